// The step of mpm_implicit: the slide, call by call. take_step() has three parts.
#pragma once

#include <vector>

#include "common/step_clock.hpp"
#include "mpm_explicit/strain.hpp"
#include "mpm_explicit/surface.hpp"
#include "mpm_explicit/transfer.hpp"
#include "mpm_implicit/move_particles.hpp"
#include "mpm_implicit/solve_nodes.hpp"
#include "mpm_implicit/solve_with_newton.hpp"
#include "mpm_implicit/state.hpp"
#include "mpm_implicit/update_stress.hpp"

namespace mpm_implicit {

/// What a step takes from the case, and what it works with. reach: 1 for linear shapes, else 2.
template <int reach>
struct StepScratch {
    std::vector<AnyLaw> laws;
    ThetaScheme scheme;
    const Contact& contact;
    double flip = 1;      // the part of FLIP in the velocity of particles
    bool frozen = false;  // particles keep their places
    NodeSolver<reach> solver;
    NewtonSolver<reach> newton;
};

/// The matrices of the step, and the velocities of the nodes at t^n.
/// in:     nodes, sorted for where the particles are; rigid motions of this step
/// out:    scratch.solver; nodes.motion, v_0; sums.solver
template <class Shape, int reach, class Clock = common::NoClock>
void find_matrices(const Shape& shape, double dt, StepScratch<reach>& scratch, GrainNodes& nodes,
                   State& state, StepSums& sums, Clock&& clock = {}) {
    // [matrices]
    particles_to_grid(shape, state.assembly.particles, nodes);  // particles -> grid
    surface_to_grid(shape, state.assembly.particles, nodes);
    start_turns(shape, scratch.contact, scratch.frozen, dt, nodes, state.assembly);
    clock.lap("put");
    scratch.solver.assemble(shape, scratch.laws, scratch.scheme, dt, state,
                            nodes);  // M, K of  [MPM-5 ... 8]
    clock.lap("matrix");
    scratch.solver.find_old_velocities(scratch.scheme, scratch.contact, state, nodes,
                                       sums.solver);  // v_i^0
    clock.lap("v_0");
    // [/matrices]
}

/// The velocities of the nodes at t^n + theta dt, with the contacts of the same level.
/// out:    nodes.motion, v^theta in the place of v_1; sums.contact, sums.solver
/// errors: NumericalError when it is not found
template <class Shape, int reach, class Clock = common::NoClock>
void find_theta_velocities(const Shape& shape, const BodyForce& body, double dt,
                           StepScratch<reach>& scratch, GrainNodes& nodes, State& state,
                           StepSums& sums, Clock&& clock = {}) {
    // [velocities]
    sums.contact =
        scratch.scheme.newton()  // v_i^theta, f_i^theta                                     [MPM-8]
            ? scratch.newton.solve(shape, scratch.laws, scratch.scheme, scratch.contact, body, dt,
                                   state, scratch.solver, nodes, sums.solver)
            : scratch.solver.solve(shape, scratch.scheme, scratch.contact, body, dt, state, nodes,
                                   sums.solver);
    clock.lap("v_theta");
    // [/velocities]
}

/// Stresses and particles at t^{n+1}.
/// out:    sums.tiles, sums.nodes
template <class Shape, int reach, class Clock = common::NoClock>
void move_to_new_level(const Shape& shape, const BodyForce& body, double dt,
                       const StepScratch<reach>& scratch, GrainNodes& nodes, State& state,
                       StepSums& sums, Clock&& clock = {}) {
    Particles& particles = state.assembly.particles;
    const std::vector<Grain>& grains = state.assembly.grains;
    // [particles]
    for_each_batch(grains, nodes, sums.tiles, [&](ParticleBatch& batch) {
        velocity_gradient(shape, particles, nodes, NewVelocity{}, dt, batch);  // [MPM-5]
        turn_gradient(particles, batch);
        update_stress(scratch.laws, scratch.scheme, dt, batch, grains, particles,
                      sums.tiles);  // [MPM-6, 7]
        if (!scratch.frozen) turn_particles(batch, particles);
    });
    sums.nodes = work_on_nodes(body, scratch.scheme.theta, dt, nodes);
    if (!scratch.frozen) carry_surface(shape, grains, nodes, dt, particles);
    move_particles(shape, grains, state.assembly.rigid, nodes, scratch.scheme.theta, scratch.flip,
                   body.damping, scratch.frozen, dt, particles, sums.tiles);  // grid -> particles
    // [/particles]
    extrapolate_controlled(scratch.solver.force_controls, scratch.scheme.theta,
                           state.assembly.rigid);
    state.layout.moved += scratch.frozen ? 0 : dt * sums.nodes.largest_speed;
    clock.lap("particles");
}

/// From t^n to t^{n+1}.
/// in/out: nodes, sorted for where the particles are; state but the budget
/// out:    sums, which the budget takes
/// errors: NumericalError as the solvers
template <class Shape, int reach, class Clock = common::NoClock>
void take_step(const Shape& shape, const BodyForce& body, double dt, StepScratch<reach>& scratch,
               GrainNodes& nodes, State& state, StepSums& sums, Clock&& clock = {}) {
    find_matrices(shape, dt, scratch, nodes, state, sums, clock);
    find_theta_velocities(shape, body, dt, scratch, nodes, state, sums, clock);
    move_to_new_level(shape, body, dt, scratch, nodes, state, sums, clock);
}

}  // namespace mpm_implicit
