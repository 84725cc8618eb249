// Angular momentum that lumping loses: particles carry, besides their velocity, the motion that the
// nodes show around them.
//
// FLIP gives a particle one velocity. What nodes turn around it, sum_i S_ip (x_i - x_p) x dv_i, is
// lost, and with it angular momentum: a disk that spins loses a tenth of it in five turns. Here a
// particle keeps it, as a matrix C_p, and gives it back to its nodes:
//     P_i = sum_p m_p S_ip [v_p + C_p r_ip],  r_ip = x_i - x_p
//     C_p = B_p D_p^-1,  B_p = sum_i S_ip v_i^1 r_ipT,  D_p = sum_i S_ip r_ip r_ipT
// affine   all of C_p, with the velocities of PIC: APIC
// spin     its rotation alone, w_p = sum_i S_ip r_ip x v_i^1 / tr D_p, with the velocities of FLIP:
//          shape functions that are small where mass is small keep it bounded, linear ones as well
// source: Jiang, Schroeder, Selle, Teran and Stomakhin, ACM Trans. Graph. 34, 51 (2015).
#pragma once

#include "mpm_explicit/budget.hpp"
#include "mpm_explicit/transfer.hpp"

namespace mpm_explicit {

using namespace mpm;

/// C_p from the nodes, before particles move.
/// in:     nodes.motion, after contact; kind, spin or affine
/// in/out: particles; sums of their tiles: the work that C_p has had, and the angular momentum
///         m_p (B_yx - B_xy) that it stands for
/// exact:  a rotation of the nodes comes back as C_p; with quadratic shapes, whose D_p is h^2/4, what
///         particles_to_grid() gives back to the nodes has this angular momentum, to round-off
template <class Shape>
void take_affine_motion(const Shape& shape, const std::vector<Grain>& grains,
                        const GrainNodes& nodes, Transfer::Affine kind, Particles& particles,
                        std::vector<TileSums>& sums) {
    const Mesh& mesh = nodes.mesh();
    const Locator at(mesh);
    const double least = 1e-12 * mesh.h * mesh.h;  // on a node of linear shapes, D_p is zero
    nodes.for_each_tile([&](const Tile& tile, std::size_t number) {
        if (grains[tile.grain].rigid) return;
        const long* origin = nodes.origins(tile.grain);
        double work = 0, angular = 0;
        for (long k = tile.begin; k < tile.end; ++k) {
            const auto p = static_cast<std::size_t>(k);
            const double x = particles.x_p[p], y = particles.y_p[p], m = particles.m_p[p];
            double xx = 0, xy = 0, yx = 0, yy = 0, D_x = 0, D_y = 0, given = 0;  // xx ...: B_p
            double &cxx = particles.cxx_p[p], &cxy = particles.cxy_p[p], &cyx = particles.cyx_p[p],
                   &cyy = particles.cyy_p[p];
            for_each_link(shape, at, origin, x, y, [&](long dof, double S, double r_x, double r_y) {
                const NodeMotion& v = nodes.motion[dof];
                xx += S * v.vx_1 * r_x, xy += S * v.vx_1 * r_y;
                yx += S * v.vy_1 * r_x, yy += S * v.vy_1 * r_y;
                D_x += S * r_x * r_x, D_y += S * r_y * r_y;
                given += S * ((v.vx_1 - v.vx_0) * (cxx * r_x + cxy * r_y) +
                              (v.vy_1 - v.vy_0) * (cyx * r_x + cyy * r_y));
            });
            work += m * given, angular += m * (yx - xy);
            if (kind == Transfer::spin) {
                const double w = (yx - xy) / (D_x + D_y + least);
                cxx = 0, cxy = -w, cyx = w, cyy = 0;
            } else {
                cxx = xx / (D_x + least), cxy = xy / (D_y + least);
                cyx = yx / (D_x + least), cyy = yy / (D_y + least);
            }
        }
        sums[number].affine = work, sums[number].spin = angular;
    });
}

}  // namespace mpm_explicit
