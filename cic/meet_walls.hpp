// particles at walls: absorbed, reflected, or emitted again by a source; only between walls.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "cic/initial_state.hpp"

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
inline void emit(const Case& w, const SpeciesCase& from, const EmissionNumbers& random,
                 Particles& s, std::size_t n) {
    const double v_th = std::sqrt(from.emission_temperature / from.mass);
    const double v_x = v_th * std::sqrt(-2 * std::log(random.uniform(0)));
    s.x_p[n] = static_cast<Real>(w.grid.x.low + random.uniform(1) * w.dt * v_x);
    s.vx_p[n] = static_cast<Real>(v_x);
    if (!s.vy_p.empty()) s.vy_p[n] = static_cast<Real>(v_th * random.gaussian(2));
    if (!s.vz_p.empty()) s.vz_p[n] = static_cast<Real>(v_th * random.gaussian(3));
}

// What one end of a direction does with a particle behind it: true when it is absorbed.
inline bool meet_end(const WallCase& wall, double at, double& x, Real& v) {
    if (wall.particles == "absorb") return true;
    x = 2 * at - x;
    v = -v;
    return false;
}

}  // namespace detail

/// Simulation particles of one species, of this weight, that a source wall emits in a step.
inline double emitted_per_step(const Case& w, const SpeciesCase& s, double weight) {
    return s.emission * w.dt * (w.dimensions == 2 ? w.grid.z.length : 1) / weight;
}

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
inline void meet_walls(const Case& w, long step, State& state) {
    if (!w.has_walls()) return;
    const Grid& grid = w.grid;
    const double area_x = w.dimensions == 2 ? grid.z.length : 1, area_z = grid.x.length;
    const auto seed = static_cast<std::uint64_t>(w.seed);
    std::size_t index = 0;
    for (const SpeciesCase& from : w.species) {
        if (!from.mobile()) continue;
        Particles& s = state.species[index];
        const auto purpose = static_cast<std::uint32_t>(1000 + 2 * index);
        std::vector<long> absorbed;
        for (const long p : detail::particles_outside(grid, s)) {
            const auto n = static_cast<std::size_t>(p);
            bool gone = false;
            for (int bounces = 0;; ++bounces) {
                double x = double(s.x_p[n]), z = s.z_p.empty() ? grid.z.low : double(s.z_p[n]);
                if (bounces > 2)
                    throw common::NumericalError(
                        s.name + ": a particle moves farther than the box in one step, at step " +
                        std::to_string(step) + ": reduce time.dt");
                if (!grid.x.periodic && x < grid.x.low && w.walls[x_low].particles == "source") {
                    detail::emit(
                        w, from,
                        {seed, purpose, static_cast<std::uint64_t>(state.emitted_again[index]++)},
                        s, n);
                    continue;
                }
                WallName wall = x_low;
                if (!grid.x.periodic && x < grid.x.low) {
                    gone = detail::meet_end(w.walls[x_low], grid.x.low, x, s.vx_p[n]);
                } else if (!grid.x.periodic && x > grid.x.high()) {
                    wall = x_high;
                    gone = detail::meet_end(w.walls[x_high], grid.x.high(), x, s.vx_p[n]);
                } else if (!s.z_p.empty() && !grid.z.periodic && z < grid.z.low) {
                    wall = z_low;
                    gone = detail::meet_end(w.walls[z_low], grid.z.low, z, s.vz_p[n]);
                } else if (!s.z_p.empty() && !grid.z.periodic && z > grid.z.high()) {
                    wall = z_high;
                    gone = detail::meet_end(w.walls[z_high], grid.z.high(), z, s.vz_p[n]);
                } else {
                    break;
                }
                if (gone) {
                    absorbed.push_back(p);
                    if (state.walls[wall].floating)
                        state.walls[wall].charge +=
                            s.q_p / (wall == x_low || wall == x_high ? area_x : area_z);
                    break;
                }
                s.x_p[n] = static_cast<Real>(x);
                if (!s.z_p.empty()) s.z_p[n] = static_cast<Real>(z);
            }
        }
        detail::remove(s, absorbed);

        // The source emits at an even rate.
        const double per_step = emitted_per_step(w, from, s.m_p / from.mass);
        const auto emitted_before = [&](long steps) {
            return static_cast<long>(std::floor(per_step * static_cast<double>(steps)));
        };
        const long first = emitted_before(step), last = emitted_before(step + 1);
        const auto old_count = static_cast<std::size_t>(s.count());
        if (s.count() + last - first > 2000000000)
            throw common::NumericalError(
                s.name + ": the source has filled the box with more than 2e9 particles, at step " +
                std::to_string(step) + ": lower its emission, or let a wall absorb them");
        const std::size_t new_count = old_count + static_cast<std::size_t>(last - first);
        s.x_p.resize(new_count);
        s.vx_p.resize(new_count);
        if (w.dimensions == 2) s.z_p.resize(new_count);
        if (w.magnetized()) s.vy_p.resize(new_count);
        if (w.magnetized() || w.dimensions == 2) s.vz_p.resize(new_count);
        for (long k = first; k < last; ++k) {
            const auto n = old_count + static_cast<std::size_t>(k - first);
            const detail::EmissionNumbers random{seed, purpose + 1, static_cast<std::uint64_t>(k)};
            detail::emit(w, from, random, s, n);
            if (!s.z_p.empty())
                s.z_p[n] = static_cast<Real>(grid.z.low + grid.z.length * random.uniform(4));
            state.walls[x_low].charge -= s.q_p / area_x;
        }
        ++index;
    }
}

}  // namespace cic
