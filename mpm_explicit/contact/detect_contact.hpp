// Contact detection: the bodies that meet at a grid node, and which pairs of them are in contact. [MPM-4]
//
// Every grain has a velocity of its own at a node. Two grains a and b, with the normal n from a to
// b, are in contact when their surfaces touch: fields share nodes already when more than a cell of
// nothing lies between them. Nodes at which a grain meets a rigid one or a wall, and nobody else, make
// contacts together (contact_columns.hpp); the others are each for themselves.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"
#include "mpm_explicit/contact/contact_columns.hpp"

namespace mpm {

class ContactDetection {
   public:
    ContactDetection(const ContactRule& rule, const std::vector<Grain>& grains,
                     const std::vector<Bond>& bonds)
        : bodies_(rule, grains, bonds) {}

    const ContactRule& rule() const { return bodies_.rule(); }

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
        const std::vector<GrainNodes::FixedNode>& fixed = nodes.fixed_nodes();
        const ContactColumns columns(bodies_, nodes, bonds, only_bonded);
        const std::size_t fixed_count = columns.empty() ? 0 : fixed.size();
        common::for_each_block(nodes.shared_count(), [&](int block, long begin, long end) {
            ContactStorage storage;
            std::vector<long> met;
            for (long n = begin; n < end; ++n)
                if (bodies_.meet_at(n, nodes)) met.push_back(n);
            std::size_t k = 0;  // of fixed nodes, where n is or would be
            while (k < fixed_count && fixed[k].shared < begin) ++k;
            for (std::size_t at = 0; at < met.size(); ++at) {
                const long n = met[at];
                ContactNode node;
                if (at + ahead < met.size()) fetch(met[at + ahead], nodes);
                while (k < fixed_count && fixed[k].shared < n) ++k;
                if (const auto f = static_cast<long>(k); k < fixed_count && fixed[k].shared == n) {
                    if (columns.is_inside(f)) continue;
                    if (columns.is_crossed(f)) {
                        SurfaceRun run = columns.contacts_at(static_cast<int>(f), storage);
                        for (; run.next(storage, node); visit(block, node))
                            load_velocities(nodes, node);
                        continue;
                    }
                }
                if (!bodies_.gather(n, nodes, storage, node)) continue;
                if (node.bodies.size() == ContactNode::max_bodies) crowded[block] = true;
                bodies_.find_pairs(nodes.mesh().h, bonds, only_bonded, true, storage, node);
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
            __builtin_prefetch(&nodes.surface[0][nodes.surface_of(member.dof)]);
        }
    }

    ContactBodies bodies_;
};

}  // namespace mpm
