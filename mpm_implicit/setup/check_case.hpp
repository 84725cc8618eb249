// What is said before a run of mpm_implicit besides what holds for every scheme
// (mpm_explicit/setup/check_case.hpp): which solver a case needs, and how far its time step can be
// trusted.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/setup/check_case.hpp"
#include "mpm_explicit/setup/plate_strain.hpp"
#include "mpm_implicit/setup/case.hpp"

namespace mpm_implicit {

/// Refuses combinations that cannot run.
/// errors: InputError with the cure
inline void validate(const Case& parameters, const ThetaScheme& scheme) {
    mpm::validate(parameters);
    for (const Material& m : materials_of(parameters.problem))
        refuse(!scheme.newton() && (m.law == Law::j2 || m.law == Law::drucker_prager),
               "[material." + m.name +
                   "] can yield, and solver.kind = \"projected_cg\" is for "
                   "elastic grains: set solver.kind = \"newton_krylov\"");
    refuse(!scheme.newton() && !scheme.keeps_volumes(),
           "method.volumes = \"updated\" makes the step nonlinear: set solver.kind = "
           "\"newton_krylov\"");
}

/// Exponents of what noise grows by, from either cause.
struct NoiseGrowth {
    double under_weight = 0, between_plates = 0;
};

/// By how much noise of grains under their weight, or between plates, grows in a run of theta = 1/2, as an
/// exponent: 0.37 e (c_p/h) alpha^(-3/4) t, with e = g H/c_p^2, as measured from alpha = 1 to 8 with columns of 24
/// and 48 cells, with H the height of all grains. The pressed mesh is not quite symmetric, and flutters. Between
/// plates e is twice as large in the mean over the grains, and half in time. Viscosity of a tenth of a step ends
/// it, and load.damping c takes c/2 from its rate.
inline NoiseGrowth growth_of_noise(const Case& parameters, const Scales& scales) {
    const Problem& problem = parameters.problem;
    const std::vector<Material> materials = materials_of(problem);
    Bounds all{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    double strain = 0, least_viscous = HUGE_VAL;
    for (const PlannedGrain& plan : plan_grains(problem, materials)) {
        const Material& m = materials[plan.material];
        if (m.law == Law::rigid) continue;
        least_viscous = std::min(least_viscous, m.viscosity);
        const Bounds box = bounds(plan.outline);
        all.x_low = std::min(all.x_low, box.x_low), all.x_high = std::max(all.x_high, box.x_high);
        all.y_low = std::min(all.y_low, box.y_low), all.y_high = std::max(all.y_high, box.y_high);
        strain = std::max(strain, 1 / std::pow(sound_speed(m), 2));
    }
    if (strain == 0) return {};
    // Along a plate they slide, and around a ring they fall.
    const double g_x = std::fabs(problem.gravity_x), g_y = std::fabs(problem.gravity_y);
    strain *= g_y >= g_x            ? g_y * (all.y_high - all.y_low)
              : !problem.periodic_x ? g_x * (all.x_high - all.x_low)
                                    : 0;
    const double rate = 0.37 * scales.sound_speed / problem.mesh().h *
                        std::pow(std::max(1.0, parameters.alpha), -0.75),
                 left = std::max(0.0, 1 - least_viscous / (0.1 * scales.dt));
    const auto growth = [&](double e, double t) {
        return left * std::max(0.0, rate * e - 0.5 * problem.damping) * t;
    };
    return {growth(strain, std::max(0.0, parameters.end - problem.rise)),
            growth(plate_strain(parameters, materials).pressed, parameters.end)};
}

/// Warnings with the number and the limit, for choices that run but may mislead.
inline std::vector<std::string> warnings_of(const Case& parameters, const ThetaScheme& scheme,
                                            const Scales& scales) {
    std::vector<std::string> warnings = resolution_warnings(parameters, scales);
    const double cells = scales.speed * scales.dt / parameters.problem.mesh().h;
    if (cells > 0.5 && scales.grains > 1)
        warnings.push_back("|v| dt/h = " + format(cells) +
                           " is above 0.5: grains can pass through each other's surfaces before "
                           "they are seen to touch; reduce time.alpha");
    const auto [under_weight, between_plates] = growth_of_noise(parameters, scales);
    const double growth = under_weight + between_plates;
    const bool pressed = between_plates > under_weight;
    if (growth > (pressed ? 5 : 7) && scheme.theta < 0.505 && parameters.flip == 1)
        warnings.push_back(
            "method.theta = " + format(scheme.theta) +
            " damps nothing that rings, and in what is pressed noise may grow by a factor exp(" +
            format(growth) + ") until time.end: set " +
            (pressed && parameters.shape == "linear" ? "method.shape = \"gimp\", and " : "") +
            "method.theta = " + (pressed ? "0.6" : "0.51") +
            " or material.<name>.viscosity = " + format(0.1 * scales.dt) + ", a tenth of a step");
    const PlateStrain strain = plate_strain(parameters, materials_of(parameters.problem));
    const double most = std::max(strain.pressed, strain.stretched);
    if (parameters.shape == "linear" && most > 0.05)
        warnings.push_back(
            "grains are strained by " + format(most) +
            ", above 0.05: particles of linear shapes that cross lines of nodes make "
            "them too soft, by a tenth or more, and finer meshes more so; set "
            "method.shape = \"gimp\"");
    if (scheme.keeps_volumes() && most > 0.1)
        warnings.push_back("method.volumes = \"kept\", and grains are strained by " + format(most) +
                           ", above 0.1: forces are those of the first shape; take "
                           "\"updated\"");
    // On so fine meshes noise of smooth shapes takes velocity, too, unless theta damps it.
    const double crossed = cells_of_impact(parameters.problem, scales);
    const bool linear = parameters.shape == "linear", noisy = crossed > 1.2 && scheme.theta < 0.55;
    if ((linear && crossed > 0.6) || noisy)
        warnings.push_back(impact_warning(
            crossed, linear ? 0.6 : 1.2,
            linear ? "up to a tenth at 0.7 and a fifth at 1.4" : "up to a tenth at 1.4",
            std::string(linear ? "method.shape = \"gimp\"" : "") +
                (linear && noisy ? " and " : "") + (noisy ? "method.theta = 0.55" : "")));
    if (parameters.flip < 1)
        warnings.push_back("method.flip = " + format(parameters.flip) +
                           " is below 1: [MPM-13] is for FLIP, and the column pic takes the rest");
    if (parameters.problem.per_side == 1 && scheme.consistent())
        warnings.push_back(
            "grid.particles_per_side = 1 with the consistent mass matrix, which is then nearly "
            "singular: take 2, or method.mass = \"lumped\"");
    const std::vector<Material> materials = materials_of(parameters.problem);
    const std::string corner =
        sharp_corner(parameters.problem, plan_grains(parameters.problem, materials), materials);
    if (!corner.empty() && scheme.consistent())
        warnings.push_back("in " + corner +
                           ", below 20, particles are fewer than nodes, and the consistent mass "
                           "matrix may be nearly singular: " +
                           sharp_corner_cure);
    return warnings;
}

/// Memory of a run [bytes]: besides what every scheme needs, the matrices, their factors, vectors.
inline double bytes_of(const Case& parameters, const ThetaScheme& scheme, const Scales& scales) {
    const double per_cell = double(parameters.problem.per_side * parameters.problem.per_side),
                 dofs = 2 * double(scales.particles) / per_cell + 64 * double(scales.grains);
    // The envelope of a factor, in single precision; and in double precision that of a grain on one
    // or two threads, while it is factorized.
    const double diagonals = parameters.shape == "linear" ? 5 : 13,
                 across = std::sqrt(dofs / double(scales.grains)),
                 reach = parameters.shape == "linear" ? 1 : 2,
                 envelope = (scheme.preconditioner == "grains" ? 0.68 * across * reach : 0) +
                            (scheme.consistent() ? 0.17 * across * reach : 0),
                 factors = envelope * (1 + std::min(2.0, 3 / double(scales.grains))),
                 newton = scheme.newton() ? 2 * 30 + 16 : 0;
    return scales.bytes + 8 * dofs * (5 * diagonals + 2 * 14 + factors + newton);
}

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& parameters, const ThetaScheme& scheme,
                                   const Scales& scales) {
    // A step takes about as long as so many of the explicit program.
    const double cost = 6 + 6 * std::sqrt(parameters.alpha);
    return mpm::describe_scales(parameters, scales,
                                ", theta = " + format(scheme.theta) + ", " + scheme.mass + " mass",
                                cost);
}

}  // namespace mpm_implicit
