// grid -> particles: particles take the change of velocity from the nodes, and move with them.
//
//     v_p^1 = v_p^0 + sum_i S_ip (v_i^1 - v_i^0)        as FLIP: incremented, not replaced [FLIP-6]
//     x_p^1 = x_p^0 + dt sum_i S_ip v_i^1               with the velocity of the grid      [FLIP-7]
// A FLIP fraction below one mixes in Harlow's PIC, v_p^1 = sum_i S_ip v_i^1, which takes energy.
#pragma once

#include <algorithm>

#include "mpm_explicit/budget.hpp"
#include "mpm_explicit/crossing.hpp"
#include "mpm_explicit/grid/clamp_to_walls.hpp"
#include "mpm_explicit/grid/move_tiles.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm_explicit {

using namespace mpm;

/// Velocities that the nodes give to a batch of particles.
template <class Shape>
struct BatchVelocity {
    double x_0[Places<Shape>::size], y_0[Places<Shape>::size];  // sum_i S_ip v_i^0
    double x_1[Places<Shape>::size], y_1[Places<Shape>::size];  // sum_i S_ip v_i^1

    void gather(const Places<Shape>& places, const long* origin, const NodeMotion* motion,
                long count) {
        for (long k = 0; k < count; ++k) {
            Four v{};
            places.for_each_node(k, origin, [&](long dof, double S, double, double) {
                v += S * load<Four>(&motion[dof].vx_0);
            });
            x_0[k] = v[0], y_0[k] = v[1], x_1[k] = v[2], y_1[k] = v[3];
        }
    }
};

/// Particles take the increment of velocity from the nodes, and move with v_i^1.
/// in/out: particles; sums of their tiles. in: flip, the FLIP fraction; frozen particles keep their places
/// exact:  the momentum of the particles changes by that of the nodes, but for what walls stop
template <class Shape>
void move_particles(const Shape& shape, const std::vector<Grain>& grains,
                    const std::vector<RigidMotion>& rigid, const GrainNodes& nodes, double flip,
                    bool frozen, double dt, Particles& particles, std::vector<TileSums>& sums) {
    const Locator at(nodes.mesh());
    const ClampToWalls clamp(nodes.mesh());
    const bool crossing = !particles.from_x_p.empty();
    const double dt_move = frozen ? 0 : dt, pic = 1 - flip;
    const auto move = [&](const Tile& tile, TileSums& sum, Extremes& reach) {
        Places<Shape> places;
        BatchVelocity<Shape> u;
        double to_x[places.size], to_y[places.size];
        double kinetic = 0, kinetic_leapfrog = 0, kinetic_increment = 0, lost = 0, momentum_x = 0,
               momentum_y = 0, angular = 0;
        double x_least = reach.x_least, x_most = reach.x_most, y_least = reach.y_least,
               y_most = reach.y_most;
        for (long begin = tile.begin; begin < tile.end; begin += places.size) {
            const long count = std::min(places.size, tile.end - begin);
            double *x_p = particles.x_p.data() + begin, *y_p = particles.y_p.data() + begin,
                   *vx_p = particles.vx_p.data() + begin, *vy_p = particles.vy_p.data() + begin;
            const double* m_p = particles.m_p.data() + begin;
            places.find(shape, at, particles, begin, count);
            u.gather(places, nodes.origins(tile.grain), nodes.motion.data(), count);
#pragma omp simd reduction(+ : kinetic, kinetic_leapfrog, kinetic_increment, lost, momentum_x, momentum_y, angular) \
    reduction(min : x_least, y_least) reduction(max : x_most, y_most)
            for (long k = 0; k < count; ++k) {
                const double ux = u.x_1[k], uy = u.y_1[k], ax = ux - u.x_0[k], ay = uy - u.y_0[k];
                const double m = m_p[k], vx = vx_p[k], vy = vy_p[k];
                const double flip_x = vx + ax, flip_y = vy + ay;  // [FLIP-6]
                const double by_x = x_p[k] + dt_move * ux,
                             by_y = y_p[k] + dt_move * uy;  // [FLIP-7]
                const double x = clamp.x(by_x), y = clamp.y(by_y);
                const double new_x = clamp.stopped(flip_x + pic * (ux - flip_x), x - by_x),
                             new_y = clamp.stopped(flip_y + pic * (uy - flip_y), y - by_y);
                vx_p[k] = new_x, vy_p[k] = new_y, to_x[k] = x, to_y[k] = y;

                const double now = new_x * new_x + new_y * new_y;
                kinetic += m * now, kinetic_leapfrog += m * (vx * new_x + vy * new_y);
                kinetic_increment += m * (ax * ax + ay * ay);
                lost += m * (now - flip_x * flip_x - flip_y * flip_y);
                momentum_x += m * new_x, momentum_y += m * new_y;
                angular += m * (x * new_y - y * new_x);
                x_least = x < x_least ? x : x_least, x_most = x > x_most ? x : x_most;
                y_least = y < y_least ? y : y_least, y_most = y > y_most ? y : y_most;
            }
            if (crossing)
                remember_crossing(at, x_p, y_p, to_x, to_y, count, &particles.from_x_p[begin],
                                  &particles.from_y_p[begin]);
            std::copy_n(to_x, count, x_p), std::copy_n(to_y, count, y_p);
        }
        sum.kinetic = 0.5 * kinetic, sum.kinetic_leapfrog = 0.5 * kinetic_leapfrog,
        sum.kinetic_increment = 0.5 * kinetic_increment;
        sum.pic = 0.5 * lost, sum.momentum_x = momentum_x, sum.momentum_y = momentum_y,
        sum.angular = angular;
        reach = {x_least, x_most, y_least, y_most};
    };
    move_tiles(grains, rigid, nodes, dt_move, particles, sums, move);
}

}  // namespace mpm_explicit
