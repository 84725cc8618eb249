// One particle through one step with all care: where it leaves the neighborhood of its node,
// meets a wall, or crosses more than a cell.
#pragma once

#include <algorithm>
#include <cmath>

#include "implicit_moment/mean_velocity.hpp"

namespace implicit_moment {

/// How particles move, and how well the implicit midpoint is found.
struct MoverSettings {
    double tolerance = 1e-4;   // a midpoint is found when an iteration moves it by less [cells]
    long max_iterations = 20;  // before the step is halved
    bool relativistic = false;
};

inline constexpr int most_bounces = 50;  // of one particle in one sub-step

namespace detail {

// Position of a midpoint for the gather: periodic image, or the wall itself while the path is
// behind it.
inline double seen_at(const common::Axis& axis, double x) {
    if (axis.periodic) return x - axis.length * std::floor((x - axis.low) / axis.length);
    return std::clamp(x, axis.low, axis.high());
}

// Mean velocity of a step of length 2h; false when the iteration does not converge.
template <class Dynamics>
inline bool find_mean_velocity(const Grid& grid, const InterleavedField& field,
                               const MoverSettings& settings, double charge_over_mass, double h,
                               double x, double z, const Velocity<double>& u,
                               MeanVelocity<double>& mean) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    Velocity<double>& vbar = mean.vbar;
    vbar = Dynamics::velocity(u);
    for (long iteration = 0; iteration < settings.max_iterations; ++iteration) {
        // Too far for this step, or not a number: the caller halves it.
        if (!(h * std::fabs(vbar.x) * per_dx <= 1 && h * std::fabs(vbar.z) * per_dz <= 1))
            return false;
        const double s = (seen_at(grid.x, x + h * vbar.x) - grid.x.low) * per_dx;
        const double t = (seen_at(grid.z, z + h * vbar.z) - grid.z.low) * per_dz;
        const long i = long(s + 0.5), j = long(t + 0.5);
        const auto at = gather_field(&field[grid.index(i - 1, j - 1)], grid.stride(), s - double(i),
                                     t - double(j));
        const MeanVelocity<double> next = Dynamics::mean(u, at, charge_over_mass * h);
        const double change = h * std::max(std::fabs(next.vbar.x - vbar.x) * per_dx,
                                           std::fabs(next.vbar.z - vbar.z) * per_dz);
        mean = next;
        if (change <= settings.tolerance && iteration > 0) return true;
    }
    return false;
}

// The part of a displacement after which a coordinate stands on a wall; 1 when it meets none.
inline double part_to_wall(const common::Axis& axis, double x, double displacement) {
    if (axis.periodic) return 1;
    if (x + displacement < axis.low) return std::clamp((axis.low - x) / displacement, 0.0, 1.0);
    if (x + displacement > axis.high())
        return std::clamp((axis.high() - x) / displacement, 0.0, 1.0);
    return 1;
}

// The time after which a path stands on the wall that it is behind after `late`. The mean velocity
// vbar_n depends on the time, so that a time in proportion would miss the wall, and putting the
// particle there would change its canonical momentum: false position between a path that ends
// inside and one that ends behind.
// in: step(time) finds vbar_n anew. out: NaN when a step fails.
template <class Step>
inline double time_to_wall(const common::Axis& axis, double from, const double& vbar_n, double late,
                           const Step& step) {
    const double outward = vbar_n < 0 ? -1 : 1, wall = vbar_n < 0 ? axis.low : axis.high();
    double early = 0, inside = outward * (wall - from);
    double behind = outward * (from + late * vbar_n - wall), time = late;
    for (int k = 0; k < 50; ++k) {
        time = early + (late - early) * inside / (inside + behind);
        if (!step(time)) return std::nan("");
        const double gap = outward * (wall - from - time * vbar_n);
        if (std::fabs(gap) <= 1e-13 * axis.spacing()) break;
        if (gap > 0) {
            early = time, inside = gap, behind *= 0.5;
        } else {
            late = time, behind = -gap, inside *= 0.5;
        }
    }
    return time;
}

// After a displacement: the periodic image, or a reflection where the wall has been reached.
inline void arrive(const common::Axis& axis, bool at_wall, double& x, double& v) {
    if (axis.periodic) {
        x = seen_at(axis, x);
        if (x >= axis.high()) x = axis.low;
        return;
    }
    x = std::clamp(x, axis.low, axis.high());
    if (at_wall) {
        const bool outward = x - axis.low < axis.high() - x ? v < 0 : v > 0;
        if (outward) v = -v;
    }
}

}  // namespace detail

/// Moves one particle by dt in `parts` equal sub-steps; a sub-step that ends behind a wall is cut
/// where it meets the wall, the particle is reflected there, and goes on with the rest.
/// out:    false when a sub-step crosses more than a cell or does not converge; the particle is
///         then not to be used.
/// note:   a reflection at the end of the step instead would rotate the velocity in the wrong sense
///         for the rest of the step, and drive a current along magnetized walls.
template <class Dynamics = Newtonian>
inline bool move_one(const Grid& grid, const InterleavedField& field, const MoverSettings& settings,
                     double charge_over_mass, double dt, int parts, double& x, double& z,
                     Velocity<double>& u) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    for (int part = 0; part < parts; ++part) {
        double left = dt / parts;
        for (int bounce = 0; left > 0; ++bounce) {
            MeanVelocity<double> mean;
            Velocity<double>& vbar = mean.vbar;
            const auto step = [&](double time) {
                return detail::find_mean_velocity<Dynamics>(grid, field, settings, charge_over_mass,
                                                            0.5 * time, x, z, u, mean) &&
                       time * std::fabs(vbar.x) * per_dx <= 1 &&
                       time * std::fabs(vbar.z) * per_dz <= 1;
            };
            if (!step(left)) return false;
            const double to_x = detail::part_to_wall(grid.x, x, left * vbar.x);
            const double to_z = detail::part_to_wall(grid.z, z, left * vbar.z);
            // A force towards the wall makes the bounces shorter and shorter: let the particle slide.
            const bool slides = bounce == most_bounces;
            double time = slides ? left : left * std::min(to_x, to_z);
            if (time < left) {
                const bool along_x = to_x <= to_z;
                time = along_x ? detail::time_to_wall(grid.x, x, vbar.x, left, step)
                               : detail::time_to_wall(grid.z, z, vbar.z, left, step);
                if (std::isnan(time)) return false;
            }
            x += time * vbar.x;
            z += time * vbar.z;
            u = mean.u_new(u);
            detail::arrive(grid.x, to_x < 1 && to_x <= to_z, x, u.x);
            detail::arrive(grid.z, to_z < 1 && to_z <= to_x, z, u.z);
            left -= time;
        }
    }
    return true;
}

}  // namespace implicit_moment
