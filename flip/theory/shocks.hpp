// Shocks that a piston drives or a wall reflects, and Noh's problem: cold gas that falls into a
// plane, a line or a point.
#pragma once

#include <cmath>
#include <limits>

#include "common/run/parameters.hpp"

namespace flip::theory {

/// A shock and the gas behind it.
struct DrivenShock {
    double speed;            // D, seen from the gas in front of it
    double speed_from_wall;  // D - u_p, seen from the piston or wall
    double mach;             // D / c of the gas in front of it; infinite for a cold gas
    double density, pressure, internal_energy;  // behind it; the energy per mass
};

/// The shock in front of a piston that is driven into gas, or from a wall that gas runs into.
///   D = (gamma + 1) u_p / 4 + {[(gamma + 1) u_p / 4]^2 + c^2}^1/2
///   rho_2 = rho D / (D - u_p),  p_2 = p + rho D u_p
/// in:    u_p > 0, the speed of the piston relative to the gas; the gas, also a cold one
/// exact: mass, momentum and energy balance; a cold ideal gas has D = (gamma + 1) u_p / 2 and
///        rho_2 / rho = (gamma + 1) / (gamma - 1), and with a wall the shock moves off at
///        (gamma - 1) u_p / 2
/// errors: InputError for a gas that cannot exist or a piston that does not push.
inline DrivenShock driven_shock(double u_p, double density, double pressure, double gamma,
                                double p_infinity = 0.0) {
    const bool possible = u_p > 0.0 && density > 0.0 && gamma > 1.0 && p_infinity >= 0.0 &&
                          pressure + p_infinity >= 0.0;
    if (!possible)
        throw common::InputError(
            "no shock runs before such a piston: take a piston speed, a density and gamma - 1 "
            "above 0, and a pressure not below -p_infinity");
    const double c_squared = gamma * (pressure + p_infinity) / density;
    const double quarter = 0.25 * (gamma + 1.0) * u_p,
                 root = std::hypot(quarter, std::sqrt(c_squared));
    DrivenShock s{};
    s.speed = quarter + root;
    // D (D - (gamma + 1) u_p / 2) = c^2
    s.speed_from_wall = 0.5 * (gamma - 1.0) * u_p + c_squared / s.speed;
    s.mach =
        c_squared > 0.0 ? s.speed / std::sqrt(c_squared) : std::numeric_limits<double>::infinity();
    s.density = density * s.speed / s.speed_from_wall;
    s.pressure = pressure + density * s.speed * u_p;
    s.internal_energy = (s.pressure + gamma * p_infinity) / ((gamma - 1.0) * s.density);
    return s;
}

/// Cold gas at the start.
struct NohProblem {
    double gamma;
    int dimension;                      // 1 plane, 2 cylinder, 3 sphere
    double density = 1.0, speed = 1.0;  // rho_0 and v_0 of the cold gas at the start
};

/// The gas at one radius.
struct NohState {
    double density, velocity, pressure, internal_energy;  // the velocity outward
};

/// The radius that the shock has reached.
///   R = (gamma - 1) v_0 t / 2
inline double noh_shock_radius(const NohProblem& noh, double t) {
    return 0.5 * (noh.gamma - 1.0) * noh.speed * t;
}

/// The gas at a radius.
///   r < R: rho = rho_0 [(gamma + 1) / (gamma - 1)]^dimension, at rest, e = v_0^2 / 2
///   r > R: rho = rho_0 (1 + v_0 t / r)^(dimension - 1), cold, falling with v_0
/// exact: gamma = 5/3 has 4, 16 or 64 rho_0 behind the shock, gamma = 1.4 has 6, 36 or 216
/// source: Noh, J. Comput. Phys. 72, 78 (1987).
inline NohState noh_state(const NohProblem& noh, double r, double t) {
    const double rho = noh.density, v = noh.speed;
    if (r > noh_shock_radius(noh, t))
        return {rho * std::pow(1.0 + v * t / r, noh.dimension - 1), -v, 0.0, 0.0};
    const double ratio = (noh.gamma + 1.0) / (noh.gamma - 1.0);
    const double behind = rho * std::pow(ratio, noh.dimension), e = 0.5 * v * v;
    return {behind, 0.0, (noh.gamma - 1.0) * behind * e, e};
}

}  // namespace flip::theory
