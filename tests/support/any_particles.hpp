// What the tests of particles need: some of them, what they deposit, and the fields they feel.
#pragma once

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <vector>

#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/move_particles.hpp"
#include "implicit_moment/sort_particles.hpp"
#include "tests/support/any_fields.hpp"

namespace facts {

using Vector = Eigen::Vector3d;
constexpr MoverSettings tight{1e-14, 100};

inline std::size_t index(long n) { return std::size_t(n); }

inline std::vector<Grid> meshes() {
    std::vector<Grid> all;
    for (const int ends : {0, 1, 2, 3}) {
        all.push_back({{8, -2, 4, ends % 2 == 0}, {7, 0.5, 2.1, ends < 2}});
    }
    all.push_back({{8, -2, 4, false, true}, {7, 0.5, 2.1, false}});  // the ends of a tail
    return all;
}

inline Particles no_particles() {
    Particles particles;
    particles.name = "ions", particles.q_p = 0.7, particles.m_p = 1.3;
    return particles;
}
inline void add(Particles& particles, double x, double z, const Vector& v) {
    particles.x_p.push_back(x), particles.z_p.push_back(z);
    particles.ux_p.push_back(v[0]), particles.uy_p.push_back(v[1]), particles.uz_p.push_back(v[2]);
}
inline Vector velocity(const Particles& particles, std::size_t p) {
    return {particles.ux_p[p], particles.uy_p[p], particles.uz_p[p]};
}
inline void sort(const Grid& grid, Particles& particles) {
    SortScratch scratch;
    sort_particles(grid, scratch, particles);
}

// Particles all over the mesh; every fifth stands on an end of it.
inline Particles anywhere(const Grid& grid, int count, double speed, Random& random) {
    Particles particles = no_particles();
    const auto place = [&](const common::Axis& axis, int kind) {
        if (kind < 2) return kind == 0 ? axis.low : axis.high();
        return axis.low + axis.length * 0.5 * (1 + random());
    };
    for (int p = 0; p < count; ++p) {
        const double x = place(grid.x, p % 20), z = place(grid.z, p / 2 % 20);
        add(particles, x, z, speed * random.vector());
    }
    sort(grid, particles);
    return particles;
}

inline double apart(const common::Axis& axis, double a, double b) {
    return std::fabs(axis.periodic ? std::remainder(a - b, axis.length) : a - b);
}
// The largest difference of a position or a velocity.
inline double difference(const Grid& grid, const Particles& a, const Particles& b) {
    REQUIRE(a.count() == b.count());
    double largest = 0;
    for (std::size_t p = 0; p < a.x_p.size(); ++p) {
        largest =
            worst({largest, apart(grid.x, a.x_p[p], b.x_p[p]), apart(grid.z, a.z_p[p], b.z_p[p]),
                   (velocity(a, p) - velocity(b, p)).norm()});
    }
    return largest;
}
inline bool identical(const Particles& a, const Particles& b) {
    return a.x_p == b.x_p && a.z_p == b.z_p && a.ux_p == b.ux_p && a.uy_p == b.uy_p &&
           a.uz_p == b.uz_p;
}

inline double largest(const Grid& grid, Place place, const Field& f) {
    double value = 0;
    for_each_distinct(grid, place, [&](long, long, long n) {
        value = worst({value, std::fabs(f[n])});
    });
    return value;
}
inline double total(const Grid& grid, Place place, const Field& f) {
    double sum = 0;
    for_each_distinct(grid, place, [&](long i, long j, long n) {
        sum += weight(grid.x, place.half_x, i) * weight(grid.z, place.half_z, j) * f[n];
    });
    return sum * grid.cell_area();
}
inline Moments deposited(const Grid& grid, const Particles& particles) {
    Moments moments(grid);
    deposit_moments(particles, grid, moments);
    return moments;
}

inline InterleavedField pack(const Grid& grid, const VectorField& E, const VectorField& B) {
    InterleavedField push;
    for (long n = 0; n < grid.size(); ++n) {
        push.push_back({E.x()[n], E.y()[n], E.z()[n], B.x()[n], B.y()[n], B.z()[n]});
    }
    return push;
}
inline InterleavedField uniform(const Grid& grid, const Vector& E, const Vector& B) {
    return InterleavedField(index(grid.size()), NodeField{E[0], E[1], E[2], B[0], B[1], B[2]});
}
inline InterleavedField random_push(const Grid& grid, double E, double B, Random& random) {
    return pack(grid, random.field(grid, current, E), random.field(grid, magnetic, B));
}

// The fields d cells from node (i, j), and at a point.
using Local = LocalField<double>;
inline Local gathered(const Grid& grid, const InterleavedField& push, long i, long j, double d_x,
                      double d_z) {
    return gather_field(&push[index(grid.index(i - 1, j - 1))], grid.stride(), d_x, d_z);
}
inline Local gathered(const Grid& grid, const InterleavedField& push, double x, double z) {
    const double s = (x - grid.x.low) / grid.x.spacing(), t = (z - grid.z.low) / grid.z.spacing();
    const long i = std::lround(s), j = std::lround(t);
    return gathered(grid, push, i, j, s - real(i), t - real(j));
}

}  // namespace facts
