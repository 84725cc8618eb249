// The step of the implicit moment method: the slide, call by call. The row of t^n belongs between the
// two functions: there the moments of t^n are known.
#pragma once

#include <algorithm>
#include <vector>

#include "common/run/sentence.hpp"
#include "common/step_clock.hpp"
#include "implicit_moment/advance_field.hpp"
#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/field/interleaved_field.hpp"
#include "implicit_moment/kick_and_drift.hpp"
#include "implicit_moment/move_particles.hpp"
#include "implicit_moment/solve_enslaved_field.hpp"
#include "implicit_moment/solve_field.hpp"
#include "implicit_moment/sort_particles.hpp"

namespace implicit_moment {

/// What a run keeps between steps besides its state; all is made anew in every step.
struct StepScratch {
    std::vector<Moments> moments;  // of each species
    FieldSolver solver;
    VectorField B_push;      // the B in which currents and particles are rotated
    InterleavedField field;  // smoothed E^{n+theta} and B_push, where particles feel them
    InterleavedField guess;  // the same with an earlier E, about which relativistic vbar are linear
    InterleaveScratch interleave;
    SortScratch sort;
    EnslavedParticles enslaved;

    StepScratch(const Grid& grid, const FieldSettings& settings, std::size_t species)
        : moments(species, Moments(grid)),
          solver(grid, settings),
          B_push(grid),
          interleave(grid),
          enslaved(grid) {}
};

/// The moments of t^n, and the B in which particles are rotated.
/// in:     particles, sorted by node; E^n and B^n
/// out:    scratch.moments; scratch.B_push
template <class Clock = common::NoClock>
void find_moments(const Grid& grid, double dt, const std::vector<Particles>& particles,
                  const FieldState& field, StepScratch& scratch, Clock&& clock = {}) {
    // [moments]
    find_push_B(scratch.solver, dt, field, scratch.B_push);
    deposit_moments(particles, grid, scratch.B_push, dt, scratch.solver.settings.rotates_on_mesh(),
                    scratch.moments);  // particles -> grid   [IMM-9]
    clock.lap("moments");
    // [/moments]
}

inline bool any_relativistic(const std::vector<Particles>& species) {
    return std::ranges::any_of(species, &Particles::relativistic);
}

/// The field about which vbar is linear, where a species is relativistic and asks for it.
/// in:     E_theta of the step before, or of the iteration before; B in which particles are rotated
/// out:    scratch.guess, not touched without such a species
inline void interleave_guess(const Grid& grid, const std::vector<Particles>& species,
                             const VectorField& E_theta, const VectorField& B,
                             StepScratch& scratch) {
    if (any_relativistic(species))
        interleave_field(grid, scratch.solver.settings.smoothing, E_theta, B, scratch.interleave,
                         scratch.guess);
}

/// A copy of all species if one is relativistic, to go back to where a kick takes too much energy.
inline std::vector<Particles> copy_if_relativistic(const std::vector<Particles>& species) {
    return any_relativistic(species) ? species : std::vector<Particles>{};
}

/// Takes back a kick, whose field is the next guess. errors: NumericalError after twenty iterations
inline void take_back_kick(const std::vector<Particles>& before, int iteration,
                           std::vector<Particles>& species) {
    if (iteration == 20)
        common::fail(
            "the field takes more energy from relativistic particles than they have; reduce "
            "time.dt");
    species = before;
}

/// From t^n to t^{n+1} with the particles' own current. The energy of particles and field changes by what
/// field.by_theta says and by nothing else, for any step.
/// in/out: particles, sorted by node; field
/// out:    iterations and residual of the field solve
/// errors: NumericalError when the field does not converge or has blown up
template <class Clock = common::NoClock>
FieldReport take_mass_matrix_step(const Grid& grid, double dt, StepScratch& scratch,
                                  std::vector<Particles>& particles, FieldState& field,
                                  Clock&& clock = {}) {
    // [mass_matrix_step]
    drift(grid, 0.5 * dt, particles);  // to x*
    clock.lap("mover");
    sort_particles(grid, scratch.sort, particles);
    clock.lap("sort");
    const std::vector<Particles> before = copy_if_relativistic(particles);
    FieldReport solved;
    for (int iteration = 0;; ++iteration) {  // once, unless relativistic particles nearly stop
        interleave_guess(grid, particles, field.E_theta, scratch.B_push, scratch);
        deposit_mass_matrix(particles, grid, scratch.B_push, scratch.guess, dt,
                            scratch.solver.mass);  // particles -> grid
        clock.lap("mass");
        solved = solve_field(scratch.solver, dt, field,
                             scratch.solver.settings.solved_to());  // [IMM-10]
        interleave_field(grid, scratch.solver.settings.smoothing, field.E_theta, scratch.B_push,
                         scratch.interleave, scratch.field);
        clock.lap("field");
        if (kick_particles(scratch.field, scratch.guess, grid, dt, particles))
            break;  // grid -> particles
        take_back_kick(before, iteration, particles);
    }
    drift(grid, 0.5 * dt, particles);  // from x*
    clock.lap("mover");
    advance_field(scratch.solver, dt, field);  // [IMM-10]
    clock.lap("field");
    sort_particles(grid, scratch.sort, particles);  // for the next step
    clock.lap("sort");
    // [/mass_matrix_step]
    return solved;
}

/// From t^n to t^{n+1} with particles that follow the field within the step: as above, and Gauss's law
/// holds as well.
template <class Clock = common::NoClock>
FieldReport take_enslaved_step(const Grid& grid, double dt, const MoverSettings& mover,
                               StepScratch& scratch, std::vector<Particles>& particles,
                               FieldState& field, Clock&& clock = {}) {
    // [enslaved_step]
    drift(grid, 0.5 * dt, particles);  // to x* and back: there the response is found
    sort_particles(grid, scratch.sort, particles);
    interleave_guess(grid, particles, field.E_theta, field.B, scratch);
    deposit_mass_matrix(particles, grid, field.B, scratch.guess, dt, scratch.solver.mass);
    drift(grid, -0.5 * dt, particles);
    clock.lap("mass");
    const FieldReport solved =
        solve_enslaved_field(scratch.solver, dt, mover, particles, field, scratch.B_push,
                             scratch.interleave, scratch.field, scratch.enslaved);
    clock.lap("field");
    move_enslaved(scratch.field, grid, dt, scratch.enslaved, particles);
    advance_field(scratch.solver, dt, scratch.enslaved.J, scratch.B_push, field);  // [IMM-10]
    sort_particles(grid, scratch.sort, particles);
    clock.lap("sort");
    // [/enslaved_step]
    return solved;
}

/// From t^n to t^{n+1}.
/// in:     scratch.moments of t^n; q/m of each species
/// in/out: particles and field
/// out:    iterations and residual of the field solve
/// errors: NumericalError when the field does not converge or a particle is lost
template <class Clock = common::NoClock>
FieldReport take_step(const Grid& grid, double dt, const MoverSettings& mover,
                      const std::vector<double>& charge_over_mass, StepScratch& scratch,
                      std::vector<Particles>& particles, FieldState& field, Clock&& clock = {}) {
    if (scratch.solver.settings.uses_mass_matrix() &&
        scratch.solver.settings.solver == "newton_krylov")
        return take_enslaved_step(grid, dt, mover, scratch, particles, field, clock);
    if (scratch.solver.settings.uses_mass_matrix())
        return take_mass_matrix_step(grid, dt, scratch, particles, field, clock);
    // [step]
    const FieldReport solved = solve_field(scratch.solver, scratch.moments, charge_over_mass, dt,
                                           field, scratch.B_push);  // [IMM-10, 11, 12]
    interleave_field(grid, scratch.solver.settings.smoothing, field.E_theta, scratch.B_push,
                     scratch.interleave, scratch.field);  // grid -> particles
    clock.lap("field");
    move_particles(scratch.field, grid, dt, mover, particles);  // particles move
    clock.lap("mover");
    advance_field(scratch.solver, dt, field);  // [IMM-10]
    clock.lap("field");
    sort_particles(grid, scratch.sort, particles);  // for the next step
    clock.lap("sort");
    // [/step]
    return solved;
}

}  // namespace implicit_moment
