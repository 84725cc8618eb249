// The classical particle-in-cell method of Harlow: compressible fluids, several at a time, with free
// surfaces and with slip at the walls. Cells hold velocity and energy; particles are mass and a
// label, and carry both from cell to cell.
//
// The default case is the showpiece of 1955: a sphere of iron hits a plate of aluminum.
// Run:   build/pic
// Run:   build/pic flip/cases/sod.toml particles.per_cell_x=64
// Run:   build/pic flip/cases/advected_blob.toml time.dt=0.001
//
// Reading order: step.hpp; then ../particles.hpp, ../problem.hpp, ../equation_of_state.hpp,
// pic_cells.hpp, largest_step.hpp, faces.hpp, lagrangian_phase.hpp, move_particles.hpp, eulerian_phase.hpp.
#include <climits>
#include <optional>

#include "common/run/start.hpp"
#include "flip/output/pic_diagnostics.hpp"
#include "flip/output/record.hpp"
#include "flip/pic/step.hpp"
#include "flip/setup/check_case.hpp"
#include "flip/setup/check_state.hpp"
#include "flip/setup/problem_of_case.hpp"
#include "flip/setup/warn_of_case.hpp"

namespace {

using namespace flip;

const common::ProgramInfo info{"pic", PROGRAM_VERSION,
                               "Harlow's particle-in-cell method for compressible flow; the "
                               "default case is a sphere that hits a plate",
                               "flip/cases/sphere_hits_plate.toml"};

int run_program(int argc, char** argv, std::optional<common::Run>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case given;
    common::ParameterTable table = describe(given);
    const common::CommandLine command = common::read_command_line(argc, argv, info, table);
    reject_unused(given);
    const Case parameters = completed(given);
    validate(parameters, info.program);
    const Scales scales = scales_of(parameters, info.program);
    if (!common::start_run(
            info, command, table,
            {describe_scales(parameters, scales, info.program),
             resolution_warnings(parameters, scales, info.program), LONG_MAX, scales.bytes},
            {parameters.checkpoint_steps, 1, parameters.end}, holder))
        return 0;
    common::Run& run = *holder;

    // 2. Particles and cells at t = 0.
    const Problem problem = problem_of(parameters);
    PicCells cells(problem);
    Recorder recorder(parameters, info.program, run.history);
    State state = initial_state(problem, load_particles(parameters), cells);
    CellFields fields;
    long step = 0;
    if (run.restarting()) {
        run.restore(state, step, [&] { validate_state(problem, run.history, state); });
        sum_cell_masses(problem.grid, state, cells);
    }

    // 3. The loop of the slide.
    while (run.not_finished(step, state.time, parameters.end)) {
        find_pressure(problem, state, cells);  // cells: p
        fields_of(problem.grid, state, cells, fields);
        recorder.record(step, state, totals_of(problem.grid, state, cells), fields, run);
        take_pic_step(problem, state, cells);  // Lagrangian phase, particles, Eulerian phase  [PIC]
        ++step;
        run.end_of_step(step, state.time, parameters.end, state);
    }

    // 4. The end of the run, the results against theory, summary.json.
    if (common::Run::reached(state.time, parameters.end)) {
        find_pressure(problem, state, cells);
        const Totals totals = totals_of(problem.grid, state, cells);
        fields_of(problem.grid, state, cells, fields);
        recorder.record(step, state, totals, fields, run);
        recorder.finish(state, totals, fields, run);
    }
    return run.finish(step, double(state.particles.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::run_and_report_errors(info, argv,
                                         [&](auto& run) { return run_program(argc, argv, run); });
}
