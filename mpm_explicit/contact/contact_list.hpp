// The contacts of one step: every node where bodies are in contact or bonded, kept from one
// solution of the contact problem to the next.
//
//     nodes    | body_begin ... body_end, pair_begin ... pair_end | the next node ... |
//     bodies   | of the first node | of the second ... |
//     pairs    | of the first node | of the second ... |
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "mpm_explicit/contact/detect_contact.hpp"

namespace mpm {

class ContactList {
   public:
    /// The bodies and pairs of one node, a range of those below.
    struct Node {
        std::size_t body_begin, body_end, pair_begin, pair_end;
        long key;  // number of the node on the mesh
    };
    std::vector<Node> nodes;
    std::vector<ContactBody> bodies;
    std::vector<ContactPair> pairs;

    /// Detects contact. visit(node), as in ContactDetection::for_each, may change a node before it
    /// is kept, and leave out pairs at its end; what is kept is what it leaves.
    template <class Visit>
    void find(const ContactDetection& detection, const GrainNodes& where,
              const std::vector<Bond>& bonds, const Visit& visit) {
        for (Block& block : blocks_) block.nodes.clear(), block.bodies.clear(), block.pairs.clear();
        detection.for_each(where, bonds, false, [&](int number, ContactNode& node) {
            visit(node);
            if (node.pairs.empty()) return;
            Block& block = blocks_[number];
            const std::size_t body = block.bodies.size(), pair = block.pairs.size();
            block.bodies.insert(block.bodies.end(), node.bodies.begin(), node.bodies.end());
            block.pairs.insert(block.pairs.end(), node.pairs.begin(), node.pairs.end());
            block.nodes.push_back({body, block.bodies.size(), pair, block.pairs.size(), node.key});
        });
        nodes.clear(), bodies.clear(), pairs.clear();
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const Block& block = blocks_[k];
            for (Node node : block.nodes) {
                node.body_begin += bodies.size(), node.body_end += bodies.size();
                node.pair_begin += pairs.size(), node.pair_end += pairs.size();
                nodes.push_back(node);
            }
            bodies.insert(bodies.end(), block.bodies.begin(), block.bodies.end());
            pairs.insert(pairs.end(), block.pairs.begin(), block.pairs.end());
            end_of_block_[k] = nodes.size();
        }
    }

    /// Calls visit(block, node, first) for a copy of every node, with the velocities of
    /// nodes.motion; first is the number of its first pair, block as in ContactDetection::for_each.
    template <class Visit>
    void for_each(const GrainNodes& where, const Visit& visit) const {
        common::for_each_row(common::block_count, [&](long number) {
            ContactStorage storage;
            for (std::size_t n = number == 0 ? 0 : end_of_block_[number - 1];
                 n < end_of_block_[number]; ++n) {
                ContactNode node = copy(nodes[n], storage);
                load_velocities(where, node);
                visit(static_cast<int>(number), node, nodes[n].pair_begin);
            }
        });
    }

    /// A copy of the bodies and pairs of a node.
    ContactNode copy(const Node& range, ContactStorage& storage) const {
        std::copy(bodies.begin() + range.body_begin, bodies.begin() + range.body_end,
                  storage.bodies.begin());
        std::copy(pairs.begin() + range.pair_begin, pairs.begin() + range.pair_end,
                  storage.pairs.begin());
        return {{storage.bodies.data(), range.body_end - range.body_begin},
                {storage.pairs.data(), range.pair_end - range.pair_begin},
                range.key};
    }

   private:
    struct Block {
        std::vector<Node> nodes;
        std::vector<ContactBody> bodies;
        std::vector<ContactPair> pairs;
    };
    std::array<Block, common::block_count> blocks_;
    std::array<std::size_t, common::block_count> end_of_block_{};  // in nodes
};

}  // namespace mpm
