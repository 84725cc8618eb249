#include "common/run/machine.hpp"

#include <fcntl.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace common {

namespace {

namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();

// The number that a file begins with; "max", a negative one and no file are no limit.
double limit_in(const fs::path& file) {
    double number = 0;
    return std::ifstream(file) >> number && number >= 0 ? number : infinity;
}

// The smallest of what limit(folder) says of the control groups of this process and of those around
// them: a line of the file is number:controllers:path, without controllers in version 2.
template <class Limit>
double smallest_limit(const Limit& limit) {
    double smallest = infinity;
    std::ifstream groups("/proc/self/cgroup");
    for (std::string number, controllers, path; std::getline(groups, number, ':') &&
                                                std::getline(groups, controllers, ':') &&
                                                std::getline(groups, path);) {
        fs::path group = fs::path("/sys/fs/cgroup") / controllers;
        smallest = std::min(smallest, limit(group));
        for (const fs::path& part : fs::path(path).relative_path())
            smallest = std::min(smallest, limit(group /= part));
    }
    return smallest;
}

}  // namespace

void open_standard_descriptors() {
    for (int lowest = 0; lowest <= STDERR_FILENO;) {
        lowest = open("/dev/null", O_RDWR);
        if (lowest > STDERR_FILENO) close(lowest);
        if (lowest < 0) return;
    }
}

void share_cores(char** argv) {
    for (const char* name : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"})
        if (std::getenv(name) != nullptr) return;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (error) return;
    setenv("GOMP_SPINCOUNT", "2000", 1);  // looks for work before libgomp sleeps: some microseconds
    setenv("KMP_BLOCKTIME", "0", 1);      // the same for clang's library, in milliseconds
    execv(program.c_str(), argv);         // returns where it fails; then it goes on as it is
}

int free_cores() {
    const double quota = smallest_limit([](const fs::path& group) {
        double time = limit_in(group / "cpu.cfs_quota_us");
        double period = limit_in(group / "cpu.cfs_period_us");
        if (std::ifstream file(group / "cpu.max"); !(file >> time >> period) && file.is_open())
            time = infinity;  // "max 100000"
        return period > 0 && time < infinity ? time / period : infinity;
    });
    return std::max(1, int(std::min<double>(omp_get_num_procs(), quota)));
}

double memory_limit_bytes(int processes) {
    const double installed = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    double bytes = std::min(installed, smallest_limit([](const fs::path& group) {
                                return std::min(limit_in(group / "memory.max"),
                                                limit_in(group / "memory.limit_in_bytes"));
                            })) /
                   processes;
    struct rlimit shell {};
    if (getrlimit(RLIMIT_AS, &shell) == 0 && shell.rlim_cur != RLIM_INFINITY)
        bytes = std::min(bytes, double(shell.rlim_cur));
    return bytes;
}

double peak_memory_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kilobytes = 0;
        if (word == "VmHWM:" && status >> kilobytes) return 1024.0 * kilobytes;
    }
    return 0;
}

std::string shell_word(const std::string& text) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) || c == '/' || c == '.' || c == '_' || c == '-' || c == '=';
    };
    if (!text.empty() && std::ranges::all_of(text, plain)) return text;
    std::string word = "'";
    for (const char letter : text)
        word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return word + "'";
}

}  // namespace common
