// Growth rates measured from the history of a run.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace common {

/// a(t) ~ exp(rate t) for begin <= t <= end.
struct GrowthFit {
    double rate = 0.0, rate_error = 0.0;  // error: one standard deviation
    double begin = 0.0, end = 0.0;
    long samples = 0;
    bool found = false;
    std::string reason = "found";
};

namespace growth_detail {

struct Line {
    double slope = 0.0, intercept = 0.0, misfit_squared = 0.0;  // misfit: sum over the samples
};

/// Sums that give the straight line through any stretch of samples at once.
struct RunningSums {
    std::vector<double> x, y, xx, xy, yy;

    RunningSums(std::span<const double> t, std::span<const double> f)
        : x(1, 0.0), y(1, 0.0), xx(1, 0.0), xy(1, 0.0), yy(1, 0.0) {
        const double middle = 0.5 * (t.front() + t.back());
        for (std::size_t n = 0; n < t.size(); ++n) {
            const double dx = t[n] - middle;
            x.push_back(x.back() + dx);
            y.push_back(y.back() + f[n]);
            xx.push_back(xx.back() + dx * dx);
            xy.push_back(xy.back() + dx * f[n]);
            yy.push_back(yy.back() + f[n] * f[n]);
        }
    }

    // The line of least squares through samples begin .. end - 1.
    Line line(std::size_t begin, std::size_t end) const {
        const double n = static_cast<double>(end - begin);
        const double X = (x[end] - x[begin]) / n, Y = (y[end] - y[begin]) / n;
        const double XX = xx[end] - xx[begin] - n * X * X, XY = xy[end] - xy[begin] - n * X * Y;
        const double YY = yy[end] - yy[begin] - n * Y * Y;
        const double slope = XY / XX;
        return {slope, Y - slope * X, std::max(YY - slope * XY, 0.0)};
    }
};

/// The middle value; of an even number of values the upper middle one.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace growth_detail

struct GrowthWindow {
    double above_start = 3.0;      // the window begins at this multiple of the level at the start
    double below_maximum = 0.2;    // and ends at this fraction of the maximum
    double start_fraction = 0.05;  // of all samples, whose median is the level at the start
    double least_stretch = 0.5;    // of the growth in the window, in logarithm, must be used
};

/// The growth rate of an amplitude, from the straightest stretch of its logarithm.
///   1. candidates: from the last time below above_start * (median of the first samples) to the
///      first time above below_maximum * (maximum)
///   2. of all stretches of candidates over which ln a grows by at least least_stretch of its
///      growth over the candidates, the one whose slope has the smallest relative standard error
///   3. rate and error from the line of least squares through ln a; the error counts correlated
///      samples as fewer: it is multiplied by [(1 + r) / (1 - r)]^1/2, r the correlation of
///      neighboring residuals
/// in:    times, increasing; amplitude of the same length, not negative. An energy grows at twice
///        the rate of an amplitude.
/// exact: for a pure exponential
inline GrowthFit fit_growth(std::span<const double> times, std::span<const double> amplitude,
                            const GrowthWindow& window = {}) {
    GrowthFit fit;
    const std::size_t count = std::min(times.size(), amplitude.size());
    fit.reason = "the signal is too short or not finite";
    const auto finite = [](double a) { return std::isfinite(a); };
    if (count < 8 || !std::all_of(amplitude.begin(), amplitude.end(), finite)) return fit;

    // Find the candidates.
    const auto first_samples = std::clamp<std::size_t>(
        static_cast<std::size_t>(window.start_fraction * static_cast<double>(count)), 1, count);
    const double start = growth_detail::median(
        {amplitude.begin(), amplitude.begin() + static_cast<std::ptrdiff_t>(first_samples)});
    const double low = window.above_start * start;
    const double high =
        window.below_maximum * *std::max_element(amplitude.begin(), amplitude.end());
    std::size_t end = 0;
    while (end < count && amplitude[end] < high) ++end;
    std::size_t begin = end;
    while (begin > 0 && amplitude[begin - 1] > low && amplitude[begin - 1] > 0.0) --begin;
    fit.reason = "the amplitude does not grow far enough above its start";
    if (!(high > 2.0 * low) || end < begin + 6) return fit;

    // Find the straightest stretch of at most 200 x 200 stretches.
    std::vector<double> logarithm;
    for (std::size_t n = begin; n < end; ++n) logarithm.push_back(std::log(amplitude[n]));
    const std::span<const double> t = times.subspan(begin, end - begin);
    const growth_detail::RunningSums sums(t, logarithm);
    const std::size_t stride = 1 + t.size() / 200;
    const double all = sums.line(0, t.size()).slope * (t.back() - t.front());
    double smallest = std::numeric_limits<double>::infinity();
    std::size_t from = 0, to = 0;
    for (std::size_t i = 0; i + 5 <= t.size(); i += stride)
        for (std::size_t j = t.size(); j >= i + 5; j -= std::min(stride, j)) {
            const auto line = sums.line(i, j);
            if (!(line.slope * (t[j - 1] - t[i]) >= window.least_stretch * all)) continue;
            const double length = t[j - 1] - t[i], n = static_cast<double>(j - i);
            // The standard error of a slope is proportional to this. Round-off counts as misfit.
            const double error = std::sqrt((line.misfit_squared + 1e-20 * n) / (n * (n - 2.0))) /
                                 (length * line.slope);
            if (error < smallest) {
                smallest = error;
                from = i;
                to = j;
            }
        }
    fit.reason = "the amplitude does not grow";
    if (to == 0 || !(all > 0.0)) return fit;

    // Fit it.
    const auto line = sums.line(from, to);
    const double middle_t = 0.5 * (t.front() + t.back()), n = static_cast<double>(to - from);
    double mean_t = 0.0, spread = 0.0, squares = 0.0, products = 0.0, before = 0.0;
    for (std::size_t k = from; k < to; ++k) mean_t += t[k] / n;
    for (std::size_t k = from; k < to; ++k) {
        const double residual = logarithm[k] - line.intercept - line.slope * (t[k] - middle_t);
        spread += (t[k] - mean_t) * (t[k] - mean_t);
        squares += residual * residual;
        products += residual * before;
        before = residual;
    }
    const double r = squares > 0.0 ? std::clamp(products / squares, 0.0, 0.99) : 0.0;
    fit.rate = line.slope;
    fit.rate_error = std::sqrt(squares / (n - 2.0) / spread * (1.0 + r) / (1.0 - r));
    fit.begin = t[from];
    fit.end = t[to - 1];
    fit.samples = static_cast<long>(to - from);
    fit.found = true;
    fit.reason = "found";
    return fit;
}

}  // namespace common
