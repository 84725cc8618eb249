// A uniform rectangular mesh in the (x, z) plane, staggered, with one ring of ghost points; each
// direction is periodic or has walls.
//
//        i     i+1/2    i+1
//   j    o-------x-------o        o  node    (i, j)              rho, E_y, J_y
//        |               |        x  x-edge  (i+1/2, j)          E_x, J_x, B_z
//  j+1/2 z       f       |        z  z-edge  (i, j+1/2)          E_z, J_z, B_x
//        |               |        f  face    (i+1/2, j+1/2)      B_y
//  j+1   o---------------o
//
// Nodes run from 0 to N in each direction; in a periodic one node N is node 0 again, in others walls
// stand on both. The value of any kind of point (i [+1/2], j [+1/2]) sits at index(i, j), -1 to N+1.
#pragma once

#include <Eigen/Core>

namespace common {

struct Axis {
    long cells = 0;
    double low = 0;     // coordinate of node 0 [length]
    double length = 0;  // [length]
    bool periodic = true;
    bool mirrors = false;  // its walls mirror the plasma, see felt in implicit_moment

    /// Distance between neighboring nodes.
    double spacing() const { return length / double(cells); }
    /// Coordinate of the upper boundary.
    double high() const { return low + length; }
    /// Coordinate of a node; a fraction lies between nodes.
    double at(double node) const { return low + node * spacing(); }
};

struct Grid {
    Axis x, z;
    bool axisymmetric = false;  // x is the distance r from the axis x = 0, and a cell is a ring

    /// Numbers per row of nodes: cells + 1 nodes and a ghost node on either side.
    long stride() const { return x.cells + 3; }
    /// Numbers per field, ghost nodes included.
    long size() const { return stride() * (z.cells + 3); }
    /// Place of node (i, j) in a field; i and j begin at -1, the ghost nodes.
    long index(long i, long j) const { return (j + 1) * stride() + i + 1; }
    /// Area of a cell; what a charge is divided by to give a density.
    double cell_area() const { return x.spacing() * z.spacing(); }
};

/// Where a quantity lives: on nodes or half-way between them, in each direction.
struct Place {
    bool half_x, half_z;
};
inline constexpr Place on_nodes{false, false}, on_x_edges{true, false}, on_z_edges{false, true},
    on_faces{true, true};

/// How a quantity continues behind a wall normal to x, and behind one normal to z: +1 even, -1
/// odd (zero on the wall).
struct Parity {
    int x, z;
};

/// One number per point, ghosts included: a column of grid.size() values.
using Field = Eigen::VectorXd;

/// Visits the ghost points beyond both ends of one direction: visit(ghost, interior, sign), the
/// interior point that it is the image of and the sign of the image.
template <class Visit>
void ghosts_along(const Axis& axis, bool half, int parity, const Visit& visit) {
    const long n = axis.cells;
    if (axis.periodic) {
        visit(-1, n - 1, 1);
        visit(n, 0, 1);
        visit(n + 1, 1, 1);
    } else if (half) {
        visit(-1, 0, parity);
        visit(n, n - 1, parity);
    } else {
        visit(-1, 1, parity);
        visit(n + 1, n - 1, parity);
    }
}

/// Copies the interior to the ghost points: periodic images, or mirror images with the given
/// parity behind a wall.
/// in/out: f, grid.size() values. An odd quantity on a node of the wall is set to zero.
inline void fill_ghosts(const Grid& grid, Place place, Parity parity, double* f) {
    const long nx = grid.x.cells, nz = grid.z.cells, stride = grid.stride();
    for (long j = 0; j <= nz; ++j) {
        double* row = f + grid.index(0, j);
        if (!grid.x.periodic && !place.half_x && parity.x < 0) row[0] = row[nx] = 0;
        ghosts_along(grid.x, place.half_x, parity.x,
                     [&](long to, long from, int sign) { row[to] = sign * row[from]; });
    }
    if (!grid.z.periodic && !place.half_z && parity.z < 0)
        for (const long j : {0L, nz}) std::fill_n(f + grid.index(-1, j), stride, 0.0);
    ghosts_along(grid.z, place.half_z, parity.z, [&](long to, long from, int sign) {
        const double* source = f + grid.index(-1, from);
        double* target = f + grid.index(-1, to);
        for (long i = 0; i < stride; ++i) target[i] = sign * source[i];
    });
}

/// Adds what was deposited on the ghost points to the interior points that they stand for; the
/// transpose of fill_ghosts. At a wall the mirror image of every particle is counted with the
/// given parity, so an even quantity on a node of the wall is doubled (its cell is half outside)
/// and an odd one vanishes there. Afterwards the ghosts hold the images.
inline void fold_ghosts(const Grid& grid, Place place, Parity parity, double* f) {
    const long nx = grid.x.cells, nz = grid.z.cells, stride = grid.stride();
    ghosts_along(grid.z, place.half_z, parity.z, [&](long from, long to, int sign) {
        const double* source = f + grid.index(-1, from);
        double* target = f + grid.index(-1, to);
        for (long i = 0; i < stride; ++i) target[i] += sign * source[i];
    });
    if (!grid.z.periodic && !place.half_z) {
        for (const long j : {0L, nz}) {
            double* row = f + grid.index(-1, j);
            for (long i = 0; i < stride; ++i) row[i] += parity.z * row[i];
        }
    }
    for (long j = 0; j <= nz; ++j) {
        double* row = f + grid.index(0, j);
        ghosts_along(grid.x, place.half_x, parity.x,
                     [&](long from, long to, int sign) { row[to] += sign * row[from]; });
        if (!grid.x.periodic && !place.half_x)
            for (const long i : {0L, nx}) row[i] += parity.x * row[i];
    }
    fill_ghosts(grid, place, parity, f);
}

}  // namespace common
