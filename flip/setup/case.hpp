// Everything a case file of pic and flip can say: plain values with their defaults. One file serves
// both programs; how FLIP goes about it stands in sections of its own, which mean nothing to pic.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/grid.hpp"
#include "common/run/formula.hpp"
#include "common/run/output_file.hpp"
#include "common/run/sentence.hpp"
#include "flip/problem.hpp"

namespace flip {

using common::format, common::refuse, common::sentence, common::warn;

/// A state of the gas: of numbers, or of formulas of the place.
template <class Number>
struct GasOf {
    std::string material;  // empty: the first
    Number density = 1, pressure = 1, velocity_x = 0, velocity_z = 0;
    Number velocity_theta = 0;    // about the axis, beside the rigid rotation
    double angular_velocity = 0;  // of that
    bool operator==(const GasOf&) const = default;
};
using GasCase = GasOf<double>;

/// The fluid that enters at one end; what it does not say is that of [inflow].
struct InflowCase {
    std::string name;  // of the end
    std::string material;
    std::optional<double> density, pressure, velocity_x, velocity_z;
    std::optional<double> velocity_theta = {}, angular_velocity = {};
};

/// One side of a Riemann problem, with a material of its own.
struct SideCase {
    double density = 1, pressure = 1, velocity = 0, gamma = 1.4, p_infinity = 0, tension = 0;
    bool operator==(const SideCase&) const = default;
};

/// Where fluid is at the start, and how it moves; later regions replace earlier ones.
struct RegionCase {
    std::string name;
    GasOf<common::Formula> gas;
    std::string shape = "everywhere";  // or box, disk, above
    double center_x = 0, center_z = 0, half_x = 0, half_z = 0, radius = 0;
    double ripple = 0;             // of the lower edge of `above`
    std::string flow = "uniform";  // or rotation, radial, gresho, wave, gaussian, shear, overturn
    double speed = 0, width = 0, amplitude = 0;
    long mode = 1;
    double energy = 0;         // added, shared by the particles of the region
    bool hydrostatic = false;  // pressure is that of the center
    double noise = 0;          // random part of the velocity

    /// Density 0; region_at() finds no region there.
    bool is_vacuum() const { return gas.density.is_number() && double(gas.density) == 0; }
    bool has_formula() const {
        return !(gas.density.is_number() && gas.pressure.is_number() &&
                 gas.velocity_x.is_number() && gas.velocity_z.is_number() &&
                 gas.velocity_theta.is_number());
    }
    /// Whether the fluid turns about the axis.
    bool turns() const {
        return gas.angular_velocity != 0 || !gas.velocity_theta.is_number() ||
               double(gas.velocity_theta) != 0;
    }
};

/// One end of the mesh.
struct BoundaryCase {
    std::string kind = "periodic";  // or slip, no_slip, open, inflow
    double slide = 0;               // speed of a no-slip wall along itself
    double pressure = 0;            // outside an open end
    GasCase inflow = {};            // made by completed()
};

/// A complete input. Any consistent units; per unit length along y, or axisymmetric.
struct Case {
    common::Grid grid{{100, 0, 1, true}, {1, 0, 1, true}};
    std::string geometry = "plane";  // or axisymmetric
    std::array<BoundaryCase, 4> boundaries;
    GasCase inflow;
    std::vector<InflowCase> inflows;

    double cfl = 0.3, dt = 0, end = 1;
    double energy_limit = 10;

    std::vector<Material> materials;
    std::string setup = "regions";  // or riemann
    double interface = 0.5;
    SideCase left, right{0.125, 0.1, 0, 1.4, 0};
    std::vector<RegionCase> regions;
    std::vector<common::Constant> constants;  // of formulas
    long per_cell_x = 4, per_cell_z = 4;
    std::string loading = "lattice";  // or random
    long seed = 1;

    double q_linear = 0.5, q_quadratic = 1;
    double gravity_x = 0, gravity_z = 0, trap = 0;

    // What only FLIP has.
    std::string transfer = "flip";  // pic, blend, apic, xpic
    double blend = 0.97;
    long xpic_order = 2;
    std::string mass = "lumped";  // or consistent
    bool deficit_to_heat = true;
    std::string density = "cells";  // or particles
    double filling = 0.1;
    bool confined = false;
    double viscosity = 0;
    std::string pressure = "explicit";  // or implicit
    double theta = 1;
    double tolerance = 1e-8;
    long max_iterations = 1000;
    long rezone_steps = 0, min_particles = 4, max_particles = 32;

    // What the run is compared with.
    std::string compare = "none";
    double theory_tolerance = 0.05;
    double frame_x = 0, frame_z = 0;  // velocity of the frame in which theory is stated
    long mode = 1;

    double fields_interval = 0, particles_interval = 0;
    common::FileFormats also;
    long checkpoint_steps = 0;

    /// Whether what the lumped masses owe the particles goes to heat; consistent ones owe nothing.
    bool heats() const { return deficit_to_heat && mass == "lumped"; }
    bool implicit() const { return pressure == "implicit"; }
    bool plane() const { return grid.z.cells > 1; }
    /// Whether something can move along z; where nothing does, files have no columns of it.
    bool moves_along_z() const {
        const auto at_end = [](const BoundaryCase& b) { return b.slide != 0; };
        const auto at_inflow = [](const InflowCase& i) { return i.velocity_z.value_or(0) != 0; };
        const auto in_region = [](const RegionCase& r) {
            const common::Formula& v = r.gas.velocity_z;
            return !v.is_number() || double(v) != 0;
        };
        return plane() || inflow.velocity_z != 0 || std::ranges::any_of(boundaries, at_end) ||
               std::ranges::any_of(inflows, at_inflow) || std::ranges::any_of(regions, in_region);
    }
    /// Whether something turns about the axis: only then particles carry angular momentum.
    bool swirls() const {
        const auto of_inflow = [](const GasCase& g) {
            return g.velocity_theta != 0 || g.angular_velocity != 0;
        };
        const auto at_end = [](const InflowCase& i) {
            return i.velocity_theta.value_or(0) != 0 || i.angular_velocity.value_or(0) != 0;
        };
        return of_inflow(inflow) || std::ranges::any_of(inflows, at_end) ||
               std::ranges::any_of(regions, &RegionCase::turns);
    }
    bool is(Side e, const char* kind) const { return boundaries[e].kind == kind; }
};

}  // namespace flip
