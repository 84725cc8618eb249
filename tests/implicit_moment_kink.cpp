// Facts about the kink of a thin current sheet and the level of the instability before it: what the
// program makes of records whose answer is known, and of the quick runs of figure 14.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "implicit_moment/theory/compare_kink.hpp"
#include "tests/support/any_numbers.hpp"
#include "tests/support/any_summary.hpp"
#include "tests/support/folder_of_test.hpp"

namespace {

using namespace facts;
using namespace implicit_moment;

std::string room(const std::string& name) {
    const std::string folder = facts::folder_of_test() + "/kink_" + name;
    std::filesystem::create_directories(folder);
    return folder;
}

// Two phases: noise that grows at `first` until it saturates at 0.01, and from t = 10 on a kink
// that grows at `second` until it saturates at 0.3. The ripple is a part of the amplitude.
struct Record {
    std::vector<double> times, amplitude;

    Record(double first, double second, double ripple, double end = 110) {
        for (long n = 0; n <= std::lround(end / 0.05); ++n) {
            const double t = 0.05 * real(n);
            const double before = std::min(1e-4 * std::exp(first * t), 0.01);
            const double after = std::min(0.01 * std::exp(second * (t - 10)), 0.3);
            times.push_back(t);
            amplitude.push_back((t < 10 ? before : after) * (1 + ripple * std::sin(1.7 * t)));
        }
    }
};

// What the program says about a record of a sheet.
nlohmann::json results(const CurrentSheetCase& sheet, const Record& record) {
    Case parameters;
    parameters.current_sheet = sheet;
    common::History history(room("record") + "/history.dat");
    history.columns({{{"time_Omega_ci", ""},
                      {"energy_drift", ""},
                      {"B_1", ""},
                      {"B_4", ""},
                      {"displacement_1", ""}},
                     {}});
    for (std::size_t n = 0; n < record.times.size(); ++n) {
        const double a = record.amplitude[n];
        history.row(std::vector<double>{record.times[n], 0, a, 0.005, 2 * a});
    }
    common::Summary summary;
    compare_kink(parameters, history, summary);
    const std::string path = room("record") + "/summary.json";
    summary.write(path, {"p", "1", "", ""}, "c", 0, "m");
    std::ifstream file(path);
    return nlohmann::json::parse(file)["results"];
}

CurrentSheetCase sheet_of(double temperature_ratio, double length = 2) {
    CurrentSheetCase sheet;
    sheet.temperature_ratio = temperature_ratio, sheet.length_x = length;
    return sheet;
}

}  // namespace

TEST_CASE("an exponential out of a level is found whatever was before and follows") {
    for (const double second : {0.04, 0.07, 0.1, 0.2}) {
        for (const double first : {0.0, 0.5, 2.5}) {
            CAPTURE(first);
            CAPTURE(second);
            const double length = std::log(20.0) / second;
            Record record(first, 0, 0);
            for (std::size_t n = 0; n < record.times.size(); ++n) {
                const double t = record.times[n];
                if (t >= 10) {
                    record.amplitude[n] = 0.01 * std::exp(second * std::clamp(t - 20, 0.0, length) +
                                                          0.2 * (first - 1) * second *
                                                              std::max(t - 20 - length, 0.0));
                }
            }
            const Ramp fit = fit_ramp(record.times, record.amplitude, second_phase);
            REQUIRE(fit.reason.empty());
            CHECK(std::fabs(fit.growth.value / second - 1) <= 0.005);
            CHECK(std::fabs(fit.begin - 20) <= 0.5);  // one of 200 parts
            CHECK(std::fabs(fit.end - 20 - length) <= 0.5);
            CHECK(std::fabs(fit.height / 0.01 - 1) <= 0.005);
        }
    }
}

TEST_CASE("of ten noisy rises the rates of nine are nearer than their errors") {
    // Noise of 15 per cent that forgets within 0.5 to 2 units of time.
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    int within = 0, measured = 0;
    double bias = 0, error = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const double rate = 0.03 + 0.01 * (trial / 3 % 10), begin = 10 + 4 * (trial % 7),
                     memory = std::exp(-0.05 / (trial % 3 == 0 ? 2 : 0.5));
        Record record(0, 0, 0);
        double noise = 0;
        for (std::size_t n = 0; n < record.times.size(); ++n) {
            noise = memory * noise + 0.15 * std::sqrt(1 - memory * memory) * normal(random);
            record.amplitude[n] =
                0.02 * std::exp(std::clamp(rate * (record.times[n] - begin), 0.0, 1.5) + noise);
        }
        const Ramp fit = fit_ramp(record.times, record.amplitude, second_phase);
        if (!fit.reason.empty()) continue;
        measured += 1, bias += fit.growth.value / rate - 1, error += fit.growth.error / rate;
        within += std::fabs(fit.growth.value - rate) <= fit.growth.error;
    }
    CHECK(measured >= 95);
    CHECK(within >= 0.9 * measured);
    CHECK(std::fabs(bias) <= 0.05 * measured);
    CHECK(error <= 0.5 * measured);  // and the errors are not so large for nothing
}

TEST_CASE("a record without a second phase has no growth there") {
    const Record flat(2.5, 0, 0.2), decaying(2.5, -0.05, 0.2);
    CHECK_FALSE(fit_ramp(flat.times, flat.amplitude, 10).reason.empty());
    CHECK_FALSE(fit_ramp(decaying.times, decaying.amplitude, 10).reason.empty());
    CHECK_FALSE(fit_ramp(flat.times, flat.amplitude, 110).reason.empty());
}

TEST_CASE("a level is exact for a constant and a square that is linear between uneven rows") {
    const std::vector<double> times{0, 3, 10, 11, 14, 20};
    std::vector<double> constant, root;
    for (const double t : times) {
        constant.push_back(t < 10 ? 7 : 0.003);
        root.push_back(t < 10 ? 7 : std::sqrt(t));
    }
    CHECK(std::fabs(level_after(times, constant, 10).value - 0.003) <= 8 * eps * 0.003);
    CHECK(std::fabs(level_after(times, root, 10).value - std::sqrt(15.0)) <= 8 * eps * 4);
    // Of 10.5 to 20 the rows know 11 to 20.
    CHECK(std::fabs(level_after(times, root, 10.5).value - std::sqrt(15.5)) <= 8 * eps * 4);
    CHECK(std::isnan(level_after(times, root, 20).value));
}

TEST_CASE("a sheet of the talk is compared with its figure and another sheet with nothing") {
    const Record record(2.5, 0.1, 0);
    const auto four = results(sheet_of(4), record), one = results(sheet_of(1), record);
    CHECK(std::fabs(four["kink_growth"]["value"].get<double>() - 0.1) <= 1e-3);
    CHECK(std::fabs(four["kink_growth_of_displacement"]["value"].get<double>() - 0.1) <= 1e-3);
    CHECK(std::fabs(four["lhdi_level"]["value"].get<double>() - 0.005) <= 1e-9);
    CHECK(std::fabs(four["kink_largest"]["value"].get<double>() - 0.6) <= 1e-9);
    CHECK(four["kink_growth"]["pass"] == true);
    CHECK(four["lhdi_level"]["pass"] == true);
    // Linear theory stands beside it and judges nothing.
    CHECK(std::fabs(one["kink_theory_growth"]["value"].get<double>() - 0.07) <= 0.02);
    CHECK(std::fabs(four["kink_theory_growth"]["value"].get<double>() - 0.11) <= 0.02);
    CHECK_FALSE(one["kink_theory_growth"].contains("pass"));
    // More than twice 0.04 and 1.5e-3.
    CHECK(one["kink_growth"]["pass"] == false);
    CHECK(one["lhdi_level"]["pass"] == false);
    CurrentSheetCase light = sheet_of(4);
    light.mass_ratio = 100;
    for (const CurrentSheetCase& other : {sheet_of(3), sheet_of(4, 8), light}) {
        const auto said = results(other, record);
        CHECK(std::fabs(said["kink_growth"]["value"].get<double>() - 0.1) <= 1e-3);
        CHECK_FALSE(said["kink_growth"].contains("pass"));
        CHECK_FALSE(said["lhdi_level"].contains("pass"));
    }
}

TEST_CASE("a record that ends in the first phase is not compared") {
    CHECK(results(sheet_of(4), Record(2.5, 0.1, 0, 39)).empty());
    CHECK_FALSE(results(sheet_of(4), Record(2.5, 0.1, 0, 40)).empty());
}

TEST_CASE("what is kept of ten short sheets draws figures 11 and 13 to 15" *
          doctest::description("long")) {
    const std::string runs = room("runs"), kept = room("kept");
    const auto run = [](const std::string& command) {
        CAPTURE(command);
        CHECK(std::system(command.c_str()) == 0);
    };
    run("sh implicit_moment/figures/thin_sheets.sh " BUILD_FOLDER "/implicit_moment " + runs +
        " 1680 time.dt=0.8 current_sheet.particles=4000 grid.cells_z=24"
        " output.profile_interval=20 field.theta=1 > " +
        runs + "/said 2>&1");
    run("sh implicit_moment/data/keep_thin_sheets.sh " + runs + " " + kept);
    // Nine runs with their verdicts, of which noise makes what it likes; levels are always there.
    std::ifstream table(kept + "/thin_sheet_runs.csv");
    int rows = 0;
    for (std::string line; std::getline(table, line);) {
        if (line.starts_with("#")) continue;
        std::vector<std::string> words;
        std::istringstream row(line);
        for (std::string word; std::getline(row, word, ',');) words.push_back(word);
        REQUIRE(words.size() == 12);
        CHECK(std::stod(words[2]) == 42);
        CHECK(std::stod(words[9]) > 0);
        CHECK(std::stod(words[10]) > 0);
        ++rows;
    }
    CHECK(rows == 9);
    for (const std::string figure : {"fig11", "fig13", "fig14", "fig15"}) {
        for (const std::string& from : {kept, std::string("implicit_moment/data")}) {
            const std::string picture = kept + "/" + figure + ".png";
            run("gnuplot -e \"out='" + picture + "'; kept='" + from +
                "'\" implicit_moment/figures/" + figure + ".gp 2> " + kept + "/" + figure);
            CHECK(std::filesystem::file_size(picture) > 20000);
        }
    }
}
