// Whole runs of a program that are repeated, continued, interrupted and compared byte by byte.
#pragma once

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/any_program.hpp"
#include "tests/support/any_summary.hpp"

namespace facts {

/// Where the folders of a test are.
inline std::string room() { return folder_of_test() + "/runs"; }

/// A clean folder name of this test's own.
inline std::string folder(const std::string& name) {
    const std::string path = room() + "/" + name;
    fs::remove_all(path);
    fs::create_directories(room());
    return path;
}

/// A program with arguments, as a shell reads them.
inline std::string command_line(const std::string& program, const std::string& arguments) {
    return std::string(BUILD_FOLDER) + "/" + program + " " + arguments;
}

/// A run into a folder. out: the exit status; what it says on stderr is kept beside that folder.
inline int run(const std::string& program, const std::string& arguments, const std::string& out) {
    return shell(command_line(program, arguments) + " --quiet --out " + out + " 2> " + out +
                 ".stderr");
}
inline int run(const Command& command, const std::string& out, const std::string& more = "") {
    return run(command.program->name,
               arguments_of({command.program, command.words + " " + more, {}}), out);
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
    const Columns all = columns_of(out + "/history.dat");
    REQUIRE(all.contains(name));
    REQUIRE(all.at(name).size() > 1);
    return all.at(name);
}

/// A process that runs a command of the shell; what it says on stderr is kept beside the folder.
inline pid_t started(const std::string& command, const std::string& out) {
    const pid_t child = fork();
    if (child == 0) {
        std::signal(SIGHUP, SIG_DFL);  // which nohup would have it ignore
        if (std::freopen((out + ".stderr").c_str(), "w", stderr) == nullptr) _exit(98);
        execl("/bin/sh", "sh", "-c", ("exec " + command + " --quiet --out " + out).c_str(),
              static_cast<char*>(nullptr));
        _exit(99);
    }
    return child;
}

/// Waits until something happens, ten seconds at most.
template <class Happens>
void wait_for(const Happens& happens) {
    for (int k = 0; k < 20000 && !happens(); ++k)
        std::this_thread::sleep_for(std::chrono::microseconds(500));
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

/// A run continued from its last but one checkpoint, by one thread, ends with the same bits.
/// in:     arguments, as a shell reads them, with output.checkpoint_steps
inline void check_restart(const std::string& program, const std::string& arguments) {
    const std::string whole = folder("whole"), rest = folder("rest");
    INFO(program << " " << arguments);
    REQUIRE(run(program, arguments, whole) == 0);
    const auto kept = checkpoints(whole);
    REQUIRE(kept.size() == 2);
    REQUIRE(run(program, "--restart " + kept[0] + " --threads 1", rest) == 0);
    CHECK(check_same_files(rest, whole) >= 3);
    CHECK(fs::exists(rest + "/history.dat"));
    CHECK(checkpoints(rest).size() == 1);
    CHECK(summary(rest)["results"] == summary(whole)["results"]);
}

/// Runs that end with status 3, one sentence after their warnings, a summary that says so, too, and
/// a history without numbers that are not finite.
/// in:     table, of commands and the sentence of each, a regular expression in which NUMBER is any
///         number
inline void check_failures(const std::string& table) {
    for (const Command& command : commands(table)) {
        const std::string out = folder("failed");
        const int status = run(command, out);
        const std::string text = said(out);
        INFO(command.program->name << " " << command.words << ": " << text);
        CHECK(status == 3);
        std::string pattern = "(warning: [^\n]*\n)*" + command.program->name + ": ";
        pattern += joined(command.expected) + "\n";
        pattern = std::regex_replace(pattern, std::regex("NUMBER"), "[-+.e0-9]+");
        INFO(pattern);
        CHECK(std::regex_match(text, std::regex(pattern)));
        CHECK(summary(out)["status"] == 3);
        CHECK(holds(text, summary(out)["message"].get<std::string>()));
        for (const char* wrong : {"nan", "inf"})
            CHECK(!holds(read_all(out + "/history.dat"), wrong));
    }
}

}  // namespace facts
