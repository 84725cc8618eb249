// Diagnostics of flip: sums over the particles, and the fluid on the cells.
#pragma once

#include <array>

#include "flip/flip/transfer.hpp"
#include "flip/state.hpp"

namespace flip {

/// Sums over the particles; with apic the motion within a particle counts.
/// exact:  added in an order that does not depend on the number of threads
inline Totals particle_totals(const Grid& grid, const Particles& p) {
    const WeightScale scale(grid);
    const double x_mid = grid.x.low + 0.5 * grid.x.length, z_mid = grid.z.low + 0.5 * grid.z.length;
    const bool affine = has(p.Cxx_p);
    std::array<Totals, common::block_count> parts{};
    common::for_each_block(
        p.count(),
        [&](int block, long begin, long end) {
            Totals sum;
            for (long k = begin; k < end; ++k) {
                const double m = p.m_p[k], vx = p.vx_p[k], vz = p.vz_p[k];
                sum.mass += m;
                sum.momentum_x += m * vx;
                sum.momentum_z += m * vz;
                sum.angular_momentum += m * ((p.x_p[k] - x_mid) * vz - (p.z_p[k] - z_mid) * vx);
                sum.kinetic += 0.5 * m * (vx * vx + vz * vz);
                sum.internal += m * p.e_p[k];
                if (!affine) continue;
                const Weights at = weights_at(scale, p.x_p[k], p.z_p[k]);
                const double C[4] = {p.Cxx_p[k], p.Cxz_p[k], p.Czx_p[k], p.Czz_p[k]};
                const double dx = grid.x.spacing(), dz = grid.z.spacing();
                sum.kinetic += m * affine_energy(grid, at, C);
                sum.angular_momentum += m * (C[2] * at.S_x[0] * at.S_x[1] * dx * dx -
                                             C[1] * at.S_z[0] * at.S_z[1] * dz * dz);
            }
            parts[block] = sum;
        },
        p.count());
    Totals all;
    for (const Totals& part : parts) {
        all.mass += part.mass;
        all.momentum_x += part.momentum_x;
        all.momentum_z += part.momentum_z;
        all.angular_momentum += part.angular_momentum;
        all.kinetic += part.kinetic;
        all.internal += part.internal;
    }
    if (p.swirl) {
        const SwirlTotals swirl = swirl_totals(p);
        all.angular_momentum = swirl.angular_momentum;
        all.kinetic += swirl.energy;
    }
    return all;
}

/// The sum of a field over the cells.
inline double sum_of_cells(const Grid& grid, const Field& f) {
    double sum = 0;
    for (long j = 0; j < grid.z.cells; ++j) sum += f.segment(grid.index(0, j), grid.x.cells).sum();
    return sum;
}

/// The fluid on the cells.
/// in:     deposit_particles() and find_pressure() have been called
inline CellFields cell_fields(const Grid& grid, const Mesh& mesh) {
    const Nodes& g = mesh.nodes;
    CellFields f;
    for (Field* field : {&f.rho, &f.vx, &f.vz, &f.p, &f.e}) field->setZero(grid.size());
    f.rho_of.assign(mesh.materials, Field::Zero(grid.size()));
    const bool swirl = !mesh.cells.swirl.empty();
    if (swirl) f.v_theta.setZero(grid.size());
    if (mesh.cells.volume.size() > 0)
        f.overfull = sum_of_cells(grid, mesh.cells.crowding.cwiseMax(0)) /
                     std::max(sum_of_cells(grid, mesh.cells.volume), 1e-300);
    for_each_cell(grid, [&](long i, long, long n) {
        const double M = mesh.cells.M[n], per_V = 1 / mesh.cells.V_of_column[i];
        if (M <= 0) return;
        const long up = n + grid.stride();
        double U = 0;
        for (long k = 0; k < mesh.materials; ++k) {
            const CellSum& sum = mesh.cells.sum[n * mesh.materials + k];
            f.rho_of[k][n] = sum.M * per_V;
            U += sum.U;
        }
        f.rho[n] = M * per_V;
        f.vx[n] = 0.25 * (g.vx[n] + g.vx[n + 1] + g.vx[up] + g.vx[up + 1]);
        f.vz[n] = 0.25 * (g.vz[n] + g.vz[n + 1] + g.vz[up] + g.vz[up + 1]);
        f.p[n] = mesh.cells.p[n];
        f.e[n] = U / M;
        if (!swirl || !(mesh.cells.swirl[n].inertia > 0)) return;
        const SwirlSum& turns = mesh.cells.swirl[n];
        f.v_theta[n] = turns.L / turns.inertia * grid.x.at(double(i) + 0.5);
    });
    return f;
}

}  // namespace flip
