// The Lagrangian phase: the equations of motion are solved on the mesh as though it moved with the
// fluid. [PIC, Lagrangian phase]
//
//     u~_c = u_c - (dt A/M_c) (P_right - P_left) + dt g          P_face = (p_left + p_right)/2 + q
//     M_c (I~_c - I_c) = -dt sum over faces of A (p_c + q) (ubar_beyond - ubar_c)/2, outward
//
// with ubar = (u + u~)/2. The centered velocity is what makes total energy exact: on every face
// inside the fluid the kinetic energy that it gives to the two cells is what their internal
// energies lose.
#pragma once

#include "flip/pic/largest_step.hpp"

namespace flip {

namespace detail {

// The pressure between two cells; none where one of them is empty.
inline double face_pressure(const PicCells& cells, long left, long right, double q) {
    return cells.filled[left] * cells.filled[right] * (0.5 * (cells.p[left] + cells.p[right]) + q);
}

// Viscous pressure on the faces below row j, and between its cells.
inline void viscous_pressure(const Problem& problem, long j, PicCells& cells) {
    const Grid& grid = problem.grid;
    const long nx = grid.x.cells, stride = grid.stride();
    const ArtificialViscosity viscosity = problem.q;
    const double half_per_V = 0.5 / grid.cell_area();
    const double *filled = cells.filled.data(), *mass = cells.mass.data(), *c = cells.c.data();
    const CellVelocity* v = cells.v.data();
    const auto q = [=](long a, long b, double du) {
        return filled[a] * filled[b] *
               viscosity(half_per_V * (mass[a] + mass[b]), 0.5 * (c[a] + c[b]), du);
    };
    const long n = grid.index(0, j);
    double *q_x = cells.q_x.data(), *q_z = cells.q_z.data();
    if (j < grid.z.cells)
        for (long m = n; m <= n + nx; ++m) q_x[m] = q(m - 1, m, v[m].x - v[m - 1].x);
    if (is_plane(problem.grid))
        for (long m = n; m < n + nx; ++m) q_z[m] = q(m - stride, m, v[m].z - v[m - stride].z);
}

// Calls visit(inside, beyond, face) for the faces on one end of the mesh.
template <class Visit>
void for_each_face_on(const Grid& grid, Side end, const Visit& visit) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    const bool low = end == x_low || end == z_low;
    if (end == x_low || end == x_high) {
        for (long j = 0; j < nz; ++j)
            visit(grid.index(low ? 0 : nx - 1, j), grid.index(low ? -1 : nx, j),
                  grid.index(low ? 0 : nx, j));
    } else {
        for (long i = 0; i < nx; ++i)
            visit(grid.index(i, low ? 0 : nz - 1), grid.index(i, low ? -1 : nz),
                  grid.index(i, low ? 0 : nz));
    }
}

}  // namespace detail

/// The momentum equation.
///   u~ = u - (dt A/M) (P_right - P_left) + dt g
/// in:     cells after share_pressure()
/// out:    v_tilde with ghosts, zero in empty cells; q_x, q_z; what ends, gravity and trap give to
///         the momentum, in the books
/// exact:  momentum, with the books; a face of an empty cell carries no pressure: a free surface
/// source: [PIC, Lagrangian phase]
inline void accelerate_cells(const Problem& problem, double dt, State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    const long nx = grid.x.cells, nz = grid.z.cells, stride = grid.stride();
    const bool plane = is_plane(problem.grid);
    const double A_x = grid.z.spacing(), A_z = grid.x.spacing();
    const CellAcceleration g(problem);
    for_each_row_of_cells(grid, [&](long j) {
        detail::viscous_pressure(problem, j, cells);
        if (j == nz - 1) detail::viscous_pressure(problem, nz, cells);
    });
    for_each_row_of_cells(grid, [&](long j) {
        const auto P_x = [&](long m) {
            return detail::face_pressure(cells, m - 1, m, cells.q_x[m]);
        };
        const auto P_z = [&](long m) {
            return detail::face_pressure(cells, m - stride, m, cells.q_z[m]);
        };
        for (long i = 0; i < nx; ++i) {
            const long n = grid.index(i, j);
            const double kick = dt * cells.per_mass[n], here = dt * cells.filled[n];
            const CellVelocity& v = cells.v[static_cast<std::size_t>(n)];
            CellVelocity& v_tilde = cells.v_tilde[static_cast<std::size_t>(n)];
            v_tilde.x = v.x - kick * A_x * (P_x(n + 1) - P_x(n)) + here * g.x(i);
            v_tilde.z = v.z + here * g.z(j);
            if (plane) v_tilde.z -= kick * A_z * (P_z(n + stride) - P_z(n));
        }
    });
    fill_ghosts(problem, cells.v_tilde);

    Books& books = state.books;
    for (const Side end : all_sides) {
        const bool along_x = end == x_low || end == x_high;
        if (problem.boundaries.is(end, BoundaryKind::periodic) || (!along_x && !plane)) continue;
        double push = 0;
        detail::for_each_face_on(grid, end, [&](long inside, long beyond_it, long face) {
            push += detail::face_pressure(cells, inside, beyond_it,
                                          along_x ? cells.q_x[face] : cells.q_z[face]);
        });
        const double inward = end == x_low || end == z_low ? 1 : -1;
        (along_x ? books.momentum_x : books.momentum_z) +=
            inward * dt * (along_x ? A_x : A_z) * push;
    }
    books.momentum_x += dt * sum_over_rows(grid, cells, [&](long j) {
                            double sum = 0;
                            for (long i = 0; i < nx; ++i)
                                sum += cells.mass[grid.index(i, j)] * g.x(i);
                            return sum;
                        });
    books.momentum_z += dt * sum_over_rows(grid, cells, [&](long j) {
                            double sum = 0;
                            for (long i = 0; i < nx; ++i)
                                sum += cells.mass[grid.index(i, j)] * g.z(j);
                            return sum;
                        });
}

namespace detail {

// Half the difference of ubar across a face, beyond it less here.
inline double half_step(double v_here, double v_beyond, double v_tilde_here,
                        double v_tilde_beyond) {
    return 0.25 * ((v_beyond + v_tilde_beyond) - (v_here + v_tilde_here));
}

}  // namespace detail

/// The energy equation: what pressure and viscosity do to a cell whose faces move with
/// (ubar_here + ubar_beyond)/2; a face beside an empty cell moves with the cell.
///   M (I~ - I) = -dt sum over faces A (p + q) (ubar_beyond - ubar)/2 along the normal outward
/// in:     cells after accelerate_cells()
/// out:    e_tilde; what comes through open ends, from gravity and from the trap, in the books
/// exact:  the total energy, with the books: sum of M (u~^2 - u^2)/2 + M (I~ - I); walls do no work
/// source: [PIC, Lagrangian phase]
inline void do_work(const Problem& problem, double dt, State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    const long nx = grid.x.cells, stride = grid.stride();
    const std::size_t K = cells.materials;
    const bool plane = is_plane(problem.grid);
    const double A_x = grid.z.spacing(), A_z = grid.x.spacing();
    const Field &p = cells.p, &q_x = cells.q_x, &q_z = cells.q_z, &filled = cells.filled;
    const auto step_x = [&](long here, long beyond_it) {
        const auto a = static_cast<std::size_t>(here), b = static_cast<std::size_t>(beyond_it);
        return detail::half_step(cells.v[a].x, cells.v[b].x, cells.v_tilde[a].x,
                                 cells.v_tilde[b].x);
    };
    const auto step_z = [&](long here, long beyond_it) {
        const auto a = static_cast<std::size_t>(here), b = static_cast<std::size_t>(beyond_it);
        return detail::half_step(cells.v[a].z, cells.v[b].z, cells.v_tilde[a].z,
                                 cells.v_tilde[b].z);
    };
    for_each_row_of_cells(grid, [&](long j) {
        for (long i = 0; i < nx; ++i) {
            const long n = grid.index(i, j);
            // [work]
            double growth = A_x * (filled[n + 1] * (p[n] + q_x[n + 1]) * step_x(n, n + 1) -
                                   filled[n - 1] * (p[n] + q_x[n]) * step_x(n, n - 1));
            if (plane) {
                const long up = n + stride, down = n - stride;
                growth += A_z * (filled[up] * (p[n] + q_z[up]) * step_z(n, up) -
                                 filled[down] * (p[n] + q_z[n]) * step_z(n, down));
            }
            const double work = -dt * growth;
            // [/work]
            const std::size_t first = static_cast<std::size_t>(n) * K;
            for (std::size_t k = 0; k < K; ++k) {
                const double M = cells.M[first + k];
                cells.e_tilde[first + k] =
                    state.cells.e[k][n] + (M > 0 ? cells.share[first + k] * work / M : 0.0);
            }
        }
    });

    // What the world outside does, and what it does not notice is zero: behind a wall ubar is odd.
    Books& books = state.books;
    for (const Side end : all_sides) {
        const bool along_x = end == x_low || end == x_high;
        if (problem.boundaries.is(end, BoundaryKind::periodic) ||
            problem.boundaries.is(end, BoundaryKind::slip) || (!along_x && !plane))
            continue;
        double work = 0;
        detail::for_each_face_on(grid, end, [&](long inside, long beyond_it, long face) {
            const double q = along_x ? q_x[face] : q_z[face];
            const auto a = static_cast<std::size_t>(inside);
            const double ubar = along_x ? 0.5 * (cells.v[a].x + cells.v_tilde[a].x)
                                        : 0.5 * (cells.v[a].z + cells.v_tilde[a].z);
            const double step = along_x ? step_x(inside, beyond_it) : step_z(inside, beyond_it);
            work += detail::face_pressure(cells, inside, beyond_it, q) * ubar +
                    filled[inside] * filled[beyond_it] * (p[inside] + q) * step;
        });
        const double inward = end == x_low || end == z_low ? 1 : -1;
        books.energy += inward * dt * (along_x ? A_x : A_z) * work;
    }
    const CellAcceleration g(problem);
    books.energy += dt * sum_over_rows(grid, cells, [&](long j) {
                        double sum = 0;
                        for (long i = 0; i < nx; ++i) {
                            const auto n = static_cast<std::size_t>(grid.index(i, j));
                            const CellVelocity &v = cells.v[n], &v_tilde = cells.v_tilde[n];
                            sum += cells.mass[grid.index(i, j)] * 0.5 *
                                   (g.x(i) * (v.x + v_tilde.x) + g.z(j) * (v.z + v_tilde.z));
                        }
                        return sum;
                    });
}

}  // namespace flip
