// Disks in a box, found by the cell of their center, to see whether a place for another is free.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mpm_explicit/setup/polygons.hpp"

namespace mpm {

/// A disk by its center and radius [length].
struct Circle {
    double x, y, radius;
};

/// Rounded in one way only, whatever a compiler makes of sums of products.
inline double squared(double dx, double dy) { return std::fma(dx, dx, dy * dy); }

/// Placed disks, found by the cell of their center. A cell is at least as wide as the largest disk.
class DiskCells {
   public:
    DiskCells(const Bounds& box, double largest, bool periodic)
        : box_(box), width_(box.x_high - box.x_low), height_(box.y_high - box.y_low) {
        period_ = periodic ? width_ : 0;
        columns_ = long(std::clamp(width_ / (2 * largest), 1.0, 1024.0));
        rows_ = long(std::clamp(height_ / (2 * largest), 1.0, 1024.0));
        cells_.resize(columns_ * rows_);
    }
    const Circle& operator[](long k) const { return disks_[k]; }
    const std::vector<Circle>& all() const { return disks_; }

    void add(const Circle& disk) {
        cells_[cell(column(disk.x), row(disk.y))].push_back(long(disks_.size()));
        disks_.push_back(disk);
    }
    /// Visits the disks in the cells around a place, in the image that is nearest.
    template <class Visit>
    void visit_near(const Circle& place, long cells, const Visit& visit) const {
        const long i = column(place.x), j = row(place.y);
        for (long b = std::max(0L, j - cells); b <= std::min(rows_ - 1, j + cells); ++b)
            for (long a = i - cells; a <= i + cells; ++a) {
                if (period_ == 0 && (a < 0 || a >= columns_)) continue;
                for (const long k : cells_[cell((a + columns_) % columns_, b)])
                    visit(k, nearest((*this)[k], place.x));
            }
    }
    /// The image of a disk nearest to x, and the one inside of the box.
    Circle nearest(Circle disk, double x) const {
        if (period_ > 0) disk.x = std::fma(period_, std::round((x - disk.x) / period_), disk.x);
        return disk;
    }
    Circle wrapped(Circle disk) const {
        if (period_ > 0 && disk.x < box_.x_low) disk.x += period_;
        if (period_ > 0 && disk.x >= box_.x_high) disk.x -= period_;
        return disk;
    }
    /// Whether a wrapped place is in the box and on no disk.
    bool is_free(const Circle& place) const {
        constexpr double nearly = 1 - 1e-11;
        const double r = place.radius * nearly;
        if (place.y - r < box_.y_low || place.y + r > box_.y_high) return false;
        if (period_ == 0 && (place.x - r < box_.x_low || place.x + r > box_.x_high)) return false;
        bool free = true;
        visit_near(place, 1, [&](long, const Circle& disk) {
            const double touching = (place.radius + disk.radius) * nearly;
            if (squared(place.x - disk.x, place.y - disk.y) < touching * touching) free = false;
        });
        return free;
    }

   private:
    static long index(double part, long count) {
        return std::clamp(long(std::floor(part * double(count))), 0L, count - 1);
    }
    long column(double x) const { return index((x - box_.x_low) / width_, columns_); }
    long row(double y) const { return index((y - box_.y_low) / height_, rows_); }
    std::size_t cell(long i, long j) const { return j * columns_ + i; }

    Bounds box_;
    double width_, height_, period_ = 0;
    long columns_ = 1, rows_ = 1;
    std::vector<std::vector<long>> cells_;
    std::vector<Circle> disks_;
};

}  // namespace mpm
