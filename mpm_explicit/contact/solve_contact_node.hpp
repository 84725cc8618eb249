// The contact problem of one grid node: the bodies with mass there, the pairs of them in contact,
// and the impulses that end approach and slip.                                                [MPM-4]
//
//         a  |  b         Every body has a velocity of its own at the node. A pair exchanges the impulse
//      ------o------>     J = lambda_n n + lambda_t t:  J on b, -J on a,
//            |  n         with n from a to b and t = (-n_y, n_x).
//
// Unknowns: two impulses per pair, at most 16 bodies and 120 pairs. With v* the velocities without
// contact,
//     v_a = v_a* - sum J/m_a,   v_b = v_b* + sum J/m_b
//     lambda_n >= 0,  (v_b - v_a).n >= 0,  lambda_n (v_b - v_a).n = 0           (Signorini)
//     |lambda_t| <= mu lambda_n,  against the slip (v_b - v_a).t where it is equal   (Coulomb)
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm {

/// What a pair does: nothing, press and slide, or press without sliding.
enum class ContactState : int { open, slip, stick };

/// A grain, a rigid grain or a wall at a grid node.
struct ContactBody {
    long dof;   // the body's node; -1: a wall
    int grain;  // of a wall: its side
    bool wall, rigid;
    double per_mx, per_my;  // 1/m_i; 0 where nothing changes the velocity
    double m;
    double vx_0, vy_0;             // before the step
    double vx, vy;                 // after it, being corrected
    double x, y;                   // center of the body's mass around the node, from the node
    double gx, gy;                 // sum_p V_p grad S_ip, out of the body
    SurfaceSums surface;           // its outline, with moments about the node
    bool has_corners = false;      // the grain, somewhere
    int force_control = -1;        // theta scheme: the force control that moves a rigid grain ...
    bool control_along_x = false;  // ... and its direction; the velocity along it is an unknown
    bool is_fixed() const { return wall || rigid; }
    /// Grains have numbers from 0, walls from -1 down.
    int id() const { return wall ? -1 - grain : grain; }
};

/// What two bodies are at one of the nodes that their surface lies between.
struct ContactLink {
    int a, b;  // of the node's bodies
    double weight;
};

/// Two bodies of a node in contact or bonded.
struct ContactPair {
    static constexpr std::size_t max_links = 8;
    std::size_t a, b;  // of the node's bodies, those of the first link
    std::array<ContactLink, max_links> links;
    std::size_t link_count = 1;
    int bond;  // number of the bond, or -1
    ContactState state = ContactState::open;
    bool held_n = false, held_t = false;  // an equality along n, and across, whatever the signs
    double nx, ny;                        // normal, from a to b
    double mu;
    double mass_n, mass_t;        // effective mass along the normal and across
    double lambda_n, lambda_t;    // impulse on b, along (nx, ny) and (-ny, nx)
    double old_n = 0, old_t = 0;  // leapfrog: the impulse on v_i^0
    bool closed() const { return state != ContactState::open; }
    double tx() const { return -ny; }
    double ty() const { return nx; }
    double impulse_x() const { return lambda_n * nx - lambda_t * ny; }
    double impulse_y() const { return lambda_n * ny + lambda_t * nx; }
    std::span<const ContactLink> all_links() const { return {links.data(), link_count}; }
};

struct ContactNode {
    static constexpr std::size_t max_bodies = 16, max_pairs = max_bodies * (max_bodies - 1) / 2;
    std::span<ContactBody> bodies;
    std::span<ContactPair> pairs;
    long key = 0;           // number of the node on the mesh
    bool isotropic = true;  // 1/m_i is the same in both directions
};

/// Effective masses of all pairs: 1/m = n.(1/m_a + 1/m_b) n, and the same for t.
inline void find_effective_masses(ContactNode& node) {
    for (ContactPair& pair : node.pairs) {
        double per_x = 0, per_y = 0;
        for (const ContactLink& link : pair.all_links()) {
            const ContactBody &one = node.bodies[link.a], &two = node.bodies[link.b];
            const double squared = link.weight * link.weight;
            per_x += squared * (one.per_mx + two.per_mx);
            per_y += squared * (one.per_my + two.per_my);
        }
        const double nn = pair.nx * pair.nx, tt = pair.ny * pair.ny,
                     per_n = per_x * nn + per_y * tt, per_t = per_x * tt + per_y * nn;
        pair.mass_n = per_n > 0 ? 1 / per_n : 0, pair.mass_t = per_t > 0 ? 1 / per_t : 0;
    }
}

/// Impulses and velocities of a node by projected Gauss-Seidel: pair after pair, until a sweep
/// changes no velocity by more than round-off. A held pair neither parts nor slips, whatever the
/// signs.
/// in:     friction, false where only held pairs resist slip
/// in/out: velocities of the bodies; impulses of the pairs, from a guess
/// exact:  momentum of the bodies that are not fixed and of the impulses on the fixed ones; one
///         pair is solved in one sweep
/// note:   Where normals are nearly parallel, as of three grains in line, impulses creep, and the
///         end may be thousands of sweeps away. Without friction it is unique, and every sweep
///         comes nearer to it; with friction, or between two bodies that are told how to move,
///         there may be no end, and 500 have to do.
inline void solve_contact_node(ContactNode& node, bool friction = true) {
    double size = 0;
    for (const ContactBody& body : node.bodies)
        size = std::max({size, std::fabs(body.vx), std::fabs(body.vy)});
    const bool only_presses =
        std::all_of(node.pairs.begin(), node.pairs.end(),
                    [](const ContactPair& pair) { return !pair.held_t && pair.mu == 0; });
    const auto fixed = std::count_if(node.bodies.begin(), node.bodies.end(),
                                     [](const ContactBody& body) { return body.is_fixed(); });
    const int max_sweeps = only_presses && fixed < 2 ? 100000 : 500;
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        double change = 0;
        for (ContactPair& pair : node.pairs) {
            // [impulse]
            const auto exchange = [&](double jx, double jy) {
                for (const ContactLink& link : pair.all_links()) {
                    ContactBody &a = node.bodies[link.a], &b = node.bodies[link.b];
                    const double x = link.weight * jx, y = link.weight * jy;
                    a.vx -= x * a.per_mx, a.vy -= y * a.per_my;
                    b.vx += x * b.per_mx, b.vy += y * b.per_my;
                    change = std::max({change, std::fabs(x) * std::max(a.per_mx, b.per_mx),
                                       std::fabs(y) * std::max(a.per_my, b.per_my)});
                }
            };
            const auto apart = [&](double& x, double& y) {
                x = y = 0;
                for (const ContactLink& link : pair.all_links()) {
                    const ContactBody &a = node.bodies[link.a], &b = node.bodies[link.b];
                    x += link.weight * (b.vx - a.vx), y += link.weight * (b.vy - a.vy);
                }
            };
            double wx, wy;
            apart(wx, wy);
            const double approach = -wx * pair.nx - wy * pair.ny;
            double n = pair.lambda_n + pair.mass_n * approach;
            if (!pair.held_n) n = std::max(0.0, n);
            exchange((n - pair.lambda_n) * pair.nx, (n - pair.lambda_n) * pair.ny);
            pair.lambda_n = n;

            apart(wx, wy);
            const double slip = wx * pair.ny - wy * pair.nx;
            double t = pair.lambda_t + pair.mass_t * slip;
            const double most = friction ? pair.mu * std::max(0.0, n) : 0;
            if (!pair.held_t) t = std::clamp(t, -most, most);
            exchange((pair.lambda_t - t) * pair.ny, (t - pair.lambda_t) * pair.nx);
            pair.lambda_t = t;
            // [/impulse]
        }
        const bool exact = node.pairs.size() == 1 && node.isotropic;
        if (exact || !(change > 1e-15 * size)) return;
    }
}

}  // namespace mpm
