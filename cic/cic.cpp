// Clouds-in-cells: charged particles in the electric field of their own charge, which is computed
// on a mesh. One or two dimensions, a uniform magnetic field, periodic or between walls.
//
// The default case is the two-stream instability: two cold beams pass through each other, roll up
// into vortices in phase space and turn their energy into heat.
// Run:   build/cic
// Run:   build/cic cic/cases/landau.toml species.electrons.amplitude=0.3
// Run:   build/cic cic/cases/two_stream.toml gauss.sign=-1 theory.compare=none
//
// Reading order: step.hpp; then units.hpp, particles.hpp, weights.hpp, and the four headers of the
// slide, deposit_charge.hpp, solve_field.hpp, gather_field.hpp, move_particles.hpp.
#include <optional>

#include "cic/meet_walls.hpp"
#include "cic/output/record.hpp"
#include "cic/setup/initial_state.hpp"
#include "cic/sort_particles.hpp"
#include "cic/step.hpp"
#include "common/run/start.hpp"

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
    if (!common::start_run(about, command, table,
                           {describe_scales(wanted, scales), resolution_warnings(wanted, scales),
                            scales.steps, scales.bytes, wanted.checkpoint_steps},
                           holder))
        return 0;
    common::Session& session = *holder;

    // 2. Particles at t = 0, velocities half a step before.
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
    while (session.keep_going(step, steps)) {
        field.walls = state.walls;
        find_field(particles, grid, scheme, background, deposit_scratch, solver, rho_g,
                   field);                                                 // [CIC-1, 2]
        recorder.snapshot(step, state, rho_g, field, session);             // files of t^n
        push_particles(field.E_g, grid, scheme, wanted.B, dt, particles);  // [CIC-3, 4, 5]
        recorder.record(step, state, rho_g, field, session);               // the row of t^n
        meet_walls(wanted, step, state);
        ++step;
        if (sort_is_due(wanted.sort_interval, step)) sort_particles(grid, sort_scratch, particles);
        session.end_of_step(step, steps, static_cast<double>(step) * dt, state);
    }

    // 4. The results against theory, summary.json.
    if (step == steps) recorder.finish(state, session);
    return session.finish(step, static_cast<double>(state.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return run(argc, argv, session); });
}
