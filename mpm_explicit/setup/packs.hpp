// Packs of grains: rows of disks, random disks, regular polygons in their place, and the deepest
// overlap in a pack.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "mpm_explicit/setup/grain_shapes.hpp"
#include "mpm_explicit/setup/random_disks.hpp"

namespace mpm {

struct PackedGrain {
    std::string name;
    Outline outline;
};

/// Equal disks in rows. The second, fourth, ... row is shifted, and may have one disk less.
struct Rows {
    double x = 0, y = 0;  // center of the first disk of the lowest row [length]
    long columns = 1, rows = 1;
    double radius = 0;
    double gap = 0;        // between neighbors, where no spacing is given
    double spacing_x = 0;  // between the centers of a row; 0: the diameter and the gap
    double spacing_y = 0;  // between rows; 0: what leaves the gap between the disks of two rows
    double shift = 0;      // of every other row along x
    bool one_less = false;
};

/// Two grains that overlap; without names and of depth 0 when none do.
struct Overlap {
    std::string first, second;
    double depth = 0;
};

/// Grains named g0001, g0002, ...; the names sort as they count.
inline std::vector<PackedGrain> named(const std::vector<Outline>& outlines) {
    const std::size_t digits = std::max<std::size_t>(4, std::to_string(outlines.size()).size());
    std::vector<PackedGrain> grains;
    for (const Outline& outline : outlines) {
        const std::string number = std::to_string(grains.size() + 1);
        std::string name = "g";
        name.append(digits - number.size(), '0').append(number);
        grains.push_back({name, outline});
    }
    return grains;
}

/// Disks in rows, from the lowest up and each from the left.
///     hexagonal: shift = spacing_x / 2
/// out:    names g0001, g0002, ... in that order
inline std::vector<PackedGrain> hexagonal_rows(const Rows& rows) {
    using detail::require, common::format;
    detail::require_length(rows.radius, "the radius of the disks in rows");
    require(rows.columns >= (rows.one_less && rows.rows > 1 ? 2 : 1) && rows.rows >= 1 &&
                static_cast<double>(rows.columns) * static_cast<double>(rows.rows) <= 1e6,
            std::to_string(rows.rows) + " rows of " + std::to_string(rows.columns) +
                " disks: give at least one disk in each row, and at most 1e6");
    for (const double length : {rows.gap, rows.spacing_x, rows.spacing_y})
        require(detail::usable(length) && length >= 0,
                "a gap or spacing of rows is " + format(length) + ": give a length, or 0");
    require(detail::usable(rows.shift), "the shift of rows is no number: give a length, or 0");
    const double apart = 2 * rows.radius + rows.gap,
                 spacing_x = rows.spacing_x > 0 ? rows.spacing_x : apart,
                 beside = std::fabs(std::remainder(rows.shift, spacing_x)),
                 beside_row = std::sqrt(std::max(0.0, (apart - beside) * (apart + beside))),
                 least_y = rows.rows > 2 ? std::max(beside_row, apart / 2) : beside_row,
                 spacing_y = rows.spacing_y > 0 ? rows.spacing_y : least_y;
    require(spacing_y > 0 || rows.rows == 1,
            "two rows shifted by " + format(rows.shift) + " fall into one: give their spacing");
    std::vector<Outline> outlines;
    for (long j = 0; j < rows.rows; ++j) {
        const bool odd = j % 2 == 1;
        for (long i = 0; i < rows.columns - (odd && rows.one_less ? 1 : 0); ++i)
            outlines.push_back(
                disk(rows.x + static_cast<double>(i) * spacing_x + (odd ? rows.shift : 0),
                     rows.y + static_cast<double>(j) * spacing_y, rows.radius));
    }
    return named(outlines);
}

/// A random pack of disks, see RandomDisks.
/// out:    names g0001, g0002, ... in the order in which they were placed
inline std::vector<PackedGrain> random_disks(const RandomDisks& pack) {
    return named(place_random_disks(pack));
}

/// Regular polygons in the circles of a pack of disks, each turned by a random angle.
/// exact:  they overlap no more than the disks; what is no disk stays as it is
inline std::vector<PackedGrain> regular_polygons(std::vector<PackedGrain> disks, long sides,
                                                 std::uint64_t seed) {
    constexpr std::uint32_t pack_angles = 0x9a13;
    for (std::size_t k = 0; k < disks.size(); ++k) {
        Outline& outline = disks[k].outline;
        if (outline.kind != OutlineKind::disk) continue;
        const double angle = 360 * common::uniform(seed, pack_angles, k, 0);
        outline = regular_polygon(outline.x, outline.y, outline.radius, sides, angle);
    }
    return disks;
}

/// The two grains of a pack that overlap deepest, of several such the first.
/// in:     period in x, or 0; tolerance, the depth that is not counted
/// exact:  as overlap_depth(); a grain longer than the period overlaps itself
/// note:   the cost is proportional to the grains: they are sorted into square cells as large as
///         the mean grain, and meet in the cells that both reach.
inline Overlap overlaps(const std::vector<PackedGrain>& grains, double period, double tolerance) {
    struct Placed {
        std::size_t grain;
        double shift;
        Bounds box;
        bool repeated;
    };
    std::vector<Placed> placed;
    Bounds all{1e300, -1e300, 1e300, -1e300};
    double mean = 0;
    const auto add = [&](std::size_t k, double shift, Bounds box, bool repeated) {
        box.x_low += shift, box.x_high += shift;
        placed.push_back({k, shift, box, repeated});
        all = {std::min(all.x_low, box.x_low), std::max(all.x_high, box.x_high),
               std::min(all.y_low, box.y_low), std::max(all.y_high, box.y_high)};
    };
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const Bounds box = bounds(grains[k].outline);
        // Begin all grains in one period, and repeat in the next those that another may reach.
        const double shift = period > 0 ? -period * std::floor(box.x_low / period) : 0;
        add(k, shift, box, false);
        if (period > 0) add(k, shift + period, box, true);
        mean += std::max(box.x_high - box.x_low, box.y_high - box.y_low);
    }
    Overlap worst;
    if (grains.empty()) return worst;
    mean /= static_cast<double>(grains.size());
    const double width = all.x_high - all.x_low, height = all.y_high - all.y_low,
                 n = static_cast<double>(placed.size()),
                 side = std::max({mean, std::sqrt(width * height / (4 * n)), width / (4 * n),
                                  height / (4 * n)});
    const auto column = [&](double x) { return static_cast<long>((x - all.x_low) / side); };
    const auto row = [&](double y) { return static_cast<long>((y - all.y_low) / side); };
    const long columns = column(all.x_high) + 1, rows = row(all.y_high) + 1;
    std::vector<std::vector<std::size_t>> cells(static_cast<std::size_t>(columns * rows));
    std::size_t worst_a = 0, worst_b = 0;
    const auto compare = [&](const Placed& a, const Placed& b) {
        if (a.repeated && b.repeated) return;
        const Outline &first = grains[a.grain].outline, &second = grains[b.grain].outline;
        const double depth = overlap_depth(moved(first, a.shift, 0), moved(second, b.shift, 0));
        const std::size_t low = std::min(a.grain, b.grain), high = std::max(a.grain, b.grain);
        const bool earlier = low < worst_a || (low == worst_a && high < worst_b);
        if (depth <= tolerance || depth < worst.depth || (depth == worst.depth && !earlier)) return;
        worst = {grains[low].name, grains[high].name, depth}, worst_a = low, worst_b = high;
    };
    for (std::size_t k = 0; k < placed.size(); ++k) {
        const Bounds& box = placed[k].box;
        for (long j = row(box.y_low); j <= row(box.y_high); ++j)
            for (long i = column(box.x_low); i <= column(box.x_high); ++i) {
                auto& cell = cells[static_cast<std::size_t>(j * columns + i)];
                for (const std::size_t other : cell) {
                    const Bounds& b = placed[other].box;
                    const double x = std::max(box.x_low, b.x_low), y = std::max(box.y_low, b.y_low);
                    // Of the cells that both reach, they meet in the first.
                    if (x < std::min(box.x_high, b.x_high) && y < std::min(box.y_high, b.y_high) &&
                        column(x) == i && row(y) == j)
                        compare(placed[other], placed[k]);
                }
                cell.push_back(k);
            }
    }
    return worst;
}

}  // namespace mpm
