// The explicit material point method: elastic and plastic grains in the plane that rebound, rub,
// stick and yield, by leapfrog.
//
// The default case is the talk's rebounding grains: two elastic disks collide, and at a quarter of
// the stability limit they part as they came.
// Run:   build/mpm_explicit
// Run:   build/mpm_explicit mpm_explicit/cases/rebound.toml time.alpha=1
// Run:   build/mpm_explicit mpm_explicit/cases/rebound.toml contact.separation=0
//
// Reading order: step.hpp; then particles.hpp, shapes.hpp, grain_nodes.hpp, transfer.hpp, strain.hpp,
// update_stress.hpp, accelerate_nodes.hpp, contact.hpp, move_particles.hpp, ledger.hpp.
#include <optional>

#include "common/run/start.hpp"
#include "mpm_explicit/output/record.hpp"
#include "mpm_explicit/setup/check_case.hpp"
#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/step.hpp"

namespace {

using namespace mpm_explicit;

const common::About about{"mpm_explicit", PROGRAM_VERSION,
                          "the explicit material point method for grains in contact; the default "
                          "case is two elastic disks that rebound",
                          "mpm_explicit/cases/rebound.toml"};

template <class Shape>
int run(const Shape& shape, const Case& wanted, const Scales& scales, common::Session& session) {
    // 2. Particles at t = 0, stresses half a step before.
    State state;
    state.assembly = assemble(wanted.problem);
    Particles& particles = state.assembly.particles;
    const std::vector<Grain>& grains = state.assembly.grains;
    std::vector<RigidMotion>& rigid = state.assembly.rigid;
    const std::vector<AnyLaw> laws = laws_of(wanted.problem);
    const Contact contact(wanted.problem.contact, grains, state.assembly.bonds);
    const double dt = scales.dt;
    GrainNodes nodes(wanted.problem.mesh(), Shape::width, scales.least_mass);
    LeapfrogRecorder recorder(wanted, scales, state, session.history);
    StepSums sums;
    long step = 0;
    if (session.restarting()) {
        session.restore(state, step);
        nodes.lay_out(grains, state.frame);
    } else {
        nodes.sort(grains, particles, state.frame);
        start_leapfrog(shape, laws, contact, wanted.frozen, dt, nodes, state);
    }

    // 3. The loop of the slide.
    while (session.keep_going(step, scales.steps)) {
        if (nodes.sort_is_due(state.frame)) nodes.sort(grains, particles, state.frame);
        recorder.snapshot(step, state, session);
        const BodyForce body = drive(wanted.problem, step, dt, rigid);
        take_step(shape, laws, contact, body, wanted.flip, wanted.frozen, dt, nodes, state,
                  sums);  // [MPM-4, 9 ... 12]
        recorder.record(step, sums, nodes, state, session);
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
    common::ParameterTable table = describe(wanted);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    refuse_impossible(wanted);
    const Scales scales = scales_of(wanted);
    if (!common::start_run(about, command, table,
                           {describe_scales(wanted, scales), warnings_of(wanted, scales),
                            scales.steps, scales.bytes, wanted.checkpoint_steps},
                           holder))
        return 0;
    common::Session& session = *holder;

    int status = 0;
    with_shape(wanted.scheme(),
               [&](const auto& shape) { status = run(shape, wanted, scales, session); });
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return start(argc, argv, session); });
}
