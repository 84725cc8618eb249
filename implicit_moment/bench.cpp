// How fast the steps of implicit_moment and explicit_em are, and where their time goes: the same calls
// with a clock between them, on the two runs of the talk's cost slide, by one thread and by two.
// `make bench` runs it.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "common/run/machine.hpp"
#include "implicit_moment/explicit_em/setup/leapfrog_state.hpp"
#include "implicit_moment/explicit_em/step.hpp"
#include "implicit_moment/setup/describe_case.hpp"
#include "implicit_moment/setup/initial_state.hpp"
#include "implicit_moment/step.hpp"
#include "tests/support/core_limits.hpp"

namespace {

using namespace implicit_moment;

// What a particle takes, counted in the code. Where it is in its cell, 4; quadratic splines, 16; B there, 39,
// and E, 50; the midpoint rule, 42. moments: sums of a species 13, of a node 126. mover: twice (as in
// this run) a midpoint with E, B and how far it strays, 165; walls and update 27. mass: weights 21,
// rotation 52, both factors 105, block 1008; mover: two flights 8, kick 160. push: gather 24, kicks 12,
// rotation 48, gamma 10, way and cell 21, current 26; those that leave their cell take more.
struct Loop {
    const char* name;
    support::Count count;
};
using Loops = std::vector<Loop>;
const Loops of_moments{{"moments", {4 + 16 + 39 + 42 + 13 + 126, 40}},    // x, u
                       {"mover", {4 + 2 * 165 + 27, 80}},                 // x, u and back
                       {"sort", {0, 32 + 5 * 20}}};                       // keys, places; x, u
const Loops of_mass{{"mass", {4 + 16 + 39 + 21 + 52 + 105 + 1008, 40}},   // x, u
                    {"mover", {8 + 160, 2 * 48 + 64}}};                   // x, u; x, u and back
const Loops of_push{{"push", {2 * 3 + 24 + 12 + 48 + 10 + 21 + 26, 80}},  // x, u and back
                    {"sort", {0, 80}}};                                   // x, u and back

// Prints a line for one thread and one for two: the rate, and the shares of the parts of a step; and of
// its loops over particles, by one thread, how much of the machine they use.
// in: start(parameters), which makes the state; take(state, clock), which takes all steps and says how
//     many iterations of the field each had
template <class Start, class Take>
void time_threads(const Case& parameters, const std::string& program, long steps,
                  const std::vector<std::string>& parts, const Loops& loops, const Start& start,
                  const Take& take) {
    std::printf("\n%s, GEM default case (%ld x %ld cells), %ld steps\n\n%8s %16s %9s",
                program.c_str(), parameters.grid.x.cells, parameters.grid.z.cells, steps, "threads",
                "particle-steps/s", "speed-up");
    for (const std::string& part : parts) std::printf(" %9s", part.c_str());
    std::printf(" %11s\n", "iterations");
    double one_thread = 0, count = 0;
    std::vector<double> seconds;
    for (const int threads : {1, 2}) {
        common::set_thread_count(threads);
        State state = start(parameters);
        count = double(state.plasma.count());
        common::StepClock clock;
        const double iterations = take(state, clock);
        const double total = clock.total(), rate = count * double(steps) / total;
        if (threads == 1) {
            one_thread = rate;
            for (const Loop& loop : loops)
                seconds.push_back(clock.seconds(loop.name) / (count * double(steps)));
        }
        std::printf("%8d %16.4g %9.2f", threads, rate, rate / one_thread);
        for (const std::string& part : parts)
            std::printf(" %8.1f%%", 100 * clock.seconds(part.c_str()) / total);
        std::printf(" %11.1f\n", iterations);
    }
    static const double peak = support::peak_flops<double>(), triad = support::triad_bytes();
    support::print_limits(peak, triad);
    for (std::size_t k = 0; k < loops.size(); ++k)
        support::print_use(loops[k].name, seconds[k], loops[k].count, peak, triad);
    std::printf("\n%.0f particles of %zu bytes; peak memory %.1f MiB\n", count, 5 * sizeof(double),
                common::peak_memory_bytes() / 1048576);
}

// Prints what the field takes per node on finer meshes of the same box, by one thread and by two, with as many
// particles in each cell.
void time_field(Case parameters) {
    std::printf("\nfield solve, response = %s, 12 particles per cell\n\n%12s %11s %25s %25s\n",
                parameters.field.response.c_str(), "cells", "iterations", "us per node, one thread",
                "two threads");
    for (const long cells : {64L, 128L, 256L, 512L}) {
        parameters.grid.x.cells = parameters.grid.z.cells = cells;
        parameters.harris.particles = 12 * cells * cells;
        State state = initial_state(parameters);
        const auto charge_over_mass = state.plasma.charge_over_mass();
        const long steps = std::max(4L, 40 * 64 / cells);
        double iterations = 0;
        std::printf("%5ld x %4ld", cells, cells);
        for (const int threads : {1, 2}) {
            common::set_thread_count(threads);
            StepScratch scratch(parameters.grid, parameters.field, state.plasma.species.size());
            common::StepClock clock;
            iterations = 0;
            for (long step = -2; step < steps; ++step) {  // two to begin with
                if (step == 0) clock.restart(), iterations = 0;
                find_moments(parameters.grid, parameters.dt, state.plasma.species, state.field,
                             scratch, clock);
                iterations +=
                    take_step(parameters.grid, parameters.dt, parameters.mover, charge_over_mass,
                              scratch, state.plasma.species, state.field, clock)
                        .iterations;
            }
            if (threads == 1) std::printf(" %11.1f", iterations / double(steps));
            std::printf(" %25.2f", 1e6 * clock.seconds("field") / double(steps * cells * cells));
        }
        std::printf("\n");
    }
}

}  // namespace

int main() {
    Case w;  // the defaults are the GEM challenge
    const auto time_response = [&](const std::string& response, long steps,
                                   const std::vector<std::string>& parts, const Loops& loops) {
        w.field.response = response;
        time_threads(w, "implicit_moment, response = " + response, steps, parts, loops,
                     initial_state, [&](State& state, common::StepClock& clock) {
                         std::vector<Particles>& particles = state.plasma.species;
                         const auto charge_over_mass = state.plasma.charge_over_mass();
                         StepScratch scratch(w.grid, w.field, particles.size());
                         double iterations = 0;
                         clock.resume();
                         for (long step = 0; step < steps; ++step) {
                             find_moments(w.grid, w.dt, particles, state.field, scratch, clock);
                             iterations += take_step(w.grid, w.dt, w.mover, charge_over_mass,
                                                     scratch, particles, state.field, clock)
                                               .iterations;
                         }
                         return iterations / double(steps);
                     });
    };
    time_response("moments", 400, {"moments", "field", "mover", "sort"}, of_moments);
    time_response("mass_matrix", 200, {"moments", "mass", "field", "mover", "sort"}, of_mass);
    w.field.response = "moments";
    time_field(w);
    Case e;
    describe_explicit(e);
    time_threads(e, "explicit_em", 20, {"push", "field", "sort"}, of_push, leapfrog_state,
                 [&](State& state, common::StepClock& clock) {
                     LeapfrogScratch scratch(e.grid);
                     clock.resume();
                     for (long step = 0; step < 20; ++step) {
                         interleave_field(e.grid, e.field.smoothing, state.field, scratch, clock);
                         take_step(e.grid, e.dt, e.leapfrog, e.field.smoothing, scratch,
                                   state.plasma.species, state.field, clock);
                     }
                     return 0.0;
                 });
    return 0;
}
