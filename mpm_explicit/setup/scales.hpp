// What follows from a case before it runs: sound, time step, particles, memory; and what to warn of.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/setup/assemble.hpp"
#include "mpm_explicit/setup/case_of_grains.hpp"

namespace mpm {

struct Scales {
    double sound_speed = 0, speed = 0;  // largest c_p, largest |v| of a grain
    double dt = 0;
    long steps = 0, particles = 0, grains = 0;
    double thinnest = 0;  // grain [length]
    double bytes = 0;
    double least_mass = 0;  // of a node that takes part: round-off of the lightest particle's
};

inline Scales scales_of(const Case& w) {
    const std::vector<Material> materials = materials_of(w.problem);
    const std::vector<PlannedGrain> plans = plan_grains(w.problem, materials);
    Scales s;
    const Problem& problem = w.problem;
    const Mesh mesh = problem.mesh();
    const double side = mesh.h / static_cast<double>(problem.per_side);
    double lightest = 1e300, nodes = 0;
    s.thinnest = 1e300;
    for (const PlannedGrain& plan : plans) {
        const Material& material = materials[static_cast<std::size_t>(plan.material)];
        const GrainCase& from = plan.from;
        s.sound_speed = std::max(s.sound_speed, sound_speed(material));
        s.speed = std::max(s.speed, std::hypot(from.velocity_x, from.velocity_y) +
                                        std::fabs(from.amplitude) +
                                        std::fabs(from.spin) * plan.outline.radius);
        s.particles += std::lround(area(plan.outline) / (side * side));
        lightest = std::min(lightest, material.density * side * side);
        s.thinnest = std::min(s.thinnest, thinnest(plan.outline));
        const Bounds box = bounds(plan.outline);
        nodes += ((box.x_high - box.x_low) / mesh.h + 5) * ((box.y_high - box.y_low) / mesh.h + 5);
    }
    s.grains = static_cast<long>(plans.size());
    // Where a smooth shape ends, its weight falls as the square of its gradient.
    s.least_mass = (w.shape == "linear" ? 1e-12 : 1e-24) * lightest;
    s.dt = w.alpha * mesh.h / (s.sound_speed + s.speed);
    const double steps = w.end / s.dt;
    if (!(steps <= 1e9))
        throw common::InputError("the run would take " + common::format(steps) +
                                 " steps, more than 1e9: raise time.alpha or lower time.end");
    s.steps = std::lround(steps);
    const long rows = s.steps / w.history_steps;
    if (w.compare != "none" && rows < 10)
        throw common::InputError("theory.compare = \"" + w.compare + "\" needs at least 10 rows " +
                                 "of history, and there would be " + std::to_string(rows) +
                                 ": raise time.end or lower output.history_steps");
    if (!(problem.damping * s.dt < 1))
        throw common::InputError("load.damping = " + common::format(problem.damping) +
                                 " takes all velocity in a step of " + common::format(s.dt) +
                                 ": lower it below " + common::format(1 / s.dt));
    if (s.particles > 2'000'000'000)
        throw common::InputError(std::to_string(s.particles) +
                                 " particles are more than 2e9: lower grid.particles_per_side");
    // Particles and their copies while they are sorted; the nodes of each grain, with a margin; the
    // table of all nodes.
    const double particles = static_cast<double>(s.particles);
    s.bytes = particles * (12 * sizeof(double) + 2 * sizeof(int)) +
              nodes * (sizeof(NodeSums) + sizeof(NodeMotion) + sizeof(NodeForce) + 1) +
              sizeof(int) * static_cast<double>((mesh.cells_x + 8) * (mesh.cells_y + 8));
    return s;
}

}  // namespace mpm
