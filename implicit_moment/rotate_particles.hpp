// What a deposit takes for the velocity of a particle: v^n itself, or the mean velocity of the coming step
// without E, and for relativistic particles what E will make of it.
#pragma once

#include "implicit_moment/field/quadratic_weights.hpp"
#include "implicit_moment/mean_velocity.hpp"

namespace implicit_moment::detail {

// B as a deposit reads it, component by component on the mesh; stride, the distance between rows.
struct MeshB {
    const double *B_x, *B_y, *B_z;
    long stride;

    // B at particles of one node.
    Velocity<SimdVector> at(long corner, const QuadraticWeights<SimdVector>& S_x,
                            const QuadraticWeights<SimdVector>& S_z) const {
        const auto& q_x = S_x.quadratic;
        const auto& l_x = S_x.linear;
        SimdVector b_x{}, b_y{}, b_z{};
        for (int j = 0; j < 3; ++j) {
            const double* f = B_z + corner + j * stride;
            b_z += S_z.quadratic[j] * (l_x[0] * f[0] + l_x[1] * f[1]);
        }
        for (int j = 0; j < 2; ++j) {
            const double *f = B_x + corner + j * stride, *g = B_y + corner + j * stride;
            b_x += S_z.linear[j] * (q_x[0] * f[0] + q_x[1] * f[1] + q_x[2] * f[2]);
            b_y += S_z.linear[j] * (l_x[0] * g[0] + l_x[1] * g[1]);
        }
        return {b_x, b_y, b_z};
    }
};

// The moments of the slide itself: R = 1.
template <class D>
struct NoRotation {
    using Dynamics = D;
    static constexpr bool responds = false;
    Velocity<SimdVector> operator()(long, const QuadraticWeights<SimdVector>&,
                                    const QuadraticWeights<SimdVector>&,
                                    const Velocity<SimdVector>& u) const {
        return D::velocity(u);
    }
};

// The magnetic rotation R of [IMM-12], half_kick = q dt / 2m.
struct MagneticRotation {
    using Dynamics = Newtonian;
    static constexpr bool responds = false;
    MeshB B;
    double half_kick;

    // vbar = [ v + v x O + (v . O) O ] / (1 + O^2),  O = half_kick B / c, with B at the particles.
    Velocity<SimdVector> operator()(long corner, const QuadraticWeights<SimdVector>& S_x,
                                    const QuadraticWeights<SimdVector>& S_z,
                                    const Velocity<SimdVector>& v) const {
        const Velocity<SimdVector> b = B.at(corner, S_x, S_z);
        return mean_velocity<SimdVector>(
            v, {SimdVector{}, SimdVector{}, SimdVector{}, b.x, b.y, b.z}, half_kick);
    }
};

// The same of relativistic particles, which turn by O / gamma, and their response to E about E = 0:
//     vbar = R(O/gamma) v + (q dt/2m) A E,   A = R(O/gamma) (1 - vbar vbar / c^2) / gamma
struct RelativisticRotation {
    using Dynamics = Relativistic;
    static constexpr bool responds = true;
    MeshB B;
    double half_kick;

    LinearVelocity<SimdVector> operator()(long corner, const QuadraticWeights<SimdVector>& S_x,
                                          const QuadraticWeights<SimdVector>& S_z,
                                          const Velocity<SimdVector>& u) const {
        const Velocity<SimdVector> b = B.at(corner, S_x, S_z);
        return linear_mean_velocity<SimdVector>(
            u, {SimdVector{}, SimdVector{}, SimdVector{}, b.x, b.y, b.z}, half_kick);
    }
};

}  // namespace implicit_moment::detail
