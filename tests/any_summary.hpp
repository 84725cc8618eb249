// What tests of whole runs ask of summary.json.
#pragma once

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

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
        const std::string shown = name + " = " + result.dump();
        INFO(shown);
        CHECK(result["pass"].get<bool>());
        ++compared;
    }
    CHECK(compared >= at_least);
}

}  // namespace facts
