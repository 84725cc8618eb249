// What is refused of walls and of one species, before a run starts.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "cic/setup/initial_state.hpp"

namespace cic {

/// Whether a mode has more than one wavelength per two cells.
inline bool is_above_cut_off(const Case& parameters, long mode_x, long mode_z) {
    return 2 * std::labs(mode_x) > parameters.grid.x.cells ||
           (parameters.dimensions == 2 && 2 * std::labs(mode_z) > parameters.grid.z.cells);
}

/// Refuses walls that are not there, or cannot be what they are asked to be.
inline void refuse_walls(const Case& parameters) {
    for (std::size_t k = 0; k < 4; ++k) {
        const WallCase& wall = parameters.walls[k];
        const std::string end = wall_names[k], direction = end.substr(0, 1);
        const bool there = (k <= x_high ? parameters.boundary_x : parameters.boundary_z) == "wall";
        refuse(!there &&
                   (wall.field != "grounded" || wall.particles != "absorb" || wall.potential != 0),
               "there is no wall at ", end, ": set grid.boundary_", direction,
               " = \"wall\", or take out boundary.", end, ", boundary.potential_", end,
               " and boundary.particles_", end);
        refuse(wall.field == "floating" && wall.potential != 0, "boundary.potential_", end, " = ",
               wall.potential,
               " belongs to a grounded wall; the charge of a floating one finds its own: take it "
               "out, or set boundary.",
               end, " = \"grounded\"");
        refuse(wall.field == "floating" && parameters.gauss_sign < 0,
               "gauss.sign = -1 is not for floating walls: set boundary.", end, " = \"grounded\"");
    }
}

/// Refuses formulas of a species that say the same twice, or what it cannot have.
inline void refuse_formulas(const Case& parameters, const SpeciesCase& s) {
    const std::string name = "species." + s.name;
    refuse(!s.density.is_number() && (s.profile != "uniform" || s.loading == "lattice"), name,
           ".density is a formula: it needs profile = \"uniform\" and loading = \"quiet\" or "
           "\"random\"");
    refuse(s.distribution_max != 0 && !s.has_distribution(), name,
           ".distribution_max ends a distribution by formula, and there is none: write "
           "distribution_x, y, z or across, or take it out");
    refuse(s.loading == "lattice" && s.has_distribution(), name,
           ".loading = \"lattice\" is for cold species: take \"quiet\"");
    const std::array<double, 3> T{s.temperature_x, s.temperature_y, s.temperature_z};
    for (std::size_t a = 0; a < 3; ++a) {
        const std::string direction(1, "xyz"[a]);
        refuse(s.tables.v[a].given() && T[a] != 0, name, ".distribution_", direction,
               " has a temperature of its own: take out temperature_", direction);
        refuse(s.tables.speed.given() && a != parameters.axis() &&
                   (s.tables.v[a].given() || T[a] != 0),
               name, ".distribution_across is also of the velocity along ", direction,
               ": take out temperature_", direction, " and distribution_", direction);
    }
    const double along =
        std::max({std::fabs(parameters.B.x), std::fabs(parameters.B.y), std::fabs(parameters.B.z)});
    refuse(s.tables.speed.given() && along < parameters.B.size(), name,
           ".distribution_across needs a magnetic field along x, y or z, or none");
}

/// Refuses constants and perturbations that belong to nothing.
inline void refuse_unused(const Case& parameters) {
    bool formulas = false;
    for (const SpeciesCase& s : parameters.species)
        formulas = formulas || !s.density.is_number() || s.has_distribution();
    refuse(!parameters.constants.empty() && !formulas,
           "[constant.*] needs a formula in a species: write one, or take it out");
    for (const PerturbationCase& p : parameters.perturbations) {
        const auto of = std::ranges::find(parameters.species, p.species, &SpeciesCase::name);
        refuse(of == parameters.species.end(), "perturbation.", p.name, ".species = \"", p.species,
               "\" is the name of no species: write one of [species.<name>]");
        refuse(p.amplitude == 0, "perturbation.", p.name,
               ".amplitude = 0 perturbs nothing: set it, or take the perturbation out");
    }
}

/// Refuses a species that cannot be loaded, moved or emitted.
inline void refuse_species(const Case& parameters, const SpeciesCase& s) {
    const std::string name = "species." + s.name;
    const bool plane = parameters.dimensions == 2;
    const Grid& grid = parameters.grid;
    if (!s.mobile()) {
        refuse(s.profile != "uniform", name,
               ": a fixed species is a uniform background: take out profile, or make it mobile and "
               "heavy");
        const bool moves = !s.at_rest() || s.temperature_x != 0 || s.temperature_y != 0 ||
                           s.temperature_z != 0 || s.has_distribution();
        const bool perturbed = !perturbations_of(parameters, s).empty() || s.ripple != 0;
        refuse(moves || perturbed || s.emission != 0, name,
               ": a fixed species stays as it is: take out drift, temperature, distribution, "
               "amplitude, perturbation, ripple and emission, or make it mobile");
        refuse(!s.density.is_number(), name,
               ".density: a fixed species is a uniform background: write a number, or make it "
               "mobile and heavy");
        return;
    }
    refuse(s.mean_density() == 0, name,
           ".density = 0 leaves its particles without charge and mass: raise it, or take the "
           "species out");
    refuse(!plane && (s.profile == "layer" || s.profile == "disk"), name, ".profile = \"",
           s.profile, "\" needs grid.dimensions = 2");
    const bool sized = s.profile == "layer" || s.profile == "disk";
    refuse(sized && s.half_width == 0, name, ".half_width = 0: a ", s.profile, " needs a width");
    const double reach = s.half_width + std::fabs(s.ripple);
    refuse(s.profile == "layer" &&
               (s.center_z - reach < grid.z.low || s.center_z + reach > grid.z.high()),
           name, ": the layer reaches beyond the box, from z = ", s.center_z - reach, " to ",
           s.center_z + reach, " in a box from 0 to ", grid.z.length);
    refuse(s.ripple != 0 && s.profile != "layer", name, ".ripple belongs to profile = \"layer\"");
    const double r = s.profile == "disk" ? s.half_width : 0;
    refuse((s.profile == "disk" || s.profile == "point") &&
               (s.center_x - r < grid.x.low || s.center_x + r > grid.x.high() ||
                (plane && (s.center_z - r < grid.z.low || s.center_z + r > grid.z.high()))),
           name, ": the ", s.profile, " reaches beyond the box: move ", name,
           ".center_x or center_z, or make it smaller");
    refuse(s.loading == "lattice" && sized, name,
           ".loading = \"lattice\" fills the whole box: take \"quiet\" for a ", s.profile);
    refuse(s.loading == "lattice" &&
               (s.temperature_x > 0 || s.temperature_y > 0 || s.temperature_z > 0),
           name, ".loading = \"lattice\" is for cold species: take \"quiet\"");
    refuse_formulas(parameters, s);
    const bool across = s.temperature_y != 0 || s.drift_y != 0 || s.tables.v[1].given();
    const bool along_z =
        s.temperature_z != 0 || s.drift_z != 0 || s.tables.v[2].given() || s.tables.speed.given();
    refuse(!parameters.magnetized() && across, name,
           " has a velocity out of the plane, which nothing can see without a magnetic field: take "
           "out drift_y, temperature_y and distribution_y, or set plasma.B_x, B_y or B_z");
    refuse(!parameters.magnetized() && !plane && along_z, name,
           " has a velocity along z, which nothing can see in one dimension without a magnetic "
           "field: take out drift_z, temperature_z, distribution_z and distribution_across");
    refuse(s.start == "ExB" && !parameters.magnetized(), name,
           ".start = \"ExB\" needs a magnetic field: set plasma.B_x, B_y or B_z");
    refuse(s.start == "ExB" && !s.at_rest(), name,
           ".start = \"ExB\" replaces the drift: take out drift_x, drift_y and drift_z");
    const auto refuse_above_cut_off = [&](const std::string& where, long mode_x, long mode_z) {
        refuse(is_above_cut_off(parameters, mode_x, mode_z), where, ": ", mode_text(mode_x, mode_z),
               " has more than one wavelength per two cells, the cut-off of the mesh: refine it or "
               "lower the mode");
    };
    double amplitudes = 0;
    for (const PerturbationCase& p : perturbations_of(parameters, s)) {
        refuse(p.mode_x == 0 && (p.mode_z == 0 || !plane), p.name,
               ": the perturbed mode has no wave number: set mode_x", (plane ? " or mode_z" : ""));
        refuse(!plane && p.mode_z != 0, p.name, ".mode_z needs grid.dimensions = 2");
        refuse(parameters.has_walls() && p.mode_x != 0 && p.mode_z != 0, p.name, ": ",
               mode_text(p.mode_x, p.mode_z),
               " would push particles through the walls: set mode_x or mode_z to 0");
        refuse_above_cut_off(p.name, p.mode_x, p.mode_z);
        amplitudes += std::fabs(p.amplitude);
    }
    refuse(amplitudes > 0.9, name, ": the amplitudes of its perturbations have the sum ",
           amplitudes, ", above 0.9, where the density could vanish: lower them");
    refuse(s.ripple != 0 && s.mode_x == 0, name, ".ripple = ", s.ripple,
           " has no wave number: set mode_x");
    if (s.ripple != 0) refuse_above_cut_off(name, s.mode_x, s.mode_z);
    refuse(particle_count(parameters, s) < 1, name,
           " has no particle: raise particles_per_cell, or its half_width of ", s.half_width);
    refuse(s.emission > 0 &&
               !(parameters.boundary_x == "wall" && parameters.walls[x_low].particles == "source"),
           name,
           ".emission needs boundary.particles_x_low = \"source\" and grid.boundary_x = \"wall\"");
    if (parameters.walls[x_low].particles != "source") return;
    const double fastest = fastest_emitted * std::sqrt(s.emission_temperature / s.mass);
    refuse(fastest * parameters.dt > grid.x.length, name,
           ".emission_temperature = ", s.emission_temperature, ": a particle emitted with ",
           fastest, " crosses the whole box in one step: lower it, or time.dt below ",
           grid.x.length / fastest);
    const double emitted = emitted_per_step(parameters, s, particle_weight(parameters, s));
    refuse(emitted > 1e6, name, ".emission = ", s.emission, " is ", emitted,
           " particles in a step, more than 1e6: lower it, or raise density, which makes them "
           "heavier");
}

}  // namespace cic
