// Vortices that turn for ever: the pressure carries the centripetal force.
#pragma once

#include <cmath>
#include <numbers>

namespace flip::theory {

/// The velocity around Gresho's vortex, of peak 1 at r = 0.2.
///   u_phi = 5 r,  2 - 5 r beyond r = 0.2,  0 beyond r = 0.4
/// source: Gresho and Chan, Int. J. Numer. Methods Fluids 11, 621 (1990).
inline double gresho_velocity(double r) {
    if (r < 0.2) return 5.0 * r;
    return r < 0.4 ? 2.0 - 5.0 * r : 0.0;
}

/// The pressure in the middle, which sets the Mach number of the peak.
///   p_0 = 1 / (gamma M^2) - 1 / 2,  M = 1 / c at r = 0.2, where p = p_0 + 1 / 2
/// in:    peak_mach, below (2 / gamma)^1/2 for a positive pressure
inline double gresho_middle_pressure(double gamma, double peak_mach) {
    return 1.0 / (gamma * peak_mach * peak_mach) - 0.5;
}

/// The pressure of Gresho's vortex in a gas of density 1.
///   p = p_0 + 25 r^2 / 2,
///       p_0 + 25 r^2 / 2 + 4 (1 - 5 r + log 5 r) beyond r = 0.2,
///       p_0 + 4 log 2 - 2 beyond r = 0.4
/// exact: dp/dr = u_phi^2 / r
inline double gresho_pressure(double r, double p_0) {
    if (r < 0.2) return p_0 + 12.5 * r * r;
    if (r < 0.4) return p_0 + 12.5 * r * r + 4.0 * (1.0 - 5.0 * r + std::log(5.0 * r));
    return p_0 + 4.0 * std::numbers::ln2 - 2.0;
}

/// integral of u^2 / 2, integral of r u, and the time in which the core turns once.
inline constexpr double gresho_kinetic_energy = 2.0 * std::numbers::pi / 75.0;
inline constexpr double gresho_angular_momentum = 7.0 * std::numbers::pi / 375.0;
inline constexpr double gresho_turnover_time = 0.4 * std::numbers::pi;

/// A disk that turns rigidly.
struct RigidRotation {
    double radius, rate;  // R, and Omega, counterclockwise
    double density = 1.0;
};

/// The velocity around the middle.
///   u_phi = Omega r
inline double rotation_velocity(const RigidRotation& d, double r) { return d.rate * r; }

/// The pressure that keeps the disk together.
///   p = p_0 + rho (Omega r)^2 / 2
inline double rotation_pressure(const RigidRotation& d, double r, double p_0) {
    return p_0 + 0.5 * d.density * d.rate * d.rate * r * r;
}

/// The angular momentum of the disk.
///   L = pi rho Omega R^4 / 2
inline double rotation_angular_momentum(const RigidRotation& d) {
    return 0.5 * std::numbers::pi * d.density * d.rate * std::pow(d.radius, 4);
}

/// The kinetic energy of the disk.
///   K = Omega L / 2
inline double rotation_kinetic_energy(const RigidRotation& d) {
    return 0.5 * d.rate * rotation_angular_momentum(d);
}

}  // namespace flip::theory
