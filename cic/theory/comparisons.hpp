// All comparisons with theory that a case can ask for.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "cic/theory/cloud_force.hpp"
#include "cic/theory/diocotron.hpp"
#include "cic/theory/sheath.hpp"
#include "cic/theory/thermal_noise.hpp"
#include "cic/theory/wave.hpp"

namespace cic {

/// No comparison, and all others.
inline constexpr std::array<Comparison, 6> comparisons{
    Comparison{.name = "none", .least_steps = 0, .either_sign = true, .formulas = true},
    wave_comparison,
    diocotron_comparison,
    sheath_comparison,
    clouds_comparison,
    heating_comparison};

/// The names that theory.compare takes.
inline std::vector<std::string> names_of_comparisons() {
    std::vector<std::string> names;
    for (const Comparison& comparison : comparisons) names.push_back(comparison.name);
    return names;
}

/// The one that a case asks for.
inline const Comparison& comparison_of(const Case& parameters) {
    for (const Comparison& comparison : comparisons)
        if (parameters.compare == comparison.name) return comparison;
    return comparisons[0];
}

/// Refuses a case that its comparison cannot be made with. errors: InputError
inline void validate_comparison(const Case& parameters) {
    const Comparison& comparison = comparison_of(parameters);
    refuse(parameters.end < double(comparison.least_steps) * parameters.dt, asked_for(parameters),
           " needs at least ", comparison.least_steps, " steps: raise time.end above ",
           double(comparison.least_steps) * parameters.dt);
    refuse(!comparison.either_sign && parameters.gauss_sign < 0, asked_for(parameters),
           " is for gauss.sign = 1");
    const auto by_formula = [](const SpeciesCase& s) {
        return !s.density.is_number() || s.has_distribution();
    };
    refuse(!comparison.formulas && std::ranges::any_of(parameters.species, by_formula),
           asked_for(parameters), " is for species without formulas: write numbers");
    comparison.validate(parameters);
}

}  // namespace cic
