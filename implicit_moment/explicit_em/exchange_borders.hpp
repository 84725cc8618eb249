// The particles of explicit_em divided among ranks (common/ranks.hpp): each has whole tiles of rows of
// cells and what is in them; all have the whole mesh. What goes over the borders, and why the bytes are
// those of one process (of the sums of charge and current at t^n: exchange_rows.hpp):
//
//     J          rows of the tiles beside a border; who has a row of the mesh adds them tile by tile,
//                species by species, as one process does; then all rows go to all
//     particles  those that cross, in the order of the tiles that they leave: the order in which
//                sort_by_cell takes them from there
//
// In one process these functions return at once.
#pragma once

#include <algorithm>
#include <vector>

#include "common/ranks.hpp"
#include "implicit_moment/explicit_em/crossings.hpp"
#include "implicit_moment/explicit_em/deposit_current.hpp"
#include "implicit_moment/ranks/exchange_rows.hpp"

namespace implicit_moment {

/// The rows of cells of each rank, of its tiles.
inline Division rows_of(const Division& tiles, long rows) {
    Division division = tiles;
    for (long& first : division.first) first = std::min(rows, first * rows_of_tile);
    return division;
}

namespace detail {

/// Whether a tile of another rank is up to two away from one of ours: what leaves it comes to no others.
inline bool is_near(const Division& tiles, long tile) {
    const long count = tiles.first.back(), begin = tiles.begin(), end = tiles.end(count);
    const long least = tile < begin ? begin - tile : tile - end + 1,
               most = tile < begin ? end - 1 - tile : tile - begin;
    return (tile < begin || tile >= end) && (least <= 2 || most >= count - 2);
}

/// The ranks that have such tiles; we have such tiles of theirs.
inline std::vector<int> neighbors_of(const Division& tiles) {
    std::vector<int> neighbors;
    for (int k = 0; k < common::rank_count(); ++k) {
        bool near = false;
        for (long tile = tiles.first[k]; tile < tiles.first[k + 1]; ++tile)
            near = near || is_near(tiles, tile);
        if (near) neighbors.push_back(k);
    }
    return neighbors;
}

}  // namespace detail

/// Brings the rows of tiles that belong to rows of other ranks there.
/// in:     rows, of cells
/// in/out: of_tile, ours filled; those of others get what they add to our rows, or no rows
inline void exchange_current(const Grid& grid, const Division& tiles, long rows,
                             std::vector<CurrentTile>& of_tile) {
    if (tiles.is_whole()) return;
    for (long k = 0; k < std::ssize(of_tile); ++k) {
        const long first = k * rows_of_tile;
        if (tiles.owner(k) == common::rank()) continue;
        if (detail::is_near(tiles, k))
            of_tile[k].clear(grid, first, std::min(rows, first + rows_of_tile));
        else
            of_tile[k].rows = 0;
    }
    // Visits the rows of the tiles of one rank that belong to another.
    const auto for_each_row_between = [&](int from, int to, const auto& work) {
        for (long k = tiles.first[from]; k < tiles.first[from + 1]; ++k) {
            CurrentTile& tile = of_tile[k];
            for (long row = tile.first_row; row < tile.first_row + tile.rows; ++row) {
                const long j = CurrentTile::image(grid.z, row), last = tiles.first.back() - 1;
                if (tiles.owner(std::clamp(j / rows_of_tile, 0L, last)) != to) continue;
                for (auto* J : {&tile.J_x, &tile.J_y, &tile.J_z})
                    work(J->data() + tile.index(-CurrentTile::margin, row), tile.columns);
            }
        }
    };
    const std::vector<int> peers = detail::neighbors_of(tiles);
    std::vector<std::vector<double>> to(peers.size()), from;
    for (std::size_t k = 0; k < peers.size(); ++k)
        for_each_row_between(common::rank(), peers[k], [&](const double* row, long count) {
            to[k].insert(to[k].end(), row, row + count);
        });
    common::exchange(peers, to, from);
    for (std::size_t k = 0; k < peers.size(); ++k) {
        const double* next = from[k].data();
        for_each_row_between(peers[k], common::rank(), [&](double* row, long count) {
            std::copy_n(next, count, row), next += count;
        });
    }
}

/// Brings the particles that cross to those who have the cells to which they come.
/// in/out: crossings of our tiles; those of others get what comes to us
inline void exchange_crossings(long per_tile, Crossings& crossings) {
    const Division& tiles = crossings.of_ranks;
    if (tiles.is_whole()) return;
    constexpr long size = 7;  // tile, cell and five quantities
    const std::vector<int> peers = detail::neighbors_of(tiles);
    std::vector<std::vector<double>> to(peers.size()), from;
    for (long tile = tiles.begin(); tile < tiles.end(tiles.first.back()); ++tile) {
        const Crossings::OfTile& left = crossings.tiles[tile];
        for (std::size_t p = 0; p < left.to_cell.size(); ++p) {
            const int owner = tiles.owner(left.to_cell[p] / per_tile);
            if (owner == common::rank()) continue;
            auto& message = to[std::ranges::find(peers, owner) - peers.begin()];
            message.insert(message.end(), {double(tile), double(left.to_cell[p])});
            message.insert(message.end(), left.quantities[p].begin(), left.quantities[p].end());
        }
    }
    common::exchange(peers, to, from);
    for (const std::vector<double>& message : from) {
        for (const double* p = message.data(); p < message.data() + message.size(); p += size) {
            Crossings::OfTile& left = crossings.tiles[long(p[0])];
            left.to_cell.push_back(int(p[1]));
            left.quantities.push_back({ParticleReal(p[2]), ParticleReal(p[3]), ParticleReal(p[4]),
                                       ParticleReal(p[5]), ParticleReal(p[6])});
        }
    }
}

}  // namespace implicit_moment
