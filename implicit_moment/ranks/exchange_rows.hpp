// Particles divided among ranks (common/ranks.hpp) by rows of the mesh: each rank has the particles of its
// rows; all have the whole mesh. What goes over the borders where particles add to the mesh, and why the
// bytes are those of one process: of a row to which both sides of a border add, the sum so far crosses,
// color after color, so that each term is added to the number to which one process adds it; then all rows
// go to all.
//
// In one process these functions do what the loop that they stand for does, or nothing.
#pragma once

#include <algorithm>
#include <vector>

#include "common/parallel.hpp"
#include "implicit_moment/field/vector_field.hpp"
#include "implicit_moment/ranks/division.hpp"

namespace implicit_moment {

/// Rows of nodes that a rank of implicit_moment needs: to a row of the mesh then no more than two ranks add.
inline constexpr long rows_of_rank = 2;

/// Numbers of the mesh, row by row, the lower ghosts first.
struct MeshRows {
    double* f;
    long length;  // of a row

    double* row(long j) const { return f + (j + 1) * length; }
};

inline std::vector<MeshRows> rows_of_vector(const Grid& grid, VectorField& f) {
    return {{f.x(), grid.stride()}, {f.y(), grid.stride()}, {f.z(), grid.stride()}};
}

/// The rows of each rank as they are stored, the ghosts with those beside them.
inline Division stored_rows(const Grid& grid, const Division& rows) {
    if (rows.is_whole()) return {};
    Division stored = rows;
    for (long& j : stored.first) ++j;
    stored.first.front() = 0, stored.first.back() = grid.z.cells + 3;
    return stored;
}

/// Gives every rank all rows. in/out: fields, our rows filled
inline void gather_rows(const Grid& grid, const Division& rows,
                        const std::vector<MeshRows>& fields) {
    if (rows.is_whole()) return;
    std::vector<long> first = stored_rows(grid, rows).first, begin = first;
    long length = 0;  // of a row of all fields: one message is faster than many
    for (const MeshRows& field : fields) length += field.length;
    for (long& j : begin) j *= length;
    std::vector<double> message(std::size_t(begin.back()));
    const auto visit = [&](int rank, const auto& work) {
        double* next = &message[std::size_t(begin[rank])];
        for (const MeshRows& field : fields) {
            const long count = (first[rank + 1] - first[rank]) * field.length;
            work(field.f + first[rank] * field.length, next, count);
            next += count;
        }
    };
    visit(common::rank(), [](const double* f, double* to, long n) { std::copy_n(f, n, to); });
    common::gather_pieces(message.data(), begin);
    for (int k = 0; k < common::rank_count(); ++k)
        if (k != common::rank())
            visit(k, [](double* f, const double* from, long n) { std::copy_n(from, n, f); });
}

namespace detail {

// Brings the sums so far to the side of a border that has not added to them in this color.
inline void exchange_sums(const Division& rows, long color, long low, long high,
                          const std::vector<MeshRows>& sums) {
    const int me = common::rank();
    // Visits the rows of the mesh at the border before a rank to which one side of it has added.
    const auto for_each_row_from = [&](bool below, int above, const auto& work) {
        const long first = rows.first[above];
        for (long j = first + low; j < first + high; ++j) {
            for (long row = std::max(0L, j - high); row <= std::min(rows.first.back() - 1, j - low);
                 ++row)
                if (row % 3 == color && (row < first) == below)
                    for (const MeshRows& sum : sums) work(sum.row(j), sum.length);
        }
    };
    std::vector<int> peers;
    if (me > 0) peers.push_back(me - 1);
    if (me + 1 < common::rank_count()) peers.push_back(me + 1);
    std::vector<std::vector<double>> to(peers.size()), from;
    for (std::size_t k = 0; k < peers.size(); ++k)
        for_each_row_from(peers[k] > me, std::max(me, peers[k]), [&](const double* f, long count) {
            to[k].insert(to[k].end(), f, f + count);
        });
    common::exchange(peers, to, from);
    for (std::size_t k = 0; k < peers.size(); ++k) {
        const double* next = from[k].data();
        for_each_row_from(peers[k] < me, std::max(me, peers[k]), [&](double* f, long count) {
            std::copy_n(next, count, f), next += count;
        });
    }
}

}  // namespace detail

/// Calls work(row) for our rows of particles, those at the same time that are three apart.
/// in:     rows, of each rank, at least two; count, of all; low and high: a row adds to the rows of the mesh
///         from low to high away, which are two or three
/// in/out: sums, to which work adds; afterwards complete in our rows
template <class Work>
inline void deposit_rows(const Division& rows, long count, long low, long high,
                         const std::vector<MeshRows>& sums, const Work& work) {
    if (rows.is_whole()) return common::for_each_row_colored(3, count, work);
    const long begin = rows.begin(), end = rows.end(count);
    for (long color = 0; color < 3; ++color) {
        const long first = begin + (color - begin % 3 + 3) % 3;
        common::for_each_row((end - first + 2) / 3, [&](long k) { work(first + 3 * k); });
        detail::exchange_sums(rows, color, low, high, sums);
    }
}

}  // namespace implicit_moment
