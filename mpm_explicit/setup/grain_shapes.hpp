// Outlines of grains, disks and polygons: their measures, how deep two of them overlap, and the
// particles that fill them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "common/run/parameters.hpp"
#include "mpm_explicit/mesh.hpp"
#include "mpm_explicit/setup/polygons.hpp"

namespace mpm {

enum class OutlineKind { disk, polygon };

/// The outline of a grain at the start.
struct Outline {
    OutlineKind kind = OutlineKind::disk;
    double x = 0, y = 0;         // center of the disk, or centroid of the polygon [length]
    double radius = 0;           // of the disk, or of the circle about the centroid that holds all
    std::vector<Point> corners;  // of the polygon, counterclockwise; it may be concave
};

namespace detail {

inline bool usable(double value) { return std::isfinite(value) && std::fabs(value) < 1e100; }

inline void require(bool condition, const std::string& sentence) {
    if (!condition) throw common::InputError(sentence);
}

inline void require_length(double value, const std::string& name) {
    require(usable(value) && value > 1e-100,
            name + " = " + common::number_text(value) + " must be a length above 0: give one");
}

}  // namespace detail

/// A polygon from its corners in order, either way around; it may be concave.
/// out:    counterclockwise, beginning with the same corner
/// errors: InputError for what is no simple polygon, with the corner, counted from 1
inline Outline polygon(std::vector<Point> corners) {
    using detail::require;
    const std::size_t n = corners.size(), most = 1000;
    const auto number = [](std::size_t k) { return std::to_string(k + 1); };
    const std::string count = std::to_string(n);
    require(
        n >= 3 && n <= most,
        "a polygon of " + count + " corners: give at least 3 and at most " + std::to_string(most));
    for (std::size_t k = 0; k < n; ++k)
        require(detail::usable(corners[k].x) && detail::usable(corners[k].y),
                "corner " + number(k) + " is not at a finite place: give two numbers below 1e100");
    const Bounds box = detail::bounds(corners);
    const double size = std::hypot(box.x_high - box.x_low, box.y_high - box.y_low),
                 tolerance = detail::resolution * size;
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t next = (k + 1) % n;
        require(detail::distance(corners[k], corners[next]) > tolerance,
                "corners " + number(k) + " and " + number(next) +
                    " of a polygon are the same point: leave one out");
    }
    require(size > 1e-100 && detail::width(corners) > tolerance,
            "the " + count + " corners of a polygon lie on a line: it has no area");
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t next = (k + 1) % n;
        for (std::size_t m = k + 2; m < n; ++m) {
            if ((m + 1) % n == k) continue;
            const std::size_t after = (m + 1) % n;
            require(!detail::sides_meet(corners[k], corners[next], corners[m], corners[after],
                                        tolerance),
                    "the side from corner " + number(k) + " to " + number(next) +
                        " of a polygon meets the side from corner " + number(m) + " to " +
                        number(after) + ": list the corners in order around the grain");
        }
    }
    auto [area, centroid] = detail::area_and_centroid(corners);
    if (area < 0) std::reverse(corners.begin() + 1, corners.end());
    Outline outline{OutlineKind::polygon, centroid.x, centroid.y, 0, std::move(corners)};
    for (const Point& p : outline.corners)
        outline.radius = std::max(outline.radius, detail::distance(p, centroid));
    return outline;
}

inline Outline disk(double x, double y, double radius) {
    detail::require_length(radius, "the radius of a disk");
    detail::require(detail::usable(x) && detail::usable(y),
                    "the center of a disk is not at a finite place: give two numbers below 1e100");
    return {OutlineKind::disk, x, y, radius, {}};
}

/// A rectangle about (x, y), turned counterclockwise by an angle in degrees.
/// exact:  without an angle its sides are at x +- width/2, y +- height/2
inline Outline box(double x, double y, double width, double height, double angle_degrees = 0) {
    detail::require_length(width, "the width of a box");
    detail::require_length(height, "the height of a box");
    const double angle = angle_degrees * std::numbers::pi / 180, cosine = std::cos(angle),
                 sine = std::sin(angle);
    std::vector<Point> corners;
    for (const auto& [a, b] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
        corners.push_back({x + a * width * cosine - b * height * sine,
                           y + a * width * sine + b * height * cosine});
    return polygon(std::move(corners));
}

/// A regular polygon in the circle about (x, y); its first corner stands at an angle in degrees,
/// counterclockwise from the direction of x.
inline Outline regular_polygon(double x, double y, double circumradius, long sides,
                               double angle_degrees = 0) {
    detail::require_length(circumradius, "the radius of a regular polygon");
    const std::string count = std::to_string(sides);
    detail::require(sides >= 3 && sides <= 1000,
                    "a regular polygon of " + count + " sides: give 3 to 1000");
    std::vector<Point> corners;
    for (long k = 0; k < sides; ++k) {
        const double turns = static_cast<double>(k) / static_cast<double>(sides),
                     angle = (angle_degrees / 180 + 2 * turns) * std::numbers::pi;
        corners.push_back({x + circumradius * std::cos(angle), y + circumradius * std::sin(angle)});
    }
    return polygon(std::move(corners));
}

/// Whether a point is inside. A point on the outline belongs to one of two neighbors that share it.
inline bool contains(const Outline& outline, double x, double y) {
    if (outline.kind == OutlineKind::disk) {
        const double dx = x - outline.x, dy = y - outline.y;
        return dx * dx + dy * dy < outline.radius * outline.radius;
    }
    return detail::contains(outline.corners, {x, y});
}

inline Bounds bounds(const Outline& outline) {
    if (outline.kind == OutlineKind::polygon) return detail::bounds(outline.corners);
    return {outline.x - outline.radius, outline.x + outline.radius, outline.y - outline.radius,
            outline.y + outline.radius};
}

inline double area(const Outline& outline) {
    return outline.kind == OutlineKind::disk ? std::numbers::pi * outline.radius * outline.radius
                                             : detail::area_and_centroid(outline.corners).first;
}

inline Point centroid(const Outline& outline) { return {outline.x, outline.y}; }

/// The least width: the narrowest gap between two parallel lines that the grain fits through.
inline double thinnest(const Outline& outline) {
    return outline.kind == OutlineKind::disk ? 2 * outline.radius : detail::width(outline.corners);
}

inline Outline moved(Outline outline, double dx, double dy) {
    outline.x += dx, outline.y += dy;
    for (Point& p : outline.corners) p.x += dx, p.y += dy;
    return outline;
}

/// How deep two outlines overlap: how far one would have to move to leave the other.
/// exact:  for disks, for convex polygons, for a disk and a convex polygon. For concave polygons 0
///         exactly when they do not overlap, and otherwise not more than the distance they would
///         have to move: the deepest overlap of their convex pieces.
/// note:   0 for outlines that only touch, within 1e-9 of the size of the smaller one.
inline double overlap_depth(const Outline& a, const Outline& b) {
    const double reach = a.radius + b.radius - detail::distance({a.x, a.y}, {b.x, b.y}),
                 touching = detail::resolution * std::min(a.radius, b.radius);
    if (reach <= touching) return 0;
    double depth = 0;
    if (a.kind == OutlineKind::disk && b.kind == OutlineKind::disk) {
        depth = reach;
    } else if (a.kind != b.kind) {
        const Outline& round = a.kind == OutlineKind::disk ? a : b;
        const std::vector<Point>& corners = a.kind == OutlineKind::disk ? b.corners : a.corners;
        const Point center{round.x, round.y};
        const double away = detail::distance_to_outline(corners, center);
        depth = round.radius + (detail::contains(corners, center) ? away : -away);
    } else {
        const auto others = detail::convex_pieces(b.corners);
        for (const auto& piece : detail::convex_pieces(a.corners))
            for (const auto& other : others)
                depth = std::max(depth, detail::convex_overlap(piece, other));
    }
    return depth > touching ? depth : 0;
}

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
    const double n = static_cast<double>(per_side), spacing = mesh.h / n;
    const Bounds box = bounds(outline);
    const auto require_room = [&](double low, double high, double room_low, double room_high,
                                  const std::string& axis) {
        detail::require(low >= room_low - 1e-6 * spacing && high <= room_high + 1e-6 * spacing,
                        "an outline from " + axis + " = " + common::format(low) + " to " +
                            common::format(high) +
                            " does not fit on the mesh, which has room from " +
                            common::format(room_low) + " to " + common::format(room_high) +
                            ": move the grain or widen the mesh");
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
                    particles.push_back({mesh.x_low + (static_cast<double>(k) + 0.5) * spacing,
                                         mesh.y_low + (static_cast<double>(q) + 0.5) * spacing});
                }
    return particles;
}

}  // namespace mpm
