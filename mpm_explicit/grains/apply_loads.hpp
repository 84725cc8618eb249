// Loads: gravity, and rigid grains, which are plates and pistons with a prescribed motion or under
// force control.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "mpm_explicit/grains/grains.hpp"

namespace mpm {

/// The loads of a case at their full value, which they reach smoothly in the time `rise`.
struct Loads {
    double gravity_x = 0, gravity_y = 0;  // acceleration
    double damping = 0;                   // of the velocity of all mass [1/time]
    double rise = 0;                      // [time]
};

/// Forces on all mass alike.
struct BodyForce {
    double gravity_x = 0, gravity_y = 0;  // acceleration now
    double damping = 0;                   // of the velocity [1/time]
};

/// The share of a load that is on at a time: 0 at t = 0, 1 after the rise, with two continuous
/// derivatives, so that it wakes few waves.
///   s^3 (10 - 15 s + 6 s^2),  s = t/rise
inline double share_of_load(double t, double rise) {
    if (t >= rise) return 1;
    const double s = t / rise;
    return s * s * s * (10 - 15 * s + 6 * s * s);
}

/// The mean of share_of_load over a step.
///   (R(t + dt) - R(t))/dt,  R = rise s^4 (5/2 - 3 s + s^2), the integral of the share
inline double mean_share_of_load(double t, double dt, double rise) {
    if (t >= rise) return 1;
    const auto R = [&](double time) {
        if (time >= rise) return time - 0.5 * rise;
        const double s = time > 0 ? time / rise : 0;
        return rise * s * s * s * s * (2.5 - 3 * s + s * s);
    };
    return t + dt > 0 ? (R(t + dt) - R(t)) / dt : 0;
}

/// The travel that a table tells for a time: straight from row to row, and at rest before the first
/// and after the last.
inline TravelRow travel_at(const std::vector<TravelRow>& table, double t) {
    if (table.empty() || t <= table.front().t) return table.empty() ? TravelRow{} : table.front();
    const auto next =
        std::upper_bound(table.begin(), table.end(), t,
                         [](double time, const TravelRow& row) { return time < row.t; });
    if (next == table.end()) return table.back();
    const TravelRow &a = *(next - 1), &b = *next;
    const double s = (t - a.t) / (b.t - a.t);
    return {t, a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
}

/// The mean velocity, from t to t + dt, of a rigid grain that is told to travel
///   v (R(t) - R(t - stop)) + swing sin^2(pi t/period) + table(t),  R = int share
/// It stops as smoothly as it starts, where it would have been at `stop` without any rise.
/// exact:  travel at the ends of steps, to round-off
inline std::array<double, 2> prescribed_velocity(const RigidMotion& is, double t, double dt,
                                                 double rise) {
    const double share = mean_share_of_load(t, dt, rise) -
                         (is.stop > 0 ? mean_share_of_load(t - is.stop, dt, rise) : 0);
    // sin^2(a + b) - sin^2 a = sin(2a + b) sin b
    const double turn = std::numbers::pi / is.period,
                 swing = std::sin(turn * (2 * t + dt)) * std::sin(turn * dt) / dt;
    const TravelRow from = travel_at(is.table, t), to = travel_at(is.table, t + dt);
    return {share * is.prescribed_vx + swing * is.swing_x + (to.x - from.x) / dt,
            share * is.prescribed_vy + swing * is.swing_y + (to.y - from.y) / dt};
}

/// Velocities of rigid grains for the step from t to t + dt.
///   prescribed:     prescribed_velocity
///   force control:  m dv/dt = share F + push - c v, push the force of the other grains on it, and
///                   share that of the middle of the step
/// note:    The dashpot c is taken at the new velocity: it never overshoots, however large.
inline void prescribe_motion(double t, double dt, double rise, std::vector<RigidMotion>& rigid) {
    const double share = share_of_load(t + 0.5 * dt, rise);
    const auto driven = [&](const RigidMotion& is, double v, double push) {
        return (v + dt * (share * is.force + push) / is.mass) / (1 + dt * is.damping / is.mass);
    };
    for (RigidMotion& is : rigid) {
        const auto [vx, vy] = prescribed_velocity(is, t, dt, rise);
        is.vx = is.force_control_x ? driven(is, is.vx, is.push_x) : vx;
        is.vy = is.force_control_y ? driven(is, is.vy, is.push_y) : vy;
        is.travel_x += dt * is.vx, is.travel_y += dt * is.vy;
    }
}

/// The middle of a step, where forces are taken.
inline double time_of_load(long step, double dt) { return (static_cast<double>(step) + 0.5) * dt; }

/// The body force at a time.
inline BodyForce body_force(const Loads& loads, double t) {
    const double share = share_of_load(t, loads.rise);
    return {share * loads.gravity_x, share * loads.gravity_y, loads.damping};
}

/// Loads in the step from t^n: the body force, and the velocities of rigid grains.
inline BodyForce apply_loads(const Loads& loads, long step, double dt,
                             std::vector<RigidMotion>& rigid) {
    prescribe_motion(static_cast<double>(step) * dt, dt, loads.rise, rigid);
    return body_force(loads, time_of_load(step, dt));
}

}  // namespace mpm
