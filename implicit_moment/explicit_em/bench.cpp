// How fast the step of explicit_em is, and where its time goes: the same calls with a clock between them,
// on the explicit run of the talk's cost slide, by one thread and by two. `make bench` runs it.
#include "implicit_moment/explicit_em/setup/leapfrog_state.hpp"
#include "implicit_moment/explicit_em/step.hpp"
#include "implicit_moment/setup/describe_case.hpp"
#include "tests/support/time_threads.hpp"

int main() {
    using namespace implicit_moment;
    // What a particle takes, counted in the code: gather 24, kicks 12, rotation 48, gamma 10, way and cell
    // 21, current 26; those that leave their cell take more. Its numbers are read and written.
    constexpr double bytes = 2 * 5 * sizeof(ParticleReal);
    const support::Loops loops{{"push", {2 * 3 + 24 + 12 + 48 + 10 + 21 + 26, bytes}},
                               {"sort", {0, bytes}}};
    Case e;
    describe_explicit(e);
    const std::string precision = sizeof(ParticleReal) == sizeof(float) ? ", single precision" : "";
    support::time_threads(e, "explicit_em" + precision, 20, {"push", "field", "sort"}, loops,
                          leapfrog_state, [&](State& state, common::StepClock& clock) {
                              LeapfrogScratch scratch(e.grid);
                              clock.resume();
                              for (long step = 0; step < 20; ++step) {
                                  interleave_field(e.grid, e.field.smoothing, state.field, scratch,
                                                   clock);
                                  take_step(e.grid, e.dt, e.leapfrog, e.field.smoothing, scratch,
                                            state.plasma.species, state.field, clock);
                              }
                              return 0.0;
                          });
    return 0;
}
