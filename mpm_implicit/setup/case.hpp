// Everything a case file of mpm_implicit can say: what both programs of the material point method
// have in common (mpm_explicit/setup/case.hpp), and the theta scheme with its solvers.
#pragma once

#include <string>
#include <vector>

#include "mpm_explicit/setup/case.hpp"
#include "mpm_implicit/theta_scheme.hpp"

namespace mpm_implicit {

using namespace mpm;

/// The table of all parameters.
/// in: comparison_names, the choices of theory.compare
inline common::ParameterTable describe(Case& parameters, ThetaScheme& scheme,
                                       const std::vector<std::string>& comparison_names) {
    using common::between;
    common::ParameterTable table;
    parameters.alpha = 1;
    describe_case(table, parameters);
    table.real("method.theta", scheme.theta, "", between(0.5, 1),
               "level of velocities, stresses and contact: 1/2 keeps energy, 1 damps most");
    table.choice("method.mass", scheme.mass, {"consistent", "lumped"},
                 "mass matrix; lumped loses energy at every theta");
    table.choice("method.volumes", scheme.volumes, {"kept", "updated"},
                 "volumes in force and energy: those of the start, or [MPM-6]");
    table.group("solver");
    table.choice("solver.kind", scheme.solver, {"projected_cg", "newton_krylov"},
                 "of a step; plastic grains and updated volumes need newton_krylov");
    table.choice("solver.preconditioner", scheme.preconditioner, {"grains", "diagonal"},
                 "for v^theta: each grain factorized, or the diagonal");
    table.real("solver.tolerance", scheme.tolerance, "", between(1e-15, 1e-3),
               "on the residual, relative");
    table.whole("solver.max_iterations", scheme.max_iterations, "", between(1, 1e6),
                "of a linear system; beyond, the run fails");
    table.whole("solver.max_outer_iterations", scheme.max_outer_iterations, "", between(1, 1000),
                "active sets tried, or Newton steps; beyond, the run fails");
    describe_output(table, parameters, comparison_names);
    return table;
}

}  // namespace mpm_implicit
