// Facts about the local theory of the lower-hybrid drift instability of a Harris sheet, and about
// the instability of the shear layer that it leaves behind.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "implicit_moment/theory/drift_dispersion.hpp"
#include "tests/support/shear_layer.hpp"

namespace {

using common::Complex;
using facts::shear_layer_growth;
using implicit_moment::CurrentSheet;
using implicit_moment::drift_dispersion;
using implicit_moment::fastest_over_z;
using implicit_moment::fastest_wave;
using implicit_moment::local_root;
using implicit_moment::LocalPlasma;
using implicit_moment::LocalWave;
using implicit_moment::lower_hybrid_frequency;
using implicit_moment::plasma_at;

const double pi = std::numbers::pi;
const Complex i(0.0, 1.0);

// The fastest growing local wave at height z, of any wave number.
LocalWave fastest_over_k(const CurrentSheet& sheet, double z) {
    const LocalPlasma plasma = plasma_at(sheet, z);
    const double unit = lower_hybrid_frequency(plasma) / plasma.v_i;
    return fastest_wave([&](double k) { return local_root(sheet, z, k); }, 0.05 * unit, 4 * unit);
}

// The fastest growing local wave of the sheet.
LocalWave fastest_local_wave(const CurrentSheet& sheet) {
    return fastest_wave([&](double z) { return fastest_over_k(sheet, z); },
                        implicit_moment::lowest_z, implicit_moment::highest_z);
}

// The sheet of the talk, with T_i / T_e.
CurrentSheet thin_sheet(double temperature_ratio, double background = 0) {
    return {180, temperature_ratio, 1, 5, background};
}

// Sheets of all kinds: hot and cold electrons, weak and strong drift and field, with background,
// each with guiding centers at rest and drifting in grad B.
std::vector<CurrentSheet> sheets() {
    std::vector<CurrentSheet> all = {
        thin_sheet(1),      thin_sheet(4, 0.01), thin_sheet(10, 0.1), {36, 10, 1, 5.025, 1e-3},
        {1836, 1, 0.1, 10}, {25, 5, 2, 1, 0.2},  {1836, 0.5, 2, 20},  {180, 1, 0.3, 0.3, 0.02}};
    for (std::size_t n = 0, count = all.size(); n < count; ++n) {
        all.push_back(all[n]);
        all.back().grad_B = true;
    }
    return all;
}

// Heights and wave numbers, the latter in units of omega_lh / v_i.
const std::vector<std::pair<double, double>> places = {{0.3, 0.2}, {0.3, 1.5}, {1, 0.5},
                                                       {1, 1.4},   {1, 3},     {1.5, 0.1},
                                                       {1.5, 1.2}, {2.5, 0.4}, {2.5, 2}};

double wave_number(const LocalPlasma& plasma, double scaled) {
    return scaled * lower_hybrid_frequency(plasma) / plasma.v_i;
}

// How often D, along the straight line from a to b, goes around the origin.
template <class Dispersion>
double turns(const Dispersion& D, Complex a, Complex b, int depth = 0) {
    const Complex middle = 0.5 * (a + b);
    const double first = std::arg(D(middle) / D(a)), second = std::arg(D(b) / D(middle));
    const bool smooth = depth > 1 && std::abs(first) < 0.3 && std::abs(second) < 0.3;
    if (smooth || depth > 40) return (first + second) / (2 * pi);
    return turns(D, a, middle, depth + 1) + turns(D, middle, b, depth + 1);
}

// The number of zeros of D, less that of its poles, in the box |Re| < width, low < Im < high. Where
// the bottom passes zeros closely it is cut into short pieces.
template <class Dispersion>
double zeros_in_box(const Dispersion& D, double width, double low, double high) {
    const Complex up(0, high - low), left(-width, low), right(width, low);
    double sum = turns(D, right, right + up) + turns(D, right + up, left + up) +
                 turns(D, left + up, left) + turns(D, Complex(-low, low), Complex(low, low));
    for (double near = low, far = low; far < width; near = far) {
        far = std::min(1.06 * near, width);
        sum += turns(D, Complex(near, low), Complex(far, low)) +
               turns(D, Complex(-far, low), Complex(-near, low));
    }
    return sum;
}

// Z from its definition as an integral, for Im zeta > 0, by the trapezoidal rule.
Complex Z_by_quadrature(Complex zeta) {
    const double h = std::min(0.25, zeta.imag() / 6);
    Complex sum = 0;
    for (long n = -std::lround(7 / h); n <= std::lround(7 / h); ++n) {
        const double t = double(n) * h;
        sum += h * std::exp(-t * t) / (t - zeta);
    }
    return sum / std::sqrt(pi);
}

// The mean over a Maxwellian of J_0(k_rho w)^2 / (omega - omega_B w^2), for Im omega > 0, by the
// trapezoidal rule.
Complex resonance_by_quadrature(double k_rho, double omega_B, Complex omega) {
    const double h = 1e-3;
    Complex sum = 0;
    for (int n = 1; n < 7000; ++n) {
        const double w = n * h, J = std::cyl_bessel_j(0, k_rho * w);
        sum += h * 2 * w * std::exp(-w * w) * J * J / (omega - omega_B * w * w);
    }
    // The slope 2 / omega of the integrand at w = 0 is what the rule errs by to first order.
    return sum - h * h / 12 * -2.0 / omega;
}

// exp(-b) I_0(b), the mean of exp(-b (1 - cos theta)).
double Gamma_0_by_quadrature(double b) {
    const int points = 400;
    double sum = 0;
    for (int n = 0; n < points; ++n) sum += std::exp(-b * (1 - std::cos(2 * pi * n / points)));
    return sum / points;
}

// 1 + the sum of the susceptibilities, from first principles in units with e = m_e = T_e = n0 = 1
// and B0 / c = 1, so that Omega_ce = 1 and 4 pi = omega_pe^2. L follows from the balance of
// pressure, which makes it 2 (T_i + T_e) / (u_i - u_e).
Complex dispersion_from_scratch(const CurrentSheet& sheet, double z, double kL, Complex omega) {
    const double four_pi = sheet.frequency_ratio * sheet.frequency_ratio;
    const double T_e = 1, T_i = sheet.temperature_ratio, m_i = sheet.mass_ratio;
    const double u_i = sheet.drift * std::sqrt(2 * T_i / m_i), u_e = -u_i * T_e / T_i;
    const double L = 2 * (T_i + T_e) / (u_i - u_e), k = kL / L;
    const double B = std::tanh(z), b = k * k * T_e / (B * B);
    // The speed (T_e / e B) d ln B / d(zL) of guiding centers.
    const double v_B = T_e / (B * B * L * std::pow(std::cosh(z), 2));
    omega /= m_i;  // from units of Omega_ci
    const Complex Gamma_0_over_omega =
        sheet.grad_B ? resonance_by_quadrature(std::sqrt(2 * b), k * v_B, omega)
                     : Gamma_0_by_quadrature(b) / omega;
    Complex D = 1;
    const auto add = [&](double n, double ion_drift, double electron_drift) {
        const Complex zeta = (omega - k * ion_drift) / (k * std::sqrt(2 * T_i / m_i));
        D += four_pi * n / (k * k * T_i) * (1.0 + zeta * Z_by_quadrature(zeta));
        D +=
            four_pi * n / (k * k * T_e) * (1.0 - (omega - k * electron_drift) * Gamma_0_over_omega);
    };
    add(1 / std::pow(std::cosh(z), 2), u_i, u_e);
    add(sheet.background, 0, 0);
    return D;
}

// gamma / [(u_i / v_i)^2 omega_lh] of the fastest wave at z = 1 of a sheet with cold electrons.
double scaled_growth(double drift) {
    const CurrentSheet sheet{1836, 1e6, drift, 5, 0};
    return fastest_over_k(sheet, 1).gamma /
           (drift * drift * lower_hybrid_frequency(plasma_at(sheet, 1)));
}

// Growth rate of the shear layer U = tanh y between walls at +-9, from finite differences of order
// h^2: the eigenvalues c of (d^2/dy^2 - k^2)^-1 [U (d^2/dy^2 - k^2) - U''].
double shear_layer_by_eigenvalues(double k, int intervals) {
    const double h = 18.0 / intervals;
    const int n = intervals - 1;
    Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd U(n), curvature(n);
    for (int j = 0; j < n; ++j) {
        U[j] = std::tanh(-9 + h * (j + 1));
        curvature[j] = -2 * U[j] * (1 - U[j] * U[j]);
        laplacian(j, j) = -2 / (h * h) - k * k;
        if (j > 0) laplacian(j, j - 1) = laplacian(j - 1, j) = 1 / (h * h);
    }
    Eigen::MatrixXd right = U.asDiagonal() * laplacian;
    right.diagonal() -= curvature;
    const Eigen::MatrixXd advance = laplacian.partialPivLu().solve(right);
    return k * advance.eigenvalues().imag().maxCoeff();
}

}  // namespace

TEST_CASE("the roots of the drift dispersion relation are zeros of an independent evaluation") {
    int growing = 0;
    for (const CurrentSheet& sheet : sheets())
        for (const auto& [z, scaled] : places) {
            const double k = wave_number(plasma_at(sheet, z), scaled);
            const LocalWave w = local_root(sheet, z, k);
            CHECK((w.found || sheet.grad_B));
            if (!(w.gamma > 0.02 * k * sheet.drift)) continue;
            ++growing;
            const Complex root(w.omega, w.gamma), aside = root * (1.0 + 1e-3 * i);
            const double here = std::abs(dispersion_from_scratch(sheet, z, k, root));
            // A root that errs by 1e-8.
            CHECK(here <= 1e-5 * std::abs(dispersion_from_scratch(sheet, z, k, aside)));
        }
    CHECK(growing >= 20);
}

TEST_CASE("the principle of the argument finds no growing wave that was missed") {
    for (const CurrentSheet& sheet : sheets())
        for (const auto& [z, scaled] : places) {
            const LocalPlasma plasma = plasma_at(sheet, z);
            const double k = wave_number(plasma, scaled);
            const auto D = drift_dispersion(plasma, k);
            const double unit = k * plasma.streams[0].u_i, low = 1e-3 * unit;
            const double size = 20 * (unit + k * plasma.v_i + lower_hybrid_frequency(plasma));
            const LocalWave w = local_root(sheet, z, k);
            CHECK(std::abs(zeros_in_box(D, size, low, size) - (w.gamma > low ? 1 : 0)) <= 1e-6);
        }
}

TEST_CASE("cold electrons let the wave into the sheet and hot ones keep it out") {
    // Electrons whose guiding centers drift in grad B with the wave damp it.
    const auto growth = [](double temperature_ratio, double z, bool grad_B) {
        CurrentSheet sheet = thin_sheet(temperature_ratio);
        sheet.grad_B = grad_B;
        return fastest_over_k(sheet, z).gamma;
    };
    CHECK(growth(1, 0.7, true) <= 1e-6);
    CHECK(growth(10, 0.7, true) >= 0.5 * growth(10, 0.7, false));
    for (const double ratio : {1.0, 2.0, 4.0}) {
        CHECK(growth(2 * ratio, 1, true) > growth(ratio, 1, true));
        CHECK(growth(2 * ratio, 1, false) < growth(ratio, 1, false));
        // Outside B is uniform.
        CHECK(std::abs(growth(ratio, 3, true) / growth(ratio, 3, false) - 1) <= 0.01);
    }
}

TEST_CASE("a sheet without background is unstable to every wave at every height") {
    for (CurrentSheet sheet : sheets()) {
        sheet.background = 0, sheet.grad_B = false;
        for (const auto& [z, scaled] : places) {
            const LocalWave w = local_root(sheet, z, wave_number(plasma_at(sheet, z), scaled));
            CHECK(w.gamma > 0);
            CHECK(w.omega > 0);
            CHECK(w.omega < w.k * sheet.drift * sheet.drift);
        }
    }
}

TEST_CASE("a plasma without drift is stable") {
    for (const CurrentSheet& sheet : sheets())
        for (const auto& [z, scaled] : places) {
            LocalPlasma plasma = plasma_at(sheet, z);
            const double k = wave_number(plasma, scaled);
            plasma.streams[0].u_i = plasma.streams[0].u_e = 0;
            const auto D = drift_dispersion(plasma, k);
            const double unit = lower_hybrid_frequency(plasma) + k * plasma.v_i;
            CHECK(std::abs(zeros_in_box(D, 20 * unit, 1e-3 * unit, 20 * unit)) <= 1e-6);
        }
}

TEST_CASE("weakly drifting sheets grow at the rate of Davidson and Gladd and Wu and Huba") {
    // From D with zeta << 1 and b << 1, where it is a quadratic equation for omega: the wave of
    // k (T_i / m_i)^1/2 = omega_lh grows fastest, with omega = k u_i / 2 and
    //   gamma = (2 pi)^1/2 / 8 (u_i / v_i)^2 omega_lh,  v_i = (2 T_i / m_i)^1/2
    const double exact = std::sqrt(2 * pi) / 8;
    const double wide = scaled_growth(0.1) / exact - 1, narrow = scaled_growth(0.05) / exact - 1;
    CHECK(std::abs(narrow) <= 0.01);
    // What the limit leaves out is of second order in the drift.
    CHECK(std::abs(wide / narrow - 4) <= 0.1);

    const CurrentSheet sheet{1836, 1e6, 0.01, 5, 0};
    const LocalWave w = fastest_over_k(sheet, 1);
    const double k = std::numbers::sqrt2 * lower_hybrid_frequency(plasma_at(sheet, 1)) / 0.01;
    CHECK(std::abs(w.k / k - 1) <= 0.01);
    CHECK(std::abs(w.omega / (w.k * 0.01 * 0.01) - 0.5) <= 0.005);
}

TEST_CASE("the thin sheet of the talk grows as in an independent program") {
    // T_i / T_e, and gamma at three heights.
    const double table[][4] = {{1, 3.00, 3.185, 2.78},
                               {2, 2.76, 3.00, 2.68},
                               {4, 2.58, 2.85, 2.59},
                               {10, 2.45, 2.73, 2.52}};
    const double heights[] = {1, 1.5, 2};
    // k and omega at the second of them.
    const double waves[][2] = {{15.5, 6.5}, {16.0, 7.6}, {16.5, 8.4}, {17.0, 8.9}};
    for (int n = 0; n < 4; ++n) {
        for (int j = 0; j < 3; ++j) {
            const LocalWave w = fastest_over_k(thin_sheet(table[n][0]), heights[j]);
            CHECK(std::abs(w.gamma - table[n][j + 1]) <= 0.006);
        }
        const LocalWave w = fastest_over_k(thin_sheet(table[n][0]), 1.5);
        CHECK(std::abs(w.k - waves[n][0]) <= 0.3);
        CHECK(std::abs(w.omega - waves[n][1]) <= 0.1);
    }
    // gamma of mode m in a sheet of length 4 L, T_i / T_e = 4, at z = 1.5.
    const double modes[][2] = {{4, 0.50},  {6, 1.47},  {8, 2.44}, {9, 2.71},
                               {10, 2.83}, {12, 2.76}, {14, 2.46}};
    for (const auto& [m, gamma] : modes)
        CHECK(std::abs(local_root(thin_sheet(4), 1.5, m * pi / 2).gamma - gamma) <= 0.006);
}

TEST_CASE("the sheet of a published moment model grows as in an independent program" *
          doctest::description("physics")) {
    // m_i / m_e = 36, T_i / T_e = 10, beta_e = 1/11 and v_e = 0.06 c.
    const CurrentSheet sheet{36, 10, 1, std::sqrt(1 / 11.0) / 0.06, 0};
    const LocalWave w = fastest_local_wave(sheet);
    CHECK(std::abs(w.gamma - 1.22) <= 0.005);
    CHECK(std::abs(w.k - 7.5) <= 0.05);
    CHECK(std::abs(fastest_over_z(sheet, w.k).gamma - w.gamma) <= 1e-4);
    CHECK(std::abs(fastest_over_z(sheet, w.k).z - w.z) <= 0.02);
}

TEST_CASE("local waves as fast as electrons gyrate are none of the theory") {
    const CurrentSheet pairs{1, 1, 1, 20, 0};
    const LocalWave fast = local_root(pairs, 1.6, 2);
    CHECK(std::hypot(fast.omega, fast.gamma) > 0.5 * std::tanh(1.6));
    CHECK(fast.gamma > 0);
    CHECK(!(fastest_over_z(pairs, 2).gamma > 0));
}

TEST_CASE("a resting background of a tenth stops the wave at the edge but not inside") {
    const auto growth = [](double background, double z) {
        return fastest_over_k(thin_sheet(4, background), z).gamma;
    };
    CHECK(growth(0.1, 2) <= 0.1 * growth(0, 2));
    CHECK(growth(0.1, 1) >= 0.5 * growth(0, 1));
    CHECK(growth(0.01, 2) >= 0.75 * growth(0, 2));
}

TEST_CASE("the searches find the largest growth rate of a dense table") {
    const CurrentSheet sheet = thin_sheet(2, 0.01);
    double over_z = 0, over_k = 0;
    for (int n = 0; n < 400; ++n) {
        over_z = std::max(over_z, local_root(sheet, 0.2 + 0.01 * n, 9).gamma);
        over_k = std::max(over_k, local_root(sheet, 2, 2 + 0.1 * n).gamma);
    }
    const double by_z = fastest_over_z(sheet, 9).gamma, by_k = fastest_over_k(sheet, 2).gamma;
    CHECK(by_z >= over_z);
    CHECK(by_z <= over_z * (1 + 1e-3));
    CHECK(by_k >= over_k);
    CHECK(by_k <= over_k * (1 + 1e-3));
}

TEST_CASE("shooting and eigenvalues give the same growth of a shear layer") {
    // Longer waves would feel the walls, shorter ones have a critical layer finer than the mesh.
    for (const double ka : {0.45, 0.55, 0.65}) {
        const double coarse = shear_layer_by_eigenvalues(ka, 120);
        const double fine = shear_layer_by_eigenvalues(ka, 240);
        CHECK(std::abs(shear_layer_growth(ka) - (4 * fine - coarse) / 3) <= 5e-4);
    }
}

TEST_CASE("a shear layer grows fastest at its known wave number and rate") {
    const double fastest = shear_layer_growth(0.4446);
    CHECK(std::abs(fastest - 0.1897) <= 5e-5);
    for (const double ka : {0.2, 0.4, 0.43, 0.46, 0.5, 0.7})
        CHECK(shear_layer_growth(ka) < fastest);
}

TEST_CASE("a shear layer is a vortex sheet to long waves and neutral to short ones") {
    for (const double ka : {0.001, 0.01, 0.1}) {
        CHECK(shear_layer_growth(ka) < ka);
        CHECK(shear_layer_growth(ka) > ka * (1 - 2 * ka));
    }
    // gamma = (2 / pi) (1 - ka) to first order around the neutral wave ka = 1, phi = sech y.
    for (const double ka : {0.9, 0.95, 0.98})
        CHECK(std::abs(shear_layer_growth(ka) / (1 - ka) - 2 / pi) <= 0.6 * (1 - ka));
    CHECK(shear_layer_growth(1) == 0);
    CHECK(shear_layer_growth(1.5) == 0);
}
