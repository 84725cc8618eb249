// Rationalized units with eps0 = 1, so that Gauss's law reads div E = rho, as on the slide but for
// its sign:
//     omega_s^2 = n_s q_s^2 / m_s
// The unit of time is 1/omega_p of a species with density 1, charge 1 and mass 1; "omega_p" without
// an index always means this one. Lengths are in any unit, velocities in that unit times omega_p.
#pragma once

#include <numbers>

#ifndef REAL
#define REAL double
#endif

namespace cic {

inline constexpr double pi = std::numbers::pi;

/// What particles, weights and the packed field are made of, and sums within one batch or block of
/// particles. Sums over batches and blocks are in double precision.
using Real = REAL;

}  // namespace cic
