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

#include "tests/support/folder_of_test.hpp"

namespace facts {

namespace fs = std::filesystem;

/// The program that a test starts; every test says which one that is.
extern const std::string program_name;

inline fs::path program() { return fs::absolute(BUILD_FOLDER) / program_name; }

struct Row {
    std::string label;
    std::optional<std::string> bytes;  // of case.toml, if there is one
    std::string arguments;             // as a shell reads them
    std::string message;
};

using Files = std::map<std::string, std::string>;  // bytes by name

struct Outcome {
    int status = -1;
    std::string out, err;
    std::vector<std::string> sentences;  // lines of err that are no warnings
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

/// A folder of its own for each row, with what the rows refer to.
inline fs::path fresh_folder(const std::string& name) {
    const fs::path folder = fs::absolute(facts::folder_of_test()) / (program_name + "_input") /
                            std::regex_replace(name, std::regex("[^A-Za-z0-9]+"), "_");
    fs::remove_all(folder);
    write_all(folder / "a_file", "not a case\n");
    write_all(folder / "foreign/notes.txt", "notes\n");
    write_all(folder / "earlier/history.dat", "# an earlier run\n");
    write_all(folder / "earlier/summary.json", "{}\n");
    write_all(folder / "other.toml", "time.end = 3\n");
    fs::create_symlink("nowhere", folder / "dangling");
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

/// Starts the program in a folder; what it prints is kept beside that folder. A hang is status 124.
/// in: before, a command that starts the program.
inline Outcome start(const fs::path& folder, const std::string& arguments,
                     const std::string& before = "") {
    const std::string out = folder.string() + ".stdout", err = folder.string() + ".stderr";
    Outcome outcome;
    outcome.status =
        shell("cd '" + folder.string() + "' && exec timeout 20 " + before + " '" +
              program().string() + "' " + arguments + " </dev/null >'" + out + "' 2>'" + err + "'");
    outcome.out = read_all(out);
    outcome.err = read_all(err);
    std::istringstream lines(outcome.err);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("warning: ")) outcome.sentences.push_back(line);
    }
    return outcome;
}

/// Status 2, one clean sentence that holds the message, and the folder as it was.
inline void check_refusal(const fs::path& folder, const Row& row, const std::string& before = "") {
    const Files there = content(folder);
    const Outcome outcome = start(folder, (row.bytes ? "case.toml " : "") + row.arguments, before);
    const auto is_control = [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; };
    INFO(row.label << ": " << outcome.err);
    CHECK(outcome.status == 2);
    CHECK(holds(outcome.err, row.message));
    CHECK(outcome.sentences.size() == 1);
    CHECK(std::none_of(outcome.err.begin(), outcome.err.end(), is_control));
    CHECK(content(folder) == there);
}

inline void check_refused(const std::vector<Row>& rows, const Files& files = {}) {
    for (const Row& row : rows) {
        const fs::path folder = fresh_folder(row.label);
        for (const auto& [name, bytes] : files) write_all(folder / name, bytes);
        if (row.bytes) write_all(folder / "case.toml", *row.bytes);
        check_refusal(folder, row);
    }
}

/// Status 0, no sentence on stderr, and nothing written. out: what it prints.
inline Outcome check_described(const std::string& label, const std::string& bytes,
                               const std::string& arguments, const std::string& before = "") {
    const fs::path folder = fresh_folder(label);
    write_all(folder / "case.toml", bytes);
    const Files there = content(folder);
    const Outcome outcome = start(folder, "case.toml --dry-run " + arguments, before);
    INFO(label << ": " << outcome.err);
    CHECK(outcome.status == 0);
    CHECK(outcome.sentences.empty());
    CHECK(content(folder) == there);
    return outcome;
}

/// A dry run with these warnings and no other.
inline void check_warnings(const std::string& label, const std::string& bytes,
                           const std::string& arguments, const std::vector<std::string>& warnings) {
    const Outcome outcome = check_described(label, bytes, arguments);
    INFO(label << ": " << outcome.err);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') ==
          static_cast<long>(warnings.size()));
    for (const std::string& warning : warnings) CHECK(holds(outcome.err, warning));
}

/// Lines of what a dry run prints, each a regular expression that one line matches.
inline void check_lines(const std::string& out, const std::vector<std::string>& expected) {
    for (const std::string& line : expected) {
        INFO(line);
        std::istringstream lines(out);
        int found = 0;
        for (std::string text; std::getline(lines, text);)
            found += std::regex_match(text, std::regex(line)) ? 1 : 0;
        CHECK(found == 1);
    }
}

/// Every case that is shipped passes a dry run. out: how many there are.
template <class Mine>
int check_shipped_cases(const std::string& method, const Mine& mine) {
    int cases = 0;
    for (const auto& entry : fs::directory_iterator(method + "/cases")) {
        const std::string name = entry.path().stem();
        if (!mine(name)) continue;
        // Memory that nobody has set is no longer zero by chance.
        check_described(name, read_all(entry.path()), "", "env MALLOC_PERTURB_=85");
        check_described(name + " twice", read_all(entry.path()), "--quiet");
        ++cases;
    }
    return cases;
}
inline int check_shipped_cases() {
    return check_shipped_cases(program_name, [](const std::string&) { return true; });
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

/// A value outside of every range that --help lists is refused with that range. out: how many.
inline int check_ranges() {
    const std::regex above(R"((>=?) (\S+))"), between(R"((\S+) \.\.\. (\S+))");
    int enforced = 0;
    const std::string help = start(fresh_folder("list of ranges"), "--help").out;
    for (const Parameter& parameter : listed_in(help)) {
        const std::string name = std::regex_replace(parameter.name, std::regex("<name>"), "beam");
        std::vector<double> outside;
        std::smatch ends;
        if (std::regex_match(parameter.range, ends, above)) {
            outside = {std::stod(ends[2]) - (ends[1] == ">" ? 0 : 1)};
        } else if (std::regex_match(parameter.range, ends, between)) {
            outside = {std::stod(ends[1]) - 1, 2 * std::stod(ends[2]) + 1};
        }
        for (const double value : outside) {
            const std::string wrong = name + "=" + std::to_string(value);
            check_refused({{"range of " + wrong, std::nullopt, wrong,
                            " is out of range; allowed: " + parameter.range}});
            ++enforced;
        }
    }
    return enforced;
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

/// --help lists the options and all parameters; those are also the ones of the case that a run
/// writes, and their defaults, given as overrides, make the same case.
/// in:     text of a short case; overrides that make it one with a single species, "beam"
/// out:    the units of the parameters
inline std::map<std::string, std::string> check_help(const std::string& short_case,
                                                     const std::string& beam) {
    const fs::path folder = fresh_folder("help");
    const Outcome help = start(folder, "--help --out nowhere");
    CHECK(help.status == 0);
    CHECK(help.err.empty());
    CHECK(!fs::exists(folder / "nowhere"));
    for (const char* option : {"--out DIR", "--force", "--restart FILE", "--threads N", "--dry-run",
                               "--quiet", "--help", "--version"})
        CHECK(holds(help.out, option));
    CHECK(start(folder, "-h").out == help.out);

    // All parameters are in the case that a run writes, and nothing else is in the list.
    const std::vector<Parameter> parameters = listed_in(help.out);
    write_all(folder / "case.toml", short_case);
    REQUIRE(start(folder, "case.toml --quiet --out defaults").status == 0);
    REQUIRE(start(folder, "case.toml --quiet --out beam " + beam).status == 0);
    std::set<std::string> listed;
    for (const Parameter& p : parameters)
        listed.insert(std::regex_replace(p.name, std::regex("<name>"), "beam"));
    const std::set<std::string> written = keys_in(read_all(folder / "beam/case.toml"));
    CHECK(listed.size() == parameters.size());
    CHECK(listed == written);

    // The defaults, given as overrides of what the short case leaves to them, make the same case.
    const std::set<std::string> shortened = keys_in(short_case);
    std::string overrides;
    std::map<std::string, std::string> units;
    for (const Parameter& p : parameters) {
        INFO(p.name);
        CHECK(!p.range.empty());
        units[p.name] = p.unit;
        if (!holds(p.name, "<name>") && !shortened.contains(p.name))
            overrides += "'" + p.name + "=" + p.initial + "' ";
    }
    REQUIRE(start(folder, "case.toml --quiet --out again " + overrides).status == 0);
    CHECK(read_all(folder / "again/case.toml") == read_all(folder / "defaults/case.toml"));
    return units;
}

inline void check_version() {
    const Outcome version = start(fresh_folder("version"), "--version");
    CHECK(version.status == 0);
    CHECK(version.out == program_name + " " PROGRAM_VERSION "\n");
    CHECK(version.err.empty());
}

}  // namespace facts
