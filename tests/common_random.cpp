// Facts about random and evenly spread numbers.
#include <doctest/doctest.h>
#include <gsl/gsl_qrng.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include "common/random.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// The largest difference between the fraction of values below x and x.
double discrepancy(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const double n = double(values.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i)
        largest = facts::worst({largest, std::abs(values[i] - double(i) / n),
                                std::abs(values[i] - double(i + 1) / n)});
    return largest;
}

}  // namespace

TEST_CASE("Philox gives the published answer for the digits of pi") {
    const r123::Philox4x32::ctr_type counter = {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}};
    const r123::Philox4x32::key_type key = {{0xa4093822, 0x299f31d0}};
    const auto words = r123::Philox4x32()(counter, key);
    CHECK(words[0] == 0xd16cfe09);
    CHECK(words[1] == 0x94fdcceb);
    CHECK(words[2] == 0x5001e420);
    CHECK(words[3] == 0x24126ea1);

    // The same counter and key as arguments of uniform().
    const double u =
        common::uniform(0x299f31d0a4093822, 0x13198a2e, 0x85a308d3243f6a88, 0x03707344);
    CHECK(same_bits(u, (double(0x94fdccebd16cfe09 >> 11) + 0.5) * 0x1p-53));
}

TEST_CASE("uniform numbers lie inside the open interval with the right moments") {
    const int n = 200000;
    double sum = 0.0, squares = 0.0, smallest = 1.0, largest = 0.0;
    for (int i = 0; i < n; ++i) {
        const double u = common::uniform(1, 2, i, 0);
        sum += u;
        squares += (u - 0.5) * (u - 0.5);
        smallest = std::min(smallest, u);
        largest = std::max(largest, u);
    }
    CHECK(smallest > 0.0);
    CHECK(largest < 1.0);
    CHECK(std::abs(sum / n - 0.5) <= 4.0 * std::sqrt(1.0 / 12.0 / n));
    CHECK(std::abs(squares / n - 1.0 / 12.0) <= 4.0 * std::sqrt(1.0 / 180.0 / n));
}

TEST_CASE("gaussian numbers have the moments of the normal distribution") {
    const int n = 200000;
    double m1 = 0.0, m2 = 0.0, m3 = 0.0, m4 = 0.0, largest = 0.0;
    for (int i = 0; i < n; ++i) {
        const double g = common::gaussian(11, 0, i, 3);
        m1 += g / n;
        m2 += g * g / n;
        m3 += g * g * g / n;
        m4 += g * g * g * g / n;
        largest = std::max(largest, std::abs(g));
    }
    CHECK(std::abs(m1) <= 4.0 * std::sqrt(1.0 / n));
    CHECK(std::abs(m2 - 1.0) <= 4.0 * std::sqrt(2.0 / n));
    CHECK(std::abs(m3) <= 4.0 * std::sqrt(15.0 / n));
    CHECK(std::abs(m4 - 3.0) <= 4.0 * std::sqrt(96.0 / n));
    CHECK(largest < 8.3);
}

TEST_CASE("a random number does not depend on the order in which numbers are drawn") {
    std::vector<double> forward(1000), backward(1000);
    for (int i = 0; i < 1000; ++i) forward[i] = common::gaussian(5, 1, i, 0);
    for (int i = 999; i >= 0; --i) backward[i] = common::gaussian(5, 1, i, 0);
    for (int i = 0; i < 1000; ++i) CHECK(same_bits(forward[i], backward[i]));
}

TEST_CASE("seed and purpose and particle and draw each give independent numbers") {
    const int n = 100000;
    double correlations[4] = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < n; ++i) {
        const double u = common::uniform(1, 1, i, 1) - 0.5;
        correlations[0] += 12.0 / n * u * (common::uniform(2, 1, i, 1) - 0.5);
        correlations[1] += 12.0 / n * u * (common::uniform(1, 2, i, 1) - 0.5);
        correlations[2] += 12.0 / n * u * (common::uniform(1, 1, i + 1, 1) - 0.5);
        correlations[3] += 12.0 / n * u * (common::uniform(1, 1, i, 2) - 0.5);
    }
    for (const double correlation : correlations)
        CHECK(std::abs(correlation) <= 4.0 / std::sqrt(double(n)));
    CHECK(common::uniform(1, 1, 1, 1) != common::uniform(1ull << 32, 1, 1, 1));
    CHECK(common::uniform(1, 1, 1, 1) != common::uniform(1, 1, 1 + (1ull << 32), 1));
}

TEST_CASE("the radical inverse is the Halton sequence of GSL") {
    gsl_qrng* halton = gsl_qrng_alloc(gsl_qrng_halton, 4);
    const unsigned bases[4] = {2, 3, 5, 7};
    double largest = 0.0, point[4];
    for (int i = 0; i < 5000; ++i) {
        gsl_qrng_get(halton, point);
        for (int d = 0; d < 4; ++d)
            largest =
                facts::worst({largest, std::abs(point[d] - common::radical_inverse(i, bases[d]))});
    }
    gsl_qrng_free(halton);
    CHECK(largest <= 1e-14);
}

TEST_CASE("a full period of the radical inverse holds every fraction once") {
    const int n = 729;
    std::vector<double> values;
    for (int i = 0; i < n - 1; ++i) values.push_back(common::radical_inverse(i, 3));
    std::sort(values.begin(), values.end());
    for (int i = 0; i < n - 1; ++i) CHECK(std::abs(values[i] - double(i + 1) / n) <= 1e-14);
}

TEST_CASE("the radical inverse stays inside the open interval for the largest indices") {
    for (const unsigned base : {2u, 3u, 5u, 7u, 31u})
        for (const std::uint64_t i :
             {std::uint64_t{0}, (std::uint64_t{1} << 53) - 1, (std::uint64_t{1} << 54) - 2}) {
            CHECK(common::radical_inverse(i, base) > 0.0);
            CHECK(common::radical_inverse(i, base) <= 1.0 - 0x1p-53);
        }
}

TEST_CASE("a shifted radical inverse is as even as the plain one and differs with the seed") {
    const int n = 4096;
    for (const unsigned base : {2u, 3u, 5u}) {
        std::vector<double> plain, one, two;
        for (int i = 0; i < n; ++i) {
            plain.push_back(common::radical_inverse(i, base));
            one.push_back(common::shifted_radical_inverse(i, base, 1));
            two.push_back(common::shifted_radical_inverse(i, base, 2));
        }
        CHECK(*std::min_element(one.begin(), one.end()) > 0.0);
        CHECK(*std::max_element(one.begin(), one.end()) < 1.0);
        CHECK(discrepancy(one) <= 2.0 * discrepancy(plain));
        CHECK(discrepancy(one) <= 0.05 * discrepancy({one.begin(), one.begin() + n / 100}));
        CHECK(std::abs(one[0] - two[0]) > 1e-3);
        CHECK(std::abs(std::accumulate(one.begin(), one.end(), 0.0) / n - 0.5) <= 2e-3);
    }
}
