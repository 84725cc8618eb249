// The step of flip: the slide, call by call, as two functions. Between them what the mesh sees at t^n
// is known.
#pragma once

#include "common/step_clock.hpp"
#include "flip/flip/deposit_particles.hpp"
#include "flip/flip/find_pressure.hpp"
#include "flip/flip/move_mesh.hpp"
#include "flip/flip/move_particles.hpp"
#include "flip/flip/rezone.hpp"

namespace flip {

/// What a run keeps between steps besides its state; all is made anew in every step.
struct FlipScratch {
    Mesh mesh;
    MassMatrix mass_matrix;
    SortScratch sort;

    explicit FlipScratch(const Problem& problem) : mesh(mesh_of(problem)) {}
};

/// The fluid on the mesh at t^n.
/// in:     particles in rows
/// out:    velocity and mass of nodes, pressure of cells
template <class Clock = common::NoClock>
void find_fluid(const Problem& problem, const State& state, Mesh& mesh, Clock&& clock = {}) {
    const Grid& grid = problem.grid;
    const std::vector<Material>& materials = problem.materials;
    // [fluid]
    deposit_particles(grid, materials, state.particles, mesh);  // particles -> mesh: v_g [FLIP-8]
    clock.lap("deposit");
    find_pressure(grid, materials, state.time, mesh, problem.scheme.confined);  // on the mesh: p_c
    clock.lap("mesh");
    // [/fluid]
}

/// From t^n to t^{n+1}, as long as the flow allows.
/// in:     scratch.mesh after find_fluid(); step, the number of steps before this one
/// in/out: state: particles, time and the length of the last step, budget, report
template <class Clock = common::NoClock>
void take_flip_step(const Problem& problem, long step, FlipScratch& scratch, State& state,
                    Clock&& clock = {}) {
    Mesh& mesh = scratch.mesh;
    Particles& particles = state.particles;
    // [step]
    double dt = step_allowed(problem, mesh, state.dt);
    state.report =
        move_mesh(problem, dt, particles, scratch.mass_matrix, mesh, state.budget);  // F_g, v_g^L
    clock.lap("mesh");
    const long left = move_particles(problem, dt, mesh, particles);  // v_p, x_p   [FLIP-6, FLIP-7]
    clock.lap("move");
    apply_particle_boundaries(problem, state.time, dt, particles, state.budget, left);
    if (rezone_is_due(problem.scheme, step)) rezone(problem, particles);
    keep_in_rows(problem.grid, scratch.sort, particles);
    clock.lap("sort");
    // [/step]
    state.time += dt;
    state.dt = dt;
}

}  // namespace flip
