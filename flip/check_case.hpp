// What is refused before a run starts: combinations that cannot run, and comparisons that theory
// cannot answer.
#pragma once

#include <string>

#include "flip/initial_state.hpp"

namespace flip {

namespace detail {

// One sentence for bad input.
inline void refuse(bool bad, const std::string& sentence) {
    if (bad) throw common::InputError(sentence);
}

}  // namespace detail

/// Refuses what cannot run. errors: InputError, one sentence with the numbers and the cure.
/// in:     a completed case; program, pic or flip
inline void refuse_impossible(const Case& w, const std::string&) {
    detail::refuse(w.regions.empty(),
                   "there is no fluid: add a [region.<name>], or setup.kind = \"riemann\"");
}

}  // namespace flip
