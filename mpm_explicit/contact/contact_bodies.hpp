// The bodies that meet at a grid node, and the pairs of them.                                  [MPM-4]
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mpm_explicit/contact/contact_rule.hpp"
#include "mpm_explicit/contact/contact_velocities.hpp"

namespace mpm {

/// The bodies that have mass at a node, with their velocities and surfaces there, and the normals of their pairs.
class ContactBodies {
   public:
    ContactBodies(const ContactRule& rule, const std::vector<Grain>& grains,
                  const std::vector<Bond>& bonds)
        : rule_(rule), materials_(std::lround(std::sqrt(rule.between.size()))) {
        bonds_of_.resize(grains.size());
        for (std::size_t k = 0; k < bonds.size(); ++k) {
            const auto [low, high] = std::minmax(bonds[k].a, bonds[k].b);
            bonds_of_[low].push_back({high, static_cast<int>(k)});
        }
        for (const Grain& grain : grains) {
            is_rigid_.push_back(grain.rigid);
            material_.push_back(grain.material), has_corners_.push_back(grain.has_corners);
        }
    }

    const ContactRule& rule() const { return rule_; }

    /// Whether two bodies have mass at shared node n: most shared nodes have mass of one grain only.
    static bool meet_at(long n, const GrainNodes& nodes) {
        const Member* const members = nodes.members().data();
        int present = 0;
        for (long l = nodes.shared_begin()[n]; l < nodes.shared_begin()[n + 1]; ++l)
            present += members[l].is_wall() || nodes.mass[members[l].dof] > nodes.least_mass();
        return present > 1;
    }

    /// All bodies with mass at shared node n. out: whether there are at least two, not all walls
    bool gather(long n, const GrainNodes& nodes, ContactStorage& storage, ContactNode& node) const {
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
            body.rigid = is_rigid_[member.grain], body.has_corners = has_corners_[member.grain];
            body.m = sum.m, body.per_mx = body.per_my = body.rigid ? 0 : per_m;
            body.x = sum.mx * per_m - member.x, body.y = sum.my * per_m - member.y;
            body.gx = sum.gx, body.gy = sum.gy;
            fixed_x = fixed_x || nodes.is_fixed_x(member.dof);
            fixed_y = fixed_y || nodes.is_fixed_y(member.dof);
            body.vx_0 = nodes.motion[member.dof].vx_0, body.vy_0 = nodes.motion[member.dof].vy_0;
            const int at = nodes.surface_of(member.dof);
            const auto& [one, two] = nodes.surface;
            body.surface = {moved(one[at], -member.x, -member.y),
                            two.empty() ? SideSums{} : moved(two[at], -member.x, -member.y)};
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
                   j = std::lround((node_y - mesh.y_low) / mesh.h), margin = GrainNodes::margin,
                   nx = mesh.cells_x + (mesh.periodic_x ? 0 : 2 * margin);
        node.key = (j + margin) * nx + (mesh.periodic_x ? ((i % nx) + nx) % nx : i + margin);
        return count > 1;
    }

    /// All pairs, those that are in contact, or only those that are bonded.
    void find_pairs(double h, const std::vector<Bond>& bonds, bool only_bonded, bool only_touching,
                    ContactStorage& storage, ContactNode& node) const {
        const auto rigid_count = std::count_if(node.bodies.begin(), node.bodies.end(),
                                               [](const ContactBody& body) { return body.rigid; });
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
                // Rigid bodies that abut are one, and their ends no surface.
                if (rigid_count > 1 && !two.wall && !free)
                    take_facing_side(one, two, pair.nx, pair.ny);
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

   private:
    int bond_of(const std::vector<Bond>& bonds, const ContactBody& one,
                const ContactBody& two) const {
        for (const auto& [other, number] : bonds_of_[one.grain])
            if (other == two.grain && !bonds[number].broken) return number;
        return -1;
    }

    // Of two free bodies: the smallest part of their mass at a node with which one of them has contact.
    static constexpr double low_mass = 1e-5;

    ContactRule rule_;
    long materials_;
    std::vector<std::vector<std::pair<int, int>>> bonds_of_;
    std::vector<bool> is_rigid_, has_corners_;
    std::vector<int> material_;
};

}  // namespace mpm
