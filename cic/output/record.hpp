// One row of history per step, snapshots when they are due, results at the end.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cic/output/diagnostics.hpp"
#include "cic/output/write_output.hpp"
#include "cic/setup/check_case.hpp"
#include "common/run/run.hpp"

namespace cic {

/// What the loop hands its results to. A row belongs to t^n: charge, field and positions of that
/// time, kinetic energy centered there, momentum half a step later.
class Recorder {
   public:
    Recorder(const Case& parameters, const State& state, common::History& history)
        : parameters_(parameters) {
        long mode_x = parameters.mode_x;
        if (parameters.compare == "wave") mode_x = theory_of_wave(parameters).mode_x;
        meters_.push_back(meter(mode_x, parameters.mode_z));
        for (long m = 1; m <= parameters.modes; ++m) meters_.push_back(meter(m, 0));
        background_ =
            fixed_background(parameters) * parameters.grid.x.length * parameters.grid.z.length;
        double charge = 0;
        for (const SpeciesCase& s : parameters.species)
            charge += std::fabs(s.charge) * s.density * filled_volume(parameters, s);
        const double round_off = 100 * static_cast<double>(std::numeric_limits<Real>::epsilon());
        least_energy_ =
            std::pow(round_off * charge, 2) * parameters.grid.x.length / parameters.grid.z.length;

        const std::string energy = "n0*m*velocity^2*volume", momentum = "n0*m*velocity*volume";
        std::vector<common::Column> columns{{"time", "1/omega_p"}, {"energy", energy},
                                            {"energy_drift", "1"}, {"kinetic", energy},
                                            {"field", energy},     {"charge_error", "1"}};
        for (const Particles& s : state.species) columns.push_back({"kinetic_" + s.name, energy});
        for (const char* a : {"x", "y", "z"})
            columns.push_back({std::string("momentum_") + a, momentum});
        columns.push_back({"mode_re", field_unit_});
        columns.push_back({"mode_im", field_unit_});
        if (parameters.has_walls()) {
            for (const Particles& s : state.species) columns.push_back({"count_" + s.name, "1"});
            for (const std::string end : {"x_low", "x_high", "z_low", "z_high"}) {
                columns.push_back({"charge_" + end, "e/area"});
                columns.push_back({"potential_" + end, "m*velocity^2/e"});
            }
            columns.push_back({"potential_middle", "m*velocity^2/e"});
        }
        if (parameters.compare == "clouds") columns.push_back({"separation_x", "length"});
        for (long m = 1; m <= parameters.modes; ++m) {
            columns.push_back({"E_" + std::to_string(m) + "_re", field_unit_});
            columns.push_back({"E_" + std::to_string(m) + "_im", field_unit_});
        }
        history.columns(columns);
    }

    /// Files of t^n, before the particles move on.
    void snapshot(long step, const State& state, const Field& rho_g, const FieldState& field,
                  common::Run& run) {
        if (parameters_.compare == "clouds") note_clouds(state);
        const std::string folder = run.path(".");
        if (due(parameters_.fields_interval, step))
            write_fields(folder, step, parameters_, state, rho_g, field);
        if (due(parameters_.particles_interval, step))
            write_particles(folder, step, parameters_, state);
        if (due(parameters_.phase_interval, step))
            write_phase_space(folder, step, parameters_, state);
    }

    /// One row for t^n, with the sums that the mover has made.
    /// errors: NumericalError when the energy is not finite or has left the limit of the case
    void record(long step, const State& state, const Field& rho_g, const FieldState& field,
                common::Run& run) {
        const Grid& grid = parameters_.grid;
        const double time = static_cast<double>(step) * parameters_.dt;
        ParticleSums all;
        for (const Particles& s : state.species) all.add(s.sums);
        const double in_field = field_energy(grid, parameters_.scheme(), rho_g, field);
        const double energy = all.kinetic + in_field;
        const common::History& history = run.history;
        const bool first = history.all().empty();
        const double initial = first ? energy : history.first("energy");
        const double gross = first ? all.kinetic + std::fabs(in_field)
                                   : history.first("kinetic") + std::fabs(history.first("field"));
        const double drift = gross > 0 ? (energy - initial) / gross : 0;
        check_energy(step, time, energy, energy - initial, gross,
                     all.kinetic + std::fabs(in_field));

        const double charge = charge_on_mesh(grid, rho_g);
        row_ = {time, energy, drift, all.kinetic, in_field, charge_error(charge, state)};
        for (const Particles& s : state.species) row_.push_back(s.sums.kinetic);
        row_.insert(row_.end(), all.momentum.begin(), all.momentum.end());
        const auto add_mode = [&](const FourierMode& meter) {
            const std::complex<double> mode = meter.amplitude(grid, field.phi);
            row_.insert(row_.end(), {mode.real(), mode.imag()});
        };
        add_mode(meters_[0]);
        if (parameters_.has_walls()) {
            for (const Particles& s : state.species) row_.push_back(static_cast<double>(s.count()));
            for (const Wall& wall : field.walls)
                row_.insert(row_.end(), {wall.charge, wall.potential});
            row_.push_back(field.phi[grid.index(grid.x.cells / 2, grid.z.cells / 2)]);
        }
        if (parameters_.compare == "clouds") row_.push_back(separation_);
        for (std::size_t m = 1; m < meters_.size(); ++m) add_mode(meters_[m]);
        run.history.row(row_);
    }

    /// The results of the whole run, after its last row.
    void finish(const State& state, common::Run& run) const {
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        if (history.all().empty()) return;
        compare_with_theory(parameters_, history, summary);
        const auto largest = [&](const char* name) {
            double most = 0;
            for (const double value : history.column(name)) most = std::max(most, std::fabs(value));
            return most;
        };
        summary.conservation("largest_energy_drift", largest("energy_drift"), "1");
        summary.conservation("largest_charge_error", largest("charge_error"), "1");
        const auto p_x = history.column("momentum_x");
        summary.conservation("momentum_x_change", p_x.back() - p_x.front(), "n0*m*velocity*volume");
        summary.performance("particles", static_cast<double>(state.count()));
        if (parameters_.spectrum) write_spectrum(run.path("spectrum.dat"), parameters_, history);
    }

   private:
    FourierMode meter(long mode_x, long mode_z) const {
        return {parameters_.grid, mode_x, mode_z, wave_vector(parameters_, mode_x, mode_z).size()};
    }

    // Whether a snapshot of the given interval falls on this step.
    bool due(double interval, long step) const {
        const double every = std::max(1.0, std::round(interval / parameters_.dt));
        return interval > 0 && std::fmod(static_cast<double>(step), every) == 0;
    }

    // Charge on the mesh less that of background and particles, relative to their sizes.
    double charge_error(double on_mesh, const State& state) const {
        double expected = background_, size = std::fabs(background_);
        for (const Particles& s : state.species) {
            expected += s.q_p * static_cast<double>(s.count());
            size += std::fabs(s.q_p) * static_cast<double>(s.count());
        }
        return size > 0 ? (on_mesh - expected) / size : 0;
    }

    // A cold plasma at rest has almost no energy to compare with: there a change must also be as
    // large as what particles and field have now, and larger than round-off makes it.
    void check_energy(long step, double time, double energy, double change, double before,
                      double now) const {
        const bool limited = parameters_.energy_limit > 0 && !parameters_.has_walls();
        const bool beyond = limited &&
                            std::fabs(change) > (parameters_.energy_limit - 1) * before &&
                            std::fabs(change) > 0.5 * now && before > 0 && now > least_energy_;
        if (std::isfinite(energy) && !beyond) return;
        throw common::NumericalError(
            "the energy is " + format(energy) + " and was " + format(energy - change) +
            " at the start, at step " + std::to_string(step) + ", t = " + format(time) +
            ": reduce time.dt, refine the mesh, or allow more with time.energy_limit");
    }

    // Distance of the first two particles along x, to the nearest image.
    void note_clouds(const State& state) {
        const double length = parameters_.grid.x.length,
                     d = double(state.species[1].x_p[0]) - double(state.species[0].x_p[0]);
        separation_ = d - length * std::floor(d / length + 0.5);
    }

    const Case& parameters_;
    std::vector<FourierMode> meters_;
    double background_ = 0;
    double least_energy_ = 0;  // of the field that round-off of all charges makes
    std::vector<double> row_;
    double separation_ = 0;
    static constexpr const char* field_unit_ = "m*velocity*omega_p/e";
};

}  // namespace cic
