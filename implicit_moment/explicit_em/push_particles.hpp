// grid -> particles -> grid: Boris's push, the move, and the current of the trajectories, in one
// sweep through the particles.
//
//     u^{n+1/2} - u^{n-1/2} = q dt/m [ E^n + u/(gamma c) x B^n ],   u = gamma v
//     x^{n+1} - x^n = dt v^{n+1/2}
//
// Fields are gathered with the splines that deposit J: then, in short steps, E does on particles the
// work that J takes from the mesh, and a mesh that does not resolve the Debye length does not by
// itself heat a plasma at rest. Particles that share a cell go several at a time; the trajectories of
// the few that leave it are cut into segments one by one (deposit_current.hpp), and they are taken out
// (crossings.hpp).
#pragma once

#include <vector>

#include "common/parallel.hpp"
#include "common/run/sentence.hpp"
#include "implicit_moment/explicit_em/boris_push.hpp"
#include "implicit_moment/explicit_em/crossings.hpp"
#include "implicit_moment/explicit_em/deposit_current.hpp"
#include "implicit_moment/explicit_em/exchange_borders.hpp"
#include "implicit_moment/field/smooth.hpp"

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

/// Sets stays to 0 where a position is beyond an end of the mesh: behind a wall, or to be wrapped.
inline void keep_within(const common::Axis& axis, const ParticleVector& x, ParticleVector& stays) {
    stays = x >= not_below(axis.low) ? stays : 0.0 * stays;
    stays = x < not_below(axis.high()) ? stays : 0.0 * stays;
}

/// The fraction of the displacement D after which a particle at d is at a border of its cell; 2 where D = 0.
inline ParticleVector to_border(const ParticleVector& d, const ParticleVector& D, ParticleReal low,
                                ParticleReal high) {
    const ParticleVector to = D > 0.0 ? high - d : low - d, way = D == 0.0 ? 1.0 + D : D;
    return D == 0.0 ? 2.0 + D : to / way;
}

/// The fraction of the step within the cell: the smaller of both directions, from 0 to 1, as in deposit_current.
inline ParticleVector first_part(const ParticleVector& x, const ParticleVector& z) {
    ParticleVector part = x <= z ? x : z;
    part = part > 0.0 ? part : 0.0 * x;
    return part < 1.0 ? part : 1.0 + 0.0 * x;
}

/// Room for the current, kept between steps; nothing of it is state.
struct CurrentScratch {
    std::vector<CurrentTile> tiles;
    Field smoothed;
};

/// Moves every particle of one species from t^n to t^{n+1} and adds its current to J.
/// in:     field, E^n and B^n, ghosts filled; dt [1/omega_pi], c dt below a cell.
/// in/out: particles, sorted by cell; J^{n+1/2}, before its ghosts are folded.
/// out:    crossings, those that have left their cell; of each cell, the first crossings.staying[cell] of
///         its particles are good, the rest of its range is free. How many particles cross more than a
///         cell (they must be none).
/// exact:  rho^{n+1} - rho^n + dt div J = 0 on every node, to round-off.
template <int l>
inline long move_particles(const InterleavedField& field, const Grid& grid, double dt,
                           const LeapfrogSettings& settings, Particles& particles,
                           Crossings& crossings, CurrentScratch& scratch, VectorField& J) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing(),
                 half_kick = 0.5 * dt * particles.q_p / particles.m_p,
                 per_c_squared = settings.per_c_squared();
    // The same as particles have them.
    using Vector = ParticleVector;
    constexpr int lanes = lanes_of<Vector>;
    const auto cells_per_x = ParticleReal(per_dx), cells_per_z = ParticleReal(per_dz),
               kick = ParticleReal(half_kick), per_c2 = ParticleReal(per_c_squared),
               step = ParticleReal(dt), per_step = ParticleReal(1 / dt);
    const long columns = Stencil<l>::cells(grid.x), rows = Stencil<l>::cells(grid.z),
               tiles = tiles_of(rows);
    std::vector<long> lost(tiles, 0);
    scratch.tiles.resize(tiles);
    const Division& of_ranks = particles.of_ranks;
    crossings.clear(columns * rows, cells_of_tile<l>(grid), of_ranks);

    common::for_each_row(of_ranks.end(tiles) - of_ranks.begin(), [&](long mine) {
        const long number = of_ranks.begin() + mine;
        CurrentTile& tile = scratch.tiles[number];
        const long first_row = number * rows_of_tile,
                   last_row = std::min(rows, first_row + rows_of_tile);
        Crossings::OfTile& crossing = crossings.tiles[number];
        tile.clear(grid, first_row, last_row);
        std::vector<long> leaving;
        for (long row = first_row; row < last_row; ++row) {
            const double z_anchor = grid.z.at(double(row));
            const auto low_z = ParticleReal(Stencil<l>::low_of(grid.z, row)),
                       high_z = ParticleReal(Stencil<l>::high_of(grid.z, row));
            const bool at_end_z = row == 0 || row == rows - 1;
            for (long column = 0; column < columns; ++column) {
                const long cell = row * columns + column;
                const long begin = particles.first_of_node[cell],
                           end = particles.first_of_node[cell + 1];
                if (begin == end) continue;
                const double x_anchor = grid.x.at(double(column));
                const auto x_of_cell = ParticleReal(x_anchor), z_of_cell = ParticleReal(z_anchor);
                const auto low_x = ParticleReal(Stencil<l>::low_of(grid.x, column)),
                           high_x = ParticleReal(Stencil<l>::high_of(grid.x, column));
                const bool at_end_x = column == 0 || column == columns - 1;
                const NodeField* corner =
                    &field[grid.index(column + Stencil<l>::first, row + Stencil<l>::first)];
                leaving.resize(end - begin + lanes);
                long leaving_count = 0;

                CurrentSums<l, Vector> sums;
                for (long p = begin; p < end; p += lanes) {
                    const long count = std::min<long>(end - p, lanes);
                    const auto load = [&](const std::vector<ParticleReal>& q) {
                        return load_simd<Vector>(&q[p], count);
                    };
                    const Vector x = load(particles.x_p), z = load(particles.z_p);
                    Velocity<Vector> u{load(particles.ux_p), load(particles.uy_p),
                                       load(particles.uz_p)};
                    const Vector d_x = (x - x_of_cell) * cells_per_x,
                                 d_z = (z - z_of_cell) * cells_per_z;
                    push<Vector>(u, gather_field<l, Vector>(corner, grid.stride(), d_x, d_z), kick,
                                 per_c2);
                    const Vector way = step * inverse_gamma(u, per_c2);  // dt / gamma
                    const Vector to_x = x + way * u.x, to_z = z + way * u.z;
                    const Vector D_x = way * u.x * cells_per_x, D_z = way * u.z * cells_per_z;
                    const Vector i = Stencil<l>::from_border(grid.x, per_dx, to_x),
                                 j = Stencil<l>::from_border(grid.z, per_dz, to_z);

                    // Move those that stay in the cell, note the others, and deposit all the way
                    // that they have within the cell.
                    const Vector here = first_simd<Vector>(count);
                    Vector stays = i >= ParticleReal(column) ? here : 0.0 * here;
                    stays = i < ParticleReal(column + 1) ? stays : 0.0 * stays;
                    stays = j >= ParticleReal(row) ? stays : 0.0 * stays;
                    stays = j < ParticleReal(row + 1) ? stays : 0.0 * stays;
                    if (at_end_x) keep_within(grid.x, to_x, stays);
                    if (at_end_z) keep_within(grid.z, to_z, stays);
                    Vector part = stays;
                    if (any_simd(stays < here)) {
                        const Vector first = first_part(to_border(d_x, D_x, low_x, high_x),
                                                        to_border(d_z, D_z, low_z, high_z));
                        part = stays < here ? first : stays;
                        for (int k = 0; k < lanes; ++k) {
                            leaving[leaving_count] = p + k;
                            leaving_count += k < count && stays[k] == 0.0;
                        }
                    }
                    sums.add(d_x, d_z, part * D_x, part * D_z, part * way * u.y * per_step);
                    store_simd(stays > 0.0 ? to_x : x, &particles.x_p[p], count);
                    store_simd(stays > 0.0 ? to_z : z, &particles.z_p[p], count);
                    store_simd(u.x, &particles.ux_p[p], count);
                    store_simd(u.y, &particles.uy_p[p], count);
                    store_simd(u.z, &particles.uz_p[p], count);
                }
                tile.add(column, row, sums);

                // Cut the trajectories of the others where they cross from cell to cell, take them
                // out, and let the last of the cell step in.
                long last = end;
                for (long k = leaving_count - 1; k >= 0; --k) {
                    const long p = leaving[k];
                    const Velocity<double> u{particles.ux_p[p], particles.uy_p[p],
                                             particles.uz_p[p]};
                    const double way = dt * inverse_gamma(u, per_c_squared);
                    Trajectory x{column, (particles.x_p[p] - x_anchor) * per_dx,
                                 way * u.x * per_dx};
                    Trajectory z{row, (particles.z_p[p] - z_anchor) * per_dz, way * u.z * per_dz};
                    if (!(std::fabs(x.D) <= 1 && std::fabs(z.D) <= 1)) {
                        ++lost[number];
                        continue;
                    }
                    deposit_current<l>(grid, way * u.y / dt, x, z, tile);
                    const ParticleReal to_x = carried(grid.x, x.end(grid.x)),
                                       to_z = carried(grid.z, z.end(grid.z));
                    crossing.to_cell.push_back(cell_of<l>(grid, to_x, to_z));
                    crossing.quantities.push_back({to_x, to_z, ParticleReal(x.sign * u.x),
                                                   ParticleReal(u.y), ParticleReal(z.sign * u.z)});
                    --last;
                    for (std::vector<ParticleReal>* q : particles.all()) (*q)[p] = (*q)[last];
                }
                crossings.staying[cell] = int(last - begin);
            }
        }
    });
    exchange_current(grid, of_ranks, rows, scratch.tiles);
    for (const CurrentTile& tile : scratch.tiles) tile.add_to_mesh(grid, particles.q_p, dt, J);
    long total = 0;
    for (const long n : lost) total += n;
    return of_ranks.is_whole() ? total : common::sum_over_ranks(total);
}

/// Moves all species. out: crossings of each; J^{n+1/2} of the plasma and of its images behind conducting walls,
/// smoothed, ghosts filled.
/// errors: NumericalError when a particle crosses more than a cell.
inline void move_particles(const InterleavedField& field, const Grid& grid, double dt,
                           const LeapfrogSettings& settings, const SmoothingSettings& smoothing,
                           std::vector<Particles>& species, std::vector<Crossings>& crossings,
                           CurrentScratch& scratch, VectorField& J) {
    J.all.setZero();
    crossings.resize(species.size());
    for (std::size_t k = 0; k < species.size(); ++k) {
        Particles& particles = species[k];
        const long lost =
            settings.order == 1
                ? move_particles<1>(field, grid, dt, settings, particles, crossings[k], scratch, J)
                : move_particles<2>(field, grid, dt, settings, particles, crossings[k], scratch, J);
        if (lost > 0) {
            common::fail(lost, " of the ", particles.name,
                         " cross more than a cell in one step: they were loaded too fast, or the "
                         "field has blown up; reduce time.dt");
        }
    }
    if (!species.empty())
        gather_rows(grid, rows_of(species.front().of_ranks, nodes_z(grid)),
                    rows_of_vector(grid, J));
    fold_ghosts(grid, felt(grid), J.all.data());
    smooth(grid, felt(grid), smoothing, J.all.data(), scratch.smoothed);
}

}  // namespace implicit_moment
