// The blast wave of an energy that is set free at a plane, a line or a point of a cold gas.
//
// All profiles are functions of lambda = r / R(t). They are known in closed form with the velocity
// as parameter, V = u t / r between its values 2 / ((nu + 2) gamma) in the middle and
// 4 / ((nu + 2) (gamma + 1)) at the shock, in nu dimensions. Here the parameter is s, from 0 to 1,
// with gamma (nu + 2) V / 2 = 1 + s^m (gamma - 1) / (gamma + 1): lambda is s times a smooth factor.
// source: Sedov, Similarity and Dimensional Methods in Mechanics, chapter 4; the exponents in the
//         notation of Kamm and Timmes, Los Alamos report LA-UR-07-2849 (2007).
#pragma once

#include <cmath>
#include <numbers>

#include "common/run/parameters.hpp"

namespace flip::theory {

/// The gas at one radius, in units of the shock.
struct BlastPoint {
    double radius;    // lambda = r / R
    double density;   // rho / rho_0
    double velocity;  // u / D, D = dR/dt
    double pressure;  // p / (rho_0 D^2)
};

/// The quantities of a blast that do not depend on the radius.
struct BlastWave {
    double gamma;
    int dimension;  // 1 plane, 2 cylinder, 3 sphere
    double alpha;   // E t^2 = alpha rho_0 R^(dimension + 2), with all the energy, of both sides
};

namespace sedov_detail {

/// The profile at the parameter s, and d lambda / ds.
struct ParametricPoint {
    BlastPoint point;
    double slope;
};
inline ParametricPoint at_parameter(double gamma, int dimension, double s) {
    const double nu = dimension, g = gamma, n = nu + 2.0;
    const double a0 = 2.0 / n, a2 = -(g - 1.0) / (2.0 * (g - 1.0) + nu);
    const double a1 = n * g / (2.0 + nu * (g - 1.0)) * (2.0 * nu * (2.0 - g) / (g * n * n) - a2);
    const double a4 = n / (2.0 - g) * a1, a5 = -2.0 / (2.0 - g);
    const double a3 = nu / (2.0 * (g - 1.0) + nu), m = -1.0 / a2;

    // The factors of the closed form, all 1 at the shock.
    const double b = (g + 1.0) / (g - 1.0), e = 0.5 * (2.0 + nu * (g - 1.0));
    const double x2 = std::pow(s, m), V = 2.0 / (n * g) * (1.0 + x2 / b);
    const double V_shock = 4.0 / (n * (g + 1.0));
    const double x1 = V / V_shock, x3 = (1.0 - e * V) / (1.0 - e * V_shock);
    const double x4 = b * (1.0 - 0.5 * n * V);

    const double smooth = std::pow(x1, -a0) * std::pow(x3, -a1);
    const double s_dV_ds = 2.0 / (n * g) * m * x2 / b;
    const double log_slope = 1.0 - (a0 / V - a1 * e / (1.0 - e * V)) * s_dV_ds;
    const double lambda = s * smooth;
    const double density = std::pow(s, m * a3) * std::pow(x3, a4) * std::pow(x4, a5);
    const double pressure =
        std::pow(x1, a0 * nu) * std::pow(x3, a4 - 2.0 * a1) * std::pow(x4, 1.0 + a5);
    return {{lambda, b * density, 2.0 / (g + 1.0) * x1 * lambda, 2.0 / (g + 1.0) * pressure},
            smooth * log_slope};
}

}  // namespace sedov_detail

/// The blast wave of a gas.
///   alpha = A (2 / (nu + 2))^2 integral_0^1 [rho u^2 / 2 + p / (gamma - 1)] lambda^(nu-1) dlambda
/// with A = 2, 2 pi or 4 pi
/// in:    1 < gamma < 2; 1, 2 or 3 dimensions
/// exact: gamma = 1.4 has alpha = 1.0774856, 0.9840740 and 0.8510719
/// errors: InputError for other gases, whose closed form is another one, and other dimensions.
inline BlastWave blast_wave(double gamma, int dimension) {
    if (!(gamma > 1.0 && gamma < 2.0 && dimension >= 1 && dimension <= 3))
        throw common::InputError(
            "the blast wave is known here for 1 < gamma < 2 in 1, 2 or 3 dimensions: take those");
    constexpr int panels = 1000;
    const double h = 1.0 / panels, aside = 0.5 * h * std::sqrt(0.6);
    const auto energy = [&](double s) {
        const auto [point, slope] = sedov_detail::at_parameter(gamma, dimension, s);
        const double density =
            0.5 * point.density * point.velocity * point.velocity + point.pressure / (gamma - 1.0);
        return density * std::pow(point.radius, dimension - 1) * slope;
    };
    // Gauss's rule of three points.
    double sum = 0.0;
    for (int i = 0; i < panels; ++i) {
        const double middle = (i + 0.5) * h;
        sum += 5.0 * energy(middle - aside) + 8.0 * energy(middle) + 5.0 * energy(middle + aside);
    }
    const double area = dimension == 1 ? 2.0 : 2.0 * (dimension - 1) * std::numbers::pi;
    const double D = 2.0 / (dimension + 2.0);
    return {gamma, dimension, area * D * D * sum * h / 18.0};
}

/// The radius of the shock; in one dimension, its distance from the plane.
///   R = (E t^2 / (alpha rho_0))^(1 / (nu + 2))
/// in:    E, all the energy; in 2 dimensions per length and in 1 per area, of both sides
inline double blast_radius(const BlastWave& w, double energy, double rho_0, double t) {
    return std::pow(energy * t * t / (w.alpha * rho_0), 1.0 / (w.dimension + 2.0));
}

/// The speed of the shock.
///   D = 2 R / ((nu + 2) t)
inline double blast_speed(const BlastWave& w, double energy, double rho_0, double t) {
    return 2.0 * blast_radius(w, energy, rho_0, t) / ((w.dimension + 2.0) * t);
}

/// The gas at r / R.
/// in:    lambda, from 0; above 1 is the cold gas in front of the shock
inline BlastPoint blast_point(const BlastWave& w, double lambda) {
    if (lambda > 1.0) return {lambda, 1.0, 0.0, 0.0};
    double low = 0.0, high = 1.0;
    for (;;) {
        const double middle = 0.5 * (low + high);
        if (!(low < middle && middle < high)) break;
        const bool inside =
            sedov_detail::at_parameter(w.gamma, w.dimension, middle).point.radius < lambda;
        (inside ? low : high) = middle;
    }
    return sedov_detail::at_parameter(w.gamma, w.dimension, high).point;
}

}  // namespace flip::theory
