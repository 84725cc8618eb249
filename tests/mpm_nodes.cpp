// Particles and nodes of the material point method: shape functions, the sparse nodes of each
// grain, and the sums that go back and forth between them.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tests/support/any_grains.hpp"

namespace {

using namespace facts;

// Places in a direction: anywhere, on nodes, half way, and next to both; in cells from node 0.
std::vector<double> places(Random& random) {
    std::vector<double> x;
    for (const double d : {0.0, 0.25, 0.5, 1.0 / 6, 0.75})
        for (const double off : {0.0, 1e-15, -1e-15, 1e-9, -1e-9}) x.push_back(7 + d + off);
    for (int k = 0; k < 40; ++k) x.push_back(random(0, 30));
    return x;
}

// The integral of the hat function from minus infinity, and the hat.
double integral_of_hat(double u) {
    if (u <= -1) return 0;
    if (u <= 0) return 0.5 * (1 + u) * (1 + u);
    return u < 1 ? 1 - 0.5 * (1 - u) * (1 - u) : 1;
}
double hat(double u) { return std::fabs(u) < 1 ? 1 - std::fabs(u) : 0; }

template <class Shape>
std::pair<double, double> weight_of(const Shape& shape, double x, long node) {
    const auto w = shape(x, 1);
    const long k = node - w.first;
    return k < 0 || k >= Shape::width ? std::pair(0.0, 0.0) : std::pair(w.S[k], w.G[k]);
}

// What the particles of a cloud have in all.
NodeSums totals(const Particles& p) {
    NodeSums t{};
    for (std::size_t k = 0; k < p.x_p.size(); ++k) {
        t.m += p.m_p[k], t.V += p.V_p[k];
        t.px += p.m_p[k] * p.vx_p[k], t.py += p.m_p[k] * p.vy_p[k];
        t.mx += p.m_p[k] * p.x_p[k], t.my += p.m_p[k] * p.y_p[k];
    }
    return t;
}
NodeSums totals(const GrainNodes& nodes) {
    NodeSums t{};
    for (const NodeSums& s : nodes.sums) {
        t.m += s.m, t.V += s.V, t.px += s.px, t.py += s.py;
        t.mx += s.mx, t.my += s.my, t.gx += s.gx, t.gy += s.gy;
    }
    return t;
}

using Key = std::tuple<int, long, long>;
std::map<Key, NodeSums> by_node(const GrainNodes& nodes, const GridLayout& layout) {
    std::map<Key, NodeSums> all;
    for_each_dof(nodes, layout, [&](int g, long i, long j, std::size_t dof) {
        all[{g, i, j}] = nodes.sums[dof];
    });
    return all;
}
double difference(const NodeSums& a, const NodeSums& b) {
    return worst({std::fabs(a.m - b.m), std::fabs(a.V - b.V), std::fabs(a.px - b.px),
                  std::fabs(a.py - b.py), std::fabs(a.mx - b.mx), std::fabs(a.my - b.my),
                  std::fabs(a.gx - b.gx), std::fabs(a.gy - b.gy)});
}

// The largest difference between two sets of nodes; a node that is not there is empty.
double difference(const std::map<Key, NodeSums>& a, const std::map<Key, NodeSums>& b) {
    double most = 0;
    const auto compare = [&](const auto& one, const auto& two) {
        for (const auto& [key, sums] : one) {
            const auto at = two.find(key);
            most = worst({most, difference(sums, at == two.end() ? NodeSums{} : at->second)});
        }
    };
    compare(a, b), compare(b, a);
    return most;
}

// Grains of many forms: one particle, a row, a column, bars, disks, with holes; anywhere.
Cloud odd_grains(std::uint64_t seed) {
    Random random(seed);
    Cloud cloud(mesh_of(60, 50, 0.5, -3.7, 11.1));
    for (int g = 0; g < 12; ++g) {
        cloud.begin_grain();
        const double x = random(5, 20), y = random(18, 28), angle = random(0, 3.2),
                     length = g % 4 == 0 ? 0 : random(0, 4),
                     width = g % 3 == 0 ? 0 : random(0, g % 3 == 1 ? 0.4 : 3);
        const long count = g == 0 ? 1 : g % 5 == 0 ? 300 : 25;
        for (long p = 0; p < count; ++p) {
            const double a = length * random(-1, 1), b = width * random(-1, 1);
            cloud.add(x + a * std::cos(angle) - b * std::sin(angle),
                      y + a * std::sin(angle) + b * std::cos(angle), random(0.5, 1.5),
                      random(-1, 1), random(-1, 1), random(0.5, 1.5));
        }
    }
    return cloud;
}

// Moves every particle by up to the distance after which a sort is due, many of them straight up,
// down, left, right or along a diagonal.
void move_until_sort(Cloud& cloud, const GrainNodes& nodes, Random& random) {
    GridLayout layout;
    double far = 0;
    for (double part = cloud.mesh.h; part > 1e-9; part *= 0.5) {
        layout.moved = far + part;
        if (!nodes.sort_is_due(layout)) far += part;
    }
    CHECK(far >= 0.25 * cloud.mesh.h);
    for (std::size_t p = 0; p < cloud.particles.x_p.size(); ++p) {
        const double size = random() < 0.5 ? far : far * random();
        const double turn = random() < 0.7 ? 0.25 * std::floor(8 * random()) : 2 * random();
        cloud.particles.x_p[p] += size * std::cos(turn * std::numbers::pi);
        cloud.particles.y_p[p] += size * std::sin(turn * std::numbers::pi);
    }
}

// Exact multiples of 1/64, so that moving by whole cells changes no bit.
double rounded(double x) { return std::round(64 * x) / 64; }

}  // namespace

// ---- shape functions ----------------------------------------------------------------------------

TEST_CASE("particles with sides of their own tile a block wherever lines cut it") {
    // low and high ends, in cells; slivers below a quarter of a particle in one direction at a time
    for (const auto& [x_low, x_high, y_low, y_high] : {std::array{7.0, 12.0, 5.0, 9.0},
                                                       {7.2, 12.3, 5.15, 9.4},
                                                       {7.35, 12.0, 5.0, 9.05},
                                                       {7.0, 12.0, 5.05, 9.1},
                                                       {7.45, 12.0, 5.0, 9.0}})
        for (const long per_side : {2L, 3L}) {
            Case c = case_on(32, 24, 1.6);
            c.problem.per_side = per_side, c.shape = "gimp";
            const double h = c.problem.mesh().h;
            GrainCase block;
            block.name = "block", block.shape = "box";
            block.x = 0.5 * h * (x_low + x_high), block.width = h * (x_high - x_low);
            block.y = 0.5 * h * (y_low + y_high), block.height = h * (y_high - y_low);
            c.problem.grains = {block};
            const Assembly all = assemble(c.problem, true);
            const Particles& p = all.particles;
            std::array<long, 40> origin{};
            for (long j = 0; j < 40; ++j) origin[std::size_t(j)] = 100 * j;
            std::map<long, std::array<double, 3>> sums;
            for (std::size_t k = 0; k < p.x_p.size(); ++k)
                for_each_node(own_shape(GimpShape{0.5 / real(per_side)}, p, k),
                              Locator(c.problem.mesh()), origin.data(), p.x_p[k], p.y_p[k],
                              [&](long dof, double S, double Gx, double Gy) {
                                  std::array<double, 3>& sum = sums[dof];
                                  sum[0] += p.V_p[k] * S, sum[1] += p.V_p[k] * Gx;
                                  sum[2] += p.V_p[k] * Gy;
                              });
            double off = 0;
            for (const auto& [dof, sum] : sums) {
                const double i = real(dof % 100), j = real(dof / 100);
                const double in_x = integral_of_hat(x_high - i) - integral_of_hat(x_low - i),
                             in_y = integral_of_hat(y_high - j) - integral_of_hat(y_low - j),
                             on_x = hat(x_high - i) - hat(x_low - i),
                             on_y = hat(y_high - j) - hat(y_low - j);
                off = worst({off, std::fabs(sum[0] / (h * h) - in_x * in_y),
                             std::fabs(sum[1] / h - on_x * in_y),
                             std::fabs(sum[2] / h - in_x * on_y)});
            }
            CHECK(off <= 1e-9);
            const bool cut = x_low != 7 || x_high != 12 || y_low != 5 || y_high != 9;
            CHECK(p.half_x_p.empty() == !cut);
        }
}

TEST_CASE("weights sum to one and reproduce the place of the particle everywhere") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        using Shape = std::decay_t<decltype(shape)>;
        for (const auto& [low, h] :
             {std::pair(0.0, 1.0), {-3.7, 0.025}, {1e3, 0.3}, {-50.0, 8.0}}) {
            Random random(1);
            const Mesh mesh = mesh_of(30, 30, h, low, low - 1);
            const Locator at(mesh);
            // Rows of 100 columns; dof s stands for the node in column s % 100, row s / 100.
            std::array<long, 40> origin{};
            for (long j = 0; j < 40; ++j) origin[static_cast<std::size_t>(j)] = 100 * (j - 2) + 5;
            double S = 0, xS = 0, G = 0, xG = 0, least = 0;
            const auto all = places(random);
            for (const double a : all) {
                for (const double b : all) {
                    const double x = mesh.x_of(a), y = mesh.y_of(b);
                    double s = 0, sx = 0, sy = 0;
                    std::array<double, 2> g{};
                    std::array<double, 4> gradient{};
                    for_each_node(shape, at, origin.data() + 2, x, y,
                                  [&](long dof, double weight, double Gx, double Gy) {
                                      const long j = (dof + 195) / 100 - 2, i = dof - 100 * j - 5;
                                      const double dx = mesh.x_of(real(i)) - x,
                                                   dy = mesh.y_of(real(j)) - y;
                                      s += weight, sx += weight * dx, sy += weight * dy;
                                      g[0] += Gx, g[1] += Gy;
                                      gradient[0] += Gx * dx, gradient[1] += Gy * dx;
                                      gradient[2] += Gx * dy, gradient[3] += Gy * dy;
                                      least = std::min(least, weight);
                                  });
                    S = worst({S, std::fabs(s - 1)});
                    xS = worst({xS, std::fabs(sx), std::fabs(sy)});
                    G = worst({G, std::fabs(g[0]), std::fabs(g[1])});
                    xG = worst({xG, std::fabs(gradient[0] - 1), std::fabs(gradient[1]),
                                std::fabs(gradient[2]), std::fabs(gradient[3] - 1)});
                }
            }
            // The place itself is known to eps times its distance from zero.
            const double coarse = eps * (1 + std::fabs(low) / h + 30);
            CHECK(S <= 4 * eps);
            CHECK(xS <= 4 * coarse * h);
            CHECK(G <= 8 * eps / h);
            CHECK(xG <= 8 * coarse);
            CHECK(least >= -eps);
            static_assert(Shape::width == 2 || Shape::width == 3);
        }
    });
}

TEST_CASE("gradients are the derivatives of the shape functions") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        const bool linear = name == "linear";
        Random random(2);
        const double d = 0x1p-20;
        double most = 0, jump = 0;
        for (const double x : places(random)) {
            // Central differences are exact for parabolas; the linear shape has kinks at the nodes.
            if (linear && std::fabs(x - std::round(x)) < 2 * d) continue;
            const double per_h = 1 / 0.3;
            for (long node = std::lround(x) - 3; node <= std::lround(x) + 3; ++node) {
                const double slope =
                    (weight_of(shape, x + d, node).first - weight_of(shape, x - d, node).first) /
                    (2 * d);
                const auto w = shape(x, per_h);
                const long k = node - w.first;
                const double G = k < 0 || k >= w.width ? 0 : w.G[k];
                most = worst({most, std::fabs(G - per_h * slope)});
                jump = worst({jump, std::fabs(weight_of(shape, x + d, node).second -
                                              weight_of(shape, x - d, node).second)});
            }
        }
        CHECK(most <= (linear ? 1e-8 : 6e-6));
        // No jump: the gradients of gimp and quadratic are continuous.
        CHECK(jump <= 13 * d);
    });
}

TEST_CASE("gimp is the linear shape averaged over the particle") {
    Random random(3);
    for (const double half : {0.5, 0.25, 1.0 / 6, 0.01}) {
        for (const double x : places(random)) {
            for (long node = std::lround(x) - 2; node <= std::lround(x) + 2; ++node) {
                const double u = x - real(node);
                const auto [S, G] = weight_of(GimpShape{half}, x, node);
                CHECK(std::fabs(S - (integral_of_hat(u + half) - integral_of_hat(u - half)) /
                                        (2 * half)) <= 8 * eps / half);
                CHECK(std::fabs(G - (hat(u + half) - hat(u - half)) / (2 * half)) <=
                      32 * eps / half);
            }
        }
    }
}

TEST_CASE("gimp with particles as wide as a cell is the quadratic spline") {
    Random random(4);
    for (const double x : places(random)) {
        for (long node = std::lround(x) - 2; node <= std::lround(x) + 2; ++node) {
            const auto [S, G] = weight_of(GimpShape{0.5}, x, node);
            const auto [Q, H] = weight_of(QuadraticShape{}, x, node);
            CHECK(std::fabs(S - Q) <= 16 * eps);
            CHECK(std::fabs(G - H) <= 16 * eps);
        }
    }
}

TEST_CASE("the particle of gimp is as wide as the lattice of its grain") {
    Case c = case_on(8, 8, 1);
    c.shape = "gimp";
    for (const long per_side : {1, 2, 3, 5}) {
        c.problem.per_side = per_side;
        CHECK(2 * c.scheme().half * real(per_side) == about(1).epsilon(1e-15));
    }
}

// ---- sparse nodes -------------------------------------------------------------------------------

TEST_CASE("totals on the nodes are those of the particles") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        Cloud cloud = odd_grains(5);
        const NodeSums expected = totals(cloud.particles);
        const NodeSums t = totals(cloud.on_nodes(shape));
        CHECK(std::fabs(t.m - expected.m) <= 1e-14 * expected.m);
        CHECK(std::fabs(t.V - expected.V) <= 1e-14 * expected.m);
        CHECK(std::fabs(t.px - expected.px) <= 1e-14 * expected.m);
        CHECK(std::fabs(t.py - expected.py) <= 1e-14 * expected.m);
        CHECK(std::fabs(t.mx - expected.mx) <= 1e-14 * std::fabs(expected.mx));
        CHECK(std::fabs(t.my - expected.my) <= 1e-14 * std::fabs(expected.my));
        CHECK(std::fabs(t.gx) <= 1e-13 * expected.V);
        CHECK(std::fabs(t.gy) <= 1e-13 * expected.V);
    });
}

TEST_CASE("the mean place of what is on a node lies within the reach of the node") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        Cloud cloud = odd_grains(6);
        const GrainNodes nodes = cloud.on_nodes(shape);
        const Mesh& mesh = cloud.mesh;
        for_each_dof(nodes, cloud.layout, [&](int, long i, long j, std::size_t dof) {
            const NodeSums& s = nodes.sums[dof];
            if (!(s.m > 1e-9)) return;
            CHECK(std::fabs(s.mx / s.m - mesh.x_of(real(i))) <= 1.5 * mesh.h);
            CHECK(std::fabs(s.my / s.m - mesh.y_of(real(j))) <= 1.5 * mesh.h);
        });
    });
}

TEST_CASE("every particle is kept by a stable sort into rows of cells with all it carries") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Cloud cloud = odd_grains(seed);
        Particles& p = cloud.particles;
        Random random(seed);
        for (std::vector<double>* quantity : p.all())
            if (quantity != &p.yield_p && quantity != &p.x_p && quantity != &p.y_p)
                for (double& value : *quantity) value = random();
        Particles before = p;
        GrainNodes nodes(cloud.mesh, 2, 0);
        for (int round = 0; round < 2; ++round) {  // of sorted particles, too
            nodes.sort(cloud.grains, p, cloud.layout);
            std::vector<int> seen(before.x_p.size(), 0);
            for (std::size_t k = 0; k < p.x_p.size(); ++k) {
                const auto was = static_cast<std::size_t>(p.yield_p[k]);
                ++seen[was];
                auto now = p.all();
                auto then = before.all();
                for (std::size_t q = 0; q < now.size(); ++q) CHECK((*now[q])[k] == (*then[q])[was]);
            }
            CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
            std::size_t row = 0;
            for (std::size_t g = 0; g < cloud.grains.size(); ++g) {
                const auto at = [&](std::size_t k) {
                    return static_cast<std::size_t>(cloud.layout.tile_begin[k]);
                };
                CHECK(at(row) == static_cast<std::size_t>(cloud.grains[g].begin));
                double last = -1e9;
                for (int r = 0; r < cloud.layout.tiles[g]; ++r, ++row) {
                    const auto cell = [&](std::size_t k) {
                        return std::floor((p.y_p[k] - cloud.mesh.y_low) / cloud.mesh.h);
                    };
                    for (std::size_t k = at(row); k < at(row + 1); ++k) {
                        CHECK(cell(k) == cell(at(row)));
                        CHECK((k > at(row) || cell(k) > last));
                        if (k > at(row)) CHECK(p.yield_p[k] > p.yield_p[k - 1]);
                    }
                    if (at(row + 1) > at(row)) last = cell(at(row));
                }
            }
            long next = 0;
            for (const Tile& tile : nodes.tiles()) {
                const Grain& grain = cloud.grains[static_cast<std::size_t>(tile.grain)];
                CHECK(tile.begin == next);
                CHECK((tile.begin >= grain.begin && tile.end <= grain.end));
                next = tile.end;
            }
            CHECK(next == p.count());
        }
    }
}

TEST_CASE(
    "a particle that has moved as far as it may between sorts is still within the rows of its "
    "grain") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        using Shape = std::decay_t<decltype(shape)>;
        Random random(7);
        long outside = 0, inside = 0;
        for (std::uint64_t seed = 1; seed <= 30; ++seed) {
            Cloud cloud = odd_grains(seed);
            GrainNodes nodes(cloud.mesh, Shape::width, 0);
            nodes.sort(cloud.grains, cloud.particles, cloud.layout);
            const GridLayout& layout = cloud.layout;
            std::vector<std::size_t> first_of(layout.rows.size(), 0);
            for (std::size_t g = 1; g < first_of.size(); ++g)
                first_of[g] = first_of[g - 1] + static_cast<std::size_t>(layout.rows[g - 1]);
            move_until_sort(cloud, nodes, random);
            const Locator at(cloud.mesh);
            for (std::size_t g = 0; g < cloud.grains.size(); ++g) {
                for (long p = cloud.grains[g].begin; p < cloud.grains[g].end; ++p) {
                    const auto n = static_cast<std::size_t>(p);
                    const auto w_x = shape((cloud.particles.x_p[n] - at.x_low) * at.per_h, 1),
                               w_y = shape((cloud.particles.y_p[n] - at.y_low) * at.per_h, 1);
                    for (int b = 0; b < Shape::width; ++b) {
                        const long row = w_y.first + b - layout.first_row[g];
                        const bool known = row >= 0 && row < layout.rows[g];
                        const std::size_t r = first_of[g] + static_cast<std::size_t>(row);
                        if (known && w_x.first >= layout.first_column[r] &&
                            w_x.first + Shape::width <= layout.end_column[r])
                            ++inside;
                        else
                            ++outside;
                    }
                }
            }
        }
        CHECK(outside == 0);
        CHECK(inside > 10000);
    });
}

TEST_CASE("sums on nodes do not depend on whether particles were sorted since they moved") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        for (const bool periodic : {false, true}) {
            Random random(8);
            Cloud cloud = odd_grains(9);
            cloud.mesh.periodic_x = periodic;
            GrainNodes nodes = cloud.on_nodes(shape);
            move_until_sort(cloud, nodes, random);
            particles_to_grid(shape, cloud.particles, nodes);
            const auto before = by_node(nodes, cloud.layout);
            nodes.sort(cloud.grains, cloud.particles, cloud.layout);
            particles_to_grid(shape, cloud.particles, nodes);
            CHECK(difference(before, by_node(nodes, cloud.layout)) <= 1e-12);
        }
    });
}

TEST_CASE("a grid layout that was kept gives the same nodes") {
    Cloud cloud = odd_grains(10);
    cloud.mesh.boundary = {Boundary::slip, Boundary::frictional, Boundary::stick, Boundary::slip};
    const GrainNodes nodes = cloud.on_nodes(QuadraticShape{});
    GrainNodes again(cloud.mesh, 3, 0);
    again.lay_out(cloud.grains, cloud.layout);
    particles_to_grid(QuadraticShape{}, cloud.particles, again);
    CHECK(again.size() == nodes.size());
    CHECK(std::memcmp(again.sums.data(), nodes.sums.data(),
                      sizeof(NodeSums) * static_cast<std::size_t>(nodes.size())) == 0);
    CHECK(again.members().size() == nodes.members().size());
}

TEST_CASE("nodes stored are proportional to the area of the grains") {
    // 2000 grains of five cells, scattered over a mesh of a quarter of a million.
    Random random(11);
    Cloud pack(mesh_of(500, 500, 1));
    for (int g = 0; g < 2000; ++g) {
        const double x = random(5, 495), y = random(5, 495);
        pack.begin_grain();
        for (int p = 0; p < 20; ++p) {
            const double r = 1.25 * std::sqrt(random()), turn = 6.3 * random();
            pack.add(x + r * std::cos(turn), y + r * std::sin(turn));
        }
    }
    CHECK(pack.on_nodes(LinearShape{}).size() <= 2000 * 7 * 7);
    CHECK(pack.on_nodes(QuadraticShape{}).size() <= 2000 * 9 * 9);

    // A bar that leans: rows times what it takes of a row.
    Cloud bar(mesh_of(200, 200, 1));
    bar.begin_grain();
    for (int p = 0; p < 20000; ++p) {
        const double a = random(0, 200), b = random(-1, 1), half = std::sqrt(0.5);
        bar.add(20 + (a - b) * half, 20 + (a + b) * half);
    }
    // In a row: the bar's width across, 2 * 2^1/2; its way in the tiles that reach a node, one per
    // tile; and the margins.
    const GrainNodes linear = bar.on_nodes(LinearShape{});
    CHECK(linear.size() <= bar.layout.rows[0] * (3 + 4 + 5));
    CHECK(linear.size() >= 8 * bar.layout.rows[0]);
    CHECK(bar.on_nodes(QuadraticShape{}).size() <= bar.layout.rows[0] * (3 + 6 + 7));
}

TEST_CASE("tiles that are worked on at the same time share no node") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        Random random(12);
        Cloud cloud(mesh_of(120, 90, 1));
        // One with so many particles per row that pieces are as thin as they may be, a column with
        // few per row, and small ones.
        cloud.add_anywhere(20000, 10, 110, 10, 25, random);
        cloud.add_anywhere(4000, 10, 13, 10, 80, random);
        for (int g = 0; g < 40; ++g) {
            const double x = random(10, 100), y = random(10, 80);
            cloud.add_anywhere(200, x, x + 5, y, y + 5, random);
        }
        cloud.add_anywhere(1500, 10, 12, 10, 12, random);
        GrainNodes nodes = cloud.on_nodes(shape);
        move_until_sort(cloud, nodes, random);
        // One thread takes piece after piece: first all of one color, then all of the other. Pieces
        // of the same color are never next to each other.
        common::set_thread_count(1);
        std::vector<std::vector<std::vector<std::size_t>>> colors(1);
        std::size_t last = 0;
        bool first = true;
        nodes.for_each_tile([&](const Tile&, std::size_t number) {
            if (!first && number < last) colors.emplace_back();
            if (first || number != last + 1) colors.back().emplace_back();
            colors.back().back().push_back(number);
            last = number, first = false;
        });
        common::set_thread_count(2);
        CHECK(colors.size() == 2);
        long pieces = 0, shared = 0, tiles = 0;
        const Locator at(cloud.mesh);
        for (const auto& color : colors) {
            std::vector<long> owner(static_cast<std::size_t>(nodes.size()), -1);
            for (const auto& piece : color) {
                ++pieces;
                for (const std::size_t s : piece) {
                    ++tiles;
                    const Tile& tile = nodes.tiles()[s];
                    for (long p = tile.begin; p < tile.end; ++p) {
                        const auto n = static_cast<std::size_t>(p);
                        for_each_node(shape, at, nodes.origins(tile.grain), cloud.particles.x_p[n],
                                      cloud.particles.y_p[n],
                                      [&](long dof, double, double, double) {
                                          long& by = owner[static_cast<std::size_t>(dof)];
                                          if (by >= 0 && by != pieces) ++shared;
                                          by = pieces;
                                      });
                    }
                }
            }
        }
        CHECK(tiles == static_cast<long>(nodes.tiles().size()));
        CHECK(pieces >= 10);
        CHECK(shared == 0);
    });
}

TEST_CASE("sums and steps have the same bits for one thread and two and three") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        std::vector<NodeSums> reference;
        for (const int threads : {1, 2, 3}) {
            common::set_thread_count(threads);
            Random random(13);
            Cloud cloud(mesh_of(120, 90, 1));
            cloud.add_anywhere(20000, 10, 110, 10, 40, random);
            cloud.add_anywhere(5000, 10, 13, 10, 80, random);
            const GrainNodes nodes = cloud.on_nodes(shape);
            if (threads == 1) reference = nodes.sums;
            REQUIRE(nodes.sums.size() == reference.size());
            CHECK(std::memcmp(nodes.sums.data(), reference.data(),
                              sizeof(NodeSums) * reference.size()) == 0);
        }
    });
    for (const std::string shape : {"linear", "gimp", "quadratic"}) {
        CAPTURE(shape);
        std::vector<std::vector<double>> reference;
        double energy = 0;
        for (const int threads : {1, 2, 3}) {
            common::set_thread_count(threads);
            Case c = case_on(80, 40, 2);
            c.shape = shape;
            c.problem.walls = {"slip", "frictional", "stick", "frictional"};
            c.problem.contact.friction = 0.3;
            c.problem.grains = {disk_at("a", 0.55, 0.5, 0.4, 0.3, 0.1),
                                disk_at("b", 1.36, 0.55, 0.4, -0.3, -0.2)};
            Run run(c);
            run.advance(30);
            std::vector<std::vector<double>> all;
            for (const std::vector<double>* quantity : run.particles().all())
                all.push_back(*quantity);
            if (threads == 1) reference = all, energy = run.budget().energy_14;
            CHECK(run.sums.contact.nodes > 0);
            CHECK(all == reference);
            CHECK(run.budget().energy_14 == energy);
        }
    }
    common::set_thread_count(2);
}

// ---- ends of the mesh ---------------------------------------------------------------------------

TEST_CASE("a grain across the seam of a periodic mesh is the same grain in the middle") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        using Shape = std::decay_t<decltype(shape)>;
        const auto put = [&](double shift) {
            Random random(14);
            Mesh mesh = mesh_of(16, 12, 0.25, -1);
            mesh.periodic_x = true;
            Cloud cloud(mesh);
            for (int g = 0; g < 2; ++g) {
                cloud.begin_grain();
                for (int p = 0; p < 200; ++p) {
                    const double x = rounded(random(0.4, 2)) + 0.125 * g, y = random(0.5, 2.5);
                    cloud.add(x + shift, y, random(0.5, 1.5), random(-1, 1), random(-1, 1));
                }
            }
            const GrainNodes nodes = cloud.on_nodes(shape);
            // It has come back as a whole, with its center on the mesh.
            for (const Grain& grain : cloud.grains) {
                const auto begin = cloud.particles.x_p.begin() + grain.begin,
                           end = cloud.particles.x_p.begin() + grain.end;
                const auto [least, most] = std::minmax_element(begin, end);
                CHECK(*most - *least <= 2);
                CHECK((*least + *most >= -2 && *least + *most < 6));
            }
            // By place relative to the shift; how far the grain came back is in its first column.
            std::map<Key, NodeSums> all;
            for (const auto& [key, sums] : by_node(nodes, cloud.layout)) {
                const auto& [g, i, j] = key;
                NodeSums s = sums;
                s.mx -= s.m * mesh.x_of(real(i)), s.my = 0;
                const long column = (i - std::lround(4 * shift) + 160) % 16;
                if (s.m > 0) all[{g, column, j}] = s;
            }
            return std::tuple(nodes.size(), nodes.shared_count(), nodes.members().size(), all);
        };
        const auto [size, shared, members, middle] = put(0);
        CHECK(members >= 2 * static_cast<std::size_t>(shared));
        CHECK(shared >= 40);
        for (const double shift : {1.0, 1.5, 2.0, 2.25, 2.5, 3.0, -1.5, -2.0, 4.0, 9.5}) {
            CAPTURE(shift);
            const auto [other_size, other_shared, other_members, other] = put(shift);
            CHECK(other_size == size);
            CHECK(other_shared == shared);
            CHECK(other_members == members);
            CHECK(difference(middle, other) <= 1e-13);
        }
        static_assert(Shape::width <= 3);
    });
}

TEST_CASE("a grain that reaches all around has the same node at both ends") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        Mesh mesh = mesh_of(12, 10, 0.25, 0.5, -1);
        mesh.periodic_x = true;
        // A lattice that fills rows of cells looks the same from every node.
        for (const double shift : {0.0, 0.01, 0.06, 0.2}) {
            Cloud ring(mesh);
            ring.begin_grain();
            for (int k = 0; k < 24; ++k)
                for (int l = 0; l < 8; ++l)
                    ring.add(0.5 + 0.125 * (k + 0.5) + shift, -1 + 0.5 + 0.125 * (l + 0.5), 2, 0.3,
                             0, 0.015625);
            GrainNodes nodes = ring.on_nodes(shape);
            CHECK(ring.layout.wraps[0] == 1);
            const auto uniform = [&] {
                std::map<long, std::set<long>> columns;
                double most = 0;
                std::map<long, double> mass;
                for_each_dof(nodes, ring.layout, [&](int, long i, long j, std::size_t dof) {
                    const NodeSums& s = nodes.sums[dof];
                    // The velocity is there at every copy of a node.
                    const bool touched = j >= 2 && j <= 6;
                    if (touched && std::fabs(nodes.motion[dof].vx_0 - 0.3) > 1e-13) most = 1;
                    if (!(s.m > 0)) return;
                    CHECK(columns[j].insert((i + 24) % 12).second);
                    const auto [at, first] = mass.insert({j, s.m});
                    most = worst({most, std::fabs(s.m - at->second), std::fabs(s.gx),
                                  std::fabs(s.px - 0.3 * s.m)});
                    // Its parts are seen around it, not at the other end.
                    CHECK(std::fabs(s.mx / s.m - mesh.x_of(real(i))) <= 1e-12);
                });
                for (const auto& [j, all] : columns) CHECK(all.size() == 12);
                return most;
            };
            CHECK(uniform() <= 1e-12);
            // Particles that have gone on without a sort are beyond the end, and still there.
            for (double& x : ring.particles.x_p) x += 0.45 * mesh.h;
            particles_to_grid(shape, ring.particles, nodes);
            nodal_velocity(ring.grains, ring.rigid, nodes);
            CHECK(uniform() <= 1e-12);
            for (double& x : ring.particles.x_p) x -= 0.9 * mesh.h;
            particles_to_grid(shape, ring.particles, nodes);
            nodal_velocity(ring.grains, ring.rigid, nodes);
            CHECK(uniform() <= 1e-12);
            // A ring stays one, and its particles come back into the box.
            nodes.sort(ring.grains, ring.particles, ring.layout);
            CHECK(ring.layout.wraps[0] == 1);
            for (const double x : ring.particles.x_p) CHECK((x >= 0.5 && x < 3.5));
        }
    });
}

TEST_CASE("spreading velocities is the transpose of folding sums and forces") {
    // sum_p m_p v_p . sum_i S_ip u_i = sum_i P_i . u_i for any velocities u of the nodes.
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        const std::array<std::array<Boundary, 4>, 4> walls{
            {{Boundary::slip, Boundary::slip, Boundary::slip, Boundary::slip},
             {Boundary::stick, Boundary::slip, Boundary::slip, Boundary::stick},
             {Boundary::stick, Boundary::stick, Boundary::stick, Boundary::stick},
             {Boundary::open, Boundary::open, Boundary::stick, Boundary::slip}}};
        for (const auto& kinds : walls) {
            const bool periodic = kinds[0] == Boundary::open;
            Random random(15);
            Cloud cloud(mesh_of(10, 8, 0.5, 2, -1));
            cloud.mesh.boundary = kinds, cloud.mesh.periodic_x = periodic;
            cloud.add_anywhere(400, 2, 7, -1, 3, random);
            GrainNodes nodes = cloud.on_nodes(shape);
            for (NodeMotion& v : nodes.motion)
                v = {random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1)};
            for (const long i : nodes.fixed_x()) nodes.motion[static_cast<std::size_t>(i)].vx_0 = 0;
            for (const long i : nodes.fixed_y()) nodes.motion[static_cast<std::size_t>(i)].vy_0 = 0;
            fill_ghost_velocity(nodes);
            const Particles& p = cloud.particles;
            double on_particles = 0, on_nodes = 0, by_force = 0;
            std::fill(nodes.force.begin(), nodes.force.end(), NodeForce{});
            for (std::size_t k = 0; k < p.x_p.size(); ++k)
                for_each_node(shape, Locator(cloud.mesh), nodes.origins(0), p.x_p[k], p.y_p[k],
                              [&](long dof, double S, double, double) {
                                  const NodeMotion& u = nodes.motion[static_cast<std::size_t>(dof)];
                                  NodeForce& f = nodes.force[static_cast<std::size_t>(dof)];
                                  f.x += p.m_p[k] * p.vx_p[k] * S, f.y += p.m_p[k] * p.vy_p[k] * S;
                                  on_particles +=
                                      p.m_p[k] * S * (p.vx_p[k] * u.vx_0 + p.vy_p[k] * u.vy_0);
                              });
            reduce_ghost_force(nodes);
            for (std::size_t n = 0; n < nodes.sums.size(); ++n) {
                const NodeMotion& u = nodes.motion[n];
                on_nodes += nodes.sums[n].px * u.vx_0 + nodes.sums[n].py * u.vy_0;
                by_force += nodes.force[n].x * u.vx_0 + nodes.force[n].y * u.vy_0;
            }
            CHECK(std::fabs(on_particles) >= 1e-3);
            CHECK(std::fabs(on_particles - on_nodes) <= 1e-12);
            CHECK(std::fabs(on_particles - by_force) <= 1e-12);
            // Images keep nothing.
            for (const GhostNode& ghost : nodes.ghosts()) {
                CHECK(nodes.sums[static_cast<std::size_t>(ghost.dof)].m == 0);
                CHECK(nodes.force[static_cast<std::size_t>(ghost.dof)].x == 0);
            }
        }
    });
}

TEST_CASE("walls and rings keep totals of mass and volume") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        for (const Boundary kind : {Boundary::slip, Boundary::stick, Boundary::frictional}) {
            for (const bool periodic : {false, true}) {
                Random random(16);
                Cloud cloud(mesh_of(10, 8, 0.5, 2, -1));
                cloud.mesh.boundary = {kind, kind, kind, kind}, cloud.mesh.periodic_x = periodic;
                cloud.add_anywhere(400, 2, 7, -1, 3, random);
                // One on every wall, and one in every corner.
                for (const double x : {2.0, 4.5, 7.0})
                    for (const double y : {-1.0, 1.0, 3.0}) cloud.add(x, y, 1, 0.5, -0.5);
                const NodeSums expected = totals(cloud.particles);
                const GrainNodes nodes = cloud.on_nodes(shape);
                const NodeSums t = totals(nodes);
                CHECK(std::fabs(t.m - expected.m) <= 1e-14 * expected.m);
                CHECK(std::fabs(t.V - expected.V) <= 1e-14 * expected.V);
                // Along a wall that is no clamp momentum stays; on a ring in any case.
                if (kind == Boundary::frictional || periodic)
                    CHECK((kind == Boundary::stick ||
                           std::fabs(t.px - expected.px) <= 1e-13 * expected.m));
                if (kind == Boundary::frictional)
                    CHECK(std::fabs(t.py - expected.py) <= 1e-13 * expected.m);
            }
        }
    });
}

TEST_CASE("nodes at a wall see the body and its mirror image") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        for (const bool clamp : {false, true}) {
            CAPTURE(clamp);
            // Particles in a corner of the mesh; and, on a wider one, they and their three ghosts.
            Random random(17);
            const Boundary kind = clamp ? Boundary::stick : Boundary::slip;
            Cloud corner(mesh_of(8, 8, 0.5)), whole(mesh_of(16, 16, 0.5, -4, -4));
            corner.mesh.boundary = {kind, Boundary::open, kind, Boundary::open};
            corner.begin_grain(), whole.begin_grain();
            for (int p = 0; p < 150; ++p) {
                const double x = random(0, 2), y = random(0, 2), m = random(0.5, 1.5),
                             vx = random(-1, 1), vy = random(-1, 1);
                corner.add(x, y, m, vx, vy);
                const double along = clamp ? -1 : 1;
                whole.add(x, y, m, vx, vy), whole.add(-x, y, m, -vx, along * vy);
                whole.add(x, -y, m, along * vx, -vy),
                    whole.add(-x, -y, m, -along * vx, -along * vy);
            }
            const GrainNodes one = corner.on_nodes(shape), four = whole.on_nodes(shape);
            auto all = by_node(four, whole.layout);
            double most = 0;
            long compared = 0;
            for_each_dof(one, corner.layout, [&](int, long i, long j, std::size_t dof) {
                if (i < 0 || j < 0) {
                    CHECK(one.sums[dof].m == 0);
                    return;
                }
                // On a wall there is only the body's half.
                const double share = (i == 0 ? 0.5 : 1) * (j == 0 ? 0.5 : 1);
                const NodeSums &a = one.sums[dof], &b = all[{0, i + 8, j + 8}];
                most = worst({most, std::fabs(a.m - share * b.m), std::fabs(a.V - share * b.V)});
                const NodeMotion& v = one.motion[dof];
                if (i == 0) CHECK(v.vx_0 == 0);
                if (j == 0) CHECK(v.vy_0 == 0);
                if (clamp && (i == 0 || j == 0)) CHECK((v.vx_0 == 0 && v.vy_0 == 0));
                if (i > 0 && (!clamp || j > 0))
                    most = worst({most, std::fabs(a.px - share * b.px)});
                if (j > 0 && (!clamp || i > 0))
                    most = worst({most, std::fabs(a.py - share * b.py)});
                if (i > 0)
                    most = worst(
                        {most, std::fabs(a.gx - share * b.gx), std::fabs(a.mx - share * b.mx)});
                if (j > 0)
                    most = worst(
                        {most, std::fabs(a.gy - share * b.gy), std::fabs(a.my - share * b.my)});
                if (b.m > 0) ++compared;
            });
            CHECK(compared >= 25);
            CHECK(most <= 1e-13 * 10);
        }
    });
}

TEST_CASE("particles that move alike give their velocity to every node with mass") {
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        Cloud cloud = odd_grains(18);
        for (double& v : cloud.particles.vx_p) v = 0.7;
        for (double& v : cloud.particles.vy_p) v = -0.2;
        cloud.grains[3].rigid = true;
        cloud.rigid[3].vx = 5, cloud.rigid[3].vy = 6;
        const GrainNodes nodes = cloud.on_nodes(shape, 1e-9);
        for_each_dof(nodes, cloud.layout, [&](int g, long, long, std::size_t dof) {
            const bool rigid = g == 3, empty = !rigid && !(nodes.sums[dof].m > 1e-9);
            const double x = rigid ? 5 : empty ? 0 : 0.7, y = rigid ? 6 : empty ? 0 : -0.2;
            CHECK(std::fabs(nodes.motion[dof].vx_0 - x) <= 1e-14);
            CHECK(std::fabs(nodes.motion[dof].vy_0 - y) <= 1e-14);
        });
    });
}

TEST_CASE("nodes that several grains touch are listed once with all of them") {
    for (const bool periodic : {false, true}) {
        Cloud cloud = odd_grains(19);
        cloud.mesh.periodic_x = periodic;
        cloud.mesh.boundary = {Boundary::open, Boundary::open, Boundary::frictional,
                               Boundary::open};
        // One that lies on the lower wall.
        cloud.begin_grain();
        for (int p = 0; p < 40; ++p) cloud.add(0.1 + 0.1 * p, 11.15);
        const GrainNodes nodes = cloud.on_nodes(LinearShape{});
        std::map<std::pair<long, long>, std::set<long>> expected;
        for_each_dof(nodes, cloud.layout, [&](int, long i, long j, std::size_t dof) {
            expected[{periodic ? (i + 60) % 60 : i, j}].insert(static_cast<long>(dof));
        });
        std::size_t shared = 0, on_wall = 0;
        for (const auto& [node, dofs] : expected) {
            const bool wall = node.second <= 0 && node.second > -4;
            if (dofs.size() + (wall ? 1 : 0) > 1) ++shared;
            if (wall) ++on_wall;
        }
        // Columns of the wall that no grain touches are not in the lists.
        CHECK(nodes.shared_count() == static_cast<long>(shared));
        CHECK(on_wall >= 20);
        for (long n = 0; n < nodes.shared_count(); ++n) {
            const auto begin = nodes.shared_begin()[static_cast<std::size_t>(n)],
                       end = nodes.shared_begin()[static_cast<std::size_t>(n) + 1];
            std::set<long> dofs;
            int last = -1;
            std::pair<long, long> where{};
            for (long l = begin; l < end; ++l) {
                const Member& member = nodes.members()[static_cast<std::size_t>(l)];
                if (member.is_wall()) {
                    CHECK(member.grain == static_cast<int>(y_low));
                    CHECK(member.y == cloud.mesh.y_low);
                    continue;
                }
                CHECK(member.grain >= last);  // grains in their order
                last = member.grain;
                dofs.insert(member.dof);
                const long i = std::lround((member.x - cloud.mesh.x_low) / cloud.mesh.h),
                           j = std::lround((member.y - cloud.mesh.y_low) / cloud.mesh.h);
                where = {periodic ? (i + 60) % 60 : i, j};
            }
            CHECK(dofs == expected[where]);
        }
    }
}
