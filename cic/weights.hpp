// The shape S of a cloud: which nodes it touches, and how much of it each of them gets.
//
//     ngp   S^(0), nearest grid point     1 node        a point, all of it to one node
//     cic   S^(1), cloud in cell          2 nodes       as wide as a cell: area weighting
//     tsc   S^(2), triangular cloud       3 nodes       a triangle, two cells wide
//
// In two dimensions S is the product of S in x and S in z.
#pragma once

#include <type_traits>

#include "cic/particles.hpp"

namespace cic {

/// Weights of S^(order) at s, a position in cells measured from a node (or, for a field that lives
/// half-way between nodes, from the first such place).
/// in:     s >= -1/2; first = first_at(s), the first place that has a weight; d = s - first, and of
///         order 2, whose weights have a middle, d = s - first - 1
/// out:    the weights of the first place and the next ones
/// exact:  the weights sum to 1 to round-off
template <int order>
struct Weights;

// [weights]
template <>
struct Weights<0> {
    static constexpr int count = 1;
    int first;
    Real S[1];
    static int first_at(Real s) { return int(s + Real(0.5)); }
    Weights(int first_place, Real) : first(first_place), S{1} {}
};

template <>
struct Weights<1> {
    static constexpr int count = 2;
    int first;
    Real S[2];
    static int first_at(Real s) { return int(s + 1) - 1; }
    Weights(int first_place, Real d) : first(first_place), S{1 - d, d} {}
};

// The polynomials of QuadraticWeights of implicit_moment, for single precision, too.
template <>
struct Weights<2> {
    static constexpr int count = 3;
    int first;
    Real S[3];
    static int first_at(Real s) { return int(s + Real(0.5)) - 1; }
    Weights(int first_place, Real d) : first(first_place) {
        const Real half = Real(0.5);
        S[0] = half * (half - d) * (half - d);
        S[1] = Real(0.75) - d * d;
        S[2] = half * (half + d) * (half + d);
    }
};
// [/weights]

/// Where the clouds of up to batch_size particles are along one direction. Found for all of them
/// before the first is used: that loop vectorizes, and memory delivers positions ahead of time.
/// in:     x_p, positions on the mesh; shift, 0 for nodes, -1/2 for the places half-way between
/// out:    [p] gives the weights of particle p
template <int order>
struct Clouds {
    int first[batch_size];
    Real d[batch_size];

    Clouds(const common::Axis& axis, const Real* x_p, long count, Real shift = 0) {
        const Real low = Real(axis.low), per_spacing = Real(1 / axis.spacing());
#pragma omp simd
        for (long p = 0; p < count; ++p) {
            const Real s = (x_p[p] - low) * per_spacing + shift;
            first[p] = Weights<order>::first_at(s);
            d[p] = s - Real(first[p] + order / 2);
        }
    }
    Weights<order> operator[](long p) const { return {first[p], d[p]}; }
};

/// How charge goes to the mesh and the field comes back.
struct Scheme {
    int order = 1;                   // of S: 0 ngp, 1 cic, 2 tsc
    bool energy_conserving = false;  // gather with one order less, from where E is a difference
    int dimensions = 1;
};

/// Calls work(order, dimensions) with both as compile-time constants.
template <class Work>
void with_order_and_dimensions(const Scheme& scheme, const Work& work) {
    const auto with_order = [&](auto dimensions) {
        if (scheme.order == 0) work(std::integral_constant<int, 0>{}, dimensions);
        if (scheme.order == 1) work(std::integral_constant<int, 1>{}, dimensions);
        if (scheme.order == 2) work(std::integral_constant<int, 2>{}, dimensions);
    };
    if (scheme.dimensions == 1) with_order(std::integral_constant<int, 1>{});
    if (scheme.dimensions == 2) with_order(std::integral_constant<int, 2>{});
}

}  // namespace cic
