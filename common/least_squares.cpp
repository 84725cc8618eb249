#include "common/least_squares.hpp"

#include <Eigen/QR>

namespace common {

Eigen::VectorXd least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A,
                              const Eigen::VectorXd& b) {
    return A.colPivHouseholderQr().solve(b);
}

void AndersonAcceleration::next(const Eigen::VectorXd& f, Eigen::VectorXd& x) {
    if (last_f_.size() > 0) {
        if (count_ == 0) dx_.setZero(x.size(), depth), df_ = dx_;
        dx_.col(count_ % depth) = x - last_x_;
        df_.col(count_++ % depth) = f - last_f_;
    }
    last_x_ = x, last_f_ = f;
    x += f;
    const Eigen::Index known = count_ < depth ? count_ : depth;
    if (known > 0)
        x -= (dx_.leftCols(known) + df_.leftCols(known)) * least_squares(df_.leftCols(known), f);
}

}  // namespace common
