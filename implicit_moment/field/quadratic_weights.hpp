// The weights that a particle shares with the nine nodes around it, in each direction.
#pragma once

namespace implicit_moment {

/// The splines of common/splines.hpp that a particle at distance d (in cells, |d| <= 1/2) from its
/// nearest node gives to its neighbors:
///     quadratic[0..2] = S^(2) to the nodes -1, 0, +1
///     linear[0..1]    = S^(1) to the midpoints -1/2, +1/2
/// Real is double, or SimdVector for several particles at once. S^(0) to the nearest node is 1.
template <class Real>
struct QuadraticWeights {
    Real quadratic[3];
    Real linear[2];

    /// in: d, distance from the nearest node in cells, -1/2 <= d <= 1/2
    explicit QuadraticWeights(const Real& d)
        : quadratic{0.5 * (0.5 - d) * (0.5 - d), 0.75 - d * d, 0.5 * (0.5 + d) * (0.5 + d)},
          linear{0.5 - d, 0.5 + d} {}
};

}  // namespace implicit_moment
