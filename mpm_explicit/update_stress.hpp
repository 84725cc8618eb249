// What stress answers to the strain of a step, between the motion of the nodes and the force on them
// (mpm_explicit/strain.hpp).
//
//     V_p^{1/2} - V_p^{-1/2} = + V_p^{-1/2} sum_i grad S_ip . v_i^0 dt                 [MPM-9]
//     sigma^{1/2} - sigma^{-1/2} = T : (e^{1/2} - e^{-1/2})                             [MPM-10]
//     e^{1/2} - e^{-1/2} = 1/2 (grad v^0 + grad v^0T) dt                                [MPM-11]
//     f_i = - sum_p V_p^{1/2} sigma_p^{1/2} . grad S_ip                  the force of   [MPM-12]
// The slide prints [MPM-9] with a minus: that is the density's, [MPM-1]. In all they are what
// [MPM-1..3] are for a particle.
#pragma once

#include <variant>
#include <vector>

#include "mpm_explicit/ledger.hpp"
#include "mpm_explicit/strain.hpp"

namespace mpm_explicit {

using namespace mpm;

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

}  // namespace mpm_explicit
