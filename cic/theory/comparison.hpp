// What a comparison of a run with theory consists of, and what several of them need. Each has a
// header of its own: wave.hpp, diocotron.hpp, sheath.hpp, cloud_force.hpp, thermal_noise.hpp; the
// list of all is in comparisons.hpp.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cic/setup/case.hpp"
#include "common/run/history.hpp"
#include "common/run/summary.hpp"

namespace cic {

using common::History, common::Summary;

/// Lines of a description, each a name and its text.
using Lines = std::vector<std::pair<std::string, std::string>>;

/// One comparison: its name in a case file, what it needs, what it adds to the description, the
/// warnings and the history of a run, and its results. What it leaves out adds nothing.
struct Comparison {
    const char* name;
    long least_steps = 10;      // of the run
    bool either_sign = false;   // also for Gauss's law as the slide prints it
    bool formulas = false;      // species may have densities and distributions by formula
    bool follows_mode = false;  // the amplitude of theory.mode_x, mode_z: some species must seed it

    /// Refuses a case that the theory does not describe. errors: InputError
    void (*validate)(const Case&) = [](const Case&) {};
    /// The mode along x whose amplitude is recorded.
    long (*recorded_mode_x)(const Case&) = [](const Case& parameters) { return parameters.mode_x; };
    /// What the run will show, before it begins.
    Lines (*describe)(const Case&) = [](const Case&) { return Lines{}; };
    /// Where the run can mislead.
    void (*add_warnings)(const Case&, std::vector<std::string>&) = [](const Case&, auto&) {};
    /// Columns of the history that need the positions of t^n.
    void (*add_columns)(const Case&, const std::vector<Particles>&,
                        common::Row&) = [](const Case&, const auto&, auto&) {};
    /// What was measured, beside what theory says.
    void (*add_results)(const Case&, const History&, Summary&) = [](const Case&, const auto&,
                                                                    auto&) {};
};

/// Units of frequencies in the results, with the convention.
inline constexpr const char* omega_p_unit = "omega_p(n=q=m=1)";

/// How a case asks for its comparison, for messages.
inline std::string asked_for(const Case& parameters) {
    return "theory.compare = \"" + parameters.compare + "\"";
}

/// How many species have this profile.
inline long count_with_profile(const Case& parameters, const char* profile) {
    long count = 0;
    for (const SpeciesCase& s : parameters.species) count += s.profile == profile;
    return count;
}

/// Mean over the second half of a run.
inline double mean_of_last_half(const std::vector<double>& values) {
    double sum = 0;
    const std::size_t half = values.size() / 2;
    for (std::size_t n = half; n < values.size(); ++n) sum += values[n];
    return sum / double(values.size() - half);
}

/// The same of what fluctuates, with an error bar: Student's t of the means of its three parts, so that
/// a slow change in it widens the bar.
inline common::Measured fluctuating_mean(const std::vector<double>& values) {
    const double mean = mean_of_last_half(values);
    const std::size_t half = values.size() / 2, part = (values.size() - half) / 3;
    double squares = 0;
    for (std::size_t n = half; part > 0 && n + part <= values.size(); n += part) {
        double sum = 0;
        for (std::size_t m = n; m < n + part; ++m) sum += values[m];
        squares += std::pow(sum / double(part) - mean, 2);
    }
    return {mean, 4.30 * std::sqrt(squares / 6)};  // two degrees of freedom
}

}  // namespace cic
