// A uniform electric field in a uniform plasma: what it becomes, and the drift E x B, beside their
// exact values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/run/run.hpp"
#include "implicit_moment/output/columns.hpp"
#include "implicit_moment/theory/wave_theory.hpp"

namespace implicit_moment {

/// The mean of E against that of the scheme, and the mean velocity over the run against c E x B/B^2.
///     The currents of the plasma weaken E: of E_0 across a strong B they leave
///     E_0/(1 + sum omega_s^2/Omega_s^2), with oscillations
/// note:   a mean over the time T has the turning points of a gyration at its ends, 4/(Omega T).
inline void compare_drift(const Case& w, const common::History& history, common::Summary& summary) {
    const auto times = history.column("time");
    const auto vector_of = [&](const std::string& name) {
        const std::array<std::vector<double>, 3> columns{
            history.column(name + "_x"), history.column(name + "_y"), history.column(name + "_z")};
        std::vector<Eigen::Vector3d> rows;
        for (std::size_t n = 0; n < times.size(); ++n)
            rows.emplace_back(columns[0][n], columns[1][n], columns[2][n]);
        return rows;
    };
    const auto E = vector_of("mean_E"), momentum = vector_of("momentum");
    const auto expected = mean_field(w, std::lround(times.back() / w.dt));
    double off = 0, largest = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        const Eigen::Vector3d& theory = expected.at(std::lround(times[n] / w.dt));
        off = std::max(off, (E[n] - theory).norm());
        largest = std::max(largest, theory.norm());
    }
    const Eigen::Vector3d B(w.uniform.B_x, w.uniform.B_y, w.uniform.B_z),
        E_0(w.uniform.E_x, w.uniform.E_y, w.uniform.E_z);
    const double fast = B.norm() > 0 ? E_0.cross(B).norm() / B.squaredNorm() : 0;
    // About the drift a charge swings as it begins: from rest to twice the drift, and its mass with it.
    const Eigen::Vector3d first = E_0.cross(B) * (B.norm() > 0 ? c / B.squaredNorm() : 0);
    // By heat a charge is heavier, some T/(m c^2) of its mass, and a wave falls behind by that part of its phase.
    double fastest = 0, heat = 0, omega2 = 0;
    for (const SpeciesCase& s : w.uniform.species) {
        if (s.charge == 0) continue;
        fastest = std::max(
            fastest, fast + (Eigen::Vector3d(s.drift_x, s.drift_y, s.drift_z) - first).norm());
        if (w.is_relativistic())
            heat = std::max(heat,
                            std::max({s.temperature_x, s.temperature_y, s.temperature_z}) / s.mass);
        omega2 +=
            s.density * s.charge * s.charge / s.mass + std::pow(s.charge / s.mass * B.norm(), 2);
    }
    const double phase = std::sqrt(omega2) * times.back();
    const std::string hot = "particles of " + format(heat) +
                            " m c^2 of heat are heavier by some of that, and theory has no Lorentz "
                            "factor: set particles.relativistic = false, or lower ";
    const std::string no_gamma = "the drift c E/B would be " + format(fast) +
                                 " c, and theory has no Lorentz factor: lower uniform.E" +
                                 (fastest < 0.9 ? ", or set particles.relativistic = false" : "");
    summary.hint(w.is_relativistic() && 0.5 * fast * fast * phase > 0.01
                     ? no_gamma
                     : cause_in_scheme(w, false) +
                           "few particles per cell shift the frequencies: raise "
                           "uniform.particles_per_cell" +
                           (w.loading == "random" ? ", or set plasma.loading = \"quiet\"" : ""));
    if (heat * phase > 0.01)
        summary.not_measured("mean_E_error", hot + "the temperatures or time.end");
    else
        summary.result_at_most("mean_E_error", off / largest, "", 0.01, "exact for the scheme");

    double mass = 0, slowest = HUGE_VAL;  // of what has a charge
    Eigen::Vector3d of_neutrals = Eigen::Vector3d::Zero();
    for (const SpeciesCase& s : w.uniform.species) {
        const double all = s.density * s.mass * w.grid.x.length * w.grid.z.length;
        if (s.charge == 0) {
            of_neutrals += all * Eigen::Vector3d(s.drift_x, s.drift_y, s.drift_z);
            continue;
        }
        mass += all;
        slowest = std::min(slowest, std::fabs(s.charge) / s.mass * B.norm() / c);
    }
    Eigen::Vector3d E_mean = Eigen::Vector3d::Zero(), velocity = E_mean;
    for (std::size_t n = 1; n < times.size(); ++n) {
        const double part = 0.5 * (times[n] - times[n - 1]) / times.back();
        E_mean += part * (E[n] + E[n - 1]);
        velocity += part / mass * (momentum[n] + momentum[n - 1] - 2 * of_neutrals);
    }
    const Eigen::Vector3d drift = c * E_mean.cross(B) / B.squaredNorm();
    if (mass == 0 || !(slowest * times.back() > 20) ||
        !(drift.norm() * B.norm() > 1e-3 * c * largest))
        return;
    summary.result_info("E_cross_B_drift", drift.norm(), "c", "c E x B/B^2, E the mean in time");
    if (!charges_cancel(w))
        return summary.not_measured("drift_over_E_cross_B",
                                    "the charge of what moves is balanced by a fixed background, "
                                    "which cannot drift: give species whose charges cancel");
    if (heat > 0.003)
        return summary.not_measured(
            "drift_over_E_cross_B",
            "the history has the momentum, of gamma v; " + hot + "the temperatures");
    if (w.is_relativistic() && fast > 0.05 && fast < 1)
        return summary.not_measured("drift_over_E_cross_B",
                                    "the history has the momentum, of gamma v; " + no_gamma);
    summary.result("drift_over_E_cross_B", velocity.dot(drift) / drift.squaredNorm(), "", 1,
                   0.01 + 4 / (slowest * times.back()), "all charges drift alike");
}

}  // namespace implicit_moment
