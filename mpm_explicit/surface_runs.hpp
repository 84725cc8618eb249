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
#include <limits>

#include "mpm_explicit/grain_nodes.hpp"
#include "mpm_explicit/solve_contact_node.hpp"

namespace mpm {

/// Whether a body shows an outline at a node; clouds of particles without one do not.
inline bool has_outline(const ContactBody& body) {
    return body.wall || body.surface.x != 0 || body.surface.y != 0;
}

/// The gap that is left between the surfaces of two bodies along n, from one to two, after some time,
/// in which it changes by so much at most; infinite where the outline of one of them is turned away
/// from n.
inline double gap_between(const ContactBody& one, const ContactBody& two, double nx, double ny,
                          double ahead, double most) {
    // Between two that are free, the normal of a corner is a guess.
    const double facing = one.is_fixed() || two.is_fixed() ? 0 : 0.5;
    const auto place = [&](const ContactBody& body, double sign) {
        if (body.wall) return body.x * nx + body.y * ny;
        const SurfaceSums& s = body.surface;
        const double area = s.x * nx + s.y * ny;
        return sign * area > facing * std::sqrt(s.x * s.x + s.y * s.y)
                   ? (nx * (s.xx * nx + s.xy * ny) + ny * (s.yx * nx + s.yy * ny)) / area
                   : sign * -std::numeric_limits<double>::infinity();
    };
    const double parting = (two.vx_0 - one.vx_0) * nx + (two.vy_0 - one.vy_0) * ny;
    return place(two, -1) - place(one, 1) + std::clamp(ahead * parting, -most, most);
}

/// What the normal of two bodies is along, from one to two: the gradient of the fixed one where there
/// is one, else between both.
inline std::array<double, 2> gradient_between(const ContactBody& one, const ContactBody& two) {
    return {(two.rigid ? 0 : one.gx) - (one.rigid ? 0 : two.gx),
            (two.rigid ? 0 : one.gy) - (one.rigid ? 0 : two.gy)};
}

/// The normal from one to two: out of the fixed one where there is one, else between both gradients.
/// out:    whether there is one
inline bool normal_between(const ContactBody& one, const ContactBody& two, double& nx, double& ny) {
    if (two.wall) {
        nx = two.grain == x_low ? -1 : two.grain == x_high ? 1 : 0;
        ny = two.grain == y_low ? -1 : two.grain == y_high ? 1 : 0;
        return true;
    }
    const std::array<double, 2> along = gradient_between(one, two);
    const double size = std::sqrt(along[0] * along[0] + along[1] * along[1]);
    nx = along[0] / size, ny = along[1] / size;
    return size > 0;
}

/// The two bodies that alone meet at a node, and along which axis their surface is crossed.
struct Meeting {
    enum Axis : signed char { none, along_x, along_y };
    int a = 0, b = 0;  // ContactBody::id()
    Axis axis = none;
    bool backward = false;  // n is against the axis
    bool operator==(const Meeting&) const = default;
};
inline Meeting meeting_of(const ContactNode& node) {
    const ContactPair& pair = node.pairs[0];
    const ContactBody &a = node.bodies[pair.a], &b = node.bodies[pair.b];
    if (!has_outline(a) || !has_outline(b)) return {};
    const bool x = std::fabs(pair.nx) > std::fabs(pair.ny);
    return {a.id(), b.id(), x ? Meeting::along_x : Meeting::along_y, (x ? pair.nx : pair.ny) < 0};
}

/// The nodes of a run, put together one after the other, and the contacts that they make.
class SurfaceRun {
   public:
    bool full() const { return links_ == ContactPair::max_links; }

    /// in:     node, with the two bodies and their pair
    void add(const ContactNode& node, Meeting::Axis axis, double h) {
        const ContactPair& pair = node.pairs[0];
        const std::size_t k = links_++, at = 2 * k;
        bodies_[at] = node.bodies[pair.a], bodies_[at + 1] = node.bodies[pair.b];
        keys_[k] = node.key;
        if (k == 0) pair_ = pair;
        if (!bodies_[at + 1].wall) {
            const auto [x, y] = gradient_between(bodies_[at], bodies_[at + 1]);
            gx_ += x, gy_ += y;
        }
        // Moments about the first node.
        const double away = static_cast<double>(k) * h, dx = axis == Meeting::along_x ? away : 0,
                     dy = axis == Meeting::along_x ? 0 : away;
        for (const std::size_t who : {0, 1}) {
            if (k == 0) seen_[who] = bodies_[who];
            if (k == 0 || seen_[who].wall) continue;
            seen_[who].surface += moved(bodies_[at + who].surface, dx, dy);
        }
    }

    /// in:     touch(a, b, pair), whether their surfaces touch, seen from all nodes of the run; where
    ///         they do not, the run makes no contact
    template <class Touch>
    void close(const Touch& touch) {
        if (!bodies_[1].wall) {
            const double size = std::hypot(gx_, gy_);
            if (!(size > 0)) return;
            pair_.nx = gx_ / size, pair_.ny = gy_ / size;
        }
        double sum = 0, heaviest = 0;
        for (std::size_t k = 0; k < links_; ++k) {
            // By the free body: what a fixed one feels moves nothing.
            const ContactBody &a = bodies_[2 * k], &b = bodies_[2 * k + 1];
            weight_[k] = std::max(0.0, area(a) - area(b)), sum += weight_[k];
            heaviest = std::max(heaviest, free_mass(k));
        }
        if (!(sum > 0)) return;
        for (const std::size_t who : {0, 1}) {
            if (seen_[who].wall) continue;
            seen_[who].vx_0 = seen_[who].vy_0 = 0;
            for (std::size_t k = 0; k < links_; ++k) {
                const ContactBody& body = bodies_[2 * k + who];
                seen_[who].vx_0 += weight_[k] / sum * body.vx_0,
                    seen_[who].vy_0 += weight_[k] / sum * body.vy_0;
            }
        }
        if (!touch(seen_[0], seen_[1], pair_)) return;
        for (std::size_t k = 0; k < links_; ++k) is_light_[k] = free_mass(k) < light * heaviest;
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
    // Mass at a node, for the heaviest of its run, below which any step is too long for it: particles
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
    std::array<ContactBody, 2 * ContactPair::max_links> bodies_;
    std::array<long, ContactPair::max_links> keys_{};
    std::array<double, ContactPair::max_links> weight_{};
    std::array<bool, ContactPair::max_links> is_light_{};
    std::array<ContactBody, 2> seen_;  // the two, with the surfaces that all nodes see
    double gx_ = 0, gy_ = 0;
};

}  // namespace mpm
