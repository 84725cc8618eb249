// on the mesh: the operators between nodes and cells, and artificial viscosity, which makes of a shock
// a layer of a few cells.
//
// Force and work are one operator and its transpose, so what the nodes gain the cells lose, to
// round-off:  sum_g F_g . v_g = sum_c p_c V_c (div v)_c  for any v on the nodes.
#pragma once

#include "flip/boundaries.hpp"
#include "flip/flip/find_pressure.hpp"

namespace flip {

namespace detail {

// [rings]
// The rate of change of the volume of a ring whose sides stay straight: its corners move by v, and
// L is the length of a ring. What flows through the side between r_1 and r_2 is the integral of
// 2 pi r v_z dr, with weights (2 r_1 + r_2)/6 and (r_1 + 2 r_2)/6: L at a third and at two thirds.
inline double dilation_of_ring(const Grid& grid, const Field& vx, const Field& vz, long n) {
    const long up = n + grid.stride();
    const double i = static_cast<double>(column_of(grid, n));
    return 0.5 * grid.z.spacing() *
               (ring_length(grid, i + 1) * (vx[n + 1] + vx[up + 1]) -
                ring_length(grid, i) * (vx[n] + vx[up])) +
           0.5 * grid.x.spacing() *
               (ring_length(grid, i + 1. / 3) * (vz[up] - vz[n]) +
                ring_length(grid, i + 2. / 3) * (vz[up + 1] - vz[n + 1]));
}

// Its transpose. Uniform pressure pushes no node, so that there is no hoop term to balance.
inline Eigen::Vector2d pressure_force_of_rings(const Grid& grid, const Field& p, long n) {
    const long down = n - grid.stride();
    const double i = static_cast<double>(column_of(grid, n));
    return {
        0.5 * grid.z.spacing() * ring_length(grid, i) * (p[down - 1] + p[n - 1] - p[down] - p[n]),
        0.5 * grid.x.spacing() *
            (ring_length(grid, i - 1. / 3) * (p[down - 1] - p[n - 1]) +
             ring_length(grid, i + 1. / 3) * (p[down] - p[n]))};
}
// [/rings]

}  // namespace detail

// [transpose]
/// V_c div v of a cell, from its four nodes.
inline double dilation(const Grid& grid, const Field& vx, const Field& vz, long n) {
    const long up = n + grid.stride();
    if (grid.axisymmetric) return detail::dilation_of_ring(grid, vx, vz, n);
    return 0.5 * grid.z.spacing() * (vx[n + 1] + vx[up + 1] - vx[n] - vx[up]) +
           0.5 * grid.x.spacing() * (vz[up] + vz[up + 1] - vz[n] - vz[n + 1]);
}

/// Force of the pressures of the four cells around a node; the transpose of dilation().
inline Eigen::Vector2d pressure_force(const Grid& grid, const Field& p, long n) {
    const long down = n - grid.stride();
    if (grid.axisymmetric) return detail::pressure_force_of_rings(grid, p, n);
    return {0.5 * grid.z.spacing() * (p[down - 1] + p[n - 1] - p[down] - p[n]),
            0.5 * grid.x.spacing() * (p[down - 1] + p[down] - p[n - 1] - p[n])};
}
// [/transpose]

/// The strain rate of a cell, mean times volume: grad v + grad v^T over 2, and v_r/r about the axis.
/// exact:  its trace is dilation()
inline CellTensor strain_rate(const Grid& grid, const Field& vx, const Field& vz, long n) {
    const long up = n + grid.stride();
    const double i = static_cast<double>(column_of(grid, n)), dx = 0.5 * grid.x.spacing(),
                 side = 0.5 * grid.z.spacing() * ring_length(grid, i + 0.5),
                 left = dx * ring_length(grid, i + 1. / 3),
                 right = dx * ring_length(grid, i + 2. / 3);
    const auto along_x = [&](const Field& v) {
        return side * (v[n + 1] + v[up + 1] - v[n] - v[up]);
    };
    const auto along_z = [&](const Field& v) {
        return left * (v[up] - v[n]) + right * (v[up + 1] - v[n + 1]);
    };
    const double hoop =
        grid.axisymmetric ? 0.5 * pi * grid.cell_area() * (vx[n] + vx[n + 1] + vx[up] + vx[up + 1])
                          : 0;
    return {along_x(vx), along_z(vz), 0.5 * (along_z(vx) + along_x(vz)), hoop};
}

/// Force of the stresses of the four cells around a node; the transpose of strain_rate().
inline Eigen::Vector2d stress_force(const Grid& grid, const std::vector<CellTensor>& q, long n) {
    const long down = n - grid.stride();
    const CellTensor &a = q[down - 1], &b = q[down], &c = q[n - 1], &d = q[n];
    const double i = static_cast<double>(column_of(grid, n)), dx = 0.5 * grid.x.spacing(),
                 dz = 0.5 * grid.z.spacing(), side_left = dz * ring_length(grid, i - 0.5),
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
inline double power(const Grid& grid, const CellTensor& q, const Field& vx, const Field& vz,
                    long n) {
    if (q.trace() == 0) return 0;
    const CellTensor e = strain_rate(grid, vx, vz, n);
    return q.xx * e.xx + q.zz * e.zz + 2 * q.xz * e.xz + q.hoop * e.hoop;
}

/// How a scalar viscosity is shared among the directions that are squeezed, in proportion.
///   N = eps^-/tr eps^-,  eps^- the strain rate without its positive principal values
/// in:     a strain rate with a negative trace
/// exact:  trace 1; in a plane shock n n, n its normal; the same in any frame of axes
/// note:   q as a pressure would push along a curved shock, too: a blast of 50 cells would run as if
///         it had a seventh more energy
inline CellTensor share_of_squeezed(const CellTensor& e) {
    const double mean = 0.5 * (e.xx + e.zz), half = 0.5 * (e.xx - e.zz),
                 apart = std::sqrt(half * half + e.xz * e.xz),  // principal values: mean +- apart
        higher = std::min(mean + apart, 0.0), lower = std::min(mean - apart, 0.0),
                 hoop = std::min(e.hoop, 0.0);
    const double both = 0.5 * (higher + lower),
                 turn = apart > 0 ? 0.5 * (higher - lower) / apart : 0;
    const CellTensor squeezed{both + turn * half, both - turn * half, turn * e.xz, hoop};
    return squeezed * (1 / squeezed.trace());
}

/// Artificial viscosity of every cell, from the velocity that the walls let stand.
///   q N,  q = rho (-d) h (linear c + quadratic h (-d)),  d = div v < 0,  h = dx, or sqrt(dx dz)
/// out:    nodes.vx0, vz0; cells.q, 0 in a cell that expands, is empty or partly void
inline void find_viscosity(const Grid& grid, const Boundaries& boundaries,
                           const ArtificialViscosity& q, Mesh& mesh) {
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    for_each_node(grid, [&](long, long, long n) {
        g.vx0[n] = g.vx[n];
        g.vz0[n] = g.vz[n];
    });
    set_walls(grid, boundaries, g.vx0, g.vz0);
    const double area = grid.cell_area(), h = is_plane(grid) ? std::sqrt(area) : grid.x.spacing();
    for_each_cell(grid, [&](long i, long, long n) {
        c.q[n] = {};
        const double V_c = area * ring_length(grid, static_cast<double>(i) + 0.5),
                     d = dilation(grid, g.vx0, g.vz0, n) / V_c;
        CellTensor strain = strain_rate(grid, g.vx0, g.vz0, n);
        if (!is_plane(grid)) strain.zz = strain.xz = 0;
        if (!(d < 0 && strain.trace() < 0) || c.M[n] <= 0 || c.surface[n] != 0) return;
        const double rho = density_of(c, i, n), sound = sound_speed(rho, c.compressibility[n]);
        c.q[n] =
            share_of_squeezed(strain) * (rho * -d * h * (q.linear * sound - q.quadratic * h * d));
    });
}

/// Lowers the artificial viscosity of rings, and of cells with several materials, to what stops the
/// compression of a cell within the step.
///   q <= -D v^0/(dt D M^-1 D^T),  D that of dilation()
/// note:   more would throw apart nodes lighter than the cell, of air by water or of a near void
inline void limit_viscosity(const Grid& grid, double dt, Mesh& mesh) {
    const Nodes& g = mesh.nodes;
    const auto mixed = [&](long n) {
        const auto first = mesh.cells.sum.begin() + n * mesh.materials,
                   end = first + mesh.materials;
        return std::count_if(first, end, [](const CellSum& sum) { return sum.M > 0; }) > 1;
    };
    const double dx = is_plane(grid) ? grid.x.spacing() : 0;  // in a row nothing moves along z
    for_each_cell(grid, [&](long i, long, long n) {
        CellTensor& q = mesh.cells.q[n];
        if (q.trace() == 0 || !(grid.axisymmetric || mixed(n))) return;
        double response = 0;  // D M^-1 D^T, of this cell alone
        for (const long side : {0, 1}) {
            const double node = static_cast<double>(i),
                         along_r =
                             grid.z.spacing() * ring_length(grid, node + static_cast<double>(side)),
                         along_z = dx * ring_length(grid, node + static_cast<double>(1 + side) / 3);
            for (const long corner : {n + side, n + side + grid.stride()})
                response += 0.25 * (along_r * along_r + along_z * along_z) / g.m[corner];
        }
        q = q * std::min(1.0, -dilation(grid, g.vx0, g.vz0, n) / (dt * response * q.trace()));
    });
}

}  // namespace flip
