// Waves that grow: at the interface of two fluids (Rayleigh-Taylor) and in a layer of shear
// (Kelvin-Helmholtz).
#pragma once

#include <complex>
#include <limits>
#include <span>

#include "flip/theory/instabilities.hpp"
#include "flip/theory/modes.hpp"

namespace flip {

/// Two fluids, one above the other, between the ends in z.
inline theory::TwoLayers layers_of(const Case& parameters) {
    const RegionCase &lower = parameters.regions.front(), &upper = parameters.regions.back();
    theory::TwoLayers s;
    s.lower_density = lower.gas.density;
    s.upper_density = upper.gas.density;
    s.gravity = -parameters.gravity_z;
    s.lower_depth = upper.center_z - parameters.grid.z.low;
    s.upper_depth = parameters.grid.z.high() - upper.center_z;
    return s;
}

/// The pressure of a region that carries its own weight, at the interface.
inline double pressure_at_interface(const Case& parameters, const RegionCase& r) {
    return r.gas.pressure +
           r.gas.density * parameters.gravity_z * (parameters.regions.back().center_z - r.center_z);
}

/// Growth rate of the tracked mode of the interface.
inline double interface_growth_of(const Case& parameters) {
    const auto stiffness_of = [&](const RegionCase& r) -> theory::LayerStiffness {
        const Material& a = material_of(parameters, r);
        return {stiffness(a, pressure_at_interface(parameters, r)), a.gamma};
    };
    return theory::compressible_interface_growth(
        layers_of(parameters), stiffness_of(parameters.regions.front()),
        stiffness_of(parameters.regions.back()), tracked_wave_number(parameters));
}

/// Growth rate of the tracked mode of the layer of shear, half-way between the ends in z.
inline double shear_growth_of(const Case& parameters) {
    const RegionCase& r = region_with_flow(parameters, "shear");
    return theory::shear_layer_growth({2 * r.speed, r.width, 0.5 * parameters.grid.z.length},
                                      tracked_wave_number(parameters));
}

/// z(t) = A cosh(rate t) + B sinh(rate t), with complex A and B.
struct HyperbolicFit {
    double rate = 0;
    double misfit = 0;  // rms of the rest, relative to that of z
};
using Times = std::span<const double>;
using Amplitudes = std::span<const std::complex<double>>;

/// Sum of |z - A cosh - B sinh|^2 for the best A and B.
inline double hyperbolic_misfit(Times t, Amplitudes z, double rate) {
    double cc = 0, cs = 0, ss = 0;
    std::complex<double> cz = 0, sz = 0;
    for (std::size_t n = 0; n < t.size(); ++n) {
        const double c = std::cosh(rate * (t[n] - t[0])), s = std::sinh(rate * (t[n] - t[0]));
        cc += c * c, cs += c * s, ss += s * s;
        cz += c * z[n], sz += s * z[n];
    }
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 1e-14 * cc * ss)) return std::numeric_limits<double>::infinity();
    const std::complex<double> A = (ss * cz - cs * sz) / determinant,
                               B = (cc * sz - cs * cz) / determinant;
    double rest = 0;
    for (std::size_t n = 0; n < t.size(); ++n)
        rest += std::norm(z[n] - A * std::cosh(rate * (t[n] - t[0])) -
                          B * std::sinh(rate * (t[n] - t[0])));
    return rest;
}

/// Rates are sought within this factor of that of theory.
inline constexpr double widest = 5;

/// The growth rate of a linear instability from its very start, where the growing and the decaying
/// wave are both there.
/// in:     t; z, not zero; rates from expected/widest to widest expected
inline HyperbolicFit fit_hyperbolic(Times t, Amplitudes z, double expected) {
    HyperbolicFit fit;
    const auto misfit = [&](double log_rate) {
        return hyperbolic_misfit(t, z, std::exp(log_rate));
    };
    // Find the valley, then narrow it by golden sections.
    const double low = std::log(expected / widest), step = 2 * std::log(widest) / 100;
    double best = low, smallest = std::numeric_limits<double>::infinity();
    for (int n = 0; n <= 100; ++n) {
        const double here = misfit(low + n * step);
        if (here < smallest) smallest = here, best = low + n * step;
    }
    const double part = 0.5 * (std::sqrt(5.0) - 1);
    double a = best - step, b = best + step;
    for (int n = 0; n < 60; ++n) {
        const double left = b - part * (b - a), right = a + part * (b - a);
        (misfit(left) < misfit(right) ? b : a) = misfit(left) < misfit(right) ? right : left;
    }
    double squares = 0;
    for (const std::complex<double>& one : z) squares += std::norm(one);
    fit.rate = std::exp(0.5 * (a + b));
    fit.misfit = std::sqrt(misfit(0.5 * (a + b)) / squares);
    return fit;
}

/// By how much the rate is uncertain: its difference between the first and the last three quarters.
inline double growth_error(Times t, Amplitudes z, double expected) {
    const std::size_t part = 3 * t.size() / 4, rest = t.size() - part;
    return std::fabs(fit_hyperbolic(t.first(part), z.first(part), expected).rate -
                     fit_hyperbolic(t.subspan(rest), z.subspan(rest), expected).rate);
}

/// The growth rate in one line.
inline std::string predict_growth(double growth) { return "growth rate " + format(growth); }

/// Warns of a viscosity that theory knows nothing of. Mu k^2/rho is a part of the rate.
inline void warn_of_viscous_wave(const Case& parameters, double rate,
                                 std::vector<std::string>& warnings) {
    const double k = tracked_wave_number(parameters);
    double lightest = parameters.regions.front().gas.density;
    for (const RegionCase& r : parameters.regions)
        lightest = std::min<double>(lightest, r.gas.density);
    const double part = parameters.viscosity * k * k / (lightest * rate);
    warn(warnings, part > 0.1 * parameters.theory_tolerance,
         "flip.viscosity = ", parameters.viscosity, " changes this wave by up to about ",
         100 * part, " %, and theory is of fluids without it: take it out");
}

/// Warns of a run shorter than one growth time, and of a mesh that is coarse for the wave.
/// note:   an interface slips within a cell, which costs a rate 0.28 k dx of itself
inline void warn_of_growth(const Case& parameters, double growth,
                           std::vector<std::string>& warnings) {
    const double cells = double(parameters.grid.x.cells) / double(parameters.mode);
    warn(warnings, cells < 32, "theory.mode = ", parameters.mode, " has ", cells,
         " cells in a wavelength, below 32: it grows too slowly by 2/cells; refine the mesh");
    warn(warnings, growth * parameters.end < 1, "theory has the growth rate ", growth,
         ", and time.end = ", parameters.end, " is less than the time ", 1 / growth,
         " in which the wave grows by e: its growth cannot be measured well");
    warn_of_viscous_wave(parameters, growth, warnings);
}

/// The growth from the start on, while the mode is smaller than `most`; and beside that of theory on
/// the mesh, where it is known, else 0. Slowed_by ends the hint.
inline void compare_growth(const FinishedRun& run, double expected, double most,
                           const std::string& source, const std::string& slowed_by,
                           double on_mesh = 0) {
    const auto times = run.history.column("time");
    const std::vector<std::complex<double>> mode = run.history.complex_column("mode");
    std::size_t count = 0;
    while (count < mode.size() && std::abs(mode[count]) < most) ++count;
    run.info("theory_growth", expected, "1/time", source);
    const char* name = "growth_over_theory";
    if (std::abs(mode.front()) >= most)
        return run.not_measured(name, "the wave begins with ", std::abs(mode.front()),
                                ", and that of theory ends at ", most,
                                ": lower the amplitude or the ripple");
    if (count < 8)
        return run.not_measured(
            name, "only ", count, " rows before the wave was as large as ", most,
            ", where that of theory ends: start with a smaller one, or raise time.end");
    const Times t = Times(times).first(count);
    const Amplitudes z = Amplitudes(mode).first(count);
    if (std::ranges::all_of(z, [](const auto& one) { return std::norm(one) == 0; }))
        return run.not_measured(name, "there is no wave: give a region an amplitude, or a ripple");
    if (expected * t.back() < 1)
        return run.not_measured(
            name, "theory has the wave grow by ", expected * t.back(), " e-foldings ",
            count < mode.size()
                ? sentence("before it is as large as ", most,
                           ", fewer than 1: start with a smaller one")
                : sentence("until time.end, fewer than 1: raise it to ", 4 / expected));
    const HyperbolicFit fit = fit_hyperbolic(t, z, expected);
    if (std::fabs(std::log(fit.rate / expected)) > 0.98 * std::log(widest))
        return run.not_measured(
            name, "the growth that fits best is ", fit.rate / expected,
            " of that of theory, at the end of the search, with a misfit of ", fit.misfit,
            fit.rate < expected ? ": the wave is not seen to grow; refine the mesh, raise the "
                                  "amplitude above the noise, or take out viscosity"
                                : ": something grows faster than this wave; refine the mesh, "
                                  "or raise the amplitude above the noise");
    const common::Measured rate(fit.rate, growth_error(t, z, expected));
    const std::string where =
        sentence(source, "; fitted up to t = ", t.back(), ", misfit ", fit.misfit);
    run.hint("the wave has ", run.parameters.grid.x.cells / run.parameters.mode,
             " cells, which cost it a part 2/cells, and ", expected * t.back(),
             " e-foldings within the fit: refine the mesh, and raise time.end or lower the "
             "amplitude until there are 4; ",
             slowed_by);
    run.summary.result_info("growth", rate, "1/time", where);
    run.summary.result(name, {rate.value / expected, rate.error / expected}, "", 1,
                       run.parameters.theory_tolerance,
                       where + "; error from the first and the last three quarters");
    if (on_mesh > 0)
        run.summary.result("growth_over_mesh", {rate.value / on_mesh, rate.error / on_mesh}, "", 1,
                           0.4 * run.parameters.theory_tolerance,
                           sentence("theory of this mesh and its masses, ", on_mesh / expected,
                                    " of that of the fluids"));
    run.info("fit_misfit", fit.misfit, "", "what is no sum of a growing and a decaying wave, rms");
    run.info("e_foldings", expected * t.back(), "", "within the fit");
}

/// Needs two fluids between walls, and pressures that carry both.
inline void validate_layers(const Case& parameters, const Refusal& refuse) {
    refuse(parameters.regions.size() != 2 || parameters.regions[0].shape != "everywhere" ||
               parameters.regions[1].shape != "above",
           " needs two regions, one everywhere and one above it");
    validate_mode(parameters, refuse, "overturn");
    refuse(parameters.grid.z.periodic, " needs walls in z");
    refuse(parameters.gravity_x != 0 || parameters.trap != 0,
           " is for gravity along z alone: take out gravity.x and gravity.trap");
    const RegionCase &lower = parameters.regions[0], &upper = parameters.regions[1];
    refuse(!(upper.center_z > parameters.grid.z.low && upper.center_z < parameters.grid.z.high()),
           ": the interface at center_z = ", upper.center_z, " is not on the mesh");
    for (const RegionCase& r : parameters.regions) {
        refuse(!r.hydrostatic, " needs fluid that begins at rest: set region.", r.name,
               ".hydrostatic = true");
        refuse(r.gas.velocity_x != 0 || r.gas.velocity_z != 0 ||
                   (r.flow != "uniform" && r.flow != "overturn"),
               " is of fluids that do not stream: take out the velocities and the flow of region.",
               r.name, ", or take flow = \"overturn\"");
    }
    const double below = pressure_at_interface(parameters, lower),
                 above = pressure_at_interface(parameters, upper);
    refuse(std::fabs(above - below) > 1e-6 * std::fabs(below),
           " needs one pressure at the interface: region.", lower.name, " has ", below,
           " there, and region.", upper.name, " has ", above);
    const double at_wall =
        above + upper.gas.density * parameters.gravity_z * layers_of(parameters).upper_depth;
    refuse(!(stiffness(material_of(parameters, upper), at_wall) > 0),
           " needs a pressure that carries ", "the fluid up to the wall, and there it is ", at_wall,
           ": raise that of both regions");
}

/// Needs heavy fluid above light fluid.
inline void validate_interface(const Case& parameters, const Refusal& refuse) {
    validate_layers(parameters, refuse);
    refuse(!(theory::interface_growth(layers_of(parameters), 1) > 0), ": density ",
           parameters.regions[1].gas.density, " above ", parameters.regions[0].gas.density,
           " with gravity.z = ", parameters.gravity_z, " does not overturn: turn one around");
}

/// The growth rate of the interface.
inline std::string predict_interface(const Case& parameters, const std::string&, double) {
    return predict_growth(interface_growth_of(parameters));
}

/// Warns of a run shorter than one growth time of the interface.
inline void warn_of_interface(const Case& parameters, std::vector<std::string>& warnings) {
    warn_of_growth(parameters, interface_growth_of(parameters), warnings);
}

/// Height of the interface, from the mass of the columns,
///   (rho_lower - rho_upper) eta(x) = integral of rho over z - its mean
/// note: it is linear in eta, where velocities at a fixed height lose (8/3 pi) k eta of themselves
inline void track_interface(const Snapshot& now, common::Row& row) {
    const Case& parameters = now.parameters;
    const theory::TwoLayers layers = layers_of(parameters);
    row.add("mode", "length",
            parameters.grid.z.length / (layers.lower_density - layers.upper_density) *
                mode_of(parameters, now.cells.rho, 0, parameters.grid.z.cells,
                        parameters.regions.back().center_x));
}

/// What the mesh of flip makes of the rate of the interface, times that of the fluids; 0 where it is not
/// known.
inline double interface_rate_by_mesh(const Case& w, const std::string& program) {
    const theory::TwoLayers layers = layers_of(w);
    const double k = tracked_wave_number(w), dz = w.grid.z.spacing(),
                 rows = layers.lower_depth / dz;
    const bool known = program == "flip" && w.transfer == "flip" && w.density == "particles" &&
                       w.grid.z.cells <= 1024 && std::fabs(rows - std::round(rows)) < 1e-6;
    return known ? theory::interface_rate_on_mesh(layers, k, w.grid.x.spacing(), dz,
                                                  w.mass == "consistent") /
                       std::abs(theory::interface_frequency(layers, k))
                 : 0;
}

/// The growth of the interface while its crests are lower than 0.3/k.
inline void compare_interface(const FinishedRun& run) {
    const Case& w = run.parameters;
    const double k = tracked_wave_number(w), growth = interface_growth_of(w);
    run.info("incompressible_growth", theory::interface_growth(layers_of(w), k), "1/time",
             "of fluids whose sound is much faster");
    std::string slowed_by = "viscosity slows it, too";
    if (run.program == "flip" && w.density == "cells")
        slowed_by +=
            ", and flip.density = \"cells\" rings, which tears the interface: take "
            "\"particles\"";
    compare_growth(run, growth, 0.3 / k, "two gases between walls, each of one density", slowed_by,
                   w.implicit() ? 0 : growth * interface_rate_by_mesh(w, run.program));
}

/// Needs a layer of shear half-way between walls, in which the mode grows.
inline void validate_shear(const Case& parameters, const Refusal& refuse) {
    validate_flow(parameters, refuse, "shear");
    validate_mode(parameters, refuse, "shear");
    const RegionCase& r = region_with_flow(parameters, "shear");
    refuse(parameters.grid.z.periodic, " needs walls in z");
    validate_no_force(parameters, refuse);
    for (const RegionCase& other : parameters.regions) {
        refuse(other.gas.velocity_x != parameters.frame_x || other.gas.velocity_z != 0, ": region.",
               other.name, " moves with ", other.gas.velocity_x, ", ", other.gas.velocity_z,
               " beside its layer of shear: set theory.frame_x to the first, and the second to 0");
        refuse(other.gas.density != r.gas.density || other.gas.pressure != r.gas.pressure ||
                   other.flow != r.flow || other.speed != r.speed || other.width != r.width,
               " is for streams of one density and pressure in one layer of shear, and region.",
               other.name, " is not like region.", r.name,
               ": give both the same density, pressure, flow, speed and width");
    }
    const double half_way = parameters.grid.z.low + 0.5 * parameters.grid.z.length;
    refuse(std::fabs(r.center_z - half_way) > 1e-6 * parameters.grid.z.length,
           " needs the layer half-way between the walls, at center_z = ", half_way);
    refuse(!(shear_growth_of(parameters) > 0), ": mode ", parameters.mode,
           " of a layer of half-width ", r.width,
           " does not grow: make it thinner, or lower theory.mode");
}

/// The growth rate of the layer.
inline std::string predict_shear(const Case& parameters, const std::string&, double) {
    return predict_growth(shear_growth_of(parameters));
}

/// Warns of a run shorter than one growth time of the layer, and of a layer thinner than the mesh.
inline void warn_of_shear(const Case& parameters, std::vector<std::string>& warnings) {
    warn_of_growth(parameters, shear_growth_of(parameters), warnings);
    const RegionCase& r = region_with_flow(parameters, "shear");
    const double across = 2 * r.width / parameters.grid.z.spacing();
    warn(warnings, across < 4, "region.", r.name, ".width = ", r.width, " is a layer of ", across,
         " cells, below 4: it is smeared, and grows at another rate; refine the mesh or widen it");
}

/// Velocity across the layer, in the rows on both sides of its middle; in one row where the middle
/// goes through it.
inline void track_shear(const Snapshot& now, common::Row& row) {
    const Case& parameters = now.parameters;
    const RegionCase& r = region_with_flow(parameters, "shear");
    const common::Axis& axis = parameters.grid.z;
    const double node = (r.center_z - axis.low) / axis.spacing(), nearest = std::floor(node + 0.5);
    const bool between = std::fabs(node - nearest) < 0.25;
    const long j = long(between ? nearest - 1 : std::floor(node)),
               j_low = std::clamp(j, 0L, axis.cells - 1),
               j_high = std::clamp(j + (between ? 2 : 1), 1L, axis.cells);
    row.add("mode", "velocity",
            mode_of(parameters, now.cells.vz, j_low, j_high,
                    r.center_x + parameters.frame_x * now.state.time));
}

/// The growth of the layer while its crests, velocity over growth rate, are lower than 0.3/k.
inline void compare_shear(const FinishedRun& run) {
    const double growth = shear_growth_of(run.parameters);
    compare_growth(run, growth, 0.3 / tracked_wave_number(run.parameters) * growth,
                   "layer of constant shear between walls",
                   "a large Mach number or viscosity slows it, too");
}

inline constexpr Comparison interface_comparison{
    "rayleigh_taylor", validate_interface, predict_interface, warn_of_interface,
    track_interface,   compare_interface,  Rows::several};

inline constexpr Comparison shear_comparison{"kelvin_helmholtz", validate_shear,      predict_shear,
                                             warn_of_shear,      track_shear,         compare_shear,
                                             Rows::several,      Frame::moves_along_x};

}  // namespace flip
