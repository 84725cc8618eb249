#include "common/least_squares.hpp"

#include <Eigen/QR>

namespace common {

Eigen::VectorXd least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A,
                              const Eigen::VectorXd& b) {
    return A.colPivHouseholderQr().solve(b);
}

}  // namespace common
