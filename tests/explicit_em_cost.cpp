// The cost slide in numbers that no clock is needed for.
#include <doctest/doctest.h>

#include <cmath>

#include "implicit_moment/explicit_em/yee_field.hpp"
#include "implicit_moment/setup/check_case.hpp"
#include "implicit_moment/setup/cost.hpp"
#include "implicit_moment/setup/describe_case.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

using namespace implicit_moment;

Case implicit_case() {
    Case w;
    describe(w);
    return w;
}
Case explicit_case() {
    Case w;
    describe_explicit(w);
    return w;
}

// Particle-steps that a case takes for a time of 1/omega_pi.
double particle_steps(const Case& w) { return double(scales_of(w).particles) / w.dt; }

// The explicit case for another mass ratio by its own rule: the same number of cells in d_e, steps
// in 1/omega_pe, and particles per cell.
Case explicit_case_of(double mass_ratio) {
    Case w = explicit_case();
    const double finer = std::sqrt(mass_ratio / w.harris.mass_ratio);
    w.grid.x.cells = std::lround(512 * finer), w.grid.z.cells = std::lround(256 * finer);
    w.dt /= finer;
    w.harris.particles = std::lround(9.12e6 * finer * finer);
    w.harris.mass_ratio = mass_ratio;
    return w;
}

}  // namespace

TEST_CASE("the cost formula has its exponent on the ratio of masses" *
          doctest::description("physics")) {
    CHECK(std::fabs(cost_ratio(25, 2) - 125) <= 1e-12 * 125);
    CHECK(std::fabs(cost_ratio(180, 2) / 2415 - 1) <= 1e-4);
    CHECK(std::fabs(cost_ratio(1836, 2) / 78670 - 1) <= 1e-4);
    CHECK(std::fabs(cost_ratio(1836, 3) / 3.37e6 - 1) <= 1e-3);
    CHECK(cost_ratio(1836, 1) == facts::about(1836));
}

TEST_CASE("the two runs of the cost slide differ by 456 in particle-steps" *
          doctest::description("physics")) {
    CHECK(std::fabs(particle_steps(explicit_case()) / particle_steps(implicit_case()) - 456) <=
          1e-9 * 456);
}

TEST_CASE("the work of explicit runs grows as the cost formula says" *
          doctest::description("physics")) {
    for (const double mass_ratio : {100.0, 400.0, 1600.0}) {
        const double grows =
            particle_steps(explicit_case_of(mass_ratio)) / particle_steps(explicit_case());
        CHECK(std::fabs(grows / (cost_ratio(mass_ratio, 2) / cost_ratio(25, 2)) - 1) <= 1e-6);
    }
}

TEST_CASE("explicit steps of the slide are as near to their limits at every mass ratio" *
          doctest::description("physics")) {
    const Case here = explicit_case();
    for (const double mass_ratio : {100.0, 400.0, 1600.0}) {
        const Case w = explicit_case_of(mass_ratio);
        CHECK(std::fabs(w.dt / courant_limit(w.grid) - here.dt / courant_limit(here.grid)) <=
              1e-12);
        const auto electrons = [](const Case& any) { return scales_of(any).species[1]; };
        CHECK(std::fabs(electrons(w).omega_p_dt / electrons(here).omega_p_dt - 1) <= 1e-12);
        CHECK(std::fabs(electrons(w).debye_length / w.grid.x.spacing() /
                            (electrons(here).debye_length / here.grid.x.spacing()) -
                        std::sqrt(mass_ratio / 25)) <= 1e-9);
    }
}
