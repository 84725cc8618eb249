// What the theta scheme does to waves of small amplitude: the exact factor g by which a wave is
// multiplied in one step, so that |g| is its damping and arg g its frequency times dt.
#pragma once

#include <cmath>
#include <complex>

namespace common {

/// A light wave in vacuum, E and B taken at the level theta in both of Maxwell's equations.
///   g = [1 + i a_0 (1 - theta)] / (1 - i a_0 theta),  a_0 = c dt K
/// in:    theta; a_0, with K the wave number that the differences of the mesh see
/// out:   g of the wave with positive frequency; the other one has conj g
/// exact: |g| = 1 for theta = 1/2, then tan(omega dt / 2) = a_0 / 2
inline std::complex<double> theta_light_wave(double theta, double a_0) {
    return std::complex<double>(1.0, a_0 * (1.0 - theta)) / std::complex<double>(1.0, -a_0 * theta);
}

/// A Langmuir wave in a cold plasma whose particles are moved by E at the level theta.
///   (g - 1)^2 = -(W^2 / 2) (1 + g) (theta g + 1 - theta),  W = omega_p dt
/// in:    theta; W
/// out:   the root with the larger imaginary part; of two real roots, which exist for
///        theta > 1/2 and large W, the larger one in absolute value
/// exact: |g| = 1 for theta = 1/2, then tan(omega dt / 2) = W / 2; |g|^2 = 1 / (1 + W^2 / 2) for
///        theta = 1 while g is complex
inline std::complex<double> theta_langmuir_wave(double theta, double W) {
    // a g^2 - 2 b g + d = 0
    const double s = 0.5 * W * W;
    const double a = 1.0 + s * theta, b = 1.0 - 0.5 * s, d = 1.0 + s * (1.0 - theta);
    const double discriminant = b * b - a * d;
    if (discriminant <= 0.0) return {b / a, std::sqrt(-discriminant) / a};
    return (b + std::copysign(std::sqrt(discriminant), b)) / a;
}

}  // namespace common
