// What the theta scheme does to waves of small amplitude: the exact factor g by which a wave is
// multiplied in one step, so that |g| is its damping and arg g its frequency times dt.
#pragma once

#include <complex>

namespace implicit_moment {

/// A light wave in vacuum, E and B taken at the level theta in both of Maxwell's equations.
///   g = [1 + i a_0 (1 - theta)] / (1 - i a_0 theta),  a_0 = c dt K
/// in:    theta; a_0, with K the wave number that the differences of the mesh see
/// out:   g of the wave with positive frequency; the other one has conj g
/// exact: |g| = 1 for theta = 1/2, then tan(omega dt / 2) = a_0 / 2
inline std::complex<double> theta_light_wave(double theta, double a_0) {
    return std::complex<double>(1.0, a_0 * (1.0 - theta)) / std::complex<double>(1.0, -a_0 * theta);
}

}  // namespace implicit_moment
