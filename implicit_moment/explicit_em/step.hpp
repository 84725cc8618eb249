// The step of explicit_em, call by call. The row of t^n belongs between interleaving the field and
// moving the particles.
#pragma once

#include <vector>

#include "common/step_clock.hpp"
#include "implicit_moment/explicit_em/deposit_charge_and_current.hpp"
#include "implicit_moment/explicit_em/sort_by_cell.hpp"
#include "implicit_moment/explicit_em/yee_field.hpp"

namespace implicit_moment {

/// What a run keeps between steps besides its state; all is made anew in every step.
struct LeapfrogScratch {
    InterleavedField field;  // E^n and B^n, where particles feel them
    InterleaveScratch interleave;
    VectorField J;  // J^{n+1/2}
    CurrentScratch current;
    std::vector<Crossings> crossings;  // of each species

    explicit LeapfrogScratch(const Grid& grid) : interleave(grid), J(grid) {}
};

/// Interleaves E^n and B^n for the particles. out: scratch.field
template <class Clock = common::NoClock>
void interleave_field(const Grid& grid, const SmoothingSettings& smoothing, const FieldState& field,
                      LeapfrogScratch& scratch, Clock&& clock = {}) {
    interleave_field(grid, smoothing, field.E, field.B, scratch.interleave, scratch.field);
    clock.lap("field");
}

/// From t^n to t^{n+1}.
/// in:     scratch.field of t^n
/// in/out: particles and field
/// errors: NumericalError when a particle crosses more than a cell
template <class Clock = common::NoClock>
void take_step(const Grid& grid, double dt, const LeapfrogSettings& settings,
               const SmoothingSettings& smoothing, LeapfrogScratch& scratch,
               std::vector<Particles>& particles, FieldState& field, Clock&& clock = {}) {
    // [step]
    move_particles(scratch.field, grid, dt, settings, smoothing, particles, scratch.crossings,
                   scratch.current, scratch.J);  // u^{n+1/2}, x^{n+1}, J^{n+1/2}
    clock.lap("push");
    advance_field(grid, dt, scratch.J, field);  // E^{n+1}, B^{n+1}
    clock.lap("field");
    sort_by_cell(grid, settings.order, scratch.crossings, particles);
    clock.lap("sort");
    // [/step]
}

/// The moments of each species at t^n, for output.
/// in:     scratch.field of t^n; images, what is behind a wall
inline std::vector<Moments> find_moments(const Grid& grid, double dt,
                                         const LeapfrogSettings& settings,
                                         const std::vector<Particles>& particles, Images images,
                                         const LeapfrogScratch& scratch) {
    std::vector<Moments> moments(particles.size(), Moments(grid));
    deposit_charge_and_current(scratch.field, grid, dt, settings, particles, images, moments);
    return moments;
}

}  // namespace implicit_moment
