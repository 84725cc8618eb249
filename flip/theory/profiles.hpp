// The fluid on the cells along one line: along x, or away from a point.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "flip/setup/case.hpp"
#include "flip/state.hpp"

namespace flip {

/// The middle of cell i along an axis.
inline double middle(const common::Axis& axis, long i) { return axis.at(double(i) + 0.5); }

/// Calls visit(c, x, z) for each cell, row by row: its index on_faces and its middle.
template <class Visit>
void visit_cells(const Grid& grid, const Visit& visit) {
    for (long j = 0; j < grid.z.cells; ++j)
        for (long i = 0; i < grid.x.cells; ++i)
            visit(grid.index(i, j), middle(grid.x, i), middle(grid.z, j));
}

/// Mean over z of a field, at the middles of the cells along x.
inline std::vector<double> mean_over_z(const Grid& grid, const Field& f) {
    std::vector<double> mean(grid.x.cells, 0.0);
    for (long j = 0; j < grid.z.cells; ++j)
        for (long i = 0; i < grid.x.cells; ++i)
            mean[i] += f[grid.index(i, j)] / double(grid.z.cells);
    return mean;
}

/// Distance from a to b along an axis, to the nearest image where it is periodic.
inline double apart(const common::Axis& axis, double a, double b) {
    const double d = b - a;
    return axis.periodic ? d - axis.length * std::floor(d / axis.length + 0.5) : d;
}

/// Means over shells, one cell wide, around a point; in a row of cells, over both sides of it.
struct RadialProfile {
    std::vector<double> r, rho, v_r, v_phi, p, e;  // v_phi counterclockwise from x to z
};

/// The fluid around (x0, z0), in a frame that moves with (vx0, vz0).
/// out:    density and pressure are means over the volume, velocity and energy over the mass
inline RadialProfile radial_profile(const Grid& grid, const CellFields& cells, double x0, double z0,
                                    double vx0 = 0, double vz0 = 0) {
    const bool plane = grid.z.cells > 1;
    const double step = std::max(grid.x.spacing(), plane ? grid.z.spacing() : 0.0);
    RadialProfile sums;
    std::vector<double> volume, mass;
    visit_cells(grid, [&](long c, double x, double z) {
        const double dx = apart(grid.x, x0, x), dz = plane ? apart(grid.z, z0, z) : 0.0,
                     r = std::hypot(dx, dz);
        const auto n = std::size_t(r / step);
        if (n >= volume.size())
            for (auto* column :
                 {&volume, &mass, &sums.r, &sums.rho, &sums.v_r, &sums.v_phi, &sums.p, &sums.e})
                column->resize(n + 1, 0.0);
        const double V = grid.axisymmetric ? x : 1, m = V * cells.rho[c], vx = cells.vx[c] - vx0,
                     vz = cells.vz[c] - vz0;
        volume[n] += V;
        mass[n] += m;
        sums.r[n] += V * r;
        sums.rho[n] += m;
        sums.p[n] += V * cells.p[c];
        sums.e[n] += m * cells.e[c];
        if (r == 0) return;
        sums.v_r[n] += m * (vx * dx + vz * dz) / r;
        sums.v_phi[n] += m * (vz * dx - vx * dz) / r;
    });
    RadialProfile profile;
    for (std::size_t n = 0; n < volume.size(); ++n) {
        if (volume[n] == 0) continue;
        const double per_mass = mass[n] > 0 ? 1 / mass[n] : 0;
        profile.r.push_back(sums.r[n] / volume[n]);
        profile.rho.push_back(sums.rho[n] / volume[n]);
        profile.p.push_back(sums.p[n] / volume[n]);
        profile.e.push_back(sums.e[n] * per_mass);
        profile.v_r.push_back(sums.v_r[n] * per_mass);
        profile.v_phi.push_back(sums.v_phi[n] * per_mass);
    }
    return profile;
}

/// The outermost place at which values rise inward through a level, linear between samples; 0 where
/// there is none.
/// in:     r, increasing
inline double outermost(const std::vector<double>& r, const std::vector<double>& values,
                        double level) {
    for (std::size_t n = r.size(); n-- > 1;)
        if (values[n] < level && values[n - 1] >= level)
            return r[n] + (level - values[n]) / (values[n - 1] - values[n]) * (r[n - 1] - r[n]);
    return 0;
}

}  // namespace flip
