// A stable counting sort for structures of arrays: first the new place of every element by its key,
// then one column after the other is carried there.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "common/parallel.hpp"

namespace common {

/// Room for one permutation, kept between sorts.
template <class Number>
struct SortScratch {
    std::vector<int> target;              // first the key of each element, then its new place
    std::vector<Number> column;           // one sorted quantity
    std::vector<std::vector<int>> place;  // [block][key - lowest of the block] next free place
    std::vector<int> next;                // [key] next free place of all
};

/// The new place of every element. Cost: elements + keys; a block that meets few keys costs less.
/// in:     key_of(p) in [0, keys)
/// out:    scratch.target; first_of_key, if wanted: key k has [first_of_key[k],
///         first_of_key[k + 1])
/// exact:  elements with the same key keep their order; it does not depend on the number of threads
template <class Number, class Key>
void counting_sort(long count, long keys, const Key& key_of, SortScratch<Number>& scratch,
                   std::vector<int>* first_of_key = nullptr) {
    scratch.target.resize(std::size_t(count));
    scratch.place.resize(block_count);
    scratch.next.assign(std::size_t(keys), 0);
    std::array<int, block_count> lowest{};

    // Count the elements of each key, block by block.
    int* target = scratch.target.data();
    for_each_block(count, [&](int block, long begin, long end) {
        int low = begin < end ? int(keys) : 0, high = -1;
        for (long p = begin; p < end; ++p) {
            target[p] = key_of(p);
            low = std::min(low, target[p]);
            high = std::max(high, target[p]);
        }
        lowest[std::size_t(block)] = low;
        auto& place = scratch.place[std::size_t(block)];
        place.assign(std::size_t(high + 1 - low), 0);
        for (long p = begin; p < end; ++p) ++place[std::size_t(target[p] - low)];
    });

    // Give every key its range and every block its share of that range.
    int* next = scratch.next.data();
    const auto for_each_share = [&](const auto& work) {
        for (std::size_t block = 0; block < block_count; ++block) {
            int *const place = scratch.place[block].data(), *const next_here = next + lowest[block];
            const long size = std::ssize(scratch.place[block]);
#pragma omp simd
            for (long k = 0; k < size; ++k) work(next_here[k], place[k]);
        }
    };
    for_each_share([](int& next_of_key, int here) { next_of_key += here; });
    std::exclusive_scan(next, next + keys, next, 0);
    if (first_of_key != nullptr) {
        first_of_key->assign(next, next + keys);
        first_of_key->push_back(int(count));
    }
    for_each_share([](int& next_of_key, int& place) {
        const int here = place;
        place = next_of_key;
        next_of_key += here;
    });

    for_each_block(count, [&](int block, long begin, long end) {
        int* place = scratch.place[std::size_t(block)].data();
        const int low = lowest[std::size_t(block)];
        for (long p = begin; p < end; ++p) target[p] = place[target[p] - low]++;
    });
}

/// Carries one quantity to the places that counting_sort found, through a column of its own type.
template <class Number>
void carry_to_place(std::vector<Number>& quantity, const std::vector<int>& target,
                    std::vector<Number>& column) {
    column.resize(quantity.size());
    const Number* from = quantity.data();
    Number* to = column.data();
    const int* place = target.data();
    for_each_block(long(quantity.size()), [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) to[place[p]] = from[p];
    });
    quantity.swap(column);
}

}  // namespace common
