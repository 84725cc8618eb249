// particles: sort by nearest node, so that the particles that share a stencil stand next to each
// other in memory.
#pragma once

#include <array>
#include <numeric>
#include <vector>

#include "common/counting_sort.hpp"
#include "common/ranks.hpp"
#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// Shared by all species and kept between steps.
using SortScratch = common::SortScratch<ParticleReal>;

/// Stable counting sort of all that a particle carries. Cost: particles + keys.
/// in:     key(p), the key of particle p, in [0, keys).
/// out:    particles in the order of their keys; first_of_node, where each key begins.
template <class Key>
inline void sort_by_key(long keys, const Key& key, SortScratch& scratch, Particles& particles) {
    common::counting_sort(particles.count(), keys, key, scratch, &particles.first_of_node);
    for (auto* quantity : particles.all())
        common::carry_to_place(*quantity, scratch.target, scratch.column);
}

namespace detail {

// The nearest node of a position inside the mesh.
struct NearestNode {
    double x_low, z_low, per_dx, per_dz;
    int row_length;

    explicit NearestNode(const Grid& grid)
        : x_low(grid.x.low),
          z_low(grid.z.low),
          per_dx(1 / grid.x.spacing()),
          per_dz(1 / grid.z.spacing()),
          row_length(int(nodes_x(grid))) {}
    int row(double z) const { return int((z - z_low) * per_dz + 0.5); }
    int operator()(double x, double z) const {
        return row(z) * row_length + int((x - x_low) * per_dx + 0.5);
    }
};

// Sorts where particles may have come to rows of other ranks: those go there, and stand where one process
// would put them, behind those of the ranks before and in front of those of the ranks behind.
inline void sort_among_ranks(const NearestNode& node_at, SortScratch& scratch,
                             Particles& particles) {
    const auto quantities = particles.all();
    const ParticleReal *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    const Division& of_ranks = particles.of_ranks;
    const long count = particles.count(), rows = of_ranks.first.back();
    const auto is_ours = [begin = of_ranks.begin(), end = of_ranks.end(rows)](long row) {
        return begin <= row && row < end;
    };
    std::array<std::vector<long>, common::block_count> leaving;
    common::for_each_block(count, [&](int block, long from, long to) {
        for (long p = from; p < to; ++p)
            if (!is_ours(node_at.row(z_p[p]))) leaving[std::size_t(block)].push_back(p);
    });
    std::vector<int> peers(common::rank_count());
    std::iota(peers.begin(), peers.end(), 0);
    std::vector<std::vector<double>> to(peers.size()), from;
    for (const std::vector<long>& of_block : leaving) {
        for (const long p : of_block) {
            auto& message = to[std::size_t(of_ranks.owner(node_at.row(z_p[p])))];
            for (const std::vector<ParticleReal>* q : quantities) message.push_back((*q)[p]);
        }
    }
    common::exchange(peers, to, from);

    // One list for the sort: particles from the ranks before, our own, particles from the ranks behind. Our own that
    // leave get a key behind those of all nodes, and are cut off.
    std::vector<double> coming;
    long before = 0;
    for (int k = 0; k < common::rank_count(); ++k) {
        coming.insert(coming.end(), from[k].begin(), from[k].end());
        if (k < common::rank()) before = std::ssize(coming) / 5;
    }
    const long arrivals = std::ssize(coming) / 5, nodes = rows * node_at.row_length;
    common::counting_sort(
        count + arrivals, nodes + 1,
        [=, coming = coming.data()](long n) {
            const long p = n - before;
            if (p >= 0 && p < count)
                return is_ours(node_at.row(z_p[p])) ? node_at(x_p[p], z_p[p]) : int(nodes);
            const double* a = coming + 5 * (p < 0 ? n : n - count);
            return node_at(a[0], a[1]);
        },
        scratch, &particles.first_of_node);
    particles.first_of_node.pop_back();
    const int* place = scratch.target.data();
    for (std::size_t a = 0; a < quantities.size(); ++a) {
        scratch.column.resize(scratch.target.size());
        const ParticleReal* ours = quantities[a]->data();
        ParticleReal* sorted = scratch.column.data();
        common::for_each_block(count, [&](int, long begin, long end) {
            for (long p = begin; p < end; ++p) sorted[place[before + p]] = ours[p];
        });
        for (long n = 0; n < arrivals; ++n)
            sorted[place[n < before ? n : n + count]] = ParticleReal(coming[5 * n + a]);
        quantities[a]->swap(scratch.column);
        quantities[a]->resize(std::size_t(particles.first_of_node.back()));
    }
}

}  // namespace detail

/// Sorts one species by nearest node, row by row.
/// in/out: particles, every position inside the mesh; first_of_node is rebuilt.
/// exact:  the order depends on the positions alone, not on the number of threads or ranks.
inline void sort_particles(const Grid& grid, SortScratch& scratch, Particles& particles) {
    const detail::NearestNode node_at(grid);
    if (!particles.of_ranks.is_whole())
        return detail::sort_among_ranks(node_at, scratch, particles);
    const ParticleReal *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    sort_by_key(
        nodes_x(grid) * nodes_z(grid), [=](long p) { return node_at(x_p[p], z_p[p]); }, scratch,
        particles);
}

/// Sorts all species.
inline void sort_particles(const Grid& grid, SortScratch& scratch,
                           std::vector<Particles>& species) {
    for (Particles& particles : species) sort_particles(grid, scratch, particles);
}

}  // namespace implicit_moment
