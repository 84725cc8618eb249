// Walls that particles do not pass.
#pragma once

#include <limits>

#include "mpm_explicit/mesh.hpp"

namespace mpm {

/// Frictional walls, which stop a particle that the nodes would carry through: of a grain in
/// contact they hold the nodes, and single particles may still be faster than those. They stop just
/// before an upper wall: at it they would be in the cell behind, whose far nodes nothing holds.
struct ClampToWalls {
    double x_least, x_most, y_least, y_most;

    explicit ClampToWalls(const Mesh& mesh) {
        constexpr double far = std::numeric_limits<double>::infinity();
        const double before = 1e-9 * mesh.h;
        x_least = mesh.has(x_low, Boundary::frictional) ? mesh.x_low : -far;
        x_most = mesh.has(x_high, Boundary::frictional) ? mesh.x_high() - before : far;
        y_least = mesh.has(y_low, Boundary::frictional) ? mesh.y_low : -far;
        y_most = mesh.has(y_high, Boundary::frictional) ? mesh.y_high() - before : far;
    }
    double x(double at) const { return at < x_least ? x_least : at > x_most ? x_most : at; }
    double y(double at) const { return at < y_least ? y_least : at > y_most ? y_most : at; }
};

}  // namespace mpm
