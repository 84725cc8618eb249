// Least squares, compiled once: Eigen's decompositions take longer to compile than a step.
#pragma once

#include <Eigen/Core>

namespace common {

/// The x that makes |A x - b| smallest; what depends on other columns, to round-off, is 0.
Eigen::VectorXd least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& b);

/// Anderson's acceleration of x <- x + f(x): of the last few x + f the combination whose f is smallest,
///   x + f - sum_j gamma_j d(x + f)_j,  the gamma_j that make |f - sum_j gamma_j df_j| smallest
/// source: D. G. Anderson, J. ACM 12, 547 (1965)
class AndersonAcceleration {
   public:
    /// in: f, what x lacks by the plain iteration. in/out: x, the next guess
    void next(const Eigen::VectorXd& f, Eigen::VectorXd& x) {
        if (last_f_.size() > 0) {
            if (count_ == 0) dx_.setZero(x.size(), depth), df_ = dx_;
            dx_.col(count_ % depth) = x - last_x_;
            df_.col(count_++ % depth) = f - last_f_;
        }
        last_x_ = x, last_f_ = f;
        x += f;
        if (const Eigen::Index known = count_ < depth ? count_ : depth; known > 0)
            x -= (dx_ + df_).leftCols(known) * least_squares(df_.leftCols(known), f);
    }

   private:
    static constexpr Eigen::Index depth = 8;
    Eigen::Index count_ = 0;
    Eigen::MatrixXd dx_, df_;
    Eigen::VectorXd last_x_, last_f_;
};

}  // namespace common
