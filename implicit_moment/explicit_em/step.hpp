// The step of explicit_em, call by call, and what it keeps between steps besides its state. The row of
// t^n belongs between packing the field and moving the particles.
#pragma once

#include <vector>

#include "common/step_clock.hpp"
#include "implicit_moment/explicit_em/count_moments.hpp"
#include "implicit_moment/explicit_em/sort_by_home.hpp"
#include "implicit_moment/explicit_em/yee_field.hpp"
#include "implicit_moment/setup/initial_state.hpp"

namespace implicit_moment {

/// Nothing of it is state: all is made anew in every step.
struct Leapfrog {
    const Case& parameters;
    PushField push;           // E^n and B^n, where particles feel them
    VectorField J, smoothed;  // J^{n+1/2}; E^n smoothed as J is
    Field scratch;
    CurrentScratch current;
    SortScratch sort;
    std::vector<Moments> now;

    explicit Leapfrog(const Case& w) : parameters(w), J(w.grid), smoothed(w.grid) {}
};

/// Packs E^n and B^n for the particles.
template <class Clock = common::NoClock>
void pack_push_field(Leapfrog& run, const FieldState& field, Clock&& clock = {}) {
    pack_push_field(run.parameters.grid, run.parameters.field.smoothing, field, run.smoothed,
                    run.scratch, run.push);
    clock.lap("field");
}

/// From t^n to t^{n+1}.
/// in:     run.push of t^n
/// in/out: field and particles
/// errors: NumericalError when a particle crosses more than a cell
template <class Clock = common::NoClock>
void take_step(Leapfrog& run, FieldState& field, std::vector<Particles>& species,
               Clock&& clock = {}) {
    const Case& w = run.parameters;
    // [step]
    move_particles(run.push, w.grid, w.dt, w.leapfrog, w.field.smoothing, species, run.current,
                   run.J);  // u^{n+1/2}, x^{n+1}, J^{n+1/2}
    clock.lap("push");
    advance_field(w.grid, w.dt, run.J, field);  // E^{n+1}, B^{n+1}
    clock.lap("field");
    sort_by_home(w.grid, w.leapfrog.order, run.sort, species);
    clock.lap("sort");
    // [/step]
}

/// The moments of t^n. in: run.push of t^n; what is behind a wall.
inline const std::vector<Moments>& moments_now(Leapfrog& run, const State& state,
                                               detail::Images images = detail::Images::conductor) {
    const std::vector<Particles>& species = state.plasma.species;
    if (run.now.size() != species.size())
        run.now.assign(species.size(), Moments(run.parameters.grid));
    count_moments(run.push, run.parameters.grid, run.parameters.dt, run.parameters.leapfrog,
                  species, images, run.now);
    return run.now;
}

}  // namespace implicit_moment
