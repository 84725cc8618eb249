// The Eulerian phase: particles have moved with the fluid, and what they bring from cell to cell
// restores the mesh. [PIC, Eulerian phase]
//
//     M' = sum m     M' u' = sum m u~_A     M' (I' + u'^2/2) = sum m (I~_A + u~_A^2/2)
//
// with sums over all particles that are now in a cell, and A the cell that each comes from, its
// donor. A particle brings the mean of its donor: this is the method's viscosity and heat conduction,
// D = |u| (dx - |u| dt)/2, and what is not conserved as kinetic energy becomes heat.
#pragma once

#include <array>
#include <cstring>
#include <string>

#include "common/run/sentence.hpp"
#include "flip/pic/move_particles.hpp"

namespace flip {

namespace detail {

// What one particle brings, per mass.
struct Contribution {
    double vx, vz, e;
};
// Of what it brings, the sums of a cell and those of one of its materials, each added as one vector.
using FourSums [[gnu::vector_size(4 * sizeof(double))]] =
    double;                                                       // vx, vz, kinetic energy, nothing
using TwoSums [[gnu::vector_size(2 * sizeof(double))]] = double;  // mass, internal energy

[[noreturn]] inline void refuse_cell(const Problem& problem, const State& state,
                                     const PicCells& cells, long n) {
    const Grid& grid = problem.grid;
    std::string what =
        "the density, " + common::format(cells.mass[n] / cell_volume(grid, column_of(grid, n)));
    for (long k = 0; k < cells.materials; ++k) {
        const double e = state.cells.e[k][n];
        if (!(e >= 0))
            what = "the internal energy of " + problem.materials[k].name + ", " + common::format(e);
    }
    common::fail(what, ", is negative or not finite ", cell_and_time(grid, n, state.time),
                 ": use a smaller time.cfl, more particles per cell, or more viscosity");
}

// Sums over all particles, cell by cell; contribution(p) says what particle p brings.
// out: cells restored. Internal energy below zero by less than 1e-10 of the kinetic energy, or 1e-13 of
// that of the rotation about the axis, is round-off. Where fluid turns, a cold gas with less than none
// takes what it lacks from the motion along r, as far as that has it: no ring conserves its momentum.
template <bool swirl = false, class What>
void sum_contributions(const Problem& problem, const What& contribution, State& state,
                       PicCells& cells) {
    const Grid& grid = problem.grid;
    const Particles& particles = state.particles;
    const long nx = grid.x.cells;
    const double round_off = swirl ? 1e-200 + 1e-13 * cells.fastest_swirl2 : 1e-200;
    const std::size_t K = cells.materials, width = cells.width_of_sums();
    const double* m_p = particles.m_p.data();
    const int* material = particles.material.data();
    for_each_row_of_cells(
        grid, [&](long j) { std::fill_n(&cells.sums[j * nx * width], nx * width, 0.0); });
    for_each_in_cell(grid, particles, [=, sums = cells.sums.data()](long p, long at) {
        const Contribution b = contribution(p);
        double* const cell = sums + at * width;
        const auto add = [m = m_p[p]]<class Numbers>(double* to, const Numbers& brought) {
            Numbers sum;
            std::memcpy(&sum, to, sizeof sum);
            sum += m * brought;
            std::memcpy(to, &sum, sizeof sum);
        };
        add(cell, FourSums{b.vx, b.vz, 0.5 * (b.vx * b.vx + b.vz * b.vz), 0});
        add(cell + 4 + 2 * material[p], TwoSums{1, b.e});
    });
    for_each_row_of_cells(grid, [&](long j) {
        const double* const sums = &cells.sums[j * nx * width];
        double *const vx_c = state.cells.vx.data(), *const vz_c = state.cells.vz.data(),
                      *const mass_c = cells.mass.data();
        std::array<double*, most_materials> e_c{};
        for (std::size_t k = 0; k < K; ++k) e_c[k] = state.cells.e[k].data();
        double refused = -1;
        for (long i = 0; i < nx; ++i) {
            const long n = grid.index(i, j);
            const double* const cell = sums + i * width;
            double* const M = &cells.M[n * K];
            double mass = 0;
            for (std::size_t k = 0; k < K; ++k) {
                M[k] = cell[4 + 2 * k];
                mass += M[k];
            }
            // [mix]
            const double per_mass = mass > 0 ? 1 / mass : 0.0;
            const double vx = cell[0] * per_mass, vz = cell[1] * per_mass,
                         kinetic = cell[2] * per_mass;
            const double heat = kinetic - 0.5 * (vx * vx + vz * vz);
            // [/mix]
            bool sound = mass >= 0 && std::isfinite(mass + kinetic);
            double lent = 0;  // by the motion along r, per mass of the cell
            for (std::size_t k = 0; k < K; ++k) {
                double e = M[k] > 0 ? cell[5 + 2 * k] / M[k] + heat : 0.0;
                if constexpr (swirl) {
                    const double lacks = -e * M[k] * per_mass;
                    if (e < 0 && lent + lacks <= 0.5 * vx * vx) lent += lacks, e = 0;
                }
                e_c[k][n] = e;
                sound = sound && e >= -1e-10 * kinetic - round_off && std::isfinite(e);
            }
            vx_c[n] = vx;
            if constexpr (swirl)
                if (lent > 0) vx_c[n] = std::copysign(std::sqrt(vx * vx - 2 * lent), vx);
            vz_c[n] = vz;
            mass_c[n] = mass;
            if (!sound && refused < 0) refused = double(n);
        }
        cells.row[j] = refused;
    });
    for (const double refused : cells.row)
        if (refused >= 0) refuse_cell(problem, state, cells, long(refused));
}

// What the particles have brought with them follows them to their places in the order of the rows.
inline void carry_with_particles(PicCells& cells) {
    common::carry_to_place(cells.donor, cells.sort.numbers.target, cells.sort.labels);
    if (!cells.swirl.empty())
        common::carry_to_place(cells.swirl, cells.sort.numbers.target, cells.sort.numbers.column);
}

// Particles in rows of cells, with the donor cells where they have some.
inline void keep_in_rows_with_donors(const Grid& grid, Particles& particles, PicCells& cells) {
    if (is_plane(grid)) {
        if (keep_in_rows(grid, cells.sort, particles) && !cells.donor.empty())
            carry_with_particles(cells);
    } else {
        particles.first_of_row = {0, int(particles.count())};
    }
}

}  // namespace detail

/// The Eulerian mesh is restored from what particles bring: mass, momentum and energy.
///   M' = sum m     u' = sum m u~_A / M'     I'_k = sum_k m I~_Ak / M'_k + H/M'
/// where H = sum m u~_A^2/2 - M' u'^2/2 >= 0 is the heat of mixing, shared by mass; a particle that
/// turns about the axis brings beside I~ what its move leaves of the energy of that.
/// in:     donor and positions; v_tilde, e_tilde
/// out:    particles in rows; velocity and internal energy in the state; M and mass of the cells
/// exact:  mass, momentum, total energy; a cell without particles is empty to the last bit
/// errors: NumericalError for a density or energy that is negative or not finite
/// source: [PIC, Eulerian phase]
inline void repartition(const Problem& problem, State& state, PicCells& cells) {
    detail::keep_in_rows_with_donors(problem.grid, state.particles, cells);
    const int *donor = cells.donor.data(), *material = state.particles.material.data();
    const CellVelocity* v_tilde = cells.v_tilde.data();
    const double* e_tilde = cells.e_tilde.data();
    const long K = cells.materials;
    const auto from_donor = [=](long p) -> detail::Contribution {
        const CellVelocity& v = v_tilde[donor[p]];
        return {v.x, v.z, e_tilde[donor[p] * K + material[p]]};
    };
    if (!problem.swirl) return detail::sum_contributions(problem, from_donor, state, cells);
    const double* swirl = cells.swirl.data();
    detail::sum_contributions<true>(
        problem,
        [=](long p) {
            detail::Contribution brought = from_donor(p);
            brought.e += swirl[p];
            return brought;
        },
        state, cells);
}

/// The state at t = 0: cells from the velocities and energies that the particles have once, and
/// then forget.
/// in:    loaded, particles with velocity and internal energy
/// exact: mass, momentum and total energy of the particles; what their velocities differ within a
///        cell is heat
inline State initial_state(const Problem& problem, Particles loaded, PicCells& cells) {
    State state;
    state.particles = std::move(loaded);
    const long size = problem.grid.size();
    state.cells = {Field::Zero(size), Field::Zero(size),
                   std::vector<Field>(cells.materials, Field::Zero(size))};
    detail::keep_in_rows_with_donors(problem.grid, state.particles, cells);
    const Particles& particles = state.particles;
    const double *vx_p = particles.vx_p.data(), *vz_p = particles.vz_p.data(),
                 *e_p = particles.e_p.data();
    detail::sum_contributions(
        problem,
        [=](long p) -> detail::Contribution {
            return {vx_p[p], vz_p[p], e_p[p]};
        },
        state, cells);
    clear_motion(state.particles);
    return state;
}

/// The masses of the cells from where the particles are, for a state that was read from a file.
/// exact: the same bits as repartition() had made
inline void sum_cell_masses(const Grid& grid, State& state, PicCells& cells) {
    cells.donor.clear();
    detail::keep_in_rows_with_donors(grid, state.particles, cells);
    const Particles& particles = state.particles;
    const long K = cells.materials, nx = grid.x.cells;
    std::fill(cells.M.begin(), cells.M.end(), 0.0);
    detail::for_each_in_cell(grid, particles, [&](long p, long at) {
        cells.M[grid.index(at % nx, at / nx) * K + particles.material[p]] += particles.m_p[p];
    });
    for (long n = 0; n < grid.size(); ++n) {
        double mass = 0;
        for (long k = 0; k < K; ++k) mass += cells.M[n * K + k];
        cells.mass[n] = mass;
    }
}

}  // namespace flip
