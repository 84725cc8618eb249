// particles -> grid and grid -> particles: the sums over nodes that every step of the material point
// method is made of.
#pragma once

#include <algorithm>
#include <cstring>

#include "mpm_explicit/grid/grain_nodes.hpp"
#include "mpm_explicit/grid/places.hpp"

namespace mpm {

/// How particles and nodes see each other.
struct Scheme {
    enum Kind { linear, gimp, quadratic } shape = linear;
    double half = 0.25;  // gimp: half the side of a particle, in cells
    int width() const { return shape == linear ? 2 : 3; }
};

/// Returns work(shape) with the shape function of the scheme.
template <class Work>
auto with_shape(const Scheme& scheme, const Work& work) {
    if (scheme.shape == Scheme::linear) return work(LinearShape{});
    if (scheme.shape == Scheme::gimp) return work(GimpShape{scheme.half});
    return work(QuadraticShape{});
}

/// What particles take from their nodes.
struct Transfer {
    enum Affine { none, spin, affine } kind = none;  // mpm_explicit/affine_motion.hpp
    double flip = 1;                                 // the part of FLIP in their velocity
    double crossing = 0;                             // mpm_explicit/crossing.hpp
};

// Numbers that lie side by side and are worked on at once.
using Two [[gnu::vector_size(2 * sizeof(double))]] = double;
using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
template <class Vector>
[[gnu::always_inline]] inline Vector load(const double* from) {
    Vector v;
    std::memcpy(&v, from, sizeof v);
    return v;
}
template <class Vector>
[[gnu::always_inline]] inline void add(double* to, const Vector& what) {
    const Vector sum = load<Vector>(to) + what;
    std::memcpy(to, &sum, sizeof sum);
}

/// Which velocity of a node is meant: before the step, or after it.
struct OldVelocity {
    static Two of(const NodeMotion& v) { return load<Two>(&v.vx_0); }
};
struct NewVelocity {
    static Two of(const NodeMotion& v) { return load<Two>(&v.vx_1); }
};

namespace detail {

// What a particle adds to a node: m, px, py and mx with S; my, gx, gy and V with S, Gx, Gy and S.
struct Carried {
    Four first, second;
};
[[gnu::always_inline]] inline void add(NodeSums& node, double S, double Gx, double Gy,
                                       const Carried& carried) {
    mpm::add(&node.m, S * carried.first);
    mpm::add(&node.my, Four{S, Gx, Gy, S} * carried.second);
}

}  // namespace detail

/// Adds the sums on ghost nodes to their masters, and clears the ghosts.
/// exact:  totals of mass and volume stay; a wall sees the body and its mirror image
inline void reduce_ghost_sums(GrainNodes& nodes) {
    for (const GhostNode& ghost : nodes.ghosts()) {
        NodeSums& from = nodes.sums[ghost.dof];
        NodeSums& to = nodes.sums[ghost.master];
        const double flip_x = ghost.mirror_x ? -1 : 1, flip_y = ghost.mirror_y ? -1 : 1;
        const bool wraps = !ghost.mirror_x && !ghost.mirror_y;
        to.m += from.m, to.V += from.V;
        to.px += ghost.part_x * from.px, to.py += ghost.part_y * from.py;
        to.gx += flip_x * from.gx, to.gy += flip_y * from.gy;
        to.mx += ghost.mirror_x ? ghost.offset * from.m - from.mx
                                : from.mx - (wraps ? ghost.offset * from.m : 0);
        to.my += ghost.mirror_y ? ghost.offset * from.m - from.my : from.my;
        from = {};
    }
}
inline void reduce_ghost_force(GrainNodes& nodes) {
    for (const GhostNode& ghost : nodes.ghosts()) {
        NodeForce& from = nodes.force[ghost.dof];
        NodeForce& to = nodes.force[ghost.master];
        to.x += ghost.part_x * from.x;
        to.y += ghost.part_y * from.y;
        if (ghost.beyond >= 0) {
            NodeForce& beyond = nodes.force[ghost.beyond];
            beyond.x -= from.x, beyond.y -= from.y;
        }
        from = {};
    }
}

/// Fills the velocities of ghost nodes from their masters: the transpose of the reduction.
inline void fill_ghost_velocity(GrainNodes& nodes) {
    const auto& ghosts = nodes.ghosts();
    for (auto ghost = ghosts.rbegin(); ghost != ghosts.rend(); ++ghost) {
        const NodeMotion& from = nodes.motion[ghost->master];
        NodeMotion& to = nodes.motion[ghost->dof];
        to = {ghost->part_x * from.vx_0, ghost->part_y * from.vy_0, ghost->part_x * from.vx_1,
              ghost->part_y * from.vy_1};
        if (ghost->beyond < 0) continue;
        const NodeMotion& beyond = nodes.motion[ghost->beyond];
        to.vx_0 -= beyond.vx_0, to.vy_0 -= beyond.vy_0;
        to.vx_1 -= beyond.vx_1, to.vy_1 -= beyond.vy_1;
    }
}

/// Whether particles also put the force of the stress that they carry on the nodes.
struct WithForce {
    static constexpr bool value = true;
};
struct WithoutForce {
    static constexpr bool value = false;
};

/// P_i += sum_p m_p S_ip C_p (x_i - x_p), where particles carry affine motion.
/// exact:  the sum over nodes is zero
template <class Shape>
void add_affine_momentum(const Shape& shape, const Particles& particles, GrainNodes& nodes) {
    const Locator at(nodes.mesh());
    nodes.for_each_tile([&](const Tile& tile, std::size_t) {
        for (long k = tile.begin; k < tile.end; ++k) {
            const auto p = static_cast<std::size_t>(k);
            const double m = particles.m_p[p], cxx = particles.cxx_p[p], cxy = particles.cxy_p[p],
                         cyx = particles.cyx_p[p], cyy = particles.cyy_p[p];
            for_each_link(shape, at, nodes.origins(tile.grain), particles.x_p[p], particles.y_p[p],
                          [&](long dof, double S, double r_x, double r_y) {
                              nodes.sums[dof].px += S * m * (cxx * r_x + cxy * r_y);
                              nodes.sums[dof].py += S * m * (cyx * r_x + cyy * r_y);
                          });
        }
    });
}

/// m_i, P_i, and what contact needs, from the particles of every grain.
///   m_i = sum_p m_p S_ip,  P_i = sum_p m_p v_p S_ip,  f_i = - sum_p V_p sigma_p . grad S_ip
/// and affine motion where particles carry it.
/// out:    nodes.sums; nodes.force, zero without force
/// exact:  sum_i m_i = sum_p m_p and sum_i P_i = sum_p m_p v_p, to round-off; sum_i f_i = 0
template <class Force = WithoutForce, class Shape>
void particles_to_grid(const Shape& shape, const Particles& particles, GrainNodes& nodes) {
    nodes.drop_constraints();
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        std::fill(nodes.sums.begin() + begin, nodes.sums.begin() + end, NodeSums{});
        std::fill(nodes.force.begin() + begin, nodes.force.begin() + end, NodeForce{});
    });
    nodes.for_each_tile([&](const Tile& tile, std::size_t) {
        // Own to the tile: what is captured would be read again after every write to a node.
        const double *x_p = particles.x_p.data(), *y_p = particles.y_p.data(),
                     *vx_p = particles.vx_p.data(), *vy_p = particles.vy_p.data(),
                     *m_p = particles.m_p.data(), *V_p = particles.V_p.data(),
                     *sxx = particles.sxx_p.data(), *syy = particles.syy_p.data(),
                     *sxy = particles.sxy_p.data();
        const long* origin = nodes.origins(tile.grain);
        const Locator at(nodes.mesh());
        NodeSums* sums = nodes.sums.data();
        NodeForce* force = nodes.force.data();
        Places<Shape> places;
        for (long begin = tile.begin; begin < tile.end; begin += places.size) {
            const long count = std::min(places.size, tile.end - begin);
            places.find(shape, at, particles, begin, count);
            for (long k = 0; k < count; ++k) {
                const long p = begin + k;
                const double x = x_p[p], y = y_p[p], m = m_p[p], V = V_p[p];
                const Two minus_x = -V * Two{sxx[p], sxy[p]}, minus_y = -V * Two{sxy[p], syy[p]};
                const detail::Carried carried{{m, m * vx_p[p], m * vy_p[p], m * x},
                                              {m * y, V, V, V}};
                places.for_each_node(k, origin, [&](long dof, double S, double Gx, double Gy) {
                    detail::add(sums[dof], S, Gx, Gy, carried);
                    if constexpr (Force::value) add(&force[dof].x, Gx * minus_x + Gy * minus_y);
                });
            }
        }
    });
    if (particles.has_affine()) add_affine_momentum(shape, particles, nodes);
    reduce_ghost_sums(nodes);
}

/// Rigid grains give their nodes their velocity, before and after the step.
inline void prescribe_rigid_velocity(const std::vector<Grain>& grains,
                                     const std::vector<RigidMotion>& rigid, GrainNodes& nodes) {
    for (std::size_t g = 0; g < grains.size(); ++g) {
        if (!grains[g].rigid) continue;
        const int k = static_cast<int>(g);
        const RigidMotion& is = rigid[g];
        for (long i = nodes.dof_begin(k); i < nodes.dof_end(k); ++i)
            nodes.motion[i] = {is.vx, is.vy, is.vx, is.vy};
    }
}

/// v_i^0 = P_i/m_i, on walls without what they forbid; rigid grains move as they are told.
/// note:   However little mass a node has, its velocity counts in gradients.
inline void nodal_velocity(const std::vector<Grain>& grains, const std::vector<RigidMotion>& rigid,
                           GrainNodes& nodes) {
    common::for_each_block(nodes.size(), [&](int, long begin, long end) {
        for (long i = begin; i < end; ++i) {
            const auto n = static_cast<std::size_t>(i);
            const NodeSums& sum = nodes.sums[n];
            const double per_m = sum.m > 0 ? 1 / sum.m : 0;
            nodes.mass[n] = sum.m;
            nodes.motion[n] = {sum.px * per_m, sum.py * per_m, 0, 0};
        }
    });
    prescribe_rigid_velocity(grains, rigid, nodes);
    for (const long i : nodes.fixed_x()) nodes.motion[i].vx_0 = 0;
    for (const long i : nodes.fixed_y()) nodes.motion[i].vy_0 = 0;
    fill_ghost_velocity(nodes);
}

}  // namespace mpm
