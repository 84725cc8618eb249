// The plasma dispersion function of Fried and Conte, which turns a Maxwellian into an algebraic
// dispersion relation.
//
//   Z(zeta) = pi^-1/2 integral dt exp(-t^2) / (t - zeta)   for Im zeta > 0, continued to the plane
//           = i pi^1/2 w(zeta),  w(zeta) = exp(-zeta^2) erfc(-i zeta)
#pragma once

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace common {

namespace plasma_dispersion_detail {

using Complex = std::complex<double>;

/// The tail q of Laplace's continued fraction Z = -1 / (zeta - q), for zeta far from the origin and
/// not below the real axis.
///   q = (1/2) / (zeta - 1 / (zeta - (3/2) / (zeta - ...)))
/// note:  more levels would bring the poles of the fraction, which lie on the real axis, near zeta.
inline Complex continued_fraction_tail(Complex zeta) {
    constexpr int levels = 20;
    Complex tail = 0.0;
    for (int n = levels; n > 0; --n) tail = 0.5 * n / (zeta - tail);
    return tail;
}

/// w(zeta) near the origin and not below the real axis: the trapezoidal sum of its integral,
/// corrected for the pole of the integrand.
///   w = (i h zeta / pi) sum_k exp(-t_k^2) / (zeta^2 - t_k^2)
///       + 2 exp(-zeta^2) / (1 +- exp(-2 pi i zeta / h))
/// with t_k = (k + 1/2) h and +, or t_k = k h and -, whichever keeps zeta away from all t_k.
/// exact:  the error of the sum is exp(-(pi / h)^2) < 1e-17
/// source: Chiarella and Reichel, Math. Comp. 22, 137 (1968).
inline Complex trapezoidal_sum(Complex zeta) {
    constexpr double h = 0.5;
    constexpr int terms = 14;
    const double position = zeta.real() / h - std::floor(zeta.real() / h);
    const bool halves = position < 0.25 || position > 0.75;
    const Complex square = zeta * zeta;
    Complex sum = halves ? Complex(0.0) : 1.0 / square;
    for (int k = halves ? 0 : 1; k <= terms; ++k) {
        const double t = (halves ? k + 0.5 : k) * h;
        sum += 2.0 * std::exp(-t * t) / (square - t * t);
    }
    const Complex pole = std::exp(Complex(0.0, -2.0 * std::numbers::pi / h) * zeta);
    const Complex correction = 2.0 * std::exp(-square) / (halves ? 1.0 + pole : 1.0 - pole);
    return Complex(0.0, h / std::numbers::pi) * zeta * sum + correction;
}

/// Z and 1 + zeta Z, the latter without cancellation for large zeta.
struct Values {
    Complex Z, one_plus_zeta_Z;
};

/// Z for Im zeta >= 0: the continued fraction far from the origin, the sum near to it.
inline Values not_below_real_axis(Complex zeta) {
    if (std::norm(zeta) > 49.0) {
        const Complex q = continued_fraction_tail(zeta);
        return {-1.0 / (zeta - q), -q / (zeta - q)};
    }
    const Complex Z = Complex(0.0, 1.0 / std::numbers::inv_sqrtpi) * trapezoidal_sum(zeta);
    return {Z, 1.0 + zeta * Z};
}

/// Below the real axis by continuation: Z(zeta) = 2 i pi^1/2 exp(-zeta^2) - Z(-zeta).
inline Values values(Complex zeta) {
    if (zeta.imag() >= 0.0) return not_below_real_axis(zeta);
    constexpr double overflow = 700.0, none = std::numeric_limits<double>::quiet_NaN();
    if (!((zeta * zeta).real() > -overflow)) return {{none, none}, {none, none}};
    const Values mirrored = not_below_real_axis(-zeta);
    const Complex wave = Complex(0.0, 2.0 / std::numbers::inv_sqrtpi) * std::exp(-zeta * zeta);
    return {wave - mirrored.Z, mirrored.one_plus_zeta_Z + zeta * wave};
}

}  // namespace plasma_dispersion_detail

/// The plasma dispersion function Z, in the whole plane.
/// exact:  relative error below 1e-12, where below the real axis it is relative to the larger of
///         the two terms of the continuation; Z' = -2 (1 + zeta Z); Z(-conj zeta) = -conj Z(zeta).
///         Where exp(-zeta^2) overflows, deep below the real axis, the result is not a number.
/// source: Fried and Conte, The Plasma Dispersion Function (1961).
inline std::complex<double> plasma_dispersion(std::complex<double> zeta) {
    return plasma_dispersion_detail::values(zeta).Z;
}

/// 1 + zeta Z(zeta): the answer of a Maxwellian to an electrostatic wave.
/// exact:  as plasma_dispersion, also for large zeta, where it is -1/(2 zeta^2) - 3/(4 zeta^4)
inline std::complex<double> plasma_response(std::complex<double> zeta) {
    return plasma_dispersion_detail::values(zeta).one_plus_zeta_Z;
}

}  // namespace common
