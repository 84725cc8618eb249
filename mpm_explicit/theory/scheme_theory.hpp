// What is known exactly about the leapfrog and the theta scheme, alone and on a mesh with particles
// at rest, and what has been published about columns of grains that collapse.
#pragma once

#include <cmath>
#include <complex>
#include <limits>

namespace mpm {

// ---- leapfrog: x'' = -w^2 x ---------------------------------------------------------------------
//   v^(n+1) = v^n - w^2 dt x^(n+1/2),  x^(n+1/2) = x^(n-1/2) + dt v^n               [MPM-9 ... 12]

/// The angular frequency w' that the scheme gives an oscillator of frequency w.
///   sin(w' dt / 2) = w dt / 2
/// out:   not a number beyond w dt = 2
inline double leapfrog_frequency(double w, double dt) {
    return w * dt <= 2 ? 2 / dt * std::asin(0.5 * w * dt)
                       : std::numeric_limits<double>::quiet_NaN();
}

/// The rate at which the oscillator grows, sign changing from step to step, beyond w dt = 2.
///   cosh(rate dt / 2) = w dt / 2
/// out:   0 up to w dt = 2
inline double leapfrog_growth(double w, double dt) {
    return w * dt > 2 ? 2 / dt * std::acosh(0.5 * w * dt) : 0;
}

/// One state of the oscillator of mass m = 1: positions half a step before and after the velocity.
struct LeapfrogState {
    double x_before, v, x_after;
};

/// One step of the oscillator.
inline LeapfrogState leapfrog_step(const LeapfrogState& s, double w, double dt) {
    const double v = s.v - w * w * dt * s.x_after;
    return {s.x_after, v, s.x_after + dt * v};
}

/// The energy with strain energy between two times.                                     [MPM-14]
///   1/2 [v^2 + w^2 x_before x_after] = 1/2 [(1 - w^2 dt^2 / 4) v^2 + w^2 (mean x)^2]
/// exact: constant for every dt; positive for all states if and only if w dt < 2
inline double leapfrog_energy_14(const LeapfrogState& s, double w) {
    return 0.5 * (s.v * s.v + w * w * s.x_before * s.x_after);
}

/// The energy with kinetic energy between two times, at the position s.x_after.         [MPM-15]
///   1/2 [v v_new + w^2 x^2] = 1/2 [(mean v)^2 + w^2 (1 - w^2 dt^2 / 4) x^2]
/// exact: constant for every dt; positive for all states if and only if w dt < 2
inline double leapfrog_energy_15(const LeapfrogState& s, double w, double dt) {
    return 0.5 * (s.v * leapfrog_step(s, w, dt).v + w * w * s.x_after * s.x_after);
}

/// The largest energy 1/2 [v^2 + w^2 (mean x)^2] that an oscillator with E14 = E can show.
///   E / (1 - w^2 dt^2 / 4)
/// out:   infinite from w dt = 2 on, where nothing is bounded
inline double leapfrog_energy_bound(double E, double w, double dt) {
    const double left = 1 - 0.25 * w * w * dt * dt;
    return left > 0 ? E / left : std::numeric_limits<double>::infinity();
}

// ---- the smallest oscillator of the material point method ---------------------------------------

/// Two cells between two fixed ends have one free line of nodes. With per_side x per_side particles
/// per cell, evenly spaced, that stay where they are, lumped mass m, linear S and motion along x:
///   f = -k u,  k = sum_p V_p (lambda + 2G) G_1p^2 = 2 (lambda + 2G) / h    per height
///   v^1 = v^0 + dt f / m,  m = sum_p m_p S_1p = rho h
///   next v^0 = sum_p m_p S_1p (v_p^0 + S_1p (v^1 - v^0)) / m = v^0 + (M_11 / m) dt f / m
///   M_11 = sum_p m_p S_1p^2 = rho h (2/3 - 1 / (6 per_side^2))
/// a leapfrog whose oscillator has w^2 = (k / m) (M_11 / m): the particles filter the velocity.
/// out:   w h / c,  c^2 = (lambda + 2G) / rho
///   (w h / c)^2 = 4/3 - 1 / (3 per_side^2)
/// exact: stable up to c dt / h = 2 / (w h / c): 2 with one particle per cell, 3^1/2 with many
inline double node_oscillator_frequency(int per_side) {
    return std::sqrt((4 - 1.0 / (per_side * per_side)) / 3);
}

/// What the particles leave of a change of the node's velocity when it comes back from them.
/// out:   M_11 / m = 2/3 - 1 / (6 per_side^2)
inline double node_filter(int per_side) { return 2.0 / 3 - 1.0 / (6.0 * per_side * per_side); }

/// The factor by which two numbers by two are multiplied in a step: of the two of a turn the one with
/// positive frequency; where nothing turns, the real one that lasts.
///   (a - g) (d - g) = b c
inline std::complex<double> step_factor(double a, double bc, double d) {
    const double half = 0.5 * (a + d), apart = -bc - 0.25 * (a - d) * (a - d);
    if (apart < 0) return half + std::copysign(std::sqrt(-apart), half);
    return {half, std::sqrt(apart)};
}

/// The factor of a step of that leapfrog, in which damping leaves the part `keeps` of velocities.
///   v^1 = keeps v^0 + dt f/m, and the node has back the part M_11/m of the change:
///   next v^0 = d v^0 - w^2 dt x,  d = 1 - (M_11/m) (1 - keeps),  x += dt (next v^0)
/// in:    z = w dt; keeps, exp(-c dt) for load.damping = c; filter, M_11/m (1: of a long wave)
/// exact: without damping  cos(arg g) = 1 - z^2/2, leapfrog_frequency
inline std::complex<double> leapfrog_factor(double z, double keeps, double filter) {
    const double d = 1 - filter * (1 - keeps);
    return step_factor(d, -d * z * z, 1 - z * z);
}

/// The same oscillator by the theta scheme: the factor g by which it is multiplied in one step.
///   v^theta = v^0 - theta z x^theta,  x^theta = x^0 + theta z v^theta,  z = w dt
///   x^1 = x^0 + z v^theta
///   next v^0 = keeps [v^0 + f (v^1 - v^0)],  v^1 - v^0 = -z x^theta
/// with x times w for length: v and x are multiplied by a matrix of
///   keeps (1 - f theta z^2/D)   -keeps f z/D
///              z/D             1 - theta z^2/D,   D = 1 + theta^2 z^2
/// in:    theta; z = w dt; f: 1 for the consistent mass, then w^2 = k / M_11, and node_filter() for
///        the lumped mass, then w^2 = k / m; keeps, what damping leaves, exp(-c dt)
/// out:   g with positive frequency; without damping nothing oscillates from theta z =
///        2 f^1/2 / (1 - f) on, and g is that of two real factors with the larger size
/// exact: f = keeps = 1 makes it [1 + i (1 - theta) z] / (1 - i theta z), of size 1 for theta = 1/2
inline std::complex<double> theta_node_oscillation(double theta, double z, double f,
                                                   double keeps = 1) {
    const double D = 1 + theta * theta * z * z, z2 = z * z / D;
    return step_factor(keeps * (1 - f * theta * z2), -keeps * f * z2 / D, 1 - theta * z2);
}

// ---- the run-out of a collapsing column ---------------------------------------------------------
//
// A column of height H = a L on a plane, L from its toe to the wall or plane of symmetry behind it,
// comes to rest with its toe at L_end. Returned is (L_end - L) / L.
// note:  Which numbers were seen where. Seen as quotations in later work, not in the papers: those
//        of Lube (two quotations agree on coefficients and powers; the crossover is quoted as 2.3
//        and as 1.8 ... 2.8), 2.5 a of Staron and Hinch, and 1.8 a and 2.3 a^2/3 about a = 3 of
//        Lajeunesse, Monnier and Homsy, Phys. Fluids 17, 103302 (2005), for glass beads. Seen in
//        the abstracts: a^(0.9 +- 0.1) in wide and a^(0.65 +- 0.05) in narrow channels with factors
//        that depend on the material, Balmforth and Kerswell, J. Fluid Mech. 538, 399 (2005), and
//        a^0.65 of a shallow-water model, Larrieu, Staron and Hinch, ibid. 554, 259 (2006). From
//        memory: the crossover a = 2 and 3.25 a^0.7 of Staron and Hinch.
//        The pieces do not meet where they change over; experiments differ by a factor 1.5.

/// Sand, rice and sugar in a channel.
///   1.2 a for a < 2.3,  1.9 a^2/3 beyond
/// source: Lube, Huppert, Sparks and Freundt, Phys. Rev. E 72, 041301 (2005).
inline double runout_in_experiments(double a) { return a < 2.3 ? 1.2 * a : 1.9 * std::cbrt(a * a); }

/// Disks in two dimensions by contact dynamics, which run out about twice as far.
///   2.5 a for a < 2,  3.25 a^0.7 beyond
/// source: Staron and Hinch, J. Fluid Mech. 545, 1 (2005).
inline double runout_of_disks(double a) { return a < 2 ? 2.5 * a : 3.25 * std::pow(a, 0.7); }

}  // namespace mpm
