// Maxwell's equations on the staggered mesh, leapfrogged: the field of explicit_em.
#pragma once

#include <cmath>

#include "implicit_moment/field/vector_field.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// The longest stable step of the field alone, [1/omega_pi]:  c dt < (1/dx^2 + 1/dz^2)^(-1/2).
inline double courant_limit(const Grid& grid) {
    return 1 / (c * std::hypot(1 / grid.x.spacing(), 1 / grid.z.spacing()));
}

/// The frequency of a wave in vacuum on this mesh, exact:
///     sin^2(omega dt/2) / (c dt)^2 = sin^2(k_x dx/2) / dx^2 + sin^2(k_z dz/2) / dz^2
/// source: Yee, IEEE Trans. Antennas Propag. 14, 302 (1966); Taflove and Hagness (2005), chapter 4.
inline double yee_frequency(const Grid& grid, double dt, double k_x, double k_z) {
    const double half_K = std::hypot(std::sin(0.5 * k_x * grid.x.spacing()) / grid.x.spacing(),
                                     std::sin(0.5 * k_z * grid.z.spacing()) / grid.z.spacing());
    return 2 / dt * std::asin(c * dt * half_K);
}

/// The frequency of leapfrogged oscillators, exact: sin(omega dt/2) = omega_p dt/2.
inline double leapfrog_frequency(double omega_p, double dt) {
    return 2 / dt * std::asin(0.5 * omega_p * dt);
}

namespace detail {

// B -= c dt curl E
inline void advance_magnetic(const Grid& grid, double dt, const VectorField& E, VectorField& B) {
    const long s = grid.stride();
    const double per_x = c * dt / grid.x.spacing(), per_z = c * dt / grid.z.spacing();
    const double *E_x = E.x(), *E_y = E.y(), *E_z = E.z();
    double *B_x = B.x(), *B_y = B.y(), *B_z = B.z();
    for_each_point(grid, [=](long n) {
        B_x[n] += per_z * (E_y[n + s] - E_y[n]);
        B_y[n] -= per_z * (E_x[n + s] - E_x[n]) - per_x * (E_z[n + 1] - E_z[n]);
        B_z[n] -= per_x * (E_y[n + 1] - E_y[n]);
    });
    fill_B_ghosts(grid, B);
}

// E += c dt curl B - 4 pi dt J
inline void advance_electric(const Grid& grid, double dt, const VectorField& B,
                             const VectorField& J, VectorField& E) {
    const long s = grid.stride();
    const double per_x = c * dt / grid.x.spacing(), per_z = c * dt / grid.z.spacing();
    const double per_J = 4 * pi * dt;
    const double *B_x = B.x(), *B_y = B.y(), *B_z = B.z();
    const double *J_x = J.x(), *J_y = J.y(), *J_z = J.z();
    double *E_x = E.x(), *E_y = E.y(), *E_z = E.z();
    for_each_point(grid, [=](long n) {
        E_x[n] -= per_z * (B_y[n] - B_y[n - s]) + per_J * J_x[n];
        E_y[n] += per_z * (B_x[n] - B_x[n - s]) - per_x * (B_z[n] - B_z[n - 1]) - per_J * J_y[n];
        E_z[n] += per_x * (B_y[n] - B_y[n - 1]) - per_J * J_z[n];
    });
    fill_ghosts(grid, electric, E);
}

}  // namespace detail

/// E and B from t^n to t^{n+1}: half a step of B, a whole one of E, the other half of B.
///     B^{n+1/2} = B^n - c dt/2 curl E^n
///     E^{n+1}   = E^n + c dt curl B^{n+1/2} - 4 pi dt J^{n+1/2}
///     B^{n+1}   = B^{n+1/2} - c dt/2 curl E^{n+1}
/// in:     J^{n+1/2}, ghosts filled.
/// in/out: field, ghosts filled.
/// exact:  div B is unchanged to round-off, and with a J that conserves charge so is
///         div E - 4 pi rho; waves in vacuum have yee_frequency and are not damped.
inline void advance_field(const Grid& grid, double dt, const VectorField& J, FieldState& field) {
    detail::advance_magnetic(grid, 0.5 * dt, field.E, field.B);
    detail::advance_electric(grid, dt, field.B, J, field.E);
    detail::advance_magnetic(grid, 0.5 * dt, field.E, field.B);
}

}  // namespace implicit_moment
