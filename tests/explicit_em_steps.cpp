// Facts about how the particles of explicit_em move, what they feel, and the current of their
// paths.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "common/splines.hpp"
#include "tests/support/any_leapfrog.hpp"

namespace {

using namespace facts;

constexpr double dt = 1;  // no speed is beyond that of light when a particle crosses a cell

InterleavedField nothing(const Grid& grid) { return uniform(grid, {0, 0, 0}, {0, 0, 0}); }

// Calls work(grid, order, relativistic) for all of them.
template <class Work>
void for_each_setting(const Work& work) {
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            for (const bool relativistic : {false, true}) work(grid, order, relativistic);
        }
    }
}

Vector electric_part(const Local& at) { return {at.E_x, at.E_y, at.E_z}; }
Vector magnetic_part(const Local& at) { return {at.B_x, at.B_y, at.B_z}; }

}  // namespace

// ---- cells --------------------------------------------------------------------------------------

TEST_CASE("the weights of a cell are splines whose slopes are differences of the next lower ones") {
    const auto check = []<int l>(std::integral_constant<int, l>) {
        Random random;
        const double h = 0.01;
        for (int sample = 0; sample < 100; ++sample) {
            const double middle = 0.5 * (Stencil<l>::low + Stencil<l>::high),
                         d = middle + 0.49 * random();
            const StencilWeights<l, double> S(d), before(d - h), after(d + h);
            double sum = 0;
            for (int k = 0; k <= l; ++k) {
                const double below = k > 0 ? S.half(k - 1) : 0, above = k < l ? S.half(k) : 0;
                sum += S.node(k);
                CHECK(std::fabs(S.node(k) - common::spline(l, d - k - Stencil<l>::first)) <=
                      2 * eps);
                CHECK(std::fabs((after.node(k) - before.node(k)) / (2 * h) - (below - above)) <=
                      2 * eps / h);
            }
            for (int k = 0; k < l; ++k) {
                const double at = d - k - Stencil<l>::first - 0.5;
                CHECK(std::fabs(S.half(k) - common::spline(l - 1, at)) <= 2 * eps);
            }
            CHECK(std::fabs(sum - 1) <= 2 * eps);
        }
    };
    check(std::integral_constant<int, 1>{});
    check(std::integral_constant<int, 2>{});
}

TEST_CASE("sorted particles lie between the borders of their cells in their old order") {
    Random random;
    for (const Grid& grid : meshes()) {
        const auto check = [&]<int l>(std::integral_constant<int, l>) {
            Particles particles = travelers(grid, 2000, dt, 0.9, false, random);
            for (std::size_t p = 0; p < 2000; ++p) particles.uy_p[p] = real(long(p));
            const Particles start = particles;
            sort(grid, l, particles);
            const long columns = Stencil<l>::cells(grid.x), rows = Stencil<l>::cells(grid.z);
            REQUIRE(particles.first_of_node.size() == index(columns * rows + 1));
            CHECK(particles.first_of_node.front() == 0);
            CHECK(particles.first_of_node.back() == 2000);
            double outside = 0;
            long wrong = 0;
            for (long cell = 0; cell < columns * rows; ++cell) {
                const long i = cell % columns, j = cell / columns;
                for (int k = particles.first_of_node[index(cell)];
                     k < particles.first_of_node[index(cell + 1)]; ++k) {
                    const auto p = std::size_t(k), from = std::size_t(particles.uy_p[p]);
                    wrong += particles.x_p[p] != start.x_p[from] ||
                             particles.z_p[p] != start.z_p[from] ||
                             particles.ux_p[p] != start.ux_p[from] ||
                             particles.uz_p[p] != start.uz_p[from];
                    wrong += k > particles.first_of_node[index(cell)] &&
                             particles.uy_p[p] <= particles.uy_p[p - 1];
                    const double d_x = (particles.x_p[p] - grid.x.low) / grid.x.spacing() - real(i),
                                 d_z = (particles.z_p[p] - grid.z.low) / grid.z.spacing() - real(j);
                    for (const double beyond :
                         {Stencil<l>::low_of(grid.x, i) - d_x, d_x - Stencil<l>::high_of(grid.x, i),
                          Stencil<l>::low_of(grid.z, j) - d_z,
                          d_z - Stencil<l>::high_of(grid.z, j)})
                        outside = worst({outside, beyond});
                }
            }
            CHECK(wrong == 0);
            CHECK(outside <= 16 * eps);
        };
        check(std::integral_constant<int, 1>{});
        check(std::integral_constant<int, 2>{});
    }
}

// ---- paths --------------------------------------------------------------------------------------

TEST_CASE("the current of a path is its integral by definition also behind walls") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        for (const double cells : {0.1, 0.999}) {
            const Particles start = travelers(grid, 300, dt, cells, relativistic, random);
            for (const int sign : {+1, -1}) {
                const VectorKind& kind = sign > 0 ? current : electric;
                Particles particles = start;
                VectorField J =
                    current_of_step(grid, nothing(grid), dt, order, relativistic, kind, particles);
                const VectorField expected =
                    current_of_flight(grid, dt, order, order, relativistic, sign, start);
                // A position that is a little off moves as much current from one edge to the next.
                const double tolerance = round_off(
                    grid, order, 300, start.q_p * grid.x.spacing() / (dt * grid.cell_area()));
                CHECK(largest(grid, kind, expected) >= 0.1);
                CAPTURE(order);
                const VectorField integral =
                    current_of_flight(grid, dt, order, 3, relativistic, sign, start);
                for (std::size_t a : {0, 2}) {  // J_y is that of the rule's points
                    const long from = long(a) * grid.size();
                    CHECK(largest(grid, kind.place[a],
                                  (J.all - integral.all).segment(from, grid.size())) <= tolerance);
                }
                J.all -= expected.all;
                CHECK(largest(grid, kind, J) <= tolerance);
            }
        }
    });
}

TEST_CASE("charge is conserved on every node to round-off") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        for (const double cells : {0.1, 0.95}) {
            const Particles start = travelers(grid, 1000, dt, cells, relativistic, random);
            for (const int sign : {+1, -1}) {
                Particles particles = start;
                const VectorField J =
                    current_of_step(grid, random_push(grid, 1e-3, 1e-2, random), dt, order,
                                    relativistic, sign > 0 ? current : electric, particles);
                Field change =
                    charge(grid, order, sign, particles) - charge(grid, order, sign, start);
                Field div = Field::Zero(grid.size());
                divergence_of_electric(grid, J.all.data(), div);
                CAPTURE(order);
                CHECK(largest(grid, on_nodes, dt * div) >= 0.1 * start.q_p / grid.cell_area());
                CHECK(largest(grid, on_nodes, change + dt * div) <=
                      round_off(grid, order, 1000, start.q_p / grid.cell_area()));
            }
        }
    });
}

TEST_CASE("the mesh holds the total current of all paths") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        const Particles start = travelers(grid, 1000, dt, 0.999, relativistic, random);
        Particles particles = start;
        VectorField J =
            current_of_step(grid, nothing(grid), dt, order, relativistic, current, particles);
        Vector expected = Vector::Zero();
        for (std::size_t p = 0; p < start.x_p.size(); ++p)
            expected += start.q_p * true_velocity(start, p, relativistic);
        for (std::size_t a = 0; a < 3; ++a) {
            // What flows into a wall flows back.
            if (a == 0 && !grid.x.periodic) continue;
            if (a == 2 && !grid.z.periodic) continue;
            const Field part = J.all.segment(long(a) * grid.size(), grid.size());
            CHECK(std::fabs(total(grid, electric.place[a], part) - expected[long(a)]) <= 1e-13);
        }
    });
}

// Esirkepov's W for a particle that stays in its cell, equations (31) and (38) to (41) of his paper
// in two dimensions.
TEST_CASE("within a cell linear splines give the current of Esirkepov") {
    Random random;
    const Grid grid = meshes()[0];
    for (int sample = 0; sample < 300; ++sample) {
        const auto inside = [&] { return 0.5 + 0.499 * random(); };
        const double x = inside(), z = inside(), to_x = inside(), to_z = inside();
        const Vector v((to_x - x) * grid.x.spacing(), random(), (to_z - z) * grid.z.spacing());
        Particles particle = no_particles();
        add(particle, grid.x.at(3 + x), grid.z.at(2 + z), v);
        const VectorField J = current_of_step(grid, nothing(grid), dt, 1, false, current, particle);

        const double S_x[2]{1 - x, x}, S_z[2]{1 - z, z};
        const double DS_x[2]{x - to_x, to_x - x}, DS_z[2]{z - to_z, to_z - z};
        const double q = particle.q_p / grid.cell_area();
        double error = 0;
        for (int k = 0; k < 2; ++k) {
            const long along_x = grid.index(3, 2 + k), along_z = grid.index(3 + k, 2);
            const double W_x = DS_x[0] * (S_z[k] + 0.5 * DS_z[k]),
                         W_z = DS_z[0] * (S_x[k] + 0.5 * DS_x[k]);
            error = worst({error, std::fabs(J.x()[along_x] + q * grid.x.spacing() / dt * W_x),
                           std::fabs(J.z()[along_z] + q * grid.z.spacing() / dt * W_z)});
            for (int m = 0; m < 2; ++m) {
                // J_y at the middle of the path, which Esirkepov takes elsewhere.
                const double W_y = (S_x[m] + 0.5 * DS_x[m]) * (S_z[k] + 0.5 * DS_z[k]);
                error = worst({error, std::fabs(J.y()[grid.index(3 + m, 2 + k)] - q * v[1] * W_y)});
            }
        }
        CHECK(error <= 8 * eps * q);
        // Nothing anywhere else.
        CHECK(std::fabs(J.all.cwiseAbs().sum() -
                        q * (std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]))) <= 32 * eps * q);
    }
}

TEST_CASE("a path cut in pieces gives the sum of their currents and ends at the same point") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        const Particles start = travelers(grid, 200, dt, 0.999, relativistic, random);
        Particles at_once = start, cut = start;
        VectorField J =
            current_of_step(grid, nothing(grid), dt, order, relativistic, electric, at_once);
        for (const double part : {0.15, 0.5, 0.05, 0.3}) {
            J.all -= part * current_of_step(grid, nothing(grid), part * dt, order, relativistic,
                                            electric, cut)
                                .all;
        }
        // In the plane; out of it the current of a piece is that of the rule's points alone.
        std::fill_n(J.y(), grid.size(), 0.0);
        CHECK(largest(grid, electric, J) <= 400 * eps);
        // Each carries its name.
        for (auto* particles : {&at_once, &cut}) {
            particles->ux_p = particles->uz_p = std::vector<double>(200, 0.0);
        }
        const auto ordered = [&](const Particles& moved) {
            Particles all = no_particles();
            std::vector<std::size_t> names(moved.uy_p.size());
            for (std::size_t p = 0; p < names.size(); ++p) names[p] = p;
            std::sort(names.begin(), names.end(),
                      [&](std::size_t a, std::size_t b) { return moved.uy_p[a] < moved.uy_p[b]; });
            for (const std::size_t p : names) add(all, moved.x_p[p], moved.z_p[p], {0, 0, 0});
            return all;
        };
        CHECK(difference(grid, ordered(at_once), ordered(cut)) <= 16 * eps);
    });
}

TEST_CASE("free particles end where the images of their straight flights do") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        Particles particles = travelers(grid, 400, dt, 0.8, relativistic, random);
        for (std::size_t p = 0; p < 400; ++p) {
            particles.uy_p[p] = 1e-3 * real(long(p));  // a name that stays
            if (p % 16 == 0) particles.z_p[p] = grid.z.low, particles.x_p[p] = grid.x.low;
            if (p % 9 == 0) particles.ux_p[p] = 0;
            if (p % 16 == 8) particles.uz_p[p] = 0;
        }
        const Particles start = particles;
        double error = 0;
        long wrong = 0;
        for (int step = 1; step <= 30; ++step) {
            current_of_step(grid, nothing(grid), dt, order, relativistic, electric, particles);
            for (std::size_t p = 0; p < 400; ++p) {
                const auto s = std::size_t(std::lround(1e3 * particles.uy_p[p]));
                const Vector v = true_velocity(start, s, relativistic);
                const auto check = [&](const common::Axis& axis, double from, double v_0,
                                       double u_0, double x, double u) {
                    const Seen seen(axis, (from - axis.low + step * dt * v_0) / axis.spacing());
                    const double at_wall = std::min(seen.s, real(axis.cells) - seen.s);
                    error = worst({error, apart(axis, axis.at(seen.s), x)});
                    wrong += !(x >= axis.low - 4 * eps && x <= axis.high() + 4 * eps);
                    wrong += axis.periodic && x >= axis.high();
                    wrong += std::fabs(u) != std::fabs(u_0);
                    wrong += (axis.periodic || at_wall > 1e-12) && u != seen.sign * u_0;
                };
                check(grid.x, start.x_p[s], v[0], start.ux_p[s], particles.x_p[p],
                      particles.ux_p[p]);
                check(grid.z, start.z_p[s], v[2], start.uz_p[s], particles.z_p[p],
                      particles.uz_p[p]);
            }
        }
        CHECK(wrong == 0);
        CHECK(error <= 1e-13);
    });
}

TEST_CASE("a particle moves the same in any crowd and the currents of a crowd add up") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            const InterleavedField push = random_push(grid, 0.05, 0.5, random);
            for (int count = 1; count <= 17; ++count) {
                Particles crowd = no_particles();
                for (int p = 0; p < count; ++p) {
                    add(crowd, grid.x.at(3.25 + 0.2 * random()), grid.z.at(2.25 + 0.2 * random()),
                        0.15 * random.vector());
                }
                sort(grid, order, crowd);  // all share a cell
                const Particles start = crowd;
                VectorField J = current_of_step(grid, push, dt, order, true, electric, crowd);
                long differ = 0;
                for (std::size_t p = 0; p < start.x_p.size(); ++p) {
                    Particles alone = no_particles();
                    add(alone, start.x_p[p], start.z_p[p], velocity(start, p));
                    J.all -= current_of_step(grid, push, dt, order, true, electric, alone).all;
                    long same = 0;  // those that leave the cell leave the order, too
                    for (std::size_t k = 0; k < crowd.x_p.size(); ++k)
                        same += alone.x_p[0] == crowd.x_p[k] && alone.z_p[0] == crowd.z_p[k] &&
                                velocity(alone, 0) == velocity(crowd, k);
                    differ += same != 1;
                }
                CHECK(differ == 0);
                CHECK(largest(grid, electric, J) <= 32 * eps);
            }
        }
    }
}

TEST_CASE("all species together give the sum of their currents smoothed and with ghosts filled") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            for (const SmoothingSettings smoothing : {SmoothingSettings{0, true}, {2, true}}) {
                const InterleavedField push = random_push(grid, 0.01, 0.1, random);
                const VectorKind kind = implicit_moment::felt(grid);
                std::vector<Particles> species;
                VectorField expected(grid), J(grid);
                for (const double q : {0.7, -0.4}) {
                    species.push_back(travelers(grid, 500, dt, 0.8, true, random));
                    species.back().q_p = q;
                    Particles alone = species.back();
                    expected.all += current_of_step(grid, push, dt, order, true, kind, alone).all;
                    sort(grid, order, species.back());
                }
                CurrentScratch scratch;
                Field room;
                smooth(grid, kind, smoothing, expected.all.data(), room);
                for (int again = 0; again < 2; ++again) {  // what is kept between steps is no state
                    std::vector<Particles> moved = species;
                    std::vector<Crossings> crossings;
                    move_particles(push, grid, dt, {true, order, true}, smoothing, moved, crossings,
                                   scratch, J);
                    CHECK(largest(J.all - expected.all) <= 200 * eps);
                }
            }
        }
    }
}

TEST_CASE("a field that is not a number or overwhelms everything is reported as lost particles") {
    const facts::Untrapped calm;
    Random random;
    const double bad = std::numeric_limits<double>::quiet_NaN();
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            for (const Vector& E : {Vector(bad, bad, bad), Vector(bad, 0, 0), Vector(10, 0, 0),
                                    Vector(0, 0, -1e30), Vector(1e200, 1e200, 1e200)}) {
                std::vector<Particles> species{travelers(grid, 100, dt, 0.1, false, random)};
                sort(grid, order, species[0]);
                CurrentScratch scratch;
                std::vector<Crossings> crossings;
                VectorField J(grid);
                CHECK_THROWS_WITH_AS(
                    move_particles(uniform(grid, E, {0, 0.1, 0}), grid, dt, {true, order, false},
                                   SmoothingSettings{0, true}, species, crossings, scratch, J),
                    "100 of the ions cross more than a cell in one step: they were loaded too "
                    "fast, or the field has blown up; reduce time.dt",
                    common::NumericalError);
            }
        }
    }
}

TEST_CASE("a particle may cross a whole cell in one step and no more in either direction") {
    const auto moves = [](const Grid& grid, long order, double cells_x, double cells_z) {
        std::vector<Particles> species{no_particles()};
        add(species[0], grid.x.at(3.4), grid.z.at(3.3),
            Vector(cells_x * grid.x.spacing(), 0, cells_z * grid.z.spacing()) / dt);
        sort(grid, order, species[0]);
        CurrentScratch scratch;
        std::vector<Crossings> crossings;
        VectorField J(grid);
        move_particles(nothing(grid), grid, dt, {true, order, false}, SmoothingSettings{0, true},
                       species, crossings, scratch, J);
    };
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            for (const double way : {-1.0, 1.0}) {
                CHECK_NOTHROW(moves(grid, order, 0.999 * way, 0.999 * way));
                CHECK_THROWS_AS(moves(grid, order, 1.001 * way, 0), common::NumericalError);
                CHECK_THROWS_AS(moves(grid, order, 0, 1.001 * way), common::NumericalError);
            }
        }
    }
}

TEST_CASE("after a step every particle is there and in its cell in an order that a sort keeps") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            for (const int count : {1, 7, 300, 5000}) {
                for (const double cells : {0.05, 0.5, 1.0}) {
                    CAPTURE(order);
                    CAPTURE(count);
                    Particles particles = travelers(grid, count, dt, cells, false, random);
                    const auto marked = [](const Particles& s) {  // by a velocity that stays
                        std::vector<double> marks = s.uy_p;
                        std::sort(marks.begin(), marks.end());
                        return marks;
                    };
                    const std::vector<double> before = marked(particles);
                    for (int step = 0; step < 5; ++step) {
                        current_of_step(grid, nothing(grid), dt, order, false, electric, particles);
                        CHECK(marked(particles) == before);
                        Particles sorted = particles;
                        sort(grid, order, sorted);
                        CHECK(identical(sorted, particles));
                        CHECK(sorted.first_of_node == particles.first_of_node);
                    }
                }
            }
        }
    }
}

TEST_CASE("a crowd that leaves its rows is moved as a whole") {
    // All particles of some rows go the same way: whole tiles are emptied and others filled.
    Random random;
    const Grid grid{{8, 0, 8, true}, {40, 0, 40, true}};
    for (const long order : {1, 2}) {
        for (const double way : {-1.0, 1.0}) {
            Particles particles = no_particles();
            for (int p = 0; p < 4000; ++p)
                add(particles, 4 + 4 * random(), 20 + (p % 3 == 0 ? 19 : 2.5) * random(),
                    Vector(0, random(), way * (0.9 + 0.099 * random())) / dt);
            const double momentum =
                std::accumulate(particles.uy_p.begin(), particles.uy_p.end(), 0.0);
            for (int step = 0; step < 90; ++step) {
                current_of_step(grid, nothing(grid), dt, order, false, electric, particles);
                Particles sorted = particles;
                sort(grid, order, sorted);
                CHECK(identical(sorted, particles));
            }
            CHECK(std::accumulate(particles.uy_p.begin(), particles.uy_p.end(), 0.0) ==
                  about(momentum).epsilon(1e-9));
        }
    }
}

TEST_CASE("one and two and three threads give the same particles and currents to the last bit") {
    for (const Grid& grid : meshes()) {
        for (const long order : {1, 2}) {
            std::vector<Particles> moved;
            std::vector<VectorField> currents;
            std::vector<Moments> counted;
            for (const int threads : {1, 2, 3}) {
                common::set_thread_count(threads);
                Random random;
                const InterleavedField push = random_push(grid, 0.02, 0.5, random);
                moved.push_back(travelers(grid, 20000, dt, 0.45, true, random));
                for (int step = 0; step < 2; ++step) {
                    currents.push_back(
                        current_of_step(grid, push, dt, order, true, electric, moved.back()));
                }
                sort(grid, order, moved.back());
                std::vector<Moments> moments(1, Moments(grid));
                deposit_charge_and_current(push, grid, dt, {true, order, true}, {moved.back()},
                                           Images::plasma, moments);
                counted.push_back(moments[0]);
                CHECK(identical(moved.back(), moved[0]));
                CHECK(currents[currents.size() - 2].all == currents[0].all);
                CHECK(currents.back().all == currents[1].all);
                CHECK(counted.back().kinetic_energy == counted[0].kinetic_energy);
                CHECK(counted.back().momentum == counted[0].momentum);
                CHECK(counted.back().rho == counted[0].rho);
                CHECK(counted.back().J_x == counted[0].J_x);
            }
            common::set_thread_count(1);
        }
    }
}

// ---- Boris's push -------------------------------------------------------------------------------

namespace {

using U = implicit_moment::Velocity<double>;
Vector vector(const U& u) { return {u.x, u.y, u.z}; }
U pushed(const Vector& u, const Vector& E, const Vector& B, double half_kick, double per_c2) {
    U now{u[0], u[1], u[2]};
    push(now, Local{E[0], E[1], E[2], B[0], B[1], B[2]}, half_kick, per_c2);
    return now;
}

}  // namespace

TEST_CASE("a magnetic field rotates u by twice the arc tangent of its angle and keeps its length") {
    Random random;
    for (const bool relativistic : {false, true}) {
        for (int sample = 0; sample < 300; ++sample) {
            const Vector u = 3 * random.vector(), B = 2 * random.vector();
            const double k = 1.5 * random(), per_c2 = per_c_squared(relativistic),
                         gamma = std::sqrt(1 + per_c2 * u.squaredNorm());
            const Vector rotated = vector(pushed(u, {0, 0, 0}, B, k, per_c2));
            const Eigen::AngleAxisd turn(-2 * std::atan(k * B.norm() / (c * gamma)),
                                         B.normalized());
            CHECK((rotated - turn * u).norm() <= 8 * eps * u.norm());
            CHECK(std::fabs(rotated.norm() / u.norm() - 1) <= 4 * eps);
            CHECK((vector(pushed(rotated, {0, 0, 0}, B, -k, per_c2)) - u).norm() <=
                  8 * eps * u.norm());
        }
    }
}

TEST_CASE("in crossed fields a slow particle rotates exactly about the E x B drift") {
    Random random;
    for (int sample = 0; sample < 300; ++sample) {
        const Vector B = random.vector() + Vector(0, 2, 0), u = random.vector(),
                     E = 0.3 * random.vector(), b = B.normalized();
        const double k = random();
        const Vector drift = c * E.cross(B) / B.squaredNorm(), along = 2 * k * E.dot(b) * b;
        const Eigen::AngleAxisd turn(-2 * std::atan(k * B.norm() / c), b);
        CHECK((vector(pushed(u, E, B, k, 0)) - (drift + turn * (u - drift) + along)).norm() <=
              8 * eps);
    }
}

TEST_CASE("a constant electric field accelerates u at a constant rate at any speed") {
    Random random;
    for (const bool relativistic : {false, true}) {
        for (int sample = 0; sample < 10; ++sample) {
            const Vector start = random.vector(), E = random.vector();
            Vector u = start;
            for (int step = 0; step < 100; ++step)
                u = vector(pushed(u, E, {0, 0, 0}, 0.05, per_c_squared(relativistic)));
            CHECK((u - (start + 100 * 0.1 * E)).norm() <= 200 * eps * u.norm());
        }
    }
}

TEST_CASE("particles are pushed by the field where they are and then moved with the new velocity") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        const InterleavedField push = random_push(grid, 0.02, 0.4, random);
        Particles particles = travelers(grid, 500, dt, 0.5, relativistic, random);
        sort(grid, order, particles);
        const Particles start = particles;
        current_of_step(grid, push, dt, order, relativistic, electric, particles);
        const double half_kick = 0.5 * dt * start.q_p / start.m_p;
        double error = 0;
        for (std::size_t p = 0; p < 500; ++p) {
            const double s = in_cells(grid.x, start.x_p[p]), t = in_cells(grid.z, start.z_p[p]);
            const Local at = felt(grid, push, order, s, t);
            const Vector u = vector(pushed(velocity(start, p), electric_part(at), magnetic_part(at),
                                           half_kick, per_c_squared(relativistic))),
                         v = u / std::sqrt(1 + per_c_squared(relativistic) * u.squaredNorm());
            const Seen x(grid.x, s + dt * v[0] / grid.x.spacing()),
                z(grid.z, t + dt * v[2] / grid.z.spacing());
            // At a wall the sign is that of round-off.
            const auto flips = [](double a, double b) {
                return std::min(std::fabs(a - b), std::fabs(a + b));
            };
            // Those that leave their cell leave the order, too: it is the one with this u_y.
            std::size_t k = 0;
            for (std::size_t other = 0; other < 500; ++other)
                if (std::fabs(particles.uy_p[other] - u[1]) < std::fabs(particles.uy_p[k] - u[1]))
                    k = other;
            error = worst({error, apart(grid.x, particles.x_p[k], grid.x.at(x.s)),
                           apart(grid.z, particles.z_p[k], grid.z.at(z.s)),
                           std::fabs(particles.uy_p[k] - u[1]), flips(particles.ux_p[k], u[0]),
                           flips(particles.uz_p[k], u[2])});
        }
        CHECK(error <= 32 * eps);
    });
}

// ---- gather -------------------------------------------------------------------------------------

TEST_CASE("linear fields are gathered exactly where the splines are linear") {
    Random random;
    const Grid grid = meshes()[3];
    const Vector E_0 = random.vector(), E_1 = random.vector(), E_2 = random.vector();
    const Vector B_0 = random.vector(), B_1 = random.vector(), B_2 = random.vector();
    InterleavedField push(index(grid.size()));
    for (long j = -1; j <= grid.z.cells + 1; ++j) {
        for (long i = -1; i <= grid.x.cells + 1; ++i) {
            const auto at = [&](const Vector& a, const Vector& b, const Vector& d, long n,
                                const VectorKind& kind) {
                const Place place = kind.place[index(n)];
                return a[n] + b[n] * (real(i) + 0.5 * place.half_x) +
                       d[n] * (real(j) + 0.5 * place.half_z);
            };
            push[index(grid.index(i, j))] = {
                at(E_0, E_1, E_2, 0, electric), at(E_0, E_1, E_2, 1, electric),
                at(E_0, E_1, E_2, 2, electric), at(B_0, B_1, B_2, 0, magnetic),
                at(B_0, B_1, B_2, 1, magnetic), at(B_0, B_1, B_2, 2, magnetic)};
        }
    }
    for (const long order : {1, 2}) {
        for (int sample = 0; sample < 300; ++sample) {
            const double s = 4 * (1 + random()), t = 3.5 * (1 + random());
            const Local at = felt(grid, push, order, s, t);
            // Linear splines take the middle of the cell where the field lives between nodes.
            const auto seen = [&](double position, bool half) {
                return order == 1 && half ? std::floor(position) + 0.5 : position;
            };
            double error = 0;
            for (long a = 0; a < 3; ++a) {
                const Place e = electric.place[index(a)], b = magnetic.place[index(a)];
                error = worst({error,
                               std::fabs(electric_part(at)[a] - E_0[a] -
                                         E_1[a] * seen(s, e.half_x) - E_2[a] * seen(t, e.half_z)),
                               std::fabs(magnetic_part(at)[a] - B_0[a] -
                                         B_1[a] * seen(s, b.half_x) - B_2[a] * seen(t, b.half_z))});
            }
            CHECK(error <= 64 * eps);
        }
    }
}

// Within a cell the gathered field is at most quadratic, so that central differences are exact.
TEST_CASE("the gathered gradient is the gradient of the gathered potential and div B is zero") {
    Random random;
    for (const Grid& grid : meshes()) {
        const double dx = grid.x.spacing(), dz = grid.z.spacing(), h = 0.05;
        const auto [E, B] = gradient_and_curl(grid, random);
        const InterleavedField push = pack(grid, E, B);
        for (const long order : {1, 2}) {
            for (int sample = 0; sample < 300; ++sample) {
                const double middle = order == 1 ? 0.5 : 0;
                const double s = std::round(3 + 2 * random()) + middle + 0.4 * random(),
                             t = std::round(3 + 2 * random()) + middle + 0.4 * random();
                const auto at = [&](double x, double z) { return felt(grid, push, order, x, z); };
                const Local left = at(s - h, t), right = at(s + h, t), down = at(s, t - h),
                            up = at(s, t + h);
                const double tolerance = 8 * eps / h / dz;
                CHECK(std::fabs(at(s, t).E_x + (right.E_y - left.E_y) / (2 * h * dx)) <= tolerance);
                CHECK(std::fabs(at(s, t).E_z + (up.E_y - down.E_y) / (2 * h * dz)) <= tolerance);
                CHECK(std::fabs((right.B_x - left.B_x) / dx + (up.B_z - down.B_z) / dz) <=
                      tolerance);
            }
        }
    }
}

TEST_CASE("the work of the current is that of the field gathered along the paths also at walls") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        const Particles start = travelers(grid, 300, dt, 0.999, relativistic, random);
        const VectorField E = random.field(grid, electric, 1);
        const InterleavedField push = pack(grid, E, VectorField(grid));
        Particles particles = start;
        const VectorField J =
            current_of_step(grid, nothing(grid), dt, order, relativistic, electric, particles);
        double work = 0;
        for (std::size_t p = 0; p < start.x_p.size(); ++p) {
            const Vector v = true_velocity(start, p, relativistic);
            along_path(
                grid, order, order, in_cells(grid.x, start.x_p[p]), in_cells(grid.z, start.z_p[p]),
                dt * v[0] / grid.x.spacing(), dt * v[2] / grid.z.spacing(),
                [&](double part, const Seen& x, const Seen& z) {
                    const Vector here = electric_part(felt(grid, push, order, x.s, z.s));
                    work += part * start.q_p * here.dot(Vector(v[0] * x.sign, v[1], v[2] * z.sign));
                });
        }
        for (std::size_t a = 0; a < 3; ++a) {
            const long from = long(a) * grid.size();
            const Field product =
                J.all.segment(from, grid.size()).cwiseProduct(E.all.segment(from, grid.size()));
            work -= total(grid, electric.place[a], product);
        }
        CHECK(std::fabs(work) <= 300 * eps);
    });
}

// A kick uses the field at the start of a path; it does the work of the current where the field
// does not change along the path.
TEST_CASE("kicks do the work of the current in a uniform field and within cells of a plane wave") {
    Random random;
    const Grid grid = meshes()[0];
    for (const long order : {1, 2}) {
        for (const bool wave : {false, true}) {
            if (wave && order == 2) continue;  // quadratic splines see slopes within a cell
            VectorField E(grid);
            for (long i = 0; i < grid.x.cells; ++i) {
                const double E_x = random();
                for (long j = 0; j < grid.z.cells; ++j) {
                    E.x()[grid.index(i, j)] = wave ? E_x : 0.2;
                    E.y()[grid.index(i, j)] = 0.5;
                    E.z()[grid.index(i, j)] = -0.4;
                }
            }
            fill_ghosts(grid, electric, E);
            const InterleavedField push = pack(grid, E, VectorField(grid));
            Particles particles = no_particles();
            for (int p = 0; p < 500; ++p) {
                const double x = wave ? std::floor(4 * (1 + random())) + 0.5 + 0.3 * random()
                                      : 4 * (1 + random());
                add(particles, grid.x.at(x), grid.z.at(3.5 * (1 + random())),
                    0.15 * grid.x.spacing() * random.vector());
            }
            const double q_m = 1e-2;  // a kick that lets them stay in their cells
            particles.m_p = particles.q_p / q_m;
            const auto energy = [&] {
                double sum = 0;
                for (std::size_t p = 0; p < 500; ++p) sum += velocity(particles, p).squaredNorm();
                return 0.5 * particles.m_p * sum;
            };
            // Between its two half kicks a velocity is v^{n+1/2} less half a kick.
            const double before = energy();
            double mean = 0;
            for (std::size_t p = 0; p < 500; ++p) {
                const double s = in_cells(grid.x, particles.x_p[p]),
                             t = in_cells(grid.z, particles.z_p[p]);
                mean += 0.5 * dt * dt * particles.q_p * q_m *
                        electric_part(felt(grid, push, order, s, t)).squaredNorm();
            }
            const VectorField J = current_of_step(grid, push, dt, order, false, current, particles);
            double work = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                const long from = long(a) * grid.size();
                const Field product =
                    J.all.segment(from, grid.size()).cwiseProduct(E.all.segment(from, grid.size()));
                work += dt * total(grid, electric.place[a], product);
            }
            CHECK(std::fabs(work) >= 0.01);
            CHECK(std::fabs(energy() - before + mean - work) <= 1e-11);
        }
    }
}

// ---- moments at t^n -----------------------------------------------------------------------------

TEST_CASE("half a step and half a step back undo each other and turn by half the angle") {
    Random random;
    for (const bool relativistic : {false, true}) {
        for (int sample = 0; sample < 300; ++sample) {
            const Vector u = 2 * random.vector(), E = random.vector(), B = random.vector();
            const Local at{E[0], E[1], E[2], B[0], B[1], B[2]};
            const double k = random(), per_c2 = per_c_squared(relativistic);
            U now{u[0], u[1], u[2]};
            half_step(now, at, k, per_c2);
            const Vector kicked = u + k * E;
            const double gamma = std::sqrt(1 + per_c2 * kicked.squaredNorm());
            const Eigen::AngleAxisd turn(-2 * std::atan(0.5 * k * B.norm() / (c * gamma)),
                                         B.normalized());
            CHECK((vector(now) - turn * kicked).norm() <= 16 * eps);
            half_step_back(now, at, k, per_c2);
            CHECK((vector(now) - u).norm() <= 16 * eps);
        }
    }
}

TEST_CASE("moments are the sums over particles and images with the velocities of the same time") {
    Random random;
    for_each_setting([&](const Grid& grid, long order, bool relativistic) {
        for (const int sign : {+1, -1}) {
            const InterleavedField push = random_push(grid, 0.1, 0.5, random);
            Particles particles = travelers(grid, 300, dt, 0.9, relativistic, random);
            sort(grid, order, particles);
            std::vector<Moments> moments(1, Moments(grid));
            deposit_charge_and_current(push, grid, dt, {true, order, relativistic}, {particles},
                                       sign > 0 ? Images::plasma : Images::conductor, moments);
            const double half_kick = 0.5 * dt * particles.q_p / particles.m_p,
                         per_c2 = per_c_squared(relativistic);
            // A wall that mirrors the plasma does so for the field equations, too.
            const auto sign_at = [&](const common::Axis& axis) { return axis.mirrors ? 1 : sign; };
            VectorField J(grid);
            Field charges = Field::Zero(grid.size());
            Vector momentum = Vector::Zero();
            double energy = 0;
            for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
                const double s = in_cells(grid.x, particles.x_p[p]),
                             t = in_cells(grid.z, particles.z_p[p]);
                U now{particles.ux_p[p], particles.uy_p[p], particles.uz_p[p]};
                half_step(now, felt(grid, push, order, s, t), half_kick, per_c2);
                const Vector u = vector(now);
                const double gamma = std::sqrt(1 + per_c2 * u.squaredNorm());
                momentum += particles.m_p * u;
                energy +=
                    particles.m_p * (relativistic ? (gamma - 1) * c * c : 0.5 * u.squaredNorm());
                const double q = particles.q_p / grid.cell_area() / gamma;
                const auto node_x = spline_and_images(grid.x, order, false, sign_at(grid.x), s),
                           node_z = spline_and_images(grid.z, order, false, sign_at(grid.z), t);
                // Linear splines put a particle on a border into the cell above it.
                const auto half = [&](const common::Axis& axis, double at) {
                    const long cell = order == 1 ? Stencil<1>::cell_of(axis, at) : 0;
                    const double inside =
                        order == 1 ? std::clamp(at, real(cell) + 1e-9, real(cell) + 1 - 1e-9) : at;
                    return spline_and_images(axis, order - 1, true, -sign_at(axis), inside);
                };
                add_product(grid, particles.q_p / grid.cell_area(), node_x, node_z, charges.data());
                add_product(grid, q * u[0], half(grid.x, s), node_z, J.x());
                add_product(grid, q * u[1], node_x, node_z, J.y());
                add_product(grid, q * u[2], node_x, half(grid.z, t), J.z());
            }
            const Moments& m = moments[0];
            const double tolerance =
                round_off(grid, order, particles.x_p.size(), particles.q_p / grid.cell_area());
            const long size = grid.size();
            CHECK(largest(grid, on_nodes, m.rho - charges) <= tolerance);
            CHECK(largest(grid, on_x_edges, m.J_x - J.all.head(size)) <= tolerance);
            CHECK(largest(grid, on_nodes, m.J_y - J.all.segment(size, size)) <= tolerance);
            CHECK(largest(grid, on_z_edges, m.J_z - J.all.tail(size)) <= tolerance);
            CHECK(std::fabs(m.kinetic_energy / energy - 1) <= 64 * eps);
            for (std::size_t a = 0; a < 3; ++a)
                CHECK(std::fabs(m.momentum[a] - momentum[long(a)]) <= 1e-13);
            // Ghosts are filled.
            Field rho = m.rho;
            common::fill_ghosts(grid, on_nodes, {sign_at(grid.x), sign_at(grid.z)}, rho.data());
            CHECK(rho == m.rho);
        }
    });
}

TEST_CASE("the energy of a slow particle has no error of cancellation") {
    const Grid grid = meshes()[0];
    for (const double u : {1e-3, 1e-8, 1e-12}) {
        Particles particle = no_particles();
        add(particle, grid.x.at(2.3), grid.z.at(3.1), {u, 0, 0});
        sort(grid, 2, particle);
        std::vector<Moments> moments(1, Moments(grid));
        deposit_charge_and_current(nothing(grid), grid, dt, {true, 2, true}, {particle},
                                   Images::plasma, moments);
        const double expected = 0.5 * particle.m_p * u * u * (1 - 0.25 * u * u);
        CHECK(std::fabs(moments[0].kinetic_energy / expected - 1) <= 1e-12);
    }
}
