// Viscosity in the explicit material point method: what it damps and what not, where the energy
// goes, and how long a step it bears.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mpm_explicit/theory/scheme_theory.hpp"
#include "tests/support/any_grains.hpp"
#include "tests/support/sliding_modes.hpp"

namespace {

using namespace facts;

// A material called default, with this viscosity.
void make_viscous(Case& c, double beta, const std::string& law = "elastic") {
    Material m;
    m.viscosity = beta, m.yield_stress = 100, m.hardening = 500;
    add_material(c, "default", law, m);
}

// Two cells between walls: one free node, frozen particles.
Case oscillator(long per_side, double beta) {
    Case c = case_on(2, 2, 2);
    c.frozen = true;
    c.problem.per_side = per_side, c.problem.walls = {"slip", "slip", "slip", "slip"};
    c.problem.grains = {box_at("a", 1, 1, 2, 2)};
    c.problem.grains[0].profile = "wave", c.problem.grains[0].amplitude = 1e-6;
    make_viscous(c, beta);
    return c;
}

}  // namespace

TEST_CASE("a rigid motion of the nodes feels no viscosity") {
    Random random(3);
    for_each_shape([&](const auto& shape, const std::string& name) {
        CAPTURE(name);
        Cloud cloud(mesh_of(12, 12, 0.1));
        cloud.begin_grain();
        for (int p = 0; p < 200; ++p)
            cloud.add(random(0.4, 0.8), random(0.4, 0.8), 1, random(-1, 1), random(-1, 1));
        GrainNodes nodes = cloud.on_nodes(shape);
        Material m;
        m.viscosity = 0.01;
        const std::vector<AnyLaw> laws = laws_of({m});
        std::vector<TileSums> sums;
        const double dt = 1e-3;
        // in: strains, whether the velocity is no rigid motion
        const auto taken = [&](double spin, double stretch) {
            for_each_dof(nodes, cloud.layout, [&](int, long i, long j, std::size_t dof) {
                const double x = 0.1 * real(i), y = 0.1 * real(j);
                nodes.motion[dof] = {3 - spin * y + stretch * x, -2 + spin * x, 0, 0};
            });
            for (NodeForce& f : nodes.force) f = {};
            for_each_batch(cloud.grains, nodes, sums, [&](ParticleBatch& batch) {
                velocity_gradient(shape, cloud.particles, nodes, OldVelocity{}, dt, batch);
                add_viscous_force(shape, laws, dt, batch, cloud.grains, cloud.particles, nodes,
                                  sums);
            });
            double sum = 0;
            for (const TileSums& tile : sums) sum += tile.viscous;
            return sum;
        };
        const auto largest_force = [&] {
            double most = 0;
            for (const NodeForce& f : nodes.force)
                most = worst({most, std::fabs(f.x), std::fabs(f.y)});
            return most;
        };
        // V = 1 of each: beta (lambda + 2G) e^2 dt in a uniform stretch.
        const double expected = 0.01 * (laws[0].T.lambda + 2 * laws[0].T.G) * 25 * dt * 200;
        CHECK(taken(0, 5) == about(expected).epsilon(1e-12));
        const double force = largest_force();
        CHECK(force > 0);
        CHECK(taken(5, 0) <= 1e-24 * expected);
        CHECK(largest_force() <= 1e-12 * force);
    });
}

TEST_CASE("one free node with viscosity is multiplied by the exact factor") {
    // v' = (1 - b - z^2) v - z^2 u, u' = v + u with z = w dt, b = beta w^2 dt: of the matrix the
    // trace is 2 - b - z^2 and the determinant 1 - b.
    for (const long n : {1L, 2L, 3L})
        for (const double beta : {0.0, 0.02, 0.3}) {
            Case c = oscillator(n, beta);
            c.alpha = 0.6;
            Run run(c);
            const double w = node_oscillator_frequency(int(n)) * sound_speed(Material{}),
                         dt = run.dt, z2 = w * w * dt * dt, b = beta * w * w * dt;
            std::vector<double> change;
            double before = 0;
            for (int step = 0; step < 40; ++step) {
                run.advance();
                double p = 0;
                for (const Momenta& one : run.budget().momenta_next) p += one.x;
                if (step > 0) change.push_back(p - before);
                before = p;
            }
            const double size = std::fabs(change[0]);
            for (std::size_t k = 2; k < change.size(); ++k)
                CHECK(std::fabs(change[k] - (2 - b - z2) * change[k - 1] +
                                (1 - b) * change[k - 2]) <= 1e-12 * size);
        }
}

TEST_CASE("viscosity shortens the step to just what leapfrog bears") {
    // The fastest wave of the mesh is taken to have w = 2 c/h. One free node has w h/c = 1 with one
    // particle in a cell: it bears up to z^2 + 2 b = 4, so to a step that is twice as long at beta
    // = 0.
    const double c_p = sound_speed(Material{}), h = 1;
    for (const double beta : {0.0, 0.1, 1.0}) {
        Material m;
        m.viscosity = beta;
        const double dt = h / c_p / viscous_shortening(m, h), w = 2 * c_p / h;
        CHECK(w * w * dt * dt + 2 * beta * w * w * dt == about(4).epsilon(1e-12));
        // The node: where the roots of its factor leave the unit circle.
        const double own = c_p / h, limit = (std::sqrt(beta * beta + 4 / (own * own)) - beta) *
                                            c_p / h * viscous_shortening(m, h);
        for (const double part : {0.99, 1.01}) {
            Case c = oscillator(1, beta);
            c.alpha = 2 * limit, c.dt = part * limit * dt;
            Run run(c);
            CHECK(run.dt == c.dt);
            const double start = run.budget().kinetic_next;
            run.advance(800);
            CHECK((run.budget().kinetic_next > 100 * start) == (part > 1));
        }
    }
}

TEST_CASE("viscosity only takes energy and the budget closes to round-off" *
          doctest::description("physics")) {
    std::size_t number = 0;
    for (const char* law : {"elastic", "j2"})
        for (const double beta : {1e-4, 3e-3, 0.1})
            for (const std::string kind : {"hit", "frozen", "plates", "ring"}) {
                Case c = case_on(30, 24, 1.5);
                c.shape = shape_names[number++ % 3];
                CAPTURE(law);
                CAPTURE(beta);
                CAPTURE(kind);
                CAPTURE(c.shape);
                make_viscous(c, beta, law);
                c.problem.contact.friction = 0.3, c.problem.contact.wall_friction = 0.4;
                c.problem.grains = {disk_at("a", 0.5, 0.55, 0.2, 0.4, 0.1),
                                    disk_at("b", 0.89, 0.6, 0.2, -0.4, -0.1)};
                c.frozen = kind == "frozen";
                if (kind == "ring") {
                    c.problem.periodic_x = true;
                    c.problem.walls = {"open", "open", "frictional", "open"};
                    c.problem.gravity_y = -2, c.problem.damping = 0.5;
                    c.problem.grains = {box_at("ring", 0.75, 0.25, 1.5, 0.5),
                                        disk_at("over", 0.1, 0.7, 0.2, 0.1, -0.2)};
                }
                if (kind == "plates") {
                    add_material(c, "steel", "rigid", Material{});
                    GrainCase below = box_at("below", 0.75, 0.2, 1.2, 0.2, 0.2), above = below;
                    above.name = "above", above.y = 1.0, above.velocity_x = 0;
                    above.control = "force_y", above.force = -300, above.damping = 100;
                    below.material = above.material = "steel";
                    c.problem.rise = 0.1;
                    c.problem.grains = {disk_at("a", 0.5, 0.6, 0.3), below, above};
                }
                Run run(c);
                const Budget& l = run.budget();
                bool falls = true;
                for (int step = 0; step < 150; ++step) {
                    const double before = l.viscous;
                    run.advance();
                    falls = falls && l.viscous <= before;
                }
                CHECK(falls);
                CHECK(l.viscous < -1e-6 * run.largest_energy);
                CHECK(run.largest_budget <=
                      1e-13 * worst({run.largest_energy, std::fabs(l.external)}));
            }
}

TEST_CASE("viscosity does not see how fast a grain flies") {
    // A wave in a box that flies by one cell per step, and in one at rest: with load.damping the
    // box slows down, with viscosity it keeps its momentum, and its wave decays alike.
    const auto flight = [](double velocity, double beta, double damping, double& kept) {
        Case c = case_on(60, 8, 6);
        c.problem.grains = {box_at("a", 0.6, 0.4, 0.8, 0.4, velocity)};
        c.problem.grains[0].profile = "wave", c.problem.grains[0].amplitude = 1e-3,
        c.problem.grains[0].mode = 2;
        c.problem.damping = damping;
        make_viscous(c, beta);
        const double dt = 0.002;
        Run run(
            c, [](Assembly&) {}, dt);
        run.advance(40);
        const auto p = run.budget().momenta_next[0].x;
        kept = velocity == 0 ? 1 : p / (velocity * 1000 * 0.8 * 0.4);
        const std::vector<std::size_t> where = run.by_number();
        std::vector<double> v;
        for (const std::size_t k : where) v.push_back(run.particles().vx_p[k] - velocity);
        return v;
    };
    double kept = 0;
    const std::vector<double> rest = flight(0, 3e-3, 0, kept), moves = flight(50, 3e-3, 0, kept);
    CHECK(kept == about(1).epsilon(1e-6));
    double off = 0, size = 0;
    for (std::size_t k = 0; k < rest.size(); ++k)
        off = worst({off, std::fabs(moves[k] - rest[k])}), size = worst({size, std::fabs(rest[k])});
    CHECK(off <= 1e-9 * size);
    (void)flight(50, 0, 5, kept);
    CHECK(kept == about(std::exp(-0.002 * 5 * 40)).epsilon(1e-6));
}

TEST_CASE("a block that slides flutters as finite elements say up to lumping" *
          doctest::description("physics")) {
    // Lumped mass and particles slow the mode down: by 9 % in frequency and a quarter in growth on
    // 8 x 4 cells, by a quarter of that on twice as many (the theta scheme has the finite elements'
    // own mass, and meets them to a few parts in a hundred on 8 x 4).
    SlidingBlock block;
    block.cells_x = 16, block.cells_y = 8, block.friction = 0.55;
    const SlidingMode mode = first_flutter(sliding_modes(block));
    Run run(
        sliding_case(block, 3e-3), [](Assembly&) {}, 1.3e-4);
    const std::complex<double> s = measured_exponent(block, mode, 0, run);
    CAPTURE(s);
    CAPTURE(mode.s);
    CHECK(std::fabs(s.real() - mode.s.real()) <= 0.1 * mode.s.real());
    CHECK(std::fabs(s.imag() - mode.s.imag()) <= 0.05 * mode.s.imag());
}
