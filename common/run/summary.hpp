// summary.json: what a run measured, beside what theory or a paper says; and the same as a table
// for the terminal.
#pragma once

#include <string>
#include <vector>

#include "common/run/parameters.hpp"

namespace common {

class Summary {
   public:
    /// A measured value that passes when |value - expected| <= tolerance.
    void result(const std::string& name, double value, const std::string& unit, double expected,
                double tolerance, const std::string& source) {
        results_.push_back({name, unit, source, value, expected, tolerance, true});
    }
    /// What was asked for and could not be measured; the reason is a sentence with the cure.
    void not_measured(const std::string& name, const std::string& reason) {
        results_.push_back({name, "", reason, 0, 0, 0, true, false});
    }
    /// A measured value that passes when low <= value <= high.
    void result_within(const std::string& name, double value, const std::string& unit, double low,
                       double high, const std::string& source) {
        result(name, value, unit, 0.5 * (low + high), 0.5 * (high - low), source);
    }
    /// A measured value that is compared with nothing.
    void result_info(const std::string& name, double value, const std::string& unit,
                     const std::string& source) {
        results_.push_back({name, unit, source, value, 0, 0, false});
    }
    /// How well a conserved quantity was kept.
    void conservation(const std::string& name, double value, const std::string& unit) {
        conservation_.push_back({name, unit, "", value, 0, 0, false});
    }
    /// A number about the speed or size of the run.
    void performance(const std::string& name, double value) {
        performance_.push_back({name, "", "", value, 0, 0, false});
    }
    /// A sentence that was printed as a warning before the run.
    void warning(const std::string& text) { warnings_.push_back(text); }

    /// The case exists to show a failure: one is said and is no shortfall.
    bool expects_failure = false;

    /// The results that fell short or could not be measured, a sentence each.
    std::vector<std::string> shortfalls() const;

    /// Whether anything was compared, or could not be measured.
    bool has_verdict() const;

    /// Whether every number is finite; a run with one that is not has failed.
    bool is_finite() const;

    /// Writes the file. Numbers that are not finite are null, with "finite": false and
    /// "pass": false; so are those that were not measured, whose verdict says so.
    /// in: status 0 done, 3 failed, 130 or 143 stopped by a signal; message, how the run ended.
    void write(const std::string& path, const ProgramInfo& info, const std::string& case_name,
               int status, const std::string& message) const;

    /// The results against theory, one line each, with a verdict.
    std::string table() const;

   private:
    struct Entry {
        std::string name, unit, source;
        double value, expected, tolerance;
        bool compared, measured = true;
        bool pass() const;
    };
    const char* verdict(const Entry& entry) const;
    std::vector<Entry> results_, conservation_, performance_;
    std::vector<std::string> warnings_;
};

}  // namespace common
