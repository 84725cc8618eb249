// Constraints: nodes of small mass, and nodes where the mass matrix is rank-deficient, take the
// velocity that a heavier neighbor, their master, and the node beyond it show on their line:
//     o ---- o ---- x        v = 2 v_master - v_beyond
//   beyond master
// A body that turns is among the velocities that are left, so forces keep its angular momentum.
// Where there is no heavy node beyond, they take the velocity of the master.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "mpm_implicit/stencil.hpp"

namespace mpm_implicit {

/// The dofs that a dof's velocity is made of, through ghosts of ghosts: the dof itself, its master, or
/// more where a ghost lies on the line through two.
struct MasterDofs {
    struct Share {
        long dof;
        double x, y;  // of the velocity components
        double mass;  // the same without the signs of walls
    };
    std::vector<long> first;                  // of each dof: 0, or -1 - k
    std::vector<Share> single;                // where first is 0, all of its velocity
    std::vector<std::vector<Share>> several;  // where first is -1 - k, several[k]

    explicit MasterDofs(const GrainNodes& nodes)
        : first(static_cast<std::size_t>(nodes.size()), 0), single(first.size()) {
        for (std::size_t i = 0; i < first.size(); ++i) single[i] = {static_cast<long>(i), 1, 1, 1};
        const auto& ghosts = nodes.ghosts();
        for (auto ghost = ghosts.rbegin(); ghost != ghosts.rend(); ++ghost) {
            std::vector<Share> made;
            const auto add = [&](long of, double x, double y, double mass) {
                for (const Share& share : of_dof(of)) {
                    const auto same = std::find_if(made.begin(), made.end(), [&](const Share& one) {
                        return one.dof == share.dof;
                    });
                    Share& to =
                        same != made.end() ? *same : made.emplace_back(Share{share.dof, 0, 0, 0});
                    to.x += x * share.x, to.y += y * share.y, to.mass += mass * share.mass;
                }
            };
            add(ghost->master, ghost->part_x, ghost->part_y, std::fabs(ghost->part_x));
            if (ghost->beyond >= 0) add(ghost->beyond, -1, -1, -1);
            const auto i = static_cast<std::size_t>(ghost->dof);
            if (made.size() == 1) {
                single[i] = made[0];
            } else {
                several.push_back(made);
                first[i] = -static_cast<long>(several.size());
            }
        }
    }

    std::span<const Share> of_dof(long dof) const {
        const auto i = static_cast<std::size_t>(dof);
        if (first[i] < 0) return several[static_cast<std::size_t>(-1 - first[i])];
        return {&single[i], 1};
    }

    /// Calls work(a, b) for the pairs of shares that an entry couples, which is stored for itself and
    /// its transpose.
    template <class Work>
    void for_each_pair(long one, long two, const Work& work) const {
        const auto of_one = of_dof(one), of_two = of_dof(two);
        for (std::size_t a = 0; a < of_one.size(); ++a)
            for (std::size_t b = one == two ? a : 0; b < of_two.size(); ++b)
                work(of_one[a], of_two[b]);
    }
};

/// A node constrained to its master, and the node beyond it or -1.
struct DofConstraint {
    long dof, master, beyond;
};

/// The constraint of the dof in row r, column i: its heaviest neighbor of those that walls hold alike,
/// one that has a node beyond it if there is; the master is the dof itself where there is none.
inline DofConstraint constraint_of(const std::vector<GridRow>& rows, long r, long i,
                                   const GrainNodes& nodes) {
    const auto mass = [&](long dof) { return nodes.sums[dof].m; };
    const GridRow& row = rows[r];
    const long dof = row.origin + i;
    const auto heavier = [&](long q, long j, double times) {
        if (q < row.lowest || q >= row.above || j < rows[q].first || j >= rows[q].end) return -1L;
        const long other = rows[q].origin + j;
        const bool alike = nodes.is_fixed_x(other) == nodes.is_fixed_x(dof) &&
                           nodes.is_fixed_y(other) == nodes.is_fixed_y(dof);
        return alike && mass(other) > times * mass(dof) ? other : -1L;
    };
    DofConstraint found{dof, dof, -1};
    for (long b = -1; b <= 1; ++b) {
        for (long a = -1; a <= 1; ++a) {
            const long master = heavier(r + b, i + a, 1);
            if (master < 0) continue;
            const long beyond = heavier(r + 2 * b, i + 2 * a, 4);
            const bool better = (beyond >= 0) != (found.beyond >= 0)
                                    ? beyond >= 0
                                    : mass(master) > mass(found.master);
            if (better) found = {dof, master, beyond};
        }
    }
    return found;
}

/// Constrains dofs, the lightest first: a master may be constrained as well.
/// in/out: nodes.sums, which move along; nodes.ghosts()
/// exact:  total mass and momentum of a grain stay
inline void constrain_nodes(std::vector<DofConstraint>& constraints, GrainNodes& nodes) {
    const auto mass = [&](long dof) { return nodes.sums[dof].m; };
    std::stable_sort(
        constraints.begin(), constraints.end(),
        [&](const DofConstraint& a, const DofConstraint& b) { return mass(a.dof) < mass(b.dof); });
    for (DofConstraint one : constraints) {
        NodeSums &from = nodes.sums[one.dof], &to = nodes.sums[one.master];
        // Others may have taken mass from it, or it may have become a ghost.
        if (one.beyond >= 0 && !(mass(one.beyond) > 3 * from.m)) one.beyond = -1;
        const auto add = [&](NodeSums& node, double part) {
            node.m += part * from.m, node.px += part * from.px, node.py += part * from.py;
            node.mx += part * from.mx, node.my += part * from.my;
        };
        add(to, one.beyond < 0 ? 1 : 2);
        if (one.beyond >= 0) add(nodes.sums[one.beyond], -1);
        to.V += from.V, to.gx += from.gx, to.gy += from.gy;
        from = {};
        if (const int k = nodes.surface_of(one.dof); k >= 0) {
            if (const int to_k = nodes.surface_of(one.master); to_k >= 0)
                nodes.surface[to_k] += nodes.surface[k];
            nodes.surface[k] = {};
        }
        nodes.constrain(one.dof, one.master, one.beyond);
    }
}

/// Constrains nodes of small mass.
/// A particle that has come a small way d into a cell sees the nodes behind it with weights of d
/// and gradients that some of their motions feel with d only: stress would drive those with 1/d,
/// and round-off with them. The theorem holds with any constraints: they make a smaller space of
/// velocities.
inline void constrain_small_mass_nodes(const std::vector<GridRow>& rows, GrainNodes& nodes) {
    constexpr double light = 1e-2;  // of the mass of the neighbor
    const auto mass = [&](long dof) { return nodes.sums[dof].m; };
    std::vector<DofConstraint> constraints;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const GridRow& row = rows[r];
        for (long i = row.first; i < row.end; ++i) {
            const long dof = row.origin + i;
            if (!(mass(dof) > 0)) continue;
            const DofConstraint one = constraint_of(rows, static_cast<long>(r), i, nodes);
            if (mass(dof) < light * mass(one.master)) constraints.push_back(one);
        }
    }
    constrain_nodes(constraints, nodes);
}

/// Constrains rank-deficient nodes, whose motion is at all particles nearly that of other nodes.
/// in: dofs, as MassFactors::factorize finds them
inline void constrain_rank_deficient_nodes(const std::vector<long>& dofs,
                                           const std::vector<GridRow>& rows, GrainNodes& nodes) {
    std::vector<DofConstraint> constraints;
    for (const long dof : dofs) {
        const auto row = std::partition_point(
            rows.begin(), rows.end(), [&](const GridRow& r) { return r.origin + r.end <= dof; });
        const DofConstraint one = constraint_of(rows, row - rows.begin(), dof - row->origin, nodes);
        if (one.master != dof) constraints.push_back(one);
    }
    constrain_nodes(constraints, nodes);
}

}  // namespace mpm_implicit
