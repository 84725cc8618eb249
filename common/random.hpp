// Random numbers that are functions of what they are for, and the evenly spread numbers of quiet
// starts. There is no state: the same arguments give the same number on any thread, in any order.
#pragma once

#include <Random123/philox.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace common {

/// A uniform number in the open interval (0, 1).
///   (floor(u / 2^11) + 1/2) / 2^53, u = 64 bits of Philox4x32-10(counter, key)
/// in:    seed of the run; purpose, e.g. a species times what is drawn; particle; draw, the count
///        of numbers that this particle has drawn for this purpose
/// exact: never 0, never 1, to which the largest would be rounded; depends on the arguments alone
/// source: Salmon, Moraes, Dror and Shaw, Proc. SC11 (2011), 16:1.
inline double uniform(std::uint64_t seed, std::uint32_t purpose, std::uint64_t particle,
                      std::uint32_t draw) {
    using Philox = r123::Philox4x32;
    using Word = std::uint32_t;
    const Philox::ctr_type counter = {{Word(particle), Word(particle >> 32), purpose, draw}};
    const Philox::key_type key = {{Word(seed), Word(seed >> 32)}};
    const Philox::ctr_type words = Philox()(counter, key);
    const std::uint64_t bits = (std::uint64_t{words[1]} << 32) | words[0];
    return std::min((double(bits >> 11) + 0.5) * 0x1p-53, 1 - 0x1p-53);
}

/// A normal number of mean 0 and variance 1, by inverting the distribution function.
/// in:    as uniform()
/// exact: |result| < 8.3
inline double gaussian(std::uint64_t seed, std::uint32_t purpose, std::uint64_t particle,
                       std::uint32_t draw) {
    return gsl_cdf_ugaussian_Pinv(uniform(seed, purpose, particle, draw));
}

/// The digits of i + 1 mirrored at the point: the van der Corput sequence.
///   i + 1 = sum_j d_j base^j  ->  sum_j d_j base^(-j-1)
/// in:    i from 0; base, a prime: another one for each coordinate
/// exact: in (0, 1); the first base^m - 1 values are the multiples of base^-m in some order
/// note:  the index is shifted by one, so that the value is never 0.
inline double radical_inverse(std::uint64_t i, unsigned base) {
    const double digit = 1.0 / base;
    double place = digit, sum = 0.0;
    for (std::uint64_t rest = i + 1; rest > 0; rest /= base) {
        sum += double(rest % base) * place;
        place *= digit;
    }
    return std::min(sum, 1.0 - 0x1p-53);
}

/// The radical inverse moved around the circle by a random amount of its own for each seed and
/// base, so that quiet starts with different seeds differ.
///   fraction of [radical_inverse(i, base) + shift(seed, base)]
/// exact: in (0, 1); as evenly spread as the radical inverse
/// source: Cranley and Patterson, SIAM J. Numer. Anal. 13, 904 (1976).
inline double shifted_radical_inverse(std::uint64_t i, unsigned base, std::uint64_t seed) {
    constexpr std::uint32_t quiet_start = 0x51e7u;
    const double sum = radical_inverse(i, base) + uniform(seed, quiet_start, base, 0);
    const double fraction = sum - std::floor(sum);
    return fraction > 0.0 ? fraction : 0x1p-54;
}

/// Numbers in (0, 1) for loading particles. A quiet start takes radical inverses, each quantity of
/// a species in a prime base of its own: small bases are quietest. Species that share bases differ
/// by a shift. A random start takes uniform().
struct LoadingNumbers {
    bool quiet;
    std::uint64_t seed;
    /// Uniform in (0, 1): the radical inverse in `base` when quiet, else random.
    double uniform(std::uint32_t purpose, unsigned base, long particle) const {
        const auto p = std::uint64_t(particle);
        return quiet ? shifted_radical_inverse(p, base, seed + 1000 * purpose)
                     : common::uniform(seed, purpose, p, base);
    }
    /// Gaussian with mean 0 and variance 1, from the same sequence.
    double gaussian(std::uint32_t purpose, unsigned base, long particle) const {
        return gsl_cdf_ugaussian_Pinv(uniform(purpose, base, particle));
    }
};

}  // namespace common
