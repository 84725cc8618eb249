// grid -> particles -> grid: what every scheme does between the motion of the nodes and the force of
// stress on them.
//
//     de_p = 1/2 (grad v_p + grad v_pT) dt,  grad v_p = sum_i grad S_ip v_i       [MPM-3, MPM-11]
//     f_i = - sum_p V_p sigma_p . grad S_ip                          the force of         [MPM-12]
// At which time velocity and stress are taken is for the scheme to say. Particles are worked on in
// chunks, so that what is between the two stays in the cache and a law runs over many at once.
#pragma once

#include <algorithm>
#include <variant>
#include <vector>

#include "mpm_explicit/materials.hpp"
#include "mpm_explicit/setup/plan_grains.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm {

/// The law of a material and its inverse, worked out once.
struct AnyLaw {
    std::variant<Elastic, J2, DruckerPrager> law;
    Compliance compliance;
};

/// The law of every material.
inline std::vector<AnyLaw> laws_of(const Problem& problem) {
    std::vector<AnyLaw> laws;
    for (const Material& m : materials_of(problem)) {
        laws.push_back({Elastic(m), Compliance(m)});
        if (m.law == Law::j2) laws.back().law = J2(m);
        if (m.law == Law::drucker_prager) laws.back().law = DruckerPrager(m);
    }
    return laws;
}

/// Up to Chunk::size particles of one strip that are worked on together, with their velocity
/// gradients times dt.
struct Chunk {
    static constexpr long size = 128;
    int grain = 0;
    std::size_t strip = 0;
    long begin = 0, count = 0;
    double xx[size], yy[size], xy[size], yx[size];  // dt dv_x/dx, dv_y/dy, dv_x/dy, dv_y/dx
};

/// Calls work(chunk) for all particles of grains that are not rigid.
template <class Work>
void for_each_chunk(const std::vector<Grain>& grains, const GrainNodes& nodes, const Work& work) {
    nodes.for_each_strip([&](const Strip& strip, std::size_t number) {
        if (grains[static_cast<std::size_t>(strip.grain)].rigid) return;
        Chunk chunk;
        chunk.grain = strip.grain, chunk.strip = number;
        for (chunk.begin = strip.begin; chunk.begin < strip.end; chunk.begin += Chunk::size) {
            chunk.count = std::min(Chunk::size, strip.end - chunk.begin);
            work(chunk);
        }
    });
}

/// The same, after the sums of all strips are cleared.
template <class Sums, class Work>
void for_each_chunk(const std::vector<Grain>& grains, const GrainNodes& nodes,
                    std::vector<Sums>& sums, const Work& work) {
    sums.assign(nodes.strips().size(), {});
    for (Sums& strip : sums) strip.least_V = 1;
    for_each_chunk(grains, nodes, work);
}

/// Velocity gradients of a chunk's particles, times dt.                           [MPM-5, MPM-11]
///   grad v_p = sum_i grad S_ip v_i
/// in:     velocity, OldVelocity or NewVelocity: which one of the nodes
/// exact:  zero for a translation; no symmetric part for a rigid rotation of the nodes
template <class Shape, class Velocity>
void velocity_gradient(const Shape& shape, const Particles& particles, const GrainNodes& nodes,
                       const Velocity& velocity, double dt, Chunk& chunk) {
    const Locator at(nodes.mesh());
    const long* origin = nodes.origins(chunk.grain);
    const NodeMotion* motion = nodes.motion.data();
    const double *x_p = particles.x_p.data() + chunk.begin,
                 *y_p = particles.y_p.data() + chunk.begin;
    for (long k = 0; k < chunk.count; ++k) {
        double xx = 0, yy = 0, xy = 0, yx = 0;
        for_each_node(shape, at, origin, x_p[k], y_p[k],
                      [&](long slot, double, double Gx, double Gy) {
                          const NodeMotion& v = motion[slot];
                          const double vx = velocity.x(v), vy = velocity.y(v);
                          xx += Gx * vx, xy += Gy * vx;
                          yx += Gx * vy, yy += Gy * vy;
                      });
        chunk.xx[k] = dt * xx, chunk.xy[k] = dt * xy, chunk.yx[k] = dt * yx, chunk.yy[k] = dt * yy;
    }
}

/// Force of a chunk's stress on the nodes.                                               [MPM-12]
///   f_i -= V_p sigma_p . grad S_ip
/// exact:  the sum over nodes is zero
template <class Shape>
void add_internal_force(const Shape& shape, const Particles& particles, const Chunk& chunk,
                        GrainNodes& nodes) {
    const Locator at(nodes.mesh());
    const long* origin = nodes.origins(chunk.grain);
    NodeForce* force = nodes.force.data();
    const auto b = static_cast<std::size_t>(chunk.begin);
    const double *x_p = &particles.x_p[b], *y_p = &particles.y_p[b], *V_p = &particles.V_p[b],
                 *sxx = &particles.sxx_p[b], *syy = &particles.syy_p[b], *sxy = &particles.sxy_p[b];
    for (long k = 0; k < chunk.count; ++k) {
        const double xx = V_p[k] * sxx[k], yy = V_p[k] * syy[k], xy = V_p[k] * sxy[k];
        for_each_node(shape, at, origin, x_p[k], y_p[k],
                      [&](long slot, double, double Gx, double Gy) {
                          force[slot].x -= xx * Gx + xy * Gy;
                          force[slot].y -= xy * Gx + yy * Gy;
                      });
    }
}

/// At the end of the step, stress turns with the body, by the particle's spin.
/// exact:  energies and invariants stay
/// note:   The slide's [MPM-2] has no such term; grains that roll need it.
inline void turn_stress(const Chunk& chunk, Particles& particles) {
    const auto b = static_cast<std::size_t>(chunk.begin);
    double *sxx = &particles.sxx_p[b], *syy = &particles.syy_p[b], *sxy = &particles.sxy_p[b];
#pragma omp simd
    for (long k = 0; k < chunk.count; ++k) {
        const Stress s = rotated({sxx[k], syy[k], sxy[k], 0}, 0.5 * (chunk.yx[k] - chunk.xy[k]));
        sxx[k] = s.xx, syy[k] = s.yy, sxy[k] = s.xy;
    }
}

}  // namespace mpm
