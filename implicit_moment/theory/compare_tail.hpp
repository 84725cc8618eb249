// A current sheet between reflecting ends, with a field across it: what it keeps where nothing perturbs
// it, and what of its flux closes on itself where it reconnects.
#pragma once

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/run/run.hpp"
#include "implicit_moment/moments.hpp"
#include "implicit_moment/output/columns.hpp"
#include "implicit_moment/setup/load_plasma.hpp"
#include "implicit_moment/theory/compare_equilibrium.hpp"
#include "implicit_moment/theory/compare_reconnection.hpp"
#include "implicit_moment/theory/images_of_mode.hpp"

namespace implicit_moment {

/// The noise of A_y along the middle row that particles make in thermal equilibrium [B0 d_i].
struct ThermalFlux {
    double rms = 0, most = 0;  // of all seeds, and what 99 of 100 stay below
};

///     <|B_k|^2>/8 pi = T w/2 for every wave k between the walls, T = T_i + T_e, w real particles in one of the
///     run's, so that <A_y^2> = 4 pi T w/(L_x L_z) sum 1/k^2
/// The mean square of a seed is a sum of s_k xi_k^2, xi_k a normal number for each wave along x; with the same mean,
/// variance and skewness sum s + (sum s^2/f)^(1/2) (chi^2 - f) is distributed, f = (sum s^2)^3/(sum s^3)^2.
/// source: Buckley and Eagleson, Austral. J. Statist. 30A, 150 (1988)
/// note:   an upper bound: with k d_e > 1 the quasi-static part is smaller, and a quiet start begins at 0.
inline ThermalFlux thermal_flux(const Case& w, double weight) {
    const Grid& grid = w.grid;
    const HarrisSheet sheet = harris_sheet(w.harris);
    double sum = 0, squares = 0, cubes = 0;
    for (long k = 1; k < grid.x.cells; ++k) {
        // Sines between walls: only odd ones across the sheet reach its middle, and are 1 there.
        double s = 0;
        for (long l = 1; l < grid.z.cells; l += 2)
            s += 1 / (std::pow(pi * double(k) / grid.x.length, 2) +
                      std::pow(pi * double(l) / grid.z.length, 2));
        sum += s, squares += s * s, cubes += s * s * s;
    }
    const double rms = std::sqrt(2 * 4 * pi * (sheet.T_i + sheet.T_e) * weight * sum /
                                 (grid.x.length * grid.z.length)) /
                       sheet.B0,
                 f = std::pow(squares, 3) / (cubes * cubes),
                 beyond = std::sqrt(squares / f) * (gsl_cdf_chisq_Pinv(0.99, f) - f);
    return {rms, rms * std::sqrt(1 + beyond / sum)};
}

/// A tail that nothing perturbs: density and current against n0 F^2/cosh^2(h) + n_inf in units of their own
/// noise, and the flux across the middle row.
inline void compare_tail_at_rest(const Case& w, const common::History& history,
                                 const Plasma& plasma, const std::vector<Moments>& moments,
                                 common::Summary& summary) {
    const Grid& grid = w.grid;
    const TailSheet tail = tail_of(w.harris);
    const double weight = plasma.species[0].q_p, x_middle = 0.5 * (grid.x.low + grid.x.high()),
                 z_middle = 0.5 * (grid.z.low + grid.z.high());
    // Blocks of eight columns.
    const long columns = std::min(8L, grid.x.cells - 1);
    SheetOverNoise seen;
    double middle = 0, expected_middle = 0, in_middle = 0;
    for (long first = 1; first + columns <= grid.x.cells; first += columns) {
        for (long j = 1; j < grid.z.cells; ++j) {
            double in_sheet = 0;
            for (long i = first; i < first + columns; ++i) {
                const double x = grid.x.at(double(i)) - x_middle;
                in_sheet += n0 / double(columns) *
                            spline_average([&](double z) { return tail.density(x, z); },
                                           grid.z.at(double(j)) - z_middle, grid.z.spacing());
            }
            const double n = in_sheet + n0 * w.harris.background;
            const double in_block = n * double(columns) * grid.cell_area() / weight;
            const auto block = [&](const Field& f) {
                return f.segment(grid.index(first, j), columns).mean();
            };
            if (seen.add(w, moments, n, in_sheet, in_block, block) && j == grid.z.cells / 2)
                middle += block(moments[0].rho), expected_middle += n, in_middle += in_block;
        }
    }
    // Linear splines, not smoothed, reach behind no wall.
    const bool ends_alike = has_linear_splines(w) && w.field.smoothing.passes == 0;
    const std::string unbalanced = no_balance(w);
    summary.hint(!unbalanced.empty() ? unbalanced
                 : !grid.x.mirrors && !ends_alike
                     ? "no equilibrium ends at walls that conduct: set "
                       "grid.boundary_x = \"reflecting\""
                     : "noise of few particles moves the field, and so does a sheet that tears "
                       "by itself, whose currents at the ends do not balance, or that the mesh "
                       "heats at its thin end: raise harris.particles, shorten time.end, refine "
                       "the mesh" +
                           std::string(w.leapfrog.chosen || w.field.uses_mass_matrix()
                                           ? ""
                                           : ", or set field.response = \"mass_matrix\""));
    seen.report("n0 F^2/cosh^2(h) + n_inf", "Lembege and Pellat 1982, made exact", summary);
    if (in_middle > 0)
        summary.result("density_in_the_middle", middle / expected_middle, "n of the equilibrium", 1,
                       3 / std::sqrt(in_middle), "equilibrium, three times the noise of a count");
    const ThermalFlux noise = thermal_flux(w, weight);
    summary.result_at_most("flux_shift", history.column("flux_shift").back(), "B0 d_i", noise.most,
                           "thermal noise of A_y, 99 of 100 seeds");
    if (w.harris.normal_field > 0)  // else any noise closes field lines
        summary.result_at_most("flux_reconnected", history.largest("flux"), "B0 d_i", 2 * noise.rms,
                               "equilibrium: no field line closes");
}

/// A seeded tail: flux that is closed in O-lines, and how fast it grew. A sheet that is thinner than an ion
/// gyrates and begins with an X-line closes more flux than crossed it, so that field lines of the lobes
/// reconnect; of thicker ones the numbers are reported alone.
inline void compare_tail_flux(const Case& w, const common::History& history,
                              common::Summary& summary) {
    const auto times = history.column("time_Omega_ci"), flux = history.column("flux");
    summary.result_info("flux_final", flux.back(), "B0 d_i", "measured");
    summary.result_info("X_line_final", history.column("X_line").back(), "d_i", "measured");
    if (times.back() >= 4)
        summary.result_info("peak_reconnection_rate", detail::steepest_slope(times, flux, 2),
                            "B0 v_A", "measured");
    const HarrisSheet sheet = harris_sheet(w.harris);
    const double rho_i = std::sqrt(2.0) * sheet.v_i / sheet.Omega_ci,
                 normal_flux = w.harris.normal_field * w.grid.x.length;
    if (!(w.harris.thickness < rho_i && flux.front() > 0 && normal_flux > 0) || times.back() < 20)
        return;
    summary.hint(
        "the sheet tears late where few particles make it noisy or the mesh is coarse: raise "
        "time.end, harris.particles or grid.cells_z");
    summary.result_at_least("flux_over_normal_flux", history.largest("flux") / normal_flux, "", 1,
                            "a sheet thinner than rho_i tears: field lines of the lobes reconnect");
}

}  // namespace implicit_moment
