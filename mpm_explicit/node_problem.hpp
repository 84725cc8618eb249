// Everybody who meets at one node, and the impulses that end their approach and their slip.   [MPM-4]
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace mpm {

namespace detail {

/// Who is at a node, with mass.
struct Party {
    long dof;
    int grain;  // of a wall: its side
    bool wall, rigid;
    double per_mx, per_my;  // 1/m_i; 0 where nothing changes the velocity
    double m;
    double vx_0, vy_0;  // before the step
    double vx, vy;      // after it, being corrected
    double x, y;        // center of the grain's part around the node, from the node
    double gx, gy;      // out of the grain
    bool is_fixed() const { return wall || rigid; }
};

struct Pair {
    std::size_t a, b;
    int bond;       // number of the bond that holds, or -1
    double nx, ny;  // from a to b
    double mu;
    double mass_n, mass_t;  // reduced, along the normal and across
    double lambda_n, lambda_t;
};

struct NodeProblem {
    static constexpr std::size_t most_parties = 16;
    std::array<Party, most_parties> party;
    std::array<Pair, most_parties*(most_parties - 1) / 2> pair;
    std::size_t parties = 0, pairs = 0;
    long key = 0;           // of the node on the mesh
    bool isotropic = true;  // 1/m_i is the same in both directions
};

/// Reduced masses of all pairs, from those of the parties.
inline void weigh_pairs(NodeProblem& node) {
    for (std::size_t k = 0; k < node.pairs; ++k) {
        Pair& pair = node.pair[k];
        const Party &one = node.party[pair.a], &two = node.party[pair.b];
        const double per_x = one.per_mx + two.per_mx, per_y = one.per_my + two.per_my,
                     nn = pair.nx * pair.nx, tt = pair.ny * pair.ny,
                     per_n = per_x * nn + per_y * tt, per_t = per_x * tt + per_y * nn;
        pair.mass_n = per_n > 0 ? 1 / per_n : 0, pair.mass_t = per_t > 0 ? 1 / per_t : 0;
    }
}

/// Projected Gauss-Seidel, until a sweep changes no velocity by more than round-off.
inline void solve(NodeProblem& node) {
    double size = 0;
    for (std::size_t k = 0; k < node.parties; ++k)
        size = std::max({size, std::fabs(node.party[k].vx), std::fabs(node.party[k].vy)});
    constexpr int most_sweeps = 500;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        double change = 0;
        for (std::size_t k = 0; k < node.pairs; ++k) {
            Pair& pair = node.pair[k];
            Party &a = node.party[pair.a], &b = node.party[pair.b];
            // [impulse]
            const auto exchange = [&](double jx, double jy) {
                a.vx -= jx * a.per_mx, a.vy -= jy * a.per_my;
                b.vx += jx * b.per_mx, b.vy += jy * b.per_my;
                change = std::max({change, std::fabs(jx) * std::max(a.per_mx, b.per_mx),
                                   std::fabs(jy) * std::max(a.per_my, b.per_my)});
            };
            const double approach = (a.vx - b.vx) * pair.nx + (a.vy - b.vy) * pair.ny;
            double n = pair.lambda_n + pair.mass_n * approach;
            if (pair.bond < 0) n = std::max(0.0, n);
            exchange((n - pair.lambda_n) * pair.nx, (n - pair.lambda_n) * pair.ny);
            pair.lambda_n = n;

            const double slip = (b.vx - a.vx) * pair.ny - (b.vy - a.vy) * pair.nx;
            double t = pair.lambda_t + pair.mass_t * slip;
            if (pair.bond < 0) t = std::clamp(t, -pair.mu * n, pair.mu * n);
            exchange((pair.lambda_t - t) * pair.ny, (t - pair.lambda_t) * pair.nx);
            pair.lambda_t = t;
            // [/impulse]
        }
        const bool exact = node.pairs == 1 && node.isotropic;
        if (exact || !(change > 1e-15 * size)) return;
    }
}

}  // namespace detail

}  // namespace mpm
