// A comparison of a run with theory: one object that says what it needs, tracks and finds.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/run/history.hpp"
#include "common/run/summary.hpp"
#include "common/run/writers.hpp"
#include "flip/setup/initial_state.hpp"
#include "flip/theory/profiles.hpp"

namespace flip {

/// The fluid of t^n, of which a comparison tracks something.
struct Snapshot {
    const Case& parameters;
    const State& state;
    const Totals& totals;
    const CellFields& cells;
};

/// A run at its end.
struct FinishedRun {
    const Case& parameters;
    const std::string& program;
    const State& state;
    const Totals& totals;
    const CellFields& cells;
    const common::History& history;
    std::string profile;  // path of profile.dat
    common::Summary& summary;

    /// A result that may differ from theory by the tolerance of the case, relative.
    void result(const std::string& name, double value, const std::string& unit, double expected,
                const std::string& source) const {
        summary.result(name, value, unit, expected,
                       parameters.theory_tolerance * std::fabs(expected), source);
    }
    /// A result that may differ from theory by the tolerance of the case, absolute.
    void absolute_result(const std::string& name, double value, const std::string& unit,
                         double expected, const std::string& source) const {
        summary.result(name, value, unit, expected, parameters.theory_tolerance, source);
    }
    /// What a shortfall of the results that follow is most likely due to, and what to change.
    template <class... Part>
    void hint(const Part&... parts) const {
        summary.hint(sentence(parts...));
    }
    /// What could not be measured, why, and what to change.
    template <class... Part>
    void not_measured(const std::string& name, const Part&... parts) const {
        summary.not_measured(name, sentence(parts...));
    }
    /// A measured value without a verdict.
    void info(const std::string& name, double value, const std::string& unit,
              const std::string& source) const {
        summary.result_info(name, value, unit, source);
    }
};

/// Refuses a case for a comparison, which is named at the beginning of the sentence.
struct Refusal {
    std::string what;
    template <class... Part>
    void operator()(bool bad, const Part&... parts) const {
        common::refuse(bad, what, parts...);
    }
};

/// How many rows of cells a comparison needs, and the frame in which its theory may be stated.
enum class Rows { any, several };
enum class Frame { at_rest, moves_along_x, moves };

/// One comparison with theory: its name in theory.compare, and what it does; null: nothing.
///   validate  refuses a case that theory has no answer for
///   predict   what theory says before the run, in one line; dt is the first time step
///   warn      adds to the warnings what may mislead about the comparison
///   track     adds the diagnostics of t^n that the comparison needs to the row of the history
///   compare   adds the results to the summary
struct Comparison {
    const char* name;
    void (*validate)(const Case&, const Refusal& refuse) = nullptr;
    std::string (*predict)(const Case&, const std::string& program, double dt) = nullptr;
    void (*warn)(const Case&, std::vector<std::string>& warnings) = nullptr;
    void (*track)(const Snapshot&, common::Row& row) = nullptr;
    void (*compare)(const FinishedRun&) = nullptr;
    Rows rows = Rows::any;
    Frame frame = Frame::at_rest;
    bool axisymmetric = false;  // stated for rings too
    bool formulas = false;      // whether regions may have them
    bool vacuum = false;        // whether a region may be one
    bool swirl = false;         // whether the fluid may turn about the axis
};

/// Refuses a case without a region that has a flow.
inline void validate_flow(const Case& parameters, const Refusal& refuse, const std::string& flow) {
    bool found = false;
    for (const RegionCase& r : parameters.regions) found = found || r.flow == flow;
    refuse(!found, " needs a region with flow = \"", flow, "\"");
}

}  // namespace flip
