// The command line: options, one case file, overrides.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "common/run/checkpoint.hpp"
#include "common/run/parameters.hpp"

namespace common {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 8> option_names{"--out",   "--restart", "--threads", "--dry-run",
                                                  "--quiet", "--force",   "--help",    "--version"};

// An argument longer than a path may be is no path.
bool is_there(const std::string& argument) {
    std::error_code unreadable;
    return fs::exists(argument, unreadable);
}

// The default case, found from the program's own place (build/ in the project) or the current
// folder.
std::string find_default_case(const ProgramInfo& info) {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    for (fs::path folder = program.parent_path(); !error && folder.has_relative_path();
         folder = folder.parent_path()) {
        const fs::path candidate = folder / info.default_case;
        if (!fs::exists(candidate)) continue;
        const fs::path nearby = fs::relative(candidate, error);
        return !error && !nearby.empty() && nearby.begin()->string() != ".." ? nearby.string()
                                                                             : candidate.string();
    }
    return info.default_case;
}

void apply_override(const std::string& argument, bool restarting, ParameterTable& table) {
    const std::string place = "command line: '" + argument + "'";
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    std::string value = argument.substr(equals + 1);
    const bool is_name = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-';
    });
    if (!is_name) throw InputError(place + ": write section.key=value");
    if (restarting && !table.is_changeable(name)) {
        throw InputError(place + ": '" + name +
                         "' cannot change on a restart; start a new run with it");
    }
    const bool quoted = !value.empty() && (value.front() == '"' || value.front() == '\'');
    if (table.takes_text(name) && !quoted) value = "'" + value + "'";
    if (value.find('\n') != std::string::npos) throw InputError(place + ": one line, one value");
    for (const Setting& setting : read_case(name + " = " + value, place)) table.set(setting);
}

int thread_number(const std::string& text) {
    char* end = nullptr;
    errno = 0;
    const long threads = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || errno != 0 || threads < 1 || threads > 1024) {
        throw InputError("--threads takes a whole number from 1 to 1024, not '" + text + "'");
    }
    return static_cast<int>(threads);
}

void print_help(const ProgramInfo& info, const ParameterTable& table) {
    std::printf(
        "%s %s: %s\n\n"
        "usage: %s [case.toml] [section.key=value ...] [options]\n\n"
        "  without a case file: %s\n"
        "  --out DIR       folder of the results; default out/%s/<case name>\n"
        "  --force         replace an earlier run in that folder\n"
        "  --restart FILE  continue from a checkpoint\n"
        "  --threads N     number of threads; results do not depend on it\n"
        "  --dry-run       show scales, memory and time, and write nothing\n"
        "  --quiet         no progress, no report\n"
        "  --help, --version\n%s",
        info.program.c_str(), info.version.c_str(), info.one_line.c_str(), info.program.c_str(),
        info.default_case.c_str(), info.program.c_str(), table.help().c_str());
}

}  // namespace

std::string read_file(const std::string& path) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (!fs::exists(status)) throw InputError(path + ": there is no such file");
    if (fs::is_directory(status)) throw InputError(path + ": is a folder, not a file");
    if (!fs::is_regular_file(status)) throw InputError(path + ": is not a regular file");
    std::ifstream file(path, std::ios::binary);
    std::string content;
    for (char piece[4096]; file.good();) {
        file.read(piece, sizeof piece);
        content.append(piece, static_cast<std::size_t>(file.gcount()));
    }
    if (!file.eof()) throw InputError(path + ": cannot be read: " + std::strerror(errno));
    return content;
}

CommandLine read_command_line(int argc, char** argv, const ProgramInfo& info,
                              ParameterTable& table) {
    CommandLine command;
    std::vector<std::string> overrides;
    bool help = false, version = false;
    for (int k = 1; k < argc; ++k) {
        std::string argument = argv[k], value;
        const bool is_option = argument.compare(0, 1, "-") == 0;
        const std::size_t equals = argument.find('=');
        const bool joined = is_option && equals != std::string::npos;
        if (joined) value = argument.substr(equals + 1), argument.resize(equals);
        const auto value_of = [&]() -> std::string {
            if (joined) return value;
            if (k + 1 >= argc || std::strncmp(argv[k + 1], "--", 2) == 0) {
                throw InputError(argument + " needs a value: " + argument +
                                 (argument == "--threads" ? " 2" : " PATH"));
            }
            return argv[++k];
        };
        if (argument == "--out" || argument == "--restart") {
            (argument == "--out" ? command.out_dir : command.restart_path) = value_of();
            if ((argument == "--out" ? command.out_dir : command.restart_path).empty()) {
                throw InputError(argument + " needs a path that is not empty");
            }
        } else if (argument == "--threads") {
            command.threads = thread_number(value_of());
        } else if (is_option && joined) {
            throw InputError("'" + argument +
                             "' takes no value, or is unknown; --help lists all options");
        } else if (argument == "--dry-run") {
            command.dry_run = true;
        } else if (argument == "--quiet") {
            command.quiet = true;
        } else if (argument == "--force") {
            command.force = true;
        } else if (argument == "--help" || argument == "-h") {
            help = true;
        } else if (argument == "--version") {
            version = true;
        } else if (is_option) {
            std::string guess;
            for (const char* name : option_names) {
                if (std::strncmp(name, argument.c_str(),
                                 std::min<std::size_t>(4, argument.size())) == 0)
                    guess = name;
            }
            throw InputError(
                "unknown option '" + argument + "'" +
                (guess.empty() ? "; --help lists all options" : "; did you mean '" + guess + "'?"));
        } else if (argument.find('=') != std::string::npos && !is_there(argument)) {
            overrides.push_back(argument);
        } else if (argument.empty()) {
            throw InputError("an empty argument: give the path of a case file, or leave it out");
        } else if (command.case_path.empty()) {
            command.case_path = argument;
        } else {
            throw InputError("two case files, '" + command.case_path + "' and '" + argument +
                             "': give one (overrides are written section.key=value)");
        }
    }
    if (help || version) {
        if (help) print_help(info, table);
        if (!help) std::printf("%s %s\n", info.program.c_str(), info.version.c_str());
        std::exit(0);
    }

    const bool restarting = !command.restart_path.empty();
    if (restarting) {
        if (!command.case_path.empty()) {
            throw InputError("--restart takes its case from the checkpoint: leave out '" +
                             command.case_path + "'");
        }
        CheckpointReader checkpoint(info, command.restart_path);
        checkpoint("step", command.restart_step);
        for (const Setting& setting : read_case(checkpoint.effective_case(), command.restart_path))
            table.set(setting);
        command.case_name = "restart";
        if (command.out_dir.empty())
            command.out_dir = fs::path(command.restart_path).parent_path().string();
        if (command.out_dir.empty()) command.out_dir = ".";
    } else {
        if (command.case_path.empty()) command.case_path = find_default_case(info);
        command.case_name = fs::path(command.case_path).stem().string();
        for (const Setting& setting : read_case(read_file(command.case_path), command.case_path))
            table.set(setting);
        if (command.out_dir.empty())
            command.out_dir = "out/" + info.program + "/" + command.case_name;
    }
    std::set<std::string> seen;
    for (const std::string& one : overrides) {
        const std::string name = one.substr(0, one.find('='));
        if (!seen.insert(name).second) {
            throw InputError("command line: '" + one + "': '" + name +
                             "' is given twice; keep one of them");
        }
        apply_override(one, restarting, table);
    }
    return command;
}

}  // namespace common
