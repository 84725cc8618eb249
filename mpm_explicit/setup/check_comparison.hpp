// Which cases a comparison with theory can be made for; the others are refused with what is missing.
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "mpm_explicit/setup/scales.hpp"

namespace mpm::detail {

inline void refuse(bool condition, const std::string& sentence) {
    if (condition) throw common::InputError(sentence);
}

inline void refuse_comparison(const Case& w, const std::vector<PlannedGrain>& plans,
                              const std::vector<Material>& materials) {
    if (w.compare == "none") return;
    const std::string compare = "theory.compare = \"" + w.compare + "\"";
    const Problem& problem = w.problem;
    const auto material_of = [&](const PlannedGrain& plan) -> const Material& {
        return materials[static_cast<std::size_t>(plan.material)];
    };
    const auto is_rigid = [&](const PlannedGrain& p) { return material_of(p).law == Law::rigid; };
    const long rigid = std::count_if(plans.begin(), plans.end(), is_rigid),
               free = static_cast<long>(plans.size()) - rigid;
    const auto profile = [&](const char* name) {
        return std::all_of(plans.begin(), plans.end(), [&](const PlannedGrain& plan) {
            return plan.from.profile == name && plan.from.amplitude != 0;
        });
    };
    const auto is = [&](const char* name) { return w.compare == name; };
    const auto wall = [&](Side side, const char* kind) {
        return problem.walls[static_cast<std::size_t>(side)] == kind;
    };
    if (is("rebound")) {
        const bool disks = free == 2 && rigid == 0 && plans[0].outline.kind == OutlineKind::disk &&
                           plans[1].outline.kind == OutlineKind::disk;
        const auto meet = [&] {
            const double dx = plans[1].outline.x - plans[0].outline.x,
                         dy = plans[1].outline.y - plans[0].outline.y,
                         vx = plans[0].from.velocity_x - plans[1].from.velocity_x,
                         vy = plans[0].from.velocity_y - plans[1].from.velocity_y;
            return dx * vx + dy * vy > 0 &&
                   std::fabs(dx * vy - dy * vx) < 1e-9 * std::fabs(dx * vx + dy * vy);
        };
        refuse(!disks || plans[0].outline.radius != plans[1].outline.radius ||
                   plans[0].material != plans[1].material || !meet(),
               compare + " needs two equal disks that meet head on");
        const auto &a = plans[0], &b = plans[1];
        const double gap = std::hypot(b.outline.x - a.outline.x, b.outline.y - a.outline.y) -
                           a.outline.radius - b.outline.radius,
                     closing = std::hypot(a.from.velocity_x - b.from.velocity_x,
                                          a.from.velocity_y - b.from.velocity_y);
        refuse(w.end < 1.05 * gap / closing,
               compare + ": the disks meet at t = " + common::format(gap / closing) +
                   ", and the run ends at " + common::format(w.end) + ": raise time.end");
    }
    const Mesh mesh = problem.mesh();
    const auto fills = [&](double low, double high, double from, double to) {
        return std::fabs(low - from) < 1e-6 * mesh.h && std::fabs(high - to) < 1e-6 * mesh.h;
    };
    if (is("bar") || is("bond")) {
        const bool held = wall(x_low, "slip") || wall(x_low, "stick");
        refuse(!profile("bar") || !held,
               compare +
                   " needs boxes with profile = \"bar\", an amplitude, and boundary.x_low = "
                   "\"slip\" or \"stick\"");
        const double low = profile_bounds(plans).x_low;
        refuse(!fills(low, low, mesh.x_low, mesh.x_low),
               compare + " needs a bar that begins at the wall, at x = " +
                   common::format(mesh.x_low) + ", not at " + common::format(low));
    }
    if (is("bond"))
        refuse(problem.bonds.empty() || free != 2,
               compare + " needs two boxes and a [bond.<name>] between them");
    if (is("standing_wave") || is("oscillator"))
        refuse(!profile("wave") || free != 1 || !wall(x_low, "slip") || !wall(x_high, "slip") ||
                   !wall(y_low, "slip") || !wall(y_high, "slip"),
               compare +
                   " needs one box with profile = \"wave\", an amplitude, and all walls "
                   "\"slip\"");
    if (is("standing_wave") || is("oscillator")) {
        const Bounds box = bounds(plans[0].outline);
        refuse(!fills(box.x_low, box.x_high, mesh.x_low, mesh.x_high()) ||
                   !fills(box.y_low, box.y_high, mesh.y_low, mesh.y_high()),
               compare + " needs a box that fills the mesh: make it " +
                   common::format(mesh.length_x()) + " by " +
                   common::format(mesh.y_high() - mesh.y_low));
    }
    if (is("oscillator"))
        refuse(problem.cells_x != 2 || !w.frozen || w.shape != "linear" || w.flip != 1,
               compare + " needs grid.cells_x = 2, method.frozen = true, and linear FLIP");
    if (is("block") || is("cylinder"))
        refuse(free != 1 || rigid < 1 || problem.gravity_x == 0 || !(problem.gravity_y < 0),
               compare +
                   " needs one grain, a rigid plate, and an inclined gravity: load.gravity_x "
                   "not 0, load.gravity_y below 0");
    if (is("disk"))
        refuse(free != 1 || rigid < 1 || rigid > 16 || plans[0].outline.kind != OutlineKind::disk ||
                   is_rigid(plans[0]),
               compare + " needs a disk, first in the case, and rigid plates, at most 16");
    for (const auto& [name, value, wants_rigid] :
         {std::tuple("theory.grain", w.grain, false), std::tuple("theory.plate", w.plate, true)}) {
        const auto found = std::find_if(
            plans.begin(), plans.end(),
            [&parameters = value](const auto& plan) { return plan.name == parameters; });
        if (value.empty()) continue;
        refuse(found == plans.end(), std::string(name) + ": there is no grain '" + value + "'");
        refuse(is_rigid(*found) != wants_rigid, std::string(name) + ": '" + value + "' is " +
                                                    (wants_rigid ? "not " : "") +
                                                    "rigid: name another grain");
    }
    if (is("yield")) {
        const auto seen = std::find_if(plans.begin(), plans.end(), [&](const auto& plan) {
            return w.grain.empty() ? !is_rigid(plan) : plan.name == w.grain;
        });
        refuse(material_of(*seen).law != Law::j2,
               compare + " needs a grain of a material with law = \"j2\", and '" + seen->name +
                   "' is of another: set theory.grain");
        refuse(std::all_of(plans.begin(), plans.end(),
                           [](const auto& plan) {
                               const GrainCase& from = plan.from;
                               return from.velocity_x == 0 && from.velocity_y == 0 &&
                                      from.spin == 0 && from.amplitude == 0;
                           }),
               compare +
                   " measures shares of the energy at the start, and nothing moves then: "
                   "give a grain a velocity");
    }
}

// Beyond these sizes, products of several numbers leave double precision.
inline void refuse_extreme(const std::string& section, const char* key, double value) {
    const double size = std::fabs(value);
    refuse(size != 0 && !(size > 1e-40 && size < 1e40),
           section + "." + key + " = " + common::format(value) +
               " is not between 1e-40 and 1e40 in size: choose other units");
}

inline void refuse_extremes(const Case& w) {
    const Problem& problem = w.problem;
    const auto check = [](const std::string& section,
                          const std::vector<std::pair<const char*, double>>& numbers) {
        for (const auto& [key, value] : numbers) refuse_extreme(section, key, value);
    };
    check("mesh", {{"length_x", problem.length_x},
                   {"origin_x", problem.origin_x},
                   {"origin_y", problem.origin_y}});
    check("walls", {{"friction", problem.contact.wall_friction}});
    check("contact",
          {{"friction", problem.contact.friction}, {"separation", problem.contact.separation}});
    check("load", {{"gravity_x", problem.gravity_x},
                   {"gravity_y", problem.gravity_y},
                   {"damping", problem.damping},
                   {"rise", problem.rise}});
    check("time", {{"alpha", w.alpha}});
    for (const MaterialCase& m : problem.materials)
        check("material." + m.name, {{"E", m.material.E},
                                     {"nu", m.material.nu},
                                     {"density", m.material.density},
                                     {"yield_stress", m.material.yield_stress},
                                     {"hardening", m.material.hardening},
                                     {"cohesion", m.material.cohesion},
                                     {"friction_angle", m.material.friction_angle},
                                     {"dilatancy_angle", m.material.dilatancy_angle},
                                     {"tension", m.material.tension}});
    for (const GrainCase& g : problem.grains)
        check("grain." + g.name, {{"angle", g.angle},
                                  {"velocity_x", g.velocity_x},
                                  {"velocity_y", g.velocity_y},
                                  {"spin", g.spin},
                                  {"amplitude", g.amplitude},
                                  {"force", g.force},
                                  {"damping", g.damping}});
    for (const PackCase& p : problem.packs)
        check("pack." + p.name, {{"velocity_x", p.velocity_x},
                                 {"velocity_y", p.velocity_y},
                                 {"shear_rate", p.shear_rate}});
    for (const BondCase& b : problem.bonds)
        check("bond." + b.name, {{"tension", b.tension}, {"shear", b.shear}});
    const Mesh mesh = problem.mesh();
    const double far = std::max(std::fabs(mesh.x_low), std::fabs(mesh.y_low)) / mesh.h;
    refuse(far > 1e9, "the mesh begins " + common::format(far) +
                          " cells from the origin, more than 1e9, where places are lost to "
                          "round-off: move grid.low_x and low_y nearer to 0");
}

}  // namespace mpm::detail
