// Water behind a dam that vanishes: shallow water theory, and the scales of Martin and Moyce.
#pragma once

#include <cmath>

namespace flip::theory {

/// Water of depth H at x < 0 on a dry bed; the dam at x = 0 vanishes at t = 0.
struct DamBreak {
    double depth, gravity;  // H, g
};

struct ShallowWater {
    double depth, velocity;
};

/// The speed of the front.
///   2 (g H)^1/2
inline double dam_front_speed(const DamBreak& d) { return 2.0 * std::sqrt(d.gravity * d.depth); }

/// Depth and velocity at x = (x / t) t, while the wave has not reached a wall.
///   h = (2 c - x / t)^2 / (9 g),  u = 2 (c + x / t) / 3,  c = (g H)^1/2,  for -c < x / t < 2 c
/// exact: at the dam 4 H / 9 and 2 c / 3; the mass and the momentum of water that is shallow
/// source: Ritter, Z. Ver. Dtsch. Ing. 36, 947 (1892).
inline ShallowWater dam_break_at(const DamBreak& d, double x_over_t) {
    const double c = std::sqrt(d.gravity * d.depth);
    if (x_over_t <= -c) return {d.depth, 0.0};
    if (x_over_t >= 2.0 * c) return {0.0, 0.0};
    const double left = 2.0 * c - x_over_t;
    return {left * left / (9.0 * d.gravity), 2.0 / 3.0 * (c + x_over_t)};
}

/// The time of Martin and Moyce, for a column of width a and height n^2 a.
///   T = t (n^2 g / a)^1/2
/// exact: Ritter's front is at x / a = 1 + 2 T from the wall behind the column
/// source: Martin and Moyce, Phil. Trans. R. Soc. London A 244, 312 (1952).
inline double column_time(double t, double width, double height, double gravity) {
    return t * std::sqrt(height * gravity) / width;
}

}  // namespace flip::theory
