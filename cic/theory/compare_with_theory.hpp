// The results of a run: what was measured, beside the exact or the predicted value.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "cic/setup/initial_state.hpp"
#include "cic/theory/cloud_force.hpp"
#include "cic/theory/diocotron.hpp"
#include "cic/theory/sheath.hpp"
#include "cic/theory/thermal_noise.hpp"
#include "common/run/history.hpp"
#include "common/run/summary.hpp"
#include "common/theory/fit_growth.hpp"
#include "common/theory/fit_oscillation.hpp"

namespace cic {

/// Units of frequencies in the results, with the convention.
inline constexpr const char* omega_p_unit = "omega_p(n=q=m=1)";

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
inline std::string onset_meaning() {
    return "the seed has grown to a tenth of what traps particles";
}

namespace detail {

inline double mean_of_last_half(const std::vector<double>& values) {
    double sum = 0;
    const std::size_t half = values.size() / 2;
    for (std::size_t n = half; n < values.size(); ++n) sum += values[n];
    return sum / static_cast<double>(values.size() - half);
}

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
inline void compare_wave(const Case& parameters, const common::History& history,
                         common::Summary& summary) {
    const Theory theory = theory_of_wave(parameters);
    const auto times = history.column("time"), re = history.column("mode_re"),
               im = history.column("mode_im");
    std::vector<double> amplitude;
    for (std::size_t n = 0; n < re.size(); ++n) amplitude.push_back(std::hypot(re[n], im[n]));
    const double growth = theory.omega.imag(), frequency = std::fabs(theory.omega.real());
    summary.result_info("theory_omega", theory.omega.real(), omega_p_unit, theory.source);
    summary.result_info("theory_growth", growth, omega_p_unit, theory.source);
    summary.result_info("mode_x", static_cast<double>(theory.mode_x), "", "followed");

    const bool grows = growth > 1e-3 * std::abs(theory.omega);
    std::vector<std::complex<double>> mode;
    const auto take = [&](std::size_t begin, std::size_t end) {
        mode.clear();
        for (std::size_t n = begin; n < end; ++n) mode.emplace_back(re[n], im[n]);
    };
    if (grows) {
        const common::GrowthFit fit = common::fit_growth(times, amplitude, {3.0, 0.1});
        const std::string where = theory.source + "; fitted from t = " + common::format(fit.begin) +
                                  " to " + common::format(fit.end) +
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
                           allowed, onset_meaning());
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
    const std::string where = theory.source +
                              "; fitted from t = " + common::format(times[window.begin]) + " to " +
                              common::format(times[window.end - 1]);
    summary.result_info("omega", omega, omega_p_unit, where);
    summary.result("omega_over_theory", omega / frequency, "", 1, parameters.frequency_tolerance,
                   where);
    if (growth < -1e-3 * frequency)
        summary.result("damping_over_theory", gamma / growth, "", 1, parameters.growth_tolerance,
                       where);
    else
        summary.result_info("damping", -gamma, omega_p_unit, where);
}

/// Growth rate of the followed mode of a case whose only species is a layer.
inline double diocotron_growth(const Case& parameters) {
    const SpeciesCase& s = parameters.species[0];
    const ChargedLayer layer{s.charge * s.density / parameters.B.y, s.half_width,
                             0.5 * parameters.grid.z.length};
    return std::fabs(
        diocotron_frequency(layer, wave_vector(parameters, parameters.mode_x, 0).size()).imag());
}

/// The rate at which the edges of a charged layer wind up.
inline void compare_diocotron(const Case& parameters, const common::History& history,
                              common::Summary& summary) {
    const double growth = diocotron_growth(parameters);
    const auto times = history.column("time"), re = history.column("mode_re"),
               im = history.column("mode_im");
    std::vector<double> amplitude;
    for (std::size_t n = 0; n < re.size(); ++n) amplitude.push_back(std::hypot(re[n], im[n]));
    const common::GrowthFit fit = common::fit_growth(times, amplitude, {2.0, 0.2});
    const std::string where =
        "guiding centers, two edges between grounded walls; fitted from t = " +
        common::format(fit.begin) + " to " + common::format(fit.end);
    summary.result_info("theory_growth", growth, omega_p_unit, where);
    summary.result_info("growth", fit.rate, omega_p_unit, where);
    summary.result("growth_over_theory", fit.rate / growth, "", 1, parameters.growth_tolerance,
                   where);
}

/// Potentials of a floating wall in front of a plasma from a source, mean of the last half.
inline void compare_sheath(const Case& parameters, const common::History& history,
                           common::Summary& summary) {
    const bool first_is_electron = parameters.species[0].charge < 0;
    const SpeciesCase &electrons = parameters.species[first_is_electron ? 0 : 1],
                      &ions = parameters.species[first_is_electron ? 1 : 0];
    const double T_e = electrons.emission_temperature;
    const Sheath sheath =
        collector_sheath(ions.mass / electrons.mass, ions.emission_temperature / T_e);
    const std::string source = "Schwager and Birdsall 1990, solved here";
    const double e = std::fabs(electrons.charge);
    summary.result("collector_potential",
                   e * detail::mean_of_last_half(history.column("potential_x_high")) / T_e, "T_e/e",
                   sheath.collector_potential,
                   parameters.growth_tolerance * std::fabs(sheath.collector_potential), source);
    summary.result("plasma_potential",
                   e * detail::mean_of_last_half(history.column("potential_middle")) / T_e, "T_e/e",
                   sheath.plasma_potential,
                   parameters.growth_tolerance * std::fabs(sheath.plasma_potential), source);
}

/// Two clouds of opposite charge swing through each other along x.
inline void compare_clouds(const Case& parameters, const common::History& history,
                           common::Summary& summary) {
    const SpeciesCase &a = parameters.species[0], &b = parameters.species[1];
    const auto separation = history.column("separation_x");
    const CloudPair pair =
        make_cloud_pair(parameters.grid.x, parameters.grid.z, parameters.scheme().order);
    const double expected = std::sqrt(
        std::max(0.0, overlap_frequency_squared(pair, a.density * a.charge, a.density * a.mass,
                                                b.density * b.charge, b.density * b.mass)[0]));
    if (expected == 0) {
        summary.result_info("largest_separation",
                            *std::max_element(separation.begin(), separation.end()), "length",
                            "measured");
        return;
    }
    const common::OscillationFit fit = common::fit_oscillation(separation, parameters.dt);
    summary.result("omega_over_theory", fit.frequency / expected, "", 1,
                   parameters.frequency_tolerance,
                   "linear force of overlapping clouds, mean over all places on the mesh");
    summary.result_info("omega", fit.frequency, omega_p_unit, "measured");
    summary.result_info("misfit", fit.misfit, "", "rms of what is not harmonic");
}

/// How a warm plasma at rest does: the energy of its noise, and how fast the mesh heats it.
inline void compare_heating(const Case& parameters, const common::History& history,
                            common::Summary& summary) {
    const auto kinetic = history.column("kinetic"), field = history.column("field");
    const double ratio = kinetic.back() / kinetic.front();
    summary.result_info("kinetic_over_initial", ratio, "", "measured");
    double inverse_debye2 = 0, per_cell = 0;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        inverse_debye2 += s.density * s.charge * s.charge / s.temperature_x;
        per_cell += static_cast<double>(s.particles_per_cell);
    }
    const double at_start = 1 / std::sqrt(inverse_debye2) / parameters.grid.x.spacing();
    const double mean = detail::mean_of_last_half(kinetic);
    const double then = at_start * std::sqrt(mean / kinetic.front());
    summary.result_info("debye_length_over_dx", at_start * std::sqrt(ratio), "", "at the end");
    const double expected =
        thermal_noise(then, per_cell, parameters.grid.x.cells, parameters.scheme().order);
    summary.result("field_over_kinetic", detail::mean_of_last_half(field) / mean, "", expected,
                   parameters.growth_tolerance * expected, "thermal noise on this mesh");
}

/// The results of a case.
inline void compare_with_theory(const Case& parameters, const common::History& history,
                                common::Summary& summary) {
    if (parameters.compare == "wave") compare_wave(parameters, history, summary);
    if (parameters.compare == "diocotron") compare_diocotron(parameters, history, summary);
    if (parameters.compare == "sheath") compare_sheath(parameters, history, summary);
    if (parameters.compare == "clouds") compare_clouds(parameters, history, summary);
    if (parameters.compare == "heating") compare_heating(parameters, history, summary);
}

}  // namespace cic
