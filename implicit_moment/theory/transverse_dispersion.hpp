// Waves that only the electromagnetic programs have: E across k in a kinetic plasma.
#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "common/theory/kinetic_dispersion.hpp"

namespace implicit_moment {

/// Waves with E across k, circularly polarized, with B_0 along k or zero.
///   D = omega^2 - c^2 k^2 + sum_s omega_s^2 { (omega - k u_s) / (2^1/2 k v_s) Z(zeta_s)
///                                             + (T_across / T_along - 1) [1 + zeta_s Z(zeta_s)] },
///   zeta_s = (omega - k u_s + sense Omega_s) / (2^1/2 k v_s),
///   and for a species that is cold along k
///   - omega_s^2 { (omega - k u_s) / w + k^2 T_across / (m w^2) },
///   w = omega - k u_s + sense Omega_s
/// in:    light, the speed c; sense +1: electrons resonate at omega = |Omega_e|, the whistler; -1: ions at Omega_i.
///        Without B_0 both are the same, and any polarization has this relation.
/// source: Stix, Waves in Plasmas (1992), chapter 10; Weibel, Phys. Rev. Lett. 2, 83 (1959).
inline common::Complex transverse_dispersion(std::span<const common::PlasmaSpecies> plasma,
                                             double k, double light, int sense,
                                             common::Complex omega) {
    common::Complex D = omega * omega - light * light * k * k;
    for (const auto& s : plasma) {
        const common::Complex doppler = omega - k * s.drift;
        const common::Complex shifted = doppler + sense * s.gyrofrequency;
        const double kv = std::abs(k) * s.speed_along();
        common::Complex response;
        if (kv == 0.0) {
            const double kv_across_squared = k * k * s.temperature_across / s.mass;
            if (shifted * shifted == 0.0) return common::no_value;
            response = s.gyrofrequency == 0.0 ? common::Complex(-1.0) : -doppler / shifted;
            if (kv_across_squared > 0.0) response -= kv_across_squared / (shifted * shifted);
        } else {
            const double root2_kv = std::numbers::sqrt2 * kv;
            const auto f = common::plasma_dispersion_detail::values(shifted / root2_kv);
            const double anisotropy = s.temperature_across / s.temperature_along - 1.0;
            response = doppler / root2_kv * f.Z + anisotropy * f.one_plus_zeta_Z;
        }
        D += s.frequency_squared() * response;
    }
    return D;
}

/// The fastest growing (or least damped) transverse wave of wave number k.
inline common::DispersionRoot fastest_growing_transverse(
    std::span<const common::PlasmaSpecies> plasma, double k, double light, int sense) {
    const auto D = [&](common::Complex omega) {
        return transverse_dispersion(plasma, k, light, sense, omega);
    };
    return common::fastest_growing_root(D, common::fan_of_guesses(plasma, k, light));
}

}  // namespace implicit_moment
