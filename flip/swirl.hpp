// Fluid that turns about the axis. A particle is a ring, and keeps the angular momentum per mass that
// it begins with, L = r v_theta: where nothing depends on the angle, pressure has no torque. On the
// motion along r and z the rotation acts by the centrifugal force f, and it has the energy E per mass:
//
//     f = L^2/r^3                E = L^2/(2 r^2),   dE/dr = -f
//
// The mesh takes what the force does from the energy E of the particles. On the mesh the force works
// at the mean velocity of a step, and particles move with another; what the two differ by is
// internal energy of the particle, in flip and pic alike.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/parallel.hpp"
#include "flip/particles.hpp"

namespace flip {

namespace detail {

// Keeps the energy of a ring on the axis finite; no other ring comes so near.
inline constexpr double least_radius = 1e-60;

}  // namespace detail

/// Energy of the rotation, per mass.
///   L^2/(2 r^2)
inline double swirl_energy(double L, double r) {
    const double v = L / std::max(r, detail::least_radius);
    return 0.5 * v * v;
}

/// The mean centrifugal force, per mass, on a ring that moves from r to r_new.
///   (L^2/2)(r + r_new)/(r^2 r_new^2)
/// exact:  times (r_new - r) it is what swirl_energy() loses; L^2/r^3 where the ring stays
inline double centrifugal_force(double L, double r, double r_new) {
    const double a = std::max(r, detail::least_radius), b = std::max(r_new, detail::least_radius),
                 v = L / a, w = L / b;
    return 0.5 * v * w * (1 / a + 1 / b);
}

/// The centrifugal force that acts in a step, known before the ring moves.
///   that of the move from r to r + ahead step, but not nearer to the axis than r/2
/// in:     step, dt times the velocity before the step; e, internal energy per mass
/// exact:  with ahead = 2 (1 - theta), particles moved at v^theta, an oscillation about a balance is
///         neither damped nor made to grow: its map from step to step keeps areas
/// note:   energy and force then differ by a part of f step/2, which internal energy lends and gets
///         back; what is too cold to lend it looks a whole step ahead, which only makes heat, and
///         damps
// [force]
[[gnu::always_inline]] inline double force_of_step(double L, double r, double step, double ahead,
                                                   double e) {
    const double here = centrifugal_force(L, r, r);
    if (e < here * std::fabs(step)) ahead = 1;
    return ahead == 0 ? here : centrifugal_force(L, r, std::max(r + ahead * step, 0.5 * r));
}
// [/force]

/// What the particles have of the rotation together.
struct SwirlTotals {
    double angular_momentum = 0, energy = 0;
};

/// Sums over the particles.
///   sum m L,  sum m L^2/(2 r^2)
/// exact:  added in an order that does not depend on the number of threads
inline SwirlTotals swirl_totals(const Particles& p) {
    std::array<SwirlTotals, common::block_count> parts{};
    if (!has(p.L_p)) return {};
    common::for_each_block(
        p.count(),
        [&](int block, long begin, long end) {
            SwirlTotals sum;
            for (long k = begin; k < end; ++k) {
                sum.angular_momentum += p.m_p[k] * p.L_p[k];
                sum.energy += p.m_p[k] * swirl_energy(p.L_p[k], p.x_p[k]);
            }
            parts[block] = sum;
        },
        p.count());
    SwirlTotals all;
    for (const SwirlTotals& part : parts) {
        all.angular_momentum += part.angular_momentum;
        all.energy += part.energy;
    }
    return all;
}

}  // namespace flip
