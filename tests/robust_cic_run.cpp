// What every run of cic keeps: the same bits for any number of threads and across a restart, with
// particles that come and go at walls; a checkpoint when a signal stops it; and a sentence and a
// summary when it blows up.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "tests/support/any_run.hpp"

const std::string facts::program_name = "cic";

namespace {

using namespace facts;

// Two beams on a line and in the plane, where particles are sorted every 25 steps.
const std::string streams =
    " cic/cases/two_stream.toml species.right.particles_per_cell=16 "
    "species.left.particles_per_cell=16";
const std::string plane =
    " cic/cases/two_stream_2d.toml grid.cells_x=32 grid.cells_z=16 species.right.loading=random "
    "species.left.temperature_x=0.01 species.left.loading=quiet";
// A source and an absorbing wall, both floating.
const std::string sheath = " cic/cases/sheath.toml time.dt=0.4 grid.cells_x=48 grid.length_x=12";
// A layer between grounded walls that its field drives apart, against a weak magnetic field.
const std::string layer =
    " cic/cases/diocotron.toml theory.compare=none plasma.B_y=0.3 grid.cells_x=32 "
    "grid.cells_z=32 species.electrons.particles_per_cell=16 species.electrons.half_width=7 "
    "species.electrons.start=drift";

// A magnetized box with a source, an absorbing wall and two mirrors.
const std::string box =
    plane +
    " theory.compare=none grid.boundary_x=wall grid.boundary_z=wall boundary.potential_x_high=1 "
    "boundary.particles_x_low=source boundary.particles_z_low=reflect "
    "boundary.particles_z_high=reflect "
    "plasma.B_y=0.2 species.right.amplitude=0 species.left.amplitude=0 "
    "species.right.emission=0.3 species.left.emission=0.1";

// All runs that differ in what they call: 1 and 2 dimensions, both schemes, all weightings, a
// magnetic field, walls.
std::vector<std::string> runs() {
    return {streams + " time.end=2",
            streams + " time.end=2 method.scheme=energy method.weighting=tsc",
            streams + " time.end=2 method.weighting=ngp plasma.B_z=0.5 theory.compare=none",
            plane + " time.end=4",
            plane + " time.end=4 method.scheme=energy method.stencil=nine_point",
            plane + " time.end=4 method.weighting=tsc method.sort_interval=1",
            sheath + " time.end=16",
            layer + " time.end=4",
            box + " time.end=4 method.weighting=tsc"};
}

// Whether a column of a history changes.
bool changes(const std::string& out, const std::string& name) {
    std::ifstream file(out + "/history.dat");
    std::string words;
    std::getline(file, words);
    const std::size_t end = words.find(":" + name + "[");
    REQUIRE(end != std::string::npos);
    const std::size_t begin = words.rfind(' ', end) + 1;
    const int column = std::stoi(words.substr(begin, end - begin));
    std::set<double> values;
    while (std::getline(file, words)) {
        std::istringstream row(words);
        double value = 0;
        for (int k = 0; k < column; ++k) row >> value;
        values.insert(value);
    }
    return values.size() > 1;
}

}  // namespace

TEST_CASE("one and two and three threads write the same history of cic" *
          doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_threads(arguments);
}

TEST_CASE("the effective case of cic runs again to the same bytes of every kind of file" *
          doctest::description("robust")) {
    // Four snapshots, each fields, particles, phase and velocities; two more for ParaView.
    const std::string often =
        " time.end=4 output.fields_interval=1 output.particles_interval=1 output.phase_interval=1";
    CHECK(check_runs_again(streams + often) == 4 * 4 + 2);
    CHECK(check_runs_again(sheath + often) == 4 * 4 + 2);
    CHECK(check_runs_again(box + often + " output.vtk=true") == 4 * 6 + 2);
    // And the spectrum.
    CHECK(check_runs_again(plane + " time.end=4 output.modes=4 output.spectrum=true") == 5);
}

TEST_CASE("a restart of cic goes on with the same bits" * doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_restart(arguments, 10);
    check_restart(box +
                      " time.end=4 output.fields_interval=0.4 output.particles_interval=0.4 "
                      "output.phase_interval=0.4",
                  20);
}

TEST_CASE("walls take and give particles in the runs that are repeated" *
          doctest::description("robust")) {
    const std::string out = folder("counts");
    REQUIRE(run(sheath + " time.end=16", out) == 0);
    CHECK(changes(out, "count_electrons"));
    CHECK(changes(out, "charge_x_high"));
    REQUIRE(run(layer + " time.end=4 --force", out) == 0);
    CHECK(changes(out, "count_electrons"));
    REQUIRE(run(box + " time.end=4 --force", out) == 0);
    CHECK(changes(out, "count_right"));
}

TEST_CASE("a signal stops cic after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    check_interruption(sheath, 0.4, SIGINT, 130);
    check_interruption(plane, 0.1, SIGTERM, 143);
}

TEST_CASE("a checkpoint of another program or of nothing is refused by cic" *
          doctest::description("robust")) {
    const std::string file = room() + "/foreign.bin", out = folder("foreign");
    const auto refused = [&](const common::ProgramInfo& info, const std::string& reason) {
        common::CheckpointWriter(info, file, "", "").finish();
        CHECK(run(" --restart " + file, out) == 2);
        INFO(said(out));
        CHECK(holds(said(out), reason));
        CHECK(!fs::exists(out));
    };
    refused({"implicit_moment", PROGRAM_VERSION, "", ""}, "of 'implicit_moment', not of 'cic'");
    refused({"cic", PROGRAM_VERSION, "", ""}, "ends too early");
}

TEST_CASE("a run of cic that blows up says when and leaves a summary" *
          doctest::description("robust")) {
    check_failure(
        " cic/cases/landau.toml time.dt=1.9 time.end=800 species.electrons.amplitude=0.5 "
        "species.electrons.temperature_x=0.1 species.electrons.particles_per_cell=100",
        ": reduce time.dt, refine the mesh, or allow more with time.energy_limit");
    // From mirror to mirror and beyond.
    check_failure(box + " boundary.potential_z_high=1e9",
                  "a particle moves farther than the box in one step, at step");
}

TEST_CASE("the energy of round-off stops no run" * doctest::description("robust")) {
    // Electrons at rest on a lattice have no energy but that, and it grows.
    const std::string out = folder("at_rest");
    CHECK(run(" cic/cases/two_stream.toml species.right.drift_x=0 species.left.drift_x=0 "
              "species.right.amplitude=0 species.left.amplitude=0 theory.compare=none "
              "species.right.loading=quiet species.left.loading=quiet "
              "output.phase_interval=0 output.particles_interval=0",
              out) == 0);
    CHECK(changes(out, "energy"));
}

TEST_CASE("force replaces every kind of file of an earlier run of cic" *
          doctest::description("robust")) {
    const std::string out = folder("replaced");
    REQUIRE(run(plane + " time.end=1.5 output.fields_interval=0.5 output.particles_interval=0.5 "
                        "output.phase_interval=0.5 output.vtk=true output.modes=2 "
                        "output.spectrum=true output.checkpoint_steps=5",
                out) == 0);
    CHECK(fs::exists(out + "/velocities_000005.dat"));
    CHECK(fs::exists(out + "/spectrum.dat"));
    write_all(out + "/phase_of_the_moon.txt", "waning");
    REQUIRE(run(plane + " time.end=1 output.fields_interval=0 output.particles_interval=0 --force",
                out) == 0);
    CHECK(content(out).size() == 4);
    CHECK(read_all(out + "/phase_of_the_moon.txt") == "waning");
}
