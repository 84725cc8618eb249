// What happens at the boundaries of the mesh in flip: images and ghosts, positions wrapped around a
// periodic direction, what leaves, what enters, and what must not.
#include <doctest/doctest.h>

#include <map>

#include "tests/support/any_fluid.hpp"

namespace {

using namespace facts;

constexpr double tiny = std::numeric_limits<double>::denorm_min();

// One end of a mesh lets fluid in, the opposite one lets it out.
Case channel(Side in) {
    Case w = flip_case(8, 6, "slip", "slip");
    w.grid.x.low = -0.3, w.grid.z.low = 2;
    const Side out = static_cast<Side>(in ^ 1);
    w.boundaries[in].kind = "inflow", w.boundaries[out] = {"open", 0, 1};
    w.inflow = {"", 2, 1, 0, 0};
    const double v = in == x_low || in == z_low ? 0.9 : -0.9;
    (in == x_low || in == x_high ? w.inflow.velocity_x : w.inflow.velocity_z) = v;
    w.per_cell_x = 3, w.per_cell_z = 2;
    return w;
}

std::string message_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const common::NumericalError& error) {
        return error.what();
    }
    return "nothing";
}

// A case with one particle on it, and no other.
FlipRun alone(const Case& w, double x, double z, double vx = 0, double vz = 0) {
    Particles p;
    p.x_p = {x}, p.z_p = {z}, p.vx_p = {vx}, p.vz_p = {vz};
    p.m_p = {0.3}, p.e_p = {2}, p.material = {0};
    if (w.density == "particles") p.V_p = {0.01};
    if (w.transfer == "apic") p.Cxx_p = {0.4}, p.Cxz_p = {-0.2}, p.Czx_p = {0.6}, p.Czz_p = {0.1};
    return FlipRun(w, p);
}

}  // namespace

TEST_CASE(
    "a position wrapped around a periodic direction is always on the mesh and moved by its "
    "length") {
    Random random(1);
    for (const double low : {0.0, -0.3, 1e9, -1e-9, 7.0}) {
        for (const double length : {1.0, 0.1, 3e5, 1e-3}) {
            const common::Axis axis{7, low, length, true};
            std::vector<double> places{low,
                                       axis.high(),
                                       std::nextafter(low, -1e300),
                                       std::nextafter(axis.high(), 1e300),
                                       std::nextafter(axis.high(), -1e300),
                                       low - tiny,
                                       low + tiny,
                                       -tiny,
                                       tiny,
                                       low - 1e-17 * length,
                                       axis.high() + 1e-17 * length};
            for (int n = 0; n < 300; ++n) {
                const double distance = length * std::pow(10, random(-320, 0));
                places.push_back(low - distance), places.push_back(low + distance);
                places.push_back(axis.high() - distance), places.push_back(axis.high() + distance);
            }
            const Grid grid{axis, {1, 0, 1, true}};
            const WeightScale scale(grid);
            for (const double x : places) {
                // No step is longer than the mesh.
                if (!(x > low - length && x < axis.high() + 0.999 * length)) continue;
                const double y = wrap(axis, x);
                CAPTURE(low);
                CAPTURE(x - low);
                CHECK((y >= low && y < axis.high()));
                const double turns = (x - y) / length;
                CHECK(std::fabs(turns - std::round(turns)) <=
                      4 * eps * (1 + std::fabs(low) / length));
                CHECK(side_crossed(grid, y, 0.5) == -1);
                const Weights w = weights_at(scale, y, 0.5);
                const long i = w.node % grid.stride() - 1;
                CHECK((i >= 0 && i < 7));
                CHECK((w.S_x[0] >= 0 && w.S_x[1] >= 0));
            }
        }
    }
    const common::Axis walls{7, 0, 1, false};
    for (const double x : {-0.5, 0.0, 0.3, 1.0, 1.7}) CHECK(wrap(walls, x) == x);
}

TEST_CASE("particles at the boundaries and on mesh lines and denormally near them do no harm") {
    for (const char* ends : {"periodic", "slip", "no_slip", "open"}) {
        for (const char* transfer : {"flip", "pic", "apic", "xpic"}) {
            for (const char* pressure : {"explicit", "implicit"}) {
                Case w = flip_case(4, 4, ends, ends);
                w.transfer = transfer, w.pressure = pressure, w.dt = 0.002, w.viscosity = 0.01;
                w.gravity_z = -0.5;
                std::vector<double> places;
                for (const double at : {0.0, 0.25, 0.5, 1.0})
                    for (const double near : {0.0, tiny, 1e-310, 1e-200, 1e-160, 1e-20, 1e-16})
                        for (const double place : {at - near, at + near})
                            if (place >= 0 &&
                                (place < 1 || (!w.is(x_low, "periodic") && place <= 1)))
                                places.push_back(place);
                for (const bool crowded : {false, true}) {
                    Random random(2);
                    Particles p;
                    if (crowded) p = any_cloud(w, 0.3, 2);
                    const std::size_t others = p.x_p.size();
                    // One at a time in the void, or all together in a crowd.
                    for (std::size_t k = 0; k < places.size(); ++k) {
                        const double x = places[k],
                                     z = places[std::size_t(random(0, real(long(places.size()))))];
                        FlipRun one = alone(w, x, z, 0.2, -0.1);
                        const Particles& q = one.particles();
                        if (!crowded) {
                            const Totals before = one.totals();
                            const std::string said = message_of([&] { one.step(); });
                            CAPTURE(ends);
                            CAPTURE(transfer);
                            CAPTURE(x);
                            CAPTURE(z);
                            CHECK(said == "nothing");
                            CHECK(leak(before, one.totals(), {}, one.state.budget).most() <= 1e-14);
                            continue;
                        }
                        auto to = p.all();
                        auto from = one.particles().all();
                        for (std::size_t c = 0; c < to.size(); ++c)
                            if (!from[c]->empty()) to[c]->push_back((*from[c])[0]);
                        p.m_p.back() = 1e-3, p.material.push_back(q.material[0]);
                    }
                    if (!crowded) continue;
                    CHECK(p.x_p.size() == others + places.size());
                    FlipRun all(w, p);
                    const Totals before = all.totals();
                    CHECK(message_of([&] { all.steps(5); }) == "nothing");
                    CHECK(leak(before, all.totals(), {}, all.state.budget).most() <= 1e-12);
                }
            }
        }
    }
}

TEST_CASE("what is beyond a wall ends the run with where and when") {
    const facts::Untrapped calm;
    for (const char* kind : {"slip", "no_slip"}) {
        for (const Side end : all_sides) {
            Case w = flip_case(4, 4, kind, kind);
            w.dt = 0.25;
            double x = 0.4, z = 0.6;
            (end == x_low || end == x_high ? x : z) = end == x_low || end == z_low ? -0.125 : 1.125;
            FlipRun r = alone(w, 0.4, 0.6);
            r.particles().x_p[0] = x, r.particles().z_p[0] = z;
            const std::string said = message_of([&] {
                apply_particle_boundaries(r.problem, 1.5, 0.25, r.particles(), r.state.budget);
            });
            CAPTURE(said);
            CHECK(said.find("through the wall") != std::string::npos);
            CHECK(said.find("x = " + common::format(x)) != std::string::npos);
            CHECK(said.find("z = " + common::format(z)) != std::string::npos);
            CHECK(said.find("t = 1.75") != std::string::npos);
            CHECK(said.find("time.cfl") != std::string::npos);
        }
    }
    // Around a periodic direction there is no wall, and of a liquid that cells count there is a cure.
    for (const char* density : {"cells", "particles"}) {
        Case w = flip_case(4, 4, "periodic", "slip");
        w.pressure = "implicit", w.density = density;
        w.materials = {{"water", 7, 10}};
        FlipRun r = alone(w, 0.4, 0.6);
        r.particles().x_p[0] = 2.125;
        const std::string said = message_of([&] {
            apply_particle_boundaries(r.problem, 1.5, 0.25, r.particles(), r.state.budget);
        });
        CAPTURE(said);
        CHECK(said.find("farther than the mesh is long, to x = 2.125") != std::string::npos);
        CHECK(said.find("wall") == std::string::npos);
        CHECK((said.find("set flip.density = \"particles\"") != std::string::npos) ==
              (w.density == "cells"));
    }
    // Nor is a position that is no number on the mesh, or out through an open end.
    for (const char* kind : {"periodic", "slip", "open"}) {
        FlipRun r = alone(flip_case(4, 4, kind, kind), 0.4, 0.6);
        for (const double bad :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
            r.particles().x_p[0] = bad;
            CHECK(message_of([&] {
                      apply_particle_boundaries(r.problem, 0, 1, r.particles(), r.state.budget);
                  }) != "nothing");
        }
    }
}

TEST_CASE("no particle of a confined gas passes a wall however rough the flow") {
    for (const char* ends : {"slip", "no_slip"}) {
        Case w = flip_case(6, 5, ends, ends);
        w.density = "particles", w.confined = true, w.filling = 0;
        w.cfl = 0.95;
        for (int n = 0; n < 1000; ++n) {
            FlipRun r(w, any_cloud(w, 20, std::uint64_t(n), 1));
            r.state.dt = 1;
            CHECK(message_of([&] { r.step(); }) == "nothing");
        }
    }
}

TEST_CASE("what leaves through an open boundary is in the budget to the last bit of energy") {
    for (const char* transfer : {"flip", "apic"}) {
        for (const char* density : {"cells", "particles"}) {
            for (const Side end : all_sides) {
                Case w = flip_case(4, 4, "open", "open");
                w.transfer = transfer, w.density = density, w.dt = 0.1;
                w.materials = {{"dust", 1, 0}};
                const bool along_x = end == x_low || end == x_high;
                const double sign = end == x_low || end == z_low ? -1 : 1;
                // Beside it one that stays, so that columns must close the gap.
                FlipRun r =
                    alone(w, along_x ? 0.5 + 0.48 * sign : 0.5, along_x ? 0.5 : 0.5 + 0.48 * sign,
                          along_x ? sign : 0.0, along_x ? 0.0 : sign);
                Particles p = r.particles();
                for (std::vector<double>* c : p.all())
                    if (!c->empty()) c->push_back(c->front());
                p.material.push_back(0);
                p.x_p[1] = p.z_p[1] = 0.5 - 0.1 * sign, p.m_p[1] = 0.7;
                p.vx_p[1] = p.vz_p[1] = 0, p.e_p[1] = 5;
                FlipRun both(w, p);
                const Totals before = both.totals();
                both.step();
                CHECK(both.particles().count() == 1);
                CHECK(both.particles().m_p[0] == 0.7);
                CHECK(both.state.budget.mass == -0.3);
                CHECK(leak(before, both.totals(), {}, both.state.budget).most() <= 1e-15);
                for (std::vector<double>* c : both.particles().all())
                    CHECK((c->empty() || c->size() == 1));
                CHECK(both.particles().material.size() == 1);
            }
        }
    }
}

TEST_CASE("inflow brings the mass that its density and speed say to one column") {
    for (const Side in : all_sides) {
        for (const double dt : {0.003, 0.0471, 0.01}) {
            for (const char* density : {"cells", "particles"}) {
                Case w = channel(in);
                w.density = density, w.transfer = "apic";
                w = completed(w);
                const bool along_x = in == x_low || in == x_high, low = in == x_low || in == z_low;
                const common::Axis &across = along_x ? w.grid.x : w.grid.z,
                                   &aside = along_x ? w.grid.z : w.grid.x;
                const double step = across.spacing() / (along_x ? 3 : 2),
                             column = 2 * step * aside.length;
                const Problem problem = problem_of(w);
                Particles p;
                Budget budget;
                double t = 0;
                while (t < 0.6) {
                    apply_particle_boundaries(problem, t, dt, p, budget);
                    t += dt;
                    // All that has entered moves on with the stream before the next step.
                    CHECK(std::fabs(budget.mass - 2 * 0.9 * t * aside.length) <=
                          0.5 * column * (1 + 1e-12));
                    CHECK(p.count() == std::lround(budget.mass / column) *
                                           std::lround(real(aside.cells) * (along_x ? 2 : 3)));
                    for (std::size_t k = 0; k < p.x_p.size(); ++k) {
                        const double place = along_x ? p.x_p[k] : p.z_p[k],
                                     depth = low ? place - across.low : across.high() - place;
                        CHECK((depth >= 0 && depth <= t * 0.9));
                        // On the lattice (n + 1/2) step behind the front of the stream.
                        const double n = (t * 0.9 - depth) / step - 0.5;
                        CHECK(std::fabs(n - std::round(n)) <= 1e-10);
                        (along_x ? p.x_p : p.z_p)[k] += (low ? 1 : -1) * 0.9 * dt;
                    }
                }
                const double momentum = along_x ? budget.momentum_x : budget.momentum_z;
                CHECK(std::fabs(momentum / budget.mass - (low ? 0.9 : -0.9)) <= 1e-13);
                const double e = internal_energy(w.materials[0], 2, 1);
                CHECK(std::fabs(budget.energy / budget.mass - (0.5 * 0.81 + e)) <= 1e-13);
                double beside_low = 1e300, beside_high = -1e300;
                for (std::size_t k = 0; k < p.x_p.size(); ++k) {
                    const double beside = along_x ? p.z_p[k] : p.x_p[k];
                    beside_low = std::min(beside_low, beside);
                    beside_high = std::max(beside_high, beside);
                    const double V = step * aside.spacing() / (along_x ? 2 : 3);
                    CHECK(std::fabs(p.m_p[k] / (2 * V) - 1) <= 1e-14);
                    CHECK(std::fabs(p.e_p[k] / e - 1) <= 1e-15);
                    if (w.density == "particles") CHECK(std::fabs(p.V_p[k] / V - 1) <= 1e-14);
                    CHECK(p.Cxx_p[k] == 0);
                }
                const double width = aside.spacing() / (along_x ? 2 : 3);
                CHECK(std::fabs(beside_low - aside.low - 0.5 * width) <= 1e-15 * 10);
                CHECK(std::fabs(aside.high() - beside_high - 0.5 * width) <= 1e-15 * 10);
            }
        }
    }
}

TEST_CASE("a uniform stream through a channel stays uniform whatever side it comes from") {
    for (const Side in : all_sides) {
        for (const char* pressure : {"explicit", "implicit"}) {
            for (const char* density : {"cells", "particles"}) {
                Case w = channel(in);
                w.pressure = pressure, w.density = density, w.tolerance = 1e-13;
                w.regions = {fluid("", 2, 1, w.inflow.velocity_x, w.inflow.velocity_z)};
                // A column enters and one leaves in every step.
                const bool along_x = in == x_low || in == x_high;
                w.dt = (along_x ? w.grid.x.spacing() / 3 : w.grid.z.spacing() / 2) / 0.9;
                CAPTURE(pressure);
                CAPTURE(density);
                FlipRun r(w);
                const long count = r.particles().count();
                r.steps(40);
                CHECK(r.particles().count() == count);
                double most = 0;
                for (std::size_t k = 0; k < r.particles().x_p.size(); ++k)
                    most = worst({most, std::fabs(r.particles().vx_p[k] - w.inflow.velocity_x),
                                  std::fabs(r.particles().vz_p[k] - w.inflow.velocity_z),
                                  std::fabs(r.particles().e_p[k] - 1.25)});
                CHECK(most <= 1e-10);
                CHECK(std::fabs(r.state.budget.mass) <= 1e-12);
            }
        }
    }
}

TEST_CASE("fluid enters a mesh that was empty and all of it is in the budget") {
    for (const Side in : all_sides) {
        for (const char* transfer : {"flip", "pic", "blend", "apic", "xpic"}) {
            for (const char* density : {"cells", "particles"}) {
                Case w = channel(in);
                w.transfer = transfer, w.density = density;
                w.boundaries[in ^ 1].pressure = 0;
                w.dt = 0.01;
                FlipRun r(w, Particles{});
                // An empty run has no columns to say which are in use.
                r.steps(30);
                CAPTURE(transfer);
                CAPTURE(density);
                const Totals t = r.totals();
                CHECK(t.mass > 0.3);
                CHECK(std::fabs(t.mass - r.state.budget.mass) <= 1e-14);
                CHECK(std::fabs(t.momentum_x - r.state.budget.momentum_x) <= 1e-13);
                CHECK(std::fabs(t.momentum_z - r.state.budget.momentum_z) <= 1e-13);
                CHECK(std::fabs(t.kinetic + t.internal - r.state.budget.energy) <= 1e-13);
            }
        }
    }
}

TEST_CASE("images and ghosts are filled and folded as transposes") {
    for (const char* ends_x : {"periodic", "slip"}) {
        for (const char* ends_z : {"periodic", "slip"}) {
            for (const long rows : {1L, 2L, 5L}) {
                const Grid grid =
                    completed(flip_case(rows == 2 ? 2 : 6, rows, ends_x, ends_z)).grid;
                Random random(3);
                // Cells: sum of a folded times b = sum of a times b filled, ghosts and all.
                for (const long width : {1L, 3L}) {
                    const long size = width * grid.size();
                    Field a = Field::Zero(size), b = Field::Zero(size);
                    const auto ghosts_too = [&](const auto& visit) {
                        for (long j = -1; j <= grid.z.cells; ++j)
                            for (long i = -1; i <= grid.x.cells; ++i)
                                for (long k = 0; k < width; ++k)
                                    visit(width * grid.index(i, j) + k,
                                          i >= 0 && j >= 0 && i < grid.x.cells && j < grid.z.cells);
                    };
                    ghosts_too([&](long n, bool inside) {
                        a[n] = random(-1, 1);
                        if (inside) b[n] = random(-1, 1);
                    });
                    Field folded = a;
                    fold_cells(grid, folded.data(), width);
                    fill_cells(grid, b.data(), width);
                    double with_a = 0, with_folded = 0;
                    ghosts_too([&](long n, bool inside) {
                        with_a += a[n] * b[n];
                        if (inside) with_folded += folded[n] * b[n];
                    });
                    CHECK(std::fabs(with_a - with_folded) <= 1e-13);
                }
                Field a = Field::Zero(grid.size());
                double before = 0, after = 0;
                for_each_node(grid,
                              [&](long, long, long n) { a[n] = random(-1, 1), before += a[n]; });
                fold_nodes(grid, a.data());
                for_own_nodes(grid, [&](long, long, long n) { after += a[n]; });
                CHECK(std::fabs(before - after) <= 1e-13);
                if (grid.x.periodic)
                    for (long j = 0; j <= grid.z.cells; ++j)
                        for (const long i : {-1L, 0L, 1L})
                            CHECK(a[grid.index(i, j)] == a[grid.index(i + grid.x.cells, j)]);
                if (grid.z.periodic)
                    for (long i = 0; i <= grid.x.cells; ++i)
                        for (const long j : {-1L, 0L, 1L})
                            CHECK(a[grid.index(i, j)] == a[grid.index(i, j + grid.z.cells)]);
            }
        }
    }
}

TEST_CASE("walls hold what they are to hold and nothing else") {
    Case w = flip_case(5, 4, "slip", "no_slip");
    w.boundaries[x_high] = {"open", 0, 0.3};
    w.boundaries[z_high].slide = 0.7;
    w = completed(w);
    Field vx = Field::Constant(w.grid.size(), 2), vz = Field::Constant(w.grid.size(), 3);
    set_walls(w.grid, problem_of(w).boundaries, vx, vz);
    for (long j = 0; j <= 4; ++j) {
        for (long i = 0; i <= 5; ++i) {
            const long n = w.grid.index(i, j);
            // In a corner the slip wall has the first word on what is normal to it.
            const double x = i == 0 ? 0 : j == 0 ? 0 : j == 4 ? 0.7 : 2, z = j % 4 == 0 ? 0 : 3;
            CHECK(vx[n] == x);
            CHECK(vz[n] == z);
        }
    }
}

TEST_CASE("particles that have come into the next row are put on the mesh as if they were sorted") {
    Case w = flip_case(6, 13, "slip", "slip");
    w.materials = {{"a", 1.4, 0}, {"b", 1.6, 0}};
    w.mass = "consistent";
    FlipRun r(w, any_cloud(w, 0.5, 4));
    Particles& p = r.state.particles;
    const auto shift = [&](double rows) {
        for (std::size_t k = 0; k < p.z_p.size(); ++k) {
            const double dz = rows * (k % 2 == 0 ? 1 : -1) * w.grid.z.spacing();
            p.z_p[k] = std::clamp(p.z_p[k] + dz, w.grid.z.low, w.grid.z.high());
        }
    };
    const int before = common::thread_count();
    shift(0.9);
    CHECK(near_their_rows(w.grid, p));
    CHECK(!keep_in_rows(w.grid, r.scratch.sort, p));
    std::vector<Field> m, M, coupled;
    const auto put = [&] {
        r.deposit();
        assemble_mass_matrix(w.grid, p, r.scratch.mass_matrix);
        m.push_back(r.nodes().m), M.push_back(r.cells().M);
        coupled.push_back(r.scratch.mass_matrix.entry[3]);
    };
    for (const int threads : {1, 2, 3}) {
        common::set_thread_count(threads);
        put();
        CHECK(m.back() == m[0]);
        CHECK(M.back() == M[0]);
        CHECK(coupled.back() == coupled[0]);
    }
    common::set_thread_count(before);
    r.sort();
    put();
    CHECK((m.back() - m[0]).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
          1e-13 * m[0].maxCoeff<Eigen::PropagateNaN>());
    CHECK((M.back() - M[0]).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
          1e-13 * M[0].maxCoeff<Eigen::PropagateNaN>());
    CHECK((coupled.back() - coupled[0]).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
          1e-13 * coupled[0].maxCoeff<Eigen::PropagateNaN>());

    // Two rows on they are sorted, and where some have gone.
    shift(1.8);
    CHECK(!near_their_rows(w.grid, p));
    CHECK(keep_in_rows(w.grid, r.scratch.sort, p));
    CHECK(near_their_rows(w.grid, p));
    remove_if(p, [](long k) { return k == 3; });
    p.x_p.push_back(p.x_p[0]);
    for (std::vector<double>* column : p.all())
        if (has(*column) && column->size() < p.x_p.size()) column->push_back((*column)[0]);
    p.material.push_back(0);
    CHECK(!near_their_rows(w.grid, p));
}

TEST_CASE("sorting keeps every particle whole and finds its row") {
    Case w = flip_case(6, 5, "slip", "slip");
    w.density = "particles", w.transfer = "apic";
    w.materials = {{"a", 1.4, 0}, {"b", 1.6, 0}, {"c", 1.2, 0}};
    Particles p = any_cloud(w, 0.5, 4);
    for (std::size_t k = 0; k < p.m_p.size(); ++k) p.L_p.push_back(real(k));
    const FlipRun r(w, p);
    const Particles& q = r.state.particles;
    CHECK(q.first_of_row.size() == 6);
    CHECK(q.first_of_row.back() == q.count());
    std::map<double, std::size_t> by_mass;
    for (std::size_t k = 0; k < p.m_p.size(); ++k) by_mass[p.m_p[k]] = k;
    Particles a = p, b = q;
    const auto in_a = a.all(), in_b = b.all();
    for (std::size_t row = 0; row < 5; ++row) {
        for (auto k = std::size_t(q.first_of_row[row]); k < std::size_t(q.first_of_row[row + 1]);
             ++k) {
            CHECK(cell_along(w.grid.z, q.z_p[k]) == long(row));
            const std::size_t was = by_mass.at(q.m_p[k]);
            for (std::size_t c = 0; c < in_a.size(); ++c) CHECK((*in_a[c])[was] == (*in_b[c])[k]);
            CHECK(p.material[was] == q.material[k]);
        }
    }
}
