// Boundary conditions. Of particles, the same in both programs: around a periodic direction, out
// through an open boundary, in through an inflow; never through a wall. Of the nodes of flip: what
// velocity a node has on a boundary, and what pressure stands outside.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "common/run/sentence.hpp"
#include "flip/particles.hpp"
#include "flip/problem.hpp"

namespace flip {

/// The side of the mesh beyond which a position lies, or -1 on the mesh.
/// note: positions on a side count as on the mesh; a position that is not finite is beyond some side
[[gnu::always_inline]] inline int side_crossed(const Grid& grid, double x, double z) {
    const bool inside =
        x >= grid.x.low && x <= grid.x.high() && z >= grid.z.low && z <= grid.z.high();
    if (inside) return -1;
    if (!(x >= grid.x.low)) return x_low;
    if (!(x <= grid.x.high())) return x_high;
    return !(z >= grid.z.low) ? z_low : z_high;
}

/// A position wrapped around a periodic direction. In any other direction it stays, but for
/// round-off beyond a boundary, which is put on it.
[[gnu::always_inline]] inline double wrap(const common::Axis& axis, double position) {
    if (!axis.periodic) {
        const double low = axis.low, high = axis.high(), tiny = 1e-12 * axis.length;
        return position < low && position > low - tiny     ? low
               : position > high && position < high + tiny ? high
                                                           : position;
    }
    if (position < axis.low) {
        position += axis.length;
        return position < axis.high() ? position : axis.low;
    }
    return position < axis.high() ? position : std::max(position - axis.length, axis.low);
}

/// Whether gravity makes particles gather within cells and fall, undamped by the transfer.
inline bool gathers(const Problem& problem) {
    const Transfer& t = problem.scheme.transfer;
    return problem.scheme.particle_volumes && !t.filtered && t.part < 1 &&
           problem.body_force.gravity_x * problem.body_force.gravity_x +
                   problem.body_force.gravity_z * problem.body_force.gravity_z >
               0;
}

/// Whether the density of cells is that of a liquid in implicit steps, whose pressure is then noise.
inline bool boils(const Problem& problem) {
    return problem.scheme.implicit && !problem.scheme.particle_volumes &&
           std::ranges::any_of(problem.materials,
                               [](const Material& a) { return a.p_infinity > 0; });
}

/// Removes every particle that has left through an open or an inflow boundary.
/// in:     time, for the message
/// in/out: particles, already wrapped; first_of_row is void afterwards
/// out:    left(p) has been called for every particle that leaves, before it is overwritten
/// errors: NumericalError for a particle beyond a wall, or a position that is not finite
template <class Left>
void remove_outflow(const Problem& problem, double time, Particles& particles, const Left& left) {
    remove_if(particles, [&](long p) {
        const double x = particles.x_p[p], z = particles.z_p[p];
        const int side = side_crossed(problem.grid, x, z);
        if (side < 0) return false;
        const BoundaryKind kind = problem.boundaries.side[side].kind;
        if ((kind != BoundaryKind::open && kind != BoundaryKind::inflow) || !std::isfinite(x + z))
            common::fail(
                kind == BoundaryKind::periodic
                    ? "a particle has gone farther than the mesh is long, to x = "
                    : "a particle has gone through the wall to x = ",
                x, ", z = ", z, " at t = ", time, ": ",
                boils(problem) ? "cells count the particles of a liquid, and implicit steps make "
                                 "flow of that: set flip.density = \"particles\"; else "
                               : "",
                "reduce time.cfl, or time.dt where it is set; where that does not help, ",
                "particles make more noise than the flow: raise particles.per_cell_x",
                gathers(problem) ? ", or take flip.transfer = \"xpic\", with which fewer gather "
                                   "within cells and fall"
                                 : "");
        left(p);
        return true;
    });
}

/// Adds the particles that enter through inflow boundaries between t and t + dt. They come in
/// columns as far apart as on the lattice of the start; column n crosses the boundary at
/// t_n = (n + 1/2) step/speed, and stands where it has got to by t + dt.
/// out:    the numbers added through each side, in this order at the end of the columns; all columns
///         that are in use are filled
inline std::array<long, 4> add_inflow(const Problem& problem, double t, double dt,
                                      Particles& particles) {
    const Grid& grid = problem.grid;
    std::array<long, 4> added{};
    for (const Side side : all_sides) {
        if (!problem.boundaries.is(side, BoundaryKind::inflow)) continue;
        const Inflow& in = problem.boundaries.side[side].inflow;
        const bool along_x = is_x_side(side), low = is_low_side(side);
        const common::Axis &across = along_x ? grid.x : grid.z, &aside = along_x ? grid.z : grid.x;
        const double speed = (low ? 1 : -1) * (along_x ? in.vx : in.vz);
        if (speed <= 0) continue;
        const double step =
            across.spacing() / double(along_x ? problem.per_cell_x : problem.per_cell_z);
        const long per_cell = along_x ? problem.per_cell_z : problem.per_cell_x,
                   count = per_cell * aside.cells;
        const double width = aside.spacing() / double(per_cell);
        const auto columns_crossed = [&](double time) {
            return long(std::floor(time * speed / step + 0.5));
        };
        for (long n = columns_crossed(t); n < columns_crossed(t + dt); ++n) {
            const double depth = (t + dt) * speed - (double(n) + 0.5) * step;
            const double at = low ? across.low + depth : across.high() - depth;
            for (long k = 0; k < count; ++k) {
                const auto [beside, ring] =
                    along_x ? LatticeColumn{aside.low + (double(k) + 0.5) * width, 1}
                            : lattice_column(grid, per_cell, k);
                const auto add = [](std::vector<double>& column, bool used, double value) {
                    if (used) column.push_back(value);
                };
                const bool moving = has(particles.vx_p) || particles.x_p.empty();
                add(particles.vx_p, moving, in.vx);
                add(particles.vz_p, moving, in.vz);
                add(particles.e_p, moving, in.e);
                add(particles.V_p, problem.scheme.particle_volumes && moving, step * width * ring);
                for (auto* C :
                     {&particles.Cxx_p, &particles.Cxz_p, &particles.Czx_p, &particles.Czz_p})
                    add(*C, problem.scheme.transfer.affine && moving, 0.0);
                add(particles.L_p, problem.swirl, beside * (in.v_theta + in.Omega * beside));
                particles.x_p.push_back(along_x ? at : beside);
                particles.z_p.push_back(along_x ? beside : at);
                particles.m_p.push_back(in.rho * step * width * ring);
                particles.material.push_back(in.material);
                ++added[side];
            }
        }
    }
    return added;
}

/// Which components of a node's velocity are given by the boundaries that it lies on.
struct Held {
    bool x = false, z = false;
    double vx = 0, vz = 0;
};

/// Walls and inflow give the normal velocity; no-slip walls and inflow also the tangential one, unless
/// another boundary has given it at a corner.
/// in:     i from 0 to cells_x, j from 0 to cells_z
inline Held held_at(const Grid& grid, const Boundaries& boundaries, long i, long j) {
    Held held;
    const auto apply = [&](Side side) {
        const Boundary& b = boundaries.side[side];
        const bool along_x = is_x_side(side), inflow = b.kind == BoundaryKind::inflow;
        const Inflow& in = b.inflow;
        const double normal = !inflow ? 0 : (along_x ? in.vx : in.vz),
                     tangential = !inflow ? b.slide : (along_x ? in.vz : in.vx);
        const bool holds_tangential = b.kind == BoundaryKind::no_slip || inflow;
        if (b.kind == BoundaryKind::slip || holds_tangential) {
            (along_x ? held.x : held.z) = true;
            (along_x ? held.vx : held.vz) = normal;
        }
        if (holds_tangential && !(along_x ? held.z : held.x)) {
            (along_x ? held.z : held.x) = true;
            (along_x ? held.vz : held.vx) = tangential;
        }
    };
    if (i == 0) apply(x_low);
    if (i == grid.x.cells) apply(x_high);
    if (j == 0) apply(z_low);
    if (j == grid.z.cells) apply(z_high);
    return held;
}

/// Sets the components of nodes that the boundaries give.
/// in/out: velocities on the nodes
inline void set_walls(const Grid& grid, const Boundaries& boundaries, Field& vx, Field& vz) {
    const auto set = [&](long i, long j) {
        const Held held = held_at(grid, boundaries, i, j);
        const long n = grid.index(i, j);
        if (held.x) vx[n] = held.vx;
        if (held.z) vz[n] = held.vz;
    };
    for (long i = 0; i <= grid.x.cells; ++i) set(i, 0), set(i, grid.z.cells);
    for (long j = 0; j <= grid.z.cells; ++j) set(0, j), set(grid.x.cells, j);
}

/// Force of the pressure outside of open boundaries on a node, half as much on a corner; in rings,
/// what pressure_force() of the same pressure inside balances.
/// in:     i from 0 to cells_x, j from 0 to cells_z
inline Eigen::Vector2d boundary_force(const Grid& grid, const Boundaries& boundaries, long i,
                                      long j) {
    const auto reach = [](const common::Axis& axis, long k, double before, double after) {
        return 0.5 * axis.spacing() *
               ((axis.periodic || k > 0 ? before : 0) +
                (axis.periodic || k < axis.cells ? after : 0));
    };
    const auto pressure = [&](Side side, bool here) {
        return here && boundaries.is(side, BoundaryKind::open) ? boundaries.side[side].pressure : 0;
    };
    const auto ring = [&](double offset) { return ring_length(grid, double(i) + offset); };
    return {reach(grid.z, j, ring(0), ring(0)) *
                (pressure(x_low, i == 0) - pressure(x_high, i == grid.x.cells)),
            reach(grid.x, i, ring(-1. / 3), ring(1. / 3)) *
                (pressure(z_low, j == 0) - pressure(z_high, j == grid.z.cells))};
}

}  // namespace flip
