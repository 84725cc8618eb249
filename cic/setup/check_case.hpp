// What is refused before a run starts: combinations that cannot run.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "cic/setup/check_species.hpp"
#include "cic/setup/read_formulas.hpp"
#include "cic/setup/scales.hpp"
#include "cic/theory/comparisons.hpp"

namespace cic {

/// Refuses what cannot run. errors: InputError, one sentence with the numbers and the cure.
/// in/out: the mesh of the case gets its boundaries, in one dimension one cell of height 1, its
///         formulas their tables, and theory.mode_x = 0 the mode that it stands for.
inline void validate(Case& parameters) {
    common::require_formats(parameters.also);
    refuse(common::rank_count() > common::block_count, common::rank_count(),
           " ranks, and the particles are in ", common::block_count,
           " blocks, of which each rank needs one: start fewer");
    Grid& grid = parameters.grid;
    grid.x.periodic = parameters.boundary_x == "periodic";
    grid.z.periodic = parameters.boundary_z == "periodic";
    if (parameters.dimensions == 1) {
        refuse(parameters.boundary_z == "wall",
               "grid.boundary_z = \"wall\" needs grid.dimensions = 2");
        refuse(grid.z.cells != 1, "grid.cells_z = ", grid.z.cells, " needs grid.dimensions = 2");
        grid.z.length = 1;
    } else {
        refuse(grid.z.cells < 2, "grid.dimensions = 2 needs grid.cells_z of at least 2");
    }
    refuse(parameters.end / parameters.dt > 1e9, "time.end / time.dt is ",
           parameters.end / parameters.dt,
           " steps, more than 1e9: raise time.dt or lower time.end");
    refuse(parameters.gauss_sign != 1 && parameters.gauss_sign != -1,
           "gauss.sign = ", parameters.gauss_sign, " is neither 1 nor -1");
    refuse(parameters.weighting == "ngp" && parameters.conserving == "energy",
           "method.scheme = \"energy\" gathers with one order less than it deposits, and there is "
           "none below method.weighting = \"ngp\": take \"cic\" or \"tsc\"");
    refuse(parameters.stencil == "nine_point" && parameters.dimensions == 1,
           "method.stencil = \"nine_point\" needs grid.dimensions = 2");
    refuse_walls(parameters);
    refuse(parameters.species.empty(), "there is no plasma: add a [species.<name>]");
    read_formulas(parameters);
    for (const SpeciesCase& s : parameters.species) refuse_species(parameters, s);
    refuse_unused(parameters);
    refuse(std::ranges::none_of(parameters.species, &SpeciesCase::mobile),
           "every species is fixed, so nothing can happen: make one mobile");

    const auto mixed = [&](std::size_t low) {
        return parameters.walls[low].field == "floating" ||
               parameters.walls[low + 1].field == "floating";
    };
    const bool box = parameters.is_box();
    refuse(box && (mixed(x_low) || mixed(z_low)),
           "a floating wall that meets others at the corners of a box is not supported: make all "
           "walls grounded, or one direction periodic");
    refuse(box && (grid.x.cells < 3 || grid.z.cells < 3), "a box needs at least 3 x 3 cells");
    refuse(box && grid.x.cells * grid.z.cells > 4000000, "a box between four walls of ",
           grid.x.cells, " x ", grid.z.cells,
           " cells is more than the 4e6 whose matrix is factorized in minutes: take fewer, or make "
           "one direction periodic");

    // Nothing but walls can carry the opposite charge.
    double total = 0, size = 0;
    for (const SpeciesCase& s : parameters.species) {
        const double volume =
            s.mobile() ? filled_volume(parameters, s) : grid.x.length * grid.z.length;
        total += s.charge * s.mean_density() * volume;
        size += std::fabs(s.charge) * s.mean_density() * volume;
    }
    const auto closed = [&](const std::string& boundary, std::size_t low) {
        return boundary == "periodic" || (parameters.walls[low].field == "floating" &&
                                          parameters.walls[low + 1].field == "floating");
    };
    const bool must_be_neutral =
        closed(parameters.boundary_x, x_low) && closed(parameters.boundary_z, z_low) && size > 0;
    if (must_be_neutral)
        refuse(std::fabs(total) > 1e-9 * size, "the plasma is not neutral: its charge is ", total,
               ", ", 100 * total / size,
               " % of the sum of all charges, and there is no grounded wall to carry the opposite: "
               "change a density, or add a fixed species with density ",
               common::number_text(std::fabs(total) / (grid.x.length * grid.z.length)),
               " and charge ", (total > 0 ? "-1" : "1"));
    const Scales scales = scales_of(parameters);
    refuse(scales.particles < 2 && !parameters.has_walls() && !parameters.magnetized(),
           "the case has ", scales.particles,
           " particle, and alone it only feels itself: raise particles_per_cell, or add a species");
    refuse(scales.most > 2e9, scales.most,
           scales.most > double(scales.particles)
               ? " particles, with those that the source wall emits, are more than 2e9: lower "
                 "emission or particles_per_cell, or raise density, which makes them heavier"
               : " particles are more than 2e9: lower particles_per_cell");
    const double length =
        parameters.dimensions == 2 ? std::max(grid.x.length, grid.z.length) : grid.x.length;
    for (const SpeciesScales& s : scales.species) {
        const double speed = s.drift + s.thermal_speed;
        if (speed > 0)
            refuse(speed * parameters.dt > length, "species.", s.name, ": particles move ",
                   speed * parameters.dt / length,
                   " times the length of the box in one step: lower time.dt below ",
                   length / speed);
    }
    const double fastest = scales.largest_omega_p * parameters.dt;
    if (parameters.gauss_sign > 0 && fastest > 0)
        refuse(fastest >= 2, "omega_p dt = ", fastest, where_densest(scales),
               " is not below 2, where the leapfrog blows up: lower time.dt below ",
               2 / scales.largest_omega_p);
    refuse(parameters.dimensions == 1 && parameters.mode_z != 0,
           "theory.mode_z needs grid.dimensions = 2");
    refuse(is_above_cut_off(parameters, parameters.mode_x, parameters.mode_z), "the followed ",
           mode_text(parameters.mode_x, parameters.mode_z),
           " has more than one wavelength per two cells, the cut-off of the mesh: refine it or "
           "lower theory.mode_x and mode_z");
    refuse(parameters.modes > 0 && 2 * parameters.modes > grid.x.cells,
           "output.modes = ", parameters.modes, " is above the cut-off of the mesh, ",
           grid.x.cells / 2, " modes: lower it or refine the mesh");
    refuse(parameters.modes > 0 && parameters.boundary_x == "wall",
           "output.modes needs periodic x");
    refuse(parameters.spectrum && parameters.modes == 0, "output.spectrum needs output.modes");
    refuse(parameters.spectrum && scales.steps < 8,
           "output.spectrum needs at least 8 steps, and there are ", scales.steps,
           ": raise time.end above ", 8 * parameters.dt);
    for (const SpeciesCase& s : parameters.species)
        for (const PerturbationCase& p : perturbations_of(parameters, s)) {
            if (p.wave != "traveling") continue;
            refuse(parameters.magnetized(), p.name,
                   ".wave = \"traveling\" is for waves without a magnetic field, whose velocities "
                   "are along them: take \"standing\"");
            refuse_wave(parameters, p.name + ".wave = \"traveling\"", p.mode_x, p.mode_z);
            theory_of_wave(parameters, p.mode_x, p.mode_z);  // throws where there is no such wave
        }
    validate_comparison(parameters);
    const bool follows = comparison_of(parameters).follows_mode;
    if (follows && parameters.mode_x == 0 && parameters.mode_z == 0)
        parameters.fastest_x = comparison_of(parameters).recorded_mode_x(parameters);
}

}  // namespace cic
