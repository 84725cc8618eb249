// Wrong case files and wrong command lines: one sentence with place and cure, status 2, nothing
// written.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>

#include "tests/support/any_program.hpp"

const std::string facts::program_name = "implicit_moment";

namespace {

using namespace facts;
using namespace std::string_literals;

// Cases to which a row adds its fault.
const std::string uniform = "[plasma]\nsetup = \"uniform\"\n[grid]\nboundary_z = \"periodic\"\n";
const std::string beam = uniform + "[species.beam]\ncharge = -1\n";

// Arguments that let a case end at once, for faults that a program might swallow.
const std::string brief = "time.end=0 harris.particles=2 grid.cells_x=4 grid.cells_z=4 --quiet";

std::string species(int count) {
    std::string text = uniform;
    for (int k = 0; k < count; ++k) text += "[species.s" + std::to_string(k) + "]\ncharge = 1\n";
    return text;
}

}  // namespace

TEST_CASE("damaged text of a case file is refused with its place" *
          doctest::description("robust")) {
    check_refused({
        {"invalid UTF-8", "[time]\ndt = 0.3 # \xff\n", "",
         "case.toml:2:12: not UTF-8 text; save the file as UTF-8"},
        {"Latin-1", "# caf\xe9\n", "", "case.toml:1:6: not UTF-8 text"},
        {"overlong UTF-8", "# \xc0\xaf\n", "", "case.toml:1:3: not UTF-8 text"},
        {"surrogate in UTF-8", "# \xed\xa0\x80\n", "", "case.toml:1:3: not UTF-8 text"},
        {"cut off UTF-8", "# \xe2\x82", "", "case.toml:1:3: not UTF-8 text"},
        {"UTF-16 with its mark", "\xff\xfe[\0t\0"s, "", "case.toml:1:1: not UTF-8 text"},
        {"UTF-16 without a mark", "[\0t\0i\0m\0e\0]\0"s, "", "case.toml:1:2: a control character"},
        {"NUL byte", "[time]\ndt = \0000.3\n"s, "", "case.toml:2:6: a control character"},
        {"escape character", "[time]\n# \x1b[31m\n", "", "case.toml:2:3: a control character"},
        {"delete character", "#\x7f\n", "", "case.toml:1:2: a control character"},
        {"lone carriage return", "[time]\rdt = 0.3\n", "", "case.toml:1:7: a control character"},
        {"unterminated text", "[plasma]\nsetup = \"harris\n", "", "case.toml:2:"},
        {"unterminated long text", "[plasma]\nsetup = \"\"\"harris\n", "", "case.toml:2:"},
        {"unterminated list", "[time]\ndt = [0.3\n", "", "case.toml:2:"},
        {"unterminated section", "[time\ndt = 0.3\n", "", "case.toml:1:"},
        {"no value", "[time]\ndt =\n", "", "case.toml:2:"},
        {"no equals sign", "[time]\ndt 0.3\n", "", "case.toml:2:4:"},
        {"no key", "[time]\n= 0.3\n", "", "case.toml:2:1:"},
        {"two values", "[time]\ndt = 0.3 0.4\n", "", "case.toml:2:10:"},
        {"decimal comma", "[time]\ndt = 0,3\n", "", "case.toml:2:7:"},
        {"capital truth", "[output]\nvtk = True\n", "", "case.toml:2:7:"},
        {"word without quotes", "[plasma]\nsetup = harris\n", "", "case.toml:2:9:"},
        {"bad escape", "[plasma]\nsetup = \"har\\qis\"\n", "", "case.toml:2:"},
        {"nested lists", "a = "s + repeated("[", 10000), "", "case.toml:1:"},
        {"nested tables", "a = "s + repeated("{a = ", 10000), "", "case.toml:1:"},
        {"nested keys", repeated("a.", 100000) + "a = 1\n", "", "case.toml:1:"},
        {"nested sections", "["s + repeated("a.", 100000) + "a]\n", "", "case.toml:1:"},
        {"line break inside a choice", "[plasma]\nsetup = \"har\\nris\"\n", "",
         "case.toml:2:9: 'plasma.setup' holds a control character"},
        {"NUL inside a choice", "[plasma]\nsetup = \"har\\u0000ris\"\n", "",
         "case.toml:2:9: 'plasma.setup' holds a control character"},
        {"escape inside a choice", "[plasma]\nsetup = \"\\u001b[31mharris\"\n", "",
         "case.toml:2:9: 'plasma.setup' holds a control character"},
        {"line break inside a key", "[time]\n\"d\\nt\" = 0.3\n", "", "case.toml:2:"},
    });
}

TEST_CASE("values of a wrong type are refused with the type that is wanted" *
          doctest::description("robust")) {
    check_refused({
        {"text for a number", "[time]\ndt = \"0.3\"\n", "",
         "case.toml:2:6: 'time.dt' takes a number, not text"},
        {"truth for a number", "[time]\ndt = true\n", "",
         "case.toml:2:6: 'time.dt' takes a number, not true or false"},
        {"text for a whole number", "[grid]\ncells_x = \"64\"\n", "",
         "case.toml:2:11: 'grid.cells_x' takes a whole number, not text"},
        {"truth for a whole number", "[grid]\ncells_x = true\n", "",
         "case.toml:2:11: 'grid.cells_x' takes a whole number, not true or false"},
        {"fraction for a whole number", "[plasma]\nseed = 1.5\n", "",
         "case.toml:2:8: 'plasma.seed' takes a whole number, not 1.5"},
        {"number for truth", "[output]\nvtk = 1\n", "",
         "case.toml:2:7: 'output.vtk' takes true or false, not a whole number"},
        {"text for truth", "[output]\nvtk = \"true\"\n", "",
         "case.toml:2:7: 'output.vtk' takes true or false, not text"},
        {"number for text", "[plasma]\nsetup = 1\n", "",
         "case.toml:2:9: 'plasma.setup' takes text, one of \"harris\", \"uniform\", "},
        {"truth for text", "[plasma]\nloading = false\n", "",
         "case.toml:2:11: 'plasma.loading' takes text, one of \"quiet\", \"random\", not true"},
        {"list for a number", "[time]\ndt = [0.3, 0.4]\n", "",
         "case.toml:2:6: 'time.dt' is a list or a date; parameters are numbers, text, true"},
        {"empty list for a number", "[time]\ndt = []\n", "", "case.toml:2:6: 'time.dt' is a list"},
        {"date for a number", "[time]\nend = 2026-11-21\n", "",
         "case.toml:2:7: 'time.end' is a list or a date"},
        {"hour for a number", "[time]\nend = 07:32:00\n", "",
         "case.toml:2:7: 'time.end' is a list or a date"},
        {"list of tables", "[[species]]\ncharge = 1\n", "",
         "case.toml:1:1: 'species' is a list or a date"},
        {"number for a section", "grid = 64\n", "", "case.toml:1:8: unknown parameter 'grid'"},
        {"section for a number", "[time.dt]\nvalue = 0.3\n", "",
         "case.toml:2:9: unknown parameter 'time.dt.value'"},
        {"table for a number", "[time]\ndt = {value = 0.3}\n", "",
         "case.toml:2:15: unknown parameter 'time.dt.value'"},
        {"empty section for a number", "[time.dt]\n", brief, "case.toml:1:"},
        {"empty table for a number", "[time]\ndt = {}\n", brief, "case.toml:2:6:"},
        {"number for the species", "species = 2\n", "",
         "case.toml:1:11: unknown parameter 'species'"},
        {"number for one species", "[species]\nbeam = 2\n", "",
         "case.toml:2:8: 'species.beam' needs the name of an item: write [species.<name>] above"},
        {"species without a name", "[species]\ndensity = 1\n", "",
         "case.toml:2:11: 'species.density' needs the name of an item"},
    });
}

TEST_CASE("values out of range are refused with the range" * doctest::description("robust")) {
    check_refused({
        {"negative cells", "[grid]\ncells_x = -64\n", "",
         "case.toml:2:11: 'grid.cells_x' = -64 is out of range; allowed: 4 ... 4096"},
        {"too few cells", "[grid]\ncells_z = 3\n", "",
         "case.toml:2:11: 'grid.cells_z' = 3 is out of range; allowed: 4 ... 4096"},
        {"no time step", "[time]\ndt = 0\n", "",
         "case.toml:2:6: 'time.dt' = 0 is out of range; allowed: > 0 1/omega_pi"},
        {"negative zero time step", "[time]\ndt = -0.0\n", "",
         "case.toml:2:6: 'time.dt' = -0 is out of range; allowed: > 0 1/omega_pi"},
        {"nan", "[time]\ndt = nan\n", "", "case.toml:2:6: 'time.dt' must be finite, not nan"},
        {"inf", "[time]\nend = inf\n", "", "case.toml:2:7: 'time.end' must be finite, not inf"},
        {"negative inf", "[uniform]\nB_x = -inf\n", "",
         "case.toml:2:7: 'uniform.B_x' must be finite, not -inf"},
        {"nan for a whole number", "[plasma]\nseed = nan\n", "",
         "case.toml:2:8: 'plasma.seed' must be finite, not nan"},
        {"inf for a whole number", "[plasma]\nseed = +inf\n", "",
         "case.toml:2:8: 'plasma.seed' must be finite, not inf"},
        {"too large a number", "[time]\ndt = 1e400\n", "",
         "'1e400' could not be interpreted as a value"},
        {"too large a whole number", "[plasma]\nseed = 99999999999999999999\n", "",
         "'99999999999999999999' is not representable in 64 bits"},
        {"largest whole number", "[plasma]\nseed = 9223372036854775807\n", "",
         " is out of range; allowed: 0 ... 1e+09"},
        {"theta below a half", "[field]\ntheta = 0.4999999999999999\n", "",
         "case.toml:2:9: 'field.theta' = 0.4999999999999999 is out of range; allowed: 0.5 ... 1"},
        {"unknown choice", "[plasma]\nsetup = \"haris\"\n", "",
         "case.toml:2:9: 'plasma.setup' = \"haris\" is not one of \"harris\", \"uniform\""},
        {"choice with capitals", "[grid]\nboundary_z = \"Wall\"\n", "",
         "case.toml:2:14: 'grid.boundary_z' = \"Wall\" is not one of \"periodic\", \"wall\""},
        {"empty choice", "[field]\nsolver = \"\"\n", "",
         "case.toml:2:10: 'field.solver' = \"\" is not one of \"gmres\", \"newton_krylov\""},
        {"drift above the speed of light", beam + "drift_x = -1.5\n", "",
         "case.toml:7:11: 'species.beam.drift_x' = -1.5 is out of range; allowed: -1 ... 1 c"},
        {"massless species", beam + "mass = 0\n", "",
         "case.toml:7:8: 'species.beam.mass' = 0 is out of range; allowed: > 0 m_i"},
    });
}

TEST_CASE("every range that is listed by --help is enforced" * doctest::description("robust")) {
    CHECK(check_ranges() >= 40);
}

TEST_CASE("unknown and repeated keys are refused with the nearest name" *
          doctest::description("robust")) {
    check_refused({
        {"misspelled key", "[harris]\n\nparticels = 200\n", "",
         "case.toml:3:13: unknown parameter 'harris.particels'; did you mean 'harris.particles'?"},
        {"misspelled section", "[gird]\ncells_x = 64\n", "",
         "case.toml:2:11: unknown parameter 'gird.cells_x'; did you mean 'grid.cells_x'?"},
        {"key in the wrong section", "[plasma]\ntheta = 1\n", "",
         "case.toml:2:9: unknown parameter 'plasma.theta'; did you mean 'field.theta'?"},
        {"key without a section", "dt = 0.3\n", "",
         "case.toml:1:6: unknown parameter 'dt'; did you mean 'time.dt'?"},
        {"key with capitals", "[time]\nDT = 0.3\n", "",
         "case.toml:2:6: unknown parameter 'time.DT'; did you mean 'time.dt'?"},
        {"unlike all keys", "[weather]\nforecast = 1\n", "",
         "case.toml:2:12: unknown parameter 'weather.forecast'; --help lists all"},
        {"unknown empty section", "[weather]\n", brief, "case.toml:1:"},
        {"unknown empty table", "[time]\nweather = {}\n", brief, "case.toml:2:"},
        {"unknown key of a species", beam + "temperature = 1e-4\n", "",
         "case.toml:7:15: unknown parameter 'species.beam.temperature'; did you mean "
         "'species.beam.temperature_"},
        {"key of a species one level too deep", "[species.beam.hot]\ndensity = 1\n", "",
         "case.toml:2:11: unknown parameter 'species.beam.hot.density'; did you mean "
         "'species.beam.density'?"},
        {"species named with a space", "[species.\"hot beam\"]\ndensity = 1\n", "",
         "'hot beam' is not a name: use letters, digits and '_'"},
        {"species named with a digit first", "[species.2nd]\ndensity = 1\n", "",
         "case.toml:2:11: '2nd' cannot name an item"},
        {"species named with nothing", "[species.\"\"]\ndensity = 1\n", "",
         "case.toml:2:11: '' cannot name an item"},
        {"species named with an accent", "[species.\"\xc3\xa9lectrons\"]\ndensity = 1\n", "",
         "'\xc3\xa9lectrons' is not a name"},
        {"species named with a path", "[species.\"../../beam\"]\ndensity = 1\n", "",
         "'../../beam' is not a name: use letters, digits and '_'"},
        {"species named with a dot", "[species.\"a.b\"]\ndensity = 1\n", "", "'a.b' is not a name"},
        {"257 species", species(257), "",
         "case.toml:518:10: more than 256 items in [species]: take some out"},
        {"repeated key", "[time]\ndt = 0.3\ndt = 0.4\n", "", "case.toml:3:"},
        {"repeated section", "[time]\ndt = 0.3\n[time]\nend = 1\n", "", "case.toml:3:"},
        {"repeated species", beam + "[species.beam]\nmass = 2\n", "", "case.toml:7:"},
        {"repeated key in dots", "time.dt = 0.3\n[time]\ndt = 0.3\n", "", "case.toml:2:"},
        {"repeated key in quotes", "[time]\ndt = 0.3\n\"dt\" = 0.4\n", "", "case.toml:3:"},
        {"repeated key with a dot in quotes", "\"time.dt\" = 0.3\n[time]\ndt = 0.4\n", brief,
         "case.toml:"},
        {"repeated override", std::nullopt, "time.dt=0.1 time.dt=0.2 " + brief, "time.dt"},
    });
}

TEST_CASE("combinations that cannot run are refused with the numbers and the cure" *
          doctest::description("robust")) {
    const std::string light = uniform + "[theory]\nwave = \"light\"\n",
                      langmuir = uniform + "[theory]\nwave = \"langmuir\"\n",
                      transverse = uniform + "[theory]\nwave = \"transverse\"\n",
                      longitudinal = uniform + "[theory]\nwave = \"longitudinal\"\n",
                      electrons = "[species.electrons]\ncharge = -1\n";
    check_refused({
        {"too many steps", "[time]\ndt = 1e-9\nend = 2\n", "",
         "time.end / time.dt is 2e+09 steps, more than 1e9: raise time.dt or lower time.end"},
        {"infinitely many steps", "[time]\ndt = 1e-300\nend = 1e300\n", "",
         "time.end / time.dt is inf steps, more than 1e9: raise time.dt or lower time.end"},
        {"sheet between periodic ends", "[grid]\nboundary_z = \"periodic\"\n", "",
         "the Harris sheet needs grid.boundary_x = \"periodic\" and grid.boundary_z = \"wall\""},
        {"sheet with walls in x", "[grid]\nboundary_x = \"wall\"\n", "",
         "the Harris sheet needs grid.boundary_x = \"periodic\" and grid.boundary_z = \"wall\""},
        {"sheet on an odd mesh", "[grid]\ncells_z = 63\n", "",
         "grid.cells_z = 63 is odd: the flux is measured on the row z = 0, so make it even"},
        {"sheet thicker than the box", "[harris]\nthickness = 4\n", "",
         "harris.thickness = 4 d_i does not fit between walls 12.8 d_i apart: at most a quarter"},
        {"sheet faster than light", "[harris]\nlight_over_alfven = 2\n", "",
         "c (drift or three thermal speeds), and the mover is not relativistic: raise "
         "harris.light_over_alfven above "},
        {"sheet with species", "[species.beam]\ndensity = 1\n", "",
         "[species.beam] belongs to plasma.setup = \"uniform\"; the Harris sheet makes its own"},
        {"sheet with a theory of waves", "[theory]\nwave = \"light\"\n", "",
         "theory.wave = \"light\" needs plasma.setup = \"uniform\""},
        {"sheet without a field", "[harris]\nlight_over_alfven = 1e200\n", "",
         "harris.light_over_alfven"},
        {"sheet without ion temperature", "[harris]\ntemperature_ratio = 1e-320\n", "",
         "harris.temperature_ratio"},
        {"seeded fields between walls", "[plasma]\nsetup = \"uniform\"\n[uniform]\nwave_E_y = 1\n",
         "", "seeded fields need periodic boundaries: take out uniform.wave_E_*"},
        {"field through walls in x", beam + "[uniform]\nB_x = 0.1\n", "grid.boundary_x=wall",
         "uniform.B_x = 0.1 would cross the conducting walls normal to x: make it 0"},
        {"field through walls in z", beam + "[uniform]\nB_z = 0.1\n", "grid.boundary_z=wall",
         "uniform.B_z = 0.1 would cross the conducting walls normal to z: make it 0"},
        {"mode without a wave number", beam + "[uniform]\nmode_x = 0\n", "",
         "uniform.mode_x and uniform.mode_z are both 0: a mode needs a wave number"},
        {"mode shorter than two cells", beam + "[uniform]\nmode_x = 33\n", "",
         "the seeded mode (33, 0) has more than one wavelength per two cells: refine the mesh"},
        {"mode shorter than two cells in z", beam + "[uniform]\nmode_z = -33\n", "",
         "the seeded mode (1, -33) has more than one wavelength per two cells"},
        {"seeded B along the mode", uniform + "[uniform]\nwave_B_x = 1e-3\n", "",
         "the seeded B is not divergence-free: k . B must be 0, so keep uniform.wave_B across"},
        {"seeded E along the mode", uniform + "[uniform]\nwave_E_x = 1e-3\n", "",
         "the seeded E has a part along k: that part follows from the charge, so seed it with"},
        {"species drifts too fast", beam + "drift_x = 0.8\ndrift_z = 0.8\n", "",
         "species 'beam' has speeds of 1.131 c (drift or three thermal speeds), and the mover"},
        {"species too hot", beam + "temperature_y = 0.25\n", "",
         "species 'beam' has speeds of 1.5 c (drift or three thermal speeds), and the mover"},
        {"nothing at all", uniform, "",
         "an empty uniform plasma: add a [species.<name>] or seed a field with uniform.wave_E_y"},
        {"too few steps to measure", light + "[uniform]\nwave_E_y = 1\n", "time.end=2.9",
         "theory.wave needs at least 10 steps to measure: raise time.end above 3"},
        {"oblique mode with a theory", light + "[uniform]\nwave_E_y = 1\nmode_z = 1\n", "",
         "theory.wave needs a mode along x or along z: set uniform.mode_x or uniform.mode_z to 0"},
        {"light in a plasma", light + electrons, "",
         "theory.wave = \"light\" is a wave in vacuum: take out the species or choose "
         "\"transverse\""},
        {"Langmuir wave in vacuum", langmuir + "[uniform]\nwave_E_y = 1\n", "",
         "theory.wave = \"langmuir\" needs a [species.<name>]"},
        {"transverse wave in vacuum", transverse + "[uniform]\nwave_E_y = 1\n", "",
         "theory.wave = \"transverse\" needs a [species.<name>]"},
        {"warm Langmuir wave", langmuir + electrons + "temperature_x = 1e-4\n", "",
         "theory.wave = \"langmuir\" is exact for a cold plasma at rest, and species 'electrons' "
         "is warm or drifts: choose \"longitudinal\""},
        {"drifting Langmuir wave", langmuir + electrons + "drift_z = 0.1\n", "",
         "species 'electrons' is warm or drifts: choose \"longitudinal\""},
        {"Langmuir wave without charge", langmuir + electrons + "wave_x = 1e-5\n",
         "species.electrons.charge=0 time.end=3 grid.cells_x=4 grid.cells_z=4 --quiet",
         "theory.wave"},
        {"Langmuir wave across B", langmuir + electrons + "[uniform]\nB_z = 0.1\n", "",
         "the dispersion relation is solved for B along k or zero"},
        {"longitudinal wave across B", longitudinal + electrons + "[uniform]\nB_z = 0.1\n", "",
         "the dispersion relation is solved for B along k or zero: take out the part of uniform.B "
         "across the mode, or theory.wave"},
        {"transverse wave across B",
         transverse + electrons + "[uniform]\nB_x = 0.1\nmode_x = 0\nmode_z = 1\n", "",
         "the dispersion relation is solved for B along k or zero"},
        {"no such root", longitudinal + electrons, "theory.near=1e10",
         "no root of the longitudinal dispersion relation was found near 1e+10: change "
         "theory.near, or set theory.wave = \"none\""},
        {"more particles than memory", beam,
         "uniform.particles_per_cell=1e6 grid.cells_x=4096 grid.cells_z=4096", "memory"},
    });
}

TEST_CASE("wrong command lines are refused with the cure" * doctest::description("robust")) {
    const std::string threads = "--threads takes a whole number from 1 to 1024, not ";
    check_refused({
        {"missing case", std::nullopt, "nowhere.toml", "nowhere.toml: there is no such file"},
        {"missing folder of a case", std::nullopt, "nowhere/case.toml",
         "nowhere/case.toml: there is no such file"},
        {"case below a file", std::nullopt, "a_file/case.toml", "a_file/case.toml: "},
        {"folder as case", std::nullopt, "foreign", "foreign: is a folder, not a file"},
        {"device as case", std::nullopt, "/dev/null", "/dev/null: is not a regular file"},
        {"file of unknown size as case", std::nullopt, "/proc/version " + brief, "/proc/version:"},
        {"other text as case", std::nullopt, "a_file", "a_file:1:5: "},
        {"program as case", std::nullopt, "'"s + program().string() + "'",
         "a control character; this is not a text file, or it is damaged"},
        {"long name of a case", std::nullopt, repeated("x", 300), ": there is no such file"},
        {"empty name of a case", std::nullopt, "'' " + brief, "file"},
        {"two cases", "", "other.toml",
         "two case files, 'case.toml' and 'other.toml': give one (overrides are written "
         "section.key=value)"},
        {"unknown option", std::nullopt, "--frobnicate",
         "unknown option '--frobnicate'; --help lists all options"},
        {"misspelled option", std::nullopt, "--dry_run",
         "unknown option '--dry_run'; did you mean '--dry-run'?"},
        {"unknown short option", std::nullopt, "-x", "unknown option '-x'"},
        {"value for a switch", std::nullopt, "--quiet=yes", "'--quiet' takes no value"},
        {"out without a value", std::nullopt, "--out", "--out needs a value: --out PATH"},
        {"out before an option", std::nullopt, "--out --quiet", "--out needs a value: --out PATH"},
        {"out with nothing", std::nullopt, "--out=", "--out needs a path that is not empty"},
        {"out with an empty word", std::nullopt, "--out ''",
         "--out needs a path that is not empty"},
        {"restart without a value", std::nullopt, "--restart", "--restart needs a value"},
        {"threads without a value", std::nullopt, "--threads",
         "--threads needs a value: --threads 2"},
        {"no threads", std::nullopt, "--threads 0", threads + "'0'"},
        {"negative threads", std::nullopt, "--threads -1", threads + "'-1'"},
        {"threads in words", std::nullopt, "--threads x", threads + "'x'"},
        {"half a thread", std::nullopt, "--threads=0.5", threads + "'0.5'"},
        {"threads with nothing", std::nullopt, "--threads=", threads + "''"},
        {"endless threads", std::nullopt, "--threads 99999999999999999999",
         threads + "'99999999999999999999'"},
        {"override without equals sign", std::nullopt, "time.dt", "time.dt: there is no such file"},
        {"override with spaces", "", "time.dt = 0.1", "two case files, 'case.toml' and 'time.dt'"},
        {"override without a name", std::nullopt, "=0.1",
         "command line: '=0.1': write section.key=value"},
        {"override without a value", std::nullopt, "time.dt=", "command line: 'time.dt=': "},
        {"override of two lines", std::nullopt, "\"$(printf 'time.dt=0.1\\ntime.end=3')\"",
         "one line, one value"},
        {"override with invalid UTF-8", std::nullopt, "\"$(printf 'plasma.setup=\\377')\"",
         "not UTF-8 text"},
        {"override of an unknown key", std::nullopt, "tiem.dt=0.1",
         "command line: 'tiem.dt=0.1': unknown parameter 'tiem.dt'; did you mean 'time.dt'?"},
        {"override of a section", std::nullopt, "grid=64", "unknown parameter 'grid'"},
        {"override out of range", std::nullopt, "field.theta=0.2",
         "command line: 'field.theta=0.2': 'field.theta' = 0.2 is out of range; allowed: 0.5 ..."},
        {"override that is not finite", std::nullopt, "time.dt=nan",
         "command line: 'time.dt=nan': 'time.dt' must be finite, not nan"},
        {"override with a word for a number", std::nullopt, "time.dt=fast",
         "command line: 'time.dt=fast': "},
        {"override with a list", std::nullopt, "time.dt=[1]", "'time.dt' is a list or a date"},
        {"override with an unknown choice", std::nullopt, "plasma.setup=haris",
         "'plasma.setup' = \"haris\" is not one of \"harris\", \"uniform\""},
        {"override with a fraction", std::nullopt, "grid.cells_x=64.5",
         "'grid.cells_x' takes a whole number, not 64.5"},
        {"override of an unknown key of a species", beam, "species.beam.denisty=2",
         "unknown parameter 'species.beam.denisty'; did you mean 'species.beam.density'?"},
    });
}

TEST_CASE("wrong output folders are refused and left as they are" *
          doctest::description("robust")) {
    const std::string earlier = "holds an earlier run; --force replaces it, --out DIR puts the";
    check_refused({
        {"file as output folder", "", "--out a_file " + brief,
         "a_file: is a file, and the results need a folder; choose another --out"},
        {"case as output folder", "", "--out case.toml " + brief, "case.toml: is a file"},
        {"device as output folder", "", "--out /dev/null " + brief, "/dev/null: is a file"},
        {"output folder below a file", "", "--out a_file/run " + brief,
         "a_file/run: cannot be created: Not a directory; choose another --out"},
        {"output folder in a foreign place", "", "--out /proc/nowhere/run " + brief,
         "/proc/nowhere/run: cannot be created: "},
        {"output folder with a long name", "", "--out " + repeated("x", 300) + " " + brief,
         ": cannot be created: File name too long; choose another --out"},
        {"output folder behind a dangling link", "", "--out dangling " + brief,
         "dangling: cannot be created: "},
        {"foreign output folder", "", "--out foreign " + brief,
         "foreign: is not empty; --force replaces it, --out DIR puts the results elsewhere"},
        {"earlier output folder", "", "--out earlier " + brief, "earlier: " + earlier},
        {"same output folder by another name", "", "--out foreign/../earlier " + brief,
         "foreign/../earlier: " + earlier},
        {"current folder as output folder", "", "--out . " + brief, "--force replaces it"},
        {"folder above as output folder", "", "--out .. " + brief, "..: is not empty; --force"},
    });
}

TEST_CASE("what must not be read or written is refused" * doctest::description("robust")) {
    // The superuser may read and write everything, and gives that up.
    const std::string before = geteuid() == 0 ? "setpriv --bounding-set=-all --inh-caps=-all" : "";
    const fs::path folder = fresh_folder("rights");
    write_all(folder / "closed.toml", "");
    const auto check = [&](const std::string& name, fs::perms rights, const Row& row) {
        fs::permissions(folder / name, rights);
        check_refusal(folder, row, before);
        fs::permissions(folder / name, fs::perms::owner_all);
    };
    using fs::perms;
    check("closed.toml", perms::none,
          {"unreadable case", std::nullopt, "closed.toml " + brief,
           "closed.toml: cannot be read: Permission denied"});
    check("foreign", perms::none,
          {"case in a closed folder", std::nullopt, "foreign/case.toml " + brief,
           "foreign/case.toml: "});
    fs::create_directory(folder / "sealed");
    check("sealed", perms::owner_read | perms::owner_exec,
          {"sealed output folder", std::nullopt, "--out sealed " + brief, "Permission denied"});
    check("sealed", perms::owner_read | perms::owner_exec,
          {"output folder in a sealed one", std::nullopt, "--out sealed/run " + brief,
           "sealed/run: cannot be created: Permission denied; choose another --out"});
    check("earlier", perms::owner_write | perms::owner_exec,
          {"output folder that cannot be listed", std::nullopt, "--out earlier " + brief,
           "earlier: "});
}

TEST_CASE("wrong restarts are refused with the reason" * doctest::description("robust")) {
    const fs::path folder = fresh_folder("restarts");
    REQUIRE(start(folder,
                  "time.end=3 harris.particles=2 grid.cells_x=4 grid.cells_z=4 --quiet "
                  "output.checkpoint_steps=10 --out run")
                .status == 0);
    const std::string good = read_all(folder / "run/checkpoint_0000000010.bin");
    REQUIRE(good.size() > 1000);
    std::string damaged = good, foreign = good;
    damaged[good.size() / 2] ^= 1;
    foreign[0] ^= 1;
    const Files files{{"good.bin", good},
                      {"damaged.bin", damaged},
                      {"foreign.bin", foreign},
                      {"long.bin", good + "."},
                      {"cut.bin", good.substr(0, good.size() / 2)},
                      {"stub.bin", good.substr(0, 10)},
                      {"empty.bin", ""}};
    check_refused(
        {
            {"missing checkpoint", std::nullopt, "--restart nowhere.bin",
             "nowhere.bin: there is no such file"},
            {"folder as checkpoint", std::nullopt, "--restart earlier",
             "earlier: is a folder, not a file"},
            {"text as checkpoint", std::nullopt, "--restart a_file", "a_file: is not a checkpoint"},
            {"empty checkpoint", std::nullopt, "--restart empty.bin",
             "empty.bin: is not a checkpoint"},
            {"stub of a checkpoint", std::nullopt, "--restart stub.bin",
             "stub.bin: is not a checkpoint"},
            {"foreign checkpoint", std::nullopt, "--restart foreign.bin",
             "foreign.bin: is not a checkpoint"},
            {"cut off checkpoint", std::nullopt, "--restart cut.bin",
             "cut.bin: the checkpoint is cut off or too long; use an earlier one"},
            {"too long a checkpoint", std::nullopt, "--restart long.bin",
             "long.bin: the checkpoint is cut off or too long; use an earlier one"},
            {"damaged checkpoint", std::nullopt, "--restart damaged.bin",
             "damaged.bin: the checkpoint is damaged (its checksum is wrong); use an earlier one"},
            {"restart with a case", "", "--restart good.bin",
             "--restart takes its case from the checkpoint: leave out 'case.toml'"},
            {"restart with another time step", std::nullopt, "--restart good.bin time.dt=0.1",
             "command line: 'time.dt=0.1': 'time.dt' cannot change on a restart; start a new run"},
            {"restart with an unknown key", std::nullopt, "--restart good.bin output.vkt=true",
             "unknown parameter 'output.vkt'; did you mean 'output.vtk'?"},
            {"restart into an earlier run", std::nullopt, "--restart good.bin --out earlier",
             "earlier: holds an earlier run; --force replaces it"},
            {"restart beyond its end", std::nullopt, "--restart good.bin time.end=1 --out run",
             "time.end"},
        },
        files);
}

TEST_CASE("force replaces an earlier run and leaves other files alone" *
          doctest::description("robust")) {
    const fs::path folder = fresh_folder("force");
    const Files mine{{"notes.txt", "a"}, {"fields_of_wheat.txt", "b"}, {"thesis.partial", "c"}};
    for (const auto& [name, bytes] : mine) write_all(folder / "earlier" / name, bytes);
    CHECK(start(folder, "--out earlier --force " + brief).status == 0);
    CHECK(read_all(folder / "earlier/summary.json").size() > 10);
    for (const auto& one : mine) {
        INFO(one.first);
        CHECK(read_all(folder / "earlier" / one.first) == one.second);
    }
}

TEST_CASE("unusual but right input is accepted" * doctest::description("robust")) {
    const std::string gem = check_described("default case", "", "").out;
    CHECK(holds(gem, "200000, 48.83 per cell"));
    for (const auto& one : Files{{"comments only", "# nothing\n\n   \t# but words\n"},
                                 {"mark of UTF-8", "\xef\xbb\xbf[time]\ndt = 0.3\n"},
                                 {"lines of another system", "[time]\r\ndt = 0.3\r\n"},
                                 {"no line break at the end", "[time]\ndt = 0.3"},
                                 {"umlauts in a comment",
                                  "# Gr\xc3\xb6\xc3\x9f"
                                  "e \xf0\x9f\x8c\x8a\n"},
                                 {"dots in a key", "time.dt = 0.3\ntime . end = 800\n"},
                                 {"whole number for a number", "[time]\nend = 800\n"},
                                 {"number for a whole number", "[harris]\nparticles = 2e5\n"},
                                 {"groups of digits", "[harris]\nparticles = 200_000\n"},
                                 {"hexadecimal number", "[grid]\ncells_x = 0x40\n"}}) {
        INFO(one.first);
        CHECK(check_described(one.first, one.second, "").out == gem);
    }
    CHECK(holds(check_described("1e5 particles", "[harris]\nparticles = 1e5\n", "").out,
                " 100000, 24.41 per cell"));
    CHECK(holds(check_described("1e5 in an override", "", "harris.particles=1e5").out,
                " 100000, 24.41 per cell"));
    CHECK(holds(check_described("64 species", species(64), "").out, "  s63 "));
    CHECK(holds(check_described("species by an override", uniform, "species.beam.mass=2").out,
                "  beam "));
    CHECK(holds(check_described("quotes in an override", beam, "'plasma.setup=\"uniform\"'").out,
                "  beam "));
    CHECK(holds(check_described("species of defaults", uniform + "[species.ions]\n", "").out,
                "  ions "));
    CHECK(holds(check_described("two species of defaults", beam + "[species.ions]\n", "").out,
                "  ions "));
}

TEST_CASE("a right case ends with status 0 however short" * doctest::description("robust")) {
    for (const auto& one :
         Files{{"no step", "time.end=0"},
               {"one step", "time.end=0.3"},
               {"no step of another sheet", "time.end=0 harris.thickness=0.6"},
               {"one step of another sheet", "time.end=0.3 harris.thickness=0.6"}}) {
        const Outcome outcome =
            start(fresh_folder(one.first),
                  one.second + " harris.particles=2 grid.cells_x=4 grid.cells_z=4 --quiet");
        INFO(one.first << ": " << outcome.err);
        CHECK(outcome.status == 0);
        CHECK(outcome.sentences.empty());
    }
}

TEST_CASE("a plasma without any energy runs or is refused" * doctest::description("robust")) {
    const fs::path folder = fresh_folder("at rest");
    write_all(folder / "case.toml", beam + "[species.ions]\ncharge = 1\n");
    const Outcome outcome = start(folder, "case.toml time.end=3 grid.cells_x=4 grid.cells_z=4");
    INFO(outcome.err);
    CHECK((outcome.status == 0 || outcome.status == 2));
    CHECK(fs::exists(folder / "out") == (outcome.status == 0));
}

TEST_CASE("every shipped case passes a dry run" * doctest::description("robust")) {
    const auto mine = [](const std::string& name) { return !holds(name, "explicit"); };
    CHECK(check_shipped_cases("implicit_moment", mine) >= 11);
}

TEST_CASE("help lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    auto units = check_help("time.end = 0\n",
                            "plasma.setup=uniform grid.boundary_z=periodic "
                            "species.beam.drift_x=0.1 uniform.particles_per_cell=1");
    CHECK(units["grid.length_x"] == "d_i");
    CHECK(units["time.dt"] == "1/omega_pi");
    CHECK(units["uniform.B_x"] == "m_i c omega_pi/e");
    CHECK(units["uniform.phase_E_y"] == "degree");
    CHECK(units["mover.tolerance"] == "cell");
    CHECK(units["output.fields_interval"] == "1/omega_pi");
    CHECK(units["species.<name>.density"] == "n0");
    CHECK(units["species.<name>.mass"] == "m_i");
    CHECK(units["species.<name>.drift_x"] == "c");
}

TEST_CASE("the version is that of the Makefile" * doctest::description("robust")) {
    check_version();
}

TEST_CASE("a dry run shows scales and memory and time and writes nothing" *
          doctest::description("robust")) {
    const std::string out = check_described("dry run", "", "--out run --threads 2").out;
    check_lines(out,
                {R"(  mesh +64 x 64 cells of 0\.4 x 0\.2 d_i, periodic in x, wall in z)",
                 R"(  steps +2667 of 0\.3 / omega_pi, c dt/dx = 0\.75, c dt/dz = 1\.5)",
                 R"(  particles +200000, 48\.83 per cell)",
                 R"(  magnetic field +0\.05 m_i c omega_pi/e, Omega_ci dt = 0\.015)",
                 R"(  ions +omega_p dt = 0\.3, Omega_c dt = 0\.015, v_th = 0\.03227 c, .*)",
                 R"(  electrons +omega_p dt = 1\.5, Omega_c dt = 0\.375, v_th = 0\.07217 c, .*)",
                 R"(  memory +about [0-9.e+]+ [KMG]iB.*)", R"(  time +about [0-9.e+-]+ .*)"});
    CHECK(check_described("quiet dry run", "", "--quiet").out.empty());
}

TEST_CASE("what may mislead is a warning with the number and the limit" *
          doctest::description("robust")) {
    check_warnings("no warning", "", "", {});
    // v_e = (25/6 B0^2/2)^(1/2) = 0.0722, dz = 0.2.
    check_warnings(
        "closure", "", "time.dt=3",
        {"warning: electrons: v_th dt/dx = 1.083 is above 1, where the moment closure fails "
         "[IMM-13]: lower time.dt to 2.771\n"});
    check_warnings(
        "closure and gyration", "", "time.dt=30",
        {"warning: ions: v_th dt/dx = 4.841 is above 1", "lower time.dt to 6.197\n",
         "warning: electrons: Omega_c dt = 37.5 is above 2 pi, gyration is not followed\n"});
    check_warnings(
        "finite grid", "", "grid.cells_x=4 grid.cells_z=4",
        {"warning: electrons: v_th dt/dx = 0.006766 is below 0.05 and the Debye length is "
         "0.004511 cells: finite-grid heating is possible, watch the energy\n"});
}
