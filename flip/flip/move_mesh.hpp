// on the mesh: the whole Lagrangian phase of flip, in which the mesh moves with the fluid.
#pragma once

#include "flip/flip/mass_matrix.hpp"
#include "flip/flip/move_particles.hpp"
#include "flip/flip/solve_pressure.hpp"
#include "flip/flip/work_on_cells.hpp"

namespace flip {

/// The mass matrix, where the case asks for more than its lumped sums; kept between steps.
using LagrangianScratch = MassMatrix;

namespace detail {

// M change = load on the nodes that are free; on those that the ends hold, change is given.
// in/out: change, 0 where it is not given; out: reaction, what holds those nodes beside their load
inline void solve_held(const Problem& problem, const MassMatrix& M, const Nodes& g, bool along_x,
                       const Field& load, Field& change, Field& reaction) {
    std::vector<char> held(static_cast<std::size_t>(problem.grid.size()), 0);
    for_each_node(problem.grid, [&](long i, long j, long n) {
        const Held h = held_at(problem, i, j);
        held[static_cast<std::size_t>(n)] = along_x ? h.x : h.z;
    });
    solve_mass(problem.grid, M, g.m, held, load, change);
    multiply(problem.grid, M, change, reaction);
    for_each_node(problem.grid, [&](long, long, long n) {
        reaction[n] = held[static_cast<std::size_t>(n)] != 0 ? reaction[n] - load[n] : 0;
    });
}

// The consistent mass matrix in place of the lumped one. First the walls stop what runs against
// them: M (v^0 - v) is their impulse, on the nodes that they hold alone, and
// (1/2) (v^0 - v) M (v^0 - v) becomes heat where they are.
// in: nodes.v, from M v = momentum; v0 on the nodes that are held; out: v0, reaction, stopped
inline void stop_consistently(const Problem& problem, const MassMatrix& M, Nodes& g) {
    const Field none = Field::Zero(problem.grid.size());
    g.stopped = none;
    for (const bool along_x : {true, false}) {
        const Field& v = along_x ? g.vx : g.vz;
        Field &start = along_x ? g.vx0 : g.vz0, &reaction = along_x ? g.reaction_x : g.reaction_z;
        Field change = start - v;
        for_each_node(problem.grid, [&](long, long, long n) {
            if (g.m[n] <= 0) change[n] = 0;
        });
        solve_held(problem, M, g, along_x, none, change, reaction);
        start = v + change;
        for_each_node(problem.grid, [&](long, long, long n) {
            if (g.m[n] > 0) g.stopped[n] += 0.5 * change[n] * reaction[n] / g.m[n];
        });
    }
}

// Then M (v^L - v^0) = dt (F + m g) on the nodes that are free. Nothing is lost to the particles, so
// the nodes owe them no heat.
// in: nodes.v0, forces; out: vL; in/out: reaction
inline void accelerate_consistently(const Problem& problem, double dt, const MassMatrix& M,
                                    Nodes& g) {
    for (const bool along_x : {true, false}) {
        const Field& force = along_x ? g.fx : g.fz;
        Field load = Field::Zero(problem.grid.size()), change = load, reaction;
        for_each_node(problem.grid, [&](long, long, long n) {
            load[n] = dt * (force[n] + g.m[n] * pull_on_node(problem, n)[along_x ? 0 : 1]);
        });
        solve_held(problem, M, g, along_x, load, change, reaction);
        (along_x ? g.vxL : g.vzL) = (along_x ? g.vx0 : g.vz0) + change;
        (along_x ? g.reaction_x : g.reaction_z) += reaction;
    }
}

// Velocities M^-1 of the momentum that the particles brought.
inline void solve_velocity(const Problem& problem, const MassMatrix& M, Mesh& mesh) {
    const std::vector<char> none(static_cast<std::size_t>(problem.grid.size()), 0);
    for (const int component : {1, 2}) {
        Field momentum = Field::Zero(problem.grid.size());
        for_each_node(problem.grid, [&](long, long, long n) {
            momentum[n] = mesh.nodes.sum[static_cast<std::size_t>(n)][component];
        });
        solve_mass(problem.grid, M, mesh.nodes.m, none, momentum,
                   component == 1 ? mesh.nodes.vx : mesh.nodes.vz);
    }
}

}  // namespace detail

/// One Lagrangian step of the mesh.
/// in:     deposit_particles() and find_pressure() have been called
/// out:    what move_particles() needs: nodes.kick, heat, carry; cells.de; books
inline StepReport move_mesh(const Problem& problem, double dt, const Particles& particles,
                            LagrangianScratch& M, Mesh& mesh, Books& books) {
    Nodes& g = mesh.nodes;
    StepReport report;
    const bool consistent = problem.scheme.consistent_mass,
               filtered = problem.scheme.transfer.filtered;
    if (consistent || filtered) assemble_mass_matrix(problem.grid, particles, M);
    if (consistent) detail::solve_velocity(problem, M, mesh);

    find_viscosity(problem, mesh);
    if (consistent) detail::stop_consistently(problem, M, g);
    find_known_forces(problem, mesh);
    if (problem.scheme.implicit) {
        report = solve_pressure(problem, dt, mesh);
    } else {
        for_each_cell(problem.grid,
                      [&](long, long, long n) { mesh.cells.p_step[n] = mesh.cells.p[n]; });
        accelerate_nodes(problem, dt, mesh);
    }
    if (consistent) detail::accelerate_consistently(problem, dt, M, g);
    work_on_cells(problem, dt, mesh, books);

    if (filtered) {
        Field vx, vz, last_x, last_z;
        filter_velocity(problem.grid, M, g.m, problem.scheme.transfer.xpic_order, g.vx, vx, last_x);
        filter_velocity(problem.grid, M, g.m, problem.scheme.transfer.xpic_order, g.vz, vz, last_z);
        prepare_transfer(problem, vx, vz, last_x, last_z, mesh);
    } else {
        prepare_transfer(problem, g.vx, g.vz, g.vxL, g.vzL, mesh);
    }
    return report;
}

}  // namespace flip
