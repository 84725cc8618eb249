// What a case file of either material point program says about the problem itself: mesh, walls,
// materials, grains, packs, bonds, contact, loads. How it is solved is each program's own business.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"
#include "mpm_explicit/contact/detect_contact.hpp"
#include "mpm_explicit/grains/apply_loads.hpp"
#include "mpm_explicit/grains/materials.hpp"
#include "mpm_explicit/grid/mesh.hpp"

namespace mpm {

/// A material by name.
struct MaterialCase {
    std::string name, law = "elastic";
    Material material;
};

/// One grain by name; lengths in the unit of the mesh, angles in degrees.
struct GrainCase {
    std::string name;
    std::string shape = "disk";  // or box, polygon
    double x = 0, y = 0;         // center
    double radius = 0.1, width = 0.2, height = 0.2, angle = 0;
    long sides = 6;
    std::string vertices;
    std::string material = "default";
    double velocity_x = 0, velocity_y = 0, spin = 0;
    std::string profile = "none";  // or bar, wave: of the velocity along x
    double amplitude = 0;
    long mode = 1;
    double stop = 0, swing_x = 0, swing_y = 0, period = 1;
    std::string table;                 // path
    std::string control = "velocity";  // or force_x, force_y
    double force = 0, damping = 0;
};

/// Many grains at once; named <pack>_<number>.
struct PackCase {
    std::string name;
    std::string kind = "hexagonal";  // or random, loose, file
    std::string file;
    double x = 0, y = 0;  // hexagonal: center of the first; random, loose: lower left of the region
    double width = 1, height = 1;
    long columns = 5, rows = 4, count = 100, seed = 1;
    double radius = 0.1, radius_min = 0.05, radius_max = 0.1;
    double spacing_x = 0, spacing_y = 0, gap = 0;
    bool shorter_rows = true;  // hexagonal: every other row has one grain less
    long sides = 0;            // 0: disks
    std::string material = "default";
    double velocity_x = 0, velocity_y = 0, shear_rate = 0;
};

/// Grains that hold together, by name.
struct BondCase {
    std::string name;
    std::string a = "*", b = "*";
    double tension = 1e30, shear = 1e30;
};

/// Friction between two materials, by name.
struct PairCase {
    std::string name;
    std::string a = "default", b = "default";
    double friction = 0;
};

/// What is solved; the words are those of the case file.
struct Problem {
    long cells_x = 48, cells_y = 24;
    double length_x = 1.2, origin_x = 0, origin_y = 0;
    bool periodic_x = false;
    std::array<std::string, 4> walls{"open", "open", "open", "open"};
    long per_side = 2;

    std::vector<MaterialCase> materials;
    std::vector<GrainCase> grains;
    std::vector<PackCase> packs;
    std::vector<BondCase> bonds;
    std::vector<PairCase> pairs;
    ContactRule contact;

    double gravity_x = 0, gravity_y = 0, damping = 0, rise = 0;

    /// What acts on every grain and plate.
    Loads loads() const { return {gravity_x, gravity_y, damping, rise}; }
    /// Coulomb's coefficient between grains of two materials, by name.
    double friction_between(const std::string& a, const std::string& b) const {
        for (const PairCase& pair : pairs)
            if ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a)) return pair.friction;
        return contact.friction;
    }
    /// Whether anything can rub.
    bool has_friction() const {
        return contact.friction > 0 || contact.wall_friction > 0 ||
               std::any_of(pairs.begin(), pairs.end(),
                           [](auto& pair) { return pair.friction > 0; });
    }
    /// The mesh with its walls.
    Mesh mesh() const {
        Mesh m;
        m.cells_x = cells_x, m.cells_y = cells_y;
        m.h = length_x / double(cells_x);
        m.x_low = origin_x, m.y_low = origin_y, m.periodic_x = periodic_x;
        for (std::size_t k = 0; k < 4; ++k)
            m.boundary[k] = walls[k] == "slip"         ? Boundary::slip
                            : walls[k] == "stick"      ? Boundary::stick
                            : walls[k] == "frictional" ? Boundary::frictional
                                                       : Boundary::open;
        return m;
    }
};

namespace detail {

// Each of these binds the parameters of one item of a list.
inline void describe_material(common::ParameterTable& table, const std::string& prefix,
                              MaterialCase& m) {
    using common::above, common::at_least, common::between;
    const std::string at = prefix + ".";
    table.choice(at + "law", m.law, {"elastic", "j2", "drucker_prager", "rigid"},
                 "how stress answers strain; rigid: not at all, the grain moves as it is told");
    table.real(at + "E", m.material.E, "stress", above(0), "Young's modulus");
    table.real(at + "nu", m.material.nu, "", between(-0.99, 0.495), "Poisson's ratio");
    table.real(at + "density", m.material.density, "mass/volume", above(0), "at the start");
    table.real(
        at + "viscosity", m.material.viscosity, "time", at_least(0),
        "beta of a stress beta T : de/dt (Kelvin-Voigt); leapfrog takes shorter steps with it");
    table.real(at + "yield_stress", m.material.yield_stress, "stress", above(0), "j2: in tension");
    table.real(at + "hardening", m.material.hardening, "stress", at_least(0),
               "j2: rise of the yield stress per plastic strain");
    table.real(at + "cohesion", m.material.cohesion, "stress", at_least(0), "drucker_prager");
    table.real(at + "friction_angle", m.material.friction_angle, "degree", between(0, 60),
               "drucker_prager: of the Mohr-Coulomb law it matches in plane strain");
    table.real(at + "dilatancy_angle", m.material.dilatancy_angle, "degree", between(0, 60),
               "drucker_prager: 0 keeps the volume when it flows");
    table.real(at + "tension", m.material.tension, "stress", at_least(0),
               "drucker_prager: largest mean stress");
}

inline void describe_grain(common::ParameterTable& table, const std::string& prefix, GrainCase& g) {
    using common::above, common::anything, common::at_least, common::between;
    const std::string at = prefix + ".";
    table.choice(at + "shape", g.shape, {"disk", "box", "polygon"}, "outline");
    table.real(at + "x", g.x, "length", anything(), "center");
    table.real(at + "y", g.y, "length", anything(), "center");
    table.real(at + "radius", g.radius, "length", above(0), "of a disk or a polygon's corners");
    table.real(at + "width", g.width, "length", above(0), "of a box");
    table.real(at + "height", g.height, "length", above(0), "of a box");
    table.real(at + "angle", g.angle, "degree", anything(), "turns a box or a regular polygon");
    table.whole(at + "sides", g.sides, "", between(3, 64), "of a regular polygon");
    table.text(
        at + "vertices", g.vertices,
        "polygon: \"x y, x y, x y ...\"; empty: a regular one; many corners: pack.<name>.file");
    table.text(at + "material", g.material, "name of its material");
    table.real(at + "velocity_x", g.velocity_x, "velocity", anything(), "at start; rigid: always");
    table.real(at + "velocity_y", g.velocity_y, "velocity", anything(), "at start; rigid: always");
    table.real(at + "spin", g.spin, "1/time", anything(), "about the center, counterclockwise");
    table.choice(at + "profile", g.profile, {"none", "bar", "wave"},
                 "of v_x along its length L: amplitude sin((n - 1/2) pi s/L), sin(n pi s/L)");
    table.real(at + "amplitude", g.amplitude, "velocity", anything(), "of the profile");
    table.whole(at + "mode", g.mode, "", between(1, 1000), "n of the profile");
    table.real(at + "stop", g.stop, "time", at_least(0),
               "rigid: when its velocity begins to end, smoothly as it rose; 0: never");
    table.real(at + "swing_x", g.swing_x, "length", anything(),
               "rigid: adds swing sin^2(pi t/period) to its travel");
    table.real(at + "swing_y", g.swing_y, "length", anything(), "the same along y");
    table.real(at + "period", g.period, "time", above(0), "of the swing");
    table.text(at + "table", g.table,
               "rigid: file with a time, a travel along x and, if any, one along y in each line");
    table.choice(at + "control", g.control, {"velocity", "force_x", "force_y"},
                 "rigid: prescribed velocity, or force control in one direction");
    table.real(at + "force", g.force, "force", anything(),
               "force control: on the grain, besides which no gravity acts on it");
    table.real(at + "damping", g.damping, "force/velocity", at_least(0), "force control: dashpot");
}

inline void describe_pack(common::ParameterTable& table, const std::string& prefix, PackCase& p) {
    using common::above, common::anything, common::at_least, common::between;
    const std::string at = prefix + ".";
    table.choice(at + "kind", p.kind, {"hexagonal", "random", "loose", "file"},
                 "rows; random sizes, each at rest on others (polygons, in such disks); scattered "
                 "without touching; a file");
    table.text(at + "file", p.file,
               "file: of lines disk NAME X Y RADIUS, polygon NAME X1 Y1 X2 Y2 ...");
    table.real(at + "x", p.x, "length", anything(), "hexagonal: first center; else left of region");
    table.real(at + "y", p.y, "length", anything(), "hexagonal: first center; else its floor");
    table.real(at + "width", p.width, "length", above(0), "of the region");
    table.real(at + "height", p.height, "length", above(0), "of the region");
    table.whole(at + "columns", p.columns, "", between(1, 10000), "hexagonal: grains in first row");
    table.whole(at + "rows", p.rows, "", between(1, 10000), "hexagonal");
    table.real(at + "radius", p.radius, "length", above(0), "hexagonal");
    table.real(at + "spacing_x", p.spacing_x, "length", at_least(0), "hexagonal; 0: two radii");
    table.real(at + "spacing_y", p.spacing_y, "length", at_least(0), "of rows; 0: they touch");
    table.flag(at + "shorter_rows", p.shorter_rows,
               "hexagonal: every other row has one grain less; else it is shifted");
    table.whole(at + "count", p.count, "", between(1, 100000), "random, loose: grains");
    table.real(at + "radius_min", p.radius_min, "length", above(0), "random, loose");
    table.real(at + "radius_max", p.radius_max, "length", above(0), "random, loose");
    table.real(at + "gap", p.gap, "length", at_least(0), "random, loose: kept between grains");
    table.whole(at + "seed", p.seed, "", between(0, 1e9), "another number, another pack");
    table.whole(at + "sides", p.sides, "", between(0, 64), "polygons with so many sides; 0: disks");
    table.text(at + "material", p.material, "name of its material");
    table.real(at + "velocity_x", p.velocity_x, "velocity", anything(), "at start; rigid: always");
    table.real(at + "velocity_y", p.velocity_y, "velocity", anything(), "at start; rigid: always");
    table.real(at + "shear_rate", p.shear_rate, "1/time", anything(),
               "adds shear_rate times the height of a grain's center above y to its v_x");
}

inline void describe_bond(common::ParameterTable& table, const std::string& prefix, BondCase& b) {
    const std::string at = prefix + ".";
    table.text(at + "a", b.a, "name of a grain; *: any that touches");
    table.text(at + "b", b.b, "name of the other; *: any that touches");
    table.real(at + "tension", b.tension, "stress", common::above(0), "strength against opening");
    table.real(at + "shear", b.shear, "stress", common::above(0), "strength against sliding");
}

inline void describe_pair(common::ParameterTable& table, const std::string& prefix, PairCase& p) {
    const std::string at = prefix + ".";
    table.text(at + "a", p.a, "name of a material");
    table.text(at + "b", p.b, "name of the other, or the same");
    table.real(at + "friction", p.friction, "", common::at_least(0), "Coulomb's coefficient");
}

}  // namespace detail

/// Adds the parameters of the problem to a program's table.
inline void describe_problem(common::ParameterTable& table, Problem& problem) {
    using common::above, common::anything, common::at_least, common::between;
    table.group("mesh: square cells in the plane (x, y), plane strain");
    table.whole("grid.cells_x", problem.cells_x, "", between(2, 16384), "cells along x");
    table.whole("grid.cells_y", problem.cells_y, "", between(2, 16384), "cells along y");
    table.real("grid.length_x", problem.length_x, "length", above(0), "length along x");
    table.real("grid.low_x", problem.origin_x, "length", anything(), "left end");
    table.real("grid.low_y", problem.origin_y, "length", anything(), "lower end");
    table.flag("grid.periodic_x", problem.periodic_x, "the left end is the right one");
    table.whole("grid.particles_per_side", problem.per_side, "", between(1, 16),
                "particles in a cell at the start, along each side");

    table.group("walls, on the outermost lines of nodes");
    const std::array<const char*, 4> ends{"x_low", "x_high", "y_low", "y_high"};
    for (std::size_t k = 0; k < 4; ++k)
        table.choice(
            "boundary." + std::string(ends[k]), problem.walls[k],
            {"open", "slip", "stick", "frictional"},
            "nothing; roller or clamp of what touches it at the start; pushes back and rubs");
    table.real("boundary.friction", problem.contact.wall_friction, "", at_least(0),
               "Coulomb's coefficient, of frictional walls");

    table.group("contact between grains");
    table.real("contact.friction", problem.contact.friction, "", at_least(0),
               "Coulomb's coefficient, of materials that no [pair.<name>] has");
    table.real(
        "contact.separation", problem.contact.separation, "h", between(0, 2),
        "grains press when their surfaces are nearer; 0: on approach only, a cell too early");

    table.group("loads");
    table.real("load.gravity_x", problem.gravity_x, "acceleration", anything(), "along x");
    table.real("load.gravity_y", problem.gravity_y, "acceleration", anything(), "along y");
    table.real("load.damping", problem.damping, "1/time", at_least(0),
               "c: velocities fall by exp(-c t), in mpm_explicit those of nodes");
    table.real("load.rise", problem.rise, "time", at_least(0),
               "gravity and rigid grains reach their full value smoothly in this time");

    table.list("material", problem.materials, detail::describe_material,
               "a material, [material.<name>]; 'default' is there without being named");
    table.list("grain", problem.grains, detail::describe_grain, "a grain, [grain.<name>]");
    table.list("pack", problem.packs, detail::describe_pack, "many grains, [pack.<name>]");
    table.list("bond", problem.bonds, detail::describe_bond,
               "grains that hold together, [bond.<name>]");
    table.list("pair", problem.pairs, detail::describe_pair,
               "friction between two materials, [pair.<name>]");
}

}  // namespace mpm
