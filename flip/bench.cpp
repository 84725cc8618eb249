// How fast the loops of pic.cpp and flip.cpp are, and where their time goes: the same calls with a
// clock between them, on the Rayleigh-Taylor instability with nine particles per cell, by one thread
// and by two; then the time per particle on small and large meshes, and about an axis. `make bench`
// runs it.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "common/run/machine.hpp"
#include "flip/flip/step.hpp"
#include "flip/pic/step.hpp"
#include "flip/setup/problem_of_case.hpp"
#include "tests/support/core_limits.hpp"

namespace {

using namespace flip;

// Heavy gas on light gas, in a box twice as high as wide; or in a can, where it rests at first.
Case heavy_on_light(long cells_x, bool rings = false) {
    Case parameters;
    parameters.grid = {{cells_x, 0, 1, true}, {2 * cells_x, -1, 2, false}};
    parameters.boundaries[z_low].kind = parameters.boundaries[z_high].kind = "slip";
    parameters.materials = {{"light", 1.4, 0}, {"heavy", 1.4, 0}};
    parameters.per_cell_x = parameters.per_cell_z = 3;
    parameters.gravity_z = -1;
    RegionCase light, heavy;
    light.gas = {"light", 1, 20, 0, 0};
    light.flow = rings ? "uniform" : "overturn";
    light.amplitude = 0.1;
    light.hydrostatic = true;
    heavy = light;
    heavy.shape = "above";
    heavy.gas.material = "heavy";
    heavy.gas.density = 2;
    parameters.regions = {light, heavy};
    if (rings) {
        parameters.geometry = "axisymmetric";
        parameters.grid.x.periodic = false;
        parameters.boundaries[x_low].kind = parameters.boundaries[x_high].kind = "slip";
    }
    return completed(parameters);
}

// The time of `steps` steps of one of the programs, after a first one that meets empty caches.
// out: count, the number of particles
common::StepClock time_steps(bool pic, const Case& parameters, long steps, long& count) {
    const Problem problem = problem_of(parameters);
    FlipScratch scratch(problem);
    PicCells cells(problem);
    State state;
    state.particles = load_particles(parameters);
    if (pic) state = initial_state(problem, state.particles, cells);
    count = state.particles.count();
    sort_particles(problem.grid, scratch.sort, state.particles);
    common::StepClock clock;
    for (long step = 0; step <= steps; ++step) {
        if (step == 1) clock.restart();
        if (pic) {
            find_pressure(problem, state, cells);
            clock.lap("mesh");
            take_pic_step(problem, state, cells, clock);
        } else {
            find_fluid(problem, state, scratch.mesh, clock);
            take_flip_step(problem, step, scratch, state, clock);
        }
    }
    return clock;
}

// What a particle takes in the plane, counted in the code. Of pic: a direction 8, weights 6, a component
// of velocity and position 9, wrap and boundaries 8; then cell 8, five sums 13. Of flip: weights_at 20,
// products S or R of four each 4; a node takes 8 or gives 10, a cell 4; momentum, energy 3; heat 5, new
// velocity, position and energy 7, wrap and boundaries 8.
struct Loop {
    const char *name, *part;
    support::Count count;
};
const std::vector<Loop> loops_of_pic{
    {"move", "move", {2 * 8 + 6 + 2 * 9 + 8, 36}},  // x, z and back, donor
    {"repart.", "repartition", {8 + 13, 40}}};      // z, x, z, m, material, donor
const std::vector<Loop> loops_of_flip{
    {"deposit", "deposit", {20 + 3 + 4 + 4 * 8 + 4 + 4 * 4, 52}},  // x, z, m, vx, vz, e, material
    {"move", "move", {20 + 4 + 4 * 10 + 4 + 4 * 4 + 5 + 7 + 8, 84}}};  // all but m, and back

}  // namespace

int main() {
    const double peak = support::peak_flops<double>(), triad = support::triad_bytes();
    for (const bool pic : {true, false}) {
        std::printf("%s, Rayleigh-Taylor, 256 x 512 cells, 9 particles per cell, explicit\n\n",
                    pic ? "pic" : "flip");
        std::printf("%8s %16s %9s %9s %9s %9s %9s\n", "threads", "particle-steps/s", "speed-up",
                    pic ? "repart." : "deposit", pic ? "Lagrange" : "mesh", "move",
                    pic ? "" : "sort");
        const Case parameters = heavy_on_light(256);
        double one_thread = 0;
        std::vector<double> seconds;
        for (const int threads : {1, 2}) {
            common::set_thread_count(threads);
            long count = 0;
            const long steps = 20;
            const common::StepClock clock = time_steps(pic, parameters, steps, count);
            const double rate = double(count) * double(steps) / clock.total();
            if (threads == 1) {
                one_thread = rate;
                for (const Loop& loop : pic ? loops_of_pic : loops_of_flip)
                    seconds.push_back(clock.seconds(loop.part) / double(count * steps));
            }
            const auto percent = [&](const char* part) {
                return 100 * clock.seconds(part) / clock.total();
            };
            std::printf("%8d %16.4g %9.2f %8.1f%% %8.1f%% %8.1f%%", threads, rate,
                        rate / one_thread, percent(pic ? "repartition" : "deposit"),
                        percent("mesh"), percent("move"));
            if (!pic) std::printf(" %8.1f%%", percent("sort"));
            std::printf("\n");
        }
        support::print_limits(peak, triad);
        for (std::size_t k = 0; k < seconds.size(); ++k) {
            const Loop& loop = (pic ? loops_of_pic : loops_of_flip)[k];
            support::print_use(loop.name, seconds[k], loop.count, peak, triad);
        }
        std::printf("\n%14s %16s %22s\n", "cells", "particles", "ns per particle-step");
        common::set_thread_count(1);
        const auto time_mesh = [&](long cells_x, bool rings) {
            long count = 0;
            const long steps = std::max(4L, 20 * 256 * 256 / (cells_x * cells_x) / 4);
            const common::StepClock clock =
                time_steps(pic, heavy_on_light(cells_x, rings), steps, count);
            std::printf("%7ld x %4ld %16ld %22.1f%s\n", cells_x, 2 * cells_x, count,
                        1e9 * clock.total() / double(count * steps), rings ? " (r, z)" : "");
        };
        for (const long cells_x : {64L, 128L, 256L, 512L}) time_mesh(cells_x, false);
        time_mesh(256, true);
        std::printf("\n");
    }
    const double label = 2 * sizeof(int), sorted = sizeof(double) + sizeof(int);
    std::printf("bytes per particle: pic %.0f, flip %.0f; peak memory %.1f MiB\n",
                3 * sizeof(double) + label + sorted, 6 * sizeof(double) + label + sorted,
                common::peak_memory_bytes() / 1048576);
    return 0;
}
