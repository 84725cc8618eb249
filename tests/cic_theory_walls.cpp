// Facts about the theory of plasmas at walls: the sheaths of a floating collector against
// quadratures of the distributions, and the diocotron instability against other calculations.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "cic/theory/diocotron.hpp"
#include "cic/theory/sheath.hpp"
#include "implicit_moment/theory/eigenvalues.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

using cic::ChargedLayer;
using cic::Sheath;
using facts::integral;
using Complex = std::complex<double>;

const double infinity = std::numeric_limits<double>::infinity();

// The density of ions where the potential is phi.
//   n_i = g(-phi / tau) / g(-phi_P / tau),  g(y) = exp(y) erfc(y^1/2)
// in:    phi, from phi_C to 0
// exact: 1 at phi_P
double ion_density(const Sheath& s, double phi) {
    return cic::detail::scaled_erfc(-phi / s.temperature_ratio) /
           cic::detail::scaled_erfc(-s.plasma_potential / s.temperature_ratio);
}

// The drift v_x along the undisturbed layer.
//   v_x = -E_z / B,  E_z = rho_0 z in the layer and rho_0 d sign z outside
double layer_drift(const ChargedLayer& layer, double z) {
    return -layer.shear_rate * std::clamp(z, -layer.half_width, layer.half_width);
}

std::vector<Sheath> sheaths() {
    std::vector<Sheath> all;
    for (const double M : {10.0, 40.0, 100.0, 1836.0})
        for (const double tau : {0.1, 1.0, 3.0}) all.push_back(cic::collector_sheath(M, tau));
    return all;
}

// The electrons where the potential is phi: the moment of v^power over those that have not reached
// the collector.
double electron_moment(const Sheath& s, double phi, int power) {
    const double slowest = -std::sqrt(2.0 * (phi - s.collector_potential));
    const auto f = [&](double v) { return std::exp(phi - 0.5 * v * v) * std::pow(v, power); };
    return s.emission * integral(f, slowest, 10.0);
}

// The ions where the potential is phi: the moment of v^power over those that have left the source,
// none of which is slower than one that left it at rest; v in units of (T_i / m_i)^1/2.
double ion_moment(const Sheath& s, double phi, int power) {
    const double slowest = std::sqrt(-2.0 * phi / s.temperature_ratio);
    const auto f = [&](double v) {
        const double v_source_squared = v * v - slowest * slowest;
        return std::exp(-0.5 * v_source_squared) * std::pow(v, power);
    };
    const double speed = std::sqrt(s.temperature_ratio / s.mass_ratio);
    return s.flux / speed * integral(f, slowest, slowest + 10.0);
}

// The potential of a ripple at the upper wall, relative to its value without a layer, when it
// starts from zero at the lower one: phi'' = k^2 phi between the edges, where phi' jumps.
Complex mismatch_at_wall(const ChargedLayer& layer, double k, Complex omega) {
    const double d = layer.half_width, b = layer.wall_distance, S = layer.shear_rate;
    Complex phi = 0.0, slope = 1.0;
    const auto advance = [&](double length) {
        const double c = std::cosh(k * length), s = std::sinh(k * length);
        const Complex phi_old = phi;
        phi = phi_old * c + slope * s / k;
        slope = phi_old * k * s + slope * c;
    };
    advance(b - d);
    slope += k * S * phi / (omega - k * layer_drift(layer, -d));
    advance(2.0 * d);
    slope -= k * S * phi / (omega - k * layer_drift(layer, d));
    advance(b - d);
    return phi * k / std::sinh(2.0 * k * b);
}

// -d^2/dz^2 + k^2 between grounded walls, on the nodes between them.
Eigen::MatrixXd poisson_matrix(const ChargedLayer& layer, double k, int cells) {
    const double h = 2.0 * layer.wall_distance / cells;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(cells - 1, cells - 1);
    for (int j = 0; j < cells - 1; ++j) {
        A(j, j) = 2.0 / (h * h) + k * k;
        if (j > 0) A(j, j - 1) = A(j - 1, j) = -1.0 / (h * h);
    }
    return A;
}

// The largest Im omega of all solutions of  (omega - k v_x) rho = -(k / B) rho_0' phi  on a mesh
// that has the edges on nodes.
double fastest_growth_on_mesh(const ChargedLayer& layer, double k, int cells) {
    const double h = 2.0 * layer.wall_distance / cells;
    const int offset = int(std::lround(layer.half_width / h));
    Eigen::MatrixXd omega = poisson_matrix(layer, k, cells).inverse();
    for (int j = 0; j < cells - 1; ++j) {
        const int from_middle = j + 1 - cells / 2;
        double jump = 0.0;
        if (from_middle == -offset) jump = layer.shear_rate / h;
        if (from_middle == offset) jump = -layer.shear_rate / h;
        omega.row(j) *= -k * jump;
        omega(j, j) += k * layer_drift(layer, from_middle * h);
    }
    return implicit_moment::eigensystem(omega.cast<std::complex<double>>())
        .values.imag()
        .maxCoeff();
}

}  // namespace

TEST_CASE("the densities of a sheath are integrals over the distributions") {
    for (const auto& s : sheaths())
        for (const double part : {0.1, 0.3, 0.6, 0.9, 1.0}) {
            const double phi = part * s.collector_potential;
            const double n_e = electron_moment(s, phi, 0), n_i = ion_moment(s, phi, 0);
            CHECK(std::abs(cic::electron_density(s, phi) / n_e - 1.0) <= 3e-14);
            CHECK(std::abs(ion_density(s, phi) / n_i - 1.0) <= 3e-14);
        }
}

TEST_CASE("the momentum flux of a sheath is an integral over the distributions") {
    for (const auto& s : sheaths())
        for (const double part : {0.1, 0.3, 0.6, 0.9, 1.0}) {
            const double phi = part * s.collector_potential;
            const double ions = s.temperature_ratio * ion_moment(s, phi, 2);
            const double P = electron_moment(s, phi, 2) + ions;
            CHECK(std::abs(cic::momentum_flux(s, phi) / P - 1.0) <= 3e-14);
        }
}

TEST_CASE("as many electrons as ions reach the collector and leave the source") {
    for (const auto& s : sheaths()) {
        const double phi_C = s.collector_potential;
        const double ion_speed = std::sqrt(s.temperature_ratio / s.mass_ratio);
        CHECK(std::abs(ion_moment(s, phi_C, 1) * ion_speed / s.flux - 1.0) <= 3e-14);
        CHECK(std::abs(electron_moment(s, phi_C, 1) / s.flux - 1.0) <= 3e-14);
        CHECK(std::abs(electron_moment(s, 0.0, 1) / s.flux - 1.0) <= 2e-13);
        CHECK(std::abs(s.emission * std::exp(phi_C) / s.flux - 1.0) <= 1e-14);
    }
}

TEST_CASE("the plasma between two sheaths is neutral and free of field") {
    for (const auto& s : sheaths()) {
        const double phi_P = s.plasma_potential;
        CHECK(std::abs(electron_moment(s, phi_P, 0) - 1.0) <= 3e-14);
        CHECK(std::abs(ion_moment(s, phi_P, 0) - 1.0) <= 3e-14);

        // With phi = phi_P r^2 the integrand is smooth at the source.
        const auto charge = [&](double r) {
            const double phi = phi_P * r * r;
            return 2.0 * phi_P * r * (ion_density(s, phi) - cic::electron_density(s, phi));
        };
        CHECK(std::abs(integral(charge, 0.0, 1.0)) <= 1e-14);
        CHECK(std::abs(cic::momentum_flux(s, 0.0) - cic::momentum_flux(s, phi_P)) <= 1e-14);
    }
}

TEST_CASE("the potential falls all the way from the source to the collector") {
    for (const auto& s : sheaths()) {
        CHECK(s.collector_potential < s.plasma_potential);
        CHECK(s.plasma_potential < 0.0);
        for (int n = 1; n < 100; ++n) {
            // E^2 / 2 = P(phi) - P(phi_P), by the first integral of phi'' = n_e - n_i.
            const double P = cic::momentum_flux(s, s.plasma_potential),
                         drop = s.collector_potential - s.plasma_potential;
            CHECK(cic::momentum_flux(s, 0.01 * n * s.plasma_potential) > P);
            CHECK(cic::momentum_flux(s, s.plasma_potential + 0.01 * n * drop) > P);
        }
    }
}

TEST_CASE("the potentials of a sheath agree with a solution of thirty digits") {
    // M, phi_P, phi_C, flux for T_i = T_e.
    const double table[][4] = {
        {40.0, -0.27635972274068177, -1.0365599298095154, 0.20930235786581582},
        {100.0, -0.3056385072627156, -1.4537542999463855, 0.13533362621361102},
        {400.0, -0.32791432276991536, -2.1159731736214012, 0.068751870927491535},
        {1836.0, -0.33801456001308289, -2.8636686093897328, 0.032315361014702542}};
    for (const auto& row : table) {
        const Sheath s = cic::collector_sheath(row[0], 1.0);
        CHECK(std::abs(s.plasma_potential - row[1]) <= 2e-14);
        CHECK(std::abs(s.collector_potential - row[2]) <= 2e-14);
        CHECK(std::abs(s.flux - row[3]) <= 2e-15);
    }
}

TEST_CASE("heavy ions have a source sheath that does not depend on their mass") {
    // Without absorbed electrons n_e = exp(phi - phi_P) and both conditions are one equation.
    const Sheath s = cic::collector_sheath(1e40, 1.0);
    const double p = -s.plasma_potential, g = std::exp(p) * std::erfc(std::sqrt(p));
    const double ions = (g + 2.0 * std::sqrt(p * std::numbers::inv_pi) - 1.0) / g;
    CHECK(std::abs(ions - std::expm1(p)) <= 1e-14);
    CHECK(std::abs(p - 0.344954) <= 1e-6);
}

TEST_CASE("the collector sheath drops what a fluid with a Bohm speed says") {
    // phi_P - phi_C = ln [M / (2 pi (1 + tau))]^1/2 for ions that enter at [(1 + tau) / M]^1/2.
    const Sheath s = cic::collector_sheath(1836.0, 1.0);
    const double fluid = 0.5 * std::log(1836.0 / (4.0 * std::numbers::pi));
    CHECK(std::abs(s.plasma_potential - s.collector_potential - fluid) <= 0.04);
}

TEST_CASE("there is no sheath for ions as fast as electrons or for impossible numbers") {
    const facts::Untrapped calm;
    const double nan = std::nan("");
    CHECK_THROWS_AS(cic::collector_sheath(1.0, 1.0), common::InputError);
    CHECK_THROWS_AS(cic::collector_sheath(40.0, 100.0), common::InputError);
    CHECK_THROWS_AS(cic::collector_sheath(1.01, 0.01), common::InputError);
    CHECK_THROWS_AS(cic::collector_sheath(40.0, 0.0), common::InputError);
    CHECK_THROWS_AS(cic::collector_sheath(40.0, -1.0), common::InputError);
    CHECK_THROWS_AS(cic::collector_sheath(nan, 1.0), common::InputError);
    CHECK_THROWS_AS(cic::collector_sheath(40.0, nan), common::InputError);
    CHECK_THROWS_AS(cic::collector_sheath(infinity, 1.0), common::InputError);
}

TEST_CASE("the diocotron frequency without walls is the one of Rayleigh") {
    for (const double b : {infinity, 30.0})
        for (const double kd : {0.1, 0.3984, 0.6, 0.7, 1.5, 4.0}) {
            const ChargedLayer layer{-1.7, 1.0, b == infinity ? b : b / kd};
            const Complex scaled = 2.0 * cic::diocotron_frequency(layer, kd) / layer.shear_rate;
            const double exact = std::pow(1.0 - 2.0 * kd, 2) - std::exp(-4.0 * kd);
            CHECK(std::abs(scaled * scaled - exact) <= 1e-14 * (1.0 + exact));
        }

    // The fastest one has exp(-2 kd) = 1 - 2 kd; growth ends at exp(-2 kd) = 2 kd - 1.
    const ChargedLayer layer{2.0, 0.5, infinity};
    CHECK(std::abs(cic::diocotron_frequency(layer, 2.0 * 0.398406) - Complex(0.0, 0.402372)) <=
          1e-6);
    CHECK(cic::diocotron_frequency(layer, 1.278464).imag() > 0.0);
    CHECK(cic::diocotron_frequency(layer, 1.278465).imag() == 0.0);
}

TEST_CASE("a diocotron ripple meets both walls") {
    for (const double d : {0.05, 0.25, 0.4, 0.7})
        for (const double k : {0.2, 1.0, 2.0, 3.0, 6.0}) {
            const ChargedLayer layer{1.3, d, 1.0};
            const Complex omega = cic::diocotron_frequency(layer, k);
            CHECK(std::abs(mismatch_at_wall(layer, k, omega)) <= 1e-14);
            CHECK(std::abs(mismatch_at_wall(layer, k, -omega)) <= 1e-14);
        }
}

TEST_CASE("the diocotron frequency is an eigenvalue of the ripples of two edges") {
    for (const double d : {0.1, 0.3, 0.6})
        for (const double k : {0.5, 1.5, 4.0}) {
            const double S = 0.8, b = 1.0;
            const auto green = [&](double z, double source) {
                return std::sinh(k * (b - z)) * std::sinh(k * (b + source)) /
                       (k * std::sinh(2.0 * k * b));
            };
            Eigen::Matrix2d ripples;
            ripples << green(d, d) - d, -green(d, -d), green(d, -d), d - green(-d, -d);
            const Eigen::Vector2cd omega = (k * S * ripples).eigenvalues();
            const Complex formula = cic::diocotron_frequency({S, d, b}, k);
            const double nearest =
                std::min(std::abs(omega(0) - formula), std::abs(omega(1) - formula));
            CHECK(nearest <= 2e-15);
        }
}

TEST_CASE("no ripple of a layer on a mesh grows faster than the diocotron instability") {
    for (const double d : {0.125, 0.25, 0.375})
        for (const double k : {0.5, 0.8, 1.1}) {
            const ChargedLayer layer{1.0, d, 1.0};
            const double exact = cic::diocotron_frequency(layer, k).imag();
            const double coarse = fastest_growth_on_mesh(layer, k, 64);
            const double fine = fastest_growth_on_mesh(layer, k, 128);
            CHECK(std::abs((4.0 * fine - coarse) / 3.0 - exact) <= 2e-8);
        }
}

TEST_CASE("the diocotron instability ends at its cutoff and needs distant walls") {
    for (const double d : {0.1, 0.3, 0.45}) {
        const ChargedLayer layer{1.0, d, 1.0};
        // sinh k(b - d) cosh kd = kd cosh kb
        double low = 1e-3, high = 50.0;
        while (high - low > 1e-12) {
            const double k = 0.5 * (low + high);
            const double balance =
                std::sinh(k * (1.0 - d)) * std::cosh(k * d) / std::cosh(k) - k * d;
            (balance > 0.0 ? low : high) = k;
        }
        CHECK(cic::diocotron_frequency(layer, low * (1.0 - 1e-9)).imag() > 0.0);
        CHECK(cic::diocotron_frequency(layer, low * (1.0 + 1e-9)).imag() == 0.0);
    }
    for (const double d : {0.5, 0.6, 0.9})
        for (const double k : {0.01, 0.1, 1.0, 10.0})
            CHECK(cic::diocotron_frequency({1.0, d, 1.0}, k).imag() == 0.0);
}

TEST_CASE("the diocotron frequency is the same for both signs of the charge") {
    for (const double k : {0.3, 1.0, 3.0})
        CHECK(cic::diocotron_frequency({1.1, 0.3, 1.0}, k) ==
              cic::diocotron_frequency({-1.1, 0.3, 1.0}, k));
}
