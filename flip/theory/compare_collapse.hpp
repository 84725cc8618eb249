// An empty cavity that closes in the middle of a sphere of liquid, against Rayleigh's solution.
#pragma once

#include "flip/theory/collapse.hpp"
#include "flip/theory/comparison.hpp"

namespace flip {

/// The cavity of a case: half of it is on the mesh, and the lower wall is the mirror.
inline theory::EmptyCavity empty_cavity_of(const Case& parameters) {
    const RegionCase &gas = parameters.regions[0], &liquid = parameters.regions[1];
    const double L = parameters.grid.x.length, S = liquid.radius;
    return {parameters.regions[2].radius,
            liquid.gas.density,
            liquid.gas.pressure,
            S,
            2 * pi * L * L * parameters.grid.z.length - 4 * pi * S * S * S / 3,
            material_of(parameters, gas).gamma};
}

/// Needs gas everywhere, in it half a sphere of liquid, and in the middle of that a vacuum.
inline void validate_collapse(const Case& parameters, const Refusal& refuse) {
    const auto& r = parameters.regions;
    refuse(!parameters.grid.axisymmetric || r.size() != 3 || r[0].shape != "everywhere" ||
               r[1].shape != "disk" || r[2].shape != "disk" || r[0].is_vacuum() ||
               r[1].is_vacuum() || !r[2].is_vacuum(),
           " needs rings, gas everywhere, in it a disk of liquid, and in that a disk of density 0, "
           "in this order");
    refuse(material_of(parameters, r[0]).p_infinity > 0 ||
               !(material_of(parameters, r[1]).p_infinity > 0),
           " needs region.", r[0].name, " of a gas, p_infinity = 0, and region.", r[1].name,
           " of a liquid");
    for (const Side s : all_sides)
        refuse(!parameters.is(s, "slip"), " needs walls: set boundary.", side_names[s],
               " = \"slip\"");
    validate_no_force(parameters, refuse);
    const double z = parameters.grid.z.low;
    for (const RegionCase& part : {r[1], r[2]})
        refuse(part.center_x != 0 || part.center_z != z, " needs the middle of liquid and cavity ",
               "on the axis and the lower wall: region.", part.name,
               ".center_x = 0, .center_z = ", z);
    refuse(r[1].gas.pressure != r[0].gas.pressure || !(r[0].gas.pressure > 0),
           " needs gas and liquid of one pressure above 0: ", r[0].gas.pressure, " and ",
           r[1].gas.pressure);
    refuse(double(r[0].gas.density) > 0.01 * double(r[1].gas.density),
           " knows no inertia of the gas: region.", r[0].name, ".density = ", r[0].gas.density,
           " is above a hundredth of that of the liquid, ", r[1].gas.density);
    for (const RegionCase& part : {r[0], r[1]})
        refuse(double(part.gas.velocity_x) != 0 || double(part.gas.velocity_z) != 0 ||
                   part.flow != "uniform",
               " begins at rest, and region.", part.name, " moves");
    const double S = r[1].radius,
                 room = std::min(parameters.grid.x.length, parameters.grid.z.length);
    refuse(!(r[2].radius < S && S < room),
           " needs the cavity in the liquid and the liquid on the mesh: radii ", r[2].radius,
           " and ", S, ", and the mesh ends at ", room);
}

/// When it is closed.
inline std::string predict_collapse(const Case& parameters, const std::string&, double) {
    return sentence("closed at t = ", theory::collapse_of(empty_cavity_of(parameters)).time.back());
}

/// The radius of a sphere of the volume that is empty: negative for more liquid than room.
/// note:   in all cells up to half-way to the surface of the liquid, whose density stays what it is
inline void track_collapse(const Snapshot& now, common::Row& row) {
    const theory::EmptyCavity cavity = empty_cavity_of(now.parameters);
    const Grid& grid = now.parameters.grid;
    const Field& rho =
        now.cells.rho_of[material_index(now.parameters, now.parameters.regions[1].gas.material)];
    double empty = 0;
    visit_cells(grid, [&](long n, double x, double z) {
        if (std::hypot(x, z - grid.z.low) < 0.5 * (cavity.radius + cavity.outer))
            empty += 2 * cell_volume(grid, column_of(grid, n)) * (1 - rho[n] / cavity.density);
    });
    row.add("cavity_radius", "length", std::cbrt(0.75 * empty / pi));
}

/// When the cavity is closed, and its radius until it is half of that of the start.
inline void compare_collapse(const FinishedRun& run) {
    const theory::EmptyCavity cavity = empty_cavity_of(run.parameters);
    const theory::Collapse exact = theory::collapse_of(cavity);
    const auto times = run.history.column("time"), radius = run.history.column("cavity_radius");
    const double R = cavity.radius, dx = run.parameters.grid.x.spacing();
    std::vector<double> expected, closed;
    double largest = 0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        expected.push_back(exact.radius_at(times[n]));
        closed.push_back(-std::pow(radius[n], 3));
        if (expected[n] >= 0.5 * R) largest = std::max(largest, std::fabs(radius[n] - expected[n]));
    }
    common::write_table(run.profile, {{"time", "time", times},
                                      {"radius", "length", radius},
                                      {"radius_exact", "length", expected}});
    double t = common::time_at_level(times, closed, 0);
    const double end = exact.time.back(), tolerance = 0.5 * dx / R * end;
    if (std::isnan(t) && times.back() <= end + tolerance)
        return run.not_measured("collapse_time", "the cavity still has the radius ", radius.back(),
                                ", and theory closes it at t = ", end, ": raise time.end");
    run.hint(std::isnan(t) ? "the cavity is still open at the end, the time that is given; " : "",
             "the liquid ends where a cell is full, and the cavity is ", R / dx,
             " cells wide: refine the mesh to 20, take ", run.flip_with(),
             "flip.density = \"particles\", flip.pressure = \"implicit\", flip.transfer = "
             "\"flip\", no viscosity, and a liquid with a large "
             "p_infinity");
    if (std::isnan(t)) t = times.back();
    run.summary.result("collapse_time", t, "time", end, tolerance,
                       "Rayleigh 1917, in a sphere of liquid; half a cell of the radius");
    run.summary.result_at_most("radius_difference", largest / dx, "dx", 1,
                               "largest until half the radius; a cell");
}

inline constexpr Comparison collapse_comparison{"collapse",
                                                validate_collapse,
                                                predict_collapse,
                                                nullptr,
                                                track_collapse,
                                                compare_collapse,
                                                Rows::several,
                                                Frame::at_rest,
                                                true,
                                                false,
                                                true};

}  // namespace flip
