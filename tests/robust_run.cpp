// What every run keeps: the same bits for any number of threads and across a restart, a
// checkpoint when a signal stops it, refusal of damaged files, and a summary whatever happens.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "common/run/history.hpp"
#include "common/run/summary.hpp"
#include "tests/support/any_numbers.hpp"
#include "tests/support/any_run.hpp"

const std::string facts::program_name = "implicit_moment";

namespace {

using namespace facts;

const std::string sheet =
    " implicit_moment/cases/gem.toml harris.particles=4000 grid.cells_x=16 grid.cells_z=16";
const std::string thin_sheet =
    " implicit_moment/cases/lhdi_quick.toml current_sheet.particles=4000 grid.cells_x=34 "
    "grid.cells_z=16 output.fields_interval=0 output.profile_interval=0.8 time.end=4";
const std::string streams =
    " implicit_moment/cases/two_stream.toml uniform.particles_per_cell=16 time.end=2";

}  // namespace

TEST_CASE("one and two and three threads write the same history" * doctest::description("robust")) {
    for (const std::string& arguments :
         {sheet + " time.end=6", sheet + " time.end=3 field.solver=newton_krylov", thin_sheet,
          streams}) {
        check_threads(arguments);
    }
}

TEST_CASE("the effective case runs again to the same bytes" * doctest::description("robust")) {
    for (const std::string& arguments :
         {sheet + " time.end=3 output.fields_interval=3 output.particles_interval=3", thin_sheet,
          streams}) {
        CHECK(check_runs_again(arguments) >= 2);
    }
}

TEST_CASE("a restart goes on with the same bits" * doctest::description("robust")) {
    for (const std::string& arguments :
         {sheet + " time.end=6", sheet + " time.end=6 field.theta=0.7 plasma.loading=random",
          sheet + " time.end=3 field.solver=newton_krylov", thin_sheet, streams}) {
        check_restart(arguments, 5);
    }
}

TEST_CASE("a signal stops a run after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    for (const auto& [signal, status] : {std::pair{SIGTERM, 143}, std::pair{SIGINT, 130}}) {
        check_interruption(sheet, 0.3, signal, status);
    }
}

TEST_CASE("damaged and cut and foreign checkpoints are refused and nothing is written" *
          doctest::description("robust")) {
    const std::string out = folder("good"), other = folder("other"), bad = room() + "/bad.bin";
    REQUIRE(run(sheet + " time.end=1.5 output.checkpoint_steps=5", out) == 0);
    const std::string good = read_all(checkpoints(out).back());
    REQUIRE(good.size() > 100000);
    const auto refused = [&](const std::string& bytes, const std::string& reason) {
        write_all(bad, bytes);
        CHECK(run(" --restart " + bad, other) == 2);
        INFO(reason << " in: " << said(other));
        CHECK(said(other).find(reason) != std::string::npos);
        CHECK(!fs::exists(other));
    };
    for (const std::size_t place : {std::size_t{20}, std::size_t{60}, good.size() / 3,
                                    good.size() / 2, good.size() - 9, good.size() - 1}) {
        std::string flipped = good;
        flipped[place] = static_cast<char>(flipped[place] ^ 0x10);
        refused(flipped, "damaged");
    }
    for (const std::size_t length : {std::size_t{24}, std::size_t{100}, good.size() - 1}) {
        refused(good.substr(0, length), "cut off");
    }
    refused(good + "x", "too long");
    refused("", "is not a checkpoint");
    refused(good.substr(0, 10), "is not a checkpoint");
    refused(std::string(1000, 'x'), "is not a checkpoint");

    // Another program, another version.
    using common::CheckpointWriter;
    CheckpointWriter({"cic", PROGRAM_VERSION, "", ""}, bad, "", "").finish();
    refused(read_all(bad), "of 'cic'");
    CheckpointWriter({"implicit_moment", "0.0.1", "", ""}, bad, "", "").finish();
    refused(read_all(bad), "version 0.0.1");
    CheckpointWriter({"implicit_moment", PROGRAM_VERSION, "", ""}, bad, "", "").finish();
    refused(read_all(bad), "ends too early");
}

TEST_CASE("a checkpoint replaces regular files only and leaves no half of one") {
    const std::string out = folder("targets");
    fs::create_directories(out);
    auto target = out + "/checkpoint";
    const auto write = [&] {
        common::CheckpointWriter({"implicit_moment", "1", "", ""}, target, "", "").finish();
    };
    fs::create_symlink("elsewhere", target);
    CHECK_THROWS_AS(write(), common::InputError);
    fs::remove(target);
    fs::create_directory(target);
    CHECK_THROWS_AS(write(), common::InputError);
    fs::remove(target);
    write();
    CHECK(fs::is_regular_file(target));
    CHECK(!fs::exists(target + ".partial"));
}

TEST_CASE("a full disk ends a run with a sentence and spares the last checkpoint" *
          doctest::description("robust")) {
    // A limit on the size of files stands for the full disk.
    const std::string out = folder("full");
    const std::string limit = "sh -c 'trap \"\" XFSZ; ulimit -f ";
    const std::string end = " --quiet --out " + out + "' 2> " + out + ".stderr";
    CHECK(shell(limit + "64; exec " + command(sheet) + " time.end=600 output.fields_interval=0" +
                end) == 2);
    CHECK(said(out).find("disk full") != std::string::npos);
    fs::remove_all(out);
    CHECK(shell(limit + "64; exec " + command(sheet) +
                " time.end=6 output.fields_interval=0 output.checkpoint_steps=5" + end) == 2);
    INFO(said(out));
    CHECK(said(out).find("checkpoint") != std::string::npos);
    for (const auto& entry : fs::directory_iterator(out)) {
        CHECK(entry.path().string().find(".partial") == std::string::npos);
    }
}

TEST_CASE("closed pipes and closed outputs do not stop a run" * doctest::description("robust")) {
    const std::string arguments =
        command(sheet) + " time.end=1.5 --force --out " + room() + "/pipe ";
    CHECK(shell(arguments + "2> /dev/null | true") == 0);
    CHECK(shell(arguments + ">&- 2>&-") == 0);
    CHECK(shell("(" + arguments + "2>&1; echo $? > " + room() + "/status) | head -1 > /dev/null") ==
          0);
    CHECK(read_all(room() + "/status") == "0\n");
    CHECK(summary(room() + "/pipe")["status"] == 0);
}

TEST_CASE("a failed run says where and when and leaves a summary" *
          doctest::description("robust")) {
    check_failure(sheet + " time.end=6 field.max_iterations=1", "did not converge");
    // A step far beyond the closure.
    const facts::Untrapped calm;
    check_failure(sheet + " time.end=6000 time.dt=6", "at step");
    CHECK(holds(said(room() + "/failed"), "warning"));
}

TEST_CASE("the summary holds what the contract names" * doctest::description("robust")) {
    const std::string out = folder("summary");
    REQUIRE(run(sheet + " time.end=3", out) == 0);
    const auto json = summary(out);
    for (const char* key : {"program", "version", "case", "status", "results", "conservation",
                            "performance", "warnings"}) {
        CAPTURE(key);
        CHECK(json.contains(key));
    }
    for (const char* key : {"wall_s", "steps", "particle_steps", "particle_steps_per_s", "threads",
                            "peak_memory_bytes"}) {
        CAPTURE(key);
        CHECK(json["performance"][key].is_number());
    }
    CHECK(json["performance"]["particle_steps"] == 40000);
    for (const char* key : {"value", "unit", "expected", "tolerance", "source", "pass"}) {
        CAPTURE(key);
        CHECK(json["results"]["flux_initial"].contains(key));
    }
}

TEST_CASE("a number that is not finite is never hidden") {
    fs::create_directories(room());
    common::Summary numbers;
    numbers.result("good", 1, "m", 1, 0.1, "exact");
    CHECK(numbers.is_finite());
    numbers.result("bad", std::nan(""), "m", 1, 0.1, "exact");
    CHECK(!numbers.is_finite());
    const std::string path = room() + "/numbers.json";
    numbers.write(path, {"p", "1", "", ""}, "c", 3, "m");
    const auto json = nlohmann::json::parse(read_all(path));
    CHECK(json["results"]["bad"]["pass"] == false);
    CHECK(json["results"]["bad"]["finite"] == false);
    CHECK(json["results"]["good"]["pass"] == true);

    common::History history(room() + "/history.dat");
    history.columns({{"time", "s"}, {"x", "m"}});
    const std::vector<double> fine{0, 1}, broken{1, std::nan("")}, more{1, 2, 3};
    history.row(fine);
    CHECK_THROWS_AS(history.row(broken), common::NumericalError);
    CHECK_THROWS(history.row(more));
    history.flush();
    CHECK(read_all(room() + "/history.dat") == "# 1:time[s] 2:x[m]\n0 1\n");
    CHECK(history.column("x") == std::vector<double>{1});
    CHECK_THROWS(history.column("y"));
}
