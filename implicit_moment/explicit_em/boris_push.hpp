// Boris's push of one particle, or of several at once: u = gamma v, the momentum per mass, by one step
// or by half a step.
#pragma once

#include "implicit_moment/mean_velocity.hpp"
#include "implicit_moment/simd.hpp"

namespace implicit_moment {

/// How explicit_em takes a step; implicit_moment does not read it.
struct LeapfrogSettings {
    bool chosen = false;  // the run is explicit_em's
    long order = 1;       // of the spline of the charge: 1 linear, 2 quadratic
    bool relativistic = true;

    /// 1/c^2, or 0 for a push that is not relativistic.
    double per_c_squared() const { return relativistic ? 1 / (c * c) : 0; }
};

/// Rotation of u about B by the angle 2 atan |t|, t = k B / gamma:  u' = u + (u + u x t) x s,
/// s = 2 t / (1 + t^2); with K = k B that is
///     u' = u + 2 / (gamma^2 + K^2) [ gamma u x K + (u x K) x K ],
/// which divides once.
/// exact:  |u| is unchanged; -k rotates back.
/// source: Boris, Proc. 4th Conf. Numerical Simulation of Plasmas (1970).
template <class Real>
inline void rotate(Velocity<Real>& u, const LocalField<Real>& at, NumberOf<Real> k,
                   NumberOf<Real> per_c_squared) {
    const Real K_x = k * at.B_x, K_y = k * at.B_y, K_z = k * at.B_z;
    const Real gamma_2 = gamma_squared(u, per_c_squared);
    const Real gamma = square_root(gamma_2);
    const Real part = 2.0 / (gamma_2 + K_x * K_x + K_y * K_y + K_z * K_z);
    const Real w_x = u.y * K_z - u.z * K_y, w_y = u.z * K_x - u.x * K_z,
               w_z = u.x * K_y - u.y * K_x;
    u.x += part * (gamma * w_x + w_y * K_z - w_z * K_y);
    u.y += part * (gamma * w_y + w_z * K_x - w_x * K_z);
    u.z += part * (gamma * w_z + w_x * K_y - w_y * K_x);
}

/// Boris's step from u^{n-1/2} to u^{n+1/2}: half the kick of E, the rotation about B, the other
/// half.
/// in:     half_kick = q dt / 2m; per_c_squared = 1/c^2, or 0 for a push that is not relativistic.
// [boris]
template <class Real>
inline void push(Velocity<Real>& u, const LocalField<Real>& at, NumberOf<Real> half_kick,
                 NumberOf<Real> per_c_squared) {
    u.x += half_kick * at.E_x, u.y += half_kick * at.E_y, u.z += half_kick * at.E_z;
    rotate(u, at, half_kick / NumberOf<Real>(c), per_c_squared);
    u.x += half_kick * at.E_x, u.y += half_kick * at.E_y, u.z += half_kick * at.E_z;
}
// [/boris]

/// u^n from u^{n-1/2}: half the kick of E, then the rotation of half a step, by 2 atan(|t|/2).
/// exact:  half_step_back undoes it.
template <class Real>
inline void half_step(Velocity<Real>& u, const LocalField<Real>& at, NumberOf<Real> half_kick,
                      NumberOf<Real> per_c_squared) {
    u.x += half_kick * at.E_x, u.y += half_kick * at.E_y, u.z += half_kick * at.E_z;
    rotate(u, at, half_kick / NumberOf<Real>(2 * c), per_c_squared);
}

/// u^{n-1/2} from u^n.
template <class Real>
inline void half_step_back(Velocity<Real>& u, const LocalField<Real>& at, NumberOf<Real> half_kick,
                           NumberOf<Real> per_c_squared) {
    rotate(u, at, half_kick / NumberOf<Real>(-2 * c), per_c_squared);
    u.x -= half_kick * at.E_x, u.y -= half_kick * at.E_y, u.z -= half_kick * at.E_z;
}

}  // namespace implicit_moment
