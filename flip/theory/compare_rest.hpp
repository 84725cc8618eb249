// Fluids that lie still: what moves all the same.
#pragma once

#include <limits>

#include "flip/theory/comparison.hpp"

namespace flip {

/// The largest speed and the largest kinetic energy that rest allows: of the slowest sound, and of the
/// weight of the fluid times the height of the mesh.
inline constexpr double largest_mach_at_rest = 1e-10, largest_kinetic_at_rest = 1e-8;

/// Needs fluids without velocity, of one pressure, or hydrostatic under gravity.
inline void validate_rest(const Case& parameters, const Refusal& refuse) {
    const bool falls = parameters.gravity_x != 0 || parameters.gravity_z != 0;
    refuse(parameters.trap != 0, " is for fluid without trap");
    refuse(
        (parameters.gravity_x != 0 && parameters.grid.x.periodic) ||
            (parameters.gravity_z != 0 && parameters.grid.z.periodic),
        " needs walls that hold the fluid, and it falls for ever along a periodic direction: set "
        "both its ends to \"slip\"");
    for (const Side side : all_sides)
        refuse(parameters.is(side, "open") || parameters.is(side, "inflow"),
               " needs ends that hold the fluid: set boundary.", side_names[side], " = \"slip\"");
    for (const RegionCase& r : parameters.regions) {
        refuse(r.gas.velocity_x != 0 || r.gas.velocity_z != 0 || r.flow != "uniform" || r.noise > 0,
               " needs fluid at rest, and region.", r.name, " moves");
        refuse(falls && !r.hydrostatic, " needs region.", r.name, ".hydrostatic = true");
        refuse(!falls && r.gas.pressure != parameters.regions.front().gas.pressure,
               " needs one pressure, and region.", r.name, " has ", r.gas.pressure);
    }
}

/// Warns of a tolerance that means nothing here.
inline void warn_of_rest(const Case& parameters, std::vector<std::string>& warnings) {
    warn(warnings, parameters.theory_tolerance != Case().theory_tolerance,
         "theory.tolerance = ", parameters.theory_tolerance,
         " means nothing to theory.compare = \"rest\", which allows ", largest_mach_at_rest,
         " of the sound speed, or under gravity a kinetic energy of ", largest_kinetic_at_rest,
         " m g h: take it out");
}

/// Largest speed and kinetic energy of the whole run.
inline void compare_rest(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    double sound = std::numeric_limits<double>::infinity();
    for (const RegionCase& r : parameters.regions)
        sound = std::min(sound, sound_speed_of(parameters, r));
    const double weight =
        run.totals.mass * std::hypot(parameters.gravity_x * parameters.grid.x.length,
                                     parameters.gravity_z * parameters.grid.z.length);
    const bool falls = weight > 0;
    run.hint(
        "something is out of balance: begin with pressures that balance across interfaces, put "
        "them between cells, and take ",
        run.flip_with(), "flip.density = \"particles\" for liquids",
        parameters.loading == "random" ? "; particles.loading = \"random\" puts more of them into "
                                         "some cells than into others: "
                                         "take \"lattice\""
                                       : "",
        run.program == "flip" && falls && parameters.transfer != "pic" &&
                parameters.transfer != "xpic"
            ? sentence("; particles gather within cells and fall with flip.transfer = \"",
                       parameters.transfer, "\": take \"xpic\" where that is what moves")
            : "");
    const double fastest = run.history.largest("largest_speed") / sound;
    if (!falls) {
        run.summary.result_at_most("largest_speed", fastest, "c", largest_mach_at_rest,
                                   "equal pressures balance; c of the slowest sound");
        return;
    }
    run.info("largest_speed", fastest, "c", "of the slowest sound");
    run.summary.result_at_most("kinetic_energy", run.history.largest("kinetic") / weight, "m g h",
                               largest_kinetic_at_rest, "the pressure balances gravity");
}

inline constexpr Comparison rest_comparison{.name = "rest",
                                            .validate = validate_rest,
                                            .warn = warn_of_rest,
                                            .compare = compare_rest,
                                            .axisymmetric = true};

}  // namespace flip
