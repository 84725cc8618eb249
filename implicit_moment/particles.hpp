// What a particle carries in the implicit moment method: position, velocity, charge and mass.
// Nothing of it is replaced by the mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "common/grid.hpp"
#include "implicit_moment/ranks/division.hpp"
#include "implicit_moment/simd.hpp"

namespace implicit_moment {

using common::Field;
using common::Grid;

/// One species, structure of arrays, kept sorted by nearest node (see sort_particles).
/// note:   u_p is the letter of the slide: the velocity v, or where the species is relativistic gamma v, the
///         momentum per mass.
struct Particles {
    std::string name;
    double q_p = 0;                              // charge of one simulation particle
    double m_p = 0;                              // its mass
    bool relativistic = false;                   // u_p is gamma v
    std::vector<ParticleReal> x_p, z_p;          // position [d_i]
    std::vector<ParticleReal> ux_p, uy_p, uz_p;  // v or gamma v [c]
    std::vector<int> first_of_node;  // node n has [first_of_node[n], first_of_node[n + 1])
    Division of_ranks;               // the rows of each rank, in explicit_em its tiles

    long count() const { return long(x_p.size()); }
    std::array<std::vector<ParticleReal>*, 5> all() { return {&x_p, &z_p, &ux_p, &uy_p, &uz_p}; }
};

/// The velocity, or u, of one particle (Real = double) or of several (a vector).
template <class Real>
struct Velocity {
    Real x, y, z;
};

/// The (nodes_x, nodes_z) table that first_of_node refers to: both end nodes are counted, also in
/// a periodic direction, where the images 0 and N hold half a cell each.
inline long nodes_x(const Grid& grid) { return grid.x.cells + 1; }
inline long nodes_z(const Grid& grid) { return grid.z.cells + 1; }

/// The first number that particles can carry which is not below x.
inline ParticleReal not_below(double x) {
    const auto nearest = ParticleReal(x);
    return double(nearest) < x ? std::nextafter(nearest, ParticleReal(INFINITY)) : nearest;
}

/// A position as particles carry it: rounded, but not to beyond an end of the mesh.
/// in:     x, on the mesh
inline ParticleReal carried(const common::Axis& axis, double x) {
    if constexpr (sizeof(ParticleReal) == sizeof(double)) return ParticleReal(x);
    const ParticleReal low = not_below(axis.low), high = not_below(axis.high());
    const auto below = [](ParticleReal end) {
        return std::nextafter(end, ParticleReal(-INFINITY));
    };
    const bool at_end = double(high) > axis.high() || (axis.periodic && x < axis.high());
    return std::clamp(ParticleReal(x), low, at_end ? below(high) : high);
}

/// Brings coordinates that have left a periodic direction back to their images.
inline void wrap(const common::Axis& axis, SimdVector& x) {
    if (!axis.periodic) return;
    x = x < axis.low ? x + axis.length : x;
    x = x >= axis.high() ? x - axis.length : x;
}

}  // namespace implicit_moment
