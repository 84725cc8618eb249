// particles: sort by cell, so that the particles that share mesh values stand next to each other in
// memory.
#pragma once

#include "implicit_moment/explicit_em/stencil.hpp"
#include "implicit_moment/sort_particles.hpp"

namespace implicit_moment {

/// Stable counting sort of one species by the cells of its splines, row by row. Cost: particles +
/// cells.
/// in/out: particles, every position inside the mesh; first_of_node is rebuilt, for cells.
/// exact:  the order depends on the positions alone, not on the number of threads.
template <int l>
inline void sort_by_cell(const Grid& grid, SortScratch& scratch, Particles& particles) {
    const double x_low = grid.x.low, z_low = grid.z.low;
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const int columns = int(Stencil<l>::cells(grid.x)), rows = int(Stencil<l>::cells(grid.z));
    const double *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    const auto cell = [=](long p) {
        const int i = std::min(int((x_p[p] - x_low) * per_dx - Stencil<l>::low), columns - 1);
        const int j = std::min(int((z_p[p] - z_low) * per_dz - Stencil<l>::low), rows - 1);
        return j * columns + i;
    };
    sort_by_key(long{columns} * rows, cell, scratch, particles);
}

/// Sorts all species. in: order, of the spline of the charge.
inline void sort_by_cell(const Grid& grid, long order, SortScratch& scratch,
                         std::vector<Particles>& species) {
    for (Particles& particles : species) {
        order == 1 ? sort_by_cell<1>(grid, scratch, particles)
                   : sort_by_cell<2>(grid, scratch, particles);
    }
}

}  // namespace implicit_moment
