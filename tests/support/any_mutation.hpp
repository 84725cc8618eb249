// Wrong runs: a shipped case with changed parameters, and the results that this has to fail.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/any_summary.hpp"

namespace facts {

/// A row without overrides is the case as it is shipped, in which nothing may fail.
struct Mutation {
    std::string program, file, overrides, fails;  // fails: names of results
};

using Words = std::set<std::string>;
inline Words words(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

/// Whose folder holds the cases that a program runs.
inline std::string folder_of_cases(const std::string& program) {
    if (program == "pic") return "flip";
    return program == "explicit_em" ? "implicit_moment" : program;
}

/// What all rows of a table said, by "program case"; failed also by program.
struct Verdicts {
    std::map<std::string, Words> judged, failed;
};

/// Runs all rows of a table; what each says that it fails has to fail.
/// out:    judged: of a case with a row as it is shipped the results of that row, else those of all
inline Verdicts run_mutations(const std::vector<Mutation>& table) {
    Verdicts verdicts;
    Words shipped;
    for (const Mutation& row : table) {
        const std::string path = folder_of_cases(row.program) + "/cases/" + row.file + ".toml",
                          key = row.program + " " + row.file;
        INFO(key << " " << row.overrides);
        REQUIRE(std::filesystem::exists(path));
        const Run run = run_into("mutation", row.program,
                                 path + " " + row.overrides + " output.particles_interval=0");
        const bool as_shipped = row.overrides.empty();
        if (as_shipped) shipped.insert(key), verdicts.judged[key].clear();
        Words fails = words(row.fails);
        for (const auto& [name, result] : run.summary["results"].items()) {
            if (!result.contains("verdict")) continue;
            INFO(name << " = " << result.dump());
            if (as_shipped || !shipped.contains(key)) verdicts.judged[key].insert(name);
            if (as_shipped) CHECK(result["verdict"] != "FAIL");
            if (fails.erase(name) == 0) continue;
            CHECK(result["verdict"] == "FAIL");
            verdicts.failed[key].insert(name), verdicts.failed[row.program].insert(name);
        }
        CAPTURE(row.fails);
        CHECK(fails.empty());  // names of results that there are
    }
    return verdicts;
}

/// Every shipped case of these folders has a row in one of the tables, or a reason why not.
inline void check_every_case(const std::vector<std::vector<Mutation>>& tables,
                             const std::vector<std::string>& folders,
                             const std::map<std::string, std::string>& left_out) {
    Words there;
    for (const std::vector<Mutation>& table : tables)
        for (const Mutation& row : table)
            there.insert(folder_of_cases(row.program) + "/cases/" + row.file);
    for (const std::string& folder : folders)
        for (const auto& file : std::filesystem::directory_iterator(folder + "/cases")) {
            const std::string name = file.path().parent_path() / file.path().stem();
            INFO(name);
            CHECK((there.contains(name) || left_out.contains(name)));
        }
}

}  // namespace facts
