// One row of history per step, snapshots when they are due, results at the end.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/run/run.hpp"
#include "flip/output/write_output.hpp"
#include "flip/theory/compare_with_theory.hpp"

namespace flip {

/// What the loop hands its results to. A row belongs to t^n: particles, cells and totals of that
/// time, and the step that led to it.
///   mass_error:     (mass - budget.mass - first) / first
///   momentum_error: (momentum - budget.momentum - first) / (sqrt(2 kinetic mass) + mass c), with
///                   kinetic energy and mass of the start, c its largest sound speed
///   energy_error:   (energy - budget.energy - first) / first
/// note:   where the start has nothing to compare with, what has come in since then takes its place
class Recorder {
   public:
    Recorder(const Case& parameters, const std::string& program, common::History& history)
        : parameters_(parameters),
          program_(program),
          sound_speed_(largest_sound_speed(parameters)) {
        std::vector<common::Column> columns{{"time", "time"},
                                            {"dt", "time"},
                                            {"energy", "energy/length"},
                                            {"kinetic", "energy/length"},
                                            {"internal", "energy/length"},
                                            {"mass", "mass/length"},
                                            {"momentum_x", "momentum/length"},
                                            {"momentum_z", "momentum/length"},
                                            {"angular_momentum", "momentum"},
                                            {"mass_error", "1"},
                                            {"momentum_x_error", "1"},
                                            {"momentum_z_error", "1"},
                                            {"energy_error", "1"},
                                            {"largest_speed", "velocity"},
                                            {"largest_mach", "1"},
                                            {"iterations", "1"},
                                            {"divergence", "speed/dx"}};
        for (const common::Column& column : followed_columns(parameters)) columns.push_back(column);
        history.columns(columns);
    }

    /// The files of t^n that are due, and its row.
    void look(long step, const State& state, const Totals& now, const CellFields& cells,
              common::Run& run) {
        snapshot(step, state, cells, run);
        record(step, state, now, cells, run);
    }

    /// Files of t^n.
    void snapshot(long step, const State& state, const CellFields& cells, common::Run& run) const {
        const std::string folder = run.path(".");
        if (is_due(parameters_.fields_interval, state))
            write_fields(folder, step, parameters_, cells);
        if (is_due(parameters_.particles_interval, state))
            write_particles(folder, step, parameters_, state.particles);
    }

    /// One row for t^n.
    /// errors: NumericalError when the energy is not finite or has left the limit of the case
    void record(long step, const State& state, const Totals& now, const CellFields& cells,
                common::Run& run) {
        const common::History& history = run.history;
        const bool is_first = history.all().empty();
        const auto first = [&](const char* name, double value) {
            return is_first ? value : history.first(name);
        };
        const auto relative = [](double change, double before, double came_in) {
            const double scale = before > 0 ? before : std::fabs(came_in);
            return scale > 0 ? change / scale : 0.0;
        };
        const Budget& budget = state.budget;
        const double mass = first("mass", now.mass), kinetic = first("kinetic", now.kinetic);
        const double energy = now.kinetic + now.internal, gross = first("energy", energy);
        check_energy(step, state, energy, gross);

        const double momentum = std::sqrt(2 * kinetic * mass) + mass * sound_speed_;
        const Extremes most = extremes(parameters_, cells);
        row_ = {state.time,
                state.dt,
                energy,
                now.kinetic,
                now.internal,
                now.mass,
                now.momentum_x,
                now.momentum_z,
                now.angular_momentum,
                relative(now.mass - budget.mass - mass, mass, budget.mass),
                relative(now.momentum_x - budget.momentum_x - first("momentum_x", now.momentum_x),
                         momentum, budget.momentum_x),
                relative(now.momentum_z - budget.momentum_z - first("momentum_z", now.momentum_z),
                         momentum, budget.momentum_z),
                relative(energy - budget.energy - gross, gross, budget.energy),
                most.speed,
                most.mach,
                static_cast<double>(state.report.iterations),
                state.report.divergence};
        add_followed(parameters_, state, now, cells, row_);
        run.history.row(row_);
    }

    /// The results of the whole run.
    /// in:     the state at its end, with its totals and cells
    void finish(const State& state, const Totals& now, const CellFields& cells,
                common::Run& run) const {
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        if (history.all().empty()) return;
        compare_with_theory(
            {parameters_, program_, state, now, cells, history, run.path("profile.dat"), summary});
        for (const char* name :
             {"mass_error", "momentum_x_error", "momentum_z_error", "energy_error"})
            summary.conservation(std::string("largest_") + name, largest(history, name), "1");
        summary.performance("particles", static_cast<double>(state.particles.count()));
    }

   private:
    // An energy that is many times what the start and the work done account for is no result.
    void check_energy(long step, const State& state, double energy, double gross) const {
        const double accounted = gross + std::fabs(state.budget.energy);
        const bool beyond = parameters_.energy_limit > 0 &&
                            std::fabs(energy) > parameters_.energy_limit * accounted;
        if (std::isfinite(energy) && !beyond) return;
        throw common::NumericalError(
            "the energy is " + format(energy) + " where the start and the work done are " +
            format(accounted) + ", at step " + std::to_string(step) +
            ", t = " + format(state.time) +
            ": reduce time.cfl, refine the mesh, or allow more with time.energy_limit");
    }

    const Case parameters_;
    const std::string program_;
    const double sound_speed_;
    std::vector<double> row_;
};

}  // namespace flip
