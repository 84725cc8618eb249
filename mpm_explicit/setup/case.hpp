// Everything a case file of mpm_explicit can say.
#pragma once

#include "mpm_explicit/setup/case_of_grains.hpp"

namespace mpm_explicit {

using namespace mpm;

/// The table of all parameters.
inline common::ParameterTable describe(Case& w) {
    common::ParameterTable table;
    describe_problem(table, w.problem);
    describe_time(table, w);
    describe_method(table, w);
    describe_comparison(table, w,
                        {"none", "rebound", "bar", "standing_wave", "oscillator", "block",
                         "cylinder", "disk", "bond", "yield", "collapse"});
    describe_output(table, w);
    return table;
}

}  // namespace mpm_explicit
