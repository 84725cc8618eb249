// What theory says about a case: its Riemann problem, its shock, the waves that grow in it.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "flip/setup/initial_state.hpp"
#include "flip/theory/acoustics.hpp"
#include "flip/theory/dam_break.hpp"
#include "flip/theory/diffusion.hpp"
#include "flip/theory/instabilities.hpp"
#include "flip/theory/riemann.hpp"
#include "flip/theory/sedov.hpp"
#include "flip/theory/shocks.hpp"

namespace flip {

/// The material of a region; the region must name one that exists.
inline const Material& material_of(const Case& w, const RegionCase& r) {
    return w.materials[static_cast<std::size_t>(material_index(w, r.gas.material))];
}

/// The first region with a flow, or the first of all.
inline const RegionCase& region_with_flow(const Case& w, std::string_view flow) {
    for (const RegionCase& r : w.regions)
        if (r.flow == flow) return r;
    return w.regions.front();
}

/// The sound speed of the uniform state of a region.
inline double sound_speed_of(const Case& w, const RegionCase& r) {
    return std::sqrt(stiffness(material_of(w, r), r.gas.pressure) / r.gas.density);
}

/// The wave number that the case follows.
inline double followed_wave_number(const Case& w) {
    return 2 * pi * static_cast<double>(w.mode) / w.grid.x.length;
}

/// The Riemann problem of a case, in the frame of theory.
inline theory::RiemannSolution riemann_of(const Case& w) {
    const auto side = [&](const SideCase& s) {
        return theory::GasState{s.density, s.velocity - w.frame_x, s.pressure, s.gamma,
                                s.p_infinity};
    };
    return theory::solve_riemann(side(w.left), side(w.right));
}

/// A wall along x that gas runs into.
struct StruckWall {
    theory::DrivenShock shock;
    bool at_low;  // the wall is x_low, and the shock runs towards larger x
    double density;
};
inline StruckWall struck_wall(const Case& w) {
    const RegionCase& r = w.regions.front();
    const Material& a = material_of(w, r);
    return {theory::driven_shock(std::fabs(r.gas.velocity_x), r.gas.density, r.gas.pressure,
                                 a.gamma, a.p_infinity),
            r.gas.velocity_x < 0, r.gas.density};
}

/// Cold gas that falls into a line, or in a row of cells into a plane.
inline theory::NohProblem noh_of(const Case& w) {
    const RegionCase& r = region_with_flow(w, "radial");
    return {material_of(w, r).gamma, w.plane() ? 2 : 1, r.gas.density, r.speed};
}

/// A blast: all its energy, with what mirrors behind slip walls add to it.
struct Blast {
    theory::BlastWave wave;
    double energy, density;
    double x, z;  // its middle
    double radius(double t) const { return theory::blast_radius(wave, energy, density, t); }
};
inline const RegionCase& hot_region(const Case& w) {
    for (const RegionCase& r : w.regions)
        if (r.energy > 0) return r;
    return w.regions.back();
}
inline Blast blast_of(const Case& w) {
    const RegionCase &hot = hot_region(w), &cold = w.regions.front();
    double energy = hot.energy / (w.plane() ? 1 : w.grid.z.length);
    const auto mirrored = [&](End low, const common::Axis& axis, double center) {
        const double near = 0.5 * axis.spacing();
        const bool at_low = w.ends[low].kind == "slip" && std::fabs(center - axis.low) <= near;
        const bool at_high =
            w.ends[low + 1].kind == "slip" && std::fabs(center - axis.high()) <= near;
        return at_low || at_high ? 2.0 : 1.0;
    };
    energy *= mirrored(x_low, w.grid.x, hot.center_x);
    if (w.plane()) energy *= mirrored(z_low, w.grid.z, hot.center_z);
    return {theory::blast_wave(material_of(w, cold).gamma, w.plane() ? 2 : 1), energy,
            cold.gas.density, hot.center_x, hot.center_z};
}

/// The region above an interface that the run follows.
inline const RegionCase& upper_region(const Case& w) {
    for (const RegionCase& r : w.regions)
        if (r.shape == "above") return r;
    return w.regions.back();
}

/// Heavy fluid above light fluid, between the ends in z.
inline theory::TwoLayers layers_of(const Case& w) {
    const RegionCase &lower = w.regions.front(), &upper = upper_region(w);
    theory::TwoLayers s;
    s.lower_density = lower.gas.density;
    s.upper_density = upper.gas.density;
    s.gravity = -w.gravity_z;
    s.lower_depth = upper.center_z - w.grid.z.low;
    s.upper_depth = w.grid.z.high() - upper.center_z;
    return s;
}

/// The layer of shear in the middle between the ends in z.
inline theory::ShearLayer shear_of(const Case& w) {
    const RegionCase& r = region_with_flow(w, "shear");
    return {2 * r.speed, r.width, 0.5 * w.grid.z.length};
}

/// Growth rate of the followed mode of an interface or of a layer of shear.
inline double theory_growth(const Case& w) {
    const double k = followed_wave_number(w);
    return w.compare == "rayleigh_taylor" ? theory::interface_growth(layers_of(w), k)
                                          : theory::shear_layer_growth(shear_of(w), k);
}

/// What one time step does to the followed sound wave, in the frame of the gas.
struct SoundWave {
    double frequency;      // c k
    double phase;          // by which a step turns it
    double amplification;  // by which a step multiplies it
};
inline SoundWave sound_wave_of(const Case& w, const std::string& program, double dt) {
    const RegionCase& r = region_with_flow(w, "wave");
    const double k = followed_wave_number(w), dx = w.grid.x.spacing(), c = sound_speed_of(w, r);
    const bool on_cells = program == "pic";
    // Differences over two cells, or from cells to the nodes between them.
    const double kappa = on_cells ? std::sin(k * dx) / dx : 2 * std::sin(0.5 * k * dx) / dx;
    const double a = c * kappa * dt;
    // In a gas 1/gamma of a change of pressure is that of density at constant energy; in a
    // stiffened gas it is (p + gamma p_infinity)/(gamma (p + p_infinity)).
    const Material& gas = material_of(w, r);
    const double p = r.gas.pressure, gamma = stiffness(gas, p) / (p + gas.gamma * gas.p_infinity);
    theory::WaveTransfer part;
    if (!on_cells) {
        const double once = theory::pic_smoothing(k, dx), lost = 1 - once;
        part.kick = part.energy = once;
        if (w.transfer == "pic") part.kept = once;
        if (w.transfer == "blend") part.kept = w.blend + (1 - w.blend) * once;
        if (w.transfer == "xpic") part.kept = 1 - std::pow(lost, static_cast<double>(w.xpic_order));
        // A particle of apic hands both nodes of its row what it has from them.
        if (w.transfer == "apic") part.kick = 1;
        // Motion changes the mass in a cell by what crosses its ends, with the velocity around them.
        part.density = w.density == "cells" ? 1 - 0.75 * lost : once;
    }
    const std::complex<double> factor =
        theory::carried_factor(w.implicit() ? w.theta : -1, gamma, a, part);
    return {c * k, std::arg(factor), std::abs(factor)};
}

/// The column of water of a broken dam: the last region, from x_low and z_low on.
struct WaterColumn {
    double width, height, density, gravity;
    std::size_t material;
};
inline WaterColumn water_of(const Case& w) {
    const RegionCase& r = w.regions.back();
    return {r.center_x + r.half_x - w.grid.x.low, r.center_z + r.half_z - w.grid.z.low,
            r.gas.density, -w.gravity_z,
            static_cast<std::size_t>(std::max(0, material_index(w, r.gas.material)))};
}

/// Who hits whom: the fastest region, and the first of another material.
struct Impact {
    const RegionCase *projectile, *target;  // null where there is none
};
inline Impact impact_of(const Case& w) {
    Impact s{&w.regions.front(), nullptr};
    const auto speed = [](const RegionCase& r) {
        return std::hypot(r.gas.velocity_x, r.gas.velocity_z);
    };
    for (const RegionCase& r : w.regions)
        if (speed(r) > speed(*s.projectile)) s.projectile = &r;
    const int material = material_index(w, s.projectile->gas.material);
    for (const RegionCase& r : w.regions)
        if (s.target == nullptr && r.shape == "box" &&
            material_index(w, r.gas.material) != material)
            s.target = &r;
    return s;
}

}  // namespace flip
