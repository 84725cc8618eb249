// particles -> grid: the current of the coming step as the particles themselves will carry it, linear
// in the field that is not known yet. It stands beside the slide's prediction from moments, and
// carries [MPM-13], the energy of any step, to the plasma.
//
// Where a particle feels the field of the step, x*, is fixed before that field is known. Its mean
// velocity is then linear in E = E^{n+theta},
//
//     vbar_p = R_p [ v_p^n + (q dt/2m) sum_h W_h(x*) E_h ],     R_p the rotation of [IMM-12],
//
// and so is the current that the particles deposit at x* with the same splines W:
//
//     J_g = (1/V) sum_p q W_g(x*) vbar_p = J_hat_g + sum_h M_gh E_h
//     J_hat_g = (1/V) sum_p q W_g R_p v_p^n
//     M_gh    = (1/V) sum_p (q^2 dt/2m) W_g R_p W_h             (a tensor for each pair of places)
//
// M is a mass matrix. The slide's chi is 4 pi theta dt M with each row summed to its diagonal, as a lumped mass is,
// and its J - dt/2 div P is J_hat expanded about x^n.
//
// g and h run over the 21 places that the particles of one nearest node reach: 2 x 3 x-edges (S1 S2),
// 3 x 3 nodes (S2 S2), 3 x 2 z-edges (S2 S1). These particles all add to one 21 x 21 block,
//
//     block = sum_p a_p b_p^T,   a_p = q W_g / V,   b_p = (q dt/2m) R_p W_h  and, 22nd, R_p v_p,
//
// whose last column is J_hat.
//
// The mean velocity of a relativistic particle is not linear in E; its tangent at a guess, the field of the step
// before, is: A of mean_velocity.hpp stands for R then.
//
// source: G. Lapenta, J. Comput. Phys. 334, 349 (2017), with other splines and other places.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/field/smooth.hpp"

namespace implicit_moment {

namespace detail {

// The places of E_x, E_y, E_z around one node, and where each component begins among the 21.
inline constexpr int places = 21;
inline constexpr std::array<int, 3> wide{2, 3, 3}, high{3, 3, 2};
inline constexpr std::array<int, 4> first_place{0, 6, 15, places};

// What h of component b can be away from g of component a: so many columns and rows, the first of
// them -(wide[a] - 1) and -(high[a] - 1). Such offsets are counted through all pairs of components.
constexpr int columns_of(int a, int b) { return wide[a] + wide[b] - 1; }
constexpr int rows_of(int a, int b) { return high[a] + high[b] - 1; }
constexpr int first_offset(int pair) {
    int first = 0;
    for (int k = 0; k < pair; ++k) first += columns_of(k / 3, k % 3) * rows_of(k / 3, k % 3);
    return first;
}
inline constexpr int offsets = first_offset(9);

}  // namespace detail

/// M on the mesh: for every place g the 15 to 25 places h of each component that share particles with
/// it, 167 numbers per node; and J_hat, which is found in the same sweep.
/// note:   the number of (row, offset, column) stands at (row * 167 + offset) * stride + column, with
///         rows and columns as they are stored, ghosts included.
struct MassMatrix {
    std::vector<double> entry;
    VectorField J_hat;           // ghosts filled
    std::vector<double> padded;  // E with room around it
    Division of_ranks;           // the rows of each rank, which has no others of M

    explicit MassMatrix(const Grid& grid) : J_hat(grid) {}
};

namespace detail {

inline constexpr int columns = 24, J_column = places;  // 21 places, J_hat, two that stay 0

// A few particles on both sides of a block. Plain numbers, so that the loops over columns take the width of
// the machine's registers by themselves.
struct BlockFactors {
    alignas(64) double a[places][simd_width];      // [g][particle]
    alignas(64) double b[3][simd_width][columns];  // [component][particle][column]

    // in: weights W of the 21 places; a_scale = q / V, 0 in lanes that hold no particle; b_scale = q dt / 2m;
    //     R and R v, or A and what is left of vbar without E
    void set(const SimdVector (&W)[places], const SimdVector& a_scale, double b_scale,
             const LinearVelocity<SimdVector>& linear) {
        for (int g = 0; g < places; ++g) {
            const SimdVector scaled = W[g] * a_scale;
            __builtin_memcpy(a[g], &scaled, sizeof scaled);
        }
        for (int p = 0; p < simd_width; ++p) {
            double row[columns] = {};
            for (int h = 0; h < places; ++h) row[h] = b_scale * W[h][p];
            const double v[3] = {linear.free.x[p], linear.free.y[p], linear.free.z[p]};
            for (int k = 0; k < 3; ++k) {
                for (int component = 0; component < 3; ++component) {
                    const double R_kc = linear.A[std::size_t(3 * k + component)][p];
                    for (int h = first_place[component]; h < first_place[component + 1]; ++h)
                        b[k][p][h] = R_kc * row[h];
                }
                b[k][p][J_column] = v[k];
                for (int h = J_column + 1; h < columns; ++h) b[k][p][h] = 0;
            }
        }
    }
};

// The block of one node's particles of all species.
struct NodeBlock {
    alignas(64) double row[places][columns] = {};

    // Adds a b^T of the particles, at most four at a time.
    void add(const BlockFactors& factors) {
        constexpr int together = std::min(simd_width, 4);
        for (int component = 0; component < 3; ++component) {
            for (int first = 0; first < simd_width; first += together) {
                const double(*b)[columns] = &factors.b[component][first];
                for (int g = first_place[component]; g < first_place[component + 1]; ++g) {
                    const double* a = &factors.a[g][first];
#pragma omp simd
                    for (int h = 0; h < columns; ++h) {
                        double sum = a[0] * b[0][h];
                        for (int p = 1; p < together; ++p) sum += a[p] * b[p][h];
                        row[g][h] += sum;
                    }
                }
            }
        }
    }
};

// Where the 21 places stand, from the corner down left of their node, and where the block's numbers go,
// from row and column of that corner.
struct BlockPlaces {
    std::array<long, places> place{};
    std::array<std::array<long, places>, places> entry{};

    explicit BlockPlaces(const Grid& grid) {
        const long stride = grid.stride();
        const auto for_each_place = [&](const auto& visit) {
            for (int a = 0; a < 3; ++a)
                for (int j = 0; j < high[a]; ++j)
                    for (int i = 0; i < wide[a]; ++i)
                        visit(first_place[a] + j * wide[a] + i, a, i, j);
        };
        for_each_place([&](int g, int a, int i, int j) {
            place[g] = a * grid.size() + j * stride + i;
            for_each_place([&](int h, int b, int i_h, int j_h) {
                const int column = i_h - i + wide[a] - 1, row = j_h - j + high[a] - 1;
                const int offset = first_offset(3 * a + b) + row * columns_of(a, b) + column;
                entry[g][h] = (long(j) * offsets + offset) * stride + i;
            });
        });
    }
};

}  // namespace detail

/// Deposits M and J_hat of all species.
/// in:     particles at x*, sorted by node there; B, ghosts filled, in which their velocities are
///         rotated; guess, E near E^{n+theta} and B, which relativistic particles ask for; dt
/// out:    mass, with what was deposited behind walls and periodic ends folded back in J_hat; M keeps
///         it and is folded where it is applied
/// exact:  J_hat + M E is the current of kick_particles in that E, to round-off; of relativistic particles to
///         second order in E less the guess.
inline void deposit_mass_matrix(const std::vector<Particles>& species, const Grid& grid,
                                const VectorField& B, const InterleavedField& guess, double dt,
                                MassMatrix& mass) {
    const long nodes = nodes_x(grid), stride = grid.stride();
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const detail::MeshB mesh_B{B.x(), B.y(), B.z(), stride};
    const auto rotated = [](const Velocity<SimdVector>& v, const Velocity<SimdVector>& b,
                            double k) {
        const auto R = rotation_matrix<SimdVector>(k * b.x, k * b.y, k * b.z);
        return LinearVelocity<SimdVector>{
            R,
            {R[0] * v.x + R[1] * v.y + R[2] * v.z, R[3] * v.x + R[4] * v.y + R[5] * v.z,
             R[6] * v.x + R[7] * v.y + R[8] * v.z}};
    };
    const detail::BlockPlaces block_places(grid);
    mass.entry.assign(std::size_t((grid.z.cells + 3) * detail::offsets * stride), 0);
    mass.J_hat.all.setZero();
    double* J_hat = mass.J_hat.all.data();
    mass.of_ranks = species.empty() ? Division{} : species.front().of_ranks;
    std::vector<MeshRows> mesh = rows_of_vector(grid, mass.J_hat);
    mesh.push_back({mass.entry.data(), detail::offsets * stride});

    deposit_rows(mass.of_ranks, nodes_z(grid), -1, 1, mesh, [&](long row) {
        const double z_node = grid.z.at(double(row));
        detail::BlockFactors factors;
        for (long column = 0; column < nodes; ++column) {
            const long node = row * nodes + column, corner = grid.index(column - 1, row - 1);
            const double x_node = grid.x.at(double(column));
            detail::NodeBlock block;
            bool empty = true;
            for (const Particles& s : species) {
                const double half_kick = 0.5 * dt * s.q_p / s.m_p, k = half_kick / c;
                const long begin = s.first_of_node[node], end = s.first_of_node[node + 1];
                for (long p = begin; p < end; p += simd_width) {
                    const long count = end - p;
                    empty = false;
                    const SimdVector d_x = (load_simd(&s.x_p[p], count) - x_node) * per_dx,
                                     d_z = (load_simd(&s.z_p[p], count) - z_node) * per_dz;
                    const QuadraticWeights<SimdVector> S_x(d_x), S_z(d_z);
                    // [mass_matrix]
                    SimdVector W[detail::places];
                    for (int j = 0; j < 3; ++j) {
                        for (int i = 0; i < 2; ++i) W[2 * j + i] = S_x.linear[i] * S_z.quadratic[j];
                        for (int i = 0; i < 3; ++i)
                            W[detail::first_place[1] + 3 * j + i] =
                                S_x.quadratic[i] * S_z.quadratic[j];
                    }
                    for (int j = 0; j < 2; ++j)
                        for (int i = 0; i < 3; ++i)
                            W[detail::first_place[2] + 3 * j + i] =
                                S_x.quadratic[i] * S_z.linear[j];
                    const Velocity<SimdVector> u{load_simd(&s.ux_p[p], count),
                                                 load_simd(&s.uy_p[p], count),
                                                 load_simd(&s.uz_p[p], count)};
                    const LinearVelocity<SimdVector> linear =
                        s.relativistic
                            ? linear_mean_velocity<SimdVector>(
                                  u, gather_field<SimdVector>(&guess[corner], stride, d_x, d_z),
                                  half_kick)
                            : rotated(u, mesh_B.at(corner, S_x, S_z), k);
                    factors.set(W, first_simd(count) * (s.q_p / grid.cell_area()), half_kick,
                                linear);
                    block.add(factors);
                    // [/mass_matrix]
                }
            }
            if (empty) continue;
            double* entry = &mass.entry[std::size_t(row * detail::offsets * stride + column)];
            for (int g = 0; g < detail::places; ++g) {
                for (int h = 0; h < detail::places; ++h)
                    entry[block_places.entry[g][h]] += block.row[g][h];
                J_hat[corner + block_places.place[g]] += block.row[g][detail::J_column];
            }
        }
    });
    gather_rows(grid, mass.of_ranks, rows_of_vector(grid, mass.J_hat));
    fold_ghosts(grid, felt(grid), mass.J_hat.all.data());
}

}  // namespace implicit_moment
