// What follows from a case before it runs: sound, time step, particles, memory.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "mpm_explicit/setup/assemble.hpp"
#include "mpm_explicit/setup/case.hpp"

namespace mpm {

/// What follows from a case, in its own units.
struct Scales {
    double sound_speed = 0, speed = 0;  // largest c_p, largest |v| of a grain
    double impact_speed = 0;            // half of the largest closing speed of grains, all of it at
                                        // plates and walls
    double dt = 0, shortening = 1;      // of the step, by viscosity
    long steps = 0, particles = 0, grains = 0;
    double nodes = 0;     // of all grains, about
    double thinnest = 0;  // grain [length]
    double bytes = 0;
    double least_mass = 0;  // of a node that takes part: round-off of the lightest particle's
};

/// The largest speed at which bodies beside each other approach along an axis: half of it between two grains, all of
/// it between a grain and a plate or wall.
inline double closing_speed(const Problem& problem, const std::vector<PlannedGrain>& plans,
                            const std::vector<Material>& materials) {
    struct Body {
        double low, high, v;
        bool fixed;
    };
    const Mesh mesh = problem.mesh();
    double fastest = 0;
    for (const bool along_x : {true, false}) {
        std::vector<Body> bodies;
        for (const PlannedGrain& plan : plans) {
            const Bounds box = bounds(plan.outline);
            const bool rigid = materials[plan.material].law == Law::rigid;
            bodies.push_back(along_x ? Body{box.x_low, box.x_high, plan.from.velocity_x, rigid}
                                     : Body{box.y_low, box.y_high, plan.from.velocity_y, rigid});
        }
        const double ends[] = {along_x ? mesh.x_low : mesh.y_low,
                               along_x ? mesh.x_high() : mesh.y_high()};
        for (const int side : {0, 1})
            if (problem.walls[(along_x ? x_low : y_low) + side] != "open")
                bodies.push_back({ends[side], ends[side], 0, true});
        // Of those below a body the fastest, as they end one after the other.
        std::vector<Body> by_end = bodies;
        std::ranges::sort(by_end, {}, &Body::high);
        std::ranges::sort(bodies, {}, &Body::low);
        double fastest_of[] = {-HUGE_VAL, -HUGE_VAL};  // of grains, and of what is fixed
        std::size_t below = 0;
        for (const Body& body : bodies) {
            for (; below < by_end.size() && by_end[below].high <= body.low + 1e-6 * mesh.h; ++below)
                fastest_of[by_end[below].fixed] =
                    std::max(fastest_of[by_end[below].fixed], by_end[below].v);
            fastest = std::max(fastest, (body.fixed ? 1 : 0.5) * (fastest_of[0] - body.v));
            if (!body.fixed) fastest = std::max(fastest, fastest_of[1] - body.v);
        }
    }
    return fastest;
}

/// The scales of a case.
///   dt <= alpha h / (c_p + |v|), for an explicit scheme c_p times viscous_shortening(), and
///   steps dt = time.end where time.dt is not given
/// errors: InputError for too many steps or particles, or a time.dt that alpha does not allow
inline Scales scales_of(const Case& parameters, bool is_explicit = true) {
    const std::vector<Material> materials = materials_of(parameters.problem);
    const std::vector<PlannedGrain> plans = plan_grains(parameters.problem, materials);
    Scales s;
    const Problem& problem = parameters.problem;
    const Mesh mesh = problem.mesh();
    const double side = mesh.h / double(problem.per_side);
    double lightest = 1e300, shortened = 0;
    s.thinnest = 1e300;
    s.impact_speed = closing_speed(problem, plans, materials);
    double own_speed = 0;
    for (const PlannedGrain& plan : plans) {
        const Material& material = materials[plan.material];
        const GrainCase& from = plan.from;
        const double c = sound_speed(material);
        s.sound_speed = std::max(s.sound_speed, c);
        shortened = std::max(shortened, is_explicit ? c * viscous_shortening(material, mesh.h) : c);
        const double own = std::fabs(from.amplitude) + std::fabs(from.spin) * plan.outline.radius +
                           std::numbers::pi / from.period * std::hypot(from.swing_x, from.swing_y) +
                           fastest(plan.table);
        s.speed = std::max(s.speed, std::hypot(from.velocity_x, from.velocity_y) + own);
        own_speed = std::max(own_speed, own);
        s.particles += std::lround(area(plan.outline) / (side * side));
        lightest = std::min(lightest, material.density * side * side);
        s.thinnest = std::min(s.thinnest, thinnest(plan.outline));
        const Bounds box = bounds(plan.outline);
        s.nodes +=
            ((box.x_high - box.x_low) / mesh.h + 5) * ((box.y_high - box.y_low) / mesh.h + 5);
    }
    s.grains = long(plans.size());
    if (s.grains > 1) s.impact_speed += own_speed;
    // Where a smooth shape ends, its weight falls as the square of its gradient.
    s.least_mass = (parameters.shape == "linear" ? 1e-12 : 1e-24) * lightest;
    const double longest = parameters.alpha * mesh.h / (shortened + s.speed);
    s.shortening = (shortened + s.speed) / (s.sound_speed + s.speed);
    const bool is_given = parameters.dt > 0;
    refuse(parameters.dt > longest * (1 + 1e-9),
           "time.dt = " + format(parameters.dt) + " is above alpha h/(c_p + |v|) = " +
               format(longest) + ": lower it, or raise time.alpha");
    s.dt = is_given ? parameters.dt : longest;
    const double steps = parameters.end / s.dt;
    refuse(!(steps <= 1e9), "the run would take " + format(steps) +
                                " steps, more than 1e9: raise time.alpha or lower time.end");
    s.steps = is_given ? std::lround(steps) : long(std::ceil(steps - 1e-9));
    if (!is_given && s.steps > 0) s.dt = parameters.end / double(s.steps);
    refuse(s.particles > 2'000'000'000,
           std::to_string(s.particles) +
               " particles are more than 2e9: lower grid.particles_per_side");
    // Particles and their copies while they are sorted and, in leapfrog, for the last row; the nodes
    // of each grain, with a margin; the table of all nodes; the raster of fringes.
    const double particles = double(s.particles),
                 pixels = parameters.fringes_interval > 0
                              ? double(mesh.cells_x * mesh.cells_y) *
                                    std::pow(double(parameters.pixels_per_cell), 2)
                              : 0;
    const long carried = ((parameters.transfers().kind == Transfer::none ? 12 : 16) +
                          (parameters.transfers().crossing > 0 ? 2 : 0) +
                          (parameters.shape == "gimp" && !is_explicit ? 2 : 0)) *
                         (is_explicit ? 2 : 1);
    s.bytes = particles * double(carried * sizeof(double) + 2 * sizeof(int)) +
              s.nodes * (sizeof(NodeSums) + sizeof(NodeMotion) + sizeof(NodeForce) +
                         sizeof(SurfaceSums) + sizeof(double) + sizeof(int) + 1) +
              pixels * (3 * sizeof(double) + sizeof(int)) +
              sizeof(int) * double((mesh.cells_x + 8) * (mesh.cells_y + 8));
    return s;
}

/// The scales of a run. A restart with another time.end keeps the time step of the run that it
/// continues, which becomes time.dt.
/// errors: InputError as scales_of, or for a checkpoint that cannot be read
inline Scales scales_of_run(const common::ProgramInfo& info, const common::CommandLine& command,
                            Case& parameters, bool is_explicit = true) {
    if (command.restart_path.empty() || parameters.dt > 0)
        return scales_of(parameters, is_explicit);
    const common::CheckpointReader checkpoint(info, command.restart_path);
    Case before = parameters;
    for (const common::Setting& one :
         common::read_case(checkpoint.effective_case(), command.restart_path)) {
        if (one.name != "time.end") continue;
        const long* const whole = std::get_if<long>(&one.value);
        before.end = whole != nullptr ? double(*whole) : std::get<double>(one.value);
    }
    if (before.end != parameters.end) parameters.dt = scales_of(before, is_explicit).dt;
    return scales_of(parameters, is_explicit);
}

/// The resolved scales as text, for --dry-run and the head of a run.
/// in:     scheme, what is said of the scheme; cost, of a step, over one of leapfrog
inline std::string describe_scales(const Case& parameters, const Scales& scales,
                                   const std::string& scheme = "", double cost = 1) {
    // Of leapfrog, on one core: a particle, and a node of a grain, where others press on it.
    const bool is_wide = parameters.shape != "linear";
    const double particle = is_wide ? 90e-9 : 35e-9, node = is_wide ? 220e-9 : 70e-9;  // s
    const Problem& problem = parameters.problem;
    const Mesh mesh = problem.mesh();
    std::string text;
    const auto line = [&](const std::string& name, const std::string& value) {
        text +=
            "  " + name + std::string(name.size() < 22 ? 22 - name.size() : 1, ' ') + value + "\n";
    };
    line("mesh", std::to_string(mesh.cells_x) + " x " + std::to_string(mesh.cells_y) +
                     " cells of " + format(mesh.h) + (mesh.periodic_x ? ", periodic in x" : ""));
    line("walls", "x: " + problem.walls[0] + ", " + problem.walls[1] + "; y: " + problem.walls[2] +
                      ", " + problem.walls[3]);
    const std::string flip =
        parameters.flip == 1 ? "FLIP" : "FLIP fraction " + format(parameters.flip);
    line("method", parameters.shape + " shape functions, " + flip +
                       (parameters.frozen ? ", frozen particles" : "") + scheme);
    line("grains", std::to_string(scales.grains) + ", the thinnest " +
                       format(scales.thinnest / mesh.h) + " cells");
    line("particles", "about " + std::to_string(scales.particles) + ", " +
                          std::to_string(problem.per_side) + " x " +
                          std::to_string(problem.per_side) + " per cell");
    line("sound",
         "c_p = " + format(scales.sound_speed) + ", largest |v| = " + format(scales.speed));
    line("steps", std::to_string(scales.steps) + " of dt = " + format(scales.dt) +
                      ", alpha = " + format(parameters.alpha) +
                      (scales.shortening > 1
                           ? ", " + format(scales.shortening) + " times shorter by viscosity"
                           : ""));
    line("memory", "about " + format(scales.bytes / 1048576) + " MiB");
    const double seconds =
        cost * double(scales.steps) * (particle * double(scales.particles) + node * scales.nodes);
    line("time", "about " + format(seconds) + " s on one core");
    return text;
}

}  // namespace mpm
