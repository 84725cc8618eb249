// What the tests of flip and pic share: the loops of their mains without files, clouds of particles
// anywhere on the mesh, and sums that know nothing of the code under test.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "flip/flip/step.hpp"
#include "flip/output/flip_diagnostics.hpp"
#include "flip/output/pic_diagnostics.hpp"
#include "flip/pic/step.hpp"
#include "flip/setup/problem_of_case.hpp"
#include "tests/support/any_numbers.hpp"

namespace facts {

using namespace flip;

using Random = UnitRandom;

/// The steps of flip, whole and in parts.
struct FlipRun {
    Case w;
    Problem problem;
    FlipScratch scratch;
    State state;
    long steps_taken = 0;

    FlipRun(const Case& parameters, const Particles& particles)
        : w(completed(parameters)), problem(problem_of(w)), scratch(problem) {
        state.particles = particles;
        sort();
    }
    explicit FlipRun(const Case& parameters)
        : FlipRun(parameters, load_particles(completed(parameters))) {}

    Particles& particles() { return state.particles; }
    Nodes& nodes() { return scratch.mesh.nodes; }
    Cells& cells() { return scratch.mesh.cells; }
    const Grid& grid() const { return w.grid; }

    void sort() { sort_particles(w.grid, scratch.sort, state.particles); }
    /// particles -> mesh, and the pressure.
    void deposit() { find_fluid(problem, state, scratch.mesh); }
    double move_nodes() {
        double dt = step_allowed(problem, scratch.mesh, state.dt);
        state.report = move_mesh(problem, dt, state.particles, scratch.mass_matrix, scratch.mesh,
                                 state.budget);
        return dt;
    }
    void step() {
        deposit();
        take_flip_step(problem, steps_taken++, scratch, state);
    }
    void steps(int count) {
        for (int n = 0; n < count; ++n) step();
    }
    Totals totals() const { return particle_totals(problem.grid, state.particles); }
};

/// The steps of pic.
struct PicRun {
    Case w;
    Problem problem;
    PicCells cells;
    State state;
    explicit PicRun(const Case& parameters)
        : w(completed(parameters)),
          problem(problem_of(w)),
          cells(problem),
          state(initial_state(problem, load_particles(w), cells)) {}
    double step() {
        find_pressure(problem, state, cells);
        take_pic_step(problem, state, cells);
        return state.dt;
    }
    void steps(int count) {
        for (int n = 0; n < count; ++n) step();
    }
    void to_the_end() {
        while (state.time < w.end) step();
    }
    Totals totals() { return totals_of(problem.grid, state, cells); }
};

/// A mesh on (0, 1) in x; a plane of unit height or a row of cells.
inline Case flip_case(long nx, long nz, const char* ends_x, const char* ends_z) {
    Case w;
    w.grid = {{nx, 0, 1, true}, {nz, 0, nz > 1 ? 1.0 : 1.0 / real(nx), true}};
    w.boundaries[x_low].kind = w.boundaries[x_high].kind = ends_x;
    w.boundaries[z_low].kind = w.boundaries[z_high].kind = ends_z;
    w.per_cell_z = nz > 1 ? 4 : 1;
    w.end = 1e3;
    return w;
}

/// The same of rings about an axis: x is the radius.
inline Case rings(long nr, long nz, const char* high = "slip", const char* ends_z = "slip") {
    Case w = flip_case(nr, nz, "slip", nz > 1 ? ends_z : "periodic");
    w.boundaries[x_high].kind = high;
    w.geometry = "axisymmetric";
    return w;
}

inline RegionCase fluid(const std::string& material, double density, double p, double vx = 0,
                        double vz = 0) {
    RegionCase r;
    r.gas = {material, density, p, vx, vz};
    return r;
}

/// Particles anywhere in a box: masses about 1/2 to 3/2 of an even share, energies about those of
/// pressure 1, random velocities.
/// in:     a completed case; density, speed: of the cloud
struct CloudBox {
    double x_low = 0, x_high = 1, z_low = 0, z_high = 1;
};
inline void add_cloud(const Case& w, long count, const CloudBox& box, double density, double speed,
                      Random& random, Particles& p, int material = -1) {
    const double area = (box.x_high - box.x_low) * (box.z_high - box.z_low);
    for (long k = 0; k < count; ++k) {
        const int kind = material >= 0 ? material : int(k % w.materials.size());
        const Material& a = w.materials[std::size_t(kind)];
        const double V = area / real(count), rho = density * random(0.5, 1.5);
        p.x_p.push_back(random(box.x_low, box.x_high));
        p.z_p.push_back(random(box.z_low, box.z_high));
        p.m_p.push_back(rho * V);
        p.material.push_back(kind);
        p.vx_p.push_back(speed * random(-1, 1));
        p.vz_p.push_back(speed * random(-1, 1));
        p.e_p.push_back(internal_energy(a, rho, random(0.7, 1.3)));
        if (w.density == "particles") p.V_p.push_back(V);
        if (w.transfer != "apic") continue;
        for (auto* C : {&p.Cxx_p, &p.Cxz_p, &p.Czx_p, &p.Czz_p})
            C->push_back(2 * speed * random(-1, 1));
    }
}
/// Twelve particles per cell anywhere on the mesh.
inline Particles any_cloud(const Case& parameters, double speed, std::uint64_t seed,
                           long per_cell = 12) {
    const Case w = completed(parameters);
    Random random(seed);
    Particles p;
    add_cloud(w, per_cell * w.grid.x.cells * w.grid.z.cells,
              {w.grid.x.low, w.grid.x.high(), w.grid.z.low, w.grid.z.high()}, 1, speed, random, p);
    return p;
}

/// Random numbers on the nodes that are not images, images filled.
inline void stir_nodes(const Grid& grid, Random& random, Field& f) {
    f.setZero(grid.size());
    for_own_nodes(grid, [&](long, long, long n) { f[n] = random(-1, 1); });
    fill_nodes(grid, f.data());
}

/// How much a step leaves of mass, momentum and energy beside the budget, relative.
struct Leak {
    double mass = 0, momentum = 0, energy = 0;
    double most() const { return worst({mass, momentum, energy}); }
};
inline Leak leak(const Totals& a, const Totals& b, const Budget& before, const Budget& after) {
    const double energy = worst({a.kinetic + a.internal, b.kinetic + b.internal}),
                 mass = worst({a.mass, b.mass}), momentum = std::sqrt(2 * energy * mass);
    Leak l;
    l.mass = std::fabs(b.mass - a.mass - (after.mass - before.mass)) / mass;
    l.momentum =
        worst({std::fabs(b.momentum_x - a.momentum_x - (after.momentum_x - before.momentum_x)),
               std::fabs(b.momentum_z - a.momentum_z - (after.momentum_z - before.momentum_z))}) /
        momentum;
    l.energy = std::fabs(b.kinetic + b.internal - a.kinetic - a.internal -
                         (after.energy - before.energy)) /
               energy;
    return l;
}
/// The same without the momentum that points outward, which no ring keeps.
inline Leak leak_along(Totals a, Totals b, Budget before, Budget after) {
    a.momentum_x = b.momentum_x = before.momentum_x = after.momentum_x = 0;
    return leak(a, b, before, after);
}

/// The largest speed on the mesh, seen from a stream along z.
inline double speed_of(const Field& vx, const Field& vz, double stream = 0) {
    return std::sqrt(
        (vx.array().square() + (vz.array() - stream).square()).maxCoeff<Eigen::PropagateNaN>());
}

}  // namespace facts
