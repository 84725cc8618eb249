// Shape functions: the weights S of a particle at the four nodes of its cell, and R at the four cells
// whose centers are around it.
#pragma once

#include <algorithm>

#include "flip/particles.hpp"
#include "flip/problem.hpp"

namespace flip {

/// Where a position is, in both directions: the cell with its four nodes, and the four cells around.
struct Weights {
    int node, cell;         // index of the lower left one of each four
    double S_x[2], S_z[2];  // of the nodes
    double R_x[2], R_z[2];  // of the cells
};

/// The constants of weights_at().
struct WeightScale {
    double x_low, z_low, per_dx, per_dz;
    int stride, origin, last_x, last_z;
    bool rings;

    explicit WeightScale(const Grid& grid)
        : x_low(grid.x.low),
          z_low(grid.z.low),
          per_dx(1 / grid.x.spacing()),
          per_dz(1 / grid.z.spacing()),
          stride(int(grid.stride())),
          origin(int(grid.index(0, 0))),
          last_x(int(grid.x.cells) - 1),
          last_z(int(grid.z.cells) - 1),
          rings(grid.axisymmetric) {}
};

/// S and R of one particle; both are linear, sum to 1, and differ by half a cell.
///   axisymmetric: R is linear in r^2, from 1 at r^2 = i (i + 1) dx^2, to 0 where column i + 1 has 1
/// in:     a position on the mesh
/// exact:  integral of R over the volume is the volume of the cell, in rings too: half-way in r^2
///         between i (i + 1) and (i + 1)(i + 2) is the border, (i + 1)^2
template <bool rings>
[[gnu::always_inline]] inline Weights weights_at(const WeightScale& a, double x, double z) {
    Weights w;
    const double s = (x - a.x_low) * a.per_dx, t = (z - a.z_low) * a.per_dz;
    const int i = std::min(int(s), a.last_x), j = std::min(int(t), a.last_z);
    const double fx = s - i, fz = t - j;
    w.S_x[0] = 1 - fx, w.S_x[1] = fx;
    w.S_z[0] = 1 - fz, w.S_z[1] = fz;
    int right = fx >= 0.5 ? 1 : 0;
    const int above = fz >= 0.5 ? 1 : 0;
    w.R_x[1] = fx + 0.5 - right;
    if constexpr (rings) {
        const double r2 = s * s, inner = i;
        right = r2 >= inner * (inner + 1) ? 1 : 0;
        const double outer = i + right;
        w.R_x[1] = 0.5 * (r2 / outer - (outer - 1));
    }
    w.R_x[0] = 1 - w.R_x[1];
    w.R_z[1] = fz + 0.5 - above, w.R_z[0] = 1 - w.R_z[1];
    w.node = a.origin + j * a.stride + i;
    w.cell = w.node + (above - 1) * a.stride + right - 1;
    return w;
}
inline Weights weights_at(const WeightScale& a, double x, double z) {
    return a.rings ? weights_at<true>(a, x, z) : weights_at<false>(a, x, z);
}

/// The weights of a batch of particles.
class BatchWeights {
   public:
    /// in: positions of at most batch_size particles, on the mesh
    BatchWeights(const WeightScale& scale, const double* x, const double* z, long count) {
        scale.rings ? find<true>(scale, x, z, count) : find<false>(scale, x, z, count);
    }
    /// weights_at() of particle k of the batch.
    [[gnu::always_inline]] Weights operator[](long k) const {
        return {node_[k],
                cell_[k],
                {1 - S_x_[k], S_x_[k]},
                {1 - S_z_[k], S_z_[k]},
                {1 - R_x_[k], R_x_[k]},
                {1 - R_z_[k], R_z_[k]}};
    }

   private:
    int node_[batch_size], cell_[batch_size];
    double S_x_[batch_size], S_z_[batch_size], R_x_[batch_size], R_z_[batch_size];

    template <bool rings>
    void find(WeightScale scale, const double* x, const double* z, long count) {
#pragma omp simd
        for (long k = 0; k < count; ++k) {
            const Weights w = weights_at<rings>(scale, x[k], z[k]);
            node_[k] = w.node, cell_[k] = w.cell;
            S_x_[k] = w.S_x[1], S_z_[k] = w.S_z[1];
            R_x_[k] = w.R_x[1], R_z_[k] = w.R_z[1];
        }
    }
};

/// Calls visit(index, weight) for the four nodes of a particle.
template <class Visit>
void for_nodes(const WeightScale& a, const Weights& w, const Visit& visit) {
    visit(w.node, w.S_x[0] * w.S_z[0]);
    visit(w.node + 1, w.S_x[1] * w.S_z[0]);
    visit(w.node + a.stride, w.S_x[0] * w.S_z[1]);
    visit(w.node + a.stride + 1, w.S_x[1] * w.S_z[1]);
}
/// The same for the four cells around it.
template <class Visit>
void for_cells(const WeightScale& a, const Weights& w, const Visit& visit) {
    visit(w.cell, w.R_x[0] * w.R_z[0]);
    visit(w.cell + 1, w.R_x[1] * w.R_z[0]);
    visit(w.cell + a.stride, w.R_x[0] * w.R_z[1]);
    visit(w.cell + a.stride + 1, w.R_x[1] * w.R_z[1]);
}

}  // namespace flip
