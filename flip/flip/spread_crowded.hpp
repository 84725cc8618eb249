// on the mesh: moves particles of a liquid apart where they crowd, and those of a single gas that is not
// confined also to where they are missing.
//
// Nothing in the equations brings the places of particles back to their volumes. Where water falls back upon
// itself, or particles gather bit by bit, cells come to hold more of it than their volume, and its surface
// sinks; a gas that turns leaves cells empty after some turns, and an empty cell has no pressure. So in every step
// crowded cells give a tenth of what they have too much to their neighbors, by a displacement that is found as a
// pressure is,
//     D M^-1 D^T phi = (crowding beyond a twentieth)/10,   x_p += sum_g S u_g,   u = M^-1 D^T phi,
// up to a quarter of a cell. The crowding of a gas is negative where it lacks volume. It counts as 0 there beside
// a void, for gas at the edge of a void lacks nothing, and at open ends and inflows, where particles come and go a
// column at a time. It is no motion: velocity, volume and energy of the particles stay as they are.
// note: What had fallen is lifted without work.
// source: the idea is that of Losasso, Talton, Kwatra and Fedkiw, IEEE Trans. Vis. Comput. Graph. 14, 797
//         (2008), whose divergence is given by the density of particles.
#pragma once

#include <algorithm>
#include <cmath>

#include "flip/flip/solve_pressure.hpp"

namespace flip {

/// Cells may hold so much more than their volume. Rings at the axis have few particles, whose volumes in a
/// cell fluctuate by more.
inline constexpr double crowded = 0.05, crowded_ring = 0.2;

namespace detail {

inline bool is_one_gas(const Problem& problem) {
    return problem.materials.size() == 1 && problem.materials[0].p_infinity == 0;
}

/// The crowding of a cell, or 0 where a gas is not spread: at open ends and inflows, and where it lacks volume
/// beside a void.
inline double excess_of(const Problem& problem, const Cells& c, long n) {
    const double excess = c.crowding[n];
    if (!is_one_gas(problem) || excess == 0) return excess;
    const Grid& grid = problem.grid;
    const long i = column_of(grid, n), j = n / grid.stride() - 1;
    const auto passes = [&](Side s) {
        return problem.boundaries.is(s, BoundaryKind::open) ||
               problem.boundaries.is(s, BoundaryKind::inflow);
    };
    if ((i == 0 && passes(x_low)) || (i == grid.x.cells - 1 && passes(x_high)) ||
        (j == 0 && passes(z_low)) || (j == grid.z.cells - 1 && passes(z_high)))
        return 0;
    if (excess > 0) return excess;
    for (long b = j - 1; b <= j + 1; ++b)
        for (long a = i - 1; a <= i + 1; ++a) {
            const bool beyond_x = a < 0 || a >= grid.x.cells, beyond_z = b < 0 || b >= grid.z.cells;
            if ((beyond_x && !grid.x.periodic) || (beyond_z && !grid.z.periodic)) continue;
            const long beside =
                grid.index((a + grid.x.cells) % grid.x.cells, (b + grid.z.cells) % grid.z.cells);
            if (c.surface[beside] != 0) return 0;
        }
    return excess;
}

/// (1/4, 1/2, 1/4) along x and then along z. D M^-1 D^T hardly sees a load that alternates from cell to cell, and
/// would answer it with large displacements: in a uniform stream of random particles they grew without end.
/// exact:  the sum stays
inline void smooth_load(const Grid& grid, const PressureCells& cells, Eigen::VectorXd& load) {
    for (const bool along_x : {true, false}) {
        const Eigen::VectorXd from = load;
        for (long r = 0; r < cells.count(); ++r) {
            const long i = column_of(grid, cells.index[r]), j = cells.index[r] / grid.stride() - 1;
            load[r] = 0.5 * from[r];
            for (const long step : {-1, 1}) {
                const long a = i + (along_x ? step : 0), b = j + (along_x ? 0 : step),
                           in_x = grid.x.periodic ? (a + grid.x.cells) % grid.x.cells : a,
                           in_z = grid.z.periodic ? (b + grid.z.cells) % grid.z.cells : b;
                const bool beyond =
                    in_x < 0 || in_z < 0 || in_x >= grid.x.cells || in_z >= grid.z.cells;
                const int beside = beyond ? -1 : cells.number[grid.index(in_x, in_z)];
                load[r] += 0.25 * from[beside >= 0 ? beside : r];
            }
        }
    }
}

}  // namespace detail

/// Adds the displacement that spreads crowded cells to nodes.increment, the velocity that moves particles.
/// in:     cells.crowding, surface; nodes.m
/// exact:  nothing is moved through walls; without crowded cells, of a gas without empty ones, nothing at all
inline void spread_crowded(const Problem& problem, double dt, Mesh& mesh) {
    const Grid& grid = problem.grid;
    const Cells& c = mesh.cells;
    Nodes& g = mesh.nodes;
    if (c.crowding.size() == 0 || c.crowding.isZero(0)) return;
    const double allowed = grid.axisymmetric ? crowded_ring : crowded;
    const detail::PressureCells cells = detail::number_cells(problem, dt, mesh);
    Eigen::VectorXd load(cells.count()), phi;
    for (long r = 0; r < cells.count(); ++r) {
        const double excess = detail::excess_of(problem, c, cells.index[r]),
                     most = allowed * c.V_of_column[column_of(grid, cells.index[r])];
        load[r] = 0.1 * (excess - std::clamp(excess, -most, most));
    }
    if (load.isZero(0)) return;
    if (detail::is_one_gas(problem)) detail::smooth_load(grid, cells, load);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(cells.count());
    auto A = detail::pressure_matrix(problem, 1 / problem.scheme.theta, mesh, cells, none);
    A.diagonal() *= 1 + 1e-6;  // a closed box has a phi, too
    detail::solve_cells(A, load, 1e-3, problem.scheme.max_iterations, phi);
    if (!phi.allFinite()) return;

    Field ux = Field::Zero(grid.size()), uz = ux;
    double most = 0;  // in cells
    for_own_nodes(grid, [&](long i, long j, long n) {
        if (!(g.m[n] > 0)) return;
        const detail::NodeStencil at = detail::stencil_at(problem, c, i, j);
        for (std::size_t k = 0; k < 4; ++k) {
            const int r = at.cell[k] >= 0 ? cells.number[at.cell[k]] : -1;
            if (r < 0) continue;
            ux[n] += at.x[k] * phi[r] / g.m[n];
            uz[n] += at.z[k] * phi[r] / g.m[n];
        }
        most = std::max({most, std::fabs(ux[n]) / grid.x.spacing(),
                         is_plane(grid) ? std::fabs(uz[n]) / grid.z.spacing() : 0});
    });
    const double per_dt = std::min(1.0, 0.25 / std::max(most, 1e-300)) / dt;
    for_each_node(grid, [&](long i, long j, long n) {
        const long own = grid.index(grid.x.periodic ? i % grid.x.cells : i,
                                    grid.z.periodic ? j % grid.z.cells : j);
        g.increment[n] += per_dt * Four(0, 0, ux[own], uz[own]);
    });
}

}  // namespace flip
