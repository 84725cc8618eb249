// Polygons in the plane: turns, hulls, widths, and the convex pieces of a concave one.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace mpm {

/// A place in the plane [length].
struct Point {
    double x = 0, y = 0;
};

/// An upright rectangle [length].
struct Bounds {
    double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
};

/// Lengths that differ by less than this part of an outline's size are taken as equal.
constexpr double resolution = 1e-9;

/// Twice the area of the triangle a, b, c; positive when it runs counterclockwise.
inline double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The distance between two points.
inline double distance(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Visits the sides of a polygon: visit(from, to).
template <class Visit>
void for_each_side(const std::vector<Point>& corners, const Visit& visit) {
    for (std::size_t k = 0; k < corners.size(); ++k)
        visit(corners[k], corners[k + 1 < corners.size() ? k + 1 : 0]);
}

/// Area and centroid; measured from the first corner, so that far away is as good as near.
inline std::pair<double, Point> area_and_centroid(const std::vector<Point>& corners) {
    double area = 0, x = 0, y = 0;
    const Point& o = corners[0];
    for_each_side(corners, [&](const Point& a, const Point& b) {
        const double part = 0.5 * turn(o, a, b);
        area += part, x += part * (a.x + b.x - 2 * o.x) / 3, y += part * (a.y + b.y - 2 * o.y) / 3;
    });
    return {area, {o.x + x / area, o.y + y / area}};
}

/// The smallest upright rectangle around some points.
inline Bounds bounds(const std::vector<Point>& corners) {
    Bounds box{corners[0].x, corners[0].x, corners[0].y, corners[0].y};
    for (const Point& p : corners) {
        box.x_low = std::min(box.x_low, p.x), box.x_high = std::max(box.x_high, p.x);
        box.y_low = std::min(box.y_low, p.y), box.y_high = std::max(box.y_high, p.y);
    }
    return box;
}

/// The corners of the convex hull, counterclockwise (monotone chains).
inline std::vector<Point> hull(std::vector<Point> points) {
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
        return a.x < b.x || (a.x == b.x && a.y < b.y);
    });
    std::vector<Point> chain;
    for (int side = 0; side < 2; ++side) {
        const std::size_t start = chain.size() + 1;
        for (const Point& p : points) {
            while (chain.size() > start &&
                   turn(chain[chain.size() - 2], chain[chain.size() - 1], p) <= 0)
                chain.pop_back();
            chain.push_back(p);
        }
        chain.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return chain;
}

/// Least distance between two parallel lines that hold all points; one of them lies on a side of
// the hull.
inline double width(const std::vector<Point>& points) {
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Point> around = hull(points);
    for_each_side(around, [&](const Point& a, const Point& b) {
        double farthest = 0;
        for (const Point& p : around) farthest = std::max(farthest, turn(a, b, p) / distance(a, b));
        least = std::min(least, farthest);
    });
    return around.size() < 3 ? 0 : least;
}

/// The sharpest corner that sticks out of a counterclockwise polygon, in degrees.
inline double sharpest_corner(const std::vector<Point>& corners) {
    const std::size_t n = corners.size();
    double sharpest = 180;
    for (std::size_t k = 0; k < n; ++k) {
        const Point &before = corners[(k + n - 1) % n], &at = corners[k],
                    &after = corners[(k + 1) % n];
        const double ax = at.x - before.x, ay = at.y - before.y, bx = after.x - at.x,
                     by = after.y - at.y, turned = std::atan2(ax * by - ay * bx, ax * bx + ay * by);
        sharpest = std::min(sharpest, 180 * (1 - turned / std::numbers::pi));
    }
    return sharpest;
}

/// The distance of a point from the line between a and b.
inline double distance_to_side(const Point& a, const Point& b, const Point& p) {
    const double dx = b.x - a.x, dy = b.y - a.y,
                 s = ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy);
    const double t = std::clamp(s, 0.0, 1.0);
    return distance({a.x + t * dx, a.y + t * dy}, p);
}

/// Whether two sides come closer than the tolerance.
inline bool sides_meet(const Point& a, const Point& b, const Point& c, const Point& d,
                       double tolerance) {
    const bool cross =
        (turn(a, b, c) > 0) != (turn(a, b, d) > 0) && (turn(c, d, a) > 0) != (turn(c, d, b) > 0);
    return cross || distance_to_side(a, b, c) <= tolerance ||
           distance_to_side(a, b, d) <= tolerance || distance_to_side(c, d, a) <= tolerance ||
           distance_to_side(c, d, b) <= tolerance;
}

/// The distance of a point from the nearest side of a polygon.
inline double distance_to_outline(const std::vector<Point>& corners, const Point& p) {
    double least = std::numeric_limits<double>::infinity();
    for_each_side(corners, [&](const Point& a, const Point& b) {
        least = std::min(least, distance_to_side(a, b, p));
    });
    return least;
}

/// Whether a point is inside: the sides that a ray to the right meets are odd in number.
inline bool contains(const std::vector<Point>& corners, const Point& p) {
    bool inside = false;
    for_each_side(corners, [&](const Point& a, const Point& b) {
        const bool up = b.y > a.y;
        if ((a.y > p.y) != (b.y > p.y) && turn(up ? a : b, up ? b : a, p) > 0) inside = !inside;
    });
    return inside;
}

/// The polygon itself when it is convex, otherwise triangles that make it up. A triangle is cut off
// at a corner that turns left and has no other corner in its triangle; there always is one.
inline std::vector<std::vector<Point>> convex_pieces(std::vector<Point> corners) {
    const auto turn_at = [&](std::size_t k) {
        const std::size_t n = corners.size();
        return turn(corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
    };
    const auto is_ear = [&](std::size_t k) {
        const std::size_t n = corners.size(), before = (k + n - 1) % n, after = (k + 1) % n;
        if (!(turn_at(k) > 0)) return false;
        for (std::size_t m = 0; m < n; ++m) {
            const Point &a = corners[before], &b = corners[k], &c = corners[after], &p = corners[m];
            if (m != before && m != k && m != after && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                turn(c, a, p) >= 0)
                return false;
        }
        return true;
    };
    bool convex = true;
    for (std::size_t k = 0; k < corners.size(); ++k) convex = convex && turn_at(k) >= 0;
    if (convex) return {corners};
    std::vector<std::vector<Point>> pieces;
    while (corners.size() > 3) {
        const std::size_t n = corners.size();
        std::size_t ear = 0, flattest = 0;
        while (ear < n && !is_ear(ear)) ++ear;
        for (std::size_t k = 0; k < n; ++k)
            if (std::fabs(turn_at(k)) < std::fabs(turn_at(flattest))) flattest = k;
        // Round-off can hide every ear of a sliver; what is left out then has no area.
        const std::size_t cut = ear < n ? ear : flattest;
        if (ear < n)
            pieces.push_back({corners[(cut + n - 1) % n], corners[cut], corners[(cut + 1) % n]});
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(cut));
    }
    pieces.push_back(corners);
    return pieces;
}

/// How far one of two convex polygons must move to leave the other; negative when they are apart.
/// The shortest way out is across a side of one of them.
inline double convex_overlap(const std::vector<Point>& first, const std::vector<Point>& second) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [own, other] : {std::pair{&first, &second}, std::pair{&second, &first}}) {
        for_each_side(*own, [&, &points = *other](const Point& a, const Point& b) {
            double deepest = -std::numeric_limits<double>::infinity();
            for (const Point& p : points) deepest = std::max(deepest, turn(a, b, p));
            least = std::min(least, deepest / distance(a, b));
        });
    }
    return least;
}

}  // namespace mpm
