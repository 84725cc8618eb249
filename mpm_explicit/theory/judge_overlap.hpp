// Whether the grains of an implicit run stay out of each other: its steps may be longer than nodes see
// ahead. Explicit steps are not. There the noise of the nodes also stretches single parts of an outline,
// which sums over nodes do not show, and a depth of such parts is none of the grain.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "mpm_explicit/theory/comparison.hpp"

namespace mpm::theory {

/// Why grains are in each other, and what has brought them apart where it was tried.
inline std::string overlap_hint(const FinishedRun& run, double overlap, double time) {
    const Case& w = run.parameters;
    // Steps so long pass in every run that was tried.
    const double part = 0.15 / std::max(0.5, overlap);
    char shorter[32];
    std::snprintf(shorter, sizeof shorter, "%.1g", part * (w.dt > 0 ? w.dt : w.alpha));
    const std::string cure = std::string("lower time.") + (w.dt > 0 ? "dt" : "alpha") + " to " +
                             format(std::stod(shorter));
    const std::string deepest = ", deepest at t = " + format(time);
    std::string hint =
        "grains that come nearer by a good part of a cell in a step are in each other before a "
        "node sees it, and stay so" +
        deepest + ": " + cure;
    const bool is_driven = std::ranges::any_of(run.planned.plans, [&](const PlannedGrain& plan) {
        return run.planned.is_rigid(plan) && plan.from.control != "velocity";
    });
    if (is_driven && run.planned.scheme.theta < 0.6)
        hint += ", or set method.theta = 0.6: a plate that a force drives swings without end";
    if (w.problem.gravity_x != 0 || w.problem.gravity_y != 0)
        hint += ", or raise load.rise, so that weight comes on slowly";
    return hint;
}

/// Judges how deep any two grains have been in each other, in cells, in all rows of the history
/// (output/overlap.hpp). Of sound runs the largest were 0.24 (all cases, at their steps), 0.37 (alpha = 4 to
/// 16); a disk of 4 cells under a plate was 0.43 deep at alpha = 12, 0.59 at 16 and 0.79 at 24, and the
/// plate of a pack did 0.98, 0.79 and 0.70 of its work at 0.27, 0.35 and 0.60. Half a cell is as far as
/// nodes on either side of a surface still see both bodies.
inline void judge_overlap(const FinishedRun& run, common::Summary& summary) {
    if (!run.planned.scheme.implicit || run.all.grains.size() < 2) return;
    const std::vector<double> overlap = run.history.column("overlap");
    const auto most = std::max_element(overlap.begin(), overlap.end());
    summary.hint(overlap_hint(run, *most, run.history.column("time")[most - overlap.begin()]));
    summary.result_at_most("overlap", *most, "h", 0.5,
                           "depth of one grain's outline in another's, the largest of all rows");
}

}  // namespace mpm::theory
