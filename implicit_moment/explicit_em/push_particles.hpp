// grid -> particles -> grid: Boris's push, the move, and the current of the paths, in one sweep
// through the particles.
//
//     u^{n+1/2} - u^{n-1/2} = q dt/m [ E^n + u/(gamma c) x B^n ],   u = gamma v
//     x^{n+1} - x^n = dt v^{n+1/2}
//
// Fields are gathered with the splines that deposit J: then E does on particles the work that J
// takes from the mesh, and a plasma at rest is not heated by a mesh that does not resolve its Debye
// length. Particles that share a home go eight at a time; the few that leave it are followed one by
// one (follow_path.hpp).
#pragma once

#include <string>
#include <vector>

#include "common/parallel.hpp"
#include "common/run/parameters.hpp"
#include "common/simd.hpp"
#include "implicit_moment/explicit_em/follow_path.hpp"
#include "implicit_moment/explicit_em/leapfrog_settings.hpp"
#include "implicit_moment/move_particles.hpp"
#include "implicit_moment/push_field.hpp"
#include "implicit_moment/smooth.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

using common::SimdVector;

/// Fields at a particle at distance d from its home.
/// in:     corner, the record of the lowest node that the home touches.
template <int l, class Real>
inline LocalField<Real> gather_at_home(const NodeField* corner, long stride, const Real& d_x,
                                       const Real& d_z) {
    const HomeWeights<l, Real> S_x(d_x), S_z(d_z);
    LocalField<Real> at{};
    for (int j = 0; j <= l; ++j) {
        const NodeField* f = corner + j * stride;
        Real E_x{}, E_y{}, B_z{};
        for (int i = 0; i < l; ++i) E_x += S_x.half[i] * f[i].E_x, B_z += S_x.half[i] * f[i].B_z;
        for (int i = 0; i <= l; ++i) E_y += S_x.node[i] * f[i].E_y;
        at.E_x += S_z.node[j] * E_x, at.E_y += S_z.node[j] * E_y, at.B_z += S_z.node[j] * B_z;
    }
    for (int j = 0; j < l; ++j) {
        const NodeField* f = corner + j * stride;
        Real E_z{}, B_x{}, B_y{};
        for (int i = 0; i <= l; ++i) E_z += S_x.node[i] * f[i].E_z, B_x += S_x.node[i] * f[i].B_x;
        for (int i = 0; i < l; ++i) B_y += S_x.half[i] * f[i].B_y;
        at.E_z += S_z.half[j] * E_z, at.B_x += S_z.half[j] * B_x, at.B_y += S_z.half[j] * B_y;
    }
    return at;
}

/// gamma^2 = 1 + u^2/c^2; per_c_squared = 0 makes it 1.
template <class Real>
inline Real gamma_squared(const Velocity<Real>& u, double per_c_squared) {
    return 1.0 + per_c_squared * (u.x * u.x + u.y * u.y + u.z * u.z);
}
template <class Real>
inline Real inverse_gamma(const Velocity<Real>& u, double per_c_squared) {
    return 1.0 / common::square_root(gamma_squared(u, per_c_squared));
}

/// Rotation of u about B by the angle 2 atan |t|, t = k B / gamma:  u' = u + (u + u x t) x s,
/// s = 2 t / (1 + t^2); with K = k B that is
///     u' = u + 2 / (gamma^2 + K^2) [ gamma u x K + (u x K) x K ],
/// which divides once.
/// exact:  |u| is unchanged; k -> -k turns back.
/// source: Boris, Proc. 4th Conf. Numerical Simulation of Plasmas (1970).
template <class Real>
inline void rotate(Velocity<Real>& u, const LocalField<Real>& at, double k, double per_c_squared) {
    const Real K_x = k * at.B_x, K_y = k * at.B_y, K_z = k * at.B_z;
    const Real gamma_2 = gamma_squared(u, per_c_squared);
    const Real gamma = common::square_root(gamma_2);
    const Real part = 2.0 / (gamma_2 + K_x * K_x + K_y * K_y + K_z * K_z);
    const Real w_x = u.y * K_z - u.z * K_y, w_y = u.z * K_x - u.x * K_z,
               w_z = u.x * K_y - u.y * K_x;
    u.x += part * (gamma * w_x + w_y * K_z - w_z * K_y);
    u.y += part * (gamma * w_y + w_z * K_x - w_x * K_z);
    u.z += part * (gamma * w_z + w_x * K_y - w_y * K_x);
}

/// Boris's step from u^{n-1/2} to u^{n+1/2}: half the kick of E, the rotation about B, the other
/// half.
/// in:     half_kick = q dt / 2m; per_c_squared = 1/c^2, or 0 for a push that is not relativistic.
// [boris]
template <class Real>
inline void push(Velocity<Real>& u, const LocalField<Real>& at, double half_kick,
                 double per_c_squared) {
    u.x += half_kick * at.E_x, u.y += half_kick * at.E_y, u.z += half_kick * at.E_z;
    rotate(u, at, half_kick / c, per_c_squared);
    u.x += half_kick * at.E_x, u.y += half_kick * at.E_y, u.z += half_kick * at.E_z;
}
// [/boris]

/// What is kept between steps; nothing of it is state.
struct CurrentScratch {
    std::vector<StripCurrent> strips;
    Field smoothed;
};

inline constexpr long rows_of_strip = 4;

namespace detail {

inline double per_c_squared(const LeapfrogSettings& settings) {
    return settings.relativistic ? 1 / (c * c) : 0;
}

// Adds a strip's current to the mesh; what lies beyond the ghosts of a periodic mesh, to its image.
inline void add_strip(const Grid& grid, const StripCurrent& strip, double q, double dt,
                      VectorField& J) {
    const auto image = [](const common::Axis& axis, long k) {
        return k < -1 ? k + axis.cells : k > axis.cells + 1 ? k - axis.cells : k;
    };
    const double per_x = q / (grid.z.spacing() * dt), per_y = q / grid.cell_area(),
                 per_z = q / (grid.x.spacing() * dt);
    for (long row = strip.first_row; row < strip.first_row + strip.rows; ++row) {
        const long j = image(grid.z, row);
        for (long column = -StripCurrent::margin; column < strip.columns - StripCurrent::margin;
             ++column) {
            const long to = grid.index(image(grid.x, column), j);
            const auto from = static_cast<std::size_t>(strip.index(column, row));
            J.x()[to] += per_x * strip.J_x[from];
            J.y()[to] += per_y * strip.J_y[from];
            J.z()[to] += per_z * strip.J_z[from];
        }
    }
}

}  // namespace detail

/// Moves every particle of one species from t^n to t^{n+1} and adds its current to J.
/// in:     field, E^n and B^n, ghosts filled; dt [1/omega_pi], c dt below a cell.
/// in/out: particles, sorted by home before, not after; J^{n+1/2}, before fold_current.
/// out:    how many particles cross more than a cell (they must be none).
/// exact:  rho^{n+1} - rho^n + dt div J = 0 on every node, to round-off.
template <int l>
inline long move_particles(const PushField& field, const Grid& grid, double dt,
                           const LeapfrogSettings& settings, Particles& particles,
                           CurrentScratch& scratch, VectorField& J) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    const double per_c_squared = detail::per_c_squared(settings);
    const long columns = Homes<l>::count(grid.x), rows = Homes<l>::count(grid.z);
    const long strips = (rows + rows_of_strip - 1) / rows_of_strip;
    std::vector<long> lost(static_cast<std::size_t>(strips), 0);
    scratch.strips.resize(static_cast<std::size_t>(strips));

    common::for_each_row(strips, [&](long part) {
        StripCurrent& strip = scratch.strips[static_cast<std::size_t>(part)];
        const long first_row = part * rows_of_strip,
                   last_row = std::min(rows, first_row + rows_of_strip);
        strip.clear(grid, first_row, last_row);
        std::vector<long> leaving;
        for (long row = first_row; row < last_row; ++row) {
            const double z_home = grid.z.at(static_cast<double>(row));
            const double low_z = Homes<l>::low_of(grid.z, row),
                         high_z = Homes<l>::high_of(grid.z, row);
            const bool wraps_z = grid.z.periodic && (row == 0 || row == rows - 1);
            for (long column = 0; column < columns; ++column) {
                const std::size_t home = static_cast<std::size_t>(row * columns + column);
                const long begin = particles.first_of_node[home],
                           end = particles.first_of_node[home + 1];
                if (begin == end) continue;
                const double x_home = grid.x.at(static_cast<double>(column));
                const double low_x = Homes<l>::low_of(grid.x, column),
                             high_x = Homes<l>::high_of(grid.x, column);
                const bool wraps_x = grid.x.periodic && (column == 0 || column == columns - 1);
                const NodeField* corner = &field[static_cast<std::size_t>(
                    grid.index(column + Homes<l>::first, row + Homes<l>::first))];
                leaving.resize(static_cast<std::size_t>(end - begin + common::simd_width));
                long leaving_count = 0;

                PathSums<l, SimdVector> paths;
                for (long p = begin; p < end; p += common::simd_width) {
                    const long count = std::min<long>(end - p, common::simd_width);
                    SimdVector x = common::load_simd(&particles.x_p[p], count);
                    SimdVector z = common::load_simd(&particles.z_p[p], count);
                    Velocity<SimdVector> u{common::load_simd(&particles.vx_p[p], count),
                                           common::load_simd(&particles.vy_p[p], count),
                                           common::load_simd(&particles.vz_p[p], count)};
                    const SimdVector d_x = (x - x_home) * per_dx, d_z = (z - z_home) * per_dz;
                    push<SimdVector>(u,
                                     gather_at_home<l, SimdVector>(corner, grid.stride(), d_x, d_z),
                                     half_kick, per_c_squared);
                    const SimdVector way = dt * inverse_gamma(u, per_c_squared);  // dt / gamma
                    const SimdVector D_x = way * u.x * per_dx, D_z = way * u.z * per_dz;
                    const SimdVector to_x = d_x + D_x, to_z = d_z + D_z;

                    // Who stays at home is moved and counted here; who leaves is noted.
                    SimdVector stays = common::first_simd(count);
                    stays = to_x >= low_x ? stays : 0.0 * stays;
                    stays = to_x <= high_x ? stays : 0.0 * stays;
                    stays = to_z >= low_z ? stays : 0.0 * stays;
                    stays = to_z <= high_z ? stays : 0.0 * stays;
                    paths.add(d_x, d_z, stays * D_x, stays * D_z, stays * way * u.y * (1 / dt));
                    x += stays * way * u.x;
                    z += stays * way * u.z;
                    if (wraps_x) detail::wrap(grid.x, x);
                    if (wraps_z) detail::wrap(grid.z, z);
                    for (int k = 0; k < common::simd_width; ++k) {
                        leaving[static_cast<std::size_t>(leaving_count)] = p + k;
                        leaving_count += k < count && stays[k] == 0.0;
                    }
                    common::store_simd(x, &particles.x_p[p], count);
                    common::store_simd(z, &particles.z_p[p], count);
                    common::store_simd(u.x, &particles.vx_p[p], count);
                    common::store_simd(u.y, &particles.vy_p[p], count);
                    common::store_simd(u.z, &particles.vz_p[p], count);
                }
                strip.take(column, row, paths,
                           [](const SimdVector& sum) { return common::simd_sum(sum); });

                for (long k = 0; k < leaving_count; ++k) {
                    const auto p = static_cast<std::size_t>(leaving[static_cast<std::size_t>(k)]);
                    const Velocity<double> u{particles.vx_p[p], particles.vy_p[p],
                                             particles.vz_p[p]};
                    const double way = dt * inverse_gamma(u, per_c_squared);
                    detail::Leg x{column, (particles.x_p[p] - x_home) * per_dx, way * u.x * per_dx};
                    detail::Leg z{row, (particles.z_p[p] - z_home) * per_dz, way * u.z * per_dz};
                    if (!(std::fabs(x.D) <= 1 && std::fabs(z.D) <= 1)) {
                        ++lost[static_cast<std::size_t>(part)];
                        continue;
                    }
                    follow_path<l>(grid, way * u.y / dt, x, z, strip);
                    particles.x_p[p] = detail::end_of<l>(grid.x, x);
                    particles.z_p[p] = detail::end_of<l>(grid.z, z);
                    particles.vx_p[p] *= x.sign;
                    particles.vz_p[p] *= z.sign;
                }
            }
        }
    });
    for (const StripCurrent& strip : scratch.strips) {
        detail::add_strip(grid, strip, particles.q_p, dt, J);
    }
    long total = 0;
    for (const long n : lost) total += n;
    return total;
}

/// Moves all species. out: J^{n+1/2} of the plasma and of its images behind conducting walls,
/// smoothed, ghosts filled.
/// errors: NumericalError when a particle crosses more than a cell.
inline void move_particles(const PushField& field, const Grid& grid, double dt,
                           const LeapfrogSettings& settings, const SmoothingSettings& smoothing,
                           std::vector<Particles>& species, CurrentScratch& scratch,
                           VectorField& J) {
    J.all.setZero();
    for (Particles& particles : species) {
        const long lost = settings.order == 1
                              ? move_particles<1>(field, grid, dt, settings, particles, scratch, J)
                              : move_particles<2>(field, grid, dt, settings, particles, scratch, J);
        if (lost > 0) {
            throw common::NumericalError(std::to_string(lost) + " of the " + particles.name +
                                         " cross more than a cell in one step: the field has "
                                         "blown up; reduce time.dt");
        }
    }
    for (std::size_t a = 0; a < 3; ++a) {
        common::fold_ghosts(grid, electric.place[a], electric.parity[a],
                            J.all.data() + static_cast<long>(a) * grid.size());
    }
    smooth(grid, electric, smoothing, J.all.data(), scratch.smoothed);
}

}  // namespace implicit_moment
