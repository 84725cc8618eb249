// The nodes of the grains as rows, and the nodes that a grain hardly touches.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "mpm_explicit/grain_nodes.hpp"

namespace mpm_implicit {

using namespace mpm;

/// A row of slots of one grain, and its rows below and above.
struct NodeRow {
    long origin;         // slot of column i: origin + i
    long first, end;     // columns
    long lowest, above;  // rows of the same grain: from the lowest to below `above`
};

/// The rows of all grains that are not rigid.
inline std::vector<NodeRow> rows_of(const std::vector<Grain>& grains, const GrainNodes& nodes,
                                    const Frame& frame) {
    std::vector<NodeRow> rows;
    std::size_t at = 0;
    for (std::size_t g = 0; g < grains.size(); ++g) {
        const long lowest = static_cast<long>(rows.size());
        for (int r = 0; r < frame.rows[g]; ++r, ++at)
            if (!grains[g].rigid)
                rows.push_back({nodes.origin(static_cast<int>(g), frame.first_row[g] + r),
                                frame.first_column[at], frame.end_column[at], lowest,
                                lowest + frame.rows[g]});
    }
    return rows;
}

/// The slot that a slot stands for, through all images; and with which signs of velocity.
struct Homes {
    std::vector<long> slot;
    std::vector<double> sign_x, sign_y;

    explicit Homes(const GrainNodes& nodes)
        : slot(static_cast<std::size_t>(nodes.size())), sign_x(slot.size(), 1), sign_y(sign_x) {
        for (std::size_t i = 0; i < slot.size(); ++i) slot[i] = static_cast<long>(i);
        const auto& images = nodes.images();
        for (auto image = images.rbegin(); image != images.rend(); ++image) {
            const auto from = static_cast<std::size_t>(image->slot),
                       of = static_cast<std::size_t>(image->of);
            slot[from] = slot[of];
            sign_x[from] = image->sign_x * sign_x[of], sign_y[from] = image->sign_y * sign_y[of];
        }
    }
};

/// The neighbor of a slot in row r, column i with the most mass, of those that walls hold alike; or
/// the slot itself.
inline long heaviest_neighbor(const std::vector<NodeRow>& rows, long r, long i,
                              const GrainNodes& nodes) {
    const auto mass = [&](long slot) { return nodes.sums[static_cast<std::size_t>(slot)].m; };
    const NodeRow& row = rows[static_cast<std::size_t>(r)];
    const long slot = row.origin + i;
    long heaviest = slot;
    for (long q = std::max(row.lowest, r - 1); q < std::min(row.above, r + 2); ++q) {
        const NodeRow& other = rows[static_cast<std::size_t>(q)];
        for (long j = std::max(i - 1, other.first); j < std::min(i + 2, other.end); ++j) {
            const long neighbor = other.origin + j;
            if (mass(neighbor) > mass(heaviest) &&
                nodes.is_fixed_x(neighbor) == nodes.is_fixed_x(slot) &&
                nodes.is_fixed_y(neighbor) == nodes.is_fixed_y(slot))
                heaviest = neighbor;
        }
    }
    return heaviest;
}

/// A node that is to move as another one does.
struct Tie {
    long slot, of;
};

/// Ties nodes to others, the lightest first: whom one is tied to may be tied as well.
/// in/out: nodes.sums, which move along; nodes.images()
/// exact:  total mass and momentum of a grain stay
inline void tie_nodes(std::vector<Tie>& ties, GrainNodes& nodes) {
    const auto mass = [&](long slot) { return nodes.sums[static_cast<std::size_t>(slot)].m; };
    std::stable_sort(ties.begin(), ties.end(),
                     [&](const Tie& a, const Tie& b) { return mass(a.slot) < mass(b.slot); });
    for (const Tie& tie : ties) {
        NodeSums &from = nodes.sums[static_cast<std::size_t>(tie.slot)],
                 &to = nodes.sums[static_cast<std::size_t>(tie.of)];
        to.m += from.m, to.V += from.V, to.px += from.px, to.py += from.py;
        to.mx += from.mx, to.my += from.my, to.gx += from.gx, to.gy += from.gy;
        from = {};
        nodes.tie(tie.slot, tie.of);
    }
}

/// Ties nodes that a grain hardly touches to their heaviest neighbor that walls hold alike, so that
/// both have one velocity.
/// A particle that has come a small way d into a cell sees the nodes behind it with weights of d and
/// gradients that some of their motions feel with d only: stress would drive those with 1/d, and
/// round-off with them. The theorem holds with any ties: they make a smaller space of velocities.
inline void tie_light_nodes(const std::vector<NodeRow>& rows, GrainNodes& nodes) {
    constexpr double light = 1e-2;  // of the mass of the neighbor
    const auto mass = [&](long slot) { return nodes.sums[static_cast<std::size_t>(slot)].m; };
    std::vector<Tie> ties;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const NodeRow& row = rows[r];
        for (long i = row.first; i < row.end; ++i) {
            const long slot = row.origin + i;
            if (!(mass(slot) > nodes.least_mass())) continue;
            const long heaviest = heaviest_neighbor(rows, static_cast<long>(r), i, nodes);
            if (mass(slot) < light * mass(heaviest)) ties.push_back({slot, heaviest});
        }
    }
    tie_nodes(ties, nodes);
}

}  // namespace mpm_implicit
