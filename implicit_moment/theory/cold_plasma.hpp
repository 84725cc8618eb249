// Waves of small amplitude in a cold uniform plasma at rest, at any angle to its magnetic field: the
// step of each program itself with its mesh and splines, linearized, as a matrix for one wave number. Its
// eigenvalues are the waves; its powers are the whole evolution.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "implicit_moment/field/apply_mass_matrix.hpp"
#include "implicit_moment/theory/eigenvalues.hpp"
#include "implicit_moment/theory/images_of_mode.hpp"

namespace implicit_moment {

/// A mode and its images. Cold particles at rest answer all images alike, so that three rows of weights with the
/// overlaps of all of them stand for those beside k.
struct MeshOfMode {
    static constexpr long images = 4;         // k, and one for each component
    Eigen::Matrix<double, 3, images> weight;  // smoothed
    Eigen::Matrix3d to_nodes;                 // the means with which chi goes to nodes and back
    double smoothing;
};

/// exact:  weight weight^T are the overlaps of the splines of two components, the sum over all images.
inline MeshOfMode mesh_of_mode(const Case& w) {
    const WaveVector k = wave_vector(w);
    const double x = k.x * w.grid.x.spacing(), z = k.z * w.grid.z.spacing();
    // Overlaps in one direction, of splines that both stand half a cell from the nodes, or none, or one of them.
    const auto products = [&](const auto& half, const auto& whole, const auto& between) {
        const double xy = between(x) * whole(z), yz = whole(x) * between(z),
                     xz = between(x) * between(z);
        Eigen::Matrix3d all;
        all << half(x) * whole(z), xy, xz, xy, whole(x) * whole(z), yz, xz, yz, whole(x) * half(z);
        return all;
    };
    const auto one = [](double) { return 1.0; };
    const auto mean = [](double angle) { return std::cos(0.5 * angle); };
    const auto sinc = [](double angle) {
        return angle == 0 ? 1 : std::sin(0.5 * angle) / (0.5 * angle);
    };
    const Eigen::Matrix3d overlap =
        has_linear_splines(w) ? products(one, linear_overlap, mean)
                              : products(linear_overlap, quadratic_overlap, mixed_overlap);
    const double at_nodes = std::pow(sinc(x) * sinc(z), has_linear_splines(w) ? 2 : 3);
    MeshOfMode mesh;
    mesh.weight.col(0) << at_nodes / sinc(x), at_nodes, at_nodes / sinc(z);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rest(
        overlap - mesh.weight.col(0) * mesh.weight.col(0).transpose());
    mesh.weight.rightCols(3) =
        rest.eigenvectors() * rest.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
    mesh.smoothing = smoothing_of_mode(w);
    mesh.weight *= mesh.smoothing;
    mesh.to_nodes = products(one, one, mean);
    return mesh;
}

/// The first of the three numbers of u of species s and image m among the amplitudes: E, B, rho, then these.
inline long place_of(std::size_t s, long m) { return 7 + 3 * (MeshOfMode::images * long(s) + m); }

/// v -> (x, y, z) x v.
inline Eigen::Matrix3d cross_product(double x, double y, double z) {
    Eigen::Matrix3d m;
    m << 0, -z, y, z, 0, -x, -y, x, 0;
    return m;
}

/// The right-hand side for amplitudes of exp(i k x).
///     dE/dt = i c K x B - 4 pi J,   dB/dt = -i c K x E,   drho/dt = -i K . J,
///     J = sum n_s q_s weight(m) u_sm,   du_sm/dt = q_s/m_s (weight(m) E + u_sm x B_0/c)
/// exact:  for small k dx its eigenvalues -i omega are the roots of det[ N N - N^2 + eps(omega) ] = 0 with the cold
///         dielectric tensor eps and N = c K/omega.
/// source: Stix, Waves in Plasmas (1992), chapters 1 and 2.
inline Eigen::MatrixXcd cold_rates(const Case& w) {
    const UniformCase& u = w.uniform;
    const WaveVector K = mesh_wave_vector(w);
    const MeshOfMode mesh = mesh_of_mode(w);
    const std::complex<double> i(0, 1);
    const long count = place_of(u.species.size(), 0);
    Eigen::MatrixXcd rates = Eigen::MatrixXcd::Zero(count, count);
    rates.block<3, 3>(0, 3) = i * c * cross_product(K.x, 0, K.z);
    rates.block<3, 3>(3, 0) = -rates.block<3, 3>(0, 3);
    for (std::size_t s = 0; s < u.species.size(); ++s) {
        const SpeciesCase& one_of = u.species[s];
        const double per_mass = one_of.charge / one_of.mass;
        for (long m = 0; m < mesh.images; ++m) {
            const long at = place_of(s, m);
            const Eigen::Matrix3d weight = mesh.weight.col(m).asDiagonal(),
                                  J = n0 * one_of.density * one_of.charge * weight;
            rates.block<3, 3>(0, at) = -4 * pi * J;
            rates.block<1, 3>(6, at) = -i * (Eigen::RowVector3d(K.x, 0, K.z) * J);
            rates.block<3, 3>(at, 0) = per_mass * weight;
            rates.block<3, 3>(at, at) = -per_mass / c * cross_product(u.B_x, u.B_y, u.B_z);
        }
    }
    return rates;
}

/// The same step with the current that moments predict in Ampere's law, where chi is on nodes and not an overlap
/// of splines, and with Gauss's law of solve_field.hpp:
///     J = sum n q weight R u^n + chi E^{n+theta},   chi = n q (q dt/2m) R,   and   i K c^2 theta dt G^{n+theta},
///     (1 + c^2 theta^2 dt^2 K^2) G^{n+theta} = i K . E^n - 4 pi rho^n
/// in/out: later f^{n+1} = now f^n
inline void predict_cold_current(const Case& w, Eigen::MatrixXcd& later, Eigen::MatrixXcd& now) {
    const UniformCase& u = w.uniform;
    const WaveVector K = mesh_wave_vector(w);
    const MeshOfMode mesh = mesh_of_mode(w);
    const double theta = w.field.theta, a = c * theta * w.dt;
    const std::complex<double> i(0, 1);
    for (std::size_t s = 0; s < u.species.size(); ++s) {
        const double half_kick = 0.5 * w.dt * u.species[s].charge / u.species[s].mass,
                     by_J = 4 * pi * n0 * u.species[s].density * u.species[s].charge * w.dt;
        const Eigen::Matrix3d R = (Eigen::Matrix3d::Identity() +
                                   half_kick / c * cross_product(u.B_x, u.B_y, u.B_z))
                                      .inverse(),
                              lumped = mesh.to_nodes.cwiseProduct(R),
                              chi = by_J * half_kick * mesh.smoothing * mesh.smoothing * lumped;
        later.block<3, 3>(0, 0) += theta * chi;
        now.block<3, 3>(0, 0) -= (1 - theta) * chi;
        for (long m = 0; m < mesh.images; ++m) {
            const Eigen::Matrix3d weight = by_J * mesh.weight.col(m).asDiagonal().toDenseMatrix();
            later.block<3, 3>(0, place_of(s, m)).setZero();
            now.block<3, 3>(0, place_of(s, m)) =
                w.field.rotates_on_mesh() ? -lumped * weight : -weight * R;
        }
    }
    const Eigen::Vector3cd gradient = i * Eigen::Vector3d(K.x, 0, K.z),
                           by_G = c * a * w.dt / (1 + a * a * K.size() * K.size()) * gradient;
    now.block<3, 3>(0, 0) += by_G * gradient.transpose();
    now.block<3, 1>(0, 6) -= 4 * pi * by_G;
}

/// One step of the program on these amplitudes.
///     implicit_moment: f^{n+1} - f^n = dt rates f^level, E and B at theta, u in the middle
///     explicit_em:     u by a whole step, B by half, E by a whole step, B by the other half
inline Eigen::MatrixXcd cold_step(const Case& w) {
    const Eigen::MatrixXcd rates = w.dt * cold_rates(w);
    const long count = rates.rows(), velocities = count - 7;
    const Eigen::MatrixXcd one = Eigen::MatrixXcd::Identity(count, count);
    if (!w.leapfrog.chosen) {
        Eigen::MatrixXcd half = 0.5 * rates;
        half.leftCols(6) = w.field.theta * rates.leftCols(6);
        Eigen::MatrixXcd later = one - half, now = one + rates - half;
        if (!w.field.uses_mass_matrix()) predict_cold_current(w, later, now);
        return later.lu().solve(now);
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

/// u from t^0 to t^{-1/2} as explicit_em takes it: back half the rotation, then half the kick.
inline void take_half_step_back(const Case& w, Eigen::VectorXcd& state) {
    const Eigen::MatrixXcd rates = w.dt * cold_rates(w);
    const long u = rates.rows() - place_of(0, 0);
    const Eigen::MatrixXcd one = Eigen::MatrixXcd::Identity(u, u),
                           turn = 0.25 * rates.bottomRightCorner(u, u);
    const Eigen::VectorXcd turned = (one + turn).lu().solve((one - turn) * state.tail(u));
    state.tail(u) = turned - 0.5 * rates.bottomLeftCorner(u, 3) * state.head(3);
}

/// A wave of the scheme.
struct ColdWave {
    std::complex<double> omega;  // omega + i gamma, omega > 0
    double along;                // the part of |E|^2 that is along K
    double followed;             // the part of |E|^2 + |B|^2 that is in theory.component
};

/// The waves of the seeded wave number, slowest first.
/// note:   gyrations that the mesh hardly sees, with most of their energy in images of k, are left out.
inline std::vector<ColdWave> cold_waves(const Case& w) {
    const Eigensystem modes = eigensystem(cold_step(w));
    const WaveVector K = mesh_wave_vector(w);
    const long component = w.component[2] - 'x' + (w.component[0] == 'B' ? 3 : 0);
    std::vector<ColdWave> waves;
    double fastest = 0;
    for (long n = 0; n < modes.values.size(); ++n) {
        const Eigen::VectorXcd mode = modes.vectors.col(n);
        double of_k = mode.head(6).squaredNorm() / (8 * pi), of_images = 0;
        for (std::size_t s = 0; s < w.uniform.species.size(); ++s) {
            const SpeciesCase& one_of = w.uniform.species[s];
            const double half = 0.5 * n0 * one_of.density * one_of.mass,
                         of_u = half * mode.segment(place_of(s, 0), 3).squaredNorm();
            of_k += of_u;
            of_images +=
                half * mode.segment(place_of(s, 0), 3 * MeshOfMode::images).squaredNorm() - of_u;
        }
        if (of_images > of_k) continue;
        const std::complex<double> g = modes.values[n];
        // Half a turn in a step has no sense: it counts as forward.
        const double growth = std::log(std::abs(g)), turn = -std::arg(g);
        waves.push_back(
            {{(turn < 1e-9 - pi ? pi : turn) / w.dt, std::fabs(growth) < 1e-12 ? 0 : growth / w.dt},
             std::norm(K.x * mode[0] + K.z * mode[2]) /
                 (K.size() * K.size() * mode.head(3).squaredNorm()),
             std::norm(mode[component]) / mode.head(6).squaredNorm()});
        fastest = std::max(fastest, waves.back().omega.real());
    }
    std::erase_if(waves, [&](const ColdWave& one) { return one.omega.real() < 1e-7 * fastest; });
    std::ranges::sort(waves, {}, [](const ColdWave& one) { return one.omega.real(); });
    return waves;
}

/// Refuses what is not cold and at rest. errors: InputError with the cure.
inline void refuse_warm(const Case& w, const std::string& wave) {
    for (const SpeciesCase& s : w.uniform.species) {
        refuse(s.temperature_x > 0 || s.temperature_y > 0 || s.temperature_z > 0 ||
                   s.drift_x != 0 || s.drift_y != 0 || s.drift_z != 0,
               wave, " is exact for a cold plasma at rest, and species '", s.name,
               "' is warm or drifts: choose \"longitudinal\", \"transverse\" or \"magnetized\"");
    }
}

}  // namespace implicit_moment
