// Gaussian units, as on the slides, in the normalization c = d_i = omega_pi = 1 with ion mass and
// charge 1:
//     length  d_i = c/omega_pi        time  1/omega_pi        velocity  c        mass  m_i
//     charge  e
// omega_pi^2 = 4 pi n0 e^2 / m_i = 1 then makes the reference density n0 = 1/(4 pi). Energies are
// per unit of the ignorable length y.
#pragma once

#include <numbers>

// What particles carry, and what explicit_em pushes them in: double, or with `make REAL=float` float.
#ifndef REAL
#define REAL double
#endif

namespace implicit_moment {

using ParticleReal = REAL;

inline constexpr double pi = std::numbers::pi;
inline constexpr double c = 1;              // speed of light
inline constexpr double n0 = 1 / (4 * pi);  // reference density: omega_pi = 1

}  // namespace implicit_moment
