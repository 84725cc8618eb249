// Which pairs of a node are in contact in this step of leapfrog, and v_i^0 as they allow it. [MPM-4]
//
// Leapfrog has two velocities of a node in a step, and contact acts on both: v_i^0 makes the strain,
// and if it were free every body would see its boundary move through its partner; v_i^1 moves the
// particles. A pair is in contact at both levels or at neither.
//
//     v_i^0  --- no approach --->  + dt (f_i/m_i + g)  --- contact --->  pressure, stick or slip
//            by the stress of the last half step                          |
//     v_i^0  <--- closed pairs: (v_b - v_a).n = 0, those that stick: (v_b - v_a).t = 0
//
// Particles take the change from v_i^0 to v_i^1 alone. With J^0, J^1 the impulses at the two levels
// and v the relative velocity after contact, of b to a, contact does the work
//     J^1.(v^0 + v^1)/2 - J^0.(v^1 - v^0)
// on them. Without friction both terms are zero while a pair presses, v^0.n = v^1.n = 0. Where it
// parts, J^1 = 0 and J^0.n >= 0: the second term takes energy and never gives any. With friction it
// may have either sign, where a pair that was held across slips; J^1.(v^0 + v^1)/2 takes more.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mpm_explicit/contact/solve_contact_node.hpp"

namespace mpm {

/// Finds the pairs that are in contact in this step, and what they make of v_i^0.
/// in/out: node, with v_0 without contact and in (vx, vy) v_1 as the stress of the last half step
///         makes it without contact; out: (vx, vy), v_0 with contact, and the closed pairs alone,
///         with the impulses old_n, old_t that made it
/// exact:  closed pairs do not approach, nor part where they press; momentum as in
///         solve_contact_node
/// note:   A node remembers nothing: the pressure is judged by the stress of the particles, so that
///         a frame that moves by whole cells per step sees the same contact.
inline void close_contact_node(ContactNode& node) {
    constexpr bool friction = false;  // on v_i^0, whose impulses are no measure of the pressure
    std::array<std::array<double, 2>, ContactNode::max_bodies> change;
    for (std::size_t k = 0; k < node.bodies.size(); ++k) {
        ContactBody& body = node.bodies[k];
        change[k] = {body.vx - body.vx_0, body.vy - body.vy_0};
        if (!body.is_fixed()) body.vx = body.vx_0, body.vy = body.vy_0;
    }
    const auto forget_impulses = [&] {
        for (ContactPair& pair : node.pairs) pair.lambda_n = pair.lambda_t = 0;
    };
    solve_contact_node(node, friction);

    // Which pairs press, and which of these friction holds.
    forget_impulses();
    for (std::size_t k = 0; k < node.bodies.size(); ++k) {
        ContactBody& body = node.bodies[k];
        if (!body.is_fixed()) body.vx += change[k][0], body.vy += change[k][1];
    }
    solve_contact_node(node);
    for (ContactPair& pair : node.pairs) {
        if (pair.bond >= 0) continue;
        pair.held_n = pair.lambda_n > 0;
        pair.held_t = std::fabs(pair.lambda_t) < pair.mu * pair.lambda_n;
    }

    // v_i^0, on which these are held and no others approach; pairs without an impulse there are open.
    forget_impulses();
    for (ContactBody& body : node.bodies)
        if (!body.is_fixed()) body.vx = body.vx_0, body.vy = body.vy_0;
    solve_contact_node(node, friction);
    const auto closed = [](const ContactPair& pair) { return pair.held_n || pair.lambda_n > 0; };
    const auto end = std::stable_partition(node.pairs.begin(), node.pairs.end(), closed);
    node.pairs = node.pairs.first(end - node.pairs.begin());
    for (ContactPair& pair : node.pairs) {
        pair.old_n = pair.lambda_n, pair.old_t = pair.lambda_t;
        // A pair that was held against parting may not part in this step: it would gain by it.
        pair.held_n = pair.bond >= 0 || pair.old_n < 0, pair.held_t = pair.bond >= 0;
    }
    forget_impulses();
}

}  // namespace mpm
