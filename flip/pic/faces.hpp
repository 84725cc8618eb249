// The faces between the cells of pic: how two cells share the pressure on their face, and what viscosity
// and the weight on a wall add to it. lagrangian_phase.hpp says what it is for.
#pragma once

#include "flip/pic/pic_cells.hpp"

namespace flip {

namespace detail {

// The part w of a cell in the face to another; 0 beside an empty one.
inline double part_of_face(Values weight, long here, long beyond) {
    return weight[beyond] / (weight[here] + weight[beyond] + 1e-300);
}
// What cells share a face by: densities under gravity, else alike.
inline Values weight_of_face(const PicCells& cells) {
    return cells.falls ? cells.rho : cells.filled;
}

// The pressure between two cells, w the part of the left one; none where one of them is empty.
inline double face_pressure(Values filled, Values p, long left, long right, double w, double q) {
    return filled[left] * filled[right] * (w * p[left] + (1 - w) * p[right] + q);
}

// Viscous pressure on the faces below row j, and between its cells, with the harmonic mean of their
// densities: more would throw a light cell about beside a heavy one, or need short steps. And the part
// of the cell before each face.
inline void find_faces(const Grid& grid, const ArtificialViscosity& given, long j,
                       PicCells& cells) {
    const long nx = grid.x.cells, stride = grid.stride();
    const ArtificialViscosity viscosity = given;
    const Values filled = cells.filled, rho = cells.rho, c = cells.c;
    const CellVelocity* v = cells.v.data();
    const long n = grid.index(0, j);
    const Values weight = weight_of_face(cells);
    const auto q = [=](long a, long b, double du) {
        const double mean = 2 * rho[a] * rho[b] / (rho[a] + rho[b] + 1e-300);
        return filled[a] * filled[b] * viscosity(mean, 0.5 * (c[a] + c[b]), du);
    };
    double *q_x = cells.q_x.data(), *q_z = cells.q_z.data(), *part_x = cells.part_x.data(),
           *part_z = cells.part_z.data();
    if (j < grid.z.cells) {
#pragma omp simd
        for (long m = n; m <= n + nx; ++m) {
            q_x[m] = q(m - 1, m, v[m].x - v[m - 1].x);
            part_x[m] = part_of_face(weight, m - 1, m);
        }
    }
    if (is_plane(grid)) {
#pragma omp simd
        for (long m = n; m < n + nx; ++m) {
            q_z[m] = q(m - stride, m, v[m].z - v[m - stride].z);
            part_z[m] = part_of_face(weight, m - stride, m);
        }
    }
}

// A wall carries the weight of the half of a cell that rests on it, as far as its pressure can.
inline void add_weight_on_walls(const Problem& problem, PicCells& cells) {
    for (const Side side : all_sides) {
        if (!problem.boundaries.is(side, BoundaryKind::slip)) continue;
        const bool low = is_low_side(side), along_x = is_x_side(side);
        const double h = (along_x ? problem.grid.x : problem.grid.z).spacing(),
                     a = along_x ? problem.body_force.gravity_x : problem.body_force.gravity_z;
        Field& q = along_x ? cells.q_x : cells.q_z;
        for_each_ghost(problem.grid, side, [&](long ghost, long inside) {
            q[low ? inside : ghost] +=
                ((a < 0) == low ? 1 : -1) *
                std::min(0.5 * h * std::fabs(a) * cells.rho[inside], cells.p[inside]);
            // About the axis the centrifugal force falls to zero within the cell there.
            if (!problem.swirl || !along_x) return;
            q[low ? inside : ghost] +=
                (low ? -0.25 : 0.5) *
                std::min(h * cells.centrifugal[inside] * cells.rho[inside], cells.p[inside]);
        });
    }
}

// Sum of of_face(inside, beyond, q) over the faces on one side, times the lengths of their rings, with
// the cells on both sides of a face and its viscous pressure.
template <class OfFace>
double sum_over_faces(const Grid& grid, const PicCells& cells, Side side, const OfFace& of_face) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    const bool low = is_low_side(side);
    double sum = 0;
    if (is_x_side(side)) {
        for (long j = 0; j < nz; ++j)
            sum += cells.ring[low ? 1 : nx] * of_face(grid.index(low ? 0 : nx - 1, j),
                                                      grid.index(low ? -1 : nx, j),
                                                      cells.q_x[grid.index(low ? 0 : nx, j)]);
    } else {
        for (long i = 0; i < nx; ++i)
            sum += cells.ring[i + 1] * of_face(grid.index(i, low ? 0 : nz - 1),
                                               grid.index(i, low ? -1 : nz),
                                               cells.q_z[grid.index(i, low ? 0 : nz)]);
    }
    return sum;
}

}  // namespace detail

}  // namespace flip
