// What is refused of boundaries, materials, regions and steps, before a run starts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "flip/setup/scales.hpp"

namespace flip {

/// Refuses numbers beyond 1e-40 and 1e40, whose products leave double precision.
inline void refuse_extreme(const std::string& name, double value) {
    const double size = std::fabs(value);
    refuse(size != 0 && !(size > 1e-40 && size < 1e40), name, " = ", value,
           " is not between 1e-40 and 1e40 in size: choose other units");
}

/// The same for a state of the gas, and its numbers are all.
template <class Number>
void refuse_extreme(const std::string& prefix, const GasOf<Number>& gas) {
    refuse_extreme(prefix + ".angular_velocity", gas.angular_velocity);
    const std::array<std::pair<const char*, const Number*>, 5> all{
        {{".density", &gas.density},
         {".pressure", &gas.pressure},
         {".velocity_x", &gas.velocity_x},
         {".velocity_z", &gas.velocity_z},
         {".velocity_theta", &gas.velocity_theta}}};
    for (const auto& [name, value] : all)
        if (common::Formula(*value).is_number()) refuse_extreme(prefix + name, double(*value));
}

/// Refuses too many particles, and numbers that lose precision.
inline void refuse_sizes(const Case& parameters) {
    const double cells = double(parameters.grid.x.cells) * double(parameters.grid.z.cells),
                 places = cells * double(parameters.per_cell_x * parameters.per_cell_z);
    refuse(places > 2e9, cells, " cells with ", parameters.per_cell_x * parameters.per_cell_z,
           " places for particles in each are ", places,
           ", more than 2e9: lower particles.per_cell_x and per_cell_z, or take fewer cells");
    const auto refuse_far = [](const std::string& name, const common::Axis& axis) {
        const double away = std::fabs(axis.low) / axis.spacing();
        refuse(!(away <= 1e9), "grid.", name, " = ", axis.low, " is ", away,
               " cells from the origin, more than 1e9, where places are lost to round-off: move it "
               "nearer to 0");
    };
    refuse_far("low_x", parameters.grid.x);
    refuse_far("low_z", parameters.grid.z);
}

/// The names of all materials, quoted, for a sentence.
inline std::string list_of_materials(const Case& parameters) {
    std::string list;
    for (const Material& a : parameters.materials)
        list += (list.empty() ? "'" : ", '") + a.name + "'";
    return list;
}

/// Refuses boundaries that do not go together, and numbers that none of them uses.
inline void refuse_boundaries(const Case& parameters) {
    for (const Side low : {x_low, z_low}) {
        const std::string a = side_names[low], b = side_names[low + 1];
        refuse((parameters.boundaries[low].kind == "periodic") !=
                   (parameters.boundaries[low + 1].kind == "periodic"),
               "boundary.", a, " = \"", parameters.boundaries[low].kind, "\" and boundary.", b,
               " = \"", parameters.boundaries[low + 1].kind,
               "\": a periodic direction has no ends; make both periodic or neither");
    }
    bool has_inflow = false;
    for (std::size_t k = 0; k < 4; ++k) {
        const BoundaryCase& end = parameters.boundaries[k];
        const std::string name = side_names[k];
        refuse(!parameters.plane() && k >= z_low && end.kind != "periodic" && end.kind != "slip",
               "boundary.", name, " = \"", end.kind,
               "\" needs grid.cells_z of at least 2: a row is periodic in z or slips");
        refuse(end.slide != 0 && end.kind != "no_slip", "boundary.slide_", name, " = ", end.slide,
               " needs boundary.", name, " = \"no_slip\"");
        refuse(end.pressure != 0 && end.kind != "open", "boundary.pressure_", name, " = ",
               end.pressure, " needs boundary.", name, " = \"open\"");
        if (end.kind != "inflow") continue;
        has_inflow = true;
        const double v = k < z_low ? end.inflow.velocity_x : end.inflow.velocity_z;
        refuse(end.inflow.material.empty() && parameters.materials.size() > 1, "inflow.", name,
               " has no material, and there are ", parameters.materials.size(), ": give inflow.",
               name, ".material one of ", list_of_materials(parameters));
        refuse(material_index(parameters, end.inflow.material) < 0, "inflow.material = \"",
               end.inflow.material, "\" is none of ", list_of_materials(parameters));
        refuse_extreme("inflow." + name, end.inflow);
        const bool low = k == x_low || k == z_low;
        refuse(!(low ? v > 0 : v < 0), "boundary.", name, " = \"inflow\" needs inflow.velocity_",
               name.substr(0, 1), (low ? " above 0" : " below 0"), ", into the mesh, and it is ",
               v);
    }
    refuse(!has_inflow && !(parameters.inflow == GasCase()),
           "[inflow] needs an end with boundary = \"inflow\": set one, or take it out");
    for (const InflowCase& in : parameters.inflows) {
        const auto end = std::ranges::find(side_names, in.name);
        refuse(end == side_names.end(), "[inflow.", in.name,
               "] names no end: write inflow.x_low, x_high, z_low or z_high");
        refuse(parameters.boundaries[end - side_names.begin()].kind != "inflow", "[inflow.",
               in.name, "] needs boundary.", in.name, " = \"inflow\": set it, or take it out");
    }
    refuse(!parameters.plane() && parameters.gravity_z != 0, "gravity.z = ", parameters.gravity_z,
           " needs grid.cells_z of at least 2");
}

/// Refuses a rotation about the axis where there is none, and what would change the angular momentum that
/// particles keep.
inline void refuse_swirl(const Case& parameters) {
    if (!parameters.swirls()) return;
    refuse(
        !parameters.grid.axisymmetric,
        "velocity_theta and angular_velocity need an axis: set grid.geometry = \"axisymmetric\"; "
        "in the plane take a region with flow = \"rotation\"");
    refuse(
        parameters.viscosity > 0, "flip.viscosity = ", parameters.viscosity,
        " has a torque, and particles that turn about the axis keep their angular momentum: take "
        "out the viscosity, or velocity_theta and angular_velocity");
    for (const Side s : all_sides)
        refuse(
            parameters.is(s, "no_slip"), "boundary.", side_names[s],
            " = \"no_slip\" would stop fluid that turns about the axis, and nothing here hands its "
            "angular momentum to the wall: take \"slip\"");
    const common::Axis& z = parameters.grid.z;
    const double dx = parameters.grid.x.spacing(), axis = 1e-6 * dx;
    for (long n = 0; n < long(parameters.regions.size()); ++n) {
        const RegionCase& r = parameters.regions[n];
        for (long j = 0; r.hydrostatic && r.turns() && j < z.cells; ++j) {
            const double at = z.at(double(j) + 0.5);
            if (r.center_x > axis && region_at(parameters, axis, at) != n) continue;
            const auto swirl = [&](double x) {
                return std::fabs(
                    detail::swirl_of(r, x, at, std::hypot(x - r.center_x, at - r.center_z)));
            };
            refuse(swirl(axis) > 1e-3 * swirl(0.5 * dx), "region.", r.name, ".velocity_theta is ",
                   swirl(axis),
                   " on the axis, and hydrostatic = true needs 0 "
                   "there: in formulas x is the distance from the axis, r that from the center of "
                   "the region");
        }
    }
}

/// Refuses what has no meaning around an axis.
inline void refuse_around_axis(const Case& parameters) {
    if (!parameters.grid.axisymmetric) return;
    const std::string geometry = "grid.geometry = \"axisymmetric\" ";
    refuse(parameters.grid.x.low != 0, geometry, "needs the axis at grid.low_x = 0, and it is ",
           parameters.grid.x.low);
    refuse(!parameters.is(x_low, "slip"), geometry,
           "needs boundary.x_low = \"slip\": nothing crosses the axis");
    refuse(parameters.is(x_high, "inflow"), geometry,
           "and boundary.x_high = \"inflow\" do not go together: a stream towards the axis is not "
           "uniform; let it come in along z");
    refuse(parameters.gravity_x != 0 || parameters.trap != 0, geometry,
           "has no direction x: take out gravity.x and gravity.trap");
    refuse(parameters.rezone_steps > 0, geometry,
           "and rezone.steps do not go together: splitting and merging keep weights that are "
           "linear in r, and rings weigh by r^2; take rezone.steps = 0");
    refuse(parameters.confined, geometry,
           "and flip.confined do not go together: its paths are those of a plane");
    for (const RegionCase& r : parameters.regions)
        refuse(r.flow != "uniform" && r.flow != "radial" && r.flow != "gaussian", geometry,
               "has no flow = \"", r.flow, "\", as region.", r.name,
               " asks for: take uniform, radial or gaussian");
}

/// Refuses materials that the equation of state or the program cannot hold.
inline void refuse_materials(const Case& parameters, const std::string& program) {
    refuse(parameters.materials.size() > most_materials, parameters.materials.size(),
           " materials are more than the ", most_materials, " that a cell can hold: use fewer");
    for (const Material& a : parameters.materials) {
        refuse(a.gamma == 1 && a.p_infinity > 0, "material.", a.name,
               ".p_infinity = ", a.p_infinity,
               " needs gamma above 1: gamma = 1 is dust, without pressure");
        refuse(a.tension > 0 && a.tension >= a.p_infinity, "material.", a.name,
               ".tension = ", a.tension, " must be below its p_infinity, ", a.p_infinity);
        refuse(a.tension > 0 && program == "flip" && parameters.density != "particles", "material.",
               a.name, ".tension = ", a.tension,
               " needs flip with flip.density = \"particles\": a cell cannot tell a liquid that is "
               "stretched from one that does not fill it");
        refuse(a.gamma == 1 && parameters.implicit(), "material.", a.name,
               ".gamma = 1 is dust, without pressure, and flip.pressure = \"implicit\" needs gamma "
               "above 1: take \"explicit\"");
        refuse(a.gamma > 1 && a.gamma < 1.001, "material.", a.name, ".gamma = ", a.gamma,
               " is between 1 and 1.001, where internal energies drown pressures in round-off: "
               "raise it, or take 1, dust");
    }
}

/// Refuses a region without shape, or with a flow that it cannot have.
inline void refuse_region(const Case& parameters, const RegionCase& r) {
    const std::string region = "region." + r.name;
    refuse(material_index(parameters, r.gas.material) < 0, region, ".material = \"", r.gas.material,
           "\" is none of ", list_of_materials(parameters));
    refuse(r.shape == "box" && !(r.half_x > 0 && r.half_z > 0), region,
           " is a box of half_x = ", r.half_x, " and half_z = ", r.half_z, ": give both");
    refuse(r.shape == "disk" && !(r.radius > 0), region, " is a disk without radius: give it");
    refuse(r.ripple != 0 && r.shape != "above", region, ".ripple = ", r.ripple,
           " needs shape = \"above\"");
    const bool plane_flow =
        r.flow == "rotation" || r.flow == "gresho" || r.flow == "shear" || r.flow == "overturn";
    refuse(plane_flow && !parameters.plane(), region, ".flow = \"", r.flow,
           "\" needs grid.cells_z of at least 2");
    const bool wide =
        r.flow == "rotation" || r.flow == "gresho" || r.flow == "shear" || r.flow == "gaussian";
    refuse(wide && !(r.width > 0), region, ".flow = \"", r.flow, "\" needs a width above 0");
    const bool waves = r.flow == "wave" || r.flow == "shear" || r.flow == "overturn";
    refuse((waves || r.ripple != 0) && 2 * r.mode >= parameters.grid.x.cells, region,
           ".mode = ", r.mode, " is not below the cut-off of the mesh, ",
           0.5 * double(parameters.grid.x.cells), " wavelengths: lower it or refine the mesh");
    refuse(r.flow == "wave" && std::fabs(r.amplitude) >= 1, region, ".amplitude = ", r.amplitude,
           " makes densities negative: take less than 1");
    refuse(r.flow == "gaussian" && r.amplitude < -1, region, ".amplitude = ", r.amplitude,
           " makes energies negative: take more than -1");
    const bool overturns = r.flow == "overturn";
    refuse(
        overturns && !(r.center_z > parameters.grid.z.low && r.center_z < parameters.grid.z.high()),
        region, ".flow = \"overturn\" needs center_z on the mesh, and it is ", r.center_z);
    const bool sound = r.flow == "wave" || r.flow == "gresho" || r.hydrostatic;
    refuse(sound && material_of(parameters, r).gamma == 1, region,
           " is dust, gamma = 1, and has no pressure for ",
           (r.hydrostatic ? "hydrostatic = true" : "flow = \"" + r.flow + "\""));
}

/// Refuses fluid that is far from rest: a tenth of its weight depends on the way to a place, or its pressure
/// changes by as much without weight. Less is a perturbation.
inline void refuse_unbalanced(const Case& parameters, const RegionCase& r) {
    if (!r.hydrostatic) return;
    const std::string rests = sentence("region.", r.name, ".hydrostatic = true ");
    for (const bool x : {true, false})
        refuse((x ? parameters.grid.x : parameters.grid.z).periodic &&
                   (x ? parameters.gravity_x : parameters.gravity_z) != 0,
               rests, "needs walls that hold the fluid, and along ", (x ? "x" : "z"),
               ", a periodic direction, gravity lets it fall for ever: set both ends to \"slip\"");
    double most = 0, apart = 0, lowest = HUGE_VAL, highest = -HUGE_VAL;
    constexpr long places = 16;
    for (long n = 0; n < places * places; ++n) {
        const common::Axis &ax = parameters.grid.x, &az = parameters.grid.z;
        const double x = ax.at((double(n % places) + 0.5) / places * double(ax.cells)),
                     z = az.at((double(n / places) + 0.5) / places * double(az.cells));
        if (!detail::contains(parameters, r, x, z)) continue;
        const double p = detail::weight_above(parameters, r, x, z);
        most = std::max(most, std::fabs(p));
        apart = std::max(apart, std::fabs(p - detail::weight_above(parameters, r, x, z, false)));
        const double given = r.gas.pressure.at(x, z, std::hypot(x - r.center_x, z - r.center_z));
        lowest = std::min(lowest, given), highest = std::max(highest, given);
    }
    refuse(highest - lowest > 0.1 * most, rests, "adds the weight of up to ", most,
           " to the pressure at the center, and region.", r.name, ".pressure changes by ",
           highest - lowest, " itself: give a number, or take out hydrostatic");
    refuse(apart > 0.1 * most, rests,
           "needs fluid that can rest, and its weight above the center, up to ", most,
           ", differs by ", apart, " from way to way: take out hydrostatic, or let ",
           r.turns() ? "neither its density nor its rotation change along the axis"
                     : "its density change along gravity alone");
}

/// Refuses densities of 0 and pressures that the equation of state does not have, at the places of
/// the particles: the lowest of them.
inline void refuse_tension(const Case& parameters) {
    double lowest = 0;
    std::string said;
    for_each_place(parameters, [&](long n, const FluidState& fluid, double x, double z, double) {
        const Material& a = parameters.materials[fluid.material];
        refuse(!(fluid.density > 0), "region.", parameters.regions[n].name, " has the density ",
               fluid.density, " at x = ", x, ", z = ", z,
               ": keep it above 0; a vacuum is a region of its own, density = 0");
        if (a.gamma == 1) return;
        const double stiff = a.gamma * a.p_infinity,
                     p = (a.gamma - 1) * fluid.density * fluid.e - stiff;
        if (p >= -1e-9 * (stiff + std::fabs(p)) || p >= lowest) return;
        lowest = p;
        said = sentence("region.", parameters.regions[n].name, " has the pressure ", p,
                        " at x = ", x, ", z = ", z,
                        ", and fluids here hold no tension: raise its pressure by more than that");
    });
    refuse(!said.empty(), said);
}

/// Refuses a run without particles, and a time step that is too long.
inline void refuse_steps(const Case& parameters, const Scales& s) {
    const auto inflows = std::ranges::count(parameters.boundaries, "inflow", &BoundaryCase::kind);
    refuse(s.particles == 0 && inflows == 0,
           "no region contains a particle, so nothing can happen: put one on the mesh, from x = ",
           parameters.grid.x.low, " to ", parameters.grid.x.high());
    refuse(s.steps > 1e9, "time.end = ", parameters.end, " is ", s.steps, " steps of ", s.dt,
           ", more than 1e9: lower time.end", (parameters.viscosity > 0 ? ", flip.viscosity" : ""),
           (parameters.dt > 0 ? " or raise time.dt" : " or take larger cells"));
    if (parameters.dt > 0 && s.rate > 0)
        refuse(parameters.dt * s.rate > 1, "time.dt = ", parameters.dt, ": ",
               (parameters.implicit() ? "the flow crosses " : "sound and flow cross "),
               parameters.dt * s.rate, " cells in a step, more than 1: lower it below ",
               1 / s.rate);
    if (parameters.dt == 0 || !(parameters.viscosity > 0)) return;
    const double h = parameters.plane()
                         ? std::min(parameters.grid.x.spacing(), parameters.grid.z.spacing())
                         : parameters.grid.x.spacing();
    double lightest = 1e300;
    for (const RegionScales& r : s.regions)
        if (r.particles > 0) lightest = std::min(lightest, r.lightest);
    const double number = parameters.viscosity * parameters.dt / (lightest * h * h);
    const bool consistent = parameters.mass == "consistent";
    // most_viscous_consistent of a plane; nodes of one row move in turn along x alone, 4/3 in the place of 4/3 + 1.
    const double most = !consistent ? 0.5 : parameters.plane() ? 0.07 : 0.09;
    refuse(number > most, "time.dt = ", parameters.dt,
           ": flip.viscosity dt/(density dx^2) = ", number, " is above ", most,
           ", where explicit viscosity ", most < 0.5 ? "with flip.mass = \"consistent\" " : "",
           "blows up: lower it below ", most * parameters.dt / number);
}

}  // namespace flip
