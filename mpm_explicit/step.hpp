// The step of mpm_explicit: the slide, call by call.
#pragma once

#include <vector>

#include "common/step_clock.hpp"
#include "mpm_explicit/accelerate_nodes.hpp"
#include "mpm_explicit/affine_motion.hpp"
#include "mpm_explicit/constrain_nodes.hpp"
#include "mpm_explicit/contact.hpp"
#include "mpm_explicit/crossing.hpp"
#include "mpm_explicit/grid/grain_nodes.hpp"
#include "mpm_explicit/move_particles.hpp"
#include "mpm_explicit/state.hpp"
#include "mpm_explicit/strain.hpp"
#include "mpm_explicit/surface.hpp"
#include "mpm_explicit/transfer.hpp"
#include "mpm_explicit/update_stress.hpp"
#include "mpm_explicit/viscosity.hpp"

namespace mpm_explicit {

/// From t^n to t^{n+1}; stresses from half a step before t^n to half a step after it.
/// in:     body, forces on all mass; transfer, what particles take from the nodes; frozen: they keep
///         their places
/// in/out: nodes, sorted for where the particles are; state but the budget
/// out:    sums, which the budget takes
template <class Shape, class Clock = common::NoClock>
void take_step(const Shape& shape, const std::vector<AnyLaw>& laws, const Contact& contact,
               const BodyForce& body, const Transfer& transfer, bool frozen, double dt,
               GrainNodes& nodes, State& state, StepSums& sums, Clock&& clock = {}) {
    Particles& particles = state.assembly.particles;
    const std::vector<Grain>& grains = state.assembly.grains;
    std::vector<RigidMotion>& rigid = state.assembly.rigid;
    std::vector<Bond>& bonds = state.assembly.bonds;
    // [step]
    particles_to_grid<WithForce>(shape, particles, nodes);  // particles -> grid
    surface_to_grid(shape, particles, nodes);
    if (transfer.crossing > 0) hold_small_mass_nodes(shape, grains, bonds, state.layout, nodes);
    clock.lap("put");
    nodal_velocity(grains, rigid, nodes);                  // v_i^0
    predict_acceleration(body, grains, rigid, dt, nodes);  // v_i^1 by sigma^{-1/2}
    clock.lap("nodes");
    contact.apply_to_old(bonds, nodes, sums.contacts);  // which press, and v_i^0  [MPM-4]
    clock.lap("contact");
    for_each_batch(grains, nodes, sums.tiles, [&](ParticleBatch& batch) {
        velocity_gradient(shape, particles, nodes, OldVelocity{}, dt, batch);  // [MPM-11]
        strain_in_both_cells(shape, transfer.crossing, particles, nodes, dt, batch);
        if (!frozen) turn_halfway(batch, particles);
        update_stress(laws, frozen, batch, grains, particles, sums.tiles);  // [MPM-9, 10]
        if (!frozen) rotate_stress(batch, 0.5, particles);
        add_internal_force(shape, particles, batch, nodes);  // [MPM-12]
        add_viscous_force(shape, laws, dt, batch, grains, particles, nodes, sums.tiles);
    });
    clock.lap("stress");
    accelerate_nodes(body, grains, rigid, dt, nodes);  // v_i^1  [MPM-12]
    clock.lap("nodes");
    sums.contact = contact.apply_to_new(dt, sums.contacts, nodes, bonds, rigid);  // f_gg'  [MPM-4]
    clock.lap("contact");
    sums.nodes = work_on_nodes(body, dt, nodes);
    clock.lap("nodes");
    if (particles.has_affine())
        take_affine_motion(shape, grains, nodes, transfer.kind, particles, sums.tiles);
    if (!frozen) carry_surface(shape, grains, nodes, dt, particles);
    move_particles(shape, grains, rigid, nodes, transfer.flip, frozen, dt, particles,
                   sums.tiles);  // grid -> particles
    state.layout.moved += frozen ? 0 : dt * sums.nodes.largest_speed;
    clock.lap("move");
    // [/step]
}

}  // namespace mpm_explicit
