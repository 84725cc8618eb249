// Viscosity in the implicit material point method: the energy theorem with its term, the exact
// factor of one node, and that both solvers agree.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/support/any_theta_step.hpp"
#include "tests/support/sliding_modes.hpp"

namespace {

using namespace facts;

// A material called default, with this viscosity.
void make_viscous(Case& c, double beta, const std::string& law = "elastic") {
    Material m;
    m.viscosity = beta, m.yield_stress = 30, m.hardening = 500;
    add_material(c, "default", law, m);
}

// Two disks that hit and rub, a third at a frictional wall, under gravity, with damping.
Case crowd() {
    Case c = case_on(12, 12, 0.6);
    c.problem.grains = {disk_at("a", 0.2, 0.35, 0.1, 0.2, -0.05),
                        disk_at("b", 0.41, 0.39, 0.1, -0.2, -0.1),
                        disk_at("c", 0.35, 0.12, 0.1, 0.1, -0.2)};
    c.problem.grains[0].spin = 1;
    c.problem.walls = {"slip", "slip", "frictional", "open"};
    c.problem.contact.friction = c.problem.contact.wall_friction = 0.3;
    c.problem.gravity_y = -1, c.problem.damping = 0.5;
    return c;
}

}  // namespace

TEST_CASE("the energy theorem holds with viscosity whatever else is at work" *
          doctest::description("physics")) {
    std::size_t number = 0;
    for (const std::string kind : {"cg", "newton", "plastic", "updated volumes"})
        for (const double theta : {0.5, 0.75, 1.0}) {
            const double beta = std::array{3e-3, 0.1, 1e-4, 3e-3}[number % 4];
            Case c = crowd();
            c.shape = shape_names[number % 3];
            c.alpha = kind == "cg" ? 2 : kind == "updated volumes" ? 0.5 : 1;
            c.flip = kind == "newton" ? 0.95 : 1;
            make_viscous(c, beta, kind == "plastic" ? "j2" : "elastic");
            ThetaScheme s = theta_scheme(theta, number % 2 == 0 ? "consistent" : "lumped",
                                         kind == "cg" ? "projected_cg" : "newton_krylov");
            s.volumes = kind == "updated volumes" ? "updated" : "kept";
            CAPTURE(kind);
            CAPTURE(theta);
            CAPTURE(beta);
            CAPTURE(s.mass);
            CAPTURE(c.shape);
            ThetaRun run(c, s, [&](Assembly& all) {
                disturb(0.004, 0, 20 + number, all);
                shake(0.02, 20 + number, all);
            });
            const Budget& l = run.budget();
            bool falls = true;
            for (int step = 0; step < 20; ++step) {
                const double before = l.viscous;
                run.advance();
                falls = falls && l.viscous < before;
            }
            CHECK(falls);
            CHECK(l.viscous < -1e-4 * run.size);
            CHECK(l.friction < 0);
            CHECK(l.damping < 0);
            CHECK(run.identity() <= 1e-12);
            if (s.keeps_volumes()) CHECK(run.growth <= 1e-12 * run.size);
            if (kind == "plastic") CHECK(l.plastic > 0);
            ++number;
        }
}

TEST_CASE("one node with viscosity swings by the exact factor however long the step") {
    // v^theta = v^0 - theta z x^theta - theta b v^theta, x^theta = x^0 + theta z v^theta with z = w
    // dt, b = beta w^2 dt: of the step's matrix the trace T and the determinant D are below.
    for (const double theta : {0.5, 0.75, 1.0})
        for (const double alpha : {0.3, 3.0, 40.0})
            for (const double beta : {0.0, 1e-3, 0.1})
                for (const char* solver : {"projected_cg", "newton_krylov"}) {
                    Case c = case_on(2, 2, 0.2);
                    c.alpha = alpha, c.frozen = true;
                    c.problem.walls = {"slip", "slip", "slip", "slip"};
                    c.problem.grains = {box_at("a", 0.1, 0.1, 0.2, 0.2)};
                    c.problem.grains[0].profile = "wave", c.problem.grains[0].amplitude = 0.1;
                    make_viscous(c, beta);
                    CAPTURE(theta);
                    CAPTURE(alpha);
                    CAPTURE(beta);
                    ThetaRun run(c, theta_scheme(theta, "consistent", solver));
                    const Moduli T = moduli(Material{});
                    const double h = 0.1, P = T.lambda + 2 * T.G, n = 2,
                                 M = 1000 * h * (2.0 / 3 - 1.0 / (6 * n * n)),
                                 z2 = 2 * P / h / M * run.dt * run.dt, b = beta * z2 / run.dt,
                                 share = 1 + theta * b + theta * theta * z2;
                    // v^1 = v - (b v^theta + z x^theta), x^1 = x + z v^theta,
                    // v^theta = (v - theta z x)/share.
                    const double trace = 2 - (b + 2 * theta * z2) / share,
                                 determinant = 1 - (b + (2 * theta - 1) * z2) / share;
                    double older = 0, old = 0, off = 0, size = 0;
                    for (int step = 0; step < 12; ++step) {
                        run.begin();
                        const auto middle = static_cast<std::size_t>(run.nodes.origin(0, 1) + 1);
                        const double v = run.nodes.motion[middle].vx_0;
                        run.solve(), run.end();
                        if (step >= 2)
                            off = worst({off, std::fabs(v - trace * old + determinant * older)});
                        size = worst({size, std::fabs(v)});
                        older = old, old = v;
                    }
                    CHECK(off <= (alpha > 10 ? 1e-8 : 1e-11) * size);
                    CHECK(determinant <= 1);
                }
}

TEST_CASE("both solvers find the same velocities with viscosity") {
    for (const double beta : {1e-3, 0.05}) {
        Case c = crowd();
        c.problem.damping = 0;
        make_viscous(c, beta);
        ThetaRun cg(c, theta_scheme(0.75)),
            newton(c, theta_scheme(0.75, "consistent", "newton_krylov"));
        cg.advance(15), newton.advance(15);
        CHECK(cg.budget().kinetic == about(newton.budget().kinetic).epsilon(1e-7));
        CHECK(cg.budget().viscous == about(newton.budget().viscous).epsilon(1e-7));
    }
}

TEST_CASE("finite elements say that sliding flutters and that viscosity ends it") {
    const auto most = [](double friction, double viscosity, int cells) {
        SlidingBlock block;
        block.friction = friction, block.viscosity = viscosity;
        block.cells_x = cells, block.cells_y = cells / 2;
        double growth = -1e300;
        for (const SlidingMode& mode : sliding_modes(block))
            growth = std::max(growth, mode.s.real());
        return growth;
    };
    for (const double friction : {0.1, 0.3, 0.5, 0.55}) {
        CHECK(most(friction, 0, 8) > 5);
        CHECK(most(friction, 2e-3, 8) < -5);
        CHECK(most(friction, 3e-3, 8) < -30);
    }
    CHECK(std::fabs(most(0, 0, 8)) <= 1e-3);
    CHECK(most(0.55, 1e-3, 8) > 10);
    // The first mode that grows, and that it is of the block and not of the mesh.
    double before = 0;
    for (const int cells : {4, 8, 12}) {
        SlidingBlock block;
        block.friction = 0.55, block.cells_x = cells, block.cells_y = cells / 2;
        const double growth = first_flutter(sliding_modes(block)).s.real();
        if (cells > 4) CHECK(std::fabs(growth - before) <= 0.1 * growth);
        before = growth;
    }
}

TEST_CASE("a block that slides flutters as finite elements say and viscosity ends it" *
          doctest::description("physics")) {
    for (const double friction : {0.3, 0.55})
        for (const double viscosity : {0.0, 1e-3, 3e-3}) {
            SlidingBlock block;
            block.friction = friction;
            const SlidingMode kicked = first_flutter(sliding_modes(block));
            block.viscosity = viscosity;
            const auto modes = sliding_modes(block);
            const SlidingMode& mode = *std::min_element(
                modes.begin(), modes.end(), [&](const SlidingMode& a, const SlidingMode& b) {
                    return std::abs(a.s - kicked.s) < std::abs(b.s - kicked.s);
                });
            Case c = sliding_case(block, 3e-3);
            c.alpha = 0.5;
            ThetaRun run(c, theta_scheme(0.5));
            const std::complex<double> s = measured_exponent(block, kicked, viscosity, run);
            CAPTURE(friction);
            CAPTURE(viscosity);
            CAPTURE(s);
            CAPTURE(mode.s);
            CHECK(std::fabs(s.real() - mode.s.real()) <= 0.05 * std::fabs(kicked.s.real()));
            CHECK(std::fabs(s.imag() - mode.s.imag()) <= 0.02 * mode.s.imag());
        }
}
