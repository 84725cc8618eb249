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

#include "flip/pic_cells.hpp"

namespace flip {

/// Artificial viscosity on one face between two cells.
///   q = rho (-du) (linear c + quadratic (-du)) where du = u_right - u_left < 0, else 0
/// note:   the method's own viscosity, rho |u| dx/2, is missing where the fluid stands still
struct Viscosity {
    double linear, quadratic;
    /// q/(-du)
    double slope(double rho, double c, double du) const {
        return rho * (linear * c - quadratic * du);
    }
    double operator()(double rho, double c, double du) const {
        return du < 0 ? -du * slope(rho, c, du) : 0.0;
    }
};

/// The acceleration of gravity and of the trap at the center of cell (i, j); in a single row
/// nothing moves along z.
struct BodyForce {
    double x_first, z_first, x_change, z_change;
    explicit BodyForce(const Case& w) {
        const auto first = [&](const common::Axis& a, double g) {
            return g + w.trap * 0.5 * (a.length - a.spacing());
        };
        x_first = first(w.grid.x, w.gravity_x);
        x_change = -w.trap * w.grid.x.spacing();
        z_first = w.plane() ? first(w.grid.z, w.gravity_z) : 0.0;
        z_change = w.plane() ? -w.trap * w.grid.z.spacing() : 0.0;
    }
    double x(long i) const { return x_first + x_change * static_cast<double>(i); }
    double z(long j) const { return z_first + z_change * static_cast<double>(j); }
    /// The largest of both, over the mesh.
    double largest(const Grid& grid) const {
        return std::max({std::fabs(x(0)), std::fabs(x(grid.x.cells - 1)), std::fabs(z(0)),
                         std::fabs(z(grid.z.cells - 1))});
    }
};

/// The state of every cell: how its materials share it, their common pressure, the speed of sound.
///   c^2 = 1/(rho compressibility);  of a cell with a free surface, that of the material in it
/// in:     masses of the cells and what the state knows of them
/// out:    mass, per_mass, filled, p, c, share, v, with ghosts
inline void share_pressure(const Case& w, const State& state, PicCells& cells) {
    const Grid& grid = w.grid;
    const std::size_t K = cells.materials;
    const double V = grid.cell_area();
    for_each_row_of_cells(grid, [&](long j) {
        std::array<double, most_materials> U{};
        for (long i = 0; i < grid.x.cells; ++i) {
            const long n = grid.index(i, j);
            const auto at = static_cast<std::size_t>(n);
            double* const M = &cells.M[at * K];
            double* const share = &cells.share[at * K];
            double mass = 0;
            for (std::size_t k = 0; k < K; ++k) {
                mass += M[k];
                U[k] = M[k] * state.cells.e[k][n];
            }
            const CellState cell = share_cell(w.materials, M, U.data(), V, share);
            double part = 1;  // of the cell that is not void
            if (cell.surface) {
                part = 0;
                for (std::size_t k = 0; k < K; ++k)
                    part += cell.compressibility * share[k] * stiffness(w.materials[k], cell.p);
            }
            cells.mass[n] = mass;
            cells.per_mass[n] = mass > 0 ? 1 / mass : 0.0;
            cells.filled[n] = mass > 0 ? 1 : 0;
            cells.p[n] = cell.p;
            cells.c[n] = cell.compressibility > 0
                             ? part * std::sqrt(V / (mass * cell.compressibility))
                             : 0.0;
            cells.v[at] = {state.cells.vx[n], state.cells.vz[n]};
        }
    });
    fill_ghosts(w, cells);
}

namespace detail {

// The largest of what of_cell(n) says.
template <class OfCell>
double largest_over_cells(const Grid& grid, PicCells& cells, const OfCell& of_cell) {
    for_each_row_of_cells(grid, [&](long j) {
        double most = 0;
        for (long i = 0; i < grid.x.cells; ++i) most = std::max(most, of_cell(grid.index(i, j)));
        cells.row[static_cast<std::size_t>(j)] = most;
    });
    return *std::max_element(cells.row.begin(), cells.row.end());
}

// Rate at which the fastest signal crosses a cell. The speed of sound counts as no less than
// sqrt(P/rho), what the pressure P on a face can give to a light cell.
inline double rate_of_signals(const Case& w, PicCells& cells) {
    const Grid& grid = w.grid;
    const bool plane = w.plane();
    const double per_dx = 1 / grid.x.spacing(), per_dz = plane ? 1 / grid.z.spacing() : 0.0,
                 both = std::sqrt(per_dx * per_dx + per_dz * per_dz), V = grid.cell_area();
    const long stride = grid.stride();
    const Field &p = cells.p, &c = cells.c, &filled = cells.filled;
    return largest_over_cells(grid, cells, [&](long n) {
        const CellVelocity& v = cells.v[static_cast<std::size_t>(n)];
        double P = 0;
        const auto face = [&](long m) { P = std::max(P, filled[m] * 0.5 * (p[n] + p[m])); };
        face(n - 1), face(n + 1);
        if (plane) face(n - stride), face(n + stride);
        const double c2 = std::max(c[n] * c[n], P * V * cells.per_mass[n]);
        return filled[n] *
               (std::fabs(v.x) * per_dx + std::fabs(v.z) * per_dz + std::sqrt(c2) * both);
    });
}

// Rate at which viscosity takes away differences of velocity, all faces of a cell together.
inline double rate_of_viscosity(const Case& w, PicCells& cells) {
    const Grid& grid = w.grid;
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing(), V = grid.cell_area();
    const long stride = grid.stride();
    const Viscosity viscosity{w.q_linear, w.q_quadratic};
    const Field &mass = cells.mass, &per_mass = cells.per_mass, &c = cells.c;
    const auto v = [&](long m) { return cells.v[static_cast<std::size_t>(m)]; };
    return largest_over_cells(grid, cells, [&](long n) {
        double rate = 0;
        const auto face = [&](long m, double du, double per_distance) {
            if (!(du < 0)) return;
            const double slope =
                viscosity.slope(0.5 * (mass[n] + mass[m]) / V, 0.5 * (c[n] + c[m]), du);
            rate += cells.filled[m] * slope * V * (per_mass[n] + per_mass[m]) * per_distance;
        };
        face(n + 1, v(n + 1).x - v(n).x, per_dx);
        face(n - 1, v(n).x - v(n - 1).x, per_dx);
        if (w.plane()) {
            face(n + stride, v(n + stride).z - v(n).z, per_dz);
            face(n - stride, v(n).z - v(n - stride).z, per_dz);
        }
        return cells.filled[n] * rate;
    });
}

}  // namespace detail

/// The next time step.
///   dt = cfl / max over cells of [|vx|/dx + |vz|/dz + c sqrt(1/dx^2 + 1/dz^2)]
/// no longer than it takes viscosity to bring two cells together or gravity to move a body at rest
/// by cfl^2 dx, or than 1.2 times the last step. A fixed time.dt overrules all of them.
/// in:     cells after share_pressure(); the step and time of the state
/// errors: NumericalError when the step gets so short that the run would never end
inline double largest_step(const Case& w, const State& state, PicCells& cells) {
    if (w.dt > 0) return w.dt;

    const Grid& grid = w.grid;
    const double least_spacing =
        w.plane() ? std::min(grid.x.spacing(), grid.z.spacing()) : grid.x.spacing();
    const double falling = std::sqrt(BodyForce(w).largest(grid) / least_spacing),
                 fastest = std::max(falling, detail::rate_of_signals(w, cells)),
                 viscous = detail::rate_of_viscosity(w, cells);
    double dt = fastest > 0 ? w.cfl / fastest : w.end / 100;
    if (viscous > 0) dt = std::min(dt, 1 / viscous);
    if (state.dt > 0) dt = std::min(dt, 1.2 * state.dt);
    if (!(dt > 1e-10 * w.end)) {
        throw common::NumericalError("the time step has fallen to " + common::shown(dt) +
                                     " at t = " + common::shown(state.time) +
                                     ": some cell has become very fast, hot or light; use more "
                                     "particles per cell or more viscosity");
    }
    return dt;
}

namespace detail {

// The pressure between two cells; none where one of them is empty.
inline double face_pressure(const PicCells& cells, long left, long right, double q) {
    return cells.filled[left] * cells.filled[right] * (0.5 * (cells.p[left] + cells.p[right]) + q);
}

// Viscous pressure on the faces below row j, and between its cells.
inline void viscous_pressure(const Case& w, long j, PicCells& cells) {
    const Grid& grid = w.grid;
    const long nx = grid.x.cells, stride = grid.stride();
    const Viscosity viscosity{w.q_linear, w.q_quadratic};
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
    if (w.plane())
        for (long m = n; m < n + nx; ++m) q_z[m] = q(m - stride, m, v[m].z - v[m - stride].z);
}

// Calls visit(inside, beyond, face) for the faces on one end of the mesh.
template <class Visit>
void for_each_face_on(const Grid& grid, End end, const Visit& visit) {
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
inline void accelerate_cells(const Case& w, double dt, State& state, PicCells& cells) {
    const Grid& grid = w.grid;
    const long nx = grid.x.cells, nz = grid.z.cells, stride = grid.stride();
    const bool plane = w.plane();
    const double A_x = grid.z.spacing(), A_z = grid.x.spacing();
    const BodyForce g(w);
    for_each_row_of_cells(grid, [&](long j) {
        detail::viscous_pressure(w, j, cells);
        if (j == nz - 1) detail::viscous_pressure(w, nz, cells);
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
    fill_ghosts(w, cells.incoming, cells.v_tilde);

    Books& books = state.books;
    for (const End end : {x_low, x_high, z_low, z_high}) {
        const bool along_x = end == x_low || end == x_high;
        if (w.is(end, "periodic") || (!along_x && !plane)) continue;
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
inline void do_work(const Case& w, double dt, State& state, PicCells& cells) {
    const Grid& grid = w.grid;
    const long nx = grid.x.cells, stride = grid.stride();
    const std::size_t K = cells.materials;
    const bool plane = w.plane();
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
    for (const End end : {x_low, x_high, z_low, z_high}) {
        const bool along_x = end == x_low || end == x_high;
        if (w.is(end, "periodic") || w.is(end, "slip") || (!along_x && !plane)) continue;
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
    const BodyForce g(w);
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
