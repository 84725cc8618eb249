// What is known exactly, or published, about the problems that the material point method is tried
// on: a disk between two loads, disks that collide, bars and waves, bodies on an incline, and a
// block that is pressed.
//
// Stress is positive in tension. Everything is plane strain and per unit thickness; units are those
// of the caller: [length], [mass / length^3], [E].
#pragma once

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "mpm_explicit/grains/materials.hpp"
#include "mpm_explicit/particles.hpp"

namespace mpm {

// ---- a disk that two opposite loads press together ----------------------------------------------

/// The stress in a disk with line loads P at (0, R) and (0, -R), toward its center.
///   sum over both loads of  -(2P/pi) cos(a) / r e_r e_r,  and an all-round tension P / (pi R);
///   r the distance from the load, a the angle from the diameter through both
/// in:    P [E length], R, and a place inside the disk; nu for the component out of the plane
/// exact: div sigma = 0, and no traction on the rim except under the loads. The plane components
///        do not depend on nu or E.
/// source: Hertz 1883; Timoshenko and Goodier, Theory of Elasticity, "Stresses in a circular disk".
inline Stress disk_stress(double P, double R, double x, double y, double nu = 0) {
    const double up = R - y, down = R + y;
    const double per_r1_4 = 1 / ((x * x + up * up) * (x * x + up * up)),
                 per_r2_4 = 1 / ((x * x + down * down) * (x * x + down * down));
    const double scale = 2 * P * std::numbers::inv_pi;
    Stress s;
    s.xx = scale * (0.5 / R - up * x * x * per_r1_4 - down * x * x * per_r2_4);
    s.yy = scale * (0.5 / R - up * up * up * per_r1_4 - down * down * down * per_r2_4);
    s.xy = scale * (up * up * x * per_r1_4 - down * down * x * per_r2_4);
    s.zz = nu * (s.xx + s.yy);
    return s;
}

/// The difference of the principal stresses in the plane, which light sees.
///   s1 - s2 = [(s_xx - s_yy)^2 + 4 s_xy^2]^1/2
inline double principal_stress_difference(const Stress& s) {
    return std::hypot(s.xx - s.yy, 2 * s.xy);
}

/// s1 - s2 at the center of the disk of disk_stress: s_xx = 2P / (pi D), s_yy = -6P / (pi D).
inline double disk_center_difference(double P, double R) {
    return 4 * P * std::numbers::inv_pi / R;
}

// ---- two equal disks in contact -----------------------------------------------------------------

/// An elastic disk.
struct Disk {
    double R, density, E, nu;

    double mass() const { return density * std::numbers::pi * R * R; }
    /// Of the pair: 1 / E_pair = 2 (1 - nu^2) / E.
    double E_pair() const { return 0.5 * E / (1 - nu * nu); }
};

/// Half the width of the flat that a force P presses between two equal disks.
///   b^2 = 4 P (R/2) / (pi E_pair)
/// exact: for b much smaller than R
/// source: Hertz; Johnson, Contact Mechanics (1985), eq. 4.43.
inline double contact_half_width(const Disk& disk, double P) {
    return std::sqrt(2 * P * disk.R * std::numbers::inv_pi / disk.E_pair());
}

/// How much closer the centers of two equal disks are under a force P, positive in compression.
///   delta = 2P (1 - nu^2) / (pi E) (2 ln(4R/b) - 1) = P / (pi E_pair) (ln(8 pi R E_pair / P) - 1)
/// exact: for b much smaller than R: the strain on the diameter from the middle of the contact to
///        the center, twice, when a second force P holds each disk on its far side
/// source: Johnson, Contact Mechanics (1985), eq. 5.57.
inline double contact_approach(const Disk& disk, double P) {
    if (P <= 0) return 0;
    const double pi_E = std::numbers::pi * disk.E_pair();
    return P / pi_E * (std::log(8 * disk.R * pi_E / P) - 1);
}

/// The work that the approach takes.
///   U = integral P d delta = P^2 / (2 pi E_pair) (ln(8 pi R E_pair / P) - 3/2)
inline double contact_energy(const Disk& disk, double P) {
    if (P <= 0) return 0;
    const double pi_E = std::numbers::pi * disk.E_pair();
    return 0.5 * P * P / pi_E * (std::log(8 * disk.R * pi_E / P) - 1.5);
}

/// What two disks do when they meet.
struct Impact {
    double duration, peak_force, peak_half_width, peak_approach;
};

/// Two equal disks that meet head on with velocities +-speed, as if the contact were always in
/// equilibrium.
///   (m/2) delta'' = -P(delta),  so that  U(P) + (m/4) delta'^2 = (m/4) (2 speed)^2
///   duration = 2 integral_0^P_max (d delta / dP) / delta' dP
/// in:    speed > 0, so slow that b stays much smaller than R
/// out:   duration [time], peak force [E length], peak b and delta [length]
/// note:  An estimate: waves in the disks are left out, and a real disk is held by its own inertia
///        rather than by a force on its far side.
inline Impact quasi_static_impact(const Disk& disk, double speed) {
    const double pi_E = std::numbers::pi * disk.E_pair(), all = disk.mass() * speed * speed;

    // The force that takes all of the energy; U grows with P up to the largest force considered.
    double low = 0, high = 8 * disk.R * pi_E * std::exp(-2.0);
    for (int n = 0; n < 200; ++n) {
        const double middle = 0.5 * (low + high);
        (contact_energy(disk, middle) < all ? low : high) = middle;
    }
    const double P_max = low;

    // With P = P_max sin^2 u the integrand has no poles.
    constexpr int samples = 4000;
    const double du = 0.5 * std::numbers::pi / samples;
    double time = 0;
    for (int n = 0; n < samples; ++n) {
        const double u = (n + 0.5) * du, P = P_max * std::sin(u) * std::sin(u);
        const double slope = (std::log(8 * disk.R * pi_E / P) - 2) / pi_E;
        const double velocity = 2 * speed * std::sqrt(1 - contact_energy(disk, P) / all);
        time += slope / velocity * 2 * P_max * std::sin(u) * std::cos(u) * du;
    }
    return {2 * time, P_max, contact_half_width(disk, P_max), contact_approach(disk, P_max)};
}

// ---- bars and waves -----------------------------------------------------------------------------

/// What swings about rest: how it goes in time, and how fast.
///   q'' + 2 gamma q' + omega^2 q = 0,  q(0) = 0, q'(0) = omega
///   q = omega/(2s) [exp(-slow t) - exp(-fast t)],  s^2 = gamma^2 - omega^2,  fast = gamma + s,
///   slow = gamma - s = omega^2/fast
struct Swing {
    double omega, gamma = 0;

    std::complex<double> s() const {
        return std::sqrt(std::complex<double>(gamma * gamma - omega * omega));
    }
    std::complex<double> slow() const { return omega * omega / (gamma + s()); }
    double at(double t) const {
        if (gamma == omega) return omega * t * std::exp(-gamma * t);
        return std::real(omega / (2. * s()) *
                         (std::exp(-slow() * t) - std::exp(-(gamma + s()) * t)));
    }
    double rate(double t) const {
        const std::complex<double> fast = gamma + s();
        if (gamma == omega) return omega * (1 - gamma * t) * std::exp(-gamma * t);
        return std::real(omega / (2. * s()) *
                         (fast * std::exp(-fast * t) - slow() * std::exp(-slow() * t)));
    }
    /// When it first turns, q' = 0; if it swings, it turns again a time pi/|s| later.
    ///   tanh(s t) = s/gamma
    double first_turn() const {
        if (gamma == omega) return 1 / gamma;
        return gamma < omega ? std::atan2(std::abs(s()), gamma) / std::abs(s())
                             : 0.5 * std::log(std::real((gamma + s()) / slow())) / std::real(s());
    }
};

/// A bar held at x = 0 and free at x = length, which starts with v = speed sin(k x).
struct Bar {
    double length, density;
    double modulus;  // stress per strain: E; E / (1 - nu^2) or lambda + 2G in plane strain
    int mode = 1;
    double speed = 0;    // of the free end
    double damping = 0;  // c: every velocity falls by exp(-c t)

    double wave_speed() const { return std::sqrt(modulus / density); }
    double wave_number() const { return (mode - 0.5) * std::numbers::pi / length; }
    double frequency() const { return wave_number() * wave_speed(); }  // angular, without damping
    Swing swing() const { return {frequency(), 0.5 * damping}; }
};

///   v = speed sin(k x) q'(t)/omega
inline double bar_velocity(const Bar& bar, double x, double t) {
    return bar.speed * std::sin(bar.wave_number() * x) * bar.swing().rate(t) / bar.frequency();
}

///   sigma = (modulus density)^1/2 speed cos(k x) q(t)
/// exact: density (dv/dt + c v) = d sigma/dx, d sigma/dt = modulus dv/dx, sigma = 0 at x = length
inline double bar_stress(const Bar& bar, double x, double t) {
    return std::sqrt(bar.modulus * bar.density) * bar.speed * std::cos(bar.wave_number() * x) *
           bar.swing().at(t);
}

/// When the tension at a joint at x first reaches the strength N > 0 that breaks it: on the way to
/// the first turn, or to the second.
/// out:   time; infinite where it never does
inline double bar_breaking_time(const Bar& bar, double x, double N) {
    const Swing swing = bar.swing();
    const auto left = [&](double t) { return N - bar_stress(bar, x, t); };
    double low = 0, high = swing.first_turn();
    if (left(high) > 0 && swing.gamma < swing.omega)
        low = high, high += std::numbers::pi / std::abs(swing.s());
    if (left(high) > 0) return std::numeric_limits<double>::infinity();
    for (int n = 0; n < 100; ++n) (left(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    return high;
}

/// A standing compression wave between rollers at x = 0 and x = length (and along y).
///   u_x = amplitude sin(k x) q(t),  k = mode pi / length
/// exact: for linear elasticity; finite strain changes it by about amplitude k
struct StandingWave {
    double length, amplitude, density;
    Moduli moduli;
    int mode = 1;
    double viscosity = 0;  // beta
    double damping = 0;    // c

    double wave_number() const { return mode * std::numbers::pi / length; }
    double frequency() const {
        return wave_number() * std::sqrt((moduli.lambda + 2 * moduli.G) / density);
    }
    ///   gamma = (c + beta omega^2)/2,  omega^2 = k^2 (lambda + 2G) / density
    Swing swing() const {
        return {frequency(), 0.5 * (damping + viscosity * frequency() * frequency())};
    }
};

///   u_x = amplitude sin(k x) q(t)
inline double wave_displacement(const StandingWave& w, double x, double t) {
    return w.amplitude * std::sin(w.wave_number() * x) * w.swing().at(t);
}

///   v_x = amplitude sin(k x) q'(t)
inline double wave_velocity(const StandingWave& w, double x, double t) {
    return w.amplitude * std::sin(w.wave_number() * x) * w.swing().rate(t);
}

/// The elastic stress.
///   e_xx = amplitude k cos(k x) q(t)
///   s_xx = (lambda + 2G) e_xx,  s_yy = s_zz = lambda e_xx
inline Stress wave_stress(const StandingWave& w, double x, double t) {
    const double k = w.wave_number();
    const double e = w.amplitude * k * std::cos(k * x) * w.swing().at(t);
    const double side = w.moduli.lambda * e;
    return {side + 2 * w.moduli.G * e, side, 0, side};
}

// ---- down an incline ----------------------------------------------------------------------------

/// The acceleration of a block that starts at rest, g (sin - mu cos), or 0 where it sticks.
/// in:    angle from the horizontal [rad], 0 to pi/2
inline double block_acceleration(double g, double angle, double mu) {
    const double slide = std::sin(angle) - mu * std::cos(angle);
    return slide > 0 ? g * slide : 0;
}

/// The acceleration of a solid cylinder's center: (2/3) g sin where it rolls, tan <= 3 mu, and
/// g (sin - mu cos) where it slips.
inline double cylinder_acceleration(double g, double angle, double mu) {
    const bool rolls = std::sin(angle) <= 3 * mu * std::cos(angle);
    return rolls ? g * std::sin(angle) / 1.5 : block_acceleration(g, angle, mu);
}

// ---- a block between smooth plates --------------------------------------------------------------

/// Stress over strain of a block that is pressed along y, free along x, held along z.
///   s_yy = E/(1 - nu^2) e_yy,  s_xx = 0,  s_zz = nu s_yy
inline double plane_strain_modulus(double E, double nu) { return E / (1 - nu * nu); }

/// Its force over its width at the start, when it is shorter by a share `strain`.
///   d s_yy = M de,  de = -dl/l, so that  s_yy = M L,  L = -ln(1 - strain): the strain of the law is
///   logarithmic, and  force = V s_yy / l  with the volume V in which the law keeps its stress,
///   V = V_0 exp((n - 1) L) where volumes change with  e_xx = n L across, and V_0 where they are kept
/// in:    M, stress over strain; across, n = nu/(1 - nu) for a free block, 0 for a confined one
inline double pressed_stress(double M, double across, bool volumes_change, double strain) {
    const double L = -std::log(1 - strain);
    return M * L * std::exp(volumes_change ? across * L : L);
}

/// The most that such a block bears when it yields at the von Mises stress Y and does not harden.
///   s_yy = 2 Y / 3^1/2, with s_zz = s_yy / 2: flow along z has come to rest
inline double plane_strain_strength(double Y) { return 2 * Y / std::numbers::sqrt3; }

/// Work per volume that steps take in a cycle of strain range sin^2(pi t/T) with a modulus M, where
/// each works against the stress at a level f of the strain that it adds.
///   (f - 1/2) M sum (de)^2 = (f - 1/2) (pi^2/2) M range^2 dt/T
inline double cycle_loss(double M, double range, double f, double dt_over_T) {
    return (f - 0.5) * 0.5 * std::numbers::pi * std::numbers::pi * M * range * range * dt_over_T;
}

/// Work per volume that a block takes in a cycle of strain of this range, held along x and z, when
/// it yields at the von Mises stress Y and does not harden. The difference of stresses follows 2 G e
/// between -Y and Y, and two thirds of it do work.
///   (4/3) Y (range - Y/G)
inline double uniaxial_loop_area(double Y, double G, double range) {
    return 4.0 / 3 * Y * std::max(0.0, range - Y / G);
}

}  // namespace mpm
