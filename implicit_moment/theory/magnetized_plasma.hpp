// Waves of small amplitude in a warm uniform plasma, at any angle to its magnetic field: the
// determinant of Maxwell's equations with the dielectric tensor of drifting bi-Maxwellians.
//
// A particle that gyrates meets the wave at every harmonic n of its gyrofrequency Omega:
//     w_n = omega - k_along u - n Omega,  a = 2^1/2 k_along v_along,  Z_n = Z(w_n / a) / a,
//     R_n = [1 + (w_n / a) Z(w_n / a)] / (k_along v_along)^2
// which are -1/w_n and -1/w_n^2 where k_along v_along = 0. With lambda = (k_across v_across / Omega)^2
// and the modified Bessel functions I_n
//     E_n = exp(-lambda) I_n(lambda),  G_n = (E_(n-1) - E_(n+1)) / 2 = n E_n / lambda,
//     H_n = E_n - (E_(n-1) + E_(n+1)) / 2,
//     omega A_n = -1 + (k_along v_across)^2 R_n + n Omega Z_n,
//     omega B_n = u omega A_n + k_along (w_n v_across^2 + n Omega v_along^2) R_n,
// the susceptibility is chi = (omega_s^2 / omega) sum_n Y_n, x across B with k, z along B:
//     Y_xx = n G_n A_n,  Y_yy = (n G_n + 2 lambda H_n) A_n,  Y_xy = -Y_yx = -i n H_n A_n,
//     Y_xz = Y_zx = (k_across / Omega) G_n B_n,  Y_yz = -Y_zy = i (k_across / Omega) H_n B_n,
//     omega Y_zz = E_n (omega - n Omega)^2 R_n
//                  + (k_across^2 / Omega) G_n [v_along^2 (w_n + 2 k_along u) R_n + u^2 Z_n]
// An E without its B would give instead
//     A_n = Z_n,   B_n = k_along v_across^2 R_n in Y_xz and Y_yz,   u Z_n + k_along v_along^2 R_n in Y_zx and Y_zy,
//     Y_zz = E_n (omega - n Omega) R_n
// which counts where particles feel a smoothed E and B as it is, and drift or have two temperatures.
// source: Stix, Waves in Plasmas (1992), chapter 10, with quotients of k_along and v_across taken out.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"
#include "implicit_moment/theory/images_of_mode.hpp"

namespace implicit_moment {

/// A species of a magnetized plasma, in the frame of its field.
struct MagnetizedSpecies {
    double omega2 = 0;  // omega_s^2 = 4 pi n q^2/m
    double Omega = 0;   // q B/(m c), with its sign
    double drift = 0, v_along = 0, v_across = 0;
};

/// A wave number along and across the field.
struct MagnetizedWave {
    double along = 0, across = 0;
};

/// (k v_t/Omega)^2 across the field; 9 times its square root is how many harmonics count.
inline double gyration_squared(const MagnetizedSpecies& s, const MagnetizedWave& k) {
    return std::pow(k.across * s.v_across / s.Omega, 2);
}

/// omega^2 chi of all species, which feel a part of E and the whole B.
/// in: plasma, Omega not 0; omega not 0
inline Eigen::Matrix3cd magnetized_response(const std::vector<MagnetizedSpecies>& plasma,
                                            MagnetizedWave k, std::complex<double> omega,
                                            double part_of_E = 1) {
    using Complex = std::complex<double>;
    const Complex i(0, 1), less = (part_of_E - 1) * omega;
    Eigen::Matrix3cd tensor = Eigen::Matrix3cd::Zero();
    for (const MagnetizedSpecies& s : plasma) {
        const double lambda = gyration_squared(s, k);
        const std::vector<double> harmonics = common::harmonics_of_maxwellian(lambda);
        const auto I_of = [&](int n) { return harmonics[std::size_t(std::abs(n))]; };
        const int count = int(harmonics.size()) - 2;
        const double kv = k.along * s.v_along, a = std::numbers::sqrt2 * std::fabs(kv);
        Eigen::Matrix3cd sum = Eigen::Matrix3cd::Zero();
        for (int n = -count; n <= count; ++n) {
            const double turn = n * s.Omega, per_Omega = k.across / s.Omega;
            const double E = I_of(n), G = 0.5 * (I_of(n - 1) - I_of(n + 1)),
                         H = E - 0.5 * (I_of(n - 1) + I_of(n + 1));
            const Complex w = omega - k.along * s.drift - turn;
            Complex Z = -1.0 / w, R = -1.0 / (w * w);
            if (a > 0) {
                const auto f = common::plasma_dispersion_detail::values(w / a);
                Z = f.Z / a, R = f.one_plus_zeta_Z / (kv * kv);
            }
            const double along2 = s.v_along * s.v_along, across2 = s.v_across * s.v_across;
            const Complex A_full = -1.0 + k.along * k.along * across2 * R + turn * Z,
                          B_full = s.drift * A_full + k.along * (w * across2 + turn * along2) * R,
                          A = A_full + less * Z, B = B_full + less * k.along * across2 * R,
                          B_z = B_full + less * (s.drift * Z + k.along * along2 * R);
            Eigen::Matrix3cd Y;
            Y << double(n) * G * A, -i * double(n) * H * A, per_Omega * G * B,
                i * double(n) * H * A, (n * G + 2 * lambda * H) * A, i * per_Omega * H * B,
                per_Omega * G * B_z, -i * per_Omega * H * B_z,
                E * (omega - turn) * (omega - turn + less) * R +
                    k.across * per_Omega * G *
                        (along2 * (w + 2 * k.along * s.drift) * R + s.drift * s.drift * Z);
            sum += Y;
        }
        tensor += s.omega2 * sum;
    }
    return tensor;
}

/// c^2 (k k - k^2) + omega^2.
inline Eigen::Matrix3cd vacuum_waves(const Eigen::Vector3d& k, double speed_of_light,
                                     std::complex<double> omega) {
    const Eigen::Matrix3d curl = k * k.transpose() - k.squaredNorm() * Eigen::Matrix3d::Identity();
    return speed_of_light * speed_of_light * curl + omega * omega * Eigen::Matrix3cd::Identity();
}

/// The matrix c^2 (k k - k^2) + omega^2 (1 + chi), in the frame of the field.
inline Eigen::Matrix3cd magnetized_waves(const std::vector<MagnetizedSpecies>& plasma,
                                         MagnetizedWave k, double speed_of_light,
                                         std::complex<double> omega) {
    return vacuum_waves(Eigen::Vector3d(k.across, 0, k.along), speed_of_light, omega) +
           magnetized_response(plasma, k, omega);
}

/// D(omega), its determinant.
/// exact:  k along B: the product of longitudinal_dispersion() and both transverse_dispersion()s;
///         cold: zero at the eigenvalues of cold_rates()
inline std::complex<double> magnetized_dispersion(const std::vector<MagnetizedSpecies>& plasma,
                                                  MagnetizedWave k, double speed_of_light,
                                                  std::complex<double> omega) {
    return magnetized_waves(plasma, k, speed_of_light, omega).determinant();
}

/// E of the wave with a root omega of D, of length 1: across all rows of the matrix.
inline Eigen::Vector3cd magnetized_E(const std::vector<MagnetizedSpecies>& plasma, MagnetizedWave k,
                                     double speed_of_light, std::complex<double> omega) {
    const Eigen::Matrix3cd M = magnetized_waves(plasma, k, speed_of_light, omega);
    Eigen::Vector3cd E(0, 0, 0);
    for (long a = 0; a < 3; ++a) {
        const Eigen::Vector3cd row = M.row(a), next = M.row((a + 1) % 3);
        // Eigen's cross() of complex vectors conjugates in some releases.
        const Eigen::Vector3cd across(row[1] * next[2] - row[2] * next[1],
                                      row[2] * next[0] - row[0] * next[2],
                                      row[0] * next[1] - row[1] * next[0]);
        if (across.norm() > E.norm()) E = across;
    }
    return E.normalized();
}

/// The axes of the frame of the uniform field of a case: across it with k, across both, and along it.
inline Eigen::Matrix3d frame_of_field(const Case& w, WaveVector k) {
    const Eigen::Vector3d vector(k.x, 0, k.z),
        b = Eigen::Vector3d(w.uniform.B_x, w.uniform.B_y, w.uniform.B_z).normalized(),
        across = vector - vector.dot(b) * b;
    Eigen::Matrix3d axes;
    axes.col(0) = across.norm() > 1e-9 * vector.norm() ? across.normalized() : b.unitOrthogonal();
    axes.col(1) = b.cross(axes.col(0)), axes.col(2) = b;
    return axes;
}
inline MagnetizedWave magnetized_wave(const Case& w, WaveVector k) {
    const Eigen::Vector3d in_frame =
        frame_of_field(w, k).transpose() * Eigen::Vector3d(k.x, 0, k.z);
    return {in_frame[2], in_frame[0]};
}

/// The species of a case in that frame.
/// in:  species that refuse_magnetized() accepts
/// out: those with a charge; others answer no field
inline std::vector<MagnetizedSpecies> magnetized_species(const Case& w) {
    const UniformCase& u = w.uniform;
    const Eigen::Vector3d B(u.B_x, u.B_y, u.B_z), b = B.normalized();
    std::vector<MagnetizedSpecies> plasma;
    for (const SpeciesCase& s : u.species) {
        if (s.charge == 0) continue;
        const Eigen::Vector3d T(s.temperature_x, s.temperature_y, s.temperature_z),
            drift(s.drift_x, s.drift_y, s.drift_z);
        const double along = T.dot(b.cwiseAbs2()), across = 0.5 * (T.sum() - along);
        plasma.push_back({4 * pi * n0 * s.density * s.charge * s.charge / s.mass,
                          s.charge * B.norm() / (s.mass * c), drift.dot(b),
                          std::sqrt(along / s.mass), std::sqrt(across / s.mass)});
    }
    return plasma;
}

/// D(omega) on the mesh of a case, K in the place of k, with a part S of E that is left by smoothing.
///     det[ c^2 (K K - K^2) + omega^2 + S sum_m weight(m) omega^2 chi(k_m) weight(m) ]
/// exact:  cold: zero at the eigenvalues of cold_rates(), as far as images_of_mode() has all images
/// note:   for steps much shorter than the period, like chi. Images that a species gyrates across more than 300 times
///         are mixed away.
/// source: Langdon, J. Comput. Phys. 6, 247 (1970), for waves with E along k.
inline std::complex<double> magnetized_dispersion_on_mesh(const Case& w,
                                                          std::complex<double> omega) {
    const std::vector<MagnetizedSpecies> plasma = magnetized_species(w);
    const WaveVector k = wave_vector(w), K = mesh_wave_vector(w);
    const double S = smoothing_of_mode(w);
    Eigen::Matrix3cd tensor = vacuum_waves({K.x, 0, K.z}, c, omega);
    for (const ImageOfMode& image : images_of_mode(w)) {
        const MagnetizedWave k_m = magnetized_wave(w, image.k);
        std::vector<MagnetizedSpecies> answering = plasma;
        if (image.k.x != k.x || image.k.z != k.z)
            std::erase_if(answering, [&](const auto& s) { return gyration_squared(s, k_m) > 9e4; });
        const Eigen::Matrix3d weight = image.weight.asDiagonal() * frame_of_field(w, image.k);
        tensor += S * weight * magnetized_response(answering, k_m, omega, S) * weight.transpose();
    }
    return tensor.determinant();
}

}  // namespace implicit_moment
