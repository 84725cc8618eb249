// How a run begins: particles on a lattice, each with the state of the fluid where it stands.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "common/random.hpp"
#include "flip/particles.hpp"
#include "flip/setup/case.hpp"
#include "flip/theory/vortex.hpp"

namespace flip {

/// The case as the programs use it: periodic directions marked, at least one material, a Riemann
/// problem written as two materials in two regions, or in one beside a vacuum, an inflow for every
/// end, and formulas read.
/// errors: InputError for a formula that is none
inline Case completed(Case parameters) {
    parameters.grid.axisymmetric = parameters.geometry == "axisymmetric";
    parameters.grid.x.periodic = parameters.is(x_low, "periodic");
    parameters.grid.z.periodic = parameters.is(z_low, "periodic");
    if (parameters.setup == "riemann") {
        const double x_end = parameters.grid.x.low + parameters.grid.x.length;
        parameters.materials = {};
        for (const auto& [name, s] :
             {std::pair{"left", parameters.left}, {"right", parameters.right}})
            parameters.materials.push_back({name, s.gamma, s.p_infinity, s.tension});
        const auto side = [&](const char* name, const SideCase& s, double from, double to) {
            RegionCase r;
            r.name = name;
            r.gas = {name, s.density, s.pressure, s.velocity, 0};
            r.shape = "box";
            r.center_x = 0.5 * (from + to);
            r.half_x = 0.5 * (to - from);
            r.center_z = parameters.grid.z.at(0.5 * double(parameters.grid.z.cells));
            r.half_z = parameters.grid.z.length;
            return r;
        };
        if (parameters.left.density > 0)
            parameters.regions.push_back(
                side("left", parameters.left, parameters.grid.x.low, parameters.interface));
        if (parameters.right.density > 0)
            parameters.regions.push_back(
                side("right", parameters.right, parameters.interface, x_end));
    }
    if (parameters.materials.empty()) parameters.materials = {{"gas", 1.4, 0}};
    for (BoundaryCase& end : parameters.boundaries) end.inflow = parameters.inflow;
    for (const InflowCase& in : parameters.inflows) {
        const auto end = std::ranges::find(side_names, in.name);
        if (end == side_names.end()) continue;  // refuse_boundaries() says so
        GasCase& gas = parameters.boundaries[end - side_names.begin()].inflow;
        gas = {in.material.empty() ? gas.material : in.material,
               in.density.value_or(gas.density),
               in.pressure.value_or(gas.pressure),
               in.velocity_x.value_or(gas.velocity_x),
               in.velocity_z.value_or(gas.velocity_z),
               in.velocity_theta.value_or(gas.velocity_theta),
               in.angular_velocity.value_or(gas.angular_velocity)};
    }
    // Of a tube with two gases the end brings its own.
    for (const Side s : {x_low, x_high}) {
        std::string& material = parameters.boundaries[s].inflow.material;
        if (parameters.setup == "riemann" && material.empty())
            material = s == x_low ? "left" : "right";
    }
    for (RegionCase& r : parameters.regions)
        for (common::Formula* f : {&r.gas.density, &r.gas.pressure, &r.gas.velocity_x,
                                   &r.gas.velocity_z, &r.gas.velocity_theta})
            f->read(parameters.constants);
    return parameters;
}

/// Index of a material by name; the first for an empty name, -1 for an unknown one.
inline int material_index(const Case& parameters, const std::string& name) {
    if (name.empty()) return 0;
    for (std::size_t k = 0; k < parameters.materials.size(); ++k)
        if (parameters.materials[k].name == name) return int(k);
    return -1;
}

/// The material of a region; the region must name one that exists.
inline const Material& material_of(const Case& parameters, const RegionCase& r) {
    return parameters.materials[material_index(parameters, r.gas.material)];
}

/// The first region with a flow, or the first of all.
inline const RegionCase& region_with_flow(const Case& parameters, std::string_view flow) {
    for (const RegionCase& r : parameters.regions)
        if (r.flow == flow) return r;
    return parameters.regions.front();
}

/// The sound speed of the uniform state of a region.
inline double sound_speed_of(const Case& parameters, const RegionCase& r) {
    return std::sqrt(stiffness(material_of(parameters, r), r.gas.pressure) / r.gas.density);
}

/// Whether all fluid begins at rest under gravity.
inline bool all_hydrostatic(const Case& parameters) {
    return std::ranges::all_of(parameters.regions,
                               [](const RegionCase& r) { return r.hydrostatic || r.is_vacuum(); });
}

/// The fluid at one place.
struct FluidState {
    int material = 0;
    double density = 0, vx = 0, vz = 0, e = 0;
    double v_theta = 0;  // about the axis
};

namespace detail {

inline bool contains(const Case& parameters, const RegionCase& r, double x, double z) {
    const double dx = x - r.center_x, dz = z - r.center_z;
    if (r.shape == "box") return std::fabs(dx) <= r.half_x && std::fabs(dz) <= r.half_z;
    if (r.shape == "disk") return dx * dx + dz * dz <= r.radius * r.radius;
    if (r.shape == "above") {
        const double k = 2 * pi * double(r.mode) / parameters.grid.x.length;
        return dz > r.ripple * std::cos(k * dx);
    }
    return true;
}

// The irrotational flow on both sides of an interface at z = 0 between walls: its normal velocity
// is 1 on the crest, and zero at the walls a distance `depth` away.
inline void overturn(double k, double x, double z, double depth, double amplitude, double& vx,
                     double& vz) {
    const double distance = depth - std::fabs(z), wall = std::sinh(k * depth);
    vz += amplitude * std::cos(k * x) * std::sinh(k * distance) / wall;
    vx += (z > 0 ? 1 : -1) * amplitude * std::sin(k * x) * std::cosh(k * distance) / wall;
}

// The velocity about the axis at (x, z).
inline double swirl_of(const RegionCase& r, double x, double z, double distance) {
    return r.gas.velocity_theta.at(x, z, distance) + r.gas.angular_velocity * x;
}

// The integral of f from a to b, by Gauss's rule of five points in each of 8, 16, ... 128 parts, until it
// changes by 1e-6 or less.
template <class Function>
double integral(double a, double b, const Function& f) {
    constexpr double at[] = {0, 0.5384693101056831, 0.9061798459386640};
    constexpr double weight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    double before = 0;
    for (int parts = 8;; parts *= 2) {
        const double part = (b - a) / parts;
        double sum = 0;
        for (int n = 0; n < parts; ++n)
            for (const int k : {-2, -1, 0, 1, 2}) {
                const std::size_t m = std::size_t(std::abs(k));
                sum +=
                    0.5 * part * weight[m] * f(a + part * (n + 0.5 + (k < 0 ? -0.5 : 0.5) * at[m]));
            }
        if (parts == 128 || (parts > 8 && std::fabs(sum - before) <= 1e-6 * std::fabs(sum)))
            return sum;
        before = sum;
    }
}

// The pressure at (x, z) above that of the center of a region: the integral of density times gravity
// and centrifugal force, along z and then along x, or the other way round, which is the same
// where the fluid can rest.
inline double weight_above(const Case& parameters, const RegionCase& r, double x, double z,
                           bool along_z_first = true) {
    const double x_0 = r.center_x, z_0 = r.center_z, g_x = parameters.gravity_x,
                 g_z = parameters.gravity_z;
    const auto distance = [&](double at_x, double at_z) {
        return std::hypot(at_x - x_0, at_z - z_0);
    };
    const auto outward = [&](double at_x, double at_z) {
        const double v = swirl_of(r, at_x, at_z, distance(at_x, at_z));
        return v * v / at_x;
    };
    const auto along_x = [&](double at_z, const auto& f) {
        return integral(x_0, x, [&](double at_x) { return f(at_x, at_z); });
    };
    if (r.gas.density.is_number() && along_z_first) {
        const double rho = r.gas.density, falls = rho * (g_x * (x - x_0) + g_z * (z - z_0));
        return r.turns() ? falls + rho * along_x(z, outward) : falls;
    }
    const auto rho = [&](double at_x, double at_z) {
        return r.gas.density.at(at_x, at_z, distance(at_x, at_z));
    };
    double sum = 0;
    if (g_z != 0)
        sum +=
            integral(z_0, z, [&](double at_z) { return g_z * rho(along_z_first ? x_0 : x, at_z); });
    if (g_x != 0 || r.turns())
        sum += along_x(along_z_first ? z : z_0, [&](double at_x, double at_z) {
            return rho(at_x, at_z) * (r.turns() ? g_x + outward(at_x, at_z) : g_x);
        });
    return sum;
}

}  // namespace detail

/// Index of the region at (x, z), the last that contains it; -1 in a vacuum.
inline long region_at(const Case& parameters, double x, double z) {
    long n = long(parameters.regions.size()) - 1;
    while (n >= 0 && !detail::contains(parameters, parameters.regions[n], x, z)) --n;
    return n >= 0 && parameters.regions[n].is_vacuum() ? -1 : n;
}

/// The fluid of one region at (x, z).
inline FluidState fluid_of(const Case& parameters, const RegionCase& r, double x, double z) {
    const int index = material_index(parameters, r.gas.material);
    const Material& a = parameters.materials[index];
    const double dx = x - r.center_x, dz = z - r.center_z, distance = std::hypot(dx, dz);
    const double k = 2 * pi * double(r.mode) / parameters.grid.x.length;
    const auto at = [&](const common::Formula& f) { return f.at(x, z, distance); };
    double rho = at(r.gas.density), p = at(r.gas.pressure), heat = 1;
    double vx = at(r.gas.velocity_x), vz = at(r.gas.velocity_z);
    if (r.hydrostatic) p += detail::weight_above(parameters, r, x, z);
    if (r.flow == "rotation") {
        vx -= r.speed * dz / r.width;
        vz += r.speed * dx / r.width;
    } else if (r.flow == "radial" && distance > 0) {
        const bool row = !parameters.plane();
        vx -= r.speed * (row ? (dx > 0 ? 1 : -1) : dx / distance);
        vz -= row ? 0 : r.speed * dz / distance;
    } else if (r.flow == "gresho") {
        const theory::GreshoVortex swirl = theory::gresho_vortex(2 * distance / r.width);
        p += rho * r.speed * r.speed * swirl.pressure;
        if (distance > 0) {
            vx -= r.speed * swirl.velocity * dz / distance;
            vz += r.speed * swirl.velocity * dx / distance;
        }
    } else if (r.flow == "wave") {
        const double c = std::sqrt(stiffness(a, p) / rho), crest = r.amplitude * std::cos(k * dx);
        p += stiffness(a, p) * crest;
        vx += c * crest;
        rho *= 1 + crest;
    } else if (r.flow == "gaussian") {
        heat += r.amplitude * std::exp(-0.5 * (parameters.plane() ? distance * distance : dx * dx) /
                                       (r.width * r.width));
    } else if (r.flow == "shear") {
        const double side = dz > 0 ? 1 : -1, decay = r.amplitude * std::exp(-k * std::fabs(dz));
        vx += r.speed * std::min(1.0, std::max(-1.0, dz / r.width));
        vx += side * decay * std::sin(k * dx);
        vz += decay * std::cos(k * dx);
    } else if (r.flow == "overturn") {
        const double depth =
            dz > 0 ? parameters.grid.z.high() - r.center_z : r.center_z - parameters.grid.z.low;
        detail::overturn(k, dx, dz, depth, r.amplitude, vx, vz);
    }
    return {
        index, rho, vx, vz, heat * internal_energy(a, rho, p), detail::swirl_of(r, x, z, distance)};
}

/// Particles of the start, cell by cell on a lattice of equal volumes.
/// in:     a completed case that validate() has not refused
/// out:    all columns that FLIP needs; unsorted; L_p = r v_theta where something turns
/// exact:  m_p is density times volume, so uniform fluid has equal masses; a particle of apic begins
///         with the gradient of the flow of its region
inline Particles load_particles(const Case& parameters) {
    constexpr std::uint32_t where = 1, how_fast = 2;
    Particles particles;
    const Grid& grid = parameters.grid;
    const double dx = grid.x.spacing() / double(parameters.per_cell_x),
                 dz = grid.z.spacing() / double(parameters.per_cell_z);
    const long columns = grid.x.cells * parameters.per_cell_x,
               rows = grid.z.cells * parameters.per_cell_z;
    const auto seed = std::uint64_t(parameters.seed);
    particles.swirl = parameters.swirls();
    std::vector<double> region_mass(parameters.regions.size(), 0.0);
    std::vector<long> region_of;
    for (long j = 0; j < rows; ++j) {
        for (long i = 0; i < columns; ++i) {
            const auto place = std::uint64_t(j * columns + i);
            const bool random = parameters.loading == "random";
            const double u = random ? common::uniform(seed, where, place, 0) : 0.5,
                         v = random ? common::uniform(seed, where, place, 1) : 0.5;
            const auto [x, ring] = lattice_column(grid, parameters.per_cell_x, i, random, u);
            const double z = grid.z.low + dz * (double(j) + v);
            const long n = region_at(parameters, x, z);
            if (n < 0) continue;
            const RegionCase& region = parameters.regions[n];
            const FluidState fluid = fluid_of(parameters, region, x, z);
            const double noise = region.noise * (2 * common::uniform(seed, how_fast, place, 0) - 1);
            particles.x_p.push_back(x);
            particles.z_p.push_back(z);
            particles.m_p.push_back(fluid.density * dx * dz * ring);
            particles.vx_p.push_back(fluid.vx + (region.noise > 0 ? noise : 0.0));
            particles.vz_p.push_back(fluid.vz);
            particles.e_p.push_back(fluid.e);
            if (particles.swirl) particles.L_p.push_back(x * fluid.v_theta);
            particles.material.push_back(fluid.material);
            if (parameters.density == "particles") particles.V_p.push_back(dx * dz * ring);
            region_mass[n] += fluid.density * dx * dz * ring;
            region_of.push_back(n);
        }
    }
    for (std::size_t p = 0; p < region_of.size(); ++p) {
        const long n = region_of[p];
        if (parameters.regions[n].energy > 0)
            particles.e_p[p] += parameters.regions[n].energy / region_mass[n];
    }
    if (parameters.transfer == "apic") {
        // Across half a cell: a jump then has no more energy in C_p than between two nodes.
        const double step_x = 0.5 * grid.x.spacing(), step_z = 0.5 * grid.z.spacing();
        for (std::size_t p = 0; p < region_of.size(); ++p) {
            const double x = particles.x_p[p], z = particles.z_p[p];
            const RegionCase& region = parameters.regions[region_of[p]];
            const FluidState left = fluid_of(parameters, region, x - step_x, z),
                             right = fluid_of(parameters, region, x + step_x, z),
                             below = fluid_of(parameters, region, x, z - step_z),
                             above = fluid_of(parameters, region, x, z + step_z);
            particles.Cxx_p.push_back((right.vx - left.vx) / (2 * step_x));
            particles.Cxz_p.push_back((above.vx - below.vx) / (2 * step_z));
            particles.Czx_p.push_back((right.vz - left.vz) / (2 * step_x));
            particles.Czz_p.push_back((above.vz - below.vz) / (2 * step_z));
        }
    }
    return particles;
}

}  // namespace flip
