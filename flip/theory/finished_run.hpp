// What a finished run hands to its comparison with theory, and how rates are read from its history.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "common/run/summary.hpp"
#include "common/theory/fit_growth.hpp"
#include "flip/theory/follow.hpp"

namespace flip {

/// A run at its end.
struct FinishedRun {
    const Case& w;
    const std::string& program;
    const State& state;
    const Totals& totals;
    const CellFields& cells;
    const common::History& history;
    std::string profile;  // path of profile.dat
    common::Summary& summary;

    /// A result that may differ from theory by the tolerance of the case, relative.
    void result(const std::string& name, double value, const std::string& unit, double expected,
                const std::string& source) const {
        summary.result(name, value, unit, expected, w.theory_tolerance * std::fabs(expected),
                       source);
    }
};

/// Slope of the straight line of least squares.
/// out:    0 for fewer than two different times
inline double slope(const std::vector<double>& t, const std::vector<double>& y,
                    std::size_t begin = 0) {
    if (begin + 2 > t.size()) return 0;
    return common::growth_detail::RunningSums(t, y).line(begin, t.size()).slope;
}

/// Phase and size of a mode that turns by less than half a turn from sample to sample.
struct Spiral {
    std::vector<double> phase, log_size;
};
inline Spiral unwound(const std::vector<double>& re, const std::vector<double>& im) {
    Spiral s;
    for (std::size_t n = 0; n < re.size(); ++n) {
        const double phase = std::atan2(im[n], re[n]);
        const double before = s.phase.empty() ? phase : s.phase.back();
        s.phase.push_back(before + std::remainder(phase - before, 2 * pi));
        s.log_size.push_back(std::log(std::max(std::hypot(re[n], im[n]), 1e-300)));
    }
    return s;
}

/// z(t) = A cosh(rate t) + B sinh(rate t), with complex A and B.
struct HyperbolicFit {
    double rate = 0;
    double misfit = 0;  // rms of the rest, relative to that of z
    long samples = 0;
};

namespace detail {

// Sum of |z - A cosh - B sinh|^2 for the best A and B.
inline double hyperbolic_misfit(const std::vector<double>& t,
                                const std::vector<std::complex<double>>& z, std::size_t count,
                                double rate) {
    double cc = 0, cs = 0, ss = 0;
    std::complex<double> cz = 0, sz = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const double c = std::cosh(rate * t[n]), s = std::sinh(rate * t[n]);
        cc += c * c, cs += c * s, ss += s * s;
        cz += c * z[n], sz += s * z[n];
    }
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 1e-14 * cc * ss)) return std::numeric_limits<double>::infinity();
    const std::complex<double> A = (ss * cz - cs * sz) / determinant,
                               B = (cc * sz - cs * cz) / determinant;
    double rest = 0;
    for (std::size_t n = 0; n < count; ++n)
        rest += std::norm(z[n] - A * std::cosh(rate * t[n]) - B * std::sinh(rate * t[n]));
    return rest;
}

}  // namespace detail

/// The growth rate of a linear instability from its very start, where the growing and the decaying
/// wave are both there.
/// in:     t from 0; z; the first `count` samples are used; rates from expected/5 to 5 expected
inline HyperbolicFit fit_hyperbolic(const std::vector<double>& t,
                                    const std::vector<std::complex<double>>& z, std::size_t count,
                                    double expected) {
    HyperbolicFit fit;
    if (count < 5 || !(expected > 0)) return fit;
    const auto misfit = [&](double log_rate) {
        return detail::hyperbolic_misfit(t, z, count, std::exp(log_rate));
    };
    // Find the valley, then narrow it by golden sections.
    const double low = std::log(expected / 5), step = std::log(25.0) / 100;
    double best = low, smallest = std::numeric_limits<double>::infinity();
    for (int n = 0; n <= 100; ++n) {
        const double here = misfit(low + n * step);
        if (here < smallest) smallest = here, best = low + n * step;
    }
    const double part = 0.5 * (std::sqrt(5.0) - 1);
    double a = best - step, b = best + step;
    for (int n = 0; n < 60; ++n) {
        const double left = b - part * (b - a), right = a + part * (b - a);
        (misfit(left) < misfit(right) ? b : a) = misfit(left) < misfit(right) ? right : left;
    }
    double squares = 0;
    for (std::size_t n = 0; n < count; ++n) squares += std::norm(z[n]);
    fit.rate = std::exp(0.5 * (a + b));
    fit.misfit = std::sqrt(misfit(0.5 * (a + b)) / squares);
    fit.samples = static_cast<long>(count);
    return fit;
}

}  // namespace flip
