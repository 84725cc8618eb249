// All that changes in a run of mpm_implicit, what a step sums up for the budget, and its loads.
#pragma once

#include <tuple>
#include <vector>

#include "mpm_explicit/apply_loads.hpp"
#include "mpm_explicit/assembly.hpp"
#include "mpm_implicit/budget.hpp"

namespace mpm_implicit {

/// What it took to solve one step.
struct SolveReport {
    long iterations = 0;       // conjugate gradients
    long mass_iterations = 0;  // for v^0
    long loops = 0;            // active sets tried, or Newton steps
    long krylov = 0;           // GMRES vectors of Newton's steps
    long held = 0;             // pairs that the rules against cycles of sets have kept as they were
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

/// A rigid grain that a force drives: its velocity in this step is one more unknown V,
///   m (V - V_old) = dt (F + push - c V)
struct ForceControl {
    std::size_t grain;
    bool along_x;
    double mass, damping, force;  // force: now
    double velocity;              // V_old
};

/// What the solvers took, summed up over the steps.
struct Effort {
    double iterations = 0, mass_iterations = 0, krylov = 0, loops = 0, held = 0;

    void add(const SolveReport& step) {
        iterations += static_cast<double>(step.iterations),
            loops += static_cast<double>(step.loops);
        mass_iterations += static_cast<double>(step.mass_iterations);
        krylov += static_cast<double>(step.krylov), held += static_cast<double>(step.held);
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

/// What one step has summed up.
struct StepSums {
    std::vector<TileSums> tiles;
    NodeWork nodes;
    ContactSums contact;
    SolveReport solver;
};

template <class Archive>
void archive(Archive& a, State& state) {
    archive(a, state.assembly);
    mpm::archive(a, state.layout);
    archive(a, state.budget);
    Effort& e = state.effort;
    a("iterations", e.iterations), a("mass_iterations", e.mass_iterations);
    a("krylov", e.krylov), a("loops", e.loops), a("held", e.held);
    std::vector<double> pairs;
    for (const ActivePair& pair : state.active_pairs)
        pairs.insert(pairs.end(),
                     {static_cast<double>(pair.node), static_cast<double>(pair.a),
                      static_cast<double>(pair.b), static_cast<double>(pair.state), pair.lambda_t});
    a("active_pairs", pairs);
    state.active_pairs.clear();
    for (std::size_t k = 0; k + 4 < pairs.size(); k += 5)
        state.active_pairs.push_back({std::lround(pairs[k]), static_cast<int>(pairs[k + 1]),
                                      static_cast<int>(pairs[k + 2]),
                                      static_cast<int>(pairs[k + 3]), pairs[k + 4]});
}

/// Loads in the step from t^n: the body force, and velocities of rigid grains.
/// out:    force_controls, those that a force drives, whose velocity belongs to the solution
inline BodyForce apply_loads(const Problem& problem, long step, double dt,
                             std::vector<RigidMotion>& rigid,
                             std::vector<ForceControl>& force_controls) {
    const double t = time_of_load(step, dt), share = share_of_load(t, problem.rise);
    force_controls.clear();
    for (std::size_t g = 0; g < rigid.size(); ++g) {
        RigidMotion& is = rigid[g];
        if (is.force_control_x || is.force_control_y)
            force_controls.push_back({g, is.force_control_x, is.mass, is.damping, share * is.force,
                                      is.force_control_x ? is.vx : is.vy});
        if (!is.force_control_x) is.vx = share * is.prescribed_vx, is.travel_x += dt * is.vx;
        if (!is.force_control_y) is.vy = share * is.prescribed_vy, is.travel_y += dt * is.vy;
    }
    return body_force(problem, t);
}

}  // namespace mpm_implicit
