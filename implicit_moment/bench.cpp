// How fast the loops of implicit_moment.cpp and explicit_em.cpp are, and where their time goes: the
// same calls with a clock between them, on the two runs of the talk's cost slide, by one thread and
// by two. `make bench` runs it.
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "implicit_moment/explicit_em/setup/leapfrog_state.hpp"
#include "implicit_moment/explicit_em/step.hpp"
#include "implicit_moment/setup/initial_state.hpp"
#include "implicit_moment/step.hpp"

namespace {

using namespace implicit_moment;

struct Split {
    common::StepClock clock;
    double iterations = 0;
};

Split time_steps(const Case& parameters, long steps, int threads, long& particle_count) {
    common::set_thread_count(threads);
    const Grid& grid = parameters.grid;
    State state = initial_state(parameters);
    std::vector<Particles>& particles = state.plasma.species;
    const std::vector<double> charge_over_mass = state.plasma.charge_over_mass();
    StepScratch scratch(grid, parameters.field, particles.size());
    particle_count = state.plasma.count();

    Split split;
    for (long step = 0; step < steps; ++step) {
        find_moments(grid, parameters.dt, particles, state.field, scratch, split.clock);
        const FieldReport report =
            take_step(grid, parameters.dt, parameters.mover, charge_over_mass, scratch, particles,
                      state.field, split.clock);
        split.iterations += report.iterations;
    }
    split.iterations /= static_cast<double>(steps);
    return split;
}

double peak_memory() {
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024;
}

// explicit_em on its default case: the loop without what happens once in twenty steps.
void time_explicit(long steps) {
    Case parameters;
    describe_explicit(parameters);
    const Grid& grid = parameters.grid;
    std::printf("\nexplicit_em, GEM default case (%ld x %ld cells), %ld steps\n\n", grid.x.cells,
                grid.z.cells, steps);
    std::printf("%8s %16s %9s %9s %9s %9s\n", "threads", "particle-steps/s", "speed-up", "push",
                "field", "sort");
    double one_thread = 0, count = 0;
    for (const int threads : {1, 2}) {
        common::set_thread_count(threads);
        State state = leapfrog_state(parameters);
        LeapfrogScratch scratch(grid);
        std::vector<Particles>& particles = state.plasma.species;
        count = static_cast<double>(state.plasma.count());
        common::StepClock clock;
        for (long step = 0; step < steps; ++step) {
            interleave_field(grid, parameters.field.smoothing, state.field, scratch, clock);
            take_step(grid, parameters.dt, parameters.leapfrog, parameters.field.smoothing, scratch,
                      particles, state.field, clock);
        }
        const double total = clock.total(), rate = count * static_cast<double>(steps) / total;
        if (threads == 1) one_thread = rate;
        std::printf("%8d %16.4g %9.2f %8.1f%% %8.1f%% %8.1f%%\n", threads, rate, rate / one_thread,
                    100 * clock.seconds("push") / total, 100 * clock.seconds("field") / total,
                    100 * clock.seconds("sort") / total);
    }
    std::printf("\n%.0f particles, %.1f bytes of peak memory for each, mesh included\n", count,
                peak_memory() / count);
}

}  // namespace

int main() {
    const Case parameters;  // the defaults are the GEM challenge
    const long steps = 400;
    long particles = 0;
    double one_thread = 0;
    std::printf("implicit_moment, GEM default case, %ld steps\n\n", steps);
    std::printf("%8s %16s %9s %9s %9s %9s %9s %11s\n", "threads", "particle-steps/s", "speed-up",
                "moments", "field", "mover", "sort", "iterations");
    for (const int threads : {1, 2}) {
        const Split split = time_steps(parameters, steps, threads, particles);
        const double rate =
            static_cast<double>(particles) * static_cast<double>(steps) / split.clock.total();
        if (threads == 1) one_thread = rate;
        const auto percent = [&](const char* part) {
            return 100 * split.clock.seconds(part) / split.clock.total();
        };
        std::printf("%8d %16.4g %9.2f %8.1f%% %8.1f%% %8.1f%% %8.1f%% %11.1f\n", threads, rate,
                    rate / one_thread, percent("moments"), percent("field"), percent("mover"),
                    percent("sort"), split.iterations);
    }
    const double carried = 5 * sizeof(double), scratch = sizeof(double) + sizeof(int);
    std::printf(
        "\n%ld particles, %.0f bytes each (%.0f carried, %.0f to sort); peak memory %.1f MiB\n",
        particles, carried + scratch, carried, scratch, peak_memory() / 1048576);
    time_explicit(20);
    return 0;
}
