// A stable counting sort for structures of arrays: first the new place of every element by its key,
// then one column after the other is carried there.
#pragma once

#include <array>
#include <vector>

#include "common/parallel.hpp"

namespace common {

/// Room for one permutation, kept between sorts.
template <class Number>
struct SortScratch {
    std::vector<int> target;              // first the key of each element, then its new place
    std::vector<Number> column;           // one sorted quantity
    std::vector<std::vector<int>> place;  // [block][key] next free place
};

/// The new place of every element. Cost: elements + keys.
/// in:     key_of(p) in [0, keys)
/// out:    scratch.target; first_of_key, if wanted: key k has [first_of_key[k],
///         first_of_key[k + 1])
/// exact:  elements with the same key keep their order; it does not depend on the number of threads
template <class Number, class Key>
void counting_sort(long count, long keys, const Key& key_of, SortScratch<Number>& scratch,
                   std::vector<int>* first_of_key = nullptr) {
    scratch.target.resize(static_cast<std::size_t>(count));
    scratch.place.resize(block_count);

    // Count the elements of each key, block by block.
    int* target = scratch.target.data();
    for_each_block(count, [&](int block, long begin, long end) {
        auto& place = scratch.place[static_cast<std::size_t>(block)];
        place.assign(static_cast<std::size_t>(keys), 0);
        for (long p = begin; p < end; ++p) target[p] = key_of(p);
        for (long p = begin; p < end; ++p) ++place[static_cast<std::size_t>(target[p])];
    });

    // Give every key its range and every block its share of that range: first the sums over
    // stretches of keys, then the stretches themselves, side by side.
    std::array<int, block_count + 1> first_of_stretch{};
    for_each_block(
        keys,
        [&](int stretch, long begin, long end) {
            int sum = 0;
            for (const auto& place : scratch.place)
                for (long key = begin; key < end; ++key) sum += place[std::size_t(key)];
            first_of_stretch[std::size_t(stretch) + 1] = sum;
        },
        block_count * keys);
    for (std::size_t k = 0; k < block_count; ++k) first_of_stretch[k + 1] += first_of_stretch[k];
    if (first_of_key != nullptr) {
        first_of_key->resize(static_cast<std::size_t>(keys) + 1);
        first_of_key->back() = first_of_stretch.back();
    }
    for_each_block(
        keys,
        [&](int stretch, long begin, long end) {
            int next = first_of_stretch[std::size_t(stretch)];
            for (auto key = std::size_t(begin); key < std::size_t(end); ++key) {
                if (first_of_key != nullptr) (*first_of_key)[key] = next;
                for (auto& place : scratch.place) {
                    const int here = place[key];
                    place[key] = next;
                    next += here;
                }
            }
        },
        block_count * keys);

    for_each_block(count, [&](int block, long begin, long end) {
        int* place = scratch.place[static_cast<std::size_t>(block)].data();
        for (long p = begin; p < end; ++p) target[p] = place[target[p]]++;
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
    for_each_block(static_cast<long>(quantity.size()), [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) to[place[p]] = from[p];
    });
    quantity.swap(column);
}
/// The same through the column of the scratch, for quantities of its type.
template <class Number>
void carry_to_place(std::vector<Number>& quantity, SortScratch<Number>& scratch) {
    carry_to_place(quantity, scratch.target, scratch.column);
}

}  // namespace common
