// Warnings, each with the number and the limit, for choices that run but may mislead.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "flip/setup/keys_of_flip.hpp"
#include "flip/setup/scales.hpp"
#include "flip/theory/compare_instability.hpp"
#include "flip/theory/compare_rest.hpp"
#include "flip/theory/compare_riemann.hpp"
#include "flip/theory/compare_sound.hpp"

namespace flip {

namespace detail {

inline void warn_of_regions(const Case& parameters, const Scales& scales,
                            const std::string& program, std::vector<std::string>& out) {
    for (const RegionScales& r : scales.regions)
        warn(out, r.particles == 0 && !r.vacuum, "region.", r.name,
             " contains no particle: it is outside the mesh, narrower than the distance between "
             "particles, or replaced by a later region");
    for (std::size_t k = 0; k < parameters.materials.size(); ++k) {
        const auto is_here = [&](const auto& gas) {
            return material_index(parameters, gas.material) == int(k);
        };
        // Riemann's problem makes two, also beside a vacuum.
        bool used = parameters.setup == "riemann" ||
                    std::ranges::any_of(parameters.boundaries, [&](auto& end) {
                        return end.kind == "inflow" && is_here(end.inflow);
                    });
        for (const RegionCase& r : parameters.regions) used = used || is_here(r.gas);
        warn(out, !used, "material.", parameters.materials[k].name, " is nowhere");
    }
    const long per_cell = parameters.per_cell_x * parameters.per_cell_z;
    warn(out, per_cell < 4, per_cell,
         " particles per cell are fewer than 4: a particle that leaves a cell takes ",
         100.0 / double(per_cell), " % of its density along");
    const long across = parameters.plane() ? std::min(parameters.per_cell_x, parameters.per_cell_z)
                                           : parameters.per_cell_x;
    warn(out,
         program == "flip" && parameters.mass == "consistent" && across < 3 &&
             parameters.rezone_steps == 0,
         "flip.mass = \"consistent\" with ", across,
         " particles across a cell, below 3: where the flow draws them apart the mass matrix is "
         "nearly singular, and cells burst; take 4, or rezone.steps = 20");
    warn(out, parameters.rezone_steps > 0 && per_cell > parameters.max_particles,
         "rezone.max_particles = ", parameters.max_particles, " is below the ", per_cell,
         " particles per cell of the start");
    warn(out,
         parameters.seed != Case{}.seed && parameters.loading == "lattice" &&
             std::ranges::none_of(parameters.regions, [](auto& r) { return r.noise > 0; }),
         "particles.seed changes nothing: particles of loading = \"lattice\" have no random "
         "places, and no region has noise");
}

// Ends that let in another gas than the one that begins there; where nothing is compared, it may be the
// same gas by another name.
inline void warn_of_inflow(const Case& parameters, std::vector<std::string>& out) {
    const auto gas = [](const Material& a) {
        return sentence("material.", a.name, ", gamma = ", a.gamma,
                        " and p_infinity = ", a.p_infinity);
    };
    for (const Side side : all_sides) {
        const BoundaryCase& end = parameters.boundaries[side];
        if (end.kind != "inflow") continue;
        const bool along_x = is_x_side(side);
        const common::Axis &across = along_x ? parameters.grid.x : parameters.grid.z,
                           &beside = along_x ? parameters.grid.z : parameters.grid.x;
        const double at = across.at(is_low_side(side) ? 0.5 : double(across.cells) - 0.5);
        const Material& in = parameters.materials[material_index(parameters, end.inflow.material)];
        for (long n = 0; n < beside.cells; ++n) {
            const double on = beside.at(double(n) + 0.5);
            const long r = along_x ? region_at(parameters, at, on) : region_at(parameters, on, at);
            if (r < 0) continue;
            const Material& here = material_of(parameters, parameters.regions[r]);
            const bool same = here.gamma == in.gamma && here.p_infinity == in.p_infinity;
            if (same && (parameters.compare == "none" || here.name == in.name)) continue;
            warn(out, true, "inflow.", side_names[side], " brings ", gas(in), ", and region.",
                 parameters.regions[r].name, " at that end is ", gas(here), ": set inflow.",
                 side_names[side], ".material = \"", here.name, "\", where that is not meant");
            break;
        }
    }
}

// Whether nothing but the flow itself moves the fluid: no jump of pressure, no energy set free.
inline bool is_gentle(const Case& parameters, const Scales& scales) {
    double low = 1e300, high = 0;
    bool filled = false;  // a void beside the fluid sets it in motion
    for (std::size_t n = 0; n < parameters.regions.size(); ++n) {
        const RegionCase& r = parameters.regions[n];
        filled = filled || r.shape == "everywhere";
        if (r.energy > 0 || (r.flow == "gaussian" && material_of(parameters, r).gamma > 1))
            return false;
        const RegionScales& all = scales.regions[n];
        const bool number = r.gas.pressure.is_number();
        low = std::min<double>(low, number ? +r.gas.pressure : all.least_pressure);
        high = std::max<double>(high, number ? +r.gas.pressure : all.most_pressure);
    }
    return filled && high <= 1.5 * low;
}

// Explicit steps of flip with slow flow over the mesh.
inline void warn_of_slow_flow(const Case& parameters, const Scales& scales,
                              std::vector<std::string>& out) {
    const bool flips = parameters.transfer == "flip" || parameters.transfer == "blend",
               fed = std::ranges::count(parameters.boundaries, "inflow", &BoundaryCase::kind) > 0,
               gentle = is_gentle(parameters, scales);
    const double dx = std::min(parameters.grid.x.spacing(), parameters.grid.z.spacing());
    for (std::size_t n = 0; n < parameters.regions.size(); ++n) {
        const RegionCase& r = parameters.regions[n];
        const RegionScales& s = scales.regions[n];
        if (s.sound_speed == 0) continue;
        const bool even = r.gas.velocity_x.is_number() && r.gas.velocity_z.is_number(),
                   turns = gentle && (!even || r.flow == "gresho" || r.flow == "shear") &&
                           parameters.grid.z.cells > 1 && s.speed * parameters.end > 2 * dx;
        const double M = turns  ? s.mach
                         : even ? std::hypot(+r.gas.velocity_x, +r.gas.velocity_z) / s.sound_speed
                                : 0;
        const bool cells = parameters.density == "cells" &&
                           parameters.compare != ringing_comparison.name && M < 0.19;
        // As measured, of eddies and of a duct: until time.end the energy is a multiple of that of the start.
        const bool kicked = (turns && flips) || (fed && gentle && M > 0.005);
        warn(out, cells && kicked, "region.", r.name, " flows at Mach ", M,
             ", below 0.19, where explicit FLIP with flip.density = \"cells\" rings",
             fed ? " behind an inflow" : " and slow flow gains energy",
             ": set flip.density = \"particles\", or flip.pressure = \"implicit\"");
        warn(out, cells && flips && !kicked && M > 0.07, "region.", r.name,
             " flows over the mesh at Mach ", M,
             ", between 0.07 and 0.19, where explicit FLIP rings: try flip.pressure = "
             "\"implicit\", or a frame of reference that moves along");
        const bool weak = parameters.density == "particles" && turns && parameters.q_linear < 0.2;
        const long across = std::min(parameters.per_cell_x, parameters.per_cell_z);
        warn(out, weak && flips && !even && across < 3, "with ", across,
             " particles across a cell, below 3, the flow of region.", r.name,
             " draws voids between them, and explicit steps make energy of that: set "
             "particles.per_cell_x and per_cell_z to 3, flip.pressure = \"implicit\", or "
             "viscosity.linear = 0.2");
        warn(out, weak && parameters.confined && parameters.filling > 0,
             "flip.confined with explicit pressure fills the room that particles leave, and slow "
             "flow, as in region.",
             r.name,
             ", gains energy by that: set flip.pressure = \"implicit\", or flip.filling = 0");
    }
}

inline void warn_of_speeds(const Case& parameters, const Scales& scales, const std::string& program,
                           std::vector<std::string>& out) {
    const bool slow = scales.sound_speed > 0 && scales.mach < 0.05;
    warn(out, program == "pic" && slow && is_gentle(parameters, scales), "the flow has Mach ",
         scales.mach, parameters.swirls() ? " beside its swirl" : "",
         ", below 0.05: cells feel a particle only when it enters them, and what classical PIC "
         "makes of such a flow is noise; take flip");
    // As measured, of iron that hits aluminum with 4 to 64 particles in a cell, at Mach 0.2 to 0.6.
    bool stiff = false, bare = true;
    for (const RegionCase& r : parameters.regions) {
        stiff = stiff || material_of(parameters, r).p_infinity > 0;
        bare = bare && r.shape != "everywhere";
    }
    const double of_noise = 1.2 / (double(parameters.per_cell_x * parameters.per_cell_z) *
                                   std::max(scales.mach * scales.mach, 1e-300));
    warn(out, program == "pic" && stiff && bare && scales.mach > 0 && of_noise > 0.1,
         "the flow has Mach ", scales.mach,
         ", and particles that come and go make pressures in stiff bodies that add about ",
         of_noise,
         " of the kinetic energy of the start: take flip, a faster flow, or raise "
         "particles.per_cell_x and per_cell_z");
    for (const RegionCase& wave : parameters.regions) {
        const double moved = particles_moved(parameters, wave);
        warn(out, program == "pic" && wave.flow == "wave" && moved < enough_moved,
             "the wave of region.", wave.name, " takes ", moved,
             " particles across a border of cells, below ", enough_moved,
             ": cells do not feel that density changes, and sound has another speed; ",
             cure_of_pic(parameters, wave));
    }
    const double slower =
        parameters.compare == wave_comparison.name ? slowed_by_mesh(parameters, program) : 0;
    warn(out, slower > 0.05, "the mesh slows this wave by ", 100 * slower,
         " %, and the comparison expects that: a wavelength has ",
         double(parameters.grid.x.cells) / double(parameters.mode),
         " cells; refine the mesh for sound of the gas");
    const RegionCase& waves = region_with_flow(parameters, "wave");
    Case follows = parameters;
    follows.mode = waves.mode;
    const bool sound = waves.flow == "wave" && !waves.has_formula() &&
                       parameters.regions.size() == 1 && parameters.q_linear == 0;
    const double grown =
        sound ? std::pow(sound_wave_of(follows, program, scales.dt).amplification, scales.steps)
              : 1;
    warn(out, grown > 1.01, "explicit steps make sound grow, this wave by a factor ", grown,
         " until time.end",
         parameters.compare == wave_comparison.name ? ", and the comparison expects that" : "",
         ": lower time.cfl, or take flip with flip.mass = \"consistent\" and an even number of "
         "particles across a cell, whose sound does not");
    warn(out,
         program == "flip" && waves.flow == "wave" && !waves.has_formula() &&
             drowns_in_noise(parameters, waves),
         "with ", parameters.per_cell_x,
         " particles across a cell, an odd number, the wave of region.", waves.name,
         " stirs the lattice, and drowns in its noise: take an even number, or "
         "flip.density = \"particles\"");
    if (program == "flip" && !parameters.implicit()) warn_of_slow_flow(parameters, scales, out);
    // Sound is weak, also on gas that moves.
    const bool shocks =
        parameters.compare != wave_comparison.name &&
        (scales.mach > 0.5 || parameters.setup == "riemann" || !is_gentle(parameters, scales));
    warn(out,
         parameters.q_linear == 0 && parameters.q_quadratic == 0 && shocks &&
             !parameters.implicit() && scales.sound_speed > 0,
         program == "pic" ? "without artificial viscosity the method has none where the fluid "
                            "rests: behind a shock at a wall, density scatters by tens of percent"
                          : "without artificial viscosity particles pile up at shocks: set "
                            "viscosity.linear = 0.5 and viscosity.quadratic = 1");
    // As measured, of gas that is nearly at rest.
    const double cells = scales.sound_speed / parameters.grid.x.spacing(),
                 foldings = 0.25 * std::pow(cells * scales.dt, 2) * cells * parameters.end;
    warn(out,
         program == "flip" && parameters.transfer == "apic" && !parameters.implicit() &&
             parameters.q_linear == 0 && foldings > 5,
         "explicit steps of apic make the shortest sound waves grow where viscosity.linear = 0, by "
         "about exp(",
         foldings, ") until time.end: set it to 0.05, or flip.pressure = \"implicit\"");
    // As measured, of water at rest, on any mesh: with apic as with flip, with blend at three quarters of that
    // rate, with xpic at an eighth. A start at rest has round-off alone to grow from.
    const bool gathers = parameters.transfer != "xpic";
    const double across = double(std::min(parameters.per_cell_x, parameters.per_cell_z)),
                 fallen = (gathers ? 0.2 : 0.03) / across * parameters.end *
                          std::sqrt(std::fabs(parameters.gravity_x) / parameters.grid.x.spacing() +
                                    std::fabs(parameters.gravity_z) / parameters.grid.z.spacing());
    warn(out,
         program == "flip" && parameters.transfer != "pic" && parameters.plane() &&
             fallen > (parameters.compare == rest_comparison.name ? 15 : 4),
         "particles that gather within a cell fall, no pressure feels it, and the transfer of ",
         parameters.transfer, " lets it grow by about exp(", fallen,
         ") until time.end: ", gathers ? "set flip.transfer = \"xpic\"" : "lower time.end",
         ", or raise particles.per_cell_x and per_cell_z");
    // As measured, of gas nearly at rest. The density of a cell bends where a particle passes its
    // center, and an odd number across a cell puts one there: a lattice moved off it grows as slowly
    // as others, and so does density = "particles". In a row all is slower.
    const bool consistent = parameters.mass == "consistent";
    const double blended = parameters.transfer == "flip"    ? 1
                           : parameters.transfer == "blend" ? 0.4
                                                            : 0,
                 damped = std::max(0.0, 1 - parameters.q_linear / (consistent ? 0.06 : 0.1));
    const auto rate_of = [&](long n) {
        if (n == 1) return 0.0;  // not measured
        const bool bends = parameters.density == "cells" && n % 2 == 1;
        return !bends ? (parameters.plane() ? 0.002 : 0.0)
               : consistent
                   ? 0.45 * std::pow(double(n), -1.5)
                   : (0.04 - 0.05 * std::min(parameters.cfl, 0.3)) * std::pow(3 / double(n), 3.5);
    };
    const long in_x = parameters.per_cell_x, in_z = parameters.per_cell_z;
    const double of_x = rate_of(in_x) / parameters.grid.x.spacing(),
                 of_z = parameters.plane() ? rate_of(in_z) / parameters.grid.z.spacing() : 0,
                 swells = (parameters.plane() ? 1 : 0.05) * std::max(of_x, of_z) * blended *
                          damped * scales.sound_speed * parameters.end;
    const long worst = of_z > of_x ? in_z : in_x;
    warn(out,
         program == "flip" && !parameters.implicit() && parameters.loading == "lattice" &&
             !shocks && swells > 5,
         "with ", worst, " particles across a cell and viscosity.linear = ", parameters.q_linear,
         " weak flow grows by up to exp(", swells, ") until time.end",
         rate_of(worst) > 0.002
             ? ", for one of them is at the center, where the density of a cell bends"
             : "",
         ": set viscosity.linear = 0.2",
         consistent || parameters.density != "cells" ? "" : " or flip.transfer = \"xpic\"");
    const bool held = std::ranges::count(parameters.boundaries, "no_slip", &BoundaryCase::kind) > 0;
    warn(out, held && parameters.viscosity == 0,
         "a no_slip wall holds fluid without viscosity only through the mesh: set flip.viscosity, "
         "or make the wall slip");
    warn(out,
         program == "flip" && held && parameters.viscosity > 0 &&
             (parameters.transfer == "xpic" || parameters.transfer == "pic"),
         "beside a no_slip wall flip.transfer = \"", parameters.transfer,
         "\" brakes a viscous flow, in a channel of 16 cells by ",
         parameters.transfer == "pic" ? 58 : 14,
         " %, and more with shorter steps: set flip.transfer = \"flip\" or \"apic\"");
    warn(out,
         parameters.implicit() && scales.speed > 0.5 * scales.sound_speed &&
             scales.sound_speed > 0 && (parameters.dt == 0 || cells * parameters.dt > 1),
         "the flow has Mach ", scales.mach, ", above 0.5, and ",
         parameters.dt == 0
             ? "time.cfl with implicit pressure does not follow its sound"
             : sentence("sound crosses ", cells * parameters.dt, " cells in time.dt, above 1"),
         ": waves are damped");
}

// Liquid whose density is that of the cells. Its stiffness makes large pressures of what they miscount: in long steps
// these move it wherever something yields, and under its weight a surface above a void never comes to rest.
inline void warn_of_counted_liquid(const Case& parameters, const Scales& scales,
                                   std::vector<std::string>& out) {
    if (parameters.density != "cells") return;
    const RegionCase* liquid = nullptr;
    bool yields = false;
    double filled = 0;
    for (std::size_t n = 0; n < parameters.regions.size(); ++n) {
        const RegionScales& s = scales.regions[n];
        if (s.particles == 0) continue;
        filled += s.particles;
        const RegionCase& r = parameters.regions[n];
        if (material_of(parameters, r).p_infinity > 0)
            liquid = &r;
        else
            yields = true;
    }
    const bool bare = filled < 0.99 * double(parameters.grid.x.cells * parameters.grid.z.cells *
                                             parameters.per_cell_x * parameters.per_cell_z),
               heavy =
                   parameters.gravity_x != 0 || parameters.gravity_z != 0 || parameters.trap != 0;
    warn(out,
         liquid != nullptr &&
             (parameters.implicit() ? bare || yields : bare && heavy && scales.mach < 0.1),
         "flip.density = \"cells\" counts the particles of region.", liquid ? liquid->name : "",
         ", a liquid beside ", bare ? "a void" : "gas", ", and ",
         parameters.implicit() ? "steps of implicit pressure make" : "its weight makes",
         " flow of what is miscounted, also where nothing should move: set flip.density = "
         "\"particles\"");
}

// As measured, of tubes on 50 to 400 cells: what flows over the mesh of pic at less than Mach 0.6 behind a wave is
// noise of tens of percent of the pressure when sound has crossed a hundred cells, and on a finer mesh more.
inline void warn_of_ringing_tube(const Case& parameters, std::vector<std::string>& out) {
    if (parameters.setup != "riemann") return;
    const theory::RiemannSolution s = riemann_of(parameters);
    for (const bool left : {true, false}) {
        const theory::GasState& gas = left ? s.left_of_contact : s.right_of_contact;
        const double c = theory::sound_speed(gas);
        if (c == 0) continue;
        const double mach = std::fabs(gas.velocity + parameters.frame_x) / c,
                     crossed = c * parameters.end / parameters.grid.x.spacing();
        warn(out, mach > 0.01 && mach < 0.6 && crossed > 30, "the ", left ? "left" : "right",
             " fluid flows over the mesh at Mach ", mach,
             " behind its wave, below 0.6, where classical PIC rings, and sound crosses ", crossed,
             " cells there until time.end, more than 30: take flip, or fewer cells");
    }
}

// Waves on a free surface, or under light gas, that steps of implicit pressure make grow: the longest that
// the mesh holds, of the depth that the fluid has when it lies level.
//   omega^2 = g k tanh k h,   k = pi/length between walls, 2 pi/length around, 3.83/radius about an axis
inline void warn_of_surface_waves(const Case& parameters, const Scales& scales,
                                  std::vector<std::string>& out) {
    const bool along_z = std::fabs(parameters.gravity_z) >= std::fabs(parameters.gravity_x);
    const common::Axis &down = along_z ? parameters.grid.z : parameters.grid.x,
                       &level = along_z ? parameters.grid.x : parameters.grid.z;
    const double g = std::fabs(along_z ? parameters.gravity_z : parameters.gravity_x);
    if (g == 0 || !parameters.implicit() || parameters.theta == 1 || !parameters.plane() ||
        parameters.transfer == "pic" || down.periodic)
        return;
    double heaviest = 0, filled = 0;
    for (const RegionScales& r : scales.regions) heaviest = std::max(heaviest, r.lightest);
    for (const RegionScales& r : scales.regions)
        if (r.lightest > 0.1 * heaviest) filled += r.particles;
    filled /= double(parameters.grid.x.cells * parameters.grid.z.cells * parameters.per_cell_x *
                     parameters.per_cell_z);
    const double k = (parameters.grid.axisymmetric ? 3.8317
                      : level.periodic             ? 2 * pi
                                                   : pi) /
                     level.length,
                 omega = std::sqrt(g * k * std::tanh(k * filled * down.length)),
                 once = std::log(
                     theory::swinging_step(omega, parameters.theta, scales.dt).amplification),
                 grown = once * parameters.end / scales.dt;
    // A fluid that falls and comes to rest within a period is no wave.
    warn(out, filled < 0.98 && omega * parameters.end > 2 * pi && grown > 0.05, "steps of ",
         scales.dt, " with flip.theta = ", parameters.theta,
         ", below 1, make waves on the surface grow, the longest of this mesh, with a period of ",
         2 * pi / omega, ", by a factor of about ", std::exp(grown),
         " until time.end: set flip.theta = 1, or time.dt = ", 0.05 / grown * scales.dt);
}

// Runs that are over before anything crosses a cell: sound, the flow or a wall that slides, a fluid
// that falls, momentum that diffuses.
inline void warn_of_idleness(const Case& parameters, const Scales& scales,
                             std::vector<std::string>& out) {
    const auto &x = parameters.grid.x, &z = parameters.grid.z;
    const double dx = parameters.plane() ? std::min(x.spacing(), z.spacing()) : x.spacing(),
                 t = parameters.end, falls = std::hypot(parameters.gravity_x, parameters.gravity_z),
                 sound = parameters.implicit() ? scales.sound_speed / dx : 0,
                 crossed = std::max({(scales.rate + sound) * t, falls * t * t / dx,
                                     std::sqrt(parameters.trap) * t,
                                     parameters.viscosity * t / (dx * dx)});
    warn(out, t > 0 && crossed < 0.1, "until time.end = ", t, " sound or the flow crosses ",
         crossed, " cells, below 0.1: the run is over before anything happens; raise time.end");
}

}  // namespace detail

/// Warnings about a completed case that validate has let through.
inline std::vector<std::string> resolution_warnings(const Case& parameters, const Scales& scales,
                                                    const std::string& program) {
    std::vector<std::string> warnings;
    for (const FlipKey& key : keys_of_flip(parameters))
        warn(warnings, program == "pic" && key.changed, key.name, " = ", key.value,
             " means nothing to pic, whose particles are mass alone");
    for (const Material& a : parameters.materials)
        warn(warnings, program == "pic" && a.tension > 0, "material.", a.name,
             ".tension = ", a.tension, " means nothing to pic, whose cells hold none");
    detail::warn_of_idleness(parameters, scales, warnings);
    detail::warn_of_regions(parameters, scales, program, warnings);
    detail::warn_of_inflow(parameters, warnings);
    detail::warn_of_speeds(parameters, scales, program, warnings);
    if (program == "flip")
        detail::warn_of_counted_liquid(parameters, scales, warnings);
    else
        detail::warn_of_ringing_tube(parameters, warnings);
    if (program == "flip" && parameters.compare != "gravity_wave")
        detail::warn_of_surface_waves(parameters, scales, warnings);
    const double on_mesh = parameters.compare == interface_comparison.name && !parameters.implicit()
                               ? interface_rate_by_mesh(parameters, program)
                               : 0;
    warn(warnings, on_mesh > 0 && std::fabs(on_mesh - 1) > parameters.theory_tolerance,
         "on this mesh the wave grows at ", on_mesh,
         " of the rate of the fluids, beyond theory.tolerance = ", parameters.theory_tolerance,
         ": refine the mesh");
    const Comparison& comparison = comparison_of(parameters);
    if (comparison.warn != nullptr) comparison.warn(parameters, warnings);
    const std::vector<std::pair<const char*, double>> intervals{
        {"output.fields_interval", parameters.fields_interval},
        {"output.particles_interval", parameters.particles_interval}};
    for (const auto& [name, interval] : intervals)
        warn(warnings, interval > 0 && interval < scales.dt, name, " = ", interval,
             " is below the first time step, ", scales.dt, ": files are written every step");
    return warnings;
}

}  // namespace flip
