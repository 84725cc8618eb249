// What is refused before a run starts: combinations that cannot run, and what the program or the
// case would silently ignore.
#pragma once

#include <string>

#include "flip/setup/check_fluid.hpp"
#include "flip/setup/describe_case.hpp"
#include "flip/setup/warn_of_case.hpp"

namespace flip {

/// Refuses methods that the program does not have, and those that do not go together.
inline void refuse_methods(const Case& parameters, const std::string& program) {
    for (const FlipKey& key : keys_of_flip(parameters)) {
        const bool physics = key.name == "flip.viscosity" || key.name == "flip.pressure";
        refuse(program == "pic" && key.changed && physics, key.name, " = ", key.value,
               " is beyond pic: run the case with flip, or take it out");
        refuse(key.changed && !key.used, key.name, " = ", key.value, " needs ", key.needs);
    }
    for (std::size_t k = 0; k < 4; ++k)
        refuse(program == "pic" && parameters.boundaries[k].kind == "no_slip", "boundary.",
               side_names[k],
               " = \"no_slip\" needs viscosity: run the case with flip, or take \"slip\"");
    refuse(parameters.mass == "consistent" && parameters.implicit(),
           "flip.mass = \"consistent\" and flip.pressure = \"implicit\" do not go together: the "
           "implicit pressure divides by lumped masses; take \"lumped\" or \"explicit\"");
    refuse(parameters.mass == "consistent" && parameters.transfer != "flip",
           "flip.mass = \"consistent\" and flip.transfer = \"", parameters.transfer,
           "\" do not go together: the other transfers make up for what lumped masses lose; take "
           "\"lumped\", or \"flip\"");
    refuse(parameters.rezone_steps > 0 && parameters.transfer == "apic",
           "rezone.steps and flip.transfer = \"apic\" do not go together: a merged particle cannot "
           "keep the gradients of several; take \"flip\", or rezone.steps = 0");
    refuse(parameters.rezone_steps > 0 && parameters.max_particles < 2 * parameters.min_particles,
           "rezone.max_particles = ", parameters.max_particles,
           " is below twice rezone.min_particles = ", parameters.min_particles,
           ": cells would split and merge the same particles in turn; raise it");
}

/// Refuses what a case says in vain.
/// in:     the case as it was read, before completed()
/// errors: InputError, one sentence
inline void reject_unused(const Case& parameters) {
    const Case d;
    const bool riemann = parameters.setup == "riemann", sides = !(parameters.left == d.left) ||
                                                                !(parameters.right == d.right) ||
                                                                parameters.interface != d.interface;
    refuse(riemann && !(parameters.regions.empty() && parameters.materials.empty()),
           "setup.kind = \"riemann\" makes its regions and materials from [left] and [right]: take "
           "out [region.*] and [material.*]");
    const bool formulas = std::ranges::any_of(parameters.regions, &RegionCase::has_formula);
    refuse(!parameters.constants.empty() && !formulas,
           "[constant.*] needs a formula in a region: write one, or take it out");
    refuse(!riemann && sides, "[left], [right] and setup.interface need setup.kind = \"riemann\"");
}

/// Refuses what cannot run.
/// in:     a completed case; program, pic or flip
/// errors: InputError, one sentence with the numbers and the cure
inline void validate(const Case& parameters, const std::string& program) {
    common::require_formats(parameters.also);
    refuse(parameters.regions.empty() && parameters.setup == "riemann",
           "there is no fluid: left.density and right.density are 0; give one of them");
    refuse(parameters.regions.empty(),
           "there is no fluid: add a [region.<name>], or set setup.kind = \"riemann\"");
    const bool between = parameters.interface > parameters.grid.x.low &&
                         parameters.interface < parameters.grid.x.low + parameters.grid.x.length;
    refuse(parameters.setup == "riemann" && !between, "setup.interface = ", parameters.interface,
           " is not on the mesh, from ", parameters.grid.x.low, " to ", parameters.grid.x.high());
    refuse_sizes(parameters);
    refuse_boundaries(parameters);
    refuse_around_axis(parameters);
    refuse_swirl(parameters);
    refuse_materials(parameters, program);
    for (const RegionCase& r : parameters.regions) {
        refuse_region(parameters, r);
        refuse_unbalanced(parameters, r);
    }
    refuse_methods(parameters, program);
    refuse_tension(parameters);
    refuse_steps(parameters, scales_of(parameters, program));
    validate_comparison(parameters);
}

}  // namespace flip
