// All that changes in a run of mpm_explicit, and what a step sums up for the budget.
#pragma once

#include <vector>

#include "mpm_explicit/budget.hpp"
#include "mpm_explicit/grains/assembly.hpp"

namespace mpm_explicit {

/// All that changes in a run.
struct State {
    Assembly assembly;
    GridLayout layout;
    Budget budget;
};

template <class Archive>
void archive(Archive& a, State& state) {
    archive(a, state.assembly);
    mpm::archive(a, state.layout);
    archive(a, state.budget);
}

/// The contacts of one step, and what it has summed up.
struct StepSums {
    ContactList contacts;
    std::vector<TileSums> tiles;
    NodeWork nodes;
    ContactSums contact;
};

}  // namespace mpm_explicit
