// How fast the loop of cic.cpp is, and where its time goes: the same calls with a clock between
// them, on a warm plasma in two dimensions, by one thread and by two. `make bench` runs it, and
// `make REAL=float bench` in single precision.
#include <cstdio>

#include "cic/setup/initial_state.hpp"
#include "cic/sort_particles.hpp"
#include "cic/step.hpp"
#include "common/run/machine.hpp"
#include "tests/support/core_limits.hpp"

namespace {

using namespace cic;

// 256 x 256 cells as wide as the Debye length, 100 electrons in each, ions at rest.
Case warm_plasma() {
    Case parameters;
    parameters.dimensions = 2;
    parameters.grid = {{256, 0, 256, true}, {256, 0, 256, true}};
    SpeciesCase electrons, ions;
    electrons.name = "electrons";
    electrons.particles_per_cell = 100;
    electrons.temperature_x = electrons.temperature_z = 1;
    electrons.loading = "random";
    ions.name = "ions";
    ions.motion = "fixed";
    ions.charge = 1;
    parameters.species = {electrons, ions};
    return parameters;
}

common::StepClock time_steps(const Case& parameters, long steps, int threads,
                             long& particle_count) {
    common::set_thread_count(threads);
    FieldSolver solver(parameters.grid, parameters.scheme(), false, 1);
    State state = initial_state(parameters, solver);
    particle_count = state.count();
    FieldState field;
    Field rho_g;
    DepositScratch deposit_scratch;
    common::SortScratch<Real> sort_scratch;

    common::StepClock clock;
    for (long step = 0; step <= steps; ++step) {
        if (step == 1) clock.restart();  // the first step meets empty caches and unsorted particles
        find_field(state.species, parameters.grid, parameters.scheme(), 1, deposit_scratch, solver,
                   rho_g, field, clock);
        push_particles(field.E_g, parameters.grid, parameters.scheme(), parameters.B, parameters.dt,
                       state.species, clock);
        if (step % parameters.sort_interval == 0)
            sort_particles(parameters.grid, sort_scratch, state.species);
        clock.lap("sort");
    }
    return clock;
}

// What a particle takes, counted in the code. In one direction: Clouds 4; move 9, of which 5 bring it
// back on a periodic mesh and 2 compare; accelerate 5, of which 3 are for the sums. On the four nodes:
// weights 2, their products 4, then 4 sums of charge or 16 flops for two components of the field.
constexpr double numbers = sizeof(Real);
constexpr support::Count deposit{2 * 4 + 2 + 4 + 4, 2 * numbers};  // reads x, z
constexpr support::Count push{2 * (4 + 9 + 5) + 2 + 4 + 16,
                              2 * 4 * numbers};  // x, z, vx, vz and back

}  // namespace

int main() {
    const Case parameters = warm_plasma();
    const long steps = 2 * parameters.sort_interval;
    long particles = 0;
    double one_thread = 0;
    common::StepClock of_one;
    std::printf(
        "cic, 256 x 256 cells, 100 particles per cell, cic weighting, momentum scheme, "
        "%s precision, %ld steps\n\n",
        sizeof(Real) == 8 ? "double" : "single", steps);
    std::printf("%8s %16s %9s %9s %9s %9s %9s\n", "threads", "particle-steps/s", "speed-up",
                "deposit", "field", "push", "sort");
    for (const int threads : {1, 2}) {
        const common::StepClock clock = time_steps(parameters, steps, threads, particles);
        const double rate = double(particles) * double(steps) / clock.total();
        if (threads == 1) one_thread = rate, of_one = clock;
        const auto percent = [&](const char* part) {
            return 100 * clock.seconds(part) / clock.total();
        };
        std::printf("%8d %16.4g %9.2f %8.1f%% %8.1f%% %8.1f%% %8.1f%%\n", threads, rate,
                    rate / one_thread, percent("deposit"), percent("field"), percent("push"),
                    percent("sort"));
    }
    const double peak = support::peak_flops<Real>(), triad = support::triad_bytes();
    support::print_limits(peak, triad);
    const auto print = [&](const char* loop, double seconds, const support::Count& count) {
        support::print_use(loop, seconds / double(particles * steps), count, peak, triad);
    };
    print("deposit", of_one.seconds("deposit"), deposit);
    print("push", of_one.seconds("push"), push);
    print("step", of_one.total(), {deposit.flops + push.flops, deposit.bytes + push.bytes});
    const double carried = 4 * sizeof(Real), scratch = sizeof(Real) + sizeof(int);
    std::printf(
        "\n%ld particles, %.0f bytes each (%.0f carried, %.0f to sort); peak memory %.1f MiB\n",
        particles, carried + scratch, carried, scratch, common::peak_memory_bytes() / 1048576);
    return 0;
}
