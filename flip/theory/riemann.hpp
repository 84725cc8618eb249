// Two gases that meet at a plane: the exact solution of Riemann's problem.
//
// Each has a gamma and a p_infinity of its own. The solution depends on x / t alone: a wave in the
// left gas, the contact, a wave in the right gas; a wave is a shock or a fan. Where even the widest
// fans leave a gap, a void opens between the gases.
// source: Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, chapter 4.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/run/parameters.hpp"
#include "flip/theory/gas_waves.hpp"

namespace flip::theory {

/// The solution: four states and the speeds of the edges between them.
struct RiemannSolution {
    GasState left, right;                        // the gases in front of the waves
    GasState left_of_contact, right_of_contact;  // behind the waves; differ in velocity at a void
    // Speeds from left to right, each not below the one before it. Head and tail of a shock agree,
    // and so do the contacts unless there is a void between them.
    double left_head, left_tail, left_contact, right_contact, right_tail, right_head;
    bool has_void;
};

namespace riemann_detail {

inline void check(const GasState& s) {
    const bool possible = s.gamma > 1.0 && s.p_infinity >= 0.0 && s.density >= 0.0 &&
                          s.pressure + s.p_infinity >= 0.0 && std::isfinite(s.gamma) &&
                          std::isfinite(s.p_infinity) && std::isfinite(s.density) &&
                          std::isfinite(s.velocity) && std::isfinite(s.pressure);
    if (!possible)
        throw common::InputError(
            "no Riemann problem has such a state: take finite numbers with gamma > 1, p_infinity "
            ">= 0, density >= 0 and pressure >= -p_infinity");
}

}  // namespace riemann_detail

/// The waves between two gases that meet at x = 0, t = 0.
///   u_L - push_L(p) = u_R + push_R(p)  for the pressure p at the contact
/// in:    the gases; density 0 on one side is a vacuum, whose other values do not matter; the least
///        pressure that they hold together: below it they part
/// exact: mass, momentum and energy balance across shocks; entropy and u +- 2 c / (gamma - 1) are
///        constant through fans
/// errors: InputError for a gas that cannot exist, and for two vacua.
/// note:  a void has the lowest pressure that both gases allow, -p_infinity of the softer one or
///        the least; at a vacuum it is zero, so that a stiffened gas has a free surface of finite
///        density there.
inline RiemannSolution solve_riemann(GasState left, GasState right,
                                     double least = -std::numeric_limits<double>::infinity()) {
    using namespace riemann_detail;
    const auto empty_like = [](const GasState& s) {
        return GasState{0.0, s.velocity, 0.0, s.gamma, 0.0};
    };
    if (left.density == 0.0) left = empty_like(right);
    if (right.density == 0.0) right = empty_like(left);
    check(left);
    check(right);
    if (left.density == 0.0 && right.density == 0.0)
        throw common::InputError("a Riemann problem needs a gas on one side at least");
    const Front L{left, -1.0}, R{right, 1.0};

    // The unknown is the pressure above the lowest one, y, so that P is exact for both gases.
    const double lowest = std::max(least, -std::min(left.p_infinity, right.p_infinity));
    const double rise_L = left.p_infinity + lowest, rise_R = right.p_infinity + lowest;
    const auto gap = [&](double y) {
        return right.velocity - left.velocity + push(L, y + rise_L) + push(R, y + rise_R);
    };
    const bool vacuum = left.density == 0.0 || right.density == 0.0;
    constexpr double smallest = 1e-300;
    double low = std::max({L.P(), R.P(), smallest}), high = low;
    while (low > smallest && gap(low) > 0.0) low *= 0.01;
    const bool has_void = vacuum || gap(std::max(low, smallest)) > 0.0 || gap(0.0) >= 0.0;

    // Halve the bracket on a logarithmic scale until no number is left in it.
    double y = 0.0;
    if (!has_void) {
        while (gap(high) < 0.0) high *= 4.0;
        for (y = std::sqrt(low) * std::sqrt(high); low < y && y < high;
             y = std::sqrt(low) * std::sqrt(high))
            (gap(y) > 0.0 ? high : low) = y;
        y = gap(high) < -gap(low) ? high : low;
    }

    RiemannSolution s{
        left, right,   behind(L, y + rise_L), behind(R, y + rise_R), 0.0, 0.0, 0.0, 0.0, 0.0,
        0.0,  has_void};
    s.left_of_contact.pressure = s.right_of_contact.pressure = y + lowest;
    if (!has_void) {
        const double u = 0.5 * (s.left_of_contact.velocity + s.right_of_contact.velocity);
        s.left_of_contact.velocity = s.right_of_contact.velocity = u;
    }
    const auto tail = [&](const Front& f, const GasState& star, double P) {
        const bool shock = P > f.P();
        return shock ? head_speed(f, P) : star.velocity + f.side * sound_speed(star);
    };
    s.left_head = head_speed(L, y + rise_L);
    s.left_tail = tail(L, s.left_of_contact, y + rise_L);
    s.left_contact = s.left_of_contact.velocity;
    s.right_contact = s.right_of_contact.velocity;
    s.right_tail = tail(R, s.right_of_contact, y + rise_R);
    s.right_head = head_speed(R, y + rise_R);
    // No wave runs into a vacuum.
    if (left.density == 0.0) s.left_head = s.left_tail = s.left_contact = s.right_contact;
    if (right.density == 0.0) s.right_head = s.right_tail = s.right_contact = s.left_contact;
    return s;
}

/// The gas at x = (x / t) t, with the gamma and p_infinity of the gas that is there.
/// note:  in a void the density is zero and the velocity x / t.
inline GasState sample(const RiemannSolution& s, double x_over_t) {
    using riemann_detail::in_fan;
    const bool from_left = x_over_t < s.left_contact;
    const bool in_void =
        s.has_void &&
        (from_left ? s.left.density == 0.0 : x_over_t < s.right_contact || s.right.density == 0.0);
    if (in_void) {
        GasState empty = from_left ? s.left_of_contact : s.right_of_contact;
        empty.density = 0.0;
        empty.velocity = x_over_t;
        return empty;
    }
    if (from_left) {
        if (x_over_t < s.left_head) return s.left;
        return x_over_t < s.left_tail ? in_fan({s.left, -1.0}, x_over_t) : s.left_of_contact;
    }
    if (x_over_t > s.right_head) return s.right;
    return x_over_t > s.right_tail ? in_fan({s.right, 1.0}, x_over_t) : s.right_of_contact;
}

/// Mass, momentum and energy.
struct Conserved {
    double mass, momentum, energy;  // per volume
};

/// What a cell holds: the means of density, rho u and E from x = low t to x = high t.
///   integral q d(x / t) = [(x / t) q - F(q)] from low to high,
/// which is dq/dt + dF/dx = 0 for functions of x / t, across shocks and contacts too
/// in:    low < high
inline Conserved mean_between(const RiemannSolution& s, double low, double high) {
    const auto inflow = [&](double xi) {
        const GasState g = sample(s, xi);
        const double m = g.density * (xi - g.velocity), E = energy_per_volume(g);
        return Conserved{m, m * g.velocity - g.pressure,
                         E * (xi - g.velocity) - g.pressure * g.velocity};
    };
    const Conserved a = inflow(low), b = inflow(high);
    const double width = high - low;
    return {(b.mass - a.mass) / width, (b.momentum - a.momentum) / width,
            (b.energy - a.energy) / width};
}

}  // namespace flip::theory
