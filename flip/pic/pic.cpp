// The classical particle-in-cell method of Harlow: compressible fluids, several at a time, with free
// surfaces and with slip at the walls. Cells hold velocity and energy; particles are mass and a
// label, and carry it from cell to cell.
//
// The default case is the showpiece of 1955: an iron ball, here a rod, hits an aluminum plate.
// Run:   build/pic
// Run:   build/pic flip/cases/sod.toml particles.per_cell_x=64
// Run:   build/pic flip/cases/advected_blob.toml time.dt=0.001
//
// Reading order: step.hpp; then ../particles.hpp, ../equation_of_state.hpp, pic_cells.hpp,
// largest_step.hpp, lagrangian_phase.hpp, eulerian_phase.hpp, ends.hpp.
#include <climits>
#include <optional>

#include "common/run/start.hpp"
#include "flip/output/record.hpp"
#include "flip/pic/pic_start.hpp"
#include "flip/pic/step.hpp"
#include "flip/setup/check_case.hpp"
#include "flip/setup/warn_of_case.hpp"

namespace {

using namespace flip;

const common::About about{
    "pic", PROGRAM_VERSION,
    "Harlow's particle-in-cell method for compressible flow; the default case "
    "is a ball that hits a plate",
    "flip/cases/sphere_hits_plate.toml"};

int run(int argc, char** argv, std::optional<common::Session>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case wanted;
    common::ParameterTable table = describe(wanted);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    refuse_idle(wanted);
    const Case w = completed(wanted);
    refuse_impossible(w, about.program);
    const Scales scales = scales_of(w, about.program);
    if (!common::start_run(about, command, table,
                           {describe_scales(w, scales, about.program),
                            resolution_warnings(w, scales, about.program), LONG_MAX, scales.bytes,
                            w.checkpoint_steps},
                           holder))
        return 0;
    common::Session& session = *holder;

    // 2. Particles and cells at t = 0.
    PicCells cells(w);
    Recorder recorder(w, about.program, session.history);
    State state = initial_state(w, cells);
    CellFields fields;
    long step = 0;
    if (session.restarting()) {
        session.restore(state, step);
        weigh_cells(w, state, cells);
    }

    // 3. The loop of the slide.
    while (session.keep_going(step, state.time, w.end)) {
        share_pressure(w, state, cells);  // cells: p
        fields_of(w, state, cells, fields);
        recorder.look(step, state, totals_of(w, state, cells), fields, session);
        take_pic_step(w, state, cells);  // Lagrangian phase, particles, Eulerian phase  [PIC]
        ++step;
        session.end_of_step(step, state.time, w.end, state);
    }

    // 4. The end of the run, the results against theory, summary.json.
    if (common::Session::reached(state.time, w.end)) {
        share_pressure(w, state, cells);
        const Totals totals = totals_of(w, state, cells);
        fields_of(w, state, cells, fields);
        recorder.look(step, state, totals, fields, session);
        recorder.finish(state, totals, fields, session);
    }
    return session.finish(step, static_cast<double>(state.particles.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return run(argc, argv, session); });
}
