// Whole runs of cic against exact and predicted values, by the numbers that the program itself puts
// into summary.json and history.dat.
#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/any_summary.hpp"
#include "tests/support/folder_of_test.hpp"

namespace {

using facts::check_results, facts::largest, facts::Run, facts::text;

// Runs a case in a folder of the test's own, without files for figures.
Run run(const std::string& name, const std::string& file, const std::string& overrides) {
    return facts::run_into("cic_" + name, "cic",
                           "cic/cases/" + file + ".toml " + overrides +
                               " output.phase_interval=0 output.particles_interval=0 "
                               "output.fields_interval=0");
}

// What it says of its results on standard error.
std::string said(const std::string& file, const std::string& overrides) {
    const std::string room = facts::folder_of_test(),
                      command = std::string(BUILD_FOLDER) + "/cic " + file + " " + overrides +
                                " output.phase_interval=0 output.particles_interval=0 "
                                "output.fields_interval=0 --out " +
                                room + "/told --force --quiet 2> " + room + "/words";
    std::filesystem::create_directories(room);
    REQUIRE(std::system(command.c_str()) == 0);
    std::ifstream words(room + "/words");
    return {std::istreambuf_iterator<char>(words), {}};
}
void says(const std::string& text, const std::string& part) {
    CAPTURE(text);
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
}

// A case of electrons before fixed ions, in a file of the test's own.
std::string case_file(const std::string& text) {
    const std::string room = facts::folder_of_test(), path = room + "/own.toml";
    std::filesystem::create_directories(room);
    std::ofstream(path) << text;
    return path;
}

const double pi = std::acos(-1.0);
std::string length_of(double k) { return " grid.length_x=" + text(2 * pi / k); }

// Frequency of a standing wave of the cold plasma at rest.
double cold_frequency(const std::string& name, const std::string& weighting,
                      const std::string& scheme, int mode, double dt) {
    const std::string m = std::to_string(mode);
    // The lattice wave is linear as long as particles stay in their cells.
    const Run r = run(name, "plasma_wave",
                      "method.weighting=" + weighting + " method.scheme=" + scheme +
                          " theory.mode_x=" + m + " species.electrons.mode_x=" + m +
                          " species.electrons.amplitude=1e-5 output.modes=0 time.dt=" + text(dt) +
                          " time.end=" + text(std::min(200.0, 2000 * dt)));
    check_results(r, 2);
    return r.value("omega");
}

}  // namespace

TEST_CASE("a cold plasma on the mesh oscillates with cos k dx half" *
          doctest::description("physics")) {
    for (const int mode : {1, 4, 8, 12}) {
        CAPTURE(mode);
        const double theta = pi * mode / 32, c = std::cos(theta), dt = 0.05;
        const auto of_leapfrog = [&](double omega) { return 2 / dt * std::asin(0.5 * omega * dt); };
        CHECK(std::fabs(cold_frequency("cold", "cic", "momentum", mode, dt) / of_leapfrog(c) - 1) <=
              1e-4);
        CHECK(std::fabs(cold_frequency("cold", "tsc", "momentum", mode, dt) /
                            of_leapfrog(c * std::sqrt((2 + c * c) / 3)) -
                        1) <= 1e-4);
        CHECK(std::fabs(cold_frequency("cold", "cic", "energy", mode, dt) / of_leapfrog(1) - 1) <=
              1e-4);
    }
}

TEST_CASE("the leapfrog raises frequencies to the arc sine" * doctest::description("physics")) {
    for (const double dt : {0.1, 0.2, 0.5, 1.0, 1.5, 1.9}) {
        CAPTURE(dt);
        CHECK(std::fabs(cold_frequency("leapfrog", "cic", "energy", 3, dt) /
                            (2 / dt * std::asin(0.5 * dt)) -
                        1) <= 1e-4);
    }
}

TEST_CASE("the energy scheme conserves the energy of small waves to round-off" *
          doctest::description("physics")) {
    // While no particle leaves its cell, the force is linear, and the leapfrog has an invariant.
    for (const double dt : {0.1, 1.0, 1.9}) {
        const Run r =
            run("invariant", "plasma_wave",
                "method.scheme=energy species.electrons.amplitude=1e-3 theory.compare=none "
                "time.dt=" +
                    text(dt) + " time.end=" + text(500 * dt));
        CHECK(largest(r.column("energy_drift")) <= 1e-10);
        CHECK(r.column("field").front() > 0);
    }
}

TEST_CASE("a traveling wave runs one way at the phase speed of theory" *
          doctest::description("physics")) {
    const Run r = run("traveling", "plasma_wave",
                      "species.electrons.wave=traveling output.spectrum=true time.end=100 "
                      "time.dt=0.1");
    check_results(r, 2);
    const std::vector<double>&re = r.column("mode_re"), &im = r.column("mode_im");
    const double start = std::hypot(re[0], im[0]);
    double turned = 0;
    for (std::size_t n = 1; n < re.size(); ++n) {
        CHECK(std::fabs(std::hypot(re[n], im[n]) / start - 1) <= 0.01);
        turned += std::arg(std::complex<double>(re[n], im[n]) /
                           std::complex<double>(re[n - 1], im[n - 1]));
    }
    // exp(i k x - i omega t), on this mesh and with this time step
    const double omega = 20 * std::asin(0.05 * std::cos(pi / 8));
    CHECK(std::fabs(turned / (100 * -omega) - 1) <= 1e-3);

    // The spectrum has its peak there, and nothing at the negative frequency.
    std::ifstream spectrum(facts::folder_of_test() + "/cic_traveling/spectrum.dat");
    double peak = 0, peak_omega = 0, peak_k = 0, mirrored = 0;
    for (std::string line; std::getline(spectrum, line);) {
        std::istringstream words(line);
        double w = 0, k = 0, power = 0;
        if (!(words >> w >> k >> power)) continue;
        if (power > peak) peak = power, peak_omega = w, peak_k = k;
        if (w < -0.5) mirrored = std::max(mirrored, power);
    }
    CHECK(std::fabs(peak_omega - omega) <= 2 * pi / 100);
    CHECK(std::fabs(peak_k - pi / 4) <= 1e-12);
    CHECK(mirrored <= 1e-4 * peak);
}

TEST_CASE("phase space in bins holds every particle" * doctest::description("physics")) {
    const std::string folder = facts::folder_of_test() + "/cic_bins";
    const std::string command = std::string(BUILD_FOLDER) +
                                "/cic cic/cases/warm_two_stream.toml time.end=1 "
                                "output.phase_interval=1 output.phase_v_max=20 --out " +
                                folder + " --force --quiet 2> /dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    const auto sum = [&](const char* file, int columns) {
        std::ifstream in(folder + file);
        double total = 0;
        for (std::string line; std::getline(in, line);) {
            std::istringstream words(line);
            double skipped = 0, right = 0, left = 0;
            bool good = true;
            for (int k = 0; k < columns; ++k) good = good && (words >> skipped);
            if (good && words >> right >> left) total += right + left;
        }
        return total;
    };
    const double L = 31.41592653589793, dx = L / 128, dv = 40.0 / 128;
    CHECK(std::fabs(sum("/phase_000000.dat", 2) * dx * dv / L - 1) <= 1e-9);
    CHECK(std::fabs(sum("/velocities_000000.dat", 1) * dv - 1) <= 1e-9);
}

TEST_CASE("two cold streams grow at the root of their dispersion relation" *
          doctest::description("physics")) {
    for (const double K : {0.3, 0.5, 0.6123724356957945, 0.9}) {
        CAPTURE(K);
        const Run r = run("two_stream", "two_stream", "output.modes=0 time.end=60" + length_of(K));
        check_results(r, 2);
        // w^2 = K^2 + 1/2 - (1/2)^1/2 (4 K^2 + 1/2)^1/2 for total omega_p = 1
        const double gamma = std::sqrt(std::sqrt(2 * K * K + 0.25) - K * K - 0.5);
        CHECK(std::fabs(r.value("theory_growth") / gamma - 1) <= 1e-9);
        CHECK(std::fabs(r.value("growth") / gamma - 1) <= 0.01);
        CHECK(std::fabs(r.conservation("momentum_x_change")) <= 1e-12);
        CHECK(r.conservation("largest_charge_error") <= 1e-14);
    }
}

TEST_CASE("no stream grows above the cut-off" * doctest::description("physics")) {
    for (const double K : {1.02, 1.1, 1.4}) {
        CAPTURE(K);
        const Run r = run("cut_off", "two_stream", "output.modes=0 time.end=60" + length_of(K));
        check_results(r, 2);
        std::vector<double> amplitude;
        for (std::size_t n = 0; n < r.column("mode_re").size(); ++n)
            amplitude.push_back(std::hypot(r.column("mode_re")[n], r.column("mode_im")[n]));
        CHECK(largest(amplitude) <= 1.2 * amplitude.front());
    }
}

TEST_CASE("Landau damping at three wave numbers" * doctest::description("physics")) {
    // k, amplitude, particles per cell, omega and gamma of the root
    struct Row {
        double k, amplitude;
        int particles_per_cell;
        double omega, gamma;
    };
    for (const Row& row : {Row{0.3, 1e-3, 16384, 1.15984648, 0.0126203684},
                           Row{0.4, 1e-3, 16384, 1.28505697, 0.0661279587},
                           Row{0.5, 5e-3, 8192, 1.41566189, 0.153359467}}) {
        CAPTURE(row.k);
        const Run r = run("landau", "landau",
                          "time.dt=0.1 species.electrons.amplitude=" + text(row.amplitude) +
                              " species.electrons.particles_per_cell=" +
                              std::to_string(row.particles_per_cell) + length_of(row.k));
        check_results(r, 3);
        CHECK(std::fabs(r.value("theory_omega") / row.omega - 1) <= 1e-7);
        CHECK(std::fabs(r.value("theory_growth") / row.gamma + 1) <= 1e-7);
        CHECK(std::fabs(r.value("omega_over_theory") - 1) <= 0.005);
        CHECK(std::fabs(r.value("damping_over_theory") - 1) <= 0.03);
    }
}

TEST_CASE("kinetic instabilities grow at the root of their dispersion relation" *
          doctest::description("physics")) {
    struct Row {
        const char* name;
        const char* overrides;
        int results;
    };
    for (const Row& row :
         {Row{"bump_on_tail", "time.end=60", 3}, Row{"weak_beam", "time.end=150", 3},
          Row{"buneman", "time.end=90", 3}, Row{"warm_two_stream", "time.end=40", 2}}) {
        CAPTURE(row.name);
        const Run r = run(row.name, row.name, row.overrides);
        check_results(r, row.results);
        CHECK(std::fabs(r.value("growth_over_theory") - 1) <= 0.05);
    }
}

TEST_CASE("warm streams need more than their thermal speed" * doctest::description("physics")) {
    const auto growth = [](double v0, double k) {
        return run("warm", "warm_two_stream",
                   "time.end=2 species.right.particles_per_cell=10 "
                   "species.left.particles_per_cell=10 species.right.drift_x=" +
                       text(v0) + " species.left.drift_x=" + text(-v0) + length_of(k))
            .value("theory_growth");
    };
    CHECK(std::fabs(growth(3, 0.2) - 0.2845097) <= 1e-6);
    // cut-off wave numbers, and the threshold 1.306930
    CHECK(growth(2, 0.529) > 0);
    CHECK(growth(2, 0.5293) <= 0);
    CHECK(growth(1.31, 0.04) > 0);
    CHECK(growth(1.30, 0.04) <= 0);
}

TEST_CASE("the law as the slide prints it grows at omega_p" * doctest::description("physics")) {
    const Run r = run("misprint", "misprint", "");
    check_results(r, 2);
    CHECK(std::fabs(r.value("theory_growth") - 1) <= 1e-9);
    CHECK(std::fabs(r.value("growth") - 1) <= 0.01);
    // As this mesh and this time step have it: (2/dt) asinh(cos(k dx/2) dt/2).
    const Run coarse =
        run("misprint", "misprint", "grid.cells_x=32 time.dt=0.1 theory.growth_tolerance=0.02");
    const double expected = 20 * std::asinh(0.05 * std::cos(pi / 32));
    CHECK(std::fabs(coarse.value("growth") / expected - 1) <= 1e-3);
}

TEST_CASE("the mesh heats most with ngp less with cic and least with tsc" *
          doctest::description("physics")) {
    const auto heating = [](const char* method, double debye_over_dx) {
        const Run r = run("heating", "thermal_heating",
                          std::string("method.weighting=") + method + " theory.growth_tolerance=1" +
                              " grid.length_x=" + text(64 / debye_over_dx));
        return r.value("kinetic_over_initial") - 1;
    };
    for (const double debye_over_dx : {0.1, 0.3183098861837907}) {
        CAPTURE(debye_over_dx);
        const double ngp = heating("ngp", debye_over_dx), cic = heating("cic", debye_over_dx),
                     tsc = heating("tsc", debye_over_dx);
        CHECK(ngp >= 8 * cic);
        CHECK(cic >= 8 * tsc);
        CHECK(tsc > 0);
        CHECK(heating("cic method.scheme=energy", debye_over_dx) <= 0.2 * cic);
    }
    // An unresolved plasma heats until its Debye length is about a third of a cell.
    CHECK(0.1 * std::sqrt(1 + heating("cic", 0.1)) >= 0.24);
    CHECK(0.1 * std::sqrt(1 + heating("cic", 0.1)) <= 0.32);
}

TEST_CASE("the mesh makes a cold beam unstable at the rate of its aliases" *
          doctest::description("physics")) {
    for (const std::string weighting : {"cic", "tsc"}) {
        CAPTURE(weighting);
        const Run r =
            run("grid_instability", "cold_beam_grid_instability", "method.weighting=" + weighting);
        check_results(r, 2);
        // The momentum scheme heats the beam but does not stop it.
        CHECK(std::fabs(r.conservation("momentum_x_change")) <= 1e-12);
        CHECK(r.column("kinetic").back() >= 1.5 * r.column("kinetic").front());
    }
}

TEST_CASE("the energy scheme is stable for fast beams and stops slow ones" *
          doctest::description("physics")) {
    const auto beam = [](const char* weighting, double u) {
        return run("threshold", "cold_beam_grid_instability",
                   std::string("method.scheme=energy species.beam.mode_x=31 theory.compare=none ") +
                       "time.dt=0.05 method.weighting=" + weighting +
                       " species.beam.drift_x=" + text(u));
    };
    const auto field_growth = [](const Run& r) {
        return largest(r.column("field")) / r.column("field").front();
    };
    // 1/12^(1/2) = 0.28868 with cic, 1/30^(1/2) = 0.18257 with tsc
    CHECK(field_growth(beam("cic", 0.28)) >= 1e8);
    CHECK(field_growth(beam("cic", 0.29)) <= 100);
    CHECK(field_growth(beam("tsc", 0.18)) >= 1e8);
    CHECK(field_growth(beam("tsc", 0.19)) <= 100);
    const Run slow = beam("cic", 0.1);
    CHECK(slow.column("momentum_x").back() <= 0.1 * slow.column("momentum_x").front());
    CHECK(largest(slow.column("energy_drift")) <= 0.01);
}

TEST_CASE("upper hybrid waves add the squares of two frequencies" *
          doctest::description("physics")) {
    for (const double B : {0.5, 1.0, 2.0}) {
        const double expected = std::sqrt(1 + B * B);
        const Run r = run(
            "upper_hybrid", "upper_hybrid",
            "time.dt=0.02 time.end=60 plasma.B_y=" + text(B) + " theory.near=" + text(expected));
        check_results(r, 2);
        CHECK(std::fabs(r.value("theory_omega") / expected - 1) <= 1e-9);
        CHECK(std::fabs(r.value("omega") / expected - 1) <= 0.002);
    }
}

TEST_CASE("a floating wall reaches the potential of theory" * doctest::description("physics")) {
    check_results(run("sheath", "sheath", ""), 2);
}

TEST_CASE("a sheath that has not settled is not measured and says what it needs" *
          doctest::description("physics")) {
    const std::string sentence = said("cic/cases/sheath.toml", "time.end=600");
    const Run r = facts::finished_run(facts::folder_of_test() + "/told");
    const auto& plasma = r.summary["results"]["plasma_potential"];
    INFO(plasma.dump());
    CHECK(plasma["verdict"] == "NOT MEASURED");
    // It falls by a half in 100, from -0.38 in the third quarter to -0.33 in the last.
    CHECK(std::fabs(plasma.value("error", 0.0) - 0.05) <= 0.015);
    CHECK(r.summary["results"]["collector_potential"]["verdict"] != "FAIL");
    // L (m_i/T_e)^(1/2) = 24 * 10.
    CAPTURE(sentence);
    CHECK(sentence.find("has not settled: ions cross the box in L (m_i/T_e)^1/2 = 240") !=
          std::string::npos);
    CHECK(sentence.find("raise time.end, 600, above 1200") != std::string::npos);
    check_results(run("settled", "sheath", "time.end=1200"), 2);
}

TEST_CASE("a diode below the limit of Child and Langmuir has its field at the cathode" *
          doctest::description("physics")) {
    // J = 400 < (4/9) 2^(1/2) 100^(3/2); E^2 = E_0^2 + 8^(1/2) J phi^(1/2) with v = (2 phi)^(1/2), and
    // the integral of d phi/E = 2 u du/E, u = phi^(1/2), is the length.
    const double J = 400, potential = 100;
    const auto length = [&](double E_0) {
        double sum = 0;
        const int parts = 20000;
        for (int k = 0; k < parts; ++k) {
            const double u = std::sqrt(potential) * (k + 0.5) / parts;
            sum += 2 * u / std::sqrt(E_0 * E_0 + std::sqrt(8.0) * J * u);
        }
        return sum * std::sqrt(potential) / parts;
    };
    double low = 0, high = potential;
    while (high - low > 1e-9) (length(0.5 * (low + high)) > 1 ? low : high) = 0.5 * (low + high);
    const std::string file = case_file(R"([grid]
cells_x = 60
length_x = 1
boundary_x = "wall"
[boundary]
particles_x_low = "source"
potential_x_high = 100
[time]
dt = 0.0005
end = 0.5
[species.electrons]
density = 0.64
emission = 400
emission_temperature = 1e-4
particles_per_cell = 1
loading = "random"
)");
    for (const std::string scheme : {"momentum", "energy"}) {
        for (const std::string weighting : {"cic", "tsc"}) {
            CAPTURE(scheme);
            CAPTURE(weighting);
            said(file, "method.scheme=" + scheme + " method.weighting=" + weighting);
            const Run r = facts::finished_run(facts::folder_of_test() + "/told");
            const auto& charge = r.column("charge_x_low");
            double mean = 0;
            const std::size_t half = charge.size() / 2;
            for (std::size_t n = half; n < charge.size(); ++n)
                mean += charge[n] / double(charge.size() - half);
            CHECK(std::fabs(mean / -low - 1) <= 0.02);
        }
    }
}

TEST_CASE("a charged layer winds up at the diocotron rate" * doctest::description("physics")) {
    check_results(run("diocotron", "diocotron",
                      "time.end=600 grid.cells_x=64 grid.cells_z=96 "
                      "species.electrons.particles_per_cell=36"),
                  1);
}

TEST_CASE("overlapping clouds of opposite charge swing harmonically" *
          doctest::description("physics")) {
    check_results(run("clouds", "cloud_collision",
                      "grid.cells_x=32 grid.cells_z=32 "
                      "grid.length_x=32 grid.length_z=32 "
                      "species.a.center_z=16.3 species.b.center_z=16.3"),
                  1);
}

TEST_CASE("two streams in the plane grow obliquely" * doctest::description("physics")) {
    for (const std::string stencil : {"five_point", "nine_point"}) {
        const Run r = run("plane", "two_stream_2d",
                          "time.end=30 grid.cells_x=64 grid.cells_z=32 method.stencil=" + stencil);
        check_results(r, 2);
    }
}

TEST_CASE("a start at E across B has the temperature of the species" *
          doctest::description("physics")) {
    const auto start = [](const char* temperature) {
        return run("across", "diocotron",
                   std::string(
                       "time.end=0.5 theory.compare=none species.electrons.temperature_x=") +
                       temperature + " species.electrons.temperature_z=" + temperature)
            .column("kinetic")
            .front();
    };
    // 32 electrons, T/2 for each of two directions.
    CHECK(std::fabs((start("100") - start("0")) / 3200 - 1) <= 1e-3);
    // Orbits of a tenth of the half width leave the rate as it is.
    check_results(run("warm", "diocotron",
                      "time.end=600 grid.cells_x=64 grid.cells_z=96 "
                      "species.electrons.particles_per_cell=36 species.electrons.temperature_x=4 "
                      "species.electrons.temperature_z=4"),
                  1);
}

TEST_CASE("thermal noise is that of the charges of all species without their drift" *
          doctest::description("physics")) {
    const std::string all =
        "grid.cells_x=40 grid.length_x=10 time.dt=0.1 time.end=400 "
        "species.electrons.loading=random species.electrons.particles_per_cell=200 ";
    const auto expected = [&](const std::string& others, double value) {
        CAPTURE(others);
        const Run r = run("noise", "thermal_heating", all + others);
        const double theory = r.summary["results"]["field_over_kinetic"]["expected"];
        CHECK(std::fabs(r.value("field_over_kinetic") / theory - 1) <= 0.15);
        CHECK(std::fabs(theory / value - 1) <= 0.02);
    };
    // One Maxwellian in two parts: sum (n_s q_s)^2/N_s is 3.025 times 1 / sum N_s.
    expected(
        "species.electrons.density=0.5 species.b.density=0.5 species.b.temperature_x=1 "
        "species.b.loading=random species.b.particles_per_cell=2000",
        3.025 * 4.11e-5);
    const std::string ions =
        "species.ions.motion=mobile species.ions.mass=4 species.ions.temperature_x=1 "
        "species.ions.loading=random species.ions.particles_per_cell=";
    expected(ions + "2000", 2.31e-4);
    // As many of both: 400 in a cell, the Debye length less by 2^1/2.
    const double l = 4 / std::sqrt(2.0);
    double equal = 0;
    for (int m = 1; m < 40; ++m) {
        const double C = std::cos(2 * pi * m / 40), A = (2 + C) / 3;
        equal += A / (A + (2 - 2 * C) * l * l) / (400 * 40);
    }
    expected(ions + "200", equal);
    check_results(run("quiet", "thermal_heating", ""), 1);
    const Run moving = run("moving", "thermal_heating", "species.electrons.drift_x=1");
    check_results(moving, 1);
    CHECK(std::fabs(moving.value("debye_length_over_dx") - 1) <= 0.01);
}

TEST_CASE("noise that is not thermal says why" * doctest::description("physics")) {
    const std::string heating = "cic/cases/thermal_heating.toml";
    says(said(heating, "time.end=100"), "takes long to come to it: raise time.end");
    says(said(heating, "time.end=100 species.electrons.loading=random"),
         "keep it: take loading = \"quiet\"");
}

TEST_CASE("a wave that grows slowly and long is one that grows" * doctest::description("physics")) {
    const std::string file = case_file(
        "[grid]\ncells_x = 128\nlength_x = 6.283185307179586\n[time]\ndt = 0.1\nend = 5400\n"
        "[species.ions]\ncharge = 1\ndensity = 1.0000000014\nmotion = \"fixed\"\n"
        "[species.e]\nloading = \"lattice\"\nparticles_per_cell = 2\namplitude = 1e-8\n"
        "[species.b]\ndensity = 1.4e-9\ndrift_x = 1\nloading = \"lattice\"\n"
        "particles_per_cell = 2\n[theory]\ncompare = \"wave\"\n");
    const Run r = facts::run_into("slow", "cic", file);
    // A weak cold beam in resonance: 3^1/2 / 2^4/3 n_b^1/3
    CHECK(std::fabs(r.value("theory_growth") / (0.687365 * std::cbrt(1.4e-9)) - 1) <= 1e-3);
    CHECK(!r.summary["results"].contains("largest_over_start"));
    CHECK(r.summary["results"]["onset"]["verdict"] == "PASS");
    CHECK(r.summary["results"]["omega_over_theory"]["verdict"] == "PASS");
    // In a time in which it could grow to exp(1.15) it may.
    const Run early = facts::run_into("slow_early", "cic", file + " time.end=1500");
    CHECK(std::fabs(early.summary["results"]["largest_over_start"].value("at_most", 0.0) /
                        (1.2 * std::exp(1500 * r.value("theory_growth"))) -
                    1) <= 1e-6);
}

TEST_CASE("a wave that another one of its mode covers is not measured" *
          doctest::description("physics")) {
    const std::string file = case_file(
        "[grid]\ncells_x = 64\nlength_x = 6.283185307179586\n[time]\ndt = 0.05\nend = 40\n"
        "[species.a]\ndensity = 0.5\ndrift_x = 0.6\namplitude = 1e-6\n"
        "[species.b]\ndensity = 0.5\ndrift_x = -0.6\n"
        "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n[theory]\ncompare = \"wave\"\n");
    const Run covered = facts::run_into("covered", "cic", file + " theory.near=1.36");
    CHECK(std::fabs(covered.value("theory_omega") - 1.3583) <= 1e-3);
    const auto& result = covered.summary["results"]["largest_over_start"];
    CHECK(result["verdict"] == "NOT MEASURED");
    CHECK(result["source"].get<std::string>().starts_with(
        "another wave of this mode grows, with 0.35"));
    const Run grows = facts::run_into("grows", "cic", file + " theory.near=0.1");
    CHECK(std::fabs(grows.value("theory_growth") - 0.3534) <= 1e-3);
    CHECK(!grows.summary["results"].contains("largest_over_start"));
}

TEST_CASE("an onset that noise brings or the perturbation hides is not measured" *
          doctest::description("physics")) {
    const auto onset = [](const std::string& file, const std::string& overrides) {
        return run("onset", file, overrides).summary["results"]["onset"].dump();
    };
    const auto streams = [&](const std::string& A) {
        return onset("warm_two_stream",
                     "time.end=60 species.right.particles_per_cell=256 "
                     "species.left.particles_per_cell=256 species.right.amplitude=" +
                         A + " species.left.amplitude=" + A);
    };
    says(streams("1e-8"), "noise starts the wave: it begins with");
    says(streams("1e-3"), "PASS");
    says(onset("bump_on_tail", "time.end=60 species.bulk.amplitude=0.003"),
         "of it is the growing wave: lower the amplitude 1.26 times or more");
}

TEST_CASE("a slow wave that noise covers is not measured and another one is not taken for it" *
          doctest::description("physics")) {
    // Ions before electrons that drift, slower than their heat: it grows by exp(1.5), noise is above.
    const std::string drifting = case_file(
        "[grid]\ncells_x = 32\nlength_x = 15.707963267948966\n[time]\ndt = 0.2\nend = 300\n"
        "[species.e]\ntemperature_x = 1\ndrift_x = 0.35\nparticles_per_cell = 1000\n"
        "[species.i]\ncharge = 1\nmass = 100\ntemperature_x = 0.02\n"
        "particles_per_cell = 1000\n[theory]\ncompare = \"wave\"\n");
    for (const char* start : {"species.i.amplitude=1e-3", "species.i.amplitude=1.36e-6",
                              "species.i.amplitude=1e-3 species.e.drift_x=-0.35"}) {
        const std::string told = said(drifting, std::string(start) + " plasma.seed=2");
        for (const char* name : {"growth", "omega"})
            says(told, std::string("NOT MEASURED ") + name +
                           "_over_theory: the noise of particles comes to 0.0");
        CHECK(told.find("FAIL") == std::string::npos);
        CHECK(told.find("lower the amplitude") == std::string::npos);
    }
    // A damped one, of which there are fewer than three periods: plasma waves ring in the noise.
    for (const char* start : {"plasma.seed=1 species.ions.amplitude=1e-4",
                              "plasma.seed=2 species.ions.amplitude=1e-3"}) {
        const std::string told = said("cic/cases/ion_acoustic.toml",
                                      std::string(start) +
                                          " time.end=150 species.ions.particles_per_cell=200 "
                                          "species.electrons.particles_per_cell=200 "
                                          "species.electrons.amplitude=0.003");
        says(told,
             "NOT MEASURED omega_over_theory: cannot be measured, because the wave of theory "
             "has 1.635 periods");
        CHECK(told.find("FAIL") == std::string::npos);
    }
}

TEST_CASE("a damped wave in which particles bounce is to be made smaller" *
          doctest::description("physics")) {
    const std::string told = run("bounce", "landau",
                                 "species.electrons.particles_per_cell=1024 "
                                 "species.electrons.amplitude=0.2")
                                 .summary["results"]["damping_over_theory"]
                                 .dump();
    says(told, "faster than the rate 0.1534, and linear theory does not hold: lower the amplitude");
    says(told, "of it");
}

TEST_CASE("what round-off and noise alone begin is no wave" * doctest::description("physics")) {
    const std::string rest =
        "[grid]\nlength_x = 6.283185307179586\ncells_x = 64\n[time]\nend = 400\n"
        "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n[species.e]\n"
        "loading = \"lattice\"\n[theory]\ncompare = \"wave\"\n";
    for (const std::string warm :
         {"",
          " grid.length_x=12.566370614359172 time.end=40 species.e.loading=quiet "
          "species.e.temperature_x=1 species.e.particles_per_cell=1024"}) {
        const Run r = facts::run_into("rest", "cic", case_file(rest) + warm);
        for (const char* name : {"largest_over_start", "omega_over_theory"})
            says(r.summary["results"][name].dump(), "no species is perturbed in this mode");
        CHECK(!r.summary["results"].contains("omega"));
    }
}

TEST_CASE("a cold plasma between walls rests in the energy scheme alone" *
          doctest::description("physics")) {
    const std::string rest = case_file(
        "[grid]\nlength_x = 4\ncells_x = 16\nboundary_x = \"wall\"\n[boundary]\n"
        "particles_x_low = \"reflect\"\nparticles_x_high = \"reflect\"\n[time]\ndt = 0.05\n"
        "end = 48\n[species.ions]\ncharge = 1\nmotion = \"fixed\"\n[species.e]\n"
        "loading = \"lattice\"\ndrift_x = 1e-8\nparticles_per_cell = 8\n");
    // In the momentum scheme displacements x_c of the cells obey  x'' = <x> 1 - K x,  K tridiagonal
    // with 1/4, 1/2, 1/4 (units of omega_p): one eigenvalue is positive.
    Eigen::MatrixXd A = Eigen::MatrixXd::Constant(16, 16, 1.0 / 16);
    for (Eigen::Index c = 0; c < 16; ++c) {
        A(c, c) -= 0.5;
        if (c > 0) A(c, c - 1) -= 0.25, A(c - 1, c) -= 0.25;
    }
    const double rate =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues().maxCoeff());
    CHECK(std::fabs(rate / 0.2213126 - 1) <= 1e-6);
    const Run r = facts::run_into("momentum", "cic", rest);
    const auto at = [&](double t) {
        const auto times = r.column("time"), field = r.column("field");
        return field[std::size_t(std::ranges::lower_bound(times, t - 1e-9) - times.begin())];
    };
    CHECK(std::fabs(std::log(at(46) / at(36)) / 20 / rate - 1) <= 0.01);
    CHECK(r.summary["results"]["energy_change"]["verdict"] == "FAIL");
    for (const char* weighting : {" method.weighting=cic", " method.weighting=tsc"}) {
        const Run kept =
            facts::run_into("energy", "cic", rest + " method.scheme=energy" + weighting);
        const auto energy = kept.column("energy");
        CHECK(std::ranges::max(energy) <= 1.01 * energy.front());
        CHECK(energy.front() <= 1e-8);
    }
}

TEST_CASE("a mesh that brakes or heats a plasma in which nothing happens is a result" *
          doctest::description("physics")) {
    const std::string drifting = case_file(
        "[grid]\nlength_x = 64\ncells_x = 64\n[time]\ndt = 0.1\nend = 200\n"
        "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n[species.e]\n"
        "temperature_x = 0.01\ndrift_x = 0.2\nloading = \"random\"\n");
    const std::string braked = said(drifting, "method.scheme=energy");
    says(braked, "FAIL momentum_change");
    says(braked, "the energy-conserving mesh brakes what moves through it");
    says(braked, "FAIL kinetic_over_initial_e");
    says(braked, "a random start has more noise than equilibrium");
    // B along the drift changes none of this.
    const std::string along = said(drifting, "method.scheme=energy plasma.B_x=1");
    says(along, "FAIL momentum_change");
    const Run kept = facts::run_into("kept", "cic", drifting);
    CHECK(!kept.summary["results"].contains("momentum_change"));
    // Ions that the mesh heats, beside electrons that it resolves.
    const std::string cold_ions = case_file(
        "[grid]\nlength_x = 64\ncells_x = 64\n[time]\ndt = 0.2\nend = 400\n[species.e]\n"
        "temperature_x = 1\n[species.ions]\ncharge = 1\nmass = 100\ntemperature_x = 0.01\n");
    const Run heated = facts::run_into("heated", "cic", cold_ions);
    const auto verdict = [&](const std::string& name) {
        return heated.summary["results"][name]["verdict"];
    };
    CHECK(verdict("kinetic_over_initial_e") == "PASS");
    CHECK(verdict("kinetic_over_initial_ions") == "FAIL");
    CHECK(verdict("energy_change") == "PASS");
}

TEST_CASE("a slow drift and a cold wave that the energy-conserving mesh takes are results" *
          doctest::description("physics")) {
    // Most of a drift of 0.03 v_th is lost, and little beside the thermal momentum.
    const std::string slow = case_file(
        "[grid]\nlength_x = 192\ncells_x = 64\n[time]\ndt = 0.2\nend = 1000\nenergy_limit = 0\n"
        "[species.e]\ntemperature_x = 1\nparticles_per_cell = 128\ndrift_x = 0.03\n"
        "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n");
    says(said(slow, "method.scheme=energy"), "FAIL momentum_change");
    CHECK(!facts::run_into("slow", "cic", slow).summary["results"].contains("momentum_change"));
    const std::string wave = case_file(
        "[grid]\nlength_x = 6.283185307179586\ncells_x = 64\n[time]\ndt = 0.1\nend = 300\n"
        "[method]\nscheme = \"energy\"\n[species.e]\nparticles_per_cell = 512\namplitude = 0.01\n"
        "loading = \"lattice\"\n[species.ions]\ncharge = 1\nmotion = \"fixed\"\n"
        "[theory]\ncompare = \"wave\"\n");
    const std::string dies = said(wave, "");
    says(dies, "FAIL damping = 0.006");
    says(dies, "lower the amplitude, or give it a temperature");
    for (const char* cure : {"amplitude=1e-3", "temperature_x=0.001 species.e.loading=quiet"})
        CHECK(said(wave, "species.e." + std::string(cure)).find("FAIL") == std::string::npos);
}

TEST_CASE("energy is judged between walls at a potential less what the battery gives" *
          doctest::description("physics")) {
    const std::string walls = case_file(
        "[grid]\nlength_x = 64\ncells_x = 64\nboundary_x = \"wall\"\n"
        "[boundary]\nparticles_x_low = \"reflect\"\nparticles_x_high = \"reflect\"\n"
        "potential_x_high = 10\n[method]\nscheme = \"energy\"\n[time]\ndt = 0.02\nend = 20\n"
        "[species.e]\ntemperature_x = 1\nparticles_per_cell = 500\n"
        "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n");
    const Run swings = facts::run_into("swings", "cic", walls);
    const auto energy = swings.column("energy");
    CHECK(std::ranges::max(energy) > 2 * energy.front());
    CHECK(swings.value("energy_change") < 0.005);
    const std::string heats =
        said(walls,
             "boundary.potential_x_high=1e-3 method.scheme=momentum time.end=3000 "
             "time.dt=0.2 species.e.particles_per_cell=4");
    says(heats, "FAIL energy_change");
}

TEST_CASE("a mode that is not there loosens no bound and a mirror image changes no verdict" *
          doctest::description("physics")) {
    const std::string rest = case_file(
        "[grid]\nlength_x = 64\ncells_x = 64\n[time]\ndt = 0.2\nend = 300\n[species.e]\n"
        "temperature_x = 1\nparticles_per_cell = 4\nmode_x = 31\namplitude = 0.001\n"
        "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n[theory]\nmode_x = 31\n");
    const Run r = facts::run_into("bound", "cic", rest);
    CHECK(double(r.summary["results"]["energy_change"]["at_most"]) == 0.05);
    for (const char* drift : {"5", "-5"}) {
        const Run moves = facts::run_into(
            "moves", "cic",
            "cic/cases/landau.toml species.electrons.drift_x=" + std::string(drift));
        check_results(moves, 3);
    }
}

TEST_CASE("modes that grow beside the one that is followed are named" *
          doctest::description("physics")) {
    // v0 k = 1.2 is above the cut-off, 0.4 and 0.8 are below.
    const std::string stream =
                          "density = 0.5\ntemperature_x = 0.01\nparticles_per_cell = 500\n"
                          "mode_x = 3\namplitude = 0.01\n",
                      box = case_file(
                          "[grid]\nlength_x = 15.707963267948966\ncells_x = 128\n"
                          "[time]\nend = 80\n[species.right]\ndrift_x = 1\n" +
                          stream + "[species.left]\ndrift_x = -1\n" + stream +
                          "[species.ions]\ncharge = 1\nmotion = \"fixed\"\n"
                          "[theory]\ncompare = \"wave\"\nmode_x = 3\n");
    says(said(box, ""), "NOT MEASURED largest_over_start: mode (2, 0) of this box grows with 0.3");
}

TEST_CASE("what falls short names what cures it" * doctest::description("physics")) {
    says(said("cic/cases/plasma_wave.toml",
              "theory.model=plasma theory.frequency_tolerance=0.005 grid.cells_x=64 time.dt=0.02"),
         "k dx is 0.3927, and the mesh changes the wave by 1 - cos(k dx/2) = 0.01921");
    // The mesh lowers a frequency by what particles that bounce do not; the rate they do change.
    const std::string langmuir = case_file(
        "[grid]\ncells_x = 16\nlength_x = 9.973310011396169\n[time]\nend = 40\n"
        "[species.e]\ntemperature_x = 0.25\nparticles_per_cell = 4000\namplitude = 0.01\n"
        "[species.i]\ncharge = 1\nmotion = \"fixed\"\n[theory]\ncompare = \"wave\"\n");
    const std::string coarse = said(langmuir, "");
    says(coarse, "FAIL omega_over_theory = 0.98");
    says(coarse, "; k dx is 0.3927, and the mesh changes the wave by 1 - cos(k dx/2) = 0.01921");
    says(coarse, "larger than the tolerance, 0.01; particles bounce in the wave");
    CHECK(said(langmuir, "grid.cells_x=48").find("FAIL omega") == std::string::npos);
    // The noise of a quiet start above its seed.
    says(said("cic/cases/bump_on_tail.toml", "species.bulk.amplitude=1e-6"),
         "noise starts the wave");
    // 8 (T_e / n_P e^2)^1/2 of the plasma, n_P = 0.1353 / 0.579.
    says(said("cic/cases/sheath.toml", "grid.length_x=6 grid.cells_x=24 time.end=1000"),
         "raise grid.length_x, 6, above 8 Debye lengths of the plasma, 16.55");
    // Whatever else, it has not settled.
    says(said("cic/cases/sheath.toml", "grid.length_x=12 grid.cells_x=24 time.end=30"),
         "; the sheath has not settled: ions cross the box in L (m_i/T_e)^1/2 = ");
    // What a source emits and no wall takes, and with a wall that takes it.
    const std::string diode = case_file(
        "[grid]\ncells_x = 16\nlength_x = 1\nboundary_x = \"wall\"\n[time]\ndt = 0.02\n"
        "end = 10\n[boundary]\npotential_x_high = -20\nparticles_x_low = \"source\"\n"
        "[species.e]\ndensity = 0.01\nemission = 1\nemission_temperature = 0.01\n"
        "particles_per_cell = 1\n");
    says(said(diode, ""),
         "warning: e: of 1.6e+04 particles from the source 1.6e+04 are in the box");
    CHECK(said(diode, "boundary.potential_x_high=20").empty());
    // Heat of the step, which no mesh cures, and of reflection from walls with a field.
    const std::string rest =
        "[grid]\ncells_x = 64\nlength_x = 16\n[time]\ndt = 1.5\nend = 600\n[species.e]\n"
        "temperature_x = 1\nparticles_per_cell = 64\n[species.i]\ncharge = 1\n"
        "motion = \"fixed\"\n";
    const std::string hot = said(case_file(rest), "");
    says(hot, "neither heats nor cools); omega_p dt is 1.5, and the leapfrog heats what swings");
    CHECK(said(case_file(rest), "time.dt=0.4").empty());
    const std::string walls =
        " grid.boundary_x=wall boundary.particles_x_low=reflect "
        "boundary.particles_x_high=reflect boundary.potential_x_high=8 "
        "time.end=100";
    says(said(case_file(rest), "time.dt=0.05" + walls),
         "; walls that have a field reflect particles to first order in the step: lower time.dt");
    CHECK(said(case_file(rest), "time.dt=0.0125" + walls).empty());
    // Of 128 cells along x eight are left.
    says(said("cic/cases/diocotron.toml", "grid.cells_x=8 theory.growth_tolerance=0.01"),
         "raise grid.cells_x");
    const std::string landau = said("cic/cases/landau.toml",
                                    "species.electrons.particles_per_cell=256 "
                                    "species.electrons.amplitude=1e-3");
    says(landau, "what hides it is noise: raise the amplitude or particles_per_cell");
    says(landau, "the error, 1.238, is larger than the tolerance, 0.03;");
    // Electrons of two temperatures have two waves.
    says(said(case_file("[grid]\ncells_x = 128\nlength_x = 20\n[time]\nend = 40\n"
                        "[species.cold]\ndensity = 0.8\ntemperature_x = 0.04\n"
                        "particles_per_cell = 2000\n[species.hot]\ndensity = 0.2\n"
                        "temperature_x = 4\nparticles_per_cell = 2000\namplitude = 0.02\n"
                        "[species.ions]\nmotion = \"fixed\"\ncharge = 1\n"
                        "[theory]\ncompare = \"wave\"\n"),
              ""),
         "another wave of this mode, omega = 0.3666, growth = -0.2803, decays hardly faster");
    says(said("cic/cases/bernstein.toml", "theory.near=2.6"),
         "what was measured is another wave of this mode, omega = 2.012: take theory.near = 2.012");
    // A cold plasma that moves: right until the mesh drives it, and with the cure.
    const std::string moves = "species.electrons.drift_x=1";
    says(said("cic/cases/plasma_wave.toml", moves),
         "and <= 1.2 is expected (no growing root); aliases "
         "drive waves of two or three cells");
    for (const char* cure : {" method.scheme=energy", " time.end=60"}) {
        const Run run =
            facts::run_into("moves", "cic", "cic/cases/plasma_wave.toml " + moves + cure);
        CHECK(run.summary["results"]["omega_over_theory"]["verdict"] == "PASS");
    }
    says(said("cic/cases/sheath.toml", "time.dt=1.8 time.end=1800"),
         "omega_p dt of the electrons is 0.87, and thermal ones cross 7.2 cells in it: lower "
         "time.dt");
    says(said("cic/cases/plasma_wave.toml", "time.dt=0.02 method.weighting=ngp"),
         "displaced by less than their distance keep their nearest node");
    says(said("cic/cases/warm_two_stream.toml",
              "species.right.amplitude=0 species.left.amplitude=0 species.right.loading=random "
              "species.right.particles_per_cell=256 species.left.particles_per_cell=256"),
         "growth is over then: raise particles_per_cell, so that noise starts it lower");
}

TEST_CASE("a wave is judged where its plasma has no drift" * doctest::description("physics")) {
    const std::string wave = case_file(
        "[grid]\ncells_x = 32\nlength_x = 12.566370614359172\n[time]\ndt = 0.1\nend = 60\n"
        "[species.e]\ntemperature_x = 0.04\nparticles_per_cell = 800\namplitude = 0.01\n"
        "[species.i]\ncharge = 1\nmotion = \"fixed\"\n[theory]\ncompare = \"wave\"\n");
    const std::string fast = "time.dt=0.01 method.weighting=tsc species.e.drift_x=40 ",
                      coarse = said(wave, fast + "grid.cells_x=8");
    // 0.5 % of 1.03 at omega = 21.
    says(coarse, "1 +- 0.0002");
    says(coarse, "; k dx is 0.7854, and the mesh changes the wave by 1 - cos(k dx/2) = 0.07612");
    const Run fine = facts::run_into("fine", "cic", wave + " " + fast + "grid.cells_x=64");
    for (const char* name : {"omega_over_theory", "damping"})
        CHECK(fine.summary["results"][name]["verdict"] == "PASS");
    CHECK(std::fabs(fine.value("damping")) < 1e-4);
    const std::string low = "species.e.drift_x=1.4 theory.near=-0.3 time.end=100";
    says(said(wave, low), "; k dx is 0.1963, and the mesh changes the wave by 0.0155");
    CHECK(said(wave, low + " grid.cells_x=64").empty());
    says(said(wave, "method.scheme=energy method.weighting=tsc grid.cells_x=8"),
         "; k dx is 0.7854, and the mesh changes the wave by 1 - sinc(k dx/2)^order = 0.050");
    says(said(wave, "species.e.amplitude=1e-6"),
         "NOT MEASURED largest_over_start: noise covers the perturbation: particles come to 0.00");
}

TEST_CASE("a wave that runs backward has a negative frequency" * doctest::description("physics")) {
    const Run r = run("backward", "plasma_wave",
                      "species.electrons.drift_x=-3 theory.model=plasma time.end=40 "
                      "theory.frequency_tolerance=0.1");
    CHECK(r.value("theory_omega") < 0);
    CHECK(std::fabs(r.value("omega") / r.value("theory_omega") - 1) <= 0.1);
}

TEST_CASE("a particles file says of what time its velocities are" *
          doctest::description("physics")) {
    // Half of the first kick lies before: v = dt/2 E_x at t = 0, q/m = -1.
    const std::string folder = facts::folder_of_test() + "/times",
                      command = std::string(BUILD_FOLDER) +
                                "/cic cic/cases/plasma_wave.toml time.end=2 "
                                "output.particles_interval=2 --out " +
                                folder + " --force --quiet 2> /dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    const auto third_line = [&](const std::string& name) {
        std::ifstream file(folder + name);
        std::string line;
        for (int n = 0; n < 3; ++n) std::getline(file, line);
        return line;
    };
    says(third_line("/particles_000000.dat"), "# time 0 step 0 particles 2048 velocities at -0.1");
    says(third_line("/particles_000010.dat"), "# time 2 step 10 particles 2048 velocities at 1.9");
}
