// The thin current sheet of figures 11 to 15: a Harris sheet seen along its field lines.
//
// The plane of the mesh is (x, z) and y points out of it. Here the current flows along the mesh's x
// and the sheet is crossed along z, so that
//     the talk's y = x,   the talk's z = z,   the talk's B_x = -B_y,   the talk's E_y = E_x
// (right-handed: the talk's x points into the plane). In figures the talk's letters are used.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "implicit_moment/setup/case.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// Modes along the current that the history follows: wavelengths length_x/m, m = 1 .. sheet_modes,
/// 16 or what a coarser mesh has.
inline long sheet_modes(const Grid& grid) { return std::min(16L, (grid.x.cells - 1) / 2); }
/// Comparisons read modes 1 to 4: fewer cells along the current are refused.
inline constexpr long least_cells_along_current = 9;

/// What the waves need to be seen: cells in one of them, particles of a species in a cell.
inline constexpr double least_cells_in_wave = 6, least_particles_in_cell = 50;

/// A thin current sheet as a Harris sheet.
///     u_i = 2 c T_i/(e B0 L) = v_i rho_i/L,  so  L = rho_i/drift = (T_i/T)^(1/2)/drift  [d_i]
/// with T = T_i + T_e, because n0 T = B0^2/8 pi makes v_i = v_A (T_i/T)^(1/2).
inline HarrisCase harris_of(const CurrentSheetCase& s) {
    HarrisCase h;
    h.mass_ratio = s.mass_ratio;
    h.light_over_alfven = s.light_over_alfven;
    h.temperature_ratio = s.temperature_ratio;
    h.thickness = std::sqrt(s.temperature_ratio / (1 + s.temperature_ratio)) / s.drift;
    h.background = s.background;
    h.perturbation = 0;
    h.particles = s.particles;
    return h;
}

/// The Harris sheet of a case, across its current or along it.
inline HarrisCase harris_of(const Case& parameters) {
    return parameters.is_along_current() ? harris_of(parameters.current_sheet) : parameters.harris;
}

/// Sets the lengths of the mesh, which a current sheet gives in units of L.
/// errors: InputError for other lengths in the case file
inline void fit_mesh_to_sheet(Case& parameters) {
    const CurrentSheetCase& s = parameters.current_sheet;
    const double L = harris_of(s).thickness;
    const Case initial;
    const auto fit = [&](const std::string& letter, double in_L, double untouched, double& length) {
        const double fitting = in_L * L;
        refuse(length != untouched && std::fabs(length / fitting - 1) > 1e-12, "grid.length_",
               letter, " = ", length, " d_i, but current_sheet.length_", letter, " makes it ", in_L,
               " L = ", fitting, " d_i: take grid.length_", letter, " out");
        length = fitting;
    };
    fit("x", s.length_x, initial.grid.x.length, parameters.grid.x.length);
    fit("z", s.length_z, initial.grid.z.length, parameters.grid.z.length);
}

/// Warnings with the number and the limit, for sheets whose instability would not be seen.
/// note:   the talk's mode has k L = 12.5; with random numbers its noise is that of the particles.
inline std::vector<std::string> sheet_warnings(const Case& parameters) {
    const CurrentSheetCase& s = parameters.current_sheet;
    std::vector<std::string> warnings;
    const double wavelength = 2 * pi / 12.5;  // [L]
    const double cells = wavelength * double(parameters.grid.x.cells) / s.length_x;
    warn(warnings, cells < least_cells_in_wave, "the waves of the talk, k L = 12.5, are ", cells,
         " cells long, and want ", least_cells_in_wave, ": raise grid.cells_x to ",
         std::ceil(least_cells_in_wave / wavelength * s.length_x));
    const double area = s.length_x * (2 + s.background * s.length_z);  // at density n0 [L^2]
    const double in_cell = 0.5 * double(s.particles) / area * s.length_x * s.length_z /
                           double(parameters.grid.x.cells * parameters.grid.z.cells);
    warn(warnings, in_cell < least_particles_in_cell, "there are ", in_cell,
         " particles of a species in a cell in the middle of the sheet, and their noise hides the "
         "waves below ",
         least_particles_in_cell, ": raise current_sheet.particles");
    return warnings;
}

}  // namespace implicit_moment
