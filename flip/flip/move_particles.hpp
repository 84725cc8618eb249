// mesh -> particles: they take the velocity increment, move with the mesh, and share the work on
// their cells.  [FLIP-6, FLIP-7]
#pragma once

#include <atomic>

#include "common/run/sentence.hpp"
#include "flip/boundaries.hpp"
#include "flip/flip/ring_paths.hpp"
#include "flip/flip/transfer.hpp"
#include "flip/flip/work_on_volume.hpp"
#include "flip/state.hpp"

namespace flip {

namespace detail {

// [conservative]
// What bilinear velocities lack for the divergence of their cell to be that of each place in it: else
// particles gather where it is less, in the corner that a lid drives them into, and leave voids where
// it is more; and under gravity they fall together within a cell, where no pressure feels it: water at
// rest would begin to boil, as exp(0.17 t sqrt(g/dz)). The flow through the sides of the cell stays as
// it is.
//   v_x += (dx/2 dz) S_x0 S_x1 t_z,  v_z += (dz/2 dx) S_z0 S_z1 t_x,  t = v_00 - v_10 - v_01 + v_11
// source: Wang, Agrusta and van Hunen, Geochem. Geophys. Geosyst. 16, 2015 (2015).
[[gnu::always_inline]] inline Velocity missing_velocity(const Grid& grid, const WeightScale& scale,
                                                        const Weights& w, const Four* v) {
    const Four t =
        v[w.node] - v[w.node + 1] - v[w.node + scale.stride] + v[w.node + scale.stride + 1];
    const double aspect = grid.x.spacing() / grid.z.spacing();
    return {0.5 * aspect * w.S_x[0] * w.S_x[1] * t[3], 0.5 / aspect * w.S_z[0] * w.S_z[1] * t[2]};
}
// [/conservative]

// The same for a batch, also in rings.
inline void find_missing_velocity(Grid grid, WeightScale scale, const BatchWeights& weights,
                                  const Four* v, long count, double* missing_x, double* missing_z) {
    if (!grid.axisymmetric) {
        for (long k = 0; k < count; ++k) {
            const Velocity missing = missing_velocity(grid, scale, weights[k], v);
            missing_x[k] = missing.x, missing_z[k] = missing.z;
        }
        return;
    }
    const double dr = grid.x.spacing(), dz = grid.z.spacing();
    double r_1[batch_size], v_r[4][batch_size], turn_z[batch_size];
    for (long k = 0; k < count; ++k) {
        const Weights w = weights[k];
        const RingFlow flow = ring_flow(scale, w, v);
        for (int corner = 0; corner < 4; ++corner) v_r[corner][k] = flow.r[corner];
        turn_z[k] = flow.turn_z;
        r_1[k] = dr * (w.node % scale.stride - 1);
    }
#pragma omp simd
    for (long k = 0; k < count; ++k) {
        const Weights w = weights[k];
        const RingFlow flow{{v_r[0][k], v_r[1][k], v_r[2][k], v_r[3][k]}, turn_z[k]};
        const Velocity missing = missing_velocity_of_ring(dr, dz, r_1[k], w.S_x[1], w.S_z[1], flow);
        missing_x[k] = missing.x, missing_z[k] = missing.z;
    }
}

// What came of a row: how many particles left the mesh, and one without volume, -1: none.
struct RowMoved {
    long left = 0, inverted = -1;
};

// Moves a batch of particles, the first of them `begin`: first each fetches what the mesh has for it, then
// all of them take it, in a loop that vectorizes.
template <bool pure_flip, bool volumes>
void move_batch_of_flip(const Problem& problem, WeightScale scale, const Mesh& mesh, double dt,
                        long begin, long count, Particles& p, RowMoved& moved) {
    const Grid& grid = problem.grid;
    const Transfer& transfer = problem.scheme.transfer;
    const Four* const increment = mesh.nodes.increment.data();
    const double* const dissipated = mesh.nodes.dissipated.data();
    const Two* const de = mesh.cells.de.data();
    const long materials = mesh.materials;
    const double deficit = transfer.dissipates ? 0.5 : 0;
    double *const x_p = p.x_p.data() + begin, *const z_p = p.z_p.data() + begin,
                  *const vx_p = p.vx_p.data() + begin, *const vz_p = p.vz_p.data() + begin,
                  *const e_p = p.e_p.data() + begin;
    const int* const material = p.material.data() + begin;
    const BatchWeights weights(scale, x_p, z_p, count);
    Four from_nodes[batch_size];  // increment, and the velocity that moves the particle
    double gained[batch_size], missing_x[batch_size] = {}, missing_z[batch_size] = {};
    // [move]
    for (long k = 0; k < count; ++k) {
        const Weights at = weights[k];
        Four sum = Four::Zero();
        double gain = 0;
        for_nodes(scale, at, [&](long n, double S) {
            sum += S * increment[n];
            gain += S * dissipated[n];
        });
        Two change = Two::Zero();
        for_cells(scale, at,
                  [&](long c, double R) { change += R * de[c * materials + material[k]]; });
        from_nodes[k] = sum;
        gained[k] = gain + change[0] + e_p[k] * change[1];
        if constexpr (volumes) {
            gained[k] += work_on_volume(problem, scale, at, mesh.cells, begin + k, p);
            if (!(p.V_p[begin + k] > 0)) moved.inverted = begin + k;
        }
    }
    if (problem.scheme.conservative_paths)
        find_missing_velocity(grid, scale, weights, increment, count, missing_x, missing_z);
    const double low_x = grid.x.low, high_x = grid.x.high(), low_z = grid.z.low,
                 high_z = grid.z.high();
    double x[batch_size], z[batch_size];
    long inside = 0;
#pragma omp simd reduction(+ : inside)
    for (long k = 0; k < count; ++k) {
        const double dvx = from_nodes[k][0], dvz = from_nodes[k][1];
        gained[k] -= deficit * (dvx * dvx + dvz * dvz);
        x[k] = x_p[k] + dt * (from_nodes[k][2] + missing_x[k]);  // [FLIP-7]
        z[k] = z_p[k] + dt * (from_nodes[k][3] + missing_z[k]);
        const bool here = (x[k] >= low_x) & (x[k] < high_x) & (z[k] >= low_z) & (z[k] < high_z);
        inside += here ? 1 : 0;
    }
    if (inside < count)
        for (long k = 0; k < count; ++k) {
            x[k] = wrap(grid.x, x[k]);
            z[k] = wrap(grid.z, z[k]);
            moved.left += side_crossed(grid, x[k], z[k]) >= 0;
        }
    for (long k = 0; k < count; ++k) {
        const Velocity dv{from_nodes[k][0], from_nodes[k][1]};
        Velocity v{vx_p[k] + dv.x, vz_p[k] + dv.z};  // [FLIP-6]
        if constexpr (!pure_flip) {
            const bool dust = problem.materials[material[k]].gamma == 1;  // may owe
            gained[k] += apply_transfer(
                transfer, grid, scale, weights[k], weights_at(scale, x[k], z[k]), mesh.nodes,
                {vx_p[k], vz_p[k]}, dv, dust ? 1e300 : e_p[k] + gained[k], begin + k, p, v);
        }
        vx_p[k] = v.x;
        vz_p[k] = v.z;
        e_p[k] += gained[k];
        x_p[k] = x[k];
        z_p[k] = z[k];
    }
    // [/move]
}

template <bool pure_flip, bool volumes>
RowMoved move_row(const Problem& problem, const WeightScale& scale, const Mesh& mesh, double dt,
                  long begin, long end, Particles& p) {
    RowMoved moved;
    for (long k = begin; k < end; k += batch_size)
        move_batch_of_flip<pure_flip, volumes>(problem, scale, mesh, dt, k,
                                               std::min(batch_size, end - k), p, moved);
    return moved;
}

}  // namespace detail

/// Particles after the step.
///   v_p += sum_g S (v_g^L - v_g)                                                  [FLIP-6]
///   x_p += dt sum_g S v_g^L; with an implicit pressure v_g^theta                  [FLIP-7]
///          on conservative paths with what that lacks of the divergence of the cell
///   e_p += sum_c R (de_c[0] + e_p de_c[1]) + sum_g S dissipated_g - |sum_g S dv_g|^2/2
///   and what another transfer than flip makes of v_p: apply_transfer(); where the fluid turns about
///   the axis, what the move leaves of the energy of that: take_swirl()
/// in:     nodes.increment, dissipated, filtered; cells.de
/// in/out: particles in rows; afterwards perhaps not
/// out:    how many are beyond a boundary now
/// errors: NumericalError when the volume of a particle is not positive any more
/// exact:  mass and momentum; total energy when the deficit goes to heat: what the lumped mass
///         matrix owes is sum_p m_p [sum_g S |dv_g|^2 - |sum_g S dv_g|^2]/2, never negative
/// source: [FLIP-6, FLIP-7]
/// note:   The slide's F_g is a force per mass of the node: dv_p/dt = sum_g (F_g/m_g) S. Particles
///         move with the velocity of the mesh and not with their own: they never pass each other.
inline long move_particles(const Problem& problem, double dt, const Mesh& mesh,
                           Particles& particles) {
    const bool volumes = has(particles.V_p);
    const WeightScale scale(problem.grid);
    const auto move =
        problem.scheme.transfer.flip
            ? (volumes ? detail::move_row<true, true> : detail::move_row<true, false>)
            : (volumes ? detail::move_row<false, true> : detail::move_row<false, false>);
    std::atomic<long> left{0}, inverted{-1};
    common::for_each_row(
        problem.grid.z.cells,
        [&](long j) {
            const detail::RowMoved moved = move(problem, scale, mesh, dt, particles.first_of_row[j],
                                                particles.first_of_row[j + 1], particles);
            left += moved.left;
            if (moved.inverted >= 0) inverted = moved.inverted;
            if (particles.swirl)
                take_swirl(mesh, particles.first_of_row[j], particles.first_of_row[j + 1],
                           particles);
        },
        particles.count());
    if (const long k = inverted; k >= 0)
        common::fail("the step turns the particle at x = ", particles.x_p[k],
                     ", z = ", particles.z_p[k], " inside out: its volume would be ",
                     particles.V_p[k], "; reduce time.cfl");
    return left;
}

/// Particles that have left are removed, and those that have entered are added, out of order.
/// in:     t, dt of the step that has moved them; left, how many it has moved beyond a boundary, or
///         any number above 0 when that is not known
/// out:    budget: mass, momentum and energy of what crossed, with apic also that of the motion
///         within a particle, as move_particles() has left it
/// errors: NumericalError for a particle beyond a wall
inline void apply_particle_boundaries(const Problem& problem, double t, double dt, Particles& p,
                                      Budget& budget, long left = 1) {
    const WeightScale scale(problem.grid);
    const auto enter = [&](long k, double sign) {
        const double m = sign * p.m_p[k];
        budget.enter(m, p.vx_p[k], p.vz_p[k], p.e_p[k]);
        if (has(p.L_p)) budget.enter_swirl(m, p.L_p[k], p.x_p[k]);
        if (!has(p.Cxx_p)) return;
        const double C[4] = {p.Cxx_p[k], p.Cxz_p[k], p.Czx_p[k], p.Czz_p[k]};
        budget.energy += m * affine_energy(problem.grid, weights_at(scale, p.x_p[k], p.z_p[k]), C);
    };
    if (left > 0) remove_outflow(problem, t + dt, p, [&](long k) { enter(k, -1); });
    const long before = p.count();
    add_inflow(problem, t, dt, p);
    for (long k = before; k < p.count(); ++k) enter(k, 1);
}

}  // namespace flip
