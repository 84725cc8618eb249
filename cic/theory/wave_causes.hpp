// What a wave begins with, and what it is most likely due to where a run has another one than theory:
// particles that bounce, noise, another mode, the mesh or the step, and which parameter changes that.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "cic/theory/theory_of_case.hpp"
#include "common/theory/measure_modes.hpp"

namespace cic {

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
    if (!(bounce > rate && rate > 1e-3 * theory.scale(std::abs(theory.omega)))) return "";
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
    double omega2 = std::norm(theory.in_plasma), gyration = 0;
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
    double blurs = 0;        // noise over the field, where it makes a frequency uncertain; else 0
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
    // Beside the frequency that is judged, which a drift can make lower than that of the plasma.
    const double beside =
                     theory.omega.imag() <= 0 && theory.omega.real() != 0
                         ? std::fabs(theory.in_plasma.real()) / theory.scale(theory.omega.real())
                         : 1,
                 by_step = beside * change_by_leapfrog(parameters, theory),
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
                 theta = std::max(k_dx, k_dz);
    const bool conserving = parameters.scheme().energy_conserving;
    // cos(k dx/2), or of the energy-conserving mesh sinc(k dx/2)^order
    const auto part = [&](double k_d) {
        return !conserving ? std::cos(k_d / 2)
               : k_d > 0   ? std::pow(std::sin(k_d / 2) / (k_d / 2), parameters.scheme().order)
                           : 1;
    };
    const double slower = beside * (2 - part(k_dx) - part(k_dz));
    const bool by_mesh =
        parameters.model != "mesh" && (start.blurs == 0 || deviation != 0) &&
        (conserving ? slower > tolerance && (deviation < 0 || theory.omega.imag() > 0)
                    : theta > 0.5 || slower > tolerance);
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
                        ", and the mesh changes the wave by ",
                        beside > 1.01 ? ""
                        : conserving  ? "1 - sinc(k dx/2)^order"
                                      : "1 - cos(k dx/2)",
                        beside > 1.01          ? ""
                        : k_dx > 0 && k_dz > 0 ? " of both directions = "
                                               : " = ",
                        slower, " or so: raise ",
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
    if (start.blurs > 0)
        return sentence("the noise of particles comes to ", start.blurs,
                        " of the seeded field: raise particles_per_cell");
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

}  // namespace cic
