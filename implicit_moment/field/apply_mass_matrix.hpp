// on the grid: the current that a field drives, J = M E, and what M makes of a uniform plasma.
#pragma once

#include <array>
#include <cmath>

#include "common/parallel.hpp"
#include "implicit_moment/mass_matrix.hpp"

namespace implicit_moment {

/// What a uniform density makes of a wave with k dx = angle between two splines of the same order,
/// the sum over g of cos(angle g) times the integral of S(x) S(x - g): 1 for long waves.
inline double linear_overlap(double angle) { return (2 + std::cos(angle)) / 3; }
inline double quadratic_overlap(double angle) {
    return (33 + 26 * std::cos(angle) + std::cos(2 * angle)) / 60;
}
/// The same of a linear spline on midpoints and a quadratic one on nodes: cos(angle (g + 1/2)) times the
/// integral of S1(x) S2(x - g - 1/2).
inline double mixed_overlap(double angle) {
    return (11 * std::cos(0.5 * angle) + std::cos(1.5 * angle)) / 12;
}

/// The mean over the cells of the current J_a that M makes of a uniform field E_b = 1.
/// in: pair, 3 a + b
inline double mean_response(const Grid& grid, const MassMatrix& mass, int pair) {
    const long stride = grid.stride();
    const int first = detail::first_offset(pair), end = detail::first_offset(pair + 1);
    const Division rows = stored_rows(grid, mass.of_ranks);
    double sum = 0;
    common::in_turn(&sum, std::array{0L, 1L}, [&](long) {
        for (long row = rows.begin(); row < rows.end(grid.z.cells + 3); ++row) {
            const double* entry =
                &mass.entry[std::size_t((row * detail::offsets + first) * stride)];
            for (long n = 0; n < (end - first) * stride; ++n) sum += entry[n];
        }
    });
    return sum / double(grid.x.cells * grid.z.cells);
}

/// J = M E.
/// in:     E as particles feel it, ghosts filled
/// out:    J, ghosts filled
/// exact:  sum_g J_g . E_g V >= 0 over the unknowns: the power of E on the velocity that E itself gives.
inline void apply_mass_matrix(const Grid& grid, MassMatrix& mass, const double* E, double* J) {
    const long stride = grid.stride(), size = grid.size();
    const long margin = 2 * stride + 2, room = size + 2 * margin;
    mass.padded.assign(std::size_t(3 * room), 0);
    double* padded = mass.padded.data();
    for (long a = 0; a < 3; ++a) std::copy_n(E + a * size, size, padded + a * room + margin);
    const Division rows = stored_rows(grid, mass.of_ranks);
    common::for_each_row(
        rows.end(grid.z.cells + 3) - rows.begin(),
        [&](long k) {
            const long row = rows.begin() + k;
            const double* entry = &mass.entry[std::size_t(row * detail::offsets * stride)];
            for (int a = 0; a < 3; ++a) {
                double* sum = J + a * size + row * stride;
                std::fill_n(sum, stride, 0.0);
                for (int b = 0; b < 3; ++b) {
                    for (int j = 0; j < detail::rows_of(a, b); ++j) {
                        for (int i = 0; i < detail::columns_of(a, b); ++i, entry += stride) {
                            const double* E_h = padded + b * room + margin +
                                                (row + j - detail::high[a] + 1) * stride + i -
                                                detail::wide[a] + 1;
#pragma omp simd
                            for (long n = 0; n < stride; ++n) sum[n] += entry[n] * E_h[n];
                        }
                    }
                }
            }
        },
        detail::offsets * size);
    gather_rows(grid, mass.of_ranks, {{J, stride}, {J + size, stride}, {J + 2 * size, stride}});
    fold_ghosts(grid, felt(grid), J);
}

}  // namespace implicit_moment
