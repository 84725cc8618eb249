// Viscosity in whole runs of both programs: a wave that decays, and a block that slides as Coulomb
// says where it would flutter without.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/any_mpm_run.hpp"

namespace {

using namespace facts;

const std::vector<std::string> programs{"mpm_explicit", "mpm_implicit"};

Run run(const std::string& program, const std::string& name, const std::string& arguments,
        int status = 0) {
    return run_mpm(program, name, program + "/cases/" + name + ".toml --threads 1 " + arguments,
                   status);
}

}  // namespace

TEST_CASE("a standing wave decays as the viscosity of its frequency says" *
          doctest::description("physics")) {
    // omega = pi c/L = 11.5: in the run beta omega^2 t/2 = 0.33, and the wave is 0.72 of what it was.
    for (const std::string& program : programs) {
        CAPTURE(program);
        std::vector<double> error;
        for (const int cells : {16, 32})
            error.push_back(run(program, "standing_wave",
                                "material.default.viscosity=0.01 time.alpha=0.2 grid.cells_x=" +
                                    std::to_string(cells) +
                                    " grid.cells_y=" + std::to_string(cells / 4))
                                .value("velocity_error"));
        CHECK(error[1] <= 0.002);
        // The force of leapfrog is of v^0: first order in dt, which viscosity shortens with h^2.
        CHECK(error[1] <= 0.35 * error[0]);
    }
}

TEST_CASE("with viscosity a block slides as Coulomb says up to the angle of friction" *
          doctest::description("physics")) {
    for (const std::string& program : programs)
        for (const char* friction : {"0.1", "0.3", "0.5", "0.55"})
            for (const std::string alpha : {"0.25", "1", "4"}) {
                if (program == "mpm_explicit" && alpha == "4") continue;
                CAPTURE(program);
                CAPTURE(friction);
                CAPTURE(alpha);
                const Run r =
                    run(program, "sliding_block",
                        "contact.friction=" + std::string(friction) + " time.alpha=" + alpha);
                check_results(r, 1);  // acceleration within one per cent
                CHECK(r.value("contact_time_share") == 1);
            }
}

TEST_CASE("without viscosity a block slides faster than Coulomb says in both programs" *
          doctest::description("physics")) {
    for (const std::string& program : programs) {
        const Run r =
            run(program, "sliding_block", "material.default.viscosity=0 theory.tolerance=10");
        CAPTURE(program);
        CHECK(r.value("acceleration") >= 0.75);  // exact: 0.670
    }
}
