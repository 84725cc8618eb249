// Facts about the kink of a thin current sheet and the level of the instability before it: what the
// program makes of records whose answer is known, and of the quick runs of figure 14.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
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

// Two phases: noise that grows at `first` until it saturates at 0.01, and from t = 10 on a kink that
// grows at `second` until it saturates at 0.3. The ripple is a part of the amplitude.
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
    history.columns({{"time_Omega_ci", ""},
                     {"energy_drift", ""},
                     {"B_1", ""},
                     {"B_4", ""},
                     {"displacement_1", ""}});
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

CurrentSheetCase sheet_of(double temperature_ratio, double length = 4) {
    CurrentSheetCase sheet;
    sheet.temperature_ratio = temperature_ratio, sheet.length_x = length;
    return sheet;
}

}  // namespace

TEST_CASE("the growth of the second phase is that of an exponential whatever was before") {
    for (const double second : {0.04, 0.07, 0.1, 0.2}) {
        for (const double first : {0.0, 0.5, 2.5}) {
            CAPTURE(first);
            CAPTURE(second);
            const Record record(first, second, 0);
            const auto fit = second_growth(record.times, record.amplitude, second);
            REQUIRE(fit.found);
            CHECK(std::fabs(fit.growth() / second - 1) <= 1e-9);
            CHECK(fit.begin >= second_phase);
            CHECK(fit.end <= 10 + std::log(0.7 * 30) / second);
        }
    }
}

TEST_CASE("the growth of the second phase withstands ripples of a fifth of the amplitude") {
    for (const double second : {0.04, 0.07, 0.1}) {
        CAPTURE(second);
        const Record record(1, second, 0.2);
        const auto fit = second_growth(record.times, record.amplitude, second);
        REQUIRE(fit.found);
        CHECK(std::fabs(fit.growth() / second - 1) <= 0.1);
    }
}

TEST_CASE("a record without a second phase has no growth there") {
    const Record record(2.5, 0, 0.2);
    const auto level = second_growth(record.times, record.amplitude, 0.1);
    CHECK(!(level.found && level.growth() > level.growth_error()));
    const Record decaying(2.5, -0.05, 0.2);
    const auto decay = second_growth(decaying.times, decaying.amplitude, 0.1);
    CHECK(!(decay.found && decay.growth() > decay.growth_error()));
}

TEST_CASE("a level is exact for a constant and a square that is linear between uneven rows") {
    const std::vector<double> times{0, 3, 10, 11, 14, 20};
    std::vector<double> constant, root;
    for (const double t : times) {
        constant.push_back(t < 10 ? 7 : 0.003);
        root.push_back(t < 10 ? 7 : std::sqrt(t));
    }
    CHECK(std::fabs(level_after(times, constant, 10) - 0.003) <= 8 * eps * 0.003);
    CHECK(std::fabs(level_after(times, root, 10) - std::sqrt(15.0)) <= 8 * eps * 4);
    // Of 10.5 to 20 the rows know 11 to 20.
    CHECK(std::fabs(level_after(times, root, 10.5) - std::sqrt(15.5)) <= 8 * eps * 4);
    CHECK(std::isnan(level_after(times, root, 20)));
}

TEST_CASE("a sheet of the talk is compared with its figure and another sheet with nothing") {
    const Record record(2.5, 0.1, 0);
    const auto four = results(sheet_of(4), record), one = results(sheet_of(1), record);
    CHECK(std::fabs(four["kink_growth"]["value"].get<double>() - 0.1) <= 1e-9);
    CHECK(std::fabs(four["kink_growth_of_displacement"]["value"].get<double>() - 0.1) <= 1e-9);
    CHECK(std::fabs(four["lhdi_level"]["value"].get<double>() - 0.005) <= 1e-9);
    CHECK(std::fabs(four["kink_largest"]["value"].get<double>() - 0.6) <= 1e-9);
    CHECK(four["kink_growth"]["pass"] == true);
    CHECK(four["lhdi_level"]["pass"] == true);
    // Linear theory stands beside it and judges nothing.
    CHECK(std::fabs(one["kink_theory_growth"]["value"].get<double>() - 0.09) <= 0.01);
    CHECK(std::fabs(four["kink_theory_growth"]["value"].get<double>() - 0.035) <= 0.01);
    CHECK_FALSE(one["kink_theory_growth"].contains("pass"));
    // More than twice 0.04 and 1.5e-3.
    CHECK(one["kink_growth"]["pass"] == false);
    CHECK(one["lhdi_level"]["pass"] == false);
    CurrentSheetCase light = sheet_of(4);
    light.mass_ratio = 100;
    for (const CurrentSheetCase& other : {sheet_of(3), sheet_of(4, 8), light}) {
        const auto said = results(other, record);
        CHECK(std::fabs(said["kink_growth"]["value"].get<double>() - 0.1) <= 1e-9);
        CHECK_FALSE(said["kink_growth"].contains("pass"));
        CHECK_FALSE(said["lhdi_level"].contains("pass"));
    }
}

TEST_CASE("a record that ends in the first phase is not compared") {
    CHECK(results(sheet_of(4), Record(2.5, 0.1, 0, 39)).empty());
    CHECK_FALSE(results(sheet_of(4), Record(2.5, 0.1, 0, 40)).empty());
}
