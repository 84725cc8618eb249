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
    // Of what ranks have read, all together, so that all refuse or none.
    const auto any = [](bool here) { return common::sum_over_ranks(long(here)) > 0; };
    std::size_t k = 0;
    for (const SpeciesCase& from : parameters.species) {
        if (!from.mobile()) continue;
        const Particles& s = state.species[k];
        Particles one;  // has what a particle of the case has
        resize(1, parameters.dimensions == 2, parameters.magnetized(), one);
        const auto lacks = [&](const std::vector<Real>& q, const std::vector<Real>& of_one) {
            return q.size() != of_one.size() * s.x_p.size();
        };
        refuse(any(lacks(s.z_p, one.z_p) || lacks(s.vx_p, one.vx_p) || lacks(s.vy_p, one.vy_p) ||
                   lacks(s.vz_p, one.vz_p)),
               s.name, ": its particles lack components or have others than those of the case");
        refuse(any(!on_mesh(parameters.grid.x, s.x_p) || !on_mesh(parameters.grid.z, s.z_p)),
               s.name, ": a particle is outside of the mesh");
        // Walls take particles away, and a source brings some in every step.
        const double loaded = double(particle_count(parameters, from)),
                     count = double(common::sum_over_ranks(s.count())),
                     emitted = double(step) * emitted_per_step(parameters, from, s.m_p / from.mass);
        refuse(count > loaded + emitted || (!parameters.has_walls() && count < loaded), s.name,
               ": it has ", count, " particles, and the case ", loaded);
        refuse(state.emitted_again[k] < 0 || double(state.emitted_again[k]) > 1e18, s.name,
               ": the count of particles that were emitted again cannot be");
        ++k;
    }
}

}  // namespace cic
