// What an outline cuts out of a square, its area and centroid: the volume and the place of a particle
// at the surface of a grain.
//
//        __________           A piece is bounded by sides of the square and by the outline. Area and
//       |    ___---|          first moments are sums over its boundary, of the triangles and sectors
//       |___/      |          that each stretch of it makes with one fixed point.
//       |   piece  |
//       |__________|
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mpm_explicit/setup/grain_shapes.hpp"

namespace mpm {

/// A part of a grain: its area, first moments, area times centroid, and of polygons the second ones along x
/// and y.
struct Piece {
    double area = 0, x = 0, y = 0, xx = 0, yy = 0;

    void operator+=(const Piece& other) {
        area += other.area, x += other.x, y += other.y, xx += other.xx, yy += other.yy;
    }
    Piece times(double part) const {
        return {part * area, part * x, part * y, part * xx, part * yy};
    }
    Piece moved(double dx, double dy) const {
        return {area, x + area * dx, y + area * dy, xx + (2 * x + area * dx) * dx,
                yy + (2 * y + area * dy) * dy};
    }
    Point centroid() const { return {x / area, y / area}; }
    /// Half the sides of the rectangle, along x and y, that spreads as far about its centroid.
    Point half_sides() const {
        const Point c = centroid();
        return {std::sqrt(std::max(0.0, 3 * (xx / area - c.x * c.x))),
                std::sqrt(std::max(0.0, 3 * (yy / area - c.y * c.y)))};
    }
};

namespace detail {

// The triangle of the origin, a and b.
inline Piece triangle(const Point& a, const Point& b) {
    const double area = 0.5 * (a.x * b.y - a.y * b.x);
    return {area, area * (a.x + b.x) / 3, area * (a.y + b.y) / 3,
            area * (a.x * a.x + a.x * b.x + b.x * b.x) / 6,
            area * (a.y * a.y + a.y * b.y + b.y * b.y) / 6};
}

// The sector of a disk about the origin between the directions of a and b.
inline Piece sector(const Point& a, const Point& b, double radius) {
    const double per_a = 1 / std::hypot(a.x, a.y), per_b = 1 / std::hypot(b.x, b.y),
                 angle = std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y),
                 third = radius * radius * radius / 3;
    return {0.5 * radius * radius * angle, third * (b.y * per_b - a.y * per_a),
            third * (a.x * per_a - b.x * per_b)};
}

// The part of a disk about the origin in the triangle of the origin, a and b: a triangle where the
// side is in the disk, and sectors before and after.
inline Piece in_disk(const Point& a, const Point& b, double radius) {
    const double dx = b.x - a.x, dy = b.y - a.y, size = dx * dx + dy * dy,
                 middle = -(a.x * dx + a.y * dy) / size,
                 half = middle * middle - (a.x * a.x + a.y * a.y - radius * radius) / size;
    if (!(half > 0)) return sector(a, b, radius);
    const double enters = std::clamp(middle - std::sqrt(half), 0.0, 1.0),
                 leaves = std::clamp(middle + std::sqrt(half), 0.0, 1.0);
    if (!(leaves > enters)) return sector(a, b, radius);
    const auto at = [&](double s) { return Point{a.x + s * dx, a.y + s * dy}; };
    Piece piece = triangle(at(enters), at(leaves));
    if (enters > 0) piece += sector(a, at(enters), radius);
    if (leaves < 1) piece += sector(at(leaves), b, radius);
    return piece;
}

// The part of a polygon on one side of a line: where sign (coordinate - at) > 0.
inline std::vector<Point> cut(const std::vector<Point>& corners, double Point::*coordinate,
                              double at, double sign) {
    std::vector<Point> left;
    for_each_side(corners, [&](const Point& a, const Point& b) {
        const double before = sign * (a.*coordinate - at), after = sign * (b.*coordinate - at);
        if (before >= 0) left.push_back(a);
        if ((before > 0 && after < 0) || (before < 0 && after > 0)) {
            const double s = before / (before - after);
            Point p{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
            p.*coordinate = at;
            left.push_back(p);
        }
    });
    return left;
}

}  // namespace detail

/// The part of a disk in the square of side 1 with the lower left corner (x, y).
/// exact:  area and centroid, to round-off
inline Piece piece_of_disk(const Point& center, double radius, double x, double y) {
    const double u = x - center.x, v = y - center.y;
    const Point corners[4]{{u, v}, {u + 1, v}, {u + 1, v + 1}, {u, v + 1}};
    Piece piece;
    for (int k = 0; k < 4; ++k) piece += detail::in_disk(corners[k], corners[(k + 1) % 4], radius);
    return {piece.area, piece.x + piece.area * center.x, piece.y + piece.area * center.y};
}

/// The part of a polygon between x and x + 1.
/// in:     corners of what is left of it between y and y + 1
/// exact:  area and moments, to round-off, of a concave one as well: where it falls apart, the
///         stretches that join its parts are passed twice, there and back
inline Piece piece_of_polygon(const std::vector<Point>& corners, double x, double y) {
    using namespace detail;
    Piece piece;
    for_each_side(cut(cut(corners, &Point::x, x, 1), &Point::x, x + 1, -1),
                  [&](const Point& a, const Point& b) {
                      piece += triangle({a.x - x, a.y - y}, {b.x - x, b.y - y});
                  });
    return piece.moved(x, y);
}

/// A part of an outline within one square: its area vector, its middle, and the side it is on.
struct OutlinePart {
    double area_x = 0, area_y = 0, x = 0, y = 0;
    int side = 0;
};

/// A number for every half of every side of a polygon, 0 or 1, which changes at each sharp corner. Around a polygon
/// with an odd number of these it has to change once more: in the middle of the last side.
/// note:   a corner is sharp that turns by more than ten degrees; the mean of two sides that turn by less is
///         at most a thirtieth of a cell off
inline std::vector<std::array<int, 2>> number_sides(const std::vector<Point>& corners) {
    const double sharp = std::cos(std::numbers::pi / 18);
    const std::size_t n = corners.size();
    const auto is_sharp = [&](std::size_t k) {
        const Point &before = corners[(k + n - 1) % n], &at = corners[k],
                    &after = corners[(k + 1) % n];
        const double ax = at.x - before.x, ay = at.y - before.y, bx = after.x - at.x,
                     by = after.y - at.y;
        return ax * bx + ay * by < sharp * std::hypot(ax, ay) * std::hypot(bx, by);
    };
    std::vector<std::array<int, 2>> sides(n);
    for (std::size_t k = 1; k < n; ++k) {
        const int side = sides[k - 1][0] ^ int(is_sharp(k));
        sides[k] = {side, side};
    }
    if (is_sharp(0)) sides.back()[1] = 1;
    return sides;
}

/// Visits the parts of an outline between the lines of a lattice of spacing 1: visit(i, j, part), with
/// the square on its inner side.
template <class Visit>
void for_each_part(const Outline& outline, const Visit& visit) {
    constexpr double inward = 1e-6;
    const auto tell = [&](const Point& middle, double area_x, double area_y, int side = 0) {
        const double size = std::hypot(area_x, area_y);
        if (!(size > 0)) return;
        visit(std::lround(std::floor(middle.x - inward * area_x / size)),
              std::lround(std::floor(middle.y - inward * area_y / size)),
              OutlinePart{area_x, area_y, middle.x, middle.y, side});
    };
    std::vector<double> ends;
    const auto crossings = [&](double from, double to, const auto& parameter) {
        for (double line = std::ceil(std::min(from, to)); line <= std::max(from, to); ++line)
            parameter(line);
    };
    if (outline.kind == OutlineKind::disk) {
        const double r = outline.radius, turn = 2 * std::numbers::pi;
        const auto add = [&](double angle) { ends.push_back(angle < 0 ? angle + turn : angle); };
        crossings(outline.x - r, outline.x + r, [&](double line) {
            const double angle = std::acos(std::clamp((line - outline.x) / r, -1.0, 1.0));
            add(angle), add(-angle);
        });
        crossings(outline.y - r, outline.y + r, [&](double line) {
            const double angle = std::asin(std::clamp((line - outline.y) / r, -1.0, 1.0));
            add(angle), add(std::numbers::pi - angle);
        });
        std::sort(ends.begin(), ends.end());
        for (std::size_t k = 0; k < ends.size(); ++k) {
            const double from = ends[k], to = k + 1 < ends.size() ? ends[k + 1] : ends[0] + turn,
                         middle = 0.5 * (from + to), chord = 2 * r * std::sin(0.5 * (to - from));
            const double x = std::cos(middle), y = std::sin(middle);
            tell({outline.x + r * x, outline.y + r * y}, chord * x, chord * y);
        }
        return;
    }
    const std::vector<std::array<int, 2>> sides = number_sides(outline.corners);
    std::size_t at = 0;
    for_each_side(outline.corners, [&](const Point& a, const Point& b) {
        const std::array<int, 2> side = sides[at++];
        ends = {0, 1};
        if (side[0] != side[1]) ends.push_back(0.5);
        crossings(a.x, b.x, [&](double line) {
            if (a.x != b.x) ends.push_back((line - a.x) / (b.x - a.x));
        });
        crossings(a.y, b.y, [&](double line) {
            if (a.y != b.y) ends.push_back((line - a.y) / (b.y - a.y));
        });
        std::sort(ends.begin(), ends.end());
        for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
            const double part = ends[k + 1] - ends[k], s = 0.5 * (ends[k] + ends[k + 1]);
            if (!(part > 1e-9)) continue;
            tell({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}, part * (b.y - a.y),
                 -part * (b.x - a.x), side[s > 0.5]);
        }
    });
}

}  // namespace mpm
