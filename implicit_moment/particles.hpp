// What a particle carries in the implicit moment method: position, velocity, charge and mass.
// Nothing of it is replaced by the mesh.
#pragma once

#include <string>
#include <vector>

#include "common/grid.hpp"
#include "common/parallel.hpp"

namespace implicit_moment {

using common::Field;
using common::Grid;

/// One species, structure of arrays, kept sorted by nearest node (see sort_particles).
struct Particles {
    std::string name;
    double q_p = 0;                        // charge of one simulation particle
    double m_p = 0;                        // its mass
    std::vector<double> x_p, z_p;          // position [d_i]
    std::vector<double> vx_p, vy_p, vz_p;  // velocity [c]
    std::vector<int> first_of_node;        // node n has [first_of_node[n], first_of_node[n + 1])

    long count() const { return static_cast<long>(x_p.size()); }
};

/// The (nodes_x, nodes_z) table that first_of_node refers to: both end nodes are counted, also in
/// a periodic direction, where the images 0 and N hold half a cell each.
inline long nodes_x(const Grid& grid) { return grid.x.cells + 1; }
inline long nodes_z(const Grid& grid) { return grid.z.cells + 1; }

}  // namespace implicit_moment
