// Cold gas that falls into a plane, a line or a point, against Noh's solution.
#pragma once

#include <limits>

#include "flip/theory/comparison.hpp"
#include "flip/theory/shocks.hpp"

namespace flip {

/// Noh's problem of a case: cold gas that falls into a line, or in a row of cells into a plane; around
/// an axis into a point, or in a row into the axis.
inline theory::NohProblem noh_of(const Case& parameters) {
    const RegionCase& r = region_with_flow(parameters, "radial");
    return {material_of(parameters, r).gamma,
            (parameters.plane() ? 2 : 1) + (parameters.grid.axisymmetric ? 1 : 0), r.gas.density,
            r.speed};
}

/// How far from the middle the gas comes from that nothing follows: to the nearest end of the mesh that
/// is no mirror in the middle, or to the edge of a disk; in a row an inflow brings more.
inline double reach_of_noh(const Case& parameters) {
    const RegionCase& r = region_with_flow(parameters, "radial");
    double reach = r.shape == "disk" ? r.radius : std::numeric_limits<double>::infinity();
    for (const Side side : all_sides) {
        const bool along_x = is_x_side(side), row = !parameters.plane();
        if ((row && !along_x) || (parameters.grid.axisymmetric && side == x_low)) continue;
        if (row && !parameters.grid.axisymmetric && parameters.is(side, "inflow")) continue;
        const common::Axis& axis = along_x ? parameters.grid.x : parameters.grid.z;
        const double way = way_to(parameters.grid, side, r.center_x, r.center_z);
        if (!parameters.is(side, "slip") || std::fabs(way) > axis.spacing())
            reach = std::min(reach, way);
    }
    return reach;
}

/// Needs cold gas that falls inward, and enough of it.
inline void validate_noh(const Case& parameters, const Refusal& refuse) {
    validate_flow(parameters, refuse, "radial");
    const RegionCase& r = region_with_flow(parameters, "radial");
    refuse(material_of(parameters, r).gamma == 1, " is for a gas, and gamma = 1 is dust");
    refuse(!(r.speed > 0), " needs region.", r.name, ".speed above 0, inward");
    validate_no_force(parameters, refuse);
    refuse(
        r.gas.velocity_x != 0 || r.gas.velocity_z != 0,
        " is of gas that falls to a place at rest: take out velocity_x and velocity_z of region.",
        r.name);
    const double most = r.gas.density * r.speed * r.speed,
                 pressure = r.gas.pressure + material_of(parameters, r).p_infinity;
    refuse(pressure > 0.01 * most, " is for cold gas, and pressure + p_infinity of region.", r.name,
           " is ", pressure, ", above a hundredth of density speed^2, ", most, ": lower it");
    for (const Side end : {x_low, x_high})
        validate_inflow(parameters, refuse, end, r, end == x_low ? r.speed : -r.speed);
    const double used_up =
        reach_of_noh(parameters) / (r.speed + theory::noh_shock_radius(noh_of(parameters), 1));
    refuse(used_up <= 0,
           " needs its middle on the mesh, or on walls that mirror it: move "
           "region.",
           r.name, ".center_x or center_z, or set the ends there to \"slip\"");
    refuse(parameters.end > used_up, ": all gas has passed the shock at t = ", used_up,
           ": lower time.end below that, or lengthen the mesh");
}

/// The radius of the shock at the end.
inline std::string predict_noh(const Case& parameters, const std::string&, double) {
    return sentence("shock at r = ", theory::noh_shock_radius(noh_of(parameters), parameters.end),
                    " at t = ", parameters.end);
}

/// Means over rings around the point that the gas falls to.
inline RadialProfile noh_profile(const Case& parameters, const CellFields& cells) {
    const RegionCase& r = region_with_flow(parameters, "radial");
    return radial_profile(parameters.grid, cells, r.center_x, r.center_z);
}

/// The radius at which the density is half-way between both sides of the exact shock.
inline void track_noh(const Snapshot& now, common::Row& row) {
    const theory::NohProblem noh = noh_of(now.parameters);
    const double R = theory::noh_shock_radius(noh, 1);
    const double level = 0.5 * (theory::noh_state(noh, 0.5 * R, 1).density +
                                theory::noh_state(noh, 1.000001 * R, 1).density);
    const RadialProfile profile = noh_profile(now.parameters, now.cells);
    row.add("shock_radius", "length", outermost(profile.r, profile.rho, level));
}

/// The plateau behind the shock, the radius of the shock, and the profile.
/// note:   but for the plane shock every method of this kind errs near the middle, and fails
inline void compare_noh(const FinishedRun& run) {
    const theory::NohProblem noh = noh_of(run.parameters);
    const double t = run.state.time, R = theory::noh_shock_radius(noh, t);
    const theory::NohState behind = theory::noh_state(noh, 0.5 * R, std::max(t, 1e-300));
    const std::string source = "Noh's exact solution";
    const RadialProfile profile = noh_profile(run.parameters, run.cells);
    double sum = 0, area = 0;
    std::vector<double> exact;
    for (std::size_t n = 0; n < profile.r.size(); ++n) {
        const double r = profile.r[n];
        exact.push_back(t > 0 ? theory::noh_state(noh, r, t).density : noh.density);
        if (r < 0.3 * R || r > 0.8 * R) continue;
        const double shell = std::pow(r, noh.dimension - 1);
        sum += shell * profile.rho[n], area += shell;
    }
    const double plateau = area > 0 ? sum / area : 0;
    const double radius = run.history.column("shock_radius").back(),
                 R_then = theory::noh_shock_radius(noh, run.history.column("time").back());
    // The plateau is what lies between 0.3 and 0.8 of the radius, three cells at least.
    const double come = R / run.parameters.grid.x.spacing(), needs = 6;
    if (come < needs)
        for (const char* name : {"plateau_density_over_theory", "shock_radius_over_theory"})
            run.not_measured(name, "the shock is ", come, " cells from the middle, and ", needs,
                             " are needed: raise time.end, or refine the mesh");
    run.hint("the shock has come ", come,
             " cells from the middle, where heat piles up and keeps mass away: refine the mesh, or "
             "raise time.end");
    if (come >= needs)
        run.result("plateau_density_over_theory", plateau / behind.density, "", 1,
                   sentence(source, ": ", behind.density));
    if (come >= needs && !(radius > 0))
        run.summary.not_measured(
            "shock_radius_over_theory",
            "the density does not reach its level: raise time.end, or refine the mesh");
    else if (come >= needs)
        run.result("shock_radius_over_theory", radius / R_then, "", 1,
                   sentence(source, ": ", R_then));
    run.info("middle_density_over_theory", profile.rho[0] / behind.density, "",
             "wall heating: the ring in the middle");
    common::write_table(run.profile, {{"r", "length", profile.r},
                                      {"rho", "mass/length^3", profile.rho},
                                      {"v_r", "velocity", profile.v_r},
                                      {"p", "pressure", profile.p},
                                      {"rho_exact", "mass/length^3", exact}});
}

inline constexpr Comparison noh_comparison{"noh",     validate_noh,   predict_noh,
                                           nullptr,   track_noh,      compare_noh,
                                           Rows::any, Frame::at_rest, true};

}  // namespace flip
