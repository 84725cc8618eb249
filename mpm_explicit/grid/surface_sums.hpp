// What the outline of a grain puts on a node, side by side.
#pragma once

#include <array>

namespace mpm {

/// What one side of the outline of a grain puts on a node (surface.hpp).
struct SideSums {
    double x, y;            // area vectors:  sum S A
    double xx, xy, yx, yy;  // their moments: sum S A_x x_s, A_x y_s, A_y x_s, A_y y_s

    void operator+=(const SideSums& other) {
        x += other.x, y += other.y;
        xx += other.xx, xy += other.xy, yx += other.yx, yy += other.yy;
    }
    SideSums times(double f) const { return {f * x, f * y, f * xx, f * xy, f * yx, f * yy}; }
};
/// The same of surfaces that are moved by (dx, dy).
inline SideSums moved(const SideSums& s, double dx, double dy) {
    return {s.x, s.y, s.xx + s.x * dx, s.xy + s.x * dy, s.yx + s.y * dx, s.yy + s.y * dy};
}

/// What the outline of a grain puts on a node: of sides that meet at a sharp corner, each for itself.
struct SurfaceSums {
    std::array<SideSums, 2> sides{};
    void operator+=(const SurfaceSums& other) {
        sides[0] += other.sides[0], sides[1] += other.sides[1];
    }
};
inline SurfaceSums moved(const SurfaceSums& s, double dx, double dy) {
    return {{moved(s.sides[0], dx, dy), moved(s.sides[1], dx, dy)}};
}

}  // namespace mpm
