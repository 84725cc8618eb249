// What every run of flip keeps: the same bits for any number of threads and across a restart, with
// either pressure, every transfer, and particles that come and go, split and merge; a checkpoint
// when a signal stops it; refusal of what is damaged or foreign; and a sentence with place and time
// when it fails.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/any_fluid_run.hpp"

const std::string facts::program_name = "flip";

namespace {

using namespace facts;

const std::string implicit = " viscosity.linear=0 viscosity.quadratic=0 flip.pressure=implicit";
const std::string vortex =
    " flip/cases/gresho.toml grid.cells_x=12 grid.cells_z=12 time.end=0.3 "
    "region.gas.pressure=70.92857142857143";
const std::string
    rezoned = " rezone.steps=5 rezone.min_particles=5 rezone.max_particles=10",
    vortex_rezoned =
        vortex +
        " flip.density=cells rezone.steps=5 rezone.min_particles=10 rezone.max_particles=20";
const std::string held =
    layers +
    " boundary.z_low=no_slip boundary.z_high=no_slip boundary.slide_z_high=0.5 "
    "flip.viscosity=0.01";

// All that differ in what they call.
std::vector<std::string> runs() {
    std::vector<std::string> all = runs_of_both();
    for (const char* transfer : {"pic", "blend", "apic", "xpic"})
        for (const std::string& flow : {channel, disk})
            all.push_back(flow + " flip.transfer=" + transfer);
    const std::vector<std::string> more{tube + " flip.mass=consistent",
                                        channel + " flip.density=particles",
                                        channel + implicit,
                                        disk + rezoned,
                                        channel +
                                            " flip.density=particles flip.transfer=xpic "
                                            "flip.deficit_to_heat=false" +
                                            rezoned,
                                        vortex,
                                        vortex + " flip.transfer=apic",
                                        vortex_rezoned,
                                        held,
                                        held + implicit};
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

}  // namespace

TEST_CASE("one and two and three threads write the same history of flip" *
          doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_threads(arguments);
}

TEST_CASE("the runs of flip that are repeated flow in and out and split and merge and iterate" *
          doctest::description("robust")) {
    const std::string out = folder("events");
    const auto mass = [&](const std::string& arguments) {
        REQUIRE(run(arguments + " --force", out) == 0);
        return column(out, "mass");
    };
    const auto particles = [&](const std::string& arguments) {
        REQUIRE(run(arguments + " --force", out) == 0);
        return summary(out)["performance"]["particles"].get<double>();
    };
    CHECK(mass(wind).back() > 1.1 * mass(wind).front());
    const std::vector<double> in_channel = mass(channel), in_void = mass(disk);
    // What comes in leaves at the other end.
    CHECK(in_channel.back() != in_channel.front());
    CHECK(std::fabs(in_channel.back() / in_channel.front() - 1) <= 0.1);
    CHECK(in_void.back() < 0.99 * in_void.front());
    CHECK(particles(disk + rezoned) != particles(disk));
    CHECK(particles(vortex_rezoned) != particles(vortex));
    REQUIRE(run(vortex + " --force", out) == 0);
    CHECK(column(out, "iterations").back() > 1);
    REQUIRE(run(channel + implicit + " --force", out) == 0);
    CHECK(column(out, "iterations").back() > 1);
}

TEST_CASE("the effective case of flip runs again to the same bytes of every kind of file" *
          doctest::description("robust")) {
    // Case, history, profile; three snapshots, each fields and particles, and both for ParaView.
    CHECK(check_runs_again(tube) == 3);
    CHECK(check_runs_again(vortex + " output.fields_interval=0.12 output.particles_interval=0.12 "
                                    "output.vtk=true") == 3 + 3 * 4);
    CHECK(check_runs_again(channel + rezoned + " output.particles_interval=0.08") == 2 + 3);
}

TEST_CASE("a restart of flip goes on with the same bits" * doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_restart(arguments, 7);
    check_restart(vortex + " output.fields_interval=0.05 output.particles_interval=0.05", 5);
}

TEST_CASE("a signal stops flip after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    check_interruption(
        " flip/cases/sod.toml grid.cells_x=40 time.dt=0.001 theory.compare=none "
        "particles.per_cell_x=40",
        0.001, SIGINT, 130);
    check_interruption(
        " flip/cases/gresho.toml grid.cells_x=24 grid.cells_z=24 time.dt=0.01 theory.compare=none "
        "region.gas.pressure=70.92857142857143",
        0.01, SIGTERM, 143);
}

TEST_CASE("damaged and cut and foreign checkpoints are refused by flip" *
          doctest::description("robust")) {
    check_bad_checkpoints("pic");
}

TEST_CASE("a run of flip that fails says what and where and when" *
          doctest::description("robust")) {
    const std::string negative =
        "density or internal energy is negative in the cell at x = NUMBER, z = NUMBER at t = "
        "NUMBER: reduce time.cfl, raise viscosity.linear, or take more particles per cell \\(in "
        "step NUMBER\\)";
    check_sentence(tube + " time.cfl=1 viscosity.linear=20", negative);
    check_sentence(tube + " left.velocity=20 right.velocity=-20 time.cfl=1", negative);
    // A disk that falls upon a wall in steps that are too long.
    check_sentence(
        over(disk, "theory.compare=none gravity.x=100 boundary.x_low=slip boundary.x_high=slip"),
        "a particle has gone through the wall to x = NUMBER, z = NUMBER at t = NUMBER: "
        "reduce time.cfl \\(in step NUMBER\\)");
    check_sentence(vortex + " flip.max_iterations=1",
                   "the implicit pressure has not converged: the limit of iterations is reached; "
                   "after 1 iterations the residual is NUMBER and not NUMBER; raise "
                   "flip.max_iterations or reduce time.cfl \\(in "
                   "step 0\\)");
    check_sentence(tube + " time.energy_limit=0.99",
                   "the energy is NUMBER where the start and the work done are NUMBER, at step 0, "
                   "t = 0: reduce time.cfl, refine the mesh, or allow more with "
                   "time.energy_limit");
}

TEST_CASE("what gravity has given does not count against the energy limit of flip" *
          doctest::description("robust")) {
    // A cold disk falls and has a thousand times the energy of its start.
    const std::string out = folder("fall");
    CHECK(run(over(disk,
                   "theory.compare=none region.disk.speed=0.01 gravity.trap=0 gravity.x=0 "
                   "gravity.z=-0.3 region.disk.radius=0.1 region.disk.center_z=0.2"),
              out) == 0);
    INFO(said(out));
    CHECK(column(out, "energy").back() > 1000 * column(out, "energy").front());
}

TEST_CASE("a full disk ends a run of flip with a sentence and no half of a file" *
          doctest::description("robust")) {
    check_full_disk();
}

TEST_CASE("closed pipes and closed outputs do not stop flip" * doctest::description("robust")) {
    check_closed_pipes();
}

TEST_CASE("force replaces every kind of file of an earlier run of flip" *
          doctest::description("robust")) {
    check_force();
}

TEST_CASE("every range that flip lists is enforced" * doctest::description("robust")) {
    CHECK(check_ranges() >= 60);
}

TEST_CASE("help of flip lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    check_lists();
}

TEST_CASE("unknown keys of flip are refused with a suggestion" * doctest::description("robust")) {
    check_unknown_keys();
}

TEST_CASE("the version of flip is that of the Makefile" * doctest::description("robust")) {
    check_version();
}

TEST_CASE("every shipped case of flip passes a dry run" * doctest::description("robust")) {
    const auto outcomes = dry_runs_of_shipped_cases();
    CHECK(outcomes.size() >= 18);
    for (const auto& named : outcomes) {
        const auto& outcome = named.second;
        INFO(outcome.err);
        CAPTURE(outcome.out);
        CHECK(outcome.status == 0);
        CHECK(outcome.sentences.empty());
    }
}
