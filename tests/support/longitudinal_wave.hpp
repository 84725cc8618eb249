// The longitudinal wave of a plasma that grows fastest, from the guesses that the programs make.
#pragma once

#include <span>

#include "common/theory/kinetic_dispersion.hpp"

namespace facts {

/// The fastest growing (or least damped) longitudinal wave of wave number k.
inline common::DispersionRoot fastest_growing_longitudinal(
    std::span<const common::PlasmaSpecies> plasma, double k) {
    const auto D = [&](common::Complex omega) {
        return common::longitudinal_dispersion(plasma, k, omega);
    };
    return common::fastest_growing_root(D, common::fan_of_guesses(plasma, k));
}

}  // namespace facts
