// particles at the ends of the mesh, in flip: out, in, and the books.
#pragma once

#include "flip/ends.hpp"

namespace flip {

/// Particles that have left are taken away, and those that have entered are added, out of order.
/// in:     t, dt of the step that has moved them
/// out:    books: mass, momentum and energy of what crossed
/// errors: NumericalError for a particle beyond a wall
inline void cross_ends(const Case& w, double t, double dt, Particles& p, Books& books) {
    const auto enter = [&](std::size_t k, double sign) {
        const double m = sign * p.m_p[k], vx = p.vx_p[k], vz = p.vz_p[k];
        books.mass += m;
        books.momentum_x += m * vx;
        books.momentum_z += m * vz;
        books.energy += m * (0.5 * (vx * vx + vz * vz) + p.e_p[k]);
    };
    remove_leaving(w, t + dt, p, [&](std::size_t k) { enter(k, -1); });
    const long added = add_inflow(w, t, dt, p);
    for (std::size_t k = p.x_p.size() - static_cast<std::size_t>(added); k < p.x_p.size(); ++k)
        enter(k, 1);
}

}  // namespace flip
