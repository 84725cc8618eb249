// All that changes in a run of mpm_implicit, and what a step sums up for the budget.
#pragma once

#include <cmath>
#include <tuple>
#include <vector>

#include "mpm_explicit/grains/assembly.hpp"
#include "mpm_implicit/budget.hpp"

namespace mpm_implicit {

/// What it took to solve one step.
struct SolveReport {
    long iterations = 0;       // conjugate gradients
    long mass_iterations = 0;  // for v^0
    long loops = 0;            // active sets tried, or Newton steps
    long krylov = 0;           // GMRES vectors of Newton's steps
};

/// A closed pair of the last step, which the next one begins with.
struct ActivePair {
    long node;
    int a, b, state;  // bodies by ContactBody::id(), ContactState
    double lambda_t;
    bool operator<(const ActivePair& other) const {
        return std::tie(node, a, b) < std::tie(other.node, other.a, other.b);
    }
};

/// What one step has summed up.
struct StepSums {
    std::vector<TileSums> tiles;
    NodeWork nodes;
    ContactSums contact;
    SolveReport solver;
};

/// What the solvers took, summed up over the steps, and what the row of t^n says of the last.
struct Effort {
    double iterations = 0, mass_iterations = 0, krylov = 0, loops = 0;
    double last_iterations = 0, last_loops = 0, contacts = 0, impulse = 0;

    void add(const StepSums& step) {
        iterations += last_iterations = static_cast<double>(step.solver.iterations);
        loops += last_loops = static_cast<double>(step.solver.loops);
        mass_iterations += static_cast<double>(step.solver.mass_iterations);
        krylov += static_cast<double>(step.solver.krylov);
        contacts = step.contact.nodes, impulse = step.contact.impulse;
    }
};

/// All that changes in a run.
struct State {
    Assembly assembly;
    GridLayout layout;
    Budget budget;
    std::vector<ActivePair> active_pairs;  // closed in the last step
    Effort effort;
};

template <class Archive>
void archive(Archive& a, State& state) {
    archive(a, state.assembly);
    mpm::archive(a, state.layout);
    archive(a, state.budget);
    Effort& e = state.effort;
    a("iterations", e.iterations), a("mass_iterations", e.mass_iterations);
    a("krylov", e.krylov), a("loops", e.loops);
    a("last_iterations", e.last_iterations), a("last_loops", e.last_loops);
    a("contacts", e.contacts), a("impulse", e.impulse);
    std::vector<double> pairs;
    for (const ActivePair& pair : state.active_pairs)
        pairs.insert(pairs.end(),
                     {static_cast<double>(pair.node), static_cast<double>(pair.a),
                      static_cast<double>(pair.b), static_cast<double>(pair.state), pair.lambda_t});
    a("active_pairs", pairs);
    if (pairs.size() % 5 != 0) throw common::InputError("the checkpoint holds a part of a pair");
    for (std::size_t k = 0; k < pairs.size(); ++k)
        if (k % 5 < 4 && !(std::fabs(pairs[k]) < 2e9))
            throw common::InputError("the checkpoint holds a pair that cannot be");
    state.active_pairs.clear();
    for (std::size_t k = 0; k + 4 < pairs.size(); k += 5)
        state.active_pairs.push_back({std::lround(pairs[k]), static_cast<int>(pairs[k + 1]),
                                      static_cast<int>(pairs[k + 2]),
                                      static_cast<int>(pairs[k + 3]), pairs[k + 4]});
}

}  // namespace mpm_implicit
