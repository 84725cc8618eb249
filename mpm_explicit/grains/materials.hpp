// Materials: their constants, invariants of stress, and elasticity in plane strain.
#pragma once

#include <cmath>
#include <string>

#include "mpm_explicit/particles.hpp"

namespace mpm {

enum class Law { elastic, j2, drucker_prager, rigid };

/// A material as a case file names it; stresses in the unit of E.
struct Material {
    std::string name;
    Law law = Law::elastic;
    double E = 1e4, nu = 0.3, density = 1000;  // E > 0, -1 < nu < 1/2, density > 0
    double viscosity = 0;                      // time, >= 0
    double yield_stress = 100, hardening = 0;  // j2: Y > 0, H >= 0
    // drucker_prager: cohesion >= 0, 0 <= dilatancy_angle <= friction_angle < 90 degrees, and
    // tension >= 0, the largest mean stress (zero: a loose sand)
    double cohesion = 0, friction_angle = 30, dilatancy_angle = 0, tension = 0;
};

// ---- stress -------------------------------------------------------------------------------------

/// p = -(xx + yy + zz) / 3, positive in compression.
inline double pressure(const Stress& s) { return -(s.xx + s.yy + s.zz) / 3; }

/// J2 = 1/2 s : s of the deviator s = sigma + p 1.
///   [(xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2] / 6 + xy^2
inline double second_invariant(const Stress& s) {
    const double a = s.xx - s.yy, b = s.yy - s.zz, c = s.zz - s.xx;
    return (a * a + b * b + c * c) * (1.0 / 6) + s.xy * s.xy;
}

/// The tension that is as near to yield, (3 J2)^1/2.
inline double von_mises(const Stress& s) { return std::sqrt(3 * second_invariant(s)); }

/// Stress turned with the body, counterclockwise by the angle t = atan(w).
///   R sigma R^T,  cos 2t = (1 - w^2) / (1 + w^2),  sin 2t = 2w / (1 + w^2)
/// in:     w = tan(t), or a small angle itself: the spin 1/2 (dv_y/dx - dv_x/dy) times dt
/// exact:  a rotation for every w, so zz, invariants and elastic energy stay; w = 0 changes nothing
/// note:   Given an angle, it turns by w - w^3/3; the gain is that it takes no sine or cosine.
inline Stress rotated(const Stress& s, double w) {
    const double sine = 2 * w / (1 + w * w), half = 0.5 * (s.xx - s.yy);
    const double from_xx_to_yy = sine * (s.xy + w * half);
    return {s.xx - from_xx_to_yy, s.yy + from_xx_to_yy, s.xy + sine * (half - w * s.xy), s.zz};
}

// ---- elasticity ---------------------------------------------------------------------------------

struct Moduli {
    double lambda = 0, G = 0, K = 0;  // Lame's first constant, shear modulus, bulk modulus
};

///   G = E / (2 (1 + nu)),  lambda = 2 G nu / (1 - 2 nu),  K = lambda + 2G/3
/// out:   rigid: zero, as it has no stress
inline Moduli moduli(const Material& m) {
    if (m.law == Law::rigid) return {};
    const double G = 0.5 * m.E / (1 + m.nu), lambda = 2 * G * m.nu / (1 - 2 * m.nu);
    return {lambda, G, lambda + 2 * G / 3};
}

/// Speed of compression waves, the fastest; rigid: 0, as no wave limits its step.
///   c^2 = (lambda + 2G) / density
inline double sound_speed(const Material& m) {
    const Moduli T = moduli(m);
    return std::sqrt((T.lambda + 2 * T.G) / m.density);
}

/// By how much viscosity beta shortens the step that explicit damping bears, at least 1.
///   leapfrog, omega = 2 c_p/h:  (omega dt/2)^2 + beta omega^2 dt/2 <= 1
///   dt <= (h/c_p) / [z + (1 + z^2)^1/2],  z = beta c_p/h
inline double viscous_shortening(const Material& m, double h) {
    const double z = m.viscosity * sound_speed(m) / h;
    return z + std::sqrt(1 + z * z);
}

/// a : T^-1 : b of two stresses, twice the elastic energy per volume where they are the same.
///   [(1 + nu) a : b - nu tr a tr b] / E,  in three dimensions
/// exact:  symmetric and positive; T^-1 : T = 1
/// note:   An elastic body in plane strain has zz = nu (xx + yy), and then a : T^-1 : a is
///         (1 + nu) / E [(1 - nu) (xx^2 + yy^2) - 2 nu xx yy + 2 xy^2]
///         Once it has yielded, zz goes its own way, so it is in the sum.
struct Compliance {
    explicit Compliance(const Material& m) : shear_((1 + m.nu) / m.E), trace_(m.nu / m.E) {}

    double operator()(const Stress& a, const Stress& b) const {
        return shear_ * (a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2 * a.xy * b.xy) -
               trace_ * (a.xx + a.yy + a.zz) * (b.xx + b.yy + b.zz);
    }

   private:
    double shear_, trace_;
};

}  // namespace mpm
