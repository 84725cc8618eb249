// What one time step does to a sound wave.
#pragma once

#include <cmath>
#include <complex>

namespace flip::theory {

/// What is left of a velocity cos k x on the mesh after it went to particles and back.
///   (2 + cos k h) / 3, the mass matrix of linear weights over its row sums
/// note:  many particles, evenly spread.
inline double pic_smoothing(double k, double h) { return (2.0 + std::cos(k * h)) / 3.0; }

/// The part of a sound wave that survives its way from the nodes to particles and back, where linear
/// weights do not see all of it; for long waves all parts are 1.
struct WaveTransfer {
    double kept = 1;                 // of the velocity that particles bring
    double increment = 1;            // of the change of velocity
    double density = 1, energy = 1;  // of the change of pressure: by motion, by work
    double response = 1;             // to a force, over that of the lumped masses
    double level = 0.5;              // between u and u + du at which an explicit pressure works
};

/// The factor by which a step multiplies a sound wave that particles carry.
///   u_new = kept u + increment du
///   p_new = p - i a [density/gamma u_move + energy (1 - 1/gamma) u_work]
/// with du of the mesh alone; explicit: u_move = u + du, u_work = u + level du; of the theta scheme:
/// u_move = u_work = u + theta du
/// in:    theta < 0: explicit; gamma, 1 over the part of density in a change of pressure
/// out:   of the two factors, that of larger phase
/// exact: where nothing is lost, the factor of the scheme on the mesh alone: of the theta scheme
///          [1 + i (1 - theta) a] / (1 - i theta a),
///        explicit, the root of lambda^2 - (2 - w a^2) lambda + 1 + (1 - w) a^2 = 0 with
///        w = 1 - (1 - level) (1 - 1/gamma), which grows unless level = 1. Where flip loses the same
///        of all changes, 1 - s + s lambda: what the mesh does not see stays, even if lambda = 0
inline std::complex<double> carried_factor(double theta, double gamma, double a,
                                           const WaveTransfer& part) {
    const std::complex<double> i(0.0, 1.0);
    const bool implicit = theta >= 0;
    const double by_motion = part.density / gamma, by_work = part.energy * (1.0 - 1.0 / gamma);
    std::complex<double> m[2][2];
    for (int column = 0; column < 2; ++column) {
        const std::complex<double> u = column == 0 ? 1.0 : 0.0, p = column == 0 ? 0.0 : 1.0;
        const std::complex<double> du =
            implicit ? (-i * a * p - theta * a * a * u) / (1.0 + theta * theta * a * a)
                     : -i * a * part.response * p;
        const std::complex<double> move = u + (implicit ? theta : 1.0) * du,
                                   work = u + (implicit ? theta : part.level) * du;
        m[0][column] = part.kept * u + part.increment * du;
        m[1][column] = p - i * a * (by_motion * move + by_work * work);
    }
    const std::complex<double> half = 0.5 * (m[0][0] + m[1][1]),
                               root =
                                   std::sqrt(half * half - m[0][0] * m[1][1] + m[0][1] * m[1][0]);
    return std::arg(half + root) > std::arg(half - root) ? half + root : half - root;
}

}  // namespace flip::theory
