// What explicit_em keeps between steps besides its state, and the steps of its loop in those terms.
#pragma once

#include <vector>

#include "implicit_moment/explicit_em/count_moments.hpp"
#include "implicit_moment/explicit_em/sort_by_home.hpp"
#include "implicit_moment/explicit_em/yee_field.hpp"
#include "implicit_moment/setup/initial_state.hpp"

namespace implicit_moment {

/// Nothing of it is state: all is made anew in every step.
struct Leapfrog {
    const Case& wanted;
    PushField push;           // E^n and B^n, where particles feel them
    VectorField J, smoothed;  // J^{n+1/2}; E^n smoothed as J is
    Field scratch;
    CurrentScratch current;
    SortScratch sort;
    std::vector<Moments> now;

    explicit Leapfrog(const Case& w) : wanted(w), J(w.grid), smoothed(w.grid) {}
};

/// Packs E^n and B^n for the particles.
inline void pack_push_field(Leapfrog& run, const FieldState& field) {
    pack_push_field(run.wanted.grid, run.wanted.field.smoothing, field, run.smoothed, run.scratch,
                    run.push);
}

/// Moves all particles from t^n to t^{n+1}; out: run.J.
/// errors: NumericalError when a particle crosses more than a cell.
inline void move_particles(Leapfrog& run, std::vector<Particles>& species) {
    move_particles(run.push, run.wanted.grid, run.wanted.dt, run.wanted.leapfrog,
                   run.wanted.field.smoothing, species, run.current, run.J);
}

/// The moments of t^n. in: run.push of t^n; what is behind a wall.
inline const std::vector<Moments>& moments_now(Leapfrog& run, const State& state,
                                               detail::Images images = detail::Images::conductor) {
    const std::vector<Particles>& species = state.plasma.species;
    if (run.now.size() != species.size()) run.now.assign(species.size(), Moments(run.wanted.grid));
    count_moments(run.push, run.wanted.grid, run.wanted.dt, run.wanted.leapfrog, species, images,
                  run.now);
    return run.now;
}

}  // namespace implicit_moment
