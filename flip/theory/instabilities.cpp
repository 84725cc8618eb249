// The matrices of instabilities.hpp, which take the compiler long.
#include "flip/theory/instabilities.hpp"

#include <Eigen/Cholesky>

namespace flip::theory {

double interface_rate_on_mesh(const TwoLayers& s, double k, double dx, double dz, bool consistent) {
    const double mu = (2 + std::cos(k * dx)) / 3;
    const long below = std::lround(s.lower_depth / dz),
               cells = below + std::lround(s.upper_depth / dz), inside = cells - 1;
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(cells + 1, cells + 1), U = M, W = M;
    for (long j = 0; j < cells; ++j) {
        const double m = dz * (j < below ? s.lower_density : s.upper_density);
        M(j, j) += m / 3, M(j + 1, j + 1) += m / 3;
        M(j, j + 1) = M(j + 1, j) = m / 6;
        U(j, j) = U(j, j + 1) = dz * std::sin(0.5 * k * dx);
        W(j, j + 1) = dx * std::cos(0.5 * k * dx), W(j, j) = -W(j, j + 1);
    }
    const Eigen::MatrixXd per_m = M.rowwise().sum().cwiseInverse().asDiagonal(),
                          trip = mu * per_m * M * per_m;
    const auto response = [&](long first, long count) -> Eigen::MatrixXd {
        if (!consistent) return trip.block(first, first, count, count);
        return M.block(first, first, count, count)
                   .llt()
                   .solve(Eigen::MatrixXd::Identity(count, count)) /
               mu;
    };
    // Walls hold w at both ends.
    const Eigen::MatrixXd D_u = U.topRows(cells), D_w = W.block(0, 1, cells, inside),
                          R_u = response(0, cells + 1), R_w = response(1, inside);
    const double pull = s.gravity * (s.upper_density - s.lower_density) * mu;
    const Eigen::VectorXd f = std::sqrt(std::fabs(pull)) * Eigen::VectorXd::Unit(inside, below - 1);
    const Eigen::MatrixXd A = D_u * R_u * D_u.transpose() + D_w * R_w * D_w.transpose();
    const Eigen::VectorXd p = A.ldlt().solve(D_w * (R_w * f));
    return std::sqrt(std::max(0.0, f.dot(R_w * (f - D_w.transpose() * p))));
}

}  // namespace flip::theory
