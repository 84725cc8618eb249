// The kink that follows the lower-hybrid drift instability of a thin current sheet, and the level at
// which that instability stays, beside figure 14 of the talk.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "common/run/run.hpp"
#include "implicit_moment/setup/current_sheet.hpp"
#include "implicit_moment/theory/compare_current_sheet.hpp"
#include "implicit_moment/theory/drift_kink.hpp"
#include "implicit_moment/theory/fit_ramp.hpp"

namespace implicit_moment {

/// When the lower-hybrid drift instability has saturated: the talk takes its level from here on, and
/// the second phase of the evolution begins, the kink's   [1/Omega_ci]
inline constexpr double second_phase = 10;
/// Its growth is looked for up to here, the end of kink_quick.toml; whole runs are judged alike.
inline constexpr double growth_end = 50;
/// A record that ends before has no second phase to speak of.   [1/Omega_ci]
inline constexpr double least_record = 40;

/// Root of the mean of a^2 from a time to the end, by the rule of the trapezoid.
///     level^2 = integral a^2 dt / (t_end - t_begin)
/// in:     times, increasing; a of the same length
/// out:    the error is two standard errors of the mean of eight parts of that time
/// exact:  for a constant, and for rows of any spacing where a^2 is linear between them
/// note:   begins at the first row that is not before `begin`; NaN without two rows from there on
inline common::Measured level_after(std::span<const double> times, std::span<const double> a,
                                    double begin) {
    constexpr int parts = 8;
    std::array<double, parts> sum{}, length{};
    const auto start =
        std::ranges::find_if(times, [&](double t) { return t >= begin * (1 - 1e-9); });
    for (std::size_t n = start - times.begin() + 1; n < times.size(); ++n) {
        const double dt = times[n] - times[n - 1],
                     passed = (times[n - 1] - *start) / (times.back() - *start);
        const int part = std::min(int(parts * passed), parts - 1);
        sum[part] += 0.5 * (a[n - 1] * a[n - 1] + a[n] * a[n]) * dt;
        length[part] += dt;
    }
    const double all = std::accumulate(length.begin(), length.end(), 0.0);
    if (!(all > 0)) return std::nan("");
    const double mean = std::accumulate(sum.begin(), sum.end(), 0.0) / all;
    double scatter = 0;
    for (int part = 0; part < parts; ++part) {
        if (length[part] > 0) scatter += std::pow(sum[part] / length[part] - mean, 2);
    }
    const double error_of_mean = std::sqrt(scatter / (parts * (parts - 1)));
    return {std::sqrt(mean), mean > 0 ? error_of_mean / std::sqrt(mean) : 0};
}

/// What the talk says about one of its sheets, m_i/m_e = 180 and u_i/v_i = 1.
struct TalkKink {
    double temperature_ratio;  // T_i/T_e
    double growth;             // of the kink   [Omega_ci]
    double level;              // of B_x(m_y = 4) after the first phase   [B0, as we read it]
};
inline constexpr std::array<TalkKink, 3> talk_kinks{
    {{4, 0.1, 6.5e-3}, {2, 0.07, 3.5e-3}, {1, 0.04, 1.5e-3}}};

/// Growth of the kink, mode 1 along the current, and level of mode 4, beside the talk.
///     kink_growth    of B_1, the root mean square over z of the amplitude of the mode of B_y:
///         of the exponential that rises out of its level after t Omega_ci = 10 (fit_ramp)
///     kink_growth_of_displacement   of the same mode of where B_y changes sign
///     kink_theory_growth, kink_theory_omega, kink_theory_z   of the fastest growing wave of this
///         length that bends a sheet without other waves: nothing is judged by it, because the sheet
///         that kinks is another after its drift instability
///     lhdi_level     root mean square in time of B_4, from t Omega_ci = 10 to the end
/// note:   The talk does not say how its Fourier components are normalized, nor the length of this
///         box. In 2 L its m_y = 4 is the wave that its figure 12 calls dominant, k_y L = 12.5, and
///         rates and levels come near to the talk's; in another length the modes are other waves, and
///         nothing is expected.
inline void compare_kink(const Case& w, const common::History& history, common::Summary& summary) {
    const auto times = history.column("time_Omega_ci");
    if (times.back() < least_record * (1 - 1e-9)) return;
    const auto B_1 = history.column("B_1"), B_4 = history.column("B_4"),
               displacement = history.column("displacement_1");
    const CurrentSheetCase& s = w.current_sheet;
    const bool of_the_talk = s.mass_ratio == 180 && s.drift == 1 && s.length_x == 2;
    const auto sheet = std::ranges::find_if(talk_kinks, [&](const TalkKink& k) {
        return of_the_talk && k.temperature_ratio == s.temperature_ratio;
    });
    const auto report = [&](const std::string& name, common::Measured value,
                            const std::string& unit, double TalkKink::*talk,
                            const std::string& source) {
        if (sheet == talk_kinks.end())
            summary.result_info(name, value, unit, source);
        else
            summary.result_within(
                name, value, unit, (*sheet).*talk / 1.5, 1.5 * (*sheet).*talk,
                "talk, figure 14: " + format((*sheet).*talk) + ", within a factor 1.5; " + source);
    };
    const auto growth = [&](const std::string& name, const std::vector<double>& a, bool compared) {
        const auto rows = std::size_t(
            std::upper_bound(times.begin(), times.end(), growth_end * (1 + 1e-9)) - times.begin());
        const Ramp seen = fit_ramp(std::span(times).first(rows), a, second_phase);
        if (!seen.reason.empty()) {
            if (compared) summary.not_measured(name, seen.reason);
            return;
        }
        const std::string window =
            "the exponential that rises out of the level of t Omega_ci = 10 or later";
        if (compared)
            report(name, seen.growth, "Omega_ci", &TalkKink::growth, window);
        else
            summary.result_info(name, seen.growth, "Omega_ci", window);
        summary.result_info(name + "_begin", seen.begin, "1/Omega_ci", "of the fit");
        summary.result_info(name + "_end", seen.end, "1/Omega_ci", "of the fit");
    };
    growth("kink_growth", B_1, true);
    growth("kink_growth_of_displacement", displacement, false);
    const double half_length = std::min(0.5 * s.length_z, 20.0);  // walls beyond are far away
    KinkResolution resolution;
    resolution.cells = int(std::ceil(resolution.cells * std::max(half_length / 4.5, 0.5)));
    const auto waves = growing_waves(
        linear_sheet(theory_sheet(s), 2 * pi / s.length_x, half_length, true, resolution));
    const SheetWave fastest = waves.empty() ? SheetWave{} : waves.front();
    const std::string linear = "linear Vlasov theory of the first sheet";
    summary.result_info("kink_theory_growth", fastest.omega.imag(), "Omega_ci",
                        waves.empty() ? linear + ", below 0.01" : linear);
    if (!waves.empty()) {
        summary.result_info("kink_theory_omega", fastest.omega.real(), "Omega_ci", linear);
        summary.result_info("kink_theory_z", fastest.height, "L", linear);
    }
    summary.result_info("kink_largest", std::ranges::max(displacement), "L",
                        "amplitude of the displacement");
    report("lhdi_level", level_after(times, B_4, second_phase), "B0", &TalkKink::level,
           "root mean square over z and time, from t Omega_ci = 10");
    summary.result_info("energy_drift_at_end", history.column("energy_drift").back(), "",
                        "conservation");
}

}  // namespace implicit_moment
