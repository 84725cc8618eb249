// What all tests with numbers need.
#pragma once

#include <cfenv>
#include <cmath>
#include <cstdlib>
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

/// Where numbers that are not finite are part of a fact: no traps of `make TRAP=1` in this scope, in
/// threads and programs that start in it.
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
