// Binomial smoothing of what goes from particles to field equations and from field equations to
// particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "common/parallel.hpp"
#include "implicit_moment/simd.hpp"
#include "implicit_moment/vector_field.hpp"

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
    const long n = axis.cells;
    if (i >= 0 && i < n) return {i, 1};
    const long period = axis.periodic ? n : 2 * n, within = (i % period + period) % period;
    if (axis.periodic || within < n || (within == n && !half)) return {within, 1};
    return {2 * n - half - within, parity};
}

// What all passes together do along one direction: the weights of a point, of its neighbors, of theirs and so on.
inline std::vector<double> smoothing_weights(const SmoothingSettings& settings) {
    std::vector<double> weights{1};
    const auto pass = [&](double side, double middle) {
        const auto at = [&](long k) {
            return std::abs(k) < long(weights.size()) ? weights[std::size_t(std::abs(k))] : 0;
        };
        std::vector<double> after;
        for (long k = 0; k <= long(weights.size()); ++k)
            after.push_back(middle * at(k) + side * (at(k - 1) + at(k + 1)));
        weights = after;
    };
    for (long n = 0; n < settings.passes; ++n) pass(0.25, 0.5);
    const double a = 0.25 * double(settings.passes);
    if (settings.compensate) pass(-a, 1 + 2 * a);
    return weights;
}

// Smooths a row of one quantity, first across the rows and then along it. Behind an end go on the images.
class RowSmoother {
   public:
    RowSmoother(const Grid& grid, Place place, Parity parity, const std::vector<double>& weights)
        : grid_(grid), half_z_(place.half_z), parity_z_(parity.z), weights_(weights) {
        const long reach = long(weights.size()) - 1, n = grid.x.cells;
        for (long i = -reach; i <= n + reach; ++i)
            along_x_.push_back(image(grid.x, place.half_x, parity.x, i));
    }

    struct Row {
        const double* f;
        double weight;
    };
    // What a thread works in.
    struct Room {
        std::vector<Row> rows;
        std::vector<double> across;
        Room(const Grid& grid, std::size_t weights)
            : rows(2 * weights), across(std::size_t(grid.x.cells + simd_width) + 2 * weights) {}
    };

    // to = row j of `from`
    void operator()(long j, const double* from, Room& room, double* to) const {
        const long reach = long(weights_.size()) - 1, n = grid_.x.cells;
        double* across = room.across.data() + reach;
        Row* rows = room.rows.data();
        for (long k = -reach; k <= reach; ++k) {
            const Image row = image(grid_.z, half_z_, parity_z_, j + k);
            rows[reach + k] = {from + grid_.index(0, row.index),
                               row.sign * weights_[std::size_t(std::abs(k))]};
        }
        for (long i = 0; i <= n; i += simd_width) {
            SimdVector sum{};
            for (long k = 0; k <= 2 * reach; ++k)
                sum += rows[k].weight * load_simd(rows[k].f + i, simd_width);
            store_simd(sum, across + i, simd_width);
        }
        for (long i = -reach; i <= n + reach; ++i) {
            if (i == 0) i = n;
            const Image point = along_x_[std::size_t(i + reach)];
            across[i] = point.sign * across[point.index];
        }
        double* row = to + grid_.index(0, j);
        const auto at = [&](long i) { return load_simd(across + i, simd_width); };
        for (long i = 0; i <= n; i += simd_width) {
            SimdVector sum = weights_[0] * at(i);
            for (long k = 1; k <= reach; ++k)
                sum += weights_[std::size_t(k)] * (at(i - k) + at(i + k));
            store_simd(sum, row + i, n + 1 - i);
        }
    }

   private:
    const Grid& grid_;
    bool half_z_;
    int parity_z_;
    const std::vector<double>& weights_;
    std::vector<Image> along_x_;
};

// Smooths several quantities that are stored one behind the other, a row of all of them after another.
inline void smooth_all(const Grid& grid, const std::vector<Place>& place,
                       const std::vector<Parity>& parity, const SmoothingSettings& settings,
                       Field& f, Field& scratch) {
    if (settings.passes == 0) return;
    const std::vector<double> weights = smoothing_weights(settings);
    std::vector<RowSmoother> smooth_row;
    for (std::size_t k = 0; k < place.size(); ++k)
        smooth_row.emplace_back(grid, place[k], parity[k], weights);
    scratch.resize(f.size());
    for_each_band(grid, [&](long first, long end) {
        RowSmoother::Room room(grid, weights.size());
        for (long j = first; j < end; ++j)
            for (long k = 0; k < long(place.size()); ++k)
                smooth_row[std::size_t(k)](j, f.data() + k * grid.size(), room,
                                           scratch.data() + k * grid.size());
    });
    f.swap(scratch);
    for (std::size_t k = 0; k < place.size(); ++k)
        common::fill_ghosts(grid, place[k], parity[k], f.data() + long(k) * grid.size());
}

}  // namespace detail

/// Smooths one quantity: `passes` times (1/4, 1/2, 1/4) in x and z, then once
/// (-a, 1 + 2a, -a) with a = passes/4.
/// In Fourier space one direction is multiplied with
///     cos^2(k dx/2)^passes [1 + 4 a sin^2(k dx/2)] = 1 - O((k dx)^4):
/// waves are kept, grid noise is removed.
/// in/out: f, ghosts filled before and after; scratch, with which it changes places.
/// exact:  a constant is unchanged; smoothing commutes with the differences of the mesh, so Gauss's
///         law and continuity stay exact; it is its own transpose.
/// note:   all passes are taken at once: their weights are those of one sum over neighbors.
inline void smooth(const Grid& grid, Place place, Parity parity, const SmoothingSettings& settings,
                   Field& f, Field& scratch) {
    detail::smooth_all(grid, {place}, {parity}, settings, f, scratch);
}

/// Smooths the three components of a vector.
inline void smooth(const Grid& grid, const VectorKind& kind, const SmoothingSettings& settings,
                   VectorField& f, Field& scratch) {
    detail::smooth_all(grid, {kind.place.begin(), kind.place.end()},
                       {kind.parity.begin(), kind.parity.end()}, settings, f.all, scratch);
}

/// What smooth() does to a wave with k dx = angle in one direction.
inline double smoothing_factor(const SmoothingSettings& settings, double angle) {
    if (settings.passes == 0) return 1;
    const double half = std::cos(0.5 * angle) * std::cos(0.5 * angle);
    const double passes = double(settings.passes);
    return std::pow(half, passes) * (settings.compensate ? 1 + passes * (1 - half) : 1.0);
}

}  // namespace implicit_moment
