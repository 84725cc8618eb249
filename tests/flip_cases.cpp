// What a case file of pic and flip can say: formulas of the place, an inflow for every end, and
// shock tubes that every transfer has to bring to the end.
#include <doctest/doctest.h>

#include <array>
#include <clocale>
#include <complex>
#include <locale>

#include "flip/output/pic_diagnostics.hpp"
#include "flip/pic/step.hpp"
#include "flip/setup/check_case.hpp"
#include "flip/theory/riemann.hpp"
#include "tests/support/any_fluid.hpp"
#include "tests/support/any_run.hpp"

namespace {

using namespace facts;

// What a case file makes of a case, and what the run writes of it.
struct Reading {
    Case given, completed;
    std::string effective;
};
Reading read(const std::string& text) {
    Reading r;
    common::ParameterTable table = describe(r.given);
    for (const common::Setting& s : common::read_case(text, "case.toml")) table.set(s);
    reject_unused(r.given);
    r.completed = completed(r.given);
    r.effective = table.effective_case();
    return r;
}

std::string refusal(const std::string& text) {
    try {
        const Case w = read(text).completed;
        validate(w, "flip");
        load_particles(w);
    } catch (const common::InputError& error) {
        return error.what();
    }
    return "nothing";
}

const std::string box =
    "[grid]\ncells_x = 8\ncells_z = 8\nlength_x = 1\nlength_z = 1\n[region.gas]\n";

}  // namespace

TEST_CASE("a formula gives particles what the flow of that name gives them") {
    const Case flow = read(box +
                           "center_x = 0.3\ncenter_z = 0.6\nflow = \"rotation\"\nspeed = 2\n"
                           "width = 0.5\n")
                          .completed,
               formula = read(box +
                              "velocity_x = \"-2*(z - h)/.5\"\nvelocity_z = \"2*(x - .3)/.5\"\n"
                              "[constant.h]\nvalue = 0.6\n")
                             .completed;
    const Particles a = load_particles(flow), b = load_particles(formula);
    REQUIRE(a.count() == b.count());
    double most = 0, fastest = 0;
    for (std::size_t k = 0; k < a.x_p.size(); ++k) {
        most = worst({most, std::fabs(a.vx_p[k] - b.vx_p[k]), std::fabs(a.vz_p[k] - b.vz_p[k])});
        fastest = worst({fastest, a.vx_p[k], a.vz_p[k]});
    }
    CHECK(fastest > 2);
    CHECK(most <= 4 * eps * fastest);
}

TEST_CASE("an apic particle starts with the gradient of the velocity at its place") {
    const Particles p = load_particles(read("[flip]\ntransfer = \"apic\"\n" + box +
                                            "velocity_x = \"0.3*x - 2*z\"\n"
                                            "velocity_z = \"5*x + 0.7*z\"\n")
                                           .completed);
    double off = 0;
    for (std::size_t k = 0; k < p.x_p.size(); ++k)
        off = worst({off, std::fabs(p.Cxx_p[k] - 0.3), std::fabs(p.Cxz_p[k] + 2),
                     std::fabs(p.Czx_p[k] - 5), std::fabs(p.Czz_p[k] - 0.7)});
    CHECK(off <= 1e-9);
}

TEST_CASE("r in a formula is the distance from the center of the region") {
    const Case w = read(box + "center_x = 0.25\ncenter_z = -2\ndensity = \"1 + r^2\"\n").completed;
    const Particles p = load_particles(w);
    const double V = w.grid.cell_area() / real(w.per_cell_x * w.per_cell_z);
    double most = 0;
    for (std::size_t k = 0; k < p.x_p.size(); ++k) {
        const double dx = p.x_p[k] - 0.25, dz = p.z_p[k] + 2, rho = 1 + dx * dx + dz * dz;
        most = worst({most, std::fabs(p.m_p[k] / (V * rho) - 1)});
    }
    CHECK(most <= 8 * eps);
}

TEST_CASE("hydrostatic pressure is the integral of the weight where density is a formula") {
    // 5 - (1 - exp(-2 z))/2 in the plane; 5 + 4 (x^2/2 + x^3/3) about an axis.
    const std::string still = box + "hydrostatic = true\npressure = 5\n";
    const Case falls = read(still + "density = \"exp(-2*z)\"\n[gravity]\nz = -1\n").completed;
    Case turns = read(still + "density = \"1 + x\"\nangular_velocity = 2\n").given;
    turns.geometry = "axisymmetric", turns = completed(turns);
    for (const double s : {0.05, 0.3, 0.95}) {
        const auto pressure_at = [&](const Case& w, double x, double z) {
            const FluidState f = fluid_of(w, w.regions[0], x, z);
            return flip::pressure(w.materials[0], f.density, f.e);
        };
        CHECK(std::fabs(pressure_at(falls, 0.3, s) - 4.5 - 0.5 * std::exp(-2 * s)) <= 1e-13);
        CHECK(std::fabs(pressure_at(turns, s, 0.3) - 5 - s * s * (2 + 4 * s / 3)) <= 1e-13);
    }
}

// A void at an end holds the pressure outside, so that a drop of that pressure stays at rest.
TEST_CASE("a drop of gas stays at rest under the pressure outside of open ends") {
    for (const bool axis : {false, true}) {
        Case w = axis ? rings(16, 16, "open", "open") : flip_case(16, 16, "open", "open");
        for (BoundaryCase& end : w.boundaries) end.pressure = end.kind == "open" ? 2 : 0;
        w.regions = {fluid("", 1, 2)};
        w.regions[0].shape = "disk", w.regions[0].radius = 0.3;
        w.regions[0].center_x = axis ? 0 : 0.5, w.regions[0].center_z = 0.5;
        w.density = "particles";
        FlipRun r(w);
        r.steps(40);
        double fastest = 0;
        for (const double v : r.particles().vx_p) fastest = worst({fastest, v});
        for (const double v : r.particles().vz_p) fastest = worst({fastest, v});
        CHECK(fastest <= 1e-13);
        w.boundaries[z_high].kind = "open", w.boundaries[z_high].pressure = 0;
        CHECK_THROWS_WITH_AS(FlipRun(w).step(), doctest::Contains("a void reaches to open ends"),
                             common::NumericalError);
    }
}

// Shock relations, gamma 5/3: a pressure of 3 drives gas of pressure 1 at 0.9608 and the shock at 2.081.
TEST_CASE("a pressure outside of an open end pushes gas that it has driven from there" *
          doctest::description("physics")) {
    Case w = flip_case(100, 1, "slip", "periodic");
    w.materials = {{"gas", 5. / 3, 0}};
    w.boundaries[x_high].kind = "open", w.boundaries[x_high].pressure = 3;
    w.regions = {fluid("", 1, 1)};
    w.per_cell_x = 16, w.end = 0.2;
    for (const char* density : {"cells", "particles"}) {
        for (const char* pressure : {"explicit", "implicit"}) {
            w.density = density, w.pressure = pressure;
            CAPTURE(std::string(density));
            CAPTURE(std::string(pressure));
            FlipRun r(w);
            const Totals before = r.totals();
            while (r.state.time < w.end) r.step();
            const double t = r.state.time, last = std::ranges::max(r.particles().x_p);
            CHECK(std::fabs(r.totals().momentum_x / (-2 * t * w.grid.z.length) - 1) <= 0.02);
            CHECK(std::fabs(last - (1 - 0.9608 * t)) <= 0.02);
            CHECK(leak(before, r.totals(), {}, r.state.budget).most() <= 1e-12);
        }
    }
    PicRun r(w);
    CHECK_THROWS_WITH_AS(r.to_the_end(), doctest::Contains("does not reach it across a void"),
                         common::NumericalError);
}

TEST_CASE("a wave that drowns in the noise of an odd lattice is not measured") {
    const std::string wave =
        "flip/cases/acoustic.toml flip.density=cells flip.pressure=explicit flip.theta=1 "
        "flip.tolerance=1e-8 time.dt=0 time.end=5 grid.cells_x=64 grid.length_z=0.015625 "
        "viscosity.linear=0 viscosity.quadratic=0 particles.per_cell_x=";
    for (const int n : {1, 2, 3, 4}) {
        const std::string out = folder("lattice");
        run("flip", wave + std::to_string(n), out);
        CAPTURE(n);
        CHECK(holds(read_all(out + "/summary.json"), "what is not the wave has the amplitude") ==
              (n % 2 == 1));
    }
}

TEST_CASE("a case that is written and read again keeps its texts and its numbers") {
    const std::string text = box +
                             "density = .5\npressure = \"1 + .1*sin(2*pi*k*x)\"\n"
                             "velocity_x = -2.5e-1\n[constant.k]\nvalue = 3\n";
    CHECK_THROWS_AS(read(text), common::InputError);  // TOML knows no .5
    const Reading once = read(box +
                              "density = 0.5\npressure = \"1 + .1*sin(2*pi*k*x)\"\n"
                              "velocity_x = -2.5e-1\n[constant.k]\nvalue = 3\n"),
                  twice = read(once.effective);
    CHECK(once.effective == twice.effective);
    CHECK(holds(once.effective,
                "\ndensity = 0.5\npressure = \"1 + .1*sin(2*pi*k*x)\"\n"
                "velocity_x = -0.25\nvelocity_z = 0\n"));
    const Particles a = load_particles(once.completed), b = load_particles(twice.completed);
    CHECK(a.e_p == b.e_p);
    CHECK(a.m_p == load_particles(read(box + "density = \"0.5\"\n").completed).m_p);
}

TEST_CASE("what is no formula is refused with its place and the cure") {
    const std::vector<std::array<std::string, 2>> wrong{
        {"density = \"1 + foo\"",
         "case.toml:7:11: 'region.gas.density' = \"1 + foo\": Unexpected token "
         "\"foo\" found at position 4"},
        {"density = \"(1 + x\"", "Missing parenthesis"},
        {"density = \"1 +\"", "Unexpected end of expression"},
        {"density = \"x ? 1\"", "missing an else clause"},
        {"density = \"x = 3\"", "to compare, write '=='"},
        {"density = \"1,5\"", "write one value, without ','"},
        {"density = \"\"", "'region.gas.density' is empty; write a number or a formula"},
        {"density = true", "'region.gas.density' takes a number or a formula, not true or false"},
        {"density = \"x - 0.5\"",
         "\"x - 0.5\" is -0.4844 at x = 0.01562, z = 0.01562; allowed: "
         "finite, >= 0"},
        {"density = \"z < .6 ? 1 : 0\"",
         "the density 0 at x = 0.01562, z = 0.6094: keep it above 0; a vacuum is a region of its "
         "own"},
        {"pressure = \"1/(x - .015625)\"", "is inf at x = 0.01562, z = 0.01562; allowed: finite"},
        {"velocity_x = \"sqrt(x - .5)\"", "at x = 0.01562, z = 0.01562; allowed: finite, any"},
        {"radius = \"x\"", "'region.gas.radius' takes a number, not text"},
        {"density = \"x\"\n[constant.x]\nvalue = 1",
         "'constant.x': the name means something already"},
        {"density = \"x\"\n[constant.sin]\nvalue = 1", "'constant.sin': the name means something"},
        {"density = 1\n[constant.k]\nvalue = 1", "[constant.*] needs a formula in a region"},
        {"flow = \"wave\"\namplitude = 0.1\ndensity = \"1 + x\"\n[theory]\ncompare = \"wave\"",
         "theory.compare = \"wave\" needs numbers, and region.gas has a formula"},
    };
    for (const auto& [text, message] : wrong) {
        CAPTURE(text);
        const std::string said = refusal(box + text + "\n");
        CAPTURE(said);
        CHECK(holds(said, message));
    }
    CHECK(refusal(box + "density = \"x == .5 || z >= .2 && x != 0 ? 1 : 2\"\n") == "nothing");
    CHECK(refusal(box + "velocity_x = \"min(x, z) - 1\"\n") == "nothing");
}

TEST_CASE("a cavity that theory does not know is refused" * doctest::description("robust")) {
    const std::string shipped = read_all("flip/cases/collapsing_cavity.toml");
    CHECK(refusal(shipped) == "nothing");
    const std::vector<std::array<std::string, 3>> wrong{
        {"density = 0.001", "density = 0.1",
         "knows no inertia of the gas: region.gas.density = 0.1"},
        {"density = 1\n", "density = 1\nvelocity_z = 1\n",
         "begins at rest, and region.liquid moves"},
        {"density = 1\n", "density = 0\n", "in that a disk of density 0, in this order"},
        {"radius = 3", "radius = 4.5", "needs the cavity in the liquid and the liquid on the mesh"},
        {"density = 0\n", "density = 0\ncenter_z = 1\n", "on the axis and the lower wall"}};
    for (const auto& [from, to, message] : wrong) {
        std::string text = shipped;
        const std::size_t at = text.find(from);
        REQUIRE(at != std::string::npos);
        CAPTURE(to);
        CHECK(holds(refusal(text.replace(at, from.size(), to)), message));
    }
}

TEST_CASE("formulas have a decimal point where the user writes a comma") {
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
    std::setlocale(LC_ALL, "de_DE.UTF-8");  // where there is one
    common::Formula f("1.25 + 2.5e-1*x", "here", common::anything());
    f.read({});
    CHECK(f.at(3, 0, 0) == 2);
    std::locale::global(before);
    std::setlocale(LC_ALL, "C");
}

TEST_CASE("a bare decimal point is read on the command line in place of a formula too") {
    const std::string out = folder("point");
    CHECK(run("flip",
              "flip/cases/gresho.toml region.gas.velocity_x=-.5 region.gas.density=+.5 "
              "theory.compare=none time.end=0 ",
              out) == 0);
    CHECK(holds(read_all(out + "/case.toml"), "density = 0.5\n"));
    CHECK(holds(read_all(out + "/case.toml"), "velocity_x = -0.5\n"));
    const std::string formula = folder("formula");
    CHECK(run("flip",
              "flip/cases/gresho.toml 'region.gas.velocity_x=-.5*sin(2*pi*x)' "
              "theory.compare=none time.end=0 ",
              formula) == 0);
    CHECK(holds(read_all(formula + "/case.toml"), "velocity_x = \"-.5*sin(2*pi*x)\"\n"));
}

// Theory: a linear wave turns by c k t, and a mesh of second order is late by less than (k dx)^2.
TEST_CASE("a sound wave across the mesh given by formulas moves with the speed of sound" *
          doctest::description("physics")) {
    FlipRun run(read("[grid]\ncells_x = 32\ncells_z = 32\nlength_x = 1\nlength_z = 1\n"
                     "[viscosity]\nlinear = 0\nquadratic = 0\n[region.gas]\n"
                     "density = \"1 + a*cos(2*pi*(x + z))\"\n"
                     "pressure = \"1 + 1.4*a*cos(2*pi*(x + z))\"\n"
                     "velocity_x = \"sqrt(.7)*a*cos(2*pi*(x + z))\"\n"
                     "velocity_z = \"sqrt(.7)*a*cos(2*pi*(x + z))\"\n[constant.a]\n"
                     "value = 0.01\n")
                    .given);
    const auto wave = [&] {
        std::complex<double> sum = 0;
        const Particles& p = run.particles();
        for (std::size_t k = 0; k < p.x_p.size(); ++k)
            sum += p.m_p[k] * (p.vx_p[k] + p.vz_p[k]) *
                   std::polar(1.0, -2 * pi * (p.x_p[k] + p.z_p[k]));
        return sum;
    };
    const std::complex<double> start = wave();
    const double k = 2 * pi * std::sqrt(2.0), ck = std::sqrt(1.4) * k;
    while (ck * run.state.time < 0.5 * pi) run.step();
    const std::complex<double> turned = wave() / start;
    CHECK(std::fabs(-std::arg(turned) / (ck * run.state.time) - 1) <= (k / 32) * (k / 32));
    CHECK(std::fabs(std::abs(turned) - 1) <= 0.03);
}

// Theory: kinetic energy falls as exp(-4 nu k^2 t), nu = 0.01. The transfer pic alone has 25 times
// that.
TEST_CASE("eddies of a case file lose the energy that their viscosity takes" *
          doctest::description("physics")) {
    const Case w = read(read_all("flip/cases/taylor_green.toml")).given;
    for (const char* transfer : {"flip", "pic"}) {
        Case v = w;
        v.transfer = transfer;
        FlipRun r(v);
        const double start = r.totals().kinetic;
        while (r.state.time < 0.2) r.step();
        const double rate = std::log(start / r.totals().kinetic) / r.state.time,
                     expected = 4 * 0.01 * (2 * pi) * (2 * pi);
        CAPTURE(transfer);
        CHECK(std::fabs(start - 0.25) <= 1e-3);
        CHECK((std::fabs(rate / expected - 1) <= 0.05) == (v.transfer == "flip"));
    }
}

TEST_CASE("a shock tube across the mesh is that along the mesh between its waves" *
          doctest::description("physics")) {
    Case w = read(
                 "[grid]\ncells_x = 96\ncells_z = 96\nlength_x = 1\nlength_z = 1\n[boundary]\n"
                 "x_low = \"slip\"\nx_high = \"slip\"\nz_low = \"slip\"\nz_high = \"slip\"\n"
                 "[region.gas]\ndensity = \"x + z < 1 ? 1 : .125\"\n"
                 "pressure = \"x + z < 1 ? 1 : .1\"\n")
                 .given;
    FlipRun r(w);
    while (r.state.time < 0.2) r.step();
    r.deposit();
    const theory::RiemannSolution exact =
        theory::solve_riemann({1, 0, 1, 1.4, 0}, {0.125, 0, 0.1, 1.4, 0});
    const double t = r.state.time, dx = 1.0 / 96, star = exact.left_of_contact.pressure;
    double p = 0, cells = 0;
    visit_cells(r.grid(), [&](long n, double x, double z) {
        const double s = (x + z - 1) / std::sqrt(2.0);
        // Between the waves, and where no wall is heard yet.
        const bool between = s > exact.left_tail * t + 3 * dx && s < exact.right_tail * t - 3 * dx;
        if (between && std::fabs(x - z) < 0.3) p += r.cells().p[n], cells += 1;
    });
    REQUIRE(cells > 100);
    CHECK(std::fabs(p / cells / star - 1) <= 0.02);
    const Totals sums = r.totals();
    CHECK(sums.momentum_x > 0.01);
    CHECK(std::fabs(sums.momentum_x - sums.momentum_z) <= 1e-12);
}

TEST_CASE("an end takes from its own inflow what that says and the rest from the common one") {
    const std::string ends = "[boundary]\nx_low = \"inflow\"\nx_high = \"inflow\"\n";
    const std::string own = "[inflow.x_low]\ndensity = 1\nvelocity_x = 4\n",
                      common = "[inflow]\ndensity = 2\npressure = 3\nvelocity_x = -5\n";
    for (const std::string& text : {own + common, common + own}) {
        const Reading r = read(ends + text + "[region.gas]\n");
        const GasCase low{"", 1, 3, 4, 0}, high{"", 2, 3, -5, 0};
        CHECK(r.completed.boundaries[x_low].inflow == low);
        CHECK(r.completed.boundaries[x_high].inflow == high);
        const Reading again = read(r.effective);
        CHECK(again.effective == r.effective);
        CHECK(again.completed.boundaries[x_low].inflow == low);
        CHECK(holds(r.effective, "[inflow.x_low]\nmaterial = \"\"\ndensity = 1\nvelocity_x = 4\n"));
        CHECK(!holds(r.effective, "[inflow.x_high]"));
    }
    const std::string row_of = "[grid]\ncells_z = 1\n[region.gas]\n";
    CHECK(holds(refusal(row_of + ends + common),
                "boundary.x_low = \"inflow\" needs inflow.velocity_x above 0"));
    CHECK(holds(refusal(row_of + ends + common + own + "[inflow.left]\n"),
                "[inflow.left] names no end"));
    CHECK(holds(refusal(row_of + ends + common + own + "[inflow.z_low]\n"),
                "[inflow.z_low] needs boundary.z_low = \"inflow\""));
    CHECK(holds(refusal(row_of + ends + common + own + "[inflow.x_high]\nmaterial = \"gold\"\n"),
                "inflow.material = \"gold\" is none of 'gas'"));
    CHECK(refusal(row_of + ends + common + own) == "nothing");
    // The ends of a tube with two gases bring their own.
    Case tube;
    tube.setup = "riemann";
    CHECK(completed(tube).boundaries[x_low].inflow.material == "left");
    CHECK(completed(tube).boundaries[x_high].inflow.material == "right");
}

namespace {

// Four gases, one from each side, into a mesh without any.
Case four_streams() {
    Case w = flip_case(8, 6, "inflow", "inflow");
    w.materials = {{"a", 1.4, 0}, {"b", 5. / 3, 0}, {"c", 1.2, 0}, {"d", 3, 0}};
    w.inflow.density = 1.5;
    w.inflows = {{"x_low", "a", {}, {}, 1.0, 0.1},
                 {"z_high", "d", 3, 2, {}, -0.8},
                 {"x_high", "b", 0.5, 0.7, -1.2, {}},
                 {"z_low", "c", 0.9, {}, 0.2, 0.7}};
    w.per_cell_x = 3, w.per_cell_z = 2;
    return w;
}

// Mass that has come through each side, to half of a column.
void check_masses(const Case& w, const Particles& p, double t) {
    const Grid& grid = w.grid;
    for (const Side side : all_sides) {
        const GasCase& in = w.boundaries[side].inflow;
        const bool along_x = is_x_side(side);
        const double speed = std::fabs(along_x ? in.velocity_x : in.velocity_z),
                     width = along_x ? grid.z.length : grid.x.length,
                     step = along_x ? grid.x.spacing() / 3 : grid.z.spacing() / 2;
        const int kind = material_index(w, in.material);
        double mass = 0;
        for (std::size_t k = 0; k < p.x_p.size(); ++k) mass += p.material[k] == kind ? p.m_p[k] : 0;
        CAPTURE(side);
        CHECK(std::fabs(mass - in.density * speed * width * t) <=
              0.5 * in.density * step * width * (1 + 1e-9));
    }
}

}  // namespace

TEST_CASE("four ends let in four gases and all of them are in the budget") {
    for (const char* transfer : {"flip", "pic", "apic"}) {
        for (const char* density : {"cells", "particles"}) {
            Case w = four_streams();
            w.transfer = transfer, w.density = density, w.dt = 0.002;
            FlipRun r(w, Particles{});
            r.steps(90);
            CAPTURE(transfer);
            CAPTURE(density);
            check_masses(r.w, r.particles(), r.state.time);
            const Totals t = r.totals();
            const Budget& in = r.state.budget;
            CHECK(t.mass > 0.4);
            CHECK(std::fabs(t.mass - in.mass) <= 1e-13);
            CHECK(std::fabs(t.momentum_x - in.momentum_x) <= 1e-12);
            CHECK(std::fabs(t.momentum_z - in.momentum_z) <= 1e-12);
            CHECK(std::fabs(t.kinetic + t.internal - in.energy) <= 1e-12);
        }
    }
    // The same in pic.
    const Case w = [] {
        Case c = four_streams();
        c.dt = 0.004;
        return completed(c);
    }();
    const Problem problem = problem_of(w);
    PicCells cells(problem);
    State state = initial_state(problem, Particles{}, cells);
    for (int n = 0; n < 45; ++n) {
        find_pressure(problem, state, cells);
        take_pic_step(problem, state, cells);
    }
    check_masses(w, state.particles, state.time);
    const Totals t = totals_of(problem.grid, state, cells);
    CHECK(t.mass > 0.4);
    CHECK(std::fabs(t.mass - state.budget.mass) <= 1e-13);
    CHECK(std::fabs(t.momentum_x - state.budget.momentum_x) <= 1e-12);
    CHECK(std::fabs(t.momentum_z - state.budget.momentum_z) <= 1e-12);
    CHECK(std::fabs(t.kinetic + t.internal - state.budget.energy) <= 1e-12);
}

namespace {

// The shock tubes of Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, chapter 4,
// with ends that fit their streams.
struct Tube {
    SideCase left, right;
    double interface, end;
    const char *low, *high;
};
const std::array<Tube, 5> toro{{
    {{1, 1, 0.75}, {0.125, 0.1, 0}, 0.3, 0.2, "inflow", "slip"},
    {{1, 0.4, -2}, {1, 0.4, 2}, 0.5, 0.15, "open", "open"},
    {{1, 1000, 0}, {1, 0.01, 0}, 0.5, 0.012, "slip", "slip"},
    {{5.99924, 460.894, 19.5975}, {5.99242, 46.0950, -6.19633}, 0.4, 0.035, "inflow", "inflow"},
    {{1, 1000, -19.59745}, {1, 0.01, -19.59745}, 0.8, 0.012, "open", "inflow"},
}};

Case tube_of(const Tube& t, long cells = 100) {
    Case w = flip_case(cells, 1, "slip", "periodic");
    w.per_cell_x = 16;
    w.setup = "riemann", w.left = t.left, w.right = t.right, w.interface = t.interface;
    w.boundaries[x_low].kind = t.low, w.boundaries[x_low].pressure = t.left.pressure;
    w.boundaries[x_high].kind = t.high, w.boundaries[x_high].pressure = t.right.pressure;
    const auto in = [](const char* end, const char* side, const SideCase& s) {
        return InflowCase{end, side, s.density, s.pressure, s.velocity, {}};
    };
    w.inflows = {in("x_low", "left", t.left), in("x_high", "right", t.right)};
    w.end = t.end;
    return w;
}

}  // namespace

TEST_CASE("shock tubes of Toro end with their energy whatever the transfer" *
          doctest::description("physics")) {
    common::set_thread_count(1);  // a row of cells is no work for two
    for (std::size_t n = 0; n < toro.size(); ++n) {
        for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
            for (const char* density : {"cells", "particles"}) {
                // Gas that is nearly a void: light nodes, which no viscosity must throw apart.
                Case w = tube_of(toro[n], n != 1 ? 100 : *density == 'c' ? 200 : 400);
                if (n == 1) w.boundaries[x_low].pressure = w.boundaries[x_high].pressure = 0;
                w.transfer = transfer, w.density = density;
                CAPTURE(n + 1);
                CAPTURE(transfer);
                CAPTURE(density);
                FlipRun r(w);
                const Totals before = r.totals();
                const auto run = [&] {
                    while (r.state.time < w.end) r.step();
                };
                CHECK_NOTHROW(run());
                CHECK(r.state.time >= w.end);
                CHECK(leak(before, r.totals(), {}, r.state.budget).most() <= 1e-12);
            }
        }
    }
}

// Pressure between the waves, exact to what two cells of a front change.
TEST_CASE("streams that two ends feed collide as the exact solution says" *
          doctest::description("physics")) {
    const Tube& t = toro[3];
    FlipRun r(tube_of(t));
    while (r.state.time < t.end) r.step();
    r.deposit();
    const auto gas = [](const SideCase& s) {
        return theory::GasState{s.density, s.velocity, s.pressure, s.gamma, s.p_infinity};
    };
    const theory::RiemannSolution exact = theory::solve_riemann(gas(t.left), gas(t.right));
    double p = 0, cells = 0;
    visit_cells(r.grid(), [&](long n, double x, double) {
        const double xi = (x - t.interface) / r.state.time, margin = 0.03 / r.state.time;
        if (xi > exact.left_tail + margin && xi < exact.right_tail - margin)
            p += r.cells().p[n], cells += 1;
    });
    REQUIRE(cells > 20);
    CHECK(std::fabs(p / cells / exact.left_of_contact.pressure - 1) <= 0.02);
}
