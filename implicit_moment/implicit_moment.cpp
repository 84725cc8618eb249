// The implicit moment method: kinetic particles, and fluid equations that predict their current,
// so that fields can be advanced with time steps longer than the plasma period and cells larger
// than the Debye length.
//
// The default case is the GEM magnetic reconnection challenge with the numbers of the talk.
// Run:   build/implicit_moment
// Run:   build/implicit_moment implicit_moment/cases/gem.toml time.end=400 field.theta=1
// Run:   build/implicit_moment implicit_moment/cases/two_stream.toml uniform.particles_per_cell=256
//
// Reading order: units.hpp, particles.hpp, deposit_moments.hpp, predict_current.hpp,
// solve_field.hpp, move_particles.hpp.
#include <cstdio>
#include <optional>

#include "common/run/session.hpp"
#include "implicit_moment/output/record.hpp"
#include "implicit_moment/output/write_output.hpp"
#include "implicit_moment/theory/compare_with_theory.hpp"

namespace {

using namespace implicit_moment;

const common::About about{
    "implicit_moment", PROGRAM_VERSION,
    "implicit moment method in 2.5 dimensions; the default case is the GEM reconnection challenge",
    "implicit_moment/cases/gem.toml"};

int run(int argc, char** argv, std::optional<common::Session>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case wanted;
    common::ParameterTable table = describe(wanted);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    refuse_impossible(wanted);
    if (wanted.wave != "none") theory_of_mode(wanted);
    const Scales scales = scales_of(wanted);
    const std::vector<std::string> warnings = closure_warnings(wanted, scales);  // [IMM-13]
    for (const std::string& warning : warnings)
        std::fprintf(stderr, "warning: %s\n", warning.c_str());
    if (!command.quiet) std::printf("%s", describe_scales(wanted, scales).c_str());
    if (command.dry_run) return 0;
    common::refuse_before_start(command, scales.steps, scales.bytes);

    // 2. Particles and fields at t = 0.
    common::set_thread_count(command.threads);
    common::Session& session = holder.emplace(about, command, table);
    for (const std::string& warning : warnings) session.summary.warning(warning);
    session.checkpoint_steps = wanted.checkpoint_steps;
    const Grid& grid = wanted.grid;
    State state = initial_state(wanted);
    std::vector<Particles>& particles = state.plasma.species;
    const std::vector<double> charge_over_mass = state.plasma.charge_over_mass();
    std::vector<Moments> moments(particles.size(), Moments(grid));
    FieldSolver solver(grid, wanted.field);
    PushField push;
    SortScratch scratch;
    Recorder recorder(
        wanted, state, [&](const State& now) { return slide_moments(grid, now); }, session.history);

    // 3. The loop of the slide.
    const double dt = wanted.dt;
    const long steps = scales.steps;
    long step = 0;
    if (session.restarting()) session.restore(state, step);
    // [loop]
    while (session.keep_going(step, steps)) {
        deposit_moments(particles, grid, state.field.B, dt, moments);     // [IMM-9]
        recorder.record(step, state, moments, session);                   // the row of t^n
        solve_field(solver, moments, charge_over_mass, dt, state.field);  // [IMM-10, 11, 12]
        pack_push_field(solver, state.field, push);                       // grid -> particles
        move_particles(push, grid, dt, wanted.mover, particles);          // particles move
        advance_field(solver, dt, state.field);                           // [IMM-10]
        sort_particles(grid, scratch, particles);                         // for the next step
        ++step;
        session.end_of_step(step, steps, static_cast<double>(step) * dt, state);
    }
    // [/loop]

    // 4. The last row, the results against theory, summary.json.
    if (step == steps) {
        deposit_moments(particles, grid, state.field.B, dt, moments);
        recorder.record(step, state, moments, session);
        recorder.finish(state, session);
    }
    return session.finish(step, static_cast<double>(state.plasma.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return run(argc, argv, session); });
}
