// mesh -> particles: the field at a cloud is the field of the nodes, weighted as its charge
// was.  [CIC-3]
#pragma once

#include <vector>

#include "cic/weights.hpp"

namespace cic {

/// E of one index (i, j), both components side by side, since they are used together. In the
/// momentum-conserving scheme both are on node (i, j); in the energy-conserving one E_x is at
/// (i+1/2, j) and E_z at (i, j+1/2).
struct NodeField {
    Real x = 0, z = 0;
};
using MeshField = std::vector<NodeField>;

/// The field at every particle of a batch.
///   E_p = sum_g E_g S(x_g - x_p)
/// and in the energy-conserving scheme, per component a,
///   E_a,p = sum_e E_a,e S'(x_e - x_p)
/// For E_x, S' is the next lower spline in x and the same spline in z; for E_z the other way round.
/// in:     E_g, grid.size() values, ghosts filled; positions on the mesh
/// out:    E_p, z only in two dimensions
/// exact:  momentum-conserving: the transpose of deposit_charge, so that
///           sum_p q_p E_p = sum_g rho_g V_g E_g
///         energy-conserving: q_p E_p = -d/dx_p (1/2) sum_g rho_g V_g phi_g
/// source: [CIC-3]; Lewis, J. Comput. Phys. 6, 136 (1970), for the energy-conserving pairing.
/// note:   The slide writes S(x - x_p) without the index of the node.
template <int order, int dimensions, bool energy_conserving>
void gather_field(const MeshField& E_g, const Grid& grid, const ParticleBatch& batch,
                  FieldAtParticles& E_p) {
    constexpr int along = energy_conserving ? order - 1 : order;
    constexpr Real to_edge = energy_conserving ? Real(-0.5) : Real(0);
    const long stride = grid.stride();
    const NodeField* const origin = E_g.data() + grid.index(0, 0);
    // [gather]
    if constexpr (dimensions == 1) {
        const Clouds<along> clouds_x(grid.x, batch.x_p, batch.count, to_edge);
        for (long p = 0; p < batch.count; ++p) {
            const Weights<along> S_x = clouds_x[p];
            Real E_x = 0;
            for (int i = 0; i < S_x.count; ++i) E_x += S_x.S[i] * origin[S_x.first + i].x;
            E_p.x[p] = E_x;
        }
    } else if constexpr (!energy_conserving) {
        const Clouds<order> clouds_x(grid.x, batch.x_p, batch.count),
            clouds_z(grid.z, batch.z_p, batch.count);
        for (long p = 0; p < batch.count; ++p) {
            const Weights<order> S_x = clouds_x[p], S_z = clouds_z[p];
            const NodeField* node = origin + S_z.first * stride + S_x.first;
            Real E_x = 0, E_z = 0;
            for (int j = 0; j < S_z.count; ++j, node += stride) {
                for (int i = 0; i < S_x.count; ++i) {
                    const Real S = S_x.S[i] * S_z.S[j];
                    E_x += S * node[i].x;
                    E_z += S * node[i].z;
                }
            }
            E_p.x[p] = E_x, E_p.z[p] = E_z;
        }
    } else {
        const Clouds<order> clouds_x(grid.x, batch.x_p, batch.count),
            clouds_z(grid.z, batch.z_p, batch.count);
        const Clouds<along> edges_x(grid.x, batch.x_p, batch.count, to_edge),
            edges_z(grid.z, batch.z_p, batch.count, to_edge);
        for (long p = 0; p < batch.count; ++p) {
            const Weights<order> S_x = clouds_x[p], S_z = clouds_z[p];
            const Weights<along> edge_x = edges_x[p], edge_z = edges_z[p];
            Real E_x = 0, E_z = 0;
            for (int j = 0; j < S_z.count; ++j)
                for (int i = 0; i < edge_x.count; ++i)
                    E_x += edge_x.S[i] * S_z.S[j] *
                           origin[(S_z.first + j) * stride + edge_x.first + i].x;
            for (int j = 0; j < edge_z.count; ++j)
                for (int i = 0; i < S_x.count; ++i)
                    E_z += S_x.S[i] * edge_z.S[j] *
                           origin[(edge_z.first + j) * stride + S_x.first + i].z;
            E_p.x[p] = E_x, E_p.z[p] = E_z;
        }
    }
    // [/gather]
}

/// The same with the scheme chosen at run time.
inline void gather_field(const MeshField& E_g, const Grid& grid, const Scheme& scheme,
                         const ParticleBatch& batch, FieldAtParticles& E_p) {
    with_order_and_dimensions(scheme, [&](auto order, auto dimensions) {
        if (!scheme.energy_conserving)
            gather_field<order(), dimensions(), false>(E_g, grid, batch, E_p);
        if constexpr (order() > 0) {
            if (scheme.energy_conserving)
                gather_field<order(), dimensions(), true>(E_g, grid, batch, E_p);
        }
    });
}

}  // namespace cic
