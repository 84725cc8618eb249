// A fluid at rest under gravity, or that turns about the axis: particles whose pressure the mesh
// balances, to round-off.
//
// The formula p + rho g z is right between the cells and not on them: a cell at a wall, or one that
// two fluids share, averages over particles that do not lie around its middle. What is wrong there
// would run away as sound and never end. So the start is the pressure with which nothing moves:
//     D M^-1 (D^T p + m g) = 0         D: dilation of the cells, D^T: force on the nodes; where the fluid
//                                      turns, beside m g the centrifugal force
#pragma once

#include <algorithm>

#include "flip/flip/deposit_particles.hpp"
#include "flip/flip/solve_pressure.hpp"

namespace flip {

namespace detail {

// The change of pressure that leaves every cell without an acceleration of its volume.
// in:  the mesh after find_pressure()
// out: on the cells, 0 where p = 0 whatever happens
inline Field change_to_balance(const Problem& problem, const Particles& particles, Mesh& mesh) {
    const Grid& grid = problem.grid;
    Nodes& g = mesh.nodes;
    Cells& c = mesh.cells;
    Field change = Field::Zero(grid.size());
    const double dt = 1 / problem.scheme.theta;  // the matrix is theta^2 dt^2 D M^-1 D^T
    const PressureCells cells = number_cells(problem, dt, mesh);
    if (cells.count() == 0) return change;
    for (Field* f : {&g.vx0, &g.vz0}) f->setZero(grid.size());
    c.q.assign(grid.size(), {});
    c.p_step = c.p;
    find_known_forces(grid, problem.boundaries, 0, mesh);
    if (problem.swirl) add_centrifugal_force(problem, 0, particles, mesh);
    accelerate_nodes(problem, 1, mesh);
    fill_nodes(grid, g.vxL.data());
    fill_nodes(grid, g.vzL.data());
    Eigen::VectorXd load(cells.count()), x;
    for (long r = 0; r < cells.count(); ++r)
        load[r] = -dilation(grid, g.vxL, g.vzL, cells.index[r]);
    const auto A = pressure_matrix(problem, dt, mesh, cells, Eigen::VectorXd::Zero(cells.count()));
    solve_cells(A, load, 1e-13, 10 * problem.scheme.max_iterations, x);
    for (long r = 0; r < cells.count(); ++r) change[cells.index[r]] = x[r];
    return change;
}

// The changes dp_p = sum_c R P_c of the particles' pressures that change those of the cells, which
// are means with the weights w_p, by a given amount.
//   sum_p R w_p dp_p = amount_c sum_p R w_p
inline std::vector<double> particle_changes(const Problem& problem, const Particles& particles,
                                            const std::vector<double>& V_p, const Cells& c,
                                            const Field& amount) {
    const Grid& grid = problem.grid;
    const WeightScale scale(grid);
    const long count = particles.count();
    const bool volumes = has(particles.V_p);
    std::vector<double> w(count), dp(count);
    const auto cells_of = [&](long k, const auto& visit) {
        for_cells(scale, weights_at(scale, particles.x_p[k], particles.z_p[k]), visit);
    };
    const auto gather = [&](Field& P) {
        fill_cells(grid, P.data());
        for (long k = 0; k < count; ++k) {
            dp[k] = 0;
            cells_of(k, [&](long cell, double R) { dp[k] += R * P[cell]; });
        }
    };
    const auto deposit = [&](const auto& value) {
        Field sum = Field::Zero(grid.size());
        for (long k = 0; k < count; ++k)
            cells_of(k, [&](long cell, double R) { sum[cell] += R * value(k); });
        fold_cells(grid, sum.data());
        return sum;
    };
    for (long k = 0; k < count; ++k) {
        const Material& a = problem.materials[particles.material[k]];
        const double p = pressure(a, particles.m_p[k] / V_p[k], particles.e_p[k]);
        w[k] = volumes ? weight_in_cell(a, V_p[k], p, c.one_fluid)
                       : V_p[k] / (p + a.gamma * a.p_infinity);
        if (a.gamma == 1 || !std::isfinite(w[k])) w[k] = 0;
    }
    const Field W = deposit([&](long k) { return w[k]; });
    Field S = Field::Zero(grid.size());  // 1/sqrt(W) of a cell with a pressure
    for_each_cell(grid, [&](long, long, long n) {
        if (c.surface[n] == 0 && W[n] > 0) S[n] = 1 / std::sqrt(W[n]);
    });
    const auto apply = [&](const Eigen::VectorXd& v, Eigen::VectorXd& Av) {
        Field P = S.cwiseProduct(v);
        gather(P);
        Av = S.cwiseProduct(deposit([&](long k) { return w[k] * dp[k]; }));
    };
    Field x = Field::Zero(grid.size());
    conjugate_gradients(apply, S.cwiseProduct(W).cwiseProduct(amount).eval(), x, 1e-12, 1000);
    Field P = S.cwiseProduct(x);
    gather(P);
    return dp;
}

}  // namespace detail

/// Gives the particles the internal energies with which the mesh balances gravity and the centrifugal
/// force.
///   e_p += dp_p V_p / ((gamma - 1) m_p)
/// in:     particles at the start, sorted by row; mesh, whose contents are lost
/// in/out: particles.e_p; as they were where the balance would need more than the weight of a cell:
///         then the case does not begin at rest
/// exact:  horizontal layers at rest stay at rest, to round-off of the largest pressure, p_infinity
///         included
inline void balance_at_rest(const Problem& problem, Particles& particles, Mesh& mesh) {
    const Grid& grid = problem.grid;
    const Cells& c = mesh.cells;
    std::vector<double> V_p = particles.V_p;
    if (V_p.empty()) {  // of a place on the lattice; rings to a per cent, which the loop mends
        const double A_p =
            grid.x.spacing() * grid.z.spacing() / double(problem.per_cell_x * problem.per_cell_z);
        for (const double x : particles.x_p)
            V_p.push_back(A_p * (grid.axisymmetric ? 2 * pi * x : 1));
    }
    const BodyForce& force = problem.body_force;
    double outward = 0;  // the largest centrifugal force per mass
    for (std::size_t k = 0; k < particles.L_p.size(); ++k)
        outward = std::max(outward,
                           centrifugal_force(particles.L_p[k], particles.x_p[k], particles.x_p[k]));
    const double step = (std::fabs(force.gravity_x) + outward) * grid.x.spacing() +
                        std::fabs(force.gravity_z) * grid.z.spacing();
    Field target;
    double apart_before = 0;
    for (int n = 0; n < 20; ++n) {
        deposit_particles(grid, problem.materials, particles, mesh);
        find_pressure(grid, problem.materials, 0, mesh);
        if (n == 0) {
            const Field change = detail::change_to_balance(problem, particles, mesh);
            const double heaviest = c.M.maxCoeff() / grid.cell_area();
            if (!(change.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= heaviest * step)) return;
            target = c.p + change;
        }
        Field apart = Field::Zero(grid.size());
        for_each_cell(grid, [&](long, long, long k) {
            if (c.surface[k] == 0 && c.M[k] > 0) apart[k] = target[k] - c.p[k];
        });
        const double most = apart.cwiseAbs().maxCoeff();
        if (most == 0 || (n > 0 && most > 0.5 * apart_before)) break;
        apart_before = most;
        const std::vector<double> dp = detail::particle_changes(problem, particles, V_p, c, apart);
        for (long k = 0; k < particles.count(); ++k) {
            const double gamma = problem.materials[particles.material[k]].gamma;
            if (gamma > 1) particles.e_p[k] += dp[k] * V_p[k] / ((gamma - 1) * particles.m_p[k]);
        }
    }
}

}  // namespace flip
