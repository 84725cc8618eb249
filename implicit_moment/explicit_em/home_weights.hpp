// Which mesh values a particle of explicit_em touches: splines of order l around its home.
//
// The home of a particle is the piece of the mesh within which its splines are one polynomial:
// with linear splines (l = 1) a cell, with quadratic ones (l = 2) the surroundings of the nearest
// node. All particles of a home read and write the same few points, so nothing in a loop over them
// depends on where they are; a path that leaves its home is cut at the border.
#pragma once

#include <algorithm>

#include "common/splines.hpp"
#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// The weights of a particle at distance d from its home's reference point (l = 1: the cell's low
/// node; l = 2: the nearest node), in cells:
///     node[0..l]   = S^(l) to the nodes, from the lowest that it touches
///     half[0..l-1] = S^(l-1) to the midpoints between them
/// Real is double or SimdVector.
/// exact:  d node[k] / dd = half[k-1] - half[k], from which charge conservation follows.
template <int l, class Real>
struct HomeWeights;

template <class Real>
struct HomeWeights<1, Real> {
    Real node[2];
    static constexpr double half[1]{1};

    explicit HomeWeights(const Real& d) : node{1 - d, d} {}
};

template <class Real>
struct HomeWeights<2, Real> {
    Real node[3], half[2];

    explicit HomeWeights(const Real& d)
        : node{0.5 * (0.5 - d) * (0.5 - d), 0.75 - d * d, 0.5 * (0.5 + d) * (0.5 + d)},
          half{0.5 - d, 0.5 + d} {}
};

/// The homes along one direction.
template <int l>
struct Homes {
    static constexpr double low = l == 1 ? 0 : -0.5, high = l == 1 ? 1 : 0.5;  // borders, in d
    static constexpr long first = l == 1 ? 0 : -1;  // lowest node that is touched, from the home

    /// Cells; or all nodes, also in a periodic direction, where 0 and N hold half a cell each.
    static long count(const common::Axis& axis) { return l == 1 ? axis.cells : axis.cells + 1; }

    /// in: s, position in cells from node 0, within [0, N].
    static long of(const common::Axis& axis, double s) {
        return l == 1 ? std::min(static_cast<long>(s), axis.cells - 1) : static_cast<long>(s + 0.5);
    }

    /// The borders of a home within the mesh: nothing is behind a wall.
    static double low_of(const common::Axis& axis, long home) {
        return !axis.periodic && home == 0 ? 0.0 : low;
    }
    static double high_of(const common::Axis& axis, long home) {
        return !axis.periodic && home == count(axis) - 1 ? (l == 1 ? 1.0 : 0.0) : high;
    }
};

}  // namespace implicit_moment
