// Outlines of grains, disks and polygons: their measures, and how deep two of them overlap.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "common/run/parameters.hpp"
#include "mpm_explicit/setup/polygons.hpp"

namespace mpm {

using common::format;  // numbers in sentences

enum class OutlineKind { disk, polygon };

/// The outline of a grain at the start.
struct Outline {
    OutlineKind kind = OutlineKind::disk;
    double x = 0, y = 0;         // center of the disk, or centroid of the polygon [length]
    double radius = 0;           // of the disk, or of the circle about the centroid that holds all
    std::vector<Point> corners;  // of the polygon, counterclockwise; it may be concave
};

/// Whether all sides of an outline are along x or y, and it has four.
inline bool is_upright_box(const Outline& outline) {
    const std::vector<Point>& c = outline.corners;
    return c.size() == 4 && ((c[0].x == c[1].x && c[1].y == c[2].y && c[2].x == c[3].x) ||
                             (c[0].y == c[1].y && c[1].x == c[2].x && c[2].y == c[3].y));
}

/// Whether a number is finite, and its square too.
inline bool usable(double value) { return std::isfinite(value) && std::fabs(value) < 1e100; }

/// errors: InputError with the sentence, where the condition holds; require: where it does not
inline void refuse(bool condition, const std::string& sentence) {
    if (condition) throw common::InputError(sentence);
}
inline void require(bool condition, const std::string& sentence) { refuse(!condition, sentence); }

/// errors: InputError for what is no length above 0
inline void require_length(double value, const std::string& name) {
    require(usable(value) && value > 1e-100,
            name + " = " + common::number_text(value) + " must be a length above 0: give one");
}

/// A polygon from its corners in order, either way around; it may be concave.
/// out:    counterclockwise, beginning with the same corner
/// errors: InputError for what is no simple polygon, with the corner, counted from 1
inline Outline polygon(std::vector<Point> corners) {
    const std::size_t n = corners.size(), most = 1000;
    const auto number = [](std::size_t k) { return std::to_string(k + 1); };
    const std::string count = std::to_string(n);
    require(
        n >= 3 && n <= most,
        "a polygon of " + count + " corners: give at least 3 and at most " + std::to_string(most));
    for (std::size_t k = 0; k < n; ++k)
        if (!usable(corners[k].x) || !usable(corners[k].y))
            throw common::InputError("corner " + number(k) +
                                     " is not at a finite place: give two numbers below 1e100");
    const Bounds box = bounds(corners);
    const double size = std::hypot(box.x_high - box.x_low, box.y_high - box.y_low),
                 tolerance = resolution * size;
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t next = (k + 1) % n;
        if (!(distance(corners[k], corners[next]) > tolerance))
            throw common::InputError("corners " + number(k) + " and " + number(next) +
                                     " of a polygon are the same point: leave one out");
    }
    require(size > 1e-100 && width(corners) > tolerance,
            "the " + count + " corners of a polygon lie on a line: it has no area");
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t next = (k + 1) % n;
        for (std::size_t m = k + 2; m < n; ++m) {
            if ((m + 1) % n == k) continue;
            const std::size_t after = (m + 1) % n;
            if (sides_meet(corners[k], corners[next], corners[m], corners[after], tolerance))
                throw common::InputError(
                    "the side from corner " + number(k) + " to " + number(next) +
                    " of a polygon meets the side from corner " + number(m) + " to " +
                    number(after) + ": list the corners in order around the grain");
        }
    }
    auto [area, centroid] = area_and_centroid(corners);
    if (area < 0) std::reverse(corners.begin() + 1, corners.end());
    Outline outline{OutlineKind::polygon, centroid.x, centroid.y, 0, std::move(corners)};
    for (const Point& p : outline.corners)
        outline.radius = std::max(outline.radius, distance(p, centroid));
    return outline;
}

/// A disk about (x, y).
/// errors: InputError for a radius that is no length
inline Outline disk(double x, double y, double radius) {
    require_length(radius, "the radius of a disk");
    require(usable(x) && usable(y),
            "the center of a disk is not at a finite place: give two numbers below 1e100");
    return {OutlineKind::disk, x, y, radius, {}};
}

/// A rectangle about (x, y), turned counterclockwise by an angle in degrees.
/// exact:  without an angle its sides are at x +- width/2, y +- height/2
inline Outline box(double x, double y, double width, double height, double angle_degrees = 0) {
    require_length(width, "the width of a box");
    require_length(height, "the height of a box");
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
    require_length(circumradius, "the radius of a regular polygon");
    const std::string count = std::to_string(sides);
    require(sides >= 3 && sides <= 1000,
            "a regular polygon of " + count + " sides: give 3 to 1000");
    std::vector<Point> corners;
    for (long k = 0; k < sides; ++k) {
        const double turns = double(k) / double(sides),
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
    return contains(outline.corners, {x, y});
}

/// The smallest upright rectangle around an outline.
inline Bounds bounds(const Outline& outline) {
    if (outline.kind == OutlineKind::polygon) return bounds(outline.corners);
    return {outline.x - outline.radius, outline.x + outline.radius, outline.y - outline.radius,
            outline.y + outline.radius};
}

/// The area inside of an outline.
inline double area(const Outline& outline) {
    return outline.kind == OutlineKind::disk ? std::numbers::pi * outline.radius * outline.radius
                                             : area_and_centroid(outline.corners).first;
}

/// The center of mass of an even plate.
inline Point centroid(const Outline& outline) { return {outline.x, outline.y}; }

/// The least width: the narrowest gap between two parallel lines that the grain fits through.
inline double thinnest(const Outline& outline) {
    return outline.kind == OutlineKind::disk ? 2 * outline.radius : width(outline.corners);
}

/// The outline, moved by (dx, dy).
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
    const double reach = a.radius + b.radius - distance({a.x, a.y}, {b.x, b.y}),
                 touching = resolution * std::min(a.radius, b.radius);
    if (reach <= touching) return 0;
    double depth = 0;
    if (a.kind == OutlineKind::disk && b.kind == OutlineKind::disk) {
        depth = reach;
    } else if (a.kind != b.kind) {
        const Outline& round = a.kind == OutlineKind::disk ? a : b;
        const std::vector<Point>& corners = a.kind == OutlineKind::disk ? b.corners : a.corners;
        const Point center{round.x, round.y};
        const double away = distance_to_outline(corners, center);
        depth = round.radius + (contains(corners, center) ? away : -away);
    } else {
        const auto others = convex_pieces(b.corners);
        for (const auto& piece : convex_pieces(a.corners))
            for (const auto& other : others) depth = std::max(depth, convex_overlap(piece, other));
    }
    return depth > touching ? depth : 0;
}

}  // namespace mpm
