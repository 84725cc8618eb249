// What one core of the machine can do, measured with two small loops, and how much of it a loop
// over particles uses. The benches print it.
#pragma once

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "implicit_moment/simd.hpp"

namespace support {

/// What a loop does for one particle, counted in its code. One flop is a multiplication, an
/// addition, a division, a root, a rounding or a comparison. Bytes are those of particles, read and
/// written; what stays in the cache, the mesh above all, is not counted.
struct Count {
    double flops, bytes;
};

/// Seconds of the fastest of seven calls, of processor time: other programs do not count.
template <class Work>
double fastest(const Work& work) {
    double best = 1e300;
    for (int repeat = 0; repeat < 7; ++repeat) {
        const std::clock_t start = std::clock();
        work();
        best = std::min(best, double(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return best;
}

/// Most multiplications and additions per second: sums s -> a s + b, as many side by side as hide
/// the latency of one.
template <class Real>
double peak_flops() {
    using Vector [[gnu::vector_size(implicit_moment::simd_width * sizeof(double))]] = Real;
    constexpr int strands = 12;
    constexpr long lanes = sizeof(Vector) / sizeof(Real), count = 1000000;
    Vector sum[strands] = {}, a = Vector{} + Real(0.5), b = Vector{} + Real(1);
    const double seconds = fastest([&] {
        for (long n = 0; n < count; ++n)
            for (Vector& s : sum) s = s * a + b;
    });
    for (const Vector& s : sum)
        if (!(s[0] > 1)) std::printf("a sum is lost\n");  // so that the loop is not left out
    return 2 * strands * lanes * count / seconds;
}

/// Bytes per second of a_i = b_i + 3 c_i, three numbers of eight bytes each time, from memory.
inline double triad_bytes() {
    constexpr long count = 1 << 22;
    std::vector<double> a(count), b(count, 1), c(count, 2);
    const double seconds = fastest([&] {
        for (long i = 0; i < count; ++i) a[i] = b[i] + 3 * c[i];
    });
    if (!(a[count - 1] > 1)) std::printf("a sum is lost\n");
    return 24.0 * count / seconds;
}

/// One line for a loop. in: seconds per particle on one core
inline void print_use(const char* loop, double seconds, const Count& count, double peak,
                      double triad) {
    std::printf("%10s %9.2f ns %6.0f flops %6.0f bytes %8.1f%% %8.1f%%\n", loop, 1e9 * seconds,
                count.flops, count.bytes, 100 * count.flops / seconds / peak,
                100 * count.bytes / seconds / triad);
}

/// The head of these lines.
inline void print_limits(double peak, double triad) {
    std::printf(
        "\none core: %.1f Gflop/s multiplying and adding, triad %.1f GB/s; per particle, and of "
        "these\n",
        1e-9 * peak, 1e-9 * triad);
}

}  // namespace support
