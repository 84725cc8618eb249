// What the tests of the material point method share: random numbers, loose clouds of particles on
// a mesh, cases made without files, and the main loop of mpm_explicit on them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "mpm_explicit/initial_state.hpp"
#include "mpm_explicit/move_particles.hpp"
#include "tests/any_numbers.hpp"

namespace facts {

using namespace mpm_explicit;

/// Numbers in [0, 1), and between two ends.
struct Random {
    std::mt19937_64 engine;
    explicit Random(std::uint64_t seed = 1) : engine(seed) {}
    double operator()() { return 0x1p-53 * static_cast<double>(engine() >> 11); }
    double operator()(double low, double high) { return low + (high - low) * (*this)(); }
};

/// Calls work(shape, name) for every shape function.
template <class Work>
void for_each_shape(const Work& work) {
    work(LinearShape{}, std::string("linear"));
    work(QuadraticShape{}, std::string("quadratic"));
    for (const double half : {1.0 / 2, 1.0 / 4, 1.0 / 6})
        work(GimpShape{half}, "gimp " + std::to_string(half));
}

// ---- particles and their nodes ------------------------------------------------------------------

/// Grains made of particles anywhere, not of a lattice.
struct Cloud {
    Mesh mesh;
    Particles particles;
    std::vector<Grain> grains;
    std::vector<RigidMotion> rigid;
    Frame frame;

    explicit Cloud(const Mesh& where) : mesh(where) {}

    void begin_grain(bool is_rigid = false) {
        Grain grain;
        grain.name = "g" + std::to_string(grains.size());
        grain.rigid = is_rigid;
        grain.begin = grain.end = particles.count();
        grains.push_back(grain), rigid.emplace_back();
    }
    /// One more particle of the last grain; its yield_p counts particles.
    void add(double x, double y, double m = 1, double vx = 0, double vy = 0, double V = 1) {
        Particles& p = particles;
        p.x_p.push_back(x), p.y_p.push_back(y), p.vx_p.push_back(vx), p.vy_p.push_back(vy);
        p.m_p.push_back(m), p.V_p.push_back(V);
        p.resize(p.x_p.size());
        p.yield_p.back() = real(p.count() - 1);
        grains.back().end = p.count();
    }
    /// A grain of particles anywhere in a box.
    void add_anywhere(long count, double x_low, double x_high, double y_low, double y_high,
                      Random& random) {
        begin_grain();
        for (long p = 0; p < count; ++p) {
            const double x = random(x_low, x_high), y = random(y_low, y_high), m = random(0.5, 1.5),
                         vx = random(-1, 1), vy = random(-1, 1);
            add(x, y, m, vx, vy, random(0.5, 1.5));
        }
    }
    /// Sorts, and puts the sums on nodes; and their velocities.
    template <class Shape>
    GrainNodes on_nodes(const Shape& shape, double least_mass = 0) {
        GrainNodes nodes(mesh, Shape::width, least_mass);
        nodes.sort(grains, particles, frame);
        put_on_nodes(shape, particles, nodes);
        velocity_of_nodes(grains, rigid, nodes);
        return nodes;
    }
};

inline Mesh mesh_of(long cells_x, long cells_y, double h, double x_low = 0, double y_low = 0) {
    Mesh mesh;
    mesh.cells_x = cells_x, mesh.cells_y = cells_y, mesh.h = h;
    mesh.x_low = x_low, mesh.y_low = y_low;
    return mesh;
}

/// Calls visit(grain, i, j, slot) for all nodes of all grains.
template <class Visit>
void for_each_slot(const GrainNodes& nodes, const Frame& frame, const Visit& visit) {
    std::size_t row = 0;
    for (std::size_t g = 0; g < frame.rows.size(); ++g)
        for (int r = 0; r < frame.rows[g]; ++r, ++row)
            for (long i = frame.first_column[row]; i < frame.end_column[row]; ++i) {
                const long j = frame.first_row[g] + r;
                visit(static_cast<int>(g), i, j,
                      static_cast<std::size_t>(nodes.origin(static_cast<int>(g), j) + i));
            }
}

// ---- cases and their runs -----------------------------------------------------------------------

/// A mesh of square cells with one elastic material, E = 1e4, nu = 0.3, density 1000.
inline Case case_on(long cells_x, long cells_y, double length_x) {
    Case c;
    c.problem.cells_x = cells_x, c.problem.cells_y = cells_y, c.problem.length_x = length_x;
    return c;
}
inline GrainCase disk_at(const std::string& name, double x, double y, double radius, double vx = 0,
                         double vy = 0) {
    GrainCase g;
    g.name = name, g.x = x, g.y = y, g.radius = radius, g.velocity_x = vx, g.velocity_y = vy;
    return g;
}
inline GrainCase box_at(const std::string& name, double x, double y, double width, double height,
                        double vx = 0, double vy = 0) {
    GrainCase g = disk_at(name, x, y, 1, vx, vy);
    g.shape = "box", g.width = width, g.height = height;
    return g;
}
inline void add_material(Case& c, const std::string& name, const std::string& law,
                         const Material& of) {
    MaterialCase m;
    m.name = name, m.law = law, m.material = of;
    c.problem.materials.push_back(m);
}

/// The steps of mpm_explicit in the order of its main, with the ledger and without files.
struct Run {
    Case wanted;
    Scales scales;
    double dt;
    State state;
    std::vector<AnyLaw> laws;
    Contact contact;
    GrainNodes nodes;
    long step = 0;

    std::vector<StripSums> strips;
    NodeWork at_nodes;
    ContactSums in_contact;
    double largest_budget = 0, largest_remap = 0, largest_energy = 0, least_V = 1;  // so far

    /// in: prepare(assembly), what is changed before the start; step_size, 0: what the case says
    template <class Prepare>
    Run(const Case& c, const Prepare& prepare, double step_size = 0)
        : wanted(c),
          scales(scales_of(c)),
          dt(step_size > 0 ? step_size : scales.dt),
          state{assemble(c.problem), {}, {}},
          laws(laws_of(c.problem)),
          contact(c.problem.contact, state.assembly.grains, state.assembly.bonds),
          nodes(c.problem.mesh(), c.scheme().width(), scales.least_mass) {
        // Elastic bodies do not use yield_p: it numbers the particles, so that tests find them.
        Particles& p = particles();
        const bool yields =
            std::any_of(laws.begin(), laws.end(), [](const auto& l) { return l.law.index() > 0; });
        for (std::size_t k = 0; k < p.yield_p.size(); ++k)
            p.yield_p[k] = yields ? 0 : static_cast<double>(k);
        prepare(state.assembly);
        nodes.sort(state.assembly.grains, p, state.frame);
        with_shape(c.scheme(), [&](const auto& shape) {
            start_leapfrog(shape, laws, contact, wanted.frozen, dt, nodes, state);
        });
    }
    explicit Run(const Case& c) : Run(c, [](Assembly&) {}) {}

    Particles& particles() { return state.assembly.particles; }
    const Ledger& ledger() const { return state.ledger; }

    void advance(long steps = 1) {
        with_shape(wanted.scheme(), [&](const auto& shape) {
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
        std::vector<Bond>& bonds = state.assembly.bonds;
        if (nodes.sort_is_due(state.frame)) nodes.sort(grains, at, state.frame);
        const BodyForce body = drive(wanted.problem, step, dt, rigid);
        put_on_nodes(shape, at, nodes);
        velocity_of_nodes(grains, rigid, nodes);
        contact.join_bonds(bonds, nodes);
        for_each_chunk(grains, nodes, strips, [&](Chunk& chunk) {
            velocity_gradient(shape, at, nodes, OldVelocity{}, dt, chunk);
            update_stress(laws, wanted.frozen, chunk, grains, at, strips);
            add_internal_force(shape, at, chunk, nodes);
            if (!wanted.frozen) turn_stress(chunk, at);
        });
        accelerate_nodes(body, grains, rigid, dt, nodes);
        in_contact = contact.apply(dt, nodes, bonds, rigid);
        at_nodes = work_on_nodes(body, dt, nodes);
        move_particles(shape, grains, rigid, nodes, wanted.flip, wanted.frozen, dt, at, strips);
        state.frame.moved += wanted.frozen ? 0 : dt * at_nodes.largest_speed;

        Ledger& l = state.ledger;
        enter_energies(step, strips, l);
        largest_budget = worst({largest_budget, std::fabs(l.budget())});
        largest_remap = worst({largest_remap, std::fabs(l.remap)});
        largest_energy = worst({largest_energy, l.kinetic + l.elastic});
        for (const StripSums& s : strips) least_V = std::min(least_V, s.least_V);
        enter_work(nodes.strips(), strips, at_nodes, in_contact, l);
        ++step;
    }
};

}  // namespace facts
