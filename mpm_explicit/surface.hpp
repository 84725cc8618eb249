// The outline of a grain: its parts, which particles near it carry along, and what nodes see of them.
//
//      o-------o-------o      A part s has an area vector A_s, out of the grain, and a place
//      |   A_s |       |      x_s = x_p + e_s. The particle p hands it to its nodes as it hands
//      |  __^__|____   |      them its mass, by S_ip; where the surface is along a normal n is then
//      | /  s  |    \  |      at every node
//      o---p---o-----\-o          sum_s S_ip (A_s.n) (x_s.n) / sum_s S_ip (A_s.n)
//                             in which a side parallel to n does not count, as A_s.n = 0.
// Sides that meet at a sharp corner have sums each for itself, and the farther one along n counts: their mean
// would lift the corner off what the grain stands on.
// So of its parts a particle needs no more than the sums A and M of particles.hpp.
#pragma once

#include "mpm_explicit/transfer.hpp"

namespace mpm {

/// Calls work(tile, particle, k) for the particles that carry parts, k in Surface, by tiles as
/// GrainNodes::for_each_tile.
template <class Work>
void for_each_host(const GrainNodes& nodes, const Surface& surface, const Work& work) {
    const std::vector<int>& host = surface.host;
    const std::vector<Tile>& tiles = nodes.tiles();
    std::vector<std::size_t> begin(tiles.size() + 1, host.size());
    for (std::size_t s = 0, k = 0; s < tiles.size(); begin[s++] = k)
        while (k < host.size() && host[k] < tiles[s].begin) ++k;
    nodes.for_each_tile([&](const Tile& tile, std::size_t s) {
        for (std::size_t k = begin[s]; k < begin[s + 1]; ++k)
            work(tile, static_cast<std::size_t>(host[k]), k);
    });
}

/// Area vectors of the outlines and their moments.
///   sum_s S_ip A_s,  sum_s S_ip A_s x_sT,  of which a particle gives S_ip A,  S_ip (A x_pT + M)
/// out:    nodes.surface, of the nodes that have a place there
/// exact:  where every node has one, sums over nodes are those over all parts
template <class Shape>
void surface_to_grid(const Shape& shape, const Particles& particles, GrainNodes& nodes) {
    const Surface& s = particles.surface;
    const bool corners =
        std::any_of(s.side.begin(), s.side.end(), [](int side) { return side > 0; });
    nodes.surface[1].resize(corners ? nodes.surface[0].size() : 0);
    for (std::vector<SideSums>& side : nodes.surface)
        common::for_each_block(std::ssize(side), [&](int, long begin, long end) {
            std::fill(side.begin() + begin, side.begin() + end, SideSums{});
        });
    const Locator at(nodes.mesh());
    for_each_host(nodes, s, [&](const Tile& tile, std::size_t p, std::size_t k) {
        const double x = particles.x_p[p], y = particles.y_p[p], a_x = s.ax[k], a_y = s.ay[k];
        const SideSums carried{
            a_x, a_y, a_x * x + s.xx[k], a_x * y + s.xy[k], a_y * x + s.yx[k], a_y * y + s.yy[k]};
        for_each_node(own_shape(shape, particles, p), at, nodes.origins(tile.grain), x, y,
                      [&](long dof, double S, double, double) {
                          const int to = nodes.surface_of(dof);
                          if (to >= 0) nodes.surface[s.side[k]][to] += carried.times(S);
                      });
    });
    for (const GhostNode& ghost : nodes.ghosts()) {
        const int k = nodes.surface_of(ghost.dof), k_to = nodes.surface_of(ghost.master);
        if (k < 0 || k_to < 0) continue;
        // As in reduce_ghost_sums(): x of a mirror image is offset - x, of a wrapped one x - offset.
        const double side_x = ghost.mirror_x ? -1 : 1, side_y = ghost.mirror_y ? -1 : 1;
        for (std::vector<SideSums>& side : nodes.surface) {
            if (side.empty()) continue;
            SideSums& one = side[k];
            const SideSums image{side_x * one.x,           side_y * one.y,           one.xx,
                                 side_x * side_y * one.xy, side_x * side_y * one.yx, one.yy};
            side[k_to] += moved(image, ghost.mirror_y ? 0 : -side_x * ghost.offset,
                                ghost.mirror_y ? ghost.offset : 0);
            one = {};
        }
    }
}

/// The parts of the outline turn and stretch with the particles that carry them, before these move.
///   e <- F e,  A <- C A,  M <- C M FT,  C = det F F^-T,  F = 1 + dt grad v_p
/// in:     nodes.motion, v_1, with which particles move
/// exact:  F is the gradient of that move. Nodes that turn, by v_i = (R - 1) x_i/dt, turn the parts by
///         R, whatever the angle; any even F takes the outline to its image, of det F times its area
/// note:   clamped to |A| <= 2 h and |M| <= 2 h^2, more than a particle carries at the start
template <class Shape>
void carry_surface(const Shape& shape, const std::vector<Grain>& grains, const GrainNodes& nodes,
                   double dt, Particles& particles) {
    const Locator at(nodes.mesh());
    Surface& s = particles.surface;
    for_each_host(nodes, s, [&](const Tile& tile, std::size_t p, std::size_t k) {
        if (grains[tile.grain].rigid) return;
        double xx = 0, xy = 0, yx = 0, yy = 0;
        for_each_node(own_shape(shape, particles, p), at, nodes.origins(tile.grain),
                      particles.x_p[p], particles.y_p[p],
                      [&](long dof, double, double Gx, double Gy) {
                          const NodeMotion& v = nodes.motion[dof];
                          xx += Gx * v.vx_1, xy += Gy * v.vx_1;
                          yx += Gx * v.vy_1, yy += Gy * v.vy_1;
                      });
        const double F_xx = 1 + dt * xx, F_xy = dt * xy, F_yx = dt * yx, F_yy = 1 + dt * yy;
        const auto turn_area = [&](double& a_x, double& a_y) {
            const double was = a_x;
            a_x = F_yy * a_x - F_yx * a_y, a_y = F_xx * a_y - F_xy * was;
        };
        const auto turn_place = [&](double& e_x, double& e_y) {
            const double was = e_x;
            e_x = F_xx * e_x + F_xy * e_y, e_y = F_yx * was + F_yy * e_y;
        };
        turn_area(s.ax[k], s.ay[k]);
        turn_area(s.xx[k], s.yx[k]), turn_area(s.xy[k], s.yy[k]);
        turn_place(s.xx[k], s.xy[k]), turn_place(s.yx[k], s.yy[k]);

        // Noise of the nodes would stretch a part without limit, however small the strain stays: F of
        // many steps do not commute. None is longer than two cells, or farther than a cell away.
        const double h = nodes.mesh().h, A_2 = s.ax[k] * s.ax[k] + s.ay[k] * s.ay[k],
                     M_2 = s.xx[k] * s.xx[k] + s.xy[k] * s.xy[k] + s.yx[k] * s.yx[k] +
                           s.yy[k] * s.yy[k];
        const double part_A = A_2 > 4 * h * h ? 2 * h / std::sqrt(A_2) : 1,
                     part_M = M_2 > 4 * h * h * h * h ? 2 * h * h / std::sqrt(M_2) : 1;
        s.ax[k] *= part_A, s.ay[k] *= part_A;
        s.xx[k] *= part_M, s.xy[k] *= part_M, s.yx[k] *= part_M, s.yy[k] *= part_M;
    });
}

}  // namespace mpm
