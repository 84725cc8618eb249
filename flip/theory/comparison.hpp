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
    /// What stands before parameters that only flip has, in advice to take them.
    const char* flip_with() const { return program == "pic" ? "flip with " : ""; }
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

/// Refuses forces.
inline void validate_no_force(const Case& parameters, const Refusal& refuse) {
    refuse(parameters.gravity_x != 0 || parameters.gravity_z != 0 || parameters.trap != 0,
           " is for fluid without gravity or trap: take them out");
}

/// Whether two materials are the same gas by another name.
inline bool same_gas(const Material& a, const Material& b) {
    return a.gamma == b.gamma && a.p_infinity == b.p_infinity;
}

/// Refuses an inflow, which sends a wave into the mesh unless it brings the gas that a region has
/// there, with its velocity_x there.
inline void validate_inflow(const Case& parameters, const Refusal& refuse, Side end,
                            const RegionCase& r, double velocity_x) {
    if (!parameters.is(end, "inflow")) return;
    const GasCase& in = parameters.boundaries[end].inflow;
    const auto same = [&](const char* what, double brought, double there) {
        refuse(std::fabs(brought - there) > 1e-3 * std::fabs(there), ": the inflow at ",
               side_names[end], " has the ", what, " ", brought, ", and region.", r.name, " there ",
               there, ": give both the same");
    };
    same("density", in.density, r.gas.density);
    same("pressure", in.pressure, r.gas.pressure);
    same("velocity_x", in.velocity_x, velocity_x);
    same("velocity_z", in.velocity_z, r.gas.velocity_z);
    refuse(!same_gas(parameters.materials[material_index(parameters, in.material)],
                     material_of(parameters, r)),
           ": the inflow at ", side_names[end], " is another gas than region.", r.name,
           ": give both the same material");
}

/// The way from a point to an end of the mesh, negative from beyond it.
inline double way_to(const Grid& grid, Side end, double x, double z) {
    const common::Axis& axis = is_x_side(end) ? grid.x : grid.z;
    const double at = is_x_side(end) ? x : z;
    return is_low_side(end) ? at - axis.low : axis.high() - at;
}

/// Which viscosities to take for shocks, and what they are; empty where they are that.
inline std::string advice_on_viscosity(const Case& parameters) {
    const Case usual;
    if (parameters.q_linear == usual.q_linear && parameters.q_quadratic == usual.q_quadratic)
        return "";
    return sentence("viscosity.linear = ", usual.q_linear,
                    " and viscosity.quadratic = ", usual.q_quadratic, ", which are ",
                    parameters.q_linear, " and ", parameters.q_quadratic);
}

/// What to do about a viscosity of the fluid where theory has none.
inline const char* hint_on_viscosity(const Case& parameters) {
    return parameters.viscosity > 0
               ? "; flip.viscosity smears the waves, and theory has none: take it out"
               : "";
}

}  // namespace flip
