// grid -> particles with the mass matrix: half a step of free flight to x*, where the particle feels
// the field of the whole step, then the other half.
//
//     x*      = x^n + dt/2 v^n
//     vbar    = v^n + q dt/2m [ E^{n+theta}(x*) + vbar x B(x*) / c ],    v^{n+1} = 2 vbar - v^n
//     x^{n+1} = x* + dt/2 v^{n+1}
//
// Nothing is iterated: x* does not depend on the field. A wall reflects what reaches it in flight,
// which costs no energy, and a plasma at rest in any B stays as it is.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"
#include "implicit_moment/mass_matrix.hpp"

namespace implicit_moment {

namespace detail {

// Where a flight ends: the periodic image, or after as many reflections as it takes.
inline void land(const common::Axis& axis, double& x, double& v) {
    if (x >= axis.low && x < axis.high()) return;
    const double lengths = (x - axis.low) / axis.length, turns = std::floor(lengths);
    x -= turns * axis.length;
    if (!axis.periodic && std::fmod(turns, 2) != 0) {
        x = axis.low + axis.high() - x;
        v = -v;
    }
    x = std::fmin(std::fmax(x, axis.low), axis.high());
    if (axis.periodic && x == axis.high()) x = axis.low;
}

}  // namespace detail

/// Moves all particles along straight lines for a time.
/// in/out: particles, not sorted afterwards
/// exact:  |v| stays; a flight back (v -> -v) ends where it began, to round-off.
/// errors: NumericalError when a particle crosses more than 1000 boxes: the run has blown up
inline void fly(const Grid& grid, double time, std::vector<Particles>& species) {
    for (Particles& s : species) {
        const double lost = common::sum_over_blocks(s.count(), [&](long begin, long end) {
            double count = 0;
            for (long p = begin; p < end; ++p) {
                const double way_x = time * s.ux_p[p], way_z = time * s.uz_p[p];
                if (!(std::fabs(way_x) < 1e3 * grid.x.length &&
                      std::fabs(way_z) < 1e3 * grid.z.length)) {
                    ++count;
                    continue;
                }
                s.x_p[p] += way_x;
                s.z_p[p] += way_z;
                detail::land(grid.x, s.x_p[p], s.ux_p[p]);
                detail::land(grid.z, s.z_p[p], s.uz_p[p]);
            }
            return count;
        });
        if (lost > 0)
            throw common::NumericalError(common::format(lost) + " of the " + s.name +
                                         " cross more than 1000 boxes in a step: the field has "
                                         "blown up; reduce time.dt");
    }
}

/// v^n -> v^{n+1} in the field at x*.
/// in:     field, the smoothed E^{n+theta} and B, ghosts filled; particles at x*, sorted by node there
/// exact:  m (|v^{n+1}|^2 - |v^n|^2) / 2 = q dt vbar . E(x*), with the splines that deposit J: what
///         particles gain is what J . E takes from the field. B does no work.
/// source: [IMM-12] for each particle
inline void kick_particles(const InterleavedField& field, const Grid& grid, double dt,
                           std::vector<Particles>& species) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const long columns = nodes_x(grid);
    common::for_each_row(nodes_z(grid), [&](long row) {
        const double z_node = grid.z.at(double(row));
        for (Particles& s : species) {
            const double half_kick = 0.5 * dt * s.q_p / s.m_p;
            for (long column = 0; column < columns; ++column) {
                const long node = row * columns + column;
                const double x_node = grid.x.at(double(column));
                const NodeField* corner = &field[grid.index(column - 1, row - 1)];
                const long end = s.first_of_node[node + 1];
                for (long p = s.first_of_node[node]; p < end; p += common::simd_width) {
                    const long count = end - p;
                    const SimdVector d_x = (common::load_simd(&s.x_p[p], count) - x_node) * per_dx,
                                     d_z = (common::load_simd(&s.z_p[p], count) - z_node) * per_dz;
                    const Velocity<SimdVector> v{common::load_simd(&s.ux_p[p], count),
                                                 common::load_simd(&s.uy_p[p], count),
                                                 common::load_simd(&s.uz_p[p], count)};
                    const auto at = gather_field<SimdVector>(corner, grid.stride(), d_x, d_z);
                    const auto vbar = mean_velocity<SimdVector>(v, at, half_kick);
                    common::store_simd(2.0 * vbar.x - v.x, &s.ux_p[p], count);
                    common::store_simd(2.0 * vbar.y - v.y, &s.uy_p[p], count);
                    common::store_simd(2.0 * vbar.z - v.z, &s.uz_p[p], count);
                }
            }
        }
    });
}

}  // namespace implicit_moment
