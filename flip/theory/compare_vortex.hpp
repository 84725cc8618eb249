// Flows that should turn for ever: Gresho's vortex, and a disk that turns rigidly.
#pragma once

#include "flip/theory/comparison.hpp"
#include "flip/theory/diffusion.hpp"
#include "flip/theory/vortex.hpp"

namespace flip {

/// The region with the vortex.
inline const RegionCase& gresho_region(const Case& parameters) {
    return region_with_flow(parameters, "gresho");
}

/// The time in which the core turns once.
inline double turn_of_gresho(const Case& parameters) {
    return std::fabs(pi * gresho_region(parameters).width / gresho_region(parameters).speed);
}

/// Needs a vortex that moves with the frame of theory.
inline void validate_gresho(const Case& parameters, const Refusal& refuse) {
    validate_flow(parameters, refuse, "gresho");
    validate_no_force(parameters, refuse);
    const RegionCase& r = gresho_region(parameters);
    refuse(r.speed == 0, " needs a flow: give region.", r.name, ".speed");
    refuse((parameters.frame_x != 0 && !parameters.grid.x.periodic) ||
               (parameters.frame_z != 0 && !parameters.grid.z.periodic),
           " in a moving frame needs periodic ends in that direction");
    refuse(r.gas.velocity_x != parameters.frame_x || r.gas.velocity_z != parameters.frame_z,
           ": the vortex moves with ", r.gas.velocity_x, ", ", r.gas.velocity_z,
           ": set theory.frame_x and frame_z to that");
}

/// The time of one turn.
inline std::string predict_gresho(const Case& parameters, const std::string&, double) {
    return sentence("one turn in t = ", turn_of_gresho(parameters));
}

/// Warns of a run shorter than half a turn.
inline void warn_of_gresho(const Case& parameters, std::vector<std::string>& warnings) {
    warn(warnings,
         parameters.regions.size() == 1 && parameters.end < 0.5 * turn_of_gresho(parameters),
         "time.end = ", parameters.end, " is less than half a turn of the vortex, ",
         turn_of_gresho(parameters), ": what one turn loses is extrapolated");
}

/// Kinetic energy and angular momentum about the middle of the vortex, both in its frame.
inline void track_gresho(const Snapshot& now, common::Row& row) {
    const Case& parameters = now.parameters;
    const CellFields& cells = now.cells;
    const RegionCase& r = gresho_region(parameters);
    const double V2 =
        parameters.frame_x * parameters.frame_x + parameters.frame_z * parameters.frame_z;
    const double kinetic = now.totals.kinetic - parameters.frame_x * now.totals.momentum_x -
                           parameters.frame_z * now.totals.momentum_z + 0.5 * now.totals.mass * V2;
    const double x0 = r.center_x + parameters.frame_x * now.state.time,
                 z0 = r.center_z + parameters.frame_z * now.state.time;
    double swirl = 0;
    visit_cells(parameters.grid, [&](long c, double x, double z) {
        const double dx = apart(parameters.grid.x, x0, x), dz = apart(parameters.grid.z, z0, z);
        swirl +=
            cells.rho[c] * parameters.grid.cell_area() *
            (dx * (cells.vz[c] - parameters.frame_z) - dz * (cells.vx[c] - parameters.frame_x));
    });
    row.add("kinetic_in_frame", "energy/length", kinetic);
    row.add("swirl", "momentum", swirl);
}

/// What one turn leaves of the vortex.
///   kept = (at the end / at the start)^(turn / duration)
inline void compare_gresho(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const RegionCase& region = gresho_region(parameters);
    const double t = run.state.time, turn = turn_of_gresho(parameters);
    const auto times = run.history.column("time");
    const std::string source = "exact: it turns for ever; of one turn";
    const auto kept = [&](const char* name) {
        const auto values = run.history.column(name);
        const double ratio = values.back() / values.front();
        return ratio > 0 ? std::pow(ratio, turn / times.back()) : 0.0;
    };
    const bool flip = run.program == "flip", noisy = flip && !parameters.implicit(),
               confined = flip && parameters.confined;
    std::string cures;
    const auto advise = [&](bool missing, const char* cure) {
        if (missing) cures += sentence(cures.empty() ? ", or take " : ", ", cure);
    };
    advise(!flip, "flip");
    advise(confined, "flip.confined = false");
    advise(noisy, "flip.pressure = \"implicit\"");
    advise(flip && parameters.density != "particles", "flip.density = \"particles\"");
    advise(flip && parameters.transfer != "flip", "flip.transfer = \"flip\"");
    advise(parameters.q_linear > 0, "viscosity.linear = 0");
    advise(parameters.viscosity > 0, "flip.viscosity = 0");
    run.hint("the core is ", region.width / parameters.grid.x.spacing(), " cells wide",
             noisy ? ", and an explicit step makes noise at low Mach numbers" : "",
             confined ? ", and paths that are confined change its energy" : "", ": refine the mesh",
             cures.empty() ? ", or raise particles.per_cell_x and per_cell_z" : cures);
    run.result("kinetic_energy_kept", kept("kinetic_in_frame"), "", 1, source);
    run.result("angular_momentum_kept", kept("swirl"), "", 1, source);
    run.info("turns", t / turn, "", "of the core");
    run.info("largest_divergence", run.history.largest("divergence"), "speed/dx",
             "after the implicit pressure");
    const RadialProfile profile = radial_profile(
        parameters.grid, run.cells, region.center_x + parameters.frame_x * t,
        region.center_z + parameters.frame_z * t, parameters.frame_x, parameters.frame_z);
    std::vector<double> exact;
    for (const double r : profile.r)
        exact.push_back(region.speed * theory::gresho_vortex(2 * r / region.width).velocity);
    common::write_table(run.profile, {{"r", "length", profile.r},
                                      {"v_phi", "velocity", profile.v_phi},
                                      {"v_r", "velocity", profile.v_r},
                                      {"p", "pressure", profile.p},
                                      {"v_exact", "velocity", exact}});
}

/// Needs dust that turns rigidly about the middle of the trap, which alone holds it on its circles.
inline void validate_rotation(const Case& parameters, const Refusal& refuse) {
    validate_flow(parameters, refuse, "rotation");
    const RegionCase& r = region_with_flow(parameters, "rotation");
    refuse(r.speed == 0, " needs a flow: give region.", r.name, ".speed");
    refuse(material_of(parameters, r).gamma > 1 && sound_speed_of(parameters, r) > 0,
           " is for dust, and region.", r.name,
           " has a pressure, which drives it apart: take a material of gamma = 1");
    const double rate = r.speed / r.width;
    refuse(!(std::fabs(parameters.trap - rate * rate) <= 1e-9 * rate * rate),
           " needs a trap that bends all paths to circles: set gravity.trap = (speed/width)^2 = ",
           common::number_text(rate * rate));
    refuse(parameters.gravity_x != 0 || parameters.gravity_z != 0,
           " is without gravity: take out gravity.x and gravity.z");
    const auto off = [](const common::Axis& axis, double center) {
        return std::fabs(center - axis.low - 0.5 * axis.length) > 1e-9 * axis.length;
    };
    refuse(off(parameters.grid.x, r.center_x) || off(parameters.grid.z, r.center_z) ||
               r.gas.velocity_x != 0 || r.gas.velocity_z != 0,
           " needs a disk that stays in the middle of the mesh, where the trap is: set region.",
           r.name, ".center_x, center_z and its velocity to that");
}

/// note:   PIC's transfer loses 2 h^2/(3 R^2) in each step; blends lose their part of that
inline void compare_rotation(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const RegionCase& region = region_with_flow(parameters, "rotation");
    const double rate = region.speed / region.width, h = parameters.grid.x.spacing();
    const double L = run.totals.angular_momentum / run.history.first("angular_momentum"),
                 K = run.totals.kinetic / run.history.first("kinetic");
    const double turns = rate * run.state.time / (2 * pi);
    run.info("revolutions", turns, "", "of the disk");
    if (std::fabs(turns) < 0.1)
        return run.not_measured("angular_momentum_kept", "the disk has made ", turns,
                                " turns, and theory is tried by a tenth at least: raise time.end");
    if (std::max(L, K) > 1)
        run.hint(
            "steps of finite length carry particles outward, and both rise with them: lower "
            "time.cfl, or time.dt where it is set");
    else
        run.hint("what the transfer takes in each step adds up over ",
                 run.history.column("time").size() - 1, " steps, with ", region.width / h,
                 " cells in the radius: refine the mesh, take longer steps, or flip.transfer = "
                 "\"flip\" in flip");
    std::string source = "exact: rigid rotation for ever";
    if (run.program == "flip" && parameters.transfer == "pic" && region.shape == "disk") {
        const double steps = double(run.history.column("time").size()) - 1;
        const double once = 1 - theory::round_trip_loss(h, region.radius);
        source += "; 2 h^2/(3 R^2) lost in each step leave " + format(std::pow(once, steps));
    }
    run.result("angular_momentum_kept", L, "", 1, source);
    run.result("kinetic_energy_kept", K, "", 1, source);
}

inline constexpr Comparison gresho_comparison{"gresho",       validate_gresho, predict_gresho,
                                              warn_of_gresho, track_gresho,    compare_gresho,
                                              Rows::several,  Frame::moves};

inline constexpr Comparison rotation_comparison{
    "rotation", validate_rotation, nullptr, nullptr, nullptr, compare_rotation, Rows::several};

}  // namespace flip
