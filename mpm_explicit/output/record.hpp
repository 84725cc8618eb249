// What a run of mpm_explicit keeps besides what every scheme does (record_grains.hpp): the budget
// of the leapfrog.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "mpm_explicit/output/record_grains.hpp"
#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/theory/compare_with_theory.hpp"

namespace mpm_explicit {

/// Adds the terms of the budget, energies now and work since the start.
inline void add_budget(const Budget& l, common::Row& row) {
    for (const auto& [name, value] : {std::pair("kinetic", l.kinetic),
                                      {"elastic", l.elastic},
                                      {"energy", l.kinetic + l.elastic},
                                      {"energy_14", l.energy_14},
                                      {"energy_15", l.energy_15},
                                      {"external", l.external},
                                      {"contact", l.contact},
                                      {"release", l.release},
                                      {"friction", l.friction},
                                      {"bond", l.bond},
                                      {"damping", l.damping},
                                      {"viscous", l.viscous},
                                      {"plastic", l.plastic},
                                      {"volume", l.volume},
                                      {"pic", l.pic},
                                      {"remap", l.remap},
                                      {"budget", l.residual()}})
        row.add(name, "energy", value);
}

/// Writes rows and files of a run, and its results.
class LeapfrogRecorder {
   public:
    LeapfrogRecorder(const Case& parameters, const Scales& scales, const State& state,
                     common::History& history)
        : dt_(scales.dt),
          levels_(parameters.problem.contact.levels),
          frictionless_(!parameters.problem.has_friction()),
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
    /// errors: NumericalError as Recorder::refuse_failure
    void record(long step, const StepSums& sums, const GrainNodes& nodes, const State& state,
                common::Run& run) {
        const Budget& l = state.budget;
        const bool finite =
            std::all_of(sums.tiles.begin(), sums.tiles.end(), [](const TileSums& s) {
                return std::isfinite(s.kinetic) && std::isfinite(s.kinetic_leapfrog);
            });
        if (finite && recorder_.row_is_due(step))
            run.history.row(row(step, l, sums.contact, state.assembly));
        // Elastic energy is that of t^{n-1/2} and t^{n+1/2}: what this step puts in counts.
        const double external = l.external + sums.contact.rigid + sums.nodes.gravity;
        recorder_.refuse_failure(step, sums.tiles, nodes, state.assembly, l.start, external,
                                 l.kinetic + l.elastic, run.history);
    }

    /// The results of the whole run, after its last step.
    void finish(long step, const State& state, common::Run& run) const {
        if (run.history.all().empty()) return;
        recorder_.compare_with_theory(step, state.assembly, run);
        if (levels_ == 2) check_energy(run);
        recorder_.finish_conservation(state.assembly, run);
        run.summary.conservation("largest_remap_error", run.history.largest("remap"), "energy");
    }

   private:
    common::Row row(long step, const Budget& l, const ContactSums& contact,
                    const Assembly& all) const {
        common::Row row;
        row.add("time", "time", double(step) * dt_);
        add_budget(l, row);
        recorder_.add_to(row, l.momenta, contact, all);
        return row;
    }

    // Contact presses without work, all it does together takes energy, and moving through cells gives
    // none. The last is no theorem: a twentieth of the energy says that the run has gone astray.
    void check_energy(common::Run& run) const {
        const auto contact = run.history.column("contact"), release = run.history.column("release"),
                   friction = run.history.column("friction");
        const double size = run.history.largest("kinetic") + run.history.largest("elastic");
        double works = 0, gives = 0;
        for (std::size_t n = 0; n < contact.size() && size > 0; ++n) {
            works = std::max(works, std::fabs(contact[n]) / size);
            gives = std::max(gives, (contact[n] + release[n] + friction[n]) / size);
        }
        const std::string source = "of pairs that press, over the energy";
        if (frictionless_)
            run.summary.result("contact_works", works, "1", 0, 1e-10, source + ": exact");
        else  // exact as well, but where sweeps end early (solve_contact_node.hpp)
            run.summary.result_info("contact_works", works, "1", source);
        run.summary.result_within("contact_gives", gives, "1", 0, 1e-10,
                                  "with release and friction, over the energy: it takes");
        const auto remap = run.history.column("remap");
        const double gain = *std::max_element(remap.begin(), remap.end());
        run.summary.result("remap_gives", size > 0 ? gain / size : 0, "1", 0, 0.05,
                           "energy that particles gain by moving through cells");
    }

    double dt_;
    long levels_;
    bool frictionless_;
    Recorder recorder_;
};

}  // namespace mpm_explicit
