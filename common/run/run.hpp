// What every run owns besides its physics: the output folder, history, summary, checkpoints,
// progress and signals.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "common/run/checkpoint.hpp"
#include "common/run/history.hpp"
#include "common/run/parameters.hpp"
#include "common/run/sentence.hpp"
#include "common/run/summary.hpp"

namespace common {

/// How often a run writes what, and where it ends.
struct Schedule {
    long checkpoint_steps = 0;  // from one to the next; 0: only when a signal stops the run
    long history_steps = 1;     // from row to row; the last row is that of the end
    double end = std::numeric_limits<double>::infinity();  // where steps are not known in number
};

class Run {
   public:
    /// Prepares the output folder, locks it and listens to SIGHUP, SIGINT and SIGTERM. Until the first step
    /// begins, a signal ends the program at once and takes away what it has begun; afterwards the
    /// step is finished and a checkpoint is written. A restart writes nothing before restore().
    /// errors: InputError when another run writes into the folder, or it holds something else, or an
    ///         earlier run without --force.
    Run(const ProgramInfo& info, const CommandLine& command, const ParameterTable& table);
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;
    ~Run();

    History history;
    Summary summary;
    Schedule schedule;

    /// Whether the run continues from a checkpoint.
    bool restarting() const { return !command_.restart_path.empty(); }

    /// Reads the checkpoint named by --restart into state, history and step.
    /// in:     validate(), which refuses a state that no run of the case can have
    /// errors: InputError for a file that is damaged or forged, or beyond the end of the run; nothing
    ///         has been written then
    template <class State, class Validate>
    void restore(State& state, long& step, const Validate& validate) {
        CheckpointReader reader(info_, command_.restart_path);
        std::vector<double> rows;
        reader("step", step), reader("history", rows);
        archive(reader, state);
        reader.finish();
        try {
            history.restore(rows);
            refuse(step < 1 || step > 1000000000000, "its step cannot be");
            refuse(history.rows() != (step - 1) / schedule.history_steps + 1,
                   "its history lacks rows, or has too many");
            validate();
        } catch (const InputError& error) {
            throw InputError(command_.restart_path + ": the checkpoint is of no run: " +
                             error.what() + "; use an earlier one");
        }
        const double last = history.column("time").back();
        refuse(reached(last, schedule.end), command_.restart_path, ": has a row of t = ", last,
               ", and the run ends at t = ", schedule.end, ": raise time.end");
        begin();
        history.open();
        first_step_ = step;
    }

    /// False at the end of the run, or after the step in which a signal asked to stop. Steps may
    /// all be equal and known in number, or as long as the flow allows until a time is reached; the
    /// last of those may end later, so that a run does not depend on where it was meant to end.
    bool not_finished(long step, long steps);
    bool not_finished(long step, double time, double end);
    /// Whether a time is the end, but for the round-off of a sum of steps.
    static bool reached(double time, double end) { return time >= end * (1 - 1e-9); }

    /// Shows progress; writes a checkpoint when one is due, at the end, or when a signal has asked
    /// to stop.
    template <class State>
    void end_of_step(long step, long steps, double time, State& state) {
        show_progress(step, steps, time, steps > 0 ? double(step) / double(steps) : 1.0);
        checkpoint_if_due(step, step == steps, state);
    }
    template <class State>
    void end_of_step(long step, double time, double end, State& state) {
        show_progress(step, 0, time, end > 0 ? std::min(1.0, time / end) : 1.0);
        checkpoint_if_due(step, reached(time, end), state);
    }

    /// Writes summary.json and prints the results.
    /// in:     step, how many steps the run has come to; count, particles (or what else is
    ///         advanced) in each.
    /// out:    the exit status: 0 done, 1 with --strict where a result fell short, 129, 130 or 143
    ///         stopped by a signal, 3 for a result that is not finite.
    int finish(long step, double count);

    /// A message about a failure, with the step if it does not say which.
    std::string when(const std::string& message) const;

    /// Writes summary.json for a run that has failed. out: the exit status.
    int fail(int status, const std::string& message);

    /// The path of a file in the folder of the run.
    std::string path(const std::string& file) const { return command_.out_dir + "/" + file; }

   private:
    template <class State>
    void checkpoint_if_due(long step, bool last, State& state) {
        const long every = schedule.checkpoint_steps;
        const bool due = every > 0 && (step % every == 0 || last);
        agree_to_stop();
        if (!due && !asked_to_stop()) return;
        history.flush();
        last_checkpoint_ = path(checkpoint_name(step));
        CheckpointWriter writer(info_, last_checkpoint_, command_.case_name, effective_case_);
        writer("step", step);
        writer("history", history.all());
        archive(writer, state);
        writer.finish();
        keep_two_checkpoints();
    }
    static bool asked_to_stop();
    static void agree_to_stop();
    static std::string checkpoint_name(long step);
    bool go_on(bool more);
    void lock_folder();
    void prepare_folder();
    void begin();  // to write into the folder
    void show_progress(long step, long steps, double time, double done);
    void keep_two_checkpoints() const;
    std::string command_to_continue(const std::string& checkpoint) const;

    ProgramInfo info_;
    CommandLine command_;
    std::string effective_case_, last_checkpoint_;
    std::vector<std::string> replaced_;  // files of an earlier run
    std::shared_ptr<std::FILE> lock_;
    long first_step_ = 0;
    double first_done_ = -1;  // part of the run that was done before the first step
    std::chrono::steady_clock::time_point start_, shown_;
    long step_ = -1;  // that is being taken
    long tenths_shown_ = 0;
    bool terminal_ = false, line_open_ = false;
    bool complete_ = false;  // the end of the run is reached
    bool is_new_ = false;    // the folder was not there
    bool begun_ = false;     // something was written into it
};

/// Refuses, before anything is written, a restart beyond the end of the run and a case larger than
/// the machine's memory. in: steps of the whole run; bytes it will take.
void refuse_before_start(const CommandLine& command, long steps, double bytes);

/// errors: InputError where a run that has not ended writes into the folder
void refuse_live_run(const std::string& folder);

/// Prepares the machine, runs a program and turns errors into one sentence on stderr and the exit
/// status: 2 bad input, 3 numerical failure.
/// in: argv of main; program(run) builds the run in place, so that a failed run still leaves its
///     summary
int run_and_report_errors(const ProgramInfo& info, char** argv,
                          const std::function<int(std::optional<Run>&)>& program);

}  // namespace common
