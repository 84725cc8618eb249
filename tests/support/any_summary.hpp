// Whole runs without files for figures, and what tests ask of their summary.json and history.dat.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/any_numbers.hpp"
#include "tests/support/folder_of_test.hpp"

namespace facts {

inline double value(const nlohmann::json& summary, const std::string& result) {
    REQUIRE(summary["results"].contains(result));
    return summary["results"][result]["value"].get<double>();
}

// Every result that is compared with something must pass, or fail as its case expects.
inline void check_results(const nlohmann::json& summary, int at_least) {
    int compared = 0;
    for (const auto& [name, result] : summary["results"].items()) {
        if (!result.contains("pass")) continue;
        const std::string format = name + " = " + result.dump();
        INFO(format);
        CHECK((result["pass"].get<bool>() || result["verdict"] == "EXPECTED FAILURE"));
        ++compared;
    }
    CHECK(compared >= at_least);
}

/// The columns of a table by their names, which its first line holds.
using Columns = std::map<std::string, std::vector<double>>;
inline Columns columns_of(const std::string& path) {
    Columns columns;
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    std::vector<std::string> names;
    std::istringstream head(line);
    for (std::string word; head >> word;) names.push_back(word);
    while (std::getline(file, line)) {
        if (line.starts_with("#")) continue;
        std::istringstream row(line);
        for (const std::string& column : names) {
            double number = 0;
            row >> number;
            columns[column].push_back(number);
        }
    }
    return columns;
}

// A finished run: its summary, and the columns of its history by name.
struct Run {
    nlohmann::json summary;
    Columns columns;

    double value(const std::string& result) const { return facts::value(summary, result); }
    double conservation(const std::string& name) const {
        REQUIRE(summary["conservation"].contains(name));
        return summary["conservation"][name]["value"].get<double>();
    }
    const std::vector<double>& column(const std::string& name) const {
        REQUIRE(columns.count(name) == 1);
        return columns.at(name);
    }
};
inline void check_results(const Run& run, int at_least) { check_results(run.summary, at_least); }

inline Run finished_run(const std::string& folder) {
    std::ifstream summary(folder + "/summary.json");
    return {nlohmann::json::parse(summary), columns_of(folder + "/history.dat")};
}

/// Runs a program into a folder of the test's own. out: what it has left there.
/// in: name, of the folder; arguments, a case file and overrides; the exit status that is expected
inline Run run_into(const std::string& name, const std::string& program,
                    const std::string& arguments, int status = 0) {
    const std::string folder = folder_of_test() + "/" + name,
                      command = std::string(BUILD_FOLDER) + "/" + program + " " + arguments +
                                " --out " + folder + " --force --quiet 2> /dev/null";
    CAPTURE(command);
    REQUIRE(std::system(command.c_str()) == 256 * status);
    return finished_run(folder);
}

/// A number with all its digits.
inline std::string text(double number) {
    char words[32];
    std::snprintf(words, sizeof words, "%.17g", number);
    return words;
}

inline double largest(const std::vector<double>& values) {
    double most = 0;
    for (const double v : values) most = worst({most, std::fabs(v)});
    return most;
}

}  // namespace facts
