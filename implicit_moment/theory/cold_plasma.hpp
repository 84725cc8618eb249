// Waves of small amplitude in a cold uniform plasma at rest, at any angle to its magnetic field: the
// step of each program itself, linearized, as a matrix for one wave number. Its eigenvalues are the
// waves; its powers are the whole evolution.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "implicit_moment/setup/case.hpp"
#include "implicit_moment/smooth.hpp"

namespace implicit_moment {

/// The wave vector of the seeded mode.
struct WaveVector {
    double x, z;
    double size() const { return std::hypot(x, z); }
};
inline WaveVector wave_vector(const Case& w) {
    return {2 * pi * double(w.uniform.mode_x) / w.grid.x.length,
            2 * pi * double(w.uniform.mode_z) / w.grid.z.length};
}

/// What the differences of the mesh see of it: K = (2/dx) sin(k dx/2).
inline WaveVector mesh_wave_vector(const Case& w) {
    const WaveVector k = wave_vector(w);
    const double dx = w.grid.x.spacing(), dz = w.grid.z.spacing();
    return {2 / dx * std::sin(0.5 * k.x * dx), 2 / dz * std::sin(0.5 * k.z * dz)};
}

/// The right-hand side for amplitudes of exp(i k x): 6 + 3 S numbers, E, B and u of each species.
///     dE/dt = i c K x B - 4 pi sum_s n_s q_s u_s,   dB/dt = -i c K x E,
///     du_s/dt = q_s/m_s (E + u_s x B_0/c)
/// exact:  its eigenvalues -i omega are the roots of det[ N N - N^2 + eps(omega) ] = 0 with the cold
///         dielectric tensor eps and N = c K/omega. Sources and pushing field are smoothed.
/// note:   splines see a field a little smaller than it is, by a part (k dx)^2/6 or less.
/// source: Stix, Waves in Plasmas (1992), chapters 1 and 2.
inline Eigen::MatrixXcd cold_rates(const Case& w) {
    const UniformCase& u = w.uniform;
    const WaveVector k = wave_vector(w), K = mesh_wave_vector(w);
    const double S = smoothing_factor(w.field.smoothing, k.x * w.grid.x.spacing()) *
                     smoothing_factor(w.field.smoothing, k.z * w.grid.z.spacing());
    const auto cross = [](double x, double y, double z) {
        Eigen::Matrix3d m;
        m << 0, -z, y, z, 0, -x, -y, x, 0;
        return m;
    };
    const std::complex<double> i(0, 1);
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    const long count = 6 + 3 * long(u.species.size());
    Eigen::MatrixXcd rates = Eigen::MatrixXcd::Zero(count, count);
    rates.block<3, 3>(0, 3) = i * c * cross(K.x, 0, K.z);
    rates.block<3, 3>(3, 0) = -i * c * cross(K.x, 0, K.z);
    for (std::size_t s = 0; s < u.species.size(); ++s) {
        const SpeciesCase& one_of = u.species[s];
        const long at = 6 + 3 * long(s);
        const double per_mass = one_of.charge / one_of.mass;
        rates.block<3, 3>(0, at) = -4 * pi * n0 * one_of.density * one_of.charge * S * one;
        rates.block<3, 3>(at, 0) = per_mass * S * one;
        rates.block<3, 3>(at, at) = -per_mass / c * cross(u.B_x, u.B_y, u.B_z);
    }
    return rates;
}

/// One step of the program on these amplitudes.
///     implicit_moment: f^{n+1} - f^n = dt rates f^level, E and B at theta, u in the middle
///     explicit_em:     u by a whole step, B by half, E by a whole step, B by the other half
inline Eigen::MatrixXcd cold_step(const Case& w) {
    const Eigen::MatrixXcd rates = w.dt * cold_rates(w);
    const long count = rates.rows(), velocities = count - 6;
    const Eigen::MatrixXcd one = Eigen::MatrixXcd::Identity(count, count);
    if (!w.leapfrog.chosen) {
        Eigen::MatrixXcd later = 0.5 * rates;
        later.leftCols(6) = w.field.theta * rates.leftCols(6);
        return (one - later).lu().solve(one + rates - later);
    }
    Eigen::MatrixXcd push = one, ampere = one, faraday = one, rotation = 0 * one;
    push.bottomRows(velocities) += rates.bottomRows(velocities);
    ampere.topRows(3) += rates.topRows(3);
    faraday.middleRows(3, 3) += 0.5 * rates.middleRows(3, 3);
    rotation.bottomRightCorner(velocities, velocities) =
        0.5 * rates.bottomRightCorner(velocities, velocities);
    push = (one - rotation).lu().solve(push - rotation);
    return faraday * ampere * faraday * push;
}

/// The waves of the seeded wave number, slowest first: omega + i gamma of the scheme, omega > 0.
inline std::vector<std::complex<double>> cold_waves(const Case& w) {
    const Eigen::VectorXcd factors = cold_step(w).eigenvalues();
    std::vector<std::complex<double>> waves;
    double fastest = 0;
    for (const std::complex<double> g : factors) {
        waves.emplace_back(-std::arg(g) / w.dt, std::log(std::abs(g)) / w.dt);
        fastest = std::max(fastest, waves.back().real());
    }
    std::erase_if(waves, [&](std::complex<double> one) { return one.real() < 1e-7 * fastest; });
    std::sort(waves.begin(), waves.end(), [](auto a, auto b) { return a.real() < b.real(); });
    const auto same = [&](auto a, auto b) { return b.real() - a.real() < 1e-7 * fastest; };
    waves.erase(std::unique(waves.begin(), waves.end(), same), waves.end());
    return waves;
}

/// Refuses what is not cold and at rest. errors: InputError with the cure.
inline void refuse_warm(const Case& w, const std::string& wave) {
    for (const SpeciesCase& s : w.uniform.species) {
        refuse(s.temperature_x > 0 || s.temperature_y > 0 || s.temperature_z > 0 ||
                   s.drift_x != 0 || s.drift_y != 0 || s.drift_z != 0,
               wave + " is exact for a cold plasma at rest, and species '" + s.name +
                   "' is warm or drifts: choose \"longitudinal\" or \"transverse\"");
    }
}

}  // namespace implicit_moment
