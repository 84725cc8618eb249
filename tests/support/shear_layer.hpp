// The Kelvin-Helmholtz instability of a smooth shear layer: what a kink grows like that the drift
// waves of a current sheet have prepared.
#pragma once

#include <cmath>
#include <complex>

namespace facts {

namespace detail {

// phi' / phi in the middle of the layer, from its value -k far away.
//   w = phi' / phi,  w' = k^2 + U'' / (U - c) - w^2,  U = tanh y
inline std::complex<double> slope_in_the_middle(double k, std::complex<double> c) {
    constexpr double far = 12;
    constexpr int steps = 3000;
    const auto slope = [&](double y, std::complex<double> w) {
        const double U = std::tanh(y);
        return k * k - 2 * U * (1 - U * U) / (U - c) - w * w;
    };
    const double h = -far / steps;
    std::complex<double> w = -k;
    for (int n = 0; n < steps; ++n) {
        const double y = far + n * h;
        const auto k1 = slope(y, w), k2 = slope(y + 0.5 * h, w + 0.5 * h * k1);
        const auto k3 = slope(y + 0.5 * h, w + 0.5 * h * k2), k4 = slope(y + h, w + h * k3);
        w += h / 6 * (k1 + 2.0 * (k2 + k3) + k4);
    }
    return w;
}

}  // namespace detail

/// Growth rate, in units of U0 / a, of waves exp(i k y) along a layer U = U0 tanh(z / a) of a fluid
/// of uniform density, from Rayleigh's equation.
///   (U - c) (phi'' - k^2 phi) = U'' phi,  gamma = k Im c
/// in:    ka > 0
/// exact: 0 where ka >= 1; ka for ka << 1; at most 0.1897, at ka = 0.4446; error below 1e-4
/// note:  U is odd, so that Re c = 0 and phi(-z) is the conjugate of phi(z): phi' / phi is
///        imaginary in the middle. Neither compression nor B is in the theory.
/// source: Michalke, J. Fluid Mech. 19, 543 (1964).
inline double shear_layer_growth(double ka) {
    if (ka >= 1) return 0;
    double low = 0, high = 1;
    for (int halving = 0; halving < 40; ++halving) {
        const double c_imaginary = 0.5 * (low + high);
        const auto w = detail::slope_in_the_middle(ka, {0, c_imaginary});
        (w.real() > 0 ? low : high) = c_imaginary;
    }
    return ka * 0.5 * (low + high);
}

}  // namespace facts
