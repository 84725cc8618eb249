// Everything a case file of mpm_explicit can say.
#pragma once

#include <string>
#include <vector>

#include "mpm_explicit/setup/case_of_grains.hpp"

namespace mpm_explicit {

using namespace mpm;

/// The table of all parameters.
/// in: comparison_names, the choices of theory.compare
inline common::ParameterTable describe(Case& w, const std::vector<std::string>& comparison_names) {
    common::ParameterTable table;
    describe_problem(table, w.problem);
    describe_time(table, w);
    describe_method(table, w);
    describe_comparison(table, w, comparison_names);
    describe_output(table, w);
    return table;
}

}  // namespace mpm_explicit
