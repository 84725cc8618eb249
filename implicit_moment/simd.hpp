// Numbers that are worked on at once, as many as one register of the machine holds. Sums over particles
// are taken in this many strands, so that their last digits are those of a kind of machine.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <utility>

#include "implicit_moment/units.hpp"

namespace implicit_moment {

#if defined __AVX512F__
inline constexpr int simd_width = 8;
#elif defined __AVX__
inline constexpr int simd_width = 4;
#else
inline constexpr int simd_width = 2;
#endif

/// So many doubles with +, -, *, / and comparisons per lane; a plain double meets all lanes.
using SimdVector [[gnu::vector_size(simd_width * sizeof(double))]] = double;
using SimdMask [[gnu::vector_size(simd_width * sizeof(double))]] = std::int64_t;  // of a comparison
/// A register of what particles carry: of floats twice as many.
using ParticleVector [[gnu::vector_size(simd_width * sizeof(double))]] = ParticleReal;

namespace detail {
template <class Real>
struct LaneOf {
    using Number = std::remove_cvref_t<decltype(std::declval<Real&>()[0])>;
};
template <std::floating_point Real>
struct LaneOf<Real> {
    using Number = Real;
};
}  // namespace detail

/// The number in each lane of a vector; of a number itself.
template <class Real>
using NumberOf = typename detail::LaneOf<Real>::Number;
template <class Vector>
inline constexpr int lanes_of = int(sizeof(Vector) / sizeof(NumberOf<Vector>));

/// from[0], ..., from[count-1]; the lanes beyond count repeat from[0], so that they stay harmless.
template <class Vector = SimdVector, class Number>
inline Vector load_simd(const Number* from, long count) {
    Vector lanes;
    if (std::same_as<Number, NumberOf<Vector>> && count >= lanes_of<Vector>) {
        __builtin_memcpy(&lanes, from, sizeof lanes);
    } else {
        for (int l = 0; l < lanes_of<Vector>; ++l) lanes[l] = from[l < count ? l : 0];
    }
    return lanes;
}

/// Writes the first count lanes.
template <class Vector, class Number>
inline void store_simd(const Vector& lanes, Number* to, long count) {
    if (std::same_as<Number, NumberOf<Vector>> && count >= lanes_of<Vector>) {
        __builtin_memcpy(to, &lanes, sizeof lanes);
    } else {
        for (int l = 0; l < lanes_of<Vector> && l < count; ++l) to[l] = Number(lanes[l]);
    }
}

/// 1 in the first count lanes and 0 in the rest.
template <class Vector = SimdVector>
inline Vector first_simd(long count) {
    Vector lanes;
    for (int l = 0; l < lanes_of<Vector>; ++l) lanes[l] = l < count ? 1 : 0;
    return lanes;
}

/// Sum of the lanes, halves first: of eight ((0+4)+(2+6)) + ((1+5)+(3+7)). Of one number, itself.
template <class Vector>
inline double simd_sum(const Vector& lanes) {
    double sum[lanes_of<Vector>];
    for (int l = 0; l < lanes_of<Vector>; ++l) sum[l] = lanes[l];
    for (int half = lanes_of<Vector> / 2; half > 0; half /= 2)
        for (int l = 0; l < half; ++l) sum[l] += sum[l + half];
    return sum[0];
}
inline double simd_sum(double number) { return number; }

/// Larger of a and b, |a| and the square root, lane by lane; the last of one number, too.
inline SimdVector larger(const SimdVector& a, const SimdVector& b) { return a > b ? a : b; }
inline SimdVector magnitude(const SimdVector& a) {
    return SimdVector(SimdMask(a) & std::numeric_limits<std::int64_t>::max());
}
template <class Vector>
inline Vector square_root(const Vector& a) {
    Vector root;
    for (int l = 0; l < lanes_of<Vector>; ++l) root[l] = std::sqrt(a[l]);
    return root;
}
inline double square_root(double a) { return std::sqrt(a); }

/// Whether a comparison holds in any lane.
template <class Mask>
inline bool any_simd(const Mask& mask) {
    std::int64_t bits[simd_width];
    __builtin_memcpy(bits, &mask, sizeof mask);
    for (int half = simd_width / 2; half > 0; half /= 2)
        for (int l = 0; l < half; ++l) bits[l] |= bits[l + half];
    return bits[0] != 0;
}

}  // namespace implicit_moment
