// What the loops of cic work on where ranks share a run (common/ranks.hpp): sums over particles are
// those of block_count blocks of a list (common/parallel.hpp), added in their order, and each rank has
// some of the blocks. One process has all of them.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <type_traits>
#include <vector>

#include "common/parallel.hpp"
#include "common/ranks.hpp"

namespace cic {

/// The first block of a rank, and where that begins in a list of `count` numbers.
/// in:     the rank; the number of ranks for the end
/// exact:  ranks have equally many blocks, or one more
inline int first_block(int of_rank) { return common::block_count * of_rank / common::rank_count(); }
inline long begin_of_rank(long count, int of_rank) {
    return count * first_block(of_rank) / common::block_count;
}
/// Calls work(block, begin, end) for each block that this rank has; begin and end count from its own first
/// particle, since it stores no others. in: count, of all ranks
template <class Work>
void for_each_own_block(long count, const Work& work) {
    const auto first = [&](long block) { return count * block / common::block_count; };
    const long own = first_block(common::rank()), begin = first(own);
    common::for_each_row(first_block(common::rank() + 1) - own, [&](long k) {
        work(int(own + k), first(own + k) - begin, first(own + k + 1) - begin);
    });
}
/// Gives every rank what the others have made of their blocks. in: sums of doubles
template <class Sums>
void gather_blocks(std::array<Sums, common::block_count>& sums) {
    static_assert(std::is_trivially_copyable_v<Sums> && sizeof(Sums) % sizeof(double) == 0);
    std::vector<long> first;
    for (int k = 0; k <= common::rank_count(); ++k)
        first.push_back(first_block(k) * long(sizeof(Sums) / sizeof(double)));
    common::gather_pieces(reinterpret_cast<double*>(sums.data()), first);
}

/// The numbers of all ranks one after the other, with every rank.
inline std::vector<double> gather_with_all(const std::vector<double>& own) {
    if (common::rank_count() == 1) return own;
    std::vector<long> first(std::size_t(common::rank_count() + 1), 0);
    first[common::rank() + 1] = std::ssize(own);
    common::sum_over_ranks(first);
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<double> all(std::size_t(first.back()));
    std::ranges::copy(own, all.begin() + first[common::rank()]);
    common::gather_pieces(all.data(), first);
    return all;
}

/// Every rank calls work(row) for every row of a mesh, one rank after the other; in the end all ranks
/// have the same numbers. They take turns at a few rows at a time, so that none waits for long.
template <class Work>
void for_each_row_in_turn(long rows, long stride, double* numbers, const Work& work) {
    const long pieces = common::rank_count() > 1 ? std::clamp(rows * stride / 4096, 1L, rows) : 1;
    std::vector<long> first;
    for (long k = 0; k <= pieces; ++k) first.push_back(rows * k / pieces * stride);
    common::in_turn(numbers, first, [&](long k) {
        const long begin = first[k] / stride, end = first[k + 1] / stride;
        common::for_each_row(end - begin, [&](long row) { work(begin + row); });
    });
}

}  // namespace cic
