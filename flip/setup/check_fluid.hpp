// What is refused of ends, materials, regions and steps, before a run starts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "flip/setup/check_comparison.hpp"

namespace flip {

namespace detail {

inline constexpr std::array<const char*, 4> end_names{"x_low", "x_high", "z_low", "z_high"};

// Beyond these sizes, products of several numbers leave double precision.
inline void refuse_extreme(const std::string& name, double value) {
    const double size = std::fabs(value);
    refuse(size != 0 && !(size > 1e-40 && size < 1e40),
           name + " = " + format(value) +
               " is not between 1e-40 and 1e40 in size: choose other units");
}

inline void refuse_extreme(const std::string& prefix, const GasCase& gas) {
    refuse_extreme(prefix + ".density", gas.density);
    refuse_extreme(prefix + ".pressure", gas.pressure);
    refuse_extreme(prefix + ".velocity_x", gas.velocity_x);
    refuse_extreme(prefix + ".velocity_z", gas.velocity_z);
}

inline void refuse_sizes(const Case& w) {
    const double cells = static_cast<double>(w.grid.x.cells) * static_cast<double>(w.grid.z.cells),
                 places = cells * static_cast<double>(w.per_cell_x * w.per_cell_z);
    refuse(places > 2e9, format(cells) + " cells with " +
                             std::to_string(w.per_cell_x * w.per_cell_z) +
                             " places for particles in each are " + format(places) +
                             ", more than 2e9: lower particles.per_cell_x and per_cell_z, or take "
                             "fewer cells");
    const std::vector<std::pair<const char*, double>> numbers{
        {"grid.length_x", w.grid.x.length},
        {"grid.length_z", w.grid.z.length},
        {"time.dt", w.dt},
        {"gravity.x", w.gravity_x},
        {"gravity.z", w.gravity_z},
        {"gravity.trap", w.trap},
        {"flip.viscosity", w.viscosity},
        {"theory.frame_x", w.frame_x},
        {"theory.frame_z", w.frame_z},
        {"viscosity.linear", w.q_linear},
        {"viscosity.quadratic", w.q_quadratic}};
    for (const auto& [name, value] : numbers) refuse_extreme(name, value);
    refuse_extreme("inflow", w.inflow);
    for (const Material& a : w.materials)
        refuse_extreme("material." + a.name + ".p_infinity", a.p_infinity);
    for (std::size_t k = 0; k < 4; ++k) {
        refuse_extreme("boundary.slide_" + std::string(end_names[k]), w.ends[k].slide);
        refuse_extreme("boundary.pressure_" + std::string(end_names[k]), w.ends[k].pressure);
    }
    const auto refuse_far = [](const std::string& name, const common::Axis& axis) {
        const double away = std::fabs(axis.low) / axis.spacing();
        refuse(!(away <= 1e9), "grid." + name + " = " + format(axis.low) + " is " + format(away) +
                                   " cells from the origin, more than 1e9, where places are lost "
                                   "to round-off: move it nearer to 0");
    };
    refuse_far("low_x", w.grid.x);
    refuse_far("low_z", w.grid.z);
}

inline void refuse_ends(const Case& w) {
    for (const End low : {x_low, z_low}) {
        const std::string a = end_names[low], b = end_names[low + 1];
        refuse((w.ends[low].kind == "periodic") != (w.ends[low + 1].kind == "periodic"),
               "boundary." + a + " = \"" + w.ends[low].kind + "\" and boundary." + b + " = \"" +
                   w.ends[low + 1].kind +
                   "\": a periodic direction has no ends; make both periodic or neither");
    }
    bool has_inflow = false;
    for (std::size_t k = 0; k < 4; ++k) {
        const EndCase& end = w.ends[k];
        const std::string name = end_names[k];
        refuse(!w.plane() && k >= z_low && end.kind != "periodic" && end.kind != "slip",
               "boundary." + name + " = \"" + end.kind +
                   "\" needs grid.cells_z of at least 2: a row is periodic in z or slips");
        refuse(end.slide != 0 && end.kind != "no_slip", "boundary.slide_" + name + " = " +
                                                            format(end.slide) + " needs boundary." +
                                                            name + " = \"no_slip\"");
        refuse(end.pressure != 0 && end.kind != "open",
               "boundary.pressure_" + name + " = " + format(end.pressure) + " needs boundary." +
                   name + " = \"open\"");
        if (end.kind != "inflow") continue;
        has_inflow = true;
        const double v = k < z_low ? w.inflow.velocity_x : w.inflow.velocity_z;
        const bool low = k == x_low || k == z_low;
        refuse(!(low ? v > 0 : v < 0), "boundary." + name + " = \"inflow\" needs inflow.velocity_" +
                                           name.substr(0, 1) + (low ? " above 0" : " below 0") +
                                           ", into the mesh, and it is " + format(v));
    }
    const GasCase none;
    refuse(!has_inflow && (w.inflow.velocity_x != 0 || w.inflow.velocity_z != 0 ||
                           w.inflow.density != none.density || w.inflow.pressure != none.pressure ||
                           !w.inflow.material.empty()),
           "[inflow] needs an end with boundary = \"inflow\": set one, or take it out");
    refuse(!w.plane() && w.gravity_z != 0,
           "gravity.z = " + format(w.gravity_z) + " needs grid.cells_z of at least 2");
}

inline std::string list_of_materials(const Case& w) {
    std::string list;
    for (const Material& a : w.materials) list += (list.empty() ? "'" : ", '") + a.name + "'";
    return list;
}

inline void refuse_materials(const Case& w) {
    refuse(w.materials.size() > most_materials,
           std::to_string(w.materials.size()) + " materials are more than the " +
               std::to_string(most_materials) + " that a cell can hold: use fewer");
    for (const Material& a : w.materials) {
        refuse(a.gamma == 1 && a.p_infinity > 0,
               "material." + a.name + ".p_infinity = " + format(a.p_infinity) +
                   " needs gamma above 1: gamma = 1 is dust, without pressure");
        refuse(a.gamma == 1 && w.implicit(),
               "material." + a.name +
                   ".gamma = 1 is dust, without pressure, and flip.pressure = "
                   "\"implicit\" needs gamma above 1: take \"explicit\"");
        refuse(a.gamma > 1 && a.gamma < 1.001,
               "material." + a.name + ".gamma = " + format(a.gamma) +
                   " is between 1 and 1.001, where internal energies drown pressures in "
                   "round-off: raise it, or take 1, dust");
    }
    refuse(material_index(w, w.inflow.material) < 0,
           "inflow.material = \"" + w.inflow.material + "\" is none of " + list_of_materials(w));
}

inline void refuse_region(const Case& w, const RegionCase& r) {
    const std::string region = "region." + r.name;
    refuse(material_index(w, r.gas.material) < 0,
           region + ".material = \"" + r.gas.material + "\" is none of " + list_of_materials(w));
    refuse_extreme(region, r.gas);
    const std::vector<std::pair<const char*, double>> numbers{
        {".speed", r.speed},   {".width", r.width},   {".energy", r.energy}, {".noise", r.noise},
        {".radius", r.radius}, {".half_x", r.half_x}, {".half_z", r.half_z}, {".ripple", r.ripple}};
    for (const auto& [name, value] : numbers) refuse_extreme(region + name, value);
    refuse(r.shape == "box" && !(r.half_x > 0 && r.half_z > 0),
           region + " is a box of half_x = " + format(r.half_x) +
               " and half_z = " + format(r.half_z) + ": give both");
    refuse(r.shape == "disk" && !(r.radius > 0), region + " is a disk without radius: give it");
    refuse(r.ripple != 0 && r.shape != "above",
           region + ".ripple = " + format(r.ripple) + " needs shape = \"above\"");
    const bool plane_flow =
        r.flow == "rotation" || r.flow == "gresho" || r.flow == "shear" || r.flow == "overturn";
    refuse(plane_flow && !w.plane(),
           region + ".flow = \"" + r.flow + "\" needs grid.cells_z of at least 2");
    const bool wide =
        r.flow == "rotation" || r.flow == "gresho" || r.flow == "shear" || r.flow == "gaussian";
    refuse(wide && !(r.width > 0), region + ".flow = \"" + r.flow + "\" needs a width above 0");
    const bool waves = r.flow == "wave" || r.flow == "shear" || r.flow == "overturn";
    refuse((waves || r.ripple != 0) && is_above_cut_off(w, r.mode),
           region + ".mode = " + std::to_string(r.mode) +
               " is not below the cut-off of the mesh, " +
               format(0.5 * static_cast<double>(w.grid.x.cells)) +
               " wavelengths: lower it or refine the mesh");
    refuse(r.flow == "wave" && std::fabs(r.amplitude) >= 1,
           region + ".amplitude = " + format(r.amplitude) +
               " makes densities negative: take less than 1");
    refuse(r.flow == "gaussian" && r.amplitude < -1,
           region + ".amplitude = " + format(r.amplitude) +
               " makes energies negative: take more than -1");
    const bool overturns = r.flow == "overturn";
    refuse(overturns && !(r.center_z > w.grid.z.low && r.center_z < w.grid.z.high()),
           region + ".flow = \"overturn\" needs center_z on the mesh, and it is " +
               format(r.center_z));
    const bool sound = r.flow == "wave" || r.flow == "gresho" || r.hydrostatic;
    refuse(sound && material_of(w, r).gamma == 1,
           region + " is dust, gamma = 1, and has no pressure for " +
               (r.hydrostatic ? "hydrostatic = true" : "flow = \"" + r.flow + "\""));
}

// Pressures that the equation of state does not have, at the places of the particles.
inline void refuse_tension(const Case& w) {
    for_each_place(w, [&](std::size_t n, const FluidState& fluid, double x, double z, double) {
        const Material& a = w.materials[static_cast<std::size_t>(fluid.material)];
        if (a.gamma == 1) return;
        const double stiff = a.gamma * a.p_infinity,
                     p = (a.gamma - 1) * fluid.density * fluid.e - stiff;
        refuse(!(p >= -1e-9 * (stiff + std::fabs(p))) || !(fluid.density > 0),
               "region." + w.regions[n].name + " has the pressure " + format(p) +
                   " at x = " + format(x) + ", z = " + format(z) +
                   ", and fluids here hold no tension: raise its "
                   "pressure by that much");
    });
}

inline void refuse_steps(const Case& w, const Scales& s) {
    refuse(s.particles == 0 && !std::any_of(w.ends.begin(), w.ends.end(),
                                            [](const EndCase& e) { return e.kind == "inflow"; }),
           "no region contains a particle, so nothing can happen: put one on the mesh, from x = " +
               format(w.grid.x.low) + " to " + format(w.grid.x.high()));
    refuse(s.steps > 1e9, "time.end = " + format(w.end) + " is " + format(s.steps) + " steps of " +
                              format(s.dt) + ", more than 1e9: lower time.end or " +
                              (w.dt > 0 ? "raise time.dt" : "take larger cells"));
    if (w.dt > 0 && s.rate > 0)
        refuse(w.dt * s.rate > 1,
               "time.dt = " + format(w.dt) + ": " +
                   (w.implicit() ? "the flow crosses " : "sound and flow cross ") +
                   format(w.dt * s.rate) + " cells in a step, more than 1: lower it below " +
                   format(1 / s.rate));
    if (w.dt == 0 || !(w.viscosity > 0)) return;
    const double h =
        w.plane() ? std::min(w.grid.x.spacing(), w.grid.z.spacing()) : w.grid.x.spacing();
    double lightest = w.regions.front().gas.density;
    for (const RegionCase& r : w.regions) lightest = std::min(lightest, r.gas.density);
    const double number = w.viscosity * w.dt / (lightest * h * h);
    refuse(number > 0.5, "time.dt = " + format(w.dt) +
                             ": flip.viscosity dt/(density dx^2) = " + format(number) +
                             " is above 0.5, where explicit viscosity blows up: lower it below " +
                             format(0.5 * w.dt / number));
}

}  // namespace detail

}  // namespace flip
