// Constraints: nodes of small mass, and in mpm_implicit nodes where the mass matrix is rank-deficient,
// take the velocity that a heavier neighbor, their master, and the node beyond it show on their line:
//     o ---- o ---- x        v = 2 v_master - v_beyond
//   beyond master
// A body that turns is among the velocities that are left, so forces keep its angular momentum.
// Where there is no heavy node beyond, they take the velocity of the master.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/parallel.hpp"
#include "mpm_explicit/grain_nodes.hpp"

namespace mpm {

/// A row of dofs of one grain, and its rows below and above.
struct GridRow {
    long origin;         // dof of column i: origin + i
    long first, end;     // columns
    long lowest, above;  // rows of the same grain: from the lowest to below `above`
};

/// The rows of all grains that are not rigid.
inline std::vector<GridRow> grid_rows(const std::vector<Grain>& grains, const GrainNodes& nodes,
                                      const GridLayout& layout) {
    std::vector<GridRow> rows;
    std::size_t at = 0;
    for (std::size_t g = 0; g < grains.size(); ++g) {
        const long lowest = static_cast<long>(rows.size());
        for (int r = 0; r < layout.rows[g]; ++r, ++at)
            if (!grains[g].rigid)
                rows.push_back({nodes.origin(static_cast<int>(g), layout.first_row[g] + r),
                                layout.first_column[at], layout.end_column[at], lowest,
                                lowest + layout.rows[g]});
    }
    return rows;
}

/// A node constrained to its master, and the node beyond it or -1.
struct DofConstraint {
    long dof, master, beyond;
};

/// Which neighbors a node may be constrained to: also those across a corner of a cell, or only those
/// along the lines of nodes.
enum class Neighbors { all, along_lines };

/// The constraint of the dof in row r, column i: its heaviest neighbor of those that walls hold alike,
/// one that has a node beyond it if there is; the master is the dof itself where there is none.
inline DofConstraint constraint_of(const std::vector<GridRow>& rows, long r, long i,
                                   Neighbors neighbors, const GrainNodes& nodes) {
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
    bool tie = false;
    for (long b = -1; b <= 1; ++b) {
        for (long a = -1; a <= 1; ++a) {
            if (neighbors == Neighbors::along_lines && a * b != 0) continue;
            const long master = heavier(r + b, i + a, 1);
            if (master < 0) continue;
            const long beyond = heavier(r + 2 * b, i + 2 * a, 4);
            const bool better = (beyond >= 0) != (found.beyond >= 0)
                                    ? beyond >= 0
                                    : mass(master) > mass(found.master);
            const bool alike = (beyond >= 0) == (found.beyond >= 0) &&
                               std::fabs(mass(master) - mass(found.master)) < 1e-9 * mass(master);
            tie = alike || (tie && !better);
            if (better) found = {dof, master, beyond};
        }
    }
    // Which of two that weigh the same would break a symmetry; and across a corner nothing is driven.
    return tie && neighbors == Neighbors::along_lines ? DofConstraint{dof, dof, -1} : found;
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

/// Constrains nodes that have less than a part of the mass of their neighbor.
/// A particle that has come a small way d into a cell sees the nodes behind it with weights of d
/// and gradients that some of their motions feel with d only: stress would drive those with 1/d,
/// and round-off with them. The theorem holds with any constraints: they make a smaller space of
/// velocities.
/// in:     light, that part
inline void constrain_small_mass_nodes(const std::vector<GridRow>& rows, double light,
                                       Neighbors neighbors, GrainNodes& nodes) {
    const auto mass = [&](long dof) { return nodes.sums[dof].m; };
    const auto for_each_mass = [&](const auto& visit) {
        common::for_each_block(
            static_cast<long>(rows.size()),
            [&](int block, long begin, long end) {
                for (long r = begin; r < end; ++r)
                    for (long i = rows[r].first; i < rows[r].end; ++i)
                        visit(block, r, i, mass(rows[r].origin + i));
            },
            nodes.size());
    };
    // Around most nodes there is no need to look: they are heavy, or empty.
    std::array<double, common::block_count> most{};
    for_each_mass([&](int block, long, long, double m) { most[block] = std::max(most[block], m); });
    const double heaviest = *std::max_element(most.begin(), most.end());
    std::array<std::vector<DofConstraint>, common::block_count> found;
    for_each_mass([&](int block, long r, long i, double m) {
        if (!(m > 0 && m < light * heaviest)) return;
        const DofConstraint one = constraint_of(rows, r, i, neighbors, nodes);
        if (m < light * mass(one.master)) found[block].push_back(one);
    });
    std::vector<DofConstraint> all;
    for (const std::vector<DofConstraint>& some : found)
        all.insert(all.end(), some.begin(), some.end());
    constrain_nodes(all, nodes);
}

/// Holds nodes with less than 1/64 of the mass of their neighbor, as an estimate of what the explicit
/// step is too long for: particles that have just crossed a line of nodes move those beyond it with
/// all their stress, and where these have the mass m_i, the neighbor m,
///   w = (c/h) (m/m_i)^1/2,  w dt = alpha (m/m_i)^1/2 > 2 below (alpha/2)^2 m: m/64 at a quarter
/// in/out: nodes.sums, nodes.surface, which move along; nodes.ghosts()
/// note:   An even stress beside a rigid plate, and a bond, do not know what is held.
///         Not with smooth shapes, whose gradients vanish where mass does, as those of linear shapes
///         do across a corner.
template <class Shape>
void hold_small_mass_nodes(const Shape&, const std::vector<Grain>& grains, const GridLayout& layout,
                           GrainNodes& nodes) {
    if constexpr (Shape::width == 2)
        constrain_small_mass_nodes(grid_rows(grains, nodes, layout), 1.0 / 64,
                                   Neighbors::along_lines, nodes);
}

}  // namespace mpm
