// What every run of mpm_explicit keeps: the same bits for any number of threads and across a
// restart, in the middle of a collision, with friction and bonds and plates; a checkpoint when a
// signal stops it; and a sentence with grain, place and time when it fails.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "tests/support/any_run.hpp"

const std::string facts::program_name = "mpm_explicit";

namespace {

using namespace facts;

// Two disks that meet at t = 0.1 and are in contact at the end, on cells of 0.05.
const std::string rebound =
    " mpm_explicit/cases/rebound.toml theory.compare=none grid.cells_x=24 grid.cells_y=12 "
    "grain.left.x=0.39 grain.right.x=0.81";
// Grains between rough plates; and so fast that particles are sorted again every 20 steps and
// grains cross the ends of the periodic mesh.
const std::string slow_shear =
    " mpm_explicit/cases/shear.toml output.history_steps=1 output.pixels_per_cell=1 "
    "grid.cells_x=25 grid.cells_y=23";
const std::string no_files = " output.particles_interval=0 output.fringes_interval=0";
const std::string fast = " pack.top.velocity_x=2 pack.disk.shear_rate=2.8 material.default.E=1e6";
const std::string shear = slow_shear + fast + no_files;
// Two halves of a bar whose bond breaks at t = 4.
const std::string bonded =
    " mpm_explicit/cases/bonded_bar.toml theory.compare=none bond.joint.tension=0.3";
// A disk between two plates, of which a force drives one.
const std::string plates =
    " mpm_explicit/cases/diametral_disk.toml theory.compare=none output.history_steps=1 "
    "grid.cells_x=20 grid.cells_y=20" +
    no_files;
const std::string press = plates + " load.rise=0.04";
// A disk that yields at a wall.
const std::string small_disk =
    " mpm_explicit/cases/yielding_disk.toml theory.compare=none grid.cells_x=12 grid.cells_y=12";
const std::string yielding = small_disk + " grain.disk.x=0.22 grain.disk.velocity_x=-1";
// A column of sand between rubbing walls, damped.
const std::string sand =
    small_disk +
    " grain.disk.shape=box grain.disk.width=0.3 grain.disk.height=0.4 grain.disk.x=0.3 "
    "grain.disk.y=0.2 grain.disk.velocity_x=0.1 boundary.y_low=frictional boundary.friction=0.4 "
    "load.gravity_y=-10 load.damping=1 material.default.law=drucker_prager";
const std::string wave = " mpm_explicit/cases/standing_wave.toml theory.compare=none";

// A belt around a periodic mesh, on which a disk lands and rubs.
std::string belt() {
    const std::string file = room() + "/belt.toml";
    write_all(file,
              "[mesh]\ncells_x = 20\ncells_y = 12\nlength_x = 1\nperiodic_x = true\n[walls]\n"
              "y_low = \"slip\"\n[contact]\nfriction = 0.5\n[grain.belt]\nshape = \"box\"\n"
              "x = 0.5\ny = 0.1\nwidth = 1\nheight = 0.2\nvelocity_x = 0.5\n[grain.disk]\n"
              "x = 0.95\ny = 0.31\nvelocity_x = 1\nvelocity_y = -0.1\n");
    return " " + file;
}

// All runs that differ in what they call: laws, walls, plates, bonds, periodic meshes, shapes.
std::vector<std::string> runs() {
    return {rebound + " time.end=0.3",
            rebound + " time.end=0.3 method.shape=gimp contact.friction=0.3",
            rebound + " time.end=0.3 method.shape=quadratic method.flip=0.95",
            shear + " time.end=0.04",
            shear + " time.end=0.04 method.shape=quadratic grid.particles_per_side=3",
            bonded + " time.end=5",
            press + " time.end=0.08",
            yielding + " time.end=0.05",
            sand + " time.end=0.1",
            belt() + " time.end=0.15",
            wave + " time.end=0.3 method.frozen=true method.shape=gimp"};
}

// Whether a process still listens to a signal.
bool listens(pid_t process, int signal) {
    std::ifstream file("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("SigCgt:", 0) == 0)
            return ((std::stoull(line.substr(7), nullptr, 16) >> (signal - 1)) & 1U) != 0;
    return false;
}

}  // namespace

TEST_CASE("one and two and three threads write the same history of mpm_explicit" *
          doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_threads(arguments);
}

TEST_CASE("the runs of mpm_explicit that are repeated meet and slip and break and yield" *
          doctest::description("robust")) {
    const std::string out = folder("events");
    const auto last = [&](const std::string& name) { return column(out, name).back(); };
    REQUIRE(run(rebound + " time.end=0.3", out) == 0);
    CHECK(last("contact_force") > 0);
    REQUIRE(run(shear + " time.end=0.04 --force", out) == 0);
    CHECK(last("contacts") > 50);
    CHECK(last("friction") < 0);
    // The top plates have moved by more than their distance to the end of the mesh.
    CHECK(last("travel_x_top_g0005") > 0.07);
    REQUIRE(run(bonded + " time.end=5 --force", out) == 0);
    CHECK(last("broken_bonds") == 1);
    CHECK(column(out, "bond_normal_1")[20] > 0);
    REQUIRE(run(press + " time.end=0.08 --force", out) == 0);
    CHECK(last("travel_y_top") < 0);
    CHECK(last("force_y_top") > 10);
    REQUIRE(run(yielding + " time.end=0.05 --force", out) == 0);
    CHECK(last("plastic") > 0);
    REQUIRE(run(sand + " time.end=0.1 --force", out) == 0);
    CHECK(last("plastic") > 0);
}

TEST_CASE("the effective case of mpm_explicit runs again to the same bytes of every kind of file" *
          doctest::description("robust")) {
    // Three snapshots, each particles and grains and fringes; and case, history, pack.
    CHECK(check_runs_again(rebound + " time.end=0.2 output.particles_interval=0.1 "
                                     "output.grains_interval=0.1 output.fringes_interval=0.1 "
                                     "output.pixels_per_cell=2 output.pack=true") == 3 * 3 + 3);
    // And for ParaView.
    CHECK(check_runs_again(bonded + " time.end=5 output.particles_interval=2.5 output.vtk=true") ==
          3 * 2 + 2);
    CHECK(check_runs_again(rebound +
                           " time.end=0.01 grain.left.shape=polygon grain.left.angle=1e-3 "
                           "material.more.nu=0.123456789012345678 "
                           "grain.right.material=more") == 3);
}

TEST_CASE("a restart of mpm_explicit in a collision goes on with the same bits" *
          doctest::description("robust")) {
    for (const std::string& arguments : runs()) check_restart(arguments, 15);
    check_restart(slow_shear + fast +
                      " time.end=0.04 output.particles_interval=2e-3 output.grains_interval=2e-3 "
                      "output.fringes_interval=4e-3",
                  40);
}

TEST_CASE("a restart of mpm_explicit goes on wherever its checkpoint was written" *
          doctest::description("robust")) {
    // Before and after a sort, before and after a bond breaks, with and without a contact.
    const std::string whole = folder("from_whole"), part = folder("from_part"),
                      rest = folder("from_rest");
    for (const auto& one :
         {std::pair{bonded + " time.end=5", 200}, std::pair{shear + " time.end=0.02", 60},
          std::pair{press + " time.end=0.08", 140}}) {
        const std::string arguments = one.first;
        const int steps = one.second;
        CAPTURE(arguments);
        REQUIRE(run(arguments + " --force", whole) == 0);
        for (int stop = 7; stop < steps; stop += steps / 5) {
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

TEST_CASE("a signal stops mpm_explicit after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    // dt = alpha h/(c_p + |v|), c_p^2 = (lambda + 2G)/density = 1.346 E/density for nu = 0.3.
    const auto dt = [](double alpha, double h, double E, double v) {
        return alpha * h / (std::sqrt(0.7 / (1.3 * 0.4) * E / 1000) + v);
    };
    check_interruption(slow_shear, dt(0.25, 0.04, 1e5, 0.2), SIGINT, 130);
    check_interruption(wave, dt(0.2, 0.0625, 1e4, 1e-4), SIGTERM, 143);
}

TEST_CASE("a second signal ends mpm_explicit at once" * doctest::description("robust")) {
    // Steps so long that the first signal is still waiting for the end of one.
    const std::string out = folder("killed"),
                      arguments =
                          " mpm_explicit/cases/standing_wave.toml theory.compare=none "
                          "grid.cells_x=800 grid.cells_y=200 time.end=100 --threads 1";
    const pid_t child = fork();
    if (child == 0) {
        std::vector<std::string> words;
        std::istringstream split(command(arguments) + " --quiet --out " + out);
        for (std::string word; split >> word;) words.push_back(word);
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        execv(pointers[0], pointers.data());
        _exit(99);
    }
    const auto wait_for = [](const auto& happens) {
        for (int k = 0; k < 20000 && !happens(); ++k)
            std::this_thread::sleep_for(std::chrono::microseconds(500));
    };
    wait_for([&] { return fs::exists(out + "/history.dat"); });
    kill(child, SIGINT);
    wait_for([&] { return !listens(child, SIGINT); });
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGINT);
    CHECK(!fs::exists(out + "/summary.json"));
}

TEST_CASE("a checkpoint of another program or of another case is refused by mpm_explicit" *
          doctest::description("robust")) {
    const std::string file = room() + "/foreign.bin", out = folder("foreign");
    const auto refused = [&](const common::ProgramInfo& info, const std::string& reason) {
        common::CheckpointWriter(info, file, "", "").finish();
        CHECK(run(" --restart " + file, out) == 2);
        INFO(said(out));
        CHECK(holds(said(out), reason));
        CHECK(!fs::exists(out));
    };
    refused({"cic", PROGRAM_VERSION, "", ""}, "of 'cic', not of 'mpm_explicit'");
    refused({"mpm_explicit", "0.0.1", "", ""}, "was written by version 0.0.1");
    refused({"mpm_explicit", PROGRAM_VERSION, "", ""}, "ends too early");
}

TEST_CASE("a run of mpm_explicit that fails names the grain and the place and the time" *
          doctest::description("robust")) {
    const std::string out = folder("failed");
    const auto check = [&](const std::string& arguments, const std::string& sentence) {
        check_failure(arguments, "");
        const std::string text = said(out), number = "[-+.e0-9]+";
        INFO(text);
        const std::string place = "at \\(" + number + ", " + number + "\\)",
                          when = "at step [0-9]+, t = " + number;
        std::string pattern = "(warning: [^\n]*\n)*mpm_explicit: " + sentence + "\n";
        pattern = std::regex_replace(pattern, std::regex("PLACE"), place);
        pattern = std::regex_replace(pattern, std::regex("WHEN"), when);
        pattern = std::regex_replace(pattern, std::regex("NUMBER"), number);
        CHECK(std::regex_match(text, std::regex(pattern)));
        CHECK(!holds(read_all(out + "/history.dat"), "nan"));
        CHECK(!holds(read_all(out + "/history.dat"), "inf"));
    };
    const std::string left =
        "a particle of grain 'XX' has left the mesh PLACE WHEN: widen the mesh, put a wall there, "
        "or reduce time.alpha if the grain has burst";
    const auto of = [](const std::string& grain, const std::string& sentence) {
        return std::regex_replace(sentence, std::regex("XX"), grain);
    };
    // Free flight to each side, and a plate.
    check(rebound + " grain.left.velocity_x=-3", of("left", left));
    check(rebound + " grain.right.velocity_x=3", of("right", left));
    check(rebound + " grain.right.velocity_y=3", of("right", left));
    check(rebound + " grain.left.velocity_y=-3 method.shape=quadratic", of("left", left));
    check(press + " grain.bottom.velocity_y=-1", of("bottom", left));
    // Steps beyond the stability limit burst the disks.
    check(
        " mpm_explicit/cases/rebound.toml theory.compare=none time.alpha=1",
        "the energy is NUMBER, and NUMBER was put in, WHEN; fastest is grain '(left|right)' PLACE: "
        "reduce time.alpha, refine the mesh, or allow more with time.energy_limit");
    // Plates that come together faster than sound, in steps that are too long.
    const std::string inverted =
        "the volume of a particle of grain 'disk' PLACE is inverted WHEN: reduce time.alpha, "
        "refine "
        "the mesh, or load the grain more slowly";
    check(plates +
              " load.rise=0 time.alpha=2 time.energy_limit=0 grain.bottom.velocity_y=100 "
              "grain.top.control=velocity grain.top.velocity_y=-100",
          inverted);
}

TEST_CASE("what loads have put in is remembered when they take it back" *
          doctest::description("robust")) {
    // A disk falls, is thrown back, and passes the height of its start with some energy to spare.
    const std::string out = folder("bounce");
    CHECK(run(small_disk + " material.default.law=elastic boundary.x_low=slip grain.disk.x=0.25 "
                           "method.shape=gimp "
                           "grain.disk.velocity_x=0 load.gravity_x=-2 time.end=1.2",
              out) == 0);
    INFO(said(out));
    CHECK(column(out, "contact_force").size() > 10);
}

TEST_CASE("a full disk ends a run of mpm_explicit with a sentence and no half of a file" *
          doctest::description("robust")) {
    // A limit on the size of files stands for the full disk.
    const std::string out = folder("full");
    const auto full = [&](const std::string& arguments, const std::string& message) {
        fs::remove_all(out);
        CHECK(shell("sh -c 'trap \"\" XFSZ; ulimit -f 64; exec " + command(arguments) +
                    " --quiet --out " + out + "' 2> " + out + ".stderr") == 2);
        INFO(said(out));
        CHECK(holds(said(out), message));
        for (const auto& entry : fs::directory_iterator(out))
            CHECK(entry.path().string().find(".partial") == std::string::npos);
    };
    full(wave + no_files + " time.end=100", "history.dat: cannot be written; is the disk full?");
    full(press + " output.checkpoint_steps=5", "checkpoint");
    full(slow_shear + " output.particles_interval=0.1", "particles_000000.dat");
    full(wave + " output.particles_interval=0 output.fringes_interval=1 output.pixels_per_cell=64",
         "fringes_000000.dat");
}

TEST_CASE("closed pipes and closed outputs do not stop mpm_explicit" *
          doctest::description("robust")) {
    const std::string out = room() + "/pipe",
                      arguments = command(rebound) + " time.end=0.1 --force --out " + out + " ";
    CHECK(shell(arguments + "2> /dev/null | true") == 0);
    CHECK(shell(arguments + ">&- 2>&-") == 0);
    CHECK(shell("(" + arguments + "2>&1; echo $? > " + out + ".status) | head -1 > /dev/null") ==
          0);
    CHECK(read_all(out + ".status") == "0\n");
    CHECK(summary(out)["status"] == 0);
}

TEST_CASE("force replaces every kind of file of an earlier run of mpm_explicit" *
          doctest::description("robust")) {
    const std::string out = folder("replaced");
    REQUIRE(run(rebound + " time.end=0.1 output.particles_interval=0.05 output.vtk=true "
                          "output.fringes_interval=0.05 output.grains_interval=0.05 "
                          "output.pack=true output.checkpoint_steps=5",
                out) == 0);
    for (const char* name : {"particles_000000.dat", "particles_000000.vtp", "fringes_000000.dat",
                             "grains_000000.dat", "pack.txt"}) {
        CAPTURE(name);
        CHECK(fs::exists(out + "/" + name));
    }
    CHECK(checkpoints(out).size() == 2);
    // Without force nothing is touched.
    const Files there = content(out);
    CHECK(run(rebound + " time.end=0.1", out) == 2);
    CHECK(holds(said(out), "holds an earlier run; --force replaces it"));
    CHECK(content(out) == there);

    for (const char* name : {"fringes_of_the_sea.dat", "grains_of_sand.dat", "pack.txt.old"})
        write_all(out + "/" + std::string(name), "kept");
    REQUIRE(run(rebound + " time.end=0.1 output.particles_interval=0 --force", out) == 0);
    CHECK(content(out).size() == 3 + 3);
    CHECK(read_all(out + "/grains_of_sand.dat") == "kept");
    // A folder that holds only such files is not ours.
    const std::string foreign = folder("foreign_folder");
    write_all(foreign + "/grains_of_sand.dat", "kept");
    CHECK(run(rebound + " time.end=0.1", foreign) == 2);
    CHECK(holds(said(foreign), "is not empty"));
}

TEST_CASE("a pack that is written and read again gives the same run of mpm_explicit" *
          doctest::description("robust")) {
    const std::string file = room() + "/pack.toml";
    for (const std::string kind :
         {"hexagonal\"\nradius = 0.15", "random\"\nwidth = 1\nheight = 0.6\nsides = 5"}) {
        const std::string first = folder("first_pack"), again = folder("again_pack");
        write_all(file,
                  "[mesh]\ncells_x = 20\ncells_y = 16\nlength_x = 1\n[time]\nend = 0.1\n"
                  "[output]\npack = true\n[contact]\nfriction = 0.3\n[pack.p]\ncount = 5\n"
                  "columns = 2\nrows = 2\nx = 0.2\ny = 0.2\nvelocity_x = -0.2\nshear_rate = 1\n"
                  "radius_min = 0.1\nradius_max = 0.15\nkind = \"" +
                      kind + "\n");
        const bool is_random = holds(kind, "random");
        const std::string region = is_random ? " pack.p.x=0 pack.p.y=0" : "";
        REQUIRE(run(" " + file + region, first) == 0);
        REQUIRE(run(" " + file + region + " pack.p.kind=file pack.p.sides=0 pack.p.file=" + first +
                        "/pack.txt",
                    again) == 0);
        CHECK(rows(first).size() > 1000);
        CHECK(rows(again) == rows(first));
        CHECK(column(again, "contacts").back() == column(first, "contacts").back());
        const std::string pack = read_all(again + "/pack.txt");
        CHECK(std::regex_replace(pack, std::regex(" p_p_"), " p_") ==
              read_all(first + "/pack.txt"));
    }
}
