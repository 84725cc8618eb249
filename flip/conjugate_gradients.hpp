// Linear systems A x = b with a symmetric, positive definite A that is known as a function, by
// preconditioned conjugate gradients.
//
//   z = M^-1 r,  p = z + beta p,  x += alpha p,  r -= alpha A p,
//   alpha = r.z / p.Ap,  beta = r.z / (r.z before)
//
// Both quotients can be 0/0: where A or M is singular, not positive, or not finite. Every
// denominator is looked at before it divides.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/gmres.hpp"

namespace flip {

/// Solves A x = b.
/// in:    apply(v, w): w = A v, and precondition(v, w): w = M^-1 v, both symmetric positive definite,
///        on Eigen::VectorXd that never alias; b; x the guess; tolerance on |b - A x| / |b|;
///        max_iterations in all
/// out:   x; the result says whether it may be used
/// exact: converged means |b - A x| <= tolerance |b| for the returned x. And always:
///        b = 0                        x = 0, no iteration, converged
///        guess good enough            x unchanged, no iteration, converged
///        A or M not positive          where it shows, not converged, x the best of the restarts
///        definite
///        not finite: b, guess         at once, not converged; a guess that is not finite becomes 0
///        not finite: A or M^-1        where it shows, not converged, x the best of the restarts
///        b scaled by a power of two   the same bits of x / |b|, unless they under- or overflow
/// source: Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49, 409 (1952).
/// note:   the residual of the recurrence drifts from b - A x by round-off; when it is small enough,
///         b - A x is computed, and if that is not, the iteration starts again from x.
template <class Operator, class Preconditioner>
common::KrylovResult conjugate_gradients(const Operator& apply, const Preconditioner& precondition,
                                         const Eigen::VectorXd& b, Eigen::VectorXd& x,
                                         double tolerance, long max_iterations) {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    // The residual grows by at most the root of the condition number; beyond this, A is singular.
    constexpr double too_far = 1e12;
    if (x.size() != b.size())
        throw std::invalid_argument(
            "conjugate_gradients: the guess must be as long as the right-hand side");
    const double size_b = common::safe_norm(b);
    if (!std::isfinite(size_b)) return {0, unknown, false, "the right-hand side is not finite"};
    if (size_b == 0.0) {
        x.setZero();
        return {0, 0.0, true, "the right-hand side is zero"};
    }
    const double size_x = common::safe_norm(x);
    if (!std::isfinite(size_x)) {
        x.setZero();
        return {0, unknown, false, "the initial guess is not finite"};
    }

    // Everything in units of |b|, or rather of the power of two below it; A is linear.
    const double unit = std::ldexp(1.0, std::ilogb(size_b)), goal = tolerance * (size_b / unit);
    const Eigen::VectorXd b_1 = b / unit;
    Eigen::VectorXd best = x / unit, x_1 = best, r = b_1, p(b.size()), z(b.size()), Ap(b.size());
    if (size_x > 0.0) {
        apply(x_1, Ap);
        r -= Ap;
    }
    double size_r = common::safe_norm(r);
    if (!std::isfinite(size_r)) return {0, unknown, false, "the operator is not finite"};

    common::KrylovResult result{0, size_r * (unit / size_b), size_r <= goal, "converged"};
    while (!result.converged && result.reason == "converged") {
        // Follow the recurrence until its residual is small enough, or something is wrong.
        double along = 0.0, followed = size_r;
        for (bool first = true; !(followed <= goal); first = false) {
            if (result.iterations >= max_iterations) {
                result.reason = "the limit of iterations is reached";
                break;
            }
            precondition(r, z);
            const double along_before = along;
            along = r.dot(z);
            if (!(along > 0.0 && std::isfinite(along))) {
                result.reason = std::isfinite(along) ? "the preconditioner is not positive definite"
                                                     : "the preconditioner is not finite";
                break;
            }
            if (first)
                p = z;
            else
                p = z + (along / along_before) * p;
            apply(p, Ap);
            const double curvature = p.dot(Ap), alpha = curvature > 0.0 ? along / curvature : 0.0;
            if (!(alpha > 0.0 && std::isfinite(alpha))) {
                result.reason = std::isfinite(curvature) ? "the operator is not positive definite"
                                                         : "the operator is not finite";
                break;
            }
            x_1 += alpha * p;
            r -= alpha * Ap;
            followed = common::safe_norm(r);
            ++result.iterations;
            if (!(followed < too_far * size_r)) {
                result.reason = std::isfinite(followed) ? "the operator is singular"
                                                        : "the operator is not finite";
                break;
            }
        }
        // What the residual really is.
        apply(x_1, Ap);
        r = b_1 - Ap;
        const double size_before = size_r, size_now = common::safe_norm(r);
        if (size_now < size_before) {
            best = x_1;
            size_r = size_now;
        }
        result.residual = size_r * (unit / size_b);
        result.converged = size_r <= goal;
        if (!result.converged && result.reason == "converged" && !(size_now < 0.5 * size_before))
            result.reason = "round-off keeps the residual from falling further";
        if (result.converged) result.reason = "converged";
    }
    if (result.iterations > 0) x = unit * best;
    return result;
}

/// The same without a preconditioner.
template <class Operator>
common::KrylovResult conjugate_gradients(const Operator& apply, const Eigen::VectorXd& b,
                                         Eigen::VectorXd& x, double tolerance,
                                         long max_iterations) {
    const auto leave = [](const Eigen::VectorXd& v, Eigen::VectorXd& w) { w = v; };
    return conjugate_gradients(apply, leave, b, x, tolerance, max_iterations);
}

}  // namespace flip
