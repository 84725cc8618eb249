// Particles at t = 0: of a Harris sheet, or of a uniform plasma with one seeded mode.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "common/ranks.hpp"
#include "implicit_moment/setup/current_sheet.hpp"
#include "implicit_moment/setup/tail_sheet.hpp"

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

/// The part of its current that a sheet of relativistic particles lacks: gamma v of a species is loaded with the drift V
/// and the temperature T, and the mean of v is about V (1 + V^2 + 5 T/m)^(-1/2), [c].
inline double lacking_current(const Case& w) {
    if (w.is_uniform() || !w.is_relativistic()) return 0;
    const HarrisSheet s = harris_sheet(harris_of(w));
    const auto lacks = [](double V, double v) {
        return V * (1 - 1 / std::sqrt(1 + (V * V + 5 * v * v) / (c * c)));
    };
    return (lacks(s.u_i, s.v_i) - lacks(s.u_e, s.v_e)) / (s.u_i - s.u_e);
}
/// The same in words. in: least, of it. out: empty below that
inline std::string no_balance(const Case& w, double least = 0.02) {
    const double part = lacking_current(w);
    if (part < least) return "";
    return sentence("drift and heat of gamma v make v smaller, so that the current is about ",
                    100 * part,
                    " % too small to balance the field and the sheet is no exact equilibrium: set "
                    "particles.relativistic = false, or raise ",
                    w.setup, ".light_over_alfven");
}

/// All species of a run.
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

inline Particles make_particles(const std::string& name, double q_p, double m_p, bool relativistic,
                                long count) {
    Particles particles;
    particles.name = name, particles.q_p = q_p, particles.m_p = m_p;
    particles.relativistic = relativistic;
    for (auto* quantity : particles.all()) quantity->resize(count);
    return particles;
}

}  // namespace detail

/// Loads ions and electrons of a Harris sheet with equal weights; every electron starts on an
/// ion, so that rho = 0 and E = 0.
///     n = n0 sech^2(z/lambda), drifting along y (a current sheet: along x);   n_inf, at rest
/// in:     share, which of the pairs
/// note:   with a normal field the density is that of tail_sheet.hpp.
inline Plasma load_harris(const Case& parameters, common::Share share = {}) {
    const HarrisCase h = harris_of(parameters);
    const Grid& grid = parameters.grid;
    const HarrisSheet sheet = harris_sheet(h);
    const bool along_x = parameters.is_along_current();
    const double reach = std::tanh(0.5 * grid.z.length / h.thickness);
    std::optional<TailPlaces> tail;
    if (h.normal_field != 0) tail.emplace(tail_of(h), grid);
    const double in_sheet =
        tail ? n0 * tail->content() : n0 * grid.x.length * 2 * h.thickness * reach;
    const double in_background = n0 * h.background * grid.x.length * grid.z.length;
    const long pairs = h.particles / 2;
    const long sheet_pairs = std::lround(double(pairs) * in_sheet / (in_sheet + in_background));
    const double weight = (in_sheet + in_background) / double(pairs);
    const double z_middle = grid.z.low + 0.5 * grid.z.length;
    const long first = share.begin(pairs), here = share.end(pairs) - first;

    const bool relativistic = parameters.is_relativistic();
    Plasma plasma;
    const auto add = [&](const std::string& name, double charge, double mass) {
        plasma.species.push_back(detail::make_particles(name, charge, mass, relativistic, here));
    };
    add("ions", weight, weight), add("electrons", -weight, weight / h.mass_ratio);
    Particles &ions = plasma.species[0], &electrons = plasma.species[1];
    const common::LoadingNumbers load{parameters.loading == "quiet",
                                      std::uint64_t(parameters.seed)};
    common::for_each_block(here, [&](int, long begin, long end) {
        for (long p = begin; p < end; ++p) {
            const long pair = first + p;
            const bool drifting = pair < sheet_pairs;
            const std::uint32_t part = drifting ? 1 : 2;
            const long index = drifting ? pair : pair - sheet_pairs;
            const double u = 2 * load.uniform(part, 3, index) - 1;
            double z = drifting ? h.thickness * std::atanh(u * reach) : 0.5 * u * grid.z.length;
            double x = grid.x.at(0) + grid.x.length * load.uniform(part, 2, index);
            if (tail && drifting) {
                const auto from_middle = tail->place(load.uniform(part, 2, index), 0.5 * (u + 1));
                x = std::clamp(grid.x.at(0) + 0.5 * grid.x.length + from_middle[0], grid.x.low,
                               grid.x.high());
                z = from_middle[1];
            }
            ions.x_p[p] = electrons.x_p[p] = carried(grid.x, x);
            ions.z_p[p] = electrons.z_p[p] = carried(grid.z, z_middle + z);
            const auto set_u = [&](Particles& s, double v, double u_s,
                                   std::array<unsigned, 3> primes) {
                const auto gaussian = [&](unsigned prime) {
                    return v * load.gaussian(part, prime, index);
                };
                s.ux_p[p] = ParticleReal(gaussian(primes[0]) + (along_x ? u_s : 0));
                s.uy_p[p] = ParticleReal(gaussian(primes[1]) + (along_x ? 0 : u_s));
                s.uz_p[p] = ParticleReal(gaussian(primes[2]));
            };
            set_u(ions, sheet.v_i, drifting ? sheet.u_i : 0, {5, 7, 11});
            set_u(electrons, sheet.v_e, drifting ? sheet.u_e : 0, {13, 17, 19});
        }
    });
    return plasma;
}

/// Phase of the seeded mode at a point of the plane.
inline double mode_phase(const Case& parameters, double x, double z) {
    const Grid& grid = parameters.grid;
    return 2 * pi *
           (double(parameters.uniform.mode_x) * (x - grid.x.low) / grid.x.length +
            double(parameters.uniform.mode_z) * (z - grid.z.low) / grid.z.length);
}

/// Loads the species of a uniform plasma; all have the same number of particles at the same
/// positions, so that opposite charges cancel at t = 0.
///     v_p = drift + Maxwellian + amplitude cos(k x + phase)
/// in:     share, which particles of each species
/// note:   where particles are relativistic that is u_p = gamma v.
inline Plasma load_uniform(const Case& parameters, common::Share share = {}) {
    const UniformCase& u = parameters.uniform;
    const Grid& grid = parameters.grid;
    const long count = u.particles_per_cell * grid.x.cells * grid.z.cells;
    const long first = share.begin(count), here = share.end(count) - first;
    const double area = grid.x.length * grid.z.length;
    const common::LoadingNumbers load{parameters.loading == "quiet",
                                      std::uint64_t(parameters.seed)};

    Plasma plasma;
    for (const SpeciesCase& s : u.species) {
        const double weight = n0 * s.density * area / double(count);
        Particles& particles = plasma.species.emplace_back(detail::make_particles(
            s.name, weight * s.charge, weight * s.mass, parameters.is_relativistic(), here));
        const auto purpose = std::uint32_t(plasma.species.size());
        const double v_x = std::sqrt(s.temperature_x / s.mass),
                     v_y = std::sqrt(s.temperature_y / s.mass),
                     v_z = std::sqrt(s.temperature_z / s.mass), degree = pi / 180;
        common::for_each_block(here, [&](int, long begin, long end) {
            for (long p = begin; p < end; ++p) {
                const long number = first + p;
                const double x = grid.x.low + grid.x.length * load.uniform(0, 2, number);
                const double z = grid.z.low + grid.z.length * load.uniform(0, 3, number);
                const double phase = mode_phase(parameters, x, z);
                particles.x_p[p] = carried(grid.x, x);
                particles.z_p[p] = carried(grid.z, z);
                double u_x = s.drift_x + s.wave_x * std::cos(phase + s.phase_x * degree),
                       u_y = s.drift_y + s.wave_y * std::cos(phase + s.phase_y * degree),
                       u_z = s.drift_z + s.wave_z * std::cos(phase + s.phase_z * degree);
                if (v_x > 0) u_x += v_x * load.gaussian(purpose, 5, number);
                if (v_y > 0) u_y += v_y * load.gaussian(purpose, 7, number);
                if (v_z > 0) u_z += v_z * load.gaussian(purpose, 11, number);
                particles.ux_p[p] = ParticleReal(u_x), particles.uy_p[p] = ParticleReal(u_y),
                particles.uz_p[p] = ParticleReal(u_z);
            }
        });
    }
    return plasma;
}

}  // namespace implicit_moment
