// on the grid: E^{n+theta} from Maxwell's equations and the predicted current.            [IMM-10]
//
// Faraday and Ampere at n+theta, with J^{n+1/2} = J_hat + chi E/(4 pi theta dt) and a = c theta dt:
//
//     (1 + chi) E + a^2 curl curl E = E^n + a curl B^n - 4 pi theta dt J_hat + a^2 grad G      (i)
//
// where G = div E - 4 pi rho at n+theta, Gauss's law with the predicted charge. The paper replaces
// curl curl E by grad div E - lap E and puts Gauss's law in for div E; that is (i). Its divergence,
// with [IMM-11], says what becomes of an error in Gauss's law:
//
//     (1 - a^2 lap) G^{n+theta} = G^n,       G = 0 on walls                                   (ii)
//
// so the error left by the finite number of particles decays and needs no projection step;
// Poisson's equation is imposed on the boundary only, as G = 0. We solve (ii) first, directly, and
// (i) by GMRES: together they are the second-order equation, with an operator that stays near
// symmetric.
//
// source: [IMM-10..12]; Ricci, Lapenta and Brackbill, J. Comput. Phys. 183, 117 (2002).
#pragma once

#include <cmath>
#include <string>

#include "common/run/sentence.hpp"
#include "implicit_moment/field/precondition_field.hpp"

namespace implicit_moment {

/// How the solver ended.
struct FieldReport {
    int iterations = 0;   // of GMRES, over all Newton steps
    double residual = 0;  // over the right-hand side
};

namespace detail {

// errors: NumericalError, with what the solver says
template <class Result>
[[noreturn]] inline void refuse_solution(const std::string& which, const Result& result) {
    common::fail("the ", which, " did not converge: ", result.reason, " (relative residual ",
                 result.residual, "); reduce time.dt or raise field.max_iterations");
}

// Solves A E = solver.source. in/out: E, the guess and the solution
inline FieldReport solve_linear_field(FieldSolver& solver, double a, double tolerance,
                                      Eigen::VectorXd& E) {
    const auto apply = [&](const Eigen::VectorXd& v, Eigen::VectorXd& out) {
        out.resize(v.size());
        apply_field_operator(solver, a, v, out);
    };
    const auto precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& out) {
        precondition_field(solver, r, out);
    };
    const auto result = common::gmres(apply, precondition, solver.source.all, E, tolerance,
                                      int(solver.settings.max_iterations), 40, solver.krylov);
    // Long steps leave round-off that no iteration takes.
    if (!result.converged && !(result.residual <= 1e-10))
        refuse_solution("field equations", result);
    return {result.iterations, result.residual};
}

}  // namespace detail

/// div E - 4 pi rho on nodes, zero on walls. in: E at t^n with ghosts, rho smoothed.
inline void gauss_residual(const Grid& grid, const VectorField& E, const Field& rho, Field& G) {
    divergence_of_electric(grid, E.all.data(), G);
    G -= 4 * pi * rho;
    if (grid.x.periodic && grid.z.periodic) {
        // Nothing but a uniform background can hold a net charge in a periodic box.
        G.array() -= interior(grid, G.data()).mean();
    }
    common::fill_ghosts(grid, common::on_nodes, {-1, -1}, G.data());
}

/// The right-hand side of (i) without J_hat: E^n + a curl B^n + a^2 grad G.
inline void maxwell_source(FieldSolver& solver, const FieldState& field, double a) {
    const Grid& grid = solver.grid;
    Field& G = solver.gauss;
    gauss_residual(grid, field.E, solver.response.rho, G);
    solve_helmholtz(grid, solver.waves, a, G);
    VectorField& source = solver.source;
    curl_of_magnetic(grid, field.B.all.data(), source.all.data());
    const long s = grid.stride();
    const double by_dx = a * a / grid.x.spacing(), by_dz = a * a / grid.z.spacing();
    const double *E_x = field.E.x(), *E_y = field.E.y(), *E_z = field.E.z(), *g = G.data();
    double *x = source.x(), *y = source.y(), *z = source.z();
    for_each_point(grid, [=](long n) {
        x[n] = E_x[n] + a * x[n] + by_dx * (g[n + 1] - g[n]);
        y[n] = E_y[n] + a * y[n];
        z[n] = E_z[n] + a * z[n] + by_dz * (g[n + s] - g[n]);
    });
    keep_unknowns(grid, source.all.data());
}

/// The B in which currents and particles are rotated: B^n as on the slide, or B^{n+1/2} = B^n - c dt/2 curl E^n,
/// with which the step is of second order in dt.
inline void find_push_B(FieldSolver& solver, double dt, const FieldState& field,
                        VectorField& B_push) {
    B_push.all = field.B.all;
    if (!solver.settings.rotates_in_the_middle()) return;
    curl_of_electric(solver.grid, field.E.all.data(), solver.curl_E.all.data());
    B_push.all -= 0.5 * c * dt * solver.curl_E.all;
    fill_B_ghosts(solver.grid, B_push);
}

/// Solves for E^{n+theta}.
/// in:     moments of all species at t^n, E and B at t^n; B_push, of find_push_B
/// out:    field.E_theta, ghosts filled; B_push, with "newton_krylov" at the level theta
/// exact:  |residual| <= tolerance |source|, or 1e-10 where round-off leaves more than the tolerance;
///         on periodic meshes and inside walls the Gauss residual obeys (ii) as nearly
/// errors: NumericalError when the solver does not converge; the field is then not used.
/// source: [IMM-10..12]
/// note:   "gmres" rotates the current in B_push, B^n on the slide; "newton_krylov" rotates it in
///         B^{n+theta} = B^n - a curl E^{n+theta}, which makes the equations nonlinear.
inline FieldReport solve_field(FieldSolver& solver, const std::vector<Moments>& moments,
                               const std::vector<double>& charge_over_mass, double dt,
                               FieldState& field, VectorField& B_push) {
    const Grid& grid = solver.grid;
    const FieldSettings& settings = solver.settings;
    const double a = c * settings.theta * dt, by_J = 4 * pi * settings.theta * dt;
    PlasmaResponse& response = solver.response;
    const double* rotated_in = settings.rotates_on_mesh()   ? nullptr
                               : settings.solver == "gmres" ? B_push.all.data()
                                                            : field.B.all.data();

    predict_current(grid, moments, charge_over_mass, rotated_in, B_push.all.data(), dt,
                    settings.theta, response);
    smooth(grid, felt(grid), settings.smoothing, response.J_hat.all.data(), solver.scratch);
    smooth(grid, common::on_nodes, felt_charge(grid), settings.smoothing, response.rho.data(),
           solver.scratch);
    prepare_preconditioner(solver, a);
    maxwell_source(solver, field, a);

    Eigen::VectorXd& E = field.E_theta.all;
    keep_unknowns(grid, E.data());
    FieldReport report;
    if (settings.solver == "gmres") {
        solver.source.all -= by_J * response.J_hat.all;
        keep_unknowns(grid, solver.source.all.data());
        report = detail::solve_linear_field(solver, a, settings.solved_to(), E);
    } else {
        const auto precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& out) {
            precondition_field(solver, r, out);
        };
        const auto residual = [&](const Eigen::VectorXd& v, Eigen::VectorXd& F) {
            F.resize(v.size());
            solver.ghosted.all = v;
            fill_ghosts(grid, electric, solver.ghosted);
            curl_of_electric(grid, solver.ghosted.all.data(), B_push.all.data());
            B_push.all = field.B.all - a * B_push.all;
            fill_B_ghosts(grid, B_push);
            predict_current(grid, moments, charge_over_mass, rotated_in, B_push.all.data(), dt,
                            settings.theta, response);
            smooth(grid, felt(grid), settings.smoothing, response.J_hat.all.data(), solver.scratch);
            apply_field_operator(solver, a, v, F);
            F += by_J * response.J_hat.all - solver.source.all;
            keep_unknowns(grid, F.data());
        };
        const double scale = std::max(common::safe_norm(solver.source.all),
                                      by_J * common::safe_norm(response.J_hat.all));
        if (!std::isfinite(scale)) common::fail("the source of the field equations is not finite");
        if (scale > 0) {
            const auto result =
                common::newton_krylov(residual, precondition, E, scale, settings.solved_to(), 30,
                                      int(settings.max_iterations), solver.newton);
            if (!result.converged) detail::refuse_solution("nonlinear field equations", result);
            report = {result.linear_iterations, result.residual};
        } else {
            E.setZero();
        }
    }
    fill_ghosts(grid, electric, field.E_theta);
    field.iterations = report.iterations;
    return report;
}

/// Solves for E^{n+theta} with the current of the mass matrix, (1 + S M S 4 pi theta dt) E + a^2 curl curl E
/// = E^n + a curl B^n - 4 pi theta dt S J_hat.
/// in:     solver.mass, deposited; E and B at t^n
/// out:    field.E_theta, ghosts filled
/// exact:  |residual| as above
/// errors: NumericalError when the solver does not converge
/// note:   Gauss's law is not in it: a^2 grad G would do work that nothing accounts for.
inline FieldReport solve_field(FieldSolver& solver, double dt, FieldState& field,
                               double tolerance) {
    const Grid& grid = solver.grid;
    const double a = c * solver.settings.theta * dt;
    prepare_preconditioner(solver, a);
    smooth(grid, felt(grid), solver.settings.smoothing, solver.mass.J_hat.all.data(),
           solver.scratch);
    curl_of_magnetic(grid, field.B.all.data(), solver.source.all.data());
    solver.source.all = field.E.all + a * solver.source.all -
                        4 * pi * solver.settings.theta * dt * solver.mass.J_hat.all;
    keep_unknowns(grid, solver.source.all.data());
    keep_unknowns(grid, field.E_theta.all.data());
    const FieldReport report = detail::solve_linear_field(solver, a, tolerance, field.E_theta.all);
    fill_ghosts(grid, electric, field.E_theta);
    field.iterations = report.iterations;
    return report;
}

}  // namespace implicit_moment
