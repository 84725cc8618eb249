// The implicit material point method: grains in contact by the theta scheme, whose energy obeys a
// theorem: it never grows, whatever the time step, and for theta = 1/2 it stays, to round-off.
//
// The default case is the talk's rebounding grains, at a time step where the explicit program bursts.
// Run:   build/mpm_implicit
// Run:   build/mpm_implicit mpm_implicit/cases/rebound.toml time.alpha=5
// Run:   build/mpm_implicit mpm_implicit/cases/rebound.toml method.mass=lumped
//
// Reading order: step.hpp; then node_rows.hpp, stencil.hpp, grain_matrix.hpp, contact_set.hpp, constraints.hpp,
// projected_cg.hpp, grain_factors.hpp, mass_factors.hpp, settle_contact.hpp, solve_nodes.hpp,
// update_stress.hpp, move_particles.hpp, ledger.hpp; then solve_with_newton.hpp.
// What both programs share is in mpm_explicit/.
#include <optional>

#include "common/run/start.hpp"
#include "mpm_implicit/output/record.hpp"
#include "mpm_implicit/setup/check_case.hpp"
#include "mpm_implicit/step.hpp"

namespace {

using namespace mpm_implicit;

const common::About about{"mpm_implicit", PROGRAM_VERSION,
                          "the implicit material point method for grains in contact; the default "
                          "case is two elastic disks that rebound",
                          "mpm_implicit/cases/rebound.toml"};

template <class Shape>
int run(const Shape& shape, const Case& wanted, const ThetaScheme& scheme, const Scales& scales,
        common::Session& session) {
    // 2. Particles at t = 0.
    State state;
    state.assembly = assemble(wanted.problem);
    Particles& particles = state.assembly.particles;
    const std::vector<Grain>& grains = state.assembly.grains;
    std::vector<RigidMotion>& rigid = state.assembly.rigid;
    std::vector<Bond>& bonds = state.assembly.bonds;
    const std::vector<AnyLaw> laws = laws_of(wanted.problem);
    const Contact contact(wanted.problem.contact, grains, bonds);
    const double dt = scales.dt;
    GrainNodes nodes(wanted.problem.mesh(), Shape::width, scales.least_mass);
    StepScratch<Shape::width - 1> run{laws, scheme, contact, wanted.flip, wanted.frozen, {}, {}};
    ThetaRecorder recorder(wanted, scheme, scales, state, session.history);
    StepSums sums;
    long step = 0;
    if (session.restarting()) {
        session.restore(state, step);
        nodes.lay_out(grains, state.frame);
    } else {
        nodes.sort(grains, particles, state.frame);
        open_ledger(state.assembly, laws, state.ledger);
        recorder.start(state, session);
    }

    // 3. The loop of the slide.
    while (session.keep_going(step, scales.steps)) {
        if (nodes.sort_is_due(state.frame)) nodes.sort(grains, particles, state.frame);
        recorder.snapshot(step, state, session);
        const BodyForce body = drive(wanted.problem, step, dt, rigid, run.solver.servos);
        take_step(shape, body, dt, run, nodes, state, sums);  // [MPM-5 ... 8]
        recorder.record(step, sums, nodes, state, session);   // [MPM-13]
        ++step;
        session.end_of_step(step, scales.steps, static_cast<double>(step) * dt, state);
    }

    // 4. The results against theory, summary.json.
    if (step == scales.steps) {
        recorder.snapshot(step, state, session);
        recorder.finish(step, state, session);
    }
    return session.finish(step, static_cast<double>(particles.count()));
}

int start(int argc, char** argv, std::optional<common::Session>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case wanted;
    ThetaScheme scheme;
    common::ParameterTable table = describe(wanted, scheme);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    refuse_impossible(wanted, scheme);
    Scales scales = scales_of(wanted);
    scales.bytes = bytes_of(wanted, scheme, scales);
    if (!common::start_run(
            about, command, table,
            {describe_scales(wanted, scheme, scales), warnings_of(wanted, scheme, scales),
             scales.steps, scales.bytes, wanted.checkpoint_steps},
            holder))
        return 0;
    common::Session& session = *holder;

    int status = 0;
    with_shape(wanted.scheme(),
               [&](const auto& shape) { status = run(shape, wanted, scheme, scales, session); });
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return start(argc, argv, session); });
}
