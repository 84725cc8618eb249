// Strip by strip, particles move: those of rigid grains as they are told, the others as a scheme says.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "mpm_explicit/grain_nodes.hpp"

namespace mpm {

/// How far the particles of a strip reach.
struct Extremes {
    double x_least = std::numeric_limits<double>::infinity(), x_most = -x_least, y_least = x_least,
           y_most = -x_least;

    void see(double x, double y) {
        x_least = x < x_least ? x : x_least, x_most = x > x_most ? x : x_most;
        y_least = y < y_least ? y : y_least, y_most = y > y_most ? y : y_most;
    }
};

/// in:     dt_move, the time that particles move for: 0 where they are frozen; move(strip, sum,
///         extremes), for a strip of a grain that is not rigid
/// in/out: particles; sums of their strips
template <class Sums, class Move>
void move_strips(const std::vector<Grain>& grains, const std::vector<RigidMotion>& rigid,
                 const GrainNodes& nodes, double dt_move, Particles& particles,
                 std::vector<Sums>& sums, const Move& move) {
    double *x_p = particles.x_p.data(), *y_p = particles.y_p.data(), *vx_p = particles.vx_p.data(),
           *vy_p = particles.vy_p.data();
    const auto move_one = [&](long number) {
        const Strip& strip = nodes.strips()[static_cast<std::size_t>(number)];
        Sums sum = sums[static_cast<std::size_t>(number)];
        Extremes reach;
        if (grains[static_cast<std::size_t>(strip.grain)].rigid) {
            const RigidMotion& is = rigid[static_cast<std::size_t>(strip.grain)];
            for (long p = strip.begin; p < strip.end; ++p) {
                x_p[p] += dt_move * is.vx, y_p[p] += dt_move * is.vy;
                vx_p[p] = is.vx, vy_p[p] = is.vy;
                reach.see(x_p[p], y_p[p]);
            }
        } else {
            move(strip, sum, reach);
        }
        sum.x_least = reach.x_least, sum.x_most = reach.x_most;
        sum.y_least = reach.y_least, sum.y_most = reach.y_most;
        sums[static_cast<std::size_t>(number)] = sum;
    };
    const long strips = static_cast<long>(nodes.strips().size());
    common::for_each_row((strips + 15) / 16, [&](long sixteen) {
        for (long s = 16 * sixteen; s < std::min(strips, 16 * (sixteen + 1)); ++s) move_one(s);
    });
}

}  // namespace mpm
