// Clouds-in-cells: charged particles in the electric field of their own charge, which is computed
// on a mesh. One dimension, x, or the plane (x, z); a uniform magnetic field; periodic or with walls.
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

#include "cic/apply_particle_boundaries.hpp"
#include "cic/output/record.hpp"
#include "cic/setup/check_case.hpp"
#include "cic/setup/check_state.hpp"
#include "cic/setup/describe_case.hpp"
#include "cic/setup/initial_state.hpp"
#include "cic/sort_particles.hpp"
#include "cic/step.hpp"
#include "common/run/start.hpp"

namespace {

using namespace cic;

const common::ProgramInfo info{"cic", PROGRAM_VERSION,
                               "clouds-in-cells, the electrostatic plasma method; the default case "
                               "is the two-stream instability",
                               "cic/cases/two_stream.toml"};

int run_program(int argc, char** argv, std::optional<common::Run>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case parameters;
    common::ParameterTable table = describe(parameters);
    const common::CommandLine command = common::read_command_line(argc, argv, info, table);
    validate(parameters);
    const Scales scales = scales_of(parameters);
    if (!common::start_run(
            info, command, table,
            {describe_scales(parameters, scales), resolution_warnings(parameters, scales),
             scales.steps, scales.bytes, scales.seconds, scales.of_mesh},
            {parameters.checkpoint_steps}, holder))
        return 0;
    common::Run& run = *holder;

    // 2. Particles at t = 0, velocities half a step before.
    const Grid& grid = parameters.grid;
    const Scheme scheme = parameters.scheme();
    const double dt = parameters.dt, background = fixed_background(parameters);
    FieldSolver solver(grid, scheme, parameters.stencil == "nine_point", parameters.gauss_sign);
    State state = initial_state(parameters, solver);
    std::vector<Particles>& particles = state.species;
    Field rho_g;
    FieldState field;
    DepositScratch deposit_scratch;
    common::SortScratch<Real> sort_scratch;
    const ParticleBoundaries boundaries = particle_boundaries(parameters, particles);
    Recorder recorder(parameters, state, run.history);

    // 3. The loop of the slide.
    const long steps = scales.steps;
    long step = 0;
    if (run.restarting())
        run.restore(state, step, [&] { validate_state(parameters, step, state), keep_own(state); });
    while (run.not_finished(step, steps)) {
        field.walls = state.walls;
        find_field(particles, grid, scheme, background, deposit_scratch, solver, rho_g,
                   field);                                                     // [CIC-1, 2]
        recorder.snapshot(step, state, rho_g, field, run);                     // files of t^n
        push_particles(field.E_g, grid, scheme, parameters.B, dt, particles);  // [CIC-3, 4, 5]
        recorder.record(step, state, rho_g, field, run);                       // the row of t^n
        apply_particle_boundaries(grid, boundaries, step, particles, state.walls,
                                  state.emitted_again);
        ++step;
        if (sort_is_due(parameters.sort_interval, step))
            sort_particles(grid, sort_scratch, particles);
        run.end_of_step(step, steps, double(step) * dt, state);
    }

    // 4. The last row, whose velocities need the half step after it; the results against theory.
    if (step == steps) {
        field.walls = state.walls;
        find_field(particles, grid, scheme, background, deposit_scratch, solver, rho_g, field);
        recorder.snapshot(step, state, rho_g, field, run);
        push_particles(field.E_g, grid, scheme, parameters.B, dt, particles);
        recorder.record(step, state, rho_g, field, run);
        recorder.finish(state, run);
    }
    return run.finish(step, double(state.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::run_and_report_errors(info, argv,
                                         [&](auto& run) { return run_program(argc, argv, run); });
}
