// Particles at t = 0: of a Harris sheet, or of a uniform plasma with one seeded mode.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "implicit_moment/setup/current_sheet.hpp"

namespace implicit_moment {

/// What a Harris sheet implies, in the normalization of units.hpp.
struct HarrisSheet {
    double B0, T_i, T_e, u_i, u_e, v_i, v_e, Omega_ci;
};

/// Equilibrium: pressure balance n0 (T_i + T_e) = B0^2 / 8 pi, and u_i = 2 c T_i / (e B0 lambda),
/// u_e = -u_i T_e/T_i.
/// exact:  n0 e (u_i - u_e) = c B0 / (4 pi lambda), Ampere's law in the middle of the sheet.
/// source: Harris, Nuovo Cimento 23, 115 (1962).
inline HarrisSheet harris_sheet(const HarrisCase& parameters) {
    HarrisSheet sheet{};
    sheet.B0 = 1 / parameters.light_over_alfven;
    const double T = sheet.B0 * sheet.B0 / (8 * pi * n0);
    sheet.T_i = T * parameters.temperature_ratio / (1 + parameters.temperature_ratio);
    sheet.T_e = T - sheet.T_i;
    sheet.u_i = 2 * c * sheet.T_i / (sheet.B0 * parameters.thickness);
    sheet.u_e = -sheet.u_i / parameters.temperature_ratio;
    sheet.v_i = std::sqrt(sheet.T_i);
    sheet.v_e = std::sqrt(sheet.T_e * parameters.mass_ratio);
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

inline void resize(Particles& particles, long count) {
    for (auto* f :
         {&particles.x_p, &particles.z_p, &particles.ux_p, &particles.uy_p, &particles.uz_p}) {
        f->resize(static_cast<std::size_t>(count));
    }
}

}  // namespace detail

/// Loads ions and electrons of a Harris sheet with equal weights; every electron starts on an
/// ion, so that rho = 0 and E = 0.
///     n = n0 sech^2(z/lambda), drifting along y (a current sheet: along x);   n_inf, at rest
inline Plasma load_harris(const Case& parameters) {
    const HarrisCase h = harris_of(parameters);
    const Grid& grid = parameters.grid;
    const HarrisSheet sheet = harris_sheet(h);
    const bool along_x = parameters.setup == "current_sheet";
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

    const common::LoadingNumbers load{parameters.loading == "quiet",
                                      static_cast<std::uint64_t>(parameters.seed)};
    common::for_each_block(pairs, [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) {
            const auto k = static_cast<std::size_t>(p);
            const bool drifting = p < sheet_pairs;
            const double u_i = drifting ? sheet.u_i : 0, u_e = drifting ? sheet.u_e : 0;
            const std::uint32_t part = drifting ? 1 : 2;
            const long index = drifting ? p : p - sheet_pairs;
            const double u = 2 * load.uniform(part, 3, index) - 1;
            const double z =
                drifting ? h.thickness * std::atanh(u * reach) : 0.5 * u * grid.z.length;
            ions.x_p[k] = electrons.x_p[k] =
                grid.x.at(0) + grid.x.length * load.uniform(part, 2, index);
            ions.z_p[k] = electrons.z_p[k] = z_middle + z;
            ions.ux_p[k] = sheet.v_i * load.gaussian(part, 5, index) + (along_x ? u_i : 0);
            ions.uy_p[k] = sheet.v_i * load.gaussian(part, 7, index) + (along_x ? 0 : u_i);
            ions.uz_p[k] = sheet.v_i * load.gaussian(part, 11, index);
            electrons.ux_p[k] = sheet.v_e * load.gaussian(part, 13, index) + (along_x ? u_e : 0);
            electrons.uy_p[k] = sheet.v_e * load.gaussian(part, 17, index) + (along_x ? 0 : u_e);
            electrons.uz_p[k] = sheet.v_e * load.gaussian(part, 19, index);
        }
    });
    return plasma;
}

/// Phase of the seeded mode at a point of the plane.
inline double mode_phase(const Case& parameters, double x, double z) {
    const Grid& grid = parameters.grid;
    return 2 * pi *
           (static_cast<double>(parameters.uniform.mode_x) * (x - grid.x.low) / grid.x.length +
            static_cast<double>(parameters.uniform.mode_z) * (z - grid.z.low) / grid.z.length);
}

/// Loads the species of a uniform plasma; all have the same number of particles at the same
/// positions, so that opposite charges cancel at t = 0.
///     v_p = drift + Maxwellian + amplitude cos(k x + phase)
inline Plasma load_uniform(const Case& parameters) {
    const UniformCase& u = parameters.uniform;
    const Grid& grid = parameters.grid;
    const long count = u.particles_per_cell * grid.x.cells * grid.z.cells;
    const double area = grid.x.length * grid.z.length;
    const common::LoadingNumbers load{parameters.loading == "quiet",
                                      static_cast<std::uint64_t>(parameters.seed)};

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
                const double phase = mode_phase(parameters, x, z);
                particles.x_p[k] = x;
                particles.z_p[k] = z;
                particles.ux_p[k] = s.drift_x + s.wave_x * std::cos(phase + s.phase_x * degree);
                particles.uy_p[k] = s.drift_y + s.wave_y * std::cos(phase + s.phase_y * degree);
                particles.uz_p[k] = s.drift_z + s.wave_z * std::cos(phase + s.phase_z * degree);
                if (v_x > 0) particles.ux_p[k] += v_x * load.gaussian(purpose, 5, p);
                if (v_y > 0) particles.uy_p[k] += v_y * load.gaussian(purpose, 7, p);
                if (v_z > 0) particles.uz_p[k] += v_z * load.gaussian(purpose, 11, p);
            }
        });
    }
    return plasma;
}

}  // namespace implicit_moment
