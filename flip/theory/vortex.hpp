// Gresho's vortex, which turns for ever: the pressure carries the centripetal force.
#pragma once

#include <cmath>
#include <numbers>

namespace flip::theory {

/// The vortex at one radius.
struct GreshoVortex {
    double
        pressure;  // above that of the middle, in units of density times the peak velocity squared
    double velocity;  // around the middle, in units of the peak velocity
};

/// The vortex at s = r/r_peak; with r_peak = 0.2 it is that of the paper.
///   u_phi = s,  2 - s beyond s = 1,  0 beyond s = 2
///   p = s^2/2,  s^2/2 + 4 (1 - s + log s) beyond s = 1,  4 log 2 - 2 beyond s = 2
/// exact:  dp/ds = u_phi^2/s
/// source: Gresho and Chan, Int. J. Numer. Methods Fluids 11, 621 (1990).
inline GreshoVortex gresho_vortex(double s) {
    if (s < 1) return {0.5 * s * s, s};
    if (s < 2) return {0.5 * s * s + 4 * (1 - s + std::log(s)), 2 - s};
    return {4 * std::log(2.0) - 2, 0};
}

/// integral of u^2 / 2, integral of r u, and the time in which the core turns once, for r_peak = 0.2
/// and a peak velocity of 1.
inline constexpr double gresho_kinetic_energy = 2.0 * std::numbers::pi / 75.0;
inline constexpr double gresho_angular_momentum = 7.0 * std::numbers::pi / 375.0;
inline constexpr double gresho_turnover_time = 0.4 * std::numbers::pi;

}  // namespace flip::theory
