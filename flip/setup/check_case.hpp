// What is refused before a run starts: combinations that cannot run, and what the program or the
// case would silently ignore.
#pragma once

#include <string>
#include <vector>

#include "flip/setup/check_fluid.hpp"
#include "flip/setup/describe_case.hpp"
#include "flip/setup/warn_of_case.hpp"

namespace flip {

namespace detail {

inline void refuse_methods(const Case& w, const std::string& program) {
    for (const IdleKey& key : keys_of_flip(w)) {
        const bool physics = key.name == "flip.viscosity" || key.name == "flip.pressure";
        refuse(program == "pic" && key.changed && physics, key.name, " = ", key.value,
               " is beyond pic: run the case with flip, or take it out");
        refuse(key.changed && !key.used, key.name, " = ", key.value, " needs ", key.needs);
    }
    for (std::size_t k = 0; k < 4; ++k)
        refuse(program == "pic" && w.ends[k].kind == "no_slip", "boundary.", end_names[k],
               " = \"no_slip\" needs viscosity: run the case with flip, or take \"slip\"");
    refuse(w.mass == "consistent" && w.implicit(),
           "flip.mass = \"consistent\" and flip.pressure = \"implicit\" do not go together: the "
           "implicit pressure divides by lumped masses; take \"lumped\" or \"explicit\"");
    refuse(w.mass == "consistent" && w.transfer != "flip",
           "flip.mass = \"consistent\" and flip.transfer = \"", w.transfer,
           "\" do not go together: the other transfers make up for what lumped masses lose; "
           "take \"lumped\", or \"flip\"");
    refuse(w.rezone_steps > 0 && w.transfer == "apic",
           "rezone.steps and flip.transfer = \"apic\" do not go together: a merged particle cannot "
           "keep the gradients of several; take \"flip\", or rezone.steps = 0");
    refuse(w.rezone_steps > 0 && w.max_particles < 2 * w.min_particles,
           "rezone.max_particles = ", w.max_particles,
           " is below twice rezone.min_particles = ", w.min_particles,
           ": cells would split and merge the same particles in turn; raise it");
}

}  // namespace detail

/// Refuses what a case says in vain.
/// in:     the case as it was read, before completed()
/// errors: InputError, one sentence
inline void reject_unused(const Case& w) {
    const Case d;
    const bool riemann = w.setup == "riemann",
               sides = !(w.left == d.left) || !(w.right == d.right) || w.interface != d.interface;
    refuse(riemann && !(w.regions.empty() && w.materials.empty()),
           "setup.kind = \"riemann\" makes its regions and materials from [left] and "
           "[right]: take out [region.*] and [material.*]");
    refuse(!riemann && sides, "[left], [right] and setup.interface need setup.kind = \"riemann\"");
}

/// Refuses what cannot run.
/// in:     a completed case; program, pic or flip
/// errors: InputError, one sentence with the numbers and the cure
inline void validate(const Case& w, const std::string& program) {
    refuse(w.regions.empty(),
           "there is no fluid: add a [region.<name>], or set setup.kind = \"riemann\"");
    const bool between = w.interface > w.grid.x.low && w.interface < w.grid.x.low + w.grid.x.length;
    refuse(w.setup == "riemann" && !between, "setup.interface = ", w.interface,
           " is not on the mesh, from ", w.grid.x.low, " to ", w.grid.x.high());
    detail::refuse_sizes(w);
    detail::refuse_ends(w);
    detail::refuse_materials(w);
    for (const RegionCase& r : w.regions) detail::refuse_region(w, r);
    detail::refuse_methods(w, program);
    detail::refuse_tension(w);
    detail::refuse_steps(w, scales_of(w, program));
    validate_comparison(w);
}

}  // namespace flip
