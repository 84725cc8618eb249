// What every program makes of a case file, a command line and a folder for its results: one
// sentence with place and cure for what is wrong, status 2, and nothing written; and what is
// listed, described and accepted.
#include <doctest/doctest.h>
#include <unistd.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/any_program.hpp"

using namespace facts;
using namespace std::string_literals;

namespace {

std::string replaced(const std::string& text, const std::string& word, const std::string& by) {
    std::string result = text;
    for (std::size_t at = result.find(word); at != std::string::npos;
         at = result.find(word, at + by.size()))
        result.replace(at, word.size(), by);
    return result;
}

// A text with a program's own words for CHOICE, ITEM, KEY and PROGRAM; COLUMN is that of a value of
// CHOICE, PLACE that of a value of KEY.
std::string of(const Program& program, const std::string& text) {
    std::string result = text;
    for (const auto& [word, by] :
         {std::pair{"COLUMN", std::to_string(program.choice.size() + 4)},
          {"PLACE", "case.toml:2:" + std::to_string(program.key.size() + 4)},
          {"CHOICE", program.choice},
          {"ITEM", program.item},
          {"KEY", program.key},
          {"PROGRAM", path_of(program).string()}})
        result = replaced(result, word, by);
    return result;
}

// What is refused and the sentence that refuses it, for every program.
using Refused = std::vector<std::pair<std::string, std::string>>;
Refused rows_in(const std::string& table) {
    Refused rows;
    for (const std::string& line : lines_in(table)) {
        const std::size_t arrow = line.find(" -> ");
        REQUIRE(arrow != std::string::npos);
        rows.emplace_back(line.substr(0, arrow), line.substr(arrow + 4));
    }
    return rows;
}

// Texts of a case; in a table, " | " stands for the end of a line.
void check_texts(const Refused& rows) {
    for (const Program& program : every_program())
        for (const auto& [text, sentence] : rows) {
            const fs::path folder = fresh_folder(program);
            write_all(folder / "case.toml", of(program, text));
            check_refusal(program, folder, "case.toml", of(program, sentence));
        }
}
void check_texts(const std::string& table) {
    Refused rows = rows_in(table);
    for (auto& row : rows) row.first = replaced(row.first, " | ", "\n") + "\n";
    check_texts(rows);
}

// Command lines, in a folder with a short case.
void check_command_lines(const Refused& rows) {
    for (const Program& program : every_program())
        for (const auto& [arguments, sentence] : rows) {
            const fs::path folder = fresh_folder(program);
            write_all(folder / "case.toml", program.short_case);
            check_refusal(program, folder, of(program, arguments), of(program, sentence));
        }
}
void check_command_lines(const std::string& table) { check_command_lines(rows_in(table)); }

std::vector<Parameter> listed(const Program& program) {
    return listed_in(start(program, fresh_folder(program), "--help").out);
}

// A case with many items.
std::string items(const Program& program, int count) {
    std::string text;
    for (int k = 0; k < count; ++k)
        text += of(program, "[ITEM.s" + std::to_string(k) + "]\nKEY = 1\n");
    return text;
}

}  // namespace

TEST_CASE("damaged text of a case file is refused with its place" *
          doctest::description("robust")) {
    const std::string not_text = ": not UTF-8 text", control = ": a control character";
    // Invalid, Latin-1, too long a form, a surrogate, cut off; UTF-16 with its mark and without;
    // NUL, escape, delete, a lone carriage return; names and values that are nested without end.
    check_texts(
        {{"[time]\nend = 0.3 # \xff\n", "case.toml:2:13: not UTF-8 text; save the file as UTF-8"},
         {"# caf\xe9\n", "case.toml:1:6" + not_text},
         {"# \xc0\xaf\n", "case.toml:1:3" + not_text},
         {"# \xed\xa0\x80\n", "case.toml:1:3" + not_text},
         {"# \xe2\x82", "case.toml:1:3" + not_text},
         {"\xff\xfe[\0t\0"s, "case.toml:1:1" + not_text},
         {"[\0t\0i\0m\0e\0]\0"s, "case.toml:1:2" + control},
         {"[time]\nend = \0000.3\n"s, "case.toml:2:7" + control},
         {"[time]\n# \x1b[31m\n", "case.toml:2:3" + control},
         {"#\x7f\n", "case.toml:1:2" + control},
         {"[time]\rend = 0.3\n", "case.toml:1:7" + control},
         {"a = "s + repeated("[", 10000), "case.toml:1:"},
         {"a = "s + repeated("{a = ", 10000), "case.toml:1:"},
         {repeated("a.", 100000) + "a = 1\n", "case.toml:1:"},
         {"["s + repeated("a.", 100000) + "a]\n", "case.toml:1:"}});
    // Without an end, a value, an equals sign, a key; with two values, a comma, capitals, without
    // quotes; escapes that are none, and such that stand for what no word may hold.
    check_texts(R"(
CHOICE = "none -> case.toml:1:
CHOICE = """none -> case.toml:1:
[time] | end = [0.3 -> case.toml:2:
[time | end = 0.3 -> case.toml:1:
[time] | end = -> case.toml:2:
[time] | end 0.3 -> case.toml:2:5:
[time] | = 0.3 -> case.toml:2:1:
[time] | end = 0.3 0.4 -> case.toml:2:11:
[time] | end = 0,3 -> case.toml:2:8:
[output] | vtk = True -> case.toml:2:7:
CHOICE = harris -> could not determine value type; text stands in quotes
CHOICE = "no\qne" -> case.toml:1:
CHOICE = "no\nne" -> case.toml:1:COLUMN: 'CHOICE' holds a control character
CHOICE = "no\u0000ne" -> case.toml:1:COLUMN: 'CHOICE' holds a control character
CHOICE = "\u001b[31mnone" -> case.toml:1:COLUMN: 'CHOICE' holds a control character
[time] | "e\nnd" = 0.3 -> case.toml:2:
)");
}

TEST_CASE("values of a wrong type are refused with the type that is wanted" *
          doctest::description("robust")) {
    check_texts(R"(
[time] | end = "0.3" -> case.toml:2:7: 'time.end' takes a number, not text
[time] | end = true -> case.toml:2:7: 'time.end' takes a number, not true or false
[grid] | cells_x = "64" -> case.toml:2:11: 'grid.cells_x' takes a whole number, not text
[grid] | cells_x = true -> case.toml:2:11: 'grid.cells_x' takes a whole number, not true or false
[grid] | cells_x = 64.5 -> case.toml:2:11: 'grid.cells_x' takes a whole number, not 64.5
[output] | vtk = 1 -> case.toml:2:7: 'output.vtk' takes true or false, not a whole number
[output] | vtk = "true" -> case.toml:2:7: 'output.vtk' takes true or false, not text
CHOICE = 1 -> case.toml:1:COLUMN: 'CHOICE' takes text, one of "
CHOICE = 1 -> ", not a whole number
CHOICE = false -> ", not true or false
[time] | end = [1, 2] -> :7: 'time.end' is a list or a date; parameters are numbers, text, true
[time] | end = [] -> case.toml:2:7: 'time.end' is a list
[time] | end = 2026-11-21 -> case.toml:2:7: 'time.end' is a list or a date
[time] | end = 07:32:00 -> case.toml:2:7: 'time.end' is a list or a date
[[ITEM]] | KEY = 1 -> case.toml:1:1: 'ITEM' is a list or a date
grid = 64 -> case.toml:1:8: unknown parameter 'grid'
[time.end] | value = 0.3 -> case.toml:2:9: unknown parameter 'time.end.value'
[time] | end = {value = 0.3} -> case.toml:2:16: unknown parameter 'time.end.value'
[time.end] -> case.toml:1:
[time] | end = {} -> case.toml:2:7:
ITEM = 2 -> unknown parameter 'ITEM'
[ITEM] | beam = 2 -> case.toml:2:8: 'ITEM.beam' needs the name of an item: write [ITEM.<name>] above
[ITEM] | KEY = 1 -> PLACE: 'ITEM.KEY' needs the name of an item: write [ITEM.<name>] above
)");
    // Text that is free, which only grains have.
    const std::string grain = "[grain.a]\n", longest(901, '1');
    for (const Program* program : programs_called("grains"))
        check_refused(*program,
                      {{"number", grain + "material = 3\n", "",
                        "case.toml:2:12: 'grain.a.material' takes text, not a whole number"},
                       {"list", grain + "vertices = [0, 1]\n", "", "case.toml:2:"},
                       {"control character", grain + "material = \"a\\u001Bb\"\n", "",
                        "'grain.a.material' holds a control character; write plain text"},
                       {"long text", grain + "vertices = \"" + longest + "\"\n", "",
                        "'grain.a.vertices' has 901 letters; write at most 900 (polygon: "},
                       {"long override", grain, "grain.a.vertices='" + longest + "'",
                        "has 901 letters; write at most 900"},
                       {"open quotes", grain, "grain.a.material=a\\'b",
                        "command line: 'grain.a.material=a'b': "},
                       {"not UTF-8", grain + "material = \"\xff\"\n", "", "case.toml:2:"}});
}

TEST_CASE("values out of range are refused with the range" * doctest::description("robust")) {
    check_texts(R"(
[grid] | cells_x = -64 -> case.toml:2:11: 'grid.cells_x' = -64 is out of range; allowed:
[grid] | cells_x = 1 -> case.toml:2:11: 'grid.cells_x' = 1 is out of range; allowed:
[grid] | length_x = 0 -> case.toml:2:12: 'grid.length_x' = 0 is out of range; allowed: > 0
[grid] | length_x = -0.0 -> case.toml:2:12: 'grid.length_x' = -0 is out of range; allowed: > 0
[time] | end = -1 -> case.toml:2:7: 'time.end' = -1 is out of range; allowed: >= 0
[time] | end = nan -> case.toml:2:7: 'time.end' must be finite, not nan
[time] | end = inf -> case.toml:2:7: 'time.end' must be finite, not inf
[grid] | length_x = -inf -> case.toml:2:12: 'grid.length_x' must be finite, not -inf
[grid] | cells_x = nan -> case.toml:2:11: 'grid.cells_x' must be finite, not nan
[grid] | cells_x = +inf -> case.toml:2:11: 'grid.cells_x' must be finite, not inf
[time] | end = 1e400 -> '1e400' could not be interpreted as a value
[grid] | cells_x = 99999999999999999999 -> '99999999999999999999' is not representable in 64 bits
[grid] | cells_x = 9223372036854775807 -> is out of range; allowed:
CHOICE = "haris" -> case.toml:1:COLUMN: 'CHOICE' = "haris" is not one of "
CHOICE = "None" -> case.toml:1:COLUMN: 'CHOICE' = "None" is not one of "
CHOICE = "" -> case.toml:1:COLUMN: 'CHOICE' = "" is not one of "
)");
}

TEST_CASE("every range and every choice that is listed by --help is enforced" *
          doctest::description("robust")) {
    const std::regex above(R"((>=?) (\S+))"), between(R"((\S+) \.\.\. (\S+))");
    for (const Program& program : every_program()) {
        int ranges = 0;
        for (const Parameter& p : listed(program)) {
            const std::string name = replaced(p.name, "<name>", "beam");
            std::vector<double> outside;
            std::smatch ends;
            std::string message =
                " is out of range; allowed: " + p.range + (p.unit.empty() ? "" : " " + p.unit);
            std::vector<std::string> wrong;
            if (p.range == "true | false") {
                wrong = {"7"}, message = "' takes true or false, not a whole number";
            } else if (holds(p.range, " | ")) {
                wrong = {"haris"};
                message =
                    "= \"haris\" is not one of \"" + replaced(p.range, " | ", "\", \"") + "\"";
            } else if (std::regex_match(p.range, ends, above)) {
                outside = {std::stod(ends[2]) - (ends[1] == ">" ? 0 : 1)};
            } else if (std::regex_match(p.range, ends, between)) {
                outside = {std::stod(ends[1]) - 1, 2 * std::stod(ends[2]) + 1};
            }
            for (const double value : outside) wrong.push_back(std::to_string(value));
            for (const std::string& value : wrong)
                check_refused(program, {{p.name, {}, name + "=" + value, message}});
            ranges += int(outside.size());
        }
        INFO(program.name);
        CHECK(ranges >= 40);
    }
}

TEST_CASE("unknown and repeated keys are refused with the nearest name" *
          doctest::description("robust")) {
    check_texts(R"(
[grid] |  | lenght_x = 2 -> :3:12: unknown parameter 'grid.lenght_x'; did you mean 'grid.length_x'?
[gird] | cells_x = 64 -> :2:11: unknown parameter 'gird.cells_x'; did you mean 'grid.cells_x'?
[output] | cells_x = 1 -> :11: unknown parameter 'output.cells_x'; did you mean 'grid.cells_x'?
cells_x = 3 -> case.toml:1:11: unknown parameter 'cells_x'; did you mean 'grid.cells_x'?
[output] | VTK = true -> :2:7: unknown parameter 'output.VTK'; did you mean 'output.vtk'?
[grid] | cells = 100 -> unknown parameter 'grid.cells'; did you mean 'grid.cells_
[weather] | forecast = 1 -> :2:12: unknown parameter 'weather.forecast'; --help lists all; is the case one of this program?
[weather] -> case.toml:1:1: unknown section [weather]
[time] | weather = {} -> case.toml:2:
[ITEM.beam] | KEY_ = 1 -> unknown parameter 'ITEM.beam.KEY_'; did you mean 'ITEM.beam.KEY'?
[ITEM.beam.hot] | KEY = 1 -> PLACE: unknown parameter 'ITEM.beam.hot.KEY'; did you mean '
[ITEM."hot beam"] | KEY = 1 -> 'hot beam' is not a name: use letters, digits and '_'
[ITEM.2nd] | KEY = 1 -> PLACE: '2nd' cannot name an item: use letters, digits and '_', a letter first
[ITEM.""] | KEY = 1 -> PLACE: '' cannot name an item
[ITEM."électrons"] | KEY = 1 -> 'électrons' is not a name
[ITEM."../../beam"] | KEY = 1 -> '../../beam' is not a name: use letters, digits and '_'
[ITEM."a.b"] | KEY = 1 -> 'a.b' is not a name
[time] | end = 0.3 | end = 0.4 -> case.toml:3:
[time] | end = 0.3 | [time] | end = 1 -> case.toml:3:
[ITEM.beam] | KEY = 1 | [ITEM.beam] | KEY = 2 -> case.toml:3:
time.end = 0.3 | [time] | end = 0.3 -> case.toml:2:
[time] | end = 0.3 | "end" = 0.4 -> case.toml:3:
"time.end" = 0.3 | [time] | end = 0.4 -> case.toml:
)");
    for (const Program& program : every_program())
        check_refused(program, {{"257 items", items(program, 257), "",
                                 of(program, "more than 256 items in [ITEM]: take some out")}});
}

TEST_CASE("a key that was renamed is refused with its new name" * doctest::description("robust")) {
    // Earlier and new names, in a case file and on the command line; then sections.
    for (const Command& command : commands(R"(
cic
    walls.x_low boundary.x_low
    walls.potential_x_high boundary.potential_x_high
fluids
    flip.most_iterations flip.max_iterations
    rezone.fewest rezone.min_particles
    rezone.most rezone.max_particles
grains
    mesh.cells_x grid.cells_x
    mesh.origin_x grid.low_x
    mesh.origin_y grid.low_y
    mesh.periodic_x grid.periodic_x
    walls.y_low boundary.y_low
    walls.friction boundary.friction
mpm_implicit
    solver.most_iterations solver.max_iterations
    solver.most_loops solver.max_outer_iterations
)")) {
        const Program& program = *command.program;
        for (const std::string& line : command.expected) {
            const std::string before = words_in(line)[0], now = words_in(line)[1],
                              sentence = ": '" + before + "' has a new name: write '" + now + "'",
                              column = std::to_string(before.size() + 4);
            check_refused(program,
                          {{"file", before + " = 1\n", "", "case.toml:1:" + column + sentence},
                           {"override", program.short_case, before + "=1",
                            "command line: '" + before + "=1'" + sentence}});
            // The new name is one, and the earlier one is none.
            const auto is_listed = [&](const std::string& name) {
                const std::vector<Parameter> all = listed(program);
                return std::any_of(all.begin(), all.end(),
                                   [&](const Parameter& one) { return one.name == name; });
            };
            CHECK(is_listed(now));
            CHECK(!is_listed(before));
        }
    }
    for (const Command& command : commands("cic [walls] -> [boundary]\ngrains [mesh] -> [grid]\n"
                                           "grains [walls] -> [boundary]")) {
        const std::string before = words_in(command.words)[0];
        check_refused(*command.program, {{"section", before + "\n", "",
                                          "case.toml:1:1: " + before + " has a new name: write " +
                                              command.expected[0]}});
    }
}

TEST_CASE("wrong command lines are refused with the cure" * doctest::description("robust")) {
    check_command_lines(R"(
nowhere.toml -> nowhere.toml: there is no such file
nowhere/case.toml -> nowhere/case.toml: there is no such file
a_file/case.toml -> a_file/case.toml:
foreign -> foreign: is a folder, not a file
/dev/null -> /dev/null: is not a regular file
/proc/version -> /proc/version:
a_file -> a_file:1:5:
PROGRAM -> a control character; this is not a text file, or it is damaged
'' -> an empty argument: give the path of a case file, or leave it out
case.toml other.toml -> two case files, 'case.toml' and 'other.toml': give one (overrides are
--frobnicate -> unknown option '--frobnicate'; --help lists all options
--dry_run -> unknown option '--dry_run'; did you mean '--dry-run'?
-x -> unknown option '-x'
--quiet=yes -> '--quiet' takes no value
--out -> --out needs a value: --out PATH
--out --quiet -> --out needs a value: --out PATH
--out= -> --out needs a path that is not empty
--out '' -> --out needs a path that is not empty
--restart -> --restart needs a value
--threads -> --threads needs a value: --threads 2
--threads 0 -> --threads takes a whole number from 1 to 1024, not '0'
--threads -1 -> --threads takes a whole number from 1 to 1024, not '-1'
--threads x -> --threads takes a whole number from 1 to 1024, not 'x'
--threads=0.5 -> --threads takes a whole number from 1 to 1024, not '0.5'
--threads= -> --threads takes a whole number from 1 to 1024, not ''
--refine 0 -> --refine takes a whole number from 1 to 10, not '0'
--refine 11 -> --refine takes a whole number from 1 to 10, not '11'
--threads 99999999999999999999 -> from 1 to 1024, not '99999999999999999999'
--threads 1 case.toml --threads=2 -> --threads is given twice; keep one of them
--out a --out b -> --out is given twice; keep one of them
time.end -> time.end: there is no such file
case.toml time.end = 0.1 -> two case files, 'case.toml' and 'time.end': give one (overrides are
=0.1 -> command line: '=0.1': write section.key=value
time.end= -> command line: 'time.end=': 'time.end' takes a number, not text ""
time.end=1e -> command line: 'time.end=1e': 'time.end' takes a number, not text "1e"
time.end=1,5 -> 'time.end' takes a number, not text "1,5"
grid.cells_x=1. -> 'grid.cells_x' = 1 is out of range; allowed:
grid.cells_x=-.5 -> 'grid.cells_x' = -0.5 is out of range; allowed:
output.vtk=yes -> 'output.vtk' takes true or false, not text "yes"
tiem.end=0.1 -> line: 'tiem.end=0.1': unknown parameter 'tiem.end'; did you mean 'time.end'?
tiem.end=soon -> line: 'tiem.end=soon': unknown parameter 'tiem.end'; did you mean 'time.end'?
TIME.END=1 -> 'TIME.END'; did you mean 'time.end'?
"weather.forecast=it's" -> unknown parameter 'weather.forecast'; --help lists all
case.toml ITEM.beam.KEY_=high -> unknown parameter 'ITEM.beam.KEY_'; did you mean 'ITEM.beam.KEY'?
grid=64 -> unknown parameter 'grid'
grid={cells_x=1} -> line: 'grid={cells_x=1}': 'grid.cells_x' = 1 is out of range; allowed:
grid.cells_x=1 -> line: 'grid.cells_x=1': 'grid.cells_x' = 1 is out of range; allowed:
time.end=nan -> command line: 'time.end=nan': 'time.end' must be finite, not nan
time.end=fast -> command line: 'time.end=fast': 'time.end' takes a number, not text "fast"
grid.length_x=true -> 'grid.length_x' takes a number, not true or false
time.end=[1] -> 'time.end' takes a number, not text "[1]"
CHOICE=haris -> 'CHOICE' = "haris" is not one of "
grid.cells_x=64.5 -> 'grid.cells_x' takes a whole number, not 64.5
case.toml time.end=1 time.end=2 -> 'time.end' is given twice; keep one of them
ITEM.KEY=1 -> 'ITEM.KEY' needs the name of an item: write [ITEM.<name>] above its parameters
case.toml ITEM.beam.KEY_=2 -> unknown parameter 'ITEM.beam.KEY_'; did you mean 'ITEM.beam.KEY'?
)");
    check_command_lines({{repeated("x", 300), ": there is no such file"},
                         {"\"$(printf 'time.end=0.1\\ntime.end=3')\"", "one line, one value"},
                         {"\"$(printf 'CHOICE=\\377')\"", "not UTF-8 text"}});
}

TEST_CASE("wrong output folders are refused and left as they are" *
          doctest::description("robust")) {
    check_command_lines(R"(
case.toml --out a_file -> a_file: is a file, and the results need a folder; choose another --out
case.toml --out case.toml -> case.toml: is a file
case.toml --out /dev/null -> /dev/null: is a file
case.toml --out a_file/run -> a_file/run: cannot be created: Not a directory; choose another --out
case.toml --out /proc/nowhere/run -> /proc/nowhere/run: cannot be created:
case.toml --out dangling -> dangling: cannot be created:
case.toml --out foreign -> foreign: is not empty; --force writes into it, and leaves what is not of a run
case.toml --out earlier -> earlier: holds an earlier run; --force replaces it, --out DIR puts the
case.toml --out foreign/../earlier -> foreign/../earlier: holds an earlier run; --force replaces it
case.toml --out . -> --force replaces it
case.toml --out .. -> ..: is not empty; --force
)");
    check_command_lines({{"case.toml --out " + repeated("x", 300),
                          ": cannot be created: File name too long; choose another --out"}});
}

TEST_CASE("what must not be read or written is refused" * doctest::description("robust")) {
    // The superuser may read and write everything, and gives that up.
    const std::string before = geteuid() == 0 ? "setpriv --bounding-set=-all --inh-caps=-all" : "";
    using fs::perms;
    for (const Program& program : every_program()) {
        const fs::path folder = fresh_folder(program);
        write_all(folder / "closed.toml", "");
        write_all(folder / "case.toml", program.short_case);
        fs::create_directory(folder / "sealed");
        const auto check = [&](const std::string& name, perms rights, const std::string& arguments,
                               const std::string& message) {
            fs::permissions(folder / name, rights);
            check_refusal(program, folder, arguments, message, before);
            fs::permissions(folder / name, perms::owner_all);
        };
        check("closed.toml", perms::none, "closed.toml",
              "closed.toml: cannot be read: Permission denied");
        check("foreign", perms::none, "foreign/case.toml", "foreign/case.toml: ");
        check("sealed", perms::owner_read | perms::owner_exec, "case.toml --out sealed",
              "Permission denied");
        check("sealed", perms::owner_read | perms::owner_exec, "case.toml --out sealed/run",
              "sealed/run: cannot be created: Permission denied; choose another --out");
        check("earlier", perms::owner_write | perms::owner_exec, "case.toml --out earlier",
              "earlier: ");
    }
}

TEST_CASE("unusual but right input is accepted" * doctest::description("robust")) {
    for (const Program& p : every_program()) {
        const std::string plain = description(p, p.short_case), rest = p.short_case.substr(15);
        REQUIRE(p.short_case.starts_with("[time]\nend = 0\n"));
        CHECK(plain.size() > 100);
        for (const std::string& text :
             {"# nothing\n\n   \t# but words\n" + p.short_case, "\xef\xbb\xbf" + p.short_case,
              replaced(p.short_case, "\n", "\r\n"), p.short_case.substr(0, p.short_case.size() - 1),
              "# Größe \xf0\x9f\x8c\x8a\n" + p.short_case, "time . end = 0.0\n" + rest}) {
            INFO(text);
            CHECK(description(p, text) == plain);
        }
        const std::string cells = description(p, p.short_case, "grid.cells_x=40");
        for (const char* value : {"4e1", "4_0", "0x28"})
            CHECK(description(p, p.short_case, "grid.cells_x="s + value) == cells);
        CHECK(cells != plain);
        // More items, by an empty section and by an override, and as many as there may be.
        if (p.method != "implicit_moment") continue;
        CHECK(holds(description(p, p.short_case + "[species.more]\n", p.beam), "  more "));
        CHECK(holds(description(p, p.short_case, "species.more.mass=2 " + p.beam), "  more "));
        CHECK(holds(description(p, p.short_case + items(p, 64), p.beam), "  s63 "));
        CHECK(holds(description(p, "", replaced(p.beam, "uniform ", "'\"uniform\"' ")), "  beam "));
    }
    const Program& implicit = program_called("implicit_moment");
    CHECK(holds(description(implicit, ""), "200000, 48.83 per cell"));
    CHECK(holds(description(implicit, "[harris]\nparticles = 1e5\n"), " 100000, 24.41 per cell"));
}

TEST_CASE("a right case ends with status 0 however short" * doctest::description("robust")) {
    for (const Program& program : every_program())
        check_accepted(program.name + " run time.end=0\n" + program.name + " run time.end=1e-9");
    check_accepted(R"(
implicit_moment few harris.particles=2 time.end=0.3
implicit_moment few harris.particles=2 time.end=0 harris.thickness=0.6
implicit_moment few harris.particles=2 time.end=0.3 harris.thickness=0.6
)");
}

TEST_CASE("every shipped case passes a dry run or is for another program" *
          doctest::description("robust")) {
    const std::map<std::string, int> fewest{{"cic", 15},          {"pic", 10},
                                            {"flip", 18},         {"mpm_explicit", 13},
                                            {"mpm_implicit", 11}, {"implicit_moment", 11},
                                            {"explicit_em", 5}};
    const std::regex beyond(
        "pic: flip\\.[a-z_]+ = \\S+ is beyond pic: run the case with flip, or take it out");
    for (const Program& program : every_program()) {
        int described = 0;
        for (const auto& entry : fs::directory_iterator(program.method + "/cases")) {
            const bool is_explicit = holds(entry.path().stem(), "explicit");
            if (program.method == "implicit_moment" && is_explicit != (program.name[0] == 'e'))
                continue;
            // Memory that nobody has set is no longer zero by chance.
            const fs::path folder = fresh_folder(program);
            write_all(folder / "case.toml", read_all(entry.path()));
            const Files there = content(folder);
            const Outcome outcome =
                start(program, folder, "case.toml --dry-run", "env MALLOC_PERTURB_=85");
            INFO(program.name << " " << entry.path() << ": " << outcome.err);
            CHECK(content(folder) == there);
            if (program.name == "pic" && outcome.status == 2) {
                REQUIRE(outcome.sentences.size() == 1);
                CHECK(std::regex_match(outcome.sentences[0], beyond));
                continue;
            }
            CHECK(outcome.status == 0);
            CHECK(outcome.sentences.empty());
            CHECK(start(program, folder, "case.toml --dry-run --quiet").out.empty());
            ++described;
        }
        INFO(program.name);
        CHECK(described >= fewest.at(program.name));
    }
}

TEST_CASE("help lists every parameter with unit and range and default" *
          doctest::description("robust")) {
    const std::string units_of_all = R"(
cic grid.length_x length time.dt 1/omega_p plasma.B_y m*omega_p/e theory.near omega_p
    boundary.potential_x_low m*velocity^2/e species.<name>.density n0
    species.<name>.temperature_x m*velocity^2 species.<name>.emission n0*velocity
fluids grid.length_x length time.end time region.<name>.density mass/length^3
    flip.viscosity mass/(length*time) gravity.trap 1/time^2
grains grid.length_x length contact.separation h time.end time
    load.gravity_x acceleration material.<name>.E stress material.<name>.friction_angle degree
    grain.<name>.spin 1/time grain.<name>.damping force/velocity pack.<name>.radius_min length
    bond.<name>.shear stress
plasmas grid.length_x d_i time.dt 1/omega_pi uniform.phase_E_y degree
    uniform.B_x m_i*c*omega_pi/e output.fields_interval 1/omega_pi species.<name>.density n0
    species.<name>.mass m_i species.<name>.drift_x c
implicit_moment mover.tolerance cell
plasmas particles.relativistic -
explicit_em particles.order - output.history_steps -
)";
    for (const Program& program : every_program()) {
        const fs::path folder = fresh_folder(program);
        INFO(program.name);
        const Outcome help = start(program, folder, "--help --out nowhere");
        CHECK(help.status == 0);
        CHECK(help.err.empty());
        CHECK(!fs::exists(folder / "nowhere"));
        for (const char* option : {"--out DIR", "--force", "--restart FILE", "--threads N",
                                   "--dry-run", "--quiet", "--help", "--version"})
            CHECK(holds(help.out, option));
        CHECK(start(program, folder, "-h").out == help.out);

        // All parameters are in the case that a run writes, and nothing else is in the list.
        const std::vector<Parameter> parameters = listed_in(help.out);
        const auto run = [&](const std::string& name, const std::string& overrides) {
            REQUIRE(start(program, folder, "case.toml --quiet --out " + name + " " + overrides)
                        .status == 0);
            return read_all(folder / name / "case.toml");
        };
        write_all(folder / "case.toml", program.short_case);
        const std::string defaults = run("defaults", "");
        std::set<std::string> listed;
        for (const Parameter& p : parameters)
            listed.insert(std::regex_replace(
                std::regex_replace(p.name, std::regex("inflow.<name>"), "inflow.x_low"),  // an end
                std::regex("<name>"), "beam"));
        CHECK(listed.size() == parameters.size());
        CHECK(listed == keys_in(run("beam", program.beam)));

        // The defaults, given as overrides of what the short case leaves to them, make the same
        // case.
        const std::set<std::string> shortened = keys_in(program.short_case);
        std::string overrides;
        std::map<std::string, std::string> units;
        for (const Parameter& p : parameters) {
            INFO(p.name);
            CHECK(!p.range.empty());
            units[p.name] = p.unit.empty() ? "-" : std::regex_replace(p.unit, std::regex(" "), "*");
            if (!holds(p.name, "<name>") && !shortened.contains(p.name))
                overrides += "'" + p.name + "=" + p.initial + "' ";
        }
        CHECK(run("again", overrides) == defaults);
        for (const Command& command : commands(units_of_all)) {
            if (command.program != &program) continue;
            const auto words = words_in(command.words + " " + joined(command.expected));
            for (std::size_t k = 0; k + 1 < words.size(); k += 2) {
                INFO(words[k]);
                CHECK(units[words[k]] == words[k + 1]);
            }
        }
        for (const char* implicit : {"field.theta", "field.tolerance", "mover.tolerance"})
            CHECK(units.contains(implicit) == (program.name == "implicit_moment"));

        const Outcome version = start(program, folder, "--version");
        CHECK(version.status == 0);
        CHECK(version.out == program.name + " " PROGRAM_VERSION "\n");
        CHECK(version.err.empty());
    }
}
