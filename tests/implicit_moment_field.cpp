// Facts about the field equations of implicit_moment: the prediction of the current, the
// second-order equation, Gauss's law by its boundary values, energy and divergence.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "implicit_moment/advance_field.hpp"
#include "implicit_moment/move_particles.hpp"
#include "implicit_moment/output/diagnostics.hpp"
#include "tests/support/any_fields.hpp"

namespace {

using namespace facts;
using Vector = Eigen::VectorXd;

// Periodic, and walls in one or both directions; spacings differ.
std::vector<Grid> meshes() {
    std::vector<Grid> all;
    for (const int ends : {0, 1, 2, 3}) {
        all.push_back({{12, -2, 4, ends % 2 == 0}, {10, 0.5, 2.1, ends < 2}});
    }
    all.push_back({{12, -2, 4, false, true}, {10, 0.5, 2.1, false}});  // the ends of a tail
    return all;
}

// Unknowns only, random.
Vector any_field(const Grid& grid, Random& random) {
    Vector E(3 * grid.size());
    for (double& value : E) value = random();
    keep_unknowns(grid, E.data());
    return E;
}

// E and B of a vacuum or plasma: E random, B the curl of something, so that div B = 0.
void any_state(const Grid& grid, double E, double B, Random& random, FieldState& field) {
    field.E.all = E * any_field(grid, random);
    fill_ghosts(grid, electric, field.E);
    VectorField A(grid);
    A.all = any_field(grid, random);
    fill_ghosts(grid, electric, A);
    curl_of_electric(grid, A.all.data(), field.B.all.data());
    field.B.all *= B / field.B.all.cwiseAbs().maxCoeff();
    fill_ghosts(grid, magnetic, field.B);
}

// Solves where the B that pushes particles is not asked for.
FieldReport solve(FieldSolver& solver, const std::vector<Moments>& moments,
                  const std::vector<double>& charge_over_mass, double dt, FieldState& field) {
    VectorField B_push = field.B;
    return solve_field(solver, moments, charge_over_mass, dt, field, B_push);
}

struct Loaded {
    std::vector<Particles> species;
    std::vector<Moments> moments;
    std::vector<double> charge_over_mass;
};

// Ions and electrons of density about n0 with thermal speed v; the charges need not cancel.
Loaded any_plasma(const Grid& grid, double mass_ratio, double v, Random& random) {
    Loaded plasma;
    const long count = 40 * grid.x.cells * grid.z.cells;
    for (const double sign : {1.0, -1.0}) {
        Particles p;
        p.name = sign > 0 ? "ions" : "electrons";
        const double weight = n0 * grid.x.length * grid.z.length / double(count);
        p.q_p = sign * weight, p.m_p = sign > 0 ? weight : weight / mass_ratio;
        for (long n = 0; n < count; ++n) {
            p.x_p.push_back(grid.x.low + 0.4999 * (1 + random()) * grid.x.length);
            p.z_p.push_back(grid.z.low + 0.4999 * (1 + random()) * grid.z.length);
            for (auto* f : {&p.ux_p, &p.uy_p, &p.uz_p}) f->push_back(v * random());
        }
        SortScratch scratch;
        sort_particles(grid, scratch, p);
        plasma.species.push_back(p);
        plasma.charge_over_mass.push_back(p.q_p / p.m_p);
        plasma.moments.emplace_back(grid);
    }
    return plasma;
}

// The largest value on the unknown nodes: inside the walls.
double largest_inside(const Grid& grid, const Field& f) {
    double most = 0;
    for (long j = grid.z.periodic ? 0 : 1; j < grid.z.cells; ++j) {
        for (long i = grid.x.periodic ? 0 : 1; i < grid.x.cells; ++i) {
            most = worst({most, std::fabs(f[grid.index(i, j)])});
        }
    }
    return most;
}

}  // namespace

TEST_CASE("the field operator is linear and nothing but zero is mapped to zero") {
    Random random;
    for (const Grid& grid : meshes()) {
        Loaded plasma = any_plasma(grid, 25, 0.1, random);
        FieldState field(grid);
        any_state(grid, 0, 0.05, random, field);
        FieldSolver solver(grid, {});
        deposit_moments(plasma.species, grid, field.B, 0.3, false, plasma.moments);
        predict_current(grid, plasma.moments, plasma.charge_over_mass, field.B.all.data(),
                        field.B.all.data(), 0.3, 0.5, solver.response);
        const auto apply = [&](const Vector& v) {
            Vector out(v.size());
            apply_field_operator(solver, 0.15, v, out);
            return out;
        };
        const Vector u = any_field(grid, random), v = any_field(grid, random);
        CHECK(largest(apply(2 * u - 3 * v) - 2 * apply(u) + 3 * apply(v)) <= 1e-12);
        CHECK(largest(apply(Vector::Zero(u.size()))) <= 0.0);
        for (int n = 0; n < 10; ++n) {
            const Vector w = any_field(grid, random);
            CHECK(w.dot(apply(w)) >= w.squaredNorm());
        }
    }
}

TEST_CASE("the susceptibility never gives energy however fast the plasma rotates") {
    // Strong random B: the electrons turn by up to a hundred radians per step, and B differs from
    // node to node. An operator whose skew part did work would fail here.
    Random random;
    for (const Grid& grid : meshes()) {
        Loaded plasma = any_plasma(grid, 1836, 0.01, random);
        FieldState field(grid);
        any_state(grid, 0, 0.5, random, field);
        PlasmaResponse response(grid);
        const double* B = field.B.all.data();
        deposit_moments(plasma.species, grid, field.B, 0.1, false, plasma.moments);
        predict_current(grid, plasma.moments, plasma.charge_over_mass, B, B, 0.1, 0.5, response);
        for (int n = 0; n < 50; ++n) {
            VectorField E(grid), out(grid);
            E.all = any_field(grid, random);
            const Vector unknowns = E.all;
            fill_ghosts(grid, electric, E);
            apply_tensor(grid, response.chi, E.all.data(), false, response.scratch, out.all.data());
            keep_unknowns(grid, out.all.data());
            CHECK(unknowns.dot(out.all) > 0);
        }
    }
}

TEST_CASE("the rotation on the mesh is the rotation of a particle in each sense") {
    // The plane-by-plane sense: a transposed tensor would turn the other way.
    const Grid grid{{8, 0, 1, true}, {8, 0, 1, true}};
    const double half_kick = 0.7;
    VectorField B(grid), v(grid), out(grid), scratch(grid);
    const Velocity<double> speed{0.3, -0.5, 0.9};
    const LocalField<double> at{0, 0, 0, 1.1, -0.6, 2.3};
    const std::array<double, 3> speeds{speed.x, speed.y, speed.z}, fields{1.1, -0.6, 2.3};
    for (std::size_t a = 0; a < 3; ++a) {
        B.all.segment(long(a) * grid.size(), grid.size()).setConstant(fields[a]);
        v.all.segment(long(a) * grid.size(), grid.size()).setConstant(speeds[a]);
    }
    Tensor R(grid);
    rotation_tensor(grid, B.all.data(), half_kick, R);
    apply_tensor(grid, R, v.all.data(), false, scratch, out.all.data());
    const Velocity<double> rotated = mean_velocity(speed, at, half_kick);
    const long n = grid.index(3, 4);
    CHECK(std::fabs(out.x()[n] - rotated.x) <= 1e-14);
    CHECK(std::fabs(out.y()[n] - rotated.y) <= 1e-14);
    CHECK(std::fabs(out.z()[n] - rotated.z) <= 1e-14);

    // Taking the rotation out again leaves the unit tensor.
    multiply_by_inverse_rotation(grid, B.all.data(), half_kick, R);
    for (std::size_t a = 0; a < 9; ++a) {
        CHECK(std::fabs(R.entry[a][n] - (a % 4 == 0 ? 1 : 0)) <= 1e-14);
    }
}

TEST_CASE("a tensor acts on each component in its place and from one to another through nodes") {
    Random random;
    for (const Grid& grid : meshes()) {
        Tensor T(grid);
        for (Field& f : T.entry) f = random.field(grid);
        VectorField v(grid), scratch(grid);
        for (double& value : v.all) value = random();
        const VectorField before = random.field(grid, current);
        const long s = grid.stride();
        const auto at = [&](std::size_t a, long n) { return T.entry[a][n]; };
        // What the nodes give to x, y and z; of x and z all but their own part.
        const auto on_node = [&](long n) -> Eigen::Vector3d {
            Eigen::Matrix3d M;
            M << 0, at(1, n), at(2, n), at(3, n), at(4, n), at(5, n), at(6, n), at(7, n), 0;
            return M * Eigen::Vector3d((v.x()[n - 1] + v.x()[n]) / 2, v.y()[n],
                                       (v.z()[n - s] + v.z()[n]) / 2);
        };
        for (const bool add : {false, true}) {
            VectorField out = before;
            apply_tensor(grid, T, v.all.data(), add, scratch, out.all.data());
            if (add) out.all -= before.all;
            for (long j = 0; j < grid.z.cells; ++j)
                for (long i = 0; i < grid.x.cells; ++i) {
                    const long n = grid.index(i, j), right = n + 1, up = n + s;
                    const double x = (at(0, n) + at(0, right)) / 2 * v.x()[n] +
                                     (on_node(n)[0] + on_node(right)[0]) / 2,
                                 z = (at(8, n) + at(8, up)) / 2 * v.z()[n] +
                                     (on_node(n)[2] + on_node(up)[2]) / 2;
                    CHECK(std::fabs(out.x()[n] - x) <= 1e-14);
                    CHECK(std::fabs(out.y()[n] - on_node(n)[1]) <= 1e-14);
                    CHECK(std::fabs(out.z()[n] - z) <= 1e-14);
                }
        }
    }
}

TEST_CASE("the solution obeys the second-order equation with the predicted charge") {
    // E + chi E - a^2 lap E = E^n + a curl B - 4 pi theta dt J_hat - 4 pi a^2 grad rho_theta,
    // written with curl curl E = grad div E - lap E; and Gauss's law at n + theta decays by (ii).
    Random random;
    for (const Grid& grid : meshes()) {
        for (const double theta : {0.5, 1.0}) {
            const double dt = 0.4, a = theta * dt;
            Loaded plasma = any_plasma(grid, 25, 0.1, random);
            FieldState field(grid);
            any_state(grid, 0.02, 0.05, random, field);
            FieldSettings settings;
            settings.theta = theta, settings.tolerance = 1e-13;
            FieldSolver solver(grid, settings);
            deposit_moments(plasma.species, grid, field.B, dt, false, plasma.moments);
            solve(solver, plasma.moments, plasma.charge_over_mass, dt, field);

            // The current that the field equations have used: 4 pi theta dt J = ... + S chi S E.
            const SmoothingSettings& smoothing = settings.smoothing;
            VectorField J(grid), E = field.E_theta, chi_E(grid);
            fill_ghosts(grid, felt(grid), E);
            smooth(grid, felt(grid), smoothing, E.all.data(), solver.scratch);
            apply_tensor(grid, solver.response.chi, E.all.data(), false, solver.response.scratch,
                         chi_E.all.data());
            fill_ghosts(grid, felt(grid), chi_E);
            smooth(grid, felt(grid), smoothing, chi_E.all.data(), solver.scratch);
            J.all = solver.response.J_hat.all + chi_E.all / (4 * pi * theta * dt);
            fill_ghosts(grid, electric, J);

            // rho_theta = rho - theta dt div J, and Gauss's law with it.
            Field div_J = Field::Zero(grid.size()), G = Field::Zero(grid.size());
            divergence_of_electric(grid, J.all.data(), div_J);
            Field rho_theta = solver.response.rho - theta * dt * div_J;
            if (grid.x.periodic && grid.z.periodic) {
                rho_theta.array() -= interior(grid, rho_theta.data()).mean();
            }
            divergence_of_electric(grid, field.E_theta.all.data(), G);
            G -= 4 * pi * rho_theta;
            common::fill_ghosts(grid, on_nodes, {-1, -1}, G.data());
            Field G_n = Field::Zero(grid.size());
            gauss_residual(grid, field.E, solver.response.rho, G_n);
            Field decayed = G_n;
            solve_helmholtz(grid, solver.waves, a, decayed);
            CHECK(largest_inside(grid, G - decayed) <= 1e-10 * largest_inside(grid, G_n));
            CHECK(largest_inside(grid, G) < largest_inside(grid, G_n));

            // The equation itself.
            VectorField curl(grid), curl_curl(grid), curl_B(grid), left(grid), right(grid);
            curl_of_electric(grid, field.E_theta.all.data(), curl.all.data());
            fill_ghosts(grid, magnetic, curl);
            curl_of_magnetic(grid, curl.all.data(), curl_curl.all.data());
            curl_of_magnetic(grid, field.B.all.data(), curl_B.all.data());
            left.all = field.E_theta.all + a * a * curl_curl.all;
            right.all = field.E.all + a * curl_B.all - 4 * pi * theta * dt * J.all;
            const long s = grid.stride();
            for_each_point(grid, [&](long n) {
                right.x()[n] += a * a * (G[n + 1] - G[n]) / grid.x.spacing();
                right.z()[n] += a * a * (G[n + s] - G[n]) / grid.z.spacing();
            });
            keep_unknowns(grid, left.all.data());
            keep_unknowns(grid, right.all.data());
            CHECK(largest(left.all - right.all) <= 1e-11 * largest(right.all));
        }
    }
}

TEST_CASE("an error in the law of Gauss decays without a projection also as a checkerboard") {
    for (const Grid& grid : meshes()) {
        for (const double theta : {0.5, 0.6, 1.0}) {
            FieldSettings settings;
            settings.theta = theta;
            settings.tolerance = 1e-13;
            FieldSolver solver(grid, settings);
            FieldState field(grid);
            const std::vector<Moments> none;
            for (long j = 0; j < grid.z.cells; ++j) {
                for (long i = 0; i < grid.x.cells; ++i) {
                    const double sign = (i + j) % 2 == 0 ? 1 : -1;
                    field.E.x()[grid.index(i, j)] = field.E.z()[grid.index(i, j)] = sign;
                }
            }
            keep_unknowns(grid, field.E.all.data());
            fill_ghosts(grid, electric, field.E);
            Field G = Field::Zero(grid.size()), rho = Field::Zero(grid.size());
            gauss_residual(grid, field.E, rho, G);
            const double first = largest_inside(grid, G);
            CHECK(first > 0);
            for (int step = 0; step < 5; ++step) {
                // (1 - a^2 lap) G^{n+theta} = G^n, and G^{n+1} from the two as E^{n+1}.
                Field expected = G;
                solve_helmholtz(grid, solver.waves, theta, expected);
                expected = (expected - (1 - theta) * G) / theta;
                const double before = largest_inside(grid, G);
                solve(solver, none, {}, 1.0, field);
                advance_field(solver, 1.0, field);
                gauss_residual(grid, field.E, rho, G);
                CHECK(largest_inside(grid, G - expected) <= 1e-10 * first);
                if (theta == 1) CHECK(largest_inside(grid, G) <= 0.5 * before);
            }
            CHECK(largest_inside(grid, G) <= 0.9 * first);
        }
    }
}

TEST_CASE("in vacuum theta one half conserves the energy and div B stays zero") {
    Random random;
    for (const Grid& grid : meshes()) {
        FieldSettings settings;
        settings.tolerance = 1e-13;
        FieldSolver solver(grid, settings);
        FieldState field(grid);
        // A field without charges: E too is a curl.
        any_state(grid, 0, 1, random, field);
        VectorField C(grid);
        C.all = field.B.all;
        curl_of_magnetic(grid, C.all.data(), field.E.all.data());
        keep_unknowns(grid, field.E.all.data());
        fill_ghosts(grid, electric, field.E);
        field.B.all.setZero();
        const std::vector<Moments> none;
        Field scratch;
        const double start = field_energy(grid, field.E) + field_energy(grid, field.B);
        double exchanged = 0;
        for (int step = 0; step < 300; ++step) {
            solve(solver, none, {}, 0.35, field);
            advance_field(solver, 0.35, field);
            const double in_B = field_energy(grid, field.B);
            exchanged = worst({exchanged, in_B / start});
            CHECK(std::fabs((field_energy(grid, field.E) + in_B) / start - 1) <= 1e-10);
        }
        CHECK(exchanged > 0.3);
        CHECK(largest_divergence(grid, field.B, scratch) <=
              1e-12 * largest(field.B.all) / grid.z.spacing());
    }
}

TEST_CASE("a field and its mirror image have the same energy") {
    Random random;
    for (const Grid& grid : meshes()) {
        FieldState field(grid);
        any_state(grid, 1, 1, random, field);
        VectorField mirrored(grid);
        const long nz = grid.z.cells;
        for (long j = 0; j <= nz; ++j) {
            for (long i = 0; i <= grid.x.cells; ++i) {
                const long to = grid.index(i, j);
                mirrored.x()[to] = field.E.x()[grid.index(i, nz - j)];
                mirrored.y()[to] = field.E.y()[grid.index(i, nz - j)];
                if (j < nz) mirrored.z()[to] = -field.E.z()[grid.index(i, nz - 1 - j)];
            }
        }
        CHECK(std::fabs(field_energy(grid, mirrored) / field_energy(grid, field.E) - 1) <= 1e-13);
    }
}

TEST_CASE("the number of iterations does not grow with the plasma period per step") {
    const Grid grid{{32, 0, 8, true}, {32, 0, 8, false}};
    Random random;
    std::vector<int> iterations;
    for (const double dt : {0.1, 1.0, 10.0, 100.0}) {
        // A uniform lattice, so that chi is uniform.
        Particles p;
        p.name = "electrons";
        p.q_p = -n0 * grid.x.length * grid.z.length / (4.0 * 32 * 32), p.m_p = -p.q_p / 100;
        for (long j = 0; j < 64; ++j) {
            for (long i = 0; i < 64; ++i) {
                p.x_p.push_back((double(i) + 0.5) * 0.125);
                p.z_p.push_back((double(j) + 0.5) * 0.125);
                for (auto* f : {&p.ux_p, &p.uy_p, &p.uz_p}) f->push_back(1e-3 / dt * random());
            }
        }
        SortScratch scratch;
        sort_particles(grid, scratch, p);
        std::vector<Particles> species{p};
        std::vector<Moments> moments{Moments(grid)};
        FieldState field(grid);
        any_state(grid, 0.01, 1e-6, random, field);
        FieldSolver solver(grid, {});
        deposit_moments(species, grid, field.B, dt, false, moments);
        iterations.push_back(solve(solver, moments, {-100}, dt, field).iterations);
    }
    for (const int count : iterations) CHECK(count <= 5);
}

TEST_CASE("of a uniform magnetized plasma without walls the preconditioner is the inverse") {
    Random random;
    for (const Grid& grid :
         {Grid{{8, -2, 4, true}, {7, 0.5, 2.1, true}}, Grid{{12, 0, 3, true}, {10, 0, 2, true}}}) {
        for (const double omega_dt : {0.3, 3.0, 40.0}) {
            for (const long passes : {0L, 2L}) {
                FieldSettings settings;
                settings.smoothing.passes = passes;
                FieldSolver solver(grid, settings);
                const Eigen::Vector3d O = omega_dt * random.vector();
                const auto R = rotation_matrix(O[0], O[1], O[2]);
                for (std::size_t k = 0; k < 9; ++k)
                    solver.response.chi.entry[k].setConstant(30 * R[k]);
                prepare_preconditioner(solver, 0.4);
                VectorField E = random.field(grid, electric);
                keep_unknowns(grid, E.all.data());
                Eigen::VectorXd r(E.all.size()), back;
                apply_field_operator(solver, 0.4, E.all, r);
                precondition_field(solver, r, back);
                CHECK((back - E.all).norm() <= 2e-5 * E.all.norm());
            }
        }
    }
}

TEST_CASE("threads that share the field solve give the same bits") {
    Random random;
    for (const int ends : {0, 1, 2, 3}) {
        const Grid grid{{72, -2, 4, ends % 2 == 0}, {67, 0.5, 2.1, ends < 2}};
        Loaded plasma = any_plasma(grid, 4, 0.1, random);
        FieldState start(grid);
        any_state(grid, 0.02, 0.05, random, start);
        deposit_moments(plasma.species, grid, start.B, 0.3, false, plasma.moments);
        const int before = common::thread_count();
        std::vector<Eigen::VectorXd> solutions;
        for (const int threads : {1, 2, 3}) {
            common::set_thread_count(threads);
            FieldState field = start;
            FieldSolver solver(grid, {});
            CHECK(solve(solver, plasma.moments, plasma.charge_over_mass, 0.3, field).iterations >=
                  2);
            solutions.push_back(field.E_theta.all);
        }
        common::set_thread_count(before);
        for (const Eigen::VectorXd& E : solutions) CHECK(E == solutions[0]);
    }
}

TEST_CASE("what does not converge is never used") {
    const facts::Untrapped calm;
    const Grid grid = meshes()[2];
    Random random;
    Loaded plasma = any_plasma(grid, 25, 0.1, random);
    FieldState field(grid);
    any_state(grid, 0.02, 0.05, random, field);
    deposit_moments(plasma.species, grid, field.B, 0.3, false, plasma.moments);
    const auto solved_from = [&](const FieldSettings& settings, FieldState start) {
        FieldSolver solver(grid, settings);
        solve(solver, plasma.moments, plasma.charge_over_mass, 0.3, start);
    };
    FieldState broken = field;
    broken.E.all[grid.index(3, 3)] = std::nan("");
    for (const char* name : {"gmres", "newton_krylov"}) {
        FieldSettings settings;
        settings.solver = name;
        CHECK_NOTHROW(solved_from(settings, field));
        CHECK_THROWS_AS(solved_from(settings, broken), common::NumericalError);
    }
    FieldSettings hasty;
    hasty.max_iterations = 1, hasty.tolerance = 1e-12;
    CHECK_THROWS_AS(solved_from(hasty, field), common::NumericalError);
}

TEST_CASE("nothing comes of nothing with both solvers") {
    const Grid grid = meshes()[2];
    for (const char* name : {"gmres", "newton_krylov"}) {
        FieldSettings settings;
        settings.solver = name;
        FieldSolver solver(grid, settings);
        FieldState field(grid);
        const std::vector<Moments> none;
        solve(solver, none, {}, 0.3, field);
        CHECK(largest(field.E_theta.all) <= 0.0);
    }
}

TEST_CASE("Newton solves the equations whose rotation is taken at the theta level") {
    Random random;
    for (const Grid& grid : meshes()) {
        const double dt = 0.5;
        Loaded plasma = any_plasma(grid, 25, 0.1, random);
        FieldState field(grid), other(grid);
        any_state(grid, 0.02, 0.05, random, field);
        other = field;
        FieldSettings settings;
        settings.tolerance = 1e-12;
        FieldSolver linear(grid, settings);
        settings.solver = "newton_krylov";
        FieldSolver newton(grid, settings);
        deposit_moments(plasma.species, grid, field.B, dt, false, plasma.moments);
        VectorField B_push = field.B;
        solve_field(linear, plasma.moments, plasma.charge_over_mass, dt, field, B_push);
        CHECK(B_push.all == field.B.all);
        solve_field(newton, plasma.moments, plasma.charge_over_mass, dt, other, B_push);

        // The B that pushes particles belongs to the E_theta that was found.
        VectorField B_theta(grid);
        curl_of_electric(grid, other.E_theta.all.data(), B_theta.all.data());
        B_theta.all = other.B.all - 0.5 * dt * B_theta.all;
        fill_ghosts(grid, magnetic, B_theta);
        CHECK(largest(B_theta.all - B_push.all) <= 1e-9 * largest(B_theta.all));
        // With the rotation in that B the linear equations have the same solution...
        FieldSolver check(grid, linear.settings);
        predict_current(grid, plasma.moments, plasma.charge_over_mass, other.B.all.data(),
                        B_theta.all.data(), dt, 0.5, check.response);
        VectorField J = check.response.J_hat;
        smooth(grid, felt(grid), settings.smoothing, J.all.data(), check.scratch);
        Vector left(J.all.size()), E = other.E_theta.all;
        keep_unknowns(grid, E.data());
        apply_field_operator(check, 0.5 * dt, E, left);
        Vector right = newton.source.all - 4 * pi * 0.5 * dt * J.all;
        keep_unknowns(grid, right.data());
        CHECK(largest(left - right) <= 1e-9 * largest(right));
        // ... which is not that of the linear equations in B^n.
        const double difference = largest(other.E_theta.all - field.E_theta.all);
        CHECK(difference > 1e-6 * largest(field.E_theta.all));
        CHECK(difference < 0.3 * largest(field.E_theta.all));
    }
}

// Moves particles towards their nearest node, so that none passes a kink of a spline on its way.
void keep_off_kinks(const Grid& grid, Particles& p) {
    const auto move = [](const common::Axis& axis, double& x) {
        const double s = (x - axis.low) / axis.spacing(), node = std::round(s);
        x = axis.at(node + 0.7 * (s - node));
    };
    for (double& x : p.x_p) move(grid.x, x);
    for (double& z : p.z_p) move(grid.z, z);
}

TEST_CASE("the current predicted with rotated particles moves the charge to third order") {
    // rho^{n+1} - rho^n + dt div(J - dt/2 div P) for particles in a uniform B without E, at an
    // Omega dt of 4: halving every speed divides the error by eight. The sums rotated on the mesh,
    // R [J - dt/2 div P], are wrong in the first order already, because components that live on
    // different places must be averaged to be rotated into each other: it divides by two.
    const Grid grid{{16, 0, 1.6, true}, {16, 0, 1.6, true}};
    const double dt = 1, Omega_dt = 4;
    std::vector<double> errors, mesh_errors;
    for (const double v : {0.004, 0.002}) {
        Random random;
        Loaded plasma = any_plasma(grid, 1, v, random);
        Particles& p = plasma.species[0];
        keep_off_kinks(grid, p);
        Moments rotated(grid), plain(grid), after(grid);
        VectorField B(grid), J(grid), R_J(grid), scratch(grid);
        B.all.head(grid.size()).setConstant(0.6 * Omega_dt);
        B.all.tail(grid.size()).setConstant(-0.8 * Omega_dt);
        deposit_moments(p, grid, B, dt, rotated);
        deposit_moments(p, grid, plain);
        InterleavedField push(std::size_t(grid.size()),
                              {0, 0, 0, 0.6 * Omega_dt, 0, -0.8 * Omega_dt});
        const MoverReport report = move_particles(push, grid, dt, {1e-13, 100}, p);
        CHECK(report.lost == 0);
        SortScratch sorted;
        sort_particles(grid, sorted, p);
        deposit_moments(p, grid, after);

        Field div = Field::Zero(grid.size());
        hatted_current(grid, rotated, dt, J);
        divergence_of_electric(grid, J.all.data(), div);
        errors.push_back(largest_inside(grid, after.rho - rotated.rho + dt * div));
        hatted_current(grid, plain, dt, J);
        Tensor R(grid);
        rotation_tensor(grid, B.all.data(), 0.5 * dt * p.q_p / p.m_p, R);
        apply_tensor(grid, R, J.all.data(), false, scratch, R_J.all.data());
        fill_ghosts(grid, electric, R_J);
        divergence_of_electric(grid, R_J.all.data(), div);
        mesh_errors.push_back(largest_inside(grid, after.rho - plain.rho + dt * div));
    }
    CHECK(std::fabs(errors[0] / errors[1] - 8) <= 0.1);
    CHECK(std::fabs(mesh_errors[0] / mesh_errors[1] - 2) <= 0.1);
    CHECK(errors[1] <= 0.01 * mesh_errors[1]);
}

TEST_CASE("continuity of the deposited moments holds to second order in dt") {
    // (rho^{n+1} - rho^n)/dt + div J^{n+1/2} with the predicted current, for a plasma in E and B.
    Random random;
    const Grid grid = meshes()[2];
    std::vector<double> errors;
    for (const double dt : {0.004, 0.002}) {
        Random same;
        Loaded plasma = any_plasma(grid, 1, 0.3, same);
        FieldState field(grid);
        any_state(grid, 0, 0.5, same, field);
        Particles& p = plasma.species[0];
        keep_off_kinks(grid, p);
        Moments before(grid), after(grid);
        deposit_moments(p, grid, field.B, dt, before);
        InterleavedField push(std::size_t(grid.size()));
        for (long n = 0; n < grid.size(); ++n) {
            push[std::size_t(n)] = {0, 0, 0, field.B.x()[n], field.B.y()[n], field.B.z()[n]};
        }
        move_particles(push, grid, dt, {1e-13, 100}, p);
        SortScratch sorted;
        sort_particles(grid, sorted, p);
        deposit_moments(p, grid, after);
        VectorField J(grid);
        Field div = Field::Zero(grid.size());
        hatted_current(grid, before, dt, J);
        divergence_of_electric(grid, J.all.data(), div);
        // Away from the walls, where paths are cut.
        double most = 0;
        for (long j = 3; j <= grid.z.cells - 3; ++j) {
            for (long i = 0; i < grid.x.cells; ++i) {
                const long n = grid.index(i, j);
                most = worst({most, std::fabs((after.rho[n] - before.rho[n]) / dt + div[n])});
            }
        }
        errors.push_back(most);
    }
    CHECK(std::fabs(errors[0] / errors[1] - 4) <= 0.1);
}
