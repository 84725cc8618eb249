// The scales of a case: what --dry-run says, and warnings where mesh and time step do not resolve
// them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/parallel.hpp"
#include "flip/theory/comparisons.hpp"

namespace flip {

/// The fluid of one region at the start.
struct RegionScales {
    std::string name;
    bool vacuum = false;
    double particles = 0;
    double mass = 0;
    double sound_speed = 0;  // the smallest
    double speed = 0;        // the largest, in the plane (x, z)
    double swirl = 0;        // the largest velocity about the axis
    double mach = 0;         // the largest of speed; 0 where there is no sound
    double lightest = 0;     // the smallest density
    double least_pressure = 0, most_pressure = 0;
};

/// The scales of all regions, and the steps, cost and memory that follow.
struct Scales {
    std::vector<RegionScales> regions;
    double particles = 0;    // at the start
    double sound_speed = 0;  // the largest
    double speed = 0;        // the largest
    double mach = 0;         // the largest
    double outward = 0;      // the largest centrifugal force per mass
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
void for_each_place(const Case& parameters, const Visit& visit) {
    const Grid& grid = parameters.grid;
    const long columns = grid.x.cells * parameters.per_cell_x,
               rows = grid.z.cells * parameters.per_cell_z;
    const double places = double(columns) * double(rows);
    const long stride = std::max(1L, long(std::ceil(std::sqrt(places / 1e6))));
    const long stride_x = std::min(stride, columns), stride_z = std::min(stride, rows);
    const double dx = grid.x.length / double(columns), dz = grid.z.length / double(rows);
    for (long j = stride_z / 2; j < rows; j += stride_z) {
        for (long i = stride_x / 2; i < columns; i += stride_x) {
            const double x = grid.x.low + dx * (double(i) + 0.5),
                         z = grid.z.low + dz * (double(j) + 0.5);
            const long n = region_at(parameters, x, z);
            if (n < 0) continue;
            visit(n, fluid_of(parameters, parameters.regions[n], x, z), x, z,
                  double(stride_x * stride_z));
        }
    }
}

/// Memory of particles and fields [byte].
inline double bytes_of(const Case& parameters, const std::string& program, double particles) {
    // Also in pic, particles are loaded with velocity and energy and the number of their region.
    double per_particle = 7 * sizeof(double) + 2 * sizeof(int);
    if (program == "flip") {
        if (parameters.density == "particles") per_particle += sizeof(double);
        if (parameters.transfer == "apic") per_particle += 4 * sizeof(double);
    }
    if (parameters.swirls()) per_particle += 2 * sizeof(double);  // and what a step needs
    const double fields = 40 + 2 * double(parameters.materials.size()) +
                          (parameters.implicit() || parameters.mass == "consistent" ? 60 : 0);
    return per_particle * particles + fields * sizeof(double) * double(parameters.grid.size());
}

/// The scales of a completed case.
/// in:     program, pic or flip, which takes more memory
inline Scales scales_of(const Case& parameters, const std::string& program = "flip") {
    Scales s;
    for (const RegionCase& r : parameters.regions)
        s.regions.push_back({.name = r.name, .vacuum = r.is_vacuum()});
    const double per_dx = 1 / parameters.grid.x.spacing(),
                 per_dz = parameters.plane() ? 1 / parameters.grid.z.spacing() : 0;
    const bool consistent = program == "flip" && parameters.mass == "consistent",
               faster = consistent && parameters.density == "cells";
    const double both = (faster ? fastest_consistent : 1) * std::hypot(per_dx, per_dz);
    const double place =
        parameters.grid.cell_area() / double(parameters.per_cell_x * parameters.per_cell_z);
    for_each_place(parameters, [&](long n, const FluidState& fluid, double x, double,
                                   double weight) {
        RegionScales& r = s.regions[n];
        const Material& a = parameters.materials[fluid.material];
        const double speed = std::hypot(fluid.vx, fluid.vz),
                     p = pressure(a, fluid.density, fluid.e),
                     c = std::sqrt(stiffness(a, p) / fluid.density);
        const bool first = r.particles == 0;
        r.sound_speed = first ? c : std::min(r.sound_speed, c);
        r.lightest = first ? fluid.density : std::min(r.lightest, fluid.density);
        r.least_pressure = first ? p : std::min(r.least_pressure, p);
        r.most_pressure = first ? p : std::max(r.most_pressure, p);
        r.speed = std::max(r.speed, speed);
        r.swirl = std::max(r.swirl, std::fabs(fluid.v_theta));
        const double from_axis = std::max(x, 0.5 * parameters.grid.x.spacing());
        if (fluid.v_theta != 0)
            s.outward = std::max(s.outward, fluid.v_theta * fluid.v_theta / from_axis);
        if (c > 0) r.mach = std::max(r.mach, speed / c);
        r.particles += weight;
        r.mass += weight * fluid.density * place * (parameters.grid.axisymmetric ? 2 * pi * x : 1);
        s.sound_speed = std::max(s.sound_speed, c);
        s.rate = std::max(
            s.rate, std::fabs(fluid.vx) * per_dx + std::fabs(fluid.vz) * per_dz +
                        (parameters.implicit() ? 0 : c * both) +
                        std::fabs(fluid.v_theta) / std::max(x, 0.5 * parameters.grid.x.spacing()));
    });
    for (std::size_t n = 0; n < parameters.regions.size(); ++n) {
        // A region that an energy has been set free in: c^2 = gamma (gamma - 1) e.
        RegionScales& r = s.regions[n];
        if (parameters.regions[n].energy == 0 || r.mass == 0) continue;
        const double gamma = material_of(parameters, parameters.regions[n]).gamma;
        r.sound_speed = std::sqrt(r.sound_speed * r.sound_speed +
                                  gamma * (gamma - 1) * parameters.regions[n].energy / r.mass);
        s.sound_speed = std::max(s.sound_speed, r.sound_speed);
        s.rate = std::max(s.rate, parameters.implicit() ? 0 : r.sound_speed * both);
    }
    for (const RegionScales& r : s.regions) {
        s.particles += r.particles;
        s.speed = std::max(s.speed, r.speed);
        s.mach = std::max(s.mach, r.mach);
    }
    for (const BoundaryCase& end : parameters.boundaries) {
        s.rate = std::max(s.rate, std::fabs(end.slide) * std::max(per_dx, per_dz));
        if (end.kind == "inflow")
            s.rate = std::max(s.rate, std::fabs(end.inflow.velocity_x) * per_dx +
                                          std::fabs(end.inflow.velocity_z) * per_dz);
    }

    // A fluid at rest is limited by how fast it can begin to move; without gravity a pressure that
    // is not even soon moves the heaviest of it with (p/rho)^1/2.
    const double pull = std::hypot(parameters.gravity_x, parameters.gravity_z) + s.outward;
    if (s.rate == 0 && pull == 0)
        for (const RegionScales& r : s.regions) {
            const double soon = r.particles > 0 ? std::sqrt(r.most_pressure / r.lightest) : 0;
            if (soon > 0 && (s.rate == 0 || soon * both < s.rate)) s.rate = soon * both;
        }
    s.dt = s.rate > 0 ? parameters.cfl / s.rate : parameters.end;
    if (pull > 0)
        s.dt = std::min(s.dt, std::sqrt(parameters.cfl / (pull * std::max(per_dx, per_dz))));
    if (parameters.trap > 0) s.dt = std::min(s.dt, parameters.cfl / std::sqrt(parameters.trap));
    for (const RegionScales& r : s.regions)
        if (parameters.viscosity > 0 && r.particles > 0)
            s.dt = std::min(s.dt, 0.25 * r.lightest /
                                      (parameters.viscosity * (per_dx * per_dx + per_dz * per_dz) *
                                       (consistent ? most_viscous_consistent : 1)));
    if (parameters.dt > 0) s.dt = parameters.dt;
    s.dt = std::min(s.dt, parameters.end);
    s.steps = s.dt > 0 ? std::max(1.0, std::ceil(parameters.end / s.dt * (1 - 1e-12))) : 0;
    s.bytes = bytes_of(parameters, program, s.particles);
    return s;
}

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& parameters, const Scales& scales,
                                   const std::string& program) {
    std::string text;
    const auto line = [&](const std::string& name, const auto&... value) {
        const std::string space(name.size() < 20 ? 20 - name.size() : 1, ' ');
        text += sentence("  ", name, space, value..., "\n");
    };
    const Grid& grid = parameters.grid;
    const auto ends = [&](Side low) {
        const std::string &a = parameters.boundaries[low].kind,
                          &b = parameters.boundaries[low + 1].kind;
        return a == b ? a : a + " and " + b;
    };
    line("mesh", grid.x.cells, " x ", grid.z.cells, " cells of ", grid.x.spacing(), " x ",
         grid.z.spacing(), ", ", ends(x_low), " in x, ", ends(z_low), " in z",
         (grid.axisymmetric ? ", rings about the axis x = 0" : ""));
    if (program == "flip") {
        std::string method = parameters.transfer;
        if (parameters.transfer == "blend") method += " " + format(parameters.blend);
        if (parameters.transfer == "xpic")
            method += " of order " + std::to_string(parameters.xpic_order);
        line("method", method, " transfer, ", parameters.mass, " mass, density of ",
             parameters.density, ", ", parameters.pressure, " pressure",
             (parameters.implicit() ? " at theta = " + format(parameters.theta) : ""));
    } else {
        line("method", "velocity and energy on the cells");
    }
    for (const RegionScales& r : scales.regions)
        if (!r.vacuum)
            line(r.name, "about ", r.particles, " particles, sound speed ", r.sound_speed,
                 ", speed up to ", r.speed, (r.mach > 0 ? ", Mach " + format(r.mach) : ""),
                 (r.swirl > 0 ? ", about the axis up to " + format(r.swirl) : ""));
    line("particles", "about ", scales.particles);
    line("steps", (parameters.dt > 0 ? "" : "about "), scales.steps,
         (parameters.dt > 0 ? " of " : "; the first of "), scales.dt);
    const Comparison& comparison = comparison_of(parameters);
    if (comparison.predict != nullptr)
        line("theory", comparison.predict(parameters, program, scales.dt));
    line("memory", "about ", scales.bytes / 1048576, " MiB");
    const double per_second = program == "pic" ? 30e6 : 12e6;
    // As measured, of 30 iterations for each cell that is filled.
    const double work = scales.particles + 2.0 * double(grid.x.cells * grid.z.cells),
                 filled = scales.particles / double(parameters.per_cell_x * parameters.per_cell_z),
                 solve = parameters.implicit() ? 3.5e-6 * filled : 0;
    line("time", "about ", scales.steps * (work / per_second + solve), " s on one core");
    return text;
}

}  // namespace flip
