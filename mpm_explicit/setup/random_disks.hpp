// Random packs of disks without overlap. A deposited pack grows from the floor: each disk comes to
// rest at the lowest place where it touches two others, or one and the floor or a wall. A loose
// pack is scattered: each disk takes the first random place that is free.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/random.hpp"
#include "mpm_explicit/setup/disk_cells.hpp"
#include "mpm_explicit/setup/grain_shapes.hpp"

namespace mpm {

/// Random disks in a box. A radius is any from the least to the largest with equal chance. Disk
/// after disk is placed until there are as many as wanted, or without that until the next one finds no place.
struct RandomDisks {
    Bounds box;
    bool periodic_x = false;  // no walls at the ends of x
    double radius_min = 0, radius_max = 0;
    long count = 0;
    double gap = 0;  // least distance between disks; half of it to the box
    bool loose = false;
    std::uint64_t seed = 1;
};

namespace detail {

// Where a disk may come to rest: on a disk, and on another disk or on something else.
enum class Beside { disk, floor_left, floor_right, wall_low, wall_high, corner_low, corner_high };

// A place between neighbors where disks may rest.
struct Pocket {
    double lowest;  // center of the smallest disk that can rest here
    Beside beside;
    long first, second;  // the disks
    bool operator<(const Pocket& other) const {
        return std::tie(lowest, beside, first, second) <
               std::tie(other.lowest, other.beside, other.first, other.second);
    }
};

// The place of a disk that rests in a pocket; none where it would roll out or fall through. Sums of
// products are rounded as in squared(), so that every machine makes the same pack.
inline std::optional<Circle> rest(const DiskCells& disks, const Bounds& box, const Pocket& pocket,
                                  double r) {
    const Beside beside = pocket.beside;
    if (beside == Beside::corner_low) return Circle{box.x_low + r, box.y_low + r, r};
    if (beside == Beside::corner_high) return Circle{box.x_high - r, box.y_low + r, r};
    Circle a = disks[pocket.first];
    const double reach = a.radius + r;
    if (beside != Beside::disk) {
        const bool on_floor = beside == Beside::floor_left || beside == Beside::floor_right,
                   to_left = beside == Beside::floor_left || beside == Beside::wall_low;
        const double x = to_left ? box.x_low + r : box.x_high - r, y = box.y_low + r,
                     away = on_floor ? y - a.y : x - a.x,
                     squared_rest = std::fma(-away, away, reach * reach);
        if (!(squared_rest >= 0) || (!on_floor && (to_left ? away > 0 : away < 0))) return {};
        const double rest_of_it = std::sqrt(squared_rest);
        if (!on_floor) return Circle{x, a.y + rest_of_it, r};
        return disks.wrapped({to_left ? a.x - rest_of_it : a.x + rest_of_it, y, r});
    }
    Circle b = disks.nearest(disks[pocket.second], a.x);
    if (a.x > b.x) std::swap(a, b);
    // Two circles about the centers meet at a part `along` of the way and `up` to its left.
    const double dx = b.x - a.x, dy = b.y - a.y, square = squared(dx, dy),
                 along =
                     0.5 + 0.5 * ((a.radius - b.radius) * (a.radius + b.radius + 2 * r)) / square,
                 up_squared = std::fma(-along, along, (a.radius + r) * (a.radius + r) / square);
    if (!(up_squared >= 0)) return {};
    const double up = std::sqrt(up_squared), x = std::fma(-up, dy, std::fma(along, dx, a.x)),
                 y = std::fma(up, dx, std::fma(along, dy, a.y));
    if (!(a.x <= x && x <= b.x)) return {};
    return disks.wrapped({x, y, r});
}

// Deposits disks one by one.
class Deposit {
   public:
    Deposit(const Bounds& box, double smallest, double largest, bool periodic)
        : box_(box), smallest_(smallest), largest_(largest), disks_(box, largest, periodic) {
        periodic_ = periodic;
        offer(Beside::corner_low, 0, 0);
        if (!periodic) offer(Beside::corner_high, 0, 0);
    }
    const DiskCells& disks() const { return disks_; }

    // Puts a disk at the lowest place, of several the one farthest left. out: false if none is
    bool add(double r) {
        std::optional<Circle> best;
        for (auto pocket = pockets_.begin(); pocket != pockets_.end();) {
            if (best && pocket->lowest > best->y) break;
            const std::optional<Circle> place = free_place(*pocket, r);
            if (place && (!best || std::tie(place->y, place->x) < std::tie(best->y, best->x)))
                best = place;
            const bool given_up = !place && !is_of_use(*pocket);
            pocket = given_up ? pockets_.erase(pocket) : std::next(pocket);
        }
        if (!best) return false;
        const auto added = long(disks_.all().size());
        disks_.visit_near(*best, 2, [&](long k, const Circle& other) {
            const double reach = best->radius + other.radius + 2 * largest_;
            if (squared(best->x - other.x, best->y - other.y) < reach * reach)
                waiting_.push_back(k);
        });
        disks_.add(*best);
        for (const long k : waiting_) offer(Beside::disk, k, added);
        waiting_.clear();
        offer(Beside::floor_left, added, 0);
        offer(Beside::floor_right, added, 0);
        if (!periodic_) offer(Beside::wall_low, added, 0);
        if (!periodic_) offer(Beside::wall_high, added, 0);
        return true;
    }

   private:
    std::optional<Circle> free_place(const Pocket& pocket, double r) const {
        const std::optional<Circle> place = rest(disks_, box_, pocket, r);
        return place && disks_.is_free(*place) ? place : std::nullopt;
    }
    // Whether some disk fits into a pocket, by trying some.
    bool is_of_use(const Pocket& pocket) const {
        constexpr int sizes = 16;
        for (int k = 0; k <= sizes; ++k)
            if (free_place(pocket, std::fma(largest_ - smallest_, k / double{sizes}, smallest_)))
                return true;
        return false;
    }
    // Adds a pocket where a disk of some size may rest. A larger disk rests higher.
    void offer(Beside beside, long first, long second) {
        Pocket pocket{0, beside, first, second};
        bool useful = false;
        for (const double r : {largest_, 0.5 * (smallest_ + largest_), smallest_}) {
            if (const auto place = rest(disks_, box_, pocket, r))
                pocket.lowest = useful ? std::min(pocket.lowest, place->y) : place->y,
                useful = true;
        }
        // A disk that just does not fall through lies between the two.
        if (beside == Beside::disk && useful && !rest(disks_, box_, pocket, smallest_))
            pocket.lowest = std::min(disks_[first].y, disks_[second].y);
        if (useful) pockets_.insert(pocket);
    }

    Bounds box_;
    double smallest_, largest_;
    bool periodic_ = false;
    DiskCells disks_;
    std::set<Pocket> pockets_;
    std::vector<long> waiting_;
};

// Draws of one pack.
constexpr std::uint32_t pack_radii = 0x9a11, pack_places = 0x9a12;

// Refuses a pack that cannot be placed, with the numbers.
inline void validate(const RandomDisks& pack) {
    const double width = pack.box.x_high - pack.box.x_low,
                 height = pack.box.y_high - pack.box.y_low, least = pack.radius_min,
                 largest = 2 * pack.radius_max + pack.gap, least_widths = pack.periodic_x ? 5 : 1;
    require_length(width, "the width of a pack");
    require_length(height, "the height of a pack");
    require_length(least, "the least radius of a pack");
    require(pack.radius_max >= least && pack.radius_max <= 100 * least,
            "the largest radius of a pack, " + format(pack.radius_max) +
                ", must be 1 to 100 times the least, " + format(least));
    require(pack.gap >= 0 && usable(pack.gap),
            "the gap of a pack is " + format(pack.gap) + ": give a length, or 0");
    require(
        width * (1 + resolution) >= least_widths * largest && height * (1 + resolution) >= largest,
        "a box of " + format(width) + " by " + format(height) + " is too small for disks " +
            format(largest) + " wide: it must be as high, and " + format(least_widths) +
            " times as wide");
    require(pack.count >= (pack.loose ? 1 : 0),
            "a pack of " + std::to_string(pack.count) + " disks: give at least one");
    const double most = pack.count > 0 ? double(pack.count) : width * height / (4 * least * least);
    require(most <= 1e6, "a pack of up to " + format(most) +
                             " disks: give larger radii or a smaller box, for at most 1e6");
}

// A disk at the first random place that is free. out: false if none of many is
inline bool scatter(const RandomDisks& pack, const Bounds& box, double r, DiskCells& disks) {
    const auto disk = static_cast<std::uint64_t>(disks.all().size());
    const double margin = pack.periodic_x ? 0 : r;
    for (std::uint32_t attempt = 0; attempt < 10000; ++attempt) {
        const double u = common::uniform(pack.seed, pack_places, disk, 2 * attempt),
                     v = common::uniform(pack.seed, pack_places, disk, 2 * attempt + 1),
                     width = box.x_high - box.x_low - 2 * margin,
                     height = box.y_high - box.y_low - 2 * r;
        const Circle place{std::fma(u, width, box.x_low + margin),
                           std::fma(v, height, box.y_low + r), r};
        if (!disks.is_free(place)) continue;
        disks.add(place);
        return true;
    }
    return false;
}

}  // namespace detail

/// Places the disks of a random pack.
/// in:     the box, the radii and how many; seed
/// out:    disks, in the order in which they were placed
/// exact:  depends on the arguments alone; none overlap, none leave the box
/// note:   a deposited disk misses a lower place only in a hole that takes none but radii of less
///         than 1/16 of their range.
/// errors: InputError when they do not fit, with how many do
inline std::vector<Outline> place_random_disks(const RandomDisks& pack) {
    detail::validate(pack);
    const double half_gap = 0.5 * pack.gap, largest = pack.radius_max + half_gap;
    // Far from the origin a pack is the same.
    const Bounds box{0, pack.box.x_high - pack.box.x_low, 0, pack.box.y_high - pack.box.y_low};
    detail::Deposit deposit(box, pack.radius_min + half_gap, largest, pack.periodic_x);
    DiskCells scattered(box, largest, pack.periodic_x);
    std::vector<Outline> outlines;
    double fraction = 0;
    const bool fill_up = pack.count == 0;
    for (std::uint64_t k = 0; fill_up || k < std::uint64_t(pack.count); ++k) {
        const double u = common::uniform(pack.seed, detail::pack_radii, k, 0),
                     r = std::fma(u, pack.radius_max - pack.radius_min, pack.radius_min);
        const bool placed = pack.loose ? detail::scatter(pack, box, r + half_gap, scattered)
                                       : deposit.add(r + half_gap);
        if (!placed && fill_up) break;
        require(placed, "the box is full with " + std::to_string(k) +
                            " disks and a solid fraction of " + format(fraction) +
                            ": ask for fewer, or make the box larger");
        const Circle& at = (pack.loose ? scattered : deposit.disks()).all().back();
        outlines.push_back(disk(pack.box.x_low + at.x, pack.box.y_low + at.y, r));
        fraction += area(outlines.back()) / (box.x_high * box.y_high);
    }
    return outlines;
}

}  // namespace mpm
