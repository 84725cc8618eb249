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
    double m = 0, x = 0, y = 0, squares = 0;
    for (long k = grain.begin; k < grain.end; ++k) {
        const auto p = static_cast<std::size_t>(k);
        m += at.m_p[p], x += at.m_p[p] * at.x_p[p], y += at.m_p[p] * at.y_p[p];
    }
    x /= m, y /= m;
    for (long k = grain.begin; k < grain.end; ++k) {
        const auto p = static_cast<std::size_t>(k);
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
    summary.hint(
        "lumped masses and linear shapes take the spin within a cell: set "
        "method.transfer = \"spin\" in mpm_explicit or method.mass = \"consistent\" in "
        "mpm_implicit, method.shape = \"quadratic\", refine the mesh, or lower "
        "time.alpha = " +
        format(run.parameters.alpha));
    summary.result_at_most("angular_momentum_change", off, "1", run.parameters.tolerance,
                           "about the center of mass: largest, over that at the start");
    summary.result("moment_of_inertia", mean, "1",
                   1 + inertia_growth(run.material(), plan.from.spin, plan.outline.radius),
                   run.parameters.tolerance,
                   "mean over that at the start: a disk in plane strain that spins");
    summary.result_info("turns", std::fabs(plan.from.spin) * run.end / (2 * std::numbers::pi), "1",
                        "at the spin of the start");
}

}  // namespace mpm::theory
