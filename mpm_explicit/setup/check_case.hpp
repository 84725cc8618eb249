// What is said before a run of mpm_explicit besides what holds for every scheme
// (mpm_explicit/setup/check_grains.hpp): how far its time step can be trusted, and how fast it is.
#pragma once

#include <string>
#include <vector>

#include "mpm_explicit/setup/case.hpp"
#include "mpm_explicit/setup/check_grains.hpp"

namespace mpm_explicit {

/// Warnings with the number and the limit, for choices that run but may mislead.
inline std::vector<std::string> warnings_of(const Case& w, const Scales& scales) {
    std::vector<std::string> warnings = resolution_warnings(w, scales);
    if (w.alpha > 0.7 && !w.frozen)
        warnings.insert(warnings.begin(),
                        "time.alpha = " + common::format(w.alpha) +
                            " is above 0.7: nothing bounds the energy of explicit solutions, and "
                            "grains that meet will burst");
    return warnings;
}

/// The resolved scales as text, for --dry-run and the head of a run.
inline std::string describe_scales(const Case& w, const Scales& scales) {
    constexpr double particle_steps_per_second = 15e6;
    const std::string flip = w.flip == 1 ? "FLIP" : "FLIP fraction " + common::format(w.flip);
    return mpm::describe_scales(
        w, scales, w.shape + " shape functions, " + flip + (w.frozen ? ", frozen particles" : ""),
        static_cast<double>(scales.steps) * static_cast<double>(scales.particles) /
            particle_steps_per_second);
}

}  // namespace mpm_explicit
