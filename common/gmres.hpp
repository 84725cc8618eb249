// Linear systems A x = b by restarted, right-preconditioned, flexible GMRES, for operators that are
// only known as a function.
//
//   in the Krylov space of A M^-1, K_k = span{r, (A M^-1) r, ..., (A M^-1)^(k-1) r}, r = b - A x,
//   find u with the smallest |r - A M^-1 u| and add M^-1 u to x
//
// Flexible: the vectors M^-1 v_k are kept, and x is made from them as they are. M^-1 may then
// differ from one product to the next, or be worked out in single precision, and the solution still
// has the full one.
//
// The basis of K_k is orthonormalized by classical Gram-Schmidt, done twice, which is as stable as
// the modified form and runs at the speed of matrix-vector products. Sums over rows are taken in pieces
// that the vector alone fixes, so that the result does not depend on the number of threads.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/parallel.hpp"

namespace common {

struct KrylovResult {
    int iterations = 0;     // products with A that enlarged a Krylov space
    double residual = 0.0;  // |b - A x| / |b| of the returned x, computed from x itself
    bool converged = false;
    std::string reason;  // how it ended, as a phrase for a message
};

/// What GMRES keeps between calls, so that only the first call allocates the long arrays.
struct GmresWorkspace {
    Eigen::MatrixXd basis;                        // orthonormal v_0 .. v_restart, one per column
    std::vector<Eigen::VectorXd> preconditioned;  // M^-1 v_0 .. M^-1 v_restart-1
    Eigen::MatrixXd hessenberg;  // A M^-1 V_k = V_k+1 H, turned into triangular R as it grows
    std::vector<Eigen::JacobiRotation<double>> rotations;  // which make H triangular
    Eigen::VectorXd projected;  // rotated right-hand side |r| e_1; its last entry is the residual
    Eigen::VectorXd y, overlap;
    Eigen::MatrixXd partial;  // sums over the rows of a piece, one per column
    Eigen::VectorXd r, w, x_before;
    double operator_size = 0.0;  // largest |A M^-1 v| seen for a unit vector v
    int components = 1;          // of a vector field, stored one behind the other
};

/// |v| that neither overflows nor underflows. in: |v|^2, where it is known
inline double safe_norm(const Eigen::VectorXd& v, double squared) {
    if (squared > 1e-280 && squared < 1e280) return std::sqrt(squared);
    const double largest = v.size() == 0 ? 0.0 : v.cwiseAbs().maxCoeff();
    if (largest == 0.0) return v.array().isNaN().any() ? v.sum() : 0.0;
    return largest * (v / largest).norm();
}
inline double safe_norm(const Eigen::VectorXd& v) { return safe_norm(v, v.squaredNorm()); }

namespace gmres_detail {

/// What is smaller than this, relative to what it was made from, is round-off.
constexpr double negligible = 1e-14;

enum class Growth { grown, complete, dependent, not_finite };

/// Gives every array of the workspace its size: n unknowns, at most `restart` basis vectors.
inline void prepare(GmresWorkspace& work, Eigen::Index n, int restart) {
    work.basis.resize(n, restart + 1);
    work.preconditioned.resize(std::size_t(restart));
    work.hessenberg.resize(restart + 1, restart);
    work.rotations.resize(std::size_t(restart));
    work.projected.resize(restart + 1);
    for (auto& v : work.preconditioned) v.resize(n);
    for (auto* v : {&work.r, &work.w, &work.x_before}) v->resize(n);
    work.operator_size = 0.0;
}

/// How a vector of n rows is cut: each of its components into parts of a length that stays in the cache, and
/// the same part of all components one after another.
struct Parts {
    static constexpr Eigen::Index rows = 512;
    Eigen::Index components, length;  // of one component

    Parts(const GmresWorkspace& work, Eigen::Index n)
        : components(n % work.components == 0 ? work.components : 1), length(n / components) {}
    Eigen::Index count() const { return components * ((length + rows - 1) / rows); }

    /// Calls work(part, its first row, its rows) for all of them.
    template <class Work>
    void for_each(const Work& work) const {
        const auto do_part = [&](long part) {
            const Eigen::Index first = part / components * rows;
            work(part, part % components * length + first, std::min(rows, length - first));
        };
        for_each_piece(count(), do_part, components * length);
    }
};

/// Takes out of w its part in the span of the first k basis vectors, twice.
///   h = V^T w;  w <- w - V h;  h' = V^T w;  w <- w - V h'
/// in:    work.basis (n x k used), work.w
/// out:   work.w orthogonal to the basis; work.overlap = h + h'; |w| before and after
inline std::array<double, 2> orthogonalize(GmresWorkspace& work, Eigen::Index k) {
    const Parts parts(work, work.w.size());
    work.partial.setZero(k + 1, parts.count());
    // Takes V h from w, where there is an h, and adds up V^T w, where that is asked for, and |w|^2.
    const auto sweep = [&](const Eigen::VectorXd& h, bool sums) -> Eigen::VectorXd {
        parts.for_each([&](long part, Eigen::Index first, Eigen::Index rows) {
            const auto V = work.basis.block(first, 0, rows, k);
            auto w = work.w.segment(first, rows);
            if (h.size() > 0) w.noalias() -= V * h.head(k);
            if (sums) work.partial.col(part).head(k).noalias() = V.transpose() * w;
            work.partial(k, part) = w.squaredNorm();
        });
        return work.partial.rowwise().sum();
    };
    const Eigen::VectorXd h = sweep({}, true);
    const double before = safe_norm(work.w, h[k]);
    const Eigen::VectorXd again = sweep(h, true), left = sweep(again, false);
    work.overlap = (h + again).head(k);
    return {before, safe_norm(work.w, left[k])};
}

/// Makes column k of the Hessenberg matrix triangular, and rotates the right-hand side with it.
inline void rotate_column(GmresWorkspace& work, Eigen::Index k) {
    auto column = work.hessenberg.col(k);
    for (Eigen::Index i = 0; i < k; ++i)
        column.applyOnTheLeft(i, i + 1, work.rotations[std::size_t(i)].adjoint());
    auto& rotation = work.rotations[std::size_t(k)];
    rotation.makeGivens(column[k], column[k + 1]);
    work.projected[k + 1] = 0;
    column.applyOnTheLeft(k, k + 1, rotation.adjoint());
    work.projected.applyOnTheLeft(k, k + 1, rotation.adjoint());
    column[k + 1] = 0;
}

/// Adds A M^-1 v_k to the Krylov space.
/// in:    work.w = v_k, also column k of work.basis
/// out:   column k of R; work.w = v_k+1, also column k + 1 of work.basis
/// exact: `complete` when the space is invariant, so that it holds the solution (lucky breakdown);
///        `dependent` when column k of R is zero, so that A is singular on the space.
template <class Operator, class Preconditioner>
Growth grow(const Operator& apply, const Preconditioner& precondition, GmresWorkspace& work,
            Eigen::Index k) {
    Eigen::VectorXd& z = work.preconditioned[std::size_t(k)];
    precondition(work.w, z);
    apply(z, work.w);
    const auto [before, left] = orthogonalize(work, k + 1);
    if (!std::isfinite(before)) return Growth::not_finite;
    work.operator_size = std::max(work.operator_size, before);
    const double length = left > negligible * before ? left : 0.0;
    work.hessenberg.col(k).head(k + 1) = work.overlap.head(k + 1);
    work.hessenberg(k + 1, k) = length;
    rotate_column(work, k);
    if (!(work.hessenberg(k, k) > negligible * work.operator_size)) return Growth::dependent;
    if (length == 0.0) return Growth::complete;
    Parts(work, work.w.size()).for_each([&](long, Eigen::Index row, Eigen::Index rows) {
        work.w.segment(row, rows) /= length;
        work.basis.col(k + 1).segment(row, rows) = work.w.segment(row, rows);
    });
    return Growth::grown;
}

/// Finds the best correction in the space of k basis vectors, or of fewer where the last ones make
/// R so nearly singular that A times the correction would be round-off.
///   R y = projected
/// out:   work.y; the number of basis vectors it uses
inline Eigen::Index find_correction(GmresWorkspace& work, Eigen::Index k, double size_r) {
    for (; k > 0; --k) {
        work.y = work.projected.head(k);
        work.hessenberg.topLeftCorner(k, k).triangularView<Eigen::Upper>().solveInPlace(work.y);
        if (work.y.stableNorm() * work.operator_size * negligible <= size_r) break;
    }
    return k;
}

/// r = b - A x, and its norm.
template <class Operator>
double find_residual(const Operator& apply, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                     Eigen::VectorXd& r) {
    apply(x, r);
    r = b - r;
    return safe_norm(r);
}

}  // namespace gmres_detail

/// Solves A x = b.
/// in:    apply(v, w): w = A v, and precondition(v, w): w = M^-1 v, on Eigen::VectorXd that never
///        alias; b; x the guess; tolerance on |b - A x| / |b|; max_iterations in all; restart, the
///        largest size of a Krylov space (n * (2 restart + 1) numbers of memory)
/// out:   x; the result says whether it may be used
/// exact: converged means |b - A x| <= tolerance |b| for the returned x. And always:
///        b = 0                        x = 0, no iteration, converged
///        guess good enough            x unchanged, no iteration, converged
///        lucky breakdown              converged
///        no convergence               x the best found, its true residual, not converged
///        singular or zero operator    the same unless b can be reached; x is finite
///        not finite: b, guess         at once, not converged; a guess that is not finite becomes 0
///        not finite: A or M^-1        at once, not converged, x the best before it
/// source: Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 856 (1986); flexible: Saad, SIAM J. Sci.
///         Comput. 14, 461 (1993).
template <class Operator, class Preconditioner>
KrylovResult gmres(const Operator& apply, const Preconditioner& precondition,
                   const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance,
                   int max_iterations, int restart, GmresWorkspace& work) {
    using gmres_detail::Growth;
    constexpr double unknown = std::numeric_limits<double>::infinity();
    if (x.size() != b.size() || restart < 1)
        throw std::invalid_argument(
            "gmres: the guess must be as long as the right-hand side, and restart at least 1");
    restart = std::min(restart, std::max(max_iterations, 1));
    gmres_detail::prepare(work, b.size(), restart);

    const double size_b = safe_norm(b);
    if (!std::isfinite(size_b)) return {0, unknown, false, "the right-hand side is not finite"};
    if (size_b == 0.0) {
        x.setZero();
        return {0, 0.0, true, "the right-hand side is zero"};
    }
    const double size_x = safe_norm(x);
    if (!std::isfinite(size_x)) {
        x.setZero();
        return {0, unknown, false, "the initial guess is not finite"};
    }

    // Start from the guess; a zero guess needs no product with A.
    if (size_x == 0.0) work.r = b;
    double size_r = size_x == 0.0 ? size_b : gmres_detail::find_residual(apply, b, x, work.r);
    if (!std::isfinite(size_r)) return {0, unknown, false, "the operator is not finite"};

    KrylovResult result{0, size_r / size_b, size_r <= tolerance * size_b, "converged"};
    while (!result.converged && result.iterations < max_iterations) {
        // Start a Krylov space from the residual.
        work.w = work.r / size_r;
        work.basis.col(0) = work.w;
        work.projected[0] = size_r;

        // Enlarge it until it holds a good enough solution.
        Growth growth = Growth::grown;
        Eigen::Index k = 0;
        while (growth == Growth::grown && k < restart && result.iterations < max_iterations &&
               !(std::abs(work.projected[k]) <= tolerance * size_b)) {
            growth = gmres_detail::grow(apply, precondition, work, k);
            ++result.iterations;
            if (growth == Growth::grown || growth == Growth::complete) ++k;
        }

        // Add the correction if it is one.
        work.x_before = x;
        const double size_before = size_r;
        const Eigen::Index used = gmres_detail::find_correction(work, k, size_r);
        if (used < k) growth = Growth::dependent;
        if (used > 0) {
            for (Eigen::Index i = 0; i < used; ++i)
                x += work.y[i] * work.preconditioned[std::size_t(i)];
            size_r = gmres_detail::find_residual(apply, b, x, work.r);
        }
        const bool finite = std::isfinite(size_r) && growth != Growth::not_finite;
        if (!(size_r <= size_before)) {
            x = work.x_before;
            size_r = size_before;
        }
        result.residual = size_r / size_b;
        result.converged = size_r <= tolerance * size_b;
        if (result.converged) break;

        // Give up where another space would bring nothing.
        const char* reason = !finite ? "the operator or the preconditioner is not finite"
                             : growth == Growth::dependent ? "the operator is singular"
                             : size_r < (1.0 - 1e-9) * size_before
                                 ? nullptr
                                 : "no progress in a whole Krylov space";
        if (reason != nullptr) return {result.iterations, result.residual, false, reason};
    }
    if (!result.converged) result.reason = "the limit of iterations is reached";
    return result;
}

}  // namespace common
