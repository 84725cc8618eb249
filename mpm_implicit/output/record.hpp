// What a run of mpm_implicit keeps besides what every scheme does
// (mpm_explicit/output/record_grains.hpp): the energy theorem term by term, and what it took to solve
// the steps.
#pragma once

#include <cmath>
#include <vector>

#include "mpm_explicit/output/record_grains.hpp"
#include "mpm_implicit/state.hpp"
#include "mpm_implicit/theory/compare_with_theory.hpp"

namespace mpm_implicit {

inline std::vector<common::Column> budget_columns() {
    std::vector<common::Column> columns = Budget::columns();
    for (const char* name : {"iterations", "loops", "held"}) columns.push_back({name, "1"});
    return columns;
}

class ThetaRecorder {
   public:
    ThetaRecorder(const Case& parameters, const ThetaScheme& scheme, const Scales& scales,
                  const State& state, common::History& history)
        : parameters_(parameters),
          scheme_(scheme),
          scales_(scales),
          recorder_(parameters, scales, state.assembly, budget_columns(), "residual", history) {}

    /// The row of t = 0.
    void start(const State& state, common::Run& run) { write_row(0, StepSums{}, state, run); }

    /// Writes the files that are due at this step, before it.
    void snapshot(long step, const State& state, const common::Run& run) const {
        recorder_.snapshot(step, state.assembly, run);
    }

    /// Enters a step into the budget and writes the row of its end.                     [MPM-13]
    /// errors: NumericalError as Recorder::refuse_failure
    void record(long step, const StepSums& sums, const GrainNodes& nodes, State& state,
                common::Run& run) {
        Budget& l = state.budget;
        add_step(scheme_.theta, scheme_.consistent(), parameters_.problem.damping, scales_.dt,
                 nodes.tiles(), sums.tiles, sums.nodes, sums.contact, l);
        state.effort.add(sums.solver);
        if (std::isfinite(l.energy()) && recorder_.row_is_due(step + 1))
            write_row(static_cast<double>(step + 1) * scales_.dt, sums, state, run);
        recorder_.refuse_failure(step, sums.tiles, nodes, state.assembly, l.start,
                                 l.plate + l.gravity, l.energy(), run.history);
    }

    /// The results of the whole run, after its last step.
    void finish(long step, const State& state, common::Run& run) const {
        if (run.history.all().empty()) return;
        const Budget& l = state.budget;
        compare_with_theory(recorder_.ended(step, state.assembly, run.history), scheme_, l,
                            run.summary);
        recorder_.finish_conservation({}, state.assembly, run);
        run.summary.conservation("largest_residual_of_a_step", l.largest_residual, "energy");
        const double steps = static_cast<double>(std::max(1L, step));
        const Effort& effort = state.effort;
        run.summary.performance("iterations_per_step", effort.iterations / steps);
        run.summary.performance("mass_iterations_per_step", effort.mass_iterations / steps);
        run.summary.performance("krylov_vectors_per_step", effort.krylov / steps);
        run.summary.performance("loops_per_step", effort.loops / steps);
        run.summary.performance("held_pairs_per_step", effort.held / steps);
    }

   private:
    void write_row(double time, const StepSums& sums, const State& state, common::Run& run) {
        const Budget& l = state.budget;
        std::vector<double> row = l.row();
        row.insert(row.end(),
                   {static_cast<double>(sums.solver.iterations),
                    static_cast<double>(sums.solver.loops), static_cast<double>(sums.solver.held)});
        recorder_.write_row(time, scales_.dt, row, l.momentum_x, l.momentum_y, sums.contact,
                            state.assembly, run);
    }

    const Case& parameters_;
    const ThetaScheme& scheme_;
    const Scales& scales_;
    Recorder recorder_;
};

}  // namespace mpm_implicit
