// Which nodes a particle of a grain sees, and how much of each: S_ip and grad S_ip.
#pragma once

#include "mpm_explicit/grid/mesh.hpp"
#include "mpm_explicit/particles.hpp"
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

/// The shape functions of one particle along x and y.
template <class Shape>
struct OwnShape {
    Shape x, y;
};
/// Those of particle p: gimp averages over the rectangle that it stands for, where particles have sides.
/// exact:  sum_p V_p grad S_ip is the integral over the grain where these tile it, cut or not
template <class Shape>
OwnShape<Shape> own_shape(const Shape& shape, const Particles& particles, std::size_t p) {
    if constexpr (Shape::has_sides)
        if (!particles.half_x_p.empty()) return {{particles.half_x_p[p]}, {particles.half_y_p[p]}};
    return {shape, shape};
}

/// Calls work(dof, S_ip, dS_ip/dx, dS_ip/dy) for the nodes around a particle of one grain.
/// in: own, its shape functions; origin, GrainNodes::origins of the grain
template <class Shape, class Work>
[[gnu::always_inline]] inline void for_each_node(const OwnShape<Shape>& own, const Locator& at,
                                                 const long* origin, double x, double y,
                                                 const Work& work) {
    for_each_product(own.x((x - at.x_low) * at.per_h, at.per_h),
                     own.y((y - at.y_low) * at.per_h, at.per_h), origin, work);
}
/// The same with one shape for all.
template <class Shape, class Work>
[[gnu::always_inline]] inline void for_each_node(const Shape& shape, const Locator& at,
                                                 const long* origin, double x, double y,
                                                 const Work& work) {
    for_each_node(OwnShape<Shape>{shape, shape}, at, origin, x, y, work);
}

/// The weights of up to `size` particles in one direction. They are found before the first of them is
/// used: that loop does several particles at once, and one that adds to nodes does not.
template <class Shape>
class BatchWeights {
   public:
    static constexpr long size = 128;

    /// in: shape(k), that of the k-th of them
    template <class ShapeOf>
    void find(const ShapeOf& shape, const double* x, double low, double per_h, long count) {
        per_h_ = per_h;
#pragma omp simd
        for (long k = 0; k < count; ++k) {
            const auto w = shape(k)((x[k] - low) * per_h, per_h);
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

    /// in: begin, the first of count particles
    void find(const Shape& shape, const Locator& at, const Particles& particles, long begin,
              long count) {
        const double *x_p = particles.x_p.data() + begin, *y_p = particles.y_p.data() + begin;
        if constexpr (Shape::has_sides)
            if (!particles.half_x_p.empty()) {
                const double *half_x = particles.half_x_p.data() + begin,
                             *half_y = particles.half_y_p.data() + begin;
                x_.find([=](long k) { return Shape{half_x[k]}; }, x_p, at.x_low, at.per_h, count);
                y_.find([=](long k) { return Shape{half_y[k]}; }, y_p, at.y_low, at.per_h, count);
                return;
            }
        const auto all_alike = [shape](long) { return shape; };
        x_.find(all_alike, x_p, at.x_low, at.per_h, count);
        y_.find(all_alike, y_p, at.y_low, at.per_h, count);
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
