// A Harris sheet that nothing perturbs, beside its own exact profiles.
#pragma once

#include <cmath>
#include <vector>

#include "common/run/run.hpp"
#include "implicit_moment/moments.hpp"
#include "implicit_moment/setup/load_plasma.hpp"
#include "implicit_moment/theory/spline_average.hpp"

namespace implicit_moment {

/// Harris sheet without perturbation: profiles against n0 sech^2(z/lambda) + n_inf, in units of
/// their own particle noise.
inline void compare_equilibrium(const Case& w, const Plasma& plasma,
                                const std::vector<Moments>& moments, const common::History& history,
                                common::Summary& summary) {
    const Grid& grid = w.grid;
    const HarrisSheet sheet = harris_sheet(w.harris);
    const double weight = plasma.species[0].q_p;
    double density = 0, current_y = 0;
    for (long j = 1; j < grid.z.cells; ++j) {
        const double z = grid.z.at(double(j)) - (grid.z.low + 0.5 * grid.z.length);
        const double in_sheet =
            n0 * spline_average(
                     [&](double at) { return std::pow(std::cosh(at / w.harris.thickness), -2); }, z,
                     grid.z.spacing());
        const double n = in_sheet + n0 * w.harris.background;
        // A row of nodes counts the particles of one row of cells; its relative noise is that of
        // their number.
        const double in_row = n * grid.x.length * grid.z.spacing() / weight;
        const auto row = [&](const Field& f) {
            return f.segment(grid.index(0, j), grid.x.cells).mean();
        };
        for (const Moments& m : moments)
            density += std::pow((std::fabs(row(m.rho)) / n - 1), 2) * in_row;
        const double J = in_sheet * (sheet.u_i - sheet.u_e);
        const double J_noise =
            n * std::sqrt((sheet.T_i + sheet.T_e * w.harris.mass_ratio) / in_row);
        current_y += std::pow((row(moments[0].J_y) + row(moments[1].J_y) - J) / J_noise, 2);
    }
    summary.hint(
        "the mesh heats what it does not resolve, and few particles exchange heat: refine the "
        "mesh, or raise harris.particles");
    for (const Particles& s : plasma.species) {
        const auto kinetic = history.column("kinetic_" + s.name);
        summary.result("kinetic_over_initial_" + s.name, kinetic.back() / kinetic.front(), "", 1,
                       0.05, "equilibrium: neither heats nor cools");
    }
    const double rows = double(grid.z.cells - 1);
    summary.result_at_most("density_over_noise", std::sqrt(density / (2 * rows)), "", 1.2,
                           "n0 sech^2(z/lambda) + n_inf");
    summary.result_at_most("current_over_noise", std::sqrt(current_y / rows), "", 1.2,
                           "Harris 1962");
}

}  // namespace implicit_moment
