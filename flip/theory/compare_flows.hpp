// Runs that are compared with a laboratory or with another computation: broken dams, cavities; and
// impacts.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/run/writers.hpp"
#include "flip/theory/finished_run.hpp"
#include "flip/theory/table.hpp"

namespace flip {

inline constexpr const char* cavity_table = "flip/data/ghia_re100.csv";
inline constexpr const char* dam_table = "flip/data/martin_moyce.csv";

/// Water behind a dam that is gone: its front in the scales of Martin and Moyce, whose column was
/// twice as high as wide.
/// note:   their dam took a time to vanish, so that speeds can be compared and times cannot
inline void compare_dam(const FinishedRun& run) {
    const Case& w = run.w;
    const WaterColumn water = water_of(w);
    const auto times = run.history.column("time"), front = run.history.column("front_x"),
               height = run.history.column("wall_height");
    std::vector<double> T, Z;
    for (std::size_t n = 0; n < times.size(); ++n) {
        T.push_back(theory::column_time(times[n], water.width, water.height, water.gravity));
        Z.push_back((front[n] - w.grid.x.low) / water.width);
    }
    run.summary.result_info("front", Z.back(), "a", "at T = " + format(T.back()));
    run.summary.result_info("wall_height", height.back() / water.height, "H", "at the same time");
    if (std::fabs(water.height / water.width - 2) > 0.05) return;
    const auto table = theory::read_table(dam_table);
    const std::vector<double>&T_lab = table.at("T"), &Z_lab = table.at("Z");
    const double from = 2, to = 3.5;
    const double T1 = common::time_at_level(T, Z, from), T2 = common::time_at_level(T, Z, to),
                 L1 = common::time_at_level(T_lab, Z_lab, from),
                 L2 = common::time_at_level(T_lab, Z_lab, to);
    if (std::isnan(T1) || std::isnan(T2)) return;
    const std::string source = "Martin and Moyce 1952, column twice as high as wide";
    run.result("front_speed", (to - from) / (T2 - T1), "(g H)^1/2", (to - from) / (L2 - L1),
               source + "; from x = 2 a to 3.5 a");
    run.summary.result_info("front_ahead", 0.5 * (L1 + L2 - T1 - T2), "(a/(n^2 g))^1/2",
                            source + "; their dam took a time to vanish");
}

namespace detail {

// Velocities in units of the lid's along both middle lines of the mesh.
struct Midlines {
    std::vector<double> u, v;  // u on x = 1/2 from the bottom up, v on z = 1/2 from the left
};
inline Midlines midlines(const Case& w, const CellFields& cells) {
    const Grid& grid = w.grid;
    const double U = w.ends[z_high].slide;
    const long i1 = (grid.x.cells - 1) / 2, i2 = grid.x.cells / 2, j1 = (grid.z.cells - 1) / 2,
               j2 = grid.z.cells / 2;
    Midlines lines;
    for (long j = 0; j < grid.z.cells; ++j)
        lines.u.push_back(0.5 * (cells.vx[grid.index(i1, j)] + cells.vx[grid.index(i2, j)]) / U);
    for (long i = 0; i < grid.x.cells; ++i)
        lines.v.push_back(0.5 * (cells.vz[grid.index(i, j1)] + cells.vz[grid.index(i, j2)]) / U);
    return lines;
}

// Linear between the middles of the cells and the walls at s = 0 and 1.
inline double between_walls(const std::vector<double>& values, double low, double high, double s) {
    const double n = static_cast<double>(values.size()), at = s * n - 0.5;
    if (at <= 0) return low + (values.front() - low) * 2 * s * n;
    if (at >= n - 1) return high + (values.back() - high) * 2 * (1 - s) * n;
    const auto i = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(i);
    return (1 - part) * values[i] + part * values[i + 1];
}

// Where the flow turns around: the largest flux between there and the bottom, in units of the box.
struct VortexCenter {
    double x = 0, z = 0, flux = 0;
};
inline VortexCenter vortex_center(const Case& w, const CellFields& cells) {
    const Grid& grid = w.grid;
    const double U = w.ends[z_high].slide, nx = static_cast<double>(grid.x.cells),
                 nz = static_cast<double>(grid.z.cells);
    const auto flux = [&](long i, long j) {
        double sum = 0;
        for (long row = 0; row < j; ++row) sum += cells.vx[grid.index(i, row)] / (U * nz);
        return -sum;
    };
    long at_i = 1, at_j = 1;
    double most = 0;
    for (long i = 1; i + 1 < grid.x.cells; ++i) {
        double sum = 0;
        for (long j = 1; j < grid.z.cells; ++j) {
            sum -= cells.vx[grid.index(i, j - 1)] / (U * nz);
            if (sum > most) most = sum, at_i = i, at_j = j;
        }
    }
    // The top of the parabola through three neighbors.
    const auto top = [](double a, double b, double c) {
        const double bend = a - 2 * b + c;
        return bend < 0 ? 0.5 * (a - c) / bend : 0.0;
    };
    const double here = flux(at_i, at_j);
    const double di = top(flux(at_i - 1, at_j), here, flux(at_i + 1, at_j)),
                 dj = top(flux(at_i, at_j - 1), here, flux(at_i, at_j + 1));
    return {(static_cast<double>(at_i) + 0.5 + di) / nx, (static_cast<double>(at_j) + dj) / nz,
            here};
}

}  // namespace detail

/// The cavity under a moving lid, at Reynolds number 100 and after it has come to rest.
inline void compare_cavity(const FinishedRun& run) {
    const Case& w = run.w;
    const auto table = theory::read_table(cavity_table);
    const std::vector<double>&y = table.at("y"), &u = table.at("u"), &x = table.at("x"),
          &v = table.at("v");
    const detail::Midlines lines = detail::midlines(w, run.cells);
    std::vector<double> u_here, v_here;
    double u_most = 0, v_most = 0;
    for (std::size_t n = 0; n < y.size(); ++n) {
        u_here.push_back(detail::between_walls(lines.u, 0, 1, y[n]));
        v_here.push_back(detail::between_walls(lines.v, 0, 0, x[n]));
        u_most = std::max(u_most, std::fabs(u_here[n] - u[n]));
        v_most = std::max(v_most, std::fabs(v_here[n] - v[n]));
    }
    const std::string source = "Ghia, Ghia and Shin 1982, tables I and II";
    run.summary.result("largest_u_difference", u_most, "lid speed", 0, w.theory_tolerance, source);
    run.summary.result("largest_v_difference", v_most, "lid speed", 0, w.theory_tolerance, source);
    const detail::VortexCenter center = detail::vortex_center(w, run.cells);
    run.summary.result("vortex_x", center.x, "length_x", 0.6172, w.theory_tolerance, source);
    run.summary.result("vortex_z", center.z, "length_z", 0.7344, w.theory_tolerance, source);
    run.summary.result_info("vortex_flux", center.flux, "lid speed*length", source + ": 0.1034");

    // How far from steady the flow is: the change of its energy over the last tenth of the run.
    const auto times = run.history.column("time"), kinetic = run.history.column("kinetic");
    std::size_t before = times.size() - 1;
    while (before > 0 && times[before] > 0.9 * times.back()) --before;
    run.summary.result_info("change_of_kinetic_energy",
                            kinetic.back() > 0 ? 1 - kinetic[before] / kinetic.back() : 0, "",
                            "over the last tenth of the run");
    common::write_table(run.profile, {{"z_published", "length_z", y},
                                      {"u_published", "lid speed", u},
                                      {"u", "lid speed", u_here},
                                      {"x_published", "length_x", x},
                                      {"v_published", "lid speed", v},
                                      {"v", "lid speed", v_here}});
}

/// Something fast hits something at rest: what is conserved, and what the target has got.
inline void compare_impact(const FinishedRun& run) {
    const double round_off = 1e-12;
    for (const char* name : {"mass_error", "momentum_x_error", "momentum_z_error", "energy_error"})
        run.summary.result(std::string("largest_") + name, run.history.largest(name), "", 0,
                           round_off, "exact but for round-off");
    const Impact impact = impact_of(run.w);
    const GasCase& gas = impact.projectile->gas;
    const char* along =
        std::fabs(gas.velocity_x) >= std::fabs(gas.velocity_z) ? "momentum_x" : "momentum_z";
    const double momentum = run.history.first(along);
    const double given = run.history.column(std::string("target_") + along).back();
    run.summary.result_info("momentum_given", momentum != 0 ? given / momentum : 0, "",
                            "part of all that the target has at the end");
    const auto depth = run.history.column("depth");
    run.summary.result_info("depth", *std::max_element(depth.begin(), depth.end()), "length",
                            "of the foremost particle behind the face of the target");
    run.summary.result_info("kinetic_energy_left",
                            run.totals.kinetic / run.history.first("kinetic"), "",
                            "relative to the start");
}

}  // namespace flip
