// What a run of mpm_implicit keeps besides what every scheme does
// (mpm_explicit/output/record_grains.hpp): the energy theorem term by term, and what it took to
// solve the steps.
#pragma once

#include <cmath>
#include <utility>

#include "mpm_explicit/output/record_grains.hpp"
#include "mpm_implicit/state.hpp"
#include "mpm_implicit/theory/compare_with_theory.hpp"
#include "mpm_implicit/theory/uneven_stress.hpp"

namespace mpm_implicit {

/// Adds the terms of the budget, energies now and work since the start.
inline void add_budget(const Budget& b, common::Row& row) {
    for (const auto& [name, value] : {std::pair("kinetic", b.kinetic),
                                      {"elastic", b.elastic},
                                      {"energy", b.energy()},
                                      {"theta_velocity", b.theta_velocity},
                                      {"theta_strain", b.theta_strain},
                                      {"lumped", b.lumped},
                                      {"contact", b.contact},
                                      {"friction", b.friction},
                                      {"bond", b.bond},
                                      {"plate", b.plate},
                                      {"gravity", b.gravity},
                                      {"external", b.plate + b.gravity},
                                      {"damping", b.damping},
                                      {"viscous", b.viscous},
                                      {"plastic", b.plastic},
                                      {"volume", b.volume},
                                      {"pic", b.pic},
                                      {"residual", b.residual()}})
        row.add(name, "energy", value);
}

/// Writes rows and files of a run, and its results.
class ThetaRecorder {
   public:
    ThetaRecorder(const Case& parameters, const ThetaScheme& scheme, const Scales& scales,
                  const State& state, common::History& history)
        : parameters_(parameters),
          scheme_(scheme),
          scales_(scales),
          recorder_(parameters, facts_of(parameters, scheme), scales, state.assembly, comparisons,
                    "residual") {
        Budget none;
        none.momenta.resize(state.assembly.grains.size());
        history.columns(row(0, none, state));
    }

    /// Writes the files and the row of t^n, when they are due.
    void record(long step, const State& state, common::Run& run) const {
        recorder_.snapshot(step, state.assembly, run);
        if (recorder_.row_is_due(step)) run.history.row(row(step, state.budget, state));
    }

    /// Looks at what a step has made.
    /// errors: NumericalError as Recorder::refuse_failure
    void refuse_failure(long step, const StepSums& sums, const GrainNodes& nodes,
                        const State& state, const common::Run& run) {
        const Budget& b = state.budget;
        recorder_.refuse_failure(step, sums.tiles, nodes, state.assembly, b.start,
                                 b.plate + b.gravity, b.energy(), run.history);
    }

    /// The results of the whole run, after its last step.
    void finish(long step, const State& state, common::Run& run) const {
        if (run.history.all().empty()) return;
        const Budget& b = state.budget;
        compare_energy_theorem(run.history, parameters_.problem, scheme_, b, run.summary);
        recorder_.compare_with_theory(step, state.assembly, run);
        warn_of_noise(parameters_, scheme_, scales_.dt, state.assembly, run);
        recorder_.finish_conservation(state.assembly, run);
        run.summary.conservation("largest_residual_of_a_step", b.largest_residual, "energy");
        const double steps = double(std::max(1L, step));
        const Effort& effort = state.effort;
        run.summary.performance("iterations_per_step", effort.iterations / steps);
        run.summary.performance("mass_iterations_per_step", effort.mass_iterations / steps);
        run.summary.performance("krylov_vectors_per_step", effort.krylov / steps);
        run.summary.performance("loops_per_step", effort.loops / steps);
    }

   private:
    common::Row row(long step, const Budget& b, const State& state) const {
        common::Row row;
        row.add("time", "time", double(step) * scales_.dt);
        add_budget(b, row);
        const Effort& last = state.effort;
        row.add("iterations", "1", last.last_iterations);
        row.add("loops", "1", last.last_loops);
        recorder_.add_to(row, b.momenta, last.contacts, last.impulse, state.assembly);
        return row;
    }

    const Case& parameters_;
    const ThetaScheme& scheme_;
    const Scales& scales_;
    Recorder recorder_;
};

}  // namespace mpm_implicit
