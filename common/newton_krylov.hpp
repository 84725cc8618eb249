// Nonlinear systems F(x) = 0 by an inexact Newton method whose linear systems are solved by GMRES
// with the Jacobian known only through differences of F.
//
//   J(x) s = -F(x) to |F + J s| <= eta |F|,   x <- x + lambda s
//   J(x) v = [F(x + h v) - F(x)] / h
//
// The forcing term eta follows the convergence of F, so that early steps are cheap and late ones
// converge fast; lambda <= 1 is reduced until |F| falls.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "common/gmres.hpp"

namespace common {

struct NewtonResult {
    int newton_iterations = 0;  // steps taken
    int linear_iterations = 0;  // Krylov iterations in all steps
    double residual = 0.0;      // |F(x)| / scale of the returned x
    bool converged = false;
    std::string reason;  // how it ended, as a phrase for a message
};

struct NewtonOptions {
    int restart = 30;                // largest Krylov space
    double size_of_x = 1.0;          // |x| counts as at least this in the difference step h
    double first_forcing = 0.1;      // eta of the first step
    double largest_forcing = 0.9;    // bounds of eta; below the lower one the error of the
    double smallest_forcing = 1e-5;  // differences would show
    int max_halvings = 12;           // times that the line search shortens a step
    // F is the gradient of something convex, or nearly so, and may have kinks: a step s is shortened where
    // s.F(x + s) > |s.F(x)|/2, even if |F| falls, unless it falls to a tenth; else it is taken.
    bool convex = false;
};

/// What Newton keeps between calls, so that only the first call allocates the long arrays.
struct NewtonWorkspace {
    GmresWorkspace linear;
    Eigen::VectorXd F, F_trial, x_trial, step, minus_F;
};

namespace newton_detail {

/// The forcing term of the next linear system, second choice of Eisenstat and Walker.
///   eta = 0.9 (|F_k| / |F_k-1|)^2, not below 0.9 eta_k-1^2 while that exceeds 0.1,
///   and not below half of goal/|F_k|, which reaches the tolerance
inline double forcing(double eta_before, double size, double size_before, double goal,
                      const NewtonOptions& options) {
    const double ratio = size / size_before;
    double eta = 0.9 * ratio * ratio;
    const double memory = 0.9 * eta_before * eta_before;
    if (memory > 0.1) eta = std::max(eta, memory);
    eta = std::max({eta, 0.5 * goal / size, options.smallest_forcing});
    return std::min(eta, options.largest_forcing);
}

/// The fraction of a step to try after `fraction` of it gave |F| = size_trial.
/// The minimum of the parabola through |F|^2 at 0 and `fraction` with the slope of the linear model
/// at 0, kept within [0.1, 0.5] of the fraction that failed.
inline double shorter_fraction(double fraction, double size, double size_trial, double eta) {
    const double slope = -2.0 * (1.0 - eta) * size * size;
    const double excess = size_trial * size_trial - size * size - slope * fraction;
    const double best = -slope * fraction * fraction / (2.0 * excess);
    if (!std::isfinite(best)) return 0.1 * fraction;
    return std::clamp(best, 0.1 * fraction, 0.5 * fraction);
}

}  // namespace newton_detail

/// Solves F(x) = 0.
/// in:    residual(x, F); precondition(v, w): w = M^-1 v with M near the Jacobian; x the guess;
///        scale, the |F| that counts as 1; tolerance on |F| / scale; max_newton steps of at most
///        max_linear Krylov iterations each
/// out:   x; the result says whether it may be used
/// exact: converged means |F(x)| <= tolerance scale for the returned x. And always:
///        guess good enough           x unchanged, no step, converged
///        F of the guess not finite   at once, not converged, x unchanged, whatever the scale
///        F of a trial not finite     counts as too large: the step is shortened
///        no step reduces |F|         not converged, x the best found
/// source: Eisenstat and Walker, SIAM J. Sci. Comput. 17, 16 (1996); Knoll and Keyes, J. Comput.
///         Phys. 193, 357 (2004).
template <class Residual, class Preconditioner>
NewtonResult newton_krylov(const Residual& residual, const Preconditioner& precondition,
                           Eigen::VectorXd& x, double scale, double tolerance, int max_newton,
                           int max_linear, NewtonWorkspace& work,
                           const NewtonOptions& options = {}) {
    if (scale <= 0.0) throw std::invalid_argument("newton_krylov: the scale must be positive");
    constexpr double unknown = std::numeric_limits<double>::infinity();
    constexpr double root_of_epsilon = 1.4901161193847656e-8;  // 2^-26
    for (auto* v : {&work.F, &work.F_trial, &work.x_trial, &work.step, &work.minus_F})
        v->resize(x.size());

    residual(x, work.F);
    double size = safe_norm(work.F);
    if (!std::isfinite(size))
        return {0, 0, unknown, false, "the residual of the initial guess is not finite"};

    // The Jacobian times v, from one more residual.
    double size_of_x = 0.0;
    const auto jacobian = [&](const Eigen::VectorXd& v, Eigen::VectorXd& Jv) {
        const double size_v = safe_norm(v);
        if (size_v == 0.0) {
            Jv.setZero();
            return;
        }
        const double h = root_of_epsilon * size_of_x / size_v;
        work.x_trial = x + h * v;
        residual(work.x_trial, work.F_trial);
        Jv = (work.F_trial - work.F) / h;
    };

    const double goal = tolerance * scale;
    double eta = options.first_forcing;
    NewtonResult result{0, 0, size / scale, size <= goal, "converged"};
    while (!result.converged && result.newton_iterations < max_newton) {
        // Solve for the step.
        size_of_x = std::max(safe_norm(x), options.size_of_x);
        work.minus_F = -work.F;
        work.step.setZero();
        const KrylovResult linear = gmres(jacobian, precondition, work.minus_F, work.step, eta,
                                          max_linear, options.restart, work.linear);
        result.linear_iterations += linear.iterations;
        if (!(linear.residual < 1.0)) {
            result.reason = "the linear system has no solution: " + linear.reason;
            return result;
        }
        const double reached = std::max(eta, linear.residual);

        // Shorten the step until the residual falls.
        double fraction = 1.0, size_trial = unknown;
        int halvings = 0;
        for (; halvings <= options.max_halvings; ++halvings) {
            work.x_trial = x + fraction * work.step;
            residual(work.x_trial, work.F_trial);
            size_trial = safe_norm(work.F_trial);
            if (options.convex && std::isfinite(size_trial)) {
                const double slope = work.step.dot(work.F), now = work.step.dot(work.F_trial);
                if (now <= -0.5 * slope || size_trial <= 0.1 * size) break;
                fraction *= std::clamp(slope / (slope - now), 0.1, 0.7);
                continue;
            }
            if (size_trial <= (1.0 - 1e-4 * fraction * (1.0 - reached)) * size) break;
            fraction = newton_detail::shorter_fraction(fraction, size, size_trial, reached);
        }
        if (halvings > options.max_halvings) {
            result.reason = "no step along the Newton direction reduces the residual";
            return result;
        }

        // Take it.
        x.swap(work.x_trial);
        work.F.swap(work.F_trial);
        eta = newton_detail::forcing(eta, size_trial, size, goal, options);
        size = size_trial;
        ++result.newton_iterations;
        result.residual = size / scale;
        result.converged = size <= goal;
    }
    if (!result.converged) result.reason = "the limit of Newton steps is reached";
    return result;
}

}  // namespace common
