// particles: more of them where they have become few, fewer where they crowd, and the mesh does not
// notice. "Computers are bigger than they were in 1960", but a flow that stretches still pulls the
// particles of a cell apart.
//
// All that the mesh sees of a particle are its weights S and R. Within a quarter of a cell none of
// them has a kink, and all are combinations of four functions, phi = (1, x, z, x z). So
//   - four children at (+-a, +-b) around their parent, each a quarter of it, are the parent;
//   - a particle i is four others j if phi_i = sum_j lambda_j phi_j: each of them takes lambda_j of
//     its mass, momentum and energy.
//
//     o-------+-------o      nodes o, center of the cell f; the quarters are numbered 0 to 3.
//     |   2   |  c c  |      c: children of a particle in quarter 3, which stay in that quarter
//     |       |  c c  |
//     +-------f-------+      In a row of cells there are two children, two others and
//     |  j j  |       |      phi = (1, x).
//     | j 0 i |   1   |
//     o---j---+-------o      i: goes into the four j of its quarter
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <vector>

#include "flip/flip/mesh.hpp"

namespace flip {

/// Whether particles are split and merged after the step of this number.
inline bool rezone_is_due(const Scheme& scheme, long step) {
    return scheme.rezone_steps > 0 && (step + 1) % scheme.rezone_steps == 0;
}

namespace detail {

// Where a particle is: its cell with its material, and the quarter of the cell.
struct Quarter {
    long cell = 0;        // [row][column][material]
    int part = 0;         // 0 to 3: left or right, below or above
    double x = 0, z = 0;  // in cells, from the center of the cell
};
inline Quarter quarter_of(const Grid& grid, long materials, const Particles& p, long k) {
    const long i = cell_along(grid.x, p.x_p[k]), j = cell_along(grid.z, p.z_p[k]);
    Quarter q;
    q.cell = (j * grid.x.cells + i) * materials + p.material[k];
    q.x = (p.x_p[k] - grid.x.low) / grid.x.spacing() - double(i) - 0.5;
    q.z = (p.z_p[k] - grid.z.low) / grid.z.spacing() - double(j) - 0.5;
    q.part = (q.x >= 0 ? 1 : 0) + (q.z >= 0 ? 2 : 0);
    return q;
}

// Half the distance to the nearest border of its quarter, in cells.
inline double room(double from_center) {
    const double r = std::fabs(from_center);
    return 0.5 * std::min(r, 0.5 - r);
}

// Splits one particle; its children stay in its quarter. out: whether there was room.
inline bool split(const Problem& problem, const Quarter& q, long k, Particles& p) {
    const Grid& grid = problem.grid;
    const bool plane = is_plane(grid);
    const double a = std::min(0.25 / double(problem.per_cell_x), room(q.x)),
                 b = plane ? std::min(0.25 / double(problem.per_cell_z), room(q.z)) : 0;
    if (a < 0.01 || (plane && b < 0.01)) return false;
    const double x = p.x_p[k], z = p.z_p[k], dx = a * grid.x.spacing(), dz = b * grid.z.spacing(),
                 part = plane ? 0.25 : 0.5;
    p.m_p[k] *= part;
    if (has(p.V_p)) p.V_p[k] *= part;
    for (int child = 1; child < (plane ? 4 : 2); ++child) {
        for (std::vector<double>* column : p.all())
            if (has(*column)) column->push_back((*column)[k]);
        p.material.push_back(p.material[k]);
        p.x_p.back() = x + (child & 1 ? dx : -dx);
        p.z_p.back() = z + (child & 2 ? dz : -dz);
    }
    p.x_p[k] = x - dx;
    p.z_p[k] = z - dz;
    return true;
}

// The parts lambda of particle i that the others take, phi_i = sum lambda_j phi_j; empty when the
// others lie on a line, or when one of them would be left with too little: with a part `worst` of
// its own mass or volume, below 0.3.
inline std::vector<double> parts_of(const std::vector<Quarter>& q, const Particles& p, long i,
                                    const std::vector<long>& others, bool plane, double& worst) {
    const auto count = long(others.size());
    Eigen::MatrixXd phi(count, count);
    Eigen::VectorXd phi_i(count);
    const auto fill = [&](long k, auto&& column) {
        column[0] = 1;
        column[1] = q[k].x - q[i].x;
        if (!plane) return;
        column[2] = q[k].z - q[i].z;
        column[3] = (q[k].x - q[i].x) * (q[k].z - q[i].z);
    };
    for (long n = 0; n < count; ++n) fill(others[n], phi.col(n));
    fill(i, phi_i);
    const Eigen::FullPivLU<Eigen::MatrixXd> solver(phi);
    if (!solver.isInvertible()) return {};
    const Eigen::VectorXd lambda = solver.solve(phi_i);
    worst = 1;
    for (long n = 0; n < count; ++n) {
        const long j = others[n];
        worst = std::min(worst, (p.m_p[j] + lambda[n] * p.m_p[i]) / p.m_p[j]);
        if (has(p.V_p)) worst = std::min(worst, (p.V_p[j] + lambda[n] * p.V_p[i]) / p.V_p[j]);
    }
    if ((phi * lambda - phi_i).norm() > 1e-12 || worst < 0.3) return {};
    return {lambda.data(), lambda.data() + count};
}

// Hands particle i to the others. The kinetic energy that mixing takes becomes heat.
// out: false, and nothing done, if a particle would be left with negative internal energy
inline bool hand_over(long i, const std::vector<long>& others, const std::vector<double>& lambda,
                      Particles& p) {
    std::vector<std::array<double, 4>> after;  // mass, velocity, internal energy
    for (std::size_t n = 0; n < others.size(); ++n) {
        const long j = others[n];
        const double given = lambda[n] * p.m_p[i], m = p.m_p[j] + given;
        const auto mixed = [&](const std::vector<double>& f) {
            return (p.m_p[j] * f[j] + given * f[i]) / m;
        };
        const double vx = mixed(p.vx_p), vz = mixed(p.vz_p);
        const double dx = p.vx_p[j] - p.vx_p[i], dz = p.vz_p[j] - p.vz_p[i];
        const double e = mixed(p.e_p) + 0.5 * p.m_p[j] * given / (m * m) * (dx * dx + dz * dz);
        if (e < 0) return false;
        after.push_back({m, vx, vz, e});
    }
    for (std::size_t n = 0; n < others.size(); ++n) {
        const long j = others[n];
        p.m_p[j] = after[n][0], p.vx_p[j] = after[n][1], p.vz_p[j] = after[n][2];
        p.e_p[j] = after[n][3];
        if (has(p.V_p)) p.V_p[j] += lambda[n] * p.V_p[i];
    }
    p.m_p[i] = 0;
    return true;
}

// Merges the lightest particle of one quarter that can be merged into others of it: of the nearest few,
// into those that leave the largest `worst` of parts_of(). out: whether there was one.
inline bool merge_one(const std::vector<Quarter>& q, bool plane, std::vector<long>& here,
                      Particles& p) {
    const std::size_t needed = plane ? 4 : 2, candidates = plane ? 7 : 4;
    if (here.size() < needed + 1) return false;
    std::ranges::stable_sort(here, {}, [&](long k) { return p.m_p[k]; });
    for (const long i : here) {
        std::vector<long> near = here;
        std::erase(near, i);
        const auto distance = [&](long a) { return std::hypot(q[a].x - q[i].x, q[a].z - q[i].z); };
        std::ranges::stable_sort(near, {}, distance);
        near.resize(std::min(near.size(), candidates));
        std::vector<bool> chosen(near.size(), false);
        std::fill_n(chosen.begin(), needed, true);
        std::vector<long> best;
        std::vector<double> best_parts;
        double most = 0;
        do {
            std::vector<long> others;
            for (std::size_t k = 0; k < near.size(); ++k)
                if (chosen[k]) others.push_back(near[k]);
            double worst = 0;
            const std::vector<double> lambda = parts_of(q, p, i, others, plane, worst);
            if (lambda.empty() || worst <= most) continue;
            most = worst, best = others, best_parts = lambda;
        } while (std::prev_permutation(chosen.begin(), chosen.end()));
        if (best.empty() || !hand_over(i, best, best_parts, p)) continue;
        std::erase(here, i);
        return true;
    }
    return false;
}

}  // namespace detail

/// Splits particles in cells that have become poor in them, inside the fluid, and merges them in
/// cells that are crowded.
/// in:     scheme.min_particles and max_particles of one material in a cell
/// in/out: particles; new ones at the end, so they are not sorted any more
/// exact:  mass, momentum, total energy, and what deposit_particles() makes of mass and momentum on
///         every node and cell, to round-off; internal energy of the cells but for the heat of
///         mixing; with volumes their sum
/// source: the aim is that of Lapenta and Brackbill, Comput. Phys. Commun. 87, 139 (1995); the
///         exact merging by weights is ours.
inline void rezone(const Problem& problem, Particles& p) {
    const Grid& grid = problem.grid;
    const Scheme& scheme = problem.scheme;
    const long materials = long(problem.materials.size()), count = p.count(),
               cells = grid.x.cells * grid.z.cells;
    std::vector<detail::Quarter> q(count);
    std::vector<long> in_cell(cells * materials, 0L), order(count);
    std::vector<char> filled(cells, 0);
    for (long k = 0; k < count; ++k) {
        q[k] = detail::quarter_of(grid, materials, p, k);
        ++in_cell[q[k].cell];
        filled[q[k].cell / materials] = 1;
    }
    std::iota(order.begin(), order.end(), 0L);
    std::ranges::stable_sort(order, {}, [&](long k) { return std::pair(q[k].cell, q[k].part); });
    const auto is_filled = [&](long i, long j) {
        if (grid.x.periodic) i = (i + grid.x.cells) % grid.x.cells;
        if (grid.z.periodic) j = (j + grid.z.cells) % grid.z.cells;
        if (i < 0 || j < 0 || i >= grid.x.cells || j >= grid.z.cells) return true;
        return filled[j * grid.x.cells + i] != 0;
    };
    const auto inside = [&](long cell) {
        const long i = cell % grid.x.cells, j = cell / grid.x.cells;
        return is_filled(i - 1, j) && is_filled(i + 1, j) && is_filled(i, j - 1) &&
               is_filled(i, j + 1);
    };
    const bool plane = is_plane(grid);
    bool any_merged = false;
    for (long begin = 0, end = 0; begin < count; begin = end) {
        const long cell = q[order[begin]].cell;
        while (end < count && q[order[end]].cell == cell) ++end;
        long number = in_cell[cell];
        if (number < scheme.min_particles && inside(cell / materials)) {
            std::vector<long> heaviest(order.begin() + begin, order.begin() + end);
            std::ranges::stable_sort(heaviest, std::greater{}, [&](long k) { return p.m_p[k]; });
            for (const long k : heaviest) {
                if (number >= scheme.min_particles) break;
                if (!detail::split(problem, q[k], k, p)) continue;
                number += plane ? 3 : 1;
            }
        }
        if (number <= scheme.max_particles) continue;
        // One after the other from the fullest quarter.
        std::array<std::vector<long>, 4> quarters;
        for (long n = begin; n < end; ++n) quarters[q[order[n]].part].push_back(order[n]);
        while (number > scheme.max_particles) {
            auto& fullest = *std::ranges::max_element(quarters, {}, &std::vector<long>::size);
            if (fullest.empty()) break;
            if (detail::merge_one(q, plane, fullest, p))
                --number, any_merged = true;
            else
                fullest.clear();
        }
    }
    if (any_merged) remove_if(p, [&](long k) { return p.m_p[k] == 0; });
}

}  // namespace flip
