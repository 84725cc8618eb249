// What is refused before a run of mpm_explicit starts, and what is warned of; mpm_implicit
// adds what only it asks for.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mpm_explicit/setup/case.hpp"
#include "mpm_explicit/setup/plate_strain.hpp"
#include "mpm_explicit/setup/scales.hpp"

namespace mpm {

namespace detail {

constexpr std::size_t longest_pack_name = 40;  // that write_pack() takes

// Refuses a grain that its mesh cannot carry, or whose parameters contradict each other.
inline void refuse_grain(const PlannedGrain& plan, const Material& material, const Mesh& mesh,
                         long per_side) {
    const std::string grain = "grain '" + plan.name + "'";
    const double thin = thinnest(plan.outline);
    refuse(thin < 2 * mesh.h * (1 - 1e-9),
           grain + " is " + format(thin / mesh.h) +
               " cells thin, below 2: refine the mesh to cells of at most " + format(0.5 * thin) +
               ", or take a larger grain");
    const Bounds box = bounds(plan.outline),
                 room{mesh.x_low, mesh.x_high(), mesh.y_low, mesh.y_high()};
    const auto corners = [](const Bounds& at) {
        return "from (" + format(at.x_low) + ", " + format(at.y_low) + ") to (" +
               format(at.x_high) + ", " + format(at.y_high) + ")";
    };
    const double slack = 1e-9 * mesh.h;
    refuse(box.y_low < room.y_low - slack || box.y_high > room.y_high + slack ||
               (!mesh.periodic_x &&
                (box.x_low < room.x_low - slack || box.x_high > room.x_high + slack)),
           grain + " reaches " + corners(box) + ", beyond the mesh " + corners(room) +
               ": move the grain or widen the mesh");
    const double length = mesh.length_x();
    refuse(mesh.periodic_x && box.x_high - box.x_low > length + slack,
           grain + " is longer than the periodic mesh: shorten it to " + format(length));
    refuse(
        mesh.periodic_x && (box.x_low < mesh.x_low - length || box.x_high > mesh.x_high() + length),
        grain + " reaches from x = " + format(box.x_low) + " to " + format(box.x_high) +
            ", more than its length of " + format(length) +
            " beyond the periodic mesh: move it by whole lengths");
    // What is two cells wide may still be a thin angle.
    const double side = mesh.h / double(per_side);
    const auto is_thin = [&] {
        for (const FilledPlace& p : fill(plan.outline, mesh, per_side))
            if (p.volume >= 0.25 * side * side) return false;
        return true;
    };
    refuse(plan.outline.kind == OutlineKind::polygon && area(plan.outline) < 1e4 * side * side &&
               is_thin(),
           grain +
               " is so thin that it fills no quarter of what a particle stands for: refine the "
               "mesh, or make it wider");
    const bool rigid = material.law == Law::rigid;
    refuse(!rigid && plan.from.control != "velocity", grain + " has control = \"" +
                                                          plan.from.control +
                                                          "\" and is not rigid: give it a "
                                                          "material with law = \"rigid\"");
    refuse(!rigid && (plan.from.stop != 0 || plan.from.swing_x != 0 || plan.from.swing_y != 0 ||
                      !plan.table.empty()),
           grain +
               " has stop, swing or table and is not rigid: give it a material with law = "
               "\"rigid\"");
    refuse(rigid && (plan.from.spin != 0 || plan.from.profile != "none"),
           grain + " is rigid and moves without turning: take out spin and profile");
    refuse(plan.from.profile != "none" && plan.from.shape != "box",
           grain + " has a profile of its velocity, which is for boxes: set shape = \"box\"");
}

}  // namespace detail

/// Refuses combinations that cannot run.
/// errors: InputError with the numbers and the cure
inline void validate(const Case& parameters) {
    common::require_formats(parameters.also);
    const Problem& problem = parameters.problem;
    const Mesh mesh = problem.mesh();
    refuse(parameters.energy_limit > 0 && parameters.energy_limit <= 1,
           "time.energy_limit = " + format(parameters.energy_limit) +
               " is what a run begins with: raise it above 1, or set 0 for none");
    const double far = std::max(std::fabs(mesh.x_low), std::fabs(mesh.y_low)) / mesh.h;
    refuse(far > 1e9, "the mesh begins " + format(far) +
                          " cells from the origin, more than 1e9, where places are lost to "
                          "round-off: move grid.low_x and low_y nearer to 0");
    for (const Side side : {x_low, x_high})
        refuse(problem.periodic_x && problem.walls[side] != "open",
               "grid.periodic_x = true leaves no walls at the ends of x: set boundary.x_low and "
               "boundary.x_high to \"open\"");
    refuse(problem.periodic_x && problem.cells_x < 8,
           "grid.cells_x = " + std::to_string(problem.cells_x) +
               " is too few for a periodic mesh: take at least 8");
    const std::vector<Material> materials = materials_of(problem);
    const std::vector<PlannedGrain> plans = plan_grains(problem, materials);
    refuse(plans.empty(), "there is no grain: add a [grain.<name>] or a [pack.<name>]");
    for (const Material& m : materials)
        refuse(m.law == Law::drucker_prager && m.dilatancy_angle > m.friction_angle,
               "[material." + m.name + "]: dilatancy_angle = " + format(m.dilatancy_angle) +
                   " is above friction_angle = " + format(m.friction_angle) +
                   ": flow would make energy; take at most the friction angle");
    std::set<std::string> names;
    bool moves = false;
    for (const PlannedGrain& plan : plans) {
        const Material& material = materials[plan.material];
        refuse(!names.insert(plan.name).second,
               "two grains are called '" + plan.name + "': rename one of them");
        refuse(parameters.pack && plan.name.size() > detail::longest_pack_name,
               "grain '" + plan.name + "' has a name of " + std::to_string(plan.name.size()) +
                   " letters, and pack.txt takes " + std::to_string(detail::longest_pack_name) +
                   ": shorten it, or set output.pack = false");
        detail::refuse_grain(plan, material, mesh, problem.per_side);
        moves = moves || material.law != Law::rigid;
    }
    refuse(!moves, "all grains are rigid: give one a material that can be strained");

    std::vector<PackedGrain> outlines;
    for (const PlannedGrain& plan : plans) outlines.push_back({plan.name, plan.outline});
    const Overlap worst =
        overlaps(outlines, problem.periodic_x ? mesh.length_x() : 0, 1e-6 * mesh.h);
    refuse(worst.depth > 0, "grains '" + worst.first + "' and '" + worst.second + "' overlap by " +
                                format(worst.depth) + ", " + format(worst.depth / mesh.h) +
                                " cells: move them apart or make them smaller");
    (void)bonds_of(problem, plans, materials);
    (void)contact_rule(problem);
    const double pixels = double(problem.cells_x * parameters.pixels_per_cell) *
                          double(problem.cells_y * parameters.pixels_per_cell);
    refuse(parameters.fringes_interval > 0 && pixels > 5e7,
           "output.pixels_per_cell = " + std::to_string(parameters.pixels_per_cell) +
               " makes rasters of " + format(pixels) + " pixels, more than 5e7: take fewer");
}

/// The shortest side of a polygon that meets another one at an obtuse corner, of 100 to 170 degrees; infinite
/// without such corners.
inline double shortest_base(const Outline& outline) {
    const std::vector<Point>& at = outline.corners;
    const std::size_t n = at.size();
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < n; ++k) {
        const Point &before = at[(k + n - 1) % n], &after = at[(k + 1) % n];
        const double ax = at[k].x - before.x, ay = at[k].y - before.y, bx = after.x - at[k].x,
                     by = after.y - at[k].y, a = std::hypot(ax, ay), b = std::hypot(bx, by),
                     turn = std::fabs(std::atan2(ax * by - ay * bx, ax * bx + ay * by));
        if (turn > std::numbers::pi / 18 && turn < std::numbers::pi * 8 / 18)
            shortest = std::min({shortest, a, b});
    }
    return shortest;
}

/// Warnings of rollers and clamps that a grain may come to, unless bonds hold it away: they hold nodes, and so
/// what touches them.
inline std::vector<std::string> arrival_warnings(const Problem& problem,
                                                 const std::vector<Material>& materials,
                                                 const std::vector<PlannedGrain>& plans) {
    std::vector<std::string> warnings;
    const Mesh mesh = problem.mesh();
    const std::array<const char*, 4> names{"x_low", "x_high", "y_low", "y_high"};
    for (const Side side : {x_low, x_high, y_low, y_high}) {
        if (problem.walls[side] != "slip" && problem.walls[side] != "stick") continue;
        const bool along_x = side == x_low || side == x_high, low = side == x_low || side == y_low;
        double farthest = 0;
        for (const PlannedGrain& plan : plans) {
            const Bounds box = bounds(plan.outline);
            const double away = side == x_low    ? box.x_low - mesh.x_low
                                : side == x_high ? mesh.x_high() - box.x_high
                                : side == y_low  ? box.y_low - mesh.y_low
                                                 : mesh.y_high() - box.y_high,
                         g = along_x ? problem.gravity_x : problem.gravity_y,
                         v = along_x ? plan.from.velocity_x : plan.from.velocity_y;
            if (materials[plan.material].law != Law::rigid &&
                (low ? g < 0 || v < 0 : g > 0 || v > 0))
                farthest = std::max(farthest, away / mesh.h);
        }
        if (farthest > 0.5 && problem.bonds.empty())
            warnings.push_back(std::string("boundary.") + names[side] + " = \"" +
                               problem.walls[side] +
                               "\" holds for good what comes near, a cell too early, and a grain "
                               "begins " +
                               format(farthest) +
                               " cells from it: take \"frictional\", "
                               "with boundary.friction = 0 where it is smooth");
    }
    return warnings;
}

/// Warnings of materials and pairs that no grain is of: their names may be misspelt.
inline std::vector<std::string> unused_warnings(const Problem& problem,
                                                const std::vector<Material>& materials,
                                                const std::vector<PlannedGrain>& plans) {
    std::vector<std::string> warnings;
    const auto is_used = [&](const std::string& name) {
        return std::ranges::any_of(
            plans, [&](const PlannedGrain& plan) { return materials[plan.material].name == name; });
    };
    for (const MaterialCase& m : problem.materials)
        if (!is_used(m.name))
            warnings.push_back("material." + m.name + " is nowhere: no grain is of it");
    for (const PairCase& pair : problem.pairs)
        if (!is_used(pair.a) || !is_used(pair.b))
            warnings.push_back("pair." + pair.name + " is nowhere: no grain is of material '" +
                               (is_used(pair.a) ? pair.b : pair.a) + "'");
    return warnings;
}

/// Whether a side of an outline is level, along x or along y at a height, and ends at a place, each to within.
inline bool level_side_ends(const Outline& outline, bool along_x, double height, double place,
                            double within) {
    const auto meet = [&](double a, double b) { return std::fabs(a - b) < within; };
    const std::vector<Point>& at = outline.corners;
    for (std::size_t k = 0; k < at.size(); ++k) {
        const Point &p = at[k], &q = at[(k + 1) % at.size()];
        if (meet(along_x ? p.y : p.x, height) && meet(along_x ? q.y : q.x, height) &&
            (meet(along_x ? p.x : p.y, place) || meet(along_x ? q.x : q.y, place)))
            return true;
    }
    return false;
}

/// Warnings of rigid grains whose level sides abut, on the side on which weight presses. As measured: a block
/// without friction is stopped there, a disk keeps 0.88 of its velocity.
inline std::vector<std::string> seam_warnings(const Problem& problem,
                                              const std::vector<Material>& materials,
                                              const std::vector<PlannedGrain>& plans) {
    std::vector<std::string> warnings;
    const double within = 0.1 * problem.mesh().h;
    const auto is_rigid = [&](const PlannedGrain& plan) {
        return materials[plan.material].law == Law::rigid;
    };
    if (std::ranges::all_of(plans, is_rigid)) return warnings;
    for (const PlannedGrain& a : plans) {
        for (const PlannedGrain& b : plans) {
            if (!is_rigid(a) || !is_rigid(b)) continue;
            const Bounds one = bounds(a.outline), two = bounds(b.outline);
            for (const bool along_x : {true, false}) {
                const double g = along_x ? problem.gravity_y : problem.gravity_x,
                             end = along_x ? one.x_high : one.y_high,
                             begin = along_x ? two.x_low : two.y_low;
                const auto both = [&](double of_one, double of_two) {
                    return std::fabs(of_one - of_two) < within &&
                           level_side_ends(a.outline, along_x, of_one, end, within) &&
                           level_side_ends(b.outline, along_x, of_two, end, within);
                };
                const bool above = along_x ? both(one.y_high, two.y_high)
                                           : both(one.x_high, two.x_high),
                           below =
                               along_x ? both(one.y_low, two.y_low) : both(one.x_low, two.x_low);
                if (std::fabs(end - begin) < within && ((g <= 0 && above) || (g >= 0 && below)))
                    warnings.push_back(
                        "rigid grains '" + a.name + "' and '" + b.name + "' abut at " +
                        (along_x ? "x = " : "y = ") + format(end) +
                        ": what slides over the seam is stopped or slowed by their ends; "
                        "make one grain of them");
            }
        }
    }
    return warnings;
}

/// The viscosity with which no block flutters that friction holds, as measured with coefficients up to 1.5: a part
/// of the time in which sound crosses where it is thinnest.
inline double steadying_viscosity(const Outline& outline, const Material& material) {
    return 0.6 * width(outline.corners) / sound_speed(material);
}

/// Warnings of friction that nodes do not hold as they should, as measured: of blocks that it holds on slopes of 34
/// degrees and more, and of disks that slip beside surfaces at an angle to the mesh.
inline std::vector<std::string> friction_warnings(const Problem& problem,
                                                  const std::vector<Material>& materials,
                                                  const std::vector<PlannedGrain>& plans) {
    std::vector<std::string> warnings;
    double most = std::max(problem.contact.friction, problem.contact.wall_friction);
    for (const PairCase& pair : problem.pairs) most = std::max(most, pair.friction);
    const bool pulled = problem.gravity_x != 0 || problem.gravity_y != 0;
    const auto is_rigid = [&](const PlannedGrain& plan) {
        return materials[plan.material].law == Law::rigid;
    };
    const auto is_disk = [&](const PlannedGrain& plan) {
        return !is_rigid(plan) && plan.outline.kind == OutlineKind::disk;
    };
    double least = 0;  // viscosity that is too low somewhere
    for (const PlannedGrain& plan : plans) {
        const Material& material = materials[plan.material];
        if (is_rigid(plan) || is_disk(plan)) continue;
        const double steady = steadying_viscosity(plan.outline, material);
        if (material.viscosity < 0.8 * steady) least = std::max(least, steady);
    }
    if (pulled && most > 0.65 && least > 0)
        warnings.push_back(
            "friction of " + format(most) +
            ", above 0.65: a block that it holds near the angle of friction flutters without "
            "viscosity and may slide; set material.<name>.viscosity = " +
            format(least) + (most > 1.5 ? ", which above 1.5 may not do" : ""));
    const auto is_turned = [&](const PlannedGrain& plan) {
        const std::vector<Point>& at = plan.outline.corners;
        for (std::size_t k = 0; k < at.size() && is_rigid(plan); ++k) {
            const Point &a = at[k], &b = at[(k + 1) % at.size()];
            const double dx = std::fabs(b.x - a.x), dy = std::fabs(b.y - a.y);
            if (std::min(dx, dy) > 0.01 * std::max(dx, dy)) return true;
        }
        return false;
    };
    const auto turned = std::ranges::find_if(plans, is_turned);
    const bool has_surface =
        std::ranges::any_of(plans, is_rigid) || problem.contact.wall_friction > 0;
    if (!pulled || !(most > 0) || !has_surface || std::ranges::none_of(plans, is_disk))
        return warnings;
    const std::string little = "where it slips friction gives it too little spin, by a part of ";
    if (turned != plans.end())
        warnings.push_back(
            "a disk beside rigid grain '" + turned->name +
            "', with sides at an angle to the mesh: nodes hold it off its lowest "
            "point, and " +
            little +
            "up to 0.07 (mpm_implicit 0.1) over the coefficient; put the sides along "
            "the mesh and turn gravity, which leaves 0.01 where it is stiff");
    else if (most < 0.3)
        warnings.push_back("a disk on a rigid surface with friction of " + format(most) + ": " +
                           little +
                           "0.01 over the coefficient where it is stiff, and up to 0.05 "
                           "where weight flattens it");
    return warnings;
}

/// By how many cells a grain that will meet another body moves while sound crosses the smallest, beside the center of
/// mass of all, or what it hits; 0 where none meet, or faster than the laws are good for.
inline double cells_of_impact(const Problem& problem, const Scales& scales) {
    const std::vector<Material> materials = materials_of(problem);
    double m = 0, p_x = 0, p_y = 0, speed = 0, smallest = std::numeric_limits<double>::infinity();
    const std::vector<PlannedGrain> plans = plan_grains(problem, materials);
    const auto for_each_free = [&](const auto& visit) {
        for (const PlannedGrain& plan : plans)
            if (const Material& of = materials[plan.material]; of.law != Law::rigid)
                visit(plan, of.density * area(plan.outline));
    };
    for_each_free([&](const PlannedGrain& plan, double mass) {
        m += mass, p_x += mass * plan.from.velocity_x, p_y += mass * plan.from.velocity_y;
        smallest = std::min(smallest, 2 * plan.outline.radius);
    });
    for_each_free([&](const PlannedGrain& plan, double) {
        speed = std::max(
            speed, std::hypot(plan.from.velocity_x - p_x / m, plan.from.velocity_y - p_y / m));
    });
    const double closing = closing_speed(problem, plans, materials);
    return closing > 0 && scales.impact_speed <= 0.05 * scales.sound_speed
               ? std::max(speed, closing) * smallest / (scales.sound_speed * problem.mesh().h)
               : 0;
}

/// What to say of grains that move too many cells in a collision. As measured with disks of 4 to 24 cells in the
/// radius, of one density and of two.
inline std::string impact_warning(double cells, double limit, const std::string& part,
                                  const std::string& cure) {
    return "grains that meet move " + format(cells) + " cells while sound crosses one, above " +
           format(limit) +
           ": particles that cross lines of nodes leave a part of a rebound as vibration, " + part +
           ", and on finer meshes more; set " + cure;
}

/// Warns of rigid plates so thin that nodes within them see both of their sides, whose areas cancel. As measured with
/// sides off the lines of nodes: of two cells they let what they press in, with gimp from half a cell and with
/// quadratic shapes from a hundredth.
inline std::vector<std::string> thin_plate_warnings(const Case& parameters,
                                                    const std::vector<Material>& materials,
                                                    const std::vector<PlannedGrain>& plans) {
    std::vector<std::string> warnings;
    const Mesh mesh = parameters.problem.mesh();
    const double enough = parameters.shape == "gimp" ? 2.5 : parameters.shape == "linear" ? 2 : 3;
    for (const PlannedGrain& plan : plans) {
        const double thick = thinnest(plan.outline) / mesh.h;
        const Bounds box = bounds(plan.outline);
        const bool level = box.y_high - box.y_low < box.x_high - box.x_low;
        const auto is_off = [&](double side) {
            const double lines = (side - (level ? mesh.y_low : mesh.x_low)) / mesh.h;
            return std::fabs(lines - std::round(lines)) > 0.01;
        };
        if (materials[plan.material].law == Law::rigid && thick < enough * (1 - 1e-9) &&
            plan.outline.kind != OutlineKind::disk &&
            (!is_upright_box(plan.outline) || is_off(level ? box.y_low : box.x_low) ||
             is_off(level ? box.y_high : box.x_high)))
            warnings.push_back("rigid grain '" + plan.name + "' is " + format(thick) +
                               " cells thick, below " + format(enough) +
                               ": off the lines of nodes method.shape = \"" + parameters.shape +
                               "\" sees both of its sides at once, and it may let in what it "
                               "presses; make it thicker, or put its sides on lines");
    }
    return warnings;
}

/// Warnings with the number and the limit, for choices that run but may mislead.
inline std::vector<std::string> resolution_warnings(const Case& parameters, const Scales& scales) {
    std::vector<std::string> warnings;
    const Problem& problem = parameters.problem;
    const Mesh mesh = problem.mesh();
    const double g = std::hypot(problem.gravity_x, problem.gravity_y), t = parameters.end,
                 crossed = std::max((scales.sound_speed + scales.speed) * t, g * t * t) / mesh.h;
    if (t > 0 && crossed < 0.1)
        warnings.push_back("until time.end = " + format(t) + " sound crosses " + format(crossed) +
                           " cells, below 0.1: the run is over before anything happens; raise "
                           "time.end");
    if (const double last = double(scales.steps) * scales.dt; std::fabs(last - t) > 1e-9 * t)
        warnings.push_back("time.end = " + format(t) +
                           " is no whole number of steps of time.dt = " + format(scales.dt) +
                           ": the run ends at t = " + common::number_text(last));
    if (scales.impact_speed > 0.05 * scales.sound_speed)
        warnings.push_back("grains meet with " + format(scales.impact_speed / scales.sound_speed) +
                           " c_p (each of two with half of their closing speed), above 0.05: an "
                           "impact strains the grains by more than the small "
                           "strains of the material laws" +
                           (scales.impact_speed > scales.sound_speed
                                ? ", and faster than sound a grain passes into what it hits"
                                : ""));
    const double height = mesh.y_high() - mesh.y_low,
                 strain = g * height / (scales.sound_speed * scales.sound_speed);
    if (strain > 0.05)
        warnings.push_back("g H/c_p^2 = " + format(strain) +
                           " is above 0.05: grains at the bottom are crushed by the weight of a "
                           "full mesh; stiffen the material");
    if (problem.contact.separation == 0)
        warnings.push_back("contact.separation = 0: grains meet where they share nodes, up to " +
                           format(2 - 1 / double(problem.per_side)) + " cells too early");
    const std::vector<std::pair<const char*, double>> intervals{
        {"output.particles_interval", parameters.particles_interval},
        {"output.fringes_interval", parameters.fringes_interval},
        {"output.grains_interval", parameters.grains_interval}};
    for (const auto& [name, interval] : intervals)
        if (interval > 0 && interval < scales.dt)
            warnings.push_back(std::string(name) + " = " + format(interval) +
                               " is below the time step " + format(scales.dt) +
                               ": files are written every step");
    const std::vector<Material> materials = materials_of(problem);
    bool has_surface = mesh.has(y_low, Boundary::frictional) ||
                       mesh.has(x_low, Boundary::frictional) ||
                       mesh.has(x_high, Boundary::frictional);
    double least = std::numeric_limits<double>::infinity(),  // radius of what can roll
        base = least;                                        // side of what can topple
    const std::vector<PlannedGrain> plans = plan_grains(problem, materials);
    for (const PlannedGrain& plan : plans) {
        if (materials[plan.material].law == Law::rigid)
            has_surface = true;
        else if (plan.outline.kind == OutlineKind::disk)
            least = std::min(least, plan.outline.radius / mesh.h);
        else
            base = std::min(base, shortest_base(plan.outline) / mesh.h);
        if (plan.from.control == "velocity" && plan.from.force != 0)
            warnings.push_back("grain '" + plan.name +
                               "' has a force and control = \"velocity\": the force does nothing");
        const GrainCase& from = plan.from;
        if ((from.control == "force_x" && (from.velocity_x != 0 || from.swing_x != 0)) ||
            (from.control == "force_y" && (from.velocity_y != 0 || from.swing_y != 0)))
            warnings.push_back("grain '" + plan.name + "' has control = \"" + from.control +
                               "\" and a velocity or a swing in that direction: it does nothing, "
                               "the grain starts at rest");
    }
    for (const std::string& warning : unused_warnings(problem, materials, plans))
        warnings.push_back(warning);
    for (const std::string& warning : arrival_warnings(problem, materials, plans))
        warnings.push_back(warning);
    for (const std::string& warning : friction_warnings(problem, materials, plans))
        warnings.push_back(warning);
    // As measured: a block of 20 and 40 cells bears 8.5 and 4 per cent too much between two such plates; and of a
    // column of 8 and 16 cells below a plate that has sunk by less than a hundredth of a cell the last one does
    // not strain with gimp.
    const auto grips = [&](const Bond& bond) {
        return materials[plans[bond.a].material].law == Law::rigid ||
               materials[plans[bond.b].material].law == Law::rigid;
    };
    const auto is_rigid = [&](const PlannedGrain& plan) {
        return materials[plan.material].law == Law::rigid;
    };
    const auto is_flat = [&](const PlannedGrain& plan) {
        return !is_rigid(plan) && plan.outline.kind != OutlineKind::disk;
    };
    for (const std::string& warning : seam_warnings(problem, materials, plans))
        warnings.push_back(warning);
    for (const std::string& warning : thin_plate_warnings(parameters, materials, plans))
        warnings.push_back(warning);
    if (parameters.shape != "linear" &&
        std::ranges::any_of(bonds_of(problem, plans, materials), grips))
        warnings.push_back("method.shape = \"" + parameters.shape +
                           "\" sees a rigid grain that is bonded to another one from " +
                           (parameters.shape == "gimp" ? "a cell away once it is pressed in"
                                                       : "three quarters of a cell away") +
                           ", and what lies there does not strain: take \"linear\"");
    else if (parameters.shape == "quadratic" && std::ranges::any_of(plans, is_rigid) &&
             std::ranges::any_of(plans, is_flat))
        // As measured: 8 to 13 per cent, in five cases; the other shapes are right within 1, and so are disks.
        warnings.push_back(
            "method.shape = \"quadratic\" makes flat grains that a rigid one presses too soft, by "
            "a tenth: take \"gimp\" or \"linear\"");
    if (g > 0 && problem.has_friction() && base < 6)
        warnings.push_back(
            "a polygon has a side of " + format(base) +
            " cells, below 6, beside an obtuse corner: nodes know its ends to half a "
            "cell, and standing on it, it topples at a slope that may be " +
            format(100 / base) + " per cent off; refine the mesh");
    if (g > 0 && has_surface && problem.has_friction() && least < 12 * (1 - 1e-9))
        warnings.push_back(
            "a disk has a radius of " + format(least) +
            " cells, below 12: where it rolls on a rigid surface it loses speed to vibration, at "
            "U^2 = g R over eight radii 5 to 22 per cent with 4 cells and 4 to 10 with 8 (in "
            "mpm_explicit, "
            "least with method.transfer = \"spin\"), in mpm_implicit 1 to 6; a slow one loses a "
            "larger part");
    return warnings;
}

}  // namespace mpm

namespace mpm_explicit {

/// Refuses combinations that cannot run.
/// errors: InputError with the cure
inline void validate_explicit(const Case& parameters) {
    validate(parameters);
    const std::string transfer = "method.transfer = \"" + parameters.transfer + "\"";
    refuse(parameters.flip != 1 && parameters.transfers().flip != parameters.flip,
           transfer + " takes no part of FLIP: leave method.flip = 1");
    refuse(parameters.transfer == "apic" && parameters.shape == "linear",
           transfer +
               " with linear shapes bursts: their gradient at a node does not fall with the "
               "mass there; set method.shape to \"gimp\" or \"quadratic\", or "
               "method.transfer = \"spin\"");
}

/// Warns of the first block that a flat plate meets where its outline cuts particles of gimp, whose squares are
/// alike here. As measured with two particles per side and plates at every tenth of a cell: up to .056 off where
/// a tenth of a square or more is cut off.
inline void warn_of_cut_squares(const Problem& problem, const std::vector<Material>& materials,
                                const std::vector<PlannedGrain>& plans,
                                std::vector<std::string>& warnings) {
    const Mesh mesh = problem.mesh();
    const double spacing = mesh.h / double(problem.per_side);
    const auto is_rigid = [&](const PlannedGrain& plan) {
        return materials[plan.material].law == Law::rigid;
    };
    const auto cuts = [&](double side, double other, double from) {
        const double squares = (side - from) / spacing;
        return std::fabs(side - other) < 0.1 * mesh.h &&
               std::fabs(squares - std::round(squares)) > 0.1;
    };
    for (const PlannedGrain& block : plans)
        for (const PlannedGrain& plate : plans) {
            if (is_rigid(block) || !is_rigid(plate) || !is_upright_box(block.outline) ||
                !is_upright_box(plate.outline))
                continue;
            const Bounds a = bounds(block.outline), b = bounds(plate.outline);
            const bool beside_x = a.y_low < b.y_high && b.y_low < a.y_high,
                       beside_y = a.x_low < b.x_high && b.x_low < a.x_high;
            if ((beside_x &&
                 (cuts(a.x_low, b.x_high, mesh.x_low) || cuts(a.x_high, b.x_low, mesh.x_low))) ||
                (beside_y &&
                 (cuts(a.y_low, b.y_high, mesh.y_low) || cuts(a.y_high, b.y_low, mesh.y_low))))
                return warnings.push_back(
                    "the outline of '" + block.name + "' cuts particles beside plate '" +
                    plate.name +
                    "': with method.shape = \"gimp\" the layer there bears up to "
                    "0.06 more or less than the others (one particle per side: more); take "
                    "\"linear\", mpm_implicit, or sides of the block at multiples of " +
                    format(spacing) + " from the corner of the mesh");
        }
}

/// Warnings with the number and the limit, for choices that run but may mislead.
inline std::vector<std::string> warnings_of(const Case& parameters, const Scales& scales) {
    std::vector<std::string> warnings = resolution_warnings(parameters, scales);
    if (parameters.alpha > 0.7 && !parameters.frozen)
        warnings.insert(warnings.begin(),
                        "time.alpha = " + format(parameters.alpha) +
                            " is above 0.7: nothing bounds the energy of explicit solutions, and "
                            "grains that meet will burst");
    const std::vector<Material> materials = materials_of(parameters.problem);
    if (parameters.shape == "gimp")
        warn_of_cut_squares(parameters.problem, materials,
                            plan_grains(parameters.problem, materials), warnings);
    const PlateStrain strain = plate_strain(parameters, materials);
    if (parameters.shape == "linear" && strain.pressed > 0.1)
        warnings.push_back("grains are pressed by " + format(strain.pressed) +
                           ", above 0.1: particles of linear shapes that cross lines of nodes make "
                           "them too soft, and finer meshes more so; set method.shape = \"gimp\"");
    const bool viscous =
        std::ranges::any_of(materials, [](const Material& m) { return m.viscosity > 0; });
    if (strain.stretched > 0.05 && parameters.transfer != "apic" && parameters.flip > 0 && !viscous)
        warnings.push_back("grains are stretched by " + format(strain.stretched) +
                           ", above 0.05: motion of particles that nodes do not see grows under "
                           "tension, and tears "
                           "them; set method.shape = \"gimp\" and method.transfer = \"apic\" or "
                           "material.<name>.viscosity = " +
                           format(2 * scales.dt));
    const double cells = cells_of_impact(parameters.problem, scales);
    if (parameters.shape == "linear" && cells > 1.35)
        warnings.push_back(impact_warning(cells, 1.35, "up to a twentieth at 1.4 and a tenth at 2",
                                          "method.shape = \"gimp\""));
    if (scales.shortening > 10)
        warnings.push_back("viscosity makes the steps " + format(scales.shortening) +
                           " times shorter, more than 10: mpm_implicit needs no shorter ones");
    return warnings;
}

}  // namespace mpm_explicit
