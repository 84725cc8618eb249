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
