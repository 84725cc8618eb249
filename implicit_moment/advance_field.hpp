// on the grid: E and B of the next time level from E^{n+theta}, and what the level theta takes from their
// energy.   [IMM-10, MPM-13]
#pragma once

#include "implicit_moment/solve_field.hpp"

namespace implicit_moment {

/// Adds to field.by_theta what the time level theta takes from the energy in a step by dE,
/// -(theta - 1/2) sum V (|dE|^2 + |dB|^2) / 4 pi: [MPM-13] of the field.
/// in:     solver.curl_E, of E^{n+theta}
inline void take_by_theta(FieldSolver& solver, double dt, const Eigen::VectorXd& dE,
                          FieldState& field) {
    const Grid& grid = solver.grid;
    double squares = 0;
    for (long k = 0; k < 3; ++k) {
        squares += interior(grid, dE.data() + k * grid.size()).squaredNorm();
        squares += c * c * dt * dt *
                   interior(grid, solver.curl_E.all.data() + k * grid.size()).squaredNorm();
    }
    field.by_theta -= (solver.settings.theta - 0.5) * squares * grid.cell_area() / (4 * pi);
}

/// E^{n+1} = [E^{n+theta} - (1 - theta) E^n] / theta,   B^{n+1} = B^n - c dt curl E^{n+theta}.
/// in/out: field, ghosts filled; what theta takes is added to field.by_theta.
/// exact:  div B is unchanged to round-off. The energy of the field changes by what theta takes, by
///         -dt sum V J . E^{n+theta}, and with moments by the work of a^2 grad G (solve_field.hpp).
/// source: [IMM-10]
inline void advance_field(FieldSolver& solver, double dt, FieldState& field) {
    const Grid& grid = solver.grid;
    const double theta = solver.settings.theta;
    curl_of_electric(grid, field.E_theta.all.data(), solver.curl_E.all.data());
    solver.source.all = (field.E_theta.all - field.E.all) / theta;
    take_by_theta(solver, dt, solver.source.all, field);
    field.B.all -= c * dt * solver.curl_E.all;
    field.E.all = (field.E_theta.all - (1 - theta) * field.E.all) / theta;
    fill_ghosts(grid, electric, field.E);
    fill_B_ghosts(grid, field.B);
}

/// The same with a current that is known: E^{n+1} = E^n + dt (c curl B_theta - 4 pi J), so that Gauss's
/// law stays where it is to round-off even if E^{n+theta} is only nearly solved for.
/// in:     J, smoothed, and B_theta = B^n - c theta dt curl E^{n+theta}; ghosts filled
inline void advance_field(FieldSolver& solver, double dt, const VectorField& J,
                          const VectorField& B_theta, FieldState& field) {
    const Grid& grid = solver.grid;
    curl_of_electric(grid, field.E_theta.all.data(), solver.curl_E.all.data());
    curl_of_magnetic(grid, B_theta.all.data(), solver.source.all.data());
    solver.source.all = dt * (c * solver.source.all - 4 * pi * J.all);
    keep_unknowns(grid, solver.source.all.data());
    take_by_theta(solver, dt, solver.source.all, field);
    field.E.all += solver.source.all;
    field.B.all -= c * dt * solver.curl_E.all;
    fill_ghosts(grid, electric, field.E);
    fill_B_ghosts(grid, field.B);
}

}  // namespace implicit_moment
