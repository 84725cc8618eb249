// What every run of every program keeps: the same bits for any number of threads and across a
// restart; a checkpoint when a signal stops it; refusal of checkpoints that are damaged or foreign;
// and a sentence and a summary when it fails.
#include <doctest/doctest.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "tests/support/any_numbers.hpp"
#include "tests/support/any_run.hpp"

using namespace facts;

namespace {

// Runs that differ in what they call: laws, schemes, solvers, walls, plates, bonds, shapes, meshes,
// particles that come and go; and the steps from one of their checkpoints to the next.
const std::string all_runs = R"(
cic streams time.end=2
cic streams time.end=2 method.scheme=energy method.weighting=tsc
cic streams time.end=2 method.weighting=ngp plasma.B_z=0.5 theory.compare=none
cic plane_streams time.end=4
cic plane_streams time.end=4 method.scheme=energy method.stencil=nine_point
cic plane_streams time.end=4 method.weighting=tsc method.sort_interval=1
cic floating time.end=16
cic layer time.end=4
cic mirrors time.end=4 method.weighting=tsc -> 10
fluids shock_tube
fluids wind
fluids channel
fluids falling
fluids layers
fluids noise
flip channel flip.transfer=pic
flip channel flip.transfer=blend
flip channel flip.transfer=apic
flip channel flip.transfer=xpic
flip falling flip.transfer=pic
flip falling flip.transfer=blend
flip falling flip.transfer=apic
flip falling flip.transfer=xpic
flip shock_tube flip.mass=consistent
flip channel flip.density=particles
flip channel implicit
flip falling rezoned
flip channel rezoned flip.density=particles flip.transfer=xpic flip.deficit_to_heat=false
flip vortex
flip vortex flip.transfer=apic
flip rezoned_vortex
flip held
flip held implicit -> 7
fluids swirling
flip swirling flip.transfer=apic time.cfl=0.1
flip swirling flip.pressure=implicit flip.theta=0.6 viscosity.linear=0 viscosity.quadratic=0 -> 5
mpm_explicit rebound
mpm_explicit rebound method.shape=gimp contact.friction=0.3
mpm_explicit rebound method.shape=quadratic method.flip=0.95
mpm_explicit shear
mpm_explicit shear method.shape=quadratic grid.particles_per_side=3
mpm_explicit bonded
mpm_explicit press
mpm_explicit yielding
mpm_explicit sand
mpm_explicit belt
mpm_explicit bar_wave time.end=0.3 method.frozen=true method.shape=gimp -> 15
mpm_implicit rebound
mpm_implicit rebound newton
mpm_implicit rebound method.mass=lumped method.shape=gimp method.theta=0.6
mpm_implicit rebound newton method.volumes=updated method.flip=0.95
mpm_implicit rebound solver.preconditioner=diagonal method.shape=quadratic
mpm_implicit shear
mpm_implicit shear newton
mpm_implicit bonded
mpm_implicit bonded newton
mpm_implicit press
mpm_implicit press newton
mpm_implicit yielding
mpm_implicit bar_wave time.end=0.3 method.frozen=true -> 9
implicit_moment sheet time.end=6
implicit_moment sheet time.end=6 field.theta=0.7 plasma.loading=random
implicit_moment sheet time.end=3 newton
implicit_moment sheet time.end=3 particles.relativistic=true
implicit_moment sheet time.end=3 particles.relativistic=true field.response=mass_matrix
implicit_moment thin_sheet
implicit_moment streams
explicit_em sheet time.end=6 output.history_steps=2
explicit_em sheet time.end=6 particles.order=2 field.smoothing_passes=2
explicit_em sheet time.end=4 particles.order=2 plasma.loading=random
explicit_em streams -> 5
)";

// The checkpoint that a short run of a program leaves, and the step it is of.
struct Kept {
    const Program* program;
    std::string out, path, bytes;
};
Kept short_checkpoint(const Program& program) {
    const std::string out = folder("good_" + program.name);
    REQUIRE(run({&program, "run", {}}, out, "output.checkpoint_steps=5") == 0);
    const std::string path = checkpoints(out).back();
    return {&program, out, path, read_all(path)};
}

// A checkpoint is refused for a reason, and nothing is written.
void check_bad_checkpoint(const Program& program, const std::string& bytes,
                          const std::string& reason, const std::string& overrides = "") {
    const std::string bad = room() + "/bad.bin", out = folder("other");
    if (!bytes.empty()) write_all(bad, bytes == "nothing" ? "" : bytes);
    const int status = run(program.name, " --restart " + bad + overrides, out);
    INFO(program.name << ": " << reason << " in: " << said(out));
    CHECK(status == 2);
    CHECK(holds(said(out), reason));
    CHECK(!fs::exists(out));
}

// A disk that is full after 64 blocks: a limit on the size of files.
std::string on_a_full_disk(const Command& command, const std::string& out) {
    return "trap '' XFSZ; ulimit -f 64; exec " +
           command_line(command.program->name, arguments_of(command)) + " --quiet --out " + out +
           " 2> " + out + ".stderr";
}

}  // namespace

TEST_CASE("one and two and three threads write the same history" * doctest::description("robust")) {
    for (const Command& command : commands(all_runs)) {
        std::vector<std::string> histories;
        INFO(command.program->name << " " << command.words);
        for (const std::string threads : {"1", "2", "3"}) {
            const std::string out = folder("threads");
            REQUIRE(run(command, out, "--threads " + threads) == 0);
            histories.push_back(read_all(out + "/history.dat"));
        }
        CHECK(histories[0].size() > 1000);
        CHECK(histories[1] == histories[0]);
        CHECK(histories[2] == histories[0]);
    }
}

TEST_CASE("a restart goes on with the same bits" * doctest::description("robust")) {
    // Also between files of every kind, and between two rows of the history.
    const std::string with_files = R"(
cic mirrors time.end=4 output.fields_interval=0.4 output.particles_interval=0.4 \
    output.phase_interval=0.4 -> 20
pic shock_tube output.fields_interval=0.02 output.particles_interval=0.02 -> 10
flip vortex output.fields_interval=0.05 output.particles_interval=0.05 -> 5
mpm_explicit slow_shear fast time.end=0.04 output.particles_interval=2e-3 \
    output.grains_interval=2e-3 output.fringes_interval=4e-3 -> 40
explicit_em streams time.end=0.4 output.history_steps=3
explicit_em explicit_weibel.toml uniform.particles_per_cell=16 time.end=0.8 particles.order=2 \
    grid.boundary_z=wall uniform.wave_B_z=0 uniform.B_x=0.1 theory.wave=none -> 5
)";
    for (const Command& command : commands(all_runs + with_files))
        check_restart(
            command.program->name,
            arguments_of({command.program,
                          command.words + " output.checkpoint_steps=" + command.expected[0],
                          {}}));
}

TEST_CASE("the last row and the last files are of the end" * doctest::description("robust")) {
    // Where the intervals of rows and files do not divide the run; and its last checkpoint, from
    // which no step is left, leads to the same row.
    for (const Command& command : commands(R"(
cic streams time.end=4 output.fields_interval=0.7 output.particles_interval=0.7 \
    output.phase_interval=0.7 -> fields particles phase velocities
cic mirrors time.end=4 output.fields_interval=0.7 output.particles_interval=0.7
fluids shock_tube output.fields_interval=0.04 output.particles_interval=0.04 -> fields particles
grains rebound time.end=0.25 output.history_steps=7 output.particles_interval=0.04 \
    output.grains_interval=0.04 output.fringes_interval=0.04
grains press output.history_steps=7 output.particles_interval=0.03 \
    output.grains_interval=0.03 output.fringes_interval=0.03 -> particles grains fringes
implicit_moment sheet time.end=3 output.fields_interval=2.1 output.particles_interval=2.1
explicit_em sheet time.end=4 output.history_steps=3 output.fields_interval=1.4 \
    output.particles_interval=1.7 -> fields particles
)")) {
        const std::string whole = folder("whole"), rest = folder("rest");
        INFO(command.program->name << " " << command.words);
        REQUIRE(run(command, whole, "output.checkpoint_steps=5") == 0);
        const std::vector<double> times = column(whole, "time");
        const long steps = summary(whole)["performance"]["steps"].get<long>();
        const std::string text = read_all(whole + "/case.toml");
        const double end = std::stod(text.substr(text.find("\nend = ") + 7));
        CHECK(times.back() >= end * (1 - 1e-9));
        CHECK(times.back() < end + times[1]);
        for (const std::string& kind : words_in(command.expected[0])) {
            char name[40];
            std::snprintf(name, sizeof name, "/%s_%06ld.dat", kind.c_str(), steps);
            CAPTURE(name);
            CHECK(fs::exists(whole + name));
        }
        REQUIRE(run(command.program->name, "--restart " + checkpoints(whole).back(), rest) == 0);
        CHECK(read_all(rest + "/history.dat") == read_all(whole + "/history.dat"));
    }
}

TEST_CASE("a restart of grains with another end keeps the time step" *
          doctest::description("robust")) {
    // Without time.dt, the step is what leads to the end. The case that the restart leaves tells
    // the step, and makes the same run from the start. What does not change may be told again.
    for (const Command& command : commands("grains rebound time.end=0.1")) {
        INFO(command.program->name);
        const std::string part = folder("part"), rest = folder("rest"), whole = folder("whole");
        REQUIRE(run(command, part, "output.checkpoint_steps=3") == 0);
        REQUIRE(run(command.program->name,
                    "--restart " + checkpoints(part)[0] +
                        " --threads 1 time.end=0.147 load.gravity_y=0",
                    rest) == 0);
        REQUIRE(run(command.program->name, rest + "/case.toml", whole) == 0);
        CHECK(read_all(rest + "/history.dat") == read_all(whole + "/history.dat"));
        CHECK(column(rest, "time")[1] == column(part, "time")[1]);
        // And the first run ends where it was told to.
        CHECK(std::fabs(column(part, "time").back() - 0.1) <= 1e-15);
    }
}

TEST_CASE("a restart goes on wherever its checkpoint was written" *
          doctest::description("robust")) {
    // Before and after a sort, before and after a bond breaks, with and without a contact, after
    // particles came in at the very end of a step; the number of stops.
    for (const Command& command : commands(R"(
cic run
fluids run
fluids translating_frame.toml theory.compare=none time.dt=7.8125e-5 time.end=1.5625e-3 -> 21
implicit_moment run
explicit_em run -> 3
mpm_explicit bonded
mpm_explicit shear time.end=0.02
mpm_explicit press -> 5
mpm_implicit rebound
mpm_implicit rebound newton
mpm_implicit shear
mpm_implicit bonded
mpm_implicit press -> 9
)")) {
        const std::string whole = folder("whole");
        INFO(command.program->name << " " << command.words);
        REQUIRE(run(command, whole) == 0);
        const std::string history = read_all(whole + "/history.dat");
        const long steps = summary(whole)["performance"]["steps"].get<long>();
        for (long stop = 3; 2 * stop <= steps; stop += 1 + steps / std::stol(command.expected[0])) {
            CAPTURE(stop);
            const std::string part = folder("part"), rest = folder("rest");
            REQUIRE(run(command, part, "output.checkpoint_steps=" + std::to_string(stop)) == 0);
            const auto kept = checkpoints(part);
            REQUIRE(kept.size() == 2);
            REQUIRE(run(command.program->name, "--restart " + kept[0] + " --threads 1", rest) == 0);
            CHECK(read_all(part + "/history.dat") == history);
            CHECK(read_all(rest + "/history.dat") == history);
        }
    }
}

TEST_CASE("the effective case runs again to the same bytes of every kind of file" *
          doctest::description("robust")) {
    // The number of files: case, history, and what is asked for.
    for (const Command& command : commands(R"(
cic streams time.end=4 output.fields_interval=1 output.particles_interval=1 \
    output.phase_interval=1
cic floating time.end=4 output.fields_interval=1 output.particles_interval=1 \
    output.phase_interval=1 -> 22
cic mirrors time.end=4 output.fields_interval=1 output.particles_interval=1 \
    output.phase_interval=1 output.vtk=true -> 34
cic plane_streams time.end=4 output.modes=4 output.spectrum=true -> 7
fluids shock_tube -> 3
pic channel output.fields_interval=0.08 output.particles_interval=0.08 output.vtk=true -> 20
flip vortex output.fields_interval=0.12 output.particles_interval=0.12 output.vtk=true -> 21
flip channel rezoned output.particles_interval=0.08 -> 6
mpm_explicit rebound time.end=0.2 output.particles_interval=0.1 output.grains_interval=0.1 \
    output.fringes_interval=0.1 output.pixels_per_cell=2 output.pack=true
mpm_implicit rebound newton output.particles_interval=0.15 output.grains_interval=0.15 \
    output.fringes_interval=0.15 output.pixels_per_cell=2 output.pack=true -> 12
mpm_explicit bonded output.particles_interval=2.5 output.vtk=true -> 9
mpm_explicit rebound time.end=0.01 grain.left.shape=polygon grain.left.angle=1e-3 \
    material.more.nu=0.123456789012345678 grain.right.material=more -> 4
mpm_implicit press method.theta=0.7 solver.tolerance=1e-12 solver.preconditioner=diagonal \
    method.mass=lumped -> 2
implicit_moment sheet time.end=3 output.fields_interval=3 output.particles_interval=3
implicit_moment thin_sheet
implicit_moment streams
explicit_em sheet time.end=4 output.fields_interval=2 output.particles_interval=2 \
    output.vtk=true
explicit_em streams -> 2 or more
)")) {
        const std::string first = folder("first"), again = folder("again");
        INFO(command.program->name << " " << command.words);
        REQUIRE(run(command, first) == 0);
        // A checkpoint holds the name of its case, too.
        const std::string name = summary(first)["case"], same = room() + "/" + name + ".toml";
        fs::copy_file(first + "/case.toml", same, fs::copy_options::overwrite_existing);
        REQUIRE(run(command.program->name, same, again) == 0);
        const int files = check_same_files(first, again);
        CHECK(check_same_files(again, first) == files);
        const int expected = std::stoi(command.expected[0]);
        CHECK((holds(command.expected[0], "more") ? files >= expected : files == expected));
    }
}

TEST_CASE("the runs that are repeated do what they are repeated for" *
          doctest::description("robust")) {
    const std::string out = folder("events");
    using Values = std::vector<double>;
    const auto of = [&](const std::string& command, const std::string& name) {
        REQUIRE(run(commands(command)[0], out, "--force") == 0);
        return column(out, name);
    };
    const auto again = [&](const std::string& name) { return column(out, name).back(); };
    const auto changes = [](const Values& v) {
        return std::any_of(v.begin(), v.end(), [&](double one) { return one != v[0]; });
    };
    // Walls take and give particles.
    CHECK(changes(of("cic floating time.end=16", "count_electrons")));
    CHECK(changes(column(out, "charge_x_high")));
    CHECK(changes(of("cic layer time.end=4", "count_electrons")));
    CHECK(changes(of("cic mirrors time.end=4", "count_right")));
    // What flows in leaves at the other end, or not; particles split and merge; pressures iterate.
    const Values wind = of("flip wind", "mass"), channel = of("flip channel", "mass"),
                 falling = of("flip falling", "mass");
    CHECK(wind.back() > 1.1 * wind.front());
    CHECK(channel.back() != channel.front());
    CHECK(std::fabs(channel.back() / channel.front() - 1) <= 0.1);
    CHECK(falling.back() < 0.99 * falling.front());
    const auto particles = [&](const std::string& command) {
        of(command, "mass");
        return summary(out)["performance"]["particles"].get<double>();
    };
    CHECK(particles("flip falling rezoned") != particles("flip falling"));
    CHECK(particles("flip rezoned_vortex") != particles("flip vortex"));
    CHECK(of("flip vortex", "iterations").back() > 1);
    CHECK(of("flip channel implicit", "iterations").back() > 1);
    // Grains meet and rub, by more than their round-off, cross the ends of the mesh, and yield; a
    // bond holds and breaks; a plate is pushed.
    for (const std::string grains :
         {"mpm_explicit rebound", "mpm_implicit rebound", "mpm_implicit rebound newton"})
        CHECK(of(grains, "contact_force").back() > 0);
    CHECK(again("friction") < -1e-2 * again("energy"));
    for (const std::string with : {"mpm_explicit", "mpm_implicit", "mpm_implicit newton"}) {
        INFO(with);
        const std::string program = with.substr(0, with.find(' ')),
                          solver = with.substr(program.size());
        const bool implicit = program == "mpm_implicit";
        if (implicit) {
            of(program + " rebound" + solver, "friction");
            CHECK(again("friction") < -1e-2 * again("energy"));
        }
        CHECK(of(program + " shear" + solver, "contacts").back() >= 40);
        CHECK(again("friction") < (implicit ? -1e-2 * again("energy") : 0));
        CHECK(again("travel_x_top_g0005") > 0.07);
        CHECK(of(program + " bonded" + solver, "broken_bonds").back() == 1);
        CHECK(column(out, "broken_bonds")[3] == 0);
        CHECK(column(out, "bond_normal_1")[implicit ? 3 : 20] > 0);
        CHECK(of(program + " press" + solver, "travel_y_top").back() < 0);
        CHECK(again("force_y_top") > 10);
    }
    for (const std::string yielding :
         {"mpm_explicit yielding", "mpm_explicit sand", "mpm_implicit yielding"})
        CHECK(of(yielding, "plastic").back() > 0);
    // A sheet reconnects some of its flux.
    CHECK(changes(of("implicit_moment sheet time.end=6", "flux")));
    CHECK(changes(of("explicit_em sheet time.end=4", "flux")));
}

TEST_CASE("a signal stops a run after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    // The time step and the exit status, which is 128 and the signal.
    for (const Command& command : commands(R"(
cic floating -> 0.4 130
cic plane_streams -> 0.1 143
fluids sod.toml grid.cells_x=40 time.dt=0.001 theory.compare=none particles.per_cell_x=40
    0.001 130
pic layers theory.compare=none time.dt=0.01 -> 0.01 143
flip vortex theory.compare=none grid.cells_x=24 grid.cells_z=24 time.dt=0.01 -> 0.01 143
mpm_explicit slow_shear time.dt=8e-4 -> 8e-4 130
mpm_explicit bar_wave time.dt=1.5e-3 -> 1.5e-3 143
mpm_implicit slow_shear time.alpha=1 time.dt=3e-3 -> 3e-3 130
mpm_implicit bar_wave time.dt=8e-3 -> 8e-3 143
implicit_moment sheet -> 0.3 143
implicit_moment sheet -> 0.3 130
explicit_em sheet -> 0.2 143
explicit_em sheet -> 0.2 129
)")) {
        const std::string stopped = folder("stopped"), unstopped = folder("unstopped");
        INFO(command.program->name << " " << command.words);
        const double dt = std::stod(words_in(command.expected[0])[0]);
        const int status = std::stoi(words_in(command.expected[0])[1]);
        const auto until = [&](double steps) { return " time.end=" + std::to_string(dt * steps); };
        const pid_t child =
            started(command_line(command.program->name,
                                 arguments_of({command.program, command.words + until(1e6), {}})),
                    stopped);
        std::error_code ignored;
        wait_for([&] {
            const auto size = fs::file_size(stopped + "/history.dat", ignored);
            return !ignored && size > 4000;
        });
        kill(child, status - 128);
        int ended = 0;
        waitpid(child, &ended, 0);
        CHECK(WIFEXITED(ended));
        CHECK(WEXITSTATUS(ended) == status);
        CHECK(summary(stopped)["status"] == status);
        const auto kept = checkpoints(stopped);
        REQUIRE(kept.size() == 1);
        const auto steps = std::stol(kept[0].substr(kept[0].size() - 14, 10));
        CHECK(steps > 0);
        // Ten more steps in the same folder end as without the interruption.
        const std::string end = until(double(steps + 10));
        REQUIRE(run(command.program->name, "--restart " + kept[0] + end, stopped) == 0);
        REQUIRE(run(command, unstopped, end) == 0);
        CHECK(read_all(stopped + "/history.dat") == read_all(unstopped + "/history.dat"));
    }
}

TEST_CASE("a second signal ends a run at once" * doctest::description("robust")) {
    // Steps so long that the first signal is still waiting for the end of one.
    const std::string out = folder("killed");
    const Command command = commands(
        "mpm_explicit bar_wave grid.cells_x=800 grid.cells_y=200 time.end=100 --threads 1")[0];
    // The step may end before the program is held, so there is more than one try.
    int status = 0;
    for (int attempt = 0; attempt < 5 && !WIFSIGNALED(status); ++attempt) {
        fs::remove_all(out);
        const pid_t child = started(command_line("mpm_explicit", arguments_of(command)), out);
        wait_for([&] { return fs::exists(out + "/history.dat"); });
        kill(child, SIGINT);
        usleep(5000);
        kill(child, SIGSTOP);
        usleep(400000);
        kill(child, SIGINT);
        kill(child, SIGCONT);
        waitpid(child, &status, 0);
    }
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGINT);
    CHECK(!fs::exists(out + "/summary.json"));
}

TEST_CASE("damaged and cut and foreign checkpoints are refused and nothing is written" *
          doctest::description("robust")) {
    const std::string bad = room() + "/bad.bin";
    std::vector<Kept> all;
    for (const Program& program : every_program()) all.push_back(short_checkpoint(program));
    for (const auto& [program, out, path, good] : all) {
        REQUIRE(good.size() > 10000);
        for (const std::size_t place : {std::size_t{20}, std::size_t{60}, good.size() / 3,
                                        good.size() / 2, good.size() - 9, good.size() - 1}) {
            std::string flipped = good;
            flipped[place] = static_cast<char>(flipped[place] ^ 0x10);
            check_bad_checkpoint(*program, flipped, "the checkpoint is damaged");
        }
        for (const std::string& length :
             {good.substr(0, 10), good.substr(0, 24), good.substr(0, 100),
              good.substr(0, good.size() - 1), good + "x"})
            check_bad_checkpoint(*program, length,
                                 "the checkpoint is cut off or too long; use an earlier one");
        std::string foreign = good;
        foreign[0] ^= 1;
        for (const std::string& other :
             {std::string("nothing"), good.substr(0, 5), foreign, std::string(1000, 'x')})
            check_bad_checkpoint(*program, other, "bad.bin: is not a checkpoint");

        // Another program's; another version's; one without anything in it.
        for (const Kept& other : all)
            if (other.program != program)
                check_bad_checkpoint(*program, other.bytes,
                                     "is a checkpoint of '" + other.program->name + "', not of '" +
                                         program->name + "'");
        for (const auto& [version, reason] :
             {std::pair{"0.0.1", "was written by version 0.0.1"},
              std::pair{PROGRAM_VERSION, "the checkpoint ends too early"}}) {
            common::CheckpointWriter({program->name, version, "", ""}, bad, "", "").finish();
            check_bad_checkpoint(*program, "", reason);
        }
    }
}

TEST_CASE("of files that are due after the end only those of the start are there" *
          doctest::description("robust")) {
    for (const Program& program : every_program()) {
        std::vector<std::size_t> counts;
        for (const char* interval : {"1e3", "1e30", "1e39"}) {
            const std::string out = folder("seldom");
            const std::string key =
                program.item == "grain" ? "output.particles_interval" : "output.fields_interval";
            REQUIRE(run({&program, "run " + key + "=" + interval, {}}, out) == 0);
            counts.push_back(
                std::size_t(std::distance(fs::directory_iterator(out), fs::directory_iterator())));
        }
        INFO(program.name);
        CHECK(counts[1] == counts[0]);
        CHECK(counts[2] == counts[0]);
    }
}

TEST_CASE("wrong restarts are refused with the reason" * doctest::description("robust")) {
    // What cannot change.
    const std::vector<Command> fixed = commands(R"(
cic run
    time.dt=0.2 method.weighting=tsc output.modes=5 grid.boundary_x=wall boundary.x_low=floating
    theory.compare=wave species.right.charge=2 species.beam.density=1
fluids run -> time.cfl=0.2 grid.cells_x=20 theory.compare=none left.density=2
grains run
    time.alpha=0.2 method.shape=gimp grid.periodic_x=true boundary.x_low=slip contact.friction=1
    load.gravity_y=-1 material.default.E=1 pack.p.velocity_x=1 bond.joint.tension=1 grain.more.x=1
    theory.compare=spin output.history_steps=2
mpm_implicit run
    method.theta=1 method.mass=lumped method.volumes=updated solver.kind=newton_krylov
    solver.tolerance=1e-9
plasmas run -> time.dt=0.1 grid.cells_x=8 plasma.setup=uniform species.beam.density=1
)");
    for (const Program& program : every_program()) {
        const Kept kept = short_checkpoint(program);
        const std::string restart = "--restart good.bin ";
        std::vector<Row> rows{
            {"missing", {}, "--restart nowhere.bin", "nowhere.bin: there is no such file"},
            {"folder", {}, "--restart earlier", "earlier: is a folder, not a file"},
            {"text", {}, "--restart a_file", "a_file: is not a checkpoint"},
            {"with a case", "", restart,
             "--restart takes its case from the checkpoint: leave out 'case.toml'"},
            {"into an earlier run",
             {},
             restart + "--out earlier",
             "earlier: holds an earlier run; --force replaces it"}};
        // The plasmas may change all of output.*, and so name what it may have been.
        if (program.method == "implicit_moment")
            rows.push_back({"unknown key",
                            {},
                            restart + "output.vkt=true",
                            "unknown parameter 'output.vkt'; did you mean 'output.vtk'?"});
        const bool counted = program.method != "flip";  // or steps are as long as the flow allows
        const std::string is =
            counted ? "is at step " +
                          std::to_string(std::stol(kept.path.substr(kept.path.size() - 14))) +
                          ", and the run ends at step "
                    : "has a row of t = " + common::format(column(kept.out, "time").end()[-2]) +
                          ", and the run ends at t = ";
        std::vector<std::pair<std::string, std::string>> ends{{"0", "0"}};
        if (program.name == "cic") ends.push_back({"0.25", "5"});
        if (program.name == "mpm_explicit") ends.push_back({"0.05", "15"});
        if (!counted) ends.push_back({"0.02", "0.02"});
        for (const auto& [time, end] : ends)
            rows.push_back({"beyond its end",
                            {},
                            restart + "time.end=" + time,
                            "good.bin: " + is + end + ": raise time.end"});
        for (const Command& command : fixed)
            for (const std::string& change : words_in(joined(command.expected)))
                if (command.program == &program)
                    rows.push_back({"change",
                                    {},
                                    restart + change,
                                    "command line: '" + change + "': '" +
                                        change.substr(0, change.find('=')) +
                                        "' cannot change on a restart; start a new run with it"});
        check_refused(program, rows, {{"good.bin", kept.bytes}});
    }
}

TEST_CASE("a full disk ends a run with a sentence and no half of a file" *
          doctest::description("robust")) {
    for (const Command& command : commands(R"(
cic line time.end=10000
fluids run time.end=10
grains bar_wave no_files time.end=100
implicit_moment sheet time.end=600 output.fields_interval=0
explicit_em sheet time.end=400 -> history.dat: cannot be written; is the disk full?
cic line species.electrons.particles_per_cell=1000 output.checkpoint_steps=5
fluids run grid.cells_x=400 output.checkpoint_steps=5
grains press output.checkpoint_steps=5
implicit_moment sheet time.end=6 output.fields_interval=0 output.checkpoint_steps=5
explicit_em sheet output.checkpoint_steps=5 -> checkpoint
cic plane_streams output.fields_interval=0 output.particles_interval=0.1
fluids run grid.cells_x=400 output.particles_interval=0.1
grains slow_shear output.particles_interval=0.1
implicit_moment sheet output.fields_interval=0 output.particles_interval=3
explicit_em sheet output.particles_interval=2 -> particles_000000.dat
fluids run grid.cells_x=800 output.fields_interval=0.1
explicit_em sheet output.fields_interval=2 -> fields_000000.dat
mpm_explicit bar_wave no_files output.fringes_interval=1 output.pixels_per_cell=64
    fringes_000000.dat
)")) {
        const std::string out = folder("full");
        const int status = shell(on_a_full_disk(command, out));
        INFO(command.program->name << " " << command.words << ": " << said(out));
        CHECK(status == 2);
        CHECK(holds(said(out), command.expected[0]));
        for (const auto& entry : fs::directory_iterator(out))
            CHECK(!holds(entry.path().string(), ".partial"));
    }
    // A folder that cannot be made.
    const std::string file = room() + "/a_file";
    write_all(file, "not a folder\n");
    for (const Program& program : every_program()) {
        const std::string out = file + "/run", stderr_of = room() + "/said";
        CHECK(shell(command_line(program.name, arguments_of({&program, "run", {}})) +
                    " --quiet --out " + out + " 2> " + stderr_of) == 2);
        CHECK(holds(read_all(stderr_of), program.name + ": "));
        CHECK(read_all(file) == "not a folder\n");
    }
}

TEST_CASE("closed pipes and closed outputs do not stop a run" * doctest::description("robust")) {
    for (const Program& program : every_program()) {
        INFO(program.name);
        const std::string out = room() + "/pipe", status = room() + "/status";
        fs::create_directories(room());
        const std::string line = command_line(program.name, arguments_of({&program, "run", {}})) +
                                 " --force --out " + out + " ";
        CHECK(shell(line + "2> /dev/null | true") == 0);
        const std::string history = read_all(out + "/history.dat");
        CHECK(shell(line + "0<&- 1>&- 2>&-") == 0);
        // What is meant for the terminal gets into no file.
        CHECK(read_all(out + "/history.dat") == history);
        CHECK(shell("(" + line + "2>&1; echo $? > " + status + ") | head -1 > /dev/null") == 0);
        CHECK(read_all(status) == "0\n");
        CHECK(summary(out)["status"] == 0);
    }
}

TEST_CASE("force replaces every kind of file of an earlier run and no other file" *
          doctest::description("robust")) {
    // Some of the files that the earlier run has left.
    for (const Command& command : commands(R"(
cic plane_streams time.end=1.5 output.fields_interval=0.5 output.particles_interval=0.5 \
    output.phase_interval=0.5 output.vtk=true output.modes=2 output.spectrum=true \
    output.checkpoint_steps=5
    velocities_000005.dat phase_000005.dat spectrum.dat particles_000000.vtp fields_000000.vti
fluids layers output.particles_interval=0.2 output.fields_interval=0.2 output.vtk=true \
    output.checkpoint_steps=20
    particles_000000.dat particles_000000.vtp fields_000000.dat fields_000000.vti
grains rebound time.end=0.1 output.particles_interval=0.05 output.vtk=true \
    output.fringes_interval=0.05 output.grains_interval=0.05 output.pack=true \
    output.checkpoint_steps=5
    particles_000000.dat particles_000000.vtp fringes_000000.dat grains_000000.dat pack.txt
implicit_moment sheet time.end=3 output.fields_interval=1.5 output.particles_interval=1.5 \
    output.vtk=true output.checkpoint_steps=5
explicit_em sheet time.end=4 output.fields_interval=2 output.particles_interval=2 \
    output.vtk=true output.checkpoint_steps=5
    particles_000000.dat particles_000000.vtp fields_000000.dat fields_000000.vti
)")) {
        const std::string out = folder("replaced"), fresh = folder("fresh");
        const Command plain{command.program, "run", {}};
        INFO(command.program->name);
        REQUIRE(run(command, out) == 0);
        for (const std::string& name : words_in(joined(command.expected))) {
            CAPTURE(name);
            CHECK(fs::exists(out + "/" + name));
        }
        CHECK(checkpoints(out).size() == 2);
        // Without force nothing is touched.
        const Files there = content(out);
        CHECK(run(plain, out) == 2);
        CHECK(holds(said(out), "holds an earlier run; --force replaces it"));
        CHECK(content(out) == there);

        const std::vector<std::string> mine{"fields_of_gold.dat",     "phase_of_the_moon.txt",
                                            "fringes_of_the_sea.dat", "grains_of_sand.dat",
                                            "pack.txt.old",           "notes.txt",
                                            "thesis.partial"};
        for (const std::string& name : mine) write_all(out + "/" + name, "kept");
        REQUIRE(run(plain, out, "--force") == 0);
        REQUIRE(run(plain, fresh) == 0);
        CHECK(content(out).size() == content(fresh).size() + mine.size());
        for (const std::string& name : mine) CHECK(read_all(out + "/" + name) == "kept");
        // A folder that holds only such files is not ours.
        const std::string foreign = folder("foreign");
        write_all(foreign + "/" + mine[3], "kept");
        CHECK(run(plain, foreign) == 2);
        CHECK(holds(said(foreign), "is not empty; --force writes into it, and leaves what is not"));
    }
}

TEST_CASE("a run that fails says what and where and when and leaves a summary" *
          doctest::description("robust")) {
    check_failures(R"(
cic landau.toml time.dt=1.9 time.end=800 species.electrons.amplitude=0.5 \
    species.electrons.temperature_x=0.1 species.electrons.particles_per_cell=100
    .*: reduce time.dt, refine the mesh, take method.scheme = "energy", or allow more with
    time.energy_limit
cic plasma_wave.toml method.weighting=ngp species.electrons.amplitude=0.05
    .*: reduce time.dt, refine the mesh, take method.weighting = "cic", or allow more with
    time.energy_limit
# From mirror to mirror and beyond.
cic mirrors boundary.potential_z_high=1e9
    .*a particle moves farther than the box in one step, at step.*
pic sod.toml time.dt=0.008
    the internal energy of (left|right), NUMBER, is negative or not finite in the cell at x =
    NUMBER, z = NUMBER at t = NUMBER: use a smaller time.cfl, more particles per cell, or more
    viscosity \(in step NUMBER\)
# A disk that falls upon a wall in steps that are too long.
fluids falling theory.compare=none gravity.x=100 walls_x
pic wall_shock.toml time.dt=0.005 viscosity.linear=0 viscosity.quadratic=0
    a particle has gone through the wall to x = NUMBER, z = NUMBER at t = NUMBER: reduce time.cfl,
    or time.dt where it is set; where that does not help, particles make more noise than the flow:
    raise particles.per_cell_x \(in step NUMBER\)
flip noh.toml grid.cells_x=24 grid.cells_z=24 time.cfl=1 viscosity.linear=0 viscosity.quadratic=0 flip.mass=consistent theory.compare=none
    density or internal energy is negative in the cell at x = NUMBER, z = NUMBER at t = NUMBER:
    reduce time.cfl, raise viscosity.linear, or take more particles per cell \(in step NUMBER\)
flip vortex flip.max_iterations=1
    the implicit pressure has not converged: the limit of iterations is reached; after 1
    iterations the residual is NUMBER and not NUMBER; raise flip.max_iterations or reduce
    time.cfl \(in step 0\)
fluids shock_tube time.energy_limit=0.99
    the energy is NUMBER where the start and the work done are NUMBER, at step 0, t = 0: reduce
    time.cfl, refine the mesh, or allow more with time.energy_limit
# Free flight to each side, and a plate.
mpm_explicit rebound grain.left.velocity_x=-3
mpm_explicit rebound grain.left.velocity_y=-3 method.shape=quadratic
mpm_implicit rebound grain.left.velocity_x=-3
    a particle of grain 'left' has left the mesh at \(NUMBER, NUMBER\) at step [0-9]+, t = NUMBER.*
mpm_explicit rebound grain.right.velocity_x=3
mpm_explicit rebound grain.right.velocity_y=3
    a particle of grain 'right' has left the mesh at \(NUMBER, NUMBER\) at step [0-9]+, t = NUMBER:
    widen the mesh, put a wall there, or reduce time.alpha if the grain has burst
mpm_explicit press grain.bottom.velocity_y=-1
    a particle of grain 'bottom' has left the mesh at \(NUMBER, NUMBER\) at step [0-9]+, t =
    NUMBER: widen the mesh, or end its motion before that
# Steps beyond the stability limit burst the disks.
mpm_explicit rebound.toml theory.compare=none time.alpha=1.2
    the energy is NUMBER, and NUMBER was put in, at step [0-9]+, t = NUMBER; fastest is grain
    '(left|right)' at \(NUMBER, NUMBER\): reduce time.alpha, refine the mesh, or allow more with
    time.energy_limit
# Plates that come together faster than sound, in steps that are too long.
mpm_explicit squeeze load.rise=0 time.alpha=1.5 time.energy_limit=0 grain.bottom.velocity_y=50 \
    grain.top.control=velocity grain.top.velocity_y=-50
    the volume of a particle of grain 'disk' at \(NUMBER, NUMBER\) is inverted at step [0-9]+, t =
    NUMBER: reduce time.alpha, refine the mesh, or load the grain more slowly
# A solver that does not get there says with whom and how far it was.
mpm_implicit rebound solver.max_iterations=1
mpm_implicit rebound solver.max_iterations=1 method.mass=lumped solver.preconditioner=diagonal
    the velocities of the nodes are not found in 1 iterations: residual .*
mpm_implicit rebound newton solver.max_iterations=1
    the velocities of the nodes before the step are not found in 1 iterations: residual .*
mpm_implicit rebound solver.max_outer_iterations=1
    contact did not settle in 1 loops: grain 'left' and grain 'right'.*reduce time.alpha, or raise
    solver.max_outer_iterations.*
mpm_implicit rebound newton solver.max_outer_iterations=1
    Newton's iteration did not converge: .*residual .*hardest pressed are grain 'left' and grain
    'right'.*
implicit_moment sheet time.end=6 field.max_iterations=1 -> .*did not converge.*
# A beam of a few particles in a wave that throws it over cells in a step.
explicit_em explicit_light_wave.toml uniform.wave_E_y=0 uniform.wave_E_z=1000 theory.wave=none \
    species.beam.charge=-1 particles.relativistic=false uniform.particles_per_cell=4 time.end=5
    .*cross more than a cell in one step: they were loaded too fast, or the field has blown up; reduce time.dt.*
# Far more charge than the mesh can hold back: the energy is not that of the start.
explicit_em explicit_langmuir.toml time.dt=0.65 time.end=600 species.electrons.density=9.3 \
    uniform.particles_per_cell=4 species.electrons.temperature_x=1e-4 theory.wave=none \
    output.history_steps=1 -> .*at step.*
)");
    // A step far beyond the closure.
    const Untrapped calm;
    check_failures("implicit_moment sheet time.end=6000 time.dt=6\n    .*at step.*");
    CHECK(holds(said(room() + "/failed"), "warning"));
}

TEST_CASE("energy that a run has been given does not stop it" * doctest::description("robust")) {
    const std::string out = folder("given");
    const auto end = [&](const std::string& command) {
        const int status = run(commands(command)[0], out, "--force");
        INFO(said(out));
        CHECK(status == 0);
        return column(out, "energy");
    };
    // Electrons at rest on a lattice have no energy but that of round-off, and it grows.
    const auto rest =
        end("cic two_stream.toml species.right.drift_x=0 species.left.drift_x=0 "
            "species.right.amplitude=0 species.left.amplitude=0 theory.compare=none "
            "species.right.loading=quiet species.left.loading=quiet output.phase_interval=0 "
            "output.particles_interval=0");
    CHECK(rest.back() != rest.front());
    // A cold disk falls and has a thousand times the energy of its start.
    const auto fall =
        end("flip falling theory.compare=none region.disk.speed=0.01 gravity.trap=0 gravity.x=0 "
            "gravity.z=-0.3 region.disk.radius=0.1 region.disk.center_z=0.2");
    CHECK(fall.back() > 1000 * fall.front());
    // A disk falls, is thrown back, and passes the height of its start with some energy to spare.
    end("mpm_explicit small_disk material.default.law=elastic boundary.x_low=slip "
        "grain.disk.x=0.25 method.shape=gimp grain.disk.velocity_x=0 load.gravity_x=-2 "
        "time.end=1.2");
    CHECK(column(out, "contact_force").size() > 10);
}

TEST_CASE("the summary holds what the contract names" * doctest::description("robust")) {
    for (const Program& program : every_program()) {
        const std::string out = folder("summary");
        INFO(program.name);
        REQUIRE(run({&program, "run", {}}, out) == 0);
        const auto json = summary(out);
        for (const char* key : {"program", "version", "case", "status", "results", "conservation",
                                "performance", "warnings"}) {
            CAPTURE(key);
            CHECK(json.contains(key));
        }
        CHECK(json["program"] == program.name);
        for (const char* key : {"wall_s", "steps", "particle_steps", "particle_steps_per_s",
                                "threads", "peak_memory_bytes"}) {
            CAPTURE(key);
            CHECK(json["performance"][key].is_number());
        }
        for (const auto& result : json["results"].items()) {
            INFO(result.key());
            CHECK(result.value().contains("value"));
            CHECK(result.value().contains("unit"));
            if (!result.value().contains("pass")) continue;
            CHECK(result.value().contains("source"));
            CHECK(result.value()["pass"] == (result.value()["verdict"] == "PASS"));
            CHECK(result.value().contains("expected") == result.value().contains("tolerance"));
            CHECK(result.value().contains("expected") + result.value().contains("at_most") +
                      result.value().contains("at_least") +
                      (result.value()["verdict"] == "NOT MEASURED") ==
                  1);
        }
        if (program.name != "implicit_moment") continue;
        CHECK(json["performance"]["particle_steps"] == 40000);
        CHECK(json["results"]["flux_initial"]["verdict"] == "PASS");
    }
}

TEST_CASE("the command of a summary runs again to the same bytes" *
          doctest::description("robust")) {
    const fs::path out = fs::path(folder("summed up")) / "it's here";
    fs::create_directories(out.parent_path());
    std::string command = BUILD_FOLDER;
    command.append("/cic time.end=1 'species.left.amplitude=2e-3' --quiet --force --out \"");
    command.append(out.string()).append("\" 2> /dev/null");
    REQUIRE(std::system(command.c_str()) == 0);
    const std::string history = read_all(out / "history.dat");
    const auto summary = nlohmann::json::parse(read_all(out / "summary.json"));
    CHECK(!summary["host"].get<std::string>().empty());
    CHECK(holds(summary["flags"].get<std::string>(), "-std=c++20"));
    CHECK(holds(summary["compiler"].get<std::string>(), "."));
    CHECK(summary.contains("revision"));
    fs::remove_all(out);
    const std::string again = summary["command"].get<std::string>() + " 2> /dev/null";
    REQUIRE(std::system(again.c_str()) == 0);
    CHECK(read_all(out / "history.dat") == history);
}

TEST_CASE("an installed program finds its cases from any folder" * doctest::description("robust")) {
    const fs::path root = folder("installed");
    fs::create_directories(root / "bin");
    fs::copy_file(std::string(BUILD_FOLDER) + "/cic", root / "bin/cic");
    fs::create_directories(root / "share/particle-in-cell/cic");
    fs::copy("cic/cases", root / "share/particle-in-cell/cic/cases");
    for (const char* words : {"", "cic/cases/landau.toml"}) {
        const std::string command = "cd " + root.string() + " && bin/cic --dry-run " + words;
        CHECK(std::system((command + " > said 2> warned").c_str()) == 0);
        CHECK(holds(read_all(root / "said"), "weighting"));
    }
    CHECK(std::system(
              ("cd " + root.string() + " && bin/cic cic/cases/ladau.toml > said 2>&1").c_str()) !=
          0);
    CHECK(holds(read_all(root / "said"), "landau, misprint"));
}

TEST_CASE("a dry run tells the memory that the run takes and a checkpoint takes no more" *
          doctest::description("robust")) {
    if (holds(BUILD_FOLDER, "sanitize")) return;  // whose own memory is larger
    constexpr double start_up = 6;                // of every process [MiB]
    for (const Command& command : commands(R"(
cic two_stream.toml theory.compare=none grid.cells_x=4096 time.end=0.3
cic two_stream_2d.toml theory.compare=none grid.cells_x=256 grid.cells_z=256 time.end=0.6 \
    method.sort_interval=2
fluids sod.toml grid.cells_x=400 grid.cells_z=200 grid.length_z=0.5 particles.per_cell_x=4 \
    particles.per_cell_z=4 theory.compare=none time.end=2e-3
flip gresho.toml theory.compare=none grid.cells_x=192 grid.cells_z=192 time.end=0.002
mpm_explicit rebound.toml theory.compare=none grid.cells_x=768 grid.cells_y=384 time.end=6e-4
mpm_explicit shear.toml grid.cells_x=200 grid.cells_y=184 time.end=3e-3
mpm_implicit rebound.toml theory.compare=none grid.cells_x=288 grid.cells_y=144 time.end=4e-3
implicit_moment gem.toml grid.cells_x=128 grid.cells_z=128 harris.particles=800000 time.end=0.9
explicit_em gem_explicit.toml harris.particles=1500000 time.end=0.18
)")) {
        const std::string out = folder("memory"), text = check_described(command).out;
        INFO(command.program->name << " " << command.words << ": " << text);
        std::smatch memory;
        REQUIRE(std::regex_search(text, memory, std::regex("memory +about ([0-9.e+]+) MiB")));
        double peak[2] = {0, 0};
        for (const int with : {0, 1}) {
            const std::string steps = std::to_string(2 * with), into = out + steps;
            fs::remove_all(into);
            REQUIRE(run(command, into, "output.checkpoint_steps=" + steps) == 0);
            CHECK(checkpoints(into).empty() == (with == 0));
            peak[with] = summary(into)["performance"]["peak_memory_bytes"].get<double>() / 1048576;
            fs::remove_all(into);
        }
        CAPTURE(peak[0]);
        CHECK(peak[0] > 30);
        CHECK(std::stod(memory[1]) >= 0.8 * (peak[0] - start_up));
        CHECK(std::stod(memory[1]) <= 1.3 * (peak[0] - start_up));
        CHECK(peak[1] <= 1.1 * peak[0]);
    }
}

TEST_CASE("a pack that is written and read again gives the same run" *
          doctest::description("robust")) {
    const auto rows = [](const std::string& out) {
        const std::string text = read_all(out + "/history.dat");
        return text.substr(text.find('\n', text.find("# units:")) + 1);
    };
    for (const Command& command : commands(R"(
grains written_pack pack.p.kind=hexagonal pack.p.radius=0.15 pack.p.x=0.2 \
    pack.p.y=0.2
grains written_pack pack.p.kind=random pack.p.width=1 pack.p.height=0.6 \
    pack.p.sides=5
)")) {
        INFO(command.program->name << " " << command.words);
        const std::string first = folder("first_pack"), again = folder("again_pack");
        REQUIRE(run(command, first) == 0);
        REQUIRE(run(command, again,
                    "pack.p.kind=file pack.p.sides=0 pack.p.file=" + first + "/pack.txt") == 0);
        CHECK(rows(first).size() > 1000);
        CHECK(rows(again) == rows(first));
        CHECK(column(again, "contacts").back() == column(first, "contacts").back());
        const std::string pack = read_all(again + "/pack.txt");
        CHECK(std::regex_replace(pack, std::regex(" p_p_"), " p_") ==
              read_all(first + "/pack.txt"));
    }
}

TEST_CASE("a restart reads its pack again and wants the same one" *
          doctest::description("robust")) {
    const std::string pack = "disk a 0.3 0.3 0.1\ndisk b 0.5 0.3 0.1\n";
    for (const Program* one : programs_called("grains")) {
        const Program& program = *one;
        const fs::path folder = fresh_folder(program);
        write_all(folder / "pack.txt", pack);
        REQUIRE(start(program, folder,
                      arguments_of({&program,
                                    "mesh end time.alpha=0.1 pack.p.kind=file "
                                    "pack.p.file=pack.txt bond.joint.a=p_a",
                                    {}}) +
                          " --quiet output.checkpoint_steps=10 --out run")
                    .status == 0);
        const std::string path = checkpoints(folder / "run").back(), good = read_all(path);
        check_refused(program,
                      {{"without its pack", std::nullopt, "--restart good.bin",
                        "[pack.p]: pack.txt: there is no such file"}},
                      {{"good.bin", good}});
        for (const std::string& other :
             {pack + "disk c 0.8 0.3 0.1\n", "disk a 0.3 0.3 0.1\n" + pack,
              std::string("disk a 0.3 0.3 0.1\ndisk b 0.5 0.3 0.09\n")}) {
            const fs::path here = fresh_folder(program);
            write_all(here / "pack.txt", other);
            write_all(here / "good.bin", good);
            const Outcome outcome =
                start(program, here, "--restart good.bin --out again --force --quiet");
            INFO(outcome.err);
            CHECK(outcome.status == 2);
            CHECK(outcome.sentences.size() == 1);
        }
    }
}

TEST_CASE("the end of a noisy run is one that it can go on from" * doctest::description("robust")) {
    // Eighteen disks that linear shapes shake: their outlines are carried through all of it.
    const Program& program = program_called("mpm_explicit");
    const fs::path here = fresh_folder(program),
                   shipped = fs::absolute("mpm_explicit/cases/compressed.toml");
    REQUIRE(
        start(program, here, shipped.string() + " --quiet output.checkpoint_steps=1067 --out run")
            .status == 0);
    for (const std::string& path : checkpoints(here / "run")) {
        INFO(path);
        CHECK(start(program, here, "--restart " + path + " --out rest --force --quiet").status ==
              0);
        CHECK(read_all(here / "rest/history.dat") == read_all(here / "run/history.dat"));
    }
}

TEST_CASE("plates move on with the same bits and want the same tables" *
          doctest::description("robust")) {
    const std::string way = "0 0 0\n0.01 0 -1e-3\n0.03 2e-3 -1e-3\n";
    for (const Program* one : programs_called("grains")) {
        const Program& program = *one;
        const fs::path folder = fresh_folder(program);
        write_all(folder / "way.txt", way);
        REQUIRE(start(program, folder,
                      arguments_of({&program,
                                    "press time.end=0.05 load.rise=0.01 time.alpha=0.2 "
                                    "grain.top.control=velocity grain.top.stop=0.02 "
                                    "grain.top.swing_y=-1e-3 grain.top.period=0.02 "
                                    "grain.top.table=way.txt grain.top.velocity_y=-0.1",
                                    {}}) +
                          " --quiet output.checkpoint_steps=7 --out run")
                    .status == 0);
        const std::string path = checkpoints(folder / "run")[0], good = read_all(path);
        REQUIRE(start(program, folder, "--restart " + path + " --out rest --quiet").status == 0);
        CHECK(read_all(folder / "rest/history.dat") == read_all(folder / "run/history.dat"));
        // What the plate has gone at the end: velocity times stop, two and a half swings, the
        // table.
        const std::vector<double> x = column(folder / "run", "travel_x_top"),
                                  y = column(folder / "run", "travel_y_top");
        CHECK(std::fabs(x.back() - 2e-3) <= 1e-15);
        if (program.name == "mpm_implicit")
            CHECK(std::fabs(y.back() - (-0.1 * 0.02 - 1e-3 - 1e-3)) <= 1e-15);
        for (const std::string& other :
             {way + "0.04 2e-3 0\n", std::string("0 0 0\n0.01 0 -1e-3\n0.03 1e-3 -1e-3\n"),
              std::string("0 0 0\n0.03 2e-3 -1e-3\n")}) {
            const fs::path here = fresh_folder(program);
            write_all(here / "way.txt", other);
            write_all(here / "good.bin", good);
            const Outcome outcome =
                start(program, here, "--restart good.bin --out again --force --quiet");
            INFO(outcome.err);
            CHECK(outcome.status == 2);
            CHECK(outcome.err.find("other tables of motion than its case reads") !=
                  std::string::npos);
        }
    }
}
