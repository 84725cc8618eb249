// What a run is compared with, by the kind of its case; compiled by itself, because theory takes longer to
// compile than the method.
#pragma once

#include <functional>
#include <vector>

#include "common/run/run.hpp"
#include "implicit_moment/moments.hpp"
#include "implicit_moment/output/unit_flux_profile.hpp"
#include "implicit_moment/setup/initial_state.hpp"

namespace implicit_moment {

/// Writes the results of a finished run, with their verdicts, into its summary.
/// in:     state, history, of the end; plasma_moments, makes the moments of the end; profile, at unit flux
void compare_with_theory(const Case& w, const State& state,
                         const std::function<std::vector<Moments>(const State&)>& plasma_moments,
                         const UnitFluxProfile& profile, const common::History& history,
                         common::Summary& summary);

}  // namespace implicit_moment
