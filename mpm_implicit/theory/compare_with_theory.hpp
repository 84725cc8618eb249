// The results of a run of mpm_implicit: what any scheme is compared with
// (mpm_explicit/theory/compare_grains.hpp), the energy theorem in every run, what the theta scheme does to
// an oscillation, exactly, and what a block bears that is pressed slowly.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

#include "common/theory/theta_scheme.hpp"
#include "mpm_explicit/theory/compare_grains.hpp"
#include "mpm_explicit/theory/scheme_theory.hpp"
#include "mpm_implicit/budget.hpp"
#include "mpm_implicit/setup/check_case.hpp"

namespace mpm_implicit {

/// Whether the theorem lets the scheme lose nothing: theta = 1/2, consistent mass, FLIP.
inline bool keeps_energy(const Case& w, const ThetaScheme& scheme) {
    return scheme.theta == 0.5 && scheme.consistent() && w.flip == 1;
}

/// [MPM-13] in every step, and that nothing but loads gives energy.
inline void compare_energy_theorem(const theory::Run& run, const ThetaScheme& scheme,
                                   const Budget& l, common::Summary& summary) {
    const auto energy = run.history.column("energy"), external = run.history.column("external"),
               volume = run.history.column("volume"), plastic = run.history.column("plastic");
    double size = std::numeric_limits<double>::min(), growth = 0;
    for (std::size_t n = 0; n < energy.size(); ++n)
        size = std::max({size, energy[n], std::fabs(external[n])});
    // What plastic flow undoes is the law's affair, not the scheme's.
    const auto given = [&](std::size_t n) {
        return energy[n] - external[n] - volume[n] + std::min(plastic[n], 0.0);
    };
    for (std::size_t n = 1; n < energy.size(); ++n)
        growth = std::max(growth, given(n) - given(n - 1));
    summary.result("energy_identity", l.largest_residual / size, "1", 0, 1e-11,
                   "[MPM-13] with all other work, largest residual of a step over the energy");
    if (scheme.keeps_volumes())
        summary.result_within("energy_growth", growth / size, "1", 0, 1e-11,
                              "between rows, beyond the work of the loads, over the energy");
}

/// What the theta scheme makes of an oscillation of frequency w: its frequency and damping.
inline void compare_oscillation(const theory::Run& run, double w, double theta,
                                common::Summary& summary) {
    const double dt = run.scales.dt, rows = static_cast<double>(run.parameters.history_steps);
    const std::complex<double> g = common::theta_light_wave(theta, w * dt);
    const double frequency = std::arg(g) / dt, damping = -std::log(std::abs(g)) / dt;
    const common::OscillationFit fit =
        common::fit_oscillation(run.history.column("momentum_x"), dt * rows);
    summary.result("frequency", fit.frequency, "1/time", frequency,
                   run.parameters.tolerance * frequency,
                   "the theta scheme's, for the exact frequency of the body");
    if (theta > 0.5)
        summary.result("damping", -fit.growth, "1/time", damping,
                       run.parameters.tolerance * damping, "the theta scheme's");
    else
        summary.result("damping", -fit.growth / frequency, "1", 0, 1e-3,
                       "none, over the frequency");
}

/// The one free node between two fixed ends, with frozen particles.
inline void compare_oscillator(const theory::Run& run, const ThetaScheme& scheme,
                               common::Summary& summary) {
    const Problem& problem = run.parameters.problem;
    const int per_side = static_cast<int>(problem.per_side);
    const double dt = run.scales.dt, c = sound_speed(run.material()), h = problem.mesh().h,
                 filter = node_filter(per_side), f = scheme.consistent() ? 1 : filter,
                 w = c / h * std::sqrt(2 * f / filter);
    const std::complex<double> g = theta_node_oscillation(scheme.theta, w * dt, f);
    summary.result_info("omega_dt", w * dt, "1", "one free node, exact in space");
    // What of the momentum the node does not see stays; its changes are the node's alone.
    auto change = run.momentum_x();
    for (std::size_t n = 0; n + 1 < change.size(); ++n) change[n] = change[n + 1] - change[n];
    change.pop_back();
    const std::string source = "exact factor of a step, theta scheme with " + scheme.mass + " mass";
    if (std::imag(g) == 0) {
        summary.result_info("overdamped", std::real(g), "1", "nothing oscillates; " + source);
        return;
    }
    const double size = std::abs(std::log(g)) / dt, tolerance = run.parameters.tolerance * size;
    const common::OscillationFit fit =
        common::fit_oscillation(change, dt * static_cast<double>(run.parameters.history_steps));
    summary.result("frequency", fit.frequency, "1/time", std::arg(g) / dt, tolerance, source);
    summary.result("damping", -fit.growth, "1/time", -std::log(std::abs(g)) / dt, tolerance,
                   source);
}

/// A block that one plate presses against another, slowly: its modulus while it is elastic, and the
/// most that it bears when it can yield but not harden.
inline void compare_billet(const theory::Run& run, common::Summary& summary) {
    const Outline& block = run.plans[run.subject.grain].outline;
    const Bounds box = bounds(block);
    const std::string plate = billet_plate(run.parameters, run.plans, run.materials);
    const auto force = run.history.column("force_y_" + plate),
               way = run.history.column("travel_y_" + plate);
    const double width = box.x_high - box.x_low, height = box.y_high - box.y_low,
                 press = std::fabs(force.back()) / width;
    const Material m = run.material();
    summary.result_info("strain", std::fabs(way.back()) / height, "1", "at the end");
    if (m.law == Law::j2) {
        const double limit = plane_strain_strength(m.yield_stress);
        summary.result("limit", press / limit, "1", 1, run.parameters.tolerance,
                       "stress on the plate at the end, over 2 Y/3^1/2, a plane block's limit");
        return;
    }
    std::vector<double> strain, stress;
    for (std::size_t n = 0; n < way.size(); ++n)
        strain.push_back(std::fabs(way[n]) / height), stress.push_back(std::fabs(force[n]) / width);
    const double exact = plane_strain_modulus(m.E, m.nu);
    summary.result("modulus", theory::slope(strain, stress, 0.5 * strain.back()), "stress", exact,
                   run.parameters.tolerance * exact,
                   "E/(1 - nu^2): stress on the plate against strain, second half of the run");
}

/// Grains that a plate presses: the energy is the work of the plate.
inline void compare_compression(const theory::Run& run, const ThetaScheme& scheme,
                                common::Summary& summary) {
    const auto energy = run.history.column("energy"), work = run.history.column("plate"),
               friction = run.history.column("friction");
    const double most =
        std::max(*std::max_element(work.begin(), work.end()), std::numeric_limits<double>::min());
    double apart = 0;
    for (std::size_t n = 0; n < energy.size(); ++n)
        apart = std::max(apart, std::fabs(energy[n] - energy[0] - work[n] - friction[n]));
    if (keeps_energy(run.parameters, scheme))
        summary.result("energy_less_work", apart / most, "1", 0, 1e-10,
                       "energy less work of plate and friction, over the work");
    summary.result_info("plate_work", work.back(), "energy", "at the end");
    summary.result_info("kinetic_share", run.history.column("kinetic").back() / energy.back(), "1",
                        "of the energy at the end");
}

inline void compare_with_theory(const theory::Run& run, const ThetaScheme& scheme, const Budget& l,
                                common::Summary& summary) {
    const Case& w = run.parameters;
    compare_energy_theorem(run, scheme, l, summary);
    const double none = std::numeric_limits<double>::infinity();
    const bool keeps = keeps_energy(w, scheme) && w.problem.contact.friction == 0;
    if (w.compare == "bar") {
        if (scheme.consistent())
            compare_oscillation(run, theory::bar_of(run).frequency(), scheme.theta, summary);
        return;
    }
    if (w.compare == "oscillator") compare_oscillator(run, scheme, summary);
    if (w.compare == "billet") compare_billet(run, summary);
    if (w.compare == "compression") compare_compression(run, scheme, summary);
    if (w.compare == "rebound") {
        const auto total = run.history.column("momentum_x"), one = run.momentum_x();
        double change = 0;
        for (const double p : total) change = std::max(change, std::fabs(p - total.front()));
        summary.result("momentum_change", change / std::fabs(one.front()), "1", 0, 1e-10,
                       "of both grains, over that of one");
    }
    mpm::compare_with_theory(run, {.rebound = keeps ? 1e-8 : none, .bar = keeps ? 1e-8 : none},
                             summary);
}

}  // namespace mpm_implicit
