// Sound as theory has it on a mesh without particles, and in a mixture.
#pragma once

#include <cmath>
#include <complex>

namespace flip::theory {

/// The factor by which a step of the theta scheme multiplies a sound wave.
///   u_new = u - i a p_theta,  p_new = p - i a u_theta,  q_theta = (1 - theta) q + theta q_new
///   lambda = [1 + i (1 - theta) a] / (1 - i theta a)
/// in:    a = c kappa dt, with kappa the wave number that the mesh sees
/// out:   of the two factors, which are conjugate, the one of positive phase
/// exact: |lambda|^2 = [1 + (1 - theta)^2 a^2] / (1 + theta^2 a^2), 1 for theta = 1/2
inline std::complex<double> theta_factor(double theta, double a) {
    const std::complex<double> i(0.0, 1.0);
    return (1.0 + i * (1.0 - theta) * a) / (1.0 - i * theta * a);
}

/// How a step of the theta scheme changes the amplitude of a sound wave.
inline double theta_amplification(double theta, double a) {
    return std::hypot(1.0, (1.0 - theta) * a) / std::hypot(1.0, theta * a);
}

/// How far a step of the theta scheme turns a sound wave; a, to second order.
///   phase = atan((1 - theta) a) + atan(theta a)
inline double theta_phase(double theta, double a) {
    return std::atan((1.0 - theta) * a) + std::atan(theta * a);
}

/// The factor by which an explicit step multiplies a sound wave: density follows the new velocity,
/// internal energy the mean of old and new.
///   u_new = u - i a p,  p_new = p - i a [w u_new + (1 - w) u],  w = (gamma + 1) / (2 gamma)
///   lambda^2 - (2 - w a^2) lambda + 1 + (1 - w) a^2 = 0
/// in:    a = c kappa dt, with kappa the wave number that the mesh sees; a < 2 / w
/// out:   of the two factors, which are conjugate, the one of positive phase
/// exact: |lambda|^2 = 1 + (1 - w) a^2: the wave grows, whatever the step
inline std::complex<double> explicit_factor(double gamma, double a) {
    const double w = (gamma + 1.0) / (2.0 * gamma);
    const double half = 1.0 - 0.5 * w * a * a, product = 1.0 + (1.0 - w) * a * a;
    return half + std::sqrt(std::complex<double>(half * half - product));
}

/// How an explicit step changes the amplitude of a sound wave.
///   |lambda| = {1 + (gamma - 1) / (2 gamma) a^2}^1/2
inline double explicit_amplification(double gamma, double a) {
    return std::sqrt(1.0 + (gamma - 1.0) / (2.0 * gamma) * a * a);
}

struct MixturePart {
    double volume_fraction, density, sound_speed;
};

/// The speed of sound in a fine mixture of two fluids that share pressure and velocity.
///   1 / (rho c^2) = sum phi / (rho_k c_k^2),  rho = sum phi rho_k
/// exact: that of either fluid where it is alone; water with air bubbles is slower than both
/// source: Wood, A Textbook of Sound (1930).
inline double wood_sound_speed(const MixturePart& a, const MixturePart& b) {
    const auto compliance = [](const MixturePart& m) {
        return m.volume_fraction / (m.density * m.sound_speed * m.sound_speed);
    };
    const double rho = a.volume_fraction * a.density + b.volume_fraction * b.density;
    return 1.0 / std::sqrt(rho * (compliance(a) + compliance(b)));
}

}  // namespace flip::theory
