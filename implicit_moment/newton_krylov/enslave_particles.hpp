// particles and grid at once: particles that follow the field to where it leads them, so that both
// energy and Gauss's law hold to the tolerance of the solver.
//
// The mass matrix fixes the place x* where a particle feels the field; its current is then that of a
// particle that stands at x*, and charge is not conserved. Here the particle is felt all along its
// straight path from x^n to x^{n+1},
//
//     x^{n+1} = x^n + dt vbar,   vbar = R_p [ v^n + (q dt/2m) E_p ],   v^{n+1} = 2 vbar - v^n
//     E_p = int_0^1 sum_g W_g(x^n + s dt vbar) E_g ds
//     J_g = (1/V) sum_p q vbar int_0^1 W_g(x^n + s dt vbar) ds
//
// The same integrals in E_p and J make the exchange of energy exact; and because W are descending
// splines, d S^(l)/dx a difference of S^(l-1), rho^{n+1} - rho^n + dt div J = 0 exactly. The splines are
// polynomials between the lines halfway between nodes, so the integrals are too: between two lines,
// two points of Gauss are exact for the charge.
//
// Each particle's x^{n+1} depends on E^{n+theta}, and that on all of them. E^{n+theta} is corrected
// with the response of the mass matrix until the field equations hold with the current above.
//
// source: G. Chen, L. Chacon and D. C. Barnes, J. Comput. Phys. 230, 7018 (2011); the mass matrix
//         as the Jacobian here.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "common/run/sentence.hpp"
#include "implicit_moment/newton_krylov/particle_path.hpp"
#include "implicit_moment/ranks/exchange_rows.hpp"

namespace implicit_moment {

/// What enslaved particles keep through the iterations of one step.
struct EnslavedParticles {
    std::vector<std::vector<Velocity<double>>> vbar;  // [species][particle]
    std::vector<std::vector<detail::PathState>> state;
    std::vector<double> J_of_block;  // [block of particles][component][point]
    VectorField J, curl;
    explicit EnslavedParticles(const Grid& grid) : J(grid), curl(grid) {}
};

inline constexpr int free_iterations = 4;  // after which a path that meets a wall stays as it is

/// Ends the run where particles of a species have no path. errors: NumericalError
inline void refuse_lost(const Particles& s, double lost) {
    if (const long of_all = common::sum_over_ranks(long(lost)); of_all > 0)
        common::fail("the paths of ", double(of_all), " of the ", s.name,
                     " are not found; reduce time.dt");
}

/// Finds every particle's path in a field, and the current along the paths.
/// in:     field, the smoothed E^{n+theta} and B, ghosts filled; particles at t^n
/// in/out: enslaved.vbar, the guess and what was found
/// out:    enslaved.J, ghosts filled
/// exact:  rho(x^n + dt vbar) - rho(x^n) + dt div J = 0 to round-off, for any vbar
/// errors: NumericalError where a path has no number, or goes through more than longest_path cells
inline void follow_field(const InterleavedField& field, const Grid& grid, double dt,
                         const MoverSettings& settings, const std::vector<Particles>& species,
                         int iteration, EnslavedParticles& enslaved) {
    const long stride = grid.stride(), size = grid.size();
    enslaved.J_of_block.assign(std::size_t(common::block_count * 3 * size), 0);
    for (std::size_t k = 0; k < species.size(); ++k) {
        const Particles& s = species[k];
        const double half_kick = 0.5 * dt * s.q_p / s.m_p, q = s.q_p / grid.cell_area();
        std::array<long, common::block_count> lost{};
        const long before = sum_before_rank(s.count()), all = common::sum_over_ranks(s.count());
        // Finds paths, deposits along them, or both. in: begin and end among the particles of all ranks
        const auto follow = [&](bool finds, bool deposits, int block, long begin, long end) {
            double* J = &enslaved.J_of_block[std::size_t(block * 3 * size)];
            for (long p = std::max(0L, begin - before); p < std::min(s.count(), end - before);
                 ++p) {
                const Velocity<double> u{s.ux_p[p], s.uy_p[p], s.uz_p[p]};
                Velocity<double>& vbar = enslaved.vbar[k][std::size_t(p)];
                if (finds && !with_dynamics(s, [&](auto dynamics) {
                        return detail::find_path(dynamics, grid, field, dt, settings, half_kick,
                                                 s.x_p[p], s.z_p[p], u, iteration < free_iterations,
                                                 vbar, enslaved.state[k][std::size_t(p)]);
                    })) {
                    ++lost[std::size_t(block)];
                    continue;
                }
                if (!deposits) continue;
                detail::along_path(
                    grid, {grid.x, s.x_p[p], dt * vbar.x}, {grid.z, s.z_p[p], dt * vbar.z},
                    [&](double w, long corner, double d_x, double d_z, double m_x, double m_z) {
                        const QuadraticWeights<double> S_x(d_x), S_z(d_z);
                        const double j_x = q * w * m_x * vbar.x, j_y = q * w * vbar.y,
                                     j_z = q * w * m_z * vbar.z;
                        for (int j = 0; j < 3; ++j) {
                            const double w_x = j_x * S_z.quadratic[j], w_y = j_y * S_z.quadratic[j];
                            double *J_x = J + corner + j * stride, *J_y = J_x + size;
                            for (int i = 0; i < 2; ++i) J_x[i] += w_x * S_x.linear[i];
                            for (int i = 0; i < 3; ++i) J_y[i] += w_y * S_x.quadratic[i];
                        }
                        for (int j = 0; j < 2; ++j) {
                            const double w_z = j_z * S_z.linear[j];
                            double* J_z = J + 2 * size + corner + j * stride;
                            for (int i = 0; i < 3; ++i) J_z[i] += w_z * S_x.quadratic[i];
                        }
                    });
            }
        };
        // The sum of a block goes on from rank to rank, so there paths are found before.
        const bool alone = s.of_ranks.is_whole();
        common::for_each_block(
            all, [&](int block, long begin, long end) { follow(true, alone, block, begin, end); });
        refuse_lost(s, double(std::accumulate(lost.begin(), lost.end(), 0L)));
        if (alone) continue;
        std::array<long, common::block_count + 1> first;
        for (long n = 0; n <= common::block_count; ++n) first[std::size_t(n)] = n * 3 * size;
        common::in_turn(enslaved.J_of_block.data(), first, [&](long block) {
            follow(false, true, int(block), all * block / common::block_count,
                   all * (block + 1) / common::block_count);
        });
    }
    enslaved.J.all.setZero();
    for (long block = 0; block < common::block_count; ++block)
        enslaved.J.all += Eigen::Map<const Eigen::VectorXd>(
            &enslaved.J_of_block[std::size_t(block * 3 * size)], 3 * size);
    fold_ghosts(grid, felt(grid), enslaved.J.all.data());
}

/// Takes the step that follow_field has found: x^{n+1} where the path ends, v^{n+1} from the field along it.
/// in:     field, that of follow_field
/// exact:  particles gain dt sum V J . E, also where mover.tolerance stopped the iteration for a path: there
///         u^{n+1} is scaled to the energy q (x^{n+1} - x^n) . E_p that it was given.
/// errors: NumericalError where no speed has that energy: a path was not found
inline void move_enslaved(const InterleavedField& field, const Grid& grid, double dt,
                          const EnslavedParticles& enslaved, std::vector<Particles>& species) {
    for (std::size_t k = 0; k < species.size(); ++k) {
        Particles& s = species[k];
        const double half_kick = 0.5 * dt * s.q_p / s.m_p;
        const double lost = common::sum_over_blocks(s.count(), [&](long begin, long end) {
            double count = 0;
            for (long p = begin; p < end; ++p) {
                const Velocity<double> u{s.ux_p[p], s.uy_p[p], s.uz_p[p]},
                    &vbar = enslaved.vbar[k][std::size_t(p)];
                const detail::PathAxis x(grid.x, s.x_p[p], dt * vbar.x),
                    z(grid.z, s.z_p[p], dt * vbar.z);
                const auto at = detail::field_along(grid, field, x, z);
                const double before = detail::dot(u, u),
                             work = 2 * half_kick * detail::dot(vbar, {at.E_x, at.E_y, at.E_z});
                const auto [u_new, wanted] = with_dynamics(s, [&](auto dynamics) {
                    return std::pair(decltype(dynamics)::mean(u, at, half_kick).u_new(u),
                                     decltype(dynamics)::square_after(u, work));
                });
                const double found = detail::dot(u_new, u_new);
                if (wanted < -1e-12 * (before + found)) ++count;
                const Velocity<double> u_1 = with_energy(u_new, found, wanted);
                s.ux_p[p] = u_1.x;
                s.uy_p[p] = u_1.y;
                s.uz_p[p] = u_1.z;
                s.x_p[p] = x.end(grid.x, s.ux_p[p]);
                s.z_p[p] = z.end(grid.z, s.uz_p[p]);
            }
            return count;
        });
        refuse_lost(s, lost);
    }
}

}  // namespace implicit_moment
