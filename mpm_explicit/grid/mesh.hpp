// The mesh of the material point method: square cells in the plane (x, y), nodes at their corners.
//
// Node (i, j) is at (x_low + i h, y_low + j h). Cell (i, j) has that node at its lower left. A
// periodic mesh has node cells_x where node 0 is.
#pragma once

#include <array>
#include <cmath>

namespace mpm {

/// What stands on a line of nodes at an end of the mesh.
///   open        nothing; a particle that goes there leaves the mesh, which is an error
///   slip        the normal velocity is zero (a roller, or a plane of symmetry)
///   stick       the velocity is zero (a clamp)
///   frictional  nothing passes, and what presses against it rubs (Coulomb)
enum class Boundary { open, slip, stick, frictional };

enum Side { x_low, x_high, y_low, y_high };

struct Mesh {
    long cells_x = 0, cells_y = 0;
    double h = 0;                 // side of a cell [length]
    double x_low = 0, y_low = 0;  // node (0, 0) [length]
    bool periodic_x = false;
    std::array<Boundary, 4> boundary{Boundary::open, Boundary::open, Boundary::open,
                                     Boundary::open};

    double x_high() const { return x_low + length_x(); }
    double y_high() const { return y_low + h * static_cast<double>(cells_y); }
    double length_x() const { return h * static_cast<double>(cells_x); }

    double x_of(double i) const { return x_low + i * h; }
    double y_of(double j) const { return y_low + j * h; }

    bool has(Side side, Boundary kind) const {
        return boundary[side] == kind &&
               !(periodic_x && (side == Side::x_low || side == Side::x_high));
    }
};

}  // namespace mpm
