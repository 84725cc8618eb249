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

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "cic/setup/distribution.hpp"

namespace cic {

/// The series of one distribution. holds() says whether it may be used in the place of the table.
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
                if (b_.empty() || error < least) least = error, L_ = one.L_, b_ = one.b_;
            }
        }
        holds_ = worst(*this, 0) < 1e-4 && agrees_with(f, backward);
    }

    /// Whether the series has the waves that are not damped, as the table has them: not where f has
    /// steps, also where it ends, or is finer than the terms.
    bool holds() const { return holds_; }

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
        const double mean = f.mean();
        const int pieces = 1024;  // of a tail
        const long count = std::ssize(f.f);
        Eigen::ArrayXd angle(count + 2 * pieces), part = Eigen::ArrayXd::Zero(angle.size());
        for (long j = 0; j < count; ++j)
            angle[j] = 2 * std::atan((f.middle(j) - mean) / L), part[j] = f.within(j);
        for (const bool upper : {false, true}) {
            const double last = upper ? f.f[count - 1] : f.f[0],
                         before = upper ? f.f[count - 2] : f.f[1],
                         end = std::fabs(f.edge(upper ? count : 0) - mean),
                         power = last > 0 ? (before / last - 1) * end / f.step : 0,
                         from = 2 * std::atan(end / L), step = (std::numbers::pi - from) / pieces;
            const bool falls = power > 2 && power < 100;
            for (long j = 0; j < pieces; ++j) {
                const double turn = from + (double(j) + 0.5) * step, w = L * std::tan(0.5 * turn);
                const long at = count + (upper ? pieces : 0) + j;
                angle[at] = upper ? turn : -turn;
                if (falls)
                    part[at] = last * std::pow(end / w, power) * (L * L + w * w) / (2 * L) * step;
            }
        }
        const Eigen::ArrayXcd back = (Complex(0, backward ? 1 : -1) * angle).exp();
        Eigen::ArrayXcd term = L / std::numbers::pi * part;
        std::vector<Complex> b;
        for (int n = 0; n <= 96; ++n) b.push_back(term.sum()), term *= back;
        return b;
    }

    // dH/dc five pieces above the axis, where sums over the table are exact to 1e-10, beside the series.
    bool agrees_with(const Distribution& f, bool backward) const {
        const long count = std::ssize(f.f);
        const double y = 5 * f.step;
        const Eigen::Map<const Eigen::ArrayXd> density(f.f.data(), count);
        const Eigen::ArrayXd v = Eigen::ArrayXd::LinSpaced(count, f.middle(0), f.middle(count - 1));
        double largest = 0, apart = 0;
        for (long n = 0; n < count; n += 5) {
            // (v - c)^-2 = (x + i y)^2 / (x^2 + y^2)^2
            const Eigen::ArrayXd x = v - v[n], weight = density / (x.square() + y * y).square();
            const Complex direct(f.step * (weight * (x.square() - y * y)).sum(),
                                 f.step * (weight * 2 * x * y).sum());
            // Of f(-v) it is the conjugate one at -conj(c).
            const Complex series =
                backward ? std::conj(at(Complex(-v[n], y)).slope) : at(Complex(v[n], y)).slope;
            largest = std::max(largest, std::abs(direct));
            apart = std::max(apart, std::abs(direct - series));
        }
        return apart <= 1e-6 * largest;
    }

    double mean_, L_ = 1;
    bool holds_ = false;
    std::vector<Complex> b_;
};

}  // namespace cic
