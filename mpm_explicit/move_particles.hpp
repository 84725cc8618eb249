// grid -> particles: particles take the change of velocity from the nodes, and move with them.
//
//     v_p^1 = v_p^0 + sum_i S_ip (v_i^1 - v_i^0)        as FLIP: incremented, not replaced [FLIP-6]
//     x_p^1 = x_p^0 + dt sum_i S_ip v_i^1               with the velocity of the grid      [FLIP-7]
// A FLIP fraction below one mixes in Harlow's PIC, v_p^1 = sum_i S_ip v_i^1, which takes energy.
#pragma once

#include "mpm_explicit/budget.hpp"
#include "mpm_explicit/clamp_to_walls.hpp"
#include "mpm_explicit/crossing.hpp"
#include "mpm_explicit/move_tiles.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm_explicit {

using namespace mpm;

/// in:     flip, the FLIP fraction; frozen particles keep their places
/// in/out: particles; sums of their tiles
/// exact:  the momentum of the particles changes by that of the nodes, but for what walls stop
template <class Shape>
void move_particles(const Shape& shape, const std::vector<Grain>& grains,
                    const std::vector<RigidMotion>& rigid, const GrainNodes& nodes, double flip,
                    bool frozen, double dt, Particles& particles, std::vector<TileSums>& sums) {
    const Locator at(nodes.mesh());
    double *x_p = particles.x_p.data(), *y_p = particles.y_p.data(), *vx_p = particles.vx_p.data(),
           *vy_p = particles.vy_p.data();
    const double* m_p = particles.m_p.data();
    double *from_x = particles.from_x_p.data(), *from_y = particles.from_y_p.data();
    const bool crossing = !particles.from_x_p.empty();
    const NodeMotion* motion = nodes.motion.data();
    const double dt_move = frozen ? 0 : dt, pic = 1 - flip;
    const ClampToWalls clamp(nodes.mesh());
    const auto move = [&](const Tile& tile, TileSums& sum, Extremes& reach) {
        const long* origin = nodes.origins(tile.grain);
        double kinetic = 0, kinetic_leapfrog = 0, kinetic_increment = 0, lost = 0, momentum_x = 0,
               momentum_y = 0, angular = 0;
        Extremes seen;
        for (long p = tile.begin; p < tile.end; ++p) {
            double ax = 0, ay = 0, ux = 0, uy = 0;
            for_each_node(shape, at, origin, x_p[p], y_p[p],
                          [&](long dof, double S, double, double) {
                              const NodeMotion& v = motion[dof];
                              ax += S * (v.vx_1 - v.vx_0), ay += S * (v.vy_1 - v.vy_0);
                              ux += S * v.vx_1, uy += S * v.vy_1;
                          });
            const double m = m_p[p], vx = vx_p[p], vy = vy_p[p];
            const double flip_x = vx + ax, flip_y = vy + ay;  // [FLIP-6]
            double new_x = flip_x + pic * (ux - flip_x), new_y = flip_y + pic * (uy - flip_y);
            const double to_x = x_p[p] + dt_move * ux, to_y = y_p[p] + dt_move * uy;  // [FLIP-7]
            const double x = clamp.x(to_x), y = clamp.y(to_y);
            if (x != to_x) new_x = clamp.stopped(new_x, x - to_x);
            if (y != to_y) new_y = clamp.stopped(new_y, y - to_y);
            vx_p[p] = new_x, vy_p[p] = new_y;
            if (crossing) remember_crossing(at, x_p[p] - x, y_p[p] - y, x, y, from_x[p], from_y[p]);
            x_p[p] = x, y_p[p] = y;

            const double now = new_x * new_x + new_y * new_y;
            kinetic += m * now, kinetic_leapfrog += m * (vx * new_x + vy * new_y);
            kinetic_increment += m * (ax * ax + ay * ay);
            lost += m * (now - flip_x * flip_x - flip_y * flip_y);
            momentum_x += m * new_x, momentum_y += m * new_y,
                angular += m * (x * new_y - y * new_x);
            seen.see(x, y);
        }
        sum.kinetic = 0.5 * kinetic, sum.kinetic_leapfrog = 0.5 * kinetic_leapfrog,
        sum.kinetic_increment = 0.5 * kinetic_increment;
        sum.pic = 0.5 * lost, sum.momentum_x = momentum_x, sum.momentum_y = momentum_y,
        sum.angular = angular;
        reach = seen;
    };
    move_tiles(grains, rigid, nodes, dt_move, particles, sums, move);
}

}  // namespace mpm_explicit
