// Loads: gravity, and rigid grains, which are plates and pistons with a prescribed motion or under
// force control.
#pragma once

#include <vector>

#include "mpm_explicit/grains.hpp"

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

/// Velocities of rigid grains for the step from t to t + dt.
///   prescribed:     v = share(t) v_prescribed
///   force control:  m dv/dt = share(t) F + push - c v, push the force of the other grains on it
/// note:    The dashpot c is taken at the new velocity: it never overshoots, however large.
inline void prescribe_motion(double t, double dt, double rise, std::vector<RigidMotion>& rigid) {
    const double share = share_of_load(t, rise);
    const auto driven = [&](const RigidMotion& is, double v, double force, double push) {
        return (v + dt * (share * force + push) / is.mass) / (1 + dt * is.damping / is.mass);
    };
    for (RigidMotion& is : rigid) {
        is.vx =
            is.force_control_x ? driven(is, is.vx, is.force, is.push_x) : share * is.prescribed_vx;
        is.vy =
            is.force_control_y ? driven(is, is.vy, is.force, is.push_y) : share * is.prescribed_vy;
        is.travel_x += dt * is.vx, is.travel_y += dt * is.vy;
    }
}

/// The middle of a step, where loads are taken.
inline double time_of_load(long step, double dt) { return (static_cast<double>(step) + 0.5) * dt; }

/// The body force at a time.
inline BodyForce body_force(const Loads& loads, double t) {
    const double share = share_of_load(t, loads.rise);
    return {share * loads.gravity_x, share * loads.gravity_y, loads.damping};
}

/// Loads in the step from t^n: the body force, and the velocities of rigid grains.
inline BodyForce apply_loads(const Loads& loads, long step, double dt,
                             std::vector<RigidMotion>& rigid) {
    const double t = time_of_load(step, dt);
    prescribe_motion(t, dt, loads.rise, rigid);
    return body_force(loads, t);
}

}  // namespace mpm
