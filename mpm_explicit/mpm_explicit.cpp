// The explicit material point method: elastic and plastic grains in the plane, by leapfrog.
//
// The default case is the talk's rebounding grains: two elastic disks collide, and at a quarter of
// the stability limit they part as they came.
// Run:   build/mpm_explicit
// Run:   build/mpm_explicit mpm_explicit/cases/rebound.toml time.alpha=1
// Run:   build/mpm_explicit mpm_explicit/cases/rebound.toml contact.separation=0
//
// Reading order: step.hpp; then particles.hpp, shapes.hpp, grid/grain_nodes.hpp, transfer.hpp, strain.hpp,
// update_stress.hpp, accelerate_nodes.hpp, contact.hpp, move_particles.hpp, budget.hpp.
#include <optional>

#include "common/run/start.hpp"
#include "mpm_explicit/output/record.hpp"
#include "mpm_explicit/setup/check_case.hpp"
#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/step.hpp"
#include "mpm_explicit/theory/compare_with_theory.hpp"

namespace {

using namespace mpm_explicit;

const common::ProgramInfo info{
    "mpm_explicit", PROGRAM_VERSION,
    "the explicit material point method for grains; the default case is two disks that rebound",
    "mpm_explicit/cases/rebound.toml"};

template <class Shape>
int run_case(const Shape& shape, const Case& parameters, const Scales& scales, common::Run& run) {
    // 2. Particles at t = 0, stresses half a step before.
    State state{assemble(parameters.problem), {}, {}};
    auto& [particles, grains, rigid, bonds] = state.assembly;
    const std::vector<AnyLaw> laws = laws_of(parameters.problem);
    const Contact contact(contact_rule(parameters.problem), grains, bonds);
    const Transfer transfer = parameters.transfers();
    const double dt = scales.dt;
    GrainNodes nodes(parameters.problem.mesh(), Shape::width, scales.least_mass);
    LeapfrogRecorder recorder(parameters, scales, state, run.history);
    StepSums sums;
    long step = 0;
    if (run.restarting()) {
        run.restore(state, step,
                    [&] { validate_state(nodes.mesh(), Shape::width, transfer, state); });
        nodes.lay_out(grains, state.layout);
    } else {
        nodes.sort(grains, particles, state.layout);
        start_leapfrog(shape, laws, contact, transfer, parameters.frozen, dt, nodes, state);
    }

    // 3. The loop of the slide.
    const auto step_from = [&](State& now, Assembly& all) {
        if (nodes.sort_is_due(now.layout)) nodes.sort(all.grains, all.particles, now.layout);
        recorder.snapshot(step, now, run);
        const BodyForce body = apply_loads(parameters.problem.loads(), step, dt, all.rigid);
        take_step(shape, laws, contact, body, transfer, parameters.frozen, dt, nodes, now,
                  sums);                               // [MPM-4, 9 ... 12]
        add_energies(step, sums.tiles, now.budget);    // [MPM-14, 15]
        recorder.record(step, sums, nodes, now, run);  // the row of t^n
    };
    while (run.not_finished(step, scales.steps)) {
        step_from(state, state.assembly);
        add_work(nodes.tiles(), sums.tiles, sums.nodes, sums.contact, state.budget);
        ++step;
        run.end_of_step(step, scales.steps, static_cast<double>(step) * dt, state);
    }

    // 4. The last row, for which a copy goes on; the results against theory, summary.json.
    if (step == scales.steps) {
        State beyond = state;
        step_from(beyond, beyond.assembly);
        recorder.finish(step, state, run);
    }
    return run.finish(step, static_cast<double>(particles.count()));
}

int run_program(int argc, char** argv, std::optional<common::Run>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case parameters;
    common::ParameterTable table = describe(parameters, theory::names_of(comparisons));
    const common::CommandLine command = common::read_command_line(argc, argv, info, table);
    validate_explicit(parameters);
    const Scales scales = scales_of_run(info, command, parameters);
    theory::validate_comparison({parameters, leapfrog}, scales, comparisons);
    if (!common::start_run(info, command, table,
                           {describe_scales(parameters, scales), warnings_of(parameters, scales),
                            scales.steps, scales.bytes},
                           {parameters.checkpoint_steps, parameters.history_steps}, holder))
        return 0;
    return with_shape(parameters.scheme(), [&](const auto& shape) {
        return run_case(shape, parameters, scales, *holder);
    });
}

}  // namespace

int main(int argc, char** argv) {
    return common::run_and_report_errors(info, argv,
                                         [&](auto& run) { return run_program(argc, argv, run); });
}
