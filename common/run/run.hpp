// What every run owns besides its physics: the output folder, history, summary, checkpoints,
// progress and signals.
#pragma once

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <string>

#include "common/run/checkpoint.hpp"
#include "common/run/history.hpp"
#include "common/run/parameters.hpp"
#include "common/run/summary.hpp"

namespace common {

class Run {
   public:
    /// Prepares the output folder, writes case.toml there and listens to SIGINT and SIGTERM.
    /// errors: InputError when the folder holds something else, or an earlier run without --force.
    Run(const ProgramInfo& info, const CommandLine& command, const ParameterTable& table);
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;
    ~Run();

    History history;
    Summary summary;
    long checkpoint_steps = 0;  // steps between checkpoints; 0: only when a signal stops the run

    /// Whether the run continues from a checkpoint.
    bool restarting() const { return !command_.restart_path.empty(); }

    /// Reads the checkpoint named by --restart into state, history and step.
    template <class State>
    void restore(State& state, long& step) {
        CheckpointReader reader(info_, command_.restart_path);
        std::vector<double> rows;
        reader("step", step);
        reader("history", rows);
        archive(reader, state);
        history.restore(rows);
        first_step_ = step;
    }

    /// False at the end of the run, or when a signal has asked to stop. Steps may all be equal and
    /// known in number, or as long as the flow allows until a time is reached; the last of those may
    /// end later, so that a run does not depend on where it was meant to end.
    bool not_finished(long step, long steps);
    bool not_finished(long step, double time, double end);
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
    /// out:    the exit status: 0 done, 130 or 143 stopped by a signal, 3 for a result that is not
    ///         finite.
    int finish(long step, double count);

    /// A message about a failure, with the step if it does not say which.
    std::string when(const std::string& message) const;

    /// Writes summary.json for a run that has failed. out: the exit status.
    int fail(int status, const std::string& message);

    /// The path of a file in the folder of the run.
    std::string path(const std::string& file) const { return command_.out_dir + "/" + file; }

    /// The signal that has asked to stop, or 0.
    static int stopped_by();

   private:
    template <class State>
    void checkpoint_if_due(long step, bool last, State& state) {
        const bool due = checkpoint_steps > 0 && (step % checkpoint_steps == 0 || last);
        if (!due && stopped_by() == 0) return;
        history.flush();
        CheckpointWriter writer(info_, effective_case_);
        writer("step", step);
        writer("history", history.all());
        archive(writer, state);
        write_checkpoint(writer, step);
    }
    void prepare_folder();
    void show_progress(long step, long steps, double time, double done);
    void write_checkpoint(CheckpointWriter& writer, long step);

    ProgramInfo info_;
    CommandLine command_;
    std::string effective_case_, last_note_;
    long first_step_ = 0;
    double first_done_ = -1;  // part of the run that was done before the first step
    std::chrono::steady_clock::time_point start_, shown_;
    long step_ = -1;  // that is being taken
    long tenths_shown_ = 0;
    bool terminal_ = false, line_open_ = false;
};

/// Refuses, before anything is written, a restart beyond the end of the run and a case larger than
/// the machine's memory. in: steps of the whole run; bytes it will take.
void refuse_before_start(const CommandLine& command, long steps, double bytes);

/// Runs a program and turns errors into one sentence on stderr and the exit status: 2 bad input,
/// 3 numerical failure.
/// in: program(run) builds the run in place, so that a failed run still leaves its summary.
int run_and_report_errors(const ProgramInfo& info,
                          const std::function<int(std::optional<Run>&)>& program);

}  // namespace common
