// What tests of whole runs ask of summary.json and history.dat.
#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace facts {

inline double value(const nlohmann::json& summary, const std::string& result) {
    REQUIRE(summary["results"].contains(result));
    return summary["results"][result]["value"].get<double>();
}

// Every result that is compared with something must pass.
inline void check_results(const nlohmann::json& summary, int at_least) {
    int compared = 0;
    for (const auto& [name, result] : summary["results"].items()) {
        if (!result.contains("pass")) continue;
        const std::string format = name + " = " + result.dump();
        INFO(format);
        CHECK(result["pass"].get<bool>());
        ++compared;
    }
    CHECK(compared >= at_least);
}

// A finished run: its summary, and the columns of its history by name.
struct Run {
    nlohmann::json summary;
    std::map<std::string, std::vector<double>> columns;

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

inline Run finished_run(const std::string& folder) {
    Run result;
    std::ifstream summary(folder + "/summary.json");
    result.summary = nlohmann::json::parse(summary);
    std::ifstream history(folder + "/history.dat");
    std::string line;
    std::getline(history, line);
    std::vector<std::string> names;
    std::istringstream head(line.substr(1));
    for (std::string word; head >> word;) {
        const std::size_t colon = word.find(':') + 1;
        names.push_back(word.substr(colon, word.find('[') - colon));
    }
    while (std::getline(history, line)) {
        std::istringstream row(line);
        for (const std::string& column : names) {
            double number = 0;
            row >> number;
            result.columns[column].push_back(number);
        }
    }
    return result;
}

}  // namespace facts
