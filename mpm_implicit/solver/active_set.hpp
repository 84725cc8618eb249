// The active set of the contact problem: which pairs of bodies press, stick or slip at which nodes.
//
// Contact acts on v^theta, as the slide's f_i^theta asks. A pair a, b with the normal n from a to b
// is
//     open    no impulse;                      asked for:  (v_b - v_a).n >= 0
//     slip    (v_b - v_a).n = 0;               asked for:  lambda >= 0, |lambda_t| = mu lambda
//             against the motion
//     stick   v_a = v_b;                       asked for:  lambda >= 0, |lambda_t| <= mu lambda
// With a set chosen, v^theta follows from a linear system; where it does not give what is asked
// for, update_active_set.hpp changes the set, and the system is solved again.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "common/least_squares.hpp"
#include "mpm_explicit/contact.hpp"
#include "mpm_implicit/apply_loads.hpp"
#include "mpm_implicit/solver/ghost_vectors.hpp"
#include "mpm_implicit/state.hpp"

namespace mpm_implicit {

using namespace mpm;

/// What the active-set iteration keeps of a pair between two solutions.
struct PairUpdate {
    double friction = 0;  // lambda_t that the next solution is to have, if the pair slips
    double target = 0;    // what friction ought to be by this solution
    int changes = 0;      // of the state, in this step
};

/// Impulses of the pairs are those on v^theta: theta times what particles feel.
class ActiveSet {
   public:
    ContactList list;
    std::vector<PairUpdate> updates;           // one per pair
    common::AndersonAcceleration of_friction;  // since the set last changed

    /// Detects contact, and guesses the set: the states of the last step, and pairs that approach.
    /// in:     where, with v_0 to judge approach by; last, the closed pairs of the last step,
    ///         sorted
    void find(const Contact& contact, const GrainNodes& where, const std::vector<Bond>& bonds,
              const std::vector<ForceControl>& controls, const std::vector<ActivePair>& last) {
        list.find(contact.detection(), where, bonds, [](ContactNode&) {});
        of_friction = {};
        updates.clear();
        ContactStorage storage;
        for (const ContactList::Node& range : list.nodes) {
            const ContactNode node = list.copy(range, storage);
            for (std::size_t k = range.pair_begin; k < range.pair_end; ++k)
                updates.push_back(guess_state(node, last, list.pairs[k]));
        }
        for (ContactBody& body : list.bodies) {
            if (!body.rigid) continue;
            for (std::size_t s = 0; s < controls.size(); ++s) {
                if (controls[s].grain != static_cast<std::size_t>(body.grain)) continue;
                body.force_control = static_cast<int>(s),
                body.control_along_x = controls[s].along_x;
            }
        }
    }

    /// What contact has done, by the impulses of the set.
    /// in:     nodes.motion, v^theta in the place of v_1
    /// out:    bonds, their stresses and whether they break; rigid, the force on each rigid grain
    ContactSums account(const Contact& contact, double theta, double dt, const GrainNodes& where,
                        std::vector<Bond>& bonds, std::vector<RigidMotion>& rigid) const {
        ContactTally sums = contact.tally({0, 1 / theta});
        list.for_each(where,
                      [&](int block, ContactNode& node, std::size_t) { sums.add(block, node); });
        return sums.finish(dt, bonds, rigid);
    }

    /// The bodies of a pair, for a message.
    std::string names(std::size_t pair, const std::vector<Grain>& grains) const {
        for (const ContactList::Node& node : list.nodes) {
            if (pair < node.pair_begin || pair >= node.pair_end) continue;
            const auto name = [&](std::size_t k) {
                const ContactBody& body = list.bodies[node.body_begin + k];
                return body.wall ? std::string("a wall")
                                 : "grain '" + grains[body.grain].name + "'";
            };
            return name(list.pairs[pair].a) + " and " + name(list.pairs[pair].b);
        }
        return "no grains";
    }

    /// The bodies of the pair that is pressed hardest, for a message.
    std::string hardest_pressed(const std::vector<Grain>& grains) const {
        if (list.pairs.empty()) return "";
        const auto hardest = std::max_element(
            list.pairs.begin(), list.pairs.end(),
            [](const ContactPair& a, const ContactPair& b) { return a.lambda_n < b.lambda_n; });
        return "hardest pressed are " + names(hardest - list.pairs.begin(), grains) + ": ";
    }

    /// What to change where the iterations do not get there, for a message.
    std::string advice() const {
        double mu = 0;
        for (const ContactPair& pair : list.pairs) mu = std::max(mu, pair.mu);
        return std::string("reduce time.alpha, or raise solver.max_outer_iterations") +
               (mu > 2 ? ", or take less friction: above 2 a grain can wedge itself, and no set of "
                         "pairs that stick and slip may be found"
                       : "");
    }

    /// The closed pairs, sorted, for the guess of the next step.
    std::vector<ActivePair> active_pairs() const {
        std::vector<ActivePair> kept;
        for (const ContactList::Node& node : list.nodes)
            for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
                const ContactPair& pair = list.pairs[k];
                if (pair.bond >= 0 || !pair.closed()) continue;
                kept.push_back({node.key, list.bodies[node.body_begin + pair.a].id(),
                                list.bodies[node.body_begin + pair.b].id(),
                                static_cast<int>(pair.state), pair.lambda_t});
            }
        std::sort(kept.begin(), kept.end());
        return kept;
    }

   private:
    static double parting(const ContactNode& node, const ContactPair& pair) {
        double sum = 0;
        for (const ContactLink& link : pair.all_links()) {
            const ContactBody &a = node.bodies[link.a], &b = node.bodies[link.b];
            sum += link.weight * ((b.vx_0 - a.vx_0) * pair.nx + (b.vy_0 - a.vy_0) * pair.ny);
        }
        return sum;
    }
    static PairUpdate guess_state(const ContactNode& node, const std::vector<ActivePair>& last,
                                  ContactPair& pair) {
        PairUpdate update;
        pair.state = ContactState::open;
        const ActivePair like{node.key, node.bodies[pair.a].id(), node.bodies[pair.b].id(), 0, 0};
        const auto same = std::lower_bound(last.begin(), last.end(), like);
        if (pair.bond >= 0) {
            pair.state = ContactState::stick;
        } else if (same != last.end() && !(like < *same)) {
            pair.state = static_cast<ContactState>(same->state);
            update.friction = pair.state == ContactState::slip ? same->lambda_t : 0;
        } else if (parting(node, pair) < 0) {
            pair.state = pair.mu > 0 ? ContactState::stick : ContactState::slip;
        }
        return update;
    }
};

}  // namespace mpm_implicit
