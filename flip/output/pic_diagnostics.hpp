// Diagnostics of pic: sums over the cells, and the fluid on the cells.
#pragma once

#include "flip/pic/eulerian_phase.hpp"

namespace flip {

/// Sums over the cells.
/// in: cells whose mass belongs to the state: after repartition() or sum_cell_masses()
inline Totals totals_of(const Grid& grid, const State& state, PicCells& cells) {
    const double x_middle = grid.x.low + 0.5 * grid.x.length,
                 z_middle = grid.z.low + 0.5 * grid.z.length;
    const auto sum = [&](const auto& of_cell) {
        return sum_over_rows(grid, cells, [&](long j) {
            double part = 0;
            for (long i = 0; i < grid.x.cells; ++i) part += of_cell(grid.index(i, j), i, j);
            return part;
        });
    };
    const Field &M = cells.mass, &vx = state.cells.vx, &vz = state.cells.vz;
    const double x_first = grid.x.at(0.5) - x_middle, z_first = grid.z.at(0.5) - z_middle,
                 dx = grid.x.spacing(), dz = grid.z.spacing();
    Totals t;
    t.mass = sum([&](long n, long, long) { return M[n]; });
    t.momentum_x = sum([&](long n, long, long) { return M[n] * vx[n]; });
    t.momentum_z = sum([&](long n, long, long) { return M[n] * vz[n]; });
    t.angular_momentum = sum([&](long n, long i, long j) {
        const double x = x_first + dx * double(i), z = z_first + dz * double(j);
        return M[n] * (x * vz[n] - z * vx[n]);
    });
    t.kinetic =
        sum([&](long n, long, long) { return 0.5 * M[n] * (vx[n] * vx[n] + vz[n] * vz[n]); });
    t.internal = sum([&](long n, long, long) {
        double U = 0;
        for (long k = 0; k < cells.materials; ++k)
            U += cells.M[n * cells.materials + k] * state.cells.e[k][n];
        return U;
    });
    if (state.particles.swirl) {
        const SwirlTotals swirl = swirl_totals(state.particles);
        t.angular_momentum = swirl.angular_momentum;
        t.kinetic += swirl.energy;
    }
    return t;
}

/// The fluid on the cells.
/// in:  cells after find_pressure()
/// out: fields, zero in empty cells; reused from step to step
inline void fields_of(const Grid& grid, const State& state, const PicCells& cells,
                      CellFields& fields) {
    const double per_area = 1 / grid.cell_area();
    if (fields.rho.size() != grid.size()) {
        for (Field* f : {&fields.rho, &fields.vx, &fields.vz, &fields.p, &fields.e})
            f->setZero(grid.size());
        fields.rho_of.assign(cells.materials, fields.rho);
    }
    for_each_row_of_cells(grid, [&](long j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const long n = grid.index(i, j);
            const double per_V = per_area * (1 / cells.ring[i + 1]);
            fields.rho[n] = cells.mass[n] * per_V;
            fields.vx[n] = state.cells.vx[n];
            fields.vz[n] = state.cells.vz[n];
            fields.p[n] = cells.p[n];
            double U = 0;
            for (long k = 0; k < cells.materials; ++k) {
                const double M = cells.M[n * cells.materials + k];
                fields.rho_of[k][n] = M * per_V;
                U += M * state.cells.e[k][n];
            }
            fields.e[n] = U * cells.per_mass[n];
        }
    });
    const Particles& particles = state.particles;
    if (!particles.swirl) return;
    fields.v_theta.setZero(grid.size());
    Field inertia = fields.v_theta;
    detail::for_each_in_cell(grid, particles, [&](long p, long at) {
        const long n = grid.index(at % grid.x.cells, at / grid.x.cells);
        const double r = particles.x_p[p], m = particles.m_p[p];
        fields.v_theta[n] += m * particles.L_p[p] * grid.x.at(double(at % grid.x.cells) + 0.5);
        inertia[n] += m * r * r;
    });
    for (long n = 0; n < grid.size(); ++n)
        if (inertia[n] > 0) fields.v_theta[n] /= inertia[n];
}

}  // namespace flip
