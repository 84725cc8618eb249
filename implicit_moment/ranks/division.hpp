// Which rows of the mesh, or tiles of them, each rank has (common/ranks.hpp).
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "common/ranks.hpp"

namespace implicit_moment {

/// Which pieces of a row of pieces each rank has: neighbors.
struct Division {
    std::vector<long> first;  // [rank], one more for the end; empty: every process has all pieces

    bool is_whole() const { return !common::has_ranks || first.empty(); }
    long begin() const { return is_whole() ? 0 : first[common::rank()]; }
    long end(long pieces) const { return is_whole() ? pieces : first[common::rank() + 1]; }
    int owner(long piece) const {
        int k = 0;
        while (piece >= first[k + 1]) ++k;
        return k;
    }

    /// Cuts such that the rank with the most work has as little as it can (few = 1; else about as little).
    /// in: the work of each piece; how many pieces every rank gets at least, which must be there
    static Division of(std::span<const long> work, long few = 1,
                       long ranks = common::rank_count()) {
        const long pieces = std::ssize(work);
        // Rank after rank is filled to a bound; the last one takes what is left.
        long most = 0;
        const auto fill = [&](long bound) {
            Division division{{0}};
            long sum = most = 0;
            for (long piece = 0; piece < pieces; ++piece) {
                const long ranks_left = ranks - std::ssize(division.first);
                const bool full = sum + work[piece] > bound || pieces - piece <= few * ranks_left;
                if (full && piece >= few + division.first.back() && ranks_left > 0)
                    division.first.push_back(piece), sum = 0;
                most = std::max(most, sum += work[piece]);
            }
            division.first.push_back(pieces);
            return division;
        };
        long low = std::ranges::max(work), high = std::reduce(work.begin(), work.end());
        while (low < high) {
            const long bound = low + (high - low) / 2;
            fill(bound);
            most <= bound ? high = bound : low = bound + 1;
        }
        return fill(low);
    }
};

/// The sum of the numbers of the ranks before this one.
inline long sum_before_rank(long number) {
    std::vector<long> of_rank(common::rank_count(), 0);
    of_rank[common::rank()] = number;
    common::sum_over_ranks(of_rank);
    return std::accumulate(of_rank.begin(), of_rank.begin() + common::rank(), 0L);
}

}  // namespace implicit_moment
