// The normal of two bodies at a node: along their outlines where these are flat, else between their gradients of
// volume.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mpm_explicit/contact/solve_contact_node.hpp"

namespace mpm {

/// What the normal of two bodies is along, from one to two: out of the fixed one where there is one, else between
/// the gradients of both.
inline std::array<double, 2> gradient_between(const ContactBody& one, const ContactBody& two) {
    return {(two.rigid ? 0 : one.gx) - (one.rigid ? 0 : two.gx),
            (two.rigid ? 0 : one.gy) - (one.rigid ? 0 : two.gy)};
}

/// The direction of an area, or of a gradient where that is no more than round-off beside it.
inline void along_area_or_gradient(const std::array<double, 2>& area,
                                   const std::array<double, 2>& gradient, double& nx, double& ny) {
    const double size_A = std::sqrt(area[0] * area[0] + area[1] * area[1]),
                 size_g = std::sqrt(gradient[0] * gradient[0] + gradient[1] * gradient[1]);
    const bool by_area = size_A > 1e-6 * size_g;
    nx = by_area ? area[0] / size_A : gradient[0] / size_g;
    ny = by_area ? area[1] / size_A : gradient[1] / size_g;
}

/// The sides of its outline that a body shows at a node: two at a corner that turns by more than ten degrees.
struct SeenSides {
    using Area = std::array<double, 2>;
    std::array<Area, 2> areas{};
    std::array<SideSums, 2> sums{};
    int count = 0;

    /// Where side k is along n.
    double place(int k, double nx, double ny) const {
        const SideSums& s = sums[k];
        return (nx * (s.xx * nx + s.xy * ny) + ny * (s.yx * nx + s.yy * ny)) /
               (s.x * nx + s.y * ny);
    }
};
inline SeenSides seen_sides(const ContactBody& body) {
    const auto& [a, b] = body.surface.sides;
    const double a_2 = a.x * a.x + a.y * a.y, b_2 = b.x * b.x + b.y * b.y,
                 cross = a.x * b.y - a.y * b.x;
    // Round-off of shape functions is no side.
    const bool both = std::min(a_2, b_2) > 1e-12 * std::max(a_2, b_2);
    if (both && cross * cross > 0.03 * a_2 * b_2) return {{{{a.x, a.y}, {b.x, b.y}}}, {a, b}, 2};
    SideSums sum = a;
    sum += b;
    return {{{{sum.x, sum.y}}}, {sum}, a_2 + b_2 > 0 ? 1 : 0};
}

/// The one side of a corner that the body's gradient is along; -1: none, or both.
inline int side_along_gradient(const ContactBody& body, const SeenSides& seen) {
    int found = -1, count = 0;
    for (int k = 0; k < seen.count; ++k) {
        const auto& [x, y] = seen.areas[k];
        const double along = x * body.gx + y * body.gy;
        if (along > 0 &&
            along * along > 0.9 * (x * x + y * y) * (body.gx * body.gx + body.gy * body.gy))
            found = k, ++count;
    }
    return count == 1 ? found : -1;
}

/// The sides of two bodies that face each other, by number; of two such pairs the one with the larger gap, where gaps
/// are told, since bodies that are apart along one normal do not touch. -1: none, or two pairs alike.
struct FacingSides {
    int of_one = -1, of_two = -1;
};
inline FacingSides facing_sides(const SeenSides& one, const SeenSides& two, bool by_gaps) {
    FacingSides found;
    double widest = 0;
    for (int i = 0; i < one.count; ++i) {
        for (int k = 0; k < two.count; ++k) {
            const SeenSides::Area &a = one.areas[i], &b = two.areas[k];
            const double against = -(a[0] * b[0] + a[1] * b[1]);
            if (!(against > 0 && against * against > 0.5 * (a[0] * a[0] + a[1] * a[1]) *
                                                         (b[0] * b[0] + b[1] * b[1])))
                continue;
            const double x = a[0] - b[0], y = a[1] - b[1], size = std::sqrt(x * x + y * y),
                         nx = x / size, ny = y / size,
                         gap = two.place(k, nx, ny) - one.place(i, nx, ny);
            const double alike = 1e-6 * (std::fabs(gap) + std::fabs(widest));
            if (found.of_one >= 0 && (!by_gaps || std::fabs(gap - widest) <= alike)) return {};
            if (found.of_one < 0 || gap > widest) found = {i, k}, widest = gap;
        }
    }
    return found;
}

/// The area of the outline that the normal of two bodies is along, from one to two; zero: their gradients have to do.
///   one is rigid:     its side; of a corner the side that faces one of the other body's corner, or that
///                     its gradient is along, else the side of the other body, else both of its own
///   both can strain:  the difference of their sides; at a corner of one the side of the other if that
///                     is straight, else as above; of two corners the sides that face each other. Two
///                     without any corner are curved, and have gradients.
/// exact:  along the normal of flat sides, whatever the shape function and wherever they are
inline SeenSides::Area area_between(const ContactBody& one, const ContactBody& two) {
    using Area = SeenSides::Area;
    const auto difference = [](const Area& a, const Area& b) {
        return Area{a[0] - b[0], a[1] - b[1]};
    };
    const bool fixed = one.rigid || two.rigid;
    if (!fixed && !one.has_corners && !two.has_corners) return {0, 0};
    const SeenSides of_one = seen_sides(one), of_two = seen_sides(two);
    if (of_one.count == 0 || of_two.count == 0) return {0, 0};
    const FacingSides facing = facing_sides(of_one, of_two, fixed);
    if (fixed || of_one.count != of_two.count) {
        const bool first = fixed ? one.rigid : of_one.count == 2;
        const SeenSides &by = first ? of_one : of_two, &other = first ? of_two : of_one;
        int side = by.count == 2 && other.count == 2 ? (first ? facing.of_one : facing.of_two) : -1;
        if (side < 0) side = by.count == 1 ? 0 : side_along_gradient(first ? one : two, by);
        const Area none{0, 0}, &of_other = other.areas[0];
        const bool flat = other.count == 1 && (first ? two : one).has_corners;
        Area out = side >= 0 && fixed   ? by.areas[side]
                   : side >= 0 && !flat ? difference(by.areas[side], of_other)
                   : other.count == 1   ? difference(none, of_other)
                                        : difference(by.areas[0], difference(none, by.areas[1]));
        return first ? out : difference(none, out);
    }
    if (facing.of_one < 0) return {0, 0};
    return difference(of_one.areas[facing.of_one], of_two.areas[facing.of_two]);
}

/// At the corner of a rigid body, takes the side that faces most the one side that the other body shows.
/// in/out: n, from one to two
inline void take_facing_side(const ContactBody& one, const ContactBody& two, double& nx,
                             double& ny) {
    const SeenSides seen = seen_sides(one.rigid ? one : two),
                    other = seen_sides(one.rigid ? two : one);
    if (seen.count != 2 || other.count != 1) return;
    double most = 0;
    for (const auto& [x, y] : seen.areas) {
        const double size = std::sqrt(x * x + y * y),
                     faces = -(x * other.areas[0][0] + y * other.areas[0][1]) / size;
        if (!(faces > most)) continue;
        const double out = (one.rigid ? 1 : -1) / size;
        nx = out * x, ny = out * y, most = faces;
    }
}

/// The normal from one to two: along the outline that counts, where one does; else between both gradients.
/// in:     least size of a gradient that is not round-off, as it is within a plate
/// out:    whether there is one
inline bool normal_between(const ContactBody& one, const ContactBody& two, double least, double& nx,
                           double& ny) {
    if (two.wall) {
        nx = two.grain == x_low ? -1 : two.grain == x_high ? 1 : 0;
        ny = two.grain == y_low ? -1 : two.grain == y_high ? 1 : 0;
        return true;
    }
    const std::array<double, 2> g = gradient_between(one, two), A = area_between(one, two);
    const double size = std::sqrt(g[0] * g[0] + g[1] * g[1]);
    along_area_or_gradient(A, g, nx, ny);
    return size > least;
}

}  // namespace mpm
