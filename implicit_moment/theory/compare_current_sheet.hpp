// The lower-hybrid drift instability of a thin current sheet, as it grows out of the noise of the
// particles, beside local linear theory.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "common/run/run.hpp"
#include "common/theory/measure_modes.hpp"
#include "implicit_moment/output/sheet_diagnostics.hpp"
#include "implicit_moment/theory/drift_dispersion.hpp"

namespace implicit_moment {

/// The sheet as local theory wants it: lengths in L, times in 1/Omega_ci; guiding centers drift in
/// grad B.
///     omega_pe/Omega_ce = (c/v_A) (m_e/m_i)^(1/2)
inline CurrentSheet theory_sheet(const CurrentSheetCase& s) {
    return {s.mass_ratio, s.temperature_ratio,
            s.drift,      s.light_over_alfven / std::sqrt(s.mass_ratio),
            s.background, true};
}

/// One mode along the current, at both edges of the sheet, row by row of the history.
struct EdgeWave {
    std::vector<std::complex<double>> upper, lower;
    std::vector<double> amplitude;  // root mean square of both

    EdgeWave(const common::History& history, long m)
        : upper(history.complex_column("upper_" + std::to_string(m))),
          lower(history.complex_column("lower_" + std::to_string(m))) {
        for (std::size_t n = 0; n < upper.size(); ++n)
            amplitude.push_back(std::sqrt(0.5 * (std::norm(upper[n]) + std::norm(lower[n]))));
    }
};

/// Mode, growth rate and frequency of the largest wave beside the fastest growing local wave of
/// the same wave number.
///     dominant_mode   the largest at the edges before t Omega_ci = 7, the time of figure 12; beside
///                     the talk's for its sheet, T_i/T_e = 4
///     growth, omega   of that mode, from its way up there
/// note:   local theory is an upper bound: a wave must be one over all the heights that it covers,
///         and at most of them it would grow more slowly. A run starts from noise, three e-foldings
///         below saturation, and realizations differ: three seeds of lhdi_quick.toml give modes 8,
///         8 and 9 with 0.79, 0.6 and 0.90 of the growth, known to 0.15, 0.4 and 0.21, and 0.92,
///         1.03 and 0.98 of the frequency of local theory, lhdi.toml 9 with 1.10 and 0.95.
///         Theory with the wider gyrations of the quick case's long step has 12 % less growth.
inline void compare_current_sheet(const Case& w, const common::History& history,
                                  common::Summary& summary) {
    const std::string talk = "talk, figure 12: m_y = 8", local = "local kinetic theory";
    const auto times = history.column("time_Omega_ci");
    if (times.back() < 2)
        return summary.not_measured("dominant_mode",
                                    "the run ends before t Omega_ci = 2: raise time.end");

    // Find the mode that is largest while the instability saturates.
    const long last = std::upper_bound(times.begin(), times.end(), 7 * (1 + 1e-9)) - times.begin();
    long dominant = 1;
    double largest = -1;
    std::size_t top = 0;
    for (long m = 1; m <= sheet_modes(w.grid); ++m) {
        const auto a = EdgeWave(history, m).amplitude;
        const auto at = std::max_element(a.begin(), a.begin() + long(last));
        if (*at <= largest) continue;
        largest = *at, dominant = m, top = at - a.begin();
    }
    // Beside the first half of 1/Omega_ci, when it has hardly grown.
    const auto of_dominant = EdgeWave(history, dominant).amplitude;
    double early = 0, rows = 0;
    for (std::size_t n = 0; n < times.size() && times[n] <= 0.5; ++n)
        early += of_dominant[n] * of_dominant[n], rows += 1;
    const double above_noise = largest / std::sqrt(early / rows);
    const double k = 2 * pi * double(dominant) / w.current_sheet.length_x;
    const CurrentSheetCase& s = w.current_sheet;
    const double all = s.length_x / 4;  // figure 12 has 4 L
    const bool of_the_talk = s.mass_ratio == 180 && s.drift == 1 && s.temperature_ratio == 4;
    const long followed = sheet_modes(w.grid);
    if (of_the_talk && double(followed) < 11 * all)
        summary.not_measured(
            "dominant_mode",
            std::to_string(followed) + " modes along the current are followed, " +
                "and the talk's may be beyond: " +
                (followed < 16 ? "raise grid.cells_x" : "lower current_sheet.length_x"));
    else if (of_the_talk && !(above_noise > 3))
        summary.not_measured("dominant_mode",
                             "the largest wave is " + format(above_noise) +
                                 " times the noise that it began with, below 3: raise "
                                 "current_sheet.particles or time.end");
    else if (of_the_talk)
        summary.result_within("dominant_mode", double(dominant), "", 7 * all, 11 * all, talk);
    else
        summary.result_info("dominant_mode", double(dominant), "", "measured");
    summary.result_info("dominant_k_L", k, "1/L", "measured");
    summary.result_info("time_of_saturation", times[top], "1/Omega_ci", "measured");

    // Fit its growth up to there.
    const LocalWave theory = fastest_over_z(theory_sheet(w.current_sheet), k);
    if (!(theory.gamma > 0))
        return summary.not_measured(
            "growth_over_theory",
            "local theory, of waves much slower than electrons gyrate, has no "
            "growth for the dominant mode: raise current_sheet.drift or "
            "mass_ratio, or refine the mesh along x");
    summary.result_info("theory_growth", theory.gamma, "Omega_ci", local);
    summary.result_info("theory_omega", theory.omega, "Omega_ci", local);
    summary.result_info("theory_z", theory.z, "L", local);
    const EdgeWave wave(history, dominant);
    common::ModeSearch search{.expected = {{theory.omega, theory.gamma}},
                              .begin = 0,
                              .end = times[top],
                              .below_maximum = 0.7};
    search.e_foldings = search.periods = 1;
    const common::MeasuredMode upper = common::measure_mode(times, wave.upper, search),
                               lower = common::measure_mode(times, wave.lower, search);
    summary.hint("realizations differ: another plasma.seed, or more particles per cell");
    for (const common::MeasuredMode* edge : {&upper, &lower})
        if (!edge->found) {
            summary.not_measured("growth_over_theory", edge->reason);
            return summary.not_measured("omega_over_theory", edge->reason);
        }
    // The mean of both edges, which disagree by what noise does to each.
    const auto mean = [](double a, double b, double error_a, double error_b, double expected) {
        return common::Measured{
            0.5 * (a + b) / expected,
            std::max(0.5 * std::hypot(error_a, error_b), 0.5 * std::fabs(a - b)) /
                std::fabs(expected)};
    };
    const std::string window = local + "; measured " + upper.window;
    summary.result_within("growth_over_theory",
                          mean(upper.growth(), lower.growth(), upper.growth_error(),
                               lower.growth_error(), theory.gamma),
                          "", 0.6, 1.1, window);
    summary.result_within("omega_over_theory",
                          mean(upper.omega.real(), lower.omega.real(), upper.frequency_error(),
                               lower.frequency_error(), theory.omega),
                          "", 0.8, 1.2, window);
}

}  // namespace implicit_moment
