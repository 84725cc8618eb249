// Facts about relativistic particles of implicit_moment: the implicit midpoint rule in u = gamma v.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "implicit_moment/step.hpp"
#include "implicit_moment/theory/eigenvalues.hpp"
#include "tests/support/any_particles.hpp"

namespace {

using namespace facts;

Vector as_vector(const Velocity<double>& v) { return {v.x, v.y, v.z}; }
Velocity<double> as_velocity(const Vector& v) { return {v[0], v[1], v[2]}; }
Local fields(const Vector& E, const Vector& B) { return {E[0], E[1], E[2], B[0], B[1], B[2]}; }
double gamma_of(const Vector& u) { return std::sqrt(1 + u.squaredNorm()); }
Vector velocity_from(const Vector& u) { return u / gamma_of(u); }
MeanVelocity<double> mean(const Vector& u, const Vector& E, const Vector& B, double k) {
    return relativistic_mean_velocity(as_velocity(u), fields(E, B), k);
}
Vector u_after(const Vector& u, const Vector& E, const Vector& B, double k) {
    return as_vector(mean(u, E, B, k).u_new(as_velocity(u)));
}
// From 1/1000 to 1000.
Vector any_size(Random& random) { return std::pow(10.0, 3 * random()) * random.vector(); }

Particles relativistic(Particles particles) {
    particles.relativistic = true;
    return particles;
}

}  // namespace

TEST_CASE("a relativistic step has the mean velocity of u and gamma and gains the work of E") {
    Random random;
    for (int sample = 0; sample < 20000; ++sample) {
        const Vector u = any_size(random), E = any_size(random), B = any_size(random);
        const double k = 0.7;
        const Vector vbar = as_vector(mean(u, E, B, k).vbar), after = u_after(u, E, B, k);
        const double size = u.norm() + after.norm() + k * E.norm(),
                     with_B = size + k * B.norm() * vbar.norm();
        CHECK((after - u - 2 * k * (E + vbar.cross(B))).norm() <= 1e-13 * with_B);
        CHECK((vbar - (u + after) / (gamma_of(u) + gamma_of(after))).norm() <= 1e-11);
        // gamma differs by (u' - u) . (u' + u) / (gamma' + gamma).
        const double gain = (after - u).dot(after + u) / (gamma_of(u) + gamma_of(after));
        CHECK(std::fabs(gain - 2 * k * vbar.dot(E)) <= 1e-12 * with_B);
        CHECK(vbar.norm() <= 1);
    }
}

TEST_CASE("slow particles move as without relativity but for the square of their speed over c") {
    Random random;
    for (int sample = 0; sample < 100; ++sample) {
        const Vector u = random.vector(), E = random.vector(), B = random.vector();
        const auto apart_at = [&](double slow) {
            const Velocity<double> start = as_velocity(slow * u);
            const Local at = fields(slow * E, B);
            const Vector with = as_vector(Relativistic::mean(start, at, 0.5).u_new(start)),
                         without = as_vector(Newtonian::mean(start, at, 0.5).u_new(start));
            return (with - without).norm() / slow;
        };
        CHECK(apart_at(1e-2) <= 1e-3);
        CHECK(std::fabs(std::log2(apart_at(1e-2) / apart_at(5e-3)) - 2) <= 0.01);
    }
}

TEST_CASE(
    "without E gamma stays to round-off and u turns by twice the arc tangent of O over gamma") {
    Random random;
    for (const double speed : {0.1, 3.0, 100.0}) {
        const Vector start = speed * random.vector(), B(0.4, -1, 2);
        const double k = 5, gamma = gamma_of(start);
        const Eigen::AngleAxisd turn(-2 * std::atan(k * B.norm() / gamma), B.normalized());
        CHECK((u_after(start, {0, 0, 0}, B, k) - turn * start).norm() <= 1e-14 * start.norm());
        Vector u = start;
        for (int step = 0; step < 1000; ++step) u = u_after(u, {0, 0, 0}, B, k);
        CHECK(std::fabs(gamma_of(u) / gamma - 1) <= 1e-13);
    }
}

TEST_CASE("the E x B drift is exact at any gamma and any step") {
    Random random;
    for (const double speed : {0.01, 0.9, 0.999, 0.99999}) {
        for (const double k : {0.01, 1.0, 300.0}) {
            const Vector B = random.vector(), v = speed * random.vector().cross(B).normalized(),
                         E = -v.cross(B), u = v / std::sqrt(1 - v.squaredNorm());
            CHECK((u_after(u, E, B, k) - u).norm() <= 1e-12 * u.norm() * gamma_of(u));
            CHECK((as_vector(mean(u, E, B, k).vbar) - v).norm() <= 1e-13 * gamma_of(u));
        }
    }
    // The whole step of both movers, periodic ends included.
    const Grid grid = meshes()[0];
    const Vector B(0.2, 1, -0.3), v(0.6, 0, 0.4), E = -v.cross(B);
    const double factor = 1 / std::sqrt(1 - v.squaredNorm());
    Particles start = relativistic(no_particles());
    add(start, -0.7, 1.2, factor * v);
    sort(grid, start);
    for (const double dt : {0.3, 20.0}) {
        const InterleavedField push = uniform(grid, E, B);
        std::vector<Particles> flown{start}, moved{start};
        move_particles(push, grid, dt, tight, moved);
        drift(grid, 0.5 * dt, flown);
        sort(grid, flown[0]);
        kick_particles(push, push, grid, dt, flown);
        drift(grid, 0.5 * dt, flown);
        for (const Particles& s : {moved[0], flown[0]}) {
            CHECK((velocity(s, 0) - factor * v).norm() <= 1e-13);
            CHECK(apart(grid.x, s.x_p[0], -0.7 + dt * v[0]) <= 1e-12);
            CHECK(apart(grid.z, s.z_p[0], 1.2 + dt * v[2]) <= 1e-12);
        }
    }
}

TEST_CASE(
    "in a uniform E motion is hyperbolic: exact at the midpoint and of second order in flight") {
    const Grid grid{{8, 0, 1000, true}, {8, 0, 1000, true}};
    const Vector E(0, 0, 2);
    const InterleavedField push = uniform(grid, E, {0, 0, 0});
    Particles start = relativistic(no_particles());
    const double acceleration = start.q_p / start.m_p * E[2], end = 8;
    add(start, 0, 100, {0, 0.5, 0});
    sort(grid, start);
    // gamma = [1 + u_y^2 + (a t)^2]^(1/2) and z = (gamma - gamma_0) / a.
    const double exact =
        100 + (std::sqrt(1.25 + std::pow(acceleration * end, 2)) - std::sqrt(1.25)) / acceleration;
    for (const bool flies : {false, true}) {
        const auto error = [&](double dt) {
            std::vector<Particles> s{start};
            for (double t = 0; t < end - 0.5 * dt; t += dt) {
                if (flies) {
                    drift(grid, 0.5 * dt, s);
                    sort(grid, s[0]);
                    kick_particles(push, push, grid, dt, s);
                    drift(grid, 0.5 * dt, s);
                } else {
                    move_particles(push, grid, dt, tight, s);
                }
                sort(grid, s[0]);
            }
            CHECK(std::fabs(s[0].uz_p[0] - acceleration * end) <= 1e-12 * acceleration * end);
            CHECK(s[0].uy_p[0] == about(0.5).epsilon(1e-12));
            return std::fabs(s[0].z_p[0] - exact);
        };
        // dt (u + u') / (gamma + gamma') is the change of gamma over a.
        if (flies)
            CHECK(std::fabs(std::log2(error(0.1) / error(0.05)) - 2) <= 0.05);
        else
            CHECK(error(0.1) <= 1e-11);
    }
}

TEST_CASE("the linear mean velocity is the tangent and its work is never negative") {
    Random random;
    for (int sample = 0; sample < 2000; ++sample) {
        const Vector u = any_size(random), guess = any_size(random), B = any_size(random);
        const double k = 0.7;
        const LinearVelocity<double> linear =
            linear_mean_velocity(as_velocity(u), fields(guess, B), k);
        const Eigen::Matrix3d A =
            Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(linear.A.data());
        const auto apart_at = [&](const Vector& d) {
            return (as_vector(linear.free) + k * A * (guess + d) -
                    as_vector(mean(u, guess + d, B, k).vbar))
                .norm();
        };
        CHECK(apart_at({0, 0, 0}) <= 1e-12 * (1 + k * A.norm() * guess.norm()));
        const Eigen::Matrix3d symmetric = 0.5 * (A + A.transpose());
        CHECK(eigensystem(symmetric.cast<std::complex<double>>()).values.real().minCoeff() >= 0);
    }
    // What it leaves out is of second order.
    for (int sample = 0; sample < 200; ++sample) {
        const Vector u = 2 * random.vector(), guess = random.vector(), B = random.vector(),
                     d = random.vector();
        const LinearVelocity<double> linear =
            linear_mean_velocity(as_velocity(u), fields(guess, B), 1);
        const auto apart_at = [&](double size) {
            const Vector E = guess + size * d;
            Vector v = as_vector(linear.free);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) v[i] += linear.A[index(3 * i + j)] * E[j];
            return (v - as_vector(mean(u, E, B, 1).vbar)).norm();
        };
        CHECK(apart_at(2e-3) <= 4.3 * apart_at(1e-3) + 1e-14);
    }
}

TEST_CASE("along v the response is that of the mass gamma cubed and across it of gamma") {
    const Vector u(0, 3, 0);
    const double gamma = gamma_of(u);
    const auto A = linear_mean_velocity(as_velocity(u), fields({0, 0, 0}, {0, 0, 0}), 0.4).A;
    CHECK(std::fabs(A[4] * std::pow(gamma, 3) - 1) <= 1e-13);
    CHECK(std::fabs(A[0] * gamma - 1) <= 1e-14);
    CHECK(std::fabs(A[8] * gamma - 1) <= 1e-14);
}

TEST_CASE("the moments of relativistic particles have their own velocities and response") {
    Random random;
    const Grid grid = meshes()[0];
    const Particles s = relativistic(anywhere(grid, 400, 3, random));
    VectorField B(grid);
    const Vector B_0(0.5, -0.3, 0.8);
    for (long n = 0; n < grid.size(); ++n) B.x()[n] = B_0[0], B.y()[n] = B_0[1], B.z()[n] = B_0[2];
    const double dt = 1.1, k = 0.5 * dt * s.q_p / s.m_p;
    Moments moments(grid), own(grid);
    deposit_moments(s, grid, B, dt, moments);
    deposit_moments(s, grid, own);
    Vector J_hat(0, 0, 0), J(0, 0, 0), momentum(0, 0, 0);
    Eigen::Matrix3d response = Eigen::Matrix3d::Zero();
    double energy = 0;
    const double small = 1e-5;
    for (std::size_t p = 0; p < s.x_p.size(); ++p) {
        const Vector u = velocity(s, p);
        momentum += s.m_p * u;
        energy += s.m_p * u.squaredNorm() / (1 + gamma_of(u));
        J += s.q_p * velocity_from(u);
        J_hat += s.q_p * as_vector(mean(u, {0, 0, 0}, B_0, k).vbar);
        for (int a = 0; a < 3; ++a) {
            const Vector E = small * Vector::Unit(a);
            response.col(a) += s.q_p / (2 * small) * as_vector(mean(u, E, B_0, k).vbar) -
                               s.q_p / (2 * small) * as_vector(mean(u, -E, B_0, k).vbar);
        }
    }
    const double size = s.q_p * double(s.count());
    CHECK(std::fabs(total(grid, on_x_edges, moments.J_x) - J_hat[0]) <= 1e-13 * size);
    CHECK(std::fabs(total(grid, on_nodes, moments.J_y) - J_hat[1]) <= 1e-13 * size);
    CHECK(std::fabs(total(grid, on_z_edges, own.J_z) - J[2]) <= 1e-13 * size);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            CHECK(std::fabs(total(grid, on_nodes, moments.response[index(3 * i + j)]) -
                            response(i, j)) <= 1e-8 * size);
    CHECK(std::fabs(moments.kinetic_energy / energy - 1) <= 1e-13);
    for (std::size_t a = 0; a < 3; ++a)
        CHECK(std::fabs(moments.momentum[a] - momentum[long(a)]) <= 1e-12 * size);
}

TEST_CASE("relativistic particles at walls and seams keep gamma and stay inside") {
    Random random;
    for (const Grid& grid : meshes()) {
        const InterleavedField push = uniform(grid, {0, 0, 0}, {0.3, 2, -0.5});
        Particles s = relativistic(anywhere(grid, 500, 5, random));
        double before = 0, after = 0;
        for (std::size_t p = 0; p < s.x_p.size(); ++p) before += gamma_of(velocity(s, p));
        for (int step = 0; step < 20; ++step) {
            const MoverReport report = move_particles(push, grid, 0.4, tight, s);
            CHECK(report.lost == 0);
            sort(grid, s);
        }
        for (std::size_t p = 0; p < s.x_p.size(); ++p) {
            after += gamma_of(velocity(s, p));
            CHECK(s.x_p[p] >= grid.x.low);
            CHECK(s.x_p[p] <= grid.x.high());
            CHECK(s.z_p[p] >= grid.z.low);
            CHECK(s.z_p[p] <= grid.z.high());
        }
        CHECK(std::fabs(after / before - 1) <= 1e-13);
    }
}
