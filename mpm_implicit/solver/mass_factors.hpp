// The consistent mass matrix of every grain, factorized by itself,  M_g = L L^T.
//
// It makes v^0 cheap, and it finds the nodes where M_g is rank-deficient: where the motion of a node
// is, at all particles, nearly that of nodes before it, its pivot is nearly zero, and v^0 there would
// be anything. Such nodes are constrained to a neighbor. It is a preconditioner and no more: constraints
// are made afterwards, it leaves out the signs of walls, and it is kept in single precision.
#pragma once

#include "mpm_implicit/solver/grain_matrix.hpp"
#include "mpm_implicit/solver/master_dofs.hpp"

namespace mpm_implicit {

class MassFactors {
   public:
    /// Factorizes the mass of all grains.
    /// in:     matrix, with the consistent mass
    /// out:    nodes whose pivot is nearly zero, which are left out
    template <int reach>
    std::vector<long> factorize(const GrainMatrix<reach>& matrix, const std::vector<Grain>& grains,
                                const GrainNodes& nodes) {
        const MasterDofs masters(nodes);
        size_ = nodes.size();
        number_.assign(static_cast<std::size_t>(size_), -1);
        factors_.resize(grains.size());
        common::for_each_row(static_cast<long>(grains.size()), [&](long g) {
            if (!grains[g].rigid) factorize(matrix, nodes, masters, static_cast<int>(g));
        });
        std::vector<long> all;
        for (const Factor& f : factors_)
            all.insert(all.end(), f.rank_deficient.begin(), f.rank_deficient.end());
        return all;
    }

    /// z = L^-T L^-1 r along x and along y: nearly M^-1 r
    void solve(const Vector& r, Vector& z) const {
        z.setZero();
        common::for_each_row(static_cast<long>(factors_.size()), [&](long g) {
            const Factor& f = factors_[g];
            const long n = static_cast<long>(f.dofs.size());
            std::vector<double> both(static_cast<std::size_t>(2 * n));
            double *x = both.data(), *y = x + n;
            for (long i = 0; i < n; ++i) {
                const float* L = f.row(i);
                double sum_x = r[f.dof(i)], sum_y = r[size_ + f.dof(i)];
#pragma omp simd reduction(- : sum_x, sum_y)
                for (long j = f.first_of(i); j < i; ++j) sum_x -= L[j] * x[j], sum_y -= L[j] * y[j];
                x[i] = sum_x * f.per_pivot(i), y[i] = sum_y * f.per_pivot(i);
            }
            for (long i = n; i-- > 0;) {
                const float* L = f.row(i);
                const double v_x = x[i] * f.per_pivot(i), v_y = y[i] * f.per_pivot(i);
#pragma omp simd
                for (long j = f.first_of(i); j < i; ++j) x[j] -= v_x * L[j], y[j] -= v_y * L[j];
                const double alone = f.alone[i];
                z[f.dof(i)] = v_x + alone * r[f.dof(i)];
                z[size_ + f.dof(i)] = v_y + alone * r[size_ + f.dof(i)];
            }
        });
    }

   private:
    static constexpr double least_pivot = 1e-3;  // of the diagonal

    struct Factor {
        std::vector<long> dofs, rank_deficient;
        std::vector<long> first, begin;  // of each row: first column; where column 0 would be
        std::vector<float> L;
        std::vector<double> pivots;  // reciprocals of the diagonal of L; 0 for a node left out
        std::vector<double> alone;   // 1/M_ii of a node left out: it may have no master

        long dof(long i) const { return dofs[i]; }
        long first_of(long i) const { return first[i]; }
        double per_pivot(long i) const { return pivots[i]; }
        const float* row(long i) const { return L.data() + begin[i]; }
    };

    template <int reach>
    void factorize(const GrainMatrix<reach>& matrix, const GrainNodes& nodes,
                   const MasterDofs& masters, int grain) {
        Factor& f = factors_[grain];
        f.dofs.clear(), f.rank_deficient.clear();
        for_each_dof_of(matrix.rows(), grain, nodes, [&](long dof) {
            if (!(nodes.sums[dof].m > nodes.least_mass())) return;
            number_[dof] = static_cast<long>(f.dofs.size());
            f.dofs.push_back(dof);
        });
        const auto for_each_entry = [&](const auto& work) {
            matrix.for_each_mass_of(grain, nodes, [&](long one, long two, double m) {
                masters.for_each_pair(one, two, [&](const auto& a, const auto& b) {
                    const long i = number_[a.dof], j = number_[b.dof];
                    if (i >= 0 && j >= 0)
                        work(std::max(i, j), std::min(i, j),
                             (i == j && one != two ? 2 : 1) * m * a.mass * b.mass);
                });
            });
        };
        const long n = static_cast<long>(f.dofs.size());
        f.first.resize(f.dofs.size()), f.begin.resize(f.dofs.size());
        f.pivots.resize(f.dofs.size()), f.alone.assign(f.dofs.size(), 0);
        for (long i = 0; i < n; ++i) f.first[i] = i;
        for_each_entry([&](long high, long low, double) {
            long& first = f.first[high];
            first = std::min(first, low);
        });
        long length = 0;
        for (long i = 0; i < n; ++i) {
            f.begin[i] = length - f.first_of(i);
            length += i - f.first_of(i) + 1;
        }
        std::vector<double> entries(static_cast<std::size_t>(length), 0.0);
        const auto row = [&](long i) { return entries.data() + f.begin[i]; };
        for_each_entry([&](long high, long low, double m) { row(high)[low] += m; });
        // L_ij = (M_ij - sum_k L_ik L_jk) / L_jj
        for (long i = 0; i < n; ++i) {
            double* L_i = row(i);
            double squares = 0;
            for (long j = f.first_of(i); j < i; ++j) {
                const double* L_j = row(j);
                double sum = 0;
#pragma omp simd reduction(+ : sum)
                for (long k = std::max(f.first_of(i), f.first_of(j)); k < j; ++k)
                    sum += L_i[k] * L_j[k];
                L_i[j] = (L_i[j] - sum) * f.per_pivot(j);
                squares += L_i[j] * L_i[j];
            }
            const double pivot = L_i[i] - squares;
            const bool seen = pivot > least_pivot * L_i[i];
            f.pivots[i] = seen ? 1 / std::sqrt(pivot) : 0;
            if (seen) continue;
            f.rank_deficient.push_back(f.dof(i));
            f.alone[i] = 1 / L_i[i];
            std::fill(L_i + f.first_of(i), L_i + i, 0.0);
        }
        f.L.assign(entries.begin(), entries.end());
    }

    long size_ = 0;
    std::vector<Factor> factors_;
    std::vector<long> number_;
};

}  // namespace mpm_implicit
