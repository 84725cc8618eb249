// Comparisons that theory cannot answer, refused before a run starts.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "flip/setup/warn_of_case.hpp"

namespace flip {

namespace detail {

// One sentence for bad input.
inline void refuse(bool bad, const std::string& sentence) {
    if (bad) throw common::InputError(sentence);
}

inline bool has_flow(const Case& w, const std::string& flow) {
    return std::any_of(w.regions.begin(), w.regions.end(),
                       [&](const RegionCase& r) { return r.flow == flow; });
}

inline bool is_above_cut_off(const Case& w, long mode) { return 2 * mode >= w.grid.x.cells; }

// A flow that the comparison is about, in the one region that has it.
inline void refuse_without_flow(const Case& w, const std::string& what, const std::string& flow) {
    refuse(!has_flow(w, flow), what + " needs a region with flow = \"" + flow + "\"");
}

inline void refuse_mode(const Case& w, const std::string& what, const std::string& flow) {
    refuse(!w.grid.x.periodic, what + " needs periodic ends in x");
    refuse(is_above_cut_off(w, w.mode),
           what + " follows theory.mode = " + std::to_string(w.mode) + ", and " +
               std::to_string(w.grid.x.cells) + " cells have no waves above " +
               std::to_string((w.grid.x.cells - 1) / 2) + ": refine the mesh or lower it");
    for (const RegionCase& r : w.regions)
        refuse(r.flow == flow && r.mode != w.mode,
               what + " follows theory.mode = " + std::to_string(w.mode) + ", and region." +
                   r.name + ".mode = " + std::to_string(r.mode) + ": make them the same");
}

inline void refuse_riemann(const Case& w, const std::string& what) {
    refuse(w.setup != "riemann", what + " needs setup.kind = \"riemann\"");
    refuse(w.grid.x.periodic, what + " needs ends in x, and they are periodic: make them open");
    refuse(w.gravity_x != 0 || w.gravity_z != 0 || w.trap != 0,
           what + " is for fluid without gravity or trap");
    riemann_of(w);
}

inline void refuse_struck_wall(const Case& w, const std::string& what) {
    const RegionCase& r = w.regions.front();
    refuse(w.regions.size() != 1 || r.shape != "everywhere" || r.flow != "uniform",
           what + " needs a single region, uniform and everywhere");
    refuse(r.gas.velocity_x == 0,
           what + " needs gas that runs into a wall: give region." + r.name + ".velocity_x");
    const End end = r.gas.velocity_x < 0 ? x_low : x_high;
    const char* name = end == x_low ? "x_low" : "x_high";
    refuse(!w.is(end, "slip"), what + ": the gas runs towards " + name +
                                   ", which is not a wall: set boundary." + name + " = \"slip\"");
    refuse(material_of(w, r).gamma == 1, what + " is for a gas, and gamma = 1 is dust");
    refuse(w.compare == "piston" && r.gas.pressure + material_of(w, r).p_infinity == 0,
           what + " needs gas with a pressure: give region." + r.name + ".pressure");
    // What comes from the other end, at best with the flow and its sound.
    const bool fed = w.is(end == x_low ? x_high : x_low, "inflow");
    const double meeting = w.grid.x.length / (struck_wall(w).shock.speed_from_wall +
                                              std::fabs(r.gas.velocity_x) + sound_speed_of(w, r));
    refuse(!fed && w.end > meeting,
           what + ": the other end of the mesh is felt behind the shock from t = " +
               format(meeting) + " on: lower time.end below that");
}

inline void refuse_blast(const Case& w, const std::string& what) {
    const auto hot = std::count_if(w.regions.begin(), w.regions.end(),
                                   [](const RegionCase& r) { return r.energy > 0; });
    refuse(hot != 1 || w.regions.size() < 2 || w.regions.front().energy > 0,
           what + " needs a cold region first, and one with an energy inside it; " +
               std::to_string(hot) + " have one");
    const double gamma = material_of(w, w.regions.front()).gamma;
    refuse(!(gamma > 1 && gamma < 2),
           what + " is known for gamma between 1 and 2, and it is " + format(gamma));
    refuse(hot_region(w).gas.density != w.regions.front().gas.density,
           what + " needs the same density inside and outside: " +
               format(hot_region(w).gas.density) + " and " + format(w.regions.front().gas.density));
    const Blast blast = blast_of(w);
    const double R = blast.radius(w.end);
    const auto room = [&](const common::Axis& axis, double center) {
        return std::max(axis.high() - center, center - axis.low);
    };
    const double most = w.plane() ? std::min(room(w.grid.x, blast.x), room(w.grid.z, blast.z))
                                  : room(w.grid.x, blast.x);
    refuse(R > most, what + ": at time.end the shock is at r = " + format(R) +
                         ", and the mesh ends at " + format(most) + ": lower time.end");
}

inline void refuse_noh(const Case& w, const std::string& what) {
    refuse_without_flow(w, what, "radial");
    const RegionCase& r = region_with_flow(w, "radial");
    refuse(material_of(w, r).gamma == 1, what + " is for a gas, and gamma = 1 is dust");
    refuse(!(r.speed > 0), what + " needs region." + r.name + ".speed above 0, inward");
    refuse(r.gas.pressure > 0.01 * r.gas.density * r.speed * r.speed,
           what + " is for cold gas, and region." + r.name + ".pressure = " +
               format(r.gas.pressure) + " is above a hundredth of density speed^2, " +
               format(r.gas.density * r.speed * r.speed));
}

inline void refuse_interface(const Case& w, const std::string& what) {
    const bool two = w.regions.size() == 2 && w.regions[0].shape == "everywhere" &&
                     w.regions[1].shape == "above";
    refuse(!two, what + " needs two regions, one everywhere and one above it");
    refuse_mode(w, what, "overturn");
    refuse(w.grid.z.periodic, what + " needs walls in z");
    const RegionCase& upper = w.regions[1];
    refuse(
        !(upper.center_z > w.grid.z.low && upper.center_z < w.grid.z.high()),
        what + ": the interface at center_z = " + format(upper.center_z) + " is not on the mesh");
    refuse(!(theory_growth(w) > 0), what + ": density " + format(upper.gas.density) + " above " +
                                        format(w.regions[0].gas.density) +
                                        " with gravity.z = " + format(w.gravity_z) +
                                        " does not overturn: turn one around");
}

inline void refuse_shear(const Case& w, const std::string& what) {
    refuse_without_flow(w, what, "shear");
    refuse_mode(w, what, "shear");
    const RegionCase& r = region_with_flow(w, "shear");
    refuse(w.grid.z.periodic, what + " needs walls in z");
    const double middle = w.grid.z.low + 0.5 * w.grid.z.length;
    refuse(std::fabs(r.center_z - middle) > 1e-6 * w.grid.z.length,
           what + " needs the layer half-way between the walls, at center_z = " + format(middle));
    refuse(!(theory_growth(w) > 0), what + ": mode " + std::to_string(w.mode) +
                                        " of a layer of half-width " + format(r.width) +
                                        " does not grow: make it thinner, or lower theory.mode");
}

inline void refuse_dam(const Case& w, const std::string& what) {
    const RegionCase& r = w.regions.back();
    refuse(r.shape != "box", what + " needs a box of water as the last region");
    const WaterColumn water = water_of(w);
    refuse(!(water.gravity > 0),
           what + " needs gravity.z below 0, and it is " + format(w.gravity_z));
    refuse(!w.is(x_low, "slip") || !w.is(z_low, "slip"),
           what + " needs a wall at x_low and a floor at z_low: set both to \"slip\"");
    const double gap =
        std::max(r.center_x - r.half_x - w.grid.x.low, r.center_z - r.half_z - w.grid.z.low);
    refuse(gap > 0.5 * w.grid.x.spacing(),
           what + " needs the water in the corner of x_low and z_low, and it is " + format(gap) +
               " away");
    refuse(water.width >= w.grid.x.length, what + " needs room beyond the water: lower region." +
                                               r.name + ".half_x below " +
                                               format(0.5 * w.grid.x.length));
    theory::read_table(dam_table);
}

inline void refuse_cavity(const Case& w, const std::string& what) {
    for (const EndCase& end : w.ends)
        refuse(end.kind != "no_slip", what + " needs no_slip walls on all sides");
    const double U = w.ends[z_high].slide;
    refuse(!(U > 0), what + " needs a lid that moves: set boundary.slide_z_high above 0");
    for (const End end : {x_low, x_high, z_low})
        refuse(w.ends[end].slide != 0, what + " needs all walls but the lid at rest");
    refuse(std::fabs(w.grid.x.length - w.grid.z.length) > 1e-9 * w.grid.x.length,
           what + " is for a square, and the mesh is " + format(w.grid.x.length) + " x " +
               format(w.grid.z.length));
    const double Re =
        w.viscosity > 0 ? w.regions.front().gas.density * U * w.grid.x.length / w.viscosity : 0;
    refuse(std::fabs(Re - 100) > 1,
           what + " is published for density speed length/flip.viscosity = 100, and it is " +
               (Re > 0 ? format(Re) : "infinite") + ": set flip.viscosity = " +
               format(w.regions.front().gas.density * U * w.grid.x.length / 100));
    theory::read_table(cavity_table);
}

}  // namespace detail

/// Refuses what the comparison of a case cannot be made with.
/// in:     a completed case that runs; program, pic or flip
/// errors: InputError, one sentence
inline void refuse_comparison(const Case& w, const std::string& program) {
    using namespace detail;
    if (w.compare == "none") return;
    const std::string what = "theory.compare = \"" + w.compare + "\"";
    const std::vector<std::string> in_the_plane{"rotation",         "gresho",    "rayleigh_taylor",
                                                "kelvin_helmholtz", "dam_break", "cavity"};
    refuse(std::count(in_the_plane.begin(), in_the_plane.end(), w.compare) > 0 && !w.plane(),
           what + " needs grid.cells_z of at least 2");
    const bool moves = w.compare == "riemann" || w.compare == "wave" || w.compare == "gresho";
    refuse((w.frame_x != 0 && !moves) || (w.frame_z != 0 && w.compare != "gresho"),
           what + " is stated in the frame of the mesh: take out theory.frame_x and frame_z");
    if (w.compare == "riemann") refuse_riemann(w, what);
    if (w.compare == "wall_shock" || w.compare == "piston") refuse_struck_wall(w, what);
    if (w.compare == "sedov") refuse_blast(w, what);
    if (w.compare == "noh") refuse_noh(w, what);
    if (w.compare == "rayleigh_taylor") refuse_interface(w, what);
    if (w.compare == "kelvin_helmholtz") refuse_shear(w, what);
    if (w.compare == "dam_break") refuse_dam(w, what);
    if (w.compare == "cavity") refuse_cavity(w, what);
    if (w.compare == "diffusion") {
        refuse_without_flow(w, what, "gaussian");
        const RegionCase& r = region_with_flow(w, "gaussian");
        refuse(!w.grid.x.periodic, what + " needs periodic ends in x");
        refuse(w.dt == 0, what + " needs steps of one length: set time.dt");
        refuse(r.gas.velocity_x == 0,
               what + " needs a flow over the mesh: give region." + r.name + ".velocity_x");
        refuse(material_of(w, r).gamma != 1,
               what + " needs dust, whose energy has no pressure: set gamma = 1");
        refuse(w.plane() && w.grid.z.cells > 1 && !w.grid.z.periodic && !w.is(z_low, "slip"),
               what + " needs periodic ends or slip walls in z");
        refuse(r.amplitude == 0, what + " needs a blob: give region." + r.name + ".amplitude");
        refuse(10 * r.width > w.grid.x.length, what + " needs a mesh ten times as long as region." +
                                                   r.name + ".width = " + format(r.width) +
                                                   ", and it is " + format(w.grid.x.length));
    }
    if (w.compare == "rotation" || w.compare == "gresho") {
        refuse_without_flow(w, what, w.compare);
        const RegionCase& r = region_with_flow(w, w.compare);
        refuse(r.speed == 0, what + " needs a flow: give region." + r.name + ".speed");
        refuse(w.compare == "gresho" && ((w.frame_x != 0 && !w.grid.x.periodic) ||
                                         (w.frame_z != 0 && !w.grid.z.periodic)),
               what + " in a moving frame needs periodic ends in that direction");
        refuse(w.compare == "gresho" &&
                   (r.gas.velocity_x != w.frame_x || r.gas.velocity_z != w.frame_z),
               what + ": the vortex moves with " + format(r.gas.velocity_x) + ", " +
                   format(r.gas.velocity_z) + ": set theory.frame_x and frame_z to that");
    }
    if (w.compare == "wave") {
        refuse_without_flow(w, what, "wave");
        refuse_mode(w, what, "wave");
        const RegionCase& r = region_with_flow(w, "wave");
        refuse(r.amplitude == 0, what + " needs a wave: give region." + r.name + ".amplitude");
        refuse(w.regions.size() != 1, what + " needs a single region");
        refuse(sound_speed_of(w, r) == 0,
               what + " needs a gas with sound: give region." + r.name + ".pressure");
        refuse(r.gas.velocity_x != w.frame_x, what + ": the gas moves with " +
                                                  format(r.gas.velocity_x) +
                                                  ": set theory.frame_x to that");
    }
    if (w.compare == "ringing") {
        const RegionCase& r = w.regions.front();
        refuse(w.regions.size() != 1 || r.flow != "uniform" || r.shape != "everywhere" ||
                   !w.grid.x.periodic,
               what + " needs a single uniform region everywhere, and periodic ends in x");
        refuse(sound_speed_of(w, r) == 0, what + " needs a gas with sound");
        refuse(r.noise == 0, what + " needs a seed: give region." + r.name + ".noise");
    }
    if (w.compare == "impact") {
        refuse(impact_of(w).target == nullptr,
               what + " needs two materials, and the one that is hit in a region of shape \"box\"");
        const GasCase& gas = impact_of(w).projectile->gas;
        refuse(gas.velocity_x == 0 && gas.velocity_z == 0, what + " needs a region that moves");
    }
    refuse(program == "pic" && w.compare == "cavity", what + " needs viscosity: run it with flip");
}

}  // namespace flip
