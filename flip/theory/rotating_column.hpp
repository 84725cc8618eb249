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
#include <vector>

namespace flip::theory {

/// A column of uniform density in radial balance, dp/dr = density v_theta^2/r.
struct RotatingColumn {
    double radius, k;                       // wave number along z
    std::function<double(double)> v_theta;  // of r
    std::function<double(double)> sound_2;  // of r, square of the speed of sound
};

/// kappa^2 = (2 v/r^2) d(r v)/dr, by differences; 0 where these are round-off.
inline double epicyclic_2(const RotatingColumn& s, double r) {
    const double h = 1e-5 * s.radius, a = std::max(r - h, 0.1 * h), b = r + h, v = s.v_theta(r);
    const double slope = (b * s.v_theta(b) - a * s.v_theta(a)) / (b - a);
    return std::fabs(r * slope) < 1e-6 * std::fabs(r * v) ? 0 : 2 * v / (r * r) * slope;
}

/// The column at the borders of rings of equal width, j even, and in their middles, j odd.
struct Rings {
    static constexpr int count = 128;
    double h, k;
    std::vector<double> r, g, kappa_2, sound_2;  // g = v_theta^2/r

    explicit Rings(const RotatingColumn& s) : h(s.radius / count), k(s.k) {
        for (int j = 0; j <= 2 * count; ++j) {
            const double at = 0.5 * h * std::max(j, 1), v = s.v_theta(at);
            r.push_back(0.5 * h * j), g.push_back(v * v / at);
            kappa_2.push_back(epicyclic_2(s, at)), sound_2.push_back(s.sound_2(at));
        }
    }
    double largest_kappa_2() const {
        double largest = 0;
        for (const double each : kappa_2) largest = std::max(largest, std::fabs(each));
        return largest;
    }
};

/// omega^2 of the wave that is nearest to that of a fluid that keeps its volume, from the energy of
/// displacements xi along r, on the borders of the rings, and zeta along z, within them:
///   omega^2 sum r (xi^2 + zeta^2) = sum r (c^2 D^2 + 2 g xi D + kappa^2 xi^2)
///   D = (r xi)'/r + k zeta,   0 in a fluid that keeps its volume
/// of which the slowest, which grows the fastest, where that fluid has a wave that grows; else of all
/// waves, sound among them, the one that moves most like its fastest.
/// exact:  second order in the width of the rings
/// source: the linear equations of motion, continuity and constant entropy, with v_theta' of constant
///         angular momentum, multiplied by the displacement
double coarse_frequency_2(const Rings& s);

/// r times the displacement at the wall of a wave with omega^2 = lambda that begins as xi ~ r on the
/// axis; a wave of the column has none there.
///   (r xi)'/r = P (k^2/lambda - 1/c^2) - xi g/c^2
///   P' = (lambda - kappa^2) xi + g (P + g xi)/c^2,   P = p/density
/// source: as above; fourth-order Runge-Kutta steps
inline double displacement_at_wall(const Rings& s, double lambda) {
    struct State {
        double flux, P;  // r xi and P
    };
    const auto slope = [&](int j, const State& y) -> State {
        const double per_c2 = 1 / s.sound_2[j], g = s.g[j], xi = y.flux / s.r[j];
        return {s.r[j] * (y.P * (s.k * s.k / lambda - per_c2) - xi * g * per_c2),
                (lambda - s.kappa_2[j]) * xi + g * (y.P + g * xi) * per_c2};
    };
    const auto moved = [](const State& a, double by, const State& d) {
        return State{a.flux + by * d.flux, a.P + by * d.P};
    };
    State y{s.h * s.h * (s.k * s.k / lambda - 1 / s.sound_2[1]), 2};
    for (int j = 2; j < 2 * Rings::count; j += 2) {
        const State a = slope(j, y), b = slope(j + 1, moved(y, 0.5 * s.h, a)),
                    c = slope(j + 1, moved(y, 0.5 * s.h, b)), d = slope(j + 2, moved(y, s.h, c));
        y = moved(y, s.h / 6,
                  {a.flux + 2 * b.flux + 2 * c.flux + d.flux, a.P + 2 * b.P + 2 * c.P + d.P});
    }
    return y.flux;
}

/// omega^2 of the wave without a node between axis and wall: of the fastest that grows, below 0, where
/// L^2 falls anywhere outward and one does; else of the fastest inertial wave.
/// out:    0 where there is none, as without rotation
/// exact:  of rigid rotation in a fluid that keeps its volume (2 Omega)^2 k^2/(k^2 + (j_1/R)^2),
///         J_1(j_1) = 0
/// source: Kelvin, Phil. Mag. 10, 155 (1880); Rayleigh, Proc. R. Soc. A 93, 148 (1917)
inline double inertial_frequency_2(const RotatingColumn& column) {
    const Rings s(column);
    if (s.largest_kappa_2() == 0) return 0;
    const double near = coarse_frequency_2(s);
    for (double width = 1e-4; width < 0.1; width *= 2) {
        double a = near * (1 - width), b = near * (1 + width);
        const bool at_a = displacement_at_wall(s, a) < 0;
        if (at_a == (displacement_at_wall(s, b) < 0)) continue;
        for (int halving = 0; halving < 50; ++halving) {
            const double middle = 0.5 * (a + b);
            ((displacement_at_wall(s, middle) < 0) == at_a ? a : b) = middle;
        }
        return 0.5 * (a + b);
    }
    return near;
}

}  // namespace flip::theory
