// How a run of pic begins, and how it goes on from a checkpoint.
#pragma once

#include "flip/pic/eulerian_phase.hpp"

namespace flip {

/// The masses of the cells from where the particles are, for a state that was read from a file.
/// exact: the same bits as repartition() had made
inline void weigh_cells(const Problem& problem, State& state, PicCells& cells) {
    cells.home.clear();
    detail::sort_with_homes(problem, state.particles, cells);
    const Particles& particles = state.particles;
    const Columns column(problem.grid.x);
    std::fill(cells.M.begin(), cells.M.end(), 0.0);
    for (long j = 0; j < problem.grid.z.cells; ++j) {
        for (auto p = static_cast<std::size_t>(particles.first_of_row[static_cast<std::size_t>(j)]);
             p < static_cast<std::size_t>(particles.first_of_row[static_cast<std::size_t>(j) + 1]);
             ++p) {
            const auto n =
                static_cast<std::size_t>(problem.grid.index(column(particles.x_p[p]), j));
            cells.M[n * cells.materials + static_cast<std::size_t>(particles.material[p])] +=
                particles.m_p[p];
        }
    }
    for (long n = 0; n < problem.grid.size(); ++n) {
        double mass = 0;
        for (std::size_t k = 0; k < cells.materials; ++k)
            mass += cells.M[static_cast<std::size_t>(n) * cells.materials + k];
        cells.mass[n] = mass;
    }
}

/// The state at t = 0: cells from the velocities and energies that the particles have once, and
/// then forget.
/// exact: mass, momentum and total energy of the particles; what their velocities differ within a
///        cell is heat
inline State initial_state(const Problem& problem, Particles loaded, PicCells& cells) {
    State state;
    state.particles = std::move(loaded);
    for (Field* f : {&state.cells.vx, &state.cells.vz}) *f = Field::Zero(problem.grid.size());
    state.cells.e.assign(problem.materials.size(), Field::Zero(problem.grid.size()));
    detail::sort_with_homes(problem, state.particles, cells);
    const Particles& particles = state.particles;
    const double *vx_p = particles.vx_p.data(), *vz_p = particles.vz_p.data(),
                 *e_p = particles.e_p.data();
    detail::collect(
        problem,
        [=](long p) -> detail::Brought {
            return {vx_p[p], vz_p[p], e_p[p]};
        },
        state, cells);
    detail::forget_motion(state.particles);
    return state;
}

}  // namespace flip
