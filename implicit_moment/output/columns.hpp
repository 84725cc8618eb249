// Columns of the history that belong to one kind of case: a sheet across its current, a tail, the seeded
// mode or the mean field of a uniform plasma.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "common/run/run.hpp"
#include "implicit_moment/output/diagnostics.hpp"
#include "implicit_moment/setup/load_plasma.hpp"

namespace implicit_moment {

/// The columns of a sheet across its current: reconnected flux and quadrupole of B_y.
/// out:    the flux [B0 d_i]
inline double add_reconnection(const Case& w, const FieldState& field, common::Row& row) {
    const double B0 = harris_sheet(w.harris).B0;
    const MiddleRow middle = middle_row(w.grid, field.B);
    row.add("flux", "B0*d_i", middle.flux / B0);
    row.add("quadrupole", "B0", quadrupole(w.grid, field.B, middle.X_point) / B0);
    return middle.flux / B0;
}

/// A_y along the middle row of a tail, where it grows with x as long as nothing reconnects.
struct TailRow {
    double flux = 0;    // of field lines around an O-line: the largest fall of A_y along x
    double X_line = 0;  // where that fall ends, from the middle [d_i]; 0 where there is none
    double shift = 0;   // rms of A_y less that of the equilibrium, epsilon B0 x
};

/// in:     B; an even number of cells in z; B_z in the middle of the equilibrium
inline TailRow tail_row(const Grid& grid, const VectorField& B, double B_z) {
    const double* of_row = B.z() + grid.index(0, grid.z.cells / 2);
    TailRow row;
    double A_y = 0, high = 0, squares = 0;
    for (long i = 1; i <= grid.x.cells; ++i) {
        A_y += grid.x.spacing() * of_row[i - 1];
        high = std::max(high, A_y);
        if (high - A_y > row.flux)
            row.flux = high - A_y,
            row.X_line = grid.x.at(double(i)) - 0.5 * (grid.x.low + grid.x.high());
        squares += std::pow(A_y - B_z * grid.x.spacing() * double(i), 2);
    }
    row.shift = std::sqrt(squares / double(grid.x.cells));
    return row;
}

/// The columns of a tail.
inline void add_tail(const Case& w, const FieldState& field, common::Row& row) {
    const double B0 = harris_sheet(w.harris).B0;
    const TailRow middle = tail_row(w.grid, field.B, w.harris.normal_field * B0);
    row.add("flux", "B0*d_i", middle.flux / B0);
    row.add("X_line", "d_i", middle.X_line);
    row.add("flux_shift", "B0*d_i", middle.shift / B0);
}

/// The columns of a uniform plasma: the complex amplitude of the seeded mode in one component.
inline void add_mode(const Case& w, const FieldState& field, common::Row& row) {
    row.add("mode", w.component,
            mode_amplitude(w.grid, field, w.component, w.uniform.mode_x, w.uniform.mode_z));
}

/// Whether a uniform plasma begins in a uniform electric field.
inline bool has_uniform_E(const Case& w) {
    return w.uniform.E_x != 0 || w.uniform.E_y != 0 || w.uniform.E_z != 0;
}

/// Whether a uniform plasma has a mean E, or gets one because it drifts across B.
inline bool has_mean_E(const Case& w) {
    const UniformCase& u = w.uniform;
    const Eigen::Vector3d B(u.B_x, u.B_y, u.B_z);
    return has_uniform_E(w) || std::ranges::any_of(u.species, [&](const SpeciesCase& s) {
               return B.cross(Eigen::Vector3d(s.drift_x, s.drift_y, s.drift_z)).norm() > 0;
           });
}

/// Its columns: the mean of E.
inline void add_mean_field(const Grid& grid, const FieldState& field, common::Row& row) {
    for (long a = 0; a < 3; ++a)
        row.add(std::string("mean_E_") + "xyz"[a], "m_i*c*omega_pi/e",
                interior(grid, field.E.all.data() + a * grid.size()).mean());
}

/// The energy of the uniform magnetic field, or of the guide field of a sheet, which nothing can use.
inline double idle_energy(const Case& w) {
    const UniformCase& u = w.uniform;
    const HarrisCase h = harris_of(w);
    const double B2 = w.is_uniform() ? u.B_x * u.B_x + u.B_y * u.B_y + u.B_z * u.B_z
                                     : std::pow(h.guide_field / h.light_over_alfven, 2);
    return 0.5 * B2 * w.grid.x.length * w.grid.z.length;
}

/// Whether an energy stands out of the round-off of the idle one, and what of it can be used; else all of it.
inline bool is_usable(const Case& w, double energy) {
    return energy - idle_energy(w) > 1e-12 * energy;
}
inline double usable_energy(const Case& w, double energy) {
    return is_usable(w, energy) ? energy - idle_energy(w) : energy;
}

}  // namespace implicit_moment
