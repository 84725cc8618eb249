// Longitudinal waves in a uniform magnetic field, k at any angle with it: Bernstein's modes where k
// is across B, and Harris's dispersion relation in between.
//
// A particle that gyrates meets the wave at every harmonic n of its gyrofrequency Omega:
//   chi = (omega_s / k)^2 sum_n [ gain_n Z(zeta_n) / (2^1/2 |k_along| v_along)
//                                 + weight_n (1 + zeta_n Z(zeta_n)) / v_along^2 ],
//   zeta_n = w_n / (2^1/2 |k_along| v_along),  w_n = omega - k_along u - n Omega
//   and where k_along v_along = 0
//   chi = -(omega_s / k)^2 sum_n [ gain_n / w_n + weight_n k_along^2 / w_n^2 ]
// with a drifting Maxwellian along B, and of the speeds v across B, J_n = J_n(k_across v / Omega),
//   weight_n = int J_n^2 f 2 pi v dv,  gain_n = -n Omega int J_n^2 f' 2 pi dv
// source: Bernstein, Phys. Rev. 109, 10 (1958); Harris, J. Nucl. Energy C 2, 138 (1961).
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "cic/setup/distribution.hpp"
#include "common/theory/kinetic_dispersion.hpp"

namespace cic {

/// What the harmonics n = 0, 1, ... of a species take and give; weight is even in n, gain odd.
struct Harmonics {
    std::vector<double> weight, gain;
};

/// Of a Maxwellian with the thermal speed v_across, b = (k_across v_across / Omega)^2.
///   weight_n = exp(-b) I_n(b),  gain_n = (k_across^2 / Omega) (weight_(n-1) - weight_(n+1)) / 2
/// exact:  gain_n = (k_across^2 / Omega) n weight_n / b,  sum_n n^2 weight_n = b
inline Harmonics maxwellian_harmonics(double k_across, double v_across, double Omega) {
    const double b = std::pow(k_across * v_across / Omega, 2);
    Harmonics h{common::harmonics_of_maxwellian(b), {0}};
    for (std::size_t n = 1; n + 1 < h.weight.size(); ++n)
        h.gain.push_back(0.5 * k_across * k_across / Omega * (h.weight[n - 1] - h.weight[n + 1]));
    h.weight.pop_back();
    return h;
}

/// J_0(x) to J_count(x), downward with J_(n-1) + J_(n+1) = (2 n / x) J_n; J_0 + 2 (J_2 + J_4 + ...)
/// is 1.
/// in:     count of at least 20 + 1.3 x
inline std::vector<double> bessel_functions(double x, std::size_t count) {
    std::vector<double> J(count + 1, 0.0);
    J[0] = 1, J[1] = 0.5 * x;
    if (x < 1e-8) return J;
    // Where they would overflow, higher ones are nothing.
    const auto top = std::min(count, std::size_t(20 + 1.3 * x));
    double above = 0, here = 1e-280, sum = 0;
    for (std::size_t n = top; n > 0; --n) {
        J[n] = here;
        if (n % 2 == 0) sum += 2 * here;
        const double below = 2 * double(n) / x * here - above;
        above = here, here = below;
    }
    J[0] = here;
    sum += here;
    for (std::size_t n = 0; n <= top; ++n) J[n] /= sum;
    return J;
}

/// Of a table of speeds across B, constant between its edges.
inline Harmonics tabulated_harmonics(double k_across, const Distribution& speeds, double Omega) {
    const std::size_t pieces = speeds.f.size();
    const double per_speed = std::fabs(k_across / Omega);
    const auto count = std::size_t(20 + 1.3 * per_speed * speeds.edge(pieces));
    Harmonics h{std::vector<double>(count + 1, 0.0), std::vector<double>(count + 1, 0.0)};
    const auto add = [&](double v, double factor, std::vector<double>& to) {
        if (factor == 0) return;
        const std::vector<double> J = bessel_functions(per_speed * v, count);
        for (std::size_t n = 0; n <= count; ++n) to[n] += factor * J[n] * J[n];
    };
    for (std::size_t j = 0; j < pieces; ++j) {
        add(speeds.middle(j), speeds.within(j), h.weight);
        add(speeds.edge(j + 1), -2 * std::numbers::pi * speeds.rise[j + 1], h.gain);
    }
    for (std::size_t n = 0; n <= count; ++n) h.gain[n] *= double(n) * Omega;
    return h;
}

/// A species in a magnetic field, for one wave vector.
struct MagnetizedSpecies {
    double omega2 = 0;  // omega_s^2
    double Omega = 0;   // q B / m, with its sign
    double k = 0, k_along = 0;
    double drift = 0, v_along = 0;  // along B
    Harmonics harmonics;
};

/// chi, and G = int f d^3v / (omega - k v) along the orbits: what a perturbation of the density of
/// free particles becomes.
struct Response {
    common::Complex chi, G;
};
inline Response magnetized_response(const MagnetizedSpecies& s, common::Complex omega) {
    const double width = std::numbers::sqrt2 * std::fabs(s.k_along) * s.v_along;
    Response sum;
    const auto add = [&](double n, double weight, double gain) {
        const common::Complex w = omega - s.k_along * s.drift - n * s.Omega;
        if (weight == 0 && gain == 0) return;
        if (width > 0) {
            const auto Z = common::plasma_dispersion_detail::values(w / width);
            sum.chi += gain * Z.Z / width + weight * Z.one_plus_zeta_Z / (s.v_along * s.v_along);
            sum.G -= weight * Z.Z / width;
        } else {
            sum.chi -= gain / w + weight * (s.k_along / w) * (s.k_along / w);
            sum.G += weight / w;
        }
    };
    for (std::size_t n = s.harmonics.weight.size() - 1; n > 0; --n) {
        add(double(n), s.harmonics.weight[n], s.harmonics.gain[n]);
        add(-double(n), s.harmonics.weight[n], -s.harmonics.gain[n]);
    }
    add(0, s.harmonics.weight[0], 0);
    sum.chi *= s.omega2 / (s.k * s.k);
    return sum;
}

/// Bernstein's modes, k across B: all roots of D = 1 + sum_s chi_s with omega > 0.
///   D rises from minus to plus infinity between neighbors of the poles n |Omega_s|, and to 1 above
///   the last one, so that there is one root each.
/// in:     species with gain_n n Omega >= 0, such as Maxwellians
/// note:   a pole of less than 1e-9 of the plasma frequencies squared is taken for none
inline std::vector<double> bernstein_roots(const std::vector<MagnetizedSpecies>& plasma) {
    double omega2 = 0;
    for (const auto& s : plasma) omega2 += s.omega2;
    std::vector<double> poles;
    for (const auto& s : plasma)
        for (std::size_t n = 1; n < s.harmonics.gain.size(); ++n)
            if (2 * s.omega2 * double(n) * s.Omega * s.harmonics.gain[n] >
                1e-9 * omega2 * s.k * s.k)
                poles.push_back(double(n) * std::fabs(s.Omega));
    std::ranges::sort(poles);
    std::vector<double> roots;
    for (std::size_t p = 0; p < poles.size(); ++p) {
        const bool last = p + 1 == poles.size();
        double low = poles[p], high = last ? std::sqrt(low * low + 2 * omega2) : poles[p + 1];
        if (high - low < 1e-9 * high) continue;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (low + high);
            double D = 1;
            for (const auto& s : plasma) D += magnetized_response(s, middle).chi.real();
            (D < 0 ? low : high) = middle;
        }
        roots.push_back(0.5 * (low + high));
    }
    return roots;
}

}  // namespace cic
