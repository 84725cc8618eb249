// particles -> grid: the current of a path, such that charge is conserved to round-off.
//
// A particle goes from x^n to x^{n+1} in a straight line. Its charge flows through the edges of the
// mesh with the splines that the slide gives to J, one order lower where it is differentiated,
//
//     J_x = 1/dt int q dx/dt S^(l-1)(x) S^(l)(z) dt,   J_z alike,   J_y = 1/dt int q v_y S S dt
//
// and since d S^(l)/dx is a difference of S^(l-1), the integral of d rho/dt + div J over the step
// is zero on every node. Within one home the integrand is a polynomial of degree 2 l - 1 along the
// path, which Gauss's rule with l points integrates exactly: with linear splines one point, the
// middle of the path, with quadratic ones two. J_y has no part in charge; its integrand has one
// degree more, and the rule leaves an error of D^2 (l = 1) or D^4 (l = 2) of a displacement D.
// source: Villasenor and Buneman, Comput. Phys. Commun. 69, 306 (1992), for l = 1; where a path
// stays in its home that is also Esirkepov, Comput. Phys. Commun. 135, 144 (2001), and the zigzag
// of Umeda et al., Comput. Phys. Commun. 156, 73 (2003), who cut other paths differently.
#pragma once

#include <cmath>
#include <vector>

#include "implicit_moment/explicit_em/home_weights.hpp"
#include "implicit_moment/vector_field.hpp"

namespace implicit_moment {

/// Gauss's points on a path of unit length; their weights are equal.
template <int l>
inline constexpr double gauss_point[l]{};
template <>
inline constexpr double gauss_point<1>[1] { 0.5 };
template <>
inline constexpr double gauss_point<2>[2] { 0.21132486540518711775, 0.78867513459481288225 };

/// What paths within one home give to the mesh values around it. In x and z it is a displacement in
/// cells, in y a velocity: the factors q dx / (dx dz dt), q / (dx dz), q dz / (dx dz dt) come
/// later, once for all particles.
template <int l, class Real>
struct PathSums {
    Real J_x[l + 1][l]{}, J_y[l + 1][l + 1]{}, J_z[l][l + 1]{};

    /// A piece of path: from d, on by D, at velocity v_y (times the part of the step it takes).
    /// exact:  div of what is added = difference of S^(l) S^(l) between the ends.
    // [path]
    void add(const Real& d_x, const Real& d_z, const Real& D_x, const Real& D_z, const Real& v_y) {
        for (const double along : gauss_point<l>) {
            const HomeWeights<l, Real> S_x(d_x + along * D_x), S_z(d_z + along * D_z);
            const Real part_x = D_x * (1.0 / l), part_y = v_y * (1.0 / l), part_z = D_z * (1.0 / l);
            for (int j = 0; j <= l; ++j) {
                for (int i = 0; i < l; ++i) J_x[j][i] += part_x * (S_x.half[i] * S_z.node[j]);
                for (int i = 0; i <= l; ++i) J_y[j][i] += part_y * (S_x.node[i] * S_z.node[j]);
            }
            for (int j = 0; j < l; ++j) {
                for (int i = 0; i <= l; ++i) J_z[j][i] += part_z * (S_x.node[i] * S_z.half[j]);
            }
        }
    }
    // [/path]
};

/// The current of some rows of homes, on a piece of mesh of their own that also has room for what
/// their particles do in the neighboring homes: no two strips write to the same place.
struct StripCurrent {
    static constexpr long margin = 2;
    long first_row = 0, rows = 0, columns = 0;  // of the mesh, margins included
    std::vector<double> J_x, J_y, J_z;

    /// in: homes [first, last) of the rows.
    void clear(const Grid& grid, long first, long last) {
        first_row = first - margin, rows = last - first + 2 * margin;
        columns = grid.x.cells + 1 + 2 * margin;
        for (auto* J : {&J_x, &J_y, &J_z}) J->assign(static_cast<std::size_t>(rows * columns), 0.0);
    }
    long index(long i, long j) const { return (j - first_row) * columns + i + margin; }

    template <int l, class Real, class Sum>
    void take(long home_x, long home_z, const PathSums<l, Real>& paths, const Sum& sum) {
        const long corner = index(home_x + Homes<l>::first, home_z + Homes<l>::first);
        double *x = &J_x[static_cast<std::size_t>(corner)],
               *y = &J_y[static_cast<std::size_t>(corner)],
               *z = &J_z[static_cast<std::size_t>(corner)];
        for (long j = 0; j <= l; ++j) {
            for (long i = 0; i < l; ++i) x[j * columns + i] += sum(paths.J_x[j][i]);
            for (long i = 0; i <= l; ++i) y[j * columns + i] += sum(paths.J_y[j][i]);
        }
        for (long j = 0; j < l; ++j) {
            for (long i = 0; i <= l; ++i) z[j * columns + i] += sum(paths.J_z[j][i]);
        }
    }
};

namespace detail {

// One direction of a path that is being followed, in cells.
struct Leg {
    long home;
    double d, D;      // where it is in its home; how far it still goes
    double sign = 1;  // of its velocity: -1 after an odd number of walls
};

// The part of the way left after which a leg leaves its home; 1 or more when it does not.
template <int l>
inline double part_to_border(const common::Axis& axis, const Leg& leg) {
    if (leg.D > 0) return (Homes<l>::high_of(axis, leg.home) - leg.d) / leg.D;
    if (leg.D < 0) return (Homes<l>::low_of(axis, leg.home) - leg.d) / leg.D;
    return 2;
}

// Steps over the border that has been reached: into the next home, or back from a wall.
template <int l>
inline void cross_border(const common::Axis& axis, Leg& leg) {
    const bool up = leg.D > 0;
    const bool wall = !axis.periodic && leg.home == (up ? Homes<l>::count(axis) - 1 : 0);
    if (wall) {
        leg.d = up ? Homes<l>::high_of(axis, leg.home) : 0.0;
        leg.D = -leg.D;
        leg.sign = -leg.sign;
    } else {
        leg.home += up ? 1 : -1;
        leg.d = up ? Homes<l>::low : Homes<l>::high;
    }
}

// Where a leg ends: the periodic image, or a point not behind a wall.
template <int l>
inline double end_of(const common::Axis& axis, const Leg& leg) {
    double x = axis.at(static_cast<double>(leg.home) + leg.d);
    if (!axis.periodic) return std::clamp(x, axis.low, axis.high());
    if (x < axis.low) x += axis.length;
    return x >= axis.high() ? x - axis.length : x;
}

}  // namespace detail

/// Follows one path from home to home and gives its current to the strip, piece by piece; walls
/// reflect it.
/// in:     the legs at the start of the step, |D| <= 1; v_y.
/// out:    the legs at the end of the step.
template <int l>
inline void follow_path(const Grid& grid, double v_y, detail::Leg& x, detail::Leg& z,
                        StripCurrent& strip) {
    double left = 1;
    // A path no longer than a cell meets at most two borders of each direction, and its end.
    for (int piece = 0; piece < 5 && left > 0; ++piece) {
        const double to_x = detail::part_to_border<l>(grid.x, x),
                     to_z = detail::part_to_border<l>(grid.z, z);
        const double part = std::clamp(std::min(to_x, to_z), 0.0, 1.0);
        PathSums<l, double> sums;
        sums.add(x.d, z.d, part * x.D, part * z.D, part * left * v_y);
        strip.take(x.home, z.home, sums, [](double sum) { return sum; });
        for (detail::Leg* leg : {&x, &z}) leg->d += part * leg->D, leg->D *= 1 - part;
        left *= 1 - part;
        if (part == 1) break;
        if (to_x <= to_z) {
            detail::cross_border<l>(grid.x, x);
        } else {
            detail::cross_border<l>(grid.z, z);
        }
    }
}

}  // namespace implicit_moment
