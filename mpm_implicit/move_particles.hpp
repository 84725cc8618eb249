// grid -> particles: particles take the change of velocity from the nodes, and move with them.
//
//     v_p^1 = v_p^0 + sum_i S_ip (v_i^1 - v_i^0),  v_i^1 - v_i^0 = (v_i^theta - v_i^0)/theta
//     x_p^1 = x_p^0 + dt sum_i S_ip v_i^theta
// A damping c then multiplies v_p^1 by exp(-c dt). A force - c m v^theta would not damp what rings from
// one step to the next and is nearly zero in v^theta; this does, at the rate c/2.
// Positions and strains go with the same velocity: then the work of gravity is exact, too (but for
// gimp and quadratic in the cell next to slip and stick walls, where weight is that of m_i).
#pragma once

#include "mpm_explicit/grains/apply_loads.hpp"
#include "mpm_explicit/grid/clamp_to_walls.hpp"
#include "mpm_explicit/grid/move_tiles.hpp"
#include "mpm_explicit/transfer.hpp"
#include "mpm_implicit/budget.hpp"

namespace mpm_implicit {

/// Particles take the increment of velocity from the nodes, and move with v_i^theta.
/// in:     nodes.motion, v^0 and v^theta; flip, the FLIP fraction; damping of the velocity; whether they are frozen
/// in/out: particles; sums of their tiles
/// exact:  without damping the momentum of the particles changes by that of the nodes, but for what walls stop;
///         with the consistent mass so does sum_p m_p x_p^0 x v_p
template <class Shape>
void move_particles(const Shape& shape, const std::vector<Grain>& grains,
                    const std::vector<RigidMotion>& rigid, const GrainNodes& nodes, double theta,
                    double flip, double damping, bool frozen, double dt, Particles& particles,
                    std::vector<TileSums>& sums) {
    const Locator at(nodes.mesh());
    double *x_p = particles.x_p.data(), *y_p = particles.y_p.data(), *vx_p = particles.vx_p.data(),
           *vy_p = particles.vy_p.data();
    const double* m_p = particles.m_p.data();
    const NodeMotion* motion = nodes.motion.data();
    const double dt_move = frozen ? 0 : dt, pic = 1 - flip, per_theta = 1 / theta,
                 keeps = std::exp(-damping * dt);
    const ClampToWalls clamp(nodes.mesh());
    const auto move = [&](const Tile& tile, TileSums& sum, Extremes& reach) {
        const long* origin = nodes.origins(tile.grain);
        double kinetic = 0, twice_increment = 0, lost = 0, momentum_x = 0, momentum_y = 0,
               angular = 0;
        Extremes seen;
        for (long p = tile.begin; p < tile.end; ++p) {
            double ux = 0, uy = 0, wx = 0, wy = 0;  // v^0 and v^theta of the nodes here
            for_each_node(own_shape(shape, particles, std::size_t(p)), at, origin, x_p[p], y_p[p],
                          [&](long dof, double S, double, double) {
                              const NodeMotion& v = motion[dof];
                              ux += S * v.vx_0, uy += S * v.vy_0;
                              wx += S * v.vx_1, wy += S * v.vy_1;
                          });
            const double m = m_p[p], ax = per_theta * (wx - ux), ay = per_theta * (wy - uy);
            const double flip_x = vx_p[p] + ax, flip_y = vy_p[p] + ay;  // [FLIP-6]
            double free_x = flip_x + pic * (ux + ax - flip_x),
                   free_y = flip_y + pic * (uy + ay - flip_y);
            const double to_x = x_p[p] + dt_move * wx, to_y = y_p[p] + dt_move * wy;  // [FLIP-7]
            const double x = clamp.x(to_x), y = clamp.y(to_y);
            if (x != to_x) free_x = clamp.stopped(free_x, x - to_x);
            if (y != to_y) free_y = clamp.stopped(free_y, y - to_y);
            const double new_x = keeps * free_x, new_y = keeps * free_y;
            vx_p[p] = new_x, vy_p[p] = new_y;
            x_p[p] = x, y_p[p] = y;

            const double now = free_x * free_x + free_y * free_y;
            kinetic += m * now, twice_increment += m * (ax * ax + ay * ay);
            lost += m * (now - flip_x * flip_x - flip_y * flip_y);
            momentum_x += m * new_x, momentum_y += m * new_y,
                angular += m * (x * new_y - y * new_x);
            seen.see(x, y);
        }
        sum.kinetic = 0.5 * keeps * keeps * kinetic, sum.damping = 0.5 * kinetic - sum.kinetic;
        sum.twice_increment = twice_increment, sum.pic = 0.5 * lost;
        sum.momentum_x = momentum_x, sum.momentum_y = momentum_y, sum.angular = angular;
        reach = seen;
    };
    move_tiles(grains, rigid, nodes, dt_move, particles, sums, move);
}

/// Work on the nodes in this step, and their largest speed.
inline NodeWork work_on_nodes(const BodyForce& body, double theta, double dt,
                              const GrainNodes& nodes) {
    std::array<NodeWork, common::block_count> part;
    common::for_each_block(nodes.size(), [&](int block, long begin, long end) {
        double twice_increment = 0, gravity = 0, speed = 0;
        const unsigned char* is_free = nodes.is_free().data();
#pragma omp simd reduction(+ : twice_increment, gravity) reduction(max : speed)
        for (long i = begin; i < end; ++i) {
            const auto n = static_cast<std::size_t>(i);
            const NodeMotion& v = nodes.motion[n];
            const double m = is_free[n] * nodes.sums[n].m, dx = v.vx_1 - v.vx_0,
                         dy = v.vy_1 - v.vy_0;
            twice_increment += m * (dx * dx + dy * dy);
            const double squared = v.vx_1 * v.vx_1 + v.vy_1 * v.vy_1;
            gravity += m * (body.gravity_x * v.vx_1 + body.gravity_y * v.vy_1);
            speed = squared > speed ? squared : speed;
        }
        part[block] = {twice_increment / (theta * theta), dt * gravity, std::sqrt(speed)};
    });
    NodeWork total;
    for (const NodeWork& one : part) {
        total.twice_increment += one.twice_increment, total.gravity += one.gravity;
        total.largest_speed = std::max(total.largest_speed, one.largest_speed);
    }
    return total;
}

}  // namespace mpm_implicit
