// FLIP, the fluid-implicit-particle method: Harlow's PIC with particles that keep their momentum and
// their energy. Compressible fluids at all speeds, several at a time, with free surfaces.
//
// The default case is Sod's shock tube; `make flip_sod` draws it beside the same run of pic and the
// exact solution.
// Run:   build/flip
// Run:   build/flip flip/cases/sod.toml flip.transfer=pic
// Run:   build/flip flip/cases/gresho.toml
//
// Reading order: step.hpp; then ../particles.hpp, ../problem.hpp, ../equation_of_state.hpp, mesh.hpp,
// deposit_particles.hpp, find_pressure.hpp, move_mesh.hpp, accelerate_nodes.hpp, solve_pressure.hpp,
// move_particles.hpp, ../boundaries.hpp.
#include <climits>
#include <optional>

#include "common/run/start.hpp"
#include "flip/flip/step.hpp"
#include "flip/output/flip_diagnostics.hpp"
#include "flip/output/record.hpp"
#include "flip/setup/balance_at_rest.hpp"
#include "flip/setup/check_case.hpp"
#include "flip/setup/check_state.hpp"
#include "flip/setup/problem_of_case.hpp"
#include "flip/setup/warn_of_case.hpp"

namespace {

using namespace flip;

const common::ProgramInfo info{"flip", PROGRAM_VERSION,
                               "FLIP, particles that keep their momentum: compressible fluids at "
                               "all speeds; the default case is Sod's shock tube",
                               "flip/cases/sod.toml"};

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

    // 2. Particles at t = 0, sorted; an empty mesh.
    const Problem problem = problem_of(parameters);
    FlipScratch scratch(problem);
    const Mesh& mesh = scratch.mesh;
    Recorder recorder(parameters, info.program, run.history);
    State state;
    Particles& particles = state.particles = load_particles(parameters);
    long step = 0;
    if (run.restarting())
        run.restore(state, step, [&] { validate_state(problem, run.history, state); });
    keep_in_rows(parameters.grid, scratch.sort, particles);
    if (!run.restarting() && all_hydrostatic(parameters))
        balance_at_rest(problem, particles, scratch.mesh);

    // 3. The loop of the slide.
    while (run.not_finished(step, state.time, parameters.end)) {
        find_fluid(problem, state, scratch.mesh);  // particles -> mesh: v_g, p_c      [FLIP-8]
        recorder.record(step, state, particle_totals(problem.grid, particles),
                        cell_fields(problem.grid, mesh), run);
        take_flip_step(problem, step, scratch, state);  // mesh -> particles: v_p, x_p [FLIP-6, 7]
        ++step;
        run.end_of_step(step, state.time, parameters.end, state);
    }

    // 4. The end of the run, the results against theory, summary.json.
    if (common::Run::reached(state.time, parameters.end)) {
        find_fluid(problem, state, scratch.mesh);
        const Totals totals = particle_totals(problem.grid, particles);
        const CellFields cells = cell_fields(problem.grid, mesh);
        recorder.record(step, state, totals, cells, run);
        recorder.finish(state, totals, cells, run);
    }
    return run.finish(step, double(particles.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::run_and_report_errors(info, argv,
                                         [&](auto& run) { return run_program(argc, argv, run); });
}
