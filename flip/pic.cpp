// The classical particle-in-cell method of Harlow: compressible fluids, several at a time, with free
// surfaces and with slip at the walls. Cells hold velocity and energy; particles are mass and a
// label, and carry it from cell to cell.
//
// The default case is Sod's shock tube. What one particle more or less in a cell does to the pressure
// can be seen in it, and how the method's own viscosity, which goes with |u|, makes shocks possible.
// Run:   build/pic
//
// Reading order: particles.hpp, state.hpp, equation_of_state.hpp, pic_cells.hpp,
// lagrangian_phase.hpp, eulerian_phase.hpp, ends.hpp.
#include <climits>
#include <cstdio>
#include <optional>

#include "common/session.hpp"
#include "flip/eulerian_phase.hpp"
#include "flip/lagrangian_phase.hpp"

namespace {

using namespace flip;

const common::About about{
    "pic", PROGRAM_VERSION,
    "Harlow's particle-in-cell method for compressible flow; the default case "
    "is Sod's shock tube",
    "flip/cases/sod_pic.toml"};

int run(int argc, char** argv, std::optional<common::Session>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case wanted;
    common::ParameterTable table = describe(wanted);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    const Case w = completed(wanted);
    if (command.dry_run) return 0;
    common::refuse_before_start(command, LONG_MAX, 0);

    // 2. Particles and cells at t = 0.
    common::set_thread_count(command.threads);
    common::Session& session = holder.emplace(about, command, table);
    session.checkpoint_steps = w.checkpoint_steps;
    PicCells cells(w);
    State state = initial_state(w, cells);
    long step = 0;
    if (session.restarting()) {
        session.restore(state, step);
        weigh_cells(w, state, cells);
    }

    // 3. The loop of the slide.
    // [loop]
    while (session.keep_going(step, state.time, w.end)) {
        share_pressure(w, state, cells);  // mesh: p of every cell
        const double dt = largest_step(w, state, cells);
        accelerate_cells(w, dt, state, cells);  // Lagrangian phase: u~   [PIC]
        do_work(w, dt, state, cells);           // Lagrangian phase: I~   [PIC]
        move_particles(w, dt, state, cells);    // particles move to final position [PIC]
        repartition(w, state, cells);           // Eulerian phase   [PIC]
        end_step(w, dt, state);
        ++step;
        session.end_of_step(step, state.time, w.end, state);
    }
    // [/loop]

    const Totals totals = totals_of(w, state, cells);
    std::printf("mass %.12g momentum %.6g energy %.15g\n", totals.mass - state.books.mass,
                totals.momentum_x - state.books.momentum_x,
                totals.kinetic + totals.internal - state.books.energy);
    return session.finish(step, static_cast<double>(state.particles.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return run(argc, argv, session); });
}
