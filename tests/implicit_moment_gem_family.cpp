// Facts about what the GEM challenge and its relatives add to implicit_moment: the profiles at unit
// flux, and a guide field.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "implicit_moment/output/diagnostics.hpp"
#include "implicit_moment/output/unit_flux_profile.hpp"
#include "implicit_moment/theory/compare_reconnection.hpp"
#include "tests/support/any_fields.hpp"
#include "tests/support/any_run.hpp"
#include "tests/support/any_summary.hpp"

namespace {

using namespace facts;

const Grid small{{12, -6, 12, true}, {8, -2, 4, false}};

// Ions of density one to three and electrons to match, with any current.
std::vector<Moments> any_moments(Random& random) {
    std::vector<Moments> moments(2, Moments(small));
    const double sign[] = {1, -1};
    for (std::size_t k = 0; k < 2; ++k) {
        const Field rho = random.field(small, on_nodes, {1, 1});
        moments[k].rho = sign[k] * (rho.array() + 2).matrix();
        moments[k].J_x = random.field(small, on_x_edges, {-1, 1});
    }
    return moments;
}

// A short run of a sheet whose flux from the start is 0.8 or 1.2.
const std::string sheet =
    " implicit_moment/cases/gem.toml harris.particles=4000 grid.cells_x=16 grid.cells_z=16 ";
int run(const std::string& arguments, const std::string& out) {
    return facts::run("implicit_moment", arguments, out);
}
const std::string below = sheet + "harris.perturbation=0.4 ",
                  above = sheet + "harris.perturbation=0.6 ";

// The rows of a table of numbers.
std::vector<std::vector<double>> table(const std::string& path) {
    std::ifstream file(path);
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::vector<double> row;
        for (double number; words >> number;) row.push_back(number);
        if (!row.empty()) rows.push_back(row);
    }
    return rows;
}

Case with_guide_field(double guide_field) {
    Case parameters;
    parameters.harris.guide_field = guide_field;
    parameters.harris.particles = 2000;
    return parameters;
}

}  // namespace

TEST_CASE("a profile averages from the first step of unit flux over its time and nothing else") {
    const facts::Untrapped calm;
    Random random;
    UnitFluxProfile profile;
    int taken = 0;
    std::array<Eigen::ArrayXd, 4> sum;
    for (Eigen::ArrayXd& s : sum) s.setZero(12);
    std::vector<double> first_B_z;
    // Time, flux, and whether the step belongs to the average. Flux may fall again.
    struct Step {
        double time, flux;
        bool counted;
    };
    const double nan = std::nan("");
    for (const Step& step : {Step{0, 0.2, false},
                             {7.0, 0.99999, false},
                             {7.2, nan, false},
                             {7.5, 1.0, true},
                             {7.7, 0.9, true},
                             {7.9, 1.2, true},
                             {8.1, 1.4, true},
                             {8.2, 1.5, false},
                             {20.0, 1.0, false}}) {
        const VectorField B = random.field(small, magnetic);
        const std::vector<Moments> moments = any_moments(random);
        const int before = taken;
        record_profile(profile, step.time, step.flux, small, B, [&] { return ++taken, moments; });
        CHECK(taken - before == (step.counted ? 1 : 0));
        if (!step.counted) continue;
        for (long i = 0; i < 12; ++i) {
            const long n = small.index(i, 4), next = small.index((i + 1) % 12, 4);
            for (std::size_t k = 0; k < 2; ++k) {
                sum[2 * k][i] += 0.5 * (moments[k].rho[n] + moments[k].rho[next]);
                sum[2 * k + 1][i] += moments[k].J_x[n];
            }
            if (first_B_z.size() < 12) first_B_z.push_back(B.z()[n]);
        }
    }
    CHECK(profile.steps == 4);
    CHECK(profile.begin == 7.5);
    CHECK(profile.end == 8.1);
    CHECK(profile.B_z == first_B_z);

    const double B0 = 0.05;
    const ProfileColumns columns = profile_columns(profile, small, B0);
    const long X_point = std::lround(columns.X_line + 6);
    double off = 0;
    for (long k = 0; k < 12; ++k) {
        const auto row = std::size_t(k);
        const long i = (k + 6 + X_point) % 12;
        off = worst({off, std::fabs(columns.x[row] - (double(k) - 5.5)),
                     std::fabs(columns.rho_ions[row] - sum[0][i] / 4 * 4 * pi),
                     std::fabs(columns.v_x_ions[row] - sum[1][i] / sum[0][i] / B0),
                     std::fabs(columns.v_x_electrons[row] - sum[3][i] / sum[2][i] / B0),
                     std::fabs(columns.B_z[row] - first_B_z[std::size_t(i)] / B0)});
    }
    CHECK(off <= 64 * eps / B0);
}

TEST_CASE("a profile is centered on the X-line and its B_z integrates to the flux on either side") {
    Case parameters;
    parameters.harris.perturbation = 0.5, parameters.harris.light_over_alfven = 40;
    const double B0 = 1 / 40.0;
    const Grid& grid = parameters.grid;
    FieldState field(grid);
    harris_field(parameters, field);
    // The same sheet moved by nine cells along x.
    VectorField moved(grid);
    for (long j = 0; j <= grid.z.cells; ++j) {
        for (long i = 0; i < grid.x.cells; ++i)
            moved.z()[grid.index((i + 9) % grid.x.cells, j)] = field.B.z()[grid.index(i, j)];
    }
    std::vector<Moments> moments(2, Moments(grid));
    for (std::size_t k = 0; k < 2; ++k) {
        moments[k].rho.setConstant((k == 0 ? 1 : -1) * 0.3 * n0);
        moments[k].J_x.setConstant((k == 0 ? 1 : -1) * 0.3 * n0 * (k == 0 ? 0.7 : -2.5) * B0);
    }
    UnitFluxProfile profile;
    record_profile(profile, 0, 1, grid, moved, [&] { return moments; });
    const ProfileColumns columns = profile_columns(profile, grid, B0);
    CHECK(std::fabs(columns.X_line - 9 * grid.x.spacing()) <= 16 * eps);
    CHECK(std::fabs(columns.flux - 1) <= 64 * eps);
    double left = 0, right = 0, odd = 0, off = 0;
    for (std::size_t k = 0; k < 64; ++k) {
        odd = worst({odd, std::fabs(columns.B_z[k] + columns.B_z[63 - k]),
                     std::fabs(columns.x[k] + columns.x[63 - k])});
        (columns.x[k] < 0 ? left : right) += columns.B_z[k] * grid.x.spacing();
        off =
            worst({off, std::fabs(columns.rho_ions[k] - 0.3), std::fabs(columns.v_x_ions[k] - 0.7),
                   std::fabs(columns.v_x_electrons[k] + 2.5)});
    }
    CHECK(odd <= 64 * eps);
    CHECK(std::fabs(left + 1) <= 64 * eps);
    CHECK(std::fabs(right - 1) <= 64 * eps);
    CHECK(off <= 16 * eps);
}

TEST_CASE("a second island is one whose field turns back beside the X-line") {
    const Grid grid = Case().grid;
    ProfileColumns columns;
    for (double x = -0.5 * grid.x.length; x <= 0.5 * grid.x.length; x += 0.1) {
        columns.x.push_back(x);
        columns.B_z.push_back(std::copysign(0.1, x));
    }
    CHECK(field_of_second_island(columns, grid) == 0);
    for (std::size_t k = 0; k < columns.x.size(); ++k)
        if (columns.x[k] > -0.24 * grid.x.length && columns.x[k] < -0.2 * grid.x.length)
            columns.B_z[k] = 0.18;
    CHECK(field_of_second_island(columns, grid) == 0.18);
}

TEST_CASE("a run without unit flux writes no profile" * doctest::description("robust")) {
    const std::string out = folder("no_profile");
    REQUIRE(run(below + "time.end=3", out) == 0);
    CHECK(fs::exists(out + "/history.dat"));
    CHECK(!fs::exists(out + "/profile.dat"));
}

TEST_CASE("a profile is the mean of the snapshots of its time" * doctest::description("robust")) {
    // 0.6/Omega_ci are 40 steps; the run goes on for 10 more.
    const std::string out = folder("snapshots");
    REQUIRE(run(above + "output.fields_interval=0.3 time.end=15", out) == 0);
    // The density on the row z = 0; the mean over x does not care for the place of the X-line.
    const int column_of_ions = 13;
    double mean = 0;
    for (long step = 0; step <= 40; ++step) {
        const std::string path = out + "/" + common::numbered("fields", step, "dat");
        if (step == 0) {
            std::istringstream names(read_all(path));
            std::string name;
            for (int k = 0; k < column_of_ions; ++k) names >> name;
            REQUIRE(name == "rho_ions");
        }
        const auto nodes = table(path);
        REQUIRE(nodes.size() == 17 * 17);
        for (std::size_t i = 0; i < 16; ++i)
            mean += nodes[8 * 17 + i][column_of_ions - 1] / (16 * 41.0);
    }
    const auto profile = table(out + "/profile.dat");
    REQUIRE(profile.size() == 16);
    double measured = 0;
    for (const auto& row : profile) measured += row[2] / 16;
    CHECK(std::fabs(measured - mean) <= 1e-12);
}

TEST_CASE("a restart within the averaging time ends with the same profile" *
          doctest::description("robust")) {
    const std::string whole = room() + "/whole", rest = room() + "/rest";
    // From step 40 of 50, where the average has 41; and from step 30 of 40.
    check_restart("implicit_moment", above + "time.end=15 output.checkpoint_steps=20");
    check_restart("implicit_moment", above + "time.end=12 output.checkpoint_steps=15");
    CHECK(table(rest + "/profile.dat").size() == 16);
    CHECK(read_all(rest + "/profile.dat") == read_all(whole + "/profile.dat"));
}

TEST_CASE("a guide field is uniform and leaves the plane and the particles alone") {
    const Case without = with_guide_field(0), with = with_guide_field(-0.7);
    const Grid& grid = with.grid;
    const State plain = initial_state(without), state = initial_state(with);
    const double B0 = harris_sheet(with.harris).B0;
    const VectorField &B = state.field.B, &plain_B = plain.field.B;
    double off = 0;
    for (long n = 0; n < grid.size(); ++n) {
        off = worst({off, std::fabs(B.y()[n] + 0.7 * B0), std::fabs(plain_B.y()[n]),
                     std::fabs(B.x()[n] - plain_B.x()[n]), std::fabs(B.z()[n] - plain_B.z()[n])});
    }
    CHECK(off <= eps * B0);
    CHECK(state.field.E.all == plain.field.E.all);
    Field scratch;
    CHECK(largest_divergence(grid, B, scratch) <= 4 * eps * B0 / grid.z.spacing());
    for (std::size_t k = 0; k < 2; ++k) {
        const Particles &p = state.plasma.species[k], &q = plain.plasma.species[k];
        CHECK(p.x_p == q.x_p);
        CHECK(p.z_p == q.z_p);
        CHECK(p.ux_p == q.ux_p);
        CHECK(p.uy_p == q.uy_p);
        CHECK(p.uz_p == q.uz_p);
    }
    // The field has no part in the flux, nor in the quadrupole.
    CHECK(middle_row(grid, B).flux == middle_row(grid, plain_B).flux);
    CHECK(std::fabs(quadrupole(grid, B, 32)) <= 16 * eps * B0);
}

TEST_CASE("a sheet with a guide field is in equilibrium" * doctest::description("physics")) {
    const std::string rest =
        " implicit_moment/cases/harris_equilibrium.toml time.end=40 harris.particles=1e5";
    for (const char* guide : {"0", "1", "-1"}) {
        const std::string out = folder("equilibrium");
        REQUIRE(run(rest + " harris.guide_field=" + guide, out) == 0);
        const Run finished = finished_run(out);
        CAPTURE(guide);
        check_results(finished.summary, 3);
        // The energy of the guide field must not hide a drift: in units of the magnetic energy of
        // the sheet, B0^2/8 pi times L_x (L_z - 2 lambda).
        const std::vector<double>& energy = finished.column("energy");
        const double of_sheet = 0.5 * 0.05 * 0.05 * 25.6 * 11.8;
        CHECK(std::fabs(energy.back() - energy.front()) <= 0.005 * of_sheet);
    }
}

TEST_CASE("a guide field is described and warned of" * doctest::description("robust")) {
    // |B| is largest at the walls.
    check_descriptions(R"(
implicit_moment harris.guide_field=0.75
    magnetic field +0\.0625 m_i c omega_pi/e, Omega_ci dt = .*
)");
    check_warnings(
        "implicit_moment harris.guide_field=20 -> warning: electrons: Omega_c dt = 7.509");
}
