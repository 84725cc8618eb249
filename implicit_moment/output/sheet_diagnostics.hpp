// What is measured in a thin current sheet: the modes along the current, the displacement of the
// sheet, and profiles across it. Letters of the mesh; current_sheet.hpp has the talk's.
#pragma once

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "common/run/history.hpp"
#include "common/run/writers.hpp"
#include "implicit_moment/output/diagnostics.hpp"

namespace implicit_moment {

/// Amplitudes of the waves exp(i k_m x), m = 1 .. sheet_modes, in every row of a quantity that
/// lives half-way between the nodes of x.
///     a_m(z) = (2/N) sum_x f(x, z) exp(-i k_m x),  k_m = 2 pi m/length_x
class RowModes {
   public:
    explicit RowModes(const Grid& grid) : waves_(sheet_modes(grid), grid.x.cells) {
        const double cells = double(grid.x.cells);
        for (long i = 0; i < grid.x.cells; ++i) {
            for (long m = 1; m <= waves_.rows(); ++m) {
                const double turns = double(m) * (double(i) + 0.5) / cells;
                waves_(m - 1, i) = std::polar(2 / cells, -2 * pi * turns);
            }
        }
    }

    /// out:    (mode, row), rows 0 .. N-1.
    /// exact:  for f = sum_m |a_m| cos(k_m x + arg a_m)
    Eigen::MatrixXcd operator()(const Grid& grid, const double* f) const {
        return waves_ * interior(grid, f);
    }
    /// The amplitudes of one function of x alone.
    Eigen::VectorXcd operator()(const Eigen::VectorXd& f) const { return waves_ * f; }

   private:
    Eigen::MatrixXcd waves_;
};

/// Root mean square over z of the amplitude of every mode.
inline Eigen::VectorXd rms_over_rows(const Eigen::MatrixXcd& amplitude) {
    return (amplitude.rowwise().squaredNorm() / double(amplitude.cols())).cwiseSqrt();
}

/// How far the sheet has moved along z, column by column: the height of the part where B_y > 0,
/// less half of the box, with B_y linear between the rows of faces.
/// in:     B_y, which goes from B0 at low z to -B0 at high z
/// exact:  where B_y changes sign once, the place of that zero between two rows; where noise makes
///         it change sign more often, the mean of those places with alternating signs.
inline Eigen::VectorXd displacement(const Grid& grid, const double* B_y) {
    Eigen::VectorXd moved = Eigen::VectorXd::Constant(grid.x.cells, -0.5 * grid.z.length);
    const double dz = grid.z.spacing();
    for (long i = 0; i < grid.x.cells; ++i) {
        const auto at = [&](long j) { return B_y[grid.index(i, j)]; };
        if (at(0) > 0) moved[i] += 0.5 * dz;
        for (long j = 0; j + 1 < grid.z.cells; ++j) {
            const double low = at(j), high = at(j + 1);
            const double above = std::max(low, 0.0) + std::max(high, 0.0);
            const double all = std::fabs(low) + std::fabs(high);
            if (all > 0) moved[i] += dz * above / all;
        }
        if (at(grid.z.cells - 1) > 0) moved[i] += 0.5 * dz;
    }
    return moved;
}

/// The columns that the history of a current sheet has beyond those of every run.
///     E_m    rms over z of mode m of E_x   [B0 v_A/c]      m = 1 .. sheet_modes
///     B_m    the same of B_y               [B0]
///     displacement_m   amplitude of mode m of the displacement of the sheet   [L]   m = 1 .. 4
///     upper_m_re, upper_m_im, lower_m_re, lower_m_im   complex amplitude of E_x, its mean over the
///            upper edge of the sheet, 0.75 L < z < 1.75 L, and over the lower one: there the
///            lower-hybrid drift instability grows fastest   [B0 v_A/c]
class SheetDiagnostics {
   public:
    explicit SheetDiagnostics(const Case& parameters)
        : grid_(parameters.grid),
          modes_(parameters.grid),
          L_(harris_of(parameters).thickness),
          B0_(harris_sheet(harris_of(parameters)).B0) {
        const auto row = [&](double z) {
            return std::lround((0.5 * grid_.z.length - z * L_) / grid_.z.spacing());
        };
        edge_ = row(1.75);
        rows_ = row(0.75) - edge_ + 1;
    }

    /// Adds the columns and their values.
    void add(const FieldState& field, common::Row& row) const {
        const std::string E_unit = "B0*v_A/c";
        const Eigen::MatrixXcd E = modes_(grid_, field.E.x()) / (B0_ * B0_ / c);
        const Eigen::MatrixXcd B = modes_(grid_, field.B.y()) / B0_;
        const Eigen::VectorXd E_rms = rms_over_rows(E), B_rms = rms_over_rows(B);
        const Eigen::VectorXcd moved = modes_(displacement(grid_, field.B.y())) / L_;
        const auto mode = [](const char* name, long m) { return name + std::to_string(m + 1); };
        for (long m = 0; m < E.rows(); ++m) row.add(mode("E_", m), E_unit, E_rms[m]);
        for (long m = 0; m < B.rows(); ++m) row.add(mode("B_", m), "B0", B_rms[m]);
        for (long m = 0; m < displacement_modes; ++m)
            row.add(mode("displacement_", m), "L", std::abs(moved[m]));
        const auto add_edge = [&](const char* name, long first) {
            const Eigen::VectorXcd mean = E.middleCols(first, rows_).rowwise().mean();
            for (long m = 0; m < E.rows(); ++m) row.add(mode(name, m), E_unit, mean[m]);
        };
        add_edge("upper_", grid_.z.cells - edge_ - rows_ + 1);
        add_edge("lower_", edge_);
    }

   private:
    static constexpr long displacement_modes = 4;
    const Grid& grid_;
    RowModes modes_;
    double L_, B0_;
    long edge_, rows_;  // first row and number of rows of the lower edge
};

/// Writes profile_NNNNNN.dat: means over x, row by row of the nodes.
inline void write_profile(const common::Snapshot& at, const Case& parameters,
                          const FieldState& field, const std::vector<Moments>& moments) {
    const Grid& grid = parameters.grid;
    const HarrisCase h = harris_of(parameters);
    const HarrisSheet sheet = harris_sheet(h);
    const double J0 = c * sheet.B0 / (4 * pi * h.thickness);
    const double v_i = std::sqrt(2 * sheet.T_i), rows = double(nodes_z(grid));
    const double time = at.time * sheet.Omega_ci;
    const Moments &ions = moments[0], &electrons = moments[1];
    std::array<std::vector<double>, 8> data;
    for (long j = 0; j < nodes_z(grid); ++j) {
        const auto mean = [&](const double* f) {
            return Eigen::Map<const Field>(f + grid.index(0, j), grid.x.cells).mean();
        };
        const double n_i = mean(ions.rho.data()), n_e = -mean(electrons.rho.data());
        const double J_i = mean(ions.J_x.data()), J_e = mean(electrons.J_x.data());
        const double B_y = 0.5 * (mean(field.B.y()) + mean(field.B.y() - grid.stride())) / sheet.B0;
        const std::array<double, 8> row{
            time,
            (grid.z.at(double(j)) - grid.z.at(0.5 * (rows - 1))) / h.thickness,
            B_y,
            (J_i + J_e) / J0,
            n_i / n0,
            n_e / n0,
            n_i > 0 ? J_i / (n_i * v_i) : 0,
            n_e > 0 ? -J_e / (n_e * v_i) : 0};
        for (std::size_t k = 0; k < row.size(); ++k) data[k].push_back(row[k]);
    }
    common::write_table(at, "profile",
                        {{"time_Omega_ci", "1/Omega_ci", data[0]},
                         {"z", "L", data[1]},
                         {"B_y", "B0", data[2]},
                         {"J_x", "c*B0/(4pi*L)", data[3]},
                         {"n_ions", "n0", data[4]},
                         {"n_electrons", "n0", data[5]},
                         {"v_ions", "v_i", data[6]},
                         {"v_electrons", "v_i", data[7]}});
}

}  // namespace implicit_moment
