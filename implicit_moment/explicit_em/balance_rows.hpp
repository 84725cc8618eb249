// Who has which rows: the particles of explicit_em are divided among ranks, and divided anew when one has
// too many. What goes over the borders in a step is in exchange_borders.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "implicit_moment/explicit_em/exchange_borders.hpp"

namespace implicit_moment {

/// Gives the particles of one species to the ranks that are to have their tiles, quantity after quantity.
/// in/out: particles, sorted by cell; those of a cell come in the order of the ranks that had them
inline void hand_over(const Division& tiles, long per_tile, Particles& particles) {
    const std::vector<int> first = particles.first_of_node;
    const long cells = std::ssize(first) - 1;
    const auto cell_of = [&](long tile) { return std::min(cells, tile * per_tile); };
    const long begin = cell_of(tiles.begin()), end = cell_of(tiles.end(tiles.first.back()));
    std::vector<int> peers(common::rank_count());
    std::iota(peers.begin(), peers.end(), 0);
    std::vector<std::vector<double>> to(peers.size()), counts, from;
    for (const int k : peers)
        for (long cell = cell_of(tiles.first[k]); cell < cell_of(tiles.first[k + 1]); ++cell)
            to[k].push_back(first[cell + 1] - first[cell]);
    common::exchange(peers, to, counts);
    std::vector<int>& next = particles.first_of_node;
    next.assign(cells + 1, 0);
    for (const std::vector<double>& of_rank : counts)
        for (long cell = begin; cell < end; ++cell) next[cell] += int(of_rank[cell - begin]);
    std::exclusive_scan(next.begin(), next.end(), next.begin(), 0);

    for (std::vector<double>* q : particles.all()) {
        for (const int k : peers)
            to[k].assign(q->begin() + first[cell_of(tiles.first[k])],
                         q->begin() + first[cell_of(tiles.first[k + 1])]);
        std::vector<double>().swap(*q);
        common::exchange(peers, to, from);
        q->reserve(next[cells]);
        std::vector<long> taken(peers.size(), 0);
        for (long cell = begin; cell < end; ++cell) {
            for (const int k : peers) {
                const double* numbers = from[k].data() + taken[k];
                const long count = long(counts[k][cell - begin]);
                q->insert(q->end(), numbers, numbers + count), taken[k] += count;
            }
        }
    }
}

/// Divides the particles among the ranks, or anew where a rank has 10 % more of them than the mean.
/// in/out: tiles and species, sorted by cell; the first time, with no tiles, every rank has any share of them
/// out:    the most particles of a rank over the mean
template <int l>
inline double balance_rows(const Grid& grid, Division& tiles, std::vector<Particles>& species) {
    if (common::rank_count() == 1) return 1;
    const long per_tile = cells_of_tile<l>(grid), rows = Stencil<l>::cells(grid.z),
               cells = rows * Stencil<l>::cells(grid.x);
    std::vector<long> work(tiles_of(rows), 0);
    for (long k = tiles.begin(); k < tiles.end(std::ssize(work)); ++k)
        for (const Particles& s : species)
            work[k] += s.first_of_node[std::min(cells, (k + 1) * per_tile)] -
                       s.first_of_node[k * per_tile];
    common::sum_over_ranks(work);
    const auto imbalance = [&](const Division& division) {
        double most = 0, all = 0;
        for (int k = 0; k < common::rank_count(); ++k) {
            const double of_rank = double(std::accumulate(
                work.begin() + division.first[k], work.begin() + division.first[k + 1], 0L));
            most = std::max(most, of_rank), all += of_rank;
        }
        return all > 0 ? most * common::rank_count() / all : 1;
    };
    if (!tiles.is_whole() && imbalance(tiles) <= 1.1) return imbalance(tiles);
    const Division even = Division::of(work);
    if (even.first != tiles.first)
        for (Particles& s : species) hand_over(even, per_tile, s);
    tiles = even;
    return imbalance(tiles);
}

/// The same for either order of the splines.
inline double balance_rows(const Grid& grid, long order, Division& tiles,
                           std::vector<Particles>& species) {
    return order == 1 ? balance_rows<1>(grid, tiles, species)
                      : balance_rows<2>(grid, tiles, species);
}

}  // namespace implicit_moment
