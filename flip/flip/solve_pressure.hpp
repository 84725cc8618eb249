// on the mesh: the pressure at the level theta, for all flow speeds. The time step then knows the
// flow and not the sound.
//
//     v^L = v* + (dt/m) D^T p^theta            v*: with every force but the pressure
//     p^theta = p^n - theta dt (K/V) D v^theta   K = rho c^2,  v^theta = (1 - theta) v^0 + theta v^L
//
// with D v = V div v on the cells (dilation) and D^T p the force on the nodes (pressure_force).
// Eliminating v^L leaves a symmetric positive definite system for the change of pressure,
//     [V/K + theta^2 dt^2 D M^-1 D^T] (p^theta - p^n) = -theta dt D v^theta(p^n).
// For slow flow the compliance V/K is nothing beside the rest, and what remains is the projection of
// an incompressible fluid. The matrix is assembled node by node, because M is diagonal: a node
// couples the four cells around it, and a cell so meets its eight neighbors.
//
//     2 | 3      cells 0 to 3 around a node o; a pressure p of cell 0 pushes it with
//     --o--      p dz/2 along x and p dx/2 along z, of cell 3 with the opposite; in rings, times
//     0 | 1      their lengths; a component that a boundary gives is not pushed at all
#pragma once

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <limits>
#include <vector>

#include "common/run/sentence.hpp"
#include "flip/conjugate_gradients.hpp"
#include "flip/flip/accelerate_nodes.hpp"
#include "flip/state.hpp"

namespace flip {

namespace detail {

// One column of D^T: the four cells around a node, and the force of a unit pressure in each.
struct NodeStencil {
    std::array<long, 4> cell;    // index, or -1: none, or one without pressure
    std::array<double, 4> x, z;  // force per pressure; 0 where a boundary gives the velocity
};

inline NodeStencil stencil_at(const Problem& problem, const Cells& c, long i, long j) {
    const Grid& grid = problem.grid;
    NodeStencil stencil;
    const Held held = held_at(grid, problem.boundaries, i, j);
    const auto inside = [](const common::Axis& axis, long cell) {
        return axis.periodic ? (cell + axis.cells) % axis.cells
                             : (cell < 0 || cell >= axis.cells ? -1 : cell);
    };
    std::size_t k = 0;
    for (const long b : {j - 1, j}) {
        for (const long a : {i - 1, i}) {
            const long ia = inside(grid.x, a), jb = inside(grid.z, b);
            const long n = ia < 0 || jb < 0 ? -1 : grid.index(ia, jb);
            stencil.cell[k] = n >= 0 && c.M[n] > 0 && c.surface[n] == 0 ? n : -1;
            const double node = double(i), side = a < i ? -1. / 3 : 1. / 3;
            stencil.x[k] =
                held.x ? 0 : (a < i ? 0.5 : -0.5) * grid.z.spacing() * ring_length(grid, node);
            stencil.z[k] =
                held.z ? 0
                       : (b < j ? 0.5 : -0.5) * grid.x.spacing() * ring_length(grid, node + side);
            ++k;
        }
    }
    return stencil;
}

// Calls visit(stencil, theta^2 dt^2/m) for every node that has mass.
template <class Visit>
void for_each_stencil(const Problem& problem, double dt, const Mesh& mesh, const Visit& visit) {
    const double theta = problem.scheme.theta;
    for_own_nodes(problem.grid, [&](long i, long j, long n) {
        const double m = mesh.nodes.m[n];
        if (m > 0) visit(stencil_at(problem, mesh.cells, i, j), theta * theta * dt * dt / m);
    });
}

// The cells that have a pressure, numbered.
struct PressureCells {
    std::vector<long> index;  // of each one on the mesh
    std::vector<int> number;  // of each cell of the mesh, -1: none
    long count() const { return long(index.size()); }
};

// Leaves out cells without pressure, and those so compressible that all which the change of their
// pressure does to the velocity is round-off: (theta^2 dt^2 D M^-1 D^T)_cc below V/K by that much.
// There p = p^n, and their weight in the sums of conjugate gradients would be none.
inline PressureCells number_cells(const Problem& problem, double dt, const Mesh& mesh) {
    const Grid& grid = problem.grid;
    const Cells& c = mesh.cells;
    Field response = Field::Zero(grid.size());
    for_each_stencil(problem, dt, mesh, [&](const NodeStencil& at, double factor) {
        for (std::size_t k = 0; k < 4; ++k)
            if (at.cell[k] >= 0)
                response[at.cell[k]] += factor * (at.x[k] * at.x[k] + at.z[k] * at.z[k]);
    });
    constexpr double round_off = std::numeric_limits<double>::epsilon();
    PressureCells cells;
    cells.number.assign(grid.size(), -1);
    for (long j = 0; j < grid.z.cells; ++j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const long n = grid.index(i, j);
            const double inertia = cell_volume(grid, i) * c.compressibility[n];
            if (c.M[n] <= 0 || c.surface[n] != 0 || inertia <= 0 ||
                response[n] <= round_off * inertia)
                continue;
            cells.number[n] = int(cells.count());
            cells.index.push_back(n);
        }
    }
    return cells;
}

// The matrix V/K + theta^2 dt^2 D M^-1 D^T, its lower half: V/K on the diagonal, and every node
// couples the cells around it.
inline Eigen::SparseMatrix<double> pressure_matrix(const Problem& problem, double dt,
                                                   const Mesh& mesh, const PressureCells& cells,
                                                   const Eigen::VectorXd& inertia) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(17 * cells.index.size());
    for (int r = 0; r < cells.count(); ++r) entries.emplace_back(r, r, inertia[r]);
    for_each_stencil(problem, dt, mesh, [&](const NodeStencil& at, double factor) {
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b) {
                if (at.cell[a] < 0 || at.cell[b] < 0) continue;
                const int row = cells.number[at.cell[a]], column = cells.number[at.cell[b]];
                if (row >= column && column >= 0)
                    entries.emplace_back(row, column,
                                         factor * (at.x[a] * at.x[b] + at.z[a] * at.z[b]));
            }
        }
    });
    Eigen::SparseMatrix<double> A(cells.count(), cells.count());
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

// Solves A x = load by conjugate gradients, from x = 0; of the symmetric A the lower half is given.
// Preconditioned with z = S F^-1 S r, F the incomplete Cholesky factors of S A S and
// S = 1/sqrt(diagonal of A). A cell that is nearly empty, or nearly without pressure, gives A
// entries hundreds of orders of magnitude beyond the others, whose squares no number holds; S A S
// has ones on its diagonal. Without factors the preconditioner is the diagonal.
inline common::KrylovResult solve_cells(const Eigen::SparseMatrix<double>& A,
                                        const Eigen::VectorXd& load, double tolerance,
                                        long max_iterations, Eigen::VectorXd& x) {
    const auto multiply = [&A](const Eigen::VectorXd& v, Eigen::VectorXd& Av) {
        Av.noalias() = A.selfadjointView<Eigen::Lower>() * v;
    };
    const Eigen::VectorXd S = A.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SparseMatrix<double> scaled = S.asDiagonal() * A * S.asDiagonal();
    const Eigen::IncompleteCholesky<double> factors(scaled);
    const auto precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
        z = S.cwiseProduct(r);
        if (factors.info() == Eigen::Success) z = factors.solve(z).eval();
        z = S.cwiseProduct(z);
    };
    x.setZero(load.size());
    return conjugate_gradients(multiply, precondition, load, x, tolerance, max_iterations);
}

}  // namespace detail

/// Solves for the pressure at the level theta.
/// in:     cells.p, compressibility, surface; known forces; nodes.vx0, vz0
/// out:    cells.p_step = p^theta, 0 where there is no fluid or no pressure; nodes.vxL, vzL with it;
///         the iterations, and what they leave of the divergence
/// errors: NumericalError when conjugate gradients do not reach the tolerance, which is relative to
///         a divergence of speed/dx in every cell
/// exact:  sound is multiplied by sqrt((1 + (1-theta)^2 a^2)/(1 + theta^2 a^2)) per step, a = c k dt,
///         never more than 1
/// source: the idea is ICE's: Harlow and Amsden, J. Comput. Phys. 8, 197 (1971).
inline StepReport solve_pressure(const Problem& problem, double dt, Mesh& mesh) {
    const Grid& grid = problem.grid;
    const Scheme& scheme = problem.scheme;
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    const double theta = scheme.theta;
    const detail::PressureCells cells = detail::number_cells(problem, dt, mesh);
    const long count = cells.count();

    // The velocity at the level theta if the pressure did not change; its divergence is the load.
    c.p_step = c.p;
    accelerate_nodes(problem, dt, mesh);
    if (count == 0) return {};
    Field vx, vz;
    const auto find_v_theta = [&] {
        vx = (1 - theta) * g.vx0 + theta * g.vxL;
        vz = (1 - theta) * g.vz0 + theta * g.vzL;
    };
    find_v_theta();
    Eigen::VectorXd load(count), inertia(count);
    for (long r = 0; r < count; ++r) {
        const long n = cells.index[r];
        inertia[r] = cell_volume(grid, column_of(grid, n)) * c.compressibility[n];
        load[r] = -theta * dt * dilation(grid, vx, vz, n);
    }

    // Conjugate gradients for the change of pressure.
    double speed = 0;
    for_own_nodes(grid,
                  [&](long, long, long n) { speed = std::max(speed, std::hypot(vx[n], vz[n])); });
    const double h = is_plane(grid) ? std::sqrt(grid.cell_area()) : grid.x.spacing(),
                 V = cell_volume(grid, grid.x.cells / 2),
                 scale = theta * dt * V * speed / h * std::sqrt(double(count));
    if (!(load.norm() > scheme.tolerance * scale))
        return {0, load.norm() / std::max(scale, 1e-300)};
    const auto A = detail::pressure_matrix(problem, dt, mesh, cells, inertia);
    const double tolerance = std::min(1.0, scheme.tolerance * scale / load.norm());
    Eigen::VectorXd change;
    const common::KrylovResult solved =
        detail::solve_cells(A, load, tolerance, scheme.max_iterations, change);
    if (!solved.converged)
        common::fail("the implicit pressure has not converged: ", solved.reason, "; after ",
                     solved.iterations, " iterations the residual is ", solved.residual,
                     " and not ", tolerance, "; raise flip.max_iterations or reduce time.cfl");
    // The change acts by itself: the sum is rounded to a part of p, which would push a light fluid.
    c.p_step.setZero();
    for (long r = 0; r < count; ++r) c.p_step[cells.index[r]] = change[r];
    push_nodes(problem, dt, mesh);
    c.p_step += c.p;
    fill_pressure(grid, c.p_step);
    find_v_theta();
    double sum = 0;
    for (long r = 0; r < count; ++r) {
        const double left =
            dilation(grid, vx, vz, cells.index[r]) + inertia[r] * change[r] / (theta * dt);
        sum += left * left;
    }
    return {solved.iterations, theta * dt * std::sqrt(sum) / scale};
}

}  // namespace flip
