// Eight numbers that are worked on at once: one AVX-512 register, or two or four smaller ones
// where the machine has those.
#pragma once

#include <cmath>

namespace common {

inline constexpr int simd_width = 8;

/// Eight doubles with +, -, *, / and comparisons per lane; a plain double meets all lanes.
using SimdVector [[gnu::vector_size(simd_width * sizeof(double))]] = double;

/// SimdVector holding from[0], ..., from[count-1]; the lanes beyond count repeat from[0], so that they
/// stay harmless.
inline SimdVector load_simd(const double* from, long count) {
    SimdVector lanes;
    if (count >= simd_width) {
        __builtin_memcpy(&lanes, from, sizeof lanes);
    } else {
        for (int l = 0; l < simd_width; ++l) lanes[l] = from[l < count ? l : 0];
    }
    return lanes;
}

/// Writes the first count lanes.
inline void store_simd(const SimdVector& lanes, double* to, long count) {
    if (count >= simd_width) {
        __builtin_memcpy(to, &lanes, sizeof lanes);
    } else {
        for (int l = 0; l < count; ++l) to[l] = lanes[l];
    }
}

/// 1 in the first count lanes and 0 in the rest.
inline SimdVector first_simd(long count) {
    SimdVector lanes{};
    for (int l = 0; l < simd_width; ++l) lanes[l] = l < count ? 1.0 : 0.0;
    return lanes;
}

/// Sum of the eight lanes, always in the order ((0+4)+(2+6)) + ((1+5)+(3+7)).
inline double simd_sum(const SimdVector& lanes) {
    using Half [[gnu::vector_size(4 * sizeof(double))]] = double;
    using Quarter [[gnu::vector_size(2 * sizeof(double))]] = double;
    const Half half = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3) +
                      __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
    const Quarter quarter =
        __builtin_shufflevector(half, half, 0, 1) + __builtin_shufflevector(half, half, 2, 3);
    return quarter[0] + quarter[1];
}

/// Larger of a and b, lane by lane, the magnitude and the square root; overloads let one formula
/// serve a single number and lanes.
inline SimdVector larger(const SimdVector& a, const SimdVector& b) { return a > b ? a : b; }
/// |a|, component by component.
inline SimdVector magnitude(const SimdVector& a) { return a < 0.0 ? -a : a; }
/// The square root, component by component.
inline SimdVector square_root(const SimdVector& a) {
    SimdVector root;
    for (int l = 0; l < simd_width; ++l) root[l] = std::sqrt(a[l]);
    return root;
}
/// The same for one number, so that a kernel can be written once.
inline double larger(double a, double b) { return a > b ? a : b; }
inline double magnitude(double a) { return std::fabs(a); }
inline double square_root(double a) { return std::sqrt(a); }

/// Largest of the eight lanes; NaN in any lane gives NaN.
inline double simd_max(const SimdVector& lanes) {
    double largest = lanes[0];
    for (int l = 1; l < simd_width; ++l) {
        largest = lanes[l] > largest || lanes[l] != lanes[l] ? lanes[l] : largest;
    }
    return largest;
}
inline double simd_max(double a) { return a; }

}  // namespace common
