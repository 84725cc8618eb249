// Constraints: nodes of small mass, and nodes where the mass matrix is rank-deficient, take the
// velocity of a neighbor, their master.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "mpm_implicit/stencil.hpp"

namespace mpm_implicit {

/// The master of every dof, through ghosts of ghosts, and the signs of its velocity components.
struct MasterDofs {
    std::vector<long> dof;
    std::vector<double> sign_x, sign_y;

    explicit MasterDofs(const GrainNodes& nodes)
        : dof(static_cast<std::size_t>(nodes.size())), sign_x(dof.size(), 1), sign_y(sign_x) {
        for (std::size_t i = 0; i < dof.size(); ++i) dof[i] = static_cast<long>(i);
        const auto& ghosts = nodes.ghosts();
        for (auto ghost = ghosts.rbegin(); ghost != ghosts.rend(); ++ghost) {
            const auto from = static_cast<std::size_t>(ghost->dof),
                       of = static_cast<std::size_t>(ghost->master);
            dof[from] = dof[of];
            sign_x[from] = ghost->sign_x * sign_x[of], sign_y[from] = ghost->sign_y * sign_y[of];
        }
    }
};

/// The neighbor of a dof in row r, column i with the most mass, of those that walls hold alike; or
/// the dof itself.
inline long heaviest_neighbor(const std::vector<GridRow>& rows, long r, long i,
                              const GrainNodes& nodes) {
    const auto mass = [&](long dof) { return nodes.sums[dof].m; };
    const GridRow& row = rows[r];
    const long dof = row.origin + i;
    long heaviest = dof;
    for (long q = std::max(row.lowest, r - 1); q < std::min(row.above, r + 2); ++q) {
        const GridRow& other = rows[q];
        for (long j = std::max(i - 1, other.first); j < std::min(i + 2, other.end); ++j) {
            const long neighbor = other.origin + j;
            if (mass(neighbor) > mass(heaviest) &&
                nodes.is_fixed_x(neighbor) == nodes.is_fixed_x(dof) &&
                nodes.is_fixed_y(neighbor) == nodes.is_fixed_y(dof))
                heaviest = neighbor;
        }
    }
    return heaviest;
}

/// A node constrained to the velocity of its master.
struct DofConstraint {
    long dof, master;
};

/// Constrains dofs to master dofs, the lightest first: a master may be constrained as well.
/// in/out: nodes.sums, which move along; nodes.ghosts()
/// exact:  total mass and momentum of a grain stay
inline void constrain_nodes(std::vector<DofConstraint>& constraints, GrainNodes& nodes) {
    const auto mass = [&](long dof) { return nodes.sums[dof].m; };
    std::stable_sort(
        constraints.begin(), constraints.end(),
        [&](const DofConstraint& a, const DofConstraint& b) { return mass(a.dof) < mass(b.dof); });
    for (const DofConstraint& one : constraints) {
        NodeSums &from = nodes.sums[one.dof], &to = nodes.sums[one.master];
        to.m += from.m, to.V += from.V, to.px += from.px, to.py += from.py;
        to.mx += from.mx, to.my += from.my, to.gx += from.gx, to.gy += from.gy;
        from = {};
        nodes.constrain(one.dof, one.master);
    }
}

/// Constrains nodes of small mass to their heaviest neighbor under the same wall conditions, so
/// that both have one velocity.
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
            if (!(mass(dof) > nodes.least_mass())) continue;
            const long heaviest = heaviest_neighbor(rows, static_cast<long>(r), i, nodes);
            if (mass(dof) < light * mass(heaviest)) constraints.push_back({dof, heaviest});
        }
    }
    constrain_nodes(constraints, nodes);
}

/// Constrains rank-deficient nodes, whose motion is at all particles nearly that of other nodes, to
/// their heaviest neighbor. in: dofs, as MassFactors::factorize finds them
inline void constrain_rank_deficient_nodes(const std::vector<long>& dofs,
                                           const std::vector<GridRow>& rows, GrainNodes& nodes) {
    std::vector<DofConstraint> constraints;
    for (const long dof : dofs) {
        const auto row = std::partition_point(
            rows.begin(), rows.end(), [&](const GridRow& r) { return r.origin + r.end <= dof; });
        const long heaviest = heaviest_neighbor(rows, row - rows.begin(), dof - row->origin, nodes);
        if (heaviest != dof) constraints.push_back({dof, heaviest});
    }
    constrain_nodes(constraints, nodes);
}

}  // namespace mpm_implicit
