// Waves that only the electromagnetic programs have: E across k in a kinetic plasma.
#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "common/theory/kinetic_dispersion.hpp"

namespace implicit_moment {

/// What a species adds to D below, where its particles feel a part S of E and the whole B:
///     omega_s^2 { (omega - k u_s) / (2^1/2 k v_s) Z(zeta_s) + (T_across / T_along - 1) [1 + zeta_s Z(zeta_s)]
///                 - (1 - S) omega / (2^1/2 k v_s) Z(zeta_s) },
///     zeta_s = w / (2^1/2 k v_s),   w = omega - k u_s + sense Omega_s
/// and where it is cold along k
///     -omega_s^2 { (omega - k u_s) / w + k^2 T_across / (m w^2) - (1 - S) omega / w }
/// note:   the programs smooth E for the particles, and not B.
inline common::Complex transverse_response(const common::PlasmaSpecies& s, double k, int sense,
                                           common::Complex omega, double part_of_E = 1) {
    const common::Complex doppler = omega - k * s.drift,
                          shifted = doppler + sense * s.gyrofrequency,
                          felt = doppler - (1 - part_of_E) * omega;
    const double kv = std::abs(k) * s.speed_along();
    common::Complex response;
    if (kv == 0.0) {
        const double kv_across_squared = k * k * s.temperature_across / s.mass;
        if (shifted * shifted == 0.0) return common::no_value;
        response = felt == shifted ? common::Complex(-1.0) : -felt / shifted;
        if (kv_across_squared > 0.0) response -= kv_across_squared / (shifted * shifted);
    } else {
        const double root2_kv = std::numbers::sqrt2 * kv;
        const auto f = common::plasma_dispersion_detail::values(shifted / root2_kv);
        const double anisotropy = s.temperature_across / s.temperature_along - 1.0;
        response = felt / root2_kv * f.Z + anisotropy * f.one_plus_zeta_Z;
    }
    return s.frequency_squared() * response;
}

/// Waves with E across k, circularly polarized, with B_0 along k or zero.
///     D = omega^2 - c^2 k^2 + sum_s transverse_response
/// in:    light, the speed c; sense +1: electrons resonate at omega = |Omega_e|, the whistler; -1: ions at Omega_i.
///        Without B_0 both are the same, and any polarization has this relation.
/// source: Stix, Waves in Plasmas (1992), chapter 10; Weibel, Phys. Rev. Lett. 2, 83 (1959).
inline common::Complex transverse_dispersion(std::span<const common::PlasmaSpecies> plasma,
                                             double k, double light, int sense,
                                             common::Complex omega) {
    common::Complex D = omega * omega - light * light * k * k;
    for (const auto& s : plasma) D += transverse_response(s, k, sense, omega);
    return D;
}

/// The part of a species whose particles have one velocity across k, where masses are gamma m.
struct Stream {
    double frequency_squared = 0;  // 4 pi n q^2 / (gamma m)
    double along = 0, across = 0;  // mean velocities v_k along k and v_E along E
    double spread = 0;             // thermal speed along k
};

/// What a stream adds to D below, without B_0, from d v = (d u - v (v . d u)/c^2)/gamma and its continuity
/// equation; S is the part of E that particles feel, and < > the mean over velocities v along k.
///     -omega_s^2 { (1 - v_E^2/c^2) <f> + k^2 v_E^2 (1 - v_k^2/c^2) <1/w^2> - k v_k v_E^2/c^2 <(1 + f)/w> },
///     w = omega - k v,   f = 1 - (1 - S) omega/w
/// exact: for spread << c. Where streams answer E along k, too, others have to cancel that.
inline common::Complex stream_response(const Stream& s, double k, double light,
                                       common::Complex omega, double part_of_E = 1) {
    const common::Complex doppler = omega - k * s.along;
    const double kv = std::abs(k) * s.spread;
    common::Complex by_w = 1.0 / doppler, by_w_squared = by_w * by_w;
    if (kv > 0) {
        const auto f =
            common::plasma_dispersion_detail::values(doppler / (std::numbers::sqrt2 * kv));
        by_w = -f.Z / (std::numbers::sqrt2 * kv);
        by_w_squared = -f.one_plus_zeta_Z / (kv * kv);
    }
    const double v_k = s.along / light, v_E = s.across / light;
    const common::Complex lost = (1 - part_of_E) * omega;
    return -s.frequency_squared * ((1 - v_E * v_E) * (1.0 - lost * by_w) +
                                   std::pow(k * s.across, 2) * (1 - v_k * v_k) * by_w_squared -
                                   k * s.along * v_E * v_E * (2.0 * by_w - lost * by_w_squared));
}

}  // namespace implicit_moment
