// Operators between nodes and cells: the change of a cell with the velocities of its nodes, and the
// force of cells on a node.
//
// Force and work are one operator and its transpose, so what the nodes gain the cells lose, to
// round-off:  sum_g F_g . v_g = sum_c p_c V_c (div v)_c  for any v on the nodes.
#pragma once

#include "flip/flip/mesh.hpp"

namespace flip {

namespace detail {

// [rings]
// The rate of change of the volume of a ring whose sides stay straight: its corners move by v, and
// L is the length of a ring. What flows through the side between r_1 and r_2 is the integral of
// 2 pi r v_z dr, with weights (2 r_1 + r_2)/6 and (r_1 + 2 r_2)/6: L at a third and at two thirds.
inline double dilation_of_ring(const Grid& grid, Values vx, Values vz, long n) {
    const long up = n + grid.stride();
    const double i = double(column_of(grid, n));
    return 0.5 * grid.z.spacing() *
               (ring_length(grid, i + 1) * (vx[n + 1] + vx[up + 1]) -
                ring_length(grid, i) * (vx[n] + vx[up])) +
           0.5 * grid.x.spacing() *
               (ring_length(grid, i + 1. / 3) * (vz[up] - vz[n]) +
                ring_length(grid, i + 2. / 3) * (vz[up + 1] - vz[n + 1]));
}

// Its transpose. Uniform pressure pushes no node, so that there is no hoop term to balance.
inline Eigen::Vector2d pressure_force_of_rings(const Grid& grid, Values p, long n) {
    const long down = n - grid.stride();
    const double i = double(column_of(grid, n));
    return {
        0.5 * grid.z.spacing() * ring_length(grid, i) * (p[down - 1] - p[down] + (p[n - 1] - p[n])),
        0.5 * grid.x.spacing() *
            (ring_length(grid, i - 1. / 3) * (p[down - 1] - p[n - 1]) +
             ring_length(grid, i + 1. / 3) * (p[down] - p[n]))};
}
// [/rings]

}  // namespace detail

// [transpose]
/// V_c div v of a cell, from its four nodes.
inline double dilation(const Grid& grid, Values vx, Values vz, long n) {
    const long up = n + grid.stride();
    if (grid.axisymmetric) return detail::dilation_of_ring(grid, vx, vz, n);
    return 0.5 * grid.z.spacing() * (vx[n + 1] + vx[up + 1] - vx[n] - vx[up]) +
           0.5 * grid.x.spacing() * (vz[up] + vz[up + 1] - vz[n] - vz[n + 1]);
}

/// Force of the pressures of the four cells around a node; the transpose of dilation().
/// exact:  differences come first, so that a pressure equal to round-off pushes by that of itself alone
inline Eigen::Vector2d pressure_force(const Grid& grid, Values p, long n) {
    const long down = n - grid.stride();
    if (grid.axisymmetric) return detail::pressure_force_of_rings(grid, p, n);
    return {0.5 * grid.z.spacing() * (p[down - 1] - p[down] + (p[n - 1] - p[n])),
            0.5 * grid.x.spacing() * (p[down - 1] - p[n - 1] + (p[down] - p[n]))};
}
// [/transpose]

/// The velocity gradient of a cell, mean times volume: xz is dv_x/dz; and v_r/r about the axis.
/// exact:  its trace is dilation()
struct CellGradient {
    double xx, zz, xz, zx, hoop;
};
inline CellGradient velocity_gradient(const Grid& grid, Values vx, Values vz, long n) {
    const long up = n + grid.stride();
    const double i = grid.axisymmetric ? double(column_of(grid, n)) : 0,
                 dx = 0.5 * grid.x.spacing(),
                 side = 0.5 * grid.z.spacing() * ring_length(grid, i + 0.5),
                 left = dx * ring_length(grid, i + 1. / 3),
                 right = dx * ring_length(grid, i + 2. / 3);
    const auto along_x = [&](Values v) { return side * (v[n + 1] + v[up + 1] - v[n] - v[up]); };
    const auto along_z = [&](Values v) {
        return left * (v[up] - v[n]) + right * (v[up + 1] - v[n + 1]);
    };
    const double hoop =
        grid.axisymmetric ? 0.5 * pi * grid.cell_area() * (vx[n] + vx[n + 1] + vx[up] + vx[up + 1])
                          : 0;
    return {along_x(vx), along_z(vz), along_z(vx), along_x(vz), hoop};
}

/// Force of the stresses of the four cells around a node; the transpose of velocity_gradient().
inline Eigen::Vector2d stress_force(const Grid& grid, const std::vector<CellTensor>& q_c, long n) {
    const CellTensor* const q = q_c.data();
    const long down = n - grid.stride();
    const CellTensor &a = q[down - 1], &b = q[down], &c = q[n - 1], &d = q[n];
    const double i = grid.axisymmetric ? double(column_of(grid, n)) : 0,
                 dx = 0.5 * grid.x.spacing(), dz = 0.5 * grid.z.spacing(),
                 side_left = dz * ring_length(grid, i - 0.5),
                 side_right = dz * ring_length(grid, i + 0.5),
                 left = dx * ring_length(grid, i - 1. / 3),
                 right = dx * ring_length(grid, i + 1. / 3);
    const double hoop =
        grid.axisymmetric ? 0.5 * pi * grid.cell_area() * (a.hoop + b.hoop + c.hoop + d.hoop) : 0;
    return {side_left * (a.xx + c.xx) - side_right * (b.xx + d.xx) + left * (a.xz - c.xz) +
                right * (b.xz - d.xz) + hoop,
            side_left * (a.xz + c.xz) - side_right * (b.xz + d.xz) + left * (a.zz - c.zz) +
                right * (b.zz - d.zz)};
}

/// Work of a stress on a cell per time, V q : grad v.
inline double power(const Grid& grid, const CellTensor& q, Values vx, Values vz, long n) {
    if (q.trace() == 0) return 0;
    const CellGradient G = velocity_gradient(grid, vx, vz, n);
    return q.xx * G.xx + q.zz * G.zz + q.xz * (G.xz + G.zx) + q.hoop * G.hoop;
}

}  // namespace flip
