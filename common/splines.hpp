// B-splines S^(0) ... S^(3), the shape functions of the whole family.
//
// S^(l) is the l-fold convolution of the top-hat with itself, in units of the cell: symmetric, unit
// integral, support (l+1) cells, l-1 continuous derivatives. Everything the methods rely on follows
// from two facts. Totals on the mesh are totals of the particles, and a derivative is a difference
// of the next lower spline:
//     sum_g S^(l)(x - g) = 1
//     d S^(l)/dx (x)     = S^(l-1)(x + 1/2) - S^(l-1)(x - 1/2)
#pragma once

#include <cmath>

namespace common {

/// S^(order)(x) with x in cells, order 0 to 3. The top-hat is 1 on [-1/2, 1/2).
inline double spline(int order, double x) {
    if (order == 0) return x >= -0.5 && x < 0.5 ? 1.0 : 0.0;
    const double r = std::fabs(x);
    if (order == 1) return r < 1 ? 1 - r : 0;
    if (order == 2) return r < 0.5 ? 0.75 - r * r : r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0;
    return r < 1 ? 2.0 / 3 - r * r + 0.5 * r * r * r : r < 2 ? (2 - r) * (2 - r) * (2 - r) / 6 : 0;
}

}  // namespace common
