// Binomial smoothing of what goes from particles to field equations and from field equations to
// particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "common/parallel.hpp"
#include "implicit_moment/field/vector_field.hpp"

namespace implicit_moment {

/// How often a quantity is smoothed, and whether the last pass restores long waves.
struct SmoothingSettings {
    long passes = 4;
    bool compensate = true;
};

namespace detail {

// The interior point that a point of a row stands for, however far outside it is, and the sign of the image.
struct Image {
    long index;
    int sign;
};
inline Image image(const common::Axis& axis, bool half, int parity, long i) {
    const long n = axis.cells, period = axis.periodic ? n : 2 * n,
               within = (i % period + period) % period;
    if (axis.periodic || within < n || (within == n && !half)) return {within, 1};
    return {2 * n - half - within, parity};
}

// One pass of (side, middle, side) in both directions over some rows of `from`, first across the rows and
// then along them; their ghosts along x are filled.
inline void smooth_rows(const Grid& grid, Place place, Parity parity, double side, double middle,
                        long rows, const double* from, double* to) {
    const long s = grid.stride(), points = grid.x.cells + 1;
    std::vector<double> room(std::size_t(grid.stride()));
    double *across = room.data(), *a = across + 1;
    for (long j = 0; j < rows; ++j) {
        const double* row = from + j * s;
        double* target = to + j * s + 1;
#pragma omp simd
        for (long i = 0; i < points + 2; ++i)
            across[i] = middle * row[i] + side * (row[i - s] + row[i + s]);
#pragma omp simd
        for (long i = 0; i < points; ++i) target[i] = middle * a[i] + side * (a[i - 1] + a[i + 1]);
        target[points] = 0;  // the last number of a row may be the image of none
        common::ghosts_along(grid.x, place.half_x, parity.x, [&](long ghost, long of, int sign) {
            target[ghost] = sign * target[of];
        });
    }
}

// All passes over several quantities that are stored one behind the other. A piece is a band of rows with as
// many beyond as the passes reach, or their images behind the ends; each pass leaves out the outermost two, so that
// no piece waits for another and a band stays in the cache. scratch holds the bands.
inline void smooth_all(const Grid& grid, long count, const Place* place, const Parity* parity,
                       const SmoothingSettings& settings, double* f, Field& scratch) {
    if (settings.passes == 0) return;
    const long size = grid.size(), s = grid.stride(), reach = settings.passes + settings.compensate,
               rows = grid.z.cells + 1, bands = (rows + 31) / 32, room = (34 + 2 * reach) * s;
    if (scratch.size() < count * bands * room) scratch.resize(count * bands * room);
    const auto for_each_band = [&](const auto& work) {
        common::for_each_piece(
            count * bands,
            [&](long piece) {
                const long band = piece % bands, first = rows * band / bands;
                work(piece / bands, first, rows * (band + 1) / bands - first,
                     scratch.data() + piece * room);
            },
            grid.size());
    };
    for_each_band([&](long k, long first, long band_rows, double* band) {
        for (long j = -reach; j < band_rows + reach; ++j) {
            const Image row = image(grid.z, place[k].half_z, parity[k].z, first + j);
            const double* from = f + k * size + grid.index(-1, row.index);
            double* to = band + (reach + j) * s;
            for (long i = 0; i < s; ++i) to[i] = row.sign * from[i];
        }
    });
    for_each_band([&](long k, long first, long band_rows, double* band) {
        const auto other = std::make_unique_for_overwrite<double[]>(std::size_t(room));
        double *from = band, *to = other.get();
        long left = band_rows + 2 * reach;  // rows of from
        const auto pass = [&](double side, double middle) {
            left -= 2;
            smooth_rows(grid, place[k], parity[k], side, middle, left, from + s, to);
            std::swap(from, to);
        };
        for (long n = 0; n < settings.passes; ++n) pass(0.25, 0.5);
        const double a = 0.25 * double(settings.passes);
        if (settings.compensate) pass(-a, 1 + 2 * a);
        std::copy_n(from, band_rows * s, f + k * size + grid.index(-1, first));
    });
    for (long k = 0; k < count; ++k) common::fill_ghosts(grid, place[k], parity[k], f + k * size);
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
