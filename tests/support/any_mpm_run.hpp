// Whole runs of a program of the material point method, without files for figures.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/support/any_numbers.hpp"
#include "tests/support/any_summary.hpp"
#include "tests/support/folder_of_test.hpp"

namespace facts {

/// Runs a case into a folder of its own. out: what it has left there.
/// in: name, of the folder; arguments, a case file and overrides; the exit status that is expected
inline Run run_mpm(const std::string& program, const std::string& name,
                   const std::string& arguments, int status = 0) {
    const std::string folder = facts::folder_of_test() + "/" + program + "_runs_" + name;
    const std::string command =
        std::string(BUILD_FOLDER) + "/" + program + " " + arguments +
        " output.particles_interval=0 output.fringes_interval=0 output.grains_interval=0 --out " +
        folder + " --force --quiet 2> /dev/null";
    CAPTURE(command);
    REQUIRE(std::system(command.c_str()) == 256 * status);
    return finished_run(folder);
}

inline double largest(const std::vector<double>& values) {
    double most = 0;
    for (const double v : values) most = worst({most, std::fabs(v)});
    return most;
}

}  // namespace facts
