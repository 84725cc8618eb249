// What stress answers to the strain of a step, between the motion of the nodes and the force on
// them (mpm_explicit/strain.hpp).
//
//     V_p^{1/2} - V_p^{-1/2} = + V_p^{-1/2} sum_i grad S_ip . v_i^0 dt                 [MPM-9]
//     sigma^{1/2} - sigma^{-1/2} = T : (e^{1/2} - e^{-1/2})                             [MPM-10]
//     e^{1/2} - e^{-1/2} = 1/2 (grad v^0 + grad v^0T) dt                                [MPM-11]
//     f_i = - sum_p V_p^{1/2} sigma_p^{1/2} . grad S_ip                  the force of   [MPM-12]
// The slide prints [MPM-9] with a minus: that is the density's, [MPM-1]. Together they are
// [MPM-1..3] of a particle.
#pragma once

#include <variant>
#include <vector>

#include "mpm_explicit/budget.hpp"
#include "mpm_explicit/strain.hpp"

namespace mpm_explicit {

using namespace mpm;

namespace detail {

template <class LawOf>
void update_stress(const LawOf& law, const Compliance& compliance, bool frozen,
                   const ParticleBatch& batch, Particles& particles, TileSums& sums) {
    double* V_p = particles.V_p.data() + batch.begin;
    double *sxx = particles.sxx_p.data() + batch.begin, *syy = particles.syy_p.data() + batch.begin,
           *sxy = particles.sxy_p.data() + batch.begin, *szz = particles.szz_p.data() + batch.begin,
           *yield = particles.yield_p.data() + batch.begin;
    const double grows = frozen ? 0 : 1;
    double elastic = 0, leapfrog = 0, stress_work = 0, old_stress_work = 0, plastic_old = 0,
           plastic_new = 0, volume = 0, least = 1;
#pragma omp simd reduction(+ : elastic, leapfrog, stress_work, old_stress_work, plastic_old, plastic_new, volume) \
    reduction(min : least)
    // [stress]
    for (long k = 0; k < batch.count; ++k) {
        const StrainStep de{batch.xx[k], batch.yy[k], 0.5 * (batch.xy[k] + batch.yx[k])};
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
        old_stress_work += V_old * (old.xx * de.xx + old.yy * de.yy + 2 * old.xy * de.xy);
        stress_work += V * (s.xx * de.xx + s.yy * de.yy + 2 * s.xy * de.xy);
        plastic_old += V_old * work(old, dep), plastic_new += V * work(s, dep);
        least = ratio < least ? ratio : least;
    }
    sums.elastic += 0.5 * elastic, sums.leapfrog += 0.5 * leapfrog;
    sums.stress_work += 0.5 * stress_work;
    sums.old_stress_work += 0.5 * old_stress_work, sums.volume += 0.5 * volume;
    sums.plastic_old += 0.5 * plastic_old, sums.plastic_new += 0.5 * plastic_new;
    sums.least_V = least < sums.least_V ? least : sums.least_V;
}

}  // namespace detail

/// Volumes and stresses of a batch at the new half level, and their energies.    [MPM-9, MPM-10]
/// in:     frozen particles keep their volumes
inline void update_stress(const std::vector<AnyLaw>& laws, bool frozen, const ParticleBatch& batch,
                          const std::vector<Grain>& grains, Particles& particles,
                          std::vector<TileSums>& sums) {
    const AnyLaw& law = laws[grains[batch.grain].material];
    std::visit(
        [&](const auto& one) {
            detail::update_stress(one, law.compliance, frozen, batch, particles, sums[batch.tile]);
        },
        law.law);
}

}  // namespace mpm_explicit
