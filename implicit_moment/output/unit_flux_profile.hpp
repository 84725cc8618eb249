// Figure 10 of the talk: the plasma along the middle row z = 0 when the reconnected flux is one
// B0 d_i.
//
// The recorder watches the flux. At the first step of unit flux it keeps B_z, and from there on it
// adds up charge and current of both species, to divide by the number of steps at the end: an average
// over particle noise. The sums belong to the recorder and go into the checkpoints beside the state.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "common/run/writers.hpp"
#include "implicit_moment/moments.hpp"
#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// How long charge and current are averaged, in 1/Omega_ci.
/// source: caption of figure 10: "averaged between t omega_ci = 15 and t omega_ci = 15.6".
inline constexpr double profile_averaging_time = 0.6;

/// What has been added up so far, one number per x-edge of the middle row.
struct UnitFluxProfile {
    long steps = 0;             // in the sums; 0: there was no unit flux yet
    double begin = 0, end = 0;  // times of the first and last of them [1/Omega_ci]
    std::vector<double> rho_ions, J_x_ions, rho_electrons, J_x_electrons;  // sums over steps
    std::vector<double> B_z;                                               // at the first step
};

/// Names every number of the profile, for writing and for reading alike.
template <class Archive>
void archive(Archive& a, UnitFluxProfile& profile) {
    a("profile.steps", profile.steps);
    a("profile.begin", profile.begin);
    a("profile.end", profile.end);
    a("profile.rho_ions", profile.rho_ions);
    a("profile.J_x_ions", profile.J_x_ions);
    a("profile.rho_electrons", profile.rho_electrons);
    a("profile.J_x_electrons", profile.J_x_electrons);
    a("profile.B_z", profile.B_z);
}

/// Records one step: begins at the first one of unit flux, adds the steps of the averaging time.
/// in:     time [1/Omega_ci], flux [B0 d_i] and B of the step; an even number of cells in z;
///         take_moments(), called only when they are needed, gives rho and J of ions and electrons
///         at the time of the step, ghosts filled.
/// note:   rho lives on nodes and is brought to the x-edges, where J_x and B_z live.
template <class TakeMoments>
void record_profile(UnitFluxProfile& profile, double time, double flux, const Grid& grid,
                    const VectorField& B, const TakeMoments& take_moments) {
    const bool over = time > profile.begin + profile_averaging_time * (1 + 1e-9);
    if (profile.steps == 0 ? !(flux >= 1) : over) return;

    const long count = grid.x.cells, row = grid.index(0, grid.z.cells / 2);
    if (profile.steps == 0) {
        profile.begin = time;
        profile.B_z.assign(B.z() + row, B.z() + row + grid.x.cells);
        for (auto* sum : {&profile.rho_ions, &profile.J_x_ions, &profile.rho_electrons,
                          &profile.J_x_electrons}) {
            sum->assign(count, 0.0);
        }
    }
    const std::vector<Moments> moments = take_moments();
    const Moments &ions = moments.at(0), &electrons = moments.at(1);
    for (long i = 0; i < count; ++i) {
        const long n = row + i;
        profile.rho_ions[i] += 0.5 * (ions.rho[n] + ions.rho[n + 1]);
        profile.rho_electrons[i] += 0.5 * (electrons.rho[n] + electrons.rho[n + 1]);
        profile.J_x_ions[i] += ions.J_x[n];
        profile.J_x_electrons[i] += electrons.J_x[n];
    }
    profile.end = time;
    ++profile.steps;
}

/// The profile in the units of the figure, one number per x-edge, in the order of x.
struct ProfileColumns {
    double X_line = 0;                  // its place in the box [d_i]
    double flux = 0;                    // from X-line to O-line [B0 d_i]
    std::vector<double> x;              // from the X-line, which is in the middle [d_i]
    std::vector<double> v_x_electrons;  // <J_x>/<rho> [v_A]
    std::vector<double> rho_ions;       // [e n0]
    std::vector<double> v_x_ions;       // [v_A]
    std::vector<double> B_z;            // [B0]
};

/// in:     a profile of at least one step; B0, which is v_A/c in the units of units.hpp.
/// exact:  flux is the integral of B_z from the X-line to the O-line, by either way around.
inline ProfileColumns profile_columns(const UnitFluxProfile& profile, const Grid& grid, double B0) {
    ProfileColumns columns;
    const long count = grid.x.cells;
    // A_y, on nodes, is smallest at the X-line.
    double A_y = 0, low = 0, high = 0;
    long X_point = 0;
    for (long i = 0; i < count; ++i) {
        if (A_y < low) low = A_y, X_point = i;
        high = std::max(high, A_y);
        A_y += profile.B_z[i] / B0 * grid.x.spacing();
    }
    columns.X_line = grid.x.at(double(X_point));
    columns.flux = high - low;

    const double v_A = B0 * c;
    for (long k = 0; k < count; ++k) {
        const long from_X = k - count / 2;
        const long i = (X_point + from_X + count) % count;
        columns.x.push_back((double(from_X) + 0.5) * grid.x.spacing());
        columns.v_x_electrons.push_back(profile.J_x_electrons[i] / profile.rho_electrons[i] / v_A);
        columns.rho_ions.push_back(profile.rho_ions[i] / double(profile.steps) / n0);
        columns.v_x_ions.push_back(profile.J_x_ions[i] / profile.rho_ions[i] / v_A);
        columns.B_z.push_back(profile.B_z[i] / B0);
    }
    return columns;
}

/// Writes profile.dat, one row per x-edge. Nothing for a run without unit flux.
inline void write_profile(const std::string& path, const UnitFluxProfile& profile, const Grid& grid,
                          double B0) {
    if (profile.steps == 0) return;
    const ProfileColumns columns = profile_columns(profile, grid, B0);
    common::write_table(path, {{"x_from_X_line", "d_i", columns.x},
                               {"v_x_electrons", "v_A", columns.v_x_electrons},
                               {"rho_ions", "e*n0", columns.rho_ions},
                               {"v_x_ions", "v_A", columns.v_x_ions},
                               {"B_z", "B0", columns.B_z}});
}

}  // namespace implicit_moment
