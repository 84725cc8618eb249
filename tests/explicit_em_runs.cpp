// Whole runs of explicit_em against exact and published values.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "tests/support/any_run.hpp"
#include "tests/support/any_summary.hpp"

namespace {

using namespace facts;

int run(const std::string& arguments, const std::string& out) {
    return facts::run("explicit_em", arguments, out);
}

const std::string cases = " implicit_moment/cases/explicit_";
// A small reconnecting sheet.
std::string sheet(long particles, long history_steps = 2) {
    return " implicit_moment/cases/gem_explicit.toml grid.cells_x=32 grid.cells_z=16 time.dt=0.2 "
           "output.history_steps=" +
           std::to_string(history_steps) + " harris.particles=" + std::to_string(particles) + " ";
}

// Runs in a folder of the fact's own and compares every result that has an expected value.
nlohmann::json passing(const std::string& name, const std::string& arguments, int results) {
    const std::string out = folder(name);
    CAPTURE(arguments);
    REQUIRE(run(arguments, out) == 0);
    const nlohmann::json json = summary(out);
    check_results(json, results);
    return json;
}
// Electrons and positrons in a square of 8, but for what the rest says.
std::string pairs(const std::string& rest, const std::string& drift = "",
                  const std::string& temperature = "") {
    std::string words = " implicit_moment/cases/gem_explicit.toml " + rest;
    const auto unless_said = [&](const std::string& key, const std::string& value) {
        if (!holds(words, " " + key + "=")) words += " " + key + "=" + value;
    };
    for (const char* axis : {"x", "z"}) {
        unless_said(std::string("grid.cells_") + axis, "32");
        unless_said(std::string("grid.length_") + axis, "8");
    }
    unless_said("plasma.setup", "uniform"), unless_said("output.fields_interval", "0");
    unless_said("time.dt", "0.1"), unless_said("uniform.particles_per_cell", "9");
    for (const std::string one : {"species.e.", "species.p."}) {
        words += " " + one + "charge=" + (one == "species.e." ? "-1" : "1");
        if (!drift.empty()) words += " " + one + drift;
        for (const char* axis : {"x", "y", "z"})
            if (!temperature.empty())
                words += " " + one + "temperature_" + axis + "=" + temperature;
    }
    return words;
}
nlohmann::json results(const std::string& name, const std::string& arguments) {
    const std::string out = folder(name);
    CAPTURE(arguments);
    REQUIRE(run(arguments, out) == 0);
    return summary(out)["results"];
}
double conserved(const nlohmann::json& json, const char* name) {
    return json["conservation"][name]["value"].get<double>();
}

}  // namespace

TEST_CASE("light waves have the frequency of Yee's mesh and keep their amplitude" *
          doctest::description("physics")) {
    for (const char* rest : {"", " time.dt=0.07 grid.cells_z=64 grid.length_z=6.4",
                             " uniform.wave_E_y=0 uniform.wave_E_z=1e-3 theory.component=E_z",
                             " uniform.mode_x=0 uniform.mode_z=1"}) {
        const auto json = passing("light", cases + "light_wave.toml" + rest, 2);
        CHECK(std::fabs(value(json, "omega_over_theory") - 1) <= 1e-6);
        CHECK(std::fabs(value(json, "damping")) <= 1e-6);
        CHECK(std::fabs(conserved(json, "largest_gauss_residual")) <= 1e-14);
    }
}

TEST_CASE("cold Langmuir waves have the frequency of the leapfrog" *
          doctest::description("physics")) {
    for (const auto& [dt, rest] :
         {std::pair{0.5, ""},
          {0.5, " particles.order=2"},
          {0.1, " time.dt=0.1 time.end=40"},
          {0.5, " particles.relativistic=false field.smoothing_passes=2"}}) {
        const auto json = passing("langmuir", cases + "langmuir.toml" + rest, 2);
        CHECK(std::fabs(value(json, "omega_over_theory") - 1) <= 0.001);
        // Velocities at t^n, the means of those around it, are too small by (omega dt)^2/8.
        CHECK(conserved(json, "largest_energy_drift") <= 0.3 * dt * dt);
        CHECK(conserved(json, "largest_gauss_residual") <= 4e-14);
    }
}

TEST_CASE("two cold streams grow at the rate of linear theory" * doctest::description("physics")) {
    passing("streams", cases + "two_stream.toml time.end=30", 2);
    passing("streams", cases + "two_stream.toml time.end=30 particles.order=2", 2);
}

TEST_CASE("Weibel filaments grow at the rate of linear theory" * doctest::description("physics")) {
    passing("weibel", cases + "weibel.toml", 2);
    passing("weibel", cases + "weibel.toml particles.order=2", 2);
    // Electrons of half the speed of light, and beams of gamma = 5^(1/2).
    passing("heavy",
            cases + "weibel.toml particles.relativistic=true species.electrons.temperature_y=0.3",
            2);
    std::string beams =
        "two_stream.toml particles.relativistic=true time.dt=0.04 time.end=30"
        " grid.length_x=4.189 grid.length_z=0.262 uniform.particles_per_cell=256"
        " theory.wave=transverse theory.component=B_z uniform.wave_B_z=3e-5";
    for (const auto& [name, drift] : {std::pair{"right", "2"}, {"left", "-2"}}) {
        const std::string one = std::string(" species.") + name;
        beams += one + ".drift_x=0" + one + ".drift_y=" + drift + one + ".temperature_y=0.09" +
                 one + ".temperature_x=4e-4" + one + ".wave_x=0";
    }
    passing("beams", cases + beams, 2);
}

TEST_CASE("a small GEM challenge keeps its energy and its constraints" *
          doctest::description("physics")) {
    for (const char* rest :
         {"", " particles.order=2", " field.smoothing_passes=2", " harris.guide_field=0.5"}) {
        const std::string out = folder("sheet");
        REQUIRE(run(sheet(20000) + "output.fields_interval=0 time.end=60" + rest, out) == 0);
        const auto json = summary(out);
        CAPTURE(rest);
        CHECK(conserved(json, "largest_energy_drift") <= 0.002);
        CHECK(conserved(json, "largest_gauss_residual") <= 2e-14);
        CHECK(conserved(json, "largest_div_B") <= 1e-14);
        CHECK(std::fabs(column(out, "flux").front() - 0.2) <= 0.01);
    }
}

TEST_CASE("momentum along walls is judged and wide splines with smoothing keep it" *
          doctest::description("physics")) {
    for (const auto& [walls, drift] :
         {std::pair{"grid.boundary_z=wall", "drift_x=0.05"},
          {"grid.boundary_z=periodic", "drift_x=0.05"},
          {"grid.boundary_x=reflecting grid.boundary_z=periodic", "drift_z=0.05"}}) {
        const std::string cold =
            pairs(std::string(walls) + " species.p.mass=4 time.end=100", drift, "1e-5");
        const auto braked = results("braked", cold)["momentum_change"];
        CHECK(braked["value"].get<double>() > 0.1);
        CHECK(braked["verdict"] == "FAIL");
        CHECK(holds(braked["hint"].get<std::string>(),
                    "Debye length is 0.01265 cells: set particles.order = 2 and "
                    "field.smoothing_passes = 4"));
        const auto kept = results("kept", cold + " particles.order=2 field.smoothing_passes=4");
        CHECK(kept["momentum_change"]["value"].get<double>() <= 1e-4);
    }
    // What a field that crosses walls holds and what meets a wall is not kept.
    for (const auto& [walls, drift] :
         {std::pair{"grid.boundary_z=reflecting uniform.B_z=0.1", "drift_z=0.05"},
          {"grid.boundary_z=reflecting uniform.B_z=0.1", "drift_y=0.05"},
          {"grid.boundary_z=wall", "drift_z=0.05"}})
        CHECK(!results("lost", pairs(std::string(walls) + " time.end=4", drift, "1e-5"))
                   .contains("momentum_change"));
}

TEST_CASE("momentum across a field along walls is kept together with that of the field" *
          doctest::description("physics")) {
    const auto kept = results("field", pairs("grid.boundary_z=wall uniform.B_y=0.2 time.end=60 "
                                             "particles.order=2 field.smoothing_passes=4",
                                             "drift_x=0.1", "0.02"));
    CHECK(kept["momentum_change"]["value"].get<double>() <= 0.01);  // particles lose 0.03
}

TEST_CASE("walls that mirror the plasma differ where splines or smoothing reach behind them" *
          doctest::description("physics")) {
    const auto history = [](const std::string& wall, const std::string& rest) {
        const std::string out = folder("behind");
        REQUIRE(run(pairs("grid.boundary_z=" + wall +
                              " time.end=5 species.e.drift_y=0.05 species.p.drift_y=-0.05 " + rest,
                          "", "1e-3"),
                    out) == 0);
        return read_all(out + "/history.dat");
    };
    CHECK(history("wall", "") == history("reflecting", ""));
    for (const char* reach : {"particles.order=2", "field.smoothing_passes=1"})
        CHECK(history("wall", reach) != history("reflecting", reach));
}

TEST_CASE("waves that have no E along walls have the frequency of theory beside them" *
          doctest::description("physics")) {
    const std::string rest =
        " grid.length_x=4 grid.length_z=4 time.dt=0.05 time.end=30 uniform.particles_per_cell=16 "
        "grid.boundary_z=wall theory.wave=transverse theory.near=2.1 output.history_steps=1";
    for (const std::string seed :
         {"uniform.mode_x=0 uniform.mode_z=1 theory.component=E_y species.e.wave_y=1e-4 "
          "species.p.wave_y=-1e-4 species.e.phase_y=90 species.p.phase_y=90",
          "theory.component=E_z species.e.wave_z=1e-4 species.p.wave_z=-1e-4"}) {
        const auto seen = results("beside", pairs(rest + " " + seed));
        CHECK(std::fabs(seen["omega_over_theory"]["value"].get<double>() - 1) <= 0.003);
    }
}

TEST_CASE("a hint of explicit_em names the cause and its cure lets the run pass" *
          doctest::description("physics")) {
    struct Failure {
        std::string run, result, hint, cured;
    };
    const std::string harris =
        " implicit_moment/cases/gem_explicit.toml grid.cells_x=64 grid.cells_z=64 "
        "grid.length_x=6.4 grid.length_z=6.4 time.dt=0.06 time.end=0.06 harris.mass_ratio=4 "
        "harris.light_over_alfven=5 harris.particles=60000 harris.perturbation=0 "
        "harris.background=0 output.fields_interval=0 output.history_steps=1";
    const auto transverse = [](const std::string& dt) {
        return pairs(
            "grid.length_x=64 grid.cells_z=4 time.end=200 theory.wave=transverse "
            "theory.component=E_y "
            "theory.near=1 species.e.wave_y=1e-4 species.p.mass=1e5 output.history_steps=1 "
            "grid.boundary_z=periodic time.dt=" +
            dt);
    };
    for (const Failure& one :
         {Failure{harris, "current_over_noise", "7.647 % too small",
                  harris + " particles.relativistic=false"},
          {transverse("1"), "omega_over_theory", "steps of omega dt = 1", transverse("0.45")}}) {
        const auto seen = results("cause", one.run);
        CHECK(seen[one.result]["verdict"] == "FAIL");
        CHECK(holds(seen[one.result]["hint"].get<std::string>(), one.hint));
        CHECK(seen["energy_drift"]["verdict"] == "PASS");
        CHECK(results("cured", one.cured)[one.result]["verdict"] == "PASS");
    }
    // A test particle at rest swings to 1.8 c where the drift is 0.9 c: no push without gamma helps.
    const auto fast = results(
        "fast", pairs("uniform.B_y=1 uniform.E_x=0.9 time.end=60 species.e.density=1e-9 "
                      "species.p.density=1e-9 grid.boundary_z=periodic"))["drift_over_E_cross_B"];
    CHECK(fast["verdict"] == "NOT MEASURED");
    CHECK(!holds(fast.dump(), "particles.relativistic"));
}

TEST_CASE("growth that is short says how long a run tells it or that it is over" *
          doctest::description("physics")) {
    const std::string turns =
        " grid.length_x=6 grid.cells_z=4 grid.length_z=0.5 time.dt=0.05 uniform.B_x=0.5 "
        "uniform.particles_per_cell=256 theory.component=B_y theory.wave=transverse "
        "output.history_steps=1 particles.relativistic=false species.e.temperature_x=0.01 "
        "species.e.temperature_y=0.05 species.e.temperature_z=0.05 species.e.wave_y=0.001 "
        "species.p.mass=1836 grid.boundary_z=periodic time.end=";
    const auto said = [&](const std::string& end) {
        return results("turns", pairs(turns + end))["growth_over_theory"]["source"]
            .get<std::string>();
    };
    CHECK(holds(said("60"), "raise time.end to 130"));
    CHECK(holds(said("130"), "growth is over then: lower the seed"));
}

TEST_CASE("a sheet with a larger island reaches unit flux and keeps its profile" *
          doctest::description("physics")) {
    const std::string out = folder("island");
    REQUIRE(run(sheet(20000) + "output.fields_interval=0 harris.perturbation=0.4 time.end=160",
                out) == 0);
    const auto json = summary(out);
    const auto flux = column(out, "flux"), time = column(out, "time_Omega_ci");
    CHECK(std::fabs(flux.front() - 0.8) <= 0.03);
    CHECK(flux.back() > 1);
    CHECK(conserved(json, "largest_energy_drift") <= 0.008);
    const double unit = value(json, "time_at_unit_flux");
    CHECK(unit > 0);
    CHECK(unit < time.back());
    CHECK(fs::file_size(out + "/profile.dat") > 1000);
}

// Electrons over a fixed background, in a field that turns them by 0.2 in half a step.
TEST_CASE("files of particles hold the velocities of their own time") {
    for (const std::string order : {"1", "2"}) {
        const std::string out = folder("velocities" + order);
        REQUIRE(run(cases +
                        "langmuir.toml theory.wave=none time.end=1 output.particles_interval=1 "
                        "uniform.B_z=0.8 species.electrons.wave_x=0 "
                        "species.electrons.drift_x=0.1 species.electrons.drift_y=0.2 "
                        "particles.order=" +
                        order,
                    out) == 0);
        std::istringstream rows(read_all(out + "/particles_000000.dat"));
        int count = 0;
        for (std::string line; std::getline(rows, line);) {
            double species = -1, x = 0, z = 0, u_x = 0, u_y = 0, u_z = 0;
            if (!(std::istringstream(line) >> species >> x >> z >> u_x >> u_y >> u_z)) continue;
            CHECK(std::hypot(u_x - 0.1, u_y - 0.2, u_z) <= 1e-6);
            ++count;
        }
        CHECK(count > 1000);
    }
}

TEST_CASE("rows and snapshots of a sparse history are those of a dense one" *
          doctest::description("robust")) {
    const std::string dense = folder("dense"), sparse = folder("sparse");
    const std::string rest = "time.end=4 output.fields_interval=1.2";
    REQUIRE(run(sheet(6000, 1) + rest, dense) == 0);
    REQUIRE(run(sheet(6000, 6) + rest, sparse) == 0);
    const auto all = column(dense, "energy"), some = column(sparse, "energy");
    REQUIRE(all.size() == 21);
    REQUIRE(some.size() == 5);  // steps 0, 6, 12, 18 and the last
    for (std::size_t n = 0; n < 4; ++n) CHECK(some[n] == all[6 * n]);
    CHECK(some.back() == all.back());
    int snapshots = 0;
    for (const auto& entry : fs::directory_iterator(sparse)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("fields_")) continue;
        CHECK(read_all(entry.path()) == read_all(dense + "/" + name));
        ++snapshots;
    }
    CHECK(snapshots == 5);  // of t = 0, 1.2, 2.4, 3.6 and the end
}

TEST_CASE("what is kept of a long explicit run stays when a shorter one is kept" *
          doctest::description("robust")) {
    const std::string run_of = folder("kept"), data = folder("data");
    fs::create_directories(run_of);
    fs::create_directories(data);
    const std::string flux = data + "/explicit_gem_flux.csv";
    const auto keep = [&](double end) {
        std::ofstream(run_of + "/summary.json") << "{\n  \"version\": \"1\"\n}\n";
        std::ofstream history(run_of + "/history.dat");
        history << "time time_Omega_ci flux\n# units: none\n";
        for (double t = 0; t <= end; t += 0.25)
            history << 20 * t << ' ' << t << ' ' << t / 2 << '\n';
        history.close();
        const std::string command = "sh implicit_moment/data/keep_explicit_gem.sh " + run_of + " " +
                                    data + " 2> " + data + "/said";
        REQUIRE(std::system(command.c_str()) == 0);
        return read_all(flux);
    };
    const std::string longer = keep(3.25);
    CHECK(holds(longer, "\n3.000,1.50000\n3.250,1.62500\n"));
    CHECK(keep(2) == longer);
    CHECK(holds(read_all(data + "/said"), "is shorter than what"));
    CHECK(holds(keep(4), "\n3.500,1.75000\n4.000,2.00000\n"));
    CHECK(!holds(read_all(flux), "4.000,2.00000\n4.000"));
}
