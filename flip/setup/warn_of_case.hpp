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
            out.push_back(
                sentence("region.", r.name,
                         " contains no particle: it is outside the mesh, narrower than the "
                         "distance between particles, or replaced by a later region"));
    for (std::size_t k = 0; k < w.materials.size(); ++k) {
        const auto is_here = [&](const GasCase& gas) {
            return material_index(w, gas.material) == static_cast<int>(k);
        };
        bool used = is_here(w.inflow) && std::any_of(w.ends.begin(), w.ends.end(), [](auto& end) {
                        return end.kind == "inflow";
                    });
        for (const RegionCase& r : w.regions) used = used || is_here(r.gas);
        if (!used) out.push_back(sentence("material.", w.materials[k].name, " is nowhere"));
    }
    const long per_cell = w.per_cell_x * w.per_cell_z;
    if (per_cell < 4)
        out.push_back(sentence(per_cell,
                               " particles per cell are fewer than 4: a particle "
                               "that leaves a cell takes ",
                               100.0 / static_cast<double>(per_cell), " % of its density along"));
    if (w.rezone_steps > 0 && per_cell > w.max_particles)
        out.push_back(sentence("rezone.max_particles = ", w.max_particles, " is below the ",
                               per_cell, " particles per cell of the start"));
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
        out.push_back(
            sentence("the flow has Mach ", scales.mach,
                     ", below 0.05: cells feel a particle only when it enters them, and what "
                     "classical PIC makes of such a flow is noise; take flip"));
    const RegionCase& r = w.regions.front();
    const double c = sound_speed_of(w, r), M = c > 0 ? std::fabs(r.gas.velocity_x) / c : 0;
    if (program == "flip" && !w.implicit() && w.density == "cells" &&
        w.compare != ringing_comparison.name && M > 0.07 && M < 0.19)
        out.push_back(
            sentence("region.", r.name, " flows over the mesh at Mach ", M,
                     ", between 0.07 and 0.19, where explicit FLIP rings: try flip.pressure = "
                     "\"implicit\", or a frame of reference that moves along"));
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
        out.push_back(
            sentence("the flow has Mach ", scales.mach,
                     ", above 0.5, and time.cfl with implicit pressure does not follow its sound: "
                     "waves are damped"));
}

}  // namespace detail

/// Warnings about a completed case that validate has let through.
inline std::vector<std::string> resolution_warnings(const Case& w, const Scales& scales,
                                                    const std::string& program) {
    std::vector<std::string> warnings;
    for (const detail::IdleKey& key : detail::keys_of_flip(w))
        if (program == "pic" && key.changed)
            warnings.push_back(sentence(key.name, " = ", key.value,
                                        " means nothing to pic, whose particles are mass alone"));
    detail::warn_of_regions(w, scales, warnings);
    detail::warn_of_speeds(w, scales, program, warnings);
    const Comparison& comparison = comparison_of(w);
    if (comparison.warn != nullptr) {
        const std::string warning = comparison.warn(w);
        if (!warning.empty()) warnings.push_back(warning);
    }
    const std::vector<std::pair<const char*, double>> intervals{
        {"output.fields_interval", w.fields_interval},
        {"output.particles_interval", w.particles_interval}};
    for (const auto& [name, interval] : intervals)
        if (interval > 0 && interval < scales.dt)
            warnings.push_back(sentence(name, " = ", interval, " is below the first time step, ",
                                        scales.dt, ": files are written every step"));
    return warnings;
}

}  // namespace flip
