// How well a run kept its energy: judged in every case.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "common/run/run.hpp"
#include "implicit_moment/setup/load_plasma.hpp"
#include "implicit_moment/theory/compare_drift.hpp"
#include "implicit_moment/theory/wave_theory.hpp"

namespace implicit_moment {

/// What the energy may do: its change relative to the start, and how far from that it may be.
struct EnergyWindow {
    double change = 0, tolerance = 0.05;
    std::string source = "conservation, and what noise may take";
};

/// Whether it is the sheet of the GEM challenge.
inline bool is_gem(const Case& w) {
    const HarrisCase gem, &h = w.harris;
    return w.is_across_current() && !w.is_tail() && h.mass_ratio == gem.mass_ratio &&
           h.temperature_ratio == gem.temperature_ratio && h.thickness == gem.thickness &&
           h.background == gem.background && h.perturbation == gem.perturbation &&
           h.guide_field == 0;
}

/// Whether a species begins with a wave.
inline bool has_seed(const SpeciesCase& s) {
    return s.wave_x != 0 || s.wave_y != 0 || s.wave_z != 0;
}

/// Whether the energy of a seed follows from the linear step: of a cold wave that starts quietly, in implicit_moment.
/// At the mesh's limit a wave is its own mirror image, and its energy depends on its phase.
inline bool knows_seeded_energy(const Case& w) {
    const bool at_limit =
        2 * w.uniform.mode_x % w.grid.x.cells == 0 && 2 * w.uniform.mode_z % w.grid.z.cells == 0;
    return w.loading == "quiet" && !w.leapfrog.chosen && !at_limit &&
           (w.wave == "langmuir" || w.wave == "cold");
}

/// The part of the usable energy that the seeded wave has: a mean over cos^2 of velocities and fields.
inline double share_of_wave(const Case& w, double usable) {
    const UniformCase& u = w.uniform;
    double sum = 0;  // 4 pi n0 = 1
    for (const double seed :
         {u.wave_B_x, u.wave_B_y, u.wave_B_z, u.wave_E_x, u.wave_E_y, u.wave_E_z})
        sum += 0.25 * seed * seed;
    for (const SpeciesCase& s : u.species)
        sum += 0.25 * s.density * s.mass *
               (s.wave_x * s.wave_x + s.wave_y * s.wave_y + s.wave_z * s.wave_z);
    return std::min(1.0, sum * w.grid.x.length * w.grid.z.length / usable);
}

/// The window of a case.
///     GEM                      two independent codes keep 0.6 %
///     other sheets             3 %, a sixth of what a sheet turns into heat until unit flux
///     cold waves               seeded_energy(), 1 % for particles, and what they have beside it
///     light                    exp(2 gamma t) - 1 with the damping of the scheme
///     loaded at random         from 0 to that, where the seed has other waves, too
///     these, theta > 1/2       what theta took from wave and noise, energy_by_theta, and what the current
///                              that moments predict may take beside: friction
///     uniform plasma           5 % of what is not the uniform magnetic field, which nothing can use
/// note:   a leapfrog knows u and B between the times of E; their means at the time of E make the
///         energy of a wave swing by tan^2(omega dt/2) of what the wave has.
/// in:     usable energy at the start; by_theta, what theta has taken of it
inline EnergyWindow energy_window(const Case& w, double usable, double by_theta) {
    EnergyWindow window;
    if (w.is_across_current() && w.harris.perturbation == 0) {
        window.tolerance = 0.005, window.source = "equilibrium";
    } else if (is_gem(w)) {
        window.tolerance = 0.006, window.source = "two codes, implicit and explicit, keep 0.6 %";
    } else if (!w.is_uniform()) {
        window.tolerance = 0.03;
    } else if (knows_seeded_energy(w)) {
        // What uneven particles have beside the seed may be lost, to 5 %.
        const SeededEnergy seed = seeded_energy(w);
        const double part = std::min(1.0, seed.at_start / usable),
                     uneven = std::min(0.05, 1 - part);
        window.change = part * seed.change - 0.5 * uneven;
        window.tolerance = 0.01 + 0.5 * uneven;
        window.source = "what the linear step makes of the seed, all its waves together";
    } else if (w.wave == "light" || w.wave == "langmuir" || w.wave == "cold") {
        const std::complex<double> wave = wave_of(w)->expect(w).omega;
        // Other waves of the seed may be damped less, or not at all where species move alike.
        const bool others =
            w.wave == "cold" || std::ranges::count_if(w.uniform.species, has_seed) > 1;
        double most = std::expm1(2 * wave.imag() * w.end), least = others ? 0 : most;
        window.source = "damping of the scheme";
        if (by_theta < 0) {
            Case without = w;
            without.field.theta = 0.5;
            const double friction = wave_of(w)->expect(without).omega.imag();
            least = by_theta, most = by_theta / std::max(0.1, 1 - friction / wave.imag());
            window.source = "what theta took, energy_by_theta, and friction";
        }
        window.change = 0.5 * (least + most);
        window.tolerance = (w.wave == "light" ? exact_to(w) : 0.05) + 0.5 * std::fabs(least - most);
        if (w.leapfrog.chosen) {
            window.source = "no damping; E and B known half a step apart: tan^2(omega dt/2)";
            window.tolerance += std::pow(std::tan(0.5 * wave.real() * w.dt), 2);
        }
    } else if (w.leapfrog.chosen && wave_of(w) != nullptr) {
        const double angle = std::min(2.0, std::fabs(wave_of(w)->expect(w).omega.real()) * w.dt);
        window.source = "conservation, and E and B known half a step apart: tan^2(omega dt/2)";
        window.tolerance += share_of_wave(w, usable) * std::pow(std::tan(0.5 * angle), 2);
    }
    return window;
}

/// The largest change of the momentum of a plasma that drifts as a whole, over that momentum, by kept_components().
/// What is conserved is that of particles and field, of which the mean fields count:
///     sum m v + V <E> x B/(4 pi c)
/// out:    NaN where a case has no such drift, a charged background, or a wave with a hundredth of it
inline double momentum_change(const Case& w, const common::History& history) {
    const UniformCase& u = w.uniform;
    if (!w.is_uniform()) return std::nan("");
    const Eigen::Vector3d kept = kept_components(w);
    const CommonDrift drift = common_drift(w);
    const double together = drift.momentum.norm(), area = w.grid.x.length * w.grid.z.length;
    double of_wave = 0;
    for (const double seed :
         {u.wave_B_x, u.wave_B_y, u.wave_B_z, u.wave_E_x, u.wave_E_y, u.wave_E_z})
        of_wave += 0.25 * seed * seed / c;
    if (!drift.counts || of_wave > 0.01 * together) return std::nan("");
    const auto vectors = [&](const std::string& name) {
        return std::array{history.column(name + "_x"), history.column(name + "_y"),
                          history.column(name + "_z")};
    };
    const auto P = vectors("momentum"), E = has_mean_E(w) ? vectors("mean_E") : P;
    const Eigen::Vector3d B(u.B_x, u.B_y, u.B_z);
    const auto momentum = [&](std::size_t n) {
        const Eigen::Vector3d of_particles(P[0][n], P[1][n], P[2][n]),
            mean_E(E[0][n], E[1][n], E[2][n]);
        // 4 pi n0 = 1.
        return has_mean_E(w) ? Eigen::Vector3d(of_particles + area / c * mean_E.cross(B))
                             : of_particles;
    };
    double change = 0;
    for (std::size_t n = 0; n < P[0].size(); ++n)
        change = std::max(change, (momentum(n) - momentum(0)).cwiseProduct(kept).norm());
    return change / (together * area);
}

/// What the mass matrix promises: the energy of particles and field changes in a step by what theta takes
/// and by nothing else.
inline void compare_theorem(const Case& w, const common::History& history,
                            common::Summary& summary) {
    const std::vector<double> residual = history.column("energy_residual");
    double largest = 0;
    for (std::size_t n = 1; n < residual.size(); ++n)
        largest = std::max(largest, std::fabs(residual[n] - residual[n - 1]));
    summary.hint("the energy is as exact as the field is solved for: lower field.tolerance");
    // Where a uniform B holds nearly all of the energy, its round-off counts: some last digits of two sums.
    const double all = history.first("energy"), part = all > 0 ? all / usable_energy(w, all) : 1,
                 digit = std::numeric_limits<double>::epsilon();
    const double bound = 1e-11 + 20 * digit * part;
    if (bound > 1e-6)
        return summary.not_measured("energy_identity_per_step",
                                    "what moves has " + format(1 / part) +
                                        " of the energy, and the rest is that of the uniform "
                                        "magnetic field: its round-off hides the identity");
    summary.result_at_most("energy_identity_per_step", largest, "", bound,
                           "exact: what particles gain the field loses, whatever the step is");
}

/// The largest rms of div E - 4 pi rho: exact along the paths of the particles, kept nearly otherwise. Mass
/// matrices promise it; of other runs it is a result where it fell short.
/// note:   in units of the charge of one sign of a uniform plasma, e n0 of a sheet
inline void compare_gauss(const Case& w, const common::History& history, common::Summary& summary) {
    double positive = w.is_uniform() ? 0 : 1, negative = 0;
    if (w.is_uniform())
        for (const SpeciesCase& s : w.uniform.species)
            (s.charge > 0 ? positive : negative) += std::fabs(s.charge) * s.density;
    const double charge = std::max(positive, negative);
    if (charge == 0) return;
    const bool mass_matrix = w.field.uses_mass_matrix();
    const bool follow = mass_matrix && w.field.solver == "newton_krylov";
    const double residual = history.largest("gauss_residual") / charge;
    const double bound = follow ? 1e-9 : mass_matrix && !w.is_uniform() ? 0.01 : 0.05;
    if (!mass_matrix && residual <= bound) return;
    const std::string of_response = mass_matrix ? "" : "field.response = \"mass_matrix\" and ";
    summary.hint(follow
                     ? "Gauss's law is as exact as the field is solved for: lower field.tolerance"
                     : "particles move otherwise than the field expects: raise the number of "
                       "particles, lower time.dt, or take " +
                           of_response + "field.solver = \"newton_krylov\"");
    summary.result_at_most("gauss_residual", residual, "4pi*e*n0", bound,
                           follow ? "exact along the paths of the particles"
                                  : "a small part of the charge of one sign");
}

/// Whether the mesh brakes a plasma that drifts, which no law of energy forbids.
inline void compare_momentum(const Case& w, const common::History& history,
                             common::Summary& summary) {
    const double change = momentum_change(w, history);
    if (std::isnan(change)) return;
    summary.hint(cause_in_scheme(w, false) + mesh_brakes(w));
    const CommonDrift drift = common_drift(w);
    const double noise = drift.is_fast ? 0 : drift.noise / drift.momentum.norm();
    summary.result_at_most("momentum_change", change, "", 0.05 + noise,
                           drift.is_fast ? "conservation" : "conservation, and noise");
}

/// Particles that a push without the Lorentz factor has made faster than light, which conserves all else.
inline void compare_speed(const Case& w, const common::History& history, common::Summary& summary) {
    if (w.is_relativistic() || !w.is_uniform()) return;
    for (const SpeciesCase& s : w.uniform.species) {
        const double mass = s.density * s.mass * w.grid.x.length * w.grid.z.length,
                     rms = std::sqrt(2 * history.largest("kinetic_" + s.name) / mass);
        if (rms <= 1) continue;
        const bool at_once = history.first("kinetic_" + s.name) > 0.5 * mass;
        summary.hint(std::string("particles without a Lorentz factor are faster than light: set "
                                 "particles.relativistic = true, or lower ") +
                     (at_once ? "temperatures and drifts" : "the fields that drive them"));
        summary.result_at_most("rms_speed_" + s.name, rms, "c", 1, "nothing is faster than light");
    }
}

/// The largest change of the energy, or where the scheme damps it the last one, in its window.
inline void compare_energy(const Case& w, const common::History& history,
                           common::Summary& summary) {
    if (w.field.uses_mass_matrix()) compare_theorem(w, history, summary);
    compare_gauss(w, history, summary);
    compare_momentum(w, history, summary);
    compare_speed(w, history, summary);
    const auto drift = history.column("energy_drift");
    const bool damps = w.field.theta > 0.5 && !w.leapfrog.chosen;
    const EnergyWindow window =
        energy_window(w, usable_energy(w, history.first("energy")),
                      damps && (w.wave == "langmuir" || w.wave == "cold")
                          ? drift.back() - history.column("energy_residual").back()
                          : 0);
    const std::string unbalanced = no_balance(w);
    summary.hint(!unbalanced.empty() && w.harris.perturbation == 0 ? unbalanced
                 : damps && !(drift.back() > 0)
                     ? std::string("field.theta above 0.5 damps fast waves and noise: raise the "
                                   "number of particles, or set it to 0.5") +
                           (w.field.uses_mass_matrix()
                                ? ""
                                : " and field.response = \"mass_matrix\", for what moments predict "
                                  "keeps no energy")
                     : (w.field.uses_mass_matrix() || w.leapfrog.chosen
                            ? ""
                            : "what moments predict keeps no energy: set field.response = "
                              "\"mass_matrix\"; or ") +
                           cause_in_scheme(w, true) +
                           "noise of few particles, or scales that are not resolved, heat or cool: "
                           "raise the number of particles, lower time.dt, or refine the mesh");
    const double usable = usable_energy(w, history.first("energy"));
    if (idle_energy(w) > 0 && !is_usable(w, history.first("energy")))
        return summary.not_measured("energy_drift",
                                    "all of the energy but 1e-12 is that of the uniform magnetic "
                                    "field, which nothing can use: raise what else moves");
    if (const double part = knows_seeded_energy(w) ? seeded_energy(w).at_start / usable : 1;
        part < 0.5)
        return summary.not_measured("energy_drift", "the seed has " + format(part) +
                                                        " of the energy, and the rest is what the "
                                                        "particles have by their places: raise it");
    if (std::fabs(window.change) > std::min(1e-3, 0.1 * window.tolerance))
        return summary.result("energy_drift", drift.back(), "", window.change, window.tolerance,
                              window.source);
    double largest = 0;
    for (const double one : drift) largest = std::max(largest, std::fabs(one));
    summary.result_at_most("energy_drift", largest, "", window.tolerance, window.source);
}

}  // namespace implicit_moment
