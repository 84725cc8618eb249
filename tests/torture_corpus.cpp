// What the laboratory of tests/torture has ever found is tried again here: forged checkpoints.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>

#include "tests/support/any_program.hpp"
#include "tests/torture/forge.hpp"

using namespace facts;

namespace {

// The newest checkpoint of a run, which is made when it is first asked for.
const std::string& checkpoint_of(const Program& program, const std::string& words) {
    static std::map<std::string, std::string> made;
    const auto [place, is_new] = made.try_emplace(program.name + " " + words);
    if (!is_new) return place->second;
    const fs::path folder = fresh_folder(program, "whole");
    const Command command{&program, words + " output.checkpoint_steps=5", {}};
    CHECK(start(program, folder, arguments_of(command) + " --quiet --out run").status == 0);
    fs::path newest;
    for (const auto& entry : fs::directory_iterator(folder / "run"))
        if (entry.path().extension() == ".bin") newest = std::max(newest, entry.path());
    return place->second = read_all(newest);
}

}  // namespace

TEST_CASE("every forged checkpoint of the corpus is refused" * doctest::description("robust")) {
    for (const std::string& line : lines_in(read_all("tests/torture/corpus/refused.txt"))) {
        const std::size_t space = line.find(' '), bar = line.find(" | ");
        REQUIRE(bar != std::string::npos);
        std::string edits = line.substr(bar + 3);
        std::replace(edits.begin(), edits.end(), '|', '\n');
        for (const Program* program : programs_called(line.substr(0, space))) {
            const std::string whole = checkpoint_of(*program, line.substr(space, bar - space));
            REQUIRE(!whole.empty());
            CHECK(torture::forged(whole, "") == whole);
            const fs::path folder = fresh_folder(*program);
            write_all(folder / "forged.bin", torture::forged(whole, edits));
            const Outcome outcome =
                start(*program, folder, "--restart forged.bin --quiet --out run");
            INFO(program->name << " " << line << ": status " << outcome.status << " "
                               << outcome.err);
            CHECK(outcome.status == 2);
            CHECK(outcome.sentences.size() == 1);
        }
    }
}
