// Facts about the plasma dispersion function, and about the roots of kinetic dispersion relations
// against published tables, exact solutions and limits.
#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"
#include "common/theory/plasma_dispersion.hpp"
#include "implicit_moment/theory/theta_light_wave.hpp"
#include "implicit_moment/theory/transverse_dispersion.hpp"
#include "tests/support/longitudinal_wave.hpp"

namespace {

using common::Complex;
using common::plasma_dispersion;
using common::PlasmaSpecies;

const double pi = std::numbers::pi;
const double root_pi = std::sqrt(pi);
const Complex i(0.0, 1.0);

// A species of plasma frequency `frequency`, with charge -1 and mass 1.
PlasmaSpecies electrons(double frequency) {
    return {frequency * frequency / (4.0 * pi), -1.0, 1.0, 0.0, 0.0, 0.0, 0.0};
}

// Points of the plane on circles of many radii, off the axes.
std::vector<Complex> points() {
    std::vector<Complex> all;
    for (const double radius : {1e-3, 0.1, 0.5, 1.0, 2.0, 3.3, 5.0, 6.9, 7.1, 9.0})
        for (int n = 0; n < 16; ++n) all.push_back(std::polar(radius, (n + 0.3) * pi / 8.0));
    return all;
}

double distance(Complex a, Complex b) { return std::abs(a - b) / std::abs(b); }

// Electrons and ions with omega_pi = Omega_ci c/v_A in units of Omega_ci and d_i, c = c/v_A.
std::vector<PlasmaSpecies> cold_magnetized(double c_over_v_A, double mass_ratio) {
    PlasmaSpecies ions{c_over_v_A * c_over_v_A / (4.0 * pi), 1.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    PlasmaSpecies light = ions;
    light.charge = -1.0;
    light.mass = 1.0 / mass_ratio;
    light.gyrofrequency = -mass_ratio;
    return {ions, light};
}

// The fastest growing (or least damped) transverse wave of wave number k.
common::DispersionRoot fastest_growing_transverse(std::span<const PlasmaSpecies> plasma, double k,
                                                  double light, int sense) {
    const auto D = [&](Complex omega) {
        return implicit_moment::transverse_dispersion(plasma, k, light, sense, omega);
    };
    return common::fastest_growing_root(D, common::fan_of_guesses(plasma, k, light));
}

}  // namespace

TEST_CASE("Z has its known values at the origin and on the imaginary axis") {
    CHECK(std::abs(plasma_dispersion(0.0) - i * root_pi) <= 1e-14);
    for (const double y : {0.1, 0.5, 1.0, 2.0, 5.0}) {
        const Complex exact = i * root_pi * std::exp(y * y) * std::erfc(y);
        CHECK(distance(plasma_dispersion(i * y), exact) <= 1e-13);
        const Complex below = i * root_pi * std::exp(y * y) * std::erfc(-y);
        CHECK(distance(plasma_dispersion(-i * y), below) <= 1e-13);
    }
}

TEST_CASE("Z agrees with tabulated values") {
    // Computed with forty digits from i pi^1/2 exp(-zeta^2) erfc(-i zeta).
    const struct {
        Complex zeta, Z;
    } table[] = {
        {{0.1, 0.0}, {-0.19867198479570573, 1.7548176404170788}},
        {{1.0, 0.0}, {-1.0761590138255368, 0.65204933217329218}},
        {{2.5, 0.0}, {-0.44616744433487096, 0.0034216408677532849}},
        {{5.0, 0.0}, {-0.20426814884855367, 2.4615739584615114e-11}},
        {{8.0, 0.0}, {-0.12600039741510678, 2.8426807890771382e-28}},
        {{1.0, 1.0}, {-0.36905845884906658, 0.54014504014875573}},
        {{-0.5, 0.2}, {0.62169046000513388, 1.1755314958059677}},
        {{3.0, 0.01}, {-0.35652282212539324, 0.0016108604859852961}},
        {{4.0, 2.0}, {-0.2006595999390787, 0.10579232823676131}},
        {{0.3, 6.0}, {-0.0079898717668043595, 0.16405788810649631}},
        {{7.5, 0.001}, {-0.13455162078326453, 1.8274348991834283e-5}},
        {{1.0, -0.5}, {-2.0167639548158606, 0.27568949691742256}},
        {{-2.0, -1.0}, {0.26029456996831756, -0.36393011610645513}},
        {{1.5, -2.0}, {5.4884957195202156, 19.262075296109638}},
        {{0.2, -3.0}, {-25722.782142515625, 10000.168546858004}},
        {{6.0, -0.3}, {-0.16863112119108403, -0.0086831963210209386}},
        {{-4.0, -5.0}, {21403.236380409201, -19157.708202211299}},
    };
    for (const auto& row : table) CHECK(distance(plasma_dispersion(row.zeta), row.Z) <= 1e-12);
}

TEST_CASE("the imaginary part of Z on the real axis is the Maxwellian") {
    for (const double x : {-3.0, -1.0, -0.25, 0.0, 0.125, 0.7, 1.0, 2.0, 3.0})
        CHECK(std::abs(plasma_dispersion(x).imag() - root_pi * std::exp(-x * x)) <= 1e-14);
}

TEST_CASE("Z obeys its differential equation in the whole plane") {
    const double h = 1e-3;
    for (const Complex zeta : points()) {
        const auto slope = [&](Complex step) {
            return (plasma_dispersion(zeta + step) - plasma_dispersion(zeta - step)) / (2.0 * step);
        };
        const Complex numerical = (4.0 * slope(h) - slope(2.0 * h)) / 3.0;
        const Complex exact = -2.0 * (1.0 + zeta * plasma_dispersion(zeta));
        const double scale = std::abs(exact) + std::abs(plasma_dispersion(zeta));
        CHECK(std::abs(numerical - exact) <= 3e-8 * scale);
        CHECK(std::abs(-2.0 * common::plasma_response(zeta) - exact) <= 1e-12 * scale);
    }
}

TEST_CASE("Z is antisymmetric under reflection at the imaginary axis") {
    for (const Complex zeta : points())
        CHECK(distance(plasma_dispersion(-std::conj(zeta)), -std::conj(plasma_dispersion(zeta))) <=
              1e-14);
}

TEST_CASE("Z above and below the real axis are joined by the pole term") {
    for (const Complex zeta : points()) {
        const Complex pole = 2.0 * i * root_pi * std::exp(-zeta * zeta);
        const Complex sum = plasma_dispersion(zeta) + plasma_dispersion(-zeta);
        CHECK(std::abs(sum - pole) <= 1e-12 * (std::abs(pole) + std::abs(plasma_dispersion(zeta))));
    }
}

TEST_CASE("the response of a Maxwellian has no cancellation at large argument") {
    for (const double x : {1e2, 1e4, 1e6}) {
        const double exact = -0.5 / (x * x) * (1.0 + 1.5 / (x * x));
        CHECK(distance(common::plasma_response(x), exact) <= 1e-7);
        CHECK(distance(common::plasma_response(i * x), -exact * (1.0 - 3.0 / (x * x))) <= 1e-7);
    }
}

TEST_CASE("Landau damping has the published frequencies and rates") {
    const double table[][3] = {{0.20, 1.063984, -0.000055}, {0.25, 1.105731, -0.002164},
                               {0.30, 1.159846, -0.012620}, {0.35, 1.220954, -0.034318},
                               {0.40, 1.285057, -0.066128}, {0.50, 1.415662, -0.153359},
                               {0.60, 1.545707, -0.264110}, {0.70, 1.673866, -0.392401},
                               {0.80, 1.799899, -0.534552}, {1.00, 2.045905, -0.851330}};
    PlasmaSpecies plasma = electrons(1.0);
    plasma.temperature_along = 1.0;
    for (const auto& row : table) {
        const double k = row[0];
        const auto root = facts::fastest_growing_longitudinal({&plasma, 1}, k);
        CHECK(root.found);
        CHECK(std::abs(root.omega.real() - row[1]) <= 1e-6);
        CHECK(std::abs(root.omega.imag() - row[2]) <= 1e-6);

        const auto D = [&](Complex w) {
            return common::longitudinal_dispersion({&plasma, 1}, k, w);
        };
        const auto near = common::root_near(D, Complex(row[1], row[2]) * 1.05);
        CHECK(near.found);
        CHECK(distance(near.omega, root.omega) <= 1e-12);
    }
}

TEST_CASE("cold beams grow as the two-stream formula says and stop where it ends") {
    const double v_0 = 1.0;
    std::vector<PlasmaSpecies> beams{electrons(std::sqrt(0.5)), electrons(std::sqrt(0.5))};
    beams[0].drift = v_0;
    beams[1].drift = -v_0;
    for (const double a : {0.1, 0.3, 0.5, std::sqrt(3.0 / 8.0), 0.8, 0.95}) {
        const double exact = std::sqrt(std::sqrt(2.0 * a * a + 0.25) - a * a - 0.5);
        const auto root = facts::fastest_growing_longitudinal(beams, a / v_0);
        CHECK(root.found);
        CHECK(std::abs(root.omega.imag() - exact) <= 1e-12);
        CHECK(std::abs(root.omega.real()) <= 1e-12);
    }
    const auto fastest = facts::fastest_growing_longitudinal(beams, std::sqrt(3.0 / 8.0));
    CHECK(std::abs(fastest.omega.imag() - 1.0 / std::sqrt(8.0)) <= 1e-12);
    for (const double a : {1.05, 1.5, 3.0}) {
        const auto root = facts::fastest_growing_longitudinal(beams, a / v_0);
        CHECK(root.found);
        CHECK(root.omega.imag() <= 1e-12);
    }
}

TEST_CASE("warm beams grow slower and approach the cold rate") {
    // v_0 = 0.2 c, k = 3.0605 omega_p / c.
    const double table[][2] = {{0.01, 0.352546}, {0.02, 0.349376}, {0.05, 0.320556}};
    for (const auto& row : table) {
        std::vector<PlasmaSpecies> beams{electrons(std::sqrt(0.5)), electrons(std::sqrt(0.5))};
        beams[0].drift = 0.2;
        beams[1].drift = -0.2;
        for (auto& beam : beams) beam.temperature_along = row[0] * row[0];
        const auto root = facts::fastest_growing_longitudinal(beams, 2.0 * pi / 2.053);
        CHECK(root.found);
        CHECK(std::abs(root.omega.imag() - row[1]) <= 2e-6);
    }
}

TEST_CASE("the Buneman root solves its polynomial and has the limiting rate") {
    // 1 = (1/M) / w^2 + 1 / (w - k v)^2 with k v = 1.
    for (const double M : {25.0, 100.0, 1836.0, 1e6}) {
        std::vector<PlasmaSpecies> plasma{electrons(1.0), electrons(1.0)};
        plasma[0].drift = 1.0;
        plasma[1].mass = M;
        const auto root = facts::fastest_growing_longitudinal(plasma, 1.0);
        const Complex w = root.omega;
        CHECK(root.found);
        CHECK(std::abs(w * w * (w - 1.0) * (w - 1.0) - (w - 1.0) * (w - 1.0) / M - w * w) <= 1e-13);
        const Complex limit = std::cbrt(0.5 / M) * std::polar(1.0, pi / 3.0);
        CHECK(distance(w, limit) <= 0.6 / std::cbrt(M));
    }
}

TEST_CASE("a cold species is the limit of a warm one") {
    std::vector<PlasmaSpecies> cold{electrons(1.0), electrons(0.3)}, warm;
    cold[0].drift = 0.4;
    cold[0].gyrofrequency = -2.0;
    cold[1].gyrofrequency = 0.1;
    for (auto& s : cold) s.temperature_across = 1e-3;
    warm = cold;
    for (auto& s : warm) s.temperature_along = 1e-10;
    for (const Complex w : {Complex(0.7, 0.2), Complex(-1.3, 0.1), Complex(3.0, 1.0)}) {
        CHECK(distance(common::longitudinal_dispersion(warm, 0.8, w),
                       common::longitudinal_dispersion(cold, 0.8, w)) <= 1e-8);
        for (const int sense : {-1, 1})
            CHECK(distance(implicit_moment::transverse_dispersion(warm, 0.8, 5.0, sense, w),
                           implicit_moment::transverse_dispersion(cold, 0.8, 5.0, sense, w)) <=
                  1e-8);
    }
}

TEST_CASE("a slow stream answers as a species without Lorentz factor") {
    PlasmaSpecies species = electrons(1.3);
    species.drift = 0.4, species.temperature_across = 0.09;
    for (const double spread : {0.0, 0.1}) {
        species.temperature_along = spread * spread;
        const implicit_moment::Stream stream{1.69, 0.4, 0.3, spread};
        for (const double part_of_E : {1.0, 0.7})
            for (const Complex w : {Complex(0.7, 0.2), Complex(-1.3, 0.1)})
                CHECK(distance(implicit_moment::stream_response(stream, 0.8, 1e5, w, part_of_E),
                               implicit_moment::transverse_response(species, 0.8, 1, w,
                                                                    part_of_E)) <= 1e-9);
    }
}

TEST_CASE("a cold stream answers a transverse wave alike in all frames that move along it") {
    // omega_s^2 counts n/gamma, and the response relates J to A across k: no frame changes them.
    const double k = 0.9, V = 0.7, gamma = 1 / std::sqrt(1 - V * V), v_k = 0.5, v_E = 0.6;
    const implicit_moment::Stream here{1.3, v_k, v_E, 0},
        there{1.3, (v_k - V) / (1 - v_k * V), v_E / (gamma * (1 - v_k * V)), 0};
    for (const double w : {0.4, 1.7})
        CHECK(distance(implicit_moment::stream_response(here, k, 1, w),
                       implicit_moment::stream_response(there, gamma * (k - V * w), 1,
                                                        gamma * (w - V * k))) <= 1e-12);
}

TEST_CASE("short filaments of two cold beams grow at beta omega_p over gamma to the half") {
    const double gamma = 3, beta = std::sqrt(1 - 1 / (gamma * gamma)), k = 300;
    const std::vector<implicit_moment::Stream> beams{{0.5 / gamma, 0, beta, 0},
                                                     {0.5 / gamma, 0, -beta, 0}};
    const auto root = common::root_near(
        [&](Complex w) {
            Complex D = w * w - k * k;
            for (const auto& beam : beams) D += implicit_moment::stream_response(beam, k, 1, w);
            return D;
        },
        Complex(0, 0.5));
    CHECK(root.found);
    CHECK(distance(root.omega, Complex(0, beta / std::sqrt(gamma))) <= 1e-5);
}

TEST_CASE("a dispersion relation moves with the plasma") {
    std::vector<PlasmaSpecies> plasma{electrons(1.0), electrons(0.4)};
    plasma[0].temperature_along = 0.04;
    plasma[1].drift = 1.0;
    const double k = 0.9;
    const Complex w(0.6, 0.3);
    const Complex here = common::longitudinal_dispersion(plasma, k, w);
    for (auto& s : plasma) s.drift += 0.37;
    CHECK(distance(common::longitudinal_dispersion(plasma, k, w + k * 0.37), here) <= 1e-13);
}

TEST_CASE("light in a cold plasma has omega squared of omega_p squared plus c k squared") {
    const PlasmaSpecies plasma = electrons(1.3);
    for (const double k : {0.0, 0.2, 1.0, 4.0}) {
        const auto root = fastest_growing_transverse({&plasma, 1}, k, 2.0, 1);
        CHECK(root.found);
        CHECK(std::abs(root.omega - std::sqrt(1.69 + 4.0 * k * k)) <= 1e-12);
    }
}

TEST_CASE("the Weibel root solves its relation and grows below the cutoff only") {
    // w^2 - c^2 k^2 - wp^2 + wp^2 (T_across / T_along) (1 + zeta Z) = 0 ends at
    // c^2 k^2 = wp^2 (T_across / T_along - 1).
    PlasmaSpecies plasma = electrons(1.0);
    plasma.temperature_along = 0.01;
    plasma.temperature_across = 0.09;
    const double cutoff = std::sqrt(8.0);
    for (const double k : {0.2, 0.5, 1.0, 1.5, 2.0, 2.7}) {
        const auto root = fastest_growing_transverse({&plasma, 1}, k, 1.0, 1);
        const Complex w = root.omega, zeta = w / (std::sqrt(2.0) * k * 0.1);
        CHECK(root.found);
        CHECK(std::abs(w.real()) <= 1e-10);
        CHECK(w.imag() > 0.0);
        CHECK(std::abs(w * w - k * k - 1.0 + 9.0 * (1.0 + zeta * plasma_dispersion(zeta))) <=
              1e-10);
    }
    const auto stable = fastest_growing_transverse({&plasma, 1}, 1.01 * cutoff, 1.0, 1);
    CHECK(stable.found);
    CHECK(stable.omega.imag() <= 1e-10);
}

TEST_CASE("the Weibel instability of a plasma that is cold along k has its exact rate") {
    // w^4 - w^2 (wp^2 + c^2 k^2) - wp^2 k^2 v^2 = 0.
    PlasmaSpecies plasma = electrons(1.0);
    plasma.temperature_across = 0.04;
    for (const double k : {0.3, 1.0, 3.0}) {
        const double b = 1.0 + k * k;
        const double exact = std::sqrt(0.5 * (std::sqrt(b * b + 4.0 * k * k * 0.04) - b));
        const auto root = fastest_growing_transverse({&plasma, 1}, k, 1.0, 1);
        CHECK(std::abs(root.omega - i * exact) <= 1e-12);
    }
}

TEST_CASE("parallel waves in a cold magnetized plasma have the published frequencies") {
    const auto plasma = cold_magnetized(20.0, 25.0);
    const auto whistler = [&](Complex w) {
        return implicit_moment::transverse_dispersion(plasma, 1.0, 20.0, +1, w);
    };
    const auto ion_cyclotron = [&](Complex w) {
        return implicit_moment::transverse_dispersion(plasma, 1.0, 20.0, -1, w);
    };
    CHECK(std::abs(common::root_near(whistler, 1.6).omega - 1.498601) <= 1e-6);
    CHECK(std::abs(common::root_near(ion_cyclotron, 0.6).omega - 0.615325) <= 1e-6);

    // n^2 = 1 - sum_s omega_s^2 / (w (w + sense Omega_s)), from the roots.
    for (const int sense : {-1, 1}) {
        const double w =
            common::root_near(
                [&](Complex omega) {
                    return implicit_moment::transverse_dispersion(plasma, 1.0, 20.0, sense, omega);
                },
                sense > 0 ? 1.6 : 0.6)
                .omega.real();
        const double n_squared = 400.0 / (w * w);
        const double right_side = 1.0 - 400.0 / (w * (w + sense)) - 1e4 / (w * (w - 25.0 * sense));
        CHECK(std::abs(n_squared - right_side) <= 1e-9 * n_squared);
    }
}

TEST_CASE("long parallel waves travel at the Alfven speed") {
    const auto plasma = cold_magnetized(20.0, 1836.0);
    const double k = 1e-3, v_A = 1.0 / std::sqrt(1.0 + (1.0 + 1.0 / 1836.0) / 400.0);
    for (const int sense : {-1, 1}) {
        const auto D = [&](Complex w) {
            return implicit_moment::transverse_dispersion(plasma, k, 20.0, sense, w);
        };
        CHECK(std::abs(common::root_near(D, 0.9 * k).omega / k - v_A) <= 1e-3);
    }
}

TEST_CASE("the search for a root reports where there is none") {
    const auto never_zero = [](Complex w) { return std::exp(0.1 * w); };
    CHECK_FALSE(common::root_near(never_zero, 1.0).found);
    const auto broken = [](Complex) { return Complex(std::nan(""), 0.0); };
    CHECK_FALSE(common::root_near(broken, 1.0).found);
    CHECK_FALSE(common::fastest_growing_root(never_zero, {1.0, i}).found);
}

TEST_CASE("the theta scheme treats vacuum light waves as tabulated") {
    const double a_0[] = {0.1, 0.5, 1.0, 2.0, 5.0};
    const struct {
        double theta, size[5], frequency[5];
    } table[] = {{0.5, {1, 1, 1, 1, 1}, {.999168, .979915, .927295, .785398, .476116}},
                 {0.6,
                  {.999003, .976795, .923548, .819836, .707107},
                  {.999068, .977705, .920926, .775399, .471239}},
                 {1.0,
                  {.995037, .894427, .707107, .447214, .196116},
                  {.996687, .927295, .785398, .553574, .274680}}};
    for (const auto& row : table)
        for (int n = 0; n < 5; ++n) {
            const Complex g = implicit_moment::theta_light_wave(row.theta, a_0[n]);
            CHECK(std::abs(std::abs(g) - row.size[n]) <= 1e-6);
            CHECK(std::abs(std::arg(g) / a_0[n] - row.frequency[n]) <= 1e-6);
        }
}

TEST_CASE("the theta scheme with one half is neutral and with more damps") {
    for (const double a : {0.01, 0.3, 1.0, 3.0, 20.0}) {
        CHECK(std::abs(std::abs(implicit_moment::theta_light_wave(0.5, a)) - 1.0) <= 1e-14);
        CHECK(std::abs(implicit_moment::theta_light_wave(0.7, a)) < 1.0);
        CHECK(std::abs(implicit_moment::theta_light_wave(0.4, a)) > 1.0);
    }
}
