// What happens to particles at the ends of the mesh: around a periodic direction, out through an
// open end, in through an inflow; and never through a wall.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "common/parallel.hpp"
#include "common/run/parameters.hpp"
#include "flip/state.hpp"

namespace flip {

/// The end beyond which a position lies, or -1 on the mesh. Positions on an end count as on the
/// mesh; so does nothing that is not a number.
[[gnu::always_inline]] inline int beyond(const Grid& grid, double x, double z) {
    const bool inside =
        x >= grid.x.low && x <= grid.x.high() && z >= grid.z.low && z <= grid.z.high();
    if (inside) return -1;
    if (!(x >= grid.x.low)) return x_low;
    if (!(x <= grid.x.high())) return x_high;
    return !(z >= grid.z.low) ? z_low : z_high;
}

/// A position brought back around a periodic direction. Elsewhere it stays; only what approaches a
/// wall for ever, and touches it by round-off, is put on it.
[[gnu::always_inline]] inline double around(const common::Axis& axis, double position) {
    if (!axis.periodic) {
        const double low = axis.low, high = axis.high(), tiny = 1e-12 * axis.length;
        return position < low && position > low - tiny     ? low
               : position > high && position < high + tiny ? high
                                                           : position;
    }
    if (position < axis.low) {
        position += axis.length;
        return position < axis.high() ? position : axis.low;
    }
    return position < axis.high() ? position : std::max(position - axis.length, axis.low);
}

/// Says that a particle is where none can be.
/// errors: NumericalError, always
[[noreturn]] inline void lost_particle(double x, double z, double time) {
    throw common::NumericalError(
        "a particle has gone through the wall to x = " + common::format(x) +
        ", z = " + common::format(z) + " at t = " + common::format(time) + ": reduce time.cfl");
}

/// Removes every particle that has left through an open end or back through an inflow.
/// in:     time, for the message
/// in/out: particles, their positions around periodic directions already; first_of_row is void
///         afterwards
/// out:    left(p) has been called for every particle that leaves, before anything has moved
/// errors: NumericalError for a particle beyond a wall, or a position that is not finite
template <class Left>
void remove_leaving(const Problem& problem, double time, Particles& particles, const Left& left) {
    std::size_t kept = 0;
    const std::size_t count = particles.x_p.size();
    const auto columns = particles.all();
    for (std::size_t p = 0; p < count; ++p) {
        const double x = particles.x_p[p], z = particles.z_p[p];
        const int end = beyond(problem.grid, x, z);
        if (end >= 0) {
            const BoundaryKind kind = problem.boundaries.side[end].kind;
            if ((kind != BoundaryKind::open && kind != BoundaryKind::inflow) ||
                !std::isfinite(x + z))
                lost_particle(x, z, time);
            left(p);
            continue;
        }
        if (kept != p) {
            for (std::vector<double>* column : columns)
                if (has(*column)) (*column)[kept] = (*column)[p];
            particles.material[kept] = particles.material[p];
        }
        ++kept;
    }
    for (std::vector<double>* column : columns)
        if (has(*column)) column->resize(kept);
    particles.material.resize(kept);
}

/// Adds the particles that enter through inflow ends between t and t + dt: columns as far apart as
/// on the lattice of the start, each where it has got to by t + dt.
/// out:    the number added, at the end of the columns; all columns that are in use are filled
inline long add_inflow(const Problem& problem, double t, double dt, Particles& particles) {
    long added = 0;
    const Inflow& in = problem.boundaries.inflow;
    for (const Side end : all_sides) {
        if (!problem.boundaries.is(end, BoundaryKind::inflow)) continue;
        const bool along_x = end == x_low || end == x_high, low = end == x_low || end == z_low;
        const common::Axis &across = along_x ? problem.grid.x : problem.grid.z,
                           &aside = along_x ? problem.grid.z : problem.grid.x;
        const double speed = (low ? 1 : -1) * (along_x ? in.vx : in.vz);
        if (speed <= 0) continue;
        const double step = across.spacing() /
                            static_cast<double>(along_x ? problem.per_cell_x : problem.per_cell_z);
        const long per_cell = along_x ? problem.per_cell_z : problem.per_cell_x,
                   count = per_cell * aside.cells;
        const double width = aside.spacing() / static_cast<double>(per_cell);
        // Column n crosses the end at t_n = (n + 1/2) step/speed.
        const auto crossed = [&](double time) {
            return static_cast<long>(std::floor(time * speed / step + 0.5));
        };
        for (long n = crossed(t); n < crossed(t + dt); ++n) {
            const double depth = (t + dt) * speed - (static_cast<double>(n) + 0.5) * step;
            const double at = low ? across.low + depth : across.high() - depth;
            for (long k = 0; k < count; ++k) {
                const double beside = aside.low + (static_cast<double>(k) + 0.5) * width;
                const auto add = [](std::vector<double>& column, bool used, double value) {
                    if (used) column.push_back(value);
                };
                const bool moving = has(particles.vx_p) || particles.x_p.empty();
                add(particles.vx_p, moving, in.vx);
                add(particles.vz_p, moving, in.vz);
                add(particles.e_p, moving, in.e);
                add(particles.V_p, problem.scheme.particle_volumes && moving, step * width);
                for (auto* C :
                     {&particles.Cxx_p, &particles.Cxz_p, &particles.Czx_p, &particles.Czz_p})
                    add(*C, problem.scheme.transfer.affine && moving, 0.0);
                particles.x_p.push_back(along_x ? at : beside);
                particles.z_p.push_back(along_x ? beside : at);
                particles.m_p.push_back(in.rho * step * width);
                particles.material.push_back(in.material);
                ++added;
            }
        }
    }
    return added;
}

}  // namespace flip
