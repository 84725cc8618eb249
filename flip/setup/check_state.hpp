// What is refused of a state that was read from a file: what no run of the case can have.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/run/checkpoint.hpp"
#include "common/run/history.hpp"
#include "flip/setup/case.hpp"
#include "flip/state.hpp"

namespace flip {

/// Refuses a state that no run of the problem can have. In pic, whose cells have velocity and
/// energy, particles have neither.
/// in:     history, the rows before this state
/// errors: InputError, one sentence
inline void validate_state(const Problem& problem, const common::History& history, State& state) {
    Particles& p = state.particles;
    const bool moving = state.cells.e.empty(), volumes = moving && problem.scheme.particle_volumes,
               affine = moving && problem.scheme.transfer.affine;
    const bool used[] = {true,    true,   true,   moving, moving, moving,
                         volumes, affine, affine, affine, affine, problem.swirl};
    bool equal = p.material.size() == p.x_p.size();
    for (std::size_t k = 0; k < std::size(used); ++k)
        equal = equal && p.all()[k]->size() == (used[k] ? p.x_p.size() : 0);
    refuse(!equal, "its particles lack columns or have others than those of the case");

    const auto on_mesh = [](const common::Axis& axis, const std::vector<double>& positions) {
        const double round_off = 1e-12 * axis.length;  // of one that has just come in
        return common::all_within(positions, axis.low - round_off, axis.high() + round_off);
    };
    refuse(!on_mesh(problem.grid.x, p.x_p) || !on_mesh(problem.grid.z, p.z_p),
           "a particle is outside of the mesh");
    refuse(!near_their_rows(problem.grid, p), "its particles are not in the rows that it says");
    constexpr double least = 1e-300, most = 1e300;
    refuse(!common::all_within(p.m_p, least, most) || !common::all_within(p.V_p, least, most),
           "a particle has no mass or no volume");
    refuse(!common::all_within(p.material, 0, double(problem.materials.size()) - 1),
           "a particle is of no material");

    const double before = history.column("time").back();
    refuse(!(state.dt > 0) || !(std::fabs(before + state.dt - state.time) <= 1e-9 * state.time),
           "its time ", state.time, " is not one step of ", state.dt, " after the last row, ",
           before);
    const double fastest = 1e6 * std::max(problem.grid.x.length, problem.grid.z.length) / state.dt;
    refuse(!common::all_within(p.vx_p, -fastest, fastest) ||
               !common::all_within(p.vz_p, -fastest, fastest),
           "a particle is faster than 1e6 lengths of the mesh in a step");
    for (std::size_t k = 0; k < p.L_p.size(); ++k)
        refuse(!(p.x_p[k] > 0 && std::fabs(p.L_p[k]) <= fastest * p.x_p[k]),
               "a particle turns about the axis faster than 1e6 lengths of the mesh in a step");
    refuse(state.report.iterations < 0 || state.report.iterations > 1000000000,
           "the iterations of its last step cannot be");
    double mass = 0;
    for (const double m_p : p.m_p) mass += m_p;
    const double expected = history.first("mass") + state.budget.mass;
    refuse(!(std::fabs(mass - expected) <=
             1e-6 * (history.first("mass") + std::fabs(state.budget.mass))),
           "the mass is ", mass, ", and ", expected, " are left of the start and what came in");
}

}  // namespace flip
