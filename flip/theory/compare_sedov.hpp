// The blast wave of an energy that is set free in cold gas, against Sedov's solution.
#pragma once

#include "flip/theory/comparison.hpp"
#include "flip/theory/sedov.hpp"

namespace flip {

/// A blast: all its energy, with what mirrors behind slip walls add to it.
struct Blast {
    theory::BlastWave wave;
    double energy, density;
    double x, z;  // its middle
    double radius(double t) const { return theory::blast_radius(wave, energy, density, t); }
};

/// The region in which the energy is set free.
inline const RegionCase& hot_region(const Case& parameters) {
    for (const RegionCase& r : parameters.regions)
        if (r.energy > 0) return r;
    return parameters.regions.back();
}

/// Whether an end of the mesh mirrors the blast: a slip wall through its center.
inline bool mirrors_blast(const Case& parameters, Side end) {
    const RegionCase& hot = hot_region(parameters);
    const common::Axis& axis = is_x_side(end) ? parameters.grid.x : parameters.grid.z;
    return parameters.is(end, "slip") && std::fabs(way_to(parameters.grid, end, hot.center_x,
                                                          hot.center_z)) <= 0.5 * axis.spacing();
}

/// The blast of a case.
inline Blast blast_of(const Case& parameters) {
    const RegionCase &hot = hot_region(parameters), &cold = parameters.regions.front();
    const int around = parameters.grid.axisymmetric ? 1 : 0;
    double energy = hot.energy / (parameters.plane() ? 1 : parameters.grid.z.length);
    const auto mirrored = [&](Side low, Side high) {
        return mirrors_blast(parameters, low) || mirrors_blast(parameters, high) ? 2.0 : 1.0;
    };
    if (around == 0) energy *= mirrored(x_low, x_high);
    if (parameters.plane()) energy *= mirrored(z_low, z_high);
    return {theory::blast_wave(material_of(parameters, cold).gamma,
                               (parameters.plane() ? 2 : 1) + around),
            energy, cold.gas.density, hot.center_x, hot.center_z};
}

/// How many times the pressure of the cold gas that of the shock must be. As measured, at 100 the radius
/// is 0.2 per cent larger than without that pressure.
inline constexpr double least_pressure_ratio = 100;

/// Needs one region with an energy in cold gas, and room for the shock until the end.
inline void validate_sedov(const Case& parameters, const Refusal& refuse) {
    const RegionCase& cold = parameters.regions.front();
    const auto hot =
        std::ranges::count_if(parameters.regions, [](const RegionCase& r) { return r.energy > 0; });
    refuse(hot != 1 || parameters.regions.size() < 2 || cold.energy > 0,
           " needs a cold region first, and one with an energy inside it; ", hot, " have one");
    refuse(parameters.grid.axisymmetric && hot_region(parameters).center_x != 0,
           " needs the blast on the axis: ", hot_region(parameters).center_x, " is not 0");
    const double gamma = material_of(parameters, cold).gamma;
    refuse(!(gamma > 1 && gamma < 2), " is known for gamma between 1 and 2, and it is ", gamma);
    validate_no_force(parameters, refuse);
    refuse(cold.shape != "everywhere", " needs cold gas everywhere: set region.", cold.name,
           ".shape = \"everywhere\"");
    for (const RegionCase& r : parameters.regions) {
        refuse(r.flow != "uniform" || r.gas.velocity_x != 0 || r.gas.velocity_z != 0,
               " needs uniform gas at rest, and region.", r.name,
               " is not that: take out its flow and velocities");
        refuse(r.gas.density != cold.gas.density, " needs one density, and region.", r.name,
               " has ", r.gas.density, " where region.", cold.name, " has ", cold.gas.density,
               ": give both the same");
        refuse(!same_gas(material_of(parameters, r), material_of(parameters, cold)),
               " needs one gas, and region.", r.name, " is another than region.", cold.name,
               ": give both the same material");
    }
    const Blast blast = blast_of(parameters);
    const double R = blast.radius(parameters.end);
    for (const Side end : all_sides) {
        const bool axis = parameters.grid.axisymmetric && end == x_low;
        if (axis || (!parameters.plane() && !is_x_side(end)) || mirrors_blast(parameters, end))
            continue;
        const std::string name = side_names[end];
        const bool around = parameters.is(end, "periodic");
        const double length = (is_x_side(end) ? parameters.grid.x : parameters.grid.z).length,
                     way = way_to(parameters.grid, end, blast.x, blast.z);
        refuse(!around && way <= 0,
               " needs a blast on the mesh or on a wall that mirrors it: set boundary.", name,
               " = \"slip\" and the center on it, or move the center");
        refuse(R > (around ? 0.5 * length : way), ": at time.end the shock is at r = ", R,
               ", and it meets ", around ? "its image beyond " : "", name, " at ",
               around ? 0.5 * length : way, ": lower time.end, or move region.",
               hot_region(parameters).name);
    }
    const double U = theory::blast_speed(blast.wave, blast.energy, blast.density,
                                         std::max(parameters.end, 1e-300)),
                 shock = 2 * blast.density * U * U / (gamma + 1);
    for (const RegionCase& r : parameters.regions) {
        const double pressure = r.gas.pressure + material_of(parameters, r).p_infinity;
        refuse(r.energy == 0 && shock < least_pressure_ratio * pressure,
               " is for a blast that does not feel the gas in front of it: at time.end the shock "
               "has the pressure ",
               shock, ", and that of region.", r.name, " is ", pressure, ", more than 1/",
               least_pressure_ratio, " of it: lower it, or time.end");
    }
}

/// The radius of the shock at the end.
inline std::string predict_sedov(const Case& parameters, const std::string&, double) {
    return sentence("shock at r = ", blast_of(parameters).radius(parameters.end),
                    " at t = ", parameters.end);
}

/// Warns of what keeps hot gas from pushing cold gas.
inline void warn_of_sedov(const Case& parameters, std::vector<std::string>& warnings) {
    const double cells = hot_region(parameters).radius / parameters.grid.x.spacing();
    warn(warnings, parameters.density == "particles" && cells < 3, "the energy starts in ", cells,
         " cells, below 3, and with flip.density = \"particles\" hot and cold gas in a cell are "
         "strained alike: the blast will be too small, by 8 % with 0.75; raise the radius, or take "
         "\"cells\"");
}

/// The outer radius at which the density is half-way to its peak.
inline void track_sedov(const Snapshot& now, common::Row& row) {
    const Blast blast = blast_of(now.parameters);
    const RadialProfile profile = radial_profile(now.parameters.grid, now.cells, blast.x, blast.z);
    const double most = std::ranges::max(profile.rho);
    row.add("shock_radius", "length",
            outermost(profile.r, profile.rho, 0.5 * (blast.density + most)));
}

/// The radius of the shock, the peak of the density, and the profiles.
inline void compare_sedov(const FinishedRun& run) {
    const Blast blast = blast_of(run.parameters);
    const double t = run.state.time, R = blast.radius(t);
    const double dx = run.parameters.grid.x.spacing();
    const double hot = hot_region(run.parameters).radius / dx, come = R / dx;
    const bool near = come < std::max(40.0, 10 * hot), flips = run.program == "flip";
    const std::string& transfer = run.parameters.transfer;
    run.hint(
        flips && transfer == "pic" ? "flip.transfer = \"pic\" smears the blast: take \"flip\"; "
                                   : "",
        "the energy starts in ", hot, " cells, and the shock has come ", come, " cells: ",
        near ? "refine the mesh or raise time.end until that is 40 and ten times the first; keep "
             : "refine the mesh; keep ",
        flips ? "flip.density = \"cells\" and " : "",
        "viscosity.linear = 0.5, viscosity.quadratic = 1", hint_on_viscosity(run.parameters));
    const double needs = std::max(12.0, 6 * hot);
    if (come < needs)
        run.not_measured("shock_radius", "the shock has come ", come,
                         " cells, and the energy starts in ", hot,
                         " of them: theory is of energy from a point, and ", needs,
                         " are needed; raise time.end, or refine the mesh and lower region.",
                         hot_region(run.parameters).name, ".radius");
    else
        run.result("shock_radius", run.history.column("shock_radius").back(), "length",
                   blast.radius(run.history.column("time").back()),
                   "Sedov's similarity solution; outer half height of the density");
    const RadialProfile profile = radial_profile(run.parameters.grid, run.cells, blast.x, blast.z);
    std::vector<double> rho_exact, v_exact, p_exact;
    const double D = t > 0 ? theory::blast_speed(blast.wave, blast.energy, blast.density, t) : 0;
    for (const double r : profile.r) {
        const theory::BlastPoint at = theory::blast_point(blast.wave, R > 0 ? r / R : 2);
        rho_exact.push_back(blast.density * at.density);
        v_exact.push_back(D * at.velocity);
        p_exact.push_back(blast.density * D * D * at.pressure);
    }
    const double peak = std::ranges::max(profile.rho);
    run.info("peak_density_ratio", peak / blast.density, "",
             sentence("exact: ", (blast.wave.gamma + 1) / (blast.wave.gamma - 1)));
    common::write_table(run.profile, {{"r", "length", profile.r},
                                      {"rho", "mass/length^3", profile.rho},
                                      {"v_r", "velocity", profile.v_r},
                                      {"p", "pressure", profile.p},
                                      {"rho_exact", "mass/length^3", rho_exact},
                                      {"v_exact", "velocity", v_exact},
                                      {"p_exact", "pressure", p_exact}});
}

inline constexpr Comparison sedov_comparison{"sedov",       validate_sedov, predict_sedov,
                                             warn_of_sedov, track_sedov,    compare_sedov,
                                             Rows::any,     Frame::at_rest, true};

}  // namespace flip
