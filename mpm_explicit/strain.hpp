// grid -> particles -> grid: what every scheme does between the motion of the nodes and the force of
// stress on them.
//
//     de_p = 1/2 (grad v_p + grad v_pT) dt,  grad v_p = sum_i grad S_ip v_i       [MPM-3, MPM-11]
//     f_i = - sum_p V_p sigma_p . grad S_ip                          the force of         [MPM-12]
// The scheme says at which time velocity and stress are taken. Particles are worked on in batches, so
// that velocity gradients stay in the cache until stress is updated, and a law runs over many at once.
#pragma once

#include <algorithm>
#include <vector>

#include "mpm_explicit/grains/material_laws.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm {

/// Up to ParticleBatch::size particles of one tile that are worked on together, with their velocity
/// gradients times dt.
struct ParticleBatch {
    static constexpr long size = 128;
    int grain = 0;
    std::size_t tile = 0;
    long begin = 0, count = 0;
    double xx[size], yy[size], xy[size], yx[size];  // dt dv_x/dx, dv_y/dy, dv_x/dy, dv_y/dx
};

/// Calls work(batch) for all particles of grains that are not rigid.
template <class Work>
void for_each_batch(const std::vector<Grain>& grains, const GrainNodes& nodes, const Work& work) {
    nodes.for_each_tile([&](const Tile& tile, std::size_t number) {
        if (grains[tile.grain].rigid) return;
        ParticleBatch batch;
        batch.grain = tile.grain, batch.tile = number;
        for (batch.begin = tile.begin; batch.begin < tile.end; batch.begin += ParticleBatch::size) {
            batch.count = std::min(ParticleBatch::size, tile.end - batch.begin);
            work(batch);
        }
    });
}

/// The same, after the sums of all tiles are cleared.
template <class Sums, class Work>
void for_each_batch(const std::vector<Grain>& grains, const GrainNodes& nodes,
                    std::vector<Sums>& sums, const Work& work) {
    sums.assign(nodes.tiles().size(), {});
    for (Sums& tile : sums) tile.least_V = 1;
    for_each_batch(grains, nodes, work);
}

/// Velocity gradients of a batch's particles, times dt.                           [MPM-5, MPM-11]
///   grad v_p = sum_i grad S_ip v_i
/// in:     velocity, OldVelocity or NewVelocity: which one of the nodes
/// exact:  zero for a translation; no symmetric part for a rigid rotation of the nodes
template <class Shape, class Velocity>
void velocity_gradient(const Shape& shape, const Particles& particles, const GrainNodes& nodes,
                       const Velocity& velocity, double dt, ParticleBatch& batch) {
    const Locator at(nodes.mesh());
    const long* origin = nodes.origins(batch.grain);
    const NodeMotion* motion = nodes.motion.data();
    static_assert(ParticleBatch::size <= Places<Shape>::size);
    Places<Shape> places;
    places.find(shape, at, particles, batch.begin, batch.count);
    for (long k = 0; k < batch.count; ++k) {
        Two along_x{}, along_y{};  // of the velocity: its derivatives
        places.for_each_node(k, origin, [&](long dof, double, double Gx, double Gy) {
            const Two v = velocity.of(motion[dof]);
            along_x += Gx * v, along_y += Gy * v;
        });
        along_x *= dt, along_y *= dt;
        batch.xx[k] = along_x[0], batch.yx[k] = along_x[1];
        batch.xy[k] = along_y[0], batch.yy[k] = along_y[1];
    }
}

/// Stresses of a batch's particles, times their volumes.
struct BatchStress {
    double xx[ParticleBatch::size], yy[ParticleBatch::size], xy[ParticleBatch::size];
};
/// The stress that the particles of a batch carry.
inline BatchStress carried_stress(const Particles& particles, const ParticleBatch& batch) {
    const auto b = static_cast<std::size_t>(batch.begin);
    const double *V_p = &particles.V_p[b], *sxx = &particles.sxx_p[b], *syy = &particles.syy_p[b],
                 *sxy = &particles.sxy_p[b];
    BatchStress V_s;
    for (long k = 0; k < batch.count; ++k)
        V_s.xx[k] = V_p[k] * sxx[k], V_s.yy[k] = V_p[k] * syy[k], V_s.xy[k] = V_p[k] * sxy[k];
    return V_s;
}

/// Force of stresses of a batch on the nodes.                                            [MPM-12]
///   f_i -= V_p sigma_p . grad S_ip
/// exact:  the sum over nodes is zero
template <class Shape>
void add_force(const Shape& shape, const Particles& particles, const ParticleBatch& batch,
               const BatchStress& V_s, GrainNodes& nodes) {
    const Locator at(nodes.mesh());
    const long* origin = nodes.origins(batch.grain);
    NodeForce* force = nodes.force.data();
    Places<Shape> places;
    places.find(shape, at, particles, batch.begin, batch.count);
    for (long k = 0; k < batch.count; ++k) {
        const Two minus_x{-V_s.xx[k], -V_s.xy[k]}, minus_y{-V_s.xy[k], -V_s.yy[k]};
        places.for_each_node(k, origin, [&](long dof, double, double Gx, double Gy) {
            add(&force[dof].x, Gx * minus_x + Gy * minus_y);
        });
    }
}

/// The same of the stress that the particles carry.
template <class Shape>
void add_internal_force(const Shape& shape, const Particles& particles, const ParticleBatch& batch,
                        GrainNodes& nodes) {
    add_force(shape, particles, batch, carried_stress(particles, batch), nodes);
}

/// The gradient of the displacement of a batch's particles, taken at their places halfway, in the step
/// that ends where they are now.
///   G = L (1 - L/2)^-1,  L = dt grad v_p
/// exact:  no symmetric part for a turn R by any angle, which is L = 1 - R^T where it ends
/// source: Hughes and Winget, Int. J. Numer. Methods Eng. 15, 1862 (1980).
inline void gradient_halfway(ParticleBatch& batch) {
#pragma omp simd
    for (long k = 0; k < batch.count; ++k) {
        const double xx = batch.xx[k], yy = batch.yy[k], xy = batch.xy[k], yx = batch.yx[k];
        const double half = 0.5 * (xx * yy - xy * yx),
                     per_det = 1 / (1 - 0.5 * (xx + yy) + 0.5 * half);
        batch.xx[k] = per_det * (xx - half), batch.yy[k] = per_det * (yy - half);
        batch.xy[k] = per_det * xy, batch.yx[k] = per_det * yx;
    }
}

/// Stress turns with the body, by `part` of the particle's turn in the step.
///   tan(angle) = part/2 (G_yx - G_xy)
/// exact:  energies and invariants stay; two halves make the turn of Hughes and Winget
/// note:   The slide's [MPM-2] has no such term; grains that roll need it.
inline void rotate_stress(const ParticleBatch& batch, double part, Particles& particles) {
    const auto b = static_cast<std::size_t>(batch.begin);
    double *sxx = &particles.sxx_p[b], *syy = &particles.syy_p[b], *sxy = &particles.sxy_p[b];
#pragma omp simd
    for (long k = 0; k < batch.count; ++k) {
        const Stress s =
            rotated({sxx[k], syy[k], sxy[k], 0}, 0.5 * part * (batch.yx[k] - batch.xy[k]));
        sxx[k] = s.xx, syy[k] = s.yy, sxy[k] = s.xy;
    }
}

/// What [MPM-11] leaves out, so that a body may turn by any angle without strain: the gradient of the
/// displacement is taken where particles were halfway, and stress has turned with them so far.
inline void turn_halfway(ParticleBatch& batch, Particles& particles) {
    gradient_halfway(batch);
    rotate_stress(batch, 0.5, particles);
}

}  // namespace mpm
