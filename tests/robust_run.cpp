// What every run keeps: the same bits for any number of threads and across a restart, a
// checkpoint when a signal stops it, refusal of damaged files, and a summary whatever happens.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "common/checkpoint.hpp"
#include "common/history.hpp"
#include "common/summary.hpp"

namespace {

namespace fs = std::filesystem;

const std::string program = std::string(BUILD_FOLDER) + "/implicit_moment";
const std::string room = std::string(BUILD_FOLDER) + "/tests/runs/robust_run";
const std::string sheet =
    " implicit_moment/cases/gem.toml harris.particles=4000 grid.cells_x=16 grid.cells_z=16";
const std::string streams =
    " implicit_moment/cases/two_stream.toml uniform.particles_per_cell=16 time.end=2";

std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}
void put(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

// A clean folder name of this test's own.
std::string folder(const std::string& name) {
    const std::string path = room + "/" + name;
    fs::remove_all(path);
    fs::create_directories(room);
    return path;
}

int shell(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
int run(const std::string& arguments, const std::string& out) {
    return shell(program + arguments + " --quiet --out " + out + " 2> " + room + "/stderr");
}
std::string said() { return content(room + "/stderr"); }

std::vector<std::string> checkpoints(const std::string& out) {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(out)) {
        if (entry.path().extension() == ".bin") found.push_back(entry.path().string());
    }
    std::sort(found.begin(), found.end());
    return found;
}

nlohmann::json summary(const std::string& out) {
    const std::string text = content(out + "/summary.json");
    REQUIRE(!text.empty());
    return nlohmann::json::parse(text);
}

// Starts a long run, waits until its history has grown, and sends a signal. The exit status.
int interrupted(const std::string& arguments, const std::string& out, int signal) {
    const pid_t child = fork();
    if (child == 0) {
        std::vector<std::string> words{program};
        std::istringstream split(arguments + " --quiet --out " + out);
        for (std::string word; split >> word;) words.push_back(word);
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        execv(program.c_str(), pointers.data());
        _exit(99);
    }
    for (int wait = 0; wait < 500; ++wait) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::error_code ignored;
        const auto size = fs::file_size(out + "/history.dat", ignored);
        if (!ignored && size > 4000) break;
    }
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("one and two and three threads write the same history" * doctest::description("robust")) {
    for (const std::string& arguments :
         {sheet + " time.end=6", sheet + " time.end=3 field.solver=newton_krylov", streams}) {
        std::vector<std::string> histories;
        for (const char* threads : {"1", "2", "3"}) {
            const std::string out = folder("threads");
            REQUIRE(run(arguments + " --threads " + threads, out) == 0);
            histories.push_back(content(out + "/history.dat"));
        }
        CHECK(histories[0].size() > 1000);
        CHECK(histories[1] == histories[0]);
        CHECK(histories[2] == histories[0]);
    }
}

TEST_CASE("the effective case runs again to the same bytes" * doctest::description("robust")) {
    for (const std::string& arguments :
         {sheet + " time.end=3 output.fields_interval=3 output.particles_interval=3", streams}) {
        const std::string first = folder("first"), again = folder("again");
        REQUIRE(run(arguments, first) == 0);
        REQUIRE(run(" " + first + "/case.toml", again) == 0);
        for (const auto& entry : fs::directory_iterator(first)) {
            const std::string name = entry.path().filename().string();
            if (name == "summary.json") continue;
            CAPTURE(name);
            CHECK(content(again + "/" + name) == content(first + "/" + name));
        }
    }
}

TEST_CASE("a restart goes on with the same bits" * doctest::description("robust")) {
    for (const std::string& arguments :
         {sheet + " time.end=6", sheet + " time.end=6 field.theta=0.7 plasma.loading=random",
          sheet + " time.end=3 field.solver=newton_krylov", streams}) {
        const std::string whole = folder("whole"), rest = folder("rest");
        REQUIRE(run(arguments + " output.checkpoint_steps=5", whole) == 0);
        const auto kept = checkpoints(whole);
        REQUIRE(kept.size() == 2);
        REQUIRE(run(" --restart " + kept[0] + " --threads 1", rest) == 0);
        CHECK(content(rest + "/history.dat") == content(whole + "/history.dat"));
        CHECK(content(rest + "/case.toml") == content(whole + "/case.toml"));
        const auto a = summary(whole)["results"], b = summary(rest)["results"];
        CHECK(a == b);
    }
}

TEST_CASE("a signal stops a run after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    for (const auto& [signal, status] : {std::pair{SIGTERM, 143}, std::pair{SIGINT, 130}}) {
        const std::string stopped = folder("stopped"), whole = folder("whole");
        const int code = interrupted(sheet + " time.end=3000", stopped, signal);
        CHECK(code == status);
        CHECK(summary(stopped)["status"] == status);
        const auto kept = checkpoints(stopped);
        REQUIRE(kept.size() == 1);
        const auto steps = std::stol(kept[0].substr(kept[0].size() - 14, 10));
        CHECK(steps > 0);
        // Ten more steps, in the same folder, beside a run without the interruption.
        const std::string end =
            " time.end=" + std::to_string(0.3 * static_cast<double>(steps + 10));
        REQUIRE(run(" --restart " + kept[0] + end, stopped) == 0);
        REQUIRE(run(sheet + end, whole) == 0);
        CHECK(content(stopped + "/history.dat") == content(whole + "/history.dat"));
    }
}

TEST_CASE("damaged and cut and foreign checkpoints are refused and nothing is written" *
          doctest::description("robust")) {
    const std::string out = folder("good"), other = folder("other"), bad = room + "/bad.bin";
    REQUIRE(run(sheet + " time.end=1.5 output.checkpoint_steps=5", out) == 0);
    const std::string good = content(checkpoints(out).back());
    REQUIRE(good.size() > 100000);
    const auto refused = [&](const std::string& bytes, const std::string& reason) {
        put(bad, bytes);
        CHECK(run(" --restart " + bad, other) == 2);
        INFO(reason << " in: " << said());
        CHECK(said().find(reason) != std::string::npos);
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
    CheckpointWriter({"cic", PROGRAM_VERSION, "", ""}, "").write(bad);
    refused(content(bad), "of 'cic'");
    CheckpointWriter({"implicit_moment", "0.0.1", "", ""}, "").write(bad);
    refused(content(bad), "version 0.0.1");
    CheckpointWriter({"implicit_moment", PROGRAM_VERSION, "", ""}, "").write(bad);
    refused(content(bad), "ends too early");
}

TEST_CASE("a checkpoint replaces regular files only and leaves no half of one") {
    const std::string out = folder("targets");
    fs::create_directories(out);
    const common::CheckpointWriter writer({"implicit_moment", "1", "", ""}, "");
    auto target = out + "/checkpoint";
    common::CheckpointWriter mutable_writer = writer;
    fs::create_symlink("elsewhere", target);
    CHECK_THROWS_AS(mutable_writer.write(target), common::InputError);
    fs::remove(target);
    fs::create_directory(target);
    CHECK_THROWS_AS(mutable_writer.write(target), common::InputError);
    fs::remove(target);
    mutable_writer.write(target);
    CHECK(fs::is_regular_file(target));
    CHECK(!fs::exists(target + ".partial"));
}

TEST_CASE("a full disk ends a run with a sentence and spares the last checkpoint" *
          doctest::description("robust")) {
    // A limit on the size of files stands for the full disk.
    const std::string out = folder("full");
    const std::string limit = "sh -c 'trap \"\" XFSZ; ulimit -f ";
    const std::string end = " --quiet --out " + out + "' 2> " + room + "/stderr";
    CHECK(shell(limit + "64; exec " + program + sheet + " time.end=600 output.fields_interval=0" +
                end) == 2);
    CHECK(said().find("disk full") != std::string::npos);
    fs::remove_all(out);
    CHECK(shell(limit + "64; exec " + program + sheet +
                " time.end=6 output.fields_interval=0 output.checkpoint_steps=5" + end) == 2);
    INFO(said());
    CHECK(said().find("checkpoint") != std::string::npos);
    for (const auto& entry : fs::directory_iterator(out)) {
        CHECK(entry.path().string().find(".partial") == std::string::npos);
    }
}

TEST_CASE("closed pipes and closed outputs do not stop a run" * doctest::description("robust")) {
    const std::string arguments =
        program + sheet + " time.end=1.5 --force --out " + room + "/pipe ";
    CHECK(shell(arguments + "2> /dev/null | true") == 0);
    CHECK(shell(arguments + ">&- 2>&-") == 0);
    CHECK(shell("(" + arguments + "2>&1; echo $? > " + room + "/status) | head -1 > /dev/null") ==
          0);
    CHECK(content(room + "/status") == "0\n");
    CHECK(summary(room + "/pipe")["status"] == 0);
}

TEST_CASE("a failed run says where and when and leaves a summary" *
          doctest::description("robust")) {
    const std::string out = folder("failed");
    CHECK(run(sheet + " time.end=6 field.max_iterations=1", out) == 3);
    CHECK(said().find("did not converge") != std::string::npos);
    CHECK(summary(out)["status"] == 3);
    fs::remove_all(out);
    // A step far beyond the closure.
    CHECK(run(sheet + " time.end=6000 time.dt=6", out) == 3);
    CHECK(summary(out)["status"] == 3);
    CHECK(said().find("warning") != std::string::npos);
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
    fs::create_directories(room);
    common::Summary numbers;
    numbers.result("good", 1, "m", 1, 0.1, "exact");
    CHECK(numbers.is_finite());
    numbers.result("bad", std::nan(""), "m", 1, 0.1, "exact");
    CHECK(!numbers.is_finite());
    const std::string path = room + "/numbers.json";
    numbers.write(path, {"p", "1", "", ""}, "c", 3, "m");
    const auto json = nlohmann::json::parse(content(path));
    CHECK(json["results"]["bad"]["pass"] == false);
    CHECK(json["results"]["bad"]["finite"] == false);
    CHECK(json["results"]["good"]["pass"] == true);

    common::History history(room + "/history.dat");
    history.columns({{"time", "s"}, {"x", "m"}});
    const std::vector<double> fine{0, 1}, broken{1, std::nan("")}, more{1, 2, 3};
    history.row(fine);
    CHECK_THROWS_AS(history.row(broken), common::NumericalError);
    CHECK_THROWS(history.row(more));
    history.flush();
    CHECK(content(room + "/history.dat") == "# 1:time[s] 2:x[m]\n0 1\n");
    CHECK(history.column("x") == std::vector<double>{1});
    CHECK_THROWS(history.column("y"));
}
