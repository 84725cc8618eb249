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

/// The blast of a case.
inline Blast blast_of(const Case& parameters) {
    const RegionCase &hot = hot_region(parameters), &cold = parameters.regions.front();
    const int around = parameters.grid.axisymmetric ? 1 : 0;
    double energy = hot.energy / (parameters.plane() ? 1 : parameters.grid.z.length);
    const auto mirrored = [&](Side low, const common::Axis& axis, double center) {
        const double near = 0.5 * axis.spacing();
        const bool at_low = parameters.is(low, "slip") && std::fabs(center - axis.low) <= near;
        const bool at_high =
            parameters.is(Side(low + 1), "slip") && std::fabs(center - axis.high()) <= near;
        return at_low || at_high ? 2.0 : 1.0;
    };
    if (around == 0) energy *= mirrored(x_low, parameters.grid.x, hot.center_x);
    if (parameters.plane()) energy *= mirrored(z_low, parameters.grid.z, hot.center_z);
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
    refuse(hot_region(parameters).gas.density != cold.gas.density,
           " needs the same density inside and outside: ", hot_region(parameters).gas.density,
           " and ", cold.gas.density);
    const Blast blast = blast_of(parameters);
    const auto room = [&](const common::Axis& axis, double center) {
        return std::max(axis.high() - center, center - axis.low);
    };
    double most = room(parameters.grid.x, blast.x);
    if (parameters.plane()) most = std::min(most, room(parameters.grid.z, blast.z));
    refuse(blast.radius(parameters.end) > most,
           ": at time.end the shock is at r = ", blast.radius(parameters.end),
           ", and the mesh ends at ", most, ": lower time.end");
    const double U = theory::blast_speed(blast.wave, blast.energy, blast.density,
                                         std::max(parameters.end, 1e-300)),
                 shock = 2 * blast.density * U * U / (gamma + 1),
                 cold_pressure = cold.gas.pressure + material_of(parameters, cold).p_infinity;
    refuse(shock < least_pressure_ratio * cold_pressure, " is for a blast that does not feel the ",
           "gas in front of it: at time.end the shock has the pressure ", shock,
           ", and that of region.", cold.name, " is ", cold_pressure, ", more than 1/",
           least_pressure_ratio, " of it: lower it, or time.end");
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
    run.hint("the energy starts in ", hot_region(run.parameters).radius / dx,
             " cells, and the shock has come ", R / dx,
             " cells: refine the mesh or raise time.end until that is 40 and ten times the first; "
             "keep flip.density = \"cells\" and viscosity.linear = 0.5, viscosity.quadratic = 1");
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
