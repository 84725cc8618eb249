#include "common/run/run.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <new>
#include <regex>

#include "common/parallel.hpp"
#include "common/run/machine.hpp"
#include "common/run/output_file.hpp"

namespace common {

namespace {

namespace fs = std::filesystem;
constexpr const char* lock_name = ".lock";

// Set by the signal handler, read by the loop.
volatile std::sig_atomic_t stop_signal = 0;
// What the loop goes by: what any of the ranks has seen when they ended the last step.
int agreed_signal = 0;

// What a signal before the first step has to take away, and to say; a handler cannot allocate.
struct Beginning {
    volatile std::sig_atomic_t is_all = 0;  // nothing has been computed so far
    char files[4][4096] = {};               // three files and then, if it is new, the folder
    char sentence[8192] = {};
} beginning;

// A first signal asks to stop, a second one kills; one that comes with the first is the same one,
// which some senders give to the program and to its group.
struct timespec first_signal {};

extern "C" void ask_to_stop(int signal) {
    struct timespec now {};
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (stop_signal != 0) {
        const double later = double(now.tv_sec - first_signal.tv_sec) +
                             1e-9 * double(now.tv_nsec - first_signal.tv_nsec);
        if (later < 0.1) return;
        std::signal(signal, SIG_DFL);
        raise(signal);
    }
    first_signal = now;
    stop_signal = signal;
    if (beginning.is_all == 0) return;
    for (const char* file : {beginning.files[0], beginning.files[1], beginning.files[2]})
        if (file[0] != '\0') unlink(file);
    if (beginning.files[3][0] != '\0') rmdir(beginning.files[3]);
    [[maybe_unused]] const ssize_t written =
        write(STDERR_FILENO, beginning.sentence, std::strlen(beginning.sentence));
    _exit(128 + signal);
}

// Makes a signal end the program with a sentence, and take these files away if it is to.
void forget_on_signal(const std::string& sentence, const std::vector<std::string>& files) {
    beginning.is_all = 0;
    std::snprintf(beginning.sentence, sizeof beginning.sentence, "%s\n", sentence.c_str());
    for (std::size_t k = 0; k < files.size(); ++k)
        std::snprintf(beginning.files[k], sizeof beginning.files[k], "%s", files[k].c_str());
    beginning.is_all = 1;
}

// A signal that is ignored (nohup) stays ignored.
void listen_to(int signal) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) return;
    action.sa_handler = ask_to_stop;
    action.sa_flags = SA_RESTART, sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

// Whether a file of this name is one that a run writes.
bool is_ours(const std::string& name) {
    static const std::regex ours(
        "(case[.]toml|summary[.]json|pack[.]txt|(history|spectrum|profile)[.]dat|(fields|particles)"
        "[.]pvd|"
        "(fields|particles|profile|phase|velocities|fringes|grains|checkpoint)_[0-9]{6,}"
        "[.](dat|vti|vtp|h5|bin))([.]partial)?");
    return std::regex_match(name, ours);
}

// A message as one line that a terminal can show.
std::string printable(const std::string& text) {
    std::string result;
    for (const unsigned char byte : text) {
        char code[8];
        std::snprintf(code, sizeof code, byte < 0x20 || byte == 0x7F ? "\\x%02x" : "%c", byte);
        result += code;
    }
    return result;
}

// Does what one does for all. errors: what it throws there, everywhere
template <class Work>
void on_first_rank(const Work& work) {
    std::optional<InputError> refused;
    try {
        if (is_first_rank()) work();
    } catch (const InputError& error) {
        refused = error;
    }
    if (largest_over_ranks(refused.has_value()) != 0)
        throw refused.value_or(InputError("the first rank cannot begin"));
}

std::string clock_text(double seconds) {
    char text[32];
    const long s = std::lround(seconds);
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    return text + (s < 600 ? 3 : s < 3600 ? 2 : 0);
}

}  // namespace

bool Run::asked_to_stop() { return agreed_signal != 0; }

void Run::agree_to_stop() { agreed_signal = int(largest_over_ranks(stop_signal)); }

std::string Run::checkpoint_name(long step) {
    char name[64];
    std::snprintf(name, sizeof name, "checkpoint_%010ld.bin", step);
    return name;
}

std::string Run::command_to_continue(const std::string& checkpoint) const {
    std::string command = rank_count() > 1 ? "mpirun -n " + std::to_string(rank_count()) + " " : "";
    command += shell_word(command_.program) + " --restart " + shell_word(checkpoint);
    if (fs::path(checkpoint).parent_path() != fs::path(command_.out_dir))
        command += " --out " + shell_word(command_.out_dir);
    if (command_.threads > 0) command += " --threads " + std::to_string(command_.threads);
    return command;
}

Run::Run(const ProgramInfo& info, const CommandLine& command, const ParameterTable& table)
    : history(command.out_dir + "/history.dat"),
      info_(info),
      command_(command),
      effective_case_(table.effective_case()),
      start_(std::chrono::steady_clock::now()),
      shown_(start_) {
    summary.expectation = table.expectation;
    std::error_code error;
    is_new_ = is_first_rank() && !fs::exists(command_.out_dir, error);
    const std::string stopped =
        info_.program + ": stopped by a signal before the first step; " +
        (restarting() ? "continue with: " + command_to_continue(command_.restart_path)
                      : "there is nothing to continue");
    // What is there already stays, until it is known that it may be replaced.
    std::vector<std::string> begun;
    if (is_first_rank())
        begun = {path("case.toml"), path("case.toml.partial"), path(lock_name),
                 is_new_ ? command_.out_dir : ""};
    forget_on_signal(stopped, is_new_ ? begun : std::vector<std::string>{});
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) listen_to(signal);
    on_first_rank([&] { prepare_folder(); });
    terminal_ = isatty(STDERR_FILENO) != 0 && std::getenv("NO_PROGRESS") == nullptr;
    if (restarting()) return;
    forget_on_signal(stopped, begun);
    begin();
}

void Run::begin() {
    begun_ = true;
    std::error_code error;
    for (const std::string& file : replaced_) fs::remove(file, error);
    OutputFile file(path("case.toml"));
    file.text("# " + info_.program + " " + info_.version + ": the complete input of this run\n" +
              effective_case_);
    file.finish();
}

Run::~Run() {
    if (line_open_) std::fputs("\n", stderr);
    if (lock_ != nullptr) unlink(path(lock_name).c_str());
    if (is_new_ && !begun_) rmdir(command_.out_dir.c_str());
}

void Run::prepare_folder() {
    std::error_code error;
    const fs::path folder = command_.out_dir;
    const auto refuse_if = [&](bool impossible, const std::string& why) {
        if (impossible) throw InputError(command_.out_dir + ": " + why + "; choose another --out");
    };
    refuse_if(fs::exists(folder, error) && !fs::is_directory(folder, error),
              "is a file, and the results need a folder");
    fs::create_directories(folder, error);
    refuse_if(bool(error), "cannot be created: " + error.message());
    std::vector<fs::path> ours;
    bool foreign = false;
    const fs::directory_iterator entries(folder, error);
    refuse_if(bool(error), "cannot be looked into: " + error.message());
    for (const auto& entry : entries) {
        const std::string name = entry.path().filename().string();
        if (is_ours(name)) ours.push_back(entry.path());
        if (!is_ours(name) && name[0] != '.') foreign = true;
    }
    const bool own_restart =
        restarting() &&
        fs::equivalent(folder, fs::absolute(command_.restart_path).parent_path(), error);
    const bool as_it_is = own_restart || (ours.empty() && !foreign);
    const bool stopped =
        std::ranges::any_of(ours, [](const fs::path& file) { return file.extension() == ".bin"; });
    refuse_live_run(command_.out_dir);
    refuse(!as_it_is && !command_.force, command_.out_dir,
           ours.empty() ? ": is not empty; --force writes into it, and leaves what is not of a run"
                        : ": holds an earlier run; --force replaces it",
           ", --out DIR puts the results elsewhere",
           stopped ? ", --resume continues a run of the same input" : "");
    lock_folder();
    if (as_it_is) return;
    // A checkpoint that we are about to read stays.
    for (const fs::path& file : ours)
        if (!restarting() || !fs::equivalent(file, command_.restart_path, error))
            replaced_.push_back(file);
}

// The lock is held until the program ends, however it ends.
void Run::lock_folder() {
    const std::string name = path(lock_name);
    for (;;) {
        refuse_special_file(name);
        const int file = open(name.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
        std::shared_ptr<std::FILE> lock(file < 0 ? nullptr : fdopen(file, "r+"), [](std::FILE* f) {
            if (f != nullptr) std::fclose(f);
        });
        refuse(lock == nullptr, command_.out_dir, ": cannot be written to: ", std::strerror(errno),
               "; choose another --out");
        if (flock(file, LOCK_EX | LOCK_NB) != 0) {
            // A file system without locks goes without.
            if (errno != EWOULDBLOCK) return;
            refuse_live_run(command_.out_dir);
            continue;
        }
        // The run before may have taken its file away between these two calls.
        struct stat status {};
        if (fstat(file, &status) == 0 && status.st_nlink > 0) {
            lock_ = lock;
            return;
        }
    }
}

// The step that was begun is finished, so that there is a checkpoint to continue from.
bool Run::go_on(bool more) {
    beginning.is_all = 0;
    complete_ = !more;
    return more && !asked_to_stop();
}

bool Run::not_finished(long step, long steps) {
    step_ = step;
    if (first_done_ < 0 && steps > 0) first_done_ = double(step) / double(steps);
    return go_on(step < steps);
}

bool Run::not_finished(long step, double time, double end) {
    step_ = step;
    if (first_done_ < 0 && end > 0) first_done_ = time / end;
    return go_on(!reached(time, end));
}

std::string Run::when(const std::string& message) const {
    if (step_ < 0 || message.find("step ") != std::string::npos) return message;
    return message + " (in step " + std::to_string(step_) + ")";
}

void Run::show_progress(long step, long steps, double time, double done) {
    if (command_.quiet) return;
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double left = elapsed * (1 - done) / std::max(1e-9, done - first_done_);
    const long percent = long(100 * done);
    const std::string of_all = steps > 0 ? " of " + std::to_string(steps) : "";
    char note[160];
    std::snprintf(note, sizeof note, "%s %3ld %%  step %ld%s  t = %.4g  %s elapsed  %s left",
                  info_.program.c_str(), percent, step, of_all.c_str(), time,
                  clock_text(elapsed).c_str(), clock_text(left).c_str());
    if (terminal_) {
        if (now - shown_ < std::chrono::milliseconds(100) && done < 1) return;
        struct winsize window {};
        const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1;
        const int width = known ? window.ws_col - 1 : 79;
        std::fprintf(stderr, "\r%-*.*s", width, width, note);
        line_open_ = true;
    } else {
        if (percent / 10 <= tenths_shown_ && done < 1) return;
        tenths_shown_ = percent / 10;
        std::fprintf(stderr, "%s\n", note);
    }
    std::fflush(stderr);
    shown_ = now;
}

void Run::keep_two_checkpoints() const {
    if (!is_first_rank()) return;
    const std::string last = fs::path(last_checkpoint_).filename();
    std::error_code error;
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(command_.out_dir, error)) {
        const std::string found = entry.path().filename().string();
        if (found.starts_with("checkpoint_") && entry.path().extension() == ".bin" && found <= last)
            names.push_back(entry.path().string());
    }
    std::ranges::sort(names);
    for (std::size_t k = 0; k + 2 < names.size(); ++k) fs::remove(names[k], error);
}

int Run::finish(long step, double count) {
    if (line_open_) std::fputs("\n", stderr);
    line_open_ = false;
    history.flush();
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double steps = double(step - first_step_);
    summary.performance("wall_s", wall);
    summary.performance("steps", steps);
    summary.performance("particle_steps", steps * count);
    summary.performance("particle_steps_per_s", wall > 0 ? steps * count / wall : 0);
    summary.performance("threads", thread_count());
    if (has_ranks) {
        summary.performance("ranks", rank_count());
        summary.performance("communication_s", communication_seconds());
    }
    summary.performance("peak_memory_bytes", double(largest_over_ranks(long(peak_memory_bytes()))));

    int status = 0;
    std::string message = "done", next;
    std::vector<std::string> shortfalls = summary.shortfalls();
    if (asked_to_stop() && !complete_) {
        status = 128 + agreed_signal;
        message = "stopped by a signal at step " + std::to_string(step);
        next = "continue with: " + command_to_continue(last_checkpoint_);
    } else if (!summary.is_finite()) {
        status = 3;
        message = "a result is not finite";
    } else if (command_.strict && summary.fell_short()) {
        status = 1;
        message = "a result fell short";
    }
    summary.write(path("summary.json"), info_, command_.case_name, status,
                  next.empty() ? message : message + "; " + next);
    if (!command_.quiet) {
        std::printf("%s%s: %s after %ld steps in %s; results in %s\n", summary.table().c_str(),
                    info_.program.c_str(), message.c_str(), step, clock_text(wall).c_str(),
                    command_.out_dir.c_str());
        if (!next.empty()) std::printf("%s\n", next.c_str());
        if (std::error_code unreadable; fs::exists("common/plot.sh", unreadable))
            std::printf("pictures: make plot RUN=%s\n", shell_word(command_.out_dir).c_str());
        if (std::fflush(stdout) != 0 && errno != EPIPE)
            shortfalls.push_back("no results on standard output: see " + path("summary.json"));
    }
    for (const std::string& warning : summary.late_warnings)
        std::fprintf(stderr, "warning: %s\n", warning.c_str());
    for (const std::string& sentence : shortfalls)
        std::fprintf(stderr, "%s: %s\n", info_.program.c_str(), sentence.c_str());
    if (status == 3 || (status > 128 && command_.quiet))
        std::fprintf(stderr, "%s: %s; %s\n", info_.program.c_str(), message.c_str(),
                     next.empty() ? ("see " + path("summary.json")).c_str() : next.c_str());
    return status;
}

int Run::fail(int status, const std::string& message) {
    if (status == 3 && summary.expectation.names("status 3"))
        std::fprintf(stderr, "%s: as expected, %s\n", info_.program.c_str(),
                     summary.expectation.because.c_str());
    if (!begun_) return status;
    try {
        history.flush();
        summary.write(path("summary.json"), info_, command_.case_name, status, message);
    } catch (const std::exception&) {
        // The disk may be full; what has failed is on the terminal anyway.
    }
    return status;
}

void refuse_before_start(const CommandLine& command, long steps, double bytes) {
    refuse(command.restart_step > steps, command.restart_path, ": is at step ",
           command.restart_step, ", and the run ends at step ", steps, ": raise time.end");
    // Ranks of one machine share its memory, and each has its own limit of the shell.
    const double there = memory_limit_bytes(ranks_here());
    refuse(bytes > there, "the case needs ", bytes / 1073741824, " GiB of memory, and there is ",
           there / 1073741824, ": use fewer particles or cells");
}

void refuse_live_run(const std::string& folder) {
    const std::string lock = folder + "/" + lock_name;
    const int file = open(lock.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    const bool live = file >= 0 && flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (file >= 0) close(file);
    refuse(live, folder,
           ": another run is writing into this folder; wait for its end, or choose another --out");
}

int run_and_report_errors(const ProgramInfo& info, char** argv,
                          const std::function<int(std::optional<Run>&)>& program) {
    open_standard_descriptors();
    share_cores(argv);
    start_ranks();
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    std::optional<Run> run;
    const auto end = [&](int status, const std::string& message) {
        const auto leave_summary = [&] {
            if (run) run->fail(status, message);
        };
        leave_summary();
        if (is_first_rank()) run.reset();
        beginning.is_all = 0;  // ranks that end first may have the others stopped
        const std::string sentence = info.program + ": " + printable(message);
        std::fflush(stdout), std::fprintf(stderr, "%s\n", sentence.c_str());
        return end_ranks(status, sentence, leave_summary);
    };
    try {
        const int status = program(run);
        run.reset();
        return end_ranks(status);
    } catch (const InputError& error) {
        return end(2, error.what());
    } catch (const NumericalError& error) {
        return end(3, run ? run->when(error.what()) : error.what());
    } catch (const std::bad_alloc&) {
        return end(2,
                   "not enough memory for this case; use fewer particles or cells (--dry-run shows "
                   "the need)");
    } catch (const std::exception& error) {
        return end(3, std::string("unexpected: ") + error.what());
    }
}

}  // namespace common
