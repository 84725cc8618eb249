// Facts about what the particles of implicit_moment deposit on the mesh and feel from it.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "common/splines.hpp"
#include "tests/support/any_particles.hpp"

namespace {

using namespace facts;

// In the order of Moments::all(): place, orders of the splines, powers of v_x, v_y, v_z.
struct Definition {
    Place place;
    int order_x, order_z, x, y, z;
};
constexpr std::array<Definition, 9> definitions{{{on_nodes, 2, 2, 0, 0, 0},
                                                 {on_x_edges, 1, 2, 1, 0, 0},
                                                 {on_nodes, 2, 2, 0, 1, 0},
                                                 {on_z_edges, 2, 1, 0, 0, 1},
                                                 {on_nodes, 0, 2, 2, 0, 0},
                                                 {on_nodes, 2, 0, 0, 0, 2},
                                                 {on_faces, 1, 1, 1, 0, 1},
                                                 {on_x_edges, 1, 2, 1, 1, 0},
                                                 {on_z_edges, 2, 1, 0, 1, 1}}};

// The double sum over points and particles, with their periodic or mirror images.
Field by_definition(const Grid& grid, const Particles& particles, const Definition& d) {
    const auto sum_of_images = [](const common::Axis& axis, int order, int power, double point,
                                  double x, double v) {
        const double s = (x - axis.low) / axis.spacing(), n = real(axis.cells);
        const auto S = [&](double at) { return common::spline(order, at - point); };
        const double images =
            axis.periodic ? S(s - n) + S(s + n) : (power % 2 ? -1 : 1) * (S(-s) + S(2 * n - s));
        return (S(s) + images) * std::pow(v, power);
    };
    Field f = Field::Zero(grid.size());
    for_each_distinct(grid, d.place, [&](long i, long j, long n) {
        const double x = real(i) + 0.5 * d.place.half_x, z = real(j) + 0.5 * d.place.half_z;
        for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
            const Vector v = velocity(particles, p);
            f[n] += particles.q_p / grid.cell_area() * std::pow(v[1], d.y) *
                    sum_of_images(grid.x, d.order_x, d.x, x, particles.x_p[p], v[0]) *
                    sum_of_images(grid.z, d.order_z, d.z, z, particles.z_p[p], v[2]);
        }
    });
    return f;
}

}  // namespace

// ---- deposit ------------------------------------------------------------------------------------

TEST_CASE("deposited moments are the sums over particles and images with their splines") {
    Random random;
    for (const Grid& grid : meshes()) {
        // 1 particle at a node, 2 at the next, ... 17: lanes that are full and every remainder.
        Particles clusters = no_particles();
        for (int count = 1; count <= 17; ++count) {
            for (int p = 0; p < count; ++p) {
                add(clusters, grid.x.at(1 + count % 6 + 0.5 * random()),
                    grid.z.at(1 + count / 6 * 2 + 0.5 * random()), random.vector());
            }
        }
        sort(grid, clusters);
        for (const Particles& particles : {clusters, anywhere(grid, 300, 1, random)}) {
            Moments moments = deposited(grid, particles);
            for (std::size_t k = 0; k < definitions.size(); ++k) {
                const Definition& d = definitions[k];
                const Field expected = by_definition(grid, particles, d);
                Field f = *moments.all()[k];
                CHECK(largest(grid, d.place, f - expected) <=
                      16 * eps * largest(grid, d.place, expected));
                // Ghosts are filled; a part normal to a wall is odd, so zero on the wall itself.
                const Parity parity{d.x % 2 ? -1 : 1, d.z % 2 ? -1 : 1};
                common::fill_ghosts(grid, d.place, parity, f.data());
                CHECK(f == *moments.all()[k]);
            }
        }
    }
}

TEST_CASE("the mesh holds the total charge and current and the sums of energy and momentum") {
    Random random;
    for (const Grid& grid : meshes()) {
        const Particles particles = anywhere(grid, 2000, 1, random);
        const Moments moments = deposited(grid, particles);
        const double q = particles.q_p, m = particles.m_p, n = real(particles.count());
        Vector sum = Vector::Zero();
        long double squares = 0;
        for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
            sum += velocity(particles, p), squares += velocity(particles, p).squaredNorm();
        }
        const Vector J(total(grid, on_x_edges, moments.J_x), total(grid, on_nodes, moments.J_y),
                       total(grid, on_z_edges, moments.J_z));
        CHECK(std::fabs(total(grid, on_nodes, moments.rho) - q * n) <= 4 * eps * n);
        // The current into a wall is not kept.
        CHECK(std::fabs(J[1] - q * sum[1]) <= eps * n);
        if (grid.x.periodic) CHECK(std::fabs(J[0] - q * sum[0]) <= eps * n);
        if (grid.z.periodic) CHECK(std::fabs(J[2] - q * sum[2]) <= eps * n);
        for (std::size_t a = 0; a < 3; ++a) {
            CHECK(std::fabs(moments.momentum[a] - m * sum[long(a)]) <= eps * n);
        }
        const double energy = 0.5 * m * double(squares);
        CHECK(std::fabs(moments.kinetic_energy / energy - 1) <= 8 * eps);
    }
}

TEST_CASE("a uniform lattice of particles has a uniform density up to the walls") {
    for (const Grid& grid : meshes()) {
        Particles particles = no_particles();
        for (double x = 0.125; x < real(grid.x.cells); x += 0.25) {
            for (double z = 0.25; z < real(grid.z.cells); z += 0.5) {
                add(particles, grid.x.at(x), grid.z.at(z), {0.3, 0.4, 0.5});
            }
        }
        sort(grid, particles);
        const Moments moments = deposited(grid, particles);
        const auto uneven = [&](const Field& f, double value) {
            const double rho = 8 * particles.q_p / grid.cell_area();
            return largest(grid, on_nodes, f / rho - Field::Constant(grid.size(), value));
        };
        CHECK(uneven(moments.rho, 1) <= 32 * eps);
        CHECK(uneven(moments.J_y, 0.4) <= 32 * eps);
        CHECK(uneven(moments.P_xx, 0.09) <= 32 * eps);
        CHECK(uneven(moments.P_zz, 0.25) <= 32 * eps);
    }
}

// Within its cell a particle in free flight deposits polynomials of at most fourth order in time,
// for which differences over five times are exact.
TEST_CASE("continuity of charge and of momentum is exact in continuous time") {
    Random random;
    for (const Grid& grid : meshes()) {
        Particles start = no_particles();
        const auto near = [&](const common::Axis& axis, long node) {
            const double side = node == 0 ? 1 : node == axis.cells ? -1 : random();
            return axis.at(real(node) + std::copysign(0.25 + 0.05 * random(), side));
        };
        for (long j = 0; j <= grid.z.cells; ++j) {
            for (long i = 0; i <= grid.x.cells; ++i) {
                add(start, near(grid.x, i), near(grid.z, j), random.vector());
            }
        }
        const auto flown = [&](double t) {
            Particles particles = start;
            for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
                particles.x_p[p] += t * particles.ux_p[p];
                particles.z_p[p] += t * particles.uz_p[p];
            }
            sort(grid, particles);
            return particles;
        };
        const auto at = [&](double t) { return deposited(grid, flown(t)); };
        const double h = 0.02, dx = grid.x.spacing(), dz = grid.z.spacing();
        const Moments m = at(0), early = at(-2 * h), before = at(-h), after = at(h),
                      late = at(2 * h);
        const auto rate = [&](Field Moments::*f) -> Field {
            return (early.*f - 8 * before.*f + 8 * after.*f - late.*f) / (12 * h);
        };
        VectorField div_P(grid), J(grid);
        const long s = grid.stride(), size = grid.size();
        for_each_point(grid, [&](long n) {
            div_P.x()[n] = (m.P_xx[n + 1] - m.P_xx[n]) / dx + (m.P_xz[n] - m.P_xz[n - s]) / dz;
            div_P.y()[n] = (m.P_xy[n] - m.P_xy[n - 1]) / dx + (m.P_yz[n] - m.P_yz[n - s]) / dz;
            div_P.z()[n] = (m.P_xz[n] - m.P_xz[n - 1]) / dx + (m.P_zz[n + s] - m.P_zz[n]) / dz;
        });
        fill_ghosts(grid, current, div_P);
        J.all << m.J_x, m.J_y, m.J_z;
        const double tolerance = 64 * eps * start.q_p / grid.cell_area() / h;
        Field div = Field::Zero(size);
        divergence_of_electric(grid, J.all.data(), div);
        CHECK(largest(grid, on_nodes, rate(&Moments::rho) + div) <= tolerance);
        CHECK(largest(grid, on_x_edges, rate(&Moments::J_x) + div_P.all.head(size)) <= tolerance);
        CHECK(largest(grid, on_nodes, rate(&Moments::J_y) + div_P.all.segment(size, size)) <=
              tolerance);
        CHECK(largest(grid, on_z_edges, rate(&Moments::J_z) + div_P.all.tail(size)) <= tolerance);

        // The same for charge and current with the conductor's images behind the walls.
        const auto imaged = [&](double t) {
            Moments moments(grid);
            deposit_moments(flown(t), grid, VectorField(grid), h, moments);
            return moments;
        };
        const Moments image = imaged(0);
        const Field rate_of_image =
            (imaged(-2 * h).rho - 8 * imaged(-h).rho + 8 * imaged(h).rho - imaged(2 * h).rho) /
            (12 * h);
        VectorField J_image(grid);
        J_image.all << image.J_x, image.J_y, image.J_z;
        divergence_of_electric(grid, J_image.all.data(), div);
        CHECK(largest(grid, on_nodes, rate_of_image + div) <= tolerance);

        // Over a whole step, with the current that the pressure has made by half time.
        const auto missing = [&](double dt) {
            VectorField half = J;
            half.all -= 0.5 * dt * div_P.all;
            divergence_of_electric(grid, half.all.data(), div);
            return largest(grid, on_nodes, at(dt).rho - m.rho + dt * div);
        };
        CHECK(std::fabs(missing(0.02) / missing(0.01) - 8) <= 0.2);
    }
}

// ---- gather -------------------------------------------------------------------------------------

TEST_CASE("the work done on particles is the work of the deposited current also at walls") {
    Random random;
    for (const Grid& grid : meshes()) {
        const Particles particles = anywhere(grid, 1000, 1, random);
        for (const bool conductor : {false, true}) {
            // Behind a wall: the mirrored plasma of the slide's moments, or what the field
            // equations have there.
            const VectorKind kind = conductor ? felt(grid) : current;
            const VectorField E = random.field(grid, kind, 1);
            const InterleavedField push = pack(grid, E, VectorField(grid));
            Moments moments(grid);
            if (conductor) {
                deposit_moments(particles, grid, VectorField(grid), 0.1, moments);
            } else {
                deposit_moments(particles, grid, moments);
            }
            double work = 0;
            for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
                const Local at = gathered(grid, push, particles.x_p[p], particles.z_p[p]);
                work += particles.q_p * velocity(particles, p).dot(Vector(at.E_x, at.E_y, at.E_z));
            }
            const std::array J{&moments.J_x, &moments.J_y, &moments.J_z};
            for (std::size_t a = 0; a < 3; ++a) {
                const Field part = E.all.segment(long(a) * grid.size(), grid.size());
                work -= total(grid, kind.place[a], J[a]->cwiseProduct(part));
            }
            CHECK(std::fabs(work) <= 0.2 * eps * real(particles.count()));
        }
    }
}

// Within a cell the gathered field is quadratic, so that central differences are exact.
TEST_CASE("the gathered gradient is the gradient of the gathered potential and div B is zero") {
    Random random;
    for (const Grid& grid : meshes()) {
        const double dx = grid.x.spacing(), dz = grid.z.spacing(), h = 0.1;
        const auto [E, B] = gradient_and_curl(grid, random);
        const InterleavedField push = pack(grid, E, B);
        const double tolerance = 2 * eps / h / dz / dz;
        for (int sample = 0; sample < 300; ++sample) {
            const long i = std::lround(4 * (1 + random())), j = std::lround(3.5 * (1 + random()));
            const double d_x = 0.4 * random(), d_z = 0.4 * random();
            const Local at = gathered(grid, push, i, j, d_x, d_z),
                        left = gathered(grid, push, i, j, d_x - h, d_z),
                        right = gathered(grid, push, i, j, d_x + h, d_z),
                        down = gathered(grid, push, i, j, d_x, d_z - h),
                        up = gathered(grid, push, i, j, d_x, d_z + h);
            CHECK(std::fabs(at.E_x + (right.E_y - left.E_y) / (2 * h * dx)) <= tolerance);
            CHECK(std::fabs(at.E_z + (up.E_y - down.E_y) / (2 * h * dz)) <= tolerance);
            CHECK(std::fabs((right.B_x - left.B_x) / dx + (up.B_z - down.B_z) / dz) <=
                  2 * h * tolerance);
            // From one cell to the next nothing jumps.
            const Local a = gathered(grid, push, 3, 2, 0.5, d_z),
                        b = gathered(grid, push, 4, 2, -0.5, d_z);
            CHECK(std::fabs(a.E_x - b.E_x) + std::fabs(a.E_y - b.E_y) + std::fabs(a.E_z - b.E_z) +
                      std::fabs(a.B_x - b.B_x) + std::fabs(a.B_y - b.B_y) +
                      std::fabs(a.B_z - b.B_z) <=
                  16 * eps / dz);
        }
    }
}
