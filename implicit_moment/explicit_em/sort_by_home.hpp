// particles: sort by home, so that the particles that share mesh values stand next to each other in
// memory.
#pragma once

#include "implicit_moment/explicit_em/home_weights.hpp"
#include "implicit_moment/sort_particles.hpp"

namespace implicit_moment {

/// Stable counting sort of the particles by home, row by row. Cost: particles + homes.
/// in/out: particles, every position inside the mesh; first_of_node is rebuilt, of homes.
/// exact:  the order depends on the positions alone, not on the number of threads.
template <int l>
inline void sort_by_home(const Grid& grid, SortScratch& scratch, Particles& particles) {
    const double x_low = grid.x.low, z_low = grid.z.low;
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const long columns = Homes<l>::count(grid.x), rows = Homes<l>::count(grid.z);
    const double *x_p = particles.x_p.data(), *z_p = particles.z_p.data();
    const auto home = [=](long p) {
        const int i = std::min(static_cast<int>((x_p[p] - x_low) * per_dx - Homes<l>::low),
                               static_cast<int>(columns) - 1);
        const int j = std::min(static_cast<int>((z_p[p] - z_low) * per_dz - Homes<l>::low),
                               static_cast<int>(rows) - 1);
        return j * static_cast<int>(columns) + i;
    };
    common::counting_sort(particles.count(), columns * rows, home, scratch,
                          &particles.first_of_node);
    for (auto* quantity :
         {&particles.x_p, &particles.z_p, &particles.vx_p, &particles.vy_p, &particles.vz_p})
        common::carry_to_place(*quantity, scratch);
}

/// Sorts all species. in: order, of the spline of the charge.
inline void sort_by_home(const Grid& grid, long order, SortScratch& scratch,
                         std::vector<Particles>& species) {
    for (Particles& particles : species) {
        order == 1 ? sort_by_home<1>(grid, scratch, particles)
                   : sort_by_home<2>(grid, scratch, particles);
    }
}

}  // namespace implicit_moment
