// Whole runs of a program of the material point method, without files for figures.
#pragma once

#include <string>

#include "tests/support/any_summary.hpp"

namespace facts {

/// Runs a case into a folder of its own. out: what it has left there.
/// in: name, of the folder; arguments, a case file and overrides; the exit status that is expected
inline Run run_mpm(const std::string& program, const std::string& name,
                   const std::string& arguments, int status = 0) {
    return run_into(name, program,
                    arguments +
                        " output.particles_interval=0 output.fringes_interval=0 "
                        "output.grains_interval=0",
                    status);
}

}  // namespace facts
