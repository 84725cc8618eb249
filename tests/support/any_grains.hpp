// What the tests of the explicit material point method share: its main loop on cases made without
// files, besides what holds for any scheme (tests/support/any_cloud.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mpm_explicit/setup/initial_state.hpp"
#include "mpm_explicit/step.hpp"
#include "tests/support/any_cloud.hpp"

namespace facts {

using namespace mpm_explicit;

/// The steps of mpm_explicit in the order of its main, with the budget and without files.
struct Run {
    Case parameters;
    Scales scales;
    double dt;
    State state;
    std::vector<AnyLaw> laws;
    Contact contact;
    GrainNodes nodes;
    long step = 0;

    StepSums sums;
    double largest_budget = 0, largest_remap = 0, largest_energy = 0, least_V = 1;  // so far

    /// in: prepare(assembly), what is changed before the start; step_size, 0: what the case says
    template <class Prepare>
    Run(const Case& c, const Prepare& prepare, double step_size = 0)
        : parameters(c),
          scales(scales_of(c)),
          dt(step_size > 0 ? step_size : scales.dt),
          state{assemble(c.problem), {}, {}},
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
        with_shape(c.scheme(), [&](const auto& shape) {
            start_leapfrog(shape, laws, contact, parameters.transfers(), parameters.frozen, dt,
                           nodes, state);
        });
    }
    explicit Run(const Case& c) : Run(c, [](Assembly&) {}) {}

    Particles& particles() { return state.assembly.particles; }
    const Budget& budget() const { return state.budget; }

    void advance(long steps = 1) {
        with_shape(parameters.scheme(), [&](const auto& shape) {
            for (long k = 0; k < steps; ++k) advance_once(shape);
        });
    }

    /// Which particle has which number now.
    std::vector<std::size_t> by_number() {
        std::vector<std::size_t> where(particles().yield_p.size());
        for (std::size_t k = 0; k < where.size(); ++k)
            where[static_cast<std::size_t>(particles().yield_p[k])] = k;
        return where;
    }

   private:
    template <class Shape>
    void advance_once(const Shape& shape) {
        Particles& at = particles();
        const std::vector<Grain>& grains = state.assembly.grains;
        std::vector<RigidMotion>& rigid = state.assembly.rigid;
        if (nodes.sort_is_due(state.layout)) nodes.sort(grains, at, state.layout);
        const BodyForce body = apply_loads(parameters.problem.loads(), step, dt, rigid);
        take_step(shape, laws, contact, body, parameters.transfers(), parameters.frozen, dt, nodes,
                  state, sums);

        Budget& l = state.budget;
        add_energies(step, sums.tiles, l);
        largest_budget = worst({largest_budget, std::fabs(l.residual())});
        largest_remap = worst({largest_remap, std::fabs(l.remap)});
        largest_energy = worst({largest_energy, l.kinetic + l.elastic});
        for (const TileSums& s : sums.tiles) least_V = std::min(least_V, s.least_V);
        add_work(nodes.tiles(), sums.tiles, sums.nodes, sums.contact, l);
        ++step;
    }
};

}  // namespace facts
