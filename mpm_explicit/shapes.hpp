// Shape functions S_ip = S(x_p - x_i) and their gradients, one direction at a time.
//
//   linear     the talk's: area weighting, two nodes per direction, gradient constant in the cell
//   gimp       linear, averaged over the particle's own square or rectangle (uGIMP): the gradient is continuous
//   quadratic  the B-spline S^(2): three nodes per direction
//
// In two dimensions S_ip = S(x) S(y) and grad S_ip = (S'(x) S(y), S(x) S'(y)).
// exact:  sum_i S_ip = 1, sum_i grad S_ip = 0, sum_i S_ip x_i = x_p, everywhere
#pragma once

#include <cmath>

namespace mpm {

/// Weights of one direction: nodes first ... first + width - 1.
template <int width_>
struct Weights {
    static constexpr int width = width_;
    int first;
    double S[width_];
    double G[width_];  // per length
};

/// x_p in cells from node 0; per_h = 1/h.
struct LinearShape {
    static constexpr int width = 2;
    static constexpr bool has_sides = false;  // whether particles may have their own
    static constexpr double least = 1e-15;    // weight: round-off
    Weights<2> operator()(double x, double per_h) const {
        // On a line of nodes, the node beyond is seen a little: a gradient asks for its velocity.
        const double cell = std::floor(x), way = x - cell, d = way > least ? way : least;
        return {static_cast<int>(cell), {1 - d, d}, {-per_h, per_h}};
    }
};

struct QuadraticShape {
    static constexpr int width = 3;
    static constexpr bool has_sides = false;
    Weights<3> operator()(double x, double per_h) const {
        const double node = std::floor(x + 0.5), d = x - node;
        return {static_cast<int>(node) - 1,
                {0.5 * (0.5 - d) * (0.5 - d), 0.75 - d * d, 0.5 * (0.5 + d) * (0.5 + d)},
                {(d - 0.5) * per_h, -2 * d * per_h, (d + 0.5) * per_h}};
    }
};

/// half: half the particle's side, in cells, at most 1/2.
struct GimpShape {
    static constexpr int width = 3;
    static constexpr bool has_sides = true;
    double half = 0.25;

    Weights<3> operator()(double x, double per_h) const {
        const double node = std::floor(x + 0.5), d = x - node;
        // The particle covers low ... high, seen from its nearest node; behind and before it:
        const double low = d - half, high = d + half;
        const double behind_low = low < 0 ? low : 0, behind_high = high < 0 ? high : 0,
                     before_low = low > 0 ? low : 0, before_high = high > 0 ? high : 0;
        const double per_side = 0.5 / half, share = (behind_high - behind_low) * per_side;
        const double S_behind =
                         0.5 * per_side * (behind_low * behind_low - behind_high * behind_high),
                     S_before =
                         0.5 * per_side * (before_high * before_high - before_low * before_low);
        return {static_cast<int>(node) - 1,
                {S_behind, 1 - S_behind - S_before, S_before},
                {-share * per_h, (2 * share - 1) * per_h, (1 - share) * per_h}};
    }
};

}  // namespace mpm
