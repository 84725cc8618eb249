// Sound: a wave, against what each step of the method does to it; and a uniform flow, which should
// make none.
#pragma once

#include <algorithm>
#include <complex>
#include <span>

#include "flip/theory/acoustics.hpp"
#include "flip/theory/modes.hpp"

namespace flip {

/// What one time step does to the tracked sound wave, in the frame of the gas.
struct SoundWave {
    double frequency;      // c k
    double phase;          // by which a step turns it
    double amplification;  // by which a step multiplies it
};

/// The sound wave of a case in steps of dt.
inline SoundWave sound_wave_of(const Case& parameters, const std::string& program, double dt) {
    const RegionCase& r = region_with_flow(parameters, "wave");
    const double k = tracked_wave_number(parameters), dx = parameters.grid.x.spacing(),
                 c = sound_speed_of(parameters, r);
    const bool on_cells = program == "pic";
    // Differences over two cells, or from cells to the nodes between them.
    const double kappa = on_cells ? std::sin(k * dx) / dx : 2 * std::sin(0.5 * k * dx) / dx;
    const double a = c * kappa * dt;
    // In a gas 1/gamma of a change of pressure is that of density at constant energy; in a
    // stiffened gas it is (p + gamma p_infinity)/(gamma (p + p_infinity)).
    const Material& gas = material_of(parameters, r);
    const double p = r.gas.pressure, gamma = stiffness(gas, p) / (p + gas.gamma * gas.p_infinity);
    theory::WaveTransfer part;
    if (!on_cells) {
        const double once = theory::pic_smoothing(k, dx), lost = 1 - once;
        part.increment = part.energy = once;
        if (parameters.transfer == "pic") part.kept = once;
        if (parameters.transfer == "blend")
            part.kept = parameters.blend + (1 - parameters.blend) * once;
        if (parameters.transfer == "xpic")
            part.kept = 1 - std::pow(lost, double(parameters.xpic_order));
        // A particle of apic hands both nodes of its row what it has from them.
        if (parameters.transfer == "apic") part.increment = 1;
        if (parameters.mass == "consistent")
            part.increment = 1, part.response = 1 / once, part.level = 1;
        // Motion changes the mass in a cell by what crosses its ends, with the velocity around them.
        part.density = parameters.density == "cells" ? 1 - 0.75 * lost : once;
    }
    const std::complex<double> factor =
        theory::carried_factor(parameters.implicit() ? parameters.theta : -1, gamma, a, part);
    return {c * k, std::arg(factor), std::abs(factor)};
}

/// The part of its frequency that the mesh alone takes from the wave of a case.
/// note: of a transfer that smooths in every step, without that: short steps would leave no wave
inline double slowed_by_mesh(const Case& parameters, const std::string& program) {
    Case kept = parameters;
    if (kept.transfer != "apic") kept.transfer = "flip";
    const double short_dt = 1e-3 / sound_wave_of(kept, program, 1).frequency;
    return 1 - sound_wave_of(kept, program, short_dt).phase / 1e-3;
}

/// How many particles a sound wave takes across a border of cells: its displacement, amplitude/k, over
/// the distance of particles. Where that is below 1/2 no cell of pic gains or loses one.
inline double particles_moved(const Case& parameters, const RegionCase& r) {
    return std::fabs(r.amplitude) * double(parameters.grid.x.cells * parameters.per_cell_x) /
           (2 * pi * double(r.mode));
}

/// How many it has to take for a frequency within two per cent, as measured with the most particles
/// that a cell may have; with a quarter of them sound is 13 per cent too fast.
inline constexpr double enough_moved = 2;
inline constexpr long enough_per_cell = 64;

/// What a wave needs so that pic shows it.
inline std::string cure_of_pic(const Case& parameters, const RegionCase& r) {
    Case many = parameters;
    many.per_cell_x = enough_per_cell;
    const double moved = particles_moved(many, r);
    return sentence("take flip, or particles.per_cell_x = ", enough_per_cell,
                    moved < enough_moved && moved > 0
                        ? sentence(" with region.", r.name,
                                   ".amplitude = ", std::fabs(r.amplitude) * enough_moved / moved)
                        : "");
}

/// Whether the lattice itself drowns a wave until the end: an odd number of particles across a cell puts
/// one at its center, where the density of the cell bends. As measured with 1, 3, 5 and 7 of them, in
/// any mode.
inline bool drowns_in_noise(const Case& parameters, const RegionCase& r) {
    const double crossed =
        sound_speed_of(parameters, r) / parameters.grid.x.spacing() * parameters.end;
    return parameters.density == "cells" && parameters.transfer != "pic" &&
           !parameters.implicit() && parameters.loading == "lattice" && parameters.q_linear < 0.1 &&
           parameters.per_cell_x % 2 == 1 && crossed > 50 * double(parameters.per_cell_x);
}

/// Needs a single region of gas with a sound wave whose mode is tracked.
inline void validate_wave(const Case& parameters, const Refusal& refuse) {
    validate_flow(parameters, refuse, "wave");
    validate_mode(parameters, refuse, "wave");
    const RegionCase& r = region_with_flow(parameters, "wave");
    refuse(r.amplitude == 0, " needs a wave: give region.", r.name, ".amplitude");
    refuse(parameters.regions.size() != 1, " needs a single region");
    refuse(sound_speed_of(parameters, r) == 0, " needs a gas with sound: give region.", r.name,
           ".pressure");
    validate_no_force(parameters, refuse);
    refuse(parameters.viscosity > 0, " is for sound that nothing damps: take out flip.viscosity");
    refuse(r.gas.velocity_x != parameters.frame_x, ": the gas moves with ", r.gas.velocity_x,
           ": set theory.frame_x to that");
}

/// "+ 0.1" or "- 0.1", to stand behind another number.
inline std::string with_sign(double value) {
    return sentence(value < 0 ? "- " : "+ ", std::fabs(value));
}

/// The period, and the factor by which a step multiplies the wave.
inline std::string predict_wave(const Case& parameters, const std::string& program, double dt) {
    const SoundWave s = sound_wave_of(parameters, program, dt);
    return sentence("period ", 2 * pi / s.frequency, "; a step of ", dt,
                    " multiplies the wave by 1 ", with_sign(s.amplification - 1));
}

/// Warns of a run shorter than one period, and of a viscosity that damps the wave.
inline void warn_of_wave(const Case& parameters, std::vector<std::string>& warnings) {
    const double c = sound_speed_of(parameters, region_with_flow(parameters, "wave")),
                 period = 2 * pi / (c * tracked_wave_number(parameters));
    warn(warnings, period > parameters.end, "the wave has the period ", period,
         ", longer than time.end = ", parameters.end, ": its frequency cannot be measured well");
    warn(warnings, parameters.q_linear > 0, "viscosity.linear = ", parameters.q_linear,
         " damps the wave, and theory is of sound that nothing damps: set it to 0");
}

/// The mode of velocity and pressure, in the frame of theory.
inline void track_wave(const Snapshot& now, common::Row& row) {
    const Case& parameters = now.parameters;
    const double from = parameters.grid.x.low + parameters.frame_x * now.state.time;
    row.add("mode", "velocity",
            mode_of(parameters, now.cells.vx, 0, parameters.grid.z.cells, from));
    row.add("pressure", "pressure",
            mode_of(parameters, now.cells.p, 0, parameters.grid.z.cells, from));
}

/// Phase and logarithm of the size of a mode that turns by less than half a turn between samples.
struct Spiral {
    std::vector<double> phase, log_size;
};
/// The phase and size of each sample.
inline Spiral unwound(const std::vector<std::complex<double>>& mode) {
    Spiral s;
    for (const std::complex<double>& z : mode) {
        const double phase = std::atan2(z.imag(), z.real());
        const double before = s.phase.empty() ? phase : s.phase.back();
        s.phase.push_back(before + std::remainder(phase - before, 2 * pi));
        s.log_size.push_back(std::log(std::max(std::hypot(z.real(), z.imag()), 1e-300)));
    }
    return s;
}

/// What the steps of a run make of a wave, one by one: steps of implicit pressure may grow.
inline Spiral spiral_of_theory(const Case& parameters, const std::string& program,
                               std::span<const double> times) {
    Spiral s{{0}, {0}};
    for (std::size_t n = 1; n < times.size(); ++n) {
        const SoundWave step = sound_wave_of(parameters, program, times[n] - times[n - 1]);
        s.phase.push_back(s.phase.back() + step.phase);
        s.log_size.push_back(s.log_size.back() + std::log(step.amplification));
    }
    return s;
}

/// Below this part of the start, a wave that its steps damp is lost in what they leave beside it.
inline constexpr double least_of_wave = 0.01;

/// How many rows of a run there are before theory leaves less of the wave.
inline std::size_t rows_of_wave(const Spiral& theory) {
    const auto dead = [](double log_size) { return log_size < std::log(least_of_wave); };
    return std::size_t(std::ranges::find_if(theory.log_size, dead) - theory.log_size.begin());
}

/// The rms of the velocity along x on the cells, about its mean.
inline double rms_velocity(const Case& parameters, const CellFields& cells) {
    const std::vector<double> vx = mean_over_z(parameters.grid, cells.vx);
    double mean = 0, squares = 0;
    for (const double v : vx) mean += v / double(vx.size());
    for (const double v : vx) squares += (v - mean) * (v - mean);
    return std::sqrt(squares / double(vx.size()));
}

/// Frequency, and the change of the amplitude in a period, both from slopes as those of theory.
inline void compare_wave(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    auto times = run.history.column("time");
    if (times.size() < 3)
        return run.summary.not_measured("frequency_over_ck", "the run has fewer than two steps");
    const double dt = times.back() / double(times.size() - 1);
    const SoundWave wave = sound_wave_of(parameters, run.program, dt);
    Spiral velocity = unwound(run.history.complex_column("mode")),
           pressure = unwound(run.history.complex_column("pressure")),
           theory = spiral_of_theory(parameters, run.program, times);
    const double period = 2 * pi / wave.frequency, steps = period / dt;
    const auto per_period = [&](const Spiral& mode) {
        return std::exp(common::slope(times, mode.log_size) * period);
    };
    const std::string scheme = sentence(
        parameters.implicit() ? "theta scheme" : "explicit step", " on this mesh",
        parameters.implicit() || wave.amplification <= 1 + 1e-12 ? "" : ", which makes sound grow");
    const RegionCase& r = region_with_flow(parameters, "wave");
    const bool flips = run.program == "flip", odd = flips && drowns_in_noise(parameters, r),
               random = flips && parameters.loading == "random" && parameters.density == "cells";
    const double cells = double(parameters.grid.x.cells) / double(parameters.mode),
                 moved = particles_moved(parameters, r),
                 shocks =
                     1 / (pi * (material_of(parameters, r).gamma + 1) * std::fabs(r.amplitude));
    double steepened = 0;  // the part of the way to a shock that the wave has come
    for (std::size_t n = 1; n < times.size(); ++n)
        steepened += std::exp(theory.log_size[n]) * (times[n] - times[n - 1]) / (period * shocks);
    // The rms of what is not the wave, times the root of 2 like an amplitude.
    const double size = std::exp(velocity.log_size.back()),
                 all = rms_velocity(run.parameters, run.cells),
                 rest = std::sqrt(std::max(0.0, 2 * all * all - size * size));
    const double wave_speed = sound_speed_of(parameters, r);
    const std::string noise = sentence("what is not the wave has the amplitude ", rest,
                                       " at time.end, and the wave ", size);
    const std::string even = sentence(
        noise,
        random ? ": particles at random places fill cells unevenly; take particles.loading "
                 "= \"lattice\", or raise region." +
                     r.name + sentence(".amplitude above ", 3 * rest / wave_speed)
               : ": take an even number of particles across a cell",
        ", or flip.density = \"particles\"");
    // The noise of particles at random places is in all modes alike, and a part of it in that of the wave.
    if ((odd && rest > size) || (random && rest > 3 * size))
        return run.not_measured("frequency_over_ck", even);
    const std::size_t rows = rows_of_wave(theory);
    const double seen = times[rows - 1];
    if (rows < times.size() && (seen < period || rows < 8))
        return run.not_measured(
            "frequency_over_ck", "after ", seen / period, " periods and ", rows - 1,
            " steps theory leaves less than ", least_of_wave, " of the wave: ",
            parameters.implicit() && parameters.theta > 0.5
                ? sentence("set time.dt = ", 0.3 / wave.frequency, " or flip.theta = 0.5")
                : "take flip.transfer = \"flip\", or a longer wave");
    times.resize(rows);
    for (Spiral* s : {&velocity, &pressure, &theory})
        s->phase.resize(rows), s->log_size.resize(rows);
    const double frequency = -common::slope(times, velocity.phase);
    run.info("frequency", frequency, "1/time", "of velocity");
    if (const double speed = std::fabs(r.amplitude) * wave_speed; r.noise > 0.1 * speed)
        run.hint("region.", r.name, ".noise = ", r.noise, " is not far below ", speed,
                 ", the velocity in the wave: lower it below a tenth of that, or take it out");
    else if (!flips)
        run.hint("the wave takes ", moved, " particles across a border of cells, of ",
                 parameters.per_cell_x,
                 " in a cell, and cells of pic feel no other motion: ", cure_of_pic(parameters, r),
                 " and theory.tolerance = 0.02");
    else if (odd)
        run.hint(
            "with an odd number of particles across a cell one is at its center, where the "
            "density of the cell bends, and weak flow grows: take an even number");
    else if (random && rest > 0.1 * size)
        run.hint(even);
    else if (steepened > 0.3)
        run.hint("the crests of this wave, which explicit steps let grow by a factor ",
                 std::exp(theory.log_size.back()),
                 " until time.end, become shocks on the way: lower region.", r.name,
                 ".amplitude, time.end or time.cfl");
    else
        run.hint(
            "the theory is of a weak wave without viscosity on many particles, and this one has ",
            cells, " cells, ", steps, " steps in a period and ", times.back() / period,
            " periods: below 16, 8 or 1 refine the mesh, shorten time.dt or raise time.end; else "
            "set viscosity.linear = viscosity.quadratic = flip.viscosity = 0, or lower the "
            "amplitude: its crests are shocks after ",
            shocks, " periods");
    run.info("theory_frequency", wave.frequency, "1/time", "c k");
    run.result("frequency_over_ck", frequency / wave.frequency, "",
               common::slope(times, theory.phase) / wave.frequency, scheme);
    if (run.program == "pic" && parameters.frame_x != 0)
        run.info("amplitude_per_period", per_period(velocity), "", "the flow diffuses it");
    else
        run.absolute_result("amplitude_per_period", per_period(velocity), "", per_period(theory),
                            sentence(scheme, "; in a step 1 ", with_sign(wave.amplification - 1)));
    run.info("pressure_amplitude_per_period", per_period(pressure), "", "measured");
    run.info("periods", times.back() / period, "", "of c k");
}

/// Needs a uniform gas with noise on a periodic mesh.
inline void validate_ringing(const Case& parameters, const Refusal& refuse) {
    const RegionCase& r = parameters.regions.front();
    refuse(parameters.regions.size() != 1 || r.flow != "uniform" || r.shape != "everywhere" ||
               !parameters.grid.x.periodic,
           " needs a single uniform region everywhere, and periodic ends in x");
    refuse(sound_speed_of(parameters, r) == 0, " needs a gas with sound");
    validate_no_force(parameters, refuse);
    refuse(r.noise == 0, " needs a seed: give region.", r.name, ".noise");
}

/// The rms of the velocity on the cells.
inline void track_ringing(const Snapshot& now, common::Row& row) {
    row.add("noise", "velocity", rms_velocity(now.parameters, now.cells));
}

/// A uniform flow should stay one: how fast its noise grows, within a tenth of the tolerance.
inline void compare_ringing(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const RegionCase& r = parameters.regions.front();
    const double c = sound_speed_of(parameters, r), dx = parameters.grid.x.spacing();
    const auto times = run.history.column("time"), noise = run.history.column("noise");
    const double level = 0.2 * run.history.largest("noise");
    const auto end = std::ranges::find_if(noise, [&](double a) { return a >= level; });
    std::vector<double> t, log_noise;
    auto begin = std::min_element(noise.begin(), end);
    // The noise of the start stays what it is until that which grows comes out of it.
    const double least = begin == end ? 0 : *begin;
    if (run.history.largest("noise") > 30 * least)
        for (auto at = begin; at != end; ++at)
            if (*at <= 3 * least) begin = at;
    for (auto at = begin; at != end; ++at)
        if (*at > 0) t.push_back(times[at - noise.begin()]), log_noise.push_back(std::log(*at));
    const double rate = t.size() < 8 ? 0 : common::slope(t, log_noise);
    const double crossed = run.state.time * c / dx;
    run.hint("the mesh does not see how particles lie in its cells: take ", run.flip_with(),
             "flip.pressure = \"implicit\", or a frame in which the flow is slower than Mach 0.07");
    if (crossed < 100)
        run.not_measured("growth", "sound has crossed ", crossed,
                         " cells, below 100, in which ringing grows by 20 to 150: raise time.end");
    else
        run.summary.result_at_most(
            "growth", rate * dx / c, "c/dx", 0.1 * parameters.theory_tolerance,
            "slope of the logarithm of the noise, from thrice its least to a fifth of its largest");
    run.info("mach", std::fabs(r.gas.velocity_x) / c, "", "of the flow over the mesh");
    run.info("largest_noise", run.history.largest("noise") / c, "c",
             "rms of the velocity on the cells");
}

inline constexpr Comparison wave_comparison{"wave",       validate_wave,       predict_wave,
                                            warn_of_wave, track_wave,          compare_wave,
                                            Rows::any,    Frame::moves_along_x};

inline constexpr Comparison ringing_comparison{"ringing", validate_ringing, nullptr,
                                               nullptr,   track_ringing,    compare_ringing};

}  // namespace flip
