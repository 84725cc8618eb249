// mesh -> particles: they take the change of velocity, move with the mesh, and share the work on
// their cells.  [FLIP-6, FLIP-7]
#pragma once

#include "flip/ends.hpp"
#include "flip/mesh.hpp"

namespace flip {

namespace detail {

// What of a step differs between the transfers, beyond the kick that all of them give.
struct Transfer {
    double towards_mesh = 0;  // part of pic: 0 flip, 1 pic, apic and xpic
    bool affine = false, filtered = false, heat = true;
};

// Energy of the motion that the gradient of an apic particle carries, per mass.
inline double affine_energy(const Grid& grid, const Weights& w, const double* C) {
    const double dx = grid.x.spacing(), dz = grid.z.spacing();
    const double D_x = w.S_x[0] * w.S_x[1] * dx * dx, D_z = w.S_z[0] * w.S_z[1] * dz * dz;
    return 0.5 * ((C[0] * C[0] + C[2] * C[2]) * D_x + (C[1] * C[1] + C[3] * C[3]) * D_z);
}

// Gradient of a bilinear function of the nodes, two components at once: xx, xz, zx, zz.
inline void bilinear_gradient(const Grid& grid, const WeightScale& scale, const Weights& w,
                              const Four* f, int first, double* C) {
    const double per_dx = 1 / grid.x.spacing(), per_dz = 1 / grid.z.spacing();
    const Four &a = f[w.node], &b = f[w.node + 1], &c = f[w.node + scale.stride],
               &d = f[w.node + scale.stride + 1];
    for (int k = 0; k < 2; ++k) {
        const int m = first + k;
        C[2 * k] = per_dx * (w.S_z[0] * (b[m] - a[m]) + w.S_z[1] * (d[m] - c[m]));
        C[2 * k + 1] = per_dz * (w.S_x[0] * (c[m] - a[m]) + w.S_x[1] * (d[m] - b[m]));
    }
}

// Kinetic energy, per mass, that a particle's motion loses by going to the mesh and coming back:
// what it and its nodes differ by, before and after.
//   sum_g S [|v_p + C (x_g - x_p) - v_g|^2 + |v_g^L - v_p' - C' (x_g - x_p)|^2]/2
struct Velocity {
    double x, z;
};
inline double lost_on_mesh(const Grid& grid, const WeightScale& scale, const Weights& w,
                           const Four* carry, const Velocity& v, const double* C,
                           const Velocity& v_new, const double* C_new) {
    double sum = 0;
    long corner = 0;
    for_nodes(scale, w, [&](long n, double S) {
        const double dx = (static_cast<double>(corner & 1) - w.S_x[1]) * grid.x.spacing(),
                     dz = (static_cast<double>(corner >> 1) - w.S_z[1]) * grid.z.spacing();
        const Four& g = carry[n];
        const double ax = v.x + C[0] * dx + C[1] * dz - g[0],
                     az = v.z + C[2] * dx + C[3] * dz - g[1],
                     bx = g[2] - v_new.x - C_new[0] * dx - C_new[1] * dz,
                     bz = g[3] - v_new.z - C_new[2] * dx - C_new[3] * dz;
        sum += 0.5 * S * (ax * ax + az * az + bx * bx + bz * bz);
        ++corner;
    });
    return sum;
}

// What flip loses by the kick: its variance among the nodes.
inline double lost_by_kick(const WeightScale& scale, const Weights& w, const Four* kick, double dvx,
                           double dvz) {
    double sum = -0.5 * (dvx * dvx + dvz * dvz);
    for_nodes(scale, w, [&](long n, double S) {
        sum += 0.5 * S * (kick[n][0] * kick[n][0] + kick[n][1] * kick[n][1]);
    });
    return sum;
}

template <bool pure_flip, bool volumes>
void move_row(const Case& w, const WeightScale& scale, const Mesh& mesh, const Transfer& transfer,
              double dt, std::size_t begin, std::size_t end, Particles& p) {
    const Grid& grid = w.grid;
    const Four* const kick = mesh.nodes.kick.data();
    const double *const heat = mesh.nodes.heat.data(), *const de = mesh.cells.de.data();
    const Cells& cells = mesh.cells;
    const long kinds = static_cast<long>(mesh.materials);
    const double deficit = w.heats() ? 0.5 : 0;
    // [move]
    for (std::size_t k = begin; k < end; ++k) {
        const Weights at = weights_at(scale, p.x_p[k], p.z_p[k]);
        Four sum = Four::Zero();
        double gained = 0;
        for_nodes(scale, at, [&](long n, double S) {
            sum += S * kick[n];
            gained += S * heat[n];
        });
        const double dvx = sum[0], dvz = sum[1];
        const long kind = p.material[k];
        for_cells(scale, at, [&](long c, double R) { gained += R * de[c * kinds + kind]; });
        gained -= deficit * (dvx * dvx + dvz * dvz);
        if constexpr (volumes) {
            const Material& a = w.materials[static_cast<std::size_t>(kind)];
            const double V = p.V_p[k], p_p = pressure(a, p.m_p[k] / V, p.e_p[k]);
            const double give = V / std::max(stiffness(a, p_p), 1e-300);
            double strain = 0, work = 0;
            for_cells(scale, at, [&](long c, double R) {
                strain += R * cells.strain[c];
                work += R * (p_p * cells.work[c] + cells.q_work[c]);
            });
            p.V_p[k] += give * strain;
            gained -= give * work / p.m_p[k];
        }
        double vx = p.vx_p[k] + dvx, vz = p.vz_p[k] + dvz;                    // [FLIP-6]
        const double x = p.x_p[k] + dt * sum[2], z = p.z_p[k] + dt * sum[3];  // [FLIP-7]
        if constexpr (!pure_flip) {
            // From what the particle has kept to what the mesh makes of it.
            const Four* const carry = mesh.nodes.carry.data();
            Four keep = Four::Zero();
            for_nodes(scale, at, [&](long n, double S) { keep += S * carry[n]; });
            const double old_x = p.vx_p[k], old_z = p.vz_p[k], part = transfer.towards_mesh;
            const double apart_x = old_x - keep[0], apart_z = old_z - keep[1];
            vx -= part * apart_x;
            vz -= part * apart_z;
            if (transfer.affine) {
                double C[4] = {p.Cxx_p[k], p.Cxz_p[k], p.Czx_p[k], p.Czz_p[k]}, C_new[4];
                bilinear_gradient(grid, scale, at, carry, 2, C_new);
                if (transfer.heat) {
                    const Weights later = weights_at(scale, around(grid.x, x), around(grid.z, z));
                    gained +=
                        lost_on_mesh(grid, scale, at, carry, {old_x, old_z}, C, {vx, vz}, C_new) +
                        affine_energy(grid, at, C_new) - affine_energy(grid, later, C_new);
                }
                p.Cxx_p[k] = C_new[0], p.Cxz_p[k] = C_new[1];
                p.Czx_p[k] = C_new[2], p.Czz_p[k] = C_new[3];
            } else if (transfer.filtered && transfer.heat) {
                gained += 0.5 * (apart_x * apart_x + apart_z * apart_z);
            } else if (transfer.heat) {
                const double none[4] = {0, 0, 0, 0};
                gained += part * lost_on_mesh(grid, scale, at, carry, {old_x, old_z}, none,
                                              {keep[2], keep[3]}, none) +
                          0.5 * part * (1 - part) * (apart_x * apart_x + apart_z * apart_z);
            }
            if (transfer.heat && !transfer.filtered)
                gained -= part * lost_by_kick(scale, at, kick, dvx, dvz);
        }
        p.vx_p[k] = vx;
        p.vz_p[k] = vz;
        p.e_p[k] += gained;
        p.x_p[k] = around(grid.x, x);
        p.z_p[k] = around(grid.z, z);
    }
    // [/move]
}

}  // namespace detail

/// Particles after the step.
///   v_p += sum_g S (v_g^L - v_g)                                                  [FLIP-6]
///   x_p += dt sum_g S v_g^L; with an implicit pressure v_g^theta                  [FLIP-7]
///   e_p += sum_c R de_c + sum_g S heat_g - |sum_g S dv_g|^2/2
///   pic, blend:  v_p' = v_p + dv_p + towards (sum_g S v_g - v_p)
///   apic:        as pic, and C_p = the gradient of v^L at the particle
///   xpic:        as pic with the filtered velocity of filter_velocity() for v_g
/// in:     nodes.kick, heat, carry; cells.de
/// in/out: particles, sorted by row; afterwards out of order, and beyond an end if they left
/// exact:  mass and momentum; total energy when the deficit goes to heat: what the lumped mass
///         matrix owes is sum_p m_p [sum_g S |dv_g|^2 - |sum_g S dv_g|^2]/2, never negative
/// source: [FLIP-6, FLIP-7]
/// note:   The slide's F_g is a force per mass of the node: dv_p/dt = sum_g (F_g/m_g) S. Particles
///         move with the velocity of the mesh and not with their own: they never pass each other.
inline void move_particles(const Case& w, double dt, const Mesh& mesh, Particles& particles) {
    detail::Transfer transfer;
    transfer.affine = w.transfer == "apic";
    transfer.filtered = w.transfer == "xpic";
    transfer.heat = w.heats();
    transfer.towards_mesh = w.transfer == "flip" ? 0 : (w.transfer == "blend" ? 1 - w.blend : 1);
    const bool pure = w.transfer == "flip", volumes = has(particles.V_p);
    const WeightScale scale(w.grid);
    common::for_each_row(
        w.grid.z.cells,
        [&](long j) {
            const auto row = static_cast<std::size_t>(j);
            const auto begin = static_cast<std::size_t>(particles.first_of_row[row]),
                       end = static_cast<std::size_t>(particles.first_of_row[row + 1]);
            if (pure && !volumes)
                detail::move_row<true, false>(w, scale, mesh, transfer, dt, begin, end, particles);
            else if (pure)
                detail::move_row<true, true>(w, scale, mesh, transfer, dt, begin, end, particles);
            else if (!volumes)
                detail::move_row<false, false>(w, scale, mesh, transfer, dt, begin, end, particles);
            else
                detail::move_row<false, true>(w, scale, mesh, transfer, dt, begin, end, particles);
        },
        particles.count());
}

/// What particles take from the mesh in place of their own velocity, where the transfer wants it.
/// in:     nodes.vx, vz, or filtered by filter_velocity(); v^L
inline void prepare_transfer(const Case& w, const Field& vx, const Field& vz, Mesh& mesh) {
    if (w.transfer == "flip") return;
    Nodes& g = mesh.nodes;
    for_each_node(w.grid, [&](long, long, long n) {
        g.carry[static_cast<std::size_t>(n)] = Four(vx[n], vz[n], g.vxL[n], g.vzL[n]);
    });
}

}  // namespace flip
