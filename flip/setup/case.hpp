// Everything a case file of pic and flip can say: plain values with their defaults. One file serves
// both programs; how FLIP goes about it stands in sections of its own, which mean nothing to pic.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/grid.hpp"
#include "common/run/parameters.hpp"
#include "flip/problem.hpp"

namespace flip {

inline constexpr double pi = 3.14159265358979323846;

/// A uniform state of the gas.
struct GasCase {
    std::string material;  // empty: the first
    double density = 1, pressure = 1, velocity_x = 0, velocity_z = 0;
};

/// One side of a Riemann problem, with a material of its own.
struct SideCase {
    double density = 1, pressure = 1, velocity = 0, gamma = 1.4, p_infinity = 0;
};

/// Where fluid is at the start, and how it moves; later regions replace earlier ones.
struct RegionCase {
    std::string name;
    GasCase gas;
    std::string shape = "everywhere";  // or box, disk, above
    double center_x = 0, center_z = 0, half_x = 0, half_z = 0, radius = 0;
    double ripple = 0;             // of the lower edge of `above`
    std::string flow = "uniform";  // or rotation, radial, gresho, wave, gaussian, shear, overturn
    double speed = 0, width = 0, amplitude = 0;
    long mode = 1;
    double energy = 0;         // added, shared by the particles of the region
    bool hydrostatic = false;  // pressure is that of center_z
    double noise = 0;          // random part of the velocity
};

/// One end of the mesh.
struct EndCase {
    std::string kind = "periodic";  // or slip, no_slip, open, inflow
    double slide = 0;               // speed of a no-slip wall along itself
    double pressure = 0;            // outside an open end
};
using End = Side;

/// A complete input. Any consistent units; per unit length along y.
struct Case {
    common::Grid grid{{100, 0, 1, true}, {1, 0, 1, true}};
    std::array<EndCase, 4> ends;
    GasCase inflow;

    double cfl = 0.3, dt = 0, end = 1;
    double energy_limit = 10;

    std::vector<Material> materials;
    std::string setup = "regions";  // or riemann
    double interface = 0.5;
    SideCase left, right{0.125, 0.1, 0, 1.4, 0};
    std::vector<RegionCase> regions;
    long per_cell_x = 4, per_cell_z = 4;
    std::string loading = "lattice";  // or random
    long seed = 1;

    double q_linear = 0.5, q_quadratic = 1;
    double gravity_x = 0, gravity_z = 0, trap = 0;

    // What only FLIP has.
    std::string transfer = "flip";  // pic, blend, apic, xpic
    double blend = 0.97;
    long xpic_order = 2;
    std::string mass = "lumped";  // or consistent
    bool deficit_to_heat = true;
    std::string density = "cells";  // or particles
    double viscosity = 0;
    std::string pressure = "explicit";  // or implicit
    double theta = 1;
    double tolerance = 1e-8;
    long max_iterations = 1000;
    long rezone_steps = 0, min_particles = 4, max_particles = 32;

    // What the run is compared with.
    std::string compare = "none";
    double theory_tolerance = 0.05;
    double frame_x = 0, frame_z = 0;  // velocity of the frame in which theory is stated
    long mode = 1;

    double fields_interval = 0, particles_interval = 0;
    bool vtk = false;
    long checkpoint_steps = 0;

    /// Whether what the lumped masses owe the particles goes to heat; consistent ones owe nothing.
    bool heats() const { return deficit_to_heat && mass == "lumped"; }
    bool implicit() const { return pressure == "implicit"; }
    bool plane() const { return grid.z.cells > 1; }
    bool is(End e, const char* kind) const { return ends[e].kind == kind; }
};

namespace detail {

inline void describe_gas(common::ParameterTable& table, const std::string& prefix, GasCase& g) {
    using common::anything, common::above, common::at_least;
    table.text(prefix + ".material", g.material, "which material; empty: the first");
    table.real(prefix + ".density", g.density, "mass/length^3", above(0), "density");
    table.real(prefix + ".pressure", g.pressure, "pressure", at_least(0),
               "pressure; of dust, gamma = 1, internal energy per volume");
    table.real(prefix + ".velocity_x", g.velocity_x, "velocity", anything(), "along x");
    table.real(prefix + ".velocity_z", g.velocity_z, "velocity", anything(), "along z");
}

inline void describe_side(common::ParameterTable& table, const std::string& name, SideCase& s) {
    using common::anything, common::above, common::at_least, common::between;
    table.real(name + ".density", s.density, "mass/length^3", above(0), "density");
    table.real(name + ".pressure", s.pressure, "pressure", at_least(0), "pressure");
    table.real(name + ".velocity", s.velocity, "velocity", anything(), "along x");
    table.real(name + ".gamma", s.gamma, "", between(1.01, 100), "ratio of specific heats");
    table.real(name + ".p_infinity", s.p_infinity, "pressure", at_least(0), "stiffness; 0: a gas");
}

inline void describe_region(common::ParameterTable& table, const std::string& prefix,
                            RegionCase& r) {
    using common::anything, common::above, common::at_least, common::between;
    describe_gas(table, prefix, r.gas);
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
        "added to the uniform state: rigid rotation by speed/width; inward motion; the "
        "Gresho vortex; a sound wave along x; a Gaussian of energy, width its sigma; a "
        "layer of shear of half-width `width`; the flow that starts Rayleigh-Taylor");
    table.real(prefix + ".speed", r.speed, "velocity", anything(), "of that flow");
    table.real(prefix + ".width", r.width, "length", at_least(0), "of that flow");
    table.real(prefix + ".amplitude", r.amplitude, "", anything(),
               "of wave (relative density), gaussian (relative energy), shear and overturn "
               "(velocity)");
    table.whole(prefix + ".mode", r.mode, "", between(1, 4096), "wavelengths in length_x");
    table.real(prefix + ".energy", r.energy, "energy/length", at_least(0),
               "added to the internal energy, shared by the mass of the region");
    table.flag(prefix + ".hydrostatic", r.hydrostatic,
               "pressure is that at center_z, and changes with depth by density times gravity");
    table.real(prefix + ".noise", r.noise, "velocity", at_least(0),
               "largest random velocity of a particle along x");
}

inline void describe_material(common::ParameterTable& table, const std::string& prefix,
                              Material& m) {
    table.real(prefix + ".gamma", m.gamma, "", common::between(1, 100),
               "ratio of specific heats; 1: dust without pressure");
    table.real(prefix + ".p_infinity", m.p_infinity, "pressure", common::at_least(0),
               "stiffness; 0: a gas");
}

}  // namespace detail

/// The table of all parameters: names, units, ranges and meanings of the fields of a Case, which
/// hold the defaults.
inline common::ParameterTable describe(Case& w) {
    using common::anything, common::above, common::at_least, common::between;
    common::ParameterTable table;

    table.group("mesh: the plane (x, z), or a single row of cells; nothing depends on y");
    table.whole("grid.cells_x", w.grid.x.cells, "", between(2, 16384), "cells along x");
    table.whole("grid.cells_z", w.grid.z.cells, "", between(1, 16384), "cells along z; 1: a row");
    table.real("grid.length_x", w.grid.x.length, "length", above(0), "length of the box along x");
    table.real("grid.length_z", w.grid.z.length, "length", above(0), "along z");
    table.real("grid.low_x", w.grid.x.low, "length", anything(), "left end");
    table.real("grid.low_z", w.grid.z.low, "length", anything(), "lower end");

    table.group("ends of the mesh");
    const std::array<const char*, 4> ends{"x_low", "x_high", "z_low", "z_high"};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string end = ends[k];
        table.choice("boundary." + end, w.ends[k].kind,
                     {"periodic", "slip", "no_slip", "open", "inflow"},
                     "open: particles leave, and the pressure outside is given");
        table.real("boundary.slide_" + end, w.ends[k].slide, "velocity", anything(),
                   "of a no-slip wall along itself");
        table.real("boundary.pressure_" + end, w.ends[k].pressure, "pressure", at_least(0),
                   "outside an open end");
    }
    detail::describe_gas(table, "inflow", w.inflow);

    table.group("time");
    table.real("time.cfl", w.cfl, "", between(1e-4, 1),
               "time step as a part of what the fastest signal needs for a cell; with implicit "
               "pressure, what the flow needs");
    table.real("time.dt", w.dt, "time", at_least(0), "fixed time step; 0: from time.cfl");
    table.real("time.end", w.end, "time", at_least(0), "length of the run");
    table.real("time.energy_limit", w.energy_limit, "", at_least(0),
               "the run fails when the energy is this many times the initial; 0: never");

    table.group("fluids");
    table.list("material", w.materials, detail::describe_material, "a material, [material.<name>]");
    table.choice("setup.kind", w.setup, {"regions", "riemann"},
                 "regions of materials, or two half-spaces [left] and [right]");
    table.real("setup.interface", w.interface, "length", anything(), "x between left and right");
    detail::describe_side(table, "left", w.left);
    detail::describe_side(table, "right", w.right);
    table.list("region", w.regions, detail::describe_region,
               "fluid at the start, [region.<name>]; later ones replace earlier ones");
    table.whole("particles.per_cell_x", w.per_cell_x, "", between(1, 64), "in a cell along x");
    table.whole("particles.per_cell_z", w.per_cell_z, "", between(1, 64), "along z");
    table.choice("particles.loading", w.loading, {"lattice", "random"},
                 "random: each particle anywhere in its share of the cell");
    table.whole("particles.seed", w.seed, "", between(0, 1e9), "another number, another noise");

    table.group("forces");
    table.real("viscosity.linear", w.q_linear, "", at_least(0),
               "artificial viscosity q = rho (-du)(linear c + quadratic (-du)) in compression");
    table.real("viscosity.quadratic", w.q_quadratic, "", at_least(0), "its quadratic part");
    table.real("gravity.x", w.gravity_x, "velocity/time", anything(), "uniform acceleration");
    table.real("gravity.z", w.gravity_z, "velocity/time", anything(), "along z");
    table.real("gravity.trap", w.trap, "1/time^2", at_least(0),
               "acceleration per distance towards the middle of the mesh");

    table.group("flip only");
    table.choice("flip.transfer", w.transfer, {"flip", "pic", "blend", "apic", "xpic"},
                 "how the velocity of a particle follows the mesh");
    table.real("flip.blend", w.blend, "", between(0, 1), "of blend: part of flip; 1 - that of pic");
    table.whole("flip.xpic_order", w.xpic_order, "", between(1, 100), "of xpic: 1 is pic");
    table.choice("flip.mass", w.mass, {"lumped", "consistent"}, "mass matrix of the nodes");
    table.flag("flip.deficit_to_heat", w.deficit_to_heat,
               "kinetic energy that the transfer loses becomes internal energy");
    table.choice("flip.density", w.density, {"cells", "particles"},
                 "density from the mass in a cell, or from volumes that particles carry");
    table.real("flip.viscosity", w.viscosity, "mass/(length time)", at_least(0),
               "dynamic viscosity of the fluid");
    table.choice("flip.pressure", w.pressure, {"explicit", "implicit"},
                 "implicit: all flow speeds; the time step knows nothing of sound");
    table.real("flip.theta", w.theta, "", between(0.5, 1), "level of the implicit pressure");
    table.real("flip.tolerance", w.tolerance, "", between(1e-15, 0.1),
               "residual of the implicit pressure, relative");
    table.whole("flip.max_iterations", w.max_iterations, "", between(1, 1e6),
                "of the conjugate gradients");
    table.whole("rezone.steps", w.rezone_steps, "step", between(0, 1e9),
                "steps between splitting and merging of particles; 0: never");
    table.whole("rezone.min_particles", w.min_particles, "", between(1, 1e6),
                "cells with fewer particles of a material, and neighbors filled, split them");
    table.whole("rezone.max_particles", w.max_particles, "", between(5, 1e6),
                "cells with more merge them");

    table.group("comparison with theory");
    table.choice("theory.compare", w.compare,
                 {"none", "riemann", "wall_shock", "piston", "diffusion", "rotation", "sedov",
                  "noh", "gresho", "wave", "ringing", "rayleigh_taylor", "kelvin_helmholtz",
                  "dam_break", "cavity", "impact"},
                 "what the run is compared with");
    table.real("theory.tolerance", w.theory_tolerance, "", above(0), "allowed difference");
    table.real("theory.frame_x", w.frame_x, "velocity", anything(),
               "velocity of the frame in which theory is stated");
    table.real("theory.frame_z", w.frame_z, "velocity", anything(), "along z");
    table.whole("theory.mode", w.mode, "", between(1, 4096), "followed wavelengths in length_x");

    table.group("output");
    table.real("output.fields_interval", w.fields_interval, "time", at_least(0),
               "time between fields files; 0: none");
    table.real("output.particles_interval", w.particles_interval, "time", at_least(0),
               "time between particles files; 0: none");
    table.flag("output.vtk", w.vtk, "also write .vti and .vtp for ParaView");
    table.whole("output.checkpoint_steps", w.checkpoint_steps, "", between(0, 1e9),
                "steps between checkpoints; 0: only when stopped");

    table.renamed({{"flip.most_iterations", "flip.max_iterations"},
                   {"rezone.fewest", "rezone.min_particles"},
                   {"rezone.most", "rezone.max_particles"}});
    table.may_change_on_restart({"time.end", "output.fields_interval", "output.particles_interval",
                                 "output.vtk", "output.checkpoint_steps"});
    return table;
}

}  // namespace flip
