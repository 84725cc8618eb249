// What a run follows besides its conserved quantities: a mode, a shock, a front.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

#include "common/run/history.hpp"
#include "flip/theory/profiles.hpp"
#include "flip/theory/theory_of_case.hpp"

namespace flip {

using common::format;

/// Largest sound speed of the fluid at the start, from the uniform states of the case.
inline double largest_sound_speed(const Case& w) {
    double most = 0;
    for (const RegionCase& r : w.regions) most = std::max(most, sound_speed_of(w, r));
    return most;
}

struct Extremes {
    double speed = 0, mach = 0;
};

/// Largest speed and Mach number of a cell.
/// note:   the sound speed is that of the material with most mass in the cell; cells without sound,
///         as dust, have no Mach number
inline Extremes extremes(const Case& w, const CellFields& cells) {
    Extremes most;
    for (long j = 0; j < w.grid.z.cells; ++j) {
        for (long i = 0; i < w.grid.x.cells; ++i) {
            const long c = w.grid.index(i, j);
            if (!(cells.rho[c] > 0)) continue;
            std::size_t main = 0;
            for (std::size_t k = 1; k < cells.rho_of.size(); ++k)
                if (cells.rho_of[k][c] > cells.rho_of[main][c]) main = k;
            const double speed = std::hypot(cells.vx[c], cells.vz[c]);
            const double sound2 = stiffness(w.materials[main], cells.p[c]) / cells.rho[c];
            most.speed = std::max(most.speed, speed);
            if (sound2 > 0) most.mach = std::max(most.mach, speed / std::sqrt(sound2));
        }
    }
    return most;
}

namespace detail {

/// Density against the distance from the wall that the gas runs into.
struct FromWall {
    std::vector<double> distance, rho;
};
inline FromWall from_wall(const Case& w, const CellFields& cells) {
    FromWall s;
    const std::vector<double> rho = mean_over_z(w.grid, cells.rho);
    const bool low = struck_wall(w).at_low;
    for (std::size_t n = 0; n < rho.size(); ++n) {
        s.distance.push_back((static_cast<double>(n) + 0.5) * w.grid.x.spacing());
        s.rho.push_back(low ? rho[n] : rho[rho.size() - 1 - n]);
    }
    return s;
}

// Fourier amplitude along x of rows j_low <= j < j_high of a field; the phase is that at `from`.
//   (2/N) sum f exp(-i k (x - from))
inline std::complex<double> mode_of(const Case& w, const Field& f, long j_low, long j_high,
                                    double from) {
    const double k = followed_wave_number(w);
    std::complex<double> sum = 0;
    for (long j = j_low; j < j_high; ++j)
        for (long i = 0; i < w.grid.x.cells; ++i)
            sum += f[w.grid.index(i, j)] *
                   std::polar(1.0, -k * (w.grid.x.at(static_cast<double>(i) + 0.5) - from));
    return 2.0 / static_cast<double>(w.grid.x.cells * (j_high - j_low)) * sum;
}

// Height of the interface between two layers, from the mass of the columns,
//   (rho_lower - rho_upper) eta(x) = integral of rho over z - its mean
// note: it is linear in eta, where velocities at a fixed height lose (8/3 pi) k eta of themselves
inline std::complex<double> interface_height(const Case& w, const CellFields& cells) {
    const theory::TwoLayers layers = layers_of(w);
    return w.grid.z.length / (layers.lower_density - layers.upper_density) *
           mode_of(w, cells.rho, 0, w.grid.z.cells, upper_region(w).center_x);
}

// The rows on both sides of a height on the mesh; one row where it goes through its middle.
struct Rows {
    long low, high;
};
inline Rows rows_at(const common::Axis& axis, double z) {
    const double node = (z - axis.low) / axis.spacing(), nearest = std::floor(node + 0.5);
    const bool between = std::fabs(node - nearest) < 0.25;
    const long row = static_cast<long>(between ? nearest - 1 : std::floor(node));
    return {std::clamp(row, 0L, axis.cells - 1),
            std::clamp(row + (between ? 2 : 1), 1L, axis.cells)};
}

// Middle and variance along x of the energy above that of the background.
struct Blob {
    double middle, variance;
};
inline Blob blob_of(const Case& w, const CellFields& cells) {
    const RegionCase& r = region_with_flow(w, "gaussian");
    const double background = internal_energy(material_of(w, r), r.gas.density, r.gas.pressure);
    const Field above =
        cells.rho.cwiseProduct(cells.e - Field::Constant(w.grid.size(), background));
    const std::vector<double> heat = mean_over_z(w.grid, above);
    const common::Axis& axis = w.grid.x;
    const auto at = [&](std::size_t n) { return axis.at(static_cast<double>(n) + 0.5); };
    std::complex<double> turn = 0;
    for (std::size_t n = 0; n < heat.size(); ++n)
        turn += heat[n] * std::polar(1.0, 2 * pi * at(n) / axis.length);
    const double guess = std::arg(turn) / (2 * pi) * axis.length;
    double sum = 0, first = 0, second = 0;
    for (std::size_t n = 0; n < heat.size(); ++n) {
        const double d = apart(axis, guess, at(n));
        sum += heat[n], first += heat[n] * d, second += heat[n] * d * d;
    }
    const double mean = sum != 0 ? first / sum : 0;
    return {guess + mean, sum != 0 ? second / sum - mean * mean : 0};
}

// Water along the floor and along the wall behind it.
inline void add_dam(const Case& w, const CellFields& cells, common::Row& row) {
    const WaterColumn water = water_of(w);
    const Field& rho = cells.rho_of[water.material];
    const auto filled = [&](long i, long j) { return rho[w.grid.index(i, j)] / water.density; };
    long i = 0;
    while (i < w.grid.x.cells && filled(i, 0) >= 0.5) ++i;
    const double inside = i > 0 ? filled(i - 1, 0) : 1,
                 outside = i < w.grid.x.cells ? filled(i, 0) : 0;
    const double beyond = inside > outside ? (inside - 0.5) / (inside - outside) : 0.5;
    double height = 0;
    for (long j = 0; j < w.grid.z.cells; ++j) height += filled(0, j) * w.grid.z.spacing();
    row.add("front_x", "length", w.grid.x.at(std::max(0.0, static_cast<double>(i) - 0.5 + beyond)));
    row.add("wall_height", "length", height);
}

// Momentum of the target, and how far the projectile has come beyond its face.
inline void add_impact(const Case& w, const State& state, const CellFields& cells,
                       common::Row& row) {
    const Impact impact = impact_of(w);
    const auto index = [&](const RegionCase& r) { return material_index(w, r.gas.material); };
    const Field& rho = cells.rho_of[static_cast<std::size_t>(index(*impact.target))];
    double px = 0, pz = 0;
    for (long j = 0; j < w.grid.z.cells; ++j) {
        for (long i = 0; i < w.grid.x.cells; ++i) {
            const long c = w.grid.index(i, j);
            px += rho[c] * cells.vx[c] * w.grid.cell_area();
            pz += rho[c] * cells.vz[c] * w.grid.cell_area();
        }
    }
    const RegionCase &hit = *impact.target, &from = *impact.projectile;
    const bool along_x = std::fabs(from.gas.velocity_x) >= std::fabs(from.gas.velocity_z);
    const double sign = (along_x ? from.gas.velocity_x : from.gas.velocity_z) < 0 ? -1 : 1;
    const double face =
        sign * (along_x ? hit.center_x : hit.center_z) - (along_x ? hit.half_x : hit.half_z);
    const auto& positions = along_x ? state.particles.x_p : state.particles.z_p;
    double foremost = -std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < positions.size(); ++p)
        if (state.particles.material[p] == index(from))
            foremost = std::max(foremost, sign * positions[p]);
    row.add("target_momentum_x", "momentum/length", px);
    row.add("target_momentum_z", "momentum/length", pz);
    row.add("depth", "length", std::isfinite(foremost) ? foremost - face : 0.0);
}

}  // namespace detail

/// What the comparison of the case needs in the history, at the end of `row`.
inline void track(const Case& w, const State& state, const Totals& now, const CellFields& cells,
                  common::Row& row) {
    const auto add_mode = [&](const std::string& name, const std::string& unit,
                              const std::complex<double>& z) {
        row.add(name + "_re", unit, z.real());
        row.add(name + "_im", unit, z.imag());
    };
    if (w.compare == "wall_shock" || w.compare == "piston") {
        const StruckWall wall = struck_wall(w);
        const detail::FromWall profile = detail::from_wall(w, cells);
        const double level = 0.5 * (wall.density + wall.shock.density);
        row.add("shock_distance", "length", outermost(profile.distance, profile.rho, level));
    } else if (w.compare == "diffusion") {
        const detail::Blob blob = detail::blob_of(w, cells);
        row.add("middle", "length", blob.middle);
        row.add("variance", "length^2", blob.variance);
    } else if (w.compare == "sedov") {
        const Blast blast = blast_of(w);
        const RadialProfile profile = radial_profile(w, cells, blast.x, blast.z);
        const double most = *std::max_element(profile.rho.begin(), profile.rho.end());
        row.add("shock_radius", "length",
                outermost(profile.r, profile.rho, 0.5 * (blast.density + most)));
    } else if (w.compare == "noh") {
        const RegionCase& r = region_with_flow(w, "radial");
        const theory::NohProblem noh = noh_of(w);
        const double R = theory::noh_shock_radius(noh, 1);
        const double level = 0.5 * (theory::noh_state(noh, 0.5 * R, 1).density +
                                    theory::noh_state(noh, 1.000001 * R, 1).density);
        const RadialProfile profile = radial_profile(w, cells, r.center_x, r.center_z);
        row.add("shock_radius", "length", outermost(profile.r, profile.rho, level));
    } else if (w.compare == "gresho") {
        const RegionCase& r = region_with_flow(w, "gresho");
        const double V2 = w.frame_x * w.frame_x + w.frame_z * w.frame_z;
        row.add("kinetic_in_frame", "energy/length",
                now.kinetic - w.frame_x * now.momentum_x - w.frame_z * now.momentum_z +
                    0.5 * now.mass * V2);
        const double x0 = r.center_x + w.frame_x * state.time,
                     z0 = r.center_z + w.frame_z * state.time;
        double swirl = 0;
        for (long j = 0; j < w.grid.z.cells; ++j) {
            for (long i = 0; i < w.grid.x.cells; ++i) {
                const long c = w.grid.index(i, j);
                const double dx = apart(w.grid.x, x0, w.grid.x.at(static_cast<double>(i) + 0.5)),
                             dz = apart(w.grid.z, z0, w.grid.z.at(static_cast<double>(j) + 0.5));
                swirl += cells.rho[c] * w.grid.cell_area() *
                         (dx * (cells.vz[c] - w.frame_z) - dz * (cells.vx[c] - w.frame_x));
            }
        }
        row.add("swirl", "momentum", swirl);
    } else if (w.compare == "wave") {
        const double from = w.grid.x.low + w.frame_x * state.time;
        add_mode("mode", "velocity", detail::mode_of(w, cells.vx, 0, w.grid.z.cells, from));
        add_mode("pressure", "pressure", detail::mode_of(w, cells.p, 0, w.grid.z.cells, from));
    } else if (w.compare == "ringing") {
        const std::vector<double> vx = mean_over_z(w.grid, cells.vx);
        double mean = 0, squares = 0;
        for (const double v : vx) mean += v / static_cast<double>(vx.size());
        for (const double v : vx) squares += (v - mean) * (v - mean);
        row.add("noise", "velocity", std::sqrt(squares / static_cast<double>(vx.size())));
    } else if (w.compare == "rayleigh_taylor") {
        add_mode("mode", "length", detail::interface_height(w, cells));
    } else if (w.compare == "kelvin_helmholtz") {
        const RegionCase& r = region_with_flow(w, "shear");
        const detail::Rows rows = detail::rows_at(w.grid.z, r.center_z);
        add_mode("mode", "velocity", detail::mode_of(w, cells.vz, rows.low, rows.high, r.center_x));
    } else if (w.compare == "dam_break") {
        detail::add_dam(w, cells, row);
    } else if (w.compare == "impact") {
        detail::add_impact(w, state, cells, row);
    }
}

}  // namespace flip
