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
                       problem.damping != 0,
                   " needs a single disk with a spin, without gravity and damping");
}

/// sum_p m_p |x_p - X|^2, about the center of mass X.
inline double moment_of_inertia(const Particles& at, const Grain& grain) {
    double m = 0, x = 0, y = 0, squares = 0;
    for (long k = grain.begin; k < grain.end; ++k) {
        const auto p = static_cast<std::size_t>(k);
        m += at.m_p[p], x += at.m_p[p] * at.x_p[p], y += at.m_p[p] * at.y_p[p];
        squares += at.m_p[p] * (at.x_p[p] * at.x_p[p] + at.y_p[p] * at.y_p[p]);
    }
    return squares - (x * x + y * y) / m;
}

inline void inertia_column(const PlannedCase& planned, const Assembly& all, common::Row& row) {
    row.add("inertia", "mass*length^2",
            moment_of_inertia(all.particles, all.grains[planned.target()]));
}

/// By how much the moment of inertia of an elastic disk grows that spins steadily in plane strain.
///   u(r) = rho w^2 (1 - n) r [(3 + n) R^2 - (1 + n) r^2] / (8 E'),  E' = E/(1 - nu^2),
///   n = nu/(1 - nu),  dI/I = 2 int u r^2 dr / int r^3 dr
/// in:     w, its angular velocity; R, its radius
inline double inertia_growth(const Material& m, double w, double R) {
    const double n = m.nu / (1 - m.nu), per_E = (1 - m.nu * m.nu) / m.E;
    return m.density * w * w * R * R * (1 - n) * per_E / 4 * ((3 + n) - 2 * (1 + n) / 3);
}

/// Angular momentum, which stays, and the moment of inertia, about which the disk breathes: it starts
/// without stress.
inline void compare_spin(const FinishedRun& run, common::Summary& summary) {
    const PlannedGrain& plan = run.planned.plans[0];
    const auto L = run.history.column("angular_momentum"), I = run.history.column("inertia");
    double off = 0, mean = 0;
    for (const double now : L) off = std::fmax(off, std::fabs(now / L.front() - 1));
    for (const double now : I) mean += now / (I.front() * double(I.size()));
    summary.result("angular_momentum_change", off, "1", 0, run.parameters.tolerance,
                   "largest, over that at the start");
    summary.result("moment_of_inertia", mean, "1",
                   1 + inertia_growth(run.material(), plan.from.spin, plan.outline.radius),
                   run.parameters.tolerance,
                   "mean over that at the start: a disk in plane strain that spins");
    summary.result_info("turns", std::fabs(plan.from.spin) * run.end / (2 * std::numbers::pi), "1",
                        "at the spin of the start");
}

}  // namespace mpm::theory
