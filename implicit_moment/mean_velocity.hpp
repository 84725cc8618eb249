// The mean velocity of a particle in a step, by the implicit midpoint rule; of particles whose u_p is
// their velocity, and of those whose u_p is gamma v.
#pragma once

#include <array>

#include "implicit_moment/field/interleaved_field.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// Mean velocity of a step, the solution of vbar = v_t + vbar x O.
///     vbar = [ v_t + v_t x O + (v_t . O) O ] / (1 + O^2)
///     v_t = v + q dt/2m E,   O = q dt B / (2 m c)
/// in:     v^n; local fields; half_kick = q dt / 2m.
/// exact:  vbar - vbar x O = v_t.
/// source: [IMM-12] for one particle.
// [midpoint]
template <class Real>
inline Velocity<Real> mean_velocity(const Velocity<Real>& v, const LocalField<Real>& at,
                                    double half_kick) {
    const Real t_x = v.x + half_kick * at.E_x, t_y = v.y + half_kick * at.E_y,
               t_z = v.z + half_kick * at.E_z;
    const double per_c = half_kick / c;
    const Real O_x = per_c * at.B_x, O_y = per_c * at.B_y, O_z = per_c * at.B_z;
    const Real dot = t_x * O_x + t_y * O_y + t_z * O_z;
    const Real scale = 1.0 / (1.0 + O_x * O_x + O_y * O_y + O_z * O_z);
    return {scale * (t_x + t_y * O_z - t_z * O_y + dot * O_x),
            scale * (t_y + t_z * O_x - t_x * O_z + dot * O_y),
            scale * (t_z + t_x * O_y - t_y * O_x + dot * O_z)};
}
// [/midpoint]

/// The same for E = 0 as a matrix, R v = vbar; entries xx xy xz, yx yy yz, zx zy zz.
/// in:     O = q dt B / (2 m c)
/// exact:  R v - (R v) x O = v;  v . R v >= 0;  |2 R v - v| = |v|.
template <class Real>
inline std::array<Real, 9> rotation_matrix(const Real& x, const Real& y, const Real& z) {
    const Real scale = 1.0 / (1.0 + x * x + y * y + z * z);
    return {scale * (1.0 + x * x), scale * (x * y + z),   scale * (x * z - y),
            scale * (y * x - z),   scale * (1.0 + y * y), scale * (y * z + x),
            scale * (z * x + y),   scale * (z * y - x),   scale * (1.0 + z * z)};
}

/// gamma^2 = 1 + u^2/c^2. in: per_c_squared = 1/c^2, or 0, which makes gamma = 1.
template <class Real>
inline Real gamma_squared(const Velocity<Real>& u, NumberOf<Real> per_c_squared) {
    return 1.0 + per_c_squared * (u.x * u.x + u.y * u.y + u.z * u.z);
}
/// 1/gamma, the factor from u to v.
template <class Real>
inline Real inverse_gamma(const Velocity<Real>& u, NumberOf<Real> per_c_squared) {
    return 1.0 / square_root(gamma_squared(u, per_c_squared));
}

/// The mean velocity of a step, and the mean gamma: u^{n+1} = 2 gamma vbar - u^n.
template <class Real>
struct MeanVelocity {
    Velocity<Real> vbar;
    Real gamma;
    Velocity<Real> u_new(const Velocity<Real>& u) const {
        return {2.0 * gamma * vbar.x - u.x, 2.0 * gamma * vbar.y - u.y, 2.0 * gamma * vbar.z - u.z};
    }
};

namespace detail {

template <class Real>
inline Real dot(const Velocity<Real>& a, const Velocity<Real>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
inline Velocity<Real> cross(const Velocity<Real>& a, const Velocity<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline bool any(bool holds) { return holds; }
inline bool any(const SimdMask& holds) { return any_simd(holds); }

}  // namespace detail

/// Mean velocity of a relativistic step,
///     u^{n+1} - u^n = q dt/m [ E + vbar x B / c ],   vbar = (u^n + u^{n+1}) / (gamma^n + gamma^{n+1}).
/// With e = q dt/2m E, O = q dt B / (2 m c), t = u^n + e and the mean gamma G of n and n+1
///     vbar = [ G t + t x O + (t . O) O / G ] / (G^2 + O^2),   G = gamma^n + vbar . e / c^2,
/// and so G is the root of a quartic, the only one with gamma^{n+1} >= 1. Newton's method comes down to it
/// from gamma^n + |e|/c, which no G exceeds.
/// exact:  m c^2 (gamma^{n+1} - gamma^n) = q dt vbar . E, to round-off of that work; without E G = gamma^n;
///         u^{n+1} = u^n where E + v x B/c = 0, at any gamma.
/// source: G. Lapenta and S. Markidis, Phys. Plasmas 18, 072101 (2011); the drift is that of J.-L. Vay, Phys.
///         Plasmas 15, 056701 (2008).
// [relativistic_midpoint]
template <class Real>
inline MeanVelocity<Real> relativistic_mean_velocity(const Velocity<Real>& u,
                                                     const LocalField<Real>& at, double half_kick) {
    const double k = half_kick / c;  // everything over c
    const Velocity<Real> e{k * at.E_x, k * at.E_y, k * at.E_z},
        O{k * at.B_x, k * at.B_y, k * at.B_z}, t{u.x / c + e.x, u.y / c + e.y, u.z / c + e.z};
    const Velocity<Real> t_O = detail::cross(t, O);
    const Real gamma = square_root(gamma_squared(u, 1 / (c * c))), OO = detail::dot(O, O),
               along = detail::dot(t, O), two = OO - detail::dot(e, t),
               one = gamma * OO + detail::dot(e, t_O), none = along * detail::dot(e, O);
    Real G = gamma + square_root(detail::dot(e, e)), step = G;
    for (int n = 0; n < 50 && detail::any(step > 1e-15 * G); ++n) {
        const Real value = (((G - gamma) * G + two) * G - one) * G - none,
                   slope = ((4.0 * G - 3.0 * gamma) * G + 2.0 * two) * G - one;
        step = value / slope;
        G = G - step;
    }
    const Real scale = c / (G * G + OO), by_O = along / G;
    return {{scale * (G * t.x + t_O.x + by_O * O.x), scale * (G * t.y + t_O.y + by_O * O.y),
             scale * (G * t.z + t_O.z + by_O * O.z)},
            G};
}
// [/relativistic_midpoint]

/// u scaled to another |u|^2, which the energy of a particle asks for; 0 where none has it.
/// in:     found, |u|^2; wanted
template <class Real>
inline Velocity<Real> with_energy(const Velocity<Real>& u, const Real& found, const Real& wanted) {
    const Real one = Real{} + 1.0, kept = wanted > 0.0 ? wanted : 0.0 * one;
    const Real scale = square_root(found > 0.0 ? kept / found : one);
    return {scale * u.x, scale * u.y, scale * u.z};
}

/// A mean velocity that is linear in E: vbar = free + q dt/2m A E.
template <class Real>
struct LinearVelocity {
    std::array<Real, 9> A;
    Velocity<Real> free;
};

/// The tangent of relativistic_mean_velocity at a guess of E.
///     A = Q - a b^T,   Q = R(O/G)/G,   a = Q vbar / (1 + e . Q vbar / c^2),   b = (Q^T e + vbar) / c^2
/// with vbar, G and e in the guess. Along v A is 1/gamma^3, across it 1/gamma.
/// in:     u^n; fields, E of them the guess; half_kick
/// exact:  v . A v >= 0, whatever the guess and B are
template <class Real>
inline LinearVelocity<Real> linear_mean_velocity(const Velocity<Real>& u,
                                                 const LocalField<Real>& guess, double half_kick) {
    const auto [vbar, G] = relativistic_mean_velocity(u, guess, half_kick);
    const double k = half_kick / c;
    const Real per_G = 1.0 / G;
    std::array<Real, 9> A =
        rotation_matrix<Real>(k * guess.B_x * per_G, k * guess.B_y * per_G, k * guess.B_z * per_G);
    for (Real& entry : A) entry = entry * per_G;
    const double v_to_one = 1 / c;
    const Velocity<Real> w{vbar.x * v_to_one, vbar.y * v_to_one, vbar.z * v_to_one},
        e{k * guess.E_x, k * guess.E_y, k * guess.E_z};
    const Velocity<Real> Q_w{A[0] * w.x + A[1] * w.y + A[2] * w.z,
                             A[3] * w.x + A[4] * w.y + A[5] * w.z,
                             A[6] * w.x + A[7] * w.y + A[8] * w.z};
    const Velocity<Real> b{A[0] * e.x + A[3] * e.y + A[6] * e.z + w.x,
                           A[1] * e.x + A[4] * e.y + A[7] * e.z + w.y,
                           A[2] * e.x + A[5] * e.y + A[8] * e.z + w.z};
    const Real part = 1.0 / (1.0 + detail::dot(e, Q_w));
    const Real a[3] = {part * Q_w.x, part * Q_w.y, part * Q_w.z}, b_of[3] = {b.x, b.y, b.z};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) A[3 * i + j] = A[3 * i + j] - a[i] * b_of[j];
    return {A,
            {vbar.x - c * (A[0] * e.x + A[1] * e.y + A[2] * e.z),
             vbar.y - c * (A[3] * e.x + A[4] * e.y + A[5] * e.z),
             vbar.z - c * (A[6] * e.x + A[7] * e.y + A[8] * e.z)}};
}

/// The dynamics of a species: what u_p means, its energy, and its mean velocity in a step.
struct Newtonian {
    // By component: a copy of the whole goes through memory in pieces.
    template <class Real>
    static Velocity<Real> velocity(const Velocity<Real>& u) {
        return {u.x, u.y, u.z};
    }
    // 2 (gamma - 1) c^2, twice the kinetic energy per mass.
    template <class Real>
    static Real twice_energy(const Velocity<Real>& u) {
        return u.x * u.x + u.y * u.y + u.z * u.z;
    }
    template <class Real>
    static MeanVelocity<Real> mean(const Velocity<Real>& u, const LocalField<Real>& at,
                                   double half_kick) {
        return {mean_velocity(u, at, half_kick), Real{} + 1.0};
    }
    // |u|^2 after a work per mass; negative where it takes more than there is.
    template <class Real>
    static Real square_after(const Velocity<Real>& u, const Real& work) {
        return u.x * u.x + u.y * u.y + u.z * u.z + 2.0 * work;
    }
};
struct Relativistic {
    template <class Real>
    static Velocity<Real> velocity(const Velocity<Real>& u) {
        const Real per_gamma = inverse_gamma(u, 1 / (c * c));
        return {per_gamma * u.x, per_gamma * u.y, per_gamma * u.z};
    }
    // Without cancellation.
    template <class Real>
    static Real twice_energy(const Velocity<Real>& u) {
        const Real gamma = square_root(gamma_squared(u, 1 / (c * c)));
        return 2.0 * (u.x * u.x + u.y * u.y + u.z * u.z) / (1.0 + gamma);
    }
    template <class Real>
    static MeanVelocity<Real> mean(const Velocity<Real>& u, const LocalField<Real>& at,
                                   double half_kick) {
        return relativistic_mean_velocity(u, at, half_kick);
    }
    template <class Real>
    static Real square_after(const Velocity<Real>& u, const Real& work) {
        const Real gamma = square_root(gamma_squared(u, 1 / (c * c)));
        const Real left = gamma + work / (c * c),
                   square = detail::dot(u, u) + 2.0 * gamma * work + work * work / (c * c);
        return left > 0.0 ? square : -c * c * (1.0 + left * left);
    }
};

/// Calls work with the dynamics of a species.
template <class Work>
inline decltype(auto) with_dynamics(const Particles& particles, const Work& work) {
    return particles.relativistic ? work(Relativistic{}) : work(Newtonian{});
}

/// v of particle p, whatever u_p is.
inline Velocity<double> velocity_of(const Particles& s, std::size_t p) {
    return with_dynamics(s, [&](auto dynamics) {
        return decltype(dynamics)::velocity(Velocity<double>{s.ux_p[p], s.uy_p[p], s.uz_p[p]});
    });
}

}  // namespace implicit_moment
