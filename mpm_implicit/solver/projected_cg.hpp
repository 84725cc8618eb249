// Projected conjugate gradients: a linear system whose solution satisfies the closed pairs.
//
//     | A  -H^T | | v      |   | b |       A: grain_matrix.hpp, order 2 n for n dofs
//     | H    0  | | lambda | = | h |       H: one row per closed pair and direction, constraints.hpp
//
// Unknowns: v of all nodes, and the velocities V of the grains under force control, which enter as
// v -> v + E V with a diagonal of their own. Residual and direction are projected on the null space of H
// (in y = D^{1/2} v: P = 1 - sum_k q_k q_k^T), so that every iterate satisfies the pairs; lambda
// never appears, and is read off at the end, H^T lambda = A v - b. Without a preconditioner this is
// preconditioning with the diagonal D of A.
//     r = P D^{-1/2} (b - A v),  z = F^{-1} r,  p = z + beta p,
//     alpha = (r.z)/(p.A p),  v += alpha p,  r -= alpha P A p,  beta = (r.z)_new/(r.z)_old
#pragma once

#include <limits>

#include "mpm_implicit/solver/constraints.hpp"

namespace mpm_implicit {

struct CgResult {
    long iterations = 0;
    double residual = 0;  // relative, as the tolerance
    bool converged = false;
};

/// Vectors that are kept between calls, so that only the first one allocates.
struct CgWorkspace {
    Vector r, t, p, q, full, z, s;
    void resize(long size) {
        for (Vector* v : {&r, &t, &p, &q, &full, &z, &s})
            if (v->size() != 2 * size) *v = Vector::Zero(2 * size);
    }
};

/// What the grains under force control add to the system: diagonal theta (m + dt c), right-hand
/// side, velocities.
struct ControlledGrains {
    std::vector<double> diagonal, b, V;
};

inline double dot(const Vector& a, const Vector& b) {
    const double *x = a.data(), *y = b.data();
    return common::sum_over_blocks(
        a.size(),
        [&](long begin, long end) {
            double sum = 0;
#pragma omp simd reduction(+ : sum)
            for (long i = begin; i < end; ++i) sum += x[i] * y[i];
            return sum;
        },
        a.size());
}

/// Solves for v.
/// in:     multiply(x, y): y = A x, symmetric; precondition(t, work): z from t, both in y;
///         constraints, built with scale = D^{-1/2}; b; tolerance on |D^{-1/2} (b - A v)|, projected
///         on the null space of the constraints, over the larger of |D^{-1/2} b| and, with v as given
///         and not projected, |D^{-1/2} (b - A v)|
/// in/out: v and controlled.V, which satisfy the constraints
/// out:    work.r = b - A v, which is -H^T lambda when converged
/// exact:  converged means the residual is that small, or as small as round-off of A v
template <class Multiply, class Precondition>
CgResult projected_cg(const Multiply& multiply, const Precondition& precondition,
                      const Constraints& constraints, const Vector& scale, const Vector& b,
                      double tolerance, long max_iterations, Vector& v,
                      ControlledGrains& controlled, CgWorkspace& work) {
    const std::size_t count = controlled.V.size();
    const long n = v.size();
    std::vector<double> r_V(count), p_V(count), q_V(count), d_V(count);
    constraints.controlled_diagonal(d_V.data());
    for (std::size_t s = 0; s < count; ++s) d_V[s] += controlled.diagonal[s];
    Vector &p = work.p, &full = work.full;
    double *r = work.r.data(), *t = work.t.data();
    const double *q = work.q.data(), *s_D = scale.data();

    double size_r = 0;  // squared, not projected: with the impulses of the pairs
    const auto find_residual = [&] {
        multiply(v, work.q);
        const double* from = b.data();
        common::for_each_block(
            n,
            [&](int, long begin, long end) {
#pragma omp simd
                for (long i = begin; i < end; ++i) r[i] = from[i] - q[i], t[i] = s_D[i] * r[i];
            },
            n);
        size_r = dot(work.t, work.t);
        constraints.project(work.t);
        constraints.controlled_force(work.r, r_V.data());
        for (std::size_t s = 0; s < count; ++s)
            r_V[s] += controlled.b[s] - controlled.diagonal[s] * controlled.V[s];
    };
    const auto size_of = [&] {  // squared, in the measure of 1/D
        double sum = dot(work.t, work.t);
        for (std::size_t s = 0; s < count; ++s) sum += r_V[s] * r_V[s] / d_V[s];
        return sum;
    };

    double size_b = 0, size_v = 0;
    for (std::size_t s = 0; s < count; ++s) size_b += controlled.b[s] * controlled.b[s] / d_V[s];
    size_b += common::sum_over_blocks(n, [&](long begin, long end) {
        double sum = 0;
        for (long i = begin; i < end; ++i) sum += s_D[i] * b[i] * (s_D[i] * b[i]);
        return sum;
    });
    CgResult result;
    find_residual();
    double rho = size_of();
    const double size = std::sqrt(std::max(size_b, size_r));
    constexpr int most_rounds = 4;
    for (int round = 0;; ++round) {
        size_v = common::sum_over_blocks(n, [&](long begin, long end) {
            double sum = 0;
            for (long i = begin; i < end; ++i)
                if (s_D[i] > 0) sum += v[i] / s_D[i] * (v[i] / s_D[i]);
            return sum;
        });
        constexpr double round_off = 8 * std::numeric_limits<double>::epsilon();
        const double goal = std::max(tolerance * size, round_off * std::sqrt(size_v));
        result.residual = size > 0 ? std::sqrt(rho) / size : 0;
        result.converged = std::sqrt(rho) <= goal;
        if (result.converged || result.iterations >= max_iterations || round == most_rounds)
            return result;

        bool first = true;
        double along = 0, along_before = 1;
        // A little more than asked for, as the residual that is followed drifts from the true one.
        while (!(std::sqrt(rho) <= 0.1 * goal) && result.iterations < max_iterations) {
            // z in y = D^{1/2} v: t itself, or better.
            const Vector& better = precondition(work.t, work);
            along = &better == &work.t ? rho : dot(work.t, better);
            for (std::size_t s = 0; s < count && &better != &work.t; ++s)
                along += r_V[s] * r_V[s] / d_V[s];
            const double beta = first ? 0 : along / along_before;
            first = false;
            along_before = along;
            for (std::size_t s = 0; s < count; ++s) p_V[s] = r_V[s] / d_V[s] + beta * p_V[s];
            const double* z = better.data();
            double* to = p.data();
            common::for_each_block(
                n,
                [&](int, long begin, long end) {
#pragma omp simd
                    for (long i = begin; i < end; ++i) to[i] = s_D[i] * z[i] + beta * to[i];
                },
                n);
            if (count > 0) full = p, constraints.add_controlled_motion(p_V.data(), full);
            Vector& direction = count > 0 ? full : p;
            multiply(direction, work.q);
            constraints.controlled_force(work.q, q_V.data());
            double curvature = dot(p, work.q);
            for (std::size_t s = 0; s < count; ++s) {
                q_V[s] += controlled.diagonal[s] * p_V[s];
                curvature += p_V[s] * q_V[s];
            }
            if (!(curvature > 0)) break;
            const double alpha = along / curvature;
            for (std::size_t s = 0; s < count; ++s)
                controlled.V[s] += alpha * p_V[s], r_V[s] -= alpha * q_V[s];
            const double* d = direction.data();
            double* v_now = v.data();
            common::for_each_block(
                n,
                [&](int, long begin, long end) {
#pragma omp simd
                    for (long i = begin; i < end; ++i) {
                        v_now[i] += alpha * d[i], r[i] -= alpha * q[i];
                        t[i] = s_D[i] * r[i];
                    }
                },
                n);
            constraints.project(work.t);
            rho = size_of();
            ++result.iterations;
        }
        find_residual();
        rho = size_of();
    }
}

}  // namespace mpm_implicit
