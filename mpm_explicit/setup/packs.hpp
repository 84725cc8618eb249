// Packs of grains: rows of disks, random disks, regular polygons in their place, and the deepest
// overlap in a pack.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/random.hpp"
#include "mpm_explicit/setup/grain_shapes.hpp"
#include "mpm_explicit/setup/random_disks.hpp"

namespace mpm {

/// A grain of a pack.
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
    require_length(rows.radius, "the radius of the disks in rows");
    require(rows.columns >= (rows.one_less && rows.rows > 1 ? 2 : 1) && rows.rows >= 1 &&
                double(rows.columns) * double(rows.rows) <= 1e6,
            std::to_string(rows.rows) + " rows of " + std::to_string(rows.columns) +
                " disks: give at least one disk in each row, and at most 1e6");
    for (const double length : {rows.gap, rows.spacing_x, rows.spacing_y})
        require(usable(length) && length >= 0,
                "a gap or spacing of rows is " + format(length) + ": give a length, or 0");
    require(usable(rows.shift), "the shift of rows is no number: give a length, or 0");
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
            outlines.push_back(disk(rows.x + double(i) * spacing_x + (odd ? rows.shift : 0),
                                    rows.y + double(j) * spacing_y, rows.radius));
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
/// note:   grains are sorted by their left ends, and each is compared with those that begin before
///         it ends: in a square pack of n grains, about n^3/2 pairs of boxes
inline Overlap overlaps(const std::vector<PackedGrain>& grains, double period, double tolerance) {
    struct Placed {
        std::size_t grain;
        double shift;
        Bounds box;
        bool repeated;
    };
    std::vector<Placed> placed;
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const Bounds box = bounds(grains[k].outline);
        // Begin all grains in one period, and repeat in the next those that another may reach.
        double shift = period > 0 ? -period * std::floor(box.x_low / period) : 0;
        for (const bool repeated : {false, true}) {
            if (repeated && !(period > 0)) break;
            if (repeated) shift += period;
            placed.push_back({k,
                              shift,
                              {box.x_low + shift, box.x_high + shift, box.y_low, box.y_high},
                              repeated});
        }
    }
    std::sort(placed.begin(), placed.end(),
              [](const Placed& a, const Placed& b) { return a.box.x_low < b.box.x_low; });
    Overlap worst;
    std::pair<std::size_t, std::size_t> worst_pair;
    for (auto a = placed.begin(); a != placed.end(); ++a)
        for (auto b = a + 1; b != placed.end() && b->box.x_low < a->box.x_high; ++b) {
            if ((a->repeated && b->repeated) || a->box.y_low >= b->box.y_high ||
                b->box.y_low >= a->box.y_high)
                continue;
            const double depth = overlap_depth(moved(grains[a->grain].outline, a->shift, 0),
                                               moved(grains[b->grain].outline, b->shift, 0));
            const std::pair<std::size_t, std::size_t> pair = std::minmax(a->grain, b->grain);
            if (depth <= tolerance || depth < worst.depth ||
                (depth == worst.depth && pair >= worst_pair))
                continue;
            worst = {grains[pair.first].name, grains[pair.second].name, depth}, worst_pair = pair;
        }
    return worst;
}

}  // namespace mpm
