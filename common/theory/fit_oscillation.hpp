// Frequencies measured from the history of a run.
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_fft_real.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace common {

/// y(t) = amplitude cos(frequency t + phase) exp(growth t), t = 0 at the first sample.
struct OscillationFit {
    double frequency = 0.0, growth = 0.0;  // [rad / time], [1 / time]; damping is negative growth
    double amplitude = 0.0, phase = 0.0;
    double frequency_error = 0.0, growth_error = 0.0;         // one standard deviation
    double misfit = std::numeric_limits<double>::infinity();  // rms of the rest / rms of y
    bool found = false;
    std::string reason = "found";

    /// The fitted y at time t.
    double at(double t) const {
        return amplitude * std::cos(frequency * t + phase) * std::exp(growth * t);
    }
};

/// z(t) ~ exp(i frequency t + growth t).
struct RotationFit {
    std::complex<double> factor = 0.0;  // from one sample to the next
    double frequency = 0.0, growth = 0.0;
    bool found = false;
};

namespace oscillation_detail {

/// Whether every value is finite.
inline bool all_finite(std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Amplitude, phase and misfit that go best with a frequency and a growth rate; where nothing does,
/// the misfit stays infinite.
///   y = exp(growth t) (C cos(frequency t) + S sin(frequency t))
inline void complete(OscillationFit& fit, std::span<const double> y, double dt) {
    // Beyond this, squares of the exponential overflow.
    if (!(fit.growth * static_cast<double>(y.size()) * dt < 300)) return;
    double cc = 0, cs = 0, ss = 0, yc = 0, ys = 0, yy = 0;
    for (std::size_t n = 0; n < y.size(); ++n) {
        const double t = static_cast<double>(n) * dt, size = std::exp(fit.growth * t);
        const double c = size * std::cos(fit.frequency * t);
        const double s = size * std::sin(fit.frequency * t);
        cc += c * c;
        cs += c * s;
        ss += s * s;
        yc += y[n] * c;
        ys += y[n] * s;
        yy += y[n] * y[n];
    }
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 0.0) || !(yy > 0.0)) return;
    const double C = (yc * ss - ys * cs) / determinant, S = (ys * cc - yc * cs) / determinant;
    fit.amplitude = std::hypot(C, S);
    fit.phase = std::atan2(-S, C);
    double rest = 0.0;
    for (std::size_t n = 0; n < y.size(); ++n) {
        const double difference = y[n] - fit.at(static_cast<double>(n) * dt);
        rest += difference * difference;
    }
    fit.misfit = std::sqrt(rest / yy);
}

/// The number of periods in the signal at which its spectrum is largest, at least 1.
inline std::size_t strongest_harmonic(std::span<const double> y) {
    std::vector<double> spectrum(y.begin(), y.end());
    const std::size_t n = y.size();
    const std::unique_ptr<gsl_fft_real_wavetable, decltype(&gsl_fft_real_wavetable_free)> table(
        gsl_fft_real_wavetable_alloc(n), gsl_fft_real_wavetable_free);
    const std::unique_ptr<gsl_fft_real_workspace, decltype(&gsl_fft_real_workspace_free)> work(
        gsl_fft_real_workspace_alloc(n), gsl_fft_real_workspace_free);
    gsl_fft_real_transform(spectrum.data(), 1, n, table.get(), work.get());
    std::size_t best = 1;
    const auto power = [&](std::size_t k) {
        return std::hypot(spectrum[2 * k - 1], spectrum[2 * k]);
    };
    for (std::size_t k = 2; 2 * k < n; ++k)
        if (power(k) > power(best)) best = k;
    return best;
}

struct Samples {
    std::span<const double> y;
    double dt = 1.0;
};

/// The rest y - f and its derivatives, with parameters (frequency, growth, C, S).
inline int rest(const gsl_vector* p, void* data, gsl_vector* f) {
    const auto& samples = *static_cast<const Samples*>(data);
    for (std::size_t n = 0; n < samples.y.size(); ++n) {
        const double t = static_cast<double>(n) * samples.dt, angle = gsl_vector_get(p, 0) * t;
        const double wave =
            gsl_vector_get(p, 2) * std::cos(angle) + gsl_vector_get(p, 3) * std::sin(angle);
        gsl_vector_set(f, n, std::exp(gsl_vector_get(p, 1) * t) * wave - samples.y[n]);
    }
    return GSL_SUCCESS;
}

/// The derivatives of these differences by the four parameters, as GSL asks for them.
inline int slopes(const gsl_vector* p, void* data, gsl_matrix* J) {
    const auto& samples = *static_cast<const Samples*>(data);
    const double C = gsl_vector_get(p, 2), S = gsl_vector_get(p, 3);
    for (std::size_t n = 0; n < samples.y.size(); ++n) {
        const double t = static_cast<double>(n) * samples.dt, angle = gsl_vector_get(p, 0) * t;
        const double size = std::exp(gsl_vector_get(p, 1) * t);
        const double c = size * std::cos(angle), s = size * std::sin(angle);
        gsl_matrix_set(J, n, 0, t * (S * c - C * s));
        gsl_matrix_set(J, n, 1, t * (C * c + S * s));
        gsl_matrix_set(J, n, 2, c);
        gsl_matrix_set(J, n, 3, s);
    }
    return GSL_SUCCESS;
}

/// Improves a fit by least squares with all four parameters free, and finds the errors.
inline OscillationFit improve(const OscillationFit& start, std::span<const double> y, double dt) {
    constexpr std::size_t parameters = 4;
    Samples samples{y, dt};
    gsl_multifit_nlinear_fdf problem{};
    problem.f = rest;
    problem.df = slopes;
    problem.n = y.size();
    problem.p = parameters;
    problem.params = &samples;

    gsl_error_handler_t* const handler = gsl_set_error_handler_off();
    const auto choices = gsl_multifit_nlinear_default_parameters();
    const std::unique_ptr<gsl_multifit_nlinear_workspace, decltype(&gsl_multifit_nlinear_free)>
        work(gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &choices, y.size(), parameters),
             gsl_multifit_nlinear_free);
    std::array<double, parameters> p{start.frequency, start.growth,
                                     start.amplitude * std::cos(start.phase),
                                     -start.amplitude * std::sin(start.phase)};
    const auto initial = gsl_vector_view_array(p.data(), parameters);
    int info = 0;
    gsl_multifit_nlinear_init(&initial.vector, &problem, work.get());
    // The library tries growth rates whose exponentials overflow; that is not for traps to see.
    std::fenv_t traps;
    std::feholdexcept(&traps);
    gsl_multifit_nlinear_driver(200, 1e-12, 1e-12, 0.0, nullptr, nullptr, &info, work.get());
    std::array<double, parameters * parameters> covariance{};
    auto matrix = gsl_matrix_view_array(covariance.data(), parameters, parameters);
    gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(work.get()), 0.0, &matrix.matrix);
    gsl_set_error_handler(handler);
    std::fesetenv(&traps);

    const gsl_vector* best = gsl_multifit_nlinear_position(work.get());
    OscillationFit fit;
    fit.frequency = gsl_vector_get(best, 0);
    fit.growth = gsl_vector_get(best, 1);
    complete(fit, y, dt);
    double squares = 0.0;
    for (const double value : y) squares += value * value;
    const double freedom = static_cast<double>(y.size() - parameters);
    const double variance = squares * fit.misfit * fit.misfit / freedom;
    fit.frequency_error = std::sqrt(variance * covariance[0]);
    fit.growth_error = std::sqrt(variance * covariance[parameters + 1]);
    fit.found = std::isfinite(fit.misfit);
    return fit;
}

}  // namespace oscillation_detail

/// Frequency and growth of a standing wave, from the recurrence that its samples obey.
///   y_n+m = a y_n + b y_n-m,  the roots of z^2 = a z + b are exp[(growth +- i frequency) m dt]
/// in:    y, evenly sampled; dt between samples; m, the distance of the samples compared
/// exact: for a signal without noise and frequency m dt < pi. Noise makes the result too damped;
///        m near a quarter of a period is best then, and fit_oscillation is better.
inline OscillationFit predict_oscillation(std::span<const double> y, double dt, std::size_t m = 1) {
    OscillationFit fit;
    fit.reason = "the signal is too short or not finite";
    if (y.size() < 2 * m + 2 || !oscillation_detail::all_finite(y)) return fit;

    // With z = 1 + d: y_n+m - 2 y_n + y_n-m = p y_n + q (y_n - y_n-m), d^2 = (p + q) d + p, which
    // keeps the digits when the frequency is low.
    double uu = 0, uv = 0, vv = 0, wu = 0, wv = 0;
    for (std::size_t n = m; n + m < y.size(); ++n) {
        const double u = y[n], v = y[n] - y[n - m], w = (y[n + m] - y[n]) - v;
        uu += u * u;
        uv += u * v;
        vv += v * v;
        wu += w * u;
        wv += w * v;
    }
    const double determinant = uu * vv - uv * uv;
    fit.reason = "the signal does not oscillate";
    if (!(determinant > 0.0)) return fit;
    const double p = (wu * vv - wv * uv) / determinant, q = (wv * uu - wu * uv) / determinant;
    const double middle = 0.5 * (p + q), discriminant = middle * middle + p;
    if (!(discriminant < 0.0)) return fit;
    const std::complex<double> z(1.0 + middle, std::sqrt(-discriminant));
    const double step = static_cast<double>(m) * dt;
    fit.frequency = std::arg(z) / step;
    fit.growth = std::log(std::abs(z)) / step;
    oscillation_detail::complete(fit, y, dt);
    fit.found = std::isfinite(fit.misfit);
    fit.reason = fit.found ? "found" : "no amplitude fits the signal";
    return fit;
}

/// Frequency and growth of a standing wave from noisy samples, by nonlinear least squares.
///   y = amplitude cos(frequency t + phase) exp(growth t) + noise
/// in:    y, evenly sampled, of zero mean but for the wave; dt between samples
/// out:   the fit, with the errors of white noise
/// note:  it starts from the peak of the spectrum with several growth rates and from recurrences
///        over about a quarter of that period, and keeps the end with the smallest misfit.
inline OscillationFit fit_oscillation(std::span<const double> y, double dt) {
    OscillationFit best;
    best.reason = "the signal is too short or not finite";
    if (y.size() < 8 || !oscillation_detail::all_finite(y)) return best;

    // Collect starts.
    const std::size_t periods = oscillation_detail::strongest_harmonic(y);
    const double duration = static_cast<double>(y.size()) * dt;
    std::vector<OscillationFit> starts;
    for (const std::size_t part : {4u, 6u, 12u})
        starts.push_back(
            predict_oscillation(y, dt, std::max<std::size_t>(1, y.size() / (part * periods))));
    for (const double growth : {-5.0 / duration, 0.0, 5.0 / duration}) {
        OscillationFit start;
        start.frequency = 2.0 * std::numbers::pi * static_cast<double>(periods) / duration;
        start.growth = growth;
        oscillation_detail::complete(start, y, dt);
        start.found = std::isfinite(start.misfit);
        starts.push_back(start);
    }

    // Keep the best end.
    best.reason = "the signal does not oscillate";
    for (const auto& start : starts) {
        if (!start.found) continue;
        const OscillationFit fit = oscillation_detail::improve(start, y, dt);
        if (fit.found && fit.misfit < best.misfit) best = fit;
    }
    best.frequency = std::abs(best.frequency);
    if (best.found) oscillation_detail::complete(best, y, dt);
    return best;
}

/// Frequency and growth of a single rotating mode.
///   z_n+1 = g z_n,  g = sum conj(z_n) z_n+1 / sum |z_n|^2
/// in:    z, evenly sampled; dt between samples
/// exact: without noise, for |frequency| dt < pi; frequency has the sign of exp(i frequency t)
inline RotationFit fit_rotation(std::span<const std::complex<double>> z, double dt) {
    std::complex<double> product = 0.0;
    double squares = 0.0;
    for (std::size_t n = 0; n + 1 < z.size(); ++n) {
        product += std::conj(z[n]) * z[n + 1];
        squares += std::norm(z[n]);
    }
    if (!(squares > 0.0) || !std::isfinite(squares)) return {};
    const std::complex<double> g = product / squares;
    if (!(std::abs(g) > 0.0) || !std::isfinite(std::abs(g))) return {};
    return {g, std::arg(g) / dt, std::log(std::abs(g)) / dt, true};
}

}  // namespace common
