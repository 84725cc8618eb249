// Warnings, each with the number and the limit, for choices that run but may mislead.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "flip/setup/keys_of_flip.hpp"
#include "flip/setup/scales.hpp"

namespace flip {

namespace detail {

inline void warn_of_regions(const Case& w, const Scales& scales, std::vector<std::string>& out) {
    for (const RegionScales& r : scales.regions)
        if (r.particles == 0)
            out.push_back("region." + r.name +
                          " contains no particle: it is outside the mesh, narrower than the "
                          "distance between particles, or replaced by a later region");
    for (std::size_t k = 0; k < w.materials.size(); ++k) {
        const auto is_here = [&](const GasCase& gas) {
            return material_index(w, gas.material) == static_cast<int>(k);
        };
        bool used = is_here(w.inflow) && std::any_of(w.ends.begin(), w.ends.end(), [](auto& end) {
                        return end.kind == "inflow";
                    });
        for (const RegionCase& r : w.regions) used = used || is_here(r.gas);
        if (!used) out.push_back("material." + w.materials[k].name + " is nowhere");
    }
    const long per_cell = w.per_cell_x * w.per_cell_z;
    if (per_cell < 4)
        out.push_back(std::to_string(per_cell) +
                      " particles per cell are fewer than 4: a particle "
                      "that leaves a cell takes " +
                      format(100.0 / static_cast<double>(per_cell)) + " % of its density along");
    if (w.rezone_steps > 0 && per_cell > w.max_particles)
        out.push_back("rezone.max_particles = " + std::to_string(w.max_particles) +
                      " is below the " + std::to_string(per_cell) +
                      " particles per cell of the start");
}

// Whether nothing but the flow itself moves the fluid: no jump of pressure, no energy set free.
inline bool is_gentle(const Case& w) {
    double low = 0, high = 0;
    bool filled = false;  // a void beside the fluid sets it in motion
    for (const RegionCase& r : w.regions) {
        filled = filled || r.shape == "everywhere";
        if (r.energy > 0 || (r.flow == "gaussian" && material_of(w, r).gamma > 1)) return false;
        const double p = r.gas.pressure;
        low = &r == &w.regions.front() ? p : std::min(low, p);
        high = std::max(high, p);
    }
    return filled && high <= 1.5 * low;
}

inline void warn_of_speeds(const Case& w, const Scales& scales, const std::string& program,
                           std::vector<std::string>& out) {
    const bool slow = scales.sound_speed > 0 && scales.mach < 0.05;
    if (program == "pic" && slow && is_gentle(w))
        out.push_back("the flow has Mach " + format(scales.mach) +
                      ", below 0.05: cells feel a particle only when it enters them, and what "
                      "classical PIC makes of such a flow is noise; take flip");
    const RegionCase& r = w.regions.front();
    const double c = sound_speed_of(w, r), M = c > 0 ? std::fabs(r.gas.velocity_x) / c : 0;
    if (program == "flip" && !w.implicit() && w.density == "cells" && w.compare != "ringing" &&
        M > 0.07 && M < 0.19)
        out.push_back("region." + r.name + " flows over the mesh at Mach " + format(M) +
                      ", between 0.07 and 0.19, where explicit FLIP rings: try flip.pressure = "
                      "\"implicit\", or a frame of reference that moves along");
    const bool shocks = scales.mach > 0.5 || w.setup == "riemann" || !is_gentle(w);
    if (w.q_linear == 0 && w.q_quadratic == 0 && shocks && !w.implicit() && scales.sound_speed > 0)
        out.push_back(
            program == "pic"
                ? "without artificial viscosity the method has none where the fluid rests: behind "
                  "a shock at a wall, density scatters by tens of percent"
                : "without artificial viscosity particles pile up at shocks: set viscosity.linear "
                  "= 0.5 and viscosity.quadratic = 1");
    const bool held = std::any_of(w.ends.begin(), w.ends.end(),
                                  [](const EndCase& end) { return end.kind == "no_slip"; });
    if (held && w.viscosity == 0)
        out.push_back(
            "a no_slip wall holds fluid without viscosity only through the mesh: set "
            "flip.viscosity, or make the wall slip");
    if (w.implicit() && scales.speed > 0.5 * scales.sound_speed && scales.sound_speed > 0)
        out.push_back("the flow has Mach " + format(scales.mach) +
                      ", above 0.5, and time.cfl with implicit pressure does not follow its sound: "
                      "waves are damped");
}

inline void warn_of_theory(const Case& w, const Scales& scales, std::vector<std::string>& out) {
    if (w.compare == "riemann") {
        const theory::RiemannSolution exact = riemann_of(w);
        const double left = w.interface + (exact.left_head + w.frame_x) * w.end,
                     right = w.interface + (exact.right_head + w.frame_x) * w.end;
        if (left < w.grid.x.low || right > w.grid.x.high())
            out.push_back("at time.end the waves are at x = " + format(left) + " and " +
                          format(right) +
                          ", beyond the ends of the mesh, which the exact solution "
                          "does not know");
    }
    if (w.compare == "wave") {
        const double period =
            2 * pi / (sound_speed_of(w, region_with_flow(w, "wave")) * followed_wave_number(w));
        if (period > w.end)
            out.push_back("the wave has the period " + format(period) +
                          ", longer than time.end = " + format(w.end) +
                          ": its frequency cannot be measured well");
    }
    if (w.compare == "rayleigh_taylor" || w.compare == "kelvin_helmholtz") {
        const double growth = theory_growth(w);
        if (growth * w.end < 1)
            out.push_back("theory has the growth rate " + format(growth) + ", and time.end = " +
                          format(w.end) + " is less than the time " + format(1 / growth) +
                          " in which the wave grows by e: its growth cannot be measured well");
    }
    if (w.compare == "gresho" && scales.regions.size() == 1) {
        const RegionCase& r = region_with_flow(w, "gresho");
        const double turn = std::fabs(pi * r.width / r.speed);
        if (w.end < 0.5 * turn)
            out.push_back("time.end = " + format(w.end) +
                          " is less than half a turn of the vortex, " + format(turn) +
                          ": what one turn loses is extrapolated");
    }
}

}  // namespace detail

/// Warnings about a completed case that validate has let through.
inline std::vector<std::string> resolution_warnings(const Case& w, const Scales& scales,
                                                    const std::string& program) {
    std::vector<std::string> warnings;
    for (const detail::IdleKey& key : detail::keys_of_flip(w))
        if (program == "pic" && key.changed)
            warnings.push_back(key.name + " = " + key.value +
                               " means nothing to pic, whose particles are mass alone");
    detail::warn_of_regions(w, scales, warnings);
    detail::warn_of_speeds(w, scales, program, warnings);
    detail::warn_of_theory(w, scales, warnings);
    const std::vector<std::pair<const char*, double>> intervals{
        {"output.fields_interval", w.fields_interval},
        {"output.particles_interval", w.particles_interval}};
    for (const auto& [name, interval] : intervals)
        if (interval > 0 && interval < scales.dt)
            warnings.push_back(std::string(name) + " = " + format(interval) +
                               " is below the first time step, " + format(scales.dt) +
                               ": files are written every step");
    return warnings;
}

}  // namespace flip
