// Facts about the particles and fields with which runs of implicit_moment start.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>

#include "implicit_moment/setup/initial_state.hpp"
#include "implicit_moment/theory/spline_average.hpp"
#include "tests/support/any_particles.hpp"

namespace {

using namespace facts;

// Two warm species that drift, 64 of each in a cell of a small periodic mesh.
Case uniform_case(const std::string& loading, long seed = 1) {
    Case parameters;
    parameters.setup = "uniform", parameters.loading = loading, parameters.seed = seed;
    parameters.grid = {{16, -2, 4, true}, {12, -3, 6, true}};
    SpeciesCase ions, electrons;
    ions.name = "ions", electrons.name = "electrons";
    ions.drift_x = 0.01, ions.drift_y = -0.02, ions.drift_z = 0.03;
    ions.temperature_x = 1e-4, ions.temperature_y = 4e-4, ions.temperature_z = 9e-4;
    electrons.charge = -1, electrons.mass = 0.04;
    electrons.temperature_x = electrons.temperature_y = electrons.temperature_z = 4e-4;
    parameters.uniform.species = {ions, electrons};
    return parameters;
}

}  // namespace

TEST_CASE("the Harris sheet balances pressure and current and its field is free of divergence") {
    const Case parameters;
    const Grid& grid = parameters.grid;
    const HarrisSheet sheet = harris_sheet(parameters.harris);
    const double B0 = sheet.B0, lambda = parameters.harris.thickness, dz = grid.z.spacing();
    CHECK(std::fabs(n0 * (sheet.T_i + sheet.T_e) * 8 * pi / (B0 * B0) - 1) <= 4 * eps);
    CHECK(std::fabs(sheet.T_i / sheet.T_e - parameters.harris.temperature_ratio) <= 64 * eps);
    CHECK(std::fabs(n0 * (sheet.u_i - sheet.u_e) * 4 * pi * lambda / (c * B0) - 1) <= 4 * eps);
    CHECK(std::fabs(sheet.u_i / sheet.T_i + sheet.u_e / sheet.T_e) <= 64 * eps / B0);

    FieldState field(grid);
    harris_field(parameters, field);
    Field div(grid.size());
    divergence_of_magnetic(grid, field.B.all.data(), div);
    CHECK(largest(grid, on_faces, div) <= 4 * eps * B0 / dz);
    // From the X point in the middle to the O point at the end of the box: 2 psi0.
    double flux = 0, wall = 0;
    for (long i = 0; i < grid.x.cells; ++i) {
        if (2 * i >= grid.x.cells) flux += field.B.z()[grid.index(i, grid.z.cells / 2)];
        wall = worst({wall, std::fabs(field.B.z()[grid.index(i, 0)])});
    }
    const double psi0 = parameters.harris.perturbation * B0;
    CHECK(std::fabs(flux * grid.x.spacing() - 2 * psi0) <= 16 * eps * B0);
    CHECK(wall <= 0);
    // The mean over x is the sheet without the perturbation.
    for (long j = 0; j < grid.z.cells; ++j) {
        const double mean =
            Eigen::Map<const Field>(field.B.x() + grid.index(0, j), grid.x.cells).mean();
        const auto log_cosh = [&](double node) {
            return std::log(std::cosh(grid.z.at(node) / lambda));
        };
        const double exact = lambda / dz * (log_cosh(real(j + 1)) - log_cosh(real(j)));
        CHECK(std::fabs(mean / B0 - exact) <= 128 * eps);
    }
}

TEST_CASE("a sheet of relativistic particles lacks the current that its warning says") {
    Case sheet;
    sheet.harris.background = 0;
    for (const double light : {4.0, 5.0, 8.0, 20.0}) {
        sheet.harris.light_over_alfven = light, sheet.harris.mass_ratio = 4;
        CHECK(lacking_current(sheet) <= 0);
        sheet.mover.relativistic = true;
        const HarrisSheet s = harris_sheet(sheet.harris);
        double current = 0;
        for (const Particles& one : load_harris(sheet).species) {
            double sum = 0;
            for (long p = 0; p < one.count(); ++p)
                sum += one.uy_p[p] / std::sqrt(1 + std::pow(one.ux_p[p], 2) +
                                               std::pow(one.uy_p[p], 2) + std::pow(one.uz_p[p], 2));
            current += (one.q_p > 0 ? 1 : -1) * sum / double(one.count());
        }
        const double lacks = 1 - current / (s.u_i - s.u_e);
        CHECK(lacks >= 0.002);
        CHECK(std::fabs(lacking_current(sheet) - lacks) <= 0.1 * lacks);
        CHECK(no_balance(sheet).empty() == (light > 8));
        sheet.setup = "uniform";
        CHECK(lacking_current(sheet) <= 0);
        sheet.setup = "harris", sheet.mover.relativistic = false;
    }
}

TEST_CASE("particles of a Harris sheet have equal weights and start with no charge") {
    for (const char* loading : {"quiet", "random"}) {
        Case parameters;
        parameters.loading = loading;
        const Grid& grid = parameters.grid;
        const HarrisSheet sheet = harris_sheet(parameters.harris);
        const State state = initial_state(parameters);
        const Particles &ions = state.plasma.species[0], &electrons = state.plasma.species[1];
        CHECK(2 * ions.count() == parameters.harris.particles);
        CHECK(ions.q_p == -electrons.q_p);
        CHECK(std::fabs(ions.q_p / ions.m_p - 1) <= eps);
        CHECK(std::fabs(electrons.q_p / electrons.m_p / -parameters.harris.mass_ratio - 1) <=
              4 * eps);
        CHECK(ions.x_p == electrons.x_p);
        CHECK(ions.z_p == electrons.z_p);

        const Moments of_ions = deposited(grid, ions), of_electrons = deposited(grid, electrons);
        CHECK(largest(grid, on_nodes, of_ions.rho + of_electrons.rho) <= 4 * eps * n0);
        CHECK(state.field.E.all.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= 64 * eps * n0);
        // Density and current of the sheet, averaged over x.
        const Field J_y = of_ions.J_y + of_electrons.J_y;
        for (long j = 0; j <= grid.z.cells; ++j) {
            const auto mean = [&](const Field& f) {
                return f.segment(grid.index(0, j), grid.x.cells).mean() / n0;
            };
            const double sech2 = spline_average(
                [&](double z) { return std::pow(std::cosh(z / parameters.harris.thickness), -2); },
                grid.z.at(real(j)), grid.z.spacing());
            CHECK(std::fabs(mean(of_ions.rho) - sech2 - parameters.harris.background) <= 0.05);
            CHECK(std::fabs(mean(J_y) - sech2 * (sheet.u_i - sheet.u_e)) <= 0.02);
        }
    }
}

TEST_CASE("a uniform plasma has the moments that were asked for") {
    for (const char* loading : {"quiet", "random"}) {
        const Case parameters = uniform_case(loading);
        const Plasma plasma = initial_state(parameters).plasma;
        const double n = 64 * 16 * 12,
                     charge = n0 * parameters.grid.x.length * parameters.grid.z.length;
        CHECK(plasma.count() == 2 * 64 * 16 * 12);
        for (std::size_t k = 0; k < 2; ++k) {
            const Particles& particles = plasma.species[k];
            const SpeciesCase& s = parameters.uniform.species[k];
            CHECK(std::fabs(particles.m_p * n / (s.mass * charge) - 1) <= 4 * eps);
            CHECK(std::fabs(particles.q_p * n / (s.charge * charge) - 1) <= 4 * eps);
            const Vector drift(s.drift_x, s.drift_y, s.drift_z),
                T(s.temperature_x, s.temperature_y, s.temperature_z);
            Eigen::Array3d mean = Eigen::Array3d::Zero(), square = mean;
            for (std::size_t p = 0; p < particles.x_p.size(); ++p) {
                const Eigen::Array3d v = velocity(particles, p) - drift;
                mean += v / n, square += v.square() / n;
            }
            for (long a = 0; a < 3; ++a) {
                CHECK(std::fabs(mean[a]) <= 4 * std::sqrt(T[a] / s.mass / n));
                CHECK(std::fabs(square[a] * s.mass / T[a] - 1) <= 4 * std::sqrt(2 / n));
            }
        }
    }
}

TEST_CASE("the seeded mode has the waves and amplitudes and phases that were asked for") {
    for (const auto& [mode_x, mode_z] : {std::pair{2, 0}, std::pair{0, 3}, std::pair{1, -2}}) {
        Case w = uniform_case("quiet");
        UniformCase& u = w.uniform;
        u.mode_x = mode_x, u.mode_z = mode_z;
        const double dx = w.grid.x.spacing(), dz = w.grid.z.spacing();
        const double k_x = 2 * pi * mode_x / w.grid.x.length,
                     k_z = 2 * pi * mode_z / w.grid.z.length;
        u.E_x = 0.1, u.E_y = 0.2, u.E_z = 0.3, u.B_x = 0.4, u.B_y = 0.5, u.B_z = 0.6;
        u.wave_E_x = 0.01, u.wave_E_y = 0.02, u.wave_E_z = 0.03, u.wave_B_y = 0.04;
        u.phase_E_x = 10, u.phase_E_y = 20, u.phase_E_z = 30, u.phase_B_y = 40;
        u.wave_B_x = mode_x == 0 ? 0.05 : -0.05 * k_z / k_x, u.wave_B_z = mode_x == 0 ? 0 : 0.05;
        u.phase_B_x = u.phase_B_z = 50;
        SpeciesCase& s = u.species[0];
        s.temperature_x = s.temperature_y = s.temperature_z = 0;
        s.wave_x = 0.001, s.wave_y = 0.002, s.wave_z = 0.003;
        s.phase_x = 60, s.phase_y = 70, s.phase_z = 80;
        const State state = loaded_state(w);
        const auto wave = [&](double x, double z, double degrees) {
            return std::cos(k_x * x + k_z * z + degrees * pi / 180);
        };
        // The mesh takes differences of A_y over a cell.
        const auto smaller = [](double half) { return half == 0 ? 1 : std::sin(half) / half; };
        const double B_x = u.wave_B_x * smaller(k_z * dz / 2),
                     B_z = u.wave_B_z * smaller(k_x * dx / 2);
        const VectorField &E = state.field.E, &B = state.field.B;
        double wrong = 0;
        for (long j = 0; j < w.grid.z.cells; ++j)
            for (long i = 0; i < w.grid.x.cells; ++i) {
                const long n = w.grid.index(i, j);
                const double x = real(i) * dx, z = real(j) * dz, x_half = x + dx / 2,
                             z_half = z + dz / 2;
                wrong = worst({wrong, std::fabs(E.x()[n] - 0.1 - 0.01 * wave(x_half, z, 10)),
                               std::fabs(E.y()[n] - 0.2 - 0.02 * wave(x, z, 20)),
                               std::fabs(E.z()[n] - 0.3 - 0.03 * wave(x, z_half, 30)),
                               std::fabs(B.x()[n] - 0.4 - B_x * wave(x, z_half, 50)),
                               std::fabs(B.y()[n] - 0.5 - 0.04 * wave(x_half, z_half, 40)),
                               std::fabs(B.z()[n] - 0.6 - B_z * wave(x_half, z, 50))});
            }
        CHECK(wrong <= 1e-14);
        const Particles& ions = state.plasma.species[0];
        for (std::size_t p = 0; p < ions.x_p.size(); ++p) {
            const double x = ions.x_p[p] - w.grid.x.low, z = ions.z_p[p] - w.grid.z.low;
            const Vector v(0.01 + 0.001 * wave(x, z, 60), -0.02 + 0.002 * wave(x, z, 70),
                           0.03 + 0.003 * wave(x, z, 80));
            wrong = worst({wrong, (velocity(ions, p) - v).norm()});
        }
        CHECK(wrong <= 1e-14);
    }
}

TEST_CASE("a quiet start is quieter than random numbers and another seed another realization") {
    const Grid grid = uniform_case("quiet").grid;
    const auto noise = [&](const char* loading) {
        const State state = initial_state(uniform_case(loading));
        const Field rho = deposited(grid, state.plasma.species[0]).rho / n0;
        return std::sqrt(total(grid, on_nodes, (rho.array() - 1).square().matrix()) / 24);
    };
    // Of 64 particles per cell: the squared weights of S2 S2 add up to 0.55 squared.
    CHECK(noise("random") <= 1.2 * 0.55 / 8);
    CHECK(noise("random") >= 0.8 * 0.55 / 8);
    CHECK(noise("quiet") <= 0.3 * noise("random"));
    for (const char* loading : {"quiet", "random"}) {
        const State one = initial_state(uniform_case(loading, 1)),
                    same = initial_state(uniform_case(loading, 1)),
                    other = initial_state(uniform_case(loading, 2));
        CHECK(identical(one.plasma.species[0], same.plasma.species[0]));
        CHECK(difference(grid, one.plasma.species[0], other.plasma.species[0]) > 0.1);
    }
}

TEST_CASE("quiet velocities are alike in every part of the box") {
    const Case parameters = uniform_case("quiet");
    const Particles ions = initial_state(parameters).plasma.species[0];
    const SpeciesCase& s = parameters.uniform.species[0];
    const Vector drift(s.drift_x, s.drift_y, s.drift_z);
    const Eigen::Array3d thermal(std::sqrt(s.temperature_x), std::sqrt(s.temperature_y),
                                 std::sqrt(s.temperature_z));
    const auto &x = parameters.grid.x, &z = parameters.grid.z;
    // Quarters along x and thirds along z are the first digits of the two places.
    std::vector<Eigen::Array3d> sums(12, Eigen::Array3d::Zero());
    for (std::size_t p = 0; p < ions.x_p.size(); ++p) {
        const auto i = std::size_t(4 * (ions.x_p[p] - x.low) / x.length),
                   j = std::size_t(3 * (ions.z_p[p] - z.low) / z.length);
        sums[3 * i + j] += (velocity(ions, p) - drift).array() / thermal;
    }
    // Of random numbers 1024^(-1/2) = 0.03.
    for (const Eigen::Array3d& sum : sums)
        CHECK((sum / 1024).abs().maxCoeff<Eigen::PropagateNaN>() <= 0.015);
}

TEST_CASE("the field at the start obeys the law of Gauss with conducting walls") {
    Random random;
    for (const Grid& grid : meshes()) {
        const VectorField any = random.field(grid, current, 1);
        const Field rho = any.all.segment(grid.size(), grid.size());
        FieldState field(grid);
        add_electrostatic_field(grid, rho, field);
        Field div = Field::Zero(grid.size());
        divergence_of_electric(grid, field.E.all.data(), div);
        // In a doubly periodic box a uniform background takes the mean.
        const bool free = grid.x.periodic && grid.z.periodic;
        const double mean = free ? total(grid, on_nodes, rho) / grid.x.length / grid.z.length : 0;
        double wrong = 0;
        for_each_distinct(grid, on_nodes, [&](long i, long j, long n) {
            const bool on_wall = weight(grid.x, false, i) * weight(grid.z, false, j) < 1;
            if (!on_wall) wrong = worst({wrong, std::fabs(div[n] - 4 * pi * (rho[n] - mean))});
        });
        CHECK(wrong <= 64 * eps * 4 * pi);
    }
}
