// particles at the ends of the mesh, in flip: out, in, and the books.
#pragma once

#include "flip/ends.hpp"
#include "flip/flip/transfer.hpp"

namespace flip {

/// Particles that have left are taken away, and those that have entered are added, out of order.
/// in:     t, dt of the step that has moved them; left, how many it has moved beyond an end, or any
///         number above 0 when that is not known
/// out:    books: mass, momentum and energy of what crossed, with apic also that of the motion within
///         a particle, as move_particles() has left it
/// errors: NumericalError for a particle beyond a wall
inline void cross_ends(const Problem& problem, double t, double dt, Particles& p, Books& books,
                       long left = 1) {
    const WeightScale scale(problem.grid);
    const auto enter = [&](std::size_t k, double sign) {
        const double m = sign * p.m_p[k], vx = p.vx_p[k], vz = p.vz_p[k];
        books.mass += m;
        books.momentum_x += m * vx;
        books.momentum_z += m * vz;
        books.energy += m * (0.5 * (vx * vx + vz * vz) + p.e_p[k]);
        if (!has(p.Cxx_p)) return;
        const double C[4] = {p.Cxx_p[k], p.Cxz_p[k], p.Czx_p[k], p.Czz_p[k]};
        books.energy += m * affine_energy(problem.grid, weights_at(scale, p.x_p[k], p.z_p[k]), C);
    };
    if (left > 0) remove_leaving(problem, t + dt, p, [&](std::size_t k) { enter(k, -1); });
    const long added = add_inflow(problem, t, dt, p);
    for (std::size_t k = p.x_p.size() - static_cast<std::size_t>(added); k < p.x_p.size(); ++k)
        enter(k, 1);
}

}  // namespace flip
