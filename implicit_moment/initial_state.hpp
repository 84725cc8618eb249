// The set-ups a case file can name: a Harris current sheet, and a uniform plasma with one seeded
// mode.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "implicit_moment/case.hpp"
#include "implicit_moment/sort_particles.hpp"

namespace implicit_moment {

/// What a Harris sheet implies, in the normalization of units.hpp.
struct HarrisSheet {
    double B0, T_i, T_e, u_i, u_e, v_i, v_e, Omega_ci;
};

/// Equilibrium: pressure balance n0 (T_i + T_e) = B0^2 / 8 pi, and u_i = 2 c T_i / (e B0 lambda),
/// u_e = -u_i T_e/T_i.
/// exact: n0 e (u_i - u_e) = c B0 / (4 pi lambda), Ampere's law in the middle of the sheet.
///        source: Harris, Nuovo Cimento 23, 115 (1962).
inline HarrisSheet harris_sheet(const HarrisCase& wanted) {
    HarrisSheet sheet{};
    sheet.B0 = 1 / wanted.light_over_alfven;
    const double T = sheet.B0 * sheet.B0 / (8 * pi * n0);
    sheet.T_i = T * wanted.temperature_ratio / (1 + wanted.temperature_ratio);
    sheet.T_e = T - sheet.T_i;
    sheet.u_i = 2 * c * sheet.T_i / (sheet.B0 * wanted.thickness);
    sheet.u_e = -sheet.u_i / wanted.temperature_ratio;
    sheet.v_i = std::sqrt(sheet.T_i);
    sheet.v_e = std::sqrt(sheet.T_e * wanted.mass_ratio);
    sheet.Omega_ci = sheet.B0 / c;
    return sheet;
}

struct Plasma {
    std::vector<Particles> species;

    std::vector<double> charge_over_mass() const {
        std::vector<double> ratio;
        for (const Particles& s : species) ratio.push_back(s.q_p / s.m_p);
        return ratio;
    }
    long count() const {
        long total = 0;
        for (const Particles& s : species) total += s.count();
        return total;
    }
};

namespace detail {

// Numbers in (0, 1) for loading: a quiet start takes radical inverses, each quantity in a prime
// base of its own.
struct Loader {
    bool quiet;
    std::uint64_t seed;
    double uniform(std::uint32_t purpose, unsigned base, long particle) const {
        const auto p = static_cast<std::uint64_t>(particle);
        return quiet ? common::scrambled_radical_inverse(p, base, seed + 1000 * purpose)
                     : common::uniform(seed, purpose, p, base);
    }
    double gaussian(std::uint32_t purpose, unsigned base, long particle) const {
        return gsl_cdf_ugaussian_Pinv(uniform(purpose, base, particle));
    }
};

inline void resize(Particles& particles, long count) {
    for (auto* f :
         {&particles.x_p, &particles.z_p, &particles.vx_p, &particles.vy_p, &particles.vz_p}) {
        f->resize(static_cast<std::size_t>(count));
    }
}

}  // namespace detail

/// Loads ions and electrons of a Harris sheet with equal weights; every electron starts on an
/// ion, so that rho = 0 and E = 0.
///     n = n0 sech^2(z/lambda), drifting along y;   n_inf, at rest
inline Plasma load_harris(const Case& wanted) {
    const HarrisCase& h = wanted.harris;
    const Grid& grid = wanted.grid;
    const HarrisSheet sheet = harris_sheet(h);
    const double reach = std::tanh(0.5 * grid.z.length / h.thickness);
    const double in_sheet = n0 * grid.x.length * 2 * h.thickness * reach;
    const double in_background = n0 * h.background * grid.x.length * grid.z.length;
    const long pairs = h.particles / 2;
    const long sheet_pairs =
        std::lround(static_cast<double>(pairs) * in_sheet / (in_sheet + in_background));
    const double weight = (in_sheet + in_background) / static_cast<double>(pairs);
    const double z_middle = grid.z.low + 0.5 * grid.z.length;

    Plasma plasma;
    plasma.species.resize(2);
    Particles &ions = plasma.species[0], &electrons = plasma.species[1];
    ions.name = "ions", ions.q_p = weight, ions.m_p = weight;
    electrons.name = "electrons", electrons.q_p = -weight, electrons.m_p = weight / h.mass_ratio;
    detail::resize(ions, pairs);
    detail::resize(electrons, pairs);

    const detail::Loader load{wanted.loading == "quiet", static_cast<std::uint64_t>(wanted.seed)};
    common::for_each_block(pairs, [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) {
            const auto k = static_cast<std::size_t>(p);
            const bool drifting = p < sheet_pairs;
            const std::uint32_t part = drifting ? 1 : 2;
            const long index = drifting ? p : p - sheet_pairs;
            const double u = 2 * load.uniform(part, 3, index) - 1;
            const double z =
                drifting ? h.thickness * std::atanh(u * reach) : 0.5 * u * grid.z.length;
            ions.x_p[k] = electrons.x_p[k] =
                grid.x.at(0) + grid.x.length * load.uniform(part, 2, index);
            ions.z_p[k] = electrons.z_p[k] = z_middle + z;
            ions.vx_p[k] = sheet.v_i * load.gaussian(part, 5, index);
            ions.vy_p[k] = sheet.v_i * load.gaussian(part, 7, index) + (drifting ? sheet.u_i : 0);
            ions.vz_p[k] = sheet.v_i * load.gaussian(part, 11, index);
            electrons.vx_p[k] = sheet.v_e * load.gaussian(part, 13, index);
            electrons.vy_p[k] =
                sheet.v_e * load.gaussian(part, 17, index) + (drifting ? sheet.u_e : 0);
            electrons.vz_p[k] = sheet.v_e * load.gaussian(part, 19, index);
        }
    });
    return plasma;
}

/// B of a Harris sheet with the GEM perturbation, as the curl of A_y on nodes, so that div B = 0
/// to round-off and B_n = 0 on walls.
///     A_y = -B0 lambda ln cosh(z/lambda) - psi0 cos(2 pi x/L_x) cos(pi z/L_z)
inline void harris_field(const Case& wanted, FieldState& field) {
    const Grid& grid = wanted.grid;
    const HarrisCase& h = wanted.harris;
    const double B0 = harris_sheet(h).B0;
    const double z_middle = grid.z.low + 0.5 * grid.z.length;
    const double x_middle = grid.x.low + 0.5 * grid.x.length;
    Field A_y = Field::Zero(grid.size());
    for (long j = -1; j <= grid.z.cells + 1; ++j) {
        const double z = grid.z.at(static_cast<double>(j)) - z_middle;
        const bool wall = j == 0 || j == grid.z.cells;
        for (long i = -1; i <= grid.x.cells + 1; ++i) {
            const double x = grid.x.at(static_cast<double>(i)) - x_middle;
            const double island = wall
                                      ? 0
                                      : h.perturbation * B0 * std::cos(2 * pi * x / grid.x.length) *
                                            std::cos(pi * z / grid.z.length);
            A_y[grid.index(i, j)] =
                -B0 * h.thickness * std::log(std::cosh(z / h.thickness)) - island;
        }
    }
    VectorField A(grid);
    std::copy_n(A_y.data(), grid.size(), A.y());
    curl_of_electric(grid, A.all.data(), field.B.all.data());
    fill_ghosts(grid, magnetic, field.B);
}

/// Phase of the seeded mode at a point of the plane.
inline double mode_phase(const Case& wanted, double x, double z) {
    const Grid& grid = wanted.grid;
    return 2 * pi *
           (static_cast<double>(wanted.uniform.mode_x) * (x - grid.x.low) / grid.x.length +
            static_cast<double>(wanted.uniform.mode_z) * (z - grid.z.low) / grid.z.length);
}

/// Loads the species of a uniform plasma; all have the same number of particles at the same
/// positions, so that opposite charges cancel at t = 0.
///     v_p = drift + Maxwellian + amplitude cos(k x + phase)
inline Plasma load_uniform(const Case& wanted) {
    const UniformCase& u = wanted.uniform;
    const Grid& grid = wanted.grid;
    const long count = u.particles_per_cell * grid.x.cells * grid.z.cells;
    const double area = grid.x.length * grid.z.length;
    const detail::Loader load{wanted.loading == "quiet", static_cast<std::uint64_t>(wanted.seed)};

    Plasma plasma;
    for (const SpeciesCase& s : u.species) {
        plasma.species.emplace_back();
        Particles& particles = plasma.species.back();
        const double weight = n0 * s.density * area / static_cast<double>(count);
        particles.name = s.name;
        particles.q_p = weight * s.charge;
        particles.m_p = weight * s.mass;
        detail::resize(particles, count);
        const auto purpose = static_cast<std::uint32_t>(plasma.species.size());
        const double v_x = std::sqrt(s.temperature_x / s.mass),
                     v_y = std::sqrt(s.temperature_y / s.mass),
                     v_z = std::sqrt(s.temperature_z / s.mass), degree = pi / 180;
        common::for_each_block(count, [&](int, long begin, long end) {
            for (long p = begin; p < end; ++p) {
                const auto k = static_cast<std::size_t>(p);
                const double x = grid.x.low + grid.x.length * load.uniform(0, 2, p);
                const double z = grid.z.low + grid.z.length * load.uniform(0, 3, p);
                const double phase = mode_phase(wanted, x, z);
                particles.x_p[k] = x;
                particles.z_p[k] = z;
                particles.vx_p[k] = s.drift_x + s.wave_x * std::cos(phase + s.phase_x * degree);
                particles.vy_p[k] = s.drift_y + s.wave_y * std::cos(phase + s.phase_y * degree);
                particles.vz_p[k] = s.drift_z + s.wave_z * std::cos(phase + s.phase_z * degree);
                if (v_x > 0) particles.vx_p[k] += v_x * load.gaussian(purpose, 5, p);
                if (v_y > 0) particles.vy_p[k] += v_y * load.gaussian(purpose, 7, p);
                if (v_z > 0) particles.vz_p[k] += v_z * load.gaussian(purpose, 11, p);
            }
        });
    }
    return plasma;
}

/// The uniform magnetic field and the seeded mode; its part of B in the plane is made from A_y,
/// so that div B = 0 to round-off.
inline void uniform_field(const Case& wanted, FieldState& field) {
    const UniformCase& u = wanted.uniform;
    const Grid& grid = wanted.grid;
    const double degree = pi / 180;
    const double k_x = 2 * pi * static_cast<double>(u.mode_x) / grid.x.length;
    const double k_z = 2 * pi * static_cast<double>(u.mode_z) / grid.z.length;
    const bool from_z = u.mode_x != 0;
    const double A = from_z ? u.wave_B_z / k_x : (u.mode_z != 0 ? -u.wave_B_x / k_z : 0.0);
    const double A_phase = (from_z ? u.phase_B_z : u.phase_B_x) * degree;

    VectorField potential(grid);
    const auto mode = [&](double i, double j, double amplitude, double phase) {
        return amplitude *
               std::cos(mode_phase(wanted, grid.x.at(i), grid.z.at(j)) + phase * degree);
    };
    for (long m = -1; m <= grid.z.cells + 1; ++m) {
        for (long l = -1; l <= grid.x.cells + 1; ++l) {
            const long n = grid.index(l, m);
            const double i = static_cast<double>(l), j = static_cast<double>(m);
            potential.y()[n] =
                A * std::sin(mode_phase(wanted, grid.x.at(i), grid.z.at(j)) + A_phase);
            field.E.x()[n] = mode(i + 0.5, j, u.wave_E_x, u.phase_E_x);
            field.E.y()[n] = mode(i, j, u.wave_E_y, u.phase_E_y);
            field.E.z()[n] = mode(i, j + 0.5, u.wave_E_z, u.phase_E_z);
        }
    }
    curl_of_electric(grid, potential.all.data(), field.B.all.data());
    for (long m = -1; m <= grid.z.cells + 1; ++m) {
        for (long l = -1; l <= grid.x.cells + 1; ++l) {
            const long n = grid.index(l, m);
            field.B.x()[n] += u.B_x;
            field.B.y()[n] += u.B_y + mode(static_cast<double>(l) + 0.5,
                                           static_cast<double>(m) + 0.5, u.wave_B_y, u.phase_B_y);
            field.B.z()[n] += u.B_z;
        }
    }
    fill_ghosts(grid, electric, field.E);
    fill_ghosts(grid, magnetic, field.B);
}

/// Adds -grad phi with -lap phi = 4 pi rho, phi = 0 on walls, so that Gauss's law holds at t = 0.
/// in: rho, smoothed as the field equations smooth it. note: in a doubly periodic box a uniform
///        background neutralizes the mean of rho.
inline void add_electrostatic_field(const Grid& grid, const MeshModes& modes, const Field& rho,
                                    FieldState& field) {
    Field phi = 4 * pi * rho;
    common::fill_ghosts(grid, common::on_nodes, {-1, -1}, phi.data());
    solve_poisson(grid, modes, phi);
    const long s = grid.stride();
    for_each_point(grid, [&](long n) {
        field.E.x()[n] -= (phi[n + 1] - phi[n]) / grid.x.spacing();
        field.E.z()[n] -= (phi[n + s] - phi[n]) / grid.z.spacing();
    });
    fill_ghosts(grid, electric, field.E);
}

/// All that a run is, at one time: what a checkpoint holds.
struct State {
    Plasma plasma;
    FieldState field;
};

/// Names every number of the state, for writing and for reading alike.
template <class Archive>
void archive(Archive& a, State& state) {
    for (Particles& s : state.plasma.species) {
        a(s.name + ".x_p", s.x_p);
        a(s.name + ".z_p", s.z_p);
        a(s.name + ".vx_p", s.vx_p);
        a(s.name + ".vy_p", s.vy_p);
        a(s.name + ".vz_p", s.vz_p);
        a(s.name + ".first_of_node", s.first_of_node);
    }
    a("E", state.field.E.all);
    a("B", state.field.B.all);
    a("E_theta", state.field.E_theta.all);
}

/// Particles and fields at t = 0, sorted, with E from Gauss's law.
inline State initial_state(const Case& wanted) {
    const Grid& grid = wanted.grid;
    State state{wanted.setup == "harris" ? load_harris(wanted) : load_uniform(wanted),
                FieldState(grid)};
    wanted.setup == "harris" ? harris_field(wanted, state.field)
                             : uniform_field(wanted, state.field);

    SortScratch scratch;
    sort_particles(grid, scratch, state.plasma.species);
    Field rho = Field::Zero(grid.size());
    Moments moments(grid);
    for (const Particles& species : state.plasma.species) {
        deposit_moments(species, grid, state.field.B, 0, moments);
        rho += moments.rho;
    }
    smooth(grid, on_nodes, {-1, -1}, wanted.field.smoothing, rho.data(), moments.rho);
    add_electrostatic_field(grid, MeshModes(grid), rho, state.field);
    state.field.E_theta = state.field.E;
    return state;
}

}  // namespace implicit_moment
