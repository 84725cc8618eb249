// A smooth distribution by formula below the real axis, where its table says nothing: a series whose
// Hilbert transform is known term by term.
//
//     f(v) = sum_n b_n Z^n / (L^2 + w^2),   Z = (L + i w) / (L - i w),   w = v - mean,   -N <= n <= N
//
// With w = L tan(theta / 2) it is a Fourier series, Z = exp(i theta). Terms with n > 0 have their pole
// below the axis and those with n < 0 above it, so that for Im c > 0, with w = c - mean,
//     H(c) = int f dv / (v - c) = 2 pi i sum_(n > 0) b_n Z^(n-1) / (L - i w)^2 + i pi b_0 / (L (L - i w))
// and that is analytic down to w = -i L: Landau's continuation.
// source: Weideman, SIAM J. Numer. Anal. 31, 1497 (1994), for a Maxwellian.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "cic/setup/distribution.hpp"

namespace cic {

class SmoothDistribution {
   public:
    using Complex = std::complex<double>;

    /// in:     f, of velocities; backward, whether v points against k
    /// note:   L and N are those of a few whose last terms are smallest where waves are damped.
    SmoothDistribution(const Distribution& f, bool backward)
        : mean_(backward ? -f.mean() : f.mean()) {
        const double width = std::sqrt(f.mean_square(f.mean()));
        const auto worst = [&](const SmoothDistribution& one, double growth) {
            double error = 0;
            for (const double speed : {-4, -3, -2, -1, 0, 1, 2, 3, 4})
                error = std::max(error, one.at(mean_ + width * Complex(speed, growth)).error);
            return error;
        };
        double least = HUGE_VAL;
        for (const double L : {1.0, 2.0, 4.0, 8.0, 16.0}) {
            const std::vector<Complex> all = terms(f, L * width, backward);
            for (const std::size_t N : {24, 48, 96}) {
                const SmoothDistribution one(mean_, L * width, {all.begin(), all.begin() + N + 1});
                const double error = worst(one, -0.1);
                if (error < least) least = error, L_ = one.L_, b_ = one.b_;
            }
        }
        error_ = worst(*this, 0);
    }

    /// Whether the series has the waves that are not damped, to 1e-4: not where f has steps.
    bool holds() const { return error_ < 1e-4; }

    /// H, dH/dc, and what the last quarter of the terms adds to dH/dc, over it.
    struct Value {
        Complex H, slope;
        double error;
    };
    Value at(Complex c) const {
        const Complex i(0, 1), w = c - mean_, below = 1.0 / (L_ - i * w), Z = (L_ + i * w) * below,
                               turn = 2.0 * i * L_ * below * below;  // dZ/dc
        Complex sum = 0, slope = 0;
        double tail = 0;
        for (std::size_t n = b_.size() - 1; n > 0; --n) {
            slope = slope * Z + sum, sum = sum * Z + b_[n];
            if (4 * n > 3 * b_.size())
                tail += double(n) * std::abs(b_[n]) * std::pow(std::abs(Z), double(n) - 2);
        }
        const Complex by = 2 * std::numbers::pi * i * below * below,
                      mean = i * std::numbers::pi * b_[0] / L_ * below;
        Value value{by * sum + mean, by * (slope * turn + 2.0 * i * below * sum) + i * below * mean,
                    0};
        value.error = tail * std::abs(by * turn / value.slope);
        return value;
    }

   private:
    SmoothDistribution(double mean, double L, std::vector<Complex> b)
        : mean_(mean), L_(L), b_(std::move(b)) {}

    // b_n = (L / pi) int f Z^-n dv, n >= 0. Where the table ends a tail like a power goes on.
    static std::vector<Complex> terms(const Distribution& f, double L, bool backward) {
        std::vector<Complex> b(97);
        const double mean = f.mean(), sense = backward ? 1 : -1;
        const auto add = [&](double part, double angle) {
            const Complex back = std::polar(1.0, sense * angle);
            Complex term = L / std::numbers::pi * part;
            for (Complex& one : b) one += term, term *= back;
        };
        const auto angle_of = [&](double w) { return 2 * std::atan(w / L); };
        for (std::size_t j = 0; j < f.f.size(); ++j) add(f.within(j), angle_of(f.middle(j) - mean));
        for (const double side : {-1.0, 1.0}) {
            const double last = side < 0 ? f.f[0] : f.f.back(),
                         before = side < 0 ? f.f[1] : f.f[f.f.size() - 2],
                         end = (side < 0 ? f.edge(0) : f.edge(f.f.size())) - mean;
            const double power = (before / last - 1) * std::fabs(end) / f.step;
            if (!(power > 2 && power < 100)) continue;
            const int pieces = 1024;
            const double from = angle_of(std::fabs(end)), step = (std::numbers::pi - from) / pieces;
            for (int j = 0; j < pieces; ++j) {
                const double angle = from + (j + 0.5) * step, w = L * std::tan(0.5 * angle);
                add(last * std::pow(std::fabs(end) / w, power) * (L * L + w * w) / (2 * L) * step,
                    side * angle);
            }
        }
        return b;
    }

    double mean_, L_ = 1, error_ = 0;
    std::vector<Complex> b_;
};

}  // namespace cic
