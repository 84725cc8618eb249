// The cost slide: what an explicit run costs, in implicit ones.   [COST]
#pragma once

#include <cmath>

namespace implicit_moment {

/// The slide's scaling of time explicit / implicit in d dimensions: an explicit code follows
/// electrons, with cells of d_e in each dimension and steps of 1/omega_pe, each smaller than those
/// of the ions by (m_i/m_e)^(1/2); particles per cell stay.
///     cost ratio = (m_i/m_e)^((d + 1)/2)
/// source: [COST], where the exponent has slipped to the numerator.
inline double cost_ratio(double mass_ratio, int d) { return std::pow(mass_ratio, 0.5 * (d + 1)); }

}  // namespace implicit_moment
