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

/// How fast particles bounce in the field of a wave, sqrt(|q| k E/m), of the lightest charge.
inline double bounce_frequency(const Case& parameters, const Theory& theory, double field) {
    double most = 0;
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile()) most = std::max(most, std::fabs(s.charge) / s.mass);
    return std::sqrt(most * wave_vector(parameters, theory.mode_x, theory.mode_z).size() * field);
}

/// Amplitude of the field at which an instability is visible: a tenth of the one in which the
/// species with the largest |q|/m bounces as fast as the wave grows, |q| k E/m = gamma^2, where
/// linear growth ends.
inline double onset_field(const Case& parameters, const Theory& theory) {
    const double gamma = theory.omega.imag();
    return 0.1 * gamma * gamma / std::pow(bounce_frequency(parameters, theory, 1), 2);
}

/// Time of the onset, before the run: the seeded field grows at the rate of theory, where a wave and
/// its mirror image run against each other both of them.
/// out:    0 for a mode that does not grow or is not seeded
inline double predicted_onset(const Case& parameters, const Theory& theory) {
    const double growth = theory.omega.imag(), onset = onset_field(parameters, theory);
    const double seed = theory.seed * (theory.mirrored && theory.omega.real() != 0 ? 2 : 1);
    return growth > 0 && seed > 0 && onset > seed ? std::log(onset / seed) / growth : 0;
}
/// What the onset is, in words.
inline const std::string onset_meaning = "the seed has grown to a tenth of what traps particles";

/// The field that the noise of randomly placed particles has in the mode, rms, before it is screened.
///   E_k^2 = sum_s (2 q_s n_s / k)^2 / N_s
/// in:     later, whether quiet species count, too: their particles become as random
inline double noise_field(const Case& parameters, const Theory& theory, bool later = true) {
    const double k = wave_vector(parameters, theory.mode_x, theory.mode_z).size();
    double squares = 0;
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile() && (s.loading == "random" || (later && s.loading != "lattice")))
            squares += std::pow(2 * s.charge * s.density / k, 2) /
                       (double(s.particles_per_cell) * double(parameters.grid.x.cells) *
                        double(parameters.dimensions == 2 ? parameters.grid.z.cells : 1));
    return std::sqrt(squares);
}

/// Whether some species is perturbed in the followed mode, in either direction.
inline bool is_seeded(const Case& parameters, const Theory& theory) {
    for (const SpeciesCase& s : parameters.species)
        for (const PerturbationCase& p : perturbations_of(parameters, s))
            if (p.is_of(theory.mode_x, theory.mode_z) || p.is_of(-theory.mode_x, -theory.mode_z))
                return true;
    return false;
}

/// Where particles bounce faster in this field than the wave of theory grows or decays: that, and
/// what to change; else nothing.
inline std::string likely_bouncing(const Case& parameters, const Theory& theory, double field) {
    const double bounce = bounce_frequency(parameters, theory, field),
                 rate = std::fabs(theory.omega.imag());
    if (!(bounce > rate && rate > 1e-3 * std::abs(theory.omega))) return "";
    return sentence("particles bounce in the wave with ", bounce, ", faster than the rate ", rate,
                    ", and linear theory does not hold: lower the amplitude to ",
                    format(rate * rate / (bounce * bounce)), " of it");
}

/// Cold plasma that moves through its mesh as a whole, along x or along z: aliases of its waves resonate with
/// each other. Where that comes out of round-off by the end, that, and what to change; else nothing.
/// Species with another drift may have a two-hundredth of omega_p^2, warm ones with the same drift a tenth:
/// more of them, and other waves are faster.
/// note:   The rate is that of mesh_dispersion() at 3/8 (tsc 7/16) of a wavelength in a cell, which hardly
///         depends on the drift from 0.05 to 5 omega_p dx, or on the step; at 0.03 it is 0.6 of that. ngp has 0.36 to
///         0.50.
inline std::string likely_driven_by_mesh(const Case& parameters) {
    if (parameters.conserving != "momentum" || parameters.gauss_sign < 0) return "";
    const bool cic = parameters.weighting == "cic", tsc = parameters.weighting == "tsc";
    const auto driven = [&](std::size_t direction, const common::Axis& axis,
                            double SpeciesCase::*drift) -> std::string {
        const auto omega2 = [](const SpeciesCase& s) {
            return s.mobile() && s.profile != "point"
                       ? s.charge * s.charge * s.mean_density() / s.mass
                       : 0;
        };
        const auto cold = [&](const SpeciesCase& s) {
            return s.temperatures(parameters.axis())[direction] == 0;
        };
        const SpeciesCase* main = nullptr;
        for (const SpeciesCase& s : parameters.species)
            if (cold(s) && omega2(s) > (main ? omega2(*main) : 0)) main = &s;
        if (!main || !axis.periodic || parameters.turns(direction)) return "";
        double own = 0, warm = 0, other = 0;
        for (const SpeciesCase& s : parameters.species) {
            const bool along = std::fabs(s.*drift - main->*drift) <= 0.01 * std::fabs(main->*drift);
            (!along ? other : cold(s) ? own : warm) += omega2(s);
        }
        const double omega_p = std::sqrt(own),
                     u = std::fabs(main->*drift) / (omega_p * axis.spacing()),
                     rate = (tsc   ? 0.1
                             : cic ? 0.2
                                   : 0.4) *
                            (u < 0.05 ? 0.6 : 1) * omega_p;
        if (other > 0.005 * own || warm > 0.1 * own || !(u > 0.025) ||
            !(rate * parameters.end > 15))
            return "";
        const std::string energy =
            sentence("take method.scheme = \"energy\"",
                     cic || tsc ? "" : " and method.weighting = \"cic\"", ", or ");
        return sentence(
            "aliases drive waves of two or three cells through cold plasma that moves, "
            "growth = ",
            rate, " or so: ", u > cold_beam_threshold(tsc ? 2 : 1) ? energy : "",
            "give it a temperature with a Debye length of a third of a cell or more, and "
            "loading = \"quiet\"");
    };
    const std::string along_x = driven(0, parameters.grid.x, &SpeciesCase::drift_x);
    return !along_x.empty() || parameters.dimensions == 1
               ? along_x
               : driven(2, parameters.grid.z, &SpeciesCase::drift_z);
}

/// By how much the leapfrog changes a wave, relative: (omega dt)^2/24, where it grows with the frequency of
/// the plasma, and (Omega dt)^2/12 of a gyration.
inline double change_by_leapfrog(const Case& parameters, const Theory& theory) {
    double omega2 = std::norm(theory.omega), gyration = 0;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        if (theory.omega.imag() > 0)
            omega2 = std::max(omega2, s.charge * s.charge * s.mean_density() / s.mass);
        if (parameters.magnetized())
            gyration = std::max(gyration, std::fabs(s.charge) * parameters.B.size() / s.mass);
    }
    const double dt2 = parameters.dt * parameters.dt;
    return std::max(omega2 * dt2 / 24, gyration * gyration * dt2 / 12);
}

/// Where another mode along x, or along z as the followed one, grows from its seed or from noise to the field
/// in which it traps particles: that, and what to change; else nothing. When it saturates it drives all modes.
inline std::string faster_mode(const Case& parameters, const Theory& theory) {
    if (parameters.magnetized() || parameters.has_distributions()) return "";
    const bool along_z = theory.mode_x == 0;
    const long cells = (along_z ? parameters.grid.z : parameters.grid.x).cells;
    Theory fastest;
    fastest.omega = {0, std::max(theory.omega.imag(), 5 / parameters.end)};
    Case any = parameters;
    any.near = 0, any.model = "plasma";
    for (long m = 1; m <= 32 && 2 * m < cells; ++m) try {
            if (m == std::labs(along_z ? theory.mode_z : theory.mode_x) &&
                (along_z || theory.mode_z == 0))
                continue;
            const Theory other =
                theory_of_wave(any, along_z ? 0 : m, along_z ? m : 0, fastest.omega.imag());
            const double growth = other.omega.imag();
            if (!(growth > fastest.omega.imag())) continue;
            const double seed = std::max(other.seed, noise_field(parameters, other));
            if (seed * std::exp(growth * parameters.end) > onset_field(parameters, other))
                fastest = other;
        } catch (const common::InputError&) {  // none was found
        }
    if (fastest.mode_x == 0 && fastest.mode_z == 0) return "";
    return sentence(mode_text(fastest.mode_x, fastest.mode_z), " of this box grows with ",
                    fastest.omega.imag(), theory.omega.imag() > 0 ? ", faster, " : ", ",
                    "and drives all others when it saturates: shorten the box to one wavelength of "
                    "the mode that is followed, or the run");
}

/// Amplitudes that a wave begins with.
struct WaveStart {
    double field = 0;        // without noise
    double noise = 0;        // of random numbers
    double later_noise = 0;  // that a quiet start comes to, where it is more than the perturbation
};
/// That noise starts the wave, and what to change.
inline std::string begins_in_noise(double noise, double seed) {
    return sentence("noise starts the wave: it begins with ", noise, ", and the seed is ", seed,
                    ": raise the amplitude or particles_per_cell");
}

/// What a wave that is not as in theory is most likely due to, and what to change.
/// in:     deviation of the frequency from theory, relative; 0 where the rate is asked about
inline std::string likely_cause(const Case& parameters, const Theory& theory,
                                const WaveStart& start, double deviation = 0) {
    const double field = start.field, noise = start.noise;
    const double by_step = change_by_leapfrog(parameters, theory),
                 k_dx =
                     wave_vector(parameters, theory.mode_x, 0).size() * parameters.grid.x.spacing(),
                 k_dz =
                     wave_vector(parameters, 0, theory.mode_z).size() * parameters.grid.z.spacing();
    // Where validate() takes that model.
    const bool takes_mesh = !parameters.has_distributions() && !parameters.magnetized() &&
                            parameters.gauss_sign > 0 &&
                            (theory.mode_x == 0 || theory.mode_z == 0) &&
                            (parameters.mode_x != 0 || parameters.mode_z != 0);
    const double tolerance = theory.omega.real() == 0 ? parameters.growth_tolerance
                                                      : parameters.frequency_tolerance,
                 theta = std::max(k_dx, k_dz), slower = 2 - std::cos(k_dx / 2) - std::cos(k_dz / 2);
    const bool conserving = parameters.scheme().energy_conserving,
               by_mesh =
                   parameters.model != "mesh" && !conserving && (theta > 0.5 || slower > tolerance);
    const std::string driven = likely_driven_by_mesh(parameters),
                      also = driven.empty() ? "" : "; and " + driven;
    const char* exact = takes_mesh ? ", or take theory.model = \"mesh\"" : "";
    const std::string leapfrog = sentence("the leapfrog changes the wave by ", by_step,
                                          " or so: lower time.dt", exact, also);
    if (noise > 0.1 * field)
        return sentence("random particles have up to ", noise / field,
                        " of the seeded field in this mode: raise amplitude or particles_per_cell, "
                        "or take loading = \"quiet\"");
    if (parameters.model != "mesh" && by_step > tolerance && (!by_mesh || by_step > slower))
        return leapfrog;
    // The mesh lowers a frequency whatever particles do beside.
    if (!(by_mesh && deviation < 0 && deviation > -2 * slower)) {
        const std::string bouncing = likely_bouncing(parameters, theory, field);
        if (!bouncing.empty()) return bouncing;
        const std::string faster = faster_mode(parameters, theory);
        if (!faster.empty()) return faster;
    }
    if (by_mesh)
        return sentence(k_dx > k_dz ? "k dx is " : "k dz is ", theta,
                        ", and the mesh changes the wave by 1 - cos(k dx/2)",
                        k_dx > 0 && k_dz > 0 ? " of both directions = " : " = ", slower,
                        " or so: raise ",
                        k_dx > 0 && k_dz > 0 ? "grid.cells_x and cells_z"
                        : k_dx > k_dz        ? "grid.cells_x"
                                             : "grid.cells_z",
                        exact, also);
    if (parameters.model != "mesh" && by_step > 0.5 * tolerance) return leapfrog;
    if (!driven.empty()) return driven;
    if (theory.hidden != 0.0)
        return sentence("another wave of this mode, omega = ", theory.hidden.real(),
                        ", growth = ", theory.hidden.imag(),
                        ", decays hardly faster, and the record has both: take another mode, or a "
                        "perturbation that has less of it");
    const bool cold = std::ranges::none_of(parameters.species, [&](const SpeciesCase& s) {
        return s.mobile() && s.temperatures(parameters.axis())[theory.mode_x != 0 ? 0 : 2] > 0;
    });
    if (conserving && cold && theory.omega.imag() <= 0)
        return "on the energy-conserving mesh a cold wave whose particles go from cell to cell "
               "feeds others: lower the amplitude, or give it a temperature with a Debye length "
               "of a third of a cell and loading = \"quiet\"";
    if (start.later_noise > 0) return begins_in_noise(start.later_noise, theory.seed);
    if (noise > 0)
        return "the noise of particles is the most likely cause: raise particles_per_cell, or take "
               "loading = \"quiet\"";
    if (const double left = std::exp(theory.omega.imag() * parameters.end); left < 0.05)
        return sentence("by the end ", left,
                        " of the wave is left, and what hides it is noise: "
                        "raise the amplitude or particles_per_cell");
    return "another wave beside it, or too short a record, is the most likely cause: raise "
           "time.end, or particles_per_cell where the start is quiet";
}

/// The wave of the mode of theory that is followed without theory.near: where one grows, the fastest.
inline std::complex<double> fastest_of_mode(const Case& parameters, const Theory& theory) try {
    Case any = parameters;
    any.near = 0;
    return parameters.near == 0 ? theory.omega
                                : theory_of_wave(any, theory.mode_x, theory.mode_z).omega;
} catch (const common::InputError&) {  // none was found
    return theory.omega;
}

/// Where a wave of the same mode is much nearer to what was measured than the one that was looked for: which
/// one; else nothing.
inline std::string other_wave(const Case& parameters, const Theory& theory,
                              const common::MeasuredMode& seen) try {
    if (!seen.found || seen.omega.real() == 0) return "";
    Case any = parameters;
    any.near = theory.mirrored ? std::fabs(seen.omega.real()) : seen.omega.real();
    const double other = theory_of_wave(any, theory.mode_x, theory.mode_z).omega.real(),
                 off = std::fabs(theory.omega.real() - any.near),
                 left = std::fabs(other - any.near);
    const double near =
        std::max(3 * seen.frequency_error(), parameters.frequency_tolerance * std::fabs(other));
    if (!(off > 3 * seen.frequency_error() && left < 0.3 * off && left < near)) return "";
    return sentence("what was measured is another wave of this mode, omega = ", other,
                    ": take theory.near = ", other, ", or a perturbation that has less of it");
} catch (const common::InputError&) {  // none was found
    return "";
}

/// What a wave that theory does not damp loses: at most 2e-3 of omega, per time.
inline void judge_undamped(const common::MeasuredMode& seen, double growth,
                           const std::string& where, Summary& summary) {
    summary.result("damping", {-seen.growth(), seen.growth_error()}, omega_p_unit, 0 - growth,
                   2e-3 * seen.frequency(), where);
}

/// A wave or an instability against the dispersion relation: frequency, growth or damping by
/// measure_mode(); of what grows the onset as well.
///   the record begins when the transient of the start is over: a growth time, or a period
///   what grows ends at a tenth of its maximum
inline void compare_wave(const Case& parameters, const History& history, Summary& summary) {
    const Theory theory = theory_of_wave(parameters);
    const auto times = history.column("time");
    const std::vector<std::complex<double>> mode = history.complex_column("mode");
    std::vector<double> amplitude;
    for (const std::complex<double> E_k : mode) amplitude.push_back(std::abs(E_k));
    const double growth = theory.omega.imag(), frequency = std::fabs(theory.omega.real());
    summary.result_info("theory_omega", theory.omega.real(), omega_p_unit, theory.source);
    summary.result_info("theory_growth", growth, omega_p_unit, theory.source);
    summary.result_info("mode_x", double(theory.mode_x), "", "followed");
    const double start = *std::max_element(
        amplitude.begin(),
        amplitude.begin() + static_cast<std::ptrdiff_t>(1 + amplitude.size() / 10));
    const bool grows = growth > 1e-3 * std::abs(theory.omega) || growth * times.back() > 3,
               seeded = is_seeded(parameters, theory);
    common::ModeSearch search;
    search.expected = {theory.omega};
    if (theory.mirrored) search.expected.push_back(-std::conj(theory.omega));
    const double onset = predicted_onset(parameters, theory);
    const double noise = noise_field(parameters, theory, false);
    const double seed = theory.seed * (theory.mirrored ? 2 : 1);
    const double field = seed > 0 ? seed : start;
    const std::complex<double> fastest =
        grows || !seeded ? theory.omega : fastest_of_mode(parameters, theory);
    const bool other = std::abs(fastest - theory.omega) > 1e-6 * std::abs(fastest),
               covered = !grows && other && fastest.imag() * times.back() > 1;
    const std::string covers = sentence(
        "another wave of this mode grows, with ", fastest.imag(), " at omega = ", fastest.real(),
        ", and covers this one: take theory.near = ", fastest.real());
    const std::string bouncing = likely_bouncing(parameters, theory, field);
    if (!bouncing.empty()) search.faded = bouncing;
    search.begin = grows ? 1 / growth : 2 * pi / frequency;
    search.below_maximum = 0.1;
    if (onset > search.begin) search.end = onset;
    const bool swings = frequency > 0 && frequency >= 0.01 * std::fabs(growth);
    common::MeasuredMode seen =
        grows || swings ? common::measure_mode(times, mode, search) : common::MeasuredMode{};
    // Of a wave that decays, noise that rings as it does moves the phase: no fit can tell it apart.
    if (!grows && seed > 0) {
        const double moved =
            2 * noise / seed * std::max(std::fabs(growth), 1 / (seen.end - seen.begin));
        seen.error = {std::hypot(seen.error.real(), moved), std::hypot(seen.error.imag(), moved)};
    }
    const double level = onset_field(parameters, theory), length = seen.end - seen.begin,
                 folds = growth * length, periods = frequency * length / (2 * pi);
    double early = noise;
    for (std::size_t n = 0; n < times.size() && times[n] < search.begin; ++n)
        early = std::max(early, amplitude[n]);
    // What the perturbation has by search.begin, a growth time, without noise.
    const double own = std::max(amplitude.front(), std::exp(1.0) * theory.seed),
                 later_noise = noise_field(parameters, theory);
    const bool noisy = grows && later_noise > 0 && early > 1.05 * own;
    const WaveStart begin{field, noise, noisy && early > 2 * own ? early : 0};
    const std::string told = grows ? "" : other_wave(parameters, theory, seen),
                      cause = !told.empty() ? told
                              : covered     ? covers
                                            : likely_cause(parameters, theory, begin);
    summary.hint(cause);
    // What begins above the onset has saturated before it can be measured, or noise has covered it.
    const double begins = std::max(noise, amplitude.front()),
                 too_fast = seen.growth() - 3 * seen.growth_error() - std::max(growth, 0.0);
    const bool in_noise = noisy && noise < level && std::min(early, later_noise) > level &&
                          !(seen.found && too_fast > 0);
    const std::string too_high =
        in_noise ? sentence("the noise of particles comes to ", early,
                            ", above the field of the onset, ", level,
                            ": raise particles_per_cell, or follow a mode that grows faster")
        : noise < level && theory.seed > 0
            ? sentence("the perturbation begins with ", early, ", above the field of the onset, ",
                       level, ", and only ", theory.seed,
                       " of it is the growing wave: lower the amplitude ", early / level,
                       " times or more")
            : sentence("noise begins with ", begins, ", above the field of the onset, ", level,
                       ": take loading = \"quiet\", or raise particles_per_cell");
    // Far from the frequency of theory, and growing no faster, is another wave, or noise.
    const double off =
        theory.mirrored ? seen.frequency() - frequency : seen.omega.real() - theory.omega.real();
    const bool grows_right = std::fabs(seen.growth() - growth) <=
                             seen.growth_error() + parameters.growth_tolerance * growth,
               elsewhere = seen.found && !(too_fast > 0) &&
                           std::fabs(off) > 0.3 * std::abs(theory.omega) + seen.frequency_error();
    if (grows && (begins > level || in_noise) &&
        (!grows_right || (elsewhere && seen.growth_error() > growth)))
        seen.found = false, seen.reason = too_high, seen.over = false;
    else if (elsewhere && later_noise > 0.3 * field && periods < search.periods &&
             std::fabs(folds) < search.e_foldings)
        seen.found = false, seen.over = false,
        seen.reason = sentence("cannot be measured, because the wave of theory has ", periods,
                               " periods and ", std::fabs(folds), " e-foldings, below ",
                               search.periods, " and ", search.e_foldings, ", ", seen.window,
                               ", and omega = ", seen.omega.real(),
                               " is seen in its place: raise time.end, and the amplitude or "
                               "particles_per_cell where noise hides it");
    const std::string where = theory.source + "; measured " + seen.window;
    const auto report = [&](const std::string& name, double value, double error, double expected,
                            double tolerance) {
        if (seen.found)
            summary.result(name, {value / expected, error / std::fabs(expected)}, "", 1, tolerance,
                           where);
        else
            summary.not_measured(name,
                                 seen.reason + (!seen.over ? ""
                                                : seeded   ? ": lower the amplitude"
                                                           : ": raise particles_per_cell, so that "
                                                             "noise starts it lower"));
    };
    if (seen.found && (grows || seeded)) {
        summary.result_info("omega", {seen.omega.real(), seen.frequency_error()}, omega_p_unit,
                            where);
        summary.result_info("growth", {seen.growth(), seen.growth_error()}, omega_p_unit, where);
    }
    // The frequency has a cause of its own, and its single wave has its direction, too.
    const auto report_frequency = [&] {
        const double deviation = off / (theory.mirrored ? frequency : theory.omega.real());
        if (seen.found && told.empty() && !covered &&
            deviation < -parameters.frequency_tolerance - seen.frequency_error() / frequency)
            summary.hint(likely_cause(parameters, theory, begin, deviation));
        else
            summary.hint(cause);
        report("omega_over_theory", theory.mirrored ? seen.frequency() : seen.omega.real(),
               seen.frequency_error(), theory.mirrored ? frequency : theory.omega.real(),
               parameters.frequency_tolerance);
        summary.hint(cause);
    };
    if (grows) {
        if (seen.found && folds < 1 && likely_driven_by_mesh(parameters).empty())
            summary.hint(sentence("the wave grows only by exp(", folds, ") in the ", periods,
                                  " periods that are measured at a time: raise "
                                  "theory.growth_tolerance, or look at the onset"));
        report("growth_over_theory", seen.growth(), seen.growth_error(), growth,
               parameters.growth_tolerance);
        if (frequency > 0.1 * growth) report_frequency();
        const double allowed = 0.5 / growth, at = common::time_at_level(times, amplitude, level);
        if (onset == 0 || times.back() <= onset + allowed) return;
        const double reached = std::isnan(at) ? times.back() : at;
        const bool late = std::fabs(reached - onset) > allowed;
        if (noise > 0.3 * theory.seed || (noisy && seen.found && grows_right && late))
            summary.not_measured("onset", begins_in_noise(early, theory.seed));
        else if (early > level)
            summary.not_measured("onset", too_high);
        else if (const std::string faster = faster_mode(parameters, theory);
                 late && !faster.empty())
            summary.not_measured("onset", faster);
        else
            summary.result("onset", reached, "1/omega_p", onset, allowed, onset_meaning);
        return;
    }

    const bool damped = growth < -1e-3 * frequency;
    if (!seeded) {
        for (const char* name : {"largest_over_start", "omega_over_theory", "damping_over_theory"})
            if (damped || name[0] != 'd')
                summary.not_measured(name,
                                     "no species is perturbed in this mode, and noise and "
                                     "round-off alone are no wave to measure: give one an "
                                     "amplitude");
        return;
    }
    // Where nothing should grow, nothing may; but a quiet start does not stay quieter than noise.
    const double largest = std::ranges::max(amplitude) / start,
                 part = noise_field(parameters, theory) / start,
                 allowed = 1.2 * std::exp(std::max(0.0, growth) * times.back());
    if (!(start > 0))
        summary.not_measured(
            "largest_over_start",
            parameters.weighting == "ngp"
                ? "cannot be measured, because with method.weighting = \"ngp\" particles that are "
                  "displaced by less than their distance keep their nearest node, and the record "
                  "begins with zero: raise the amplitude or particles_per_cell, or take \"cic\""
                : "cannot be measured, because the charges of the perturbations cancel and the "
                  "record begins with zero: perturb one species alone");
    else if (covered)
        summary.not_measured("largest_over_start", covers);
    else if (const std::string faster = faster_mode(parameters, theory);
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
                               growth > 0 ? "the growth of theory" : "no growing root");
    if (!swings) {
        summary.not_measured("omega_over_theory",
                             "the mode of theory is too damped to swing: take a smaller "
                             "theory.mode_x, or a colder plasma");
        return;
    }
    report_frequency();
    if (damped)
        report("damping_over_theory", seen.growth(), seen.growth_error(), growth,
               parameters.growth_tolerance);
    else if (seen.found)
        judge_undamped(seen, growth, where, summary);
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
        },
    .add_results = compare_wave};

}  // namespace cic
