// The cavity under a moving lid, at Reynolds number 100 and after it has come to rest, against the
// computation of Ghia, Ghia and Shin.
#pragma once

#include <algorithm>
#include <numeric>

#include "flip/theory/comparison.hpp"
#include "flip/theory/table.hpp"

namespace flip {

/// Tables I and II of Ghia, Ghia and Shin.
inline constexpr const char* cavity_table = "flip/data/ghia_re100.csv";

/// Needs a square with a lid at Reynolds number 100.
inline void validate_cavity(const Case& parameters, const Refusal& refuse) {
    for (const BoundaryCase& end : parameters.boundaries)
        refuse(end.kind != "no_slip", " needs no_slip walls on all sides");
    validate_no_force(parameters, refuse);
    const double U = parameters.boundaries[z_high].slide;
    refuse(!(U > 0), " needs a lid that moves: set boundary.slide_z_high above 0");
    for (const Side end : {x_low, x_high, z_low})
        refuse(parameters.boundaries[end].slide != 0, " needs all walls but the lid at rest");
    refuse(std::fabs(parameters.grid.x.length - parameters.grid.z.length) >
               1e-9 * parameters.grid.x.length,
           " is for a square, and the mesh is ", parameters.grid.x.length, " x ",
           parameters.grid.z.length);
    const double inertia = parameters.regions.front().gas.density * U * parameters.grid.x.length,
                 Re = parameters.viscosity > 0 ? inertia / parameters.viscosity : 0;
    refuse(std::fabs(Re - 100) > 1,
           " is published for density speed length/flip.viscosity = 100, and it is ",
           Re > 0 ? format(Re) : "infinite", ": set flip.viscosity = ", inertia / 100);
    theory::read_table(cavity_table);
}

/// Velocities in units of the lid's along both middle lines of the mesh.
struct Midlines {
    std::vector<double> u, v;  // u on x = 1/2 from the bottom up, v on z = 1/2 from the left
};
/// Means of the two cells next to the middle, where the number of cells is even.
inline Midlines midlines(const Case& parameters, const CellFields& cells) {
    const Grid& grid = parameters.grid;
    const double U = parameters.boundaries[z_high].slide;
    const long i1 = (grid.x.cells - 1) / 2, i2 = grid.x.cells / 2, j1 = (grid.z.cells - 1) / 2,
               j2 = grid.z.cells / 2;
    Midlines lines;
    for (long j = 0; j < grid.z.cells; ++j)
        lines.u.push_back(0.5 * (cells.vx[grid.index(i1, j)] + cells.vx[grid.index(i2, j)]) / U);
    for (long i = 0; i < grid.x.cells; ++i)
        lines.v.push_back(0.5 * (cells.vz[grid.index(i, j1)] + cells.vz[grid.index(i, j2)]) / U);
    return lines;
}

/// Linear between the middles of the cells and the walls at s = 0 and 1.
inline double between_walls(const std::vector<double>& values, double low, double high, double s) {
    const double n = double(values.size()), at = s * n - 0.5;
    if (at <= 0) return low + (values.front() - low) * 2 * s * n;
    if (at >= n - 1) return high + (values.back() - high) * 2 * (1 - s) * n;
    const auto i = std::size_t(at);
    const double part = at - double(i);
    return (1 - part) * values[i] + part * values[i + 1];
}

/// Where the flow turns around: the largest flux between there and the bottom, in units of the box.
struct VortexCenter {
    double x = 0, z = 0, flux = 0;
};
/// The center from the stream function -integral u dz, with a parabola through three nodes.
inline VortexCenter vortex_center(const Case& parameters, const CellFields& cells) {
    const Grid& grid = parameters.grid;
    const double U = parameters.boundaries[z_high].slide, nx = double(grid.x.cells),
                 nz = double(grid.z.cells);
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
    return {(double(at_i) + 0.5 + di) / nx, (double(at_j) + dj) / nz, here};
}

/// Where the vortex is.
inline void track_cavity(const Snapshot& now, common::Row& row) {
    const VortexCenter center = vortex_center(now.parameters, now.cells);
    row.add("vortex_x", "length_x", center.x);
    row.add("vortex_z", "length_z", center.z);
}

/// Profiles through the middle, the center of the vortex, and how steady the flow is.
inline void compare_cavity(const FinishedRun& run) {
    const Case& parameters = run.parameters;
    const auto table = theory::read_table(cavity_table);
    const std::vector<double>&y = table.at("y"), &u = table.at("u"), &x = table.at("x"),
          &v = table.at("v");
    const Midlines lines = midlines(parameters, run.cells);
    std::vector<double> u_here, v_here;
    double u_most = 0, v_most = 0;
    for (std::size_t n = 0; n < y.size(); ++n) {
        u_here.push_back(between_walls(lines.u, 0, 1, y[n]));
        v_here.push_back(between_walls(lines.v, 0, 0, x[n]));
        u_most = std::max(u_most, std::fabs(u_here[n] - u[n]));
        v_most = std::max(v_most, std::fabs(v_here[n] - v[n]));
    }
    const std::string source = "Ghia, Ghia and Shin 1982, tables I and II";
    const double turn = 4 * parameters.grid.x.length / parameters.boundaries[z_high].slide;
    const auto times = run.history.column("time");
    run.hint("the table is of a steady flow on a fine mesh: after ", times.back() / turn,
             " turns of the vortex (3 are enough) raise time.end, else refine the mesh of ",
             parameters.grid.x.cells, " cells, or take ", run.flip_with(),
             "flip.transfer = \"apic\"");
    run.summary.result_at_most("largest_u_difference", u_most, "lid speed",
                               parameters.theory_tolerance, source);
    run.summary.result_at_most("largest_v_difference", v_most, "lid speed",
                               parameters.theory_tolerance, source);
    // The last turn of the vortex, whose core turns in 4 pi/vorticity, and how steady the flow is then.
    long first = long(times.size()) - 1;
    while (first > 0 && times[first - 1] >= times.back() - turn) --first;
    const auto of_turn = [&](const char* name) {
        const auto column = run.history.column(name);
        return std::vector<double>(column.begin() + first, column.end());
    };
    const auto mean = [](const std::vector<double>& f) {
        return std::accumulate(f.begin(), f.end(), 0.0) / double(f.size());
    };
    const std::string of_last_turn = source + "; mean of the last turn, 4 length/lid speed";
    run.absolute_result("vortex_x", mean(of_turn("vortex_x")), "length_x", 0.6172, of_last_turn);
    run.absolute_result("vortex_z", mean(of_turn("vortex_z")), "length_z", 0.7344, of_last_turn);
    run.info("vortex_flux", vortex_center(parameters, run.cells).flux, "lid speed*length",
             source + ": 0.1034");
    const auto kinetic = of_turn("kinetic");
    const auto [least, most] = std::ranges::minmax(kinetic);
    const double average = mean(kinetic);
    if (times.back() < turn)
        run.not_measured("unsteadiness", "the run is shorter than a turn of the vortex, ", turn,
                         ": raise time.end");
    else
        run.summary.result_at_most(
            "unsteadiness", average > 0 ? std::max(most - average, average - least) / average : 0,
            "", 0.01, "steady: kinetic energy within 1 % of its mean for the last turn");
    common::write_table(run.profile, {{"z_published", "length_z", y},
                                      {"u_published", "lid speed", u},
                                      {"u", "lid speed", u_here},
                                      {"x_published", "length_x", x},
                                      {"v_published", "lid speed", v},
                                      {"v", "lid speed", v_here}});
}

inline constexpr Comparison cavity_comparison{"cavity",     validate_cavity, nullptr,      nullptr,
                                              track_cavity, compare_cavity,  Rows::several};

}  // namespace flip
