// Rayleigh's empty cavity that a pressure closes, in a sphere of liquid with a free surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace flip::theory {

/// An empty cavity in the middle of a sphere of liquid, and what presses on the liquid from outside.
struct EmptyCavity {
    double radius = 1, density = 1, pressure = 1;
    double outer = std::numeric_limits<double>::infinity();   // radius of the liquid
    double volume = std::numeric_limits<double>::infinity();  // of the gas that presses
    double gamma = 1.4;                                       // of that gas
};

/// How far the cavity has closed.
struct Collapse {
    std::vector<double> time, radius;  // to radius 0
    double radius_at(double t) const {
        const auto after = std::upper_bound(time.begin(), time.end(), t);
        if (after == time.end()) return 0;
        const auto n = std::max<std::ptrdiff_t>(1, after - time.begin());
        return radius[n - 1] +
               (radius[n] - radius[n - 1]) * (t - time[n - 1]) / (time[n] - time[n - 1]);
    }
};

/// The radius of the cavity in time, for an incompressible liquid.
///   2 pi rho R^3 (1 - R/S) (dR/dt)^2 = W,  S^3 = S_0^3 - R_0^3 + R^3
///   W = p V_0 [1 - (V_0/V)^(gamma-1)]/(gamma - 1),  V = V_0 + 4 pi (R_0^3 - R^3)/3,
///   the work of a gas that expands from V_0; of constant pressure, p (V - V_0)
/// exact:  without bounds, time.back() = 0.914681 R_0 (rho/p)^1/2
/// source: Rayleigh, Phil. Mag. 34, 94 (1917); the sphere of liquid: Obreschkow et al., Phys. Rev.
///         Lett. 97, 094502 (2006)
/// note:   steps even in (1 - R/R_0)^1/2, in which the time is smooth at the start
inline Collapse collapse_of(const EmptyCavity& c, int steps = 4000) {
    Collapse all{{0}, {c.radius}};
    const double whole = 4 * std::acos(-1.0) / 3, s3 = std::pow(c.outer / c.radius, 3) - 1;
    for (int n = 0; n < steps; ++n) {
        const double u = (n + 0.5) / steps, end = (n + 1.0) / steps, x = 1 - u * u;
        const double closed = 1 - x * x * x,
                     filled = whole * std::pow(c.radius, 3) * closed / c.volume;
        const double expands =
            filled > 0 ? -std::expm1((1 - c.gamma) * std::log1p(filled)) / ((c.gamma - 1) * filled)
                       : 1;
        const double inertia = 1 - x / std::cbrt(s3 + x * x * x);
        const double slowness =
            std::sqrt(1.5 * c.density / c.pressure * x * x * x * inertia / (closed * expands));
        all.time.push_back(all.time.back() + c.radius * slowness * 2 * u / steps);
        all.radius.push_back(c.radius * (1 - end * end));
    }
    return all;
}

}  // namespace flip::theory
