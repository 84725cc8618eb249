// Who has which rows: particles are divided among ranks by rows of the mesh, or by strips of rows, and divided
// anew when one has too many. What goes over the borders in a step is in exchange_rows.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "implicit_moment/exchange_rows.hpp"
#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// Gives the particles of one species to the ranks that are to have their rows.
/// in:     per_piece, cells or nodes of a piece
/// in/out: particles, sorted: those of the division before, then those of the one after
inline void hand_over(const Division& after, long per_piece, Particles& particles) {
    const Division& before = particles.of_ranks;
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
        return std::array<long, 2>{std::min(cells, begin * per_piece),
                                   std::min(cells, std::max(begin, end) * per_piece)};
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
    particles.of_ranks = after;
}

/// Divides the particles among the ranks, or anew where a rank has 10 % more of them than the mean and other
/// borders take a twentieth off that.
/// in:     per_piece, cells or nodes of a piece: one row or more; least, the pieces that a rank needs
/// in/out: species, sorted; the first time, every rank has all particles
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
    if (!of_ranks.is_whole()) common::sum_over_ranks(work);
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
