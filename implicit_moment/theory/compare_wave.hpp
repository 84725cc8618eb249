// The seeded mode of a uniform plasma beside theory: frequency and damping of a wave, growth rate of
// an instability, and what may be the cause where they differ.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "common/run/run.hpp"
#include "common/theory/measure_modes.hpp"
#include "implicit_moment/output/columns.hpp"
#include "implicit_moment/theory/images_of_mode.hpp"
#include "implicit_moment/theory/wave_theory.hpp"

namespace implicit_moment {

/// How far particles of a seeded wave swing, in cells.
///     u/omega,   u of the seed, or (q/m) E/omega or the drift c E/B of its E, whatever is less
inline double swing_in_cells(const Case& w, double omega) {
    const UniformCase& u = w.uniform;
    const double B = std::hypot(u.B_x, u.B_y, u.B_z);
    double cells = 0;
    for (const SpeciesCase& s : u.species) {
        const double by_E =
                         std::min(std::fabs(s.charge / s.mass) / omega, B > 0 ? c / B : HUGE_VAL),
                     u_x = std::max(std::fabs(s.wave_x), by_E * std::fabs(u.wave_E_x)),
                     u_z = std::max(std::fabs(s.wave_z), by_E * std::fabs(u.wave_E_z));
        cells = std::max(
            {cells, u_x / (omega * w.grid.x.spacing()), u_z / (omega * w.grid.z.spacing())});
    }
    return cells;
}

/// The largest T/m of a direction in which theory has no Lorentz factor: that part of the mass gamma m is missing
/// there. The theory of longitudinal waves has the factor, and that of transverse waves without B for all that
/// moves across k.
inline double heat_without_gamma(const Case& w) {
    if (w.wave == "longitudinal") return 0;
    const UniformCase& u = w.uniform;
    const WaveVector k = wave_vector(w);
    const bool along = w.wave == "transverse" && u.B_x == 0 && u.B_y == 0 && u.B_z == 0;
    double heat = 0;
    for (const SpeciesCase& s : u.species)
        heat = std::max({heat, along && k.x == 0 ? 0 : s.temperature_x / s.mass,
                         along ? 0 : s.temperature_y / s.mass,
                         along && k.z == 0 ? 0 : s.temperature_z / s.mass});
    return heat;
}

/// Why a wave may differ from theory, and what to change.
inline std::string likely_cause(const Case& w, const Theory& theory, bool grows,
                                const common::MeasuredMode& seen, double tolerance) {
    const double heat = heat_without_gamma(w);
    if (!theory.of_scheme && w.is_relativistic() && heat > 0.003)
        return "theory is without the Lorentz factor of this heat, and particles with thermal "
               "speeds of " +
               format(std::sqrt(heat)) + " c are heavier by some " + format(heat) +
               " of their mass: set particles.relativistic = false, or lower the temperatures";
    const double damping =
        w.leapfrog.chosen ? 0 : 0.5 * (w.field.theta - 0.5) * std::norm(theory.omega) * w.dt;
    const double counts =
        grows ? 0.5 * tolerance * theory.omega.imag() : 1e-3 * std::abs(theory.omega);
    if (!theory.of_scheme && damping > counts)
        return "field.theta = " + format(w.field.theta) + " damps by some " + format(damping) +
               ", which this theory of short steps does not have: set field.theta = 0.5, or lower "
               "time.dt";
    // Of a leapfrog sin(omega dt/2) = omega' dt/2.
    const double leap = grows ? 0 : std::norm(theory.omega) * w.dt * w.dt / 24;
    const bool low = seen.found && seen.frequency() < std::fabs(theory.omega.real());
    if (w.leapfrog.chosen && !theory.of_scheme && leap > 0.3 * tolerance && !low)
        return "steps of omega dt = " + format(std::abs(theory.omega) * w.dt) +
               " raise the frequency by some " + format(leap) +
               " of it, which this theory of short steps does not have: lower time.dt to " +
               format(w.dt * std::sqrt(0.3 * tolerance / leap));
    const std::string near_c = drifts_near_c(w)
                                   ? "; or raise field.smoothing_passes: particles near "
                                     "c feed light that the mesh slows down (numerical "
                                     "Cherenkov)"
                                   : "";
    if (seen.over || seen.high)
        return (seen.over ? std::string("growth is over before it tells enough")
                          : "it begins near its maximum, or with another mode that has as much") +
               ": lower the seed, and where that is below the noise raise the particles per cell" +
               (std::abs(theory.omega) * w.dt > 0.1
                    ? std::string("; or lower time.dt, which changes it")
                    : "") +
               near_c;
    if (!w.leapfrog.chosen && theory.of_scheme && !w.field.uses_mass_matrix() &&
        w.field.smoothing.passes > 0 &&
        (w.boundary_x == "reflecting" || w.boundary_z == "reflecting"))
        return "what moments predict is smoothed with what is behind walls that reflect, and damps "
               "less: set field.response = \"mass_matrix\", or take \"wall\" for the boundary";
    const double swing = swing_in_cells(w, std::abs(theory.omega));
    if (theory.of_scheme && w.wave != "light" && has_linear_splines(w) && swing > 0.01)
        return "particles swing by " + format(swing) +
               " of a cell, and the force of linear splines jumps between cells, so that the wave "
               "is not linear: lower the seed to " +
               format(0.01 / swing) + " of it, or take particles.order = 2";
    return (grows
                ? "the seed may be below the noise, the run too short, or a step too long: raise "
                  "the particles per cell or the seed, or time.end, or lower time.dt"
                : "noise, a seed so large that the wave is not linear, a step that changes it, or "
                  "a field that this wave does not have are likely causes: raise the particles "
                  "per cell, lower the seed or time.dt, or change theory.component") +
           near_c;
}

/// The seeded mode against theory, by measure_mode(): growth rate of an instability, up to a tenth of
/// its maximum; frequency and damping of a wave.
inline void compare_wave(const Case& w, const common::History& history, common::Summary& summary) {
    const Wave* wave = wave_of(w);
    if (wave == nullptr) return;
    const Theory theory = wave->expect(w);
    const double tolerance = theory.of_scheme ? exact_to(w) : 0.03;
    const auto times = history.column("time");
    const double growth = theory.omega.imag(), frequency = std::fabs(theory.omega.real());
    summary.result_info("theory_omega", frequency, "omega_pi", theory.source);
    summary.result_info("theory_growth", growth, "omega_pi", theory.source);
    if (const auto& without = theory.without_mesh; without.found) {
        const std::string source = "root of the kinetic dispersion relation";
        summary.result_info("theory_omega_without_mesh", std::fabs(without.omega.real()),
                            "omega_pi", source);
        summary.result_info("theory_growth_without_mesh", without.omega.imag(), "omega_pi", source);
    }

    const bool grows = !theory.of_scheme && growth > 1e-3 * std::abs(theory.omega);
    common::ModeSearch search;
    // Fields are real, and the seed may run either way.
    search.expected = {theory.omega, -std::conj(theory.omega)};
    if (grows) search.begin = 1 / growth, search.below_maximum = 0.1;
    const common::MeasuredMode seen =
        common::measure_mode(times, history.complex_column("mode"), search);
    const std::string where = theory.source + "; measured " + seen.window;
    summary.hint(likely_cause(w, theory, grows, seen, tolerance));
    const double apart = times.size() > 1 ? times[1] - times[0] : 0;
    const bool rare = frequency * apart >= pi;
    // In a run so long growth is seen, or it is over: it needs 3 e-foldings, and 3.5 more to its maximum.
    const double enough = std::ceil(grows ? search.begin + 6.5 / growth : 20 / frequency);
    const bool is_short = seen.reason.ends_with("raise time.end") && enough > w.end;
    const auto report = [&](const std::string& name, common::Measured value) {
        if (rare)
            summary.not_measured(
                name, "cannot be measured, because rows of the history are " + format(apart) +
                          " apart, and half a period is " + format(pi / frequency) + ": lower " +
                          (w.leapfrog.chosen ? "output.history_steps" : "time.dt"));
        else if (seen.found)
            summary.result(name, value, "", 1, tolerance, where);
        else
            summary.not_measured(name, seen.reason + (seen.over  ? ": lower the seed"
                                                      : is_short ? " to " + format(enough)
                                                                 : ""));
    };
    if (grows) report("growth_over_theory", {seen.growth() / growth, seen.growth_error() / growth});
    if (frequency > 0.1 * std::fabs(growth))  // a slower one fades before it swings
        report("omega_over_theory",
               {seen.frequency() / frequency, seen.frequency_error() / frequency});
    if (grows) return;
    const common::Measured damping{-seen.growth(), seen.growth_error()};
    // A wave that is hardly damped is compared as it is, not by the ratio of two small numbers.
    if (std::fabs(growth) > (theory.of_scheme ? 2 * tolerance : 1e-3) * frequency)
        report("damping_over_theory",
               {seen.growth() / growth, seen.growth_error() / std::fabs(growth)});
    else if (seen.found && theory.of_scheme)
        summary.result("damping", damping, "omega_pi", 0 - growth,
                       std::min(1e-3, tolerance) * frequency, theory.source);
    else if (seen.found && seen.growth_error() < 2e-3 * frequency) {
        if (w.field.theta == 0.5 && !w.leapfrog.chosen && !w.field.uses_mass_matrix())
            summary.hint(
                "what moments predict acts as friction, by (k dx)^2 omega_p^2 dt/24: set "
                "field.response = \"mass_matrix\", refine the mesh or lower time.dt");
        summary.result("damping", damping, "omega_pi", 0 - growth, 2e-3 * frequency, theory.source);
    } else if (seen.found)
        summary.result_info("damping", damping, "omega_pi", theory.source);
}

}  // namespace implicit_moment
