// What is refused of a state that was read from a file: what no run of the case can have.
#pragma once

#include "cic/setup/initial_state.hpp"
#include "common/run/checkpoint.hpp"

namespace cic {

/// Refuses a state that no run of the case can have after so many steps.
/// errors: InputError, one sentence
inline void validate_state(const Case& parameters, long step, const State& state) {
    const auto on_mesh = [](const common::Axis& axis, const std::vector<Real>& positions) {
        return common::all_within(positions, double(Real(axis.low)), double(Real(axis.high())));
    };
    std::size_t k = 0;
    for (const SpeciesCase& from : parameters.species) {
        if (!from.mobile()) continue;
        const Particles& s = state.species[k];
        Particles whole;
        resize(s.count(), parameters.dimensions == 2, parameters.magnetized(), whole);
        refuse(s.z_p.size() != whole.z_p.size() || s.vx_p.size() != whole.vx_p.size() ||
                   s.vy_p.size() != whole.vy_p.size() || s.vz_p.size() != whole.vz_p.size(),
               s.name, ": its particles lack components or have others than those of the case");
        refuse(!on_mesh(parameters.grid.x, s.x_p) || !on_mesh(parameters.grid.z, s.z_p), s.name,
               ": a particle is outside of the mesh");
        // Walls take particles away, and a source brings some in every step.
        const double loaded = double(particle_count(parameters, from)), count = double(s.count()),
                     emitted = double(step) * emitted_per_step(parameters, from, s.m_p / from.mass);
        refuse(count > loaded + emitted || (!parameters.has_walls() && count < loaded), s.name,
               ": it has ", count, " particles, and the case ", loaded);
        refuse(state.emitted_again[k] < 0 || double(state.emitted_again[k]) > 1e18, s.name,
               ": the count of particles that were emitted again cannot be");
        ++k;
    }
}

}  // namespace cic
