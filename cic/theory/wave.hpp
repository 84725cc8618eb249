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
#include "cic/theory/wave_causes.hpp"
#include "common/theory/measure_modes.hpp"

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
           " with a magnetic field needs the same temperature in all directions across it, and '",
           s.name, "' has temperature_x = ", T[0], ", y: ", T[1], ", z: ", T[2]);
    refuse(std::hypot(u[1] * B[2] - u[2] * B[1], u[2] * B[0] - u[0] * B[2],
                      u[0] * B[1] - u[1] * B[0]) >
               1e-6 * std::hypot(u[0], u[1], u[2]) * parameters.B.size(),
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
           "summed: raise the magnetic field or take it out, or name a lower mode");
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
            refuse(s.tables.speed.given() || (s.has_distribution() && k.x != 0 && k.z != 0), what,
                   " is for distributions by formula of the velocity along x or along z, and a "
                   "mode along the same axis: change the mode or distribution of '",
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

/// What a wave that theory does not damp loses: at most 2e-3 of omega, in: scale, per time.
inline void judge_undamped(const common::MeasuredMode& seen, double growth, double scale,
                           const std::string& where, Summary& summary) {
    summary.result("damping", {-seen.growth(), seen.growth_error()}, omega_p_unit, 0 - growth,
                   2e-3 * scale, where);
}

/// The record of a run beside the wave of theory, and what was measured of it.
struct WaveRecord {
    Theory theory;
    std::vector<double> times, amplitude;  // |E_k|
    common::ModeSearch search;
    common::MeasuredMode seen;
    bool grows = false, seeded = false;
    double onset = 0;  // predicted time; 0 where there is none
    double level = 0;  // field of the onset
    double noise = 0,
           later_noise = 0;  // of particles in this mode: at the start, and of quiet ones later
    double early = 0;        // the largest field, or noise, before the measured window
    double largest_at_start = 0;  // of the first tenth of the record
    bool noisy = false;           // noise has started a growing wave beside the perturbation
    bool in_noise = false;        // above the level of the onset
    bool grows_right = false;     // as in theory, within error and tolerance
    WaveStart start;
    std::string covered;  // by which other wave of this mode, and what to change
    std::string told;     // which other wave of this mode was measured, and what to change
    std::string cause;    // of what is not as in theory

    double growth() const { return theory.omega.imag(); }
    double frequency() const { return std::fabs(theory.omega.real()); }
    double e_foldings() const { return growth() * (seen.end - seen.begin); }
    double periods() const { return frequency() * (seen.end - seen.begin) / (2 * pi); }
    bool swings() const { return frequency() > 0 && frequency() >= 0.01 * std::fabs(growth()); }
    /// What the measured frequency has beyond that of theory; of waves in both directions either.
    double frequency_off() const {
        return theory.mirrored ? seen.frequency() - frequency()
                               : seen.omega.real() - theory.omega.real();
    }
    std::string where() const { return theory.source + "; measured " + seen.window; }
};

/// Measures the followed mode by measure_mode().
///   the record begins when the transient of the start is over: a growth time, or a period
///   what grows ends at a tenth of its maximum
inline WaveRecord measure_wave(const Case& parameters, const History& history) {
    WaveRecord w;
    w.theory = theory_of_wave(parameters);
    w.times = history.column("time");
    std::vector<std::complex<double>> mode = history.complex_column("mode");
    for (const std::complex<double> E_k : mode) w.amplitude.push_back(std::abs(E_k));
    // A plasma that drifts fast is followed: its wave has fewer periods there.
    const double shift = std::abs(w.theory.in_plasma) < w.frequency()
                             ? (w.theory.omega - w.theory.in_plasma).real()
                             : 0;
    for (std::size_t n = 0; n < mode.size() && shift != 0; ++n)
        mode[n] *= std::polar(1.0, shift * w.times[n]);
    w.largest_at_start = *std::max_element(
        w.amplitude.begin(),
        w.amplitude.begin() + static_cast<std::ptrdiff_t>(1 + w.amplitude.size() / 10));
    const double growth = w.growth(), end = w.times.back();
    w.grows = growth > 1e-3 * w.theory.scale(std::abs(w.theory.omega)) || growth * end > 3;
    w.seeded = is_seeded(parameters, w.theory);
    w.onset = predicted_onset(parameters, w.theory);
    w.level = onset_field(parameters, w.theory);
    w.noise = noise_field(parameters, w.theory, false);
    w.later_noise = noise_field(parameters, w.theory);
    const double seed = w.theory.seed * (w.theory.mirrored ? 2 : 1),
                 field = seed > 0 ? seed : w.largest_at_start;

    const std::complex<double> fastest =
        w.grows || !w.seeded ? w.theory.omega : fastest_of_mode(parameters, w.theory);
    const bool other = std::abs(fastest - w.theory.omega) > 1e-6 * std::abs(fastest);
    if (!w.grows && other && fastest.imag() * end > 1)
        w.covered = sentence("another wave of this mode grows, with ", fastest.imag(),
                             " at omega = ", fastest.real(),
                             ", and covers this one: take theory.near = ", fastest.real());

    const double begins = std::max(seed, w.amplitude.front());
    if (!w.grows && w.covered.empty() && w.later_noise > begins && w.largest_at_start > 5 * begins)
        w.covered = sentence("noise covers the perturbation: particles come to ",
                             w.largest_at_start, " in a tenth of the record, and the seed is ",
                             seed, ": raise the amplitude or particles_per_cell");

    w.search.expected = {w.theory.omega - shift};
    if (w.theory.mirrored) w.search.expected.push_back(-std::conj(w.theory.omega));
    const std::string bouncing = likely_bouncing(parameters, w.theory, field);
    if (!bouncing.empty()) w.search.faded = bouncing;
    w.search.begin = w.grows ? 1 / growth : 2 * pi / w.theory.scale(w.frequency());
    w.search.below_maximum = 0.1;
    if (w.onset > w.search.begin) w.search.end = w.onset;
    if (w.grows || w.swings()) w.seen = common::measure_mode(w.times, mode, w.search);
    w.seen.omega += shift;
    if (shift != 0) w.seen.window += sentence(", Doppler shift ", shift, " taken off");
    // Of a wave that decays, noise that rings as it does moves the phase: no fit can tell it apart.
    if (!w.grows && seed > 0) {
        const double moved =
            2 * w.noise / seed * std::max(std::fabs(growth), 1 / (w.seen.end - w.seen.begin));
        w.seen.error = {std::hypot(w.seen.error.real(), moved),
                        std::hypot(w.seen.error.imag(), moved)};
    }

    w.early = w.noise;
    for (std::size_t n = 0; n < w.times.size() && w.times[n] < w.search.begin; ++n)
        w.early = std::max(w.early, w.amplitude[n]);
    // What the perturbation has by search.begin, a growth time, without noise.
    const double own = std::max(w.amplitude.front(), std::exp(1.0) * w.theory.seed);
    w.noisy = w.grows && w.later_noise > 0 && w.early > 1.05 * own;
    w.start = {field, w.noise, w.noisy && w.early > 2 * own ? w.early : 0};
    if (!w.grows && w.seen.found && w.later_noise > 0.1 * field &&
        w.seen.frequency_error() > parameters.frequency_tolerance * w.theory.scale(w.frequency()))
        w.start.blurs = w.later_noise / field;
    if (!w.grows) w.told = other_wave(parameters, w.theory, w.seen);
    w.cause = !w.told.empty()      ? w.told
              : !w.covered.empty() ? w.covered
                                   : likely_cause(parameters, w.theory, w.start);
    return w;
}

/// Why nothing was measured of a wave that begins above the field of its onset.
inline std::string begins_too_high(const WaveRecord& w) {
    if (w.in_noise)
        return sentence("the noise of particles comes to ", w.early,
                        ", above the field of the onset, ", w.level,
                        ": raise particles_per_cell, or follow a mode that grows faster");
    if (w.noise < w.level && w.theory.seed > 0)
        return sentence("the perturbation begins with ", w.early,
                        ", above the field of the onset, ", w.level, ", and only ", w.theory.seed,
                        " of it is the growing wave: lower the amplitude ", w.early / w.level,
                        " times or more");
    return sentence("noise begins with ", w.early, ", above the field of the onset, ", w.level,
                    ": take loading = \"quiet\", or raise particles_per_cell");
}

/// Takes back what was measured where noise, or another wave, is in the place of that of theory.
inline void doubt_wave(const Case& parameters, WaveRecord& w) {
    common::MeasuredMode& seen = w.seen;
    const bool too_fast = seen.growth() - 3 * seen.growth_error() > std::max(w.growth(), 0.0);
    w.in_noise = w.noisy && w.noise < w.level && std::min(w.early, w.later_noise) > w.level &&
                 !(seen.found && too_fast);
    w.grows_right = std::fabs(seen.growth() - w.growth()) <=
                    seen.growth_error() + parameters.growth_tolerance * w.growth();
    // Far from the frequency of theory, and growing no faster, is another wave, or noise.
    const bool elsewhere =
        seen.found && !too_fast &&
        std::fabs(w.frequency_off()) >
            0.3 * w.theory.scale(std::abs(w.theory.omega)) + seen.frequency_error();
    // What begins above the onset has saturated before it can be measured, or noise has covered it.
    const bool too_high = std::max(w.noise, w.amplitude.front()) > w.level || w.in_noise;
    if (w.grows && too_high && (!w.grows_right || (elsewhere && seen.growth_error() > w.growth())))
        seen.found = false, seen.reason = begins_too_high(w), seen.over = false;
    else if (elsewhere && w.later_noise > 0.3 * w.start.field && w.periods() < w.search.periods &&
             std::fabs(w.e_foldings()) < w.search.e_foldings)
        seen.found = false, seen.over = false,
        seen.reason = sentence("cannot be measured, because the wave of theory has ", w.periods(),
                               " periods and ", std::fabs(w.e_foldings()), " e-foldings, below ",
                               w.search.periods, " and ", w.search.e_foldings, ", ", seen.window,
                               ", and omega = ", seen.omega.real(),
                               " is seen in its place: raise time.end, and the amplitude or "
                               "particles_per_cell where noise hides it");
}

/// A measured number of the wave over that of theory.
inline void judge_number(const WaveRecord& w, const std::string& name, double value, double error,
                         double expected, double tolerance, Summary& summary) {
    if (w.seen.found)
        summary.result(name, {value / expected, error / std::fabs(expected)}, "", 1, tolerance,
                       w.where());
    else
        summary.not_measured(name,
                             w.seen.reason + (!w.seen.over ? ""
                                              : w.seeded   ? ": lower the amplitude"
                                                           : ": raise particles_per_cell, so that "
                                                             "noise starts it lower"));
}

/// The frequency, which has a cause of its own where it is low; that of a single wave has its sign.
inline void judge_frequency(const Case& parameters, const WaveRecord& w, Summary& summary) {
    const common::MeasuredMode& seen = w.seen;
    const double expected = w.theory.mirrored ? w.frequency() : w.theory.omega.real(),
                 scale = w.theory.scale(expected),
                 deviation = std::copysign(w.frequency_off(),
                                           w.frequency_off() * w.theory.in_plasma.real()) /
                             scale,
                 tolerance = parameters.frequency_tolerance * scale / w.frequency();
    if (seen.found && w.told.empty() && w.covered.empty() &&
        deviation < -parameters.frequency_tolerance - seen.frequency_error() / scale)
        summary.hint(likely_cause(parameters, w.theory, w.start, deviation));
    judge_number(w, "omega_over_theory", w.theory.mirrored ? seen.frequency() : seen.omega.real(),
                 seen.frequency_error(), expected, tolerance, summary);
    summary.hint(w.cause);
}

/// What grows: its rate, its frequency where it has one, and when it is seen.
inline void judge_growing_wave(const Case& parameters, const WaveRecord& w, Summary& summary) {
    const double growth = w.growth();
    if (w.seen.found && w.e_foldings() < 1 && likely_driven_by_mesh(parameters).empty())
        summary.hint(sentence("the wave grows only by exp(", w.e_foldings(), ") in the ",
                              w.periods(),
                              " periods that are measured at a time: raise "
                              "theory.growth_tolerance, or look at the onset"));
    judge_number(w, "growth_over_theory", w.seen.growth(), w.seen.growth_error(), growth,
                 parameters.growth_tolerance, summary);
    summary.hint(w.cause);
    if (w.frequency() > 0.1 * growth) judge_frequency(parameters, w, summary);

    const double allowed = 0.5 / growth, end = w.times.back(),
                 at = common::time_at_level(w.times, w.amplitude, w.level);
    if (w.onset == 0 || end <= w.onset + allowed) return;
    const double reached = std::isnan(at) ? end : at;
    const bool late = std::fabs(reached - w.onset) > allowed;
    if (w.noise > 0.3 * w.theory.seed || (w.noisy && w.seen.found && w.grows_right && late))
        summary.not_measured("onset", begins_in_noise(w.early, w.theory.seed));
    else if (w.early > w.level)
        summary.not_measured("onset", begins_too_high(w));
    else if (const std::string faster = faster_mode(parameters, w.theory); late && !faster.empty())
        summary.not_measured("onset", faster);
    else
        summary.result("onset", reached, "1/omega_p", w.onset, allowed, onset_meaning);
}

/// Where nothing should grow, nothing may; but a quiet start does not stay quieter than noise.
inline void judge_largest(const Case& parameters, const WaveRecord& w, Summary& summary) {
    const double largest = std::ranges::max(w.amplitude) / w.largest_at_start,
                 part = w.later_noise / w.largest_at_start,
                 allowed = 1.2 * std::exp(std::max(0.0, w.growth()) * w.times.back());
    if (!(w.largest_at_start > 0))
        summary.not_measured(
            "largest_over_start",
            parameters.weighting == "ngp"
                ? "cannot be measured, because with method.weighting = \"ngp\" particles that are "
                  "displaced by less than their distance keep their nearest node, and the record "
                  "begins with zero: raise the amplitude or particles_per_cell, or take \"cic\""
                : "cannot be measured, because the charges of the perturbations cancel and the "
                  "record begins with zero: perturb one species alone");
    else if (!w.covered.empty())
        summary.not_measured("largest_over_start", w.covered);
    else if (const std::string faster = faster_mode(parameters, w.theory);
             largest > allowed && !faster.empty())
        summary.not_measured("largest_over_start", faster);
    else if (largest > allowed && largest < allowed + 3 * part)
        summary.not_measured(
            "largest_over_start",
            sentence(
                "the noise of particles, of which a quiet start shows more and more, may become ",
                part, " of the wave: raise amplitude or particles_per_cell"));
    else
        summary.result_at_most("largest_over_start", largest, "", allowed,
                               w.growth() > 0 ? "the growth of theory" : "no growing root");
}

/// What does not grow: that it does not, its frequency, and its damping or that it has none.
inline void judge_lasting_wave(const Case& parameters, const WaveRecord& w, Summary& summary) {
    const bool damped = w.growth() < -1e-3 * w.theory.scale(w.frequency());
    if (!w.seeded) {
        for (const char* name : {"largest_over_start", "omega_over_theory", "damping_over_theory"})
            if (damped || name[0] != 'd')
                summary.not_measured(name,
                                     "no species is perturbed in this mode, and noise and "
                                     "round-off alone are no wave to measure: give one an "
                                     "amplitude");
        return;
    }
    judge_largest(parameters, w, summary);
    if (!w.swings()) {
        summary.not_measured("omega_over_theory",
                             "the mode of theory is too damped to swing: take a smaller "
                             "theory.mode_x, or a colder plasma");
        return;
    }
    judge_frequency(parameters, w, summary);
    if (damped)
        judge_number(w, "damping_over_theory", w.seen.growth(), w.seen.growth_error(), w.growth(),
                     parameters.growth_tolerance, summary);
    else if (w.seen.found)
        judge_undamped(w.seen, w.growth(), w.theory.scale(w.seen.frequency()), w.where(), summary);
}

/// A wave or an instability against the dispersion relation: frequency, growth or damping, and of
/// what grows the onset as well.
inline void compare_wave(const Case& parameters, const History& history, Summary& summary) {
    WaveRecord w = measure_wave(parameters, history);
    const Theory& theory = w.theory;
    summary.result_info("theory_omega", theory.omega.real(), omega_p_unit, theory.source);
    summary.result_info("theory_growth", theory.omega.imag(), omega_p_unit, theory.source);
    summary.result_info("mode_x", double(theory.mode_x), "", "followed");
    doubt_wave(parameters, w);
    summary.hint(w.cause);
    if (w.seen.found && (w.grows || w.seeded)) {
        summary.result_info("omega", {w.seen.omega.real(), w.seen.frequency_error()}, omega_p_unit,
                            w.where());
        summary.result_info("growth", {w.seen.growth(), w.seen.growth_error()}, omega_p_unit,
                            w.where());
    }
    if (w.grows)
        judge_growing_wave(parameters, w, summary);
    else
        judge_lasting_wave(parameters, w, summary);
}

/// Frequency, growth and onset of the followed mode in words, before the run.
inline Lines describe_wave(const Case& parameters) {
    const Theory theory = theory_of_wave(parameters);
    Lines lines{{"theory", mode_text(theory.mode_x, theory.mode_z) +
                               ": omega = " + format(theory.omega.real()) + ", growth = " +
                               format(theory.omega.imag()) + " omega_p; " + theory.source}};
    if (theory.seed > 0) lines.push_back({"seeded field", "E_k = " + format(theory.seed)});
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
            const bool search = parameters.mode_x == 0 && parameters.mode_z == 0;
            const long modes = (parameters.grid.x.cells - 1) / 2;
            refuse_wave(parameters, asked_for(parameters), search ? modes : parameters.mode_x,
                        parameters.mode_z);
            refuse(search && parameters.model == "mesh",
                   "theory.mode_x = 0 looks for the fastest growing mode with theory.model = "
                   "\"plasma\", and not \"mesh\": name a mode, or take \"plasma\"");
            refuse(search && (modes < 1 || modes > 512),
                   "theory.mode_x = 0 looks for the fastest growing of ", modes,
                   " modes, and that is for 1 to 512: name a mode");
        },
    .recorded_mode_x = [](const Case& parameters) { return theory_of_wave(parameters).mode_x; },
    .describe = describe_wave,
    .add_warnings =
        [](const Case& parameters, std::vector<std::string>& warnings) {
            const std::complex<double> omega = theory_of_wave(parameters).omega;
            const double period = 2 * pi / std::fabs(omega.real());
            common::warn(warnings,
                         omega.imag() <= 0 && omega.real() != 0 && period > parameters.end,
                         "the wave of theory has the period ", period,
                         ", longer than time.end = ", parameters.end,
                         ": its frequency cannot be measured well");
            for (const SpeciesCase& s : parameters.species)
                for (const PerturbationCase& p : perturbations_of(parameters, s))
                    common::warn(warnings,
                                 s.mobile() && p.wave == "standing" && p.amplitude > 0.5 &&
                                     omega.imag() <= 0 &&
                                     s.temperatures(parameters.axis())[p.mode_x != 0 ? 0 : 2] == 0,
                                 s.name, ": a cold standing wave of the amplitude ", p.amplitude,
                                 ", above 0.5, breaks within half a period, when its particles "
                                 "overtake each other: lower it");
        },
    .add_results = compare_wave};

}  // namespace cic
