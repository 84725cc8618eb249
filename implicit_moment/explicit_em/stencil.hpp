// Which mesh values a particle of explicit_em touches: the stencil of its splines of order l.
//
//      l = 1: the cell between two nodes         l = 2: the surroundings of the nearest node
//
//        o------x------o                              :      :      :
//        |  p          |                           o--x---o--x---o
//        z             z   o nodes                    :  p   :       p within half a cell of the
//        |             |   x, z midpoints          o--x---o--x---o    node in the middle
//        o------x------o                              :      :
//
// Both are called a cell here: the piece of the mesh within which the splines of a particle are one
// polynomial. Its index (i, j) anchors the stencil. All particles of a cell read and write the same
// few points, so nothing in a loop over them depends on where they are; a trajectory that leaves its
// cell is cut at the border.
#pragma once

#include <algorithm>

#include "implicit_moment/field/quadratic_weights.hpp"
#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// The weights of a particle at distance d from its anchor (l = 1: the cell's low node; l = 2: the
/// nearest node), in cells:
///     node(0..l)   = S^(l) to the nodes, from the lowest that it touches
///     half(0..l-1) = S^(l-1) to the midpoints between them
/// Real is double or ParticleVector.
/// exact:  d node(k) / dd = half(k-1) - half(k), from which charge conservation follows.
template <int l, class Real>
struct StencilWeights;

template <class Real>
struct StencilWeights<1, Real> {
    Real linear[2];

    explicit StencilWeights(const Real& d) : linear{1 - d, d} {}
    const Real& node(int k) const { return linear[k]; }
    static constexpr NumberOf<Real> half(int) { return 1; }
};

template <class Real>
struct StencilWeights<2, Real> {
    QuadraticWeights<Real> S;

    explicit StencilWeights(const Real& d) : S(d) {}
    const Real& node(int k) const { return S.quadratic[k]; }
    const Real& half(int k) const { return S.linear[k]; }
};

/// The cells along one direction.
template <int l>
struct Stencil {
    static constexpr double low = l == 1 ? 0 : -0.5, high = l == 1 ? 1 : 0.5;  // borders, in d
    static constexpr long first = l == 1 ? 0 : -1;  // lowest node that is touched, from the anchor

    /// How many: between nodes, or around all nodes, where in a periodic direction, too, 0 and N
    /// have half a cell each.
    static long cells(const common::Axis& axis) { return l == 1 ? axis.cells : axis.cells + 1; }

    /// The cell of a position. in: s, in cells from node 0, within [0, N].
    static long cell_of(const common::Axis& axis, double s) {
        return l == 1 ? std::min(long(s), axis.cells - 1) : long(s + 0.5);
    }

    /// A position in cells from the low border of cell 0: its whole part is the cell. in: per_spacing,
    /// 1 over the spacing; Real is double or ParticleVector
    template <class Real>
    static Real from_border(const common::Axis& axis, double per_spacing, const Real& x) {
        using Number = NumberOf<Real>;
        // The product comes last: all round it alike, whether the machine fuses products or not.
        return (x - Number(axis.low + low * axis.spacing())) * Number(per_spacing);
    }

    /// The borders of a cell within the mesh: nothing is behind a wall.
    static double low_of(const common::Axis& axis, long cell) {
        return !axis.periodic && cell == 0 ? 0.0 : low;
    }
    static double high_of(const common::Axis& axis, long cell) {
        return !axis.periodic && cell == cells(axis) - 1 ? (l == 1 ? 1.0 : 0.0) : high;
    }
};

/// The cell of a particle, row by row, to the last digit as the push finds it. in: a position within the mesh
template <int l>
inline int cell_of(const Grid& grid, ParticleReal x, ParticleReal z) {
    const int columns = int(Stencil<l>::cells(grid.x)), rows = int(Stencil<l>::cells(grid.z));
    const int i =
        std::min(int(Stencil<l>::from_border(grid.x, 1 / grid.x.spacing(), x)), columns - 1);
    const int j = std::min(int(Stencil<l>::from_border(grid.z, 1 / grid.z.spacing(), z)), rows - 1);
    return j * columns + i;
}

}  // namespace implicit_moment
