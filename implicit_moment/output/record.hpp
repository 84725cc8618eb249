// One row of history per step, snapshots when they are due, results at the end.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/run/run.hpp"
#include "common/run/sentence.hpp"
#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/output/columns.hpp"
#include "implicit_moment/output/sheet_diagnostics.hpp"
#include "implicit_moment/output/unit_flux_profile.hpp"
#include "implicit_moment/output/write_output.hpp"
#include "implicit_moment/solve_field.hpp"
#include "implicit_moment/theory/compare_with_theory.hpp"

namespace implicit_moment {

/// The moments of the slide at t^n, for output.
inline std::vector<Moments> slide_moments(const Grid& grid, const State& state) {
    std::vector<Moments> moments(state.plasma.species.size(), Moments(grid));
    for (std::size_t k = 0; k < moments.size(); ++k)
        deposit_moments(state.plasma.species[k], grid, moments[k]);
    return moments;
}

/// The u of a particle that has it at t^n.
inline Velocity<double> stored_u(const Particles& s, long p) {
    return {s.ux_p[p], s.uy_p[p], s.uz_p[p]};
}

/// What a checkpoint holds: the state of the run, and beside it what the recorder has added up.
struct Checkpoint {
    State& state;
    UnitFluxProfile& profile;
    bool is_implicit = true;   // explicit_em has no level theta and solves for nothing
    common::Share share = {};  // of the particles, that this rank reads
};

/// Names every number of the checkpoint, for writing and for reading alike.
template <class Archive>
void archive(Archive& a, Checkpoint& checkpoint) {
    archive(a, checkpoint.state, checkpoint.share);
    archive(a, checkpoint.profile);
    if (!checkpoint.is_implicit) return;
    a("by_theta", checkpoint.state.field.by_theta);
    a("iterations", checkpoint.state.field.iterations);
}

/// What the loop hands its results to; it never changes the state. Rows belong to t^n: moments, E and
/// B of the same time level.
class Recorder {
   public:
    UnitFluxProfile profile;  // of a Harris sheet, added up so far

    /// in: plasma_moments, the moments of t^n itself with the plasma's own images behind walls; u_at, the u of a
    ///     particle at t^n.
    Recorder(const Case& parameters, const State& state,
             std::function<std::vector<Moments>(const State&)> plasma_moments,
             std::function<Velocity<double>(const Particles&, long)> u_at, common::History& history)
        : parameters_(parameters),
          plasma_moments_(std::move(plasma_moments)),
          u_at_(std::move(u_at)) {
        if (parameters.is_along_current()) sheet_.emplace(parameters);
        const Grid& grid = parameters.grid;
        const std::vector<Moments> none(state.plasma.species.size(), Moments(grid));
        history.columns(row_of(0, FieldState(grid), state.plasma, none, 0));
    }

    /// Records t^n: one row, the share of the profile, and what else is due.
    /// errors: NumericalError when the energy is not finite or beyond ten times the initial.
    void record(long step, const State& state, const std::vector<Moments>& moments,
                common::Run& run) {
        const Grid& grid = parameters_.grid;
        const FieldState& field = state.field;
        const double time = double(step) * parameters_.dt;
        const double energy = total_energy(field, moments),
                     initial = step == 0 ? energy : run.history.first("energy");
        if (!std::isfinite(energy) || (initial > 0 && !(energy / initial <= 10))) {
            common::fail(
                "the energy is ", energy / initial, " times the initial energy at step ", step,
                ", t = ", time,
                ": reduce time.dt, or refine a mesh that does not resolve the Debye length");
        }
        run.history.row(row_of(time, field, state.plasma, moments, initial));

        if (parameters_.is_across_current() && !parameters_.is_tail()) {
            const double B0 = harris_sheet(parameters_.harris).B0;
            record_profile(profile, time * B0 / c, middle_row(grid, field.B).flux / B0, grid,
                           field.B, [&] { return plasma_moments_(state); });
        }
        const common::Snapshot at{run.path("."), step, time, parameters_.also};
        if (due(parameters_.fields_interval, step))
            write_fields(at, grid, field, state.plasma, plasma_moments_(state));
        if (due(parameters_.particles_interval, step))
            write_particles(at, state.plasma, parameters_, u_at_);
        if (sheet_ && due(parameters_.profile_interval, step))
            write_profile(at, parameters_, field, plasma_moments_(state));
    }

    /// The results of the whole run, after its last row.
    void finish(const State& state, common::Run& run) const {
        const Case& w = parameters_;
        const common::History& history = run.history;
        common::Summary& summary = run.summary;
        compare_with_theory(w, state, plasma_moments_, profile, history, summary);
        if (w.is_across_current() && !w.is_tail())
            write_profile(run.path("profile.dat"), profile, w.grid, harris_sheet(w.harris).B0);
        const auto conserved = [&](const std::string& name, const std::string& unit) {
            summary.conservation("largest_" + name, history.largest(name), unit);
        };
        conserved("energy_drift", "1");
        conserved("div_B", "B*omega_pi/c");
        // What each species has been heated by, the mesh and its noise included; not of one that rests at first.
        for (const Particles& s : state.plasma.species) {
            const auto kinetic = history.column("kinetic_" + s.name);
            if (kinetic.front() > 1e-9 * history.largest("kinetic_" + s.name))
                summary.conservation("kinetic_change_" + s.name,
                                     kinetic.back() / kinetic.front() - 1, "1");
        }
        conserved("gauss_residual", "4pi*e*n0");
        summary.performance("particles", double(common::sum_over_ranks(state.plasma.count())));
    }

   private:
    // Of fields and particles, in units of n0.
    double total_energy(const FieldState& field, const std::vector<Moments>& moments) const {
        double energy = field_energy(parameters_.grid, field.E);
        energy += field_energy(parameters_.grid, field.B);
        for (const Moments& m : moments) energy += m.kinetic_energy;
        return energy / n0;
    }

    // The row of t^n: every column's name and unit beside its value.
    common::Row row_of(double time, const FieldState& field, const Plasma& plasma,
                       const std::vector<Moments>& moments, double initial) const {
        const Grid& grid = parameters_.grid;
        const std::string of_energy = "n0*m_i*c^2*d_i^2", of_momentum = "m_i*c*n0*d_i^2";
        const double energy = total_energy(field, moments);
        std::array<double, 3> momentum{};
        Field rho = Field::Zero(grid.size()), gauss = rho, scratch;
        for (const Moments& m : moments) {
            for (std::size_t a = 0; a < 3; ++a) momentum[a] += m.momentum[a];
            rho += m.rho;
        }
        smooth(grid, on_nodes, felt_charge(grid), parameters_.field.smoothing, rho.data(), scratch);
        gauss_residual(grid, field.E, rho, gauss);

        common::Row row;
        row.add("time", "1/omega_pi", time);
        if (!parameters_.is_uniform()) {
            row.add("time_Omega_ci", "1/Omega_ci",
                    time * harris_sheet(harris_of(parameters_)).Omega_ci);
        }
        row.add("energy", of_energy, energy);
        // A cold plasma at rest has no energy to compare with.
        const auto change = [&](double to) {
            return initial > 0 ? (to - initial) / usable_energy(parameters_, initial) : 0;
        };
        row.add("energy_drift", "1", change(energy));
        row.add("electric", of_energy, field_energy(grid, field.E) / n0);
        row.add("magnetic", of_energy, field_energy(grid, field.B) / n0);
        for (std::size_t k = 0; k < moments.size(); ++k)
            row.add("kinetic_" + plasma.species[k].name, of_energy, moments[k].kinetic_energy / n0);
        for (std::size_t a = 0; a < 3; ++a)
            row.add(std::string("momentum_") + "xyz"[a], of_momentum, momentum[a] / n0);
        row.add("div_B", "B*omega_pi/c", largest_divergence(grid, field.B, scratch));
        row.add("gauss_residual", "4pi*e*n0", gauss_error(grid, gauss));
        if (!parameters_.leapfrog.chosen) {
            const double by_theta = field.by_theta / n0;
            row.add("energy_by_theta", of_energy, by_theta);
            row.add("energy_residual", "1", change(energy - by_theta));
            row.add("iterations", "1", field.iterations);
        }
        if (parameters_.is_tail())
            add_tail(parameters_, field, row);
        else if (parameters_.is_across_current())
            add_reconnection(parameters_, field, row);
        if (parameters_.is_along_current()) sheet_->add(field, row);
        if (parameters_.is_uniform()) add_mode(parameters_, field, row);
        if (has_mean_E(parameters_)) add_mean_field(grid, field, row);
        return row;
    }

    // Whether a snapshot of the given interval falls on this step; one falls on the last.
    bool due(double interval, long step) const {
        if (interval <= 0) return false;
        if (step == std::lround(parameters_.end / parameters_.dt)) return true;
        const double every = double(parameters_.history_steps),
                     rows = std::max(1.0, std::round(interval / parameters_.dt / every));
        return std::fmod(double(step), rows * every) == 0;
    }

    const Case& parameters_;
    std::function<std::vector<Moments>(const State&)> plasma_moments_;
    std::function<Velocity<double>(const Particles&, long)> u_at_;
    std::optional<SheetDiagnostics> sheet_;
};

}  // namespace implicit_moment
