// What is refused before a run starts: combinations that cannot run, and comparisons that theory
// cannot answer.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cic/setup/check_species.hpp"
#include "cic/setup/scales.hpp"

namespace cic {

namespace detail {

// Where the dispersion relations of theory_of_case.hpp do not hold.
inline void refuse_wave(const Case& w, const std::string& what, long mode_x, long mode_z) {
    refuse(w.has_walls(), what + " needs periodic boundaries");
    for (const SpeciesCase& s : w.species) {
        if (!s.mobile()) continue;
        refuse(s.profile != "uniform",
               what + " needs uniform species, and '" + s.name + "' is a " + s.profile);
        const bool cold = s.temperature_x == 0 && s.temperature_y == 0 && s.temperature_z == 0;
        const bool at_rest = s.drift_x == 0 && s.drift_y == 0 && s.drift_z == 0;
        refuse(w.magnetized() && !(cold && at_rest),
               what + " with a magnetic field is for cold species at rest, and '" + s.name +
                   "' is warm or drifts: take out plasma.B_x, B_y and B_z, or set theory.compare = "
                   "\"none\" and waves to \"standing\"");
    }
    refuse(w.model == "mesh" && mode_x != 0 && mode_z != 0,
           "theory.model = \"mesh\" needs a mode along x or along z, and not " +
               mode_text(mode_x, mode_z));
    refuse(w.model == "mesh" && (w.magnetized() || w.gauss_sign < 0),
           "theory.model = \"mesh\" has neither a magnetic field nor gauss.sign = -1: take "
           "\"plasma\"");
    refuse(w.magnetized() && w.gauss_sign < 0,
           what + " with a magnetic field is for gauss.sign = 1");
}

inline void refuse_comparison(const Case& w) {
    const std::string compare = "theory.compare = \"" + w.compare + "\"";
    if (w.compare == "none") return;
    const auto with_profile = [&](const char* profile) {
        return std::count_if(w.species.begin(), w.species.end(),
                             [&](const SpeciesCase& s) { return s.profile == profile; });
    };
    refuse(w.end < 10 * w.dt,
           compare + " needs at least 10 steps: raise time.end above " + format(10 * w.dt));
    refuse(w.compare != "wave" && w.gauss_sign < 0, compare + " is for gauss.sign = 1");
    if (w.compare == "wave") {
        refuse_wave(w, compare, w.mode_x, w.mode_z);
        const bool search = w.mode_x == 0 && w.mode_z == 0;
        const long modes = (w.grid.x.cells - 1) / 2;
        refuse(search && (modes < 1 || modes > 512 || w.model == "mesh"),
               "theory.mode_x = 0 looks for the fastest growing of " + std::to_string(modes) +
                   " modes, and that is for 1 to 512 and theory.model = \"plasma\": name a mode");
    } else if (w.compare == "diocotron") {
        refuse(w.species.size() != 1 || with_profile("layer") != 1 || w.boundary_z != "wall" ||
                   w.boundary_x == "wall" || w.B.y == 0 || w.B.x != 0 || w.B.z != 0,
               compare +
                   " needs one species with profile = \"layer\" and no other, plasma.B_y alone, "
                   "and walls in z only");
        const SpeciesCase& layer = w.species[0];
        refuse(w.mode_x == 0 || w.mode_z != 0,
               compare + " follows theory.mode_x, and not " + mode_text(w.mode_x, w.mode_z));
        const WallCase &low = w.walls[z_low], &high = w.walls[z_high];
        refuse(low.field != "grounded" || high.field != "grounded" ||
                   low.potential != high.potential ||
                   std::fabs(layer.center_z - 0.5 * w.grid.z.length) > 1e-6 * w.grid.z.length,
               compare +
                   " needs grounded walls of the same potential, and the layer half-way between "
                   "them, at center_z = " +
                   format(0.5 * w.grid.z.length));
        refuse(diocotron_growth(w) == 0,
               compare + ": mode " + std::to_string(w.mode_x) + " of a layer of half_width " +
                   format(layer.half_width) + " and charge " + format(layer.charge) +
                   " does not grow: make it thinner, or change theory.mode_x");
    } else if (w.compare == "sheath") {
        refuse(w.dimensions != 1 || w.magnetized() || w.boundary_x != "wall" ||
                   w.walls[x_low].particles != "source" || w.walls[x_low].field != "floating" ||
                   w.walls[x_high].particles != "absorb" || w.walls[x_high].field != "floating",
               compare +
                   " needs grid.dimensions = 1, no magnetic field, a floating source at x_low and "
                   "a floating, absorbing wall at x_high");
        refuse(w.species.size() != 2 || !w.species[0].mobile() || !w.species[1].mobile() ||
                   w.species[0].emission != w.species[1].emission ||
                   w.species[0].charge != -w.species[1].charge || w.species[0].emission == 0,
               compare + " needs two mobile species of opposite charge with the same emission");
        const std::size_t electron = w.species[0].charge < 0 ? 0 : 1;
        const SpeciesCase &electrons = w.species[electron], &ions = w.species[1 - electron];
        // This throws where there is no sheath.
        collector_sheath(ions.mass / electrons.mass,
                         ions.emission_temperature / electrons.emission_temperature);
    } else if (w.compare == "clouds") {
        refuse(w.species.size() != 2 || with_profile("point") != 2 || w.dimensions != 2 ||
                   w.has_walls() || w.magnetized() || w.conserving != "momentum" ||
                   w.stencil != "five_point",
               compare +
                   " needs two species with profile = \"point\" in a periodic plane, the "
                   "momentum scheme and the five-point stencil, and no magnetic field");
        refuse(w.species[0].center_x == w.species[1].center_x,
               compare + " needs clouds apart along x, and both have center_x = " +
                   format(w.species[0].center_x));
    } else if (w.compare == "heating") {
        refuse(w.has_walls() || w.dimensions != 1,
               compare + " needs a warm plasma in one periodic dimension");
        for (const SpeciesCase& s : w.species)
            refuse(s.mobile() && (s.profile != "uniform" || s.charge == 0 || s.temperature_x == 0),
                   compare + " needs uniform, charged, warm species, and '" + s.name + "' has " +
                       "profile \"" + s.profile + "\", charge " + format(s.charge) +
                       " and temperature_x " + format(s.temperature_x));
    }
}

}  // namespace detail

/// Refuses what cannot run. errors: InputError, one sentence with the numbers and the cure.
/// in/out: the mesh of the case gets its boundaries; in one dimension one cell of height 1.
inline void validate(Case& w) {
    using detail::refuse;
    w.grid.x.periodic = w.boundary_x == "periodic";
    w.grid.z.periodic = w.boundary_z == "periodic";
    if (w.dimensions == 1) {
        refuse(w.boundary_z == "wall", "grid.boundary_z = \"wall\" needs grid.dimensions = 2");
        refuse(w.grid.z.cells != 1,
               "grid.cells_z = " + std::to_string(w.grid.z.cells) + " needs grid.dimensions = 2");
        w.grid.z.length = 1;
    } else {
        refuse(w.grid.z.cells < 2, "grid.dimensions = 2 needs grid.cells_z of at least 2");
    }
    refuse(w.end / w.dt > 1e9, "time.end / time.dt is " + format(w.end / w.dt) +
                                   " steps, more than 1e9: raise time.dt or lower time.end");
    const std::vector<std::pair<const char*, double>> numbers{
        {"grid.length_x", w.grid.x.length},
        {"grid.length_z", w.grid.z.length},
        {"time.dt", w.dt},
        {"plasma.B_x", w.B.x},
        {"plasma.B_y", w.B.y},
        {"plasma.B_z", w.B.z},
        {"output.phase_v_max", w.phase_v_max}};
    for (const auto& [name, value] : numbers) detail::refuse_extreme(name, value);
    refuse(w.gauss_sign != 1 && w.gauss_sign != -1,
           "gauss.sign = " + format(w.gauss_sign) + " is neither 1 nor -1");
    refuse(w.weighting == "ngp" && w.conserving == "energy",
           "method.scheme = \"energy\" gathers with one order less than it deposits, and there is "
           "none below method.weighting = \"ngp\": take \"cic\" or \"tsc\"");
    refuse(w.stencil == "nine_point" && w.dimensions == 1,
           "method.stencil = \"nine_point\" needs grid.dimensions = 2");
    detail::refuse_walls(w);
    refuse(w.species.empty(), "there is no plasma: add a [species.<name>]");
    for (const SpeciesCase& s : w.species) detail::refuse_species(w, s);
    const bool has_mobile = std::any_of(w.species.begin(), w.species.end(),
                                        [](const SpeciesCase& s) { return s.mobile(); });
    refuse(!has_mobile, "every species is fixed, so nothing can happen: make one mobile");

    const auto mixed = [&](std::size_t low) {
        return w.walls[low].field == "floating" || w.walls[low + 1].field == "floating";
    };
    const bool box = detail::is_box(w);
    refuse(box && (mixed(x_low) || mixed(z_low)),
           "floating walls that meet grounded ones at a corner are not supported: make all walls "
           "grounded, or one direction periodic");
    refuse(box && (w.grid.x.cells < 3 || w.grid.z.cells < 3), "a box needs at least 3 x 3 cells");
    refuse(box && w.grid.x.cells * w.grid.z.cells > 4000000,
           "a box between four walls of " + std::to_string(w.grid.x.cells) + " x " +
               std::to_string(w.grid.z.cells) +
               " cells is more than the 4e6 whose matrix is factorized in minutes: take fewer, or "
               "make one direction periodic");

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
    if (must_be_neutral)
        refuse(std::fabs(total) > 1e-9 * size,
               "the plasma is not neutral: its charge is " + format(total) + ", " +
                   format(100 * total / size) +
                   " % of the sum of all charges, and there is no grounded wall to carry the "
                   "opposite: "
                   "change a density, or add a fixed species with density " +
                   format(std::fabs(total) / (w.grid.x.length * w.grid.z.length)) + " and charge " +
                   (total > 0 ? "-1" : "1"));
    const Scales scales = scales_of(w);
    refuse(scales.particles < 2, "the case has " + std::to_string(scales.particles) +
                                     " particle, and alone it only feels itself: raise "
                                     "particles_per_cell");
    refuse(static_cast<double>(scales.particles) > 2e9,
           format(static_cast<double>(scales.particles)) +
               " particles are more than 2e9: lower particles_per_cell");
    const double length =
        w.dimensions == 2 ? std::max(w.grid.x.length, w.grid.z.length) : w.grid.x.length;
    for (const SpeciesScales& s : scales.species) {
        const double speed = s.drift + s.thermal_speed;
        if (speed > 0)
            refuse(speed * w.dt > length, "species." + s.name + ": particles move " +
                                              format(speed * w.dt / length) +
                                              " times the length of the box in one step: lower "
                                              "time.dt below " +
                                              format(length / speed));
    }
    const double fastest = scales.omega_p * w.dt;
    if (w.gauss_sign > 0 && fastest > 0)
        refuse(fastest >= 2,
               "omega_p dt = " + format(fastest) +
                   " is not below 2, where the leapfrog blows up: lower time.dt below " +
                   format(2 / scales.omega_p));
    refuse(w.dimensions == 1 && w.mode_z != 0, "theory.mode_z needs grid.dimensions = 2");
    refuse(detail::is_above_cut_off(w, w.mode_x, w.mode_z),
           "the followed " + mode_text(w.mode_x, w.mode_z) +
               " has more than one wavelength per two cells, the cut-off of the mesh: refine it "
               "or lower theory.mode_x and mode_z");
    refuse(w.modes > 0 && 2 * w.modes > w.grid.x.cells,
           "output.modes = " + std::to_string(w.modes) + " is above the cut-off of the mesh, " +
               std::to_string(w.grid.x.cells / 2) + " modes: lower it or refine the mesh");
    refuse(w.modes > 0 && w.boundary_x == "wall", "output.modes needs periodic x");
    refuse(w.spectrum && w.modes == 0, "output.spectrum needs output.modes");
    refuse(w.spectrum && scales.steps < 8,
           "output.spectrum needs at least 8 steps, and there are " + std::to_string(scales.steps) +
               ": raise time.end above " + format(8 * w.dt));
    for (const SpeciesCase& s : w.species) {
        if (!s.mobile() || s.amplitude == 0 || s.wave != "traveling") continue;
        detail::refuse_wave(w, "species." + s.name + ".wave = \"traveling\"", s.mode_x, s.mode_z);
        theory_of_wave(w, s.mode_x, s.mode_z);  // throws where there is no such wave
    }
    detail::refuse_comparison(w);
}

}  // namespace cic
