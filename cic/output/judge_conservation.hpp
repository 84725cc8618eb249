// What a run keeps, whatever it is compared with: its momentum, and where nothing happens the energy
// of each species.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cic/setup/scales.hpp"

namespace cic {

/// The largest change of the momentum, of sum (2 K M)^1/2 of all species, K kinetic energy, M mass, at the
/// start or, where that is nothing, at its largest. The momentum scheme keeps it to round-off, and is judged
/// only where it did not; the energy scheme where a species drifts. Where drifts do not cancel it is judged
/// by the momentum that they have together, with a tolerance for the noise of so many particles. Of a
/// magnetized plasma the momentum along B.
/// in:     least_energy, below which all energy is round-off
inline void judge_momentum(const Case& parameters, double least_energy, const History& history,
                           Summary& summary) {
    if (parameters.has_walls()) return;
    // B turns all momentum but that along it, which x and z have where B is in the plane.
    const bool plane = parameters.dimensions == 2;
    const MagneticField& B = parameters.B;
    if (B.y != 0 || (!plane && B.z != 0)) return;
    const auto along_B = [&](double x, double z) {
        return parameters.magnetized() ? std::fabs(x * B.x + z * B.z) / B.size() : std::hypot(x, z);
    };
    const auto kinetic = history.column("kinetic"), x = history.column("momentum_x"),
               z = plane ? history.column("momentum_z") : std::vector<double>(x.size(), 0.0);
    std::vector<double> scale(x.size(), 0.0);
    double drifting = 0, noise2 = 0;
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        const auto own = history.column("kinetic_" + s.name);
        const double mass = s.mass * s.mean_density() * filled_volume(parameters, s);
        for (std::size_t n = 0; n < own.size(); ++n)
            scale[n] += std::sqrt(2 * std::max(0.0, own[n]) * mass);
        drifting += mass * along_B(s.drift_x, plane ? s.drift_z : 0.0);
        noise2 += 2 * own.front() * mass / double(particle_count(parameters, s));
    }
    double change = 0;
    for (std::size_t n = 0; n < x.size(); ++n)
        change = std::max(change, along_B(x[n] - x[0], z[n] - z[0]));
    const double most = std::ranges::max(scale);
    const double thermal = scale.front() > 0.1 * most ? scale.front() : most,
                 carried = along_B(x[0], z[0]);
    const bool energy = parameters.scheme().energy_conserving;
    // What does not drift has nothing to lose.
    if (energy && !(drifting > 0.01 * most)) return;
    const bool together = energy && carried > 0.01 * most;
    const double noise = std::sqrt(noise2) / carried;
    if (together && noise > 0.5)
        return summary.not_measured("momentum_change",
                                    sentence("the noise of so many particles has ", noise,
                                             " of the momentum that they have together: raise "
                                             "particles_per_cell or the drift"));
    change /= together ? carried : thermal;
    if (!(std::ranges::max(kinetic) > least_energy) || (!energy && change <= 0.05)) return;
    summary.hint(energy ? "the energy-conserving mesh brakes what moves through it: take "
                          "method.scheme = \"momentum\", or refine the mesh to the Debye length"
                        : "the forces of this scheme are equal and opposite to round-off: compile "
                          "with REAL=double");
    summary.result_at_most("momentum_change", change, "", together ? 0.05 + noise : 0.05,
                           "momentum is conserved, but for the energy-conserving mesh");
}

/// Whether nothing can happen: a periodic, uniform plasma of Maxwellians that move together, if at all.
inline bool is_at_rest(const Case& parameters) {
    if (parameters.has_walls() || parameters.gauss_sign < 0) return false;
    const SpeciesCase* first = nullptr;
    const MagneticField& B = parameters.B;
    // Along B, and of a momentum that is recorded.
    const auto drifts_freely = [&](const SpeciesCase& s) {
        return s.drift_y == 0 && (parameters.dimensions == 2 || s.drift_z == 0) &&
               B.y * s.drift_x == 0 && B.y * s.drift_z == 0 && B.z * s.drift_x == B.x * s.drift_z;
    };
    for (const SpeciesCase& s : parameters.species) {
        if (!s.mobile()) continue;
        if (!first) first = &s;
        const std::array<double, 3> T = s.temperatures(parameters.axis());
        const bool isotropic = parameters.magnetized() ? T[0] == T[1] && T[0] == T[2]
                                                       : parameters.dimensions == 1 || T[0] == T[2];
        if (s.profile != "uniform" || !s.density.is_number() || s.has_distribution() ||
            !isotropic || !perturbations_of(parameters, s).empty() || s.ripple != 0 ||
            s.drift() != first->drift() || !drifts_freely(s))
            return false;
    }
    return true;
}

/// Where the leapfrog heats plasma whose Debye length the mesh resolves: that, and what to change.
inline std::string heats_in_step(const Case& parameters) {
    const Scales scales = scales_of(parameters);
    const double omega_dt = scales.largest_omega_p * parameters.dt,
                 dx = std::max(parameters.grid.x.spacing(),
                               parameters.dimensions == 2 ? parameters.grid.z.spacing() : 0.0);
    if (!(omega_dt > 0.5) || pi * scales.least_debye_length < dx) return "";
    return sentence("omega_p dt is ", omega_dt,
                    ", and the leapfrog heats what swings within a step: lower time.dt");
}

/// What a plasma at rest has of the energy of each species at the end, without a common drift. Energy as
/// a whole does not tell what species exchange, nor what they take from the noise of a random start.
inline void judge_rest(const Case& parameters, const History& history, Summary& summary) {
    if (!is_at_rest(parameters)) return;
    const Scales scales = scales_of(parameters);
    const Grid& grid = parameters.grid;
    const double volume = grid.x.length * grid.z.length, field = history.first("field");
    double mass = 0;  // per volume
    for (const SpeciesCase& s : parameters.species)
        if (s.mobile()) mass += s.mass * s.mean_density();
    std::vector<double> drift2(history.column("time").size(), 0.0);
    std::vector<std::string> components{"momentum_x"};
    if (parameters.dimensions == 2) components.push_back("momentum_z");
    for (const std::string& component : components) {
        const auto momentum = history.column(component);
        for (std::size_t n = 0; n < drift2.size(); ++n)
            drift2[n] += std::pow(momentum[n] / (mass * volume), 2);
    }
    const double dx = parameters.dimensions == 2 ? std::max(grid.x.spacing(), grid.z.spacing())
                                                 : grid.x.spacing();
    for (const SpeciesScales& scale : scales.species) {
        const SpeciesCase& s =
            *std::ranges::find(parameters.species, scale.name, &SpeciesCase::name);
        auto kinetic = history.column("kinetic_" + s.name);
        for (std::size_t n = 0; n < kinetic.size(); ++n)
            kinetic[n] -= 0.5 * s.mass * s.mean_density() * volume * drift2[n];
        if (scale.thermal_speed == 0 || s.charge == 0 || !(kinetic.front() > 0)) continue;
        const std::string of_step = heats_in_step(parameters);
        summary.hint(
            !of_step.empty() ? of_step
            : s.loading == "random" && field > 0.1 * kinetic.front()
                ? sentence("a random start has more noise than equilibrium, its field ",
                           field / kinetic.front(),
                           " of this energy, and gives it to particles: "
                           "take loading = \"quiet\", or raise particles_per_cell")
                : sentence("the Debye length of ", s.name, " is ", scale.debye_length / dx,
                           " cells: the mesh heats what it does not resolve, and few particles "
                           "exchange heat: refine the mesh, or raise particles_per_cell, ",
                           s.particles_per_cell));
        summary.result("kinetic_over_initial_" + s.name, kinetic.back() / kinetic.front(), "", 1,
                       0.1, "a plasma at rest: neither heats nor cools");
    }
}

}  // namespace cic
