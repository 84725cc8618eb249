// One row of history per step, snapshots when they are due, results at the end.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/run/run.hpp"
#include "implicit_moment/output/sheet_diagnostics.hpp"
#include "implicit_moment/output/write_output.hpp"
#include "implicit_moment/theory/compare_current_sheet.hpp"
#include "implicit_moment/theory/compare_kink.hpp"
#include "implicit_moment/theory/compare_with_theory.hpp"

namespace implicit_moment {

/// The moments of the slide at t^n, for output.
inline std::vector<Moments> slide_moments(const Grid& grid, const State& state) {
    std::vector<Moments> moments(state.plasma.species.size(), Moments(grid));
    for (std::size_t k = 0; k < moments.size(); ++k)
        deposit_moments(state.plasma.species[k], grid, moments[k]);
    return moments;
}

/// What the loop hands its results to. Rows belong to t^n: moments, E and B of the same time level.
class Recorder {
   public:
    /// in: plasma_moments, the moments of t^n itself with the plasma's own images behind walls.
    Recorder(const Case& parameters, const State& state,
             std::function<std::vector<Moments>(const State&)> plasma_moments,
             common::History& history)
        : parameters_(parameters),
          harris_(parameters.setup == "harris"),
          plasma_moments_(std::move(plasma_moments)) {
        if (parameters.setup == "current_sheet") sheet_.emplace(parameters);
        std::vector<common::Column> columns{{"time", "1/omega_pi"}};
        if (harris_ || sheet_) columns.push_back({"time_Omega_ci", "1/Omega_ci"});
        columns.insert(
            columns.end(),
            {{"energy", unit_}, {"energy_drift", "1"}, {"electric", unit_}, {"magnetic", unit_}});
        for (const Particles& s : state.plasma.species)
            columns.push_back({"kinetic_" + s.name, unit_});
        columns.insert(columns.end(), {{"momentum_x", "m_i*c*n0*d_i^2"},
                                       {"momentum_y", "m_i*c*n0*d_i^2"},
                                       {"momentum_z", "m_i*c*n0*d_i^2"},
                                       {"div_B", "B*omega_pi/c"},
                                       {"gauss_residual", "4pi*e*n0"}});
        if (harris_) columns.insert(columns.end(), {{"flux", "B0*d_i"}, {"quadrupole", "B0"}});
        if (sheet_) {
            for (const common::Column& column : SheetDiagnostics::columns())
                columns.push_back(column);
        }
        if (!harris_ && !sheet_)
            columns.insert(columns.end(),
                           {{"mode_re", parameters.component}, {"mode_im", parameters.component}});
        history.columns(columns);
    }

    /// One row for t^n, and the profile's share of it.
    /// errors: NumericalError when the energy is not finite or beyond ten times the initial.
    void record(long step, State& state, const std::vector<Moments>& moments, common::Run& run) {
        const Grid& grid = parameters_.grid;
        const FieldState& field = state.field;
        const double time = static_cast<double>(step) * parameters_.dt;
        const double electric_energy = field_energy(grid, field.E),
                     magnetic_energy = field_energy(grid, field.B);
        double energy = electric_energy + magnetic_energy;
        std::array<double, 3> momentum{};
        for (const Moments& m : moments) {
            energy += m.kinetic_energy;
            for (std::size_t a = 0; a < 3; ++a) momentum[a] += m.momentum[a];
        }
        energy /= n0;
        const double initial = step == 0 ? energy : run.history.first("energy");
        // A cold plasma at rest has no energy to compare with.
        const double drift = initial > 0 ? energy / initial - 1 : 0;
        if (!std::isfinite(energy) || !(drift <= 9)) {
            throw common::NumericalError("the energy is " + format(energy / initial) +
                                         " times the initial energy at step " +
                                         std::to_string(step) + ", t = " + format(time) +
                                         ": reduce time.dt or refine the mesh");
        }

        rho_.setZero(grid.size());
        for (const Moments& m : moments) rho_ += m.rho;
        smooth(grid, on_nodes, {-1, -1}, parameters_.field.smoothing, rho_.data(), scratch_);
        gauss_.resize(grid.size());
        gauss_residual(grid, field.E, rho_, gauss_);

        row_ = {time};
        if (harris_ || sheet_) row_.push_back(time * harris_sheet(harris_of(parameters_)).Omega_ci);
        row_.insert(row_.end(), {energy, drift, electric_energy / n0, magnetic_energy / n0});
        for (const Moments& m : moments) row_.push_back(m.kinetic_energy / n0);
        row_.insert(row_.end(),
                    {momentum[0] / n0, momentum[1] / n0, momentum[2] / n0,
                     largest_divergence(grid, field.B, gauss_scratch_), gauss_error(grid, gauss_)});
        if (harris_) {
            const double B0 = harris_sheet(parameters_.harris).B0;
            const MiddleRow middle = middle_row(grid, field.B);
            row_.insert(row_.end(),
                        {middle.flux / B0, quadrupole(grid, field.B, middle.X_point) / B0});
            watch(state.profile, time * B0 / c, middle.flux / B0, grid, field.B,
                  [&] { return plasma_moments_(state); });
        } else if (sheet_) {
            sheet_->measure(field, row_);
        } else {
            const auto mode =
                mode_amplitude(grid, field, parameters_.component, parameters_.uniform.mode_x,
                               parameters_.uniform.mode_z);
            row_.insert(row_.end(), {mode.real(), mode.imag()});
        }
        run.history.row(row_);
        if (due(parameters_.fields_interval, step)) {
            write_fields(run.path("."), step, grid, field, state.plasma, plasma_moments_(state),
                         parameters_.vtk);
        }
        if (due(parameters_.particles_interval, step))
            write_particles(run.path("."), step, state.plasma, parameters_.vtk);
        if (sheet_ && due(parameters_.profile_interval, step))
            write_profile(run.path("."), step, parameters_, field, plasma_moments_(state));
    }

    /// The results of the whole run, after its last row.
    void finish(const State& state, common::Run& run) const {
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        if (harris_ && parameters_.harris.perturbation != 0)
            compare_reconnection(parameters_, history, state.profile, summary);
        if (harris_ && parameters_.harris.perturbation == 0)
            compare_equilibrium(parameters_, state.plasma, plasma_moments_(state), history,
                                summary);
        if (harris_)
            write_profile(run.path("profile.dat"), state.profile, parameters_.grid,
                          harris_sheet(parameters_.harris).B0);
        if (sheet_) compare_current_sheet(parameters_, history, summary);
        if (sheet_) compare_kink(parameters_, history, summary);
        if (!harris_ && !sheet_) compare_mode(parameters_, history, summary);
        const auto largest = [&](const char* name) {
            double most = 0;
            for (const double value : history.column(name)) most = std::max(most, std::fabs(value));
            return most;
        };
        summary.conservation("largest_energy_drift", largest("energy_drift"), "1");
        summary.conservation("largest_div_B", largest("div_B"), "B*omega_pi/c");
        summary.conservation("largest_gauss_residual", largest("gauss_residual"), "4pi*e*n0");
        summary.performance("particles", static_cast<double>(state.plasma.count()));
    }

   private:
    // Whether a snapshot of the given interval falls on this step.
    bool due(double interval, long step) const {
        if (interval <= 0) return false;
        const long rows =
            std::lround(interval / parameters_.dt / double(parameters_.history_steps));
        return step % (std::max(1L, rows) * parameters_.history_steps) == 0;
    }

    const Case& parameters_;
    bool harris_;
    std::function<std::vector<Moments>(const State&)> plasma_moments_;
    std::optional<SheetDiagnostics> sheet_;
    Field rho_, gauss_, scratch_, gauss_scratch_;
    std::vector<double> row_;
    static constexpr const char* unit_ = "n0*m_i*c^2*d_i^2";
};

}  // namespace implicit_moment
