// Tile by tile, particles move: those of rigid grains as they are told, the others as a scheme
// says.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "mpm_explicit/grid/grain_nodes.hpp"

namespace mpm {

/// How far the particles of a tile reach.
struct Extremes {
    double x_least = std::numeric_limits<double>::infinity(), x_most = -x_least, y_least = x_least,
           y_most = -x_least;

    void see(double x, double y) {
        x_least = x < x_least ? x : x_least, x_most = x > x_most ? x : x_most;
        y_least = y < y_least ? y : y_least, y_most = y > y_most ? y : y_most;
    }
};

/// in:     dt_move, the time that particles move for: 0 where they are frozen; move(tile, sum,
///         extremes), for a tile of a grain that is not rigid
/// in/out: particles; sums of their tiles
template <class Sums, class Move>
void move_tiles(const std::vector<Grain>& grains, const std::vector<RigidMotion>& rigid,
                const GrainNodes& nodes, double dt_move, Particles& particles,
                std::vector<Sums>& sums, const Move& move) {
    double *x_p = particles.x_p.data(), *y_p = particles.y_p.data(), *vx_p = particles.vx_p.data(),
           *vy_p = particles.vy_p.data();
    const auto move_one = [&](long number) {
        const Tile& tile = nodes.tiles()[number];
        Sums sum = sums[number];
        Extremes reach;
        if (grains[tile.grain].rigid) {
            const RigidMotion& is = rigid[tile.grain];
            for (long p = tile.begin; p < tile.end; ++p) {
                x_p[p] += dt_move * is.vx, y_p[p] += dt_move * is.vy;
                vx_p[p] = is.vx, vy_p[p] = is.vy;
                reach.see(x_p[p], y_p[p]);
            }
        } else {
            move(tile, sum, reach);
        }
        sum.x_least = reach.x_least, sum.x_most = reach.x_most;
        sum.y_least = reach.y_least, sum.y_most = reach.y_most;
        sums[number] = sum;
    };
    const long tiles = static_cast<long>(nodes.tiles().size());
    common::for_each_row((tiles + 15) / 16, [&](long sixteen) {
        for (long s = 16 * sixteen; s < std::min(tiles, 16 * (sixteen + 1)); ++s) move_one(s);
    });
}

}  // namespace mpm
