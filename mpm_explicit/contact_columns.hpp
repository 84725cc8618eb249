// Contact at a rigid surface: the runs of nodes across it (surface_runs.hpp), column beside column, and
// what touches between two columns.
//
//      column i        i + 1         Nodes see the outline within a cell to both sides. Where it is
//     ----\-----------/------        round, and touches between two columns, both see gaps that are
//          \ _     _ /               open: at its lowest point it is nearer than at either. With k the
//     o-- s ----------- o            second difference of the gaps of column i, which is lower than those
//                                    beside it, and of these,
//         s = (g_i-1 - g_i+1)/2k,   g(s) = g_i - k s^2/2.
// There the runs of column i and of the one on that side make one contact, in which they have the parts
// 1 - |s| and |s|: the lowest point of a circle has the same gap wherever it is, and no velocity where the
// circle rolls. Were each column for itself, the circle would fall by h^2/8R = k/8 from one to the next,
// and what rolls would hop. Where that is less than the separation at which surfaces touch, both columns
// do, and each is for itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mpm_explicit/contact_bodies.hpp"

namespace mpm {

/// The run that begins at a fixed node: the gap that it sees, and the runs in the columns beside it.
struct ContactColumn {
    double gap = std::numeric_limits<double>::infinity();
    int before = -1, next = -1;
};

/// The lowest point beside a column, between it and one of the columns beside it; none: -1.
struct LowestPoint {
    int with = -1;             // the other column
    double gap = 0, part = 0;  // part, s, of the other column: half at most
};
/// in:     n, number of a column; separation, at which surfaces touch [length]; 0: wherever grains
///         approach, at every column
/// out:    none where a column beside it is lower, where one is missing, and where the fall between
///         columns, k/8, is less than the separation: both of them touch then
/// exact:  for a parabola, wherever its lowest point is; mirror images mirror each other
inline LowestPoint lowest_point(const std::vector<ContactColumn>& columns, int n,
                                double separation) {
    if (!(separation > 0) || n < 0 || columns[n].before < 0 || columns[n].next < 0) return {};
    const double g = columns[n].gap, g_before = columns[columns[n].before].gap,
                 g_next = columns[columns[n].next].gap, k = g_before - 2 * g + g_next;
    if (!(g < g_before && g <= g_next && k > 8 * separation && std::isfinite(k))) return {};
    const double s = 0.5 * (g_before - g_next) / k;
    return {s < 0 ? columns[n].before : columns[n].next, g - 0.5 * k * s * s, std::fabs(s)};
}

/// The rigid surfaces of one step.
class ContactColumns {
   public:
    /// Finds where grains meet a rigid one or a wall, and nobody else, and the gaps there.
    /// in:     nodes, which have to stay as they are; only_bonded, nothing is looked for
    ContactColumns(const ContactBodies& bodies, const GrainNodes& nodes,
                   const std::vector<Bond>& bonds, bool only_bonded)
        : bodies_(bodies),
          nodes_(nodes),
          bonds_(bonds),
          meetings_(only_bonded ? 0 : nodes.fixed_nodes().size()),
          columns_(meetings_.size()),
          table_(nodes, meetings_) {
        for (const GhostNode& one : nodes.constraints())
            if (one.along != 0) held_.push_back(one);
        std::stable_sort(held_.begin(), held_.end(), ByMaster{});
        for_each_fixed_node(
            [&](long n, ContactStorage& storage) { meetings_[n] = meet(n, storage); });
        for_each_fixed_node([&](long n, ContactStorage& storage) {
            if (!is_crossed(n)) return;
            SurfaceRun run = gather_run(n, storage);
            if (!run.weigh()) return;
            columns_[n] = {gap_of(bodies_.rule(), run.seen(0), run.seen(1), run.pair(), h()),
                           static_cast<int>(table_.next_column(n, true)),
                           static_cast<int>(table_.next_column(n, false))};
        });
    }

    /// What fixed node n is: the surface is crossed there, in a run; or it is within a rigid grain.
    bool is_crossed(long n) const { return meetings_[n].axis != Meeting::none && !is_inside(n); }
    bool is_inside(long n) const { return meetings_[n].axis == Meeting::inside; }
    bool empty() const { return meetings_.empty(); }

    /// The contacts of the run that begins at fixed node n, or of it and one beside it: none where no
    /// run begins, where it is part of another contact, or where surfaces do not touch.
    SurfaceRun contacts_at(int n, ContactStorage& storage) const {
        const ContactColumn& column = columns_[n];
        const double near = bodies_.rule().separation * h();
        if (!std::isfinite(column.gap) || point_at(column.before).with == n ||
            point_at(column.next).with == n)
            return {};
        const LowestPoint point = point_at(n);
        if (near > 0 && !((point.with < 0 ? column.gap : point.gap) <= near)) return {};
        SurfaceRun run = gather_run(n, storage);
        run.weigh();
        if (point.with >= 0) {
            SurfaceRun other = gather_run(point.with, storage);
            other.weigh();
            run.join(other, point.part);
        }
        return run;
    }

   private:
    struct ByMaster {
        static long of(const GhostNode& one) { return one.master; }
        static long of(long master) { return master; }
        bool operator()(const auto& a, const auto& b) const { return of(a) < of(b); }
    };

    double h() const { return nodes_.mesh().h; }
    template <class Work>
    void for_each_fixed_node(const Work& work) {
        common::for_each_block(static_cast<long>(meetings_.size()), [&](int, long begin, long end) {
            ContactStorage storage;
            for (long n = begin; n < end; ++n) work(n, storage);
        });
    }

    Meeting meet(long n, ContactStorage& storage) const {
        ContactNode node;
        const long shared = nodes_.fixed_nodes()[n].shared;
        if (!bodies_.meet_at(shared, nodes_) || !bodies_.gather(shared, nodes_, storage, node) ||
            node.bodies.size() != 2 || (!node.bodies[0].is_fixed() && !node.bodies[1].is_fixed()))
            return {};
        bodies_.find_pairs(h(), bonds_, false, false, storage, node);
        return node.pairs.empty() || node.pairs[0].bond < 0 ? meeting_of(node, h()) : Meeting{};
    }

    // The lowest point beside a column; none where two points have the same other column.
    LowestPoint point_at(int n) const {
        const double near = bodies_.rule().separation * h();
        const LowestPoint point = lowest_point(columns_, n, near);
        if (point.with < 0) return {};
        const ContactColumn& other = columns_[point.with];
        const int beyond = other.before == n ? other.next : other.before;
        return lowest_point(columns_, beyond, near).with == point.with ? LowestPoint{} : point;
    }

    // The run that begins at fixed node n: empty where none does.
    SurfaceRun gather_run(long n, ContactStorage& storage) const {
        SurfaceRun run;
        table_.for_each_node(n, [&](long shared) {
            ContactNode one;
            bodies_.gather(shared, nodes_, storage, one);
            bodies_.find_pairs(h(), bonds_, false, false, storage, one);
            const Meeting::Axis axis = meetings_[n].axis;
            run.add(one, axis, h());
            // A node beyond the surface may be held by the line through this one and one further in.
            for (const ContactBody& body : one.bodies) {
                if (body.is_fixed()) continue;
                const auto [from, to] =
                    std::equal_range(held_.begin(), held_.end(), body.dof, ByMaster{});
                for (auto by = from; by != to; ++by)
                    if (by->along == axis && !meets_others(by->beyond))
                        run.add_beyond(inner_body(by->beyond, body));
            }
        });
        return run;
    }

    bool meets_others(long dof) const {
        const long l = nodes_.surface_of(dof);
        if (l < 0 || l >= std::ssize(nodes_.members())) return false;
        const std::vector<long>& begin = nodes_.shared_begin();
        return bodies_.meet_at(std::upper_bound(begin.begin(), begin.end(), l) - begin.begin() - 1,
                               nodes_);
    }
    // The body of a node at which the grain is alone.
    ContactBody inner_body(long dof, const ContactBody& of) const {
        ContactBody body = of;
        const NodeSums& sum = nodes_.sums[dof];
        body.dof = dof, body.m = sum.m, body.per_mx = body.per_my = 1 / sum.m;
        body.gx = sum.gx, body.gy = sum.gy, body.surface = {};
        body.vx_0 = nodes_.motion[dof].vx_0, body.vy_0 = nodes_.motion[dof].vy_0;
        return body;
    }

    const ContactBodies& bodies_;
    const GrainNodes& nodes_;
    const std::vector<Bond>& bonds_;
    std::vector<Meeting> meetings_;
    std::vector<ContactColumn> columns_;
    RunTable table_;
    std::vector<GhostNode> held_;  // with a node beyond the master, by master
};

}  // namespace mpm
