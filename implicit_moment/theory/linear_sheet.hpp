// Linear Vlasov theory of a plane plasma that varies across its magnetic field: waves
// exp(i k x - i omega t) with B along y, one wave over all z, with all their fields E_x, E_z and B_y.
//
// Each part of the plasma is a Maxwellian M of density n(z) that drifts along x. What a wave adds to
// it is written in Hermite polynomials of w = (v - u) / v_s, orthonormal in the mean over M,
//     f = n M + n^1/2 M sum_ab g_ab h_a(w_x) h_b(w_z) exp(i k x - i omega t),  a + b <= degree,
// and with v_s = (T/m)^1/2, Omega = q B / (m c) and T dn/dz = q n u B / c, the balance of forces,
// Vlasov's equation is exactly
//     omega g_ab = k u g_ab + k v_s [(a+1)^1/2 g_(a+1)b + a^1/2 g_(a-1)b]
//                - i v_s [b^1/2 n^1/2 d/dz n^-1/2 g_a(b-1) + (b+1)^1/2 n^-1/2 d/dz n^1/2 g_a(b+1)]
//                + i Omega {[(a+1) b]^1/2 g_(a+1)(b-1) - [a (b+1)]^1/2 g_(a-1)(b+1)}
//                + i (q/|q|) omega_s n^1/2 {E_x for g_10, E_z + u B_y / c for g_01}
// Here g is in such units that Maxwell's equations have the same factors:
//     omega E_x = -i c dB_y/dz - i sum (q/|q|) omega_s n^1/2 [g_10 + (u / v_s) g_00]
//     omega E_z = -c k B_y - i sum (q/|q|) omega_s n^1/2 g_01
//     omega B_y = -c k E_z - i c dE_x/dz
// That is an eigenvalue problem, omega x = A x. Degree 1 is a fluid of constant temperature, degree 2
// has a tensor of pressure and no flow of heat, and high degrees are Vlasov's equation, once a
// damping of the highest forgets what phase mixing carries there.
//
// Staggered in z: even b and E_x on the nodes, odd b, E_z and B_y between them. Charge is conserved
// exactly, and without drift A is Hermitian, as it is for functions of z.
// Units: half-width L of the sheet, 1/Omega_ci of the ions in B0, density n0 and field B0; B_y of a
// wave is c times that.
//
// source: Daughton, Phys. Plasmas 6, 1329 (1999), the same theory by orbit integrals; Grant and Feix,
//         Phys. Fluids 10, 696 (1967), Hermite polynomials for Vlasov's equation.
#pragma once

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"

namespace implicit_moment {

/// A part of the plasma, of density in_sheet sech^2 z + uniform; uniform = 0 if it drifts across B.
struct DriftingMaxwellian {
    double sign = 1, mass = 1;            // of the charge; m / m_i
    double in_sheet = 0, uniform = 0;     // densities [n0]
    double drift = 0, thermal_speed = 1;  // u, v_s = (T/m)^1/2 > 0 [L Omega_ci]
    int degree = 1;                       // of the polynomials in velocity, at least 1
    double damping = 0;                   // of the highest degree [Omega_ci]

    double density(double z) const { return in_sheet / std::pow(std::cosh(z), 2) + uniform; }
};

/// What waves meet at an end: a conducting wall that reflects particles, or the middle of a sheet
/// for waves of one parity: E_x even (sausage) or odd (kink). Periodic ends come in pairs.
enum class End { wall, even, odd, periodic };

/// A plasma between two ends, and the wave number of the waves that are looked for.
struct LinearSheet {
    std::vector<DriftingMaxwellian> plasma;
    double omega_pi = 0;         // (4 pi n0 e^2/m_i)^1/2 [Omega_ci]
    double light = 0;            // c [L Omega_ci]
    double k = 0;                // [1/L]
    double low = 0, high = 4.5;  // [L]
    int cells = 48;
    End lower = End::odd, upper = End::wall;
    double B = -1;         // B_y = B tanh z,
    bool reverses = true;  // or B everywhere
};

/// The matrix A, and the rows of its unknowns: at place p, z = low + p dz/2, a node where p is even.
/// A row is -1 where there is no such unknown.
struct SheetMatrix {
    Eigen::SparseMatrix<common::Complex> A;
    std::vector<double> z;            // of place p
    std::vector<int> E_x, E_z, B_y;   // row, at place p
    std::vector<std::vector<int>> g;  // first row of part s at place p
    std::vector<int> degree;          // of part s

    /// The row of g_ab of part s at place p.
    int moment(std::size_t s, int p, int a, int b) const {
        if (a < 0 || b < 0 || a + b > degree[s]) return -1;
        int row = g[s][p] + a;
        for (int below = p % 2; below < b; below += 2) row += degree[s] - below + 1;
        return g[s][p] < 0 ? -1 : row;
    }
};

namespace detail {

// Numbers the unknowns, place after place.
inline SheetMatrix number_unknowns(const LinearSheet& sheet) {
    const int last = 2 * sheet.cells - (sheet.lower == End::periodic ? 1 : 0);
    SheetMatrix m;
    m.g.resize(sheet.plasma.size());
    for (const DriftingMaxwellian& part : sheet.plasma) m.degree.push_back(part.degree);
    int rows = 0;
    for (int p = 0; p <= last; ++p) {
        const bool node = p % 2 == 0;
        const End end = p == 0 ? sheet.lower : p == last ? sheet.upper : End::periodic;
        m.z.push_back(sheet.low + p * (sheet.high - sheet.low) / (2 * sheet.cells));
        m.E_x.push_back(node && end != End::wall && end != End::odd ? rows++ : -1);
        m.E_z.push_back(node ? -1 : rows++);
        m.B_y.push_back(node ? -1 : rows++);
        for (std::size_t s = 0; s < m.g.size(); ++s) {
            m.g[s].push_back(end == End::odd ? -1 : rows);
            if (end == End::odd) continue;
            for (int b = p % 2; b <= m.degree[s]; b += 2) rows += m.degree[s] - b + 1;
        }
    }
    m.A.resize(rows, rows);
    return m;
}

}  // namespace detail

/// The matrix A of the header.
/// exact:  A is Hermitian where nothing drifts and nothing is damped; errors of order dz^2
/// note:   a node at an end has half a cell, and with it its unknowns are divided by 2^1/2
inline SheetMatrix sheet_matrix(const LinearSheet& sheet) {
    using common::Complex;
    const Complex i(0, 1);
    SheetMatrix m = detail::number_unknowns(sheet);
    std::vector<Eigen::Triplet<Complex>> entries;
    const auto add = [&](int row, int column, Complex value) {
        if (row >= 0 && column >= 0) entries.emplace_back(row, column, value);
    };
    const int places = int(m.z.size()), last = places - 1;
    const bool periodic = sheet.lower == End::periodic;
    const double dz = (sheet.high - sheet.low) / sheet.cells, k = sheet.k;
    const double light = sheet.light;

    for (int p = 0; p < places; ++p) {
        // What differs or is averaged between the neighbors, q.
        for (const int side : {-1, 1}) {
            const int q = periodic ? (p + side + places) % places : p + side;
            if (q < 0 || q > last) continue;
            const bool at_end = !periodic && (p == 0 || p == last || q == 0 || q == last);
            const double weight = at_end ? std::numbers::sqrt2 : 1;
            const Complex slope = -i * (side * weight / dz);  // -i d/dz
            const double z_between = m.z[p % 2 == 1 ? p : q];
            const double B = sheet.B * (sheet.reverses ? std::tanh(z_between) : 1);
            add(m.E_x[p], m.B_y[q], light * slope);
            add(m.B_y[p], m.E_x[q], light * slope);
            for (std::size_t s = 0; s < sheet.plasma.size(); ++s) {
                const DriftingMaxwellian& part = sheet.plasma[s];
                const double v = part.thermal_speed;
                const double ratio = std::sqrt(part.density(m.z[p]) / part.density(m.z[q]));
                const Complex turn = i * (0.5 * weight * part.sign / part.mass * B);
                for (int b = p % 2; b <= part.degree; b += 2)
                    for (int a = 0; a + b <= part.degree; ++a) {
                        const int row = m.moment(s, p, a, b);
                        add(row, m.moment(s, q, a, b - 1), v * std::sqrt(b) * ratio * slope);
                        add(row, m.moment(s, q, a, b + 1), v * std::sqrt(b + 1) / ratio * slope);
                        add(row, m.moment(s, q, a + 1, b - 1), turn * std::sqrt((a + 1) * b));
                        add(row, m.moment(s, q, a - 1, b + 1), -turn * std::sqrt(a * (b + 1)));
                    }
            }
        }
        // What is local.
        add(m.E_z[p], m.B_y[p], -light * k);
        add(m.B_y[p], m.E_z[p], -light * k);
        for (std::size_t s = 0; s < sheet.plasma.size(); ++s) {
            const DriftingMaxwellian& part = sheet.plasma[s];
            const double u = part.drift, v = part.thermal_speed;
            for (int b = p % 2; b <= part.degree; b += 2)
                for (int a = 0; a + b <= part.degree; ++a) {
                    const int row = m.moment(s, p, a, b);
                    const double high = std::max(0.0, (a + b - 2.0) / std::max(1, part.degree - 2));
                    add(row, row, k * u - i * (part.damping * std::pow(high, 4)));
                    add(row, m.moment(s, p, a + 1, b), k * v * std::sqrt(a + 1));
                    add(row, m.moment(s, p, a - 1, b), k * v * std::sqrt(a));
                }
            const Complex force =
                i * (part.sign * sheet.omega_pi * std::sqrt(part.density(m.z[p]) / part.mass));
            const int n = p % 2 == 0 ? m.moment(s, p, 0, 0) : -1;
            const int J_x = p % 2 == 0 ? m.moment(s, p, 1, 0) : -1;
            const int J_z = p % 2 == 0 ? -1 : m.moment(s, p, 0, 1);
            add(J_x, m.E_x[p], force);
            add(m.E_x[p], J_x, -force);
            add(m.E_x[p], n, -force * (u / v));
            add(J_z, m.E_z[p], force);
            add(m.E_z[p], J_z, -force);
            add(J_z, m.B_y[p], force * (u / light));
        }
    }
    m.A.setFromTriplets(entries.begin(), entries.end());
    return m;
}

}  // namespace implicit_moment
