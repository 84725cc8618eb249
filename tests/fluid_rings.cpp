// Cells that are rings about an axis, in flip and pic: their volumes, forces that are transposes of
// how the volumes change, and what whole steps keep.
#include <doctest/doctest.h>

#include "tests/support/any_fluid.hpp"

namespace {

using namespace facts;

// Volume of the ring with the straight sides between four corners, counterclockwise: 2 pi times the
// integral of x over their polygon.
double volume_of(const std::array<Eigen::Vector2d, 4>& at) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d &a = at[k], &b = at[(k + 1) % 4];
        sum += (a[0] * b[1] - b[0] * a[1]) * (a[0] + b[0]) / 6;
    }
    return 2 * pi * sum;
}

// A sphere of one material meets a plate of another, in a void.
Case impact(long cells) {
    Case w = rings(cells, cells, "open");
    w.materials = {{"ball", 4, 1}, {"plate", 3, 0.5}};
    w.regions = {fluid("plate", 1, 0.1), fluid("ball", 2, 0.05, 0, -1.1)};
    w.regions[0].shape = "box";
    w.regions[0].center_z = 0.35, w.regions[0].half_x = 0.7, w.regions[0].half_z = 0.15;
    w.regions[1].shape = "disk";
    w.regions[1].center_z = 0.75, w.regions[1].radius = 0.2;
    return w;
}

}  // namespace

TEST_CASE("the dilation of a ring is how fast the volume between its corners changes") {
    const Case w = completed(rings(5, 4));
    const Grid& grid = w.grid;
    Random random(1);
    Field vx, vz;
    stir_nodes(grid, random, vx), stir_nodes(grid, random, vz);
    for (long j = 0; j <= 4; ++j) vx[grid.index(0, j)] = 0;
    for_each_cell(grid, [&](long i, long j, long n) {
        const auto volume_after = [&](double t) {
            std::array<Eigen::Vector2d, 4> at;
            for (const long k : {0, 1, 2, 3}) {
                const long a = i + (k == 1 || k == 2), b = j + (k > 1), m = grid.index(a, b);
                at[std::size_t(k)] = {grid.x.at(real(a)) + t * vx[m],
                                      grid.z.at(real(b)) + t * vz[m]};
            }
            return volume_of(at);
        };
        CHECK(std::fabs(volume_after(0) - cell_volume(grid, i)) <= 1e-15);
        const double t = 1e-4, rate = (volume_after(t) - volume_after(-t)) / (2 * t);
        CHECK(std::fabs(dilation(grid, vx, vz, n) - rate) <= 1e-7);
    });
}

TEST_CASE("the force of pressure on rings is the transpose and uniform pressure pushes nothing") {
    for (const char* high : {"slip", "open"}) {
        Case w = rings(7, 5, high, high);
        for (BoundaryCase& end : w.boundaries)
            if (end.kind == "open") end.pressure = 0.7;
        w = completed(w);
        const Problem problem = problem_of(w);
        const Grid& grid = w.grid;
        Random random(2);
        Field vx, vz, p = Field::Zero(grid.size());
        stir_nodes(grid, random, vx), stir_nodes(grid, random, vz);
        for_each_cell(grid, [&](long, long, long n) { p[n] = random(-1, 1); });
        double by_nodes = 0, by_cells = 0, along = 0, size = 0;
        for_own_nodes(grid, [&](long, long, long n) {
            const Eigen::Vector2d F = pressure_force(grid, p, n);
            by_nodes += F[0] * vx[n] + F[1] * vz[n], along += F[1], size += F.norm();
        });
        for_each_cell(grid,
                      [&](long, long, long n) { by_cells += p[n] * dilation(grid, vx, vz, n); });
        CHECK(std::fabs(by_nodes - by_cells) <= 1e-14 * size);
        CHECK(std::fabs(along) <= 1e-14 * size);
        for_each_cell(grid, [&](long, long, long n) { p[n] = 0.7; });
        for_own_nodes(grid, [&](long i, long j, long n) {
            const Held held = held_at(grid, problem.boundaries, i, j);
            const Eigen::Vector2d F =
                pressure_force(grid, p, n) + boundary_force(grid, problem.boundaries, i, j);
            if (!held.x) CHECK(std::fabs(F[0]) <= 1e-15);
            if (!held.z) CHECK(std::fabs(F[1]) <= 1e-15);
        });
    }
}

TEST_CASE("a pressure that falls along the axis accelerates all nodes alike") {
    for (const long per_cell : {1L, 2L, 3L}) {
        Case w = rings(6, 5);
        w.regions = {fluid("", 1, 1)};
        w.per_cell_x = w.per_cell_z = per_cell;
        FlipRun r(w);
        r.deposit();
        Field p = Field::Zero(r.grid().size());
        for_each_cell(r.grid(), [&](long, long j, long n) { p[n] = 3 - 0.4 * real(j); });
        for_each_node(r.grid(), [&](long, long j, long n) {
            const double a = pressure_force(r.grid(), p, n)[1] / r.nodes().m[n];
            if (j > 0 && j < 5) CHECK(std::fabs(a - 0.4 * 5) <= 1e-13);
        });
    }
}

TEST_CASE("the cells of rings have their volumes and the density of the fluid") {
    for (const long per_cell : {1L, 2L, 3L, 4L, 64L}) {
        Case w = rings(6, 3);
        w.regions = {fluid("", 2, 1)};
        w.per_cell_x = per_cell;
        FlipRun r(w);
        r.deposit();
        const CellFields f = cell_fields(r.grid(), r.scratch.mesh);
        double V = 0, most = 0;
        for_each_cell(r.grid(), [&](long i, long, long n) {
            CHECK(std::fabs(f.rho[n] - 2) <= 1e-13);
            CHECK(std::fabs(f.p[n] - 1) <= 1e-13);
            const double V_i = r.cells().V_of_column[std::size_t(i)];
            V += V_i, most = worst({most, std::fabs(V_i / cell_volume(r.grid(), i) - 1)});
        });
        CHECK(std::fabs(V - pi) <= 1e-13);
        CHECK(std::fabs(r.totals().mass - 2 * pi) <= 1e-13);
        // Weights that are linear in r^2 give a ring its volume; those of the plane, 13/12 of it on
        // the axis, however many particles there are.
        if (per_cell > 1) CHECK(most <= 0.01);
        if (per_cell == 64) CHECK(most <= 1e-4);
    }
}

TEST_CASE("regions of rings hold the energies that they are given beside those of their pressure") {
    for (const bool random : {false, true}) {
        Case w = rings(6, 4);
        w.regions = {fluid("", 2, 1), fluid("", 3, 1)};
        w.regions[1].shape = "disk", w.regions[1].center_z = 0.5, w.regions[1].radius = 0.4;
        if (random) w.loading = "random";
        const auto internal = [&] {
            const Particles p = load_particles(completed(w));
            double sum = 0;
            for (std::size_t k = 0; k < p.m_p.size(); ++k) sum += p.m_p[k] * p.e_p[k];
            return sum;
        };
        const double before = internal();
        for (const auto& [region, energy] : {std::pair(0, 5.0), {1, 7.0}}) {
            w.regions[0].energy = w.regions[1].energy = 0;
            w.regions[std::size_t(region)].energy = energy;
            CHECK(std::fabs(internal() - before - energy) <= 1e-13 * (before + energy));
        }
    }
}

TEST_CASE("every step on rings keeps mass and momentum along the axis and energy" *
          doctest::description("physics")) {
    long combinations = 0;
    for (const bool hole : {false, true}) {
        for (const char* high : {"slip", "no_slip", "open"}) {
            for (const char* ends_z : {"periodic", "open", "inflow"}) {
                for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
                    for (const int method : {0, 1, 2, 3, 4}) {
                        const bool consistent = method == 4;
                        if (consistent && (hole || std::string(transfer) != "flip")) continue;
                        Case w = rings(7, 6, high, ends_z);
                        if (w.is(z_low, "inflow")) {
                            w.boundaries[z_high].kind = "open";
                            w.inflow = {"", 1, 1, 0, 0.8};
                        }
                        for (BoundaryCase& end : w.boundaries)
                            if (end.kind == "open") end.pressure = 0.6;
                        w.materials = {{"air", 1.4, 0}, {"water", 4, 0.5}};
                        w.transfer = transfer, w.xpic_order = 3, w.dt = 0.004;
                        if (method == 1) w.density = "particles", w.viscosity = 0.02;
                        if (method > 1 && !consistent) w.pressure = "implicit", w.tolerance = 1e-10;
                        if (method == 3) w.theta = 0.6, w.viscosity = 0.02;
                        if (consistent) w.mass = "consistent";
                        Random random(5);
                        Particles p;
                        add_cloud(completed(w), hole ? 200 : 700,
                                  hole ? CloudBox{0, 0.63, 0.3, 0.8} : CloudBox{}, 1, 0.5, random,
                                  p);
                        CAPTURE(hole);
                        CAPTURE(std::string(high));
                        CAPTURE(std::string(ends_z));
                        CAPTURE(std::string(transfer));
                        CAPTURE(method);
                        FlipRun r(w, p);
                        for (int n = 0; n < 3; ++n) {
                            const Totals a = r.totals();
                            const Budget before = r.state.budget;
                            r.step();
                            const Leak l = leak_along(a, r.totals(), before, r.state.budget);
                            CHECK(l.mass <= 1e-14);
                            CHECK(l.momentum <= 1e-13);
                            CHECK(l.energy <= 1e-13);
                        }
                        ++combinations;
                    }
                }
            }
        }
    }
    CHECK(combinations == 2 * 9 * 5 * 4 + 9);
}

TEST_CASE("a sphere that hits a plate keeps mass and momentum along the axis and energy") {
    for (const char* transfer : {"flip", "apic"}) {
        Case w = impact(24);
        w.transfer = transfer;
        FlipRun r(w);
        const Totals before = r.totals();
        r.steps(100);
        CHECK(leak_along(before, r.totals(), {}, r.state.budget).most() <= 1e-12);
    }
    PicRun r(impact(24));
    const Totals before = r.totals();
    r.steps(150);
    CHECK(leak_along(before, r.totals(), {}, r.state.budget).most() <= 1e-12);
    CHECK(r.totals().kinetic < 0.9 * before.kinetic);
}

TEST_CASE("uniform gas about an axis stays at rest and in a uniform stream along it") {
    for (const double stream : {0.0, 0.3}) {
        for (const long per_cell : {2L, 3L}) {
            Case w = rings(8, 6, "slip", stream > 0 ? "periodic" : "slip");
            w.materials = {{"gas", 1.4, 0}, {"other", 5.0 / 3, 0}};
            // Two gases at one pressure: one is a ball on the axis.
            w.regions = {fluid("gas", 1, 1, 0, stream), fluid("gas", 1, 1, 0, stream)};
            w.regions[1].shape = "disk", w.regions[1].radius = 0.4, w.regions[1].center_z = 0.5;
            w.per_cell_x = w.per_cell_z = per_cell;
            const double c = std::sqrt(1.4);
            for (const char* density : {"cells", "particles"}) {
                // With volumes each particle knows its density, and gases may differ.
                if (w.density = density; w.density == "particles")
                    w.regions[1].gas.material = "other", w.regions[1].gas.density = 3;
                for (const char* pressure : {"explicit", "implicit"}) {
                    w.pressure = pressure, w.tolerance = 1e-14;
                    FlipRun r(w);
                    r.steps(60);
                    r.deposit();
                    const Particles& p = r.particles();
                    double most = 0;
                    for (std::size_t k = 0; k < p.x_p.size(); ++k)
                        most = worst({most, std::hypot(p.vx_p[k], p.vz_p[k] - stream)});
                    CAPTURE(stream);
                    CAPTURE(per_cell);
                    CAPTURE(std::string(density));
                    CAPTURE(std::string(pressure));
                    CHECK(most <= 1e-10 * c);
                }
            }
        }
    }
    Case w = rings(8, 6);
    w.regions = {fluid("", 1, 1)};
    PicRun r(w);
    r.steps(60);
    CHECK(speed_of(r.state.cells.vx, r.state.cells.vz) <= 1e-10);
}

TEST_CASE("a sphere without pressure flies along the axis and keeps its shape") {
    Case w = rings(16, 32, "open", "open");
    w.grid.z.length = 2;
    w.materials = {{"metal", 4, 1}};
    w.regions = {fluid("metal", 2, 0, 0, 0.5)};
    w.regions[0].shape = "disk", w.regions[0].radius = 0.4, w.regions[0].center_z = 0.6;
    FlipRun f(w);
    PicRun p(w);
    const Particles start = f.state.particles;
    for (const bool pic : {false, true}) {
        State& state = pic ? p.state : f.state;
        while (state.time < 1) pic ? p.steps(1) : f.steps(1);
        // Sorting by rows keeps the order of particles that move alike.
        const Particles& now = state.particles;
        REQUIRE(now.count() == start.count());
        double most = 0;
        for (std::size_t k = 0; k < start.x_p.size(); ++k)
            most = worst({most, std::fabs(now.x_p[k] - start.x_p[k]),
                          std::fabs(now.z_p[k] - start.z_p[k] - 0.5 * state.time)});
        CHECK(most <= 1e-12);
    }
}

TEST_CASE("a Newtonian fluid that expands evenly in space feels its viscosity at the ends alone") {
    // v = (r, z) has the same strain along r, around the axis and along z: no stress at all; and
    // v = (r, -z) a uniform one, whose force is none. Without the strain around the axis neither
    // is.
    Case w = rings(6, 5, "open", "open");
    w.regions = {fluid("", 1, 1)};
    w.viscosity = 0.3;
    FlipRun r(w);
    r.deposit();
    Nodes& g = r.nodes();
    const Grid& grid = r.grid();
    for (const double sign : {1.0, -1.0}) {
        for_each_node(grid, [&](long i, long j, long n) {
            g.vx0[n] = grid.x.at(real(i)), g.vz0[n] = sign * grid.z.at(real(j));
        });
        g.fx.setZero(), g.fz.setZero();
        add_viscous_force(grid, w.viscosity, r.scratch.mesh);
        double inside = 0, all = 0;
        for_each_node(grid, [&](long i, long j, long n) {
            const double F = std::hypot(i > 0 ? g.fx[n] : 0, g.fz[n]);
            all = worst({all, F});
            if (i < 6 && j > 0 && j < 5) inside = worst({inside, F});
        });
        CHECK(inside <= 1e-14);
        CHECK((sign > 0 ? all <= 1e-14 : all > 0.1));
    }
}

TEST_CASE("the number of threads does not change a bit of what happens about an axis") {
    std::vector<Particles> of_flip, of_pic;
    for (const int threads : {1, 2}) {
        common::set_thread_count(threads);
        FlipRun f(impact(80));
        f.steps(20);
        of_flip.push_back(f.state.particles);
        PicRun p(impact(80));
        p.steps(20);
        of_pic.push_back(p.state.particles);
    }
    common::set_thread_count(1);
    for (const auto* runs : {&of_flip, &of_pic}) {
        const Particles &a = (*runs)[0], &b = (*runs)[1];
        CHECK(a.x_p == b.x_p);
        CHECK(a.z_p == b.z_p);
        CHECK(a.e_p == b.e_p);
        CHECK(a.vx_p == b.vx_p);
    }
}
