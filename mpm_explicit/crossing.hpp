// Particles that cross a line of nodes: strain of both cells.
//
//     o-----|-----o     Linear gradients jump at a line of nodes. [MPM-11] strains a particle that has
//         p-|->         crossed as if all of its way had been in the new cell. One that hovers about a
//     o-----|-----o     line is compressed by that at each crossing; and the more it is compressed, the
//                       more its force pushes the nodes of that line, and it, to and fro. Instead, the
//                       part w of what strains it is of the cell that it has left:
//     grad v_p = (1 - w) sum_i grad S_i(x_p) v_i^0 + w sum_i grad S_i(x_p - dx_p) v_i^0
// with dx_p the way that it has come. With w = 1/2 crossings give no energy to first order. With
// w = 0, the slide, one gives V_p sigma : dt [grad v]/2, with [ ] the jump.
// source: after Nairn, Comput. Model. Eng. Sci. 4, 649 (2003), who strains all particles twice in a step.
#pragma once

#include <cmath>

#include "mpm_explicit/strain.hpp"

namespace mpm_explicit {

using namespace mpm;

/// Keeps where particles came from, if that is in another cell; otherwise zero.
/// in:     x_p, y_p, where they were; to_x, to_y, where they go; count of them
/// out:    from_x, from_y, the way back
/// note:   One that moves by more than half a cell in a step may have come from where its grain has no
///         nodes any more, and counts as one that has not crossed.
inline void remember_crossing(const Locator& at, const double* x_p, const double* y_p,
                              const double* to_x, const double* to_y, long count, double* from_x,
                              double* from_y) {
    const double most = GrainNodes::reach / at.per_h;
#pragma omp simd
    for (long k = 0; k < count; ++k) {
        const double dx = x_p[k] - to_x[k], dy = y_p[k] - to_y[k];
        const auto cell = [&](double x, double low) { return std::floor((x - low) * at.per_h); };
        const double cells_x = cell(to_x[k] + dx, at.x_low) - cell(to_x[k], at.x_low),
                     cells_y = cell(to_y[k] + dy, at.y_low) - cell(to_y[k], at.y_low);
        const bool crosses = (cells_x != 0) | (cells_y != 0),
                   near = (std::fabs(dx) <= most) & (std::fabs(dy) <= most);
        from_x[k] = (crosses & near) ? dx : 0, from_y[k] = (crosses & near) ? dy : 0;
    }
}

/// The part w of what strains those that have crossed is of the cell that they have left.
/// in/out: batch, velocity gradients times dt
/// exact:  a turn of the nodes by any angle stays one
/// note:   Where the last particle has left a cell, nodes of it have no velocity, and nothing is shared.
template <class Shape>
void strain_in_both_cells(const Shape& shape, double w, const Particles& particles,
                          const GrainNodes& nodes, double dt, ParticleBatch& batch) {
    if (!(w > 0)) return;
    const Locator at(nodes.mesh());
    for (long k = 0; k < batch.count; ++k) {
        const auto p = static_cast<std::size_t>(batch.begin + k);
        const double dx = particles.from_x_p[p], dy = particles.from_y_p[p];
        if (dx == 0 && dy == 0) continue;
        double xx = 0, yy = 0, xy = 0, yx = 0;
        bool all_move = true;
        for_each_node(shape, at, nodes.origins(batch.grain), particles.x_p[p] + dx,
                      particles.y_p[p] + dy, [&](long dof, double, double Gx, double Gy) {
                          const NodeMotion& v = nodes.motion[dof];
                          xx += Gx * v.vx_0, xy += Gy * v.vx_0;
                          yx += Gx * v.vy_0, yy += Gy * v.vy_0;
                          all_move = all_move && nodes.moves(dof);
                      });
        if (!all_move) continue;
        batch.xx[k] += w * (dt * xx - batch.xx[k]), batch.xy[k] += w * (dt * xy - batch.xy[k]);
        batch.yx[k] += w * (dt * yx - batch.yx[k]), batch.yy[k] += w * (dt * yy - batch.yy[k]);
    }
}

}  // namespace mpm_explicit
