// Symmetric matrices whose entries couple a node to its neighbors in the same grain: one field per
// diagonal of the stencil.
//
// A node is coupled to those at most `reach` rows and columns away. The entry at a node couples it to
// the one an offset (a, b) further on, b > 0 or b = 0 and a >= 0; the other half is the transpose.
//
//      o   o   o        reach 1 (linear shape functions): five diagonals, o the stored ones
//      .   o   o
//      .   .   .
#pragma once

#include "mpm_implicit/constrain_nodes.hpp"

namespace mpm_implicit {

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
    const GridRow& row = rows[static_cast<std::size_t>(number)];
    for (int b = 0; b <= reach; ++b) {
        for (int a = b == 0 ? 0 : -reach; a <= reach; ++a) {
            const int diagonal = Stencil<reach>::diagonal(a, b);
            const auto link = [&](long to, long shift, bool transposed) {
                const GridRow& other = rows[static_cast<std::size_t>(to)];
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
