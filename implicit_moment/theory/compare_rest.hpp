// A uniform plasma in which nothing can happen: what each species gains or loses.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "common/run/run.hpp"
#include "implicit_moment/output/columns.hpp"
#include "implicit_moment/theory/wave_theory.hpp"

namespace implicit_moment {

/// Whether nothing can happen: a uniform plasma without seeds whose species, isotropic Maxwellians, move together
/// or not at all; between walls they do not move. A drift across B would gyrate, and one of relativistic
/// particles has no energy of its own. Between walls no background makes a charged plasma neutral.
inline bool is_at_rest(const Case& w) {
    const UniformCase& u = w.uniform;
    if (!w.is_uniform() || has_uniform_E(w) || w.wave != "none" || u.species.empty()) return false;
    for (const double seed :
         {u.wave_B_x, u.wave_B_y, u.wave_B_z, u.wave_E_x, u.wave_E_y, u.wave_E_z})
        if (seed != 0) return false;
    const auto drift_of = [](const SpeciesCase& s) {
        return Eigen::Vector3d(s.drift_x, s.drift_y, s.drift_z);
    };
    const Eigen::Vector3d B(u.B_x, u.B_y, u.B_z), drift = drift_of(u.species[0]);
    const bool periodic = w.grid.x.periodic && w.grid.z.periodic, moves = drift.norm() > 0;
    if (drift.cross(B).norm() > 0 || (moves && (w.is_relativistic() || !periodic))) return false;
    double charge = 0;
    for (const SpeciesCase& s : u.species) charge += s.density * s.charge;
    if (!periodic && std::fabs(charge) > 1e-9) return false;
    return std::ranges::all_of(u.species, [&](const SpeciesCase& s) {
        return s.temperature_x == s.temperature_y && s.temperature_x == s.temperature_z &&
               s.wave_x == 0 && s.wave_y == 0 && s.wave_z == 0 && drift_of(s) == drift;
    });
}

/// Kinetic energy of each species at the end over that of the start, without a common drift: what one loses
/// another may gain, and their sum does not tell. Of one species alone the energy tells all. What begins with
/// less than a twentieth of all heat is judged by its part of that.
inline void compare_rest(const Case& w, const common::History& history, common::Summary& summary) {
    const std::vector<SpeciesCase>& species = w.uniform.species;
    const auto counts = [](const SpeciesCase& s) { return s.charge != 0; };
    if (!is_at_rest(w) || std::ranges::count_if(species, counts) < 2) return;
    const double area = w.grid.x.length * w.grid.z.length,
                 dx = std::max(w.grid.x.spacing(), w.grid.z.spacing());
    double mass = 0, all_heat = 0;
    for (const SpeciesCase& s : species) {
        mass += s.density * s.mass * area;
        if (counts(s)) all_heat += 1.5 * s.density * s.temperature_x * area;
    }
    const auto x = history.column("momentum_x"), y = history.column("momentum_y"),
               z = history.column("momentum_z");
    const auto drift2 = [&](std::size_t n) {
        return (x[n] * x[n] + y[n] * y[n] + z[n] * z[n]) / (mass * mass);
    };
    for (const SpeciesCase& s : species) {
        if (!counts(s)) continue;
        const auto kinetic = history.column("kinetic_" + s.name);
        const auto heat = [&](std::size_t n) {
            return kinetic[n] - 0.5 * s.density * s.mass * area * drift2(n);
        };
        const std::string number = format(double(w.uniform.particles_per_cell));
        const bool by_theta =
            w.field.theta > 0.5 && !w.leapfrog.chosen && heat(kinetic.size() - 1) < heat(0);
        summary.hint((by_theta ? "field.theta = " + format(w.field.theta) +
                                     " takes the energy of noise: set it to 0.5; or "
                               : "") +
                     cause_in_scheme(w, true) + "the Debye length of " + s.name + " is " +
                     format(std::sqrt(s.temperature_x / s.density) / std::fabs(s.charge) / dx) +
                     " cells, and " + number + " particles per cell" +
                     (w.loading == "random" ? ", placed at random," : "") +
                     " heat or cool by their noise: refine the mesh, raise "
                     "uniform.particles_per_cell" +
                     (w.loading == "random" ? ", or take plasma.loading = \"quiet\"" : "") +
                     (w.field.uses_mass_matrix() || w.leapfrog.chosen
                          ? ""
                          : "; field.response = \"mass_matrix\" keeps the energy of all"));
        const std::string source = "a plasma that nothing drives: neither heats nor cools";
        if (1.5 * s.density * s.temperature_x * area > 0.05 * all_heat)
            summary.result("kinetic_over_initial_" + s.name, heat(kinetic.size() - 1) / heat(0), "",
                           1, 0.1, source);
        else if (all_heat > 0)
            summary.result_at_most("kinetic_over_all_" + s.name,
                                   heat(kinetic.size() - 1) / all_heat, "", 0.1, source);
    }
}

}  // namespace implicit_moment
