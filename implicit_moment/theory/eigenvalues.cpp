// What eigenvalues.hpp declares, by Eigen.
#include "implicit_moment/theory/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseLU>
#include <memory>

namespace implicit_moment {

Eigensystem eigensystem(const Eigen::MatrixXcd& A) {
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(A);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

std::function<Eigen::VectorXcd(const Eigen::VectorXcd&)> sparse_inverse(
    const Eigen::SparseMatrix<std::complex<double>>& A) {
    const auto factors =
        std::make_shared<Eigen::SparseLU<Eigen::SparseMatrix<std::complex<double>>>>(A);
    if (factors->info() != Eigen::Success) return {};
    return [factors](const Eigen::VectorXcd& x) -> Eigen::VectorXcd { return factors->solve(x); };
}

}  // namespace implicit_moment
