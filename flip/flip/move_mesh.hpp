// on the mesh: the whole Lagrangian phase of flip, in which the mesh moves with the fluid; what the
// motion of the nodes does to the fluid in the cells, and what the nodes hand to the particles.
//
//     v  --walls-->  v^0  --forces-->  v^L          nodes; v from the particles
//                     \________________/
//                   v_bar = (v^0 + v^L)/2           at which forces work, as a square changes by
//                                                   twice its mean times its change
//     p_c acts on nodes with D^T and works on cells with D v_work, v_bar if explicit and the mass lumped;
//     q_c likewise with the strain rate: what nodes gain, cells lose
#pragma once

#include "flip/flip/mass_matrix.hpp"
#include "flip/flip/spread_crowded.hpp"

namespace flip {

/// Adds to the budget what comes from outside within the step: gravity, the pressure outside of open
/// boundaries, and what walls give to the nodes that they hold, R = m (v^L - v) - dt (F + m g).
///   momentum: the impulses;  energy: impulse . v_bar, of walls impulse . velocity of the wall
inline void add_external_work(const Problem& problem, double dt, const Mesh& mesh, Budget& budget) {
    const Grid& grid = problem.grid;
    const Nodes& g = mesh.nodes;
    const BodyForce& force = problem.body_force;
    const long nx = grid.x.cells - (grid.x.periodic ? 1 : 0),
               nz = grid.z.cells - (grid.z.periodic ? 1 : 0);
    const bool inside = force.gravity_x != 0 || force.gravity_z != 0 || force.trap != 0 ||
                        mesh.cells.outside.size() > 0;
    std::vector<Budget> of_row(nz + 1);
    const auto add_row = [&](long j) {
        Budget& sum = of_row[j];
        const auto add = [&](double impulse_x, double impulse_z, double vx, double vz) {
            sum.momentum_x += impulse_x;
            sum.momentum_z += impulse_z;
            sum.energy += impulse_x * vx + impulse_z * vz;
        };
        for (long i = 0; i <= nx; ++i) {
            if (!inside && i > 0 && j > 0 && i < grid.x.cells && j < grid.z.cells) continue;
            const long n = grid.index(i, j);
            const Eigen::Vector2d weight = dt * g.m[n] * node_acceleration(grid, force, i, j);
            add(weight[0], weight[1], g.vx_bar[n], g.vz_bar[n]);
            if (g.m[n] <= 0) continue;
            const Held held = held_at(grid, problem.boundaries, i, j);
            const bool lumped = g.reaction_x.size() == 0;
            if (held.x)
                add(lumped ? g.m[n] * (g.vxL[n] - g.vx[n]) - dt * g.fx[n] - weight[0]
                           : g.reaction_x[n],
                    0, held.vx, 0);
            if (held.z)
                add(0,
                    lumped ? g.m[n] * (g.vzL[n] - g.vz[n]) - dt * g.fz[n] - weight[1]
                           : g.reaction_z[n],
                    0, held.vz);
            const Eigen::Vector2d F = outside_force(grid, problem.boundaries, mesh.cells, i, j, n);
            add(dt * F[0], dt * F[1], g.vx_bar[n], g.vz_bar[n]);
        }
    };
    common::for_each_row(nz + 1, add_row, grid.size());
    // The budget is rounded once per step; row by row, its errors of rounding added up.
    Budget of_step;
    for (const Budget& sum : of_row) {
        of_step.momentum_x += sum.momentum_x;
        of_step.momentum_z += sum.momentum_z;
        of_step.energy += sum.energy;
    }
    budget.momentum_x += of_step.momentum_x;
    budget.momentum_z += of_step.momentum_z;
    budget.energy += of_step.energy;
}

/// The work of pressure and viscosity on the cells, and what the particles need of the nodes.
///   dE_c = -dt (p V div v_work + V q : grad v_bar) + viscous heating
/// For the particles of material k pressure changes e in proportion to e, as it does at one pressure
/// when nothing else happens, so that each keeps its entropy; viscosity by mass:
///   de_ck[1] = -dt share_ck p V div v_work / U_ck,   de_ck[0] = share_ck (rest of dE_c) / M_ck
///   dissipated_g = |v^0 - v|^2/2                      of what walls stop, or with the consistent
///                                                     mass (v^0 - v) M (v^0 - v)/(2 m_g)
///          + (level - 1/2) dt F_g . (v^L - v^0)/m_g   of pressure, v_work = v^0 + level (v^L - v^0)
///          + |v^L - v|^2/2                            that the lumped mass owes the particles
/// level is theta of an implicit pressure, 1/2 of an explicit one, and 1 with the consistent mass, where
/// work at v_bar would make the shortest sound grow: no loss of the transfer damps it there
/// in:     v, v^0, v^L; p_step, q; forces
/// out:    cells.de, and with volumes strain, work, q_work; nodes.increment, dissipated;
///         budget
/// exact:  sum_c dE_c + change of (1/2) sum_g m_g v_g^2 + what walls and theta dissipate = what the
///         budget has got
inline void work_on_cells(const Problem& problem, double dt, Mesh& mesh, Budget& budget) {
    const Grid& grid = problem.grid;
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    const bool implicit = problem.scheme.implicit,
               late = implicit || problem.scheme.consistent_mass;
    const double level = implicit ? problem.scheme.theta : late ? 1 : 0.5;
    const Values move_x = implicit ? g.vx_work : g.vxL, move_z = implicit ? g.vz_work : g.vzL;

    const bool dissipates = problem.scheme.transfer.dissipates,
               walls = g.wall_dissipation.size() > 0;
    const Values m = g.m, vx = g.vx, vz = g.vz, vx0 = g.vx0, vz0 = g.vz0, vxL = g.vxL, vzL = g.vzL,
                 p_step = c.p_step, wall_dissipation = g.wall_dissipation;
    double *const vx_bar = g.vx_bar.data(), *const vz_bar = g.vz_bar.data(),
                  *const vx_work = g.vx_work.data(), *const vz_work = g.vz_work.data(),
                  *const dissipated = g.dissipated.data();
    Four* const increment = g.increment.data();
    for_each_node(grid, [=](long, long, long n) {
        const double dvx = vxL[n] - vx[n], dvz = vzL[n] - vz[n];
        const double stop_x = vx0[n] - vx[n], stop_z = vz0[n] - vz[n];
        vx_bar[n] = 0.5 * (vx0[n] + vxL[n]);
        vz_bar[n] = 0.5 * (vz0[n] + vzL[n]);
        vx_work[n] = (1 - level) * vx0[n] + level * vxL[n];
        vz_work[n] = (1 - level) * vz0[n] + level * vzL[n];
        double loss = walls ? wall_dissipation[n] : 0.5 * (stop_x * stop_x + stop_z * stop_z);
        if (dissipates) loss += 0.5 * (dvx * dvx + dvz * dvz);
        if (late && m[n] > 0) {
            const Eigen::Vector2d F = pressure_force(grid, p_step, n);
            loss +=
                (level - 0.5) * dt / m[n] * (F[0] * (vxL[n] - vx0[n]) + F[1] * (vzL[n] - vz0[n]));
        }
        dissipated[n] = loss;
        const bool filled = m[n] > 0;
        increment[n][0] = filled ? dvx : 0;
        increment[n][1] = filled ? dvz : 0;
        increment[n][2] = filled ? move_x[n] : 0;
        increment[n][3] = filled ? move_z[n] : 0;
    });
    add_external_work(problem, dt, mesh, budget);

    const bool volumes = c.volume.size() > 0;
    const long count = mesh.materials;
    const double viscosity = problem.viscosity;
    const Values M_c = c.M;
    for_each_cell(grid, [=, &g, &c, q = c.q.data(), sum = c.sum.data(), share_c = c.share.data(),
                         de = c.de.data()](long, long, long n) {
        const double work = dilation(grid, vx_work, vz_work, n),
                     q_power = power(grid, q[n], vx_bar, vz_bar, n);
        double adiabatic = 0;
        double dE = viscosity > 0 && M_c[n] > 0
                        ? dt * viscous_heating(grid, viscosity, g, g.vx_bar, g.vz_bar, n)
                        : 0;
        if (volumes) {
            // Particles know their own pressure; the viscous heat goes by mass.
            const bool yields = c.surface[n] == 0 && c.C[n] > 0;
            const double per_C = yields ? dt / c.C[n] : 0;
            c.strain[n] = per_C * dilation(grid, move_x, move_z, n);
            c.work[n] = per_C * work;
            c.q_work[n] = per_C * (q_power + (c.p_step[n] - c.p[n]) * work);
        } else {
            adiabatic = -dt * p_step[n] * work;
            dE -= dt * q_power;
        }
        for (long ck = n * count; ck < (n + 1) * count; ++ck) {
            const double M = sum[ck].M, U = sum[ck].U;
            const double share = volumes ? (M_c[n] > 0 ? M / M_c[n] : 0) : share_c[ck];
            de[ck] = Two(M > 0 ? share * (U > 0 ? dE : dE + adiabatic) / M : 0,
                         U > 0 ? share * adiabatic / U : 0);
        }
    });
    fill_cells(grid, c.de[0].data(), 2 * count);
    if (volumes) {
        for (Field* f : {&c.strain, &c.work, &c.q_work, &c.p, &c.room}) fill_cells(grid, f->data());
        fill_cells(grid, c.excess.data(), count);
    }
}

namespace detail {

// What particles take from the mesh in place of their own velocity: v and v^L; or for xpic the
// filtered velocity with its last term.
// out: nodes.filtered
inline void filter_nodes(const Problem& problem, const MassMatrix& M, Nodes& g) {
    const Transfer& transfer = problem.scheme.transfer;
    if (transfer.flip) return;
    Field vx = g.vx, vz = g.vz, other_x = g.vxL, other_z = g.vzL;
    if (transfer.filtered) {
        filter_velocity(problem.grid, M, g.m, transfer.xpic_order, g.vx, vx, other_x);
        filter_velocity(problem.grid, M, g.m, transfer.xpic_order, g.vz, vz, other_z);
    }
    for_each_node(problem.grid, [&](long, long, long n) {
        g.filtered[n] = Four(vx[n], vz[n], other_x[n], other_z[n]);
    });
}

// How many cells the fastest node crosses per time, and on conservative paths the fastest particle.
inline double most_cells_crossed(const Grid& grid, const Nodes& g, bool conservative) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = is_plane(grid) ? 1 / grid.z.spacing() : 0;
    double most = 0;
    for_own_nodes(grid, [&](long, long, long n) {
        most = std::max({most, std::fabs(g.vxL[n]) * per_dx, std::fabs(g.vzL[n]) * per_dz});
    });
    for (long j = 0; conservative && j < grid.z.cells; ++j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const auto at = corners_of(grid, grid.index(i, j));
            const auto crossed = [&](const Field& v, const Field& w, double per_v, double per_w) {
                double fastest = 0;
                for (const long corner : at) fastest = std::max(fastest, std::fabs(v[corner]));
                const double turned = std::fabs(w[at[0]] - w[at[1]] - w[at[2]] + w[at[3]]);
                return per_v * fastest * (grid.axisymmetric ? 1.25 : 1) +
                       (grid.axisymmetric ? 0.75 : 0.5) * per_w * turned;
            };
            most = std::max({most, crossed(g.vxL, g.vzL, per_dx, per_dz),
                             crossed(g.vzL, g.vxL, per_dz, per_dx)});
        }
    }
    return most;
}

}  // namespace detail

/// One Lagrangian step of the mesh.
/// in:     deposit_particles() and find_pressure() have been called
/// in/out: dt, halved as long as the new velocity takes some particle farther than a cell: the
///         implicit pressure may be quick to move air beside water; M, room for the mass matrix,
///         where the scheme asks for one; budget
/// out:    what move_particles() needs: nodes.increment, dissipated, filtered; cells.de
/// exact:  no particle passes a wall, unless the case gives a dt
inline StepReport move_mesh(const Problem& problem, double& dt, const Particles& particles,
                            MassMatrix& M, Mesh& mesh, Budget& budget) {
    const Grid& grid = problem.grid;
    const Boundaries& boundaries = problem.boundaries;
    Nodes& g = mesh.nodes;
    StepReport report;
    const bool consistent = problem.scheme.consistent_mass;
    if (consistent || problem.scheme.transfer.filtered) assemble_mass_matrix(grid, particles, M);
    if (consistent) solve_velocity(grid, M, g);

    find_viscosity(grid, boundaries, problem.q, mesh);
    limit_viscosity(grid, dt, mesh);
    fill_voids(grid, boundaries, mesh.cells);
    if (consistent) stop_at_walls(problem, M, g);
    for (;; dt *= 0.5) {
        find_known_forces(grid, boundaries, problem.viscosity, mesh);
        if (problem.swirl) add_centrifugal_force(problem, dt, particles, mesh);
        if (problem.scheme.implicit) {
            report = solve_pressure(problem, dt, mesh);
        } else {
            for_each_cell(grid, [p = Values(mesh.cells.p), p_step = mesh.cells.p_step.data()](
                                    long, long, long n) { p_step[n] = p[n]; });
            accelerate_nodes(problem, dt, mesh);
        }
        if (consistent) accelerate_consistently(problem, dt, M, g);
        if (problem.limits.dt > 0 ||
            !(dt * detail::most_cells_crossed(grid, g, problem.scheme.conservative_paths) > 1))
            break;
    }
    work_on_cells(problem, dt, mesh, budget);
    if (problem.swirl) work_on_swirl(grid, dt, particles, mesh);
    if (problem.scheme.implicit) spread_crowded(problem, dt, mesh);
    detail::filter_nodes(problem, M, g);
    return report;
}

}  // namespace flip
