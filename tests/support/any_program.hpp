// A program that is started from outside, and what it may never do with wrong input.
#pragma once

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/every_program.hpp"
#include "tests/support/folder_of_test.hpp"

namespace facts {

namespace fs = std::filesystem;

inline fs::path path_of(const Program& program) {
    return fs::absolute(BUILD_FOLDER) / program.name;
}

using Files = std::map<std::string, std::string>;  // bytes by name

struct Outcome {
    int status = -1;
    std::string out, err;
    std::vector<std::string> sentences;  // lines of err that are no warnings and no verdicts
};

inline std::string read_all(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_all(const fs::path& path, const std::string& bytes) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
}

inline bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline std::string repeated(const std::string& text, int times) {
    std::string result;
    for (int k = 0; k < times; ++k) result += text;
    return result;
}

/// A command as a shell reads it. out: the exit status, or 128 and the signal that ended it.
inline int shell(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The case file and the arguments that the words of a command stand for, as a shell reads them.
/// note:   a command that names no case file starts from an empty one, which is written here
inline std::string arguments_of(const Command& command) {
    Arguments found;
    expand(command.words, *command.program, found);
    fs::path file = fs::absolute(folder_of_test()) / "empty.toml";
    if (found.file.empty())
        write_all(file, "");
    else
        file = fs::absolute(found.file);
    std::string arguments = "'";
    arguments += file.string() + "'";
    for (const auto& [key, value] : found.overrides) arguments += " " + key + "=" + value;
    return arguments + found.options;
}

/// A folder of its own for each start, with what the rows refer to.
inline fs::path fresh_folder(const Program& program, const std::string& name = "here") {
    const fs::path folder = fs::absolute(folder_of_test()) / program.name / name;
    fs::remove_all(folder);
    write_all(folder / "a_file", "not a case\n");
    write_all(folder / "foreign/notes.txt", "notes\n");
    write_all(folder / "earlier/history.dat", "# an earlier run\n");
    write_all(folder / "earlier/summary.json", "{}\n");
    write_all(folder / "other.toml", "time.end = 3\n");
    fs::create_symlink("nowhere", folder / "dangling");
    // The published tables that a comparison reads.
    fs::create_directory_symlink(fs::absolute(program.method), folder / program.method);
    return folder;
}

/// Names and contents of all that is in a folder.
inline Files content(const fs::path& folder) {
    Files found;
    const auto all = fs::directory_options::skip_permission_denied;
    for (const auto& entry : fs::recursive_directory_iterator(folder, all))
        found[entry.path()] = entry.is_regular_file() ? read_all(entry.path()) : "";
    return found;
}

/// Starts a program in a folder; what it prints is kept beside that folder. A hang is status 124.
/// in: before, a command that starts the program.
inline Outcome start(const Program& program, const fs::path& folder, const std::string& arguments,
                     const std::string& before = "") {
    const std::string out = folder.string() + ".stdout", err = folder.string() + ".stderr";
    fs::remove(out), fs::remove(err);
    Outcome outcome;
    outcome.status = shell("cd '" + folder.string() + "' && exec timeout 60 " + before + " '" +
                           path_of(program).string() + "' " + arguments + " </dev/null >'" + out +
                           "' 2>'" + err + "'");
    outcome.out = read_all(out);
    outcome.err = read_all(err);
    std::istringstream lines(outcome.err);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("warning: ") && !holds(line, ": FAIL ") &&
            !holds(line, ": NOT MEASURED "))
            outcome.sentences.push_back(line);
    }
    return outcome;
}

/// Status 2, one clean sentence that holds the message, and the folder as it was.
inline void check_refusal(const Program& program, const fs::path& folder,
                          const std::string& arguments, const std::string& message,
                          const std::string& before = "") {
    const Files there = content(folder);
    const Outcome outcome = start(program, folder, arguments, before);
    const auto is_control = [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; };
    INFO(program.name << " " << arguments << ": " << outcome.err);
    CHECK(outcome.status == 2);
    INFO("expected: " << message);
    CHECK(holds(outcome.err, message));
    CHECK(outcome.sentences.size() == 1);
    CHECK(std::none_of(outcome.err.begin(), outcome.err.end(), is_control));
    CHECK(content(folder) == there);
}

/// A command and the sentence that refuses it.
inline void check_refusal(const Command& command, const std::string& sentence) {
    const Program& program = *command.program;
    check_refusal(program, fresh_folder(program), arguments_of(command), sentence);
}

/// Commands, each with the sentence that refuses it.
inline void check_refused(const std::string& table) {
    for (const Command& command : commands(table)) {
        REQUIRE(!command.expected.empty());
        check_refusal(command, joined(command.expected));
    }
}

struct Row {
    std::string label;
    std::optional<std::string> bytes;  // of case.toml, if there is one
    std::string arguments;             // as a shell reads them
    std::string message;
};

inline void check_refused(const Program& program, const std::vector<Row>& rows,
                          const Files& files = {}) {
    for (const Row& row : rows) {
        INFO(row.label);
        const fs::path folder = fresh_folder(program);
        for (const auto& [name, bytes] : files) write_all(folder / name, bytes);
        if (row.bytes) write_all(folder / "case.toml", *row.bytes);
        check_refusal(program, folder, (row.bytes ? "case.toml " : "") + row.arguments,
                      row.message);
    }
}

/// Status 0, no sentence on stderr, and nothing written. out: what it prints.
inline Outcome check_described(const Program& program, const std::string& arguments,
                               const std::string& before = "", const std::string& bytes = "") {
    const fs::path folder = fresh_folder(program);
    write_all(folder / "case.toml", bytes);
    const Files there = content(folder);
    const Outcome outcome = start(program, folder, arguments + " --dry-run", before);
    INFO(program.name << " " << arguments << ": " << outcome.err);
    CHECK(outcome.status == 0);
    CHECK(outcome.sentences.empty());
    CHECK(content(folder) == there);
    return outcome;
}
inline Outcome check_described(const Command& command) {
    return check_described(*command.program, arguments_of(command));
}

/// The text of a case is understood; out: what a dry run of it prints.
inline std::string description(const Program& program, const std::string& bytes,
                               const std::string& arguments = "") {
    return check_described(program, "case.toml " + arguments, "", bytes).out;
}

/// Dry runs, each with its warnings, which begin with that word, and no other.
inline void check_warnings(const std::string& table) {
    for (const Command& command : commands(table)) {
        std::vector<std::string> warnings;
        for (const std::string& line : command.expected) {
            if (line == "no warning") continue;
            if (line.starts_with("warning: "))
                warnings.push_back(line);
            else
                warnings.back() += " " + line;
        }
        REQUIRE(!command.expected.empty());
        const Outcome outcome = check_described(command);
        INFO(command.words << ": " << outcome.err);
        CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == long(warnings.size()));
        for (const std::string& warning : warnings) {
            INFO(warning);
            CHECK(holds(outcome.err, warning));
        }
    }
}

/// Dry runs, each with lines of what it prints: regular expressions that one line matches.
inline void check_descriptions(const std::string& table) {
    for (const Command& command : commands(table)) {
        const std::string out = check_described(command).out;
        REQUIRE(!command.expected.empty());
        CHECK(!holds(out, "nan"));
        for (const std::string& expected : command.expected) {
            INFO(expected << " in: " << out);
            std::istringstream lines(out);
            int found = 0;
            for (std::string line; std::getline(lines, line);)
                found += std::regex_match(line, std::regex(" *" + expected)) ? 1 : 0;
            CHECK(found == 1);
        }
    }
}

/// Runs that end with status 0, without a sentence, and with numbers only.
inline void check_accepted(const std::string& table) {
    for (const Command& command : commands(table)) {
        REQUIRE(command.expected.empty());
        const fs::path folder = fresh_folder(*command.program);
        write_all(folder / "a pack's file.txt", "disk a 0.3 0.3 0.1");
        const Outcome outcome =
            start(*command.program, folder, arguments_of(command) + " --quiet --out run");
        INFO(command.program->name << " " << command.words << ": " << outcome.err);
        CHECK(outcome.status == 0);
        CHECK(outcome.sentences.empty());
        CHECK(fs::exists(folder / "run/summary.json"));
        CHECK(!holds(read_all(folder / "run/history.dat"), "nan"));
    }
}

struct Parameter {
    std::string name, unit, range, initial;
};

/// The parameters that --help lists, each in two lines: name, meaning and unit; range and default.
inline std::vector<Parameter> listed_in(const std::string& help) {
    std::istringstream lines(help);
    const std::regex first(R"(  ([a-z_]+(?:\.[A-Za-z_<>]+)+) +\S.*?(?: \[([^\]]+)\])?)"),
        second(R"( {10,}(\S.*); default (.+))");
    std::vector<Parameter> parameters;
    std::string line, next;
    std::smatch one, two;
    while (std::getline(lines, line)) {
        if (!std::regex_match(line, one, first)) continue;
        std::getline(lines, next);
        INFO(line << " / " << next);
        REQUIRE(std::regex_match(next, two, second));
        parameters.push_back({one[1], one[2], two[1], two[2]});
    }
    return parameters;
}

/// The parameters that the text of a case sets.
inline std::set<std::string> keys_in(const std::string& text) {
    std::set<std::string> keys;
    std::istringstream lines(text);
    const std::regex section(R"(\[(.+)\])"), key(R"(([\w.]+) = .+)");
    std::smatch match;
    for (std::string line, prefix; std::getline(lines, line);) {
        if (std::regex_match(line, match, section)) prefix = match.str(1) + ".";
        if (std::regex_match(line, match, key)) keys.insert(prefix + match.str(1));
    }
    return keys;
}

}  // namespace facts
