// The matrices of rotating_column.hpp, which take the compiler long.
#include "flip/theory/rotating_column.hpp"

#include <Eigen/Dense>

namespace flip::theory {

double coarse_frequency_2(const Rings& s) {
    constexpr int n = Rings::count, borders = n - 1;
    const double scale = s.largest_kappa_2(), R = n * s.h,
                 // Sound so fast changes nothing, and leaves digits for the others.
        fast = 1e5 * scale * (R * R + 1 / (s.k * s.k));
    Eigen::VectorXd mass(borders + n);
    Eigen::MatrixXd W = Eigen::MatrixXd::Zero(borders + n, borders + n),
                    incompressible = Eigen::MatrixXd::Zero(borders + n, borders);
    for (int i = 1; i < n; ++i) {
        mass[i - 1] = s.r[2 * i];
        W(i - 1, i - 1) = s.r[2 * i] * s.kappa_2[2 * i];
        incompressible(i - 1, i - 1) = 1;
    }
    for (int c = 0; c < n; ++c) {
        const int middle = 2 * c + 1, along = borders + c;
        const double r = mass[along] = s.r[middle], c_2 = std::min(s.sound_2[middle], fast);
        // D and xi as sums over the displacements of this ring.
        const int at[] = {c - 1, c, along};
        const double D[] = {-s.r[middle - 1] / (r * s.h), s.r[middle + 1] / (r * s.h), s.k},
                     xi[] = {0.5, 0.5, 0};
        const auto is_wall = [&](int a) { return at[a] < 0 || (a == 1 && c == n - 1); };
        for (int a = 0; a < 3; ++a) {
            if (is_wall(a)) continue;
            if (a < 2) incompressible(along, at[a]) = -D[a] / s.k;
            for (int b = 0; b < 3; ++b)
                if (!is_wall(b))
                    W(at[a], at[b]) +=
                        r * (c_2 * D[a] * D[b] + s.g[middle] * (xi[a] * D[b] + D[a] * xi[b]));
        }
    }
    const Eigen::MatrixXd weighted = mass.asDiagonal() * incompressible;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> stiff(
        incompressible.transpose() * W * incompressible, incompressible.transpose() * weighted);
    const Eigen::VectorXd per_root = mass.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> all(per_root.asDiagonal() * W *
                                                             per_root.asDiagonal());
    if (stiff.eigenvalues()[0] < -1e-5 * scale) return all.eigenvalues()[0];
    const Eigen::VectorXd alike =
        (all.eigenvectors().transpose() *
         (per_root.cwiseInverse().asDiagonal() * incompressible * stiff.eigenvectors().col(n - 2)))
            .cwiseAbs();
    Eigen::Index most = 0;
    alike.maxCoeff(&most);
    return all.eigenvalues()[most];
}

}  // namespace flip::theory
