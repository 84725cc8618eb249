// Whole runs of a program that are repeated, continued, interrupted and compared byte by byte.
#pragma once

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/any_program.hpp"
#include "tests/support/folder_of_test.hpp"

namespace facts {

/// Where the folders of a test are.
inline std::string room() { return facts::folder_of_test() + "/" + program_name + "_run"; }

/// A clean folder name of this test's own.
inline std::string folder(const std::string& name) {
    const std::string path = room() + "/" + name;
    fs::remove_all(path);
    fs::create_directories(room());
    return path;
}

/// The program with these arguments, as a shell reads them.
inline std::string command(const std::string& arguments) {
    return std::string(BUILD_FOLDER) + "/" + program_name + arguments;
}

/// A run into a folder. out: the exit status; what it says on stderr is kept beside that folder.
inline int run(const std::string& arguments, const std::string& out) {
    return shell(command(arguments) + " --quiet --out " + out + " 2> " + out + ".stderr");
}
inline std::string said(const std::string& out) { return read_all(out + ".stderr"); }

inline std::vector<std::string> checkpoints(const std::string& out) {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(out)) {
        if (entry.path().extension() == ".bin") found.push_back(entry.path().string());
    }
    std::sort(found.begin(), found.end());
    return found;
}

inline nlohmann::json summary(const std::string& out) {
    const std::string text = read_all(out + "/summary.json");
    REQUIRE(!text.empty());
    return nlohmann::json::parse(text);
}

/// The values of a column of a history.
inline std::vector<double> column(const std::string& out, const std::string& name) {
    std::ifstream file(out + "/history.dat");
    std::string words;
    std::getline(file, words);
    const std::size_t end = words.find(":" + name + "[");
    REQUIRE(end != std::string::npos);
    const std::size_t begin = words.rfind(' ', end) + 1;
    const int number = std::stoi(words.substr(begin, end - begin));
    std::vector<double> values;
    while (std::getline(file, words)) {
        std::istringstream row(words);
        double value = 0;
        for (int k = 0; k < number; ++k) row >> value;
        values.push_back(value);
    }
    REQUIRE(values.size() > 1);
    return values;
}

/// The rows of a history without the names of its columns.
inline std::string rows(const std::string& out) {
    const std::string text = read_all(out + "/history.dat");
    return text.substr(text.find('\n') + 1);
}

/// Starts a long run, waits until its history has grown, and sends a signal. The exit status.
inline int interrupted(const std::string& arguments, const std::string& out, int signal) {
    const pid_t child = fork();
    if (child == 0) {
        if (std::freopen((out + ".stderr").c_str(), "w", stderr) == nullptr) _exit(98);
        std::vector<std::string> words;
        std::istringstream split(command(arguments) + " --quiet --out " + out);
        for (std::string word; split >> word;) words.push_back(word);
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        execv(pointers[0], pointers.data());
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

/// The same history for any number of threads.
inline void check_threads(const std::string& arguments) {
    std::vector<std::string> histories;
    CAPTURE(arguments);
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = folder("threads");
        REQUIRE(run(arguments + " --threads " + threads, out) == 0);
        histories.push_back(read_all(out + "/history.dat"));
    }
    CHECK(histories[0].size() > 1000);
    CHECK(histories[1] == histories[0]);
    CHECK(histories[2] == histories[0]);
}

/// Every file of one folder that another one has, too, is the same there, but for the summary.
/// out: how many
inline int check_same_files(const std::string& some, const std::string& all) {
    int compared = 0;
    for (const auto& entry : fs::directory_iterator(some)) {
        const std::string name = entry.path().filename().string();
        if (name == "summary.json") continue;
        CAPTURE(name);
        CHECK(read_all(all + "/" + name) == read_all(entry.path()));
        ++compared;
    }
    return compared;
}

/// The effective case runs again to the same bytes. out: number of files
inline int check_runs_again(const std::string& arguments) {
    const std::string first = folder("first"), again = folder("again");
    CAPTURE(arguments);
    REQUIRE(run(arguments, first) == 0);
    REQUIRE(run(" " + first + "/case.toml", again) == 0);
    CHECK(check_same_files(again, first) == check_same_files(first, again));
    return check_same_files(first, again);
}

/// A run continued from its last but one checkpoint, by one thread, ends with the same bits.
/// in: steps from one checkpoint to the next
inline void check_restart(const std::string& arguments, int steps) {
    const std::string whole = folder("whole"), rest = folder("rest");
    CAPTURE(arguments);
    REQUIRE(run(arguments + " output.checkpoint_steps=" + std::to_string(steps), whole) == 0);
    const auto kept = checkpoints(whole);
    REQUIRE(kept.size() == 2);
    REQUIRE(run(" --restart " + kept[0] + " --threads 1", rest) == 0);
    CHECK(check_same_files(rest, whole) >= 3);
    CHECK(fs::exists(rest + "/history.dat"));
    CHECK(checkpoints(rest).size() == 1);
    CHECK(summary(rest)["results"] == summary(whole)["results"]);
}

/// A signal stops a run with its status and a checkpoint, from which ten more steps in the same
/// folder end as without the interruption.
/// in:     arguments without time.end; the time step
inline void check_interruption(const std::string& arguments, double dt, int signal, int status) {
    const std::string stopped = folder("stopped"), unstopped = folder("unstopped");
    CAPTURE(arguments);
    const int code =
        interrupted(arguments + " time.end=" + std::to_string(1e6 * dt), stopped, signal);
    CHECK(code == status);
    CHECK(summary(stopped)["status"] == status);
    const auto kept = checkpoints(stopped);
    REQUIRE(kept.size() == 1);
    const auto steps = std::stol(kept[0].substr(kept[0].size() - 14, 10));
    CHECK(steps > 0);
    const std::string end = " time.end=" + std::to_string(dt * static_cast<double>(steps + 10));
    REQUIRE(run(" --restart " + kept[0] + end, stopped) == 0);
    REQUIRE(run(arguments + end, unstopped) == 0);
    CHECK(read_all(stopped + "/history.dat") == read_all(unstopped + "/history.dat"));
}

/// A run ends with status 3, a sentence that holds the message, and a summary that says so, too.
inline void check_failure(const std::string& arguments, const std::string& message) {
    const std::string out = folder("failed");
    CAPTURE(arguments);
    CHECK(run(arguments, out) == 3);
    INFO(said(out));
    CHECK(holds(said(out), message));
    CHECK(summary(out)["status"] == 3);
    CHECK(holds(summary(out)["message"].get<std::string>(), message));
}

}  // namespace facts
