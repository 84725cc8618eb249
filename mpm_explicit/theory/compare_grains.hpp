// The results of grains under load, whatever the scheme, and which comparison a case asks for.
#pragma once

#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/theory/compare_elastic.hpp"
#include "mpm_explicit/theory/scheme_theory.hpp"

namespace mpm {

namespace theory {

inline double slope(const std::vector<double>& x, const std::vector<double>& y, double from) {
    std::vector<double> u, v;
    for (std::size_t n = 0; n < x.size(); ++n)
        if (x[n] >= from) u.push_back(x[n]), v.push_back(y[n]);
    double c0, c1, c00, c01, c11, chi2;
    if (u.size() < 2) return std::nan("");
    gsl_fit_linear(u.data(), 1, v.data(), 1, u.size(), &c0, &c1, &c00, &c01, &c11, &chi2);
    return c1;
}

/// A block or a cylinder on a rigid plate, gravity inclined.
inline void compare_incline(const Run& run, common::Summary& summary) {
    const Problem& problem = run.parameters.problem;
    const double g = std::hypot(problem.gravity_x, problem.gravity_y),
                 angle = std::atan2(std::fabs(problem.gravity_x), -problem.gravity_y),
                 mu = problem.contact.friction;
    const bool block = run.parameters.compare == "block";
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
                   exact > 0 ? run.parameters.tolerance * exact : 0.01 * g * std::sin(angle),
                   source);
    summary.result_info("speed_at_end", v.back(), "velocity", "along the plate");
}

/// A disk between two plates (Brazilian test).
inline void compare_disk(const Run& run, common::Summary& summary) {
    const auto& grains = run.all.grains;
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
        if (grain.rigid && (run.parameters.plate.empty() || grain.name == run.parameters.plate))
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
                   run.parameters.tolerance, source + ", over 8P/(pi D)");
    summary.result("center_xx", xx / center.xx, "1", 1, run.parameters.tolerance,
                   source + ", over 2P/(pi D)");
    summary.result("center_yy", yy / center.yy, "1", 1, run.parameters.tolerance,
                   source + ", over -6P/(pi D)");
    const Material m = run.material();
    const double b = contact_half_width({R, m.density, m.E, m.nu}, P);
    summary.result_info("contact_half_width", b / R, "R", "line contact; the loads are no points");
}

/// What yields stays on its yield surface and only ever takes energy.
inline void compare_yield(const Run& run, common::Summary& summary) {
    const Material m = run.material();
    const Particles& at = run.all.particles;
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
    const double width = high - low, a = (top - run.parameters.problem.origin_y) / width,
                 runout = (last(front) - high) / width;
    summary.result_info("aspect_ratio", a, "1", "height over width of the column");
    summary.result_within("runout", runout, "1", runout_in_experiments(a), runout_of_disks(a),
                          "(L_end - L_0)/L_0, between columns of sand between plates (Lube and "
                          "others 2005) and stiff disks in two dimensions (Staron and Hinch 2005)");
    const double steady = front[front.size() * 9 / 10];
    summary.result_within("still_moving", (last(front) - steady) / width, "1", -0.05, 0.05,
                          "what the front gained in the last tenth of the run");
}

/// What a scheme may change of the energy.
struct EnergyTolerance {
    double rebound = 0, bar = 0;
};

}  // namespace theory

/// The comparison that the case asks for, where it holds for any scheme.
inline void compare_with_theory(const theory::Run& run, const theory::EnergyTolerance& tolerance,
                                common::Summary& summary) {
    using namespace theory;
    const std::string& compare = run.parameters.compare;
    if (compare == "rebound") compare_rebound(run, tolerance.rebound, summary);
    if (compare == "bar") compare_bar(run, tolerance.bar, summary);
    if (compare == "standing_wave") compare_standing_wave(run, summary);
    if (compare == "block" || compare == "cylinder") compare_incline(run, summary);
    if (compare == "disk") compare_disk(run, summary);
    if (compare == "bond") compare_bond(run, tolerance.bar, summary);
    if (compare == "yield") compare_yield(run, summary);
    if (compare == "collapse") compare_collapse(run, summary);
}

}  // namespace mpm
