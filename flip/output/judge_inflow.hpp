// Gas that comes in slower than sound: an inflow gives its density, pressure and velocity, and one of
// the three belongs to the gas in front of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "common/run/summary.hpp"
#include "flip/setup/problem_of_case.hpp"
#include "flip/state.hpp"

namespace flip {

/// The fluid in the cells in front of an end.
struct FluidInFront {
    double density = 0, pressure = 0, velocity = 0, mach = 0;  // velocity into the mesh
    double distance = 0;                                       // of the farthest cell
};

/// The mean from the fifth to the twelfth cell, beyond those in which what comes in becomes what is there.
/// out:    density 0 where there is another material, too, or no pressure
inline FluidInFront fluid_in_front(const Case& parameters, const CellFields& cells, Side side,
                                   const Inflow& in) {
    const Grid& grid = parameters.grid;
    const bool along_x = is_x_side(side);
    const common::Axis& across = along_x ? grid.x : grid.z;
    const long from = std::min(4L, across.cells / 4), to = std::min(12L, across.cells / 2);
    double volume = 0, mass = 0, others = 0, momentum = 0, pV = 0;
    for (long j = 0; j < grid.z.cells; ++j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const long at = along_x ? i : j, way = is_low_side(side) ? at : across.cells - 1 - at;
            if (way < from || way >= to) continue;
            const long n = grid.index(i, j);
            const double V = cell_volume(grid, i), m = cells.rho[n] * V;
            volume += V, mass += m, others += m - cells.rho_of[in.material][n] * V;
            momentum += m * (along_x ? cells.vx : cells.vz)[n], pV += cells.p[n] * V;
        }
    }
    if (!(mass > 0) || others > 1e-6 * mass || !(pV > 0)) return {};
    FluidInFront f{mass / volume, pV / volume, (is_low_side(side) ? 1 : -1) * momentum / mass};
    f.mach = f.velocity /
             std::sqrt(stiffness(parameters.materials[in.material], f.pressure) / f.density);
    f.distance = double(to) * across.spacing();
    return f;
}

/// The sentence that says how such an inflow does not go beyond Mach 1: an end that draws less, or gas
/// that comes in at Mach 1 with the same mass flux and total enthalpy.
///   u = c,   u^2 [1/2 + 1/(gamma - 1)] = c_in^2/(gamma - 1) + u_in^2/2,   rho u = rho_in u_in
inline std::string cure_of_inflow(const Case& parameters, Side side, const Inflow& in, double u) {
    const Material& a = parameters.materials[in.material];
    const std::string name = side_names[side], other = side_names[side ^ 1];
    const double g = a.gamma - 1, total = in.c * in.c / g + 0.5 * u * u,
                 sonic = std::sqrt(total / (0.5 + 1 / g)), rho = in.rho * u / sonic,
                 p = rho * sonic * sonic / a.gamma - a.p_infinity;
    std::string cure;
    if (parameters.boundaries[side ^ 1].kind == "open" &&
        parameters.boundaries[side ^ 1].pressure < in.p)
        cure = sentence("set boundary.pressure_", other, " = ", in.p, ", that of what comes in");
    if (p > 0)
        cure += sentence(cure.empty() ? "" : ", or ", "let it come in at Mach 1 with that mass ",
                         "flux and enthalpy, as a pipe that is drawn empty makes it: inflow.", name,
                         " with density = ", rho, ", pressure = ", p, ", velocity_",
                         name.substr(0, 1), " = ", is_low_side(side) ? sonic : -sonic);
    return cure;
}

/// Judges each inflow of gas slower than sound into a pipe: gas in front of it is not faster than sound.
///   Mach <= 1.1 + x/(c t)   in a fan that empties the pipe u - c = x/t; and a tenth for noise
/// Warns where that gas has another pressure than what comes in.
inline void judge_inflows(const Case& parameters, double time, const CellFields& cells,
                          common::Summary& summary) {
    for (const Side side : all_sides) {
        if (!parameters.is(side, "inflow")) continue;
        const Inflow in = detail::inflow_of(parameters, parameters.boundaries[side].inflow);
        const double u = std::fabs(is_x_side(side) ? in.vx : in.vz);
        const FluidInFront front = fluid_in_front(parameters, cells, side, in);
        // At Mach 1 nothing runs back to the inflow; and what came in has to fill these cells.
        if (!(u < 0.99 * in.c) || front.density == 0 ||
            in.rho * u * time < front.density * front.distance)
            continue;
        const std::string name = side_names[side];
        const auto lets_out = [&](Side beside) {
            return parameters.is(beside, "open") || parameters.is(beside, "inflow");
        };
        const Side beside = is_x_side(side) ? z_low : x_low;
        const bool pipe = !lets_out(beside) && !lets_out(static_cast<Side>(beside + 1));
        const double limit = 1.1 + front.distance / (in.c * time);
        if (pipe && limit < 2) {
            const std::string cure = cure_of_inflow(parameters, side, in, u);
            summary.hint(sentence(
                "an inflow slower than sound keeps its mass flux and not its pressure, and where "
                "the pipe draws more than that, the gas leaves it in a jump that loses entropy",
                cure.empty() ? "" : ": ", cure));
            summary.result_at_most("mach_behind_" + name, front.mach, "", limit,
                                   sentence("gas that came in at Mach ", u / in.c,
                                            " stays below 1 in a pipe; 0.1 + x/(c t) more"));
            if (front.mach > limit) continue;
        }
        const double K = stiffness(parameters.materials[in.material], in.p);
        if (!(std::fabs(front.pressure - in.p) > 0.05 * K)) continue;
        const BoundaryCase& end = parameters.boundaries[side ^ 1];
        summary.late_warnings.push_back(sentence(
            "the gas behind inflow.", name, " has the pressure ", front.pressure,
            ", and what comes in ", in.p, ": slower than sound an inflow keeps its mass flux, and ",
            "there the gas goes on with density ", front.density, " and velocity ", front.velocity,
            end.kind == "open" && end.pressure != in.p
                ? sentence("; where it should stay as it comes in, set boundary.pressure_",
                           side_names[side ^ 1], " = ", in.p)
                : ""));
    }
}

}  // namespace flip
