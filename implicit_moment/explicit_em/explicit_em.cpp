// The explicit rival of the implicit moment method: electromagnetic particle-in-cell as most codes
// do it. Nothing is predicted and nothing is solved; every electron scale must be resolved.
//
// The default case is the explicit run of the talk's cost slide: the GEM challenge on 512 x 256
// cells. Its full length takes half an hour on two cores, `time.end=10` a minute.
// Run:   build/explicit_em
// Run:   build/explicit_em implicit_moment/cases/explicit_two_stream.toml particles.order=2
//
// Reading order: step.hpp; then stencil.hpp, push_particles.hpp, deposit_current.hpp, yee_field.hpp. What it
// shares with implicit_moment.cpp: plasma, set-ups, walls, records; `diff` shows the rest.
#include <optional>

#include "common/run/start.hpp"
#include "implicit_moment/explicit_em/setup/check_leapfrog.hpp"
#include "implicit_moment/explicit_em/setup/leapfrog_state.hpp"
#include "implicit_moment/explicit_em/step.hpp"
#include "implicit_moment/output/record.hpp"
#include "implicit_moment/ranks/balance_rows.hpp"
#include "implicit_moment/setup/check_state.hpp"
#include "implicit_moment/setup/describe_case.hpp"

namespace {

using namespace implicit_moment;

const common::ProgramInfo info{"explicit_em", PROGRAM_VERSION,
                               "explicit electromagnetic particle-in-cell in 2.5 dimensions; the "
                               "default case is the explicit run of the talk's cost slide",
                               "implicit_moment/cases/gem_explicit.toml"};

int run_program(int argc, char** argv, std::optional<common::Run>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case parameters;
    common::ParameterTable table = describe_explicit(parameters);
    const common::CommandLine command = common::read_command_line(argc, argv, info, table);
    validate(parameters);
    refuse_unstable(parameters);
    const Scales scales = scales_of(parameters);
    if (!common::start_run(
            info, command, table,
            {describe_scales(parameters, scales), leapfrog_warnings(parameters, scales),
             scales.steps, scales.bytes, scales.seconds, scales.of_mesh},
            {parameters.checkpoint_steps, parameters.history_steps}, holder))
        return 0;
    common::Run& run = *holder;

    // 2. Particles and fields at t = 0.
    const Grid& grid = parameters.grid;
    const LeapfrogSettings& settings = parameters.leapfrog;
    const double dt = parameters.dt;
    State state = leapfrog_state(parameters);
    std::vector<Particles>& particles = state.plasma.species;
    LeapfrogScratch scratch(grid);
    const auto moments_with = [&](Images images) {
        return find_moments(grid, dt, settings, particles, images, scratch);
    };
    Recorder recorder(
        parameters, state, [&](const State&) { return moments_with(Images::plasma); },
        [&](const Particles& s, long p) { return u_at_t(scratch.field, grid, dt, settings, s, p); },
        run.history);

    // 3. The loop.
    const long steps = scales.steps;
    long step = 0;
    Checkpoint checkpoint{state, recorder.profile, false, common::share_of_rank()};
    const auto sort = [&](std::vector<Particles>& all) { sort_by_cell(grid, settings.order, all); };
    if (run.restarting())
        run.restore(checkpoint, step, [&] { validate_state(parameters, step, sort, checkpoint); });
    double imbalance = balance_rows(cells_of_tile(grid, settings.order), 1, particles);
    while (run.not_finished(step, steps)) {
        interleave_field(grid, parameters.field.smoothing, state.field, scratch);  // E^n, B^n
        if (step % parameters.history_steps == 0)                                  // the row of t^n
            recorder.record(step, state, moments_with(Images::conductor), run);
        take_step(grid, dt, settings, parameters.field.smoothing, scratch, particles,
                  state.field);  // u, J^{n+1/2}; x, E, B^{n+1}
        if (++step % 10 == 0)
            imbalance = balance_rows(cells_of_tile(grid, settings.order), 1, particles);
        run.end_of_step(step, steps, double(step) * dt, checkpoint);
    }

    // 4. The last row, the results against theory, summary.json.
    if (step == steps) {
        interleave_field(grid, parameters.field.smoothing, state.field, scratch);
        recorder.record(step, state, moments_with(Images::conductor), run);
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
