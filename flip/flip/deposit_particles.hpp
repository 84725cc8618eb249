// particles -> mesh: mass and momentum go to the nodes, the materials with their energy to the
// cells.  [FLIP-8]
#pragma once

#include <span>

#include "flip/flip/centrifugal_force.hpp"

namespace flip {

/// Nodes with less mass have none: at the smallest of numbers, quotients lose their meaning.
inline constexpr double least_mass = 1e-280;

namespace detail {

// What the particles [begin, end) leave on the mesh. A particle of apic brings to each node the velocity
// that its own gradient gives it there.
template <bool affine, bool volumes>
void deposit_band(const WeightScale& scale, const Material* materials, const Particles& p,
                  long begin, long end, const Grid& grid, Mesh& mesh) {
    Four* const node_sum = mesh.nodes.sum.data();
    CellSum* const cell_sum = mesh.cells.sum.data();
    const long count = mesh.materials;
    const double dx = grid.x.spacing(), dz = grid.z.spacing();
    // [deposit]
    for (long k = begin; k < end; ++k) {
        const Weights w = weights_at(scale, p.x_p[k], p.z_p[k]);
        const double m = p.m_p[k];
        const Four momentum(m, m * p.vx_p[k], m * p.vz_p[k], 1);
        if constexpr (affine) {
            const Four along_x(0, m * p.Cxx_p[k] * dx, m * p.Czx_p[k] * dx, 0),
                along_z(0, m * p.Cxz_p[k] * dz, m * p.Czz_p[k] * dz, 0);
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
        const long material = p.material[k];
        const double energy = m * p.e_p[k];
        for_cells(scale, w, [&](long c, double R) {
            cell_sum[c * count + material].M += R * m;
            cell_sum[c * count + material].U += R * energy;
        });
        if constexpr (volumes) {
            const Material& a = materials[material];
            const double V = p.V_p[k], p_p = pressure(a, m / V, p.e_p[k]);
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
        affine ? (volumes ? detail::deposit_band<true, true> : detail::deposit_band<true, false>)
               : (volumes ? detail::deposit_band<false, true> : detail::deposit_band<false, false>);
    for_each_band(grid, particles, [&](long begin, long end) {
        deposit(scale, materials.data(), particles, begin, end, grid, mesh);
    });
    fold_nodes(grid, g.sum.data());
    fold_cells(grid, &c.sum[0].M, 2 * count);
    if (volumes) {
        fold_cells(grid, c.volume.data());
        fold_cells(grid, &c.soft[0].C, 3 * count);
    }

    for_each_node(grid, [&](long, long, long n) {
        const Four& sum = g.sum[n];
        const double per_mass = sum[0] > least_mass ? 1 / sum[0] : 0;
        g.m[n] = per_mass > 0 ? sum[0] : 0;
        g.vx[n] = sum[1] * per_mass;
        g.vz[n] = sum[2] * per_mass;
    });
    for_each_cell(grid, [&](long, long, long n) {
        double M = 0;
        for (long k = 0; k < count; ++k) M += c.sum[n * count + k].M;
        c.M[n] = M;
    });
    if (particles.swirl) deposit_swirl(grid, particles, mesh);
}

}  // namespace flip
