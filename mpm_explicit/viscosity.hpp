// Viscosity of Kelvin and Voigt: beside the elastic stress, one that answers the rate of strain.
//
//     sigma_v = beta T : de/dt,  f_i -= sum_p V_p sigma_v . grad S_ip    beside that of [MPM-2]
// It is in the force on nodes and not in the particle's memory, so the elastic energy is that of the
// elastic stress. A motion of the whole grain feels nothing of it; a wave of frequency omega decays
// as exp(-beta omega^2 t/2).
#pragma once

#include "mpm_explicit/strain.hpp"

namespace mpm {

/// Adds the viscous stress of a batch, times volume; nothing where beta = 0.
///   V_p beta/dt T : de
/// in:     batch, its velocity gradients times dt; growth, of the volumes per trace of de
/// out:    what it takes in a step, sum_p V_p sigma_v : de
/// exact:  that is never negative; zero for a rigid motion of the nodes
inline double add_viscous_stress(const AnyLaw& law, double dt, double growth,
                                 const ParticleBatch& batch, const Particles& particles,
                                 BatchStress& V_s) {
    if (law.viscosity == 0) return 0;
    const double* V_p = particles.V_p.data() + batch.begin;
    const double per_dt = law.viscosity / dt, lambda = law.T.lambda, two_G = 2 * law.T.G;
    double taken = 0;
#pragma omp simd reduction(+ : taken)
    for (long k = 0; k < batch.count; ++k) {
        const double xx = batch.xx[k], yy = batch.yy[k], xy = 0.5 * (batch.xy[k] + batch.yx[k]),
                     trace = xx + yy, V = per_dt * V_p[k] * (1 + growth * trace);
        V_s.xx[k] += V * (lambda * trace + two_G * xx);
        V_s.yy[k] += V * (lambda * trace + two_G * yy);
        V_s.xy[k] += V * two_G * xy;
        taken += V * (lambda * trace * trace + two_G * (xx * xx + yy * yy + 2 * xy * xy));
    }
    return taken;
}

/// Force of the viscous stress of a batch on the nodes; sums.viscous, as add_viscous_stress().
template <class Shape, class Sums>
void add_viscous_force(const Shape& shape, const std::vector<AnyLaw>& laws, double dt,
                       const ParticleBatch& batch, const std::vector<Grain>& grains,
                       const Particles& particles, GrainNodes& nodes, std::vector<Sums>& sums) {
    const AnyLaw& law = laws[grains[batch.grain].material];
    if (law.viscosity == 0) return;
    BatchStress V_s{};
    sums[batch.tile].viscous += add_viscous_stress(law, dt, 0, batch, particles, V_s);
    add_force(shape, particles, batch, V_s, nodes);
}

}  // namespace mpm
