// Contact at a rigid surface: the runs of nodes across it (surface_runs.hpp), column beside column, and
// what touches between two columns.
//
//      column i        i + 1         Nodes see the outline within a cell to both sides. Where it is
//     ----\-----------/------        round, and touches between two columns, both see gaps that are
//          \ _     _ /               open: at its lowest point it is nearer than at either,
//     o--------  s ------ o              g(s) = (1 - s) g_i + s g_i+1 - s (1 - s) k/2,
//                                    with k the second difference of the gaps of four columns. There
// the two runs make one contact, in which they have the parts 1 - s and s: the lowest point of a circle
// has the same gap wherever it is, and no velocity where the circle rolls. Were each column for itself,
// the circle would fall by h^2/8R = k/8 from one to the next, and what rolls would hop. Where that is less
// than the separation at which surfaces touch, both columns do, and each is for itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mpm_explicit/contact/contact_bodies.hpp"

namespace mpm {

/// The run that begins at a fixed node: the gap that it sees, and the runs in the columns beside it.
struct ContactColumn {
    double gap = std::numeric_limits<double>::infinity();
    int before = -1, next = -1;
};

/// The lowest point between a column and the next one; none: contact is at the columns.
struct LowestPoint {
    bool exists = false;
    double gap = 0, part = 0;  // part, s, of the next column
};
/// The lowest point between column n and the next one.
/// in:     n, number of the first column; separation, at which surfaces touch [length]; 0: wherever
///         grains approach, at every column; h, width of a cell
/// exact:  for a parabola, wherever its lowest point is
/// note:   Below 3.3 cells of radius, k = 0.3 h, a disk would rock on the point under it, and gain by it.
inline LowestPoint lowest_point(const std::vector<ContactColumn>& columns, int n, double separation,
                                double h) {
    constexpr double sharpest = 0.3;
    const auto gap_at = [&](int at) {
        return at < 0 ? std::numeric_limits<double>::infinity() : columns[at].gap;
    };
    if (!(separation > 0) || n < 0 || columns[n].next < 0) return {};
    const int to = columns[n].next;
    // Beside a curved surface, two columns may not be one another's.
    if (columns[to].before != n) return {};
    const double g = columns[n].gap, g_to = columns[to].gap;
    // What is pressed at both columns is held at both: with one contact between them the surface could tilt
    // about it without resistance, one column sinking in as the other opens.
    if (g <= 0 && g_to <= 0) return {};
    // Second differences at both columns, where there is a column beyond.
    double k = 0, count = 0, least = std::numeric_limits<double>::infinity(), most = 0;
    for (const double one :
         {gap_at(columns[n].before) - 2 * g + g_to, g - 2 * g_to + gap_at(columns[to].next)})
        if (std::isfinite(one))
            k += one, count += 1, least = std::min(least, one), most = std::max(most, one);
    // What is flat on one side and turns on the other is a corner, and stands on it.
    if (count == 2 && !(least > 0.2 * most)) return {};
    // Where the fall between the columns is less than the separation, k/8, both of them touch.
    if (!(count > 0 && k / count > 8 * separation && k / count < sharpest * h)) return {};
    k /= count;
    const double part = 0.5 - (g_to - g) / k,
                 gap = g + part * (g_to - g) - 0.5 * k * part * (1 - part);
    return {part > 0 && part < 1, gap, part};
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
        // No node is in two contacts: beyond two lines at once, as at a corner, it bears nothing.
        std::vector<long> beyond;
        for (const GhostNode& one : nodes.constraints())
            if (one.along != 0) beyond.push_back(one.beyond);
        std::sort(beyond.begin(), beyond.end());
        for (const GhostNode& one : nodes.constraints()) {
            if (one.along == 0 || !(nodes.mass[one.beyond] > nodes.least_mass())) continue;
            const auto [from, to] = std::equal_range(beyond.begin(), beyond.end(), one.beyond);
            if (to - from == 1) held_.push_back(one);
        }
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

    /// The contacts of the run that begins at fixed node n, or of it and the next one: none where no
    /// run begins, where it is part of another contact, or where surfaces do not touch.
    SurfaceRun contacts_at(int n, ContactStorage& storage) const {
        const double near = bodies_.rule().separation * h();
        if (!std::isfinite(columns_[n].gap) || ends_point(n)) return {};
        const LowestPoint point = point_after(n);
        if (near > 0 && !((point.exists ? point.gap : columns_[n].gap) <= near)) return {};
        SurfaceRun run = gather_run(n, storage);
        run.weigh();
        if (point.exists) {
            SurfaceRun next = gather_run(columns_[n].next, storage);
            next.weigh();
            run.join(next, point.part);
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

    // The lowest point between a column and the next one, where there is none beside it: no column is in
    // two contacts, and mirror images mirror each other.
    LowestPoint point_after(int n) const {
        if (n < 0 || !bodies_.rule().points) return {};
        const double near = bodies_.rule().separation * h();
        const ContactColumn& column = columns_[n];
        const bool beside = (next_of(column.before) == n &&
                             lowest_point(columns_, column.before, near, h()).exists) ||
                            lowest_point(columns_, column.next, near, h()).exists;
        return beside ? LowestPoint{} : lowest_point(columns_, n, near, h());
    }

    int next_of(int n) const { return n < 0 ? -1 : columns_[n].next; }
    // Whether the column is the second one of a point.
    bool ends_point(int n) const {
        return next_of(columns_[n].before) == n && point_after(columns_[n].before).exists;
    }

    // The run that begins at fixed node n: empty where none does.
    SurfaceRun gather_run(long n, ContactStorage& storage) const {
        SurfaceRun run;
        const Meeting::Axis axis = meetings_[n].axis;
        table_.for_each_node(n, [&](long shared) {
            ContactNode one;
            bodies_.gather(shared, nodes_, storage, one);
            bodies_.find_pairs(h(), bonds_, false, false, storage, one);
            run.add(one, axis, h());
        });
        // A node beyond the surface may be held by the line through one of these and one further in.
        for (std::size_t k = 0, nodes = run.size(); k < nodes; ++k) {
            const ContactBody body = run.free_body(k);
            const auto [from, to] =
                std::equal_range(held_.begin(), held_.end(), body.dof, ByMaster{});
            for (auto by = from; by != to; ++by)
                if (!body.is_fixed() && by->along == axis && !run.let_pull(by->beyond) &&
                    !meets_others(by->beyond))
                    run.add_beyond(k, inner_body(by->beyond, body));
        }
        return run;
    }

    bool meets_others(long dof) const {
        const int n = nodes_.shared_of(dof);
        return n >= 0 && bodies_.meet_at(n, nodes_);
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
