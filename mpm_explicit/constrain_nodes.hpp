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
#include <map>
#include <utility>
#include <vector>

#include "common/parallel.hpp"
#include "mpm_explicit/grid/grain_nodes.hpp"

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
    signed char along = 0;  // 1, 2: gradients are shared along x, along y, as forces are
    long lowest = 0;        // the lowest row of its grain
};

/// Which neighbors a node may be constrained to: also those across a corner of a cell, or only those
/// along the lines of nodes.
enum class Neighbors { all, along_lines };

/// The constraint of the dof in row r, column i: its heaviest neighbor of those that walls hold alike,
/// one that has a node beyond it if there is; the master is the dof itself where there is none. One across
/// a corner has to weigh twice as much: beside a flat surface all three weigh the same, and were round-off to
/// choose, some columns would get the forces of two and others none.
/// in:     nodes.mass
inline DofConstraint constraint_of(const std::vector<GridRow>& rows, long r, long i,
                                   Neighbors neighbors, const GrainNodes& nodes) {
    const auto mass = [&](long dof) { return nodes.mass[dof]; };
    const GridRow& row = rows[r];
    const long dof = row.origin + i;
    const auto heavier = [&](long q, long j, double times) {
        if (q < row.lowest || q >= row.above || j < rows[q].first || j >= rows[q].end) return -1L;
        const long other = rows[q].origin + j;
        const bool alike = nodes.is_fixed_x(other) == nodes.is_fixed_x(dof) &&
                           nodes.is_fixed_y(other) == nodes.is_fixed_y(dof);
        // Of bonded grains what counts is mass together, but each takes the mass of its own nodes.
        return alike && mass(other) > times * mass(dof) &&
                       nodes.sums[other].m > times * nodes.sums[dof].m
                   ? other
                   : -1L;
    };
    const DofConstraint none{dof, dof, -1, 0, row.lowest};
    DofConstraint found = none;
    double most = mass(dof);
    bool tie = false;
    for (long b = -1; b <= 1; ++b) {
        for (long a = -1; a <= 1; ++a) {
            if (neighbors == Neighbors::along_lines && a * b != 0) continue;
            const long master = heavier(r + b, i + a, 1);
            if (master < 0) continue;
            const long beyond = heavier(r + 2 * b, i + 2 * a, 4);
            const double m = (a * b == 0 ? 2 : 1) * mass(master), lead = m - most;
            const bool same = (beyond >= 0) == (found.beyond >= 0),
                       alike = same && std::fabs(lead) < 1e-9 * m,
                       better = same ? lead > 0 && !alike : beyond >= 0;
            tie = alike || (tie && !better);
            const bool on_line = a * b == 0 && beyond >= 0;
            if (!better) continue;
            most = m;
            found = {dof, master, beyond,
                     static_cast<signed char>(!on_line ? 0
                                              : a != 0 ? 1
                                                       : 2),
                     row.lowest};
        }
    }
    // Which of two that weigh the same would break a symmetry; and across a corner nothing is driven.
    return tie && neighbors == Neighbors::along_lines ? none : found;
}

/// Constrains dofs, the lightest of a grain first: a master may be constrained as well.
/// in/out: nodes.sums and nodes.mass, which move along; nodes.ghosts()
/// exact:  total mass and momentum of a grain stay
inline void constrain_nodes(std::vector<DofConstraint>& constraints, GrainNodes& nodes) {
    const auto mass = [&](long dof) { return nodes.mass[dof]; };
    std::stable_sort(constraints.begin(), constraints.end(),
                     [&](const DofConstraint& a, const DofConstraint& b) {
                         return a.lowest != b.lowest ? a.lowest < b.lowest
                                                     : mass(a.dof) < mass(b.dof);
                     });
    for (DofConstraint one : constraints) {
        NodeSums& from = nodes.sums[one.dof];
        // Others may have taken mass from it, or it may have become a ghost.
        if (one.beyond >= 0 &&
            !(mass(one.beyond) > 3 * mass(one.dof) && nodes.sums[one.beyond].m > 3 * from.m))
            one.beyond = -1, one.along = 0;
        const auto add = [&](long dof, double part) {
            NodeSums& node = nodes.sums[dof];
            nodes.mass[dof] += part * mass(one.dof);
            node.m += part * from.m, node.px += part * from.px, node.py += part * from.py;
            node.mx += part * from.mx, node.my += part * from.my;
            if (one.along != 0) node.gx += part * from.gx, node.gy += part * from.gy;
        };
        add(one.master, one.beyond < 0 ? 1 : 2);
        if (one.beyond >= 0) add(one.beyond, -1);
        NodeSums& to = nodes.sums[one.master];
        to.V += from.V;
        if (one.along == 0) to.gx += from.gx, to.gy += from.gy;
        from = {}, nodes.mass[one.dof] = 0;
        const int k = nodes.surface_of(one.dof), to_k = nodes.surface_of(one.master);
        for (std::vector<SideSums>& side : nodes.surface) {
            if (k < 0 || side.empty()) continue;
            if (to_k >= 0) side[to_k] += side[k];
            side[k] = {};
        }
        nodes.constrain(one.dof, one.master, one.beyond, one.along);
    }
}

/// nodes.mass: the mass of each grain at its nodes; of bonded grains that of both together at one density, so that
/// light means a sliver of a cell and not a light material. A node without mass takes the velocity of its bonded
/// partner.
inline void find_masses(const std::vector<Bond>& bonds, GrainNodes& nodes) {
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        for (long i = begin; i < end; ++i) nodes.mass[i] = nodes.sums[i].m;
    });
    std::map<std::pair<int, int>, double> joined;  // how many times as dense the second one is
    for (const Bond& bond : bonds)
        if (!bond.broken)
            joined[{bond.a, bond.b}] = bond.density_ratio,
                            joined[{bond.b, bond.a}] = 1 / bond.density_ratio;
    if (joined.empty()) return;
    for (long n = 0; n < nodes.shared_count(); ++n)
        for (long a = nodes.shared_begin()[n]; a < nodes.shared_begin()[n + 1]; ++a)
            for (long b = nodes.shared_begin()[n]; b < nodes.shared_begin()[n + 1]; ++b) {
                const Member &one = nodes.members()[a], &two = nodes.members()[b];
                if (one.is_wall() || two.is_wall()) continue;
                const auto bond = joined.find({one.grain, two.grain});
                if (bond == joined.end()) continue;
                const double m = nodes.sums[two.dof].m / bond->second;
                if (!(nodes.mass[one.dof] > 0) && m > 0) nodes.constrain(one.dof, two.dof, -1);
                nodes.mass[one.dof] += m;
            }
}

/// Constrains nodes that have less than a part of the mass of their neighbor.
/// A particle a small way d inside a cell gives the far nodes masses of order d, and its stress forces
/// of order 1: accelerations there, and the round-off in them, grow as 1/d.
/// The energy theorem of mpm_implicit holds with any constraints: they make a
/// smaller space of velocities.
/// in:     light, that part; bonds, whose grains are held alike where they are joined
/// in/out: nodes.sums, which move along; nodes.ghosts()
inline void constrain_small_mass_nodes(const std::vector<GridRow>& rows,
                                       const std::vector<Bond>& bonds, double light,
                                       Neighbors neighbors, GrainNodes& nodes) {
    find_masses(bonds, nodes);
    const auto mass = [&](long dof) { return nodes.mass[dof]; };
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
        if (!(m > 0 && m < light * heaviest && nodes.sums[rows[r].origin + i].m > 0)) return;
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
/// note:   Not with smooth shapes, whose gradients vanish where mass does, as those of linear shapes do
///         across a corner.
template <class Shape>
void hold_small_mass_nodes(const Shape&, const std::vector<Grain>& grains,
                           const std::vector<Bond>& bonds, const GridLayout& layout,
                           GrainNodes& nodes) {
    if constexpr (Shape::width == 2)
        constrain_small_mass_nodes(grid_rows(grains, nodes, layout), bonds, 1.0 / 64,
                                   Neighbors::along_lines, nodes);
}

}  // namespace mpm
