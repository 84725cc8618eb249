// All that changes in a run of mpm_explicit, and what a step sums up for the ledger.
#pragma once

#include <vector>

#include "mpm_explicit/assembly.hpp"
#include "mpm_explicit/ledger.hpp"

namespace mpm_explicit {

/// All that changes in a run.
struct State {
    Assembly assembly;
    Frame frame;
    Ledger ledger;
};

template <class Archive>
void archive(Archive& a, State& state) {
    archive(a, state.assembly);
    mpm::archive(a, state.frame);
    archive(a, state.ledger);
}

/// What one step has summed up.
struct StepSums {
    std::vector<StripSums> strips;
    NodeWork nodes;
    ContactSums contact;
};

}  // namespace mpm_explicit
