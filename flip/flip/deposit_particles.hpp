// particles -> mesh: mass and momentum go to the nodes, the materials with their energy to the
// cells.  [FLIP-8]
#pragma once

#include <span>

#include "flip/flip/centrifugal_force.hpp"

namespace flip {

/// Nodes with less mass have none: at the smallest of numbers, quotients lose their meaning.
inline constexpr double least_mass = 1e-280;

namespace detail {

// Deposits a batch of particles, the first of them `begin`. A particle of apic brings to each node the velocity that
// its own gradient gives it there.
template <bool affine, bool volumes>
void deposit_batch(WeightScale scale, const Material* materials, const Particles& p, long begin,
                   long count_here, const Grid& grid, Mesh& mesh) {
    Four* const node_sum = mesh.nodes.sum.data();
    CellSum* const cell_sum = mesh.cells.sum.data();
    const long count = mesh.materials;
    const double dx = grid.x.spacing(), dz = grid.z.spacing();
    const double *const m_p = p.m_p.data() + begin, *const vx_p = p.vx_p.data() + begin,
                        *const vz_p = p.vz_p.data() + begin, *const e_p = p.e_p.data() + begin;
    const int* const material_p = p.material.data() + begin;
    const BatchWeights weights(scale, p.x_p.data() + begin, p.z_p.data() + begin, count_here);
    // [deposit]
    Four of_particle[batch_size];  // mass, momentum, and one particle
#pragma omp simd
    for (long k = 0; k < count_here; ++k) {
        of_particle[k][0] = m_p[k];
        of_particle[k][1] = m_p[k] * vx_p[k];
        of_particle[k][2] = m_p[k] * vz_p[k];
        of_particle[k][3] = 1;
    }
    for (long k = 0; k < count_here; ++k) {
        const Weights w = weights[k];
        const double m = m_p[k];
        const Four& momentum = of_particle[k];
        if constexpr (affine) {
            const long q = begin + k;
            const Four along_x(0, m * p.Cxx_p[q] * dx, m * p.Czx_p[q] * dx, 0),
                along_z(0, m * p.Cxz_p[q] * dz, m * p.Czz_p[q] * dz, 0);
            const double fx = w.S_x[1], fz = w.S_z[1];
            long corner = 0;
            for_nodes(scale, w, [&](long n, double S) {
                const double right = double(corner & 1), above = double(corner >> 1);
                node_sum[n] += S * (momentum + (right - fx) * along_x + (above - fz) * along_z);
                ++corner;
            });
        } else {
            for_nodes(scale, w, [&](long n, double S) { node_sum[n] += S * momentum; });
        }
        const long material = material_p[k];
        const double energy = m * e_p[k];
        for_cells(scale, w, [&](long c, double R) {
            cell_sum[c * count + material].M += R * m;
            cell_sum[c * count + material].U += R * energy;
        });
        if constexpr (volumes) {
            const Material& a = materials[material];
            const double V = p.V_p[begin + k], p_p = pressure(a, m / V, e_p[k]);
            const double C = weight_in_cell(a, V, p_p, mesh.cells.one_fluid),
                         CK = C * stiffness(a, p_p);
            for_cells(scale, w, [&](long c, double R) {
                mesh.cells.volume[c] += R * V;
                SoftSum& soft = mesh.cells.soft[c * count + material];
                soft.C += R * C;
                soft.Cp += R * C * p_p;
                soft.CK += R * CK;
            });
        }
    }
    // [/deposit]
}

}  // namespace detail

/// Mass and velocity of the nodes, mass and internal energy of the materials in the cells.
///   m_g = sum_p m_p S(x_p - x_g),   v_g = sum_p m_p v_p S(x_p - x_g) / m_g     [FLIP-8]
///   M_ck = sum_p m_p R(x_p - x_c),  U_ck = sum_p m_p e_p R(x_p - x_c), over material k
/// in:     particles in rows, every position on the mesh
/// out:    nodes.m, vx, vz (0 where no particle is near), and in nodes.sum[3] how many
///         particles are around a node; cells.sum, M, and the sums over volumes
/// exact:  totals on nodes and cells are those of the particles, for mass, momentum and energy
/// source: [FLIP-8]; with apic, v_p + C_p (x_g - x_p) for v_p: Jiang, Schroeder and Teran,
///         J. Comput. Phys. 338, 137 (2017).
/// note:   "Fabre" on the slide is Favre: weighted by mass.
inline void deposit_particles(const Grid& grid, std::span<const Material> materials,
                              const Particles& particles, Mesh& mesh) {
    const bool volumes = has(particles.V_p), affine = has(particles.Cxx_p);
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    const long stride = grid.stride(), count = mesh.materials;
    common::for_each_row(
        grid.z.cells + 3,
        [&](long row) {
            const long n = row * stride;
            std::fill_n(g.sum.begin() + n, stride, Four::Zero());
            std::fill_n(c.sum.begin() + n * count, stride * count, CellSum{});
            if (!volumes) return;
            std::fill_n(c.volume.data() + n, stride, 0.0);
            std::fill_n(c.soft.begin() + n * count, stride * count, SoftSum{});
        },
        grid.size());
    const WeightScale scale(grid);
    const auto deposit =
        affine
            ? (volumes ? detail::deposit_batch<true, true> : detail::deposit_batch<true, false>)
            : (volumes ? detail::deposit_batch<false, true> : detail::deposit_batch<false, false>);
    for_each_band(grid, particles, [&](long begin, long end) {
        for (long p = begin; p < end; p += batch_size)
            deposit(scale, materials.data(), particles, p, std::min(batch_size, end - p), grid,
                    mesh);
    });
    fold_nodes(grid, g.sum.data());
    fold_cells(grid, &c.sum[0].M, 2 * count);
    if (volumes) {
        fold_cells(grid, c.volume.data());
        fold_cells(grid, &c.soft[0].C, 3 * count);
    }

    double *const m_g = g.m.data(), *const vx_g = g.vx.data(), *const vz_g = g.vz.data(),
                  *const M_c = c.M.data();
    for_each_node(grid, [=, sums = g.sum.data()](long, long, long n) {
        const Four& sum = sums[n];
        const double per_mass = sum[0] > least_mass ? 1 / sum[0] : 0;
        m_g[n] = per_mass > 0 ? sum[0] : 0;
        vx_g[n] = sum[1] * per_mass;
        vz_g[n] = sum[2] * per_mass;
    });
    for_each_cell(grid, [=, sum = c.sum.data()](long, long, long n) {
        double M = 0;
        for (long k = 0; k < count; ++k) M += sum[n * count + k].M;
        M_c[n] = M;
    });
    if (particles.swirl) deposit_swirl(grid, particles, mesh);
}

}  // namespace flip
