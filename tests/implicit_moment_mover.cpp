// Facts about how the particles of implicit_moment move: the midpoint rule, sub-steps, walls,
// seams.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/random.hpp"
#include "tests/support/any_particles.hpp"

namespace {

using namespace facts;

// Moves with at least as many sub-steps as given.
Particles one_by_one(const Grid& grid, const InterleavedField& push, double dt, int at_least,
                     const Particles& start) {
    Particles moved = start;
    for (std::size_t p = 0; p < start.x_p.size(); ++p) {
        Velocity<double> v{};
        for (int parts = at_least; parts <= 1024; parts *= 2) {
            moved.x_p[p] = start.x_p[p], moved.z_p[p] = start.z_p[p];
            v = {start.ux_p[p], start.uy_p[p], start.uz_p[p]};
            if (move_one(grid, push, tight, start.q_p / start.m_p, dt, parts, moved.x_p[p],
                         moved.z_p[p], v))
                break;
        }
        moved.ux_p[p] = v.x, moved.uy_p[p] = v.y, moved.uz_p[p] = v.z;
    }
    return moved;
}

}  // namespace

// ---- the mover ----------------------------------------------------------------------------------

TEST_CASE("moved particles satisfy the midpoint rule to the tolerance of the mover") {
    Random random;
    const Grid grid = meshes()[0];
    const InterleavedField push = random_push(grid, 0.3, 0.5, random);
    for (const double tolerance : {1e-4, 1e-14}) {
        const Particles start = anywhere(grid, 3000, 0.5, random);
        Particles particles = start;
        const double dt = 0.5, h = 0.5 * dt, kick = start.q_p / start.m_p * h;
        const MoverReport report = move_particles(push, grid, dt, {tolerance, 100}, particles);
        CHECK(report.one_by_one > 100);
        CHECK(report.sub_stepped == 0);
        double residual = 0, displacement = 0;
        for (std::size_t p = 0; p < start.x_p.size(); ++p) {
            const Vector v = velocity(start, p), u = 0.5 * (v + velocity(particles, p));
            double x = start.x_p[p] + h * u[0], z = start.z_p[p] + h * u[2];
            x -= grid.x.length * std::floor((x - grid.x.low) / grid.x.length);
            z -= grid.z.length * std::floor((z - grid.z.low) / grid.z.length);
            const Local at = gathered(grid, push, x, z);
            const Vector E(at.E_x, at.E_y, at.E_z), B(at.B_x, at.B_y, at.B_z);
            residual = worst({residual, (u - v - kick * (E + u.cross(B))).norm()});
            displacement =
                worst({displacement, apart(grid.x, particles.x_p[p], start.x_p[p] + dt * u[0]),
                       apart(grid.z, particles.z_p[p], start.z_p[p] + dt * u[2])});
        }
        CHECK(residual * h / grid.z.spacing() <= tolerance);
        CHECK(displacement <= 8 * eps);
    }
}

TEST_CASE("several at once and one by one find the same step also at walls") {
    Random random;
    for (const Grid& grid : meshes()) {
        const InterleavedField push = random_push(grid, 0.2, 0.5, random);
        const Particles start = anywhere(grid, 3000, 0.5, random);
        Particles particles = start;
        const MoverReport report = move_particles(push, grid, 0.4, tight, particles);
        CHECK(report.lost == 0);
        CHECK(report.one_by_one < 1500);
        CHECK(difference(grid, particles, one_by_one(grid, push, 0.4, 1, start)) <= 1e-14);
        for (const auto& [at, axis] :
             {std::pair{&particles.x_p, &grid.x}, {&particles.z_p, &grid.z}}) {
            CHECK(*std::min_element(at->begin(), at->end()) >= axis->low);
            CHECK(*std::max_element(at->begin(), at->end()) <= axis->high());
        }
    }
}

TEST_CASE("a magnetic field does no work") {
    Random random;
    for (const Grid& grid : meshes()) {
        const InterleavedField push = random_push(grid, 0, 2, random);
        for (int sample = 0; sample < 5; ++sample) {
            const Particles start = anywhere(grid, 2000, 0.5, random);
            Particles particles = start;
            move_particles(push, grid, 0.4, MoverSettings{}, particles);
            double change = 0;
            for (std::size_t p = 0; p < start.x_p.size(); ++p) {
                const double v = velocity(start, p).norm(), now = velocity(particles, p).norm();
                change = worst({change, std::fabs(now - v)});
            }
            CHECK(change <= 2e-14);
        }
    }
}

TEST_CASE("in uniform fields a step is the E x B drift and a turn by twice the arc tangent") {
    Random random;
    const Grid grid = meshes()[0];
    const Vector B(0.3, -0.5, 0.4), E(0.02, 0.03, 0.05), b = B.normalized();
    const InterleavedField push = uniform(grid, E, B);
    for (const double dt : {0.01, 0.3, 1.5}) {
        const Particles start = anywhere(grid, 500, 0.1, random);
        Particles particles = start;
        move_particles(push, grid, dt, tight, particles);
        const double kick = start.q_p / start.m_p * dt;
        const Eigen::AngleAxisd turn(-2 * std::atan(0.5 * kick * B.norm()), b);
        const Vector drift = E.cross(B) / B.squaredNorm(), along = kick * E.dot(b) * b;
        double error = 0;
        for (std::size_t p = 0; p < start.x_p.size(); ++p) {
            const Vector expected = drift + turn * (velocity(start, p) - drift) + along;
            error = worst({error, (velocity(particles, p) - expected).norm()});
        }
        CHECK(error <= 2 * eps);
    }
}

TEST_CASE("steps are undone by steps with velocity and magnetic field reversed") {
    Random random;
    const Grid grid = meshes()[0];
    const VectorField E = random.field(grid, electric, 0.3);
    VectorField B = random.field(grid, magnetic, 0.5), reversed = B;
    reversed.all = -B.all;
    const InterleavedField forward = pack(grid, E, B), backward = pack(grid, E, reversed);
    for (int sample = 0; sample < 200; ++sample) {
        const Particles start = anywhere(grid, 1, 0.5, random);
        Particles particle = start;
        for (const InterleavedField* push : {&forward, &backward}) {
            for (int step = 0; step < 4; ++step) {
                move_particles(*push, grid, 0.3, tight, particle);
                sort(grid, particle);
            }
            for (auto* v : {&particle.ux_p, &particle.uy_p, &particle.uz_p}) v->front() *= -1;
        }
        CHECK(difference(grid, start, particle) <= 2e-14);
    }
}

TEST_CASE("a particle that would cross several cells in a step is followed in sub-steps") {
    Random random;
    const Grid grid = meshes()[0];
    VectorField E(grid), B(grid);
    for (long j = -1; j <= grid.z.cells + 1; ++j) {
        for (long i = -1; i <= grid.x.cells + 1; ++i) {
            const double x = 2 * pi * real(i) / real(grid.x.cells),
                         z = 2 * pi * real(j) / real(grid.z.cells);
            E.x()[grid.index(i, j)] = 0.2 * std::sin(x);
            E.z()[grid.index(i, j)] = 0.2 * std::cos(z);
            B.y()[grid.index(i, j)] = 0.3 * std::sin(x + z);
        }
    }
    const InterleavedField push = pack(grid, E, B);
    for (const double cells : {2.5, 4.0, 8.0}) {
        Particles particles = anywhere(grid, 50, 0, random);
        for (std::size_t p = 0; p < 50; ++p) {
            const double angle = pi * random(), v = cells * grid.x.spacing();
            particles.ux_p[p] = v * std::cos(angle), particles.uz_p[p] = v * std::sin(angle);
        }
        const Particles start = particles;
        const MoverReport report = move_particles(push, grid, 1, MoverSettings{}, particles);
        CHECK(report.lost == 0);
        CHECK(report.sub_stepped == 50);
        CHECK(report.one_by_one == 50);
        CHECK(difference(grid, particles, one_by_one(grid, push, 1, 512, start)) <= 0.02);
    }
}

TEST_CASE("a field that is not a number is reported as lost particles") {
    const facts::Untrapped calm;
    Random random;
    const double bad = std::numeric_limits<double>::quiet_NaN();
    for (const Grid& grid : meshes()) {
        for (const Vector& E : {Vector(bad, bad, bad), Vector(0, bad, 0)}) {
            std::vector<Particles> species{anywhere(grid, 100, 0.1, random)};
            Particles same = species[0];
            const InterleavedField push = uniform(grid, E, {0, 0.1, 0});
            CHECK(move_particles(push, grid, 0.3, MoverSettings{}, same).lost == 100);
            CHECK_THROWS_AS(move_particles(push, grid, 0.3, MoverSettings{}, species),
                            common::NumericalError);
        }
    }
}

TEST_CASE("a field that overwhelms everything is reported as lost particles") {
    const facts::Untrapped calm;
    Random random;
    for (const Grid& grid : meshes()) {
        for (const double huge : {1e12, 1e18, 1e30, 1e200}) {
            Particles particles = anywhere(grid, 100, 0.1, random);
            const InterleavedField push = uniform(grid, {huge, huge, huge}, {0, 0, 0});
            CHECK(move_particles(push, grid, 0.3, MoverSettings{}, particles).lost == 100);
        }
    }
}

// ---- walls and seams ----------------------------------------------------------------------------

TEST_CASE("without fields particles bounce between walls like light between mirrors") {
    Random random;
    for (const Grid& grid : meshes()) {
        const InterleavedField push = uniform(grid, {0, 0, 0}, {0, 0, 0});
        Particles particles = anywhere(grid, 400, 0.9, random);
        for (std::size_t p = 0; p < 400; ++p) {  // some in corners, some along walls
            if (p % 16 == 0) particles.z_p[p] = grid.z.low, particles.x_p[p] = grid.x.high();
            if (p % 9 == 0) particles.ux_p[p] = 0;
            particles.uy_p[p] = double(p);  // a name that stays
        }
        const Particles start = particles;
        double error = 0;
        long wrong = 0;
        for (int step = 1; step <= 40; ++step) {
            sort(grid, particles);
            wrong += move_particles(push, grid, 0.3, MoverSettings{}, particles).lost;
            // With all its images a bouncing particle flies straight on.
            const auto check = [&](const common::Axis& axis, double x_0, double v_0, double x,
                                   double v) {
                const double path = (x_0 - axis.low + step * 0.3 * v_0) / axis.length;
                const double seen = axis.periodic ? path : std::fabs(std::remainder(path, 2));
                error = worst({error, apart(axis, axis.low + seen * axis.length, x)});
                wrong += !(x >= axis.low && x <= axis.high() && std::fabs(v) == std::fabs(v_0));
            };
            for (std::size_t p = 0; p < 400; ++p) {
                const auto s = std::size_t(particles.uy_p[p]);
                check(grid.x, start.x_p[s], start.ux_p[s], particles.x_p[p], particles.ux_p[p]);
                check(grid.z, start.z_p[s], start.uz_p[s], particles.z_p[p], particles.uz_p[p]);
            }
        }
        CHECK(wrong == 0);
        CHECK(error <= 4e-14);
    }
}

TEST_CASE("who comes to a wall is reflected and who has turned back already is not") {
    const common::Axis axis{8, -1, 2, false};
    for (const double side : {-1.0, 1.0}) {
        for (const double speed : {0.3, 2.0}) {
            double x = side > 0 ? axis.high() + 1e-14 : axis.low - 1e-14, v = side * speed;
            detail::arrive(axis, true, x, v);
            CHECK(x == (side > 0 ? axis.high() : axis.low));
            CHECK(v == -side * speed);
            detail::arrive(axis, true, x, v);
            CHECK(v == -side * speed);
            detail::arrive(axis, false, x, v = side * speed);
            CHECK(v == side * speed);
        }
    }
}

TEST_CASE("a particle that lies on a wall and is pressed against it stays there") {
    const Grid grid = meshes()[3];
    for (const double depth : {0.0, 1e-15, 1e-9, 1e-3}) {
        for (const double E : {0.01, 1.0}) {
            Particles particle = no_particles();
            add(particle, grid.x.at(2.3), grid.z.low + depth, {0.1, 0.2, 0});
            sort(grid, particle);
            const InterleavedField push = uniform(grid, {0, 0, -E}, {0, 0, 0});
            CHECK(move_particles(push, grid, 0.3, tight, particle).lost == 0);
            CHECK(particle.z_p[0] >= grid.z.low);
            CHECK(particle.z_p[0] <= grid.z.low + depth + 1e-6);
            CHECK(std::fabs(particle.x_p[0] - grid.x.at(2.3) - 0.03) <= 1e-13);
        }
    }
}

// The electrons of the GEM challenge turn by almost 0.4 in a step at the walls.
TEST_CASE("gyration at a reflecting wall drives no current and keeps the density uniform" *
          doctest::description("physics")) {
    const Grid grid{{4, 0, 4, true}, {8, 0, 8, false}};
    const double thermal = 0.2;  // cells per step
    for (const bool along_x : {true, false}) {
        for (const double turn : {0.1, 0.2, 0.4}) {
            Particles particles;
            particles.q_p = particles.m_p = 1.0 / 300;
            for (std::uint64_t p = 0; p < 300 * 4 * 8; ++p) {
                const auto normal = [p](unsigned base) {
                    return gsl_cdf_ugaussian_Pinv(common::radical_inverse(p, base));
                };
                add(particles, 4 * common::radical_inverse(p, 2), 8 * common::radical_inverse(p, 3),
                    thermal * Vector(normal(5), normal(7), normal(11)));
            }
            const InterleavedField push =
                uniform(grid, {0, 0, 0}, {along_x ? turn : 0, along_x ? 0 : turn, 0});
            double density = 0, flow = 0;
            for (int step = 0; step < 600; ++step) {
                sort(grid, particles);
                if (step >= 300 && step % 10 == 0) {
                    const Moments moments = deposited(grid, particles);
                    for (long n = grid.index(0, 0); n < grid.index(4, 0); ++n) {
                        density += moments.rho[n] / 120;
                        flow += (along_x ? moments.J_y : moments.J_x)[n] / 120 / thermal;
                    }
                }
                move_particles(push, grid, 1, MoverSettings{1e-6, 20}, particles);
            }
            CHECK(std::fabs(density - 1) <= 0.01);
            CHECK(std::fabs(flow) <= 0.01);
        }
    }
}

TEST_CASE("particles cross the periodic seam and stay inside the mesh") {
    const Grid grid = meshes()[0];
    const InterleavedField push = uniform(grid, {0, 0, 0}, {0, 0, 0});
    for (const double x : {grid.x.low, grid.x.high(), std::nextafter(grid.x.high(), 0.0)}) {
        for (const double v : {0.0, 1e-300, -1e-300, 1e-17, -1e-17, 0.5, -0.5, 9.0, -9.0}) {
            Particles particle = no_particles();
            add(particle, x, grid.z.at(2), {v, 0, v});
            sort(grid, particle);
            CHECK(move_particles(push, grid, 0.3, MoverSettings{}, particle).lost == 0);
            CHECK(particle.x_p[0] >= grid.x.low);
            CHECK(particle.x_p[0] < grid.x.high());
            CHECK(apart(grid.x, particle.x_p[0], x + v * 0.3) <= 4 * eps);
            CHECK(apart(grid.z, particle.z_p[0], grid.z.at(2) + v * 0.3) <= 8 * eps);
            CHECK(particle.ux_p[0] == v);
        }
    }
}

TEST_CASE("one and two and three threads give the same particles and moments to the last bit") {
    for (const Grid& grid : meshes()) {
        std::vector<Particles> moved;
        std::vector<Moments> moments;
        for (const int threads : {1, 2, 3}) {
            common::set_thread_count(threads);
            Random random;
            const InterleavedField push = random_push(grid, 0.2, 0.5, random);
            Particles& particles = moved.emplace_back(anywhere(grid, 5000, 0.5, random));
            for (int step = 0; step < 3; ++step) {
                move_particles(push, grid, 0.4, MoverSettings{}, particles);
                sort(grid, particles);
            }
            moments.push_back(deposited(grid, particles));
            CHECK(identical(particles, moved[0]));
            CHECK(moments.back().kinetic_energy == moments[0].kinetic_energy);
            CHECK(moments.back().momentum == moments[0].momentum);
            for (std::size_t f = 0; f < moments[0].all().size(); ++f) {
                CHECK(*moments.back().all()[f] == *moments[0].all()[f]);
            }
        }
    }
}
