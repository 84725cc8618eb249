// Loads of a step of the theta scheme: as in mpm_explicit/grains/apply_loads.hpp, but the velocity of a
// grain under force control is found together with those of the nodes.
#pragma once

#include "mpm_explicit/grains/apply_loads.hpp"

namespace mpm_implicit {

using namespace mpm;

/// A rigid grain under force control: its velocity at t^n + theta dt is one more unknown V^theta,
///   m (V^theta - V^0) = theta dt (F + push - c V^theta),  V^1 = V^0 + (V^theta - V^0)/theta
/// so that at theta = 1/2 what pushes it works as much as its kinetic energy grows.
struct ForceControl {
    std::size_t grain;
    bool along_x;
    double mass, damping, force;  // force: now
    double velocity;              // V^0
};

/// Loads in the step from t^n: the body force, and velocities of rigid grains.
/// out:    force_controls, the grains whose velocity belongs to the solution
inline BodyForce apply_loads(const Loads& loads, long step, double dt,
                             std::vector<RigidMotion>& rigid,
                             std::vector<ForceControl>& force_controls) {
    const double t = time_of_load(step, dt), share = share_of_load(t, loads.rise);
    force_controls.clear();
    for (std::size_t g = 0; g < rigid.size(); ++g) {
        RigidMotion& is = rigid[g];
        if (is.force_control_x || is.force_control_y)
            force_controls.push_back({g, is.force_control_x, is.mass, is.damping, share * is.force,
                                      is.force_control_x ? is.vx : is.vy});
        const auto [vx, vy] =
            prescribed_velocity(is, static_cast<double>(step) * dt, dt, loads.rise);
        if (!is.force_control_x) is.vx = vx, is.travel_x += dt * vx;
        if (!is.force_control_y) is.vy = vy, is.travel_y += dt * vy;
    }
    return body_force(loads, t);
}

/// Velocities at t^{n+1} of the grains under force control.
/// in/out: rigid, with their velocities at t^n + theta dt
inline void extrapolate_controlled(const std::vector<ForceControl>& force_controls, double theta,
                                   std::vector<RigidMotion>& rigid) {
    for (const ForceControl& control : force_controls) {
        RigidMotion& is = rigid[control.grain];
        double& V = control.along_x ? is.vx : is.vy;
        V = control.velocity + (V - control.velocity) / theta;
    }
}

}  // namespace mpm_implicit
