// on the mesh: forces on the nodes and their velocities in the Lagrangian phase, from pressure,
// viscosity and gravity.
#pragma once

#include <array>
#include <cmath>

#include "flip/boundaries.hpp"
#include "flip/flip/artificial_viscosity.hpp"

namespace flip {

/// Acceleration by gravity and trap on a node.
///   a = g + trap (x_middle - x)
/// note:   the two images of a node at the seam of a periodic direction are as far from the middle
///         on either side: there the trap does not accelerate
inline Eigen::Vector2d node_acceleration(const Grid& grid, const BodyForce& force, long i, long j) {
    const auto along = [&](const common::Axis& axis, double gravity, long k) {
        const bool seam = axis.periodic && (k == 0 || k == axis.cells);
        const double x = axis.at(seam ? 0.5 * double(axis.cells) : double(k));
        return gravity + force.trap * (axis.low + 0.5 * axis.length - x);
    };
    return {along(grid.x, force.gravity_x, i), along(grid.z, force.gravity_z, j)};
}
inline Eigen::Vector2d node_acceleration(const Grid& grid, const BodyForce& force, long n) {
    return node_acceleration(grid, force, n % grid.stride() - 1, n / grid.stride() - 1);
}

namespace detail {

// The gradients of the four corner functions at one of the four points of Gauss's rule, for a
// velocity that is bilinear in a cell of column i: x derivatives and z derivatives; in rings also
// S/r, of which the strain v_r/r around the axis is made. ring is the length of the ring there.
struct CornerGradients {
    double x[4], z[4], hoop[4], ring;
};
inline std::array<CornerGradients, 4> corner_gradients(const Grid& grid, long i) {
    const double near = 0.5 - 0.5 / std::sqrt(3.0), dx = grid.x.spacing(), dz = grid.z.spacing();
    std::array<CornerGradients, 4> all;
    for (std::size_t k = 0; k < 4; ++k) {
        const double fx = k & 1 ? 1 - near : near, fz = k & 2 ? 1 - near : near;
        const double node = double(i) + fx, per_r = grid.axisymmetric ? 1 / grid.x.at(node) : 0;
        all[k] = {{-(1 - fz) / dx, (1 - fz) / dx, -fz / dx, fz / dx},
                  {-(1 - fx) / dz, -fx / dz, (1 - fx) / dz, fx / dz},
                  {per_r * (1 - fx) * (1 - fz), per_r * fx * (1 - fz), per_r * (1 - fx) * fz,
                   per_r * fx * fz},
                  ring_length(grid, node)};
    }
    return all;
}

// Stress of a Newtonian fluid, mu (grad v + grad v^T - (2/3) div v), at one point.
struct ViscousStress {
    double xx, zz, xz, hoop;
};
inline ViscousStress viscous_stress(double mu, const CornerGradients& d,
                                    const std::array<long, 4>& n, const Field& vx,
                                    const Field& vz) {
    double xx = 0, zz = 0, xz = 0, hoop = 0;
    for (std::size_t a = 0; a < 4; ++a) {
        xx += d.x[a] * vx[n[a]];
        zz += d.z[a] * vz[n[a]];
        xz += d.z[a] * vx[n[a]] + d.x[a] * vz[n[a]];
        hoop += d.hoop[a] * vx[n[a]];
    }
    const double mean = (xx + zz + hoop) * 2 / 3;
    return {mu * (2 * xx - mean), mu * (2 * zz - mean), mu * xz, mu * (2 * hoop - mean)};
}

}  // namespace detail

/// Fills the ghosts of a pressure: around a periodic direction the other side, else nothing. A wall
/// holds its nodes itself, and boundary_force() is what acts on an open boundary.
template <class Values>
void fill_pressure(const Grid& grid, Values& p) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    const typename Values::value_type none{};
    for (long j = 0; j < nz; ++j) {
        p[grid.index(-1, j)] = grid.x.periodic ? p[grid.index(nx - 1, j)] : none;
        p[grid.index(nx, j)] = grid.x.periodic ? p[grid.index(0, j)] : none;
    }
    for (long i = -1; i <= nx; ++i) {
        p[grid.index(i, -1)] = grid.z.periodic ? p[grid.index(i, nz - 1)] : none;
        p[grid.index(i, nz)] = grid.z.periodic ? p[grid.index(i, 0)] : none;
    }
}

/// Adds the viscous force of the fluid, from the velocities before the step.
///   F_g -= sum over cells of the integral of tau . grad S_g, by Gauss's rule of four points
/// exact:  forces sum to zero but for walls, in rings along z alone; a rigid motion feels none
inline void add_viscous_force(const Grid& grid, double viscosity, Mesh& mesh) {
    if (viscosity == 0) return;
    Nodes& g = mesh.nodes;
    const double area = 0.25 * grid.cell_area();
    common::for_each_row_colored(2, grid.z.cells, [&](long j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const long n = grid.index(i, j);
            if (has_bare_node(grid, g, n)) continue;
            const auto corners = corners_of(grid, n);
            for (const detail::CornerGradients& d : detail::corner_gradients(grid, i)) {
                const auto tau = detail::viscous_stress(viscosity, d, corners, g.vx0, g.vz0);
                const double part = area * d.ring;
                for (std::size_t a = 0; a < 4; ++a) {
                    g.fx[corners[a]] -=
                        part * (tau.xx * d.x[a] + tau.xz * d.z[a] + tau.hoop * d.hoop[a]);
                    g.fz[corners[a]] -= part * (tau.xz * d.x[a] + tau.zz * d.z[a]);
                }
            }
        }
    });
    fold_nodes(grid, g.fx.data());
    fold_nodes(grid, g.fz.data());
}

/// Heat that viscosity makes in one cell per time, from stresses of v^0 and the motion v_bar.
inline double viscous_heating(const Grid& grid, double viscosity, const Nodes& g, const Field& vx,
                              const Field& vz, long n) {
    if (has_bare_node(grid, g, n)) return 0;
    const auto corners = corners_of(grid, n);
    double sum = 0;
    for (const detail::CornerGradients& d : detail::corner_gradients(grid, column_of(grid, n))) {
        const auto tau = detail::viscous_stress(viscosity, d, corners, g.vx0, g.vz0);
        for (std::size_t a = 0; a < 4; ++a)
            sum += d.ring *
                   (vx[corners[a]] * (tau.xx * d.x[a] + tau.xz * d.z[a] + tau.hoop * d.hoop[a]) +
                    vz[corners[a]] * (tau.xz * d.x[a] + tau.zz * d.z[a]));
    }
    return 0.25 * grid.cell_area() * sum;
}

/// Lets the pressure outside of open boundaries into the voids that reach to them, so that it acts on the
/// surface of fluid that has left its end.
/// in:     cells.M, surface
/// out:    cells.outside
/// errors: NumericalError where a void reaches to ends of different pressures
inline void fill_voids(const Grid& grid, const Boundaries& boundaries, Cells& c) {
    const auto open = [&](Side side) { return boundaries.is(side, BoundaryKind::open); };
    if (std::ranges::none_of(all_sides, [&](Side side) {
            return open(side) && boundaries.side[side].pressure != 0;
        }))
        return;
    c.outside.setConstant(grid.size(), NAN);
    std::vector<std::pair<long, double>> found;
    const auto enter = [&](long i, long j, double pressure) {
        const auto wrapped = [](const common::Axis& axis, long k) {
            return axis.periodic ? (k + axis.cells) % axis.cells : k;
        };
        i = wrapped(grid.x, i), j = wrapped(grid.z, j);
        if (i < 0 || j < 0 || i >= grid.x.cells || j >= grid.z.cells) return;
        const long n = grid.index(i, j);
        if (c.M[n] > 0 && c.surface[n] == 0) return;
        if (c.outside[n] != pressure && !std::isnan(c.outside[n]))
            common::fail("a void reaches to open ends with the pressures ", pressure, " and ",
                         c.outside[n], ", and has one: make them alike, or close an end");
        if (c.outside[n] != pressure) found.emplace_back(n, c.outside[n] = pressure);
    };
    for (const Side side : all_sides) {
        if (!open(side)) continue;
        const long last = is_low_side(side) ? 0 : (is_x_side(side) ? grid.x : grid.z).cells - 1;
        for (long k = 0; k < (is_x_side(side) ? grid.z : grid.x).cells; ++k)
            enter(is_x_side(side) ? last : k, is_x_side(side) ? k : last,
                  boundaries.side[side].pressure);
    }
    while (!found.empty()) {
        const auto [n, pressure] = found.back();
        found.pop_back();
        const long i = column_of(grid, n), j = n / grid.stride() - 1;
        enter(i - 1, j, pressure), enter(i + 1, j, pressure);
        enter(i, j - 1, pressure), enter(i, j + 1, pressure);
    }
    c.outside = c.outside.array().isNaN().select(0.0, c.outside);
    fill_pressure(grid, c.outside);
}

/// Force of the pressure outside of open boundaries on a node: through them, and across the voids beside
/// them.
inline Eigen::Vector2d outside_force(const Grid& grid, const Boundaries& boundaries, const Cells& c,
                                     long i, long j, long n) {
    Eigen::Vector2d F =
        c.outside.size() > 0 ? pressure_force(grid, c.outside, n) : Eigen::Vector2d(0, 0);
    if (i == 0 || j == 0 || i == grid.x.cells || j == grid.z.cells)
        F += boundary_force(grid, boundaries, i, j);
    return F;
}

/// The forces that are known before the step: q, the viscosity of the fluid, and the pressure
/// outside of open boundaries.
/// out:    nodes.fx, fz
inline void find_known_forces(const Grid& grid, const Boundaries& boundaries, double viscosity,
                              Mesh& mesh) {
    Nodes& g = mesh.nodes;
    double *const fx = g.fx.data(), *const fz = g.fz.data();
    for_each_node(grid, [=](long, long, long n) { fx[n] = fz[n] = 0; });
    add_viscous_force(grid, viscosity, mesh);
    fill_pressure(grid, mesh.cells.q);
    for_each_node(grid, [=, &boundaries, &c = mesh.cells](long i, long j, long n) {
        const Eigen::Vector2d F =
            stress_force(grid, c.q, n) + outside_force(grid, boundaries, c, i, j, n);
        fx[n] += F[0];
        fz[n] += F[1];
    });
}

/// Velocities after the Lagrangian phase.
///   v_g^L = v_g^0 + dt (F_g/m_g + a_g),  a_g of node_acceleration();  held by the walls
/// in:     nodes.vx0, vz0; cells.p_step inside, the pressure that acts in this step; known forces
/// in/out: nodes.fx, fz: with the force of pressure
/// out:    nodes.vxL, vzL, 0 on nodes without mass
/// exact:  internal forces sum to zero, in rings along z alone
/// source: [FLIP-6]
inline void accelerate_nodes(const Problem& problem, double dt, Mesh& mesh) {
    const Grid& grid = problem.grid;
    Nodes& g = mesh.nodes;
    fill_pressure(grid, mesh.cells.p_step);
    const Values p = mesh.cells.p_step, m = g.m, vx0 = g.vx0, vz0 = g.vz0;
    double *const fx = g.fx.data(), *const fz = g.fz.data(), *const vxL = g.vxL.data(),
                  *const vzL = g.vzL.data();
    for_each_node(grid, [=, force = problem.body_force](long i, long j, long n) {
        const Eigen::Vector2d F = pressure_force(grid, p, n);
        fx[n] += F[0];
        fz[n] += F[1];
        const double per_mass = m[n] > 0 ? 1 / m[n] : 0;
        const Eigen::Vector2d a = node_acceleration(grid, force, i, j);
        vxL[n] = per_mass > 0 ? vx0[n] + dt * (per_mass * fx[n] + a[0]) : 0;
        vzL[n] = per_mass > 0 ? vz0[n] + dt * (per_mass * fz[n] + a[1]) : 0;
    });
    set_walls(grid, problem.boundaries, g.vxL, g.vzL);
}

/// Adds what a change of the pressure does.
///   F_g += D^T p,  v_g^L += dt D^T p/m_g
/// in:     cells.p_step, the change inside
/// in/out: nodes.fx, fz, vxL, vzL of accelerate_nodes()
inline void push_nodes(const Problem& problem, double dt, Mesh& mesh) {
    const Grid& grid = problem.grid;
    Nodes& g = mesh.nodes;
    fill_pressure(grid, mesh.cells.p_step);
    for_each_node(grid, [&](long, long, long n) {
        const Eigen::Vector2d F = pressure_force(grid, mesh.cells.p_step, n);
        const double per_mass = g.m[n] > 0 ? dt / g.m[n] : 0;
        g.fx[n] += F[0];
        g.fz[n] += F[1];
        g.vxL[n] += per_mass * F[0];
        g.vzL[n] += per_mass * F[1];
    });
    set_walls(grid, problem.boundaries, g.vxL, g.vzL);
}

}  // namespace flip
