// The set-ups a case file can name: a Harris current sheet across its current or along it, and a
// uniform plasma with one seeded mode. The particles come from load_plasma.hpp, fields from here.
#pragma once

#include <cmath>

#include "common/ranks.hpp"
#include "implicit_moment/deposit_moments.hpp"
#include "implicit_moment/field/waves.hpp"
#include "implicit_moment/ranks/balance_rows.hpp"
#include "implicit_moment/setup/load_plasma.hpp"
#include "implicit_moment/solve_field.hpp"
#include "implicit_moment/sort_particles.hpp"

namespace implicit_moment {

/// B of a Harris sheet with the GEM perturbation, as the curl of A_y on nodes, so that div B = 0
/// to round-off and B_n = 0 on walls; and a uniform B_y, which pushes nothing that drifts along y.
///     A_y = -B0 lambda ln cosh(z/lambda) - psi0 cos(2 pi x/L_x) cos(pi z/L_z)
/// note:   with a normal field the first part is that of tail_sheet.hpp, and it crosses the walls.
inline void harris_field(const Case& parameters, FieldState& field) {
    const Grid& grid = parameters.grid;
    const HarrisCase& h = parameters.harris;
    const double B0 = harris_sheet(h).B0;
    const double z_middle = grid.z.low + 0.5 * grid.z.length;
    const double x_middle = grid.x.low + 0.5 * grid.x.length;
    Field A_y = Field::Zero(grid.size());
    for (long j = -1; j <= grid.z.cells + 1; ++j) {
        const double z = grid.z.at(double(j)) - z_middle;
        const bool wall = j == 0 || j == grid.z.cells;
        for (long i = -1; i <= grid.x.cells + 1; ++i) {
            const double x = grid.x.at(double(i)) - x_middle;
            const double island = wall
                                      ? 0
                                      : h.perturbation * B0 * std::cos(2 * pi * x / grid.x.length) *
                                            std::cos(pi * z / grid.z.length);
            double& A = A_y[grid.index(i, j)];
            A = -B0 * h.thickness * log_cosh(z / h.thickness) - island;
            if (h.normal_field != 0) A = B0 * h.thickness * tail_of(h).A_y(x, z) - island;
        }
    }
    VectorField A(grid);
    std::copy_n(A_y.data(), grid.size(), A.y());
    curl_of_electric(grid, A.all.data(), field.B.all.data());
    std::fill_n(field.B.y(), grid.size(), h.guide_field * B0);
    fill_B_ghosts(grid, field.B);
}

/// B of a current sheet along x: B_y = -B0 tanh(z/L), averaged over each row of faces.
inline void current_sheet_field(const Case& parameters, FieldState& field) {
    const Grid& grid = parameters.grid;
    const HarrisCase h = harris_of(parameters);
    const auto potential = [&](long j) {
        const double z = grid.z.at(double(j)) - (grid.z.low + 0.5 * grid.z.length);
        return -harris_sheet(h).B0 * h.thickness * log_cosh(z / h.thickness);
    };
    for (long j = 0; j < grid.z.cells; ++j) {
        const double B_y = (potential(j + 1) - potential(j)) / grid.z.spacing();
        std::fill_n(field.B.y() + grid.index(0, j), grid.x.cells, B_y);
    }
    fill_B_ghosts(grid, field.B);
}

/// The uniform fields and the seeded mode; its part of B in the plane is made from A_y,
/// so that div B = 0 to round-off.
inline void uniform_field(const Case& parameters, FieldState& field) {
    const UniformCase& u = parameters.uniform;
    const Grid& grid = parameters.grid;
    const double degree = pi / 180;
    const double k_x = 2 * pi * double(u.mode_x) / grid.x.length;
    const double k_z = 2 * pi * double(u.mode_z) / grid.z.length;
    const bool from_z = u.mode_x != 0;
    const double A = from_z ? u.wave_B_z / k_x : (u.mode_z != 0 ? -u.wave_B_x / k_z : 0.0);
    const double A_phase = (from_z ? u.phase_B_z : u.phase_B_x) * degree;

    VectorField potential(grid);
    const auto mode = [&](double i, double j, double amplitude, double phase) {
        return amplitude *
               std::cos(mode_phase(parameters, grid.x.at(i), grid.z.at(j)) + phase * degree);
    };
    for (long m = -1; m <= grid.z.cells + 1; ++m) {
        for (long l = -1; l <= grid.x.cells + 1; ++l) {
            const long n = grid.index(l, m);
            const double i = double(l), j = double(m);
            potential.y()[n] =
                A * std::sin(mode_phase(parameters, grid.x.at(i), grid.z.at(j)) + A_phase);
            field.E.x()[n] = u.E_x + mode(i + 0.5, j, u.wave_E_x, u.phase_E_x);
            field.E.y()[n] = u.E_y + mode(i, j, u.wave_E_y, u.phase_E_y);
            field.E.z()[n] = u.E_z + mode(i, j + 0.5, u.wave_E_z, u.phase_E_z);
        }
    }
    curl_of_electric(grid, potential.all.data(), field.B.all.data());
    for (long m = -1; m <= grid.z.cells + 1; ++m) {
        for (long l = -1; l <= grid.x.cells + 1; ++l) {
            const long n = grid.index(l, m);
            field.B.x()[n] += u.B_x;
            field.B.y()[n] +=
                u.B_y + mode(double(l) + 0.5, double(m) + 0.5, u.wave_B_y, u.phase_B_y);
            field.B.z()[n] += u.B_z;
        }
    }
    fill_ghosts(grid, electric, field.E);
    fill_B_ghosts(grid, field.B);
}

/// Adds -grad phi with -lap phi = 4 pi rho - div E, phi = 0 on walls, so that Gauss's law holds at
/// t = 0, also on this mesh for a seeded E whose k . E is 0.
/// in:     rho, smoothed as the field equations smooth it; E with ghosts filled.
/// note:   in a doubly periodic box a uniform background neutralizes the mean of rho.
inline void add_electrostatic_field(const Grid& grid, const Field& rho, FieldState& field) {
    Field phi = Field::Zero(grid.size());
    gauss_residual(grid, field.E, rho, phi);
    phi = -phi;
    NodeWaves waves(grid);
    solve_poisson(grid, waves, phi);
    const long s = grid.stride();
    for_each_point(grid, [&](long n) {
        field.E.x()[n] -= (phi[n + 1] - phi[n]) / grid.x.spacing();
        field.E.z()[n] -= (phi[n + s] - phi[n]) / grid.z.spacing();
    });
    fill_ghosts(grid, electric, field.E);
}

/// All that a run is, at one time.
struct State {
    Plasma plasma;
    FieldState field;
};

/// Names every number of the state, for writing and for reading alike. in: share, of the particles, to be read
template <class Archive>
void archive(Archive& a, State& state, common::Share share) {
    for (Particles& s : state.plasma.species) {
        a(s.name + ".x_p", common::OfAllRanks<ParticleReal>{s.x_p, share});
        a(s.name + ".z_p", common::OfAllRanks<ParticleReal>{s.z_p, share});
        a(s.name + ".ux_p", common::OfAllRanks<ParticleReal>{s.ux_p, share});
        a(s.name + ".uy_p", common::OfAllRanks<ParticleReal>{s.uy_p, share});
        a(s.name + ".uz_p", common::OfAllRanks<ParticleReal>{s.uz_p, share});
        a(s.name + ".first_of_node", common::SumOverRanks{s.first_of_node});
    }
    a("E", state.field.E.all);
    a("B", state.field.B.all);
    a("E_theta", state.field.E_theta.all);
}

/// Particles and fields of the set-up, before E has its part that follows from the charge.
inline State loaded_state(const Case& parameters, common::Share share = {}) {
    State state{
        parameters.is_uniform() ? load_uniform(parameters, share) : load_harris(parameters, share),
        FieldState(parameters.grid)};
    if (parameters.is_across_current()) harris_field(parameters, state.field);
    if (parameters.is_along_current()) current_sheet_field(parameters, state.field);
    if (parameters.is_uniform()) uniform_field(parameters, state.field);
    return state;
}

/// Particles and fields at t = 0, sorted, with E from Gauss's law. Every rank loads its share of the particles by
/// number, and hands them over to those who are to have their rows.
inline State initial_state(const Case& parameters) {
    const Grid& grid = parameters.grid;
    State state = loaded_state(parameters, common::share_of_rank());
    SortScratch scratch;
    sort_particles(grid, scratch, state.plasma.species);
    balance_rows(nodes_x(grid), rows_of_rank, state.plasma.species);
    Field rho = Field::Zero(grid.size());
    Moments moments(grid);
    for (const Particles& species : state.plasma.species) {
        deposit_moments(species, grid, state.field.B, 0, moments);
        rho += moments.rho;
    }
    smooth(grid, on_nodes, felt_charge(grid), parameters.field.smoothing, rho.data(), moments.rho);
    add_electrostatic_field(grid, rho, state.field);
    state.field.E_theta = state.field.E;
    return state;
}

}  // namespace implicit_moment
