// One row of history per step, snapshots when they are due, results at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/run/run.hpp"
#include "common/run/sentence.hpp"
#include "flip/output/judge_inflow.hpp"
#include "flip/output/write_output.hpp"
#include "flip/setup/scales.hpp"
#include "flip/theory/comparisons.hpp"

namespace flip {

/// Largest speed and Mach number of a cell.
struct Extremes {
    double speed = 0, mach = 0;
};

/// The largest speed and Mach number.
/// note:   the sound speed is that of the material with most mass in the cell; cells without sound,
///         as dust, have no Mach number
inline Extremes extremes(const Case& parameters, const CellFields& cells) {
    Extremes most;
    visit_cells(parameters.grid, [&](long c, double, double) {
        if (!(cells.rho[c] > 0)) return;
        std::size_t main = 0;
        for (std::size_t k = 1; k < cells.rho_of.size(); ++k)
            if (cells.rho_of[k][c] > cells.rho_of[main][c]) main = k;
        double speed = std::hypot(cells.vx[c], cells.vz[c]);
        if (cells.v_theta.size() > 0) speed = std::hypot(speed, cells.v_theta[c]);
        const double sound2 = stiffness(parameters.materials[main], cells.p[c]) / cells.rho[c];
        most.speed = std::max(most.speed, speed);
        if (sound2 > 0) most.mach = std::max(most.mach, speed / std::sqrt(sound2));
    });
    return most;
}

/// What the loop hands its results to. A row belongs to t^n: particles, cells and totals of that
/// time, and the step that led to it.
///   mass_error:     (mass - budget.mass - first) / first
///   momentum_error: (momentum - budget.momentum - first) / (sqrt(2 kinetic mass) + mass c), with
///                   kinetic energy and mass of the start, c its largest sound speed
///   angular_momentum_error: the same about the axis, over that times the radius of the mesh
///   energy_error:   (energy - budget.energy - first) / first
/// note:   where the start has nothing to compare with, what has come in since then takes its place
class Recorder {
   public:
    Recorder(const Case& parameters, const std::string& program, common::History& history)
        : parameters_(parameters), program_(program) {
        for (const RegionCase& r : parameters.regions) {
            if (r.is_vacuum()) continue;
            sound_speed_ =
                std::max(sound_speed_, r.has_formula() ? scales_of(parameters, program).sound_speed
                                                       : sound_speed_of(parameters, r));
        }
        CellFields empty;
        for (Field* f : {&empty.rho, &empty.vx, &empty.vz, &empty.p, &empty.e})
            *f = Field::Zero(parameters.grid.size());
        if (parameters.swirls()) empty.v_theta = empty.rho;
        empty.rho_of.assign(parameters.materials.size(), empty.rho);
        history.columns(row_of({}, {}, empty, history));
    }

    /// Writes the files of t^n that are due, and adds its row to the history.
    /// errors: NumericalError when the energy is not finite or has left the limit of the case
    void record(long step, const State& state, const Totals& now, const CellFields& cells,
                common::Run& run) const {
        const common::Snapshot at{run.path("."), step, state.time, parameters_.also};
        // At the end, too.
        const auto due = [&](double interval) {
            return is_due(interval, state) ||
                   (interval > 0 && common::Run::reached(state.time, parameters_.end));
        };
        if (due(parameters_.fields_interval)) write_fields(at, parameters_, cells);
        if (due(parameters_.particles_interval)) write_particles(at, parameters_, state.particles);
        const double energy = now.kinetic + now.internal;
        const bool is_first = run.history.all().empty();
        check_energy(step, state, energy, is_first ? energy : run.history.first("energy"));
        run.history.row(row_of(state, now, cells, run.history));
    }

    /// The results of the whole run.
    /// in:     the state at its end, with its totals and cells
    void finish(const State& state, const Totals& now, const CellFields& cells,
                common::Run& run) const {
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        if (history.all().empty()) return;
        const Comparison& comparison = comparison_of(parameters_);
        if (comparison.compare != nullptr && history.rows() > 1)
            comparison.compare({parameters_, program_, state, now, cells, history,
                                run.path("profile.dat"), summary});
        if (comparison.compare != nullptr && !summary.has_verdict())
            summary.not_measured(comparison.name, "the run is too short for it: raise time.end");
        if (history.rows() > 1) judge_inflows(parameters_, state.time, cells, summary);
        if (history.rows() > 1) judge_energy(history, summary);
        if (history.rows() > 1) judge_volume(history, summary);
        if (history.rows() > 1) judge_heat(history, summary);
        std::vector<std::string> errors{"mass_error", "momentum_x_error", "energy_error"};
        if (parameters_.moves_along_z()) errors.insert(errors.begin() + 2, "momentum_z_error");
        if (parameters_.swirls()) errors.insert(errors.end() - 1, "angular_momentum_error");
        for (const std::string& name : errors)
            summary.conservation("largest_" + name, history.largest(name), "1");
        summary.performance("particles", double(state.particles.count()));
    }

   private:
    // The quantities of t^n, each beside its name and unit.
    common::Row row_of(const State& state, Totals now, const CellFields& cells,
                       const common::History& history) const {
        const auto first = [&](const char* name, double value) {
            return history.all().empty() ? value : history.first(name);
        };
        const auto relative = [](double change, double before, double came_in) {
            const double scale = before > 0 ? before : std::fabs(came_in);
            return scale > 0 ? change / scale : 0.0;
        };
        Budget budget = state.budget;
        // Around an axis momenta that point outward cancel.
        const bool rings = parameters_.grid.axisymmetric, plane = parameters_.moves_along_z(),
                   swirl = parameters_.swirls();
        if (rings) now.momentum_x = budget.momentum_x = 0;
        if (rings && !swirl) now.angular_momentum = 0;
        const std::string per_length = rings ? "" : "/length";
        const double mass = first("mass", now.mass), kinetic = first("kinetic", now.kinetic);
        const double energy = now.kinetic + now.internal, gross = first("energy", energy);
        const double momentum = std::sqrt(2 * kinetic * mass) + mass * sound_speed_;
        const auto momentum_error = [&](const char* name, double value, double came_in) {
            return relative(value - came_in - first(name, value), momentum, came_in);
        };
        const Extremes most = extremes(parameters_, cells);
        common::Row row;
        row.add("time", "time", state.time);
        row.add("dt", "time", state.dt);
        row.add("energy", "energy" + per_length, energy);
        row.add("kinetic", "energy" + per_length, now.kinetic);
        row.add("internal", "energy" + per_length, now.internal);
        row.add("mass", "mass" + per_length, now.mass);
        row.add("momentum_x", "momentum" + per_length, now.momentum_x);
        if (plane) row.add("momentum_z", "momentum" + per_length, now.momentum_z);
        if (plane || swirl)
            row.add("angular_momentum", swirl ? "momentum length" : "momentum",
                    now.angular_momentum);
        row.add("mass_error", "1", relative(now.mass - budget.mass - mass, mass, budget.mass));
        row.add("momentum_x_error", "1",
                momentum_error("momentum_x", now.momentum_x, budget.momentum_x));
        if (plane)
            row.add("momentum_z_error", "1",
                    momentum_error("momentum_z", now.momentum_z, budget.momentum_z));
        if (swirl)
            row.add("angular_momentum_error", "1",
                    relative(now.angular_momentum - budget.angular_momentum -
                                 first("angular_momentum", now.angular_momentum),
                             momentum * parameters_.grid.x.length, budget.angular_momentum));
        row.add("energy_error", "1",
                relative(energy - budget.energy - gross, gross, budget.energy));
        row.add("largest_speed", "velocity", most.speed);
        if (judges_volume()) row.add("overfull", "1", cells.overfull);
        if (judges_heat()) row.add("compressed", "energy" + per_length, compressed(cells));
        row.add("largest_mach", "1", most.mach);
        row.add("iterations", "1", double(state.report.iterations));
        row.add("divergence", "speed/dx", state.report.divergence);
        const Comparison& comparison = comparison_of(parameters_);
        if (comparison.track != nullptr) comparison.track({parameters_, state, now, cells}, row);
        return row;
    }

    // Energy less what came in at the ends and from forces is kept to round-off: kinetic energy that a
    // transfer to particles takes becomes heat; where it does not, the transfer only takes.
    void judge_energy(const common::History& history, common::Summary& summary) const {
        // A part in 1e12, and ten units in the last place in a step, of the largest energy.
        const double steps = double(history.rows() - 1), first = history.first("energy"),
                     times = first > 0 ? history.largest("energy") / first : 1,
                     round_off =
                         times * (1e-12 + 10 * std::numeric_limits<double>::epsilon() * steps);
        const std::vector<double> error = history.column("energy_error");
        const auto [least, most] = std::ranges::minmax(error);
        summary.hint(
            "no step of the scheme makes or loses energy, so that the run has gone astray: lower "
            "time.cfl, or flip.tolerance of an implicit pressure");
        if (program_ == "pic" || parameters_.deficit_to_heat)
            return summary.result_at_most("energy_error", std::max(most, -least), "", round_off,
                                          "largest, over the start: exact but for round-off");
        summary.result_at_most("energy_gain", most, "", round_off,
                               "largest, over the start: the transfer to particles only takes");
        summary.result_info("energy_lost", -least, "",
                            "what the transfer takes, for flip.deficit_to_heat = false");
    }

    bool judges_volume() const {
        return program_ == "flip" && parameters_.density == "particles" &&
               std::ranges::any_of(parameters_.materials,
                                   [](const Material& m) { return m.p_infinity > 0; });
    }

    // Liquid that lies where other liquid is takes no room, and its level sinks: a twentieth is seen.
    void judge_volume(const common::History& history, common::Summary& summary) const {
        if (!judges_volume()) return;
        summary.hint(!parameters_.implicit()
                         ? "nothing in an explicit step brings particles back to their volumes: "
                           "take flip.pressure = \"implicit\""
                     : parameters_.transfer == "xpic"
                         ? "particles gather faster than they are spread: raise "
                           "particles.per_cell_x and per_cell_z"
                         : "particles gather faster than they are spread: take flip.transfer = "
                           "\"xpic\", or raise particles.per_cell_x and per_cell_z");
        summary.result_at_most("overfull", history.largest("overfull") - history.first("overfull"),
                               "", 0.05,
                               "part of all volume that liquid has beyond its cells, largest, over "
                               "that of the start");
    }

    // Of liquids alone whose density is that of the cells.
    bool judges_heat() const {
        return program_ == "flip" && parameters_.density == "cells" &&
               std::ranges::all_of(parameters_.materials,
                                   [](const Material& m) { return m.p_infinity > 0; });
    }

    // What liquid can give by expanding to p = 0, or somewhat more: sum of V p^2/(2 gamma p_infinity).
    double compressed(const CellFields& cells) const {
        double softest = std::numeric_limits<double>::infinity(), sum = 0;
        for (const Material& m : parameters_.materials)
            softest = std::min(softest, stiffness(m, 0));
        const Grid& grid = parameters_.grid;
        visit_cells(grid, [&](long n, double, double) {
            sum += cell_volume(grid, column_of(grid, n)) * cells.p[n] * cells.p[n];
        });
        return sum / (2 * softest);
    }

    // Energy is kept also where noise moves a liquid, for it cools: below what it has at p = 0, which
    // no flow of it can do.
    void judge_heat(const common::History& history, common::Summary& summary) const {
        const std::vector<double> mass = history.column("mass");
        const bool closed = std::fabs(mass.back() - mass.front()) <= 1e-9 * mass.front();
        if (!judges_heat() || !closed) return;
        const double least = history.first("internal") - history.first("compressed");
        double taken = 0, kinetic = 1e-11 * history.first("internal");
        for (const double now : history.column("internal")) taken = std::max(taken, least - now);
        for (const double now : history.column("kinetic")) kinetic = std::max(kinetic, now);
        summary.hint(
            "cells miscount the particles of a liquid, and that is pressure which moves it: set "
            "flip.density = \"particles\"");
        summary.result_at_most("kinetic_from_heat", taken / kinetic, "", 0.1,
                               "what the liquid has cooled by beyond p = 0, largest, over the "
                               "largest kinetic energy");
    }

    // An energy that is many times what the start and the work done account for is no result.
    void check_energy(long step, const State& state, double energy, double gross) const {
        const double accounted = gross + std::fabs(state.budget.energy);
        const bool beyond = parameters_.energy_limit > 0 &&
                            std::fabs(energy) > parameters_.energy_limit * accounted;
        if (std::isfinite(energy) && !beyond) return;
        common::fail("the energy is ", energy, " where the start and the work done are ", accounted,
                     ", at step ", step, ", t = ", state.time,
                     ": reduce time.cfl, refine the mesh, or allow more with time.energy_limit");
    }

    const Case parameters_;
    const std::string program_;
    double sound_speed_ = 0;  // the largest of the start
};

}  // namespace flip
