// The preconditioner for large time steps: every grain's matrix is factorized by itself,
//     A_g = L L^T
// so that what is left to conjugate gradients is how grains press on each other. Nodes are numbered
// along the shorter side of the grain; then L fills no more than the envelope of A, from the first
// entry of each row to the diagonal, and its rows are products of contiguous numbers:
//
//     1 . . . .      a row of L is stored from its first entry on, two rows (x, y) per node
//     x 1 . . .      and the zeros before it are not
//       x 1 . .
//       x x 1 .
//         x x 1
// It is kept in single precision, as it is read more often than anything else; L L^T stays
// positive.
#pragma once

#include "mpm_implicit/solver/grain_matrix.hpp"
#include "mpm_implicit/solver/master_dofs.hpp"

namespace mpm_implicit {

class GrainFactors {
   public:
    /// Factorizes all grains.
    /// in:     matrix; scale, 0 where a velocity cannot change
    template <int reach>
    void factorize(const GrainMatrix<reach>& matrix, const Vector& scale,
                   const std::vector<Grain>& grains, const GrainNodes& nodes) {
        size_ = nodes.size();
        const MasterDofs masters(nodes);
        number_.assign(static_cast<std::size_t>(size_), -1);
        factors_.resize(grains.size());
        common::for_each_row(static_cast<long>(grains.size()), [&](long g) {
            if (!grains[g].rigid) factorize(matrix, scale, nodes, masters, static_cast<int>(g));
        });
    }

    /// z = L^-T L^-1 r for every grain; 0 where nothing moves
    void solve(const Vector& r, Vector& z) const {
        z.setZero();
        common::for_each_row(static_cast<long>(factors_.size()), [&](long g) {
            const Factor& f = factors_[g];
            const long n = f.size();
            std::vector<double> x(static_cast<std::size_t>(2 * n));
            double* y = x.data();
            for (long i = 0; i < n; ++i) {
                const float *L_0 = f.row(i, 0), *L_1 = f.row(i, 1);
                double sum_0 = f.moves(i, 0) ? r[f.dof(i)] : 0,
                       sum_1 = f.moves(i, 1) ? r[size_ + f.dof(i)] : 0;
#pragma omp simd reduction(- : sum_0, sum_1)
                for (long j = 2 * f.first_of(i); j < 2 * i; ++j)
                    sum_0 -= L_0[j] * y[j], sum_1 -= L_1[j] * y[j];
                y[2 * i] = sum_0 * f.per_pivot(i, 0);
                y[2 * i + 1] = (sum_1 - L_1[2 * i] * y[2 * i]) * f.per_pivot(i, 1);
            }
            for (long i = n; i-- > 0;) {
                const float *L_0 = f.row(i, 0), *L_1 = f.row(i, 1);
                const double value_1 = y[2 * i + 1] * f.per_pivot(i, 1),
                             value_0 = (y[2 * i] - L_1[2 * i] * value_1) * f.per_pivot(i, 0);
#pragma omp simd
                for (long j = 2 * f.first_of(i); j < 2 * i; ++j)
                    y[j] -= value_0 * L_0[j] + value_1 * L_1[j];
                if (f.moves(i, 0)) z[f.dof(i)] = value_0;
                if (f.moves(i, 1)) z[size_ + f.dof(i)] = value_1;
            }
        });
    }

   private:
    // Rows 2 i and 2 i + 1 are the velocities of node i along x and y; what cannot move has a one
    // on the diagonal and nothing else.
    struct Factor {
        std::vector<long> dofs;               // of the nodes
        std::vector<unsigned char> can_move;  // 1 for x, 2 for y
        std::vector<long> first;              // of each node, the first one its rows reach back to
        std::vector<long> begin;              // of each row, where column 0 would be
        std::vector<float> L;
        std::vector<double> pivots;  // reciprocals of the diagonal of L

        static std::size_t at(long i, int component) {
            return static_cast<std::size_t>(2 * i + component);
        }
        long size() const { return static_cast<long>(dofs.size()); }
        long dof(long i) const { return dofs[i]; }
        long first_of(long i) const { return first[i]; }
        bool moves(long i, int component) const { return (can_move[i] >> component & 1) != 0; }
        double per_pivot(long i, int component) const { return pivots[at(i, component)]; }
        const float* row(long i, int component) const { return L.data() + begin[at(i, component)]; }
        long begin_of(long i, int component) const { return begin[at(i, component)]; }
    };

    template <int reach>
    void factorize(const GrainMatrix<reach>& matrix, const Vector& scale, const GrainNodes& nodes,
                   const MasterDofs& masters, int grain) {
        Factor& f = factors_[grain];
        f.dofs.clear(), f.can_move.clear();
        for_each_dof_of(matrix.rows(), grain, nodes, [&](long dof) {
            const int moves = (scale[dof] > 0 ? 1 : 0) + (scale[size_ + dof] > 0 ? 2 : 0);
            if (moves == 0) return;
            number_[dof] = f.size();
            f.dofs.push_back(dof), f.can_move.push_back(static_cast<unsigned char>(moves));
        });
        const long n = f.size();
        // The envelope, then its entries.
        f.first.resize(f.dofs.size());
        for (long i = 0; i < n; ++i) f.first[i] = i;
        for_each_entry(matrix, grain, nodes, masters, f, [&](long i, int, long j, int, double) {
            long& first = f.first[std::max(i, j)];
            first = std::min({first, i, j});
        });
        f.begin.resize(2 * f.dofs.size());
        long length = 0;
        for (long i = 0; i < n; ++i) {
            for (const int component : {0, 1}) {
                f.begin[Factor::at(i, component)] = length - 2 * f.first_of(i);
                length += 2 * (i - f.first_of(i)) + 2;
            }
        }
        std::vector<double> entries(static_cast<std::size_t>(length), 0.0);
        const auto row = [&](long i, int component) {
            return entries.data() + f.begin_of(i, component);
        };
        f.pivots.resize(2 * f.dofs.size());
        for_each_entry(matrix, grain, nodes, masters, f,
                       [&](long i, int a, long j, int b, double value) {
                           if (i > j || (i == j && a >= b))
                               row(i, a)[2 * j + b] += value;
                           else
                               row(j, b)[2 * i + a] += value;
                       });
        for (long i = 0; i < n; ++i)
            for (const int component : {0, 1})
                if (!f.moves(i, component)) row(i, component)[2 * i + component] = 1;
        for (long i = 0; i < n; ++i) factorize_node(i, row, f);
        f.L.assign(entries.begin(), entries.end());
    }

    // L_ij = (A_ij - sum_k L_ik L_jk) L_jj^-T, two rows and two columns at a time.
    template <class Row>
    static void factorize_node(long i, const Row& row, Factor& f) {
        double *L_0 = row(i, 0), *L_1 = row(i, 1);
        const double before_0 = L_0[2 * i], before_1 = L_1[2 * i + 1];
        for (long j = f.first_of(i); j <= i; ++j) {
            const double *M_0 = row(j, 0), *M_1 = row(j, 1);
            double s_00 = 0, s_01 = 0, s_10 = 0, s_11 = 0;
#pragma omp simd reduction(+ : s_00, s_01, s_10, s_11)
            for (long k = 2 * std::max(f.first_of(i), f.first_of(j)); k < 2 * j; ++k) {
                s_00 += L_0[k] * M_0[k], s_01 += L_0[k] * M_1[k];
                s_10 += L_1[k] * M_0[k], s_11 += L_1[k] * M_1[k];
            }
            const double a_10 = L_1[2 * j] - s_10;
            if (j < i) {
                const double per_0 = f.per_pivot(j, 0), per_1 = f.per_pivot(j, 1);
                L_0[2 * j] = (L_0[2 * j] - s_00) * per_0;
                L_1[2 * j] = a_10 * per_0;
                L_0[2 * j + 1] = (L_0[2 * j + 1] - s_01 - L_0[2 * j] * M_1[2 * j]) * per_1;
                L_1[2 * j + 1] = (L_1[2 * j + 1] - s_11 - L_1[2 * j] * M_1[2 * j]) * per_1;
            } else {
                f.pivots[Factor::at(i, 0)] = reciprocal(before_0 - s_00, before_0);
                L_1[2 * i] = a_10 * f.per_pivot(i, 0);
                f.pivots[Factor::at(i, 1)] =
                    reciprocal(before_1 - s_11 - L_1[2 * i] * L_1[2 * i], before_1);
            }
        }
    }

    // What round-off has made of a pivot near zero is replaced: a preconditioner may.
    static double reciprocal(double pivot, double before) {
        return 1 / std::sqrt(pivot > 1e-14 * before ? pivot : before);
    }

    // Calls work(node, component, node, component, value) for the entries of a grain's matrix where
    // both can move, of each pair of entries one.
    template <int reach, class Work>
    void for_each_entry(const GrainMatrix<reach>& matrix, int grain, const GrainNodes& nodes,
                        const MasterDofs& masters, const Factor& f, const Work& work) const {
        matrix.for_each_block_of(
            grain, nodes, [&](long one, long two, double xx, double xy, double yx, double yy) {
                masters.for_each_pair(one, two, [&](const auto& a, const auto& b) {
                    const long i = number_[a.dof], j = number_[b.dof];
                    if (i < 0 || j < 0) return;
                    const bool same = one == two && i == j;
                    // Dofs that stand for one: the entry and its transpose meet on the diagonal.
                    const double twice = i == j && !same ? 2 : 1;
                    const bool i_x = f.moves(i, 0), i_y = f.moves(i, 1), j_x = f.moves(j, 0),
                               j_y = f.moves(j, 1);
                    if (i_x && j_x) work(i, 0, j, 0, twice * a.x * b.x * xx);
                    if (i_y && j_y) work(i, 1, j, 1, twice * a.y * b.y * yy);
                    if (i_x && j_y) work(i, 0, j, 1, a.x * b.y * xy);
                    if (!same && i_y && j_x) work(i, 1, j, 0, a.y * b.x * yx);
                });
            });
    }

    long size_ = 0;
    std::vector<Factor> factors_;
    std::vector<long> number_;
};

}  // namespace mpm_implicit
