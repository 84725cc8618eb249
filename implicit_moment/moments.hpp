// Charge, current and stress of one species on the staggered mesh, and what is behind a wall.
#pragma once

#include <array>

#include "implicit_moment/field/vector_field.hpp"
#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// The moments of one species, per unit area of the mesh. P carries the charge, as J does: it is
/// the sum of q v v S. Times m/q that is the slide's P, a flux of momentum; minus n m u u, a
/// pressure.
struct Moments {
    Field rho, J_x, J_y, J_z, P_xx, P_zz, P_xz, P_xy, P_yz;
    Field plasma_density;              // charge density of the plasma itself, up to the walls
    std::array<Field, 9> response;     // relativistic: sum of (q^2 dt/2m) A S; else empty
    double kinetic_energy = 0;         // sum of m v^2 / 2, or m c^2 (gamma - 1), over the particles
    std::array<double, 3> momentum{};  // sum of m u

    explicit Moments(const Grid& grid) {
        for (Field* f : all()) f->setZero(grid.size());
    }
    std::array<Field*, 9> all() {
        return {&rho, &J_x, &J_y, &J_z, &P_xx, &P_zz, &P_xz, &P_xy, &P_yz};
    }
};

using common::on_faces, common::on_nodes, common::on_x_edges, common::on_z_edges;

/// What stands behind a wall: the plasma's own mirror image, or what the field equations have there, the
/// image charges of a conductor (felt, in vector_field.hpp).
enum class Images { plasma, conductor };

/// Adds what was deposited behind walls and periodic ends to the points that it belongs to.
/// in/out: rho and J, afterwards with ghosts filled.
inline void fold_charge_and_current(const Grid& grid, Images images, Moments& moments) {
    const Parity w = images == Images::plasma ? Parity{+1, +1} : felt_charge(grid);
    common::fold_ghosts(grid, on_nodes, w, moments.rho.data());
    common::fold_ghosts(grid, on_x_edges, {-w.x, w.z}, moments.J_x.data());
    common::fold_ghosts(grid, on_nodes, w, moments.J_y.data());
    common::fold_ghosts(grid, on_z_edges, {w.x, -w.z}, moments.J_z.data());
}

/// The same for the stress.
/// note:   P_nn is even with either image: on the wall it is the push on the particles that it reflects.
inline void fold_stress(const Grid& grid, Images images, Moments& moments) {
    const Parity w = images == Images::plasma ? Parity{+1, +1} : felt_charge(grid);
    common::fold_ghosts(grid, on_nodes, {+1, w.z}, moments.P_xx.data());
    common::fold_ghosts(grid, on_nodes, {w.x, +1}, moments.P_zz.data());
    common::fold_ghosts(grid, on_faces, {-w.x, -w.z}, moments.P_xz.data());
    common::fold_ghosts(grid, on_x_edges, {-w.x, w.z}, moments.P_xy.data());
    common::fold_ghosts(grid, on_z_edges, {w.x, -w.z}, moments.P_yz.data());
}

}  // namespace implicit_moment
