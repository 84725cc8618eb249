// Who meets at a node, and which of them are in contact there.                             [MPM-4]
//
// Every grain has a velocity of its own at a node. Two grains a and b, with the normal n from a to b,
// are in contact when they are close enough: fields share nodes already when more than a cell of
// nothing lies between the surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/run/parameters.hpp"
#include "mpm_explicit/grain_nodes.hpp"
#include "mpm_explicit/node_problem.hpp"

namespace mpm {

struct ContactRule {
    double friction = 0, wall_friction = 0;
    // Grains press when the centers of their parts around a node are nearer than this, in cells; 0:
    // wherever they approach, which is too early.
    double separation = 0.8;
};

class Meetings {
   public:
    Meetings(const ContactRule& rule, const std::vector<Grain>& grains,
             const std::vector<Bond>& bonds)
        : rule_(rule), bonds_of_(grains.size()) {
        for (std::size_t k = 0; k < bonds.size(); ++k) {
            const auto [low, high] = std::minmax(bonds[k].a, bonds[k].b);
            bonds_of_[static_cast<std::size_t>(low)].push_back({high, static_cast<int>(k)});
        }
        for (const Grain& grain : grains) is_rigid_.push_back(grain.rigid);
    }

    /// Calls visit(block, node) for every shared node where a pair is in contact or bonded; or only
    /// where one is bonded, with the bonded pairs alone.
    /// in:     block below common::block_count: several threads visit, but one block is one thread's
    ///         and in order; node, with the velocities of nodes.motion, for visit to change
    /// errors: NumericalError when too many grains are at a node; not for only the bonded ones
    template <class Visit>
    void for_each(const GrainNodes& nodes, const std::vector<Bond>& bonds, bool only_bonded,
                  const Visit& visit) const {
        std::array<bool, common::block_count> crowded{};
        common::for_each_block(nodes.shared_count(), [&](int block, long begin, long end) {
            detail::NodeProblem node;
            for (long n = begin; n < end; ++n) {
                if (!gather(n, nodes, node)) continue;
                if (node.parties == detail::NodeProblem::most_parties)
                    crowded[static_cast<std::size_t>(block)] = true;
                find_pairs(nodes.mesh().h, bonds, only_bonded, node);
                if (node.pairs == 0) continue;
                load_velocities(nodes, node);
                visit(block, node);
            }
        });
        const bool any = std::find(crowded.begin(), crowded.end(), true) != crowded.end();
        if (any && !only_bonded)
            throw common::NumericalError(
                "more than " + std::to_string(detail::NodeProblem::most_parties - 1) +
                " grains and walls meet at one node: refine the mesh, or use larger grains");
    }

   private:
    static constexpr long mesh_margin = 4;  // nodes beyond the mesh that grains may touch

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
                       nodes.sums[static_cast<std::size_t>(members[l].dof)].m > nodes.least_mass();
        if (present < 2) return false;
        double node_x = 0, node_y = 0;
        for (long l = begin; l < end; ++l) {
            const Member& member = members[l];
            if (node.parties == detail::NodeProblem::most_parties) break;
            detail::Party& party = node.party[node.parties];
            if (member.is_wall()) {
                if (node.parties == 0) return false;
                party = {};
                party.dof = -1, party.grain = member.grain, party.wall = true;
                party.x = member.x - node_x, party.y = member.y - node_y;
                ++node.parties;
                continue;
            }
            const auto dof = static_cast<std::size_t>(member.dof);
            const NodeSums& sum = nodes.sums[dof];
            if (!(sum.m > nodes.least_mass())) continue;
            const double per_m = 1 / sum.m;
            party.dof = member.dof, party.grain = member.grain, party.wall = false;
            party.rigid = is_rigid_[static_cast<std::size_t>(member.grain)];
            party.m = sum.m, party.per_mx = party.per_my = party.rigid ? 0 : per_m;
            party.x = sum.mx * per_m - member.x, party.y = sum.my * per_m - member.y;
            party.gx = sum.gx, party.gy = sum.gy;
            node_x = member.x, node_y = member.y;
            ++node.parties;
        }
        const Mesh& mesh = nodes.mesh();
        const long i = std::lround((node_x - mesh.x_low) / mesh.h),
                   j = std::lround((node_y - mesh.y_low) / mesh.h),
                   nx = mesh.cells_x + (mesh.periodic_x ? 0 : 2 * mesh_margin);
        node.key =
            (j + mesh_margin) * nx + (mesh.periodic_x ? ((i % nx) + nx) % nx : i + mesh_margin);
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
            __builtin_prefetch(&nodes.sums[static_cast<std::size_t>(member.dof)]);
            __builtin_prefetch(&nodes.motion[static_cast<std::size_t>(member.dof)], 1);
        }
    }

    // Velocities, and what walls forbid.
    static void load_velocities(const GrainNodes& nodes, detail::NodeProblem& node) {
        node.isotropic = true;
        for (std::size_t k = 0; k < node.parties; ++k) {
            detail::Party& party = node.party[k];
            if (party.wall) continue;
            const NodeMotion& v = nodes.motion[static_cast<std::size_t>(party.dof)];
            party.vx_0 = v.vx_0, party.vy_0 = v.vy_0, party.vx = v.vx_1, party.vy = v.vy_1;
            if (party.rigid) continue;
            if (nodes.is_fixed_x(party.dof)) party.per_mx = 0, node.isotropic = false;
            if (nodes.is_fixed_y(party.dof)) party.per_my = 0, node.isotropic = false;
        }
        detail::weigh_pairs(node);
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

    // Parts of a node's mass that are too small to turn a normal.
    static constexpr double low_mass = 1e-5;

    ContactRule rule_;
    std::vector<std::vector<std::pair<int, int>>> bonds_of_;
    std::vector<bool> is_rigid_;
};

}  // namespace mpm
