// What every run of pic keeps: the same bits for any number of threads and across a restart, with
// particles that come and go; a checkpoint when a signal stops it; refusal of what is damaged or
// foreign or for flip alone; and a sentence with place and time when it fails.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <string>

#include "tests/support/any_fluid_run.hpp"

const std::string facts::program_name = "pic";

namespace {

using namespace facts;

}  // namespace

TEST_CASE("one and two and three threads write the same history of pic" *
          doctest::description("robust")) {
    for (const std::string& arguments : runs_of_both()) check_threads(arguments);
}

TEST_CASE("the effective case of pic runs again to the same bytes of every kind of file" *
          doctest::description("robust")) {
    // Case, history, profile; three snapshots, each fields and particles, and both for ParaView.
    CHECK(check_runs_again(tube) == 3);
    CHECK(check_runs_again(channel + " output.fields_interval=0.08 output.particles_interval=0.08 "
                                     "output.vtk=true") == 2 + 3 * 4);
}

TEST_CASE("a restart of pic goes on with the same bits" * doctest::description("robust")) {
    for (const std::string& arguments : runs_of_both()) check_restart(arguments, 7);
    check_restart(tube + " output.fields_interval=0.02 output.particles_interval=0.02", 10);
}

TEST_CASE("a signal stops pic after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    check_interruption(
        " flip/cases/sod.toml grid.cells_x=40 time.dt=0.001 theory.compare=none "
        "particles.per_cell_x=40",
        0.001, SIGINT, 130);
    check_interruption(
        " flip/cases/rayleigh_taylor.toml grid.cells_x=10 grid.cells_z=20 "
        "theory.compare=none output.particles_interval=0 time.dt=0.01",
        0.01, SIGTERM, 143);
}

TEST_CASE("damaged and cut and foreign checkpoints are refused by pic" *
          doctest::description("robust")) {
    check_bad_checkpoints("flip");
}

TEST_CASE("a run of pic that fails says what and where and when" * doctest::description("robust")) {
    check_sentence(" flip/cases/sod.toml time.dt=0.008",
                   "the internal energy of (left|right), NUMBER, is negative or not finite in the "
                   "cell at x = NUMBER, z = NUMBER at t = NUMBER: use a smaller time.cfl, more "
                   "particles per cell, or more viscosity \\(in step NUMBER\\)");
    const std::string wall =
        "a particle has gone through the wall to x = NUMBER, z = NUMBER at t = NUMBER: reduce "
        "time.cfl \\(in step NUMBER\\)";
    check_sentence(
        over(disk, "theory.compare=none gravity.x=100 boundary.x_low=slip boundary.x_high=slip"),
        wall);
    check_sentence(
        " flip/cases/wall_shock.toml time.dt=0.005 viscosity.linear=0 "
        "viscosity.quadratic=0",
        wall);
    check_sentence(tube + " time.energy_limit=0.99",
                   "the energy is NUMBER where the start and the work done are NUMBER, at step 0, "
                   "t = 0: reduce time.cfl, refine the mesh, or allow more with "
                   "time.energy_limit");
}

TEST_CASE("a full disk ends a run of pic with a sentence and no half of a file" *
          doctest::description("robust")) {
    check_full_disk();
}

TEST_CASE("closed pipes and closed outputs do not stop pic" * doctest::description("robust")) {
    check_closed_pipes();
}

TEST_CASE("force replaces every kind of file of an earlier run of pic" *
          doctest::description("robust")) {
    check_force();
}

TEST_CASE("every range that pic lists is enforced" * doctest::description("robust")) {
    CHECK(check_ranges() >= 60);
}

TEST_CASE("help of pic lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    check_lists();
}

TEST_CASE("unknown keys of pic are refused with a suggestion" * doctest::description("robust")) {
    check_unknown_keys();
}

TEST_CASE("the version of pic is that of the Makefile" * doctest::description("robust")) {
    check_version();
}

TEST_CASE("every shipped case passes a dry run of pic or is for flip" *
          doctest::description("robust")) {
    int described = 0;
    const std::regex beyond(
        "pic: flip\\.[a-z_]+ = \\S+ is beyond pic: run the case with flip, or take it out");
    for (const auto& named : dry_runs_of_shipped_cases()) {
        const auto& outcome = named.second;
        INFO(outcome.err);
        if (outcome.status == 0) {
            CHECK(outcome.sentences.empty());
            ++described;
        } else {
            CHECK(outcome.status == 2);
            REQUIRE(outcome.sentences.size() == 1);
            CHECK(std::regex_match(outcome.sentences[0], beyond));
        }
    }
    CHECK(described >= 10);
}
