// Particles that cross a line of nodes: strain of both cells.
//
//     o-----|-----o     Linear gradients jump at a line of nodes. [MPM-11] strains a particle that has
//         p-|->         crossed as if all of its way had been in the new cell. One that hovers about a
//     o-----|-----o     line is compressed by that at each crossing; and the more it is compressed, the
//                       more its force pushes the nodes of that line, and it, to and fro. Instead, of
//                       what strains it the part w is what it saw in the cell that it has left:
//     grad v_p = (1 - w) sum_i grad S_ip v_i^0 + w (sum_i grad S_ip v_i^1 of the step before)
// With w = 1/2 crossings give no energy to first order, and what the velocities v_i^1 have beside v_i^0,
// their noise, is damped. With w = 0, the slide, one gives V_p sigma : dt [grad v]/2, with [ ] the jump.
// source: Nairn, Comput. Model. Eng. Sci. 4, 649 (2003), who strains all particles twice in a step.
#pragma once

#include <algorithm>
#include <cmath>

#include "mpm_explicit/clamp_to_walls.hpp"
#include "mpm_explicit/strain.hpp"

namespace mpm_explicit {

using namespace mpm;

/// What particles that will have crossed a line see before they move, as a gradient where they then
/// are; zero for the others.
///   L (1 + L)^-1,  L = dt sum_i grad S_ip v_i^1
/// in:     nodes.motion, v_1, with which particles move
/// out:    particles.left()
template <class Shape>
void see_cells_left(const Shape& shape, const std::vector<Grain>& grains, const GrainNodes& nodes,
                    double dt, Particles& particles) {
    for (std::vector<double>* one : particles.left()) one->resize(particles.x_p.size());
    const Mesh& mesh = nodes.mesh();
    const Locator at(mesh);
    const ClampToWalls clamp(mesh);
    nodes.for_each_tile([&](const Tile& tile, std::size_t) {
        if (grains[tile.grain].rigid) return;
        for (long k = tile.begin; k < tile.end; ++k) {
            const auto p = static_cast<std::size_t>(k);
            const double x = particles.x_p[p], y = particles.y_p[p];
            double ux = 0, uy = 0, xx = 0, xy = 0, yx = 0, yy = 0;
            for_each_node(shape, at, nodes.origins(tile.grain), x, y,
                          [&](long dof, double S, double Gx, double Gy) {
                              const NodeMotion& v = nodes.motion[dof];
                              ux += dt * S * v.vx_1, uy += dt * S * v.vy_1;
                              xx += dt * Gx * v.vx_1, xy += dt * Gy * v.vx_1;
                              yx += dt * Gx * v.vy_1, yy += dt * Gy * v.vy_1;
                          });
            const auto line = [&](double from, double low) {
                return std::floor((from - low) * at.per_h);
            };
            const bool crosses = line(clamp.x(x + ux), at.x_low) != line(x, at.x_low) ||
                                 line(clamp.y(y + uy), at.y_low) != line(y, at.y_low);
            const double both = xx * yy - xy * yx, per = crosses ? 1 / (1 + xx + yy + both) : 0;
            particles.lxx_p[p] = per * (xx + both), particles.lyy_p[p] = per * (yy + both);
            particles.lxy_p[p] = per * xy, particles.lyx_p[p] = per * yx;
        }
    });
}

/// The part w of what strains those that have crossed is of the cell that they have left.
/// in/out: batch, velocity gradients times dt
/// exact:  a turn of the nodes by any angle stays one
/// note:   one that left a cell without any gradient counts as one that has not crossed.
inline void strain_in_both_cells(double w, const Particles& particles, ParticleBatch& batch) {
    if (particles.lxx_p.empty()) return;
    for (long k = 0; k < batch.count; ++k) {
        const auto p = static_cast<std::size_t>(batch.begin + k);
        const double xx = particles.lxx_p[p], xy = particles.lxy_p[p], yx = particles.lyx_p[p],
                     yy = particles.lyy_p[p];
        if (xx == 0 && xy == 0 && yx == 0 && yy == 0) continue;
        batch.xx[k] += w * (xx - batch.xx[k]), batch.xy[k] += w * (xy - batch.xy[k]);
        batch.yx[k] += w * (yx - batch.yx[k]), batch.yy[k] += w * (yy - batch.yy[k]);
    }
}

}  // namespace mpm_explicit
