// What particles with a given density put on the nodes.
#pragma once

#include "common/splines.hpp"

namespace implicit_moment {

/// What a smooth distribution f(x) of particles puts on the node at x: the integral of f S^(2).
/// exact: for constant and linear f; otherwise by the midpoint rule, to 1e-4 of what S^(2) changes.
template <class Function>
double spline_average(const Function& f, double x, double dx) {
    constexpr int points = 120;
    double sum = 0;
    for (int k = 0; k < points; ++k) {
        const double s = 3 * ((k + 0.5) / points - 0.5);
        sum += common::spline(2, s) * f(x + s * dx) * 3 / points;
    }
    return sum;
}

}  // namespace implicit_moment
