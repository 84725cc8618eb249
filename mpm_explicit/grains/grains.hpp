// Grains: which particles belong together, what they are made of, how rigid ones move, and which
// ones are bonded.
#pragma once

#include <string>
#include <vector>

#include "mpm_explicit/particles.hpp"

namespace mpm {

struct Grain {
    std::string name;
    int material = 0;         // index into the materials of the case
    bool rigid = false;       // moves as it is told
    long begin = 0, end = 0;  // its particles
    double mass = 0;          // theirs, per unit thickness
    bool has_corners = false;
};

/// How far a grain has traveled at a time.
struct TravelRow {
    double t = 0, x = 0, y = 0;
};

/// How a rigid grain moves: as it is told (apply_loads.hpp), or in one direction as a force drives
/// it. Grains that are not rigid have one, too, and do not use it.
struct RigidMotion {
    double vx = 0, vy = 0;              // velocity in this step
    double push_x = 0, push_y = 0;      // force of the other grains on it, in the last step
    double travel_x = 0, travel_y = 0;  // since the start
    double prescribed_vx = 0, prescribed_vy = 0;  // when the load has risen
    double stop = 0;                              // when it begins to end; 0: never
    double swing_x = 0, swing_y = 0, period = 1;
    std::vector<TravelRow> table;  // times rising
    bool force_control_x = false, force_control_y = false;
    double force = 0, mass = 1, damping = 0;  // of the force control
};

/// Two grains that hold together at the nodes they share, until the stress on their interface
/// leaves the ellipse (shear/S)^2 + (tension/N)^2 = 1; then never again.
struct Bond {
    int a = 0, b = 0;               // grains
    double density_ratio = 1;       // of the materials of b and a
    double tension = 0, shear = 0;  // strengths N, S [stress]
    bool broken = false;
    double normal_stress = 0, shear_stress = 0;  // of the last step, tension positive
    double area = 0;
};

}  // namespace mpm
