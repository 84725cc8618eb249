// One of the seven programs, started some hundred times a second with whatever libFuzzer thinks of,
// inside one process, under the sanitizers. An input is text:
//
//   words of the command line           or  forge NAME
//   lines of a case file, if any            lines that change a checkpoint, as in forge.hpp
//
// NAME is a run of tests/support/every_program.hpp. A run ends after some steps, or after the step
// in which its first second is over, as if by SIGTERM, and its memory is limited, so that each is
// short. What ends with a status outside the contract, or as an error that nobody expected, aborts;
// so does whatever a sanitizer finds.
//
// Run: sh tests/torture/inputs.sh PROGRAM FOLDER SECONDS
#define DOCTEST_CONFIG_DISABLE
#include <sys/mman.h>
#include <sys/resource.h>

#include <csetjmp>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>

#include "common/run/run.cpp"  // its signals belong to the process, which goes on
#include "tests/support/every_program.hpp"
#include "tests/torture/forge.hpp"

int program_main(int argc, char** argv);  // what the main of the program is called here

namespace {

namespace fs = std::filesystem;

constexpr int most_looks_at_clock = 12;  // a run looks once or twice in a step
constexpr rlim_t most_memory = 4 * 1024 * 1024;

jmp_buf end_of_program;
bool inside = false;
int looks_at_clock = 0;
std::clock_t began = 0;

}  // namespace

// The linker sends calls here (--wrap).
extern "C" {  // a point in time is a long in a register
[[noreturn]] void __real_exit(int status);
[[noreturn]] void __wrap_exit(int status) {
    if (inside) longjmp(end_of_program, 1 + status);
    __real_exit(status);
}
int __real_getrlimit(__rlimit_resource_t which, struct rlimit* limit);
int __wrap_getrlimit(__rlimit_resource_t which, struct rlimit* limit) {
    const int result = __real_getrlimit(which, limit);
    if (inside && which == RLIMIT_AS) limit->rlim_cur = most_memory;
    return result;
}
long __real__ZNSt6chrono3_V212steady_clock3nowEv();
long __wrap__ZNSt6chrono3_V212steady_clock3nowEv() {
    if (inside &&
        (++looks_at_clock == most_looks_at_clock || std::clock() - began > CLOCKS_PER_SEC))
        common::stop_signal = SIGTERM;
    return __real__ZNSt6chrono3_V212steady_clock3nowEv();
}
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
int LLVMFuzzerInitialize(int* argc, char*** argv);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned seed);
}

namespace {

struct Parameter {
    std::string name, initial;
    std::vector<std::string> choices;
};

std::string program;          // its name, which is that of this file
fs::path room;                // everything is written here
int terminal_of_program = 0;  // a file that takes what the program says
int report = 2;               // and a descriptor for what the laboratory says
bool only_forged = false;     // checkpoints, or else case files and command lines
std::uint64_t* tried = nullptr;
std::vector<Parameter> parameters;
std::vector<std::string> runs;                   // words that stand for a case
std::map<std::string, std::string> checkpoints;  // of these runs, as they are needed

std::string read_all(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_all(const fs::path& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, at);)
        if (!part.empty()) parts.push_back(part);
    return parts;
}

// Runs the program. out: its exit status; what it says is in room/terminal
int start(std::vector<std::string> words) {
    words.insert(words.begin(), program);
    for (const std::string& last : {std::string("--out"), (room / "out").string()})
        words.push_back(last);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (ftruncate(terminal_of_program, 0) != 0) std::abort();
    lseek(terminal_of_program, 0, SEEK_SET);
    dup2(terminal_of_program, 1);  // libFuzzer has taken its own away, -close_fd_mask=3
    dup2(terminal_of_program, 2);
    common::stop_signal = 0;
    looks_at_clock = 0, began = std::clock();
    int status = setjmp(end_of_program) - 1;
    if (status < 0) {
        inside = true;
        status = program_main(int(words.size()), argv.data());
    }
    inside = false;
    std::fflush(nullptr);
    return status;
}

// The words that a run's name stands for.
std::vector<std::string> words_of(const std::string& name) {
    facts::Arguments found;
    facts::expand(name, facts::program_called(program), found);
    std::vector<std::string> words;
    if (!found.file.empty()) words.push_back(found.file);
    for (const auto& [key, value] : found.overrides) words.push_back(key + "=" + value);
    return words;
}

// A checkpoint of a run, or nothing where it makes none.
const std::string& checkpoint_of(const std::string& name) {
    const auto [place, is_new] = checkpoints.try_emplace(name);
    if (!is_new || std::find(runs.begin(), runs.end(), name) == runs.end()) return place->second;
    start(words_of(name));
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(room / "out", none))
        if (entry.path().extension() == ".bin") place->second = read_all(entry.path());
    fs::remove_all(room / "out");
    return place->second;
}

[[noreturn]] void fail(const std::string& what) {
    dprintf(report, "%s: %s\n%s\n", program.c_str(), what.c_str(),
            read_all(room / "terminal").c_str());
    std::abort();
}

// ---- the generator -------------------------------------------------------------------------------

std::mt19937 dice;
std::size_t below(std::size_t count) { return dice() % count; }
template <class List>
const auto& any_of(const List& list) {
    return list[below(list.size())];
}

std::string any_number() {
    static const std::vector<std::string> numbers{"0",      "1",          "2",
                                                  "3",      "8",          "16",
                                                  "0.1",    "-1",         "-0.0",
                                                  "0.5",    "1e-3",       "1e-9",
                                                  "1e3",    "1e9",        "1e300",
                                                  "-1e300", "1e-300",     "nan",
                                                  "-inf",   "5e-324",     "65536",
                                                  "1e18",   "2147483648", "4294967296",
                                                  "100",    "1e155",      "9223372036854775807"};
    return any_of(numbers);
}

std::string any_value(const Parameter& parameter) {
    const std::size_t roll = below(8);
    char text[32];
    if (!parameter.choices.empty() && roll < 7) return any_of(parameter.choices);
    if (roll < 4) {
        const double factor = std::exp2(double(below(9)) - 4);
        std::snprintf(text, sizeof text, "%.3g",
                      std::strtod(parameter.initial.c_str(), nullptr) * factor);
        return text;
    }
    return roll == 4 ? any_of(parameters).initial : any_number();
}

// Gives a parameter another value, on the command line.
void change_parameter(std::vector<std::string>& words) {
    const Parameter& parameter = any_of(parameters);
    std::string name = parameter.name;
    const std::size_t open = name.find("<name>");
    if (open != std::string::npos) {
        std::vector<std::string> items{"beam"};
        for (const std::string& word : words)
            if (word.compare(0, open, name, 0, open) == 0)
                items.push_back(word.substr(open, word.find('.', open) - open));
        name.replace(open, 6, any_of(items));
    }
    std::erase_if(words, [&](const std::string& word) { return word.rfind(name + "=", 0) == 0; });
    words.push_back(name + "=" + any_value(parameter));
}

std::string any_edit() {
    const std::string block = std::to_string(below(60)), place = std::to_string(below(1000));
    const std::size_t roll = below(16);
    if (roll == 0) return "length " + block + " " + place;
    if (roll == 1) return "case " + place + " " + any_number();
    if (roll == 2) return "case " + place + " " + any_value(any_of(parameters));
    if (roll == 3) return "type " + block + " " + any_of(std::string("dflic"));
    if (roll == 4) return (below(2) == 0 ? "remove " : "repeat ") + block;
    if (roll == 5) return "byte " + std::to_string(below(100000)) + " " + place;
    if (roll == 6) return "cut " + std::to_string(below(100000));
    return "number " + block + " " + place + " " + any_number();
}

std::string any_input() {
    const std::string name = any_of(runs);
    if (only_forged) return "forge " + name + "\n" + any_edit() + "\n";
    std::string text;
    for (const std::string& word : words_of(name)) text += word + " ";
    return text + "\n";
}

std::string changed(const std::string& input) {
    const std::size_t end = std::min(input.find('\n'), input.size());
    if (input.rfind("forge ", 0) == 0) {
        std::vector<std::string> lines = split(input, '\n');
        if (lines.size() > 1 && below(2) == 0)
            lines[1 + below(lines.size() - 1)] = any_edit();
        else
            lines.push_back(any_edit());
        if (lines.size() > 6) lines.resize(2);
        std::string text;
        for (const std::string& line : lines) text += line + "\n";
        return text;
    }
    std::vector<std::string> words = split(input.substr(0, end), ' ');
    std::string text = input.substr(end);
    if (below(8) == 0 && !words.empty() && words[0].ends_with(".toml")) {
        text = "\n" + read_all(words[0]);
        words.erase(words.begin());
    }
    for (std::size_t k = below(3) + 1; k > 0; --k) change_parameter(words);
    static const std::vector<std::string> options{"--strict",  "--quiet",   "--resume", "--force",
                                                  "--threads", "--restart", "--help"};
    std::erase(words, "--dry-run");
    if (below(32) == 0) words.push_back(any_of(options));
    if (below(16) != 0) words.push_back("--dry-run");
    std::string line;
    for (const std::string& word : words) line += word + " ";
    return line + text;
}

}  // namespace

int LLVMFuzzerInitialize(int*, char*** argv) {
    program = fs::path((*argv)[0]).filename();
    setenv("GOMP_SPINCOUNT", "2000", 1);  // a program starts itself again where this is not said
    std::string name = (fs::temp_directory_path() / ("fuzz_" + program + "_XXXXXX")).string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    room = name;
    terminal_of_program = open((room / "terminal").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    // How many inputs were tried is known whatever ends the process.
    const char* count = std::getenv("FUZZ_COUNT");
    const int file = open(count != nullptr ? count : (room / "count").c_str(),
                          O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0 || ftruncate(file, 8) != 0) std::abort();
    tried =
        static_cast<std::uint64_t*>(mmap(nullptr, 8, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    std::atexit([] { fs::remove_all(room); });

    only_forged = std::getenv("FUZZ_ONLY") != nullptr;
    report = dup(2);
    start({"--help"});
    dup2(report, 2);
    const std::vector<std::string> lines = split(read_all(room / "terminal"), '\n');
    for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
        const std::string word = lines[k].substr(0, lines[k].find(' ', 2));
        const std::size_t ending = lines[k + 1].find("; default ");
        if (word.find('.') == std::string::npos || ending == std::string::npos) continue;
        const std::size_t from = lines[k + 1].find_first_not_of(' ');
        const std::string range = lines[k + 1].substr(from, ending - from);
        Parameter parameter{word.substr(2), lines[k + 1].substr(ending + 10), {}};
        if (range.find(" | ") != std::string::npos)
            for (const std::string& choice : split(range, ' '))
                if (choice != "|") parameter.choices.push_back(choice);
        parameters.push_back(parameter);
    }
    for (const std::string& line : facts::lines_in(facts::program_called(program).words))
        runs.push_back(line.substr(0, line.find(' ')));
    return parameters.empty() || runs.empty() ? 1 : 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string input(reinterpret_cast<const char*>(data), size);
    const std::size_t end = std::min(input.find('\n'), input.size());
    const std::string first = input.substr(0, end), rest = end < size ? input.substr(end + 1) : "";
    std::vector<std::string> words;
    if (first.rfind("forge ", 0) == 0) {
        const std::string& whole = checkpoint_of(first.substr(6));
        if (whole.empty()) return 0;
        write_all(room / "forged.bin", torture::forged(whole, rest));
        words = {"--restart", (room / "forged.bin").string()};
    } else {
        words = split(first.c_str(), ' ');
        if (!rest.empty()) {
            write_all(room / "case.toml", rest);
            words.insert(words.begin(), (room / "case.toml").string());
        }
    }
    ++*tried;
    const bool strict = std::find(words.begin(), words.end(), "--strict") != words.end();
    const int status = start(words);
    if (status != 0 && status != 2 && status != 3 && status != 143 && !(strict && status == 1))
        fail("status " + std::to_string(status));
    if (status == 3 && read_all(room / "terminal").find(": unexpected: ") != std::string::npos)
        fail("an error that nobody expected");
    fs::remove_all(room / "out");
    return 0;
}

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned seed) {
    dice.seed(seed);
    const std::size_t roll = below(20);
    if (roll < 3 && size > 1) return LLVMFuzzerMutate(data, size, max_size);
    const std::string old(reinterpret_cast<char*>(data), size);
    const std::string text = size < 4 || roll == 3 ? any_input() : changed(old);
    std::copy_n(text.begin(), std::min(text.size(), max_size), data);
    return std::min(text.size(), max_size);
}
