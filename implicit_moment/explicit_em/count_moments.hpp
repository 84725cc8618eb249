// What explicit_em shows of its particles: charge, current and energy at t^n, where positions are,
// with the velocities, which are half a step behind, brought there.
#pragma once

#include <array>
#include <vector>

#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/explicit_em/push_particles.hpp"

namespace implicit_moment {

/// u^n from u^{n-1/2}: half the kick of E, then half the rotation.
/// exact:  back_half_step undoes it.
template <class Real>
inline void half_step(Velocity<Real>& u, const LocalField<Real>& at, double half_kick,
                      double per_c_squared) {
    u.x += half_kick * at.E_x, u.y += half_kick * at.E_y, u.z += half_kick * at.E_z;
    rotate(u, at, 0.5 * half_kick / c, per_c_squared);
}

/// u^{n-1/2} from u^n.
template <class Real>
inline void back_half_step(Velocity<Real>& u, const LocalField<Real>& at, double half_kick,
                           double per_c_squared) {
    rotate(u, at, -0.5 * half_kick / c, per_c_squared);
    u.x -= half_kick * at.E_x, u.y -= half_kick * at.E_y, u.z -= half_kick * at.E_z;
}

namespace detail {

/// rho and J at t^n of one species with the splines of move_particles; energy and momentum.
template <int l>
inline void count_moments(const PushField& field, const Grid& grid, double dt,
                          const LeapfrogSettings& settings, const Particles& particles,
                          Images images, Moments& moments) {
    for (Field* f : moments.all()) f->setZero();
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    const double per_c2 = per_c_squared(settings), q = particles.q_p / grid.cell_area();
    const long columns = Homes<l>::count(grid.x), rows = Homes<l>::count(grid.z);
    std::vector<std::array<double, 4>> sums_of_row(static_cast<std::size_t>(rows));

    common::for_each_row_three_colors(rows, [&](long row) {
        std::array<double, 4>& sums = sums_of_row[static_cast<std::size_t>(row)];
        const double z_home = grid.z.at(static_cast<double>(row));
        for (long column = 0; column < columns; ++column) {
            const std::size_t home = static_cast<std::size_t>(row * columns + column);
            const double x_home = grid.x.at(static_cast<double>(column));
            const long corner = grid.index(column + Homes<l>::first, row + Homes<l>::first);
            for (long k = particles.first_of_node[home]; k < particles.first_of_node[home + 1];
                 ++k) {
                const auto p = static_cast<std::size_t>(k);
                const double d_x = (particles.x_p[p] - x_home) * per_dx,
                             d_z = (particles.z_p[p] - z_home) * per_dz;
                Velocity<double> u{particles.vx_p[p], particles.vy_p[p], particles.vz_p[p]};
                half_step<double>(
                    u,
                    gather_at_home<l, double>(&field[static_cast<std::size_t>(corner)],
                                              grid.stride(), d_x, d_z),
                    half_kick, per_c2);
                const double square = u.x * u.x + u.y * u.y + u.z * u.z,
                             per_gamma = inverse_gamma(u, per_c2);
                sums[0] += u.x, sums[1] += u.y, sums[2] += u.z;
                sums[3] += square / (1 + 1 / per_gamma);  // gamma - 1, without cancellation

                const HomeWeights<l, double> S_x(d_x), S_z(d_z);
                const double v_x = q * per_gamma * u.x, v_y = q * per_gamma * u.y,
                             v_z = q * per_gamma * u.z;
                for (long j = 0; j <= l; ++j) {
                    const long n = corner + j * grid.stride();
                    for (long i = 0; i <= l; ++i) {
                        const double S = S_x.node[i] * S_z.node[j];
                        moments.rho[n + i] += q * S;
                        moments.J_y[n + i] += v_y * S;
                    }
                    for (long i = 0; i < l; ++i)
                        moments.J_x[n + i] += v_x * (S_x.half[i] * S_z.node[j]);
                }
                for (long j = 0; j < l; ++j) {
                    for (long i = 0; i <= l; ++i) {
                        moments.J_z[corner + j * grid.stride() + i] +=
                            v_z * (S_x.node[i] * S_z.half[j]);
                    }
                }
            }
        }
    });

    moments.kinetic_energy = 0;
    moments.momentum = {};
    for (const auto& sums : sums_of_row) {
        for (std::size_t a = 0; a < 3; ++a) moments.momentum[a] += particles.m_p * sums[a];
        moments.kinetic_energy += particles.m_p * sums[3];
    }
    const int w = images == Images::plasma ? +1 : -1;
    common::fold_ghosts(grid, on_nodes, {w, w}, moments.rho.data());
    common::fold_ghosts(grid, on_x_edges, {-w, w}, moments.J_x.data());
    common::fold_ghosts(grid, on_nodes, {w, w}, moments.J_y.data());
    common::fold_ghosts(grid, on_z_edges, {w, -w}, moments.J_z.data());
}

}  // namespace detail

/// The moments of all species at t^n.
/// in:     field, E^n and B^n; particles sorted by home, velocities of t^{n-1/2}; images, what is
///         behind a wall: a conductor's for Gauss's law, the plasma's own for what is shown.
/// out:    rho, J, kinetic energy m c^2 (gamma - 1) and momentum m u; no stress.
inline void count_moments(const PushField& field, const Grid& grid, double dt,
                          const LeapfrogSettings& settings, const std::vector<Particles>& species,
                          detail::Images images, std::vector<Moments>& moments) {
    for (std::size_t k = 0; k < species.size(); ++k) {
        settings.order == 1
            ? detail::count_moments<1>(field, grid, dt, settings, species[k], images, moments[k])
            : detail::count_moments<2>(field, grid, dt, settings, species[k], images, moments[k]);
    }
}

}  // namespace implicit_moment
