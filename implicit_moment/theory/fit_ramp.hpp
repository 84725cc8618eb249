// Growth out of a level: what is fitted to the kink of a thin current sheet.
#pragma once

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"
#include "common/run/summary.hpp"

namespace implicit_moment {

/// An exponential that rises out of a level and goes over into another one, slower, flat or falling.
struct Ramp {
    common::Measured growth = std::nan("");  // nine of ten are nearer than the error
    double begin = 0, end = 0;               // of the rise
    double height = 0, later = 0;            // of the level; growth after the rise
    std::string reason;                      // why there is none; empty when there is one

    double operator()(double t) const {
        return std::log(height) + growth.value * (std::clamp(t, begin, end) - begin) +
               later * std::max(t - end, 0.0);
    }
};

namespace detail {

// A record in 200 equal parts of its time: means of t and of ln a, and the sums that lines through some of them need.
class LogRecord {
   public:
    static constexpr long parts = 200;
    std::vector<double> t, y;

    LogRecord(std::span<const double> times, std::span<const double> a, double begin)
        : begin_(begin), spacing_((times.back() - begin) / double(parts)) {
        std::vector<double> sum_t(parts), sum_y(parts), count(parts);
        for (std::size_t n = 0; n < times.size(); ++n) {
            if (times[n] < begin || !(a[n] > 0)) continue;
            const long part = std::min(long((times[n] - begin) / spacing_), parts - 1);
            sum_t[part] += times[n], sum_y[part] += std::log(a[n]), count[part] += 1;
        }
        for (long part = 0; part < parts; ++part) {
            first_.push_back(t.size());
            if (count[part] == 0) continue;
            t.push_back(sum_t[part] / count[part]), y.push_back(sum_y[part] / count[part]);
        }
        first_.push_back(t.size());
    }

    // The best level, line and line through some y, by the sums of 1, t, t^2, y and t y up to each part.
    Ramp best(const std::vector<double>& values) const {
        const std::size_t n = t.size();
        std::vector<double> T(n + 1), TT(n + 1), Y(n + 1), TY(n + 1);
        for (std::size_t k = 0; k < n; ++k) {
            T[k + 1] = T[k] + t[k], TT[k + 1] = TT[k] + t[k] * t[k];
            Y[k + 1] = Y[k] + values[k], TY[k + 1] = TY[k] + t[k] * values[k];
        }
        // Of what is counted from `from` in entries a to b: the sums of it, its square and itself times y.
        struct Sums {
            double r, rr, ry;
        };
        const auto sums = [&](double from, std::size_t a, std::size_t b) {
            const double count = double(b - a), first = T[b] - T[a];
            return Sums{first - from * count,
                        TT[b] - TT[a] - 2 * from * first + from * from * count,
                        TY[b] - TY[a] - from * (Y[b] - Y[a])};
        };
        Ramp found;
        double most = -1;  // of the squares that are explained
        for (long i = 0; i < parts; ++i) {
            for (long j = i + 4; j <= parts; ++j) {
                const double from = at(i), to = at(j), rise = to - from;
                const std::size_t a = first_[std::size_t(i)], b = first_[std::size_t(j)];
                const Sums in = sums(from, a, b), after = sums(to, b, n);
                const double beyond = double(n - b), all = double(n), r = in.r + beyond * rise,
                             rr = in.rr + beyond * rise * rise - r * r / all,
                             ry = in.ry + rise * (Y[n] - Y[b]) - r * Y[n] / all, q = after.r,
                             qq = after.rr - q * q / all, qy = after.ry - q * Y[n] / all,
                             rq = rise * q - r * q / all;
                const double determinant = rr * qq - rq * rq;
                const bool both = beyond > 3 && determinant > 1e-9 * rr * qq;
                if (!(rr > 0)) continue;
                const double growth = both ? (qq * ry - rq * qy) / determinant : ry / rr,
                             later = both ? (rr * qy - rq * ry) / determinant : 0,
                             explained = growth * ry + later * qy;
                if (explained <= most) continue;
                most = explained;
                found.growth = growth, found.later = later, found.begin = from, found.end = to;
                found.height = std::exp((Y[n] - growth * r - later * q) / all);
            }
        }
        return found;
    }

   private:
    double begin_, spacing_;
    std::vector<std::size_t> first_;  // entry at which a part begins
    double at(long part) const { return begin_ + double(part) * spacing_; }
};

}  // namespace detail

/// Fits ln a = ln h + gamma [clamp(t, t_1, t_2) - t_1] + gamma' max(t - t_2, 0) by least squares in h,
/// gamma, gamma', t_1 and t_2: a level, an exponential and what follows, with nobody choosing where they
/// meet.
/// in:     times, increasing, a > 0 of the same length; begin, when the first level is there
/// out:    the error is what 98 of 100 fits stay within, to the fit with its residuals drawn anew in
///         blocks that are twice as long as they remember; of noisy rises whose rate is known nine of
///         ten are nearer
/// exact:  to half a percent for such a record, because its corners lie within one of 200 parts
/// errors: `reason` where less than one e-folding lies between the levels
/// source: blocks: Kuensch, Ann. Statist. 17, 1217 (1989)
inline Ramp fit_ramp(std::span<const double> times, std::span<const double> a, double begin) {
    Ramp found;
    found.reason = "cannot be measured, because the record ends before the second phase";
    if (times.size() < 2 || times.back() <= begin) return found;
    const detail::LogRecord record(times, a, begin);
    const std::size_t n = record.t.size();
    if (n < std::size_t(record.parts / 4)) return found;
    found = record.best(record.y);

    std::vector<double> rest, line;
    double square = 0, product = 0;
    for (std::size_t k = 0; k < n; ++k) {
        line.push_back(found(record.t[k])), rest.push_back(record.y[k] - line[k]);
        square += rest[k] * rest[k], product += k > 0 ? rest[k] * rest[k - 1] : 0;
    }
    const double correlation = square > 0 ? std::clamp(product / square, 0.0, 0.98) : 0,
                 memory = (1 + correlation) / (1 - correlation);
    // Five numbers were fitted to so many independent ones: residuals are too small, and their tails too thin.
    const double independent = double(n) / memory, left = std::max(independent - 5, 2.0),
                 shrunk = std::sqrt(std::min(left / independent, 1.0)),
                 tails = gsl_cdf_tdist_Pinv(0.975, left) / gsl_cdf_ugaussian_Pinv(0.975);
    const std::size_t block = std::min(std::size_t(2 * memory), n / 4);
    std::mt19937_64 random(1);
    std::vector<double> misses, drawn(n);
    for (int draw = 0; draw < 200; ++draw) {
        for (std::size_t k = 0, from = 0; k < n; ++k, ++from) {
            if (k % block == 0) from = std::size_t(random() % (n - block + 1));
            drawn[k] = line[k] + rest[from] / shrunk;
        }
        misses.push_back(std::fabs(record.best(drawn).growth.value - found.growth.value));
    }
    std::ranges::sort(misses);
    found.growth.error = tails * misses[196];
    const double e_foldings = found.growth.value * (found.end - found.begin);
    if (!(e_foldings >= 1))
        found.reason = "cannot be measured, because only " +
                       format(std::round(100 * e_foldings) / 100) +
                       " e-foldings lie between the level before and what follows";
    return found;
}

}  // namespace implicit_moment
