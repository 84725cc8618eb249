// Runs of pic and of flip that are short and differ in what they call, and what both must do when
// they are asked for nonsense, stopped, or continued.
#pragma once

#include <string>
#include <vector>

#include "common/run/checkpoint.hpp"
#include "tests/support/any_run.hpp"

namespace facts {

/// A run with more settings, which replace those of the same name: given twice, they are refused.
inline std::string over(const std::string& arguments, const std::string& more) {
    std::ostringstream kept;
    std::istringstream words(arguments);
    for (std::string word; words >> word;) {
        const std::string key = word.substr(0, word.find('=') + 1);
        const bool replaced = holds(word, "=") && (more.starts_with(key) || holds(more, ' ' + key));
        if (!replaced) kept << ' ' << word;
    }
    kept << ' ' << more;
    return kept.str();
}

// Sod's tube between walls.
inline const std::string tube = " flip/cases/sod.toml grid.cells_x=40 time.end=0.15";
// Gas that comes in at one end and is held up by a wall.
inline const std::string wind = " flip/cases/piston.toml grid.cells_x=40 time.end=0.3";
// Gas that comes in at one end of a channel and leaves at the other, against the pressure there.
inline const std::string channel =
    " flip/cases/piston.toml theory.compare=none grid.cells_x=24 grid.cells_z=6 grid.length_z=0.25 "
    "boundary.x_low=open boundary.pressure_x_low=0.8 boundary.z_low=slip boundary.z_high=slip "
    "particles.per_cell_x=3 particles.per_cell_z=2 time.end=0.2";
// A disk that turns in a void; gravity lets it fall out of the mesh.
inline const std::string disk =
    " flip/cases/rotating_disk.toml grid.cells_x=20 grid.cells_z=20 time.dt=0.03 time.end=1 "
    "gravity.x=0.6";
// Two gases, one above the other.
inline const std::string layers =
    " flip/cases/rayleigh_taylor.toml grid.cells_x=10 grid.cells_z=20 time.end=0.4 "
    "output.particles_interval=0";
// Particles anywhere, and noise.
inline const std::string noise =
    " flip/cases/piston.toml grid.cells_x=30 time.end=0.3 particles.loading=random "
    "region.gas.noise=0.1";

inline std::vector<std::string> runs_of_both() {
    return {tube, wind, channel, disk, layers, noise};
}

/// Damaged, cut, foreign and outdated checkpoints are refused, and nothing is written.
/// in:     the other of the two programs
inline void check_bad_checkpoints(const std::string& other_program) {
    const std::string good_run = folder("good"), out = folder("other"), bad = room() + "/bad.bin";
    REQUIRE(run(tube + " output.checkpoint_steps=20", good_run) == 0);
    const std::string kept = checkpoints(good_run).back(), good = read_all(kept);
    REQUIRE(good.size() > 10000);
    const auto refused = [&](const std::string& bytes, const std::string& reason,
                             const std::string& overrides = "") {
        write_all(bad, bytes);
        CHECK(run(" --restart " + bad + overrides, out) == 2);
        INFO(reason << " in: " << said(out));
        CHECK(holds(said(out), reason));
        CHECK(!fs::exists(out));
    };
    for (const std::size_t place : {std::size_t{20}, std::size_t{60}, good.size() / 3,
                                    good.size() / 2, good.size() - 9, good.size() - 1}) {
        std::string flipped = good;
        flipped[place] = static_cast<char>(flipped[place] ^ 0x10);
        refused(flipped, "damaged");
    }
    for (const std::size_t length : {std::size_t{24}, std::size_t{100}, good.size() - 1})
        refused(good.substr(0, length), "cut off");
    refused(good + "x", "too long");
    refused("", "is not a checkpoint");

    // The other program's, with the same case; another version's; one without anything in it.
    const std::string foreign = folder("foreign");
    REQUIRE(shell(std::string(BUILD_FOLDER) + "/" + other_program + tube +
                  " output.checkpoint_steps=20 --quiet --out " + foreign + " 2> /dev/null") == 0);
    refused(read_all(checkpoints(foreign).back()),
            "of '" + other_program + "', not of '" + program_name + "'");
    common::CheckpointWriter({program_name, "0.0.1", "", ""}, bad, "", "").finish();
    refused(read_all(bad), "was written by version 0.0.1");
    common::CheckpointWriter({program_name, PROGRAM_VERSION, "", ""}, bad, "", "").finish();
    refused(read_all(bad), "ends too early");
    // Another case.
    refused(good, "time.cfl", " time.cfl=0.2");
}

/// A limit on the size of files stands for the full disk.
inline void check_full_disk() {
    const std::string out = folder("full");
    const auto full = [&](const std::string& arguments, const std::string& message) {
        fs::remove_all(out);
        CHECK(shell("sh -c 'trap \"\" XFSZ; ulimit -f 64; exec " + command(arguments) +
                    " --quiet --out " + out + "' 2> " + out + ".stderr") == 2);
        INFO(said(out));
        CHECK(holds(said(out), message));
        for (const auto& entry : fs::directory_iterator(out))
            CHECK(!holds(entry.path().string(), ".partial"));
    };
    full(over(tube, "time.end=10"), "history.dat: cannot be written; is the disk full?");
    full(over(tube, "grid.cells_x=400 output.checkpoint_steps=5"), "checkpoint");
    full(over(tube, "grid.cells_x=400 output.particles_interval=0.1"), "particles_000000.dat");
    full(over(tube, "grid.cells_x=800 output.fields_interval=0.1"), "fields_000000.dat");
    // A folder that cannot be made.
    const std::string file = room() + "/a_file";
    write_all(file, "not a folder\n");
    CHECK(shell(command(tube) + " --quiet --out " + file + "/run 2> " + out + ".stderr") == 2);
    CHECK(holds(said(out), program_name + ": "));
    CHECK(read_all(file) == "not a folder\n");
}

inline void check_closed_pipes() {
    const std::string out = room() + "/pipe",
                      arguments = command(tube) + " --force --out " + out + " ";
    CHECK(shell(arguments + "2> /dev/null | true") == 0);
    CHECK(shell(arguments + ">&- 2>&-") == 0);
    CHECK(shell("(" + arguments + "2>&1; echo $? > " + out + ".status) | head -1 > /dev/null") ==
          0);
    CHECK(read_all(out + ".status") == "0\n");
    CHECK(summary(out)["status"] == 0);
}

/// A folder with an earlier run is kept unless --force replaces it, and what is not of a run stays.
inline void check_force() {
    const std::string out = folder("replaced");
    REQUIRE(run(over(layers,
                     "output.particles_interval=0.2 output.fields_interval=0.2 output.vtk=true "
                     "output.checkpoint_steps=20"),
                out) == 0);
    for (const char* name : {"particles_000000.dat", "particles_000000.vtp", "fields_000000.dat",
                             "fields_000000.vti"}) {
        CAPTURE(name);
        CHECK(fs::exists(out + "/" + name));
    }
    CHECK(checkpoints(out).size() == 2);
    const Files there = content(out);
    CHECK(run(tube, out) == 2);
    CHECK(holds(said(out), "holds an earlier run; --force replaces it"));
    CHECK(content(out) == there);

    write_all(out + "/fields_of_gold.dat", "kept");
    REQUIRE(run(tube + " --force", out) == 0);
    // case.toml, history.dat, profile.dat, summary.json, and that.
    CHECK(content(out).size() == 4 + 1);
    CHECK(read_all(out + "/fields_of_gold.dat") == "kept");
    // A folder that holds only such files is not ours.
    const std::string foreign = folder("foreign_folder");
    write_all(foreign + "/fields_of_gold.dat", "kept");
    CHECK(run(tube, foreign) == 2);
    CHECK(holds(said(foreign), "is not empty"));
}

/// A run ends with status 3 and one sentence after its warnings, and its history is finite.
/// in:     sentence, a regular expression in which NUMBER is any number
inline void check_sentence(const std::string& arguments, const std::string& sentence) {
    check_failure(arguments, "");
    const std::string out = room() + "/failed", text = said(out);
    INFO(arguments << ": " << text);
    std::string pattern = "(warning: [^\n]*\n)*" + program_name + ": " + sentence + "\n";
    pattern = std::regex_replace(pattern, std::regex("NUMBER"), "[-+.e0-9]+");
    CHECK(std::regex_match(text, std::regex(pattern)));
    CHECK(!holds(read_all(out + "/history.dat"), "nan"));
    CHECK(!holds(read_all(out + "/history.dat"), "inf"));
}

/// What a dry run says to every case that is shipped, started where the published tables are.
inline std::map<std::string, Outcome> dry_runs_of_shipped_cases() {
    std::map<std::string, Outcome> outcomes;
    for (const auto& entry : fs::directory_iterator("flip/cases")) {
        const fs::path folder = fresh_folder("shipped " + entry.path().stem().string());
        write_all(folder / "case.toml", read_all(entry.path()));
        fs::create_directory_symlink(fs::absolute("flip"), folder / "flip");
        const Files there = content(folder);
        // Memory that nobody has set is no longer zero by chance.
        outcomes[entry.path().string()] =
            start(folder, "case.toml --dry-run", "env MALLOC_PERTURB_=85");
        CHECK(content(folder) == there);
    }
    return outcomes;
}

/// --help, ranges, unknown keys, the version.
inline void check_lists() {
    auto units = check_help("[time]\nend = 0\n[region.beam]\n", "material.beam.gamma=1.5");
    CHECK(units["grid.length_x"] == "length");
    CHECK(units["time.end"] == "time");
    CHECK(units["region.<name>.density"] == "mass/length^3");
    CHECK(units["flip.viscosity"] == "mass/(length time)");
    CHECK(units["gravity.trap"] == "1/time^2");
}
inline void check_unknown_keys() {
    const std::string gas = "[time]\nend = 1\n[region.gas]\n";
    check_refused({
        {"transfer", gas, "'flip.tranfser=\"apic\"'",
         "unknown parameter 'flip.tranfser'; did you mean 'flip.transfer'?"},
        {"cells", gas, "grid.cells=100",
         "unknown parameter 'grid.cells'; did you mean 'grid.cells_"},
        {"density of a region", gas + "densty = 2\n", "",
         "case.toml:4:10: unknown parameter 'region.gas.densty'; did you mean "
         "'region.gas.density'?"},
        {"section", gas + "[visosity]\nlinear = 1\n", "", "did you mean 'viscosity.linear'?"},
        {"choice", gas, "flip.pressure=implict",
         "'flip.pressure' = \"implict\" is not one of \"explicit\", \"implicit\""},
    });
}

}  // namespace facts
