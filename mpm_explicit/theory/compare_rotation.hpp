// A free disk that spins: what steps and noise do to its angular momentum and to its size.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mpm_explicit/theory/comparison.hpp"

namespace mpm::theory {

/// Needs one disk that spins, and nothing that acts on it.
inline void need_spin(const PlannedCase& planned) {
    const Problem& problem = planned.parameters.problem;
    const PlannedGrain& first = planned.plans[0];
    planned.refuse(planned.plans.size() != 1 || first.outline.kind != OutlineKind::disk ||
                       first.from.spin == 0 || problem.gravity_x != 0 || problem.gravity_y != 0 ||
                       problem.damping != 0 || problem.periodic_x || planned.parameters.frozen ||
                       !(planned.has_wall(x_low, "open") && planned.has_wall(x_high, "open") &&
                         planned.has_wall(y_low, "open") && planned.has_wall(y_high, "open")),
                   " needs a single disk with a spin that moves free: no gravity, damping, walls, "
                   "period or method.frozen");
}

/// Its center of mass X, and sum_p m_p |x_p - X|^2.
inline void inertia_columns(const PlannedCase& planned, const Assembly& all, common::Row& row) {
    const Particles& at = all.particles;
    const Grain& grain = all.grains[planned.target()];
    const auto [m, x, y] = center_of_mass(at, grain.begin, grain.end);
    double squares = 0;
    for (long p = grain.begin; p < grain.end; ++p) {
        const double dx = at.x_p[p] - x, dy = at.y_p[p] - y;
        squares += at.m_p[p] * (dx * dx + dy * dy);
    }
    row.add("center_x", "length", x);
    row.add("center_y", "length", y);
    row.add("inertia", "mass*length^2", squares);
}

/// By how much the moment of inertia of an elastic disk grows that spins steadily in plane strain.
///   u(r) = rho w^2 (1 - n) r [(3 + n) R^2 - (1 + n) r^2] / (8 E'),  E' = E/(1 - nu^2),
///   n = nu/(1 - nu),  dI/I = 2 int u r^2 dr / int r^3 dr
/// in:     w, its angular velocity; R, its radius
inline double inertia_growth(const Material& m, double w, double R) {
    const double n = m.nu / (1 - m.nu), per_E = (1 - m.nu * m.nu) / m.E;
    return m.density * w * w * R * R * (1 - n) * per_E / 4 * ((3 + n) - 2 * (1 + n) / 3);
}

/// What keeps more of a spin than a case has chosen.
inline std::string cures_of_spin(const FinishedRun& run) {
    const Case& w = run.parameters;
    const SchemeFacts& scheme = run.planned.scheme;
    std::string cures;
    if (!scheme.implicit && w.transfer != "spin") cures += "set method.transfer = \"spin\", ";
    const std::string corner = sharp_corner(w.problem, run.planned.plans, run.planned.materials);
    if (scheme.implicit && !scheme.consistent_mass)
        cures += "set method.mass = \"consistent\"" +
                 (corner.empty() ? "" : ", with grid.particles_per_side = 3 because of " + corner) +
                 ", ";
    if (scheme.implicit && w.flip < 1) cures += "set method.flip = 1, ";
    if (scheme.theta > 0.5)
        cures += "set method.theta = 0.5, since " + format(scheme.theta) +
                 " damps what turns in a step, ";
    // As measured: other shapes help where the rest is right, and shorter steps the consistent mass alone.
    if (cures.empty() && w.shape == "linear") cures = "take method.shape = \"gimp\", ";
    const bool shorter = scheme.implicit && scheme.consistent_mass && w.flip == 1;
    return cures + "refine the mesh" +
           (shorter ? ", or lower time.alpha = " + format(w.alpha) : "");
}

/// Angular momentum about the center of mass, L - X x P, which stays whatever the frame; and the
/// moment of inertia, about which the disk breathes: it starts without stress.
inline void compare_spin(const FinishedRun& run, common::Summary& summary) {
    const PlannedGrain& plan = run.planned.plans[0];
    auto L = run.history.column("angular_momentum");
    const auto I = run.history.column("inertia"), x = run.history.column("center_x"),
               y = run.history.column("center_y"), p_x = run.history.column("momentum_x"),
               p_y = run.history.column("momentum_y");
    double off = 0, mean = 0;
    for (std::size_t n = 0; n < L.size(); ++n) {
        L[n] -= x[n] * p_y[n] - y[n] * p_x[n];
        off = std::fmax(off, std::fabs(L[n] / L.front() - 1));
    }
    for (const double now : I) mean += now / (I.front() * double(I.size()));
    const double rim = std::fabs(plan.from.spin) * plan.outline.radius / run.scales.sound_speed;
    summary.hint(
        (rim > 0.2
             ? "the rim is at " + format(rim) +
                   " of the speed of sound, and theory is of small strain: lower its spin; or "
             : "") +
        cures_of_spin(run));
    summary.result_at_most("angular_momentum_change", off, "1", run.parameters.tolerance,
                           "about the center of mass: largest, over that at the start");
    const double growth = inertia_growth(run.material(), plan.from.spin, plan.outline.radius);
    summary.result("moment_of_inertia", mean, "1", 1 + growth, run.parameters.tolerance,
                   "mean over that at the start: a disk in plane strain that spins");
    summary.result_info("inertia_growth", (mean - 1) / growth, "1",
                        "mean over that at the start less 1, over that of theory");
    summary.result_info("turns", std::fabs(plan.from.spin) * run.end / (2 * std::numbers::pi), "1",
                        "at the spin of the start");
}

// ---- any run in which nothing turns the grains from outside --------------------------------------

/// Warns where two grains press on each other while both travel over the mesh: by how many cells.
/// in:     m, their mass
inline void warn_of_travel(const FinishedRun& run, double m, common::Summary& summary) {
    if (run.planned.plans.size() != 2 || !run.planned.parameters.problem.bonds.empty()) return;
    const auto times = run.history.column("time"), force = run.history.column("contact_force"),
               p_x = run.history.column("momentum_x"), p_y = run.history.column("momentum_y");
    double pressed = 0;
    for (std::size_t n = 1; n < times.size(); ++n)
        if (force[n] > 0) pressed += times[n] - times[n - 1];
    const double cells = std::hypot(p_x.front(), p_y.front()) / m * pressed /
                         run.planned.parameters.problem.mesh().h;
    if (cells > 0.5)
        summary.late_warnings.push_back(
            "the grains travel " + format(cells) +
            " cells while they press, and a rebound depends on that: flat bars keep 0.92 "
            "of their velocity where they are and half of it over some cells; let their "
            "center of mass rest");
}

/// Says by how much the angular momentum of free grains strays, over the largest that their energy
/// can have, (2 K I)^1/2. No theorem keeps it: a twentieth says that the run has gone astray.
inline void judge_free_grains(const FinishedRun& run, common::Summary& summary) {
    const PlannedCase& planned = run.planned;
    const Problem& problem = planned.parameters.problem;
    bool open = !problem.periodic_x && !planned.parameters.frozen;
    for (const Side side : {x_low, x_high, y_low, y_high})
        open = open && planned.has_wall(side, "open");
    if (!open || planned.rigid_grains() > 0 || problem.gravity_x != 0 || problem.gravity_y != 0 ||
        problem.damping != 0)
        return;
    const Particles& at = run.all.particles;
    const auto [m, x, y] = center_of_mass(at, 0, at.count());
    double squares = 0, off = 0;
    for (std::size_t p = 0; p < at.m_p.size(); ++p)
        squares +=
            at.m_p[p] * ((at.x_p[p] - x) * (at.x_p[p] - x) + (at.y_p[p] - y) * (at.y_p[p] - y));
    const auto L = run.history.column("angular_momentum");
    for (const double now : L) off = std::fmax(off, std::fabs(now - L.front()));
    warn_of_travel(run, m, summary);
    const double kinetic = run.history.largest("kinetic") - energy_of_drift(run.history, run.all),
                 size = std::sqrt(2 * std::max(0.0, kinetic) * squares);
    summary.hint(cures_of_spin(run));
    if (size > 0)
        summary.result_at_most("angular_momentum_strays", off / size, "1", 0.05,
                               "largest change, over the largest that the energy allows");
}

}  // namespace mpm::theory
