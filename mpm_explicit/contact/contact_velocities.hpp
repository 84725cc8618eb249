// The velocities of the bodies at a node, to the contact problem and back.
#pragma once

#include <array>

#include "mpm_explicit/contact/solve_contact_node.hpp"
#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm {

/// Velocities of the bodies from nodes.motion, no mobility along directions that walls fix, and the
/// effective masses.
inline void load_velocities(const GrainNodes& nodes, ContactNode& node) {
    node.isotropic = true;
    for (ContactBody& body : node.bodies) {
        if (body.wall) continue;
        const NodeMotion& v = nodes.motion[body.dof];
        body.vx_0 = v.vx_0, body.vy_0 = v.vy_0, body.vx = v.vx_1, body.vy = v.vy_1;
        if (body.rigid) continue;
        if (nodes.is_fixed_x(body.dof)) body.per_mx = 0, node.isotropic = false;
        if (nodes.is_fixed_y(body.dof)) body.per_my = 0, node.isotropic = false;
    }
    find_effective_masses(node);
}

/// The new velocities of the bodies, back to nodes.motion.
inline void store_velocities(const ContactNode& node, GrainNodes& nodes) {
    for (const ContactBody& body : node.bodies) {
        if (body.is_fixed()) continue;
        NodeMotion& v = nodes.motion[body.dof];
        v.vx_1 = body.vx, v.vy_1 = body.vy;
    }
}

/// The same for v_i^0.
inline void store_old_velocities(const ContactNode& node, GrainNodes& nodes) {
    for (const ContactBody& body : node.bodies) {
        if (body.is_fixed()) continue;
        NodeMotion& v = nodes.motion[body.dof];
        v.vx_0 = body.vx, v.vy_0 = body.vy;
    }
}

/// Room for the bodies and pairs of one node.
struct ContactStorage {
    std::array<ContactBody, ContactNode::max_bodies> bodies;
    std::array<ContactPair, ContactNode::max_pairs> pairs;
};

}  // namespace mpm
