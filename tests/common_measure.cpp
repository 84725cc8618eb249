// Facts about the measurement of frequencies and growth rates from sampled signals.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "common/random.hpp"
#include "common/theory/fit_growth.hpp"
#include "common/theory/fit_oscillation.hpp"

namespace {

std::vector<double> wave(int n, double dt, double frequency, double growth, double amplitude,
                         double phase, double noise, std::uint64_t seed) {
    std::vector<double> y;
    for (int i = 0; i < n; ++i)
        y.push_back(amplitude * std::cos(frequency * i * dt + phase) * std::exp(growth * i * dt) +
                    noise * common::gaussian(seed, 0, i, 0));
    return y;
}

std::vector<double> even_times(int n, double dt) {
    std::vector<double> t;
    for (int i = 0; i < n; ++i) t.push_back(i * dt);
    return t;
}

}  // namespace

TEST_CASE("prediction finds frequency and damping of a clean oscillation exactly") {
    for (const double frequency : {0.03, 0.7, 2.5})
        for (const double growth : {-0.05, -0.001, 0.0, 0.02})
            for (const std::size_t m : {1u, 3u}) {
                const double dt = 0.3;
                const auto y = wave(200, dt, frequency, growth, 1e-3, 0.4, 0.0, 0);
                const auto fit = common::predict_oscillation(y, dt, m);
                CHECK(fit.found);
                CHECK(std::abs(fit.frequency - frequency) <= 1e-9 * (1.0 + frequency));
                CHECK(std::abs(fit.growth - growth) <= 1e-9);
                CHECK(std::abs(fit.amplitude - 1e-3) <= 1e-9);
                CHECK(std::abs(fit.phase - 0.4) <= 1e-6);
                CHECK(fit.misfit <= 1e-6);
            }
}

TEST_CASE("the nonlinear fit finds a clean oscillation exactly too") {
    const auto y = wave(300, 0.1, 1.4156, -0.1533, 0.01, -1.0, 0.0, 0);
    const auto fit = common::fit_oscillation(y, 0.1);
    CHECK(fit.found);
    CHECK(std::abs(fit.frequency - 1.4156) <= 1e-9);
    CHECK(std::abs(fit.growth + 0.1533) <= 1e-9);
    CHECK(std::abs(fit.phase + 1.0) <= 1e-8);
}

TEST_CASE("the nonlinear fit is right within its errors in noise that ruins prediction") {
    const double dt = 0.05, frequency = 1.4, growth = -0.03;
    int within_frequency = 0, within_growth = 0;
    double bias = 0.0;
    for (int seed = 0; seed < 40; ++seed) {
        const auto y = wave(800, dt, frequency, growth, 1.0, 0.7, 0.3, seed);
        const auto fit = common::fit_oscillation(y, dt);
        CHECK(fit.found);
        CHECK(std::abs(fit.frequency - frequency) <= 5.0 * fit.frequency_error);
        CHECK(std::abs(fit.growth - growth) <= 5.0 * fit.growth_error);
        CHECK(fit.frequency_error <= 0.01);
        within_frequency += std::abs(fit.frequency - frequency) <= fit.frequency_error;
        within_growth += std::abs(fit.growth - growth) <= fit.growth_error;
        bias += (fit.growth - growth) / 40.0;
        const auto naive = common::predict_oscillation(y, dt, 1);
        CHECK((!naive.found || std::abs(naive.growth - growth) > 0.3));
    }
    // 68 % of 40 is 27, with a standard deviation of 3.
    CHECK(within_frequency >= 18);
    CHECK(within_frequency <= 36);
    CHECK(within_growth >= 18);
    CHECK(within_growth <= 36);
    CHECK(std::abs(bias) <= 0.003);
}

TEST_CASE("a signal that cannot be an oscillation is reported") {
    const std::vector<double> zero(100, 0.0), short_one(3, 1.0);
    std::vector<double> decay, broken(100, 1.0);
    for (int i = 0; i < 100; ++i) decay.push_back(std::exp(-0.1 * i) + 0.5 * std::exp(-0.2 * i));
    broken[50] = std::numeric_limits<double>::quiet_NaN();
    for (const auto& y : {zero, short_one, decay, broken})
        CHECK_FALSE(common::predict_oscillation(y, 1.0).found);
    for (const auto& y : {zero, short_one, broken})
        CHECK_FALSE(common::fit_oscillation(y, 1.0).found);
}

TEST_CASE("a rotating mode gives its factor exactly and its sense by the sign") {
    for (const double frequency : {-1.2, -0.01, 0.3, 3.0}) {
        const std::complex<double> g = std::polar(0.99, frequency * 0.9);
        std::vector<std::complex<double>> z{{0.3, -0.4}};
        for (int n = 0; n < 50; ++n) z.push_back(g * z.back());
        const auto fit = common::fit_rotation(z, 0.9);
        CHECK(fit.found);
        CHECK(std::abs(fit.factor - g) <= 1e-14);
        CHECK(std::abs(fit.frequency - frequency) <= 1e-13);
        CHECK(std::abs(fit.growth - std::log(0.99) / 0.9) <= 1e-13);
    }
    const std::vector<std::complex<double>> nothing(10, 0.0);
    CHECK_FALSE(common::fit_rotation(nothing, 1.0).found);
}

TEST_CASE("the growth of a pure exponential is exact") {
    const auto t = even_times(400, 0.1);
    std::vector<double> a;
    for (const double time : t) a.push_back(1e-6 * std::exp(0.35 * time));
    const auto fit = common::fit_growth(t, a);
    CHECK(fit.found);
    CHECK(std::abs(fit.rate - 0.35) <= 1e-10);
    CHECK(fit.rate_error <= 1e-10);
    CHECK(fit.begin < fit.end);
}

TEST_CASE("growth out of noise into saturation is measured between the two") {
    // A mode with dA/dt = 0.3 A (1 - A^2) from 1e-3 under noise of 3e-3; it oscillates at the end.
    for (int seed = 0; seed < 20; ++seed) {
        const auto t = even_times(1000, 0.06);
        std::vector<double> a;
        for (std::size_t i = 0; i < t.size(); ++i) {
            const double mode = 1e-3 * std::exp(0.3 * t[i]);
            const double level =
                mode / std::sqrt(1.0 + mode * mode) * (1.0 - 0.2 * (mode > 3.0) * std::sin(t[i]));
            a.push_back(std::hypot(level + 3e-3 * common::gaussian(seed, 0, i, 0),
                                   3e-3 * common::gaussian(seed, 1, i, 0)));
        }
        const auto fit = common::fit_growth(t, a);
        CHECK(fit.found);
        CHECK(fit.begin >= 5.0);
        CHECK(fit.end <= std::log(0.5 / 1e-3) / 0.3);
        CHECK(fit.end - fit.begin >= 4.0);
        CHECK(std::abs(fit.rate - 0.3) <= 0.03);
    }
}

TEST_CASE("the error of a growth rate covers its scatter also for correlated noise") {
    int within = 0;
    for (int seed = 0; seed < 50; ++seed) {
        const auto t = even_times(300, 0.1);
        std::vector<double> a;
        double drift = 0.0;
        for (std::size_t i = 0; i < t.size(); ++i) {
            drift = 0.7 * drift + 0.05 * common::gaussian(seed, 2, i, 0);
            a.push_back(std::exp(0.4 * t[i] + drift));
        }
        const auto fit = common::fit_growth(t, a);
        CHECK(fit.found);
        CHECK(std::abs(fit.rate - 0.4) <= 0.02);
        within += std::abs(fit.rate - 0.4) <= 2.0 * fit.rate_error;
    }
    CHECK(within >= 38);
}

TEST_CASE("a signal that does not grow is reported") {
    const auto t = even_times(200, 0.1);
    std::vector<double> noise, decay, broken(200, 1.0);
    for (int i = 0; i < 200; ++i) {
        noise.push_back(std::abs(common::gaussian(3, 0, i, 0)));
        decay.push_back(std::exp(-0.1 * i));
    }
    broken[3] = std::numeric_limits<double>::infinity();
    const std::vector<double> zero(200, 0.0), few(5, 1.0);
    for (const auto& a : {noise, decay, broken, zero, few})
        CHECK_FALSE(common::fit_growth(t, a).found);
}
