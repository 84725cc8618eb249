// on the mesh: the pressure of the cells from what is in them, and how long the step may be.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>

#include "common/run/sentence.hpp"
#include "flip/flip/centrifugal_force.hpp"
#include "flip/flip/mesh.hpp"
#include "flip/state.hpp"

namespace flip {

/// With particles that carry volumes, a cell of liquid that is filled to less than this part is
/// surface: p = 0. A gas has room to grow there.
inline constexpr double least_filled = 0.7;

/// A cell has neither pressure nor viscosity if the barest of its nodes has less than this part of the
/// particles of another: an impulse on a node without mass would leave the budget. Their number
/// stands for the volume that they began with; mass must not decide, for air does not end where water
/// begins.
inline constexpr double barest_node = 0.01;

/// Internal energy below zero by less than this part of the kinetic energy is round-off.
inline constexpr double cold_enough = 1e-9;

/// The four nodes of a cell: lower left, lower right, upper left, upper right.
inline std::array<long, 4> corners_of(const Grid& grid, long n) {
    return {n, n + 1, n + grid.stride(), n + grid.stride() + 1};
}

/// Whether a cell has a node with next to no fluid around it.
inline bool has_bare_node(const Grid& grid, const Nodes& g, long n) {
    const long up = n + grid.stride();
    const auto around = [sum = g.sum.data()](long corner) { return sum[corner][3]; };
    const auto [least, most] = std::minmax({around(n), around(n + 1), around(up), around(up + 1)});
    return least <= barest_node * most;
}

/// Pressure and compressibility of every cell, and how its materials share a change of volume.
///   density of cells:       find_equilibrium() of masses and energies in the cell
///   volumes of particles:   p_c = sum_p R C_p p_p / sum_p R C_p,  C_p of weight_in_cell()
/// in:     deposit_particles() has been called
/// out:    cells.p, compressibility, share, surface (1: p = 0 whatever happens). With volumes also
///         excess = (p_kc - p_c)(1 - |p_c|/max_k |p_kc - p_c|), p_kc the mean pressure of material k;
///         0 in one fluid, and where no difference exceeds p_c, as gravity's within a cell; and room,
///         the part by which gas would have to grow to fill the cell, or least_filled of it beside
///         another material: in -1/2 to 1 where it is confined, else in 0 to 1; and crowding, what
///         cells of liquid hold beyond their volume, at most that volume, and those of one gas
///         that is not confined beyond it or, with the other sign, short of it
/// exact:  with volumes a state of equal pressure stays one wherever the particles are, as long as
///         they fill the cells, or the filling of the scheme is 0
/// errors: NumericalError for a negative or not finite density or energy, with where and when
inline void find_pressure(const Grid& grid, std::span<const Material> materials, double time,
                          Mesh& mesh, bool confined = false) {
    const Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    const bool volumes = c.volume.size() > 0;
    const long count = mesh.materials;
    const bool turns = !c.swirl.empty();
    const Values vx = g.vx, vz = g.vz, M_c = c.M;
    double *const p_c = c.p.data(), *const compressibility = c.compressibility.data();
    std::atomic<long> bad{-1};
    for_each_cell(grid, [=, &g, &c, &bad, sum_c = c.sum.data(), share = c.share.data(),
                         surface_c = c.surface.data(),
                         V_of_column = c.V_of_column.data()](long i, long, long n) {
        const double V_c = V_of_column[i];
        double speed2 = 0;
        for (const long corner : corners_of(grid, n))
            speed2 = std::max(speed2, vx[corner] * vx[corner] + vz[corner] * vz[corner]);
        if (turns && M_c[n] > 0) speed2 += c.swirl[n].force * grid.x.at(double(i) + 0.5) / M_c[n];
        double M[most_materials], U[most_materials];
        bool sound = true, gas = false;
        for (long k = 0; k < count; ++k) {
            const CellSum& sum = sum_c[n * count + k];
            M[k] = sum.M;
            U[k] = std::max(sum.U, 0.0);
            gas = gas || (sum.M > 0 && materials[k].p_infinity == 0);
            const bool dust = materials[k].gamma == 1;  // whose energy does nothing
            sound = sound && sum.M >= 0 &&
                    (dust ? std::isfinite(sum.U) : sum.U >= -cold_enough * sum.M * speed2);
        }
        if (!sound) bad = n;
        const CellState cell = find_equilibrium(materials, M, U, V_c, share + n * count);
        p_c[n] = cell.p;
        compressibility[n] = cell.compressibility;
        bool surface = cell.surface;
        if (volumes) {
            double C = 0, Cp = 0, CK = 0;
            for (long k = 0; k < count; ++k) {
                const SoftSum& soft = c.soft[n * count + k];
                C += soft.C, Cp += soft.Cp, CK += soft.CK;
            }
            c.C[n] = C;
            const bool filled = (gas || c.volume[n] >= least_filled * V_c) && C > 0;
            c.p[n] = filled ? Cp / C : 0;
            double* const excess = &c.excess[n * count];
            double largest = 0;
            for (long k = 0; k < count; ++k) {
                const SoftSum& soft = c.soft[n * count + k];
                excess[k] = filled && !c.one_fluid && soft.C > 0 ? soft.Cp / soft.C - c.p[n] : 0;
                largest = std::max(largest, std::fabs(excess[k]));
            }
            const double beyond = 1 - std::fabs(c.p[n]) / std::max(largest, 1e-300);
            for (long k = 0; k < count; ++k) excess[k] *= std::max(0.0, beyond);
            // sum of V/K, or in one fluid V^2/sum of V K
            const double yields = !c.one_fluid ? C : C > 0 ? C * C / CK : 0;
            c.compressibility[n] = c.volume[n] > 0 ? yields / c.volume[n] : 0;
            surface = !filled;
            const double full = confined ? 1 : least_filled, least = confined ? -0.5 : 0;
            c.room[n] = (count > 1 || confined) && gas && c.volume[n] > 0
                            ? std::clamp(full * V_c / c.volume[n] - 1, least, 1.0)
                            : 0;
        }
        surface = surface || has_bare_node(grid, g, n);
        if (volumes)
            c.crowding[n] = gas && (count > 1 || confined)
                                ? 0
                                : std::clamp(c.volume[n] - V_c, gas ? -V_c : 0.0, V_c);
        surface_c[n] = surface ? 1 : 0;
        if (surface) p_c[n] = 0;
    });
    if (bad < 0) return;
    const char* cure =
        time > 0 ? "reduce time.cfl, raise viscosity.linear, or take more particles per cell"
                 : "with hydrostatic = true the balance of the mesh takes more pressure from a "
                   "cell than it has: refine the mesh, or raise region.pressure";
    common::fail("density or internal energy is negative ", cell_and_time(grid, bad, time), ": ",
                 cure, (volumes ? "; where cold gas meets hot gas, flip.density = \"cells\"" : ""));
}

/// Sound speed of a cell, c^2 = 1/(rho x compressibility); of a mixture, Wood's.
inline double sound_speed(double rho, double compressibility) {
    return rho > 0 && compressibility > 0 ? 1 / std::sqrt(rho * compressibility) : 0;
}

/// Density of a cell in column i: of the volumes that its particles carry, where they do.
inline double density_of(const Cells& c, long i, long n) {
    const Values M = c.M, volume = c.volume;
    return M[n] / (c.volume.size() > 0 ? std::max(volume[n], 1e-300) : c.V_of_column[i]);
}

/// The longest step that the flow allows.
///   dt = cfl min 1/(|v_x|/dx + |v_z|/dz + c sqrt(1/dx^2 + 1/dz^2)),  fastest_consistent c for c with
///   the consistent mass and the density of cells; where the fluid turns, rate_of_swirl() is added;
/// after the first step without the sound of the gas when the pressure is implicit; with viscosity
/// nu also dt <= 1/(4 nu (1/dx^2 + 1/dz^2)), over most_viscous_consistent with that mass; at most sqrt(cfl dx/a), a of gravity and of the
/// centrifugal force, cfl/sqrt(trap), and 1.2 times the last step
/// in:     find_pressure() has been called; last, the last step, 0 before the first
/// out:    a fixed limits.dt where there is one
/// errors: NumericalError when the step gets so short that the run would never end
/// note:   no sound runs through a cell that is partly void
inline double step_allowed(const Problem& problem, const Mesh& mesh, double last) {
    const StepLimits& limits = problem.limits;
    if (limits.dt > 0) return limits.dt;
    const Grid& grid = problem.grid;
    const Nodes& g = mesh.nodes;
    const Cells& c = mesh.cells;
    const bool plane = is_plane(grid), no_sound = problem.scheme.implicit && last > 0;
    const double per_dx = 1 / grid.x.spacing(), per_dz = plane ? 1 / grid.z.spacing() : 0;
    const double per_dx2 = per_dx * per_dx + per_dz * per_dz,
                 faster = problem.scheme.consistent_mass && !problem.scheme.particle_volumes
                              ? fastest_consistent
                              : 1,
                 damped = problem.scheme.consistent_mass ? most_viscous_consistent : 1;
    const Values vx_g = g.vx, vz_g = g.vz, M = c.M, compressibility = c.compressibility;
    std::vector<double> of_row(grid.z.cells, 0.0);
    common::for_each_row(
        grid.z.cells,
        [&](long j) {
            double most = 0;
            for (long i = 0; i < grid.x.cells; ++i) {
                const long n = grid.index(i, j);
                if (M[n] <= 0) continue;
                double vx = 0, vz = 0;
                for (const long corner : corners_of(grid, n)) {
                    vx = std::max(vx, std::fabs(vx_g[corner]));
                    vz = std::max(vz, std::fabs(vz_g[corner]));
                }
                const double rho = density_of(c, i, n);
                const double sound =
                    c.surface[n] != 0 || no_sound
                        ? 0
                        : faster * sound_speed(rho, compressibility[n]) * std::sqrt(per_dx2);
                double turns = 0, outward = 0;
                if (!c.swirl.empty()) {
                    turns = rate_of_swirl(grid, c, i, n);
                    outward = std::sqrt(c.swirl[n].force / (M[n] * limits.cfl) * per_dx);
                }
                double rate = (vx * per_dx + vz * per_dz + sound + turns) / limits.cfl;
                if (problem.viscosity > 0)
                    rate = std::max(rate, 4 * damped * problem.viscosity / rho * per_dx2);
                most = std::max({most, rate, outward});
            }
            of_row[j] = most;
        },
        grid.size());
    const double most = std::ranges::max(of_row);

    const BodyForce& force = problem.body_force;
    const double gravity = std::hypot(force.gravity_x, force.gravity_z),
                 least_spacing =
                     plane ? std::min(grid.x.spacing(), grid.z.spacing()) : grid.x.spacing();
    double dt = most > 0 ? 1 / most : limits.end / 100;
    if (gravity > 0) dt = std::min(dt, std::sqrt(limits.cfl * least_spacing / gravity));
    if (force.trap > 0) dt = std::min(dt, limits.cfl / std::sqrt(force.trap));
    if (last > 0) dt = std::min(dt, 1.2 * last);
    if (!(dt > 1e-10 * limits.end))
        common::fail("the time step has fallen to ", dt,
                     ": some cell has become very fast, hot or light; use more particles per cell, "
                     "or ",
                     problem.viscosity > 0 ? "less flip.viscosity" : "more viscosity.linear");
    return dt;
}

}  // namespace flip
