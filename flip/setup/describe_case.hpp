// The table of parameters, from which case files, the command line and --help are read.
#pragma once

#include <string>
#include <vector>

#include "common/run/parameters.hpp"
#include "flip/theory/comparisons.hpp"

namespace flip {

namespace detail {

template <class Gas>
void describe_gas(common::ParameterTable& table, const std::string& prefix, Gas& g,
                  bool may_be_vacuum) {
    using common::anything, common::above, common::at_least;
    table.text(prefix + ".material", g.material,
               "which material; empty: the first; of an inflow, the only one");
    table.real(prefix + ".density", g.density, "mass/length^3",
               may_be_vacuum ? at_least(0) : above(0),
               may_be_vacuum ? "density; the number 0: a vacuum" : "density");
    table.real(prefix + ".pressure", g.pressure, "pressure", at_least(0),
               "pressure; of dust, gamma = 1, internal energy per volume");
    table.real(prefix + ".velocity_x", g.velocity_x, "velocity", anything(), "along x");
    table.real(prefix + ".velocity_z", g.velocity_z, "velocity", anything(), "along z");
    table.real(prefix + ".velocity_theta", g.velocity_theta, "velocity", anything(),
               "about the axis, where grid.geometry is axisymmetric: swirl; the axis is x = 0");
    table.real(prefix + ".angular_velocity", g.angular_velocity, "1/time", anything(),
               "of a rigid rotation about the axis, added to that");
}

template <class Gas>
void describe_gas(common::ParameterTable& table, const std::string& prefix, Gas& g) {
    describe_gas(table, prefix, g, false);
}

inline void describe_side(common::ParameterTable& table, const std::string& name, SideCase& s) {
    using common::anything, common::above, common::at_least, common::between;
    table.real(name + ".density", s.density, "mass/length^3", at_least(0), "0: a vacuum");
    table.real(name + ".pressure", s.pressure, "pressure", at_least(0), "pressure");
    table.real(name + ".velocity", s.velocity, "velocity", anything(), "along x");
    table.real(name + ".gamma", s.gamma, "", between(1.01, 100), "ratio of specific heats");
    table.real(name + ".p_infinity", s.p_infinity, "pressure", at_least(0), "stiffness; 0: a gas");
    table.real(name + ".tension", s.tension, "pressure", at_least(0), "largest that it holds");
}

inline void describe_region(common::ParameterTable& table, const std::string& prefix,
                            RegionCase& r) {
    using common::anything, common::above, common::at_least, common::between;
    describe_gas(table, prefix, r.gas, true);
    table.choice(prefix + ".shape", r.shape, {"everywhere", "box", "disk", "above"},
                 "above: z > center_z + ripple cos(k (x - center_x)), k = 2 pi mode/length_x");
    table.real(prefix + ".center_x", r.center_x, "length", anything(), "of shape and flow");
    table.real(prefix + ".center_z", r.center_z, "length", anything(), "of shape and flow");
    table.real(prefix + ".half_x", r.half_x, "length", at_least(0), "half the width of a box");
    table.real(prefix + ".half_z", r.half_z, "length", at_least(0), "half its height");
    table.real(prefix + ".radius", r.radius, "length", at_least(0), "of a disk");
    table.real(prefix + ".ripple", r.ripple, "length", anything(), "of the lower edge of `above`");
    table.choice(
        prefix + ".flow", r.flow,
        {"uniform", "rotation", "radial", "gresho", "wave", "gaussian", "shear", "overturn"},
        "added to the uniform state: rigid rotation by speed/width; inward motion; the Gresho "
        "vortex; a sound wave along x; a Gaussian of energy, width its sigma; a layer of shear of "
        "half-width `width`; the flow that starts Rayleigh-Taylor");
    table.real(prefix + ".speed", r.speed, "velocity", anything(), "of that flow");
    table.real(prefix + ".width", r.width, "length", at_least(0), "of that flow");
    table.real(
        prefix + ".amplitude", r.amplitude, "", anything(),
        "of wave (relative density), gaussian (relative energy), shear and overturn (velocity)");
    table.whole(prefix + ".mode", r.mode, "", between(1, 4096), "wavelengths in length_x");
    table.real(prefix + ".energy", r.energy, "energy/length", at_least(0),
               "added to the internal energy, shared by the mass of the region");
    table.flag(
        prefix + ".hydrostatic", r.hydrostatic,
        "pressure is that at center_x, center_z, and changes with depth by the integral of density "
        "times gravity, and away from the axis by that of density times the centrifugal force");
    table.real(prefix + ".noise", r.noise, "velocity", at_least(0),
               "largest random velocity of a particle along x");
}

inline void describe_material(common::ParameterTable& table, const std::string& prefix,
                              Material& m) {
    table.real(prefix + ".gamma", m.gamma, "", common::between(1, 100),
               "ratio of specific heats; 1: dust without pressure");
    table.real(prefix + ".p_infinity", m.p_infinity, "pressure", common::at_least(0),
               "stiffness; 0: a gas");
    table.real(prefix + ".tension", m.tension, "pressure", common::at_least(0),
               "largest that a liquid holds before a void opens; below p_infinity");
}

}  // namespace detail

/// The table of all parameters: names, units, ranges and meanings of the fields of a Case, which
/// hold the defaults.
inline common::ParameterTable describe(Case& parameters) {
    using common::anything, common::above, common::at_least, common::between;
    common::ParameterTable table;

    table.group(
        "mesh: the plane (x, z), or a single row of cells; nothing depends on y, or on the angle");
    table.whole("grid.cells_x", parameters.grid.x.cells, "", between(2, 16384), "cells along x");
    table.whole("grid.cells_z", parameters.grid.z.cells, "", between(1, 16384),
                "cells along z; 1: a row");
    table.real("grid.length_x", parameters.grid.x.length, "length", above(0),
               "length of the box along x");
    table.real("grid.length_z", parameters.grid.z.length, "length", above(0), "along z");
    table.real("grid.low_x", parameters.grid.x.low, "length", anything(), "left end");
    table.real("grid.low_z", parameters.grid.z.low, "length", anything(), "lower end");
    table.choice(
        "grid.geometry", parameters.geometry, {"plane", "axisymmetric"},
        "axisymmetric: x is the distance r from the axis x = 0, and all is of whole rings");

    table.group("boundaries of the mesh");
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string end = side_names[k];
        table.choice("boundary." + end, parameters.boundaries[k].kind,
                     {"periodic", "slip", "no_slip", "open", "inflow"},
                     "open: particles leave, and the pressure outside is given");
        table.real("boundary.slide_" + end, parameters.boundaries[k].slide, "velocity", anything(),
                   "of a no-slip wall along itself");
        table.real("boundary.pressure_" + end, parameters.boundaries[k].pressure, "pressure",
                   at_least(0), "outside an open end, and in a void beside it (not in pic)");
    }
    detail::describe_gas(table, "inflow", parameters.inflow);
    table.list("inflow", parameters.inflows, detail::describe_gas<InflowCase>,
               "x_low, x_high, z_low or z_high: where it differs from [inflow]");

    table.group("time");
    table.real("time.cfl", parameters.cfl, "", between(1e-4, 1),
               "time step as a part of what the fastest signal needs for a cell; with implicit "
               "pressure, what the flow needs");
    table.real("time.dt", parameters.dt, "time", at_least(0), "fixed time step; 0: from time.cfl");
    table.real("time.end", parameters.end, "time", at_least(0), "length of the run");
    table.real("time.energy_limit", parameters.energy_limit, "", at_least(0),
               "the run fails when the energy is this many times the initial; 0: never");

    table.group("fluids");
    table.list("material", parameters.materials, detail::describe_material,
               "a material, [material.<name>]");
    table.choice("setup.kind", parameters.setup, {"regions", "riemann"},
                 "regions of materials, or two half-spaces [left] and [right]");
    table.real("setup.interface", parameters.interface, "length", anything(),
               "x between left and right");
    detail::describe_side(table, "left", parameters.left);
    detail::describe_side(table, "right", parameters.right);
    table.list("region", parameters.regions, detail::describe_region,
               "fluid at the start, [region.<name>]; later ones replace earlier ones");
    table.list("constant", parameters.constants, common::describe_constant,
               "a name for a number, for formulas of x, z and r, the distance from the center");
    table.whole("particles.per_cell_x", parameters.per_cell_x, "", between(1, 64),
                "in a cell along x");
    table.whole("particles.per_cell_z", parameters.per_cell_z, "", between(1, 64), "along z");
    table.choice("particles.loading", parameters.loading, {"lattice", "random"},
                 "random: each particle anywhere in its share of the cell");
    table.whole("particles.seed", parameters.seed, "", between(0, 1e9),
                "another number, another noise: of loading = \"random\" and of region.*.noise");

    table.group("forces");
    table.real("viscosity.linear", parameters.q_linear, "", at_least(0),
               "artificial viscosity q = rho (-du)(linear c + quadratic (-du)) in compression");
    table.real("viscosity.quadratic", parameters.q_quadratic, "", at_least(0),
               "its quadratic part");
    table.real("gravity.x", parameters.gravity_x, "velocity/time", anything(),
               "uniform acceleration");
    table.real("gravity.z", parameters.gravity_z, "velocity/time", anything(), "along z");
    table.real("gravity.trap", parameters.trap, "1/time^2", at_least(0),
               "acceleration per distance towards the middle of the mesh");

    table.group("flip only");
    table.choice("flip.transfer", parameters.transfer, {"flip", "pic", "blend", "apic", "xpic"},
                 "how the velocity of a particle follows the mesh");
    table.real("flip.blend", parameters.blend, "", between(0, 1),
               "of blend: part of flip; 1 - that of pic");
    table.whole("flip.xpic_order", parameters.xpic_order, "", between(1, 100), "of xpic: 1 is pic");
    table.choice("flip.mass", parameters.mass, {"lumped", "consistent"},
                 "mass matrix of the nodes");
    table.flag("flip.deficit_to_heat", parameters.deficit_to_heat,
               "kinetic energy that the transfer loses becomes internal energy");
    table.choice("flip.density", parameters.density, {"cells", "particles"},
                 "density from the mass in a cell, or from volumes that particles carry");
    table.real("flip.filling", parameters.filling, "", between(0, 1),
               "part of its room that a gas beside another material takes in a step");
    table.flag("flip.confined", parameters.confined,
               "gas everywhere: particles leave no void, and volumes follow the room both ways");
    table.real("flip.viscosity", parameters.viscosity, "mass/(length time)", at_least(0),
               "dynamic viscosity of the fluid");
    table.choice("flip.pressure", parameters.pressure, {"explicit", "implicit"},
                 "implicit: all flow speeds; the time step knows nothing of sound");
    table.real("flip.theta", parameters.theta, "", between(0.5, 1),
               "level of the implicit pressure");
    table.real("flip.tolerance", parameters.tolerance, "", between(1e-15, 0.1),
               "residual of the implicit pressure, relative");
    table.whole("flip.max_iterations", parameters.max_iterations, "", between(1, 1e6),
                "of the conjugate gradients");
    table.whole("rezone.steps", parameters.rezone_steps, "step", between(0, 1e9),
                "steps between splitting and merging of particles; 0: never");
    table.whole("rezone.min_particles", parameters.min_particles, "", between(1, 1e6),
                "cells with fewer particles of a material, and neighbors filled, split them");
    table.whole("rezone.max_particles", parameters.max_particles, "", between(5, 1e6),
                "cells with more merge them");

    table.group("comparison with theory");
    std::vector<std::string> names;
    for (const Comparison& c : comparisons()) names.push_back(c.name);
    table.choice("theory.compare", parameters.compare, names, "what the run is compared with");
    table.real("theory.tolerance", parameters.theory_tolerance, "", above(0),
               "allowed difference; of riemann, between the waves, as the mesh sets the others");
    table.real("theory.frame_x", parameters.frame_x, "velocity", anything(),
               "velocity of the frame in which theory is stated");
    table.real("theory.frame_z", parameters.frame_z, "velocity", anything(), "along z");
    table.whole("theory.mode", parameters.mode, "", between(1, 4096),
                "tracked wavelengths in length_x; of inertial_wave, half wavelengths in length_z");

    table.group("output");
    table.real("output.fields_interval", parameters.fields_interval, "time", at_least(0),
               "time between fields files; 0: none");
    table.real("output.particles_interval", parameters.particles_interval, "time", at_least(0),
               "time between particles files; 0: none");
    table.flag("output.vtk", parameters.also.vtk, "also write .vti and .vtp for ParaView");
    table.flag("output.openpmd", parameters.also.openpmd, "also write .h5, HDF5 after openPMD");
    table.whole("output.checkpoint_steps", parameters.checkpoint_steps, "", between(0, 1e9),
                "steps between checkpoints; 0: only when stopped");

    table.renamed({{"flip.most_iterations", "flip.max_iterations"},
                   {"rezone.fewest", "rezone.min_particles"},
                   {"rezone.most", "rezone.max_particles"}});
    table.may_change_on_restart({"time.end", "output.fields_interval", "output.particles_interval",
                                 "output.vtk", "output.openpmd", "output.checkpoint_steps"});
    return table;
}

}  // namespace flip
