// Walls that particles do not pass.
#pragma once

#include <cmath>
#include <limits>

#include "mpm_explicit/grid/mesh.hpp"

namespace mpm {

/// Frictional walls, which stop a particle that the nodes would carry through: of a grain in
/// contact they hold the nodes, and single particles may still be faster than those. They stop just
/// before an upper wall: at it they would be in the cell behind, whose far nodes nothing holds.
struct ClampToWalls {
    double x_least, x_most, y_least, y_most;

    explicit ClampToWalls(const Mesh& mesh) {
        constexpr double far = std::numeric_limits<double>::infinity();
        const auto before = [&](double wall) {
            return wall - 1e-9 * mesh.h - 1e-15 * std::fabs(wall);
        };
        x_least = mesh.has(x_low, Boundary::frictional) ? mesh.x_low : -far;
        x_most = mesh.has(x_high, Boundary::frictional) ? before(mesh.x_high()) : far;
        y_least = mesh.has(y_low, Boundary::frictional) ? mesh.y_low : -far;
        y_most = mesh.has(y_high, Boundary::frictional) ? before(mesh.y_high()) : far;
    }
    double x(double at) const { return at < x_least ? x_least : at > x_most ? x_most : at; }
    double y(double at) const { return at < y_least ? y_least : at > y_most ? y_most : at; }
    // A velocity that led on into a wall, from which it was put back by so much.
    static double stopped(double v, double back) { return v * back < 0 ? 0 : v; }
};

}  // namespace mpm
