// Facts about the solvers of linear and nonlinear systems: every ending of GMRES, of conjugate
// gradients and of Newton-Krylov is the documented one, and their answers agree with other methods.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/IterativeSolvers>

#include "common/gmres.hpp"
#include "common/least_squares.hpp"
#include "common/newton_krylov.hpp"
#include "flip/conjugate_gradients.hpp"
#include "tests/support/any_numbers.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using facts::Untrapped;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

auto times(const MatrixXd& A) {
    return [&A](const VectorXd& v, VectorXd& w) { w = A * v; };
}

// A diagonally dominant nonsymmetric matrix, different for every seed.
MatrixXd random_matrix(int n, unsigned seed) {
    std::srand(seed);
    MatrixXd A = MatrixXd::Random(n, n);
    A.diagonal().array() += 3.0 * std::sqrt(double(n));
    return A;
}

// GMRES without a preconditioner and without a workspace that is kept.
template <class Operator>
common::KrylovResult gmres(const Operator& apply, const VectorXd& b, VectorXd& x, double tolerance,
                           int max_iterations, int restart) {
    common::GmresWorkspace work;
    const auto leave = [](const VectorXd& v, VectorXd& w) { w = v; };
    return common::gmres(apply, leave, b, x, tolerance, max_iterations, restart, work);
}

// Newton and Krylov in the same way.
template <class Residual>
common::NewtonResult newton_krylov(const Residual& residual, VectorXd& x, double scale,
                                   double tolerance, int max_newton, int max_linear) {
    common::NewtonWorkspace work;
    const auto leave = [](const VectorXd& v, VectorXd& w) { w = v; };
    return common::newton_krylov(residual, leave, x, scale, tolerance, max_newton, max_linear,
                                 work);
}

double true_residual(const MatrixXd& A, const VectorXd& x, const VectorXd& b) {
    return (b - A * x).norm() / b.norm();
}

}  // namespace

TEST_CASE("GMRES agrees with dense LU and with BiCGSTAB and GMRES of Eigen") {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const MatrixXd A = random_matrix(80, seed);
        const VectorXd b = VectorXd::Random(80);
        const VectorXd exact = A.partialPivLu().solve(b);
        VectorXd x = VectorXd::Zero(80);
        const auto result = gmres(times(A), b, x, 1e-12, 400, 40);
        CHECK(result.converged);
        CHECK((x - exact).norm() <= 1e-10 * exact.norm());
        CHECK(std::abs(result.residual - true_residual(A, x, b)) <= 1e-14);

        const Eigen::SparseMatrix<double> sparse = A.sparseView();
        Eigen::BiCGSTAB<Eigen::SparseMatrix<double>> bicgstab(sparse);
        bicgstab.setTolerance(1e-12);
        CHECK((x - bicgstab.solve(b)).norm() <= 1e-10 * exact.norm());
        Eigen::GMRES<Eigen::SparseMatrix<double>, Eigen::IdentityPreconditioner> theirs(sparse);
        theirs.setTolerance(1e-12);
        theirs.set_restart(40);
        CHECK((x - theirs.solve(b)).norm() <= 1e-10 * exact.norm());
        CHECK(std::abs(result.iterations - int(theirs.iterations())) <= 2);
    }
}

TEST_CASE("GMRES ends within as many iterations as there are distinct eigenvalues") {
    VectorXd d(60);
    for (int i = 0; i < 60; ++i) d[i] = 1.0 + i % 4;
    const MatrixXd A = d.asDiagonal();
    VectorXd x = VectorXd::Zero(60);
    const auto result = gmres(times(A), VectorXd::Ones(60), x, 1e-13, 100, 30);
    CHECK(result.converged);
    CHECK(result.iterations == 4);
}

TEST_CASE("GMRES with an exact preconditioner needs one iteration") {
    const MatrixXd A = random_matrix(50, 7);
    const auto lu = A.partialPivLu();
    const auto exact = [&](const VectorXd& v, VectorXd& w) { w = lu.solve(v); };
    const VectorXd b = VectorXd::Random(50);
    VectorXd x = VectorXd::Zero(50);
    common::GmresWorkspace work;
    const auto result = common::gmres(times(A), exact, b, x, 1e-12, 100, 30, work);
    CHECK(result.converged);
    CHECK(result.iterations == 1);
    CHECK(true_residual(A, x, b) <= 1e-12);
}

TEST_CASE("GMRES never needs fewer iterations with a shorter restart") {
    const MatrixXd A = random_matrix(120, 3);
    const VectorXd b = VectorXd::Random(120);
    int before = 0;
    for (const int restart : {120, 12, 6, 3, 1}) {
        VectorXd x = VectorXd::Zero(120);
        const auto result = gmres(times(A), b, x, 1e-10, 2000, restart);
        CHECK(result.converged);
        CHECK(result.reason == "converged");
        CHECK(result.residual <= 1e-10);
        CHECK(result.iterations >= before);
        before = result.iterations;
    }
}

TEST_CASE("GMRES with a kept workspace repeats its answer bit for bit") {
    const MatrixXd A = random_matrix(90, 5);
    const auto leave = [](const VectorXd& v, VectorXd& w) { w = v; };
    const VectorXd b = VectorXd::Random(90), other = VectorXd::Random(90);
    common::GmresWorkspace work;
    VectorXd first = VectorXd::Zero(90), between = other, second = VectorXd::Zero(90);
    common::gmres(times(A), leave, b, first, 1e-9, 60, 20, work);
    common::gmres(times(A), leave, other, between, 1e-9, 60, 20, work);
    common::gmres(times(A), leave, b, second, 1e-9, 60, 20, work);
    CHECK((first.array() == second.array()).all());
}

TEST_CASE("GMRES solves for a vector of components with the same bits on any number of threads") {
    // A chain of 9000 or 9001 points; the components are how its parts are dealt, and change round-off alone.
    const auto chain = [](const VectorXd& v, VectorXd& w) {
        const long n = v.size();
        w = 4 * v;
        w.head(n - 1) -= v.tail(n - 1);
        w.tail(n - 1) -= 1.5 * v.head(n - 1);
    };
    const auto leave = [](const VectorXd& v, VectorXd& w) { w = v; };
    const int before = common::thread_count();
    for (const long n : {9000L, 9001L}) {
        const VectorXd b = VectorXd::Random(n);
        VectorXd plain = VectorXd::Zero(n);
        CHECK(gmres(chain, b, plain, 1e-12, 100, 40).converged);
        VectorXd first;
        for (const int threads : {1, 2, 5}) {
            common::set_thread_count(threads);
            common::GmresWorkspace work;
            work.components = 3;
            VectorXd x = VectorXd::Zero(n), left(n);
            CHECK(common::gmres(chain, leave, b, x, 1e-12, 100, 40, work).converged);
            chain(x, left);
            CHECK((left - b).norm() <= 1.01e-12 * b.norm());
            CHECK((x - plain).norm() <= 1e-11 * plain.norm());
            if (threads == 1) first = x;
            CHECK((x.array() == first.array()).all());
        }
        common::set_thread_count(before);
    }
}

TEST_CASE("GMRES returns zero for a zero right-hand side whatever the guess") {
    const MatrixXd A = random_matrix(20, 1);
    VectorXd x = VectorXd::Random(20);
    const auto result = gmres(times(A), VectorXd::Zero(20), x, 1e-10, 100, 10);
    CHECK(result.converged);
    CHECK(result.iterations == 0);
    CHECK(result.residual == 0.0);
    CHECK(x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() == 0.0);
}

TEST_CASE("GMRES leaves a good enough guess untouched") {
    const MatrixXd A = random_matrix(40, 2);
    const VectorXd b = VectorXd::Random(40);
    VectorXd x = A.partialPivLu().solve(b);
    const VectorXd guess = x;
    const auto result = gmres(times(A), b, x, 1e-10, 100, 10);
    CHECK(result.converged);
    CHECK(result.iterations == 0);
    CHECK((x.array() == guess.array()).all());
}

TEST_CASE("GMRES takes a lucky breakdown for success") {
    MatrixXd A = MatrixXd::Identity(30, 30);
    A.topLeftCorner(3, 3) << 2, 1, 0, 0, 3, 1, 1, 0, 4;
    VectorXd b = VectorXd::Zero(30), x = VectorXd::Zero(30);
    b.head(3) << 1, 2, 3;
    const auto result = gmres(times(A), b, x, 1e-14, 100, 30);
    CHECK(result.converged);
    CHECK(result.iterations <= 3);
    CHECK(true_residual(A, x, b) <= 1e-14);
}

TEST_CASE("GMRES reports a zero operator and keeps a finite solution") {
    const MatrixXd A = MatrixXd::Zero(10, 10);
    VectorXd x = VectorXd::Ones(10);
    const auto result = gmres(times(A), VectorXd::Ones(10), x, 1e-8, 100, 10);
    CHECK_FALSE(result.converged);
    CHECK(result.residual == 1.0);
    CHECK(x.allFinite());
    CHECK(result.reason == "the operator is singular");
}

TEST_CASE("GMRES reports a singular system that has no solution") {
    VectorXd d = VectorXd::LinSpaced(12, 1.0, 2.0);
    d[5] = 0.0;
    const MatrixXd A = d.asDiagonal();
    const VectorXd b = VectorXd::Ones(12);
    VectorXd x = VectorXd::Zero(12);
    const auto result = gmres(times(A), b, x, 1e-8, 500, 30);
    CHECK_FALSE(result.converged);
    CHECK(x.allFinite());
    CHECK(x.norm() <= 1e3);
    CHECK(result.residual >= 1.0 / std::sqrt(12.0) - 1e-12);
    CHECK(result.residual <= 1.0);
}

TEST_CASE("GMRES solves a singular system whose right-hand side can be reached") {
    VectorXd d = VectorXd::LinSpaced(12, 1.0, 2.0), b = VectorXd::Ones(12);
    d[5] = b[5] = 0.0;
    const MatrixXd A = d.asDiagonal();
    VectorXd x = VectorXd::Zero(12);
    const auto result = gmres(times(A), b, x, 1e-12, 100, 30);
    CHECK(result.converged);
    CHECK(true_residual(A, x, b) <= 1e-12);
}

TEST_CASE("GMRES stops at once when the right-hand side or the guess is not finite") {
    const facts::Untrapped calm;
    const MatrixXd A = random_matrix(10, 4);
    for (const double bad : {not_a_number, infinity, -infinity}) {
        VectorXd b = VectorXd::Ones(10), x = VectorXd::Ones(10);
        b[3] = bad;
        auto result = gmres(times(A), b, x, 1e-8, 1000, 10);
        CHECK_FALSE(result.converged);
        CHECK(result.iterations == 0);
        CHECK((x.array() == 1.0).all());
        b[3] = 1.0;
        x[7] = bad;
        result = gmres(times(A), b, x, 1e-8, 1000, 10);
        CHECK_FALSE(result.converged);
        CHECK(result.iterations == 0);
        CHECK(x.allFinite());
    }
}

TEST_CASE("GMRES stops at once when the operator or the preconditioner is not finite") {
    const facts::Untrapped calm;
    const MatrixXd A = random_matrix(40, 6);
    const VectorXd b = VectorXd::Ones(40);
    for (const int last : {0, 1, 3}) {
        int calls = 0;
        const auto fails = [&](const VectorXd& v, VectorXd& w) {
            w = A * v;
            if (calls++ >= last) w[9] = not_a_number;
        };
        VectorXd x = VectorXd::Zero(40);
        const auto result = gmres(fails, b, x, 1e-12, 1000, 10);
        CHECK_FALSE(result.converged);
        CHECK(result.iterations == last + 1);
        CHECK(x.allFinite());

        common::GmresWorkspace work;
        calls = 0;
        x.setZero();
        const auto other = common::gmres(times(A), fails, b, x, 1e-12, 1000, 10, work);
        CHECK_FALSE(other.converged);
        CHECK(other.iterations == last + 1);
        CHECK(x.allFinite());
    }
}

TEST_CASE("GMRES survives numbers whose squares overflow or underflow") {
    const facts::Untrapped calm;
    const MatrixXd A = random_matrix(30, 8);
    const VectorXd b = VectorXd::Random(30);
    VectorXd plain = VectorXd::Zero(30);
    const auto expected = gmres(times(A), b, plain, 1e-10, 100, 30);
    for (const double factor : {1e160, 1e-200}) {
        const VectorXd scaled = factor * b;
        VectorXd x = VectorXd::Zero(30);
        const auto result = gmres(times(A), scaled, x, 1e-10, 100, 30);
        CHECK(result.converged);
        CHECK(result.iterations == expected.iterations);
        CHECK((x / factor - plain).norm() <= 1e-9 * plain.norm());

        const MatrixXd large = factor * A;
        x.setZero();
        const auto other = gmres(times(large), b, x, 1e-10, 100, 30);
        CHECK(other.converged);
        CHECK((x * factor - plain).norm() <= 1e-9 * plain.norm());
    }
    const MatrixXd too_large = 1e308 * A;
    VectorXd x = VectorXd::Zero(30);
    const auto result = gmres(times(too_large), b, x, 1e-10, 100, 30);
    CHECK_FALSE(result.converged);
    CHECK(x.allFinite());
}

TEST_CASE("GMRES without convergence returns the best solution and its true residual") {
    const MatrixXd A = random_matrix(100, 9);
    const VectorXd b = VectorXd::Random(100);
    double before = 1.0;
    for (const int limit : {0, 1, 2, 5, 9}) {
        VectorXd x = VectorXd::Zero(100);
        const auto result = gmres(times(A), b, x, 1e-14, limit, 30);
        CHECK_FALSE(result.converged);
        CHECK(result.iterations == limit);
        CHECK(result.residual <= before);
        CHECK(std::abs(result.residual - true_residual(A, x, b)) <= 1e-14);
        before = result.residual;
    }
}

TEST_CASE("GMRES reports the stagnation of a cyclic shift and solves it with a full space") {
    MatrixXd A = MatrixXd::Zero(20, 20);
    for (int i = 0; i < 20; ++i) A(i, (i + 1) % 20) = 1.0;
    VectorXd b = VectorXd::Zero(20), x = VectorXd::Zero(20);
    b[0] = 1.0;
    const auto shorter = gmres(times(A), b, x, 1e-10, 10000, 10);
    CHECK_FALSE(shorter.converged);
    CHECK(shorter.iterations == 10);
    const auto full = gmres(times(A), b, x, 1e-10, 10000, 20);
    CHECK(full.converged);
    CHECK(full.iterations == 20);
}

TEST_CASE("Newton converges quadratically on a smooth problem") {
    // x_i + x_i^3 / 3 + (x_i-1 + x_i+1) / 10 = c_i, with a known solution.
    constexpr int n = 40;
    VectorXd solution(n), c(n);
    for (int i = 0; i < n; ++i) solution[i] = std::sin(0.7 * i);
    const auto left_side = [](const VectorXd& x, VectorXd& F) {
        F = x.array() + x.array().cube() / 3.0;
        for (int i = 0; i < n; ++i) F[i] += 0.1 * (x[(i + 1) % n] + x[(i + n - 1) % n]);
    };
    left_side(solution, c);
    const auto residual = [&](const VectorXd& x, VectorXd& F) {
        left_side(x, F);
        F -= c;
    };
    const auto leave = [](const VectorXd& v, VectorXd& w) { w = v; };
    common::NewtonWorkspace work;
    common::NewtonOptions options;
    options.first_forcing = options.largest_forcing = options.smallest_forcing = 1e-7;

    // Take the steps one at a time and watch the error.
    VectorXd x = solution.array() + 0.3;
    double error = (x - solution).norm();
    for (int step = 0; step < 3; ++step) {
        const auto result =
            common::newton_krylov(residual, leave, x, 1.0, 1e-300, 1, 100, work, options);
        CHECK(result.newton_iterations == 1);
        const double after = (x - solution).norm();
        CHECK(after <= 0.5 * error * error + 1e-7 * error);
        error = after;
    }
    CHECK(error <= 1e-5);

    x = VectorXd::Zero(n);
    const auto result = newton_krylov(residual, x, c.norm(), 1e-12, 20, 100);
    CHECK(result.converged);
    CHECK(result.newton_iterations <= 7);
    CHECK((x - solution).norm() <= 1e-11 * solution.norm());
}

TEST_CASE("Newton shortens its steps where the full step diverges") {
    // Newton on arctan diverges from |x| > 1.3917.
    const auto residual = [](const VectorXd& x, VectorXd& F) { F = x.array().atan(); };
    VectorXd x(2);
    x << 10.0, -3.0;
    const auto result = newton_krylov(residual, x, 1.0, 1e-12, 30, 10);
    CHECK(result.converged);
    CHECK(x.norm() <= 1e-11);
}

TEST_CASE("Newton leaves a good enough guess untouched") {
    const auto residual = [](const VectorXd& x, VectorXd& F) { F = x.array().square() - 4.0; };
    VectorXd x = VectorXd::Constant(5, 2.0);
    const auto result = newton_krylov(residual, x, 1.0, 1e-12, 30, 10);
    CHECK(result.converged);
    CHECK(result.newton_iterations == 0);
    CHECK(result.linear_iterations == 0);
    CHECK((x.array() == 2.0).all());
}

TEST_CASE("Newton stops at once when the residual of the guess is not finite") {
    const facts::Untrapped calm;
    const auto residual = [](const VectorXd& x, VectorXd& F) { F = x.array().log(); };
    VectorXd x = VectorXd::Constant(3, -1.0);
    for (const double scale : {1.0, std::nan("")}) {
        const auto result = newton_krylov(residual, x, scale, 1e-12, 30, 10);
        CHECK_FALSE(result.converged);
        CHECK(result.newton_iterations == 0);
        CHECK((x.array() == -1.0).all());
    }
}

TEST_CASE("Newton steps back from where the residual is not finite") {
    const facts::Untrapped calm;
    // From x = 4 the full step for log x = 0 leads to a negative x.
    const auto residual = [](const VectorXd& x, VectorXd& F) { F = x.array().log(); };
    VectorXd x = VectorXd::Constant(3, 4.0);
    const auto result = newton_krylov(residual, x, 1.0, 1e-12, 30, 10);
    CHECK(result.converged);
    CHECK((x.array() - 1.0).abs().maxCoeff<Eigen::PropagateNaN>() <= 1e-11);
}

TEST_CASE("Newton reports a problem without solution and keeps a finite point") {
    const auto residual = [](const VectorXd& x, VectorXd& F) { F = x.array().square() + 1.0; };
    VectorXd x = VectorXd::Constant(3, 0.7);
    const auto result = newton_krylov(residual, x, 1.0, 1e-10, 50, 10);
    CHECK_FALSE(result.converged);
    CHECK(x.allFinite());
    CHECK(result.residual >= std::sqrt(3.0));
    CHECK(result.residual <= std::sqrt(3.0) * (0.49 + 1.0));
}

TEST_CASE("Newton reports the limit of its steps with the true residual") {
    const auto residual = [](const VectorXd& x, VectorXd& F) { F = x.array().cube() - 8.0; };
    VectorXd x = VectorXd::Constant(4, 20.0), F(4);
    const auto result = newton_krylov(residual, x, 2.0, 1e-12, 2, 10);
    CHECK_FALSE(result.converged);
    CHECK(result.newton_iterations == 2);
    residual(x, F);
    CHECK(std::abs(result.residual - F.norm() / 2.0) <= 1e-12 * result.residual);
}

// ---- conjugate gradients -----------------------------------------------------------------------

namespace {

// Symmetric positive definite with a condition number of about `condition`.
MatrixXd definite_matrix(int n, unsigned seed, double condition) {
    std::srand(seed);
    const MatrixXd Q = MatrixXd::Random(n, n).householderQr().householderQ();
    VectorXd d(n);
    for (int i = 0; i < n; ++i) d[i] = std::pow(condition, double(i) / (n - 1));
    const MatrixXd A = Q * d.asDiagonal() * Q.transpose();
    return 0.5 * (A + A.transpose());
}

}  // namespace

TEST_CASE("conjugate gradients agree with Cholesky and with those of Eigen") {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const MatrixXd A = definite_matrix(60, seed, 100);
        const VectorXd b = VectorXd::Random(60), exact = A.llt().solve(b);
        VectorXd x = VectorXd::Zero(60);
        const auto result = flip::conjugate_gradients(times(A), b, x, 1e-12, 400);
        CHECK(result.converged);
        CHECK((x - exact).norm() <= 1e-10 * exact.norm());
        CHECK(std::abs(result.residual - true_residual(A, x, b)) <= 1e-14);
        const Eigen::SparseMatrix<double> sparse = A.sparseView();
        Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper,
                                 Eigen::IdentityPreconditioner>
            theirs(sparse);
        theirs.setTolerance(1e-12);
        CHECK((x - theirs.solve(b)).norm() <= 1e-10 * exact.norm());
        CHECK(std::abs(result.iterations - int(theirs.iterations())) <= 2);
    }
}

TEST_CASE("conjugate gradients end within as many iterations as there are distinct eigenvalues") {
    VectorXd d(60);
    for (int i = 0; i < 60; ++i) d[i] = 1.0 + i % 4;
    const MatrixXd A = d.asDiagonal();
    VectorXd x = VectorXd::Zero(60);
    const auto result = flip::conjugate_gradients(times(A), VectorXd::Ones(60), x, 1e-13, 100);
    CHECK(result.converged);
    CHECK(result.iterations == 4);

    const auto exact = [&](const VectorXd& v, VectorXd& w) { w = v.cwiseQuotient(d); };
    VectorXd y = VectorXd::Zero(60);
    const auto once =
        flip::conjugate_gradients(times(A), exact, VectorXd::Random(60), y, 1e-13, 100);
    CHECK(once.converged);
    CHECK(once.iterations == 1);
}

TEST_CASE("conjugate gradients return zero for a zero right-hand side whatever the guess") {
    const MatrixXd A = definite_matrix(20, 1, 10);
    VectorXd x = VectorXd::Random(20);
    const auto result = flip::conjugate_gradients(times(A), VectorXd::Zero(20), x, 1e-10, 100);
    CHECK(result.converged);
    CHECK(result.iterations == 0);
    CHECK(result.residual == 0.0);
    CHECK(x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() == 0.0);
    VectorXd none;
    CHECK(flip::conjugate_gradients(times(A), VectorXd(), none, 1e-10, 100).converged);
}

TEST_CASE("conjugate gradients leave a good enough guess untouched") {
    const MatrixXd A = definite_matrix(40, 2, 10);
    const VectorXd b = VectorXd::Random(40);
    VectorXd x = A.llt().solve(b);
    const VectorXd guess = x;
    const auto result = flip::conjugate_gradients(times(A), b, x, 1e-10, 100);
    CHECK(result.converged);
    CHECK(result.iterations == 0);
    CHECK((x.array() == guess.array()).all());
    // The exact one: every residual is zero, and no tolerance is too small.
    const MatrixXd one = MatrixXd::Identity(40, 40);
    VectorXd same = b;
    CHECK(flip::conjugate_gradients(times(one), b, same, 0, 100).iterations == 0);
    CHECK((same.array() == b.array()).all());
}

TEST_CASE("conjugate gradients report what round-off does not let them reach") {
    const MatrixXd A = definite_matrix(50, 4, 1e12);
    VectorXd x = VectorXd::Zero(50);
    const auto result = flip::conjugate_gradients(times(A), VectorXd::Random(50), x, 1e-16, 100000);
    CHECK_FALSE(result.converged);
    CHECK(x.allFinite());
    CHECK(result.iterations < 100000);
    CHECK(result.reason == "round-off keeps the residual from falling further");
}

TEST_CASE("conjugate gradients report an operator or preconditioner that is not positive") {
    const VectorXd b = VectorXd::Ones(12);
    struct Row {
        double last;  // eigenvalue
        std::string reason;
    };
    for (const Row& row :
         {Row{0, "the operator is singular"}, Row{-1, "the operator is not positive definite"}}) {
        VectorXd d = VectorXd::LinSpaced(12, 1, 2);
        d[11] = row.last;
        const MatrixXd A = d.asDiagonal();
        VectorXd x = VectorXd::Zero(12);
        const auto result = flip::conjugate_gradients(times(A), b, x, 1e-10, 100);
        CHECK_FALSE(result.converged);
        CHECK(result.reason == row.reason);
        CHECK(x.allFinite());
        CHECK(std::abs(result.residual - true_residual(A, x, b)) <= 1e-14);
        CHECK(result.residual <= 1);
    }
    const MatrixXd zero = MatrixXd::Zero(12, 12), one = MatrixXd::Identity(12, 12);
    VectorXd x = VectorXd::Zero(12);
    auto result = flip::conjugate_gradients(times(zero), b, x, 1e-10, 100);
    CHECK(result.reason == "the operator is not positive definite");
    CHECK(x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() == 0.0);
    for (const double factor : {0.0, -1.0}) {
        const auto wrong = [&](const VectorXd& v, VectorXd& w) { w = factor * v; };
        result = flip::conjugate_gradients(times(one), wrong, b, x, 1e-10, 100);
        CHECK(result.reason == "the preconditioner is not positive definite");
        CHECK(x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() == 0.0);
    }
}

TEST_CASE("conjugate gradients solve a singular system whose right-hand side can be reached") {
    VectorXd d = VectorXd::LinSpaced(12, 1, 2), b = VectorXd::Ones(12);
    d[4] = b[4] = 0;
    const MatrixXd A = d.asDiagonal();
    VectorXd x = VectorXd::Zero(12);
    CHECK(flip::conjugate_gradients(times(A), b, x, 1e-13, 100).converged);
    CHECK((A * x - b).norm() <= 1e-13 * b.norm());
}

TEST_CASE("conjugate gradients stop where a number is not finite") {
    const Untrapped calm;
    const MatrixXd A = definite_matrix(15, 3, 10);
    for (const double bad : {not_a_number, infinity}) {
        VectorXd b = VectorXd::Ones(15), x = VectorXd::Zero(15);
        b[7] = bad;
        auto result = flip::conjugate_gradients(times(A), b, x, 1e-10, 100);
        CHECK_FALSE(result.converged);
        CHECK(result.reason == "the right-hand side is not finite");
        b[7] = 1, x[3] = bad;
        result = flip::conjugate_gradients(times(A), b, x, 1e-10, 100);
        CHECK(result.reason == "the initial guess is not finite");
        CHECK(x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() == 0.0);
        for (const int sound_calls : {0, 1, 4}) {
            int calls = 0;
            const auto breaks = [&](const VectorXd& v, VectorXd& w) {
                w = A * v;
                if (calls++ >= sound_calls) w[2] = bad;
            };
            x = VectorXd::Zero(15);
            result = flip::conjugate_gradients(breaks, b, x, 1e-10, 100);
            CHECK_FALSE(result.converged);
            CHECK(result.reason == "the operator is not finite");
            CHECK(result.iterations <= sound_calls + 1);
            CHECK(x.allFinite());
            calls = 0, x = VectorXd::Zero(15);
            result = flip::conjugate_gradients(times(A), breaks, b, x, 1e-10, 100);
            CHECK_FALSE(result.converged);
            CHECK(result.reason == "the preconditioner is not finite");
            CHECK(x.allFinite());
        }
    }
}

TEST_CASE("conjugate gradients do not notice the size of the right-hand side") {
    const MatrixXd A = definite_matrix(25, 5, 50);
    const VectorXd b = VectorXd::Random(25);
    VectorXd x = VectorXd::Zero(25);
    flip::conjugate_gradients(times(A), b, x, 1e-12, 200);
    for (const int power : {-900, -500, 500, 900}) {
        const double factor = std::ldexp(1.0, power);
        VectorXd y = VectorXd::Zero(25);
        const auto result = flip::conjugate_gradients(times(A), factor * b, y, 1e-12, 200);
        CHECK(result.converged);
        CHECK((y.array() / factor == x.array()).all());
    }
}

TEST_CASE("conjugate gradients without convergence return the true residual") {
    const MatrixXd A = definite_matrix(80, 6, 1e4);
    const VectorXd b = VectorXd::Random(80);
    VectorXd x = VectorXd::Zero(80);
    const auto result = flip::conjugate_gradients(times(A), b, x, 1e-12, 40);
    CHECK_FALSE(result.converged);
    CHECK(result.iterations == 40);
    CHECK(result.reason == "the limit of iterations is reached");
    CHECK(std::abs(result.residual - true_residual(A, x, b)) <= 1e-13);
}

TEST_CASE("Anderson's acceleration solves a linear iteration in as many rounds as it has unknowns" *
          doctest::description("unit")) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        constexpr int n = 6;
        const MatrixXd A = random_matrix(n, seed);  // x <- A x + b itself runs away
        const VectorXd b = VectorXd::Random(n),
                       exact = (MatrixXd::Identity(n, n) - A).lu().solve(b);
        VectorXd x = VectorXd::Zero(n);
        common::AndersonAcceleration acceleration;
        for (int round = 0; round <= n; ++round) acceleration.next(A * x + b - x, x);
        CHECK((x - exact).norm() <= 1e-9 * exact.norm());
        acceleration = {};  // begins anew, with another number of unknowns
        VectorXd y = VectorXd::Zero(2);
        for (int round = 0; round <= 2; ++round) acceleration.next(VectorXd::Constant(2, 3) - y, y);
        CHECK((y - VectorXd::Constant(2, 3)).norm() <= 1e-12);
    }
}
