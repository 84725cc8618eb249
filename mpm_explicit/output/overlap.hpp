// How deep grains are in each other, by the outlines that they carry along (surface.hpp).
//
//      .---------.          A part q of one outline that is inside another is as deep in it as the
//     /  a        \         nearest part s of that one is away, along its normal:
//    |       q-----|-.          d_q = (x_s - x_q).n_s
//     \      |    /   \     Inside is where the other outline is all around, by Gauss
//      '-----|---'  b  |        sum_s A_s.(x_s - x_q)/|x_s - x_q|^2 = 2 pi,  outside 0,
//             \_______/     which is not exact nearer than a part is long: there n_s says it.
//
// Nodes see the surfaces that are within a cell, and nothing of bodies that are deeper in each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_explicit/grid/mesh.hpp"

namespace mpm {

/// A part of an outline: its middle, and its area vector out of the grain.
struct PlacedPart {
    double x, y, ax, ay;
};

/// The outline of a grain as its particles carry it, with the upright rectangle and the circle around it.
struct CarriedOutline {
    std::vector<PlacedPart> parts;
    double x_low = HUGE_VAL, x_high = -HUGE_VAL, y_low = HUGE_VAL, y_high = -HUGE_VAL;
    double x = 0, y = 0, radius = 0;  // of the circle

    /// in: wider than the middles, where parts end; period, of the mesh along x, or 0: what wraps around it
    ///     has no ends
    void find_bounds(double wider, double period) {
        if (parts.empty()) return;
        for (const PlacedPart& s : parts) {
            x_low = std::min(x_low, s.x), x_high = std::max(x_high, s.x);
            y_low = std::min(y_low, s.y), y_high = std::max(y_high, s.y);
        }
        x_low -= wider, x_high += wider, y_low -= wider, y_high += wider;
        x = 0.5 * (x_low + x_high), y = 0.5 * (y_low + y_high);
        for (const PlacedPart& s : parts)
            radius = std::max(radius, std::hypot(s.x - x, s.y - y) + wider);
        if (period > 0 && x_high - x_low > 0.9 * period)
            x_low = -HUGE_VAL, x_high = radius = HUGE_VAL;
    }
    /// How deep a point can be inside at most: so far is the rectangle, or the circle, away.
    double room_at(double at_x, double at_y) const {
        const double beside = std::min({at_x - x_low, x_high - at_x, at_y - y_low, y_high - at_y});
        return beside > 0 ? std::min(beside, radius - std::hypot(at_x - x, at_y - y)) : 0;
    }
};

/// The outlines of all grains.
///   x_s = x_p + MT A/|A|^2, the mean place of what a particle carries
/// note: Parts that cancel, of a grain no wider than one particle, have no place.
inline std::vector<CarriedOutline> carried_outlines(const Assembly& all, double h, double period) {
    std::vector<CarriedOutline> outlines(all.grains.size());
    const Surface& s = all.particles.surface;
    std::size_t k = 0;
    for (std::size_t g = 0; g < all.grains.size(); ++g) {
        for (; k < s.count() && s.host[k] < all.grains[g].end; ++k) {
            const auto p = static_cast<std::size_t>(s.host[k]);
            const double A_2 = s.ax[k] * s.ax[k] + s.ay[k] * s.ay[k];
            if (!(A_2 > 1e-8 * h * h)) continue;
            const double e_x = (s.xx[k] * s.ax[k] + s.yx[k] * s.ay[k]) / A_2,
                         e_y = (s.xy[k] * s.ax[k] + s.yy[k] * s.ay[k]) / A_2;
            if (!(e_x * e_x + e_y * e_y < h * h)) continue;
            outlines[g].parts.push_back(
                {all.particles.x_p[p] + e_x, all.particles.y_p[p] + e_y, s.ax[k], s.ay[k]});
        }
        outlines[g].find_bounds(h / 8, period);
    }
    return outlines;
}

/// How deep the point (x, y) is in a grain, if it is deeper than that; else the same depth.
/// in: period, of the mesh along x, or 0: of every part the nearest image counts; room, that the grain has
///     there: parts with noise in their normals would say more
inline double deeper_in(const CarriedOutline& grain, double x, double y, double period, double room,
                        double depth) {
    const auto away = [&](const PlacedPart& s) {
        const double dx = s.x - x;
        return period > 0 ? dx - period * std::round(dx / period) : dx;
    };
    double nearest_2 = HUGE_VAL;
    const PlacedPart* nearest = nullptr;
    for (const PlacedPart& s : grain.parts) {
        const double dx = away(s), dy = s.y - y, away_2 = dx * dx + dy * dy;
        if (away_2 < nearest_2) nearest_2 = away_2, nearest = &s;
    }
    if (nearest == nullptr) return depth;
    const double deep =
        std::min(room, (nearest->ax * away(*nearest) + nearest->ay * (nearest->y - y)) /
                           std::hypot(nearest->ax, nearest->ay));
    if (!(deep > depth)) return depth;
    // No part is at the point: the nearest is not.
    double around = 0;
    for (const PlacedPart& s : grain.parts) {
        const double dx = away(s), dy = s.y - y;
        around += (s.ax * dx + s.ay * dy) / (dx * dx + dy * dy);
    }
    return around > std::numbers::pi ? deep : depth;
}

/// How deep any two grains are in each other, the most; 0 where none are. Rigid ones pass through each
/// other as they are told, and do not count.
/// exact: within 0.04 h for disks of four cells or more, whose outlines are h^2/12 R farther out than
///        they; of a sharp corner the last half of a part is missing
inline double deepest_overlap(const Assembly& all, const Mesh& mesh) {
    const double period = mesh.periodic_x ? mesh.length_x() : 0;
    const std::vector<CarriedOutline> outlines = carried_outlines(all, mesh.h, period);
    double deepest = 0;
    const auto look = [&](const CarriedOutline& a, const CarriedOutline& b, double shift) {
        for (const PlacedPart& q : b.parts) {
            const double room = a.room_at(q.x + shift, q.y);
            if (room > deepest) deepest = deeper_in(a, q.x, q.y, period, room, deepest);
        }
    };
    // From left to right; on a periodic mesh with an image on either side.
    struct Left {
        double x, shift;
        std::size_t grain;
    };
    std::vector<Left> order;
    for (std::size_t g = 0; g < outlines.size(); ++g) {
        const double x = outlines[g].x_low;
        order.push_back({x, 0, g});
        if (period > 0)
            order.push_back({x - period, -period, g}), order.push_back({x + period, period, g});
    }
    std::ranges::sort(order, {}, &Left::x);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t left = order[k].grain;
        const CarriedOutline& a = outlines[left];
        for (std::size_t l = k + 1; l < order.size() && order[k].shift == 0; ++l) {
            const auto& [x, shift, right] = order[l];
            if (!(x < a.x_high)) break;
            const CarriedOutline& b = outlines[right];
            if (left == right || !(b.y_low < a.y_high && a.y_low < b.y_high) ||
                (all.grains[left].rigid && all.grains[right].rigid))
                continue;
            look(a, b, shift), look(b, a, -shift);
        }
    }
    return deepest;
}

}  // namespace mpm
