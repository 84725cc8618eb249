// What the cells of pic know before a step: their pressure, what accelerates and resists, and how
// long the step may be.
#pragma once

#include <array>
#include <concepts>

#include "common/run/sentence.hpp"
#include "flip/pic/centrifugal_force.hpp"

namespace flip {

/// The acceleration of gravity and of the trap at the center of cell (i, j); in a single row
/// nothing moves along z.
///   a = g + trap (x_middle - x),  linear in i and in j
struct CellAcceleration {
    double x_first, z_first, x_change, z_change;
    explicit CellAcceleration(const Problem& problem) {
        const Grid& grid = problem.grid;
        const BodyForce& force = problem.body_force;
        const auto first = [&](const common::Axis& a, double g) {
            return g + force.trap * 0.5 * (a.length - a.spacing());
        };
        const bool plane = is_plane(grid);
        x_first = first(grid.x, force.gravity_x);
        x_change = -force.trap * grid.x.spacing();
        z_first = plane ? first(grid.z, force.gravity_z) : 0.0;
        z_change = plane ? -force.trap * grid.z.spacing() : 0.0;
    }
    double x(std::integral auto i) const { return x_first + x_change * double(i); }
    double z(long j) const { return z_first + z_change * double(j); }
    /// The largest of both, over the mesh.
    double largest(const Grid& grid) const {
        return std::max({std::fabs(x(0)), std::fabs(x(grid.x.cells - 1)), std::fabs(z(0)),
                         std::fabs(z(grid.z.cells - 1))});
    }
};

/// The state of every cell: how its materials share it, their common pressure, the speed of sound.
///   c^2 = 1/(rho compressibility);  of a cell with a free surface, that of the material in it
/// in:     masses of the cells and what the state knows of them
/// out:    mass, per_mass, rho, filled, p, c, share, v, with ghosts
/// errors: NumericalError where no fluid is at an open end that has a pressure outside
inline void find_pressure(const Problem& problem, const State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    const std::vector<Material>& materials = problem.materials;
    const long K = cells.materials;
    for_each_row_of_cells(grid, [&](long j) {
        const long first = grid.index(0, j);
        std::array<double, most_materials> U{};
        std::array<const double*, most_materials> e{};
        for (long k = 0; k < K; ++k) e[k] = state.cells.e[k].data() + first;
        const double *const vx = state.cells.vx.data() + first, *const vz =
                                                                    state.cells.vz.data() + first;
        const auto row_of = [=](auto& column) { return column.data() + first; };
        double *const mass_c = row_of(cells.mass), *const per_mass = row_of(cells.per_mass),
                      *const rho = row_of(cells.rho), *const filled = row_of(cells.filled),
                      *const p = row_of(cells.p), *const c = row_of(cells.c);
        CellVelocity* const v = row_of(cells.v);
        for (long i = 0; i < grid.x.cells; ++i) {
            const double V = grid.cell_area() * cells.ring[i + 1];
            double* const M = &cells.M[(first + i) * K];
            double* const share = &cells.share[(first + i) * K];
            double mass = 0;
            for (long k = 0; k < K; ++k) {
                mass += M[k];
                U[k] = M[k] * e[k][i];
            }
            const CellState cell = find_equilibrium(materials, M, U.data(), V, share);
            double part = 1;  // of the cell that is not void
            if (cell.surface) {
                part = 0;
                for (long k = 0; k < K; ++k)
                    part += cell.compressibility * share[k] * stiffness(materials[k], cell.p);
            }
            mass_c[i] = mass;
            per_mass[i] = mass > 0 ? 1 / mass : 0.0;
            rho[i] = mass / V;
            filled[i] = mass > 0 ? 1 : 0;
            p[i] = cell.p;
            c[i] = cell.compressibility > 0 ? part * std::sqrt(V / (mass * cell.compressibility))
                                            : 0.0;
            v[i] = {vx[i], vz[i]};
        }
    });
    fill_ghosts(grid, problem.boundaries, cells);
    for (const Side side : all_sides) {
        const Boundary& end = problem.boundaries.side[side];
        if (end.kind != BoundaryKind::open || end.pressure == 0) continue;
        bool reached = false;
        for_each_ghost(grid, side,
                       [&](long, long inside) { reached = reached || cells.filled[inside] != 0; });
        if (!reached)
            common::fail("there is no fluid at ", side_names[side], " at t = ", state.time,
                         ", and the pressure outside, ", end.pressure,
                         ", does not reach it across a void: take flip, where it does, or "
                         "boundary.pressure_",
                         side_names[side], " = 0, or end before");
    }
}

namespace detail {

// The largest of what of_cell(n) says.
template <class OfCell>
double largest_over_cells(const Grid& grid, PicCells& cells, const OfCell& of_cell) {
    for_each_row_of_cells(grid, [&](long j) {
        const long first = grid.index(0, j), end = first + grid.x.cells;
        double most = 0;
#pragma omp simd reduction(max : most)
        for (long n = first; n < end; ++n) most = std::max(most, of_cell(n));
        cells.row[j] = most;
    });
    return std::ranges::max(cells.row);
}

// Rate at which the fastest signal crosses a cell. The speed of sound counts as no less than
// sqrt(P/rho), what the pressure P on a face can give to a light cell.
inline double rate_of_signals(const Grid& grid, PicCells& cells) {
    const bool plane = is_plane(grid);
    const double per_dx = 1 / grid.x.spacing(), per_dz = plane ? 1 / grid.z.spacing() : 0.0,
                 both = std::sqrt(per_dx * per_dx + per_dz * per_dz);
    const long stride = grid.stride();
    const Values p = cells.p, c = cells.c, filled = cells.filled, rho = cells.rho;
    const CellVelocity* const velocity = cells.v.data();
    return largest_over_cells(grid, cells, [=](long n) {
        const CellVelocity& v = velocity[n];
        double P = 0;
        const auto face = [&](long m) { P = std::max(P, filled[m] * 0.5 * (p[n] + p[m])); };
        face(n - 1), face(n + 1);
        if (plane) face(n - stride), face(n + stride);
        const double c2 = std::max(c[n] * c[n], filled[n] * P / (rho[n] + 1e-300));
        return filled[n] *
               (std::fabs(v.x) * per_dx + std::fabs(v.z) * per_dz + std::sqrt(c2) * both);
    });
}

// Rate at which viscosity takes away differences of velocity, all faces of a cell together: at a face
// q (1/rho + 1/rho_beyond)/(-du dx), whose harmonic mean of densities cancels.
inline double rate_of_viscosity(const Grid& grid, const ArtificialViscosity& viscosity,
                                PicCells& cells) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const bool plane = is_plane(grid);
    const long stride = grid.stride();
    const Values c = cells.c, filled = cells.filled;
    const CellVelocity* const v = cells.v.data();
    return largest_over_cells(grid, cells, [=](long n) {
        double rate = 0;
        const auto face = [&](long m, double du, double per_distance) {
            const double closes = du < 0 ? 2 * per_distance : 0.0;
            rate += closes * filled[m] * viscosity.slope(1, 0.5 * (c[n] + c[m]), du);
        };
        face(n + 1, v[n + 1].x - v[n].x, per_dx);
        face(n - 1, v[n].x - v[n - 1].x, per_dx);
        if (plane) {
            face(n + stride, v[n + stride].z - v[n].z, per_dz);
            face(n - stride, v[n].z - v[n - stride].z, per_dz);
        }
        return filled[n] * rate;
    });
}

}  // namespace detail

/// The next time step.
///   dt = cfl / max over cells of [|vx|/dx + |vz|/dz + c sqrt(1/dx^2 + 1/dz^2)], to which the largest
///        rate_of_swirl() is added where the fluid turns about the axis;
/// at most cfl sqrt(dx/a), a the largest acceleration by gravity and trap plus that of the centrifugal
/// force; 1/rate_of_viscosity(), in which viscosity brings two cells to one velocity; and 1.2 times the
/// last step. A fixed limits.dt overrules all of them.
/// in:     cells after find_pressure(); the step and time of the state
/// errors: NumericalError when the step gets so short that the run would never end
inline double largest_step(const Problem& problem, const State& state, PicCells& cells) {
    const StepLimits& limits = problem.limits;
    if (limits.dt > 0) return limits.dt;

    const Grid& grid = problem.grid;
    const double least_spacing =
        is_plane(grid) ? std::min(grid.x.spacing(), grid.z.spacing()) : grid.x.spacing();
    const double turns = problem.swirl ? rate_of_swirl(problem, state.particles, cells) : 0,
                 outward = problem.swirl ? detail::largest_force(grid, cells, 0) : 0,
                 pull = CellAcceleration(problem).largest(grid) + outward,
                 falling = std::sqrt(pull / least_spacing),
                 fastest = std::max(falling, detail::rate_of_signals(grid, cells) + turns),
                 viscous = detail::rate_of_viscosity(grid, problem.q, cells);
    double dt = fastest > 0 ? limits.cfl / fastest : limits.end / 100;
    if (viscous > 0) dt = std::min(dt, 1 / viscous);
    if (state.dt > 0) dt = std::min(dt, 1.2 * state.dt);
    if (!(dt > 1e-10 * limits.end)) {
        common::fail("the time step has fallen to ", dt, " at t = ", state.time,
                     ": some cell has become very fast, hot or light; use more particles per cell "
                     "or more viscosity");
    }
    return dt;
}

}  // namespace flip
