// The fields that push particles, interleaved for the gather: the six components of one node share
// one cache line.
//
//     E_x E_x E_x ...   E_y E_y E_y ...   ->   E_x E_y E_z B_x B_y B_z - -   E_x E_y ...
//     one component of all nodes               all components of one node
#pragma once

#include <vector>

#include "common/parallel.hpp"
#include "implicit_moment/field/quadratic_weights.hpp"
#include "implicit_moment/field/smooth.hpp"
#include "implicit_moment/particles.hpp"

namespace implicit_moment {

/// The components that are stored at index (i, j): each at its own place of the staggered mesh.
struct alignas(8 * sizeof(ParticleReal)) NodeField {
    ParticleReal E_x, E_y, E_z, B_x, B_y, B_z;
};

/// grid.size() records, ghosts included.
using InterleavedField = std::vector<NodeField>;

/// The six components at one particle (Real = double) or at several (SimdVector).
template <class Real>
struct LocalField {
    Real E_x, E_y, E_z, B_x, B_y, B_z;
};

/// What interleave_field works in, kept between steps.
struct InterleaveScratch {
    VectorField smoothed;
    Field pass;
    explicit InterleaveScratch(const Grid& grid) : smoothed(grid) {}
};

/// Interleaves what pushes particles: a smoothed copy of E, and B itself.
/// in:     E and B, ghosts filled.
/// note:   E is smoothed as the current is; then E does on particles the work that J takes.
inline void interleave_field(const Grid& grid, const SmoothingSettings& smoothing,
                             const VectorField& E_mesh, const VectorField& B,
                             InterleaveScratch& scratch, InterleavedField& interleaved) {
    const bool changes = smoothing.passes > 0 || mirrors_plasma(grid);
    if (changes) {
        scratch.smoothed.all = E_mesh.all;
        if (mirrors_plasma(grid)) fill_ghosts(grid, felt(grid), scratch.smoothed);
        smooth(grid, felt(grid), smoothing, scratch.smoothed.all.data(), scratch.pass);
    }
    const VectorField& E = changes ? scratch.smoothed : E_mesh;
    interleaved.resize(grid.size());
    const double *E_x = E.x(), *E_y = E.y(), *E_z = E.z(), *B_x = B.x(), *B_y = B.y(), *B_z = B.z();
    common::for_each_block(
        grid.size(),
        [&](int, long begin, long end) {
            for (long n = begin; n < end; ++n) {
                interleaved[n] = {ParticleReal(E_x[n]), ParticleReal(E_y[n]), ParticleReal(E_z[n]),
                                  ParticleReal(B_x[n]), ParticleReal(B_y[n]), ParticleReal(B_z[n])};
            }
        },
        grid.size());
}

/// Fields at a particle that lies (d_x, d_z) cells from its nearest node, |d| <= 1/2.
///     E_x(x_p) = sum_g E_x,g S1(x) S2(z),  B_z alike;   E_z, B_x with S2 S1;   E_y with S2 S2;
///     B_y with S1 S1
/// in:     corner, the record down left of the nearest node; stride between rows. Real is double or
///         SimdVector for particles that share one node.
/// exact:  E is gathered with the splines that deposit J, so that the work done on particles is the
///         work taken from the mesh; a potential field E = -grad phi is gathered as the exact
///         gradient of the gathered potential, and the gathered B is divergence-free at every
///         point.
template <class Real>
inline LocalField<Real> gather_field(const NodeField* corner, long stride, const Real& d_x,
                                     const Real& d_z) {
    const QuadraticWeights<Real> S_x(d_x), S_z(d_z);
    const auto& q_x = S_x.quadratic;
    const auto& l_x = S_x.linear;
    LocalField<Real> at{};
    for (int j = 0; j < 3; ++j) {
        const NodeField* f = corner + j * stride;
        const Real& w = S_z.quadratic[j];
        at.E_x += w * (l_x[0] * f[0].E_x + l_x[1] * f[1].E_x);
        at.E_y += w * (q_x[0] * f[0].E_y + q_x[1] * f[1].E_y + q_x[2] * f[2].E_y);
        at.B_z += w * (l_x[0] * f[0].B_z + l_x[1] * f[1].B_z);
    }
    for (int j = 0; j < 2; ++j) {
        const NodeField* f = corner + j * stride;
        const Real& w = S_z.linear[j];
        at.E_z += w * (q_x[0] * f[0].E_z + q_x[1] * f[1].E_z + q_x[2] * f[2].E_z);
        at.B_x += w * (q_x[0] * f[0].B_x + q_x[1] * f[1].B_x + q_x[2] * f[2].B_x);
        at.B_y += w * (l_x[0] * f[0].B_y + l_x[1] * f[1].B_y);
    }
    return at;
}

}  // namespace implicit_moment
