// How far rigid grains press or pull those between them, as a case says it before the run.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mpm_explicit/setup/assemble.hpp"
#include "mpm_explicit/setup/case.hpp"
#include "mpm_explicit/setup/plan_grains.hpp"

namespace mpm {

/// Parts of the height, or width, of all other grains.
struct PlateStrain {
    double pressed = 0, stretched = 0;
};

/// By how much rigid grains on both sides, or one and a wall, press all others together until time.end, or
/// pull them apart where they are bonded. Swings and tables are not counted; a force, as the strain of one
/// elastic body, only where it presses.
inline PlateStrain plate_strain(const Case& parameters, const std::vector<Material>& materials) {
    const Problem& problem = parameters.problem;
    const Mesh mesh = problem.mesh();
    const std::vector<PlannedGrain> plans = plan_grains(problem, materials);
    const auto travel_in = [&](double t) {
        return t > problem.rise ? t - 0.5 * problem.rise : 0.5 * t * t / problem.rise;
    };
    const std::vector<Bond> bonds = bonds_of(problem, plans, materials);
    PlateStrain strain;
    for (const bool along_x : {true, false}) {
        const auto from = [&](const Bounds& box) { return along_x ? box.x_low : box.y_low; };
        const auto to = [&](const Bounds& box) { return along_x ? box.x_high : box.y_high; };
        double low = HUGE_VAL, high = -HUGE_VAL, left = HUGE_VAL, right = -HUGE_VAL, E = HUGE_VAL;
        for (const PlannedGrain& plan : plans) {
            const Material& m = materials[plan.material];
            if (m.law == Law::rigid) continue;
            const Bounds box = bounds(plan.outline);
            low = std::min(low, from(box)), high = std::max(high, to(box)), E = std::min(E, m.E);
            left = std::min(left, along_x ? box.y_low : box.x_low);
            right = std::max(right, along_x ? box.y_high : box.x_high);
        }
        // What is nearest on either side, and how far it goes.
        const auto wall = [&](Side side, double at) {
            return problem.walls[side] == "open" || (along_x && problem.periodic_x) ? HUGE_VAL : at;
        };
        const double at_low = wall(along_x ? x_low : y_low, along_x ? mesh.x_low : mesh.y_low);
        double below = at_low < HUGE_VAL ? at_low : -HUGE_VAL,
               above = wall(along_x ? x_high : y_high, along_x ? mesh.x_high() : mesh.y_high()),
               of_below = 0, of_above = 0, force = 0;
        // Whether what is nearest holds the grains when it goes away.
        const auto holds = [&](Side side) {
            return problem.walls[side] == "stick" || problem.walls[side] == "slip";
        };
        bool held_below = at_low < HUGE_VAL && holds(along_x ? x_low : y_low),
             held_above = above < HUGE_VAL && holds(along_x ? x_high : y_high);
        for (const PlannedGrain& plan : plans) {
            const GrainCase& is = plan.from;
            if (materials[plan.material].law != Law::rigid) continue;
            const Bounds box = bounds(plan.outline);
            const bool is_below = to(box) <= low + 0.5 * mesh.h,
                       is_above = from(box) >= high - 0.5 * mesh.h;
            if (is.control == (along_x ? "force_x" : "force_y")) {
                force = std::max(force, is_below ? is.force : is_above ? -is.force : 0);
                continue;
            }
            const bool stops = is.stop > 0 && is.stop + problem.rise <= parameters.end;
            const double way = (along_x ? is.velocity_x : is.velocity_y) *
                               (stops ? is.stop : travel_in(parameters.end));
            const bool bonded = std::ranges::any_of(bonds, [&](const Bond& bond) {
                return &plans[bond.a] == &plan || &plans[bond.b] == &plan;
            });
            if (is_below && to(box) >= below) below = to(box), of_below = way, held_below = bonded;
            if (is_above && from(box) <= above)
                above = from(box), of_above = way, held_above = bonded;
        }
        const double gaps = std::max(0.0, low - below) + std::max(0.0, above - high);
        strain.pressed = std::max({strain.pressed, (of_below - of_above - gaps) / (high - low),
                                   force / (E * (right - left))});
        if (held_below && held_above)
            strain.stretched = std::max(strain.stretched, (of_above - of_below) / (high - low));
    }
    return strain;
}

}  // namespace mpm
