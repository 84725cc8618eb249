// Particles at t = 0: where a species is, how fast it moves, and the perturbation it starts with.
#pragma once

#include <cmath>
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

/// Real particles in each simulation particle of a mobile species.
inline double particle_weight(const Case& parameters, const SpeciesCase& s) {
    return s.mean_density() * filled_volume(parameters, s) / double(particle_count(parameters, s));
}

/// Charge density of all fixed species.
inline double fixed_background(const Case& parameters) {
    double rho = 0;
    for (const SpeciesCase& s : parameters.species)
        if (!s.mobile()) rho += s.charge * s.mean_density();
    return rho;
}

namespace detail {

// Rows and columns of a lattice in each cell, as square as the number allows.
inline long lattice_columns(long per_cell) {
    long columns = long(std::sqrt(double(per_cell)));
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
    const Distribution& along_x = s.tables.x;
    const double x = along_x.given() ? along_x.inverse(u) : grid.x.low + grid.x.length * u;
    if (parameters.dimensions == 1) return {x, 0};
    const double v = load.uniform(purpose, s.loading == "random" ? 3 : 2, p);
    if (along_x.given()) {
        const auto piece = std::size_t((x - along_x.low) / along_x.step);
        return {x, s.tables.z[std::min(piece, s.tables.z.size() - 1)].inverse(v)};
    }
    if (s.profile == "layer") return {x, s.center_z + s.half_width * (2 * v - 1)};
    if (s.profile == "disk") {
        const double r = s.half_width * std::sqrt(u);
        return {s.center_x + r * std::cos(2 * pi * v), s.center_z + r * std::sin(2 * pi * v)};
    }
    return {x, grid.z.low + grid.z.length * v};
}

}  // namespace detail

/// Loads one species, its range of it where there are ranks.
///     x_p = even or random + displacements,  each -(A/k) sin(k x) along its k
///     and, for the ripple of a layer, z_p + ripple cos(k_x x)
///     v_p = drift + Maxwellian, and for a traveling wave + (omega/k - u) A cos(k x) along k
///     with formulas the inverse of the density, and of each distribution, of the same numbers
/// exact:  to first order in A the relative density is 1 + A cos(k x) + ...; a traveling wave is
///         that of theory where it is not damped
inline Particles load_species(const Case& parameters, const SpeciesCase& s, std::uint32_t purpose) {
    const Grid& grid = parameters.grid;
    const long count = particle_count(parameters, s);
    const bool plane = parameters.dimensions == 2;
    Particles particles;
    particles.name = s.name;
    const double weight = particle_weight(parameters, s);
    particles.q_p = weight * s.charge;
    particles.m_p = weight * s.mass;
    const long before = begin_of_rank(count, common::rank()),
               own = begin_of_rank(count, common::rank() + 1) - before;
    resize(own, plane, parameters.magnetized(), particles);
    particles.among_ranks = count;

    struct Seed {
        WaveVector k;
        double amplitude, phase_speed;  // the latter seen by the species
    };
    std::vector<Seed> seeds;
    for (const PerturbationCase& from : perturbations_of(parameters, s)) {
        const WaveVector k = wave_vector(parameters, from.mode_x, from.mode_z);
        const double speed =
            from.wave == "traveling"
                ? theory_of_wave(parameters, from.mode_x, from.mode_z).omega.real() / k.size() -
                      (s.drift_x * k.x + s.drift_z * k.z) / k.size()
                : 0;
        seeds.push_back({k, from.amplitude, speed});
    }
    const double k_ripple = wave_vector(parameters, s.mode_x, 0).x;
    const common::LoadingNumbers load{s.loading != "random", std::uint64_t(parameters.seed)};
    const std::array<double, 3> thermal{std::sqrt(s.temperature_x / s.mass),
                                        std::sqrt(s.temperature_y / s.mass),
                                        std::sqrt(s.temperature_z / s.mass)};
    // Small bases are quietest: the first belongs to the direction that has none yet.
    const std::array<unsigned, 3> base = plane ? std::array{3u, 7u, 5u} : std::array{2u, 5u, 3u};
    const std::size_t across_a = parameters.axis() == 0 ? 2 : 0,
                      across_b = parameters.axis() == 1 ? 2 : 1;
    const std::uint32_t velocities = 100 + purpose;
    for_each_own_block(count, [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) {
            const long n = before + p;  // its place among all
            detail::Position at = detail::position_of(parameters, s, purpose, load, n, count);
            std::array<double, 3> u = s.drift();
            for (std::size_t a = 0; a < 3; ++a) {
                if (thermal[a] > 0) u[a] += thermal[a] * load.gaussian(velocities, base[a], n);
                if (s.tables.v[a].given())
                    u[a] += s.tables.v[a].inverse(load.uniform(velocities, base[a], n));
            }
            if (s.tables.speed.given()) {
                const double speed = s.tables.speed.inverse(
                                 load.uniform(velocities, base[across_a], n)),
                             angle = 2 * pi * load.uniform(velocities, base[across_b], n);
                u[across_a] += speed * std::cos(angle), u[across_b] += speed * std::sin(angle);
            }
            const detail::Position unperturbed = at;
            for (const auto& [k, amplitude, phase_speed] : seeds) {
                const double phase =
                    k.x * (unperturbed.x - grid.x.low) + k.z * (unperturbed.z - grid.z.low);
                const double displacement = -amplitude / k.size() * std::sin(phase),
                             speed = phase_speed * amplitude * std::cos(phase);
                at.x += displacement * k.x / k.size(), u[0] += speed * k.x / k.size();
                at.z += displacement * k.z / k.size(), u[2] += speed * k.z / k.size();
            }
            if (s.ripple != 0) at.z += s.ripple * std::cos(k_ripple * (at.x - grid.x.low));
            if (!seeds.empty() || s.ripple != 0) {
                if (grid.x.periodic)
                    at.x -= grid.x.length * std::floor((at.x - grid.x.low) / grid.x.length);
                if (plane && grid.z.periodic)
                    at.z -= grid.z.length * std::floor((at.z - grid.z.low) / grid.z.length);
            }
            particles.x_p[p] = Real(at.x);
            particles.vx_p[p] = Real(u[0]);
            if (plane) particles.z_p[p] = Real(at.z);
            if (!particles.vy_p.empty()) particles.vy_p[p] = Real(u[1]);
            if (!particles.vz_p.empty()) particles.vz_p[p] = Real(u[2]);
        }
    });
    return particles;
}

}  // namespace cic
