// All that a run is, at one time, and how it begins.
#pragma once

#include <vector>

#include "cic/deposit_charge.hpp"
#include "cic/setup/load_plasma.hpp"
#include "cic/solve_field.hpp"

namespace cic {

/// What a checkpoint holds. The field is not part of it: it follows from the charge.
struct State {
    std::vector<Particles> species;
    Walls walls;
    std::vector<long> emitted_again;  // by the source wall, per species

    long count() const {
        long total = 0;
        for (const Particles& s : species) total += s.count();
        return total;
    }
};

/// Names every number of the state, for writing and for reading alike.
template <class Archive>
void archive(Archive& a, State& state) {
    for (std::size_t k = 0; k < state.species.size(); ++k) {
        Particles& s = state.species[k];
        a(s.name + ".x_p", s.x_p);
        a(s.name + ".z_p", s.z_p);
        a(s.name + ".vx_p", s.vx_p);
        a(s.name + ".vy_p", s.vy_p);
        a(s.name + ".vz_p", s.vz_p);
        a(s.name + ".emitted_again", state.emitted_again[k]);
    }
    for (std::size_t k = 0; k < 4; ++k)
        a("wall_charge_" + std::to_string(k), state.walls[k].charge);
}

/// The walls of a case at t = 0, uncharged.
inline Walls walls_of(const Case& w) {
    Walls walls;
    for (std::size_t k = 0; k < 4; ++k)
        walls[k] = {w.walls[k].field == "floating", w.walls[k].potential, 0};
    return walls;
}

/// Replaces the velocities of a species by the drift in E and B,
///   v_p = E_p x B / B^2
/// note:   At t = -1/2 dt as at t = 0: accelerate() leaves this velocity as it is.
inline void start_drifting(const MeshField& E_g, const Case& w, Particles& particles) {
    const Eigen::Vector3d B(w.B.x, w.B.y, w.B.z);
    std::vector<Particles> one(1);
    one[0] = std::move(particles);
    for_each_chunk(one, [&](Chunk& p) {
        FieldAtParticles E_p;
        gather_field(E_g, w.grid, w.scheme(), p, E_p);
        for (long k = 0; k < p.count; ++k) {
            const Eigen::Vector3d E(double(E_p.x[k]), 0, p.z_p == nullptr ? 0 : double(E_p.z[k]));
            const Eigen::Vector3d v = E.cross(B) / B.squaredNorm();
            p.vx_p[k] = static_cast<Real>(v[0]);
            p.vy_p[k] = static_cast<Real>(v[1]);
            p.vz_p[k] = static_cast<Real>(v[2]);
        }
    });
    particles = std::move(one[0]);
}

/// Particles at t = 0, with velocities half a step earlier.
inline State initial_state(const Case& w, FieldSolver& solver) {
    State state;
    std::uint32_t purpose = 0;
    for (const SpeciesCase& s : w.species)
        if (s.mobile()) state.species.push_back(load_species(w, s, ++purpose));
    state.emitted_again.assign(state.species.size(), 0);
    state.walls = walls_of(w);

    DepositScratch scratch;
    Field rho_g;
    FieldState field;
    field.walls = state.walls;
    deposit_charge(state.species, w.grid, w.scheme(), fixed_background(w), scratch, rho_g);
    solve_field(solver, rho_g, field);
    for_each_chunk(state.species, [&](Chunk& p) {
        FieldAtParticles E_p;
        gather_field(field.E_g, w.grid, w.scheme(), p, E_p);
        start_leapfrog(E_p, w.B, w.dt, p);
    });
    std::size_t mobile = 0;
    for (const SpeciesCase& s : w.species) {
        if (!s.mobile()) continue;
        if (s.start == "ExB") start_drifting(field.E_g, w, state.species[mobile]);
        ++mobile;
    }
    return state;
}

}  // namespace cic
