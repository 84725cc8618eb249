// particles: sort by row of cells now and then, so that the stretch of mesh which a block of
// particles works on stays in the cache.
#pragma once

#include <vector>

#include "cic/share_particles.hpp"
#include "common/counting_sort.hpp"

namespace cic {

/// Whether the interval has passed. in: interval in steps, 0: never
inline bool sort_is_due(long interval, long step) { return interval > 0 && step % interval == 0; }

/// Stable sort by row of cells; within a row the order stays mixed, and neighbors in memory do not
/// wait for each other's charge to reach the same node.
/// in/out: particles, every position on the mesh; nothing happens in one dimension
inline void sort_particles(const Grid& grid, common::SortScratch<Real>& scratch,
                           std::vector<Particles>& species) {
    if (grid.z.cells == 1) return;
    const double z_low = grid.z.low, per_dz = 1 / grid.z.spacing();
    std::vector<int> first_of_row;
    for (Particles& s : species) {
        const auto row = [&](long p) { return int((double(s.z_p[p]) - z_low) * per_dz); };
        common::counting_sort(s.count(), grid.z.cells + 1, row, scratch, &first_of_row);
        for (std::vector<Real>* quantity : s.all())
            if (!quantity->empty())
                common::carry_to_place(*quantity, scratch.target, scratch.column);
        share_runs(first_of_row, s);
    }
}

}  // namespace cic
