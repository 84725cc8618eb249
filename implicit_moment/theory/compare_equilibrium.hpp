// A Harris sheet that nothing perturbs, beside its own exact profiles.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/run/run.hpp"
#include "implicit_moment/moments.hpp"
#include "implicit_moment/setup/load_plasma.hpp"
#include "implicit_moment/theory/spline_average.hpp"

namespace implicit_moment {

/// Density and current of a sheet beside its equilibrium, block of nodes after block, in units of their noise:
/// that of the number of particles in a block.
struct SheetOverNoise {
    double density = 0, current = 0, count = 0;

    /// in:     n, what is expected in the block, and what of it drifts; number, of its particles of a species;
    ///         mean, of a moment over its nodes
    /// out:    false for a block of less than ten particles, whose noise is not Gaussian and which is left out
    template <class Mean>
    bool add(const Case& w, const std::vector<Moments>& moments, double n, double drifts,
             double number, const Mean& mean) {
        if (!(number >= 10)) return false;
        const HarrisSheet sheet = harris_sheet(w.harris);
        for (const Moments& m : moments)
            density += std::pow(std::fabs(mean(m.rho)) / n - 1, 2) * number;
        const double J = drifts * (sheet.u_i - sheet.u_e),
                     noise = n * std::sqrt((sheet.T_i + sheet.T_e * w.harris.mass_ratio) / number);
        current += std::pow((mean(moments[0].J_y) + mean(moments[1].J_y) - J) / noise, 2);
        count += 1;
        return true;
    }
    /// in:     where density and current of theory come from
    void report(const std::string& of_density, const std::string& of_current,
                common::Summary& summary) const {
        if (count == 0)
            return summary.not_measured("density_over_noise",
                                        "no part of the sheet has ten particles to compare: raise "
                                        "harris.particles");
        summary.result_at_most("density_over_noise", std::sqrt(density / (2 * count)), "", 1.2,
                               of_density);
        summary.result_at_most("current_over_noise", std::sqrt(current / count), "", 1.2,
                               of_current);
    }
};

/// Harris sheet without perturbation: profiles against n0 sech^2(z/lambda) + n_inf, row by row of the nodes,
/// which count the particles of one row of cells.
inline void compare_equilibrium(const Case& w, const Plasma& plasma,
                                const std::vector<Moments>& moments, const common::History& history,
                                common::Summary& summary) {
    const Grid& grid = w.grid;
    const double weight = plasma.species[0].q_p;
    SheetOverNoise seen;
    for (long j = 1; j < grid.z.cells; ++j) {
        const double z = grid.z.at(double(j)) - (grid.z.low + 0.5 * grid.z.length);
        const double in_sheet =
            n0 * spline_average(
                     [&](double at) { return std::pow(std::cosh(at / w.harris.thickness), -2); }, z,
                     grid.z.spacing());
        const double n = in_sheet + n0 * w.harris.background;
        seen.add(w, moments, n, in_sheet, n * grid.x.length * grid.z.spacing() / weight,
                 [&](const Field& f) { return f.segment(grid.index(0, j), grid.x.cells).mean(); });
    }
    // Noise alone makes such a flux, too, but takes no energy from the field.
    const auto gained = [&](const std::string& column) {
        return history.column(column).back() - history.first(column);
    };
    double heated = 0;
    for (const Particles& s : plasma.species)
        heated = std::max(heated, gained("kinetic_" + s.name));
    const double flux = history.column("flux").back(), tears = 2 * pi * w.harris.thickness;
    const std::string unbalanced = no_balance(w),
                      tearing = flux > 0.1 * w.harris.thickness && grid.x.length > tears
                                    ? sentence(
                                          "the sheet tears by itself, for the box is longer than "
                                          "2 pi lambda = ",
                                          tears, ", and has reconnected ", flux,
                                          " B0 d_i: shorten time.end or grid.length_x, or raise "
                                          "harris.particles")
                                    : "";
    const bool by_tearing = !tearing.empty() && -gained("magnetic") > 0.5 * heated;
    summary.hint(!unbalanced.empty() ? unbalanced
                 : by_tearing        ? tearing
                                     : "few particles exchange heat: raise harris.particles; or "
                                       "refine the mesh, which heats what it does not resolve");
    for (const Particles& s : plasma.species) {
        const auto kinetic = history.column("kinetic_" + s.name);
        summary.result("kinetic_over_initial_" + s.name, kinetic.back() / kinetic.front(), "", 1,
                       0.05, "equilibrium: neither heats nor cools");
    }
    const std::string lacks = no_balance(w, 0.003);
    summary.hint(!unbalanced.empty() ? unbalanced
                 : !tearing.empty()  ? tearing
                 : !lacks.empty()    ? lacks
                                     : "the mesh changes a sheet that it does not resolve, and the "
                                       "more particles there are the more this stands out of their "
                                       "noise: refine the mesh, or lower field.smoothing_passes");
    seen.report("n0 sech^2(z/lambda) + n_inf", "Harris 1962", summary);
}

}  // namespace implicit_moment
