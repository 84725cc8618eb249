// The preconditioner for large time steps: every grain's matrix is factorized by itself,
//     A_g = L L^T
// so that what is left to conjugate gradients is how grains press on each other. Nodes are numbered
// along the shorter side of the grain; then L fills no more than the envelope of A, from the first
// entry of each row to the diagonal, and its rows are products of contiguous numbers.
#pragma once

#include "mpm_implicit/grain_matrix.hpp"

namespace mpm_implicit {

class GrainFactors {
   public:
    /// in:     matrix; scale, 0 where a velocity cannot change
    template <int reach>
    void factorize(const GrainMatrix<reach>& matrix, const Vector& scale,
                   const std::vector<Grain>& grains, const GrainNodes& nodes) {
        size_ = nodes.size();
        find_homes(nodes);
        factors_.resize(grains.size());
        common::for_each_row(static_cast<long>(grains.size()), [&](long g) {
            if (!grains[static_cast<std::size_t>(g)].rigid)
                factorize(matrix, scale, nodes, static_cast<int>(g));
        });
    }

    /// z = L^-T L^-1 r for every grain; 0 where nothing moves
    void solve(const Vector& r, Vector& z) const {
        z.setZero();
        common::for_each_row(static_cast<long>(factors_.size()), [&](long g) {
            const Factor& f = factors_[static_cast<std::size_t>(g)];
            const long n = static_cast<long>(f.dofs.size());
            std::vector<double> x(static_cast<std::size_t>(n));
            for (long i = 0; i < n; ++i) {
                const auto k = static_cast<std::size_t>(i);
                const double* L = f.row(i);
                double sum = r[f.dofs[k]];
                const double* from = x.data();
#pragma omp simd reduction(- : sum)
                for (long j = f.first[k]; j < i; ++j) sum -= L[j] * from[j];
                x[k] = sum * f.per_pivot[k];
            }
            for (long i = n; i-- > 0;) {
                const auto k = static_cast<std::size_t>(i);
                const double* L = f.row(i);
                const double value = x[k] * f.per_pivot[k];
                double* to = x.data();
#pragma omp simd
                for (long j = f.first[k]; j < i; ++j) to[j] -= value * L[j];
                z[f.dofs[k]] = value;
            }
        });
    }

   private:
    struct Factor {
        std::vector<long> dofs;   // in the vector of velocities
        std::vector<long> first;  // of each row, the first column
        std::vector<long> begin;  // of each row, where column 0 would be
        std::vector<double> L, per_pivot;
        const double* row(long i) const { return L.data() + begin[static_cast<std::size_t>(i)]; }
        double* row(long i) { return L.data() + begin[static_cast<std::size_t>(i)]; }
    };

    // For whom a slot stands, and with which signs.
    void find_homes(const GrainNodes& nodes) {
        home_.resize(static_cast<std::size_t>(size_));
        sign_x_.assign(static_cast<std::size_t>(size_), 1), sign_y_ = sign_x_;
        for (long i = 0; i < size_; ++i) home_[static_cast<std::size_t>(i)] = i;
        const auto& images = nodes.images();
        for (auto image = images.rbegin(); image != images.rend(); ++image) {
            const auto slot = static_cast<std::size_t>(image->slot),
                       of = static_cast<std::size_t>(image->of);
            home_[slot] = home_[of];
            sign_x_[slot] = image->sign_x * sign_x_[of],
            sign_y_[slot] = image->sign_y * sign_y_[of];
        }
        number_.assign(static_cast<std::size_t>(2 * size_), -1);
    }

    template <int reach>
    void factorize(const GrainMatrix<reach>& matrix, const Vector& scale, const GrainNodes& nodes,
                   int grain) {
        Factor& f = factors_[static_cast<std::size_t>(grain)];
        f.dofs.clear();
        matrix.for_each_node_of(grain, nodes, [&](long slot) {
            if (scale[slot] > 0) f.dofs.push_back(slot);
            if (scale[size_ + slot] > 0) f.dofs.push_back(size_ + slot);
        });
        const long n = static_cast<long>(f.dofs.size());
        for (long i = 0; i < n; ++i)
            number_[static_cast<std::size_t>(f.dofs[static_cast<std::size_t>(i)])] = i;
        // The envelope, then its entries.
        f.first.resize(f.dofs.size()), f.begin.resize(f.dofs.size());
        for (long i = 0; i < n; ++i) f.first[static_cast<std::size_t>(i)] = i;
        for_each_entry(matrix, grain, nodes, [&](long i, long j, double) {
            const long low = std::min(i, j), high = std::max(i, j);
            f.first[static_cast<std::size_t>(high)] =
                std::min(f.first[static_cast<std::size_t>(high)], low);
        });
        long length = 0;
        for (long i = 0; i < n; ++i) {
            const auto k = static_cast<std::size_t>(i);
            f.begin[k] = length - f.first[k];
            length += i - f.first[k] + 1;
        }
        f.L.assign(static_cast<std::size_t>(length), 0.0);
        f.per_pivot.resize(f.dofs.size());
        for_each_entry(matrix, grain, nodes, [&](long i, long j, double value) {
            f.row(std::max(i, j))[std::min(i, j)] += value;
        });
        // L_ij = (A_ij - sum_k L_ik L_jk) / L_jj
        for (long i = 0; i < n; ++i) {
            const auto k = static_cast<std::size_t>(i);
            double* L_i = f.row(i);
            double squares = 0;
            const double before = L_i[i];
            for (long j = f.first[k]; j < i; ++j) {
                const double* L_j = f.row(j);
                double sum = L_i[j];
#pragma omp simd reduction(- : sum)
                for (long l = std::max(f.first[k], f.first[static_cast<std::size_t>(j)]); l < j;
                     ++l)
                    sum -= L_i[l] * L_j[l];
                L_i[j] = sum * f.per_pivot[static_cast<std::size_t>(j)];
                squares += L_i[j] * L_i[j];
            }
            // What round-off has made of a pivot near zero is replaced: a preconditioner may.
            const double pivot = before - squares;
            f.per_pivot[k] = 1 / std::sqrt(pivot > 1e-14 * before ? pivot : before);
        }
    }

    // Calls work(i, j, value) for the entries of a grain's matrix, of each pair one.
    template <int reach, class Work>
    void for_each_entry(const GrainMatrix<reach>& matrix, int grain, const GrainNodes& nodes,
                        const Work& work) const {
        matrix.for_each_block_of(
            grain, nodes, [&](long one, long two, double xx, double xy, double yx, double yy) {
                const auto a = static_cast<std::size_t>(one), b = static_cast<std::size_t>(two);
                const long ax = number_[static_cast<std::size_t>(home_[a])],
                           ay = number_[static_cast<std::size_t>(size_ + home_[a])],
                           bx = number_[static_cast<std::size_t>(home_[b])],
                           by = number_[static_cast<std::size_t>(size_ + home_[b])];
                const bool same = one == two, met = home_[a] == home_[b] && !same;
                // Two slots that stand for one: the entry and its transpose meet on the diagonal.
                const double twice = met ? 2 : 1;
                if (ax >= 0 && bx >= 0) work(ax, bx, twice * sign_x_[a] * sign_x_[b] * xx);
                if (ay >= 0 && by >= 0) work(ay, by, twice * sign_y_[a] * sign_y_[b] * yy);
                if (ax >= 0 && by >= 0) work(ax, by, sign_x_[a] * sign_y_[b] * xy);
                if (!same && ay >= 0 && bx >= 0) work(ay, bx, sign_y_[a] * sign_x_[b] * yx);
            });
    }

    long size_ = 0;
    std::vector<Factor> factors_;
    std::vector<long> home_, number_;
    std::vector<double> sign_x_, sign_y_;
};

}  // namespace mpm_implicit
