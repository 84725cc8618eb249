// The steps of clouds-in-cells one by one: what is exact in the deposit, the field, the gather and
// the leapfrog, on periodic meshes and between walls.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "cic/apply_particle_boundaries.hpp"
#include "cic/output/diagnostics.hpp"
#include "cic/setup/initial_state.hpp"
#include "cic/sort_particles.hpp"
#include "common/splines.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

using namespace cic;
using facts::eps;
using facts::real;
using facts::worst;

using Random = facts::UnitRandom;

struct Mesh {
    Grid grid;
    Scheme scheme;
    std::string name;
};

// Every weighting on lines and planes, periodic and between walls.
std::vector<Mesh> meshes(bool energy_conserving) {
    std::vector<Mesh> all;
    for (int order = energy_conserving ? 1 : 0; order <= 2; ++order) {
        for (const bool walls_x : {false, true}) {
            for (const int kind : {0, 1, 2}) {
                Mesh m;
                m.grid = {{9, -0.4, 3.7, !walls_x}, {1, 0, 1, true}};
                if (kind > 0) m.grid.z = {7, 0.3, 2.9, kind == 1};
                m.scheme = {order, energy_conserving, kind > 0 ? 2 : 1};
                m.name = "order " + std::to_string(order) + ", walls " + std::to_string(walls_x) +
                         ", kind " + std::to_string(kind);
                all.push_back(m);
            }
        }
    }
    return all;
}

// Particles anywhere on a mesh, some next to its ends.
Particles scattered(const Mesh& m, long count, double charge, std::uint64_t seed) {
    Random random(seed);
    Particles s;
    s.name = "scattered";
    s.q_p = charge, s.m_p = 0.7;
    for (long p = 0; p < count; ++p) {
        const double u = p % 5 == 0 ? 0.02 * random() : random();
        s.x_p.push_back(m.grid.x.low + m.grid.x.length * (p % 2 == 0 ? u : 1 - u));
        s.vx_p.push_back(random() - 0.5);
        if (m.scheme.dimensions == 2) {
            const double v = p % 7 == 0 ? 0.02 * random() : random();
            s.z_p.push_back(m.grid.z.low + m.grid.z.length * (p % 3 == 0 ? 1 - v : v));
            s.vz_p.push_back(random() - 0.5);
        }
    }
    return s;
}

struct Solved {
    Field rho_g;
    FieldState field;
};

Solved solve(const Mesh& m, const std::vector<Particles>& species, double background = 0,
             bool nine_point = false, const Walls& walls = {}) {
    Solved s;
    DepositScratch scratch;
    FieldSolver solver(m.grid, m.scheme, nine_point, 1);
    deposit_charge(species, m.grid, m.scheme, background, scratch, s.rho_g);
    s.field.walls = walls;
    solve_field(solver, s.rho_g, s.field);
    return s;
}

// The field at every particle.
std::vector<std::array<double, 2>> gathered(const Mesh& m, const MeshField& E_g, Particles s) {
    std::vector<std::array<double, 2>> E(s.x_p.size());
    std::vector<Particles> one{s};
    for_each_batch(one, [&](ParticleBatch& batch) {
        FieldAtParticles E_p;
        gather_field(E_g, m.grid, m.scheme, batch, E_p);
        for (long k = 0; k < batch.count; ++k)
            E[batch.x_p - one[0].x_p.data() + k] = {E_p.x[k],
                                                    m.scheme.dimensions == 2 ? E_p.z[k] : 0};
    });
    return E;
}

double mean_charge(const Mesh& m, const Particles& s) {
    return s.q_p * double(s.count()) / (m.grid.x.length * m.grid.z.length);
}

ParticleBatch whole(Particles& s) {
    const auto from = [](std::vector<Real>& v) { return v.empty() ? nullptr : v.data(); };
    return {from(s.x_p), from(s.z_p), from(s.vx_p), from(s.vy_p), from(s.vz_p), s.count(), s.q_p,
            s.m_p,       {}};
}

// How far numbers are from filling (0, 1) evenly, each alone and all pairs: the largest mean of a
// wave as long as the interval, over the numbers, their sums and their differences; 1 with one
// outside.
double unevenness(const std::vector<std::vector<double>>& u) {
    double most = 0;
    const auto mean = [](const std::vector<double>& a, const std::vector<double>& b, double sign) {
        std::complex<double> sum = 0;
        for (std::size_t p = 0; p < a.size(); ++p)
            sum += std::polar(1.0, 2 * pi * (a[p] + (sign != 0 ? sign * b[p] : 0)));
        return a.empty() ? 0 : std::abs(sum) / double(a.size());
    };
    for (std::size_t a = 0; a < u.size(); ++a) {
        most = worst({most, mean(u[a], u[a], 0)});
        for (const double number : u[a])
            if (!(number >= -8 * eps && number <= 1 + 8 * eps)) most = 1;
        for (std::size_t b = a + 1; b < u.size(); ++b)
            if (!u[a].empty() && !u[b].empty())
                most = worst({most, mean(u[a], u[b], 1), mean(u[a], u[b], -1)});
    }
    return most;
}

}  // namespace

TEST_CASE("weights are the B-splines and sum to one") {
    Random random(1);
    const common::Axis axis{6, 0.7, 1.8, true};
    for (const long count : {1L, 7L, batch_size}) {
        for (const double shift : {0.0, -0.5}) {
            std::vector<Real> x_p(count);
            for (Real& x : x_p) x = axis.low + axis.length * random();
            const auto check = [&](int order, const auto& clouds) {
                for (long p = 0; p < count; ++p) {
                    const double s = (x_p[p] - axis.low) / axis.spacing() + shift;
                    const auto weights = clouds[p];
                    double sum = 0;
                    for (int i = 0; i < weights.count; ++i) {
                        const double exact = common::spline(order, s - weights.first - i);
                        CHECK(std::fabs(weights.S[i] - exact) <= 16 * eps);
                        sum += weights.S[i];
                    }
                    CHECK(std::fabs(sum - 1) <= 2 * eps);
                }
            };
            check(0, Clouds<0>(axis, x_p.data(), count, shift));
            check(1, Clouds<1>(axis, x_p.data(), count, shift));
            check(2, Clouds<2>(axis, x_p.data(), count, shift));
        }
    }
}

TEST_CASE("the charge on the mesh is the charge of particles and background") {
    for (const bool energy : {false, true}) {
        for (const Mesh& m : meshes(energy)) {
            CAPTURE(m.name);
            const std::vector<Particles> species{scattered(m, 101, -0.3, 2),
                                                 scattered(m, 57, 0.2, 3)};
            DepositScratch scratch;
            Field rho_g;
            deposit_charge(species, m.grid, m.scheme, 1.5, scratch, rho_g);
            const double expected = -0.3 * 101 + 0.2 * 57 + 1.5 * m.grid.x.length * m.grid.z.length;
            CHECK(std::fabs(charge_on_mesh(m.grid, rho_g) - expected) <= 1e-14 * 60);
        }
    }
}

TEST_CASE("the gather is the transpose of the deposit") {
    for (const Mesh& m : meshes(false)) {
        CAPTURE(m.name);
        const std::vector<Particles> species{scattered(m, 200, -0.3, 4)};
        // Any field, with its ghosts.
        Solved any = solve(m, {scattered(m, 50, 1, 5)});
        Random random(6);
        for (NodeField& E : any.field.E_g) E = {random() - 0.5, random() - 0.5};
        for (long j = 0; j <= m.grid.z.cells; ++j) {  // node N is node 0 in a periodic direction
            for (long i = 0; i <= m.grid.x.cells; ++i) {
                const long a = m.grid.x.periodic ? i % m.grid.x.cells : i,
                           b = m.grid.z.periodic ? j % m.grid.z.cells : j;
                any.field.E_g[std::size_t(m.grid.index(i, j))] =
                    any.field.E_g[std::size_t(m.grid.index(a, b))];
            }
        }
        cic::fill_ghosts(m.grid, false, any.field.E_g);
        DepositScratch scratch;
        Field rho_g;
        deposit_charge(species, m.grid, m.scheme, 0, scratch, rho_g);
        double on_particles = 0, on_mesh = 0;
        for (const auto& E : gathered(m, any.field.E_g, species[0]))
            on_particles += -0.3 * (E[0] + 2 * E[1]);
        const bool plane = m.scheme.dimensions == 2;
        for_each_node(m.grid, [&](long n, double volume) {
            const NodeField& E = any.field.E_g[std::size_t(n)];
            on_mesh += rho_g[n] * volume * (E.x + (plane ? 2 * E.z : 0));
        });
        CHECK(std::fabs(on_particles - on_mesh) <= 1e-14 * 60);
    }
}

TEST_CASE("a particle exerts no force on itself in the momentum scheme") {
    for (const Mesh& m : meshes(false)) {
        if (!m.grid.x.periodic || !m.grid.z.periodic) continue;
        for (const bool nine_point : {false, true}) {
            CAPTURE(m.name);
            double most = 0;
            for (std::uint64_t seed = 0; seed < 20; ++seed) {
                const Particles one = scattered(m, 1, 1, seed);
                const Solved s = solve(m, {one}, -mean_charge(m, one), nine_point);
                for (const auto& E : gathered(m, s.field.E_g, one))
                    most = worst({most, std::fabs(E[0]), std::fabs(E[1])});
            }
            CHECK(most <= 1e-15 * 10);
        }
    }
}

TEST_CASE("the energy scheme pulls a particle to the middle of its cell") {
    // F = -q^2 (f - 1/2) for a charge q per area, f its place in the cell, in a long box.
    Mesh m{{{4096, 0, 4096, true}, {1, 0, 1, true}}, {1, true, 1}, ""};
    for (const double f : {0.0625, 0.25, 0.5, 0.875}) {
        Particles one;
        one.q_p = 1.3, one.m_p = 1;
        one.x_p = {2000 + f}, one.vx_p = {0};
        const Solved s = solve(m, {one}, -mean_charge(m, one));
        CHECK(std::fabs(gathered(m, s.field.E_g, one)[0][0] + 1.3 * (f - 0.5)) <= 1.3 / 4096);
    }
}

TEST_CASE("all forces together vanish in the momentum scheme and not in the energy scheme") {
    for (const bool energy : {false, true}) {
        for (const Mesh& m : meshes(energy)) {
            if (!m.grid.x.periodic || !m.grid.z.periodic) continue;
            CAPTURE(m.name);
            const Particles cloud = scattered(m, 40, -0.4, 7);
            const Solved s = solve(m, {cloud}, -mean_charge(m, cloud));
            std::array<double, 2> total{};
            double size = 0;
            for (const auto& E : gathered(m, s.field.E_g, cloud)) {
                for (std::size_t a = 0; a < 2; ++a) total[a] += E[a];
                size += std::fabs(E[0]);
            }
            if (!energy) {
                CHECK(std::fabs(total[0]) <= 1e-14 * size);
                CHECK(std::fabs(total[1]) <= 1e-14 * size);
            } else {
                CHECK(std::fabs(total[0]) >= 1e-4 * size);
            }
        }
    }
}

TEST_CASE("the force of the energy scheme is the gradient of the field energy") {
    for (const Mesh& m : meshes(true)) {
        for (const bool floating : {false, true}) {
            if (floating && m.grid.x.periodic == m.grid.z.periodic) continue;
            CAPTURE(m.name);
            CAPTURE(floating);
            Particles cloud = scattered(m, 20, -0.4, 8);
            const double background = -mean_charge(m, cloud);
            Walls walls;
            walls[x_low].potential = 0.6, walls[x_high].potential = -0.3;
            walls[z_low].potential = 0.6, walls[z_high].potential = -0.4;
            for (const WallName high : {x_high, z_high})
                if (floating) walls[high] = {true, 0, 0.8};
            // What batteries have given is no energy of the field.
            const auto energy = [&](const Particles& c) {
                const Solved s = solve(m, {c}, background, false, walls);
                double sum = field_energy(m.grid, s.rho_g, s.field);
                for (const WallName wall : {x_low, x_high, z_low, z_high}) {
                    const bool along_x = wall == x_low || wall == x_high;
                    if (!s.field.walls[wall].floating)
                        sum -= walls[wall].potential * s.field.walls[wall].charge *
                               (along_x ? m.grid.z : m.grid.x).length;
                }
                return sum;
            };
            const auto E =
                gathered(m, solve(m, {cloud}, background, false, walls).field.E_g, cloud);
            for (const std::size_t p : {0UL, 3UL, 5UL, 8UL, 10UL, 17UL}) {
                for (std::size_t a = 0; a < (m.scheme.dimensions == 2 ? 2 : 1); ++a) {
                    auto& x = a == 0 ? cloud.x_p : cloud.z_p;
                    const double here = x[p], h = 1e-5;
                    x[p] = here + h;
                    const double after = energy(cloud);
                    x[p] = here - h;
                    const double before = energy(cloud);
                    x[p] = here;
                    CHECK(std::fabs(cloud.q_p * E[p][a] + (after - before) / (2 * h)) <= 2e-9);
                }
            }
        }
    }
}

TEST_CASE("the field of the energy scheme is minus the gradient of the potential under the cloud") {
    for (const Mesh& m : meshes(true)) {
        CAPTURE(m.name);
        Walls walls;  // of a box whose potentials are unlike where they meet
        walls[x_low].potential = 2, walls[z_low].potential = -2, walls[x_high].potential = 0.5;
        const Particles cloud = scattered(m, 20, -0.4, 8);
        const Solved s = solve(m, {cloud}, -mean_charge(m, cloud), false, walls);
        Particles probes = scattered(m, 60, 1, 9);
        const auto nodes = [](const common::Axis& axis) { return axis.cells + !axis.periodic; };
        const auto potential = [&](std::size_t p) {
            Particles one = probes;
            one.x_p = {probes.x_p[p]}, one.vx_p = {0};
            if (m.scheme.dimensions == 2) one.z_p = {probes.z_p[p]}, one.vz_p = {0};
            DepositScratch scratch;
            Field rho_g;
            deposit_charge({one}, m.grid, m.scheme, 0, scratch, rho_g);
            const auto inside = [](const common::Axis& axis, long i) {
                return axis.periodic || (i > 0 && i < axis.cells) ? 1 : 0.5;
            };
            double sum = 0;
            for (long j = 0; j < nodes(m.grid.z); ++j)
                for (long i = 0; i < nodes(m.grid.x); ++i)
                    sum += rho_g[m.grid.index(i, j)] * s.field.phi[m.grid.index(i, j)] *
                           inside(m.grid.x, i) * inside(m.grid.z, j);
            return sum * m.grid.x.spacing() * m.grid.z.spacing() / probes.q_p;
        };
        const auto E = gathered(m, s.field.E_g, probes);
        for (std::size_t p = 0; p < E.size(); ++p)
            for (std::size_t a = 0; a < (m.scheme.dimensions == 2 ? 2 : 1); ++a) {
                Real& x = a == 0 ? probes.x_p[p] : probes.z_p[p];
                const double here = x, h = 1e-5;
                x = here + h;
                const double after = potential(p);
                x = here - h;
                const double before = potential(p);
                x = here;
                CHECK(std::fabs(E[p][a] + (after - before) / (2 * h)) <= 1e-8);
            }
    }
}

TEST_CASE("particles that fill the mesh evenly are neutral with as much background") {
    for (const bool energy : {false, true}) {
        for (const Mesh& m : meshes(energy)) {
            CAPTURE(m.name);
            CAPTURE(energy);
            const long per_cell = 32, in_x = per_cell * m.grid.x.cells,
                       in_z = m.scheme.dimensions == 2 ? per_cell * m.grid.z.cells : 1;
            Particles s;
            s.m_p = 1, s.q_p = -m.grid.x.length * m.grid.z.length / double(in_x * in_z);
            for (long j = 0; j < in_z; ++j)
                for (long i = 0; i < in_x; ++i) {
                    s.x_p.push_back(m.grid.x.low + m.grid.x.length * (real(i) + 0.5) / real(in_x));
                    if (in_z > 1)
                        s.z_p.push_back(m.grid.z.low +
                                        m.grid.z.length * (real(j) + 0.5) / real(in_z));
                }
            DepositScratch scratch;
            Field rho_g;
            deposit_charge({s}, m.grid, m.scheme, 1, scratch, rho_g);
            double most = 0;
            for_each_node(m.grid, [&](long n, double) {
                most = worst({most, std::fabs(rho_g[n])});
            });
            CHECK(most <= 3e-4);  // of the lattice, 1/(12 32^2) in each direction
        }
    }
}

TEST_CASE("a uniform field between walls is the same at every particle up to the walls") {
    for (const bool energy : {false, true}) {
        for (const Mesh& m : meshes(energy)) {
            if (m.grid.x.periodic == m.grid.z.periodic) continue;
            const bool along_x = !m.grid.x.periodic;
            const common::Axis& axis = along_x ? m.grid.x : m.grid.z;
            Particles s = scattered(m, 200, 0, 21);
            (along_x ? s.x_p : s.z_p)[0] = axis.low;
            (along_x ? s.x_p : s.z_p)[1] = axis.high();
            const double E = 1.7;
            for (const int floating : {0, 1, 2}) {  // walls at potentials; the upper one; both
                CAPTURE(m.name);
                CAPTURE(energy);
                CAPTURE(floating);
                Walls walls;
                Wall &low = walls[along_x ? x_low : z_low],
                     &high = walls[along_x ? x_high : z_high];
                low = {floating > 1, 0.4, E};
                high = {floating > 0, 0.4 - E * axis.length, -E};
                double most = 0;
                for (const auto& E_p : gathered(m, solve(m, {s}, 0, false, walls).field.E_g, s))
                    most = worst({most, std::fabs(E_p[along_x ? 0 : 1] - E),
                                  std::fabs(E_p[along_x ? 1 : 0])});
                CHECK(most <= 1e-13);
            }
        }
    }
}

TEST_CASE("the difference equation holds on every node") {
    // Also on meshes of several tiles, the last of them as narrow or as wide as it can be.
    std::vector<Mesh> all = meshes(false);
    for (const long nz : {15, 16, 17, 33})
        all.push_back(
            {{{17, 0, 17, nz % 2 == 0}, {nz, 0, real(nz), true}}, {1, false, 2}, "tiles"});
    for (const Mesh& m : all) {
        for (const bool nine_point : {false, true}) {
            CAPTURE(m.name);
            CAPTURE(nine_point);
            const Particles cloud = scattered(m, 60, 0.8, 9);
            const bool closed = m.grid.x.periodic && m.grid.z.periodic;
            Walls walls;
            walls[x_low].potential = 0.7, walls[x_high].potential = 0.7;
            walls[z_low].potential = 0.7, walls[z_high].potential = 0.7;
            const Solved s =
                solve(m, {cloud}, closed ? -mean_charge(m, cloud) : 0, nine_point, walls);
            const Field& phi = s.field.phi;
            const double dx = m.grid.x.spacing(), dz = m.grid.z.spacing();
            const long row = m.grid.stride();
            const auto delta_xx = [&](long n) {
                return (phi[n + 1] - 2 * phi[n] + phi[n - 1]) / (dx * dx);
            };
            const double coupling = nine_point ? (dx * dx + dz * dz) / 12 : 0;
            double most = 0;
            for (long j = m.grid.z.periodic ? 0 : 1; j < m.grid.z.cells; ++j) {
                for (long i = m.grid.x.periodic ? 0 : 1; i < m.grid.x.cells; ++i) {
                    const long n = m.grid.index(i, j);
                    const double delta_zz = (phi[n + row] - 2 * phi[n] + phi[n - row]) / (dz * dz);
                    const double both =
                        (delta_xx(n + row) - 2 * delta_xx(n) + delta_xx(n - row)) / (dz * dz);
                    most = worst(
                        {most, std::fabs(delta_xx(n) + delta_zz + coupling * both + s.rho_g[n])});
                }
            }
            CHECK(most <= 1e-12);
            // The field on nodes away from walls: what phi falls by over two cells.
            most = 0;
            for (long j = m.scheme.dimensions == 2 ? 1 : 0; j < m.grid.z.cells; ++j) {
                for (long i = 1; i < m.grid.x.cells; ++i) {
                    const long n = m.grid.index(i, j);
                    const NodeField& E = s.field.E_g[n];
                    most = worst({most, E.x - (phi[n - 1] - phi[n + 1]) / (2 * dx)});
                    if (m.scheme.dimensions == 2 && j + 1 < m.grid.z.cells)
                        most = worst({most, E.z - (phi[n - row] - phi[n + row]) / (2 * dz)});
                }
            }
            CHECK(most <= 1e-12);
            if (!m.grid.x.periodic) {
                for (long j = 0; j < m.grid.z.cells; ++j) {
                    CHECK(std::fabs(phi[m.grid.index(0, j)] - 0.7) <= 1e-14);
                    CHECK(std::fabs(phi[m.grid.index(m.grid.x.cells, j)] - 0.7) <= 1e-14);
                }
            }
        }
    }
}

TEST_CASE("the force between walls is the difference of the field pressures") {
    for (int order = 0; order <= 2; ++order) {
        Mesh m{{{11, 0.5, 3.0, false}, {1, 0, 1, true}}, {order, false, 1}, ""};
        for (const bool floating : {false, true}) {
            CAPTURE(order);
            const Particles cloud = scattered(m, 30, 0.3, 10);
            Walls walls;
            walls[x_low].potential = 1.0;
            if (floating) {
                walls[x_low] = {true, 0, 0.4};
                walls[x_high] = {true, 0, -0.4 - 0.3 * 30};
            }
            const Solved s = solve(m, {cloud}, 0, false, walls);
            double force = 0;
            for (const auto& E : gathered(m, s.field.E_g, cloud)) force += 0.3 * E[0];
            // E points along x away from the low wall and toward the high one.
            const double low = s.field.walls[x_low].charge, high = s.field.walls[x_high].charge;
            CHECK(std::fabs(force - 0.5 * (high * high - low * low)) <= 1e-12);
            // Gauss's law from wall to wall.
            CHECK(std::fabs(low + high + 0.3 * 30) <= 1e-12);
            // The low one of two floating walls is where the potential is zero.
            CHECK(s.field.walls[x_low].potential == (floating ? 0 : 1));
            CHECK(s.field.walls[x_high].potential == s.field.phi[m.grid.index(11, 0)]);
        }
    }
}

TEST_CASE("grounded walls have together the opposite of the charge between them") {
    for (const bool energy : {false, true})
        for (const Mesh& m : meshes(energy)) {
            if (m.grid.x.periodic && m.grid.z.periodic) continue;
            CAPTURE(m.name);
            CAPTURE(energy);
            Walls walls;
            walls[x_low].potential = 2, walls[z_low].potential = -2, walls[z_high].potential = 0.5;
            const Particles cloud = scattered(m, 40, -0.4, 8);
            const Solved s = solve(m, {cloud}, 0, false, walls);
            double all = mean_charge(m, cloud) * m.grid.x.length * m.grid.z.length;
            for (const WallName wall : {x_low, x_high, z_low, z_high}) {
                const bool along_x = wall == x_low || wall == x_high;
                if (!(along_x ? m.grid.x : m.grid.z).periodic)
                    all += s.field.walls[wall].charge * (along_x ? m.grid.z : m.grid.x).length;
            }
            CHECK(std::fabs(all) <= 1e-12);
        }
}

TEST_CASE("a floating wall carries its charge and a row of floating walls no net field") {
    Mesh m{{{10, 0, 5.0, false}, {8, 0, 3.0, true}}, {1, false, 2}, ""};
    const Particles cloud = scattered(m, 40, -0.2, 11);
    Walls walls;
    walls[x_low].potential = 0;
    walls[x_high] = {true, 0, -0.35};
    const Solved s = solve(m, {cloud}, 0, false, walls);
    const long N = m.grid.x.cells;
    double sigma = 0, spread = 0;
    for (long j = 0; j < m.grid.z.cells; ++j) {
        const long n = m.grid.index(N, j);
        sigma += cic::surface_charge(s.field.phi[n], s.field.phi[n - 1], s.rho_g[n],
                                     m.grid.x.spacing()) /
                 double(m.grid.z.cells);
        spread = worst({spread, std::fabs(s.field.phi[n] - s.field.phi[m.grid.index(N, 0)])});
    }
    CHECK(std::fabs(sigma + 0.35) <= 1e-13);  // the charge that it was given
    CHECK(spread <= 1e-13);                   // a conductor has one potential
}

TEST_CASE("a mode along floating walls obeys Gauss's law in the half cells at both") {
    const long N = 6;
    const double dx = 0.4, c = 0.9, K2 = 1.7;  // K2 fixes the mean
    const Wall low{true, 0, 0.3}, high{true, 0, -0.8};
    Random random(31);
    std::vector<double> rho, scratch;
    for (long i = 0; i <= N; ++i) rho.push_back(random() - 0.5);
    std::vector<double> phi = rho;
    solve_tridiagonal(dx, c, K2, low, high, phi.data(), N, scratch);
    // What flows out of a cell through its faces, and out of the wall, is what is in it.
    const auto out = [&](std::size_t i, std::size_t to) { return c * (phi[i] - phi[to]) / dx; };
    const auto held = [&](std::size_t i) { return dx * (rho[i] - K2 * phi[i]); };
    double most = worst({std::fabs(out(0, 1) - 0.5 * held(0) - low.charge),
                         std::fabs(out(6, 5) - 0.5 * held(6) - high.charge)});
    for (std::size_t i = 1; i < 6; ++i)
        most = worst({most, std::fabs(out(i, i - 1) + out(i, i + 1) - held(i))});
    CHECK(most <= 1e-14);
}

TEST_CASE("the leapfrog can be run backwards") {
    Mesh m{{{16, 0, 16, true}, {16, 0, 16, true}}, {2, false, 2}, ""};
    std::vector<Particles> species{scattered(m, 400, -0.64, 12)};
    Particles& s = species[0];
    s.vy_p.assign(400, 0.1);
    const auto start_x = s.x_p, start_vx = s.vx_p, start_vy = s.vy_p;
    MagneticField B{0.2, 0.9, -0.3};
    FieldSolver solver(m.grid, m.scheme, false, 1);
    DepositScratch scratch;
    Field rho_g;
    FieldState field;
    const auto steps = [&](double dt, bool move_first) {
        for (int n = 0; n < 50; ++n) {
            if (move_first)
                for_each_batch(species,
                               [&](ParticleBatch& batch) { move_particles(m.grid, dt, batch); });
            deposit_charge(species, m.grid, m.scheme, 1, scratch, rho_g);
            solve_field(solver, rho_g, field);
            for_each_batch(species, [&](ParticleBatch& batch) {
                FieldAtParticles E_p;
                gather_field(field.E_g, m.grid, m.scheme, batch, E_p);
                accelerate(E_p, B, dt, batch);
                if (!move_first) move_particles(m.grid, dt, batch);
            });
        }
    };
    steps(0.2, false);
    CHECK(std::fabs(s.x_p[0] - start_x[0]) > 0.1);
    steps(-0.2, true);
    double most = 0;
    for (std::size_t p = 0; p < s.x_p.size(); ++p) {
        const double d = std::fabs(s.x_p[p] - start_x[p]);
        most = worst({most, std::min(d, 16 - d), std::fabs(s.vx_p[p] - start_vx[p]),
                      std::fabs(s.vy_p[p] - start_vy[p])});
    }
    CHECK(most <= 1e-9);
}

TEST_CASE("the rotation keeps the speed and its angle is twice the arc tangent") {
    Particles s;
    s.q_p = -0.5, s.m_p = 0.25;
    s.x_p = {0.1}, s.vx_p = {0.3}, s.vy_p = {-0.2}, s.vz_p = {0.7};
    const MagneticField B{0.4, -0.3, 1.2};
    const double dt = 0.6, Omega_dt = -2.0 * B.size() * dt;
    const Eigen::Vector3d b = Eigen::Vector3d(B.x, B.y, B.z) / B.size(), v(0.3, -0.2, 0.7);
    ParticleBatch batch = whole(s);
    FieldAtParticles E_p{};
    accelerate(E_p, B, dt, batch);
    const Eigen::Vector3d after(s.vx_p[0], s.vy_p[0], s.vz_p[0]);
    CHECK(std::fabs(after.norm() - v.norm()) <= 4 * eps);
    CHECK(std::fabs(after.dot(b) - v.dot(b)) <= 4 * eps);
    const Eigen::Vector3d before_across = v - v.dot(b) * b, across = after - after.dot(b) * b;
    // dv/dt = (q/m) v x B turns by -Omega about b.
    const double angle = std::atan2(before_across.cross(across).dot(b), before_across.dot(across));
    CHECK(std::fabs(angle + 2 * std::atan(0.5 * Omega_dt)) <= 8 * eps);
    CHECK(std::fabs(batch.sums.kinetic - 0.5 * 0.25 * v.squaredNorm()) <= 4 * eps);
    for (int a = 0; a < 3; ++a)
        CHECK(std::fabs(batch.sums.momentum[std::size_t(a)] - 0.25 * after[a]) <= 4 * eps);
}

TEST_CASE("the drift in E and B is exact for any time step") {
    Particles s;
    s.q_p = 1, s.m_p = 0.01;
    s.x_p = {0.1}, s.z_p = {0.1};
    const MagneticField B{0, 2, 0};
    const double E_x = 0.3, E_z = -0.5;  // E x B / B^2 = (-E_z B_y, 0, E_x B_y) / B_y^2
    s.vx_p = {-E_z / 2}, s.vy_p = {0}, s.vz_p = {E_x / 2};
    FieldAtParticles E_p{};
    E_p.x[0] = E_x, E_p.z[0] = E_z;
    for (const double dt : {0.001, 0.01, 0.1}) {  // Omega dt = 0.2, 2, 20
        ParticleBatch batch = whole(s);
        for (int n = 0; n < 100; ++n) accelerate(E_p, B, dt, batch);
        CHECK(std::fabs(s.vx_p[0] + E_z / 2) <= 1e-13);
        CHECK(std::fabs(s.vz_p[0] - E_x / 2) <= 1e-13);
        CHECK(std::fabs(batch.sums.kinetic - 0.5 * 0.01 * (0.25 * 0.25 + 0.15 * 0.15)) <= 1e-13);
    }
}

TEST_CASE("the start is half a step before") {
    Particles s;
    s.q_p = -1, s.m_p = 1;
    s.x_p = {0.1}, s.vx_p = {0.25};
    FieldAtParticles E_p{};
    E_p.x[0] = 0.8;
    ParticleBatch batch = whole(s);
    start_leapfrog(E_p, {}, 0.1, batch);
    CHECK(std::fabs(s.vx_p[0] - (0.25 + 0.05 * 0.8)) <= eps);
    accelerate(E_p, {}, 0.1, batch);
    CHECK(std::fabs(s.vx_p[0] - (0.25 - 0.05 * 0.8)) <= eps);
    // (1/2) m v_old v_new = (1/2) m (v^2 - h^2)
    CHECK(std::fabs(batch.sums.kinetic - 0.5 * (0.25 * 0.25 - 0.04 * 0.04)) <= eps);
}

TEST_CASE("walls take charge reflect speed and lose nothing") {
    Case parameters;
    parameters.dimensions = 2;
    parameters.grid = {{8, 0, 8, false}, {8, 0, 4, false}};
    parameters.boundary_x = parameters.boundary_z = "wall";
    parameters.walls[x_low] = {"floating", "absorb", 0};
    parameters.walls[x_high] = {"grounded", "reflect", 0};
    parameters.walls[z_low] = {"grounded", "absorb", 0};
    parameters.walls[z_high] = {"grounded", "reflect", 0};
    SpeciesCase from;
    from.name = "scattered";
    parameters.species = {from};
    State state;
    state.walls = walls_of(parameters);
    state.emitted_again = {0};
    Particles s;
    s.q_p = -0.5, s.m_p = 0.5;
    //        in   absorbed  reflected absorbed  reflected  both reflected
    s.x_p = {4.0, -0.25, 8.5, 3.0, 3.0, 8.125};
    s.z_p = {1.0, 1.0, 1.0, -0.5, 4.25, 4.125};
    s.vx_p = {1, -2, 3, 1, 1, 2};
    s.vz_p = {1, 1, 1, -1, 2, 3};
    state.species = {s};
    apply_particle_boundaries(parameters.grid, particle_boundaries(parameters, state.species), 0,
                              state.species, state.walls, state.emitted_again);
    const Particles& after = state.species[0];
    REQUIRE(after.count() == 4);
    CHECK(state.walls[x_low].charge == -0.5 / 4);  // per area, over the length of the wall
    double energy = 0;
    for (std::size_t p = 0; p < 4; ++p) {
        CHECK(after.x_p[p] >= 0);
        CHECK(after.x_p[p] <= 8);
        CHECK(after.z_p[p] >= 0);
        CHECK(after.z_p[p] <= 4);
        energy += after.vx_p[p] * after.vx_p[p] + after.vz_p[p] * after.vz_p[p];
    }
    CHECK(energy == 2 + 10 + 5 + 13);
    const auto at = [&](double x) {
        return std::find(after.x_p.begin(), after.x_p.end(), x) - after.x_p.begin();
    };
    REQUIRE(at(7.5) < 4);
    CHECK(after.vx_p[std::size_t(at(7.5))] == -3);
    REQUIRE(at(7.875) < 4);
    CHECK(after.vz_p[std::size_t(at(7.875))] == -3);
}

TEST_CASE("a source emits its rate with the flux of a half Maxwellian") {
    Case parameters;
    parameters.grid.x = {8, 0, 1e6, false};
    parameters.grid.z.length = 2;
    parameters.boundary_x = "wall";
    parameters.dt = 0.25;
    parameters.walls[x_low] = {"floating", "source", 0};
    SpeciesCase from;
    from.name = "electrons", from.mass = 4, from.emission = 1.25, from.emission_temperature = 9;
    parameters.species = {from};
    State state;
    state.walls = walls_of(parameters);
    state.emitted_again = {0};
    Particles s;
    s.q_p = -0.001, s.m_p = 0.004;  // 0.001 electrons
    state.species = {s};
    const long steps = 200;
    const ParticleBoundaries boundaries = particle_boundaries(parameters, state.species);
    for (long step = 0; step < steps; ++step)
        apply_particle_boundaries(parameters.grid, boundaries, step, state.species, state.walls,
                                  state.emitted_again);
    const Particles& after = state.species[0];
    const double N = double(after.count());
    CHECK(after.count() == 125000);  // 1.25 / 0.001 on a length of 2 per unit of time for 50
    CHECK(std::fabs(state.walls[x_low].charge - 0.001 * N / 2) <= 1e-9);
    // <v> = (pi T / 2 m)^1/2 and <v^2> = 2 T/m, within four standard errors of N numbers.
    double v = 0, v2 = 0;
    for (const double u : after.vx_p) v += u / N, v2 += u * u / N;
    CHECK(std::fabs(v / std::sqrt(pi * 9 / 8) - 1) <= 4 * 0.523 / std::sqrt(N));
    CHECK(std::fabs(v2 / 4.5 - 1) <= 4 / std::sqrt(N));
}

TEST_CASE("sorting by row moves whole particles") {
    Mesh m{{{8, 0, 8, true}, {16, 0, 4, true}}, {1, false, 2}, ""};
    std::vector<Particles> species{scattered(m, 1000, 1, 13)};
    Particles& s = species[0];
    for (std::size_t p = 0; p < 1000; ++p) s.vx_p[p] = s.x_p[p] + 10 * s.z_p[p];
    double sum = 0, after = 0;
    for (std::size_t p = 0; p < 1000; ++p) sum += s.vx_p[p];
    common::SortScratch<Real> scratch;
    sort_particles(m.grid, scratch, species);
    for (std::size_t p = 0; p < 1000; ++p) {
        after += s.vx_p[p];
        CHECK(s.vx_p[p] == s.x_p[p] + 10 * s.z_p[p]);
        if (p > 0) CHECK(std::floor(4 * s.z_p[p]) >= std::floor(4 * s.z_p[p - 1]));
    }
    CHECK(std::fabs(after - sum) <= 1e-9);
    CHECK(sort_is_due(25, 50));
    CHECK(sort_is_due(1, 7));
    CHECK(!sort_is_due(25, 51));
    CHECK(!sort_is_due(0, 50));
}

TEST_CASE("a table of a distribution has its moments and its inverse that of its integral") {
    // Constant in four pieces of a quarter between 1 and 2, as 1 : 2 : 3 : 2.
    const Distribution line = tabulate(1, 2, 4, false, [](double v) {
        return v < 1.25 ? 1.0 : v < 1.5 || v > 1.75 ? 2.0 : 3.0;
    });
    CHECK(line.mean() == facts::about((1.125 + 2 * 1.375 + 3 * 1.625 + 2 * 1.875) / 8));
    double mean_square = 0;  // about 1, of each piece that of its middle and 1/12 of its width
    for (const auto& [part, middle] : {std::pair(1, 0.125), {2, 0.375}, {3, 0.625}, {2, 0.875}})
        mean_square += part / 8.0 * (middle * middle + 0.0625 / 12);
    CHECK(line.mean_square(1) == facts::about(mean_square));
    for (const auto& [u, v] : {std::pair(0.0, 1.0), {0.0625, 1.125}, {0.25, 1.375}, {1.0, 2.0}})
        CHECK(line.inverse(u) == facts::about(v));
    CHECK(line.inverse(1.5) == 2);
    CHECK(line.inverse(-1) == 1);
    // Speeds in a plane have 2 pi v f(v): of a uniform disk a quarter is within half of its radius.
    const Distribution disk = tabulate(0, 3, 600, true, [](double) { return 1.0; });
    CHECK(disk.inverse(0.25) == facts::about(1.5));
    CHECK(disk.mean() == facts::about(2).epsilon(1e-5));
}

TEST_CASE("a perturbed species has the density that the case asks for") {
    for (const std::string loading : {"quiet", "lattice", "random"}) {
        CAPTURE(loading);
        Case parameters;
        parameters.grid.x = {32, 0, 2.0, true};
        SpeciesCase s;
        s.name = "electrons", s.loading = loading, s.particles_per_cell = 4000;
        s.amplitude = 0.02, s.mode_x = 3, s.density = 0.5;
        parameters.species = {s};
        const Particles particles = load_species(parameters, s, 1);
        CHECK(particles.count() == 128000);
        CHECK(std::fabs(particles.q_p * 128000 + 0.5 * 2.0) <= 1e-12);
        std::complex<double> mode = 0;
        const double k = wave_vector(parameters, 3, 0).x;
        for (const double x : particles.x_p) mode += std::polar(2.0 / 128000, -k * x);
        // The displacement is linear in the amplitude: 3/8 of its square remains.
        const double noise = loading == "random" ? 4 * std::sqrt(2.0 / 128000) : 1e-5;
        CHECK(std::abs(mode - 0.02) <= noise);
        const auto [least, most] = std::ranges::minmax(particles.x_p);
        CHECK((least >= 0 && most < 2));  // who is moved across the seam comes in again
    }
    const PerturbationCase standing{"wave", "electrons", 2, 3, 0.1};
    CHECK((standing.is_of(2, 3) && standing.is_of(-2, -3)));
    CHECK((!standing.is_of(-2, 3) && !standing.is_of(2, -3)));
}

TEST_CASE("simulation particles have together the charge and the mass of all that they stand for") {
    for (const double charge : {-1.0, -0.5, 2.0}) {
        Case parameters;
        parameters.grid.x = {8, 0, 5.0, true};
        SpeciesCase s;
        s.name = "ions", s.density = 0.3, s.charge = charge, s.mass = 4, s.particles_per_cell = 10;
        parameters.species = {s};
        const Particles loaded = load_species(parameters, s, 1);
        CHECK(std::fabs(80 * loaded.q_p - charge * 0.3 * 5) <= 1e-14);
        CHECK(std::fabs(80 * loaded.m_p - 4 * 0.3 * 5) <= 1e-14);
    }
}

TEST_CASE("a quiet Maxwellian has its moments") {
    Case parameters;
    parameters.grid.x = {32, 0, 32, true};
    SpeciesCase s;
    s.name = "electrons", s.particles_per_cell = 1000;
    s.temperature_x = 2, s.mass = 0.5, s.drift_x = 0.7;
    parameters.species = {s};
    const Particles particles = load_species(parameters, s, 1);
    double v = 0, v2 = 0, v4 = 0;
    for (const double u : particles.vx_p) {
        const double c = (u - 0.7) / 2;
        v += c / 32000, v2 += c * c / 32000, v4 += c * c * c * c / 32000;
    }
    CHECK(std::fabs(v) <= 1e-3);
    CHECK(std::fabs(v2 - 1) <= 2e-3);
    CHECK(std::fabs(v4 - 3) <= 0.03);
}

TEST_CASE("what is loaded is spread evenly and each quantity independently of the others") {
    for (const std::string profile : {"line", "uniform", "layer", "disk"}) {
        for (const std::string loading : {"quiet", "random"}) {
            CAPTURE(profile);
            CAPTURE(loading);
            Case parameters;
            parameters.dimensions = profile == "line" ? 1 : 2;
            parameters.grid = {{16, -1, 4, true}, {1, 0, 1, true}};
            if (profile != "line") parameters.grid.z = {8, 0.5, 2, true};
            parameters.B.y = 1;
            SpeciesCase s;
            s.profile = profile == "line" ? "uniform" : profile, s.loading = loading;
            s.center_x = 0.9, s.center_z = 1.5, s.half_width = 0.6, s.density = 0.3, s.mass = 0.5;
            s.temperature_x = 2, s.temperature_y = 0.5, s.temperature_z = 1.5;
            s.drift_x = 0.1, s.drift_y = -0.2, s.drift_z = 0.4, s.particles_per_cell = 1000;
            const Particles loaded = load_species(parameters, s, 1);

            // The measures in which all are uniform in (0, 1).
            std::vector<std::vector<double>> u(5);
            const auto maxwellian = [](double v, double drift, double T) {
                return 0.5 * std::erfc((drift - v) / std::sqrt(2 * T / 0.5));
            };
            for (std::size_t p = 0; p < loaded.x_p.size(); ++p) {
                const double x = loaded.x_p[p] - 0.9,
                             z = loaded.z_p.empty() ? 0 : loaded.z_p[p] - 1.5;
                if (profile == "disk") {
                    u[0].push_back((x * x + z * z) / 0.36);
                    u[1].push_back(std::atan2(z, x) / (2 * pi) + 0.5);
                } else {
                    u[0].push_back((x + 1.9) / 4);
                    if (profile != "line")
                        u[1].push_back((z / (profile == "layer" ? 1.2 : 2)) + 0.5);
                }
                u[2].push_back(maxwellian(loaded.vx_p[p], 0.1, 2));
                u[3].push_back(maxwellian(loaded.vy_p[p], -0.2, 0.5));
                u[4].push_back(maxwellian(loaded.vz_p[p], 0.4, 1.5));
            }
            // Of N independent numbers the mean wave is larger than this once in e^16 trials.
            const double N = double(loaded.count());
            CHECK(unevenness(u) <= 4 / std::sqrt(N));
            if (loading == "quiet" && profile == "line")
                CHECK(worst({std::fabs(u[0].front() - 0.5 / N),
                             std::fabs(u[0].back() - 1 + 0.5 / N)}) <= 4 * eps);

            const double volume = profile == "line"      ? 4
                                  : profile == "uniform" ? 8
                                  : profile == "layer"   ? 4 * 1.2
                                                         : pi * 0.36;
            CHECK(std::fabs(N - 1000 * volume / parameters.grid.cell_area()) <= 0.5);
            CHECK(std::fabs(N * loaded.q_p + 0.3 * volume) <= 1e-12);
            CHECK(std::fabs(N * loaded.m_p - 0.5 * 0.3 * volume) <= 1e-12);
        }
    }
}

TEST_CASE("a lattice has one particle in the middle of each of its cells") {
    Case parameters;
    parameters.dimensions = 2;
    parameters.grid = {{5, -1, 2, true}, {4, 0.5, 3, true}};
    SpeciesCase s;
    s.loading = "lattice", s.particles_per_cell = 6;  // three columns and two rows in a cell
    const Particles loaded = load_species(parameters, s, 1);
    REQUIRE(loaded.count() == 120);
    std::vector<int> held(120, 0);
    for (std::size_t p = 0; p < 120; ++p) {
        const double column = (loaded.x_p[p] + 1) / 2 * 15 - 0.5,
                     row = (loaded.z_p[p] - 0.5) / 3 * 8 - 0.5;
        CHECK(std::fabs(column - std::round(column)) <= 32 * eps);
        CHECK(std::fabs(row - std::round(row)) <= 32 * eps);
        ++held[std::size_t(std::lround(column) + 15 * std::lround(row))];
    }
    CHECK(held == std::vector<int>(120, 1));
}

TEST_CASE("every particle is in one batch and its work leaves the others alone") {
    for (const long count :
         {0L, 1L, batch_size - 1, batch_size, batch_size + 1, 9 * batch_size + 5}) {
        CAPTURE(count);
        std::vector<Particles> species(1);
        resize(count, true, true, species[0]);
        for_each_batch(species, [&](ParticleBatch& batch) {
            CHECK(batch.count <= batch_size);
            for (long k = 0; k < batch.count; ++k) batch.vz_p[k] += 1;
            batch.sums.kinetic = double(batch.count);
            batch.sums.momentum = {1.0 * batch.sums.kinetic, 2 * batch.sums.kinetic,
                                   3 * batch.sums.kinetic};
        });
        CHECK(species[0].vz_p == std::vector<Real>(std::size_t(count), 1));
        CHECK(species[0].sums.kinetic == double(count));
        for (std::size_t a = 0; a < 3; ++a)
            CHECK(species[0].sums.momentum[a] == (real(long(a)) + 1) * real(count));
    }
    for (const bool magnetized : {false, true}) {
        for (Mesh m : meshes(false)) {
            CAPTURE(m.name);
            Particles s = scattered(m, 5, -1, 14);
            if (magnetized) resize(5, m.scheme.dimensions == 2, true, s);
            Particles before = s;
            const MeshField E_g(std::size_t(m.grid.size()), {0.3, -0.2});
            FieldAtParticles E_p;
            std::fill_n(E_p.x, 5, 7), std::fill_n(E_p.z, 5, 7);
            ParticleBatch batch = whole(s);
            batch.count = 3;
            gather_field(E_g, m.grid, m.scheme, batch, E_p);
            start_leapfrog(E_p, {0, 0.5, 0}, 0.1, batch);
            accelerate(E_p, {0, 0.5, 0}, 0.1, batch);
            move_particles(m.grid, 0.1, batch);
            for (const std::size_t p : {3u, 4u}) {
                CHECK(E_p.x[p] == 7);
                CHECK(E_p.z[p] == 7);
                for (std::size_t a = 0; a < 5; ++a)
                    if (!s.all()[a]->empty()) CHECK((*s.all()[a])[p] == (*before.all()[a])[p]);
            }
            CHECK(s.x_p[2] != before.x_p[2]);
            CHECK(std::fabs(batch.sums.momentum[0] - 0.7 * (s.vx_p[0] + s.vx_p[1] + s.vx_p[2])) <=
                  8 * eps);
        }
    }
}

TEST_CASE("a particle moves by its own velocity times the step between walls and across a seam") {
    for (const Mesh& m : meshes(false)) {
        CAPTURE(m.name);
        Particles s = scattered(m, 9, 1, 32);
        const Particles before = s;
        ParticleBatch batch = whole(s);
        move_particles(m.grid, 0.7, batch);
        const auto off = [](const common::Axis& axis, double way) {
            return std::fabs(axis.periodic ? std::remainder(way, axis.length) : way);
        };
        double most = 0;
        for (std::size_t p = 0; p < 9; ++p) {
            most = worst({most, off(m.grid.x, s.x_p[p] - before.x_p[p] - 0.7 * s.vx_p[p])});
            if (!s.z_p.empty())
                most = worst({most, off(m.grid.z, s.z_p[p] - before.z_p[p] - 0.7 * s.vz_p[p])});
        }
        CHECK(most <= 32 * eps);
    }
}

TEST_CASE("the amplitude of a mode of the field is that of minus the derivative of the potential") {
    const Grid grid{{16, 0, 4, true}, {8, 0, 3, true}};
    const double k_x = 2 * pi * 3 / 4, k_z = -2 * pi * 2 / 3, k = std::hypot(k_x, k_z);
    Field phi = Field::Zero(grid.size());
    for (long j = 0; j < 8; ++j)
        for (long i = 0; i < 16; ++i)
            phi[grid.index(i, j)] = std::cos(k_x * 0.25 * real(i) + k_z * 0.375 * real(j) - 0.3);
    const std::complex<double> of_field = FourierMode(grid, 3, -2, k).amplitude(grid, phi);
    CHECK(std::abs(of_field - std::complex<double>(0, -k) * std::polar(1.0, -0.3)) <= 1e-13);
    CHECK(std::abs(FourierMode(grid, 3, 2, k).amplitude(grid, phi)) <= 1e-13);
}

TEST_CASE("half a step backwards and one ahead is half a step ahead") {
    for (const bool plane : {false, true}) {
        for (const bool magnetized : {false, true}) {
            const MagneticField B = magnetized ? MagneticField{0.4, -0.3, 1.2} : MagneticField{};
            Particles s;
            s.q_p = -0.5, s.m_p = 0.25;
            resize(1, plane, magnetized, s);
            for (std::vector<Real>* quantity : s.all())
                if (!quantity->empty()) (*quantity)[0] = 0.3 + 0.1 * real(quantity - &s.x_p);
            Particles mirrored = s;
            FieldAtParticles E_p{};
            E_p.x[0] = 0.8, E_p.z[0] = -0.5;
            ParticleBatch batch = whole(s), other = whole(mirrored);
            start_leapfrog(E_p, B, 0.2, batch);
            accelerate(E_p, B, 0.2, batch);
            start_leapfrog(E_p, B, -0.2, other);
            for (std::size_t a = 0; a < 5; ++a)
                if (!s.all()[a]->empty())
                    CHECK(std::fabs((*s.all()[a])[0] - (*mirrored.all()[a])[0]) <= 4 * eps);
        }
    }
}

TEST_CASE(
    "a cold traveling wave starts with the velocities of a wave that runs at omega_p over k") {
    Case parameters;
    parameters.dimensions = 2;
    parameters.grid = {{16, -1, 4, true}, {8, 0.5, 3, true}};
    SpeciesCase s;
    s.name = "electrons", s.loading = "lattice", s.wave = "traveling", s.amplitude = 1e-4;
    s.mode_x = 2, s.mode_z = -1, s.drift_x = 0.2, s.drift_z = 0.3;
    parameters.species = {s};
    const WaveVector k = wave_vector(parameters, 2, -1);
    parameters.near = k.x * 0.2 + k.z * 0.3 + 1;  // of the two waves the one that runs along k
    const Particles loaded = load_species(parameters, s, 1);
    const double N = double(loaded.count());
    std::complex<double> along = 0, across = 0, density = 0;
    for (std::size_t p = 0; p < loaded.x_p.size(); ++p) {
        const double u_x = loaded.vx_p[p] - 0.2, u_z = loaded.vz_p[p] - 0.3;
        const std::complex<double> wave =
            std::polar(2 / N, -k.x * (loaded.x_p[p] + 1) - k.z * (loaded.z_p[p] - 0.5));
        along += wave * (u_x * k.x + u_z * k.z) / k.size();
        across += wave * (u_x * k.z - u_z * k.x) / k.size();
        density += wave;
    }
    // To first order in the amplitude.
    CHECK(std::abs(density - 1e-4) <= 1e-8);
    CHECK(std::abs(along - 1e-4 / k.size()) <= 1e-8);
    CHECK(std::abs(across) <= 1e-8);
}

TEST_CASE("what a source emits is spread evenly and each quantity independently of the others") {
    const Grid grid{{8, -1, 100, false}, {4, 0.5, 2, true}};
    ParticleBoundaries boundaries;
    boundaries.walls[x_low] = AtWall::source;
    boundaries.emission = {{1.5, 1000.25}};
    boundaries.dt = 0.25, boundaries.plane = boundaries.magnetized = true;
    std::vector<Particles> species(1);
    Walls walls;
    std::vector<long> emitted_again{0};
    species[0].q_p = -0.5;
    std::vector<std::vector<double>> u(5);
    const auto note = [&](std::size_t p) {
        const Particles& s = species[0];
        u[0].push_back(std::exp(-0.5 * s.vx_p[p] * s.vx_p[p] / 2.25));
        u[1].push_back((s.x_p[p] + 1) / (0.25 * s.vx_p[p]));  // on its way for a part of the step
        u[2].push_back(0.5 * std::erfc(-s.vy_p[p] / (1.5 * std::sqrt(2.0))));
        u[3].push_back(0.5 * std::erfc(-s.vz_p[p] / (1.5 * std::sqrt(2.0))));
    };
    for (long step = 0; step < 20; ++step)
        apply_particle_boundaries(grid, boundaries, step, species, walls, emitted_again);
    REQUIRE(species[0].count() == 20005);  // 20 times 1000.25
    CHECK(walls[x_low].charge == 0.25 * 20005);
    for (std::size_t p = 0; p < 20005; ++p) {
        note(p);
        u[4].push_back((species[0].z_p[p] - 0.5) / 2);
    }
    CHECK(unevenness(u) <= 4 / std::sqrt(20005));
    // Those that come back are sent out again, where they are along the wall.
    std::fill(species[0].x_p.begin(), species[0].x_p.end(), -1.5);
    boundaries.emission[0].per_step = 0;
    const std::vector<Real> z = species[0].z_p;
    apply_particle_boundaries(grid, boundaries, 20, species, walls, emitted_again);
    CHECK(species[0].z_p == z);
    CHECK(emitted_again[0] == 20005);
    std::vector<double> first = u[0];
    u.assign(5, {});
    for (std::size_t p = 0; p < 20005; ++p) note(p);
    u[4] = first;
    CHECK(unevenness(u) <= 4 / std::sqrt(20005));
}

TEST_CASE("what a case does not say is a cold plasma at rest without fields of its own") {
    const Case c;
    const SpeciesCase s;
    // The wave that grows fastest in two cold streams at +- 1, (3/8)^1/2, fits in once.
    CHECK(std::fabs(2 * pi / c.grid.x.length - std::sqrt(0.375)) <= 4 * eps);
    CHECK(worst({std::fabs(s.temperature_x), std::fabs(s.temperature_y), std::fabs(s.temperature_z),
                 std::fabs(s.drift_x), std::fabs(s.drift_y), std::fabs(s.drift_z),
                 std::fabs(s.amplitude), std::fabs(s.ripple), std::fabs(s.emission), c.B.size()}) ==
          0);
    CHECK(s.density * s.charge * s.charge / s.mass == 1);  // omega_p
    CHECK(c.gauss_sign == 1);
    CHECK(worst({c.fields_interval, c.particles_interval, c.phase_interval, real(c.modes),
                 real(c.checkpoint_steps), real(c.spectrum), real(c.also.vtk)}) == 0);
    for (const Wall& wall : walls_of(c)) {
        CHECK(!wall.floating);
        CHECK(wall.potential == 0);
        CHECK(wall.charge == 0);
    }
}

TEST_CASE("who starts with the drift in E and B keeps it") {
    Case parameters;
    parameters.dimensions = 2;
    parameters.grid = {{4, 0, 1, true}, {4, 0, 1, true}};
    parameters.B = {0.3, -2, 0.4};
    const MeshField E_g(std::size_t(parameters.grid.size()), {0.3, -0.2});
    Particles s;
    s.q_p = -1, s.m_p = 0.5;
    resize(2, true, true, s);
    SpeciesCase species;
    species.start = "ExB";
    start_velocities(E_g, parameters, species, s);
    const Eigen::Vector3d B(0.3, -2, 0.4),
        v = Eigen::Vector3d(0.3, 0, -0.2).cross(B) / B.squaredNorm();
    for (const std::size_t p : {0u, 1u})
        CHECK((Eigen::Vector3d(s.vx_p[p], s.vy_p[p], s.vz_p[p]) - v).norm() <= 4 * eps);
}
