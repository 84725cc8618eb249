// Wrong case files of mpm_explicit: one sentence with the place, the number and the cure, status 2,
// nothing written; and right ones at the edge of what it takes. Damaged text, wrong command lines
// and wrong output folders are refused by what all programs share: see robust_input.cpp.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/any_program.hpp"

const std::string facts::program_name = "mpm_explicit";

namespace {

using namespace facts;

// Cases to which a row adds its fault: two disks on cells of 0.05 that fly towards each other, the
// same on a periodic mesh, a disk between a plate that is driven and one that a force drives, and a
// box that fills its mesh.
const std::string mesh = "[mesh]\ncells_x = 24\ncells_y = 12\nlength_x = 1.2\n";
const std::string end = "[time]\nend = 0.1\n";
const std::string left = "[grain.left]\nx = 0.35\ny = 0.3\nradius = 0.2\nvelocity_x = 0.1\n",
                  right = "[grain.right]\nx = 0.85\ny = 0.3\nradius = 0.2\nvelocity_x = -0.1\n";
const std::string disks = mesh + end + left + right;
const std::string around = disks + "[walls]\n[contact]\n";
const std::string periodic = "grid.periodic_x=true ";
const std::string plate = "shape = \"box\"\nwidth = 1\nheight = 0.1\nmaterial = \"plate\"\n";
const std::string plates = mesh + end +
                           "[material.plate]\nlaw = \"rigid\"\n[grain.disk]\nx = 0.6\ny = 0.3\n"
                           "radius = 0.2\n[grain.bottom]\nx = 0.6\ny = 0.05\n" +
                           plate + "[grain.top]\nx = 0.6\ny = 0.55\ncontrol = \"force_y\"\n" +
                           plate;
const std::string body =
    "[mesh]\ncells_x = 8\ncells_y = 4\nlength_x = 0.8\n[time]\nend = 0.1\n[grain.body]\n"
    "shape = \"box\"\nx = 0.4\ny = 0.2\nwidth = 0.8\nheight = 0.4\n";
const std::string slip =
    "boundary.x_low=slip boundary.x_high=slip boundary.y_low=slip boundary.y_high=slip ";

std::string shipped(const std::string& name) {
    return read_all("mpm_explicit/cases/" + name + ".toml");
}

}  // namespace

TEST_CASE("a mesh or a run that mpm_explicit cannot carry is refused" *
          doctest::description("robust")) {
    check_refused({
        {"walls at the ends of a periodic mesh", disks, periodic + "boundary.x_low=slip",
         "grid.periodic_x = true leaves no walls at the ends of x: set boundary.x_low and "
         "boundary.x_high "
         "to \"open\""},
        {"short periodic mesh", body, periodic + "grid.cells_x=7 grid.length_x=0.7",
         "grid.cells_x = 7 is too few for a periodic mesh: take at least 8"},
        {"one column", disks, "grid.cells_x=1",
         "'grid.cells_x' = 1 is out of range; allowed: 2 ... 16384"},
        {"far away", disks, "grid.low_y=1e9",
         "the mesh begins 2e+10 cells from the origin, more than 1e9, where places are lost to "
         "round-off: move grid.low_x and low_y nearer to 0"},
        {"too many steps", disks, "time.alpha=1e-9",
         "the run would take 7.538e+09 steps, more than 1e9: raise time.alpha or lower time.end"},
        {"endless run", disks, "time.end=1e300",
         "steps, more than 1e9: raise time.alpha or lower time.end"},
        {"damping of all velocity", disks, "load.damping=400",
         "load.damping = 400 takes all velocity in a step of 0.003317: lower it below 301.5"},
        {"more particles than numbers", body,
         "grid.cells_x=16000 grid.cells_y=8000 grid.particles_per_side=16",
         "32768000000 particles are more than 2e9: lower grid.particles_per_side"},
        {"large rasters", body,
         "grid.cells_x=1600 output.fringes_interval=1 "
         "grid.cells_y=800 output.pixels_per_cell=64",
         "output.pixels_per_cell = 64 makes rasters of 5.243e+09 pixels, more than 5e7: take "
         "fewer"},
        {"no length of time", disks, "time.end=-1",
         "'time.end' = -1 is out of range; allowed: >= 0 time"},
        {"no number of time", disks, "time.end=nan", "'time.end' must be finite, not nan"},
    });
}

TEST_CASE("numbers of mpm_explicit whose products leave double precision are refused" *
          doctest::description("robust")) {
    std::vector<Row> rows;
    for (const std::string name : {"grid.length_x",
                                   "grid.low_x",
                                   "boundary.friction",
                                   "contact.friction",
                                   "load.gravity_y",
                                   "load.damping",
                                   "load.rise",
                                   "time.alpha",
                                   "material.default.E",
                                   "material.default.density",
                                   "material.default.yield_stress",
                                   "material.default.hardening",
                                   "material.default.cohesion",
                                   "material.default.tension",
                                   "grain.left.velocity_x",
                                   "grain.left.spin",
                                   "grain.left.amplitude",
                                   "grain.left.force",
                                   "grain.left.damping",
                                   "pack.more.shear_rate",
                                   "bond.joint.tension"})
        for (const std::string value : {"1e+300", "1e-300"})
            rows.push_back({"extreme " + name + " " + value, disks, name + "=" + value,
                            name + " = " + value +
                                " is not between 1e-40 and 1e40 in size: choose other units"});
    rows.push_back({"extreme negative velocity", disks, "grain.left.velocity_y=-1e41",
                    "grain.left.velocity_y = -1e+41 is not between 1e-40 and 1e40 in size"});
    rows.push_back({"infinite radius", disks, "grain.left.radius=inf",
                    "'grain.left.radius' must be finite, not inf"});
    check_refused(rows);
}

TEST_CASE("grains that overlap are refused with their names and how deep" *
          doctest::description("robust")) {
    const std::string box = " grain.right.shape=box grain.right.width=0.3 grain.right.height=0.3";
    const std::string row = " pack.row.x=0.3 pack.row.y=0.1 pack.row.rows=1 pack.row.columns=3 ";
    const std::string cure = ": move them apart or make them smaller";
    check_refused({
        {"two disks", disks, "grain.right.x=0.7",
         "grains 'left' and 'right' overlap by 0.05, 1 cells" + cure},
        {"disk and box", disks, "grain.right.x=0.675" + box,
         "grains 'left' and 'right' overlap by 0.025, 0.5 cells" + cure},
        {"two hexagons", disks,
         "grain.left.shape=polygon grain.right.shape=polygon grain.right.x=0.7",
         "grains 'left' and 'right' overlap by 0.0433, 0.866 cells" + cure},
        {"disk in the notch of a concave polygon", disks,
         "grain.left.shape=polygon grain.left.vertices='0.1 0.1, 0.6 0.1, 0.6 0.5, 0.4 0.3, "
         "0.1 0.5' grain.right.x=0.75",
         "grains 'left' and 'right' overlap by 0.05, 1 cells" + cure},
        {"across the seam", around,
         periodic + "grain.left.x=0.15 grain.right.x=1.1 grain.right.y=0.31",
         "grains 'left' and 'right' overlap by 0.1498, 2.996 cells" + cure},
        {"whole lengths across the seam", around, periodic + "grain.right.x=2.3",
         "grain 'right' reaches from x = 2.1 to 2.5, more than its length of 1.2 beyond the "
         "periodic mesh: move it by whole lengths"},
        {"a pack and a grain", mesh + end + left, "pack.row.radius=0.1" + row,
         "grains 'left' and 'row_g0001' overlap by 0.09384, 1.877 cells" + cure},
        {"a narrow pack", mesh + end, "pack.row.radius=0.1 pack.row.spacing_x=0.15" + row,
         "grains 'row_g0001' and 'row_g0002' overlap by 0.05, 1 cells" + cure},
        {"a long grain around a periodic mesh", mesh + end,
         periodic + "grain.bar.shape=box grain.bar.x=0.6 grain.bar.y=0.3 grain.bar.width=1.3",
         "grain 'bar' is longer than the periodic mesh: shorten it to 1.2"},
        {"two grains of one name", mesh + end,
         "pack.p.x=0.2 pack.p.y=0.2 pack.p.rows=1 pack.p.columns=1 grain.p_g0001.x=0.6 "
         "grain.p_g0001.y=0.3",
         "two grains are called 'p_g0001': rename one of them"},
        {"a sliver under a plate", shipped("compressed"), "grain.plate.y=0.769",
         "grains 'plate' and 'disk_g0015' overlap by"},
    });
}

TEST_CASE("grains that mpm_explicit cannot fill or hold are refused" *
          doctest::description("robust")) {
    const std::string polygon = "grain.left.shape=polygon grain.left.vertices=";
    check_refused({
        {"no grain", mesh, "", "there is no grain: add a [grain.<name>] or a [pack.<name>]"},
        {"nothing at all", "", "", "there is no grain"},
        {"rigid grains only", plates, "material.default.law=rigid",
         "all grains are rigid: give one a material that can be strained"},
        {"thin disk", disks, "grain.left.radius=0.04",
         "grain 'left' is 1.6 cells thin, below 2: refine the mesh to cells of at most 0.04, or "
         "take a larger grain"},
        {"thin turned box", disks,
         "grain.left.shape=box grain.left.width=0.3 grain.left.height=0.08 grain.left.angle=30",
         "grain 'left' is 1.6 cells thin"},
        {"thin triangle", disks, polygon + "'0.1 0.2, 0.5 0.2, 0.3 0.25'",
         "grain 'left' is 1 cells thin"},
        {"thin pack", disks, "pack.p.radius=0.01 pack.p.x=0.6 pack.p.y=0.05 pack.p.rows=1",
         "grain 'p_g0001' is 0.4 cells thin"},
        {"angle between the particles", disks,
         polygon + "'0.2 0.2, 0.5 0.2, 0.5 0.201, 0.201 0.201, 0.201 0.5, 0.2 0.5'",
         "grain 'left' is so thin that no particle falls into it: refine the mesh, or make it "
         "wider"},
        {"beyond the left end", disks, "grain.left.x=0.15",
         "grain 'left' reaches from (-0.05, 0.1) to (0.35, 0.5), beyond the mesh from (0, 0) to "
         "(1.2, 0.6): move the grain or widen the mesh"},
        {"beyond the right end", disks, "grain.right.x=1.1", "grain 'right' reaches from (0.9, "},
        {"below a periodic mesh", around, periodic + "grain.left.y=0.1",
         "grain 'left' reaches from (0.15, -0.1)"},
        {"above the mesh", disks, "grid.low_y=-0.3", "beyond the mesh from (0, -0.3) to"},
        {"two corners", disks, polygon + "'0.2 0.2, 0.5 0.2'",
         "[grain.left]: a polygon of 2 corners: give at least 3 and at most 1000"},
        {"crossing sides", disks, polygon + "'0.2 0.2, 0.5 0.5, 0.5 0.2, 0.2 0.5'",
         "[grain.left]: the side from corner 1 to 2 of a polygon meets the side from corner 3 to "
         "4: list the corners in order around the grain"},
        {"corners on a line", disks, polygon + "'0.2 0.2, 0.3 0.3, 0.4 0.4'",
         "[grain.left]: the 3 corners of a polygon lie on a line: it has no area"},
        {"same corner twice", disks, polygon + "'0.2 0.2, 0.2 0.2, 0.4 0.4'",
         "[grain.left]: corners 1 and 2 of a polygon are the same point: leave one out"},
        {"three numbers for a corner", disks, polygon + "'0 0, 1 0 2, 1 1'",
         "grain.left.vertices: ' 1 0 2' is not a corner: write \"x y, x y, x y\""},
        {"one number for a corner", disks, polygon + "'0 0, 1, 1 1'",
         "grain.left.vertices: ' 1' is not a corner"},
        {"nan for a corner", disks, polygon + "'0 0, nan 0, 1 1'",
         "grain.left.vertices: ' nan 0' is not a corner"},
        {"infinity for a corner", disks, polygon + "'0 0, 1e999 0, 1 1'",
         "grain.left.vertices: ' 1e999 0' is not a corner"},
        {"distant corner", disks, polygon + "'0 0, 1e200 0, 1 1'",
         "[grain.left]: corner 2 is not at a finite place: give two numbers below 1e100"},
        {"corners of a disk", disks, "grain.left.vertices='0 0, 1 0, 1 1'",
         "[grain.left]: vertices belong to shape = \"polygon\": set it, or take them out"},
        {"two sides", disks, "grain.left.sides=2",
         "'grain.left.sides' = 2 is out of range; allowed: 3 ... 64"},
    });
}

TEST_CASE("materials and motions that do not go together are refused" *
          doctest::description("robust")) {
    check_refused({
        {"unknown material", disks, "grain.left.material=steel",
         "[grain.left]: there is no [material.steel]; add it, or name another material"},
        {"no material", disks, "grain.left.material=",
         "[grain.left]: there is no [material.]; add it, or name another material"},
        {"unknown material of a pack", disks, "pack.p.material=steel",
         "[pack.p]: there is no [material.steel]; add it, or name another material"},
        {"unknown law", disks, "material.default.law=plastic",
         "'material.default.law' = \"plastic\" is not one of \"elastic\", \"j2\", "
         "\"drucker_prager\", \"rigid\""},
        {"dilatancy above friction", disks,
         "material.default.law=drucker_prager material.default.dilatancy_angle=40",
         "[material.default]: dilatancy_angle = 40 is above friction_angle = 30: flow would make "
         "energy; take at most the friction angle"},
        {"incompressible", disks, "material.default.nu=0.5",
         "'material.default.nu' = 0.5 is out of range; allowed: -0.99 ... 0.495"},
        {"servo of an elastic grain", disks, "grain.left.control=force_x",
         "grain 'left' has control = \"force_x\" and is not rigid: give it a material with law = "
         "\"rigid\""},
        {"spin of a plate", plates, "grain.top.spin=1",
         "grain 'top' is rigid and moves without turning: take out spin and profile"},
        {"profile of a plate", plates, "grain.top.profile=wave",
         "grain 'top' is rigid and moves without turning: take out spin and profile"},
        {"profile of a disk", disks, "grain.left.profile=bar",
         "grain 'left' has a profile of its velocity, which is for boxes: set shape = \"box\""},
    });
}

TEST_CASE("packs that cannot be made are refused with the cure" * doctest::description("robust")) {
    const auto made = [](const std::string& how) {
        std::string arguments;
        std::istringstream words(how);
        for (std::string word; words >> word;) arguments += " pack.p." + word;
        return arguments;
    };
    const std::string region = " width=1.2 height=0.6 radius_min=0.1 radius_max=0.1";
    check_refused({
        {"full box", mesh, made("kind=random count=50" + region),
         "[pack.p]: the box is full with 17 disks and a solid fraction of 0.7418: ask for fewer, "
         "or make the box larger"},
        {"loose and full box", mesh, made("kind=loose count=50" + region),
         "[pack.p]: the box is full with 10 disks and a solid fraction of 0.4363: ask for fewer"},
        {"box below a disk", mesh, made("kind=random radius_min=0.4 radius_max=0.4 height=0.6"),
         "[pack.p]: a box of 1 by 0.6 is too small for disks 0.8 wide: it must be as high, and 1 "
         "times as wide"},
        {"narrow periodic box", mesh, periodic + made("kind=random width=0.3" + region),
         "command line: 'pack.p.width=1.2': 'pack.p.width' is given twice; keep one of them"},
        {"radii the wrong way around", mesh, made("kind=random radius_min=0.2 radius_max=0.1"),
         "[pack.p]: the largest radius of a pack, 0.1, must be 1 to 100 times the least, 0.2"},
        {"one disk and one less", mesh, made("columns=1 rows=2"),
         "[pack.p]: 2 rows of 1 disks: give at least one disk in each row, and at most 1e6"},
        {"a hundred million disks", mesh, made("columns=10000 rows=10000"),
         "[pack.p]: 10000 rows of 10000 disks"},
        {"two sides of packed grains", mesh, made("sides=2 x=0.2 y=0.2 columns=1 rows=1"),
         "[pack.p]: a regular polygon of 2 sides: give 3 to 1000"},
        {"half a row", mesh, made("rows=1.5"), "'pack.p.rows' takes a whole number, not 1.5"},
        {"unknown kind", mesh, made("kind=cubic"),
         "'pack.p.kind' = \"cubic\" is not one of \"hexagonal\", \"random\", \"loose\", \"file\""},
        {"file of rows", mesh, made("file=pack.txt"),
         "[pack.p]: file belongs to kind = \"file\": set it, or take file out"},
        {"no name of a file", mesh, made("kind=file"),
         "[pack.p]: kind = \"file\" needs the name of a file: set file"},
        {"no file", mesh, made("kind=file file=nowhere.txt"),
         "[pack.p]: nowhere.txt: there is no such file"},
        {"folder", mesh, made("kind=file file=foreign"),
         "[pack.p]: foreign: is a folder, not a file"},
        {"dangling link", mesh, made("kind=file file=dangling"),
         "[pack.p]: dangling: there is no such file"},
        {"long name", mesh,
         "output.pack=true grain.a_name_that_goes_on_and_on_for_forty_one_letters.x=0.3 "
         "grain.a_name_that_goes_on_and_on_for_forty_one_letters.y=0.3",
         "grain 'a_name_that_goes_on_and_on_for_forty_one_letters' has a name of 48 letters, and "
         "pack.txt takes 40: shorten it, or set output.pack = false"},
    });
}

TEST_CASE("damaged files of packs are refused with their line" * doctest::description("robust")) {
    const std::string good = "# grains\ndisk a 0.3 0.3 0.1\n", zero("disk b\0 1 1 1\n", 14);
    const std::vector<std::pair<std::string, std::string>> damaged{
        {"", "pack.txt: holds no grain; write lines like: disk left 0.35 0.3 0.2"},
        {"# nothing\n\n", "pack.txt: holds no grain"},
        {good + "ball b 1 1 1\n",
         "pack.txt:3: unknown word 'ball'; a line begins with disk or polygon"},
        {good + "disk\n", "pack.txt:3: a disk without a name; write its name and its numbers"},
        {good + "disk b-c 1 1 1\n",
         "pack.txt:3: 'b-c' cannot name a grain: use letters, digits and '_', 40 at most"},
        {good + "disk b 1 1\n", "pack.txt:3: a disk takes 3 numbers, x y radius, not 2"},
        {good + "disk b 1 1 1 1\n", "pack.txt:3: a disk takes 3 numbers, x y radius, not 4"},
        {good + "disk b 1 one 1\n",
         "pack.txt:3: 'one' is not a number: write one like 0.25 or 1e-3"},
        {good + "disk b 1 0x1 1\n", "pack.txt:3: '0x1' is not a number"},
        {good + "disk b 1 nan 1\n",
         "pack.txt:3: 'nan' is no number to compute with: give a finite one"},
        {good + "disk b 1e999 1 1\n", "pack.txt:3: '1e999' is no number to compute with"},
        {good + "disk b 1 1 -1\n",
         "pack.txt:3: 'b': the radius of a disk = -1 must be a length above 0: give one"},
        {good + "polygon b 0 0 1 0\n",
         "pack.txt:3: a polygon takes two numbers, x y, for each of 3 or more corners, not 4 "
         "numbers"},
        {good + "polygon b 0 0 1 0 1\n", "for each of 3 or more corners, not 5 numbers"},
        {good + "polygon b 0 0 1 1 1 0 0 1\n",
         "pack.txt:3: 'b': the side from corner 1 to 2 of a polygon meets the side from corner 3 "
         "to 4"},
        {good + "disk a 0.8 0.3 0.1\n",
         "pack.txt:3: the name 'a' is that of line 2 too: give each grain its own"},
        {good + "disk \xff 1 1 1\n", "pack.txt:3: not UTF-8 text; save the file as UTF-8"},
        {good + zero, "pack.txt:3: a control character; this is not a text file, or it is damaged"},
        {good + "\x1b[2J\n", "pack.txt:3: a control character"},
        {good + std::string(100001, '#'),
         "pack.txt:3: the line has more than 100000 letters; this is not a pack of grains"},
        {good + "disk b 0.35 0.3 0.1\n",
         "grains 'p_a' and 'p_b' overlap by 0.15, 3 cells: move them apart"},
    };
    int number = 0;
    for (const auto& [bytes, message] : damaged)
        check_refused({{std::to_string(++number) + " damaged", mesh,
                        "pack.p.kind=file pack.p.file=pack.txt", message}},
                      {{"pack.txt", bytes}});
}

TEST_CASE("bonds that nothing can hold are refused with their names" *
          doctest::description("robust")) {
    const std::string joint = "bond.joint.a=left bond.joint.b=right ",
                      together = "grain.left.x=0.4 grain.right.x=0.8 ";
    check_refused({
        {"bond across a gap", disks, joint,
         "[bond.joint]: 'left' and 'right' do not touch: put them within a quarter of a cell"},
        {"bond of any across a gap", disks, "bond.joint.tension=1",
         "[bond.joint]: '*' and '*' do not touch"},
        {"bond of nobody", disks, joint + "bond.joint.b=nobody",
         "command line: 'bond.joint.b=nobody': 'bond.joint.b' is given twice"},
        {"bond to nobody", disks, "bond.joint.a=nobody",
         "[bond.joint]: there is no grain 'nobody'; name one of the case, or \"*\" for all"},
        {"bond to nothing", disks, "bond.joint.a=", "[bond.joint]: there is no grain ''"},
        {"bond to itself", disks, together + "bond.joint.a=left bond.joint.b=left",
         "[bond.joint]: 'left' and 'left' do not touch"},
        {"bond of plates", plates,
         "grain.top.y=0.15 grain.disk.y=0.4 bond.joint.a=top bond.joint.b=bottom",
         "[bond.joint]: 'top' and 'bottom' are rigid and need no bond: take it out"},
        {"two bonds of one pair", disks, together + joint + "bond.more.tension=1",
         "[bond.more]: 'left' and 'right' are bonded already: let one bond name both"},
        {"bond without strength", disks, together + joint + "bond.joint.tension=0",
         "'bond.joint.tension' = 0 is out of range; allowed: > 0 stress"},
    });
    // Across the seam of a periodic mesh, and within a quarter of a cell.
    check_described("bonds across the seam", around,
                    periodic + "grain.left.x=0.2 grain.right.x=0.99 " + joint);
}

TEST_CASE("comparisons of mpm_explicit are refused where theory does not hold" *
          doctest::description("robust")) {
    const std::string compare = "theory.compare=";
    const std::string meet = "theory.compare = \"rebound\" needs two equal disks that meet head on";
    const std::string bar =
        "theory.compare = \"bar\" needs boxes with profile = \"bar\", an amplitude, and "
        "boundary.x_low = \"slip\" or \"stick\"";
    const std::string wave =
        "theory.compare = \"standing_wave\" needs one box with profile = \"wave\", an amplitude, "
        "and all walls \"slip\"";
    const std::string incline =
        "needs one grain, a rigid plate, and an inclined gravity: load.gravity_x not 0, "
        "load.gravity_y below 0";
    const std::string press =
        "theory.compare = \"disk\" needs a disk, first in the case, and rigid plates, at most 16";
    const std::string profile = " grain.body.amplitude=1e-3 grain.body.profile=";
    check_refused({
        {"disks of two sizes", disks, compare + "rebound time.end=1 grain.left.radius=0.19", meet},
        {"disks that part", disks,
         compare + "rebound time.end=1 grain.left.velocity_x=-0.2 grain.right.velocity_x=0.1",
         meet},
        {"disks that pass", disks, compare + "rebound time.end=1 grain.left.velocity_y=0.1", meet},
        {"disks of two materials", disks,
         compare + "rebound time.end=1 material.soft.E=1e3 grain.left.material=soft", meet},
        {"one disk", mesh + left, compare + "rebound", meet},
        {"box and disk", disks, compare + "rebound grain.left.shape=box", meet},
        {"disks that meet later", disks, compare + "rebound time.end=0.4",
         "theory.compare = \"rebound\": the disks meet at t = 0.5, and the run ends at 0.4: raise "
         "time.end"},
        {"few rows", disks, compare + "collapse time.end=0.02",
         "theory.compare = \"collapse\" needs at least 10 rows of history, and there would be 6: "
         "raise time.end or lower output.history_steps"},
        {"few rows of many steps", disks, compare + "collapse output.history_steps=10",
         "theory.compare = \"collapse\" needs at least 10 rows of history, and there would be 3"},
        {"bar without a profile", body, compare + "bar boundary.x_low=slip", bar},
        {"bar without a wall", body, compare + "bar" + profile + "bar", bar},
        {"bar at a rubbing wall", body, compare + "bar boundary.x_low=frictional" + profile + "bar",
         bar},
        {"bar without an amplitude", body,
         compare + "bar boundary.x_low=slip grain.body.profile=bar", bar},
        {"bar beside the wall", body,
         compare + "bar boundary.x_low=slip grain.body.width=0.6" + profile + "bar",
         "theory.compare = \"bar\" needs a bar that begins at the wall, at x = 0, not at 0.1"},
        {"bond of one bar", body, compare + "bond boundary.x_low=slip" + profile + "bar",
         "theory.compare = \"bond\" needs two boxes and a [bond.<name>] between them"},
        {"wave between open ends", body, compare + "standing_wave" + profile + "wave", wave},
        {"wave of a bar", body, compare + "standing_wave " + slip + profile + "bar", wave},
        {"wave of two bodies", disks, compare + "standing_wave " + slip, wave},
        {"wave in part of the mesh", body,
         compare + "standing_wave " + slip + "grain.body.height=0.3" + profile + "wave",
         "theory.compare = \"standing_wave\" needs a box that fills the mesh: make it 0.8 by 0.4"},
        {"oscillator of many cells", body, compare + "oscillator " + slip + profile + "wave",
         "theory.compare = \"oscillator\" needs grid.cells_x = 2, method.frozen = true, and linear "
         "FLIP"},
        {"oscillator that moves", shipped("oscillator"), "method.frozen=false",
         "theory.compare = \"oscillator\" needs grid.cells_x = 2, method.frozen = true"},
        {"oscillator of splines", shipped("oscillator"), "method.shape=quadratic",
         "theory.compare = \"oscillator\" needs grid.cells_x = 2, method.frozen = true"},
        {"block without a plate", body, compare + "block load.gravity_x=1 load.gravity_y=-1",
         "theory.compare = \"block\" " + incline},
        {"block on level ground", shipped("incline_block"), "load.gravity_x=0",
         "theory.compare = \"block\" " + incline},
        {"cylinder that falls up", shipped("incline_cylinder"), "load.gravity_y=1",
         "theory.compare = \"cylinder\" " + incline},
        {"disk without plates", mesh + left, compare + "disk", press},
        {"two disks and no plates", disks, compare + "disk", press},
        {"box between plates", plates, compare + "disk grain.disk.shape=box", press},
        {"disk that cannot yield", disks, compare + "yield",
         "theory.compare = \"yield\" needs a grain of a material with law = \"j2\", and 'left' is "
         "of another: set theory.grain"},
        {"the other disk yields", disks,
         compare + "yield material.soft.law=j2 grain.right.material=soft",
         "needs a grain of a material with law = \"j2\", and 'left' is of another"},
        {"nothing yields at rest", mesh + end + left,
         compare + "yield material.default.law=j2 grain.left.velocity_x=0",
         "theory.compare = \"yield\" measures shares of the energy at the start, and nothing moves "
         "then: give a grain a velocity"},
        {"nobody", plates, compare + "disk theory.grain=nobody",
         "theory.grain: there is no grain 'nobody'"},
        {"no plate", plates, compare + "disk theory.plate=nobody",
         "theory.plate: there is no grain 'nobody'"},
        {"plate for a grain", plates, compare + "disk theory.grain=top",
         "theory.grain: 'top' is rigid: name another grain"},
        {"grain for a plate", plates, compare + "disk theory.plate=disk",
         "theory.plate: 'disk' is not rigid: name another grain"},
    });
    check_described("the other disk yields and is seen", disks,
                    compare +
                        "yield material.soft.law=j2 grain.right.material=soft "
                        "theory.grain=right");
}

TEST_CASE("keys and values of grains are refused with their place" *
          doctest::description("robust")) {
    check_refused({
        {"unknown key", disks + "radus = 0.1\n", "",
         "case.toml:17:9: unknown parameter 'grain.right.radus'; did you mean "
         "'grain.right.radius'?"},
        {"unknown section", disks + "[meash]\ncells_x = 3\n", "",
         "unknown parameter 'meash.cells_x'; did you mean 'grid.cells_x'?"},
        {"long override", disks, "grain.left.vertices='" + std::string(901, '1') + "'",
         "has 901 letters; write at most 900"},
        {"unknown override", disks, "grain.left.materiel=steel",
         "command line: 'grain.left.materiel=steel': "},
        {"key without an item", disks, "grain.radius=1",
         "'grain.radius' needs the name of an item: write [grain.<name>] above its parameters"},
        {"grain twice", disks + left, "", "case.toml:17:1: "},
        {"key twice", disks + "radius = 0.1\n", "", "case.toml:17:10: "},
        {"override twice", disks, "time.end=1 time.end=2",
         "'time.end' is given twice; keep one of them"},
        {"text for a number", disks + "spin = \"fast\"\n", "",
         "case.toml:17:8: 'grain.right.spin' takes a number, not text"},
        {"number for text", disks + "material = 3\n", "",
         "'grain.right.material' takes text, not a whole number"},
        {"list for text", disks + "vertices = [0, 1]\n", "", "case.toml:17:"},
        {"number for a choice", disks + "shape = 1\n", "",
         "'grain.right.shape' takes text, one of \"disk\", \"box\", \"polygon\", not a whole "
         "number"},
        {"unknown choice", disks, "grain.left.shape=ball",
         "'grain.left.shape' = \"ball\" is not one of \"disk\", \"box\", \"polygon\""},
        {"control character in text", disks + "material = \"a\\u001Bb\"\n", "",
         "'grain.right.material' holds a control character; write plain text"},
        {"long text", disks + "vertices = \"" + std::string(901, '1') + "\"\n", "",
         "'grain.right.vertices' has 901 letters; write at most 900"},
        {"open quotes", disks, "grain.left.material=a\\'b",
         "command line: 'grain.left.material=a'b': "},
        {"not UTF-8", disks + "material = \"\xff\"\n", "", "case.toml:17:"},
        {"not a name", disks, "grain.2.x=1",
         "'2' cannot name an item: use letters, digits and '_', a letter first"},
        {"number for a grain", disks + "[grain]\nmiddle = 3\n", "", "case.toml:18:"},
        {"truth for a number", disks, "grid.length_x=true",
         "'grid.length_x' takes a number, not true or false"},
        {"number for truth", disks, "grid.periodic_x=1",
         "'grid.periodic_x' takes true or false, not a whole number"},
        {"no case", std::nullopt, "nowhere.toml", "nowhere.toml: there is no such file"},
    });
    std::string many = mesh;
    for (int k = 0; k < 257; ++k) many += "[grain.g" + std::to_string(k) + "]\nx = 0.3\n";
    check_refused({{"many grains", many, "", "more than 256 items in [grain]: take some out"}});
}

TEST_CASE("a restart of mpm_explicit keeps what its checkpoint says" *
          doctest::description("robust")) {
    const fs::path folder = fresh_folder("restarts");
    const std::string packed =
        mesh + end + "[pack.p]\nkind = \"file\"\nfile = \"pack.txt\"\n[bond.joint]\n";
    write_all(folder / "case.toml", packed);
    const std::string pack = "disk a 0.3 0.3 0.1\ndisk b 0.5 0.3 0.1\n";
    write_all(folder / "pack.txt", pack);
    REQUIRE(start(folder, "case.toml --quiet output.checkpoint_steps=10 --out run").status == 0);
    const std::string good = read_all(folder / "run/checkpoint_0000000020.bin");
    std::string flipped = good;
    flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 0x10);
    const Files files{{"good.bin", good},
                      {"flipped.bin", flipped},
                      {"cut.bin", good.substr(0, good.size() - 8)},
                      {"pack.txt", pack}};
    const auto unchangeable = [](const std::string& name, const std::string& value) {
        return Row{"restart with another " + name, std::nullopt,
                   "--restart good.bin " + name + "=" + value,
                   "'" + name + "' cannot change on a restart; start a new run with it"};
    };
    check_refused(
        {unchangeable("time.alpha", "0.2"),
         unchangeable("method.shape", "gimp"),
         unchangeable("grid.periodic_x", "true"),
         unchangeable("boundary.x_low", "slip"),
         unchangeable("contact.friction", "1"),
         unchangeable("load.gravity_y", "-1"),
         unchangeable("material.default.E", "1"),
         unchangeable("pack.p.velocity_x", "1"),
         unchangeable("bond.joint.tension", "1"),
         unchangeable("grain.more.x", "1"),
         unchangeable("theory.compare", "collapse"),
         unchangeable("output.history_steps", "2"),
         {"restart beyond its end", std::nullopt, "--restart good.bin time.end=0.05",
          "good.bin: is at step 20, and the run ends at step 15: raise time.end"},
         {"restart with a case", disks, "--restart good.bin",
          "--restart takes its case from the checkpoint: leave out 'case.toml'"},
         {"restart of a damaged file", std::nullopt, "--restart flipped.bin",
          "flipped.bin: the checkpoint is damaged (its checksum is wrong)"},
         {"restart of a cut file", std::nullopt, "--restart cut.bin",
          "cut.bin: the checkpoint is cut off or too long; use an earlier one"},
         {"restart of text", std::nullopt, "--restart a_file", "a_file: is not a checkpoint"}},
        files);

    // The pack is read again, and must be the same.
    check_refused({{"restart without its pack", std::nullopt, "--restart good.bin",
                    "[pack.p]: pack.txt: there is no such file"}},
                  {{"good.bin", good}});
    for (const std::string& other : {pack + "disk c 0.8 0.3 0.1\n", "disk a 0.3 0.3 0.1\n" + pack,
                                     std::string("disk a 0.3 0.3 0.1\ndisk b 0.5 0.3 0.09\n")}) {
        write_all(folder / "pack.txt", other);
        const Outcome outcome =
            start(folder, "--restart run/checkpoint_0000000020.bin --out again --force --quiet");
        INFO(outcome.err);
        CHECK(outcome.status == 2);
        CHECK(outcome.sentences.size() == 1);
    }
}

TEST_CASE("every range that mpm_explicit lists is enforced" * doctest::description("robust")) {
    CHECK(check_ranges() >= 60);
}

TEST_CASE("help of mpm_explicit lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    auto units = check_help(
        "[time]\nend = 0\n[grain.beam]\nx = 0.6\ny = 0.45\n",
        "material.beam.E=1 pack.beam.x=0.2 pack.beam.y=0.15 pack.beam.columns=2 pack.beam.rows=1 "
        "bond.beam.tension=1");
    CHECK(units["grid.length_x"] == "length");
    CHECK(units["contact.separation"] == "h");
    CHECK(units["load.gravity_x"] == "acceleration");
    CHECK(units["time.end"] == "time");
    CHECK(units["material.<name>.E"] == "stress");
    CHECK(units["material.<name>.friction_angle"] == "degree");
    CHECK(units["grain.<name>.spin"] == "1/time");
    CHECK(units["grain.<name>.damping"] == "force/velocity");
    CHECK(units["pack.<name>.radius_min"] == "length");
    CHECK(units["bond.<name>.shear"] == "stress");
}

TEST_CASE("the version of mpm_explicit is that of the Makefile" * doctest::description("robust")) {
    check_version();
}

TEST_CASE("every shipped case of mpm_explicit passes a dry run" * doctest::description("robust")) {
    CHECK(check_shipped_cases() >= 13);
}

TEST_CASE("a dry run of mpm_explicit shows scales and memory and time" *
          doctest::description("robust")) {
    const std::string out =
        check_described("dry run", shipped("rebound"), "--out run --threads 2").out;
    // c_p^2 = 1.346 E/density, dt = 0.25 h/(c_p + |v|), and 0.4^2 pi/4 (2/h)^2 particles in each.
    check_lines(
        out,
        {R"(  mesh +48 x 24 cells of 0\.025)", R"(  walls +x: open, open; y: .*)",
         R"(  method +linear shape functions, FLIP)", R"(  grains +2, the thinnest 16 cells)",
         R"(  particles +1608, 2 x 2 per cell)", R"(  sound +c_p = 3\.669, largest \|v\| = 0\.1)",
         R"(  steps +1206 of dt = 0\.001658, alpha = 0\.25)", R"(  memory +about [0-9.e+-]+ MiB)",
         R"(  time +about [0-9.e+-]+ s on.*)"});
    CHECK(check_described("quiet dry run", disks, "--quiet").out.empty());
    CHECK(holds(check_described("periodic dry run", shipped("shear"), "").out,
                "50 x 46 cells of 0.02, periodic in x"));
    const std::string other =
        check_described("dry run of a variant", disks,
                        "method.shape=gimp method.flip=0.9 method.frozen=true boundary.y_low=stick")
            .out;
    CHECK(holds(other, "gimp shape functions, FLIP fraction 0.9, frozen particles\n"));
    CHECK(holds(other, "y: stick, open\n"));
}

TEST_CASE("what may mislead in mpm_explicit is a warning with the number and the limit" *
          doctest::description("robust")) {
    check_warnings("no warning", disks, "", {});
    check_warnings("large steps", disks, "time.alpha=0.8",
                   {"warning: time.alpha = 0.8 is above 0.7: nothing bounds the energy of explicit "
                    "solutions, and grains that meet will burst\n"});
    check_warnings("large steps of particles at rest", disks, "time.alpha=0.8 method.frozen=true",
                   {});
    check_warnings("fast impact", disks, "grain.left.velocity_x=0.3669",
                   {"warning: |v|/c_p = 0.1 is above 0.05: an impact strains the grains by more "
                    "than the small strains of the material laws\n"});
    check_warnings("fast grain alone", mesh + end + left, "grain.left.velocity_x=0.3669", {});
    check_warnings(
        "weight", disks, "load.gravity_y=-2.25",
        {"warning: g H/c_p^2 = 0.1003 is above 0.05: grains at the bottom are crushed by "
         "the weight of a full mesh; stiffen the material\n"});
    check_warnings(
        "early contact", disks, "contact.separation=0",
        {"warning: contact.separation = 0: grains meet where they share nodes, up to 1.5 "
         "cells too early\n"});
    check_warnings(
        "late contact", disks, "grid.particles_per_side=1",
        {"warning: contact.separation = 0.8 with one particle per side: grains will meet "
         "too late; take 1.07\n"});
    check_warnings("contact in time", disks, "grid.particles_per_side=1 contact.separation=1.07",
                   {});
    check_warnings("short intervals", disks,
                   "output.particles_interval=1e-3 output.fringes_interval=1 "
                   "output.grains_interval=1e-4",
                   {"warning: output.particles_interval = 0.001 is below the time step 0.003317: "
                    "files are written every step\n",
                    "warning: output.grains_interval = 0.0001 is below the time step 0.003317"});
    check_warnings(
        "force without a servo", plates, "grain.bottom.force=2",
        {"warning: grain 'bottom' has a force and control = \"velocity\": the force does "
         "nothing\n"});
    check_warnings("velocity of a servo", plates, "grain.top.velocity_y=-0.1",
                   {"warning: grain 'top' has control = \"force_y\" and a velocity in that "
                    "direction, -0.1: it does nothing, the grain starts at rest\n"});
    check_warnings("velocity across a servo", plates, "grain.top.velocity_x=-0.1", {});
}

TEST_CASE("a case at the edge of what mpm_explicit takes ends with status 0" *
          doctest::description("robust")) {
    const auto check = [](const std::string& bytes, const std::string& arguments) {
        const fs::path folder = fresh_folder("edge");
        write_all(folder / "case.toml", bytes);
        write_all(folder / "a pack's file.txt", "disk a 0.3 0.3 0.1");
        const Outcome outcome = start(folder, "case.toml --quiet " + arguments);
        INFO(arguments << ": " << outcome.err);
        CHECK(outcome.status == 0);
        CHECK(outcome.sentences.empty());
        CHECK(!holds(read_all(folder / "out/mpm_explicit/case/history.dat"), "nan"));
    };
    check(disks, "time.end=0 output.fringes_interval=1 output.grains_interval=1");
    check(disks, "time.end=1e-300 output.pack=true");
    check(disks, "time.alpha=1e30");
    check(disks, "output.particles_interval=1e300 output.grains_interval=1e300");
    check(disks, "grid.particles_per_side=16 time.end=0.01");
    check(disks, "grid.low_x=-1000 grain.left.x=-999.65 grain.right.x=-999.15");
    check(disks,
          "grain.left.velocity_x=0 grain.right.velocity_x=0 output.vtk=true "
          "output.particles_interval=0.05");
    // The smallest mesh, full, with every kind of wall.
    const std::string small =
        "grid.cells_x=2 grid.cells_y=2 grid.length_x=0.8 grain.body.y=0.4 "
        "grain.body.height=0.8 load.gravity_y=-1e-3 ";
    for (const std::string shape : {"linear", "gimp", "quadratic"})
        for (const std::string wall : {"slip", "stick", "frictional"})
            check(body, small + "method.shape=" + shape + " boundary.x_low=" + wall +
                            " boundary.x_high=" + wall + " boundary.y_low=" + wall +
                            " boundary.y_high=" + wall);
    // A ring around the shortest periodic mesh, and grains that straddle its ends.
    check(body, periodic + "grain.body.velocity_x=0.3 grain.body.height=0.3");
    check(body, periodic +
                    "grain.body.x=0.7 grain.body.width=0.6 grain.body.height=0.3 "
                    "method.shape=quadratic");
    check(around, periodic + "grain.left.x=1.25 grain.right.x=-0.45");
    check(plates, "grain.top.force=-1e-3 grain.top.damping=1e30");
    check(plates, "grain.bottom.velocity_x=0.1 load.rise=1e30");
    check(mesh + end, "pack.p.kind=file pack.p.file='\"a pack'\"'\"'s file.txt\"'");
    check(mesh + end, "pack.p.x=0.2 pack.p.y=0.2 pack.p.columns=3 pack.p.rows=1 pack.p.sides=5");
}
