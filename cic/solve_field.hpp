// on the mesh: the electric field of the charge density, Gauss's law.  [CIC-2]
#pragma once

#include <array>

#include "cic/gather_field.hpp"
#include "cic/poisson.hpp"

namespace cic {

/// Potential and field of one time level.
struct FieldState {
    Field phi;      // on nodes, ghosts filled
    MeshField E_g;  // packed for gather_field
    Walls walls;
};

/// What solve_field() needs beside the charge: the mesh, where the field is wanted, and the prepared
/// solver of Poisson's equation. Nothing in it changes from step to step but scratch room.
class FieldSolver {
   public:
    /// in:     nine_point, the Laplacian with the corners; gauss_sign, +1, or -1 for the law as the
    ///         slide prints it
    FieldSolver(const Grid& grid, const Scheme& scheme, bool nine_point, double gauss_sign)
        : grid_(grid), scheme_(scheme), gauss_sign_(gauss_sign), poisson_(grid, nine_point) {}

    friend void solve_field(FieldSolver&, const Field&, FieldState&);

   private:
    Grid grid_;
    Scheme scheme_;
    double gauss_sign_;
    PoissonSolver poisson_;
    Field right_;
};

namespace detail {

// E = -grad phi half-way between nodes.
inline void field_on_edges(const Grid& grid, const Field& phi, MeshField& E_g) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const long stride = grid.stride();
    common::for_each_row(grid.z.cells + 2, [&](long row) {
        for (long i = -1; i <= grid.x.cells; ++i) {
            const long n = grid.index(i, row - 1);
            E_g[n] = {Real((phi[n] - phi[n + 1]) * per_dx),
                      Real((phi[n] - phi[n + stride]) * per_dz)};
        }
    });
}

// E on nodes: the mean of the two differences beside each node.
inline void field_on_nodes(const Grid& grid, const Field& phi, MeshField& E_g) {
    const double half_per_dx = 0.5 / grid.x.spacing(), half_per_dz = 0.5 / grid.z.spacing();
    const long stride = grid.stride();
    common::for_each_row(grid.z.cells + 1, [&](long row) {
        for (long i = 0; i <= grid.x.cells; ++i) {
            const long n = grid.index(i, row);
            E_g[n] = {Real((phi[n - 1] - phi[n + 1]) * half_per_dx),
                      Real((phi[n - stride] - phi[n + stride]) * half_per_dz)};
        }
    });
}

// Visits the nodes of both walls of a direction: visit(node, step to the next node inside, wall,
// +1 or -1 for a normal along or against the axis, step along the wall out of a corner or 0).
template <class Visit>
void for_each_wall_node(const Grid& grid, bool along_x, const Visit& visit) {
    const common::Axis& other = along_x ? grid.z : grid.x;
    const long N = along_x ? grid.x.cells : grid.z.cells, step = along_x ? 1 : grid.stride(),
               aside = along_x ? grid.stride() : 1;
    for (long k = 0; k <= (other.periodic ? other.cells - 1 : other.cells); ++k) {
        const long out = other.periodic ? 0 : k == 0 ? aside : k == other.cells ? -aside : 0;
        visit(along_x ? grid.index(0, k) : grid.index(k, 0), step, along_x ? x_low : z_low, 1.0,
              out);
        visit(along_x ? grid.index(N, k) : grid.index(k, N), -step, along_x ? x_high : z_high, -1.0,
              out);
    }
}

}  // namespace detail

/// Charge per area on the inner face of a wall, from Gauss's law in the half cell before it.
///   sigma = E_1/2 - rho_0 dx/2, E pointing away from the wall
inline double surface_charge(double phi_wall, double phi_next, double rho_wall, double dx) {
    return (phi_wall - phi_next) / dx - 0.5 * dx * rho_wall;
}

/// Fills the places around the mesh with copies of the field, periodic ones or images behind walls, so
/// that gather_field stays the transpose of deposit_charge: on nodes mirror images; on edges, where it is
/// the difference of a potential with phi_-1 = 2 phi_0 - phi_1, the same field across the wall, and along it
/// the opposite one about that on the wall (which is not zero where the potentials of walls that meet differ).
inline void fill_ghosts(const Grid& grid, bool on_edges, MeshField& E_g) {
    const auto at = [&](long i, long j) -> NodeField& { return E_g[grid.index(i, j)]; };
    const long nx = grid.x.cells, nz = grid.z.cells;
    const auto along = [&](const common::Axis& axis, const auto& field) {
        common::ghosts_along(axis, false, on_edges ? -1 : 1, [&](long to, long from, int sign) {
            field(to) = sign < 0 ? 2 * field(to < 0 ? 0 : axis.cells) - field(from) : field(from);
        });
    };
    for (long j = 0; j <= nz; ++j) {
        common::ghosts_along(grid.x, on_edges, 1,
                             [&](long to, long from, int) { at(to, j).x = at(from, j).x; });
        along(grid.x, [&](long i) -> Real& { return at(i, j).z; });
    }
    for (long i = -1; i <= nx + 1; ++i) {
        along(grid.z, [&](long j) -> Real& { return at(i, j).x; });
        common::ghosts_along(grid.z, on_edges, 1,
                             [&](long to, long from, int) { at(i, to).z = at(i, from).z; });
    }
}

/// The field of the charge density.
///   div E = rho,  E = -grad phi:   -lap phi = rho
/// in:     rho_g on nodes, on walls per half cell; field.walls with the potentials of grounded walls and the
///         charges of floating ones
/// out:    field.phi; field.E_g, on nodes (momentum-conserving) or on edges (energy-conserving);
///         field.walls with the charges of grounded walls and the potentials of floating ones
/// exact:  the difference equation to round-off. Grounded walls have together the opposite of the charge
///         between them. On a node of a wall E is the mean of the two sides
///         of its charge, sigma and E_1/2, so that in one dimension the force on all particles is
///         the difference of the field pressures on the walls,
///           sum_g rho_g V_g E_g = [E^2/2]_low^high
/// source: [CIC-2]
/// note:   The slide prints div E = -rho, which makes like charges attract: gauss_sign = -1.
inline void solve_field(FieldSolver& solver, const Field& rho_g, FieldState& field) {
    const Grid& grid = solver.grid_;
    solver.right_ = solver.gauss_sign_ * rho_g;
    const Field& rho = solver.right_;
    Field& phi = field.phi;
    solver.poisson_.solve(rho, field.walls, phi);
    common::fill_ghosts(grid, common::on_nodes, {1, 1}, phi.data());

    field.E_g.resize(grid.size());
    const bool on_edges = solver.scheme_.energy_conserving;
    if (on_edges)
        detail::field_on_edges(grid, phi, field.E_g);
    else
        detail::field_on_nodes(grid, phi, field.E_g);

    // What the walls got: the mean charge of a grounded one, the potential of a floating one; and
    // the field on their nodes.
    for (const bool along_x : {true, false}) {
        const common::Axis &axis = along_x ? grid.x : grid.z, &other = along_x ? grid.z : grid.x;
        if (axis.periodic) continue;
        std::array<double, 4> charge{};
        detail::for_each_wall_node(
            grid, along_x, [&](long n, long in, WallName wall, double sign, long out) {
                const double dx = axis.spacing(), phi_next = phi[n + in],
                             sigma = surface_charge(phi[n], phi_next, rho[n], dx);
                // A corner has half a face, and belongs to the wall at x, whose potential it has. What
                // goes from it along the wall at z ends on that one.
                const double dz = other.spacing(),
                             to_corner = -dx / (dz * dz) * (phi[n] - phi[n + out]);
                charge[wall] += out == 0
                                    ? sigma / double(other.cells)
                                    : (along_x ? sigma : to_corner) / (2 * double(other.cells));
                if (field.walls[wall].floating) field.walls[wall].potential = phi[n];
                if (on_edges) return;
                const double E_half = (phi[n] - phi_next) / dx;
                (along_x ? field.E_g[n].x : field.E_g[n].z) = Real(sign * 0.5 * (sigma + E_half));
            });
        for (const WallName wall : {along_x ? x_low : z_low, along_x ? x_high : z_high})
            if (!field.walls[wall].floating) field.walls[wall].charge = charge[wall];
    }
    fill_ghosts(grid, on_edges, field.E_g);
}

}  // namespace cic
