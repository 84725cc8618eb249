// The command line: options, one case file, overrides.
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "common/ranks.hpp"
#include "common/run/machine.hpp"
#include "common/run/run.hpp"
#include "common/run/sentence.hpp"

namespace common {

namespace {
namespace fs = std::filesystem;

constexpr std::array<const char*, 12> option_names{
    "--refine",  "--out",   "--force",  "--resume",  "--restart", "--verify",
    "--threads", "--quiet", "--strict", "--dry-run", "--help",    "--version"};

// An argument longer than a path may be is no path.
bool is_there(const std::string& argument) {
    std::error_code unreadable;
    return fs::exists(argument, unreadable);
}

// A file of the project, found from the program's own place (build/ in the project, or bin/ beside
// share/ where it is installed) or the current folder.
std::string find_in_project(const std::string& file) {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    for (fs::path folder = program.parent_path(); !error && folder.has_relative_path();
         folder = folder.parent_path()) {
        fs::path candidate = folder / file;
        if (!is_there(candidate)) candidate = folder / "share/particle-in-cell" / file;
        if (!is_there(candidate)) continue;
        const fs::path nearby = fs::relative(candidate, error);
        return !error && !nearby.empty() && nearby.begin()->string() != ".." ? nearby.string()
                                                                             : candidate.string();
    }
    return file;
}

// The cases of a program, for who has mistaken the path of one.
std::string list_cases(const ProgramInfo& info, const std::string& wrong) {
    const fs::path folder = fs::path(find_in_project(info.default_case)).parent_path();
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    if (const std::string name = fs::path(wrong).stem(); std::ranges::count(names, name) > 0)
        return "; did you mean " + (folder / name).string() + ".toml?";
    std::string list;
    for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
    return list.empty() ? "" : "; in " + folder.string() + "/ there are: " + list;
}

// For a case that cannot be read. errors: InputError where it lies in the folder of another method
void refuse_foreign_case(const ProgramInfo& info, const std::string& path, const std::string& why) {
    const fs::path folder = fs::weakly_canonical(path).parent_path();
    const std::string method = folder.parent_path().filename(), readme = method + "/README.md";
    const bool is_method = !method.empty() && fs::exists(find_in_project(readme));
    if (folder.filename() == "cases" && method != *fs::path(info.default_case).begin() && is_method)
        throw InputError(path + ": is a case of " + method + ", not of " + info.program +
                         "; its programs are named in " + readme + "; " + why);
}

// What a run that is to be resumed has left in its folder: all, a checkpoint, or nothing that counts. What is
// older than the program or of another input does not. errors: InputError for one of those that could go on
void look_for_earlier_run(const ProgramInfo& info, const ParameterTable& table,
                          CommandLine& command) {
    if (!command.dry_run) refuse_live_run(command.out_dir);
    std::error_code error;
    const auto built = fs::last_write_time("/proc/self/exe", error);
    const auto counts = [&](const fs::path& file) {
        return fs::is_regular_file(file, error) && fs::last_write_time(file, error) > built;
    };
    const bool forced = std::exchange(command.force, true);
    const fs::path folder = command.out_dir, input = folder / "case.toml",
                   summary = folder / "summary.json";
    const std::string effective_case = table.effective_case(),
                      found = fs::is_regular_file(input, error) ? read_file(input) : "",
                      text = counts(summary) ? read_file(summary) : "";
    const bool there = counts(input), same = found.starts_with("# " + info.program + " "),
               ours = there && same && found.ends_with("\n" + effective_case);
    if (ours && !text.empty()) {
        command.fell_short = text.find("\"verdict\": \"FAIL\"") != std::string::npos ||
                             text.find("\"verdict\": \"NOT MEASURED\"") != std::string::npos;
        // --strict asks for the verdicts, so the run ends once more.
        command.complete = text.find("\n  \"status\": 0,") != std::string::npos &&
                           !(command.strict && command.fell_short);
    }
    if (command.complete) return;
    std::vector<fs::path> checkpoints;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const bool named = entry.path().filename().string().starts_with("checkpoint_");
        if (named && entry.path().extension() == ".bin" && counts(entry.path()))
            checkpoints.push_back(entry.path());
    }
    std::sort(checkpoints.rbegin(), checkpoints.rend());
    const bool other = there && !ours,
               stopped = text.empty() || text.find("continue with: ") != std::string::npos;
    if (other && stopped && !checkpoints.empty())
        refuse(!forced, command.out_dir, ": holds a stopped run of another ",
               same ? "input: --restart " : "program: there --restart ",
               checkpoints.front().string(), " goes on with it, --force replaces it");
    for (const fs::path& path : checkpoints) {
        try {
            CheckpointReader checkpoint(info, path);
            checkpoint("step", command.restart_step);
            if (checkpoint.effective_case() == effective_case)
                return void(command.restart_path = path);
        } catch (const InputError& damaged) {  // or of another version
            if (is_first_rank())
                std::fprintf(stderr, "warning: %s; --resume begins before it\n", damaged.what());
        }
    }
    const char* const whose = there ? same ? "other input" : "other program" : " older program";
    if (!ours && !found.empty() && is_first_rank() && !command.dry_run)
        std::fprintf(stderr, "%s: replaces the run of an%s in %s\n", info.program.c_str(), whose,
                     command.out_dir.c_str());
    command.restart_step = 0;
}

// Says whether a checkpoint is whole and of what it is, and ends the program.
// errors: InputError where it is not
[[noreturn]] void verify_checkpoint(const ProgramInfo& info, const std::string& path) {
    CheckpointReader checkpoint(info, path);
    long step = 0;
    checkpoint("step", step);
    std::printf("%s: whole; case '%s' of %s %s at step %ld, %ld blocks\n", path.c_str(),
                checkpoint.case_name().c_str(), info.program.c_str(), info.version.c_str(), step,
                checkpoint.blocks());
    std::exit(0);
}

// Runs a case on meshes with twice the cells, and where it is fixed half the time step, of the one
// before, prints how the errors of its results fall, and ends the program.
[[noreturn]] void refine(const ParameterTable& table, const CommandLine& command,
                         const std::vector<std::string>& overrides) {
    std::vector<nlohmann::ordered_json> found;
    int status = 0;
    for (int n = 0; n < command.refine; ++n) {
        // SIGTERM that ends this program ends the run, too.
        std::string finer, line = "exec setpriv --pdeathsig TERM " + shell_word(command.program) +
                                  " " + shell_word(command.case_path);
        for (const Setting& one : read_case(table.effective_case(), command.case_path)) {
            const long cells = one.name.starts_with("grid.cells_") ? std::get<long>(one.value) : 0;
            const double* dt = one.name == "time.dt" ? std::get_if<double>(&one.value) : nullptr;
            if (cells > 1) finer += " " + one.name + "=" + std::to_string(cells << n);
            if (dt != nullptr && *dt > 0) finer += " time.dt=" + number_text(std::ldexp(*dt, -n));
        }
        for (const std::string& one : overrides)
            if (finer.find(' ' + one.substr(0, one.find('=') + 1)) == std::string::npos)
                line += ' ' + shell_word(one);
        const std::string folder = command.out_dir + "/" + std::to_string(n + 1);
        line += finer + (command.dry_run ? " --dry-run --out " : " --quiet --out ") +
                shell_word(folder);
        if (command.threads > 0) line += " --threads " + std::to_string(command.threads);
        line += std::string(command.force ? " --force" : "") + (command.resume ? " --resume" : "") +
                (command.strict ? " --strict" : "");
        std::printf("%d:%s\n", n + 1, finer.c_str()), std::fflush(stdout);
        const int ended = std::system(line.c_str());
        status = std::max(status, WIFEXITED(ended) ? WEXITSTATUS(ended) : 130);
        if (status > 1) break;
        if (!command.dry_run)
            found.push_back(nlohmann::ordered_json::parse(read_file(folder + "/summary.json")));
    }
    if (found.empty()) std::exit(status);
    const char* head =
        "error on each mesh, or value below a bound, and its order: log2 of before/it\n";
    for (const auto& result : found.back()["results"].items()) {
        const char* const of = result.value().contains("at_most") ? "at_most" : "expected";
        if (!result.value().contains(of)) continue;
        std::printf("%s%-26s", std::exchange(head, ""), result.key().c_str());
        double before = NAN;
        for (const auto& json : found) {
            const auto one = json["results"].value(result.key(), nlohmann::ordered_json::object());
            if (!one.contains(of)) std::printf(" %11s", "-");
            if (!one.contains(of)) continue;
            const double expected = one.value("expected", 0.0),
                         error = std::fabs(double(one["value"]) - expected),
                         bound = one.value("at_most", std::fabs(expected));
            // What a scheme has exactly differs by rounding, which has no order.
            const bool order = before > 0 && error > 1e-10 * bound && (*of == 'e' || bound > 1e-8);
            std::printf(" %11.4g", error);
            if (order)
                std::printf(" (%5.2f)", std::log2(before / error));
            else if (before >= 0)
                std::printf(" (    -)");
            before = error;
        }
        std::printf("\n");
    }
    if (*head) std::printf("no result has an expected number, so none has an error\n");
    std::exit(status);
}

void apply_override(const std::string& argument, ParameterTable& table) {
    const std::string place = "command line: '" + argument + "'";
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    std::string value = argument.substr(equals + 1);
    const bool is_name = !name.empty() && std::ranges::all_of(name, [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-';
    });
    if (!is_name) throw InputError(place + ": write section.key=value");
    const bool quoted = !value.empty() && (value.front() == '"' || value.front() == '\'');
    const std::optional<bool> is_text = table.takes_text(name, value);
    // A name that is none is refused whatever its value; {} may be that of a section.
    if (!is_text && !value.starts_with('{')) return table.set({name, value, place});
    if (value.find('\n') != std::string::npos) throw InputError(place + ": one line, one value");
    std::vector<Setting> settings;
    try {
        const bool bare = is_text.value_or(false) && !quoted;
        settings = read_case(name + " = " + (bare ? "'" + value + "'" : value), place);
    } catch (const InputError&) {
        if (is_text.value_or(true) || quoted) throw;
        // Numbers are written .5, 1. and 01, too; what is none is refused as text.
        char* end = nullptr;
        const double number = std::strtod(value.c_str(), &end);
        settings = {{name, value, place}};
        if (end != value.c_str() && *end == '\0') settings[0].value = number;
    }
    for (const Setting& setting : settings) table.set(setting);
}

int whole_number(const std::string& option, const std::string& text, long low, long high) {
    char* end = nullptr;
    errno = 0;
    const long number = std::strtol(text.c_str(), &end, 10);
    refuse(text.empty() || *end != '\0' || errno != 0 || number < low || number > high, option,
           " takes a whole number from ", low, " to ", high, ", not '", text, "'");
    return int(number);
}

void print_help(const ProgramInfo& info, const ParameterTable& table) {
    std::printf(
        "%s %s: %s\n\n"
        "usage: %s [case.toml] [section.key=value ...] [options]\n\n"
        "  without a case file: %s\n"
        "  --out DIR       folder of the results; default out/%s/<case name>\n"
        "  --force         replace an earlier run in that folder\n"
        "  --resume        go on with an earlier run of the same input in that folder; if there\n"
        "                  is none, or the program is newer, begin; if complete, do nothing\n"
        "  --restart FILE  continue from a checkpoint\n"
        "  --verify FILE   say whether a checkpoint is whole, and of what it is\n"
        "  --refine N      run the case on N meshes, each of twice the cells and half time.dt if\n"
        "                  set, in DIR/1, 2 ..., and show the order at which their errors fall\n"
        "  --threads N     number of threads, else the free cores, or one for short steps\n"
        "  --dry-run       show scales, memory and time, and write nothing\n"
        "  --quiet         no progress, no report; what fell short is still said\n"
        "  --strict        status 1 where a result fell short\n"
        "  --help, --version\n\n"
        "status: 0 done; 1 only with --strict; 2 bad input; 3 numerical failure; 129, 130 or\n"
        "        143 stopped after a checkpoint by a terminal that closes, Ctrl-C or SIGTERM; a\n"
        "        second Ctrl-C kills at once\n"
        "A folder takes one run at a time. --dry-run tells the memory, and a case that needs more\n"
        "than there is (machine, control group, ulimit) is refused.\n%s%s",
        info.program.c_str(), info.version.c_str(), info.one_line.c_str(), info.program.c_str(),
        info.default_case.c_str(), info.program.c_str(),
        has_ranks ? "mpirun -n N: N ranks share the particles, with the same bytes; a signal to "
                    "one of them\n"
                    "checkpoints and ends all.\n"
                  : "",
        table.help().c_str());
}

}  // namespace

void refuse_unreadable(const std::string& path) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (!fs::exists(status)) throw InputError(path + ": there is no such file");
    if (fs::is_directory(status)) throw InputError(path + ": is a folder, not a file");
    if (!fs::is_regular_file(status)) throw InputError(path + ": is not a regular file");
}

std::string read_file(const std::string& path) {
    refuse_unreadable(path);
    std::ifstream file(path, std::ios::binary);
    std::string content;
    for (char piece[4096]; file.good();) {
        file.read(piece, sizeof piece);
        content.append(piece, std::size_t(file.gcount()));
    }
    if (!file.eof()) throw InputError(path + ": cannot be read: " + std::strerror(errno));
    return content;
}

CommandLine read_command_line(int argc, char** argv, const ProgramInfo& info,
                              ParameterTable& table) {
    CommandLine command;
    command.program = argv[0];
    table.describe_expectation();
    std::vector<std::string> overrides;
    std::string to_verify;
    bool help = false, version = false;
    const std::map<std::string, std::string*> paths{{"--out", &command.out_dir},
                                                    {"--restart", &command.restart_path},
                                                    {"--verify", &to_verify}};
    const std::map<std::string, bool*> flags{{"--dry-run", &command.dry_run},
                                             {"--quiet", &command.quiet},
                                             {"--force", &command.force},
                                             {"--resume", &command.resume},
                                             {"--strict", &command.strict},
                                             {"--version", &version},
                                             {"--help", &help},
                                             {"-h", &help}};
    std::set<std::string> seen;
    for (int k = 1; k < argc; ++k) {
        std::string argument = argv[k], value;
        const bool is_option = argument.compare(0, 1, "-") == 0;
        const std::size_t equals = argument.find('=');
        const bool joined = is_option && equals != std::string::npos;
        if (joined) value = argument.substr(equals + 1), argument.resize(equals);
        const auto value_of = [&]() -> std::string {
            refuse(!seen.insert(argument).second, argument, " is given twice; keep one of them");
            if (joined) return value;
            const bool number = argument == "--threads" || argument == "--refine";
            refuse(k + 1 >= argc || std::strncmp(argv[k + 1], "--", 2) == 0, argument,
                   " needs a value: ", argument, number ? " 2" : " PATH");
            return argv[++k];
        };
        if (const auto path = paths.find(argument); path != paths.end()) {
            *path->second = value_of();
            refuse(path->second->empty(), argument, " needs a path that is not empty");
        } else if (argument == "--threads") {
            command.threads = whole_number(argument, value_of(), 1, 1024);
        } else if (argument == "--refine") {
            command.refine = whole_number(argument, value_of(), 1, 10);
        } else if (is_option && joined) {
            refuse(true, "'", argument,
                   "' takes no value, or is unknown; --help lists all options");
        } else if (const auto flag = flags.find(argument); flag != flags.end()) {
            *flag->second = true;
        } else if (is_option) {
            std::string guess;
            for (const std::string name : option_names)
                if (name.starts_with(argument.substr(0, 4))) guess = name;
            refuse(
                true, "unknown option '", argument,
                guess.empty() ? "'; --help lists all options" : "'; did you mean '" + guess + "'?");
        } else if (argument.find('=') != std::string::npos && !is_there(argument)) {
            overrides.push_back(argument);
        } else if (argument.empty()) {
            throw InputError("an empty argument: give the path of a case file, or leave it out");
        } else if (command.case_path.empty()) {
            command.case_path = is_there(argument) ? argument : find_in_project(argument);
        } else {
            refuse(true, "two case files, '", command.case_path, "' and '", argument,
                   "': give one (overrides are written section.key=value)");
        }
    }
    if (help) print_help(info, table);
    if (version && !help) std::printf("%s %s\n", info.program.c_str(), info.version.c_str());
    if (help || version) std::exit(0);
    if (!to_verify.empty()) verify_checkpoint(info, to_verify);

    const bool restarting = !command.restart_path.empty();
    if (restarting) {
        refuse(command.refine > 0, "--refine begins runs of its own: leave out --restart, or it");
        refuse(!command.case_path.empty(),
               "--restart takes its case from the checkpoint: leave out '", command.case_path, "'");
        refuse(command.resume, "--resume finds the checkpoint itself: leave out --restart, or it");
        CheckpointReader checkpoint(info, command.restart_path);
        checkpoint("step", command.restart_step);
        for (const Setting& setting : read_case(checkpoint.effective_case(), command.restart_path))
            table.set(setting);
        refuse(table.effective_case() != checkpoint.effective_case(), command.restart_path,
               ": the case in it lacks parameters: continue it with the build that wrote it");
        command.case_name = checkpoint.case_name();
        if (command.out_dir.empty())
            command.out_dir = fs::path(command.restart_path).parent_path().string();
        if (command.out_dir.empty()) command.out_dir = ".";
    } else {
        if (command.case_path.empty()) command.case_path = find_in_project(info.default_case);
        if (!is_there(command.case_path))
            throw InputError(command.case_path + ": there is no such file" +
                             list_cases(info, command.case_path));
        command.case_name = fs::path(command.case_path).stem().string();
        try {
            for (const Setting& one : read_case(read_file(command.case_path), command.case_path))
                table.set(one);
        } catch (const InputError& error) {
            refuse_foreign_case(info, command.case_path, error.what());
            throw;
        }
        if (command.out_dir.empty())
            command.out_dir = "out/" + info.program + "/" + command.case_name +
                              (command.refine > 0 ? "_refined" : "");
    }
    for (const std::string& one : overrides) {
        const std::string name = one.substr(0, one.find('='));
        refuse(!seen.insert(name).second, "command line: '", one, "': '", name,
               "' is given twice; keep one of them");
        const std::string before = table.effective_case();
        apply_override(one, table);
        refuse(restarting && !table.is_changeable(name) && table.effective_case() != before,
               "command line: '", one, "': '", name,
               "' cannot change on a restart; start a new run with it");
    }
    refuse(command.refine > 0 && rank_count() > 1,
           "--refine begins programs of its own: leave out mpirun, or it");
    if (command.refine > 0) refine(table, command, overrides);
    table.derive();
    if (command.resume) look_for_earlier_run(info, table, command);
    return command;
}

}  // namespace common
