// Facts about a current sheet with a field across it, between walls on all sides: an exact
// equilibrium, walls up to which a plasma goes on and through which flux may pass, and what stays
// where it is.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "implicit_moment/output/diagnostics.hpp"
#include "implicit_moment/setup/initial_state.hpp"
#include "implicit_moment/step.hpp"
#include "implicit_moment/theory/compare_tail.hpp"
#include "tests/support/any_particles.hpp"
#include "tests/support/any_summary.hpp"

namespace {

using namespace facts;

// -(lap A + exp(2 A)) of A(x, z), lengths in L, by differences of fourth order.
template <class Potential>
double ampere_residual(const Potential& A, double x, double z) {
    const double h = 0.01;
    const auto second = [&](double a, double b) {
        return (-A(x + 2 * a, z + 2 * b) + 16 * A(x + a, z + b) - 30 * A(x, z) +
                16 * A(x - a, z - b) - A(x - 2 * a, z - 2 * b)) /
               (12 * h * h);
    };
    return std::fabs(second(h, 0) + second(0, h) + std::exp(2 * A(x, z)));
}

Case tail_case(long cells) {
    Case w;
    w.grid.x = {cells, -12.8, 25.6, false, true}, w.grid.z.cells = cells;
    w.harris.thickness = 1, w.harris.normal_field = 0.04, w.harris.background = 0.1;
    w.harris.perturbation = 0, w.harris.particles = 20000;
    return w;
}

// A lattice of particles up to the walls that moves along y.
Particles lattice(const Grid& grid) {
    Particles s = no_particles();
    const long side = 8;
    for (long j = 0; j < side * grid.z.cells; ++j)
        for (long i = 0; i < side * grid.x.cells; ++i)
            add(s, grid.x.at((double(i) + 0.5) / double(side)),
                grid.z.at((double(j) + 0.5) / double(side)), {0, 0.3, 0});
    sort(grid, s);
    return s;
}

}  // namespace

TEST_CASE("the tail obeys the law of Ampere that the slowly varying sheet misses by epsilon^2") {
    std::vector<double> missed;
    for (const double epsilon : {0.1, 0.05, 0.025}) {
        const TailSheet tail{1, epsilon};
        const auto slow = [&](double x, double z) {
            return epsilon * x - std::log(std::cosh(tail.F(x) * z));
        };
        double most = 0, slow_most = 0;
        for (double x = -0.5 / epsilon; x <= 0.5 / epsilon; x += 0.1 / epsilon)
            for (double z = 0; z <= 4; z += 0.25) {
                const auto A = [&](double at_x, double at_z) { return tail.A_y(at_x, at_z); };
                most = worst({most, ampere_residual(A, x, z)});
                slow_most = worst({slow_most, ampere_residual(slow, x, z)});
                CHECK(std::fabs(std::exp(2 * A(x, z)) / tail.density(x, z) - 1) <= 1e-12);
            }
        CHECK(most <= 1e-7);
        missed.push_back(slow_most / (epsilon * epsilon));
    }
    CHECK(missed[2] >= 0.5);
    CHECK(std::fabs(missed[0] / missed[1] - 1) <= 0.05);
    CHECK(std::fabs(missed[1] / missed[2] - 1) <= 0.05);
}

TEST_CASE("the tail on a mesh has no divergence and the current of its drifts to second order") {
    std::vector<double> errors;
    for (const long cells : {32, 64, 128}) {
        const Case w = tail_case(cells);
        const Grid& grid = w.grid;
        const HarrisSheet sheet = harris_sheet(w.harris);
        FieldState field(grid);
        harris_field(w, field);
        Field div = Field::Zero(grid.size());
        divergence_of_magnetic(grid, field.B.all.data(), div);
        CHECK(largest(grid, on_faces, div) <= 16 * eps * sheet.B0 / grid.z.spacing());
        for (long i = 0; i < grid.x.cells; ++i)
            CHECK(std::fabs(field.B.z()[grid.index(i, grid.z.cells / 2)] / sheet.B0 - 0.04) <=
                  1e-12);
        VectorField curl(grid);
        curl_of_magnetic(grid, field.B.all.data(), curl.all.data());
        double most = 0;
        for (long j = 1; j < grid.z.cells; ++j)
            for (long i = 1; i < grid.x.cells; ++i) {
                const double n = n0 *
                                 tail_of(w.harris).density(grid.x.at(real(i)), grid.z.at(real(j))),
                             J = 4 * pi / c * n * (sheet.u_i - sheet.u_e);
                most = worst({most, std::fabs(curl.y()[grid.index(i, j)] - J)});
            }
        errors.push_back(most / sheet.B0);
    }
    // dz^2/12 of the fourth derivative, 2 B0 F^4/L^3 at the dense end, where F^4 = 7.8.
    CHECK(errors[2] <= 0.01 / 12 * 2 * 7.8);
    CHECK(std::fabs(errors[1] / errors[2] - 4) <= 0.5);
}

TEST_CASE("what crosses a wall goes on behind it without divergence also where particles feel it") {
    const Case w = tail_case(32);
    const Grid& grid = w.grid;
    FieldState field(grid);
    harris_field(w, field);
    CHECK(std::fabs(field.B.x()[grid.index(0, 24)]) > 0.1 * harris_sheet(w.harris).B0);
    CHECK(std::fabs(field.B.z()[grid.index(3, 0)]) > 0.01 * harris_sheet(w.harris).B0);
    const InterleavedField push = pack(grid, field.E, field.B);
    const double dx = grid.x.spacing(), dz = grid.z.spacing(), h = 0.05;
    Random random;
    for (int sample = 0; sample < 300; ++sample) {
        // At all four walls and in the corners.
        const long i = sample % 3 == 0   ? 0
                       : sample % 3 == 1 ? grid.x.cells
                                         : 7,
                   j = sample % 2 == 0 ? 0 : grid.z.cells;
        const double d_x = (i == 0   ? 0.25
                            : i == 7 ? 0
                                     : -0.25) +
                           0.15 * random(),
                     d_z = (j == 0 ? 0.25 : -0.25) + 0.15 * random();
        const double slope_x = (gathered(grid, push, i, j, d_x + h, d_z).B_x -
                                gathered(grid, push, i, j, d_x - h, d_z).B_x) /
                               (2 * h * dx),
                     slope_z = (gathered(grid, push, i, j, d_x, d_z + h).B_z -
                                gathered(grid, push, i, j, d_x, d_z - h).B_z) /
                               (2 * h * dz);
        CHECK(std::fabs(slope_x + slope_z) <= 1e-13);
    }
}

TEST_CASE("particles of the tail are where its density says") {
    const Case w = tail_case(64);
    const TailSheet tail = tail_of(w.harris);
    const TailPlaces places(tail, w.grid);
    // The integral of the density from the middle row to z, in pieces.
    const auto up_to = [&](double x, double z) {
        double sum = 0;
        const int pieces = 4000;
        for (int k = 0; k < pieces; ++k)
            sum += tail.density(x, (k + 0.5) * z / pieces) * z / pieces;
        return sum;
    };
    // A thirtieth of the noise of 1e5 particles is enough.
    for (const double u_x : {0.0, 0.001, 0.3, 0.77, 0.9999})
        for (const double u_z : {0.0, 0.02, 0.5, 0.6, 0.97, 1.0}) {
            const auto at = places.place(u_x, u_z);
            CHECK(std::fabs(at[0]) <= 0.5 * w.grid.x.length * (1 + 1e-15));
            CHECK(std::fabs(at[1]) <= 0.5 * w.grid.z.length * (1 + 1e-15));
            CHECK(std::fabs(up_to(at[0], at[1]) / up_to(at[0], 6.4) - (2 * u_z - 1)) <= 1e-4);
        }
    double left = 0, all = 0;
    const auto third = places.place(1.0 / 3, 0.5);
    for (int k = 0; k < 400; ++k) {
        const double dx = w.grid.x.length / 400, x = -0.5 * w.grid.x.length + (k + 0.5) * dx;
        const double column = 2 * dx * up_to(x, 6.4);
        all += column;
        left += column * std::clamp((third[0] - x) / dx + 0.5, 0.0, 1.0);
    }
    CHECK(std::fabs(places.content() / all - 1) <= 1e-4);
    CHECK(std::fabs(left / all - 1.0 / 3) <= 1e-4);
    // As much of the density is to the left as was asked for, also within a 4096th of the box.
    const double half_x = 0.5 * w.grid.x.length, half_z = 0.5 * w.grid.z.length;
    const auto column = [&](double x) {
        return 2 * tail.content(x, std::tanh(tail.height(x, half_z)));
    };
    const double content = integral(column, -half_x, half_x, 200);
    CHECK(std::fabs(places.content() / content - 1) <= 1e-8);
    for (const double u_x : {0.00005, 0.001, 0.1234, 0.3, 0.5, 0.77, 0.9999}) {
        const double x = places.place(u_x, 0.5)[0];
        CHECK(std::fabs(integral(column, -half_x, x, 200) / content - u_x) <= 1e-7);
    }
}

TEST_CASE(
    "a current goes on up to walls that mirror the plasma and not to those with image charges") {
    for (const bool mirrors : {true, false}) {
        const Grid grid{{12, -2, 4, false, mirrors}, {10, 0.5, 2.1, false, true}};
        const Particles s = lattice(grid);
        const double J = s.q_p * real(s.count()) / (grid.x.length * grid.z.length) * 0.3;
        for (const long passes : {0L, 4L}) {
            MassMatrix mass(grid);
            Moments moments(grid);
            Field scratch;
            const SmoothingSettings smoothing{passes, true};
            deposit_mass_matrix({s}, grid, VectorField(grid), {}, 0, mass);
            smooth(grid, felt(grid), smoothing, mass.J_hat.all.data(), scratch);
            deposit_moments(s, grid, VectorField(grid), 0, moments);
            smooth(grid, on_nodes, felt_charge(grid), smoothing, moments.J_y.data(), scratch);
            const long beside = grid.index(1, 5);
            for (const double* J_y : {mass.J_hat.y(), moments.J_y.data()}) {
                const double part = J_y[beside] / J;
                // A 48th of S2 lies more than a cell to one side; smoothing takes the rest.
                if (mirrors)
                    CHECK(std::fabs(part - 1) <= 1e-12);
                else
                    CHECK(std::fabs(part - (passes == 0 ? 1 - 2 / 48.0 : 0.6436)) <= 0.003);
            }
        }
    }
}

TEST_CASE("flux through walls is frozen and the middle row keeps its flux to round-off") {
    for (const char* response : {"moments", "mass_matrix"}) {
        Case w = tail_case(32);
        w.field.response = response;
        const Grid& grid = w.grid;
        State state = initial_state(w);
        const VectorField start = state.field.B;
        StepScratch scratch(grid, w.field, 2);
        const auto flux = [&](const VectorField& B) {
            return interior(grid, B.z()).col(grid.z.cells / 2).sum() * grid.x.spacing();
        };
        Field div = Field::Zero(grid.size());
        for (int step = 0; step < 5; ++step) {
            find_moments(grid, 0.3, state.plasma.species, state.field, scratch);
            take_step(grid, 0.3, w.mover, state.plasma.charge_over_mass(), scratch,
                      state.plasma.species, state.field);
            CHECK(std::fabs(flux(state.field.B) - flux(start)) <= 1e-14);
            for (long j = 0; j < grid.z.cells; ++j)
                for (const long i : {0L, grid.x.cells})
                    CHECK(state.field.B.x()[grid.index(i, j)] == start.x()[grid.index(i, j)]);
            for (long i = 0; i < grid.x.cells; ++i)
                for (const long j : {0L, grid.z.cells})
                    CHECK(state.field.B.z()[grid.index(i, j)] == start.z()[grid.index(i, j)]);
            divergence_of_magnetic(grid, state.field.B.all.data(), div);
            CHECK(largest(grid, on_faces, div) <= 1e-15);
        }
        CHECK(largest(state.field.B.all - start.all) >= 1e-5);
    }
}

TEST_CASE("closed flux is the largest fall of A_y along the middle row") {
    const Case w = tail_case(32);
    const Grid& grid = w.grid;
    VectorField B(grid);
    double* row = B.z() + grid.index(0, grid.z.cells / 2);
    std::fill_n(row, grid.x.cells, 0.5);
    CHECK(tail_row(grid, B, 0.5).flux <= 0);
    CHECK(tail_row(grid, B, 0.5).shift <= 1e-14);
    row[10] = -2, row[11] = 0.5, row[12] = -1;  // falls of 2 and 1, and 0.5 between them
    const TailRow closed = tail_row(grid, B, 0.5);
    CHECK(std::fabs(closed.flux - 2.5 * grid.x.spacing()) <= 1e-14);
    CHECK(std::fabs(closed.X_line - grid.x.at(13)) <= 1e-13);
}

TEST_CASE("thermal noise moves the flux of a tail by less than its bound for 99 of 100 seeds") {
    const Case w = tail_case(32);
    const Grid& grid = w.grid;
    const double weight = 1e-4, B0 = harris_sheet(w.harris).B0,
                 T = harris_sheet(w.harris).T_i + harris_sheet(w.harris).T_e;
    const ThermalFlux noise = thermal_flux(w, weight);
    long above = 0;
    double squares = 0;
    const int seeds = 4000;
    VectorField B(grid);
    double* B_z = B.z() + grid.index(0, grid.z.cells / 2);
    std::vector<double> A_y(std::size_t(grid.x.cells + 1));
    for (int seed = 0; seed < seeds; ++seed) {
        std::fill(A_y.begin(), A_y.end(), 0.0);
        for (long k = 1; k < grid.x.cells; ++k) {
            // T w/2 in each wave sin(k x) sin(l z).
            double a = 0;
            for (long l = 1; l < grid.z.cells; l += 2)
                a += common::gaussian(std::uint64_t(seed), 7, std::uint64_t(k), std::uint32_t(l)) /
                     std::hypot(real(k) / grid.x.length, real(l) / grid.z.length) / pi;
            a *= std::sqrt(16 * pi * T * weight / (grid.x.length * grid.z.length));
            for (long i = 0; i <= grid.x.cells; ++i)
                A_y[std::size_t(i)] += a * std::sin(pi * real(k * i) / real(grid.x.cells));
        }
        for (long i = 0; i < grid.x.cells; ++i)
            B_z[i] = (A_y[std::size_t(i + 1)] - A_y[std::size_t(i)]) / grid.x.spacing();
        const double shift = tail_row(grid, B, 0).shift / B0;
        squares += shift * shift / seeds;
        above += shift > noise.most;
    }
    CHECK(std::fabs(std::sqrt(squares) / noise.rms - 1) <= 0.03);
    CHECK(above >= seeds / 250);
    CHECK(above <= seeds / 60);
}

TEST_CASE("a tail at rest stays and does not where images of charge hide the current of its ends" *
          doctest::description("physics")) {
    const std::string tail = "implicit_moment/cases/lembege_pellat.toml output.fields_interval=0";
    const auto run = [&](const std::string& name, const std::string& arguments) {
        return run_into(name, "implicit_moment", tail + arguments).summary;
    };
    check_results(run("tail", ""), 6);
    const auto mass = run("tail_mass", " field.response=mass_matrix time.end=100");
    check_results(mass, 8);
    CHECK(std::fabs(value(mass, "energy_drift")) <= 1e-9);
    const auto walls = run("tail_walls", " grid.boundary_x=wall");
    CHECK(value(walls, "flux_shift") >= 0.02);
    CHECK(value(walls, "flux_reconnected") >= 0.04);
}
