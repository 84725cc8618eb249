// How mpm_implicit takes a step: the level theta, and what solves for it.
#pragma once

#include <string>

namespace mpm_implicit {

/// The choices of a case; the words are those of the case file.
struct ThetaScheme {
    double theta = 0.5;
    std::string mass = "consistent", volumes = "kept", solver = "projected_cg",
                preconditioner = "grains";
    double tolerance = 1e-13;
    long max_iterations = 5000, max_outer_iterations = 50;

    bool consistent() const { return mass == "consistent"; }
    bool keeps_volumes() const { return volumes == "kept"; }
    bool newton() const { return solver == "newton_krylov"; }
};

}  // namespace mpm_implicit
