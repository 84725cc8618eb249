// A wave or an instability of the case, and what its run is compared with: frequency, growth or
// damping, and the time of the onset, from the dispersion relation of its species.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "cic/theory/comparison.hpp"
#include "cic/theory/theory_of_case.hpp"
#include "common/theory/fit_growth.hpp"
#include "common/theory/fit_oscillation.hpp"

namespace cic {

/// Refuses a species in a magnetic field that does not stay as it is without a wave, or whose gyration
/// the theory cannot follow.
inline void refuse_magnetized(const Case& parameters, const SpeciesCase& s, const std::string& what,
                              const WaveVector& k) {
    const std::size_t axis = parameters.axis();
    const std::array<double, 3> B{parameters.B.x, parameters.B.y, parameters.B.z},
        T = s.temperatures(axis), u = s.drift();
    const bool aligned = std::fabs(B[axis]) == parameters.B.size();
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double most = std::max({T[0], T[1], T[2]});
    refuse(std::fabs(T[a] - T[b]) > 1e-9 * most ||
               (!aligned && std::fabs(T[axis] - T[a]) > 1e-9 * most),
           what,
           " with a magnetic field needs the same temperature in all directions across it, "
           "and '",
           s.name, "' has temperature_x = ", T[0], ", y: ", T[1], ", z: ", T[2]);
    refuse(std::hypot(u[1] * B[2] - u[2] * B[1], u[2] * B[0] - u[0] * B[2],
                      u[0] * B[1] - u[1] * B[0]) >
               1e-12 * std::hypot(u[0], u[1], u[2]) * parameters.B.size(),
           what, " with a magnetic field is for drifts along it, and '", s.name,
           "' drifts across: it would gyrate as a whole; take out that drift, or set "
           "theory.compare = \"none\" and waves to \"standing\"");
    refuse(s.tables.v[0].given() || s.tables.v[1].given() || s.tables.v[2].given(), what,
           " with a magnetic field is for Maxwellians and distribution_across, and '", s.name,
           "' has a distribution by formula of one direction");
    const double speed = s.tables.speed.given() ? s.distribution_max : std::sqrt(most / s.mass),
                 along = (k.x * B[0] + k.z * B[2]) / parameters.B.size(),
                 across = std::sqrt(std::max(0.0, k.size() * k.size() - along * along)),
                 orbit = across * speed * s.mass / (std::fabs(s.charge) * parameters.B.size());
    refuse(s.charge == 0, what, " with a magnetic field is for charged species, and '", s.name,
           "' has none: make it fixed or take it out");
    refuse(orbit > 100, what, ": the orbits of '", s.name, "' are ", orbit,
           " times the length 1/k across the field, more than the 100 to which harmonics are "
           "summed: raise the magnetic field, "
           "or take it out");
}

/// Refuses a case for which the dispersion relations of theory_of_case.hpp do not hold.
/// in:     what asks for them, and for which mode
inline void refuse_wave(const Case& parameters, const std::string& what, long mode_x, long mode_z) {
    refuse(parameters.has_walls(), what, " needs periodic boundaries");
    const WaveVector k = wave_vector(parameters, mode_x, mode_z);
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        refuse(s.profile != "uniform", what, " needs uniform species, and '", s.name, "' is a ",
               s.profile);
        refuse(!s.density.is_number(), what, " needs uniform species, and the density of '", s.name,
               "' is a formula");
        refuse(parameters.model == "mesh" && s.has_distribution(),
               "theory.model = \"mesh\" is for Maxwellians, and '", s.name,
               "' has a distribution by formula: take \"plasma\"");
        if (parameters.magnetized())
            refuse_magnetized(parameters, s, what, k);
        else
            refuse(
                s.tables.speed.given() || (s.has_distribution() && k.x != 0 && k.z != 0), what,
                " is for distributions by formula of the velocity along x or along z, and a mode "
                "along the same axis: change the mode or distribution of '",
                s.name, "'");
    }
    refuse(parameters.model == "mesh" && mode_x != 0 && mode_z != 0,
           "theory.model = \"mesh\" needs a mode along x or along z, and not ",
           mode_text(mode_x, mode_z));
    refuse(parameters.model == "mesh" && (parameters.magnetized() || parameters.gauss_sign < 0),
           "theory.model = \"mesh\" has neither a magnetic field nor gauss.sign = -1: take "
           "\"plasma\"");
    refuse(parameters.magnetized() && parameters.gauss_sign < 0, what,
           " with a magnetic field is for gauss.sign = 1");
}

/// Amplitude of the field at which an instability is visible: a tenth of the one in which the
/// species with the largest |q|/m bounces as fast as the wave grows, |q| k E/m = gamma^2, where
/// linear growth ends.
inline double onset_field(const Case& parameters, const Theory& theory) {
    double most = 0;
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile()) most = std::max(most, std::fabs(s.charge) / s.mass);
    const double k = wave_vector(parameters, theory.mode_x, theory.mode_z).size();
    return 0.1 * theory.omega.imag() * theory.omega.imag() / (most * k);
}

/// Time of the onset, before the run: the seeded field grows at the rate of theory.
/// out:    0 for a mode that does not grow or is not seeded
inline double predicted_onset(const Case& parameters, const Theory& theory) {
    const double growth = theory.omega.imag(), onset = onset_field(parameters, theory);
    return growth > 0 && theory.seed > 0 && onset > theory.seed
               ? std::log(onset / theory.seed) / growth
               : 0;
}
/// What the onset is, in words.
inline const std::string onset_meaning = "the seed has grown to a tenth of what traps particles";

namespace detail {

// The rows in which a damped wave is measured.
struct Window {
    std::size_t begin = 0, end = 0;
};

// One period after the start, when what else was excited has died away, until the amplitude has
// fallen by e^3, or to the end. A standing wave is zero twice a period: the amplitude at a time is
// the largest within the next half period.
inline Window ringing_window(const std::vector<double>& amplitude, double dt, double frequency) {
    const std::size_t count = amplitude.size();
    const auto half = std::max<std::size_t>(1, static_cast<std::size_t>(pi / (frequency * dt)));
    const auto envelope = [&](std::size_t n) {
        const auto from = amplitude.begin() + static_cast<std::ptrdiff_t>(n);
        return *std::max_element(from,
                                 from + static_cast<std::ptrdiff_t>(std::min(half, count - n)));
    };
    Window window{std::min(2 * half, count / 4), count};
    const double start = envelope(window.begin);
    for (std::size_t n = window.begin; n + half < count; n += half) {
        if (envelope(n) >= std::exp(-3.0) * start) continue;
        window.end = n;
        break;
    }
    return window;
}

}  // namespace detail

/// A wave or an instability against the dispersion relation.
///   growing: rate by fit_growth, frequency by rotation within the same times, onset
///   otherwise: frequency and damping within ringing_window
inline void compare_wave(const Case& parameters, const History& history, Summary& summary) {
    const Theory theory = theory_of_wave(parameters);
    const auto times = history.column("time"), re = history.column("mode_re"),
               im = history.column("mode_im");
    const std::vector<double> amplitude = amplitude_of_mode(history);
    const double growth = theory.omega.imag(), frequency = std::fabs(theory.omega.real());
    summary.result_info("theory_omega", theory.omega.real(), omega_p_unit, theory.source);
    summary.result_info("theory_growth", growth, omega_p_unit, theory.source);
    summary.result_info("mode_x", double(theory.mode_x), "", "followed");

    const bool grows = growth > 1e-3 * std::abs(theory.omega);
    std::vector<std::complex<double>> mode;
    const auto take = [&](std::size_t begin, std::size_t end) {
        mode.clear();
        for (std::size_t n = begin; n < end; ++n) mode.emplace_back(re[n], im[n]);
    };
    if (grows) {
        const common::GrowthFit fit = common::fit_growth(times, amplitude, {3.0, 0.1});
        const std::string where = theory.source + "; fitted from t = " + format(fit.begin) +
                                  " to " + format(fit.end) +
                                  (fit.found ? "" : " (" + fit.reason + ")");
        summary.result_info("growth", fit.rate, omega_p_unit, where);
        summary.result("growth_over_theory", fit.rate / growth, "", 1, parameters.growth_tolerance,
                       where);
        if (fit.found && frequency > 0.1 * growth) {
            const auto row = [&](double t) {
                return static_cast<std::size_t>(t / parameters.dt + 0.5);
            };
            take(row(fit.begin), row(fit.end) + 1);
            const common::RotationFit rotation = common::fit_rotation(mode, parameters.dt);
            summary.result("omega_over_theory", -rotation.frequency / theory.omega.real(), "", 1,
                           parameters.frequency_tolerance, where);
        }
        const double onset = predicted_onset(parameters, theory), allowed = 0.5 / growth;
        const double seen =
            common::time_at_level(times, amplitude, onset_field(parameters, theory));
        if (onset > 0 && times.back() > onset + allowed)
            summary.result("onset", std::isnan(seen) ? times.back() : seen, "1/omega_p", onset,
                           allowed, onset_meaning);
        return;
    }

    // Where nothing should grow, nothing may.
    const double start = *std::max_element(
        amplitude.begin(),
        amplitude.begin() + static_cast<std::ptrdiff_t>(1 + amplitude.size() / 10));
    summary.result_within("largest_over_start",
                          *std::max_element(amplitude.begin(), amplitude.end()) / start, "", 0, 1.2,
                          "no growing root");
    if (frequency < 0.01 * std::fabs(growth)) return;  // too damped to swing

    const detail::Window window = detail::ringing_window(amplitude, parameters.dt, frequency);
    take(window.begin, window.end);
    // In a magnetic field a part of the seed stays at rest: it drops out of differences over half a
    // period, which change neither frequency nor damping.
    if (parameters.magnetized()) {
        const auto half = static_cast<std::size_t>(std::ceil(pi / (frequency * parameters.dt)));
        for (std::size_t n = 0; n + half < mode.size(); ++n) mode[n] -= mode[n + half];
        mode.resize(mode.size() > half ? mode.size() - half : 0);
    }
    // A standing wave keeps its phase, a traveling one turns it: its ellipse is round.
    std::complex<double> squares = 0;
    for (const auto& z : mode) squares += z * z;
    const std::complex<double> direction = std::polar(1.0, -0.5 * std::arg(squares));
    std::vector<double> standing;
    double along = 0, across = 0;
    for (const auto& z : mode) {
        const std::complex<double> turned = direction * z;
        standing.push_back(turned.real());
        along += turned.real() * turned.real();
        across += turned.imag() * turned.imag();
    }
    double omega = 0, gamma = 0;
    if (across < 0.1 * along) {
        const common::OscillationFit fit = common::fit_oscillation(standing, parameters.dt);
        omega = fit.frequency, gamma = fit.growth;
    } else {
        const common::RotationFit fit = common::fit_rotation(mode, parameters.dt);
        omega = std::fabs(fit.frequency), gamma = fit.growth;
    }
    const std::string where = theory.source + "; fitted from t = " + format(times[window.begin]) +
                              " to " + format(times[window.end - 1]);
    summary.result_info("omega", omega, omega_p_unit, where);
    summary.result("omega_over_theory", omega / frequency, "", 1, parameters.frequency_tolerance,
                   where);
    if (growth < -1e-3 * frequency)
        summary.result("damping_over_theory", gamma / growth, "", 1, parameters.growth_tolerance,
                       where);
    else
        summary.result_info("damping", -gamma, omega_p_unit, where);
}

/// Frequency, growth and onset of the followed mode in words, before the run.
inline Lines describe_wave(const Case& parameters) {
    const Theory theory = theory_of_wave(parameters);
    Lines lines{{"theory", mode_text(theory.mode_x, theory.mode_z) +
                               ": omega = " + format(theory.omega.real()) + ", growth = " +
                               format(theory.omega.imag()) + " omega_p; " + theory.source}};
    std::string others;
    for (std::size_t n = 0; n < std::min<std::size_t>(10, theory.others.size()); ++n)
        others += (n > 0 ? ", " : "") + format(theory.others[n]);
    if (!others.empty()) lines.push_back({"other Bernstein modes", "omega = " + others});
    const double onset = predicted_onset(parameters, theory);
    if (onset > 0) lines.push_back({"onset", "about t = " + format(onset) + ": " + onset_meaning});
    return lines;
}

/// The comparison of waves and instabilities.
inline constexpr Comparison wave_comparison{
    .name = "wave",
    .either_sign = true,
    .formulas = true,
    .follows_mode = true,
    .validate =
        [](const Case& parameters) {
            refuse_wave(parameters, asked_for(parameters), parameters.mode_x, parameters.mode_z);
            const bool search = parameters.mode_x == 0 && parameters.mode_z == 0;
            const long modes = (parameters.grid.x.cells - 1) / 2;
            refuse(search && (modes < 1 || modes > 512 || parameters.model == "mesh"),
                   "theory.mode_x = 0 looks for the fastest growing of ", modes,
                   " modes, and that is for 1 to 512 and theory.model = \"plasma\": name a mode");
        },
    .recorded_mode_x = [](const Case& parameters) { return theory_of_wave(parameters).mode_x; },
    .describe = describe_wave,
    .add_warnings =
        [](const Case& parameters, std::vector<std::string>& warnings) {
            const std::complex<double> omega = theory_of_wave(parameters).omega;
            const double period = 2 * pi / std::fabs(omega.real());
            if (omega.imag() <= 0 && omega.real() != 0 && period > parameters.end)
                warnings.push_back(sentence("the wave of theory has the period ", period,
                                            ", longer than time.end = ", parameters.end,
                                            ": its frequency cannot be measured well"));
        },
    .add_results = compare_wave};

}  // namespace cic
