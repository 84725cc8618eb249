// The lower-hybrid drift instability of a Harris sheet in local linear theory.
//
// Waves exp(i k y - i omega t) along the current and across B, electrostatic, at one height z. Ions
// do not feel B in the short time that a wave needs to grow. Electrons are frozen to it: their
// guiding centers rest, and the gradient of the density makes them drift all the same.
//   D = 1 + sum over sheet and background of
//       { [1 + zeta Z(zeta)] + (T_i / T_e) [1 - Gamma_0(b) (omega - k u_e) / omega] } / (k l_i)^2,
//   zeta = (omega - k u_i) / (k v_i),  b = k^2 rho_e^2 / 2,  Gamma_0 = exp(-b) I_0(b),
//   with n, B, rho_e and the Debye length l_i of the ions at z
// Units: half-width L of the sheet, 1 / Omega_ci of the ions in B0, density n0 in the middle.
//
// note: Neglected are the drift of the electrons in grad B, the variation of the wave with z, its
//       magnetic field, and the electron gyrofrequency's harmonics. All but the first are small
//       where k L >> 1, k c / omega_pe >> 1 and omega << Omega_ce.
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

#include "common/kinetic_dispersion.hpp"
#include "common/plasma_dispersion.hpp"

namespace implicit_moment {

/// B = B0 tanh z, n = n0 (sech^2 z + background), with both temperatures uniform, seen where E = 0.
/// note: drift = u_i / v_i = rho_i / L and u_e / u_i = -T_e / T_i, with v_i = (2 T_i / m_i)^1/2.
struct CurrentSheet {
    double mass_ratio = 180;       // m_i / m_e
    double temperature_ratio = 1;  // T_i / T_e
    double drift = 1;              // u_i / v_i of the sheet; the background rests
    double frequency_ratio = 5;    // omega_pe / Omega_ce at n0, B0
    double background = 0;         // n_b / n0
};

/// A part of the plasma, electrons and ions, with its own mean velocities.
struct Stream {
    double density = 0, u_i = 0, u_e = 0;
};

/// What the waves at one height know of the sheet.
struct LocalPlasma {
    double v_i = 0;          // (2 T_i / m_i)^1/2
    double rho_e = 0;        // (2 T_e / m_e)^1/2 / Omega_ce in the local field
    double omega_pi = 0;     // at n0
    double Omega_ratio = 0;  // omega_pe / Omega_ce at n0 and in the local field
    double temperature_ratio = 0;
    std::array<Stream, 2> streams;
};

/// The plasma at height z > 0.
///   v_i = drift, u_i = drift^2, omega_pi = (omega_pe / Omega_ce) (m_i / m_e)^1/2
inline LocalPlasma plasma_at(const CurrentSheet& sheet, double z) {
    const double B = std::tanh(z), n = 1 - B * B, u_i = sheet.drift * sheet.drift;
    const double rho_e = sheet.drift / std::sqrt(sheet.mass_ratio * sheet.temperature_ratio) / B;
    return {sheet.drift,
            rho_e,
            sheet.frequency_ratio * std::sqrt(sheet.mass_ratio),
            sheet.frequency_ratio / B,
            sheet.temperature_ratio,
            {{{n, u_i, -u_i / sheet.temperature_ratio}, {sheet.background, 0, 0}}}};
}

/// The local lower-hybrid frequency, omega_pi / (1 + omega_pe^2 / Omega_ce^2)^1/2.
inline double lower_hybrid_frequency(const LocalPlasma& plasma) {
    double density = 0;
    for (const Stream& s : plasma.streams) density += s.density;
    return plasma.omega_pi *
           std::sqrt(density / (1 + density * plasma.Omega_ratio * plasma.Omega_ratio));
}

/// D(omega) of the header, for a wave number k > 0.
/// exact: analytic but for a pole at omega = 0; D of a sheet without background has one zero in the
///        upper half-plane, for every k
inline common::Complex drift_dispersion(const LocalPlasma& plasma, double k,
                                        common::Complex omega) {
    const double Gamma_0 = gsl_sf_bessel_I0_scaled(0.5 * std::pow(k * plasma.rho_e, 2));
    common::Complex D = 1;
    for (const Stream& s : plasma.streams) {
        const double k_l_i = k * plasma.v_i / (std::numbers::sqrt2 * plasma.omega_pi);
        const common::Complex ions =
            common::plasma_response((omega - k * s.u_i) / (k * plasma.v_i));
        const common::Complex electrons = 1.0 - Gamma_0 + Gamma_0 * k * s.u_e / omega;
        D += s.density * (ions + plasma.temperature_ratio * electrons) / (k_l_i * k_l_i);
    }
    return D;
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
        for (const double radius : {0.2, 0.5, 1.0})
            for (const double degrees : {2.0, 25.0, 50.0, 85.0})
                guesses.push_back(std::polar(scale * radius, degrees * std::numbers::pi / 180));
    const auto D = [&](common::Complex omega) { return drift_dispersion(plasma, k, omega); };
    return common::fastest_growing_root(D, guesses);
}

/// The fastest growing (or least damped) local wave of wave number k at height z > 0.
inline LocalWave local_root(const CurrentSheet& sheet, double z, double k) {
    const common::DispersionRoot root = local_root(plasma_at(sheet, z), k);
    return {z, k, root.omega.real(), root.omega.imag(), root.found};
}

namespace detail {

// The wave of largest growth rate among wave(s), low <= s <= high: the best of a scan, then golden
// sections between its neighbors.
template <class Wave>
LocalWave fastest(const Wave& wave, double low, double high) {
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

}  // namespace detail

/// Bounds of the searches: heights in L, and wave numbers in units of omega_lh / v_i at z.
inline constexpr double lowest_z = 0.2, highest_z = 4.0, lowest_k = 0.05, highest_k = 4.0;

/// The fastest growing local wave of wave number k, wherever it is.
inline LocalWave fastest_over_z(const CurrentSheet& sheet, double k) {
    return detail::fastest([&](double z) { return local_root(sheet, z, k); }, lowest_z, highest_z);
}

/// The fastest growing local wave at height z, of any wave number.
inline LocalWave fastest_over_k(const CurrentSheet& sheet, double z) {
    const LocalPlasma plasma = plasma_at(sheet, z);
    const double unit = lower_hybrid_frequency(plasma) / plasma.v_i;
    return detail::fastest([&](double k) { return local_root(sheet, z, k); }, lowest_k * unit,
                           highest_k * unit);
}

/// The fastest growing local wave of the sheet.
inline LocalWave fastest_local_wave(const CurrentSheet& sheet) {
    return detail::fastest([&](double z) { return fastest_over_k(sheet, z); }, lowest_z, highest_z);
}

}  // namespace implicit_moment
