// The step of clouds-in-cells: the slide, call by call, as two functions. Between them the field of
// t^n is known.
#pragma once

#include <vector>

#include "cic/deposit_charge.hpp"
#include "cic/gather_field.hpp"
#include "cic/move_particles.hpp"
#include "cic/solve_field.hpp"
#include "common/step_clock.hpp"

namespace cic {

/// The field of t^n.
/// in:     particles at x^n; background, the charge density of fixed species; field.walls
/// out:    rho_g, field
template <class Clock = common::NoClock>
void find_field(const std::vector<Particles>& particles, const Grid& grid, const Scheme& scheme,
                double background, DepositScratch& scratch, FieldSolver& solver, Field& rho_g,
                FieldState& field, Clock&& clock = {}) {
    // [field]
    deposit_charge(particles, grid, scheme, background, scratch, rho_g);  // [CIC-1]
    clock.lap("deposit");
    solve_field(solver, rho_g, field);  // [CIC-2]
    clock.lap("field");
    // [/field]
}

/// Particles from t^n to t^{n+1}, velocities from half a step before t^n to half a step after it.
/// in:     E_g of t^n; B, uniform
/// in/out: particles
template <class Clock = common::NoClock>
void push_particles(const MeshField& E_g, const Grid& grid, const Scheme& scheme,
                    const MagneticField& B, double dt, std::vector<Particles>& particles,
                    Clock&& clock = {}) {
    // [push]
    for_each_batch(particles, [&](ParticleBatch& batch) {
        FieldAtParticles E_p;
        gather_field(E_g, grid, scheme, batch, E_p);  // [CIC-3]
        accelerate(E_p, B, dt, batch);                // [CIC-4]
        move_particles(grid, dt, batch);              // [CIC-5]
    });
    clock.lap("push");
    // [/push]
}

}  // namespace cic
