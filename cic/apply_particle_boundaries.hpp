// particles at walls: absorbed, reflected, or emitted again by a source.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "cic/poisson.hpp"
#include "cic/share_particles.hpp"
#include "common/random.hpp"
#include "common/run/sentence.hpp"

namespace cic {

/// What a wall does with the particles that have come behind it.
enum class AtWall { absorb, reflect, source };

/// What the source wall emits of one species.
struct Emission {
    double thermal_speed = 0;  // (T/m)^1/2 of the half-Maxwellian
    double per_step = 0;       // simulation particles in a step, also less than one
};

/// The boundary conditions of the particles.
struct ParticleBoundaries {
    std::array<AtWall, 4> walls{};   // by WallName; only x_low can be a source
    std::vector<Emission> emission;  // of each species
    double dt = 0;
    std::uint64_t seed = 0;                  // of the random numbers of the emission
    bool plane = false, magnetized = false;  // for the components of new particles
};

/// No particle is emitted faster than this times its thermal speed: (-2 log u)^1/2 is at most 8.65 for
/// the random numbers u.
inline constexpr double fastest_emitted = 8.7;

namespace detail {

// One wall, and the components of the particles that it can change.
struct Boundary {
    WallName name;
    double at;
    int outward;  // +1 or -1
    std::vector<Real>*x_p, *v_p;

    // Area of the wall; the mesh of one dimension is 1 high.
    double area(const Grid& grid) const {
        return name == x_low || name == x_high ? grid.z.length : grid.x.length;
    }
};

inline std::vector<Boundary> boundaries_around(const Grid& grid, Particles& s) {
    std::vector<Boundary> all;
    if (!grid.x.periodic) {
        all.push_back({x_low, grid.x.low, -1, &s.x_p, &s.vx_p});
        all.push_back({x_high, grid.x.high(), 1, &s.x_p, &s.vx_p});
    }
    if (!grid.z.periodic) {
        all.push_back({z_low, grid.z.low, -1, &s.z_p, &s.vz_p});
        all.push_back({z_high, grid.z.high(), 1, &s.z_p, &s.vz_p});
    }
    return all;
}

// The first wall that particle p is behind, or none.
inline const Boundary* crossed_wall(const std::vector<Boundary>& boundaries, long p) {
    for (const Boundary& boundary : boundaries)
        if (boundary.outward * (double((*boundary.x_p)[p]) - boundary.at) > 0) return &boundary;
    return nullptr;
}

// Indices of the particles that are behind a wall, in order.
inline std::vector<long> particles_outside(const Grid& grid, const Particles& s) {
    std::vector<std::vector<long>> of_block(common::block_count);
    const auto outside = [](const common::Axis& axis, Real x) {
        return !axis.periodic && (double(x) < axis.low || double(x) > axis.high());
    };
    common::for_each_block(s.count(), [&](int block, long begin, long end) {
        for (long p = begin; p < end; ++p)
            if (outside(grid.x, s.x_p[p]) || (!s.z_p.empty() && outside(grid.z, s.z_p[p])))
                of_block[block].push_back(p);
    });
    std::vector<long> all;
    for (const auto& part : of_block) all.insert(all.end(), part.begin(), part.end());
    return all;
}

// Takes particles out, given their indices in order; the last ones fill the gaps.
inline void remove(Particles& s, const std::vector<long>& indices) {
    if (common::rank_count() > 1) return remove_among_ranks(indices, s);
    for (std::vector<Real>* quantity : s.all()) {
        if (quantity->empty()) continue;
        for (auto p = indices.rbegin(); p != indices.rend(); ++p) {
            (*quantity)[*p] = quantity->back();
            quantity->pop_back();
        }
    }
}

// The random numbers of the n-th emission of one kind.
struct EmissionNumbers {
    std::uint64_t seed;
    std::uint32_t purpose;
    std::uint64_t n;
    double uniform(std::uint32_t draw) const { return common::uniform(seed, purpose, n, draw); }
    double gaussian(std::uint32_t draw) const { return common::gaussian(seed, purpose, n, draw); }
};

// Puts particle p at the wall at x_low, with the velocity of a half-Maxwellian weighted with the
// speed at which it leaves. It has been on its way for a random part of the step.
inline void emit(const Grid& grid, double dt, double v_th, const EmissionNumbers& random,
                 Particles& s, long p) {
    const double v_x = v_th * std::sqrt(-2 * std::log(random.uniform(0)));
    s.x_p[p] = Real(grid.x.low + random.uniform(1) * dt * v_x);
    s.vx_p[p] = Real(v_x);
    if (!s.vy_p.empty()) s.vy_p[p] = Real(v_th * random.gaussian(2));
    if (!s.vz_p.empty()) s.vz_p[p] = Real(v_th * random.gaussian(3));
}

// Treats the particles of one species that are behind a wall; what is absorbed is gone.
inline void apply_at_walls(const Grid& grid, const ParticleBoundaries& conditions, double v_th,
                           std::uint32_t purpose, long step, Particles& s, Walls& walls,
                           long& emitted_again) {
    const std::vector<Boundary> boundaries = boundaries_around(grid, s);
    const std::vector<long> outside = particles_outside(grid, s);
    std::vector<long> absorbed;
    // Charges are added to the walls, and particles emitted, in the order of the list: ranks take turns.
    struct {
        Walls walls;
        long emitted_again;
        bool leapt;
    } now{walls, emitted_again, false};
    common::in_turn(&now, std::array{0L, 1L}, [&](long) {
        for (const long p : outside) {
            for (int bounces = 0; const Boundary* wall = crossed_wall(boundaries, p); ++bounces) {
                now.leapt = now.leapt || bounces > 2;
                if (now.leapt) return;
                const AtWall does = conditions.walls[wall->name];
                if (does == AtWall::absorb) {
                    absorbed.push_back(p);
                    if (now.walls[wall->name].floating)
                        now.walls[wall->name].charge += s.q_p / wall->area(grid);
                    break;
                }
                if (does == AtWall::source) {
                    const auto count = std::uint64_t(now.emitted_again++);
                    emit(grid, conditions.dt, v_th, {conditions.seed, purpose, count}, s, p);
                } else {
                    Real &x = (*wall->x_p)[p], &v = (*wall->v_p)[p];
                    x = Real(2 * wall->at - double(x));
                    v = -v;
                }
            }
        }
    });
    if (now.leapt)
        common::fail(s.name, ": a particle moves farther than the box in one step, at step ", step,
                     ": reduce time.dt");
    walls = now.walls, emitted_again = now.emitted_again;
    remove(s, absorbed);
}

// Lets the source wall emit what is due in this step, at an even rate; the last rank gets it.
inline void emit_new(const Grid& grid, const ParticleBoundaries& conditions,
                     const Emission& emission, std::uint32_t purpose, long step, Particles& s,
                     Wall& source) {
    const auto emitted_before = [&](long steps) {
        return long(std::floor(emission.per_step * double(steps)));
    };
    const long first = emitted_before(step), last = emitted_before(step + 1);
    const bool is_ours = common::rank() + 1 == common::rank_count();
    const long old_count = s.count();
    if (s.count_of_all() + last - first > 2000000000)
        common::fail(s.name,
                     ": the source has filled the box with more than 2e9 particles, at step ", step,
                     ": lower its emission, or let a wall absorb them");
    if (is_ours) resize(old_count + last - first, conditions.plane, conditions.magnetized, s);
    for (long k = first; k < last; ++k) {
        source.charge -= s.q_p / grid.z.length;
        if (!is_ours) continue;
        const long p = old_count + k - first;
        const EmissionNumbers random{conditions.seed, purpose, std::uint64_t(k)};
        emit(grid, conditions.dt, emission.thermal_speed, random, s, p);
        if (conditions.plane) s.z_p[p] = Real(grid.z.low + grid.z.length * random.uniform(4));
    }
}

}  // namespace detail

/// Applies the boundary conditions to every particle behind a wall, and lets a source wall emit.
///   absorb:  the particle is gone, its charge is on the wall
///   reflect: x -> 2 x_wall - x, v -> -v
///   source:  it comes back with the half-Maxwellian of its species, v exp(-m v^2/2T)
/// in:     step, for the numbers of the emission
/// in/out: species, all particles on the mesh afterwards; walls, the charges of floating ones;
///         emitted_again, how many of each species the source has sent back
/// exact:  the charge of particles and walls together stays, but for what grounded walls absorb: a source
///         takes what it emits from its wall
/// note:   A reflected particle keeps the leapfrog centered where the wall has no field: its mirror image would
///         have moved so. A field on the wall leaves an error of first order in the step.
/// errors: NumericalError when a particle leaps over the whole box, or when they are too many
inline void apply_particle_boundaries(const Grid& grid, const ParticleBoundaries& conditions,
                                      long step, std::vector<Particles>& species, Walls& walls,
                                      std::vector<long>& emitted_again) {
    if (grid.x.periodic && grid.z.periodic) return;
    for (std::size_t k = 0; k < species.size(); ++k) {
        const Emission& emission = conditions.emission[k];
        const auto purpose = std::uint32_t(1000 + 2 * k);
        detail::apply_at_walls(grid, conditions, emission.thermal_speed, purpose, step, species[k],
                               walls, emitted_again[k]);
        if (emission.per_step > 0)
            detail::emit_new(grid, conditions, emission, purpose + 1, step, species[k],
                             walls[x_low]);
        share(species[k]);
    }
}

}  // namespace cic
