// Who has which rows: the particles of explicit_em are divided among ranks, and divided anew when one has
// too many. What goes over the borders in a step is in exchange_borders.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "implicit_moment/explicit_em/exchange_borders.hpp"

namespace implicit_moment {

/// Gives the particles of one species to the ranks that are to have their tiles.
/// in/out: particles, sorted by cell: those of the division before, then those of the one after
inline void hand_over(const Division& before, const Division& after, long per_tile,
                      Particles& particles) {
    const int me = common::rank();
    const long cells = std::ssize(particles.first_of_node) - 1;
    // The cells that go from one rank to another. Before the first division every rank has all cells, and
    // keeps those that it is to have.
    const auto cells_between = [&](int from, int to) {
        const bool whole = before.is_whole();
        const long begin = std::max(whole ? 0 : before.first[from], after.first[to]),
                   end = std::min(whole && from == to ? cells
                                  : whole             ? 0
                                                      : before.first[from + 1],
                                  after.first[to + 1]);
        return std::array<long, 2>{std::min(cells, begin * per_tile),
                                   std::min(cells, std::max(begin, end) * per_tile)};
    };
    const std::vector<int>& first = particles.first_of_node;
    std::vector<int> peers;
    std::vector<std::vector<double>> to, from;
    for (int k = 0; k < common::rank_count(); ++k) {
        peers.push_back(k), to.emplace_back();
        const auto [begin, end] = cells_between(me, k);
        for (long cell = begin; cell < end; ++cell) to[k].push_back(first[cell + 1] - first[cell]);
        for (const std::vector<double>* q : particles.all())
            to[k].insert(to[k].end(), q->begin() + first[begin], q->begin() + first[end]);
    }
    common::exchange(peers, to, from);

    for (std::vector<double>* q : particles.all()) std::vector<double>().swap(*q);
    particles.first_of_node.assign(cells + 1, 0);
    for (int k = 0; k < common::rank_count(); ++k) {
        const auto [begin, end] = cells_between(k, me);
        const long count = (std::ssize(from[k]) - (end - begin)) / 5;
        const double* next = from[k].data();
        for (long cell = begin; cell < end; ++cell) particles.first_of_node[cell] = int(*next++);
        for (std::vector<double>* q : particles.all())
            q->insert(q->end(), next, next + count), next += count;
    }
    std::exclusive_scan(particles.first_of_node.begin(), particles.first_of_node.end(),
                        particles.first_of_node.begin(), 0);
}

/// Divides the particles among the ranks, or anew where a rank has 10 % more of them than the mean and other
/// borders take a twentieth off that.
/// in/out: tiles and species; the first time, every rank has all particles
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
    if (!tiles.is_whole()) common::sum_over_ranks(work);
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
    if (!tiles.is_whole() && imbalance(even) > 0.95 * imbalance(tiles)) return imbalance(tiles);
    if (even.first != tiles.first)
        for (Particles& s : species) hand_over(tiles, even, per_tile, s);
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
