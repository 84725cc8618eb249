// The start of a run of explicit_em: the set-ups of initial_state.hpp, E from Gauss's law with
// explicit_em's own splines, and u half a step back.
#pragma once

#include "implicit_moment/explicit_em/step.hpp"
#include "implicit_moment/setup/initial_state.hpp"

namespace implicit_moment {

/// Particles at x^0, u^{-1/2} and fields at t = 0; particles sorted by cell. Every rank loads its share of them by
/// number, and hands them over to those who are to have their rows.
/// exact:  div E = 4 pi rho with rho smoothed as J will be, on every node inside.
/// note:   the loaded velocities are taken for u = gamma v.
inline State leapfrog_state(const Case& parameters) {
    const Grid& grid = parameters.grid;
    const LeapfrogSettings& settings = parameters.leapfrog;
    State state = loaded_state(parameters, common::share_of_rank());
    std::vector<Particles>& species = state.plasma.species;

    LeapfrogScratch scratch(grid);
    sort_by_cell(grid, settings.order, species);
    balance_rows(cells_of_tile(grid, settings.order), 1, species);
    interleave_field(grid, {0, false}, state.field, scratch);
    Field rho = Field::Zero(grid.size()), pass;
    for (const Moments& m : find_moments(grid, 0, settings, species, Images::conductor, scratch))
        rho += m.rho;
    smooth(grid, on_nodes, felt_charge(grid), parameters.field.smoothing, rho.data(), pass);
    add_electrostatic_field(grid, rho, state.field);

    interleave_field(grid, parameters.field.smoothing, state.field, scratch);
    const double dt = parameters.dt, per_c_squared = settings.per_c_squared();
    for (Particles& particles : species) {
        settings.order == 1 ? half_step_back<1>(scratch.field, grid, dt, per_c_squared, particles)
                            : half_step_back<2>(scratch.field, grid, dt, per_c_squared, particles);
    }
    return state;
}

}  // namespace implicit_moment
