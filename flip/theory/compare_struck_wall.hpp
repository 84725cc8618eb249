// Gas that runs into a wall: cold gas, and a piston, which is the same in the frame of the gas.
#pragma once

#include "flip/theory/comparison.hpp"
#include "flip/theory/shocks.hpp"

namespace flip {

/// A wall along x that gas runs into.
struct StruckWall {
    theory::DrivenShock shock;
    bool at_low;  // the wall is x_low, and the shock runs towards larger x
    double density;
};
/// The wall that the gas of the first region runs into, and the shock in front of it.
inline StruckWall struck_wall(const Case& parameters) {
    const RegionCase& r = parameters.regions.front();
    const Material& a = material_of(parameters, r);
    return {theory::driven_shock(std::fabs(r.gas.velocity_x), r.gas.density, r.gas.pressure,
                                 a.gamma, a.p_infinity),
            r.gas.velocity_x < 0, r.gas.density};
}

/// Needs uniform gas that runs into a wall, until the other end of the mesh is felt.
inline void validate_wall_shock(const Case& parameters, const Refusal& refuse) {
    const RegionCase& r = parameters.regions.front();
    refuse(parameters.regions.size() != 1 || r.shape != "everywhere" || r.flow != "uniform",
           " needs a single region, uniform and everywhere");
    refuse(r.gas.velocity_x == 0, " needs gas that runs into a wall: give region.", r.name,
           ".velocity_x");
    const Side wall = r.gas.velocity_x < 0 ? x_low : x_high;
    const char* name = side_names[wall];
    refuse(!parameters.is(wall, "slip"), ": the gas runs towards ", name,
           ", which is not a wall: set boundary.", name, " = \"slip\"");
    refuse(material_of(parameters, r).gamma == 1, " is for a gas, and gamma = 1 is dust");
    validate_no_force(parameters, refuse);
    for (const Side side : {z_low, z_high})
        refuse(!parameters.is(side, "periodic") && !parameters.is(side, "slip"),
               " needs gas that nothing else holds up or lets out: set boundary.", side_names[side],
               " = \"slip\"");
    refuse(r.gas.velocity_z != 0 && !parameters.grid.z.periodic,
           " needs gas that runs straight at the wall: take out region.", r.name, ".velocity_z");
    // An inflow of the same gas is felt where the shock comes to it, another end with the flow and its
    // sound.
    const Side other = wall == x_low ? x_high : x_low;
    validate_inflow(parameters, refuse, other, r, r.gas.velocity_x);
    const bool fed = parameters.is(other, "inflow");
    const double speed = struck_wall(parameters).shock.speed_from_wall,
                 meeting =
                     parameters.grid.x.length /
                     (speed +
                      (fed ? 0 : std::fabs(r.gas.velocity_x) + sound_speed_of(parameters, r)));
    refuse(parameters.end > meeting,
           ": the other end of the mesh is felt behind the shock from t = ", meeting,
           " on: lower time.end below that");
}

/// Needs what wall_shock needs, and gas with a pressure.
inline void validate_piston(const Case& parameters, const Refusal& refuse) {
    validate_wall_shock(parameters, refuse);
    const RegionCase& r = parameters.regions.front();
    refuse(r.gas.pressure + material_of(parameters, r).p_infinity == 0,
           " needs gas with a pressure: give region.", r.name, ".pressure");
}

/// Density, speed and Mach number of the shock.
inline std::string predict_wall_shock(const Case& parameters, const std::string&, double) {
    const theory::DrivenShock s = struck_wall(parameters).shock;
    return sentence("density ", s.density, " behind a shock at ", s.speed_from_wall,
                    " from the wall, Mach ", s.mach);
}

/// Density against the distance from the wall that the gas runs into.
struct FromWall {
    std::vector<double> distance, rho;
};
/// The means over z, turned around where the wall is x_high.
inline FromWall from_wall(const Case& parameters, const CellFields& cells) {
    FromWall s{{}, mean_over_z(parameters.grid, cells.rho)};
    if (!struck_wall(parameters).at_low) std::ranges::reverse(s.rho);
    for (std::size_t n = 0; n < s.rho.size(); ++n)
        s.distance.push_back((double(n) + 0.5) * parameters.grid.x.spacing());
    return s;
}

/// The distance at which the density is half-way between both sides of the shock.
inline void track_wall_shock(const Snapshot& now, common::Row& row) {
    const StruckWall wall = struck_wall(now.parameters);
    const FromWall profile = from_wall(now.parameters, now.cells);
    row.add("shock_distance", "length",
            outermost(profile.distance, profile.rho, 0.5 * (wall.density + wall.shock.density)));
}

/// The plateau behind the shock, and how fast the shock moves away from the wall.
inline void compare_wall_shock(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const StruckWall wall = struck_wall(parameters);
    const double dx = parameters.grid.x.spacing(), R = wall.shock.speed_from_wall * run.state.time;
    const std::string source = "balance of mass, momentum and energy across the shock";
    const std::string advice = advice_on_viscosity(parameters);
    run.hint("the shock has come ", R / dx,
             " cells, of which the first six are the wall's heat and four are its width: below 40 "
             "raise time.end or refine the mesh",
             advice.empty() ? "" : "; else take " + advice, hint_on_viscosity(parameters));
    const FromWall profile = from_wall(parameters, run.cells);
    const double from = std::max(0.2 * R, 6 * dx), to = R - std::max(0.15 * R, 5 * dx);
    double count = 0, sum = 0, squares = 0;
    std::vector<double> exact;
    for (std::size_t n = 0; n < profile.rho.size(); ++n) {
        exact.push_back(profile.distance[n] < R ? wall.shock.density : wall.density);
        if (profile.distance[n] < from || profile.distance[n] > to) continue;
        count += 1, sum += profile.rho[n], squares += profile.rho[n] * profile.rho[n];
    }
    if (count > 0) {
        const double mean = sum / count;
        run.result("density_behind_shock", mean, "mass/length^3", wall.shock.density, source);
        run.summary.result_at_most(
            "density_scatter", std::sqrt(std::max(0.0, squares / count - mean * mean)),
            "mass/length^3", 0.05 * (wall.shock.density - wall.density),
            "rms over the cells behind the shock, where it is uniform: a twentieth of the jump");
        const auto times = run.history.column("time"),
                   distance = run.history.column("shock_distance");
        const auto later = [&](std::span<const double> rows) {
            return rows.subspan(rows.size() / 2);
        };
        run.result("shock_speed", common::slope(later(times), later(distance)), "velocity",
                   wall.shock.speed_from_wall, source + "; from the wall, in the second half");
        run.summary.result("shock_distance", distance.back(), "length",
                           wall.shock.speed_from_wall * times.back(),
                           std::max(3 * dx, parameters.theory_tolerance * R), source);
    } else {
        run.not_measured(
            "density_behind_shock", "the shock is ", R / dx,
            " cells from the wall, and 12 are needed: raise time.end, or refine the mesh");
    }
    run.info("wall_density_over_theory", profile.rho[0] / wall.shock.density, "",
             "wall heating: the cell at the wall");
    common::write_table(run.profile, {{"distance", "length", profile.distance},
                                      {"rho", "mass/length^3", profile.rho},
                                      {"rho_exact", "mass/length^3", exact}});
}

/// The results of wall_shock, after the Mach number of the shock.
inline void compare_piston(const FinishedRun& run) {
    const double mach = struck_wall(run.parameters).shock.mach;
    if (std::isfinite(mach))
        run.info("theory_mach", mach, "", "balance of mass, momentum and energy across the shock");
    compare_wall_shock(run);
}

inline constexpr Comparison wall_shock_comparison{"wall_shock",       validate_wall_shock,
                                                  predict_wall_shock, nullptr,
                                                  track_wall_shock,   compare_wall_shock};

inline constexpr Comparison piston_comparison{"piston", validate_piston,  predict_wall_shock,
                                              nullptr,  track_wall_shock, compare_piston};

}  // namespace flip
