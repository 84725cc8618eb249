// What the tests of explicit_em need: its particles and their steps, and by definition what a path
// gives to the mesh.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/splines.hpp"
#include "implicit_moment/explicit_em/deposit_charge_and_current.hpp"
#include "implicit_moment/explicit_em/push_particles.hpp"
#include "implicit_moment/explicit_em/sort_by_cell.hpp"
#include "implicit_moment/explicit_em/yee_field.hpp"
#include "tests/support/any_particles.hpp"

namespace facts {

inline void sort(const Grid& grid, long order, Particles& particles) {
    SortScratch scratch;
    order == 1 ? sort_by_cell<1>(grid, scratch, particles)
               : sort_by_cell<2>(grid, scratch, particles);
}

// Position in cells, rounded as the sort by cells rounds it.
inline double in_cells(const common::Axis& axis, double x) {
    return (x - axis.low) * (1 / axis.spacing());
}

inline double per_c_squared(bool relativistic) { return relativistic ? 1 / (c * c) : 0; }

// v of u = gamma v.
inline Vector true_velocity(const Particles& particles, std::size_t p, bool relativistic) {
    const Vector u = velocity(particles, p);
    return u / std::sqrt(1 + per_c_squared(relativistic) * u.squaredNorm());
}

// What round-off may leave of a sum over particles on a node when each of so many, anywhere on the
// mesh, gives at most so much: positions are known to eps of the length of the mesh, sums to eps.
inline double round_off(const Grid& grid, long order, std::size_t count, double each) {
    const double n =
        real(long(count) * (order + 1) * (order + 1)) / real(grid.x.cells * grid.z.cells);
    return n * (n + real(std::max(grid.x.cells, grid.z.cells))) * eps * each;
}

// Particles on the ends of the mesh, on borders of cells, in corners and anywhere else, that go up
// to so many cells per step in both directions.
inline Particles travelers(const Grid& grid, int count, double dt, double cells, bool relativistic,
                           Random& random) {
    Particles particles = no_particles();
    const auto place = [&](const common::Axis& axis) {
        const auto kind = std::lround(5.5 + 5.5 * random());
        const double end = axis.periodic ? std::nextafter(axis.high(), axis.low) : axis.high();
        const double s = 0.5 * real(axis.cells) * (1 + random());
        if (kind < 2) return kind == 0 ? axis.low : end;
        return kind < 6 ? std::min(end, axis.at(0.5 * std::round(2 * s))) : axis.at(s);
    };
    for (int p = 0; p < count; ++p) {
        const double x = place(grid.x), z = place(grid.z);
        const Vector v = cells / dt *
                         Vector(grid.x.spacing() * random(), 0.5 * grid.z.spacing() * random(),
                                grid.z.spacing() * random());
        add(particles, x, z, v / std::sqrt(1 - per_c_squared(relativistic) * v.squaredNorm()));
    }
    return particles;
}

// The sort that ends a step.
inline void sort_after_push(const Grid& grid, long order, Crossings& crossings,
                            Particles& particles) {
    sort_by_cell(order == 1 ? cells_of_tile<1>(grid) : cells_of_tile<2>(grid), crossings,
                 particles);
}

// One step of one species; J as deposited, folded with the images of the given kind.
inline VectorField current_of_step(const Grid& grid, const InterleavedField& push, double dt,
                                   long order, bool relativistic, const VectorKind& kind,
                                   Particles& particles) {
    const LeapfrogSettings settings{true, order, relativistic};
    CurrentScratch scratch;
    Crossings crossings;
    VectorField J(grid);
    sort(grid, order, particles);
    CHECK((order == 1
               ? move_particles<1>(push, grid, dt, settings, particles, crossings, scratch, J)
               : move_particles<2>(push, grid, dt, settings, particles, crossings, scratch, J)) ==
          0);
    sort_after_push(grid, order, crossings, particles);
    fold_ghosts(grid, kind, J.all.data());
    return J;
}

inline double largest(const Grid& grid, const VectorKind& kind, const VectorField& f) {
    double most = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        most = worst({most, largest(grid, kind.place[a],
                                    f.all.segment(long(a) * grid.size(), grid.size()))});
    }
    return most;
}

// The fields at a point, whatever its cell.
inline Local felt(const Grid& grid, const InterleavedField& push, long order, double s, double t) {
    const auto at = [&]<int l>(std::integral_constant<int, l>) {
        const long i = Stencil<l>::cell_of(grid.x, s), j = Stencil<l>::cell_of(grid.z, t);
        return gather_field<l, double>(
            &push[index(grid.index(i + Stencil<l>::first, j + Stencil<l>::first))], grid.stride(),
            s - real(i), t - real(j));
    };
    return order == 1 ? at(std::integral_constant<int, 1>{}) : at(std::integral_constant<int, 2>{});
}

// ---- by definition ------------------------------------------------------------------------------

// The spline of a point at s cells, and of its images, at every distinct node or midpoint.
inline std::vector<double> spline_and_images(const common::Axis& axis, long order, bool half,
                                             int parity, double s) {
    std::vector<double> all;
    const double n = real(axis.cells);
    for (long i = 0; i < points(axis, half); ++i) {
        const auto S = [&](double at) {
            return common::spline(int(order), at - real(i) - 0.5 * half);
        };
        all.push_back(S(s) +
                      (axis.periodic ? S(s - n) + S(s + n) : parity * (S(-s) + S(2 * n - s))));
    }
    return all;
}

inline void add_product(const Grid& grid, double factor, const std::vector<double>& x,
                        const std::vector<double>& z, double* f) {
    for (std::size_t j = 0; j < z.size(); ++j) {
        for (std::size_t i = 0; i < x.size(); ++i)
            f[grid.index(long(i), long(j))] += factor * x[i] * z[j];
    }
}

// Charge with the images of the given sign behind walls.
inline Field charge(const Grid& grid, long order, Parity images, const Particles& particles) {
    Field rho = Field::Zero(grid.size());
    for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
        const double s = in_cells(grid.x, particles.x_p[p]), t = in_cells(grid.z, particles.z_p[p]);
        add_product(grid, particles.q_p / grid.cell_area(),
                    spline_and_images(grid.x, order, false, images.x, s),
                    spline_and_images(grid.z, order, false, images.z, t), rho.data());
    }
    return rho;
}
inline Field charge(const Grid& grid, long order, int sign, const Particles& particles) {
    return charge(grid, order, Parity{sign, sign}, particles);
}

// A straight flight seen from within the mesh: where it is, and the sign of its velocity there.
struct Seen {
    double s, sign = 1;
    Seen(const common::Axis& axis, double at) : s(at) {
        const double n = real(axis.cells);
        if (axis.periodic) {
            s -= n * std::floor(s / n);
        } else {
            s -= 2 * n * std::floor(s / (2 * n));
            sign = s <= n ? 1 : -1;
            s = std::min(s, 2 * n - s);
        }
    }
};

// Calls visit(part of the step, x, z) at the points of Gauss's rule on each piece of a flight in
// one cell. With as many points as the order that is the rule of the scheme, which is exact for J_x
// and J_z; with three it is exact for J_y, too.
template <class Visit>
void along_path(const Grid& grid, long order, long rule, double s, double t, double D_x, double D_z,
                const Visit& visit) {
    using Rule = std::vector<std::pair<double, double>>;  // points on [-1, 1], weights
    const std::vector<Rule> rules{
        {{0, 1}},
        {{-std::sqrt(1.0 / 3), 0.5}, {std::sqrt(1.0 / 3), 0.5}},
        {{-std::sqrt(0.6), 5.0 / 18}, {0, 8.0 / 18}, {std::sqrt(0.6), 5.0 / 18}}};
    std::vector<double> cuts{0, 1};
    const auto cut = [&](const common::Axis& axis, double from, double D) {
        for (double line = std::floor(std::min(from, from + D)); line <= std::max(from, from + D);
             line += 0.5) {
            const bool node = line == std::floor(line);
            const bool wall = !axis.periodic && (line == 0 || line == real(axis.cells));
            const double part = (line - from) / D;
            if ((wall || node == (order == 1)) && part > 0 && part < 1) cuts.push_back(part);
        }
    };
    cut(grid.x, s, D_x);
    cut(grid.z, t, D_z);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 1; k < cuts.size(); ++k) {
        const double length = cuts[k] - cuts[k - 1];
        for (const auto& [at, weight] : rules[index(rule - 1)]) {
            const double time = cuts[k - 1] + 0.5 * (1 + at) * length;
            visit(weight * length, Seen(grid.x, s + time * D_x), Seen(grid.z, t + time * D_z));
        }
    }
}

// The mean current of free flights over a step; behind walls the plasma's own images (sign +1) or
// a conductor's (-1).
inline VectorField current_of_flight(const Grid& grid, double dt, long order, long rule,
                                     bool relativistic, int sign, const Particles& particles) {
    VectorField J(grid);
    for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
        const Vector v = true_velocity(particles, p, relativistic);
        const auto visit = [&](double part, const Seen& x, const Seen& z) {
            const double q = part * particles.q_p / grid.cell_area();
            const auto node_x = spline_and_images(grid.x, order, false, sign, x.s),
                       node_z = spline_and_images(grid.z, order, false, sign, z.s);
            add_product(grid, q * v[0] * x.sign,
                        spline_and_images(grid.x, order - 1, true, -sign, x.s), node_z, J.x());
            add_product(grid, q * v[1], node_x, node_z, J.y());
            add_product(grid, q * v[2] * z.sign, node_x,
                        spline_and_images(grid.z, order - 1, true, -sign, z.s), J.z());
        };
        along_path(grid, order, rule, in_cells(grid.x, particles.x_p[p]),
                   in_cells(grid.z, particles.z_p[p]), dt * v[0] / grid.x.spacing(),
                   dt * v[2] / grid.z.spacing(), visit);
    }
    fill_ghosts(grid, sign > 0 ? current : electric, J);
    return J;
}

}  // namespace facts
