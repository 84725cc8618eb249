// Where the energy goes: sums of one step, tile by tile, and the budget they add up to.
//
// Leapfrog keeps the energy of [MPM-14] as long as particles stand still:
//     E^n = 1/2 sum_p m_p v_p^2 + 1/2 sum_p V_p sigma_p^{n-1/2} : T^-1 : sigma_p^{n+1/2}
// Everything that changes it is counted where it happens, so that the rest, `budget`, is round-off:
//     d E = external + contact + release + friction + bond + damping + viscous - plastic + volume
//           + pic + remap
// remap is what moving particles from cell to cell costs: the work that the nodes get from the force
// of stress, less what stress has given for it in the steps before and after, with the second order
// of a turn; and the kinetic energy that lumping the mass takes. viscous is - sum_p V_p sigma_v : de_p,
// never positive; by what the work of the viscous force on 1/2 (v_i^0 + v_i^1) differs is in remap.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mpm_explicit/contact.hpp"
#include "mpm_explicit/grains/assembly.hpp"

namespace mpm_explicit {

/// Sums over the particles of one tile.
struct TileSums {
    // after the stress of the step
    double elastic = 0;          // 1/2 V sigma^{n+1/2} : T^-1 : sigma^{n+1/2}
    double leapfrog = 0;         // 1/2 V sigma^{n-1/2} : T^-1 : sigma^{n+1/2}
    double stress_work = 0;      // 1/2 V sigma^{n+1/2} : de
    double old_stress_work = 0;  // 1/2 V sigma^{n-1/2} : de, with the volume of the step before
    double plastic_old = 0;      // 1/2 V^{n-1/2} sigma^{n-1/2} : de^p
    double plastic_new = 0;      // 1/2 V^{n+1/2} sigma^{n+1/2} : de^p
    double volume = 0;           // 1/2 (V^{n+1/2} - V^{n-1/2}) sigma^{n-1/2} : T^-1 : sigma^{n+1/2}
    double viscous = 0;          // V^{n+1/2} sigma_v : de
    double least_V = 0;          // smallest V^{n+1/2}/V^{n-1/2}
    // after particles have moved
    double kinetic = 0;            // 1/2 m v^{n+1} v^{n+1}
    double kinetic_leapfrog = 0;   // 1/2 m v^n v^{n+1}
    double kinetic_increment = 0;  // 1/2 m (S_ip (v_i^1 - v_i^0))^2
    double pic = 0;                // what a FLIP fraction below one takes, and walls from particles
    double affine = 0;             // the work of affine motion
    double momentum_x = 0, momentum_y = 0, angular = 0, spin = 0;  // spin: of affine motion
    double x_least = 0, x_most = 0, y_least = 0, y_most = 0;
};

/// Sums over nodes, after contact.
struct NodeWork {
    double internal_work = 0;      // dt f_i 1/2 (v_i^0 + v_i^1)
    double kinetic_increment = 0;  // 1/2 m_i (v_i^1 - v_i^0)^2
    double gravity = 0, damping = 0;
    double largest_speed = 0;

    void operator+=(const NodeWork& other) {
        internal_work += other.internal_work, kinetic_increment += other.kinetic_increment;
        gravity += other.gravity, damping += other.damping;
        largest_speed = std::max(largest_speed, other.largest_speed);
    }
};

/// Energies now, and work since the start.
struct Budget {
    double kinetic = 0, elastic = 0;      // of t^n
    double energy_14 = 0, energy_15 = 0;  // [MPM-14] of t^n, [MPM-15] of t^{n+1/2}
    double external = 0, contact = 0, release = 0, friction = 0, bond = 0, damping = 0, viscous = 0,
           plastic = 0, volume = 0, pic = 0, remap = 0;
    double start = 0;                                 // energy_14 at t = 0
    double elastic_before = 0;                        // of t^{n-1/2}
    double kinetic_next = 0;                          // of t^{n+1}
    std::vector<mpm::Momenta> momenta, momenta_next;  // of each grain, at t^n and t^{n+1}

    double work() const {
        return external + contact + release + friction + bond + damping + viscous - plastic +
               volume + pic + remap;
    }
    double residual() const { return energy_14 - start - work(); }
};

template <class Archive>
void archive(Archive& a, Budget& b) {
    std::vector<double*> numbers{
        &b.kinetic,  &b.elastic, &b.energy_14,      &b.energy_15,    &b.external, &b.contact,
        &b.friction, &b.bond,    &b.damping,        &b.plastic,      &b.volume,   &b.pic,
        &b.remap,    &b.start,   &b.elastic_before, &b.kinetic_next, &b.release,  &b.viscous};
    std::vector<double> values;
    for (const double* number : numbers) values.push_back(*number);
    std::span all(values);  // of this length
    a("budget", all);
    for (std::size_t k = 0; k < numbers.size(); ++k) *numbers[k] = values[k];
    archive_momenta(a, b.momenta_next);
}

/// Kinetic energy and momenta at the start.
/// in: sums of every tile, the angular momentum of affine motion
inline void start_budget(const mpm::Assembly& all, const std::vector<mpm::Tile>& where,
                         const std::vector<TileSums>& sums, Budget& b) {
    b.momenta_next = mpm::momenta_of(all);
    for (std::size_t k = 0; k < sums.size(); ++k)
        b.momenta_next[static_cast<std::size_t>(where[k].grain)].angular += sums[k].spin;
    const mpm::Particles& at = all.particles;
    b.kinetic_next = 0;
    for (const mpm::Grain& grain : all.grains)
        for (long k = grain.begin; k < grain.end && !grain.rigid; ++k) {
            const auto p = static_cast<std::size_t>(k);
            b.kinetic_next += 0.5 * at.m_p[p] * (at.vx_p[p] * at.vx_p[p] + at.vy_p[p] * at.vy_p[p]);
        }
}

/// The energies of t^n, [MPM-14] and [MPM-15], when all of its step has been summed up.
inline void add_energies(long step, const std::vector<TileSums>& tiles, Budget& b) {
    TileSums s;
    for (const TileSums& one : tiles) {
        s.elastic += one.elastic, s.leapfrog += one.leapfrog,
            s.old_stress_work += one.old_stress_work;
        s.plastic_old += one.plastic_old, s.volume += one.volume,
            s.kinetic_leapfrog += one.kinetic_leapfrog;
    }
    b.kinetic = b.kinetic_next;
    b.momenta = b.momenta_next;
    b.energy_14 = b.kinetic + s.leapfrog;
    b.energy_15 = s.kinetic_leapfrog + s.elastic;
    if (step == 0) {
        b.start = b.energy_14;
        b.elastic_before = s.leapfrog;
    } else {
        b.remap += s.old_stress_work, b.volume += s.volume, b.plastic += s.plastic_old;
    }
    b.elastic = 0.5 * (b.elastic_before + s.elastic);
    b.elastic_before = s.elastic;
}

/// The work of the step that leads from t^n to t^{n+1}.
inline void add_work(const std::vector<mpm::Tile>& where, const std::vector<TileSums>& tiles,
                     const NodeWork& nodes, const mpm::ContactSums& contact, Budget& b) {
    TileSums s;
    std::fill(b.momenta_next.begin(), b.momenta_next.end(), mpm::Momenta{});
    for (std::size_t k = 0; k < tiles.size(); ++k) {
        s.plastic_new += tiles[k].plastic_new, s.kinetic += tiles[k].kinetic;
        s.kinetic_increment += tiles[k].kinetic_increment, s.pic += tiles[k].pic;
        s.affine += tiles[k].affine, s.stress_work += tiles[k].stress_work;
        s.viscous += tiles[k].viscous;
        mpm::Momenta& grain = b.momenta_next[static_cast<std::size_t>(where[k].grain)];
        grain.x += tiles[k].momentum_x, grain.y += tiles[k].momentum_y;
        grain.angular += tiles[k].angular + tiles[k].spin;
    }
    b.kinetic_next = s.kinetic;
    b.external += contact.rigid + nodes.gravity;
    b.contact += contact.normal, b.release += contact.release;
    b.friction += contact.friction, b.bond += contact.bond;
    b.damping += nodes.damping, b.viscous -= s.viscous;
    b.plastic += s.plastic_new, b.pic += s.pic - s.affine;
    b.remap += nodes.internal_work + s.stress_work + s.viscous -
               (nodes.kinetic_increment - s.kinetic_increment);
}

}  // namespace mpm_explicit
