// The outline of a grain: its parts, which particles near it carry along, and what nodes see of them.
//
//      o-------o-------o      A part s has an area vector A_s, out of the grain, and a place
//      |   A_s |       |      x_s = x_p + e_s. The particle p hands it to its nodes as it hands
//      |  __^__|____   |      them its mass, by S_ip; where the surface is along a normal n is then
//      | /  s  |    \\  |      at every node
//      o---p---o-----\\-o          sum_s S_ip (A_s.n) (x_s.n) / sum_s S_ip (A_s.n)
//                             in which a side that n is along, or that is turned away, has no part.
#pragma once

#include "mpm_explicit/transfer.hpp"

namespace mpm {

/// Calls work(particle, first, end) for the particles of a tile that carry parts, with the numbers of
/// these.
template <class Work>
void for_each_host(const Surface& surface, const Tile& tile, const Work& work) {
    for (std::size_t k = surface.first_of(tile.begin), end;
         k < surface.count() && surface.host[k] < tile.end; k = end) {
        for (end = k + 1; end < surface.count() && surface.host[end] == surface.host[k];) ++end;
        work(static_cast<std::size_t>(surface.host[k]), k, end);
    }
}

/// Area vectors of the outlines and their moments.
///   sum_s S_ip A_s,  sum_s S_ip A_s x_sT
/// out:    nodes.surface
/// exact:  sums over all nodes are those over all parts
template <class Shape>
void surface_to_grid(const Shape& shape, const Particles& particles, GrainNodes& nodes) {
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        std::fill(nodes.surface.begin() + begin, nodes.surface.begin() + end, SurfaceSums{});
    });
    const Locator at(nodes.mesh());
    const Surface& parts = particles.surface;
    nodes.for_each_tile([&](const Tile& tile, std::size_t) {
        for_each_host(parts, tile, [&](std::size_t p, std::size_t first, std::size_t end) {
            const double x = particles.x_p[p], y = particles.y_p[p];
            SurfaceSums carried{};
            for (std::size_t k = first; k < end; ++k) {
                const double a_x = parts.ax[k], a_y = parts.ay[k], x_s = x + parts.ex[k],
                             y_s = y + parts.ey[k];
                carried += {a_x, a_y, a_x * x_s, a_x * y_s, a_y * x_s, a_y * y_s};
            }
            for_each_node(shape, at, nodes.origins(tile.grain), x, y,
                          [&](long dof, double S, double, double) {
                              nodes.surface[dof] += carried.times(S);
                          });
        });
    });
    for (const GhostNode& ghost : nodes.ghosts()) {
        SurfaceSums& from = nodes.surface[ghost.dof];
        SurfaceSums& to = nodes.surface[ghost.master];
        // As in reduce_ghost_sums(): x of a mirror image is offset - x, of a wrapped one x - offset.
        const double side_x = ghost.mirror_x ? -1 : 1, side_y = ghost.mirror_y ? -1 : 1;
        const SurfaceSums image{side_x * from.x,           side_y * from.y,           from.xx,
                                side_x * side_y * from.xy, side_x * side_y * from.yx, from.yy};
        to += moved(image, ghost.mirror_y ? 0 : -side_x * ghost.offset,
                    ghost.mirror_y ? ghost.offset : 0);
        from = {};
    }
}

/// The parts of the outline turn and stretch with the particles that carry them, before these move.
///   e <- F e,  A <- det F F^-T A,  F = (1 - L/2)^-1 (1 + L/2),  L = dt grad v_p
/// in:     nodes.motion, v_1, with which particles move
/// exact:  a turn of the nodes is a turn of the parts, by 2 atan of half of what L says
template <class Shape>
void carry_surface(const Shape& shape, const std::vector<Grain>& grains, const GrainNodes& nodes,
                   double dt, Particles& particles) {
    const Locator at(nodes.mesh());
    Surface& parts = particles.surface;
    nodes.for_each_tile([&](const Tile& tile, std::size_t) {
        if (grains[tile.grain].rigid) return;
        for_each_host(parts, tile, [&](std::size_t p, std::size_t first, std::size_t end) {
            double xx = 0, xy = 0, yx = 0, yy = 0;
            for_each_node(shape, at, nodes.origins(tile.grain), particles.x_p[p], particles.y_p[p],
                          [&](long dof, double, double Gx, double Gy) {
                              const NodeMotion& v = nodes.motion[dof];
                              xx += Gx * v.vx_1, xy += Gy * v.vx_1;
                              yx += Gx * v.vy_1, yy += Gy * v.vy_1;
                          });
            xx *= 0.5 * dt, xy *= 0.5 * dt, yx *= 0.5 * dt, yy *= 0.5 * dt;
            const double per = 1 / ((1 - xx) * (1 - yy) - xy * yx), both = xx * yy - xy * yx;
            const double F_xx = per * (1 + xx - yy - both), F_xy = per * 2 * xy,
                         F_yx = per * 2 * yx, F_yy = per * (1 - xx + yy - both);
            for (std::size_t k = first; k < end; ++k) {
                const double e_x = parts.ex[k], e_y = parts.ey[k], a_x = parts.ax[k],
                             a_y = parts.ay[k];
                parts.ex[k] = F_xx * e_x + F_xy * e_y, parts.ey[k] = F_yx * e_x + F_yy * e_y;
                parts.ax[k] = F_yy * a_x - F_yx * a_y, parts.ay[k] = F_xx * a_y - F_xy * a_x;
            }
        });
    });
}

}  // namespace mpm
