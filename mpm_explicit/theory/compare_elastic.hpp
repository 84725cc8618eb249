// The results of elastic grains that collide and vibrate, whatever the scheme: what was measured,
// beside the exact or the published value.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "common/run/summary.hpp"
#include "common/theory/fit_oscillation.hpp"
#include "mpm_explicit/setup/scales.hpp"
#include "mpm_explicit/theory/exact_solutions.hpp"
#include "mpm_explicit/theory/measure.hpp"

namespace mpm::theory {

/// A run that has ended, for its comparison.
struct Run {
    const Case& parameters;
    const Scales& scales;
    const Assembly& all;
    const common::History& history;
    Subject subject;
    double end;  // time
    std::vector<Material> materials;
    std::vector<PlannedGrain> plans;

    const Grain& grain() const { return all.grains[subject.grain]; }
    Material material() const { return materials[static_cast<std::size_t>(grain().material)]; }
    double mass() const {
        double m = 0;
        for (long p = grain().begin; p < grain().end; ++p)
            m += all.particles.m_p[static_cast<std::size_t>(p)];
        return m;
    }
    std::vector<double> momentum_x() const { return history.column("momentum_x_" + grain().name); }
};

inline double last(const std::vector<double>& values) { return values.back(); }

/// What is left of the energy at the end.
inline void compare_energy(const Run& run, double tolerance, common::Summary& summary) {
    const auto energy = run.history.column("energy");
    summary.result("energy_change", last(energy) / energy.front() - 1, "1", 0, tolerance,
                   "exact: none");
}

/// Two equal disks that meet head on.
/// in: energy_tolerance, what the scheme may change of the energy; infinite for one that is meant to
///     lose it, whose disks part as they can
inline void compare_rebound(const Run& run, double energy_tolerance, common::Summary& summary) {
    const bool keeps_energy = std::isfinite(energy_tolerance);
    const PlannedGrain &a = run.plans[0], &b = run.plans[1];
    const double dx = b.outline.x - a.outline.x, dy = b.outline.y - a.outline.y,
                 apart = std::hypot(dx, dy), nx = dx / apart, ny = dy / apart;
    const auto times = run.history.column("time"), force = run.history.column("contact_force"),
               energy = run.history.column("energy"),
               p_x = run.history.column("momentum_x_" + a.name),
               p_y = run.history.column("momentum_y_" + a.name);
    double begin = std::nan(""), end = std::nan("");
    for (std::size_t n = 0; n < times.size(); ++n) {
        if (!(force[n] > 0)) continue;
        if (std::isnan(begin)) begin = times[n];
        end = times[n];
    }
    if (std::isnan(begin)) begin = end = times.back();  // they have not met
    const double closing = (a.from.velocity_x - b.from.velocity_x) * nx +
                           (a.from.velocity_y - b.from.velocity_y) * ny,
                 touch = (apart - a.outline.radius - b.outline.radius) / closing;
    const Material material = run.material();
    const Impact impact = quasi_static_impact(
        {a.outline.radius, material.density, material.E, material.nu}, 0.5 * closing);
    summary.result("contact_begins", begin, "time", touch, 0.04 * touch + run.scales.dt,
                   "the gap over the closing velocity");
    if (keeps_energy)
        summary.result("contact_lasts", end - begin, "time", impact.duration,
                       0.15 * impact.duration + 2 * run.scales.dt,
                       "line contact always in equilibrium, an estimate");
    const double before = p_x.front() * nx + p_y.front() * ny,
                 after = p_x.back() * nx + p_y.back() * ny;
    const std::string source = "momentum of a grain, after over before";
    if (keeps_energy && closing < 0.1 * run.scales.sound_speed)
        summary.result("rebound", -after / before, "1", 0.95, 0.03,
                       source + "; on refined meshes 3 to 7 % of the energy stay as vibration");
    else
        summary.result_info("rebound", -after / before, "1", source);
    if (keeps_energy) compare_energy(run, energy_tolerance, summary);
    summary.result_info("largest_energy",
                        *std::max_element(energy.begin(), energy.end()) / energy.front(), "1",
                        "over the initial");
    if (keeps_energy)
        summary.result_within("parted", times.back() - end, "time", 0.1 * run.end, run.end,
                              "since the last contact");
}

/// The bar that all grains make together, held at the left end and free at the other.
inline Bar bar_of(const Run& run) {
    const Problem& problem = run.parameters.problem;
    const Material m = run.material();
    const bool held = problem.walls[y_low] == "slip" && problem.walls[y_high] == "slip";
    const GrainCase& from = run.plans.front().from;
    return {profile_bounds(run.plans).length(), m.density,
            held ? moduli(m).lambda + 2 * moduli(m).G : m.E / (1 - m.nu * m.nu),
            static_cast<int>(from.mode), from.amplitude};
}

inline void compare_frequency(const Run& run, double expected, const std::string& source,
                              common::Summary& summary) {
    const common::OscillationFit fit =
        common::fit_oscillation(run.history.column("momentum_x"),
                                run.scales.dt * static_cast<double>(run.parameters.history_steps));
    summary.result("frequency", fit.frequency, "1/time", expected,
                   run.parameters.tolerance * expected, source);
}

inline void compare_bar(const Run& run, double energy_tolerance, common::Summary& summary) {
    compare_frequency(run, bar_of(run).frequency(), "bar with a fixed and a free end", summary);
    compare_energy(run, energy_tolerance, summary);
}

/// A compression wave that stands between rollers.
inline void compare_standing_wave(const Run& run, common::Summary& summary) {
    const Problem& problem = run.parameters.problem;
    const Material m = run.material();
    const GrainCase& from = problem.grains.front();
    StandingWave wave{problem.length_x, 1, m.density, moduli(m), static_cast<int>(from.mode)};
    wave.amplitude = from.amplitude / wave.frequency();
    const Particles& at = run.all.particles;
    // The wave is compared where the particles started: x_p less the displacement of theory.
    double error = 0, size = 0;
    for (std::size_t p = 0; p < at.x_p.size(); ++p) {
        const double x = at.x_p[p] - problem.origin_x;
        const double u = wave_displacement(wave, x, run.end);
        const double exact = wave_velocity(wave, x - u, run.end);
        error += (at.vx_p[p] - exact) * (at.vx_p[p] - exact) + at.vy_p[p] * at.vy_p[p];
        size += 0.5 * from.amplitude * from.amplitude;
    }
    summary.result("velocity_error", std::sqrt(error / size), "1", 0, run.parameters.tolerance,
                   "rms over particles at the end, of the wave's own rms; exact for small strain");
}

/// Two halves of a bar that vibrates: one bar as long as the bond holds, and when it breaks.
inline void compare_bond(const Run& run, double energy_tolerance, common::Summary& summary) {
    const Bar bar = bar_of(run);
    const auto times = run.history.column("time"), broken = run.history.column("broken_bonds"),
               normal = run.history.column("bond_normal_1");
    const double joint = bounds(run.plans.front().outline).x_high - profile_bounds(run.plans).x_low,
                 strength = run.all.bonds.front().tension,
                 expected = bar_breaking_time(bar, joint, strength);
    if (std::isfinite(expected)) {
        const double breaks = common::time_at_level(times, broken, 0.5);
        const bool holds = std::isnan(breaks);
        summary.result("bond_breaks", holds ? times.back() : breaks, "time", expected,
                       run.parameters.tolerance * expected,
                       holds ? "it held to the end" : "stress of the bar at the joint");
    } else {
        compare_bar(run, energy_tolerance, summary);
        const double peak = bar_stress(bar, joint, 0.5 * std::numbers::pi / bar.frequency());
        summary.result("largest_bond_stress", *std::max_element(normal.begin(), normal.end()),
                       "stress", peak, run.parameters.tolerance * peak,
                       "stress of the bar at the joint");
    }
}

}  // namespace mpm::theory
