// How long messages between two ranks take, by the functions with which the programs exchange them.
// Run:   mpirun -n 2 build/mpi/benches/message_times      (make MPI=1 bench)
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "common/ranks.hpp"

namespace {

// Seconds of one call, the least of ten means.
template <class Call>
double seconds_of(long calls, const Call& call) {
    using Clock = std::chrono::steady_clock;
    double least = 1e9;
    for (int series = 0; series < 10; ++series) {
        const auto start = Clock::now();
        for (long k = 0; k < calls; ++k) call(k);
        const std::chrono::duration<double> all = Clock::now() - start;
        least = std::min(least, all.count() / double(calls));
    }
    return least;
}

}  // namespace

int main() {
    common::start_ranks();
    const int me = common::rank(), peers[] = {1 - me};
    if (common::rank_count() != 2) return common::end_ranks(2, "message_times wants two ranks");
    std::printf("messages between two ranks%s; gather: half of as many numbers comes from each\n\n",
                common::ranks_here() == 2 ? " of one machine, through its memory" : "");
    std::printf("%10s %14s %10s %14s %10s\n", "bytes", "message, us", "GB/s", "gather, us", "GB/s");
    double shortest = 0, longest = 0;
    constexpr long most = 1 << 21;
    for (long count = 1; count <= most; count *= 8) {
        const long calls = std::clamp(most / count / 8, 4L, 2000L), bytes = 8 * count;
        const std::vector<std::vector<double>> message{std::vector<double>(count, 1.0)}, nothing(1);
        std::vector<std::vector<double>> from;
        // Back and forth: first from rank 0, then from rank 1.
        const double there = seconds_of(2 * calls, [&](long k) {
            common::exchange(peers, k % 2 == me ? message : nothing, from);
        });
        std::vector<double> all(count, 1.0);
        const long first[] = {0, count / 2, count};
        const double gathered =
            seconds_of(calls, [&](long) { common::gather_pieces(all.data(), first); });
        std::printf("%10ld %14.2f %10.2f %14.2f %10.2f\n", bytes, 1e6 * there,
                    1e-9 * double(bytes) / there, 1e6 * gathered, 1e-9 * double(bytes) / gathered);
        (count == 1 ? shortest : longest) = there;
    }
    std::printf("\nlatency %.2f us, bandwidth %.2f GB/s\n", 1e6 * shortest,
                8e-9 * double(most) / longest);
    return common::end_ranks(0);
}
