// All comparisons with theory, and the one that a case asks for.
#pragma once

#include <span>

#include "flip/theory/comparison.hpp"

namespace flip {

/// Every value of theory.compare, "none" among them.
std::span<const Comparison> comparisons();

/// The comparison that a case asks for.
const Comparison& comparison_of(const Case& parameters);

/// Refuses what the comparison of a case cannot be made with.
/// in:     a completed case that runs
/// errors: InputError, one sentence
void validate_comparison(const Case& parameters);

}  // namespace flip
