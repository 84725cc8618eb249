// Wrong case files of cic: one sentence with the number and the cure, status 2, nothing written;
// and right ones at the edge of what it takes. Damaged text, wrong command lines and wrong output
// folders are refused by what all programs share: see robust_input.cpp.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/any_program.hpp"

const std::string facts::program_name = "cic";

namespace {

using namespace facts;

// Cases to which a row adds its fault: electrons and a fixed background in one dimension and in the
// plane, electrons and ions between two walls.
const std::string background = "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n";
const std::string electrons = "[species.electrons]\nparticles_per_cell = 8\n";
const std::string line =
    "[grid]\ncells_x = 16\nlength_x = 6\n[time]\nend = 2\n" + background + electrons;
const std::string plane =
    "[grid]\ndimensions = 2\ncells_x = 8\ncells_z = 8\nlength_x = 6\nlength_z = 6\n"
    "[time]\nend = 2\n" +
    background + electrons;
const std::string between_walls =
    "[grid]\ncells_x = 16\nlength_x = 6\nboundary_x = \"wall\"\n[time]\nend = 2\n" + electrons +
    "temperature_x = 1\n[species.ions]\ncharge = 1\nmass = 100\nparticles_per_cell = 8\n";
const std::string box = " grid.boundary_x=wall grid.boundary_z=wall";

std::string shipped(const std::string& name) { return read_all("cic/cases/" + name + ".toml"); }

}  // namespace

TEST_CASE("a mesh or a time step that cannot run is refused" * doctest::description("robust")) {
    check_refused({
        {"columns in one dimension", line, "grid.cells_z=8",
         "grid.cells_z = 8 needs grid.dimensions = 2"},
        {"walls in z in one dimension", line, "grid.boundary_z=wall",
         "grid.boundary_z = \"wall\" needs grid.dimensions = 2"},
        {"one row in the plane", plane, "grid.cells_z=1",
         "grid.dimensions = 2 needs grid.cells_z of at least 2"},
        {"one column", plane, "grid.cells_x=1",
         "'grid.cells_x' = 1 is out of range; allowed: 2 ... 16384"},
        {"small box", plane, "grid.cells_x=2" + box, "a box needs at least 3 x 3 cells"},
        {"large box", plane, "grid.cells_x=4096 grid.cells_z=4096" + box,
         "a box between four walls of 4096 x 4096 cells is more than the 4e6 whose matrix is "
         "factorized in minutes: take fewer, or make one direction periodic"},
        {"too many steps", line, "time.dt=1e-9",
         "time.end / time.dt is 2e+09 steps, more than 1e9: raise time.dt or lower time.end"},
        {"infinitely many steps", line, "time.dt=1e-300 time.end=1e300",
         "time.end / time.dt is inf steps, more than 1e9"},
        {"time step beyond the leapfrog", line, "time.dt=2",
         "omega_p dt = 2 is not below 2, where the leapfrog blows up: lower time.dt below 2"},
        {"time step beyond the leapfrog of two species", between_walls, "time.dt=1.999",
         "omega_p dt = 2.009 is not below 2, where the leapfrog blows up: lower time.dt below "
         "1.99"},
        {"time step for a dense plasma", line,
         "time.dt=0.3 species.electrons.density=100 species.ions.density=100",
         "omega_p dt = 3 is not below 2, where the leapfrog blows up: lower time.dt below 0.2"},
        {"leap over the box", line, "species.electrons.drift_x=100",
         "species.electrons: particles move 1.667 times the length of the box in one step: lower "
         "time.dt below 0.06"},
        {"half a sign", line, "gauss.sign=0.5", "gauss.sign = 0.5 is neither 1 nor -1"},
        {"energy-conserving points", line, "method.scheme=energy method.weighting=ngp",
         "method.scheme = \"energy\" gathers with one order less than it deposits, and there is "
         "none below method.weighting = \"ngp\": take \"cic\" or \"tsc\""},
        {"corners in one dimension", line, "method.stencil=nine_point",
         "method.stencil = \"nine_point\" needs grid.dimensions = 2"},
    });
}

TEST_CASE("numbers whose products leave double precision are refused with the number" *
          doctest::description("robust")) {
    const std::string cure = " is not between 1e-40 and 1e40 in size: choose other units";
    std::vector<Row> rows;
    for (const std::string name :
         {"grid.length_x", "time.dt", "plasma.B_x", "plasma.B_y", "plasma.B_z",
          "boundary.potential_x_high", "output.phase_v_max", "species.electrons.density",
          "species.electrons.charge", "species.electrons.mass", "species.electrons.drift_x",
          "species.electrons.drift_y", "species.electrons.drift_z",
          "species.electrons.temperature_x", "species.electrons.temperature_y",
          "species.electrons.temperature_z", "species.electrons.emission",
          "species.electrons.emission_temperature"})
        for (const std::string value : {"1e+300", "1e-300"}) {
            const bool few_steps = name == "time.dt" && value == "1e-300";
            rows.push_back({"extreme " + name + " " + value, between_walls,
                            name + "=" + value + (few_steps ? " time.end=1e-299" : ""),
                            name + " = " + value + cure});
        }
    rows.push_back({"extreme negative charge", line, "species.electrons.charge=-1e41",
                    "species.electrons.charge = -1e+41" + cure});
    rows.push_back(
        {"extreme length_z", plane, "grid.length_z=1e-41", "grid.length_z = 1e-41" + cure});
    check_refused(rows);
}

TEST_CASE("a plasma that is not one is refused with its charge or its number of particles" *
          doctest::description("robust")) {
    check_refused({
        {"no plasma", "", "", "there is no plasma: add a [species.<name>]"},
        {"nothing that moves", "[grid]\n" + background, "",
         "every species is fixed, so nothing can happen: make one mobile"},
        {"electrons alone", "[grid]\nlength_x = 6\n[species.electrons]\n", "",
         "the plasma is not neutral: its charge is -6, -100 % of the sum of all charges, and there "
         "is no grounded wall to carry the opposite: change a density, or add a fixed species with "
         "density 1 and charge 1"},
        {"too many ions", line, "species.ions.density=3",
         "the plasma is not neutral: its charge is 12, 50 % of the sum of all charges"},
        {"too many ions in the plane", plane, "species.ions.density=3",
         "or add a fixed species with density 2 and charge -1"},
        {"ions between floating walls", between_walls,
         "boundary.x_low=floating boundary.x_high=floating species.ions.density=1.5",
         "the plasma is not neutral: its charge is 3, 20 % of the sum of all charges"},
        {"one particle", plane,
         "species.electrons.profile=point species.electrons.density=36 "
         "species.electrons.center_x=1 species.electrons.center_z=1",
         "the case has 1 particle, and alone it only feels itself: raise particles_per_cell"},
        {"more particles than numbers", plane,
         "species.electrons.particles_per_cell=1e7 grid.cells_x=64 grid.cells_z=64",
         "4.096e+10 particles are more than 2e9: lower particles_per_cell"},
        {"no particle", plane,
         "species.electrons.profile=disk species.electrons.center_x=1 "
         "species.electrons.center_z=1 species.electrons.half_width=1e-3",
         "species.electrons has no particle: raise particles_per_cell, or its half_width of "
         "0.001"},
        {"no particles", line, "species.electrons.particles_per_cell=0",
         "'species.electrons.particles_per_cell' = 0 is out of range; allowed: 1 ... 1e+07"},
        {"no density", line, "species.electrons.density=0",
         "species.electrons.density = 0 leaves its particles without charge and mass: raise it, or "
         "take the species out"},
        {"species of that name already", line + electrons, "", "case.toml:"},
    });
}

TEST_CASE("species that cannot be loaded are refused with the cure" *
          doctest::description("robust")) {
    const std::string center =
        " species.electrons.center_x=1 species.electrons.center_z=1 species.electrons.profile=";
    const std::string fixed =
        "species.ions: a fixed species stays as it is: take out drift, temperature, amplitude, "
        "ripple and emission, or make it mobile";
    check_refused({
        {"fixed disk", plane, "species.ions.profile=disk",
         "species.ions: a fixed species is a uniform background: take out profile, or make it "
         "mobile and heavy"},
        {"fixed wave", line, "species.ions.amplitude=0.1", fixed},
        {"fixed drift", line, "species.ions.drift_x=1", fixed},
        {"fixed heat", line, "species.ions.temperature_x=1", fixed},
        {"fixed ripple", line, "species.ions.ripple=1", fixed},
        {"fixed source", line, "species.ions.emission=1", fixed},
        {"layer on a line", line, "species.electrons.profile=layer",
         "species.electrons.profile = \"layer\" needs grid.dimensions = 2"},
        {"disk on a line", line, "species.electrons.profile=disk",
         "species.electrons.profile = \"disk\" needs grid.dimensions = 2"},
        {"layer without width", plane, "species.electrons.profile=layer",
         "species.electrons.half_width = 0: a layer needs a width"},
        {"disk without width", plane, "species.electrons.profile=disk",
         "species.electrons.half_width = 0: a disk needs a width"},
        {"wide layer", plane,
         "species.electrons.half_width=2 species.electrons.ripple=0.5" + center + "layer",
         "species.electrons: the layer reaches beyond the box, from z = -1.5 to 3.5 in a box from "
         "0 to 6"},
        {"wide disk", plane, "species.electrons.half_width=2" + center + "disk",
         "species.electrons: the disk reaches beyond the box: move species.electrons.center_x or "
         "center_z, or make it smaller"},
        {"point outside", plane, "species.electrons.profile=point species.electrons.center_x=6.1",
         "species.electrons: the point reaches beyond the box"},
        {"ripple of a uniform plasma", plane, "species.electrons.ripple=0.1",
         "species.electrons.ripple belongs to profile = \"layer\""},
        {"ripple without a wave number", plane,
         "species.electrons.half_width=0.5 species.electrons.ripple=0.1 "
         "species.electrons.mode_x=0" +
             center + "layer",
         "species.electrons.ripple = 0.1 has no wave number: set mode_x"},
        {"lattice of a disk", plane,
         "species.electrons.half_width=0.5 species.electrons.loading=lattice" + center + "disk",
         "species.electrons.loading = \"lattice\" fills the whole box: take \"quiet\" for a disk"},
        {"warm lattice", line,
         "species.electrons.temperature_x=1 species.electrons.loading=lattice",
         "species.electrons.loading = \"lattice\" is for cold species: take \"quiet\""},
        {"velocity out of the plane", plane, "species.electrons.drift_y=1",
         "species.electrons has a velocity out of the plane, which nothing can see without a "
         "magnetic field: take out drift_y and temperature_y, or set plasma.B_x, B_y or B_z"},
        {"velocity along z", line, "species.electrons.temperature_z=1",
         "species.electrons has a velocity along z, which nothing can see in one dimension without "
         "a magnetic field: take out drift_z and temperature_z"},
        {"drift without a field", line, "species.electrons.start=ExB",
         "species.electrons.start = \"ExB\" needs a magnetic field: set plasma.B_x, B_y or B_z"},
        {"wave without a wave number", line,
         "species.electrons.amplitude=0.1 species.electrons.mode_x=0",
         "species.electrons: the perturbed mode has no wave number: set mode_x"},
        {"wave without a wave number in the plane", plane,
         "species.electrons.amplitude=0.1 species.electrons.mode_x=0",
         "species.electrons: the perturbed mode has no wave number: set mode_x or mode_z"},
        {"oblique wave on a line", line,
         "species.electrons.amplitude=0.1 species.electrons.mode_z=1",
         "species.electrons.mode_z needs grid.dimensions = 2"},
        {"short wave", line, "species.electrons.amplitude=0.1 species.electrons.mode_x=9",
         "species.electrons: mode (9, 0) has more than one wavelength per two cells, the cut-off "
         "of the mesh: refine it or lower the mode"},
        {"short wave along z", plane, "species.electrons.amplitude=0.1 species.electrons.mode_z=-5",
         "species.electrons: mode (1, -5) has more than one wavelength per two cells"},
        {"short ripple", plane,
         "species.electrons.half_width=0.5 species.electrons.ripple=0.1 "
         "species.electrons.mode_x=5" +
             center + "layer",
         "species.electrons: mode (5, 0) has more than one wavelength per two cells"},
        {"wave deeper than the plasma", line, "species.electrons.amplitude=1",
         "'species.electrons.amplitude' = 1 is out of range; allowed: -0.9 ... 0.9"},
        {"oblique wave between walls", plane,
         "species.electrons.amplitude=0.1 species.electrons.mode_z=1 grid.boundary_z=wall",
         "species.electrons: mode (1, 1) would push particles through the walls: set mode_x or "
         "mode_z to 0"},
    });
}

TEST_CASE("walls that do not fit are refused with the cure" * doctest::description("robust")) {
    const std::string source = " boundary.particles_x_low=source";
    check_refused({
        {"potential without a wall", line, "boundary.potential_x_high=1",
         "there is no wall at x_high: set grid.boundary_x = \"wall\", or take out boundary.x_high, "
         "boundary.potential_x_high and boundary.particles_x_high"},
        {"floating without a wall", plane, "boundary.z_low=floating",
         "there is no wall at z_low: set grid.boundary_z = \"wall\""},
        {"mirror without a wall", plane, "boundary.particles_z_high=reflect",
         "there is no wall at z_high: set grid.boundary_z = \"wall\""},
        {"source at the wrong end", between_walls, "boundary.particles_x_high=source",
         "'boundary.particles_x_high' = \"source\" is not one of \"absorb\", \"reflect\""},
        {"potential of a floating wall", between_walls,
         "boundary.x_high=floating boundary.potential_x_high=-5",
         "boundary.potential_x_high = -5 belongs to a grounded wall; the charge of a floating one "
         "finds its own: take it out, or set boundary.x_high = \"grounded\""},
        {"floating wall with the sign of the slide", between_walls,
         "boundary.x_low=floating gauss.sign=-1",
         "gauss.sign = -1 is not for floating walls: set boundary.x_low = \"grounded\""},
        {"floating wall of a box", plane, "boundary.z_low=floating" + box,
         "floating walls that meet grounded ones at a corner are not supported: make all walls "
         "grounded, or one direction periodic"},
        {"emission without a source", between_walls, "species.electrons.emission=1",
         "species.electrons.emission needs boundary.particles_x_low = \"source\" and "
         "grid.boundary_x "
         "= \"wall\""},
        {"endless emission", between_walls, "species.electrons.emission=1e9" + source,
         "species.electrons.emission = 1e+09 is 2.133e+09 particles in a step, more than 1e6: "
         "lower it, or raise density, which makes them heavier"},
        {"emission across the box", between_walls,
         "species.electrons.emission_temperature=1e6" + source,
         "species.electrons.emission_temperature = 1e+06: a particle emitted with 8700 crosses the "
         "whole box in one step: lower it, or time.dt below 0.0006897"},
    });
}

TEST_CASE("theories are refused where they do not hold" * doctest::description("robust")) {
    const std::string wave = "theory.compare=wave ", mesh = "theory.model=mesh ";
    const std::string layer =
        "theory.compare = \"diocotron\" needs one species with profile = \"layer\" and no other, "
        "plasma.B_y alone, and walls in z only";
    const std::string between =
        "theory.compare = \"diocotron\" needs grounded walls of the same potential, and the layer "
        "half-way between them, at center_z = 8";
    const std::string source =
        "theory.compare = \"sheath\" needs grid.dimensions = 1, no magnetic field, a floating "
        "source at x_low and a floating, absorbing wall at x_high";
    const std::string pair =
        "theory.compare = \"sheath\" needs two mobile species of opposite charge with the same "
        "emission";
    const std::string points =
        "theory.compare = \"clouds\" needs two species with profile = \"point\" in a periodic "
        "plane, the momentum scheme and the five-point stencil, and no magnetic field";
    const std::string warm = "theory.compare = \"heating\" needs a warm plasma in one periodic";
    const std::string traveling =
        "species.electrons.amplitude=0.1 species.electrons.wave=traveling ";
    check_refused({
        {"too few steps", line, wave + "time.end=0.5",
         "theory.compare = \"wave\" needs at least 10 steps: raise time.end above 1"},
        {"followed mode above the cut-off", line, "theory.mode_x=9",
         "the followed mode (9, 0) has more than one wavelength per two cells, the cut-off of the "
         "mesh: refine it or lower theory.mode_x and mode_z"},
        {"followed mode above the cut-off along z", plane, wave + "theory.mode_z=5",
         "the followed mode (1, 5) has more than one wavelength per two cells"},
        {"followed mode along z on a line", line, "theory.mode_z=1",
         "theory.mode_z needs grid.dimensions = 2"},
        {"wave between walls", between_walls, wave,
         "theory.compare = \"wave\" needs periodic boundaries"},
        {"wave in a disk", plane,
         wave + "species.electrons.profile=disk species.electrons.center_x=3 "
                "species.electrons.center_z=3 species.electrons.half_width=1 "
                "species.electrons.density=11.459155902616464",
         "theory.compare = \"wave\" needs uniform species, and 'electrons' is a disk"},
        {"wave in a warm magnetized plasma", line,
         wave + "plasma.B_y=1 species.electrons.temperature_x=1",
         "theory.compare = \"wave\" with a magnetic field is for cold species at rest, and "
         "'electrons' is warm or drifts: take out plasma.B_x, B_y and B_z, or set theory.compare = "
         "\"none\""},
        {"wave in a drifting magnetized plasma", line,
         wave + "plasma.B_y=1 species.electrons.drift_z=1", "'electrons' is warm or drifts"},
        {"magnetized wave with the sign of the slide", line, wave + "plasma.B_y=1 gauss.sign=-1",
         "theory.compare = \"wave\" with a magnetic field is for gauss.sign = 1"},
        {"oblique wave on the mesh", plane, wave + mesh + "theory.mode_z=1",
         "theory.model = \"mesh\" needs a mode along x or along z, and not mode (1, 1)"},
        {"magnetized mesh", line, wave + mesh + "plasma.B_y=1",
         "theory.model = \"mesh\" has neither a magnetic field nor gauss.sign = -1: take "
         "\"plasma\""},
        {"search on the mesh", line, wave + mesh + "theory.mode_x=0",
         "theory.mode_x = 0 looks for the fastest growing of 7 modes, and that is for 1 to 512 and "
         "theory.model = \"plasma\": name a mode"},
        {"search on a fine mesh", line, wave + "theory.mode_x=0 grid.cells_x=2048",
         "theory.mode_x = 0 looks for the fastest growing of 1023 modes"},
        {"search on a coarse mesh", line, wave + "theory.mode_x=0 grid.cells_x=2",
         "theory.mode_x = 0 looks for the fastest growing of 0 modes"},
        {"no such root", line, wave + "theory.near=1e300",
         "no root of the dispersion relation was found for mode (1, 0): give theory.near a "
         "frequency to look at, or set theory.compare = \"none\""},
        {"no wave without charge", line, wave + "species.electrons.charge=0 species.ions.charge=0",
         "no root of the dispersion relation was found for mode (1, 0)"},
        {"no wave at the cut-off", line, wave + mesh + "theory.mode_x=8",
         "no root of the dispersion relation was found for mode (8, 0)"},
        {"traveling wave between walls", between_walls, traveling,
         "species.electrons.wave = \"traveling\" needs periodic boundaries"},
        {"traveling wave without charge", line,
         traveling + "species.electrons.charge=0 species.ions.charge=0",
         "no root of the dispersion relation was found for mode (1, 0)"},
        {"traveling wave in a warm magnetized plasma", line,
         traveling + "plasma.B_y=1 species.electrons.temperature_x=1",
         "species.electrons.wave = \"traveling\" with a magnetic field is for cold species"},
        {"diocotron without a layer", plane, "theory.compare=diocotron", layer},
        {"diocotron with ions", shipped("diocotron"), "species.ions.motion=fixed", layer},
        {"diocotron in a box", shipped("diocotron"), "grid.boundary_x=wall", layer},
        {"diocotron in an oblique field", shipped("diocotron"), "plasma.B_x=1", layer},
        {"diocotron with the sign of the slide", shipped("diocotron"), "gauss.sign=-1",
         "theory.compare = \"diocotron\" is for gauss.sign = 1"},
        {"diocotron without a mode", shipped("diocotron"), "theory.mode_x=0",
         "theory.compare = \"diocotron\" follows theory.mode_x, and not mode (0, 0)"},
        {"diocotron across the layer", shipped("diocotron"), "theory.mode_z=1",
         "theory.compare = \"diocotron\" follows theory.mode_x, and not mode (1, 1)"},
        {"layer aside", shipped("diocotron"), "species.electrons.center_z=7", between},
        {"layer beside a floating wall", shipped("diocotron"), "boundary.z_high=floating", between},
        {"layer between two potentials", shipped("diocotron"), "boundary.potential_z_low=1",
         between},
        {"thick layer", shipped("diocotron"), "species.electrons.half_width=5",
         "theory.compare = \"diocotron\": mode 1 of a layer of half_width 5 and charge -1 does not "
         "grow: make it thinner, or change theory.mode_x"},
        {"sheath without walls", line, "theory.compare=sheath", source},
        {"sheath without a source", shipped("sheath"),
         "boundary.particles_x_low=absorb species.electrons.emission=0 species.ions.emission=0",
         source},
        {"sheath at a grounded wall", shipped("sheath"), "boundary.x_high=grounded", source},
        {"sheath at a mirror", shipped("sheath"), "boundary.particles_x_high=reflect", source},
        {"sheath in a field", shipped("sheath"), "plasma.B_y=1", source},
        {"sheath of uneven emission", shipped("sheath"), "species.ions.emission=0.1", pair},
        {"sheath of doubly charged ions", shipped("sheath"),
         "species.ions.charge=2 species.ions.density=0.025", pair},
        {"sheath of light ions", shipped("sheath"), "species.ions.mass=0.5",
         "no sheath forms at a floating collector unless ions are slower than electrons: take m_i "
         "/ m_e above T_i / T_e, and T_i / T_e above 0"},
        {"sheath of cold light ions", shipped("sheath"),
         "species.ions.mass=1.2 species.ions.emission_temperature=1e-3",
         "no potential falls from the source to a floating collector for such light and cold ions: "
         "raise m_i / m_e or T_i / T_e"},
        {"clouds on a line", line, "theory.compare=clouds", points},
        {"clouds and a third species", shipped("cloud_collision"),
         "species.ions.motion=fixed species.ions.charge=0", points},
        {"clouds between walls", shipped("cloud_collision"), "grid.boundary_z=wall", points},
        {"clouds with the energy scheme", shipped("cloud_collision"), "method.scheme=energy",
         points},
        {"clouds with the nine-point stencil", shipped("cloud_collision"),
         "method.stencil=nine_point", points},
        {"clouds in a field", shipped("cloud_collision"), "plasma.B_y=1", points},
        {"clouds side by side", shipped("cloud_collision"), "species.b.center_x=20",
         "theory.compare = \"clouds\" needs clouds apart along x, and both have center_x = 20"},
        {"heating between walls", between_walls, "theory.compare=heating", warm},
        {"heating in the plane", plane, "theory.compare=heating species.electrons.temperature_x=1",
         warm},
        {"heating of a cold plasma", line, "theory.compare=heating",
         "theory.compare = \"heating\" needs uniform, charged, warm species, and 'electrons' has "
         "profile \"uniform\", charge -1 and temperature_x 0"},
    });
}

TEST_CASE("output that cannot be made is refused with the limit" * doctest::description("robust")) {
    check_refused({
        {"modes above the cut-off", line, "output.modes=9",
         "output.modes = 9 is above the cut-off of the mesh, 8 modes: lower it or refine the mesh"},
        {"modes between walls", between_walls, "output.modes=2", "output.modes needs periodic x"},
        {"spectrum of no modes", line, "output.spectrum=true",
         "output.spectrum needs output.modes"},
        {"spectrum of few steps", line, "output.spectrum=true output.modes=4 time.end=0.3",
         "output.spectrum needs at least 8 steps, and there are 3: raise time.end above 0.8"},
    });
}

TEST_CASE("a restart of cic keeps what its checkpoint says" * doctest::description("robust")) {
    const fs::path folder = fresh_folder("restarts");
    write_all(folder / "case.toml", line);
    REQUIRE(start(folder, "case.toml --quiet output.checkpoint_steps=10 --out run").status == 0);
    const Files files{{"good.bin", read_all(folder / "run/checkpoint_0000000010.bin")}};
    const auto unchangeable = [](const std::string& name, const std::string& value) {
        return Row{"restart with another " + name, std::nullopt,
                   "--restart good.bin " + name + "=" + value,
                   "'" + name + "' cannot change on a restart; start a new run with it"};
    };
    check_refused({unchangeable("time.dt", "0.2"),
                   unchangeable("method.weighting", "tsc"),
                   unchangeable("output.modes", "4"),
                   unchangeable("grid.boundary_x", "wall"),
                   unchangeable("boundary.x_low", "floating"),
                   unchangeable("theory.compare", "wave"),
                   unchangeable("species.electrons.charge", "2"),
                   unchangeable("species.beam.density", "1"),
                   {"restart beyond its end", std::nullopt, "--restart good.bin time.end=0.5",
                    "good.bin: is at step 10, and the run ends at step 5: raise time.end"}},
                  files);
}

TEST_CASE("every range that cic lists is enforced" * doctest::description("robust")) {
    CHECK(check_ranges() >= 40);
}

TEST_CASE("help of cic lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    auto units = check_help("[time]\nend = 0\n[species.beam]\ncharge = 0\n", "");
    CHECK(units["grid.length_x"] == "length");
    CHECK(units["time.dt"] == "1/omega_p");
    CHECK(units["plasma.B_y"] == "m omega_p/e");
    CHECK(units["boundary.potential_x_low"] == "m velocity^2/e");
    CHECK(units["theory.near"] == "omega_p");
    CHECK(units["species.<name>.density"] == "n0");
    CHECK(units["species.<name>.temperature_x"] == "m velocity^2");
    CHECK(units["species.<name>.emission"] == "n0 velocity");
}

TEST_CASE("the version of cic is that of the Makefile" * doctest::description("robust")) {
    check_version();
}

TEST_CASE("every shipped case of cic passes a dry run" * doctest::description("robust")) {
    CHECK(check_shipped_cases() >= 15);
}

TEST_CASE("a dry run of cic shows scales and theory and memory and time" *
          doctest::description("robust")) {
    const std::string out =
        check_described("dry run", shipped("two_stream"), "--out run --threads 2").out;
    check_lines(out, {R"(  mesh +128 cells of 0\.08016, periodic in x)",
                      R"(  method +cic weighting, momentum-conserving)",
                      R"(  steps +1600 of 0\.05)", R"(  particles +65536)",
                      R"(  all mobile species together +omega_p = 1, omega_p dt = 0\.05, cold)",
                      R"(  right +32768 particles, omega_p = 0\.7071, v_th = 0, drift = 1)",
                      R"(  theory +mode \(1, 0\): omega = 0, growth = 0\.3536 omega_p; .*)",
                      R"(  onset +about t = .*)", R"(  memory +about [0-9.e+]+ [KMG]iB.*)",
                      R"(  time +about [0-9.e+-]+ .*)"});
    CHECK(check_described("quiet dry run", line, "--quiet").out.empty());
    CHECK(holds(check_described("plane", shipped("diocotron"), "").out,
                "128 x 128 cells of 0.125 x 0.125, periodic in x, walls in z"));
    CHECK(holds(check_described("slide", shipped("misprint"), "").out,
                "div E = -rho as the slide prints it"));
}

TEST_CASE("what may mislead in cic is a warning with the number and the limit" *
          doctest::description("robust")) {
    const std::string warm = " species.electrons.temperature_x=0.01";
    check_warnings("no warning", line, "", {});
    check_warnings("large time step", line, "time.dt=1",
                   {"warning: omega_p dt = 1 is above 0.5: frequencies are 4.72 % too high; at 2 "
                    "the leapfrog blows up\n"});
    // lambda_D = 0.1, dx = 0.375.
    check_warnings("Debye length", line, warm,
                   {"warning: the Debye length is 0.2667 cells, below 0.3183 for cic: the mesh "
                    "will heat the plasma; refine it to cells of 0.3142\n"});
    check_warnings("Debye length of points", line, "method.weighting=ngp" + warm,
                   {"warning: the Debye length is 0.2667 cells, below 0.6 for ngp"});
    check_warnings("Debye length of triangles", line, "method.weighting=tsc" + warm, {});
    check_warnings("Debye length with the energy scheme", line, "method.scheme=energy" + warm, {});
    check_warnings("Debye length across", plane, "grid.length_z=60" + warm,
                   {"warning: the Debye length is 0.01333 cells, below 0.3183 for cic"});
    check_warnings("slow beam", line, "method.scheme=energy species.electrons.drift_x=0.1",
                   {"warning: electrons: a cold beam at 0.2667 omega_p dx is below 0.2887, where "
                    "the energy-conserving mesh stops it; refine the mesh\n"});
    check_warnings("fast beam", line, "species.electrons.drift_x=10",
                   {"warning: electrons: particles move 2.667 cells in a step; below 2 they see "
                    "the field they cross\n"});
    check_warnings("strong field", line, "plasma.B_y=20",
                   {"warning: electrons: Omega_c dt = 2 is above 1: gyration is slowed by the time "
                    "step to 0.7854 of its frequency; drifts stay right\n"});
    check_warnings("prime number of cells", line, "grid.cells_x=2063",
                   {"warning: grid.cells_x = 2063 has the prime factor 2063, above 200: its "
                    "Fourier transforms take about 103 times as long as those of a product of 2, 3 "
                    "and 5\n"});
    check_warnings("prime number of rows", plane, "grid.cells_z=422",
                   {"warning: grid.cells_z = 422 has the prime factor 211, above 200"});
    check_warnings("prime number of steps", line,
                   "output.spectrum=true output.modes=1 time.end=21.1",
                   {"warning: output.spectrum: time.end / time.dt = 211 has the prime factor 211"});
    check_warnings("short intervals", line,
                   "output.fields_interval=0.01 output.particles_interval=1 "
                   "output.phase_interval=0.05",
                   {"warning: output.fields_interval = 0.01 is below time.dt = 0.1: files are "
                    "written every step\n",
                    "warning: output.phase_interval = 0.05 is below time.dt = 0.1"});
    check_warnings("source of nothing", between_walls, "boundary.particles_x_low=source",
                   {"warning: boundary.particles_x_low = \"source\", and every emission is 0: the "
                    "wall only gives back what reaches it, with emission_temperature\n"});
    check_warnings("slow wave", line, "theory.compare=wave species.electrons.amplitude=0.01",
                   {"warning: the wave of theory has the period 6.283, longer than time.end = 2: "
                    "its frequency cannot be measured well\n"});
    check_warnings("wave that nobody starts", line,
                   "theory.compare=wave time.end=10 species.electrons.mode_x=2",
                   {"warning: no species is perturbed in the followed mode (1, 0): only noise can "
                    "start the wave\n"});
}

TEST_CASE("a case at the edge of what cic takes ends with status 0" *
          doctest::description("robust")) {
    const auto check = [](const std::string& bytes, const std::string& arguments) {
        const fs::path folder = fresh_folder("edge");
        write_all(folder / "case.toml", bytes);
        const Outcome outcome = start(folder, "case.toml --quiet " + arguments);
        INFO(arguments << ": " << outcome.err);
        CHECK(outcome.status == 0);
        CHECK(outcome.sentences.empty());
    };
    check(line, "time.end=0 output.fields_interval=1");
    check(line, "time.end=1e-300");
    check(line, "time.end=0.1");
    check(line, "output.fields_interval=1e300 output.particles_interval=1e300");
    check(line, "grid.cells_x=2 species.electrons.particles_per_cell=1");
    check(line, "species.electrons.amplitude=-0.9 species.electrons.mode_x=-8");
    check(line, "species.electrons.charge=0 species.ions.charge=0 time.dt=1e20 time.end=1e21");
    check(line, "grid.length_x=1e-20");
    check(line,
          "theory.compare=wave gauss.sign=-1 species.electrons.temperature_x=4 "
          "species.electrons.amplitude=0.01");
    // Like charges attract, and particles cross so many boxes in a step that round-off loses them.
    check(line,
          "gauss.sign=-1 time.energy_limit=0 time.dt=1e10 time.end=1e12 "
          "species.electrons.amplitude=0.1");
    check(between_walls, "boundary.x_low=floating boundary.x_high=floating");
    check(between_walls, "grid.cells_x=2 boundary.potential_x_high=100 boundary.x_low=floating");
    // The last of the electrons is absorbed before new ones come.
    check(plane,
          "grid.boundary_x=wall boundary.particles_x_low=source boundary.potential_x_low=-1e6 "
          "species.electrons.emission=0.5 plasma.B_y=0.1");
    // In a corner a particle meets the source and another wall in the same step.
    check(plane,
          "boundary.particles_x_low=source time.dt=0.4 time.end=20 species.electrons.emission=1 "
          "species.electrons.temperature_x=30 species.electrons.temperature_z=30" +
              box);
    const std::string edge =
        "species.electrons.profile=point species.electrons.density=2 "
        "species.ions.motion=mobile species.ions.density=2 "
        "species.ions.profile=point species.electrons.center_x=6 "
        "species.ions.center_z=6 ";
    check(plane, edge);
    check(plane, edge + box);
    for (const std::string weighting : {"ngp", "cic", "tsc"})
        for (const std::string scheme : {"momentum", "energy"})
            for (const std::string ends : {"", " grid.boundary_x=wall", " grid.boundary_z=wall",
                                           " grid.boundary_x=wall grid.boundary_z=wall"}) {
                if (weighting == "ngp" && scheme == "energy") continue;
                check(plane,
                      "grid.cells_x=3 grid.cells_z=3 method.stencil=nine_point time.end=10 "
                      "species.electrons.temperature_x=1 species.electrons.temperature_z=1 "
                      "method.weighting=" +
                          weighting + " method.scheme=" + scheme + ends);
            }
}
