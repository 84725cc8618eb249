// The start of a run of explicit_em: the set-ups of initial_state.hpp, E from Gauss's law with
// explicit_em's own splines, and velocities half a step back.
#pragma once

#include "implicit_moment/explicit_em/count_moments.hpp"
#include "implicit_moment/explicit_em/sort_by_home.hpp"
#include "implicit_moment/explicit_em/yee_field.hpp"
#include "implicit_moment/setup/initial_state.hpp"

namespace implicit_moment {

namespace detail {

// Velocities from t^0 to t^{-1/2}.
template <int l>
inline void start_back(const PushField& field, const Grid& grid, double dt, double per_c_squared,
                       Particles& particles) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    common::for_each_block(particles.count(), [&](int, long begin, long end) {
        for (long k = begin; k < end; ++k) {
            const auto p = static_cast<std::size_t>(k);
            const double s = (particles.x_p[p] - grid.x.low) * per_dx,
                         t = (particles.z_p[p] - grid.z.low) * per_dz;
            const long i = Homes<l>::of(grid.x, s), j = Homes<l>::of(grid.z, t);
            const auto at = gather_at_home<l, double>(
                &field[static_cast<std::size_t>(
                    grid.index(i + Homes<l>::first, j + Homes<l>::first))],
                grid.stride(), s - static_cast<double>(i), t - static_cast<double>(j));
            Velocity<double> u{particles.vx_p[p], particles.vy_p[p], particles.vz_p[p]};
            back_half_step(u, at, half_kick, per_c_squared);
            particles.vx_p[p] = u.x, particles.vy_p[p] = u.y, particles.vz_p[p] = u.z;
        }
    });
}

}  // namespace detail

/// Particles at x^0, u^{-1/2} and fields at t = 0; particles sorted by home.
/// exact:  div E = 4 pi rho with rho smoothed as J will be, on every node inside.
/// note:   the loaded velocities are taken for u = gamma v.
inline State leapfrog_state(const Case& parameters) {
    const Grid& grid = parameters.grid;
    const LeapfrogSettings& settings = parameters.leapfrog;
    State state = loaded_state(parameters);
    std::vector<Particles>& species = state.plasma.species;

    SortScratch sort;
    sort_by_home(grid, settings.order, sort, species);
    PushField push;
    VectorField smoothed(grid);
    Field scratch;
    pack_push_field(grid, {0, false}, state.field, smoothed, scratch, push);
    std::vector<Moments> moments(species.size(), Moments(grid));
    count_moments(push, grid, 0, settings, species, detail::Images::conductor, moments);
    Field rho = Field::Zero(grid.size());
    for (const Moments& m : moments) rho += m.rho;
    smooth(grid, on_nodes, {-1, -1}, parameters.field.smoothing, rho.data(), scratch);
    add_electrostatic_field(grid, MeshModes(grid), rho, state.field);

    pack_push_field(grid, parameters.field.smoothing, state.field, smoothed, scratch, push);
    const double per_c_squared = detail::per_c_squared(settings);
    for (Particles& particles : species) {
        settings.order == 1
            ? detail::start_back<1>(push, grid, parameters.dt, per_c_squared, particles)
            : detail::start_back<2>(push, grid, parameters.dt, per_c_squared, particles);
    }
    return state;
}

}  // namespace implicit_moment
