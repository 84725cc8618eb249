// on the grid: forces make the new velocities of the nodes.
//
//     m_i (v_i^1 - v_i^0)/dt = - sum_p V_p^{1/2} sigma_p^{1/2} . grad S_ip + m_i f_i^0   [MPM-12]
// The force of constraint f_i^0 is what contact adds afterwards (contact.hpp); the first term was
// summed up in mpm_explicit/strain.hpp.
#pragma once

#include <cmath>

#include "mpm_explicit/apply_loads.hpp"
#include "mpm_explicit/budget.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm_explicit {

using namespace mpm;

/// v_i^1 without contact, damped halfway before the force and halfway after it.
///   v_i^1 = d [d v_i^0 + dt (f_i/m_i + g)],  d = exp(-c dt/2)
/// exact:  a free velocity falls by exp(-c dt); a wave by exp(-c dt/2), without the error c dt of a
///         force - c v_i^0
inline void accelerate_nodes(const BodyForce& body, const std::vector<Grain>& grains,
                             const std::vector<RigidMotion>& rigid, double dt, GrainNodes& nodes) {
    const double least_mass = nodes.least_mass(), d = std::exp(-0.5 * body.damping * dt),
                 taken = dt > 0 ? (1 - d * d) / dt : 0;
    reduce_ghost_force(nodes);
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        for (long i = begin; i < end; ++i) {
            const auto n = static_cast<std::size_t>(i);
            NodeMotion& v = nodes.motion[n];
            const bool empty = !(nodes.mass[n] > least_mass);
            const double dt_m = empty ? 0 : d * dt / nodes.mass[n], dt_body = empty ? 0 : dt;
            v.vx_1 =
                v.vx_0 + dt_m * nodes.force[n].x + dt_body * (d * body.gravity_x - taken * v.vx_0);
            v.vy_1 =
                v.vy_0 + dt_m * nodes.force[n].y + dt_body * (d * body.gravity_y - taken * v.vy_0);
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
    const double d = std::exp(-0.5 * body.damping * dt), of_v = d * d - 1, of_force = dt * (d - 1);
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
            damping += mean_x * (m * (of_v * v.vx_0 + of_force * body.gravity_x) +
                                 of_force * nodes.force[n].x) +
                       mean_y * (m * (of_v * v.vy_0 + of_force * body.gravity_y) +
                                 of_force * nodes.force[n].y);
            const double squared = v.vx_1 * v.vx_1 + v.vy_1 * v.vy_1;
            speed = squared > speed ? squared : speed;
        }
        part[block] = {dt * internal_work, 0.5 * kinetic_increment, dt * gravity, damping,
                       std::sqrt(speed)};
    });
    NodeWork total;
    for (const NodeWork& one : part) total += one;
    return total;
}

}  // namespace mpm_explicit
