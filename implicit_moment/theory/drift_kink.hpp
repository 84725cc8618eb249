// The drift kink of a Harris sheet: the waves along its current that bend it, in linear Vlasov
// theory, without the lower-hybrid drift instability that a simulation has first.
//
// Waves have one of two parities: in a kink B_y, E_z and v_z are even in z and n and E_x odd, in a
// sausage it is the other way around. One half of the sheet is enough for each.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "implicit_moment/theory/drift_dispersion.hpp"
#include "implicit_moment/theory/eigenvalues.hpp"
#include "implicit_moment/theory/linear_sheet.hpp"

namespace implicit_moment {

/// How finely space and velocities are resolved. One and a half times the cells or one of the degrees,
/// or twice the damping, changes the growth of a drift kink with k L < 2 by less than 0.01 Omega_ci,
/// and that of waves at the edges by up to a quarter.
struct KinkResolution {
    int cells = 48;
    int ions = 10, electrons = 4, background = 6;  // degrees
    double damping = 2;                            // of the highest degree, over k v_s
};

/// The same plasma as in local theory, between walls at +-half_length, for its kinks or its sausages.
inline LinearSheet linear_sheet(const CurrentSheet& sheet, double k, double half_length = 4.5,
                                bool kink = true, const KinkResolution& resolution = {}) {
    const double tau = sheet.temperature_ratio, m_e = 1 / sheet.mass_ratio;
    const double u_i = sheet.drift * sheet.drift, v_i = sheet.drift / std::numbers::sqrt2;
    const double v_e = v_i / std::sqrt(m_e * tau);
    LinearSheet linear;
    linear.plasma = {{1, 1, 1, 0, u_i, v_i, resolution.ions},
                     {-1, m_e, 1, 0, -u_i / tau, v_e, resolution.electrons}};
    if (sheet.background > 0) {
        linear.plasma.push_back({1, 1, 0, sheet.background, 0, v_i, resolution.background});
        linear.plasma.push_back({-1, m_e, 0, sheet.background, 0, v_e, resolution.background});
    }
    for (DriftingMaxwellian& part : linear.plasma)
        part.damping = resolution.damping * k * part.thermal_speed;
    linear.omega_pi = sheet.frequency_ratio * std::sqrt(sheet.mass_ratio);
    linear.light = linear.omega_pi * sheet.drift * std::sqrt((1 + tau) / tau);
    linear.k = k;
    linear.high = half_length;
    linear.cells = resolution.cells;
    linear.lower = kink ? End::odd : End::even;
    return linear;
}

/// A wave of the sheet: omega = its eigenvalue, and the fields that go with it.
struct SheetWave {
    common::Complex omega;
    Eigen::VectorXcd x;
    double residual = 0;  // |A x - omega x| / |omega x|
    double height = 0;    // mean of |z| over |B_y|^2 [L]
    double magnetic = 0;  // B_y / E_z, root mean squares
    double growth() const { return omega.imag(); }
};

/// The waves whose frequencies are nearest to `near`, from a Krylov space of (A - near)^-1.
/// in:     near, not an eigenvalue; size of the space
/// out:    those whose residual is below 1e-8, the fastest growing first
/// source: Saad, Numerical Methods for Large Eigenvalue Problems (2011), chapter 8: shift and invert.
inline std::vector<SheetWave> waves_near(const SheetMatrix& m, common::Complex near,
                                         int size = 40) {
    using common::Complex;
    using Matrix = Eigen::MatrixXcd;
    const long n = m.A.rows();
    Eigen::SparseMatrix<Complex> shifted(n, n);
    shifted.setIdentity();
    shifted = m.A - near * shifted;
    const auto inverse = sparse_inverse(shifted);
    if (!inverse) return {};
    long steps = std::min<long>(size, n);
    Matrix V = Matrix::Zero(n, steps + 1), H = Matrix::Zero(steps + 1, steps);
    for (long row = 0; row < n; ++row) V(row, 0) = std::polar(1.0, double(row) * double(row));
    V.col(0).normalize();
    for (long j = 0; j < steps; ++j) {
        Eigen::VectorXcd next = inverse(V.col(j));
        for (int twice = 0; twice < 2; ++twice) {
            const Eigen::VectorXcd part = V.leftCols(j + 1).adjoint() * next;
            next -= V.leftCols(j + 1) * part;
            H.col(j).head(j + 1) += part;
        }
        const double norm = next.norm();
        if (!std::isfinite(norm)) return {};
        H(j + 1, j) = norm;
        if (norm == 0) steps = j + 1;
        V.col(j + 1) = norm > 0 ? Eigen::VectorXcd(next / norm) : next;
    }

    std::vector<SheetWave> waves;
    const Eigensystem ritz = eigensystem(H.topLeftCorner(steps, steps));
    for (long j = 0; j < steps; ++j) {
        SheetWave wave;
        // Inverse iteration refines what the eigenvectors of H make.
        const Eigen::VectorXcd x = (V.leftCols(steps) * ritz.vectors.col(j)).normalized();
        wave.x = inverse(x);
        wave.x.normalize();
        const Eigen::VectorXcd Ax = m.A * wave.x;
        wave.omega = wave.x.dot(Ax);
        const double rest = (Ax - wave.omega * wave.x).norm();
        if (!(rest < 1e-8 * std::abs(wave.omega))) continue;
        wave.residual = rest / std::abs(wave.omega);
        double B2 = 0, E2 = 0, B2_z = 0;
        for (std::size_t p = 1; p < m.z.size(); p += 2) {
            const double B2_here = std::norm(wave.x[m.B_y[p]]);
            B2 += B2_here, B2_z += B2_here * std::fabs(m.z[p]), E2 += std::norm(wave.x[m.E_z[p]]);
        }
        if (B2 > 0) wave.height = B2_z / B2;
        if (E2 > 0) wave.magnetic = std::sqrt(B2 / E2);
        waves.push_back(wave);
    }
    std::ranges::sort(waves, std::greater{}, &SheetWave::growth);
    return waves;
}

/// The growing waves of wave number k that travel with the ions, the fastest first: from searches
/// about k u_i.
/// note:   waves far from k u_i, or that grow more slowly than `least`, may be missing
inline std::vector<SheetWave> growing_waves(const LinearSheet& sheet, double least = 0.01) {
    const SheetMatrix m = sheet_matrix(sheet);
    const double k_u_i = sheet.k * sheet.plasma.front().drift;
    std::vector<SheetWave> waves;
    for (const double part : {0.5, 0.75, 1.0})
        for (SheetWave& wave : waves_near(m, {part * k_u_i, 0.2 + 0.1 * part * sheet.k}, 50))
            if (wave.omega.imag() > least &&
                std::ranges::none_of(waves, [&](const SheetWave& known) {
                    return std::abs(known.omega - wave.omega) < 1e-6 * k_u_i;
                }))
                waves.push_back(std::move(wave));
    std::ranges::sort(waves, std::greater{}, &SheetWave::growth);
    return waves;
}

}  // namespace implicit_moment
