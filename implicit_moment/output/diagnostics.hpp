// What is measured every step: energies, momentum, the two constraints, the reconnected flux, the
// seeded mode.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "implicit_moment/setup/case.hpp"
#include "implicit_moment/setup/initial_state.hpp"

namespace implicit_moment {

/// Energy of one vector field, sum of f^2 / 8 pi over the mesh. Tangential E vanishes on walls and normal
/// B stays as it is there, so every unknown has a full cell.
inline double field_energy(const Grid& grid, const VectorField& f) {
    double sum = 0;
    for (long a = 0; a < 3; ++a) {
        sum += interior(grid, f.all.data() + a * grid.size()).squaredNorm();
    }
    return sum * grid.cell_area() / (8 * pi);
}

/// Largest |div B| on the mesh. exact: stays where it started, at round-off.
inline double largest_divergence(const Grid& grid, const VectorField& B, Field& scratch) {
    scratch.setZero(grid.size());
    divergence_of_magnetic(grid, B.all.data(), scratch);
    return interior(grid, scratch.data()).cwiseAbs().maxCoeff();
}

/// Root mean square of div E - 4 pi rho on the nodes inside, in units of 4 pi e n0 = 1.
inline double gauss_error(const Grid& grid, const Field& gauss) {
    const auto inside = interior(grid, gauss.data());
    return std::sqrt(inside.squaredNorm() / double(inside.size()));
}

/// A_y on nodes from B, zero at node (0, 0):  B_z = dA_y/dx,  B_x = -dA_y/dz. Its contours are
/// the field lines in the plane.
/// exact:  the same by every path, because div B = 0.
/// note:   in a periodic direction it is not periodic if B has a mean there.
inline Field flux_function(const Grid& grid, const VectorField& B) {
    Field A_y = Field::Zero(grid.size());
    for (long j = 0; j <= grid.z.cells; ++j) {
        if (j > 0) {
            A_y[grid.index(0, j)] =
                A_y[grid.index(0, j - 1)] - grid.z.spacing() * B.x()[grid.index(0, j - 1)];
        }
        for (long i = 0; i < grid.x.cells; ++i) {
            A_y[grid.index(i + 1, j)] =
                A_y[grid.index(i, j)] + grid.x.spacing() * B.z()[grid.index(i, j)];
        }
    }
    return A_y;
}

/// A_y along the middle row, from one end to the other: smallest at the X-line, largest at the
/// O-line.
struct MiddleRow {
    double flux = 0;   // psi_O - psi_X, (1/2) int |B_z(x, 0)| dx for one X- and one O-line
    long X_point = 0;  // its node
};

/// The reconnected flux, and where it passes.
/// source: Birn et al., J. Geophys. Res. 106, 3715 (2001), figure 1.
inline MiddleRow middle_row(const Grid& grid, const VectorField& B) {
    const long middle = grid.z.cells / 2;
    double A_y = 0, low = 0, high = 0;
    MiddleRow row;
    for (long i = 0; i < grid.x.cells; ++i) {
        if (A_y < low) {
            low = A_y;
            row.X_point = i;
        }
        high = std::max(high, A_y);
        A_y += grid.x.spacing() * B.z()[grid.index(i, middle)];
    }
    row.flux = high - low;
    return row;
}

/// Mean of B_y sign(x z) in a quarter of the box around the X-line: positive for the quadrupole
/// that the Hall current of reconnection makes (electrons stream away from the X-line, so J_x < 0
/// at x > 0 and dB_y/dz > 0 there).
/// in:     B with ghosts filled; x periodic.
inline double quadrupole(const Grid& grid, const VectorField& B, long X_point) {
    const long nx = grid.x.cells, j_0 = grid.z.cells / 2;
    const long reach_x = nx / 4, reach_z = grid.z.cells / 4;
    double sum = 0;
    for (long j = 0; j < reach_z; ++j) {
        const double *above = B.y() + grid.index(0, j_0 + j),
                     *below = B.y() + grid.index(0, j_0 - 1 - j);
        for (long i = 0; i < reach_x; ++i) {
            const long right = (X_point + i) % nx, left = (X_point - 1 - i + nx) % nx;
            sum += above[right] - above[left] - below[right] + below[left];
        }
    }
    return sum / (4.0 * double(reach_x * reach_z));
}

/// Complex amplitude of the wave exp(i k x) in one field component, (2/N) sum f exp(-i k x), at
/// the component's own places.
/// in:     name E_x ... B_z.
inline std::complex<double> mode_amplitude(const Grid& grid, const FieldState& field,
                                           const std::string& name, long mode_x, long mode_z) {
    const bool is_B = name[0] == 'B';
    const long a = name[2] - 'x';
    const Place place = (is_B ? magnetic : electric).place[a];
    const double* f = (is_B ? field.B : field.E).all.data() + a * grid.size();
    const double k_x = 2 * pi * double(mode_x) / double(grid.x.cells);
    const double k_z = 2 * pi * double(mode_z) / double(grid.z.cells);
    std::complex<double> sum = 0;
    for (long j = 0; j < grid.z.cells; ++j) {
        for (long i = 0; i < grid.x.cells; ++i) {
            const double x = double(i) + (place.half_x ? 0.5 : 0.0);
            const double z = double(j) + (place.half_z ? 0.5 : 0.0);
            sum += f[grid.index(i, j)] * std::polar(1.0, -k_x * x - k_z * z);
        }
    }
    return sum * (2.0 / double(grid.x.cells * grid.z.cells));
}

}  // namespace implicit_moment
