// on the mesh: the pressure of the cells from what is in them, and how long the step may be.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "flip/flip/mesh.hpp"

namespace flip {

/// Cells of liquid that particles which carry volumes fill less than this are surface: p = 0. A gas
/// fills what there is.
inline constexpr double least_filled = 0.7;

/// A cell has neither pressure nor viscosity if the lightest of its nodes has less than this part of
/// the mass of the heaviest: what pushes on nothing would leave the books.
inline constexpr double lightest_node = 0.01;

/// Internal energy below zero by less than this part of the kinetic energy is round-off.
inline constexpr double cold_enough = 1e-9;

/// Whether a cell reaches to nodes with next to no mass.
inline bool is_frayed(const Grid& grid, const Field& m, long n) {
    const long up = n + grid.stride();
    const auto [lightest, heaviest] = std::minmax({m[n], m[n + 1], m[up], m[up + 1]});
    return lightest <= lightest_node * heaviest;
}

/// Pressure and compressibility of every cell, and how its materials share a change of volume.
///   density = "cells":      share_cell() of masses and energies in the cell
///   density = "particles":  p_c = sum_p R (V_p/K_p) p_p / sum_p R V_p/K_p,  K = rho c^2
/// in:     deposit_particles() has been called
/// out:    cells.p, compressibility, share, surface (1: p = 0 whatever happens)
/// exact:  with volumes a state of equal pressure stays one wherever the particles are
/// errors: NumericalError for a negative or not finite density or energy, with where and when
inline void find_pressure(const Problem& problem, double time, Mesh& mesh) {
    const Grid& grid = problem.grid;
    Cells& c = mesh.cells;
    const bool volumes = c.volume.size() > 0;
    const double V_c = grid.cell_area();
    const std::size_t kinds = mesh.materials;
    const Nodes& g = mesh.nodes;
    const long stride = grid.stride();
    std::atomic<long> bad{-1};
    for_each_cell(grid, [&](long, long, long n) {
        const std::array<long, 4> corners{n, n + 1, n + stride, n + stride + 1};
        double speed2 = 0;
        for (const long corner : corners)
            speed2 = std::max(speed2, g.vx[corner] * g.vx[corner] + g.vz[corner] * g.vz[corner]);
        double M[most_materials], U[most_materials];
        bool sound = true, gas = false;
        for (std::size_t k = 0; k < kinds; ++k) {
            const CellSum& sum = c.sum[static_cast<std::size_t>(n) * kinds + k];
            M[k] = sum.M;
            U[k] = std::max(sum.U, 0.0);
            gas = gas || (sum.M > 0 && problem.materials[k].p_infinity == 0);
            const bool dust = problem.materials[k].gamma == 1;  // whose energy does nothing
            sound = sound && sum.M >= 0 &&
                    (dust ? std::isfinite(sum.U) : sum.U >= -cold_enough * sum.M * speed2);
        }
        if (!sound) bad = n;
        const CellState cell =
            share_cell(problem.materials, M, U, V_c, &c.share[static_cast<std::size_t>(n) * kinds]);
        c.p[n] = cell.p;
        c.compressibility[n] = cell.compressibility;
        bool surface = cell.surface;
        if (volumes) {
            const bool filled = (gas || c.volume[n] >= least_filled * V_c) && c.give[n] > 0;
            c.p[n] = filled ? c.give_p[n] / c.give[n] : 0;
            c.compressibility[n] = c.volume[n] > 0 ? c.give[n] / c.volume[n] : 0;
            surface = !filled;
        }
        surface = surface || is_frayed(grid, g.m, n);
        c.surface[static_cast<std::size_t>(n)] = surface ? 1 : 0;
        if (surface) c.p[n] = 0;
    });
    if (bad < 0) return;
    const long i = bad % grid.stride() - 1, j = bad / grid.stride() - 1;
    throw common::NumericalError(
        "density or internal energy is negative in the cell at x = " +
        common::format(grid.x.at(static_cast<double>(i) + 0.5)) +
        ", z = " + common::format(grid.z.at(static_cast<double>(j) + 0.5)) +
        " at t = " + common::format(time) +
        ": reduce time.cfl, raise viscosity.linear, or take more particles per cell");
}

/// Sound speed of a cell, c^2 = 1/(rho x compressibility); of a mixture, Wood's.
inline double sound_speed(double rho, double compressibility) {
    return rho > 0 && compressibility > 0 ? 1 / std::sqrt(rho * compressibility) : 0;
}

/// The longest step that the flow allows.
///   dt = cfl min 1/(|v_x|/dx + |v_z|/dz + c sqrt(1/dx^2 + 1/dz^2)),
/// after the first step without the sound of the gas when the pressure is implicit; with viscosity
/// nu also dt <= 1/(4 nu (1/dx^2 + 1/dz^2)); at most 1.2 times the last step
/// in:     find_pressure() has been called; last, the last step, 0 before the first
/// out:    time.dt where the case gives it
inline double step_allowed(const Problem& problem, const Mesh& mesh, double last) {
    if (problem.limits.dt > 0) return problem.limits.dt;
    const Grid& grid = problem.grid;
    const Nodes& g = mesh.nodes;
    const Cells& c = mesh.cells;
    const bool plane = is_plane(problem.grid);
    const double per_dx = 1 / grid.x.spacing(), per_dz = plane ? 1 / grid.z.spacing() : 0;
    const double per_dx2 = per_dx * per_dx + per_dz * per_dz, V_c = grid.cell_area();
    std::vector<double> of_row(static_cast<std::size_t>(grid.z.cells), 0.0);
    common::for_each_row(
        grid.z.cells,
        [&](long j) {
            double most = 0;
            for (long i = 0; i < grid.x.cells; ++i) {
                const long n = grid.index(i, j);
                if (c.M[n] <= 0) continue;
                double vx = 0, vz = 0;
                for (const long corner : {n, n + 1, n + grid.stride(), n + grid.stride() + 1}) {
                    vx = std::max(vx, std::fabs(g.vx[corner]));
                    vz = std::max(vz, std::fabs(g.vz[corner]));
                }
                const double filled = c.volume.size() > 0 ? std::max(c.volume[n], 1e-300) : V_c;
                const double rho = c.M[n] / filled;
                // Through a cell that is partly void no sound runs.
                const bool silent = c.surface[static_cast<std::size_t>(n)] != 0;
                const double sound =
                    silent || (problem.scheme.implicit && last > 0)
                        ? 0
                        : sound_speed(rho, c.compressibility[n]) * std::sqrt(per_dx2);
                double rate = (vx * per_dx + vz * per_dz + sound) / problem.limits.cfl;
                if (problem.viscosity > 0)
                    rate = std::max(rate, 4 * problem.viscosity / rho * per_dx2);
                most = std::max(most, rate);
            }
            of_row[static_cast<std::size_t>(j)] = most;
        },
        grid.size());
    const double most = *std::max_element(of_row.begin(), of_row.end());

    // A fluid at rest is limited by how fast it can begin to move.
    const double pull = std::hypot(problem.body_force.gravity_x, problem.body_force.gravity_z);
    double dt = most > 0 ? 1 / most : problem.limits.end / 100;
    if (pull > 0)
        dt = std::min(
            dt, std::sqrt(problem.limits.cfl *
                          std::min(grid.x.spacing(), plane ? grid.z.spacing() : grid.x.spacing()) /
                          pull));
    if (problem.body_force.trap > 0)
        dt = std::min(dt, problem.limits.cfl / std::sqrt(problem.body_force.trap));
    return last > 0 ? std::min(dt, 1.2 * last) : dt;
}

}  // namespace flip
