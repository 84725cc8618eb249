// A gas, and one wave of Riemann's problem that runs into it.
//
//   p = (gamma - 1) rho e - gamma p_infinity,  c^2 = gamma (p + p_infinity) / rho
//
// With P = p + p_infinity a stiffened gas moves like an ideal one of pressure P; p_infinity = 0 is
// an ideal gas. A wave is a shock where it raises the pressure, and a fan where it lowers it.
// source: Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, chapters 3 and 4.
#pragma once

#include <algorithm>
#include <cmath>

namespace flip::theory {

/// A gas at one place; a density of 0 is a void.
struct GasState {
    double density, velocity, pressure;
    double gamma, p_infinity = 0.0;
};

/// The speed of sound.
///   c = [gamma (p + p_infinity) / rho]^1/2
/// exact: zero in a void
inline double sound_speed(const GasState& s) {
    return s.density > 0.0 ? std::sqrt(s.gamma * (s.pressure + s.p_infinity) / s.density) : 0.0;
}

/// Internal and kinetic energy per volume.
///   E = (p + gamma p_infinity) / (gamma - 1) + rho u^2 / 2
/// note:  a void has E = -p, the work against the pressure around it; it is zero around a liquid
///        with a free surface, and p_infinity where gases tear apart at p = -p_infinity.
inline double energy_per_volume(const GasState& s) {
    if (!(s.density > 0.0)) return -s.pressure;
    return (s.pressure + s.gamma * s.p_infinity) / (s.gamma - 1.0) +
           0.5 * s.density * s.velocity * s.velocity;
}

namespace riemann_detail {

/// The gas in front of a wave that runs to the left, side = -1, or to the right, side = 1.
struct Front {
    GasState gas;
    double side;
    double P() const { return gas.pressure + gas.p_infinity; }
};

/// log(P / P_front), exact also for small differences.
inline double log_ratio(double P, double P_front) {
    const double change = (P - P_front) / P_front;
    return std::abs(change) < 0.5 ? std::log1p(change) : std::log(P / P_front);
}

/// The mass that a shock sweeps up per area and time.
///   Q = [rho ((gamma + 1) P + (gamma - 1) P_front) / 2]^1/2
inline double swept_mass(const Front& f, double P) {
    const double g = f.gas.gamma;
    return std::sqrt(0.5 * f.gas.density * ((g + 1.0) * P + (g - 1.0) * f.P()));
}

/// By how much a wave speeds up the gas in the direction in which it runs.
///   shock: (P - P_front) / Q
///   fan:   2 c / (gamma - 1) [(P / P_front)^((gamma - 1) / 2 gamma) - 1]
inline double push(const Front& f, double P) {
    if (f.gas.density == 0.0 || P == f.P()) return 0.0;
    if (P > f.P()) return (P - f.P()) / swept_mass(f, P);
    const double g = f.gas.gamma;
    const double power = P > 0.0 ? std::expm1((g - 1.0) / (2.0 * g) * log_ratio(P, f.P())) : -1.0;
    return 2.0 * sound_speed(f.gas) / (g - 1.0) * power;
}

/// The gas behind a wave.
inline GasState behind(const Front& f, double P) {
    GasState s = f.gas;
    const double g = s.gamma, P_front = f.P();
    s.pressure = P - s.p_infinity;
    s.velocity += f.side * push(f, P);
    if (P > P_front)
        s.density *= ((g + 1.0) * P + (g - 1.0) * P_front) / ((g - 1.0) * P + (g + 1.0) * P_front);
    else if (P < P_front)
        s.density *= P > 0.0 ? std::exp(log_ratio(P, P_front) / g) : 0.0;
    return s;
}

/// The speed of the edge of a wave that touches the gas in front of it.
inline double head_speed(const Front& f, double P) {
    const bool shock = P > f.P();
    const double relative = shock ? swept_mass(f, P) / f.gas.density : sound_speed(f.gas);
    return f.gas.velocity + f.side * relative;
}

/// The gas in a fan.
///   c = (gamma - 1) / (gamma + 1) [side (x / t - u_front) + 2 c_front / (gamma - 1)]
inline GasState in_fan(const Front& f, double x_over_t) {
    GasState s = f.gas;
    const double g = s.gamma, c_front = sound_speed(s), away = f.side * (x_over_t - s.velocity);
    const double c = std::max(((g - 1.0) * away + 2.0 * c_front) / (g + 1.0), 0.0);
    s.velocity = x_over_t - f.side * c;
    s.density *= std::pow(c / c_front, 2.0 / (g - 1.0));
    s.pressure = f.P() * std::pow(c / c_front, 2.0 * g / (g - 1.0)) - s.p_infinity;
    return s;
}

}  // namespace riemann_detail

}  // namespace flip::theory
