// What is refused of a state that was read from a file: what mpm_explicit refuses, and pairs that
// no step can have closed.
#pragma once

#include <algorithm>

#include "mpm_explicit/setup/check_state.hpp"
#include "mpm_implicit/state.hpp"

namespace mpm_implicit {

/// Refuses a state that no run of the case can have.
/// in:     width of the shape function in nodes
/// errors: InputError, one sentence
inline void validate_state(const Mesh& mesh, int width, State& state) {
    mpm::validate_state(mesh, width, false, true, state.assembly, state.layout,
                        state.budget.momenta);
    for (const std::vector<double>* column : state.assembly.particles.from())
        refuse(!column->empty(), "its particles have places that they came from");
    const std::vector<ActivePair>& pairs = state.active_pairs;
    const bool closed = std::all_of(pairs.begin(), pairs.end(), [](const ActivePair& pair) {
        return pair.state == static_cast<int>(ContactState::slip) ||
               pair.state == static_cast<int>(ContactState::stick);
    });
    const auto falls = [](const ActivePair& a, const ActivePair& b) { return !(a < b); };
    refuse(!closed || std::adjacent_find(pairs.begin(), pairs.end(), falls) != pairs.end(),
           "its pairs in contact are not closed, or out of order");
    const Effort& e = state.effort;
    for (const double count : {e.iterations, e.mass_iterations, e.krylov, e.loops,
                               e.last_iterations, e.last_loops, e.contacts, e.impulse})
        refuse(count < 0, "the iterations of its solvers, or its contacts, are negative");
}

}  // namespace mpm_implicit
