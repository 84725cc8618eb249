// particles -> mesh: every cloud shares its charge among the nodes that it touches.  [CIC-1]
#pragma once

#include <cstdlib>
#include <vector>

#include "cic/weights.hpp"

namespace cic {

/// Room for one mesh per block of particles, kept between steps.
struct DepositScratch {
    std::vector<std::vector<Real>> sum_of_block;
    std::vector<double> sum;  // of all blocks
};

namespace detail {

// Adds S of up to batch_size particles to one mesh. in: z_p, null in one dimension
template <int order, int dimensions>
void add_weights(const Real* x_p, const Real* z_p, long count, const Grid& grid, Real* sum) {
    const long stride = grid.stride();
    Real* const origin = sum + grid.index(0, 0);
    const Clouds<order> clouds_x(grid.x, x_p, count);
    // [deposit]
    if constexpr (dimensions == 1) {
        for (long p = 0; p < count; ++p) {
            const Weights<order> S_x = clouds_x[p];
            for (int i = 0; i < S_x.count; ++i) origin[S_x.first + i] += S_x.S[i];
        }
    } else {
        const Clouds<order> clouds_z(grid.z, z_p, count);
        for (long p = 0; p < count; ++p) {
            const Weights<order> S_x = clouds_x[p], S_z = clouds_z[p];
            Real* node = origin + S_z.first * stride + S_x.first;
            for (int j = 0; j < S_z.count; ++j, node += stride)
                for (int i = 0; i < S_x.count; ++i) node[i] += S_x.S[i] * S_z.S[j];
        }
    }
    // [/deposit]
}

}  // namespace detail

/// Charge density of one species on the nodes, without folding.
///   rho_g += sum_p q_p S(x_g - x_p) / V_c
/// in/out: rho_g, grid.size() values; what falls on ghost nodes stays there
inline void add_charge(const Particles& particles, const Grid& grid, const Scheme& scheme,
                       DepositScratch& scratch, Field& rho_g) {
    const long size = grid.size(), rows = grid.z.cells + 3, stride = grid.stride();
    scratch.sum_of_block.resize(common::block_count);
    with_order_and_dimensions(scheme, [&](auto order, auto dimensions) {
        for_each_own_block(particles.count_of_all(), [&](int block, long begin, long end) {
            auto& sum = scratch.sum_of_block[block];
            sum.assign(size, 0);
            for (long p = begin; p < end; p += batch_size)
                detail::add_weights<order(), dimensions()>(
                    &particles.x_p[p], dimensions() == 2 ? &particles.z_p[p] : nullptr,
                    std::min(batch_size, end - p), grid, sum.data());
        });
    });
    // Block after block, and where there are ranks, rank after rank.
    scratch.sum.assign(size, 0);
    for_each_row_in_turn(rows, stride, scratch.sum.data(), [&](long row) {
        double* const of_row = scratch.sum.data() + row * stride;
        for (int k = first_block(common::rank()); k < first_block(common::rank() + 1); ++k) {
            const Real* const of_block = scratch.sum_of_block[k].data() + row * stride;
            for (long n = 0; n < stride; ++n) of_row[n] += double(of_block[n]);
        }
    });
    const double charge = particles.q_p / grid.cell_area();
    const double* const sum = scratch.sum.data();
    double* const rho = rho_g.data();
    common::for_each_row(rows, [&](long row) {
        for (long n = row * stride; n < (row + 1) * stride; ++n) rho[n] += charge * sum[n];
    });
}

namespace detail {

// What the clouds of the energy-conserving scheme have behind walls: an image of opposite charge. With
// the potential behind a wall, phi_-1 = 2 phi_0 - phi_1, a charge there is worth two on the wall less one
// on the node inside, so that it has the same moment, and is all on the wall when its particle arrives.
// in/out: rho_g, before ghosts are folded; ghosts behind walls are zero afterwards
inline void move_ghosts_to_walls(const Grid& grid, Field& rho_g) {
    const auto move = [&](double& ghost, double& wall, double& inside) {
        wall += 2 * ghost, inside -= ghost, ghost = 0;
    };
    const long nx = grid.x.cells, nz = grid.z.cells;
    const auto rho = [&](long i, long j) -> double& { return rho_g[grid.index(i, j)]; };
    for (long i = -1; i <= nx + 1 && !grid.z.periodic; ++i) {
        move(rho(i, -1), rho(i, 0), rho(i, 1));
        move(rho(i, nz + 1), rho(i, nz), rho(i, nz - 1));
    }
    for (long j = -1; j <= nz + 1 && !grid.x.periodic; ++j) {
        move(rho(-1, j), rho(0, j), rho(1, j));
        move(rho(nx + 1, j), rho(nx, j), rho(nx - 1, j));
    }
}

// The uniform background as the clouds of the energy-conserving scheme have it, so that with as many of
// opposite charge it is neutral (N on a lattice in a cell, to 1/12 N^2): with tsc 1 + 1/12 on a wall and 1 - 1/24
// on the node inside.
inline void add_background_as_clouds(const Grid& grid, double background, Field& rho_g) {
    const auto part = [](const common::Axis& axis, long i) {
        if (axis.periodic) return 1.0;
        const auto of_wall = [](long away) { return away == 0 ? 2 : away == 1 ? -1 : 0; };
        return 1 + (of_wall(std::abs(i)) + of_wall(std::abs(axis.cells - i))) / 24.0;
    };
    for (long j = -1; j <= grid.z.cells + 1; ++j)
        for (long i = -1; i <= grid.x.cells + 1; ++i)
            rho_g[grid.index(i, j)] += background * part(grid.x, i) * part(grid.z, j);
}

}  // namespace detail

/// Charge density of all particles and of the fixed background.
///   rho_g = background + sum_p q_p S(x_g - x_p) / V_c
/// in:     every position on the mesh; in one dimension V_c = dx, in two dx dz
/// out:    rho_g on the nodes, ghosts filled; on a node of a wall, whose cell is half outside, the
///         charge is divided by the half that is inside
/// exact:  sum_g rho_g V_g = the charge of background and particles, to round-off; in the
///         energy-conserving scheme also their moment, sum_g rho_g V_g x_g, between walls
/// source: [CIC-1]
/// note:   The slide leaves out V_c; its S is a density, ours sums to 1 over the nodes.
inline void deposit_charge(const std::vector<Particles>& species, const Grid& grid,
                           const Scheme& scheme, double background, DepositScratch& scratch,
                           Field& rho_g) {
    rho_g.setZero(grid.size());
    for (const Particles& particles : species) add_charge(particles, grid, scheme, scratch, rho_g);
    if (scheme.energy_conserving) detail::move_ghosts_to_walls(grid, rho_g);
    common::fold_ghosts(grid, common::on_nodes, {1, 1}, rho_g.data());
    if (scheme.energy_conserving && scheme.order == 2)
        detail::add_background_as_clouds(grid, background, rho_g);
    else
        rho_g.array() += background;
}

}  // namespace cic
