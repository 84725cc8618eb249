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
// source: Stix, Waves in Plasmas (1992), chapter 10, with quotients of k_along and v_across taken out.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "common/theory/kinetic_dispersion.hpp"
#include "implicit_moment/setup/case.hpp"
#include "implicit_moment/theory/cold_plasma.hpp"

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

/// omega^2 (1 + chi) of all species.
/// in: plasma, Omega not 0; omega not 0
inline Eigen::Matrix3cd dielectric_tensor(const std::vector<MagnetizedSpecies>& plasma,
                                          MagnetizedWave k, std::complex<double> omega) {
    using Complex = std::complex<double>;
    const Complex i(0, 1);
    Eigen::Matrix3cd tensor = omega * omega * Eigen::Matrix3cd::Identity();
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
            const Complex A = -1.0 + k.along * k.along * across2 * R + turn * Z,
                          B = s.drift * A + k.along * (w * across2 + turn * along2) * R;
            Eigen::Matrix3cd Y;
            Y << double(n) * G * A, -i * double(n) * H * A, per_Omega * G * B,
                i * double(n) * H * A, (n * G + 2 * lambda * H) * A, i * per_Omega * H * B,
                per_Omega * G * B, -i * per_Omega * H * B,
                E * (omega - turn) * (omega - turn) * R +
                    k.across * per_Omega * G *
                        (along2 * (w + 2 * k.along * s.drift) * R + s.drift * s.drift * Z);
            sum += Y;
        }
        tensor += s.omega2 * sum;
    }
    return tensor;
}

/// D(omega) = det[ c^2 (k k - k^2) + omega^2 (1 + chi) ].
/// exact:  k along B: the product of longitudinal_dispersion() and both transverse_dispersion()s;
///         cold: zero at the eigenvalues of cold_rates()
inline std::complex<double> magnetized_dispersion(const std::vector<MagnetizedSpecies>& plasma,
                                                  MagnetizedWave k, double speed_of_light,
                                                  std::complex<double> omega) {
    const Eigen::Vector3d vector(k.across, 0, k.along);
    const Eigen::Matrix3d curl =
        vector * vector.transpose() - vector.squaredNorm() * Eigen::Matrix3d::Identity();
    return (speed_of_light * speed_of_light * curl + dielectric_tensor(plasma, k, omega))
        .determinant();
}

/// The seeded mode and the species of a case in the frame of its uniform field.
inline MagnetizedWave magnetized_wave(const Case& w) {
    const WaveVector k = wave_vector(w);
    const Eigen::Vector3d vector(k.x, 0, k.z), B(w.uniform.B_x, w.uniform.B_y, w.uniform.B_z);
    return {vector.dot(B) / B.norm(), vector.cross(B).norm() / B.norm()};
}
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

}  // namespace implicit_moment
