// The explicit rival of the implicit moment method: electromagnetic particle-in-cell as most codes
// do it. Nothing is predicted and nothing is solved; every electron scale must be resolved.
//
// The default case is the explicit run of the talk's cost slide: the GEM challenge on 512 x 256
// cells. Its full length takes the better part of an hour on two cores, `time.end=10` a minute.
// Run:   build/explicit_em
// Run:   build/explicit_em implicit_moment/cases/explicit_two_stream.toml particles.order=2
//
// Reading order: step.hpp; then home_weights.hpp, push_particles.hpp, follow_path.hpp, yee_field.hpp. What it
// shares with implicit_moment.cpp: plasma, set-ups, walls, records; `diff` shows the rest.
#include <optional>

#include "common/run/start.hpp"
#include "implicit_moment/explicit_em/leapfrog_state.hpp"
#include "implicit_moment/explicit_em/setup/check_leapfrog.hpp"
#include "implicit_moment/explicit_em/step.hpp"
#include "implicit_moment/output/record.hpp"
#include "implicit_moment/output/write_output.hpp"
#include "implicit_moment/theory/compare_with_theory.hpp"

namespace {

using namespace implicit_moment;

const common::About about{
    "explicit_em", PROGRAM_VERSION,
    "explicit electromagnetic particle-in-cell in 2.5 dimensions; the default case is the explicit "
    "run of the talk's cost slide",
    "implicit_moment/cases/gem_explicit.toml"};

int run(int argc, char** argv, std::optional<common::Session>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case wanted;
    common::ParameterTable table = describe_explicit(wanted);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    refuse_impossible(wanted);
    refuse_unstable(wanted);
    if (wanted.wave != "none") theory_of_mode(wanted);
    const Scales scales = scales_of(wanted);
    if (!common::start_run(about, command, table,
                           {describe_scales(wanted, scales), leapfrog_warnings(wanted, scales),
                            scales.steps, scales.bytes, wanted.checkpoint_steps},
                           holder))
        return 0;
    common::Session& session = *holder;

    // 2. Particles and fields at t = 0.
    State state = leapfrog_state(wanted);
    Leapfrog leapfrog(wanted);
    const auto shown = [&](const State& now) {
        return moments_now(leapfrog, now, detail::Images::plasma);
    };
    Recorder recorder(wanted, state, shown, session.history);

    // 3. The loop.
    const double dt = wanted.dt;
    const long steps = scales.steps;
    long step = 0;
    if (session.restarting()) session.restore(state, step);
    std::vector<Particles>& particles = state.plasma.species;
    while (session.keep_going(step, steps)) {
        pack_push_field(leapfrog, state.field);  // E^n, B^n
        if (step % wanted.history_steps == 0)    // the row of t^n
            recorder.record(step, state, moments_now(leapfrog, state), session);
        take_step(leapfrog, state.field, particles);  // u, J^{n+1/2}; x, E, B^{n+1}
        ++step;
        session.end_of_step(step, steps, static_cast<double>(step) * dt, state);
    }

    // 4. The last row, the results against theory, summary.json.
    if (step == steps) {
        pack_push_field(leapfrog, state.field);
        recorder.record(step, state, moments_now(leapfrog, state), session);
        recorder.finish(state, session);
    }
    return session.finish(step, static_cast<double>(state.plasma.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return run(argc, argv, session); });
}
