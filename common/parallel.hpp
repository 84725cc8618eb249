// Parallel loops whose result does not depend on the number of threads. All OpenMP of the project
// lives here.
//
// Work is cut into pieces that are fixed by the problem alone. Threads choose which piece they
// take next, never how the pieces are cut or in which order partial sums are added; so one thread
// and forty give the same bits.
#pragma once

#include <omp.h>

#include <array>
#include <exception>
#include <numeric>

namespace common {

/// Does a piece of a parallel loop, and keeps what it throws: no exception may leave the region.
template <class Work>
void do_piece(std::exception_ptr& thrown, const Work& work) try {
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
/// in: numbers, how many a loop works on, where it is known to be short
/// errors: what one of the pieces throws, when all have ended
template <class Work>
void for_each_row_colored(long colors, long rows, const Work& work,
                          long numbers = parallel_threshold) {
    std::exception_ptr thrown;
#pragma omp parallel if (numbers >= parallel_threshold)
    for (long color = 0; color < colors; ++color) {
#pragma omp for schedule(dynamic, 1)
        for (long row = color; row < rows; row += colors) do_piece(thrown, [&] { work(row); });
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
