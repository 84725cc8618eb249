// How fast the step of implicit_moment is, and where its time goes: the same calls with a clock between
// them, on the run of the talk's cost slide, by one thread and by two. `make bench` runs it.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "implicit_moment/setup/initial_state.hpp"
#include "implicit_moment/step.hpp"
#include "tests/support/time_threads.hpp"

namespace {

using namespace implicit_moment;
using support::Loops, support::time_threads;

// What a particle takes, counted in the code. Where it is in its cell, 4; quadratic splines, 16; B there, 39,
// and E, 50; the midpoint rule, 42. moments: sums of a species 13, of a node 126. mover: twice (as in
// this run) a midpoint with E, B and how far it strays, 165; walls and update 27. mass: weights 21,
// rotation 52, both factors 105, block 1008; mover: two flights 8, kick 160.
const Loops of_moments{{"moments", {4 + 16 + 39 + 42 + 13 + 126, 40}},   // x, u
                       {"mover", {4 + 2 * 165 + 27, 80}},                // x, u and back
                       {"sort", {0, 32 + 5 * 20}}};                      // keys, places; x, u
const Loops of_mass{{"mass", {4 + 16 + 39 + 21 + 52 + 105 + 1008, 40}},  // x, u
                    {"mover", {8 + 160, 2 * 48 + 64}}};                  // x, u; x, u and back

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
    return 0;
}
