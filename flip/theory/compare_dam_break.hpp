// Water behind a dam that is gone, against the laboratory of Martin and Moyce.
#pragma once

#include "flip/theory/comparison.hpp"
#include "flip/theory/table.hpp"

namespace flip {

/// The fronts of Martin and Moyce.
inline constexpr const char* dam_table = "flip/data/martin_moyce.csv";

/// The time of Martin and Moyce, for a column of width a and height n^2 a.
///   T = t (n^2 g / a)^1/2
/// exact: Ritter's front is at x / a = 1 + 2 T from the wall behind the column
/// source: Martin and Moyce, Phil. Trans. R. Soc. London A 244, 312 (1952).
inline double column_time(double t, double width, double height, double gravity) {
    return t * std::sqrt(height * gravity) / width;
}

/// The column of water of a broken dam: the last region, from x_low and z_low on.
struct WaterColumn {
    double width, height, density, gravity;
    int material;
};
/// The column of water of a case.
inline WaterColumn water_of(const Case& parameters) {
    const RegionCase& r = parameters.regions.back();
    return {r.center_x + r.half_x - parameters.grid.x.low,
            r.center_z + r.half_z - parameters.grid.z.low, r.gas.density, -parameters.gravity_z,
            material_index(parameters, r.gas.material)};
}

/// Needs a box of water in the corner of a wall and a floor.
inline void validate_dam_break(const Case& parameters, const Refusal& refuse) {
    const RegionCase& r = parameters.regions.back();
    refuse(r.shape != "box", " needs a box of water as the last region");
    const WaterColumn water = water_of(parameters);
    refuse(!(water.gravity > 0), " needs gravity.z below 0, and it is ", parameters.gravity_z);
    refuse(parameters.gravity_x != 0 || parameters.trap != 0,
           " is for water that gravity.z alone pulls: take out gravity.x and gravity.trap");
    refuse(!parameters.is(x_low, "slip") || !parameters.is(z_low, "slip"),
           " needs a wall at x_low and a floor at z_low: set both to \"slip\"");
    const double gap = std::max(r.center_x - r.half_x - parameters.grid.x.low,
                                r.center_z - r.half_z - parameters.grid.z.low);
    refuse(gap > 0.5 * parameters.grid.x.spacing(),
           " needs the water in the corner of x_low and z_low, and it is ", gap, " away");
    refuse(water.width >= parameters.grid.x.length, " needs room beyond the water: lower region.",
           r.name, ".half_x below ", 0.5 * parameters.grid.x.length);
    theory::read_table(dam_table);
}

/// Water along the floor, up to half density, and along the wall behind it.
inline void track_dam_break(const Snapshot& now, common::Row& row) {
    const Grid& grid = now.parameters.grid;
    const WaterColumn water = water_of(now.parameters);
    const auto filled = [&](long i, long j) {
        return now.cells.rho_of[water.material][grid.index(i, j)] / water.density;
    };
    long i = 0;
    while (i < grid.x.cells && filled(i, 0) >= 0.5) ++i;
    const double inside = i > 0 ? filled(i - 1, 0) : 1,
                 outside = i < grid.x.cells ? filled(i, 0) : 0;
    const double beyond = inside > outside ? (inside - 0.5) / (inside - outside) : 0.5;
    double height = 0;
    for (long j = 0; j < grid.z.cells; ++j) height += filled(0, j) * grid.z.spacing();
    row.add("front_x", "length",
            grid.x.at(std::clamp(double(i) - 0.5 + beyond, 0.0, double(grid.x.cells))));
    row.add("wall_height", "length", height);
}

/// The front in the scales of Martin and Moyce, whose column was twice as high as wide.
/// note:   their dam took a time to vanish, so that speeds can be compared and times cannot
inline void compare_dam_break(const FinishedRun& run) {
    const WaterColumn water = water_of(run.parameters);
    const auto times = run.history.column("time"), front = run.history.column("front_x"),
               height = run.history.column("wall_height");
    std::vector<double> T, Z;
    for (std::size_t n = 0; n < times.size(); ++n) {
        T.push_back(column_time(times[n], water.width, water.height, water.gravity));
        Z.push_back((front[n] - run.parameters.grid.x.low) / water.width);
    }
    run.info("front", Z.back(), "a", "at T = " + format(T.back()));
    run.info("wall_height", height.back() / water.height, "H", "at the same time");
    if (std::fabs(water.height / water.width - 2) > 0.05)
        return run.not_measured("front_speed", "the column is ", water.height / water.width,
                                " times as high as wide, and that of the laboratory was twice: set "
                                "half_z to twice half_x, and center_z to half_z");
    const auto table = theory::read_table(dam_table);
    const std::vector<double>&T_lab = table.at("T"), &Z_lab = table.at("Z");
    const double from = 2, to = 3.5;
    const double T1 = common::time_at_level(T, Z, from), T2 = common::time_at_level(T, Z, to),
                 L1 = common::time_at_level(T_lab, Z_lab, from),
                 L2 = common::time_at_level(T_lab, Z_lab, to);
    if (std::isnan(T1) || std::isnan(T2))
        return run.not_measured(
            "front_speed", "the front has come to x = ", Z.back(),
            " a, and its speed is that from 2 a to 3.5 a: raise time.end, or lengthen the mesh");
    const std::string source = "Martin and Moyce 1952, column twice as high as wide";
    run.hint("the front is a wedge, thinner than a cell at its tip, and the column is ",
             water.width / run.parameters.grid.x.spacing(),
             " cells wide: refine the mesh to 20, take ", run.flip_with(),
             "flip.density = \"particles\", and keep "
             "viscosity and pic's part of the transfer small");
    run.result("front_speed", (to - from) / (T2 - T1), "(g H)^1/2", (to - from) / (L2 - L1),
               source + "; from x = 2 a to 3.5 a");
    run.info("front_ahead", 0.5 * (L1 + L2 - T1 - T2), "(a/(n^2 g))^1/2",
             source + "; their dam took a time to vanish");
}

inline constexpr Comparison dam_break_comparison{
    "dam_break",     validate_dam_break, nullptr,      nullptr,
    track_dam_break, compare_dam_break,  Rows::several};

}  // namespace flip
