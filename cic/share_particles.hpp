// The particles of cic divided among ranks (common/ranks.hpp). The sums over particles are those of
// block_count blocks of the list of a species, added in their order; so a rank has some of these
// blocks, and with them a range of that list. All have the whole mesh. What goes from rank to rank:
//
//     charge     the sum over blocks so far, from each rank to the next; in the end to all
//     energy     the sums of all blocks, to all
//     particles  those whose place in the list is now another rank's: where a sort has given them
//                one, or where a wall has taken others out of the list
//
// So all ranks have equally many particles, to one block, whatever the plasma does. In one process
// share_runs returns at once.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "cic/particles.hpp"

namespace cic {

/// Gives every rank its part of the list of all particles. In that list particles are sorted by key, and
/// those of one key stand in the order of the ranks that have had them.
/// in:     first, where the runs of this rank begin, one for each key and one more for the end
/// in/out: particles
inline void share_runs(const std::vector<int>& first, Particles& particles) {
    const int ranks = common::rank_count(), me = common::rank();
    if (ranks == 1) return;
    const std::size_t keys = first.size() - 1;
    std::vector<double> lengths;
    for (std::size_t key = 0; key < keys; ++key) lengths.push_back(first[key + 1] - first[key]);
    lengths = gather_with_all(lengths);  // [rank][key]
    const long all = long(std::accumulate(lengths.begin(), lengths.end(), 0.0));

    // Run after run of the list of all: how much of it comes here; and where what goes to a rank begins.
    std::vector<long> comes, from_rank(ranks, 0), goes(ranks + 1, 0);
    long begin = 0;
    for (std::size_t key = 0; key < keys; ++key)
        for (int k = 0; k < ranks; ++k) {
            const long end = begin + long(lengths[k * keys + key]);
            const auto part_of = [&](int rank) {
                return std::max(0L, std::min(end, begin_of_rank(all, rank + 1)) -
                                        std::max(begin, begin_of_rank(all, rank)));
            };
            comes.push_back(part_of(me));
            from_rank[k] += comes.back();
            for (int to = 0; to < ranks && k == me; ++to) goes[to + 1] += part_of(to);
            begin = end;
        }
    std::partial_sum(goes.begin(), goes.end(), goes.begin());
    particles.among_ranks = all;
    std::vector<int> peers;
    for (int k = 0; k < ranks; ++k)
        if (k != me && (from_rank[k] > 0 || goes[k + 1] > goes[k])) peers.push_back(k);
    if (peers.empty()) return;

    for (std::vector<Real>* q : particles.all()) {
        std::vector<std::vector<double>> to(peers.size()), from, of_rank(ranks);
        for (std::size_t k = 0; k < peers.size() && !q->empty(); ++k)
            to[k].assign(q->begin() + goes[peers[k]], q->begin() + goes[peers[k] + 1]);
        common::exchange(peers, to, from);
        // A component that the species lacks is empty here, and nobody sends it.
        std::size_t size = q->empty() ? 0 : goes[me + 1] - goes[me];
        for (std::size_t k = 0; k < peers.size(); ++k)
            size += from[k].size(), of_rank[peers[k]].swap(from[k]);
        if (keys == 1 && size > 0) {  // what stays is in the middle
            q->resize(goes[me + 1]);
            q->erase(q->begin(), q->begin() + goes[me]);
            for (int k = me - 1; k >= 0; --k)
                q->insert(q->begin(), of_rank[k].begin(), of_rank[k].end());
            for (int k = me + 1; k < ranks; ++k)
                q->insert(q->end(), of_rank[k].begin(), of_rank[k].end());
            continue;
        }
        if (!q->empty()) of_rank[me].assign(q->begin() + goes[me], q->begin() + goes[me + 1]);
        std::vector<const double*> next;
        for (const std::vector<double>& list : of_rank) next.push_back(list.data());
        q->resize(size);
        auto place = q->begin();
        for (std::size_t n = 0; n < comes.size() && size > 0; ++n) {
            const double*& here = next[n % ranks];
            place = std::copy_n(here, comes[n], place);
            here += comes[n];
        }
    }
}

/// The same for lists that follow each other in the order of the ranks.
inline void share(Particles& particles) { share_runs({0, int(particles.count())}, particles); }

/// Takes particles out of the list of all; the last ones fill the gaps, the very last one the last
/// gap. Every rank sees as many of the last ones as there are gaps.
/// in:     indices, of those of this rank, in order
/// in/out: particles, each rank's range; afterwards lists that follow each other
inline void remove_among_ranks(const std::vector<long>& indices, Particles& particles) {
    const long begin = begin_of_rank(particles.among_ranks, common::rank());
    std::vector<double> gaps;
    for (const long p : indices) gaps.push_back(double(begin + p));
    gaps = gather_with_all(gaps);
    const long left = particles.among_ranks - std::ssize(gaps),
               kept = std::clamp(left - begin, 0L, particles.count());
    constexpr long width = std::tuple_size_v<decltype(particles.all())>;
    std::vector<double> last;
    for (long p = kept; p < particles.count(); ++p)
        for (const std::vector<Real>* q : particles.all())
            last.push_back(q->empty() ? 0 : double((*q)[p]));
    last = gather_with_all(last);

    for (auto gap = gaps.rbegin(); gap != gaps.rend(); ++gap) {
        const long place = long(*gap), p = place - begin, from = std::ssize(last) - width;
        for (long a = 0; a < width; ++a) {
            std::vector<Real>& q = *particles.all()[a];
            if (place >= left) last[(place - left) * width + a] = last[from + a];
            if (p >= 0 && p < kept && !q.empty()) q[p] = Real(last[from + a]);
        }
        last.resize(from);
    }
    for (std::vector<Real>* q : particles.all())
        if (!q->empty()) q->resize(kept);
    particles.among_ranks = left;
}

}  // namespace cic
