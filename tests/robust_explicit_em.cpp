// What explicit_em refuses and warns of, and how its runs end when something goes wrong.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "common/run/checkpoint.hpp"
#include "tests/support/any_run.hpp"

const std::string facts::program_name = "explicit_em";

namespace {

using namespace facts;

const std::string uniform = "[plasma]\nsetup = \"uniform\"\n[grid]\nboundary_z = \"periodic\"\n";
const std::string beam = uniform + "[species.beam]\ncharge = -1\n";
const std::string sheet =
    " implicit_moment/cases/gem_explicit.toml grid.cells_x=32 grid.cells_z=16 time.dt=0.2 "
    "harris.particles=6000 output.fields_interval=0 output.checkpoint_steps=0 "
    "output.history_steps=1";

}  // namespace

TEST_CASE("a step beyond the limits of stability is refused with the limit and the cure" *
          doctest::description("robust")) {
    check_refused({
        // dx = dz = 0.05: 0.05/2^(1/2) = 0.03536.
        {"light", "", "time.dt=0.036",
         "time.dt = 0.036 is not below the limit of light on this mesh, 0.03536 / omega_pi (c dt < "
         "(1/dx^2 + 1/dz^2)^(-1/2)): lower time.dt to 0.03005 or use larger cells"},
        {"light by the cells", "[grid]\ncells_x = 1024\n", "",
         "time.dt = 0.03 is not below the limit of light on this mesh, 0.02236 / omega_pi"},
        // omega_p of ions and electrons at the density of sheet and background:
        // (26 * 1.2)^(1/2) = 5.586.
        {"plasma oscillations", "", "time.dt=0.4 grid.cells_x=32 grid.cells_z=16",
         "omega_p dt = 2.234 is not below 2, the limit of leapfrogged plasma oscillations: lower "
         "time.dt to 0.2685 or use implicit_moment"},
        {"plasma oscillations of one species", beam,
         "grid.length_x=5120 grid.length_z=2560 time.dt=2.5 species.beam.density=4",
         "omega_p dt = 5 is not below 2"},
    });
}

TEST_CASE("parameters of the sibling and wrong values are refused with the place" *
          doctest::description("robust")) {
    check_refused({
        {"theta", "[field]\ntheta = 0.5\n", "", "case.toml:2:9: unknown parameter 'field.theta'"},
        {"solver", "", "field.tolerance=1e-3", "unknown parameter 'field.tolerance'"},
        {"tolerance of the mover", "", "mover.tolerance=1e-3",
         "unknown parameter 'mover.tolerance'"},
        {"misspelled", "[particles]\nodrer = 1\n", "",
         "case.toml:2:9: unknown parameter 'particles.odrer'; did you mean 'particles.order'?"},
        {"cubic splines", "[particles]\norder = 3\n", "",
         "case.toml:2:9: 'particles.order' = 3 is out of range; allowed: 1 ... 2"},
        {"constant splines", "", "particles.order=0",
         "'particles.order' = 0 is out of range; allowed: 1 ... 2"},
        {"number for truth", "[particles]\nrelativistic = 1\n", "",
         "case.toml:2:16: 'particles.relativistic' takes true or false, not a whole number"},
        {"no rows", "", "output.history_steps=0",
         "'output.history_steps' = 0 is out of range; allowed: 1 ... 1e+06"},
        {"faster than light", beam, "grid.length_x=512 grid.length_z=256 species.beam.drift_x=2",
         "'species.beam.drift_x' = 2 is out of range"},
        {"crossed wall", "", "plasma.setup=uniform uniform.B_z=0.1 species.beam.charge=-1",
         "uniform.B_z = 0.1 would cross the conducting walls normal to z: make it 0"},
    });
}

TEST_CASE("what may mislead is a warning with the number and the limit" *
          doctest::description("robust")) {
    // The default resolves 0.29 of a cell per Debye length.
    check_warnings("no warning", "", "", {});
    // v_e/omega_pe = 0.0722/5 = 0.01443 d_i.
    check_warnings("Debye length", "", "grid.cells_x=256 grid.cells_z=128",
                   {"warning: electrons: the Debye length is 0.1443 cells, below 0.2: where the "
                    "plasma drifts the mesh may heat it, watch the energy\n"});
    check_warnings("warm oscillations", "", "time.dt=0.3 grid.cells_x=48 grid.cells_z=24",
                   {"warning: omega_p dt = 1.676 is above 1.62, where oscillations of a warm "
                    "plasma may grow: lower time.dt to 0.2685\n",
                    "warning: ions: the Debye length is ", "warning: electrons: the Debye length"});
    // Omega_ce dt = 25 * 1.0 * 0.03.
    check_warnings("gyration", "", "harris.light_over_alfven=10 harris.guide_field=10",
                   {"warning: electrons: Omega_c dt = 0.7537 is above 0.5, gyration is too slow by "
                    "more than 2 %: lower time.dt to 0.0199\n"});
    check_warnings(
        "slow push", beam,
        "particles.relativistic=false species.beam.temperature_x=0.09 grid.cells_x=512",
        {"warning: beam: four thermal speeds are 1.2 c, and the push is not relativistic\n"});
}

TEST_CASE("every shipped case of explicit_em passes a dry run" * doctest::description("robust")) {
    const auto mine = [](const std::string& name) { return holds(name, "explicit"); };
    CHECK(check_shipped_cases("implicit_moment", mine) >= 5);
}

TEST_CASE("help lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    auto units = check_help(
        "time.end = 0\n[harris]\nparticles = 2\n[grid]\ncells_x = 8\ncells_z "
        "= 8\n",
        "plasma.setup=uniform grid.boundary_z=periodic "
        "species.beam.drift_x=0.1 uniform.particles_per_cell=1");
    CHECK(units["particles.order"].empty());
    CHECK(units.contains("particles.relativistic"));
    CHECK(units.contains("output.history_steps"));
    CHECK(!units.contains("field.theta"));
    CHECK(!units.contains("mover.tolerance"));
    check_version();
}

TEST_CASE("a run that blows up ends with status 3 and says where" *
          doctest::description("robust")) {
    // A beam of a few particles in a wave that throws it over cells in a step.
    check_failure(
        " implicit_moment/cases/explicit_light_wave.toml uniform.wave_E_y=0 "
        "uniform.wave_E_z=1000 theory.wave=none species.beam.charge=-1 "
        "particles.relativistic=false uniform.particles_per_cell=4 time.end=5",
        "cross more than a cell in one step: the field has blown up; reduce time.dt");
    // Far more charge than the mesh can hold back: the energy is not that of the start.
    check_failure(
        " implicit_moment/cases/explicit_langmuir.toml time.dt=0.65 time.end=600 "
        "species.electrons.density=9.3 uniform.particles_per_cell=4 "
        "species.electrons.temperature_x=1e-4 theory.wave=none output.history_steps=1",
        "at step");
}

TEST_CASE("a signal stops a run after a checkpoint from which it can go on" *
          doctest::description("robust")) {
    for (const auto& [signal, status] : {std::pair{SIGTERM, 143}, std::pair{SIGINT, 130}})
        check_interruption(sheet, 0.2, signal, status);
}

TEST_CASE("a checkpoint of another program is refused and nothing is written" *
          doctest::description("robust")) {
    const std::string bad = room() + "/foreign.bin", other = folder("other");
    fs::create_directories(room());
    common::CheckpointWriter({"implicit_moment", PROGRAM_VERSION, "", ""}, bad, "", "").finish();
    CHECK(run(" --restart " + bad, other) == 2);
    INFO(said(other));
    CHECK(holds(said(other), "of 'implicit_moment'"));
    CHECK(!fs::exists(other));
}
