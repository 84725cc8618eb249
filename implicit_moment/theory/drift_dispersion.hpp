// The lower-hybrid drift instability of a Harris sheet in local linear theory.
//
// Waves exp(i k y - i omega t) along the current and across B, electrostatic, at one height z. Ions
// do not feel B in the short time that a wave needs to grow. Electrons are frozen to it: their
// guiding centers rest, and the gradient of the density makes them drift all the same. On demand
// the guiding centers drift in grad B.
//   D = 1 + sum over sheet and background of
//       { [1 + zeta Z(zeta)] + (T_i / T_e) [1 - Gamma_0(b) (omega - k u_e) / omega] } / (k l_i)^2,
//   zeta = (omega - k u_i) / (k v_i),  b = k^2 rho_e^2 / 2,  Gamma_0 = exp(-b) I_0(b),
//   with n, B, rho_e and the Debye length l_i of the ions at z, and with the drift in grad B
//   Gamma_0 / omega -> integral ds exp(-s) J_0(k rho_e s^1/2)^2 / (omega - k v_B s),  s > 0
// Units: half-width L of the sheet, 1 / Omega_ci of the ions in B0, density n0 in the middle.
//
// note: Neglected are the variation of the wave with z, its magnetic field, and harmonics of the
//       electron gyrofrequency: small where k L >> 1, k c / omega_pe >> 1 and omega << Omega_ce.
//       With guiding centers at rest long waves grow at z < 1; the drift in grad B stops them.
// source: Krall and Liewer, Phys. Rev. A 4, 2094 (1971); Davidson, Gladd, Wu and Huba, Phys. Fluids
//         20, 301 (1977); Yoon, Lui and Sitnov, Phys. Plasmas 9, 1526 (2002), for the Harris sheet.
#pragma once

#include <gsl/gsl_sf_bessel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"
#include "common/theory/plasma_dispersion.hpp"

namespace implicit_moment {

/// B = B0 tanh z, n = n0 (sech^2 z + background), with both temperatures uniform, seen where E = 0.
/// note: drift = u_i / v_i = rho_i / L and u_e / u_i = -T_e / T_i, with v_i = (2 T_i / m_i)^1/2.
struct CurrentSheet {
    double mass_ratio = 180;       // m_i / m_e
    double temperature_ratio = 1;  // T_i / T_e
    double drift = 1;              // u_i / v_i of the sheet; the background rests
    double frequency_ratio = 5;    // omega_pe / Omega_ce at n0, B0
    double background = 0;         // n_b / n0
    bool grad_B = false;           // whether guiding centers of electrons drift in grad B
};

/// A part of the plasma, electrons and ions, with its own mean velocities.
struct Stream {
    double density = 0, u_i = 0, u_e = 0;
};

/// What the waves at one height know of the sheet.
struct LocalPlasma {
    double v_i = 0;                // (2 T_i / m_i)^1/2
    double rho_e = 0;              // (2 T_e / m_e)^1/2 / Omega_ce in the local field
    double v_B = 0;                // mean drift of guiding centers in grad B
    double omega_pi = 0;           // at n0
    double frequency_ratio = 0;    // omega_pe / Omega_ce at n0 and in the local field
    double temperature_ratio = 0;  // T_i / T_e
    std::array<Stream, 2> streams;
};

/// The plasma at height z > 0.
///   v_i = drift, u_i = drift^2, omega_pi = (omega_pe / Omega_ce) (m_i / m_e)^1/2,
///   v_B = -u_e (d ln B / dz) / |d ln n / dz| = -u_e / (2 sinh^2 z)
inline LocalPlasma plasma_at(const CurrentSheet& sheet, double z) {
    const double B = std::tanh(z), n = 1 - B * B;
    const double u_i = sheet.drift * sheet.drift, u_e = -u_i / sheet.temperature_ratio;
    LocalPlasma plasma;
    plasma.v_i = sheet.drift;
    plasma.rho_e = sheet.drift / std::sqrt(sheet.mass_ratio * sheet.temperature_ratio) / B;
    plasma.v_B = sheet.grad_B ? -0.5 * u_e / std::pow(std::sinh(z), 2) : 0.0;
    plasma.omega_pi = sheet.frequency_ratio * std::sqrt(sheet.mass_ratio);
    plasma.frequency_ratio = sheet.frequency_ratio / B;
    plasma.temperature_ratio = sheet.temperature_ratio;
    plasma.streams = {{{n, u_i, u_e}, {sheet.background, 0, 0}}};
    return plasma;
}

/// The local lower-hybrid frequency, omega_pi / (1 + omega_pe^2 / Omega_ce^2)^1/2.
inline double lower_hybrid_frequency(const LocalPlasma& plasma) {
    double density = 0;
    for (const Stream& s : plasma.streams) density += s.density;
    return plasma.omega_pi *
           std::sqrt(density / (1 + density * plasma.frequency_ratio * plasma.frequency_ratio));
}

/// The electrons of a wave of wave number k, sorted by the frequency k v of their guiding centers:
/// Gamma_0 / omega becomes the sum of weight / (omega - frequency).
struct GuidingCenters {
    std::vector<common::Complex> frequency, weight;
};

namespace detail {

// J_0(x), the mean of cos(x sin theta).
inline common::Complex bessel_J0(common::Complex x) {
    const int points = 16 + int(std::abs(x));
    common::Complex sum = 0;
    for (int n = 0; n < points; ++n)
        sum += std::cos(x * std::sin((n + 0.5) * std::numbers::pi / points));
    return sum / double(points);
}

}  // namespace detail

/// All guiding centers at rest, or the integral of the header by the double exponential rule
///   s = exp(t - exp(-t)) exp(-i pi / 8),  dt = 0.1
/// along a ray below the real axis, which no resonance s = omega / (k v_B) meets while
/// arg omega > -pi / 8.
/// exact:  relative error below 1e-8 in growing waves of k rho_e < 5
/// source: Takahasi and Mori, Publ. RIMS 9, 721 (1974).
inline GuidingCenters guiding_centers(const LocalPlasma& plasma, double k) {
    const double k_rho = k * plasma.rho_e;
    if (plasma.v_B == 0) return {{0.0}, {gsl_sf_bessel_I0_scaled(0.5 * k_rho * k_rho)}};
    constexpr double dt = 0.1, first = -3.5, last = 4.0;
    const common::Complex ray = std::polar(1.0, -std::numbers::pi / 8);
    GuidingCenters centers;
    for (long n = std::lround(first / dt); n <= std::lround(last / dt); ++n) {
        const double t = double(n) * dt;
        const common::Complex s = std::exp(t - std::exp(-t)) * ray;
        const common::Complex J = detail::bessel_J0(k_rho * std::sqrt(s));
        centers.frequency.push_back(k * plasma.v_B * s);
        centers.weight.push_back(dt * (1 + std::exp(-t)) * s * std::exp(-s) * J * J);
    }
    return centers;
}

/// D of the header as a function of omega, for a wave number k > 0.
/// exact: analytic in the upper half-plane; with guiding centers at rest everywhere but for a pole
///        at omega = 0. Without background and grad B it has one zero in the upper half-plane.
inline auto drift_dispersion(const LocalPlasma& plasma, double k) {
    return [plasma, k, centers = guiding_centers(plasma, k)](common::Complex omega) {
        common::Complex Gamma_0_over_omega = 0;
        for (std::size_t n = 0; n < centers.weight.size(); ++n)
            Gamma_0_over_omega += centers.weight[n] / (omega - centers.frequency[n]);
        const double k_l_i = k * plasma.v_i / (std::numbers::sqrt2 * plasma.omega_pi);
        common::Complex D = 1;
        for (const Stream& s : plasma.streams) {
            const auto ions = common::plasma_response((omega - k * s.u_i) / (k * plasma.v_i));
            const auto electrons = 1.0 - (omega - k * s.u_e) * Gamma_0_over_omega;
            D += s.density * (ions + plasma.temperature_ratio * electrons) / (k_l_i * k_l_i);
        }
        return D;
    };
}

/// A wave of the sheet.
struct LocalWave {
    double z = 0, k = 0;
    double omega = 0;          // real part
    double gamma = -HUGE_VAL;  // growth rate
    bool found = false;
};

/// The fastest growing (or least damped) wave of wave number k in a local plasma.
/// note:  starts from fans at k u_i, k v_i and the lower-hybrid frequency
inline common::DispersionRoot local_root(const LocalPlasma& plasma, double k) {
    std::vector<common::Complex> guesses;
    for (const double scale :
         {k * plasma.streams[0].u_i, k * plasma.v_i, lower_hybrid_frequency(plasma)})
        for (const double radius : {0.3, 0.9})
            for (const double degrees : {3.0, 30.0, 70.0})
                guesses.push_back(std::polar(scale * radius, degrees * std::numbers::pi / 180));
    return common::fastest_growing_root(drift_dispersion(plasma, k), guesses);
}

/// The fastest growing (or least damped) local wave of wave number k at height z > 0.
inline LocalWave local_root(const CurrentSheet& sheet, double z, double k) {
    const common::DispersionRoot root = local_root(plasma_at(sheet, z), k);
    return {z, k, root.omega.real(), root.omega.imag(), root.found};
}

/// The wave of largest growth rate among wave(s), low <= s <= high: the best of a scan, then golden
/// sections between its neighbors.
template <class Waves>
LocalWave fastest_wave(const Waves& wave, double low, double high) {
    constexpr int intervals = 24, sections = 12;
    const double step = (high - low) / intervals;
    LocalWave best;
    double middle = low;
    for (int n = 0; n <= intervals; ++n) {
        const LocalWave w = wave(low + n * step);
        if (w.gamma > best.gamma) best = w, middle = low + n * step;
    }
    double a = std::max(middle - step, low), b = std::min(middle + step, high);
    for (int n = 0; n < sections; ++n) {
        const double inner = (b - a) / std::numbers::phi;
        const LocalWave left = wave(b - inner), right = wave(a + inner);
        if (left.gamma > right.gamma)
            b = a + inner;
        else
            a = b - inner;
        for (const LocalWave& w : {left, right})
            if (w.gamma > best.gamma) best = w;
    }
    return best;
}

/// Bounds of the search for the height [L].
inline constexpr double lowest_z = 0.2, highest_z = 4.0;

/// The fastest growing local wave of wave number k, wherever it is.
/// out:    none where it is half as fast as electrons gyrate or faster; theory takes them for much faster
inline LocalWave fastest_over_z(const CurrentSheet& sheet, double k) {
    const LocalWave wave =
        fastest_wave([&](double z) { return local_root(sheet, z, k); }, lowest_z, highest_z);
    const double Omega_ce = sheet.mass_ratio * std::tanh(wave.z);  // over Omega_ci
    return std::hypot(wave.omega, wave.gamma) < 0.5 * Omega_ce ? wave : LocalWave{};
}

}  // namespace implicit_moment
