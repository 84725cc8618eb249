// One row of history per step, snapshots when they are due, results at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cic/output/diagnostics.hpp"
#include "cic/output/judge_conservation.hpp"
#include "cic/output/write_output.hpp"
#include "cic/theory/comparisons.hpp"
#include "common/run/run.hpp"
#include "common/run/sentence.hpp"

namespace cic {

/// What the loop hands its results to; it changes nothing of them. A row belongs to t^n: charge,
/// field and positions of that time, kinetic energy centered there, momentum half a step later.
class Recorder {
   public:
    /// in:     state at t = 0; history gets its columns
    Recorder(const Case& parameters, const State& state, common::History& history)
        : parameters_(parameters), comparison_(comparison_of(parameters)) {
        add_mode("mode", comparison_.recorded_mode_x(parameters), parameters.mode_z);
        for (long m = 1; m <= parameters.modes; ++m) add_mode("E_" + std::to_string(m), m, 0);
        const Grid& grid = parameters.grid;
        background_ = fixed_background(parameters) * grid.x.length * grid.z.length;
        double charge = 0;
        for (const SpeciesCase& s : parameters.species)
            charge += std::fabs(s.charge) * s.mean_density() * filled_volume(parameters, s);
        const double round_off = 100 * double(std::numeric_limits<Real>::epsilon());
        least_energy_ = std::pow(round_off * charge, 2) * grid.x.length / grid.z.length;

        record_positions(state);
        const Field nothing = Field::Zero(grid.size());
        history.columns(row(0, state, nothing, {nothing, {}, state.walls}, {}));
    }

    /// Before the particles move on: the files of t^n that are due, and what the row needs of the
    /// positions.
    void snapshot(long step, const State& state, const Field& rho_g, const FieldState& field,
                  common::Run& run) {
        record_positions(state);
        const common::Snapshot at{run.path("."), step, double(step) * parameters_.dt,
                                  parameters_.also};
        if (due(parameters_.fields_interval, step))
            write_fields(at, parameters_, state, rho_g, field);
        if (due(parameters_.particles_interval, step)) write_particles(at, parameters_, state);
        if (due(parameters_.phase_interval, step)) write_phase_space(at, parameters_, state);
    }

    /// One row for t^n, with the sums that the mover has made.
    /// errors: NumericalError when the energy is not finite or has left the limit of the case
    void record(long step, const State& state, const Field& rho_g, const FieldState& field,
                common::Run& run) const {
        Energies now;
        for (const Particles& s : state.species) now.kinetic += s.sums.kinetic;
        now.field = field_energy(parameters_.grid, rho_g, field);
        Energies first = now;
        if (!run.history.all().empty())
            first = {run.history.first("kinetic"), run.history.first("field")};
        now.change = now.sum() - first.sum(), now.at_start = first.size();
        check_energy(step, now);
        run.history.row(row(step, state, rho_g, field, now));
    }

    /// The results of the whole run, after its last row.
    void finish(const State& state, common::Run& run) const {
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        if (history.all().empty()) return;
        comparison_.add_results(parameters_, history, summary);
        if (parameters_.compare != "none" && !summary.has_verdict())
            summary.not_measured(parameters_.compare,
                                 "the run is too short for it: raise time.end");
        judge_energy(history, summary);
        judge_momentum(parameters_, least_energy_, history, summary);
        judge_rest(parameters_, history, summary);
        warn_of_pile_up(state, history.column("time").back(), summary);
        summary.conservation("largest_energy_drift", history.largest("energy_drift"), "1");
        summary.conservation("largest_charge_error", history.largest("charge_error"), "1");
        const auto p_x = history.column("momentum_x");
        summary.conservation("momentum_x_change", p_x.back() - p_x.front(), "n0*m*velocity*volume");
        summary.performance("particles", double(state.count()));
        if (common::rank_count() > 1) summary.performance("imbalance", imbalance(state));
        if (parameters_.spectrum) write_spectrum(run.path("spectrum.dat"), parameters_, history);
    }

   private:
    // Whether no particle goes through the ends of the mesh: walls reflect.
    bool keeps_energy() const {
        for (std::size_t k = 0; k < 4; ++k) {
            const bool there = (k < 2 ? parameters_.boundary_x : parameters_.boundary_z) == "wall";
            if (there && parameters_.walls[k].particles != "reflect") return false;
        }
        return true;
    }

    // The energy less what batteries have given that hold walls at their potentials, sum V (Q - Q_0).
    std::vector<double> energy_without_batteries(const common::History& history) const {
        auto energy = history.column("energy");
        for (std::size_t k = 0; k < 4; ++k) {
            const double V = parameters_.walls[k].potential;
            if (V == 0) continue;
            const auto Q = history.column(std::string("charge_") + wall_names[k]);
            const double area = (k < 2 ? parameters_.grid.z : parameters_.grid.x).length;
            for (std::size_t n = 0; n < Q.size(); ++n) energy[n] -= V * area * (Q[n] - Q[0]);
        }
        return energy;
    }

    // Whether energy was kept, of its start or, where that is nothing, of its largest.
    void judge_energy(const common::History& history, common::Summary& summary) const {
        if (!keeps_energy() || parameters_.gauss_sign < 0) return;
        const auto energy = energy_without_batteries(history);
        double change = 0, largest = 0;
        for (const double one : energy) {
            change = std::max(change, std::fabs(one - energy.front()));
            largest = std::max(largest, std::fabs(one));
        }
        // The field of a bias is no energy of the plasma.
        const bool biased = std::ranges::any_of(
            parameters_.walls, [](const WallCase& wall) { return wall.potential != 0; });
        const double own = biased ? history.first("kinetic") : energy.front();
        const double scale = own > 1e-3 * largest ? own : largest;
        const Scheme scheme = parameters_.scheme();
        const bool conserving = scheme.energy_conserving;
        std::string of_step = heats_in_step(parameters_);
        if (of_step.empty() && biased)
            of_step =
                "walls that have a field reflect particles to first order in the step: "
                "lower time.dt";
        summary.hint(
            !of_step.empty()
                ? of_step
                : sentence(
                      "the mesh heats what it does not resolve, few particles are noise, and the "
                      "leapfrog heats what swings within a step: raise grid.cells_x or "
                      "particles_per_cell, ",
                      conserving && scheme.order == 2 ? ""
                      : conserving                    ? "take method.weighting = \"tsc\", "
                      : scheme.order == 2
                          ? "take method.scheme = \"energy\", "
                          : "take method.scheme = \"energy\" or method.weighting = \"tsc\", ",
                      "or lower time.dt"));
        // Of the field of a wave on nodes the momentum scheme turns cos^2(k dx/2) into motion.
        double limit = 0.05;
        if (!conserving && comparison_.follows_mode) {
            const WaveVector k = wave_vector(parameters_, comparison_.recorded_mode_x(parameters_),
                                             parameters_.mode_z);
            limit += (std::pow(std::sin(0.5 * k.x * parameters_.grid.x.spacing()), 2) +
                      std::pow(std::sin(0.5 * k.z * parameters_.grid.z.spacing()), 2)) *
                     std::min(1.0, history.largest("field") / scale);
        }
        if (scale > least_energy_)
            summary.result_at_most("energy_change", change / scale, "", limit,
                                   "energy is conserved, but for the mesh and the step");
    }

    // Where particles of a source stay in the box, however often they come back to it.
    void warn_of_pile_up(const State& state, double end, common::Summary& summary) const {
        std::size_t mobile = 0;
        for (const SpeciesCase& s : parameters_.species) {
            if (!s.mobile()) continue;
            const std::size_t k = mobile++;
            const double weight = state.species[k].m_p / s.mass,
                         emitted = emitted_per_step(parameters_, s, weight) * end / parameters_.dt,
                         first = double(particle_count(parameters_, s)),
                         now = double(state.species[k].count_of_all()),
                         again = double(state.emitted_again[k]);
            if (!(emitted > std::max(first, 100.0) && now - first > 0.9 * emitted &&
                  again > emitted))
                continue;
            summary.late_warnings.push_back(sentence(
                s.name, ": of ", emitted, " particles from the source ", now - first,
                " are in the box, and it has sent them back ", again,
                " times: they pile up without end; let them reach a wall that absorbs, by its "
                "potential, particles_x_high or a weaker field B across, or lower the emission"));
        }
    }

    struct Energies {
        double kinetic = 0, field = 0;
        double change = 0;    // of their sum, since the start
        double at_start = 0;  // the sum of their sizes
        double sum() const { return kinetic + field; }
        double size() const { return kinetic + std::fabs(field); }
    };

    void add_mode(const std::string& name, long mode_x, long mode_z) {
        const double k = wave_vector(parameters_, mode_x, mode_z).size();
        modes_.push_back({name, {parameters_.grid, mode_x, mode_z, k}});
    }

    // Columns and values of one row.
    common::Row row(long step, const State& state, const Field& rho_g, const FieldState& field,
                    const Energies& now) const {
        const std::string energy = "n0*m*velocity^2*volume", momentum = "n0*m*velocity*volume";
        const Grid& grid = parameters_.grid;
        common::Row row;
        row.add("time", "1/omega_p", double(step) * parameters_.dt);
        row.add("energy", energy, now.sum());
        row.add("energy_drift", "1", now.at_start > 0 ? now.change / now.at_start : 0);
        row.add("kinetic", energy, now.kinetic);
        row.add("field", energy, now.field);
        row.add("charge_error", "1", charge_error(charge_on_mesh(grid, rho_g), state));
        ParticleSums all;
        for (const Particles& s : state.species) {
            row.add("kinetic_" + s.name, energy, s.sums.kinetic);
            all.add(s.sums);
        }
        row.add("momentum_x", momentum, all.momentum[0]);
        const bool plane = parameters_.dimensions == 2, magnetized = parameters_.magnetized();
        if (magnetized) row.add("momentum_y", momentum, all.momentum[1]);
        if (magnetized || plane) row.add("momentum_z", momentum, all.momentum[2]);
        const auto add_amplitude = [&](std::size_t m) {
            const auto& [name, mode] = modes_[m];
            row.add(name, "m*velocity*omega_p/e", mode.amplitude(grid, field.phi));
        };
        add_amplitude(0);
        if (parameters_.has_walls()) {
            for (const Particles& s : state.species)
                row.add("count_" + s.name, "1", double(s.count_of_all()));
            for (std::size_t k = 0; k < 4; ++k) {
                row.add(std::string("charge_") + wall_names[k], "e/area", field.walls[k].charge);
                row.add(std::string("potential_") + wall_names[k], "m*velocity^2/e",
                        field.walls[k].potential);
            }
            row.add("potential_middle", "m*velocity^2/e",
                    field.phi[grid.index(grid.x.cells / 2, grid.z.cells / 2)]);
        }
        for (std::size_t k = 0; k < of_positions_.values.size(); ++k) {
            const common::Column& column = of_positions_.columns[k];
            row.add(column.name, column.unit, of_positions_.values[k]);
        }
        for (std::size_t m = 1; m < modes_.size(); ++m) add_amplitude(m);
        return row;
    }

    // Whether a snapshot of the given interval falls on this step; one falls on the last.
    bool due(double interval, long step) const {
        const double every = std::max(1.0, std::round(interval / parameters_.dt));
        const bool last = step == std::lround(parameters_.end / parameters_.dt);
        return interval > 0 && (last || std::fmod(double(step), every) == 0);
    }

    // Charge on the mesh less that of background and particles, relative to their sizes.
    double charge_error(double on_mesh, const State& state) const {
        double expected = background_, size = std::fabs(background_);
        for (const Particles& s : state.species) {
            expected += s.q_p * double(s.count_of_all());
            size += std::fabs(s.q_p) * double(s.count_of_all());
        }
        return size > 0 ? (on_mesh - expected) / size : 0;
    }

    // A cold plasma at rest has almost no energy to compare with: there a change must also be as
    // large as what particles and field have now, and larger than round-off makes it.
    void check_energy(long step, const Energies& now) const {
        const bool limited = parameters_.energy_limit > 0 && !parameters_.has_walls();
        const double change = std::fabs(now.change);
        const bool exceeded = limited && now.at_start > 0 && now.size() > least_energy_ &&
                              change > (parameters_.energy_limit - 1) * now.at_start &&
                              change > 0.5 * now.size();
        if (std::isfinite(now.sum()) && !exceeded) return;
        common::fail("the energy is ", now.sum(), " and was ", now.sum() - now.change,
                     " at the start, at step ", step, ", t = ", double(step) * parameters_.dt,
                     ": reduce time.dt, refine the mesh, ",
                     parameters_.weighting == "ngp"           ? "take method.weighting = \"cic\", "
                     : parameters_.scheme().energy_conserving ? ""
                                                              : "take method.scheme = \"energy\", ",
                     "or allow more with time.energy_limit");
    }

    void record_positions(const State& state) {
        of_positions_ = {};
        comparison_.add_columns(parameters_, state.species, of_positions_);
    }

    const Case& parameters_;
    const Comparison& comparison_;
    std::vector<std::pair<std::string, FourierMode>> modes_;  // by the names of their columns

    double background_ = 0;     // charge of the fixed species
    double least_energy_ = 0;   // of the field that round-off of all charges makes
    common::Row of_positions_;  // columns that need the positions of t^n
};

}  // namespace cic
