// The results of elastic grains that collide and vibrate, whatever the scheme: what was measured,
// beside the exact or the published value.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "common/theory/measure_modes.hpp"
#include "mpm_explicit/theory/comparison.hpp"
#include "mpm_explicit/theory/exact_solutions.hpp"

namespace mpm::theory {

/// What is most likely wrong with the energy of an explicit run, and what it has not tried yet. Of linear
/// shapes the force of a particle jumps at lines of nodes, of others it does not.
inline std::string cell_crossing_hint(const Case& w) {
    std::vector<std::string> cures;
    if (w.problem.contact.levels != 2) cures.emplace_back("take contact.levels = 2");
    if (w.alpha > 0.25) cures.emplace_back("lower time.alpha (0.25)");
    if (w.shape == "linear") {
        cures.emplace_back("take method.shape = \"gimp\"");
        if (w.crossing == 0) cures.emplace_back("take method.crossing = 0.5");
    } else {
        cures.emplace_back("refine the mesh");
        if (w.alpha > 0.1 && w.alpha <= 0.25) cures.emplace_back("lower time.alpha (0.1)");
        if (w.transfer == "flip" && w.flip == 1)
            cures.emplace_back("take method.flip = 0.99, which takes some");
    }
    std::string hint = "noise of cell crossing gives or takes energy: ";
    for (const std::string& cure : cures) hint += (&cure == &cures[0] ? "" : ", or ") + cure;
    return hint;
}

/// What a wrong energy of a body that should keep it is due to.
inline std::string energy_hint(const FinishedRun& run) {
    return run.planned.scheme.bar_tolerance < 1e-6
               ? "the scheme keeps it as exactly as steps are solved: lower solver.tolerance"
               : cell_crossing_hint(run.parameters) + "; friction and large strains take some";
}

/// What is left of the energy at the end, with what loads gave and load.damping took.
inline void compare_energy(const FinishedRun& run, double tolerance, common::Summary& summary) {
    const auto energy = run.history.column("energy");
    const double worked =
        run.history.column("external").back() + run.history.column("damping").back();
    // In the frame of the center of mass.
    const double own = energy.front() - energy_of_drift(run.history, run.all);
    const double change = (energy.back() - worked - energy.front()) / own;
    const std::string& transfer = run.parameters.transfer;
    const bool is_pic = run.parameters.flip < 1 || transfer == "pic",
               is_affine = transfer == "apic" || transfer == "spin";
    const double passed = run.history.column("pic").back() / own;
    summary.hint(is_pic && change < 0
                     ? "PIC takes kinetic energy in each step, more in shorter ones: take "
                       "method.flip = 1 and, in mpm_explicit, method.transfer = \"flip\""
                 : is_affine && change < 0 && passed < 0.5 * change
                     ? "method.transfer = \"" + transfer + "\" takes " + format(-passed) +
                           " of it, the column pic: take method.transfer = \"flip\""
                     : energy_hint(run));
    summary.result("energy_change", change, "1", 0, tolerance,
                   "besides the work of loads and of load.damping; exact: none");
}

/// Says how many cells a contact of half-width b covers, and warns where they are too few. The
/// approach of a cylinder under load over theory was measured as .976, .984 at b/h = 2.4, 3.6 with the
/// theta scheme, .88, .994 at 2.2, 3.6 with leapfrog.
inline void report_contact(const FinishedRun& run, double b, common::Summary& summary) {
    const double cells = b / run.parameters.problem.mesh().h;
    const std::string few =
        "below 4 cells the approach may be wrong, by a tenth at 2, and more off lines of nodes";
    summary.result_info("contact_half_width", cells, "h",
                        "line contact at its largest load; " + few);
    if (cells < 4 && run.parameters.compare != "rebound")  // which does not judge the approach
        summary.late_warnings.push_back("contact_half_width = " + format(cells) + ": " + few +
                                        "; refine the mesh to cells of at most " + format(b / 4));
}

// ---- two equal disks that meet head on ----------------------------------------------------------

/// When a grain has gone as far as without damping in the time t.
///   t = [1 - exp(-c t')]/c
/// out:   t'; not a number where it never comes so far
inline double time_of_way(double t, double c) { return c > 0 ? -std::log1p(-c * t) / c : t; }

/// Needs two equal disks of one material on one line, and a run that lasts until they meet.
inline void need_equal_disks(const PlannedCase& planned) {
    const std::vector<PlannedGrain>& plans = planned.plans;
    const auto is_disk = [](auto& plan) { return plan.outline.kind == OutlineKind::disk; };
    const std::string sentence = " needs two equal disks of one material that meet head on";
    planned.refuse(planned.free_grains() != 2 || planned.rigid_grains() != 0 ||
                       !std::all_of(plans.begin(), plans.end(), is_disk),
                   sentence);
    const PlannedGrain &a = plans[0], &b = plans[1];
    const double dx = b.outline.x - a.outline.x, dy = b.outline.y - a.outline.y,
                 vx = a.from.velocity_x - b.from.velocity_x,
                 vy = a.from.velocity_y - b.from.velocity_y, approach = dx * vx + dy * vy;
    planned.refuse(a.outline.radius != b.outline.radius || a.material != b.material ||
                       !(approach > 0 && std::fabs(dx * vy - dy * vx) < 1e-9 * approach),
                   sentence);
    const double touch = time_of_way((std::hypot(dx, dy) - a.outline.radius - b.outline.radius) /
                                         std::hypot(vx, vy),
                                     planned.parameters.problem.damping),
                 end = planned.parameters.end;
    planned.refuse(std::isnan(touch), ": load.damping stops the disks before they meet: lower it");
    planned.refuse(end < 1.05 * touch, ": the disks meet at t = " + format(touch) +
                                           ", and the run ends at " + format(end) +
                                           ": raise time.end");
}

/// When they meet, how long they touch, and with what they part.
/// note: where the scheme or viscosity takes energy, the disks part as they can; no theory is known
///       of a contact with load.damping.
inline void compare_rebound(const FinishedRun& run, common::Summary& summary) {
    const double energy_tolerance = run.planned.scheme.rebound_tolerance;
    const double damping = run.parameters.problem.damping;
    const bool keeps_energy = std::isfinite(energy_tolerance) && run.material().viscosity == 0,
               knows = keeps_energy && damping == 0;
    const PlannedGrain &a = run.planned.plans[0], &b = run.planned.plans[1];
    const double dx = b.outline.x - a.outline.x, dy = b.outline.y - a.outline.y,
                 apart = std::hypot(dx, dy), nx = dx / apart, ny = dy / apart;
    const auto times = run.history.column("time"), force = run.history.column("contact_force"),
               energy = run.history.column("energy");
    // Of one grain less that of the other, along their line: no frame changes it.
    const auto momentum = [&](std::size_t row) {
        const auto of = [&](const std::string& name) { return run.history.column(name)[row]; };
        return (of("momentum_x_" + a.name) - of("momentum_x_" + b.name)) * nx +
               (of("momentum_y_" + a.name) - of("momentum_y_" + b.name)) * ny;
    };
    const double closing = (a.from.velocity_x - b.from.velocity_x) * nx +
                           (a.from.velocity_y - b.from.velocity_y) * ny,
                 touch =
                     time_of_way((apart - a.outline.radius - b.outline.radius) / closing, damping);
    const Material& material = run.material();
    const Impact impact =
        quasi_static_impact({a.outline.radius, material.density, material.E, material.nu},
                            0.5 * closing * std::exp(-damping * touch));
    // One collision ends when they have been apart for as long as one lasts: they may graze before it and
    // chatter in it, and may meet anew later.
    const double apart_for =
        std::max(impact.duration, times.size() > 1 ? 4 * (times[1] - times[0]) : 0.0);
    double begin = std::nan(""), end = std::nan("");
    std::size_t last = times.size() - 1;
    bool over = false;
    for (std::size_t n = 0; n < times.size(); ++n) {
        if (force[n] > 0) {
            if (std::isnan(begin)) begin = times[n];
            end = times[n];
        } else if (times[n] - end > apart_for) {
            last = n, over = true;
            break;
        }
    }
    if (std::isnan(begin))
        return summary.not_measured(
            "contact_begins", "the disks have not met: raise time.end, or contact.separation");
    const double parted = times.back() - end;
    over = over || parted >= 0.1 * impact.duration;
    const double cells = a.outline.radius / run.parameters.problem.mesh().h;
    const double half = impact.peak_half_width / run.parameters.problem.mesh().h;
    const bool implicit = run.planned.scheme.implicit;
    std::string cures;
    const auto add = [&](bool helps, const std::string& cure) {
        if (helps) cures += (cures.empty() ? "" : ", ") + cure;
    };
    const double separation = run.parameters.problem.contact.separation;
    add(separation != 0.02, "set contact.separation = 0.02");
    add(!implicit && run.parameters.alpha > 0.25, "take time.alpha = 0.25");
    add(implicit && impact.duration < 30 * run.scales.dt,
        "lower time.alpha: the contact lasts " + format(impact.duration / run.scales.dt) +
            " steps, below 30");
    add(cells < 8, "refine the mesh, on which the radius is " + format(cells) + " cells");
    add(half < 1.5,
        "refine the mesh, on which half of the contact is " + format(half) + " cells, below 1.5");
    add(run.parameters.shape == "linear",
        "take method.shape = \"quadratic\": with linear ones more stays as vibration, and on "
        "finer meshes more still");
    add(cures.empty(), "refine the mesh, or lower the velocities");
    summary.hint(cures);
    summary.result("contact_begins", begin, "time", touch, 0.04 * touch + run.scales.dt,
                   damping > 0 ? "the gap at a closing velocity that falls by exp(-c t)"
                               : "the gap over the closing velocity");
    if (keeps_energy && !knows)
        summary.not_measured("contact_lasts",
                             "no theory is known of how long disks touch and with what they part "
                             "while load.damping slows them down: set it to 0");
    else if (knows && !over)
        summary.not_measured("contact_lasts", "the collision is not over: raise time.end");
    if (!over) summary.not_measured("rebound", "the collision is not over: raise time.end");
    // On 24 to 64 cells in a radius the contact lasts 0.974 +- 0.003 of the estimate. Faster ones strain
    // more than the law is good for, by a tenth and more.
    const bool slow = closing < 0.1 * run.scales.sound_speed;
    const double lasts = (slow ? 0.974 : 1) * impact.duration,
                 lasts_within = (slow ? 0.05 : 0.15) * lasts + 2 * run.scales.dt;
    if (knows && over && lasts_within > 0.5 * impact.duration)
        summary.not_measured("contact_lasts",
                             "a contact of " + format(impact.duration / run.scales.dt) +
                                 " steps is too short to time: lower time.alpha until it has 6");
    else if (knows && over)
        summary.result(
            "contact_lasts", end - begin, "time", lasts, lasts_within,
            slow ? "0.974 of a line contact always in equilibrium, as on 24 to 64 cells in a radius"
                 : "line contact always in equilibrium, which a fast one is not");
    const double before = momentum(0), after = momentum(last);
    report_contact(run, impact.peak_half_width, summary);
    const std::string source = "momentum of one grain less that of the other, after over before";
    if (knows && slow && over)
        summary.result("rebound", -after / before, "1", 0.97, 0.025,
                       source +
                           "; 0.98 with quadratic shapes on fine meshes, and linear ones leave "
                           "more in vibration");
    else if (over)
        summary.result_info("rebound", -after / before, "1", source);
    if (keeps_energy) compare_energy(run, (slow ? 1 : 5) * energy_tolerance, summary);
    summary.result_info("largest_energy",
                        *std::max_element(energy.begin(), energy.end()) / energy.front(), "1",
                        "over the initial");
    summary.hint(
        "the run ends too early for it, or the steps are too long: raise time.end, or lower "
        "time.alpha");
    if (keeps_energy)
        summary.result_at_least("parted", parted, "time", 0.1 * run.end,
                                "since the last contact: a tenth of the run");
}

// ---- a bar that is held at its left end ---------------------------------------------------------

/// Whether smooth walls hold it above and below, so that it cannot grow thicker.
inline bool is_held_across(const PlannedCase& planned) {
    const Mesh mesh = planned.parameters.problem.mesh();
    const Bounds box = bounds(planned.plans.front().outline);
    return planned.has_wall(y_low, "slip") && planned.has_wall(y_high, "slip") &&
           box.y_low - mesh.y_low < 1e-6 * mesh.h && mesh.y_high() - box.y_high < 1e-6 * mesh.h;
}

/// Needs boxes with the profile of a bar, which begins at a wall that holds it.
inline void need_bar(const PlannedCase& planned) {
    planned.refuse_viscosity();
    const Mesh mesh = planned.parameters.problem.mesh();
    planned.refuse(!planned.has_profile("bar") ||
                       !(planned.has_wall(x_low, "slip") || planned.has_wall(x_low, "stick")),
                   " needs boxes with profile = \"bar\", an amplitude, and boundary.x_low = "
                   "\"slip\" or \"stick\"");
    const double low = profile_bounds(planned.plans).x_low;
    planned.refuse(!(std::fabs(low - mesh.x_low) < 1e-6 * mesh.h),
                   " needs a bar that begins at the wall, at x = " + format(mesh.x_low) +
                       ", not at " + format(low));
    const PlannedGrain& first = planned.plans.front();
    const auto differs = [&](const PlannedGrain& plan) {
        return plan.material != first.material || plan.from.mode != first.from.mode ||
               plan.from.amplitude != first.from.amplitude;
    };
    planned.refuse(std::ranges::any_of(planned.plans, differs),
                   " needs one material, mode and amplitude of all boxes");
    // Of plates of this height: omega^2 falls by (nu/(1 - nu))^2 (k height)^2/12 (Rayleigh and Lamb).
    const Bounds box = bounds(first.outline);
    const double nu = planned.material_of(first).nu, height = box.y_high - box.y_low,
                 k = (double(first.from.mode) - 0.5) * std::numbers::pi /
                     profile_bounds(planned.plans).length(),
                 slower = std::pow(nu / (1 - nu) * k * height, 2) / 24;
    planned.refuse(!is_held_across(planned) && slower > 0.5 * planned.parameters.tolerance,
                   " is of a thin bar, and this one, whose height is " + format(height) +
                       " and whose wave is " + format(2 * std::numbers::pi / k) +
                       " long, is slower by about " + format(slower) +
                       ": lower its height or its mode, or let it fill the mesh between "
                       "boundary.y_low and y_high = \"slip\"");
}

/// The bar that all grains make together, held at the left end and free at the other.
inline Bar bar_of(const FinishedRun& run) {
    const PlannedCase& planned = run.planned;
    const Material& m = run.material();
    const GrainCase& from = planned.plans.front().from;
    const double stiffness =
        run.stiffening() * (is_held_across(planned) ? moduli(m).lambda + 2 * moduli(m).G
                                                    : plane_strain_modulus(m.E, m.nu));
    return {profile_bounds(planned.plans).length(),
            m.density,
            stiffness,
            int(from.mode),
            from.amplitude,
            run.parameters.problem.damping};
}

/// Frequency and damping of a body that rings, and what to say where they cannot be measured.
/// in:     y(t) of the rows of the history, or of their changes; expected, the root of theory
inline common::MeasuredMode measure_ringing(const FinishedRun& run, const std::vector<double>& y,
                                            std::complex<double> expected) {
    const auto times = run.history.column("time");
    common::ModeSearch search{.expected = {expected, -std::conj(expected)}};
    search.periods = search.e_foldings = 1;  // such a record has no noise
    return common::measure_mode(std::span(times).first(y.size()), y, search);
}

/// What a record gains from row to row, where the part `keeps` of it stays.
inline std::vector<double> changes_of(std::vector<double> y, double keeps = 1) {
    for (std::size_t n = 0; n + 1 < y.size(); ++n) y[n] = y[n + 1] - keeps * y[n];
    y.pop_back();
    return y;
}

/// A number of what rings beside theory.
inline void report_ringing(const common::MeasuredMode& seen, const std::string& name,
                           common::Measured value, const std::string& unit, double expected,
                           double tolerance, const std::string& source, common::Summary& summary) {
    summary.hint(
        "a smaller amplitude, more cells or a shorter step bring the body closer to theory");
    if (seen.found)
        summary.result(name, value, unit, expected, tolerance, source + "; " + seen.window);
    else
        summary.not_measured(name, seen.reason);
}

/// Frequency and damping of what moves as exp(root t).
/// in:     y, as in measure_ringing; within, the tolerances of both, as in root: where that of the
///         damping is 0 nothing is said of it
inline void compare_root(const FinishedRun& run, const std::vector<double>& y,
                         std::complex<double> root, std::complex<double> within,
                         const std::string& source, common::Summary& summary) {
    const common::MeasuredMode seen = measure_ringing(run, y, {root.imag(), root.real()});
    const double per_row = run.scales.dt * double(run.parameters.history_steps);
    if (root.imag() * per_row > std::numbers::pi)
        return summary.not_measured("frequency",
                                    "rows of the history are too far apart to see it "
                                    "swing: lower output.history_steps or time.alpha");
    if (root.imag() > 0)
        report_ringing(seen, "frequency", {seen.frequency(), seen.frequency_error()}, "1/time",
                       root.imag(), within.imag(), source, summary);
    else
        summary.not_measured("frequency", "nothing swings: lower load.damping, or time.alpha");
    if (within.real() > 0)
        report_ringing(seen, "damping", {-seen.growth(), seen.growth_error()}, "1/time",
                       -root.real(), within.real(), source, summary);
}

/// The same of a bar, within what a body has whose frequency is wrong by theory.tolerance.
/// in:     root_of(omega), by theory; undamped, how near 0 the damping of what has none is
template <class Theory>
void compare_bar_with(const FinishedRun& run, const Theory& root_of, double undamped,
                      const std::string& source, common::Summary& summary) {
    const double w = bar_of(run).frequency(), tolerance = run.parameters.tolerance;
    const std::complex<double> root = root_of(w);
    double rate = -tolerance * root.real(), frequency = 0;
    for (const double off : {-tolerance, tolerance}) {
        const std::complex<double> apart = root_of((1 + off) * w) - root;
        frequency = std::max(frequency, std::fabs(apart.imag()));
        if (root.imag() == 0) rate = std::max(rate, std::fabs(apart.real()));
    }
    compare_root(run, run.history.column("momentum_x"), root, {undamped + rate, frequency}, source,
                 summary);
}

/// Whether steps are short enough for theory to know what load.damping does in them; else says so.
/// in:     most, of c dt: theory of the leapfrog, with stiffening(), errs by (c dt)^2/12, others by c dt/2
inline bool knows_damping(const FinishedRun& run, double most, const std::string& result,
                          common::Summary& summary) {
    const double in_a_step = run.parameters.problem.damping * run.scales.dt;
    if (in_a_step <= most) return true;
    summary.not_measured(result, "load.damping takes " + format(-std::expm1(-in_a_step)) +
                                     " of a velocity in a step, and theory is of short ones: lower "
                                     "time.alpha, or load.damping");
    return false;
}

/// Its frequency and damping, and the energy it keeps.
inline void compare_bar(const FinishedRun& run, common::Summary& summary) {
    if (!knows_damping(run, 0.2, "frequency", summary)) return;
    const double gamma = 0.5 * run.parameters.problem.damping,
                 change = run.planned.scheme.bar_tolerance;
    const auto root_of = [&](double w) { return -Swing{w, gamma}.slow(); };
    compare_bar_with(run, root_of, gamma > 0 ? 0.5 * change / run.end : 0,
                     "bar with a fixed and a free end", summary);
    if (std::isfinite(change)) compare_energy(run, change, summary);
}

// ---- a compression wave that stands between rollers ---------------------------------------------

/// Needs one box with the profile of a wave, which fills a mesh between rollers.
inline void need_wave(const PlannedCase& planned) {
    const Mesh mesh = planned.parameters.problem.mesh();
    bool rollers = true;
    for (const Side side : {x_low, x_high, y_low, y_high})
        rollers = rollers && planned.has_wall(side, "slip");
    planned.refuse(!planned.has_profile("wave") || planned.free_grains() != 1 || !rollers,
                   " needs one box with profile = \"wave\", an amplitude, and all walls \"slip\"");
    planned.refuse_gravity();
    const Bounds box = bounds(planned.plans[0].outline);
    const auto same = [&](double a, double b) { return std::fabs(a - b) < 1e-6 * mesh.h; };
    planned.refuse(!same(box.x_low, mesh.x_low) || !same(box.x_high, mesh.x_high()) ||
                       !same(box.y_low, mesh.y_low) || !same(box.y_high, mesh.y_high()),
                   " needs a box that fills the mesh: make it " + format(mesh.length_x()) + " by " +
                       format(mesh.y_high() - mesh.y_low));
}

/// The one free node between two fixed ends, with frozen particles; each scheme has its own result.
inline void need_oscillator(const PlannedCase& planned) {
    const Case& parameters = planned.parameters;
    planned.refuse_viscosity();
    need_wave(planned);
    planned.refuse(parameters.problem.cells_x != 2 || !parameters.frozen ||
                       parameters.shape != "linear" || parameters.flip != 1,
                   " needs grid.cells_x = 2, method.frozen = true, and linear FLIP");
}

/// Velocities at the end, particle by particle.
inline void compare_standing_wave(const FinishedRun& run, common::Summary& summary) {
    if (run.planned.scheme.damps_first && !knows_damping(run, 0.2, "velocity_error", summary))
        return;
    const Problem& problem = run.parameters.problem;
    const Material& m = run.material();
    const GrainCase& from = problem.grains.front();
    StandingWave wave{problem.length_x, 1,           m.density,      moduli(m),
                      int(from.mode),   m.viscosity, problem.damping};
    wave.moduli.lambda *= run.stiffening(), wave.moduli.G *= run.stiffening();
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
    const double q = wave.swing().at(run.end), rate = wave.swing().rate(run.end) / wave.frequency();
    if (std::hypot(q, rate) < 1e-3)
        return summary.not_measured("velocity_error",
                                    "damping leaves " + format(std::hypot(q, rate)) +
                                        " of the wave at the end, too little: lower time.end");
    size *= q * q + rate * rate;
    const SchemeFacts& scheme = run.planned.scheme;
    // By theta = 1/2 the phase is late by omega t (omega dt)^2/12; the leapfrog makes up for a part of the mesh.
    const double step = wave.frequency() * run.scales.dt, tolerance = run.parameters.tolerance,
                 late = scheme.implicit ? wave.frequency() * run.end * step * step / 12 : 0,
                 strain = wave.amplitude * wave.wave_number();
    summary.hint(
        run.parameters.flip < 1 || run.parameters.transfer == "pic"
            ? "PIC damps, in each step: take method.flip = 1" +
                  std::string(scheme.implicit ? "" : " and method.transfer = \"flip\"")
        : scheme.implicit && scheme.theta > 0.5
            ? "method.theta = " + format(scheme.theta) +
                  " damps: set it to 0.5, or lower time.alpha"
            : "the mesh of " + format(double(problem.cells_x)) +
                  " cells changes the speed of waves, by a phase that grows with time: refine it, "
                  "or lower time.end" +
                  (late > 0.25 * tolerance ? " or time.alpha" : "") +
                  (strain > 0.1 * tolerance
                       ? "; theory is of small strain: lower amplitude = " + format(from.amplitude)
                       : ""));
    summary.result("velocity_error", std::sqrt(error / size), "1", 0, tolerance,
                   "rms over particles at the end, of the wave's own rms, of velocity and strain; "
                   "exact for small strain");
}

// ---- two bonded halves of a bar that vibrates ---------------------------------------------------

/// Needs what a bar needs, and a bond between two boxes.
inline void need_bond(const PlannedCase& planned) {
    need_bar(planned);
    planned.refuse(planned.parameters.problem.bonds.empty() || planned.free_grains() != 2,
                   " needs two boxes and a [bond.<name>] between them");
}

/// One bar as long as the bond holds, and when it breaks.
inline void compare_bond(const FinishedRun& run, common::Summary& summary) {
    const double part = run.parameters.tolerance, stiffer = run.stiffening();
    if (!knows_damping(run, run.planned.scheme.damps_first ? 0.2 : 1.5 * part, "bond_breaks",
                       summary))
        return;
    const Bar bar = bar_of(run);
    const auto times = run.history.column("time"), broken = run.history.column("broken_bonds"),
               normal = run.history.column("bond_normal_1");
    // Only waves see the bar stiffer than its stress does.
    const std::vector<PlannedGrain>& halves = run.planned.plans;
    const double joint =
                     std::min(bounds(halves[0].outline).x_high, bounds(halves[1].outline).x_high) -
                     profile_bounds(halves).x_low,
                 strength = stiffer * run.all.bonds.front().tension,
                 expected = bar_breaking_time(bar, joint, strength);
    summary.hint("the bar is " + format(bar.length / run.parameters.problem.mesh().h) +
                 " cells long and its stress is that of whole cells: refine the mesh, or lower "
                 "time.alpha; bond.*.tension decides when it breaks");
    if (std::isfinite(expected)) {
        // Of the step that breaks it, the row before and the row after are known.
        const double per_row = run.scales.dt * double(run.parameters.history_steps),
                     breaks = common::time_at_level(times, broken, 0.5) +
                              run.planned.scheme.bond_level * run.scales.dt,
                     tolerance = part * expected;
        if (!(bar_breaking_time(bar, joint, (1 + part) * strength) <= (1 + 5 * part) * expected))
            return summary.not_measured(
                "bond_breaks", "the stress at the joint hardly grows when it breaks, at t = " +
                                   format(expected) + ": lower bond.*.tension");
        if (std::isnan(breaks) && times.back() < expected + tolerance)
            return summary.not_measured(
                "bond_breaks",
                "theory has it break at t = " + format(expected) + ": raise time.end above that");
        const bool holds = std::isnan(breaks);
        summary.result(
            "bond_breaks", {holds ? times.back() : breaks, holds ? 0 : 0.5 * per_row}, "time",
            expected, tolerance,
            holds ? "it held to the end"
                  : "stress of the bar at the joint, between rows " + format(per_row) + " apart");
    } else {
        compare_bar(run, summary);
        const double peak = bar_stress(bar, joint, bar.swing().first_turn()) / stiffer;
        summary.result("largest_bond_stress", *std::max_element(normal.begin(), normal.end()),
                       "stress", peak, part * peak, "stress of the bar at the joint");
    }
}

}  // namespace mpm::theory
