// Particles move with the fluid to their final position, and cross the boundaries of the mesh.
// [PIC, particles move to final position]
//
//     x_p += dt u~(x_p)                                  u~ area-weighted from the cells around
//
// A particle * is a box as large as a cell, and moves with the velocities of the four cells that it
// overlaps, in proportion to the areas.
//
//     +-------+-------+
//     |   . . | . .   |      here mostly with that of the upper right cell; where empty cells are
//     |   .   | * .   |      near, they are left out and the rest is scaled to 1
//     +---.---+---.---+
//     |   . . | . .   |
//     +-------+-------+
#pragma once

#include <cstring>

#include "flip/boundaries.hpp"
#include "flip/pic/centrifugal_force.hpp"

namespace flip {

namespace detail {

// The velocities of two cells side by side: x and z of the left one, then of the right one.
using TwoVelocities [[gnu::vector_size(2 * sizeof(CellVelocity))]] = double;

// New positions and donor cells of a batch, the particles [begin, end). Places and motion are found for
// all of them in loops that vectorize; between these each particle fetches the velocities of its cells.
// out: how many are beyond a boundary of the mesh
template <bool plane, bool holes>
long move_batch(const Grid& grid, double dt, long begin, long end, Particles& particles,
                PicCells& cells) {
    double *const x_p = particles.x_p.data() + begin, *const z_p = particles.z_p.data() + begin;
    int* const donor = cells.donor.data() + begin;
    const CellVelocity* const v = cells.v_tilde.data();
    const double* const filled = cells.filled.data();
    const CellAlong column(grid.x), row(grid.z);
    const long count = end - begin;
    const int stride = int(grid.stride()), first = int(grid.index(0, 0));
    int lower_left[batch_size];                // of the four cells, or the left one of two
    double f[batch_size], g[batch_size];       // the parts that the right and the upper ones get
    TwoVelocities velocity[batch_size];        // of the columns on the left and on the right
    [[maybe_unused]] double area[batch_size];  // that is not over empty cells
#pragma omp simd
    for (long k = 0; k < count; ++k) {
        const double s = (x_p[k] - column.low) * column.per_cell;
        const int i = int(s), right = int(s + 0.5);  // of the two columns of cells
        f[k] = s + 0.5 - right;
        donor[k] = first + (i < column.last ? i : column.last);
        lower_left[k] = first + right - 1;
        if constexpr (plane) {
            const double t = (z_p[k] - row.low) * row.per_cell;
            const int j = int(t), up = int(t + 0.5);  // of the two rows of cells
            g[k] = t + 0.5 - up;
            donor[k] += (j < row.last ? j : row.last) * stride;
            lower_left[k] += (up - 1) * stride;
        }
    }

    for (long k = 0; k < count; ++k) {
        const long n = lower_left[k];
        TwoVelocities low, high;
        std::memcpy(&low, v + n, sizeof low);
        if constexpr (plane) {
            std::memcpy(&high, v + n + stride, sizeof high);
            velocity[k] = (1 - g[k]) * low + g[k] * high;
        } else {
            velocity[k] = low;
        }
        if constexpr (holes) {
            double left = filled[n], right = filled[n + 1];
            if constexpr (plane) {
                left += g[k] * (filled[n + stride] - left);
                right += g[k] * (filled[n + stride + 1] - right);
            }
            area[k] = (1 - f[k]) * left + f[k] * right;
        }
    }

    const double low_x = grid.x.low, high_x = grid.x.high(), low_z = grid.z.low,
                 high_z = grid.z.high();
    long inside = 0;
#pragma omp simd reduction(+ : inside)
    for (long k = 0; k < count; ++k) {
        double left = dt * (1 - f[k]), right = dt * f[k];
        if constexpr (holes) left /= area[k], right /= area[k];
        const double x = x_p[k] + (left * velocity[k][0] + right * velocity[k][2]);
        x_p[k] = x;
        bool here = (x >= low_x) & (x < high_x);
        if constexpr (plane) {
            const double z = z_p[k] + (left * velocity[k][1] + right * velocity[k][3]);
            z_p[k] = z;
            here = here & (z >= low_z) & (z < high_z);
        }
        inside += here ? 1 : 0;
    }
    if (inside == count) return 0;

    const auto count_outside = [&](const common::Axis& axis, double* x) {
        const double low = axis.low, high = axis.high();
        for (long k = 0; k < count; ++k) x[k] = wrap(axis, x[k]);
        long outside = 0;
        for (long k = 0; k < count; ++k) outside += x[k] >= low && x[k] <= high ? 0 : 1;
        return outside;
    };
    return count_outside(grid.x, x_p) + (plane ? count_outside(grid.z, z_p) : 0);
}

// Whether an empty cell is among those that particles of row j, or one beside it, look at.
inline bool has_holes(const Grid& grid, const Field& filled, long j) {
    const long reach = is_plane(grid) ? 2 : 0;
    double least = 1;
    for (long b = std::max(j - reach, -1L); b <= std::min(j + reach, grid.z.cells); ++b) {
        const double* row = filled.data() + grid.index(-1, b);
        for (long i = 0; i < grid.x.cells + 2; ++i) least = std::min(least, row[i]);
    }
    return least == 0;
}

}  // namespace detail

/// Harlow's particles know their mass and material, where they are, and how they turn about the axis:
/// clears all other columns.
inline void clear_motion(Particles& particles) {
    for (auto* column : {&particles.vx_p, &particles.vz_p, &particles.e_p, &particles.V_p,
                         &particles.Cxx_p, &particles.Cxz_p, &particles.Czx_p, &particles.Czz_p})
        column->clear();
}

/// Particles that have left are removed, and those that have entered are added, out of order.
/// out:    budget: mass, momentum and energy of what crossed, with u~ and I~ of the donor cell; the
///         donor of those that enter is a corner of the ghosts, one for each side, which holds its
///         inflow
/// errors: NumericalError for a particle beyond a wall
inline void apply_particle_boundaries(const Problem& problem, double dt, State& state,
                                      PicCells& cells) {
    Particles& particles = state.particles;
    remove_outflow(problem, state.time + dt, particles, [&](long p) {
        const long A = cells.donor[p];
        const CellVelocity& v = cells.v_tilde[A];
        double e = cells.e_tilde[A * cells.materials + particles.material[p]];
        if (problem.swirl) {
            e += cells.swirl[p];
            state.budget.enter_swirl(-particles.m_p[p], particles.L_p[p], particles.x_p[p]);
        }
        state.budget.enter(-particles.m_p[p], v.x, v.z, e);
        cells.donor[p] = -1;
    });
    if (problem.swirl) {
        std::size_t kept = 0;
        for (std::size_t p = 0; p < cells.donor.size(); ++p)
            if (cells.donor[p] >= 0) cells.swirl[kept++] = cells.swirl[p];
        cells.swirl.resize(kept);
    }
    std::erase(cells.donor, -1);

    const std::array<long, 4> added = add_inflow(problem, state.time, dt, particles);
    clear_motion(particles);
    const Grid& grid = problem.grid;
    for (const Side side : all_sides) {
        const Inflow& in = problem.boundaries.side[side].inflow;
        const long corner = grid.index(side & 1 ? grid.x.cells : -1, side & 2 ? grid.z.cells : -1);
        cells.v_tilde[corner] = {in.vx, in.vz};
        for (long k = 0; k < cells.materials; ++k)
            cells.e_tilde[corner * cells.materials + k] = in.e;
        for (long k = 0; k < added[side]; ++k) {
            const std::size_t p = cells.donor.size();
            state.budget.enter(particles.m_p[p], in.vx, in.vz, in.e);
            if (problem.swirl) {
                state.budget.enter_swirl(particles.m_p[p], particles.L_p[p], particles.x_p[p]);
                cells.swirl.push_back(0);
            }
            cells.donor.push_back(int(corner));
        }
    }
}

/// Particles move with the fluid to their final position; those that leave and enter do so.
///   x_p += dt u~(x_p)
/// in:     cells after accelerate_cells(); particles in rows
/// out:    positions, all on the mesh; donor, the cell that each particle comes from
/// exact:  one velocity everywhere moves every particle by it, also beside empty cells
/// errors: NumericalError for a particle beyond a wall, or a position that is not finite
/// note:   in a single row of cells nothing moves along z
/// source: [PIC, particles move to final position]
inline void move_particles(const Problem& problem, double dt, State& state, PicCells& cells) {
    const Grid& grid = problem.grid;
    Particles& particles = state.particles;
    cells.donor.resize(particles.x_p.size());
    const double outside = sum_over_rows(grid, cells, [&](long j) {
        const bool holes = detail::has_holes(grid, cells.filled, j);
        const auto move =
            is_plane(grid)
                ? (holes ? detail::move_batch<true, true> : detail::move_batch<true, false>)
                : (holes ? detail::move_batch<false, true> : detail::move_batch<false, false>);
        const long begin = particles.first_of_row[j], end = particles.first_of_row[j + 1];
        long count = 0;
        for (long p = begin; p < end; p += batch_size)
            count += move(grid, dt, p, std::min(end, p + batch_size), particles, cells);
        return double(count);
    });
    if (problem.swirl) take_swirl(particles, cells);
    if (outside > 0 || problem.boundaries.has(BoundaryKind::inflow))
        apply_particle_boundaries(problem, dt, state, cells);
}

}  // namespace flip
