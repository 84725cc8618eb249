// What all tests with numbers need.
#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>

namespace facts {

constexpr double eps = std::numeric_limits<double>::epsilon();

inline double real(long n) { return static_cast<double>(n); }

/// The largest of numbers that are not negative; not a number where one of them is not.
inline double worst(std::initializer_list<double> values) {
    double largest = 0;
    for (const double v : values) largest = largest >= v || std::isnan(largest) ? largest : v;
    return largest;
}

}  // namespace facts
