// Grains meet at the nodes they share: what one presses or rubs on the other there.       [MPM-4]
//
// Every grain has a velocity of its own at a node. Two grains a and b, with the normal n from a to b,
// press when they approach, (v_a - v_b).n > 0, and are close enough: fields share nodes already when
// more than a cell of nothing lies between the surfaces. An impulse lambda n, equal and opposite,
// takes the approach away, and friction takes the slip away as far as Coulomb allows:
//     lambda >= 0,   |lambda_t| <= mu lambda
// With more than two at a node (grains, rigid ones, walls) the pairs are solved in turn until nothing
// changes (projected Gauss-Seidel). Bonded grains do not part and do not slip.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/mpm/bond_load.hpp"
#include "common/mpm/node_problem.hpp"
#include "common/mpm/transfer.hpp"
#include "common/parameters.hpp"

namespace mpm {

struct ContactRule {
    double friction = 0, wall_friction = 0;
    // Grains press when the centers of their parts around a node are nearer than this, in cells; 0:
    // wherever they approach, which is too early.
    double separation = 0.8;
};

/// What contact did in one step. Work is impulse times velocity, at the mean of old and new.
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

class Contact {
   public:
    Contact(const ContactRule& rule, const std::vector<Grain>& grains,
            const std::vector<Bond>& bonds)
        : rule_(rule), bonds_of_(grains.size()) {
        for (std::size_t k = 0; k < bonds.size(); ++k) {
            const auto [low, high] = std::minmax(bonds[k].a, bonds[k].b);
            bonds_of_[static_cast<std::size_t>(low)].push_back({high, static_cast<int>(k)});
        }
        for (std::size_t g = 0; g < grains.size(); ++g) {
            is_rigid_.push_back(grains[g].rigid);
            if (grains[g].rigid) rigid_grains_.push_back(g);
        }
    }

    /// Gives bonded grains one velocity v_i^0 at every node they share, so that strain does not see
    /// the joint.
    /// exact:  grains bonded at all their common nodes move as one grain
    void join_bonds(const std::vector<Bond>& bonds, GrainNodes& nodes) const {
        if (bonds.empty()) return;
        common::for_each_block(nodes.shared_count(), [&](int, long begin, long end) {
            detail::NodeProblem node;
            for (long n = begin; n < end; ++n) {
                if (!gather(n, nodes, node)) continue;
                find_pairs(nodes.mesh().h, bonds, true, node);
                if (node.pairs == 0) continue;
                load_velocities(nodes, node);
                for (std::size_t k = 0; k < node.parties; ++k)
                    node.party[k].vx = node.party[k].vx_0, node.party[k].vy = node.party[k].vy_0;
                detail::solve(node);
                for (std::size_t k = 0; k < node.parties; ++k) {
                    if (node.party[k].is_fixed()) continue;
                    NodeMotion& v = nodes.motion[static_cast<std::size_t>(node.party[k].slot)];
                    v.vx_0 = node.party[k].vx, v.vy_0 = node.party[k].vy;
                }
            }
        });
        spread_velocity(nodes);
    }

    /// Corrects v_i^1 at the shared nodes, once per step.
    /// in/out: nodes.motion; bonds, their stresses and whether they break; rigid, the force on each
    ///         rigid grain
    /// out:    what it did
    /// exact:  momentum of the grains at a node, to round-off; afterwards none of them approach,
    ///         and none slip where friction can hold. Where four or more grains jam at one node, a
    ///         thousandth of the approach may be left.
    /// errors: NumericalError when too many grains are at a node
    ContactSums apply(double dt, GrainNodes& nodes, std::vector<Bond>& bonds,
                      std::vector<RigidMotion>& rigid) const {
        struct Block {
            ContactSums sums;
            std::vector<std::array<double, 2>> push;  // impulses on rigid grains
            std::vector<detail::BondLoad> loads;
            bool crowded = false;
        };
        std::array<Block, common::block_count> blocks;
        common::for_each_block(nodes.shared_count(), [&](int number, long begin, long end) {
            Block& block = blocks[static_cast<std::size_t>(number)];
            block.push.assign(rigid_grains_.size(), {0, 0});
            detail::NodeProblem node;
            for (long n = begin; n < end; ++n) {
                if (!gather(n, nodes, node)) continue;
                if (node.parties == detail::NodeProblem::most_parties) block.crowded = true;
                find_pairs(nodes.mesh().h, bonds, false, node);
                if (node.pairs == 0) continue;
                load_velocities(nodes, node);
                detail::solve(node);
                for (std::size_t k = 0; k < node.pairs; ++k) {
                    const detail::Pair& pair = node.pair[k];
                    add_work(node, pair, block.sums);
                    add_push(node, pair, block.push);
                    if (pair.bond >= 0) block.loads.push_back(detail::load_of(node, pair));
                }
                for (std::size_t k = 0; k < node.parties; ++k) {
                    if (node.party[k].is_fixed()) continue;
                    NodeMotion& v = nodes.motion[static_cast<std::size_t>(node.party[k].slot)];
                    v.vx_1 = node.party[k].vx, v.vy_1 = node.party[k].vy;
                }
            }
        });
        if (std::any_of(blocks.begin(), blocks.end(), [](const Block& b) { return b.crowded; }))
            throw common::NumericalError(
                "more than " + std::to_string(detail::NodeProblem::most_parties - 1) +
                " grains and walls meet at one node: refine the mesh, or use larger grains");
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
        spread_velocity(nodes);
        return sums;
    }

   private:
    // Everybody with mass at shared node n. out: whether there is anything to do
    bool gather(long n, const GrainNodes& nodes, detail::NodeProblem& node) const {
        const auto k = static_cast<std::size_t>(n);
        node.parties = node.pairs = 0;
        // Most shared nodes have mass of one grain only.
        const Member* const members = nodes.members().data();
        const long begin = nodes.shared_begin()[k], end = nodes.shared_begin()[k + 1];
        int present = 0;
        fetch_ahead(begin, end, nodes);
        for (long l = begin; l < end; ++l)
            present += members[l].is_wall() ||
                       nodes.sums[static_cast<std::size_t>(members[l].slot)].m > nodes.least_mass();
        if (present < 2) return false;
        double node_x = 0, node_y = 0;
        for (long l = begin; l < end; ++l) {
            const Member& member = members[l];
            if (node.parties == detail::NodeProblem::most_parties) break;
            detail::Party& party = node.party[node.parties];
            if (member.is_wall()) {
                if (node.parties == 0) return false;
                party = {};
                party.slot = -1, party.grain = member.grain, party.wall = true;
                party.x = member.x - node_x, party.y = member.y - node_y;
                ++node.parties;
                continue;
            }
            const auto slot = static_cast<std::size_t>(member.slot);
            const NodeSums& sum = nodes.sums[slot];
            if (!(sum.m > nodes.least_mass())) continue;
            const double per_m = 1 / sum.m;
            party.slot = member.slot, party.grain = member.grain, party.wall = false;
            party.rigid = is_rigid_[static_cast<std::size_t>(member.grain)];
            party.m = sum.m, party.per_mx = party.per_my = party.rigid ? 0 : per_m;
            party.x = sum.mx * per_m - member.x, party.y = sum.my * per_m - member.y;
            party.gx = sum.gx, party.gy = sum.gy;
            node_x = member.x, node_y = member.y;
            ++node.parties;
        }
        return node.parties > 1;
    }

    // Shared nodes are far apart in memory: they are fetched so many members before their turn.
    // Contact of a million particles in 2000 grains takes a third less time with it.
    static void fetch_ahead(long begin, long end, const GrainNodes& nodes) {
        constexpr long ahead = 32;
        const long all = static_cast<long>(nodes.members().size());
        for (long l = begin + ahead; l < std::min(end + ahead, all); ++l) {
            const Member& member = nodes.members()[static_cast<std::size_t>(l)];
            if (member.is_wall()) continue;
            __builtin_prefetch(&nodes.sums[static_cast<std::size_t>(member.slot)]);
            __builtin_prefetch(&nodes.motion[static_cast<std::size_t>(member.slot)], 1);
        }
    }

    // Velocities, and what walls forbid.
    static void load_velocities(const GrainNodes& nodes, detail::NodeProblem& node) {
        node.isotropic = true;
        for (std::size_t k = 0; k < node.parties; ++k) {
            detail::Party& party = node.party[k];
            if (party.wall) continue;
            const NodeMotion& v = nodes.motion[static_cast<std::size_t>(party.slot)];
            party.vx_0 = v.vx_0, party.vy_0 = v.vy_0, party.vx = v.vx_1, party.vy = v.vy_1;
            if (party.rigid) continue;
            if (nodes.is_fixed_x(party.slot)) party.per_mx = 0, node.isotropic = false;
            if (nodes.is_fixed_y(party.slot)) party.per_my = 0, node.isotropic = false;
        }
        for (std::size_t k = 0; k < node.pairs; ++k) {
            detail::Pair& pair = node.pair[k];
            const detail::Party &one = node.party[pair.a], &two = node.party[pair.b];
            const double per_x = one.per_mx + two.per_mx, per_y = one.per_my + two.per_my,
                         nn = pair.nx * pair.nx, tt = pair.ny * pair.ny,
                         per_n = per_x * nn + per_y * tt, per_t = per_x * tt + per_y * nn;
            pair.mass_n = per_n > 0 ? 1 / per_n : 0, pair.mass_t = per_t > 0 ? 1 / per_t : 0;
        }
    }

    // The pairs that are in contact, or only those that are bonded.
    void find_pairs(double h, const std::vector<Bond>& bonds, bool only_bonded,
                    detail::NodeProblem& node) const {
        node.pairs = 0;
        for (std::size_t b = 1; b < node.parties; ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                const detail::Party &one = node.party[a], &two = node.party[b];
                if (one.is_fixed() && two.is_fixed()) continue;
                const int bond = bonds.empty() || two.wall ? -1 : bond_of(bonds, one, two);
                if (only_bonded && bond < 0) continue;
                const bool free = !one.is_fixed() && !two.is_fixed();
                // A bond holds however little of a grain is here.
                const bool light = std::min(one.m, two.m) < low_mass * (one.m + two.m);
                if (free && bond < 0 && light) continue;
                detail::Pair& pair = node.pair[node.pairs];
                if (!find_normal(one, two, pair.nx, pair.ny)) continue;
                const double apart = (two.x - one.x) * pair.nx + (two.y - one.y) * pair.ny;
                const double limit = rule_.separation * h * (two.wall ? 0.5 : 1);
                if (bond < 0 && limit > 0 && apart > limit) continue;
                pair.a = a, pair.b = b, pair.bond = bond;
                pair.mu = two.wall ? rule_.wall_friction : rule_.friction;
                pair.lambda_n = pair.lambda_t = 0;
                ++node.pairs;
            }
        }
    }

    // From one to two: out of the fixed one where there is one, else between both gradients.
    static bool find_normal(const detail::Party& one, const detail::Party& two, double& nx,
                            double& ny) {
        if (two.wall) {
            nx = two.grain == x_low ? -1 : two.grain == x_high ? 1 : 0;
            ny = two.grain == y_low ? -1 : two.grain == y_high ? 1 : 0;
            return true;
        }
        nx = (two.rigid ? 0 : one.gx) - (one.rigid ? 0 : two.gx);
        ny = (two.rigid ? 0 : one.gy) - (one.rigid ? 0 : two.gy);
        const double squared = nx * nx + ny * ny;
        if (!(squared > 0)) return false;
        const double per_size = 1 / std::sqrt(squared);
        nx *= per_size, ny *= per_size;
        return true;
    }

    int bond_of(const std::vector<Bond>& bonds, const detail::Party& one,
                const detail::Party& two) const {
        for (const auto& [other, number] : bonds_of_[static_cast<std::size_t>(one.grain)])
            if (other == two.grain && !bonds[static_cast<std::size_t>(number)].broken)
                return number;
        return -1;
    }

    static void add_work(const detail::NodeProblem& node, const detail::Pair& pair,
                         ContactSums& sums) {
        const detail::Party &a = node.party[pair.a], &b = node.party[pair.b];
        const double tx = -pair.ny, ty = pair.nx;
        const auto mean = [](const detail::Party& p, double& x, double& y) {
            x = p.is_fixed() ? p.vx : 0.5 * (p.vx_0 + p.vx);
            y = p.is_fixed() ? p.vy : 0.5 * (p.vy_0 + p.vy);
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

    // Parts of a node's mass that are too small to turn a normal.
    static constexpr double low_mass = 1e-5;

    ContactRule rule_;
    std::vector<std::vector<std::pair<int, int>>> bonds_of_;
    std::vector<bool> is_rigid_;
    std::vector<std::size_t> rigid_grains_;
};

}  // namespace mpm
