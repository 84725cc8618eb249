// What every run of mpm_implicit keeps: the same bits for any number of threads and across a restart,
// in the middle of a collision, by both solvers; a sentence when its solvers do not get there; and
// what is refused or warned of by this program alone. What it shares with mpm_explicit is in
// robust_mpm_input.cpp and robust_mpm_run.cpp.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "tests/support/any_run.hpp"

const std::string facts::program_name = "mpm_implicit";

namespace {

using namespace facts;

const std::string newton = " solver.kind=newton_krylov";
// Two disks that meet at t = 0.1, off their line of centers, and rub on each other to the end.
const std::string rebound =
    " mpm_implicit/cases/rebound.toml theory.compare=none grid.cells_x=24 grid.cells_y=12 "
    "grain.left.x=0.39 grain.left.y=0.35 grain.left.velocity_y=0.1 grain.right.x=0.81 "
    "contact.friction=0.2 time.end=0.3";
const std::string no_files = " output.particles_interval=0 output.fringes_interval=0";
// Grains between rough plates, on a periodic mesh whose ends they cross, with sorts in between.
const std::string shear =
    " mpm_explicit/cases/shear.toml output.history_steps=1 grid.cells_x=25 grid.cells_y=23 "
    "time.alpha=1 output.pixels_per_cell=1 pack.top.velocity_x=2 pack.disk.shear_rate=2.8 "
    "material.default.E=1e6 time.end=0.04" +
    no_files;
// Two halves of a bar whose bond breaks at t = 0.7.
const std::string bonded =
    " mpm_implicit/cases/bonded_bar.toml theory.compare=none bond.joint.tension=0.3 time.alpha=1 "
    "time.end=6";
// A disk between two plates, of which a force drives one.
const std::string press =
    " mpm_implicit/cases/diametral_disk.toml theory.compare=none grid.cells_x=20 grid.cells_y=20 "
    "grid.particles_per_side=2 load.rise=0.04 time.end=0.4" +
    no_files;
// A disk that yields at a wall.
const std::string yielding =
    " mpm_implicit/cases/yielding_disk.toml theory.compare=none grid.cells_x=12 grid.cells_y=12 "
    "grain.disk.x=0.22 time.end=0.4";
const std::string wave = " mpm_implicit/cases/standing_wave.toml theory.compare=none time.alpha=1";

// All runs that differ in what they call: solvers, masses, laws, plates, bonds, meshes, shapes.
std::vector<std::string> runs() {
    return {rebound,
            rebound + newton,
            rebound + " method.mass=lumped method.shape=gimp method.theta=0.6",
            rebound + newton + " method.volumes=updated method.flip=0.95",
            rebound + " solver.preconditioner=diagonal method.shape=quadratic",
            shear,
            shear + newton,
            bonded,
            bonded + newton,
            press,
            press + newton,
            yielding,
            wave + " time.end=0.3 method.frozen=true"};
}

std::string shipped(const std::string& name) {
    return read_all("mpm_implicit/cases/" + name + ".toml");
}

}  // namespace

TEST_CASE("one and two and three threads write the same history of mpm_implicit" *
          doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_threads(arguments);
}

TEST_CASE("the runs of mpm_implicit that are repeated press and rub and break and yield" *
          doctest::description("robust")) {
    const std::string out = folder("events");
    const auto last = [&](const std::string& name) { return column(out, name).back(); };
    for (const std::string& solver : {std::string(), newton}) {
        REQUIRE(run(rebound + solver + " --force", out) == 0);
        CHECK(last("contact_force") > 0);
        CHECK(last("friction") < -1e-2 * last("energy"));
        REQUIRE(run(shear + solver + " --force", out) == 0);
        CHECK(last("contacts") > 50);
        CHECK(last("friction") < -1e-2 * last("energy"));
        // The top plates have moved by more than their distance to the end of the mesh.
        CHECK(last("travel_x_top_g0005") > 0.07);
        REQUIRE(run(bonded + solver + " --force", out) == 0);
        CHECK(last("broken_bonds") == 1);
        CHECK(column(out, "broken_bonds")[3] == 0);
        CHECK(column(out, "bond_normal_1")[3] > 0);
        REQUIRE(run(press + solver + " --force", out) == 0);
        CHECK(last("travel_y_top") < 0);
        CHECK(last("force_y_top") > 10);
    }
    REQUIRE(run(yielding + " --force", out) == 0);
    CHECK(last("plastic") > 0);
}

TEST_CASE("the effective case of mpm_implicit runs again to the same bytes" *
          doctest::description("robust")) {
    // Three snapshots, each particles and grains and fringes; and case, history, pack.
    CHECK(check_runs_again(rebound + newton +
                           " output.particles_interval=0.133 output.grains_interval=0.133 "
                           "output.fringes_interval=0.133 output.pixels_per_cell=2 "
                           "output.pack=true") == 3 * 3 + 3);
    CHECK(check_runs_again(press + " method.theta=0.7 solver.tolerance=1e-12 "
                                   "solver.preconditioner=diagonal method.mass=lumped") == 2);
}

TEST_CASE("a restart of mpm_implicit in a collision goes on with the same bits" *
          doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_restart(arguments, 9);
}

TEST_CASE("a restart of mpm_implicit goes on wherever its checkpoint was written" *
          doctest::description("robust")) {
    // Before and while the disks press, before and after a sort, before and after a bond breaks.
    const std::string whole = folder("from_whole"), part = folder("from_part"),
                      rest = folder("from_rest");
    for (const std::string& arguments : {rebound, rebound + newton, shear, bonded, press}) {
        CAPTURE(arguments);
        REQUIRE(run(arguments + " --force", whole) == 0);
        const long steps = static_cast<long>(column(whole, "time").size()) - 1;
        for (long stop = 3; 2 * stop <= steps; stop += steps / 9) {
            CAPTURE(stop);
            const std::string often = " output.checkpoint_steps=" + std::to_string(stop);
            REQUIRE(run(arguments + often + " --force", part) == 0);
            const auto kept = checkpoints(part);
            REQUIRE(kept.size() == 2);
            REQUIRE(run(" --restart " + kept[0] + " --threads 1 --force", rest) == 0);
            CHECK(read_all(part + "/history.dat") == read_all(whole + "/history.dat"));
            CHECK(read_all(rest + "/history.dat") == read_all(whole + "/history.dat"));
        }
    }
}

TEST_CASE("a signal stops mpm_implicit after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    // dt = alpha h/(c_p + |v|), c_p^2 = (lambda + 2G)/density = 1.346 E/density for nu = 0.3.
    const auto dt = [](double alpha, double h, double E, double v) {
        return alpha * h / (std::sqrt(0.7 / (1.3 * 0.4) * E / 1000) + v);
    };
    const std::string slow_shear =
        " mpm_explicit/cases/shear.toml output.history_steps=1 grid.cells_x=25 grid.cells_y=23 "
        "output.pixels_per_cell=1 time.alpha=1";
    check_interruption(slow_shear, dt(1, 0.04, 1e5, 0.2), SIGINT, 130);
    check_interruption(wave, dt(1, 1.0 / 32, 1e4, 1e-4), SIGTERM, 143);
}

TEST_CASE("a checkpoint of mpm_explicit is refused by mpm_implicit" *
          doctest::description("robust")) {
    const std::string file = room() + "/foreign.bin", out = folder("foreign");
    fs::create_directories(room());
    common::CheckpointWriter({"mpm_explicit", PROGRAM_VERSION, "", ""}, file, "", "").finish();
    CHECK(run(" --restart " + file, out) == 2);
    INFO(said(out));
    CHECK(holds(said(out), "of 'mpm_explicit', not of 'mpm_implicit'"));
    CHECK(!fs::exists(out));
}

TEST_CASE("what cannot change on a restart of mpm_implicit is refused" *
          doctest::description("robust")) {
    const std::string first = folder("unchanged"), second = folder("changed");
    REQUIRE(run(rebound + " output.checkpoint_steps=9", first) == 0);
    const std::string file = checkpoints(first).front();
    for (const std::string change :
         {"method.theta=1", "method.mass=lumped", "method.volumes=updated",
          "solver.kind=newton_krylov", "solver.tolerance=1e-9", "time.alpha=2"}) {
        CAPTURE(change);
        CHECK(run(" --restart " + file + " " + change, second) == 2);
        const std::string name = change.substr(0, change.find('='));
        CHECK(holds(said(second), name + "' cannot change on a restart; start a new run with it"));
        CHECK(!fs::exists(second));
    }
}

TEST_CASE("a solver of mpm_implicit that does not get there says with whom and how far it was" *
          doctest::description("robust")) {
    const std::string pair = "grain 'left' and grain 'right'", lumped = " method.mass=lumped";
    check_failure(rebound + " solver.max_iterations=1",
                  "the velocities of the nodes are not found in 1 iterations: residual ");
    check_failure(
        rebound + newton + " solver.max_iterations=1",
        "the velocities of the nodes before the step are not found in 1 iterations: residual ");
    check_failure(rebound + lumped + " solver.max_iterations=1 solver.preconditioner=diagonal",
                  "the velocities of the nodes are not found in 1 iterations: residual ");
    check_failure(rebound + " solver.max_outer_iterations=1",
                  "contact did not settle in 1 loops: " + pair);
    check_failure(rebound + " solver.max_outer_iterations=1",
                  "reduce time.alpha, or raise solver.max_outer_iterations");
    check_failure(rebound + newton + " solver.max_outer_iterations=1",
                  "Newton's iteration did not converge: ");
    check_failure(rebound + newton + " solver.max_outer_iterations=1",
                  "hardest pressed are " + pair);
    check_failure(rebound + newton + " solver.max_outer_iterations=1", "residual ");
}

TEST_CASE("a grain of mpm_implicit that leaves the mesh is named with place and time" *
          doctest::description("robust")) {
    check_failure(rebound + " grain.left.velocity_x=-3",
                  "a particle of grain 'left' has left the mesh at (");
}

TEST_CASE("schemes and solvers of mpm_implicit that do not go together are refused" *
          doctest::description("robust")) {
    const std::string disks = shipped("rebound"), bar = shipped("vibrating_bar"),
                      billet = shipped("billet");
    const std::string need =
        "theory.compare = \"billet\" needs one upright box between two rigid "
        "plates without friction, of which one moves along y";
    const std::string knows =
        "theory.compare = \"billet\" knows what is elastic, and what has law = \"j2\" and "
        "hardening = 0: change [material.default]";
    check_refused({
        {"small theta", disks, "method.theta=0.4",
         "'method.theta' = 0.4 is out of range; allowed: 0.5 ... 1"},
        {"large theta", disks, "method.theta=1.1",
         "'method.theta' = 1.1 is out of range; allowed: 0.5 ... 1"},
        {"unknown mass", disks, "method.mass=diagonal",
         "'method.mass' = \"diagonal\" is not one of \"consistent\", \"lumped\""},
        {"unknown volumes", disks, "method.volumes=frozen",
         "'method.volumes' = \"frozen\" is not one of \"kept\", \"updated\""},
        {"unknown solver", disks, "solver.kind=gmres",
         "'solver.kind' = \"gmres\" is not one of \"projected_cg\", \"newton_krylov\""},
        {"unknown preconditioner", disks, "solver.preconditioner=none",
         "'solver.preconditioner' = \"none\" is not one of"},
        {"no tolerance", disks, "solver.tolerance=0",
         "'solver.tolerance' = 0 is out of range; allowed: 1e-15 ... 0.001"},
        {"coarse tolerance", disks, "solver.tolerance=0.1",
         "'solver.tolerance' = 0.1 is out of range; allowed: 1e-15 ... 0.001"},
        {"no iteration", disks, "solver.max_iterations=0",
         "'solver.max_iterations' = 0 is out of range; allowed: 1 ... 1e+06"},
        {"no loop", disks, "solver.max_outer_iterations=0",
         "'solver.max_outer_iterations' = 0 is out of range; allowed: 1 ... 1000"},
        {"half a loop", disks, "solver.max_outer_iterations=1.5",
         "'solver.max_outer_iterations' takes a whole number, not 1.5"},
        {"plastic disks and cg", disks, "material.default.law=j2",
         "[material.default] can yield, and solver.kind = \"projected_cg\" is for elastic grains: "
         "set solver.kind = \"newton_krylov\""},
        {"sand and cg", disks, "material.default.law=drucker_prager",
         "[material.default] can yield, and solver.kind = \"projected_cg\""},
        {"growing volumes and cg", disks, "method.volumes=updated",
         "method.volumes = \"updated\" makes the step nonlinear: set solver.kind = "
         "\"newton_krylov\""},
        {"damping of a lumped bar", bar, "method.mass=lumped",
         "theory.compare = \"bar\" knows the damping of the consistent mass matrix only: set "
         "method.mass = \"consistent\", or compare with \"oscillator\""},
        {"oscillator of many cells", shipped("oscillator"), "grid.cells_x=4 grid.cells_y=4",
         "theory.compare = \"oscillator\" needs grid.cells_x = 2, method.frozen = true, and linear "
         "FLIP"},
        {"collapse", disks, "theory.compare=collapse",
         "'theory.compare' = \"collapse\" is not one of"},
        {"disks for a billet", disks, "theory.compare=billet", need},
        {"rough billet", billet, "contact.friction=0.1", need},
        {"turned billet", billet, "grain.billet.height=0.3 grain.billet.angle=1", need},
        {"round billet", billet, "grain.billet.shape=disk grain.billet.radius=0.2", need},
        {"plates at rest", billet, "grain.top.velocity_y=0", need},
        {"billet that hardens", shipped("billet_plastic"), "material.default.hardening=1", knows},
        {"billet of sand", billet, "material.default.law=drucker_prager solver.kind=newton_krylov",
         knows},
        {"narrow plate", billet, "grain.top.width=0.5",
         "theory.compare = \"billet\": plate 'top' does not cover a whole side of 'billet': make "
         "it wider, and let them touch"},
        {"plate above a gap", billet,
         "grain.top.y=0.549 grain.billet.height=0.39 "
         "grain.billet.y=0.295",
         "plate 'top' does not cover a whole side of 'billet'"},
        {"no such plate", billet, "theory.plate=middle",
         "theory.plate: there is no grain 'middle'"},
    });
    check_described("hardening that elastic grains ignore", billet, "material.default.hardening=1");
    check_described("plastic disks and Newton", disks,
                    "material.default.law=j2 solver.kind=newton_krylov");
    check_described("growing volumes and Newton", disks,
                    "method.volumes=updated solver.kind=newton_krylov");
}

TEST_CASE("what may mislead in mpm_implicit is a warning with the number and the limit" *
          doctest::description("robust")) {
    const std::string disks = shipped("rebound");
    const std::string one = "grid.particles_per_side=1 contact.separation=1.07 ";
    check_warnings("no warning", disks, "", {});
    check_warnings("no warning of long steps", disks, "time.alpha=15 time.end=6", {});
    check_warnings("steps across surfaces", disks,
                   "time.alpha=25 time.end=10 output.particles_interval=0",
                   {"warning: |v| dt/h = 0.6633 is above 0.5: grains can pass through each "
                    "other's surfaces before they are seen to touch; reduce time.alpha\n"});
    check_warnings("fast grain alone", shipped("vibrating_bar"),
                   "time.alpha=60 time.end=2000 output.particles_interval=0", {});
    check_warnings("part of PIC", disks, "method.flip=0.9",
                   {"warning: method.flip = 0.9 is below 1: [MPM-13] is for FLIP, and the column "
                    "pic takes the rest\n"});
    check_warnings("one particle", disks, one,
                   {"warning: grid.particles_per_side = 1 with the consistent mass matrix, which "
                    "is then nearly singular: take 2, or method.mass = \"lumped\"\n"});
    check_warnings("one particle and lumped mass", disks, one + "method.mass=lumped", {});
}

TEST_CASE("every range that mpm_implicit lists is enforced" * doctest::description("robust")) {
    CHECK(check_ranges() >= 64);
}

TEST_CASE("help of mpm_implicit lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    check_help(
        "[time]\nend = 0\n[grain.beam]\nx = 0.6\ny = 0.45\n",
        "material.beam.E=1 pack.beam.x=0.2 pack.beam.y=0.15 pack.beam.columns=2 pack.beam.rows=1 "
        "bond.beam.tension=1");
}

TEST_CASE("the version of mpm_implicit is that of the Makefile" * doctest::description("robust")) {
    check_version();
}

TEST_CASE("every shipped case of mpm_implicit passes a dry run" * doctest::description("robust")) {
    CHECK(check_shipped_cases() >= 11);
}

TEST_CASE("a dry run of mpm_implicit shows its scheme and scales" *
          doctest::description("robust")) {
    const std::string out = check_described("dry run", shipped("rebound"), "--threads 2").out;
    check_lines(out, {R"(  mesh +48 x 24 cells of 0\.025)",
                      R"(  method +linear shape functions, FLIP, theta = 0\.5, consistent mass)",
                      R"(  particles +1608, 2 x 2 per cell)",
                      R"(  sound +c_p = 3\.669, largest \|v\| = 0\.1)",
                      R"(  steps +302 of dt = 0\.006633, alpha = 1)",
                      R"(  memory +about [0-9.e+-]+ MiB)", R"(  time +about [0-9.e+-]+ s on.*)"});
}

TEST_CASE("a case at the edge of what mpm_implicit takes ends with status 0" *
          doctest::description("robust")) {
    const auto check = [](const std::string& bytes, const std::string& arguments) {
        const fs::path here = fresh_folder("edge");
        write_all(here / "case.toml", bytes);
        const Outcome outcome = start(here, "case.toml --quiet " + arguments);
        INFO(arguments << ": " << outcome.err);
        CHECK(outcome.status == 0);
        CHECK(outcome.sentences.empty());
        CHECK(!holds(read_all(here / "out/mpm_implicit/case/history.dat"), "nan"));
    };
    const std::string disks =
        "[mesh]\ncells_x = 24\ncells_y = 12\nlength_x = 1.2\n[grain.left]\n"
        "x = 0.35\ny = 0.3\nvelocity_x = 0.1\n[grain.right]\nx = 0.85\n"
        "y = 0.3\nvelocity_x = -0.1\n";
    for (const std::string& solver : {std::string(), newton}) {
        check(disks, "time.end=0" + solver);
        check(disks, "time.alpha=1e30" + solver);
        check(disks, "time.end=0.1 grid.particles_per_side=1" + solver);
        check(disks, "time.end=0.1 grid.particles_per_side=8 method.shape=quadratic" + solver);
        check(disks, "grain.left.velocity_x=0 grain.right.velocity_x=0 time.end=0.1" + solver);
        // The smallest mesh, full, with every kind of wall.
        for (const std::string wall : {"slip", "stick", "frictional"})
            for (const std::string shape : {"linear", "gimp", "quadratic"})
                check(
                    "[mesh]\ncells_x = 2\ncells_y = 2\nlength_x = 0.8\n[time]\nend = 0.1\n"
                    "[grain.body]\nshape = \"box\"\nx = 0.4\ny = 0.4\nwidth = 0.8\n"
                    "height = 0.8\n",
                    "load.gravity_y=-1e-3 method.shape=" + shape + " boundary.x_low=" + wall +
                        " boundary.x_high=" + wall + " boundary.y_low=" + wall +
                        " boundary.y_high=" + wall + solver);
    }
}
