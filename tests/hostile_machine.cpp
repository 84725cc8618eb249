// What happens to a run and is not its doing: other work on the machine, signals, damaged files,
// links, a second run in the same folder.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/any_program.hpp"

namespace {

namespace fs = std::filesystem;

using facts::read_all, facts::write_all, facts::holds;

struct Outcome {
    int status;
    std::string out, err;
};

// A folder of the test, empty, with a helper that runs commands there in the environment of a user.
struct Room {
    fs::path folder = fs::absolute(facts::folder_of_test());

    Room() {
        fs::remove_all(folder);
        fs::create_directories(folder);
    }

    // in: command, as a shell reads it, in the root of the project
    Outcome run(const std::string& command) const {
        const std::string out = folder / "stdout", err = folder / "stderr";
        const int status = std::system(("env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT -u KMP_BLOCKTIME "
                                        "-u OMP_NUM_THREADS sh -c '" +
                                        command + "' </dev/null >" + out + " 2>" + err)
                                           .c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_all(out),
                read_all(err)};
    }
    std::string path(const std::string& name) const { return folder / name; }
};

std::string program(const std::string& name) { return std::string(BUILD_FOLDER) + "/" + name; }

// A run of cic that takes a second or less, in so many steps.
std::string short_run(const std::string& out, int steps) {
    return program("cic") + " theory.compare=none time.end=" + std::to_string(0.05 * steps) +
           " --out " + out + " ";
}

std::string newest_checkpoint(const fs::path& folder) {
    std::string newest;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".bin") newest = std::max(newest, entry.path().string());
    return newest;
}

const std::vector<std::string> programs{
    "cic", "pic", "flip", "mpm_explicit", "mpm_implicit", "implicit_moment", "explicit_em"};

}  // namespace

// Threads that spin while they wait for one that has no core make a run fifty times longer, in one
// run of three. The time by the clock depends on what else the machine does, that of its
// processors does not.
TEST_CASE("beside busy work a program takes no more than with threads that sleep while they wait" *
          doctest::description("robust")) {
    const Room room;
    const auto seconds_of_children = [] {
        rusage used;
        getrusage(RUSAGE_CHILDREN, &used);
        return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
               1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    };
    const auto longest_of = [&](int runs, const std::string& policy) {
        double longest = 0;
        for (int k = 0; k < runs; ++k) {
            const double before = seconds_of_children();
            CHECK(
                room.run(policy + short_run(room.path("run"), 300) + "--threads 2 --quiet --force")
                    .status == 0);
            longest = std::max(longest, seconds_of_children() - before);
        }
        return longest;
    };
    std::vector<pid_t> busy;
    for (long core = 0; core < sysconf(_SC_NPROCESSORS_ONLN); ++core) {
        const pid_t child = fork();
        if (child == 0) execlp("sh", "sh", "-c", "while :; do :; done", nullptr);
        busy.push_back(child);
    }
    const double passive = longest_of(4, "OMP_WAIT_POLICY=passive "), own = longest_of(8, "");
    for (const pid_t child : busy) {
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
    }
    INFO("passive " << passive << " s of processors, as a user starts it " << own << " s");
    CHECK(own <= 2.0 * passive + 1.0);
}

TEST_CASE("a signal at any moment leaves nothing or a checkpoint and the command that continues" *
          doctest::description("robust")) {
    const Room room;
    for (const std::string& name : programs) {
        const std::string out = room.path(name);
        for (const std::string after : {"0.003", "0.01", "0.03", "0.1", "0.3"}) {
            INFO(name << " stopped after " << after << " s");
            fs::remove_all(out);
            const Outcome stopped =
                room.run("timeout --foreground --preserve-status -s INT " + after + " " +
                         program(name) + " --quiet --threads 1 --out " + out);
            CHECK((stopped.status == 130 || stopped.status == 0));
            if (!fs::exists(out) || stopped.status == 0) continue;
            const std::string checkpoint = newest_checkpoint(out);
            INFO("left: " << room.run("ls -A " + out).out << stopped.err << stopped.status);
            REQUIRE(!checkpoint.empty());
            CHECK(room.run(program(name) + " --verify " + checkpoint).status == 0);
            CHECK(holds(stopped.err, "continue with: " + program(name) + " --restart " +
                                         checkpoint + " --threads 1\n"));
        }
    }
}

TEST_CASE("a run that is resumed after a signal gives the same bytes and a complete one is left" *
          doctest::description("robust")) {
    const Room room;
    const std::string whole = room.path("whole"), parts = room.path("parts");
    CHECK(room.run(short_run(whole, 400) + "--quiet").status == 0);
    int stops = 0;
    for (int k = 0; k < 20; ++k) {
        const Outcome part = room.run("timeout --foreground --preserve-status -s TERM 0.2 " +
                                      short_run(parts, 400) + "--quiet --resume");
        if (part.status == 0) break;
        CHECK(part.status == 143);
        ++stops;
    }
    INFO(stops << " stops");
    // On a busy machine the stops alone do not reach the end.
    CHECK(room.run(short_run(parts, 400) + "--quiet --resume").status == 0);
    CHECK(read_all(parts + "/history.dat") == read_all(whole + "/history.dat"));
    const auto written = fs::last_write_time(parts + "/history.dat");
    const Outcome again = room.run(short_run(parts, 400) + "--resume");
    CHECK(again.status == 0);
    CHECK(holds(again.out, "holds this run, complete"));
    CHECK(fs::last_write_time(parts + "/history.dat") == written);
    CHECK(room.run(short_run(parts, 401) + "--quiet --resume").status == 0);
    CHECK(read_all(parts + "/history.dat").size() > read_all(whole + "/history.dat").size());
}

TEST_CASE("resuming does not replace a stopped run of another input and names damage" *
          doctest::description("robust")) {
    const Room room;
    const std::string out = room.path("run");
    const Outcome part = room.run("timeout --foreground --preserve-status -s TERM 0.5 " +
                                  short_run(out, 1000000) + "--quiet");
    REQUIRE(part.status == 143);
    const std::string kept = newest_checkpoint(out), bytes = read_all(kept);
    REQUIRE(!kept.empty());
    const std::string other = short_run(out, 6) + "output.checkpoint_steps=3 --quiet --resume ";
    const Outcome refused = room.run(other);
    CHECK(refused.status == 2);
    CHECK(holds(refused.err, "holds a stopped run of another input: --restart " + kept));
    const Outcome foreign = room.run(program("pic") + " --resume --out " + out);
    CHECK(foreign.status == 2);
    CHECK(holds(foreign.err, "holds a stopped run of another program: there --restart " + kept));
    CHECK(read_all(kept) == bytes);
    CHECK(room.run(other + "--force").status == 0);
    CHECK(!fs::exists(kept));

    // A complete one may be made again.
    const Outcome replaced = room.run(other + "time.dt=0.025");
    CHECK(replaced.status == 0);
    CHECK(holds(replaced.err, "cic: replaces the run of another input in " + out));
    fs::remove(out + "/summary.json");
    const std::string newest = newest_checkpoint(out), whole = read_all(newest);
    write_all(newest, whole.substr(0, whole.size() - 1));
    const Outcome damaged = room.run(other + "time.dt=0.025");
    CHECK(damaged.status == 0);
    CHECK(holds(damaged.err, "warning: " + newest + ": "));
    CHECK(holds(damaged.err, "; --resume begins before it"));
}

TEST_CASE("a checkpoint with flipped bits or of another length is refused" *
          doctest::description("robust")) {
    const Room room;
    const std::string out = room.path("run"), bad = room.path("bad.bin");
    CHECK(room.run(short_run(out, 5) + "output.checkpoint_steps=5 --quiet").status == 0);
    const std::string good = read_all(newest_checkpoint(out));
    const auto is_refused = [&](const std::string& bytes) {
        write_all(bad, bytes);
        const Outcome outcome = room.run(program("cic") + " --verify " + bad);
        return outcome.status == 2 && holds(outcome.err, "checkpoint");
    };
    REQUIRE(good.size() > 10000);
    CHECK_FALSE(is_refused(good));
    int refused = 0, tried = 0;
    for (std::size_t at = 0; at < good.size(); at += good.size() / 40 + 1) {
        std::string one = good, pair = good;
        one[at] = static_cast<char>(one[at] ^ 1);
        // Two signs of numbers.
        for (const std::size_t sign : {at / 2, at})
            pair[sign] = static_cast<char>(pair[sign] ^ 128);
        if (at == 0) pair = good + '\0';
        for (const std::string& bytes : {one, pair, good.substr(0, at)}) {
            refused += is_refused(bytes);
            ++tried;
        }
    }
    CHECK(refused == tried);
}

TEST_CASE("a second run in the same folder is refused while the first one writes" *
          doctest::description("robust")) {
    const Room room;
    const std::string out = room.path("run");
    const Outcome both =
        room.run(short_run(out, 100000) + "--quiet & first=$!; sleep 0.5; " + short_run(out, 5) +
                 "--quiet --force; echo second $?; " + short_run(out, 5) + "--quiet --resume; " +
                 short_run(out, 5) + "--quiet; kill $first; wait $first; echo first $?");
    CHECK(both.err.find("earlier run") == std::string::npos);
    CHECK(both.err.find("replaces") == std::string::npos);
    CHECK(holds(both.err, "another run is writing into this folder"));
    CHECK(holds(both.out, "second 2"));
    CHECK(holds(both.out, "first 143"));
    CHECK(room.run(short_run(out, 5) + "--quiet --force").status == 0);
}

TEST_CASE("nothing is written through a link" * doctest::description("robust")) {
    const Room room;
    const std::string out = room.path("run"), victim = room.path("victim");
    CHECK(room.run(short_run(out, 5) + "output.checkpoint_steps=5 --quiet").status == 0);
    write_all(victim, "mine\n");
    fs::remove(out + "/history.dat");
    fs::create_symlink(victim, out + "/history.dat");
    const Outcome linked =
        room.run(program("cic") + " --quiet time.end=1 --restart " + newest_checkpoint(out));
    CHECK(linked.status == 2);
    CHECK(holds(linked.err, "history.dat: is not a regular file"));
    CHECK(read_all(victim) == "mine\n");
}

TEST_CASE("a result that fell short is said even with --quiet and is status 1 with --strict" *
          doctest::description("robust")) {
    const Room room;
    // The waves have no time to grow.
    const std::string early =
        program("cic") + " time.end=1 --quiet --force --out " + room.path("run") + " ";
    const Outcome quiet = room.run(early), strict = room.run(early + "--strict");
    CHECK(quiet.status == 0);
    CHECK(holds(quiet.err, "cic: NOT MEASURED growth_over_theory: cannot be measured, because "));
    CHECK(strict.status == 1);
    CHECK(holds(read_all(room.path("run/summary.json")), "\"status\": 1"));

    // A complete run that is left as it is keeps its verdict.
    CHECK(room.run(early).status == 0);
    const Outcome left = room.run(early + "--resume");
    CHECK(left.status == 0);
    CHECK(holds(left.err, "cic: a result fell short"));
    CHECK(room.run(early + "--resume --strict").status == 1);
}

TEST_CASE("a figure has the same numbers where numbers are written with a comma" *
          doctest::description("robust")) {
    const Room room;
    if (room.run("localedef -f UTF-8 -i de_DE " + room.path("de_DE.UTF-8")).status != 0) {
        MESSAGE("skipped: there is no locale de_DE to be made; make deps-dev installs its sources");
        return;
    }
    const std::string german =
                          "env LANG=de_DE.UTF-8 LC_ALL=de_DE.UTF-8 LOCPATH=" + room.path("") + " ",
                      english = "env LANG=C LC_ALL=C ";
    REQUIRE(room.run(german + "awk \"BEGIN { print 1 / 2 }\"").out == "0,5\n");
    // make with a folder out/ of its own; programs are as they are.
    const auto draw = [&](const std::string& name, const std::string& locale) {
        const fs::path root = room.path(name);
        fs::create_directories(root);
        for (const auto& entry : fs::directory_iterator("."))
            if (entry.path().filename() != "out")
                fs::create_symlink(fs::absolute(entry.path()), root / entry.path().filename());
        const std::string build = BUILD_FOLDER, by = build + "/mpm_explicit";
        const Outcome made = room.run("cd " + root.string() + " && " + locale +
                                      "env -u MAKEFLAGS -u MAKELEVEL make BUILD=" + build + " -o " +
                                      by + " mpm_explicit_oscillator");
        INFO(made.err);
        REQUIRE(made.status == 0);
        return root / "out";
    };
    const fs::path here = draw("english", english), there = draw("german", german);
    int compared = 0;
    for (const auto& entry : fs::recursive_directory_iterator(here)) {
        const std::string name = fs::relative(entry.path(), here);
        if (!entry.is_regular_file() || name.ends_with("summary.json")) continue;
        CAPTURE(name);
        CHECK(read_all(there / name) == read_all(entry.path()));
        ++compared;
    }
    CHECK(compared >= 8);
}

TEST_CASE("a program takes the cores and the memory that its affinity and its control group leave" *
          doctest::description("robust")) {
    const Room room;
    // in: enter, what the shell does before it becomes the program
    const auto run_in = [&](const std::string& enter, const std::string& words) {
        return room.run(enter + short_run(room.path("run"), 3) + "--quiet --force " + words);
    };
    const auto threads_in = [&](const std::string& enter) {
        CHECK(run_in(enter, "").status == 0);
        const std::string summary = read_all(room.folder / "run/summary.json");
        std::smatch found;
        CHECK(std::regex_search(summary, found, std::regex("\"threads\": ([0-9]+)")));
        return found.str(1);
    };
    CHECK(threads_in("exec taskset -c 0 ") == "1");

    // A group of either version of control groups, with limits, if one may be made here.
    const std::string name = "particle_in_cell_" + std::to_string(getpid());
    const auto grouped = [&](const std::string& controller, const std::string& limits) {
        for (const std::string& root :
             {"/sys/fs/cgroup/" + controller, std::string("/sys/fs/cgroup")}) {
            const std::string group = root + "/" + name;
            const Outcome made =
                room.run("mkdir " + group + " && cd " + group + " && { " + limits + "; }");
            if (made.status == 0) return group;
            room.run("rmdir " + group);
        }
        return std::string();
    };
    const auto enter = [](const std::string& group) {
        return "echo $$ > " + group + "/cgroup.procs && exec ";
    };
    const std::string slow = grouped("cpu",
                                     "{ [ -f cpu.max ] && echo 100000 100000 > cpu.max; } || "
                                     "echo 100000 > cpu.cfs_quota_us");
    if (slow.empty()) MESSAGE("skipped: no control group of processors may be made here");
    if (!slow.empty()) {
        CHECK(threads_in(enter(slow)) == "1");
        room.run("rmdir " + slow);
    }
    const std::string small = grouped("memory",
                                      "{ [ -f memory.max ] && echo 100000000 > memory.max; } || "
                                      "echo 100000000 > memory.limit_in_bytes");
    if (small.empty()) MESSAGE("skipped: no control group of memory may be made here");
    if (!small.empty()) {
        CHECK(run_in(enter(small), "").status == 0);
        const Outcome large = run_in(enter(small), "species.left.particles_per_cell=1e5");
        CHECK(large.status == 2);
        INFO(large.err);
        CHECK(holds(large.err, "memory"));
        room.run("rmdir " + small);
    }
}

TEST_CASE("the peak of memory belongs to the program and not to what started it" *
          doctest::description("robust")) {
    const Room room;
    const std::string large(200 << 20, 'x');
    CHECK(large.size() > 1000);
    CHECK(room.run(short_run(room.path("run"), 5) + "--quiet").status == 0);
    std::smatch found;
    const std::string summary = read_all(room.path("run/summary.json"));
    REQUIRE(std::regex_search(summary, found, std::regex("\"peak_memory_bytes\": ([0-9.e+]+)")));
    CHECK(std::stod(found[1]) < 100e6);
}

TEST_CASE("a slip in a case or on the command line is answered with what was meant" *
          doctest::description("robust")) {
    const Room room;
    const auto answer = [&](const std::string& text, const std::string& arguments) {
        write_all(room.path("slip.toml"), text);
        const Outcome outcome =
            room.run(program("cic") + " " + (text.empty() ? "" : room.path("slip.toml")) + " " +
                     arguments + " --dry-run");
        CHECK(outcome.status == 2);
        return outcome.err;
    };
    CHECK(holds(answer("", "two_stream"), "did you mean cic/cases/two_stream.toml?"));
    CHECK(holds(answer("", "tow_stream"), "there are: "));
    CHECK(holds(answer("", "flip/cases/sod.toml"), "is a case of flip, not of cic"));
    // A folder of someone's own is no method of the project.
    write_all(room.path("mine/cases/slip.toml"), "[specie.x]\n");
    const Outcome own =
        room.run("cd " + room.path("") + "; " + fs::absolute(program("cic")).string() +
                 " mine/cases/slip.toml --dry-run");
    CHECK(own.status == 2);
    CHECK(!holds(own.err, "is a case of"));
    CHECK(holds(answer("[specie.x]\n", ""), "did you mean [species.x]?"));
    CHECK(holds(answer("[specie.x]\ndensity = 1\n", ""), "did you mean 'species.x.density'?"));
    CHECK(holds(answer("[time]\nend = 1é\n", ""), "slip.toml:2:8: 'é' may stand in text"));
    CHECK(holds(answer("[time]\nx = \"é \\\\\" é\n", ""), "slip.toml:2:12: 'é' may stand in text"));
    for (const std::string quotes : {"\"\"\"", "\x27\x27\x27"})
        CHECK(holds(answer("x = " + quotes + "a\nb" + quotes + " é\n", ""),
                    "slip.toml:1:5: write text between single quotes, on one line"));
    CHECK(holds(answer("# é\n[time]\né = 1\n", ""), "slip.toml:3:1: 'é' may stand in text"));
    CHECK(room.run(program("cic") + " species.right.drift_x=-.5 --dry-run").status == 0);
}
