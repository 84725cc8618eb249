// Material laws of plane strain: how a step of strain changes the stress.
//
//   elastic          sigma^1 - sigma^0 = T : de                                    [MPM-2, 7, 10]
//   j2               the same, and shear stress is held at Y + H ep by radial return
//   drucker_prager   shear strength grows with pressure; no tension beyond a cut-off
//   rigid            no stress: the grain moves as it is told
//
// A law is a struct of constants with one operator, which a loop over particles calls. It tries an
// elastic step; where the stress is then more than the material bears, it takes stress away, and
// the strain that this stands for is plastic:
//     sigma^1 = sigma^0 + T : (de - de^p)
// What can be got back is the elastic energy 1/2 V sigma : T^-1 : sigma. For T see Elastic, for
// T^-1 see Compliance. A strain that is not a number gives a stress that is not one.
//
// Laws choose values, not ways, so a loop over them can be vectorized (roots: -fno-math-errno). In
// it, let a Stress be made of its four numbers: the copy of a whole one stops the compiler.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <variant>
#include <vector>

#include "mpm_explicit/grains/materials.hpp"

namespace mpm {

/// Plastic strain of a step; with zz, as only the total strain is confined to the plane.
struct PlasticStep {
    double xx = 0, yy = 0, xy = 0, zz = 0;  // xy the tensor component
};

/// sigma : de^p, the work per volume that plastic flow takes.
inline double work(const Stress& s, const PlasticStep& dep) {
    return s.xx * dep.xx + s.yy * dep.yy + s.zz * dep.zz + 2 * s.xy * dep.xy;
}

/// Linear elasticity.                                                         [MPM-2, 7, 10]
///   T : de = lambda tr(de) 1 + 2G de,  de_zz = 0
/// in:     de, strain of the step
/// in/out: s, stress; ep, accumulated plastic strain, which stays
/// out:    dep, plastic strain of the step: none
struct Elastic {
    explicit Elastic(const Material& m) : T(moduli(m)) {}

    void operator()(const StrainStep& de, Stress& s, PlasticStep& dep, double& /*ep*/) const {
        strain(de, s);
        dep.xx = dep.yy = dep.xy = dep.zz = 0;
    }

    /// The elastic step by itself.
    void strain(const StrainStep& de, Stress& s) const {
        const double all_round = T.lambda * (de.xx + de.yy), two_G = 2 * T.G;
        s.xx += all_round + two_G * de.xx;
        s.yy += all_round + two_G * de.yy;
        s.xy += two_G * de.xy;
        s.zz += all_round;
    }

    Moduli T;
};

namespace detail {

/// Strain per stress of one material: 1/(2G) for a deviator, 1/(3K) for a mean stress.
struct Softness {
    double deviator, mean;
    explicit Softness(const Moduli& T) : deviator(0.5 / T.G), mean(1 / (3 * T.K)) {}
};

/// Takes part of the deviator, 0 to 1, and some mean stress away.
/// out:    dep, the plastic strain that this stands for
/// exact:  nothing changes where both are zero
inline void take_away(double part, double mean_stress, const Softness& softness, Stress& s,
                      PlasticStep& dep) {
    const double mean = -pressure(s), swelling = softness.mean * mean_stress;
    const double xx = part * (s.xx - mean), yy = part * (s.yy - mean), zz = part * (s.zz - mean),
                 xy = part * s.xy;
    s.xx -= xx + mean_stress, s.yy -= yy + mean_stress, s.xy -= xy, s.zz -= zz + mean_stress;
    dep.xx = softness.deviator * xx + swelling, dep.yy = softness.deviator * yy + swelling;
    dep.xy = softness.deviator * xy, dep.zz = softness.deviator * zz + swelling;
}

}  // namespace detail

/// Von Mises plasticity with linear isotropic hardening: metals.
///   q = (3 J2)^1/2 <= Y + H ep
/// Beyond, with the deviator s and q of the elastic step, it goes back along the radius:
///   dep_eq = (q - Y - H ep) / (3G + H),  de^p = 3/2 dep_eq s/q,  s^1 = s (1 - 3G dep_eq / q)
/// in:     de, strain of the step
/// in/out: s, stress; ep, the sum of dep_eq = (2/3 de^p : de^p)^1/2
/// out:    dep, plastic strain of the step
/// exact:  ends on the surface; one step or many where strain grows in proportion from no stress;
///         no plastic change of volume; sigma : de^p >= 0 with sigma^1 and with the mean of sigma^0
///         and sigma^1, as q^0 <= q^1
/// source: Wilkins, Methods in Computational Physics 3, 211 (1964).
struct J2 {
    explicit J2(const Material& m)
        : elastic(m),
          yield_stress(m.yield_stress),
          hardening(m.hardening),
          softness_(elastic.T),
          three_G_(3 * elastic.T.G),
          flow_per_excess_(1 / (three_G_ + m.hardening)) {}

    void operator()(const StrainStep& de, Stress& s, PlasticStep& dep, double& ep) const {
        elastic.strain(de, s);
        const double q = von_mises(s), strength = yield_stress + hardening * ep;
        const double reached = q > strength ? q : strength;
        const double dep_eq = (reached - strength) * flow_per_excess_;
        detail::take_away(three_G_ * dep_eq / reached, 0, softness_, s, dep);
        ep += dep_eq;
    }

    Elastic elastic;
    double yield_stress, hardening;

   private:
    detail::Softness softness_;
    double three_G_, flow_per_excess_;
};

/// A cone in the space of stresses: J2^1/2 + alpha I1 <= k, and alpha_psi of its plastic flow.
struct Cone {
    double alpha, alpha_psi, k;
};

/// The cone that is Mohr-Coulomb's law in the plane, R and P radius and center of Mohr's circle:
///   R = c cos(phi) - P sin(phi),   de^p_1 + de^p_2 = sin(psi) (de^p_1 - de^p_2)
/// A body that flows steadily in plane strain has de^p_zz = 0. Then s_zz = -2 alpha_psi J2^1/2, so
///   R^2 = (1 - 3 alpha_psi^2) J2,  I1 = 3 P - 3 alpha_psi J2^1/2,  and both laws are the same with
///   alpha_psi = sin(psi) / r,  alpha = r sin(phi) / d,  k = 3 r c cos(phi) / d,
///   r^2 = 9 + 3 sin^2(psi),  d = 9 + 3 sin(phi) sin(psi)
/// exact:  psi = phi: alpha = alpha_psi = tan(phi) / (9 + 12 tan^2(phi))^1/2;
///         psi = 0: alpha = sin(phi) / 3, k = c cos(phi);  alpha_psi <= alpha where psi <= phi
/// note:   It is weaker than Mohr-Coulomb in triaxial compression, where its friction angle is that
///         of alpha = 2 sin / (3^1/2 (3 - sin)): 22 degrees for phi = 30 and psi = 0 degrees.
/// source: Drucker and Prager, Q. Appl. Math. 10, 157 (1952), for psi = phi.
inline Cone plane_strain_cone(const Material& m) {
    constexpr double degree = std::numbers::pi / 180;
    const double sin_phi = std::sin(m.friction_angle * degree),
                 cos_phi = std::cos(m.friction_angle * degree),
                 sin_psi = std::sin(m.dilatancy_angle * degree);
    const double r = std::sqrt(9 + 3 * sin_psi * sin_psi), d = 9 + 3 * sin_phi * sin_psi;
    return {r * sin_phi / d, sin_psi / r, 3 * r * m.cohesion * cos_phi / d};
}

/// Drucker-Prager plasticity: soils and sands.
///   cone   J2^1/2 + alpha I1 <= k,                      de^p = dl [s / (2 J2^1/2) + alpha_psi 1]
///   cut    I1/3 <= apex = min(tension, k / (3 alpha)),  de^p = dl 1
/// From the elastic step it goes back to the cone by
///   dl = (J2^1/2 + alpha I1 - k) / (G + 9K alpha alpha_psi),
///   J2^1/2 -= G dl,  I1/3 -= 3K alpha_psi dl;
/// where that is still beyond the cut, to I1/3 = apex instead, and J2^1/2 to what the cone bears
/// there if it is more. Without friction the cone is a cylinder, and only `tension` cuts it.
/// in:     de, strain of the step
/// in/out: s, stress; ep, the sum of (2/3 de^p : de^p)^1/2 of the part of de^p without volume
/// out:    dep, plastic strain of the step
/// exact:  ends on the surface; sigma^1 : de^p >= 0 where psi <= phi: on the cone it is
///         dl [k - (alpha - alpha_psi) I1] with I1 <= k/alpha. With sigma^0 it may be negative.
/// note:   What opens at the cut does not remember how far: it bears load as soon as it is
///         compressed, not when the gap has closed.
struct DruckerPrager {
    explicit DruckerPrager(const Material& m)
        : elastic(m), cone(plane_strain_cone(m)), softness_(elastic.T) {
        const double G = elastic.T.G, K = elastic.T.K;
        const bool blunt = 3 * cone.alpha * m.tension <= cone.k;
        apex = blunt ? m.tension : cone.k / (3 * cone.alpha);
        size_at_apex_ = blunt ? cone.k - 3 * cone.alpha * apex : 0;
        flow_per_excess_ = 1 / (G + 9 * K * cone.alpha * cone.alpha_psi);
        mean_per_flow_ = 3 * K * cone.alpha_psi;
        ep_per_size_ = 1 / (std::numbers::sqrt3 * G);
    }

    void operator()(const StrainStep& de, Stress& s, PlasticStep& dep, double& ep) const {
        elastic.strain(de, s);
        const double mean = -pressure(s), size = std::sqrt(second_invariant(s));
        const double excess = size + 3 * cone.alpha * mean - cone.k;
        const double dl = excess > 0 ? excess * flow_per_excess_ : 0;
        const double mean_on_cone = mean - mean_per_flow_ * dl,
                     size_on_cone = size - elastic.T.G * dl,
                     size_at_cut = size > size_at_apex_ ? size_at_apex_ : size;
        const bool opens = mean_on_cone > apex;
        const double mean_drop = mean - (opens ? apex : mean_on_cone),
                     size_drop = size - (opens ? size_at_cut : size_on_cone);
        // The smallest number makes no difference but to 0/0.
        const double part = size_drop / (size + std::numeric_limits<double>::min());
        detail::take_away(part, mean_drop, softness_, s, dep);
        ep += size_drop * ep_per_size_;
    }

    Elastic elastic;
    Cone cone;
    double apex;  // largest mean stress

   private:
    detail::Softness softness_;
    double size_at_apex_, flow_per_excess_, mean_per_flow_, ep_per_size_;
};

/// The law of a material and its inverse, worked out once.
struct AnyLaw {
    std::variant<Elastic, J2, DruckerPrager> law;
    Compliance compliance;
    Moduli T;
    double viscosity = 0;  // beta, of sigma_v = beta T : de/dt (viscosity.hpp)
};

/// The law of every material.
inline std::vector<AnyLaw> laws_of(const std::vector<Material>& materials) {
    std::vector<AnyLaw> laws;
    for (const Material& m : materials) {
        laws.push_back({Elastic(m), Compliance(m), moduli(m), m.viscosity});
        if (m.law == Law::j2) laws.back().law = J2(m);
        if (m.law == Law::drucker_prager) laws.back().law = DruckerPrager(m);
    }
    return laws;
}

}  // namespace mpm
