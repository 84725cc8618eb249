// The state at t = 0: grains filled with particles, and stresses half a step before. The state of a
// restart: refused where no run can have it.
#pragma once

#include "mpm_explicit/accelerate_nodes.hpp"
#include "mpm_explicit/affine_motion.hpp"
#include "mpm_explicit/setup/case.hpp"
#include "mpm_explicit/setup/check_state.hpp"
#include "mpm_explicit/setup/scales.hpp"
#include "mpm_explicit/state.hpp"
#include "mpm_explicit/surface.hpp"
#include "mpm_explicit/update_stress.hpp"

namespace mpm_explicit {

/// Stresses are taken half a step back with the velocities of the start, as leapfrog needs them:
///   sigma^{-1/2} = sigma^0 - T : e(v^0) dt/2
/// in:     transfer, which says what particles carry
/// note:   positions stay where they are: they belong to t = 0 as the case gives them
template <class Shape>
void start_leapfrog(const Shape& shape, const std::vector<AnyLaw>& laws, const Contact& contact,
                    const Transfer& transfer, bool frozen, double dt, GrainNodes& nodes,
                    State& state) {
    Assembly& all = state.assembly;
    if (transfer.crossing > 0)
        for (std::vector<double>* one : all.particles.from())
            one->assign(static_cast<std::size_t>(all.particles.count()), 0.0);
    particles_to_grid(shape, all.particles, nodes);
    surface_to_grid(shape, all.particles, nodes);
    nodal_velocity(all.grains, all.rigid, nodes);
    predict_acceleration({}, all.grains, all.rigid, 0, nodes);
    std::vector<TileSums> sums(nodes.tiles().size());
    if (transfer.kind != Transfer::none) {
        for (std::vector<double>* one : all.particles.affine())
            one->resize(static_cast<std::size_t>(all.particles.count()), 0.0);
        take_affine_motion(shape, all.grains, nodes, transfer.kind, all.particles, sums);
    }
    start_budget(all, nodes.tiles(), sums, state.budget);
    ContactList list;
    contact.apply_to_old(all.bonds, nodes, list);
    for_each_batch(all.grains, nodes, sums, [&](ParticleBatch& batch) {
        velocity_gradient(shape, all.particles, nodes, OldVelocity{}, -0.5 * dt, batch);
        update_stress(laws, frozen, batch, all.grains, all.particles, sums);
    });
}

/// Refuses a state that no run of the case can have.
/// in:     width of the shape function in nodes
/// errors: InputError, one sentence
inline void validate_state(const Mesh& mesh, int width, const Transfer& transfer, State& state) {
    mpm::validate_state(mesh, width, transfer.kind != Transfer::none, false, state.assembly,
                        state.layout, state.budget.momenta_next);
    Particles& p = state.assembly.particles;
    const double most = GrainNodes::reach * mesh.h;
    for (const std::vector<double>* column : p.from())
        refuse(column->size() != (transfer.crossing > 0 ? p.x_p.size() : 0) ||
                   !common::all_within(*column, -most, most),
               "where its particles came from is not of this case");
}

}  // namespace mpm_explicit
