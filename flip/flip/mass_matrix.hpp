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

#include "common/conjugate_gradients.hpp"
#include "flip/flip/set_walls.hpp"

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
    common::for_each_row_three_colors(
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
/// note:   for y = D^1/2 x and the matrix D^-1/2 M D^-1/2, D the diagonal of M; a node whose square
///         of S is too small for a number has no entry there, and keeps the start
inline void solve_mass(const Grid& grid, const MassMatrix& M, const Field& m,
                       const std::vector<char>& held, const Field& b, Field& x) {
    std::vector<long> free;
    for_own_nodes(grid, [&](long n) {
        if (m[n] > 0 && held[static_cast<std::size_t>(n)] == 0 && M.entry[0][n] > 0)
            free.push_back(n);
    });
    const auto count = static_cast<Eigen::Index>(free.size());
    Eigen::VectorXd scale(count), load(count), y = Eigen::VectorXd::Zero(count);
    Field d = Field::Zero(grid.size()), Md;
    multiply(grid, M, x, Md);
    double size = 0;  // of the terms of b - M x
    for (Eigen::Index k = 0; k < count; ++k) {
        const long n = free[static_cast<std::size_t>(k)];
        scale[k] = 1 / std::sqrt(M.entry[0][n]);
        load[k] = scale[k] * (b[n] - Md[n]);
        size += scale[k] * scale[k] * (b[n] * b[n] + Md[n] * Md[n]);
    }
    const auto multiply_free = [&](const Eigen::VectorXd& v, Eigen::VectorXd& Mv) {
        for (Eigen::Index k = 0; k < count; ++k)
            d[free[static_cast<std::size_t>(k)]] = scale[k] * v[k];
        multiply(grid, M, d, Md);
        for (Eigen::Index k = 0; k < count; ++k)
            Mv[k] = scale[k] * Md[free[static_cast<std::size_t>(k)]];
    };
    const double size_load = common::safe_norm(load),
                 tolerance = size_load > 0 ? std::min(1.0, 1e-13 * std::sqrt(size) / size_load) : 0;
    const common::KrylovResult solved =
        common::conjugate_gradients(multiply_free, load, y, tolerance, 2000);
    if (!solved.converged)
        throw common::NumericalError(
            "the consistent mass matrix cannot be solved with: " + solved.reason +
            "; the nodes have too few particles: take more per cell, or "
            "flip.mass = \"lumped\"");
    for (Eigen::Index k = 0; k < count; ++k)
        x[free[static_cast<std::size_t>(k)]] += scale[k] * y[k];
    fill_nodes(grid, x.data());
}

}  // namespace flip
