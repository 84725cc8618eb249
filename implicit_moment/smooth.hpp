// Binomial smoothing of what goes from particles to field equations and from field equations to
// particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel.hpp"
#include "implicit_moment/vector_field.hpp"

namespace implicit_moment {

/// How often a quantity is smoothed, and whether the last pass restores long waves.
struct SmoothingSettings {
    long passes = 4;
    bool compensate = true;
};

namespace detail {

// One pass of (side, middle, side) in both directions, out of place: across the rows into the row
// `across`, then along them.
inline void stencil_rows(const Grid& grid, double side, double middle, const double* f,
                         double* across, double* out) {
    const long s = grid.stride(), points = grid.x.cells + 1;
    const double* a = across + 1;
    for (long j = 0; j <= grid.z.cells; ++j) {
        const double* row = f + grid.index(-1, j);
        double* target = out + grid.index(0, j);
#pragma omp simd
        for (long i = 0; i < points + 2; ++i)
            across[i] = middle * row[i] + side * (row[i - s] + row[i + s]);
#pragma omp simd
        for (long i = 0; i < points; ++i) target[i] = middle * a[i] + side * (a[i - 1] + a[i + 1]);
    }
}

// All passes over several quantities that are stored one behind the other, each on one thread: a
// quantity stays in its cache, and no thread waits between passes. scratch holds a copy and a row of
// each quantity.
inline void smooth_all(const Grid& grid, long count, const Place* place, const Parity* parity,
                       const SmoothingSettings& settings, double* f, Field& scratch) {
    if (settings.passes == 0) return;
    const long size = grid.size(), row = grid.stride();
    if (scratch.size() < count * (size + row)) scratch.setZero(count * (size + row));
    common::for_each_row(
        count,
        [&](long k) {
            double *from = f + k * size, *to = scratch.data() + k * size,
                   *across = scratch.data() + count * size + k * row;
            const auto pass = [&](double side, double middle) {
                stencil_rows(grid, side, middle, from, across, to);
                common::fill_ghosts(grid, place[k], parity[k], to);
                std::swap(from, to);
            };
            for (long n = 0; n < settings.passes; ++n) pass(0.25, 0.5);
            const double a = 0.25 * double(settings.passes);
            if (settings.compensate) pass(-a, 1 + 2 * a);
            if (from != f + k * size) std::copy_n(from, size, f + k * size);
        },
        numbers_to_share(grid));
}

}  // namespace detail

/// Smooths one quantity in place: `passes` times (1/4, 1/2, 1/4) in x and z, then once
/// (-a, 1 + 2a, -a) with a = passes/4.
/// In Fourier space one direction is multiplied with
///     cos^2(k dx/2)^passes [1 + 4 a sin^2(k dx/2)] = 1 - O((k dx)^4):
/// waves are kept, grid noise is removed.
/// in/out: f, ghosts filled before and after; scratch, room that is kept between calls.
/// exact:  a constant is unchanged; smoothing commutes with the differences of the mesh, so Gauss's
///         law and continuity stay exact; it is its own transpose.
inline void smooth(const Grid& grid, Place place, Parity parity, const SmoothingSettings& settings,
                   double* f, Field& scratch) {
    detail::smooth_all(grid, 1, &place, &parity, settings, f, scratch);
}

/// Smooths the three components of a vector.
inline void smooth(const Grid& grid, const VectorKind& kind, const SmoothingSettings& settings,
                   double* all, Field& scratch) {
    detail::smooth_all(grid, 3, kind.place.data(), kind.parity.data(), settings, all, scratch);
}

/// What smooth() does to a wave with k dx = angle in one direction.
inline double smoothing_factor(const SmoothingSettings& settings, double angle) {
    if (settings.passes == 0) return 1;
    const double half = std::cos(0.5 * angle) * std::cos(0.5 * angle);
    const double passes = double(settings.passes);
    return std::pow(half, passes) * (settings.compensate ? 1 + passes * (1 - half) : 1.0);
}

}  // namespace implicit_moment
