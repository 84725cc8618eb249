// The grains of a case before they are filled with particles: outlines, materials, how they start.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "mpm_explicit/grains/grains.hpp"
#include "mpm_explicit/grains/material_laws.hpp"
#include "mpm_explicit/setup/fill_grain.hpp"
#include "mpm_explicit/setup/pack_file.hpp"
#include "mpm_explicit/setup/packs.hpp"
#include "mpm_explicit/setup/problem.hpp"
#include "mpm_explicit/setup/travel_file.hpp"

namespace mpm {

/// A grain before it is filled with particles.
struct PlannedGrain {
    std::string name;
    Outline outline;
    int material = 0;
    GrainCase from;                // velocities, profile, control
    std::vector<TravelRow> table;  // that a rigid grain follows
};

/// Materials in the order of the case; with 'default' at the end when grains use it unnamed.
inline std::vector<Material> materials_of(const Problem& problem) {
    std::vector<Material> materials;
    for (const MaterialCase& m : problem.materials) {
        materials.push_back(m.material);
        materials.back().name = m.name;
        materials.back().law = m.law == "j2"               ? Law::j2
                               : m.law == "drucker_prager" ? Law::drucker_prager
                               : m.law == "rigid"          ? Law::rigid
                                                           : Law::elastic;
    }
    const auto is_default = [](const Material& m) { return m.name == "default"; };
    if (std::none_of(materials.begin(), materials.end(), is_default)) {
        materials.emplace_back();
        materials.back().name = "default";
    }
    return materials;
}

/// The law of every material.
inline std::vector<AnyLaw> laws_of(const Problem& w) { return laws_of(materials_of(w)); }

namespace detail {

// The corners in a text "x y, x y, ...".
inline std::vector<Point> vertices_of(const std::string& name, const std::string& text) {
    std::vector<Point> points;
    std::istringstream corners(text);
    for (std::string corner; std::getline(corners, corner, ',');) {
        std::istringstream numbers(corner);
        Point p{};
        std::string rest;
        refuse(!(numbers >> p.x >> p.y) || (numbers >> rest),
               "grain." + name + ".vertices: '" + corner +
                   "' is not a corner: write \"x y, x y, x y\"");
        points.push_back(p);
    }
    return points;
}

// The outline of a named grain.
inline Outline outline_of(const GrainCase& g) {
    try {
        refuse(g.shape != "polygon" && !g.vertices.empty(),
               "vertices belong to shape = \"polygon\": set it, or take them out");
        if (g.shape == "disk") return disk(g.x, g.y, g.radius);
        if (g.shape == "box") return box(g.x, g.y, g.width, g.height, g.angle);
        if (g.vertices.empty()) return regular_polygon(g.x, g.y, g.radius, g.sides, g.angle);
        return polygon(vertices_of(g.name, g.vertices));
    } catch (const common::InputError& error) {
        throw common::InputError("[grain." + g.name + "]: " + error.what());
    }
}

// The travel that a named grain is told.
inline std::vector<TravelRow> table_of(const GrainCase& g) {
    try {
        return g.table.empty() ? std::vector<TravelRow>{} : read_travel(g.table);
    } catch (const common::InputError& error) {
        throw common::InputError("[grain." + g.name + "]: " + error.what());
    }
}

// The grains of a pack.
inline std::vector<PackedGrain> grains_of(const PackCase& p, const Problem& problem) {
    try {
        std::vector<PackedGrain> pack;
        refuse(p.kind != "file" && !p.file.empty(),
               "file belongs to kind = \"file\": set it, or take file out");
        if (p.kind == "file") {
            refuse(p.file.empty(), "kind = \"file\" needs the name of a file: set file");
            pack = read_pack(p.file);
        } else if (p.kind == "hexagonal") {
            Rows rows;
            rows.x = p.x, rows.y = p.y, rows.columns = p.columns, rows.rows = p.rows;
            rows.radius = p.radius, rows.gap = p.gap;
            rows.spacing_x = p.spacing_x, rows.spacing_y = p.spacing_y;
            rows.shift = p.spacing_x > 0 ? 0.5 * p.spacing_x : p.radius + 0.5 * p.gap;
            rows.one_less = p.shorter_rows;
            pack = hexagonal_rows(rows);
        } else {
            const double most_x = 100 * problem.mesh().length_x(),
                         most_y = 100 * problem.mesh().h * double(problem.cells_y);
            refuse(p.width > most_x || p.height > most_y,
                   "a region of " + format(p.width) + " by " + format(p.height) +
                       " is more than a hundred times the mesh: make it smaller");
            RandomDisks disks;
            disks.box = {p.x, p.x + p.width, p.y, p.y + p.height};
            disks.periodic_x = problem.periodic_x;
            disks.radius_min = p.radius_min, disks.radius_max = p.radius_max;
            disks.count = p.count, disks.gap = p.gap, disks.loose = p.kind == "loose";
            disks.seed = static_cast<std::uint64_t>(p.seed);
            pack = random_disks(disks);
        }
        return p.sides > 0 ? regular_polygons(pack, p.sides, static_cast<std::uint64_t>(p.seed))
                           : pack;
    } catch (const common::InputError& error) {
        throw common::InputError("[pack." + p.name + "]: " + error.what());
    }
}

}  // namespace detail

/// Whether disks may touch a plate between two columns of nodes, as they do where they roll.
/// in:   dt of a long step, or 0
/// note: A point between two columns shares its load P by their gaps, a step late: a spring 2 P/k, with
///       k = h^2/R, on the mass rho h^2 of a column. A disk that is pressed or thrown would swing about the
///       point, and lose its load and its speed. So in long steps there are points for one grain alone
///       that starts at rest, or across its weight, and on a plate at rest or a wall, where the step is
///       short enough for its weight.
inline bool may_touch_between_columns(const Problem& problem, double dt) {
    if (dt == 0) return true;
    const double weight = std::hypot(problem.gravity_x, problem.gravity_y);
    const bool down_y = std::fabs(problem.gravity_y) >= std::fabs(problem.gravity_x);
    const auto is_rigid = [&](const GrainCase& g) {
        return std::ranges::any_of(problem.materials, [&](const MaterialCase& m) {
            return m.name == g.material && m.law == "rigid";
        });
    };
    for (const GrainCase& g : problem.grains) {
        const bool along =
            !is_rigid(g) && weight > 0 && (down_y ? g.velocity_y : g.velocity_x) == 0;
        if ((!along && (g.velocity_x != 0 || g.velocity_y != 0)) || g.swing_x != 0 ||
            g.swing_y != 0 || !g.table.empty() || g.control != "velocity")
            return false;
    }
    if (!problem.packs.empty() ||
        std::ranges::count_if(problem.grains, is_rigid) + 1 != std::ssize(problem.grains))
        return false;
    GrainCase near = *std::ranges::find_if_not(problem.grains, is_rigid);
    const Mesh mesh = problem.mesh();
    const double h = mesh.h, R = near.radius;
    if (2 * std::numbers::pi * weight * std::pow(R, 3) * dt * dt > std::pow(h, 4)) return false;
    // What falls on a plate is thrown.
    near.radius += 0.1 * h;
    const Outline outline = detail::outline_of(near);
    const auto [x_low, x_high, y_low, y_high] = bounds(outline);
    return x_low < mesh.x_low || y_low < mesh.y_low || x_high > mesh.x_high() ||
           y_high > mesh.y_high() || std::ranges::any_of(problem.grains, [&](const GrainCase& g) {
               return is_rigid(g) && overlap_depth(outline, detail::outline_of(g)) > 0;
           });
}

/// The rule of contact, with the friction of every pair of materials.
/// in:     dt, 0 for leapfrog. In long steps surfaces that will touch within half of one press already.
/// errors: InputError for a material that is not there, or two whose friction is told twice
inline ContactRule contact_rule(const Problem& problem, double dt = 0) {
    ContactRule rule = problem.contact;
    rule.ahead = 0.5 * dt;
    rule.points = may_touch_between_columns(problem, dt);
    if (problem.pairs.empty()) return rule;
    const std::vector<Material> materials = materials_of(problem);
    for (const PairCase& pair : problem.pairs) {
        const std::string place = "[pair." + pair.name + "]: ";
        for (const std::string& name : {pair.a, pair.b})
            refuse(std::none_of(materials.begin(), materials.end(),
                                [&](const Material& m) { return m.name == name; }),
                   place + "there is no [material." + name + "]; add it, or name another material");
        for (const PairCase* other = problem.pairs.data(); other != &pair; ++other)
            refuse(std::minmax(other->a, other->b) == std::minmax(pair.a, pair.b),
                   place + "'" + pair.a + "' and '" + pair.b + "' are in [pair." + other->name +
                       "], too: take one out");
    }
    for (const Material& a : materials)
        for (const Material& b : materials)
            rule.between.push_back(problem.friction_between(a.name, b.name));
    return rule;
}

/// All grains of a case: the named ones, then those of packs, called <pack>_<name>.
/// errors: InputError for an unknown material, or an outline, a pack or a table that cannot be
inline std::vector<PlannedGrain> plan_grains(const Problem& problem,
                                             const std::vector<Material>& materials) {
    const auto material_of = [&](const std::string& name, const std::string& whose) {
        for (std::size_t k = 0; k < materials.size(); ++k)
            if (materials[k].name == name) return int(k);
        throw common::InputError("[" + whose + "]: there is no [material." + name +
                                 "]; add it, or name another material");
    };
    std::vector<PlannedGrain> grains;
    for (const GrainCase& g : problem.grains)
        grains.push_back({g.name, detail::outline_of(g), material_of(g.material, "grain." + g.name),
                          g, detail::table_of(g)});
    for (const PackCase& p : problem.packs) {
        const int material = material_of(p.material, "pack." + p.name);
        for (const PackedGrain& packed : detail::grains_of(p, problem)) {
            GrainCase from;
            from.velocity_x = p.velocity_x + p.shear_rate * (packed.outline.y - p.y);
            from.velocity_y = p.velocity_y;
            grains.push_back({p.name + "_" + packed.name, packed.outline, material, from, {}});
        }
    }
    return grains;
}

/// What makes the mass matrix regular in a sharp corner.
inline constexpr const char* sharp_corner_cure =
    "take grid.particles_per_side = 3, or blunt the corner";

/// The sharpest corner of the grains that can be strained, where it is below 20 degrees and has two particles along
/// the side of a cell or fewer, in words; empty where there is none. As measured from 5 to 45 degrees: particles
/// are fewer than nodes in such a corner, and up to 16 degrees the consistent mass matrix may be nearly singular;
/// with three it is not at 3 degrees.
inline std::string sharp_corner(const Problem& problem, const std::vector<PlannedGrain>& plans,
                                const std::vector<Material>& materials) {
    double sharpest = 20;
    std::string words;
    if (problem.per_side > 2) return words;
    for (const PlannedGrain& plan : plans) {
        if (materials[plan.material].law == Law::rigid || plan.outline.corners.empty()) continue;
        const double angle = sharpest_corner(plan.outline.corners);
        if (!(angle < sharpest)) continue;
        sharpest = angle;
        words = "the corner of " + format(angle) + " degrees of grain '" + plan.name + "'";
    }
    return words;
}

}  // namespace mpm
