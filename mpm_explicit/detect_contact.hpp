// Contact detection: the bodies that meet at a grid node, and which pairs of them are in contact. [MPM-4]
//
// Every grain has a velocity of its own at a node. Two grains a and b, with the normal n from a to
// b, are in contact when their surfaces touch: fields share nodes already when more than a cell of
// nothing lies between them. Nodes at which a grain meets a rigid one or a wall, and nobody else, make
// runs across the surface (surface_runs.hpp); the others are each for themselves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/run/parameters.hpp"
#include "mpm_explicit/contact_rule.hpp"
#include "mpm_explicit/contact_velocities.hpp"

namespace mpm {

class ContactDetection {
   public:
    ContactDetection(const ContactRule& rule, const std::vector<Grain>& grains,
                     const std::vector<Bond>& bonds)
        : rule_(rule), materials_(std::lround(std::sqrt(rule.between.size()))) {
        bonds_of_.resize(grains.size());
        for (std::size_t k = 0; k < bonds.size(); ++k) {
            const auto [low, high] = std::minmax(bonds[k].a, bonds[k].b);
            bonds_of_[low].push_back({high, static_cast<int>(k)});
        }
        for (const Grain& grain : grains) {
            is_rigid_.push_back(grain.rigid);
            material_.push_back(grain.material);
        }
    }

    const ContactRule& rule() const { return rule_; }

    /// Calls visit(block, node) for every shared node where a pair is in contact or bonded; or only
    /// where one is bonded, with the bonded pairs alone.
    /// in:     block below common::block_count: several threads visit, but one block is one
    ///         thread's and in order; node, with the velocities of nodes.motion, for visit to
    ///         change
    /// errors: NumericalError when too many bodies are at a node; not for only the bonded ones
    template <class Visit>
    void for_each(const GrainNodes& nodes, const std::vector<Bond>& bonds, bool only_bonded,
                  const Visit& visit) const {
        std::array<bool, common::block_count> crowded{};
        const double h = nodes.mesh().h;
        const std::vector<GrainNodes::FixedNode>& fixed = nodes.fixed_nodes();
        std::vector<Meeting> meetings(only_bonded ? 0 : fixed.size());
        const auto meet = [&](int, long begin, long end) {
            ContactStorage storage;
            for (long k = begin; k < end; ++k) {
                ContactNode node;
                const long n = fixed[k].shared;
                if (!meet_at(n, nodes) || !gather_bodies(n, nodes, storage, node)) continue;
                if (node.bodies.size() != 2) continue;
                if (!node.bodies[0].is_fixed() && !node.bodies[1].is_fixed()) continue;
                find_pairs(h, bonds, false, false, storage, node);
                if (node.pairs.empty() || node.pairs[0].bond < 0) meetings[k] = meeting_of(node, h);
            }
        };
        common::for_each_block(static_cast<long>(meetings.size()), meet);
        common::for_each_block(nodes.shared_count(), [&](int block, long begin, long end) {
            ContactStorage storage;
            std::vector<long> met;
            for (long n = begin; n < end; ++n)
                if (meet_at(n, nodes)) met.push_back(n);
            std::size_t k = 0;  // of fixed nodes, where n is or would be
            while (k < meetings.size() && fixed[k].shared < begin) ++k;
            for (std::size_t at = 0; at < met.size(); ++at) {
                const long n = met[at];
                ContactNode node;
                if (at + ahead < met.size()) fetch(met[at + ahead], nodes);
                while (k < meetings.size() && fixed[k].shared < n) ++k;
                const Meeting::Axis run_along =
                    k < meetings.size() && fixed[k].shared == n ? meetings[k].axis : Meeting::none;
                if (run_along == Meeting::inside) continue;
                if (run_along != Meeting::none) {
                    SurfaceRun run;
                    gather_run(static_cast<long>(k), nodes, bonds, meetings, storage, run);
                    for (; run.next(storage, node); visit(block, node))
                        load_velocities(nodes, node);
                    continue;
                }
                if (!gather_bodies(n, nodes, storage, node)) continue;
                if (node.bodies.size() == ContactNode::max_bodies) crowded[block] = true;
                find_pairs(h, bonds, only_bonded, true, storage, node);
                if (node.pairs.empty()) continue;
                load_velocities(nodes, node);
                visit(block, node);
            }
        });
        const bool any = std::find(crowded.begin(), crowded.end(), true) != crowded.end();
        if (any && !only_bonded)
            throw common::NumericalError(
                "more than " + std::to_string(ContactNode::max_bodies - 1) +
                " grains and walls meet at one node: refine the mesh, or use larger grains");
    }

   private:
    static constexpr long mesh_margin = 4;  // nodes beyond the mesh that grains may touch

    // Whether two bodies have mass at shared node n: most shared nodes have mass of one grain only.
    static bool meet_at(long n, const GrainNodes& nodes) {
        const Member* const members = nodes.members().data();
        int present = 0;
        for (long l = nodes.shared_begin()[n]; l < nodes.shared_begin()[n + 1]; ++l)
            present += members[l].is_wall() || nodes.mass[members[l].dof] > nodes.least_mass();
        return present > 1;
    }

    // All bodies with mass at shared node n. out: whether there are at least two, not all walls
    bool gather_bodies(long n, const GrainNodes& nodes, ContactStorage& storage,
                       ContactNode& node) const {
        const Member* const members = nodes.members().data();
        const long begin = nodes.shared_begin()[n], end = nodes.shared_begin()[n + 1];
        double node_x = 0, node_y = 0;
        bool fixed_x = false, fixed_y = false;
        std::size_t count = 0;
        for (long l = begin; l < end && count < ContactNode::max_bodies; ++l) {
            const Member& member = members[l];
            ContactBody& body = storage.bodies[count];
            if (member.is_wall()) {
                if (count == 0) return false;
                body = {};
                body.dof = -1, body.grain = member.grain, body.wall = true;
                body.x = member.x - node_x, body.y = member.y - node_y;
                ++count;
                continue;
            }
            const NodeSums& sum = nodes.sums[member.dof];
            if (!(sum.m > nodes.least_mass())) continue;
            const double per_m = 1 / sum.m;
            body.dof = member.dof, body.grain = member.grain, body.wall = false;
            body.rigid = is_rigid_[member.grain];
            body.m = sum.m, body.per_mx = body.per_my = body.rigid ? 0 : per_m;
            body.x = sum.mx * per_m - member.x, body.y = sum.my * per_m - member.y;
            body.gx = sum.gx, body.gy = sum.gy;
            fixed_x = fixed_x || nodes.is_fixed_x(member.dof);
            fixed_y = fixed_y || nodes.is_fixed_y(member.dof);
            body.vx_0 = nodes.motion[member.dof].vx_0, body.vy_0 = nodes.motion[member.dof].vy_0;
            body.surface = moved(nodes.surface[l], -member.x, -member.y);
            node_x = member.x, node_y = member.y;
            ++count;
        }
        node.bodies = {storage.bodies.data(), count};
        // On a wall that holds nodes, what is beyond it takes the gradient across it away.
        for (ContactBody& body : node.bodies) {
            if (fixed_x) body.gx = 0;
            if (fixed_y) body.gy = 0;
        }
        const Mesh& mesh = nodes.mesh();
        const long i = std::lround((node_x - mesh.x_low) / mesh.h),
                   j = std::lround((node_y - mesh.y_low) / mesh.h),
                   nx = mesh.cells_x + (mesh.periodic_x ? 0 : 2 * mesh_margin);
        node.key =
            (j + mesh_margin) * nx + (mesh.periodic_x ? ((i % nx) + nx) % nx : i + mesh_margin);
        return count > 1;
    }

    // The run that begins at fixed node n: empty where none does, or its surfaces do not touch.
    void gather_run(long n, const GrainNodes& nodes, const std::vector<Bond>& bonds,
                    const std::vector<Meeting>& meetings, ContactStorage& storage,
                    SurfaceRun& run) const {
        RunTable(nodes, meetings).for_each_node(n, [&](long at) {
            ContactNode one;
            gather_bodies(at, nodes, storage, one);
            find_pairs(nodes.mesh().h, bonds, false, false, storage, one);
            run.add(one, meetings[n].axis, nodes.mesh().h);
        });
        if (run.empty()) return;
        run.close([&](const ContactBody& a, const ContactBody& b, const ContactPair& pair) {
            return touch(rule_, a, b, pair, nodes.mesh().h);
        });
    }

    // Shared nodes are far apart in memory: they are fetched so many nodes before their turn.
    // Contact of a million particles in 2000 grains takes a quarter less time with it. Without inlining
    // GCC leaves out the calls: the function does nothing that it can see.
    static constexpr std::size_t ahead = 16;
    [[gnu::always_inline]] static void fetch(long n, const GrainNodes& nodes) {
        for (long l = nodes.shared_begin()[n]; l < nodes.shared_begin()[n + 1]; ++l) {
            const Member& member = nodes.members()[l];
            if (member.is_wall()) continue;
            __builtin_prefetch(&nodes.sums[member.dof]);
            __builtin_prefetch(&nodes.motion[member.dof], 1);
        }
    }

    // All pairs, those that are in contact, or only those that are bonded.
    void find_pairs(double h, const std::vector<Bond>& bonds, bool only_bonded, bool only_touching,
                    ContactStorage& storage, ContactNode& node) const {
        std::size_t count = 0;
        for (std::size_t b = 1; b < node.bodies.size(); ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                const ContactBody &one = node.bodies[a], &two = node.bodies[b];
                if (one.is_fixed() && two.is_fixed()) continue;
                const int bond = bonds.empty() || two.wall ? -1 : bond_of(bonds, one, two);
                if (only_bonded && bond < 0) continue;
                const bool free = !one.is_fixed() && !two.is_fixed();
                // A bond holds however little of a grain is here.
                const bool light = std::min(one.m, two.m) < low_mass * (one.m + two.m);
                if (free && bond < 0 && light) continue;
                ContactPair& pair = storage.pairs[count];
                const double least = bond < 0 ? 1e-6 * h : 0;
                if (!normal_between(one, two, least, pair.nx, pair.ny)) continue;
                if (bond < 0 && only_touching && !touch(rule_, one, two, pair, h)) continue;
                pair.a = a, pair.b = b, pair.bond = bond;
                pair.links[0] = {static_cast<int>(a), static_cast<int>(b), 1}, pair.link_count = 1;
                pair.mu =
                    two.wall ? rule_.wall_friction
                    : rule_.between.empty()
                        ? rule_.friction
                        : rule_.between[material_[one.grain] * materials_ + material_[two.grain]];
                pair.lambda_n = pair.lambda_t = pair.old_n = pair.old_t = 0;
                pair.state = ContactState::open, pair.held_n = pair.held_t = bond >= 0;
                ++count;
            }
        }
        node.pairs = {storage.pairs.data(), count};
    }

    int bond_of(const std::vector<Bond>& bonds, const ContactBody& one,
                const ContactBody& two) const {
        for (const auto& [other, number] : bonds_of_[one.grain])
            if (other == two.grain && !bonds[number].broken) return number;
        return -1;
    }

    // Parts of a node's mass that are too small to turn a normal.
    static constexpr double low_mass = 1e-5;

    ContactRule rule_;
    long materials_;
    std::vector<std::vector<std::pair<int, int>>> bonds_of_;
    std::vector<bool> is_rigid_;
    std::vector<int> material_;
};

}  // namespace mpm
