// Sines and cosines of the staggered mesh: the basis in which constant-coefficient field
// equations are solved at once.
//
// Let D be the forward difference from nodes to midpoints along one direction. Its singular value
// decomposition D = U sigma V^T is known in closed form, for periodic ends (sines and cosines)
// and for walls (node values vanish there). On the product of two such bases curl curl and the
// Laplacian act on each mode alone. With a few dozen to a few hundred points per direction four
// small matrix products beat a fast Fourier transform.
// source: the fast diagonalization method, Lynch, Rice and Thomas, Numer. Math. 6 (1964).
#pragma once

#include <cmath>

#include "implicit_moment/units.hpp"
#include "implicit_moment/vector_field.hpp"

namespace implicit_moment {

/// One direction: columns of V are node modes, columns of U midpoint modes, both orthonormal, D V
/// = U diag(sigma).
struct AxisModes {
    Eigen::MatrixXd V, U;
    Eigen::VectorXd sigma;  // [1/length]
    Eigen::VectorXd angle;  // k dx of each mode
};

/// exact:  D V = U diag(sigma) to round-off.
/// note:   at a wall, mode 0 of V is the node on the wall itself, where nothing is unknown.
inline AxisModes axis_modes(const common::Axis& axis) {
    const long n = axis.cells;
    const double count = double(n);
    AxisModes modes{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n),
                    Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    for (long m = 0; m < n; ++m) {
        // Periodic: modes 0, 1, 1, 2, 2, ... as cosine and sine; with an even number of cells the
        // last is the alternating one.
        const bool cosine = axis.periodic && m % 2 == 1;
        const double wave = axis.periodic ? double((m + 1) / 2) : double(m);
        const double angle = (axis.periodic ? 2 : 1) * pi * wave / count;
        const bool alternating = axis.periodic && 2 * ((m + 1) / 2) == n;
        const double norm = std::sqrt((m == 0 || alternating ? 1.0 : 2.0) / count);
        modes.angle[m] = angle;
        modes.sigma[m] = 2 / axis.spacing() * std::sin(0.5 * angle);
        for (long i = 0; i < n; ++i) {
            const double node = angle * double(i);
            const double mid = angle * (double(i) + 0.5);
            if (m == 0) {
                modes.V(i, m) = axis.periodic ? norm : (i == 0 ? 1.0 : 0.0);
                modes.U(i, m) = norm;
            } else if (cosine) {
                modes.V(i, m) = norm * std::cos(node);
                modes.U(i, m) = -norm * std::sin(mid);
            } else {
                modes.V(i, m) = norm * std::sin(node);
                modes.U(i, m) = norm * std::cos(mid);
            }
        }
    }
    return modes;
}

/// The modes of both directions.
struct MeshModes {
    AxisModes x, z;
    explicit MeshModes(const Grid& grid) : x(axis_modes(grid.x)), z(axis_modes(grid.z)) {}
};

/// f becomes the function whose modes are those of f times factor(k^2), k^2 of the Laplacian.
/// in/out: f on nodes, zero on walls; ghosts filled afterwards.
template <class Factor>
inline void scale_modes(const Grid& grid, const MeshModes& modes, const Factor& factor, Field& f) {
    auto values = interior(grid, f.data());
    Eigen::MatrixXd half = modes.x.V.transpose() * values;
    Eigen::MatrixXd amplitude = half * modes.z.V;
    for (long l = 0; l < grid.z.cells; ++l) {
        const double k_z = modes.z.sigma[l];
        for (long k = 0; k < grid.x.cells; ++k) {
            const double k_x = modes.x.sigma[k];
            amplitude(k, l) *= factor(k_x * k_x + k_z * k_z);
        }
    }
    half.noalias() = modes.x.V * amplitude;
    values.noalias() = half * modes.z.V.transpose();
    common::fill_ghosts(grid, common::on_nodes, {-1, -1}, f.data());
}

/// Solves (1 - a^2 lap) g = f on nodes, with g = 0 on walls. in/out: f becomes g, ghosts filled.
/// exact:  to round-off.
inline void solve_helmholtz(const Grid& grid, const MeshModes& modes, double a, Field& f) {
    scale_modes(
        grid, modes, [a](double k2) { return 1 / (1 + a * a * k2); }, f);
}

/// Solves -lap g = f on nodes, with g = 0 on walls; where nothing fixes the mean, the means of f
/// and g are taken out.
inline void solve_poisson(const Grid& grid, const MeshModes& modes, Field& f) {
    scale_modes(
        grid, modes, [](double k2) { return k2 > 0 ? 1 / k2 : 0; }, f);
}

}  // namespace implicit_moment
