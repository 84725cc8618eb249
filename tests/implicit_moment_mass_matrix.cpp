// Facts about the particles' own current: the mass matrix is the response of the kicks, the energy
// of particles and field changes by theta alone, and particles that follow the field keep Gauss's
// law too.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/splines.hpp"
#include "implicit_moment/output/diagnostics.hpp"
#include "implicit_moment/step.hpp"
#include "tests/support/any_particles.hpp"

namespace {

using namespace facts;

// Ions and electrons all over a mesh, in E and in a B whose divergence vanishes.
struct AnyPlasma {
    std::vector<Particles> species;
    FieldState field;

    AnyPlasma(const Grid& grid, int count, double speed, double E, double B, Random& random,
              bool relativistic = false)
        : field(grid) {
        for (const double sign : {1.0, -1.0}) {
            species.push_back(anywhere(grid, count, speed, random));
            Particles& s = species.back();
            const double weight = n0 * grid.x.length * grid.z.length / count;
            s.name = sign > 0 ? "ions" : "electrons";
            s.relativistic = relativistic;
            s.q_p = sign * weight, s.m_p = sign > 0 ? weight : weight / 25;
        }
        field.E = random.field(grid, electric, E);
        keep_unknowns(grid, field.E.all.data());
        fill_ghosts(grid, electric, field.E);
        if (relativistic) field.E_theta = field.E;
        VectorField A = random.field(grid, electric);
        curl_of_electric(grid, A.all.data(), field.B.all.data());
        field.B.all *= B / field.B.all.cwiseAbs().maxCoeff();
        fill_ghosts(grid, magnetic, field.B);
        if (!grid.x.mirrors) return;
        // What crosses the walls: of a linear and a bilinear A_y.
        for (long j = -1; j <= grid.z.cells + 1; ++j)
            for (long i = -1; i <= grid.x.cells + 1; ++i)
                A.y()[grid.index(i, j)] = grid.x.at(real(i)) * (1 + grid.z.at(real(j)));
        VectorField across(grid);
        std::fill_n(A.x(), grid.size(), 0.0), std::fill_n(A.z(), grid.size(), 0.0);
        curl_of_electric(grid, A.all.data(), across.all.data());
        field.B.all += B / 4 * across.all;
        fill_B_ghosts(grid, field.B);
    }
    std::vector<double> charge_over_mass() const {
        return {species[0].q_p / species[0].m_p, species[1].q_p / species[1].m_p};
    }
    double energy(const Grid& grid) const {
        double sum = field_energy(grid, field.E) + field_energy(grid, field.B);
        for (const Particles& s : species)
            for (std::size_t p = 0; p < s.x_p.size(); ++p)
                sum += 0.5 * s.m_p * with_dynamics(s, [&](auto dynamics) {
                           return decltype(dynamics)::twice_energy(
                               Velocity<double>{s.ux_p[p], s.uy_p[p], s.uz_p[p]});
                       });
        return sum;
    }
    // div E - 4 pi rho with rho smoothed as the field equations do.
    Field gauss(const Grid& grid, const SmoothingSettings& smoothing) const {
        Field rho = Field::Zero(grid.size()), G = rho, scratch;
        Moments moments(grid);
        for (const Particles& s : species) {
            deposit_moments(s, grid, field.B, 0, moments);
            rho += moments.rho;
        }
        smooth(grid, on_nodes, felt_charge(grid), smoothing, rho.data(), scratch);
        gauss_residual(grid, field.E, rho, G);
        return G;
    }
};

// The current on the mesh of particles that stand at x* and move with vbar, spline by spline.
VectorField current_of(const Grid& grid, const std::vector<Particles>& species,
                       const std::vector<std::vector<Vector>>& vbar) {
    VectorField J(grid);
    for (std::size_t k = 0; k < species.size(); ++k) {
        const Particles& s = species[k];
        for (std::size_t p = 0; p < s.x_p.size(); ++p) {
            const double x = (s.x_p[p] - grid.x.low) / grid.x.spacing(),
                         z = (s.z_p[p] - grid.z.low) / grid.z.spacing();
            for (long j = -1; j <= grid.z.cells + 1; ++j) {
                for (long i = -1; i <= grid.x.cells + 1; ++i) {
                    const double dx = x - double(i), dz = z - double(j);
                    const long n = grid.index(i, j);
                    const double q = s.q_p / grid.cell_area();
                    J.x()[n] +=
                        q * vbar[k][p][0] * common::spline(1, dx - 0.5) * common::spline(2, dz);
                    J.y()[n] += q * vbar[k][p][1] * common::spline(2, dx) * common::spline(2, dz);
                    J.z()[n] +=
                        q * vbar[k][p][2] * common::spline(2, dx) * common::spline(1, dz - 0.5);
                }
            }
        }
    }
    fold_ghosts(grid, felt(grid), J.all.data());
    return J;
}

double sum_of_products(const Grid& grid, const VectorField& a, const VectorField& b) {
    double sum = 0;
    for (long k = 0; k < 3; ++k)
        sum += interior(grid, a.all.data() + k * grid.size())
                   .cwiseProduct(interior(grid, b.all.data() + k * grid.size()))
                   .sum();
    return sum;
}

}  // namespace

TEST_CASE("J_hat and M E are the current that the kicks make") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const double dt : {0.1, 3.0}) {
            AnyPlasma plasma(grid, 200, 0.3, 0.2, 5, random);
            MassMatrix mass(grid);
            deposit_mass_matrix(plasma.species, grid, plasma.field.B, {}, dt, mass);
            VectorField J(grid), E = plasma.field.E;
            fill_ghosts(grid, felt(grid), E);
            apply_mass_matrix(grid, mass, E.all.data(), J.all.data());
            J.all += mass.J_hat.all;

            InterleaveScratch scratch(grid);
            InterleavedField field;
            interleave_field(grid, {0, false}, plasma.field.E, plasma.field.B, scratch, field);
            std::vector<Particles> after = plasma.species;
            kick_particles(field, {}, grid, dt, after);
            std::vector<std::vector<Vector>> vbar(2);
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t p = 0; p < after[k].x_p.size(); ++p)
                    vbar[k].push_back(0.5 *
                                      (velocity(plasma.species[k], p) + velocity(after[k], p)));
            const VectorField exact = current_of(grid, plasma.species, vbar);
            CHECK(largest(J.all - exact.all) <= 1e-12 * largest(exact.all));
        }
    }
}

TEST_CASE("the mass matrix does no negative work and is symmetric where there is no B") {
    Random random;
    for (const Grid& grid : meshes()) {
        AnyPlasma plasma(grid, 100, 0.3, 1, 4, random);
        VectorField u = plasma.field.E;
        fill_ghosts(grid, felt(grid), u);
        VectorField v = random.field(grid, electric), M_u(grid), M_v(grid);
        keep_unknowns(grid, v.all.data());
        fill_ghosts(grid, felt(grid), v);
        MassMatrix mass(grid);
        deposit_mass_matrix(plasma.species, grid, plasma.field.B, {}, 2, mass);
        apply_mass_matrix(grid, mass, u.all.data(), M_u.all.data());
        CHECK(sum_of_products(grid, u, M_u) > 0);
        plasma.field.B.all.setZero();
        deposit_mass_matrix(plasma.species, grid, plasma.field.B, {}, 2, mass);
        apply_mass_matrix(grid, mass, u.all.data(), M_u.all.data());
        apply_mass_matrix(grid, mass, v.all.data(), M_v.all.data());
        const double one = sum_of_products(grid, v, M_u), other = sum_of_products(grid, u, M_v);
        CHECK(std::fabs(one - other) <= 1e-13 * std::fabs(one));
    }
}

TEST_CASE(
    "of a uniform plasma the mass matrix makes the lumped response times the overlap of splines") {
    const Grid grid{{16, 0, 1, true}, {12, 0, 3, true}};
    Particles s = no_particles();
    const long side = 8;
    for (long j = 0; j < side * grid.z.cells; ++j)
        for (long i = 0; i < side * grid.x.cells; ++i)
            add(s, (double(i) + 0.5) / double(side) * grid.x.spacing(),
                (double(j) + 0.5) / double(side) * grid.z.spacing(), {0, 0, 0});
    sort(grid, s);
    MassMatrix mass(grid);
    const double dt = 0.7;
    deposit_mass_matrix({s}, grid, VectorField(grid), {}, dt, mass);
    const double rho = s.q_p * double(s.count()) / (grid.x.length * grid.z.length);
    const double lumped = rho * 0.5 * dt * s.q_p / s.m_p;
    for (int component = 0; component < 3; ++component)
        CHECK(std::fabs(mean_response(grid, mass, 4 * component) - lumped) <= 1e-13 * lumped);
    const double k_x = 2 * pi * 5 / 16, k_z = 2 * pi * 3 / 12;
    VectorField E(grid), J(grid);
    for (long j = 0; j < grid.z.cells; ++j)
        for (long i = 0; i < grid.x.cells; ++i)
            for (double* f : {E.x(), E.y(), E.z()})
                f[grid.index(i, j)] = std::cos(k_x * double(i) + k_z * double(j));
    fill_ghosts(grid, electric, E);
    VectorField one(grid);
    const auto response = [&](double* component) {
        one.all.setZero();
        std::copy_n(E.all.data() + (component - E.all.data()), grid.size(),
                    one.all.data() + (component - E.all.data()));
        apply_mass_matrix(grid, mass, one.all.data(), J.all.data());
        return sum_of_products(grid, one, J) / sum_of_products(grid, one, one) / lumped;
    };
    CHECK(std::fabs(response(E.x()) - linear_overlap(k_x) * quadratic_overlap(k_z)) <= 2e-3);
    CHECK(std::fabs(response(E.y()) - quadratic_overlap(k_x) * quadratic_overlap(k_z)) <= 2e-3);
    CHECK(std::fabs(response(E.z()) - quadratic_overlap(k_x) * linear_overlap(k_z)) <= 2e-3);
}

TEST_CASE("a flight and the flight back leave particles where they were") {
    Random random;
    for (const Grid& grid : meshes()) {
        std::vector<Particles> there{anywhere(grid, 300, 1, random)};
        const std::vector<Particles> start = there;
        for (const double time : {0.3, 20.0}) {
            drift(grid, time, there);
            for (std::size_t p = 0; p < there[0].x_p.size(); ++p) {
                CHECK(there[0].x_p[p] >= grid.x.low);
                CHECK(there[0].x_p[p] <= grid.x.high());
                CHECK(there[0].z_p[p] >= grid.z.low);
                CHECK(there[0].z_p[p] <= grid.z.high());
            }
            drift(grid, -time, there);
            // On the wall itself a velocity may be that before or after the reflection.
            for (std::size_t p = 0; p < start[0].x_p.size(); ++p) {
                CHECK(apart(grid.x, there[0].x_p[p], start[0].x_p[p]) <= 1e-13);
                CHECK(apart(grid.z, there[0].z_p[p], start[0].z_p[p]) <= 1e-13);
            }
        }
    }
}

TEST_CASE("a flight over more than 1000 boxes is refused") {
    const facts::Untrapped calm;
    for (const Grid& grid : meshes())
        for (const double away : {1.0, -1.0})
            for (const double boxes : {999.0, 1001.0, std::nan("")}) {
                std::vector<Particles> along_x(2, no_particles()), along_z = along_x;
                for (int p = 0; p < 3; ++p) {
                    const double way = p == 1 ? away * boxes : 0;
                    add(along_x[1], grid.x.at(2.3), grid.z.at(3), {way * grid.x.length, 0, 0});
                    add(along_z[1], grid.x.at(2.3), grid.z.at(3), {0, 0, way * grid.z.length});
                }
                for (auto* species : {&along_x, &along_z}) {
                    if (boxes == 999)
                        CHECK_NOTHROW(drift(grid, 1, *species));
                    else
                        CHECK_THROWS_AS(drift(grid, 1, *species), common::NumericalError);
                }
            }
}

// The theorem, for any step, field, mesh and boundary, and with it what theta takes.
void check_energy(const std::string& solver, double longest, bool relativistic = false) {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const double theta : {0.5, 0.6, 1.0}) {
            for (const long passes : {0L, 3L}) {
                for (const double dt : {0.1, longest}) {
                    for (const int count : {60, relativistic ? 200 : 900}) {
                        INFO(solver << " " << grid.x.periodic << grid.z.periodic << " theta "
                                    << theta << " passes " << passes << " dt " << dt << " count "
                                    << count);
                        // Omega_ce dt up to 25 B dt; relativistic kicks of up to 0.2 c and more.
                        AnyPlasma plasma(grid, count, relativistic ? 2 : 0.1, 0.005, 0.4, random,
                                         relativistic);
                        FieldSettings settings;
                        settings.response = "mass_matrix", settings.solver = solver;
                        settings.theta = theta, settings.smoothing.passes = passes;
                        StepScratch scratch(grid, settings, 2);
                        double before = plasma.energy(grid);
                        for (int step = 0; step < 3; ++step) {
                            const Field gauss = plasma.gauss(grid, settings.smoothing);
                            const double by_theta = plasma.field.by_theta;
                            find_moments(grid, dt, plasma.species, plasma.field, scratch);
                            take_step(grid, dt, {}, plasma.charge_over_mass(), scratch,
                                      plasma.species, plasma.field);
                            const double after = plasma.energy(grid),
                                         taken = plasma.field.by_theta - by_theta;
                            CHECK(std::fabs(after - before - taken) <= 1e-11 * before);
                            CHECK((theta == 0.5 ? taken == 0 : taken < 0));
                            if (solver == "newton_krylov")
                                CHECK(largest(grid, on_nodes,
                                              plasma.gauss(grid, settings.smoothing) - gauss) <=
                                      1e-12 * std::max(1.0, largest(grid, on_nodes, gauss)));
                            before = after;
                        }
                    }
                }
            }
        }
    }
}

TEST_CASE("with the mass matrix the energy changes by theta alone") { check_energy("gmres", 3); }

TEST_CASE("particles that follow the field keep energy and Gauss's law") {
    check_energy("newton_krylov", 0.3);
}

TEST_CASE("with the mass matrix the energy with gamma changes by theta alone") {
    check_energy("gmres", 0.5, true);
}

TEST_CASE("relativistic particles that follow the field keep energy and Gauss's law") {
    check_energy("newton_krylov", 0.3, true);
}

TEST_CASE("charge is conserved along any path") {
    Random random;
    for (const Grid& grid : meshes()) {
        for (const double way : {0.01, 0.6, 5.0}) {
            AnyPlasma plasma(grid, 150, 0.1, 0, 0, random);
            EnslavedParticles enslaved(grid);
            enslaved.vbar.resize(2), enslaved.state.resize(2);
            for (std::size_t k = 0; k < 2; ++k) {
                const std::size_t count = plasma.species[k].x_p.size();
                enslaved.state[k].assign(count, {true, false, false});  // paths as they are given
                for (std::size_t p = 0; p < count; ++p) {
                    const Vector v = way * random.vector();
                    enslaved.vbar[k].push_back({v[0], v[1], v[2]});
                }
            }
            const SmoothingSettings none{0, false};
            InterleaveScratch scratch(grid);
            InterleavedField field;
            interleave_field(grid, none, plasma.field.E, plasma.field.B, scratch, field);
            const double dt = 1.3;
            const Field before = plasma.gauss(grid, none);
            follow_field(field, grid, dt, {}, plasma.species, 0, enslaved);
            Field divergence = Field::Zero(grid.size());
            divergence_of_electric(grid, enslaved.J.all.data(), divergence);
            move_enslaved(field, grid, dt, enslaved, plasma.species);
            for (Particles& s : plasma.species) sort(grid, s);
            // E = 0: what gauss gives is -4 pi rho, without its mean in a periodic box.
            const Field after = plasma.gauss(grid, none);
            double most = 0, size = 0;
            for (long j = grid.z.periodic ? 0 : 1; j < grid.z.cells; ++j)
                for (long i = grid.x.periodic ? 0 : 1; i < grid.x.cells; ++i) {
                    const long n = grid.index(i, j);
                    most = worst(
                        {most, std::fabs((after[n] - before[n]) / (4 * pi) - dt * divergence[n])});
                    size = std::max(size, std::fabs(dt * divergence[n]));
                }
            CHECK(most <= 1e-12 * std::max(size, 1.0));
        }
    }
}

TEST_CASE("a field in which no path ends is refused") {
    const facts::Untrapped calm;
    Random random;
    const Grid grid = meshes().front();
    for (const double E : {1e12, std::nan("")}) {
        AnyPlasma plasma(grid, 10, 0.1, 0.1, 0, random);
        EnslavedParticles enslaved(grid);
        enslaved.vbar.resize(2), enslaved.state.resize(2);
        for (std::size_t k = 0; k < 2; ++k)
            enslaved.state[k].resize(10), enslaved.vbar[k].resize(10, {0, 0, 0});
        InterleaveScratch scratch(grid);
        InterleavedField field;
        plasma.field.E.all.setConstant(E);
        interleave_field(grid, {0, false}, plasma.field.E, plasma.field.B, scratch, field);
        CHECK_THROWS_AS(follow_field(field, grid, 1, {}, plasma.species, 0, enslaved),
                        common::NumericalError);
    }
}

TEST_CASE(
    "particles in a wave of light are followed to second order with B of the middle of the step") {
    // Charges too small to be felt, in a wave that travels along x. The light itself is of second
    // order.
    const Grid grid{{64, 0, 2 * pi, true}, {4, 0, 0.4, true}};
    const auto velocities = [&](const std::string& response, const std::string& level, double dt) {
        FieldState field(grid);
        for (long j = -1; j <= grid.z.cells + 1; ++j)
            for (long i = -1; i <= grid.x.cells + 1; ++i) {
                const long n = grid.index(i, j);
                field.E.y()[n] = 0.4 * std::cos(grid.x.at(double(i)));
                field.B.z()[n] = 0.4 * std::cos(grid.x.at(double(i) + 0.5));
            }
        std::vector<Particles> species{no_particles()};
        species[0].q_p = species[0].m_p = 1e-12;
        Random random;
        for (int p = 0; p < 40; ++p)
            add(species[0], pi * (1 + random()), 0.2 * (1 + random()), 0.1 * random.vector());
        sort(grid, species[0]);
        FieldSettings settings;
        settings.response = response, settings.B_level = level;
        settings.smoothing.passes = 0, settings.tolerance = 1e-12;
        StepScratch scratch(grid, settings, 1);
        for (double t = 0; t < 2 - 0.5 * dt; t += dt) {
            find_moments(grid, dt, species, field, scratch);
            take_step(grid, dt, tight, {1.0}, scratch, species, field);
        }
        // In the order of their velocities along z, which only E_z and B could change: it hardly
        // does.
        std::vector<std::pair<double, double>> found;
        for (std::size_t p = 0; p < species[0].x_p.size(); ++p)
            found.emplace_back(species[0].uz_p[p], species[0].ux_p[p]);
        std::sort(found.begin(), found.end());
        Eigen::VectorXd v(long(found.size()));
        for (long p = 0; p < v.size(); ++p) v[p] = found[std::size_t(p)].second;
        return v;
    };
    for (const std::string response : {"moments", "mass_matrix"}) {
        const auto order = [&](const std::string& level) {
            const auto v = [&](double dt) { return velocities(response, level, dt); };
            const Eigen::VectorXd coarse = v(0.1), middle = v(0.05), fine = v(0.025);
            return std::log2((coarse - middle).norm() / (middle - fine).norm());
        };
        CHECK(std::fabs(order("start") - 1) <= 0.15);
        CHECK(std::fabs(order("middle") - 2) <= 0.15);
    }
}
