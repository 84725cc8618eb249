// Facts about the particles of implicit_moment: what they deposit, what they feel, how they move, how they
// are loaded.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/initial_state.hpp"
#include "implicit_moment/move_particles.hpp"

namespace {

using namespace implicit_moment;
constexpr double eps = std::numeric_limits<double>::epsilon();

// Numbers between -1 and 1.
struct Random {
    std::mt19937_64 engine{1};
    double operator()() { return 0x1p-52 * static_cast<double>(engine() >> 11) - 1; }
    VectorField field(const Grid& grid, const VectorKind& kind, double amplitude = 1) {
        VectorField f(grid);
        for (double& value : f.all) value = amplitude * (*this)();
        fill_ghosts(grid, kind, f);
        return f;
    }
};

Grid mesh(bool periodic_x, bool periodic_z) {
    return {{8, -2, 4, periodic_x}, {7, 0.5, 2.1, periodic_z}};
}
std::vector<Grid> meshes() {
    return {mesh(true, true), mesh(true, false), mesh(false, true), mesh(false, false)};
}

Particles no_particles() {
    Particles particles;
    particles.name = "ions", particles.q_p = 0.7, particles.m_p = 1.3;
    return particles;
}
void add(Particles& particles, double x, double z, double v_x, double v_y, double v_z) {
    particles.x_p.push_back(x), particles.z_p.push_back(z);
    particles.vx_p.push_back(v_x), particles.vy_p.push_back(v_y), particles.vz_p.push_back(v_z);
}
void sort(const Grid& grid, Particles& particles) {
    SortScratch scratch;
    sort_particles(grid, scratch, particles);
}

// Particles all over the mesh; every fifth stands on an end of it.
Particles anywhere(const Grid& grid, long count, double speed, Random& random) {
    Particles particles = no_particles();
    for (long p = 0; p < count; ++p) {
        double x = grid.x.low + grid.x.length * 0.5 * (1 + random());
        double z = grid.z.low + grid.z.length * 0.5 * (1 + random());
        if (p % 10 == 3) x = p % 20 == 3 ? grid.x.low : grid.x.high();
        if (p % 10 == 7) z = p % 20 == 7 ? grid.z.low : grid.z.high();
        add(particles, x, z, speed * random(), speed * random(), speed * random());
    }
    sort(grid, particles);
    return particles;
}

bool same_bytes(const double* a, const double* b, long count) {
    return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof *a) == 0;
}
bool same_bytes(const Particles& a, const Particles& b) {
    const long n = a.count();
    return n == b.count() && same_bytes(a.x_p.data(), b.x_p.data(), n) &&
           same_bytes(a.z_p.data(), b.z_p.data(), n) &&
           same_bytes(a.vx_p.data(), b.vx_p.data(), n) &&
           same_bytes(a.vy_p.data(), b.vy_p.data(), n) &&
           same_bytes(a.vz_p.data(), b.vz_p.data(), n);
}

// Visits the distinct points of a place; w is the part of a point's cell that lies inside the mesh.
template <class Visit>
void for_each_distinct(const Grid& grid, Place place, const Visit& visit) {
    const bool ends_x = !grid.x.periodic && !place.half_x,
               ends_z = !grid.z.periodic && !place.half_z;
    for (long j = 0; j < grid.z.cells + ends_z; ++j) {
        for (long i = 0; i < grid.x.cells + ends_x; ++i) {
            const double w = (ends_x && i % grid.x.cells == 0 ? 0.5 : 1) *
                             (ends_z && j % grid.z.cells == 0 ? 0.5 : 1);
            visit(i, j, grid.index(i, j), w);
        }
    }
}
double largest(const Grid& grid, Place place, const Field& f) {
    double value = 0;
    for_each_distinct(grid, place, [&](long, long, long n, double) {
        value = std::fabs(f[n]) <= value ? value : std::fabs(f[n]);
    });
    return value;
}
double total(const Grid& grid, Place place, const Field& f) {
    double sum = 0;
    for_each_distinct(grid, place,
                      [&](long, long, long n, double w) { sum += w * f[n] * grid.cell_area(); });
    return sum;
}

// ---- the definitions of the moments --------------------------------------------------------------

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

// A particle and its images: position, and the sign of the velocity along this axis.
struct Image {
    double at;
    int sign;
};
std::array<Image, 3> images(const common::Axis& axis, double x) {
    if (axis.periodic) return {{{x, 1}, {x - axis.length, 1}, {x + axis.length, 1}}};
    return {{{x, 1}, {2 * axis.low - x, -1}, {2 * axis.high() - x, -1}}};
}

double power(double v, int exponent) { return exponent == 0 ? 1 : exponent == 1 ? v : v * v; }

// The double sum over points and particles.
Field by_definition(const Grid& grid, const Particles& particles, const Definition& d) {
    Field f = Field::Zero(grid.size());
    for_each_distinct(grid, d.place, [&](long i, long j, long n, double) {
        const double x = static_cast<double>(i) + 0.5 * d.place.half_x;
        const double z = static_cast<double>(j) + 0.5 * d.place.half_z;
        for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
            double S_x = 0, S_z = 0;
            for (const Image& image : images(grid.x, particles.x_p[p])) {
                S_x += power(image.sign * particles.vx_p[p], d.x) *
                       common::spline(d.order_x, (image.at - grid.x.low) / grid.x.spacing() - x);
            }
            for (const Image& image : images(grid.z, particles.z_p[p])) {
                S_z += power(image.sign * particles.vz_p[p], d.z) *
                       common::spline(d.order_z, (image.at - grid.z.low) / grid.z.spacing() - z);
            }
            f[n] += particles.q_p / grid.cell_area() * S_x * S_z * power(particles.vy_p[p], d.y);
        }
    });
    return f;
}

Moments deposited(const Grid& grid, const Particles& particles) {
    Moments moments(grid);
    deposit_moments(particles, grid, moments);
    return moments;
}

// ---- fields at particles -------------------------------------------------------------------------

PushField pack(const Grid& grid, const VectorField& E, const VectorField& B) {
    PushField push;
    for (long n = 0; n < grid.size(); ++n) {
        push.push_back({E.x()[n], E.y()[n], E.z()[n], B.x()[n], B.y()[n], B.z()[n]});
    }
    return push;
}
PushField uniform(const Grid& grid, std::array<double, 3> E, std::array<double, 3> B) {
    const NodeField same{E[0], E[1], E[2], B[0], B[1], B[2]};
    return PushField(static_cast<std::size_t>(grid.size()), same);
}

// The fields d cells from node (i, j).
LocalField<double> gathered(const Grid& grid, const PushField& push, long i, long j, double d_x,
                            double d_z) {
    return gather_field(&push[static_cast<std::size_t>(grid.index(i - 1, j - 1))], grid.stride(),
                        d_x, d_z);
}
LocalField<double> gathered(const Grid& grid, const PushField& push, double x, double z) {
    const double s = (x - grid.x.low) / grid.x.spacing(), t = (z - grid.z.low) / grid.z.spacing();
    const long i = std::lround(s), j = std::lround(t);
    return gathered(grid, push, i, j, s - static_cast<double>(i), t - static_cast<double>(j));
}
// The periodic image inside the mesh, and the distance between two positions or their images.
double wrapped(const common::Axis& axis, double x) {
    return axis.periodic ? x - axis.length * std::floor((x - axis.low) / axis.length) : x;
}
double apart(const common::Axis& axis, double a, double b) {
    return std::fabs(axis.periodic ? std::remainder(a - b, axis.length) : a - b);
}

constexpr MoverSettings tight{1e-14, 100};

}  // namespace

TEST_CASE("deposited moments are the sums over particles and images with their splines") {
    Random random;
    for (const Grid& grid : meshes()) {
        const Particles particles = anywhere(grid, 300, 1, random);
        Moments moments = deposited(grid, particles);
        for (std::size_t k = 0; k < definitions.size(); ++k) {
            const Definition& d = definitions[k];
            const Field expected = by_definition(grid, particles, d);
            const Field error = *moments.all()[k] - expected;
            CHECK(largest(grid, d.place, error) <= 16 * eps * largest(grid, d.place, expected));
            // The normal part of an odd moment is zero on the wall itself.
            Field again = *moments.all()[k];
            common::fill_ghosts(grid, d.place, {d.x % 2 ? -1 : 1, d.z % 2 ? -1 : 1}, again.data());
            CHECK(same_bytes(again.data(), moments.all()[k]->data(), grid.size()));
        }
    }
}

TEST_CASE("any number of particles at one node is counted by the eight lanes") {
    Random random;
    const Grid grid = mesh(true, false);
    for (long count = 1; count <= 17; ++count) {
        Particles particles = no_particles();
        for (long p = 0; p < count; ++p) {
            add(particles, grid.x.at(3 + 0.5 * random()), grid.z.at(2 + 0.5 * random()), random(),
                random(), random());
        }
        sort(grid, particles);
        Moments moments = deposited(grid, particles);
        for (std::size_t k = 0; k < definitions.size(); ++k) {
            const Field expected = by_definition(grid, particles, definitions[k]);
            const Field error = *moments.all()[k] - expected;
            CHECK(largest(grid, definitions[k].place, error) <= 1e-14 * static_cast<double>(count));
        }
    }
}

TEST_CASE("the mesh holds the total charge and current and the sums of energy and momentum") {
    Random random;
    for (const Grid& grid : meshes()) {
        const Particles particles = anywhere(grid, 2000, 1, random);
        const Moments moments = deposited(grid, particles);
        const double q = particles.q_p, m = particles.m_p,
                     n = static_cast<double>(particles.count());
        std::array<double, 3> sum{};
        long double energy = 0;
        for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
            const std::array v{particles.vx_p[p], particles.vy_p[p], particles.vz_p[p]};
            for (std::size_t a = 0; a < 3; ++a) sum[a] += v[a], energy += 0.5 * m * v[a] * v[a];
        }
        CHECK(std::fabs(total(grid, on_nodes, moments.rho) - q * n) <= eps * n);
        CHECK(std::fabs(total(grid, on_nodes, moments.J_y) - q * sum[1]) <= eps * n);
        // The current into a wall is not kept.
        if (grid.x.periodic) {
            CHECK(std::fabs(total(grid, on_x_edges, moments.J_x) - q * sum[0]) <= eps * n);
        }
        if (grid.z.periodic) {
            CHECK(std::fabs(total(grid, on_z_edges, moments.J_z) - q * sum[2]) <= eps * n);
        }
        CHECK(std::fabs(moments.kinetic_energy / static_cast<double>(energy) - 1) <= 8 * eps);
        for (std::size_t a = 0; a < 3; ++a) {
            CHECK(std::fabs(moments.momentum[a] - m * sum[a]) <= eps * n);
        }
    }
}

TEST_CASE("a uniform lattice of particles has a uniform density up to the walls") {
    for (const Grid& grid : meshes()) {
        Particles particles = no_particles();
        for (double x = 0.125; x < static_cast<double>(grid.x.cells); x += 0.25) {
            for (double z = 0.25; z < static_cast<double>(grid.z.cells); z += 0.5) {
                add(particles, grid.x.at(x), grid.z.at(z), 0.3, 0.4, 0.5);
            }
        }
        sort(grid, particles);
        const Moments moments = deposited(grid, particles);
        const double rho = 8 * particles.q_p / grid.cell_area();
        const auto uneven = [&](const Field& f, double value) {
            return largest(grid, on_nodes, f - Field::Constant(grid.size(), value)) / rho;
        };
        CHECK(uneven(moments.rho, rho) <= 16 * eps);
        CHECK(uneven(moments.J_y, 0.4 * rho) <= 16 * eps);
        CHECK(uneven(moments.P_xx, 0.09 * rho) <= 16 * eps);
        CHECK(uneven(moments.P_zz, 0.25 * rho) <= 16 * eps);
    }
}

// Within its cell a particle in free flight deposits polynomials of at most fourth order in time, for
// which differences over five times are exact.
TEST_CASE("continuity of charge and of momentum is exact in continuous time") {
    Random random;
    for (const Grid& grid : meshes()) {
        Particles start = no_particles();
        for (long j = 0; j <= grid.z.cells; ++j) {
            for (long i = 0; i <= grid.x.cells; ++i) {
                const auto near = [&](const common::Axis& axis, long node) {
                    const double side = node == 0 ? 1 : node == axis.cells ? -1 : random();
                    return axis.at(static_cast<double>(node) +
                                   std::copysign(0.25 + 0.05 * random(), side));
                };
                add(start, near(grid.x, i), near(grid.z, j), random(), random(), random());
            }
        }
        const auto at = [&](double t) {
            Particles particles = start;
            for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
                particles.x_p[p] += t * particles.vx_p[p];
                particles.z_p[p] += t * particles.vz_p[p];
            }
            sort(grid, particles);
            return deposited(grid, particles);
        };
        const double h = 0.02, dx = grid.x.spacing(), dz = grid.z.spacing();
        const long s = grid.stride();
        const Moments now = at(0);
        const Moments early = at(-2 * h), before = at(-h), after = at(h), late = at(2 * h);
        const auto rate = [&](Field Moments::*f) -> Field {
            return (early.*f - 8 * before.*f + 8 * after.*f - late.*f) / (12 * h);
        };
        VectorField div_P(grid), J(grid);
        for_each_point(grid, [&](long n) {
            div_P.x()[n] =
                (now.P_xx[n + 1] - now.P_xx[n]) / dx + (now.P_xz[n] - now.P_xz[n - s]) / dz;
            div_P.y()[n] =
                (now.P_xy[n] - now.P_xy[n - 1]) / dx + (now.P_yz[n] - now.P_yz[n - s]) / dz;
            div_P.z()[n] =
                (now.P_xz[n] - now.P_xz[n - 1]) / dx + (now.P_zz[n + s] - now.P_zz[n]) / dz;
        });
        fill_ghosts(grid, current, div_P);
        J.all << now.J_x, now.J_y, now.J_z;
        const double scale = start.q_p / grid.cell_area(), tolerance = 64 * eps * scale / h;
        Field div = Field::Zero(grid.size());
        divergence_of_electric(grid, J.all.data(), div);
        CHECK(largest(grid, on_nodes, rate(&Moments::rho) + div) <= tolerance);
        const auto part = [&](long a) { return div_P.all.segment(a * grid.size(), grid.size()); };
        CHECK(largest(grid, on_x_edges, rate(&Moments::J_x) + part(0)) <= tolerance);
        CHECK(largest(grid, on_nodes, rate(&Moments::J_y) + part(1)) <= tolerance);
        CHECK(largest(grid, on_z_edges, rate(&Moments::J_z) + part(2)) <= tolerance);

        // Over a whole step, with the current that the pressure turns until half time.
        const auto missing = [&](double dt) {
            VectorField half = J;
            half.all -= 0.5 * dt * div_P.all;
            divergence_of_electric(grid, half.all.data(), div);
            return largest(grid, on_nodes, at(dt).rho - now.rho + dt * div);
        };
        CHECK(std::fabs(missing(0.02) / missing(0.01) - 8) <= 0.2);
    }
}

TEST_CASE("the work done on particles is the work of the deposited current also at walls") {
    Random random;
    for (const Grid& grid : meshes()) {
        const Particles particles = anywhere(grid, 1000, 1, random);
        const VectorField E = random.field(grid, current);
        const PushField push = pack(grid, E, VectorField(grid));
        const Moments moments = deposited(grid, particles);
        double work = 0, of_current = 0;
        for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
            const auto at = gathered(grid, push, particles.x_p[p], particles.z_p[p]);
            work += particles.q_p * (particles.vx_p[p] * at.E_x + particles.vy_p[p] * at.E_y +
                                     particles.vz_p[p] * at.E_z);
        }
        const std::array J{&moments.J_x, &moments.J_y, &moments.J_z};
        for (std::size_t a = 0; a < 3; ++a) {
            const Field component = E.all.segment(static_cast<long>(a) * grid.size(), grid.size());
            of_current += total(grid, current.place[a], J[a]->cwiseProduct(component));
        }
        CHECK(std::fabs(work - of_current) <= 0.2 * eps * static_cast<double>(particles.count()));
    }
}

// Within a cell the gathered field is quadratic, so that central differences are exact.
TEST_CASE("the gathered gradient is the gradient of the gathered potential and div B is zero") {
    Random random;
    for (const Grid& grid : meshes()) {
        const double dx = grid.x.spacing(), dz = grid.z.spacing();
        // phi in the place of E_y, A_y in the place of B: both live on nodes and vanish on walls.
        VectorField E = random.field(grid, electric), A = random.field(grid, electric), B(grid);
        for_each_point(grid, [&](long n) {
            E.x()[n] = -(E.y()[n + 1] - E.y()[n]) / dx;
            E.z()[n] = -(E.y()[n + grid.stride()] - E.y()[n]) / dz;
        });
        curl_of_electric(grid, A.all.data(), B.all.data());
        fill_ghosts(grid, electric, E);
        fill_ghosts(grid, magnetic, B);
        const PushField push = pack(grid, E, B);
        for (int sample = 0; sample < 300; ++sample) {
            const long i = std::lround(4 * (1 + random())), j = std::lround(3.5 * (1 + random()));
            const double d_x = 0.4 * random(), d_z = 0.4 * random(), h = 0.1;
            const auto at = gathered(grid, push, i, j, d_x, d_z),
                       left = gathered(grid, push, i, j, d_x - h, d_z),
                       right = gathered(grid, push, i, j, d_x + h, d_z),
                       down = gathered(grid, push, i, j, d_x, d_z - h),
                       up = gathered(grid, push, i, j, d_x, d_z + h);
            const double tolerance = 4 * eps / h / dz / dz;
            CHECK(std::fabs(at.E_x + (right.E_y - left.E_y) / (2 * h * dx)) <= tolerance);
            CHECK(std::fabs(at.E_z + (up.E_y - down.E_y) / (2 * h * dz)) <= tolerance);
            CHECK(std::fabs((right.B_x - left.B_x) / (2 * h * dx) +
                            (up.B_z - down.B_z) / (2 * h * dz)) <= tolerance);
        }
        // From one cell to the next nothing jumps.
        for (int sample = 0; sample < 100; ++sample) {
            const double d = 0.5 * random();
            const auto a = gathered(grid, push, 3, 2, 0.5, d),
                       b = gathered(grid, push, 4, 2, -0.5, d);
            const auto e = gathered(grid, push, 3, 2, d, 0.5),
                       f = gathered(grid, push, 3, 3, d, -0.5);
            for (const auto& [one, other] : {std::pair{a, b}, {e, f}}) {
                const double jump =
                    std::fabs(one.E_x - other.E_x) + std::fabs(one.E_y - other.E_y) +
                    std::fabs(one.E_z - other.E_z) + std::fabs(one.B_x - other.B_x) +
                    std::fabs(one.B_y - other.B_y) + std::fabs(one.B_z - other.B_z);
                CHECK(jump <= 16 * eps / dz);
            }
        }
    }
}

// ---- the mover -----------------------------------------------------------------------------------

TEST_CASE("moved particles satisfy the midpoint rule to the tolerance of the mover") {
    Random random;
    const Grid grid = mesh(true, true);
    const PushField push =
        pack(grid, random.field(grid, electric, 0.3), random.field(grid, magnetic, 0.5));
    for (const double tolerance : {1e-4, 1e-14}) {
        Particles particles = anywhere(grid, 3000, 0.5, random);
        const Particles start = particles;
        const double dt = 0.5, h = 0.5 * dt, kick = particles.q_p / particles.m_p * h;
        const MoverReport report = move_particles(push, grid, dt, {tolerance, 100}, particles);
        CHECK(report.one_by_one > 100);
        CHECK(report.sub_stepped == 0);
        double residual = 0, displacement = 0;
        for (std::size_t p = 0; p < start.x_p.size(); ++p) {
            const double x = start.x_p[p], z = start.z_p[p];
            const double u_x = 0.5 * (start.vx_p[p] + particles.vx_p[p]),
                         u_y = 0.5 * (start.vy_p[p] + particles.vy_p[p]),
                         u_z = 0.5 * (start.vz_p[p] + particles.vz_p[p]);
            const auto at =
                gathered(grid, push, wrapped(grid.x, x + h * u_x), wrapped(grid.z, z + h * u_z));
            residual = std::max(
                {residual,
                 std::fabs(u_x - start.vx_p[p] - kick * (at.E_x + u_y * at.B_z - u_z * at.B_y)),
                 std::fabs(u_y - start.vy_p[p] - kick * (at.E_y + u_z * at.B_x - u_x * at.B_z)),
                 std::fabs(u_z - start.vz_p[p] - kick * (at.E_z + u_x * at.B_y - u_y * at.B_x))});
            displacement = std::max({displacement, apart(grid.x, particles.x_p[p], x + dt * u_x),
                                     apart(grid.z, particles.z_p[p], z + dt * u_z)});
        }
        CHECK(residual * h / grid.z.spacing() <= tolerance);
        CHECK(displacement <= 8 * eps);
    }
}

TEST_CASE("eight at once and one by one find the same step also at walls") {
    Random random;
    for (const Grid& grid : meshes()) {
        const PushField push =
            pack(grid, random.field(grid, current, 0.2), random.field(grid, magnetic, 0.5));
        Particles particles = anywhere(grid, 3000, 0.5, random);
        const Particles start = particles;
        const double charge_over_mass = start.q_p / start.m_p, dt = 0.4;
        const MoverReport report = move_particles(push, grid, dt, tight, particles);
        CHECK(report.lost == 0);
        CHECK(report.one_by_one < start.count() / 2);
        double difference = 0;
        for (std::size_t p = 0; p < start.x_p.size(); ++p) {
            double x = 0, z = 0;
            Velocity<double> v{};
            int parts = 1;
            do {
                x = start.x_p[p], z = start.z_p[p];
                v = {start.vx_p[p], start.vy_p[p], start.vz_p[p]};
                parts *= 2;
            } while (!move_one(grid, push, tight, charge_over_mass, dt, parts / 2, x, z, v) &&
                     parts < 1024);
            difference =
                std::max({difference, apart(grid.x, x, particles.x_p[p]),
                          apart(grid.z, z, particles.z_p[p]), std::fabs(v.x - particles.vx_p[p]),
                          std::fabs(v.y - particles.vy_p[p]), std::fabs(v.z - particles.vz_p[p])});
            CHECK(particles.x_p[p] >= grid.x.low);
            CHECK(particles.x_p[p] <= grid.x.high());
            CHECK(particles.z_p[p] >= grid.z.low);
            CHECK(particles.z_p[p] <= grid.z.high());
        }
        CHECK(difference <= 1e-13);
    }
}

TEST_CASE("a magnetic field does no work") {
    Random random;
    for (const Grid& grid : meshes()) {
        const PushField push = pack(grid, VectorField(grid), random.field(grid, magnetic, 2));
        Particles particles = anywhere(grid, 2000, 0.5, random);
        for (int step = 0; step < 5; ++step) {
            const Particles start = particles;
            move_particles(push, grid, 0.4, MoverSettings{}, particles);
            double change = 0;
            for (std::size_t p = 0; p < start.x_p.size(); ++p) {
                const double before = std::hypot(start.vx_p[p], start.vy_p[p], start.vz_p[p]);
                const double after =
                    std::hypot(particles.vx_p[p], particles.vy_p[p], particles.vz_p[p]);
                change = std::max(change, std::fabs(after - before));
            }
            CHECK(change <= 1e-13);
            sort(grid, particles);
        }
    }
}

TEST_CASE("in uniform fields a step is the E x B drift and a turn by twice the arc tangent") {
    Random random;
    const Grid grid = mesh(true, true);
    for (const double dt : {0.01, 0.3, 1.5}) {
        const Eigen::Vector3d B(0.3, -0.5, 0.4), E(0.02, 0.03, 0.05), b = B.normalized();
        const PushField push = uniform(grid, {E[0], E[1], E[2]}, {B[0], B[1], B[2]});
        Particles particles = anywhere(grid, 500, 0.1, random);
        const Particles start = particles;
        move_particles(push, grid, dt, tight, particles);
        const double q_m = particles.q_p / particles.m_p, Omega = q_m * B.norm();
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(-2 * std::atan(0.5 * Omega * dt), b).toRotationMatrix();
        const Eigen::Vector3d drift = E.cross(B) / B.squaredNorm(), along = q_m * dt * E.dot(b) * b;
        double error = 0;
        for (std::size_t p = 0; p < start.x_p.size(); ++p) {
            const Eigen::Vector3d before(start.vx_p[p], start.vy_p[p], start.vz_p[p]),
                after(particles.vx_p[p], particles.vy_p[p], particles.vz_p[p]);
            const Eigen::Vector3d expected = drift + turn * (before - drift) + along;
            error = std::max(error, (after - expected).norm());
        }
        CHECK(error <= 8 * eps);
    }
}

TEST_CASE("steps are undone by steps with velocity and magnetic field reversed") {
    Random random;
    const Grid grid = mesh(true, true);
    const VectorField E = random.field(grid, electric, 0.3);
    VectorField B = random.field(grid, magnetic, 0.5), reversed = B;
    reversed.all = -B.all;
    const PushField forward = pack(grid, E, B), backward = pack(grid, E, reversed);
    double error = 0;
    for (int sample = 0; sample < 300; ++sample) {
        const Particles start = anywhere(grid, 1, 0.5, random);
        Particles particle = start;
        for (const PushField* push : {&forward, &backward}) {
            for (int step = 0; step < 4; ++step) {
                move_particles(*push, grid, 0.3, tight, particle);
                sort(grid, particle);
            }
            for (auto* v : {&particle.vx_p, &particle.vy_p, &particle.vz_p}) v->front() *= -1;
        }
        error = std::max({error, apart(grid.x, start.x_p[0], particle.x_p[0]),
                          apart(grid.z, start.z_p[0], particle.z_p[0]),
                          std::fabs(start.vx_p[0] - particle.vx_p[0]),
                          std::fabs(start.vy_p[0] - particle.vy_p[0]),
                          std::fabs(start.vz_p[0] - particle.vz_p[0])});
    }
    CHECK(error <= 1e-13);
}

TEST_CASE("a particle that would cross several cells in a step is followed in sub-steps") {
    Random random;
    const Grid grid = mesh(true, true);
    VectorField E(grid), B(grid);
    for (long j = -1; j <= grid.z.cells + 1; ++j) {
        for (long i = -1; i <= grid.x.cells + 1; ++i) {
            const double x = 2 * pi * static_cast<double>(i) / static_cast<double>(grid.x.cells),
                         z = 2 * pi * static_cast<double>(j) / static_cast<double>(grid.z.cells);
            const long n = grid.index(i, j);
            E.x()[n] = 0.2 * std::sin(x), E.z()[n] = 0.2 * std::cos(z),
            B.y()[n] = 0.3 * std::sin(x + z);
        }
    }
    const PushField push = pack(grid, E, B);
    const double dt = 1;
    for (const double cells : {2.5, 4.0, 8.0}) {
        Particles particles = no_particles();
        for (int p = 0; p < 50; ++p) {
            const double angle = pi * random(), v = cells * grid.x.spacing();
            add(particles, grid.x.at(4 + 4 * random()), grid.z.at(3.5 + 3.5 * random()),
                v * std::cos(angle), 0.1, v * std::sin(angle));
        }
        sort(grid, particles);
        const Particles start = particles;
        const MoverReport report = move_particles(push, grid, dt, MoverSettings{}, particles);
        CHECK(report.lost == 0);
        CHECK(report.sub_stepped == 50);
        CHECK(report.one_by_one == 50);
        double error = 0;
        for (std::size_t p = 0; p < start.x_p.size(); ++p) {
            double x = start.x_p[p], z = start.z_p[p];
            Velocity<double> v{start.vx_p[p], start.vy_p[p], start.vz_p[p]};
            REQUIRE(move_one(grid, push, tight, start.q_p / start.m_p, dt, 512, x, z, v));
            error = std::max(
                {error, apart(grid.x, x, particles.x_p[p]), apart(grid.z, z, particles.z_p[p]),
                 std::fabs(v.x - particles.vx_p[p]), std::fabs(v.z - particles.vz_p[p])});
        }
        CHECK(error <= 0.02);
    }
}

TEST_CASE("a field that is not a number is reported as lost particles") {
    Random random;
    for (const Grid& grid : meshes()) {
        const double bad = std::numeric_limits<double>::quiet_NaN();
        for (const PushField& push :
             {uniform(grid, {bad, bad, bad}, {0, 0, 0}), uniform(grid, {0, 0, 0}, {0, bad, 0})}) {
            std::vector<Particles> species{anywhere(grid, 100, 0.1, random)};
            CHECK(move_particles(push, grid, 0.3, MoverSettings{}, species[0]).lost == 100);
            species[0] = anywhere(grid, 100, 0.1, random);
            CHECK_THROWS_AS(move_particles(push, grid, 0.3, MoverSettings{}, species),
                            common::NumericalError);
        }
    }
}

TEST_CASE("a field that overwhelms everything is reported as lost particles") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const double huge : {1e12, 1e18, 1e30, 1e200}) {
            Particles particles = anywhere(grid, 100, 0.1, random);
            const PushField push = uniform(grid, {huge, huge, huge}, {0, 0, 0});
            CHECK(move_particles(push, grid, 0.3, MoverSettings{}, particles).lost == 100);
        }
    }
}

TEST_CASE("without fields particles bounce between walls like light between mirrors") {
    Random random;
    for (const Grid& grid : meshes()) {
        const PushField push = uniform(grid, {0, 0, 0}, {0, 0, 0});
        const double dt = 0.3;
        Particles particles =
            anywhere(grid, 400, 0.9, random);  // some in corners, some along walls
        for (std::size_t p = 0; p < 400; ++p) {
            if (p % 16 == 0) particles.z_p[p] = grid.z.low, particles.x_p[p] = grid.x.high();
            if (p % 9 == 0) particles.vx_p[p] = 0;
            particles.vy_p[p] = static_cast<double>(p);  // a name that stays
        }
        const Particles start = particles;
        sort(grid, particles);
        double error = 0;
        long outside = 0, lost = 0;
        for (int step = 1; step <= 40; ++step) {
            lost += move_particles(push, grid, dt, MoverSettings{}, particles).lost;
            for (std::size_t p = 0; p < 400; ++p) {
                const auto from = static_cast<std::size_t>(particles.vy_p[p]);
                const auto check = [&](const common::Axis& axis, double x_0, double v_0, double x,
                                       double v) {
                    // With all its images a bouncing particle flies straight on.
                    const double path = (x_0 - axis.low + step * dt * v_0) / axis.length;
                    const double folded =
                        axis.periodic ? path - std::floor(path) : std::remainder(path, 2);
                    error =
                        std::max(error, apart(axis, axis.low + std::fabs(folded) * axis.length, x));
                    const double depth = std::min(x - axis.low, axis.high() - x);
                    const double sign = axis.periodic || folded > 0 ? 1 : -1;
                    if (depth > 1e-12) error = std::max(error, std::fabs(v - sign * v_0));
                    outside += !(depth >= 0 && std::fabs(v) == std::fabs(v_0));
                };
                check(grid.x, start.x_p[from], start.vx_p[from], particles.x_p[p],
                      particles.vx_p[p]);
                check(grid.z, start.z_p[from], start.vz_p[from], particles.z_p[p],
                      particles.vz_p[p]);
            }
            sort(grid, particles);
        }
        CHECK(lost == 0);
        CHECK(outside == 0);
        CHECK(error <= 1e-13);
    }
}

TEST_CASE("a particle that lies on a wall and is pressed against it stays there") {
    const Grid grid = mesh(false, false);
    for (const double depth : {0.0, 1e-15, 1e-9, 1e-3}) {
        for (const double E : {0.01, 1.0}) {
            Particles particle = no_particles();
            add(particle, grid.x.at(2.3), grid.z.low + depth, 0.1, 0.2, 0);
            sort(grid, particle);
            const PushField push = uniform(grid, {0, 0, -E}, {0, 0, 0});
            CHECK(move_particles(push, grid, 0.3, tight, particle).lost == 0);
            CHECK(particle.z_p[0] >= grid.z.low);
            CHECK(particle.z_p[0] <= grid.z.low + depth + 1e-6);
            CHECK(std::fabs(particle.x_p[0] - grid.x.at(2.3) - 0.03) <= 1e-13);
        }
    }
}

// The electrons of the GEM challenge turn by 0.4 in a step at the walls.
TEST_CASE("gyration at a reflecting wall drives no current and keeps the density uniform" *
          doctest::description("physics")) {
    const Grid grid{{4, 0, 4, true}, {8, 0, 8, false}};
    const double thermal = 0.2;  // cells per step
    for (const bool along_x : {true, false}) {
        for (const double turn : {0.2, 0.4}) {
            const long count = 200 * grid.x.cells * grid.z.cells;
            Particles particles;
            particles.q_p = particles.m_p = 1.0 / 200;
            const auto normal = [](long p, unsigned base) {
                return gsl_cdf_ugaussian_Pinv(common::radical_inverse(p, base));
            };
            for (long p = 0; p < count; ++p) {
                add(particles, 4 * common::radical_inverse(p, 2), 8 * common::radical_inverse(p, 3),
                    thermal * normal(p, 5), thermal * normal(p, 7), thermal * normal(p, 11));
            }
            const PushField push =
                uniform(grid, {0, 0, 0}, {along_x ? turn : 0, along_x ? 0 : turn, 0});
            SortScratch scratch;
            sort_particles(grid, scratch, particles);
            Moments moments(grid);
            double density = 0, flow = 0;
            for (int step = 1; step <= 400; ++step) {
                move_particles(push, grid, 1, MoverSettings{1e-6, 20}, particles);
                sort_particles(grid, scratch, particles);
                if (step <= 200 || step % 10 > 0) continue;
                deposit_moments(particles, grid, moments);
                for (long i = 0; i < grid.x.cells; ++i) {
                    const long n = grid.index(i, 0);
                    density += moments.rho[n] / 80;
                    flow += (along_x ? moments.J_y : moments.J_x)[n] / 80 / thermal;
                }
            }
            CHECK(std::fabs(density - 1) <= 0.01);
            CHECK(std::fabs(flow) <= 0.01);
        }
    }
}

TEST_CASE("particles cross the periodic seam and stay inside the mesh") {
    const Grid grid = mesh(true, true);
    const PushField push = uniform(grid, {0, 0, 0}, {0, 0, 0});
    const double dt = 0.3;
    for (const double x : {grid.x.low, grid.x.high(), std::nextafter(grid.x.high(), 0.0)}) {
        for (const double v : {0.0, 1e-300, -1e-300, 1e-17, -1e-17, 0.5, -0.5, 9.0, -9.0}) {
            Particles particle = no_particles();
            add(particle, x, grid.z.at(2), v, 0, v);
            sort(grid, particle);
            CHECK(move_particles(push, grid, dt, MoverSettings{}, particle).lost == 0);
            CHECK(particle.x_p[0] >= grid.x.low);
            CHECK(particle.x_p[0] < grid.x.high());
            CHECK(apart(grid.x, particle.x_p[0], x + v * dt) <= 4 * eps);
            CHECK(apart(grid.z, particle.z_p[0], grid.z.at(2) + v * dt) <= 8 * eps);
            CHECK(particle.vx_p[0] == v);
        }
    }
}

TEST_CASE("one and two and three threads give the same bytes of particles and moments") {
    const int before = common::thread_count();
    for (const Grid& grid : meshes()) {
        std::vector<Particles> moved;
        std::vector<Moments> moments;
        for (const int threads : {1, 2, 3}) {
            common::set_thread_count(threads);
            Random random;
            const PushField push =
                pack(grid, random.field(grid, current, 0.2), random.field(grid, magnetic, 0.5));
            moved.push_back(anywhere(grid, 5000, 0.5, random));
            for (int step = 0; step < 3; ++step) {
                move_particles(push, grid, 0.4, MoverSettings{}, moved.back());
                sort(grid, moved.back());
            }
            moments.push_back(deposited(grid, moved.back()));
        }
        for (std::size_t k = 1; k < 3; ++k) {
            CHECK(same_bytes(moved[0], moved[k]));
            CHECK(moments[0].kinetic_energy == moments[k].kinetic_energy);
            CHECK(moments[0].momentum == moments[k].momentum);
            for (std::size_t f = 0; f < definitions.size(); ++f) {
                CHECK(same_bytes(moments[0].all()[f]->data(), moments[k].all()[f]->data(),
                                 grid.size()));
            }
        }
    }
    common::set_thread_count(before);
}

// ---- loading -------------------------------------------------------------------------------------

namespace {
Case harris_case() {
    Case wanted;
    wanted.harris.particles = 100000;
    return wanted;
}

// Two warm species that drift, on a small periodic mesh.
Case uniform_case(const std::string& loading, long seed = 1) {
    Case wanted;
    wanted.setup = "uniform", wanted.loading = loading, wanted.seed = seed;
    wanted.grid = {{16, -2, 4, true}, {12, -3, 6, true}};
    wanted.uniform.species.resize(2);
    SpeciesCase &ions = wanted.uniform.species[0], &electrons = wanted.uniform.species[1];
    ions.name = "ions", electrons.name = "electrons";
    electrons.charge = -1, electrons.mass = 0.04;
    ions.drift_x = 0.01, ions.drift_y = -0.02, ions.drift_z = 0.03;
    ions.temperature_x = 1e-4, ions.temperature_y = 4e-4, ions.temperature_z = 9e-4;
    electrons.temperature_x = electrons.temperature_y = electrons.temperature_z = 4e-4;
    return wanted;
}
}  // namespace

TEST_CASE("the Harris sheet balances pressure and current and its field is free of divergence") {
    const Case wanted = harris_case();
    const Grid& grid = wanted.grid;
    const HarrisSheet sheet = harris_sheet(wanted.harris);
    const double B0 = sheet.B0, lambda = wanted.harris.thickness;
    CHECK(std::fabs(n0 * (sheet.T_i + sheet.T_e) * 8 * pi / (B0 * B0) - 1) <= 4 * eps);
    CHECK(std::fabs(sheet.T_i / sheet.T_e - wanted.harris.temperature_ratio) <= 64 * eps);
    CHECK(std::fabs(n0 * (sheet.u_i - sheet.u_e) * 4 * pi * lambda / (c * B0) - 1) <= 4 * eps);
    CHECK(std::fabs(sheet.v_e * sheet.v_e / wanted.harris.mass_ratio / sheet.T_e - 1) <= 4 * eps);

    FieldState field(grid);
    harris_field(wanted, field);
    Field div(grid.size());
    divergence_of_magnetic(grid, field.B.all.data(), div);
    CHECK(largest(grid, on_faces, div) <= 4 * eps * B0 / grid.z.spacing());
    double flux = 0, wall = 0, difference = 0;
    for (long i = 0; i < grid.x.cells; ++i) {
        const double B_z = field.B.z()[grid.index(i, grid.z.cells / 2)];
        if (2 * i >= grid.x.cells) flux += B_z * grid.x.spacing();
        wall = std::max(wall, std::fabs(field.B.z()[grid.index(i, 0)]));
    }
    // From the X point in the middle to the O point at the end of the box: 2 psi0.
    CHECK(std::fabs(flux - 2 * wanted.harris.perturbation * B0) <= 16 * eps * B0);
    CHECK(wall <= 0);
    // On average over x the sheet is left.
    for (long j = 0; j < grid.z.cells; ++j) {
        double mean = 0;
        for (long i = 0; i < grid.x.cells; ++i) mean += field.B.x()[grid.index(i, j)] / 64;
        const double z = grid.z.at(static_cast<double>(j) + 0.5), dz = grid.z.spacing();
        const double exact =
            lambda / dz *
            std::log(std::cosh((z + dz / 2) / lambda) / std::cosh((z - dz / 2) / lambda));
        difference = std::max(difference, std::fabs(mean / B0 - exact));
    }
    CHECK(difference <= 128 * eps);
}

TEST_CASE("particles of a Harris sheet have equal weights and start with no charge") {
    for (const char* loading : {"quiet", "random"}) {
        Case wanted = harris_case();
        wanted.loading = loading;
        const Grid& grid = wanted.grid;
        const State state = initial_state(wanted);
        const Particles &ions = state.plasma.species[0], &electrons = state.plasma.species[1];
        const long pairs = wanted.harris.particles / 2;
        CHECK(ions.count() == pairs);
        CHECK(electrons.count() == pairs);
        CHECK(ions.q_p == -electrons.q_p);
        CHECK(std::fabs(ions.q_p / ions.m_p - 1) <= eps);
        CHECK(std::fabs(electrons.q_p / electrons.m_p + wanted.harris.mass_ratio) <= 64 * eps);
        CHECK(same_bytes(ions.x_p.data(), electrons.x_p.data(), pairs));
        CHECK(same_bytes(ions.z_p.data(), electrons.z_p.data(), pairs));

        const Moments of_ions = deposited(grid, ions), of_electrons = deposited(grid, electrons);
        CHECK(largest(grid, on_nodes, of_ions.rho + of_electrons.rho) <= 4 * eps * n0);
        CHECK(state.field.E.all.cwiseAbs().maxCoeff() <= 64 * eps * n0);
        // Density and current of the sheet, averaged over x.
        double density = 0, flow = 0;
        const HarrisSheet sheet = harris_sheet(wanted.harris);
        for (long j = 0; j <= grid.z.cells; ++j) {
            double rho = 0, J = 0;
            for (long i = 0; i < grid.x.cells; ++i) {
                rho += of_ions.rho[grid.index(i, j)] / 64 / n0;
                J += (of_ions.J_y + of_electrons.J_y)[grid.index(i, j)] / 64 / n0;
            }
            const double sech2 = common::spline_average(
                [&](double z) { return std::pow(std::cosh(z / wanted.harris.thickness), -2); },
                grid.z.at(static_cast<double>(j)), grid.z.spacing());
            density = std::max(density, std::fabs(rho - sech2 - wanted.harris.background));
            flow = std::max(flow, std::fabs(J - sech2 * (sheet.u_i - sheet.u_e)));
        }
        CHECK(density <= 0.05);
        CHECK(flow <= 0.05);
    }
}

TEST_CASE("a uniform plasma has the moments that were asked for") {
    for (const char* loading : {"quiet", "random"}) {
        const Case wanted = uniform_case(loading);
        const State state = initial_state(wanted);
        const double n = static_cast<double>(state.plasma.species[0].count());
        CHECK(state.plasma.count() == 2 * 64 * 16 * 12);
        for (std::size_t k = 0; k < 2; ++k) {
            const Particles& particles = state.plasma.species[k];
            const SpeciesCase& s = wanted.uniform.species[k];
            CHECK(std::fabs(particles.m_p * n / (n0 * s.mass * 24) - 1) <= 4 * eps);
            CHECK(std::fabs(particles.q_p * n / (n0 * s.charge * 24) - 1) <= 4 * eps);
            const auto check = [&](const std::vector<double>& v, double drift, double T) {
                double mean = 0, variance = 0;
                for (const double one : v) mean += one / n;
                for (const double one : v) variance += (one - drift) * (one - drift) / n;
                CHECK(std::fabs(mean - drift) <= 4 * std::sqrt(T / s.mass / n));
                CHECK(std::fabs(variance * s.mass / T - 1) <= 4 * std::sqrt(2 / n));
            };
            check(particles.vx_p, s.drift_x, s.temperature_x);
            check(particles.vy_p, s.drift_y, s.temperature_y);
            check(particles.vz_p, s.drift_z, s.temperature_z);
        }
    }
}

TEST_CASE("a quiet start is quieter than random numbers and another seed another realization") {
    const auto noise = [](const State& state, const Grid& grid) {
        const Field rho = deposited(grid, state.plasma.species[0]).rho / n0;
        return std::sqrt(total(grid, on_nodes, (rho.array() - 1).square().matrix()) / 24);
    };
    const Case quiet = uniform_case("quiet"), random = uniform_case("random");
    const double quiet_noise = noise(initial_state(quiet), quiet.grid);
    const double random_noise = noise(initial_state(random), random.grid);
    // Noise of n particles per cell in S2 S2: sum of the squared weights is 0.55 per direction.
    CHECK(random_noise <= 1.2 * 0.55 / 8);
    CHECK(random_noise >= 0.8 * 0.55 / 8);
    CHECK(quiet_noise <= 0.3 * random_noise);
    for (const char* loading : {"quiet", "random"}) {
        const Particles one = initial_state(uniform_case(loading, 1)).plasma.species[0],
                        same = initial_state(uniform_case(loading, 1)).plasma.species[0],
                        other = initial_state(uniform_case(loading, 2)).plasma.species[0];
        CHECK(same_bytes(one, same));
        CHECK(one.vx_p[0] != other.vx_p[0]);
        CHECK(one.x_p[0] != other.x_p[0]);
    }
}

TEST_CASE("the field at the start obeys the law of Gauss with conducting walls") {
    Random random;
    for (const Grid& grid : meshes()) {
        Field rho = Field::NullaryExpr(grid.size(), [&] { return random(); });
        common::fill_ghosts(grid, on_nodes, {+1, +1}, rho.data());
        FieldState field(grid);
        add_electrostatic_field(grid, MeshModes(grid), rho, field);
        Field div = Field::Zero(grid.size()), curl = div;
        divergence_of_electric(grid, field.E.all.data(), div);
        // In a doubly periodic box a uniform background takes the mean.
        const bool free = grid.x.periodic && grid.z.periodic;
        const double mean = free ? total(grid, on_nodes, rho) / (grid.x.length * grid.z.length) : 0;
        double wrong = 0;
        for_each_distinct(grid, on_nodes, [&](long, long, long n, double w) {
            if (w == 1) wrong = std::max(wrong, std::fabs(div[n] - 4 * pi * (rho[n] - mean)));
        });
        CHECK(wrong <= 256 * eps * 4 * pi);
        VectorField curl_E(grid);
        curl_of_electric(grid, field.E.all.data(), curl_E.all.data());
        CHECK(largest(grid, on_faces, curl_E.all.segment(grid.size(), grid.size())) <=
              64 * eps * 4 * pi);
    }
}
