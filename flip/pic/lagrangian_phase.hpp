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

#include "flip/pic/faces.hpp"
#include "flip/pic/largest_step.hpp"

namespace flip {

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
    // In a single row nothing pushes along z.
    const double A_x = grid.z.spacing(), A_z = plane ? grid.x.spacing() : 0.0;
    const CellAcceleration g(problem);
    for_each_row_of_cells(grid, [&](long j) {
        detail::find_faces(grid, problem.q, j, cells);
        if (j == nz - 1) detail::find_faces(grid, problem.q, nz, cells);
    });
    if (problem.swirl) find_centrifugal_force(problem, dt, state, cells);
    if (cells.falls) detail::add_weight_on_walls(problem, cells);
    for_each_row_of_cells(grid, [&](long j) {
        const Values filled = cells.filled, per_mass = cells.per_mass, p = cells.p, q_x = cells.q_x,
                     q_z = cells.q_z, part_x = cells.part_x, part_z = cells.part_z;
        const auto P_x = [=](long m) {
            return detail::face_pressure(filled, p, m - 1, m, part_x[m], q_x[m]);
        };
        const auto P_z = [=](long m) {
            return detail::face_pressure(filled, p, m - stride, m, part_z[m], q_z[m]);
        };
        const long first = grid.index(0, j);
        const CellVelocity* const v = cells.v.data() + first;
        CellVelocity* const v_tilde = cells.v_tilde.data() + first;
        const double* const ring = cells.ring.data() + 1;
#pragma omp simd
        for (int i = 0; i < int(nx); ++i) {
            const long n = first + i;
            const double dt_per_M = dt * per_mass[n] * ring[i], dt_here = dt * filled[n];
            v_tilde[i].x = v[i].x - dt_per_M * A_x * (P_x(n + 1) - P_x(n)) + dt_here * g.x(i);
            v_tilde[i].z = v[i].z - dt_per_M * A_z * (P_z(n + stride) - P_z(n)) + dt_here * g.z(j);
        }
    });
    if (problem.swirl) add_centrifugal_force(grid, dt, cells);
    fill_ghosts(grid, boundaries, cells.v_tilde);

    Budget& budget = state.budget;
    const Values weight = detail::weight_of_face(cells);
    for (const Side side : all_sides) {
        const bool along_x = is_x_side(side);
        if (boundaries.is(side, BoundaryKind::periodic) || (!along_x && !plane)) continue;
        const double inward = is_low_side(side) ? 1 : -1;
        const double push =
            detail::sum_over_faces(grid, cells, side, [&](long inside, long beyond, double q) {
                return detail::face_pressure(cells.filled, cells.p, inside, beyond,
                                             detail::part_of_face(weight, inside, beyond), q);
            });
        (along_x ? budget.momentum_x : budget.momentum_z) +=
            inward * dt * (along_x ? A_x : A_z) * push;
    }
    const auto weigh = [&](const auto& acceleration) {
        return sum_over_rows(grid, cells, [&](long j) {
            const double* const mass = cells.mass.data() + grid.index(0, j);
            double sum = 0;
#pragma omp simd reduction(+ : sum)
            for (int i = 0; i < int(nx); ++i) sum += mass[i] * acceleration(i, j);
            return sum;
        });
    };
    budget.momentum_x += dt * weigh([&](int i, long) { return g.x(i); });
    budget.momentum_z += dt * weigh([&](int, long j) { return g.z(j); });
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
    // In a single row nothing pushes along z.
    const double A_x = grid.z.spacing(), A_z = plane ? grid.x.spacing() : 0.0;
    const Values p = cells.p, q_x = cells.q_x, q_z = cells.q_z, part_x = cells.part_x,
                 part_z = cells.part_z;
    double* const work = cells.work.data();
    const CellVelocity *const v = cells.v.data(), *const v_tilde = cells.v_tilde.data();
    const double* const ring = cells.ring.data() + 1;
    // The difference of ubar across a face; along x times the lengths of the rings, the transpose of
    // what accelerate_cells() does.
    const auto step_x = [=](long here, long beyond, long i, long i_beyond) {
        return 0.5 * (ring[i_beyond] * (v[beyond].x + v_tilde[beyond].x) -
                      ring[i] * (v[here].x + v_tilde[here].x));
    };
    const auto step_z = [=](long here, long beyond) {
        return 0.5 * ((v[beyond].z + v_tilde[beyond].z) - (v[here].z + v_tilde[here].z));
    };
    for_each_row_of_cells(grid, [&, work, ring](long j) {
        const long first = grid.index(0, j);
#pragma omp simd
        for (long i = 0; i < nx; ++i) {
            const long n = first + i;
            // [work]
            const long up = n + stride, down = n - stride;
            const double growth =
                A_x * ((p[n] + q_x[n + 1]) * part_x[n + 1] * step_x(n, n + 1, i, i + 1) -
                       (p[n] + q_x[n]) * (1 - part_x[n]) * step_x(n, n - 1, i, i - 1)) +
                A_z * ring[i] *
                    ((p[n] + q_z[up]) * part_z[up] * step_z(n, up) -
                     (p[n] + q_z[n]) * (1 - part_z[n]) * step_z(n, down));
            work[n] = -dt * growth;
            // [/work]
        }
        for (long k = 0; k < K; ++k) {
            const double *const e = state.cells.e[k].data(), *const M = cells.M.data() + k,
                                *const share = cells.share.data() + k;
            double* const e_tilde = cells.e_tilde.data() + k;
#pragma omp simd
            for (long n = first; n < first + nx; ++n) {
                const double M_k = M[n * K];
                e_tilde[n * K] = e[n] + share[n * K] * work[n] / std::max(M_k, 1e-300);
            }
        }
    });

    Budget& budget = state.budget;
    const Values weight = detail::weight_of_face(cells);
    for (const Side side : all_sides) {
        const bool along_x = is_x_side(side);
        if (boundaries.is(side, BoundaryKind::periodic) ||
            boundaries.is(side, BoundaryKind::slip) || (!along_x && !plane))
            continue;
        const double inward = is_low_side(side) ? 1 : -1;
        const double through =
            detail::sum_over_faces(grid, cells, side, [&](long inside, long beyond, double q) {
                const auto ubar = [&](long n) {
                    return along_x ? 0.5 * (v[n].x + v_tilde[n].x) : 0.5 * (v[n].z + v_tilde[n].z);
                };
                const double w = detail::part_of_face(weight, inside, beyond);
                return detail::face_pressure(cells.filled, cells.p, inside, beyond, w, q) *
                           ubar(inside) +
                       cells.filled[inside] * w * (p[inside] + q) * (ubar(beyond) - ubar(inside));
            });
        budget.energy += inward * dt * (along_x ? A_x : A_z) * through;
    }
    const CellAcceleration g(problem);
    const Values mass = cells.mass;
    budget.energy +=
        dt * sum_over_rows(grid, cells, [&](long j) {
            const long first = grid.index(0, j);
            double sum = 0;
#pragma omp simd reduction(+ : sum)
            for (int i = 0; i < int(nx); ++i) {
                const long n = first + i;
                sum += mass[n] * 0.5 *
                       (g.x(i) * (v[n].x + v_tilde[n].x) + g.z(j) * (v[n].z + v_tilde[n].z));
            }
            return sum;
        });
    if (problem.swirl) work_on_swirl(grid, dt, state.particles, cells);
}

}  // namespace flip
