// grid -> particles: the implicit midpoint rule in E^{n+theta}, with the magnetic rotation of
// every particle done exactly as the rule says.
//
//     x_half = x^n + dt/2 vbar
//     vbar   = v^n + q dt/2m [ E^{n+theta}(x_half) + vbar x B(x_half) / c ]
//     x^{n+1} = x^n + dt vbar,   v^{n+1} = 2 vbar - v^n
//
// and with relativistic particles, u = gamma v, vbar = (u^n + u^{n+1}) / (gamma^n + gamma^{n+1}).
//
// The rule is iterated until the midpoint stands still. Particles that share a nearest node see
// the same 3 x 3 mesh values, so several of them are iterated at once; the few whose midpoint
// leaves the neighborhood of that node, or that meet a wall, are moved one by one (move_one.hpp).
#pragma once

#include <algorithm>
#include <vector>

#include "common/parallel.hpp"
#include "common/ranks.hpp"
#include "common/run/sentence.hpp"
#include "implicit_moment/move_one.hpp"

namespace implicit_moment {

/// What a move of one species needed.
struct MoverReport {
    long one_by_one = 0;   // particles moved one by one
    long sub_stepped = 0;  // particles that needed more than one sub-step
    long lost = 0;         // particles not followed even in 1024 sub-steps: the run must end
};

namespace detail {

// The part of a node's cell that lies inside the mesh, as center and half-width in cells.
struct Cell {
    double center = 0, half = 0.5;
    Cell(const common::Axis& axis, long node) {
        if (axis.periodic || (node > 0 && node < axis.cells)) return;
        center = node == 0 ? 0.25 : -0.25;
        half = 0.25;
    }
};

// How far a coordinate is behind a wall, in cells; not positive inside, 0 in a periodic direction.
inline SimdVector behind_wall(const common::Axis& axis, const SimdVector& x, double per_dx) {
    if (axis.periodic) return SimdVector{};
    return larger(axis.low - x, x - axis.high()) * per_dx;
}

template <class Dynamics>
inline MoverReport move_particles(Dynamics, const InterleavedField& field, const Grid& grid,
                                  double dt, const MoverSettings& settings, Particles& particles) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing(), h = 0.5 * dt;
    const double charge_over_mass = particles.q_p / particles.m_p;
    const double half_kick = charge_over_mass * h;
    const long row_length = nodes_x(grid);
    std::vector<MoverReport> report_of_row(nodes_z(grid));

    common::for_each_row(nodes_z(grid), [&](long row) {
        MoverReport& report = report_of_row[row];
        const double z_node = grid.z.at(double(row));
        const detail::Cell cell_z(grid.z, row);
        for (long column = 0; column < row_length; ++column) {
            const long node = row * row_length + column;
            const long begin = particles.first_of_node[node],
                       end = particles.first_of_node[node + 1];
            const double x_node = grid.x.at(double(column));
            const detail::Cell cell_x(grid.x, column);
            const NodeField* corner = &field[grid.index(column - 1, row - 1)];

            for (long p = begin; p < end; p += simd_width) {
                const long count = std::min<long>(end - p, simd_width);
                SimdVector x = load_simd(&particles.x_p[p], count);
                SimdVector z = load_simd(&particles.z_p[p], count);
                Velocity<SimdVector> u{load_simd(&particles.ux_p[p], count),
                                       load_simd(&particles.uy_p[p], count),
                                       load_simd(&particles.uz_p[p], count)};
                const SimdVector from_x = (x - x_node) * per_dx, from_z = (z - z_node) * per_dz;

                // Iterate all midpoints; note how far each strays beyond the node's cell.
                Velocity<SimdVector> vbar = Dynamics::velocity(u);
                SimdVector outside{}, change{}, gamma = SimdVector{} + 1.0;
                for (long iteration = 0; iteration < settings.max_iterations; ++iteration) {
                    const SimdVector d_x = from_x + (h * per_dx) * vbar.x,
                                     d_z = from_z + (h * per_dz) * vbar.z;
                    outside = larger(outside, larger(magnitude(d_x - cell_x.center) - cell_x.half,
                                                     magnitude(d_z - cell_z.center) - cell_z.half));
                    const auto at = gather_field<SimdVector>(corner, grid.stride(), d_x, d_z);
                    const auto [next, next_gamma] =
                        Dynamics::template mean<SimdVector>(u, at, half_kick);
                    change = larger(magnitude(next.x - vbar.x) * (h * per_dx),
                                    magnitude(next.z - vbar.z) * (h * per_dz));
                    change = outside > 0.0 ? 0.0 * change : change;
                    // By component: a copy of the whole goes through memory in pieces.
                    vbar.x = next.x, vbar.y = next.y, vbar.z = next.z, gamma = next_gamma;
                    if (iteration > 0 && !any_simd(change > settings.tolerance)) break;
                }

                outside = larger(outside, detail::behind_wall(grid.x, x + dt * vbar.x, per_dx));
                outside = larger(outside, detail::behind_wall(grid.z, z + dt * vbar.z, per_dz));

                // Move the others one by one.
                for (long l = 0; l < count; ++l) {
                    if (outside[l] <= 0 && change[l] <= settings.tolerance) continue;
                    const double start_x = x[l], start_z = z[l];
                    const Velocity<double> start_u{u.x[l], u.y[l], u.z[l]};
                    double x_1 = start_x, z_1 = start_z;
                    Velocity<double> u_1 = start_u;
                    int parts = 1;
                    while (!move_one<Dynamics>(grid, field, settings, charge_over_mass, dt, parts,
                                               x_1, z_1, u_1)) {
                        x_1 = start_x, z_1 = start_z, u_1 = start_u;
                        parts *= 2;
                        if (parts > 1024) {
                            ++report.lost;
                            break;
                        }
                    }
                    ++report.one_by_one;
                    if (parts > 1) ++report.sub_stepped;
                    // Put the moved particle back among them, such that the update below
                    // leaves it where it is.
                    x[l] = x_1, z[l] = z_1;
                    vbar.x[l] = vbar.y[l] = vbar.z[l] = 0;
                    u.x[l] = -u_1.x, u.y[l] = -u_1.y, u.z[l] = -u_1.z;
                }

                x += dt * vbar.x;
                z += dt * vbar.z;
                wrap(grid.x, x);
                wrap(grid.z, z);
                store_simd(x, &particles.x_p[p], count);
                store_simd(z, &particles.z_p[p], count);
                store_simd(2.0 * gamma * vbar.x - u.x, &particles.ux_p[p], count);
                store_simd(2.0 * gamma * vbar.y - u.y, &particles.uy_p[p], count);
                store_simd(2.0 * gamma * vbar.z - u.z, &particles.uz_p[p], count);
            }
        }
    });

    MoverReport total;
    for (const MoverReport& row : report_of_row) {
        total.one_by_one += row.one_by_one;
        total.sub_stepped += row.sub_stepped;
        total.lost += row.lost;
    }
    return total;
}

}  // namespace detail

/// Moves every particle of one species from t^n to t^{n+1}.
/// in:     field, the smoothed E^{n+theta} and B, ghosts filled; dt [1/omega_pi].
/// in/out: particles, sorted by nearest node before, not after.
/// exact:  no work by B; the midpoint rule to settings.tolerance.
/// source: slide "Implicit Moment Method", particle equations; the rotation of [IMM-12].
/// note:   a particle whose midpoint leaves the node's cell and that would cross more than a cell
///         is moved in as many sub-steps as keep it within one, each with the field of the cell it
///         is in; with the field of one point it would run away.
inline MoverReport move_particles(const InterleavedField& field, const Grid& grid, double dt,
                                  const MoverSettings& settings, Particles& particles) {
    return with_dynamics(particles, [&](auto dynamics) {
        return detail::move_particles(dynamics, field, grid, dt, settings, particles);
    });
}

/// Moves all species. errors: NumericalError when a particle cannot be followed even in 1024
/// sub-steps.
inline void move_particles(const InterleavedField& field, const Grid& grid, double dt,
                           const MoverSettings& settings, std::vector<Particles>& species) {
    for (Particles& particles : species) {
        const MoverReport report = move_particles(field, grid, dt, settings, particles);
        if (const long lost = common::sum_over_ranks(report.lost); lost > 0) {
            common::fail(
                lost, " of the ", particles.name,
                " cannot be followed in 1024 sub-steps: the field has blown up; reduce time.dt");
        }
    }
}

}  // namespace implicit_moment
