// Constraints in the matrices of mpm_implicit: which dofs the velocity of a dof is made of, and nodes
// where the mass matrix is rank-deficient.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "mpm_implicit/solver/stencil.hpp"

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

/// Constrains rank-deficient nodes, whose motion is at all particles nearly that of other nodes.
/// in: dofs, as MassFactors::factorize finds them
inline void constrain_rank_deficient_nodes(const std::vector<long>& dofs,
                                           const std::vector<GridRow>& rows, GrainNodes& nodes) {
    std::vector<DofConstraint> constraints;
    for (const long dof : dofs) {
        const auto row = std::partition_point(
            rows.begin(), rows.end(), [&](const GridRow& r) { return r.origin + r.end <= dof; });
        const DofConstraint one =
            constraint_of(rows, row - rows.begin(), dof - row->origin, Neighbors::all, nodes);
        if (one.master != dof) constraints.push_back(one);
    }
    constrain_nodes(constraints, nodes);
}

}  // namespace mpm_implicit
