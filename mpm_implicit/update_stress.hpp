// grid -> particles: what the motion of the nodes, taken at the level theta, does to volume and
// stress.
//
//     e_p^1 - e_p^0 = 1/2 sum_i [grad S_ip v_i^theta + (..)^T] dt                          [MPM-5]
//     V_p^1 - V_p^0 = + V_p^0 sum_i grad S_ip . v_i^theta dt                               [MPM-6]
//     sigma_p^1 - sigma_p^0 = T : (e_p^1 - e_p^0)                                          [MPM-7]
// The slide prints [MPM-6] with a minus: that is the density's, [MPM-1]. The theorem [MPM-13] wants
// volumes that stay, so force and energy use those of the start unless a case asks for [MPM-6].
#pragma once

#include "mpm_explicit/viscosity.hpp"
#include "mpm_implicit/budget.hpp"
#include "mpm_implicit/theta_scheme.hpp"
#include "mpm_implicit/turned_gradient.hpp"

namespace mpm_implicit {

namespace detail {

template <class LawOf>
void update_stress(const LawOf& law, const Compliance& compliance, double theta, bool grows,
                   const ParticleBatch& batch, Particles& particles, TileSums& sums) {
    double* V_p = particles.V_p.data() + batch.begin;
    double *sxx = particles.sxx_p.data() + batch.begin, *syy = particles.syy_p.data() + batch.begin,
           *sxy = particles.sxy_p.data() + batch.begin, *szz = particles.szz_p.data() + batch.begin,
           *yield = particles.yield_p.data() + batch.begin;
    const double growth = grows ? 1 : 0;
    double elastic = 0, theta_strain = 0, plastic = 0, volume = 0, least = 1;
#pragma omp simd reduction(+ : elastic, theta_strain, plastic, volume) reduction(min : least)
    // [stress]
    for (long k = 0; k < batch.count; ++k) {
        const StrainStep de{batch.xx[k], batch.yy[k],
                            0.5 * (batch.xy[k] + batch.yx[k])};  // [MPM-5]
        const Stress old{sxx[k], syy[k], sxy[k], szz[k]};
        Stress s{sxx[k], syy[k], sxy[k], szz[k]};  // a copy of old would not vectorize
        PlasticStep dep{};
        law(de, s, dep, yield[k]);  // [MPM-7]
        const double V_old = V_p[k], ratio = 1 + growth * (de.xx + de.yy);
        const double V = V_old * ratio;  // [MPM-6]
        V_p[k] = V;
        sxx[k] = s.xx, syy[k] = s.yy, sxy[k] = s.xy, szz[k] = s.zz;
        // [/stress]

        const double dxx = s.xx - old.xx, dyy = s.yy - old.yy, dxy = s.xy - old.xy;
        const double energy = compliance(s, s);
        elastic += V * energy;
        const double answer = dxx * de.xx + dyy * de.yy + 2 * dxy * de.xy;
        theta_strain += V_old * answer;
        plastic += V_old * 0.5 * (work(old, dep) + work(s, dep));
        const double old_work = old.xx * de.xx + old.yy * de.yy + 2 * old.xy * de.xy;
        volume += (V - V_old) * (0.5 * energy - theta * (old_work + theta * answer));
        least = ratio < least ? ratio : least;
    }
    sums.elastic += 0.5 * elastic, sums.theta_strain += theta_strain;
    sums.plastic += plastic, sums.volume += volume;
    sums.least_V = least < sums.least_V ? least : sums.least_V;
}

// sigma^theta = sigma^0 + theta (sigma^1 - sigma^0) and V^theta, from which the force is made.
template <class LawOf>
void stress_at_theta(const LawOf& law, double theta, bool grows, const ParticleBatch& batch,
                     const Particles& from, BatchStress& V_s) {
    const double *V_p = from.V_p.data() + batch.begin, *sxx = from.sxx_p.data() + batch.begin,
                 *syy = from.syy_p.data() + batch.begin, *sxy = from.sxy_p.data() + batch.begin,
                 *szz = from.szz_p.data() + batch.begin, *yield = from.yield_p.data() + batch.begin;
    const double growth = grows ? theta : 0;
#pragma omp simd
    for (long k = 0; k < batch.count; ++k) {
        const StrainStep de{batch.xx[k], batch.yy[k], 0.5 * (batch.xy[k] + batch.yx[k])};
        Stress s{sxx[k], syy[k], sxy[k], szz[k]};
        PlasticStep dep{};
        double ep = yield[k];
        law(de, s, dep, ep);
        const double V = V_p[k] * (1 + growth * (de.xx + de.yy));
        V_s.xx[k] = V * (sxx[k] + theta * (s.xx - sxx[k]));
        V_s.yy[k] = V * (syy[k] + theta * (s.yy - syy[k]));
        V_s.xy[k] = V * (sxy[k] + theta * (s.xy - sxy[k]));
    }
}

}  // namespace detail

/// Volumes and stresses of a batch at the end of the step, and their energies.    [MPM-6, MPM-7]
inline void update_stress(const std::vector<AnyLaw>& laws, const ThetaScheme& scheme, double dt,
                          const ParticleBatch& batch, const std::vector<Grain>& grains,
                          Particles& particles, std::vector<TileSums>& sums) {
    const AnyLaw& law = laws[grains[batch.grain].material];
    if (law.viscosity > 0) {  // of the volumes V^theta
        BatchStress V_s{};
        sums[batch.tile].viscous += add_viscous_stress(
            law, dt, scheme.keeps_volumes() ? 0 : scheme.theta, batch, particles, V_s);
    }
    std::visit(
        [&](const auto& one) {
            detail::update_stress(one, law.compliance, scheme.theta, !scheme.keeps_volumes(), batch,
                                  particles, sums[batch.tile]);
        },
        law.law);
}

/// Force of the stress that particles have.
template <class Shape>
void force_of_stress(const Shape& shape, const std::vector<Grain>& grains,
                     const Particles& particles, GrainNodes& nodes) {
    for_each_batch(grains, nodes, [&](ParticleBatch& batch) {
        add_turned_force(shape, particles, batch, carried_stress(particles, batch), nodes);
    });
}

/// Force on the nodes of the stress that velocities v^theta would make, [MPM-5 ... 7] put in.
///   f_i = - sum_p V_p (sigma_p^theta + sigma_v) . G_ip
/// in:     nodes.motion, v^theta in the place of v_1; particles, of the old level, which stay
/// out:    nodes.force
template <class Shape>
void force_at_theta(const Shape& shape, const std::vector<AnyLaw>& laws, const ThetaScheme& scheme,
                    double dt, const std::vector<Grain>& grains, const Particles& particles,
                    GrainNodes& nodes) {
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        std::fill(nodes.force.begin() + begin, nodes.force.begin() + end, NodeForce{});
    });
    for_each_batch(grains, nodes, [&](ParticleBatch& batch) {
        velocity_gradient(shape, particles, nodes, NewVelocity{}, dt, batch);
        turn_gradient(particles, batch);
        BatchStress V_s;
        const AnyLaw& law = laws[grains[batch.grain].material];
        std::visit(
            [&](const auto& one) {
                detail::stress_at_theta(one, scheme.theta, !scheme.keeps_volumes(), batch,
                                        particles, V_s);
            },
            law.law);
        add_viscous_stress(law, dt, scheme.keeps_volumes() ? 0 : scheme.theta, batch, particles,
                           V_s);
        add_turned_force(shape, particles, batch, V_s, nodes);
    });
    reduce_ghost_force(nodes);
}

}  // namespace mpm_implicit
