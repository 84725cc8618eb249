// The results of a run of mpm_implicit: what any scheme is compared with
// (common/mpm/compare_with_theory.hpp), the energy theorem in every run, and what the theta scheme
// does to an oscillation, exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/mpm/compare_with_theory.hpp"
#include "common/mpm/scheme_theory.hpp"
#include "common/theta_scheme.hpp"
#include "mpm_implicit/case.hpp"
#include "mpm_implicit/ledger.hpp"

namespace mpm_implicit {

/// Whether the theorem lets the scheme lose nothing: theta = 1/2, consistent mass, FLIP.
inline bool keeps_energy(const Case& w, const ThetaScheme& scheme) {
    return scheme.theta == 0.5 && scheme.consistent() && w.flip == 1;
}

/// [MPM-13] in every step, and that nothing but loads gives energy.
inline void compare_energy_theorem(const theory::Run& run, const ThetaScheme& scheme,
                                   const Ledger& l, common::Summary& summary) {
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
    const double dt = run.scales.dt, rows = static_cast<double>(run.wanted.history_steps);
    const std::complex<double> g = common::theta_light_wave(theta, w * dt);
    const double frequency = std::arg(g) / dt, damping = -std::log(std::abs(g)) / dt;
    const common::OscillationFit fit =
        common::fit_oscillation(run.history.column("momentum_x"), dt * rows);
    summary.result("frequency", fit.frequency, "1/time", frequency,
                   run.wanted.tolerance * frequency,
                   "the theta scheme's, for the exact frequency of the body");
    if (theta > 0.5)
        summary.result("damping", -fit.growth, "1/time", damping, run.wanted.tolerance * damping,
                       "the theta scheme's");
    else
        summary.result("damping", -fit.growth / frequency, "1", 0, 1e-3,
                       "none, over the frequency");
}

/// Grains that a plate presses: the energy is the work of the plate.
inline void compare_compression(const theory::Run& run, const ThetaScheme& scheme,
                                common::Summary& summary) {
    const auto energy = run.history.column("energy"), work = run.history.column("plate"),
               friction = run.history.column("friction");
    const double most = *std::max_element(work.begin(), work.end());
    double apart = 0;
    for (std::size_t n = 0; n < energy.size(); ++n)
        apart = std::max(apart, std::fabs(energy[n] - energy[0] - work[n] - friction[n]));
    if (keeps_energy(run.wanted, scheme))
        summary.result("energy_less_work", apart / most, "1", 0, 1e-10,
                       "energy less work of plate and friction, over the work");
    summary.result_info("plate_work", work.back(), "energy", "at the end");
    summary.result_info("kinetic_share", run.history.column("kinetic").back() / energy.back(), "1",
                        "of the energy at the end");
}

inline void compare_with_theory(const theory::Run& run, const ThetaScheme& scheme, const Ledger& l,
                                common::Summary& summary) {
    const Case& w = run.wanted;
    compare_energy_theorem(run, scheme, l, summary);
    const double none = std::numeric_limits<double>::infinity();
    const bool keeps = keeps_energy(w, scheme) && w.problem.contact.friction == 0;
    if (w.compare == "bar") {
        if (scheme.consistent())
            compare_oscillation(run, theory::bar_of(run).frequency(), scheme.theta, summary);
        return;
    }
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
