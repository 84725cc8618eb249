// What a run follows besides its conserved quantities: a mode, a shock, a front.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "common/history.hpp"
#include "flip/state.hpp"

namespace flip {

using common::shown;

/// Largest sound speed of the fluid at the start, from the uniform states of the case.
inline double largest_sound_speed(const Case& w) {
    double most = 0;
    for (const RegionCase& r : w.regions) {
        const int index = material_index(w, r.gas.material);
        if (index < 0) continue;
        const Material& a = w.materials[static_cast<std::size_t>(index)];
        most = std::max(most, std::sqrt(stiffness(a, r.gas.pressure) / r.gas.density));
    }
    return most;
}

/// The material that most of the mass of a cell belongs to.
inline std::size_t main_material(const CellFields& cells, long cell) {
    std::size_t most = 0;
    for (std::size_t k = 1; k < cells.rho_of.size(); ++k)
        if (cells.rho_of[k][cell] > cells.rho_of[most][cell]) most = k;
    return most;
}

struct Extremes {
    double speed = 0, mach = 0;
};

/// Largest speed and Mach number of a cell.
/// note:   the sound speed is that of the main material of the cell; cells without sound, as dust,
///         have no Mach number
inline Extremes extremes(const Case& w, const CellFields& cells) {
    Extremes most;
    for (long j = 0; j < w.grid.z.cells; ++j) {
        for (long i = 0; i < w.grid.x.cells; ++i) {
            const long c = w.grid.index(i, j);
            if (!(cells.rho[c] > 0)) continue;
            const double speed = std::hypot(cells.vx[c], cells.vz[c]);
            const double sound2 =
                stiffness(w.materials[main_material(cells, c)], cells.p[c]) / cells.rho[c];
            most.speed = std::max(most.speed, speed);
            if (sound2 > 0) most.mach = std::max(most.mach, speed / std::sqrt(sound2));
        }
    }
    return most;
}

/// Columns of the history that the comparison of the case needs.
inline std::vector<common::Column> followed_columns(const Case&) { return {}; }

/// Their values in one row, at the end of `row`.
inline void add_followed(const Case&, const State&, const Totals&, const CellFields&,
                         std::vector<double>&) {}

/// Largest size of a column of the history.
inline double largest(const common::History& history, const std::string& name) {
    double most = 0;
    for (const double value : history.column(name)) most = std::max(most, std::fabs(value));
    return most;
}

}  // namespace flip
