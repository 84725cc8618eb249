// Contact of grains at the nodes they share: impulses that press and rub.                  [MPM-4]
//
// Two grains a and b that are close enough (detect_contact.hpp), with the normal n from a to b,
// press when they approach, (v_a - v_b).n > 0. An impulse lambda n, equal and opposite, takes the
// approach away, and friction takes the slip away as far as Coulomb allows:
//     lambda >= 0,   |lambda_t| <= mu lambda
// With more than two at a node (grains, rigid ones, walls) the pairs are solved in turn until
// nothing changes (solve_contact_node.hpp). Bonded grains do not part and do not slip.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mpm_explicit/contact/bond_load.hpp"
#include "mpm_explicit/contact/close_contact_node.hpp"
#include "mpm_explicit/contact/contact_list.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm {

/// What contact did in one step. Work is impulse times velocity, at the level of the scheme.
struct ContactSums {
    double normal = 0, friction = 0, bond = 0;  // work within the grains
    double release = 0;                         // of impulses on v_i^0, where it parts or slips
    double rigid = 0;                           // work of rigid grains on the others
    double impulse = 0;                         // sum of all |lambda|
    double nodes = 0;                           // pairs that press, counted at nodes

    void operator+=(const ContactSums& other) {
        normal += other.normal, friction += other.friction, bond += other.bond;
        release += other.release, rigid += other.rigid;
        impulse += other.impulse, nodes += other.nodes;
    }
};

/// At which level of time a scheme counts what contact did; leapfrog: at the mean of old and new.
struct ContactLevel {
    double old_share = 0.5;  // of v_i^0 in the velocity that does work; the rest is v_i^1
    double per_impulse = 1;  // what is reported, over the impulse that changes v_i^1
};

/// Work, forces on rigid grains and loads of bonds, summed over nodes in a fixed order.
class ContactTally {
   public:
    /// in: rigid_grains, their numbers, rising
    ContactTally(const std::vector<std::size_t>& rigid_grains, const ContactLevel& level)
        : rigid_grains_(rigid_grains), level_(level) {
        for (Block& block : blocks_) block.push.assign(rigid_grains_.size(), {0, 0});
    }

    /// Adds a node, with the velocities after contact and the impulses that made them.
    /// in:     number of the block, as in ContactDetection::for_each
    /// in/out: node; its impulses are multiplied by level.per_impulse
    [[gnu::always_inline]] void add(int number, ContactNode& node) {
        Block& block = blocks_[number];
        for (ContactPair& pair : node.pairs) {
            pair.lambda_n *= level_.per_impulse, pair.lambda_t *= level_.per_impulse;
            add_work(node, pair, block.sums);
            add_push(node, pair, block.push);
            if (pair.bond >= 0) block.loads.push_back(bond_load(node, pair));
        }
    }

    /// out: bonds, their stresses and whether they break; rigid, the force on each rigid grain
    ContactSums finish(double dt, std::vector<Bond>& bonds, std::vector<RigidMotion>& rigid) const {
        ContactSums sums;
        for (const Block& block : blocks_) sums += block.sums;
        for (std::size_t k = 0; k < rigid_grains_.size(); ++k) {
            RigidMotion& motion = rigid[rigid_grains_[k]];
            motion.push_x = motion.push_y = 0;
            for (const Block& block : blocks_)
                motion.push_x += block.push[k][0] / dt, motion.push_y += block.push[k][1] / dt;
        }
        std::vector<BondLoad> total(bonds.size());
        for (const Block& block : blocks_)
            for (const BondLoad& load : block.loads) total[load.bond] += load;
        for (std::size_t k = 0; k < bonds.size(); ++k) update_bond(total[k], dt, bonds[k]);
        return sums;
    }

   private:
    struct Block {
        ContactSums sums;
        std::vector<std::array<double, 2>> push;  // impulses on rigid grains
        std::vector<BondLoad> loads;
    };

    void add_work(const ContactNode& node, const ContactPair& pair, ContactSums& sums) const {
        const ContactBody &a = node.bodies[pair.a], &b = node.bodies[pair.b];
        const double tx = -pair.ny, ty = pair.nx, old_share = level_.old_share;
        // Of the bodies at the surface, between their nodes.
        const auto mean = [&](int ContactLink::*who, double& x, double& y) {
            x = y = 0;
            for (const ContactLink& link : pair.all_links()) {
                const ContactBody& p = node.bodies[link.*who];
                x += link.weight *
                     (p.is_fixed() ? p.vx : old_share * p.vx_0 + (1 - old_share) * p.vx);
                y += link.weight *
                     (p.is_fixed() ? p.vy : old_share * p.vy_0 + (1 - old_share) * p.vy);
            }
        };
        const auto change = [&](int ContactLink::*who, double& x, double& y) {
            x = y = 0;
            for (const ContactLink& link : pair.all_links()) {
                const ContactBody& p = node.bodies[link.*who];
                x += link.weight * (p.is_fixed() ? 0 : p.vx - p.vx_0);
                y += link.weight * (p.is_fixed() ? 0 : p.vy - p.vy_0);
            }
        };
        double ax, ay, bx, by, cax, cay, cbx, cby;
        mean(&ContactLink::a, ax, ay), mean(&ContactLink::b, bx, by);
        const double normal = pair.lambda_n * ((bx - ax) * pair.nx + (by - ay) * pair.ny),
                     friction = pair.lambda_t * ((bx - ax) * tx + (by - ay) * ty);
        if (pair.bond >= 0) {
            sums.bond += normal + friction;
        } else {
            sums.normal += normal, sums.friction += friction;
            if (pair.lambda_n > 0) sums.impulse += pair.lambda_n, sums.nodes += 1;
        }
        change(&ContactLink::a, cax, cay), change(&ContactLink::b, cbx, cby);
        sums.release -= pair.old_n * ((cbx - cax) * pair.nx + (cby - cay) * pair.ny) +
                        pair.old_t * ((cbx - cax) * tx + (cby - cay) * ty);
        // A fixed body takes or gives the rest.
        const double jx = pair.lambda_n * pair.nx + pair.lambda_t * tx,
                     jy = pair.lambda_n * pair.ny + pair.lambda_t * ty;
        if (a.is_fixed()) sums.rigid += jx * ax + jy * ay;
        if (b.is_fixed()) sums.rigid -= jx * bx + jy * by;
    }

    void add_push(const ContactNode& node, const ContactPair& pair,
                  std::vector<std::array<double, 2>>& push) const {
        for (const auto& [who, sign] : {std::pair(pair.a, -1.0), std::pair(pair.b, 1.0)}) {
            const ContactBody& body = node.bodies[who];
            if (!body.rigid) continue;
            const auto grain = static_cast<std::size_t>(body.grain);
            const auto at = std::lower_bound(rigid_grains_.begin(), rigid_grains_.end(), grain);
            auto& sum = push[at - rigid_grains_.begin()];
            sum[0] += sign * pair.impulse_x(), sum[1] += sign * pair.impulse_y();
        }
    }

    const std::vector<std::size_t>& rigid_grains_;
    ContactLevel level_;
    std::array<Block, common::block_count> blocks_;
};

class Contact {
   public:
    Contact(const ContactRule& rule, const std::vector<Grain>& grains,
            const std::vector<Bond>& bonds)
        : detection_(rule, grains, bonds) {
        for (std::size_t g = 0; g < grains.size(); ++g)
            if (grains[g].rigid) rigid_grains_.push_back(g);
    }

    const ContactDetection& detection() const { return detection_; }
    ContactTally tally(const ContactLevel& level) const { return {rigid_grains_, level}; }

    /// Gives bonded grains one velocity v_i^0 at every node they share, so that strain does not see
    /// the joint.
    /// exact:  grains bonded at all their common nodes move as one grain
    void join_bonds(const std::vector<Bond>& bonds, GrainNodes& nodes) const {
        if (bonds.empty()) return;
        detection_.for_each(nodes, bonds, true, [&](int, ContactNode& node) {
            for (ContactBody& body : node.bodies) body.vx = body.vx_0, body.vy = body.vy_0;
            solve_contact_node(node);
            store_old_velocities(node, nodes);
        });
        fill_ghost_velocity(nodes);
    }

    /// Contact on v_i^0, of which strain is made (close_contact_node.hpp).
    /// in/out: nodes.motion, v_0; in v_1, what the stress of the last half step makes of it
    /// out:    list, the contacts of this step
    /// errors: NumericalError when too many grains are at a node
    void apply_to_old(const std::vector<Bond>& bonds, GrainNodes& nodes, ContactList& list) const {
        const bool both = detection_.rule().levels == 2;
        if (!both) join_bonds(bonds, nodes);
        list.find(detection_, nodes, bonds, [&](ContactNode& node) {
            if (!both) return;
            close_contact_node(node);
            store_old_velocities(node, nodes);
        });
        fill_ghost_velocity(nodes);
    }

    /// Contact on v_i^1: the force of constraint.                                        [MPM-12]
    /// in:     list of this step; level, what the scheme counts
    /// in/out: nodes.motion, v_1; bonds, their stresses and whether they break; rigid, the force on
    ///         each rigid grain
    /// out:    what contact did
    /// exact:  momentum of the grains at a node, to round-off; afterwards none of them approach,
    ///         and none slip where friction can hold. Where three or more grains jam at one node
    ///         with friction, sweeps end early and part of the approach may be left.
    ContactSums apply_to_new(double dt, const ContactList& list, GrainNodes& nodes,
                             std::vector<Bond>& bonds, std::vector<RigidMotion>& rigid,
                             const ContactLevel& level = {}) const {
        ContactTally sums = tally(level);
        list.for_each(nodes, [&](int block, ContactNode& node, std::size_t) {
            solve_contact_node(node);
            sums.add(block, node);
            store_velocities(node, nodes);
        });
        fill_ghost_velocity(nodes);
        return sums.finish(dt, bonds, rigid);
    }

   private:
    ContactDetection detection_;
    std::vector<std::size_t> rigid_grains_;
};

}  // namespace mpm
