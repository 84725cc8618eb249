// The results of a run of mpm_implicit: what any scheme is compared with
// (mpm_explicit/theory/compare_grains.hpp), the energy theorem in every run, and what the theta
// scheme does to an oscillation, exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

#include "mpm_explicit/theory/compare_grains.hpp"
#include "mpm_explicit/theory/compare_plates.hpp"
#include "mpm_explicit/theory/compare_rotation.hpp"
#include "mpm_explicit/theory/scheme_theory.hpp"
#include "mpm_implicit/budget.hpp"
#include "mpm_implicit/theta_scheme.hpp"

namespace mpm_implicit {

/// Whether the theorem lets the scheme lose nothing: theta = 1/2, consistent mass, FLIP.
inline bool keeps_energy(const Case& parameters, const theory::SchemeFacts& scheme) {
    return scheme.theta == 0.5 && scheme.consistent_mass && parameters.flip == 1;
}

/// The properties of the theta scheme that comparisons use.
inline theory::SchemeFacts facts_of(const Case& parameters, const ThetaScheme& scheme) {
    theory::SchemeFacts facts{.theta = scheme.theta,
                              .force_level = scheme.theta,
                              .bond_level = scheme.theta - 1,
                              .implicit = true,
                              .consistent_mass = scheme.consistent()};
    facts.volumes_change = !scheme.keeps_volumes();
    const bool keeps = keeps_energy(parameters, facts) && !parameters.problem.has_friction();
    facts.bar_tolerance = keeps ? 1e-8 : std::numeric_limits<double>::infinity();
    facts.rebound_tolerance = facts.bar_tolerance;
    return facts;
}

/// [MPM-13] in every step, and that nothing but loads gives energy.
inline void compare_energy_theorem(const common::History& history, const Problem& problem,
                                   const ThetaScheme& scheme, const Budget& b,
                                   common::Summary& summary) {
    const auto energy = history.column("energy"), external = history.column("external"),
               volume = history.column("volume"), plastic = history.column("plastic");
    double size = std::numeric_limits<double>::min(), growth = 0;
    for (std::size_t n = 0; n < energy.size(); ++n)
        size = std::max({size, energy[n], std::fabs(external[n])});
    // Energy that plastic flow gives back comes from the law, not from the scheme.
    const auto given = [&](std::size_t n) {
        return energy[n] - external[n] - volume[n] + std::min(plastic[n], 0.0);
    };
    for (std::size_t n = 1; n < energy.size(); ++n)
        growth = std::max(growth, given(n) - given(n - 1));
    const std::vector<Material> materials = materials_of(problem);
    const std::string corner = sharp_corner(problem, plan_grains(problem, materials), materials);
    summary.hint(
        "the theorem is as good as the solution of a step: " +
        (scheme.tolerance > 1e-13 ? "lower solver.tolerance, which is " + format(scheme.tolerance)
         : scheme.consistent() && !corner.empty()
             ? "in " + corner + " the consistent mass matrix is nearly singular; " +
                   sharp_corner_cure
             : "round-off leaves no more than solver.tolerance = " + format(scheme.tolerance) +
                   "; where matrices are nearly singular grid.particles_per_side = 3 helps"));
    summary.result_at_most("energy_identity", b.largest_residual / size, "1", 1e-11,
                           "[MPM-13] with all other work, largest residual of a step over the "
                           "energy");
    if (scheme.keeps_volumes())
        return summary.result_at_most(
            "energy_growth", growth / size, "1", 1e-11,
            "between rows, beyond the work of the loads, over the energy");
    double gain = 0;
    for (std::size_t n = 0; n < energy.size(); ++n)
        gain = std::max(gain, given(n) + volume[n] - energy.front());
    summary.hint(
        "a law of small strain knows no energy of large ones: take method.volumes = "
        "\"kept\", or a stiffer material");
    summary.result_at_most("energy_gain", gain / size, "1", 0.05,
                           "beyond the work of the loads, over the energy; volumes that change "
                           "give energy that no theorem bounds");
}

/// Two disks that meet: their momentum, besides what any scheme is compared with.
inline void compare_rebound(const theory::FinishedRun& run, common::Summary& summary) {
    const auto x = run.history.column("momentum_x"), y = run.history.column("momentum_y");
    const GrainCase &a = run.planned.plans[0].from, &b = run.planned.plans[1].from;
    const double speed = std::hypot(a.velocity_x - b.velocity_x, a.velocity_y - b.velocity_y);
    double change = 0;
    for (std::size_t n = 0; n < x.size(); ++n)
        change = std::max(change, std::hypot(x[n] - x.front(), y[n] - y.front()));
    summary.hint("contact pushes both alike: lower solver.tolerance, and keep the walls away");
    summary.result_at_most("momentum_change", change / (0.5 * run.mass() * speed), "1", 1e-10,
                           "of both grains, over that of one about their center of mass");
    theory::compare_rebound(run, summary);
}

/// Needs what theory::need_bar needs, and the consistent mass matrix.
inline void need_bar(const theory::PlannedCase& planned) {
    theory::need_bar(planned);
    planned.refuse(!planned.scheme.consistent_mass,
                   " knows the damping of the consistent mass matrix only: set method.mass = "
                   "\"consistent\", or compare with \"oscillator\"");
}

/// What the theta scheme makes of the vibration of a bar: its frequency and damping.
inline void compare_bar(const theory::FinishedRun& run, common::Summary& summary) {
    const double dt = run.scales.dt, theta = run.planned.scheme.theta,
                 keeps = std::exp(-run.parameters.problem.damping * dt);
    if (keeps < 1e-6)
        return summary.not_measured("frequency",
                                    "load.damping leaves nothing of a velocity after a step: lower "
                                    "it, or time.alpha");
    const auto root_of = [&](double w) {
        return std::log(theta_node_oscillation(theta, w * dt, 1, keeps)) / dt;
    };
    const double frequency = std::imag(root_of(theory::bar_of(run).frequency()));
    theory::compare_bar_with(run, root_of, theta > 0.5 ? 0 : 1e-3 * frequency,
                             "the theta scheme's, for the exact frequency of the body", summary);
}

/// The one free node between two fixed ends, with frozen particles.
inline void compare_oscillator(const theory::FinishedRun& run, common::Summary& summary) {
    const theory::SchemeFacts& scheme = run.planned.scheme;
    const Problem& problem = run.parameters.problem;
    const int per_side = int(problem.per_side);
    const double dt = run.scales.dt, c = sound_speed(run.material()), h = problem.mesh().h,
                 filter = node_filter(per_side), f = scheme.consistent_mass ? 1 : filter,
                 w = c / h * std::sqrt(2 * f / filter);
    const double damping = problem.damping;
    const std::complex<double> g = theta_node_oscillation(scheme.theta, w * dt, f,
                                                          std::exp(-damping * dt)),
                               root = std::log(g) / dt;
    summary.result_info("omega_dt", w * dt, "1", "one free node, exact in space");
    const std::string source = std::string("exact factor of a step, theta scheme with ") +
                               (scheme.consistent_mass ? "consistent" : "lumped") + " mass";
    if (std::imag(g) == 0 && damping == 0) {
        summary.result_info("overdamped", std::real(g), "1", "nothing oscillates; " + source);
        return summary.not_measured("frequency",
                                    "nothing oscillates in so long steps with lumped "
                                    "mass: lower time.alpha");
    }
    // What of the momentum the node does not see stays, or falls by damping; its changes are the
    // node's alone.
    const double keeps = std::exp(-damping * dt * double(run.parameters.history_steps)),
                 within = run.parameters.tolerance * std::abs(root);
    theory::compare_root(run, theory::changes_of(run.momentum_x(), keeps), root, {within, within},
                         source, summary);
}

/// Needs a plate.
inline void need_compression(const theory::PlannedCase& planned) {
    planned.refuse(planned.rigid_grains() == 0, " needs a rigid grain that presses the others");
}

/// Grains that a plate presses: the energy is the work of the plate, less what other work took.
inline void compare_compression(const theory::FinishedRun& run, common::Summary& summary) {
    const auto energy = run.history.column("energy"), work = run.history.column("plate");
    std::vector<double> left = energy;
    double most = std::numeric_limits<double>::min(), apart = 0;
    for (const auto& [of, sign] : {std::pair("plate", -1),
                                   {"gravity", -1},
                                   {"damping", -1},
                                   {"friction", -1},
                                   {"bond", -1},
                                   {"viscous", -1},
                                   {"volume", -1},
                                   {"pic", -1},
                                   {"plastic", 1}}) {
        const auto done = run.history.column(of);
        for (std::size_t n = 0; n < left.size(); ++n) left[n] += sign * done[n];
    }
    for (std::size_t n = 0; n < left.size(); ++n)
        most = std::max({most, energy[n], std::fabs(work[n])}),
        apart = std::max(apart, std::fabs(left[n] - energy[0]));
    summary.hint("lower solver.tolerance");
    if (keeps_energy(run.parameters, run.planned.scheme))
        summary.result_at_most("energy_less_work", apart / most, "1", 1e-10,
                               "energy less work of plate, gravity, damping, friction, bonds, "
                               "viscosity, flow, volumes and walls, over the largest");
    summary.result_info("plate_work", work.back(), "energy", "at the end");
    if (energy.back() > 0)
        summary.result_info("kinetic_share", run.history.column("kinetic").back() / energy.back(),
                            "1", "of the energy at the end");
}

/// What a run of mpm_implicit can be compared with.
inline constexpr theory::Comparison comparisons[] = {
    {"rebound", theory::need_equal_disks, compare_rebound},
    {"bar", need_bar, compare_bar},
    {"standing_wave", theory::need_wave, theory::compare_standing_wave},
    {"oscillator", theory::need_oscillator, compare_oscillator},
    {"block", theory::need_block, theory::compare_block},
    {"rest", theory::need_rest, theory::compare_rest},
    {"spin", theory::need_spin, theory::compare_spin, theory::inertia_columns},
    {"rolling", theory::need_rolling, theory::compare_rolling, theory::turning_column},
    {"disk", theory::need_pressed_disk, theory::compare_disk, theory::center_columns},
    {"hertz", theory::need_hertz, theory::compare_hertz},
    {"bond", theory::need_bond, theory::compare_bond},
    {"yield", theory::need_yielding, theory::compare_yield},
    {"compression", need_compression, compare_compression},
    {"billet", theory::need_billet, theory::compare_billet},
    {"hold", theory::need_hold, theory::compare_hold},
    {"cycle", theory::need_cycle, theory::compare_cycle},
    {"energy"}};  // the energy theorem, which is tried in every run

}  // namespace mpm_implicit
