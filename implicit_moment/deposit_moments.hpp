// particles -> grid: charge, current and stress of one species, each with its own spline. [IMM-9]
//
// The slide gives rho the spline S^(l), J the spline S^(l-1) and P the spline S^(l-2). Here l = 2,
// and the order drops only in the direction that is differentiated, because d S^(l)/dx is a
// difference of S^(l-1):
//
//     rho   nodes    S2(x) S2(z)          P_xx  nodes    S0(x) S2(z)
//     J_x   x-edges  S1(x) S2(z)          P_zz  nodes    S2(x) S0(z)
//     J_y   nodes    S2(x) S2(z)          P_xz  faces    S1(x) S1(z)
//     J_z   z-edges  S2(x) S1(z)          P_xy  x-edges  S1(x) S2(z)
//                                         P_yz  z-edges  S2(x) S1(z)
//
// so that, for particles in free flight, d rho/dt + div J = 0 and dJ/dt + div P = 0 hold exactly
// at every instant.
//
// In a magnetic field what counts is the mean velocity of the coming step, which the mover will
// find as vbar = R v with the rotation R of [IMM-12]. So for the field equations the particles
// are rotated one by one before they are deposited: J and P are then sums of vbar and vbar vbar, and
//
//     J^{n+1/2} = J - dt/2 div P + (answer to E)
//
// is the flux through the midpoints that the particles will really have, to second order in their
// displacement, for any Omega dt.
#pragma once

#include <array>
#include <iterator>
#include <type_traits>

#include "implicit_moment/field/quadratic_weights.hpp"
#include "implicit_moment/moments.hpp"
#include "implicit_moment/ranks/exchange_rows.hpp"
#include "implicit_moment/rotate_particles.hpp"

namespace implicit_moment {

namespace detail {

// The sums of one node's particles over its 3 x 3 surroundings, a partial sum for each lane.
struct NodeSums {
    SimdVector rho[3][3]{}, J_y[3][3]{};
    SimdVector J_x[3][2]{}, P_xy[3][2]{};
    SimdVector J_z[2][3]{}, P_yz[2][3]{};
    SimdVector P_xz[2][2]{};
    SimdVector P_xx[3][1]{}, P_zz[1][3]{};

    // Adds particles of velocity v with the splines S; present is 0 for lanes that hold none.
    void add(const QuadraticWeights<SimdVector>& S_x, const QuadraticWeights<SimdVector>& S_z,
             const SimdVector& v_x, const SimdVector& v_y, const SimdVector& v_z,
             const SimdVector& present) {
        // [splines]
        for (int j = 0; j < 3; ++j) {
            const SimdVector S = S_z.quadratic[j] * present;
            P_xx[j][0] += S * v_x * v_x;
            for (int i = 0; i < 3; ++i) {
                const SimdVector w = S_x.quadratic[i] * S;
                rho[j][i] += w;
                J_y[j][i] += w * v_y;
            }
            for (int i = 0; i < 2; ++i) {
                const SimdVector w_v = S_x.linear[i] * S * v_x;
                J_x[j][i] += w_v;
                P_xy[j][i] += w_v * v_y;
            }
        }
        for (int j = 0; j < 2; ++j) {
            const SimdVector S_v = S_z.linear[j] * present * v_z;
            for (int i = 0; i < 3; ++i) {
                const SimdVector w_v = S_x.quadratic[i] * S_v;
                J_z[j][i] += w_v;
                P_yz[j][i] += w_v * v_y;
            }
            for (int i = 0; i < 2; ++i) P_xz[j][i] += S_x.linear[i] * S_v * v_x;
        }
        const SimdVector zz = present * v_z * v_z;
        for (int i = 0; i < 3; ++i) P_zz[0][i] += S_x.quadratic[i] * zz;
        // [/splines]
    }
};

// The same of their response to E, where they are relativistic.
struct ResponseSums {
    SimdVector A[9][3][3]{};
    void add(const QuadraticWeights<SimdVector>& S_x, const QuadraticWeights<SimdVector>& S_z,
             const std::array<SimdVector, 9>& of_particles, const SimdVector& present) {
        for (std::size_t a = 0; a < 9; ++a)
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i)
                    A[a][j][i] += S_x.quadratic[i] * (S_z.quadratic[j] * present * of_particles[a]);
    }
};
struct NoResponse {};

template <class Rotation>
inline void deposit(const Particles& particles, const Grid& grid, const Rotation& rotation,
                    Images images, Moments& moments) {
    using Dynamics = typename Rotation::Dynamics;
    std::vector<MeshRows> mesh;
    const auto begin_with = [&](Field& f) {
        mesh.push_back({f.setZero(grid.size()).data(), grid.stride()});
    };
    for (Field* f : moments.all()) begin_with(*f);
    if constexpr (Rotation::responds)
        for (Field& f : moments.response) begin_with(f);
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const double q = particles.q_p / grid.cell_area();
    const long columns = nodes_x(grid), stride = grid.stride();
    std::vector<std::array<double, 4>> sums_of_row(nodes_z(grid) + 2);  // u, 2 energy/m

    deposit_rows(particles.of_ranks, nodes_z(grid), -1, 1, mesh, [&](long row) {
        const double z_node = grid.z.at(double(row));
        SimdVector total_x{}, total_y{}, total_z{}, total_squared{};
        for (long column = 0; column < columns; ++column) {
            const long node = row * columns + column;
            const long begin = particles.first_of_node[node],
                       end = particles.first_of_node[node + 1];
            if (begin == end) continue;
            const double x_node = grid.x.at(double(column));
            const long corner = grid.index(column - 1, row - 1);  // the node down left of this one

            NodeSums sums;
            std::conditional_t<Rotation::responds, ResponseSums, NoResponse> response;
            for (long p = begin; p < end; p += simd_width) {
                const long count = end - p;
                const SimdVector present = first_simd(count);
                const SimdVector d_x = (load_simd(&particles.x_p[p], count) - x_node) * per_dx;
                const SimdVector d_z = (load_simd(&particles.z_p[p], count) - z_node) * per_dz;
                const QuadraticWeights<SimdVector> S_x(d_x), S_z(d_z);
                const Velocity<SimdVector> u{load_simd(&particles.ux_p[p], count),
                                             load_simd(&particles.uy_p[p], count),
                                             load_simd(&particles.uz_p[p], count)};
                total_x += present * u.x;
                total_y += present * u.y;
                total_z += present * u.z;
                total_squared += present * Dynamics::twice_energy(u);
                Velocity<SimdVector> v;
                if constexpr (Rotation::responds) {
                    const LinearVelocity<SimdVector> vbar = rotation(corner, S_x, S_z, u);
                    v = vbar.free;
                    response.add(S_x, S_z, vbar.A, present);
                } else {
                    v = rotation(corner, S_x, S_z, u);
                }
                sums.add(S_x, S_z, v.x, v.y, v.z, present);
            }

            // Add the sums to the mesh, from the point (i, j) of the stencil on.
            const auto add = [&](Field& f, const auto& sum, long i = 0, long j = 0) {
                for (long m = 0; m < std::ssize(sum); ++m) {
                    for (long l = 0; l < std::ssize(sum[0]); ++l)
                        f[corner + (j + m) * stride + i + l] += q * simd_sum(sum[m][l]);
                }
            };
            add(moments.rho, sums.rho);
            add(moments.J_x, sums.J_x), add(moments.J_y, sums.J_y), add(moments.J_z, sums.J_z);
            add(moments.P_xx, sums.P_xx, 1, 0), add(moments.P_zz, sums.P_zz, 0, 1);
            add(moments.P_xz, sums.P_xz), add(moments.P_xy, sums.P_xy);
            add(moments.P_yz, sums.P_yz);
            if constexpr (Rotation::responds)
                for (std::size_t a = 0; a < 9; ++a) add(moments.response[a], response.A[a]);
        }
        sums_of_row[row + 1] = {simd_sum(total_x), simd_sum(total_y), simd_sum(total_z),
                                simd_sum(total_squared)};
    });
    mesh.push_back({sums_of_row.front().data(), 4});
    gather_rows(grid, particles.of_ranks, mesh);

    moments.kinetic_energy = 0;
    moments.momentum = {};
    for (const auto& sums : sums_of_row) {
        for (std::size_t a = 0; a < 3; ++a) moments.momentum[a] += particles.m_p * sums[a];
        moments.kinetic_energy += 0.5 * particles.m_p * sums[3];
    }

    // The density that answers to a field is that of the plasma and its mirror image.
    moments.plasma_density = moments.rho;
    common::fold_ghosts(grid, on_nodes, {+1, +1}, moments.plasma_density.data());
    if constexpr (Rotation::responds) {
        for (Field& f : moments.response) {
            f *= rotation.half_kick;
            common::fold_ghosts(grid, on_nodes, {+1, +1}, f.data());
        }
    }
    fold_charge_and_current(grid, images, moments);
    fold_stress(grid, images, moments);
}

}  // namespace detail

/// Deposits the moments of one species as the slide has them.
///     rho_g = sum_p q_p S(x_g - x_p) / (dx dz),  J_g = sum_p q_p v_p S' / (dx dz),
///     P_g = sum_p q_p v_p v_p S'' / (dx dz)
/// in:     particles sorted by nearest node.
/// out:    moments with ghosts filled.
/// exact:  total charge and current; the mesh continuity equations in continuous time.
/// source: [IMM-9]
/// note:   the slide weighs P with the mass; with the charge, J and P enter [IMM-12] alike. Walls
///         mirror the plasma: a particle's image has the same charge and the opposite normal
///         velocity, so J_n is odd and vanishes on the wall, and a node on the wall counts its half
///         cell twice.
inline void deposit_moments(const Particles& particles, const Grid& grid, Moments& moments) {
    with_dynamics(particles, [&](auto dynamics) {
        detail::deposit(particles, grid, detail::NoRotation<decltype(dynamics)>{}, Images::plasma,
                        moments);
    });
}

/// Deposits the moments of one species with the mean velocities vbar = R v of the coming step in
/// place of v; energy and momentum are those of v.
/// in:     B at t^n, ghosts filled; dt of the coming step.
/// exact:  without B the moments of the slide. In any B, rho^{n+1} - rho^n + dt div(J - dt/2 div P)
///         vanishes for particles in no field E, but for terms of third order in vbar dt/dx and of
///         the change of B along the way.
/// source: [IMM-9, IMM-12]
/// note:   behind a wall stand the image charges of the conductor: opposite charge, opposite normal
///         velocity. rho and J then have the parities of E, the gather is the transpose of the
///         deposit, and a charge that touches the wall makes no field.
/// note:   the slide rotates the sums instead, R [J - dt/2 div P]. For a pressure that is not
///         isotropic the two differ as soon as Omega dt is not small, and the sum rotated on the
///         mesh feeds an instability (see the notes, "Rotate the particles").
inline void deposit_moments(const Particles& particles, const Grid& grid, const VectorField& B,
                            double dt, Moments& moments) {
    const double half_kick = 0.5 * dt * particles.q_p / particles.m_p;
    const detail::MeshB mesh_B{B.x(), B.y(), B.z(), grid.stride()};
    if (particles.relativistic)
        detail::deposit(particles, grid, detail::RelativisticRotation{mesh_B, half_kick},
                        Images::conductor, moments);
    else
        detail::deposit(particles, grid, detail::MagneticRotation{mesh_B, half_kick},
                        Images::conductor, moments);
}

/// Deposits all species for the field equations, with their mean velocities, or with v^n where R turns
/// their sums on the mesh.
inline void deposit_moments(const std::vector<Particles>& species, const Grid& grid,
                            const VectorField& B, double dt, bool rotate_on_mesh,
                            std::vector<Moments>& moments) {
    for (std::size_t k = 0; k < species.size(); ++k) {
        if (rotate_on_mesh)
            detail::deposit(species[k], grid, detail::NoRotation<Newtonian>{}, Images::conductor,
                            moments[k]);
        else
            deposit_moments(species[k], grid, B, dt, moments[k]);
    }
}

}  // namespace implicit_moment
