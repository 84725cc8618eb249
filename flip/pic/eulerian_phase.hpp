// The Eulerian phase: particles have moved with the fluid, and what they carry from cell to cell
// restores the mesh. [PIC, Eulerian phase]
//
//     x_p += dt u~(x_p)                                  u~ area-weighted from the cells around
//     M' = sum m     M' u' = sum m u~_A     M' (I' + u'^2/2) = sum m (I~_A + u~_A^2/2)
//
// with sums over all particles that are now in a cell, and A the cell that each comes from. A
// particle brings the mean of its cell: this is the method's viscosity and heat conduction,
// D = |u| (dx - |u| dt)/2, and what is not conserved as kinetic energy becomes heat.
#pragma once

#include "flip/ends.hpp"
#include "flip/pic/pic_cells.hpp"

namespace flip {

namespace detail {

inline constexpr long chunk = 512;

// New positions and homes of the particles [begin, end) of row j. A particle is a box as large as
// a cell, and moves with the velocities of the four cells that it overlaps, in proportion to the
// areas; where `holes` are near, empty cells have no say.
// out: how many are beyond an end of the mesh
template <bool plane, bool holes>
long move_chunk(const Problem& problem, double dt, long j, long begin, long end,
                Particles& particles, PicCells& cells) {
    const Grid& grid = problem.grid;
    double *const x_p = particles.x_p.data(), *const z_p = particles.z_p.data();
    int* const home = cells.home.data();
    const CellVelocity* const v = cells.v_tilde.data();
    const double* const filled = cells.filled.data();
    const Columns column(grid.x);
    const int stride = static_cast<int>(grid.stride()),
              first = static_cast<int>(grid.index(0, plane ? j : 0));
    const double z_low = grid.z.low, per_dz = 1 / grid.z.spacing();
    const double to_row = static_cast<double>(j);
#pragma omp simd
    for (long p = begin; p < end; ++p) {
        const double s = (x_p[p] - column.low) * column.per_dx;
        const int i = static_cast<int>(s);
        const int right = static_cast<int>(s + 0.5);  // of the two columns of cells
        const double f = s + 0.5 - right;
        home[p] = first + (i < column.last ? i : column.last);
        if constexpr (plane) {
            const double t = (z_p[p] - z_low) * per_dz + 0.5 - to_row;
            const int up = t < 1 ? 0 : 1;
            const double g = t - up;
            const int n = first + (up - 1) * stride + right - 1;
            double w00 = (1 - f) * (1 - g), w10 = f * (1 - g), w01 = (1 - f) * g, w11 = f * g;
            if constexpr (holes) {
                w00 *= filled[n], w10 *= filled[n + 1];
                w01 *= filled[n + stride], w11 *= filled[n + stride + 1];
                const double per_area = 1 / (w00 + w10 + w01 + w11);
                w00 *= per_area, w10 *= per_area, w01 *= per_area, w11 *= per_area;
            }
            x_p[p] += dt * (w00 * v[n].x + w10 * v[n + 1].x + w01 * v[n + stride].x +
                            w11 * v[n + stride + 1].x);
            z_p[p] += dt * (w00 * v[n].z + w10 * v[n + 1].z + w01 * v[n + stride].z +
                            w11 * v[n + stride + 1].z);
        } else {
            const int n = first + right - 1;
            double w0 = 1 - f, w1 = f;
            if constexpr (holes) {
                w0 *= filled[n], w1 *= filled[n + 1];
                const double per_area = 1 / (w0 + w1);
                w0 *= per_area, w1 *= per_area;
            }
            x_p[p] += dt * (w0 * v[n].x + w1 * v[n + 1].x);
        }
    }

    const auto bring_back = [&](const common::Axis& axis, double* x) {
        const double low = axis.low, high = axis.high();
        for (long p = begin; p < end; ++p) x[p] = around(axis, x[p]);
        long lost = 0;
        for (long p = begin; p < end; ++p) lost += x[p] >= low && x[p] <= high ? 0 : 1;
        return lost;
    };
    return bring_back(grid.x, x_p) + (plane ? bring_back(grid.z, z_p) : 0);
}

// Whether an empty cell is among those that particles of row j look at.
inline bool has_holes(const Grid& grid, const Field& filled, long j) {
    const long reach = grid.z.cells > 1 ? 1 : 0;
    double least = 1;
    for (long b = j - reach; b <= j + reach; ++b) {
        const double* row = filled.data() + grid.index(-1, b);
        for (long i = 0; i < grid.x.cells + 2; ++i) least = std::min(least, row[i]);
    }
    return least == 0;
}

// What one particle brings, per mass.
struct Brought {
    double vx, vz, e;
};

[[noreturn]] inline void refuse_cell(const Problem& problem, const State& state,
                                     const PicCells& cells, long i, long j) {
    const long n = problem.grid.index(i, j);
    std::string what =
        "the density, " + common::format(cells.mass[n] / problem.grid.cell_area()) + ",";
    for (std::size_t k = 0; k < cells.materials; ++k) {
        const double e = state.cells.e[k][n];
        if (!(e >= 0))
            what = "the internal energy of " + problem.materials[k].name + ", " +
                   common::format(e) + ",";
    }
    throw common::NumericalError(
        what + " is negative or not finite in the cell at x = " +
        common::format(problem.grid.x.at(static_cast<double>(i) + 0.5)) +
        ", z = " + common::format(problem.grid.z.at(static_cast<double>(j) + 0.5)) +
        " at t = " + common::format(state.time) +
        ": use a smaller time.cfl, more particles per cell, or more viscosity");
}

// Sums over the particles of every row, cell by cell; brought(p) says what particle p brings.
template <class What>
void collect(const Problem& problem, const What& brought, State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    const Particles& particles = state.particles;
    const long nx = grid.x.cells;
    const std::size_t K = cells.materials, width = 3 + 2 * K;
    const Columns column(grid.x);
    const double *x_p = particles.x_p.data(), *m_p = particles.m_p.data();
    const int *material = particles.material.data(), *first = particles.first_of_row.data();
    for_each_row_of_cells(grid, [&](long j) {
        double* const sums = &cells.sums[static_cast<std::size_t>(j * nx) * width];
        std::fill_n(sums, static_cast<std::size_t>(nx) * width, 0.0);
        for (long p = first[j]; p < first[j + 1]; ++p) {
            const double m = m_p[p];
            const Brought b = brought(p);
            double* const cell = sums + static_cast<std::size_t>(column(x_p[p])) * width;
            double* const of_material = cell + 3 + 2 * material[p];
            cell[0] += m * b.vx;
            cell[1] += m * b.vz;
            cell[2] += 0.5 * m * (b.vx * b.vx + b.vz * b.vz);
            of_material[0] += m;
            of_material[1] += m * b.e;
        }

        // Restore the cells. Sound ones have no energy below zero but for round-off.
        double refused = -1;
        for (long i = 0; i < nx; ++i) {
            const long n = grid.index(i, j);
            const double* const cell = sums + static_cast<std::size_t>(i) * width;
            double* const M = &cells.M[static_cast<std::size_t>(n) * K];
            double mass = 0;
            for (std::size_t k = 0; k < K; ++k) {
                M[k] = cell[3 + 2 * k];
                mass += M[k];
            }
            // [mix]
            const double per_mass = mass > 0 ? 1 / mass : 0.0;
            const double vx = cell[0] * per_mass, vz = cell[1] * per_mass,
                         kinetic = cell[2] * per_mass;
            const double heat = kinetic - 0.5 * (vx * vx + vz * vz);
            // [/mix]
            bool sound = mass >= 0 && std::isfinite(mass + kinetic);
            for (std::size_t k = 0; k < K; ++k) {
                const double e = M[k] > 0 ? cell[4 + 2 * k] / M[k] + heat : 0.0;
                state.cells.e[k][n] = e;
                sound = sound && e >= -1e-10 * kinetic - 1e-200 && std::isfinite(e);
            }
            state.cells.vx[n] = vx;
            state.cells.vz[n] = vz;
            cells.mass[n] = mass;
            if (!sound && refused < 0) refused = static_cast<double>(i);
        }
        cells.row[static_cast<std::size_t>(j)] = refused;
    });
    for (long j = 0; j < grid.z.cells; ++j) {
        const double refused = cells.row[static_cast<std::size_t>(j)];
        if (refused >= 0) refuse_cell(problem, state, cells, static_cast<long>(refused), j);
    }
}

// Sorts by row of cells, with the homes where particles have some.
inline void sort_with_homes(const Problem& problem, Particles& particles, PicCells& cells) {
    if (is_plane(problem.grid)) {
        sort_particles(problem.grid, cells.sort, particles);
        if (!cells.home.empty())
            common::carry_to_place(cells.home, cells.sort.numbers.target, cells.sort.labels);
    } else {
        particles.first_of_row = {0, static_cast<int>(particles.count())};
    }
}

// Harlow's particles know their mass and material, and where they are.
inline void forget_motion(Particles& particles) {
    for (auto* column : {&particles.vx_p, &particles.vz_p, &particles.e_p, &particles.V_p,
                         &particles.Cxx_p, &particles.Cxz_p, &particles.Czx_p, &particles.Czz_p})
        column->clear();
}

// Takes away who has left and brings in who enters, with the books.
inline void exchange_with_outside(const Problem& problem, double dt, State& state,
                                  PicCells& cells) {
    Particles& particles = state.particles;
    Books& books = state.books;
    const auto enter = [&](double m, const CellVelocity& v, double e) {
        books.mass += m;
        books.momentum_x += m * v.x;
        books.momentum_z += m * v.z;
        books.energy += m * (e + 0.5 * (v.x * v.x + v.z * v.z));
    };
    const auto leaves = [&](std::size_t p) {
        const auto A = static_cast<std::size_t>(cells.home[p]);
        const auto k = static_cast<std::size_t>(particles.material[p]);
        enter(-particles.m_p[p], cells.v_tilde[A], cells.e_tilde[A * cells.materials + k]);
        cells.home[p] = -1;
    };
    remove_leaving(problem, state.time + dt, particles, leaves);
    std::erase(cells.home, -1);

    const long added = add_inflow(problem, state.time, dt, particles);
    if (added == 0) return;
    forget_motion(particles);
    const Inflow& in = problem.boundaries.inflow;
    const auto corner = static_cast<std::size_t>(outside(problem.grid));
    cells.v_tilde[corner] = {in.vx, in.vz};
    for (std::size_t k = 0; k < cells.materials; ++k)
        cells.e_tilde[corner * cells.materials + k] = in.e;
    cells.home.resize(particles.x_p.size(), outside(problem.grid));
    for (std::size_t p = particles.x_p.size() - static_cast<std::size_t>(added);
         p < particles.x_p.size(); ++p)
        enter(particles.m_p[p], {in.vx, in.vz}, in.e);
}

}  // namespace detail

/// Particles move with the fluid to their final position; those that leave and enter do so.
///   x_p += dt u~(x_p)
/// in:     cells after accelerate_cells(); particles in rows
/// out:    positions, all on the mesh; home, the cell that each particle comes from; first_of_row
///         is void until repartition()
/// exact:  one velocity everywhere moves every particle by it, also beside empty cells
/// errors: NumericalError for a particle beyond a wall, or a position that is not finite
/// note:   in a single row of cells nothing moves along z
/// source: [PIC, particles move to final position]
inline void move_particles(const Problem& problem, double dt, State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    Particles& particles = state.particles;
    cells.home.resize(particles.x_p.size());
    const bool plane = is_plane(problem.grid);
    const double lost = sum_over_rows(grid, cells, [&](long j) {
        const bool holes = detail::has_holes(grid, cells.filled, j);
        const long begin = particles.first_of_row[static_cast<std::size_t>(j)],
                   end = particles.first_of_row[static_cast<std::size_t>(j) + 1];
        long beyond_it = 0;
        for (long p = begin; p < end; p += detail::chunk) {
            const long to = std::min(end, p + detail::chunk);
            beyond_it += plane ? (holes ? detail::move_chunk<true, true>(problem, dt, j, p, to,
                                                                         particles, cells)
                                        : detail::move_chunk<true, false>(problem, dt, j, p, to,
                                                                          particles, cells))
                               : (holes ? detail::move_chunk<false, true>(problem, dt, j, p, to,
                                                                          particles, cells)
                                        : detail::move_chunk<false, false>(problem, dt, j, p, to,
                                                                           particles, cells));
        }
        return static_cast<double>(beyond_it);
    });
    const bool comes_in = problem.boundaries.has(BoundaryKind::inflow);
    if (lost > 0 || comes_in) detail::exchange_with_outside(problem, dt, state, cells);
}

/// The Eulerian mesh is restored from what particles bring: mass, momentum and energy.
///   M' = sum m     u' = sum m u~_A / M'     I'_k = sum_k m I~_Ak / M'_k + H/M'
/// where H = sum m u~_A^2/2 - M' u'^2/2 >= 0 is the heat of mixing, shared by mass.
/// in:     home and positions; v_tilde, e_tilde
/// out:    particles in rows; velocity and internal energy in the state; M and mass of the cells
/// exact:  mass, momentum, total energy; a cell without particles is empty to the last bit
/// errors: NumericalError for a density or energy that is negative or not finite
/// source: [PIC, Eulerian phase]
inline void repartition(const Problem& problem, State& state, PicCells& cells) {
    detail::sort_with_homes(problem, state.particles, cells);
    const int *home = cells.home.data(), *material = state.particles.material.data();
    const CellVelocity* v_tilde = cells.v_tilde.data();
    const double* e_tilde = cells.e_tilde.data();
    const long K = static_cast<long>(cells.materials);
    detail::collect(
        problem,
        [=](long p) -> detail::Brought {
            const CellVelocity& v = v_tilde[home[p]];
            return {v.x, v.z, e_tilde[home[p] * K + material[p]]};
        },
        state, cells);
}

}  // namespace flip
