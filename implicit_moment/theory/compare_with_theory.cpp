// What compare_with_theory.hpp declares: a tail, a sheet across or along its current, a uniform plasma.
#include "implicit_moment/theory/compare_with_theory.hpp"

#include "implicit_moment/theory/compare_current_sheet.hpp"
#include "implicit_moment/theory/compare_drift.hpp"
#include "implicit_moment/theory/compare_energy.hpp"
#include "implicit_moment/theory/compare_equilibrium.hpp"
#include "implicit_moment/theory/compare_kink.hpp"
#include "implicit_moment/theory/compare_reconnection.hpp"
#include "implicit_moment/theory/compare_rest.hpp"
#include "implicit_moment/theory/compare_tail.hpp"
#include "implicit_moment/theory/compare_wave.hpp"

namespace implicit_moment {

void compare_with_theory(const Case& w, const State& state,
                         const std::function<std::vector<Moments>(const State&)>& plasma_moments,
                         const UnitFluxProfile& profile, const common::History& history,
                         common::Summary& summary) {
    if (history.rows() < 2)
        return summary.not_measured("energy_drift",
                                    "the history has only the row of the start: raise time.end");
    if (w.is_tail()) {
        if (w.harris.perturbation != 0)
            compare_tail_flux(w, history, summary);
        else
            compare_tail_at_rest(w, history, state.plasma, plasma_moments(state), summary);
    } else if (w.is_across_current()) {
        if (w.harris.perturbation != 0)
            compare_reconnection(w, history, profile, summary);
        else
            compare_equilibrium(w, state.plasma, plasma_moments(state), history, summary);
    } else if (w.is_along_current()) {
        compare_current_sheet(w, history, summary);
        compare_kink(w, history, summary);
    } else {
        compare_wave(w, history, summary);
        if (has_uniform_E(w)) compare_drift(w, history, summary);
        compare_rest(w, history, summary);
    }
    compare_energy(w, history, summary);
}

}  // namespace implicit_moment
