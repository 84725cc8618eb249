// grid -> particles -> grid: Boris's push, the move, and the current of the trajectories, in one
// sweep through the particles.
//
//     u^{n+1/2} - u^{n-1/2} = q dt/m [ E^n + u/(gamma c) x B^n ],   u = gamma v
//     x^{n+1} - x^n = dt v^{n+1/2}
//
// Fields are gathered with the splines that deposit J: then E does on particles the work that J
// takes from the mesh, and a plasma at rest is not heated by a mesh that does not resolve its Debye
// length. Particles that share a cell go several at a time; the trajectories of the few that leave it
// are cut into segments one by one (deposit_current.hpp).
#pragma once

#include <string>
#include <vector>

#include "common/parallel.hpp"
#include "common/run/parameters.hpp"
#include "implicit_moment/explicit_em/boris_push.hpp"
#include "implicit_moment/explicit_em/deposit_current.hpp"
#include "implicit_moment/smooth.hpp"

namespace implicit_moment {

/// Fields at a particle at distance d from the anchor of its cell.
///     E_x(x_p) = sum_g E_x,g S^(l-1)(x) S^(l)(z),  and so on, as J is deposited
/// in:     corner, the record of the lowest node that the stencil touches; stride between rows.
template <int l, class Real>
inline LocalField<Real> gather_field(const NodeField* corner, long stride, const Real& d_x,
                                     const Real& d_z) {
    const StencilWeights<l, Real> S_x(d_x), S_z(d_z);
    LocalField<Real> at{};
    for (int j = 0; j <= l; ++j) {
        const NodeField* f = corner + j * stride;
        Real E_x{}, E_y{}, B_z{};
        for (int i = 0; i < l; ++i) E_x += S_x.half(i) * f[i].E_x, B_z += S_x.half(i) * f[i].B_z;
        for (int i = 0; i <= l; ++i) E_y += S_x.node(i) * f[i].E_y;
        at.E_x += S_z.node(j) * E_x, at.E_y += S_z.node(j) * E_y, at.B_z += S_z.node(j) * B_z;
    }
    for (int j = 0; j < l; ++j) {
        const NodeField* f = corner + j * stride;
        Real E_z{}, B_x{}, B_y{};
        for (int i = 0; i <= l; ++i) E_z += S_x.node(i) * f[i].E_z, B_x += S_x.node(i) * f[i].B_x;
        for (int i = 0; i < l; ++i) B_y += S_x.half(i) * f[i].B_y;
        at.E_z += S_z.half(j) * E_z, at.B_x += S_z.half(j) * B_x, at.B_y += S_z.half(j) * B_y;
    }
    return at;
}

/// Room for the current, kept between steps; nothing of it is state.
struct CurrentScratch {
    std::vector<CurrentTile> tiles;
    Field smoothed;
};

inline constexpr long rows_of_tile = 4;

/// Moves every particle of one species from t^n to t^{n+1} and adds its current to J.
/// in:     field, E^n and B^n, ghosts filled; dt [1/omega_pi], c dt below a cell.
/// in/out: particles, sorted by cell before, not after; J^{n+1/2}, before its ghosts are folded.
/// out:    how many particles cross more than a cell (they must be none).
/// exact:  rho^{n+1} - rho^n + dt div J = 0 on every node, to round-off.
template <int l>
inline long move_particles(const InterleavedField& field, const Grid& grid, double dt,
                           const LeapfrogSettings& settings, Particles& particles,
                           CurrentScratch& scratch, VectorField& J) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    const double per_c_squared = settings.per_c_squared();
    const long columns = Stencil<l>::cells(grid.x), rows = Stencil<l>::cells(grid.z);
    const long tiles = (rows + rows_of_tile - 1) / rows_of_tile;
    std::vector<long> lost(tiles, 0);
    scratch.tiles.resize(tiles);

    common::for_each_row(tiles, [&](long part) {
        CurrentTile& tile = scratch.tiles[part];
        const long first_row = part * rows_of_tile,
                   last_row = std::min(rows, first_row + rows_of_tile);
        tile.clear(grid, first_row, last_row);
        std::vector<long> leaving;
        for (long row = first_row; row < last_row; ++row) {
            const double z_anchor = grid.z.at(double(row));
            const double low_z = Stencil<l>::low_of(grid.z, row),
                         high_z = Stencil<l>::high_of(grid.z, row);
            const bool wraps_z = grid.z.periodic && (row == 0 || row == rows - 1);
            for (long column = 0; column < columns; ++column) {
                const long cell = row * columns + column;
                const long begin = particles.first_of_node[cell],
                           end = particles.first_of_node[cell + 1];
                if (begin == end) continue;
                const double x_anchor = grid.x.at(double(column));
                const double low_x = Stencil<l>::low_of(grid.x, column),
                             high_x = Stencil<l>::high_of(grid.x, column);
                const bool wraps_x = grid.x.periodic && (column == 0 || column == columns - 1);
                const NodeField* corner =
                    &field[grid.index(column + Stencil<l>::first, row + Stencil<l>::first)];
                leaving.resize(end - begin + common::simd_width);
                long leaving_count = 0;

                CurrentSums<l, SimdVector> sums;
                for (long p = begin; p < end; p += common::simd_width) {
                    const long count = std::min<long>(end - p, common::simd_width);
                    SimdVector x = common::load_simd(&particles.x_p[p], count);
                    SimdVector z = common::load_simd(&particles.z_p[p], count);
                    Velocity<SimdVector> u{common::load_simd(&particles.ux_p[p], count),
                                           common::load_simd(&particles.uy_p[p], count),
                                           common::load_simd(&particles.uz_p[p], count)};
                    const SimdVector d_x = (x - x_anchor) * per_dx, d_z = (z - z_anchor) * per_dz;
                    push<SimdVector>(u,
                                     gather_field<l, SimdVector>(corner, grid.stride(), d_x, d_z),
                                     half_kick, per_c_squared);
                    const SimdVector way = dt * inverse_gamma(u, per_c_squared);  // dt / gamma
                    const SimdVector D_x = way * u.x * per_dx, D_z = way * u.z * per_dz;
                    const SimdVector to_x = d_x + D_x, to_z = d_z + D_z;

                    // Move and deposit the particles that stay in the cell; note the others.
                    SimdVector stays = common::first_simd(count);
                    stays = to_x >= low_x ? stays : 0.0 * stays;
                    stays = to_x <= high_x ? stays : 0.0 * stays;
                    stays = to_z >= low_z ? stays : 0.0 * stays;
                    stays = to_z <= high_z ? stays : 0.0 * stays;
                    sums.add(d_x, d_z, stays * D_x, stays * D_z, stays * way * u.y * (1 / dt));
                    x += stays * way * u.x;
                    z += stays * way * u.z;
                    if (wraps_x) wrap(grid.x, x);
                    if (wraps_z) wrap(grid.z, z);
                    for (int k = 0; k < common::simd_width; ++k) {
                        leaving[leaving_count] = p + k;
                        leaving_count += k < count && stays[k] == 0.0;
                    }
                    common::store_simd(x, &particles.x_p[p], count);
                    common::store_simd(z, &particles.z_p[p], count);
                    common::store_simd(u.x, &particles.ux_p[p], count);
                    common::store_simd(u.y, &particles.uy_p[p], count);
                    common::store_simd(u.z, &particles.uz_p[p], count);
                }
                tile.add(column, row, sums,
                         [](const SimdVector& sum) { return common::simd_sum(sum); });

                // Cut the trajectories of the others where they cross from cell to cell.
                for (long k = 0; k < leaving_count; ++k) {
                    const long p = leaving[k];
                    const Velocity<double> u{particles.ux_p[p], particles.uy_p[p],
                                             particles.uz_p[p]};
                    const double way = dt * inverse_gamma(u, per_c_squared);
                    Trajectory x{column, (particles.x_p[p] - x_anchor) * per_dx,
                                 way * u.x * per_dx};
                    Trajectory z{row, (particles.z_p[p] - z_anchor) * per_dz, way * u.z * per_dz};
                    if (!(std::fabs(x.D) <= 1 && std::fabs(z.D) <= 1)) {
                        ++lost[part];
                        continue;
                    }
                    deposit_current<l>(grid, way * u.y / dt, x, z, tile);
                    particles.x_p[p] = x.end(grid.x);
                    particles.z_p[p] = z.end(grid.z);
                    particles.ux_p[p] *= x.sign;
                    particles.uz_p[p] *= z.sign;
                }
            }
        }
    });
    for (const CurrentTile& tile : scratch.tiles) tile.add_to_mesh(grid, particles.q_p, dt, J);
    long total = 0;
    for (const long n : lost) total += n;
    return total;
}

/// Moves all species. out: J^{n+1/2} of the plasma and of its images behind conducting walls,
/// smoothed, ghosts filled.
/// errors: NumericalError when a particle crosses more than a cell.
inline void move_particles(const InterleavedField& field, const Grid& grid, double dt,
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
        common::fold_ghosts(grid, electric.place[a], felt(grid).parity[a],
                            J.all.data() + a * grid.size());
    }
    smooth(grid, felt(grid), smoothing, J.all.data(), scratch.smoothed);
}

}  // namespace implicit_moment
