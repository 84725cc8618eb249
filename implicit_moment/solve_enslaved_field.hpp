// particles and grid at once: E^{n+theta} and the paths of all particles in it, found together.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/least_squares.hpp"
#include "common/run/sentence.hpp"
#include "implicit_moment/advance_field.hpp"
#include "implicit_moment/newton_krylov/enslave_particles.hpp"

namespace implicit_moment {

/// Solves field and particles together.
/// in:     solver.mass of the same particles; particles and field at t^n
/// out:    field.E_theta; B_theta, at its level; interleaved, both as particles feel them;
///         enslaved.vbar; enslaved.J, smoothed
/// exact:  |residual| <= tolerance |source|, or 1e-7 where round-off of the currents leaves more
/// errors: NumericalError when it does not converge
inline FieldReport solve_enslaved_field(FieldSolver& solver, double dt,
                                        const MoverSettings& settings,
                                        const std::vector<Particles>& species, FieldState& field,
                                        VectorField& B_theta, InterleaveScratch& scratch,
                                        InterleavedField& interleaved,
                                        EnslavedParticles& enslaved) {
    const Grid& grid = solver.grid;
    const SmoothingSettings& smoothing = solver.settings.smoothing;
    const double a = c * solver.settings.theta * dt, by_J = 4 * pi * solver.settings.theta * dt;
    const double goal = solver.settings.solved_to();
    enslaved.vbar.resize(species.size());
    enslaved.state.resize(species.size());
    for (std::size_t k = 0; k < species.size(); ++k) {
        enslaved.vbar[k].resize(species[k].x_p.size());
        enslaved.state[k].assign(species[k].x_p.size(), {});
        for (std::size_t p = 0; p < species[k].x_p.size(); ++p)
            enslaved.vbar[k][p] = velocity_of(species[k], p);
    }

    // The guess: the mass matrix alone. Then what is left of the field equations is corrected with it.
    FieldReport report = solve_field(solver, dt, field, 1e-3);
    Eigen::VectorXd source = solver.source.all + by_J * solver.mass.J_hat.all, correction;
    keep_unknowns(grid, source.data());
    const double scale = std::max(common::safe_norm(source), common::safe_norm(solver.source.all));
    common::AndersonAcceleration acceleration;
    constexpr double round_off = 1e-7;
    double best = 2;
    int best_iteration = 0;
    MoverSettings follow = settings;
    for (int iteration = 0;; ++iteration) {
        // B at the same level: B^n - a curl E.
        curl_of_electric(grid, field.E_theta.all.data(), enslaved.curl.all.data());
        B_theta.all = field.B.all - a * enslaved.curl.all;
        fill_B_ghosts(grid, B_theta);
        interleave_field(grid, smoothing, field.E_theta, B_theta, scratch, interleaved);
        follow_field(interleaved, grid, dt, follow, species, iteration, enslaved);
        smooth(grid, felt(grid), smoothing, enslaved.J.all.data(), solver.scratch);

        // What is left: source - E + a curl (B_theta - B^n) - 4 pi theta dt J.
        VectorField& left = solver.source;
        B_theta.all -= field.B.all;
        curl_of_magnetic(grid, B_theta.all.data(), left.all.data());
        left.all = source - field.E_theta.all + a * left.all - by_J * enslaved.J.all;
        keep_unknowns(grid, left.all.data());
        report.residual = scale > 0 ? common::safe_norm(left.all) / scale : 0;
        if (report.residual <= goal) break;
        // Round-off: sums of currents that cancel leave more than the goal.
        if (report.residual < 0.5 * best) best = report.residual, best_iteration = iteration;
        if (iteration >= best_iteration + 6 && report.residual <= round_off) break;
        if (iteration == 100 || !std::isfinite(report.residual))
            common::fail("field and particles did not converge together (relative residual ",
                         report.residual, "); reduce time.dt");
        follow.tolerance = std::min(settings.tolerance, std::max(1e-14, 0.1 * report.residual));
        correction.setZero(left.all.size());
        report.iterations += detail::solve_linear_field(solver, a, 1e-3, correction).iterations;
        acceleration.next(correction, field.E_theta.all);
        keep_unknowns(grid, field.E_theta.all.data());
        fill_ghosts(grid, electric, field.E_theta);
    }
    B_theta.all += field.B.all;
    field.iterations = report.iterations;
    return report;
}

}  // namespace implicit_moment
