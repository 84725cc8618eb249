// particles: sort by nearest node, so that the particles that share a stencil stand next to each
// other in memory.
#pragma once

#include <vector>

#include "common/counting_sort.hpp"
#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// Shared by all species and kept between steps.
using SortScratch = common::SortScratch<double>;

/// Stable counting sort of all that a particle carries. Cost: particles + keys.
/// in:     key(p), the key of particle p, in [0, keys).
/// out:    particles in the order of their keys; first_of_node, where each key begins.
template <class Key>
inline void sort_by_key(long keys, const Key& key, SortScratch& scratch, Particles& particles) {
    common::counting_sort(particles.count(), keys, key, scratch, &particles.first_of_node);
    for (auto* quantity : particles.all()) common::carry_to_place(*quantity, scratch);
}

/// Sorts one species by nearest node, row by row.
/// in/out: particles, every position inside the mesh; first_of_node is rebuilt.
/// exact:  the order depends on the positions alone, not on the number of threads.
inline void sort_particles(const Grid& grid, SortScratch& scratch, Particles& particles) {
    const double x_low = grid.x.low, z_low = grid.z.low;
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const int row_length = int(nodes_x(grid));
    const double *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    const auto nearest_node = [=](long p) {
        const int i = int((x_p[p] - x_low) * per_dx + 0.5);
        const int j = int((z_p[p] - z_low) * per_dz + 0.5);
        return j * row_length + i;
    };
    sort_by_key(nodes_x(grid) * nodes_z(grid), nearest_node, scratch, particles);
}

/// Sorts all species.
inline void sort_particles(const Grid& grid, SortScratch& scratch,
                           std::vector<Particles>& species) {
    for (Particles& particles : species) sort_particles(grid, scratch, particles);
}

}  // namespace implicit_moment
