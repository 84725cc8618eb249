// The thin current sheet of figures 11 to 15: a Harris sheet seen along its field lines.
//
// The plane of the mesh is (x, z) and y points out of it. Here the current flows along the mesh's x
// and the sheet is crossed along z, so that
//     the talk's y = x,   the talk's z = z,   the talk's B_x = -B_y,   the talk's E_y = E_x
// (right-handed: the talk's x points into the plane). In figures the talk's letters are used.
#pragma once

#include <cmath>
#include <string>

#include "implicit_moment/case.hpp"

namespace implicit_moment {

/// Modes along the current that the history follows: wavelengths length_x/m, m = 1 .. sheet_modes.
inline constexpr long sheet_modes = 16;

/// The Harris sheet that a thin current sheet is.
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
inline HarrisCase harris_of(const Case& wanted) {
    return wanted.setup == "current_sheet" ? harris_of(wanted.current_sheet) : wanted.harris;
}

/// Sets the lengths of the mesh, which a current sheet gives in units of L.
/// errors: InputError for lengths in the case file that are others.
inline void fit_mesh_to_sheet(Case& wanted) {
    const CurrentSheetCase& s = wanted.current_sheet;
    const double L = harris_of(s).thickness;
    const Case initial;
    const auto fit = [&](const std::string& letter, double in_L, double untouched, double& length) {
        const double fitting = in_L * L;
        if (length != untouched && std::fabs(length / fitting - 1) > 1e-12) {
            throw common::InputError("grid.length_" + letter + " = " + common::shown(length) +
                                     " d_i, but current_sheet.length_" + letter + " makes it " +
                                     common::shown(in_L) + " L = " + common::shown(fitting) +
                                     " d_i: take grid.length_" + letter + " out");
        }
        length = fitting;
    };
    fit("x", s.length_x, initial.grid.x.length, wanted.grid.x.length);
    fit("z", s.length_z, initial.grid.z.length, wanted.grid.z.length);
}

}  // namespace implicit_moment
