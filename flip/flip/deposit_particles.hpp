// particles -> mesh: mass and momentum go to the nodes, the materials with their energy to the
// cells.  [FLIP-8]
#pragma once

#include "flip/flip/mesh.hpp"

namespace flip {

/// Nodes with less mass have none: at the smallest of numbers, quotients lose their meaning.
inline constexpr double least_mass = 1e-280;

namespace detail {

// What the particles of one row of cells leave on the mesh: two rows of nodes, three of cells.
template <bool affine, bool volumes>
void deposit_row(const WeightScale& scale, const std::vector<Material>& materials,
                 const Particles& p, std::size_t begin, std::size_t end, const Grid& grid,
                 Mesh& mesh) {
    Four* const node_sum = mesh.nodes.sum.data();
    CellSum* const cell_sum = mesh.cells.sum.data();
    const long kinds = static_cast<long>(mesh.materials);
    const double dx = grid.x.spacing(), dz = grid.z.spacing();
    // [deposit]
    for (std::size_t k = begin; k < end; ++k) {
        const Weights w = weights_at(scale, p.x_p[k], p.z_p[k]);
        const double m = p.m_p[k];
        const Four momentum(m, m * p.vx_p[k], m * p.vz_p[k], 0);
        if constexpr (affine) {
            // Each node meets the velocity that the particle's own gradient gives it.
            const Four along_x(0, m * p.Cxx_p[k] * dx, m * p.Czx_p[k] * dx, 0),
                along_z(0, m * p.Cxz_p[k] * dz, m * p.Czz_p[k] * dz, 0);
            const double fx = w.S_x[1], fz = w.S_z[1];
            long corner = 0;
            for_nodes(scale, w, [&](long n, double S) {
                const double right = static_cast<double>(corner & 1),
                             above = static_cast<double>(corner >> 1);
                node_sum[n] += S * (momentum + (right - fx) * along_x + (above - fz) * along_z);
                ++corner;
            });
        } else {
            for_nodes(scale, w, [&](long n, double S) { node_sum[n] += S * momentum; });
        }
        const long kind = p.material[k];
        const double energy = m * p.e_p[k];
        for_cells(scale, w, [&](long c, double R) {
            cell_sum[c * kinds + kind].M += R * m;
            cell_sum[c * kinds + kind].U += R * energy;
        });
        if constexpr (volumes) {
            const Material& a = materials[static_cast<std::size_t>(kind)];
            const double V = p.V_p[k], p_p = pressure(a, m / V, p.e_p[k]);
            const double give = compliance(a, V, p_p);
            for_cells(scale, w, [&](long c, double R) {
                mesh.cells.volume[c] += R * V;
                mesh.cells.give[c] += R * give;
                mesh.cells.give_p[c] += R * give * p_p;
            });
        }
    }
    // [/deposit]
}

}  // namespace detail

/// Mass and velocity of the nodes, mass and internal energy of the materials in the cells.
///   m_g = sum_p m_p S(x_p - x_g),   v_g = sum_p m_p v_p S(x_p - x_g) / m_g     [FLIP-8]
///   M_ck = sum_p m_p R(x_p - x_c),  U_ck = sum_p m_p e_p R(x_p - x_c), over material k
/// in:     particles sorted by row, every position on the mesh
/// out:    nodes.m, vx, vz (0 where no particle is near); cells.sum, M, and the sums over volumes
/// exact:  totals on nodes and cells are those of the particles, for mass, momentum and energy
/// source: [FLIP-8]; with apic, v_p + C_p (x_g - x_p) for v_p: Jiang, Schroeder and Teran,
///         J. Comput. Phys. 338, 137 (2017).
/// note:   "Fabre" on the slide is Favre: weighted by mass.
inline void deposit_particles(const Problem& problem, const Particles& particles, Mesh& mesh) {
    const Grid& grid = problem.grid;
    const bool volumes = has(particles.V_p), affine = has(particles.Cxx_p);
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    const long rows = grid.z.cells + 3, stride = grid.stride();
    common::for_each_row(
        rows,
        [&](long row) {
            const auto n = static_cast<std::size_t>(row * stride),
                       count = static_cast<std::size_t>(stride);
            std::fill_n(g.sum.begin() + static_cast<long>(n), count, Four::Zero());
            std::fill_n(c.sum.begin() + static_cast<long>(n * mesh.materials),
                        count * mesh.materials, CellSum{});
            if (volumes)
                for (Field* f : {&c.volume, &c.give, &c.give_p})
                    std::fill_n(f->data() + n, count, 0.0);
        },
        grid.size());
    const WeightScale scale(grid);
    common::for_each_row_three_colors(
        grid.z.cells,
        [&](long j) {
            const auto begin = static_cast<std::size_t>(
                           particles.first_of_row[static_cast<std::size_t>(j)]),
                       end = static_cast<std::size_t>(
                           particles.first_of_row[static_cast<std::size_t>(j) + 1]);
            if (affine && volumes)
                detail::deposit_row<true, true>(scale, problem.materials, particles, begin, end,
                                                grid, mesh);
            else if (affine)
                detail::deposit_row<true, false>(scale, problem.materials, particles, begin, end,
                                                 grid, mesh);
            else if (volumes)
                detail::deposit_row<false, true>(scale, problem.materials, particles, begin, end,
                                                 grid, mesh);
            else
                detail::deposit_row<false, false>(scale, problem.materials, particles, begin, end,
                                                  grid, mesh);
        },
        particles.count());
    fold_nodes(grid, g.sum.data());
    fold_cells(grid, &c.sum[0].M, 2 * static_cast<long>(mesh.materials));
    if (volumes)
        for (Field* f : {&c.volume, &c.give, &c.give_p}) fold_cells(grid, f->data());

    for_each_node(grid, [&](long, long, long n) {
        const Four& sum = g.sum[static_cast<std::size_t>(n)];
        const double per_mass = sum[0] > least_mass ? 1 / sum[0] : 0;
        g.m[n] = per_mass > 0 ? sum[0] : 0;
        g.vx[n] = sum[1] * per_mass;
        g.vz[n] = sum[2] * per_mass;
    });
    for_each_cell(grid, [&](long, long, long n) {
        double M = 0;
        for (std::size_t k = 0; k < mesh.materials; ++k)
            M += c.sum[static_cast<std::size_t>(n) * mesh.materials + k].M;
        c.M[n] = M;
    });
}

}  // namespace flip
