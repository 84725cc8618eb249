// The parameters of cic: names, units, ranges and meanings.
#pragma once

#include <string>
#include <vector>

#include "cic/theory/comparisons.hpp"

namespace cic {

namespace detail {

inline void describe_species(common::ParameterTable& table, const std::string& prefix,
                             SpeciesCase& s) {
    using common::anything, common::above, common::at_least, common::between;
    const auto real = [&](const char* name, double& value, const char* unit, common::Range allowed,
                          const char* meaning) {
        table.real(prefix + "." + name, value, unit, allowed, meaning);
    };
    const auto choice = [&](const char* name, std::string& value,
                            const std::vector<std::string>& choices, const char* meaning) {
        table.choice(prefix + "." + name, value, choices, meaning);
    };
    const auto formula = [&](const char* name, common::Formula& value, const char* unit,
                             const char* meaning) {
        table.real(prefix + "." + name, value, unit, at_least(0), meaning);
    };
    formula("density", s.density, "n0",
            "number density, also a formula of x, z and r; of a point, the number itself");
    real("charge", s.charge, "e", anything(), "charge of one particle");
    real("mass", s.mass, "m", above(0), "mass of one particle");
    choice("motion", s.motion, {"mobile", "fixed"}, "fixed: a uniform background of charge");
    choice("profile", s.profile, {"uniform", "layer", "disk", "point"},
           "where the species is; layer: |z - center_z| < half_width; point: one cloud");
    real("center_x", s.center_x, "length", anything(), "of a disk or point");
    real("center_z", s.center_z, "length", anything(), "of a layer, disk or point");
    real("half_width", s.half_width, "length", at_least(0), "of a layer; radius of a disk");
    table.whole(prefix + ".particles_per_cell", s.particles_per_cell, "", between(1, 1e7),
                "simulation particles in each cell that the species fills");
    choice("loading", s.loading, {"quiet", "random", "lattice"},
           "evenly spread numbers, random ones, or a cold lattice");
    real("drift_x", s.drift_x, "velocity", anything(), "mean velocity along x");
    real("drift_y", s.drift_y, "velocity", anything(), "out of the plane; needs a field");
    real("drift_z", s.drift_z, "velocity", anything(), "along z");
    real("temperature_x", s.temperature_x, "m velocity^2", at_least(0), "temperature of v_x");
    real("temperature_y", s.temperature_y, "m velocity^2", at_least(0), "of v_y; needs a field");
    real("temperature_z", s.temperature_z, "m velocity^2", at_least(0), "of v_z");
    formula("distribution_x", s.distribution_x, "",
            "formula of v: the distribution of v_x less the drift, in any unit; 0: Maxwellian");
    formula("distribution_y", s.distribution_y, "", "of v_y; needs a field");
    formula("distribution_z", s.distribution_z, "", "of v_z");
    formula("distribution_across", s.distribution_across, "",
            "of the speed v across B, per area of the plane of velocities; without B, in (x, z)");
    real("distribution_max", s.distribution_max, "velocity", at_least(0),
         "distributions end at this speed");
    choice("start", s.start, {"drift", "ExB"}, "ExB: the drift is E x B/B^2 in the field at t = 0");
    table.whole(prefix + ".mode_x", s.mode_x, "", between(-2048, 2048),
                "perturbed wavelengths in length_x");
    table.whole(prefix + ".mode_z", s.mode_z, "", between(-2048, 2048), "in length_z");
    real("amplitude", s.amplitude, "density", between(-0.9, 0.9),
         "of the density in the perturbed mode, relative");
    real("ripple", s.ripple, "length", anything(),
         "displacement along z, ripple cos(k x), in two dimensions");
    choice("wave", s.wave, {"standing", "traveling"},
           "traveling: with the velocities of the wave of theory");
    real("emission", s.emission, "n0 velocity", at_least(0),
         "particles per area and time from a source wall");
    real("emission_temperature", s.emission_temperature, "m velocity^2", above(0),
         "of the half-Maxwellian that a source wall emits");
}

inline void describe_perturbation(common::ParameterTable& table, const std::string& prefix,
                                  PerturbationCase& p) {
    using common::between;
    table.text(prefix + ".species", p.species, "the name of the perturbed species");
    table.whole(prefix + ".mode_x", p.mode_x, "", between(-2048, 2048), "wavelengths in length_x");
    table.whole(prefix + ".mode_z", p.mode_z, "", between(-2048, 2048), "in length_z");
    table.real(prefix + ".amplitude", p.amplitude, "density", between(-0.9, 0.9),
               "of the density, relative");
    table.choice(prefix + ".wave", p.wave, {"standing", "traveling"},
                 "traveling: with the velocities of the wave of theory");
}

}  // namespace detail

/// The table of all parameters: names, units, ranges and meanings of the fields of a Case, which
/// hold the defaults.
inline common::ParameterTable describe(Case& parameters) {
    using common::anything, common::above, common::at_least, common::between;
    common::ParameterTable table;

    table.group("mesh: x, or the plane (x, z); nothing depends on y");
    table.whole("grid.dimensions", parameters.dimensions, "", between(1, 2),
                "1: nothing depends on z");
    table.whole("grid.cells_x", parameters.grid.x.cells, "", between(2, 16384), "cells along x");
    table.whole("grid.cells_z", parameters.grid.z.cells, "", between(1, 16384),
                "cells along z, in two dimensions");
    table.real("grid.length_x", parameters.grid.x.length, "length", above(0),
               "length of the box along x");
    table.real("grid.length_z", parameters.grid.z.length, "length", above(0),
               "along z, in two dimensions");
    table.choice("grid.boundary_x", parameters.boundary_x, {"periodic", "wall"}, "both ends of x");
    table.choice("grid.boundary_z", parameters.boundary_z, {"periodic", "wall"}, "both ends of z");

    table.group("walls, where a direction has them");
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string end = wall_names[k];
        table.choice("boundary." + end, parameters.walls[k].field, {"grounded", "floating"},
                     "held at a potential, or insulated and charged by what it absorbs");
        table.real("boundary.potential_" + end, parameters.walls[k].potential, "m velocity^2/e",
                   anything(), "of a grounded wall");
        table.choice(
            "boundary.particles_" + end, parameters.walls[k].particles,
            k == x_low ? std::vector<std::string>{"absorb", "reflect", "source"}
                       : std::vector<std::string>{"absorb", "reflect"},
            k == x_low ? "source: emits, and emits again what comes back" : "what becomes of them");
    }

    table.group("time");
    table.real("time.dt", parameters.dt, "1/omega_p", above(0), "time step");
    table.real("time.end", parameters.end, "1/omega_p", at_least(0), "length of the run");
    table.real("time.energy_limit", parameters.energy_limit, "", at_least(0),
               "periodic runs fail when the energy is this many times the initial; 0: never");

    table.group("method");
    table.choice("method.weighting", parameters.weighting, {"ngp", "cic", "tsc"},
                 "nearest grid point, cloud in cell, triangular cloud");
    table.choice("method.scheme", parameters.conserving, {"momentum", "energy"},
                 "what the gather conserves; energy: one order less, from the edges (Lewis)");
    table.choice("method.stencil", parameters.stencil, {"five_point", "nine_point"},
                 "Laplacian in two dimensions");
    table.real("gauss.sign", parameters.gauss_sign, "", between(-1, 1),
               "+1 for div E = rho; -1 for the law as the slide prints it");
    table.whole("method.sort_interval", parameters.sort_interval, "step", between(0, 1e9),
                "steps between sorts by row, in two dimensions; 0: never");

    table.group("plasma");
    table.real("plasma.B_x", parameters.B.x, "m omega_p/e", anything(),
               "uniform magnetic field along x");
    table.real("plasma.B_y", parameters.B.y, "m omega_p/e", anything(), "out of the plane");
    table.real("plasma.B_z", parameters.B.z, "m omega_p/e", anything(), "along z");
    table.whole("plasma.seed", parameters.seed, "", between(0, 1e9),
                "another number, another realization");
    table.list("species", parameters.species, detail::describe_species,
               "a species of the plasma, [species.<name>]");
    table.list("perturbation", parameters.perturbations, detail::describe_perturbation,
               "one more perturbed mode of a species, [perturbation.<name>]");
    table.list("constant", parameters.constants, common::describe_constant,
               "a name for a number, for formulas");

    table.group("comparison with theory");
    table.choice("theory.compare", parameters.compare, names_of_comparisons(),
                 "what the run is compared with; wave: the dispersion relation of its species");
    table.choice("theory.model", parameters.model, {"plasma", "mesh"},
                 "waves of the plasma, or of the plasma as mesh and time step see it");
    table.whole("theory.mode_x", parameters.mode_x, "", between(-2048, 2048),
                "followed wavelengths in length_x; with mode_z = 0 also 0: the fastest along x");
    table.whole("theory.mode_z", parameters.mode_z, "", between(-2048, 2048), "in length_z");
    table.real("theory.near", parameters.near, "omega_p", anything(),
               "of the roots that a search finds, the one of the nearest frequency; 0: the fastest "
               "growing");
    table.real("theory.growth_tolerance", parameters.growth_tolerance, "", between(0, 1),
               "of rates, sheath potentials and thermal noise, relative");
    table.real("theory.frequency_tolerance", parameters.frequency_tolerance, "", between(0, 1),
               "of frequencies, relative");

    table.group("output");
    table.whole("output.modes", parameters.modes, "", between(0, 512),
                "modes along x whose amplitudes are columns of the history");
    table.flag("output.spectrum", parameters.spectrum,
               "spectrum.dat: those modes against frequency");
    table.real("output.fields_interval", parameters.fields_interval, "1/omega_p", at_least(0),
               "time between fields files; 0: none");
    table.real("output.particles_interval", parameters.particles_interval, "1/omega_p", at_least(0),
               "time between particles files, velocities half a step before; 0: none");
    table.real("output.phase_interval", parameters.phase_interval, "1/omega_p", at_least(0),
               "time between files of f(x, v_x) and f(v_x); 0: none");
    table.whole("output.phase_bins_x", parameters.phase_bins_x, "", between(1, 4096),
                "bins along x");
    table.whole("output.phase_bins_v", parameters.phase_bins_v, "", between(2, 4096),
                "bins along v_x");
    table.real("output.phase_v_max", parameters.phase_v_max, "velocity", at_least(0),
               "bins reach from -v_max to v_max; 0: far enough for the start");
    table.flag("output.vtk", parameters.also.vtk, "also write .vti and .vtp for ParaView");
    table.flag("output.openpmd", parameters.also.openpmd, "also write .h5, HDF5 after openPMD");
    table.whole("output.checkpoint_steps", parameters.checkpoint_steps, "", between(0, 1e9),
                "steps between checkpoints; 0: only when stopped");

    // Columns of the history and the number of modes belong to the whole run.
    table.renamed({{"walls.", "boundary."}});
    table.may_change_on_restart({"time.end", "output.fields_interval", "output.particles_interval",
                                 "output.phase_interval", "output.vtk", "output.openpmd",
                                 "output.checkpoint_steps"});
    return table;
}

}  // namespace cic
