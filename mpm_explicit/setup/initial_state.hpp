// The state at t = 0: grains filled with particles, and stresses half a step before.
#pragma once

#include "mpm_explicit/accelerate_nodes.hpp"
#include "mpm_explicit/setup/case.hpp"
#include "mpm_explicit/setup/scales.hpp"
#include "mpm_explicit/state.hpp"
#include "mpm_explicit/update_stress.hpp"

namespace mpm_explicit {

/// Stresses are taken half a step back with the velocities of the start, as leapfrog needs them:
///   sigma^{-1/2} = sigma^0 - T : e(v^0) dt/2
/// note:   positions stay where they are: they belong to t = 0 as the case gives them
template <class Shape>
void start_leapfrog(const Shape& shape, const std::vector<AnyLaw>& laws, const Contact& contact,
                    bool frozen, double dt, GrainNodes& nodes, State& state) {
    Assembly& all = state.assembly;
    put_on_nodes(shape, all.particles, nodes);
    velocity_of_nodes(all.grains, all.rigid, nodes);
    contact.join_bonds(all.bonds, nodes);
    std::vector<StripSums> sums;
    for_each_chunk(all.grains, nodes, sums, [&](Chunk& chunk) {
        velocity_gradient(shape, all.particles, nodes, OldVelocity{}, -0.5 * dt, chunk);
        update_stress(laws, frozen, chunk, all.grains, all.particles, sums);
    });
    open_ledger(all, state.ledger);
}

}  // namespace mpm_explicit
