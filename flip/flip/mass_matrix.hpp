// on the mesh: the consistent mass matrix of the nodes, which the lumped masses m_g stand in for.
//
//     M_gh = sum_p m_p S_gp S_hp,      sum_h M_gh = m_g
//
// With it FLIP loses no kinetic energy at all, at the price of a linear system per step. Its
// product with v/m, on the other hand, is one trip from the mesh to the particles and back, which is
// what XPIC filters with.
//
//     4   2   3      a particle couples the nodes of its cell, so M couples each node with its eight
//       \ | /        neighbors; M is symmetric, and node n stores the entries 0 to 4: with itself, and
//         0 - 1      with those to the right, above, above right and above left. The other four are
//                    entries of the neighbors: M_(n, n - step_k) = entry[k][n - step_k].
#pragma once

#include <array>

#include "common/run/sentence.hpp"
#include "flip/conjugate_gradients.hpp"
#include "flip/flip/accelerate_nodes.hpp"

namespace flip {

/// Half of the matrix, as in the picture.
struct MassMatrix {
    std::array<Field, 5> entry;
    static constexpr std::array<std::array<long, 2>, 5> to{
        {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {-1, 1}}};
};

/// The consistent mass matrix of the particles.
/// out:    M, all entries, ghosts filled
/// exact:  symmetric; rows sum to m_g; positive semidefinite
inline void assemble_mass_matrix(const Grid& grid, const Particles& p, MassMatrix& M) {
    for (Field& f : M.entry) f.setZero(grid.size());
    const WeightScale scale(grid);
    for_each_band(grid, p, [&](long begin, long end) {
        for (long k = begin; k < end; ++k) {
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
    });
    // Around a periodic direction the last row or column of nodes is the first.
    const long nx = grid.x.cells, nz = grid.z.cells;
    const auto move = [](double& from, double& to) { to += from, from = 0; };
    for (Field& f : M.entry) {
        if (grid.x.periodic)
            for (long j = 0; j <= nz; ++j) move(f[grid.index(nx, j)], f[grid.index(0, j)]);
        if (grid.z.periodic)
            for (long i = 0; i <= nx; ++i) move(f[grid.index(i, nz)], f[grid.index(i, 0)]);
        fill_nodes(grid, f.data());
    }
}

/// y = M x.
/// in/out: x, its periodic images are filled; y on all nodes, images filled
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
///         particles minus M v is (M_L - M) last
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
    for_own_nodes(grid, [&](long, long, long n) {
        if (m[n] > 0 && held[n] == 0 && M.entry[0][n] > 0) free.push_back(n);
    });
    const auto count = long(free.size());
    Eigen::VectorXd scale(count), load(count), y = Eigen::VectorXd::Zero(count);
    Field d = Field::Zero(grid.size()), Md;
    multiply(grid, M, x, Md);
    double size = 0;  // of the terms of b - M x
    for (long k = 0; k < count; ++k) {
        const long n = free[k];
        scale[k] = 1 / std::sqrt(M.entry[0][n]);
        load[k] = scale[k] * (b[n] - Md[n]);
        size += scale[k] * scale[k] * (b[n] * b[n] + Md[n] * Md[n]);
    }
    const auto multiply_free = [&](const Eigen::VectorXd& v, Eigen::VectorXd& Mv) {
        for (long k = 0; k < count; ++k) d[free[k]] = scale[k] * v[k];
        multiply(grid, M, d, Md);
        for (long k = 0; k < count; ++k) Mv[k] = scale[k] * Md[free[k]];
    };
    const double size_load = common::safe_norm(load),
                 tolerance = size_load > 0 ? std::min(1.0, 1e-13 * std::sqrt(size) / size_load) : 0;
    const common::KrylovResult solved =
        conjugate_gradients(multiply_free, load, y, tolerance, 2000);
    if (!solved.converged)
        common::fail(
            "the consistent mass matrix cannot be solved with: ", solved.reason,
            "; the nodes have too few particles: take more per cell, or flip.mass = \"lumped\"");
    for (long k = 0; k < count; ++k) x[free[k]] += scale[k] * y[k];
    fill_nodes(grid, x.data());
}

/// Velocities of the nodes with the consistent mass, in place of the Favre average.
///   M v = sum_p m_p v_p S_p
/// out: nodes.vx, vz
inline void solve_velocity(const Grid& grid, const MassMatrix& M, Nodes& g) {
    const std::vector<char> none(grid.size(), 0);
    for (const int component : {1, 2}) {
        Field momentum = Field::Zero(grid.size());
        for_each_node(grid, [&](long, long, long n) { momentum[n] = g.sum[n][component]; });
        solve_mass(grid, M, g.m, none, momentum, component == 1 ? g.vx : g.vz);
    }
}

namespace detail {

// M change = load on the nodes that are free; on those that the boundaries hold, change is given.
// in/out: change, 0 where it is not given; out: reaction, what holds those nodes beside their load
inline void solve_held(const Problem& problem, const MassMatrix& M, const Nodes& g, bool along_x,
                       const Field& load, Field& change, Field& reaction) {
    const Grid& grid = problem.grid;
    std::vector<char> held(grid.size(), 0);
    for_each_node(grid, [&](long i, long j, long n) {
        const Held h = held_at(grid, problem.boundaries, i, j);
        held[n] = along_x ? h.x : h.z;
    });
    solve_mass(grid, M, g.m, held, load, change);
    multiply(grid, M, change, reaction);
    for_each_node(
        grid, [&](long, long, long n) { reaction[n] = held[n] != 0 ? reaction[n] - load[n] : 0; });
}

}  // namespace detail

/// The walls stop what runs against them, with the consistent mass: M (v^0 - v) is their impulse, on
/// the nodes that they hold alone, and (1/2) (v^0 - v) M (v^0 - v) becomes heat where they are.
/// in:  nodes.v, from M v = momentum; v0 on the nodes that are held
/// out: v0 on all nodes, reaction, wall_dissipation
inline void stop_at_walls(const Problem& problem, const MassMatrix& M, Nodes& g) {
    const Field none = Field::Zero(problem.grid.size());
    g.wall_dissipation = none;
    for (const bool along_x : {true, false}) {
        const Field& v = along_x ? g.vx : g.vz;
        Field &start = along_x ? g.vx0 : g.vz0, &reaction = along_x ? g.reaction_x : g.reaction_z;
        Field change = start - v;
        for_each_node(problem.grid, [&](long, long, long n) {
            if (g.m[n] <= 0) change[n] = 0;
        });
        detail::solve_held(problem, M, g, along_x, none, change, reaction);
        start = v + change;
        for_each_node(problem.grid, [&](long, long, long n) {
            if (g.m[n] > 0) g.wall_dissipation[n] += 0.5 * change[n] * reaction[n] / g.m[n];
        });
    }
}

/// M (v^L - v^0) = dt (F + m g) on the nodes that are free: accelerate_nodes() with the consistent
/// mass. Nothing is lost to the particles, so that nothing is dissipated.
/// in:     nodes.v0, forces
/// in/out: reaction, with the impulse of the walls
/// out:    nodes.vxL, vzL
inline void accelerate_consistently(const Problem& problem, double dt, const MassMatrix& M,
                                    Nodes& g) {
    const Grid& grid = problem.grid;
    for (const bool along_x : {true, false}) {
        const Field& force = along_x ? g.fx : g.fz;
        Field load = Field::Zero(grid.size()), change = load, reaction;
        for_each_node(grid, [&](long, long, long n) {
            load[n] = dt * (force[n] + g.m[n] * node_acceleration(grid, problem.body_force,
                                                                  n)[along_x ? 0 : 1]);
        });
        detail::solve_held(problem, M, g, along_x, load, change, reaction);
        (along_x ? g.vxL : g.vzL) = (along_x ? g.vx0 : g.vz0) + change;
        (along_x ? g.reaction_x : g.reaction_z) += reaction;
    }
}

}  // namespace flip
