// Which nodes a particle of a grain sees, and how much of each: S_ip and grad S_ip.
#pragma once

#include "mpm_explicit/grid/mesh.hpp"
#include "mpm_explicit/shapes.hpp"

namespace mpm {

/// Where a particle is on the mesh, in cells from node (0, 0).
struct Locator {
    double x_low, y_low, per_h;
    explicit Locator(const Mesh& mesh) : x_low(mesh.x_low), y_low(mesh.y_low), per_h(1 / mesh.h) {}
};

/// Calls work(dof, S_ip, dS_ip/dx, dS_ip/dy) for the nodes that two directions have weights for.
template <class Weights, class Work>
[[gnu::always_inline]] inline void for_each_product(const Weights& w_x, const Weights& w_y,
                                                    const long* origin, const Work& work) {
#pragma GCC unroll 3
    for (int b = 0; b < Weights::width; ++b) {
        const long dof = origin[w_y.first + b] + w_x.first;
#pragma GCC unroll 3
        for (int a = 0; a < Weights::width; ++a)
            work(dof + a, w_x.S[a] * w_y.S[b], w_x.G[a] * w_y.S[b], w_x.S[a] * w_y.G[b]);
    }
}

/// Calls work(dof, S_ip, dS_ip/dx, dS_ip/dy) for the nodes around a particle of one grain.
/// in: origin, GrainNodes::origins of the grain
template <class Shape, class Work>
[[gnu::always_inline]] inline void for_each_node(const Shape& shape, const Locator& at,
                                                 const long* origin, double x, double y,
                                                 const Work& work) {
    for_each_product(shape((x - at.x_low) * at.per_h, at.per_h),
                     shape((y - at.y_low) * at.per_h, at.per_h), origin, work);
}

/// The weights of up to `size` particles in one direction. They are found before the first of them is
/// used: that loop does several particles at once, and one that adds to nodes does not.
template <class Shape>
class BatchWeights {
   public:
    static constexpr long size = 128;

    void find(const Shape& shape, const double* x, double low, double per_h, long count) {
        per_h_ = per_h;
#pragma omp simd
        for (long k = 0; k < count; ++k) {
            const auto w = shape((x[k] - low) * per_h, per_h);
            first_[k] = w.first;
#pragma GCC unroll 3
            for (int a = 0; a < Shape::width; ++a) S_[a][k] = w.S[a], G_[a][k] = w.G[a];
        }
    }
    [[gnu::always_inline]] Weights<Shape::width> operator[](long k) const {
        if constexpr (Shape::width == 2)
            return {first_[k], {1 - S_[1][k], S_[1][k]}, {-per_h_, per_h_}};
        else
            return {first_[k], {S_[0][k], S_[1][k], S_[2][k]}, {G_[0][k], G_[1][k], G_[2][k]}};
    }

   private:
    int first_[size];
    double per_h_, S_[Shape::width][size], G_[Shape::width][size];
};

/// The same in both directions.
template <class Shape>
class Places {
   public:
    static constexpr long size = BatchWeights<Shape>::size;

    /// in: x_p, y_p of count particles
    void find(const Shape& shape, const Locator& at, const double* x_p, const double* y_p,
              long count) {
        x_.find(shape, x_p, at.x_low, at.per_h, count);
        y_.find(shape, y_p, at.y_low, at.per_h, count);
    }
    /// Calls work(dof, S_ip, dS_ip/dx, dS_ip/dy) for the nodes around the k-th of them.
    /// in: origin, GrainNodes::origins of the grain
    template <class Work>
    [[gnu::always_inline]] void for_each_node(long k, const long* origin, const Work& work) const {
        for_each_product(x_[k], y_[k], origin, work);
    }

   private:
    BatchWeights<Shape> x_, y_;
};

/// Calls work(dof, S_ip, x_i - x_p, y_i - y_p) for the nodes around a particle of one grain.
template <class Shape, class Work>
void for_each_link(const Shape& shape, const Locator& at, const long* origin, double x, double y,
                   const Work& work) {
    const double column = (x - at.x_low) * at.per_h, row = (y - at.y_low) * at.per_h,
                 h = 1 / at.per_h;
    const auto w_x = shape(column, at.per_h), w_y = shape(row, at.per_h);
    for (int b = 0; b < Shape::width; ++b)
        for (int a = 0; a < Shape::width; ++a)
            work(origin[w_y.first + b] + w_x.first + a, w_x.S[a] * w_y.S[b],
                 h * (double(w_x.first + a) - column), h * (double(w_y.first + b) - row));
}

}  // namespace mpm
