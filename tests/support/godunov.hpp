// Godunov's first-order method for two stiffened gases in a tube: what the windows of the Riemann
// comparison are justified against.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "flip/theory/riemann.hpp"

namespace facts {

/// What the tube holds at the end, cell by cell.
struct GodunovTube {
    std::vector<double> rho, u, p;
};

/// Two gases that meet at x = interface, on cells of equal size with open ends.
///   U_i -= dt/dx [F(i+1/2) - F(i-1/2)], F of the exact solution between neighbors at x/t = 0
///   G_i -= dt/dx {(u* - |u*|)/2 [G(i+1) - G(i)] + (u* + |u*|)/2 [G(i) - G(i-1)]}
/// for U = (rho, rho u, E) and G = 1/(gamma - 1), gamma p_infinity/(gamma - 1), so that a contact
/// with one pressure and one velocity keeps them
/// source: Godunov, Mat. Sb. 47, 271 (1959); Shyue, J. Comput. Phys. 142, 208 (1998).
inline GodunovTube godunov_tube(const flip::theory::GasState& left,
                                const flip::theory::GasState& right, double low, double length,
                                long cells, double interface, double end, double cfl = 0.9) {
    using namespace flip::theory;
    const long N = cells + 2;
    const double dx = length / double(cells);
    struct Cell {
        double q[5];  // mass, momentum, energy, and both G
        GasState gas;
    };
    const auto filled = [](const GasState& s) {
        return Cell{{s.density, s.density * s.velocity, energy_per_volume(s), 1 / (s.gamma - 1),
                     s.gamma * s.p_infinity / (s.gamma - 1)},
                    s};
    };
    std::vector<Cell> cell;
    for (long i = 0; i < N; ++i)
        cell.push_back(filled(low + (double(i) - 0.5) * dx < interface ? left : right));
    struct Flux {
        double F[3], u;
    };
    std::vector<Flux> flux(N - 1);
    for (double t = 0; t < end;) {
        double fastest = 0;
        for (long i = 0; i + 1 < N; ++i) {
            const RiemannSolution s = solve_riemann(cell[i].gas, cell[i + 1].gas);
            const GasState g = sample(s, 0);
            fastest = std::max({fastest, std::fabs(s.left_head), std::fabs(s.right_head)});
            flux[i] = {{g.density * g.velocity, g.density * g.velocity * g.velocity + g.pressure,
                        (energy_per_volume(g) + g.pressure) * g.velocity},
                       0.5 * (s.left_contact + s.right_contact)};
        }
        const double dt = std::min(cfl * dx / fastest, end - t), r = dt / dx;
        std::vector<Cell> next = cell;
        for (long i = 1; i + 1 < N; ++i) {
            double* q = next[i].q;
            for (int k = 0; k < 3; ++k) q[k] -= r * (flux[i].F[k] - flux[i - 1].F[k]);
            for (int k = 3; k < 5; ++k)
                q[k] -= r * (std::min(flux[i].u, 0.0) * (cell[i + 1].q[k] - cell[i].q[k]) +
                             std::max(flux[i - 1].u, 0.0) * (cell[i].q[k] - cell[i - 1].q[k]));
            const double gamma = 1 + 1 / q[3], u = q[1] / q[0];
            next[i].gas = {q[0], u, (q[2] - 0.5 * q[1] * u - q[4]) / q[3], gamma,
                           q[4] * (gamma - 1) / gamma};
        }
        next.front() = next[1], next.back() = next[N - 2];
        cell = next;
        t = t + dt;
    }
    GodunovTube tube;
    for (long i = 1; i + 1 < N; ++i) {
        tube.rho.push_back(cell[i].gas.density);
        tube.u.push_back(cell[i].gas.velocity);
        tube.p.push_back(cell[i].gas.pressure);
    }
    return tube;
}

}  // namespace facts
