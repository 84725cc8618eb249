// The numbers that the steps work with, from what the case file says in words.
#pragma once

#include <cmath>
#include <string>

#include "flip/problem.hpp"
#include "flip/setup/initial_state.hpp"

namespace flip {

namespace detail {

inline BoundaryKind boundary_kind(const std::string& word) {
    return word == "slip"      ? BoundaryKind::slip
           : word == "no_slip" ? BoundaryKind::no_slip
           : word == "open"    ? BoundaryKind::open
           : word == "inflow"  ? BoundaryKind::inflow
                               : BoundaryKind::periodic;
}

inline Inflow inflow_of(const Case& w, const GasCase& in) {
    const int k = material_index(w, in.material);
    if (k < 0) return {};
    const Material& a = w.materials[k];
    const double rho = in.density, e = internal_energy(a, rho, in.pressure),
                 p = pressure(a, rho, e);
    return {k,
            rho,
            p,
            std::sqrt(stiffness(a, p) / rho),
            e,
            in.velocity_x,
            in.velocity_z,
            in.velocity_theta,
            in.angular_velocity};
}

}  // namespace detail

/// The problem that a case describes.
/// in: a completed case that validate() has not refused
inline Problem problem_of(const Case& w) {
    Problem problem;
    problem.grid = w.grid;
    problem.materials = w.materials;
    for (const Side s : all_sides)
        problem.boundaries.side[s] = {detail::boundary_kind(w.boundaries[s].kind),
                                      w.boundaries[s].slide, w.boundaries[s].pressure,
                                      detail::inflow_of(w, w.boundaries[s].inflow)};
    problem.body_force = {w.gravity_x, w.gravity_z, w.trap};
    problem.q = {w.q_linear, w.q_quadratic};
    problem.viscosity = w.viscosity;
    problem.swirl = w.swirls();
    problem.limits = {w.cfl, w.dt, w.end};
    problem.per_cell_x = w.per_cell_x;
    problem.per_cell_z = w.per_cell_z;

    const bool consistent = w.mass == "consistent";
    const double part = w.transfer == "flip" ? 0 : (w.transfer == "blend" ? 1 - w.blend : 1);
    const Transfer transfer{w.transfer == "flip", part,         w.transfer == "apic",
                            w.transfer == "xpic", w.xpic_order, w.heats()};
    // Under gravity, and the centrifugal force, particles must not fall together within a cell, where no
    // pressure feels it.
    const bool falls = w.gravity_x != 0 || w.gravity_z != 0,
               conservative = w.confined || ((falls || w.swirls()) && w.plane());
    problem.scheme = {transfer,         consistent,     w.density == "particles",
                      w.filling,        w.confined,     conservative,
                      w.implicit(),     w.theta,        w.tolerance,
                      w.max_iterations, w.rezone_steps, w.min_particles,
                      w.max_particles};
    return problem;
}

}  // namespace flip
