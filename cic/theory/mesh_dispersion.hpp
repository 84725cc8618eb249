// Longitudinal waves of a uniform plasma as the mesh and the time step see them: the dispersion
// relation of clouds-in-cells for one wave number along an axis of the mesh.
//
// A node cannot tell a wave k from its aliases k_p = k + 2 pi p / dx. Particles can, and answer to
// each of them; what they answer is deposited on the nodes as one wave again. So the mesh replaces
// the susceptibility chi(omega, k) of the plasma by a sum. With theta = k dx / 2, theta_p = theta +
// pi p, and the transform of the weights, S^(l)(k_p) = [sin(theta_p) / theta_p]^(l+1):
//
//   momentum conserving, E_k = -i kappa phi_k and S^(l) both ways:
//     D = 1 + (kappa / K^2) sum_p k_p S^(l)(k_p)^2 chi(omega, k_p)
//   energy conserving, E = -i K phi_k on edges, deposit with S^(l), gather with S^(l-1):
//     D = 1 + (1 / K^2) sum_p k_p^2 S^(l)(k_p)^2 chi(omega, k_p)
//   K = (2 / dx) sin(theta),  kappa = sin(k dx) / dx,  K^2 phi_k = rho_k
//
// The factors of chi are plain powers,
//     cos(theta) [sin(theta) / theta_p]^(2l+1)  and  [sin(theta) / theta_p]^(2l),
// so that the sum over p is one of 1 / theta_p^n, known in closed form where chi does not depend on
// p: in a cold plasma at rest.
// source: Langdon, J. Comput. Phys. 6, 247 (1970); Lewis, J. Comput. Phys. 6, 136 (1970).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"

namespace cic {

/// What turns the waves of a plasma into those of a program, along one axis.
struct MeshScheme {
    double dx = 1.0;
    double dt = 0.0;  // zero: the limit of short time steps
    int order = 1;    // of the weights S: 0 ngp, 1 cic, 2 tsc; 1 or 2 if energy conserving
    bool energy_conserving = false;
};

namespace detail {

using common::Complex, common::PlasmaSpecies;

/// The factor of chi(omega, k_p), also between the whole numbers p.
inline double alias_weight(const MeshScheme& scheme, double theta, double p) {
    const double ratio = std::sin(theta) / (theta + std::numbers::pi * p);
    return scheme.energy_conserving ? std::pow(ratio, 2 * scheme.order)
                                    : std::cos(theta) * std::pow(ratio, 2 * scheme.order + 1);
}

/// Sum over all p of the factor of chi.
inline double sum_of_alias_weights(const MeshScheme& scheme, double theta) {
    const double cosine = std::cos(theta), square = cosine * cosine;
    if (scheme.energy_conserving) return scheme.order == 1 ? 1.0 : (1.0 + 2.0 * square) / 3.0;
    return scheme.order < 2 ? square : square * (2.0 + square) / 3.0;
}

/// What a warm species adds to D where fields kick at steps dt: with x = omega - k u, tau = k v dt,
///   chi = omega_s^2 dt^2 sum_(n > 0) n exp(i n x dt - (n tau)^2 / 2) = sum_m chi_(dt -> 0)(x + 2 pi m / dt)
///   the first sum where tau is not small; else, of the second, the term nearest to x, and of the
///   others the powers tau^0 and tau^2, which have a closed form
/// exact: to 1e-6 of the largest term; without temperature -(omega_s dt / 2)^2 / sin^2(x dt / 2)
inline Complex kicked_susceptibility(const PlasmaSpecies& s, double tau, double dt, Complex x) {
    const Complex i(0.0, 1.0);
    const Complex turn(std::remainder(x.real() * dt, 2.0 * std::numbers::pi), x.imag() * dt);
    const double by = s.frequency_squared() * dt * dt;
    if (tau > 0.05) {
        const double damping = std::max(0.0, -turn.imag());
        const double count =
            (damping + std::sqrt(damping * damping + 80.0 * tau * tau)) / (tau * tau);
        if (!(count < 1e6)) return common::no_value;
        Complex sum = 0.0;
        for (double n = 1.0; n <= count; ++n)
            sum += n * std::exp(i * n * turn - 0.5 * n * n * tau * tau);
        return by * sum;
    }
    // Of all terms 1 / w^2 and 3 tau^2 / w^4, without those of w = turn.
    Complex others = -1.0 / 12.0 - turn * turn / 240.0, fourth = 1.0 / 720.0;
    if (std::abs(turn) > 0.05) {
        const Complex sine = std::sin(0.5 * turn), by_square = 0.25 / (sine * sine);
        others = 1.0 / (turn * turn) - by_square;
        fourth = by_square * by_square - by_square / 6.0 - std::pow(turn, -4);
    }
    const Complex zeta = turn / (std::numbers::sqrt2 * tau);
    return by * (common::plasma_response(zeta) / (tau * tau) + others - 3.0 * tau * tau * fourth);
}

/// What one species adds to D in an unbounded plasma.
inline Complex susceptibility(const PlasmaSpecies& s, double k, double dt, Complex omega) {
    const Complex doppler = omega - k * s.drift;
    const double kv = std::abs(k) * s.speed_along();
    if (kv > 0.0 && dt > 0.0) return kicked_susceptibility(s, kv * dt, dt, doppler);
    if (kv > 0.0) {
        const Complex zeta = doppler / (std::numbers::sqrt2 * kv);
        return s.frequency_squared() / (kv * kv) * common::plasma_response(zeta);
    }
    const Complex leapfrog = dt > 0.0 ? 2.0 / dt * std::sin(0.5 * dt * doppler) : doppler;
    if (leapfrog * leapfrog == 0.0) return common::no_value;
    return -s.frequency_squared() / (leapfrog * leapfrog);
}

/// Sum of f(p) over -count <= p <= count.
template <class Summand>
Complex near_sum(const Summand& f, long count) {
    Complex sum = f(0.0);
    for (long p = count; p > 0; --p) sum += f(double(p)) + f(-double(p));
    return sum;
}

/// Sum of f(p) over |p| > count, for an f that is smooth there and falls off like a power of p: the
/// formula of Euler and Maclaurin, with Gauss's eight points in 1 / p for the integral.
///   sum_(p > P) h(p) = integral_(P + 1/2) dp h(p) + h'(P + 1/2) / 24 + ...,  h(p) = f(p) + f(-p)
template <class Summand>
Complex far_sum(const Summand& f, long count) {
    struct Point {
        double place, weight;
    };
    constexpr std::array<Point, 4> gauss{{{0.1834346424956498, 0.3626837833783620},
                                          {0.5255324099163290, 0.3137066458778873},
                                          {0.7966664774136267, 0.2223810344533745},
                                          {0.9602898564975363, 0.1012285362903763}}};
    const auto both = [&](double p) { return f(p) + f(-p); };
    const double P = double(count), edge = P + 0.5;
    Complex sum = (both(P + 1.0) - both(P)) / 24.0;
    for (const Point& point : gauss) {
        for (const double sign : {-1.0, 1.0}) {
            const double s = 0.5 * (1.0 + sign * point.place);  // edge / p
            sum += 0.5 * point.weight * edge / (s * s) * both(edge / s);
        }
    }
    return sum;
}

/// What one species adds to D on the mesh; roughly: good enough for a first guess at a root.
inline Complex mesh_susceptibility(const PlasmaSpecies& s, double k, const MeshScheme& scheme,
                                   Complex omega, bool roughly = false) {
    const double theta = 0.5 * k * scheme.dx;
    const double speed = std::max(std::abs(s.drift), s.speed_along());
    if (speed == 0.0)
        return sum_of_alias_weights(scheme, theta) * susceptibility(s, k, scheme.dt, omega);

    const auto f = [&](double p) {
        const double k_p = k + 2.0 * std::numbers::pi / scheme.dx * p;
        return alias_weight(scheme, theta, p) * susceptibility(s, k_p, scheme.dt, omega);
    };
    // The resonances omega = k_p u and omega = k_p v are at |p| = resonant.
    const double resonant = 0.5 * std::numbers::inv_pi * std::abs(omega) * scheme.dx / speed;
    const auto aliases = [](double count) { return std::lround(std::min(count, 1000.0)); };
    if (roughly) return near_sum(f, aliases(4.0 + resonant));
    const double power = 2.0 * scheme.order + (scheme.energy_conserving ? 0.0 : 1.0);
    if (scheme.dt == 0.0 || (s.drift == 0.0 && s.speed_along() > 0.0)) {
        const long count = aliases(8.0 + 24.0 / power + 3.0 * resonant);
        return near_sum(f, count) + far_sum(f, count);
    }
    // With the leapfrog, chi of a drifting species is periodic in k_p u: only the weights fall off,
    // and with a temperature chi, where particles cross a wavelength in a step.
    const double crossed =
        10.0 * scheme.dx / (2.0 * std::numbers::pi * scheme.dt * s.speed_along());
    return near_sum(f, aliases(std::min(1.0 + crossed, std::pow(1e10, 1.0 / power))));
}

}  // namespace detail

/// Waves along an axis of the mesh; see the top of this file.
///   chi = sum_s omega_s^2 / (k v_s)^2 [1 + zeta_s Z(zeta_s)],
///   zeta_s = (omega - k u_s) / (2^1/2 |k| v_s),  v_s^2 = T_s / m_s
///   at dt = 0, with kicked_susceptibility() otherwise; and for a cold species
///   - omega_s^2 / {(2 / dt) sin[(omega - k u_s) dt / 2]}^2
/// in:     plasma, with omega_s^2 = 4 pi n q^2 / m: pass density / (4 pi) where Gauss's law has no
///         4 pi; 0 < |k| <= pi / dx
/// exact:  The error of the sum is below 1e-9 max(1, |D|) with ngp and 1e-10 otherwise, while the
///         larger of |u| and v of a moving species is above 1e-3 |omega| dx; a species at rest and
///         cold has none. The resonances of a cold drifting species with dt > 0 do not weaken with
///         |p|: there the error relative to the largest chi is 1e-3 with ngp, 1e-6 with
///         energy-conserving cic, and 1e-9 otherwise.
/// note:   Deep below the real axis, where exp(-zeta^2) of any alias overflows, D is not finite, and a
///         search for roots gives up.
inline common::Complex mesh_dispersion(std::span<const common::PlasmaSpecies> plasma, double k,
                                       const MeshScheme& scheme, common::Complex omega) {
    common::Complex D = 1.0;
    for (const auto& s : plasma) D += detail::mesh_susceptibility(s, k, scheme, omega);
    return D;
}

/// Guesses for the roots of the mesh mode k.
///   1. the roots of D with few aliases, from common::fan_of_guesses and from around the resonances
///      k_p u_s +- omega_p of drifting species
///   2. brought to the frequencies under which samples in time show them, |Re omega| <= pi / dt
inline std::vector<common::Complex> guesses_on_mesh(std::span<const common::PlasmaSpecies> plasma,
                                                    double k, const MeshScheme& scheme) {
    using common::Complex;
    const auto rough_D = [&](Complex omega) {
        Complex D = 1.0;
        for (const auto& s : plasma) D += detail::mesh_susceptibility(s, k, scheme, omega, true);
        return D;
    };
    std::vector<Complex> guesses = common::fan_of_guesses(plasma, k);
    double total_squared = 0.0;
    for (const auto& s : plasma) total_squared += s.frequency_squared();
    const double omega_p = std::sqrt(total_squared);
    for (const auto& s : plasma)
        for (const double p : {-3.0, -2.0, -1.0, 1.0, 2.0, 3.0})
            for (const double away : {-1.0, -0.5, 0.0, 0.5, 1.0})
                if (s.drift != 0.0)
                    guesses.push_back((k + 2.0 * std::numbers::pi / scheme.dx * p) * s.drift +
                                      Complex(away, 0.2) * omega_p);

    std::vector<Complex> roots;
    for (const Complex guess : guesses) {
        const common::DispersionRoot root = common::root_near(rough_D, guess);
        if (!root.found) continue;
        roots.push_back(root.omega);
        if (scheme.dt > 0.0)
            roots.back().real(
                std::remainder(root.omega.real(), 2.0 * std::numbers::pi / scheme.dt));
    }
    return roots;
}

/// The fastest growing (or least damped) wave of the mesh mode k.
/// out:    not found where there is no wave: at k = pi / dx, where kappa = 0
inline common::DispersionRoot fastest_growing_on_mesh(std::span<const common::PlasmaSpecies> plasma,
                                                      double k, const MeshScheme& scheme) {
    const auto D = [&](common::Complex omega) { return mesh_dispersion(plasma, k, scheme, omega); };
    return common::fastest_growing_root(D, guesses_on_mesh(plasma, k, scheme));
}

/// The drift u / (omega_p dx) below which the energy-conserving scheme makes a cold beam unstable.
///   The last wave to become stable alternates from node to node, k = pi / dx. Its aliases come in
///   pairs +-k_p, so D has its maximum between the resonances omega = +-(pi / dx) u at zero, and
///     D(0) = 1 - (threshold omega_p dx / u)^2
///   Where that is negative the curve misses the axis, and two real roots have become a pair of
///   complex ones.
/// in:     order, 1 or 2
/// exact:  12^-1/2 and 30^-1/2, to 1e-11
/// note:   For dt -> 0. A finite dt adds narrow resonances of high aliases, where omega - k_p u is
///         a multiple of 2 pi / dt. They can grow above the threshold, too, if particles are close
///         enough to show them.
inline double cold_beam_threshold(int order) {
    const common::PlasmaSpecies beam{
        .density = 0.25 * std::numbers::inv_pi, .charge = 1.0, .mass = 1.0, .drift = 1.0};
    const MeshScheme scheme{1.0, 0.0, order, true};
    const common::Complex D = mesh_dispersion({&beam, 1}, std::numbers::pi, scheme, 0.0);
    return std::sqrt(1.0 - D.real());
}

}  // namespace cic
