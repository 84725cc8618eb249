// Waves of a column that turns about its axis, held together by its rotation, or torn apart where that
// falls outward.
#pragma once

#include <gsl/gsl_sf_bessel.h>

#include <complex>

#include "flip/theory/compare_instability.hpp"
#include "flip/theory/rotating_column.hpp"

namespace flip {

/// The pressure of a fluid.
inline double pressure_of(const Case& parameters, const FluidState& fluid) {
    return pressure(parameters.materials[fluid.material], fluid.density, fluid.e);
}

/// The column of a case, and the wave with theory.mode half wavelengths between its ends.
inline theory::RotatingColumn column_of(const Case& parameters) {
    const common::Axis &x = parameters.grid.x, &z = parameters.grid.z;
    const auto at = [&parameters, middle = z.low + 0.5 * z.length](double r) {
        return fluid_of(parameters, parameters.regions.front(), r, middle);
    };
    return {
        x.length, pi * double(parameters.mode) / z.length, [at](double r) { return at(r).v_theta; },
        [at, &parameters](double r) {
            const FluidState fluid = at(r);
            return stiffness(parameters.materials[fluid.material], pressure_of(parameters, fluid)) /
                   fluid.density;
        }};
}

/// omega of the wave: real, or imaginary where it grows.
inline std::complex<double> inertial_frequency_of(const Case& parameters) {
    return std::sqrt(std::complex<double>(theory::inertial_frequency_2(column_of(parameters))));
}

/// Needs one gas that turns about the axis between slip walls, alike along z.
inline void validate_inertial_wave(const Case& parameters, const Refusal& refuse) {
    const RegionCase& r = parameters.regions.front();
    refuse(!parameters.grid.axisymmetric,
           " is a wave about an axis: set grid.geometry = \"axisymmetric\"");
    refuse(parameters.regions.size() != 1 || r.shape != "everywhere",
           " needs a single region everywhere");
    refuse(!r.turns(), " needs fluid that turns: give region.", r.name, ".angular_velocity");
    refuse(!r.gas.density.is_number(), " needs the density of region.", r.name, " as a number");
    refuse(material_of(parameters, r).gamma == 1, " needs a gas, and region.", r.name, " is dust");
    for (const Side s : {x_high, z_low, z_high})
        refuse(!parameters.is(s, "slip"), " needs walls that slip: set boundary.", side_names[s],
               " = \"slip\"");
    refuse(parameters.gravity_z != 0, " is without gravity: take out gravity.z");
    refuse(2 * parameters.mode > parameters.grid.z.cells,
           " follows theory.mode = ", parameters.mode, " half wavelengths along z, and ",
           parameters.grid.z.cells, " cells have no more than ", parameters.grid.z.cells / 2,
           ": refine the mesh or lower it");
    const common::Axis &x = parameters.grid.x, &z = parameters.grid.z;
    const auto column = [&](double at, double height) {
        return fluid_of(parameters, r, at, height);
    };
    const double middle = z.low + 0.5 * z.length;
    double fastest = 0, strongest = 0, off = 0;
    for (const double part : {0.25, 0.5, 0.75, 1.0}) {
        const double at = 0.999 * x.length * part, h = 1e-3 * x.length;
        const FluidState fluid = column(at, middle);
        for (long j = 0; j < z.cells; ++j)
            refuse(
                std::fabs(column(at, z.at(double(j) + 0.5)).v_theta - fluid.v_theta) >
                    1e-9 * std::fabs(fluid.v_theta),
                " needs a rotation that is the same at each z, and region.", r.name,
                ".velocity_theta changes: in formulas x is the distance from the axis, r that from "
                "the center of the region");
        const double push = fluid.density * fluid.v_theta * fluid.v_theta / at,
                     rise = (pressure_of(parameters, column(at + h, middle)) -
                             pressure_of(parameters, column(at - h, middle))) /
                            (2 * h);
        fastest = std::max(fastest, std::fabs(fluid.v_theta));
        strongest = std::max(strongest, push), off = std::max(off, std::fabs(rise - push));
    }
    refuse(off > 0.01 * strongest, " needs a pressure that holds the column together: set region.",
           r.name, ".hydrostatic = true");
    refuse(std::fabs(column(1e-6 * x.length, middle).v_theta) > 1e-3 * fastest,
           " needs a rotation about the axis, and region.", r.name,
           ".velocity_theta is not 0 there");
    // Where a wave has its largest velocity across the axis, the parts of its modes along z.
    const auto seeded = [&](long mode) {
        double sum = 0;
        for (long j = 0; j < z.cells; ++j) {
            const double at = (double(j) + 0.5) / double(z.cells);
            sum += column(0.48 * x.length, z.low + at * z.length).vx *
                   std::cos(pi * double(mode) * at);
        }
        return std::fabs(sum);
    };
    long most = parameters.mode;
    for (long mode = 1; 2 * mode <= z.cells; ++mode)
        if (seeded(mode) > seeded(most)) most = mode;
    refuse(seeded(parameters.mode) < 0.01 * seeded(most),
           " follows theory.mode = ", parameters.mode, ", and region.", r.name,
           ".velocity_x has mode ", most, ": make them the same");
    refuse(inertial_frequency_of(parameters) == 0.0,
           " has no wave: the angular momentum is the same everywhere");
}

/// The period, or the growth rate.
inline std::string predict_inertial_wave(const Case& parameters, const std::string&, double) {
    const std::complex<double> omega = inertial_frequency_of(parameters);
    return omega.imag() > 0 ? sentence("growth rate ", omega.imag())
                            : sentence("period ", 2 * pi / omega.real());
}

/// Warns of a run too short to measure the wave.
inline void warn_of_inertial_wave(const Case& parameters, std::vector<std::string>& warnings) {
    const std::complex<double> omega = inertial_frequency_of(parameters);
    const double needs = omega.imag() > 0 ? 3 / omega.imag() : 4 * pi / omega.real();
    warn(warnings, needs > parameters.end, "time.end = ", parameters.end, " is less than ", needs,
         omega.imag() > 0 ? ", three e-foldings of the wave" : ", two periods of the wave",
         ": it cannot be measured well");
}

/// The part of v_r that goes as J_1(j_1 r/R) cos k (z - low).
inline void track_inertial_wave(const Snapshot& now, common::Row& row) {
    const Grid& grid = now.parameters.grid;
    const double k = pi * double(now.parameters.mode) / grid.z.length,
                 along = gsl_sf_bessel_zero_J1(1) / grid.x.length;
    std::vector<double> shape;
    for (long i = 0; i < grid.x.cells; ++i)
        shape.push_back(gsl_sf_bessel_J1(along * middle(grid.x, i)));
    double sum = 0, norm = 0;
    for (long j = 0; j < grid.z.cells; ++j) {
        const double wave = std::cos(k * (middle(grid.z, j) - grid.z.low));
        for (long i = 0; i < grid.x.cells; ++i) {
            const double weight = middle(grid.x, i) * shape[std::size_t(i)] * wave;
            sum += weight * now.cells.vx[grid.index(i, j)];
            norm += weight * shape[std::size_t(i)] * wave;
        }
    }
    row.add("mode", "velocity", sum / norm);
}

/// The frequency beside that of theory.
/// in:     mode, a record at the times of the steps, which follow the flow
inline void compare_inertial_frequency(const FinishedRun& run, double expected,
                                       const std::vector<double>& times,
                                       const std::vector<double>& mode) {
    common::ModeSearch search{.expected = {expected, -expected}};
    search.periods = 2;
    const common::MeasuredMode seen = measure_between_steps(times, mode, search);
    if (!seen.found) return run.not_measured("frequency_over_theory", seen.reason);
    run.summary.result("frequency_over_theory",
                       {seen.frequency() / expected, seen.frequency_error() / expected}, "", 1,
                       run.parameters.theory_tolerance, "waves of the column; " + seen.window);
    run.info("damping", -seen.growth() / expected, "theory_frequency", "what the method takes");
}

/// The growth rate beside that of theory, while the wave is small.
/// in:     most, the speed at which it is not small any more
inline void compare_inertial_growth(const FinishedRun& run, double expected, double most,
                                    const std::vector<double>& times,
                                    const std::vector<double>& mode) {
    std::size_t count = 0;
    while (count < mode.size() && std::fabs(mode[count]) < most) ++count;
    const char* name = "growth_over_theory";
    if (count < 8 || std::fabs(mode.front()) == 0)
        return run.not_measured(name, "the wave begins with ", std::fabs(mode.front()),
                                ", and that of theory ends at ", most,
                                ": give velocity_x a smaller amplitude, but not 0");
    const std::vector<std::complex<double>> all(mode.begin(), mode.begin() + long(count));
    const Times t = Times(times).first(count);
    const double rate = fit_hyperbolic(t, all, expected).rate;
    if (!(expected * t.back() >= 2))
        return run.not_measured(name, "the run has ", expected * t.back(),
                                " e-foldings, below 2: raise time.end");
    run.summary.result(name, {rate / expected, growth_error(t, all, expected) / expected}, "", 1,
                       run.parameters.theory_tolerance,
                       sentence("waves of the column, up to t = ", t.back(),
                                "; error from the first and the last three quarters"));
}

/// Frequency or growth beside that of theory.
inline void compare_inertial_wave(const FinishedRun& run) {
    const Case& w = run.parameters;
    const std::complex<double> omega = inertial_frequency_of(w);
    const bool grows = omega.imag() > 0;
    const double size = std::abs(omega);
    const theory::RotatingColumn column = column_of(w);
    theory::RotatingColumn stiff = column;
    stiff.sound_2 = [](double) { return 1e30; };
    run.info(grows ? "theory_growth" : "theory_frequency", size, "1/time",
             "waves of the column, with its sound");
    run.info("without_sound", std::sqrt(std::fabs(theory::inertial_frequency_2(stiff))), "1/time",
             "of a fluid that keeps its volume");
    run.hint(
        "the wave has ", w.grid.z.cells / w.mode,
        " cells in half a length: refine the mesh where that is below 16, lower its speed where "
        "that is not small beside v_theta, set viscosity.linear = viscosity.quadratic = 0, take ",
        run.flip_with(),
        "flip.transfer = \"flip\" and flip.density = \"particles\", and raise "
        "time.end");
    const auto times = run.history.column("time"), mode = run.history.column("mode");
    if (times.size() < 9)
        return run.not_measured(grows ? "growth_over_theory" : "frequency_over_theory",
                                "the run has fewer than 8 steps: raise time.end");
    if (!grows) return compare_inertial_frequency(run, size, times, mode);
    compare_inertial_growth(run, size, 0.1 * size * column.radius, times, mode);
}

inline constexpr Comparison inertial_wave_comparison{.name = "inertial_wave",
                                                     .validate = validate_inertial_wave,
                                                     .predict = predict_inertial_wave,
                                                     .warn = warn_of_inertial_wave,
                                                     .track = track_inertial_wave,
                                                     .compare = compare_inertial_wave,
                                                     .rows = Rows::several,
                                                     .axisymmetric = true,
                                                     .formulas = true,
                                                     .swirl = true};

}  // namespace flip
