// The small vibrations of an elastic block that slides steadily on a rigid plane with friction, by
// finite elements: bilinear quadrilaterals, consistent mass, and nothing of the material point
// method.
//
// While all of the lower side presses and slips forward, friction there is -mu times the pressure:
//     M u'' + K (u + beta u') = F,  at the lower side u_y = 0 and F_x = -mu F_y, else F = 0
// With the rows of F_y put into those of F_x, and u_y = 0 left out,
//     (M_x + mu M_y) u'' + (K_x + mu K_y) (u + beta u') = 0
// The matrices are not symmetric any more, so u ~ exp(s t) may grow. And how a program is asked the
// same: its block slides with viscosity until it is at peace, loses the viscosity, gets a kick in
// the form of one mode, and its momentum across the plate is followed.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "common/least_squares.hpp"
#include "tests/support/any_cloud.hpp"

namespace facts {

struct SlidingBlock {
    double width = 0.4, height = 0.2, E = 1e6, nu = 0.3, density = 1000;
    int cells_x = 8, cells_y = 4;
    double friction = 0.3, viscosity = 0;
};

struct SlidingMode {
    std::complex<double> s;  // Im s >= 0
    Eigen::VectorXcd u;      // of all nodes, row by row from below: u_x, u_y, u_x ...
};

/// Modes of the block, from low to high frequency.
inline std::vector<SlidingMode> sliding_modes(const SlidingBlock& block) {
    using Matrix = Eigen::MatrixXd;
    const int columns = block.cells_x + 1, nodes = columns * (block.cells_y + 1);
    const double a = block.width / block.cells_x, b = block.height / block.cells_y;
    const double G = 0.5 * block.E / (1 + block.nu), lambda = 2 * G * block.nu / (1 - 2 * block.nu);
    Eigen::Matrix3d D;
    D << lambda + 2 * G, lambda, 0, lambda, lambda + 2 * G, 0, 0, 0, G;

    // One element, by two Gauss points along each side.
    Eigen::Matrix<double, 8, 8> k = decltype(k)::Zero(), m = k;
    const double gauss = 1 / std::sqrt(3.0), corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (const double r : {-gauss, gauss})
        for (const double t : {-gauss, gauss}) {
            Eigen::Matrix<double, 3, 8> B = decltype(B)::Zero();
            Eigen::Matrix<double, 2, 8> N = decltype(N)::Zero();
            for (int n = 0; n < 4; ++n) {
                const double x = corner[n][0], y = corner[n][1];
                N(0, 2 * n) = N(1, 2 * n + 1) = (1 + x * r) * (1 + y * t) / 4;
                B(0, 2 * n) = B(2, 2 * n + 1) = x * (1 + y * t) / (2 * a);
                B(1, 2 * n + 1) = B(2, 2 * n) = y * (1 + x * r) / (2 * b);
            }
            k += 0.25 * a * b * B.transpose() * D * B;
            m += 0.25 * a * b * block.density * N.transpose() * N;
        }
    Matrix K = Matrix::Zero(2 * nodes, 2 * nodes), M = K;
    for (int j = 0; j < block.cells_y; ++j)
        for (int i = 0; i < block.cells_x; ++i) {
            const int first = j * columns + i,
                      of[4] = {first, first + 1, first + columns + 1, first + columns};
            for (int p = 0; p < 8; ++p)
                for (int q = 0; q < 8; ++q) {
                    const int row = 2 * of[p / 2] + p % 2, column = 2 * of[q / 2] + q % 2;
                    K(row, column) += k(p, q), M(row, column) += m(p, q);
                }
        }

    // Friction takes the rows of u_y at the lower side into those of u_x.
    std::vector<int> free;
    for (int at = 0; at < 2 * nodes; ++at)
        if (at >= 2 * columns || at % 2 == 0) free.push_back(at);
    for (int at = 0; at < 2 * columns; at += 2) {
        K.row(at) += block.friction * K.row(at + 1);
        M.row(at) += block.friction * M.row(at + 1);
    }
    const Matrix K_free = K(free, free), M_free = M(free, free);
    const Eigen::EigenSolver<Matrix> solver(M_free.partialPivLu().solve(K_free));
    const Eigen::MatrixXcd vectors = solver.eigenvectors();

    // K u = q M u, and s^2 + beta q s + q = 0. Slower than this is the block as a whole.
    const double slow = 0.01 * std::sqrt(block.E / block.density) / block.width;
    std::vector<SlidingMode> modes;
    for (Eigen::Index n = 0; n < solver.eigenvalues().size(); ++n) {
        const std::complex<double> q = solver.eigenvalues()[n], c = 0.5 * block.viscosity * q,
                                   root = std::sqrt(c * c - q);
        for (const std::complex<double>& s : {-c + root, -c - root}) {
            if (!(std::abs(s) > slow && s.imag() >= 0)) continue;
            Eigen::VectorXcd u = Eigen::VectorXcd::Zero(2 * nodes);
            u(free) = vectors.col(n);
            modes.push_back({s, u});
        }
    }
    std::sort(modes.begin(), modes.end(), [](const SlidingMode& one, const SlidingMode& two) {
        return one.s.imag() < two.s.imag();
    });
    return modes;
}

/// The lowest mode that grows.
inline const SlidingMode& first_flutter(const std::vector<SlidingMode>& modes) {
    return *std::find_if(modes.begin(), modes.end(),
                         [](const SlidingMode& one) { return one.s.real() > 1; });
}

/// The block on a plate, both on lines of nodes, with frozen particles.
inline Case sliding_case(const SlidingBlock& block, double viscosity) {
    const int refined = block.cells_x / 8;
    Case c = case_on(16 * refined, 10 * refined, 0.8);
    Material m;
    m.E = block.E, m.nu = block.nu, m.density = block.density, m.viscosity = viscosity;
    add_material(c, "default", "elastic", m);
    add_material(c, "steel", "rigid", Material{});
    c.problem.grains = {box_at("block", 0.4, 0.25, block.width, block.height),
                        box_at("plate", 0.4, 0.075, 0.8, 0.15)};
    c.problem.grains[1].material = "steel";
    c.problem.gravity_x = 5, c.problem.gravity_y = -std::sqrt(75.0), c.problem.rise = 0.05;
    c.problem.contact.friction = block.friction;
    c.frozen = true;
    return c;
}

/// Adds the real part of a mode to the velocities of the block in a sliding_case(), at most `size`.
inline void kick(const SlidingBlock& block, const SlidingMode& mode, double size, Assembly& all) {
    const double h = block.width / block.cells_x, unit = size / mode.u.cwiseAbs().maxCoeff();
    Particles& p = all.particles;
    for (long k = all.grains[0].begin; k < all.grains[0].end; ++k) {
        const auto n = static_cast<std::size_t>(k);
        const double x = (p.x_p[n] - 0.2) / h, y = (p.y_p[n] - 0.15) / h, i = std::floor(x),
                     j = std::floor(y);
        for (const double a : {0.0, 1.0})
            for (const double b : {0.0, 1.0}) {
                const double S = unit * (1 - std::fabs(x - i - a)) * (1 - std::fabs(y - j - b));
                const int at = 2 * static_cast<int>((j + b) * (block.cells_x + 1) + i + a);
                p.vx_p[n] += S * mode.u[at].real(), p.vy_p[n] += S * mode.u[at + 1].real();
            }
    }
}

/// The exponent s of y = A exp(s t) + B exp(s* t) + C, by least squares.
///   y(t + 2T) + c_1 y(t + T) + c_0 y(t) = c,  exp(s T) a root of z^2 + c_1 z + c_0
/// in: every, rows in T: about a sixth of a period
inline std::complex<double> exponent(const std::vector<double>& y, double dt, std::size_t every) {
    const auto rows = static_cast<Eigen::Index>(y.size() - 2 * every);
    const Eigen::Map<const Eigen::VectorXd> all(y.data(), rows + 2 * static_cast<long>(every));
    Eigen::MatrixXd A(rows, 3);
    A << all.segment(static_cast<long>(every), rows), all.head(rows), Eigen::VectorXd::Ones(rows);
    A.leftCols(2) /= all.cwiseAbs().maxCoeff();
    const Eigen::Vector3d c = common::least_squares(A, -all.tail(rows) / all.cwiseAbs().maxCoeff());
    const std::complex<double> root =
        0.5 * (-c[0] + std::sqrt(std::complex(c[0] * c[0] - 4 * c[1])));
    return std::log(root) / (real(static_cast<long>(every)) * dt);
}

/// Slides, kicks and follows: what s the momentum of the block across the plate has.
/// in: Program, Run or ThetaRun; viscosity, after the kick
template <class Program>
std::complex<double> measured_exponent(const SlidingBlock& block, const SlidingMode& mode,
                                       double viscosity, Program& run) {
    run.advance(std::lround(0.15 / run.dt));
    run.laws[0].viscosity = viscosity;
    kick(block, mode, 1e-5, run.state.assembly);
    std::vector<double> y;
    for (double t = 0; t < 0.15; t += run.dt) {
        run.advance();
        if (t < 0.05) continue;  // the mode that decays as fast must go
        const Particles& p = run.particles();
        const Grain& grain = run.state.assembly.grains[0];
        y.push_back(0);
        for (auto k = static_cast<std::size_t>(grain.begin); long(k) < grain.end; ++k)
            y.back() += p.m_p[k] * p.vy_p[k];
    }
    return exponent(y, run.dt, static_cast<std::size_t>(0.005 / run.dt));
}

}  // namespace facts
