// The particles that fill the outline of a grain.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "mpm_explicit/mesh.hpp"
#include "mpm_explicit/setup/grain_shapes.hpp"

namespace mpm {

namespace detail {

// A place on the lattice of particles in whole numbers, so that mirror images are treated alike.
struct LatticePoint {
    std::int64_t x, y;
};

// An outline in units of 2^-bits of the spacing of the lattice.
struct LatticeOutline {
    LatticePoint center;
    std::int64_t radius;
    std::vector<LatticePoint> corners;

    bool strictly_contains(const LatticePoint& p) const {
        if (corners.empty()) {
            const std::int64_t dx = p.x - center.x, dy = p.y - center.y;
            return std::abs(dx) < radius && std::abs(dy) < radius &&
                   dx * dx + dy * dy < radius * radius;
        }
        bool inside = false;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const LatticePoint &a = corners[k], &b = corners[(k + 1) % corners.size()];
            if ((a.y < p.y && b.y < p.y) || (a.y > p.y && b.y > p.y)) continue;
            const std::int64_t area = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
            if (area == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x)) return false;
            if ((a.y > p.y) != (b.y > p.y) && (area > 0) == (b.y > a.y)) inside = !inside;
        }
        return inside;
    }
};

}  // namespace detail

/// The particles of a grain: the points of a lattice that are inside.
///     x = x_low + (k + 1/2) h / per_side,  y likewise
/// in:     per_side, particles per cell and direction
/// out:    positions, cell by cell, row of cells by row of cells; none when the grain is too thin
/// exact:  each particle stands for the area (h / per_side)^2; a box along mesh lines gets its
///         area. Outlines that are mirror images about a mesh line get mirror images. Outlines that
///         do not overlap share no particle: points on the outline are left out.
/// errors: InputError for an outline that reaches beyond the mesh; in a periodic direction the
///         particles stand inside the mesh instead, and the outline must not be longer than it
/// note:   the outline is rounded to a millionth of the spacing, so that places that are equal on
///         paper are equal here.
inline std::vector<Point> fill(const Outline& outline, const Mesh& mesh, long per_side) {
    const double n = double(per_side), spacing = mesh.h / n;
    const Bounds box = bounds(outline);
    const auto require_room = [&](double low, double high, double room_low, double room_high,
                                  const std::string& axis) {
        require(low >= room_low - 1e-6 * spacing && high <= room_high + 1e-6 * spacing,
                "an outline from " + axis + " = " + format(low) + " to " + format(high) +
                    " does not fit on the mesh, which has room from " + format(room_low) + " to " +
                    format(room_high) + ": move the grain or widen the mesh");
    };
    const double wrapped = mesh.periodic_x ? mesh.length_x() : 0;
    require_room(box.x_low, box.x_high, mesh.x_low - wrapped, mesh.x_high() + wrapped, "x");
    if (mesh.periodic_x) require_room(box.x_low, box.x_high, box.x_low, box.x_low + wrapped, "x");
    require_room(box.y_low, box.y_high, mesh.y_low, mesh.y_high(), "y");

    // As fine as products of whole numbers of 64 bits allow, at most 2^-20.
    int bits = 20;
    const double size = std::max(box.x_high - box.x_low, box.y_high - box.y_low) / spacing;
    while (bits > 1 && std::ldexp(size + 4 * n, bits) > 0x1p30) --bits;
    const auto fine = [&](double length) -> std::int64_t {
        return std::llround(std::ldexp(length / spacing, bits));
    };
    const auto fine_point = [&](double x, double y) -> detail::LatticePoint {
        return {fine(x - mesh.x_low), fine(y - mesh.y_low)};
    };
    detail::LatticeOutline lattice{fine_point(outline.x, outline.y), fine(outline.radius), {}};
    for (const Point& p : outline.corners) lattice.corners.push_back(fine_point(p.x, p.y));

    std::vector<Point> particles;
    const auto cell = [&](double length) { return std::lround(std::floor(length / mesh.h)); };
    const long i_low = cell(box.x_low - mesh.x_low), i_high = cell(box.x_high - mesh.x_low),
               j_low = cell(box.y_low - mesh.y_low), j_high = cell(box.y_high - mesh.y_low);
    const std::int64_t half = std::int64_t{1} << (bits - 1);
    const auto middle = [&](long k) { return (2 * std::int64_t{k} + 1) * half; };
    for (long j = j_low; j <= j_high; ++j)
        for (long i = i_low; i <= i_high; ++i)
            for (long q = j * per_side; q < (j + 1) * per_side; ++q)
                for (long p = i * per_side; p < (i + 1) * per_side; ++p) {
                    if (!lattice.strictly_contains({middle(p), middle(q)})) continue;
                    const long all = mesh.cells_x * per_side,
                               k = mesh.periodic_x ? (p % all + all) % all : p;
                    particles.push_back({mesh.x_low + (double(k) + 0.5) * spacing,
                                         mesh.y_low + (double(q) + 0.5) * spacing});
                }
    return particles;
}

}  // namespace mpm
