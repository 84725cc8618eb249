// Where the energy goes, [MPM-13] term by term.
//
// The energy is that of the particles,
//     E = 1/2 sum_p m_p v_p^2 + 1/2 sum_p V_p sigma_p : T^-1 : sigma_p
// and in a step, with d the change of a quantity in it,
//     dE = - (theta - 1/2) sum_p m_p dv_p^2                       theta_velocity
//          - (theta - 1/2) sum_p V_p dsigma_p : de_p              theta_strain
//          - theta sum_ij dv_i (m_i delta_ij - M_ij) dv_j         lumped: 0 for consistent mass
//          - sum_p V_p 1/2 (sigma^0 + sigma^1) : de^p             plastic
//          - sum_p V_p sigma_v : de_p                             viscous: never positive
//          + work of contact, friction, bonds, plates, gravity, damping + volume + pic
// The slide's equation is the first two lines. Everything is counted where it happens, so that the
// rest, `residual`, is round-off and what the solvers leave.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mpm_explicit/contact.hpp"
#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_explicit/grains/material_laws.hpp"
#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm_implicit {

using namespace mpm;

/// Sums over the particles of one tile.
struct TileSums {
    double elastic = 0;       // 1/2 V sigma^1 : T^-1 : sigma^1
    double theta_strain = 0;  // V dsigma : de
    double plastic = 0;       // V 1/2 (sigma^0 + sigma^1) : de^p
    double volume = 0;        // what a change of volumes adds
    double viscous = 0;       // V^theta sigma_v : de
    double least_V = 0;       // smallest V^1/V^0
    // after particles have moved
    double kinetic = 0;          // 1/2 m v^1 v^1
    double twice_increment = 0;  // m dv dv
    double pic = 0;              // what a FLIP fraction below one takes, and walls from particles
    double damping = 0;          // what load.damping takes
    double momentum_x = 0, momentum_y = 0, angular = 0;
    double x_least = 0, x_most = 0, y_least = 0, y_most = 0;
};

/// Sums over nodes.
struct NodeWork {
    double twice_increment = 0;  // m_i dv_i dv_i
    double gravity = 0;          // dt m_i g v_i^theta
    double largest_speed = 0;
};

/// Energies now, and what has been taken and given since the start.
struct Budget {
    double kinetic = 0, elastic = 0;
    double theta_velocity = 0, theta_strain = 0, lumped = 0;
    double contact = 0, friction = 0, bond = 0, plate = 0, gravity = 0, damping = 0, viscous = 0,
           plastic = 0, volume = 0, pic = 0;
    double start = 0;
    double largest_residual = 0;   // of one step
    std::vector<Momenta> momenta;  // of each grain

    double energy() const { return kinetic + elastic; }
    double work() const {
        return contact + friction + bond + plate + gravity + damping + viscous + volume + pic -
               plastic - theta_velocity - theta_strain - lumped;
    }
    double residual() const { return energy() - start - work(); }
};

template <class Archive>
void archive(Archive& a, Budget& b) {
    std::vector<double*> numbers{
        &b.kinetic,  &b.elastic, &b.theta_velocity, &b.theta_strain,     &b.lumped,  &b.contact,
        &b.friction, &b.bond,    &b.plate,          &b.gravity,          &b.damping, &b.plastic,
        &b.volume,   &b.pic,     &b.start,          &b.largest_residual, &b.viscous};
    std::vector<double> values;
    for (const double* number : numbers) values.push_back(*number);
    std::span all(values);  // of this length
    a("budget", all);
    for (std::size_t k = 0; k < numbers.size(); ++k) *numbers[k] = values[k];
    archive_momenta(a, b.momenta);
}

/// Energies and momenta at the start.
inline void start_budget(const Assembly& all, const std::vector<AnyLaw>& laws, Budget& b) {
    b = {};
    b.momenta = momenta_of(all);
    const Particles& at = all.particles;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        if (all.grains[g].rigid) continue;
        const Compliance& C = laws[all.grains[g].material].compliance;
        for (long k = all.grains[g].begin; k < all.grains[g].end; ++k) {
            const auto p = static_cast<std::size_t>(k);
            b.kinetic += 0.5 * at.m_p[p] * (at.vx_p[p] * at.vx_p[p] + at.vy_p[p] * at.vy_p[p]);
            b.elastic += 0.5 * at.V_p[p] * C(at.stress(p), at.stress(p));
        }
    }
    b.start = b.energy();
}

/// Adds the terms of a step.                                                             [MPM-13]
inline void add_step(double theta, bool consistent, const std::vector<Tile>& where,
                     const std::vector<TileSums>& tiles, const NodeWork& nodes,
                     const ContactSums& contact, Budget& b) {
    const double energy_before = b.energy(), work_before = b.work();
    TileSums s;
    std::fill(b.momenta.begin(), b.momenta.end(), Momenta{});
    for (std::size_t k = 0; k < tiles.size(); ++k) {
        const TileSums& one = tiles[k];
        s.elastic += one.elastic, s.theta_strain += one.theta_strain, s.plastic += one.plastic;
        s.volume += one.volume, s.kinetic += one.kinetic, s.twice_increment += one.twice_increment;
        s.pic += one.pic, s.damping += one.damping, s.viscous += one.viscous;
        Momenta& grain = b.momenta[static_cast<std::size_t>(where[k].grain)];
        grain.x += one.momentum_x, grain.y += one.momentum_y, grain.angular += one.angular;
    }
    b.kinetic = s.kinetic, b.elastic = s.elastic;
    b.theta_velocity += (theta - 0.5) * s.twice_increment,
        b.theta_strain += (theta - 0.5) * s.theta_strain;
    if (!consistent) b.lumped += theta * (nodes.twice_increment - s.twice_increment);
    b.contact += contact.normal, b.friction += contact.friction, b.bond += contact.bond;
    b.plate += contact.rigid, b.gravity += nodes.gravity;
    b.damping -= s.damping, b.viscous -= s.viscous, b.plastic += s.plastic, b.volume += s.volume,
        b.pic += s.pic;
    const double residual = (b.energy() - energy_before) - (b.work() - work_before);
    b.largest_residual = std::max(b.largest_residual, std::fabs(residual));
}

}  // namespace mpm_implicit
