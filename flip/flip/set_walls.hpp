// The rows of the mesh that belong to its ends: what velocity a node has there, and what pressure
// stands outside.
#pragma once

#include "flip/flip/mesh.hpp"

namespace flip {

inline bool holds_tangential(const Boundary& end) {
    return end.kind == BoundaryKind::no_slip || end.kind == BoundaryKind::inflow;
}
/// Whether the end keeps the fluid's velocity from changing across it.
inline bool holds_normal(const Boundary& end) {
    return end.kind == BoundaryKind::slip || holds_tangential(end);
}

/// Which components of a node are given by the ends that it lies on.
struct Held {
    bool x = false, z = false;
    double vx = 0, vz = 0;
};

/// in:     i from 0 to cells_x, j from 0 to cells_z
inline Held held_at(const Problem& problem, long i, long j) {
    Held held;
    const auto meet = [&](Side e) {
        const Boundary& end = problem.boundaries.side[e];
        const bool along_x = e == x_low || e == x_high;
        const double normal = end.kind != BoundaryKind::inflow ? 0
                              : along_x                        ? problem.boundaries.inflow.vx
                                                               : problem.boundaries.inflow.vz;
        const double tangential = end.kind != BoundaryKind::inflow ? end.slide
                                  : along_x                        ? problem.boundaries.inflow.vz
                                                                   : problem.boundaries.inflow.vx;
        if (holds_normal(end)) {
            (along_x ? held.x : held.z) = true;
            (along_x ? held.vx : held.vz) = normal;
        }
        if (holds_tangential(end) && !(along_x ? held.z : held.x)) {
            (along_x ? held.z : held.x) = true;
            (along_x ? held.vz : held.vx) = tangential;
        }
    };
    if (i == 0) meet(x_low);
    if (i == problem.grid.x.cells) meet(x_high);
    if (j == 0) meet(z_low);
    if (j == problem.grid.z.cells) meet(z_high);
    return held;
}

/// Sets the components of nodes that the ends of the mesh hold.
/// in/out: velocities on the nodes
inline void set_walls(const Problem& problem, Field& vx, Field& vz) {
    const Grid& grid = problem.grid;
    const auto set = [&](long i, long j) {
        const Held held = held_at(problem, i, j);
        const long n = grid.index(i, j);
        if (held.x) vx[n] = held.vx;
        if (held.z) vz[n] = held.vz;
    };
    for (long i = 0; i <= grid.x.cells; ++i) set(i, 0), set(i, grid.z.cells);
    for (long j = 0; j <= grid.z.cells; ++j) set(0, j), set(grid.x.cells, j);
}

/// Force of the pressure outside of open ends on a node, half as much on a corner.
/// in:     i from 0 to cells_x, j from 0 to cells_z
inline Eigen::Vector2d outside_force(const Problem& problem, long i, long j) {
    const auto reach = [](const common::Axis& axis, long k) {
        const bool corner = !axis.periodic && (k == 0 || k == axis.cells);
        return corner ? 0.5 * axis.spacing() : axis.spacing();
    };
    const auto press = [&](Side e, bool on) {
        return on && problem.boundaries.is(e, BoundaryKind::open)
                   ? problem.boundaries.side[e].pressure
                   : 0;
    };
    return {reach(problem.grid.z, j) *
                (press(x_low, i == 0) - press(x_high, i == problem.grid.x.cells)),
            reach(problem.grid.x, i) *
                (press(z_low, j == 0) - press(z_high, j == problem.grid.z.cells))};
}

/// Fills the ring of ghost cells: around a periodic direction the other side, else nothing. A wall
/// holds its nodes itself, and outside_force() is what presses on an open end.
inline void fill_pressure(const Grid& grid, Field& p) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    for (long j = 0; j < nz; ++j) {
        p[grid.index(-1, j)] = grid.x.periodic ? p[grid.index(nx - 1, j)] : 0;
        p[grid.index(nx, j)] = grid.x.periodic ? p[grid.index(0, j)] : 0;
    }
    for (long i = -1; i <= nx; ++i) {
        p[grid.index(i, -1)] = grid.z.periodic ? p[grid.index(i, nz - 1)] : 0;
        p[grid.index(i, nz)] = grid.z.periodic ? p[grid.index(i, 0)] : 0;
    }
}

}  // namespace flip
