// The results of a run of mpm_explicit: what any scheme is compared with
// (mpm_explicit/theory/compare_grains.hpp), and the invariants that only leapfrog has.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "mpm_explicit/theory/compare_grains.hpp"
#include "mpm_explicit/theory/compare_plates.hpp"
#include "mpm_explicit/theory/compare_rotation.hpp"
#include "mpm_explicit/theory/scheme_theory.hpp"

namespace mpm_explicit {

using namespace mpm;

/// The one free node between two fixed ends, with frozen particles.
inline void compare_oscillator(const theory::FinishedRun& run, common::Summary& summary) {
    const Problem& problem = run.parameters.problem;
    const double h = problem.mesh().h, c = sound_speed(run.material()), dt = run.scales.dt,
                 w = node_oscillator_frequency(int(problem.per_side)) * c / h;
    summary.result_info("omega_dt", w * dt, "1", "one free node, exact");
    const auto e14 = run.history.column("energy_14"), e15 = run.history.column("energy_15"),
               kinetic = run.history.column("kinetic");
    // Beyond the limit the invariants are small differences of terms that grow.
    double most = 0, change_14 = 0, change_15 = 0;
    for (std::size_t n = 0; n < e14.size(); ++n) {
        const double size = std::max(std::fabs(e14.front()), kinetic[n]);
        most = std::max(most, kinetic[n] / kinetic.front());
        change_14 = std::max(change_14, std::fabs(e14[n] - e14.front()) / size);
        change_15 = std::max(change_15, std::fabs(e15[n] - e15.front()) / size);
    }
    const bool is_free = problem.damping == 0;
    const auto report = [&](const std::string& number, double change) {
        if (is_free)
            summary.result_at_most("change_of_energy_" + number, change, "1", 1e-12,
                                   "[MPM-" + number + "]: an invariant");
        else
            summary.not_measured("change_of_energy_" + number,
                                 "[MPM-" + number +
                                     "] is an invariant of free oscillations: "
                                     "take out load.damping");
    };
    summary.hint(
        "both are invariants as long as particles keep what the nodes give: take "
        "method.transfer = \"flip\"");
    report("14", change_14), report("15", change_15);
    summary.result_info("energy_14", e14.front() / kinetic.front(), "1",
                        "over the kinetic energy at the start; negative beyond omega dt = 2");
    const std::complex<double> g = leapfrog_factor(w * dt, std::exp(-problem.damping * dt),
                                                   node_filter(int(problem.per_side)));
    if (std::real(g) > 0 || std::imag(g) > 0)
        theory::compare_root(run, theory::changes_of(run.momentum_x()), std::log(g) / dt,
                             {problem.damping > 0 ? 1e-4 * w : 0, 1e-4 * w},
                             "leapfrog of one free node, exact in space", summary);
    summary.result_info("largest_kinetic", most, "1",
                        "over the initial: 1/(1 - (omega dt/2)^2) at most by [MPM-14], and beyond "
                        "omega dt = 2 nothing bounds it");
}

/// The properties of the leapfrog that comparisons use: how far its energy strays at alpha = 1/4.
inline constexpr theory::SchemeFacts leapfrog{
    .rebound_tolerance = 0.006, .bar_tolerance = 0.01, .bond_level = 0.5, .damps_first = true};

/// What a run of mpm_explicit can be compared with.
inline constexpr theory::Comparison comparisons[] = {
    {"rebound", theory::need_equal_disks, theory::compare_rebound},
    {"bar", theory::need_bar, theory::compare_bar},
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
    {"billet", theory::need_billet, theory::compare_billet},
    {"hold", theory::need_hold, theory::compare_hold},
    {"cycle", theory::need_cycle, theory::compare_cycle},
    {"collapse", theory::need_collapse, theory::compare_collapse, theory::front_column}};

}  // namespace mpm_explicit
