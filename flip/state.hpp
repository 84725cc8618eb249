// All that a run is, at one time, and what either program says about it: totals for the history,
// fields on the cells for pictures and comparisons.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"
#include "flip/particles.hpp"
#include "flip/problem.hpp"
#include "flip/swirl.hpp"

namespace flip {

/// Energy and momentum budget: what has come in since the start from outside the fluid, through open
/// and inflow boundaries, from walls, gravity and the trap.
/// exact: what the fluid has now, minus this, does not change
struct Budget {
    double mass = 0, momentum_x = 0, momentum_z = 0, energy = 0;
    double angular_momentum = 0;  // about the axis

    /// Adds what comes in with the mass m, negative for what leaves; e per mass.
    void enter(double m, double vx, double vz, double e) {
        mass += m;
        momentum_x += m * vx;
        momentum_z += m * vz;
        energy += m * (0.5 * (vx * vx + vz * vz) + e);
    }
    /// Adds what it brings of the rotation about the axis, at the distance r from it.
    void enter_swirl(double m, double L, double r) {
        angular_momentum += m * L;
        energy += m * swirl_energy(L, r);
    }
};

/// What the cells of `pic` keep from step to step, on_faces, ghosts not filled.
struct CellFluid {
    Field vx, vz;          // velocity
    std::vector<Field> e;  // specific internal energy of each material
};

/// What the last step has to say besides the state it leaves.
struct StepReport {
    long iterations = 0;    // of the implicit pressure
    double divergence = 0;  // what its tolerance leaves, root mean square, in units of speed/dx
};

/// What a checkpoint holds. `cells` is empty in flip.
struct State {
    Particles particles;
    CellFluid cells;
    Budget budget;
    double time = 0;
    double dt = 0;  // of the last step; 0 before the first
    StepReport report;
};

/// Names every number of the state, for writing and for reading alike.
template <class Archive>
void archive(Archive& a, State& s) {
    archive(a, s.particles);
    a("vx_c", s.cells.vx);
    a("vz_c", s.cells.vz);
    for (std::size_t k = 0; k < s.cells.e.size(); ++k) a("e_c" + std::to_string(k), s.cells.e[k]);
    a("mass_in", s.budget.mass);
    a("momentum_x_in", s.budget.momentum_x);
    a("momentum_z_in", s.budget.momentum_z);
    a("energy_in", s.budget.energy);
    if (s.particles.swirl) a("angular_momentum_in", s.budget.angular_momentum);
    a("time", s.time);
    a("dt", s.dt);
    a("iterations", s.report.iterations);
    a("divergence", s.report.divergence);
}

/// Sums over the fluid; in flip over particles, in pic over cells.
struct Totals {
    double mass = 0, momentum_x = 0, momentum_z = 0;
    // About the middle of the mesh, counterclockwise from x to z; where the fluid turns about the
    // axis, about that, and its energy is kinetic.
    double angular_momentum = 0;
    double kinetic = 0, internal = 0;
};

/// The fluid on the cells, on_faces of the grid; zero where there is none.
struct CellFields {
    Field rho, vx, vz, p, e;
    std::vector<Field> rho_of;  // of each material
    Field v_theta;              // r sum m L/sum m r^2; empty where nothing turns
    double overfull = 0;        // part of the volume of liquid beyond what its cells have
};

/// Where and when a cell is, for messages.
inline std::string cell_and_time(const Grid& grid, long n, double time) {
    const double i = double(n % grid.stride()) - 0.5, j = double(n / grid.stride()) - 0.5;
    return "in the cell at x = " + common::format(grid.x.at(i)) +
           ", z = " + common::format(grid.z.at(j)) + " at t = " + common::format(time);
}

/// Whether a time of `interval` has passed within the last step; always at the start.
inline bool is_due(double interval, const State& s) {
    if (interval <= 0) return false;
    const auto count = [&](double t) { return std::floor(t / interval * (1 + 1e-12)); };
    return s.dt == 0 || count(s.time) > count(s.time - s.dt);
}

}  // namespace flip
