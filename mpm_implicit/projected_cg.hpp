// Conjugate gradients in the space of velocities that the closed pairs allow.
//
// It solves  A v = b + H^T lambda,  H v = h  for v, and for the velocities V of plates that forces
// drive; H are the rows of constraints.hpp. Residual and direction are projected, so that every
// iterate obeys the pairs; lambda never appears. In y = D^{1/2} v the preconditioner is the diagonal.
#pragma once

#include <limits>

#include "mpm_implicit/constraints.hpp"

namespace mpm_implicit {

struct CgResult {
    long iterations = 0;
    double residual = 0;  // of what was asked for
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

/// What the plates add to the system: diagonal theta (m + dt c), right-hand side, velocities.
struct PlateSystem {
    std::vector<double> diagonal, b, V;
};

inline double dot(const Vector& a, const Vector& b) {
    return common::sum_over_blocks(a.size(), [&](long begin, long end) {
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (long i = begin; i < end; ++i) sum += a[i] * b[i];
        return sum;
    });
}

/// in:     multiply(x, y): y = A x, symmetric; constraints, built with scale = D^{-1/2}; b; tolerance
///         on |D^{-1/2} (b - A v)| without what the pairs forbid, over |D^{-1/2} b|
/// in/out: v and plates.V, which obey the constraints
/// out:    work.r = b - A v, which is -H^T lambda when converged
/// exact:  converged means the residual is that small, or as small as round-off of A v
template <class Multiply, class Precondition>
CgResult projected_cg(const Multiply& multiply, const Precondition& precondition,
                      const Constraints& constraints, const Vector& scale, const Vector& b,
                      double tolerance, long most_iterations, Vector& v, PlateSystem& plates,
                      CgWorkspace& work) {
    const std::size_t count = plates.V.size();
    std::vector<double> r_V(count), z_V(count), p_V(count), q_V(count), d_V(count);
    constraints.plates_weigh(d_V.data());
    for (std::size_t s = 0; s < count; ++s) d_V[s] += plates.diagonal[s];
    Vector &r = work.r, &t = work.t, &p = work.p, &q = work.q, &full = work.full;

    double size_r = 0;  // with the impulses of the pairs
    const auto find_residual = [&] {
        multiply(v, q);
        common::for_each_block(r.size(), [&](int, long begin, long end) {
            for (long i = begin; i < end; ++i) r[i] = b[i] - q[i], t[i] = scale[i] * r[i];
        });
        size_r = dot(t, t);
        constraints.project(t);
        constraints.plates_feel(r, r_V.data());
        for (std::size_t s = 0; s < count; ++s)
            r_V[s] += plates.b[s] - plates.diagonal[s] * plates.V[s];
    };
    const auto size_of = [&] {  // squared, in the measure of 1/D
        double sum = dot(t, t);
        for (std::size_t s = 0; s < count; ++s) sum += r_V[s] * r_V[s] / d_V[s];
        return sum;
    };

    double size_b = 0, size_v = 0;
    for (std::size_t s = 0; s < count; ++s) size_b += plates.b[s] * plates.b[s] / d_V[s];
    size_b += common::sum_over_blocks(b.size(), [&](long begin, long end) {
        double sum = 0;
        for (long i = begin; i < end; ++i) sum += scale[i] * b[i] * (scale[i] * b[i]);
        return sum;
    });
    CgResult result;
    find_residual();
    double rho = size_of();
    const double size = std::sqrt(std::max(size_b, size_r));
    constexpr int most_rounds = 4;
    for (int round = 0;; ++round) {
        size_v = common::sum_over_blocks(v.size(), [&](long begin, long end) {
            double sum = 0;
            for (long i = begin; i < end; ++i)
                if (scale[i] > 0) sum += v[i] / scale[i] * (v[i] / scale[i]);
            return sum;
        });
        constexpr double round_off = 8 * std::numeric_limits<double>::epsilon();
        const double goal = std::max(tolerance * size, round_off * std::sqrt(size_v));
        result.residual = size > 0 ? std::sqrt(rho) / size : 0;
        result.converged = std::sqrt(rho) <= goal;
        if (result.converged || result.iterations >= most_iterations || round == most_rounds)
            return result;

        bool first = true;
        double along = 0, along_before = 1;
        // A little more than asked for, as the residual that is followed drifts from the true one.
        while (!(std::sqrt(rho) <= 0.1 * goal) && result.iterations < most_iterations) {
            // z in y = D^{1/2} v: as t, or better.
            const Vector& z = precondition(t, work);
            along = dot(t, z);
            for (std::size_t s = 0; s < count; ++s) along += r_V[s] * r_V[s] / d_V[s];
            const double beta = first ? 0 : along / along_before;
            first = false;
            along_before = along;
            for (std::size_t s = 0; s < count; ++s) p_V[s] = r_V[s] / d_V[s] + beta * p_V[s];
            common::for_each_block(p.size(), [&](int, long begin, long end) {
#pragma omp simd
                for (long i = begin; i < end; ++i) p[i] = scale[i] * z[i] + beta * p[i];
            });
            Vector* direction = &p;
            if (count > 0) {
                full = p, direction = &full;
                constraints.add_plates(p_V.data(), full);
            }
            multiply(*direction, q);
            constraints.plates_feel(q, q_V.data());
            double curvature = dot(p, q);
            for (std::size_t s = 0; s < count; ++s) {
                q_V[s] += plates.diagonal[s] * p_V[s];
                curvature += p_V[s] * q_V[s];
            }
            if (!(curvature > 0)) break;
            const double alpha = along / curvature;
            for (std::size_t s = 0; s < count; ++s)
                plates.V[s] += alpha * p_V[s], r_V[s] -= alpha * q_V[s];
            common::for_each_block(v.size(), [&](int, long begin, long end) {
                const Vector& d = *direction;
#pragma omp simd
                for (long i = begin; i < end; ++i) {
                    v[i] += alpha * d[i], r[i] -= alpha * q[i];
                    t[i] = scale[i] * r[i];
                }
            });
            constraints.project(t);
            rho = size_of();
            ++result.iterations;
        }
        find_residual();
        rho = size_of();
    }
}

}  // namespace mpm_implicit
