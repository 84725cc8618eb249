// mesh -> particles: they take the change of velocity, move with the mesh, and share the work on
// their cells.  [FLIP-6, FLIP-7]
#pragma once

#include <atomic>

#include "flip/flip/transfer.hpp"

namespace flip {

namespace detail {

// Work on one particle that carries its volume, which it takes at its own pressure; per mass.
// in: cells.strain, work, q_work; in/out: V_p
inline double work_on_volume(const Problem& problem, const WeightScale& scale, const Weights& at,
                             const Cells& cells, std::size_t k, Particles& p) {
    const Material& a = problem.materials[static_cast<std::size_t>(p.material[k])];
    const double V = p.V_p[k], p_p = pressure(a, p.m_p[k] / V, p.e_p[k]);
    const double give = compliance(a, V, p_p);
    double strain = 0, work = 0;
    for_cells(scale, at, [&](long c, double R) {
        strain += R * cells.strain[c];
        work += R * (p_p * cells.work[c] + cells.q_work[c]);
    });
    p.V_p[k] += give * strain;
    return -give * work / p.m_p[k];
}

// What came of a row: how many particles left the mesh, and one without volume, -1: none.
struct RowMoved {
    long left = 0, inside_out = -1;
};

template <bool pure_flip, bool volumes>
RowMoved move_row(const Problem& problem, const WeightScale& scale, const Mesh& mesh,
                  const Transfer& transfer, double dt, std::size_t begin, std::size_t end,
                  Particles& p) {
    const Grid& grid = problem.grid;
    const Four* const kick = mesh.nodes.kick.data();
    const double *const heat = mesh.nodes.heat.data(), *const de = mesh.cells.de.data(),
                        *const relative_de = mesh.cells.relative_de.data();
    const long kinds = static_cast<long>(mesh.materials);
    const double deficit = problem.scheme.transfer.dissipates ? 0.5 : 0;
    RowMoved moved;
    // [move]
    for (std::size_t k = begin; k < end; ++k) {
        const Weights at = weights_at(scale, p.x_p[k], p.z_p[k]);
        Four sum = Four::Zero();
        double gained = 0;
        for_nodes(scale, at, [&](long n, double S) {
            sum += S * kick[n];
            gained += S * heat[n];
        });
        const Velocity dv{sum[0], sum[1]};
        const long kind = p.material[k];
        for_cells(scale, at, [&](long c, double R) {
            gained += R * (de[c * kinds + kind] + p.e_p[k] * relative_de[c * kinds + kind]);
        });
        gained -= deficit * dv.square();
        if constexpr (volumes) {
            gained += work_on_volume(problem, scale, at, mesh.cells, k, p);
            if (!(p.V_p[k] > 0)) moved.inside_out = static_cast<long>(k);
        }
        Velocity v{p.vx_p[k] + dv.x, p.vz_p[k] + dv.z};           // [FLIP-6]
        const double x = around(grid.x, p.x_p[k] + dt * sum[2]),  // [FLIP-7]
            z = around(grid.z, p.z_p[k] + dt * sum[3]);
        if constexpr (!pure_flip)
            gained += follow_mesh(transfer, grid, scale, at, weights_at(scale, x, z), mesh.nodes,
                                  {p.vx_p[k], p.vz_p[k]}, dv, k, p, v);
        p.vx_p[k] = v.x;
        p.vz_p[k] = v.z;
        p.e_p[k] += gained;
        p.x_p[k] = x;
        p.z_p[k] = z;
        moved.left += beyond(grid, x, z) >= 0;
    }
    // [/move]
    return moved;
}

}  // namespace detail

/// Particles after the step.
///   v_p += sum_g S (v_g^L - v_g)                                                  [FLIP-6]
///   x_p += dt sum_g S v_g^L; with an implicit pressure v_g^theta                  [FLIP-7]
///   e_p += sum_c R (de_c + e_p relative_de_c) + sum_g S heat_g - |sum_g S dv_g|^2/2
///   and what another transfer than flip makes of v_p: follow_mesh()
/// in:     nodes.kick, heat, carry; cells.de, relative_de
/// in/out: particles, sorted by row; afterwards out of order
/// out:    how many are beyond an end now
/// errors: NumericalError when the volume of a particle is not positive any more
/// exact:  mass and momentum; total energy when the deficit goes to heat: what the lumped mass
///         matrix owes is sum_p m_p [sum_g S |dv_g|^2 - |sum_g S dv_g|^2]/2, never negative
/// source: [FLIP-6, FLIP-7]
/// note:   The slide's F_g is a force per mass of the node: dv_p/dt = sum_g (F_g/m_g) S. Particles
///         move with the velocity of the mesh and not with their own: they never pass each other.
inline long move_particles(const Problem& problem, double dt, const Mesh& mesh,
                           Particles& particles) {
    const Transfer& transfer = problem.scheme.transfer;
    const bool pure = problem.scheme.transfer.flip, volumes = has(particles.V_p);
    const WeightScale scale(problem.grid);
    std::atomic<long> left{0}, inside_out{-1};
    common::for_each_row(
        problem.grid.z.cells,
        [&](long j) {
            const auto row = static_cast<std::size_t>(j);
            const auto begin = static_cast<std::size_t>(particles.first_of_row[row]),
                       end = static_cast<std::size_t>(particles.first_of_row[row + 1]);
            const auto move =
                pure ? (volumes ? detail::move_row<true, true> : detail::move_row<true, false>)
                     : (volumes ? detail::move_row<false, true> : detail::move_row<false, false>);
            const detail::RowMoved moved =
                move(problem, scale, mesh, transfer, dt, begin, end, particles);
            left += moved.left;
            if (moved.inside_out >= 0) inside_out = moved.inside_out;
        },
        particles.count());
    if (inside_out >= 0) {
        const auto k = static_cast<std::size_t>(inside_out);
        throw common::NumericalError(
            "the step turns the particle at x = " + common::format(particles.x_p[k]) +
            ", z = " + common::format(particles.z_p[k]) + " inside out: its volume would be " +
            common::format(particles.V_p[k]) + "; reduce time.cfl");
    }
    return left;
}

}  // namespace flip
