// Where the time of a step goes. The steps of all programs take a clock and call lap("...") after
// each part; a program gives them none, a bench a StepClock.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace common {

struct NoClock {
    void lap(const char*) const {}
};

/// Seconds by part of the step.
class StepClock {
   public:
    StepClock() { restart(); }
    /// Forgets all, and begins.
    void restart() {
        seconds_.clear();
        resume();
    }
    /// Begins the next part without counting what has passed since the last one.
    void resume() { last_ = Time::now(); }
    /// Ends a part: what has passed since the last one is its.
    void lap(const char* part) {
        const auto now = Time::now();
        seconds_[part] += std::chrono::duration<double>(now - last_).count();
        last_ = now;
    }
    /// Seconds spent in a part so far; 0 for a part that is not known.
    double seconds(const std::string& part) const {
        return seconds_.contains(part) ? seconds_.at(part) : 0;
    }
    /// Seconds spent in all parts.
    double total() const {
        double sum = 0;
        for (const auto& [part, seconds] : seconds_) sum += seconds;
        return sum;
    }

   private:
    using Time = std::chrono::steady_clock;
    std::map<std::string, double> seconds_;
    Time::time_point last_;
};

}  // namespace common
