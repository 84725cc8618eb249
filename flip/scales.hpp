// The scales of a case: what --dry-run says, and warnings where mesh and time step do not resolve
// them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/parallel.hpp"
#include "flip/follow.hpp"

namespace flip {

/// The fluid of one region at the start.
struct RegionScales {
    std::string name;
    double particles = 0;
    double sound_speed = 0;  // the smallest
    double speed = 0;        // the largest
    double mach = 0;         // the largest; 0 where there is no sound
};

struct Scales {
    std::vector<RegionScales> regions;
    double particles = 0;    // at the start
    double sound_speed = 0;  // the largest
    double speed = 0;        // the largest
    double mach = 0;         // the largest
    double dt = 0;           // the first time step
    double steps = 0;        // of the run, if all are as long as the first
    double bytes = 0;        // memory that the run will take
};

namespace detail {

// Places of the lattice that are looked at; a finer lattice is sampled.
inline constexpr long most_places = 1000000;

inline long stride_of_places(const Case& w) {
    const double places = static_cast<double>(w.grid.x.cells * w.per_cell_x) *
                          static_cast<double>(w.grid.z.cells * w.per_cell_z);
    return std::max(1L, static_cast<long>(std::ceil(std::sqrt(places / most_places))));
}

}  // namespace detail

/// The scales of a completed case.
/// note:   particles are counted at the places of the lattice; of a lattice with more than 1e6
///         places, at some of them
inline Scales scales_of(const Case& w) {
    Scales s;
    for (const RegionCase& r : w.regions) s.regions.push_back({r.name});
    const Grid& grid = w.grid;
    const long columns = grid.x.cells * w.per_cell_x, rows = grid.z.cells * w.per_cell_z;
    const long stride = detail::stride_of_places(w);
    const long stride_x = std::min(stride, columns), stride_z = std::min(stride, rows);
    const double dx = grid.x.length / static_cast<double>(columns),
                 dz = grid.z.length / static_cast<double>(rows);
    // The rate at which a signal crosses cells.
    double rate = 0;
    for (long j = stride_z / 2; j < rows; j += stride_z) {
        for (long i = stride_x / 2; i < columns; i += stride_x) {
            const double x = grid.x.low + dx * (static_cast<double>(i) + 0.5),
                         z = grid.z.low + dz * (static_cast<double>(j) + 0.5);
            std::size_t n = w.regions.size();
            while (n > 0 && !detail::contains(w, w.regions[n - 1], x, z)) --n;
            if (n == 0) continue;
            RegionScales& r = s.regions[n - 1];
            const FluidState fluid = fluid_of(w, w.regions[n - 1], x, z);
            const Material& a = w.materials[static_cast<std::size_t>(fluid.material)];
            const double speed = std::hypot(fluid.vx, fluid.vz);
            const double p = pressure(a, fluid.density, fluid.e),
                         c = std::sqrt(stiffness(a, p) / fluid.density);
            r.sound_speed = r.particles > 0 ? std::min(r.sound_speed, c) : c;
            r.speed = std::max(r.speed, speed);
            if (c > 0) r.mach = std::max(r.mach, speed / c);
            r.particles += static_cast<double>(stride_x * stride_z);
            s.sound_speed = std::max(s.sound_speed, c);
            const double sound = w.implicit() ? 0.0 : c;
            rate = std::max({rate, (std::fabs(fluid.vx) + sound) / grid.x.spacing(),
                             (std::fabs(fluid.vz) + (w.plane() ? sound : 0)) / grid.z.spacing()});
        }
    }
    for (const RegionScales& r : s.regions) {
        s.particles += r.particles;
        s.speed = std::max(s.speed, r.speed);
        s.mach = std::max(s.mach, r.mach);
    }
    for (const End end : {x_low, x_high, z_low, z_high})
        if (w.is(end, "inflow"))
            rate = std::max({rate, std::fabs(w.inflow.velocity_x) / grid.x.spacing(),
                             std::fabs(w.inflow.velocity_z) / grid.z.spacing()});
    for (const EndCase& end : w.ends)
        rate = std::max(rate, std::fabs(end.slide) / std::min(grid.x.spacing(), grid.z.spacing()));
    if (rate == 0) {
        // At rest, forces set the pace.
        const double g = std::hypot(w.gravity_x, w.gravity_z);
        rate = std::max(std::sqrt(w.trap), std::sqrt(g / grid.x.spacing()));
    }
    s.dt = w.dt > 0 ? w.dt : (rate > 0 ? std::min(w.end, w.cfl / rate) : w.end);
    s.steps = s.dt > 0 ? std::ceil(w.end / s.dt * (1 - 1e-12)) : 0;
    return s;
}

inline std::string describe_scales(const Case&, const Scales&, const std::string&) { return ""; }

inline std::vector<std::string> resolution_warnings(const Case&, const Scales&) { return {}; }

}  // namespace flip
