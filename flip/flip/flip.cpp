// FLIP, the fluid-implicit-particle method: Harlow's PIC with particles that keep their momentum and
// their energy. Compressible fluids at all speeds, several at a time, with free surfaces.
//
// The default case is Sod's shock tube; `make flip_sod` draws it beside the same run of pic and the
// exact solution.
// Run:   build/flip
// Run:   build/flip flip/cases/sod.toml flip.transfer=pic
// Run:   build/flip flip/cases/gresho.toml
//
// Reading order: particles.hpp, equation_of_state.hpp, mesh.hpp, deposit_particles.hpp,
// find_pressure.hpp, accelerate_nodes.hpp, solve_pressure.hpp, work_on_cells.hpp, move_mesh.hpp,
// move_particles.hpp.
#include <climits>
#include <cstdio>
#include <optional>

#include "flip/flip/cross_ends.hpp"
#include "flip/flip/deposit_particles.hpp"
#include "flip/flip/flip_fields.hpp"
#include "flip/flip/move_mesh.hpp"
#include "flip/flip/rezone.hpp"
#include "flip/output/record.hpp"
#include "flip/setup/check_case.hpp"
#include "flip/setup/warn_of_case.hpp"

namespace {

using namespace flip;

const common::About about{"flip", PROGRAM_VERSION,
                          "FLIP, particles that keep their momentum: compressible fluids at all "
                          "speeds; the default case is Sod's shock tube",
                          "flip/cases/sod.toml"};

int run(int argc, char** argv, std::optional<common::Session>& holder) {
    // 1. The case: defaults, file, command line; refuse, warn, or only describe.
    Case wanted;
    common::ParameterTable table = describe(wanted);
    const common::CommandLine command = common::read_command_line(argc, argv, about, table);
    refuse_idle(wanted);
    const Case w = completed(wanted);
    refuse_impossible(w, about.program);
    const Scales scales = scales_of(w, about.program);
    const std::vector<std::string> warnings = resolution_warnings(w, scales, about.program);
    for (const std::string& warning : warnings)
        std::fprintf(stderr, "warning: %s\n", warning.c_str());
    if (!command.quiet) std::printf("%s", describe_scales(w, scales, about.program).c_str());
    if (command.dry_run) return 0;
    common::refuse_before_start(command, LONG_MAX, scales.bytes);

    // 2. Particles at t = 0, sorted; an empty mesh.
    common::set_thread_count(command.threads);
    common::Session& session = holder.emplace(about, command, table);
    for (const std::string& warning : warnings) session.summary.warning(warning);
    session.checkpoint_steps = w.checkpoint_steps;
    Mesh mesh = mesh_of(w);
    LagrangianScratch mass_matrix;
    SortScratch sort_scratch;
    Recorder recorder(w, about.program, session.history);
    State state;
    Particles& particles = state.particles = load_particles(w);
    long step = 0;
    if (session.restarting()) session.restore(state, step);
    sort_particles(w.grid, sort_scratch, particles);

    // 3. The loop of the slide.
    // [loop]
    while (session.keep_going(step, state.time, w.end)) {
        deposit_particles(w, particles, mesh);  // particles -> mesh: v_g        [FLIP-8]
        find_pressure(w, state.time, mesh);     // on the mesh: p_c
        recorder.look(step, state, particle_totals(w, particles), cell_fields(w, mesh), session);
        const double dt = step_allowed(w, mesh, state.dt);
        state.report = move_mesh(w, dt, particles, mass_matrix, mesh, state.books);  // F_g, v_g^L
        const long left = move_particles(w, dt, mesh, particles);  // v_p, x_p   [FLIP-6, FLIP-7]
        cross_ends(w, state.time, dt, particles, state.books, left);
        ++step;
        if (w.rezone_steps > 0 && step % w.rezone_steps == 0) rezone(w, particles);
        sort_particles(w.grid, sort_scratch, particles);
        state.time += dt;
        state.dt = dt;
        session.end_of_step(step, state.time, w.end, state);
    }
    // [/loop]

    // 4. The end of the run, the results against theory, summary.json.
    if (common::Session::reached(state.time, w.end)) {
        deposit_particles(w, particles, mesh);
        find_pressure(w, state.time, mesh);
        const Totals totals = particle_totals(w, particles);
        const CellFields cells = cell_fields(w, mesh);
        recorder.look(step, state, totals, cells, session);
        recorder.finish(state, totals, cells, session);
    }
    return session.finish(step, static_cast<double>(particles.count()));
}

}  // namespace

int main(int argc, char** argv) {
    return common::guarded(about, [&](auto& session) { return run(argc, argv, session); });
}
