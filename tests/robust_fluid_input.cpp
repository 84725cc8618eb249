// Wrong case files of pic and flip: one sentence with the number and the cure; right ones at the
// edge of what they take; what a dry run says and warns of. How files and command lines are read is
// what all programs share: see robust_input.cpp.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "flip/setup/check_case.hpp"

namespace {

using namespace flip;

// A case with settings laid over it: lines, the last of which holds, and then sections.
Case made(const std::string& text, const std::string& over) {
    std::vector<std::string> parts{text};
    std::istringstream lines(over);
    bool in_sections = false;
    for (std::string line; std::getline(lines, line);) {
        if (in_sections)
            parts.back() += "\n" + line;
        else
            parts.push_back(line);
        in_sections = in_sections || line.starts_with("[");
    }
    Case w;
    common::ParameterTable table = describe(w);
    for (const std::string& part : parts)
        for (const common::Setting& setting : common::read_case(part, "case.toml"))
            table.set(setting);
    reject_unused(w);
    return completed(w);
}

struct Row {
    std::string label, text, over, message;
    std::string program = "flip";
};

void check_refused(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        std::string message = "(nothing is refused)";
        try {
            validate(made(row.text, row.over), row.program);
        } catch (const common::InputError& error) {
            message = error.what();
        }
        INFO(row.label << ": " << message);
        CHECK(message.find(row.message) != std::string::npos);
        CHECK(std::count(message.begin(), message.end(), '\n') == 0);
    }
}

// What runs: the scales are finite, and the description has a line for each of them.
void check_accepted(const std::string& label, const std::string& text, const std::string& over,
                    const std::string& program = "flip") {
    INFO(label);
    const Case w = made(text, over);
    CHECK_NOTHROW(validate(w, program));
    const Scales scales = scales_of(w, program);
    CHECK(std::isfinite(scales.steps));
    CHECK(std::isfinite(scales.bytes));
    const std::string description = describe_scales(w, scales, program);
    CHECK(description.find("nan") == std::string::npos);
    for (const char* line : {"  mesh ", "  method ", "  particles ", "  steps ", "  memory "})
        CHECK(description.find(line) != std::string::npos);
}

void check_warnings(const std::string& label, const std::string& text, const std::string& over,
                    const std::vector<std::string>& expected, const std::string& program = "flip") {
    const Case w = made(text, over);
    validate(w, program);
    const std::vector<std::string> warnings =
        resolution_warnings(w, scales_of(w, program), program);
    std::string all;
    for (const std::string& warning : warnings) all += warning + "\n";
    INFO(label << ": " << all);
    CHECK(warnings.size() == expected.size());
    for (const std::string& warning : expected) CHECK(all.find(warning) != std::string::npos);
}

// Cases to which a row adds its fault: gas in a tube and in a box between walls, the same on a
// periodic mesh, and a shock tube.
const std::string walls_x = "boundary.x_low = \"slip\"\nboundary.x_high = \"slip\"\n",
                  walls_z = "boundary.z_low = \"slip\"\nboundary.z_high = \"slip\"\n";
const std::string end = "time.end = 0.1\n";
const std::string gas = "[region.gas]\n";
const std::string tube = walls_x + end + gas;
const std::string square = "grid.cells_x = 32\ngrid.cells_z = 32\n";
const std::string box = square + walls_x + walls_z + end + gas;
const std::string around = square + end + gas;
const std::string sod = walls_x + end + "setup.kind = \"riemann\"\n";

}  // namespace

TEST_CASE("a fluid case without fluid is refused with what to add" *
          doctest::description("robust")) {
    check_refused({
        {"nothing", "", "",
         "there is no fluid: add a [region.<name>], or set setup.kind = \"riemann\""},
        {"beside the mesh", tube,
         "region.gas.shape = \"box\"\nregion.gas.center_x = 5\nregion.gas.half_x = 1\n"
         "region.gas.half_z = 1",
         "no region contains a particle, so nothing can happen: put one on the mesh, from x = 0 to "
         "1"},
        {"flat box", tube, "region.gas.shape = \"box\"\nregion.gas.half_x = 1",
         "region.gas is a box of half_x = 1 and half_z = 0: give both"},
        {"disk without radius", tube, "region.gas.shape = \"disk\"",
         "region.gas is a disk without radius: give it"},
        {"ripple of a box", tube, "region.gas.ripple = 0.1",
         "region.gas.ripple = 0.1 needs shape = \"above\""},
        {"unknown material", tube, "region.gas.material = \"gold\"",
         "region.gas.material = \"gold\" is none of 'gas'"},
        {"unknown material of the inflow", tube,
         "inflow.material = \"gold\"\nboundary.x_low = \"inflow\"\ninflow.velocity_x = 1",
         "inflow.material = \"gold\" is none of 'gas'"},
        {"riemann with regions", sod, "[region.more]",
         "setup.kind = \"riemann\" makes its regions and materials from [left] and [right]: take "
         "out [region.*] and [material.*]"},
        {"riemann with materials", sod, "[material.more]", "take out [region.*] and [material.*]"},
        {"sides without riemann", tube, "left.density = 3",
         "[left], [right] and setup.interface need setup.kind = \"riemann\""},
        {"interface beside the mesh", sod, "setup.interface = 1",
         "setup.interface = 1 is not on the mesh, from 0 to 1"},
    });
}

TEST_CASE("a fluid mesh or a time step that cannot run is refused" *
          doctest::description("robust")) {
    check_refused({
        {"more particles than numbers", box,
         "grid.cells_x = 16384\ngrid.cells_z = 16384\nparticles.per_cell_x = 4",
         "2.684e+08 cells with 16 places for particles in each are 4.295e+09, more than 2e9: lower "
         "particles.per_cell_x and per_cell_z, or take fewer cells"},
        {"far away", tube, "grid.low_x = 1e8",
         "grid.low_x = 1e+08 is 1e+10 cells from the origin, more than 1e9"},
        {"too many steps", tube, "time.end = 1e9", "more than 1e9: lower time.end"},
        {"step beyond sound", tube, "time.dt = 0.02",
         "time.dt = 0.02: sound and flow cross 2.366 cells in a step, more than 1: lower it below "
         "0.008452"},
        {"step beyond the flow", tube,
         "time.dt = 0.02\nflip.pressure = \"implicit\"\nregion.gas.velocity_x = 1",
         "time.dt = 0.02: the flow crosses 2 cells in a step"},
        {"step beyond viscosity", box, "time.dt = 0.001\nflip.viscosity = 1",
         "flip.viscosity dt/(density dx^2) = 1.024 is above 0.5, where explicit viscosity blows "
         "up: lower it below 0.0004883"},
        {"gravity across a row", tube, "gravity.z = -1",
         "gravity.z = -1 needs grid.cells_z of at least 2"},
    });
}

TEST_CASE("ends of a fluid mesh that do not fit are refused" * doctest::description("robust")) {
    check_refused({
        {"half periodic", box, "boundary.x_low = \"periodic\"",
         "boundary.x_low = \"periodic\" and boundary.x_high = \"slip\": a periodic direction has "
         "no ends; make both periodic or neither"},
        {"half periodic in z", box, "boundary.z_high = \"periodic\"",
         "boundary.z_low = \"slip\" and boundary.z_high = \"periodic\""},
        {"open row", tube, "boundary.z_low = \"open\"\nboundary.z_high = \"open\"",
         "boundary.z_low = \"open\" needs grid.cells_z of at least 2: a row is periodic in z or "
         "slips"},
        {"sliding slip", box, "boundary.slide_x_low = 1",
         "boundary.slide_x_low = 1 needs boundary.x_low = \"no_slip\""},
        {"pressure at a wall", box, "boundary.pressure_z_high = 1",
         "boundary.pressure_z_high = 1 needs boundary.z_high = \"open\""},
        {"inflow that leaves", box, "boundary.x_high = \"inflow\"\ninflow.velocity_x = 1",
         "boundary.x_high = \"inflow\" needs inflow.velocity_x below 0, into the mesh, and it is "
         "1"},
        {"inflow at rest", box, "boundary.z_low = \"inflow\"\ninflow.velocity_x = 1",
         "boundary.z_low = \"inflow\" needs inflow.velocity_z above 0, into the mesh, and it is "
         "0"},
        {"inflow nowhere", box, "inflow.velocity_x = 1",
         "[inflow] needs an end with boundary = \"inflow\": set one, or take it out"},
    });
}

TEST_CASE("materials and pressures that cannot be are refused with the number" *
          doctest::description("robust")) {
    std::string nine;
    for (const char letter : std::string("abcdefghi"))
        nine += "[material." + std::string(1, letter) + "]\n";
    const std::string water = "[material.water]\ngamma = 4.4\np_infinity = 600\n";
    check_refused({
        {"nine materials", tube, nine,
         "9 materials are more than the 8 that a cell can hold: use fewer"},
        {"stiff dust", tube, "[material.a]\ngamma = 1\np_infinity = 2",
         "material.a.p_infinity = 2 needs gamma above 1: gamma = 1 is dust, without pressure"},
        {"implicit dust", tube, "flip.pressure = \"implicit\"\n[material.a]\ngamma = 1",
         "material.a.gamma = 1 is dust, without pressure, and flip.pressure = \"implicit\" needs "
         "gamma above 1"},
        {"almost dust", tube, "[material.a]\ngamma = 1.0001",
         "material.a.gamma = 1 is between 1 and 1.001"},
        {"sound in dust", tube, "region.gas.flow = \"wave\"\n[material.a]\ngamma = 1",
         "region.gas is dust, gamma = 1, and has no pressure for flow = \"wave\""},
        {"tension on top", box,
         "gravity.z = -4\nregion.gas.hydrostatic = true\nregion.gas.pressure = 1",
         "region.gas has the pressure -0.01562 at x = 0.003906, z = 0.2539, and fluids here hold "
         "no tension: raise its pressure by that much"},
        {"tension in a wave of water", box + water,
         "region.gas.pressure = 0\nregion.gas.flow = \"wave\"\nregion.gas.amplitude = 0.01",
         ", and fluids here hold no tension"},
        {"wave of void", tube, "region.gas.flow = \"wave\"\nregion.gas.amplitude = 1",
         "region.gas.amplitude = 1 makes densities negative: take less than 1"},
        {"Gaussian of less than nothing", tube,
         "region.gas.flow = \"gaussian\"\nregion.gas.width = 0.1\nregion.gas.amplitude = -2",
         "region.gas.amplitude = -2 makes energies negative: take more than -1"},
        {"flow without width", box, "region.gas.flow = \"rotation\"",
         "region.gas.flow = \"rotation\" needs a width above 0"},
        {"vortex in a row", tube, "region.gas.flow = \"gresho\"\nregion.gas.width = 0.4",
         "region.gas.flow = \"gresho\" needs grid.cells_z of at least 2"},
        {"wave above the cut-off", tube, "region.gas.flow = \"wave\"\nregion.gas.mode = 50",
         "region.gas.mode = 50 is not below the cut-off of the mesh, 50 wavelengths"},
        {"interface outside", box, "region.gas.flow = \"overturn\"\nregion.gas.center_z = 1",
         "region.gas.flow = \"overturn\" needs center_z on the mesh, and it is 1"},
    });
    const std::string cure = " is not between 1e-40 and 1e40 in size: choose other units";
    for (const std::string name :
         {"grid.length_x", "grid.length_z", "region.gas.density", "region.gas.pressure",
          "region.gas.velocity_x", "region.gas.velocity_z", "region.gas.speed", "region.gas.width",
          "region.gas.energy", "gravity.x", "gravity.trap", "boundary.pressure_x_low",
          "flip.viscosity", "inflow.density", "theory.frame_x", "viscosity.linear"})
        for (const std::string value : {"1e+300", "1e-300"})
            check_refused(
                {{"extreme " + name, box, name + " = " + value,
                  name == "grid.length_z" && value == "1e-300" ? name
                                                               : name + " = " + value + cure}});
}

TEST_CASE("what a method ignores is refused with what it needs" * doctest::description("robust")) {
    for (const std::string setting : {"flip.viscosity = 0.1", "flip.pressure = \"implicit\""})
        check_refused(
            {{"pic with " + setting, tube, setting,
              setting + " is beyond pic: run the case with flip, or take it out", "pic"}});
    for (const std::string setting :
         {"flip.transfer = \"apic\"", "flip.mass = \"consistent\"", "flip.deficit_to_heat = false",
          "flip.density = \"particles\"", "rezone.steps = 5"})
        check_warnings("pic with " + setting, tube, setting + "\nregion.gas.velocity_x = 0.5",
                       {setting + " means nothing to pic, whose particles are mass alone"}, "pic");
    check_refused({
        {"pic at a no-slip wall", tube, "boundary.x_low = \"no_slip\"",
         "boundary.x_low = \"no_slip\" needs viscosity: run the case with flip, or take \"slip\"",
         "pic"},
        {"blend without blend", tube, "flip.blend = 0.9",
         "flip.blend = 0.9 needs flip.transfer = \"blend\""},
        {"order without xpic", tube, "flip.xpic_order = 3",
         "flip.xpic_order = 3 needs flip.transfer = \"xpic\""},
        {"theta of the explicit pressure", tube, "flip.theta = 0.6",
         "flip.theta = 0.6 needs flip.pressure = \"implicit\""},
        {"rezoning never", tube, "rezone.max_particles = 40",
         "rezone.max_particles = 40 needs rezone.steps above 0"},
        {"rezoning to and fro", tube,
         "rezone.steps = 1\nrezone.min_particles = 8\nrezone.max_particles = 15",
         "rezone.max_particles = 15 is below twice rezone.min_particles = 8"},
        {"consistent and implicit", tube,
         "flip.mass = \"consistent\"\nflip.pressure = \"implicit\"",
         "flip.mass = \"consistent\" and flip.pressure = \"implicit\" do not go together"},
    });
}

TEST_CASE("comparisons of shocks and blasts that theory cannot answer are refused" *
          doctest::description("robust")) {
    const auto compare = [](const std::string& name) {
        return "theory.compare = \"" + name + "\"\n";
    };
    const std::string piston = compare("piston") + "region.gas.velocity_x = -1\n";
    const std::string hot =
        "[region.hot]\nshape = \"disk\"\nradius = 0.05\ncenter_x = 0.5\ncenter_z = 0.5\n"
        "energy = 1\n";
    check_refused({
        {"regions", tube, compare("riemann"),
         "theory.compare = \"riemann\" needs setup.kind = \"riemann\""},
        {"periodic tube", sod,
         compare("riemann") + "boundary.x_low = \"periodic\"\nboundary.x_high = \"periodic\"",
         "theory.compare = \"riemann\" needs ends in x, and they are periodic"},
        {"tube with gravity", sod, compare("riemann") + "gravity.x = 1",
         "theory.compare = \"riemann\" is for fluid without gravity or trap"},
        {"gas at rest", tube, compare("wall_shock"),
         "theory.compare = \"wall_shock\" needs gas that runs into a wall: give "
         "region.gas.velocity_x"},
        {"gas that runs out", tube, piston + "boundary.x_low = \"open\"",
         "the gas runs towards x_low, which is not a wall: set boundary.x_low = \"slip\""},
        {"two regions", tube, piston + "[region.more]",
         "theory.compare = \"piston\" needs a single region, uniform and everywhere"},
        {"piston of dust", tube, piston + "[material.a]\ngamma = 1",
         "theory.compare = \"piston\" is for a gas, and gamma = 1 is dust"},
        {"piston in cold gas", tube, piston + "region.gas.pressure = 0",
         "theory.compare = \"piston\" needs gas with a pressure: give region.gas.pressure"},
        {"wall that flies", tube, piston + "theory.frame_x = 1",
         "is stated in the frame of the mesh: take out theory.frame_x and frame_z"},
        {"shock that meets the other end", tube, piston + "time.end = 0.4",
         "the other end of the mesh is felt behind the shock from t = 0.3216 on: lower time.end"},
        {"no blast", box, compare("sedov"),
         "theory.compare = \"sedov\" needs a cold region first, and one with an energy inside it; "
         "0 have one"},
        {"blast in a stiff gas", box, compare("sedov") + "[material.a]\ngamma = 3\n" + hot,
         "theory.compare = \"sedov\" is known for gamma between 1 and 2, and it is 3"},
        {"blast in a hole", box, compare("sedov") + hot + "density = 2",
         "needs the same density inside and outside: 2 and 1"},
        {"blast beyond the mesh", box, compare("sedov") + "time.end = 1\n" + hot,
         "theory.compare = \"sedov\": at time.end the shock is at r = 1.004, and the mesh ends at "
         "0.5: lower time.end"},
        {"nothing falls", box, compare("noh"),
         "theory.compare = \"noh\" needs a region with flow = \"radial\""},
        {"warm gas falls", box,
         compare("noh") + "region.gas.flow = \"radial\"\nregion.gas.speed = 1",
         "theory.compare = \"noh\" is for cold gas, and region.gas.pressure = 1 is above a "
         "hundredth of density speed^2, 1"},
        {"gas flies apart", box,
         compare("noh") + "region.gas.flow = \"radial\"\nregion.gas.speed = -1",
         "theory.compare = \"noh\" needs region.gas.speed above 0, inward"},
    });
}

TEST_CASE("comparisons of waves and vortices that theory cannot answer are refused" *
          doctest::description("robust")) {
    const auto compare = [](const std::string& name) {
        return "theory.compare = \"" + name + "\"\n";
    };
    const std::string between = box +
                                "[region.heavy]\nshape = \"above\"\ncenter_z = 0.5\n"
                                "density = 2\n";
    const std::string around_x = "boundary.x_low = \"periodic\"\nboundary.x_high = \"periodic\"\n";
    const std::string shear =
        "region.gas.flow = \"shear\"\nregion.gas.center_z = 0.5\nregion.gas.speed = 0.1\n"
        "region.gas.width = 0.05\n";
    const std::string wave = "region.gas.flow = \"wave\"\nregion.gas.amplitude = 0.01\n";
    const std::string blob =
        "region.gas.flow = \"gaussian\"\nregion.gas.amplitude = 1\nregion.gas.width = 0.05\n"
        "region.gas.velocity_x = 1\ntime.dt = 0.001\n";
    const std::string dust = "\n[material.dust]\ngamma = 1";
    const std::string vortex =
        "region.gas.flow = \"gresho\"\nregion.gas.speed = 1\nregion.gas.width = 0.4\n";
    check_refused({
        {"interface in a row", tube, compare("rayleigh_taylor"),
         "theory.compare = \"rayleigh_taylor\" needs grid.cells_z of at least 2"},
        {"no interface", box, compare("rayleigh_taylor"),
         "theory.compare = \"rayleigh_taylor\" needs two regions, one everywhere and one above "
         "it"},
        {"interface between walls in x", between, compare("rayleigh_taylor"),
         "theory.compare = \"rayleigh_taylor\" needs periodic ends in x"},
        {"interface without gravity", between, compare("rayleigh_taylor") + around_x,
         "density 2 above 1 with gravity.z = 0 does not overturn: turn one around"},
        {"interface of another mode", between,
         compare("rayleigh_taylor") + around_x +
             "gravity.z = -1\nregion.heavy.flow = \"overturn\"\nregion.heavy.mode = 2",
         "follows theory.mode = 1, and region.heavy.mode = 2: make them the same"},
        {"mode above the cut-off", between,
         compare("rayleigh_taylor") + around_x + "gravity.z = -1\ntheory.mode = 16",
         "follows theory.mode = 16, and 32 cells have no waves above 15"},
        {"layer aside", box,
         compare("kelvin_helmholtz") + around_x + shear + "region.gas.center_z = 0.25",
         "needs the layer half-way between the walls, at center_z = 0.5"},
        {"thick layer", box,
         compare("kelvin_helmholtz") + around_x + shear + "region.gas.width = 0.3",
         "mode 1 of a layer of half-width 0.3 does not grow: make it thinner, or lower "
         "theory.mode"},
        {"no layer", box, compare("kelvin_helmholtz") + around_x,
         "theory.compare = \"kelvin_helmholtz\" needs a region with flow = \"shear\""},
        {"wave between walls", box, compare("wave") + wave,
         "theory.compare = \"wave\" needs periodic ends in x"},
        {"wave without amplitude", around, compare("wave") + wave + "region.gas.amplitude = 0",
         "theory.compare = \"wave\" needs a wave: give region.gas.amplitude"},
        {"wave in cold gas", around, compare("wave") + wave + "region.gas.pressure = 0",
         "theory.compare = \"wave\" needs a gas with sound: give region.gas.pressure"},
        {"wave that is carried", around, compare("wave") + wave + "region.gas.velocity_x = 1",
         "theory.compare = \"wave\": the gas moves with 1: set theory.frame_x to that"},
        {"blob without step", around, compare("diffusion") + blob + "time.dt = 0" + dust,
         "theory.compare = \"diffusion\" needs steps of one length: set time.dt"},
        {"blob at rest", around, compare("diffusion") + blob + "region.gas.velocity_x = 0" + dust,
         "theory.compare = \"diffusion\" needs a flow over the mesh: give region.gas.velocity_x"},
        {"blob of gas", around, compare("diffusion") + blob,
         "theory.compare = \"diffusion\" needs dust, whose energy has no pressure: set gamma = 1"},
        {"wide blob", around, compare("diffusion") + blob + "region.gas.width = 0.2" + dust,
         "needs a mesh ten times as long as region.gas.width = 0.2, and it is 1"},
        {"ringing without seed", around, compare("ringing"),
         "theory.compare = \"ringing\" needs a seed: give region.gas.noise"},
        {"vortex without speed", around, compare("gresho") + vortex + "region.gas.speed = 0",
         "theory.compare = \"gresho\" needs a flow: give region.gas.speed"},
        {"vortex that is carried", around,
         compare("gresho") + vortex + "region.gas.velocity_x = 1\nregion.gas.pressure = 9",
         "the vortex moves with 1, 0: set theory.frame_x and frame_z to that"},
        {"nothing turns", box, compare("rotation"),
         "theory.compare = \"rotation\" needs a region with flow = \"rotation\""},
    });
}

TEST_CASE("comparisons of dams and cavities and impacts that have no answer are refused" *
          doctest::description("robust")) {
    const auto compare = [](const std::string& name) {
        return "theory.compare = \"" + name + "\"\n";
    };
    const std::string dam = compare("dam_break") +
                            "gravity.z = -1\nregion.gas.shape = \"box\"\nregion.gas.half_x = 0.2\n"
                            "region.gas.half_z = 0.4\nregion.gas.center_x = 0.2\n"
                            "region.gas.center_z = 0.4\n";
    const std::string held =
        "boundary.x_low = \"no_slip\"\nboundary.x_high = \"no_slip\"\n"
        "boundary.z_low = \"no_slip\"\nboundary.z_high = \"no_slip\"\n";
    const std::string lid = compare("cavity") + held + "boundary.slide_z_high = 1\n";
    check_refused({
        {"dam without gravity", box, dam + "gravity.z = 0",
         "theory.compare = \"dam_break\" needs gravity.z below 0, and it is 0"},
        {"dam in mid-air", box, dam + "region.gas.center_z = 0.5",
         "needs the water in the corner of x_low and z_low, and it is 0.1 away"},
        {"dam without room", box, dam + "region.gas.half_x = 0.5\nregion.gas.center_x = 0.5",
         "needs room beyond the water: lower region.gas.half_x below 0.5"},
        {"dam on an open floor", box, dam + "boundary.z_low = \"open\"",
         "needs a wall at x_low and a floor at z_low: set both to \"slip\""},
        {"cavity of slip", box, compare("cavity"),
         "theory.compare = \"cavity\" needs no_slip walls on all sides"},
        {"cavity at rest", box, compare("cavity") + held,
         "needs a lid that moves: set boundary.slide_z_high above 0"},
        {"cavity without viscosity", box, lid,
         "is published for density speed length/flip.viscosity = 100, and it is infinite: set "
         "flip.viscosity = 0.01"},
        {"cavity of honey", box, lid + "flip.viscosity = 0.1", "and it is 10: set"},
        {"long cavity", box, lid + "flip.viscosity = 0.01\ngrid.length_x = 2",
         "is for a square, and the mesh is 2 x 1"},
        {"impact of one", box, compare("impact"),
         "theory.compare = \"impact\" needs two materials, and the one that is hit in a region of "
         "shape \"box\""},
    });
}

TEST_CASE("what may mislead in a fluid is a warning with the number and the limit" *
          doctest::description("robust")) {
    check_warnings("no warning", tube, "", {});
    check_warnings("no warning of Sod", sod, "", {});
    check_warnings("no warning of Sod by pic", sod, "", {}, "pic");
    check_warnings("rest by pic", tube, "",
                   {"the flow has Mach 0, below 0.05: cells feel a particle only when it enters "
                    "them"},
                   "pic");
    check_warnings("ringing", tube, "region.gas.velocity_x = 0.12",
                   {"region.gas flows over the mesh at Mach 0.1014, between 0.07 and 0.19, where "
                    "explicit FLIP rings"});
    check_warnings("shock without viscosity", sod, "viscosity.linear = 0\nviscosity.quadratic = 0",
                   {"without artificial viscosity particles pile up at shocks"});
    check_warnings(
        "shock without viscosity by pic", sod, "viscosity.linear = 0\nviscosity.quadratic = 0",
        {"without artificial viscosity the method has none where the fluid rests"}, "pic");
    check_warnings("implicit shock", tube,
                   "flip.pressure = \"implicit\"\nregion.gas.velocity_x = 1",
                   {"the flow has Mach 0.8452, above 0.5, and time.cfl with implicit pressure"});
    check_warnings("wall without viscosity", tube, "boundary.x_low = \"no_slip\"",
                   {"a no_slip wall holds fluid without viscosity only through the mesh"});
    check_warnings("few particles", tube, "particles.per_cell_x = 2\nparticles.per_cell_z = 1",
                   {"2 particles per cell are fewer than 4: a particle that leaves a cell takes 50 "
                    "% of its density along"});
    check_warnings("crowd", tube, "rezone.steps = 5\nrezone.max_particles = 12",
                   {"rezone.max_particles = 12 is below the 16 particles per cell of the start"});
    check_warnings("region that is lost", tube + "[region.drop]\nshape = \"disk\"\nradius = 1e-6\n",
                   "", {"region.drop contains no particle"});
    check_warnings("material that is nowhere", tube, "[material.a]\n[material.b]",
                   {"material.b is nowhere"});
    check_warnings("short intervals", tube,
                   "output.fields_interval = 1e-6\noutput.particles_interval = 1",
                   {"output.fields_interval = 1e-06 is below the first time step, 0.002535: files "
                    "are written every step"});
    check_warnings("waves beyond the ends", sod, "theory.compare = \"riemann\"\ntime.end = 0.4",
                   {"at time.end the waves are at x = 0.02671 and 1.201, beyond the ends"});
    check_warnings("slow wave", around,
                   "theory.compare = \"wave\"\nregion.gas.flow = \"wave\"\n"
                   "region.gas.amplitude = 0.01",
                   {"the wave has the period 0.8452, longer than time.end = 0.1"});
}

TEST_CASE("a dry run of a fluid shows scales and theory and memory and time" *
          doctest::description("robust")) {
    const auto description = [](const std::string& text, const std::string& over,
                                const std::string& program) {
        const Case w = made(text, over);
        validate(w, program);
        return describe_scales(w, scales_of(w, program), program);
    };
    const std::string tube_text =
        description(sod, "theory.compare = \"riemann\"\nboundary.x_high = \"open\"", "flip");
    for (const char* line :
         {"  mesh                100 x 1 cells of 0.01 x 1, slip and open in x, periodic in z\n",
          "  method              flip transfer, lumped mass, density of cells, explicit pressure\n",
          "  left                about 800 particles, sound speed 1.183, speed up to 0\n",
          "  right               about 800 particles, sound speed 1.058, speed up to 0\n",
          "  particles           about 1600\n",
          "  steps               about 40; the first of 0.0025",
          "  theory              pressure 0.3031 and velocity 0.9275 at the contact\n",
          "  memory              about ", "  time                about "}) {
        INFO(tube_text);
        INFO(line);
        CHECK(tube_text.find(line) != std::string::npos);
    }
    const std::string wall = description(
        tube, "theory.compare = \"wall_shock\"\nregion.gas.velocity_x = -1\ntime.dt = 1e-3", "pic");
    CHECK(wall.find("velocity and energy on the cells\n") != std::string::npos);
    CHECK(wall.find("steps               100 of 0.001\n") != std::string::npos);
    CHECK(wall.find("density 2.") != std::string::npos);
    // c^2 = gamma (gamma - 1) E/m = 0.56/(524/16384) in the hot disk.
    const std::string blast =
        description(box,
                    "[region.hot]\nshape = \"disk\"\nradius = 0.1\ncenter_x = 0.5\n"
                    "center_z = 0.5\nenergy = 1\npressure = 0",
                    "flip");
    INFO(blast);
    CHECK(blast.find("particles, sound speed 4.18") != std::string::npos);
}

TEST_CASE("a fluid case at the edge of what is taken passes" * doctest::description("robust")) {
    for (const std::string program : {"pic", "flip"}) {
        check_accepted("no time", tube, "time.end = 0", program);
        check_accepted("two cells", tube, "grid.cells_x = 2", program);
        check_accepted("tall mesh", box, "grid.cells_x = 2\ngrid.cells_z = 300", program);
        check_accepted("one particle per cell", tube,
                       "particles.per_cell_x = 1\nparticles.per_cell_z = 1", program);
        check_accepted("dust", tube, "[material.a]\ngamma = 1", program);
        check_accepted("cold dust at rest", tube,
                       "region.gas.pressure = 0\n[material.a]\ngamma = 1", program);
        check_accepted("cold gas at rest", box, "region.gas.pressure = 0", program);
        check_accepted("large mesh", box, "grid.cells_x = 8192\ngrid.cells_z = 8192", program);
        check_accepted("a jet into nothing", box,
                       "boundary.x_low = \"inflow\"\ninflow.velocity_x = 1\n"
                       "region.gas.shape = \"disk\"\nregion.gas.radius = 1e-9",
                       program);
        check_accepted("water", box + "[material.water]\ngamma = 4.4\np_infinity = 600\n",
                       "region.gas.pressure = 0", program);
        check_accepted("gases that tear apart", sod,
                       "left.velocity = -20\nright.velocity = 20\ntheory.compare = \"riemann\"",
                       program);
        check_accepted("eight materials", tube,
                       "[material.a]\n[material.b]\n[material.c]\n[material.d]\n[material.e]\n"
                       "[material.f]\n[material.g]\n[material.h]",
                       program);
    }
    check_accepted("small units", tube,
                   "grid.length_x = 1e-20\ngrid.length_z = 1e-20\ntime.end = 1e-21");
    check_accepted("row that slips", walls_z + tube, "");
    for (const std::string transfer : {"flip", "pic", "blend", "apic", "xpic"})
        check_accepted("transfer " + transfer, box, "flip.transfer = \"" + transfer + "\"");
}

TEST_CASE("every shipped fluid case passes" * doctest::description("robust")) {
    if (!std::filesystem::exists("flip/cases")) return;
    for (const auto& entry : std::filesystem::directory_iterator("flip/cases")) {
        const std::string path = entry.path().string();
        INFO(path);
        const Case w = made(common::read_file(path), "");
        CHECK_NOTHROW(validate(w, "flip"));
    }
}
