// The scales of a case: what --dry-run says, and warnings where mesh and time step do not resolve
// them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/parallel.hpp"
#include "flip/theory/compare_with_theory.hpp"

namespace flip {

/// The fluid of one region at the start.
struct RegionScales {
    std::string name;
    double particles = 0;
    double mass = 0;
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
    double rate = 0;         // at which the fastest signal crosses cells [1/time]
    double dt = 0;           // the first time step
    double steps = 0;        // of the run, if all are as long as the first
    double bytes = 0;        // memory that the run will take
};

/// Calls visit(region, fluid, x, z, weight) for places of the lattice of the start.
/// in:     a case whose regions name materials that exist
/// out:    weight, how many particles a place stands for: 1 up to 1e6 places, more on a finer
///         lattice
template <class Visit>
void for_each_place(const Case& w, const Visit& visit) {
    const Grid& grid = w.grid;
    const long columns = grid.x.cells * w.per_cell_x, rows = grid.z.cells * w.per_cell_z;
    const double places = static_cast<double>(columns) * static_cast<double>(rows);
    const long stride = std::max(1L, static_cast<long>(std::ceil(std::sqrt(places / 1e6))));
    const long stride_x = std::min(stride, columns), stride_z = std::min(stride, rows);
    const double dx = grid.x.length / static_cast<double>(columns),
                 dz = grid.z.length / static_cast<double>(rows);
    for (long j = stride_z / 2; j < rows; j += stride_z) {
        for (long i = stride_x / 2; i < columns; i += stride_x) {
            const double x = grid.x.low + dx * (static_cast<double>(i) + 0.5),
                         z = grid.z.low + dz * (static_cast<double>(j) + 0.5);
            std::size_t n = w.regions.size();
            while (n > 0 && !detail::contains(w, w.regions[n - 1], x, z)) --n;
            if (n == 0) continue;
            visit(n - 1, fluid_of(w, w.regions[n - 1], x, z), x, z,
                  static_cast<double>(stride_x * stride_z));
        }
    }
}

namespace detail {

inline double bytes_of(const Case& w, const std::string& program, double particles) {
    double per_particle = 3 * sizeof(double) + 2 * sizeof(int) + sizeof(double);  // and a sort
    if (program == "flip") {
        per_particle += 3 * sizeof(double);
        if (w.density == "particles") per_particle += sizeof(double);
        if (w.transfer == "apic") per_particle += 4 * sizeof(double);
    }
    const double fields = 40 + 2 * static_cast<double>(w.materials.size()) +
                          (w.implicit() || w.mass == "consistent" ? 60 : 0);
    return per_particle * particles + fields * sizeof(double) * static_cast<double>(w.grid.size());
}

}  // namespace detail

/// The scales of a completed case.
/// in:     program, pic or flip, which takes more memory
inline Scales scales_of(const Case& w, const std::string& program = "flip") {
    Scales s;
    for (const RegionCase& r : w.regions) s.regions.push_back({r.name, 0, 0, 0, 0, 0});
    const double per_dx = 1 / w.grid.x.spacing(), per_dz = w.plane() ? 1 / w.grid.z.spacing() : 0;
    const double both = std::hypot(per_dx, per_dz);
    const double place = w.grid.cell_area() / static_cast<double>(w.per_cell_x * w.per_cell_z);
    for_each_place(w, [&](std::size_t n, const FluidState& fluid, double, double, double weight) {
        RegionScales& r = s.regions[n];
        const Material& a = w.materials[static_cast<std::size_t>(fluid.material)];
        const double speed = std::hypot(fluid.vx, fluid.vz),
                     p = pressure(a, fluid.density, fluid.e),
                     c = std::sqrt(stiffness(a, p) / fluid.density);
        r.sound_speed = r.particles > 0 ? std::min(r.sound_speed, c) : c;
        r.speed = std::max(r.speed, speed);
        if (c > 0) r.mach = std::max(r.mach, speed / c);
        r.particles += weight;
        r.mass += weight * fluid.density * place;
        s.sound_speed = std::max(s.sound_speed, c);
        s.rate = std::max(s.rate, std::fabs(fluid.vx) * per_dx + std::fabs(fluid.vz) * per_dz +
                                      (w.implicit() ? 0 : c * both));
    });
    for (std::size_t n = 0; n < w.regions.size(); ++n) {
        // A region that an energy has been set free in: c^2 = gamma (gamma - 1) e.
        RegionScales& r = s.regions[n];
        if (w.regions[n].energy == 0 || r.mass == 0) continue;
        const double gamma = material_of(w, w.regions[n]).gamma;
        r.sound_speed = std::sqrt(r.sound_speed * r.sound_speed +
                                  gamma * (gamma - 1) * w.regions[n].energy / r.mass);
        s.sound_speed = std::max(s.sound_speed, r.sound_speed);
        s.rate = std::max(s.rate, w.implicit() ? 0 : r.sound_speed * both);
    }
    for (const RegionScales& r : s.regions) {
        s.particles += r.particles;
        s.speed = std::max(s.speed, r.speed);
        s.mach = std::max(s.mach, r.mach);
    }
    for (const EndCase& end : w.ends) {
        s.rate = std::max(s.rate, std::fabs(end.slide) * std::max(per_dx, per_dz));
        if (end.kind == "inflow")
            s.rate = std::max(s.rate, std::fabs(w.inflow.velocity_x) * per_dx +
                                          std::fabs(w.inflow.velocity_z) * per_dz);
    }

    // A fluid at rest is limited by how fast it can begin to move.
    const double pull = std::hypot(w.gravity_x, w.gravity_z);
    s.dt = s.rate > 0 ? w.cfl / s.rate : w.end;
    if (pull > 0) s.dt = std::min(s.dt, std::sqrt(w.cfl / (pull * std::max(per_dx, per_dz))));
    if (w.trap > 0) s.dt = std::min(s.dt, w.cfl / std::sqrt(w.trap));
    if (w.dt > 0) s.dt = w.dt;
    s.dt = std::min(s.dt, w.end);
    s.steps = s.dt > 0 ? std::max(1.0, std::ceil(w.end / s.dt * (1 - 1e-12))) : 0;
    s.bytes = detail::bytes_of(w, program, s.particles);
    return s;
}

namespace detail {

/// What theory says about the case, in one line; empty where it says nothing in advance.
inline std::string theory_line(const Case& w, const Scales& scales, const std::string& program) {
    if (w.compare == "riemann") {
        const theory::RiemannSolution s = riemann_of(w);
        return "pressure " + format(s.left_of_contact.pressure) + " and velocity " +
               format(s.left_contact) + " at the contact";
    }
    if (w.compare == "wall_shock" || w.compare == "piston") {
        const theory::DrivenShock s = struck_wall(w).shock;
        return "density " + format(s.density) + " behind a shock at " + format(s.speed_from_wall) +
               " from the wall, Mach " + format(s.mach);
    }
    if (w.compare == "sedov")
        return "shock at r = " + format(blast_of(w).radius(w.end)) + " at t = " + format(w.end);
    if (w.compare == "noh")
        return "shock at r = " + format(theory::noh_shock_radius(noh_of(w), w.end)) +
               " at t = " + format(w.end);
    if (w.compare == "gresho") {
        const RegionCase& r = region_with_flow(w, "gresho");
        return "one turn in t = " + format(std::fabs(pi * r.width / r.speed));
    }
    if (w.compare == "wave") {
        const SoundWave s = sound_wave_of(w, program, scales.dt);
        return "period " + format(2 * pi / s.frequency) + "; a step of " + format(scales.dt) +
               " multiplies the wave by " + format(s.amplification);
    }
    if (w.compare == "rayleigh_taylor" || w.compare == "kelvin_helmholtz")
        return "growth rate " + format(theory_growth(w));
    return "";
}

}  // namespace detail

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& w, const Scales& scales,
                                   const std::string& program) {
    std::string text;
    const auto line = [&](const std::string& name, const std::string& value) {
        text +=
            "  " + name + std::string(name.size() < 20 ? 20 - name.size() : 1, ' ') + value + "\n";
    };
    const Grid& grid = w.grid;
    const auto ends = [&](End low) {
        const std::string &a = w.ends[low].kind, &b = w.ends[low + 1].kind;
        return a == b ? a : a + " and " + b;
    };
    line("mesh", std::to_string(grid.x.cells) + " x " + std::to_string(grid.z.cells) +
                     " cells of " + format(grid.x.spacing()) + " x " + format(grid.z.spacing()) +
                     ", " + ends(x_low) + " in x, " + ends(z_low) + " in z");
    if (program == "flip") {
        std::string method = w.transfer;
        if (w.transfer == "blend") method += " " + format(w.blend);
        if (w.transfer == "xpic") method += " of order " + std::to_string(w.xpic_order);
        line("method", method + " transfer, " + w.mass + " mass, density of " + w.density + ", " +
                           w.pressure + " pressure" +
                           (w.implicit() ? " at theta = " + format(w.theta) : ""));
    } else {
        line("method", "velocity and energy on the cells");
    }
    for (const RegionScales& r : scales.regions)
        line(r.name, "about " + format(r.particles) + " particles, sound speed " +
                         format(r.sound_speed) + ", speed up to " + format(r.speed) +
                         (r.mach > 0 ? ", Mach " + format(r.mach) : ""));
    line("particles", "about " + format(scales.particles));
    line("steps", (w.dt > 0 ? "" : "about ") + format(scales.steps) +
                      (w.dt > 0 ? " of " : "; the first of ") + format(scales.dt));
    const std::string theory = detail::theory_line(w, scales, program);
    if (!theory.empty()) line("theory", theory);
    line("memory", "about " + format(scales.bytes / 1048576) + " MiB");
    const double per_second = program == "pic" ? 30e6 : 12e6;
    const double work =
        scales.steps * (scales.particles + 2.0 * static_cast<double>(grid.x.cells * grid.z.cells));
    line("time", "about " + format(work / per_second) + " s on one core");
    return text;
}

}  // namespace flip
