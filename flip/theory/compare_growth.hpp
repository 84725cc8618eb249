// Runs whose result is a rate: diffusion, waves, instabilities.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "flip/theory/finished_run.hpp"

namespace flip {

/// A Gaussian of energy that flows over the mesh: how fast its variance grows.
///   variance' = 2 D
inline void compare_diffusion(const FinishedRun& run) {
    const Case& w = run.w;
    const RegionCase& region = region_with_flow(w, "gaussian");
    const double u = region.gas.velocity_x, dx = w.grid.x.spacing();
    const double unit = std::fabs(u) * dx;
    const auto times = run.history.column("time"), variance = run.history.column("variance");
    const double D = 0.5 * slope(times, variance) / unit;
    run.summary.result_info("courant_number", std::fabs(u) * w.dt / dx, "", "|u| dt/dx");
    if (run.program == "pic") {
        const double expected =
            (w.loading == "lattice"
                 ? theory::harlow_lattice_diffusivity(u, dx, w.dt, static_cast<int>(w.per_cell_x))
                 : theory::harlow_diffusivity(u, dx, w.dt)) /
            unit;
        run.summary.result("diffusivity", D, "u dx", expected, w.theory_tolerance * 0.5,
                           "cells mix what enters them");
        run.summary.result_info("many_particles", theory::harlow_diffusivity(u, dx, w.dt) / unit,
                                "u dx", "(1 - C)/2, with many particles in a cell");
    } else {
        run.summary.result("diffusivity", D, "u dx", 0, w.theory_tolerance * 0.5,
                           "particles carry energy");
    }
}

/// A sound wave: frequency and amplitude against what each step of the method does to it.
inline void compare_wave(const FinishedRun& run) {
    const Case& w = run.w;
    const auto times = run.history.column("time");
    if (times.size() < 3) return;
    const double dt = times.back() / static_cast<double>(times.size() - 1);
    const SoundWave wave = sound_wave_of(w, run.program, dt);
    const Spiral spiral = unwound(run.history.column("mode_re"), run.history.column("mode_im"));
    const double frequency = -slope(times, spiral.phase), growth = slope(times, spiral.log_size);
    const double period = 2 * pi / wave.frequency, steps = period / dt;
    const std::string scheme =
        w.implicit() ? "theta scheme" : "explicit step: density follows the new velocity";
    run.summary.result_info("frequency", frequency, "1/time", "of velocity");
    run.summary.result_info("theory_frequency", wave.frequency, "1/time", "c k");
    run.result("frequency_over_ck", frequency / wave.frequency, "",
               wave.phase / (wave.frequency * dt), scheme);
    const double kept = std::exp(growth * period), expected = std::pow(wave.amplification, steps);
    const bool carried = run.program == "pic" && w.frame_x != 0;
    if (carried)
        run.summary.result_info("amplitude_per_period", kept, "", "the flow diffuses it");
    else
        run.summary.result("amplitude_per_period", kept, "", expected, w.theory_tolerance,
                           scheme + "; factor per step " + format(wave.amplification));
    const Spiral pressure =
        unwound(run.history.column("pressure_re"), run.history.column("pressure_im"));
    run.summary.result_info("pressure_amplitude_per_period",
                            std::exp(slope(times, pressure.log_size) * period), "", "measured");
    run.summary.result_info("periods", times.back() / period, "", "of c k");
}

/// A uniform flow that should stay one: how fast its noise grows.
inline void compare_ringing(const FinishedRun& run) {
    const Case& w = run.w;
    const double c = sound_speed_of(w, w.regions.front()), dx = w.grid.x.spacing();
    const auto times = run.history.column("time"), noise = run.history.column("noise");
    const common::GrowthFit fit = common::fit_growth(times, noise);
    run.summary.result_info("growth", fit.rate * dx / c, "c/dx",
                            fit.found ? "measured from t = " + format(fit.begin) + " to " +
                                            format(fit.end) + "; exact: 0"
                                      : fit.reason);
    run.summary.result_info("mach", std::fabs(w.regions.front().gas.velocity_x) / c, "",
                            "of the flow over the mesh");
    run.summary.result_info("largest_noise", run.history.largest("noise") / c, "c",
                            "rms of the velocity on the cells");
}

/// The growth of an interface or of a layer of shear.
/// note:   it is measured from the start, while the crests are lower than 0.3/k; the mode is the
///         height of the interface, or the velocity across the layer of shear
inline void compare_instability(const FinishedRun& run) {
    const Case& w = run.w;
    const double expected = theory_growth(w), k = followed_wave_number(w);
    const bool interface = w.compare == "rayleigh_taylor";
    const std::string source =
        interface ? "two layers between walls" : "layer of constant shear between walls";
    const auto times = run.history.column("time"), re = run.history.column("mode_re"),
               im = run.history.column("mode_im");
    std::vector<std::complex<double>> mode;
    for (std::size_t n = 0; n < re.size(); ++n) mode.emplace_back(re[n], im[n]);
    const double most = 0.3 / k * (interface ? 1 : expected);
    std::size_t count = 0;
    while (count < mode.size() && std::abs(mode[count]) < most) ++count;
    const HyperbolicFit fit = fit_hyperbolic(times, mode, count, expected);
    run.summary.result_info("theory_growth", expected, "1/time", source);
    if (fit.samples == 0) {
        run.summary.result_info("growth", 0, "1/time", "no five rows at small amplitude");
        return;
    }
    const std::string where = source + "; fitted up to t = " + format(times[count - 1]) +
                              ", misfit " + format(fit.misfit);
    run.summary.result_info("growth", fit.rate, "1/time", where);
    run.summary.result("growth_over_theory", fit.rate / expected, "", 1, w.theory_tolerance, where);
    run.summary.result("fit_misfit", fit.misfit, "", 0, 0.2,
                       "what is no sum of a growing and a decaying wave, rms");
    run.summary.result_info("e_foldings", expected * times[count - 1], "", "within the fit");
}

}  // namespace flip
