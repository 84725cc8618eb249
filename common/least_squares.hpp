// Least squares, compiled once: Eigen's decompositions take longer to compile than a step.
#pragma once

#include <Eigen/Core>

namespace common {

/// The x that makes |A x - b| smallest; what depends on other columns, to round-off, is 0.
Eigen::VectorXd least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& b);

}  // namespace common
