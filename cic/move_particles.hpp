// particles move: the leapfrog, with Boris's rotation about a uniform magnetic field.
// [CIC-4, CIC-5]
//
//     v^(n-1/2) --E^n--> v^(n+1/2)          x^n --v^(n+1/2)--> x^(n+1)
//
// Velocities live half-way between positions, so both steps are centered: the error is of second
// order in dt, and the scheme can be run backwards.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "cic/particles.hpp"

namespace cic {

/// A uniform magnetic field, B_y out of the plane.
struct MagneticField {
    double x = 0, y = 0, z = 0;
    double size() const { return std::hypot(x, y, z); }
};

/// The rotation about B in a step.
///   R = rotation by -2 atan(Omega dt/2) about B,  Omega = q B/m
/// in:     part of a step: 1, or -1/2 for half a step backwards
/// exact:  the drift E x B/B^2 in a uniform field, for any Omega dt; |v| without E
/// note:   The drift is exact, but the angle is 1 - (Omega dt)^2/12 of the true one. With a rotation
///         by Omega dt the drift would be (Omega dt/2) / tan(Omega dt/2) of the true one.
/// source: Boris, Proc. 4th Conf. Num. Sim. Plasmas (1970).
inline Eigen::Matrix3d rotation_of_step(const MagneticField& B, double charge_over_mass, double dt,
                                        double part) {
    if (B.size() == 0) return Eigen::Matrix3d::Identity();
    const Eigen::Vector3d axis = Eigen::Vector3d(B.x, B.y, B.z) / B.size();
    const double angle = -2 * std::atan(0.5 * charge_over_mass * B.size() * dt);
    return Eigen::AngleAxisd(part * angle, axis).toRotationMatrix();
}

namespace detail {

// v_old . v_new and v_new, summed over particles, of one component.
struct ComponentSums {
    Real product = 0, v_new = 0;
};

// One component of the momentum equation without B.
inline ComponentSums accelerate_along(Real kick, long count, const Real* E_p, Real* v_p) {
    Real product = 0, sum = 0;
    // [accelerate]
#pragma omp simd reduction(+ : product, sum)
    for (long p = 0; p < count; ++p) {
        const Real v_old = v_p[p], v_new = v_old + kick * E_p[p];
        v_p[p] = v_new;
        product += v_old * v_new;
        sum += v_new;
    }
    // [/accelerate]
    return {product, sum};
}

// All three components with B: half a kick, the rotation, the other half.
inline std::array<ComponentSums, 3> accelerate_and_turn(Real half_kick,
                                                        const Eigen::Matrix3d& rotation,
                                                        const FieldAtParticles& E_p,
                                                        ParticleBatch& batch) {
    const Eigen::Matrix<Real, 3, 3> R = rotation.cast<Real>();
    const bool plane = batch.z_p != nullptr;
    Real *const vx = batch.vx_p, *const vy = batch.vy_p, *const vz = batch.vz_p;
    Real product = 0, sum_x = 0, sum_y = 0, sum_z = 0;
#pragma omp simd reduction(+ : product, sum_x, sum_y, sum_z)
    for (long p = 0; p < batch.count; ++p) {
        const Real h_x = half_kick * E_p.x[p], h_z = plane ? half_kick * E_p.z[p] : Real(0);
        const Real x = vx[p] + h_x, y = vy[p], z = vz[p] + h_z;
        vx[p] = R(0, 0) * x + R(0, 1) * y + R(0, 2) * z + h_x;
        vy[p] = R(1, 0) * x + R(1, 1) * y + R(1, 2) * z;
        vz[p] = R(2, 0) * x + R(2, 1) * y + R(2, 2) * z + h_z;
        product += x * x + y * y + z * z - h_x * h_x - h_z * h_z;
        sum_x += vx[p];
        sum_y += vy[p];
        sum_z += vz[p];
    }
    return {ComponentSums{product, sum_x}, ComponentSums{0, sum_y}, ComponentSums{0, sum_z}};
}

}  // namespace detail

/// The momentum equation over one step.
///   v^(n+1/2) = v^(n-1/2) + (q/m) dt E_p,  and with B
///   v^(n+1/2) = R [v^(n-1/2) + h] + h,  h = (q/m) (dt/2) E_p,  R the rotation of one step
/// in/out: velocities of the batch; in one dimension only vx without B
/// out:    batch.sums: the momentum at n+1/2, and the kinetic energy at n, without B
///           (1/2) m v^(n-1/2) . v^(n+1/2),
///         for which energy theorems hold. It is computed as (1/2) m (|v^(n-1/2) + h|^2 - |h|^2):
///         without B the same, and with B the rotation does not enter
/// source: [CIC-4]
inline void accelerate(const FieldAtParticles& E_p, const MagneticField& B, double dt,
                       ParticleBatch& batch) {
    const double charge_over_mass = batch.q_p / batch.m_p;
    const Real kick = Real(charge_over_mass * dt);
    std::array<detail::ComponentSums, 3> sums{};
    if (batch.vy_p != nullptr) {
        sums = detail::accelerate_and_turn(kick / 2, rotation_of_step(B, charge_over_mass, dt, 1),
                                           E_p, batch);
    } else {
        sums[0] = detail::accelerate_along(kick, batch.count, E_p.x, batch.vx_p);
        if (batch.vz_p != nullptr)
            sums[2] = detail::accelerate_along(kick, batch.count, E_p.z, batch.vz_p);
    }
    batch.sums = {};
    for (std::size_t a = 0; a < 3; ++a) {
        batch.sums.kinetic += 0.5 * batch.m_p * double(sums[a].product);
        batch.sums.momentum[a] = batch.m_p * double(sums[a].v_new);
    }
}

/// Half a step backwards, for the start: v^(-1/2) from v^0.
///   v^(-1/2) = R^(-1/2) v^0 - h
/// exact:  accelerate() then gives v^(1/2) = R^(1/2) v^0 + h, the mirror image in time
inline void start_leapfrog(const FieldAtParticles& E_p, const MagneticField& B, double dt,
                           ParticleBatch& batch) {
    const double charge_over_mass = batch.q_p / batch.m_p;
    const Eigen::Matrix3d R = rotation_of_step(B, charge_over_mass, dt, -0.5);
    const double h = 0.5 * charge_over_mass * dt;
    for (long p = 0; p < batch.count; ++p) {
        const auto at = [p](const Real* v) { return v == nullptr ? 0.0 : double(v[p]); };
        const Eigen::Vector3d v =
            R * Eigen::Vector3d(at(batch.vx_p), at(batch.vy_p), at(batch.vz_p));
        batch.vx_p[p] = Real(v[0] - h * double(E_p.x[p]));
        if (batch.vy_p != nullptr) batch.vy_p[p] = Real(v[1]);
        if (batch.vz_p != nullptr)
            batch.vz_p[p] = Real(v[2] - (batch.z_p != nullptr ? h * double(E_p.z[p]) : 0.0));
    }
}

namespace detail {

// One direction of move_particles().
inline void move_along(const common::Axis& axis, Real dt, long count, const Real* v, Real* x) {
    const Real low = Real(axis.low), high = Real(axis.high()), length = Real(axis.length),
               per_length = Real(1 / axis.length);
    if (axis.periodic) {
        // The last line keeps round-off, and what is not finite any more, on the mesh.
        // [move]
#pragma omp simd
        for (long p = 0; p < count; ++p) {
            const Real to = x[p] + dt * v[p];
            const Real on_mesh = to - length * std::floor((to - low) * per_length);
            x[p] = on_mesh > low ? (on_mesh < high ? on_mesh : high) : low;
        }
        // [/move]
    } else {
#pragma omp simd
        for (long p = 0; p < count; ++p) x[p] += dt * v[p];
    }
}

}  // namespace detail

/// The positions over one step.
///   x^(n+1) = x^n + dt v^(n+1/2)
/// in/out: positions of the batch; in a periodic direction they come back on the mesh, between
///         walls they may end behind one: see apply_particle_boundaries
/// source: [CIC-5]
inline void move_particles(const Grid& grid, double dt, ParticleBatch& batch) {
    detail::move_along(grid.x, Real(dt), batch.count, batch.vx_p, batch.x_p);
    if (batch.z_p != nullptr)
        detail::move_along(grid.z, Real(dt), batch.count, batch.vz_p, batch.z_p);
}

}  // namespace cic
