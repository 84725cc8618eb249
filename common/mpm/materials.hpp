// Material laws of plane strain: how a step of strain changes the stress.
//
//   elastic          sigma^1 - sigma^0 = T : de                                    [MPM-2, 7, 10]
//   j2               the same, and shear stress is held at Y + H ep by radial return
//   drucker_prager   shear strength grows with pressure; no tension beyond a cut-off
//   rigid            no stress: the grain moves as it is told
#pragma once

#include <string>

#include "common/mpm/particles.hpp"

namespace mpm {

enum class Law { elastic, j2, drucker_prager, rigid };

/// A material as a case file names it; stresses in the unit of E.
struct Material {
    std::string name;
    Law law = Law::elastic;
    double E = 1e4, nu = 0.3, density = 1000;
    double yield_stress = 100, hardening = 0;  // j2: Y, H
    // drucker_prager: angles in degrees; tension, the largest mean stress (zero: a loose sand)
    double cohesion = 0, friction_angle = 30, dilatancy_angle = 0, tension = 0;
};

/// What update_stress needs of a material, worked out once.
struct Moduli {
    double lambda = 0, G = 0, K = 0;  // Lame's first constant, shear modulus, bulk modulus
};

}  // namespace mpm
