// grid -> particles -> grid: how the motion of the nodes strains the particles, what stress answers,
// and the force it puts on the nodes.
//
//     V_p^{1/2} - V_p^{-1/2} = + V_p^{-1/2} sum_i grad S_ip . v_i^0 dt                 [MPM-9]
//     sigma^{1/2} - sigma^{-1/2} = T : (e^{1/2} - e^{-1/2})                             [MPM-10]
//     e^{1/2} - e^{-1/2} = 1/2 (grad v^0 + grad v^0T) dt                                [MPM-11]
//     f_i = - sum_p V_p^{1/2} sigma_p^{1/2} . grad S_ip                  the force of   [MPM-12]
// The slide prints [MPM-9] with a minus: that is the density's, [MPM-1]. In all they are what
// [MPM-1..3] are for a particle.
#pragma once

#include <variant>

#include "common/mpm/materials.hpp"
#include "common/mpm/transfer.hpp"
#include "mpm_explicit/ledger.hpp"

namespace mpm_explicit {

using namespace mpm;

/// The law of a material and its inverse, worked out once.
struct AnyLaw {
    std::variant<Elastic, J2, DruckerPrager> law;
    Compliance compliance;
};

/// Up to Chunk::size particles of one strip that are worked on together, with their velocity
/// gradients times dt.
struct Chunk {
    static constexpr long size = 128;
    int grain = 0;
    std::size_t strip = 0;
    long begin = 0, count = 0;
    double xx[size], yy[size], xy[size], yx[size];  // dt dv_x/dx, dv_y/dy, dv_x/dy, dv_y/dx
};

/// Calls work(chunk) for all particles of grains that are not rigid, and clears the sums of their
/// strips.
template <class Work>
void for_each_chunk(const std::vector<Grain>& grains, const GrainNodes& nodes,
                    std::vector<StripSums>& sums, const Work& work) {
    sums.assign(nodes.strips().size(), {});
    nodes.for_each_strip([&](const Strip& strip, std::size_t number) {
        sums[number].least_V = 1;
        if (grains[static_cast<std::size_t>(strip.grain)].rigid) return;
        Chunk chunk;
        chunk.grain = strip.grain, chunk.strip = number;
        for (chunk.begin = strip.begin; chunk.begin < strip.end; chunk.begin += Chunk::size) {
            chunk.count = std::min(Chunk::size, strip.end - chunk.begin);
            work(chunk);
        }
    });
}

/// Velocity gradients of a chunk's particles, times dt.                                  [MPM-11]
///   grad v_p = sum_i grad S_ip v_i^0
/// exact:  zero for a translation; no symmetric part for a rigid rotation of the nodes
template <class Shape>
void velocity_gradient(const Shape& shape, const Particles& particles, const GrainNodes& nodes,
                       double dt, Chunk& chunk) {
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
                          xx += Gx * v.vx_0, xy += Gy * v.vx_0;
                          yx += Gx * v.vy_0, yy += Gy * v.vy_0;
                      });
        chunk.xx[k] = dt * xx, chunk.xy[k] = dt * xy, chunk.yx[k] = dt * yx, chunk.yy[k] = dt * yy;
    }
}

namespace detail {

template <class LawOf>
void update_stress(const LawOf& law, const Compliance& compliance, bool frozen, const Chunk& chunk,
                   Particles& particles, StripSums& sums) {
    double* V_p = particles.V_p.data() + chunk.begin;
    double *sxx = particles.sxx_p.data() + chunk.begin, *syy = particles.syy_p.data() + chunk.begin,
           *sxy = particles.sxy_p.data() + chunk.begin, *szz = particles.szz_p.data() + chunk.begin,
           *yield = particles.yield_p.data() + chunk.begin;
    const double grows = frozen ? 0 : 1;
    double elastic = 0, leapfrog = 0, announced = 0, plastic_old = 0, plastic_new = 0, volume = 0,
           least = 1;
#pragma omp simd reduction(+ : elastic, leapfrog, announced, plastic_old, plastic_new, volume) \
    reduction(min : least)
    // [stress]
    for (long k = 0; k < chunk.count; ++k) {
        const StrainStep de{chunk.xx[k], chunk.yy[k], 0.5 * (chunk.xy[k] + chunk.yx[k])};
        const Stress old{sxx[k], syy[k], sxy[k], szz[k]};
        Stress s{sxx[k], syy[k], sxy[k], szz[k]};  // a copy of old would not vectorize
        PlasticStep dep{};
        law(de, s, dep, yield[k]);  // [MPM-10]
        const double V_old = V_p[k], ratio = 1 + grows * (de.xx + de.yy);
        const double V = V_old * ratio;  // [MPM-9]
        V_p[k] = V;
        sxx[k] = s.xx, syy[k] = s.yy, sxy[k] = s.xy, szz[k] = s.zz;
        // [/stress]

        const double cross = compliance(old, s);
        elastic += V * compliance(s, s), leapfrog += V * cross, volume += (V - V_old) * cross;
        announced += V_old * (old.xx * de.xx + old.yy * de.yy + 2 * old.xy * de.xy);
        plastic_old += V_old * work(old, dep), plastic_new += V * work(s, dep);
        least = ratio < least ? ratio : least;
    }
    sums.elastic += 0.5 * elastic, sums.leapfrog += 0.5 * leapfrog;
    sums.announced += 0.5 * announced, sums.volume += 0.5 * volume;
    sums.plastic_old += 0.5 * plastic_old, sums.plastic_new += 0.5 * plastic_new;
    sums.least_V = least < sums.least_V ? least : sums.least_V;
}

}  // namespace detail

/// Volumes and stresses of a chunk at the new half level, and their energies.    [MPM-9, MPM-10]
/// in:     frozen particles keep their volumes
inline void update_stress(const std::vector<AnyLaw>& laws, bool frozen, const Chunk& chunk,
                          const std::vector<Grain>& grains, Particles& particles,
                          std::vector<StripSums>& sums) {
    const AnyLaw& law =
        laws[static_cast<std::size_t>(grains[static_cast<std::size_t>(chunk.grain)].material)];
    std::visit(
        [&](const auto& one) {
            detail::update_stress(one, law.compliance, frozen, chunk, particles, sums[chunk.strip]);
        },
        law.law);
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

}  // namespace mpm_explicit
