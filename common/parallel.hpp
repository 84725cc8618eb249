// Parallel loops whose result does not depend on the number of threads. All threads of the project
// start here.
//
// Work is cut into pieces that are fixed by the problem alone. Threads choose which piece they
// take, never how the pieces are cut or in which order partial sums are added; so one thread
// and forty give the same bits.
#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <numeric>
#include <vector>

namespace common {

/// Does a piece of a parallel loop and keeps what it throws, since no exception may leave the region. Never
/// inlined: two copies of a loop may fuse other products with sums, and round otherwise.
template <class Work>
[[gnu::noinline, gnu::noclone]] void do_piece(std::exception_ptr& thrown, const Work& work) try {
    work();
} catch (...) {
#pragma omp critical
    thrown = std::current_exception();
}

/// Number of pieces a loop over particles is cut into; any machine's threads share these.
inline constexpr int block_count = 16;

/// Loops over fewer numbers than this are over before another thread has woken up.
inline constexpr long parallel_threshold = 4096;

/// Calls work(row) for every row in [0, rows), those at the same time that are `colors` apart: a row that
/// writes to what it shares with the next one (two colors), or to both its neighbors (three), then meets
/// nobody else's writes, and every sum on the mesh is added in the same order whatever the number of threads.
/// A thread takes its own part of the rows, the same one in every loop of as many, so that what it left in
/// its cache is there when it comes back; then what others have not begun, from the ends of their parts.
/// in: numbers, how many a loop works on, where it is known to be short
/// errors: what one of the pieces throws, when all have ended
template <class Work>
void for_each_row_colored(long colors, long rows, const Work& work,
                          long numbers = parallel_threshold) {
    std::exception_ptr thrown;
    std::vector<std::atomic_flag> taken(std::size_t(std::max(rows, 0L)));
    const auto take = [&](long row) {
        std::atomic_flag& flag = taken[std::size_t(row)];
        if (!flag.test(std::memory_order_relaxed) && !flag.test_and_set(std::memory_order_relaxed))
            do_piece(thrown, [&] { work(row); });
    };
#pragma omp parallel if (numbers >= parallel_threshold)
    for (long color = 0; color < colors; ++color) {
        const long count = (rows - color + colors - 1) / colors;  // rows of this color
        const long me = omp_get_thread_num(), threads = omp_get_num_threads();
        const auto first = [&](long thread) { return count * thread / threads; };
        for (long k = first(me); k < first(me + 1); ++k) take(color + colors * k);
        for (long thread = me + 1; thread < me + threads; ++thread)
            for (long k = first(thread % threads + 1); k-- > first(thread % threads);)
                take(color + colors * k);
#pragma omp barrier
    }
    if (thrown) std::rethrow_exception(thrown);
}

/// The same for rows that do not write to each other's data.
template <class Work>
void for_each_row(long rows, const Work& work, long numbers = parallel_threshold) {
    for_each_row_colored(1, rows, work, numbers);
}

/// Calls work(piece) for every piece in [0, pieces); a thread takes neighboring pieces, and the same ones in
/// every loop of as many: what they left in its cache is there when it comes back.
template <class Work>
void for_each_piece(long pieces, const Work& work, long numbers = parallel_threshold) {
    std::exception_ptr thrown;
#pragma omp parallel for schedule(static) if (numbers >= parallel_threshold)
    for (long piece = 0; piece < pieces; ++piece) do_piece(thrown, [&] { work(piece); });
    if (thrown) std::rethrow_exception(thrown);
}

/// Calls work(block, begin, end) once for each of block_count contiguous pieces of [0, count).
template <class Work>
void for_each_block(long count, const Work& work, long numbers = parallel_threshold) {
    const auto first = [&](long block) { return count * block / block_count; };
    for_each_row(
        block_count, [&](long k) { work(int(k), first(k), first(k + 1)); }, numbers);
}

/// Sum of partial(begin, end) over the blocks of [0, count), added in block order.
template <class Partial>
double sum_over_blocks(long count, const Partial& partial, long numbers = parallel_threshold) {
    std::array<double, block_count> part{};
    for_each_block(
        count,
        [&](int block, long begin, long end) { part[std::size_t(block)] = partial(begin, end); },
        numbers);
    return std::accumulate(part.begin(), part.end(), 0.0);
}

/// Threads that a parallel region will have.
inline int thread_count() { return omp_get_max_threads(); }
/// Sets the number of threads; 0 leaves it as it is.
inline void set_thread_count(int threads) {
    if (threads > 0) omp_set_num_threads(threads);
}

}  // namespace common
