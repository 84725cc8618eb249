// What a bond between two grains bears, over all the nodes that they share.
#pragma once

#include <algorithm>
#include <cmath>

#include "mpm_explicit/contact/solve_contact_node.hpp"
#include "mpm_explicit/grains/grains.hpp"

namespace mpm {

/// The load of one bond, at one node or summed over its nodes.
struct BondLoad {
    int bond = 0;
    double jx = 0, jy = 0;  // impulse on b
    double ax = 0, ay = 0;  // area of the interface, along its normal from a to b, as a has it
    double bx = 0, by = 0;  // and as b has it
    void operator+=(const BondLoad& other) {
        jx += other.jx, jy += other.jy;
        ax += other.ax, ay += other.ay, bx += other.bx, by += other.by;
    }
};

/// A node's share of the load: gradients of volume sum up to the surface, wherever on the mesh it
/// is.
///   A n = sum_i g_a or -sum_i g_b, the smaller along their sum
/// exact:  for particles on a lattice and an interface along it, of which the whole side of one grain is a part;
///         where both reach beyond the other, up to a cell too large
/// note:   The usual sum over nodes of sqrt(2 min(V_a, V_b) (V_a + V_b)) / h is up to 30 % short
///         where the interface is not on a line of nodes.
inline BondLoad bond_load(const ContactNode& node, const ContactPair& pair) {
    const ContactBody &a = node.bodies[pair.a], &b = node.bodies[pair.b];
    return {pair.bond, pair.impulse_x(), pair.impulse_y(), a.gx, a.gy, -b.gx, -b.gy};
}

/// Mean stress on the interface in this step, and whether the bond breaks.
///   (shear/S)^2 + (max(0, tension)/N)^2 >= 1
inline void update_bond(const BondLoad& load, double dt, Bond& bond) {
    // At the ends of the shorter side the longer one has a part of its area that bears nothing.
    const double sum_x = load.ax + load.bx, sum_y = load.ay + load.by,
                 sum = std::hypot(sum_x, sum_y), nx = sum > 0 ? sum_x / sum : 0,
                 ny = sum > 0 ? sum_y / sum : 0;
    bond.area = std::min(load.ax * nx + load.ay * ny, load.bx * nx + load.by * ny);
    if (bond.broken || !(bond.area > 0)) {
        bond.normal_stress = bond.shear_stress = 0;
        return;
    }
    const double per = 1 / (dt * bond.area);
    // b is pulled back towards a where the impulse on it is against the normal.
    bond.normal_stress = -(load.jx * nx + load.jy * ny) * per;
    bond.shear_stress = (load.jy * nx - load.jx * ny) * per;
    const double pull = std::max(0.0, bond.normal_stress) / bond.tension,
                 shear = bond.shear_stress / bond.shear;
    bond.broken = pull * pull + shear * shear >= 1;
}

}  // namespace mpm
