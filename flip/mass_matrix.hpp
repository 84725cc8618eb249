// on the mesh: the consistent mass matrix of the nodes, which the lumped masses m_g stand in for.
//
//     M_gh = sum_p m_p S_gp S_hp,      sum_h M_gh = m_g
//
// With it FLIP loses no kinetic energy at all, at the price of a linear system per step. Its
// product with v/m, on the other hand, is one trip from the mesh to the particles and back, which is
// what XPIC filters with.
#pragma once

#include <array>
#include <string>

#include "flip/set_walls.hpp"

namespace flip {

/// A symmetric matrix that couples each node with its eight neighbors, half of it stored: with
/// itself, and the neighbors to the right, above, above right, above left.
struct MassMatrix {
    std::array<Field, 5> entry;
    static constexpr std::array<std::array<long, 2>, 5> to{
        {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {-1, 1}}};
};

/// out:    M, all entries, ghosts filled
/// exact:  symmetric; rows sum to m_g; positive semidefinite
inline void assemble_mass_matrix(const Grid& grid, const Particles& p, MassMatrix& M) {
    for (Field& f : M.entry) f.setZero(grid.size());
    const WeightScale scale(grid);
    common::for_each_row_three_apart(
        grid.z.cells,
        [&](long j) {
            const auto row = static_cast<std::size_t>(j);
            for (auto k = static_cast<std::size_t>(p.first_of_row[row]);
                 k < static_cast<std::size_t>(p.first_of_row[row + 1]); ++k) {
                const Weights w = weights_at(scale, p.x_p[k], p.z_p[k]);
                const double m = p.m_p[k];
                const double S[4] = {w.S_x[0] * w.S_z[0], w.S_x[1] * w.S_z[0], w.S_x[0] * w.S_z[1],
                                     w.S_x[1] * w.S_z[1]};
                const long n = w.node, up = n + scale.stride;
                M.entry[0][n] += m * S[0] * S[0];
                M.entry[0][n + 1] += m * S[1] * S[1];
                M.entry[0][up] += m * S[2] * S[2];
                M.entry[0][up + 1] += m * S[3] * S[3];
                M.entry[1][n] += m * S[0] * S[1];
                M.entry[1][up] += m * S[2] * S[3];
                M.entry[2][n] += m * S[0] * S[2];
                M.entry[2][n + 1] += m * S[1] * S[3];
                M.entry[3][n] += m * S[0] * S[3];
                M.entry[4][n + 1] += m * S[1] * S[2];
            }
        },
        p.count());
    // Around a periodic direction the last row or column of nodes is the first.
    const long nx = grid.x.cells, nz = grid.z.cells;
    for (Field& f : M.entry) {
        if (grid.x.periodic)
            for (long j = 0; j <= nz; ++j) {
                f[grid.index(0, j)] += f[grid.index(nx, j)];
                f[grid.index(nx, j)] = 0;
            }
        if (grid.z.periodic)
            for (long i = 0; i <= nx; ++i) {
                f[grid.index(i, 0)] += f[grid.index(i, nz)];
                f[grid.index(i, nz)] = 0;
            }
        fill_nodes(grid, f.data());
    }
}

/// y = M x. in/out: x, its periodic images are filled; y on all nodes, images filled.
inline void multiply(const Grid& grid, const MassMatrix& M, Field& x, Field& y) {
    fill_nodes(grid, x.data());
    y.setZero(grid.size());
    for_each_node(grid, [&](long, long, long n) {
        double sum = M.entry[0][n] * x[n];
        for (std::size_t k = 1; k < 5; ++k) {
            const long step = MassMatrix::to[k][0] + grid.stride() * MassMatrix::to[k][1];
            sum += M.entry[k][n] * x[n + step] + M.entry[k][n - step] * x[n - step];
        }
        y[n] = sum;
    });
    fill_nodes(grid, y.data());
}

/// One component of the velocity that xpic gives to particles in place of their own: what the mesh
/// can represent, without the smoothing of pic.
///   v = sum_{k < order} (I - M_L^-1 M)^k v_g;  order 1 is pic, many orders M^-1 M_L v_g
/// out:    v; last, the last term of the sum, which says what the filter leaves: the momentum of the
///         particles less M v is (M_L - M) last
/// source: Hammerquist and Nairn, Comput. Methods Appl. Mech. Eng. 318, 724 (2017).
/// note:   theirs also corrects the displacement; here positions follow the slide, FLIP-7
inline void filter_velocity(const Grid& grid, const MassMatrix& M, const Field& m, long order,
                            const Field& v_g, Field& v, Field& last) {
    Field trip;
    v = last = v_g;
    for (long k = 1; k < order; ++k) {
        multiply(grid, M, last, trip);
        for_each_node(
            grid, [&](long, long, long n) { last[n] = m[n] > 0 ? last[n] - trip[n] / m[n] : 0; });
        v += last;
    }
}

/// Solves M x = b for one component on the nodes where it is free; where it is held, x is given.
/// in/out: x, start and held values
/// errors: NumericalError when conjugate gradients do not converge to 1e-13
inline void solve_mass(const Grid& grid, const MassMatrix& M, const Field& m,
                       const std::vector<char>& held, const Field& b, Field& x) {
    Field r, z, d, Md;
    const auto free = [&](long n) { return m[n] > 0 && held[static_cast<std::size_t>(n)] == 0; };
    const auto dot = [&](const Field& a, const Field& c) {
        double sum = 0;
        for_own_nodes(grid, [&](long n) { sum += a[n] * c[n]; });
        return sum;
    };
    const auto precondition = [&] {
        z.setZero(grid.size());
        for_each_node(grid, [&](long, long, long n) {
            if (free(n)) z[n] = r[n] / M.entry[0][n];
        });
    };
    multiply(grid, M, x, Md);
    r.setZero(grid.size());
    double size = 0;
    for_each_node(grid, [&](long, long, long n) {
        if (free(n)) r[n] = b[n] - Md[n];
    });
    for_own_nodes(grid, [&](long n) {
        if (free(n)) size += (b[n] * b[n] + Md[n] * Md[n]) / M.entry[0][n];
    });
    precondition();
    d = z;
    double rz = dot(r, z);
    for (int k = 0; k < 2000 && rz > 1e-26 * size; ++k) {
        multiply(grid, M, d, Md);
        const double step = rz / dot(d, Md);
        x += step * d;
        for_each_node(grid, [&](long, long, long n) {
            if (free(n)) r[n] -= step * Md[n];
        });
        precondition();
        const double next = dot(r, z);
        d = z + (next / rz) * d;
        rz = next;
    }
    if (!(rz <= 1e-26 * size))
        throw common::NumericalError(
            "the consistent mass matrix cannot be solved with: the nodes have too few particles; "
            "take more per cell, or flip.mass = \"lumped\"");
    fill_nodes(grid, x.data());
}

}  // namespace flip
