// How fast the steps of implicit_moment and explicit_em are by one thread and by two, and where their time
// goes; both benches print it.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "common/parallel.hpp"
#include "common/run/machine.hpp"
#include "common/step_clock.hpp"
#include "implicit_moment/setup/initial_state.hpp"
#include "tests/support/core_limits.hpp"

namespace support {

using implicit_moment::Case, implicit_moment::ParticleReal, implicit_moment::State;

/// A loop over particles, and what it does for one of them.
struct Loop {
    const char* name;
    Count count;
};
using Loops = std::vector<Loop>;

/// Prints a line for one thread and one for two: the rate, and the shares of the parts of a step; and of
/// its loops over particles, by one thread, how much of the machine they use.
/// in:     start(parameters), which makes the state; take(state, clock), which takes all steps and says how
///         many iterations of the field each had
template <class Start, class Take>
inline void time_threads(const Case& parameters, const std::string& program, long steps,
                         const std::vector<std::string>& parts, const Loops& loops,
                         const Start& start, const Take& take) {
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
    static const double peak = peak_flops<ParticleReal>(), triad = triad_bytes();
    print_limits(peak, triad);
    for (std::size_t k = 0; k < loops.size(); ++k)
        print_use(loops[k].name, seconds[k], loops[k].count, peak, triad);
    std::printf("\n%.0f particles of %zu bytes; peak memory %.1f MiB\n", count,
                5 * sizeof(ParticleReal), common::peak_memory_bytes() / 1048576);
}

}  // namespace support
