// All that a run is, at one time, and how it begins.
#pragma once

#include <vector>

#include "cic/apply_particle_boundaries.hpp"
#include "cic/deposit_charge.hpp"
#include "cic/setup/load_plasma.hpp"
#include "cic/solve_field.hpp"

namespace cic {

/// What a checkpoint holds. The field is not part of it: it follows from the charge.
struct State {
    std::vector<Particles> species;
    Walls walls;
    std::vector<long> emitted_again;  // by the source wall, per species

    long count() const {  // of all ranks
        long total = 0;
        for (const Particles& s : species) total += s.count_of_all();
        return total;
    }
};

/// Gives every rank its own range of the lists of which each has read a share.
inline void keep_own(State& state) {
    for (Particles& s : state.species) share(s);
}

/// The most particles of a rank over the mean.
inline double imbalance(const State& state) {
    long own = 0;
    for (const Particles& s : state.species) own += s.count();
    const double most = double(common::largest_over_ranks(own)), all = double(state.count());
    return all > 0 ? most * common::rank_count() / all : 1;
}

/// Names every number of the state, for writing and for reading alike.
template <class Archive>
void archive(Archive& a, State& state) {
    for (std::size_t k = 0; k < state.species.size(); ++k) {
        Particles& s = state.species[k];
        a(s.name + ".x_p", common::OfAllRanks<Real>{s.x_p, common::share_of_rank()});
        a(s.name + ".z_p", common::OfAllRanks<Real>{s.z_p, common::share_of_rank()});
        a(s.name + ".vx_p", common::OfAllRanks<Real>{s.vx_p, common::share_of_rank()});
        a(s.name + ".vy_p", common::OfAllRanks<Real>{s.vy_p, common::share_of_rank()});
        a(s.name + ".vz_p", common::OfAllRanks<Real>{s.vz_p, common::share_of_rank()});
        a(s.name + ".emitted_again", state.emitted_again[k]);
    }
    for (std::size_t k = 0; k < 4; ++k)
        a("wall_charge_" + std::to_string(k), state.walls[k].charge);
}

/// The walls of a case at t = 0, uncharged.
inline Walls walls_of(const Case& parameters) {
    Walls walls;
    for (std::size_t k = 0; k < 4; ++k)
        walls[k] = {parameters.walls[k].field == "floating", parameters.walls[k].potential, 0};
    return walls;
}

/// Simulation particles of one species, of this weight, that a source wall emits in a step.
inline double emitted_per_step(const Case& parameters, const SpeciesCase& s, double weight) {
    return s.emission * parameters.dt * parameters.grid.z.length / weight;
}

/// The boundary conditions of the particles of a case, which have been loaded.
inline ParticleBoundaries particle_boundaries(const Case& parameters,
                                              const std::vector<Particles>& species) {
    ParticleBoundaries conditions;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string& does = parameters.walls[k].particles;
        conditions.walls[k] = does == "absorb"    ? AtWall::absorb
                              : does == "reflect" ? AtWall::reflect
                                                  : AtWall::source;
    }
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const double weight = species[conditions.emission.size()].m_p / s.mass;
        conditions.emission.push_back(
            {std::sqrt(s.emission_temperature / s.mass), emitted_per_step(parameters, s, weight)});
    }
    conditions.dt = parameters.dt;
    conditions.seed = std::uint64_t(parameters.seed);
    conditions.plane = parameters.dimensions == 2;
    conditions.magnetized = parameters.magnetized();
    return conditions;
}

/// Velocities of a species half a step before t = 0.
///   v^(-1/2) = R^(-1/2) v^0 - h,  or with start = "ExB"
///   v^(-1/2) = R^(-1/2) v^0 + E_p x B / B^2,  v^0 without a drift
/// note:   At t = -1/2 dt as at t = 0: accelerate() leaves the drift across B as it is.
inline void start_velocities(const MeshField& E_g, const Case& parameters, const SpeciesCase& s,
                             Particles& particles) {
    const Eigen::Vector3d B(parameters.B.x, parameters.B.y, parameters.B.z);
    std::vector<Particles> one(1);
    one[0] = std::move(particles);
    for_each_batch(one, [&](ParticleBatch& batch) {
        FieldAtParticles E_p;
        gather_field(E_g, parameters.grid, parameters.scheme(), batch, E_p);
        if (s.start != "ExB") return start_leapfrog(E_p, parameters.B, parameters.dt, batch);
        start_leapfrog(FieldAtParticles{}, parameters.B, parameters.dt, batch);
        for (long p = 0; p < batch.count; ++p) {
            const Eigen::Vector3d E(double(E_p.x[p]), 0,
                                    batch.z_p == nullptr ? 0 : double(E_p.z[p]));
            const Eigen::Vector3d v = E.cross(B) / B.squaredNorm();
            batch.vx_p[p] += Real(v[0]);
            batch.vy_p[p] += Real(v[1]);
            batch.vz_p[p] += Real(v[2]);
        }
    });
    particles = std::move(one[0]);
}

/// Particles at t = 0, with velocities half a step earlier.
inline State initial_state(const Case& parameters, FieldSolver& solver) {
    State state;
    std::uint32_t purpose = 0;
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile()) state.species.push_back(load_species(parameters, s, ++purpose));
    state.emitted_again.assign(state.species.size(), 0);
    state.walls = walls_of(parameters);

    DepositScratch scratch;
    Field rho_g;
    FieldState field;
    field.walls = state.walls;
    deposit_charge(state.species, parameters.grid, parameters.scheme(),
                   fixed_background(parameters), scratch, rho_g);
    solve_field(solver, rho_g, field);
    std::size_t mobile = 0;
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile()) start_velocities(field.E_g, parameters, s, state.species[mobile++]);
    return state;
}

}  // namespace cic
