// Two fluids of very different density beside each other in flip: rest, balance under gravity, what
// shares a cell, tension, and that nothing is thrown through a wall.
#include <doctest/doctest.h>

#include <numeric>

#include "flip/setup/balance_at_rest.hpp"
#include "tests/support/any_fluid.hpp"

namespace {

using namespace facts;

// Two fluids at the pressure 1: a dense one on the left, of the whole height or a disk; `ratio`
// times as dense as the gas.
Case two_at_rest(long rows, double ratio, bool liquid) {
    Case w = flip_case(12, rows, "slip", "slip");
    w.materials = {{"light", 1.4, 0},
                   liquid ? Material{"dense", 4.4, 6000} : Material{"dense", 1.4, 0}};
    const RegionCase light = fluid("light", 1, 1);
    RegionCase dense = fluid("dense", ratio, 1);
    dense.shape = rows > 1 ? "disk" : "box";
    dense.center_x = rows > 1 ? 0.5 : 0.25, dense.center_z = 0.5;
    dense.half_x = 0.25, dense.half_z = 1, dense.radius = 0.3;
    w.regions = {light, dense};
    w.per_cell_x = 3, w.per_cell_z = rows > 1 ? 3 : 1;
    return w;
}

double fastest_of(const Particles& p) {
    double fastest = 0;
    for (std::size_t k = 0; k < p.x_p.size(); ++k)
        fastest = worst({fastest, std::fabs(p.vx_p[k]), std::fabs(p.vz_p[k])});
    return fastest;
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

// A pond of water 1 deep under as much air, a thousand times lighter.
Case pond(const char* density, const char* pressure) {
    Case w = flip_case(3, 12, "slip", "slip");
    w.grid.z = {12, -1, 2, false};
    w.materials = {{"water", 4.4, 61000}, {"air", 1.4, 0}};
    w.gravity_z = -1, w.density = density, w.pressure = pressure, w.end = 1;
    RegionCase air = fluid("air", 0.001, 10.2), water = fluid("water", 1, 10.7);
    air.hydrostatic = water.hydrostatic = true;
    water.shape = "box", water.center_x = 0.5, water.half_x = 1;
    water.center_z = -0.5, water.half_z = 0.55;  // to the middle of a cell
    w.regions = {air, water};
    return w;
}

}  // namespace

TEST_CASE("a contact at rest stays at rest at any ratio of densities") {
    for (const double ratio : {10.0, 199.0, 1e3, 1e5})
        for (const bool liquid : {false, true})
            for (const long rows : {1L, 9L})
                for (const char* pressure : {"explicit", "implicit"})
                    for (const char* density : {"cells", "particles"})
                        for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
                            Case w = two_at_rest(rows, ratio, liquid);
                            w.pressure = pressure, w.density = density, w.transfer = transfer;
                            CAPTURE(ratio);
                            CAPTURE(liquid);
                            CAPTURE(rows);
                            CAPTURE(std::string(pressure));
                            CAPTURE(std::string(density));
                            CAPTURE(std::string(transfer));
                            FlipRun r(w);
                            r.steps(12);
                            const double p = liquid ? 6001 * 4.4 : 1.4;
                            const double sound = std::min(std::sqrt(1.4), std::sqrt(p / ratio));
                            CHECK(fastest_of(r.particles()) <= 1e-10 * sound);
                        }
}

// The largest speed until sound of the slower fluid has crossed the mesh `crossings` times, in
// units of that sound.
double fastest_at_rest(const Case& w, double crossings) {
    FlipRun r(w);
    const Material& dense = w.materials[1];
    const double sound =
        std::min(std::sqrt(1.4), std::sqrt(stiffness(dense, 1) / double(w.regions[1].gas.density)));
    double fastest = 0;
    while (r.state.time < crossings / sound) {
        r.step();
        fastest = worst({fastest, fastest_of(r.particles())});
    }
    return fastest / sound;
}

TEST_CASE("steps of many crossings of sound leave two fluids at rest") {
    for (const double ratio : {10.0, 1e3, 1e5})
        for (const bool liquid : {false, true})
            for (const long rows : {1L, 9L})
                for (const char* density : {"cells", "particles"})
                    for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
                        Case w = two_at_rest(rows, ratio, liquid);
                        w.pressure = "implicit", w.density = density, w.transfer = transfer;
                        w.end = 1e4;
                        CAPTURE(ratio);
                        CAPTURE(liquid);
                        CAPTURE(rows);
                        CAPTURE(std::string(density));
                        CAPTURE(std::string(transfer));
                        CHECK(fastest_at_rest(w, 10) <= 1e-10);
                    }
}

TEST_CASE("two fluids lie still while the slower sound crosses them ten times" *
          doctest::description("long")) {
    for (const double ratio : {10.0, 1e3, 1e5})
        for (const bool liquid : {false, true})
            for (const char* density : {"cells", "particles"})
                for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
                    Case w = two_at_rest(9, ratio, liquid);
                    w.density = density, w.transfer = transfer, w.end = 1e4;
                    CAPTURE(ratio);
                    CAPTURE(liquid);
                    CAPTURE(std::string(density));
                    CAPTURE(std::string(transfer));
                    CHECK(fastest_at_rest(w, 10) <= 1e-10);
                }
}

TEST_CASE("the viscosity of a cell that two fluids share does not throw the lighter one about") {
    FlipRun r(two_at_rest(1, 1e5, false));
    Random random(3);
    Particles& p = r.particles();
    for (std::size_t k = 0; k < p.x_p.size(); ++k)
        if (p.material[k] == 0) p.vx_p[k] = 1e-8 * random(-1, 1);
    r.steps(400);
    CHECK(fastest_of(p) <= 1e-8);
}

TEST_CASE("a pond under air balances gravity where the formula alone does not" *
          doctest::description("physics")) {
    for (const char* density : {"cells", "particles"}) {
        for (const char* pressure : {"explicit", "implicit"}) {
            CAPTURE(std::string(density));
            CAPTURE(std::string(pressure));
            const auto largest_kinetic = [&](bool balanced) {
                FlipRun r(pond(density, pressure));
                if (balanced) balance_at_rest(r.problem, r.particles(), r.scratch.mesh);
                double kinetic = 0;
                while (r.state.time < 0.2) {  // ten times as long as sound takes through all
                    r.step();
                    kinetic = worst({kinetic, r.totals().kinetic});
                }
                return kinetic / (r.totals().mass * 2);
            };
            const double balanced = largest_kinetic(true);
            CHECK(balanced <= 1e-20);
            CHECK(largest_kinetic(false) >= 100 * balanced);
        }
    }
}

TEST_CASE("a pond in balance is the same at all places of one height") {
    for (const char* density : {"cells", "particles"}) {
        FlipRun r(pond(density, "explicit"));
        const std::vector<double> before = r.particles().e_p;
        balance_at_rest(r.problem, r.particles(), r.scratch.mesh);
        const Particles& p = r.particles();
        double apart = 0, changed = 0;
        for (std::size_t k = 0; k < p.x_p.size(); ++k) {
            const auto first =
                std::size_t(std::find(p.z_p.begin(), p.z_p.end(), p.z_p[k]) - p.z_p.begin());
            apart = worst({apart, std::fabs(p.e_p[k] / p.e_p[first] - 1)});
            changed = worst({changed, std::fabs(p.e_p[k] / before[k] - 1)});
        }
        CHECK(apart <= 1e-12);
        CHECK(changed >= 1e-6);
    }
}

TEST_CASE("water under gravity does not begin to boil" * doctest::description("physics")) {
    // On bilinear paths particles fall together within a cell, where no pressure feels it. For
    // an hourglass a(z) of the nodes the mass of a node changes by a'/3, and a'' = -(g/27) a' of
    // time grows at up to sqrt(g/(54 dz)), 0.43 here. On conservative paths only sums over few
    // particles are left of it, with n across a cell 1/n^2 of the force.
    const auto kinetic = [](bool conservative, double t) {
        Case w = flip_case(6, 10, "slip", "slip");
        w.grid.z = {10, -1, 1, false}, w.grid.x = {6, 0, 0.6, false};
        w.materials = {{"water", 4.4, 5}};
        w.gravity_z = -1, w.density = "particles", w.pressure = "implicit", w.end = 100;
        w.per_cell_x = w.per_cell_z = 4, w.q_linear = w.q_quadratic = 0;
        w.regions = {fluid("water", 1, 1)};
        w.regions[0].hydrostatic = true;
        FlipRun r(w);
        r.problem.scheme.conservative_paths = conservative;
        balance_at_rest(r.problem, r.particles(), r.scratch.mesh);
        Random random(5);
        for (std::size_t k = 0; k < r.particles().x_p.size(); ++k)
            r.particles().vz_p[k] = 1e-12 * random(-1, 1);
        while (r.state.time < t) r.step();
        return r.totals().kinetic / r.totals().mass;
    };
    const auto rate = [&](bool conservative) {
        return std::log(kinetic(conservative, 30) / kinetic(conservative, 20)) / 20;
    };
    CHECK(rate(false) >= 0.43);
    CHECK(rate(true) <= 0.4 * rate(false));
    CHECK(kinetic(true, 60) <= 1e-17);  // on bilinear paths 1e-3 of m g h
}

TEST_CASE("materials that share a cell come to one pressure volume for volume") {
    // At rest between walls that nothing leaves; a step so short that nothing moves.
    Case w = flip_case(3, 3, "slip", "slip");
    w.materials = {{"air", 1.4, 0}, {"water", 4.4, 6000}};
    w.density = "particles", w.dt = 1e-14, w.q_linear = w.q_quadratic = 0;
    Particles p;
    const long n = 12;
    for (long j = 0; j < n; ++j) {
        for (long i = 0; i < n; ++i) {
            const int material = (i + j) % 2 == 0 ? 1 : 0;
            const Material a = w.materials[std::size_t(material)];
            const double rho = material == 1 ? 1000 : 1, V = 1 / real(n * n);
            p.x_p.push_back((real(i) + 0.5) / real(n)), p.z_p.push_back((real(j) + 0.5) / real(n));
            p.m_p.push_back(rho * V), p.V_p.push_back(V), p.material.push_back(material);
            p.vx_p.push_back(0), p.vz_p.push_back(0);
            p.e_p.push_back(internal_energy(a, rho, material == 1 ? 500 : 1));
        }
    }
    FlipRun r(w, p);
    const double energy = r.totals().internal, volume = sum_of(r.particles().V_p);
    const auto apart = [&] {
        double most = 0;
        r.deposit();
        for_each_cell(r.grid(), [&](long, long, long c) {
            most = worst({most, std::fabs(r.cells().excess[2 * std::size_t(c)] -
                                          r.cells().excess[2 * std::size_t(c) + 1])});
        });
        return most;
    };
    const double before = apart();
    CHECK(before > 100);
    const Particles start = r.particles();
    const double p_c = r.cells().p[r.grid().index(1, 1)];
    r.steps(1);
    for (std::size_t k = 0; k < start.x_p.size(); ++k)  // each pays p_c for its volume
        if (start.material[k] == 1)
            CHECK(std::fabs(start.m_p[k] * (start.e_p[k] - r.particles().e_p[k]) /
                                (p_c * (r.particles().V_p[k] - start.V_p[k])) -
                            1) <= 0.02);
    CHECK(std::fabs(sum_of(r.particles().V_p) - volume) <= 1e-14);
    CHECK(std::fabs(r.totals().internal / energy - 1) <= 1e-14);
    r.steps(30);
    r.deposit();
    for_each_cell(r.grid(), [&](long, long, long c) {  // water is within one p_c of the cell
        CHECK(std::fabs(r.cells().excess[2 * std::size_t(c) + 1]) <= 1e-2 * r.cells().p[c]);
    });
    CHECK(apart() <= 0.05 * before);
    CHECK(std::fabs(r.totals().internal / energy - 1) <= 1e-13);
}

TEST_CASE("a liquid holds its tension and no more and a gas none") {
    const Material water{"water", 4.4, 6000, 2000}, air{"air", 1.4, 0};
    // Stretched at constant energy: p from the equation of state until it breaks.
    const double e = internal_energy(water, 1, 0);
    for (const double rho : {1.0, 0.98, 0.95, 0.93, 0.5}) {
        CAPTURE(rho);
        const double exact = 3.4 * rho * e - 4.4 * 6000;
        CHECK(std::fabs(pressure(water, rho, e) - std::max(exact, -2000.0)) <= 1e-9);
    }
    CHECK(pressure(water, 0.93, e) < 0);
    CHECK(pressure(air, 1e-9, 1e-9) > 0);
}

TEST_CASE("a start that is far from balance stays as the case says") {
    // Air at 10.5 over water at 10.2: the balance would take the jump away.
    Case w = pond("particles", "explicit");
    w.regions[0].gas.pressure = 10.5;
    FlipRun r(w);
    const std::vector<double> before = r.particles().e_p;
    balance_at_rest(r.problem, r.particles(), r.scratch.mesh);
    CHECK(r.particles().e_p == before);
}

TEST_CASE("no node takes a particle farther than a cell and none passes a wall") {
    // Water at a high pressure beside air: the implicit step would know nothing of it before.
    Case w = two_at_rest(1, 1000, true);
    w.regions[1].gas.pressure = 1e6;
    w.pressure = "implicit", w.density = "particles";
    FlipRun r(w);
    r.state.dt = 1;  // as though a step had gone before
    r.deposit();
    const double asked = step_allowed(r.problem, r.scratch.mesh, r.state.dt);
    const double taken = r.move_nodes();
    CHECK(taken < asked);
    double farthest = 0;
    for_own_nodes(r.grid(), [&](long, long, long n) {
        farthest = std::max(farthest, std::fabs(r.nodes().vxL[n]) * taken / r.grid().x.spacing());
    });
    CHECK(farthest <= 1);
    CHECK(farthest > 0.25);
}
