// summary.json: what a run measured, beside what theory or a paper says; and the same as a table
// for the terminal.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/run/parameters.hpp"

namespace common {

/// A measured number and its error bar: 95 of 100 such are nearer to the truth.
struct Measured {
    double value = 0, error = 0;
    Measured(double number, double error_bar = 0) : value(number), error(error_bar) {}
};

class Summary {
   public:
    /// A measured value that passes when |value - expected| <= tolerance + error, and could not be
    /// measured when its error is larger than the tolerance and it is not three of them off.
    void result(const std::string& name, Measured value, const std::string& unit, double expected,
                double tolerance, const std::string& source) {
        add({name, unit, source, value, expected, tolerance, Kind::compared});
    }
    /// A measured value that passes when value <= limit + error.
    void result_at_most(const std::string& name, Measured value, const std::string& unit,
                        double limit, const std::string& source) {
        add({name, unit, source, value, limit, std::fabs(limit), Kind::at_most});
    }
    /// A measured value that passes when value >= limit - error.
    void result_at_least(const std::string& name, Measured value, const std::string& unit,
                         double limit, const std::string& source) {
        add({name, unit, source, value, limit, std::fabs(limit), Kind::at_least});
    }
    /// What was asked for and could not be measured; the reason is a sentence with the cure.
    void not_measured(const std::string& name, const std::string& reason) {
        add({name, "", reason, 0, 0, 0, Kind::not_measured});
    }
    /// A measured value that passes when low <= value <= high.
    void result_within(const std::string& name, Measured value, const std::string& unit, double low,
                       double high, const std::string& source) {
        result(name, value, unit, 0.5 * (low + high), 0.5 * (high - low), source);
    }
    /// A measured value that is compared with nothing.
    void result_info(const std::string& name, Measured value, const std::string& unit,
                     const std::string& source) {
        add({name, unit, source, value});
    }
    /// What a shortfall of the results that follow is most likely due to, and what to change.
    void hint(const std::string& sentence) { hint_ = sentence; }
    /// How well a conserved quantity was kept.
    void conservation(const std::string& name, double value, const std::string& unit) {
        conservation_.push_back({name, unit, "", value});
    }
    /// A number about the speed or size of the run.
    void performance(const std::string& name, double value) {
        performance_.push_back({name, "", "", value});
    }
    /// Warnings that were printed before the run, and those that are printed after it.
    std::vector<std::string> warnings, late_warnings;

    /// A result that is named here and falls short has the verdict EXPECTED FAILURE.
    Expectation expectation;

    /// The results that fell short, as expected or not, or could not be measured, or are expected
    /// to fall short and are none, a sentence each.
    std::vector<std::string> shortfalls() const;

    /// Whether one fell short that was not expected to, or could not be measured.
    bool fell_short() const;

    /// Whether anything was compared, or could not be measured.
    bool has_verdict() const;

    /// Whether every number is finite; a run with one that is not has failed.
    bool is_finite() const;

    /// Writes the file. Numbers that are not finite are null, with "finite": false and "pass": false; so are
    /// those that were not measured, whose verdict says so. What fails has its hint.
    /// in: status 0 done, 3 failed, 129, 130 or 143 stopped by a signal; message, how the run ended.
    void write(const std::string& path, const ProgramInfo& info, const std::string& case_name,
               int status, const std::string& message) const;

    /// The results against theory, one line each, with a verdict.
    std::string table() const;

   private:
    enum class Kind { told, compared, at_most, at_least, not_measured };
    struct Entry {
        std::string name, unit, source;
        Measured value;
        double expected = 0, tolerance = 0;
        Kind kind = Kind::told;
        std::string hint = {};
        bool is_judged() const { return kind != Kind::told; }
        bool is_measured() const;
        bool meets() const;
        std::string wanted() const;
    };
    void add(Entry entry) {
        entry.hint = hint_;
        results_.push_back(std::move(entry));
    }
    const char* verdict(const Entry& entry) const;
    std::string hint_;
    std::vector<Entry> results_, conservation_, performance_;
};

}  // namespace common
