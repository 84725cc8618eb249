// Clouds-in-cells: charged particles in the electric field of their own charge, which is computed
// on a mesh. One or two dimensions, a uniform magnetic field, periodic or between walls.
//
// The default case is the two-stream instability: two cold beams pass through each other, roll up
// into vortices in phase space and turn their energy into heat.
// Run:   build/cic
// Run:   build/cic cic/cases/landau.toml species.electrons.amplitude=0.3
// Run:   build/cic cic/cases/two_stream.toml gauss.sign=-1 theory.compare=none
//
// Reading order: units.hpp, particles.hpp, weights.hpp, deposit_charge.hpp, solve_field.hpp,
// gather_field.hpp, move_particles.hpp.
#include <cstdio>
#include <optional>

#include "cic/meet_walls.hpp"
#include "cic/output/record.hpp"
#include "cic/sort_particles.hpp"

namespace {

using namespace cic;

const common::About about{"cic", PROGRAM_VERSION,
                          "clouds-in-cells, the electrostatic plasma method; the default case is "
                          "the two-stream instability",
                          "cic/cases/two_stream.toml"};

int run(int argc, char** argv, std::optional<common::Session>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case wanted;
    common::ParameterTable table = describe(wanted);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    refuse_impossible(wanted);
    const Scales scales = scales_of(wanted);
    const std::string description = describe_scales(wanted, scales);
    const std::vector<std::string> warnings = resolution_warnings(wanted, scales);
    for (const std::string& warning : warnings)
        std::fprintf(stderr, "warning: %s\n", warning.c_str());
    if (!command.quiet) std::printf("%s", description.c_str());
    if (command.dry_run) return 0;
    common::refuse_before_start(command, scales.steps, scales.bytes);

    // 2. Particles at t = 0, velocities half a step before.
    common::set_thread_count(command.threads);
    common::Session& session = holder.emplace(about, command, table);
    for (const std::string& warning : warnings) session.summary.warning(warning);
    session.checkpoint_steps = wanted.checkpoint_steps;
    const Grid& grid = wanted.grid;
    const Scheme scheme = wanted.scheme();
    const double dt = wanted.dt, background = fixed_background(wanted);
    FieldSolver solver(grid, scheme, wanted.stencil == "nine_point", wanted.gauss_sign);
    State state = initial_state(wanted, solver);
    std::vector<Particles>& particles = state.species;
    Field rho_g;
    FieldState field;
    DepositScratch deposit_scratch;
    common::SortScratch<Real> sort_scratch;
    Recorder recorder(wanted, state, session.history);

    // 3. The loop of the slide.
    const long steps = scales.steps;
    long step = 0;
    if (session.restarting()) session.restore(state, step);
    // [loop]
    while (session.keep_going(step, steps)) {
        deposit_charge(particles, grid, scheme, background, deposit_scratch, rho_g);  // [CIC-1]
        field.walls = state.walls;
        solve_field(solver, rho_g, field);                      // [CIC-2]
        recorder.snapshot(step, state, rho_g, field, session);  // files of t^n
        for_each_chunk(particles, [&](Chunk& p) {
            FieldAtParticles E_p;
            gather_field(field.E_g, grid, scheme, p, E_p);  // [CIC-3]
            accelerate(E_p, wanted.B, dt, p);               // [CIC-4]
            move_particles(grid, dt, p);                    // [CIC-5]
        });
        recorder.record(step, state, rho_g, field, session);  // the row of t^n
        meet_walls(wanted, step, state);
        ++step;
        if (sort_is_due(wanted, step)) sort_particles(grid, sort_scratch, particles);
        session.end_of_step(step, steps, static_cast<double>(step) * dt, state);
    }
    // [/loop]

    // 4. The results against theory, summary.json.
    if (step == steps) recorder.finish(state, session);
    return session.finish(step, static_cast<double>(state.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return run(argc, argv, session); });
}
