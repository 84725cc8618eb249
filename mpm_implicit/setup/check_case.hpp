// What is said before a run of mpm_implicit besides what holds for every scheme
// (mpm_explicit/setup/check_grains.hpp): which solver a case needs, and how far its time step can be trusted.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/setup/check_grains.hpp"
#include "mpm_implicit/setup/case.hpp"

namespace mpm_implicit {

/// The plate that presses a billet: the one that the case names, or the first that moves along y.
/// out:    its name; empty if there is none
inline std::string billet_plate(const Case& w, const std::vector<PlannedGrain>& plans,
                                const std::vector<Material>& materials) {
    for (const PlannedGrain& plan : plans) {
        const bool rigid = materials[static_cast<std::size_t>(plan.material)].law == Law::rigid;
        if (rigid && (w.plate.empty() ? plan.from.velocity_y != 0 : plan.name == w.plate))
            return plan.name;
    }
    return {};
}

/// What the comparison "billet" asks for.
/// errors: InputError with what is missing
inline void refuse_billet(const Case& w) {
    const std::vector<Material> materials = materials_of(w.problem);
    const std::vector<PlannedGrain> plans = plan_grains(w.problem, materials);
    const auto law_of = [&](const PlannedGrain& plan) {
        return materials[static_cast<std::size_t>(plan.material)].law;
    };
    const PlannedGrain* block = nullptr;
    long blocks = 0;
    for (const PlannedGrain& plan : plans)
        if (law_of(plan) != Law::rigid) block = &plan, ++blocks;
    const bool upright = blocks == 1 && block->from.shape == "box" && block->from.angle == 0;
    mpm::detail::refuse(!upright || plans.size() != 3 || w.problem.contact.friction != 0 ||
                            billet_plate(w, plans, materials).empty(),
                        "theory.compare = \"billet\" needs one upright box between two rigid "
                        "plates without friction, of which one moves along y");
    const Material& m = materials[static_cast<std::size_t>(block->material)];
    mpm::detail::refuse(m.law != Law::elastic && (m.law != Law::j2 || m.hardening != 0),
                        "theory.compare = \"billet\" knows what is elastic, and what has law = "
                        "\"j2\" and hardening = 0: change [material." +
                            m.name + "]");
    const Bounds box = bounds(block->outline);
    for (const PlannedGrain& plan : plans) {
        if (&plan == block) continue;
        const Bounds plate = bounds(plan.outline);
        const double gap =
            std::min(std::fabs(plate.y_low - box.y_high), std::fabs(plate.y_high - box.y_low));
        mpm::detail::refuse(
            plate.x_low > box.x_low || plate.x_high < box.x_high || gap > 1e-6 * w.problem.mesh().h,
            "theory.compare = \"billet\": plate '" + plan.name +
                "' does not cover a whole side of '" + block->name +
                "': make it wider, and let them touch");
    }
}

/// Refuses combinations that cannot run.
/// errors: InputError with the cure
inline void validate(const Case& w, const ThetaScheme& scheme) {
    using mpm::detail::refuse;
    mpm::validate(w);
    for (const Material& m : materials_of(w.problem))
        refuse(!scheme.newton() && (m.law == Law::j2 || m.law == Law::drucker_prager),
               "[material." + m.name +
                   "] can yield, and solver.kind = \"projected_cg\" is for "
                   "elastic grains: set solver.kind = \"newton_krylov\"");
    refuse(!scheme.newton() && !scheme.keeps_volumes(),
           "method.volumes = \"updated\" makes the step nonlinear: set solver.kind = "
           "\"newton_krylov\"");
    refuse(w.compare == "bar" && !scheme.consistent(),
           "theory.compare = \"bar\" knows the damping of the consistent mass matrix only: set "
           "method.mass = \"consistent\", or compare with \"oscillator\"");
    if (w.compare == "billet") refuse_billet(w);
}

/// Warnings with the number and the limit, for choices that run but may mislead.
inline std::vector<std::string> warnings_of(const Case& w, const ThetaScheme& scheme,
                                            const Scales& scales) {
    std::vector<std::string> warnings = resolution_warnings(w, scales);
    const double cells = scales.speed * scales.dt / w.problem.mesh().h;
    if (cells > 0.5 && scales.grains > 1)
        warnings.push_back("|v| dt/h = " + common::format(cells) +
                           " is above 0.5: grains can pass through each other's surfaces before "
                           "they are seen to touch; reduce time.alpha");
    if (w.flip < 1)
        warnings.push_back("method.flip = " + common::format(w.flip) +
                           " is below 1: [MPM-13] is for FLIP, and the column pic takes the rest");
    if (w.problem.per_side == 1 && scheme.consistent())
        warnings.push_back(
            "grid.particles_per_side = 1 with the consistent mass matrix, which is then nearly "
            "singular: take 2, or method.mass = \"lumped\"");
    return warnings;
}

/// Memory of a run [bytes]: besides what every scheme needs, the matrices, their factors, vectors.
inline double bytes_of(const Case& w, const ThetaScheme& scheme, const Scales& scales) {
    const double per_cell = static_cast<double>(w.problem.per_side * w.problem.per_side),
                 dofs = 2 * static_cast<double>(scales.particles) / per_cell +
                        64 * static_cast<double>(scales.grains);
    const double diagonals = w.shape == "linear" ? 5 : 13,
                 across = std::sqrt(dofs / static_cast<double>(scales.grains)),
                 reach = w.shape == "linear" ? 1 : 2,
                 factors = (scheme.preconditioner == "grains" ? 4 * across * reach : 0) +
                           (scheme.consistent() ? across * reach : 0),
                 newton = scheme.newton() ? 2 * (2 * 30 + 16) : 0;
    return scales.bytes + 8 * dofs * (5 * diagonals + 2 * 14 + factors + newton);
}

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& w, const ThetaScheme& scheme, const Scales& scales) {
    // A step takes about as long as so many of the explicit program.
    const double explicit_steps = 6 + 6 * std::sqrt(w.alpha), particle_steps_per_second = 15e6;
    const std::string flip = w.flip == 1 ? "FLIP" : "FLIP fraction " + common::format(w.flip);
    return mpm::describe_scales(
        w, scales,
        w.shape + " shape functions, " + flip + (w.frozen ? ", frozen particles" : "") +
            ", theta = " + common::format(scheme.theta) + ", " + scheme.mass + " mass",
        explicit_steps * static_cast<double>(scales.steps) * static_cast<double>(scales.particles) /
            particle_steps_per_second);
}

}  // namespace mpm_implicit
