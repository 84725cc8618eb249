// Waves at the interface of light fluid above heavy fluid, between walls: waves on water, where the
// upper one is air.
#pragma once

#include "flip/theory/compare_instability.hpp"

namespace flip {

/// The frequency of the tracked mode.
inline double gravity_wave_frequency(const Case& parameters) {
    return theory::interface_frequency(layers_of(parameters), tracked_wave_number(parameters))
        .real();
}

/// Needs light fluid above heavy fluid between walls, whose sound is much faster than the wave.
inline void validate_gravity_wave(const Case& parameters, const Refusal& refuse) {
    validate_layers(parameters, refuse);
    const RegionCase &lower = parameters.regions[0], &upper = parameters.regions[1];
    refuse(!(gravity_wave_frequency(parameters) > 0), ": density ", upper.gas.density, " above ",
           lower.gas.density, " with gravity.z = ", parameters.gravity_z,
           " does not swing: turn one around");
    for (const RegionCase& r : parameters.regions) {
        const double c2 = stiffness(material_of(parameters, r),
                                    pressure_at_interface(parameters, r)) /
                          r.gas.density,
                     slow =
                         std::fabs(parameters.gravity_z) / (tracked_wave_number(parameters) * c2);
        refuse(slow > 0.5 * parameters.theory_tolerance,
               " is of fluids that keep their volume, and "
               "with the sound of region.",
               r.name, " the frequency changes by g/(k c^2) = ", slow,
               ": raise its pressure or material.", r.gas.material, ".p_infinity");
    }
}

/// The frequency of the wave.
inline std::string predict_gravity_wave(const Case& parameters, const std::string&, double) {
    const double omega = gravity_wave_frequency(parameters);
    return sentence("frequency ", omega, ", period ", 2 * pi / omega);
}

/// Warns of a run of less than two periods, and of a mesh that is coarse for the wave.
inline void warn_of_gravity_wave(const Case& parameters, std::vector<std::string>& warnings) {
    const double by_mesh = interface_rate_by_mesh(parameters, "flip"),
                 period = 2 * pi / gravity_wave_frequency(parameters);
    warn(warnings, by_mesh > 0 && 1 - by_mesh > parameters.theory_tolerance,
         "on this mesh the "
         "frequency is ",
         by_mesh,
         " of that of the fluids, which cannot slip within a cell, and "
         "theory.tolerance is ",
         parameters.theory_tolerance, ": refine the mesh");
    warn(warnings, parameters.end < 2 * period, "time.end = ", parameters.end,
         " is less than two periods, ", 2 * period, ": the frequency cannot be measured well");
    warn_of_viscous_wave(parameters, gravity_wave_frequency(parameters), warnings);
}

/// Frequency and amplitude of the wave, both directions of travel.
inline void compare_gravity_wave(const FinishedRun& run) {
    const Case& w = run.parameters;
    const double omega = gravity_wave_frequency(w), k = tracked_wave_number(w);
    const auto times = run.history.column("time");
    const std::vector<std::complex<double>> mode = run.history.complex_column("mode");
    run.info("theory_frequency", omega, "1/time", "two layers between walls");
    double steepest = 0, first = 0;  // of all, and of the first period
    for (std::size_t n = 0; n < mode.size(); ++n) {
        steepest = std::max(steepest, k * std::abs(mode[n]));
        if (omega * times[n] < 2 * pi) first = steepest;
    }
    run.info("steepness", steepest, "", "largest height times wave number");
    const char* const names[] = {"frequency_over_theory", "amplitude_per_period"};
    const auto give_up = [&](const std::string& why) {
        for (const char* name : names) run.not_measured(name, why);
    };
    if (steepest < 1e-9)
        return give_up("there is no wave: give a region an amplitude, or a ripple");
    if (steepest > 0.4)
        return give_up(sentence(
            "the wave has the steepness ", steepest, ", and theory is of small ones, below 0.4: ",
            first > 0.3 ? "lower the amplitude"
                        : sentence("in the first period it was ", first,
                                   ", and the rest is what steps and particles made: lower "
                                   "time.end, raise particles.per_cell_x and per_cell_z",
                                   run.program == "pic"   ? ", take flip"
                                   : w.transfer == "flip" ? ", take flip.transfer = \"xpic\""
                                                          : "",
                                   run.program == "flip" && w.implicit() && w.theta < 1
                                       ? ", or flip.theta = 1"
                                       : "")));
    common::ModeSearch search{.expected = {omega, -omega}};
    search.periods = 1.5;
    const common::MeasuredMode seen = measure_between_steps(times, mode, search);
    if (!seen.found) return give_up(seen.reason);
    double phase = 0, growth = 0;
    for (std::size_t n = 1; n < times.size(); ++n) {
        const theory::SwingingStep step =
            theory::swinging_step(omega, w.implicit() ? w.theta : 1, times[n] - times[n - 1]);
        phase += step.phase, growth += std::log(step.amplification);
    }
    const double of_steps = phase / times.back(), period = 2 * pi / omega;
    const double by_mesh = interface_rate_by_mesh(w, run.program);
    run.hint(
        "the wave has ", w.grid.x.cells / w.mode,
        " cells, and the fluids cannot slip within one, which costs most where their densities "
        "are alike: refine the mesh, ",
        steepest > 0.06 ? sentence("lower the amplitude, for the steepness is ", steepest,
                                   ", and above 0.06 that slows the wave, ")
                        : "",
        "raise particles.per_cell_x and per_cell_z, and take ", run.flip_with(),
        "flip.transfer = \"xpic\" where particles make more noise than the wave; viscosity damps "
        "it");
    run.summary.result(names[0], {seen.frequency() / of_steps, seen.frequency_error() / of_steps},
                       "", 1, w.theory_tolerance, "layers and steps; " + seen.window);
    if (by_mesh > 0)
        run.summary.result(
            "frequency_over_mesh",
            {seen.frequency() / of_steps / by_mesh, seen.frequency_error() / of_steps / by_mesh},
            "", 1, 0.4 * w.theory_tolerance,
            sentence("layers, steps and this mesh, ", by_mesh, " of what they are in the fluids"));
    const common::Measured kept(std::exp(seen.growth() * period), seen.growth_error() * period);
    const double expected = std::exp(growth / times.back() * period);
    if (run.program == "flip" && w.transfer == "flip")
        run.summary.result(names[1], kept, "", expected, 2 * w.theory_tolerance,
                           "steps; " + seen.window);
    else
        run.summary.result_at_most(names[1], kept, "", expected + 2 * w.theory_tolerance,
                                   "steps; the transfer takes some; " + seen.window);
}

inline constexpr Comparison gravity_wave_comparison{
    "gravity_wave",  validate_gravity_wave, predict_gravity_wave, warn_of_gravity_wave,
    track_interface, compare_gravity_wave,  Rows::several};

}  // namespace flip
