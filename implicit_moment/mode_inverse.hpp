// The inverse of the field equations of a uniform plasma, mode by mode: for each wave 2 x 2 numbers in the
// plane and one across it, or, where a uniform magnetization turns all of it and both directions are
// periodic, 3 x 3.
//
// In a periodic direction cosine and sine of a wave number belong together. Counted from where each
// component lives, a wave e^{i k x} of E has real equations,
//
//     [ 1 + a^2 (K^2 - K K^T) + w^2 chi_ab g_ab(k) ] e,     K = (2/dx) sin(k dx/2),
//
// with w of the smoothing, g_ab of the splines or averages between the places of components a and b, and chi
// the mean susceptibility with its rotation. Between walls the average of a component that has cosines is not
// among the sines of another, so that rotation has no such form there, and is left out.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <utility>
#include <vector>

#include "implicit_moment/mesh_modes.hpp"

namespace implicit_moment {

/// The inverse for every mode: 2 x 2 in the plane, one number for y; or for waves that are turned.
struct ModeInverse {
    Eigen::ArrayXXf xx, xz, zz, yy;
    bool turns = false;
    std::vector<std::array<Eigen::Matrix3f, 2>> wave;  // [k_x + (nx/2 + 1) k_z][k_z > 0, k_z < 0]
};

namespace detail {

// Modes of one wave number of a periodic direction with n points; -1 where there is none.
struct WaveModes {
    long cosine, sine;
    WaveModes(long wave, long n)
        : cosine(wave == 0 ? 0 : 2 * wave - 1), sine(2 * wave < n && wave > 0 ? 2 * wave : -1) {}
};

// Cosine and sine part of one component: of node modes as they are, while midpoint modes of cosines are
// minus sines.
inline std::array<float, 2> parts(bool half, float cosine, float sine) {
    return half ? std::array<float, 2>{sine, -cosine} : std::array<float, 2>{cosine, sine};
}
inline std::array<float, 2> modes_of(bool half, const std::array<float, 2>& parts) {
    return half ? std::array<float, 2>{-parts[1], parts[0]} : parts;
}

}  // namespace detail

/// Inverts the matrices of all waves of a doubly periodic mesh.
/// in:     matrix(k, l), of modes k and l that are cosines: without a^2 K_x K_z, and that product
/// out:    inverse.wave
template <class Matrix>
inline void find_wave_inverses(const Grid& grid, const Matrix& matrix, ModeInverse& inverse) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    inverse.wave.resize(std::size_t((nx / 2 + 1) * (nz / 2 + 1)));
    for (long q = 0; q <= nz / 2; ++q) {
        for (long p = 0; p <= nx / 2; ++p) {
            const auto [M, product] =
                matrix(detail::WaveModes(p, nx).cosine, detail::WaveModes(q, nz).cosine);
            for (const int sense : {1, -1}) {
                Eigen::Matrix3d of_wave = M;
                of_wave(0, 2) -= sense * product, of_wave(2, 0) -= sense * product;
                inverse.wave[std::size_t(p + (nx / 2 + 1) * q)][sense > 0 ? 0 : 1] =
                    of_wave.inverse().cast<float>();
            }
        }
    }
}

/// Solves every wave of a doubly periodic mesh.
/// in/out: amplitudes of E_x, E_y, E_z by modes, as precondition_field has them
inline void solve_waves(const Grid& grid, const ModeInverse& inverse,
                        std::array<Eigen::MatrixXf, 3>& amplitude) {
    const long nx = grid.x.cells, nz = grid.z.cells;
    common::for_each_row(
        nz / 2 + 1,
        [&](long q) {
            const detail::WaveModes z(q, nz);
            for (long p = 0; p <= nx / 2; ++p) {
                const detail::WaveModes x(p, nx);
                const auto at = [&](std::size_t k, long m, long l) {
                    return m < 0 || l < 0 ? 0.0f : amplitude[k](m, l);
                };
                // [cosine or sine of k_x x + k_z z, then of k_x x - k_z z][component]
                std::array<Eigen::Vector3f, 2> plus, minus;
                for (int k = 0; k < 3; ++k) {
                    const auto K = std::size_t(k);
                    const bool half_x = k == 0 && p > 0, half_z = k == 2 && q > 0;
                    const auto low = detail::parts(half_x, at(K, x.cosine, z.cosine),
                                                   at(K, x.sine, z.cosine)),
                               high = detail::parts(half_x, at(K, x.cosine, z.sine),
                                                    at(K, x.sine, z.sine)),
                               of_cos = detail::parts(half_z, low[0], high[0]),
                               of_sin = detail::parts(half_z, low[1], high[1]);
                    plus[0][k] = of_cos[0] - of_sin[1], plus[1][k] = of_sin[0] + of_cos[1];
                    minus[0][k] = of_cos[0] + of_sin[1], minus[1][k] = of_sin[0] - of_cos[1];
                }
                const auto& [of_plus, of_minus] = inverse.wave[std::size_t(p + (nx / 2 + 1) * q)];
                for (std::size_t part = 0; part < 2; ++part) {
                    plus[part] = (0.5f * of_plus * plus[part]).eval();
                    minus[part] = (0.5f * of_minus * minus[part]).eval();
                }
                for (int k = 0; k < 3; ++k) {
                    const auto K = std::size_t(k);
                    const bool half_x = k == 0 && p > 0, half_z = k == 2 && q > 0;
                    const auto of_cos = detail::modes_of(
                                   half_z, {plus[0][k] + minus[0][k], plus[1][k] - minus[1][k]}),
                               of_sin = detail::modes_of(
                                   half_z, {plus[1][k] + minus[1][k], minus[0][k] - plus[0][k]}),
                               low = detail::modes_of(half_x, {of_cos[0], of_sin[0]}),
                               high = detail::modes_of(half_x, {of_cos[1], of_sin[1]});
                    amplitude[K](x.cosine, z.cosine) = low[0];
                    if (x.sine > 0) amplitude[K](x.sine, z.cosine) = low[1];
                    if (z.sine > 0) amplitude[K](x.cosine, z.sine) = high[0];
                    if (x.sine > 0 && z.sine > 0) amplitude[K](x.sine, z.sine) = high[1];
                }
            }
        },
        numbers_to_share(grid));
}

}  // namespace implicit_moment
