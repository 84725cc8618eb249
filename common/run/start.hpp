// What every main does between the case and the first step.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/parallel.hpp"
#include "common/run/machine.hpp"
#include "common/run/run.hpp"

namespace common {

/// What follows from a case before it runs.
struct Preparation {
    std::string description;  // scales, memory and time in words
    std::vector<std::string> warnings;
    long steps = 0;      // to be run; a run until a time does not know them
    double bytes = 0;    // of memory, in each rank
    double seconds = 0;  // on one core
    double of_mesh = 0;  // of these, on the mesh, which every rank has
};

/// Refuses ranks that would not do the same, because they see other files; and warns where several processes
/// are started of a program that has no ranks.
inline void refuse_unlike_ranks(const CommandLine& command, const ParameterTable& table) {
    const char* started = std::getenv("OMPI_COMM_WORLD_SIZE");
    if (!has_ranks && started != nullptr && std::atol(started) > 1)
        std::fprintf(stderr,
                     "warning: mpirun starts this program %s times, and it has no ranks, so each "
                     "is a run of its own; build/mpi/ has those with ranks (make MPI=1 all)\n",
                     started);
    const std::string all = table.effective_case() + "\n" + command.restart_path + "\n" +
                            std::to_string(command.restart_step) + (command.complete ? "+" : "-") +
                            (command.dry_run ? "+" : "-");
    const long sum = long(std::hash<std::string>()(all) >> 1);
    refuse(sum_over_ranks(long(sum != largest_over_ranks(sum))) > 0,
           "ranks have read different cases, or see different output folders: give all the same "
           "files, in a folder that all machines share");
}

/// Says what the case is and what may mislead in it, and opens the run.
/// in:     prepared and schedule, of a case that was not refused
/// out:    holder, the run; false with --dry-run, where the words are all, and where --resume finds
///         the run complete
/// errors: InputError where the folder, the memory or the length of the run is impossible
inline bool start_run(const ProgramInfo& info, const CommandLine& command,
                      const ParameterTable& table, const Preparation& prepared,
                      const Schedule& schedule, std::optional<Run>& holder) {
    refuse_unlike_ranks(command, table);
    for (const std::string& warning : prepared.warnings)
        std::fprintf(stderr, "warning: %s\n", warning.c_str());
    if (!command.quiet) std::printf("%s", prepared.description.c_str());
    // Ranks beside others have one thread, and so have short steps: on a busy machine threads wait.
    const bool unsaid = command.threads == 0 && std::getenv("OMP_NUM_THREADS") == nullptr,
               one = ranks_here() > 1 || prepared.seconds < 2e-4 * double(prepared.steps);
    set_thread_count(!unsaid ? command.threads : one ? 1 : free_cores());
    if (rank_count() > 1 && !command.quiet) {
        const double cores = std::min({double(thread_count()), double(free_cores()),
                                       double(sysconf(_SC_NPROCESSORS_ONLN)) / ranks_here()});
        const double seconds =
            prepared.of_mesh + (prepared.seconds - prepared.of_mesh) / rank_count();
        std::printf("  %-33s %d, each with about that memory, if particles divide evenly\n",
                    "ranks", rank_count());
        if (seconds > 0)
            std::printf("  %-33s about %.4g s, with %.2g core(s) each\n", "time with them",
                        seconds / cores, cores);
    }
    if (command.dry_run && !command.complete) try {
            refuse_before_start(command, prepared.steps, prepared.bytes);
        } catch (const InputError& error) {
            std::fprintf(stderr, "warning: the run will be refused here: %s\n", error.what());
        }
    if (command.dry_run) return false;
    if (command.complete) {
        if (!command.quiet)
            std::printf("%s: %s holds this run, complete\n", info.program.c_str(),
                        command.out_dir.c_str());
        if (command.fell_short)
            std::fprintf(stderr, "%s: a result fell short; see %s/summary.json\n",
                         info.program.c_str(), command.out_dir.c_str());
        return false;
    }
    // What ranks have read, nobody changes while others read it.
    refuse_before_start(command, prepared.steps, prepared.bytes);
    largest_over_ranks(0);
    Run& run = holder.emplace(info, command, table);
    run.summary.warnings = prepared.warnings;
    run.schedule = schedule;
    return true;
}

}  // namespace common
