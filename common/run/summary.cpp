#include "common/run/summary.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/run/machine.hpp"
#include "common/run/output_file.hpp"

// The state of the sources, which the build links into programs; empty without git.
[[gnu::weak]] extern const char* const source_revision;

namespace common {

namespace {

using Json = nlohmann::ordered_json;

// The command line of this process, to be given to a shell again.
std::string command_line() {
    std::ifstream words("/proc/self/cmdline");
    std::string line;
    for (std::string word; std::getline(words, word, '\0');)
        line.append(line.empty() ? "" : " ").append(shell_word(word));
    return line;
}

std::string host_name() {
    char name[256] = {};
    return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

// The library writes a number that is not finite as null without a word; say so.
void put(Json& object, const std::string& key, double value) {
    object[key] = value;
    if (!std::isfinite(value)) object["finite"] = false;
}

// Six digits, and the error with two.
std::string text_of(const Measured& number) {
    char text[64];
    const int length = std::snprintf(text, sizeof text, "%.6g", number.value);
    if (number.error > 0)
        std::snprintf(text + length, sizeof text - length, " +- %.2g", number.error);
    return text;
}

}  // namespace

std::vector<Expectation::Failure> Expectation::list() const {
    std::vector<Failure> all;
    std::istringstream parts(fails);
    for (std::string part; std::getline(parts, part, ',');) {
        part.erase(0, part.find_first_not_of(' ')), part.erase(part.find_last_not_of(' ') + 1);
        Failure one{part, ""};
        std::istringstream words(part);
        std::string from, to;
        words >> one.name >> from >> one.low >> to >> one.high;
        if (!words || !words.eof() || from != "from" || to != "to") one = {part, part};
        if (!part.empty()) all.push_back(one);
    }
    return all;
}

bool Expectation::names(const std::string& result, double value) const {
    return std::ranges::any_of(list(), [&](const Failure& one) {
        return one.name == result && value >= one.low && value <= one.high;
    });
}

bool Summary::Entry::is_measured() const {
    if (kind == Kind::not_measured) return false;
    // Whoever is three error bars off has been measured well enough.
    const double off = std::fabs(value.value - expected) - (kind == Kind::compared ? tolerance : 0);
    return !(is_judged() && value.error > tolerance) || off > 3 * value.error;
}

bool Summary::Entry::meets() const {
    const double above = value.value - expected, slack = value.error;
    if (!is_measured() || !std::isfinite(above)) return false;
    return kind == Kind::at_most    ? above <= slack
           : kind == Kind::at_least ? above >= -slack
                                    : std::fabs(above) <= tolerance + slack;
}

std::string Summary::Entry::wanted() const {
    return kind == Kind::at_most    ? "<= " + format(expected)
           : kind == Kind::at_least ? ">= " + format(expected)
           : kind == Kind::compared ? format(expected) + " +- " + format(tolerance)
                                    : "";
}

const char* Summary::verdict(const Entry& entry) const {
    if (!entry.is_judged()) return "";
    if (!entry.is_measured()) return "NOT MEASURED";
    if (entry.meets()) return "PASS";
    return expectation.names(entry.name, entry.value.value) ? "EXPECTED FAILURE" : "FAIL";
}

bool Summary::has_verdict() const { return std::ranges::any_of(results_, &Entry::is_judged); }

bool Summary::is_finite() const {
    const auto finite = [](const Entry& entry) { return std::isfinite(entry.value.value); };
    return std::ranges::all_of(results_, finite) && std::ranges::all_of(conservation_, finite);
}

void Summary::write(const std::string& path, const ProgramInfo& info, const std::string& case_name,
                    int status, const std::string& message) const {
    Json json;
    json["program"] = info.program;
    json["version"] = info.version;
    json["revision"] = &source_revision != nullptr ? source_revision : "";
    json["command"] = command_line();
    json["host"] = host_name();
    json["compiler"] = __VERSION__;
    json["flags"] = BUILD_FLAGS;
    json["case"] = case_name;
    json["status"] = status;
    json["message"] = message;
    json["results"] = Json::object();
    for (const Entry& entry : results_) {
        Json& result = json["results"][entry.name];
        put(result, "value", entry.value.value);
        if (entry.kind == Kind::not_measured) result["value"] = nullptr;
        if (entry.value.error > 0) put(result, "error", entry.value.error);
        result["unit"] = entry.unit;
        if (entry.kind == Kind::compared) {
            put(result, "expected", entry.expected);
            put(result, "tolerance", entry.tolerance);
        }
        if (entry.kind == Kind::at_most) put(result, "at_most", entry.expected);
        if (entry.kind == Kind::at_least) put(result, "at_least", entry.expected);
        result["source"] = entry.source;
        if (entry.is_judged()) {
            const std::string word = verdict(entry);
            result["pass"] = word == "PASS", result["verdict"] = word;
            if (word == "FAIL" && !entry.hint.empty()) result["hint"] = entry.hint;
        }
        if (!std::isfinite(entry.value.value)) result["pass"] = false;
    }
    json["conservation"] = Json::object();
    for (const Entry& entry : conservation_) {
        put(json["conservation"][entry.name], "value", entry.value.value);
        json["conservation"][entry.name]["unit"] = entry.unit;
    }
    json["performance"] = Json::object();
    for (const Entry& entry : performance_) put(json["performance"], entry.name, entry.value.value);
    json["warnings"] = warnings;
    for (const std::string& late : late_warnings) json["warnings"].push_back(late);

    OutputFile file(path);
    file.text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    file.finish();
}

std::vector<std::string> Summary::shortfalls() const {
    std::vector<std::string> sentences;
    for (const Entry& entry : results_) {
        const std::string word = verdict(entry);
        const std::string start = word + " " + entry.name,
                          hint = entry.hint.empty() ? "" : "; " + entry.hint;
        const std::string value = " = " + text_of(entry.value);
        if (word == "NOT MEASURED")
            sentences.push_back(entry.kind == Kind::not_measured
                                    ? start + ": " + entry.source
                                    : start + value + ": the error, " + format(entry.value.error) +
                                          ", is larger than the tolerance, " +
                                          format(entry.tolerance) + hint);
        else if (word == "FAIL")
            sentences.push_back(start + value + ", and " + entry.wanted() + " is expected (" +
                                entry.source + ")" + hint);
        else if (word == "EXPECTED FAILURE")
            sentences.push_back("as expected, " + entry.name + value + " and not " +
                                entry.wanted() + ": " + expectation.because);
    }
    for (const auto& [text, name, low, high] : expectation.list()) {
        const auto found = std::ranges::find(results_, name, &Entry::name);
        const bool missing = found == results_.end() || !found->is_judged(),
                   passed = !missing && found->meets();
        if (name != "status 3" && (missing || passed || *verdict(*found) == 'F'))
            sentences.push_back("expect.fails names '" + text +
                                (missing  ? "', and this run judges no such result"
                                 : passed ? "', and it passed"
                                          : "', and it fails with another value"));
    }
    return sentences;
}

bool Summary::fell_short() const {
    return std::ranges::any_of(results_, [&](const Entry& entry) {
        const std::string word = verdict(entry);
        return word == "FAIL" || word == "NOT MEASURED";
    });
}

std::string Summary::table() const {
    if (results_.empty()) return "";
    std::string text;
    char line[512];
    std::snprintf(line, sizeof line, "%-26s %20s   %-20s %-6s %s\n", "result", "measured",
                  "expected", "", "source");
    text += line;
    for (const Entry& entry : results_) {
        const bool measured = entry.kind != Kind::not_measured;
        const std::string unit =
            entry.unit.empty() || entry.unit == "1" ? "" : " [" + entry.unit + "]";
        std::snprintf(line, sizeof line, "%-26s %20s   %-20s %-6s %s%s\n", entry.name.c_str(),
                      measured ? text_of(entry.value).c_str() : "", entry.wanted().c_str(),
                      verdict(entry), entry.source.c_str(), unit.c_str());
        text += line;
    }
    return text;
}

}  // namespace common
