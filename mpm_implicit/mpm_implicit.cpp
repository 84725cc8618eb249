// The implicit material point method: grains in contact by the theta scheme, whose energy obeys a
// theorem: it never grows, whatever the time step, and for theta = 1/2 it stays, to round-off.
//
// The default case is the talk's rebounding grains, at a time step where the explicit program bursts.
// Run:   build/mpm_implicit
// Run:   build/mpm_implicit mpm_implicit/cases/rebound.toml time.alpha=5
// Run:   build/mpm_implicit mpm_implicit/cases/rebound.toml method.mass=lumped
// Reading order: step.hpp; then as the README says. What both programs share is in mpm_explicit/.
#include <optional>

#include "common/run/start.hpp"
#include "mpm_implicit/output/record.hpp"
#include "mpm_implicit/setup/check_case.hpp"
#include "mpm_implicit/setup/check_state.hpp"
#include "mpm_implicit/step.hpp"
#include "mpm_implicit/theory/compare_with_theory.hpp"

namespace {

using namespace mpm_implicit;

const common::ProgramInfo info{
    "mpm_implicit", PROGRAM_VERSION,
    "the implicit material point method for grains; the default case is two disks that rebound",
    "mpm_implicit/cases/rebound.toml"};

template <class Shape>
int run_case(const Shape& shape, const Case& parameters, const ThetaScheme& scheme,
             const Scales& scales, common::Run& run) {
    // 2. Particles at t = 0.
    State state;
    Assembly& all = state.assembly = assemble(parameters.problem, Shape::has_sides);
    const double dt = scales.dt;
    const Contact contact(contact_rule(parameters.problem, dt), all.grains, all.bonds);
    GrainNodes nodes(parameters.problem.mesh(), Shape::width, scales.least_mass);
    StepScratch<Shape::width - 1> scratch{
        laws_of(parameters.problem), scheme, contact, parameters.flip, parameters.frozen, {}, {}};
    ThetaRecorder recorder(parameters, scheme, scales, state, run.history);
    StepSums sums;
    long step = 0;
    if (run.restarting()) {
        run.restore(state, step, [&] { validate_state(nodes.mesh(), Shape::width, state); });
        nodes.lay_out(all.grains, state.layout);
    } else {
        nodes.sort(all.grains, all.particles, state.layout);
        start_budget(all, scratch.laws, state.budget);
    }

    // 3. The loop of the slide.
    while (run.not_finished(step, scales.steps)) {
        if (nodes.sort_is_due(state.layout)) nodes.sort(all.grains, all.particles, state.layout);
        recorder.record(step, state, run);  // the row of t^n
        const BodyForce body = apply_loads(parameters.problem.loads(), step, dt, all.rigid,
                                           scratch.solver.force_controls);
        take_step(shape, body, dt, scratch, nodes, state, sums);  // [MPM-5 ... 8]
        add_step(scheme.theta, scheme.consistent(), nodes.tiles(), sums.tiles, sums.nodes,
                 sums.contact, state.budget);  // [MPM-13]
        state.effort.add(sums);
        recorder.refuse_failure(step, sums, nodes, state, run);
        ++step;
        run.end_of_step(step, scales.steps, static_cast<double>(step) * dt, state);
    }

    // 4. The last row, the results against theory, summary.json.
    if (step == scales.steps) {
        recorder.record(step, state, run);
        recorder.finish(step, state, run);
    }
    return run.finish(step, static_cast<double>(all.particles.count()));
}

int run_program(int argc, char** argv, std::optional<common::Run>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case parameters;
    ThetaScheme scheme;
    common::ParameterTable table = describe(parameters, scheme, theory::names_of(comparisons));
    const common::CommandLine command = common::read_command_line(argc, argv, info, table);
    validate(parameters, scheme);
    Scales scales = scales_of_run(info, command, parameters, false);
    scales.bytes = bytes_of(parameters, scheme, scales);
    theory::validate_comparison({parameters, facts_of(parameters, scheme)}, scales, comparisons);
    if (!common::start_run(info, command, table,
                           {describe_scales(parameters, scheme, scales),
                            warnings_of(parameters, scheme, scales), scales.steps, scales.bytes},
                           {parameters.checkpoint_steps, parameters.history_steps}, holder))
        return 0;
    return with_shape(parameters.scheme(), [&](const auto& shape) {
        return run_case(shape, parameters, scheme, scales, *holder);
    });
}

}  // namespace

int main(int argc, char** argv) {
    return common::run_and_report_errors(info, argv,
                                         [&](auto& run) { return run_program(argc, argv, run); });
}
