// How the velocity of a particle follows the mesh is a family of transfers on the same kernels. FLIP
// keeps its own and takes the change of the mesh; the others replace a part or all of it by what the
// mesh has made of it.
//
//     v_p' = v_p + dv_p + part (sum_g S v_g - v_p)
//       flip  part 0        blend  part 1 - flip.blend        pic, apic  part 1
//       xpic  part 1, with the filtered velocity of filter_velocity() for v_g
//       apic  also C_p' = gradient of v^L at the particle, which goes to the mesh with it
#pragma once

#include "flip/flip/mesh.hpp"

namespace flip {

/// A velocity, or a difference of two.
struct Velocity {
    double x, z;
    double square() const { return x * x + z * z; }
};

/// Energy of the motion that the gradient of an apic particle carries, per mass.
///   sum_i (C_ix^2 D_x + C_iz^2 D_z)/2,  D = S_0 S_1 dx^2, the second moment of the weights
/// in: C, the components xx, xz, zx, zz
inline double affine_energy(const Grid& grid, const Weights& w, const double* C) {
    const double dx = grid.x.spacing(), dz = grid.z.spacing();
    const double D_x = w.S_x[0] * w.S_x[1] * dx * dx, D_z = w.S_z[0] * w.S_z[1] * dz * dz;
    return 0.5 * ((C[0] * C[0] + C[2] * C[2]) * D_x + (C[1] * C[1] + C[3] * C[3]) * D_z);
}

namespace detail {

// Gradient of v^L, the last two of `filtered`, which is bilinear in the cell: xx, xz, zx, zz.
inline void bilinear_gradient(const Grid& grid, const WeightScale& scale, const Weights& w,
                              const Four* filtered, double* C) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const Four &a = filtered[w.node], &b = filtered[w.node + 1],
               &c = filtered[w.node + scale.stride], &d = filtered[w.node + scale.stride + 1];
    for (int k = 0; k < 2; ++k) {
        const int m = 2 + k;
        C[2 * k] = per_dx * (w.S_z[0] * (b[m] - a[m]) + w.S_z[1] * (d[m] - c[m]));
        C[2 * k + 1] = per_dz * (w.S_x[0] * (c[m] - a[m]) + w.S_x[1] * (d[m] - b[m]));
    }
}

// Kinetic energy, per mass, that a particle's motion loses by going to the mesh and coming back:
// what it and its nodes differ by, before and after.
//   sum_g S [|v_p + C (x_g - x_p) - v_g|^2 + |v_g^L - v_p' - C' (x_g - x_p)|^2]/2
inline double lost_on_mesh(const Grid& grid, const WeightScale& scale, const Weights& w,
                           const Four* filtered, const Velocity& v, const double* C,
                           const Velocity& v_new, const double* C_new) {
    double sum = 0;
    long corner = 0;
    for_nodes(scale, w, [&](long n, double S) {
        const double dx = (double(corner & 1) - w.S_x[1]) * grid.x.spacing(),
                     dz = (double(corner >> 1) - w.S_z[1]) * grid.z.spacing();
        const Four& g = filtered[n];
        const double ax = v.x + C[0] * dx + C[1] * dz - g[0],
                     az = v.z + C[2] * dx + C[3] * dz - g[1],
                     bx = g[2] - v_new.x - C_new[0] * dx - C_new[1] * dz,
                     bz = g[3] - v_new.z - C_new[2] * dx - C_new[3] * dz;
        sum += 0.5 * S * (ax * ax + az * az + bx * bx + bz * bz);
        ++corner;
    });
    return sum;
}

// What flip loses by the increment: its variance among the nodes.
inline double lost_by_increment(const WeightScale& scale, const Weights& w, const Four* increment,
                                const Velocity& mean) {
    double sum = -0.5 * mean.square();
    for_nodes(scale, w, [&](long n, double S) {
        sum += 0.5 * S * (increment[n][0] * increment[n][0] + increment[n][1] * increment[n][1]);
    });
    return sum;
}

// What a filter of finite order takes beside the square of a difference: how its last term and the
// new velocity vary together among the nodes. Summed over particles, v_new (M_L - M) last.
inline double lost_in_filter(const WeightScale& scale, const Weights& w, const Four* filtered,
                             const Four* increment, const Velocity& v_new) {
    double sum = 0;
    for_nodes(scale, w, [&](long n, double S) {
        sum += S * ((filtered[n][0] + increment[n][0] - v_new.x) * filtered[n][2] +
                    (filtered[n][1] + increment[n][1] - v_new.z) * filtered[n][3]);
    });
    return sum;
}

}  // namespace detail

/// Turns one particle's velocity, which has taken the increment already, from its own towards that
/// of the mesh.
/// in:     old, its velocity before the increment; dv, the increment at the particle; at, later: its
///         weights before and after it has moved; e, the energy per mass that it has left to give
/// in/out: v, its velocity; C_p
/// out:    heat per mass, beyond that of flip, which the nodes have given already
/// note:   the energy in C_p depends on where in its cell a particle is, and may grow as it moves;
///         one of apic that cannot pay for it, cold gas that a shock meets, goes without C_p
/// exact:  with the heat, total energy; for pic, blend and apic the heat is that of differences
///         squared, but for what moving does to the energy in C_p
inline double apply_transfer(const Transfer& rule, const Grid& grid, const WeightScale& scale,
                             const Weights& at, const Weights& later, const Nodes& nodes,
                             const Velocity& old, const Velocity& dv, double e, long k,
                             Particles& p, Velocity& v) {
    const Four* const filtered = nodes.filtered.data();
    Four mesh = Four::Zero();
    for_nodes(scale, at, [&](long n, double S) { mesh += S * filtered[n]; });
    const Velocity apart{old.x - mesh[0], old.z - mesh[1]};
    v.x -= rule.part * apart.x;
    v.z -= rule.part * apart.z;
    if (rule.filtered && rule.dissipates)
        return 0.5 * apart.square() +
               detail::lost_in_filter(scale, at, filtered, nodes.increment.data(), v);
    if (rule.filtered) return 0;

    double C[4] = {0, 0, 0, 0}, C_new[4] = {0, 0, 0, 0};
    if (rule.affine) {
        C[0] = p.Cxx_p[k], C[1] = p.Cxz_p[k], C[2] = p.Czx_p[k], C[3] = p.Czz_p[k];
        detail::bilinear_gradient(grid, scale, at, filtered, C_new);
    }
    const double flip = detail::lost_by_increment(scale, at, nodes.increment.data(), dv);
    const auto heat = [&] {
        const double pic =
            detail::lost_on_mesh(grid, scale, at, filtered, old, C, {mesh[2], mesh[3]}, C_new);
        return rule.part * (pic - flip) + 0.5 * rule.part * (1 - rule.part) * apart.square() +
               affine_energy(grid, at, C_new) - affine_energy(grid, later, C_new);
    };
    double gained = rule.dissipates ? heat() : 0;
    if (rule.affine) {
        if (0.5 * e + gained < 0) {
            std::fill_n(C_new, 4, 0.0);
            gained = heat();
        }
        p.Cxx_p[k] = C_new[0], p.Cxz_p[k] = C_new[1];
        p.Czx_p[k] = C_new[2], p.Czz_p[k] = C_new[3];
    }
    return gained;
}

}  // namespace flip
