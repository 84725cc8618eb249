// What bilinear velocities lack in a ring for particles to diverge at each place as their cell does.
#pragma once

#include <algorithm>

#include "flip/flip/transfer.hpp"

namespace flip {

namespace detail {

// [ring_paths]
// What missing_velocity() of move_particles.hpp is in the plane, in a ring from r_1 to r_2, whose
// divergence is (1/r) d(r v_r)/dr + dv_z/dz. With v_r = p + q r
// in the middle of the cell, p_1 and q_1 their differences from bottom to top, and dv_z/dz = c + e r:
//   v_r += S_x0 S_x1 dr^2/(r_1 + r_2) [(e/3)(r_1 + r_2 + r_1 r_2/r) - p/r]
//   v_z += (dz/2) S_z0 S_z1 (p_1/r + 2 q_1)
// On the axis v_r = 0 and p = 0.
// in: f, g, how far the particle is through the cell
struct RingFlow {
    double r[4], turn_z;  // v_r at the nodes, t_z = v_00 - v_10 - v_01 + v_11
};
inline RingFlow ring_flow(const WeightScale& scale, const Weights& w, const Four* v) {
    const Four &a = v[w.node], &b = v[w.node + 1], &c = v[w.node + scale.stride],
               &d = v[w.node + scale.stride + 1];
    return {{a[2], b[2], c[2], d[2]}, a[3] - b[3] - c[3] + d[3]};
}
[[gnu::always_inline]] inline Velocity missing_velocity_of_ring(double dr, double dz, double r_1,
                                                                double f, double g,
                                                                const RingFlow& v) {
    const double r_2 = r_1 + dr, r = std::max(r_1 + f * dr, 1e-9 * dr);
    const double q_low = (v.r[1] - v.r[0]) / dr, q_high = (v.r[3] - v.r[2]) / dr,
                 p_low = v.r[0] - q_low * r_1, p_high = v.r[2] - q_high * r_1,
                 e = v.turn_z / (dr * dz);
    return {(1 - f) * f * dr * dr / (r_1 + r_2) *
                (e / 3 * (r_1 + r_2 + r_1 * r_2 / r) - 0.5 * (p_low + p_high) / r),
            0.5 * dz * (1 - g) * g * ((p_high - p_low) / r + 2 * (q_high - q_low))};
}
// [/ring_paths]

inline Velocity missing_velocity_of_ring(const Grid& grid, const WeightScale& scale,
                                         const Weights& w, const Four* v) {
    const double dr = grid.x.spacing(), r_1 = dr * double(column_of(grid, w.node));
    return missing_velocity_of_ring(dr, grid.z.spacing(), r_1, w.S_x[1], w.S_z[1],
                                    ring_flow(scale, w, v));
}

}  // namespace detail

}  // namespace flip
