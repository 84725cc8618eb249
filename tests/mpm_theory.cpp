// Facts about the theory that the material point method is compared with, each against another
// derivation: balance of forces, quadratures, other integrators; and about the raster of fringes.
#include <doctest/doctest.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "implicit_moment/theory/theta_light_wave.hpp"
#include "mpm_explicit/output/write_output.hpp"
#include "mpm_explicit/theory/exact_solutions.hpp"
#include "mpm_explicit/theory/scheme_theory.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

using facts::real;
using mpm::Disk;
using mpm::FringeRaster;
using mpm::Mesh;
using mpm::Particles;
using mpm::Stress;

constexpr double pi = std::numbers::pi;
const Disk colliding{0.2, 1000, 1e4, 0.3};

// Gauss's rule of three points on each of many panels.
template <class Function>
double integral(const Function& f, double low, double high, int panels = 4000) {
    const double h = (high - low) / panels, aside = 0.5 * h * std::sqrt(0.6);
    double sum = 0;
    for (int n = 0; n < panels; ++n) {
        const double middle = low + (n + 0.5) * h;
        sum += 5 * f(middle - aside) + 8 * f(middle) + 5 * f(middle + aside);
    }
    return sum * h / 18;
}

// The force between two colliding disks whose centers are closer by delta.
double force_of(double delta) {
    double low = 0, high = 8 * pi * colliding.R * colliding.E_pair() * std::exp(-2.0);
    for (int n = 0; n < 100; ++n) {
        const double middle = 0.5 * (low + high);
        (mpm::contact_approach(colliding, middle) < delta ? low : high) = middle;
    }
    return delta > 0 ? low : 0.0;
}

// delta, its rate and the impulse so far.
int collide(double, const double y[], double rate[], void*) {
    const double P = force_of(y[0]);
    rate[0] = y[1];
    rate[1] = -P / (0.5 * colliding.mass());
    rate[2] = P;
    return GSL_SUCCESS;
}

struct Collision {
    double duration, peak_force, impulse, rebound;
};

Collision collide_with_gsl(double speed) {
    gsl_odeiv2_system system{collide, nullptr, 3, nullptr};
    gsl_odeiv2_driver* driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rkf45, 1e-4, 1e-11, 1e-11);
    double y[3] = {0, 2 * speed, 0}, t = 0, last_t = 0, last_delta = 0, largest = 0;
    for (int n = 1; y[0] > 0 || n == 1; ++n) {
        last_t = t, last_delta = y[0];
        if (gsl_odeiv2_driver_apply(driver, &t, n * 2e-4, y) != GSL_SUCCESS) break;
        largest = std::max(largest, force_of(y[0]));
    }
    gsl_odeiv2_driver_free(driver);
    return {last_t + (t - last_t) * last_delta / (last_delta - y[0]), largest, y[2], -y[1]};
}

}  // namespace

TEST_CASE("the stress in a disk between two loads is in balance everywhere") {
    const double R = 0.2, P = 237.5, d = 1e-5;
    for (const double x : {-0.13, -0.05, 0.0, 0.02, 0.1})
        for (const double y : {-0.12, -0.03, 0.0, 0.06, 0.11}) {
            const auto at = [&](double dx, double dy) {
                return mpm::disk_stress(P, R, x + dx, y + dy);
            };
            const double force_x = at(d, 0).xx - at(-d, 0).xx + at(0, d).xy - at(0, -d).xy;
            const double force_y = at(d, 0).xy - at(-d, 0).xy + at(0, d).yy - at(0, -d).yy;
            const double scale = P / (R * R);
            CHECK(std::abs(force_x) / (2 * d) <= 1e-5 * scale);
            CHECK(std::abs(force_y) / (2 * d) <= 1e-5 * scale);
        }
}

TEST_CASE("the stress in a disk between two loads is compatible with a displacement") {
    // Without body forces sxx + syy is harmonic.
    const double d = 1e-3;
    for (const double x : {-0.4, 0.1, 0.5})
        for (const double y : {-0.3, 0.0, 0.4}) {
            const auto sum = [&](double dx, double dy) {
                const Stress s = mpm::disk_stress(1, 1, x + dx, y + dy);
                return s.xx + s.yy;
            };
            const double laplacian =
                (sum(d, 0) + sum(-d, 0) + sum(0, d) + sum(0, -d) - 4 * sum(0, 0)) / (d * d);
            CHECK(std::abs(laplacian) <= 1e-3);
        }
}

TEST_CASE("the rim of a disk between two loads is free") {
    const double R = 0.2, P = 237.5;
    for (int n = 1; n < 40; ++n) {
        if (n == 20) continue;
        const double angle = 2 * pi * n / 40 + 0.5 * pi, c = std::cos(angle), s = std::sin(angle);
        const Stress at = mpm::disk_stress(P, R, R * c, R * s);
        CHECK(std::abs(at.xx * c + at.xy * s) <= 1e-11 * P / R);
        CHECK(std::abs(at.xy * c + at.yy * s) <= 1e-11 * P / R);
    }
}

TEST_CASE("a load is carried across every horizontal chord and nothing across a vertical one") {
    const double R = 0.2, P = 237.5;
    for (const double at : {-0.15, -0.05, 0.01, 0.1}) {
        const double half = std::sqrt(R * R - at * at);
        const auto on_row = [&](double x) { return mpm::disk_stress(P, R, x, at); };
        const auto on_column = [&](double y) { return mpm::disk_stress(P, R, at, y); };
        CHECK(std::abs(integral([&](double x) { return on_row(x).yy; }, -half, half) / P + 1) <=
              1e-11);
        CHECK(std::abs(integral([&](double x) { return on_row(x).xy; }, -half, half)) <= 1e-11 * P);
        CHECK(std::abs(integral([&](double y) { return on_column(y).xx; }, -half, half)) <=
              1e-9 * P);
        CHECK(std::abs(integral([&](double y) { return on_column(y).xy; }, -half, half)) <=
              1e-11 * P);
    }
}

TEST_CASE("the center of a loaded disk has tension P by pi R and three times that compression") {
    const Stress s = mpm::disk_stress(237.5, 0.2, 0, 0, 0.3);
    const double unit = 237.5 / (pi * 0.2);
    CHECK(std::abs(s.xx / unit - 1) <= 1e-14);
    CHECK(std::abs(s.yy / unit + 3) <= 1e-14);
    CHECK(s.xy == 0);
    CHECK(std::abs(s.zz / unit + 0.6) <= 1e-14);
    CHECK(std::abs(mpm::principal_stress_difference(s) / mpm::disk_center_difference(237.5, 0.2) -
                   1) <= 1e-14);
    CHECK(std::abs(mpm::disk_center_difference(237.5, 0.2) - 1511.97) <= 0.01);
}

TEST_CASE("the approach of two disks is the strain that Hertz leaves on the line of centers") {
    // Toward the contact Hertz's pressure on a half plane, from the far side a line load.
    const Disk disk{1, 1, 1, 0.3};
    const double to_strain = (1 - disk.nu * disk.nu) / disk.E, side = disk.nu / (1 - disk.nu);
    for (const double P : {1e-6, 1e-5, 1e-4}) {
        const double b = mpm::contact_half_width(disk, P);
        const auto strain = [&](double z) {
            const double root = std::sqrt(b * b + z * z);
            const double across =
                P / pi * (1 - 2 * (b * b + 2 * z * z) / (b * b * root) + 4 * z / (b * b));
            const double along = P / pi * (1 - 2 / (2 - z) - 2 / root);
            return to_strain * (along - side * across);
        };
        const double near = integral(strain, 0, 50 * b), far = integral(strain, 50 * b, 1);
        // What is left is of the order of b squared.
        CHECK(std::abs(mpm::contact_approach(disk, P) / (-2 * (near + far)) - 1) <= 0.2 * b * b);
    }
}

TEST_CASE("Hertz pressure on the contact width presses a flat between two round bodies") {
    // The peak pressure 2P / (pi b) and b are joined by curvature: b = 2 p R_pair / E_pair.
    const double P = 100, b = mpm::contact_half_width(colliding, P);
    const double p = 2 * P / (pi * b);
    CHECK(std::abs(2 * p * 0.5 * colliding.R / colliding.E_pair() / b - 1) <= 1e-14);
}

TEST_CASE("the work of a contact is the integral of its force") {
    for (const double P : {1.0, 30.0, 100.0}) {
        const double dP = 1e-4 * P;
        const double work =
            mpm::contact_energy(colliding, P + dP) - mpm::contact_energy(colliding, P - dP);
        const double path =
            mpm::contact_approach(colliding, P + dP) - mpm::contact_approach(colliding, P - dP);
        CHECK(std::abs(work / path / P - 1) <= 1e-7);
    }
    CHECK(mpm::contact_energy(colliding, 0) == 0);
    CHECK(mpm::contact_approach(colliding, 0) == 0);
}

TEST_CASE("an impact integrated in time has the duration and the force of the quadrature") {
    const mpm::Impact impact = mpm::quasi_static_impact(colliding, 0.1);
    const Collision collision = collide_with_gsl(0.1);
    CHECK(std::abs(impact.duration / collision.duration - 1) <= 2e-6);
    CHECK(std::abs(impact.peak_force / collision.peak_force - 1) <= 2e-6);
    // It ends a part of a step later.
    CHECK(std::abs(collision.rebound / 0.2 - 1) <= 1e-6);
    CHECK(std::abs(collision.impulse / (2 * colliding.mass() * 0.1) - 1) <= 1e-6);
    CHECK(std::abs(impact.duration - 0.416) <= 5e-4);
    CHECK(std::abs(impact.peak_force - 103) <= 0.1);
    CHECK(std::abs(impact.peak_half_width / colliding.R - 0.244) <= 5e-4);
}

TEST_CASE("impacts of disks are alike at the same speed in units of the sound speed") {
    Disk harder = colliding;
    harder.E = 1e6;
    const mpm::Impact soft = mpm::quasi_static_impact(colliding, 0.1),
                      hard = mpm::quasi_static_impact(harder, 1);
    CHECK(std::abs(hard.duration / soft.duration - 0.1) <= 1e-9);
    CHECK(std::abs(hard.peak_force / soft.peak_force - 100) <= 1e-7);
    CHECK(std::abs(hard.peak_approach / soft.peak_approach - 1) <= 1e-9);
}

// None, weak, nearly critical, and so strong that nothing swings; omega of the lowest mode is 0.51.
const double dampings[] = {0, 0.05, 0.9, 1.1, 20};

TEST_CASE("a fixed and free bar obeys the wave equation with damping") {
    for (const int mode : {1, 2, 3})
        for (const double c : dampings) {
            const mpm::Bar bar{25, 1.5, 100, mode, 0.1, c};
            const double d = 1e-4, scale = std::sqrt(bar.modulus * bar.density) * bar.speed,
                         off = 1e-9 * (1 + c * c * c);  // third derivative
            for (const double x : {2.0, 11.0, 23.0})
                for (const double t : {0.3, 2.0, 6.1}) {
                    const double push =
                        mpm::bar_stress(bar, x + d, t) - mpm::bar_stress(bar, x - d, t);
                    const double gain =
                        mpm::bar_velocity(bar, x, t + d) - mpm::bar_velocity(bar, x, t - d);
                    const double drag = 2 * d * c * mpm::bar_velocity(bar, x, t);
                    CHECK(std::abs(push - bar.density * (gain + drag)) <= off * scale);
                    const double rise =
                        mpm::bar_stress(bar, x, t + d) - mpm::bar_stress(bar, x, t - d);
                    const double stretch =
                        mpm::bar_velocity(bar, x + d, t) - mpm::bar_velocity(bar, x - d, t);
                    CHECK(std::abs(rise - bar.modulus * stretch) <= off * scale);
                }
            CHECK(mpm::bar_velocity(bar, 0, 1) == 0);
            CHECK(std::abs(mpm::bar_stress(bar, 25, 1)) <= 1e-14 * scale);
            CHECK(std::abs(mpm::bar_stress(bar, 3, 0)) <= 1e-14 * scale);
            CHECK(std::abs(mpm::bar_velocity(bar, 25, 0) / (mode == 2 ? -0.1 : 0.1) - 1) <= 1e-13);
        }
}

TEST_CASE("the bar of the literature has a period of ten") {
    mpm::Bar bar{25, 1, 100, 1, 0.1};
    CHECK(std::abs(2 * pi / bar.frequency() - 10) <= 1e-14);
    bar.mode = 2;
    CHECK(std::abs(bar.frequency() - 1.884956) <= 1e-6);
}

TEST_CASE("what swings turns where it stands still and critically damped as its neighbors") {
    for (const double gamma : {0.0, 0.3, 2.9999, 3.0, 3.0001, 40.0}) {
        const mpm::Swing swing{3, gamma};
        const double turn = swing.first_turn();
        CHECK(std::abs(swing.rate(turn)) <= 1e-8 * swing.omega);
        for (int n = 0; n < 50; ++n) CHECK(swing.rate(turn * n / 50) > 0);
        if (gamma < 3) CHECK(std::abs(swing.rate(turn + pi / std::abs(swing.s()))) <= 1e-8);
    }
    const mpm::Swing critical{3, 3}, near{3, 3 * (1 + 1e-9)};
    for (const double t : {0.1, 1.0, 3.0}) {
        CHECK(std::abs(critical.at(t) - near.at(t)) <= 1e-7);
        CHECK(std::abs(critical.rate(t) - near.rate(t)) <= 1e-7);
    }
    CHECK(std::isfinite(mpm::Swing{3, 1e6}.at(1e3)));
}

TEST_CASE("a joint breaks at the first moment of its strength") {
    for (const double c : dampings)
        for (const int mode : {1, 2})
            for (const double speed : {0.1, -0.1})
                for (const double x : {5.0, 15.0, 20.0}) {
                    const mpm::Bar bar{25, 1, 100, mode, speed, c};
                    double most = 0;
                    for (int n = 0; n < 4000; ++n)
                        most = std::max(most, mpm::bar_stress(bar, x, 0.01 * n));
                    if (most == 0) continue;
                    const double N = 0.7 * most, t = mpm::bar_breaking_time(bar, x, N);
                    REQUIRE(std::isfinite(t));
                    CHECK(std::abs(mpm::bar_stress(bar, x, t) - N) <= 1e-14);
                    for (int n = 0; n < 100; ++n) CHECK(mpm::bar_stress(bar, x, t * n / 100) < N);
                    CHECK(std::isinf(mpm::bar_breaking_time(bar, x, 1.001 * most)));
                }
}

TEST_CASE("a standing wave between rollers obeys the equations of elasticity and damping") {
    for (const auto& [beta, c] :
         {std::pair(0.0, 0.0), {0.02, 0.0}, {0.2, 0.0}, {0.0, 5.0}, {0.01, 35.0}}) {
        const mpm::StandingWave wave{1.5, 1e-4, 1000, {5769.0, 3846.0, 8333.0}, 2, beta, c};
        const double d = 1e-4, s_scale = 1e-4 * wave.wave_number() * 13461, w = wave.frequency(),
                     fastest = w + beta * w * w + c,
                     off = d * d / 6 * 1e-4 * fastest * fastest * fastest;  // third derivative
        for (const double x : {0.1, 0.6, 1.3})
            for (const double t : {0.02, 0.2, 0.33}) {
                const auto u = [&](double dx, double dt) {
                    return mpm::wave_displacement(wave, x + dx, t + dt);
                };
                CHECK(std::abs((u(0, d) - u(0, -d)) / (2 * d) - mpm::wave_velocity(wave, x, t)) <=
                      off);
                const double strain = (u(d, 0) - u(-d, 0)) / (2 * d);
                const Stress s = mpm::wave_stress(wave, x, t);
                CHECK(std::abs(s.xx - 13461 * strain) <= 1e-6 * s_scale);
                CHECK(std::abs(s.yy - 5769 * strain) <= 1e-6 * s_scale);
                CHECK(s.zz == s.yy);
                CHECK(s.xy == 0);
                const auto all = [&](double at) {  // s_xx + beta ds_xx/dt
                    const auto elastic = [&](double time) {
                        return mpm::wave_stress(wave, at, time).xx;
                    };
                    return elastic(t) + beta * (elastic(t + d) - elastic(t - d)) / (2 * d);
                };
                const double gain =
                    mpm::wave_velocity(wave, x, t + d) - mpm::wave_velocity(wave, x, t - d);
                const double drag = 2 * d * c * mpm::wave_velocity(wave, x, t);
                CHECK(std::abs(all(x + d) - all(x - d) - 1000 * (gain + drag)) / (2 * d) <=
                      1e-5 * s_scale);
            }
        CHECK(std::abs(mpm::wave_velocity(wave, 1.5, 0.1)) <= 1e-15);
        CHECK(mpm::wave_displacement(wave, 0.3, 0) == 0);
        CHECK(mpm::wave_velocity(wave, 0.3, 0) ==
              facts::about(1e-4 * wave.frequency() * std::sin(0.3 * wave.wave_number())));
    }
}

TEST_CASE("a block slides on an incline or sticks to it") {
    const double degree = pi / 180;
    CHECK(std::abs(mpm::block_acceleration(10, 30 * degree, 0.3) - 2.4019) <= 1e-4);
    CHECK(std::abs(mpm::block_acceleration(10, 60 * degree, 0.3) - 7.1603) <= 1e-4);
    CHECK(std::abs(mpm::block_acceleration(10, 60 * degree, 0.6) - 5.6603) <= 1e-4);
    CHECK(mpm::block_acceleration(10, 30 * degree, 0.6) == 0);
    CHECK(std::abs(mpm::block_acceleration(10, 30 * degree, 0) - 5) <= 1e-14);
    CHECK(mpm::block_acceleration(10, std::atan(0.5) - 1e-9, 0.5) == 0);
    CHECK(mpm::block_acceleration(10, std::atan(0.5) + 1e-9, 0.5) > 0);
}

TEST_CASE("a cylinder rolls as far as friction can turn it") {
    // The friction F turns it: m R^2 / 2 (a / R) = F R, and F is at most mu m g cos.
    const double mu = 0.3, g = 10;
    for (const double angle : {0.1, 0.5, 0.7, 0.75, 1.0, 1.5}) {
        const double a = mpm::cylinder_acceleration(g, angle, mu);
        const double friction = g * std::sin(angle) - a, limit = mu * g * std::cos(angle);
        CHECK(friction <= limit * (1 + 1e-14));
        const double spin = 2 * friction;
        CHECK(spin <= a * (1 + 1e-14));
        CHECK((std::abs(spin / a - 1) <= 1e-14 || std::abs(friction / limit - 1) <= 1e-14));
    }
    const double between = std::atan(3 * mu);
    CHECK(std::abs(mpm::cylinder_acceleration(g, between - 1e-9, mu) -
                   mpm::cylinder_acceleration(g, between + 1e-9, mu)) <= 1e-7);
}

TEST_CASE("leapfrog oscillates at its own frequency") {
    const double w = 3, dt = 0.5, shifted = mpm::leapfrog_frequency(w, dt);
    CHECK(shifted > w);
    CHECK(std::isnan(mpm::leapfrog_frequency(w, 0.7)));
    mpm::LeapfrogState s{std::cos(-0.5 * shifted * dt), 0, std::cos(0.5 * shifted * dt)};
    for (int n = 1; n <= 1000; ++n) {
        s = mpm::leapfrog_step(s, w, dt);
        CHECK(std::abs(s.x_after - std::cos(shifted * (n + 0.5) * dt)) <= 1e-11);
    }
}

TEST_CASE("leapfrog grows beyond two radians per step and not below") {
    CHECK(mpm::leapfrog_growth(1, 2) == 0);
    for (const double dt : {2.0001, 2.1, 3.0}) {
        const double rate = mpm::leapfrog_growth(1, dt);
        mpm::LeapfrogState s{0.3, 1, 0.2};
        for (int n = 0; n < 1000 && std::abs(s.v) < 1e200; ++n) s = mpm::leapfrog_step(s, 1, dt);
        const double before = s.v;
        s = mpm::leapfrog_step(s, 1, dt);
        CHECK(std::abs(s.v / before / -std::exp(rate * dt) - 1) <= 1e-9);
    }
}

TEST_CASE("both energies of leapfrog are constant whether it is stable or not") {
    for (const double dt : {0.1, 1.5, 1.99, 2.3}) {
        mpm::LeapfrogState s{0.3, 1, 0.3 + dt};
        const double E14 = mpm::leapfrog_energy_14(s, 1), E15 = mpm::leapfrog_energy_15(s, 1, dt);
        for (int n = 0; n < 20; ++n) {
            s = mpm::leapfrog_step(s, 1, dt);
            const double size = 1 + s.v * s.v;
            CHECK(std::abs(mpm::leapfrog_energy_14(s, 1) - E14) <= 1e-13 * size);
            CHECK(std::abs(mpm::leapfrog_energy_15(s, 1, dt) - E15) <= 1e-13 * size);
        }
    }
}

TEST_CASE("the energies of leapfrog are positive for every state only below two radians per step") {
    for (const double dt : {0.5, 1.9, 2.1}) {
        bool all_positive_14 = true, all_positive_15 = true;
        for (int n = 0; n < 360; ++n) {
            const double x = std::cos(n * pi / 180), v = std::sin(n * pi / 180);
            const mpm::LeapfrogState around{x - 0.5 * dt * v, v, x + 0.5 * dt * v};
            if (!(mpm::leapfrog_energy_14(around, 1) > 0)) all_positive_14 = false;
            const mpm::LeapfrogState before{0, v + 0.5 * dt * x, x};
            if (!(mpm::leapfrog_energy_15(before, 1, dt) > 0)) all_positive_15 = false;
        }
        CHECK(all_positive_14 == (dt < 2));
        CHECK(all_positive_15 == (dt < 2));
    }
}

TEST_CASE("the energy of a leapfrog oscillator comes up to its bound and not beyond") {
    const double dt = 1.7;
    mpm::LeapfrogState s{0.3, 1, 0.3 + dt};
    const double bound = mpm::leapfrog_energy_bound(mpm::leapfrog_energy_14(s, 1), 1, dt);
    double largest = 0;
    for (int n = 0; n < 20000; ++n) {
        s = mpm::leapfrog_step(s, 1, dt);
        const double x = 0.5 * (s.x_before + s.x_after);
        largest = std::max(largest, 0.5 * (s.v * s.v + x * x));
    }
    CHECK(largest <= bound * (1 + 1e-11));
    CHECK(largest >= bound * (1 - 1e-6));
    CHECK(std::isinf(mpm::leapfrog_energy_bound(1, 1, 2)));
}

TEST_CASE("the node between two cells oscillates as its theory says") {
    // FLIP in the plane: 2 x 1 cells, ends fixed, sliding along y; particles stay in place.
    const double h = 0.7, rho = 3, lambda = 5, G = 2, c = std::sqrt((lambda + 2 * G) / rho);
    for (const auto& [per_side, keeps] : {std::pair(1, 1.0),
                                          {2, 1.0},
                                          {3, 1.0},
                                          {4, 1.0},
                                          {1, 0.7},
                                          {2, 0.99},
                                          {3, 0.5},
                                          {4, 0.01}}) {
        const double w = mpm::node_oscillator_frequency(per_side) * c / h, dt = 0.8 / w;
        struct Point {
            double S[2], G_x[2], G_y[2], v = 0, sxx = 0, syy = 0;
        };
        std::vector<Point> points;
        const double V = h * h / (per_side * per_side);
        double m[2] = {0, 0};
        for (int a = 0; a < 2 * per_side; ++a)
            for (int b = 0; b < per_side; ++b) {
                const double x = (a + 0.5) / per_side, y = (b + 0.5) / per_side;
                const double S_x = x < 1 ? x : 2 - x, G_x = (x < 1 ? 1 : -1) / h;
                points.push_back(
                    {{S_x * (1 - y), S_x * y}, {G_x * (1 - y), G_x * y}, {-S_x / h, S_x / h}, S_x});
                for (int i = 0; i < 2; ++i) m[i] += rho * V * points.back().S[i];
            }
        std::vector<double> history;
        for (int n = 0; n < 40; ++n) {
            double v[2] = {0, 0}, f[2] = {0, 0};
            for (const Point& p : points)
                for (int i = 0; i < 2; ++i) v[i] += rho * V * p.S[i] * p.v / m[i];
            for (Point& p : points) {
                const double rate = p.G_x[0] * v[0] + p.G_x[1] * v[1];
                p.sxx += dt * (lambda + 2 * G) * rate;
                for (int i = 0; i < 2; ++i) f[i] -= V * p.G_x[i] * p.sxx;
            }
            for (Point& p : points)
                for (int i = 0; i < 2; ++i)
                    p.v += p.S[i] * (keeps * v[i] + dt * f[i] / m[i] - v[i]);
            history.push_back(v[0]);
        }
        for (std::size_t n = 1; n + 1 < history.size(); ++n) {
            // Both factors of a step: g and its conjugate, or the real one that lasts and d/g.
            const std::complex<double> g =
                mpm::leapfrog_factor(w * dt, keeps, mpm::node_filter(per_side));
            const double d = 1 - mpm::node_filter(per_side) * (1 - keeps),
                         both = std::imag(g) > 0 ? 2 * std::real(g) : std::real(g + d / g);
            CHECK(std::abs(history[n + 1] + d * history[n - 1] - both * history[n]) <= 1e-13);
            if (std::imag(g) > 0) CHECK(std::abs(std::norm(g) - d) <= 1e-14);
            if (keeps == 1)
                CHECK(std::abs(std::arg(g) - mpm::leapfrog_frequency(w, dt) * dt) <= 1e-14);
        }
    }
    CHECK(mpm::node_oscillator_frequency(1) == 1);
    CHECK(std::abs(mpm::node_oscillator_frequency(1000) - std::sqrt(4.0 / 3)) <= 1e-6);
}

TEST_CASE("the node between two cells follows the theta scheme as its theory says") {
    // The line of particles of two cells, in full: their velocities and stresses, and one free
    // node.
    const double h = 0.7, rho = 3, P = 9;
    int turns = 0, creeps = 0;
    for (const bool consistent : {true, false})
        for (const int per_side : {1, 2, 3, 4})
            for (const double theta : {0.5, 0.6, 0.75, 1.0})
                for (const auto& [alpha, keeps] : {std::pair(0.1, 1.0),
                                                   {1.0, 1.0},
                                                   {3.0, 1.0},
                                                   {30.0, 1.0},
                                                   {0.1, 0.99},
                                                   {1.0, 0.5}}) {
                    const double dt = alpha * h / std::sqrt(P / rho);
                    struct Point {
                        double S, G, v, s = 0;
                    };
                    std::vector<Point> points;
                    const double V = h / per_side;
                    double m = 0, M = 0;
                    for (int a = 0; a < 2 * per_side; ++a) {
                        const double x = (a + 0.5) / per_side, S = x < 1 ? x : 2 - x;
                        points.push_back({S, (x < 1 ? 1 : -1) / h, 1 + x});
                        m += rho * V * S, M += rho * V * S * S;
                    }
                    CHECK(std::abs(M / m - mpm::node_filter(per_side)) <= 1e-14);
                    std::vector<double> changes;
                    for (int n = 0; n < 30; ++n) {
                        double p = 0, f = 0, K = 0;
                        for (const Point& point : points) {
                            p += rho * V * point.S * point.v, f -= V * point.G * point.s;
                            K += V * point.G * point.G * P;
                        }
                        const double mass = consistent ? M : m, v_0 = p / mass;
                        const double v_theta =
                            (mass * v_0 + theta * dt * f) / (mass + theta * theta * dt * dt * K);
                        for (Point& point : points) {
                            point.v = keeps * (point.v + point.S * (v_theta - v_0) / theta);
                            point.s += dt * P * point.G * v_theta;
                        }
                        changes.push_back((v_theta - v_0) / theta);
                    }
                    const double f = consistent ? 1 : M / m,
                                 w = std::sqrt(2 * P / h / (consistent ? M : m));
                    const std::complex<double> g =
                        mpm::theta_node_oscillation(theta, w * dt, f, keeps);
                    CHECK(std::abs(g) <= 1 + 1e-15);
                    if (std::imag(g) != 0) {
                        // Both factors, g and its conjugate.
                        ++turns;
                        for (std::size_t n = 1; n + 1 < changes.size(); ++n) {
                            const double size = std::abs(changes[n - 1]) + std::abs(changes[n]);
                            CHECK(std::abs(changes[n + 1] - 2 * std::real(g) * changes[n] +
                                           std::norm(g) * changes[n - 1]) <=
                                  1e-12 * size + 1e-13 * std::abs(changes[0]));
                        }
                    } else {
                        // The larger of two real ones, g and d/g: changes obey
                        //     c_(n+1) = (g + d/g) c_n - d c_(n-1)
                        ++creeps;
                        const auto& c = changes;
                        const double left = c[1] * c[1] - c[0] * c[2],
                                     d = (c[2] * c[2] - c[1] * c[3]) / left,
                                     sum = (c[1] * c[2] - c[0] * c[3]) / left;
                        CHECK(std::abs(d / std::real(g)) <= std::abs(g));
                        CHECK(std::abs(std::real(g) + d / std::real(g) - sum) <= 1e-9);
                    }
                }
    CHECK(turns >= 90);
    CHECK(creeps >= 10);
}

TEST_CASE("the theta scheme of one node has its own limits") {
    for (const double z : {0.01, 0.5, 2.0, 10.0, 300.0}) {
        for (const double theta : {0.5, 0.6, 1.0}) {
            // A consistent mass filters nothing: the factor of a light wave.
            const std::complex<double> g = mpm::theta_node_oscillation(theta, z, 1);
            CHECK(std::abs(g - implicit_moment::theta_light_wave(theta, z)) <= 1e-15);
            // The closed form of its size, and nothing grows.
            for (const double f : {0.5, 0.625, 0.9}) {
                const double D = 1 + theta * theta * z * z;
                const std::complex<double> lumped = mpm::theta_node_oscillation(theta, z, f);
                CHECK(std::abs(lumped) < 1);
                if (std::imag(lumped) > 0)
                    CHECK(std::abs(std::norm(lumped) -
                                   (1 - (theta - f * (1 - theta)) * z * z / D)) <= 1e-15);
                CHECK((std::imag(lumped) > 0) == (theta * z < 2 * std::sqrt(f) / (1 - f)));
            }
        }
        // theta = 1/2 turns and keeps its size: tan(omega dt / 2) = z / 2.
        const std::complex<double> g = mpm::theta_node_oscillation(0.5, z, 1);
        CHECK(std::abs(std::abs(g) - 1) <= 1e-15);
        CHECK(std::abs(std::tan(0.5 * std::arg(g)) - 0.5 * z) <= 1e-11 * (1 + z * z));
    }
    // w^2 = (k / m) (M_11 / m) is that of leapfrog, where steps are short.
    const double z = 1e-5, f = mpm::node_filter(2);
    CHECK(std::abs(std::arg(mpm::theta_node_oscillation(0.5, z * std::sqrt(2.0), f)) / z /
                       mpm::node_oscillator_frequency(2) -
                   1) <= 1e-9);
}

TEST_CASE("the force on a block that is pressed much is the sum of its small steps") {
    // Increments of the law in the frame of the moment, with the force V sigma / l on the plate.
    for (const bool changes : {true, false})
        for (const double across : {0.0, 0.3 / 0.7}) {
            const double M = 7;
            double l = 1, s = 0, V = 1;
            for (int n = 0; n < 100000; ++n) {
                const double dl = 1e-6, de = dl / (l - 0.5 * dl);
                s += M * de, l -= dl;
                if (changes) V *= 1 - de * (1 - across);
            }
            CHECK(std::abs(mpm::pressed_stress(M, across, changes, 0.1) / (V * s / l) - 1) <= 1e-5);
            CHECK(std::abs(mpm::pressed_stress(M, across, changes, 1e-6) / (M * 1e-6) - 1) <= 2e-6);
        }
}

TEST_CASE("a pressed block has the stress of plane strain") {
    // Elastic, with the law of the programs: free along x, held along z.
    mpm::Material m;
    m.E = 7, m.nu = 0.3;
    const mpm::Moduli T = mpm::moduli(m);
    const double e_y = -0.01, e_x = -T.lambda / (T.lambda + 2 * T.G) * e_y,
                 s_y = (T.lambda + 2 * T.G) * e_y + T.lambda * e_x;
    CHECK(std::abs(s_y / e_y / mpm::plane_strain_modulus(7, 0.3) - 1) <= 1e-14);
    // Plastic: at the limit s_zz is halfway, where the von Mises stress is Y.
    const double s = mpm::plane_strain_strength(3);
    CHECK(std::abs(mpm::von_mises({0, -s, 0, -0.5 * s}) / 3 - 1) <= 1e-15);
    CHECK(mpm::von_mises({0, -s, 0, -0.4 * s}) > 3);
}

TEST_CASE("columns run out farther the taller they are and disks farther than sand") {
    for (double a = 0.1; a < 20; a += 0.05) {
        CHECK(mpm::runout_in_experiments(a + 0.05) > mpm::runout_in_experiments(a));
        CHECK(mpm::runout_of_disks(a + 0.05) > mpm::runout_of_disks(a));
        const double ratio = mpm::runout_of_disks(a) / mpm::runout_in_experiments(a);
        CHECK(ratio > 1.5);
        CHECK(ratio < 2.2);
    }
    CHECK(std::abs(mpm::runout_in_experiments(1) - 1.2) <= 1e-15);
    CHECK(std::abs(mpm::runout_in_experiments(8) - 7.6) <= 1e-14);
    CHECK(std::abs(mpm::runout_of_disks(1) - 2.5) <= 1e-15);
}

namespace {

struct Range {
    long begin, end;
    bool has_corners = false;
};

// Four particles per cell of the mesh, where they are less than R from (x, y).
Range add_disk(Particles& particles, const Mesh& mesh, double x, double y, double R,
               const Stress& s) {
    const long begin = particles.count();
    const double d = 0.5 * mesh.h;
    const auto first = [d](double low) { return std::lround(std::floor(low / d)); };
    for (long b = first(y - R - mesh.y_low); b <= first(y + R - mesh.y_low); ++b)
        for (long a = first(x - R - mesh.x_low); a <= first(x + R - mesh.x_low); ++a) {
            const double x_p = mesh.x_low + (real(a) + 0.5) * d,
                         y_p = mesh.y_low + (real(b) + 0.5) * d;
            if (!(std::hypot(x_p - x, y_p - y) < R)) continue;
            const auto p = static_cast<std::size_t>(particles.count());
            particles.resize(p + 1);
            particles.x_p[p] = x_p, particles.y_p[p] = y_p, particles.V_p[p] = d * d;
            particles.set_stress(p, s);
        }
    return {begin, particles.count()};
}

Mesh box(long cells_x, long cells_y, double h) {
    Mesh mesh;
    mesh.cells_x = cells_x, mesh.cells_y = cells_y, mesh.h = h;
    return mesh;
}

// 10 x 8 particles, 0.05 apart, with the lower left corner of the first at (x, y).
Particles block(double x, double y) {
    Particles particles;
    for (int b = 0; b < 8; ++b)
        for (int a = 0; a < 10; ++a) {
            particles.resize(particles.x_p.size() + 1);
            particles.x_p.back() = x + 0.05 * (a + 0.5);
            particles.y_p.back() = y + 0.05 * (b + 0.5);
            particles.V_p.back() = 0.05 * 0.05;
        }
    return particles;
}

double area_of(const FringeRaster& raster, int grain) {
    double pixels = 0;
    for (const int g : raster.grain) pixels += g == grain;
    return pixels * raster.x.step * raster.y.step;
}

}  // namespace

TEST_CASE("uniform stress has one fringe order all over its grain and none outside") {
    const Mesh mesh = box(20, 20, 0.05);
    Particles particles;
    const Stress s{3, -1, 1.5, 0.4};
    const std::vector<Range> grains{add_disk(particles, mesh, 0.51, 0.47, 0.4, s)};
    const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh, 7);
    CHECK(raster.x.count == 140);
    long inside = 0;
    for (std::size_t i = 0; i < raster.grain.size(); ++i) {
        CHECK((raster.grain[i] == 0 || raster.grain[i] == -1));
        if (raster.grain[i] == 0) {
            ++inside;
            CHECK(std::abs(raster.stress_difference[i] - 5) <= 1e-13);
            CHECK(std::abs(raster.pressure[i] + 0.8) <= 1e-13);
        } else {
            CHECK(std::isnan(raster.stress_difference[i]));
            CHECK(std::isnan(raster.pressure[i]));
        }
    }
    CHECK(inside > 9000);
}

TEST_CASE("linear stress is linear inside a grain") {
    const Mesh mesh = box(20, 20, 0.05);
    Particles particles;
    const std::vector<Range> grains{add_disk(particles, mesh, 0.5, 0.5, 0.4, {})};
    for (std::size_t p = 0; p < particles.x_p.size(); ++p)
        particles.set_stress(p, {2 + particles.x_p[p], -particles.y_p[p], 0, 0});
    const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh);
    for (long j = 0; j < raster.y.count; ++j)
        for (long i = 0; i < raster.x.count; ++i) {
            const double x = raster.x.at(i), y = raster.y.at(j);
            if (std::hypot(x - 0.5, y - 0.5) > 0.25) continue;
            CHECK(std::abs(raster.stress_difference[raster.pixel(i, j)] - (2 + x + y)) <= 1e-12);
        }
}

TEST_CASE("the pixels of a disk have its area and their outline is round") {
    const Mesh mesh = box(24, 24, 0.025);
    const double R = 0.2;
    for (const double x : {0.3, 0.3075, 0.3125})
        for (const double y : {0.3, 0.31, 0.30625}) {
            Particles particles;
            const std::vector<Range> grains{add_disk(particles, mesh, x, y, R, {1, 0, 0, 0})};
            const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh);
            const double particles_area = real(grains[0].end) * 0.0125 * 0.0125;
            CHECK(std::abs(area_of(raster, 0) / particles_area - 1) <= 1e-3);
            CHECK(std::abs(area_of(raster, 0) / (pi * R * R) - 1) <= 1.1e-2);
            // Particles are cut off at a lattice of half a cell; the outline stays closer.
            for (long j = 0; j < raster.y.count; ++j)
                for (long i = 0; i < raster.x.count; ++i) {
                    const double r = std::hypot(raster.x.at(i) - x, raster.y.at(j) - y);
                    const int g = raster.grain[raster.pixel(i, j)];
                    if (r < R - 0.3 * mesh.h) CHECK(g == 0);
                    if (r > R + 0.3 * mesh.h) CHECK(g == -1);
                }
        }
}

TEST_CASE("a block is drawn where it is wherever it lies on the mesh") {
    const Mesh mesh = box(12, 12, 0.1);
    for (double shift = 0; shift < 0.1; shift += 0.011) {
        const Particles particles = block(0.3 + shift, 0.4 - shift);
        const std::vector<Range> grains{{0, particles.count()}};
        const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh, 20);
        for (long i = 0; i < raster.x.count; ++i) {
            const double past_left = raster.x.at(i) - 0.3 - shift, past_right = past_left - 0.5;
            const int g = raster.grain[raster.pixel(i, std::lround((0.6 - shift) * 200))];
            if (past_left > 0.015 && past_right < -0.015) CHECK(g == 0);
            if (past_left < -0.015 || past_right > 0.015) CHECK(g == -1);
        }
        for (long j = 0; j < raster.y.count; ++j) {
            const double past_foot = raster.y.at(j) - 0.4 + shift, past_head = past_foot - 0.4;
            const int g = raster.grain[raster.pixel(std::lround((0.55 + shift) * 200), j)];
            if (past_foot > 0.015 && past_head < -0.015) CHECK(g == 0);
            if (past_foot < -0.015 || past_head > 0.015) CHECK(g == -1);
        }
    }
}

TEST_CASE("a block is drawn with its corners") {
    const Mesh mesh = box(12, 12, 0.1);
    for (double shift = 0; shift < 0.1; shift += 0.011) {
        const Particles particles = block(0.3 + shift, 0.4 - shift);
        const std::vector<Range> grains{{0, particles.count(), true}};
        const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh);
        // A pixel is 1/80 wide: none is missing that is more than two of them inside of the block.
        for (long j = 0; j < raster.y.count; ++j)
            for (long i = 0; i < raster.x.count; ++i) {
                const double depth = std::min(0.25 - std::fabs(raster.x.at(i) - 0.55 - shift),
                                              0.2 - std::fabs(raster.y.at(j) - 0.6 + shift));
                if (depth > 0.02) CHECK(raster.grain[raster.pixel(i, j)] == 0);
                if (depth < -0.01) CHECK(raster.grain[raster.pixel(i, j)] == -1);
            }
    }
}

TEST_CASE("nothing of a grain shows in the grain that it touches") {
    const Mesh mesh = box(40, 20, 0.025);
    Particles particles;
    const std::vector<Range> grains{add_disk(particles, mesh, 0.303, 0.25, 0.2, {1, 0, 0, 0}),
                                    add_disk(particles, mesh, 0.703, 0.25, 0.2, {1000, 0, 0, 0})};
    const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh);
    double gap = 1;
    for (std::size_t i = 0; i < raster.grain.size(); ++i) {
        if (raster.grain[i] == 0) CHECK(std::abs(raster.stress_difference[i] - 1) <= 1e-13);
        if (raster.grain[i] == 1) CHECK(std::abs(raster.stress_difference[i] - 1000) <= 1e-10);
    }
    for (long j = 0; j < raster.y.count; ++j)
        for (long i = 0; i + 1 < raster.x.count; ++i)
            if (raster.grain[raster.pixel(i, j)] == 0 && raster.grain[raster.pixel(i + 1, j)] != 0)
                for (long k = i + 1; k < raster.x.count; ++k)
                    if (raster.grain[raster.pixel(k, j)] == 1) {
                        gap = std::min(gap, real(k - i - 1) * raster.x.step);
                        break;
                    }
    CHECK(gap <= 0.3 * mesh.h);
    CHECK(std::abs(area_of(raster, 0) / area_of(raster, 1) - 1) <= 5e-3);
}

TEST_CASE("a pixel between overlapping grains shows the one that covers more of it") {
    const Mesh mesh = box(40, 20, 0.025);
    Particles particles;
    const std::vector<Range> grains{add_disk(particles, mesh, 0.4, 0.25, 0.2, {1, 0, 0, 0}),
                                    add_disk(particles, mesh, 0.6, 0.25, 0.2, {2, 0, 0, 0})};
    const std::vector<Range> turned{grains[1], grains[0]};
    const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh),
                       other = mpm::draw_fringes(particles, turned, mesh);
    // In the bulk both cover all of a pixel; at the rim of one the other wins.
    for (long j = 0; j < raster.y.count; ++j)
        for (long i = 0; i < raster.x.count; ++i) {
            const double dx = raster.x.at(i), dy = raster.y.at(j) - 0.25;
            const std::size_t pixel = raster.pixel(i, j);
            if (std::abs(std::hypot(dx - 0.4, dy) - 0.195) < 0.005 &&
                std::hypot(dx - 0.6, dy) < 0.15) {
                CHECK(raster.grain[pixel] == 1);
                CHECK(other.grain[pixel] == 0);
            }
        }
}

TEST_CASE("mirrored grains have a mirrored picture") {
    const Mesh mesh = box(24, 20, 0.03);
    Particles particles;
    const std::vector<Range> grains{add_disk(particles, mesh, 0.3, 0.31, 0.2, {}),
                                    add_disk(particles, mesh, 0.6, 0.2, 0.1, {})};
    for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
        const double x = particles.x_p[p], y = particles.y_p[p];
        particles.set_stress(p, {x * x, y, x * y, 0.3 * x});
    }
    Particles mirrored = particles;
    for (std::size_t p = 0; p < mirrored.x_p.size(); ++p) {
        mirrored.x_p[p] = mesh.x_low + mesh.x_high() - mirrored.x_p[p];
        mirrored.sxy_p[p] = -mirrored.sxy_p[p];
    }
    const FringeRaster one = mpm::draw_fringes(particles, grains, mesh),
                       two = mpm::draw_fringes(mirrored, grains, mesh);
    for (long j = 0; j < one.y.count; ++j)
        for (long i = 0; i < one.x.count; ++i) {
            const std::size_t here = one.pixel(i, j), there = one.pixel(one.x.count - 1 - i, j);
            CHECK(one.grain[here] == two.grain[there]);
            if (one.grain[here] < 0 || two.grain[there] < 0) continue;
            CHECK(std::abs(one.stress_difference[here] - two.stress_difference[there]) <= 1e-13);
            CHECK(std::abs(one.pressure[here] - two.pressure[there]) <= 1e-13);
        }
}

TEST_CASE("a grain across the seam of a periodic mesh is drawn on both sides") {
    Mesh mesh = box(32, 16, 0.03125);
    mesh.periodic_x = true;
    for (const double turns : {-3.0, -1.0, 0.0, 2.0}) {
        Particles seam, middle;
        const std::vector<Range> grains{add_disk(middle, mesh, 0.5, 0.25, 0.15, {2, 0, 1, 0})};
        const std::vector<Range> wrapped{add_disk(seam, mesh, 1 + turns, 0.25, 0.15, {2, 0, 1, 0})};
        REQUIRE(seam.count() == middle.count());
        const FringeRaster a = mpm::draw_fringes(middle, grains, mesh),
                           b = mpm::draw_fringes(seam, wrapped, mesh);
        CHECK(area_of(a, 0) > 0.065);
        for (long j = 0; j < a.y.count; ++j)
            for (long i = 0; i < a.x.count; ++i)
                CHECK(a.grain[a.pixel(i, j)] ==
                      b.grain[b.pixel((i + a.x.count / 2) % a.x.count, j)]);
    }
}

TEST_CASE("particles in every place of a loaded disk show the fringes of the closed form") {
    const Mesh mesh = box(48, 48, 0.0125);
    const double R = 0.2, P = 237.5;
    Particles particles;
    const std::vector<Range> grains{add_disk(particles, mesh, 0.3, 0.3, R, {})};
    for (std::size_t p = 0; p < particles.x_p.size(); ++p)
        particles.set_stress(
            p, mpm::disk_stress(P, R, particles.x_p[p] - 0.3, particles.y_p[p] - 0.3, 0.3));
    const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh);
    double largest = 0;
    for (long j = 0; j < raster.y.count; ++j)
        for (long i = 0; i < raster.x.count; ++i) {
            const double x = raster.x.at(i) - 0.3, y = raster.y.at(j) - 0.3;
            if (std::hypot(x, y) > 0.1) continue;
            const double exact = mpm::principal_stress_difference(mpm::disk_stress(P, R, x, y));
            const double drawn = raster.stress_difference[raster.pixel(i, j)];
            largest = facts::worst({largest, std::abs(drawn - exact) / exact});
        }
    CHECK(largest <= 0.02);
}

TEST_CASE("a file of fringes holds every pixel and is whole") {
    const Mesh mesh = box(8, 6, 0.1);
    Particles particles;
    const std::vector<Range> grains{add_disk(particles, mesh, 0.4, 0.3, 0.2, {3, -1, 1.5, 0.4})};
    const FringeRaster raster = mpm::draw_fringes(particles, grains, mesh, 7);
    const auto folder = std::filesystem::temp_directory_path() / "mpm_theory_fringes";
    std::filesystem::create_directories(folder);
    const common::Snapshot at{folder.string(), 12, 0.75};
    const std::string path = at.path("fringes", "dat");
    mpm::write_fringes(at, raster);
    CHECK(!std::filesystem::exists(path + ".partial"));

    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    CHECK(line == "x y stress_difference pressure grain");
    std::getline(file, line);
    CHECK(line == "# units: x length, y length, stress_difference stress, pressure stress");
    std::getline(file, line);
    CHECK(line == "# time 0.75 step 12");
    long rows = 0, empty = 0, inside = 0;
    while (std::getline(file, line)) {
        if (line.empty()) {
            ++empty;
            continue;
        }
        const std::size_t i = static_cast<std::size_t>(rows++);
        double x = 0, y = 0;
        char difference[32], pressure[32];
        int grain = 7;
        REQUIRE(std::sscanf(line.c_str(), "%lf %lf %31s %31s %d", &x, &y, difference, pressure,
                            &grain) == 5);
        CHECK(std::abs(x - raster.x.at(static_cast<long>(i) % 56)) <= 1e-9);
        CHECK(std::abs(y - raster.y.at(static_cast<long>(i) / 56)) <= 1e-9);
        CHECK(grain == raster.grain[i]);
        if (grain < 0) CHECK(std::string(difference) == "NaN");
        if (grain < 0) CHECK(std::string(pressure) == "NaN");
        if (grain < 0) continue;
        ++inside;
        CHECK(std::abs(std::stod(difference) - 5) <= 1e-5);
        CHECK(std::abs(std::stod(pressure) + 0.8) <= 1e-6);
    }
    CHECK(rows == 56 * 42);
    CHECK(empty == 42);
    CHECK(inside > 500);
    std::filesystem::remove_all(folder);
}
