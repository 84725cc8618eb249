// What is looked at before a run starts: combinations that cannot run, and scales that mesh and
// time step do not resolve.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cic/compare_with_theory.hpp"

namespace cic {

using common::shown;

/// The scales of one species.
struct SpeciesScales {
    std::string name;
    double omega_p = 0, thermal_speed = 0, drift = 0, Omega_c = 0;
    double debye_length = 0;  // of this species alone; 0 for a cold one
    long particles = 0;
};

struct Scales {
    std::vector<SpeciesScales> species;
    double omega_p = 0;       // of all mobile species together
    double debye_length = 0;  // of all warm ones together; 0 when all are cold
    long steps = 0, particles = 0;
    double bytes = 0;  // memory that the run will take
};

inline Scales scales_of(const Case& w) {
    Scales s;
    double inverse_debye2 = 0;
    long components = w.dimensions + (w.magnetized() ? 3 : w.dimensions);
    for (const SpeciesCase& k : w.species) {
        if (!k.mobile()) continue;
        SpeciesScales scale;
        scale.name = k.name;
        const double omega2 = k.density * k.charge * k.charge / k.mass;
        scale.omega_p = std::sqrt(omega2);
        scale.thermal_speed =
            std::sqrt(std::max({k.temperature_x, k.temperature_y, k.temperature_z}) / k.mass);
        scale.drift = std::hypot(k.drift_x, k.drift_y, k.drift_z);
        scale.Omega_c = std::fabs(k.charge) * w.B.size() / k.mass;
        scale.debye_length = omega2 > 0 ? scale.thermal_speed / scale.omega_p : 0;
        scale.particles = particle_count(w, k);
        if (scale.debye_length > 0) inverse_debye2 += 1 / std::pow(scale.debye_length, 2);
        if (k.profile != "point") s.omega_p = std::hypot(s.omega_p, scale.omega_p);
        s.particles += scale.particles;
        s.species.push_back(scale);
    }
    s.debye_length = inverse_debye2 > 0 ? 1 / std::sqrt(inverse_debye2) : 0;
    s.steps = std::lround(w.end / w.dt);
    const double per_particle = static_cast<double>(components + 1) * sizeof(Real) + sizeof(int);
    s.bytes = per_particle * static_cast<double>(s.particles) +
              static_cast<double>(w.grid.size()) * (common::block_count + 8) * sizeof(double);
    return s;
}

namespace detail {

// One sentence for bad input.
inline void refuse(bool bad, const std::string& sentence) {
    if (bad) throw common::InputError(sentence);
}

inline void refuse_species(const Case& w, const SpeciesCase& s) {
    const std::string name = "species." + s.name;
    const bool plane = w.dimensions == 2;
    if (!s.mobile()) {
        refuse(s.profile != "uniform",
               name +
                   ": a fixed species is a uniform background: take out profile, or make it "
                   "mobile and heavy");
        refuse(s.amplitude != 0,
               name + ": a fixed species cannot be perturbed: take out amplitude");
        return;
    }
    refuse(!plane && (s.profile == "layer" || s.profile == "disk"),
           name + ".profile = \"" + s.profile + "\" needs grid.dimensions = 2");
    const bool sized = s.profile == "layer" || s.profile == "disk";
    refuse(sized && s.half_width == 0, name + ".half_width = 0: a " + s.profile + " needs a width");
    const double reach = s.half_width + std::fabs(s.ripple);
    refuse(s.profile == "layer" &&
               (s.center_z - reach < w.grid.z.low || s.center_z + reach > w.grid.z.high()),
           name + ": the layer reaches beyond the box, from z = " + shown(s.center_z - reach) +
               " to " + shown(s.center_z + reach) + " in a box from 0 to " +
               shown(w.grid.z.length));
    refuse(s.ripple != 0 && s.profile != "layer", name + ".ripple belongs to profile = \"layer\"");
    const double r = s.profile == "disk" ? s.half_width : 0;
    refuse((s.profile == "disk" || s.profile == "point") &&
               (s.center_x - r < w.grid.x.low || s.center_x + r > w.grid.x.high() ||
                (plane && (s.center_z - r < w.grid.z.low || s.center_z + r > w.grid.z.high()))),
           name + ": the " + s.profile + " reaches beyond the box: move " + name +
               ".center_x or center_z, or make it smaller");
    refuse(s.loading == "lattice" && sized,
           name + ".loading = \"lattice\" fills the whole box: take \"quiet\" for a " + s.profile);
    refuse(s.loading == "lattice" &&
               (s.temperature_x > 0 || s.temperature_y > 0 || s.temperature_z > 0),
           name + ".loading = \"lattice\" is for cold species: take \"quiet\"");
    const bool across = s.temperature_y != 0 || s.drift_y != 0;
    const bool along_z = s.temperature_z != 0 || s.drift_z != 0;
    refuse(!w.magnetized() && across,
           name +
               " has a velocity out of the plane, which nothing can see without a magnetic "
               "field: take out drift_y and temperature_y, or set plasma.B_x, B_y or B_z");
    refuse(!w.magnetized() && !plane && along_z,
           name +
               " has a velocity along z, which nothing can see in one dimension without a "
               "magnetic field: take out drift_z and temperature_z");
    refuse(s.start == "ExB" && !w.magnetized(),
           name + ".start = \"ExB\" needs a magnetic field: set plasma.B_x, B_y or B_z");
    if (s.amplitude != 0) {
        refuse(s.mode_x == 0 && (s.mode_z == 0 || !plane),
               name + ": the perturbed mode has no wave number: set mode_x" +
                   (plane ? " or mode_z" : ""));
        refuse(!plane && s.mode_z != 0, name + ".mode_z needs grid.dimensions = 2");
        refuse(2 * std::labs(s.mode_x) > w.grid.x.cells ||
                   2 * std::labs(s.mode_z) > w.grid.z.cells + (plane ? 0 : 1),
               name + ": mode (" + std::to_string(s.mode_x) + ", " + std::to_string(s.mode_z) +
                   ") has more than one wave length per two cells, the cut-off of the mesh: refine "
                   "it or lower the mode");
    }
    refuse(s.wave == "traveling" && s.amplitude != 0 && w.has_walls(),
           name + ".wave = \"traveling\" needs periodic boundaries");
    refuse(particle_count(w, s) < 1, name +
                                         " has no particle: raise particles_per_cell, or its "
                                         "half_width of " +
                                         shown(s.half_width));
    refuse(s.emission > 0 && !(w.boundary_x == "walls" && w.walls[x_low].particles == "source"),
           name +
               ".emission needs walls.particles_x_low = \"source\" and grid.boundary_x = "
               "\"walls\"");
}

inline void refuse_comparison(const Case& w) {
    const std::string compare = "theory.compare = \"" + w.compare + "\"";
    if (w.compare == "none") return;
    const auto with_profile = [&](const char* profile) {
        return std::count_if(w.species.begin(), w.species.end(),
                             [&](const SpeciesCase& s) { return s.profile == profile; });
    };
    const bool any_mobile = std::any_of(w.species.begin(), w.species.end(),
                                        [](const SpeciesCase& s) { return s.mobile(); });
    refuse(w.compare != "none" && w.end < 10 * w.dt,
           compare + " needs at least 10 steps: raise time.end above " + shown(10 * w.dt));
    if (w.compare == "wave") {
        refuse(!any_mobile, compare + " needs a mobile species");
        refuse(w.dimensions == 1 && w.mode_z != 0, "theory.mode_z needs grid.dimensions = 2");
        refuse(2 * std::labs(w.mode_x) > w.grid.x.cells ||
                   2 * std::labs(w.mode_z) > w.grid.z.cells + (w.dimensions == 1 ? 1 : 0),
               "the followed mode (" + std::to_string(w.mode_x) + ", " + std::to_string(w.mode_z) +
                   ") has more than one wave length per two cells, the cut-off of the mesh: refine "
                   "it or lower theory.mode_x and mode_z");
        refuse(w.has_walls(), compare + " needs periodic boundaries");
        for (const SpeciesCase& s : w.species) {
            refuse(s.mobile() && s.profile != "uniform",
                   compare + " needs uniform species, and '" + s.name + "' is a " + s.profile);
            refuse(w.magnetized() && s.mobile() &&
                       (s.temperature_x > 0 || s.temperature_y > 0 || s.temperature_z > 0 ||
                        s.drift_x != 0 || s.drift_y != 0 || s.drift_z != 0),
                   compare + " with a magnetic field is for cold species at rest, and '" + s.name +
                       "' is warm or drifts: set theory.compare = \"none\"");
        }
        refuse(w.model == "mesh" && w.mode_x != 0 && w.mode_z != 0,
               "theory.model = \"mesh\" needs a mode along x or along z");
        refuse(w.model == "mesh" && (w.magnetized() || w.gauss_sign < 0),
               "theory.model = \"mesh\" has neither a magnetic field nor gauss.sign = -1: take "
               "\"plasma\"");
    } else if (w.compare == "diocotron") {
        refuse(with_profile("layer") != 1 || w.boundary_z != "walls" || w.boundary_x == "walls" ||
                   w.B.y == 0,
               compare +
                   " needs one species with profile = \"layer\", plasma.B_y, and walls in z "
                   "only");
        refuse(w.mode_x == 0, compare + " follows theory.mode_x, which is 0");
    } else if (w.compare == "sheath") {
        refuse(w.dimensions != 1 || w.boundary_x != "walls" ||
                   w.walls[x_low].particles != "source" || w.walls[x_low].field != "floating" ||
                   w.walls[x_high].particles != "absorb" || w.walls[x_high].field != "floating",
               compare +
                   " needs grid.dimensions = 1, a floating source at x_low and a floating, "
                   "absorbing wall at x_high");
        refuse(w.species.size() != 2 || !w.species[0].mobile() || !w.species[1].mobile() ||
                   w.species[0].emission != w.species[1].emission ||
                   w.species[0].charge * w.species[1].charge >= 0 || w.species[0].emission == 0,
               compare + " needs two mobile species of opposite charge with the same emission");
    } else if (w.compare == "clouds") {
        refuse(w.species.size() != 2 || with_profile("point") != 2 || w.dimensions != 2 ||
                   w.has_walls() || w.magnetized() || w.conserving != "momentum" ||
                   w.stencil != "five_point",
               compare +
                   " needs two species with profile = \"point\" in a periodic plane, the "
                   "momentum scheme and the five-point stencil, and no magnetic field");
    } else if (w.compare == "heating") {
        refuse(!any_mobile || w.has_walls() || w.dimensions != 1 || scales_of(w).debye_length == 0,
               compare + " needs a warm plasma in one periodic dimension");
    }
}

}  // namespace detail

/// Refuses what cannot run. errors: InputError, one sentence with the numbers and the cure.
/// in/out: the mesh of the case gets its boundaries; in one dimension one cell of height 1.
inline void refuse_impossible(Case& w) {
    using detail::refuse;
    w.grid.x.periodic = w.boundary_x == "periodic";
    w.grid.z.periodic = w.boundary_z == "periodic";
    if (w.dimensions == 1) {
        refuse(w.boundary_z == "walls", "grid.boundary_z = \"walls\" needs grid.dimensions = 2");
        refuse(w.grid.z.cells != 1,
               "grid.cells_z = " + std::to_string(w.grid.z.cells) + " needs grid.dimensions = 2");
        w.grid.z.length = 1;
    } else {
        refuse(w.grid.z.cells < 2, "grid.dimensions = 2 needs grid.cells_z of at least 2");
    }
    refuse(w.end / w.dt > 1e9, "time.end / time.dt is " + shown(w.end / w.dt) +
                                   " steps, more than 1e9: raise time.dt or lower time.end");
    refuse(w.gauss_sign != 1 && w.gauss_sign != -1,
           "gauss.sign = " + shown(w.gauss_sign) + " is neither 1 nor -1");
    refuse(w.weighting == "ngp" && w.conserving == "energy",
           "method.scheme = \"energy\" gathers with one order less than it deposits, and there is "
           "none below method.weighting = \"ngp\": take \"cic\" or \"tsc\"");
    refuse(w.species.empty(), "there is no plasma: add a [species.<name>]");
    for (const SpeciesCase& s : w.species) detail::refuse_species(w, s);
    const bool has_mobile = std::any_of(w.species.begin(), w.species.end(),
                                        [](const SpeciesCase& s) { return s.mobile(); });
    refuse(!has_mobile, "every species is fixed, so nothing can happen: make one mobile");

    const auto mixed = [&](std::size_t low) {
        return w.walls[low].field == "floating" || w.walls[low + 1].field == "floating";
    };
    const bool box = w.boundary_x == "walls" && w.boundary_z == "walls";
    refuse(box && (mixed(x_low) || mixed(z_low)),
           "floating walls that meet grounded ones at a corner are not supported: make all walls "
           "grounded, or one direction periodic");
    refuse(box && (w.grid.x.cells < 3 || w.grid.z.cells < 3), "a box needs at least 3 x 3 cells");

    // Nothing but walls can carry the opposite charge.
    double total = 0, size = 0;
    for (const SpeciesCase& s : w.species) {
        const double volume = s.mobile() ? filled_volume(w, s) : w.grid.x.length * w.grid.z.length;
        total += s.charge * s.density * volume;
        size += std::fabs(s.charge) * s.density * volume;
    }
    const auto closed = [&](const std::string& boundary, std::size_t low) {
        return boundary == "periodic" ||
               (w.walls[low].field == "floating" && w.walls[low + 1].field == "floating");
    };
    const bool must_be_neutral =
        closed(w.boundary_x, x_low) && closed(w.boundary_z, z_low) && size > 0;
    refuse(must_be_neutral && std::fabs(total) > 1e-9 * size,
           "the plasma is not neutral: its charge is " + shown(total) + ", " +
               shown(100 * total / size) +
               " % of the sum of all charges, and there is no grounded wall to carry the opposite: "
               "change a density, or add a fixed species with density " +
               shown(std::fabs(total) / (w.grid.x.length * w.grid.z.length)) + " and charge " +
               (total > 0 ? "-1" : "1"));
    const Scales scales = scales_of(w);
    refuse(scales.particles < 2, "the case has " + std::to_string(scales.particles) +
                                     " particle, and alone it only feels itself: raise "
                                     "particles_per_cell");
    refuse(static_cast<double>(scales.particles) > 2e9,
           shown(static_cast<double>(scales.particles)) +
               " particles are more than 2e9: lower particles_per_cell");
    const double fastest = scales.omega_p * w.dt;
    refuse(w.gauss_sign > 0 && fastest >= 2,
           "omega_p dt = " + shown(fastest) +
               " is not below 2, where the leapfrog blows up: lower time.dt below " +
               shown(2 / scales.omega_p));
    refuse((w.modes > 0 && 2 * w.modes > w.grid.x.cells),
           "output.modes = " + std::to_string(w.modes) + " is above the cut-off of the mesh, " +
               std::to_string(w.grid.x.cells / 2) + " modes: lower it or refine the mesh");
    refuse(w.modes > 0 && w.boundary_x == "walls", "output.modes needs periodic x");
    refuse(w.spectrum && w.modes == 0, "output.spectrum needs output.modes");
    detail::refuse_comparison(w);
}

/// Warnings with the number and the limit, for choices that run but may mislead.
inline std::vector<std::string> resolution_warnings(const Case& w, const Scales& scales) {
    std::vector<std::string> warnings;
    const double dx =
        w.dimensions == 2 ? std::max(w.grid.x.spacing(), w.grid.z.spacing()) : w.grid.x.spacing();
    const double omega_dt = scales.omega_p * w.dt;
    if (omega_dt > 0.5 && w.gauss_sign > 0)
        warnings.push_back("omega_p dt = " + shown(omega_dt) + " is above 0.5: frequencies are " +
                           shown(100 * (2 / omega_dt * std::asin(0.5 * omega_dt) - 1)) +
                           " % too high; at 2 the leapfrog blows up");
    // Where each kind of weighting stops heating.
    const double least = w.weighting == "ngp" ? 0.6 : (w.weighting == "cic" ? 1 / pi : 0.15);
    if (w.conserving == "momentum" && scales.debye_length > 0 && scales.debye_length < least * dx)
        warnings.push_back("the Debye length is " + shown(scales.debye_length / dx) +
                           " cells, below " + shown(least) + " for " + w.weighting +
                           ": the mesh will heat the plasma; refine it to " +
                           shown(scales.debye_length / least) + " per cell");
    for (const SpeciesScales& s : scales.species) {
        if (s.thermal_speed == 0 && s.drift > 0 && scales.omega_p > 0 && w.compare != "clouds") {
            const double u = s.drift / (scales.omega_p * dx);
            const double safe = w.weighting == "tsc" ? 1 / std::sqrt(30.0) : 1 / std::sqrt(12.0);
            if (w.conserving == "energy" && u < safe)
                warnings.push_back(s.name + ": a cold beam at " + shown(u) +
                                   " omega_p dx is below " + shown(safe) +
                                   ", where the energy-conserving mesh stops it; refine the mesh");
        }
        if (s.drift + s.thermal_speed > 2 * dx / w.dt)
            warnings.push_back(s.name + ": particles move " +
                               shown((s.drift + s.thermal_speed) * w.dt / dx) +
                               " cells in a step; below 2 they see the field they cross");
        if (s.Omega_c * w.dt > 1)
            warnings.push_back(s.name + ": Omega_c dt = " + shown(s.Omega_c * w.dt) +
                               " is above 1: gyration is slowed by the time step to " +
                               shown(std::atan(0.5 * s.Omega_c * w.dt) / (0.5 * s.Omega_c * w.dt)) +
                               " of its frequency; drifts stay right");
    }
    return warnings;
}

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& w, const Scales& scales) {
    const double dx = w.grid.x.spacing();
    std::string text;
    const auto line = [&](const std::string& name, const std::string& value) {
        text +=
            "  " + name + std::string(name.size() < 34 ? 34 - name.size() : 1, ' ') + value + "\n";
    };
    std::string mesh = std::to_string(w.grid.x.cells) + " cells of " + shown(dx);
    if (w.dimensions == 2)
        mesh = std::to_string(w.grid.x.cells) + " x " + std::to_string(w.grid.z.cells) +
               " cells of " + shown(dx) + " x " + shown(w.grid.z.spacing());
    line("mesh", mesh + ", " + w.boundary_x + " in x" +
                     (w.dimensions == 2 ? ", " + w.boundary_z + " in z" : ""));
    line("method", w.weighting + " weighting, " + w.conserving + "-conserving" +
                       (w.gauss_sign < 0 ? ", div E = -rho as the slide prints it" : ""));
    line("steps", std::to_string(scales.steps) + " of " + shown(w.dt));
    line("particles", std::to_string(scales.particles));
    line("unit of frequency", "omega_p of density 1, charge 1, mass 1");
    line("all mobile species together",
         "omega_p = " + shown(scales.omega_p) + ", omega_p dt = " + shown(scales.omega_p * w.dt) +
             (scales.debye_length > 0 ? ", Debye length = " + shown(scales.debye_length) + " = " +
                                            shown(scales.debye_length / dx) + " dx"
                                      : ", cold"));
    for (const SpeciesScales& s : scales.species)
        line(s.name, std::to_string(s.particles) + " particles, omega_p = " + shown(s.omega_p) +
                         ", v_th = " + shown(s.thermal_speed) + ", drift = " + shown(s.drift) +
                         (s.Omega_c > 0 ? ", Omega_c = " + shown(s.Omega_c) : ""));
    if (w.compare == "wave") {
        const Theory theory = theory_of_wave(w);
        const double growth = theory.omega.imag();
        line("theory", "mode (" + std::to_string(theory.mode_x) + ", " +
                           std::to_string(theory.mode_z) +
                           "): omega = " + shown(theory.omega.real()) +
                           ", growth = " + shown(growth) + " omega_p; " + theory.source);
        const double onset = predicted_onset(w, theory);
        if (onset > 0) line("onset", "about t = " + shown(onset) + ": " + onset_meaning());
    }
    line("memory", "about " + shown(scales.bytes / 1048576) + " MiB");
    const double work =
        static_cast<double>(scales.steps) *
        (static_cast<double>(scales.particles) + 30.0 * static_cast<double>(w.grid.size()));
    line("time", "about " + shown(work / 80e6) + " s on one core");
    return text;
}

}  // namespace cic
