// The centrifugal force of fluid that turns about the axis, on cells, and the energy of the rotation
// that pays for it. Particles keep their angular momentum, and cells do not mix it.
//
//     particle                      cell                      particle
//     L_p at r  -- f_p, before -->  u~ += dt sum m f_p/M
//                                   work M f . ubar  -->      brings I~ + E(r) - E(r') - dt f_p ubar
//
// What a cell gains by the force of a particle in it, the particle has lost: total energy is exact. What
// its move from r to r' releases of the energy E beside that comes with it, as heat, to the cell where
// it arrives.
#pragma once

#include "flip/pic/pic_cells.hpp"

namespace flip {

namespace detail {

// Means over the particles of every cell of what of_particle(p, n) says, by mass.
// out: cells.centrifugal
template <class OfParticle>
void mean_of_cells(const Grid& grid, const Particles& particles, const OfParticle& of_particle,
                   PicCells& cells) {
    cells.centrifugal.setZero(grid.size());
    const long nx = grid.x.cells;
    for_each_in_cell(grid, particles, [&](long p, long at) {
        const long n = grid.index(at % nx, at / nx);
        cells.centrifugal[n] += particles.m_p[p] * cells.per_mass[n] * of_particle(p, n);
    });
}

// The largest of the force of a cell times a power of its distance from the axis.
inline double largest_force(const Grid& grid, PicCells& cells, double power) {
    for_each_row_of_cells(grid, [&](long j) {
        double most = 0;
        for (long i = 0; i < grid.x.cells; ++i)
            most = std::max(most, cells.centrifugal[grid.index(i, j)] *
                                      std::pow(grid.x.at(double(i) + 0.5), power));
        cells.row[j] = most;
    });
    return std::ranges::max(cells.row);
}

}  // namespace detail

/// The largest rate at which the fluid of a cell turns, (f/r)^1/2: with the force that grows as it comes
/// nearer to the axis a ring oscillates at no more than 3^1/2 of that.
/// out:    cells.centrifugal, L^2/r^3
inline double rate_of_swirl(const Problem& problem, const Particles& particles, PicCells& cells) {
    detail::mean_of_cells(
        problem.grid, particles,
        [&](long p, long) {
            return centrifugal_force(particles.L_p[p], particles.x_p[p], particles.x_p[p]);
        },
        cells);
    return std::sqrt(detail::largest_force(problem.grid, cells, -1));
}

/// The centrifugal force of this step.
///   sum m f_p/M,  f_p of force_of_step()
/// in:     particles in rows; cells after find_pressure()
/// out:    cells.centrifugal, fastest_swirl2; cells.swirl, f_p
inline void find_centrifugal_force(const Problem& problem, double dt, const State& state,
                                   PicCells& cells) {
    const Particles& particles = state.particles;
    cells.swirl.resize(std::size_t(particles.count()));
    detail::mean_of_cells(
        problem.grid, particles,
        [&](long p, long n) {
            const double e = state.cells.e[particles.material[p]][n];
            return cells.swirl[p] =
                       force_of_step(particles.L_p[p], particles.x_p[p], dt * cells.v[n].x, 0, e);
        },
        cells);
    cells.fastest_swirl2 = detail::largest_force(problem.grid, cells, 1);
}

/// The cells are accelerated by it.
///   u~ += dt sum m f_p/M
inline void add_centrifugal_force(const Grid& grid, double dt, PicCells& cells) {
    for_each_row_of_cells(grid, [&](long j) {
        for (long i = 0; i < grid.x.cells; ++i)
            cells.v_tilde[grid.index(i, j)].x += dt * cells.centrifugal[grid.index(i, j)];
    });
}

/// What is left of the energy of the rotation when the force has done its work.
///   E(r) - dt f_p ubar,  ubar = (u + u~)/2 of the cell
/// in:     v_tilde; cells.swirl, f_p; particles where they were
/// out:    cells.swirl, that energy per mass
inline void work_on_swirl(const Grid& grid, double dt, const Particles& particles,
                          PicCells& cells) {
    const long nx = grid.x.cells;
    detail::for_each_in_cell(grid, particles, [&](long p, long at) {
        const long n = grid.index(at % nx, at / nx);
        cells.swirl[p] = swirl_energy(particles.L_p[p], particles.x_p[p]) -
                         dt * cells.swirl[p] * 0.5 * (cells.v[n].x + cells.v_tilde[n].x);
    });
}

/// Particles have moved: what the rotation does not need where they are now is heat, which comes with
/// them.
///   E(r) - dt f_p ubar - E(r')
/// in/out: cells.swirl
/// exact:  total energy, with the work of the force on the cells; L_p stays
inline void take_swirl(const Particles& particles, PicCells& cells) {
    common::for_each_block(
        particles.count(),
        [&](int, long begin, long end) {
            for (long p = begin; p < end; ++p)
                cells.swirl[p] -= swirl_energy(particles.L_p[p], particles.x_p[p]);
        },
        particles.count());
}

}  // namespace flip
