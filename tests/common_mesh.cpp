// Facts about the mesh and what is done on it: splines, ghosts and walls, differences and their
// modes, smoothing, parallel loops, and the sort by node.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <utility>
#include <vector>

#include "common/random.hpp"
#include "common/splines.hpp"
#include "implicit_moment/field/quadratic_weights.hpp"
#include "implicit_moment/field/smooth.hpp"
#include "implicit_moment/field/waves.hpp"
#include "implicit_moment/ranks/division.hpp"
#include "implicit_moment/simd.hpp"
#include "implicit_moment/sort_particles.hpp"
#include "implicit_moment/theory/spline_average.hpp"
#include "tests/support/any_fields.hpp"

namespace {

using namespace facts;
using common::on_faces, common::on_nodes, common::on_x_edges, common::on_z_edges, common::spline;
using implicit_moment::QuadraticWeights, implicit_moment::SimdVector, implicit_moment::simd_width,
    implicit_moment::load_simd, implicit_moment::store_simd, implicit_moment::first_simd,
    implicit_moment::simd_sum, implicit_moment::any_simd, implicit_moment::magnitude;
constexpr Parity even{+1, +1}, odd{-1, -1};

// Every pair of ends, with few cells and with more than a loop is cut into.
std::vector<Grid> meshes() {
    std::vector<Grid> all;
    for (const auto& [n_x, n_z] : {std::pair{9L, 6L}, {4L, 4L}, {20L, 23L}}) {
        for (const int ends : {0, 1, 2, 3}) {
            all.push_back({{n_x, -1.5, 0.5 * real(n_x), ends % 2 == 0},
                           {n_z, 0.5, 0.3 * real(n_z), ends < 2}});
        }
    }
    return all;
}

template <class Visit>
void for_every_place_and_parity(const Visit& visit) {
    for (const Grid& grid : meshes()) {
        for (const Place place : {on_nodes, on_x_edges, on_z_edges, on_faces}) {
            for (const int x : {+1, -1}) {
                for (const int z : {+1, -1}) visit(grid, place, Parity{x, z});
            }
        }
    }
}

// The integral over the mesh of a product, in units of the cell; the largest difference.
double dot(const Grid& grid, Place place, const double* a, const double* b) {
    double sum = 0;
    for_each_distinct(grid, place, [&](long i, long j, long n) {
        sum += weight(grid.x, place.half_x, i) * weight(grid.z, place.half_z, j) * a[n] * b[n];
    });
    return sum;
}
double difference(const Grid& grid, Place place, const double* a, const double* b) {
    double largest = 0;
    for_each_distinct(grid, place, [&](long, long, long n) {
        largest = worst({largest, std::fabs(a[n] - b[n])});
    });
    return largest;
}
double dot(const Grid& grid, const VectorKind& kind, const VectorField& a, const VectorField& b) {
    return dot(grid, kind.place[0], a.x(), b.x()) + dot(grid, kind.place[1], a.y(), b.y()) +
           dot(grid, kind.place[2], a.z(), b.z());
}
double difference(const Grid& grid, const VectorKind& kind, const VectorField& a,
                  const VectorField& b) {
    return worst({difference(grid, kind.place[0], a.x(), b.x()),
                  difference(grid, kind.place[1], a.y(), b.y()),
                  difference(grid, kind.place[2], a.z(), b.z())});
}
double difference(const Grid& grid, Place place, const Field& a, const Field& b) {
    return difference(grid, place, a.data(), b.data());
}
double size_of(const Grid& grid, Place place, const Field& f) {
    return difference(grid, place, f, Field::Zero(f.size()));
}

bool filled(const Grid& grid, Place place, Parity parity, const Field& f) {
    Field again = f;
    common::fill_ghosts(grid, place, parity, again.data());
    return again == f;
}

// A wall is a mirror: the periodic mesh that holds a walled one and its image side by side, and
// the value of a quantity anywhere on it.
Grid with_image(Grid grid) {
    for (common::Axis* axis : {&grid.x, &grid.z}) {
        if (!axis->periodic) *axis = {2 * axis->cells, axis->low, 2 * axis->length, true};
    }
    return grid;
}
double image(const Grid& grid, Place place, Parity parity, const double* f, long i, long j) {
    const auto source = [](const common::Axis& axis, bool half, int mirror, long k) {
        const long period = axis.periodic ? axis.cells : 2 * axis.cells;
        k = (k + period) % period;
        return k < points(axis, half) ? std::pair{k, 1} : std::pair{period - half - k, mirror};
    };
    const auto [from_i, sign_x] = source(grid.x, place.half_x, parity.x, i);
    const auto [from_j, sign_z] = source(grid.z, place.half_z, parity.z, j);
    return sign_x * sign_z * f[grid.index(from_i, from_j)];
}
Field with_image(const Grid& grid, Place place, Parity parity, const double* f) {
    const Grid twice = with_image(grid);
    Field both = Field::Zero(twice.size());
    for_each_distinct(twice, place, [&](long i, long j, long n) {
        both[n] = image(grid, place, parity, f, i, j);
    });
    common::fill_ghosts(twice, place, even, both.data());
    return both;
}
VectorField with_image(const Grid& grid, const VectorKind& kind, const VectorField& f) {
    VectorField both(with_image(grid));
    both.all << with_image(grid, kind.place[0], kind.parity[0], f.x()),
        with_image(grid, kind.place[1], kind.parity[1], f.y()),
        with_image(grid, kind.place[2], kind.parity[2], f.z());
    return both;
}

// The differences, with ghosts filled.
VectorField gradient(const Grid& grid, const Field& phi) {
    VectorField E(grid);
    for_each_point(grid, [&](long n) {
        E.x()[n] = (phi[n + 1] - phi[n]) / grid.x.spacing();
        E.z()[n] = (phi[n + grid.stride()] - phi[n]) / grid.z.spacing();
    });
    fill_ghosts(grid, electric, E);
    return E;
}
VectorField curl_E(const Grid& grid, const VectorField& E) {
    VectorField curl(grid);
    curl_of_electric(grid, E.all.data(), curl.all.data());
    fill_ghosts(grid, magnetic, curl);
    return curl;
}
VectorField curl_B(const Grid& grid, const VectorField& B) {
    VectorField curl(grid);
    curl_of_magnetic(grid, B.all.data(), curl.all.data());
    fill_ghosts(grid, electric, curl);
    return curl;
}
Field div_E(const Grid& grid, const VectorField& E, Parity parity = odd) {
    Field div = Field::Zero(grid.size());
    divergence_of_electric(grid, E.all.data(), div);
    common::fill_ghosts(grid, on_nodes, parity, div.data());
    return div;
}
Field div_B(const Grid& grid, const VectorField& B) {
    Field div = Field::Zero(grid.size());
    divergence_of_magnetic(grid, B.all.data(), div);
    return div;
}
double per_cell(const Grid& grid) { return 1 / std::min(grid.x.spacing(), grid.z.spacing()); }

constexpr std::array<SmoothingSettings, 5> smoothings{
    {{1, true}, {1, false}, {2, true}, {3, true}, {4, false}}};
Field smoothed(const Grid& grid, Place place, Parity parity, const SmoothingSettings& settings,
               Field f) {
    Field scratch;
    smooth(grid, place, parity, settings, f.data(), scratch);
    return f;
}
VectorField smoothed(const Grid& grid, const VectorKind& kind, const SmoothingSettings& settings,
                     VectorField f) {
    Field scratch;
    smooth(grid, kind, settings, f.all.data(), scratch);
    return f;
}

}  // namespace

// ---- splines and lanes --------------------------------------------------------------------------

TEST_CASE("splines are symmetric and add up to one and keep the mean and the variance") {
    Random random;
    for (int order = 0; order <= 3; ++order) {
        const double reach = 0.5 * (order + 1);
        for (int sample = 0; sample < 500; ++sample) {
            const double x = random();
            double sum = 0, mean = 0, variance = 0;
            for (int g = -4; g <= 4; ++g) {
                const double S = spline(order, x - g);
                sum += S, mean += S * (g - x), variance += S * (g - x) * (g - x);
            }
            CHECK(std::fabs(sum - 1) <= 2 * eps);
            if (order > 0) CHECK(std::fabs(mean) <= 2 * eps);
            if (order > 1) CHECK(std::fabs(variance - (order + 1) / 12.0) <= 4 * eps);
            CHECK(spline(order, 2 * x) == spline(order, -2 * x));
            CHECK(spline(order, reach * x) > 0);
            CHECK(spline(order, reach + std::fabs(x)) == 0);
        }
    }
}

// By a three-point Gauss rule between kinks, exact for every piece.
TEST_CASE("a spline is the next lower one averaged over a cell and changes by its differences") {
    Random random;
    const auto integral = [](const auto& f, double a, double b) {
        const double middle = 0.5 * (a + b), half = 0.5 * (b - a), node = half * std::sqrt(0.6);
        return half / 9 * (5 * f(middle - node) + 8 * f(middle) + 5 * f(middle + node));
    };
    for (int order = 1; order <= 3; ++order) {
        const auto lower = [&](double x) { return spline(order - 1, x); };
        const auto slope = [&](double x) { return lower(x + 0.5) - lower(x - 0.5); };
        for (int sample = 0; sample < 500; ++sample) {
            const double x = 2.5 * random(), kink = 0.5 * std::ceil(2 * x - 1);
            const double average = integral(lower, x - 0.5, kink) +
                                   integral(lower, kink, kink + 0.5) +
                                   integral(lower, kink + 0.5, x + 0.5);
            CHECK(std::fabs(average - spline(order, x)) <= 2 * eps);
            const double a = kink + 0.25 + 0.25 * random(), b = kink + 0.25 + 0.25 * random();
            const double change = spline(order, b) - spline(order, a);
            CHECK(std::fabs(integral(slope, a, b) - change) <= 2 * eps);
        }
    }
}

TEST_CASE("the spline average keeps straight lines and multiplies waves with a cubed sinc") {
    const double dx = 0.3, x = 1.7;
    const double line = implicit_moment::spline_average([](double s) { return 2 - 7 * s; }, x, dx);
    CHECK(std::fabs(line - (2 - 7 * x)) <= 1e-14);
    for (const double angle : {0.1, 0.5, 1.0, 2.0, 3.0}) {
        const double factor = std::pow(2 / angle * std::sin(0.5 * angle), 3);
        const auto wave = [&](double s) { return std::cos(angle / dx * (s - x)); };
        CHECK(std::fabs(implicit_moment::spline_average(wave, x, dx) - factor) <=
              1e-6 * (1 - factor));
    }
}

TEST_CASE("several lanes and one number get the weights of the splines") {
    Random random;
    for (int sample = 0; sample < 100; ++sample) {
        SimdVector d{0.5, -0.5};
        for (int l = 2; l < simd_width; ++l) d[l] = 0.5 * random();
        const QuadraticWeights<SimdVector> lanes(d);
        for (int l = 0; l < simd_width; ++l) {
            const QuadraticWeights<double> one(d[l]);
            for (int g = 0; g < 3; ++g) {
                CHECK(std::fabs(one.quadratic[g] - spline(2, d[l] - (g - 1))) <= eps);
                CHECK(std::fabs(lanes.quadratic[g][l] - one.quadratic[g]) <= eps);
            }
            for (int g = 0; g < 2; ++g) {
                CHECK(std::fabs(one.linear[g] - spline(1, d[l] - (g - 0.5))) <= eps);
                CHECK(std::fabs(lanes.linear[g][l] - one.linear[g]) <= eps);
            }
        }
    }
}

TEST_CASE("a few lanes are loaded and added and stored without their neighbors") {
    Random random;
    for (std::size_t count = 1; count <= simd_width; ++count) {
        std::vector<double> from(count), to(12, 7);
        for (double& value : from) value = random();
        const long few = long(count);
        const SimdVector lanes = load_simd(from.data(), few);
        for (std::size_t l = 0; l < simd_width; ++l) CHECK(lanes[l] == from[l < count ? l : 0]);
        const double sum = simd_sum(first_simd(few) * lanes);
        CHECK(std::fabs(sum - std::accumulate(from.begin(), from.end(), 0.0)) <= 4 * eps);
        const double largest = *std::max_element(from.begin(), from.end());
        CHECK(!any_simd(lanes > largest));
        CHECK(any_simd(lanes >= largest));
        store_simd(lanes, to.data(), few);
        for (std::size_t l = 0; l < to.size(); ++l) CHECK(to[l] == (l < count ? from[l] : 7));
    }
}

TEST_CASE("a comparison holds in some lane where it holds in one") {
    for (int l = 0; l < simd_width; ++l) {
        SimdVector lanes{};
        CHECK(!any_simd(lanes > 0.5));
        lanes[l] = -1;
        CHECK(any_simd(magnitude(lanes) > 0.5));
        CHECK(!any_simd(lanes > 0.5));
    }
}

// ---- ghosts and walls ---------------------------------------------------------------------------

TEST_CASE("ghosts are periodic or mirror images and an odd quantity vanishes on a wall") {
    Random random;
    for_every_place_and_parity([&](const Grid& grid, Place place, Parity parity) {
        const Field u = random.field(grid);
        Field f = u;
        common::fill_ghosts(grid, place, parity, f.data());
        long wrong = 0;
        for_each_distinct(grid, place, [&](long i, long j, long n) {
            const bool zero = (parity.x < 0 && weight(grid.x, place.half_x, i) < 1) ||
                              (parity.z < 0 && weight(grid.z, place.half_z, j) < 1);
            wrong += f[n] != (zero ? 0 : u[n]);
        });
        // Behind a wall the last column and row of midpoints have no image.
        const long last_i = grid.x.cells + (grid.x.periodic || !place.half_x);
        const long last_j = grid.z.cells + (grid.z.periodic || !place.half_z);
        for (long j = -1; j <= last_j; ++j) {
            for (long i = -1; i <= last_i; ++i) {
                wrong += f[grid.index(i, j)] != image(grid, place, parity, f.data(), i, j);
            }
        }
        CHECK(wrong == 0);
    });
}

// With the weight 1/2 of a node on a wall:  sum over all stored points of d fill(u)
//     = sum over the distinct points of weight fold(d) u
TEST_CASE("folding is the transpose of filling and doubles the nodes on walls") {
    Random random;
    for_every_place_and_parity([&](const Grid& grid, Place place, Parity parity) {
        const Field u = random.field(grid);
        Field filled_u = u, d = random.field(grid);
        for (long j = -1; j <= grid.z.cells + 1; ++j) {
            if (!grid.x.periodic && place.half_x) d[grid.index(grid.x.cells + 1, j)] = 0;
        }
        if (!grid.z.periodic && place.half_z) d.tail(grid.stride()).setZero();
        common::fill_ghosts(grid, place, parity, filled_u.data());
        const double stored = d.dot(filled_u), tolerance = 0.5 * eps * real(grid.size());
        common::fold_ghosts(grid, place, parity, d.data());
        CHECK(std::fabs(stored - dot(grid, place, d.data(), u.data())) <= tolerance);
        CHECK(filled(grid, place, parity, d));
    });
}

TEST_CASE("a walled mesh is half of a periodic mesh that holds the mirror image") {
    Random random;
    for (const Grid& grid : meshes()) {
        const Grid twice = with_image(grid);
        const double tolerance = 4 * eps * per_cell(grid);
        const VectorField E = random.field(grid, electric), B = random.field(grid, magnetic),
                          J = random.field(grid, current);
        const VectorField E_2 = with_image(grid, electric, E), B_2 = with_image(grid, magnetic, B),
                          J_2 = with_image(grid, current, J);
        const auto both = [&](const VectorKind& kind, const VectorField& f) {
            return with_image(grid, kind, f);
        };
        CHECK(difference(twice, magnetic, both(magnetic, curl_E(grid, E)), curl_E(twice, E_2)) <=
              tolerance);
        CHECK(difference(twice, electric, both(electric, curl_B(grid, B)), curl_B(twice, B_2)) <=
              tolerance);
        // The divergence of E is odd behind walls, those of J and B are even.
        const auto error = [&](Place place, Parity parity, const Field& f, const Field& f_2) {
            return difference(twice, place, with_image(grid, place, parity, f.data()), f_2);
        };
        CHECK(error(on_nodes, odd, div_E(grid, E), div_E(twice, E_2)) <= tolerance);
        CHECK(error(on_nodes, even, div_E(grid, J, even), div_E(twice, J_2)) <= tolerance);
        CHECK(error(on_faces, even, div_B(grid, B), div_B(twice, B_2)) <= tolerance);
    }
}

// ---- differences and their modes ----------------------------------------------------------------

TEST_CASE("the curl of a gradient and the divergence of a curl are zero to round-off") {
    Random random;
    for (const Grid& grid : meshes()) {
        const double tolerance = 4 * eps * per_cell(grid) * per_cell(grid);
        const VectorField slope = gradient(grid, random.field(grid, on_nodes, odd));
        CHECK(difference(grid, magnetic, curl_E(grid, slope), VectorField(grid)) <= tolerance);
        const VectorField B = curl_E(grid, random.field(grid, electric)),
                          E = curl_B(grid, random.field(grid, magnetic));
        CHECK(size_of(grid, on_faces, div_B(grid, B)) <= tolerance);
        CHECK(size_of(grid, on_nodes, div_E(grid, E)) <= tolerance);
    }
}

TEST_CASE("the two curls are transposes of each other and divergence of minus the gradient") {
    Random random;
    for (const Grid& grid : meshes()) {
        const double tolerance = eps * per_cell(grid) * real(grid.size());
        const VectorField E = random.field(grid, electric), B = random.field(grid, magnetic);
        const Field phi = random.field(grid, on_nodes, odd);
        CHECK(std::fabs(dot(grid, magnetic, B, curl_E(grid, E)) -
                        dot(grid, electric, E, curl_B(grid, B))) <= tolerance);
        CHECK(std::fabs(dot(grid, on_nodes, phi.data(), div_E(grid, E).data()) +
                        dot(grid, electric, E, gradient(grid, phi))) <= tolerance);
    }
}

// A scheme that averages would not see these modes at all.
TEST_CASE("an alternating field is seen by curl curl minus grad div with its full wave number") {
    const Grid grid{{8, 0, 4, true}, {6, 0, 1.8, true}};
    for (const auto& mode : {std::pair{1, 0}, {0, 1}, {1, 1}}) {
        const long p = mode.first, q = mode.second;
        const double k2 = real(p) * std::pow(2 / grid.x.spacing(), 2) +
                          real(q) * std::pow(2 / grid.z.spacing(), 2);
        for (long component = 0; component < 3; ++component) {
            VectorField E(grid);
            for_each_distinct(grid, on_nodes, [&](long i, long j, long n) {
                E.all[component * grid.size() + n] = (p * i + q * j) % 2 == 0 ? 1 : -1;
            });
            fill_ghosts(grid, electric, E);
            VectorField result = curl_B(grid, curl_E(grid, E)), expected(grid);
            result.all -= gradient(grid, div_E(grid, E)).all;
            expected.all = k2 * E.all;
            CHECK(difference(grid, electric, result, expected) <= 8 * eps * k2);
        }
    }
}

TEST_CASE("the transforms see every wave of the mesh and the forward difference makes K of it") {
    Random random;
    for (const long n_x : {4L, 7L, 16L}) {
        for (const long n_z : {5L, 12L}) {
            for (const int ends : {0, 1, 2, 3}) {
                const Grid grid{{n_x, -2, 3.7, ends % 2 == 0}, {n_z, 0.5, 2.9, ends < 2}};
                NodeWaves waves(grid);
                MeshWaves<double, 3> of_vector(grid);
                const long points_x = waves.x.points(), points_z = waves.z.points();
                CHECK(points_x == (grid.x.periodic ? n_x : 2 * n_x));
                CHECK(points_z == (grid.z.periodic ? n_z : 2 * n_z));

                // To waves and back, three components at their places: nothing is changed.
                VectorField E = random.field(grid, electric);
                keep_unknowns(grid, E.all.data());
                Eigen::VectorXd back = Eigen::VectorXd::Zero(E.all.size());
                const auto part = [&](std::size_t k) {
                    const long at = long(k) * grid.size();
                    return WaveComponent{E.all.data() + at, back.data() + at, electric.place[k]};
                };
                long rows = 0;
                of_vector.apply({part(0), part(1), part(2)}, [&](long, const auto&) {
#pragma omp atomic
                    ++rows;
                });
                CHECK(rows == points_x / 2 + 1);
                keep_unknowns(grid, back.data());
                CHECK((back - E.all).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= 8 * eps);

                // A wave of the doubled mesh, which vanishes on walls, has its own number and no
                // other.
                for (long p = grid.x.periodic ? 0 : 1; p < (n_x + 1) / 2; ++p) {
                    for (long q = grid.z.periodic ? 0 : 1; q < (n_z + 1) / 2; ++q) {
                        const auto phase = [](const AxisWaves& axis, long wave, long node) {
                            return axis.angle[std::size_t(wave)] * real(node);
                        };
                        Field f = Field::Zero(grid.size());
                        for_each_distinct(grid, on_nodes, [&](long i, long j, long n) {
                            const double x = phase(waves.x, p, i), z = phase(waves.z, q, j);
                            f[n] = (grid.x.periodic ? std::cos(x) : std::sin(x)) *
                                   (grid.z.periodic ? std::cos(z) : std::sin(z));
                        });
                        double elsewhere = 0, here = 0;
                        Field g = f;
                        waves.apply({WaveComponent{f.data(), g.data(), on_nodes}}, [&](long row,
                                                                                       const auto&
                                                                                           wave) {
                            for (long k = 0; k < points_z; ++k) {
                                const double size = std::hypot(wave[0][2 * k], wave[0][2 * k + 1]);
                                const bool its =
                                    row == p && (k == q || k == (points_z - q) % points_z);
                                (its ? here : elsewhere) = worst({its ? here : elsewhere, size});
                            }
                        });
                        CHECK(elsewhere <= 8 * eps);
                        CHECK(here >= 0.24);
                    }
                }

                // D e^{i k x} = i K e^{i k (x + dx/2)}.
                for (const AxisWaves* axis : {&waves.x, &waves.z}) {
                    const double d = axis == &waves.x ? grid.x.spacing() : grid.z.spacing();
                    for (std::size_t k = 0; k < axis->K.size(); ++k) {
                        const std::complex<double> one(0, 1), wave = std::exp(one * axis->angle[k]);
                        CHECK(std::abs((wave - 1.0) / d -
                                       one * axis->K[k] * std::exp(one * (axis->angle[k] / 2))) <=
                              4 * eps / d);
                        CHECK(std::fabs(axis->angle[k]) <= pi);
                    }
                    CHECK(axis->K[0] == 0);
                }
            }
        }
    }
}

TEST_CASE("the Helmholtz and Poisson solutions satisfy the five-point equations to round-off") {
    Random random;
    for (const Grid& grid : meshes()) {
        NodeWaves waves(grid);
        const double k2 = 8 * per_cell(grid) * per_cell(grid);
        const auto laplacian = [&](const Field& g) { return div_E(grid, gradient(grid, g)); };
        Field f = random.field(grid, on_nodes, odd);
        for (const double a : {0.0, 0.2, 3.0}) {
            Field g = f;
            solve_helmholtz(grid, waves, a, g);
            const Field left = g - a * a * laplacian(g);
            CHECK(difference(grid, on_nodes, left, f) <= 16 * eps * (4 + a * a * k2));
            CHECK(filled(grid, on_nodes, odd, g));
        }
        Field g = f;
        solve_poisson(grid, waves, g);
        if (grid.x.periodic && grid.z.periodic) {  // nothing fixes the mean
            const Field one = Field::Ones(grid.size());
            const double cells = dot(grid, on_nodes, one.data(), one.data());
            f.array() -= dot(grid, on_nodes, one.data(), f.data()) / cells;
            CHECK(std::fabs(dot(grid, on_nodes, one.data(), g.data())) <= eps * cells);
        }
        const double tolerance = 4 * eps * (1 + k2 * size_of(grid, on_nodes, g));
        CHECK(difference(grid, on_nodes, -laplacian(g), f) <= tolerance);
        CHECK(filled(grid, on_nodes, odd, g));
    }
}

// ---- smoothing ----------------------------------------------------------------------------------

TEST_CASE("smoothing keeps constants and is its own transpose and sees walls as mirrors") {
    Random random;
    for_every_place_and_parity([&](const Grid& grid, Place place, Parity parity) {
        const Field a = random.field(grid, place, parity), b = random.field(grid, place, parity);
        for (const SmoothingSettings& settings : smoothings) {
            const Field one = Field::Ones(grid.size());
            CHECK(difference(grid, place, smoothed(grid, place, even, settings, one), one) <=
                  8 * eps);
            const Field S_a = smoothed(grid, place, parity, settings, a),
                        S_b = smoothed(grid, place, parity, settings, b);
            CHECK(std::fabs(dot(grid, place, S_a.data(), b.data()) -
                            dot(grid, place, a.data(), S_b.data())) <= eps * real(grid.size()));
            const Grid twice = with_image(grid);
            const Field expected =
                smoothed(twice, place, even, settings, with_image(grid, place, parity, a.data()));
            CHECK(difference(twice, place, with_image(grid, place, parity, S_a.data()), expected) <=
                  8 * eps);
            CHECK(size_of(grid, on_nodes, a - S_a) > 0.01);
        }
        CHECK(smoothed(grid, place, parity, {0, true}, a) == a);
    });
}

TEST_CASE("smoothing leaves nothing in a row that was in memory before") {
    Random random;
    for_every_place_and_parity([&](const Grid& grid, Place place, Parity parity) {
        const Field a = random.field(grid, place, parity);
        for (const SmoothingSettings& settings : smoothings) {
            const Field expected = smoothed(grid, place, parity, settings, a);
            // What is given back now is what smoothing will be given.
            for (const long rows :
                 {grid.z.cells + 3, 34 + 2 * (settings.passes + settings.compensate)})
                std::vector<double>(std::size_t(rows * grid.stride()),
                                    std::numeric_limits<double>::quiet_NaN());
            CHECK(smoothed(grid, place, parity, settings, a) == expected);
        }
    });
}

TEST_CASE("smoothing multiplies every wave with its smoothing factor") {
    for (const int ends : {0, 1, 2, 3}) {
        const Grid grid{{9, 0, 1, ends % 2 == 0}, {8, 0, 1, ends < 2}};
        for (const Place place : {on_nodes, on_x_edges, on_z_edges, on_faces}) {
            // What is on nodes vanishes on walls, what is on midpoints is even about them.
            const Parity parity{place.half_x ? 1 : -1, place.half_z ? 1 : -1};
            const auto along = [](const common::Axis& axis, bool half, long wave, long i) {
                const double angle = (axis.periodic ? 2 : 1) * pi * real(wave) / real(axis.cells),
                             at = angle * (real(i) + 0.5 * half);
                return std::pair(angle, axis.periodic ? std::cos(at + 0.3)
                                        : half        ? std::cos(at)
                                                      : std::sin(at));
            };
            for_each_distinct(grid, on_faces, [&](long l, long m, long) {
                Field f = Field::Zero(grid.size());
                for_each_distinct(grid, place, [&](long i, long j, long n) {
                    f[n] = along(grid.x, place.half_x, l, i).second *
                           along(grid.z, place.half_z, m, j).second;
                });
                common::fill_ghosts(grid, place, parity, f.data());
                for (const SmoothingSettings& settings : smoothings) {
                    const Field expected =
                        smoothing_factor(settings, along(grid.x, place.half_x, l, 0).first) *
                        smoothing_factor(settings, along(grid.z, place.half_z, m, 0).first) * f;
                    const Field result = smoothed(grid, place, parity, settings, f);
                    CHECK(difference(grid, place, result, expected) <= 16 * eps);
                }
            });
        }
    }
}

TEST_CASE("compensated smoothing touches long waves in fourth order only") {
    for (const long passes : {1L, 2L, 3L, 5L}) {
        const auto lost = [&](double angle, bool compensate) {
            return 1 - smoothing_factor({passes, compensate}, angle);
        };
        CHECK(std::fabs(lost(0.02, true) / lost(0.01, true) - 16) <= 0.05);
        CHECK(std::fabs(lost(0.02, false) / lost(0.01, false) - 4) <= 0.01);
        CHECK(std::fabs(lost(pi, true) - 1) <= eps);
    }
    CHECK(smoothing_factor({0, true}, pi) == 1);
}

TEST_CASE("smoothing commutes with curl and divergence also at walls") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const SmoothingSettings& settings : smoothings) {
            const double tolerance = 16 * eps * per_cell(grid);
            const VectorField E = random.field(grid, electric), B = random.field(grid, magnetic),
                              J = random.field(grid, current);
            const VectorField S_E = smoothed(grid, electric, settings, E),
                              S_B = smoothed(grid, magnetic, settings, B),
                              S_J = smoothed(grid, current, settings, J);
            CHECK(difference(grid, magnetic, curl_E(grid, S_E),
                             smoothed(grid, magnetic, settings, curl_E(grid, E))) <= tolerance);
            CHECK(difference(grid, electric, curl_B(grid, S_B),
                             smoothed(grid, electric, settings, curl_B(grid, B))) <= tolerance);
            const Field of_E = smoothed(grid, on_nodes, odd, settings, div_E(grid, E)),
                        of_J = smoothed(grid, on_nodes, even, settings, div_E(grid, J, even));
            CHECK(difference(grid, on_nodes, div_E(grid, S_E), of_E) <= tolerance);
            CHECK(difference(grid, on_nodes, div_E(grid, S_J, even), of_J) <= tolerance);
        }
    }
}

// ---- threads and sorting ------------------------------------------------------------------------

TEST_CASE("loops over blocks and rows cover everything once whatever the number of threads") {
    Random random;
    for (const long count : {0L, 1L, 15L, 16L, 1000L}) {
        std::vector<double> values(count), sums;
        for (double& value : values) value = random();
        std::vector<std::vector<double>> rows;
        for (const int threads : {0, 1, 2, 3}) {  // 0: row after row as it is meant
            common::set_thread_count(threads);
            sums.push_back(common::sum_over_blocks(count, [&](long begin, long end) {
                return std::accumulate(values.begin() + begin, values.begin() + end, 0.0);
            }));
            std::vector<int> seen(values.size(), 0);
            common::for_each_block(count, [&](int, long begin, long end) {
                for (long p = begin; p < end; ++p) ++seen[std::size_t(p)];
            });
            common::for_each_row(count, [&](long row) { ++seen[std::size_t(row)]; });
            CHECK(std::count(seen.begin(), seen.end(), 2) == count);

            // A sum that depends on the order in which a row meets its neighbors.
            rows.emplace_back(values.size() + 2, 1);
            const auto give = [&](long row) {
                for (const long n : {row, row + 1, row + 2}) {
                    double& value = rows.back()[std::size_t(n)];
                    value = 0.7 * value + real(row);
                }
            };
            if (threads == 0) {
                for (long row = 0; row < 3 * count; ++row) {
                    if (row % count * 3 + row / count < count) give(row % count * 3 + row / count);
                }
            } else {
                common::for_each_row_colored(3, count, give);
            }
            CHECK(sums.back() == sums[0]);
            CHECK(rows.back() == rows[0]);
        }
        const double total = std::accumulate(values.begin(), values.end(), 0.0);
        CHECK(std::fabs(sums[0] - total) <= eps * real(count));
    }
}

TEST_CASE("what a piece of a parallel loop throws reaches the caller when all pieces have ended") {
    const long before = common::thread_count();
    for (const int threads : {1, 2}) {
        common::set_thread_count(threads);
        for (const long numbers : {1L, 1L << 20}) {
            std::array<std::atomic<int>, common::block_count> seen{};
            const auto piece = [&](long k) {
                ++seen[std::size_t(k)];
                if (k == 3) throw std::bad_alloc();
            };
            const long rows = common::block_count;
            CHECK_THROWS_AS(common::for_each_row(rows, piece, numbers), std::bad_alloc);
            CHECK_THROWS_AS(common::for_each_row_colored(2, rows, piece, numbers), std::bad_alloc);
            CHECK_THROWS_AS(common::for_each_row_colored(3, rows, piece, numbers), std::bad_alloc);
            CHECK_THROWS_AS(common::for_each_block(
                                rows, [&](int block, long, long) { piece(block); }, numbers),
                            std::bad_alloc);
            for (const auto& times : seen) CHECK(times == 4);
        }
    }
    common::set_thread_count(int(before));
}

TEST_CASE("the sort is stable and puts every particle at its nearest node for any threads") {
    const Grid grid{{7, -1.5, 3.5, true}, {5, 0.5, 1.5, false}};
    Random random;
    const auto place = [&](const common::Axis& axis, int kind) {  // some on the ends of the mesh
        if (kind < 2) return kind == 0 ? axis.low : axis.high();
        return axis.low + axis.length * (0.5 + 0.4999 * random());
    };
    Particles start;
    for (int p = 0; p < 5000; ++p) {
        start.x_p.push_back(place(grid.x, p % 20));
        start.z_p.push_back(place(grid.z, p % 30));
        start.ux_p.push_back(p);
        start.uy_p.push_back(random());
        start.uz_p.push_back(random());
    }
    std::vector<Particles> sorted;
    for (const int threads : {1, 2, 3}) {
        common::set_thread_count(threads);
        SortScratch scratch;
        sort_particles(grid, scratch, sorted.emplace_back(start));
        CHECK(sorted.back().first_of_node == sorted[0].first_of_node);
        CHECK(sorted.back().ux_p == sorted[0].ux_p);
    }
    const Particles& s = sorted[0];
    const auto nodes = std::size_t(nodes_x(grid) * nodes_z(grid));
    REQUIRE(s.first_of_node.size() == nodes + 1);
    CHECK(s.first_of_node.front() == 0);
    CHECK(s.first_of_node.back() == 5000);
    long far = 0, unordered = 0, torn = 0;
    for (std::size_t node = 0; node < nodes; ++node) {
        const double i = real(long(node) % nodes_x(grid)), j = real(long(node) / nodes_x(grid));
        const auto first = std::size_t(s.first_of_node[node]),
                   end = std::size_t(s.first_of_node[node + 1]);
        for (std::size_t p = first; p < end; ++p) {
            const auto from = std::size_t(s.ux_p[p]);
            far += !(std::fabs(s.x_p[p] - grid.x.at(i)) <= (0.5 + 4 * eps) * grid.x.spacing() &&
                     std::fabs(s.z_p[p] - grid.z.at(j)) <= (0.5 + 4 * eps) * grid.z.spacing());
            unordered += p > first && !(s.ux_p[p - 1] < s.ux_p[p]);
            torn += !(s.x_p[p] == start.x_p[from] && s.z_p[p] == start.z_p[from] &&
                      s.uy_p[p] == start.uy_p[from] && s.uz_p[p] == start.uz_p[from]);
        }
    }
    CHECK(far == 0);
    CHECK(unordered == 0);
    CHECK(torn == 0);
}

TEST_CASE("borders between ranks leave as little as possible to the one with most") {
    // Against all ways to cut at most eight pieces, some of them empty.
    for (std::uint32_t trial = 0; trial < 2000; ++trial) {
        const auto below = [&](long bound, std::uint32_t k) {
            return long(double(bound) * common::uniform(7, 1, trial, k));
        };
        std::vector<long> work(1 + below(8, 100));
        for (std::size_t k = 0; k < work.size(); ++k)
            work[k] = std::max(0L, below(12, std::uint32_t(k)) - 2);
        const long pieces = std::ssize(work), ranks = 1 + below(pieces, 101);
        const auto most_of = [&](const std::vector<long>& first) {
            long most = 0;
            for (std::size_t k = 0; k + 1 < first.size(); ++k)
                most = std::max(most, std::accumulate(work.begin() + first[k],
                                                      work.begin() + first[k + 1], 0L));
            return most;
        };
        long best = std::accumulate(work.begin(), work.end(), 0L);
        for (unsigned cuts = 0; cuts < 1U << (pieces - 1); ++cuts) {
            if (std::popcount(cuts) != ranks - 1) continue;
            std::vector<long> first{0};
            for (long piece = 1; piece < pieces; ++piece)
                if ((cuts >> (piece - 1) & 1U) != 0) first.push_back(piece);
            first.push_back(pieces);
            best = std::min(best, most_of(first));
        }
        const auto division = implicit_moment::Division::of(work, 1, ranks);
        CHECK(std::ssize(division.first) == ranks + 1);
        CHECK(std::adjacent_find(division.first.begin(), division.first.end(),
                                 std::greater_equal<>()) == division.first.end());
        CHECK(most_of(division.first) == best);
    }
}
