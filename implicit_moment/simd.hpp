// Numbers that are worked on at once, as many as one register of the machine holds. Sums over particles
// are taken in this many strands, so that their last digits are those of a kind of machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

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

/// from[0], ..., from[count-1]; the lanes beyond count repeat from[0], so that they stay harmless.
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
    SimdVector lanes;
    for (int l = 0; l < simd_width; ++l) lanes[l] = l < count ? 1 : 0;
    return lanes;
}

/// Sum of the lanes, halves first: of eight ((0+4)+(2+6)) + ((1+5)+(3+7)).
inline double simd_sum(const SimdVector& lanes) {
    double sum[simd_width];
    __builtin_memcpy(sum, &lanes, sizeof lanes);
    for (int half = simd_width / 2; half > 0; half /= 2)
        for (int l = 0; l < half; ++l) sum[l] += sum[l + half];
    return sum[0];
}

/// Larger of a and b, |a| and the square root, lane by lane; the last of one number, too.
inline SimdVector larger(const SimdVector& a, const SimdVector& b) { return a > b ? a : b; }
inline SimdVector magnitude(const SimdVector& a) {
    return SimdVector(SimdMask(a) & std::numeric_limits<std::int64_t>::max());
}
inline SimdVector square_root(const SimdVector& a) {
    SimdVector root;
    for (int l = 0; l < simd_width; ++l) root[l] = std::sqrt(a[l]);
    return root;
}
inline double square_root(double a) { return std::sqrt(a); }

/// Whether a comparison holds in any lane.
inline bool any_simd(const SimdMask& mask) {
    std::int64_t bits[simd_width];
    __builtin_memcpy(bits, &mask, sizeof mask);
    for (int half = simd_width / 2; half > 0; half /= 2)
        for (int l = 0; l < half; ++l) bits[l] |= bits[l + half];
    return bits[0] != 0;
}

}  // namespace implicit_moment
