// Facts about the linear theory of the drift kink of a Harris sheet: its matrix in plasmas whose
// waves are known, and its kinks where they have a formula.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"
#include "implicit_moment/theory/drift_kink.hpp"
#include "implicit_moment/theory/magnetized_plasma.hpp"
#include "tests/support/longitudinal_wave.hpp"

namespace {

using common::Complex;
using namespace implicit_moment;

// The sheet of the talk, with T_i / T_e.
CurrentSheet thin_sheet(double temperature_ratio, double mass_ratio = 180,
                        double background = 0.01) {
    return {mass_ratio, temperature_ratio, 1, 40 / std::sqrt(mass_ratio), background};
}

// The wave with most of a magnetic field, which is the drift kink where there is one: waves of the
// edges are nearly electrostatic.
// in:     waves, one or more
const SheetWave& drift_kink(const std::vector<SheetWave>& waves) {
    return *std::ranges::max_element(
        waves, [](const SheetWave& a, const SheetWave& b) { return a.magnetic < b.magnetic; });
}

// The wave of long wavelength: both species are shifted as a whole, nothing but their inertia acts,
//     m_i (omega - k u_i)^2 + m_e (omega - k u_e)^2 = 0
// exact:  for k L << 1
Complex rigid_kink(const CurrentSheet& sheet, double k) {
    const double M = sheet.mass_ratio, u_i = sheet.drift * sheet.drift;
    const double u_e = -u_i / sheet.temperature_ratio;
    return k / (M + 1) * Complex(M * u_i + u_e, std::sqrt(M) * (u_i - u_e));
}

// All eigenvalues, of matrices that are small.
std::vector<Complex> spectrum(const SheetMatrix& m) {
    const Eigen::VectorXcd all = eigensystem(Eigen::MatrixXcd(m.A)).values;
    return {all.begin(), all.end()};
}

// All eigenvalues where nothing drifts and nothing is damped.
std::vector<Complex> spectrum_without_drift(const SheetMatrix& m) {
    const Eigen::MatrixXcd A(m.A);
    const Eigen::VectorXd all = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd>(A).eigenvalues();
    return {all.begin(), all.end()};
}

double distance(const std::vector<Complex>& spectrum, Complex omega) {
    double nearest = HUGE_VAL;
    for (const Complex other : spectrum) nearest = std::min(nearest, std::abs(other - omega));
    return nearest;
}

double largest_growth(const std::vector<Complex>& spectrum) {
    double largest = -HUGE_VAL;
    for (const Complex omega : spectrum) largest = std::max(largest, omega.imag());
    return largest;
}

// Warm ions and electrons in a uniform field, or in none.
LinearSheet uniform_plasma(double B, int degree) {
    LinearSheet plasma;
    plasma.plasma = {{1, 1, 0, 1, 0, 0.4, degree}, {-1, 0.25, 0, 1, 0, 0.7, degree}};
    plasma.omega_pi = 3, plasma.light = 10, plasma.k = 0.8;
    plasma.low = 0, plasma.high = 6, plasma.cells = 12;
    plasma.B = B, plasma.reverses = false;
    return plasma;
}

// The same, and nothing varies along z.
LinearSheet uniform_along_z(double B, int degree) {
    LinearSheet plasma = uniform_plasma(B, degree);
    plasma.cells = 1;
    plasma.lower = plasma.upper = End::periodic;
    return plasma;
}

// The wave that is nearest to omega.
SheetWave wave_near(const LinearSheet& sheet, Complex omega) {
    SheetWave nearest{HUGE_VAL, {}, 0, 0, 0};
    for (const SheetWave& wave : waves_near(sheet_matrix(sheet), omega, 25))
        if (std::abs(wave.omega - omega) < std::abs(nearest.omega - omega)) nearest = wave;
    return nearest;
}

// The kink of a sheet without background that is nearest to that of two rigid species.
Complex nearly_rigid(const CurrentSheet& sheet, double k, int cells_in_L, int degree) {
    const KinkResolution resolution{12 * cells_in_L, degree, degree, 1, 0};
    return wave_near(linear_sheet(sheet, k, 12, true, resolution), rigid_kink(sheet, k)).omega;
}

}  // namespace

TEST_CASE("without drift the matrix is Hermitian and no wave grows") {
    for (const End lower : {End::wall, End::even, End::odd, End::periodic}) {
        LinearSheet sheet = linear_sheet(thin_sheet(2), 1.3);
        for (DriftingMaxwellian& part : sheet.plasma) part.drift = part.damping = 0;
        sheet.lower = lower;
        if (lower == End::periodic) sheet.upper = lower;
        const SheetMatrix m = sheet_matrix(sheet);
        const Eigen::SparseMatrix<Complex> transposed = m.A.adjoint();
        CHECK((m.A - transposed).norm() <= 1e-14 * m.A.norm());
        CHECK(m.A.norm() > 100);
    }
}

TEST_CASE("light and the sound and plasma waves of two fluids are exact on the mesh") {
    for (const End end : {End::even, End::odd}) {
        LinearSheet plasma = uniform_plasma(0, 1);
        plasma.lower = plasma.upper = end;
        const auto waves = spectrum_without_drift(sheet_matrix(plasma));
        for (const int m : {1, 2, 7}) {
            const double dz = 0.5, k_z = m * std::numbers::pi / 6;
            const double K2 = plasma.k * plasma.k + std::pow(2 * std::sin(k_z * dz / 2) / dz, 2);
            const double ions = 9, electrons = 36, v2_i = 0.16, v2_e = 0.49;
            CHECK(distance(waves, std::sqrt(ions + electrons + 100 * K2)) <= 1e-11);
            // ions / (omega^2 - K^2 v_i^2) + electrons / (omega^2 - K^2 v_e^2) = 1
            const double a = ions + K2 * v2_i, b = electrons + K2 * v2_e;
            const double root = std::sqrt((a - b) * (a - b) / 4 + ions * electrons);
            for (const double sign : {-1.0, 1.0})
                CHECK(distance(waves, std::sqrt((a + b) / 2 + sign * root)) <= 1e-11);
        }
    }
}

TEST_CASE("waves across a uniform field are those of the dielectric tensor of Maxwellians") {
    const LinearSheet plasma = uniform_along_z(1, 24);
    const SheetMatrix m = sheet_matrix(plasma);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> all{Eigen::MatrixXcd(m.A)};
    const std::vector<MagnetizedSpecies> species{{9, 1, 0, 0.4, 0.4}, {36, -4, 0, 0.7, 0.7}};
    const auto D = [&](Complex omega) {
        return magnetized_dispersion(species, {0, plasma.k}, plasma.light, omega);
    };
    int compared = 0;
    for (long j = 0; j < m.A.rows(); ++j) {
        // The two at the harmonics of the ions that have much of a field, and three fast ones.
        const Eigen::VectorXcd x = all.eigenvectors().col(j);
        const double omega = all.eigenvalues()[j];
        if (omega < 0.1 || std::norm(x[m.E_x[0]]) + std::norm(x[m.E_z[1]]) < 1e-3) continue;
        const common::DispersionRoot root = common::root_near(D, omega);
        CHECK(root.found);
        CHECK(std::abs(root.omega - omega) <= 1e-8 * omega);
        ++compared;
    }
    CHECK(compared == 5);
}

TEST_CASE("a wave across the field does not know its direction but for an error of second order") {
    LinearSheet along_x = uniform_along_z(1, 3), oblique = uniform_plasma(1, 3);
    along_x.k = std::hypot(oblique.k, 2 * std::numbers::pi / 6);
    oblique.lower = oblique.upper = End::periodic;
    const auto exact = spectrum_without_drift(sheet_matrix(along_x));
    const auto slowest =
        std::find_if(exact.begin(), exact.end(), [](Complex omega) { return omega.real() > 0.1; });
    for (const Complex omega : {*slowest, exact.back()}) {
        double error[2];
        for (const int fine : {0, 1}) {
            oblique.cells = fine ? 96 : 48;
            error[fine] = std::abs(wave_near(oblique, omega + 1e-4).omega - omega);
        }
        CHECK(error[0] <= 0.01 * std::abs(omega));
        CHECK(std::abs(error[0] / error[1] - 4) <= 0.1);
    }
}

TEST_CASE("two streams grow and waves damp as in Vlasov's theory") {
    // Phase mixing wants many polynomials, and a damping of the highest.
    const double k = 0.8, v = 0.5;
    const int degree = 36;
    for (const double drift : {0.0, 0.9, 1.2}) {  // Landau damping; two-stream instabilities
        LinearSheet plasma = uniform_along_z(0, degree);
        plasma.k = k, plasma.omega_pi = 1;
        plasma.plasma.clear();
        std::vector<common::PlasmaSpecies> species;
        for (const double sign : {-1.0, 1.0}) {
            plasma.plasma.push_back({-1, 1, 0, 0.5, sign * drift, v, degree, 20 * k * v});
            const double density = 0.5 / (4 * std::numbers::pi);  // omega_s^2 = 1/2
            species.push_back({density, 1, 1, sign * drift, v * v, v * v, 0});
        }
        const Complex exact = facts::fastest_growing_longitudinal(species, k).omega;
        CHECK(std::abs(wave_near(plasma, exact).omega - exact) <= 2e-5);
    }
}

TEST_CASE("a Harris sheet does not change where nothing varies along the current") {
    for (const bool kink : {true, false})
        for (const int degree : {1, 2, 4}) {
            const KinkResolution resolution{16, degree, degree, 1, 0};
            const CurrentSheet sheet = thin_sheet(1, 25, 0);
            const SheetMatrix m = sheet_matrix(linear_sheet(sheet, 0, 4.5, kink, resolution));
            CHECK(largest_growth(spectrum(m)) <= 1e-9);
        }
}

TEST_CASE("kinks and sausages are all the waves of a sheet") {
    const CurrentSheet sheet = thin_sheet(1, 25);
    const KinkResolution coarse{12, 2, 2, 1, 0};
    const LinearSheet kink = linear_sheet(sheet, 1, 4.5, true, coarse);
    const auto kinks = spectrum(sheet_matrix(kink));
    const auto sausages = spectrum(sheet_matrix(linear_sheet(sheet, 1, 4.5, false, coarse)));
    LinearSheet both = kink;
    both.low = -4.5, both.cells = 24, both.lower = End::wall;
    const auto all = spectrum(sheet_matrix(both));
    CHECK(all.size() == kinks.size() + sausages.size());
    for (const auto& some : {kinks, sausages})
        for (const Complex omega : some) CHECK(distance(all, omega) <= 1e-9);
    CHECK(largest_growth(kinks) >= largest_growth(sausages) + 0.1);

    // The search finds the fastest of them.
    const auto found = growing_waves(kink);
    CHECK(std::abs(found.front().omega.imag() - largest_growth(kinks)) <= 1e-9);
    CHECK(found.front().residual <= 1e-8);
    CHECK(distance(kinks, found.front().omega) <= 1e-9);
}

TEST_CASE("a long kink is that of two species that slide through each other as a whole") {
    for (const double mass_ratio : {1.0, 4.0})
        for (const double temperature_ratio : {1.0, 4.0})
            for (const int degree : {1, 3}) {
                const CurrentSheet sheet = thin_sheet(temperature_ratio, mass_ratio, 0);
                const Complex kink = nearly_rigid(sheet, 0.1, 24, degree);
                CHECK(std::abs(kink / rigid_kink(sheet, 0.1) - 1.0) <= 0.02);
            }
}

TEST_CASE("the growth of a kink converges with the square of the distance of nodes") {
    const CurrentSheet sheet = thin_sheet(1, 1, 0);
    const double coarse = nearly_rigid(sheet, 0.2, 6, 2).imag();
    const double fine = nearly_rigid(sheet, 0.2, 12, 2).imag();
    const double finest = nearly_rigid(sheet, 0.2, 24, 2).imag();
    CHECK(std::abs((coarse - fine) / (fine - finest) - 4) <= 0.5);
}

TEST_CASE("the drift kink of the thin sheet is the faster the hotter the electrons" *
          doctest::description("physics")) {
    // Its electrons drift the faster, and it is from their drift against the ions that it grows.
    const double k = std::numbers::pi / 4;
    double last = HUGE_VAL;
    for (const double temperature_ratio : {1.0, 2.0, 4.0}) {
        const CurrentSheet sheet = thin_sheet(temperature_ratio);
        const auto waves = growing_waves(linear_sheet(sheet, k));
        REQUIRE(!waves.empty());
        const SheetWave& kink = drift_kink(waves);
        const double part = kink.omega.imag() / rigid_kink(sheet, k).imag();
        CHECK(part >= 0.6);
        CHECK(part <= 1);
        CHECK(std::abs(kink.omega.real() / (k * sheet.drift) - 1) <= 0.1);
        CHECK(kink.height <= 0.5);
        CHECK(kink.omega.imag() <= 0.85 * last);
        last = kink.omega.imag();
    }
}

TEST_CASE("the drift kink is the slower the lighter the electrons" *
          doctest::description("physics")) {
    // As (m_e / m_i)^1/2 of two rigid species, or faster.
    double last = HUGE_VAL;
    for (const double mass_ratio : {25.0, 100.0, 400.0}) {
        const auto waves = growing_waves(linear_sheet(thin_sheet(1, mass_ratio), 1));
        REQUIRE(!waves.empty());
        const double growth = drift_kink(waves).omega.imag();
        CHECK(growth >= 0.01);
        CHECK(growth <= 0.5 * last);
        last = growth;
    }
}

TEST_CASE("the growth of the drift kink hardly depends on how velocities are resolved" *
          doctest::description("physics")) {
    const auto growth = [](const KinkResolution& resolution) {
        const LinearSheet sheet =
            linear_sheet(thin_sheet(1), 0.5 * std::numbers::pi, 4.5, true, resolution);
        return drift_kink(growing_waves(sheet)).omega.imag();
    };
    const double standard = growth({});
    for (const KinkResolution& other : std::vector<KinkResolution>{
             {72, 10, 4, 6, 2}, {48, 15, 4, 9, 2}, {48, 10, 6, 6, 2}, {48, 10, 4, 6, 4}})
        CHECK(std::abs(growth(other) - standard) <= 0.01);
}

TEST_CASE("waves at the edges of the sheet grow almost as fast as in local theory" *
          doctest::description("physics")) {
    // Local theory, which is electrostatic, is an upper bound; kinks and sausages are alike.
    const double k = 2 * std::numbers::pi;
    for (const double temperature_ratio : {1.0, 4.0}) {
        CurrentSheet sheet = thin_sheet(temperature_ratio);
        const SheetWave kink = growing_waves(linear_sheet(sheet, k)).front();
        const SheetWave sausage = growing_waves(linear_sheet(sheet, k, 4.5, false)).front();
        sheet.grad_B = true;
        const double local = fastest_over_z(sheet, k).gamma;
        CHECK(kink.omega.imag() <= local);
        CHECK(kink.omega.imag() >= 0.7 * local);
        CHECK(std::abs(kink.omega - sausage.omega) <= 0.01 * std::abs(kink.omega));
        CHECK(kink.height >= 0.7);
    }
}
