// What a run of mpm_explicit keeps besides what every scheme does (record_grains.hpp): the budget of
// the leapfrog.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mpm_explicit/output/record_grains.hpp"
#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/theory/compare_with_theory.hpp"

namespace mpm_explicit {

inline std::vector<common::Column> budget_columns() {
    std::vector<common::Column> columns;
    for (const char* name :
         {"kinetic", "elastic", "energy", "energy_14", "energy_15", "external", "contact",
          "friction", "bond", "damping", "plastic", "volume", "pic", "remap", "budget"})
        columns.push_back({name, "energy"});
    return columns;
}

inline std::vector<double> budget_row(const Budget& l) {
    return {l.kinetic,   l.elastic,   l.kinetic + l.elastic,
            l.energy_14, l.energy_15, l.external,
            l.contact,   l.friction,  l.bond,
            l.damping,   l.plastic,   l.volume,
            l.pic,       l.remap,     l.residual()};
}

class LeapfrogRecorder {
   public:
    LeapfrogRecorder(const Case& parameters, const Scales& scales, const State& state,
                     common::History& history)
        : dt_(scales.dt),
          recorder_(parameters, scales, state.assembly, budget_columns(), "budget", history) {}

    /// Writes the files that are due at this step, before it.
    void snapshot(long step, const State& state, const common::Run& run) const {
        recorder_.snapshot(step, state.assembly, run);
    }

    /// Enters a step into the budget and writes its row of the history.
    /// errors: NumericalError as Recorder::refuse_failure
    void record(long step, const StepSums& sums, const GrainNodes& nodes, State& state,
                common::Run& run) {
        Budget& l = state.budget;
        add_energies(step, sums.tiles, l);
        const bool finite =
            std::all_of(sums.tiles.begin(), sums.tiles.end(), [](const TileSums& s) {
                return std::isfinite(s.kinetic) && std::isfinite(s.kinetic_leapfrog);
            });
        if (finite && recorder_.row_is_due(step))
            recorder_.write_row(static_cast<double>(step) * dt_, dt_, budget_row(l), l.momentum_x,
                                l.momentum_y, sums.contact, state.assembly, run);
        recorder_.refuse_failure(step, sums.tiles, nodes, state.assembly, l.start, l.external,
                                 l.kinetic + l.elastic, run.history);
        add_work(nodes.tiles(), sums.tiles, sums.nodes, sums.contact, l);
    }

    /// The results of the whole run, after its last step.
    void finish(long step, const State& state, common::Run& run) const {
        if (run.history.all().empty()) return;
        compare_with_theory(recorder_.ended(step, state.assembly, run.history), run.summary);
        recorder_.finish_conservation({{"remap", "largest_remap_error"}}, state.assembly, run);
    }

   private:
    double dt_;
    Recorder recorder_;
};

}  // namespace mpm_explicit
