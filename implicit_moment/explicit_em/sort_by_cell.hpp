// particles: sort by cell, so that the particles that share mesh values stand next to each other in
// memory.
//
// After a step the particles that have stayed in their cell stand first in its old range; it only has
// to be moved to where it begins now, and the places behind them filled with those that have come.
// All happens in place: tiles of rows do it side by side, and each writes in its own new range alone.
//
//     old   |aaaaa..|bbb....|cccc..|        a, b, c: those that stay in a cell; . : left
//     new   |aaaaa+|bbb+++++|cccc++|        + : those that come
//
// A cell that moves up is moved after those above it, one that moves down after those below it; then
// none meets a place that is still needed. What stands in the new range of another tile is copied first.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <vector>

#include "implicit_moment/explicit_em/exchange_borders.hpp"
#include "implicit_moment/sort_particles.hpp"

namespace implicit_moment {

/// Stable counting sort of one species by the cells of its splines, row by row: the start of a run.
/// Cost: particles + cells.
/// in/out: particles, every position inside the mesh; first_of_node is rebuilt, for cells.
/// exact:  the order depends on the positions alone, not on the number of threads; particles that are
///         sorted already keep their order.
template <int l>
inline void sort_by_cell(const Grid& grid, SortScratch& scratch, Particles& particles) {
    const ParticleReal *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    sort_by_key(
        Stencil<l>::cells(grid.x) * Stencil<l>::cells(grid.z),
        [=, &grid](long p) { return cell_of<l>(grid, x_p[p], z_p[p]); }, scratch, particles);
}

/// Sorts all species. in: order, of the spline of the charge.
inline void sort_by_cell(const Grid& grid, long order, std::vector<Particles>& species) {
    SortScratch scratch;
    for (Particles& particles : species) {
        order == 1 ? sort_by_cell<1>(grid, scratch, particles)
                   : sort_by_cell<2>(grid, scratch, particles);
    }
}

namespace detail {

/// The tiles from which a particle can come to a tile, in their order: those up to two away, since the
/// last tile of a periodic mesh may have a single row.
inline std::vector<long> origins_of(long tile, long tiles) {
    std::vector<long> origins;
    for (long from = 0; from < tiles; ++from) {
        const long apart = std::abs(from - tile);
        if (apart <= 2 || apart >= tiles - 2) origins.push_back(from);
    }
    return origins;
}

/// Calls work(cell, quantities) for every particle that comes to the cells [begin, end) of a tile.
template <class Work>
inline void for_each_arrival(const Crossings& crossings, long tile, long begin, long end,
                             const Work& work) {
    for (const long from : origins_of(tile, std::ssize(crossings.tiles))) {
        const Crossings::OfTile& left = crossings.tiles[from];
        for (long k = 0; k < std::ssize(left.to_cell); ++k)
            if (begin <= left.to_cell[k] && left.to_cell[k] < end)
                work(left.to_cell[k], left.quantities[k]);
    }
}

/// Moves one quantity of those that stay in the cells [begin, end) of a tile to where the cells begin
/// now, within the new range of the tile.
/// in:     first, where cells began; below and above, what stood outside of the new range
inline void move_cells(long begin, long end, const std::vector<int>& first,
                       const Crossings& crossings, const std::vector<ParticleReal>& below,
                       const std::vector<ParticleReal>& above, ParticleReal* q) {
    const std::vector<int>&staying = crossings.staying, &next = crossings.first_next;
    // What of a cell stood in [from, to), whose numbers are at `copy`.
    const auto move = [&](long cell, const ParticleReal* copy, long from, long to) {
        const long a = std::max(long(first[cell]), from),
                   b = std::min(long(first[cell] + staying[cell]), to);
        if (a < b)
            std::memmove(q + next[cell] + (a - first[cell]), copy + (a - from),
                         std::size_t(b - a) * sizeof(ParticleReal));
    };
    const long from = next[begin], to = next[end];
    for (long cell = end - 1; cell >= begin; --cell)
        if (next[cell] > first[cell]) move(cell, q + from, from, to);
    for (long cell = begin; cell < end; ++cell)
        if (next[cell] < first[cell]) move(cell, q + from, from, to);
    const long end_below = first[begin] + std::ssize(below),
               begin_above = first[end] - std::ssize(above);
    for (long cell = begin; cell < end && first[cell] < end_below; ++cell)
        move(cell, below.data(), first[begin], end_below);
    for (long cell = end - 1; cell >= begin && first[cell + 1] > begin_above; --cell)
        move(cell, above.data(), begin_above, first[end]);
}

}  // namespace detail

/// Sorts one species after the push. Cost: particles, each read and written once.
/// in:     crossings of the push; per_tile, cells of a tile
/// in/out: particles, as the push leaves them; sorted by cell, first_of_node is rebuilt
/// exact:  the order does not depend on the number of threads; a stable sort leaves it as it is
inline void sort_by_cell(long per_tile, Crossings& crossings, Particles& particles) {
    const long cells = std::ssize(crossings.staying), tiles = std::ssize(crossings.tiles);
    std::vector<int>&first = particles.first_of_node, &next = crossings.first_next;
    const Division& of_ranks = crossings.of_ranks;
    const auto for_each_tile = [&](const auto& work) {
        common::for_each_row(of_ranks.end(tiles) - of_ranks.begin(), [&](long k) {
            const long tile = of_ranks.begin() + k;
            work(tile, tile * per_tile, std::min(cells, (tile + 1) * per_tile));
        });
    };
    exchange_crossings(per_tile, crossings);
    next.assign(std::size_t(cells + 1), 0);
    for_each_tile([&](long tile, long begin, long end) {
        std::copy_n(&crossings.staying[begin], end - begin, &next[begin]);
        detail::for_each_arrival(crossings, tile, begin, end,
                                 [&](int cell, const auto&) { ++next[cell]; });
    });
    std::exclusive_scan(next.begin(), next.end(), next.begin(), 0);

    const auto quantities = particles.all();
    const std::size_t most = std::max(first[cells], next[cells]);
    for (std::vector<ParticleReal>* q : quantities) {
        if (most > q->capacity()) q->reserve(most + most / 10);
        q->resize(most);
    }
    for_each_tile([&](long tile, long begin, long end) {
        const long end_below = std::min(first[end], next[begin]),
                   begin_above = std::max(first[begin], next[end]);
        for (std::size_t a = 0; a < quantities.size(); ++a) {
            const ParticleReal* q = quantities[a]->data();
            Crossings::OfTile& room = crossings.tiles[tile];
            room.below[a].assign(q + first[begin], q + std::max<long>(first[begin], end_below));
            room.above[a].assign(q + std::min<long>(first[end], begin_above), q + first[end]);
        }
    });
    for_each_tile([&](long tile, long begin, long end) {
        const Crossings::OfTile& room = crossings.tiles[tile];
        for (std::size_t a = 0; a < quantities.size(); ++a)
            detail::move_cells(begin, end, first, crossings, room.below[a], room.above[a],
                               quantities[a]->data());
        detail::for_each_arrival(crossings, tile, begin, end,
                                 [&](int cell, const std::array<ParticleReal, 5>& of_particle) {
                                     const long p = next[cell] + crossings.staying[cell]++;
                                     for (std::size_t a = 0; a < quantities.size(); ++a)
                                         (*quantities[a])[p] = of_particle[a];
                                 });
    });
    first.swap(next);
    for (std::vector<ParticleReal>* q : quantities) q->resize(first[cells]);
}

/// Sorts all species after the push.
inline void sort_by_cell(const Grid& grid, long order, std::vector<Crossings>& crossings,
                         std::vector<Particles>& species) {
    for (std::size_t k = 0; k < species.size(); ++k)
        sort_by_cell(cells_of_tile(grid, order), crossings[k], species[k]);
}

}  // namespace implicit_moment
