// Formulas of a case as tables: profiles of the density, distributions of velocities.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "cic/setup/case.hpp"

namespace cic {

/// Pieces of the table of a distribution of velocities.
inline constexpr long velocity_pieces = 4096;

/// The mean over a cell from piece j on of a table of densities, in means of all.
inline double mean_from(const Distribution& table, std::size_t j, const common::Axis& axis) {
    const std::size_t all = table.f.size(), cell = all / std::size_t(axis.cells),
                      end = std::min(all, j + cell);
    return (table.cumulative[end] - table.cumulative[j]) * double(all) / double(cell);
}

/// The largest of these; 0 for an empty table.
inline double peak_of(const Distribution& table, const common::Axis& axis) {
    double peak = 0;
    for (std::size_t j = 0; j < table.f.size(); ++j)
        peak = std::max(peak, mean_from(table, j, axis));
    return peak;
}

/// Reads the formulas of all species and makes their tables, density and distributions.
///   The table of positions has at least 4096 pieces in one dimension and 512 x 512 in two, with one
///   or more in a cell.
/// errors: InputError for a formula that is none, negative, or zero everywhere
inline void read_formulas(Case& parameters) {
    const Grid& grid = parameters.grid;
    for (SpeciesCase& s : parameters.species) {
        const std::string name = "species." + s.name;
        s.tables = {};
        const auto refuse_nothing = [&](const Distribution& table, const char* what) {
            refuse(!table.given(), name, ".", what, " is 0 everywhere: particles need a place");
        };
        if (!s.density.is_number()) {
            s.density.read(parameters.constants);
            const auto density = [&](double x, double z) {
                return s.density.at(x, z, std::hypot(x - s.center_x, z - s.center_z));
            };
            double sum = 0;  // of all pieces
            const bool plane = parameters.dimensions == 2;
            const long pieces = std::max(plane ? 512L : 4096L, grid.x.cells),
                       rows = plane ? std::max(512L, grid.z.cells) : 1;
            s.tables.x = tabulate(grid.x.low, grid.x.high(), pieces, false, [&](double x) {
                double column = 0;
                const auto along_z = [&](double z) {
                    const double n = density(x, z);
                    column += n;
                    return n;
                };
                if (plane)
                    s.tables.z.push_back(tabulate(grid.z.low, grid.z.high(), rows, false, along_z));
                else
                    along_z(0);
                sum += column;
                return column;
            });
            refuse_nothing(s.tables.x, "density");
            s.tables.mean_density = sum / double(pieces * rows);
            for (std::size_t j = 0; j < s.tables.x.f.size(); ++j)
                s.tables.peak =
                    std::max(s.tables.peak, mean_from(s.tables.x, j, grid.x) *
                                                (plane ? peak_of(s.tables.z[j], grid.z) : 1));
        }
        const auto read = [&](common::Formula& f, const char* what, double low, bool speeds,
                              Distribution& table) {
            if (f.is_number() && double(f) == 0) return;
            refuse(s.distribution_max == 0, name, ".", what, " needs ", name,
                   ".distribution_max, the speed at which it ends");
            f.read(parameters.constants, "v");
            table = tabulate(low, s.distribution_max, velocity_pieces, speeds,
                             [&](double v) { return f.at(v); });
            refuse_nothing(table, what);
            // What is narrower than a piece is in the table by chance, or not at all.
            constexpr long fine = 64;  // points in a piece
            const auto at = [&](long j) {
                return f.at(low + (double(j) + 0.5) * table.step / double(fine));
            };
            double all = 0, missed = 0, before = 0, here = f.at(table.middle(0));
            for (long piece = 0; piece < velocity_pieces; ++piece) {
                const double after =
                    piece + 1 < velocity_pieces ? f.at(table.middle(std::size_t(piece + 1))) : 0;
                double mass = 0, most = 0;
                for (long j = piece * fine; j < (piece + 1) * fine; ++j) {
                    const double value = at(j);
                    most = std::max(most, value), mass += value;
                }
                all += mass;
                if (most > 2 * std::max(before, after)) missed += mass;
                before = here, here = after;
            }
            refuse(missed > 1e-6 * all, name, ".", what,
                   " has parts narrower than the pieces of its table, which are ", table.step,
                   " wide: lower ", name,
                   ".distribution_max, or make a narrow beam a species of its own");
        };
        const double lowest = -s.distribution_max;
        read(s.distribution_x, "distribution_x", lowest, false, s.tables.v[0]);
        read(s.distribution_y, "distribution_y", lowest, false, s.tables.v[1]);
        read(s.distribution_z, "distribution_z", lowest, false, s.tables.v[2]);
        read(s.distribution_across, "distribution_across", 0, true, s.tables.speed);
    }
}

}  // namespace cic
