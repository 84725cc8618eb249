// What all tests with numbers need.
#pragma once

#include <doctest/doctest.h>

#include <cfenv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <random>

namespace facts {

constexpr double eps = std::numeric_limits<double>::epsilon();

inline double real(long n) { return double(n); }

/// A number to compare with to a part of its size; doctest's own adds 1 to the size, and lets every small
/// number pass. 0 is only about 0.
inline doctest::Approx about(double value) {
    return doctest::Approx(value).scale(std::numeric_limits<double>::min());
}

/// The largest of numbers that are not negative; not a number where one of them is not.
inline double worst(std::initializer_list<double> values) {
    double largest = 0;
    for (const double v : values) largest = largest >= v || std::isnan(largest) ? largest : v;
    return largest;
}

/// Numbers in [0, 1), and between two ends.
struct UnitRandom {
    std::mt19937_64 engine;
    explicit UnitRandom(std::uint64_t seed = 1) : engine(seed) {}
    double operator()() { return 0x1p-53 * double(engine() >> 11); }
    double operator()(double low, double high) { return low + (high - low) * (*this)(); }
};

/// Gauss's rule of three points on each of many panels.
template <class Function>
double integral(const Function& f, double low, double high, int panels = 2000) {
    const double h = (high - low) / panels, aside = 0.5 * h * std::sqrt(0.6);
    double sum = 0.0;
    for (int n = 0; n < panels; ++n) {
        const double middle = low + (n + 0.5) * h;
        sum += 5.0 * f(middle - aside) + 8.0 * f(middle) + 5.0 * f(middle + aside);
    }
    return sum * h / 18.0;
}

/// Where numbers that are not finite are part of a fact: no traps of `make TRAP=1` in this scope,
/// in threads and programs that start in it.
class Untrapped {
   public:
    Untrapped() {
        std::feholdexcept(&before_);
        setenv("UNTRAPPED", "1", 1);
    }
    ~Untrapped() {
        unsetenv("UNTRAPPED");
        std::fesetenv(&before_);
    }
    Untrapped(const Untrapped&) = delete;
    Untrapped& operator=(const Untrapped&) = delete;

   private:
    std::fenv_t before_{};
};

}  // namespace facts
