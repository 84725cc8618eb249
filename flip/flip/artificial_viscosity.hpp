// on the mesh: artificial viscosity, which makes of a shock a layer of a few cells.
#pragma once

#include <algorithm>
#include <cmath>

#include "flip/boundaries.hpp"
#include "flip/flip/cell_operators.hpp"
#include "flip/flip/find_pressure.hpp"

namespace flip {

/// Artificial viscosity of one cell: a stress along the directions that are squeezed.
///   sum_k w_k q(h_k) n_k n_k,  q(h) = rho (-d) h (linear c + quadratic h (-d)),  d = div v < 0,
///   w_k = r_k^-/sum r^-,  r_k^- = min(n_k . grad v n_k, 0),  h_k the width of the cell along n_k
/// n_k are the principal directions of grad v^T grad v: those in which the velocity changes most and
/// least. About an axis there is a third, with r = v_r/r.
/// in:     G, the velocity gradient, any multiple; rho c and d of the cell, d < 0
/// exact:  in a plane front q n n, n its normal, whatever slides along it; even squeezing shares q
///         evenly; the same in any frame of axes where the cells are squares
/// note:   q as a pressure would push along a curved front, too: Sedov's sphere would run as if it
///         had a seventh more energy at a radius of 50 cells. The principal directions of the strain
///         rate would turn towards shear, and brake it.
inline CellTensor viscous_stress_of(const Grid& grid, const ArtificialViscosity& q,
                                    const CellGradient& G, double rho, double sound, double d) {
    const double dx = grid.x.spacing(), dz = is_plane(grid) ? grid.z.spacing() : dx;
    const double apart = 0.5 * (G.xx * G.xx + G.zx * G.zx - G.xz * G.xz - G.zz * G.zz),
                 mixed = G.xx * G.xz + G.zx * G.zz, size = std::sqrt(apart * apart + mixed * mixed);
    const double c = size > 0 ? apart / size : 1, s = size > 0 ? mixed / size : 0;
    const double mean = 0.5 * (G.xx + G.zz), half = 0.5 * (c * (G.xx - G.zz) + s * (G.xz + G.zx));
    const double first = std::min(mean + half, 0.0), second = std::min(mean - half, 0.0),
                 hoop = std::min(G.hoop, 0.0), all = first + second + hoop;
    const auto along = [&](double part, double n_x2, double n_z2) {
        const double h = 1 / std::sqrt(n_x2 / (dx * dx) + n_z2 / (dz * dz));
        return part == 0 ? 0 : part / all * rho * -d * h * (q.linear * sound - q.quadratic * h * d);
    };
    const double a = along(first, 0.5 * (1 + c), 0.5 * (1 - c)),
                 b = along(second, 0.5 * (1 - c), 0.5 * (1 + c));
    return {0.5 * (a + b + c * (a - b)), 0.5 * (a + b - c * (a - b)), 0.5 * s * (a - b),
            along(hoop, 1, 0)};
}

/// Artificial viscosity of every cell, from the velocity that the walls let stand.
/// out:    nodes.vx0, vz0; cells.q, 0 in a cell that expands, is empty or partly void
inline void find_viscosity(const Grid& grid, const Boundaries& boundaries,
                           const ArtificialViscosity& q, Mesh& mesh) {
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    for_each_node(grid, [vx = Values(g.vx), vz = Values(g.vz), vx0 = g.vx0.data(),
                         vz0 = g.vz0.data()](long, long, long n) {
        vx0[n] = vx[n];
        vz0[n] = vz[n];
    });
    set_walls(grid, boundaries, g.vx0, g.vz0);
    for_each_cell(grid, [=, &c, vx = Values(g.vx0), vz = Values(g.vz0), M = Values(c.M),
                         q_c = c.q.data(), surface = c.surface.data()](long i, long, long n) {
        q_c[n] = {};
        CellGradient G = velocity_gradient(grid, vx, vz, n);
        if (!is_plane(grid)) G.xz = G.zx = G.zz = 0;
        const double d = (G.xx + G.zz + G.hoop) / cell_volume(grid, i);
        if (!(d < 0) || M[n] <= 0 || surface[n] != 0) return;
        const double rho = density_of(c, i, n), sound = sound_speed(rho, c.compressibility[n]);
        q_c[n] = viscous_stress_of(grid, q, G, rho, sound, d);
    });
}

/// Lowers the artificial viscosity of cells to what stops their compression within the step.
///   q <= -D v^0/(dt D M^-1 D^T),  D that of dilation()
/// note:   more would throw apart nodes lighter than the cell, of air by water or of a near void, and
///         pay for it with energy that the cell may not have; and where sound crosses many cells in an
///         implicit step, any nodes
inline void limit_viscosity(const Grid& grid, double dt, Mesh& mesh) {
    const Nodes& g = mesh.nodes;
    const double dx = is_plane(grid) ? grid.x.spacing() : 0;  // in a row nothing moves along z
    for_each_cell(grid, [=, m = Values(g.m), vx = Values(g.vx0), vz = Values(g.vz0),
                         q_c = mesh.cells.q.data()](long i, long, long n) {
        CellTensor& q = q_c[n];
        if (q.trace() == 0) return;
        double response = 0;  // D M^-1 D^T, of this cell alone
        for (const long side : {0, 1}) {
            const double node = double(i),
                         along_r = grid.z.spacing() * ring_length(grid, node + double(side)),
                         along_z = dx * ring_length(grid, node + double(1 + side) / 3);
            for (const long corner : {n + side, n + side + grid.stride()})
                response += 0.25 * (along_r * along_r + along_z * along_z) / m[corner];
        }
        q = q * std::min(1.0, -dilation(grid, vx, vz, n) / (dt * response * q.trace()));
    });
}

}  // namespace flip
