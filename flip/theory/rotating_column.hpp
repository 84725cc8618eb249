// A column of fluid that turns about its axis, between slip walls: its waves of small amplitude, and
// whether they grow.
//
// The fluid is displaced by xi along r. A ring keeps its angular momentum L, and where L^2 rises
// outward it is pulled back, at the rate kappa of its epicycles, kappa^2 = (1/r^3) d(L^2)/dr: these are
// inertial waves, and Rayleigh's criterion is the sign of kappa^2.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

namespace flip::theory {

/// A column of uniform density in radial balance, dp/dr = density v_theta^2/r.
struct RotatingColumn {
    double radius, k;                       // wave number along z
    std::function<double(double)> v_theta;  // of r
    std::function<double(double)> sound_2;  // of r, square of the speed of sound
};

/// kappa^2 = (2 v/r^2) d(r v)/dr, by differences.
inline double epicyclic_2(const RotatingColumn& s, double r) {
    const double h = 1e-5 * s.radius, a = std::max(r - h, 0.1 * h), b = r + h;
    const double slope = (b * s.v_theta(b) - a * s.v_theta(a)) / (b - a);
    return 2 * s.v_theta(r) / (r * r) * slope;
}

/// The displacement at the wall of a wave with omega^2 = lambda that begins as xi = r on the axis; a
/// wave of the column has none there.
///   (r xi)'/r = P (k^2/lambda - 1/c^2) - xi g/c^2,   g = v_theta^2/r
///   P' = (lambda - kappa^2) xi + g (P + g xi)/c^2,   P = p/density
/// source: the linear equations of motion, continuity and constant entropy, with v_theta' of constant
///         angular momentum; fourth-order Runge-Kutta steps
inline double displacement_at_wall(const RotatingColumn& s, double lambda, int steps = 200) {
    struct State {
        double flux, P;  // r xi and P
    };
    const auto slope = [&](double r, const State& y) -> State {
        const double v = s.v_theta(r), g = v * v / r, per_c2 = 1 / s.sound_2(r), xi = y.flux / r;
        return {r * (y.P * (s.k * s.k / lambda - per_c2) - xi * g * per_c2),
                (lambda - epicyclic_2(s, r)) * xi + g * (y.P + g * xi) * per_c2};
    };
    const double h = s.radius / steps;
    double r = 0.01 * h;
    State y{r * r, 2 / (s.k * s.k / lambda - 1 / s.sound_2(r))};
    const auto moved = [](const State& a, double by, const State& d) {
        return State{a.flux + by * d.flux, a.P + by * d.P};
    };
    for (int n = 0; n < steps; ++n) {
        const double end = n + 1 == steps ? s.radius : (n + 1) * h, step = end - r;
        const State a = slope(r, y), b = slope(r + 0.5 * step, moved(y, 0.5 * step, a)),
                    c = slope(r + 0.5 * step, moved(y, 0.5 * step, b)),
                    d = slope(end, moved(y, step, c));
        y = moved(y, step / 6,
                  {a.flux + 2 * b.flux + 2 * c.flux + d.flux, a.P + 2 * b.P + 2 * c.P + d.P});
        r = end;
    }
    return y.flux / s.radius;
}

/// omega^2 of the wave without a node between axis and wall: of the fastest that grows, below 0, where
/// L^2 falls anywhere outward and one does; else of the fastest inertial wave.
/// out:    0 where there is none, as without rotation
/// exact:  of rigid rotation in a fluid that keeps its volume (2 Omega)^2 k^2/(k^2 + (j_1/R)^2),
///         J_1(j_1) = 0
/// source: Kelvin, Phil. Mag. 10, 155 (1880); Rayleigh, Proc. R. Soc. A 93, 148 (1917)
inline double inertial_frequency_2(const RotatingColumn& s) {
    double least = 0, most = 0;
    constexpr int places = 200, tries = 200;
    for (int n = 1; n <= places; ++n) {
        const double r = s.radius * (n - 0.5) / places, kappa_2 = epicyclic_2(s, r),
                     turns = s.v_theta(r) / r;
        if (std::fabs(kappa_2) < 1e-4 * turns * turns) continue;  // differences of one number
        least = std::min(least, kappa_2), most = std::max(most, kappa_2);
    }
    for (const double first : {least, most}) {
        if (first == 0) continue;
        double a = first, at_a = displacement_at_wall(s, a);
        for (int n = 1; n < tries; ++n) {
            double b = first * (1 - double(n) / tries);
            const double at_b = displacement_at_wall(s, b);
            if ((at_a < 0) == (at_b < 0)) {
                a = b, at_a = at_b;
                continue;
            }
            for (int halving = 0; halving < 60; ++halving) {
                const double middle = 0.5 * (a + b);
                ((displacement_at_wall(s, middle) < 0) == (at_a < 0) ? a : b) = middle;
            }
            return 0.5 * (a + b);
        }
    }
    return 0;
}

}  // namespace flip::theory
