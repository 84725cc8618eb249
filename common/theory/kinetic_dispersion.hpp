// Waves of small amplitude in a uniform plasma: the frequencies that linear theory gives for one
// wave number, as the roots of a dispersion relation D(omega) = 0.
//
// Every wave varies like exp(i k x - i omega t): Im omega is a growth rate, and a damping rate
// where it is negative. Units are Gaussian and otherwise free: omega_s^2 = 4 pi n q^2 / m.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "common/theory/plasma_dispersion.hpp"

namespace common {

using Complex = std::complex<double>;

/// What a dispersion relation is at a pole, or where its terms overflow.
inline constexpr Complex no_value{std::numeric_limits<double>::quiet_NaN(),
                                  std::numeric_limits<double>::quiet_NaN()};

/// A uniform species; "along" means along the wave vector k.
struct PlasmaSpecies {
    double density = 0.0, charge = 0.0, mass = 1.0;
    double drift = 0.0;               // mean velocity along k
    double temperature_along = 0.0;   // zero for a cold species
    double temperature_across = 0.0;  // of the velocity in the plane across k; in an unmagnetized
                                      // plasma of the one along E, with m u^2 of drifts along E
    double gyrofrequency = 0.0;       // q B_0 / (m c), with its sign; B_0 along k, or zero

    /// The plasma frequency squared, 4 pi n q^2 / m.
    double frequency_squared() const {
        return 4.0 * std::numbers::pi * density * charge * charge / mass;
    }
    /// The thermal speed along k, (T / m)^1/2.
    double speed_along() const { return std::sqrt(temperature_along / mass); }
};

/// Waves with E along k.
///   D = 1 + sum_s omega_s^2 / (k v_s)^2 [1 + zeta_s Z(zeta_s)],
///   zeta_s = (omega - k u_s) / (2^1/2 k v_s),  v_s^2 = T_s / m_s
///   and for a cold species  - omega_s^2 / (omega - k u_s)^2
/// source: Fried and Conte (1961); Stix, Waves in Plasmas (1992), chapter 8.
inline Complex longitudinal_dispersion(std::span<const PlasmaSpecies> plasma, double k,
                                       Complex omega) {
    Complex D = 1.0;
    for (const auto& s : plasma) {
        const Complex doppler = omega - k * s.drift;
        const double kv = std::abs(k) * s.speed_along();
        if (kv == 0.0) {
            if (doppler * doppler == 0.0) return no_value;
            D -= s.frequency_squared() / (doppler * doppler);
        } else {
            const Complex zeta = doppler / (std::numbers::sqrt2 * kv);
            D += s.frequency_squared() / (kv * kv) * plasma_response(zeta);
        }
    }
    return D;
}

/// exp(-x) I_n(x) of the modified Bessel functions for n = 0, 1, ..., until they are below round-off:
/// what harmonic n of its gyration takes of a Maxwellian, x = (k_across v_across / Omega)^2.
///   The ratios I_n / I_(n-1) = x / (2 n + x I_(n+1) / I_n) are taken downward, and
///   exp(-x) (I_0 + 2 I_1 + 2 I_2 + ...) = 1 gives the first.
inline std::vector<double> harmonics_of_maxwellian(double x) {
    const auto count = std::size_t(20 + 9 * std::sqrt(x));
    std::vector<double> I(count + 2, 0.0);
    for (std::size_t n = count; n > 0; --n) I[n] = x / (2 * double(n) + x * I[n + 1]);
    I[0] = 1;
    double sum = 1;
    for (std::size_t n = 1; n <= count; ++n) sum += 2 * (I[n] *= I[n - 1]);
    for (double& value : I) value /= sum;
    return I;
}

struct DispersionRoot {
    Complex omega = {0.0, -std::numeric_limits<double>::infinity()};
    bool found = false;
};

/// Newton's step from omega to the root of D, with the derivative across 1e-5 |omega|.
/// out:   not a number where D is not finite, or does not change, or squares overflow
template <class Dispersion>
Complex newton_step(const Dispersion& D, Complex omega) {
    if (!(std::abs(omega) < 1e150)) return no_value;
    const Complex aside = 1e-5 * omega, D_here = D(omega);
    if (D_here == 0.0) return 0.0;
    const Complex change = D(omega + aside) - D_here;
    const auto finite = [](Complex z) {
        return std::isfinite(z.real()) && std::isfinite(z.imag());
    };
    if (!finite(D_here) || !finite(change) || change == 0.0) return no_value;
    return -D_here * aside / change;
}

/// The root of D that Newton's method reaches from a guess, with steps no longer than |guess|.
/// in:    D(omega), analytic; guess, not zero
/// exact: found means that a step shorter than 1e-8 |omega| was followed by two more
template <class Dispersion>
DispersionRoot root_near(const Dispersion& D, Complex guess) {
    const double longest = std::abs(guess);
    Complex omega = guess;
    for (int iteration = 0; iteration < 100; ++iteration) {
        Complex step = newton_step(D, omega);
        const double length = std::abs(step);
        if (!std::isfinite(length)) return {};
        if (length > longest) step *= longest / length;
        omega += step;
        // Once a step is this short, two more reach round-off.
        if (length <= 1e-8 * std::abs(omega)) {
            for (int more = 0; more < 2; ++more) omega += newton_step(D, omega);
            return {omega, true};
        }
    }
    return {};
}

/// Of the roots that are reached from all guesses the one with the largest Im omega; of roots that
/// grow at the same rate the one with the largest |Re omega|, to the right of two as large.
template <class Dispersion>
DispersionRoot fastest_growing_root(const Dispersion& D, const std::vector<Complex>& guesses) {
    DispersionRoot best;
    for (const Complex guess : guesses) {
        const DispersionRoot root = root_near(D, guess);
        if (!root.found) continue;
        const double same = 1e-9 * std::abs(root.omega);
        const double lead = root.omega.imag() - best.omega.imag();
        const double away = std::abs(root.omega.real()) - std::abs(best.omega.real());
        const bool further =
            std::abs(lead) <= same && (std::abs(away) > same ? away > 0 : root.omega.real() > 0);
        if (!best.found || lead > same || further) best = root;
    }
    return best;
}

/// Guesses for the roots at wave number k: a fan around each natural frequency of the plasma, as it
/// is and carried along by each species.
///   { 0, k u_s } + f r exp(i phi),  f in { omega_s, |Omega_s|, k v_s, |k u_s|, c k, omega_total }
inline std::vector<Complex> fan_of_guesses(std::span<const PlasmaSpecies> plasma, double k,
                                           double c = 0.0) {
    std::vector<double> frequencies, centers{0.0};
    double total_squared = 0.0;
    for (const auto& s : plasma) {
        total_squared += s.frequency_squared();
        for (const double f : {std::sqrt(s.frequency_squared()), std::abs(s.gyrofrequency),
                               std::abs(k) * s.speed_along(), std::abs(k * s.drift)})
            frequencies.push_back(f);
        if (s.drift != 0.0) centers.push_back(k * s.drift);
    }
    frequencies.push_back(std::sqrt(total_squared));
    frequencies.push_back(std::abs(c * k));
    std::ranges::sort(frequencies);
    const auto close = [](double a, double b) { return b - a <= 0.05 * b; };
    frequencies.erase(std::unique(frequencies.begin(), frequencies.end(), close),
                      frequencies.end());

    std::vector<Complex> guesses;
    for (const double center : centers)
        for (const double f : frequencies)
            for (const double radius : {0.1, 0.4, 0.8, 1.3, 2.0})
                for (const double degrees : {-15.0, 3.0, 30.0, 60.0, 90.0, 120.0, 150.0, 177.0})
                    if (f > 0.0)
                        guesses.push_back(
                            center + std::polar(f * radius, degrees * std::numbers::pi / 180.0));
    return guesses;
}

}  // namespace common
