// What a particle carries in clouds-in-cells: position and velocity, charge and mass. The mesh
// keeps nothing from one step to the next.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "cic/own_blocks.hpp"
#include "cic/units.hpp"
#include "common/grid.hpp"

namespace cic {

using common::Field;
using common::Grid;

/// Sums over particles that the mover makes in passing.
struct ParticleSums {
    double kinetic = 0;                // energy at the time of the positions
    std::array<double, 3> momentum{};  // at the new velocities

    void add(const ParticleSums& other) {
        kinetic += other.kinetic;
        for (std::size_t a = 0; a < 3; ++a) momentum[a] += other.momentum[a];
    }
};

/// One species, structure of arrays. z_p is empty in one dimension; vy_p, and vz_p in one
/// dimension, are empty without a magnetic field, which alone could change or show them.
struct Particles {
    std::string name;
    double q_p = 0, m_p = 0;             // charge and mass of one simulation particle
    std::vector<Real> x_p, z_p;          // at t^n
    std::vector<Real> vx_p, vy_p, vz_p;  // at t^(n-1/2), after accelerate() at t^(n+1/2)
    ParticleSums sums;                   // of the last step
    long among_ranks = 0;                // where there are several, how many they have together

    long count() const { return long(x_p.size()); }
    long count_of_all() const { return common::rank_count() > 1 ? among_ranks : count(); }
    std::array<std::vector<Real>*, 5> all() { return {&x_p, &z_p, &vx_p, &vy_p, &vz_p}; }
};

/// Gives a species room for as many particles, with the components that can change.
inline void resize(long count, bool plane, bool magnetized, Particles& particles) {
    particles.x_p.resize(count);
    particles.vx_p.resize(count);
    if (plane) particles.z_p.resize(count);
    if (magnetized) particles.vy_p.resize(count);
    if (magnetized || plane) particles.vz_p.resize(count);
}

/// The most particles that are worked on together: few enough for all their numbers to stay in the
/// nearest cache from one line of the slide to the next, and for the next ones to come from memory
/// meanwhile.
inline constexpr long batch_size = 64;

/// A batch of consecutive particles of one species, a view of its arrays; null where the species
/// has no such component.
struct ParticleBatch {
    Real *x_p, *z_p, *vx_p, *vy_p, *vz_p;
    long count;
    double q_p, m_p;
    ParticleSums sums;
};

/// The field at the particles of a batch, E_p.z only in two dimensions.
struct FieldAtParticles {
    Real x[batch_size], z[batch_size];
};

/// Calls work(batch) for all particles of all species, batch by batch.
/// out:    sums of every species, added in an order that does not depend on the threads.
template <class Work>
void for_each_batch(std::vector<Particles>& species, const Work& work) {
    for (Particles& s : species) {
        std::array<ParticleSums, common::block_count> sums{};
        for_each_own_block(s.count_of_all(), [&](int block, long begin, long end) {
            const auto from = [](std::vector<Real>& values, long p) {
                return values.empty() ? nullptr : values.data() + p;
            };
            for (long p = begin; p < end; p += batch_size) {
                ParticleBatch batch{from(s.x_p, p),  from(s.z_p, p),  from(s.vx_p, p),
                                    from(s.vy_p, p), from(s.vz_p, p), std::min(batch_size, end - p),
                                    s.q_p,           s.m_p,           {}};
                work(batch);
                sums[block].add(batch.sums);
            }
        });
        gather_blocks(sums);
        s.sums = {};
        for (const ParticleSums& block : sums) s.sums.add(block);
    }
}

}  // namespace cic
