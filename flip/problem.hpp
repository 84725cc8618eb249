// The numbers of a run that the steps use: the mesh and its boundaries, the materials,
// the forces and the scheme. Nothing here changes in time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/grid.hpp"
#include "flip/equation_of_state.hpp"

namespace flip {

using common::Field;
using common::Grid;

/// A column of numbers to be read. Eigen's brackets check every index, and a loop with checks does not
/// vectorize.
class Values {
   public:
    Values(const Field& column) : data_(column.data()) {}
    Values(const double* column) : data_(column) {}
    double operator[](long n) const { return data_[n]; }

   private:
    const double* data_;
};

inline constexpr double pi = 3.14159265358979323846;

/// The length of a ring of cells about the axis, 2 pi r; in the plane 1, as all is per length there.
/// in:     node, a fraction between nodes: i + 1/2 is the middle of column i
/// exact:  ring_length(i + 1/2) x area of a cell is the volume of the ring, pi (r_2^2 - r_1^2) dz
inline double ring_length(const Grid& grid, double node) {
    return grid.axisymmetric ? 2 * pi * grid.x.at(node) : 1;
}
/// The volume of a cell in column i.
inline double cell_volume(const Grid& grid, long i) {
    return grid.cell_area() * ring_length(grid, double(i) + 0.5);
}
/// The column of the cell or node with index n.
inline long column_of(const Grid& grid, long n) { return n % grid.stride() - 1; }

/// The sides of the mesh.
enum Side : std::size_t { x_low, x_high, z_low, z_high };
inline constexpr std::array<Side, 4> all_sides{x_low, x_high, z_low, z_high};
inline constexpr std::array<const char*, 4> side_names{"x_low", "x_high", "z_low", "z_high"};
inline bool is_x_side(Side side) { return side == x_low || side == x_high; }
inline bool is_low_side(Side side) { return side == x_low || side == z_low; }

/// Conditions that a boundary can set.
enum class BoundaryKind { periodic, slip, no_slip, open, inflow };

/// The fluid that enters through an inflow boundary.
struct Inflow {
    int material = 0;
    double rho = 0, p = 0, c = 0,
           e = 0;  // density, pressure, sound speed, specific internal energy
    double vx = 0, vz = 0;
    double v_theta = 0, Omega = 0;  // about the axis, v_theta + Omega r
};

/// The boundary condition on one side.
struct Boundary {
    BoundaryKind kind = BoundaryKind::periodic;
    double slide = 0;     // velocity of a no-slip wall along itself
    double pressure = 0;  // outside of an open boundary
    Inflow inflow = {};
};

/// The conditions on all four sides.
struct Boundaries {
    std::array<Boundary, 4> side;

    bool is(Side s, BoundaryKind kind) const { return side[s].kind == kind; }
    bool has(BoundaryKind kind) const {
        return std::ranges::any_of(side, [&](const Boundary& b) { return b.kind == kind; });
    }
};

/// Acceleration of the whole fluid: uniform gravity, and a trap towards the middle of the mesh.
///   a = g + trap (x_middle - x)
struct BodyForce {
    double gravity_x = 0, gravity_z = 0;  // [velocity/time]
    double trap = 0;                      // [1/time^2]
};

/// Coefficients of the artificial viscosity, a pressure in fluid that is compressed.
///   q = rho (-du) (linear c + quadratic (-du)) where du < 0, else 0;  du, the difference of the
///   velocities on two sides, is negative where they approach
struct ArtificialViscosity {
    double linear = 0, quadratic = 0;

    /// q/(-du)
    double slope(double rho, double c, double du) const {
        return rho * (linear * c - quadratic * du);
    }
    double operator()(double rho, double c, double du) const {
        const double approach = std::min(du, 0.0);
        return -approach * slope(rho, c, approach);
    }
};

/// How long a step may be: a part cfl of what the fastest signal allows, or dt where that is not 0;
/// and the time at which the run ends.
struct StepLimits {
    double cfl = 0.3, dt = 0, end = 1;
};

/// With the consistent mass and the density of cells the shortest sound of the mesh is at most this
/// much faster than all other, as M is (1 - 1/n^2)/3 of the lumped mass there:
///   c dt/dx [3/(2 gamma (1 - 1/n^2)) + 1 - 1/gamma]^1/2 <= 1,  n >= 2 particles across a cell
inline constexpr double fastest_consistent = 1.4142135623730951;

/// And the steps of viscosity have to be so much shorter, with some room for particles that have moved:
///   dt nu/dx^2 (4/3 + 1) 12/(1 - 1/n^2) <= 2 where nodes move in turn along both axes
inline constexpr double most_viscous_consistent = 4;

/// How the velocity of a particle follows the mesh; see transfer.hpp.
struct Transfer {
    bool flip = true;        // nothing but the velocity increment of the mesh
    double part = 0;         // of the velocity of the mesh that replaces the particle's own
    bool affine = false;     // apic: particles carry the gradient of the velocity
    bool filtered = false;   // xpic: the velocity of the mesh is filtered
    long xpic_order = 2;     // of that filter
    bool dissipates = true;  // kinetic energy that the transfer loses becomes internal energy
};

/// How `flip` goes about it; `pic` has no choices.
struct Scheme {
    Transfer transfer;
    bool consistent_mass = false;     // mass matrix of the nodes: consistent instead of lumped
    bool particle_volumes = false;    // density from volumes that particles carry, not from cells
    double filling = 0;               // part of its room that a gas takes in a step, with volumes
    bool confined = false;            // a gas that fills the mesh, with volumes: no voids
    bool conservative_paths = false;  // particles diverge at each place as their cell does
    bool implicit = false;            // pressure at the level theta
    double theta = 1, tolerance = 1e-8;
    long max_iterations = 1000;                  // of the conjugate gradients
    long rezone_steps = 0;                       // steps between rezonings; 0: never
    long min_particles = 4, max_particles = 32;  // of one material in a cell
};

/// The input of the steps: mesh, boundaries, materials and scheme of one run.
struct Problem {
    Grid grid;
    std::vector<Material> materials;
    Boundaries boundaries;
    BodyForce body_force;
    ArtificialViscosity q;
    double viscosity = 0;  // dynamic viscosity of the fluid [mass/(length time)]
    bool swirl = false;    // whether particles turn about the axis; see swirl.hpp
    StepLimits limits;
    long per_cell_x = 4, per_cell_z = 4;  // particles of a cell at the start
    Scheme scheme;
};

/// One column of the particles of the start.
struct LatticeColumn {
    double x, ring;  // where it is; length of its ring
};
/// Column n of the start, on the lattice or at the part u of its width.
/// exact:  on the lattice a ring of fluid stands at its center of mass, so that the nodes get from it
///         what they would get from the fluid; at random, any part of its volume is as likely
inline LatticeColumn lattice_column(const Grid& grid, long per_cell, long n, bool random = false,
                                    double u = 0.5) {
    const double dx = grid.x.spacing() / double(per_cell), x = grid.x.low + dx * (double(n) + u);
    if (!grid.axisymmetric) return {x, 1};
    const double r = dx * (double(n) + 0.5);
    return {
        random ? std::sqrt(r * r + 0.25 * dx * dx + (2 * u - 1) * dx * r) : r + dx * dx / (12 * r),
        2 * pi * r};
}

/// Whether there is more than one row of cells; in a single row nothing moves along z.
inline bool is_plane(const Grid& grid) { return grid.z.cells > 1; }

}  // namespace flip
