// Vectors of velocities, momenta or impulses at all dofs, x of dof i in [i] and y in [size + i]; and
// what mpm_explicit/transfer.hpp does for the ghosts of nodes, for theirs.
#pragma once

#include <Eigen/Core>

#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm_implicit {

using namespace mpm;
using Vector = Eigen::VectorXd;

/// Ghosts take their values from the dofs that they stand for.
inline void fill_ghosts(const GrainNodes& nodes, Vector& x) {
    const long n = nodes.size();
    const auto& ghosts = nodes.ghosts();
    for (auto ghost = ghosts.rbegin(); ghost != ghosts.rend(); ++ghost) {
        x[ghost->dof] = ghost->part_x * x[ghost->master];
        x[n + ghost->dof] = ghost->part_y * x[n + ghost->master];
        if (ghost->beyond < 0) continue;
        x[ghost->dof] -= x[ghost->beyond], x[n + ghost->dof] -= x[n + ghost->beyond];
    }
}

/// The transpose: dofs take what is on their ghosts.
inline void reduce_ghosts(const GrainNodes& nodes, Vector& y) {
    const long n = nodes.size();
    for (const GhostNode& ghost : nodes.ghosts()) {
        y[ghost.master] += ghost.part_x * y[ghost.dof];
        y[n + ghost.master] += ghost.part_y * y[n + ghost.dof];
        if (ghost.beyond >= 0)
            y[ghost.beyond] -= y[ghost.dof], y[n + ghost.beyond] -= y[n + ghost.dof];
        y[ghost.dof] = y[n + ghost.dof] = 0;
    }
}

/// The same for the diagonal of a matrix, but for what couples master and ghost.
inline void reduce_ghost_diagonal(const GrainNodes& nodes, Vector& d) {
    for (const GhostNode& ghost : nodes.ghosts()) {
        for (const long at : {0L, nodes.size()}) {
            d[at + ghost.master] += ghost.part_x * ghost.part_x * d[at + ghost.dof];
            if (ghost.beyond >= 0) d[at + ghost.beyond] += d[at + ghost.dof];
            d[at + ghost.dof] = 0;
        }
    }
}

}  // namespace mpm_implicit
