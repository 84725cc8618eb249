// The Lagrangian phase: the equations of motion are solved on the mesh as though it moved with the
// fluid. [PIC, Lagrangian phase]
//
//     u~_c = u_c - (dt A/M_c) (P_right - P_left) + dt g        P_face = w_c p_c + w_beyond p_beyond + q
//     M_c (I~_c - I_c) = -dt sum over faces of A (p_c + q) w_c (ubar_beyond - ubar_c), outward
//
// with w = 1/2 and ubar = (u + u~)/2; for a cell that is a ring, A = V_c/dx, and each ubar is multiplied
// by the A of its own cell. The centered velocity is what makes total energy exact: on every face inside
// the fluid the kinetic energy that it gives to the two cells is what their internal energies lose.
//
// Under gravity w_c = rho_beyond/(rho_c + rho_beyond), with which the halves of two cells accelerate
// alike at their face, so that fluids of any density rest on each other.
#pragma once

#include "flip/pic/largest_step.hpp"

namespace flip {

namespace detail {

// The part w of a cell in the face to another; 0 beside an empty one.
inline double part_of_face(const PicCells& cells, long here, long beyond) {
    return cells.falls ? cells.rho[beyond] / (cells.rho[here] + cells.rho[beyond] + 1e-300)
                       : 0.5 * cells.filled[beyond];
}

// The pressure between two cells; none where one of them is empty.
inline double face_pressure(const PicCells& cells, long left, long right, double q) {
    return cells.filled[left] * cells.filled[right] *
           (part_of_face(cells, left, right) * cells.p[left] +
            part_of_face(cells, right, left) * cells.p[right] + q);
}

// Viscous pressure on the faces below row j, and between its cells, with the harmonic mean of their
// densities: more would throw a light cell about beside a heavy one, or need short steps.
inline void viscous_pressure(const Grid& grid, const ArtificialViscosity& given, long j,
                             PicCells& cells) {
    const long nx = grid.x.cells, stride = grid.stride();
    const ArtificialViscosity viscosity = given;
    const double *filled = cells.filled.data(), *rho = cells.rho.data(), *c = cells.c.data();
    const CellVelocity* v = cells.v.data();
    const long n = grid.index(0, j);
    const auto q = [=](long a, long b, double du) {
        const double mean = 2 * rho[a] * rho[b] / (rho[a] + rho[b] + 1e-300);
        return filled[a] * filled[b] * viscosity(mean, 0.5 * (c[a] + c[b]), du);
    };
    double *q_x = cells.q_x.data(), *q_z = cells.q_z.data();
    if (j < grid.z.cells)
        for (long m = n; m <= n + nx; ++m) q_x[m] = q(m - 1, m, v[m].x - v[m - 1].x);
    if (is_plane(grid))
        for (long m = n; m < n + nx; ++m) q_z[m] = q(m - stride, m, v[m].z - v[m - stride].z);
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

/// The momentum equation.
///   u~ = u - (dt A/M) (P_right - P_left) + dt g, and where the fluid turns about the axis + dt f
/// in:     cells after find_pressure()
/// out:    v_tilde with ghosts, zero in empty cells; q_x, q_z; what boundaries, gravity and trap give
///         to the momentum, in the budget
/// exact:  momentum, with the budget; a face of an empty cell carries no pressure: a free surface
/// source: [PIC, Lagrangian phase]
inline void accelerate_cells(const Problem& problem, double dt, State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    const Boundaries& boundaries = problem.boundaries;
    const long nx = grid.x.cells, nz = grid.z.cells, stride = grid.stride();
    const bool plane = is_plane(grid);
    const double A_x = grid.z.spacing(), A_z = grid.x.spacing();
    const CellAcceleration g(problem);
    for_each_row_of_cells(grid, [&](long j) {
        detail::viscous_pressure(grid, problem.q, j, cells);
        if (j == nz - 1) detail::viscous_pressure(grid, problem.q, nz, cells);
    });
    if (problem.swirl) find_centrifugal_force(problem, dt, state, cells);
    if (cells.falls) detail::add_weight_on_walls(problem, cells);
    for_each_row_of_cells(grid, [&](long j) {
        const auto P_x = [&](long m) {
            return detail::face_pressure(cells, m - 1, m, cells.q_x[m]);
        };
        const auto P_z = [&](long m) {
            return detail::face_pressure(cells, m - stride, m, cells.q_z[m]);
        };
        for (long i = 0; i < nx; ++i) {
            const long n = grid.index(i, j);
            const double dt_per_M = dt * cells.per_mass[n] * cells.ring[i + 1],
                         dt_here = dt * cells.filled[n];
            const CellVelocity& v = cells.v[n];
            CellVelocity& v_tilde = cells.v_tilde[n];
            v_tilde.x = v.x - dt_per_M * A_x * (P_x(n + 1) - P_x(n)) + dt_here * g.x(i);
            v_tilde.z = v.z + dt_here * g.z(j);
            if (plane) v_tilde.z -= dt_per_M * A_z * (P_z(n + stride) - P_z(n));
        }
    });
    if (problem.swirl) add_centrifugal_force(grid, dt, cells);
    fill_ghosts(grid, boundaries, cells.v_tilde);

    Budget& budget = state.budget;
    for (const Side side : all_sides) {
        const bool along_x = is_x_side(side);
        if (boundaries.is(side, BoundaryKind::periodic) || (!along_x && !plane)) continue;
        const double inward = is_low_side(side) ? 1 : -1;
        const double push =
            detail::sum_over_faces(grid, cells, side, [&](long inside, long beyond, double q) {
                return detail::face_pressure(cells, inside, beyond, q);
            });
        (along_x ? budget.momentum_x : budget.momentum_z) +=
            inward * dt * (along_x ? A_x : A_z) * push;
    }
    const auto weight = [&](const auto& acceleration) {
        return sum_over_rows(grid, cells, [&](long j) {
            double sum = 0;
            for (long i = 0; i < nx; ++i) sum += cells.mass[grid.index(i, j)] * acceleration(i, j);
            return sum;
        });
    };
    budget.momentum_x += dt * weight([&](long i, long) { return g.x(i); });
    budget.momentum_z += dt * weight([&](long, long j) { return g.z(j); });
}

/// The energy equation: what pressure and viscosity do to a cell whose faces move with the mean of
/// ubar, with the parts w; a face beside an empty cell moves with the cell.
///   M (I~ - I) = -dt sum over faces A (p + q) w (ubar_beyond - ubar) along the normal outward
/// in:     cells after accelerate_cells()
/// out:    e_tilde; what comes through open boundaries, from gravity and trap, in the budget
/// exact:  the total energy, with the budget: sum of M (u~^2 - u^2)/2 + M (I~ - I); walls do no work,
///         because behind a wall ubar is odd
/// source: [PIC, Lagrangian phase]
inline void do_work(const Problem& problem, double dt, State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    const Boundaries& boundaries = problem.boundaries;
    const long nx = grid.x.cells, stride = grid.stride(), K = cells.materials;
    const bool plane = is_plane(grid);
    const double A_x = grid.z.spacing(), A_z = grid.x.spacing();
    const Field &p = cells.p, &q_x = cells.q_x, &q_z = cells.q_z;
    const std::vector<CellVelocity>&v = cells.v, &v_tilde = cells.v_tilde;
    const double* const ring = cells.ring.data() + 1;
    // The part w of the difference of ubar across a face, beyond it minus here; along x times the
    // lengths of the rings, the transpose of what accelerate_cells() does.
    const auto step_x = [&](long here, long beyond, long i, long i_beyond) {
        return 0.5 * detail::part_of_face(cells, here, beyond) *
               (ring[i_beyond] * (v[beyond].x + v_tilde[beyond].x) -
                ring[i] * (v[here].x + v_tilde[here].x));
    };
    const auto step_z = [&](long here, long beyond) {
        return 0.5 * detail::part_of_face(cells, here, beyond) *
               ((v[beyond].z + v_tilde[beyond].z) - (v[here].z + v_tilde[here].z));
    };
    for_each_row_of_cells(grid, [&](long j) {
        for (long i = 0; i < nx; ++i) {
            const long n = grid.index(i, j);
            // [work]
            double growth = A_x * ((p[n] + q_x[n + 1]) * step_x(n, n + 1, i, i + 1) -
                                   (p[n] + q_x[n]) * step_x(n, n - 1, i, i - 1));
            if (plane) {
                const long up = n + stride, down = n - stride;
                growth += A_z * ring[i] *
                          ((p[n] + q_z[up]) * step_z(n, up) - (p[n] + q_z[n]) * step_z(n, down));
            }
            const double work = -dt * growth;
            // [/work]
            for (long k = 0; k < K; ++k) {
                const double M = cells.M[n * K + k];
                cells.e_tilde[n * K + k] =
                    state.cells.e[k][n] + (M > 0 ? cells.share[n * K + k] * work / M : 0.0);
            }
        }
    });

    Budget& budget = state.budget;
    for (const Side side : all_sides) {
        const bool along_x = is_x_side(side);
        if (boundaries.is(side, BoundaryKind::periodic) ||
            boundaries.is(side, BoundaryKind::slip) || (!along_x && !plane))
            continue;
        const double inward = is_low_side(side) ? 1 : -1;
        const double work =
            detail::sum_over_faces(grid, cells, side, [&](long inside, long beyond, double q) {
                const auto ubar = [&](long n) {
                    return along_x ? 0.5 * (v[n].x + v_tilde[n].x) : 0.5 * (v[n].z + v_tilde[n].z);
                };
                return detail::face_pressure(cells, inside, beyond, q) * ubar(inside) +
                       cells.filled[inside] * detail::part_of_face(cells, inside, beyond) *
                           (p[inside] + q) * (ubar(beyond) - ubar(inside));
            });
        budget.energy += inward * dt * (along_x ? A_x : A_z) * work;
    }
    const CellAcceleration g(problem);
    budget.energy +=
        dt * sum_over_rows(grid, cells, [&](long j) {
            double sum = 0;
            for (long i = 0; i < nx; ++i) {
                const long n = grid.index(i, j);
                sum += cells.mass[n] * 0.5 *
                       (g.x(i) * (v[n].x + v_tilde[n].x) + g.z(j) * (v[n].z + v_tilde[n].z));
            }
            return sum;
        });
    if (problem.swirl) work_on_swirl(grid, dt, state.particles, cells);
}

}  // namespace flip
