// particles -> grid: the current of a trajectory, such that charge is conserved to round-off.
//
// A particle goes from x^n to x^{n+1} in a straight line. Its charge flows through the edges of the
// mesh with the splines that the slide gives to J, one order lower where it is differentiated,
//
//     J_x = 1/dt int q dx/dt S^(l-1)(x) S^(l)(z) dt,   J_z alike,   J_y = 1/dt int q v_y S S dt
//
// and since d S^(l)/dx is a difference of S^(l-1), the integral of d rho/dt + div J over the step
// is zero on every node. Within one cell the integrand is a polynomial of degree 2 l - 1 along the
// trajectory, which Gauss's rule with l points integrates exactly: with linear splines one point, the
// middle of the segment, with quadratic ones two. J_y has no part in charge; its integrand has one
// degree more, and the rule leaves an error of D^2 (l = 1) or D^4 (l = 2) of a displacement D.
// source: Villasenor and Buneman, Comput. Phys. Commun. 69, 306 (1992), for l = 1; where a trajectory
// stays in its cell that is also Esirkepov, Comput. Phys. Commun. 135, 144 (2001), and the zigzag
// of Umeda et al., Comput. Phys. Commun. 156, 73 (2003), who cut other trajectories differently.
#pragma once

#include <iterator>
#include <vector>

#include "implicit_moment/explicit_em/stencil.hpp"
#include "implicit_moment/field/vector_field.hpp"

namespace implicit_moment {

/// Gauss's points on a segment of unit length; their weights are equal.
template <int l>
inline constexpr double gauss_point[l]{};
template <>
inline constexpr double gauss_point<1>[1] { 0.5 };
template <>
inline constexpr double gauss_point<2>[2] { 0.21132486540518711775, 0.78867513459481288225 };

/// What trajectory segments within one cell give to the mesh values around it. In x and z it is a
/// displacement in cells, in y a velocity: the factors q dx / (dx dz dt), q / (dx dz),
/// q dz / (dx dz dt) come later, once for all particles.
template <int l, class Real>
struct CurrentSums {
    Real J_x[l + 1][l]{}, J_y[l + 1][l + 1]{}, J_z[l][l + 1]{};

    /// Adds a segment: from d, on by D, at velocity v_y (times the part of the step it takes).
    /// exact:  div of what is added = difference of S^(l) S^(l) between the ends.
    // [segment]
    void add(const Real& d_x, const Real& d_z, const Real& D_x, const Real& D_z, const Real& v_y) {
        for (const double point : gauss_point<l>) {
            const auto along = NumberOf<Real>(point);
            const StencilWeights<l, Real> S_x(d_x + along * D_x), S_z(d_z + along * D_z);
            const Real part_x = D_x * (1.0 / l), part_y = v_y * (1.0 / l), part_z = D_z * (1.0 / l);
            for (int j = 0; j <= l; ++j) {
                for (int i = 0; i < l; ++i) J_x[j][i] += part_x * (S_x.half(i) * S_z.node(j));
                for (int i = 0; i <= l; ++i) J_y[j][i] += part_y * (S_x.node(i) * S_z.node(j));
            }
            for (int j = 0; j < l; ++j) {
                for (int i = 0; i <= l; ++i) J_z[j][i] += part_z * (S_x.node(i) * S_z.half(j));
            }
        }
    }
    // [/segment]
};

/// The current of some rows of cells, on a piece of mesh of their own that also has room for what
/// their particles deposit in the neighboring cells: no two tiles write to the same place.
struct CurrentTile {
    static constexpr long margin = 2;
    long first_row = 0, rows = 0, columns = 0;  // of the mesh, margins included
    std::vector<double> J_x, J_y, J_z;

    /// Makes it the empty tile of the rows [first, last) of cells.
    void clear(const Grid& grid, long first, long last) {
        first_row = first - margin, rows = last - first + 2 * margin;
        columns = grid.x.cells + 1 + 2 * margin;
        for (auto* J : {&J_x, &J_y, &J_z}) J->assign(rows * columns, 0.0);
    }
    long index(long i, long j) const { return (j - first_row) * columns + i + margin; }

    /// Adds the sums of one cell.
    template <int l, class Real>
    void add(long cell_x, long cell_z, const CurrentSums<l, Real>& sums) {
        const long corner = index(cell_x + Stencil<l>::first, cell_z + Stencil<l>::first);
        const auto add_to = [&](std::vector<double>& J, const auto& of_cell) {
            for (long j = 0; j < std::ssize(of_cell); ++j) {
                for (long i = 0; i < std::ssize(of_cell[0]); ++i)
                    J[corner + j * columns + i] += simd_sum(of_cell[j][i]);
            }
        };
        add_to(J_x, sums.J_x), add_to(J_y, sums.J_y), add_to(J_z, sums.J_z);
    }

    /// What lies beyond the ghosts of a periodic mesh goes to its image.
    static long image(const common::Axis& axis, long k) {
        return k < -1 ? k + axis.cells : k > axis.cells + 1 ? k - axis.cells : k;
    }

    /// Adds the tile to the mesh, with the factors of J.
    void add_to_mesh(const Grid& grid, double q, double dt, VectorField& J) const {
        const double per_x = q / (grid.z.spacing() * dt), per_y = q / grid.cell_area(),
                     per_z = q / (grid.x.spacing() * dt);
        for (long row = first_row; row < first_row + rows; ++row) {
            const long j = image(grid.z, row);
            for (long column = -margin; column < columns - margin; ++column) {
                const long to = grid.index(image(grid.x, column), j);
                const long from = index(column, row);
                J.x()[to] += per_x * J_x[from];
                J.y()[to] += per_y * J_y[from];
                J.z()[to] += per_z * J_z[from];
            }
        }
    }
};

/// One direction of a trajectory: where the next segment begins, and what is left of the way.
struct Trajectory {
    long cell;
    double d, D;      // from the anchor of its cell; displacement that is left [cells]
    double sign = 1;  // of its velocity: -1 after an odd number of walls

    /// The fraction of the way left at the next cell crossing; 1 or more when there is none.
    template <int l>
    double fraction_to_crossing(const common::Axis& axis) const {
        if (D > 0) return (Stencil<l>::high_of(axis, cell) - d) / D;
        if (D < 0) return (Stencil<l>::low_of(axis, cell) - d) / D;
        return 2;
    }

    /// Goes that fraction of the way left.
    void advance(double fraction) { d += fraction * D, D *= 1 - fraction; }

    /// A cell crossing: into the next cell, or back from a wall.
    template <int l>
    void cross(const common::Axis& axis) {
        const bool up = D > 0;
        if (!axis.periodic && cell == (up ? Stencil<l>::cells(axis) - 1 : 0)) {
            d = up ? Stencil<l>::high_of(axis, cell) : 0.0;
            D = -D;
            sign = -sign;
        } else {
            cell += up ? 1 : -1;
            d = up ? Stencil<l>::low : Stencil<l>::high;
        }
    }

    /// Where it ends: the periodic image, or a point not behind a wall.
    double end(const common::Axis& axis) const {
        double x = axis.at(double(cell) + d);
        if (!axis.periodic) return std::clamp(x, axis.low, axis.high());
        if (x < axis.low) x += axis.length;
        return x >= axis.high() ? x - axis.length : x;
    }
};

/// Deposits the current of one trajectory segment by segment, cut where it crosses from cell to cell;
/// walls reflect it. The first segment is left out: the push deposits it with those of the whole cell.
/// in:     v_y; x and z at the start of the step, |D| <= 1.
/// out:    x and z at the end of the step; tile.
/// exact:  as the segments: charge to round-off.
template <int l>
inline void deposit_current(const Grid& grid, double v_y, Trajectory& x, Trajectory& z,
                            CurrentTile& tile) {
    double left = 1;
    // A way no longer than a cell crosses at most two borders of each direction, and ends.
    for (int segment = 0; segment < 5 && left > 0; ++segment) {
        const double to_x = x.fraction_to_crossing<l>(grid.x),
                     to_z = z.fraction_to_crossing<l>(grid.z);
        const double part = std::clamp(std::min(to_x, to_z), 0.0, 1.0);
        if (segment > 0) {
            CurrentSums<l, double> sums;
            sums.add(x.d, z.d, part * x.D, part * z.D, part * left * v_y);
            tile.add(x.cell, z.cell, sums);
        }
        x.advance(part), z.advance(part);
        left *= 1 - part;
        if (part == 1) break;
        to_x <= to_z ? x.cross<l>(grid.x) : z.cross<l>(grid.z);
    }
}

}  // namespace implicit_moment
