// The diocotron instability of a charged layer: its two edges, which drift in opposite directions
// across a magnetic field, drive each other's ripples by their charge, as in a shear layer of an
// ideal fluid.
//
// A layer |z| < d of uniform charge density rho_0 lies between grounded walls at z = +-b, with a
// uniform B along y. Particles follow v = E x B / B^2, without inertia: omega_p^2 << Omega_c^2. All
// rates scale with the shear rate S = rho_0 / B (eps_0 = 1). Ripples vary like
// exp(i k x - i omega t): Im omega is a growth rate.
#pragma once

#include <cmath>
#include <complex>
#include <string>

#include "cic/theory/comparison.hpp"
#include "cic/theory/theory_of_case.hpp"
#include "common/theory/measure_modes.hpp"

namespace cic {

/// The layer, between its walls.
struct ChargedLayer {
    double shear_rate;     // S = rho_0 / B
    double half_width;     // d
    double wall_distance;  // b, from the middle of the layer; infinite without walls
};

/// The frequency of the ripples of wave number k.
/// The edges z = +-d are displaced by eta_+-, and charge +-rho_0 eta_+- on them disturbs phi:
///   -i (omega - k v_x) eta_+- = v_z = -i k phi / B        at z = +-d
///   (omega + k S d) eta_+ = k S (G_same eta_+ - G_other eta_-)
///   (omega - k S d) eta_- = k S (G_other eta_+ - G_same eta_-)
/// with Green's function of grounded walls,
///   G(z, z') = sinh k(b - z) sinh k(b + z') / (k sinh 2kb),  z > z',
/// G_same = G(d, d), G_other = G(d, -d), so that
///   omega^2 = (k S)^2 [(d - G_same)^2 - G_other^2]
///           = S^2 (kd - g_even) (kd - g_odd),
///   g_even = sinh k(b - d) cosh kd / cosh kb,  g_odd = sinh k(b - d) sinh kd / sinh kb
/// in:    k > 0, 0 < d < b
/// out:   the root that grows, or the positive one of two real roots; the other is -omega
/// exact: without walls (2 omega / S)^2 = (1 - 2kd)^2 - exp(-4kd). It grows for g_even > kd, thus
///        never with walls at b < 2d.
/// source: Rayleigh, Proc. London Math. Soc. 11, 57 (1880); Levy, Phys. Fluids 8, 1288 (1965).
inline std::complex<double> diocotron_frequency(const ChargedLayer& layer, double k) {
    const double kd = k * layer.half_width, kb = k * layer.wall_distance;
    const double gap = -std::expm1(-2.0 * (kb - kd));
    const double g_even = 0.5 * gap * (1.0 + std::exp(-2.0 * kd)) / (1.0 + std::exp(-2.0 * kb));
    const double g_odd = 0.5 * gap * std::expm1(-2.0 * kd) / std::expm1(-2.0 * kb);
    const double S = layer.shear_rate;
    return std::sqrt(std::complex<double>(S * S * (kd - g_even) * (kd - g_odd)));
}

/// Growth rate of the followed mode of a case whose only species is a layer.
inline double diocotron_growth(const Case& parameters) {
    const SpeciesCase& s = parameters.species[0];
    const ChargedLayer layer{s.charge * s.mean_density() / parameters.B.y, s.half_width,
                             0.5 * parameters.grid.z.length};
    return std::fabs(
        diocotron_frequency(layer, wave_vector(parameters, parameters.mode_x, 0).size()).imag());
}

/// The rate at which the edges of a charged layer wind up.
inline void compare_diocotron(const Case& parameters, const History& history, Summary& summary) {
    const double growth = diocotron_growth(parameters);
    const common::MeasuredMode seen =
        common::measure_mode(history.column("time"), history.complex_column("mode"),
                             {.expected = {{0, growth}}, .below_maximum = 0.2});
    const std::string where =
        "guiding centers, two edges between grounded walls; measured " + seen.window;
    summary.result_info("theory_growth", growth, omega_p_unit, where);
    const double k_dx =
        wave_vector(parameters, parameters.mode_x, 0).size() * parameters.grid.x.spacing();
    summary.hint(0.125 * k_dx * k_dx > 0.5 * parameters.growth_tolerance
                     ? sentence("k dx is ", k_dx,
                                ", and the mesh changes the wave by 1 - cos(k dx/2) = ",
                                1 - std::cos(0.5 * k_dx), " or more: raise grid.cells_x")
                     : "inertia changes the drift where omega_p is not far below Omega_c, and so "
                       "does a coarse "
                       "layer: lower the density, or raise grid.cells_z");
    if (!seen.found) return summary.not_measured("growth_over_theory", seen.reason);
    summary.result_info("growth", {seen.growth(), seen.growth_error()}, omega_p_unit, where);
    summary.result("growth_over_theory", {seen.growth() / growth, seen.growth_error() / growth}, "",
                   1, parameters.growth_tolerance, where);
}

/// Refuses a case that is not one layer between grounded walls, across the magnetic field.
inline void validate_diocotron(const Case& parameters) {
    refuse(parameters.species.size() != 1 || count_with_profile(parameters, "layer") != 1 ||
               parameters.boundary_z != "wall" || parameters.boundary_x == "wall" ||
               parameters.B.y == 0 || parameters.B.x != 0 || parameters.B.z != 0,
           asked_for(parameters),
           " needs one species with profile = \"layer\" and no other, plasma.B_y alone, and walls "
           "in z only");
    const SpeciesCase& layer = parameters.species[0];
    refuse(parameters.mode_x == 0 || parameters.mode_z != 0, asked_for(parameters),
           " follows theory.mode_x, and not ", mode_text(parameters.mode_x, parameters.mode_z));
    const WallCase &low = parameters.walls[z_low], &high = parameters.walls[z_high];
    refuse(low.field != "grounded" || high.field != "grounded" || low.potential != high.potential ||
               std::fabs(layer.center_z - 0.5 * parameters.grid.z.length) >
                   1e-6 * parameters.grid.z.length,
           asked_for(parameters),
           " needs grounded walls of the same potential, and the layer half-way between them, at "
           "center_z = ",
           0.5 * parameters.grid.z.length);
    const double orbit =
        std::sqrt(std::max(layer.temperature_x, layer.temperature_z) * layer.mass) /
        std::fabs(layer.charge * parameters.B.y);
    refuse(orbit > 0.1 * layer.half_width, asked_for(parameters),
           " is for cold particles, and the orbits of '", layer.name, "' have the radius ", orbit,
           ", above a tenth of its half_width of ", layer.half_width,
           ": lower its temperature, or raise plasma.B_y");
    refuse(diocotron_growth(parameters) == 0, asked_for(parameters), ": mode ", parameters.mode_x,
           " of a layer of half_width ", layer.half_width, " and charge ", layer.charge,
           " does not grow: make it thinner, or change theory.mode_x");
}

/// The comparison of a charged layer.
inline constexpr Comparison diocotron_comparison{.name = "diocotron",
                                                 .follows_mode = true,
                                                 .validate = validate_diocotron,
                                                 .add_results = compare_diocotron};

}  // namespace cic
