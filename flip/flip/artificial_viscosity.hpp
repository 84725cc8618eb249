// on the mesh: artificial viscosity, which makes of a shock a layer of a few cells.
#pragma once

#include <cmath>

#include "flip/boundaries.hpp"
#include "flip/flip/cell_operators.hpp"
#include "flip/flip/find_pressure.hpp"

namespace flip {

/// How a scalar viscosity is shared among the directions that are squeezed, in proportion.
///   N = eps^-/tr eps^-,  eps^- the strain rate without its positive principal values
/// in:     a strain rate with a negative trace
/// exact:  trace 1; in a plane shock n n, n its normal; the same in any frame of axes
/// note:   q as a pressure would push along a curved front, too: Sedov's sphere would run as if it
///         had a seventh more energy at a radius of 50 cells
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
    const double h = is_plane(grid) ? std::sqrt(grid.cell_area()) : grid.x.spacing();
    for_each_cell(grid, [&](long i, long, long n) {
        c.q[n] = {};
        CellTensor strain = strain_rate(grid, g.vx0, g.vz0, n);
        if (!is_plane(grid)) strain.zz = strain.xz = 0;
        const double d = strain.trace() / cell_volume(grid, i);
        if (!(d < 0) || c.M[n] <= 0 || c.surface[n] != 0) return;
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
