// Contact at a rigid surface, and not at every node beside it.
//
//     o  j + 1  a rigid grain     Both bodies have mass at j and at j + 1. Were the grain held at both,
//     |         or a wall         all of it between them would be rigid, however far from the surface.
//     |-----------  surface       The nodes that follow each other across the surface make one contact,
//     o  j      a grain           a run, in which node k has the weight of its area,
//                                     w_k = g_k.n / sum of the run,  g = sum_p V_p grad S_ip
//     sum_k w_k (v_b - v_a)_k.n >= 0,   impulse w_k lambda n on node k
// Gradients of volume are what an even stress acts with on its nodes: with these weights it is in
// equilibrium with an even pressure, to round-off, wherever in the cell the surface is. Two grains
// that can both be strained have one velocity at each node that they press at: together they are
// strained as one body would be, and nothing between the nodes is rigid.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mpm_explicit/contact/run_table.hpp"

namespace mpm {

/// The nodes of a run, put together one after the other, and the contacts that they make.
class SurfaceRun {
   public:
    bool empty() const { return links_ == 0; }

    /// in:     node, with the two bodies, and their pair where it has a normal
    void add(const ContactNode& node, Meeting::Axis axis, double h) {
        const std::size_t k = links_++, at = 2 * k;
        bodies_[at] = node.bodies[0], bodies_[at + 1] = node.bodies[1];
        keys_[k] = node.key;
        if (!node.pairs.empty()) pair_ = node.pairs[0];
        if (!bodies_[at + 1].wall) {
            const auto area = area_between(bodies_[at], bodies_[at + 1]),
                       gradient = gradient_between(bodies_[at], bodies_[at + 1]);
            for (const std::size_t c : {0, 1}) area_[c] += area[c], gradient_[c] += gradient[c];
        }
        // Moments about the first node.
        const double away = static_cast<double>(nodes_++) * h,
                     dx = axis == Meeting::along_x ? away : 0,
                     dy = axis == Meeting::along_x ? 0 : away;
        for (const std::size_t who : {0, 1}) {
            if (k == 0) seen_[who] = bodies_[who];
            if (k == 0 || seen_[who].wall) continue;
            seen_[who].surface += moved(bodies_[at + who].surface, dx, dy);
        }
    }

    std::size_t size() const { return links_; }
    /// The body at a node of the run that is not fixed; where both are, the first.
    const ContactBody& free_body(std::size_t k) const {
        return bodies_[2 * k + (bodies_[2 * k].is_fixed() && !bodies_[2 * k + 1].is_fixed())];
    }

    /// Takes in the node that shows, with node k of the run, what one on their line does that is held to both:
    /// what the surface presses there, it pulls by at the node beyond, also where that is of the run.
    /// in:     beyond, its body
    void add_beyond(std::size_t k, const ContactBody& beyond) {
        if (links_ == RunTable::longest) return;
        const std::size_t at = 2 * links_, free = bodies_[2 * k].is_fixed() ? 1 : 0;
        bodies_[at + free] = beyond, bodies_[at + 1 - free] = bodies_[2 * k + 1 - free];
        keys_[links_] = keys_[k], may_pull_[links_] = true, ++links_;
    }
    bool let_pull(long dof) {
        for (std::size_t k = 0; k < links_; ++k)
            if (free_body(k).dof == dof) return may_pull_[k] = true;
        return false;
    }

    /// The weights of its nodes. out: whether it has any, and so makes a contact
    bool weigh() {
        if (empty()) return false;
        if (!bodies_[1].wall) {
            if (gradient_ == std::array{0.0, 0.0}) return false;
            along_area_or_gradient(area_, gradient_, pair_.nx, pair_.ny);
        }
        double sum = 0, heaviest = 0;
        for (std::size_t k = 0; k < links_; ++k) {
            // By the free body: what a fixed one feels moves nothing.
            const ContactBody &a = bodies_[2 * k], &b = bodies_[2 * k + 1];
            const double along = area(a) - area(b);
            weight_[k] = may_pull_[k] ? along : std::max(0.0, along), sum += weight_[k];
            heaviest = std::max(heaviest, free_mass(k));
        }
        if (!(sum > 0)) return false;
        for (std::size_t k = 0; k < links_; ++k)
            weight_[k] /= sum, is_light_[k] = free_mass(k) < light * heaviest;
        for (const std::size_t who : {0, 1}) {
            if (seen_[who].wall) continue;
            seen_[who].vx_0 = seen_[who].vy_0 = 0;
            for (std::size_t k = 0; k < links_; ++k) {
                const ContactBody& body = bodies_[2 * k + who];
                seen_[who].vx_0 += weight_[k] * body.vx_0,
                    seen_[who].vy_0 += weight_[k] * body.vy_0;
            }
        }
        left_ = 1 + links_;
        return true;
    }

    /// The two bodies as all nodes of the run see them, and their normal.
    const ContactBody& seen(std::size_t who) const { return seen_[who]; }
    const ContactPair& pair() const { return pair_; }

    /// Makes one contact of this run and of that in the next column, at a point between them.
    /// in:     part, the share of the next one
    void join(const SurfaceRun& next, double part) {
        for (std::size_t k = 0; k < links_; ++k) weight_[k] *= 1 - part;
        for (std::size_t k = 0; k < next.links_; ++k, ++links_) {
            bodies_[2 * links_] = next.bodies_[2 * k],
                        bodies_[2 * links_ + 1] = next.bodies_[2 * k + 1];
            keys_[links_] = next.keys_[k], weight_[links_] = part * next.weight_[k];
            is_light_[links_] = next.is_light_[k];
        }
        left_ = 1 + links_;
    }

    /// The next contact of the run: all heavy nodes together, then each light one by itself.
    /// out:    node, in the storage's bodies and pairs; false when there is none left
    template <class Storage>
    bool next(Storage& storage, ContactNode& node) {
        while (left_ > 0) {
            const std::size_t turn = links_ + 1 - left_--;
            const bool alone = turn > 0;
            if (alone && !is_light_[turn - 1]) continue;
            ContactPair& pair = storage.pairs[0] = pair_;
            pair.link_count = 0;
            double sum = 0;
            for (std::size_t k = 0; k < links_; ++k) {
                if (alone ? k + 1 != turn : is_light_[k]) continue;
                const int at = static_cast<int>(2 * pair.link_count);
                storage.bodies[at] = bodies_[2 * k], storage.bodies[at + 1] = bodies_[2 * k + 1];
                if (at == 0) node.key = keys_[k];
                pair.links[pair.link_count++] = {at, at + 1, alone ? 1 : weight_[k]};
                sum += alone ? 1 : weight_[k];
            }
            if (!(sum > 0)) continue;
            for (std::size_t k = 0; k < pair.link_count; ++k) pair.links[k].weight /= sum;
            pair.a = 0, pair.b = 1;
            node.bodies = {storage.bodies.data(), 2 * pair.link_count};
            node.pairs = {storage.pairs.data(), 1};
            return true;
        }
        return false;
    }

   private:
    // Mass at a node, over that of the heaviest of its run, below which any step is too long: particles
    // that have just crossed have stress, and nearly no mass to work on. A larger part would make
    // layers rigid that slivers of a grain have beyond a line of nodes.
    static constexpr double light = 1.0 / 4096;

    double area(const ContactBody& body) const {
        return body.is_fixed() ? 0 : body.gx * pair_.nx + body.gy * pair_.ny;
    }
    double free_mass(std::size_t k) const {
        return bodies_[bodies_[2 * k].is_fixed() ? 2 * k + 1 : 2 * k].m;
    }

    ContactPair pair_{};
    std::size_t links_ = 0, left_ = 0;  // left_, turns of next()
    std::size_t nodes_ = 0;             // that follow each other across the surface
    std::array<ContactBody, 2 * ContactPair::max_links> bodies_;
    std::array<long, ContactPair::max_links> keys_{};
    std::array<double, ContactPair::max_links> weight_{};
    std::array<bool, ContactPair::max_links> is_light_{}, may_pull_{};
    std::array<ContactBody, 2> seen_;            // the two, with the surfaces that all nodes see
    std::array<double, 2> area_{}, gradient_{};  // that n is along
};

}  // namespace mpm
