// What a run of mpm_explicit keeps besides what every scheme does (record_grains.hpp): the budget
// of the leapfrog.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mpm_explicit/output/record_grains.hpp"
#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/theory/compare_with_theory.hpp"

namespace mpm_explicit {

/// Adds the terms of the budget, energies now and work since the start.
inline void add_budget(const Budget& b, common::Row& row) {
    for (const auto& [name, value] : {std::pair("kinetic", b.kinetic),
                                      {"elastic", b.elastic},
                                      {"energy", b.kinetic + b.elastic},
                                      {"energy_14", b.energy_14},
                                      {"energy_15", b.energy_15},
                                      {"external", b.external},
                                      {"contact", b.contact},
                                      {"release", b.release},
                                      {"friction", b.friction},
                                      {"bond", b.bond},
                                      {"damping", b.damping},
                                      {"viscous", b.viscous},
                                      {"plastic", b.plastic},
                                      {"volume", b.volume},
                                      {"pic", b.pic},
                                      {"remap", b.remap},
                                      {"budget", b.residual()}})
        row.add(name, "energy", value);
}

/// Writes rows and files of a run, and its results.
class LeapfrogRecorder {
   public:
    LeapfrogRecorder(const Case& parameters, const Scales& scales, const State& state,
                     common::History& history)
        : dt_(scales.dt),
          gain_hint_(theory::cell_crossing_hint(parameters)),
          most_gain_(0.05 + swing_of_frozen(parameters, scales)),
          levels_(parameters.problem.contact.levels),
          frictionless_(!parameters.problem.has_friction()),
          linear_(parameters.shape == "linear"),
          passes_all_(parameters.transfer == "flip" && parameters.flip == 1 &&
                      parameters.problem.damping == 0 && !any_viscous(parameters)),
          recorder_(parameters, leapfrog, scales, state.assembly, comparisons, "budget") {
        Budget none;
        none.momenta.resize(state.assembly.grains.size());
        history.columns(row(0, none, {}, state.assembly));
    }

    /// Writes the files that are due at this step, before it.
    void snapshot(long step, const State& state, const common::Run& run) const {
        recorder_.snapshot(step, state.assembly, run);
    }

    /// Writes the row of t^n, when the budget has the energies of the step and not yet its work.
    /// errors: NumericalError as Recorder::refuse_failure, unless the run has ended at t^n
    void record(long step, const StepSums& sums, const GrainNodes& nodes, const State& state,
                common::Run& run) {
        const Budget& b = state.budget;
        const bool finite =
            std::all_of(sums.tiles.begin(), sums.tiles.end(), [](const TileSums& s) {
                return std::isfinite(s.kinetic) && std::isfinite(s.kinetic_leapfrog);
            });
        if (finite && recorder_.row_is_due(step))
            run.history.row(row(step, b, sums.contact, state.assembly));
        if (recorder_.is_end(step)) return;
        // Elastic energy is that of t^{n-1/2} and t^{n+1/2}: what this step puts in counts.
        const double external = b.external + sums.contact.rigid + sums.nodes.gravity;
        recorder_.refuse_failure(step, sums.tiles, nodes, state.assembly, b.start, external,
                                 b.kinetic + b.elastic, run.history);
    }

    /// The results of the whole run, after its last step.
    void finish(long step, const State& state, common::Run& run) const {
        if (run.history.all().empty()) return;
        recorder_.compare_with_theory(step, state.assembly, run);
        judge_energy(theory::energy_of_drift(run.history, state.assembly), run);
        recorder_.finish_conservation(state.assembly, run);
        run.summary.conservation("largest_remap_error", run.history.largest("remap"), "energy");
    }

   private:
    common::Row row(long step, const Budget& b, const ContactSums& contact,
                    const Assembly& all) const {
        common::Row row;
        row.add("time", "time", double(step) * dt_);
        add_budget(b, row);
        recorder_.add_to(row, b.momenta, contact.nodes, contact.impulse, all);
        return row;
    }

    // With both levels contact presses without work, and all it does together takes energy. What the
    // particles have got beyond work is from contact on one level, from moving through cells, and from a
    // step too long for the leapfrog. No theorem bounds it: a twentieth of the energy says that the run has
    // gone astray. What volumes add that change is no error: a law of small strain has no energy of large ones.
    // in: drift, the energy of the center of mass, which nothing was put in for
    void judge_energy(double drift, common::Run& run) const {
        const auto contact = run.history.column("contact"), release = run.history.column("release"),
                   friction = run.history.column("friction");
        const auto energy = run.history.column("energy"), e14 = run.history.column("energy_14"),
                   external = run.history.column("external"), remap = run.history.column("remap"),
                   rest = run.history.column("budget");
        const double size = run.history.largest("kinetic") + run.history.largest("elastic");
        double works = 0, gives = 0, gain = 0, lost = 0, put_in = 0;
        for (std::size_t n = 0; n < contact.size() && size > 0; ++n) {
            works = std::max(works, std::fabs(contact[n]) / size);
            const double together = contact[n] + release[n] + friction[n];
            gives = std::max(gives, together / size);
            // What energy_14 has got from no work, and what the energy is beyond it since the start.
            const double beyond = energy[n] - e14[n] - (energy[0] - e14[0]),
                         got = remap[n] + rest[n] + beyond;
            gain = std::max(gain, got + std::max(together, 0.0));
            lost = std::max(lost, -remap[n]);
            put_in = std::max(put_in, energy[0] - drift + std::fabs(external[n]));
        }
        const std::string source = "of pairs that press, over the energy";
        run.summary.hint(levels_ != 2    ? "take contact.levels = 2"
                         : frictionless_ ? "where a grain is between two bodies that are told how "
                                           "to move, sweeps end before its pairs settle: keep "
                                           "plates that meet a grain a cell apart"
                                         : "take less friction: where sweeps end early, pairs do "
                                           "not settle");
        if (frictionless_ && levels_ == 2)
            run.summary.result_at_most("contact_works", works, "1", 1e-10, source + ": exact");
        else  // exact as well, but where sweeps end early (solve_contact_node.hpp)
            run.summary.result_info("contact_works", works, "1", source);
        const std::string together = "with release and friction, over the energy";
        if (levels_ == 2)
            run.summary.result_at_most("contact_gives", gives, "1", 1e-10, together + ": it takes");
        else
            run.summary.result_info("contact_gives", gives, "1",
                                    together + ": contact on v_i^1 alone gives");
        run.summary.hint(gain_hint_);
        run.summary.result_at_most(
            "energy_gain", gain / (put_in > 0 ? put_in : 1), "1", most_gain_,
            "beyond all work, largest, over the energy put in: moving through "
            "cells should give none");
        const std::string by_cells = "by moving through cells, largest, over the energy put in";
        lost /= put_in > 0 ? put_in : 1;
        if (!passes_all_) return run.summary.result_info("energy_lost", lost, "1", by_cells);
        run.summary.hint(
            linear_
                ? "particles of linear shapes lose force when they are pressed across lines of "
                  "nodes, and more of them on finer meshes: take method.shape = \"gimp\"; where "
                  "plates drive, lower time.alpha"
                : gain_hint_);
        run.summary.result_at_most("energy_lost", lost, "1", most_gain_, by_cells);
    }

    static bool any_viscous(const Case& parameters) {
        return std::ranges::any_of(materials_of(parameters.problem),
                                   [](const Material& m) { return m.viscosity > 0; });
    }

    // By how much the energy of frozen particles swings above energy_14, which is then exact: that of
    // the smallest oscillator.
    static double swing_of_frozen(const Case& parameters, const Scales& scales) {
        const Problem& problem = parameters.problem;
        const double w = node_oscillator_frequency(int(problem.per_side)) * scales.sound_speed /
                         problem.mesh().h;
        if (!parameters.frozen || w * scales.dt >= 2) return 0;
        return leapfrog_energy_bound(1, w, scales.dt) - 1;
    }

    double dt_;
    std::string gain_hint_;
    double most_gain_;
    long levels_;
    bool frictionless_;
    bool linear_;      // shapes
    bool passes_all_;  // to the particles, of what the nodes have got: FLIP, and nothing that damps
    Recorder recorder_;
};

}  // namespace mpm_explicit
