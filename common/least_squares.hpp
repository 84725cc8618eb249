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
    void next(const Eigen::VectorXd& f, Eigen::VectorXd& x);

   private:
    static constexpr Eigen::Index depth = 8;
    Eigen::Index count_ = 0;
    Eigen::MatrixXd dx_, df_;
    Eigen::VectorXd last_x_, last_f_;
};

}  // namespace common
