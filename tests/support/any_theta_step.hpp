// What the tests of the implicit material point method share: the loop of its main on cases made
// without files, as a whole and up to the solution of a step.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "mpm_explicit/setup/scales.hpp"
#include "mpm_implicit/state.hpp"
#include "mpm_implicit/step.hpp"
#include "tests/support/any_cloud.hpp"

namespace facts {

using namespace mpm_implicit;

/// The steps of mpm_implicit in the order of its main, with the budget and without files.
struct ThetaRun {
    Case parameters;
    ThetaScheme scheme;
    Scales scales;
    double dt;
    State state;
    std::vector<AnyLaw> laws;
    Contact contact;
    GrainNodes nodes;
    long step = 0;
    BodyForce body;

    StepSums sums;
    double size = 0;         // largest energy or work of loads, so far
    double growth = -1e300;  // largest of a step, beyond the work of loads and what laws undo
    double least_V = 1;      // smallest V^1/V^0 of a step

    /// in: prepare(assembly), what is changed before the start
    template <class Prepare>
    ThetaRun(const Case& c, const ThetaScheme& s, const Prepare& prepare)
        : parameters(c),
          scheme(s),
          scales(scales_of(c, false)),
          dt(scales.dt),
          state{assemble(c.problem, c.shape == "gimp"), {}, {}, {}, {}},
          laws(laws_of(c.problem)),
          contact(contact_rule(c.problem), state.assembly.grains, state.assembly.bonds),
          nodes(c.problem.mesh(), c.scheme().width(), scales.least_mass) {
        // Elastic bodies do not use yield_p: it numbers the particles, so that tests find them.
        Particles& p = particles();
        const bool yields =
            std::any_of(laws.begin(), laws.end(), [](const auto& l) { return l.law.index() > 0; });
        for (std::size_t k = 0; k < p.yield_p.size(); ++k)
            p.yield_p[k] = yields ? 0 : static_cast<double>(k);
        prepare(state.assembly);
        nodes.sort(state.assembly.grains, p, state.layout);
        start_budget(state.assembly, laws, state.budget);
        size = budget().energy();
    }
    ThetaRun(const Case& c, const ThetaScheme& s) : ThetaRun(c, s, [](Assembly&) {}) {}

    Particles& particles() { return state.assembly.particles; }
    const Budget& budget() const { return state.budget; }
    std::vector<Grain>& grains() { return state.assembly.grains; }
    /// Largest residual of a step, over the energy.
    double identity() const { return budget().largest_residual / size; }

    /// Calls work(shape, solver), the solver as wide as the shape.
    template <class Work>
    void with(const Work& work) {
        with_scratch([&](const auto& shape, auto& scratch) { work(shape, scratch.solver); });
    }

    void advance(long steps = 1) {
        with_scratch([&](const auto& shape, auto& scratch) {
            for (long k = 0; k < steps; ++k) {
                begin(shape, scratch);
                solve(shape, scratch);
                end(shape, scratch);
            }
        });
    }
    /// A step up to v_i^0: who meets is known, and the matrices.
    void begin() {
        with_scratch([&](const auto& shape, auto& scratch) { begin(shape, scratch); });
    }
    /// And v_i^theta, with the particles still where they were.
    void solve() {
        with_scratch([&](const auto& shape, auto& scratch) { solve(shape, scratch); });
    }
    void end() {
        with_scratch([&](const auto& shape, auto& scratch) { end(shape, scratch); });
    }
    /// The pairs of the last step.
    const ActiveSet& set() const {
        return parameters.shape == "linear" ? narrow_.solver.set : wide_.solver.set;
    }

   private:
    template <class Work>
    void with_scratch(const Work& work) {
        with_shape(parameters.scheme(), [&](const auto& shape) {
            work(shape, scratch_of<std::decay_t<decltype(shape)>::width - 1>());
        });
    }
    template <int reach>
    auto& scratch_of() {
        if constexpr (reach == 1)
            return narrow_;
        else
            return wide_;
    }
    template <class Shape, int reach>
    void begin(const Shape& shape, StepScratch<reach>& scratch) {
        if (nodes.sort_is_due(state.layout)) nodes.sort(grains(), particles(), state.layout);
        // What a test has changed since the last step.
        scratch.laws = laws, scratch.scheme = scheme, scratch.flip = parameters.flip,
        scratch.frozen = parameters.frozen;
        body = apply_loads(parameters.problem.loads(), step, dt, state.assembly.rigid,
                           scratch.solver.force_controls);
        find_matrices(shape, dt, scratch, nodes, state, sums);
    }
    template <class Shape, int reach>
    void solve(const Shape& shape, StepScratch<reach>& scratch) {
        find_theta_velocities(shape, body, dt, scratch, nodes, state, sums);
    }
    template <class Shape, int reach>
    void end(const Shape& shape, StepScratch<reach>& scratch) {
        move_to_new_level(shape, body, dt, scratch, nodes, state, sums);

        Budget& l = state.budget;
        const auto given = [&] {
            return l.energy() - l.plate - l.gravity - l.volume + std::min(l.plastic, 0.0);
        };
        const double before = given();
        add_step(scheme.theta, scheme.consistent(), nodes.tiles(), sums.tiles, sums.nodes,
                 sums.contact, l);
        const double grown = given() - before;
        growth = growth >= grown || std::isnan(growth) ? growth : grown;
        size = worst({size, l.energy(), std::fabs(l.plate + l.gravity)});
        for (const TileSums& s : sums.tiles) least_V = std::min(least_V, s.least_V);
        ++step;
    }

    StepScratch<1> narrow_{laws, scheme, contact, parameters.flip, parameters.frozen, {}, {}};
    StepScratch<2> wide_{laws, scheme, contact, parameters.flip, parameters.frozen, {}, {}};
};

// ---- cases --------------------------------------------------------------------------------------

inline ThetaScheme theta_scheme(double theta, const std::string& mass = "consistent",
                                const std::string& solver = "projected_cg") {
    ThetaScheme s;
    s.theta = theta, s.mass = mass, s.solver = solver;
    s.max_outer_iterations = 300;  // that friction settles is not for every test
    return s;
}

/// Adds random velocities to all particles that are not rigid's.
inline void shake(double size, std::uint64_t seed, Assembly& all) {
    Random random(seed);
    for (const Grain& grain : all.grains)
        for (long k = grain.begin; k < grain.end && !grain.rigid; ++k) {
            const auto p = static_cast<std::size_t>(k);
            all.particles.vx_p[p] += size * random(-1, 1);
            all.particles.vy_p[p] += size * random(-1, 1);
        }
}

/// Moves every particle by a part of its lattice, and gives it some stress.
inline void disturb(double way, double stress, std::uint64_t seed, Assembly& all) {
    Random random(seed);
    Particles& p = all.particles;
    for (std::size_t k = 0; k < p.x_p.size(); ++k) {
        p.x_p[k] += way * random(-1, 1), p.y_p[k] += way * random(-1, 1);
        const double xx = stress * random(-1, 1), yy = stress * random(-1, 1);
        p.set_stress(k, {xx, yy, stress * random(-1, 1), 0.3 * (xx + yy)});
    }
}

}  // namespace facts
