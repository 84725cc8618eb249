// The results of grains under load, whatever the scheme.
#pragma once

#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "mpm_explicit/setup/check_case.hpp"
#include "mpm_explicit/theory/compare_elastic.hpp"
#include "mpm_explicit/theory/scheme_theory.hpp"

namespace mpm::theory {

/// The slope of the line through y(x) by least squares, where x is at least `from`.
inline double slope(const std::vector<double>& x, const std::vector<double>& y, double from) {
    std::vector<double> u, v;
    for (std::size_t n = 0; n < x.size(); ++n)
        if (x[n] >= from) u.push_back(x[n]), v.push_back(y[n]);
    double c0, c1, c00, c01, c11, chi2;
    if (u.size() < 2) return std::nan("");
    gsl_fit_linear(u.data(), 1, v.data(), 1, u.size(), &c0, &c1, &c00, &c01, &c11, &chi2);
    return c1;
}

// ---- a block or a cylinder on a rigid plate, gravity inclined -----------------------------------

/// Needs one grain, a rigid plate, and a gravity that is not perpendicular to it.
inline void need_incline(const PlannedCase& planned) {
    const Problem& problem = planned.parameters.problem;
    planned.refuse(
        planned.free_grains() != 1 || planned.rigid_grains() < 1 || problem.gravity_x == 0 ||
            !(problem.gravity_y < 0),
        " needs one grain, a rigid plate, and an inclined gravity: load.gravity_x not 0, "
        "load.gravity_y below 0");
    const Bounds grain = bounds(planned.plans[planned.target()].outline);
    double top = -std::numeric_limits<double>::infinity();  // of the plates below
    for (const PlannedGrain& plan : planned.plans) {
        const double high = bounds(plan.outline).y_high;
        if (!planned.is_rigid(plan) || high >= 0.5 * (grain.y_low + grain.y_high)) continue;
        planned.refuse(!planned.is_fixed(plan),
                       " is of a plate at rest: take out what moves '" + plan.name + "'");
        top = std::max(top, high);
    }
    planned.refuse(
        std::isinf(top),
        " needs a rigid plate below the grain: turn the case, so that x is along the plate");
    const GrainCase& from = planned.plans[planned.target()].from;
    planned.refuse(
        from.velocity_x != 0 || from.velocity_y != 0 || from.spin != 0 || from.amplitude != 0,
        " is of a grain that starts at rest: take out velocity_x, velocity_y, spin and "
        "amplitude of '" +
            from.name + "'");
    planned.refuse(grain.y_low - top > 0.1 * problem.mesh().h,
                   " needs a grain on its plate, and '" + from.name + "' begins " +
                       format(grain.y_low - top) + " above: lower it");
}

/// Friction between the target grain and theory.plate, or the first rigid grain.
inline double friction_on_plate(const PlannedCase& planned) {
    const std::string& name = planned.parameters.plate;
    const auto plate = std::find_if(planned.plans.begin(), planned.plans.end(), [&](auto& plan) {
        return planned.is_rigid(plan) && (name.empty() || plan.name == name);
    });
    return planned.parameters.problem.friction_between(
        planned.material_of(planned.plans[planned.target()]).name,
        planned.material_of(*plate).name);
}

/// The acceleration of the grain, fitted to its momentum.
/// in: acceleration by theory, of g, angle and friction
inline void compare_incline(const FinishedRun& run,
                            double (*acceleration)(double g, double angle, double mu),
                            const std::string& source, common::Summary& summary) {
    const Problem& problem = run.parameters.problem;
    const double g = std::hypot(problem.gravity_x, problem.gravity_y),
                 angle = std::atan2(std::fabs(problem.gravity_x), -problem.gravity_y),
                 exact = acceleration(g, angle, friction_on_plate(run.planned));
    auto v = run.momentum_x();
    const double m = run.mass();
    for (double& value : v) value /= std::copysign(m, problem.gravity_x);
    const auto times = run.history.column("time");
    const double end_speed = v.back();
    // Damping c makes it dv/dt = a - c v, of what slides and of what rolls: v + c x has the slope a.
    double way = 0, before = v.front();
    for (std::size_t n = 1; n < v.size(); ++n) {
        way += 0.5 * (times[n] - times[n - 1]) * (before + v[n]), before = v[n];
        v[n] += problem.damping * way;
    }
    const double from = std::max(problem.rise, 0.25 * run.end), measured = slope(times, v, from);
    if (std::isnan(measured))
        return summary.not_measured("acceleration",
                                    "it is measured from t = " + format(from) +
                                        " on, when gravity is there: raise time.end");
    const Outline& outline = run.planned.plans[run.planned.target()].outline;
    const bool is_round = outline.kind == OutlineKind::disk;
    const double mu = friction_on_plate(run.planned);
    const double steady = is_round ? 0 : steadying_viscosity(outline, run.material());
    const std::string flutters = run.material().viscosity < 0.8 * steady
                                     ? "friction follows the pressure, which flutters where a "
                                       "grain slides, or friction above 0.65 holds it, without "
                                       "viscosity: set material.*.viscosity = " +
                                           format(steady) + "; or "
                                     : "";
    summary.hint(
        exact == 0 ? (mu > 0.65 ? flutters : "") +
                         "what friction holds sways on its base while its weight comes on: raise "
                         "load.rise, load.damping or time.end"
                   : flutters + (is_round ? "a round grain rolls on single nodes: " : "") +
                         "refine the mesh, or lower time.alpha = " + format(run.parameters.alpha));
    summary.result(
        "acceleration", measured, "acceleration", exact,
        exact > 0 ? run.parameters.tolerance * exact : 0.01 * g * std::sin(angle),
        source + (problem.damping > 0 ? "; of its speed and load.damping times its way" : ""));
    summary.result_info("speed_at_end", end_speed, "velocity", "along the plate");
    const auto pressed = run.history.column("contacts");
    double rows = 0, touching = 0;
    for (std::size_t n = 0; n < times.size(); ++n)
        if (times[n] >= from) rows += 1, touching += pressed[n] > 0 ? 1 : 0;
    summary.result_info("contact_time_share", touching / rows, "1",
                        "share of the rows in which the plate presses; below 1 the grain hops");
}

/// Needs what an incline needs, and a block that does not topple: friction, min(mu, tan) of its weight, pulls at
/// the bottom, and the base has to reach farther downhill than that turns the weight.
inline void need_block(const PlannedCase& planned) {
    need_incline(planned);
    const Problem& problem = planned.parameters.problem;
    const Outline& outline = planned.plans[planned.target()].outline;
    planned.refuse(outline.kind == OutlineKind::disk,
                   " is of a block, and a disk rolls: set theory.compare = \"rolling\"");
    const double slope = std::min(friction_on_plate(planned),
                                  std::fabs(problem.gravity_x / problem.gravity_y)),
                 low = bounds(outline).y_low, downhill = std::copysign(1, problem.gravity_x);
    double reach = -1e300;
    for (const Point& corner : outline.corners)
        if (corner.y - low < 1e-6 * outline.radius)
            reach = std::max(reach, downhill * (corner.x - outline.x));
    planned.refuse(slope * (outline.y - low) >= reach,
                   " is of a block that does not topple, and friction turns this one over its "
                   "lower edge: its base reaches " +
                       format(reach) + " beyond its center, and has to reach farther than " +
                       format(slope * (outline.y - low)));
}

/// A block slides, or friction holds it.
inline void compare_block(const FinishedRun& run, common::Summary& summary) {
    compare_incline(run, block_acceleration, "g (sin - mu cos), or 0 where friction holds",
                    summary);
}

/// How fast the target grain turns, omega = sum_p m_p (x_p - X) x v_p / sum_p m_p |x_p - X|^2.
inline void turning_column(const PlannedCase& planned, const Assembly& all, common::Row& row) {
    const Particles& at = all.particles;
    const Grain& grain = all.grains[planned.target()];
    const auto [m, x, y] = center_of_mass(at, grain.begin, grain.end);
    double turns = 0, squares = 0;
    for (long p = grain.begin; p < grain.end; ++p) {
        const double dx = at.x_p[p] - x, dy = at.y_p[p] - y;
        turns += at.m_p[p] * (dx * at.vy_p[p] - dy * at.vx_p[p]);
        squares += at.m_p[p] * (dx * dx + dy * dy);
    }
    row.add("angular_velocity", "1/time", turns / squares);
}

/// Needs what a block needs, and a disk.
inline void need_rolling(const PlannedCase& planned) {
    need_incline(planned);
    planned.refuse(planned.plans[planned.target()].outline.kind != OutlineKind::disk,
                   " needs a disk");
}

/// A cylinder rolls, or slips. Where it rolls, v_y = 0 and U = omega R: the largest velocity of its
/// center away from the plate or towards it, over that along the plate, and the mean velocity of the
/// center over that of the rim, in the second half of the run. Where it slips, friction turns it:
/// I omega' = mu N R, I = m R^2/2.
inline void compare_rolling(const FinishedRun& run, common::Summary& summary) {
    compare_incline(run, cylinder_acceleration,
                    "(2/3) g sin where it rolls, g (sin - mu cos) where it slips", summary);
    const Problem& problem = run.parameters.problem;
    const auto times = run.history.column("time"), p_x = run.momentum_x(),
               p_y = run.history.column("momentum_y_" + run.grain().name);
    auto omega = run.history.column("angular_velocity");
    const double R = run.planned.plans[run.planned.target()].outline.radius, m = run.mass(),
                 turns = -2 * friction_on_plate(run.planned) * problem.gravity_y / R;
    if (std::fabs(problem.gravity_x) > 1.5 * turns * R) {
        const double from = std::max(problem.rise, 0.25 * run.end);
        double angle = 0, before = omega.front();
        for (std::size_t n = 1; n < times.size(); ++n) {
            angle += 0.5 * (times[n] - times[n - 1]) * (before + omega[n]), before = omega[n];
            omega[n] += problem.damping * angle;
        }
        const double measured = -std::copysign(1, problem.gravity_x) * slope(times, omega, from);
        if (std::isnan(measured)) return;  // as the acceleration, which says so
        summary.hint(
            "columns of nodes hold a disk up to two hundredths of R off its lowest point, which "
            "turns it as a rolling friction does: the more friction, the less that is of it");
        // Without friction as much as a tenth is of friction 0.1.
        const double most = turns == 0 ? -0.02 * problem.gravity_y / R : 0.1 * turns;
        return summary.result("angular_acceleration", measured, "1/time^2", turns, most,
                              "2 mu g cos/R: friction turns what slips");
    }
    double hops = 0, center = 0, rim = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        if (times[n] < 0.5 * run.end) continue;
        hops = std::max(hops, std::fabs(p_y[n] / p_x[n]));
        center += std::fabs(p_x[n] / m), rim += std::fabs(omega[n]) * R;
    }
    summary.hint(
        "contact is at nodes, and between two of them what rolls sinks and hops: refine the mesh, "
        "and lengthen load.rise");
    summary.result_at_most("vertical_speed", hops, "1", 0.01,
                           "of the center, over that along the plate: largest, second half of the "
                           "run");
    summary.result("speed_over_rim", center / rim, "1", 1, 0.01,
                   "U over omega R, second half of the run: it rolls without slip");
}

// ---- a grain at rest on a rigid plate -----------------------------------------------------------

/// What moves a grain that should rest.
inline std::string rest_hint(const FinishedRun& run) {
    const Case& w = run.parameters;
    const Outline& outline = run.planned.plans[run.planned.target()].outline;
    const Mesh mesh = w.problem.mesh();
    const double half_cells = 2 * (outline.x - mesh.x_low) / mesh.h,
                 line = mesh.x_low + 0.5 * mesh.h * std::round(half_cells);
    if (outline.kind == OutlineKind::disk)
        return "nodes hold a disk beside its lowest point, and it rolls to where they are alike on "
               "both sides: put its center at x = " +
               format(line) + ", and set contact.friction = 0 and load.damping = " +
               format(std::sqrt(-w.problem.gravity_y / outline.radius)) +
               "; where that is not enough, refine the mesh";
    if (run.planned.scheme.implicit)
        return "stress that is held turns into noise of the mesh where nothing damps what rings: "
               "set method.theta = 0.51, or material.<name>.viscosity = " +
               format(0.1 * run.scales.dt) + ", a tenth of a step, and lengthen load.rise";
    std::string hint = "lengthen load.rise to many periods of the block";
    if (w.problem.contact.levels != 2) hint += ", take contact.levels = 2";
    if (w.shape != "linear") hint += ", take method.shape = \"linear\"";
    return hint + ", and put surfaces on lines of nodes";
}

/// Needs one grain, a rigid plate, and gravity towards it.
inline void need_rest(const PlannedCase& planned) {
    const Problem& problem = planned.parameters.problem;
    planned.refuse(planned.free_grains() != 1 || planned.rigid_grains() < 1 ||
                       problem.gravity_x != 0 || !(problem.gravity_y < 0),
                   " needs one grain, a rigid plate, and load.gravity_y below 0 alone");
}

/// The largest kinetic energy in the second half of the run, over m g h with the height h of the
/// grain; and how much of it is new in the last quarter.
inline void compare_rest(const FinishedRun& run, common::Summary& summary) {
    const Particles& at = run.all.particles;
    const auto [low, high] =
        std::minmax_element(at.y_p.begin() + run.grain().begin, at.y_p.begin() + run.grain().end);
    const double weight = -run.mass() * run.parameters.problem.gravity_y * (*high - *low);
    const auto times = run.history.column("time"), kinetic = run.history.column("kinetic");
    double third = 0, last = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        if (times[n] < 0.5 * run.end) continue;
        double& quarter = times[n] < 0.75 * run.end ? third : last;
        quarter = std::max(quarter, kinetic[n]);
    }
    summary.hint(rest_hint(run));
    summary.result_at_most("kinetic_over_weight", std::max(third, last) / weight, "1", 1e-6,
                           "at rest, over m g h, in the second half of the run");
    summary.result_at_most("kinetic_grows", (last - third) / weight, "1", 1e-8,
                           "the last quarter less the third, over m g h");
}

// ---- a disk between two plates (Brazilian test) -------------------------------------------------

/// Needs a disk, first in the case, and rigid plates.
inline void need_pressed_disk(const PlannedCase& planned) {
    const PlannedGrain& first = planned.plans[0];
    const long plates = planned.rigid_grains();
    planned.refuse(planned.free_grains() != 1 || plates < 1 || plates > 16 ||
                       first.outline.kind != OutlineKind::disk || planned.is_rigid(first),
                   " needs a disk, first in the case, and rigid plates, at most 16");
    planned.refuse_gravity();
}

/// Mean stress of the particles within a distance of the center of a grain.
inline Stress stress_at_center(const Assembly& all, std::size_t grain, double distance) {
    const Particles& at = all.particles;
    const long begin = all.grains[grain].begin, end = all.grains[grain].end;
    const auto [m, x, y] = center_of_mass(at, begin, end);
    double V = 0;
    Stress mean;
    for (long p = begin; p < end; ++p) {
        if (std::hypot(at.x_p[p] - x, at.y_p[p] - y) > distance) continue;
        V += at.V_p[p], mean.xx += at.V_p[p] * at.sxx_p[p], mean.yy += at.V_p[p] * at.syy_p[p];
        mean.xy += at.V_p[p] * at.sxy_p[p], mean.zz += at.V_p[p] * at.szz_p[p];
    }
    return {mean.xx / V, mean.yy / V, mean.xy / V, mean.zz / V};
}

/// Stress at the center, averaged over a circle of one and a half cells.
inline void center_columns(const PlannedCase& planned, const Assembly& all, common::Row& row) {
    const Stress s =
        stress_at_center(all, planned.target(), 1.5 * planned.parameters.problem.mesh().h);
    row.add("center_xx", "stress", s.xx);
    row.add("center_yy", "stress", s.yy);
    row.add("center_xy", "stress", s.xy);
}

/// The mean of a column over the last tenth of the run.
inline double mean_late(const FinishedRun& run, const std::string& name) {
    const auto times = run.history.column("time"), values = run.history.column(name);
    double sum = 0, count = 0;
    for (std::size_t n = 0; n < times.size(); ++n)
        if (times[n] >= 0.9 * run.end) sum += values[n], count += 1;
    return sum / count;
}

/// The late load: the mean of the plates that count, and the difference of the largest and the smallest
/// of all.
struct PlateLoad {
    double mean = 0, spread = 0;
};
/// Reports it; where the plates bear nothing, that `result` cannot be measured.
inline PlateLoad load_of_plates(const FinishedRun& run, const std::string& result,
                                common::Summary& summary) {
    double sum = 0, plates = 0, least = 1e300, most = 0;
    for (const Grain& grain : run.all.grains) {
        if (!grain.rigid) continue;
        const double P = std::fabs(mean_late(run, "force_y_" + grain.name));
        least = std::min(least, P), most = std::max(most, P);
        if (run.parameters.plate.empty() || grain.name == run.parameters.plate)
            sum += P, plates += 1;
    }
    if (sum > 0)
        summary.result_info("load", sum / plates, "force",
                            "of the plates, the mean over the last tenth of the run");
    else
        summary.not_measured(result,
                             "the plates bear nothing in the last tenth of the run: let one press");
    return {sum / plates, most - least};
}

/// The stress at the center under the mean load of the plates, against the closed form.
inline void compare_disk(const FinishedRun& run, common::Summary& summary) {
    const double P = load_of_plates(run, "center_difference", summary).mean;
    if (!(P > 0)) return;
    const double R = run.planned.plans[run.planned.target()].outline.radius;
    const double xx = mean_late(run, "center_xx"), yy = mean_late(run, "center_yy"),
                 xy = mean_late(run, "center_xy"), exact = disk_center_difference(P, R);
    const Stress center = disk_stress(P, R, 0, 0);
    const std::string source = "Hertz's disk between two line loads";
    summary.hint("the contact is " +
                 format(contact_half_width(
                            {R, run.material().density, run.material().E, run.material().nu}, P) /
                        run.parameters.problem.mesh().h) +
                 " cells wide at each side and waves of the load die out slowly: refine the mesh, "
                 "lengthen load.rise, raise load.damping, or take method.shape = \"gimp\"");
    summary.result("center_difference", std::hypot(xx - yy, 2 * xy) / exact, "1", 1,
                   run.parameters.tolerance, source + ", over 8P/(pi D)");
    summary.result("center_xx", xx / center.xx, "1", 1, run.parameters.tolerance,
                   source + ", over 2P/(pi D)");
    summary.result("center_yy", yy / center.yy, "1", 1, run.parameters.tolerance,
                   source + ", over -6P/(pi D)");
    const Material& m = run.material();
    report_contact(run, contact_half_width({R, m.density, m.E, m.nu}, P), summary);
}

// ---- a cylinder between two plates (Hertz) ------------------------------------------------------

/// Needs a disk without friction that touches two rigid plates, one below and one above.
inline void need_hertz(const PlannedCase& planned) {
    need_pressed_disk(planned);
    const Outline& disk = planned.plans[0].outline;
    const Problem& problem = planned.parameters.problem;
    bool below = false, above = false;
    for (const PlannedGrain& plan : planned.plans) {
        const Bounds plate = bounds(plan.outline);
        const double near = 1e-6 * problem.mesh().h;
        below = below || std::fabs(disk.y - disk.radius - plate.y_high) < near;
        above = above || std::fabs(plate.y_low - disk.y - disk.radius) < near;
    }
    planned.refuse(planned.rigid_grains() != 2 || !below || !above || problem.has_friction() ||
                       planned.material_of(planned.plans[0]).law != Law::elastic,
                   " needs an elastic disk between two rigid plates that touch it below and above, "
                   "without friction");
}

/// How much closer the plates are than at the start, against line contact under the load that they
/// bear.
/// exact: for small strain and b much smaller than R; what is left out is at most 0.2 (b/R)^2 of it
inline void compare_hertz(const FinishedRun& run, common::Summary& summary) {
    const Material& m = run.material();
    const double R = run.planned.plans[0].outline.radius, h = run.parameters.problem.mesh().h;
    const Disk disk{R, m.density, m.E, m.nu};
    const PlateLoad load = load_of_plates(run, "approach", summary);
    if (!(load.mean > 0)) return;
    const double b = contact_half_width(disk, load.mean);
    double low = 0, high = 0;
    for (const PlannedGrain& plan : run.planned.plans)
        if (run.planned.is_rigid(plan))
            (plan.outline.y < run.planned.plans[0].outline.y ? low : high) =
                mean_late(run, "travel_y_" + plan.name);
    summary.hint(
        "the grain is not at rest between the plates: move them more slowly, let them stop "
        "before the last fifth of the run, and raise load.damping");
    summary.result_at_most("loads_differ", load.spread / load.mean, "1", 0.01,
                           "of both plates, over their mean: equal at rest");
    const bool implicit = run.planned.scheme.implicit;
    summary.hint(
        "the contact is " + format(b / h) + " cells wide at each side" +
        (b < 4 * h ? ", and the nodes see it coarsely: refine the mesh until it has four or more"
                   : ": refine the mesh") +
        (run.parameters.shape == "gimp"
             ? ""
             : "; take method.shape = \"gimp\", since noise of cell crossing softens") +
        (implicit && run.planned.scheme.theta < 0.6 ? "; method.theta = 0.6 damps noise" : ""));
    summary.result("approach", (low - high) / contact_approach(disk, load.mean), "1", 1,
                   run.parameters.tolerance,
                   "over 2 P (1 - nu^2) / (pi E) (2 ln(4 R/b) - 1), Johnson's eq. 5.57, at both "
                   "ends; strain = " +
                       format((low - high) / (2 * R)));
    report_contact(run, b, summary);
}

// ---- a grain that yields ------------------------------------------------------------------------

/// Needs a target grain of von Mises material, and one that moves.
inline void need_yielding(const PlannedCase& planned) {
    const PlannedGrain& target = planned.plans[planned.target()];
    planned.refuse(planned.material_of(target).law != Law::j2,
                   " needs a grain of a material with law = \"j2\", and '" + target.name +
                       "' is of another: set theory.grain");
    const auto is_at_rest = [&](const PlannedGrain& plan) {
        const GrainCase& from = plan.from;
        return planned.is_rigid(plan) || (from.velocity_x == 0 && from.velocity_y == 0 &&
                                          from.spin == 0 && from.amplitude == 0);
    };
    planned.refuse(std::ranges::all_of(planned.plans, is_at_rest),
                   " measures shares of the energy at the start, and nothing that can be strained "
                   "moves then: give it a velocity");
}

/// What yields stays on its yield surface and only ever takes energy.
inline void compare_yield(const FinishedRun& run, common::Summary& summary) {
    const Material& m = run.material();
    const Particles& at = run.all.particles;
    double worst = 0, most = 0, yielded = 0;
    for (long p = run.grain().begin; p < run.grain().end; ++p) {
        worst = std::max(worst,
                         von_mises(at.stress(p)) / (m.yield_stress + m.hardening * at.yield_p[p]));
        most = std::max(most, at.yield_p[p]);
        yielded += at.yield_p[p] > 0 ? 1 : 0;
    }
    if (yielded == 0)
        return summary.not_measured("largest_stress_over_strength",
                                    "nothing has yielded: raise the velocity or time.end, or lower "
                                    "yield_stress");
    const auto plastic = run.history.column("plastic"), energy = run.history.column("energy");
    double backward = 0;
    for (std::size_t n = 1; n < plastic.size(); ++n)
        backward = std::max(backward, plastic[n - 1] - plastic[n]);
    summary.hint("the return to the yield surface is exact in a step: lower time.alpha");
    summary.result_at_most("largest_stress_over_strength", worst, "1", 1 + 1e-12,
                           "von Mises stress over Y + H ep, at the end");
    summary.result_at_most("plastic_work_undone", backward, "energy", 1e-12 * energy.front(),
                           "plastic work never comes back");
    summary.result_info("plastic_work", plastic.back() / energy.front(), "1",
                        "of the initial energy");
    summary.result_info("largest_plastic_strain", most, "1", "of a particle");
    summary.result_info("yielded", yielded / double(run.grain().end - run.grain().begin), "1",
                        "share of the particles");
}

// ---- a column of grains that collapses to one side ----------------------------------------------

/// The place beyond which a share of all mass that is not rigid lies, along x.
inline double front_of(const Assembly& all, double share) {
    std::vector<double> x;
    for (const Grain& grain : all.grains)
        if (!grain.rigid)
            x.insert(x.end(), all.particles.x_p.begin() + grain.begin,
                     all.particles.x_p.begin() + grain.end);
    const auto at = x.begin() + static_cast<std::ptrdiff_t>((1 - share) * double(x.size() - 1));
    std::nth_element(x.begin(), at, x.end());
    return *at;
}

/// The front of the grains.
inline void front_column(const PlannedCase&, const Assembly& all, common::Row& row) {
    constexpr double share_beyond = 0.01;
    row.add("front", "length", front_of(all, share_beyond));
}

/// Needs a column at the wall x_low, on the floor y_low, that falls to the right: as published ones, it rubs on
/// itself and on the floor, and nothing else acts.
inline void need_collapse(const PlannedCase& planned) {
    const Problem& problem = planned.parameters.problem;
    const Mesh mesh = problem.mesh();
    planned.refuse(planned.rigid_grains() > 0,
                   " needs no plate: the floor is the wall boundary.y_low, and the wall behind the "
                   "column is boundary.x_low");
    double x = 1e300, y = 1e300, largest = 0;
    for (const PlannedGrain& plan : planned.plans) {
        const Bounds box = bounds(plan.outline);
        x = std::min(x, box.x_low), y = std::min(y, box.y_low);
        largest = std::max(largest, 2 * plan.outline.radius);
    }
    planned.refuse(mesh.periodic_x || planned.has_wall(x_low, "open") ||
                       !(x - mesh.x_low < largest) || !(y - mesh.y_low < largest),
                   " needs a column in the lower left corner of the mesh, at a wall "
                   "boundary.x_low: it begins at x = " +
                       format(x) + " and y = " + format(y) + ", and the mesh at " +
                       format(mesh.x_low) + " and " + format(mesh.y_low));
    planned.refuse(!planned.has_wall(y_low, "frictional") || !(problem.contact.wall_friction > 0) ||
                       !(problem.contact.friction > 0),
                   " needs boundary.y_low = \"frictional\", and boundary.friction and "
                   "contact.friction above 0: published columns stand on rough floors");
    planned.refuse(!(problem.gravity_y < 0) || problem.gravity_x != 0 || problem.damping > 0,
                   " needs load.gravity_y below 0 alone, and load.damping = 0");
}

/// The run-out, between two published laws.
inline void compare_collapse(const FinishedRun& run, common::Summary& summary) {
    const auto front = run.history.column("front");
    double low = 1e300, high = -1e300, top = -1e300;
    for (const PlannedGrain& plan : run.planned.plans) {
        if (run.planned.is_rigid(plan)) continue;
        const Bounds box = bounds(plan.outline);
        low = std::min(low, box.x_low), high = std::max(high, box.x_high);
        top = std::max(top, box.y_high);
    }
    const double width = high - low, a = (top - run.parameters.problem.origin_y) / width,
                 runout = (front.back() - high) / width;
    summary.result_info("aspect_ratio", a, "1", "height over width of the column");
    const double wall = run.parameters.problem.mesh().x_high();
    if (front.back() + 0.1 * runout * width > wall)
        return summary.not_measured(
            "runout", "the front is at x = " + format(front.back()) +
                          ", and what stopped it may be the end of the mesh at " + format(wall) +
                          ": take more cells along x");
    summary.hint(
        "grains of few cells and smooth floors run out farther, and steep or rough ones "
        "less: contact.friction = 0.5 on all, boundary.friction the same, some thousand "
        "grains, and a time.end at which they rest");
    summary.result_within("runout", runout, "1", runout_in_experiments(a), runout_of_disks(a),
                          "(L_end - L_0)/L_0, between columns of sand between plates (Lube and "
                          "others 2005) and stiff disks in two dimensions (Staron and Hinch 2005)");
    const double steady = front[front.size() * 9 / 10];
    summary.result_within("still_moving", (front.back() - steady) / width, "1", -0.05, 0.05,
                          "what the front gained in the last tenth of the run");
}

}  // namespace mpm::theory
