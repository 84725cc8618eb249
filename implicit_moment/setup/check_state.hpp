// What is refused of a state that was read from a file: what no run of the case can have.
#pragma once

#include <cmath>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "implicit_moment/output/record.hpp"
#include "implicit_moment/setup/check_case.hpp"

namespace implicit_moment {

namespace detail {

// Refuses sums of a profile that are not those of its steps.
inline void validate_profile(const Case& parameters, long step, const UnitFluxProfile& profile) {
    const std::size_t count = profile.steps > 0 ? std::size_t(parameters.grid.x.cells) : 0;
    bool fits = profile.steps >= 0 && profile.steps <= step + 1 && profile.begin >= 0 &&
                profile.begin <= profile.end;
    for (const auto* sum : {&profile.rho_ions, &profile.J_x_ions, &profile.rho_electrons,
                            &profile.J_x_electrons, &profile.B_z})
        fits = fits && sum->size() == count;
    refuse(!fits, "the profile at unit flux is not one of its steps");
}

}  // namespace detail

/// Refuses a state that no run of the case can have after so many steps.
/// in:     sort(species), as every step ends: it leaves sorted particles as they are
/// errors: InputError, one sentence
template <class Sort>
void validate_state(const Case& parameters, long step, const Sort& sort, Checkpoint& checkpoint) {
    const Grid& grid = parameters.grid;
    const auto on_mesh = [](const common::Axis& axis, const std::vector<ParticleReal>& positions) {
        return common::all_within(positions, axis.low, axis.high());
    };
    // What ranks have of the particles, all together, so that all refuse or none.
    const auto of_all = [&](std::vector<long> of_share) {
        if (checkpoint.share.parts > 1) common::sum_over_ranks(of_share);
        return of_share;
    };
    Plasma& plasma = checkpoint.state.plasma;
    for (Particles& s : plasma.species) s.of_ranks = {};  // read by number, not by rows
    const long expected = scales_of(parameters).particles, count = of_all({plasma.count()})[0];
    refuse(count != expected, "it has ", count, " particles, and the case ", expected);
    for (Particles& s : plasma.species) {
        for (const std::vector<ParticleReal>* column : s.all())
            refuse(of_all({column->size() != s.x_p.size()})[0] > 0, s.name,
                   ": its particles lack components");
        refuse(of_all({!on_mesh(grid.x, s.x_p) || !on_mesh(grid.z, s.z_p)})[0] > 0, s.name,
               ": a particle is outside of the mesh");
    }
    std::vector<std::vector<long>> read;
    for (const Particles& s : plasma.species)
        read.emplace_back(s.first_of_node.begin(), s.first_of_node.end());
    sort(plasma.species);
    for (std::size_t k = 0; k < read.size(); ++k) {
        const std::vector<int>& first = plasma.species[k].first_of_node;
        refuse(of_all({first.begin(), first.end()}) != read[k], plasma.species[k].name,
               ": its particles are not sorted");
    }
    detail::validate_profile(parameters, step, checkpoint.profile);
    const FieldState& field = checkpoint.state.field;
    refuse(field.by_theta > 0, "the level theta takes energy and gives none");
    refuse(field.iterations < 0 || field.iterations != std::floor(field.iterations),
           "its field was solved in a number of iterations that is none");
}

}  // namespace implicit_moment
