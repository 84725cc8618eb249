// The implicit material point method in whole steps and short runs: the energy theorem term by
// term, momentum, what contact asks for, both solvers against each other, and what the theta scheme
// does to an oscillation.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <utility>
#include <vector>

#include "mpm_implicit/output/record.hpp"
#include "tests/support/any_theta_step.hpp"

namespace {

using namespace facts;

const std::array<const char*, 2> masses{"consistent", "lumped"},
    solvers{"projected_cg", "newton_krylov"};

// Two disks that are about to meet, one of them spinning, on a mesh of h = 0.05.
Case collision(double friction) {
    Case c = case_on(18, 12, 0.9);
    c.alpha = 2, c.problem.contact.friction = friction;
    c.problem.grains = {disk_at("left", 0.29, 0.28, 0.14, 0.1),
                        disk_at("right", 0.5675, 0.32, 0.14, -0.1)};
    c.problem.grains[0].spin = 0.5;
    return c;
}

// Four disks thrown together in a box, 0.006 cells apart.
Case crowd(double friction) {
    Case c = case_on(16, 16, 0.8);
    c.alpha = 2, c.problem.contact.friction = c.problem.contact.wall_friction = friction;
    c.problem.grains = {disk_at("a", 0.25, 0.26, 0.13, 0.1, 0.05),
                        disk_at("b", 0.5103, 0.265, 0.13, -0.1, 0.02),
                        disk_at("c", 0.3758, 0.4879, 0.13, 0.02, -0.1),
                        disk_at("d", 0.616, 0.4808, 0.11, -0.1, -0.1)};
    return c;
}

// Everything that a step can hold, by name.
std::vector<std::pair<std::string, Case>> everything() {
    std::vector<std::pair<std::string, Case>> all;
    const auto add = [&](const std::string& name, const Case& c) -> Problem& {
        all.push_back({name, c});
        return all.back().second.problem;
    };
    const auto plate = [](double x, double y, double width, double height) {
        GrainCase g = box_at("plate", x, y, width, height);
        g.material = "steel";
        return g;
    };
    add("contact", collision(0)), add("friction", collision(0.4)), add("crowd", crowd(0.3));
    add("walls", crowd(0.3)).walls = {"frictional", "slip", "stick", "frictional"};
    all.back().second.problem.grains[0] = box_at("a", 0.15, 0.15, 0.3, 0.3, 0.02, -0.03);
    add("gravity and damping", crowd(0.3)).walls = {"slip", "slip", "frictional", "open"};
    all.back().second.problem.gravity_x = 0.3, all.back().second.problem.gravity_y = -1;
    all.back().second.problem.damping = 0.5, all.back().second.problem.rise = 0.2;
    all.back().second.problem.grains[0] = box_at("a", 0.3, 0.11, 0.3, 0.2);

    Case pressed = collision(0.3);
    add_material(pressed, "steel", "rigid", Material{});
    pressed.problem.walls = {"frictional", "open", "open", "open"};
    pressed.problem.contact.wall_friction = 0.2;
    pressed.problem.grains = {box_at("block", 0.16, 0.3, 0.3, 0.4), plate(0.37, 0.3, 0.1, 0.5)};
    pressed.problem.grains[1].velocity_x = -0.1, pressed.problem.grains[1].velocity_y = 0.05;
    add("moving plate", pressed);
    Problem& control = add("force control", pressed);
    control.grains[1].control = "force_x", control.grains[1].force = -8;
    control.grains[1].damping = 20;

    Case ring = collision(0.3);
    ring.problem.periodic_x = true;
    ring.problem.grains = {box_at("ring", 0.45, 0.15, 0.9, 0.2, 0.05),
                           disk_at("over", 0.02, 0.39, 0.14, -0.1, -0.1)};
    add("periodic", ring);

    Case bonded = collision(0.3);
    bonded.problem.grains = {box_at("a", 0.3, 0.3, 0.2, 0.2, -0.05, 0.02),
                             box_at("b", 0.5, 0.3, 0.2, 0.2, 0.05, -0.02)};
    bonded.problem.bonds.push_back({"all"});
    add("bonds that hold", bonded);
    bonded.problem.bonds[0].tension = 20, bonded.problem.bonds[0].shear = 20;
    add("bonds that break", bonded);
    add("pic", collision(0.2));
    all.back().second.flip = 0.9;
    return all;
}

// A case after twenty steps, with some disorder in places and velocities.
ThetaRun follow(const Case& c, const ThetaScheme& s, std::uint64_t seed, double speed = 0.02) {
    ThetaRun run(c, s, [&](Assembly& all) {
        disturb(0.004, 0, seed, all);
        shake(speed, seed, all);
    });
    run.advance(20);
    return run;
}

std::array<double, 3> total_momentum(const Assembly& all) {
    std::array<double, 3> sum{};  // and the sum of sizes
    const Particles& p = all.particles;
    for (const Grain& grain : all.grains)
        for (long k = grain.begin; k < grain.end && !grain.rigid; ++k) {
            const auto n = static_cast<std::size_t>(k);
            sum[0] += p.m_p[n] * p.vx_p[n], sum[1] += p.m_p[n] * p.vy_p[n];
            sum[2] += p.m_p[n] * std::hypot(p.vx_p[n], p.vy_p[n]);
        }
    return sum;
}

double angular_momentum(const Assembly& all) {
    double sum = 0;
    for (const Momenta& one : momenta_of(all)) sum += one.angular;
    return sum;
}

// The largest difference of v^theta between two runs with the same nodes, over the largest.
double difference_of_nodes(const ThetaRun& one, const ThetaRun& two) {
    double off = one.nodes.size() == two.nodes.size() ? 0 : 1e300, size = 0;
    for (std::size_t k = 0; k < one.nodes.motion.size(); ++k) {
        const NodeMotion &a = one.nodes.motion[k], &b = two.nodes.motion[k];
        const double m = one.nodes.sums[k].m;
        if (!(m > one.nodes.least_mass())) continue;
        off = worst({off, std::fabs(a.vx_1 - b.vx_1), std::fabs(a.vy_1 - b.vy_1)});
        size = worst({size, std::fabs(a.vx_1), std::fabs(a.vy_1)});
    }
    return off / size;
}

// Calls visit(shape, p, dof, S, Gx, Gy) for the nodes that particle p sees.
template <class Visit>
void for_each_weight(ThetaRun& run, const Visit& visit) {
    run.with([&](const auto& shape, auto&) {
        const Locator at(run.nodes.mesh());
        const Particles& p = run.particles();
        for (std::size_t g = 0; g < run.grains().size(); ++g)
            for (long k = run.grains()[g].begin; k < run.grains()[g].end; ++k) {
                const auto n = static_cast<std::size_t>(k);
                for_each_node(shape, at, run.nodes.origins(static_cast<int>(g)), p.x_p[n], p.y_p[n],
                              [&](long dof, double S, double Gx, double Gy) {
                                  visit(n, run.nodes.motion[static_cast<std::size_t>(dof)], S, Gx,
                                        Gy);
                              });
            }
    });
}

}  // namespace

// ---- the energy theorem -------------------------------------------------------------------------

TEST_CASE("the energy theorem holds in every step whatever it holds" *
          doctest::description("physics")) {
    double counted = 0;
    std::size_t number = 0;
    for (const auto& each : everything()) {
        const std::string name = each.first;
        const bool bonded = name.substr(0, 5) == "bonds";
        double friction = 0, plate = 0, gravity = 0, damping = 0, bond = 0, pic = 0, pressed = 0;
        long broken = 0;
        for (std::size_t t = 0; t < 3; ++t) {
            for (std::size_t m = 0; m < 2; ++m, ++number) {
                const double theta = std::array{0.5, 0.75, 1.0}[t];
                Case c = each.second;
                c.shape = shape_names[(number + t) % 3];
                const ThetaScheme s = theta_scheme(theta, masses[m], solvers[(number / 3 + m) % 2]);
                c.alpha = s.newton() ? 0.5 : std::array{0.5, 2.0, 5.0}[(number / 2) % 3];
                CAPTURE(name);
                CAPTURE(theta);
                CAPTURE(s.mass);
                CAPTURE(s.solver);
                CAPTURE(c.shape);
                ThetaRun run = follow(c, s, 1 + number);
                const Budget& l = run.budget();
                CHECK(run.identity() <= 1e-12);
                // The energy is that of the particles.
                Budget now;
                start_budget(run.state.assembly, run.laws, now);
                counted = worst({counted, std::fabs(now.energy() - l.energy()) / run.size});
                // What the scheme takes is not negative; contact does no work.
                if (theta == 0.5) CHECK((l.theta_velocity == 0 && l.theta_strain == 0));
                if (theta > 0.5) CHECK((l.theta_velocity > 0 && l.theta_strain > 0));
                CHECK((m == 0 ? l.lumped == 0 : l.lumped > 0));
                CHECK(std::fabs(l.contact) <= 1e-10 * run.size);
                CHECK(l.friction <= 1e-12 * run.size);
                CHECK(l.damping <= 0);
                CHECK((l.plastic == 0 && l.volume == 0));
                friction -= l.friction, plate += std::fabs(l.plate), gravity += l.gravity;
                damping -= l.damping, bond += std::fabs(l.bond) / run.size, pic -= l.pic / run.size;
                pressed += run.sums.contact.nodes;
                for (const Bond& one : run.state.assembly.bonds) broken += one.broken;
            }
        }
        CHECK((pressed > 0) == !bonded);
        CHECK((friction > 0) == (name != "contact" && !bonded));
        CHECK((plate > 0) == (name == "moving plate" || name == "force control"));
        CHECK((gravity != 0) == (name == "gravity and damping"));
        CHECK((damping > 0) == (name == "gravity and damping"));
        // Frictional walls take the velocity into them from particles that they stop.
        const auto& walls = each.second.problem.walls;
        if (std::ranges::count(walls, "frictional") == 0)
            CHECK((pic > 1e-6) == (name == "pic"));
        else
            CHECK(pic >= -1e-15);
        if (name == "bonds that break") CHECK(broken >= 5);
        if (name == "bonds that hold") CHECK(broken == 0);
        if (name == "bonds that hold") CHECK(bond <= 1e-10);
    }
    CHECK(counted <= 1e-13);
}

TEST_CASE("the energy theorem holds for grains that yield and volumes that change" *
          doctest::description("physics")) {
    std::size_t number = 0;
    for (const char* law : {"j2", "drucker_prager", "elastic"}) {
        for (const double theta : {0.5, 0.75, 1.0}) {
            for (const char* mass : masses) {
                const std::string which = law;
                const bool sand = which == "drucker_prager";
                Case c = collision(0.3);
                c.shape = shape_names[number++ % 3];
                c.alpha = sand ? 0.2 : 1;
                Material of;
                of.yield_stress = 30, of.hardening = 500, of.cohesion = 20, of.tension = 20;
                add_material(c, "soft", law, of);
                for (GrainCase& g : c.problem.grains) g.material = "soft", g.velocity_x *= 2;
                ThetaScheme s = theta_scheme(theta, mass, "newton_krylov");
                s.volumes = which == "elastic" || theta == 0.75 ? "updated" : "kept";
                CAPTURE(which);
                CAPTURE(theta);
                CAPTURE(s.mass);
                CAPTURE(s.volumes);
                CAPTURE(c.shape);
                ThetaRun run = follow(c, s, number, sand ? 0.15 : 0.02);
                const Budget& l = run.budget();
                CHECK(run.identity() <= 1e-12);
                CHECK((std::fabs(l.plastic) > 1e-3 * run.size) == (which != "elastic"));
                if (which == "j2") CHECK(l.plastic > 0);
                CHECK((std::fabs(l.volume) > 1e-9 * run.size) == !s.keeps_volumes());
            }
        }
    }
}

TEST_CASE("damping takes the same part of all velocities after a step and nothing else of it") {
    for (const char* solver : solvers) {
        CAPTURE(solver);
        Case c = collision(0.3);
        c.alpha = 5;
        const double rate = 4;
        const auto step = [&](double damping) {
            c.problem.damping = damping;
            ThetaRun run(c, theta_scheme(0.5, "consistent", solver),
                         [](Assembly& all) { shake(0.05, 3, all); });
            run.advance();
            return run;
        };
        ThetaRun free = step(0), damped = step(rate);
        const Particles &one = free.particles(), &two = damped.particles();
        const double keeps = std::exp(-rate * free.dt);
        CHECK(keeps < 0.9);
        for (std::size_t p = 0; p < one.x_p.size(); ++p) {
            CHECK(two.vx_p[p] == keeps * one.vx_p[p]);
            CHECK(two.vy_p[p] == keeps * one.vy_p[p]);
            CHECK(two.x_p[p] == one.x_p[p]);
            CHECK(two.sxx_p[p] == one.sxx_p[p]);
        }
        CHECK(damped.identity() <= 1e-12);
    }
}

TEST_CASE("theta one half with the consistent mass keeps the energy of grains that collide") {
    for (const std::string& shape : shape_names) {
        for (const char* solver : solvers) {
            for (const double alpha : {1.5, 5.0}) {
                CAPTURE(shape);
                CAPTURE(alpha);
                Case c = collision(0);
                c.shape = shape, c.alpha = alpha;
                ThetaRun run(c, theta_scheme(0.5, "consistent", solver),
                             [](Assembly& all) { shake(0.05, 3, all); });
                const double before = run.budget().energy();
                double pressed = 0;
                for (int k = 0; k < 20; ++k) {
                    run.advance();
                    pressed += run.sums.contact.nodes;
                }
                CHECK(pressed > 10);
                CHECK(run.budget().elastic > 1e-3 * before);
                CHECK(std::fabs(run.budget().energy() / before - 1) <= 1e-11);
            }
        }
    }
}

TEST_CASE("nothing gives energy to random grains whatever the time step" *
          doctest::description("physics")) {
    std::uint64_t number = 0;
    for (const double theta : {0.5, 0.55, 0.8, 1.0}) {
        for (const double alpha : {0.3, 3.0, 20.0, 100.0}) {
            for (const char* mass : masses) {
                Case c = crowd(number % 3 == 0 ? 0 : 0.4);
                c.shape = shape_names[++number % 3];
                c.alpha = alpha;
                c.problem.walls = {"slip", "frictional", "frictional", "stick"};
                // A fraction of a cell in a step.
                const double slower = std::min(1.0, 3 / alpha);
                for (GrainCase& g : c.problem.grains)
                    g.velocity_x *= slower, g.velocity_y *= slower;
                const ThetaScheme s =
                    theta_scheme(theta, mass, solvers[number % 5 == 0 && alpha < 5]);
                CAPTURE(theta);
                CAPTURE(alpha);
                CAPTURE(s.mass);
                CAPTURE(s.solver);
                CAPTURE(c.shape);
                CAPTURE(c.problem.contact.friction);
                ThetaRun run(c, s, [&](Assembly& all) {
                    disturb(0.008, 20 * slower, number, all);
                    shake(0.2 * slower, number, all);
                });
                run.advance(8);
                CHECK(run.growth <= 1e-12 * run.size);
                CHECK(run.identity() <= 1e-11);
            }
        }
    }
}

TEST_CASE("gravity does exactly the work of the way that grains fall") {
    for (const double theta : {0.5, 0.8}) {
        for (const std::string& shape : shape_names) {
            Case c = case_on(16, 16, 0.8);
            c.shape = shape, c.alpha = 1;
            c.problem.gravity_x = 0.4, c.problem.gravity_y = -2;
            c.problem.grains = {disk_at("a", 0.4, 0.55, 0.13, 0.1, 0.2)};
            ThetaRun run(c, theta_scheme(theta));
            const double y = c.problem.grains[0].y;
            const long steps = 15;
            double m = 0, before = 0, after = 0, x_before = 0, x_after = 0;
            const auto center = [&](double& mx, double& my) {
                m = mx = my = 0;
                const Particles& p = run.particles();
                for (std::size_t k = 0; k < p.x_p.size(); ++k)
                    m += p.m_p[k], mx += p.m_p[k] * p.x_p[k], my += p.m_p[k] * p.y_p[k];
                mx /= m, my /= m;
            };
            center(x_before, before);
            CHECK(before == about(y).epsilon(1e-12));
            run.advance(steps);
            center(x_after, after);
            // All of it moves with v^theta: sum_k dt (v_0 + (k + theta) g dt).
            const double n = real(steps), t = n * run.dt,
                         far = 0.5 * t * t + (theta - 0.5) * n * run.dt * run.dt;
            CHECK(std::fabs(after - before - 0.2 * t + 2 * far) <= 1e-13);
            CHECK(std::fabs(x_after - x_before - 0.1 * t - 0.4 * far) <= 1e-13);
            const double work = m * (0.4 * (x_after - x_before) - 2 * (after - before));
            CHECK(std::fabs(run.budget().gravity - work) <= 1e-12 * work);
            CHECK(run.budget().elastic <= 1e-20 * work);
            if (theta == 0.5)
                CHECK(std::fabs(run.budget().energy() - run.budget().start - work) <= 1e-12 * work);
        }
    }
}

// ---- momentum -----------------------------------------------------------------------------------

TEST_CASE("the momentum of all grains stays with contact and friction and bonds") {
    double off = 0;
    std::uint64_t number = 0;
    for (const std::string& shape : shape_names) {
        for (const char* mass : masses) {
            for (const char* solver : solvers) {
                Case c = crowd(0.4);
                c.shape = shape;
                c.problem.bonds.push_back({"glue", "a", "b"});
                ThetaRun run(c, theta_scheme(0.6, mass, solver), [&](Assembly& all) {
                    disturb(0.004, 5, ++number, all);
                    shake(0.05, number, all);
                });
                const auto before = total_momentum(run.state.assembly);
                double pressed = 0;
                for (int step = 0; step < 12; ++step)
                    run.advance(), pressed += run.sums.contact.nodes;
                CHECK(pressed > 0);
                CHECK(!run.state.assembly.bonds[0].broken);
                const auto after = total_momentum(run.state.assembly);
                off = worst({off, std::fabs(after[0] - before[0]) / before[2],
                             std::fabs(after[1] - before[1]) / before[2]});
                const Budget& l = run.budget();
                double x = 0, y = 0;
                for (std::size_t g = 0; g < 4; ++g) x += l.momenta[g].x, y += l.momenta[g].y;
                CHECK(std::fabs(x - after[0]) <= 1e-13 * before[2]);
                CHECK(std::fabs(y - after[1]) <= 1e-13 * before[2]);
            }
        }
    }
    CHECK(off <= 1e-13);
}

TEST_CASE("a free grain keeps its momentum where its particles land on lines of nodes") {
    // The node beyond has no mass there, and the gradient asks for its velocity.
    for (const std::string& shape : shape_names) {
        for (const char* mass : masses) {
            for (const char* solver : solvers) {
                Case c = case_on(24, 24, 1.2);
                c.shape = shape, c.alpha = 30;
                c.problem.grains = {box_at("a", 0.6, 0.6, 0.3, 0.3, -0.1)};
                c.dt = 0.0125 / 0.1;  // a quarter of a cell
                ThetaRun run(c, theta_scheme(0.5, mass, solver));
                run.advance(9);
                CHECK(run.budget().elastic <= 1e-20);
                CHECK(std::fabs(run.budget().momenta[0].x + 0.1 * 1000 * 0.09) <= 1e-10);
            }
        }
    }
}

TEST_CASE("forces and contact keep the angular momentum of all grains with the consistent mass") {
    // Particles that move keep it to second order in the step; frozen ones show that forces,
    // contact, friction and bonds keep it.
    for (const std::string& shape : shape_names) {
        for (const char* solver : solvers) {
            Case c = crowd(0.4);
            c.shape = shape, c.frozen = true;
            c.problem.bonds.push_back({"glue", "a", "b"});
            ThetaRun run(c, theta_scheme(0.5, "consistent", solver), [&](Assembly& all) {
                disturb(0.004, 5, 7, all);
                shake(0.05, 7, all);
            });
            const double before = angular_momentum(run.state.assembly);
            run.advance(12);
            CHECK(run.sums.contact.nodes > 0);
            CHECK(std::fabs(angular_momentum(run.state.assembly) - before) <=
                  1e-12 * total_momentum(run.state.assembly)[2]);
        }
    }
}

TEST_CASE("a plate gives what grains get and obeys its own law of motion") {
    double off = 0;
    for (const char* solver : solvers) {
        for (const char* control : {"velocity", "force_x"}) {
            for (const std::string& shape : shape_names) {
                Case c = collision(0.3);
                c.shape = shape, c.problem.rise = 0.05;
                add_material(c, "steel", "rigid", Material{});
                c.problem.grains = {box_at("block", 0.25, 0.3, 0.3, 0.3),
                                    box_at("plate", 0.46, 0.3, 0.1, 0.4, -0.1, 0.05)};
                c.problem.grains[1].material = "steel", c.problem.grains[1].control = control;
                c.problem.grains[1].force = -8, c.problem.grains[1].damping = 15;
                ThetaRun run(c, theta_scheme(0.7, "consistent", solver));
                const RigidMotion& is = run.state.assembly.rigid[1];
                double travel = 0;
                for (int k = 0; k < 15; ++k) {
                    const auto before = total_momentum(run.state.assembly);
                    const double V = is.vx, t = time_of_load(run.step, run.dt);
                    run.advance();
                    const auto after = total_momentum(run.state.assembly);
                    const double size = 1e-3 + after[2];
                    off = worst({off, std::fabs(after[0] - before[0] + run.dt * is.push_x) / size,
                                 std::fabs(after[1] - before[1] + run.dt * is.push_y) / size});
                    // m (V^1 - V^0) = dt (F + push - c V^theta)
                    const bool driven = is.force_control_x;
                    const double V_theta = driven ? 0.3 * V + 0.7 * is.vx : is.vx;
                    travel += run.dt * V_theta;
                    CHECK(std::fabs(is.travel_x - travel) <= 1e-15);
                    if (!driven) continue;
                    const double F = share_of_load(t, 0.05) * is.force;
                    off = worst({off, std::fabs(is.mass * (is.vx - V) -
                                                run.dt * (F + is.push_x - 15 * V_theta)) /
                                          (is.mass * std::fabs(is.vx))});
                }
                CHECK(total_momentum(run.state.assembly)[0] < -0.1);
            }
        }
    }
    CHECK(off <= 1e-10);
}

TEST_CASE("a plate under a force swings on a block without loss at theta = 1/2") {
    for (const double theta : {0.5, 0.8}) {
        for (const char* solver : solvers) {
            Case c = collision(0);
            c.shape = "gimp";
            Material heavy;
            heavy.density = 20000;
            add_material(c, "steel", "rigid", heavy);
            c.problem.walls = {"slip", "slip", "open", "open"};
            c.problem.grains = {box_at("block", 0.15, 0.3, 0.3, 0.3),
                                box_at("plate", 0.35, 0.3, 0.1, 0.4)};
            c.problem.grains[1].material = "steel", c.problem.grains[1].control = "force_x";
            c.problem.grains[1].force = -30;
            ThetaRun run(c, theta_scheme(theta, "consistent", solver));
            const RigidMotion& is = run.state.assembly.rigid[1];
            double least = 0, largest = 0, deepest = 0, V = 0, lost = 0;
            for (int k = 0; k < 200; ++k) {
                const double before = is.vx;
                run.advance();
                const Budget& b = run.state.budget;
                V = is.vx, lost += (theta - 0.5) * is.mass * (V - before) * (V - before);
                const double total = b.energy() + 0.5 * is.mass * V * V - is.force * is.travel_x -
                                     b.volume - b.pic + lost + b.theta_velocity + b.theta_strain;
                least = std::min(least, total), largest = std::max(largest, total);
                deepest = std::max(deepest, is.force * is.travel_x);
            }
            CAPTURE(deepest);
            CHECK(largest - least <= 1e-9 * deepest);
        }
    }
}

TEST_CASE("boxes that are bonded move as one box does") {
    // Smoother shapes tie light nodes at the joint that one box does not have.
    double off = 0;
    for (const double theta : {0.5, 0.8}) {
        for (const char* mass : masses) {
            for (const char* solver : solvers) {
                Case whole = collision(0.3), halves = whole;
                whole.problem.grains = {box_at("a", 0.45, 0.3, 0.4, 0.2)};
                halves.problem.grains = {box_at("a", 0.35, 0.3, 0.2, 0.2),
                                         box_at("b", 0.55, 0.3, 0.2, 0.2)};
                halves.problem.bonds.push_back({"all"});
                const auto move = [](Assembly& all) {
                    Particles& p = all.particles;
                    for (std::size_t k = 0; k < p.x_p.size(); ++k) {
                        p.vx_p[k] = 0.05 * std::sin(9 * p.x_p[k] + 7 * p.y_p[k]);
                        p.vy_p[k] = 0.05 * std::cos(11 * p.x_p[k] - 5 * p.y_p[k]);
                    }
                };
                ThetaRun one(whole, theta_scheme(theta, mass, solver), move),
                    two(halves, theta_scheme(theta, mass, solver), move);
                one.advance(4), two.advance(4);
                off = worst({off, unlike(one.particles(), two.particles())});
                CHECK(std::fabs(one.budget().energy() - two.budget().energy()) <= 1e-10 * one.size);
            }
        }
    }
    CHECK(off <= 1e-10);
}

// ---- what contact asks for ----------------------------------------------------------------------

TEST_CASE("impulses press and gaps stay open and friction is Coulomb's at the solution") {
    long pressed = 0, stuck = 0, slipped = 0, open = 0;
    double approach = 0, pull = 0, both = 0, rub = 0, with = 0;
    std::uint64_t number = 0;
    for (const double mu : {0.0, 0.2, 0.8}) {
        for (const std::string& shape : shape_names) {
            for (const char* solver : solvers) {
                Case c = crowd(mu);
                c.shape = shape, c.alpha = number % 2 == 0 ? 1 : 4;
                c.problem.walls = {"frictional", "open", "frictional", "slip"};
                for (GrainCase& g : c.problem.grains) g.x -= 0.1197, g.y -= 0.1297;
                ThetaRun run(
                    c, theta_scheme(number % 2 == 0 ? 0.5 : 0.8, masses[number / 2 % 2], solver),
                    [&](Assembly& all) { shake(0.1, ++number, all); });
                for (int step = 0; step < 8; ++step) {
                    run.begin(), run.solve();
                    {
                        const ActiveSet& set = run.set();
                        double press = 0, speed = 0;
                        for (const ContactPair& pair : set.list.pairs)
                            press = std::max(press, std::fabs(pair.lambda_n));
                        for (const NodeMotion& v : run.nodes.motion)
                            speed = std::max({speed, std::fabs(v.vx_1), std::fabs(v.vy_1)});
                        for (const ContactList::Node& node : set.list.nodes) {
                            for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
                                const ContactPair& pair = set.list.pairs[k];
                                const auto of = [&](std::size_t who) -> std::array<double, 2> {
                                    const ContactBody& is = set.list.bodies[node.body_begin + who];
                                    if (is.is_fixed()) return {is.vx, is.vy};
                                    const NodeMotion& v =
                                        run.nodes.motion[static_cast<std::size_t>(is.dof)];
                                    return {v.vx_1, v.vy_1};
                                };
                                double x = 0, y = 0;
                                for (const ContactLink& link : pair.all_links()) {
                                    const auto a = of(static_cast<std::size_t>(link.a)),
                                               b = of(static_cast<std::size_t>(link.b));
                                    x += link.weight * (b[0] - a[0]) / speed;
                                    y += link.weight * (b[1] - a[1]) / speed;
                                }
                                const double parts = x * pair.nx + y * pair.ny,
                                             slip = y * pair.nx - x * pair.ny,
                                             n = pair.lambda_n / press, t = pair.lambda_t / press;
                                approach = worst({approach, std::max(0.0, -parts)});
                                pull = worst({pull, std::max(0.0, -n)});
                                both = worst({both, std::fabs(n * parts)});
                                rub = worst({rub, std::max(0.0, std::fabs(t) - mu * n)});
                                with = worst({with, std::max(0.0, t * slip)});
                                // Who slips rubs as much as it can.
                                if (std::fabs(slip) > 1e-6)
                                    rub = worst(
                                        {rub, std::fabs(std::fabs(t) - mu * std::max(0.0, n))});
                                pressed += n > 1e-9, open += parts > 1e-9;
                                if (mu > 0 && n > 1e-9)
                                    (std::fabs(slip) > 1e-6 ? slipped : stuck) += 1;
                            }
                        }
                    }
                    run.end();
                }
            }
        }
    }
    CHECK(approach <= 1e-10);
    CHECK(pull <= 1e-10);
    CHECK(both <= 1e-10);
    CHECK(rub <= 1e-8);
    CHECK(with <= 1e-10);
    CHECK(pressed >= 500);
    CHECK(open >= 200);
    CHECK(stuck >= 100);
    CHECK(slipped >= 100);
}

TEST_CASE("both solvers find the same velocities") {
    long pressed = 0;
    std::uint64_t number = 0;
    for (const std::string& shape : shape_names) {
        for (const char* mass : masses) {
            for (const double mu : {0.0, 0.3}) {
                for (const double alpha : {0.5, 5.0}) {
                    Case c = crowd(mu);
                    c.shape = shape, c.alpha = alpha;
                    c.problem.walls = {"frictional", "open", "slip", "open"};
                    for (GrainCase& g : c.problem.grains) g.x -= 0.1197, g.y -= 0.1297;
                    ++number;
                    const auto prepare = [&](Assembly& all) {
                        disturb(0.002, 10, number, all);
                        shake(0.05, number, all);
                    };
                    ThetaRun one(c, theta_scheme(0.6, mass, solvers[0]), prepare),
                        two(c, theta_scheme(0.6, mass, solvers[1]), prepare);
                    for (ThetaRun* run : {&one, &two}) run->begin(), run->solve();
                    pressed += static_cast<long>(one.sums.contact.nodes);
                    for (const ThetaRun* run : {&one, &two}) CHECK(run->sums.solver.iterations > 0);
                    const double off = difference_of_nodes(one, two);
                    CAPTURE(shape);
                    CAPTURE(mu);
                    CAPTURE(alpha);
                    CHECK(off <= (mu > 0 ? 1e-6 : 1e-9));
                }
            }
        }
    }
    CHECK(pressed >= 20);
}

// ---- the theta scheme ---------------------------------------------------------------------------

TEST_CASE("one node between walls swings by the factor of the theta scheme") {
    std::array<double, 2> off{};  // of both solvers
    for (const double theta : {0.5, 0.75, 1.0}) {
        for (const long n : {2L, 3L}) {
            for (const double alpha : {0.3, 3.0, 40.0}) {
                for (const std::size_t kind : {std::size_t{0}, std::size_t{1}}) {
                    Case c = case_on(2, 2, 0.2);
                    c.alpha = alpha, c.frozen = true;
                    c.problem.per_side = n, c.problem.walls = {"slip", "slip", "slip", "slip"};
                    c.problem.grains = {box_at("a", 0.1, 0.1, 0.2, 0.2)};
                    c.problem.grains[0].profile = "wave", c.problem.grains[0].amplitude = 0.1;
                    ThetaRun run(c, theta_scheme(theta, "consistent", solvers[kind]));
                    run.begin();
                    const auto middle = static_cast<std::size_t>(run.nodes.origin(0, 1) + 1);
                    const double u_0 = run.nodes.motion[middle].vx_0;
                    CHECK(u_0 > 0.05);
                    const Material m;
                    const double h = 0.1, G = 0.5 * m.E / (1 + m.nu),
                                 P = 2 * G * (1 - m.nu) / (1 - 2 * m.nu), k = 2 * P / h,
                                 M = m.density * h * (2.0 / 3 - 1.0 / (6 * real(n * n))),
                                 omega = std::sqrt(k / M), z = omega * run.dt;
                    const std::complex<double> i(0, 1),
                        g = (1.0 + i * (1 - theta) * z) / (1.0 - i * theta * z);
                    std::complex<double> wave = u_0;  // u + i omega x
                    for (int step = 0; step < 40; ++step) {
                        if (step > 0) run.begin();
                        run.solve(), run.end();
                        wave *= g;
                        const NodeMotion& v = run.nodes.motion[middle];
                        const double u = v.vx_0 + (v.vx_1 - v.vx_0) / theta;
                        off[kind] = worst({off[kind], std::fabs(u - wave.real()) / u_0});
                        // Strain of the cells is x/h to the left, -x/h to the right.
                        const Particles& p = run.particles();
                        for (std::size_t q = 0; q < p.x_p.size(); ++q) {
                            const double x = (p.x_p[q] < 0.1 ? 1 : -1) * p.sxx_p[q] / P * h;
                            off[kind] =
                                worst({off[kind], std::fabs(x * omega - wave.imag()) / u_0});
                        }
                    }
                }
            }
        }
    }
    CHECK(off[0] <= 1e-11);
    // Where the step is a hundred times that of stability, round-off of the residual is larger.
    CHECK(off[1] <= 1e-8);
}

TEST_CASE("particles move and strain with v theta and take the change of velocity of the nodes") {
    double moved = 0, faster = 0, strained = 0, turned = 0;
    for (const std::string& shape : shape_names) {
        for (const bool frozen : {false, true}) {
            Case c = crowd(0.3);
            c.shape = shape, c.frozen = frozen;
            const double theta = 0.7;
            ThetaRun run(c, theta_scheme(theta), [](Assembly& all) {
                disturb(0.004, 10, 5, all);
                shake(0.05, 5, all);
            });
            run.advance(2);
            run.begin(), run.solve();
            const Particles before = run.particles();
            const std::size_t count = before.x_p.size();
            std::vector<std::array<double, 4>> v(count, {0, 0, 0, 0}), L = v;
            for_each_weight(
                run, [&](std::size_t p, const NodeMotion& of, double S, double Gx, double Gy) {
                    v[p][0] += S * of.vx_1, v[p][1] += S * of.vy_1;
                    v[p][2] += S * (of.vx_1 - of.vx_0) / theta;
                    v[p][3] += S * (of.vy_1 - of.vy_0) / theta;
                    L[p][0] += run.dt * Gx * of.vx_1, L[p][1] += run.dt * Gy * of.vy_1;
                    L[p][2] += 0.5 * run.dt * (Gy * of.vx_1 + Gx * of.vy_1);
                    L[p][3] += 0.5 * run.dt * (Gx * of.vy_1 - Gy * of.vx_1);
                });
            run.end();
            const Particles& after = run.particles();
            const double way = frozen ? 0 : run.dt;
            const Elastic law{Material{}};
            for (std::size_t p = 0; p < count; ++p) {
                moved = worst({moved, std::fabs(after.x_p[p] - before.x_p[p] - way * v[p][0]),
                               std::fabs(after.y_p[p] - before.y_p[p] - way * v[p][1])});
                faster = worst({faster, std::fabs(after.vx_p[p] - before.vx_p[p] - v[p][2]),
                                std::fabs(after.vy_p[p] - before.vy_p[p] - v[p][3])});
                // A quarter of the turn of G_ip enters the mean; frozen grains turn nothing.
                const double t = before.turn_p[p],
                             now = (L[p][3] - 0.5 * t * (L[p][0] + L[p][1])) / (1 + t * t);
                turned = worst({turned, std::fabs(after.turn_p[p] - t -
                                                  (frozen ? 0 : 0.25 * (0.5 * now - t)))});
                if (!frozen) continue;
                const double around = law.T.lambda * (L[p][0] + L[p][1]), twice = 2 * law.T.G;
                strained =
                    worst({strained,
                           std::fabs(after.sxx_p[p] - before.sxx_p[p] - around - twice * L[p][0]),
                           std::fabs(after.syy_p[p] - before.syy_p[p] - around - twice * L[p][1]),
                           std::fabs(after.sxy_p[p] - before.sxy_p[p] - twice * L[p][2]),
                           std::fabs(after.szz_p[p] - before.szz_p[p] - around)});
            }
        }
    }
    CHECK(moved <= 1e-15);
    CHECK(faster <= 1e-15);
    CHECK(strained <= 1e-11);
    CHECK(turned <= 1e-15);
}

TEST_CASE("volumes stay bit for bit or grow by 1 + tr de") {
    for (const std::string& shape : shape_names) {
        ThetaRun kept(crowd(0.3), theta_scheme(0.5));
        std::vector<double> V = kept.particles().V_p;
        kept.advance(5);
        std::vector<double> now = kept.particles().V_p;
        std::sort(V.begin(), V.end()), std::sort(now.begin(), now.end());
        CHECK(now == V);
        CHECK(kept.least_V == 1);

        Case c = collision(0.3);
        c.shape = shape;
        ThetaScheme s = theta_scheme(0.6, "consistent", "newton_krylov");
        s.volumes = "updated";
        ThetaRun run(c, s, [](Assembly& all) { shake(0.05, 7, all); });
        double off = 0, most = 0, least = 1;
        for (int step = 0; step < 4; ++step) {
            run.begin(), run.solve();
            const std::vector<double> before = run.particles().V_p;
            std::vector<double> trace(before.size(), 0.0);
            for_each_weight(
                run, [&](std::size_t p, const NodeMotion& of, double, double Gx, double Gy) {
                    const double t = run.particles().turn_p[p];  // G_ip
                    trace[p] +=
                        run.dt / (1 + t * t) * ((Gx - t * Gy) * of.vx_1 + (Gy + t * Gx) * of.vy_1);
                });
            run.end();
            for (std::size_t p = 0; p < before.size(); ++p) {
                off = worst({off, std::fabs(run.particles().V_p[p] / before[p] - 1 - trace[p])});
                most = worst({most, std::fabs(trace[p])});
                least = std::min(least, 1 + trace[p]);
            }
        }
        CHECK(off <= 1e-15);
        CHECK(most >= 1e-3);
        CHECK(std::fabs(run.least_V - least) <= 1e-15);
    }
}

TEST_CASE("any number of threads takes the same bits through contact") {
    const int before = common::thread_count();
    for (const char* solver : solvers) {
        for (const char* shape : {"linear", "quadratic"}) {
            Case c = crowd(0.4);
            c.shape = shape;
            c.problem.walls = {"frictional", "slip", "frictional", "open"};
            c.problem.bonds.push_back({"glue", "a", "b"});
            std::vector<Particles> results;
            std::vector<Budget> budgets;
            for (const int threads : {1, 2, 3}) {
                common::set_thread_count(threads);
                ThetaRun run(c, theta_scheme(0.6, "consistent", solver), [](Assembly& all) {
                    disturb(0.004, 5, 2, all);
                    shake(0.1, 2, all);
                });
                run.advance(5);
                CHECK(run.sums.contact.nodes > 0);
                results.push_back(run.particles()), budgets.push_back(run.budget());
            }
            for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
                const auto one = results[0].all(), other = results[k].all();
                for (std::size_t q = 0; q < one.size(); ++q) CHECK(*one[q] == *other[q]);
                common::Row row, other_row;
                mpm_implicit::add_budget(budgets[0], row);
                mpm_implicit::add_budget(budgets[k], other_row);
                CHECK(row.values == other_row.values);
            }
        }
    }
    common::set_thread_count(before);
}
