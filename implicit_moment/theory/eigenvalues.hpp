// Eigenvalues of complex matrices and inverses of sparse ones, which take the compiler long: a source of
// their own is compiled beside the program.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <complex>
#include <functional>

namespace implicit_moment {

/// Eigenvalues, and the eigenvectors of unit length as columns.
struct Eigensystem {
    Eigen::VectorXcd values;
    Eigen::MatrixXcd vectors;
};
Eigensystem eigensystem(const Eigen::MatrixXcd& A);

/// x -> A^-1 x, by sparse factors of A.
/// out:    empty where A is singular
std::function<Eigen::VectorXcd(const Eigen::VectorXcd&)> sparse_inverse(
    const Eigen::SparseMatrix<std::complex<double>>& A);

}  // namespace implicit_moment
