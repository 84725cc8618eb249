// particles -> mesh -> particles: the centrifugal force of fluid that turns about the axis, and the
// energy of the rotation that pays for it.
//
//     particle                        mesh                          particle
//     L_p at r  -- f_p S, before -->  F_g += sum_p m_p f_p S
//                                     work F_g . v_bar  -- S -->    e_p += E(r) - E(r') - dt f_p v_bar
//
// What a force brings to a node with the weight S it takes from the particle with the same S, so that
// total energy is exact; what the move from r to r' releases of the energy E beside that is heat.
#pragma once

#include "flip/flip/mesh.hpp"
#include "flip/swirl.hpp"

namespace flip {

/// What the rotation brings to the cells, for the step that it allows and for pictures.
///   sum_p m_p L R,  sum_p m_p r^2 R,  sum_p m_p (L^2/r^3) R
/// in:     particles in rows, every position on the mesh
/// out:    cells.swirl
inline void deposit_swirl(const Grid& grid, const Particles& p, Mesh& mesh) {
    std::vector<SwirlSum>& sum = mesh.cells.swirl;
    sum.assign(grid.size(), {});
    const WeightScale scale(grid);
    for_each_band(grid, p, [&](long begin, long end) {
        for (long k = begin; k < end; ++k) {
            const double r = p.x_p[k], L = p.L_p[k], m = p.m_p[k], f = centrifugal_force(L, r, r);
            for_cells(scale, weights_at(scale, r, p.z_p[k]), [&](long c, double R) {
                sum[c].L += R * m * L;
                sum[c].inertia += R * m * r * r;
                sum[c].force += R * m * f;
            });
        }
    });
    fold_cells(grid, &sum[0].L, 3);
}

/// The rate at which the fluid of a cell turns, (F/(M r))^1/2: with the force that grows as it comes
/// nearer to the axis a ring oscillates at no more than 3^1/2 of that.
inline double rate_of_swirl(const Grid& grid, const Cells& c, long i, long n) {
    return c.M[n] > 0 ? std::sqrt(c.swirl[n].force / (c.M[n] * grid.x.at(double(i) + 0.5))) : 0;
}

/// Adds the centrifugal force to those on the nodes.
///   F_g += sum_p m_p f_p S,  f_p of force_of_step()
/// in:     nodes.vx0, the velocity before the step
/// in/out: nodes.fx; mesh.swirl, f_p
inline void add_centrifugal_force(const Problem& problem, double dt, const Particles& p,
                                  Mesh& mesh) {
    const Grid& grid = problem.grid;
    Nodes& g = mesh.nodes;
    const double ahead = problem.scheme.implicit ? 2 * (1 - problem.scheme.theta) : 0;
    g.centrifugal.setZero(grid.size());
    mesh.swirl.resize(std::size_t(p.count()));
    const WeightScale scale(grid);
    for_each_band(grid, p, [&](long begin, long end) {
        for (long k = begin; k < end; ++k) {
            const Weights at = weights_at(scale, p.x_p[k], p.z_p[k]);
            double v = 0;
            for_nodes(scale, at, [&](long n, double S) { v += S * g.vx0[n]; });
            const double f = force_of_step(p.L_p[k], p.x_p[k], dt * v, ahead, p.e_p[k]);
            mesh.swirl[k] = f;
            for_nodes(scale, at, [&](long n, double S) { g.centrifugal[n] += S * p.m_p[k] * f; });
        }
    });
    fold_nodes(grid, g.centrifugal.data());
    for_each_node(grid, [&](long, long, long n) { g.fx[n] += g.centrifugal[n]; });
}

/// What is left of the energy of the rotation when the force has done its work.
///   E(r) - dt f_p sum_g S v_bar
/// in:     nodes.vx_bar; mesh.swirl, f_p
/// out:    mesh.swirl, that energy per mass
inline void work_on_swirl(const Grid& grid, double dt, const Particles& p, Mesh& mesh) {
    const WeightScale scale(grid);
    common::for_each_block(
        p.count(),
        [&](int, long begin, long end) {
            for (long k = begin; k < end; ++k) {
                double v_bar = 0;
                for_nodes(scale, weights_at(scale, p.x_p[k], p.z_p[k]),
                          [&](long n, double S) { v_bar += S * mesh.nodes.vx_bar[n]; });
                mesh.swirl[k] = swirl_energy(p.L_p[k], p.x_p[k]) - dt * mesh.swirl[k] * v_bar;
            }
        },
        p.count());
}

/// Particles [begin, end) have moved: what the rotation does not need where they are now is heat.
///   e_p += E(r) - dt f_p sum_g S v_bar - E(r')
/// exact:  total energy, with the work of the force on the nodes; L_p stays
inline void take_swirl(const Mesh& mesh, long begin, long end, Particles& p) {
    for (long k = begin; k < end; ++k) p.e_p[k] += mesh.swirl[k] - swirl_energy(p.L_p[k], p.x_p[k]);
}

}  // namespace flip
