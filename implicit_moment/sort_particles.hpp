// particles: sort by nearest node, so that the particles that share a stencil stand next to each
// other in memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// Room for one permutation, shared by all species and kept between steps.
struct SortScratch {
    std::vector<int> target;              // first the node of each particle, then its new place
    std::vector<double> column;           // one sorted quantity
    std::vector<std::vector<int>> place;  // [block][node] next free place
};

/// Stable counting sort of the particles by nearest node, row by row. Cost: particles + nodes.
/// in/out: particles, every position inside the mesh; first_of_node is rebuilt.
/// exact:  the order depends on the positions alone, not on the number of threads.
inline void sort_particles(const Grid& grid, SortScratch& scratch, Particles& particles) {
    const long count = particles.count(), nodes = nodes_x(grid) * nodes_z(grid);
    scratch.target.resize(static_cast<std::size_t>(count));
    scratch.column.resize(static_cast<std::size_t>(count));
    scratch.place.resize(common::block_count);

    // Count the particles of each node, block by block.
    const double x_low = grid.x.low, z_low = grid.z.low;
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const int row_length = static_cast<int>(nodes_x(grid));
    const double *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    int* target = scratch.target.data();
    common::for_each_block(count, [&](int block, long begin, long end) {
        auto& place = scratch.place[static_cast<std::size_t>(block)];
        place.assign(static_cast<std::size_t>(nodes), 0);
        for (long p = begin; p < end; ++p) {
            const int i = static_cast<int>((x_p[p] - x_low) * per_dx + 0.5);
            const int j = static_cast<int>((z_p[p] - z_low) * per_dz + 0.5);
            target[p] = j * row_length + i;
        }
        for (long p = begin; p < end; ++p) ++place[static_cast<std::size_t>(target[p])];
    });

    // Give every node its range and every block its share of that range.
    particles.first_of_node.resize(static_cast<std::size_t>(nodes) + 1);
    int next = 0;
    for (std::size_t node = 0; node < static_cast<std::size_t>(nodes); ++node) {
        particles.first_of_node[node] = next;
        for (auto& place : scratch.place) {
            const int here = place[node];
            place[node] = next;
            next += here;
        }
    }
    particles.first_of_node[static_cast<std::size_t>(nodes)] = next;

    common::for_each_block(count, [&](int block, long begin, long end) {
        int* place = scratch.place[static_cast<std::size_t>(block)].data();
        for (long p = begin; p < end; ++p) target[p] = place[target[p]]++;
    });

    // Carry every quantity to its new place.
    for (auto* quantity :
         {&particles.x_p, &particles.z_p, &particles.vx_p, &particles.vy_p, &particles.vz_p}) {
        const double* from = quantity->data();
        double* to = scratch.column.data();
        common::for_each_block(count, [&](int, long begin, long end) {
            for (long p = begin; p < end; ++p) to[target[p]] = from[p];
        });
        quantity->swap(scratch.column);
    }
}

/// Sorts all species.
inline void sort_particles(const Grid& grid, SortScratch& scratch,
                           std::vector<Particles>& species) {
    for (Particles& particles : species) sort_particles(grid, scratch, particles);
}

}  // namespace implicit_moment
