// What explicit_em shows of its particles: charge, current and energy at t^n, where positions are,
// with u, which is half a step behind, brought there.
#pragma once

#include <array>
#include <vector>

#include "implicit_moment/explicit_em/push_particles.hpp"
#include "implicit_moment/moments.hpp"

namespace implicit_moment {

/// rho and J of one species at t^n, energy and momentum; see the function for all species.
template <int l>
inline void deposit_charge_and_current(const InterleavedField& field, const Grid& grid, double dt,
                                       const LeapfrogSettings& settings, const Particles& particles,
                                       Images images, Moments& moments) {
    for (Field* f : moments.all()) f->setZero();
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    const double per_c2 = settings.per_c_squared(), q = particles.q_p / grid.cell_area();
    const long columns = Stencil<l>::cells(grid.x), rows = Stencil<l>::cells(grid.z);
    std::vector<std::array<double, 4>> sums_of_row(nodes_z(grid) + 2);

    const Division our_rows = rows_of(particles.of_ranks, rows);
    const auto deposit_row = [&](long row) {
        std::array<double, 4>& sums = sums_of_row[row + 1];
        const double z_anchor = grid.z.at(double(row));
        for (long column = 0; column < columns; ++column) {
            const long cell = row * columns + column;
            const double x_anchor = grid.x.at(double(column));
            const long corner = grid.index(column + Stencil<l>::first, row + Stencil<l>::first);
            for (long p = particles.first_of_node[cell]; p < particles.first_of_node[cell + 1];
                 ++p) {
                const double d_x = (particles.x_p[p] - x_anchor) * per_dx,
                             d_z = (particles.z_p[p] - z_anchor) * per_dz;
                Velocity<double> u{particles.ux_p[p], particles.uy_p[p], particles.uz_p[p]};
                half_step<double>(u,
                                  gather_field<l, double>(&field[corner], grid.stride(), d_x, d_z),
                                  half_kick, per_c2);
                const double square = u.x * u.x + u.y * u.y + u.z * u.z,
                             per_gamma = inverse_gamma(u, per_c2);
                sums[0] += u.x, sums[1] += u.y, sums[2] += u.z;
                sums[3] += square / (1 + 1 / per_gamma);  // (gamma - 1) c^2, without cancellation

                const StencilWeights<l, double> S_x(d_x), S_z(d_z);
                const double v_x = q * per_gamma * u.x, v_y = q * per_gamma * u.y,
                             v_z = q * per_gamma * u.z;
                for (int j = 0; j <= l; ++j) {
                    const long n = corner + j * grid.stride();
                    for (int i = 0; i <= l; ++i) {
                        const double S = S_x.node(i) * S_z.node(j);
                        moments.rho[n + i] += q * S;
                        moments.J_y[n + i] += v_y * S;
                    }
                    for (int i = 0; i < l; ++i)
                        moments.J_x[n + i] += v_x * (S_x.half(i) * S_z.node(j));
                }
                for (int j = 0; j < l; ++j) {
                    for (int i = 0; i <= l; ++i) {
                        moments.J_z[corner + j * grid.stride() + i] +=
                            v_z * (S_x.node(i) * S_z.half(j));
                    }
                }
            }
        }
    };
    std::vector<MeshRows> mesh;
    for (Field* f : {&moments.rho, &moments.J_x, &moments.J_y, &moments.J_z})
        mesh.push_back({f->data(), grid.stride()});
    deposit_rows(our_rows, rows, Stencil<l>::first, Stencil<l>::first + l, mesh, deposit_row);
    mesh.push_back({sums_of_row.front().data(), 4});
    gather_rows(grid, our_rows, mesh);

    moments.kinetic_energy = 0;
    moments.momentum = {};
    for (const auto& sums : sums_of_row) {
        for (std::size_t a = 0; a < 3; ++a) moments.momentum[a] += particles.m_p * sums[a];
        moments.kinetic_energy += particles.m_p * sums[3];
    }
    fold_charge_and_current(grid, images, moments);
}

/// The moments of all species at t^n, with the splines of move_particles.
/// in:     field, E^n and B^n; particles sorted by cell, u of t^{n-1/2}; images, what is behind a
///         wall: a conductor's for Gauss's law, the plasma's own for what is shown.
/// out:    rho, J, kinetic energy m c^2 (gamma - 1) and momentum m u; no stress.
inline void deposit_charge_and_current(const InterleavedField& field, const Grid& grid, double dt,
                                       const LeapfrogSettings& settings,
                                       const std::vector<Particles>& species, Images images,
                                       std::vector<Moments>& moments) {
    for (std::size_t k = 0; k < species.size(); ++k) {
        settings.order == 1 ? deposit_charge_and_current<1>(field, grid, dt, settings, species[k],
                                                            images, moments[k])
                            : deposit_charge_and_current<2>(field, grid, dt, settings, species[k],
                                                            images, moments[k]);
    }
}

/// Fields at any point of the mesh.
template <int l>
inline LocalField<double> gather_field(const InterleavedField& field, const Grid& grid, double x,
                                       double z) {
    const double s = (x - grid.x.low) * (1 / grid.x.spacing()),
                 t = (z - grid.z.low) * (1 / grid.z.spacing());
    const long i = Stencil<l>::cell_of(grid.x, s), j = Stencil<l>::cell_of(grid.z, t);
    return gather_field<l, double>(&field[grid.index(i + Stencil<l>::first, j + Stencil<l>::first)],
                                   grid.stride(), s - double(i), t - double(j));
}

/// u of one particle at t^n, for output. in: field, E^n and B^n; u of t^{n-1/2}
inline Velocity<double> u_at_t(const InterleavedField& field, const Grid& grid, double dt,
                               const LeapfrogSettings& settings, const Particles& particles,
                               long p) {
    const double x = particles.x_p[p], z = particles.z_p[p];
    Velocity<double> u{particles.ux_p[p], particles.uy_p[p], particles.uz_p[p]};
    half_step(u,
              settings.order == 1 ? gather_field<1>(field, grid, x, z)
                                  : gather_field<2>(field, grid, x, z),
              0.5 * dt * particles.q_p / particles.m_p, settings.per_c_squared());
    return u;
}

/// u of one species from t^0 to t^{-1/2}. in: field, E^0 and B^0.
template <int l>
inline void half_step_back(const InterleavedField& field, const Grid& grid, double dt,
                           double per_c_squared, Particles& particles) {
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    common::for_each_block(particles.count(), [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) {
            Velocity<double> u{particles.ux_p[p], particles.uy_p[p], particles.uz_p[p]};
            half_step_back(u, gather_field<l>(field, grid, particles.x_p[p], particles.z_p[p]),
                           half_kick, per_c_squared);
            particles.ux_p[p] = ParticleReal(u.x), particles.uy_p[p] = ParticleReal(u.y),
            particles.uz_p[p] = ParticleReal(u.z);
        }
    });
}

}  // namespace implicit_moment
