// Fluid that turns about the axis, in flip and pic: the angular momentum that every particle keeps,
// the force and the energy of the rotation, balances, and waves.
#include <doctest/doctest.h>
#include <gsl/gsl_sf_bessel.h>

#include "flip/setup/balance_at_rest.hpp"
#include "flip/theory/rotating_column.hpp"
#include "tests/support/any_fluid.hpp"

namespace {

using namespace facts;

RegionCase turning(double Omega, double density, double p, double vx = 0, double vz = 0) {
    RegionCase r = fluid("", density, p, vx, vz);
    r.gas.angular_velocity = Omega;
    return r;
}

common::Formula formula(const std::string& text) {
    return common::Formula(text, "region.test", common::anything());
}

// The leak of a step, without the momentum that points outward; and that of the angular momentum,
// over sum m |L|.
struct SwirlLeak {
    Leak plane;
    double angular = 0;
    double most() const { return worst({plane.most(), angular}); }
};
SwirlLeak leak_of(const Totals& a, const Totals& b, const Budget& before, const Budget& after,
                  const Particles& p) {
    double all = 0;
    for (std::size_t k = 0; k < p.L_p.size(); ++k) all += p.m_p[k] * std::fabs(p.L_p[k]);
    return {leak_along(a, b, before, after),
            std::fabs(b.angular_momentum - a.angular_momentum -
                      (after.angular_momentum - before.angular_momentum)) /
                all};
}

// Two gases anywhere, with any velocities along r and z and about the axis.
Particles turning_cloud(const Case& w, std::uint64_t seed, double speed, long count,
                        const CloudBox& box = {}) {
    Random random(seed);
    Particles p;
    add_cloud(completed(w), count, box, 1, speed, random, p);
    p.swirl = true;
    for (const double r : p.x_p) p.L_p.push_back(r * speed * random(-2, 3));
    return p;
}

double fastest(const Particles& p) {
    double most = 0;
    for (std::size_t k = 0; k < p.vx_p.size(); ++k)
        most = worst({most, std::hypot(p.vx_p[k], p.vz_p[k])});
    return most;
}

}  // namespace

TEST_CASE("the mean force on a ring that moves is what its energy of rotation loses") {
    Random random(3);
    for (int n = 0; n < 1000; ++n) {
        const double L = random(-2, 2), r = random(0.01, 1), r_new = random(0.01, 1),
                     lost = swirl_energy(L, r) - swirl_energy(L, r_new),
                     size = swirl_energy(L, r) + swirl_energy(L, r_new);
        CHECK(std::fabs(centrifugal_force(L, r, r_new) * (r_new - r) - lost) <= 1e-14 * size);
        CHECK(std::fabs(centrifugal_force(L, r, r) * r * r * r / (L * L) - 1) <= 1e-14);
    }
    CHECK(centrifugal_force(0, 0, 0) == 0);
    CHECK(swirl_energy(0, 0) == 0);
}

TEST_CASE("every step of flip keeps the angular momentum of each ring and total energy" *
          doctest::description("physics")) {
    long combinations = 0;
    for (const bool hole : {false, true}) {
        for (const char* high : {"slip", "open"}) {
            for (const char* ends_z : {"slip", "periodic", "open", "inflow"}) {
                for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
                    for (const int method : {0, 1, 2, 3, 4}) {
                        const bool consistent = method == 4;
                        if (consistent && (hole || std::string(transfer) != "flip")) continue;
                        Case w = rings(7, 6, high, ends_z);
                        if (w.is(z_low, "inflow")) {
                            w.boundaries[z_high].kind = "open";
                            w.inflow = {"", 1, 1, 0, 0.8, 0.3, 0.5};
                        }
                        for (BoundaryCase& end : w.boundaries)
                            if (end.kind == "open") end.pressure = 0.6;
                        w.regions = {turning(1, 1, 1)};  // the case asks for a rotation
                        w.materials = {{"air", 1.4, 0}, {"water", 4, 0.5}};
                        w.transfer = transfer, w.xpic_order = 3, w.dt = 0.004;
                        if (method == 1) w.density = "particles";
                        if (method > 1 && !consistent) w.pressure = "implicit", w.tolerance = 1e-10;
                        if (method == 3) w.theta = 0.6;
                        if (consistent) w.mass = "consistent";
                        CAPTURE(hole);
                        CAPTURE(std::string(high));
                        CAPTURE(std::string(ends_z));
                        CAPTURE(std::string(transfer));
                        CAPTURE(method);
                        FlipRun r(w,
                                  turning_cloud(w, 5, 0.5, hole ? 200 : 700,
                                                hole ? CloudBox{0, 0.63, 0.3, 0.8} : CloudBox{}));
                        for (int n = 0; n < 3; ++n) {
                            const Totals a = r.totals();
                            const Budget before = r.state.budget;
                            r.step();
                            const SwirlLeak l =
                                leak_of(a, r.totals(), before, r.state.budget, r.particles());
                            CHECK(l.plane.mass <= 1e-14);
                            CHECK(l.plane.momentum <= 1e-13);
                            CHECK(l.plane.energy <= 1e-13);
                            CHECK(l.angular <= 1e-14);
                        }
                        ++combinations;
                    }
                }
            }
        }
    }
    CHECK(combinations == 2 * 8 * 5 * 4 + 8);
}

TEST_CASE("every step of pic keeps the angular momentum of each ring and total energy" *
          doctest::description("physics")) {
    for (const char* high : {"slip", "open"}) {
        for (const char* ends_z : {"slip", "periodic", "open", "inflow"}) {
            for (const char* shape : {"everywhere", "disk"}) {
                Case w = rings(9, 8, high, ends_z);
                if (w.is(z_low, "inflow")) {
                    w.boundaries[z_high].kind = "open";
                    w.inflow = {"air", 1, 1, 0, 0.8, 0.3, 0.5};
                }
                for (BoundaryCase& end : w.boundaries)
                    if (end.kind == "open") end.pressure = *shape == 'e' ? 0.6 : 0;
                w.materials = {{"air", 1.4, 0}, {"water", 4, 0.5}};
                w.regions = {turning(1, 1, 1, 0.3, -0.4), turning(-2, 3, 1, 0, 0.6)};
                w.regions[0].shape = shape, w.regions[0].radius = 0.6, w.regions[0].center_z = 0.5;
                w.regions[1].gas.material = "water", w.regions[1].shape = "disk";
                w.regions[1].radius = 0.3, w.regions[1].center_z = 0.4;
                w.loading = "random";
                CAPTURE(std::string(high));
                CAPTURE(std::string(ends_z));
                CAPTURE(std::string(shape));
                PicRun r(w);
                for (int n = 0; n < 10; ++n) {
                    const Totals a = r.totals();
                    const Budget before = r.state.budget;
                    r.step();
                    const SwirlLeak l =
                        leak_of(a, r.totals(), before, r.state.budget, r.state.particles);
                    CHECK(l.plane.mass <= 1e-14);
                    CHECK(l.plane.momentum <= 1e-13);
                    CHECK(l.plane.energy <= 1e-13);
                    CHECK(l.angular <= 1e-14);
                }
            }
        }
    }
}

TEST_CASE(
    "a violent run keeps the total angular momentum and energy and what each ring has of it") {
    // A spinning ball of cold gas bursts, flies outward and comes back from the walls.
    Case w = rings(16, 16);
    w.regions = {turning(0.5, 0.2, 0.01), turning(6, 3, 1e-4)};
    w.regions[1].shape = "disk", w.regions[1].radius = 0.4, w.regions[1].center_z = 0.5;
    const auto sorted = [](std::vector<double> L) {
        std::ranges::sort(L);
        return L;
    };
    for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
        w.transfer = transfer;
        FlipRun r(w);
        const Totals before = r.totals();
        const std::vector<double> L = sorted(r.particles().L_p);
        r.steps(150);
        CAPTURE(std::string(transfer));
        CHECK(leak_of(before, r.totals(), {}, r.state.budget, r.particles()).most() <= 1e-12);
        CHECK(sorted(r.particles().L_p) == L);
        CHECK(r.totals().internal > 2 * before.internal);
    }
    PicRun r(w);
    const Totals before = r.totals();
    const std::vector<double> L = sorted(r.state.particles.L_p);
    r.steps(150);
    CHECK(leak_of(before, r.totals(), {}, r.state.budget, r.state.particles).most() <= 1e-12);
    CHECK(sorted(r.state.particles.L_p) == L);
    CHECK(r.totals().internal > 2 * before.internal);
}

TEST_CASE("gas that turns in balance stays at rest with errors of its order") {
    // Second order in pic; of first order in flip, whose cells at a wall average over particles
    // that do not lie around their middle: there hydrostatic = true is for.
    // A liquid that keeps its density, p = p_0 + rho Omega^2 r^2/2; a gas of one temperature,
    // rho = exp(Omega^2 r^2/2 T); and a column whose middle turns faster.
    struct Balance {
        const char *density, *pressure, *swirl;
        double Omega;
    };
    for (const Balance& b : {Balance{"", "3 + .5*x*x", "", 1},
                             {"exp(.25*x*x)", "2*exp(.25*x*x)", "", 1},
                             {"", "3 - .5/(1 + x*x)", "x/(1 + x*x)", 0}}) {
        std::vector<double> of_flip, of_pic;
        for (const long n : {8L, 16L, 32L}) {
            Case w = rings(n, 4);
            w.grid.z.length = 4.0 / real(n);
            w.regions = {turning(b.Omega, 1, 1)};
            if (*b.density != 0) w.regions[0].gas.density = formula(b.density);
            if (*b.swirl != 0) w.regions[0].gas.velocity_theta = formula(b.swirl);
            w.regions[0].gas.pressure = formula(b.pressure);
            FlipRun f(w);
            PicRun p(w);
            double most = 0;
            while (f.state.time < 1) {
                f.step();
                most = worst({most, fastest(f.particles())});
            }
            of_flip.push_back(most);
            most = 0;
            while (p.state.time < 1) {
                p.step();
                most = worst({most, speed_of(p.state.cells.vx, p.state.cells.vz)});
            }
            of_pic.push_back(most);
        }
        CAPTURE(std::string(b.pressure));
        const auto order = [](const std::vector<double>& e) { return std::log2(e[0] / e[2]) / 2; };
        CHECK(worst({of_flip[0], of_pic[0]}) <= 0.005);
        CHECK(order(of_flip) >= 0.9);
        CHECK(order(of_pic) >= 1.5);
    }
}

TEST_CASE("a rigid rotation is shown as one in every cell and beside the axis") {
    Case w = rings(8, 4);
    w.regions = {turning(2, 1.5, 4)};
    FlipRun flip(w);
    flip.deposit();
    PicRun pic(w);
    find_pressure(pic.problem, pic.state, pic.cells);
    CellFields of_pic;
    fields_of(pic.w.grid, pic.state, pic.cells, of_pic);
    const CellFields of_flip = cell_fields(flip.grid(), flip.scratch.mesh);
    for_each_cell(flip.grid(), [&](long i, long, long n) {
        const double v = 2 * flip.grid().x.at(double(i) + 0.5);
        CHECK(std::fabs(of_flip.v_theta[n] / v - 1) <= 1e-13);
        CHECK(std::fabs(of_pic.v_theta[n] / v - 1) <= 1e-13);
    });
}

TEST_CASE(
    "hydrostatic pressure has the integral of the centrifugal force from the center of its "
    "region") {
    // v_theta = 0.7 x^2 + 1.3 x: the integral of v_theta^2/x.
    const auto of_powers = [](double x) { return x * x * (0.1225 * x * x + 1.82 / 3 * x + 0.845); };
    const auto of_vortex = [](double x) { return -0.5 / (1 + x * x); };
    for (const double center : {0.0, 0.4, 1.0}) {
        Case w = rings(4, 2);
        w.regions = {turning(1.3, 2, 5), turning(0, 2, 5)};
        w.regions[0].gas.velocity_theta = formula("0.7*x*x");
        w.regions[1].gas.velocity_theta = formula("x/(1 + x*x)");
        for (RegionCase& r : w.regions) r.hydrostatic = true, r.center_x = center;
        w = completed(w);
        const auto pressure_at = [&](const RegionCase& r, double x) {
            return flip::pressure(w.materials[0], 2, fluid_of(w, r, x, 0.3).e);
        };
        for (const double x : {0.05, 0.3, 0.95}) {
            CHECK(std::fabs(pressure_at(w.regions[0], x) - 5 -
                            2 * (of_powers(x) - of_powers(center))) <= 1e-13);
            CHECK(std::fabs(pressure_at(w.regions[1], x) - 5 -
                            2 * (of_vortex(x) - of_vortex(center))) <= 1e-12);
        }
    }
}

TEST_CASE("a column in hydrostatic balance turns at rest to round-off") {
    for (const char* density : {"cells", "particles"}) {
        for (const char* pressure : {"explicit", "implicit"}) {
            Case w = rings(12, 8);
            w.regions = {turning(1, 1, 3)};
            w.regions[0].hydrostatic = true, w.regions[0].center_z = 0.5;
            w.gravity_z = -0.2;
            w.density = density, w.pressure = pressure, w.tolerance = 1e-14;
            FlipRun r(w);
            balance_at_rest(r.problem, r.particles(), r.scratch.mesh);
            r.steps(60);
            CAPTURE(std::string(density));
            CAPTURE(std::string(pressure));
            CHECK(fastest(r.particles()) <= 1e-10);
        }
    }
}

TEST_CASE("turning dust that contracts bounces on straight lines and turns the faster") {
    // Rings of dust fly straight on: r^2 = (r_0 + v_0 t)^2 + (v_theta t)^2. From v_0 = -r_0 and
    // v_theta = 0.5 r_0 all contract alike, to 0.447 of their radius, and expand again.
    for (const bool pic : {false, true}) {
        std::vector<double> errors;
        for (const long n : {32L, 64L}) {
            Case w = rings(n, 1, "open");
            w.materials = {{"dust", 1, 0}};
            w.regions = {turning(0.5, 1, 0)};
            w.regions[0].gas.velocity_x = formula("-x");
            w.regions[0].shape = "box", w.regions[0].half_x = 0.8, w.regions[0].half_z = 1;
            w.dt = 0.64 / real(n);
            FlipRun f(w);
            PicRun p(w);
            State& state = pic ? p.state : f.state;
            const Particles start = state.particles;
            double most = 0, spin = 0;
            while (state.time < 1.2) {
                pic ? p.steps(1) : f.steps(1);
                const double t = state.time, s = std::hypot(1 - t, 0.5 * t);
                const Particles& now = state.particles;
                for (std::size_t k = 0; k < start.x_p.size(); ++k) {
                    if (start.x_p[k] < 0.2 || start.x_p[k] > 0.6) continue;
                    most = worst({most, std::fabs(now.x_p[k] / (start.x_p[k] * s) - 1)});
                    spin = worst(
                        {spin, std::fabs(now.L_p[k] / now.x_p[k] / (0.5 * start.x_p[k] / s) - 1)});
                }
            }
            errors.push_back(worst({most, spin}));
        }
        CAPTURE(pic);
        CAPTURE(errors[0]);
        CAPTURE(errors[1]);
        CHECK(errors[1] <= (pic ? 0.05 : 0.015));
        CHECK(errors[1] <= 0.6 * errors[0]);
    }
}

TEST_CASE("cold gas that turns and falls together is stopped by its rotation in either program") {
    // Noh's stream with a rotation: without it all gas would come to the axis.
    Case w = rings(40, 4, "open");
    w.grid.z.length = 0.1;
    w.regions = {turning(1, 1, 1e-8)};
    w.regions[0].flow = "radial", w.regions[0].speed = 1, w.regions[0].center_z = 0.05;
    for (const double cfl : {0.2, 0.7}) {
        w.cfl = cfl;
        CAPTURE(cfl);
        FlipRun f(w);
        const Totals of_flip = f.totals();
        while (f.state.time < 0.6) f.step();
        CHECK(leak_of(of_flip, f.totals(), {}, f.state.budget, f.particles()).most() <= 1e-12);
        PicRun p(w);
        const Totals of_pic = p.totals();
        while (p.state.time < 0.6) p.step();
        CHECK(leak_of(of_pic, p.totals(), {}, p.state.budget, p.state.particles).most() <= 1e-12);
        for (const Field& e : p.state.cells.e) CHECK(e.minCoeff() >= -1e-12);
    }
}

TEST_CASE("a case without a rotation has no column for it and one with it the same plane flow") {
    Case w = rings(20, 1);
    w.regions = {fluid("", 1, 1, 0.1)};
    FlipRun still(w);
    PicRun still_pic(w);
    CHECK(still.particles().L_p.empty());
    CHECK(still_pic.state.particles.L_p.empty());
    CHECK(still.nodes().centrifugal.size() == 0);
    CHECK(still.cells().swirl.empty());
    // A rotation so slow that its force is below round-off.
    w.regions[0].gas.angular_velocity = 1e-20;
    FlipRun slow(w);
    slow.steps(20), still.steps(20);
    CHECK(slow.particles().x_p == still.particles().x_p);
    CHECK(slow.particles().vx_p == still.particles().vx_p);
    CHECK(slow.particles().L_p.size() == slow.particles().x_p.size());
}

TEST_CASE("the number of threads does not change a bit of fluid that turns") {
    std::vector<Particles> of_flip, of_pic;
    Case w = rings(48, 48);
    w.regions = {turning(1, 1, 1), turning(-3, 2, 0.1)};
    w.regions[1].shape = "disk", w.regions[1].radius = 0.4, w.regions[1].center_z = 0.5;
    for (const int threads : {1, 2}) {
        common::set_thread_count(threads);
        FlipRun f(w);
        f.steps(10);
        of_flip.push_back(f.state.particles);
        PicRun p(w);
        p.steps(10);
        of_pic.push_back(p.state.particles);
    }
    common::set_thread_count(1);
    for (const auto* runs : {&of_flip, &of_pic}) {
        const Particles &a = (*runs)[0], &b = (*runs)[1];
        CHECK(a.x_p == b.x_p);
        CHECK(a.z_p == b.z_p);
        CHECK(a.e_p == b.e_p);
        CHECK(a.L_p == b.L_p);
    }
}

TEST_CASE("on conservative paths a ring has the divergence of its cell everywhere") {
    Case w = rings(6, 5);
    w.regions = {turning(1, 1, 1)};
    FlipRun r(w);
    const Grid& grid = r.grid();
    Random random(9);
    Field vx, vz;
    stir_nodes(grid, random, vx), stir_nodes(grid, random, vz);
    std::vector<Four> v(std::size_t(grid.size()), Four::Zero());
    for_each_node(grid, [&](long i, long, long n) {
        if (i == 0) vx[n] = 0;
        v[std::size_t(n)] = Four(0, 0, vx[n], vz[n]);
    });
    const WeightScale scale(grid);
    const auto velocity = [&](double x, double z) {
        const Weights at = weights_at(scale, x, z);
        Four sum = Four::Zero();
        for_nodes(scale, at, [&](long n, double S) { sum += S * v[std::size_t(n)]; });
        const Velocity missing = detail::missing_velocity_of_ring(grid, scale, at, v.data());
        return Velocity{sum[2] + missing.x, sum[3] + missing.z};
    };
    for_each_cell(grid, [&](long i, long j, long n) {
        const double cell = dilation(grid, vx, vz, n) / cell_volume(grid, i);
        for (int k = 0; k < 10; ++k) {
            const double x = grid.x.at(real(i) + random(0.05, 0.95)),
                         z = grid.z.at(real(j) + random(0.05, 0.95)), h = 1e-5;
            const double here =
                ((x + h) * velocity(x + h, z).x - (x - h) * velocity(x - h, z).x) / (2 * h * x) +
                (velocity(x, z + h).z - velocity(x, z - h).z) / (2 * h);
            CHECK(std::fabs(here - cell) <= 1e-6 * (1 + std::fabs(cell)));
        }
    });
}

TEST_CASE("particles of a column at rest boil within their cells but on conservative paths") {
    // As water under gravity does, exp(0.17 t sqrt(g/dz)), with Omega^2 R for g: 0.83 here.
    const auto growth = [](bool conservative) {
        Case w = rings(24, 12);
        w.grid.z.length = 0.5;
        w.regions = {turning(1, 1, 3)};
        w.regions[0].hydrostatic = true, w.regions[0].noise = 1e-7;
        w.per_cell_x = w.per_cell_z = 3;
        w.density = "particles", w.q_linear = w.q_quadratic = 0;
        FlipRun r(w);
        r.problem.scheme.conservative_paths = conservative;
        balance_at_rest(r.problem, r.particles(), r.scratch.mesh);
        const auto speed = [&](double end) {
            while (r.state.time < end) r.step();
            return fastest(r.particles());
        };
        const double early = speed(6), late = speed(12);
        return std::log(late / early) / 6;
    };
    const double bilinear = growth(false), conservative = growth(true);
    CAPTURE(bilinear);
    CAPTURE(conservative);
    CHECK(bilinear >= 0.5);
    CHECK(conservative <= 0.5 * bilinear);
}

TEST_CASE("the waves of a column are those of Kelvin where sound is fast") {
    theory::RotatingColumn s;
    s.sound_2 = [](double) { return 1e12; };
    for (const double R : {0.5, 2.0}) {
        for (const double k : {0.7, 3.0, 20.0}) {
            for (const double Omega : {0.3, -2.0}) {
                s.radius = R, s.k = k;
                s.v_theta = [Omega](double r) { return Omega * r; };
                const double j = gsl_sf_bessel_zero_J1(1) / R,
                             exact = 4 * Omega * Omega * k * k / (k * k + j * j);
                CHECK(std::fabs(theory::inertial_frequency_2(s) / exact - 1) <= 1e-5);
            }
        }
    }
    // Sound that is slow takes part, and slows them.
    s.radius = 1, s.k = pi, s.v_theta = [](double r) { return r; };
    double before = theory::inertial_frequency_2(s);
    for (const double c2 : {100.0, 10.0, 3.0}) {
        s.sound_2 = [c2](double r) { return c2 + 0.7 * r * r; };
        const double now = theory::inertial_frequency_2(s);
        CHECK(now < before);
        CHECK(now > 0.8 * before);
        before = now;
    }
}

// Solved for apart from the program, by shooting from the axis in 400 steps and counting nodes.
TEST_CASE("an inertial wave is told from sound that is slower or nearly as fast") {
    struct Wave {
        double Omega, length, pressure, omega;
    };
    for (const Wave& wave :
         {Wave{1, 1, 11.4, 1.26095}, Wave{1.7, 4, 11.4, 0.6632}, Wave{2, 4, 11.4, 0.7720},
          Wave{3, 4, 11.4, 1.1076}, Wave{1, 8, 11.4, 0.2017}, Wave{1, 1, 0.2, 1.0016},
          Wave{8, 1, 11.4, 7.8550}, Wave{40, 1, 11.4, 27.49}}) {
        CAPTURE(wave.omega);
        theory::RotatingColumn s;
        s.radius = 1, s.k = pi / wave.length;
        s.v_theta = [&](double r) { return wave.Omega * r; };
        s.sound_2 = [&](double r) {
            return 1.4 * (wave.pressure + 0.5 * wave.Omega * wave.Omega * r * r);
        };
        CHECK(std::sqrt(theory::inertial_frequency_2(s)) == about(wave.omega).epsilon(3e-4));
    }
}

TEST_CASE("a column grows where its angular momentum falls outward and nowhere else") {
    theory::RotatingColumn s;
    s.radius = 1, s.k = pi, s.sound_2 = [](double) { return 1e12; };
    const auto square = [&](const std::function<double(double)>& v) {
        s.v_theta = v;
        return theory::inertial_frequency_2(s);
    };
    CHECK(square([](double r) { return r; }) > 0);
    CHECK(square([](double r) { return r / (1 + r * r); }) > 0);  // L rises to 1/2
    CHECK(square([](double r) { return 2 * r * std::exp(-4 * r * r); }) < 0);
    CHECK(square([](double r) { return -2 * r * std::exp(-4 * r * r); }) < 0);
    CHECK(square([](double r) { return 0.3 / r; }) == 0);  // L is one number
    CHECK(square([](double) { return 0; }) == 0);
}
