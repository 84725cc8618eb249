// particles at walls: absorbed, reflected, or emitted again by a source; only between walls.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "cic/setup/initial_state.hpp"

namespace cic {

namespace detail {

// Indices of the particles that are behind a wall, in order.
inline std::vector<long> particles_outside(const Grid& grid, const Particles& s) {
    std::vector<std::vector<long>> of_block(common::block_count);
    const auto outside = [](const common::Axis& axis, Real x) {
        return !axis.periodic && (double(x) < axis.low || double(x) > axis.high());
    };
    common::for_each_block(s.count(), [&](int block, long begin, long end) {
        for (long p = begin; p < end; ++p) {
            const auto n = static_cast<std::size_t>(p);
            if (outside(grid.x, s.x_p[n]) || (!s.z_p.empty() && outside(grid.z, s.z_p[n])))
                of_block[static_cast<std::size_t>(block)].push_back(p);
        }
    });
    std::vector<long> all;
    for (const auto& part : of_block) all.insert(all.end(), part.begin(), part.end());
    return all;
}

// Takes particles out, given their indices in order; the last ones fill the gaps.
inline void remove(Particles& s, const std::vector<long>& indices) {
    for (std::vector<Real>* quantity : s.all()) {
        if (quantity->empty()) continue;
        for (auto p = indices.rbegin(); p != indices.rend(); ++p) {
            (*quantity)[static_cast<std::size_t>(*p)] = quantity->back();
            quantity->pop_back();
        }
    }
}

// Numbers for the n-th emission of one kind.
struct EmissionNumbers {
    std::uint64_t seed;
    std::uint32_t purpose;
    std::uint64_t n;
    double uniform(std::uint32_t draw) const { return common::uniform(seed, purpose, n, draw); }
    double gaussian(std::uint32_t draw) const { return common::gaussian(seed, purpose, n, draw); }
};

// No particle is emitted faster than this times its thermal speed.
inline constexpr double fastest_emitted = 8.7;

// Velocity from the wall at x_low: half-Maxwellian weighted with the speed at which it leaves. The
// particle has been on its way for a random part of the step.
inline void emit(const Case& parameters, const SpeciesCase& from, const EmissionNumbers& random,
                 Particles& s, std::size_t n) {
    const double v_th = std::sqrt(from.emission_temperature / from.mass);
    const double v_x = v_th * std::sqrt(-2 * std::log(random.uniform(0)));
    s.x_p[n] = static_cast<Real>(parameters.grid.x.low + random.uniform(1) * parameters.dt * v_x);
    s.vx_p[n] = static_cast<Real>(v_x);
    if (!s.vy_p.empty()) s.vy_p[n] = static_cast<Real>(v_th * random.gaussian(2));
    if (!s.vz_p.empty()) s.vz_p[n] = static_cast<Real>(v_th * random.gaussian(3));
}

// One end of the box that is a wall, and the numbers of the particles that it can change.
struct End {
    WallName name;
    double at;
    int outward;  // +1 or -1
    std::vector<Real>*x_p, *v_p;
};

inline std::vector<End> walls_around(const Grid& grid, Particles& s) {
    std::vector<End> ends;
    if (!grid.x.periodic) {
        ends.push_back({x_low, grid.x.low, -1, &s.x_p, &s.vx_p});
        ends.push_back({x_high, grid.x.high(), 1, &s.x_p, &s.vx_p});
    }
    if (!grid.z.periodic) {
        ends.push_back({z_low, grid.z.low, -1, &s.z_p, &s.vz_p});
        ends.push_back({z_high, grid.z.high(), 1, &s.z_p, &s.vz_p});
    }
    return ends;
}

// The wall that a particle is behind, or none.
inline const End* wall_before(const std::vector<End>& ends, std::size_t n) {
    for (const End& end : ends)
        if (end.outward * (double((*end.x_p)[n]) - end.at) > 0) return &end;
    return nullptr;
}

// Area of a wall: 1 in one dimension.
inline double area_of(const Case& parameters, WallName wall) {
    if (parameters.dimensions == 1) return 1;
    return wall == x_low || wall == x_high ? parameters.grid.z.length : parameters.grid.x.length;
}

}  // namespace detail

/// Simulation particles of one species, of this weight, that a source wall emits in a step.
inline double emitted_per_step(const Case& parameters, const SpeciesCase& s, double weight) {
    return s.emission * parameters.dt *
           (parameters.dimensions == 2 ? parameters.grid.z.length : 1) / weight;
}

namespace detail {

// Lets the particles of one species that are behind a wall meet it; what is absorbed is gone.
inline void meet_ends(const Case& parameters, const SpeciesCase& from, std::uint32_t purpose,
                      long step, Particles& s, Walls& walls, long& emitted_again) {
    const std::vector<End> ends = walls_around(parameters.grid, s);
    std::vector<long> absorbed;
    for (const long p : particles_outside(parameters.grid, s)) {
        const auto n = static_cast<std::size_t>(p);
        for (int bounces = 0; const End* end = wall_before(ends, n); ++bounces) {
            const std::string& does = parameters.walls[end->name].particles;
            if (bounces > 2)
                throw common::NumericalError(
                    s.name + ": a particle moves farther than the box in one step, at step " +
                    std::to_string(step) + ": reduce time.dt");
            if (does == "absorb") {
                absorbed.push_back(p);
                if (walls[end->name].floating)
                    walls[end->name].charge += s.q_p / area_of(parameters, end->name);
                break;
            }
            if (does == "source") {
                const auto count = static_cast<std::uint64_t>(emitted_again++);
                emit(parameters, from,
                     {static_cast<std::uint64_t>(parameters.seed), purpose, count}, s, n);
            } else {
                Real &x = (*end->x_p)[n], &v = (*end->v_p)[n];
                x = static_cast<Real>(2 * end->at - double(x));
                v = -v;
            }
        }
    }
    remove(s, absorbed);
}

// Lets the source wall emit what is due in this step, at an even rate.
inline void emit_new(const Case& parameters, const SpeciesCase& from, std::uint32_t purpose,
                     long step, Particles& s, Walls& walls) {
    const double per_step = emitted_per_step(parameters, from, s.m_p / from.mass);
    const auto emitted_before = [&](long steps) {
        return static_cast<long>(std::floor(per_step * static_cast<double>(steps)));
    };
    const long first = emitted_before(step), last = emitted_before(step + 1);
    const long old_count = s.count(), new_count = old_count + last - first;
    if (new_count > 2000000000)
        throw common::NumericalError(
            s.name + ": the source has filled the box with more than 2e9 particles, at step " +
            std::to_string(step) + ": lower its emission, or let a wall absorb them");
    resize(parameters, new_count, s);
    for (long k = first; k < last; ++k) {
        const auto n = static_cast<std::size_t>(old_count + k - first);
        const EmissionNumbers random{static_cast<std::uint64_t>(parameters.seed), purpose,
                                     static_cast<std::uint64_t>(k)};
        emit(parameters, from, random, s, n);
        if (!s.z_p.empty())
            s.z_p[n] = static_cast<Real>(parameters.grid.z.low +
                                         parameters.grid.z.length * random.uniform(4));
        walls[x_low].charge -= s.q_p / area_of(parameters, x_low);
    }
}

}  // namespace detail

/// Lets every particle behind a wall meet it, and a source wall emit.
///   absorb: the particle is gone, its charge is on the wall
///   reflect: x -> 2 x_wall - x, v -> -v
///   source: it comes back with the half-Maxwellian of its species, v exp(-m v^2/2T)
/// in:     step, for the numbers of the emission
/// in/out: state: particles, all on the mesh afterwards, and charges of floating walls
/// exact:  the charge of particles and walls together changes by what a source emits, and that is
///         counted on the source wall
/// note:   A reflected particle keeps the leapfrog centered: its mirror image would have moved so.
/// errors: NumericalError when a particle leaps over the whole box, or when they are too many
inline void apply_particle_boundaries(const Case& parameters, long step, State& state) {
    if (!parameters.has_walls()) return;
    std::size_t index = 0;
    for (const SpeciesCase& from : parameters.species) {
        if (!from.mobile()) continue;
        Particles& s = state.species[index];
        const auto purpose = static_cast<std::uint32_t>(1000 + 2 * index);
        detail::meet_ends(parameters, from, purpose, step, s, state.walls,
                          state.emitted_again[index]);
        if (from.emission > 0)
            detail::emit_new(parameters, from, purpose + 1, step, s, state.walls);
        ++index;
    }
}

}  // namespace cic
