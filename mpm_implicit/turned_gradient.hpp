// Gradients where particles are halfway through a turn, so that a body may turn by any angle without
// strain.
//
//     G_ip = grad S_ip (1 + t_p J)^-1,  t_p = dt/4 (d u_y/dx - d u_x/dy),  u = v^theta
// with J a quarter turn, counterclockwise: 1 + t_p J carries what is around a particle to the middle
// of the step. G_ip replaces grad S_ip in strain and in force alike, with the t_p of the steps before:
// so the step stays linear, and [MPM-13] holds. t_p is a mean over some steps, since with theta = 1/2
// stiff modes ring from one step to the next. Stress is kept as it is in the middle of the next step,
// turned by half a step's turn.
#pragma once

#include "mpm_explicit/contact.hpp"
#include "mpm_explicit/strain.hpp"

namespace mpm_implicit {

using namespace mpm;

/// t_p of the first step, by the velocities P_i/m_i; zero where particles are frozen. Later steps have
/// it from turn_particles().
/// in:     nodes.sums
/// out:    nodes.motion, v_0, in the first step; particles.turn_p
template <class Shape>
void start_turns(const Shape& shape, const Contact& contact, bool frozen, double dt,
                 GrainNodes& nodes, Assembly& all) {
    Particles& particles = all.particles;
    if (!particles.turn_p.empty()) return;
    particles.turn_p.assign(particles.x_p.size(), 0.0);
    if (frozen) return;
    nodal_velocity(all.grains, all.rigid, nodes);
    contact.join_bonds(all.bonds, nodes);
    for_each_batch(all.grains, nodes, [&](ParticleBatch& batch) {
        velocity_gradient(shape, particles, nodes, OldVelocity{}, dt, batch);
        double* t = particles.turn_p.data() + batch.begin;
        for (long k = 0; k < batch.count; ++k) t[k] = 0.25 * (batch.yx[k] - batch.xy[k]);
    });
}

/// L (1 + t J)^-1 of a batch's particles.                                              [MPM-5]
inline void turn_gradient(const Particles& particles, ParticleBatch& batch) {
    const double* turn = particles.turn_p.data() + batch.begin;
#pragma omp simd
    for (long k = 0; k < batch.count; ++k) {
        const double t = turn[k], c = 1 / (1 + t * t);
        const double xx = batch.xx[k], xy = batch.xy[k], yx = batch.yx[k], yy = batch.yy[k];
        batch.xx[k] = c * (xx - t * xy), batch.xy[k] = c * (xy + t * xx);
        batch.yx[k] = c * (yx - t * yy), batch.yy[k] = c * (yy + t * yx);
    }
}

/// Stress turns with the particles of a batch; their turn in this step enters the mean t_p.
/// in:     batch, after turn_gradient()
inline void turn_particles(const ParticleBatch& batch, Particles& particles) {
    rotate_stress(batch, 0.5, particles);
    rotate_stress(batch, 0.5, particles);
    double* t = particles.turn_p.data() + batch.begin;
    constexpr double part = 0.25;  // of this step in the mean
    for (long k = 0; k < batch.count; ++k)
        t[k] += part * (0.25 * (batch.yx[k] - batch.xy[k]) - t[k]);
}

/// f_i -= V_p sigma_p . G_ip of a batch.
/// in:     V_p sigma_p
/// exact:  the sum over nodes is zero; the power is that of the strain of turn_gradient()
template <class Shape>
void add_turned_force(const Shape& shape, const Particles& particles, const ParticleBatch& batch,
                      const BatchStress& V_s, GrainNodes& nodes) {
    const Locator at(nodes.mesh());
    const long* origin = nodes.origins(batch.grain);
    const auto b = static_cast<std::size_t>(batch.begin);
    const double *x_p = &particles.x_p[b], *y_p = &particles.y_p[b], *turn = &particles.turn_p[b];
    for (long k = 0; k < batch.count; ++k) {
        const double t = turn[k], c = 1 / (1 + t * t);
        const double xx = c * (V_s.xx[k] + t * V_s.xy[k]), xy = c * (V_s.xy[k] - t * V_s.xx[k]),
                     yx = c * (V_s.xy[k] + t * V_s.yy[k]), yy = c * (V_s.yy[k] - t * V_s.xy[k]);
        for_each_node(own_shape(shape, particles, b + std::size_t(k)), at, origin, x_p[k], y_p[k],
                      [&](long dof, double, double Gx, double Gy) {
                          nodes.force[dof].x -= xx * Gx + xy * Gy;
                          nodes.force[dof].y -= yx * Gx + yy * Gy;
                      });
    }
}

}  // namespace mpm_implicit
