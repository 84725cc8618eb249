// particles -> mesh: every cloud shares its charge among the nodes that it touches.  [CIC-1]
#pragma once

#include <vector>

#include "cic/weights.hpp"

namespace cic {

/// Room for one mesh per block of particles, kept between steps.
struct DepositScratch {
    std::vector<std::vector<Real>> sum_of_block;
};

namespace detail {

// Adds S of the particles [begin, end) to one mesh.
template <int order, int dimensions>
void add_weights(const Particles& particles, const Grid& grid, long begin, long end, Real* sum) {
    const Real x_low = Real(grid.x.low), z_low = Real(grid.z.low);
    const Real per_dx = Real(1 / grid.x.spacing()), per_dz = Real(1 / grid.z.spacing());
    const long stride = grid.stride();
    Real* const origin = sum + grid.index(0, 0);
    // [deposit]
    for (long p = begin; p < end; ++p) {
        const Weights<order> S_x((particles.x_p[p] - x_low) * per_dx);
        if constexpr (dimensions == 1) {
            for (int i = 0; i < S_x.count; ++i) origin[S_x.first + i] += S_x.S[i];
        } else {
            const Weights<order> S_z((particles.z_p[p] - z_low) * per_dz);
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
    const long size = grid.size();
    scratch.sum_of_block.resize(common::block_count, std::vector<Real>(size));
    with_order_and_dimensions(scheme, [&](auto order, auto dimensions) {
        common::for_each_block(particles.count(), [&](int block, long begin, long end) {
            auto& sum = scratch.sum_of_block[block];
            sum.assign(size, 0);
            detail::add_weights<order(), dimensions()>(particles, grid, begin, end, sum.data());
        });
    });
    const double charge = particles.q_p / grid.cell_area();
    common::for_each_row(grid.z.cells + 3, [&](long row) {
        for (long n = row * grid.stride(); n < (row + 1) * grid.stride(); ++n) {
            double sum = 0;
            for (const auto& block : scratch.sum_of_block) sum += double(block[n]);
            rho_g[n] += charge * sum;
        }
    });
}

/// Charge density of all particles and of the fixed background.
///   rho_g = background + sum_p q_p S(x_g - x_p) / V_c
/// in:     every position on the mesh; in one dimension V_c = dx, in two dx dz
/// out:    rho_g on the nodes, ghosts filled; on a node of a wall, whose cell is half outside, the
///         charge is divided by the half that is inside
/// exact:  sum_g rho_g V_g = the charge of background and particles, to round-off
/// source: [CIC-1]
/// note:   The slide leaves out V_c; its S is a density, ours sums to 1 over the nodes.
inline void deposit_charge(const std::vector<Particles>& species, const Grid& grid,
                           const Scheme& scheme, double background, DepositScratch& scratch,
                           Field& rho_g) {
    rho_g.setZero(grid.size());
    for (const Particles& particles : species) add_charge(particles, grid, scheme, scratch, rho_g);
    common::fold_ghosts(grid, common::on_nodes, {1, 1}, rho_g.data());
    rho_g.array() += background;
}

}  // namespace cic
