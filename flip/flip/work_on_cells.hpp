// on the mesh: what the motion of the nodes does to the fluid in the cells, and what the nodes hand
// to the particles.
#pragma once

#include "flip/flip/accelerate_nodes.hpp"

namespace flip {

/// Enters what comes from outside within the step: gravity, the pressure outside of open ends, and
/// what walls give to the nodes that they hold, R = m (v^L - v) - dt (F + m g).
///   momentum: the impulses;  energy: impulse . vbar, of walls impulse . velocity of the wall
inline void enter_outside(const Problem& problem, double dt, const Nodes& g, Books& books) {
    const Grid& grid = problem.grid;
    const long nx = grid.x.cells - (grid.x.periodic ? 1 : 0),
               nz = grid.z.cells - (grid.z.periodic ? 1 : 0);
    const bool pulled = problem.body_force.gravity_x != 0 || problem.body_force.gravity_z != 0 ||
                        problem.body_force.trap != 0;
    std::vector<Books> of_row(static_cast<std::size_t>(nz) + 1);
    const auto enter_row = [&](long j) {
        Books& sum = of_row[static_cast<std::size_t>(j)];
        const auto enter = [&](double impulse_x, double impulse_z, double vx, double vz) {
            sum.momentum_x += impulse_x;
            sum.momentum_z += impulse_z;
            sum.energy += impulse_x * vx + impulse_z * vz;
        };
        for (long i = 0; i <= nx; ++i) {
            const bool edge = i == 0 || j == 0 || i == grid.x.cells || j == grid.z.cells;
            if (!pulled && !edge) continue;
            const long n = grid.index(i, j);
            const Eigen::Vector2d pull = dt * g.m[n] * pull_on_node(problem, n);
            enter(pull[0], pull[1], g.vx_bar[n], g.vz_bar[n]);
            if (!edge || g.m[n] <= 0) continue;
            const Held held = held_at(problem, i, j);
            const bool lumped = g.reaction_x.size() == 0;
            if (held.x)
                enter(lumped ? g.m[n] * (g.vxL[n] - g.vx[n]) - dt * g.fx[n] - pull[0]
                             : g.reaction_x[n],
                      0, held.vx, 0);
            if (held.z)
                enter(0,
                      lumped ? g.m[n] * (g.vzL[n] - g.vz[n]) - dt * g.fz[n] - pull[1]
                             : g.reaction_z[n],
                      0, held.vz);
            const Eigen::Vector2d press = dt * outside_force(problem, i, j);
            enter(press[0], press[1], g.vx_bar[n], g.vz_bar[n]);
        }
    };
    common::for_each_row(nz + 1, enter_row, grid.size());
    for (const Books& sum : of_row) {
        books.momentum_x += sum.momentum_x;
        books.momentum_z += sum.momentum_z;
        books.energy += sum.energy;
    }
}

/// The work of pressure and viscosity on the cells, and what the particles need of the nodes.
///   dE_c = -dt (p V div v_work + q V div v_bar) + viscous heat,   v_bar = (v^0 + v^L)/2
/// For the particles of material k pressure changes e in proportion to e, as it does at one pressure
/// when nothing else happens, so that each keeps its entropy; viscosity by mass:
///   relative_de_ck = -dt share_ck p V div v_work / U_ck,   de_ck = share_ck (rest of dE_c) / M_ck
///   heat_g = |v^0 - v|^2/2                            of what walls stop, or with the consistent
///                                                     mass (v^0 - v) M (v^0 - v)/(2 m_g)
///          + (theta - 1/2) dt F_g . (v^L - v^0)/m_g   of an implicit pressure, v_work = v^theta
///          + |v^L - v|^2/2                            that the lumped mass owes the particles
/// in:     v, v^0, v^L; p_step, q; forces
/// out:    cells.de, relative_de, and with volumes strain, work, q_work; nodes.kick, heat; books
/// exact:  sum_c dE_c + change of (1/2) sum_g m_g v_g^2 + heat of walls and of theta = what the books
///         have entered
inline void work_on_cells(const Problem& problem, double dt, Mesh& mesh, Books& books) {
    const Grid& grid = problem.grid;
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    const std::size_t kinds = mesh.materials;
    const double level = problem.scheme.implicit ? problem.scheme.theta : 0.5;
    const Field& move_x = problem.scheme.implicit ? g.vx_work : g.vxL;
    const Field& move_z = problem.scheme.implicit ? g.vz_work : g.vzL;

    for_each_node(grid, [&](long, long, long n) {
        const double dvx = g.vxL[n] - g.vx[n], dvz = g.vzL[n] - g.vz[n];
        const double stop_x = g.vx0[n] - g.vx[n], stop_z = g.vz0[n] - g.vz[n];
        g.vx_bar[n] = 0.5 * (g.vx0[n] + g.vxL[n]);
        g.vz_bar[n] = 0.5 * (g.vz0[n] + g.vzL[n]);
        g.vx_work[n] = (1 - level) * g.vx0[n] + level * g.vxL[n];
        g.vz_work[n] = (1 - level) * g.vz0[n] + level * g.vzL[n];
        g.heat[n] = g.stopped.size() > 0 ? g.stopped[n] : 0.5 * (stop_x * stop_x + stop_z * stop_z);
        if (problem.scheme.transfer.dissipates) g.heat[n] += 0.5 * (dvx * dvx + dvz * dvz);
        if (problem.scheme.implicit && g.m[n] > 0) {
            const Eigen::Vector2d F = pressure_force(grid, c.p_step, n);
            g.heat[n] += (problem.scheme.theta - 0.5) * dt / g.m[n] *
                         (F[0] * (g.vxL[n] - g.vx0[n]) + F[1] * (g.vzL[n] - g.vz0[n]));
        }
        g.kick[static_cast<std::size_t>(n)] =
            g.m[n] > 0 ? Four(dvx, dvz, move_x[n], move_z[n]) : Four::Zero();
    });
    enter_outside(problem, dt, g, books);

    const bool volumes = c.volume.size() > 0;
    for_each_cell(grid, [&](long, long, long n) {
        const double work = dilation(grid, g.vx_work, g.vz_work, n),
                     bar = dilation(grid, g.vx_bar, g.vz_bar, n);
        double adiabatic = 0;
        double dE = problem.viscosity > 0 && c.M[n] > 0
                        ? dt * viscous_heat(problem, g, g.vx_bar, g.vz_bar, n)
                        : 0;
        if (volumes) {
            // Particles know their own pressure; the viscous heat goes by mass.
            const bool gives = c.surface[static_cast<std::size_t>(n)] == 0 && c.give[n] > 0;
            const double per_give = gives ? dt / c.give[n] : 0;
            c.strain[n] = per_give * dilation(grid, move_x, move_z, n);
            c.work[n] = per_give * work;
            c.q_work[n] = per_give * (c.q[n] * bar + (c.p_step[n] - c.p[n]) * work);
        } else {
            adiabatic = -dt * c.p_step[n] * work;
            dE -= dt * c.q[n] * bar;
        }
        for (std::size_t k = 0; k < kinds; ++k) {
            const std::size_t ck = static_cast<std::size_t>(n) * kinds + k;
            const double share = volumes ? (c.M[n] > 0 ? c.sum[ck].M / c.M[n] : 0) : c.share[ck];
            const bool warm = c.sum[ck].U > 0;
            c.de[ck] = c.sum[ck].M > 0 ? share * (warm ? dE : dE + adiabatic) / c.sum[ck].M : 0;
            c.relative_de[ck] = warm ? share * adiabatic / c.sum[ck].U : 0;
        }
    });
    fill_cells(grid, c.de.data(), static_cast<long>(kinds));
    fill_cells(grid, c.relative_de.data(), static_cast<long>(kinds));
    if (volumes)
        for (Field* f : {&c.strain, &c.work, &c.q_work}) fill_cells(grid, f->data());
}

}  // namespace flip
