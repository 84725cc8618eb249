// Which pairs of grains press, stick or slip at which nodes: the active set of the contact problem.
//
// Contact acts on v^theta, as the slide's f_i^theta asks. A pair a, b with the normal n from a to b is
//     open    no impulse;                      asked for:  (v_b - v_a).n >= 0
//     slip    (v_b - v_a).n = 0;               asked for:  lambda >= 0, |lambda_t| = mu lambda
//             against the motion
//     stick   v_a = v_b;                       asked for:  lambda >= 0, |lambda_t| <= mu lambda
// With a set chosen, v^theta follows from a linear system; where it does not give what is asked for,
// the set is changed and the system solved again. Sets that would follow each other in a circle are
// broken up: a pair that comes back only slips, and it may open twice and change between stick and
// slip three times in a step. A pair that may no longer change stays as it is, and is counted.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/contact.hpp"
#include "mpm_implicit/state.hpp"

namespace mpm_implicit {

using namespace mpm;

enum class Hold : int { open, slip, stick };

/// One grain, rigid grain or wall at a node where grains meet.
struct Meeter {
    long dof;                      // -1: a wall
    int grain;                     // a wall: -1 - its side
    bool fixed;                    // its velocity is given
    double vx, vy;                 // then: the velocity
    int force_control = -1;        // a rigid grain that a force drives: its number ...
    bool control_along_x = false;  // ... and direction; the velocity in that direction is not given
};

/// Grains have numbers from 0, walls from -1 down.
inline int number_of(const detail::Party& party) {
    return party.wall ? -1 - party.grain : party.grain;
}

/// Two of them. Impulses are those on v^theta: theta times what particles feel.
struct MeetingPair {
    std::size_t a, b;  // of the node's meeters
    int bond;
    double nx, ny, mu;
    Hold hold = Hold::open;
    double lambda_n = 0, lambda_t = 0;  // on b; along (nx, ny) and (-ny, nx)
    double friction = 0;                // lambda_t that the next solution is to have, if it slips
    double target = 0;                  // what friction ought to be by this solution
    double x_before = 0, target_before = 0;  // lambda_t and target of the solution before
    int releases = 0, switches = 0;
    bool closed() const { return hold != Hold::open; }
    double tx() const { return -ny; }
    double ty() const { return nx; }
};

struct MeetingNode {
    std::size_t meeter_begin, meeter_end, pair_begin, pair_end;
    long key;  // of the node on the mesh
};

class ContactSet {
   public:
    std::vector<MeetingNode> nodes;
    std::vector<Meeter> meeters;
    std::vector<MeetingPair> pairs;
    bool same_before = false;  // the last two solutions had the same set
    std::array<std::size_t, common::block_count> first_pair;  // of each block of meetings

    /// Finds everybody who meets, and guesses who presses: those who did in the last step, and those
    /// who approach.
    /// in:     where, with v_0 to judge approach by; memory, sorted
    void find(const Contact& contact, const GrainNodes& where, const std::vector<Bond>& bonds,
              const std::vector<RigidMotion>& rigid,
              const std::vector<ForceControl>& force_controls,
              const std::vector<PairMemory>& memory) {
        struct Block {
            std::vector<MeetingNode> nodes;
            std::vector<Meeter> meeters;
            std::vector<MeetingPair> pairs;
        };
        std::array<Block, common::block_count> blocks;
        contact.meetings().for_each(where, bonds, false, [&](int number, auto& node) {
            Block& block = blocks[static_cast<std::size_t>(number)];
            MeetingNode here{block.meeters.size(), 0, block.pairs.size(), 0, node.key};
            for (std::size_t k = 0; k < node.parties; ++k) {
                const detail::Party& party = node.party[k];
                Meeter meeter{party.dof, number_of(party), party.is_fixed(), 0, 0};
                if (party.rigid) {
                    const auto g = static_cast<std::size_t>(party.grain);
                    meeter.vx = rigid[g].vx, meeter.vy = rigid[g].vy;
                    for (std::size_t s = 0; s < force_controls.size(); ++s) {
                        if (force_controls[s].grain != g) continue;
                        meeter.force_control = static_cast<int>(s);
                        meeter.control_along_x = force_controls[s].along_x;
                    }
                }
                block.meeters.push_back(meeter);
            }
            for (std::size_t k = 0; k < node.pairs; ++k) {
                const detail::Pair& pair = node.pair[k];
                MeetingPair meet{pair.a, pair.b, pair.bond, pair.nx, pair.ny, pair.mu};
                const detail::Party &a = node.party[pair.a], &b = node.party[pair.b];
                const auto before = [](const detail::Party& p, const Meeter& is, double& x,
                                       double& y) {
                    x = p.is_fixed() ? is.vx : p.vx_0, y = p.is_fixed() ? is.vy : p.vy_0;
                };
                double ax, ay, bx, by;
                before(a, block.meeters[here.meeter_begin + pair.a], ax, ay);
                before(b, block.meeters[here.meeter_begin + pair.b], bx, by);
                const PairMemory like{here.key, number_of(a), number_of(b), 0, 0};
                const auto last = std::lower_bound(memory.begin(), memory.end(), like);
                if (pair.bond >= 0) {
                    meet.hold = Hold::stick;
                } else if (last != memory.end() && !(like < *last)) {
                    meet.hold = static_cast<Hold>(last->hold);
                    meet.friction = meet.hold == Hold::slip ? last->lambda_t : 0;
                } else if ((bx - ax) * pair.nx + (by - ay) * pair.ny < 0) {
                    meet.hold = pair.mu > 0 ? Hold::stick : Hold::slip;
                }
                block.pairs.push_back(meet);
            }
            here.meeter_end = block.meeters.size(), here.pair_end = block.pairs.size();
            block.nodes.push_back(here);
        });
        same_before = false;
        nodes.clear(), meeters.clear(), pairs.clear();
        for (std::size_t k = 0; k < blocks.size(); ++k) {
            const Block& block = blocks[k];
            first_pair[k] = pairs.size();
            for (MeetingNode node : block.nodes) {
                node.meeter_begin += meeters.size(), node.meeter_end += meeters.size();
                node.pair_begin += pairs.size(), node.pair_end += pairs.size();
                nodes.push_back(node);
            }
            meeters.insert(meeters.end(), block.meeters.begin(), block.meeters.end());
            pairs.insert(pairs.end(), block.pairs.begin(), block.pairs.end());
        }
    }

    /// What contact has done, by the impulses of the set.
    /// in:     nodes.motion, v^theta in the place of v_1
    /// out:    bonds, their stresses and whether they break; rigid, the force on each rigid grain
    ContactSums account(const Contact& contact, double theta, double dt, GrainNodes& where,
                        std::vector<Bond>& bonds, std::vector<RigidMotion>& rigid) const {
        std::array<std::size_t, common::block_count> next = first_pair;
        return contact.apply(dt, where, bonds, rigid, {0, 1 / theta}, [&](int block, auto& node) {
            for (std::size_t k = 0; k < node.pairs; ++k) {
                const MeetingPair& pair = pairs[next[static_cast<std::size_t>(block)]++];
                node.pair[k].lambda_n = pair.lambda_n, node.pair[k].lambda_t = pair.lambda_t;
            }
        });
    }

    /// Who a pair is, for a message.
    std::string names(std::size_t pair, const std::vector<Grain>& grains) const {
        for (const MeetingNode& node : nodes) {
            if (pair < node.pair_begin || pair >= node.pair_end) continue;
            const auto name = [&](std::size_t k) {
                const Meeter& is = meeters[node.meeter_begin + k];
                return is.dof < 0
                           ? std::string("a wall")
                           : "grain '" + grains[static_cast<std::size_t>(is.grain)].name + "'";
            };
            return name(pairs[pair].a) + " and " + name(pairs[pair].b);
        }
        return "no grains";
    }

    /// What to begin the next step with.
    std::vector<PairMemory> memory() const {
        std::vector<PairMemory> kept;
        for (const MeetingNode& node : nodes)
            for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
                const MeetingPair& pair = pairs[k];
                if (pair.bond >= 0 || !pair.closed()) continue;
                kept.push_back({node.key, meeters[node.meeter_begin + pair.a].grain,
                                meeters[node.meeter_begin + pair.b].grain,
                                static_cast<int>(pair.hold), pair.lambda_t});
            }
        std::sort(kept.begin(), kept.end());
        return kept;
    }
};

}  // namespace mpm_implicit
