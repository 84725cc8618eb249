// grid -> particles with the mass matrix: half a step of free flight to x*, where the particle feels
// the field of the whole step, then the other half.
//
//     x*      = x^n + dt/2 v^n
//     vbar    = v^n + q dt/2m [ E^{n+theta}(x*) + vbar x B(x*) / c ],    v^{n+1} = 2 vbar - v^n
//     x^{n+1} = x* + dt/2 v^{n+1}
//
// and for a relativistic particle the vbar and u^{n+1} = gamma v of mean_velocity.hpp.
//
// Nothing is iterated: x* does not depend on the field. A wall reflects what reaches it in flight,
// which costs no energy, and a plasma at rest in any B stays as it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/ranks.hpp"
#include "common/run/sentence.hpp"
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
/// exact:  |u| stays; a flight back (v -> -v) ends where it began, to round-off.
/// errors: NumericalError when a particle crosses more than 1000 boxes: the run has blown up
inline void drift(const Grid& grid, double time, std::vector<Particles>& species) {
    for (Particles& s : species) {
        const auto drift_block = [&](auto dynamics, long begin, long end) {
            double count = 0;
            for (long p = begin; p < end; ++p) {
                const Velocity<double> v =
                    decltype(dynamics)::velocity(Velocity<double>{s.ux_p[p], s.uy_p[p], s.uz_p[p]});
                const double way_x = time * v.x, way_z = time * v.z;
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
        };
        const double lost = common::sum_over_blocks(s.count(), [&](long begin, long end) {
            return with_dynamics(s,
                                 [&](auto dynamics) { return drift_block(dynamics, begin, end); });
        });
        if (const long of_all = common::sum_over_ranks(long(lost)); of_all > 0)
            common::fail(
                double(of_all), " of the ", s.name,
                " cross more than 1000 boxes in a step: the field has blown up; reduce time.dt");
    }
}

namespace detail {

// u of relativistic particles after a kick: the direction of the implicit midpoint rule, and the energy that the
// field gave, q dt vbar . E with the vbar that the mass matrix has. The two differ by E times the square of E
// less the guess. stops: whether a particle has less energy than the field would take.
template <class Real>
inline Velocity<Real> kicked(const Velocity<Real>& u, const LocalField<Real>& at,
                             const LocalField<Real>& guess, double half_kick, bool& stops) {
    const auto [A, free] = linear_mean_velocity<Real>(u, guess, half_kick);
    const Velocity<Real> e{half_kick * at.E_x, half_kick * at.E_y, half_kick * at.E_z},
        vbar{free.x + A[0] * e.x + A[1] * e.y + A[2] * e.z,
             free.y + A[3] * e.x + A[4] * e.y + A[5] * e.z,
             free.z + A[6] * e.x + A[7] * e.y + A[8] * e.z},
        u_new = relativistic_mean_velocity<Real>(u, at, half_kick).u_new(u);
    const Real found = dot(u_new, u_new),
               wanted = Relativistic::square_after<Real>(u, 2.0 * dot(vbar, e));
    stops = stops || any(wanted < -1e-12 * (dot(u, u) + found));
    return with_energy(u_new, found, wanted);
}

}  // namespace detail

/// v^n -> v^{n+1} in the field at x*.
/// in:     field, the smoothed E^{n+theta} and B, ghosts filled; guess, that of deposit_mass_matrix; particles
///         at x*, sorted by node there
/// out:    false where a relativistic particle has less energy than is taken from it, so far from E is the
///         guess; the particles are then not to be used
/// exact:  m (|v^{n+1}|^2 - |v^n|^2) / 2, or m c^2 (gamma^{n+1} - gamma^n), = q dt vbar . E(x*), with the vbar and
///         the splines that deposit J: what particles gain is what J . E takes from the field. B does no work.
/// source: [IMM-12] for each particle
inline bool kick_particles(const InterleavedField& field, const InterleavedField& guess,
                           const Grid& grid, double dt, std::vector<Particles>& species) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const long columns = nodes_x(grid);
    std::vector<char> stops_in_row(std::size_t(nodes_z(grid)), 0);
    common::for_each_row(nodes_z(grid), [&](long row) {
        bool stops = false;
        const double z_node = grid.z.at(double(row));
        for (Particles& s : species) {
            const double half_kick = 0.5 * dt * s.q_p / s.m_p;
            for (long column = 0; column < columns; ++column) {
                const long node = row * columns + column;
                const double x_node = grid.x.at(double(column));
                const long corner = grid.index(column - 1, row - 1);
                const long end = s.first_of_node[node + 1];
                for (long p = s.first_of_node[node]; p < end; p += simd_width) {
                    const long count = end - p;
                    const SimdVector d_x = (load_simd(&s.x_p[p], count) - x_node) * per_dx,
                                     d_z = (load_simd(&s.z_p[p], count) - z_node) * per_dz;
                    const Velocity<SimdVector> u{load_simd(&s.ux_p[p], count),
                                                 load_simd(&s.uy_p[p], count),
                                                 load_simd(&s.uz_p[p], count)};
                    const auto at =
                        gather_field<SimdVector>(&field[corner], grid.stride(), d_x, d_z);
                    const Velocity<SimdVector> u_new =
                        s.relativistic
                            ? detail::kicked(
                                  u, at,
                                  gather_field<SimdVector>(&guess[corner], grid.stride(), d_x, d_z),
                                  half_kick, stops)
                            : Newtonian::mean(u, at, half_kick).u_new(u);
                    store_simd(u_new.x, &s.ux_p[p], count);
                    store_simd(u_new.y, &s.uy_p[p], count);
                    store_simd(u_new.z, &s.uz_p[p], count);
                }
            }
        }
        stops_in_row[std::size_t(row)] = stops;
    });
    return common::largest_over_ranks(std::ranges::max(stops_in_row)) == 0;
}

}  // namespace implicit_moment
