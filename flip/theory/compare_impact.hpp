// Something fast hits something at rest: what is conserved, and what the target has got.
#pragma once

#include <limits>

#include "flip/theory/comparison.hpp"

namespace flip {

/// The fastest region, and the first box of another material.
struct Impact {
    const RegionCase *projectile, *target;  // null where there is none
    bool along_x() const {
        return std::fabs(projectile->gas.velocity_x) >= std::fabs(projectile->gas.velocity_z);
    }
};
/// The impact of a case.
inline Impact impact_of(const Case& parameters) {
    Impact s{&parameters.regions.front(), nullptr};
    const auto speed = [](const RegionCase& r) {
        return std::hypot(r.gas.velocity_x, r.gas.velocity_z);
    };
    for (const RegionCase& r : parameters.regions)
        if (speed(r) > speed(*s.projectile)) s.projectile = &r;
    for (const RegionCase& r : parameters.regions)
        if (s.target == nullptr && r.shape == "box" &&
            &material_of(parameters, r) != &material_of(parameters, *s.projectile))
            s.target = &r;
    return s;
}

/// Needs a region that moves and a box of another material.
inline void validate_impact(const Case& parameters, const Refusal& refuse) {
    const Impact impact = impact_of(parameters);
    refuse(impact.target == nullptr,
           " needs two materials, and the one that is hit in a region of shape \"box\"");
    const auto& gas = impact.projectile->gas;
    refuse(gas.velocity_x == 0 && gas.velocity_z == 0, " needs a region that moves");
}

/// Whether kinetic energy is all that the fluid has to give, and nothing else gives any: p = 0, where de = -p dV
/// has its least, no forces, and ends that only let out.
inline bool least_internal_energy(const Case& parameters) {
    bool least = parameters.gravity_x == 0 && parameters.gravity_z == 0 && parameters.trap == 0;
    for (const RegionCase& r : parameters.regions)
        least = least && r.gas.pressure == 0 && r.energy == 0;
    for (const BoundaryCase& end : parameters.boundaries)
        least = least && end.kind != "inflow" && end.pressure == 0 && end.slide == 0;
    return least;
}

/// Momentum of the target, and how far the projectile has come beyond its face.
inline void track_impact(const Snapshot& now, common::Row& row) {
    const Case& parameters = now.parameters;
    const Impact impact = impact_of(parameters);
    const RegionCase &hit = *impact.target, &from = *impact.projectile;
    const Field& rho = now.cells.rho_of[material_index(parameters, hit.gas.material)];
    double px = 0, pz = 0;
    const Grid& grid = parameters.grid;
    visit_cells(grid, [&](long c, double, double) {
        const double V = cell_volume(grid, column_of(grid, c));
        if (!grid.axisymmetric) px += rho[c] * now.cells.vx[c] * V;
        pz += rho[c] * now.cells.vz[c] * V;
    });
    const bool along_x = impact.along_x();
    const double sign = (along_x ? from.gas.velocity_x : from.gas.velocity_z) < 0 ? -1 : 1;
    const double face =
        sign * (along_x ? hit.center_x : hit.center_z) - (along_x ? hit.half_x : hit.half_z);
    const Particles& particles = now.state.particles;
    const auto& positions = along_x ? particles.x_p : particles.z_p;
    const int material = material_index(parameters, from.gas.material);
    double foremost = -std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < positions.size(); ++p)
        if (particles.material[p] == material) foremost = std::max(foremost, sign * positions[p]);
    const char* const unit = grid.axisymmetric ? "momentum" : "momentum/length";
    row.add("target_momentum_x", unit, px);
    row.add("target_momentum_z", unit, pz);
    row.add("depth", "length", std::isfinite(foremost) ? foremost - face : 0.0);
}

/// Mass and momentum to round-off, as energy in every run, and how much momentum and depth the
/// target has taken.
inline void compare_impact(const FinishedRun& run) {
    const double round_off = 1e-12;
    std::vector<std::string> kept{"mass_error"};
    if (!run.parameters.grid.axisymmetric) kept.push_back("momentum_x_error");
    if (run.parameters.moves_along_z()) kept.push_back("momentum_z_error");
    run.hint(
        "every step keeps it with what ends and gravity give, so that the run has gone astray: "
        "lower time.cfl; if that does not help, the program is wrong");
    for (const std::string& name : kept)
        run.summary.result_at_most("largest_" + name, run.history.largest(name), "", round_off,
                                   "exact but for round-off");
    const char* along = impact_of(run.parameters).along_x() ? "momentum_x" : "momentum_z";
    const double momentum = run.history.first(along);
    const double given = run.history.column(std::string("target_") + along).back();
    run.info("momentum_given", momentum != 0 ? given / momentum : 0, "",
             "part of all that the target has at the end");
    const auto depth = run.history.column("depth");
    run.info("depth", std::ranges::max(depth), "length",
             "of the foremost particle behind the face of the target");
    const double left = run.totals.kinetic / run.history.first("kinetic");
    if (!least_internal_energy(run.parameters))
        return run.info("kinetic_energy_left", left, "", "relative to the start");
    run.hint(
        "fluid at p = 0 has no internal energy to give, so that what is more is noise of particles "
        "that enter and leave cells, of the size of p_infinity: ",
        run.program == "pic"
            ? "take flip, or a faster impact, or raise particles.per_cell_x and per_cell_z"
            : "take particles.per_cell_x = particles.per_cell_z = 4 on a lattice, "
              "viscosity.linear = 0.5 and viscosity.quadratic = 1");
    run.summary.result_at_most("kinetic_energy_left", left, "", 1.01,
                               "relative to the start, where the fluid has the least internal "
                               "energy; 0.01 more for the noise of bodies that meet");
}

inline constexpr Comparison impact_comparison{"impact",  validate_impact, nullptr,
                                              nullptr,   track_impact,    compare_impact,
                                              Rows::any, Frame::at_rest,  true};

}  // namespace flip
