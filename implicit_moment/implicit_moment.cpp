// The implicit moment method: kinetic particles, and fluid equations that predict their current,
// so that fields can be advanced with time steps longer than the plasma period and cells larger
// than the Debye length.
//
// The default case is the GEM magnetic reconnection challenge with the numbers of the talk.
// Run:   build/implicit_moment
// Run:   build/implicit_moment implicit_moment/cases/gem.toml time.end=400 field.theta=1
// Run:   build/implicit_moment implicit_moment/cases/two_stream.toml uniform.particles_per_cell=256
//
// Reading order: step.hpp; then units.hpp, particles.hpp, deposit_moments.hpp, predict_current.hpp,
// solve_field.hpp, move_particles.hpp.
#include <optional>

#include "common/run/start.hpp"
#include "implicit_moment/output/record.hpp"
#include "implicit_moment/ranks/balance_rows.hpp"
#include "implicit_moment/setup/check_case.hpp"
#include "implicit_moment/setup/check_state.hpp"
#include "implicit_moment/setup/describe_case.hpp"
#include "implicit_moment/setup/initial_state.hpp"
#include "implicit_moment/step.hpp"

namespace {

using namespace implicit_moment;

const common::ProgramInfo info{
    "implicit_moment", PROGRAM_VERSION,
    "implicit moment method in 2.5 dimensions; the default case is the GEM reconnection challenge",
    "implicit_moment/cases/gem.toml"};

int run_program(int argc, char** argv, std::optional<common::Run>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case parameters;
    common::ParameterTable table = describe(parameters);
    const common::CommandLine command = common::read_command_line(argc, argv, info, table);
    validate(parameters);
    refuse_ranks(parameters);
    const Scales scales = scales_of(parameters);
    // Where the closure of the moments does not hold is a warning.                [IMM-13]
    if (!common::start_run(
            info, command, table,
            {describe_scales(parameters, scales), closure_warnings(parameters, scales),
             scales.steps, scales.bytes, scales.seconds, scales.of_mesh},
            {parameters.checkpoint_steps}, holder))
        return 0;
    common::Run& run = *holder;

    // 2. Particles and fields at t = 0.
    const Grid& grid = parameters.grid;
    State state = initial_state(parameters);
    std::vector<Particles>& particles = state.plasma.species;
    const std::vector<double> charge_over_mass = state.plasma.charge_over_mass();
    StepScratch scratch(grid, parameters.field, particles.size());
    Recorder recorder(
        parameters, state, [&](const State& now) { return slide_moments(grid, now); }, stored_u,
        run.history);

    // 3. The loop of the slide.
    const double dt = parameters.dt;
    const long steps = scales.steps;
    long step = 0;
    Checkpoint checkpoint{state, recorder.profile, true, common::share_of_rank()};
    const auto sort = [&](std::vector<Particles>& all) { sort_particles(grid, scratch.sort, all); };
    if (run.restarting())
        run.restore(checkpoint, step, [&] { validate_state(parameters, step, sort, checkpoint); });
    double imbalance = balance_rows(nodes_x(grid), rows_of_rank, particles);
    while (run.not_finished(step, steps)) {
        find_moments(grid, dt, particles, state.field, scratch);  // particles -> grid  [IMM-9]
        recorder.record(step, state, scratch.moments, run);       // the row of t^n
        take_step(grid, dt, parameters.mover, charge_over_mass, scratch, particles, state.field);
        if (++step % 10 == 0) imbalance = balance_rows(nodes_x(grid), rows_of_rank, particles);
        run.end_of_step(step, steps, double(step) * dt, checkpoint);
    }

    // 4. The last row, the results against theory, summary.json.
    if (step == steps) {
        find_moments(grid, dt, particles, state.field, scratch);
        recorder.record(step, state, scratch.moments, run);
        recorder.finish(state, run);
    }
    if (common::rank_count() > 1) run.summary.performance("imbalance", imbalance);
    return run.finish(step, double(scales.particles));
}

}  // namespace

int main(int argc, char** argv) {
    return common::run_and_report_errors(info, argv,
                                         [&](auto& run) { return run_program(argc, argv, run); });
}
