// on the grid: forces make the new velocities of the nodes.
//
//     m_i (v_i^1 - v_i^0)/dt = - sum_p V_p^{1/2} sigma_p^{1/2} . grad S_ip + m_i f_i^0   [MPM-12]
// The force of constraint f_i^0 is what contact adds afterwards (contact.hpp); the first term was
// summed up in mpm_explicit/strain.hpp.
#pragma once

#include <cmath>

#include "mpm_explicit/budget.hpp"
#include "mpm_explicit/grains/apply_loads.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm_explicit {

using namespace mpm;

/// The part of the velocity that damping takes in a step, per time: [1 - exp(-c dt)]/dt.
inline double damping_rate(double c, double dt) { return dt > 0 ? -std::expm1(-c * dt) / dt : c; }

/// v_i^1 without contact. What damping takes depends on v_i^0 alone, so that it bears no load at rest.
///   v_i^1 = exp(-c dt) v_i^0 + dt (f_i/m_i + g)
/// exact:  a free velocity falls by exp(-c dt); a wave of frequency w by exp(-c dt/2), as if w^2
///         were larger by exp(c dt/2), to second order
inline void accelerate_nodes(const BodyForce& body, const std::vector<Grain>& grains,
                             const std::vector<RigidMotion>& rigid, double dt, GrainNodes& nodes) {
    const double least_mass = nodes.least_mass(), c = damping_rate(body.damping, dt);
    reduce_ghost_force(nodes);
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        for (long i = begin; i < end; ++i) {
            const auto n = static_cast<std::size_t>(i);
            NodeMotion& v = nodes.motion[n];
            const bool empty = !(nodes.mass[n] > least_mass);
            const double dt_m = empty ? 0 : dt / nodes.mass[n], dt_body = empty ? 0 : dt;
            v.vx_1 = v.vx_0 + dt_m * nodes.force[n].x + dt_body * (body.gravity_x - c * v.vx_0);
            v.vy_1 = v.vy_0 + dt_m * nodes.force[n].y + dt_body * (body.gravity_y - c * v.vy_0);
        }
    });
    prescribe_rigid_velocity(grains, rigid, nodes);
    for (const long i : nodes.fixed_x()) nodes.motion[i].vx_1 = 0;
    for (const long i : nodes.fixed_y()) nodes.motion[i].vy_1 = 0;
    fill_ghost_velocity(nodes);
}

/// v_i^1 as the stress of the last half step makes it: contact judges by it which pairs press.
/// out:    nodes.motion, v_1; nodes.force, which is cleared for the stress of this step
inline void predict_acceleration(const BodyForce& body, const std::vector<Grain>& grains,
                                 const std::vector<RigidMotion>& rigid, double dt,
                                 GrainNodes& nodes) {
    accelerate_nodes(body, grains, rigid, dt, nodes);
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        std::fill(nodes.force.begin() + begin, nodes.force.begin() + end, NodeForce{});
    });
}

/// Work on the nodes in this step, and their largest speed; after contact.
inline NodeWork work_on_nodes(const BodyForce& body, double dt, const GrainNodes& nodes) {
    std::array<NodeWork, common::block_count> part;
    common::for_each_block(nodes.size(), [&](int block, long begin, long end) {
        double internal_work = 0, kinetic_increment = 0, gravity = 0, damping = 0, speed = 0;
        const unsigned char* is_free = nodes.is_free().data();
#pragma omp simd reduction(+ : internal_work, kinetic_increment, gravity, damping) reduction(max : speed)
        for (long i = begin; i < end; ++i) {
            const auto n = static_cast<std::size_t>(i);
            const NodeMotion& v = nodes.motion[n];
            const double m = is_free[n] * nodes.mass[n], dx = v.vx_1 - v.vx_0, dy = v.vy_1 - v.vy_0,
                         mean_x = 0.5 * (v.vx_0 + v.vx_1), mean_y = 0.5 * (v.vy_0 + v.vy_1);
            internal_work += nodes.force[n].x * mean_x + nodes.force[n].y * mean_y;
            kinetic_increment += m * (dx * dx + dy * dy);
            gravity += m * (body.gravity_x * mean_x + body.gravity_y * mean_y);
            damping -= m * (v.vx_0 * mean_x + v.vy_0 * mean_y);
            const double squared = v.vx_1 * v.vx_1 + v.vy_1 * v.vy_1;
            speed = squared > speed ? squared : speed;
        }
        part[block] = {dt * internal_work, 0.5 * kinetic_increment, dt * gravity,
                       dt * damping_rate(body.damping, dt) * damping, std::sqrt(speed)};
    });
    NodeWork total;
    for (const NodeWork& one : part) total += one;
    return total;
}

}  // namespace mpm_explicit
