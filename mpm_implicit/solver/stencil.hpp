// Symmetric matrices whose entries couple a node to its neighbors in the same grain: one field per
// diagonal of the stencil.
//
// A node is coupled to those at most `reach` rows and columns away. The entry at a node couples it
// to the one an offset (a, b) further on, b > 0 or b = 0 and a >= 0; the other half is the
// transpose.
//
//      o   o   o        reach 1 (linear shape functions): five diagonals, o the stored ones
//      .   o   o
//      .   .   .
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "mpm_explicit/constrain_nodes.hpp"

namespace mpm_implicit {

using namespace mpm;

/// The rows of a grain: from the first to below the second.
inline std::pair<long, long> rows_of_grain(const std::vector<GridRow>& rows, int grain,
                                           const GrainNodes& nodes) {
    const long begin = nodes.dof_begin(grain), end = nodes.dof_end(grain);
    const auto dof_of = [](const GridRow& row) { return row.origin + row.first; };
    const auto first = std::partition_point(
        rows.begin(), rows.end(), [&](const GridRow& row) { return dof_of(row) < begin; });
    const auto last = std::partition_point(first, rows.end(),
                                           [&](const GridRow& row) { return dof_of(row) < end; });
    return {first - rows.begin(), last - rows.begin()};
}

/// Calls work(dof) for the dofs of a grain, row by row or column by column: along its shorter
/// side.
template <class Work>
void for_each_dof_of(const std::vector<GridRow>& rows, int grain, const GrainNodes& nodes,
                     const Work& work) {
    const auto [low, above] = rows_of_grain(rows, grain, nodes);
    long first = std::numeric_limits<long>::max(), end = -first;
    for (long r = low; r < above; ++r) {
        const GridRow& row = rows[r];
        if (row.first < row.end) first = std::min(first, row.first), end = std::max(end, row.end);
    }
    if (end - first <= above - low) {
        for (long r = low; r < above; ++r) {
            const GridRow& row = rows[r];
            for (long i = row.first; i < row.end; ++i) work(row.origin + i);
        }
    } else {
        for (long i = first; i < end; ++i) {
            for (long r = low; r < above; ++r) {
                const GridRow& row = rows[r];
                if (i >= row.first && i < row.end) work(row.origin + i);
            }
        }
    }
}

/// Calls work(i) for all dofs, or all numbers of a vector, below count.
template <class Work>
void for_each_dof(long count, const Work& work) {
    common::for_each_block(count, [&](int, long begin, long end) {
        for (long i = begin; i < end; ++i) work(i);
    });
}

template <int reach>
struct Stencil {
    static constexpr int side = 2 * reach + 1, diagonals = (side * side + 1) / 2;
    static constexpr int diagonal(int a, int b) {
        return b == 0 ? a : reach + 1 + (b - 1) * side + a + reach;
    }
};

/// Calls work(diagonal, dof, other, count, transposed) for stretches of a row's dofs and the dofs
/// that they are coupled to; transposed: the entry is stored at the other one.
template <int reach, class Work>
[[gnu::always_inline]] inline void for_each_link(const std::vector<GridRow>& rows, long number,
                                                 const Work& work) {
    const GridRow& row = rows[number];
    for (int b = 0; b <= reach; ++b) {
        for (int a = b == 0 ? 0 : -reach; a <= reach; ++a) {
            const int diagonal = Stencil<reach>::diagonal(a, b);
            const auto link = [&](long to, long shift, bool transposed) {
                const GridRow& other = rows[to];
                const long first = std::max(row.first, other.first - shift),
                           end = std::min(row.end, other.end - shift);
                if (first < end)
                    work(diagonal, row.origin + first, other.origin + first + shift, end - first,
                         transposed);
            };
            if (number + b < row.above) link(number + b, a, false);
            if (number - b >= row.lowest && (a != 0 || b != 0)) link(number - b, -a, true);
        }
    }
}

/// Entries of a symmetric matrix with blocks of `components` numbers: one field per diagonal and
/// component.
template <int reach, int components>
class SymmetricStencil {
   public:
    void clear(long size) {
        size_ = size;
        data_.resize(static_cast<std::size_t>(Stencil<reach>::diagonals * components * size));
        common::for_each_block(static_cast<long>(data_.size()), [&](int, long begin, long end) {
            std::fill(data_.begin() + begin, data_.begin() + end, 0.0);
        });
    }
    long size() const { return size_; }
    double* field(int diagonal, int component) {
        return data_.data() + (diagonal * components + component) * size_;
    }
    const double* field(int diagonal, int component) const {
        return data_.data() + (diagonal * components + component) * size_;
    }

   private:
    long size_ = 0;
    std::vector<double> data_;
};

}  // namespace mpm_implicit
