// The matrices of the theta scheme on the nodes of each grain.
//
//     M_ij = sum_p m_p S_ip S_jp                                   consistent mass
//     K_ij = sum_p V_p grad S_ip . T . grad S_jp                   stiffness, 2 x 2
//     A    = M + theta dt (theta dt + beta) K                      of the system for v^theta [MPM-8]
// M and A are symmetric, of order 2 n for n dofs, and stored by diagonals of a stencil. No entry
// couples two grains (contact does):
//
//     | A_1          |  v_1: v_x of all dofs, then v_y
//     |     A_2      |  v_2
//     |         ...  |  ...
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "mpm_explicit/strain.hpp"
#include "mpm_implicit/solver/ghost_vectors.hpp"
#include "mpm_implicit/solver/stencil.hpp"

namespace mpm_implicit {

/// Components of a block: how the force along the first answers to velocity along the second.
enum Component { xx, xy, yx, yy };

template <int reach>
class GrainMatrix {
   public:
    /// Sums up M and K over the particles.
    /// in:     theta dt; consistent: M in A is the consistent mass, else the lumped mass
    ///         m_i = sum_j M_ij; particles.turn_p
    /// exact:  A is symmetric and positive where nodes have mass; K of a rigid motion is zero
    template <class Shape>
    void assemble(const Shape& shape, const std::vector<AnyLaw>& laws,
                  const std::vector<Grain>& grains, const Particles& particles,
                  const GrainNodes& nodes, const std::vector<GridRow>& rows, double theta_dt,
                  bool consistent) {
        static_assert(Shape::width == reach + 1);
        consistent_ = consistent;
        nodes_ = &nodes;
        rows_ = rows;
        A_.clear(nodes.size());
        if (consistent) M_.clear(nodes.size());
        const Locator at(nodes.mesh());
        nodes.for_each_tile([&](const Tile& tile, std::size_t) {
            const Grain& grain = grains[tile.grain];
            if (grain.rigid) return;
            const AnyLaw& law = laws[grain.material];
            const double factor_K = theta_dt * (theta_dt + law.viscosity);
            const long* origin = nodes.origins(tile.grain);
            for (long k = tile.begin; k < tile.end; ++k) {
                const auto p = static_cast<std::size_t>(k);
                const OwnShape<Shape> own = own_shape(shape, particles, p);
                add_particle(own.x((particles.x_p[p] - at.x_low) * at.per_h, at.per_h),
                             own.y((particles.y_p[p] - at.y_low) * at.per_h, at.per_h), origin,
                             law.T.lambda, law.T.G, factor_K * particles.V_p[p],
                             particles.turn_p[p], particles.m_p[p]);
            }
        });
        if (!consistent) add_lumped();
    }

    bool consistent() const { return consistent_; }
    const std::vector<GridRow>& rows() const { return rows_; }

    /// y = A x, with ghosts: those of x are filled, and those of y reduced.
    void multiply(Vector& x, Vector& y) const {
        const long n = A_.size();
        multiply_rows(x, y, [&](int diagonal, long dof, long other, long count, bool transposed) {
            const long from = transposed ? other : dof;
            const double *Axx = A_.field(diagonal, xx) + from,
                         *Axy = A_.field(diagonal, transposed ? yx : xy) + from,
                         *Ayx = A_.field(diagonal, transposed ? xy : yx) + from,
                         *Ayy = A_.field(diagonal, yy) + from;
            const double *x_x = x.data() + other, *x_y = x_x + n;
            double *y_x = y.data() + dof, *y_y = y_x + n;
#pragma omp simd
            for (long i = 0; i < count; ++i) {
                y_x[i] += Axx[i] * x_x[i] + Axy[i] * x_y[i];
                y_y[i] += Ayx[i] * x_x[i] + Ayy[i] * x_y[i];
            }
        });
    }

    /// y = M x, as A uses it.
    void multiply_mass(Vector& x, Vector& y) const {
        const long n = A_.size();
        if (!consistent_) {
            for_each_dof(n, [&](long i) {
                const double m = nodes_->sums[i].m;
                y[i] = m * x[i], y[n + i] = m * x[n + i];
            });
            return;
        }
        multiply_rows(x, y, [&](int diagonal, long dof, long other, long count, bool transposed) {
            const double* M = M_.field(diagonal, 0) + (transposed ? other : dof);
            const double *x_x = x.data() + other, *x_y = x_x + n;
            double *y_x = y.data() + dof, *y_y = y_x + n;
#pragma omp simd
            for (long i = 0; i < count; ++i) y_x[i] += M[i] * x_x[i], y_y[i] += M[i] * x_y[i];
        });
    }

    /// The diagonals of A and of M, ghosts added to what they stand for.
    void diagonal(Vector& d) const {
        const long n = A_.size();
        std::copy_n(A_.field(0, xx), n, d.data());
        std::copy_n(A_.field(0, yy), n, d.data() + n);
        reduce_ghost_diagonal(*nodes_, d);
    }
    void diagonal_mass(Vector& d) const {
        const long n = A_.size();
        if (consistent_) {
            std::copy_n(M_.field(0, 0), n, d.data());
        } else {
            for (long i = 0; i < n; ++i) d[i] = nodes_->sums[i].m;
        }
        std::copy_n(d.data(), n, d.data() + n);
        if (consistent_) reduce_ghost_diagonal(*nodes_, d);
    }

    /// Calls work(dof, other, xx, xy, yx, yy) for the stored blocks of a grain.
    template <class Work>
    void for_each_block_of(int grain, const GrainNodes& nodes, const Work& work) const {
        const auto [low, above] = rows_of_grain(rows_, grain, nodes);
        for (long r = low; r < above; ++r) {
            for_each_link<reach>(
                rows_, r, [&](int diagonal, long dof, long other, long count, bool transposed) {
                    if (transposed) return;
                    for (long i = 0; i < count; ++i)
                        work(dof + i, other + i, A_.field(diagonal, xx)[dof + i],
                             A_.field(diagonal, xy)[dof + i], A_.field(diagonal, yx)[dof + i],
                             A_.field(diagonal, yy)[dof + i]);
                });
        }
    }

    /// Calls work(dof, other, m) for the stored entries of a grain's consistent mass matrix.
    template <class Work>
    void for_each_mass_of(int grain, const GrainNodes& nodes, const Work& work) const {
        const auto [low, above] = rows_of_grain(rows_, grain, nodes);
        for (long r = low; r < above; ++r) {
            for_each_link<reach>(
                rows_, r, [&](int diagonal, long dof, long other, long count, bool transposed) {
                    const double* M = M_.field(diagonal, 0) + dof;
                    for (long i = 0; i < count && !transposed; ++i) work(dof + i, other + i, M[i]);
                });
        }
    }

   private:
    // One particle's share: the pairs of its nodes, each pair once.
    template <class W>
    [[gnu::always_inline]] void add_particle(const W& w_x, const W& w_y, const long* origin,
                                             double lambda, double G, double V, double turn,
                                             double m) {
        constexpr int width = reach + 1;
        const double scale = 1 / (1 + turn * turn);  // G_ip of turned_gradient.hpp
        double S[width * width], Gx[width * width], Gy[width * width];
        long dof[width * width];
        for (int b = 0; b < width; ++b) {
            for (int a = 0; a < width; ++a) {
                const int i = b * width + a;
                S[i] = w_x.S[a] * w_y.S[b];
                const double G_x = w_x.G[a] * w_y.S[b], G_y = w_x.S[a] * w_y.G[b];
                Gx[i] = scale * (G_x - turn * G_y), Gy[i] = scale * (G_y + turn * G_x);
                dof[i] = origin[w_y.first + b] + w_x.first + a;
            }
        }
        const double P = V * (lambda + 2 * G), L = V * lambda, G_V = V * G;
        const double m_A = consistent_ ? m : 0;
        for (int i = 0; i < width * width; ++i) {
            for (int j = i; j < width * width; ++j) {
                const int diagonal =
                    Stencil<reach>::diagonal(j % width - i % width, j / width - i / width);
                const double M = S[i] * S[j], mass = m_A * M;
                A_.field(diagonal, xx)[dof[i]] += P * Gx[i] * Gx[j] + G_V * Gy[i] * Gy[j] + mass;
                A_.field(diagonal, xy)[dof[i]] += L * Gx[i] * Gy[j] + G_V * Gy[i] * Gx[j];
                A_.field(diagonal, yx)[dof[i]] += L * Gy[i] * Gx[j] + G_V * Gx[i] * Gy[j];
                A_.field(diagonal, yy)[dof[i]] += P * Gy[i] * Gy[j] + G_V * Gx[i] * Gx[j] + mass;
                if (consistent_) M_.field(diagonal, 0)[dof[i]] += m * M;
            }
        }
    }

    void add_lumped() {
        double *Axx = A_.field(0, xx), *Ayy = A_.field(0, yy);
        for_each_dof(A_.size(), [&](long i) {
            const double mass = nodes_->is_free()[i] * nodes_->sums[i].m;
            Axx[i] += mass, Ayy[i] += mass;
        });
    }

    // y = sum of link(...) over the stretches of every row, from zero.
    template <class Link>
    void multiply_rows(Vector& x, Vector& y, const Link& link) const {
        const long n = A_.size();
        fill_ghosts(*nodes_, x);
        common::for_each_block(
            static_cast<long>(rows_.size()),
            [&](int, long begin, long end) {
                for (long number = begin; number < end; ++number) {
                    const GridRow& row = rows_[number];
                    for (double* part : {y.data(), y.data() + n})
                        std::fill_n(part + row.origin + row.first, row.end - row.first, 0.0);
                    for_each_link<reach>(rows_, number, link);
                }
            },
            n);
        reduce_ghosts(*nodes_, y);
    }

    bool consistent_ = true;
    const GrainNodes* nodes_ = nullptr;
    std::vector<GridRow> rows_;
    SymmetricStencil<reach, 4> A_;
    SymmetricStencil<reach, 1> M_;
};

}  // namespace mpm_implicit
