#include "common/run/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/run/output_file.hpp"

namespace common {

namespace {

using Json = nlohmann::ordered_json;

// The library writes a number that is not finite as null without a word; say so.
void put(Json& object, const std::string& key, double value) {
    if (std::isfinite(value)) {
        object[key] = value;
    } else {
        object[key] = nullptr;
        object["finite"] = false;
    }
}

}  // namespace

bool Summary::Entry::pass() const {
    return measured && std::isfinite(value) && std::isfinite(expected) &&
           std::fabs(value - expected) <= tolerance;
}

const char* Summary::verdict(const Entry& entry) const {
    if (!entry.measured) return "NOT MEASURED";
    return entry.pass() ? "PASS" : expects_failure ? "EXPECTED FAILURE" : "FAIL";
}

bool Summary::has_verdict() const {
    return std::any_of(results_.begin(), results_.end(),
                       [](auto& entry) { return entry.compared; });
}

bool Summary::is_finite() const {
    const auto finite = [](const Entry& entry) { return std::isfinite(entry.value); };
    return std::all_of(results_.begin(), results_.end(), finite) &&
           std::all_of(conservation_.begin(), conservation_.end(), finite);
}

void Summary::write(const std::string& path, const ProgramInfo& info, const std::string& case_name,
                    int status, const std::string& message) const {
    Json json;
    json["program"] = info.program;
    json["version"] = info.version;
    json["case"] = case_name;
    json["status"] = status;
    json["message"] = message;
    json["results"] = Json::object();
    for (const Entry& entry : results_) {
        Json& result = json["results"][entry.name];
        if (entry.measured) put(result, "value", entry.value);
        if (!entry.measured) result["value"] = nullptr;
        result["unit"] = entry.unit;
        if (entry.compared && entry.measured) {
            put(result, "expected", entry.expected);
            put(result, "tolerance", entry.tolerance);
        }
        result["source"] = entry.source;
        if (entry.compared) result["pass"] = entry.pass(), result["verdict"] = verdict(entry);
        if (!std::isfinite(entry.value)) result["pass"] = false;
    }
    json["conservation"] = Json::object();
    for (const Entry& entry : conservation_) {
        put(json["conservation"][entry.name], "value", entry.value);
        json["conservation"][entry.name]["unit"] = entry.unit;
    }
    json["performance"] = Json::object();
    for (const Entry& entry : performance_) put(json["performance"], entry.name, entry.value);
    json["warnings"] = warnings_;

    OutputFile file(path);
    file.text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    file.finish();
}

std::vector<std::string> Summary::shortfalls() const {
    std::vector<std::string> sentences;
    for (const Entry& entry : results_) {
        if (!entry.compared || entry.pass() || (entry.measured && expects_failure)) continue;
        if (!entry.measured) {
            sentences.push_back("NOT MEASURED " + entry.name + ": " + entry.source);
            continue;
        }
        sentences.push_back("FAIL " + entry.name + " = " + format(entry.value) + ", and " +
                            format(entry.expected) + " +- " + format(entry.tolerance) +
                            " is expected (" + entry.source + ")");
    }
    return sentences;
}

std::string Summary::table() const {
    if (results_.empty()) return "";
    std::string text;
    char line[512];
    std::snprintf(line, sizeof line, "%-26s %14s   %-22s %-6s %s\n", "result", "measured",
                  "expected", "", "source");
    text += line;
    for (const Entry& entry : results_) {
        char expected[64] = "";
        if (entry.compared && entry.measured)
            std::snprintf(expected, sizeof expected, "%.6g +- %.3g", entry.expected,
                          entry.tolerance);
        const std::string unit =
            entry.unit.empty() || entry.unit == "1" ? "" : " [" + entry.unit + "]";
        char value[32] = "";
        if (entry.measured) std::snprintf(value, sizeof value, "%.6g", entry.value);
        std::snprintf(line, sizeof line, "%-26s %14s   %-22s %-6s %s%s\n", entry.name.c_str(),
                      value, expected, entry.compared ? verdict(entry) : "", entry.source.c_str(),
                      unit.c_str());
        text += line;
    }
    return text;
}

}  // namespace common
