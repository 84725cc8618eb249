// The results of a run: what was measured, beside the exact or the published value.
#pragma once

#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "common/fit_oscillation.hpp"
#include "common/mpm/exact_solutions.hpp"
#include "common/mpm/measure.hpp"
#include "common/mpm/scheme_theory.hpp"
#include "common/summary.hpp"
#include "mpm_explicit/initial_state.hpp"

namespace mpm_explicit {

namespace detail {

struct Run {
    const Case& wanted;
    const Scales& scales;
    const State& state;
    const common::History& history;
    Subject subject;
    double end;  // time
    std::vector<Material> materials;
    std::vector<PlannedGrain> plans;

    const Grain& grain() const { return state.assembly.grains[subject.grain]; }
    Material material() const { return materials[static_cast<std::size_t>(grain().material)]; }
    double mass() const {
        double m = 0;
        for (long p = grain().begin; p < grain().end; ++p)
            m += state.assembly.particles.m_p[static_cast<std::size_t>(p)];
        return m;
    }
    std::vector<double> momentum_x() const { return history.column("momentum_x_" + grain().name); }
};

inline double last(const std::vector<double>& values) { return values.back(); }

inline double slope(const std::vector<double>& x, const std::vector<double>& y, double from) {
    std::vector<double> u, v;
    for (std::size_t n = 0; n < x.size(); ++n)
        if (x[n] >= from) u.push_back(x[n]), v.push_back(y[n]);
    double c0, c1, c00, c01, c11, chi2;
    if (u.size() < 2) return std::nan("");
    gsl_fit_linear(u.data(), 1, v.data(), 1, u.size(), &c0, &c1, &c00, &c01, &c11, &chi2);
    return c1;
}

/// Two equal disks that meet head on.
inline void compare_rebound(const Run& run, common::Summary& summary) {
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
    summary.result("contact_begins", begin, "time", touch, 0.04 * touch,
                   "the gap over the closing velocity");
    summary.result("contact_lasts", end - begin, "time", impact.duration, 0.15 * impact.duration,
                   "line contact always in equilibrium, an estimate");
    const double before = p_x.front() * nx + p_y.front() * ny,
                 after = p_x.back() * nx + p_y.back() * ny;
    const std::string source = "momentum of a grain, after over before";
    if (closing < 0.1 * run.scales.sound_speed)
        summary.result("rebound", -after / before, "1", 0.95, 0.03,
                       source + "; on refined meshes 3 to 7 % of the energy stay as vibration");
    else
        summary.result_info("rebound", -after / before, "1", source);
    summary.result("energy_change", last(energy) / energy.front() - 1, "1", 0, 0.03, "exact: none");
    summary.result_info("largest_energy",
                        *std::max_element(energy.begin(), energy.end()) / energy.front(), "1",
                        "over the initial");
    summary.result_within("parted", times.back() - end, "time", 0.1 * run.end, run.end,
                          "since the last contact");
}

/// The bar that all grains make together, held at the left end and free at the other.
inline Bar bar_of(const Run& run) {
    const Problem& problem = run.wanted.problem;
    const Material m = run.material();
    const bool held = problem.walls[y_low] == "slip" && problem.walls[y_high] == "slip";
    const GrainCase& from = run.plans.front().from;
    return {profile_bounds(run.plans).length(), m.density,
            held ? moduli(m).lambda + 2 * moduli(m).G : m.E / (1 - m.nu * m.nu),
            static_cast<int>(from.mode), from.amplitude};
}

inline void compare_bar(const Run& run, common::Summary& summary) {
    const Bar bar = bar_of(run);
    const common::OscillationFit fit =
        common::fit_oscillation(run.history.column("momentum_x"),
                                run.scales.dt * static_cast<double>(run.wanted.history_steps));
    summary.result("frequency", fit.frequency, "1/time", bar.frequency(),
                   run.wanted.tolerance * bar.frequency(), "bar with a fixed and a free end");
    const auto energy = run.history.column("energy");
    summary.result("energy_change", last(energy) / energy.front() - 1, "1", 0, 0.01, "exact: none");
}

/// A compression wave that stands between rollers.
inline void compare_standing_wave(const Run& run, common::Summary& summary) {
    const Problem& problem = run.wanted.problem;
    const Material m = run.material();
    const GrainCase& from = problem.grains.front();
    StandingWave wave{problem.length_x, 1, m.density, moduli(m), static_cast<int>(from.mode)};
    wave.amplitude = from.amplitude / wave.frequency();
    const Particles& at = run.state.assembly.particles;
    // The wave is compared where the particles started: x_p less the displacement of theory.
    double error = 0, size = 0;
    for (std::size_t p = 0; p < at.x_p.size(); ++p) {
        const double x = at.x_p[p] - problem.origin_x;
        const double u = wave_displacement(wave, x, run.end);
        const double exact = wave_velocity(wave, x - u, run.end);
        error += (at.vx_p[p] - exact) * (at.vx_p[p] - exact) + at.vy_p[p] * at.vy_p[p];
        size += 0.5 * from.amplitude * from.amplitude;
    }
    summary.result("velocity_error", std::sqrt(error / size), "1", 0, run.wanted.tolerance,
                   "rms over particles at the end, of the wave's own rms; exact for small strain");
}

/// The one free node between two fixed ends, with frozen particles.
inline void compare_oscillator(const Run& run, common::Summary& summary) {
    const Problem& problem = run.wanted.problem;
    const double h = problem.mesh().h, c = sound_speed(run.material()), dt = run.scales.dt,
                 w = node_oscillator_frequency(static_cast<int>(problem.per_side)) * c / h;
    summary.result_info("omega_dt", w * dt, "1", "one free node, exact");
    const auto e14 = run.history.column("energy_14"), e15 = run.history.column("energy_15"),
               kinetic = run.history.column("kinetic");
    // Beyond the limit the invariants are small differences of terms that grow.
    double most = 0, change_14 = 0, change_15 = 0;
    for (std::size_t n = 0; n < e14.size(); ++n) {
        const double size = std::max(std::fabs(e14.front()), kinetic[n]);
        most = std::max(most, kinetic[n] / kinetic.front());
        change_14 = std::max(change_14, std::fabs(e14[n] - e14.front()) / size);
        change_15 = std::max(change_15, std::fabs(e15[n] - e15.front()) / size);
    }
    const bool stable = w * dt < 2;
    summary.result("change_of_energy_14", change_14, "1", 0, 1e-12, "[MPM-14]: an invariant");
    summary.result("change_of_energy_15", change_15, "1", 0, 1e-12, "[MPM-15]: an invariant");
    summary.result_info("energy_14", e14.front() / kinetic.front(), "1",
                        "over the kinetic energy at the start; negative beyond omega dt = 2");
    if (stable) {
        const common::OscillationFit fit = common::fit_oscillation(run.momentum_x(), dt);
        summary.result("frequency", fit.frequency, "1/time", leapfrog_frequency(w, dt), 1e-4 * w,
                       "leapfrog, (2/dt) asin(omega dt/2)");
        summary.result_within("largest_kinetic", most, "1", 0, 1 / (1 - 0.25 * w * w * dt * dt),
                              "bounded by [MPM-14], over the initial");
    } else {
        summary.result_info("largest_kinetic", most, "1",
                            "over the initial: beyond omega dt = 2 the invariants bound nothing");
    }
}

/// A block or a cylinder on a rigid plate, gravity inclined.
inline void compare_incline(const Run& run, common::Summary& summary) {
    const Problem& problem = run.wanted.problem;
    const double g = std::hypot(problem.gravity_x, problem.gravity_y),
                 angle = std::atan2(std::fabs(problem.gravity_x), -problem.gravity_y),
                 mu = problem.contact.friction;
    const bool block = run.wanted.compare == "block";
    const double exact =
        block ? block_acceleration(g, angle, mu) : cylinder_acceleration(g, angle, mu);
    auto v = run.momentum_x();
    const double m = run.mass();
    for (double& value : v) value /= std::copysign(m, problem.gravity_x);
    const auto times = run.history.column("time");
    const double measured = slope(times, v, std::max(problem.rise, 0.25 * run.end));
    const std::string source = block
                                   ? "g (sin - mu cos), or 0 where friction holds"
                                   : "(2/3) g sin where it rolls, g (sin - mu cos) where it slips";
    summary.result("acceleration", measured, "acceleration", exact,
                   exact > 0 ? run.wanted.tolerance * exact : 0.01 * g * std::sin(angle), source);
    summary.result_info("speed_at_end", v.back(), "velocity", "along the plate");
}

/// A disk between two plates (Brazilian test).
inline void compare_disk(const Run& run, common::Summary& summary) {
    const auto& grains = run.state.assembly.grains;
    const auto times = run.history.column("time");
    const auto mean_late = [&](const std::string& name) {
        const auto values = run.history.column(name);
        double sum = 0, count = 0;
        for (std::size_t n = 0; n < times.size(); ++n)
            if (times[n] >= 0.9 * run.end) sum += values[n], count += 1;
        return sum / count;
    };
    double P = 0, plates = 0;
    for (const Grain& grain : grains)
        if (grain.rigid && (run.wanted.plate.empty() || grain.name == run.wanted.plate))
            P += std::fabs(mean_late("force_y_" + grain.name)), plates += 1;
    P /= plates;
    const double R = run.plans[run.subject.grain].outline.radius;
    const double xx = mean_late("center_xx"), yy = mean_late("center_yy"),
                 xy = mean_late("center_xy"), exact = disk_center_difference(P, R);
    const Stress center = disk_stress(P, R, 0, 0);
    const std::string source = "Hertz's disk between two line loads";
    summary.result_info("load", P, "force",
                        "of the plates, the mean over the last tenth of the run");
    summary.result("center_difference", std::hypot(xx - yy, 2 * xy) / exact, "1", 1,
                   run.wanted.tolerance, source + ", over 8P/(pi D)");
    summary.result("center_xx", xx / center.xx, "1", 1, run.wanted.tolerance,
                   source + ", over 2P/(pi D)");
    summary.result("center_yy", yy / center.yy, "1", 1, run.wanted.tolerance,
                   source + ", over -6P/(pi D)");
    const Material m = run.material();
    const double b = contact_half_width({R, m.density, m.E, m.nu}, P);
    summary.result_info("contact_half_width", b / R, "R", "line contact; the loads are no points");
}

/// Two halves of a bar that vibrates: one bar as long as the bond holds, and when it breaks.
inline void compare_bond(const Run& run, common::Summary& summary) {
    const Bar bar = bar_of(run);
    const auto times = run.history.column("time"), broken = run.history.column("broken_bonds"),
               normal = run.history.column("bond_normal_1");
    const double joint = bounds(run.plans.front().outline).x_high - profile_bounds(run.plans).x_low,
                 strength = run.state.assembly.bonds.front().tension,
                 expected = bar_breaking_time(bar, joint, strength);
    if (std::isfinite(expected)) {
        const double breaks = common::time_at_level(times, broken, 0.5);
        const bool holds = std::isnan(breaks);
        summary.result("bond_breaks", holds ? times.back() : breaks, "time", expected,
                       run.wanted.tolerance * expected,
                       holds ? "it held to the end" : "stress of the bar at the joint");
    } else {
        compare_bar(run, summary);
        const double peak = bar_stress(bar, joint, 0.5 * std::numbers::pi / bar.frequency());
        summary.result("largest_bond_stress", *std::max_element(normal.begin(), normal.end()),
                       "stress", peak, run.wanted.tolerance * peak,
                       "stress of the bar at the joint");
    }
}

/// What yields stays on its yield surface and only ever takes energy.
inline void compare_yield(const Run& run, common::Summary& summary) {
    const Material m = run.material();
    const Particles& at = run.state.assembly.particles;
    double worst = 0, most = 0, yielded = 0;
    for (long k = run.grain().begin; k < run.grain().end; ++k) {
        const auto p = static_cast<std::size_t>(k);
        worst = std::max(worst,
                         von_mises(at.stress(p)) / (m.yield_stress + m.hardening * at.yield_p[p]));
        most = std::max(most, at.yield_p[p]);
        yielded += at.yield_p[p] > 0 ? 1 : 0;
    }
    const auto plastic = run.history.column("plastic"), energy = run.history.column("energy");
    double backward = 0;
    for (std::size_t n = 1; n < plastic.size(); ++n)
        backward = std::max(backward, plastic[n - 1] - plastic[n]);
    summary.result_within("largest_stress_over_strength", worst, "1", 0, 1 + 1e-12,
                          "von Mises stress over Y + H ep, at the end");
    summary.result_within("plastic_work_undone", backward, "energy", 0, 1e-12 * energy.front(),
                          "plastic work never comes back");
    summary.result_info("plastic_work", last(plastic) / energy.front(), "1",
                        "of the initial energy");
    summary.result_info("largest_plastic_strain", most, "1", "of a particle");
    summary.result_info("yielded",
                        yielded / static_cast<double>(run.grain().end - run.grain().begin), "1",
                        "share of the particles");
}

/// A column of grains that collapses to one side.
inline void compare_collapse(const Run& run, common::Summary& summary) {
    const auto front = run.history.column("front");
    double low = 1e300, high = -1e300, top = -1e300;
    for (const PlannedGrain& plan : run.plans) {
        if (run.materials[static_cast<std::size_t>(plan.material)].law == Law::rigid) continue;
        const Bounds box = bounds(plan.outline);
        low = std::min(low, box.x_low), high = std::max(high, box.x_high);
        top = std::max(top, box.y_high);
    }
    const double width = high - low, a = (top - run.wanted.problem.origin_y) / width,
                 runout = (last(front) - high) / width;
    summary.result_info("aspect_ratio", a, "1", "height over width of the column");
    summary.result_within("runout", runout, "1", runout_in_experiments(a), runout_of_disks(a),
                          "(L_end - L_0)/L_0, between columns of sand between plates (Lube and "
                          "others 2005) and stiff disks in two dimensions (Staron and Hinch 2005)");
    const double steady = front[front.size() * 9 / 10];
    summary.result_within("still_moving", (last(front) - steady) / width, "1", -0.05, 0.05,
                          "what the front gained in the last tenth of the run");
}

}  // namespace detail

inline void compare_with_theory(const Case& w, const Scales& scales, const Subject& subject,
                                double end, const State& state, const common::History& history,
                                common::Summary& summary) {
    const std::vector<Material> materials = materials_of(w.problem);
    const detail::Run run{w,       scales, state,     history,
                          subject, end,    materials, plan_grains(w.problem, materials)};
    if (w.compare == "rebound") detail::compare_rebound(run, summary);
    if (w.compare == "bar") detail::compare_bar(run, summary);
    if (w.compare == "standing_wave") detail::compare_standing_wave(run, summary);
    if (w.compare == "oscillator") detail::compare_oscillator(run, summary);
    if (w.compare == "block" || w.compare == "cylinder") detail::compare_incline(run, summary);
    if (w.compare == "disk") detail::compare_disk(run, summary);
    if (w.compare == "bond") detail::compare_bond(run, summary);
    if (w.compare == "yield") detail::compare_yield(run, summary);
    if (w.compare == "collapse") detail::compare_collapse(run, summary);
}

}  // namespace mpm_explicit
