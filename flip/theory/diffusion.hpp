// How transfers between particles and mesh smear what they carry.
#pragma once

#include <cmath>

namespace flip::theory {

/// The diffusivity of Harlow's method: a particle that enters a cell takes its mean.
///   D = u dx (1 - C) / 2,  C = u dt / dx
/// note:  many particles per cell. It is proportional to the speed over the mesh.
inline double harlow_diffusivity(double u, double dx, double dt) {
    const double speed = std::abs(u);
    return 0.5 * speed * dx * (1.0 - speed * dt / dx);
}

/// The diffusivity of Harlow's method when each cell has n particles on a lattice.
/// The part phi of them that enters in a step spreads by phi (1 - phi) dx^2; it is m / n or
/// (m + 1) / n, m = floor(n C), and C in the mean:
///   D = dx^2 / (2 dt) (C - <phi^2>),  <phi^2> = [(1 - f) m^2 + f (m + 1)^2] / n^2,  f = n C - m
/// in:    n > 0; C up to 1
/// exact: u dx (1 - 1 / n) / 2 for C < 1 / n, harlow_diffusivity where n C is a whole number
inline double harlow_lattice_diffusivity(double u, double dx, double dt, int n) {
    const double C = std::abs(u) * dt / dx, m = std::floor(n * C), f = n * C - m;
    const double square = ((1.0 - f) * m * m + f * (m + 1.0) * (m + 1.0)) / (double(n) * n);
    return 0.5 * dx * dx / dt * (C - square);
}

/// The part of its angular momentum that a rigid disk loses when its velocities go to the mesh and
/// back once by linear weights.
///   2 h^2 / (3 R^2)
/// note:  the mesh has all of it: the particles lose it on their way back. For h << R.
inline double round_trip_loss(double h, double R) { return 2.0 * h * h / (3.0 * R * R); }

}  // namespace flip::theory
