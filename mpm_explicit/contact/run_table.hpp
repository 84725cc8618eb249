// Where the surfaces of two bodies are, and which nodes follow each other across a surface.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mpm_explicit/contact/outline_normal.hpp"
#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm {

/// Whether a body shows an outline at a node, beyond round-off of shape functions; clouds of particles
/// without one do not. h, the width of a cell.
inline bool has_outline(const ContactBody& body, double h) {
    const auto& [one, two] = body.surface.sides;
    return body.wall ||
           std::fabs(one.x) + std::fabs(one.y) + std::fabs(two.x) + std::fabs(two.y) > 1e-6 * h;
}

/// The gap that is left between the surfaces of two bodies along n, from one to two, after some time,
/// in which it changes by so much at most; infinite where the outline of one of them is turned away
/// from n.
inline double gap_between(const ContactBody& one, const ContactBody& two, double nx, double ny,
                          double ahead, double most) {
    // Between two that are free, the normal of corner on corner is a guess; beside a corner, a side
    // along n has no place.
    const bool free = !one.is_fixed() && !two.is_fixed();
    const auto place = [&](const ContactBody& body, double sign) {
        if (body.wall) return body.x * nx + body.y * ny;
        const auto size = [](const SideSums& s) { return std::sqrt(s.x * s.x + s.y * s.y); };
        const auto& sides = body.surface.sides;
        const bool corner = size(sides[0]) > 0 && size(sides[1]) > 0;
        double farthest = -std::numeric_limits<double>::infinity();
        for (const SideSums& s : sides) {
            const double area = s.x * nx + s.y * ny;
            if (sign * area > (free ? 0.5 : corner ? 0.1 : 0.0) * size(s))
                farthest = std::max(
                    farthest,
                    sign * ((nx * (s.xx * nx + s.xy * ny) + ny * (s.yx * nx + s.yy * ny)) / area));
        }
        return sign * farthest;
    };
    const double parting = (two.vx_0 - one.vx_0) * nx + (two.vy_0 - one.vy_0) * ny;
    return place(two, -1) - place(one, 1) + std::clamp(ahead * parting, -most, most);
}

/// The two bodies that alone meet at a node, one of them fixed, and along which axis their surface is
/// crossed; inside: a node within the fixed one, where it has no normal.
struct Meeting {
    enum Axis : signed char { none, along_x, along_y, inside };
    int a = 0, b = 0;  // ContactBody::id()
    Axis axis = none;
    bool backward = false;  // n is against the axis
    bool operator==(const Meeting&) const = default;
    bool same_bodies(const Meeting& other) const { return a == other.a && b == other.b; }
};
/// in:     node, with two bodies; h, the width of a cell
inline Meeting meeting_of(const ContactNode& node, double h) {
    const ContactBody &a = node.bodies[0], &b = node.bodies[1];
    if (node.pairs.empty()) return {a.id(), b.id(), Meeting::inside};
    if (!has_outline(a, h) || !has_outline(b, h)) return {};
    const ContactPair& pair = node.pairs[0];
    const bool x = std::fabs(pair.nx) > std::fabs(pair.ny);
    return {a.id(), b.id(), x ? Meeting::along_x : Meeting::along_y, (x ? pair.nx : pair.ny) < 0};
}

/// Which fixed nodes make which runs.
class RunTable {
   public:
    RunTable(const GrainNodes& nodes, const std::vector<Meeting>& meetings)
        : nodes_(nodes), meetings_(meetings) {}

    /// Calls visit(shared node) for the nodes of the run that begins at fixed node n, if one does.
    /// note:   longer runs than of RunTable::longest are cut, counted from their first node
    template <class Visit>
    void for_each_node(long n, const Visit& visit) const {
        constexpr long most = longest;
        const Meeting& own = meetings_[n];
        const auto next = [&](long at, bool back) { return following(at, own, back); };
        const auto visit_inside = [&](long at, bool back) {
            const long to = beside(at, own.axis, back);
            if (to < 0 || meetings_[to].axis != Meeting::inside || owner(to) != at) return 0L;
            visit(nodes_.fixed_nodes()[to].shared);
            return 1L;
        };
        long before = 0;
        for (long at = next(n, true); at >= 0; at = next(at, true)) ++before;
        if (before % most != 0) return;
        long count = before == 0 ? visit_inside(n, true) : 0, last = n;
        for (long at = n; at >= 0 && count < most; last = at, at = next(at, false))
            visit(nodes_.fixed_nodes()[at].shared), ++count;
        if (count < most) visit_inside(last, false);
    }

    static constexpr long longest = ContactPair::max_links / 2;

    /// The fixed node at which the run in the next column begins, of the same two bodies; -1: none.
    long next_column(long n, bool back) const {
        const Meeting& own = meetings_[n];
        const long to =
            beside(n, own.axis == Meeting::along_x ? Meeting::along_y : Meeting::along_x, back);
        if (to < 0) return -1;
        for (const long at : {to, beside(to, own.axis, true), beside(to, own.axis, false)})
            if (at >= 0 && meetings_[at] == own) return start_of(at);
        return -1;
    }

   private:
    long following(long at, const Meeting& own, bool back) const {
        const long to = beside(at, own.axis, back);
        return to >= 0 && meetings_[to] == own ? to : -1;
    }
    long start_of(long at) const {
        long before = 0, start = at;
        for (long to = at; (to = following(to, meetings_[at], true)) >= 0;) start = to, ++before;
        for (long k = before - before % longest; k > 0; --k)
            start = following(start, meetings_[at], false);
        return start;
    }
    long beside(long at, Meeting::Axis axis, bool back) const {
        const GrainNodes::FixedNode& to = nodes_.fixed_nodes()[at];
        return axis == Meeting::along_x ? (back ? to.left : to.right)
                                        : (back ? to.below : to.above);
    }
    // The node whose run takes in a node within the fixed body; -1: none.
    long owner(long at) const {
        for (const Meeting::Axis axis : {Meeting::along_y, Meeting::along_x})
            for (const bool back : {true, false}) {
                const long to = beside(at, axis, back);
                if (to >= 0 && meetings_[to].axis == axis &&
                    meetings_[to].same_bodies(meetings_[at]))
                    return to;
            }
        return -1;
    }
    const GrainNodes& nodes_;
    const std::vector<Meeting>& meetings_;
};

}  // namespace mpm
