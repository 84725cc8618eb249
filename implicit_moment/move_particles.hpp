// grid -> particles: the implicit midpoint rule in E^{n+theta}, with the magnetic rotation of
// every particle done exactly as the rule says.
//
//     x_half = x^n + dt/2 vbar
//     vbar   = v^n + q dt/2m [ E^{n+theta}(x_half) + vbar x B(x_half) / c ]
//     x^{n+1} = x^n + dt vbar,   v^{n+1} = 2 vbar - v^n
//
// The rule is iterated until the midpoint stands still. Particles that share a nearest node see
// the same 3 x 3 mesh values, so eight of them are iterated at once; the few whose midpoint
// leaves the neighborhood of that node are moved one by one.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/lanes.hpp"
#include "common/parallel.hpp"
#include "common/parameters.hpp"
#include "implicit_moment/push_field.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

using common::Lanes;

struct MoverSettings {
    double tolerance =
        1e-3;  // the midpoint stands still when an iteration moves it by less [cells]
    long max_iterations = 20;
};

struct MoverReport {
    long one_by_one = 0;   // particles moved one by one
    long sub_stepped = 0;  // particles that needed more than one sub-step
    long lost =
        0;  // particles whose iteration did not converge even with 1024 sub-steps: the run must end
};

template <class Real>
struct Velocity {
    Real x, y, z;
};

/// Mean velocity of a step: vbar = v_t + (v_t x O) + ... solved for vbar = v_t + vbar x O.
///     vbar = [ v_t + v_t x O + (v_t . O) O ] / (1 + O^2),   v_t = v + q dt/2m E,   O = q dt B /
///     (2 m c)
/// in: v^n; local fields; half_kick = q dt / 2m.   exact: vbar - vbar x O = v_t.   source:
///        [IMM-12] for one particle.
template <class Real>
inline Velocity<Real> mean_velocity(const Velocity<Real>& v, const LocalField<Real>& at,
                                    double half_kick) {
    const Real t_x = v.x + half_kick * at.E_x, t_y = v.y + half_kick * at.E_y,
               t_z = v.z + half_kick * at.E_z;
    const double per_c = half_kick / c;
    const Real O_x = per_c * at.B_x, O_y = per_c * at.B_y, O_z = per_c * at.B_z;
    const Real dot = t_x * O_x + t_y * O_y + t_z * O_z;
    const Real scale = 1.0 / (1.0 + O_x * O_x + O_y * O_y + O_z * O_z);
    return {scale * (t_x + t_y * O_z - t_z * O_y + dot * O_x),
            scale * (t_y + t_z * O_x - t_x * O_z + dot * O_y),
            scale * (t_z + t_x * O_y - t_y * O_x + dot * O_z)};
}

namespace detail {

// Where the mesh ends: a coordinate is brought back inside, and the normal velocity is turned
// around at a wall.
inline void keep_inside(const common::Axis& axis, Lanes& x, Lanes& v) {
    const double low = axis.low, high = axis.high();
    if (axis.periodic) {
        x = x < low ? x + axis.length : x;
        x = x >= high ? x - axis.length : x;
    } else {
        v = x < low || x > high ? -v : v;
        x = x < low ? 2 * low - x : x;
        x = x > high ? 2 * high - x : x;
    }
}

inline void keep_inside(const common::Axis& axis, double& x, double& v) {
    if (axis.periodic) {
        x -= axis.length * std::floor((x - axis.low) / axis.length);
        if (x >= axis.high()) x = axis.low;
    } else if (x < axis.low || x > axis.high()) {
        v = -v;
        x = std::clamp(x < axis.low ? 2 * axis.low - x : 2 * axis.high() - x, axis.low,
                       axis.high());
    }
}

// Position of a midpoint for the gather: periodic image, or the wall itself while the path is
// behind it.
inline double seen_at(const common::Axis& axis, double x) {
    if (axis.periodic) return x - axis.length * std::floor((x - axis.low) / axis.length);
    return std::clamp(x, axis.low, axis.high());
}

// The part of a node's cell that lies inside the mesh, as center and half-width in cells.
struct Cell {
    double center = 0, half = 0.5;
    Cell(const common::Axis& axis, long node) {
        if (axis.periodic || (node > 0 && node < axis.cells)) return;
        center = node == 0 ? 0.25 : -0.25;
        half = 0.25;
    }
};

// One particle through one step in `parts` equal sub-steps; false when a sub-step crosses more
// than a cell or does not converge.
inline bool move_one(const Grid& grid, const PushField& field, const MoverSettings& settings,
                     double half_kick, double dt, int parts, double& x, double& z,
                     Velocity<double>& v) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double h = 0.5 * dt / parts, kick = half_kick / parts;
    for (int part = 0; part < parts; ++part) {
        Velocity<double> u = v;
        bool converged = false;
        for (long iteration = 0; iteration < settings.max_iterations && !converged; ++iteration) {
            const double s = (seen_at(grid.x, x + h * u.x) - grid.x.low) * per_dx;
            const double t = (seen_at(grid.z, z + h * u.z) - grid.z.low) * per_dz;
            const long i = static_cast<long>(s + 0.5), j = static_cast<long>(t + 0.5);
            const auto at =
                gather_field(&field[static_cast<std::size_t>(grid.index(i - 1, j - 1))],
                             grid.stride(), s - static_cast<double>(i), t - static_cast<double>(j));
            const Velocity<double> next = mean_velocity(v, at, kick);
            const double change =
                std::max(std::fabs(next.x - u.x) * per_dx, std::fabs(next.z - u.z) * per_dz) * h;
            u = next;
            converged = change <= settings.tolerance && iteration > 0;
        }
        if (!converged || !(2 * h * std::fabs(u.x) * per_dx <= 1) ||
            !(2 * h * std::fabs(u.z) * per_dz <= 1)) {
            return false;
        }
        x += 2 * h * u.x;
        z += 2 * h * u.z;
        v = {2 * u.x - v.x, 2 * u.y - v.y, 2 * u.z - v.z};
        keep_inside(grid.x, x, v.x);
        keep_inside(grid.z, z, v.z);
    }
    return true;
}

}  // namespace detail

/// Moves every particle of one species from t^n to t^{n+1}.
/// in: field, the smoothed E^{n+theta} and B, ghosts filled; dt [1/omega_pi]. in/out: particles,
///        sorted by nearest node before, not after.
/// exact: no work by B; the midpoint rule to settings.tolerance.   source: slide "Implicit Moment
///        Method", particle equations.
/// note: a particle that would cross more than a cell in a step is moved in as many sub-steps as
///        keep it within one, each with the field of the cell it is in; with the field of one
///        point it would run away.
inline MoverReport move_particles(const PushField& field, const Grid& grid, double dt,
                                  const MoverSettings& settings, Particles& particles) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing(), h = 0.5 * dt;
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    const long columns = nodes_x(grid);
    std::vector<MoverReport> report_of_row(static_cast<std::size_t>(nodes_z(grid)));

    common::for_each_row(nodes_z(grid), [&](long row) {
        MoverReport& report = report_of_row[static_cast<std::size_t>(row)];
        const double z_node = grid.z.at(static_cast<double>(row));
        const detail::Cell cell_z(grid.z, row);
        for (long column = 0; column < columns; ++column) {
            const std::size_t node = static_cast<std::size_t>(row * columns + column);
            const long begin = particles.first_of_node[node],
                       end = particles.first_of_node[node + 1];
            const double x_node = grid.x.at(static_cast<double>(column));
            const detail::Cell cell_x(grid.x, column);
            const NodeField* corner =
                &field[static_cast<std::size_t>(grid.index(column - 1, row - 1))];

            for (long p = begin; p < end; p += common::lane_count) {
                const long count = std::min<long>(end - p, common::lane_count);
                Lanes x = common::load_lanes(&particles.x_p[p], count);
                Lanes z = common::load_lanes(&particles.z_p[p], count);
                Velocity<Lanes> v{common::load_lanes(&particles.vx_p[p], count),
                                  common::load_lanes(&particles.vy_p[p], count),
                                  common::load_lanes(&particles.vz_p[p], count)};
                const Lanes from_x = (x - x_node) * per_dx, from_z = (z - z_node) * per_dz;

                // Iterate all eight midpoints; note how far each strays beyond the node's cell.
                Velocity<Lanes> u = v;
                Lanes outside{}, change{};
                for (long iteration = 0; iteration < settings.max_iterations; ++iteration) {
                    const Lanes d_x = from_x + (h * per_dx) * u.x,
                                d_z = from_z + (h * per_dz) * u.z;
                    outside = common::larger(
                        outside,
                        common::larger(common::magnitude(d_x - cell_x.center) - cell_x.half,
                                       common::magnitude(d_z - cell_z.center) - cell_z.half));
                    const auto at = gather_field<Lanes>(corner, grid.stride(), d_x, d_z);
                    const Velocity<Lanes> next = mean_velocity<Lanes>(v, at, half_kick);
                    change = common::larger(common::magnitude(next.x - u.x) * (h * per_dx),
                                            common::magnitude(next.z - u.z) * (h * per_dz));
                    change = outside > 0.0 ? 0.0 * change : change;
                    u = next;
                    if (iteration > 0 && common::largest_lane(change) <= settings.tolerance) break;
                }

                // The rest, one by one.
                for (long l = 0; l < count; ++l) {
                    if (outside[l] <= 0 && change[l] <= settings.tolerance) continue;
                    const std::size_t q = static_cast<std::size_t>(p + l);
                    const double start_x = particles.x_p[q], start_z = particles.z_p[q];
                    const Velocity<double> start_v{particles.vx_p[q], particles.vy_p[q],
                                                   particles.vz_p[q]};
                    double x_1 = start_x, z_1 = start_z;
                    Velocity<double> v_1 = start_v;
                    int parts = 1;
                    while (!detail::move_one(grid, field, settings, half_kick, dt, parts, x_1, z_1,
                                             v_1)) {
                        x_1 = start_x, z_1 = start_z, v_1 = start_v;
                        parts *= 2;
                        if (parts > 1024) {
                            ++report.lost;
                            break;
                        }
                    }
                    ++report.one_by_one;
                    if (parts > 1) ++report.sub_stepped;
                    // Hand the finished particle to the eight, such that the update below leaves
                    // it where it is.
                    x[l] = x_1, z[l] = z_1;
                    u.x[l] = u.y[l] = u.z[l] = 0;
                    v.x[l] = -v_1.x, v.y[l] = -v_1.y, v.z[l] = -v_1.z;
                }

                x += dt * u.x;
                z += dt * u.z;
                v = {2.0 * u.x - v.x, 2.0 * u.y - v.y, 2.0 * u.z - v.z};
                detail::keep_inside(grid.x, x, v.x);
                detail::keep_inside(grid.z, z, v.z);
                common::store_lanes(x, &particles.x_p[p], count);
                common::store_lanes(z, &particles.z_p[p], count);
                common::store_lanes(v.x, &particles.vx_p[p], count);
                common::store_lanes(v.y, &particles.vy_p[p], count);
                common::store_lanes(v.z, &particles.vz_p[p], count);
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

/// Moves all species. errors: NumericalError when a particle cannot be followed even in 1024
/// sub-steps.
inline void move_particles(const PushField& field, const Grid& grid, double dt,
                           const MoverSettings& settings, std::vector<Particles>& species) {
    for (Particles& particles : species) {
        const MoverReport report = move_particles(field, grid, dt, settings, particles);
        if (report.lost > 0) {
            throw common::NumericalError(
                std::to_string(report.lost) + " of the " + particles.name +
                " cannot be followed in 1024 sub-steps: the field has blown up; reduce time.dt");
        }
    }
}

}  // namespace implicit_moment
