// The classical particle-in-cell method step by step: what is exact in the Lagrangian phase, in the
// motion of particles and in the repartition, and what its own diffusion is.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/any_fluid.hpp"

namespace {

using namespace facts;
using Run = facts::PicRun;

RegionCase disk(RegionCase r, double x, double z, double radius) {
    r.shape = "disk";
    r.center_x = x, r.center_z = z, r.radius = radius;
    return r;
}

Case sod() {
    Case w = flip_case(100, 1, "slip", "periodic");
    w.setup = "riemann";
    w.per_cell_x = 16;
    w.end = 0.2;
    return w;
}

// A disk of something like metal hits a plate of something like another, in a void.
Case impact(long cells = 32) {
    Case w = flip_case(cells, cells, "slip", "slip");
    w.materials = {{"ball", 4, 1}, {"plate", 3, 0.5}, {"dust", 1, 0}};
    w.regions = {fluid("plate", 1, 0.1), disk(fluid("ball", 2, 0.05, 1.1, 0.2), 0.3, 0.45, 0.15),
                 disk(fluid("dust", 0.3, 0, 0.5, -0.9), 0.2, 0.85, 0.1)};
    w.regions[0].shape = "box";
    w.regions[0].center_x = 0.7, w.regions[0].center_z = 0.5;
    w.regions[0].half_x = 0.15, w.regions[0].half_z = 0.4;
    return w;
}

// Gases at random everywhere.
Case turbulence(long nx, long nz, const char* ends_x, const char* ends_z) {
    Case w = flip_case(nx, nz, ends_x, ends_z);
    w.materials = {{"air", 1.4, 0}, {"helium", 5.0 / 3, 0}};
    w.loading = "random";
    w.regions = {fluid("air", 1, 1, 0.3, -0.2), disk(fluid("helium", 0.4, 1.5), 0.4, 0.6, 0.25)};
    w.regions[0].noise = 1.5;
    w.regions[1].noise = 0.5;
    if (nz == 1) w.regions[1].center_z = 0, w.per_cell_x = 16;
    return w;
}

// Random velocities and energies in the cells that are filled.
void stir(Run& r, std::uint64_t seed) {
    Random random(seed);
    for (long n = 0; n < r.w.grid.size(); ++n) {
        if (r.cells.mass[n] == 0) continue;
        r.state.cells.vx[n] = random() - 0.5;
        r.state.cells.vz[n] = r.w.plane() ? random() - 0.5 : 0.0;
        for (Field& e : r.state.cells.e) e[n] = 0.5 + random();
    }
}

// What a Lagrangian phase does to the energy, less the budget, and how much there is of it.
struct Change {
    double kinetic = 0, internal = 0, size = 0, momentum_x = 0, momentum_z = 0;
};
Change change_of(Run& r) {
    Change c;
    const std::size_t K = r.cells.materials;
    for (long j = 0; j < r.w.grid.z.cells; ++j) {
        for (long i = 0; i < r.w.grid.x.cells; ++i) {
            const long n = r.w.grid.index(i, j);
            const auto at = std::size_t(n);
            const CellVelocity& b = r.cells.v_tilde[at];
            const double ax = r.state.cells.vx[n], az = r.state.cells.vz[n];
            const double K_change =
                0.5 * r.cells.mass[n] * ((b.x * b.x + b.z * b.z) - (ax * ax + az * az));
            c.kinetic += K_change;
            c.momentum_x += r.cells.mass[n] * (b.x - ax);
            c.momentum_z += r.cells.mass[n] * (b.z - az);
            c.size += std::fabs(K_change);
            for (std::size_t k = 0; k < K; ++k)
                c.internal +=
                    r.cells.M[at * K + k] * (r.cells.e_tilde[at * K + k] - r.state.cells.e[k][n]);
        }
    }
    return c;
}

// Mass, momentum and energy of a run less its budget do not change.
void check_conservation(Run& r, int steps, double tolerance) {
    const Totals a = r.totals();
    const double energy = a.kinetic + a.internal, momentum = std::sqrt(2 * energy * a.mass);
    for (int n = 0; n < steps && r.state.time < r.w.end; ++n) r.step();
    const Totals b = r.totals();
    const Budget& in = r.state.budget;
    CHECK(r.state.time > 0);
    CHECK(std::fabs(b.mass - in.mass - a.mass) <= tolerance * a.mass);
    CHECK(std::fabs(b.momentum_x - in.momentum_x - a.momentum_x) <= tolerance * momentum);
    CHECK(std::fabs(b.momentum_z - in.momentum_z - a.momentum_z) <= tolerance * momentum);
    CHECK(std::fabs(b.kinetic + b.internal - in.energy - energy) <= tolerance * energy);
}

double density(const Run& r, long i, long j = 0) {
    return r.cells.mass[r.w.grid.index(i, j)] / r.w.grid.cell_area();
}

// The state mirrored along x, or with x and z exchanged.
void reflect(Run& r) {
    const Grid& grid = r.w.grid;
    State old = r.state;
    for (double& x : r.state.particles.x_p) x = grid.x.low + (grid.x.high() - x);
    for (long j = 0; j < grid.z.cells; ++j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const long a = grid.index(i, j), b = grid.index(grid.x.cells - 1 - i, j);
            r.state.cells.vx[b] = -old.cells.vx[a];
            r.state.cells.vz[b] = old.cells.vz[a];
            for (std::size_t k = 0; k < old.cells.e.size(); ++k)
                r.state.cells.e[k][b] = old.cells.e[k][a];
        }
    }
    sum_cell_masses(r.problem.grid, r.state, r.cells);
}
void exchange(Run& r) {
    const Grid grid = r.w.grid;
    State old = r.state;
    std::swap(r.w.grid.x, r.w.grid.z);
    std::swap(r.w.boundaries[x_low], r.w.boundaries[z_low]);
    std::swap(r.w.boundaries[x_high], r.w.boundaries[z_high]);
    std::swap(r.w.gravity_x, r.w.gravity_z);
    r.problem = problem_of(r.w);
    r.cells = PicCells(r.problem);
    r.state.particles.x_p.swap(r.state.particles.z_p);
    for (long j = 0; j < grid.z.cells; ++j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const long a = grid.index(i, j), b = r.w.grid.index(j, i);
            r.state.cells.vx[b] = old.cells.vz[a];
            r.state.cells.vz[b] = old.cells.vx[a];
            for (std::size_t k = 0; k < old.cells.e.size(); ++k)
                r.state.cells.e[k][b] = old.cells.e[k][a];
        }
    }
    sum_cell_masses(r.problem.grid, r.state, r.cells);
}

}  // namespace

TEST_CASE("mass and momentum and energy are exact in a shock tube") {
    for (const double q : {0.0, 1.0}) {
        CAPTURE(q);
        Case w = sod();
        w.q_linear = 0.5 * q, w.q_quadratic = q;
        Run r(w);
        check_conservation(r, 1000, 1e-12);
    }
}

TEST_CASE("mass and momentum and energy are exact when solids collide in a void") {
    for (const double q : {0.0, 1.0}) {
        CAPTURE(q);
        Case w = impact();
        w.q_linear *= q, w.q_quadratic *= q;
        w.gravity_z = -0.3;
        w.trap = 0.2;
        Run r(w);
        check_conservation(r, 150, 1e-12);
        CHECK(r.state.time > 0.3);  // the ball has reached the plate
    }
}

TEST_CASE("mass and momentum and energy are exact for gases at random") {
    for (const char* ends : {"periodic", "slip"}) {
        for (const long rows : {1L, 2L, 3L, 12L}) {
            CAPTURE(ends);
            CAPTURE(rows);
            Run r(turbulence(16, rows, "periodic", ends));
            check_conservation(r, 60, 1e-12);
            if (rows == 1) continue;
            Run s(turbulence(rows, 16, ends, "periodic"));
            check_conservation(s, 60, 1e-12);
        }
    }
}

TEST_CASE("a blast into gas without any heat keeps mass and momentum and energy") {
    // The precursor that the repartition sends ahead falls below the smallest of numbers.
    Case w = flip_case(40, 40, "slip", "open");
    w.loading = "random";
    w.regions = {fluid("", 1, 0), disk(fluid("", 1, 0), 0.5, 0.5, 0.06)};
    w.regions[1].energy = 0.3;
    Run r(w);
    check_conservation(r, 200, 1e-12);
    CHECK(r.state.time > 0.02);
    CHECK(r.totals().kinetic > 0.05);
}

TEST_CASE("what flows through the ends is in the budget") {
    for (const bool turned : {false, true}) {
        Case w = turbulence(24, 20, turned ? "slip" : "open", turned ? "open" : "slip");
        w.boundaries[turned ? z_low : x_low].kind = "inflow";
        w.inflow = {"helium", 0.5, 1.2, turned ? 0.0 : 1.5, turned ? 1.5 : 0.0};
        w.boundaries[turned ? z_high : x_high].pressure = 0.4;
        Run r(w);
        const double mass = r.totals().mass;
        check_conservation(r, 200, 1e-12);
        CHECK(std::fabs(r.totals().mass - mass) > 0.02 * mass);
    }
}

TEST_CASE("kinetic energy given and internal energy taken cancel face by face") {
    for (const bool plane : {false, true}) {
        for (const char* ends : {"periodic", "slip", "open"}) {
            for (const bool void_around : {false, true}) {
                CAPTURE(plane);
                CAPTURE(ends);
                CAPTURE(void_around);
                Case w = turbulence(14, plane ? 11 : 1, ends, plane ? ends : "periodic");
                if (void_around) w.regions[0] = disk(w.regions[0], 0.35, plane ? 0.4 : 0, 0.36);
                w.boundaries[x_high].pressure = void_around ? 0 : 0.7;
                w.gravity_x = 0.4, w.gravity_z = plane ? -0.8 : 0, w.trap = 0.3;
                Run r(w);
                stir(r, 3);
                find_pressure(r.problem, r.state, r.cells);
                const double dt = 0.01;
                accelerate_cells(r.problem, dt, r.state, r.cells);
                do_work(r.problem, dt, r.state, r.cells);
                const Change c = change_of(r);
                CHECK(c.size > 0);
                CHECK(std::fabs(c.kinetic + c.internal - r.state.budget.energy) <= 1e-13 * c.size);
                CHECK(std::fabs(c.momentum_x - r.state.budget.momentum_x) <= 1e-13);
                CHECK(std::fabs(c.momentum_z - r.state.budget.momentum_z) <= 1e-13);
            }
        }
    }
}

TEST_CASE("the work of the velocity at the end of the step instead of the mean loses the energy") {
    Run r(turbulence(14, 11, "slip", "slip"));
    stir(r, 4);
    find_pressure(r.problem, r.state, r.cells);
    accelerate_cells(r.problem, 0.01, r.state, r.cells);
    do_work(r.problem, 0.01, r.state, r.cells);
    const Change good = change_of(r);
    r.cells.v = r.cells.v_tilde;
    do_work(r.problem, 0.01, r.state, r.cells);
    const Change bad = change_of(r);
    CHECK(std::fabs(good.kinetic + good.internal) <= 1e-13 * good.size);
    CHECK(std::fabs(bad.kinetic + bad.internal) >= 1e-3 * bad.size);
}

TEST_CASE("a light gas that meets a heavy one needs no shorter steps than its sound") {
    // A face of mean density would press on the light cell as on one of that density.
    Case w = flip_case(8, 1, "slip", "slip");
    w.materials = {{"light", 1.4, 0}, {"heavy", 1.4, 0}};
    w.regions = {fluid("light", 1, 1), fluid("heavy", 1000, 1)};
    w.regions[1].shape = "box";
    w.regions[1].center_x = 0.25, w.regions[1].half_x = 0.25, w.regions[1].half_z = 1;
    Run at_rest(w);
    find_pressure(at_rest.problem, at_rest.state, at_rest.cells);
    w.regions[0].gas.velocity_x = -0.01;
    Run r(w);
    find_pressure(r.problem, r.state, r.cells);
    CHECK(largest_step(r.problem, r.state, r.cells) >=
          0.9 * largest_step(at_rest.problem, at_rest.state, at_rest.cells));
    accelerate_cells(r.problem, 1e-9, r.state, r.cells);
    const double c = 0.5 * (std::sqrt(1.4) + std::sqrt(1.4e-3)), du = 0.01, rho = 2 * 1000.0 / 1001;
    CHECK(std::fabs(r.cells.q_x[r.w.grid.index(4, 0)] / (rho * du * (0.5 * c + du)) - 1) <= 1e-12);
}

TEST_CASE("fluids of any density rest on each other under gravity and fall alike" *
          doctest::description("physics")) {
    for (const double ratio : {1.0, 10.0, 1e3, 1e5}) {
        for (const bool row : {true, false}) {
            CAPTURE(ratio);
            CAPTURE(row);
            Case w = flip_case(row ? 12 : 5, row ? 1 : 12, "slip", "slip");
            if (row)
                w.gravity_x = -1, w.boundaries[z_low].kind = w.boundaries[z_high].kind = "periodic";
            if (!row) w.gravity_z = -1;
            w.materials = {{"light", 1.4, 0}, {"heavy", 4.4, 600}};
            w.regions = {fluid("light", 1 / ratio, 10), fluid("heavy", 1, 10.25)};
            RegionCase &light = w.regions[0], &heavy = w.regions[1];
            (row ? light.center_x : light.center_z) = 0.5;
            heavy.shape = "box", heavy.half_x = heavy.half_z = row ? 1 : 0.25;
            (row ? heavy.half_x : heavy.half_z) = (row ? heavy.center_x : heavy.center_z) = 0.25;
            if (!row) heavy.half_x = 2;
            light.hydrostatic = heavy.hydrostatic = true;
            Run r(w);
            r.steps(300);
            CHECK(worst({r.state.cells.vx.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
                         r.state.cells.vz.cwiseAbs().maxCoeff<Eigen::PropagateNaN>()}) <= 1e-10);
            // Where pressure is even it holds nothing: away from walls all fall with g.
            light.hydrostatic = heavy.hydrostatic = false, heavy.gas.pressure = 10;
            Run falling(w);
            find_pressure(falling.problem, falling.state, falling.cells);
            accelerate_cells(falling.problem, 0.01, falling.state, falling.cells);
            for (long k = 1; k < 11; ++k) {
                const auto n = std::size_t(w.grid.index(row ? k : 2, row ? 0 : k));
                const CellVelocity& v = falling.cells.v_tilde[n];
                CHECK(std::fabs((row ? v.x : v.z) + 0.01) <= 1e-12 * ratio);
            }
        }
    }
}

TEST_CASE("an interior cell is pushed by the pressures beside it and works with its own") {
    for (const double q : {0.0, 1.0}) {
        Case w = flip_case(8, 1, "periodic", "periodic");
        w.regions = {fluid("", 1, 1)};
        w.q_linear = 0.5 * q, w.q_quadratic = q;
        Run s(w);
        stir(s, 5);
        find_pressure(s.problem, s.state, s.cells);
        const double dt = 0.003, A = w.grid.z.spacing();
        accelerate_cells(s.problem, dt, s.state, s.cells);
        do_work(s.problem, dt, s.state, s.cells);
        const auto n = [&](long i) { return s.w.grid.index((i + 8) % 8, 0); };
        const auto u = [&](long i) { return s.state.cells.vx[n(i)]; };
        const auto ubar = [&](long i) {
            return 0.5 * (u(i) + s.cells.v_tilde[std::size_t(n(i))].x);
        };
        const auto p = [&](long i) { return 0.4 * 1.0 * s.state.cells.e[0][n(i)]; };
        const auto c = [&](long i) { return std::sqrt(1.4 * p(i)); };
        const auto viscous = [&](long i) {  // on the face between i and i + 1
            const double du = u(i + 1) - u(i);
            return du < 0 ? q * -du * (0.25 * (c(i) + c(i + 1)) - du) : 0.0;
        };
        const auto P = [&](long i) { return 0.5 * (p(i) + p(i + 1)) + viscous(i); };
        const double M = s.cells.mass[n(0)];
        for (long i = 0; i < 8; ++i) {
            const auto at = std::size_t(n(i));
            CHECK(std::fabs(s.cells.v_tilde[at].x - (u(i) - dt * A / M * (P(i) - P(i - 1)))) <=
                  1e-14);
            const double right = 0.5 * (ubar(i) + ubar(i + 1)),
                         left = 0.5 * (ubar(i) + ubar(i - 1));
            const double work = p(i) * (right - left) + viscous(i) * (right - ubar(i)) +
                                viscous(i - 1) * (ubar(i) - left);
            CHECK(std::fabs(s.cells.e_tilde[at] - (s.state.cells.e[0][n(i)] - dt * A / M * work)) <=
                  1e-14);
        }
    }
}

TEST_CASE("gases in one cell share the pressure and the work by their stiffness") {
    Case w = flip_case(2, 1, "periodic", "periodic");
    w.materials = {{"air", 1.4, 0}, {"helium", 5.0 / 3, 0}};
    w.per_cell_x = 2;
    w.regions = {fluid("air", 1, 1), fluid("helium", 0.3, 2)};
    w.regions[1].shape = "box";
    w.regions[1].center_x = 0.125, w.regions[1].half_x = 0.1, w.regions[1].half_z = 1;
    Run r(w);
    find_pressure(r.problem, r.state, r.cells);
    const long n = r.w.grid.index(0, 0), m = r.w.grid.index(1, 0);
    CHECK(std::fabs(r.cells.p[n] - 1.5) <= 1e-14);  // half a cell of each
    CHECK(std::fabs(r.cells.p[m] - 1.0) <= 1e-14);
    // V_k/(gamma_k p) with V_k of the partial pressures 1/2 and 1.
    const auto at = std::size_t(n);
    CHECK(std::fabs(r.cells.share[2 * at] - (0.5 / 1.4) / (0.5 / 1.4 + 1 / (5.0 / 3))) <= 1e-14);
    CHECK(std::fabs(r.cells.share[2 * at] + r.cells.share[2 * at + 1] - 1) <= 1e-15);
    r.state.cells.vx[n] = 1;
    find_pressure(r.problem, r.state, r.cells);
    accelerate_cells(r.problem, 0.01, r.state, r.cells);
    do_work(r.problem, 0.01, r.state, r.cells);
    const auto work = [&](std::size_t k) {
        return r.cells.M[2 * at + k] * (r.cells.e_tilde[2 * at + k] - r.state.cells.e[k][n]);
    };
    CHECK(std::fabs(work(0)) > 1e-6);
    CHECK(std::fabs(work(0) / (work(0) + work(1)) - r.cells.share[2 * at]) <= 1e-12);
}

TEST_CASE("the speed of sound is that of the material also where it does not fill its cell") {
    Case w = flip_case(8, 8, "slip", "slip");
    w.materials = {{"metal", 4, 3}};
    w.regions = {fluid("metal", 2, 0)};
    Run r(w);
    for (const double left : {1.0, 0.25}) {  // of the mass in one cell
        const long n = r.w.grid.index(3, 3);
        r.cells.M[std::size_t(n)] *= left;
        find_pressure(r.problem, r.state, r.cells);
        CHECK(r.cells.p[n] <= 1e-14);
        CHECK(std::fabs(r.cells.c[n] - std::sqrt(4 * 3 / 2.0)) <= 1e-13);
    }
}

TEST_CASE("the heat of mixing is that of an inelastic impact") {
    // Dust of mass m runs into dust of mass M that rests in the next cell.
    const double m = 0.3, M = 0.8, u = 1.7;
    Case w = flip_case(8, 1, "slip", "periodic");
    w.materials = {{"dust", 1, 0}};
    w.q_linear = w.q_quadratic = 0;
    w.dt = 0.06;
    Run r(w);
    r.state.particles.x_p = {0.24, 0.3};
    r.state.particles.z_p = {0.01, 0.01};
    r.state.particles.m_p = {m, M};
    r.state.particles.material = {0, 0};
    const long A = w.grid.index(1, 0), B = w.grid.index(2, 0);
    r.state.cells.vx[A] = u;
    r.state.cells.e[0][A] = 0.5, r.state.cells.e[0][B] = 2;
    sum_cell_masses(r.problem.grid, r.state, r.cells);
    r.step();
    const double heat = 0.5 * m * M / (m + M) * u * u;
    CHECK(r.cells.mass[A] == 0);
    CHECK(std::fabs(r.cells.mass[B] - (m + M)) <= 2 * eps);
    CHECK(std::fabs(r.state.cells.vx[B] - m * u / (m + M)) <= 2 * eps);
    CHECK(std::fabs((m + M) * r.state.cells.e[0][B] - (m * 0.5 + M * 2 + heat)) <= 8 * eps);
}

TEST_CASE("a cell that all particles have left is empty to the last bit") {
    Case w = impact();
    Run r(w);
    std::vector<bool> was(std::size_t(w.grid.size()));
    long emptied = 0;
    for (int step = 0; step < 80; ++step) {
        for (std::size_t n = 0; n < was.size(); ++n) was[n] = r.cells.mass[long(n)] > 0;
        r.step();
        for (long j = 0; j < w.grid.z.cells; ++j) {
            for (long i = 0; i < w.grid.x.cells; ++i) {
                const long n = w.grid.index(i, j);
                bool anyone = false;
                for (std::size_t p = 0; p < r.state.particles.x_p.size() && !anyone; ++p)
                    anyone = cell_along(w.grid.x, r.state.particles.x_p[p]) == i &&
                             cell_along(w.grid.z, r.state.particles.z_p[p]) == j;
                if (anyone) continue;
                emptied += was[std::size_t(n)] ? 1 : 0;
                double sum = std::fabs(r.cells.mass[n]) + std::fabs(r.state.cells.vx[n]) +
                             std::fabs(r.state.cells.vz[n]);
                for (const Field& e : r.state.cells.e) sum += std::fabs(e[n]);
                CHECK(sum == 0);
            }
        }
    }
    CHECK(emptied > 20);
}

TEST_CASE("a body in a void flies with one velocity and stays cold") {
    for (const long rows : {1L, 24L}) {
        Case w = flip_case(24, rows, "periodic", "periodic");
        w.materials = {{"metal", 4, 1}};
        w.regions = {disk(fluid("metal", 1, 0, 0.7, rows > 1 ? -0.4 : 0.0), 0.3, 0.5, 0.2)};
        if (rows == 1) w.regions[0].center_z = 0;
        w.dt = 0.013;
        Run r(w);
        const Totals before = r.totals();
        r.steps(100);
        CHECK(std::fabs(r.totals().internal - before.internal) <= 1e-13 * before.internal);
        double most = 0;
        for_each_cell(w.grid, [&](long, long, long n) {
            if (r.cells.mass[n] > 0) most = worst({most, std::fabs(r.state.cells.vx[n] - 0.7)});
        });
        CHECK(most <= 1e-13);
    }
}

TEST_CASE("gas in a periodic box falls as one body") {
    Case w = flip_case(12, 10, "periodic", "periodic");
    w.regions = {fluid("", 1, 1, 0.1, 0.2)};
    w.gravity_x = 0.3, w.gravity_z = -0.5;
    w.dt = 0.01;
    Run r(w);
    r.steps(25);  // nobody leaves a cell in the same step as a neighbor on the lattice would not
    const Totals t = r.totals();
    CHECK(std::fabs(t.momentum_x - t.mass * (0.1 + 0.3 * 0.25)) <= 1e-14);
    CHECK(std::fabs(t.momentum_z - t.mass * (0.2 - 0.5 * 0.25)) <= 1e-14);
}

TEST_CASE("the trap pulls every cell towards the middle of the mesh") {
    Case w = flip_case(6, 5, "slip", "slip");
    w.grid.x.low = -2, w.grid.z.low = 1;
    w.materials = {{"dust", 1, 0}};
    w.regions = {fluid("dust", 1, 0)};
    w.trap = 3, w.gravity_x = 0.2, w.gravity_z = 0.1;
    Run r(w);
    find_pressure(r.problem, r.state, r.cells);
    accelerate_cells(r.problem, 0.01, r.state, r.cells);
    for (long j = 0; j < 5; ++j) {
        for (long i = 0; i < 6; ++i) {
            const CellVelocity& v = r.cells.v_tilde[std::size_t(w.grid.index(i, j))];
            const double x = w.grid.x.at(real(i) + 0.5) + 1.5, z = w.grid.z.at(real(j) + 0.5) - 1.5;
            CHECK(std::fabs(v.x - 0.01 * (0.2 - 3 * x)) <= 1e-16);
            CHECK(std::fabs(v.z - 0.01 * (0.1 - 3 * z)) <= 1e-16);
        }
    }
}

TEST_CASE("a wall is a mirror") {
    // Half of a box that is symmetric about x = 1/2, with a wall there, moves like that half.
    Run whole(turbulence(24, 10, "slip", "slip"));
    Case part = whole.w;
    part.grid.x = {12, 0, 0.5, false};
    Run half(part);
    stir(half, 7);
    whole.state.particles = half.state.particles;
    Particles& all = whole.state.particles;
    for (std::size_t p = 0; p < half.state.particles.x_p.size(); ++p) {
        all.x_p.push_back(1 - half.state.particles.x_p[p]);
        all.z_p.push_back(half.state.particles.z_p[p]);
        all.m_p.push_back(half.state.particles.m_p[p]);
        all.material.push_back(half.state.particles.material[p]);
    }
    for (long j = 0; j < 10; ++j) {
        for (long i = 0; i < 12; ++i) {
            const long from = part.grid.index(i, j), a = whole.w.grid.index(i, j),
                       b = whole.w.grid.index(23 - i, j);
            whole.state.cells.vx[a] = half.state.cells.vx[from];
            whole.state.cells.vx[b] = -half.state.cells.vx[from];
            whole.state.cells.vz[a] = whole.state.cells.vz[b] = half.state.cells.vz[from];
            for (std::size_t k = 0; k < 2; ++k)
                whole.state.cells.e[k][a] = whole.state.cells.e[k][b] = half.state.cells.e[k][from];
        }
    }
    sum_cell_masses(whole.problem.grid, whole.state, whole.cells);
    whole.problem.limits.dt = half.problem.limits.dt = 0.004;
    whole.steps(25), half.steps(25);
    double most = 0;
    for (long j = 0; j < 10; ++j)
        for (long i = 0; i < 12; ++i)
            most = worst({most,
                          std::fabs(whole.state.cells.vx[whole.w.grid.index(i, j)] -
                                    half.state.cells.vx[part.grid.index(i, j)]),
                          std::fabs(density(whole, i, j) - density(half, i, j))});
    CHECK(most <= 1e-11);
}

TEST_CASE("left and right and up and down are alike") {
    const Case w = turbulence(20, 14, "slip", "periodic");
    Run plain(w), mirrored(w), exchanged(w);
    for (Run* r : {&plain, &mirrored, &exchanged}) stir(*r, 8);
    reflect(mirrored);
    exchange(exchanged);
    for (Run* r : {&plain, &mirrored, &exchanged}) r->steps(25);
    reflect(mirrored);
    exchange(exchanged);
    for (Run* r : {&mirrored, &exchanged}) {
        double most = 0;
        for_each_cell(w.grid, [&](long, long, long n) {
            most = worst({most, std::fabs(r->state.cells.vx[n] - plain.state.cells.vx[n]),
                          std::fabs(r->state.cells.vz[n] - plain.state.cells.vz[n]),
                          std::fabs(r->cells.mass[n] - plain.cells.mass[n]),
                          std::fabs(r->state.cells.e[1][n] - plain.state.cells.e[1][n])});
        });
        CHECK(most <= 1e-10);
    }
}

TEST_CASE("the number of threads does not change a bit") {
    Case w = impact(72);
    w.boundaries[x_low].kind = w.boundaries[x_high].kind = "open";
    w.boundaries[z_low].kind = w.boundaries[z_high].kind = "periodic";
    std::vector<State> states;
    const int before = common::thread_count();
    for (const int threads : {1, 2, 3}) {
        common::set_thread_count(threads);
        Run r(w);
        r.steps(40);
        states.push_back(r.state);
    }
    common::set_thread_count(before);
    for (const State& s : states) {
        CHECK((s.particles.x_p == states[0].particles.x_p));
        CHECK((s.particles.z_p == states[0].particles.z_p));
        CHECK((s.cells.vx == states[0].cells.vx));
        CHECK((s.cells.e[0] == states[0].cells.e[0]));
        CHECK(s.time == states[0].time);
        CHECK(s.budget.energy == states[0].budget.energy);
    }
}

TEST_CASE("the masses of the cells come back from the particles to the last bit") {
    Run r(turbulence(20, 14, "slip", "periodic"));
    r.steps(30);
    const PicCells before = r.cells;
    const Particles particles = r.state.particles;
    sum_cell_masses(r.problem.grid, r.state, r.cells);
    CHECK((r.cells.M == before.M));
    CHECK((r.state.particles.x_p == particles.x_p));
    CHECK((r.state.particles.first_of_row == particles.first_of_row));
}

TEST_CASE("the method diffuses what it carries by half the velocity and what is left of a cell" *
          doctest::description("physics")) {
    struct Expected {
        double C, D;
        long per_cell;
    };
    // With few particles, one at a time crosses: (1 - 1/per cell)/2.
    for (const Expected& e :
         {Expected{0.05, 0.475, 64}, Expected{0.2, 0.4, 64}, Expected{0.5, 0.25, 64},
          Expected{0.9, 0.05, 64}, Expected{0.05, 0.375, 4}, Expected{0.5, 0.25, 16}}) {
        Case w = flip_case(200, 1, "periodic", "periodic");
        w.materials = {{"dust", 1, 0}};
        w.regions = {fluid("dust", 1, 1, 1)};
        w.regions[0].flow = "gaussian";
        w.regions[0].center_x = 0.5, w.regions[0].width = 0.05, w.regions[0].amplitude = 1;
        w.per_cell_x = e.per_cell;
        const double dx = w.grid.x.spacing();
        w.dt = e.C * dx;
        w.end = 36 * dx;
        Run r(w);
        const auto variance = [&](double center) {
            double sum = 0, first = 0, second = 0;
            for (long i = 0; i < 200; ++i) {
                const double x = (real(i) + 0.5) * dx - center, s = x - std::floor(x + 0.5);
                const double weight = r.state.cells.e[0][w.grid.index(i, 0)] - 1;
                sum += weight, first += weight * s, second += weight * s * s;
            }
            return second / sum - first * first / (sum * sum);
        };
        const double before = variance(0.5);
        r.to_the_end();
        const double D = (variance(0.5 + 36 * dx) - before) / (2 * w.end);
        MESSAGE("C = " << e.C << " per cell " << e.per_cell << ": D/(u dx) = " << D / dx);
        CHECK(std::fabs(D / dx - e.D) <= 0.01 * e.D);
    }
}

TEST_CASE("the centered velocity in the work lets sound grow weakly" *
          doctest::description("physics")) {
    // In each step by (1 + (1 - a) (c kappa dt)^2)^(1/2), a = (gamma + 1)/(2 gamma),
    // kappa = sin(k dx)/dx; over four periods of a traveling wave in 16 cells.
    const long N = 16;
    const double gamma = 1.4, c = std::sqrt(gamma), kappa = real(N) * std::sin(2 * pi / real(N)),
                 amplitude = 0.02;
    Case w = flip_case(N, 1, "periodic", "periodic");
    w.regions = {fluid("", 1, 1)};
    w.regions[0].flow = "wave", w.regions[0].amplitude = amplitude;
    w.per_cell_x = 64;
    w.q_linear = w.q_quadratic = 0;
    w.dt = 0.5 / (real(N) * c);
    w.end = 4 * 2 * pi / (kappa * c);
    Run r(w);
    r.to_the_end();
    double re = 0, im = 0;
    for (long i = 0; i < N; ++i) {
        const double phase = 2 * pi * (real(i) + 0.5) / real(N),
                     u = r.state.cells.vx[w.grid.index(i, 0)] * 2 / real(N);
        re += u * std::cos(phase), im += u * std::sin(phase);
    }
    const double a = (gamma + 1) / (2 * gamma), s = c * kappa * w.dt,
                 expected = 0.5 * std::log(1 + (1 - a) * s * s) * w.end / w.dt,
                 measured = std::log(std::hypot(re, im) / (amplitude * c));
    MESSAGE("growth over four periods: " << std::exp(measured) << ", expected "
                                         << std::exp(expected));
    CHECK(std::fabs(measured - expected) <= 0.15 * expected);
}

TEST_CASE("a uniform stream through both ends stays uniform") {
    Case w = flip_case(12, 6, "open", "periodic");
    w.boundaries[x_low].kind = "inflow";
    w.inflow = {"", 1, 1, 2, 0};
    w.boundaries[x_high].pressure = 1;
    w.regions = {fluid("", 1, 1, 2, 0)};
    w.dt = 1.0 / 12 / 4 / 2;  // a column of particles enters and one leaves in every step
    Run r(w);
    r.steps(100);
    CHECK(r.state.particles.count() == 12 * 6 * 16);
    CHECK(std::fabs(r.totals().mass - 1) <= 1e-13);
    CHECK(std::fabs(r.state.budget.mass) <= 1e-12);
    for (long j = 0; j < 6; ++j) {
        for (long i = 0; i < 12; ++i) {
            CHECK(std::fabs(r.state.cells.vx[w.grid.index(i, j)] - 2) <= 1e-12);
            CHECK(std::fabs(r.state.cells.e[0][w.grid.index(i, j)] - 2.5) <= 1e-12);
        }
    }
    CHECK(r.state.particles.vx_p.empty());
}

TEST_CASE("fluid enters a mesh that was empty") {
    Case w = flip_case(10, 4, "open", "periodic");
    w.boundaries[x_low].kind = "inflow";
    w.inflow = {"", 1, 0.1, 1, 0};
    Run r(w);
    for (int n = 0; n < 400 && r.state.time < 0.5; ++n) {
        if (r.state.dt == 0) r.problem.limits.dt = 0.02;
        r.step();
        r.problem.limits.dt = 0.01;
    }
    CHECK(r.state.particles.count() > 0);
    CHECK(r.state.particles.e_p.empty());
    CHECK(std::fabs(r.totals().mass - r.state.budget.mass) <= 1e-13);
    CHECK(std::fabs(r.totals().mass - 0.5) <= 0.03);
    CHECK(std::fabs(r.totals().kinetic + r.totals().internal - r.state.budget.energy) <= 1e-13);
}

TEST_CASE("totals and fields are those of the fluid") {
    Case w = impact(20);
    Run r(w);
    stir(r, 9);
    find_pressure(r.problem, r.state, r.cells);
    CellFields fields;
    fields_of(r.problem.grid, r.state, r.cells, fields);
    const Totals t = r.totals();
    Totals s;
    const double V = w.grid.cell_area();
    double by_material = 0, pressed = 0;
    for (long j = 0; j < 20; ++j) {
        for (long i = 0; i < 20; ++i) {
            const long n = w.grid.index(i, j);
            const double m = fields.rho[n] * V, x = (real(i) + 0.5) / 20 - 0.5,
                         z = (real(j) + 0.5) / 20 - 0.5, vx = fields.vx[n], vz = fields.vz[n];
            s.mass += m, s.momentum_x += m * vx, s.momentum_z += m * vz;
            s.angular_momentum += m * (x * vz - z * vx);
            s.kinetic += 0.5 * m * (vx * vx + vz * vz), s.internal += m * fields.e[n];
            for (const Field& rho : fields.rho_of) by_material += rho[n] * V;
            pressed += fields.p[n];
            if (m == 0) CHECK(std::fabs(vx) + std::fabs(fields.p[n]) + fields.e[n] == 0);
        }
    }
    double mass = 0;
    for (const double m : r.state.particles.m_p) mass += m;
    CHECK(std::fabs(t.mass - mass) <= 1e-13);
    CHECK(std::fabs(by_material - mass) <= 1e-13);
    CHECK(pressed > 0);
    for (const double difference :
         {t.mass - s.mass, t.momentum_x - s.momentum_x, t.momentum_z - s.momentum_z,
          t.angular_momentum - s.angular_momentum, t.kinetic - s.kinetic, t.internal - s.internal})
        CHECK(std::fabs(difference) <= 1e-14);
}

TEST_CASE("the time step follows flow and sound and not where the run ends") {
    Case w = flip_case(10, 5, "periodic", "periodic");
    w.regions = {fluid("", 1, 1, 0.3, -0.2)};
    w.q_linear = w.q_quadratic = 0;
    Run r(w);
    find_pressure(r.problem, r.state, r.cells);
    const double c = std::sqrt(1.4), rate = 0.3 * 10 + 0.2 * 5 + c * std::hypot(10, 5);
    CHECK(std::fabs(largest_step(r.problem, r.state, r.cells) * rate - 0.3) <= 1e-14);
    r.state.dt = 1e-3;
    CHECK(std::fabs(largest_step(r.problem, r.state, r.cells) - 1.2e-3) <= 1e-17);
    r.state.dt = 0;
    r.state.time = 0.5, r.problem.limits.end = 0.5001;
    CHECK(std::fabs(largest_step(r.problem, r.state, r.cells) * rate - 0.3) <= 1e-14);
    r.problem.limits.dt = 0.07;
    CHECK(largest_step(r.problem, r.state, r.cells) == 0.07);

    // In a row the height of the cells does not count.
    Case flat = flip_case(10, 1, "periodic", "periodic");
    flat.regions = {fluid("", 1, 1, 0.3, 0)};
    flat.q_linear = flat.q_quadratic = 0;
    Run row(flat);
    find_pressure(row.problem, row.state, row.cells);
    CHECK(std::fabs(largest_step(row.problem, row.state, row.cells) * (0.3 + c) * 10 - 0.3) <=
          1e-14);

    // A light cell between an empty one and one of high pressure, which gives it sqrt(P/rho) at least.
    Case edge = flip_case(8, 1, "slip", "slip");
    edge.materials = {{"gas", 1.4, 0}};
    edge.regions = {fluid("gas", 0, 0), fluid("gas", 1e-6, 1e-6), fluid("gas", 1, 100)};
    for (const std::size_t k : {1, 2}) {
        edge.regions[k].shape = "box";
        edge.regions[k].half_z = 1;
        edge.regions[k].half_x = k == 1 ? 0.0625 : 0.25;
        edge.regions[k].center_x = k == 1 ? 0.4375 : 0.75;
    }
    edge.q_linear = edge.q_quadratic = 0;
    Run light(edge);
    find_pressure(light.problem, light.state, light.cells);
    const double pushed = std::sqrt(0.5 * (100 + 1e-6) / 1e-6) * 8;
    CHECK(std::fabs(largest_step(light.problem, light.state, light.cells) * pushed - 0.3) <= 1e-9);

    // Dust at rest has no speed to go by.
    Case still = flip_case(10, 5, "periodic", "periodic");
    still.materials = {{"dust", 1, 0}};
    still.regions = {fluid("dust", 1, 0)};
    still.end = 3;
    Run s(still);
    find_pressure(s.problem, s.state, s.cells);
    CHECK(std::fabs(largest_step(s.problem, s.state, s.cells) - 0.03) <= 1e-16);
    s.problem.body_force.gravity_z = -2;
    CHECK(std::fabs(largest_step(s.problem, s.state, s.cells) - 0.3 / std::sqrt(2 * 10.0)) <=
          1e-15);
}

TEST_CASE("viscosity does not throw back cold streams that meet") {
    Case w = flip_case(20, 1, "slip", "periodic");
    w.materials = {{"dust", 1, 0}};
    w.regions = {fluid("dust", 1, 0, 1), fluid("dust", 0.05, 0, -1)};
    w.regions[1].shape = "box";
    w.regions[1].center_x = 0.75, w.regions[1].half_x = 0.25, w.regions[1].half_z = 1;
    w.cfl = 1;
    for (const double quadratic : {1.0, 4.0}) {
        w.q_quadratic = quadratic;
        Run r(w);
        const Totals before = r.totals();
        find_pressure(r.problem, r.state, r.cells);
        const double dt = largest_step(r.problem, r.state, r.cells);
        accelerate_cells(r.problem, dt, r.state, r.cells);
        do_work(r.problem, dt, r.state, r.cells);
        const auto n = std::size_t(w.grid.index(9, 0));
        CHECK(r.cells.v_tilde[n].x < 1);
        CHECK(r.cells.v_tilde[n].x >= r.cells.v_tilde[n + 1].x);
        CHECK(r.cells.v_tilde[n].x - r.cells.v_tilde[n + 1].x <= 1);  // and not for nothing
        CHECK(r.cells.e_tilde[n] > 0);
        CHECK(r.cells.e_tilde[n + 1] > 0);
        CHECK(before.internal == 0);
    }
}

TEST_CASE("a step that is much too long ends the run with a word on where and why") {
    const auto message = [](Case w, int steps) {
        try {
            Run r(w);
            r.steps(steps);
        } catch (const common::NumericalError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    Case hot = sod();
    hot.dt = 0.05;
    const std::string about_energy = message(hot, 10);
    CAPTURE(about_energy);
    CHECK(about_energy.find("t = 0") != std::string::npos);
    CHECK(about_energy.find("time.cfl") != std::string::npos);
    Case fast = flip_case(10, 1, "slip", "periodic");
    fast.materials = {{"dust", 1, 0}};
    fast.regions = {fluid("dust", 1, 0, 1)};
    fast.dt = 0.2;
    const std::string about_wall = message(fast, 3);
    CAPTURE(about_wall);
    CHECK(about_wall.find("gone through the wall") != std::string::npos);
}
