// The results of a run: what was measured, beside the exact or the predicted value.
#pragma once

#include <string>

#include "common/summary.hpp"
#include "flip/follow.hpp"

namespace flip {

/// A run at its end.
struct FinishedRun {
    const Case& w;
    const std::string& program;
    const State& state;
    const Totals& totals;
    const CellFields& cells;
    const common::History& history;
    std::string profile;  // path of profile.dat
    common::Summary& summary;
};

/// The results of a case.
inline void compare_with_theory(const FinishedRun&) {}

}  // namespace flip
