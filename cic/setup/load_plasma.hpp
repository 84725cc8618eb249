// Particles at t = 0: where a species is, how fast it moves, and the perturbation it starts with.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "cic/theory/theory_of_case.hpp"
#include "common/random.hpp"

namespace cic {

/// The part of the mesh that a species fills: a length in one dimension, an area in two, and 1 for
/// a point.
inline double filled_volume(const Case& parameters, const SpeciesCase& s) {
    if (s.profile == "layer") return parameters.grid.x.length * 2 * s.half_width;
    if (s.profile == "disk") return pi * s.half_width * s.half_width;
    if (s.profile == "point") return 1;
    return parameters.grid.x.length * (parameters.dimensions == 2 ? parameters.grid.z.length : 1);
}

/// Simulation particles of a species.
inline long particle_count(const Case& parameters, const SpeciesCase& s) {
    if (!s.mobile()) return 0;
    if (s.profile == "point") return 1;
    const double cells = filled_volume(parameters, s) / parameters.grid.cell_area();
    return std::lround(double(s.particles_per_cell) * cells);
}

/// Charge density of all fixed species.
inline double fixed_background(const Case& parameters) {
    double rho = 0;
    for (const SpeciesCase& s : parameters.species)
        if (!s.mobile()) rho += s.charge * s.density;
    return rho;
}

namespace detail {

// Rows and columns of a lattice in each cell, as square as the number allows.
inline long lattice_columns(long per_cell) {
    long columns = static_cast<long>(std::sqrt(double(per_cell)));
    while (per_cell % columns != 0) --columns;
    return per_cell / columns;
}

struct Position {
    double x, z;
};

// Position of one particle before the perturbation.
inline Position position_of(const Case& parameters, const SpeciesCase& s, std::uint32_t purpose,
                            const common::LoadingNumbers& load, long p, long count) {
    const Grid& grid = parameters.grid;
    const double even = (double(p) + 0.5) / double(count);
    if (s.profile == "point") return {s.center_x, s.center_z};
    if (s.loading == "lattice" && parameters.dimensions == 2) {
        const long columns = lattice_columns(s.particles_per_cell) * grid.x.cells,
                   rows = count / columns;
        return {grid.x.low + grid.x.length * (double(p % columns) + 0.5) / double(columns),
                grid.z.low + grid.z.length * (double(p / columns) + 0.5) / double(rows)};
    }
    const double u = s.loading == "random" ? load.uniform(purpose, 2, p) : even;
    if (parameters.dimensions == 1) return {grid.x.low + grid.x.length * u, 0};
    const double v = load.uniform(purpose, s.loading == "random" ? 3 : 2, p);
    if (s.profile == "layer")
        return {grid.x.low + grid.x.length * u, s.center_z + s.half_width * (2 * v - 1)};
    if (s.profile == "disk") {
        const double r = s.half_width * std::sqrt(u);
        return {s.center_x + r * std::cos(2 * pi * v), s.center_z + r * std::sin(2 * pi * v)};
    }
    return {grid.x.low + grid.x.length * u, grid.z.low + grid.z.length * v};
}

}  // namespace detail

/// Loads one species.
///     x_p = even or random + displacement,  displacement = -(A/k) sin(k x) along k
///     and, for the ripple of a layer, z_p + ripple cos(k_x x)
///     v_p = drift + Maxwellian, and for a traveling wave + (omega/k - u) A cos(k x) along k
/// exact:  to first order in A the density is 1 + A cos(k x); a traveling wave is that of
///         theory where it is not damped
inline Particles load_species(const Case& parameters, const SpeciesCase& s, std::uint32_t purpose) {
    const Grid& grid = parameters.grid;
    const long count = particle_count(parameters, s);
    const bool plane = parameters.dimensions == 2;
    Particles particles;
    particles.name = s.name;
    const double weight = s.density * filled_volume(parameters, s) / double(count);
    particles.q_p = weight * s.charge;
    particles.m_p = weight * s.mass;
    resize(count, plane, parameters.magnetized(), particles);

    const WaveVector k = wave_vector(parameters, s.mode_x, s.mode_z);
    double phase_speed = 0;
    if (s.amplitude != 0 && s.wave == "traveling")
        phase_speed = theory_of_wave(parameters, s.mode_x, s.mode_z).omega.real() / k.size() -
                      (s.drift_x * k.x + s.drift_z * k.z) / k.size();
    const common::LoadingNumbers load{s.loading != "random",
                                      static_cast<std::uint64_t>(parameters.seed)};
    const double v_x = std::sqrt(s.temperature_x / s.mass),
                 v_y = std::sqrt(s.temperature_y / s.mass),
                 v_z = std::sqrt(s.temperature_z / s.mass);
    // Small bases are quietest: the first belongs to the direction that has none yet.
    const unsigned base_x = plane ? 3 : 2, base_z = plane ? 5 : 3, base_y = plane ? 7 : 5;
    const std::uint32_t velocities = 100 + purpose;
    common::for_each_block(count, [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) {
            detail::Position at = detail::position_of(parameters, s, purpose, load, p, count);
            double u_x = s.drift_x, u_y = s.drift_y, u_z = s.drift_z;
            if (v_x > 0) u_x += v_x * load.gaussian(velocities, base_x, p);
            if (v_y > 0) u_y += v_y * load.gaussian(velocities, base_y, p);
            if (v_z > 0) u_z += v_z * load.gaussian(velocities, base_z, p);
            if (s.amplitude != 0) {
                const double phase = k.x * (at.x - grid.x.low) + k.z * (at.z - grid.z.low);
                const double displacement = -s.amplitude / k.size() * std::sin(phase),
                             speed = phase_speed * s.amplitude * std::cos(phase);
                at.x += displacement * k.x / k.size(), u_x += speed * k.x / k.size();
                at.z += displacement * k.z / k.size(), u_z += speed * k.z / k.size();
            }
            if (s.ripple != 0) at.z += s.ripple * std::cos(k.x * (at.x - grid.x.low));
            if (s.amplitude != 0 || s.ripple != 0) {
                if (grid.x.periodic)
                    at.x -= grid.x.length * std::floor((at.x - grid.x.low) / grid.x.length);
                if (plane && grid.z.periodic)
                    at.z -= grid.z.length * std::floor((at.z - grid.z.low) / grid.z.length);
            }
            particles.x_p[p] = Real(at.x);
            particles.vx_p[p] = Real(u_x);
            if (plane) particles.z_p[p] = Real(at.z);
            if (!particles.vy_p.empty()) particles.vy_p[p] = Real(u_y);
            if (!particles.vz_p.empty()) particles.vz_p[p] = Real(u_z);
        }
    });
    return particles;
}

}  // namespace cic
