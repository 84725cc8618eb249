// Who has which rows: particles are divided among ranks by rows of the mesh, or by strips of rows, and divided
// anew when one has too many. What goes over the borders in a step is in exchange_rows.hpp.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "implicit_moment/particles.hpp"
#include "implicit_moment/ranks/exchange_rows.hpp"

namespace implicit_moment {

/// Gives the particles of one species to the ranks that are to have their rows, quantity after quantity.
/// in:     per_piece, cells or nodes of a piece
/// in/out: particles, sorted by cell; those of a cell come in the order of the ranks that had them
inline void hand_over(const Division& after, long per_piece, Particles& particles) {
    const std::vector<int> first = particles.first_of_node;
    const long cells = std::ssize(first) - 1;
    const auto cell_of = [&](long piece) { return std::min(cells, piece * per_piece); };
    const long begin = cell_of(after.begin()), end = cell_of(after.end(after.first.back()));
    std::vector<int> peers(common::rank_count());
    std::iota(peers.begin(), peers.end(), 0);
    std::vector<std::vector<double>> to(peers.size()), counts, from;
    for (const int k : peers)
        for (long cell = cell_of(after.first[k]); cell < cell_of(after.first[k + 1]); ++cell)
            to[k].push_back(first[cell + 1] - first[cell]);
    common::exchange(peers, to, counts);
    std::vector<int>& next = particles.first_of_node;
    next.assign(cells + 1, 0);
    for (const std::vector<double>& of_rank : counts)
        for (long cell = begin; cell < end; ++cell) next[cell] += int(of_rank[cell - begin]);
    std::exclusive_scan(next.begin(), next.end(), next.begin(), 0);

    for (std::vector<ParticleReal>* q : particles.all()) {
        for (const int k : peers)
            to[k].assign(q->begin() + first[cell_of(after.first[k])],
                         q->begin() + first[cell_of(after.first[k + 1])]);
        std::vector<ParticleReal>().swap(*q);
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
    particles.of_ranks = after;
}

/// Divides the particles among the ranks, or anew where a rank has 10 % more of them than the mean and other
/// borders take a twentieth off that.
/// in:     per_piece, cells or nodes of a piece: one row or more; least, the pieces that a rank needs
/// in/out: species, sorted; the first time, undivided, every rank has any share of them
/// out:    the most particles of a rank over the mean
inline double balance_rows(long per_piece, long least, std::vector<Particles>& species) {
    if (common::rank_count() == 1 || species.empty()) return 1;
    const Division of_ranks = species.front().of_ranks;
    const long cells = std::ssize(species.front().first_of_node) - 1;
    std::vector<long> work((cells + per_piece - 1) / per_piece, 0);
    for (long k = of_ranks.begin(); k < of_ranks.end(std::ssize(work)); ++k)
        for (const Particles& s : species)
            work[k] += s.first_of_node[std::min(cells, (k + 1) * per_piece)] -
                       s.first_of_node[k * per_piece];
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
    if (!of_ranks.is_whole() && imbalance(of_ranks) <= 1.1) return imbalance(of_ranks);
    const Division even = Division::of(work, least);
    if (!of_ranks.is_whole() && imbalance(even) > 0.95 * imbalance(of_ranks))
        return imbalance(of_ranks);
    if (even.first != of_ranks.first)
        for (Particles& s : species) hand_over(even, per_piece, s);
    return imbalance(even);
}

}  // namespace implicit_moment
