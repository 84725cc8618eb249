// Grains meet at the nodes they share: what one presses or rubs on the other there.       [MPM-4]
//
// Two grains a and b that are close enough (meetings.hpp), with the normal n from a to b, press when
// they approach, (v_a - v_b).n > 0. An impulse lambda n, equal and opposite, takes the approach away,
// and friction takes the slip away as far as Coulomb allows:
//     lambda >= 0,   |lambda_t| <= mu lambda
// With more than two at a node (grains, rigid ones, walls) the pairs are solved in turn until nothing
// changes (projected Gauss-Seidel). Bonded grains do not part and do not slip.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mpm_explicit/bond_load.hpp"
#include "mpm_explicit/meetings.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm {

/// What contact did in one step. Work is impulse times velocity, at the level of the scheme.
struct ContactSums {
    double normal = 0, friction = 0, bond = 0;  // work within the grains
    double rigid = 0;                           // work of rigid grains on the others
    double impulse = 0;                         // sum of all |lambda|
    double nodes = 0;                           // pairs that press, counted at nodes

    void operator+=(const ContactSums& other) {
        normal += other.normal, friction += other.friction, bond += other.bond;
        rigid += other.rigid, impulse += other.impulse, nodes += other.nodes;
    }
};

/// At which level of time a scheme counts what contact did; leapfrog: at the mean of old and new.
struct ContactLevel {
    double old_share = 0.5;  // of v_i^0 in the velocity that does work; the rest is v_i^1
    double per_impulse = 1;  // what is reported, over the impulse that changes v_i^1
};

class Contact {
   public:
    Contact(const ContactRule& rule, const std::vector<Grain>& grains,
            const std::vector<Bond>& bonds)
        : meetings_(rule, grains, bonds) {
        for (std::size_t g = 0; g < grains.size(); ++g)
            if (grains[g].rigid) rigid_grains_.push_back(g);
    }

    const Meetings& meetings() const { return meetings_; }

    /// Gives bonded grains one velocity v_i^0 at every node they share, so that strain does not see
    /// the joint.
    /// exact:  grains bonded at all their common nodes move as one grain
    void join_bonds(const std::vector<Bond>& bonds, GrainNodes& nodes) const {
        if (bonds.empty()) return;
        meetings_.for_each(nodes, bonds, true, [&](int, detail::NodeProblem& node) {
            for (std::size_t k = 0; k < node.parties; ++k)
                node.party[k].vx = node.party[k].vx_0, node.party[k].vy = node.party[k].vy_0;
            detail::solve(node);
            for (std::size_t k = 0; k < node.parties; ++k) {
                if (node.party[k].is_fixed()) continue;
                NodeMotion& v = nodes.motion[static_cast<std::size_t>(node.party[k].dof)];
                v.vx_0 = node.party[k].vx, v.vy_0 = node.party[k].vy;
            }
        });
        fill_ghost_velocity(nodes);
    }

    /// Corrects v_i^1 at the shared nodes, once per step.
    /// in:     level, what the scheme counts
    /// in/out: nodes.motion; bonds, their stresses and whether they break; rigid, the force on each
    ///         rigid grain
    /// out:    what it did
    /// exact:  momentum of the grains at a node, to round-off; afterwards none of them approach,
    ///         and none slip where friction can hold. Where four or more grains jam at one node, a
    ///         thousandth of the approach may be left.
    /// errors: NumericalError when too many grains are at a node
    ContactSums apply(double dt, GrainNodes& nodes, std::vector<Bond>& bonds,
                      std::vector<RigidMotion>& rigid, const ContactLevel& level = {}) const {
        return apply(dt, nodes, bonds, rigid, level,
                     [](int, detail::NodeProblem& node) { detail::solve(node); });
    }

    /// The same with impulses that are found elsewhere.
    /// in:     settle(block, node), which sets impulses and velocities of a node; block as in
    ///         Meetings::for_each
    template <class Settle>
    ContactSums apply(double dt, GrainNodes& nodes, std::vector<Bond>& bonds,
                      std::vector<RigidMotion>& rigid, const ContactLevel& level,
                      const Settle& settle) const {
        struct Block {
            ContactSums sums;
            std::vector<std::array<double, 2>> push;  // impulses on rigid grains
            std::vector<detail::BondLoad> loads;
        };
        std::array<Block, common::block_count> blocks;
        for (Block& block : blocks) block.push.assign(rigid_grains_.size(), {0, 0});
        meetings_.for_each(nodes, bonds, false, [&](int number, detail::NodeProblem& node) {
            Block& block = blocks[static_cast<std::size_t>(number)];
            settle(number, node);
            for (std::size_t k = 0; k < node.pairs; ++k) {
                detail::Pair& pair = node.pair[k];
                pair.lambda_n *= level.per_impulse, pair.lambda_t *= level.per_impulse;
                add_work(node, pair, level.old_share, block.sums);
                add_push(node, pair, block.push);
                if (pair.bond >= 0) block.loads.push_back(detail::load_of(node, pair));
            }
            for (std::size_t k = 0; k < node.parties; ++k) {
                if (node.party[k].is_fixed()) continue;
                NodeMotion& v = nodes.motion[static_cast<std::size_t>(node.party[k].dof)];
                v.vx_1 = node.party[k].vx, v.vy_1 = node.party[k].vy;
            }
        });
        ContactSums sums;
        for (const Block& block : blocks) sums += block.sums;
        for (std::size_t k = 0; k < rigid_grains_.size(); ++k) {
            RigidMotion& motion = rigid[rigid_grains_[k]];
            motion.push_x = motion.push_y = 0;
            for (const Block& block : blocks)
                motion.push_x += block.push[k][0] / dt, motion.push_y += block.push[k][1] / dt;
        }
        std::vector<detail::BondLoad> total(bonds.size());
        for (const Block& block : blocks)
            for (const detail::BondLoad& load : block.loads)
                total[static_cast<std::size_t>(load.bond)] += load;
        for (std::size_t k = 0; k < bonds.size(); ++k) detail::take_load(total[k], dt, bonds[k]);
        fill_ghost_velocity(nodes);
        return sums;
    }

   private:
    static void add_work(const detail::NodeProblem& node, const detail::Pair& pair,
                         double old_share, ContactSums& sums) {
        const detail::Party &a = node.party[pair.a], &b = node.party[pair.b];
        const double tx = -pair.ny, ty = pair.nx;
        const auto mean = [&](const detail::Party& p, double& x, double& y) {
            x = p.is_fixed() ? p.vx : old_share * p.vx_0 + (1 - old_share) * p.vx;
            y = p.is_fixed() ? p.vy : old_share * p.vy_0 + (1 - old_share) * p.vy;
        };
        double ax, ay, bx, by;
        mean(a, ax, ay), mean(b, bx, by);
        const double normal = pair.lambda_n * ((bx - ax) * pair.nx + (by - ay) * pair.ny),
                     friction = pair.lambda_t * ((bx - ax) * tx + (by - ay) * ty);
        if (pair.bond >= 0) {
            sums.bond += normal + friction;
        } else {
            sums.normal += normal, sums.friction += friction;
            if (pair.lambda_n > 0) sums.impulse += pair.lambda_n, sums.nodes += 1;
        }
        // A fixed one takes or gives the rest.
        const double jx = pair.lambda_n * pair.nx + pair.lambda_t * tx,
                     jy = pair.lambda_n * pair.ny + pair.lambda_t * ty;
        if (a.is_fixed()) sums.rigid += jx * ax + jy * ay;
        if (b.is_fixed()) sums.rigid -= jx * bx + jy * by;
    }

    void add_push(const detail::NodeProblem& node, const detail::Pair& pair,
                  std::vector<std::array<double, 2>>& push) const {
        for (const auto& [who, sign] : {std::pair(pair.a, -1.0), std::pair(pair.b, 1.0)}) {
            const detail::Party& party = node.party[who];
            if (!party.rigid) continue;
            const auto grain = static_cast<std::size_t>(party.grain);
            const auto at = std::lower_bound(rigid_grains_.begin(), rigid_grains_.end(), grain);
            auto& sum = push[static_cast<std::size_t>(at - rigid_grains_.begin())];
            sum[0] += sign * (pair.lambda_n * pair.nx - pair.lambda_t * pair.ny);
            sum[1] += sign * (pair.lambda_n * pair.ny + pair.lambda_t * pair.nx);
        }
    }

    Meetings meetings_;
    std::vector<std::size_t> rigid_grains_;
};

}  // namespace mpm
