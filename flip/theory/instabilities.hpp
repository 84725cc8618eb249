// Waves that grow at the interface of two fluids and in a shear layer, at small amplitude and far
// below the speed of sound.
//
// z points up and gravity down. Waves vary like exp(i k x - i omega t): Im omega is a growth rate.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace flip::theory {

/// Fluid 1 below z = 0, fluid 2 above it, between rigid walls at z = -lower_depth and upper_depth.
struct TwoLayers {
    double lower_density, upper_density;
    double gravity = 0.0;
    double lower_velocity = 0.0, upper_velocity = 0.0;  // along x
    double lower_depth = std::numeric_limits<double>::infinity();
    double upper_depth = std::numeric_limits<double>::infinity();
};

/// The frequency of waves at the interface.
///   (a_1 + a_2) omega = k (a_1 U_1 + a_2 U_2)
///                       +- [(a_1 + a_2) g k (rho_1 - rho_2) - a_1 a_2 k^2 (U_2 - U_1)^2]^1/2
/// with a = rho coth k H, from the pressure on both sides of z = eta:
///   a_1 (omega - k U_1)^2 + a_2 (omega - k U_2)^2 = g k (rho_1 - rho_2)
/// in:    k > 0
/// out:   the root that grows, or the larger of two real roots
/// exact: Im omega = (A g k)^1/2, A = (rho_2 - rho_1) / (rho_2 + rho_1), for heavy fluid at rest
///        on top of light fluid, both deep (Rayleigh and Taylor); k |U_2 - U_1| / 2 for equal
///        densities (Helmholtz and Kelvin)
/// source: Lamb, Hydrodynamics, articles 231 and 232.
inline std::complex<double> interface_frequency(const TwoLayers& s, double k) {
    const double a_1 = s.lower_density / std::tanh(k * s.lower_depth);
    const double a_2 = s.upper_density / std::tanh(k * s.upper_depth), a = a_1 + a_2;
    const double shear = k * (s.upper_velocity - s.lower_velocity);
    const double weight = s.gravity * k * (s.lower_density - s.upper_density);
    const std::complex<double> square = (weight - a_1 * a_2 / a * shear * shear) / a;
    return k * (a_1 * s.lower_velocity + a_2 * s.upper_velocity) / a + std::sqrt(square);
}

/// The growth rate of waves at the interface; zero where they do not grow.
inline double interface_growth(const TwoLayers& s, double k) {
    return interface_frequency(s, k).imag();
}

/// A fluid of one density with U(z) = velocity_difference / 2 times z / half_width, clamped to
/// +-1, between rigid walls at z = +-wall_distance.
struct ShearLayer {
    double velocity_difference, half_width;  // U(d) - U(-d), and d
    double wall_distance = std::numeric_limits<double>::infinity();
};

namespace instabilities_detail {

/// Green's function of -d^2/dz^2 + k^2 between rigid walls at z = +-b.
///   sinh k (b - z_high) sinh k (b + z_low) / (k sinh 2 k b)
inline double green(double k, double b, double z, double from) {
    const double high = std::max(z, from), low = std::min(z, from);
    const double decay = std::exp(-k * (high - low)) / (2.0 * k);
    if (std::isinf(b)) return decay;
    return decay * std::expm1(-2.0 * k * (b - high)) * std::expm1(-2.0 * k * (b + low)) /
           -std::expm1(-4.0 * k * b);
}

}  // namespace instabilities_detail

/// The frequency of waves in a shear layer.
/// By (U - c) (psi'' - k^2 psi) = U'' psi vorticity is disturbed at the two kinks of U only. With
/// S = velocity_difference / 2 d and Green's function G of walls, psi = A G(z, d) + B G(z, -d):
///   A (S d - S G_same - c) = S G_other B
///   B (S d - S G_same + c) = S G_other A
///   (omega / k)^2 = c^2 = S^2 [(d - G_same)^2 - G_other^2]
/// in:    k > 0
/// out:   the root that grows, or the positive one of two real roots; the other is -omega
/// exact: without walls omega^2 = (S / 2)^2 [(1 - 2 k d)^2 - exp(-4 k d)], which grows for
///        k d < 0.6392 and becomes k velocity_difference / 2 for k d -> 0
/// source: Rayleigh, Proc. London Math. Soc. 11, 57 (1880).
inline std::complex<double> shear_layer_frequency(const ShearLayer& s, double k) {
    using instabilities_detail::green;
    const double d = s.half_width, b = s.wall_distance, S = 0.5 * s.velocity_difference / d;
    const double same = green(k, b, d, d), other = green(k, b, d, -d);
    const double square = (d - same - other) * (d - same + other);
    return std::abs(S) * k * std::sqrt(std::complex<double>(square));
}

/// The growth rate of waves in a shear layer; zero where they do not grow.
inline double shear_layer_growth(const ShearLayer& s, double k) {
    return shear_layer_frequency(s, k).imag();
}

}  // namespace flip::theory
